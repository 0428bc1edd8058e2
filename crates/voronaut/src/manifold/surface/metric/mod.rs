//! Metric fields on surfaces: a symmetric positive definite tensor of space at every place of a surface, of which edges
//! see the part in the tangent plane.
//!
//! | field | as a METRIC | what it is |
//! |---|---|---|
//! | `Constant` | `uniform` | the surface's own lengths |
//! | [`Shock`] | `shock:phi=10,lambda=0.6` | thin across the shock of RR-9103, 15.2, in space |
//! | [`SpaceFormula`] | `formula:m11; m12; m22; m13; m23; m33` | six expressions in x, y, z |
//! | `ImplicitCurvature` | `curvature`, of an equation | principal curvatures, exact (RR-9103, 15.1) |
//! | [`Sampled`] | `curvature`, of a file | principal curvatures at vertices, fitted (`fit_curvatures`) |
//! | `CovariantHessian` | `hessian:EXPR` | optimal for the interpolation of a function of x, y and z on the surface |
//! | [`Sampled`] | `hessian:FILE.sol` | the same, recovered from values at vertices |
//! | [`Sampled`] | `FILE.sol` | tensors or sizes at vertices, log-Euclidean between them |
//! | [`Sampled`] | what `remesh` makes | sizes at vertices for a distance to the surface, graded ([`Sizing`]) |
//! | `Closer` | `--hausd` | another field, finer where a distance to the surface asks for it |
//! | [`Finer`] | `--hausd` | another field, finer where a mesh came out too far from the surface |
//! | [`Bounded`](crate::metric::Bounded) | `--h-min --h-max --a-max` | another field within limits, in the tangent plane |
//!
//! [`Spec`] reads the second column, [`field`] makes the field; `check_tensor3` tells whether a value is a metric.

mod area;
mod bounded;
mod curvature;
mod finer;
mod gradation;
mod hessian;
mod nodal;
mod sampled;
mod sizing;
mod spec;

pub(crate) use crate::metric::check_tensor3;
pub(crate) use area::area_of_surface;
pub(crate) use bounded::Closer;
pub(crate) use curvature::fit_curvatures;
pub(crate) use curvature::{FLOOR, ImplicitCurvature, sampled_curvature};
pub use finer::Finer;
pub(crate) use gradation::{grade, grade_tensors};
pub(crate) use hessian::{CovariantHessian, hessians_on, recovered_on};
pub(crate) use nodal::TangentPlanes;
pub(crate) use sampled::filled;
pub use sampled::{Sampled, Sizes};
pub use sizing::Sizing;
pub use spec::{Spec, field};
pub(crate) use spec::{field_of_values, within};

use super::super::Place;
use crate::geometry::{Point, Point3, Tensor3};
use crate::metric::{MetricField, Shock, SpaceFormula};

/// A Riemannian metric field on a surface.
///
/// The contract: `at` is a pure function of the place and returns a positive definite tensor in units of 1 / length^2.
/// Whatever it says of the normal direction, no edge sees it.
pub trait SurfaceMetric: Sync {
    /// The tensor at a place.
    fn at(&self, place: &Place) -> Tensor3;

    /// What bounds made of the curvatures that it rests on, if it rests on those of a mesh.
    fn curvature_figures(&self) -> Option<CurvatureFigures> {
        None
    }
}

/// Fields of space are fields on every surface.
impl<F: Fn(Point3) -> Tensor3 + Sync> SurfaceMetric for F {
    fn at(&self, place: &Place) -> Tensor3 {
        self(place.position)
    }
}

impl SurfaceMetric for Box<dyn SurfaceMetric + '_> {
    fn at(&self, place: &Place) -> Tensor3 {
        (**self).at(place)
    }

    fn curvature_figures(&self) -> Option<CurvatureFigures> {
        (**self).curvature_figures()
    }
}

/// The same tensor everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Constant(pub(crate) Tensor3);

impl SurfaceMetric for Constant {
    fn at(&self, _place: &Place) -> Tensor3 {
        self.0
    }
}

/// Another field times a factor.
pub struct Scaled<'a> {
    /// The field.
    pub field: &'a dyn SurfaceMetric,
    /// What its tensors are multiplied by, positive and finite.
    pub factor: f64,
}

impl SurfaceMetric for Scaled<'_> {
    fn at(&self, place: &Place) -> Tensor3 {
        self.field.at(place) * self.factor
    }

    fn curvature_figures(&self) -> Option<CurvatureFigures> {
        self.field.curvature_figures()
    }
}

/// E does not depend on z: F = U diag(1 + phi |grad E|, 1, 1) U' has the planar field in its upper left corner.
impl SurfaceMetric for Shock {
    fn at(&self, place: &Place) -> Tensor3 {
        let planar = MetricField::at(self, Point::new(place.position.x, place.position.y));
        Tensor3 { xx: planar.xx, xy: planar.xy, yy: planar.yy, ..Tensor3::IDENTITY }
    }
}

impl SurfaceMetric for SpaceFormula {
    fn at(&self, place: &Place) -> Tensor3 {
        self.tensor(place.position)
    }
}

/// What bounds have made of curvatures, in numbers of vertices.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct CurvatureFigures {
    /// Lesser curvatures count as this one, in units of 1 / length.
    pub floor: f64,
    /// Vertices where the lesser curvature is below it.
    pub floored: usize,
    /// Vertices where the greater curvature is above what edges there can tell, and counts as that.
    pub capped: usize,
    /// Vertices without a fit, which have their neighbours' mean.
    pub unfitted: usize,
    /// The greatest curvature in use.
    pub greatest: f64,
}
