//! One pass over a surface: seeds, their triangulation, relaxed and settled, and one mesh of all patches.

use super::dual::account;
use super::patches::Patched;
use super::settle::{Settled, cells};
use super::stopwatch::Stopwatch;
use super::{Centroid, Effort, MeshOptions, Seeding};
use crate::canvas::{Canvas, CanvasFigures, Draped};
use crate::diagram::SurfaceDiagram;
use crate::dual::{Moving, Road, SurfaceDual};
use crate::error::{Error, Result};
use crate::figures;
use crate::geometry::Point3;
use crate::lists::{distinct, in_order};
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::{Manifold, Place};
use crate::mesh::Mesh;
use crate::metric::{Expression, Norm};
use crate::optimise::{Cells, Mending, Patience, Relaxed, relax};
use crate::progress::Progress;
use crate::quality::{self, Meetings, Validity};
use crate::rdt::{OnSurface, Rdt, Start};
use crate::sampling::{
    ALL_VERTICES, Adapted, FeatureSeeds, Held, Holding, MeasuredCurves, Wanted, adapted, contracted, exchanged,
    fill_farthest,
};
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::collections::BTreeSet;

/// Seeds that a canvas is made for at least.
const LEAST_SEEDS: usize = 334;
/// Triangles that are mended in the end, as a share of all, and how often. Of spot, bob, a bracket, a cube and a patch at 2,000 and 6,000 vertices the
/// least quality goes either way with 0.002 to 0.02; the mean is up to 0.003 higher with 0.02, which takes up to a quarter longer.
const MENDED_SHARE: f64 = 0.005;
const MENDINGS: usize = 3;
/// It is at least so many triangles: of bob and a chair at 1,020 vertices the least quality was 0.69 and 0.48, and is 0.78 and 0.81.
const LEAST_MENDED: usize = 48;
/// Curves on which contraction ends too early are kept as they are, and the rest is tried again, so often at most.
const DENSER: usize = 12;
/// After so many passes all vertices of the curves that faulty triangles touch are kept.
const PATIENCE: usize = 4;
/// The surface is kept as far around a faulty triangle as this share of its longest edge, twice as far the second time, and so on.
const AROUND: f64 = 0.2;

/// Parts of a relaxation, between which seeds are exchanged.
#[derive(Clone, Copy)]
pub(super) struct Parts {
    /// So many at most.
    pub(super) most: usize,
    /// With so great a share of unit edges there are no more.
    pub(super) enough: f64,
}

impl Parts {
    /// Of seeds from a coarser mesh. The second part took an eighth of the time, for a mean quality that was higher by 0.001 to 0.004 (meshes of
    /// 6,000 of spot, bob, a cube and a patch).
    pub(super) const EVEN: Self = Self { most: 2, enough: 0.998 };
    /// Of other seeds. Of spot, bob, a bracket, a cube and a patch at 2,000 and 6,000 vertices 4 take up to a third longer, with a mean quality that
    /// is 0.001 higher at 6,000 vertices and the same at 2,000; with 2 it is up to 0.004 lower.
    const ROUGH: Self = Self { most: 3, enough: f64::INFINITY };

    fn of(effort: Effort, are_even: bool) -> Self {
        match effort {
            Effort::Normal | Effort::Fast if are_even => Self::EVEN,
            Effort::Normal => Self::ROUGH,
            effort => Self { most: effort.parts(false), enough: f64::INFINITY },
        }
    }
}

/// What passes are made with.
pub(super) struct Setting<'a> {
    pub(super) manifold: &'a Manifold,
    pub(super) metric: &'a dyn SurfaceMetric,
    /// The function that the mesh is for, if it is for one, and the norm.
    pub(super) aim: Option<(&'a Expression, Norm)>,
    pub(super) options: &'a MeshOptions,
    pub(super) progress: &'a dyn Progress,
    pub(super) curves: MeasuredCurves<'a>,
    /// Where the surface meets itself.
    pub(super) meetings: &'a Meetings,
    pub(super) watch: &'a Stopwatch<'a>,
}

