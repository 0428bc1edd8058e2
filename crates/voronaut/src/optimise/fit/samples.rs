//! Samples of a surface and of its mesh, and the closest point of the other for each: on triangles whose vertices move it is found
//! from a triangle nearby.

use crate::elementary::Elementary;
use crate::geometry::{Point3, Vector3};
use crate::manifold::Manifold;
use crate::manifold::surface::closest_weights;
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};

/// A point of the surface, and the part of the surface's area that it stands for.
#[derive(Clone, Copy)]
struct Sample {
    place: Point3,
    weight: f64,
}

/// What is measured: fixed samples of the surface, and samples of the mesh that move with it.
pub(super) struct Samples<'a> {
    pub(super) surface: Sheet<'a>,
    of_surface: Vec<Sample>,
}

/// The closest points to all samples.
pub(super) struct Assignment {
    /// Of each sample of the surface, on the mesh.
    to_mesh: Vec<Foot>,
    /// Of each sample of the mesh, on the surface.
    to_surface: Vec<Foot>,
    /// Mean square distance, the mean of both directions.
    pub(super) mean_square: f64,
    /// The greatest distance.
    pub(super) greatest: f64,
}

/// A point of the mesh and one of the surface that should be as near as can be.
pub(super) struct Pair {
    /// The triangle of the mesh.
    pub(super) face: FaceId,
    /// Where in it.
    pub(super) weights: [f64; 3],
    /// The unit direction along which their distance is measured.
    pub(super) direction: Vector3,
    /// How far the mesh is to move along it.
    pub(super) gap: f64,
    /// Part of all pairs.
    pub(super) weight: f64,
}

/// Sides of a triangle of the mesh are cut into so many parts; its samples are the middles of the square of that many parts,
/// and its corners: the tip of an ear that has come out too far shows nowhere else.
const PARTS: usize = 4;
const CORNERS: usize = PARTS * PARTS;
const PER_TRIANGLE: usize = CORNERS + 3;
/// The sample in the middle of a triangle: the second upright part of the second row.
const MIDDLE: usize = 8;
/// The part of a triangle's area that a corner stands for: with it, means of quadratic functions are exact.
const CORNER_SHARE: f64 = 1.0 / 147.0;

/// A pair at the root mean square distance weighs this part more than one without distance, those further apart more by
/// the square, ...
const FARTHER: f64 = 0.1;
/// ... up to this many times.
const FARTHEST: f64 = 100.0;

/// Distances below this part of the root mean square have no direction of their own at a vertex or an edge.
const NEAR: f64 = 0.1;

impl Assignment {
    /// Where on the surface the middle of a triangle of the mesh is closest.
    pub(super) fn below(&self, f: FaceId) -> FaceId {
        self.to_surface[PER_TRIANGLE * f.index() + MIDDLE].face
    }

    /// A factor on the weight of a pair: what is far apart, tips above all, is drawn together more, for less than a per cent
    /// of the root mean square distance.
    fn urgency(&self, foot: &Foot) -> f64 {
        1.0 + FARTHER * (foot.square() / self.mean_square).min(FARTHEST)
    }
}

impl<'a> Samples<'a> {
    /// About `count` samples of the surface, even by area, and all its vertices.
    pub(super) fn new(surface: &'a Manifold, count: usize) -> Self {
        Self { surface: Sheet::of(surface), of_surface: of_surface(surface, count) }
    }

    /// Closest points among all triangles of a mesh and of the surface; none are farther than those known.
    pub(super) fn assign(&self, surface: &Manifold, mesh: &Manifold, known: Option<&Assignment>) -> Assignment {
        surface.prepare();
        mesh.prepare();
        let sheet = Sheet::of(mesh);
        let find = |on: &Manifold, sheet: &Sheet, p: Point3, known: Option<Foot>| {
            let nearer = on.nearer(p, known.map_or(f64::INFINITY, |foot| foot.square()));
            nearer.map(|face| sheet.foot(face, p)).or(known).unwrap_or_else(|| sheet.foot(FaceId(0), p))
        };
        self.measured(
            &sheet,
            |i, p| find(mesh, &sheet, p, known.map(|known| known.to_mesh[i])),
            |i, p| find(surface, &self.surface, p, known.map(|known| known.to_surface[i])),
        )
    }

