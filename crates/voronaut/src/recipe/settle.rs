//! Steps of the main job in the plane: seeding on a canvas, relaxing, and the last pass, which decides on the edges by both roads and
//! says how sure that is.

use super::MeshOptions;
use super::options::{self, Centroid, Seeding};
use super::plane::Job;
use crate::canvas::{Canvas, CanvasFigures};
use crate::diagram::{Care, Diagram, Flat, Ground};
use crate::dual::{Consultation, Disagreement, Dual, Effort, Moving};
use crate::error::Result;
use crate::geodesic::{Margin, Method};
use crate::geometry::Point;
use crate::optimise::{Cells, Mending, OnCanvas, Patience, Relaxed, exchange, meet_blocked_flips, relax};
use crate::progress::Progress;
use crate::sampling::{Plan, demand_memory, refine_farthest};
use crate::triangulation::VertexId;
use crate::{canvas, figures};

/// Flips by the most careful tests, asks the diagram where the road says so, and tells what came of it.
///
/// # Errors
/// The canvas finds the metric invalid somewhere.
pub(super) fn settle(dual: &mut Dual, plan: &Plan, options: &MeshOptions, progress: &dyn Progress) -> Result<Settled> {
    progress.begin("settling edges", 1)?;
    dual.flip_all(Effort::Full);
    let found = dual.consult_diagram(options.road(), options.canvas, options.canvas_size, options.geodesic)?;
    let made = found.made;
    let canvas = made.map(|m| m.canvas);
    let diagram = made.map(|m| figures::Diagram {
        orphans: m.orphans,
        orphan_components: m.orphan_components,
        raw_nerve: None,
        counters: m.diagram,
    });
    Ok(Settled { dual: account(dual, plan, found), canvas, diagram })
}

/// What the report says of the last pass.
#[derive(Clone, Debug, Default)]
pub(super) struct Settled {
    pub(super) dual: figures::Dual,
    pub(super) canvas: Option<CanvasFigures>,
    pub(super) diagram: Option<figures::Diagram>,
}

fn account(dual: &mut Dual, plan: &Plan, found: Consultation) -> figures::Dual {
    let number = plan.numbering(dual);
    let ends = |edge: [VertexId; 2]| edge.map(|v| number[v.index()]);
    let disagreement = |d: Disagreement| figures::Disagreement {
        edge: ends(d.edge),
        instead: d.instead.map(ends),
        margin: d.margin.value,
        error: d.margin.error,
        settled_by: d.settled_by,
    };
    let uncertain = |(edge, Margin { value: margin, error }): ([VertexId; 2], Margin)| {
        let edge = ends(edge);
        figures::UncertainEdge { edge, margin, error }
    };
    figures::Dual {
        min_margin: dual.smallest_margin(Effort::Full).unwrap_or(0.0),
        blocked_flips: dual.blocked_flips(Effort::Full).len() + found.impossible.len(),
        geodesic_tests: dual.counters().tests.to_vec(),
        compared: found.compared,
        disagreements: found.disagreements.into_iter().map(disagreement).collect(),
        uncertain: found.uncertain.len(),
        uncertain_edges: found.uncertain.into_iter().map(uncertain).collect(),
        ..figures::Dual::default()
    }
}

/// Seeds put at blocked flips, as a share of all: N is kept within one per cent.
const BLOCKED_SHARE: f64 = 0.005;
/// Seeds exchanged between two halves of the relaxation, as a share of all.
const EXCHANGED_SHARE: f64 = 0.06;

/// Triangles that are mended in the end, as a share of all.
const MENDED_SHARE: f64 = 0.002;
/// Where so great a share of the edges is of unit length it is at least so many triangles, so often: of 500 to 10,000 vertices for sampled values the
/// least quality was 0.72 to 0.85 for 0.63 to 0.84. Elsewhere lengths pay: of 1,000 vertices for a mild shock 98.4 % were of unit length for 98.9 %.
const EVEN: f64 = 0.998;
const LEAST_MENDED: usize = 24;
const MENDINGS: usize = 3;
/// Relative error of the energy that tangent planes give, where all seeds are rough.
const ROUGH_DOUBT: f64 = 0.03;

/// Mends the worst triangles, before and after that edges that are not of unit length: around those seeds have come to lie from where the worst can
/// be made better. Of a swirl of 3,900, 4,000 and 4,100 vertices the least quality is .020 .017 .016 for .012 .009 .014, with 0.4 % fewer unit edges.
fn mend(dual: &mut Dual) {
    let poor = (dual.topology().face_count() as f64 * MENDED_SHARE).ceil() as usize;
    let (most, times) = if dual.unit_share() >= EVEN { (poor.max(LEAST_MENDED), MENDINGS) } else { (poor, 1) };
    let mut mending = Mending::default();
    for _ in 0..times {
        mending.worst(dual, most);
    }
    mending.lengths(dual);
    mending.worst(dual, most);
}