/// What a pass has come to.
pub(super) struct Pass<'a> {
    manifold: &'a Manifold,
    pub(super) dual: SurfaceDual<'a>,
    features: FeatureSeeds,
    owners: Vec<u32>,
    pub(super) relaxed: Relaxed,
    pub(super) settled: Settled,
}

/// The mesh of a pass.
pub(super) struct Checked {
    pub(super) mesh: Mesh,
    /// What is found of it.
    pub(super) validity: Validity,
    /// The triangles that make it none, are folded over, or have a border that is of no patch.
    pub(super) faulty: Vec<u32>,
}

/// Where the passes before made no mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct Reseed {
    /// How many times as many seeds as their lengths ask for each curve shall have; one if there is no entry.
    density: Vec<usize>,
    /// Faulty triangles, around which a pass that starts from the surface's own triangles keeps these.
    held: Vec<Held>,
    /// Whether nothing else may help: the surface's own triangles stay, and are split at most.
    pub(super) is_last: bool,
    /// Passes before.
    pub(super) rounds: usize,
}

impl Reseed {
    /// What to tell the user.
    pub(super) fn note(&self) -> Option<String> {
        let count = self.held.len();
        (count > 0).then(|| format!("made anew {} times: {count} triangles met or were folded over", self.rounds))
    }
}

/// Seeds before they are relaxed.
pub(super) struct Started {
    pub(super) features: FeatureSeeds,
    /// Of the places on features, which come first, the seed that each belongs to.
    pub(super) owners: Vec<u32>,
    pub(super) adapted: Adapted,
    /// Whether they come from a coarser mesh that was relaxed.
    pub(super) is_even: bool,
    /// Where one was made.
    pub(super) canvas: Option<CanvasFigures>,
}

