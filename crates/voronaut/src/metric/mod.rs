//! Metric fields: a symmetric positive definite tensor at every point of the domain.
//!
//! | field | as a METRIC | what it is |
//! |---|---|---|
//! | [`Uniform`] | `uniform`, `uniform:m11,m12,m22` | the same tensor everywhere |
//! | [`Swirl`] | `swirl:nu=3,field=authors` | long cells along a spiral (RR-9103, 15.3) |
//! | [`Shock`] | `shock:phi=10,lambda=0.6` | thin cells across a sine-shaped front (RR-9103, 15.2) |
//! | [`Formula`] | `formula:m11; m12; m22` | three expressions in x and y |
//! | [`Boundary`] | `boundary:h0=0.01,growth=1.2,aspect=1,h_max=inf` | layers along the boundary |
//! | [`Hessian`] | `hessian:EXPR` | optimal for the interpolation of a function |
//! | `Recovered` | `hessian:FILE.sol` | the same, for a solution at the vertices of a mesh |
//! | [`Sampled`] | `FILE.sol` | tensors or sizes at the vertices of a mesh, log-Euclidean between them |
//! | [`Bounded`] | `--h-min --h-max --a-max` | another field within limits |
//! | `smoothed()` | `--smooth-metric` | another field, averaged over neighbours on a background mesh |
//! | [`Scaled`] | `-n`, `--complexity` | another field times a factor |
//! | `Steadied` | `--mesher starset` | another field, finer where it turns |
//!
//! [`nodal`] has metrics at the vertices of a mesh, and what adapters do with them; [`recover_hessian`] what they come from.
//!
//! [`MetricSpec`] reads the second column; [`complexity()`] integrates sqrt(det M); `check_tensor` and
//! `check_field` tell whether values are a metric. Fields do not check their own values: whoever uses a tensor does.

mod analytic;
mod boundary;
mod bounds;
mod complexity;
mod expression;
mod form;
mod formula;
mod hessian;
mod neighbours;
pub mod nodal;
mod norm;
mod optimal;
mod parser;
mod program;
mod recovery;
mod sampled;
mod scaled;
mod series;
mod sharing;
mod smoothed;
mod spec;
mod validate;
mod vocabulary;

pub use analytic::{Shock, Swirl, SwirlField, Uniform};
pub use boundary::{Boundary, BoundarySizes};
pub use bounds::{Bounded, Bounds};
pub use complexity::complexity;
pub(crate) use complexity::{complexities, rough_complexity};
pub use expression::Expression;
pub use formula::{Formula, Snapshot, SpaceFormula};
pub use hessian::Hessian;
pub(crate) use hessian::{FLOOR, Recovered, rounding};
pub(crate) use neighbours::Neighbours;
pub use norm::Norm;
pub(crate) use optimal::Optimal;
pub use recovery::{Recovery, recover_hessian};
pub(crate) use recovery::{hessian_around, least_squares};
pub use sampled::Sampled;
pub use scaled::Scaled;
pub(crate) use scaled::Steadied;
pub use smoothed::MOST_SWEEPS;
pub(crate) use smoothed::{smoothed, swept};
pub use spec::MetricSpec;
pub(crate) use spec::{Parameters, name_and_rest};
pub(crate) use validate::{
    check_at_vertices, check_field, check_sizes, check_tensor, check_tensor_at, check_tensor3, require,
};
pub use vocabulary::Variables;

use crate::geometry::{Aabb, Jet, Point, Tensor};
use crate::mesh::Mesh;
use std::cell::Cell;

/// A Riemannian metric field on the plane.
///
/// The contract: `at` is a pure function of the point, defined on the whole domain and finite a little outside it
/// (derivatives are taken by differences), and returns a positive definite tensor in units of 1 / length^2.
pub trait MetricField: Sync {
    /// The tensor at a point.
    fn at(&self, p: Point) -> Tensor;

    /// The same, but for rounding, where the point is near that of the last call with this `near`: a field that looks for places
    /// looks there first.
    fn at_near(&self, p: Point, _near: &mut Near) -> Tensor {
        self.at(p)
    }

    /// All that has to be known of it in a domain and around, which is given as triangles: tensors at the vertices of a mesh. `None` where
    /// the field is no such thing, or the domain is not where the mesh is.
    fn excerpt(&self, _domain: &Mesh) -> Option<(Mesh, Vec<Tensor>)> {
        None
    }

    /// The integral of sqrt(det M) over a domain, in closed form: known where the field is given on triangles, and these have the area and
    /// the bounds of the domain but for a share of them.
    fn integral(&self, _area: f64, _bounds: Aabb, _share: f64) -> Option<f64> {
        None
    }
}

/// Where a field or a function found what it was last asked for; at first nowhere.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Near {
    pub(crate) place: Option<u32>,
}

/// A field that is asked for places near each other, one after the other.
pub(crate) fn nearby(field: &dyn MetricField) -> impl Fn(Point) -> Tensor + '_ {
    let found = Cell::new(Near::default());
    move |p| {
        let mut near = found.get();
        let tensor = field.at_near(p, &mut near);
        found.set(near);
        tensor
    }
}

impl<F: Fn(Point) -> Tensor + Sync> MetricField for F {
    fn at(&self, p: Point) -> Tensor {
        self(p)
    }
}

impl MetricField for Box<dyn MetricField + '_> {
    fn at(&self, p: Point) -> Tensor {
        (**self).at(p)
    }

    fn at_near(&self, p: Point, near: &mut Near) -> Tensor {
        (**self).at_near(p, near)
    }

    fn excerpt(&self, domain: &Mesh) -> Option<(Mesh, Vec<Tensor>)> {
        (**self).excerpt(domain)
    }

    fn integral(&self, area: f64, bounds: Aabb, share: f64) -> Option<f64> {
        (**self).integral(area, bounds, share)
    }
}

/// A function on the plane.
///
/// The contract: `value` is a pure function of the point, defined on the whole domain; where it is not finite, whoever uses
/// it says so.
pub trait ScalarField: Sync {
    /// The value at a point.
    fn value(&self, p: Point) -> f64;

    /// The value, and first and second derivatives by x and y; `None` where these are not known in closed form.
    fn jet(&self, _p: Point) -> Option<Jet> {
        None
    }

    /// [`value`](Self::value), but for rounding, where the point is near that of the last call with this `near`.
    fn value_near(&self, p: Point, _near: &mut Near) -> f64 {
        self.value(p)
    }

    /// [`jet`](Self::jet), in the same way.
    fn jet_near(&self, p: Point, _near: &mut Near) -> Option<Jet> {
        self.jet(p)
    }
}

impl<F: Fn(Point) -> f64 + Sync> ScalarField for F {
    fn value(&self, p: Point) -> f64 {
        self(p)
    }
}
