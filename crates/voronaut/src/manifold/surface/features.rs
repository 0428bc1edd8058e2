//! Features of a surface, which a mesh of it has to keep, and the curves they make: chains from stop to stop, or closed.

use super::super::Place;
use super::Surface;
use crate::elementary::Elementary;
use crate::geometry::{Point3, Vector3};
use crate::lists::{Classes, distinct};
use crate::mesh::Network;
use crate::triangulation::{Constraint, HalfEdge, VertexId};
use std::collections::{BTreeMap, BTreeSet};

/// What counts as a feature besides borders, edges of the input's list, and edges between triangles of different labels.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct FeatureOptions {
    /// Edges where the normal turns by more than this angle (degrees) are creases, and features that turn by more have a
    /// corner there; `None`: neither is looked for.
    pub ar: Option<f64>,
}

impl FeatureOptions {
    /// The angle (degrees) unless another is given.
    pub const DEFAULT_ANGLE: f64 = 45.0;
}

impl Default for FeatureOptions {
    fn default() -> Self {
        Self { ar: Some(Self::DEFAULT_ANGLE) }
    }
}

/// The label of curves along which a surface was cut to be meshed in parts: from stop to stop they are one edge of the mesh, in each part.
pub(crate) const CUT: i32 = i32::MIN;

/// What is known of a feature edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Mark {
    /// The user's label; 0 for none.
    pub label: i32,
    /// Whether the surface has a crease there, or ends, as far as it was looked for or is listed.
    pub is_ridge: bool,
    /// Whether it has to stay as it is.
    pub is_required: bool,
}

impl Surface {
    /// Whether an edge is a feature whatever its angle: of the list, of a required triangle, on the border, between labels.
    pub(super) fn is_given(&self, h: HalfEdge) -> bool {
        self.feature(h, &FeatureOptions { ar: None }).is_some()
    }

    /// What the input says of an edge, and what its triangles do; `None` of an edge that is no feature.
    pub(crate) fn feature(&self, h: HalfEdge, options: &FeatureOptions) -> Option<Mark> {
        let t = &self.topology;
        let listed = t.constraint(h).map(|Constraint(i)| self.marks[i as usize]);
        let is_required = [Some(h), t.twin(h)].into_iter().flatten().any(|side| self.is_required(side));
        let is_ridge = options.ar.is_some_and(|angle| self.turns(h, angle));
        let is_interface = t.twin(h).is_none_or(|twin| t.region(twin.face()) != t.region(h.face()));
        let mark = listed.unwrap_or_default();
        (listed.is_some() || is_required || is_ridge || is_interface).then_some(Mark {
            label: mark.label,
            is_ridge: mark.is_ridge || is_ridge,
            is_required: mark.is_required || is_required,
        })
    }

    fn is_required(&self, side: HalfEdge) -> bool {
        self.required_triangles.binary_search(&side.face()).is_ok()
    }

    /// Whether the normals on both sides of an edge differ by more than an angle. At the border the surface turns back.
    fn turns(&self, h: HalfEdge, angle: f64) -> bool {
        let Some(twin) = self.topology.twin(h) else { return true };
        self.normal(h.face()).dot(self.normal(twin.face())) < angle.to_radians().cosine()
    }
}

/// The features of a surface as curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct FeatureGraph {
    /// The curves; every feature edge is in one.
    pub curves: Vec<Curve>,
    /// Vertices that have to be kept, on curves or not, in order: corners, required ones, those where marks change.
    pub stops: Vec<VertexId>,
    /// Those among them where curves end, bend or fork, or that the input calls corners, in order.
    pub corners: Vec<VertexId>,
}

/// A chain of feature edges between two stops, which may be one, or a closed one without any.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Curve {
    /// Its edges, one after the other.
    pub edges: Vec<CurveEdge>,
    /// What all of its edges are.
    pub mark: Mark,
    /// Whether it ends at stops; else it is closed.
    pub has_stops: bool,
}

/// An edge of a curve, with its sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CurveEdge {
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

/// Creases found by their angle that end inside a smooth part after fewer edges than this are noise of a coarse mesh, or of a scan, and so
/// are those that hang together in fewer: the least solid, a tetrahedron, has six.
const LEAST_CREASE: usize = 5;

