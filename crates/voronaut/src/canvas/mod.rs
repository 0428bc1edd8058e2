//! The canvas (RR-9103, sections 6.2 and 7): the discretised domain on which distances travel.
//!
//! Solvers see only `Canvas::topology`, vertices, faces, edges with metric lengths, never positions, or the graph of
//! `Canvas::graph`. What is drawn, or found by its coordinates, uses `Canvas::embedded`, the triangulation of the plane
//! from which the lengths were taken. All have the same vertices. Kinds of canvas differ in where these are, and a star set
//! in its graph.

mod agreement;
mod border;
mod buckets;
mod consistent;
mod draped;
mod flip;
mod isotropic;
mod lengths;
mod locate;
mod on_surface;
mod refine;
mod relocate;
mod star;
mod star_set;
mod steiner;
mod surface_stars;
mod way;

pub(crate) use border::Border;
pub use consistent::PickCounters;
pub(crate) use consistent::{Consistency, NEEDS_MORE, UNIT_RADIUS, consistent};
pub use draped::Draped;
pub(crate) use draped::Homes;
pub(crate) use lengths::metric_area;
pub(crate) use on_surface::even_on_surface;
pub(crate) use refine::COARSE;
pub use star_set::{StarFigures, StarSet};
pub use way::Way;

use crate::error::{Result, named};
use crate::geodesic::{Graph, bowed_chord};
use crate::geometry::Point;
use crate::lists::{distinct, in_order};
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use crate::planar::Planar;
use crate::triangulation::{Triangulation, VertexId};
use isotropic::Until;
use locate::Finder;

/// The discretisation that distances travel on; its names are those users type (`--canvas`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// `intrinsic`: refined evenly in the metric, geodesic edge lengths, flipped by lengths alone.
    #[default]
    Intrinsic,
    /// `isotropic`: a Euclidean Delaunay triangulation as fine everywhere as the metric is in its finest direction.
    Isotropic,
    /// `starset`: even in the metric, with the Delaunay stars of the vertices, each in its vertex's own metric, as the graph
    /// that methods without triangles travel on.
    StarSet,
}

named!(Kind, "canvas", [Intrinsic = "intrinsic", Isotropic = "isotropic", StarSet = "starset"]);

/// Canvas vertices per seed (`--canvas-size`) unless told otherwise.
pub const VERTICES_PER_SEED: u32 = 60;
/// Seeds that a canvas is made for at least: the cells of a few are large, and so is what the metric does within them.
pub(crate) const LEAST_SEEDS: usize = 2500;
/// So many seeds are few.
pub(crate) const FEW_SEEDS: usize = 300;
/// Bytes that a canvas vertex costs at the peak, with a diagram on the canvas: measured 0.44 to 0.55 kB, with a reserve.
pub const BYTES_PER_VERTEX: f64 = 700.0;

/// Vertices of a canvas for so many seeds: `per_seed` for each; up to `FEW_SEEDS` of them count as `LEAST_SEEDS`, and from there on
/// that least falls with their number.
pub fn size_for(seeds: usize, per_seed: u32) -> usize {
    let least = LEAST_SEEDS.saturating_mul(per_seed as usize) / seeds.div_ceil(FEW_SEEDS).max(1);
    seeds.saturating_mul(per_seed as usize).max(least)
}

/// Edges hide little that their ends do not tell where there are so many vertices for each seed of a mesh: they are a quarter as long as its own.
const TOLD_BY: usize = 20;

/// How a canvas came about. Deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct CanvasCounters {
    /// Vertices put on edges, or at circumcentres, while the triangulation was refined.
    pub splits: u64,
    /// Flips while it was refined, in the plane.
    pub planar_flips: u64,
    /// Edges split because the lengths around a face broke the triangle inequality.
    pub repairs: u64,
    /// Edges shortened, where repairs came to their end, to the sum of the other two of their face.
    pub shortened: u64,
    /// Flips to the intrinsic Delaunay triangulation, by lengths alone.
    pub flips: u64,
}

