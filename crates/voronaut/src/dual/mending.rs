//! What mending the worst triangles asks of a triangulation: how good triangles and edges are as a mesh's are measured.

use super::{Dual, Effort, Moving, SurfaceDual};
use crate::geometry::{Point, Tensor, Tensor3, Vector};
use crate::metric::MetricField;
use crate::surface::Place;
use crate::triangulation::VertexId;

/// Seeds of which one at a time is tried elsewhere.
pub(crate) trait Mending: Moving {
    /// A place with what the metric is there.
    type Site: Copy;

    /// Where a seed is.
    fn site(&self, v: VertexId) -> Self::Site;
    /// Where a seed would be after a move; `None` where it cannot go.
    fn site_after(&self, v: VertexId, by: Vector) -> Option<Self::Site>;
    /// The quality of a straight triangle in the log-Euclidean mean of the tensors at its corners: 1 of an equilateral one,
    /// negative of one that is turned over.
    fn quality(&self, corners: [Self::Site; 3]) -> f64;
    /// The metric length of a straight edge.
    fn straight_length(&self, ends: [Self::Site; 2]) -> f64;
    /// After a seed has moved: measures the metric there and flips around it.
    fn settle_move(&mut self, v: VertexId);
}

/// A point and the logarithm of the tensor there.
#[derive(Clone, Copy)]
pub(crate) struct Site {
    at: Point,
    log: Tensor,
}

impl Mending for Dual<'_> {
    type Site = Site;

    fn site(&self, v: VertexId) -> Site {
        let at = self.position(v);
        Site { at, log: self.field().at(at).log() }
    }

    fn site_after(&self, v: VertexId, by: Vector) -> Option<Site> {
        let at = self.position(v) + by;
        Some(Site { at, log: self.field().at(at).log() })
    }

    fn quality(&self, [a, b, c]: [Site; 3]) -> f64 {
        ((a.log + b.log + c.log) * (1.0 / 3.0)).exp().shape([a.at, b.at, c.at])
    }

    fn straight_length(&self, [a, b]: [Site; 2]) -> f64 {
        ((a.log + b.log) * 0.5).exp().length(b.at - a.at)
    }

    fn settle_move(&mut self, v: VertexId) {
        self.remeasure(v);
        self.flip_around(v, Effort::Local);
    }
}

/// A place of a surface and the logarithm of the tensor there.
#[derive(Clone, Copy)]
pub(crate) struct SurfaceSite {
    place: Place,
    log: Tensor3,
}

impl SurfaceDual<'_> {
    fn site_of(&self, place: Place) -> SurfaceSite {
        let normal = self.input().normal(&place);
        SurfaceSite { log: (self.metric().at(&place) * self.factor()).log(), place: Place { normal, ..place } }
    }
}

impl Mending for SurfaceDual<'_> {
    type Site = SurfaceSite;

    fn site(&self, v: VertexId) -> SurfaceSite {
        self.site_of(self.places()[v.index()])
    }

    fn site_after(&self, v: VertexId, by: Vector) -> Option<SurfaceSite> {
        Some(self.site_of(self.place_after(v, by)?))
    }

    /// Negative where the triangle is turned over against the surface's normal at a corner.
    fn quality(&self, corners: [SurfaceSite; 3]) -> f64 {
        let [a, b, c] = corners.map(|site| site.place.position);
        let tensor = (corners.iter().fold(Tensor3::default(), |sum, site| sum + site.log) * (1.0 / 3.0)).exp();
        let (normal, quality) = ((b - a).cross(c - a), tensor.shape([a, b, c]));
        let is_upright = corners.iter().all(|site| site.place.normal.dot(normal) > 0.0);
        if is_upright { quality } else { -quality }
    }

    fn straight_length(&self, [a, b]: [SurfaceSite; 2]) -> f64 {
        ((a.log + b.log) * 0.5).exp().length(b.place.position - a.place.position)
    }

    fn settle_move(&mut self, v: VertexId) {
        self.remeasure(v);
        self.flip_around(v);
    }
}
