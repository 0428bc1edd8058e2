//! Feature curves: chains of feature edges from stop to stop, or closed.

use super::features::{FeatureOptions, Mark};
use super::{Place, Surface};
use crate::geometry::{Point3, Vector3};
use crate::triangulation::{HalfEdge, VertexId};
use std::collections::BTreeSet;

/// The features of a surface as curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// The curves; every feature edge is in one.
    pub curves: Vec<Curve>,
    /// Vertices that have to be kept, on curves or not, in order: corners, required ones, those where marks change.
    pub stops: Vec<VertexId>,
    /// Those among them where curves end, bend or fork, or that the input calls corners, in order.
    pub corners: Vec<VertexId>,
}

/// A chain of feature edges between two stops, which may be one, or a closed one without any.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its edges, one after the other.
    pub edges: Vec<CurveEdge>,
    /// What all of its edges are.
    pub mark: Mark,
    /// Whether it ends at stops; else it is closed.
    pub has_stops: bool,
}

/// An edge of a curve, with its sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CurveEdge {
    /// Where it begins.
    pub from: VertexId,
    /// Where it ends.
    pub to: VertexId,
    /// The half-edge in this direction, if a triangle has it, and that against it.
    pub sides: [Option<HalfEdge>; 2],
}

impl Curve {
    /// The first vertex and the last.
    pub(crate) fn ends(&self) -> [VertexId; 2] {
        [self.edges[0].from, self.edges[self.edges.len() - 1].to]
    }

    /// Whether only one triangle has each edge.
    pub(crate) fn is_border(&self) -> bool {
        self.edges[0].sides.contains(&None)
    }
}

impl CurveEdge {
    fn of(surface: &Surface, h: HalfEdge) -> Self {
        let t = surface.topology();
        Self { from: t.origin(h), to: t.target(h), sides: [Some(h), t.twin(h)] }
    }

    fn turned(self) -> Self {
        Self { from: self.to, to: self.from, sides: [self.sides[1], self.sides[0]] }
    }

    /// Where it begins and ends in space.
    pub(crate) fn positions(&self, surface: &Surface) -> [Point3; 2] {
        [self.from, self.to].map(|v| surface.position(v))
    }

    fn direction(&self, surface: &Surface) -> Vector3 {
        let [a, b] = self.positions(surface);
        (b - a).unit().unwrap_or_default()
    }

    /// The place with this parameter, from 0 at the beginning to 1 at the end, in the triangle on each side. All have the same
    /// position to the bit.
    pub(crate) fn places(&self, surface: &Surface, t: f64) -> Vec<Place> {
        let [a, b] = self.positions(surface);
        let position = a.lerp(b, t);
        let on = |(side, t): (Option<HalfEdge>, f64)| {
            let h = side?;
            let mut weights = [0.0; 3];
            weights[h.index() % 3] = 1.0 - t;
            weights[h.next().index() % 3] = t;
            Some(Place { position, ..surface.place(h.face(), weights) })
        };
        [(self.sides[0], t), (self.sides[1], 1.0 - t)].into_iter().filter_map(on).collect()
    }
}

/// Creases found by their angle that end inside a smooth part after fewer edges than this are noise of a coarse mesh.
const LEAST_CREASE: usize = 5;

impl Surface {
    /// Its features as curves, cut at stops: where one ends, forks, bends by more than the angle of the options, where marks
    /// change, at corners and required vertices of the input and at the ends of required edges. Creases of fewer than five
    /// edges that end inside a patch do not count, unless the input lists them.
    pub(crate) fn curves(&self, options: &FeatureOptions) -> Curves {
        let found = self.topology.edges().filter_map(|h| Some((h, self.feature(h, options)?)));
        let edges: Vec<(CurveEdge, Mark)> = found.map(|(h, mark)| (CurveEdge::of(self, h), mark)).collect();
        let mut at: Vec<Vec<usize>> = vec![Vec::new(); self.positions.len()];
        for (i, (edge, _)) in edges.iter().enumerate() {
            at[edge.from.index()].push(i);
            at[edge.to.index()].push(i);
        }
        prune(self, &edges, &mut at);
        let network = Network { surface: self, options, edges: &edges, at: &at };
        let corners: BTreeSet<VertexId> =
            self.corners.iter().copied().chain(network.vertices().filter(|&v| network.is_corner(v))).collect();
        let stops = network.vertices().filter(|&v| network.changes(v));
        let stops: BTreeSet<VertexId> = corners.iter().chain(&self.required_points).copied().chain(stops).collect();
        let curves = network.curves(&stops);
        Curves { curves, stops: stops.into_iter().collect(), corners: corners.into_iter().collect() }
    }
}

/// Takes away creases found by angle that are short and end nowhere, again and again.
fn prune(surface: &Surface, edges: &[(CurveEdge, Mark)], at: &mut [Vec<usize>]) {
    let mut ends: Vec<VertexId> =
        (0..).map(VertexId).zip(at.iter()).filter(|(_, at)| at.len() == 1).map(|(v, _)| v).collect();
    while let Some(end) = ends.pop() {
        let (mut v, mut chain) = (end, Vec::new());
        while let Some(&i) = at[v.index()].iter().find(|i| !chain.contains(*i)) {
            let is_given = edges[i].0.sides[0].is_some_and(|h| surface.is_given(h));
            if is_given || chain.len() == LEAST_CREASE || (v != end && at[v.index()].len() != 2) {
                break;
            }
            chain.push(i);
            v = if edges[i].0.from == v { edges[i].0.to } else { edges[i].0.from };
        }
        if (1..LEAST_CREASE).contains(&chain.len()) {
            for i in chain {
                for v in [edges[i].0.from, edges[i].0.to] {
                    at[v.index()].retain(|&j| j != i);
                }
            }
            ends.extend((at[v.index()].len() == 1).then_some(v));
        }
    }
}

