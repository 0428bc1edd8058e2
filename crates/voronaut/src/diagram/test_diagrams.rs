//! A domain and seeds for the tests of this module.

use crate::geometry::Point;
use crate::manifold::domain::Domain;
use crate::test_cases::plate;

/// A square from (-2, -2) to (2, 2) with a square hole from (-0.5, -0.5) to (0.5, 0.5).
pub(super) fn plate_with_hole() -> Domain {
    let square = |half: f64| [[-half, -half], [half, -half], [half, half], [-half, half]];
    plate(&[&square(2.0), &square(0.5)])
}

/// So many seeds along the additive sequence of the plastic number, those outside the plate's hole.
pub(super) fn seeds_of(domain: &Domain, count: usize) -> Vec<Point> {
    let part = |i: usize, a: f64| 3.9 * ((i as f64 * a) % 1.0) - 1.95;
    let all = (1..10 * count).map(|i| Point::new(part(i, 0.754_877_666), part(i, 0.569_840_291)));
    let is_inside = |p: &Point| p.x.abs() > 0.51 || p.y.abs() > 0.51;
    assert!(domain.area() < 16.0);
    all.filter(is_inside).take(count).collect()
}
