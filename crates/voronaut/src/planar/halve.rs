//! Edges cut in two, many at once: the triangulation is made anew, in the order in which it was.

use super::{Planar, is_left};
use crate::geometry::Point;
use crate::triangulation::{Constraint, FaceId, HalfEdge, Triangulation, VertexId};

/// What a vertex was before edges were cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// This vertex.
    Vertex(VertexId),
    /// A place on this edge, given by one of its sides.
    Edge(HalfEdge),
}

/// No cut, and no number yet.
const NONE: u32 = u32::MAX;

impl Planar {
    /// The triangulation with edges cut at points on them, and what each of its vertices was. Constraints and regions are kept, lengths are
    /// not. Where rounding would turn a triangle over, the edges of its face stay whole. Vertices and faces are numbered in the order of the
    /// faces before.
    pub(crate) fn halved(&self, cuts: &[(HalfEdge, Point)]) -> (Planar, Vec<Origin>) {
        let cutting = Cutting::new(self, cuts);
        let mut made =
            Made { vertex: vec![NONE; self.positions.len()], cut: vec![NONE; cuts.len()], ..Made::default() };
        for f in self.topology.faces() {
            for triangle in cutting.parts(f) {
                made.push(&cutting, triangle, f);
            }
        }
        let mut topology = Triangulation::from_triangles(made.origins.len(), &made.triangles, &made.regions);
        for (h, constraint) in made.constraints {
            topology.set_constraint(h, constraint);
        }
        (Planar { topology, positions: made.positions }, made.origins)
    }
}

/// A corner of a new triangle: a vertex, or the cut of this number.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Corner {
    Vertex(VertexId),
    Cut(u32),
}

struct Cutting<'a> {
    planar: &'a Planar,
    cuts: &'a [(HalfEdge, Point)],
    /// The cut of each half-edge.
    of: Vec<u32>,
}

impl<'a> Cutting<'a> {
    fn new(planar: &'a Planar, cuts: &'a [(HalfEdge, Point)]) -> Self {
        let mut cutting = Self { planar, cuts, of: vec![NONE; 3 * planar.topology.face_slots()] };
        for (i, &(h, _)) in cuts.iter().enumerate() {
            planar.topology.sides(h).for_each(|h| cutting.of[h.index()] = i as u32);
        }
        let mut pending: Vec<FaceId> =
            cuts.iter().flat_map(|&(h, _)| planar.topology.sides(h)).map(HalfEdge::face).collect();
        while let Some(f) = pending.pop() {
            if cutting.parts(f).all(|triangle| cutting.stands(triangle)) {
                continue;
            }
            for h in f.half_edges().into_iter().filter(|h| cutting.of[h.index()] != NONE).collect::<Vec<_>>() {
                for side in planar.topology.sides(h) {
                    cutting.of[side.index()] = NONE;
                    pending.push(side.face());
                }
            }
        }
        cutting
    }

    /// The triangles that a face becomes.
    fn parts(&self, f: FaceId) -> impl Iterator<Item = [Corner; 3]> + use<> {
        let sides = f.half_edges();
        let cuts = sides.map(|h| Some(self.of[h.index()]).filter(|&cut| cut != NONE).map(Corner::Cut));
        let corners = self.planar.topology.corners(f).map(Corner::Vertex);
        // Turned so that the sides that are cut come first.
        let turn = match cuts.map(|cut| cut.is_some()) {
            [false, true, _] => 1,
            [_, false, true] => 2,
            _ => 0,
        };
        let [a, b, c] = [0, 1, 2].map(|i| corners[(i + turn) % 3]);
        let parts = match [0, 1, 2].map(|i| cuts[(i + turn) % 3]) {
            [Some(p), Some(q), Some(r)] => [Some([a, p, r]), Some([p, b, q]), Some([r, q, c]), Some([p, q, r])],
            [Some(p), Some(q), None] => [Some([p, b, q]), Some([p, q, c]), Some([a, p, c]), None],
            [Some(p), None, None] => [Some([a, p, c]), Some([p, b, c]), None, None],
            _ => [Some([a, b, c]), None, None, None],
        };
        parts.into_iter().flatten()
    }

    fn position(&self, corner: Corner) -> Point {
        match corner {
            Corner::Vertex(v) => self.planar.position(v),
            Corner::Cut(i) => self.cuts[i as usize].1,
        }
    }

    fn stands(&self, triangle: [Corner; 3]) -> bool {
        let [a, b, c] = triangle.map(|corner| self.position(corner));
        is_left(a, b, c)
    }

