//! Why an edge cannot be of unit length: what has to be kept (borders, features, corners, required edges), how dense vertices are
//! around it, or a metric that turns too fast for straight edges.

use super::super::planar_quality::edge_length;
use super::{Around, RANGE, is_unit};
use crate::elementary::Elementary;
use crate::geodesic::bowed_chord;
use crate::geometry::{Point, Vector, from_frame};
use crate::lists::{Rows, distinct, in_order, marked};
use crate::mesh::{Edges, Mesh, Network};
use crate::metric::MetricField;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_3;

/// How what has to be kept bears on an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Forced {
    /// It does not.
    No,
    /// The edge is short, and joins two places of borders or features across the domain.
    Across,
    /// The edge is kept as it is, or ends where such an edge does.
    Kept,
}

impl Forced {
    /// Of all edges of a mesh, in order, by their metric lengths.
    pub(super) fn of(curves: &Curves, edges: &[[u32; 2]], lengths: &[f64]) -> Vec<Self> {
        let mut crowded = vec![false; curves.is_on.len()];
        let mut all = vec![Forced::No; lengths.len()];
        for ((ends, &length), forced) in edges.iter().zip(lengths).zip(&mut all) {
            if is_unit(length) {
                continue;
            }
            let kept = curves.kept.get(ends);
            let both = |list: &[bool]| length < 1.0 && ends.iter().all(|&v| list[v as usize]);
            if kept.is_some_and(|kept| kept.is_required || both(&curves.is_corner)) {
                for &v in ends {
                    crowded[v as usize] = true;
                }
            } else if kept.is_none() && both(&curves.is_on) {
                *forced = Forced::Across;
            }
        }
        for (ends, forced) in edges.iter().zip(&mut all) {
            if ends.iter().any(|&v| crowded[v as usize]) {
                *forced = Forced::Kept;
            }
        }
        all
    }
}

/// What has to be kept of a mesh.
pub(super) struct Curves {
    /// The edges of borders and features, by their vertices.
    kept: BTreeMap<[u32; 2], Kept>,
    /// Vertices on them, and required ones.
    is_on: Vec<bool>,
    /// Vertices that cannot slide along them.
    is_corner: Vec<bool>,
}

#[derive(Clone, Copy, Default)]
struct Kept {
    label: i32,
    is_required: bool,
}

impl Curves {
    /// Curves that turn by more than `corner` (radians) in a vertex have a corner there.
    pub(super) fn of(mesh: &Mesh, edges: &Edges, corner: f64) -> Self {
        let kept = kept(mesh, edges);
        let network = Network::new(mesh.points.len(), kept.keys().copied());
        let marks: Vec<Kept> = kept.values().copied().collect();
        // Whether a vertex cannot slide along borders and features.
        let is_corner = |&v: &u32| {
            let &[e, f] = network.at(v) else { return true };
            let [p, at, q] = [network.across(v, e), v, network.across(v, f)].map(|v| mesh.position(v));
            let (to, from) = (at - p, q - at);
            let turn = to.cross(from).norm().arctangent_over(to.dot(from));
            let [before, after] = [e, f].map(|i| marks[i as usize]);
            before.label != after.label || before.is_required || after.is_required || turn > corner
        };
        let listed = || mesh.corners.iter().chain(&mesh.required_points).copied();
        let is_corner = marked(mesh.points.len(), listed().chain(network.vertices().filter(is_corner)));
        let is_on = marked(mesh.points.len(), listed().chain(network.vertices()));
        Self { kept, is_on, is_corner }
    }

    /// Whether all of these vertices are on borders or features, or required.
    pub(super) fn has_all(&self, vertices: &[u32]) -> bool {
        vertices.iter().all(|&v| self.is_on[v as usize])
    }
}

/// The edges of one triangle, and those that the mesh lists, as far as they are edges of triangles.
fn kept(mesh: &Mesh, edges: &Edges) -> BTreeMap<[u32; 2], Kept> {
    let single = edges.iter().filter(|sides| sides.len() != 2);
    let mut kept: BTreeMap<[u32; 2], Kept> = single.map(|sides| (sides[0].ends, Kept::default())).collect();
    for (i, &ends) in mesh.edges.iter().enumerate().filter(|(_, ends)| !edges.at(**ends).is_empty()) {
        let label = mesh.edge_labels.get(i).copied().unwrap_or(0);
        kept.insert(in_order(ends), Kept { label, is_required: false });
    }
    for &ends in mesh.required_edges.iter().filter_map(|&i| mesh.edges.get(i as usize)) {
        kept.entry(in_order(ends)).and_modify(|kept| kept.is_required = true);
    }
    kept
}

