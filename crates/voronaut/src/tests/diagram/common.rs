//! What several of the tests need.

use crate::canvas::Canvas;
use crate::geometry::Point;
use crate::manifold::domain::{Domain, rect};
use crate::triangulation::VertexId;

/// A quasi-random sequence in the unit square (Halton, bases 2 and 3, a little shaken).
pub(crate) fn halton(i: u32) -> (f64, f64) {
    let radical = |mut i: u32, base: u32| {
        let (mut place, mut sum) = (1.0, 0.0);
        while i > 0 {
            place /= f64::from(base);
            sum += place * f64::from(i % base);
            i /= base;
        }
        sum
    };
    let shake = |x: f64| 1e-4 * (f64::from(i) * x).sin();
    ((radical(i, 2) + shake(1.7)).clamp(0.001, 0.999), (radical(i, 3) + shake(2.3)).clamp(0.001, 0.999))
}

pub(crate) fn square(half: f64) -> Domain {
    Domain::new(&rect(Point::new(-half, -half), Point::new(half, half)).unwrap()).unwrap()
}

pub(crate) fn vertices(canvas: &Canvas) -> impl Iterator<Item = VertexId> {
    (0..canvas.vertex_count() as u32).map(VertexId)
}