impl<'a> Setting<'a> {
    /// A pass that starts from farthest points on a canvas, or from the surface's own triangles, with so many steps of relaxation.
    /// Without any, not even of flips, triangles are the surface's where they are held.
    ///
    /// # Errors
    /// The metric is invalid somewhere; features cannot be kept as they are.
    pub(super) fn pass(
        &self,
        count: usize,
        scale: f64,
        reseed: &mut Reseed,
        is_farthest: bool,
        steps: Option<usize>,
    ) -> Result<Pass<'a>> {
        self.progress.begin("seeding", count as u64)?;
        let started = self.watch.time("seed", || {
            if is_farthest {
                self.started_from_canvas(count, scale, reseed)
            } else if reseed.rounds == 0 && !reseed.is_last && steps.is_some_and(|steps| steps > 0) {
                self.started_from_coarser(count, scale, reseed)
            } else {
                self.started_from_surface(count, scale, reseed)
            }
        });
        let Started { features, owners, adapted, is_even, canvas } = started?;
        let own = self.canvas_to_relax_on(adapted.places.len(), steps)?;
        let parts = Parts::of(self.options.effort, is_even);
        let (dual, relaxed) = self.watch.time("relax", || self.relaxed(adapted, scale, steps, parts, own.as_ref()))?;
        let settled = Settled { canvas: own.map(|canvas| canvas.figures()).or(canvas), ..Settled::default() };
        Ok(Pass { manifold: self.manifold, dual, features, owners, relaxed, settled })
    }

    /// Settles the edges of a pass that has made a mesh, and says whether any may be another one now.
    pub(super) fn settle_edges(&self, pass: &mut Pass<'a>) -> Result<bool> {
        let canvas = pass.settled.canvas.take();
        pass.settled = self.watch.time("settle", || self.settled(&mut pass.dual))?;
        pass.settled.canvas = pass.settled.canvas.take().or(canvas);
        Ok(self.options.dual == Road::Canvas)
    }

    fn dual_of(&self, Adapted { places, staying, topology, .. }: Adapted, scale: f64) -> Result<SurfaceDual<'a>> {
        SurfaceDual::new(self.manifold, self.metric, scale, places, staying, topology)
    }

    /// In the metric whose factor is fit; with steps, relaxed in parts, between which vertices are exchanged and the factor made fit.
    fn relaxed(
        &self,
        adapted: Adapted,
        scale: f64,
        steps: Option<usize>,
        parts: Parts,
        canvas: Option<&Canvas<Draped<'a>>>,
    ) -> Result<(SurfaceDual<'a>, Relaxed)> {
        let staying = adapted.staying;
        let Some(steps) = steps else {
            let mut dual = self.dual_of(adapted, scale)?;
            self.fit_scale(&mut dual)?;
            return Ok((dual, Relaxed::default()));
        };
        self.progress.begin("relaxing", steps as u64)?;
        let dual = self.unfolded(adapted, scale)?;
        let cells = cells(self.options.centroid, canvas);
        let patience = Patience { steps, gain: self.options.effort.gain() };
        let (mut dual, relaxed) = self.relaxed_in_parts(dual, staying, &cells, parts, patience, self.progress)?;
        mend(&mut dual);
        Ok((dual, relaxed))
    }

    /// Ready to be relaxed.
    pub(super) fn unfolded(&self, adapted: Adapted, scale: f64) -> Result<SurfaceDual<'a>> {
        let mut dual = self.dual_of(adapted, scale)?;
        dual.unfold();
        dual.flip_all();
        self.fit_scale(&mut dual)?;
        Ok(dual)
    }

    /// Between parts vertices are exchanged, and the factor is made fit.
    pub(super) fn relaxed_in_parts<'c>(
        &self,
        mut dual: SurfaceDual<'a>,
        staying: usize,
        cells: &Cells<'c, &'c Canvas<Draped<'c>>>,
        Parts { most, enough }: Parts,
        Patience { steps, gain }: Patience,
        progress: &dyn Progress,
    ) -> Result<(SurfaceDual<'a>, Relaxed)> {
        let mut relaxed = Relaxed::default();
        for part in 0..most {
            let steps = (steps * (part + 1)) / most - (steps * part) / most;
            if part > 0 && steps > 0 {
                if dual.unit_share() >= enough {
                    break;
                }
                let factor = dual.factor();
                let other = exchanged(self.manifold, self.metric, factor, dual.places(), dual.topology(), staying);
                dual = self.dual_of(other, factor)?;
                dual.flip_all();
            }
            relaxed.append(relax(&mut dual, cells, Patience { steps, gain }, progress)?);
            self.fit_scale(&mut dual)?;
        }
        Ok((dual, relaxed))
    }

    /// Farthest points on a canvas whose triangles are contracted onto them.
    fn started_from_canvas(&self, count: usize, scale: f64, reseed: &Reseed) -> Result<Started> {
        let (features, given, owners, total) = self.featured(count, scale, reseed);
        let (canvas, at) = self.canvas(total, &given)?;
        let mut diagram = SurfaceDiagram::on_surface(&canvas, &at, self.options.geodesic)?;
        let draped = canvas.draped();
        let required = self.manifold.required_triangles();
        let may_hold = |v: VertexId| {
            !draped.topology().is_border_vertex(v) && required.binary_search(&draped.place(v).face).is_err()
        };
        fill_farthest(&mut diagram, total, 0.0, may_hold, self.progress, |diagram, v| {
            diagram.insert_at_vertex(v);
        })?;
        let seeds: Vec<VertexId> = (0..diagram.colours() as u32).filter_map(|colour| diagram.seed(colour)).collect();
        let slots = (0..draped.topology().vertex_slots() as u32).map(VertexId);
        let triangles = (draped.topology().clone(), slots.map(|v| *draped.place(v)).collect());
        let adapted = contracted(self.manifold, self.metric, scale, triangles, &seeds, owners.len(), seeds.len());
        if adapted.stuck.is_empty() {
            return Ok(Started { features, owners, adapted, is_even: false, canvas: Some(canvas.figures()) });
        }
        Err(no_features())
    }

    /// Seeds on features, their places, the seed that each place belongs to, and how many places there are to be.
    pub(super) fn featured(
        &self,
        count: usize,
        scale: f64,
        reseed: &Reseed,
    ) -> (FeatureSeeds, Vec<Place>, Vec<u32>, usize) {
        let features = self.curves.sampled(1.0 / scale.sqrt(), self.options.hausd, &reseed.density);
        let (given, owners) = features.flattened();
        let total = count.max(features.seeds.len()) + owners.len() - features.seeds.len();
        (features, given, owners, total)
    }

    /// The surface's own triangles, adapted. Where vertices of a curve cannot be contracted without folds, all of them become seeds.
    pub(super) fn started_from_surface(&self, count: usize, scale: f64, reseed: &mut Reseed) -> Result<Started> {
        let curves = &self.manifold.features().curves;
        reseed.density.resize(curves.len(), 1);
        if reseed.is_last {
            reseed.density.fill(ALL_VERTICES);
        }
        for _ in 0..DENSER {
            let (features, given, owners, total) = self.featured(count, scale, reseed);
            let held = if reseed.is_last { Holding::All } else { Holding::Near(&reseed.held) };
            let wanted = Wanted { given: &given, factor: scale, count: total, held };
            let Some(adapted) = adapted(self.manifold, self.metric, &wanted) else { break };
            if adapted.stuck.is_empty() {
                return Ok(Started { features, owners, adapted, is_even: false, canvas: None });
            }
            let stuck: BTreeSet<VertexId> = adapted.stuck.iter().map(|&v| self.manifold.seams().original(v)).collect();
            for (curve, density) in curves.iter().zip(&mut reseed.density) {
                let is_stuck = curve.edges.iter().any(|edge| stuck.contains(&edge.from) || stuck.contains(&edge.to));
                *density = if is_stuck { ALL_VERTICES } else { *density };
            }
        }
        Err(no_features())
    }

    fn canvas(&self, count: usize, seeds: &[Place]) -> Result<(Canvas<Draped<'a>>, Vec<VertexId>)> {
        self.progress.begin("canvas", 1)?;
        let size = self.canvas_size(count);
        Canvas::on_surface(self.options.canvas, self.manifold, self.metric, size, seeds)
    }

    /// The canvas that cells are coloured on, if seeds are moved to centroids there.
    fn canvas_to_relax_on(&self, count: usize, steps: Option<usize>) -> Result<Option<Canvas<Draped<'a>>>> {
        let is_made = steps.is_some_and(|steps| steps > 0) && self.options.centroid != Centroid::Tangent;
        is_made.then(|| Ok(self.watch.time("canvas", || self.canvas(count, &[]))?.0)).transpose()
    }

    /// Whether seeding, relaxing, protecting or settling takes a canvas.
    pub(super) fn needs_canvas(&self) -> bool {
        let MeshOptions { seeding, dual, centroid, .. } = *self.options;
        seeding != Seeding::Sizing || dual == Road::Canvas || centroid != Centroid::Tangent
    }

    /// Canvas vertices for so many seeds.
    pub(super) fn canvas_size(&self, count: usize) -> usize {
        count.max(LEAST_SEEDS).saturating_mul(self.options.canvas_size as usize)
    }

    fn fit_scale(&self, dual: &mut SurfaceDual) -> Result<()> {
        if self.options.vertices.is_some() {
            let mean = dual.mean_length();
            dual.rescale(dual.factor() / (mean * mean))?;
        }
        Ok(())
    }

    /// Where that is asked for, flips by lengths of geodesics on a canvas that has the seeds as vertices.
    fn settled(&self, dual: &mut SurfaceDual) -> Result<Settled> {
        if self.options.dual == Road::Canvas {
            return self.settle(dual);
        }
        let (blocked_flips, min_margin) = dual.unsettled();
        let dual = figures::Dual { min_margin, blocked_flips, ..figures::Dual::default() };
        Ok(Settled { dual, ..Settled::default() })
    }

    fn settle(&self, dual: &mut SurfaceDual) -> Result<Settled> {
        self.progress.begin("settling edges", 1)?;
        let (canvas, at) = self.canvas(dual.places().len(), dual.places())?;
        let diagram = SurfaceDiagram::on_surface(&canvas, &at, self.options.geodesic)?;
        let triangles = dual.triangles();
        let nerve = diagram.nerve();
        let at_border = Start::from_nerve(&nerve).at_border;
        let rdt = Rdt::judged(OnSurface::new(&diagram), at.len(), &Start { triangles, at_border });
        dual.settle_by(|quad| rdt.margin_of(quad));
        let blocked = dual.disagreeing(|quad| rdt.margin_of(quad));
        dual.unfold();
        mend(dual);
        let account = figures::Dual { blocked_flips: blocked, ..account(&rdt, &nerve, Road::Geodesic) };
        Ok(Settled { dual: account, canvas: Some(canvas.figures()), diagram: Some(figures::Diagram::of(&diagram)) })
    }

    /// A canvas of so many seeds as a surface: finer than what an equation was first meshed to.
    pub(super) fn fine_surface(&self, count: usize) -> Result<Manifold> {
        self.canvas(count, &[])?.0.draped().to_manifold()
    }
}