/// A canvas in numbers. Deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct CanvasFigures {
    /// Which canvas.
    pub kind: Kind,
    /// Its vertices.
    pub vertices: usize,
    /// How it came about, its fields beside these.
    #[serde(flatten)]
    pub counters: CanvasCounters,
    /// Its stars, of a star set.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stars: Option<StarFigures>,
}

impl std::ops::AddAssign for CanvasFigures {
    /// Those of both together.
    fn add_assign(&mut self, more: Self) {
        self.vertices += more.vertices;
        self.counters.splits += more.counters.splits;
        self.counters.planar_flips += more.counters.planar_flips;
        self.counters.repairs += more.counters.repairs;
        self.counters.shortened += more.counters.shortened;
        self.counters.flips += more.counters.flips;
        if let (Some(stars), Some(more)) = (&mut self.stars, more.stars) {
            *stars = StarFigures {
                vertices: stars.vertices + more.vertices,
                inconsistencies: stars.inconsistencies + more.inconsistencies,
                simplices: stars.simplices + more.simplices,
                radius: stars.radius.max(more.radius),
                rounds: stars.rounds.max(more.rounds),
                unsettled: stars.unsettled + more.unsettled,
            };
        }
    }
}

/// An immutable canvas of any [`Kind`], of a planar domain or, as a `Canvas<Draped>`, of a surface.
///
/// Two triangulations on the same vertices: *embedded*, which covers the domain exactly and keeps its constraints, with
/// straight edges in the plane or in the triangles of a surface; and the one that distances travel on, whose edges are known
/// by metric length alone. Edges of the second that flips have made are not straight in the domain; nothing needs them to
/// be, for points are located, refinement is done and paths are drawn in the first. Chords of both have the metric length of
/// a straight segment (`crate::geodesic::chord`) or, if flipped, of the straight line through flattened triangles.
#[derive(Debug)]
pub struct Canvas<E = InPlane> {
    embedded: E,
    topology: Triangulation,
    stars: Option<StarSet>,
    kind: Kind,
    counters: CanvasCounters,
}

/// What a canvas of a planar domain is embedded as.
#[derive(Debug)]
pub struct InPlane {
    planar: Planar,
    finder: Finder,
}

impl<E> Canvas<E> {
    /// What distances travel on: vertices, faces, metric lengths.
    pub(crate) fn topology(&self) -> &Triangulation {
        &self.topology
    }

    /// Number of vertices; all slots are used.
    pub fn vertex_count(&self) -> usize {
        self.topology.vertex_slots()
    }

    /// The stars, if it is a star set.
    pub(crate) fn stars(&self) -> Option<&StarSet> {
        self.stars.as_ref()
    }

    /// Which canvas it is; one by [`Canvas::straight`] counts as intrinsic.
    #[cfg(test)]
    pub(crate) fn kind(&self) -> Kind {
        self.kind
    }

    /// How the canvas came about.
    #[cfg(test)]
    pub(crate) fn counters(&self) -> &CanvasCounters {
        &self.counters
    }

    /// The pairs of vertices that methods on graphs travel between: the edges of an embedded triangulation, of a star set those
    /// of its stars.
    fn pairs<'a>(&'a self, embedded: &'a Triangulation) -> Box<dyn Iterator<Item = [VertexId; 2]> + 'a> {
        match &self.stars {
            Some(stars) => Box::new(stars.pairs()),
            None => Box::new(embedded.edges().map(|h| embedded.ends(h))),
        }
    }

    /// The canvas in numbers.
    pub fn figures(&self) -> CanvasFigures {
        let stars = self.stars.as_ref().map(|stars| *stars.figures());
        CanvasFigures { kind: self.kind, vertices: self.vertex_count(), counters: self.counters, stars }
    }
}

impl Canvas {
    /// The intrinsic canvas: refines a domain's triangulation to about `vertices` vertices, evenly in the metric,
    /// takes metric lengths by quadrature, and flips by lengths alone until it is intrinsic Delaunay.
    ///
    /// It has more vertices only if the domain itself has, or where lengths had to be repaired.
    ///
    /// # Errors
    /// [`crate::Error::Metric`] where the metric is not positive definite at a vertex.
    pub fn intrinsic(planar: &Planar, field: &dyn MetricField, vertices: usize) -> Result<Self> {
        Self::new(Kind::Intrinsic, planar, field, vertices)
    }

