//! From an indexed list of triangles, turned so that neighbours agree, to a surface.

use super::{Mark, Surface};
use crate::error::{Error, Result};
use crate::geometry::Point3;
use crate::lists::{Classes, distinct, in_order};
use crate::mesh::{Edges, Mesh};
use crate::triangulation::{Broken, Constraint, FaceId, Triangulation, VertexId};

impl Surface {
    /// The surface of a mesh's triangles, with its labels; edges of the list are fixed.
    ///
    /// Where neighbouring triangles turn different ways, the fewer of a component are turned ([`Surface::turned`]).
    /// Nothing is joined: triangles are neighbours if they share two vertex numbers.
    ///
    /// # Errors
    /// [`Error::Mesh`] of numbers beyond the lists they refer to. [`Error::Domain`] with the place of: no triangles, a
    /// coordinate that is not finite, a triangle that has a vertex twice or no area, two triangles with the same
    /// vertices, an edge of more than two triangles, a vertex where triangles meet in a point only, a one-sided surface,
    /// an edge in the list that is no triangle's, or there twice with different labels.
    pub fn new(mesh: &Mesh) -> Result<Self> {
        mesh.check_numbers()?;
        mesh.demand_straight()?;
        let positions = finite_positions(mesh)?;
        check_triangles(&mesh.triangles, &positions)?;
        let mut triangles = mesh.triangles.clone();
        let edges = Edges::of(&mesh.triangles);
        check_edges(&edges, &positions)?;
        let turned = turned(triangles.len(), &edges, |ends| edge(ends, &positions))?;
        for &t in &turned {
            triangles[t].swap(1, 2);
        }
        let mut regions = mesh.triangle_labels.clone();
        regions.resize(triangles.len(), 0);
        let topology = Triangulation::from_triangles(positions.len(), &triangles, &regions);
        check_fans(&topology, &positions)?;
        let mut point_labels = mesh.point_labels.clone();
        point_labels.resize(positions.len(), 0);
        let mut surface = Self {
            topology,
            positions,
            normals: Box::default(),
            point_labels,
            marks: marks(mesh).into(),
            corners: distinct(mesh.corners.iter().copied().map(VertexId)).into(),
            required_points: distinct(mesh.required_points.iter().copied().map(VertexId)).into(),
            required_triangles: distinct(mesh.required_triangles.iter().copied().map(FaceId)),
            turned: turned.len(),
        };
        surface.normals = surface.normals_of_faces();
        surface.fix_edges(&mesh.edges)?;
        Ok(surface)
    }

    /// The surface as plain arrays; fixed edges are its edges, border or not. [`Surface::new`] makes the same of it.
    pub fn to_mesh(&self) -> Mesh {
        let t = &self.topology;
        let fixed: Vec<_> = t.edges().filter_map(|h| Some((h, t.constraint(h)?))).collect();
        let marks: Vec<Mark> = fixed.iter().map(|&(_, constraint)| self.mark(constraint)).collect();
        let marked = |is: fn(&Mark) -> bool| (0..).zip(&marks).filter(|(_, mark)| is(mark)).map(|(i, _)| i).collect();
        Mesh {
            points: self.positions.iter().map(|p| p.to_array()).collect(),
            point_labels: self.point_labels.clone(),
            triangles: t.faces().map(|f| t.corners(f).map(|v| v.0)).collect(),
            triangle_labels: t.faces().map(|f| t.region(f)).collect(),
            edges: fixed.iter().map(|&(h, _)| [t.origin(h).0, t.target(h).0]).collect(),
            edge_labels: marks.iter().map(|mark| mark.label).collect(),
            corners: self.corners.iter().map(|v| v.0).collect(),
            required_points: self.required_points.iter().map(|v| v.0).collect(),
            ridges: marked(|mark| mark.is_ridge),
            required_edges: marked(|mark| mark.is_required),
            required_triangles: self.required_triangles.iter().map(|f| f.0).collect(),
            periodic: Vec::new(),
            curved: None,
        }
    }