impl Job<'_> {
    /// Relaxes in parts, with an exchange of seeds before each but the first.
    ///
    /// # Errors
    /// The metric is found invalid at a seed.
    pub(super) fn relax(&self, dual: &mut Dual, canvas: Option<&Canvas>, effort: options::Effort) -> Result<Relaxed> {
        dual.reorder();
        let steps = self.options.lloyd;
        self.progress.begin("relaxing", steps as u64)?;
        let field = self.field;
        let cells = cells(self.options.centroid, canvas.map(|canvas| Flat { canvas, field }));
        let patience = Patience { steps, gain: effort.gain() };
        let relaxed = self.relax_in_parts(dual, &cells, effort.parts(self.is_even), patience, self.progress)?;
        self.fit_scale(dual);
        if self.exchanges() {
            mend(dual);
            dual.take_touched();
        }
        dual.verdict()?;
        Ok(relaxed)
    }

    /// Relaxes in parts, with an exchange of seeds before each but the first. One that raises the energy, where that is in doubt, is the last but with
    /// `best`: in the layers along a coast later parts took half of the time, and mean quality was higher by 0.002 for them.
    pub(super) fn relax_in_parts(
        &self,
        dual: &mut Dual,
        cells: &Cells,
        parts: usize,
        Patience { steps, gain }: Patience,
        progress: &dyn Progress,
    ) -> Result<Relaxed> {
        let patience = |steps| Patience { steps, gain };
        let mut relaxed = relax(dual, cells, patience(steps / parts), progress)?;
        for part in 1..parts {
            let mut left = (steps * (part + 1)) / parts - (steps * part) / parts;
            let is_changed = self.exchange(dual, cells, &mut relaxed, progress)?;
            // With weights it rises as it likes.
            let counts = is_changed && self.options.centroid != Centroid::Weighted;
            let rises = counts && matches!(relaxed.energy[..], [.., before, after] if after > before);
            if is_changed {
                left = left.saturating_sub(1);
            }
            relaxed.append(relax(dual, cells, patience(left), progress)?);
            if rises && !self.options.effort.is_thorough() {
                break;
            }
        }
        Ok(relaxed)
    }

    /// Exchanges seeds and takes a step; if both together raise the energy (in a rough metric: by more than its doubt), both
    /// are taken back. Says whether a step was taken.
    fn exchange(&self, dual: &mut Dual, cells: &Cells, relaxed: &mut Relaxed, progress: &dyn Progress) -> Result<bool> {
        if !self.exchanges() {
            return Ok(false);
        }
        let count = dual.vertex_count();
        let most = |share: f64| (count as f64 * share) as usize;
        let before = dual.save();
        self.fit_scale(dual);
        let met = meet_blocked_flips(dual, most(BLOCKED_SHARE));
        exchange(dual, self.fill(count), most(EXCHANGED_SHARE).max(met))?;
        let Some(&energy) = relaxed.energy.last() else { return Ok(false) };
        let step = relax(dual, cells, Patience { steps: 1, gain: 0.0 }, progress)?;
        let doubt = if self.options.centroid == Centroid::Tangent { ROUGH_DOUBT * rough_share(dual) } else { 0.0 };
        let rises = step.energy.last().is_none_or(|&now| now > (1.0 + doubt) * energy);
        if rises && self.options.centroid != Centroid::Weighted {
            dual.take_back(&before);
            return Ok(false);
        }
        relaxed.append(step);
        Ok(true)
    }

    /// Farthest points that are not to be relaxed stay as they are.
    fn exchanges(&self) -> bool {
        self.options.lloyd > 0 || self.options.seeding != Seeding::Farthest
    }
}

/// The cells that seeds are relaxed with, on the canvas if one was made.
pub(super) fn cells<'a, G: Ground<'a>>(centroid: Centroid, ground: Option<G>) -> Cells<'a, G> {
    match (centroid, ground) {
        (Centroid::Canvas, Some(ground)) => Cells::Canvas(OnCanvas::new(ground)),
        (Centroid::Weighted, Some(ground)) => Cells::Weighted(OnCanvas::new(ground)),
        _ => Cells::Tangent,
    }
}

/// The share of seeds at which the metric is rough.
fn rough_share(dual: &Dual) -> f64 {
    let rough = dual.topology().vertices().filter(|&v| dual.local(v).is_rough).count();
    rough as f64 / dual.vertex_count() as f64
}

impl Job<'_> {
    /// The canvas of the domain, if seeding or relaxing needs one: it does not depend on the metric's factor, so one serves all
    /// rounds of seeding.
    ///
    /// # Errors
    /// The memory limit, or the metric at a canvas vertex.
    pub(super) fn canvas(&mut self, plan: &Plan, seeds: usize) -> Result<Option<Canvas>> {
        if self.options.seeding != Seeding::Farthest && self.options.centroid == Centroid::Tangent {
            return Ok(None);
        }
        let size = canvas::size_for(seeds, self.options.canvas_size);
        demand_memory(seeds as f64, size as f64, self.options.memory_limit)?;
        self.progress.begin("canvas", 1)?;
        let canvas =
            self.watch.time("canvas", || Canvas::new(self.options.canvas, plan.domain.planar(), self.field, size))?;
        self.canvas = Some(canvas.figures());
        Ok(Some(canvas))
    }

    /// Fills the interior of a dual whose segments are sampled.
    ///
    /// # Errors
    /// None that a dual of the canvas's domain could cause.
    pub(super) fn seed_farthest(&mut self, canvas: &Canvas, dual: &mut Dual, count: usize) -> Result<()> {
        let seeds: Vec<Point> = dual.topology().vertices().map(|v| dual.position(v)).collect();
        let mut diagram = Diagram::of_vertices(canvas, self.field, &seeds, Method::March, Care::Quick)?;
        refine_farthest(dual, &mut diagram, self.fill(count), self.progress)?;
        self.diagram = Some(figures::Diagram::of(&diagram));
        Ok(())
    }
}