    /// The isotropic one of [`Canvas::new`] with as many vertices as it takes until no circumradius exceeds so many `isotropic_size`s
    /// (at its circumcentre), but for faces that rounding or a small angle of the domain leaves no way to cut. The authors
    /// use 1.
    ///
    /// # Errors
    /// As for [`Canvas::intrinsic`].
    pub(crate) fn isotropic_sized(planar: &Planar, field: &dyn MetricField, sizes: f64) -> Result<Self> {
        let mut counters = CanvasCounters::default();
        let until = Until { vertices: usize::MAX, sizes };
        let planar = isotropic::refine(planar.clone(), field, until, &mut counters)?;
        Self::measured(renumbered(&planar), field, Kind::Isotropic, counters)
    }

    /// The canvas of a kind with so many vertices, even in the metric. It has more only if the domain itself has, or where
    /// lengths had to be repaired.
    ///
    /// - Intrinsic: as [`Canvas::intrinsic`].
    /// - Isotropic (RR-9103, section 6.2): a Euclidean Delaunay triangulation, refined at the circumcentre of the face whose
    ///   circumradius is largest beside `isotropic_size` there. Its triangles are obtuse in the metric, so that distances that
    ///   need triangles travel on the intrinsic Delaunay triangulation of its vertices.
    /// - Star set (RR-9103, section 7): its graph are the Delaunay stars of the vertices, each in its vertex's own metric.
    ///   Distances that need triangles travel as on the isotropic one.
    ///
    /// # Errors
    /// As for [`Canvas::intrinsic`].
    pub fn new(kind: Kind, planar: &Planar, field: &dyn MetricField, vertices: usize) -> Result<Self> {
        Self::made(kind, planar.clone(), field, COARSE, vertices)
    }

    /// [`Canvas::new`] from an embedded triangulation of seeds, which may cover a part of a domain only. Its vertices are vertices of
    /// the canvas, under other ids.
    ///
    /// # Errors
    /// As for [`Canvas::new`].
    pub(crate) fn from_planar(kind: Kind, planar: Planar, field: &dyn MetricField, vertices: usize) -> Result<Self> {
        let coarse = COARSE.min(TOLD_BY * planar.topology.vertex_count());
        Self::made(kind, planar, field, coarse, vertices)
    }

    /// Edges are measured with care while there are fewer vertices than `coarse`.
    fn made(kind: Kind, planar: Planar, field: &dyn MetricField, coarse: usize, vertices: usize) -> Result<Self> {
        let mut counters = CanvasCounters::default();
        let planar = match kind {
            Kind::Intrinsic => refine::refine(planar, field, coarse, vertices, &mut counters)?,
            Kind::Isotropic => isotropic::refine(planar, field, Until { vertices, sizes: 0.0 }, &mut counters)?,
            Kind::StarSet => star_set::refine(planar, field, vertices, &mut counters)?,
        };
        Self::measured(renumbered(&planar), field, kind, counters)
    }

    /// This canvas with half the size around some vertices: their edges in the embedded triangulation are halved, the
    /// new edges measured, and all flipped anew by lengths. Old vertices keep their ids and places, new ones come after
    /// them. `field` is the one that the canvas was made with.
    ///
    /// # Errors
    /// As for [`Canvas::intrinsic`].
    pub(crate) fn refined(&self, field: &dyn MetricField, around: &[VertexId]) -> Result<Self> {
        let topology = &self.embedded.planar.topology;
        // At the border the last edge of a star is known only by the face before it.
        let edges = around.iter().flat_map(|&v| topology.star(v)).flat_map(|h| [h, h.prev()]);
        let ends = |h| topology.ends(h);
        let edges = distinct(edges.map(ends).map(in_order));
        let mut counters = self.counters;
        let embedded = match self.kind {
            Kind::Isotropic => isotropic::halve(self.embedded.planar.clone(), &edges, &mut counters),
            Kind::Intrinsic | Kind::StarSet => {
                refine::halve(self.embedded.planar.clone(), field, &edges, &mut counters)?
            }
        };
        Self::measured(embedded, field, self.kind, counters)
    }