    /// The side of a face that an edge between two corners is part of, if it is one.
    fn side(&self, f: FaceId, ends: [Corner; 2]) -> Option<HalfEdge> {
        let topology = &self.planar.topology;
        let is_on = |h: HalfEdge, corner: Corner| match corner {
            Corner::Vertex(v) => topology.ends(h).contains(&v),
            Corner::Cut(i) => self.of[h.index()] == i,
        };
        f.half_edges().into_iter().find(|&h| ends.into_iter().all(|corner| is_on(h, corner)))
    }
}

/// What is made.
#[derive(Default)]
struct Made {
    /// The new number of each vertex, and of each cut.
    vertex: Vec<u32>,
    cut: Vec<u32>,
    origins: Vec<Origin>,
    positions: Vec<Point>,
    triangles: Vec<[u32; 3]>,
    regions: Vec<i32>,
    constraints: Vec<(HalfEdge, Constraint)>,
}

impl Made {
    fn push(&mut self, cutting: &Cutting, triangle: [Corner; 3], f: FaceId) {
        let topology = &cutting.planar.topology;
        for i in 0..3 {
            let constraint =
                cutting.side(f, [triangle[i], triangle[(i + 1) % 3]]).and_then(|side| topology.constraint(side));
            let h = HalfEdge((3 * self.triangles.len() + i) as u32);
            self.constraints.extend(constraint.map(|constraint| (h, constraint)));
        }
        let numbers = triangle.map(|corner| self.number(cutting, corner));
        self.triangles.push(numbers);
        self.regions.push(topology.region(f));
    }

    fn number(&mut self, cutting: &Cutting, corner: Corner) -> u32 {
        let (slot, origin) = match corner {
            Corner::Vertex(v) => (&mut self.vertex[v.index()], Origin::Vertex(v)),
            Corner::Cut(i) => (&mut self.cut[i as usize], Origin::Edge(cutting.cuts[i as usize].0)),
        };
        if *slot == NONE {
            *slot = self.origins.len() as u32;
            self.origins.push(origin);
            self.positions.push(cutting.position(corner));
        }
        *slot
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar::delaunay;

    /// Scattered points, of whose triangulation one edge inside is constrained and one face has a region of its own.
    fn scattered() -> Planar {
        let points: Vec<Point> = (0..40).map(|i| Point::new(f64::from(i * 7 % 40), f64::from(i * i % 23))).collect();
        let mut planar = delaunay(&points).unwrap();
        let edge = planar.topology.edges().find(|&h| planar.topology.twin(h).is_some()).unwrap();
        planar.topology.set_constraint(edge, Constraint(3));
        planar
    }

    fn middles(planar: &Planar, which: impl Fn(usize) -> bool) -> Vec<(HalfEdge, Point)> {
        let edges = planar.topology.edges().enumerate().filter(|&(i, _)| which(i));
        edges.map(|(_, h)| (h, planar.ends(h)[0].midpoint(planar.ends(h)[1]))).collect()
    }

    #[test]
    fn any_edges_can_be_halved() {
        let planar = scattered();
        let constrained = |planar: &Planar| {
            let edges = planar.topology.edges().filter(|&h| planar.topology.constraint(h) == Some(Constraint(3)));
            edges.map(|h| planar.ends(h)[0].distance(planar.ends(h)[1])).collect::<Vec<f64>>()
        };
        for every in [1, 2, 3, 5, usize::MAX] {
            let cuts = middles(&planar, |i| i.is_multiple_of(every));
            let (halved, origins) = planar.halved(&cuts);
            halved.topology.check().unwrap();
            assert!(halved.is_embedded());
            assert_eq!(halved.topology.vertex_count(), planar.topology.vertex_count() + cuts.len());
            assert!((halved.area() - planar.area()).abs() < 1e-9 * planar.area());
            assert!((constrained(&halved).iter().sum::<f64>() - constrained(&planar)[0]).abs() < 1e-12);
            for (&origin, &p) in origins.iter().zip(&halved.positions) {
                match origin {
                    Origin::Vertex(v) => assert_eq!(p, planar.position(v)),
                    Origin::Edge(h) => assert!(cuts.contains(&(h, p))),
                }
            }
        }
        let all = middles(&planar, |_| true);
        assert_eq!(planar.halved(&all).0.topology.face_count(), 4 * planar.topology.face_count());
    }

    #[test]
    fn where_a_cut_would_turn_a_triangle_over_edges_stay_whole() {
        let planar = scattered();
        let mut cuts = middles(&planar, |_| true);
        // Far off its edge.
        let (bad, _) = cuts[20];
        cuts[20].1 = Point::new(1e3, 1e3);
        let (halved, origins) = planar.halved(&cuts);
        halved.topology.check().unwrap();
        assert!(halved.is_embedded() && !origins.contains(&Origin::Edge(bad)));
        let whole = cuts.len() + planar.topology.vertex_count() - halved.topology.vertex_count();
        assert!((1..=5).contains(&whole), "{whole}");
    }
}
