//! What seeds and canvas vertices are seen in, from around some seeds: the plane itself, or a chart of a surface, which is a part of the
//! plane with a metric. What the report proves of the plane, of what is near a seed, holds of a chart (RR-9103, section 12).

use crate::canvas::Homes;
use crate::diagram::{Diagram, SurfaceDiagram};
use crate::geodesic::{Fineness, Paths};
use crate::geometry::Point;
use crate::manifold::{Chart, Place};
use crate::metric::MetricField;
use crate::net::SeedsOnSurface;
use crate::triangulation::{FaceId, VertexId};

/// The seeds of a diagram, to be seen from around some of them.
pub(super) trait Sights<P>: Sync {
    /// What is seen from the middle of some seeds, if all of them are.
    fn around<const N: usize>(&self, seeds: [u32; N]) -> Option<impl Sight>;
    /// The face of the embedded canvas that holds a place.
    fn face(&self, at: P) -> Option<FaceId>;
}

/// A part of the plane with a metric, in which seeds and canvas vertices are.
pub(super) trait Sight: Sync {
    fn field(&self) -> &dyn MetricField;
    fn seed(&self, i: u32) -> Point;
    fn vertex(&self, v: VertexId) -> Point;

    /// The length of the geodesic between two points and its relative error; NaN where none is found.
    fn length(&self, paths: &Paths, p: Point, q: Point, fineness: Fineness) -> (f64, f64) {
        paths.length(self.field(), p, q, fineness).map_or((f64::NAN, 0.0), |length| (length.value, length.error))
    }
}

impl Sights<Point> for Diagram<'_> {
    fn around<const N: usize>(&self, _seeds: [u32; N]) -> Option<impl Sight> {
        Some(self)
    }

    fn face(&self, at: Point) -> Option<FaceId> {
        self.canvas().face_of(self.canvas().locate(at)?)
    }
}

impl Sight for &Diagram<'_> {
    fn field(&self) -> &dyn MetricField {
        Diagram::field(self)
    }

    fn seed(&self, i: u32) -> Point {
        Diagram::seed(self, i).unwrap_or_default()
    }

    fn vertex(&self, v: VertexId) -> Point {
        self.canvas().position(v)
    }
}

/// The seeds of a diagram on a surface.
pub(super) struct OnSurface<'d, 'a> {
    diagram: &'d SurfaceDiagram<'a>,
    seeds: SeedsOnSurface<'a>,
    homes: Homes,
}

impl<'d, 'a> OnSurface<'d, 'a> {
    pub(super) fn new(diagram: &'d SurfaceDiagram<'a>) -> Self {
        Self { diagram, seeds: SeedsOnSurface::of(diagram), homes: diagram.canvas().draped().homes() }
    }
}

impl Sights<Place> for OnSurface<'_, '_> {
    fn around<const N: usize>(&self, seeds: [u32; N]) -> Option<impl Sight> {
        Some(InChart { chart: self.seeds.chart(&seeds)?, sights: self })
    }

    fn face(&self, at: Place) -> Option<FaceId> {
        self.diagram.canvas().draped().face_at(&at, &self.homes).ok().map(|found| found.0)
    }
}

struct InChart<'s, 'd, 'a> {
    chart: Chart<'a>,
    sights: &'s OnSurface<'d, 'a>,
}

impl Sight for InChart<'_, '_, '_> {
    fn field(&self) -> &dyn MetricField {
        &self.chart
    }

    fn seed(&self, i: u32) -> Point {
        self.chart.flatten(self.sights.seeds.position(i))
    }

    fn vertex(&self, v: VertexId) -> Point {
        self.chart.flatten(self.sights.diagram.canvas().draped().position(v))
    }
}
