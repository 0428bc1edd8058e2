//! The discretised Riemannian Voronoi diagram (RR-9103, section 6.3) of seeds on a canvas.
//!
//! Every canvas vertex has the colour of its nearest seed and the distance to it. Seeds are inserted, removed and moved
//! one at a time, each by work on the cells concerned only, and with the result that making the diagram anew would have.
//! The diagrams of other [`Kind`]s are coloured by straight distances instead, and made anew at every change.

mod assemble;
mod cells;
mod chords;
mod descend;
mod distances;
mod envelope;
mod frozen;
mod glued;
mod ground;
mod nerve;
mod on_surface;
mod orphans;
mod overlap;
mod paths;
mod resolve;
mod seeds;
#[cfg(test)]
mod test_diagrams;

pub use cells::{Cells, Outline};
pub use chords::Kind;
pub use distances::{Distances, SurfaceDistances};
pub use frozen::Frozen;
pub use ground::Ground;
pub use nerve::{Nerve, NerveEdge, NerveTriangle, Witnesses};
pub use paths::Paths;
pub use resolve::{RESOLVE_ROUNDS, Resolved, resolve};
pub(crate) use seeds::Care;

use crate::canvas::{Canvas, Draped};
use crate::error::Result;
use crate::geodesic::{Geodesic, Label, MarchCounters, Marching, Method, NO_COLOUR, Propagation, Sources, Support};
use crate::geometry::Point;
use crate::metric::{MetricField, check_field};
use crate::triangulation::VertexId;
use chords::Chords;
use ground::{solver, sources};
use overlap::Overlap;
use seeds::Start;
use std::sync::OnceLock;

/// See the [module](self). Seed i has colour i; a removed seed's colour is not used again. It is the same for every
/// [`Ground`]: a `Diagram<'a>` lies in the plane, a [`SurfaceDiagram`] on a surface.
pub struct Diagram<'a, G: Ground<'a> = Flat<'a>> {
    ground: G,
    kind: Kind,
    measure: Measure<'a>,
    care: Care,
    seeds: Vec<Option<Seed<G::Place>>>,
    sources: Sources,
    propagation: Propagation,
    overlap: OnceLock<Overlap>,
}

/// A canvas of the plane.
#[derive(Clone, Copy)]
pub struct Flat<'a> {
    pub(crate) canvas: &'a Canvas,
    pub(crate) field: &'a dyn MetricField,
}

/// The diagram of seeds on a surface.
pub type SurfaceDiagram<'a> = Diagram<'a, &'a Canvas<Draped<'a>>>;

/// How distances from seeds come about.
enum Measure<'a> {
    /// Along shortest ways on the canvas.
    Ways(Box<dyn Geodesic + 'a>),
    /// Straight.
    Chords(Chords),
}

/// A seed: where it is, and the canvas vertices that it gives a distance to.
#[derive(Clone, Debug)]
pub struct Seed<P> {
    at: P,
    starts: Vec<Start>,
}

impl<'a> Diagram<'a> {
    /// The diagram of seeds by fast marching with circular waves, all fronts at once.
    ///
    /// # Errors
    /// [`Error::Domain`](crate::Error::Domain) of a seed outside the domain.
    pub fn new(canvas: &'a Canvas, field: &'a dyn MetricField, seeds: &[Point]) -> Result<Self> {
        Self::with_solver(canvas, field, seeds, Marching::on(canvas.topology()))
    }

    /// The diagram of the vertices of a mesh of the canvas's domain, which may touch itself in points: of as many vertices
    /// in one place as the domain has fans there, in order, each belongs to one fan. (Elsewhere a seed belongs to all.)
    ///
    /// # Errors
    /// As for [`Diagram::of_kind`].
    pub(crate) fn of_vertices(
        canvas: &'a Canvas,
        field: &'a dyn MetricField,
        vertices: &[Point],
        method: Method,
        care: Care,
    ) -> Result<Self> {
        let ground = Flat { canvas, field };
        Self::of_seeds(ground, vertices, true, care, Measure::Ways(solver(ground, method)?))
    }

    /// The diagram of seeds by a solver.
    ///
    /// # Errors
    /// As for [`Diagram::new`].
    pub(crate) fn with_solver(
        canvas: &'a Canvas,
        field: &'a dyn MetricField,
        seeds: &[Point],
        solver: impl Geodesic + 'a,
    ) -> Result<Self> {
        Self::of_seeds(Flat { canvas, field }, seeds, false, Care::Full, Measure::Ways(Box::new(solver)))
    }

