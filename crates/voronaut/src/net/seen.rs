//! Seeds as they are seen from around some of them: as points of a plane with a metric. A surface is seen in the chart in the middle.

use super::Simplices;
use crate::dual::Dual;
use crate::geometry::{Point, Point3, Tensor, Vector3};
use crate::manifold::surface::Patch;
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::{Chart, Manifold, Place};
use crate::metric::{MetricField, Near};
use crate::triangulation::VertexId;

/// Seeds whose normals have a lesser cosine with a chart's are not seen in it.
const SEEN: f64 = 0.5;
/// The metric is told by polynomials as far from the middle of some seeds as the farthest of them, times this: the seeds across the sides of a triangle are
/// in there.
const PATCH: f64 = 2.5;
/// A centre this near (barycentric) to a surface's border may be beyond it.
const AT_BORDER: f64 = 1e-9;

/// A plane with a metric, and where the domain is in it.
pub(crate) trait Terrain: Sync {
    /// The metric.
    fn field(&self) -> &dyn MetricField;
    /// Whether a point is in the domain, as the triangle sees it that has the seed for a corner.
    fn is_inside(&self, seed: u32, p: Point) -> bool;
    /// Whether edges of a single triangle are pieces of the domain's border: more may lie beyond those of a chart.
    fn is_whole(&self) -> bool;
}

/// Seeds of the plane, or of a surface.
pub(super) trait Seeds: Sync {
    /// Where a seed or the centre of a circle is.
    type Place: Copy + PartialEq + Send + Sync;

    /// How many there are.
    fn count(&self) -> usize;
    /// Where one is.
    fn place(&self, seed: u32) -> Self::Place;
    /// What is around these, if all of them are seen from their middle.
    fn around(&self, seeds: &[u32]) -> Option<impl View<Place = Self::Place>>;
}

/// A plane in which seeds are seen.
pub(crate) trait View: Terrain {
    /// What a point of it is a place of.
    type Place;

    /// A seed; `None` of one that cannot be seen, which is far away.
    fn seed(&self, seed: u32) -> Option<Point>;
    /// Where a point is.
    fn place(&self, p: Point) -> Option<Self::Place>;
    /// Whether it has no creases around the seeds, across which geodesics are no polynomials.
    fn is_smooth(&self) -> bool {
        true
    }
}

/// Seeds of the plane: all are seen from everywhere.
#[derive(Clone, Copy)]
pub(super) struct Flat<'a> {
    pub(super) field: &'a dyn MetricField,
    pub(super) found: &'a Simplices<'a>,
}

impl Seeds for Flat<'_> {
    type Place = Point;

    fn count(&self) -> usize {
        self.found.seeds.len()
    }

    fn place(&self, seed: u32) -> Point {
        self.found.seeds[seed as usize]
    }

    fn around(&self, _seeds: &[u32]) -> Option<impl View<Place = Point>> {
        Some(*self)
    }
}

impl Terrain for Dual<'_> {
    fn field(&self) -> &dyn MetricField {
        self.field()
    }

    fn is_inside(&self, seed: u32, p: Point) -> bool {
        self.is_inside(VertexId(seed), p)
    }

    fn is_whole(&self) -> bool {
        true
    }
}

impl Terrain for Flat<'_> {
    fn field(&self) -> &dyn MetricField {
        self.field
    }

    fn is_inside(&self, seed: u32, p: Point) -> bool {
        (self.found.is_inside)(seed, p)
    }

    fn is_whole(&self) -> bool {
        true
    }
}

impl View for Flat<'_> {
    type Place = Point;

    fn seed(&self, seed: u32) -> Option<Point> {
        Some(self.found.seeds[seed as usize])
    }

    fn place(&self, p: Point) -> Option<Point> {
        Some(p)
    }
}

/// Seeds at places of a surface.
pub(crate) struct SeedsOnSurface<'a> {
    manifold: &'a Manifold,
    metric: &'a dyn SurfaceMetric,
    places: Vec<Place>,
    normals: Vec<Vector3>,
}

impl<'a> SeedsOnSurface<'a> {
    pub(crate) fn new(manifold: &'a Manifold, metric: &'a dyn SurfaceMetric, places: Vec<Place>) -> Self {
        let normals = places.iter().map(|place| manifold.normal(place)).collect();
        Self { manifold, metric, places, normals }
    }

