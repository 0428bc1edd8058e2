//! A metric where it is looked at, and angles in it.

use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::{MetricField, Near, check_tensor};

/// The angle (radians, from -pi to pi) by which u must turn to point along v, in a metric.
pub(super) fn angle(m: Tensor, u: Vector, v: Vector) -> f64 {
    (m.determinant().max(0.0).sqrt() * u.cross(v)).arctangent_over(m.dot(u, v))
}

pub(super) fn tensor(metric: &dyn MetricField, p: Point) -> Result<Tensor> {
    tensor_near(metric, p, &mut Near::default())
}

pub(super) fn tensor_near(metric: &dyn MetricField, p: Point, near: &mut Near) -> Result<Tensor> {
    let m = metric.at_near(p, near);
    check_tensor(m, p)?;
    Ok(m)
}