    /// Closest points after vertices have moved, found from those before.
    pub(super) fn follow(&self, mesh: &Sheet, before: &Assignment) -> Assignment {
        self.measured(
            mesh,
            |i, p| mesh.descend(before.to_mesh[i].face, p),
            |i, p| self.surface.descend(before.to_surface[i].face, p),
        )
    }

    fn measured(
        &self,
        mesh: &Sheet,
        on_mesh: impl Fn(usize, Point3) -> Foot + Sync,
        on_surface: impl Fn(usize, Point3) -> Foot + Sync,
    ) -> Assignment {
        let to_mesh: Vec<Foot> = self.of_surface.par_iter().enumerate().map(|(i, s)| on_mesh(i, s.place)).collect();
        let count = PER_TRIANGLE * mesh.topology.face_slots();
        let to_surface: Vec<Foot> = (0..count).into_par_iter().map(|i| on_surface(i, of_mesh(mesh, i).0)).collect();
        let mean = |feet: &[Foot], weight: &dyn Fn(usize) -> f64| {
            let weighted = feet.iter().enumerate().map(|(i, foot)| (weight(i), foot.square()));
            let [sum, total] = weighted.fold([0.0; 2], |[sum, total], (w, square)| [sum + w * square, total + w]);
            sum / total
        };
        let (a, b) = (mean(&to_mesh, &|i| self.of_surface[i].weight), mean(&to_surface, &|i| of_mesh(mesh, i).1));
        let greatest = to_mesh.iter().chain(&to_surface).map(Foot::square).fold(0.0, f64::max).sqrt();
        Assignment { to_mesh, to_surface, mean_square: 0.5 * (a + b), greatest }
    }

    /// All pairs of samples and their closest points; weights of each direction sum to one.
    pub(super) fn pairs<'b>(&'b self, mesh: &'b Sheet, at: &'b Assignment) -> impl Iterator<Item = Pair> + 'b {
        let near = NEAR * at.mean_square.sqrt();
        let total: f64 = self.of_surface.iter().map(|s| s.weight).sum();
        let area: f64 = mesh.topology.faces().map(|f| 0.5 * mesh.area_vector(f).norm()).sum();
        let to_mesh = at.to_mesh.iter().zip(&self.of_surface).map(move |(foot, s)| {
            let direction = mesh.direction(foot, near);
            let gap = direction.dot(foot.offset);
            let weight = s.weight / total * at.urgency(foot);
            Pair { face: foot.face, weights: foot.weights, direction, gap, weight }
        });
        let to_surface = at.to_surface.iter().enumerate().map(move |(i, foot)| {
            let direction = self.surface.direction(foot, near);
            let gap = -direction.dot(foot.offset);
            let (face, weights) = on_lattice(i);
            let weight = of_mesh(mesh, i).1 / area * at.urgency(foot);
            Pair { face, weights, direction, gap, weight }
        });
        to_mesh.chain(to_surface)
    }
}

/// A sample of the mesh: its triangle and barycentric coordinates.
fn on_lattice(i: usize) -> (FaceId, [f64; 3]) {
    let (face, k) = (FaceId((i / PER_TRIANGLE) as u32), i % PER_TRIANGLE);
    if k >= CORNERS {
        return (face, [0, 1, 2].map(|corner| if corner == k - CORNERS { 1.0 } else { 0.0 }));
    }
    // Parts in rows: of every row the upright ones, then those upside down.
    let before = |row: usize| CORNERS - (PARTS - row) * (PARTS - row);
    let row = (0..PARTS).rev().find(|&row| before(row) <= k).unwrap_or(0);
    let (rest, upright) = (k - before(row), PARTS - row);
    let (column, third) = if rest < upright { (rest, 1.0 / 3.0) } else { (rest - upright, 2.0 / 3.0) };
    let (s, t) = ((column as f64 + third) / PARTS as f64, (row as f64 + third) / PARTS as f64);
    (face, [1.0 - s - t, s, t])
}

/// Where a sample of the mesh is, and the area that it stands for.
fn of_mesh(mesh: &Sheet, i: usize) -> (Point3, f64) {
    let (face, weights) = on_lattice(i);
    let corners = mesh.triangle(face);
    let of_part = (1.0 - 3.0 * CORNER_SHARE) / CORNERS as f64;
    let share = if i % PER_TRIANGLE < CORNERS { of_part } else { CORNER_SHARE };
    (Point3::weighted(corners, weights), 0.5 * area_vector(corners).norm() * share)
}

