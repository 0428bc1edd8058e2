//! The local rule of first-order schemes: a plane wave that crosses the far edge of a triangle with a uniform metric.

use crate::geometry::{Tensor, Vector};

/// The distance at a vertex, seen from which an edge has its ends at u and w, of the shortest way across that edge, along
/// which the distance varies linearly between the two given (Bornemann and Rasch 2006); `None` if that way leads
/// through an end. It is never less than both distances, and may be less than one.
pub(super) fn crossing(metric: Tensor, [u, w]: [Vector; 2], at: [f64; 2]) -> Option<f64> {
    let e = u - w;
    let area = e.cross(w);
    across(metric.dot(e, e), metric.dot(e, w), metric.determinant() * area * area, at)
}

/// The same in the one metric that gives a triangle its lengths: those of the sides from the vertex to the edge's ends, and of
/// the edge.
pub(super) fn crossing_by_lengths([to_u, to_w]: [f64; 2], edge: f64, at: [f64; 2]) -> Option<f64> {
    let square = edge * edge;
    let along = 0.5 * (to_u * to_u - to_w * to_w - square);
    across(square, along, square * to_w * to_w - along * along, at)
}

/// From the products of e = u - w with itself and with w, and the determinant of the Gram matrix of e and w.
fn across(square: f64, along: f64, gram: f64, [at_u, at_w]: [f64; 2]) -> Option<f64> {
    let difference = at_u - at_w;
    let rest = square - difference * difference;
    if !(rest > 0.0 && gram > 0.0) {
        return None;
    }
    let foot = (-along - difference * (gram / rest).sqrt()) / square;
    let distance = at_w + (-difference * along + (gram * rest).sqrt()) / square;
    (foot > 0.0 && foot < 1.0 && distance.is_finite()).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_least_over_the_edge() {
        let mut found = 0;
        for i in 0..200 {
            let f = f64::from(i);
            let (angle, ratio) = (0.7 * f, 1.0 + (3.0 * f).sin().abs() * 30.0);
            let metric = Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), ratio, 1.0);
            let (u, w) = (Vector::new(1.0 + (1.1 * f).sin(), 0.5), Vector::new(-0.4, 1.0 + 0.5 * (2.3 * f).cos()));
            let at = [2.0 + 0.8 * (1.7 * f).sin(), 2.0];
            let through = |p: f64| p * at[0] + (1.0 - p) * at[1] + metric.length(u * p + w * (1.0 - p));
            let least = (0..=20_000).map(|k| through(f64::from(k) / 20_000.0)).fold(f64::INFINITY, f64::min);
            let sides = [metric.length(u), metric.length(w)];
            let by_lengths = crossing_by_lengths(sides, metric.length(u - w), at);
            match crossing(metric, [u, w], at) {
                Some(distance) => {
                    found += 1;
                    assert!((distance - least).abs() < 1e-6, "{distance} {least}");
                    assert!(distance >= at[0].min(at[1]));
                    assert!((by_lengths.unwrap() - distance).abs() < 1e-6, "{by_lengths:?} {distance}");
                }
                None => assert!(least >= through(0.0).min(through(1.0)) - 1e-12),
            }
        }
        assert!(found > 40, "{found}");
    }
}