/// Feature edges, and those at each vertex.
struct Network<'a> {
    surface: &'a Surface,
    options: &'a FeatureOptions,
    edges: &'a [(CurveEdge, Mark)],
    at: &'a [Vec<usize>],
}

impl Network<'_> {
    /// The vertices with feature edges.
    fn vertices(&self) -> impl Iterator<Item = VertexId> {
        (0..).map(VertexId).zip(self.at).filter(|(_, at)| !at.is_empty()).map(|(v, _)| v)
    }

    /// The edge leaving a vertex.
    fn leaving(&self, v: VertexId, i: usize) -> CurveEdge {
        let edge = self.edges[i].0;
        if edge.from == v { edge } else { edge.turned() }
    }

    /// Whether curves end or fork at a vertex, or bend.
    fn is_corner(&self, v: VertexId) -> bool {
        let &[i, j] = self.at[v.index()].as_slice() else { return true };
        let [e, f] = [i, j].map(|i| self.leaving(v, i).direction(self.surface));
        self.options.ar.is_some_and(|angle| -e.dot(f) < angle.to_radians().cos())
    }

    /// Whether the edges at a vertex differ in what they are, or one is required.
    fn changes(&self, v: VertexId) -> bool {
        let mut marks = self.at[v.index()].iter().map(|&i| self.edges[i].1);
        let borders = |&i: &usize| self.edges[i].0.sides.contains(&None);
        let first = marks.clone().next();
        let is_mixed = self.at[v.index()].iter().any(borders) && !self.at[v.index()].iter().all(borders);
        is_mixed || marks.any(|mark| mark.is_required || Some(mark) != first)
    }

    /// The curves: first those from the stops, then the closed ones.
    fn curves(&self, stops: &BTreeSet<VertexId>) -> Vec<Curve> {
        let mut used = vec![false; self.edges.len()];
        let mut curves = Vec::new();
        for start in stops.iter().copied().chain(self.vertices()) {
            for &i in &self.at[start.index()] {
                if !used[i] {
                    let edges = self.follow(start, i, stops, &mut used);
                    curves.push(Curve { edges, mark: self.edges[i].1, has_stops: stops.contains(&start) });
                }
            }
        }
        curves
    }

    fn follow(&self, start: VertexId, first: usize, stops: &BTreeSet<VertexId>, used: &mut [bool]) -> Vec<CurveEdge> {
        let (mut v, mut next) = (start, Some(first));
        let mut edges = Vec::new();
        while let Some(i) = next {
            used[i] = true;
            let edge = self.leaving(v, i);
            edges.push(edge);
            v = edge.to;
            next = self.at[v.index()].iter().copied().find(|&j| !used[j]).filter(|_| !stops.contains(&v));
        }
        edges
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;

    /// The unit cube, 12 triangles, a label per side.
    fn cube() -> Mesh {
        let points = (0..8).map(|i| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)]).collect();
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Mesh { points, triangles, triangle_labels: (0..12).map(|i| i / 2).collect(), ..Mesh::default() }
    }

    #[test]
    fn a_cube_has_twelve_ridges_and_eight_corners() {
        let surface = Surface::new(&cube()).unwrap();
        let found = surface.curves(&FeatureOptions::default());
        assert_eq!((found.curves.len(), found.corners.len(), found.stops.len()), (12, 8, 8));
        assert!(found.curves.iter().all(|c| c.mark.is_ridge && c.edges.len() == 1 && c.has_stops));
        let by_labels = surface.curves(&FeatureOptions { ar: None });
        assert_eq!((by_labels.curves.len(), by_labels.corners.len()), (12, 8));
        assert!(by_labels.curves.iter().all(|c| !c.mark.is_ridge));
        let unlabelled = Surface::new(&Mesh { triangle_labels: Vec::new(), ..cube() }).unwrap();
        assert_eq!(unlabelled.curves(&FeatureOptions { ar: None }), Curves::default());
        assert_eq!(unlabelled.curves(&FeatureOptions { ar: Some(91.0) }), Curves::default());
    }

    #[test]
    fn required_points_stop_a_curve_and_labels_change_it() {
        let mesh = Mesh {
            points: vec![[0., 0., 0.], [1., 0., 0.], [2., 0.1, 0.], [3., 0., 0.], [1.5, 2., 0.]],
            triangles: vec![[0, 1, 4], [1, 2, 4], [2, 3, 4]],
            edges: vec![[0, 1], [1, 2], [2, 3]],
            edge_labels: vec![5, 5, 6],
            required_points: vec![1],
            ..Mesh::default()
        };
        let found = Surface::new(&mesh).unwrap().curves(&FeatureOptions::default());
        assert_eq!(found.corners, [0, 3, 4].map(VertexId));
        assert_eq!(found.stops, [0, 1, 2, 3, 4].map(VertexId));
        assert!(found.curves.len() == 5 && found.curves.iter().all(Curve::is_border));
        let closed = Surface::new(&mesh).unwrap().curves(&FeatureOptions { ar: None });
        assert_eq!((closed.corners.len(), closed.stops), (0, [0, 1, 2, 3].map(VertexId).to_vec()));
        assert_eq!(closed.curves.len(), 4);
    }
}
