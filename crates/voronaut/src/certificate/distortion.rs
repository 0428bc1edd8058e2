//! The distortion between tensors (RR-9103, section 3.2), and how large it gets around a seed.

use crate::elementary::Elementary;
use crate::geometry::{Point, Tensor};
use crate::metric::MetricField;

/// Where the metric is sampled around a seed: circles in the seed's own metric, and places on each.
const CIRCLES: usize = 12;
const PLACES: usize = 48;

/// psi: the metrics of two tensors measure no vector longer than this times what the other does. At least 1; infinite where
/// one of them is no metric.
pub(crate) fn distortion(g: Tensor, h: Tensor) -> f64 {
    let [_, inverse] = g.frames();
    let eigen = h.along(inverse).eigen();
    let is_metric = eigen.small > 0.0 && eigen.large.is_finite();
    if is_metric { eigen.large.max(1.0 / eigen.small).max(1.0).sqrt() } else { f64::INFINITY }
}

/// An estimate of the greatest distortion between the tensor at a point and those within a distance of it, measured
/// with that tensor: the largest of 576 samples, times the root of the largest ratio of two neighbouring ones. No
/// bound: a field may do what it likes between samples.
pub(crate) fn distortion_around(field: &dyn MetricField, p: Point, radius: f64) -> f64 {
    let centre = field.at(p);
    let [_, [u, v]] = centre.frames();
    let sample = |circle: usize, place: usize| {
        let (sin, cos) = (std::f64::consts::TAU * place as f64 / PLACES as f64).sine_and_cosine();
        let r = radius * circle as f64 / CIRCLES as f64;
        distortion(centre, field.at(p + (u * cos + v * sin) * r)).logarithm()
    };
    let (mut inner, mut most, mut jump) = (vec![0.0; PLACES], 0.0_f64, 0.0_f64);
    for circle in 1..=CIRCLES {
        let outer: Vec<f64> = (0..PLACES).map(|place| sample(circle, place)).collect();
        for (place, &value) in outer.iter().enumerate() {
            let beside = outer[(place + 1) % PLACES];
            most = most.max(value);
            jump = jump.max((value - beside).abs()).max((value - inner[place]).abs());
        }
        inner = outer;
    }
    let psi = (most + 0.5 * jump).exponential();
    // What is no metric somewhere is distorted beyond measure.
    if psi.is_finite() { psi } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;

    #[test]
    fn what_is_no_metric_is_distorted_beyond_measure() {
        let (good, nan, indefinite) = (Tensor::IDENTITY, Tensor::isotropic(f64::NAN), Tensor::new(1.0, 2.0, 1.0));
        for bad in [nan, indefinite] {
            assert!(distortion(good, bad).is_infinite() && distortion(bad, good).is_infinite(), "{bad:?}");
            let field = move |p: Point| if p.x > 0.9 { bad } else { good };
            assert!(distortion_around(&field, Point::new(0.0, 0.0), 1.0).is_infinite(), "{bad:?}");
            assert!(distortion_around(&field, Point::new(1.0, 0.0), 0.05).is_infinite(), "{bad:?}");
        }
    }

    #[test]
    fn equal_tensors_are_not_distorted_and_scaled_ones_by_the_scale() {
        let g = Tensor::new(5.0, -2.0, 3.0);
        assert!(distortion(g, g) - 1.0 < 1e-12);
        assert!((distortion(g, g * 4.0) - 2.0).abs() < 1e-12 && (distortion(g * 4.0, g) - 2.0).abs() < 1e-12);
        let h = Tensor::new(1.0, 0.3, 9.0);
        assert!((distortion(g, h) - distortion(h, g)).abs() < 1e-12);
    }

    #[test]
    fn no_vector_shows_more_and_one_shows_as_much() {
        let (g, h) = (Tensor::new(5.0, -2.0, 3.0), Tensor::new(1.0, 0.3, 9.0));
        let ratio = |i: u32| {
            let (y, x) = (f64::from(i) * 1e-3).sin_cos();
            let v = Vector::new(x, y);
            (g.length(v) / h.length(v)).max(h.length(v) / g.length(v))
        };
        let most = (0..3142).map(ratio).fold(1.0, f64::max);
        assert!(most <= distortion(g, h) && most > 0.999_99 * distortion(g, h));
    }

    #[test]
    fn around_a_point_it_is_that_of_the_farthest_point_of_a_growing_metric() {
        // Lengths grow by e^x: within a distance r of (0, 0), measured with the tensor there, by e^r at most.
        let field = |p: Point| Tensor::isotropic((-p.x).exp());
        let psi = distortion_around(&field, Point::default(), 0.1);
        assert!(psi >= 0.1_f64.exp() && psi < 0.11_f64.exp(), "{psi}");
        assert!(distortion_around(&|_: Point| Tensor::new(5.0, -2.0, 3.0), Point::default(), 3.0) - 1.0 < 1e-12);
    }
}