/// An edge with its metric length, and how what has to be kept bears on it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judged {
    pub(super) ends: [u32; 2],
    pub(super) length: f64,
    pub(super) forced: Forced,
}

/// The edges around some of a mesh: those at an end of one of these, or at a neighbour of such an end.
pub(super) struct Density {
    /// In order.
    edges: Vec<Judged>,
    /// Those at each vertex.
    at: Rows<u32>,
}

impl Density {
    /// What it is of: of all edges, in order, those around some.
    pub(super) fn near<I: Iterator<Item = Judged>>(
        vertices: usize,
        asked: &[Judged],
        all: impl Fn() -> I,
    ) -> Vec<Judged> {
        let is_end = marked(vertices, asked.iter().flat_map(|edge| edge.ends));
        let touching = all().filter(|edge| edge.ends.iter().any(|&v| is_end[v as usize]));
        let is_near = marked(vertices, touching.flat_map(|edge| edge.ends));
        let around = || all().filter(|edge| edge.ends.iter().any(|&v| is_near[v as usize]));
        let mut edges = Vec::with_capacity(around().count());
        edges.extend(around());
        edges
    }

    /// Of these edges.
    pub(super) fn of(vertices: usize, edges: Vec<Judged>) -> Self {
        let at = Rows::new(vertices, (0..).zip(&edges).flat_map(|(e, edge)| edge.ends.map(|v| (v, e))));
        Self { edges, at }
    }

    /// Whether an edge's length is what it is because of the density around: of the edges at its ends and at their neighbours
    /// the logarithms of lengths spread (standard deviation) no more than those of unit edges may, their mean is the greater
    /// part of the edge's own, and what is left of that is in the range of unit edges.
    pub(super) fn explains(&self, edge: &Judged) -> bool {
        let logarithms: Vec<f64> = self.patch(edge).into_iter().map(Elementary::logarithm).collect();
        let count = logarithms.len() as f64;
        let mean = logarithms.iter().sum::<f64>() / count;
        let variance = logarithms.iter().map(|logarithm| (logarithm - mean).powi(2)).sum::<f64>() / count;
        let own = edge.length.logarithm();
        variance <= RANGE * RANGE && (own - mean).abs() <= RANGE && mean / own >= 0.5
    }

    /// The lengths of edges at the ends of an edge and at their neighbours, in order, without those that are forced.
    fn patch(&self, edge: &Judged) -> Vec<f64> {
        let around = |v: u32| self.at.row(v as usize).iter().copied();
        let vertices = edge.ends.into_iter().flat_map(around).flat_map(|e| self.edges[e as usize].ends);
        let edges = distinct(distinct(vertices).into_iter().flat_map(around));
        let told = edges.into_iter().map(|e| self.edges[e as usize]).filter(|edge| edge.forced == Forced::No);
        told.map(|edge| edge.length).collect()
    }
}

/// From the middle of a unit triangle to its corners.
const FRAC_1_SQRT_3: f64 = 0.577_350_269_189_625_8;

/// So many ways to lay a triangle around a point are tried, evenly turned against each other.
const TURNS: u32 = 6;

/// Whether no unit triangle of the metric at the origin, laid around it in any of [`TURNS`] ways, has straight edges that are
/// unit edges of the metric as it varies. Edges along which there is no metric do not count as failures: it may end with the domain.
pub(super) fn straight_edges_fail(field: &dyn MetricField) -> bool {
    let frame = field.at(Point::default()).cholesky();
    let is_unit = |p: Point, q: Point| edge_length([p, q], field).map_or(true, is_unit);
    let third = 2.0 * FRAC_PI_3;
    let fits = |turn: u32| {
        let first = third * f64::from(turn) / f64::from(TURNS);
        let corner = |i: f64| {
            let (sin, cos) = (first + third * i).sine_and_cosine();
            Point::default() + from_frame(frame, Vector::new(cos, sin) * FRAC_1_SQRT_3)
        };
        let [a, b, c] = [0.0, 1.0, 2.0].map(corner);
        is_unit(a, b) && is_unit(b, c) && is_unit(c, a)
    };
    !(0..TURNS).any(fits)
}

/// Whether an edge is long, and its geodesic is shorter by the greater part of that, by logarithms.
pub(super) fn bends(around: &Around, length: f64) -> bool {
    let [p, q] = [Point::default() - around.half, Point::default() + around.half];
    let geodesic = bowed_chord(around.field.as_ref(), p, q);
    length > 1.0 && length > geodesic * length.sqrt()
}