fn of_surface(surface: &Manifold, count: usize) -> Vec<Sample> {
    let t = surface.topology();
    let vertices = t.vertices().count();
    let total = surface.area();
    let step = total / count as f64;
    let mut samples = Vec::with_capacity(count + vertices);
    let (mut reached, mut k) = (0.0, 0_usize);
    for f in t.faces() {
        reached += 0.5 * surface.area_vector(f).norm();
        while k < count && (k as f64 + 0.5) * step < reached {
            let place = Point3::weighted(surface.triangle(f), scattered(k));
            samples.push(Sample { place, weight: step });
            k += 1;
        }
    }
    let share = vertices as f64 / count as f64;
    let star_area = |v: VertexId| t.star(v).map(|h| surface.area_vector(h.face()).norm() / 6.0).sum::<f64>();
    samples
        .extend(t.vertices().map(|v| Sample { place: surface.positions()[v.index()], weight: share * star_area(v) }));
    samples
}

/// The k-th of points that fill a triangle evenly, as barycentric coordinates: the additive sequence of Roberts 2018 in the
/// unit square, folded at its diagonal.
fn scattered(k: usize) -> [f64; 3] {
    let [s, t] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2].map(|step: f64| (0.5 + step * k as f64).fract());
    let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
    [1.0 - s - t, s, t]
}

/// Triangles with positions of their own.
#[derive(Clone)]
pub(super) struct Sheet<'a> {
    pub(super) topology: &'a Triangulation,
    pub(super) positions: Vec<Point3>,
}

/// The closest point of a triangle to some point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub(super) face: FaceId,
    /// Its barycentric coordinates.
    pub(super) weights: [f64; 3],
    /// From it to the point.
    pub(super) offset: Vector3,
}

/// A barycentric coordinate up to this is zero.
const ON_BORDER: f64 = 1e-9;

impl Foot {
    /// The square of the distance.
    pub(super) fn square(&self) -> f64 {
        self.offset.dot(self.offset)
    }

    /// Whether it is off the triangle's border, so that the offset is along the normal.
    fn is_inside(&self) -> bool {
        self.held_by().all(|held| held)
    }

    /// Which corners it is not opposite to, but for rounding.
    fn held_by(&self) -> impl Iterator<Item = bool> {
        self.weights.into_iter().map(|w| w > ON_BORDER)
    }
}

fn square(v: Vector3) -> f64 {
    v.dot(v)
}

impl<'a> Sheet<'a> {
    /// A surface's triangles, where they are.
    pub(super) fn of(surface: &'a Manifold) -> Self {
        Self { topology: surface.topology(), positions: surface.positions().to_vec() }
    }

    /// The corners of a triangle.
    pub(super) fn triangle(&self, f: FaceId) -> [Point3; 3] {
        self.topology.corners(f).map(|v| self.positions[v.index()])
    }

    /// The normal with the length of twice the area.
    pub(super) fn area_vector(&self, f: FaceId) -> Vector3 {
        area_vector(self.triangle(f))
    }

    /// The closest point of one triangle.
    pub(super) fn foot(&self, face: FaceId, p: Point3) -> Foot {
        let corners = self.triangle(face);
        let weights = closest_weights(corners, p);
        Foot { face, weights, offset: p - Point3::weighted(corners, weights) }
    }

    /// A closest point among the triangles around: from triangle to triangle while that comes nearer, until none comes nearer that
    /// shares a corner with the one that was reached. Beyond a gap or a bulge there may be nearer ones, so the distance is an upper
    /// bound.
    pub(super) fn descend(&self, start: FaceId, p: Point3) -> Foot {
        let mut best = self.foot(start, p);
        while !self.is_far_inside(&best) {
            let nearer = self.nearer_beside(&best, p).or_else(|| self.nearer_around(&best, p));
            let Some(nearer) = nearer else { break };
            best = nearer;
        }
        best
    }

    /// Whether a foot is so far from the border of its triangle that none that shares a corner with it comes nearer, unless they make an angle below 30
    /// degrees: what does is less than twice the distance from the foot, and all of it at least half as far as the border.
    fn is_far_inside(&self, foot: &Foot) -> bool {
        let corners = self.triangle(foot.face);
        let height = |i: usize| foot.weights[i] * foot.weights[i] / square(corners[(i + 2) % 3] - corners[(i + 1) % 3]);
        let least = (0..3).map(height).fold(f64::INFINITY, f64::min);
        16.0 * foot.square() < least * square(area_vector(corners))
    }

