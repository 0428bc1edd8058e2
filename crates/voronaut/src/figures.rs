//! What runs are judged by: the diagram, the dual, the net, protection, as reports have them.

use crate::canvas::{PickCounters, StarFigures};
use crate::diagram::Ground;
use crate::dual::Road;
use crate::geodesic::MarchCounters;
use crate::net::Net;
use crate::optimise::Ending;
use crate::realisation::{Found, GeodesicEdge, Realisation};
use serde::Serialize;

/// A consistent star set. Deterministic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StarSet {
    /// The star set as it ended.
    #[serde(flatten)]
    pub figures: StarFigures,
    /// How it was refined.
    #[serde(flatten)]
    pub counters: PickCounters,
}

/// The discrete Riemannian Voronoi diagram.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagram {
    /// Canvas vertices cut off from their cell.
    pub orphans: usize,
    /// The connected sets that they form.
    pub orphan_components: usize,
    /// The nerve as canvas faces of three colours alone have it, beside the exact dual.
    pub raw_nerve: Option<RawNerve>,
    /// Work of the solver, its fields beside this one.
    #[serde(flatten)]
    pub counters: MarchCounters,
}

/// How far canvas faces of three colours are the exact dual: nothing within faces, no in-circle test.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct RawNerve {
    /// Triples of cells that share a canvas face.
    pub triangles: usize,
    /// Triangles of the exact dual that no face witnesses.
    pub missing: usize,
    /// Triples that are no triangle of the exact dual.
    pub extra: usize,
}

impl Diagram {
    /// Of a diagram as it is.
    pub fn of<'a, G: Ground<'a>>(diagram: &crate::diagram::Diagram<'a, G>) -> Self {
        let components = diagram.orphan_components();
        Self {
            orphans: components.iter().map(Vec::len).sum(),
            orphan_components: components.len(),
            raw_nerve: None,
            counters: *diagram.counters(),
        }
    }
}

/// A set of seeds as a net. Lengths are metric, in units of the mesh's edges where the metric was scaled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NetFigures {
    /// How far a point of the domain is from the nearest seed, at most.
    pub epsilon: f64,
    /// The least distance of two seeds.
    pub mu: f64,
    /// mu / epsilon.
    pub lambda: f64,
    /// The power protection of the least protected triangle with its circumcentre in the domain.
    pub delta: f64,
    /// The same as a share of epsilon.
    pub delta_over_epsilon: f64,
    /// The power protection of the least protected place where the border of two cells meets that of the domain, as a
    /// share of epsilon; null where edges do not follow the border.
    pub border_delta_over_epsilon: Option<f64>,
    /// Triangles with their circumcentre in the domain.
    pub interior: usize,
    /// Those of them that are not Delaunay: a seed is in their circle.
    pub not_delaunay: usize,
    /// The shares of epsilon below which the protection of a hundredth, a tenth and half of them is.
    pub delta_percentiles: [f64; 3],
    /// Triangles and border edges without a circle: nearly straight, or with geodesics that are not resolved.
    pub unmeasured: usize,
    /// Triangles measured by distances on a canvas, since geodesics are not resolved there.
    pub by_canvas: usize,
}

impl NetFigures {
    /// Of a net.
    pub fn of<P: Copy + PartialEq + Send + Sync>(net: &Net<P>) -> Self {
        let mut all: Vec<f64> = net.interior().map(|ball| ball.protection() / net.epsilon).collect();
        all.sort_unstable_by(f64::total_cmp);
        let at = |share: f64| all.get((share * all.len() as f64) as usize).copied().unwrap_or(f64::NAN);
        Self {
            epsilon: net.epsilon,
            mu: net.mu,
            lambda: net.lambda(),
            delta: net.delta(),
            delta_over_epsilon: net.delta() / net.epsilon,
            border_delta_over_epsilon: (!net.border.is_empty()).then(|| net.border_delta() / net.epsilon),
            interior: all.len(),
            not_delaunay: net.interior().filter(|ball| ball.power < 0.0).count(),
            delta_percentiles: [0.01, 0.1, 0.5].map(at),
            unmeasured: net.unmeasured,
            by_canvas: net.by_canvas,
        }
    }
}