impl Surface {
    /// Its features as curves, cut at stops: where one ends, forks, bends by more than the angle of the options, where marks
    /// change, at corners and required vertices of the input and at the ends of required edges. A vertex whose normal is farther than that
    /// angle from those of all its triangles, the apex of a cone, is a corner on no curve. Creases of fewer than five
    /// edges that end inside a patch, or touch no other, do not count, unless the input lists them.
    pub(crate) fn curves(&self, options: &FeatureOptions) -> FeatureGraph {
        let features = Features::of(self, options);
        let vertices = || features.network.vertices().map(VertexId);
        let bends = vertices().filter(|&v| features.is_corner(v, options.ar));
        // Vertices of no triangle belong to nothing, whatever the input calls them.
        let [corners, required] = [&self.corners, &self.required_points]
            .map(|listed| listed.iter().copied().filter(|&v| self.topology.start(v).is_some()));
        let tips = options.ar.map(|angle| self.tips(angle)).unwrap_or_default();
        let is_alone = |v: &VertexId| features.network.at(v.0).is_empty();
        let tips = tips.into_iter().map(|tip| tip.0).filter(is_alone);
        let corners: BTreeSet<VertexId> = corners.chain(bends).chain(tips).collect();
        let changes = vertices().filter(|&v| features.changes(v));
        let stops: BTreeSet<VertexId> = corners.iter().copied().chain(required).chain(changes).collect();
        let curves = features.curves(&stops);
        FeatureGraph { curves, stops: stops.into_iter().collect(), corners: corners.into_iter().collect() }
    }
}

/// Feature edges and how they hang together.
struct Features<'a> {
    surface: &'a Surface,
    edges: Vec<(CurveEdge, Mark)>,
    network: Network,
}

impl<'a> Features<'a> {
    fn of(surface: &'a Surface, options: &FeatureOptions) -> Self {
        let found = surface.topology.edges().filter_map(|h| Some((h, surface.feature(h, options)?)));
        let edges: Vec<(CurveEdge, Mark)> = found.map(|(h, mark)| (CurveEdge::of(surface, h), mark)).collect();
        let ends = edges.iter().map(|(edge, _)| [edge.from.0, edge.to.0]);
        let network = Network::new(surface.positions.len(), ends);
        let mut features = Self { surface, edges, network };
        features.prune_ends();
        features.prune_specks();
        features
    }

    /// Takes away creases found by angle that hang together in few edges: most are three around a dent.
    fn prune_specks(&mut self) {
        let network = &mut self.network;
        let mut parts = Classes::new(self.surface.positions.len());
        let left: Vec<u32> = distinct(network.vertices().flat_map(|v| network.at(v)).copied());
        for &i in &left {
            let (edge, _) = self.edges[i as usize];
            parts.join(edge.from.0, edge.to.0);
        }
        let mut edges_of: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for i in left {
            edges_of.entry(parts.of(self.edges[i as usize].0.from.0)).or_default().push(i);
        }
        let is_given = |&i: &u32| self.edges[i as usize].0.sides[0].is_some_and(|h| self.surface.is_given(h));
        let specks = edges_of.into_values().filter(|part| part.len() < LEAST_CREASE && !part.iter().any(is_given));
        specks.flatten().for_each(|i| network.remove(i));
    }

    /// Takes away creases found by angle that are short and end nowhere, again and again.
    fn prune_ends(&mut self) {
        let network = &mut self.network;
        let mut ends: Vec<u32> = network.vertices().filter(|&v| network.at(v).len() == 1).collect();
        while let Some(end) = ends.pop() {
            let (mut v, mut chain) = (end, Vec::new());
            while let Some(&i) = network.at(v).iter().find(|i| !chain.contains(*i)) {
                let is_given = self.edges[i as usize].0.sides[0].is_some_and(|h| self.surface.is_given(h));
                if is_given || chain.len() == LEAST_CREASE || (v != end && network.at(v).len() != 2) {
                    break;
                }
                chain.push(i);
                v = network.across(v, i);
            }
            if (1..LEAST_CREASE).contains(&chain.len()) {
                for i in chain {
                    network.remove(i);
                }
                ends.extend((network.at(v).len() == 1).then_some(v));
            }
        }
    }