    /// The diagram of a kind; a method, on what of the canvas it travels on, is for the Riemannian one.
    ///
    /// # Errors
    /// As for [`Diagram::new`]; [`Error::Unsupported`](crate::Error::Unsupported) of a method that does not drive diagrams; [`Error::Metric`](crate::Error::Metric) where the metric is not positive definite at a seed.
    pub fn of_kind(
        kind: Kind,
        canvas: &'a Canvas,
        field: &'a dyn MetricField,
        seeds: &[Point],
        method: Method,
    ) -> Result<Self> {
        if kind != Kind::Riemannian {
            check_field(field, seeds.iter().copied())?;
        }
        Self::of(kind, Flat { canvas, field }, seeds, method)
    }

    /// The canvas.
    pub(crate) fn canvas(&self) -> &'a Canvas {
        self.ground.canvas
    }

    /// The metric that it was made with.
    pub(crate) fn field(&self) -> &'a dyn MetricField {
        self.ground.field
    }
}

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// The diagram of seeds, which may be the vertices of a mesh of the domain.
    ///
    /// # Errors
    /// A seed is outside the domain.
    fn of_seeds(ground: G, seeds: &[G::Place], are_vertices: bool, care: Care, measure: Measure<'a>) -> Result<Self> {
        let starts = ground.starts_of_all(seeds, are_vertices, care)?;
        Ok(Self { care, ..Self::made(ground, seeds, starts, measure) })
    }

    fn of(kind: Kind, ground: G, seeds: &[G::Place], method: Method) -> Result<Self> {
        let chords = match kind {
            Kind::Riemannian => {
                return Self::of_seeds(ground, seeds, false, Care::Full, Measure::Ways(solver(ground, method)?));
            }
            Kind::DuWang => Chords::InMetricOfPlace,
            Kind::LabelleShewchuk => Chords::InMetricOfSeed,
        };
        let starts = ground.starts_of_all(seeds, false, Care::Quick)?;
        Ok(Self { kind, ..Self::made(ground, seeds, starts, Measure::Chords(chords)) })
    }

    fn made(ground: G, seeds: &[G::Place], starts: Vec<Vec<Start>>, measure: Measure<'a>) -> Self {
        let sources = sources(ground, &starts);
        let placed: Vec<_> = seeds.iter().zip(starts).map(|(&at, starts)| Some(Seed { at, starts })).collect();
        let propagation = match &measure {
            Measure::Ways(solver) => solver.propagate(&sources),
            Measure::Chords(chords) => chords.propagate(ground, &placed),
        };
        let (kind, care, overlap) = (Kind::Riemannian, Care::Full, OnceLock::new());
        Self { ground, kind, measure, care, seeds: placed, sources, propagation, overlap }
    }

    /// What it lies on.
    pub(crate) fn ground(&self) -> G {
        self.ground
    }

    /// By what distance its cells are the nearest places.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Inserts a seed by one front from it; returns its colour.
    ///
    /// # Errors
    /// [`Error::Domain`](crate::Error::Domain) outside the domain, on a surface of what is no canvas vertex; the diagram is as before.
    pub fn insert(&mut self, at: G::Place) -> Result<u32> {
        let colour = self.seeds.len() as u32;
        let starts = self.ground.starts(at)?;
        self.seeds.push(None);
        self.place(colour, at, starts);
        Ok(colour)
    }

    /// Moves a seed, which keeps its colour.
    ///
    /// # Errors
    /// [`Error::Domain`](crate::Error::Domain) where there is no such seed, or it would leave the domain; the diagram is as before.
    #[cfg(test)]
    pub(crate) fn move_to(&mut self, colour: u32, to: G::Place) -> Result<()> {
        if self.seed(colour).is_none() {
            let help = "colours are those that insertions returned and removals have not ended";
            return Err(crate::Error::domain("no such seed", format!("colour {colour}"), help));
        }
        let starts = self.ground.starts(to)?;
        self.place(colour, to, starts);
        Ok(())
    }

    /// Inserts a seed at a canvas vertex, with as much care as the diagram was made with; returns its colour.
    pub(crate) fn insert_at_vertex(&mut self, v: VertexId) -> u32 {
        let colour = self.seeds.len() as u32;
        let starts = self.ground.starts_at_vertex(v, self.care);
        self.seeds.push(None);
        self.place(colour, self.ground.place(v), starts);
        colour
    }

    /// Removes a seed; its neighbours' fronts fill its cell. Says whether there was one.
    pub fn remove(&mut self, colour: u32) -> bool {
        let changed = self.lift(colour);
        self.mend(&changed);
        !changed.is_empty()
    }

    /// Where a seed is; `None` of a removed one.
    pub fn seed(&self, colour: u32) -> Option<G::Place> {
        self.seeds.get(colour as usize)?.as_ref().map(|seed| seed.at)
    }

    /// The canvas vertices in sight of a seed, with their distances from it.
    pub(crate) fn starts_of(&self, colour: u32) -> impl Iterator<Item = (VertexId, f64)> {
        let seed = self.seeds.get(colour as usize).and_then(Option::as_ref);
        seed.into_iter().flat_map(|seed| &seed.starts).map(|start| (start.vertex, start.distance))
    }

    /// Number of colours given so far, those of removed seeds among them.
    pub(crate) fn colours(&self) -> usize {
        self.seeds.len()
    }

    /// Metric distance (that of the diagram's kind) from a canvas vertex to its seed; infinite where no seed reaches.
    pub(crate) fn distance(&self, v: VertexId) -> f64 {
        self.label(v).distance
    }

    /// The colour of a canvas vertex; `None` where no seed reaches.
    pub fn colour(&self, v: VertexId) -> Option<u32> {
        let colour = self.label(v).colour;
        (colour != NO_COLOUR).then_some(colour)
    }

    /// The canvas vertex that the distance came from, the nearer to the seed of two; `None` beside the seed.
    pub(crate) fn parent(&self, v: VertexId) -> Option<VertexId> {
        let topology = self.ground.topology();
        match self.label(v).support() {
            Support::Nothing | Support::Source => None,
            Support::Neighbour(u) => Some(u),
            Support::Vertex(h) => topology.ends(h).into_iter().find(|&end| end != v).or(Some(v)),
            Support::Edge(h) => {
                let [a, b] = topology.ends(h);
                Some(if self.distance(b) < self.distance(a) { b } else { a })
            }
        }
    }

    /// Colour, distance and support of a canvas vertex.
    pub(crate) fn label(&self, v: VertexId) -> &Label {
        self.propagation.label(v)
    }

    /// Work of the solver since the beginning.
    pub(crate) fn counters(&self) -> &MarchCounters {
        self.propagation.counters()
    }

    /// The canvas vertex farthest from its seed, and its distance: where farthest-point refinement puts the next seed.
    pub(crate) fn farthest(&self) -> Option<(VertexId, f64)> {
        self.vertices().map(|v| (v, self.distance(v))).max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
    }

    /// All canvas vertices, in order.
    pub(crate) fn vertices(&self) -> impl Iterator<Item = VertexId> + use<'a, G> {
        (0..self.vertex_count() as u32).map(VertexId)
    }

    /// Number of canvas vertices.
    pub fn vertex_count(&self) -> usize {
        self.ground.topology().vertex_slots()
    }

    /// Canvas vertices per colour.
    pub fn cell_sizes(&self) -> Vec<usize> {
        let mut sizes = vec![0; self.seeds.len()];
        for label in self.propagation.labels() {
            if let Some(size) = sizes.get_mut(label.colour as usize) {
                *size += 1;
            }
        }
        sizes
    }

    /// Puts a seed in a place, from where it was if it was anywhere.
    fn place(&mut self, colour: u32, at: G::Place, starts: Vec<Start>) {
        let mut changed = self.lift(colour);
        for s in &starts {
            self.sources.add(s.vertex, s.distance, colour);
            changed.push(s.vertex);
        }
        self.seeds[colour as usize] = Some(Seed { at, starts });
        self.mend(&changed);
    }

    /// Takes a seed's starts away; returns the vertices that had them.
    fn lift(&mut self, colour: u32) -> Vec<VertexId> {
        let seed = self.seeds.get_mut(colour as usize).and_then(Option::take);
        let vertices: Vec<VertexId> = seed.iter().flat_map(|s| &s.starts).map(|s| s.vertex).collect();
        for &v in &vertices {
            self.sources.remove(v, colour);
        }
        vertices
    }

    fn mend(&mut self, changed: &[VertexId]) {
        self.overlap = OnceLock::new();
        match &self.measure {
            Measure::Ways(solver) => solver.update(&self.sources, changed, &mut self.propagation),
            Measure::Chords(chords) => self.propagation = chords.propagate(self.ground, &self.seeds),
        }
    }
}