/// How seeds were moved until they were protected. Deterministic.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Protection {
    /// The share of epsilon asked for.
    pub asked: f64,
    /// Why it ended.
    pub ending: Ending,
    /// Rounds of moves.
    pub rounds: usize,
    /// Moves of seeds.
    pub moves: u64,
    /// Places tried for them.
    pub tries: u64,
    /// Interior triangles, and in the plane border edges, that were not protected before.
    pub unprotected_before: usize,
    /// Those that are not protected in the end.
    pub unprotected: usize,
    /// The nerve of the seeds that a canvas shows by itself.
    pub raw_nerve: CanvasNerve,
}

/// The raw nerve of seeds on a canvas that, in the plane, was refined for them. Deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CanvasNerve {
    /// Vertices of the canvas.
    pub canvas_vertices: usize,
    /// Rounds of refinement around Voronoi vertices that it did not tell apart.
    pub rounds: u32,
    /// Places where it still does not; of a surface, where it does not show three cells that meet.
    pub unwitnessed: usize,
    /// The nerve, beside the exact dual.
    #[serde(flatten)]
    pub nerve: RawNerve,
}

/// The dual: how its edges were settled, and how sure that is. Deterministic.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Dual {
    /// In-circle tests settled by each level of the filter.
    pub geodesic_tests: Vec<u64>,
    /// Edges of which neither lengths nor the diagram are sure: those of `uncertain_edges`.
    pub uncertain: usize,
    /// The smallest margin (sine of the sum of opposite angles) among the edges that lengths decided on.
    pub min_margin: f64,
    /// Flips that the metric wants and the plane forbids.
    pub blocked_flips: usize,
    /// Edges on which lengths and the diagram were compared.
    pub compared: usize,
    /// Those on which they differ.
    pub disagreements: Vec<Disagreement>,
    /// The edges of which neither is sure.
    pub uncertain_edges: Vec<UncertainEdge>,
    /// Pairs of straight edges without a common vertex that cross.
    pub crossing_edges: Option<usize>,
    /// The edges as geodesics, where they were found, its fields beside these.
    #[serde(flatten)]
    pub geodesics: Option<Geodesics>,
}

/// The edges of a dual as geodesics.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Geodesics {
    /// Pairs of geodesics that meet elsewhere than at a seed.
    pub crossing_geodesics: usize,
    /// Edges that were moved aside because they crossed another one from the same seed.
    pub parted_geodesics: usize,
    /// Triangles whose three geodesics bound no region.
    pub open_regions: usize,
    /// All edges, in order, without their points.
    pub geodesic_edges: Vec<GeodesicEdge>,
}

impl Geodesics {
    /// Of a realisation.
    pub fn of<P>(realisation: &Realisation<P>) -> Self {
        let without_points = |edge: &GeodesicEdge<P>| GeodesicEdge {
            points: Vec::new(),
            ends: edge.ends,
            length: edge.length,
            error: edge.error,
            found: edge.found,
        };
        Self {
            crossing_geodesics: realisation.crossing.len(),
            parted_geodesics: realisation.edges.iter().filter(|e| e.found == Found::Parted).count(),
            open_regions: realisation.open(),
            geodesic_edges: realisation.edges.iter().map(without_points).collect(),
        }
    }
}

/// An edge on which lengths of geodesics and the nerve of the diagram differ. Vertices are numbered from 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Disagreement {
    /// Its ends.
    pub edge: [u32; 2],
    /// The ends of the other diagonal, if that is what the nerve has.
    pub instead: Option<[u32; 2]>,
    /// Its margin by lengths.
    pub margin: f64,
    /// Estimated error of the margin.
    pub error: f64,
    /// Which of the two was followed.
    pub settled_by: Road,
}

/// An edge of which neither lengths nor the diagram are sure. Vertices are numbered from 0.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct UncertainEdge {
    /// Its ends.
    pub edge: [u32; 2],
    /// Its margin by lengths.
    pub margin: f64,
    /// Estimated error of the margin.
    pub error: f64,
}
