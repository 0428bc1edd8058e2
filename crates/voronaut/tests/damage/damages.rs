//! What happens to surfaces on their way.

use super::random::Random;
use voronaut::mesh::Mesh;

/// What was done to a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Done {
    Holes,
    Flipped,
    Missing,
    DuplicateTriangles,
    DuplicateVertices,
    Soup,
    Degenerate,
    TJunctions,
    NotFinite,
    ThreeTriangleEdge,
    Pinched,
}

pub(crate) const ALL: [Done; 11] = [
    Done::Holes,
    Done::Flipped,
    Done::Missing,
    Done::DuplicateTriangles,
    Done::DuplicateVertices,
    Done::Soup,
    Done::Degenerate,
    Done::TJunctions,
    Done::NotFinite,
    Done::ThreeTriangleEdge,
    Done::Pinched,
];

impl Done {
    /// Words of an error that name it; none where it is no reason to refuse a mesh.
    pub(crate) fn words(self) -> &'static [&'static str] {
        match self {
            // What is left of two triangles may hang together in a vertex only.
            Self::Holes | Self::Missing | Self::DuplicateVertices => &["meet in a point only"],
            Self::Flipped | Self::DuplicateTriangles | Self::Degenerate | Self::Soup => &[],
            // A vertex that takes over some corners of another may leave it in two fans.
            Self::TJunctions => &["a T-junction"],
            Self::NotFinite => &["is not finite"],
            Self::ThreeTriangleEdge => &["an edge of ", "meet in a point only"],
            Self::Pinched => &["meet in a point only", "an edge of ", "a T-junction", "a one-sided surface"],
        }
    }

    /// Does it to a mesh, a few times.
    pub(crate) fn apply(self, mesh: &mut Mesh, random: &mut Random) {
        if self == Self::Soup {
            return soup(mesh);
        }
        for _ in 0..=random.below(3) {
            let t = random.below(mesh.triangles.len());
            match self {
                Self::Holes => hole(mesh, t),
                Self::Flipped => mesh.triangles[t].swap(0, 1),
                Self::Missing => drop(mesh.triangles.swap_remove(t)),
                Self::DuplicateTriangles => duplicate(mesh, t, random),
                Self::DuplicateVertices => split_vertex(mesh, t, random),
                Self::Degenerate => degenerate(mesh, t, random),
                Self::TJunctions => t_junction(mesh, t, random),
                Self::NotFinite => {
                    mesh.points[mesh.triangles[t][0] as usize][1] = [f64::NAN, f64::INFINITY][random.below(2)];
                }
                Self::ThreeTriangleEdge => fin(mesh, t),
                Self::Pinched => pinch(mesh, t, random),
                Self::Soup => {}
            }
        }
    }
}

fn push(mesh: &mut Mesh, p: [f64; 3]) -> u32 {
    mesh.points.push(p);
    mesh.points.len() as u32 - 1
}

fn between(mesh: &Mesh, v: u32, w: u32, t: f64) -> [f64; 3] {
    mesh.position(v).lerp(mesh.position(w), t).to_array()
}

/// All triangles of a vertex go.
fn hole(mesh: &mut Mesh, t: usize) {
    let v = mesh.triangles[t][0];
    if mesh.triangles.iter().filter(|t| !t.contains(&v)).count() > 8 {
        mesh.triangles.retain(|t| !t.contains(&v));
    }
}

fn duplicate(mesh: &mut Mesh, t: usize, random: &mut Random) {
    let mut triangle = mesh.triangles[t];
    if random.below(2) == 0 {
        triangle.swap(0, 2);
    }
    mesh.triangles.push(triangle);
}

/// One triangle, or several, get a vertex of their own at the same place.
fn split_vertex(mesh: &mut Mesh, t: usize, random: &mut Random) {
    let v = mesh.triangles[t][0];
    let copy = push(mesh, mesh.points[v as usize]);
    for triangle in &mut mesh.triangles {
        if triangle.contains(&v) && random.below(2) == 0 {
            *triangle = triangle.map(|w| if w == v { copy } else { w });
        }
    }
}

fn soup(mesh: &mut Mesh) {
    let corners: Vec<u32> = mesh.triangles.as_flattened().to_vec();
    mesh.points = corners.iter().map(|&v| mesh.points[v as usize]).collect();
    mesh.triangles = (0..mesh.triangles.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
}

/// A vertex twice in a triangle; or a flat triangle in an edge that is cut on one of its sides.
fn degenerate(mesh: &mut Mesh, t: usize, random: &mut Random) {
    let [a, b, c] = mesh.triangles[t];
    if random.below(2) == 0 {
        return mesh.triangles.push([a, b, b]);
    }
    let p = between(mesh, a, b, 0.2 + 0.6 * random.unit());
    let middle = push(mesh, p);
    mesh.triangles[t] = [a, middle, c];
    mesh.triangles.extend([[middle, b, c], [a, b, middle]]);
}

/// An edge is cut on one of its sides.
fn t_junction(mesh: &mut Mesh, t: usize, random: &mut Random) {
    let [a, b, c] = mesh.triangles[t];
    let p = between(mesh, a, b, 0.2 + 0.6 * random.unit());
    let middle = push(mesh, p);
    mesh.triangles[t] = [a, middle, c];
    mesh.triangles.push([middle, b, c]);
}

/// A triangle stands up from an edge.
fn fin(mesh: &mut Mesh, t: usize) {
    let [a, b, c] = mesh.triangles[t];
    let [p, q, r] = [a, b, c].map(|v| mesh.position(v));
    let normal = (q - p).cross(r - p).unit().unwrap_or_default();
    let tip = push(mesh, (p.lerp(q, 0.5) + normal * p.distance(q)).to_array());
    mesh.triangles.push([a, b, tip]);
}

/// Two vertices become one.
fn pinch(mesh: &mut Mesh, t: usize, random: &mut Random) {
    let [v, w] = [mesh.triangles[t][0], mesh.triangles[random.below(mesh.triangles.len())][1]];
    mesh.triangles.iter_mut().flatten().filter(|u| **u == w).for_each(|u| *u = v);
}