impl Pass<'_> {
    fn patched(&self) -> Patched<'_> {
        Patched { manifold: self.manifold, features: &self.features, owners: &self.owners }
    }

    /// The vertex of the mesh that a seed is.
    pub(super) fn vertex(&self, seed: u32) -> u32 {
        self.patched().vertex(seed)
    }

    /// One mesh of all patches; its triangles are in the order of the dual's.
    fn mesh(&self) -> Mesh {
        self.patched().mesh(self.dual.places(), &self.dual.triangles())
    }

    /// Mends its needles, and says whether it did.
    pub(super) fn mend_needles(&mut self) -> bool {
        let (mut mending, mut changes) = (Mending::default(), 0);
        for _ in 0..MENDINGS {
            let needles = mending.edges_of_needles(&self.dual);
            changes += self.dual.round_off(needles) + mending.needles(&mut self.dual) as u64;
        }
        changes > 0
    }

    /// Its mesh, and what is found of that.
    pub(super) fn checked(&self, meetings: &Meetings) -> Checked {
        let mesh = self.mesh();
        let (validity, faulty) = quality::examined_on(&mesh, meetings);
        let faulty = distinct(faulty.into_iter().chain(self.astray()));
        Checked { mesh, validity, faulty }
    }

    /// The triangles that are folded over, or whose border is that of no patch.
    fn astray(&self) -> Vec<u32> {
        let topology = self.dual.topology();
        let features: BTreeSet<[u32; 2]> = self.features.edges.iter().map(|edge| in_order(edge.ends)).collect();
        let strays = |h: HalfEdge| {
            let ends = [topology.origin(h), topology.target(h)].map(|v| self.patched().vertex(v.0));
            topology.twin(h).is_none() && !features.contains(&in_order(ends))
        };
        let is_wrong = |f: FaceId| self.dual.is_folded(f) || f.half_edges().into_iter().any(strays);
        (0..).zip(topology.faces()).filter(|&(_, f)| is_wrong(f)).map(|(i, _)| i).collect()
    }

    /// What to do differently: more of the surface kept around faulty triangles, more seeds on the curves that one touches.
    pub(super) fn reseed(&self, faulty: &[u32], before: Reseed) -> Reseed {
        let mut density = before.density;
        density.resize(self.manifold.features().curves.len(), 1);
        let triangles = self.dual.triangles();
        let mut curves: BTreeSet<usize> = BTreeSet::new();
        for corners in faulty.iter().map(|&t| triangles[t as usize]) {
            let seeds: BTreeSet<u32> = corners.iter().filter_map(|&v| self.owners.get(v as usize).copied()).collect();
            if seeds.len() == 3 || before.rounds >= PATIENCE {
                // Between features alone there may be no room for a seed.
                let touches = |v: &u32| seeds.contains(v);
                let is_patient = before.rounds < PATIENCE;
                let touched = self.features.edges.iter().filter(|edge| {
                    if is_patient { edge.ends.iter().all(touches) } else { edge.ends.iter().any(touches) }
                });
                curves.extend(touched.map(|edge| edge.curve));
            }
        }
        for curve in curves {
            density[curve] = if before.rounds < PATIENCE { density[curve].saturating_mul(2) } else { ALL_VERTICES };
        }
        let mut held = before.held;
        held.extend(faulty.iter().map(|&t| {
            let corners = triangles[t as usize].map(|v| self.dual.places()[v as usize]);
            let around =
                (before.rounds + 1) as f64 * AROUND * Point3::longest_side(corners.map(|place| place.position));
            Held { corners: corners.map(|place| place.position), within: around }
        }));
        Reseed { density, held, rounds: before.rounds + 1, is_last: false }
    }

    /// Vertices that features have.
    pub(super) fn vertices_on_features(&self) -> usize {
        self.features.seeds.len()
    }

    /// What to tell the user.
    pub(super) fn notes(&self) -> Vec<String> {
        let folded = self.dual.topology().faces().filter(|&f| self.dual.is_folded(f)).count();
        let told = [
            (self.features.loose, "single feature edges inside a patch: only their ends are kept"),
            (folded, "triangles face away from the surface: straight edges cannot honour the metric there"),
        ];
        told.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect()
    }
}