    fn fix_edges(&mut self, edges: &[[u32; 2]]) -> Result<()> {
        for (i, &[a, b]) in edges.iter().enumerate() {
            let [v, w] = [a, b].map(VertexId);
            let h = self.topology.find(v, w).or_else(|| self.topology.find(w, v)).ok_or_else(|| {
                let what = format!("edge {} of the list is no edge of a triangle", i + 1);
                Error::domain(what, edge([a, b], &self.positions), "remove it, or let a triangle have it")
            })?;
            let same = |other: Constraint| self.mark(other).label == self.marks[i].label;
            if let Some(other) = self.topology.constraint(h).filter(|&other| !same(other)) {
                let what = format!("edges {} and {} of the list are one, with different labels", other.0 + 1, i + 1);
                return Err(Error::domain(what, edge([a, b], &self.positions), "keep one of them"));
            }
            self.topology.set_constraint(h, Constraint(i as u32));
        }
        Ok(())
    }
}

/// Triangles count as without area where their height is so small a part of their longest side: as rounding makes it.
const FLAT: f64 = 1e-14;

fn finite_positions(mesh: &Mesh) -> Result<Vec<Point3>> {
    if mesh.triangles.is_empty() {
        return Err(Error::domain("no triangles", "the mesh", "give a surface as a mesh of triangles"));
    }
    let positions: Vec<Point3> = mesh.points.iter().map(|&p| p.into()).collect();
    match positions.iter().position(|p| !p.is_finite()) {
        None => Ok(positions),
        Some(i) => {
            let place = at(i as u32, &positions);
            Err(Error::domain("a coordinate is not finite", place, "remove or correct the vertex"))
        }
    }
}

fn check_triangles(triangles: &[[u32; 3]], positions: &[Point3]) -> Result<()> {
    for (i, &[a, b, c]) in triangles.iter().enumerate() {
        if a == b || b == c || c == a {
            let what = format!("triangle {} has a vertex twice", i + 1);
            let twice = if a == b { a } else { c };
            return Err(Error::domain(what, at(twice, positions), "remove the triangle"));
        }
        let [p, q, r] = [a, b, c].map(|v| positions[v as usize]);
        if !has_area([p, q, r]) {
            let what = format!("triangle {} has no area", i + 1);
            let place = [a, b, c].map(|v| at(v, positions)).join(", ");
            return Err(Error::domain(what, place, "remove it and join its neighbours, or move one of its corners"));
        }
    }
    check_duplicates(triangles, positions)
}

/// Whether a triangle is more than a line, by more than rounding.
pub(super) fn has_area([p, q, r]: [Point3; 3]) -> bool {
    let longest = Point3::longest_side([p, q, r]);
    (q - p).cross(r - p).norm() > FLAT * longest * longest
}

fn check_duplicates(triangles: &[[u32; 3]], positions: &[Point3]) -> Result<()> {
    let mut keys: Vec<_> = triangles.iter().copied().map(in_order).zip(1..).collect();
    keys.sort_unstable();
    let Some(pair) = keys.windows(2).find(|pair| pair[0].0 == pair[1].0) else { return Ok(()) };
    let what = format!("triangles {} and {} have the same vertices", pair[0].1, pair[1].1);
    Err(Error::domain(what, at(pair[0].0[0], positions), "keep one of them"))
}

fn check_edges(edges: &Edges, positions: &[Point3]) -> Result<()> {
    let Some(same) = edges.iter().find(|same| same.len() > 2) else { return Ok(()) };
    let [s, t, u] = [0, 1, 2].map(|i| same[i].triangle() + 1);
    let what = format!("an edge of {} triangles (among them {s}, {t} and {u})", same.len());
    Err(Error::domain(what, edge(same[0].ends, positions), "leave at most two triangles at every edge"))
}

fn check_fans(topology: &Triangulation, positions: &[Point3]) -> Result<()> {
    match topology.check() {
        Ok(()) => Ok(()),
        Err(Broken::Fan(v)) => {
            let help = "split the vertex, one for each group of neighbouring triangles";
            Err(Error::domain("triangles that meet in a point only", at(v.0, positions), help))
        }
        Err(other) => Err(Error::mesh(
            format!("its triangles do not hang together ({other:?})"),
            "the surface",
            "please report this",
        )),
    }
}

fn marks(mesh: &Mesh) -> Vec<Mark> {
    let label = |i: usize| mesh.edge_labels.get(i).copied().unwrap_or_default();
    let mut marks: Vec<Mark> = (0..mesh.edges.len()).map(|i| Mark { label: label(i), ..Mark::default() }).collect();
    mesh.ridges.iter().for_each(|&i| marks[i as usize].is_ridge = true);
    mesh.required_edges.iter().for_each(|&i| marks[i as usize].is_required = true);
    marks
}