    /// The nearest, if nearer, across the sides of a triangle that holds its foot inside, or of those that share an end of the side
    /// that holds it: mostly the way goes on there.
    fn nearer_beside(&self, foot: &Foot, p: Point3) -> Option<Foot> {
        let t = self.topology;
        if foot.is_inside() {
            return self.nearer(foot, p, foot.face.half_edges().into_iter().filter_map(|h| t.twin(h)));
        }
        let held = foot.held_by().zip(t.corners(foot.face)).filter(|&(held, _)| held);
        self.nearer(foot, p, held.flat_map(|(_, v)| t.star(v)))
    }

    /// The nearest, if nearer, of all triangles that share a corner with one. Those whose planes are farther than the foot are not.
    fn nearer_around(&self, foot: &Foot, p: Point3) -> Option<Foot> {
        let may_be = |h: &HalfEdge| {
            let corners = self.triangle(h.face());
            let normal = area_vector(corners);
            let height = normal.dot(p - corners[0]);
            height * height < foot.square() * normal.dot(normal)
        };
        let around = self.topology.corners(foot.face).into_iter().flat_map(|v| self.topology.star(v));
        self.nearer(foot, p, around.filter(may_be))
    }

    fn nearer(&self, foot: &Foot, p: Point3, among: impl Iterator<Item = HalfEdge>) -> Option<Foot> {
        let mut best = *foot;
        for h in among.filter(|h| h.face() != foot.face) {
            let other = self.foot(h.face(), p);
            if other.square() < best.square() {
                best = other;
            }
        }
        (best.face != foot.face).then_some(best)
    }

    /// The unit direction along which the distance of a foot changes most: the normal inside a triangle, at its border from
    /// the foot to the point. Where these are hardly apart (beside `near`) that says nothing, and the mean normal there
    /// takes its place, without a jump.
    pub(super) fn direction(&self, foot: &Foot, near: f64) -> Vector3 {
        if foot.is_inside() {
            return self.area_vector(foot.face).unit().unwrap_or_default();
        }
        let normal = self.mean_normal(foot);
        let side = if normal.dot(foot.offset) < 0.0 { -near } else { near };
        (foot.offset + normal * side).unit().unwrap_or(normal)
    }

    /// The mean of the normals at a point of an edge, or at a vertex, there weighted by angles (Baerentzen and Aanaes 2005).
    fn mean_normal(&self, foot: &Foot) -> Vector3 {
        let t = self.topology;
        let at = |v: VertexId| self.positions[v.index()];
        let corners = foot.held_by().zip(t.corners(foot.face)).filter(|&(held, _)| held).map(|(_, v)| v);
        let corners: Vec<VertexId> = corners.collect();
        let around = t.star(corners[0]).filter(|h| corners.iter().all(|v| t.corners(h.face()).contains(v)));
        let weighted = around.map(|h| {
            let [u, v] = [t.target(h), t.apex(h)].map(|v| at(v) - at(t.origin(h)));
            let angle = if corners.len() == 1 { u.cross(v).norm().arctangent_over(u.dot(v)) } else { 1.0 };
            self.area_vector(h.face()).unit().unwrap_or_default() * angle
        });
        weighted.fold(Vector3::default(), |sum, n| sum + n).unit().unwrap_or_default()
    }
}