    /// The edge leaving a vertex.
    fn leaving(&self, v: VertexId, i: u32) -> CurveEdge {
        let edge = self.edges[i as usize].0;
        if edge.from == v { edge } else { edge.turned() }
    }

    /// Whether curves end or fork at a vertex, or bend by more than the angle.
    fn is_corner(&self, v: VertexId, angle: Option<f64>) -> bool {
        let &[i, j] = self.network.at(v.0) else { return true };
        let [e, f] = [i, j].map(|i| self.leaving(v, i).direction(self.surface));
        angle.is_some_and(|angle| -e.dot(f) < angle.to_radians().cosine())
    }

    /// Whether the edges at a vertex differ in what they are, or one is required.
    fn changes(&self, v: VertexId) -> bool {
        let mut kinds = self.network.at(v.0).iter().map(|&i| {
            let (edge, mark) = self.edges[i as usize];
            (edge.sides.contains(&None), mark)
        });
        let first = kinds.clone().next();
        kinds.any(|kind| kind.1.is_required || Some(kind) != first)
    }

    fn curves(&self, stops: &BTreeSet<VertexId>) -> Vec<Curve> {
        let curve = |(start, chain): (u32, Vec<u32>)| {
            let mark = self.edges[chain[0] as usize].1;
            let mut at = VertexId(start);
            let next = |i| {
                let edge = self.leaving(at, i);
                at = edge.to;
                edge
            };
            Curve { edges: chain.into_iter().map(next).collect(), mark, has_stops: stops.contains(&VertexId(start)) }
        };
        self.network.chains(|v| stops.contains(&VertexId(v))).into_iter().map(curve).collect()
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
        assert_eq!(unlabelled.curves(&FeatureOptions { ar: None }), FeatureGraph::default());
        assert_eq!(unlabelled.curves(&FeatureOptions { ar: Some(91.0) }), FeatureGraph::default());
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

    /// A frustum with so many sides, wider at the top, where edges turn by 100 degrees.
    fn frustum(sides: u32) -> Surface {
        let ring = |z: f64, radius: f64| {
            let angle = move |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(sides);
            (0..sides).map(move |i| [radius * angle(i).cos(), radius * angle(i).sin(), z])
        };
        // Of the walls' distances from the axis.
        let wall = (std::f64::consts::PI / f64::from(sides)).cos();
        let points = ring(0.0, (1.0 - 0.1763) / wall).chain(ring(1.0, 1.0 / wall)).collect();
        let next = |i: u32| (i + 1) % sides;
        let walls = (0..sides).flat_map(|i| [[i, next(i), sides + next(i)], [i, sides + next(i), sides + i]]);
        let ends = (1..sides - 1).flat_map(|i| [[0, i + 1, i], [sides, sides + i, sides + i + 1]]);
        Surface::new(&Mesh { points, triangles: walls.chain(ends).collect(), ..Mesh::default() }).unwrap()
    }

    #[test]
    fn creases_of_fewer_than_five_edges_alone_are_noise() {
        let found = |sides| frustum(sides).curves(&FeatureOptions { ar: Some(93.0) });
        assert_eq!(found(4), FeatureGraph::default());
        assert_eq!(found(5).curves.iter().map(|curve| curve.edges.len()).sum::<usize>(), 5);
    }

    #[test]
    fn vertices_of_no_triangle_are_no_stops() {
        let cube = cube();
        let (alone, own) = (cube.points.len() as u32, cube.triangles[0][0]);
        let points = cube.points.iter().copied().chain([[9.0; 3]]).collect();
        let (corners, required_points) = (vec![own, alone], vec![alone]);
        let mesh = Mesh { points, corners, required_points, ..cube };
        let found = Surface::new(&mesh).unwrap().curves(&FeatureOptions { ar: None });
        assert!(found.stops.contains(&VertexId(own)) && !found.stops.contains(&VertexId(alone)), "{:?}", found.stops);
        assert!(!found.corners.contains(&VertexId(alone)));
    }
}