    /// The canvas on the vertices of a triangulation, of which some lengths may be known.
    fn measured(embedded: Planar, field: &dyn MetricField, kind: Kind, counters: CanvasCounters) -> Result<Self> {
        let mut canvas = Self::unflipped(embedded, field, kind, counters)?;
        canvas.counters.flips = flip::to_intrinsic_delaunay(&mut canvas.topology);
        if kind == Kind::StarSet {
            canvas.stars = Some(StarSet::new(&canvas.embedded.planar, field)?);
        }
        Ok(canvas)
    }

    fn unflipped(
        mut embedded: Planar,
        field: &dyn MetricField,
        kind: Kind,
        mut counters: CanvasCounters,
    ) -> Result<Self> {
        lengths::measure(&mut embedded, field, &mut counters)?;
        let (topology, finder) = (embedded.topology.clone(), Finder::new(&embedded));
        Ok(Self { embedded: InPlane { planar: embedded, finder }, topology, stars: None, kind, counters })
    }

    /// The same vertices, triangulated in the plane.
    pub(crate) fn embedded(&self) -> &Planar {
        &self.embedded.planar
    }

    /// The vertices with their tensors and the edges of [`Canvas::embedded`], of a star set those of its stars, with lengths of
    /// geodesics, for methods that know no triangles. `field` is the one that the canvas was made with.
    pub(crate) fn graph(&self, field: &dyn MetricField) -> Graph {
        let topology = &self.embedded.planar.topology;
        let tensors = self.embedded.planar.positions.par_iter().with_min_len(1024).map(|&p| field.at(p)).collect();
        let known = |a, b| topology.edge_between(a, b).map(|h| topology.length(h));
        // One order, so that the length is the same in both directions.
        let measured = |a: VertexId, b: VertexId| bowed_chord(field, self.position(a.min(b)), self.position(a.max(b)));
        Graph::new(self.embedded.planar.positions.clone(), tensors, self.pairs(topology))
            .with_lengths(|a, b| known(a, b).unwrap_or_else(|| measured(a, b)))
    }

    /// The position of a vertex.
    pub fn position(&self, v: VertexId) -> Point {
        self.embedded.planar.position(v)
    }
}

/// The triangulation that [`Canvas::intrinsic`] starts from, alone: even in the metric, with so many vertices, and all of those that
/// there were. Edges are measured with care while there are fewer vertices than `coarse`, which is [`COARSE`] where nothing is known of the
/// field.
///
/// # Errors
/// As for [`Canvas::intrinsic`].
pub(crate) fn even(planar: &Planar, field: &dyn MetricField, coarse: usize, vertices: usize) -> Result<Planar> {
    let refined = refine::refine(planar.clone(), field, coarse, vertices, &mut CanvasCounters::default())?;
    Ok(renumbered(&refined))
}

/// The vertices along a Hilbert curve, for the sake of the cache.
fn renumbered(planar: &Planar) -> Planar {
    let old = planar.along_curve();
    let positions = old.iter().map(|&v| planar.position(v)).collect();
    Planar { topology: planar.topology.renumbered(&old), positions }
}

#[cfg(test)]
mod tests {
    use super::size_for;

    #[test]
    fn few_seeds_count_as_many_and_every_number_for_each_counts() {
        assert_eq!([1, 300, 301, 10_000].map(|seeds| size_for(seeds, 60)), [150_000, 150_000, 75_000, 600_000]);
        assert_eq!([1, 300, 301, 10_000].map(|seeds| size_for(seeds, 4)), [10_000, 10_000, 5000, 40_000]);
        assert_eq!(size_for(1, u32::MAX), 2500 * u32::MAX as usize);
    }
}