/// A vertex, numbered from 1, for messages.
pub(super) fn vertex(v: u32, position: Point3) -> String {
    format!("vertex {} {position}", v + 1)
}

fn at(v: u32, positions: &[Point3]) -> String {
    vertex(v, positions[v as usize])
}

fn edge([a, b]: [u32; 2], positions: &[Point3]) -> String {
    format!("{} - {}", at(a, positions), at(b, positions))
}

/// Turns triangles until neighbours pass their edge in opposite directions; in each component as few as possible (its
/// majority stays). Every edge has at most two sides. Returns how many were turned.
///
/// # Errors
/// [`Error::Domain`] of a one-sided surface (a Moebius strip, a Klein bottle), where no way of turning is right; `place`
/// says where an edge is.
fn turned(count: usize, edges: &Edges, place: impl Fn([u32; 2]) -> String) -> Result<Vec<usize>> {
    let mut turns = Turns::new(count);
    for sides in edges.iter() {
        if let [s, t] = *sides
            && !turns.join(s.half_edge / 3, t.half_edge / 3, s.forward == t.forward)
        {
            return Err(one_sided(place(s.ends)));
        }
    }
    Ok(turns.minorities())
}

/// Which triangles turn as others do: t as it is, and t + count turned.
pub(super) struct Turns {
    count: u32,
    same: Classes,
}

impl Turns {
    pub(super) fn new(count: usize) -> Self {
        Self { count: count as u32, same: Classes::new(2 * count) }
    }

    /// The first triangle of the same component, and whether this one turns against it.
    fn of(&mut self, t: u32) -> (u32, bool) {
        let [own, against] = [t, t + self.count].map(|t| self.same.shorten(t));
        (own.min(against), against < own)
    }

    /// Makes one component of two, where one triangle is to turn against the other or not; false if they already turn otherwise.
    pub(super) fn join(&mut self, s: u32, t: u32, is_against: bool) -> bool {
        let [like, unlike] = if is_against { [t + self.count, t] } else { [t, t + self.count] };
        if self.same.shorten(s) == self.same.shorten(unlike) {
            return false;
        }
        self.same.join(s, like);
        self.same.join(s + self.count, unlike);
        true
    }

    /// The triangles to turn for all to agree: in each component as few as possible, in order.
    pub(super) fn minorities(&mut self) -> Vec<usize> {
        let found: Vec<(u32, bool)> = (0..self.count).map(|t| self.of(t)).collect();
        let mut counts = vec![[0_usize; 2]; found.len()];
        for &(first, is_turned) in &found {
            counts[first as usize][usize::from(is_turned)] += 1;
        }
        let is_less = |&t: &usize| {
            let (first, is_turned) = found[t];
            let [as_first, others] = counts[first as usize];
            is_turned == (others <= as_first)
        };
        (0..found.len()).filter(is_less).collect()
    }
}