/// The normal of a triangle with the length of twice its area.
pub(super) fn area_vector([a, b, c]: [Point3; 3]) -> Vector3 {
    (b - a).cross(c - a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::torus;
    use crate::mesh::Mesh;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    #[test]
    fn means_over_the_mesh_are_exact_of_quadratic_functions() {
        let surface = Manifold::new(torus(2.0, 0.7, 0.9).unwrap(), None);
        let sheet = Sheet::of(&surface);
        for f in surface.topology().faces().take(10) {
            let numbers = (0..PER_TRIANGLE).map(|k| PER_TRIANGLE * f.index() + k);
            let [a, b, c] = surface.triangle(f);
            let area = 0.5 * surface.area_vector(f).norm();
            let (mut sum, mut weights) = (0.0, 0.0);
            for i in numbers {
                let (p, weight) = of_mesh(&sheet, i);
                sum += weight * p.x * p.x;
                weights += weight;
            }
            let exact = area * (a.x * a.x + b.x * b.x + c.x * c.x + a.x * b.x + b.x * c.x + c.x * a.x) / 6.0;
            assert!((weights / area - 1.0).abs() < 1e-13 && (sum / exact - 1.0).abs() < 1e-12, "{sum} {exact}");
            let middle = of_mesh(&sheet, PER_TRIANGLE * f.index() + MIDDLE).0;
            assert!(middle.distance(Point3::weighted([a, b, c], [1.0 / 3.0; 3])) < 1e-14);
        }
    }

    #[test]
    fn samples_of_the_surface_are_even() {
        let surface = Manifold::new(torus(2.0, 0.7, 0.2).unwrap(), None);
        let samples = of_surface(&surface, 10_000);
        assert_eq!(samples.len(), 10_000 + surface.positions().len());
        let total: f64 = samples.iter().map(|s| s.weight).sum();
        let mean = |f: &dyn Fn(Point3) -> f64| samples.iter().map(|s| s.weight * f(s.place)).sum::<f64>() / total;
        // Of a torus: x^2 has the mean (R^2 + 3/2 r^2) / 2, z^2 has r^2 / 2.
        assert!(mean(&|p| p.x).abs() < 0.01 && mean(&|p| p.z).abs() < 0.01);
        assert!((mean(&|p| p.x * p.x) / 2.3675 - 1.0).abs() < 0.01, "{}", mean(&|p| p.x * p.x));
        assert!((mean(&|p| p.z * p.z) / 0.245 - 1.0).abs() < 0.02, "{}", mean(&|p| p.z * p.z));
    }

    proptest! {
        #[test]
        fn descents_from_nearby_find_the_closest(u in 0.0..TAU, v in 0.0..TAU, off in -0.2..0.2, face in 0_u32..100) {
            let surface = Manifold::new(torus(2.0, 0.7, 0.4).unwrap(), None);
            let sheet = Sheet::of(&surface);
            let at = |u: f64, v: f64, tube: f64| {
                let ring = 2.0 + tube * v.cos();
                Point3::new(ring * u.cos(), ring * u.sin(), tube * v.sin())
            };
            let p = at(u, v, 0.7 + off);
            let truth = surface.closest_of_triangles(p).unwrap();
            let near = surface.closest_of_triangles(at(u + 0.3, v - 0.4, 0.7)).unwrap().place.face;
            let foot = sheet.descend(near, p);
            prop_assert!((foot.square().sqrt() - truth.distance).abs() < 1e-12);
            prop_assert!((foot.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            prop_assert!((sheet.direction(&foot, 0.0).dot(foot.offset).abs() - truth.distance).abs() < 1e-12);
            // From anywhere: never nearer than the closest of all, nor farther than where it began.
            let far = sheet.descend(FaceId(face), p);
            prop_assert!(far.square().sqrt() > truth.distance - 1e-12);
            prop_assert!(far.square() <= sheet.foot(FaceId(face), p).square());
            let around = surface.topology().corners(far.face).into_iter().flat_map(|v| surface.topology().star(v));
            for h in around {
                prop_assert!(sheet.foot(h.face(), p).square() >= far.square() * (1.0 - 1e-12));
            }
        }
    }

    /// A fan with one triangle that leans over the one below the point: they share the corner, and what is between them is farther.
    #[test]
    fn a_triangle_that_only_shares_a_corner_is_found() {
        let rim =
            [[1.0, 0.0, 0.0], [0.5, 0.9, 0.0], [-0.5, 0.9, 0.0], [0.0, 0.4, 0.9], [0.4, 0.0, 0.9], [0.5, -0.9, 0.0]];
        let points = std::iter::once([0.0; 3]).chain(rim).collect();
        let triangles = (0..6).map(|i| [0, i + 1, (i + 1) % 6 + 1]).collect();
        let surface = Manifold::of(&Mesh { points, triangles, ..Mesh::default() }).unwrap();
        let sheet = Sheet::of(&surface);
        let p = Point3::new(0.17, 0.1, 0.5);
        let below = FaceId(0);
        assert!(sheet.foot(below, p).is_inside());
        assert!(sheet.nearer_beside(&sheet.foot(below, p), p).is_none());
        let truth = surface.closest_of_triangles(p).unwrap().distance;
        assert!((sheet.descend(below, p).square().sqrt() - truth).abs() < 1e-14 && truth < 0.1);
    }
}