    /// The chart in the middle of some seeds, if all are seen in it.
    pub(crate) fn chart(&self, seeds: &[u32]) -> Option<Chart<'a>> {
        let (first, share) = (self.places[*seeds.first()? as usize], 1.0 / seeds.len() as f64);
        let offset = |i: u32| self.places[i as usize].position - first.position;
        let middle = seeds.iter().fold(Vector3::default(), |sum, &i| sum + offset(i) * share);
        let place = self.manifold.lift(&first, first.position + middle)?;
        let normal = self.manifold.normal(&place);
        let is_seen = |&i: &u32| self.normals[i as usize].dot(normal) >= SEEN;
        seeds.iter().all(is_seen).then(|| Chart::new(self.manifold, self.metric, place, normal))
    }

    /// The chart that looks along the normal of the straight triangle between three seeds, if it looks at the upper side there.
    pub(crate) fn facing(&self, seeds: [u32; 3]) -> Option<Chart<'a>> {
        let [a, b, c] = seeds.map(|i| self.position(i));
        let normal = (b - a).cross(c - a).unit()?;
        let upright: f64 = seeds.iter().map(|&i| self.normals[i as usize].dot(normal)).sum();
        let place = self.manifold.closest_facing(a + ((b - a) + (c - a)) * (1.0 / 3.0), normal)?;
        (upright > 0.0).then(|| Chart::new(self.manifold, self.metric, place, normal))
    }

    /// What is seen in that chart.
    pub(crate) fn view(&self, seeds: &[u32]) -> Option<impl View<Place = Place>> {
        let chart = self.chart(seeds)?;
        let from_middle = |&i: &u32| chart.flatten(self.position(i)).distance(Point::default());
        let half = PATCH * seeds.iter().map(from_middle).fold(0.0, f64::max);
        let patch = if half > 0.0 { Patch::new(&chart, half) } else { None };
        Some(InChart { chart, patch, seeds: self })
    }

    /// The position of a seed.
    pub(crate) fn position(&self, seed: u32) -> Point3 {
        self.places[seed as usize].position
    }

    /// Puts a seed elsewhere.
    pub(crate) fn put(&mut self, seed: u32, place: Place) {
        self.places[seed as usize] = place;
        self.normals[seed as usize] = self.manifold.normal(&place);
    }
}

impl Seeds for &SeedsOnSurface<'_> {
    type Place = Place;

    fn count(&self) -> usize {
        self.places.len()
    }

    fn place(&self, seed: u32) -> Place {
        self.places[seed as usize]
    }

    fn around(&self, seeds: &[u32]) -> Option<impl View<Place = Place>> {
        self.view(seeds)
    }
}

struct InChart<'a> {
    chart: Chart<'a>,
    patch: Option<Patch>,
    seeds: &'a SeedsOnSurface<'a>,
}

impl MetricField for InChart<'_> {
    fn at(&self, p: Point) -> Tensor {
        self.at_near(p, &mut Near::default())
    }

    fn at_near(&self, p: Point, near: &mut Near) -> Tensor {
        self.patch.as_ref().and_then(|patch| patch.at(p)).unwrap_or_else(|| self.chart.at_near(p, near))
    }
}

impl Terrain for InChart<'_> {
    fn field(&self) -> &dyn MetricField {
        self
    }

    fn is_inside(&self, _seed: u32, p: Point) -> bool {
        self.chart.place(p).is_some_and(|place| !self.seeds.manifold.is_at_border(&place, AT_BORDER))
    }

    fn is_whole(&self) -> bool {
        false
    }
}

impl View for InChart<'_> {
    type Place = Place;

    fn seed(&self, seed: u32) -> Option<Point> {
        let is_seen = self.seeds.normals[seed as usize].dot(self.chart.normal()) >= SEEN;
        is_seen.then(|| self.chart.flatten(self.seeds.position(seed)))
    }

    fn place(&self, p: Point) -> Option<Place> {
        self.chart.place(p)
    }

    fn is_smooth(&self) -> bool {
        self.seeds.manifold.equation().is_some() || self.patch.is_some()
    }
}