/// The error of a surface without two sides.
pub(super) fn one_sided(place: String) -> Error {
    let help =
        "only two-sided surfaces can be meshed: cut this one open (`repair` does), or correct the triangles there";
    Error::domain("a one-sided surface: its triangles cannot all turn the same way", place, help)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedron() -> Mesh {
        Mesh {
            points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            triangles: vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
            triangle_labels: vec![4, 5, 6, 7],
            ..Mesh::default()
        }
    }

    #[test]
    fn labels_and_fixed_edges_are_kept() {
        let mut mesh = tetrahedron();
        mesh.points.push([9.0, 9.0, 9.0]);
        (mesh.edges, mesh.edge_labels) = (vec![[2, 1], [0, 3]], vec![8, 9]);
        (mesh.corners, mesh.required_points) = (vec![3, 1], vec![1]);
        let surface = Surface::new(&mesh).unwrap();
        let t = surface.topology();
        assert_eq!(t.faces().map(|f| t.region(f)).collect::<Vec<_>>(), [4, 5, 6, 7]);
        let h = t.find(VertexId(1), VertexId(2)).unwrap();
        assert_eq!(t.constraint(h).map(|c| surface.mark(c).label), Some(8));
        assert_eq!(
            (surface.corners(), surface.required_points()),
            (&[VertexId(1), VertexId(3)][..], &[VertexId(1)][..])
        );
        assert_eq!((t.vertices().count(), surface.turned()), (4, 0));
        let again = Surface::new(&surface.to_mesh()).unwrap();
        assert_eq!(again.to_mesh(), surface.to_mesh());
    }

    #[test]
    fn the_fewer_triangles_are_turned() {
        for (turn, count) in [(vec![], 0), (vec![1_u32], 1), (vec![0, 3], 2), (vec![0, 2, 3], 1), (vec![0, 1, 2, 3], 0)]
        {
            let mut mesh = tetrahedron();
            for &t in &turn {
                mesh.triangles[t as usize].swap(0, 1);
            }
            let surface = Surface::new(&mesh).unwrap();
            assert_eq!(surface.turned(), count, "{turn:?}");
            surface.topology().check().unwrap();
            assert_eq!(surface.topology().edges().count(), 6);
        }
    }

    fn moebius() -> Mesh {
        let at = |i: u32| {
            let angle = std::f64::consts::TAU * f64::from(i / 2) / 5.0;
            let across = if i.is_multiple_of(2) { 0.3 } else { -0.3 };
            let r = 1.0 + across * (0.5 * angle).cos();
            [r * angle.cos(), r * angle.sin(), across * (0.5 * angle).sin()]
        };
        let strip = (0..5).flat_map(|k| {
            let [a, b] = [2 * k, 2 * k + 1];
            let [c, d] = if k < 4 { [a + 2, b + 2] } else { [1, 0] };
            [[a, b, c], [b, d, c]]
        });
        Mesh { points: (0..10).map(at).collect(), triangles: strip.collect(), ..Mesh::default() }
    }

    #[test]
    fn what_makes_no_surface_is_named_with_its_place() {
        let message = |change: &dyn Fn(&mut Mesh)| {
            let mut mesh = tetrahedron();
            change(&mut mesh);
            let error = Surface::new(&mesh).unwrap_err();
            assert!(!error.help().is_empty());
            error.to_string()
        };
        for (message, expected) in [
            (message(&|m| *m = Mesh::default()), "invalid domain: no triangles"),
            (message(&|m| m.points[1][2] = f64::NAN), "a coordinate is not finite at vertex 2 (1, 0, NaN)"),
            (message(&|m| m.triangles[1][2] = 4), "invalid mesh: vertex 4 (from 0) does not exist at a list of 4"),
            (message(&|m| m.triangles[1] = [3, 1, 3]), "triangle 2 has a vertex twice at vertex 4 (0, 0, 1)"),
            (message(&|m| m.points[3] = [0.5, 0.0, 0.0]), "triangle 2 has no area at vertex 1 (0, 0, 0), vertex 2"),
            (message(&|m| m.points[3] = [1.0, 0.0, 0.0]), "triangle 2 has no area"),
            (
                message(&|m| m.triangles.push([3, 2, 1])),
                "triangles 3 and 5 have the same vertices at vertex 2 (1, 0, 0)",
            ),
            (
                message(&|m| {
                    m.points.push([5.0, 5.0, 5.0]);
                    m.triangles.push([0, 1, 4]);
                }),
                "an edge of 3 triangles (among them 1, 2 and 5) at vertex 1 (0, 0, 0) - vertex 2 (1, 0, 0)",
            ),
            (
                message(&|m| {
                    m.points.extend([[0.0, 0.0, 2.0], [1.0, 0.0, 2.0]]);
                    m.triangles.push([3, 4, 5]);
                }),
                "triangles that meet in a point only at vertex 4 (0, 0, 1)",
            ),
            (message(&|m| *m = moebius()), "a one-sided surface: its triangles cannot all turn the same way at vertex"),
            (
                message(&|m| (m.edges, m.edge_labels) = (vec![[0, 1], [1, 0]], vec![5, 6])),
                "edges 1 and 2 of the list are one, with different labels at vertex 2 (1, 0, 0) - vertex 1 (0, 0, 0)",
            ),
            (
                message(&|m| {
                    m.triangles.pop();
                    m.points.push([1.0; 3]);
                    m.edges = vec![[0, 1], [0, 4]];
                }),
                "edge 2 of the list is no edge of a triangle at vertex 1 (0, 0, 0) - vertex 5 (1, 1, 1)",
            ),
        ] {
            assert!(message.contains(expected), "{message}");
        }
    }
}