/// That a mesh of which this is found is valid, has the surface's topology, and all that is required.
///
/// # Errors
/// [`Error::Mesh`] with the first fault.
pub(super) fn demand(manifold: &Manifold, mesh: &Mesh, found: &Validity) -> Result<()> {
    let help = "ask for more vertices (`vertices`); please report this with the input";
    let fault = |what: &str, place: String| Err(Error::mesh(what, place, help));
    if let Some(found) = &found.first_fault {
        return fault(&found.what, found.place.clone());
    }
    let whole = manifold.whole();
    if (found.euler, found.boundary_loops) != (whole.euler, whole.borders) {
        let what = format!(
            "the mesh has another topology than the surface: Euler number {} and {} borders instead of {} and {}",
            found.euler, found.boundary_loops, whole.euler, whole.borders
        );
        return fault(&what, "the mesh".into());
    }
    if mesh.required_triangles.len() < manifold.required_triangles().len() {
        return fault("a required triangle is not in the mesh", "the mesh".into());
    }
    Ok(())
}

fn no_features() -> Error {
    let help = "ask for more vertices, or leave features out";
    Error::domain("features cannot be kept without folds", "the surface", help)
}

/// Mends the worst triangles, before and after that edges that are not of unit length: around those seeds have come to lie from where the worst can be
/// made better, and their flips may leave needles.
fn mend(dual: &mut SurfaceDual) {
    let poor = (dual.topology().face_count() as f64 * MENDED_SHARE).ceil() as usize;
    let (poor, mut mending) = (poor.max(LEAST_MENDED), Mending::default());
    for _ in 0..MENDINGS {
        dual.round_off(mending.edges_of_needles(dual));
        mending.worst(dual, poor);
        mending.needles(dual);
    }
    dual.round_off(mending.edges_of_needles(dual));
    mending.lengths(dual);
    mending.worst(dual, poor);
    mending.needles(dual);
}
