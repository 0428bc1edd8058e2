//! Sides moved onto geodesics between their ends, as far as polynomials can be.

use super::elements::{Elements, Hold};
use super::local::solved;
use super::newton::{Aim, displace};
use super::rules::{GAUSS, on_curve};
use super::term::{Around, curve_at, curve_length, transposed};
use crate::geodesic::is_unit;
use crate::geometry::{Point, Vector, to_frame};
use crate::metric::{MetricField, Near};
use crate::parallel::prelude::*;

/// Steps to the least energy of a curve, at most; each gains digits, for what the metric's second derivatives say is left out.
const STEPS: usize = 12;
/// They end where one gains less than this share of the energy: it is as long as rounding of places lets it be.
const LEAST_GAIN: f64 = 1e-24;
/// Steps that gain less are taken as they are: slopes are known better than energies.
const KNOWN_GAIN: f64 = 1e-12;

/// Moves the inner points of the sides inside to where the energy of these is least between their ends; less far where triangles would not be valid. Of polynomials
/// these are nearest to geodesics that are passed at constant speed, to within the power of their length that is one above the order. Sides of unit length
/// whose geodesics are not of unit length stay: they are bowed where the metric turns within a triangle.
pub(super) fn straighten(elements: &mut Elements, aim: &Aim) {
    let order = elements.order;
    let sides: Vec<Vec<u32>> =
        elements.sides().filter(|numbers| elements.holds[numbers[1] as usize] == Hold::Free).collect();
    let steps = |numbers: &Vec<u32>| -> Vec<(u32, Vector)> {
        let old: Vec<Point> = numbers.iter().map(|&n| elements.points[n as usize]).collect();
        let is_unit = |curve: &Vec<Point>| is_unit(curve_length(curve, aim.metric));
        let new = shortest(&old, aim.metric).filter(|new| is_unit(new) || !is_unit(&old));
        let Some(new) = new else { return Vec::new() };
        (1..order).map(|i| (numbers[i], new[i] - old[i])).collect()
    };
    let given: Vec<(u32, Vector)> = sides.par_iter().map(steps).collect::<Vec<_>>().concat();
    displace(elements, aim, &given, true);
}

/// The curve of the same order and ends with the least energy, near one; none where steps do not lead there.
fn shortest(points: &[Point], metric: &dyn MetricField) -> Option<Vec<Point>> {
    let (mut points, mut near) = (points.to_vec(), Near::default());
    let mut energy = energy(&points, metric, &mut near);
    for _ in 0..STEPS {
        let (matrix, slope) = expansion(&points, metric, &mut near);
        let decrease = |step: &[f64]| step.iter().zip(&slope).map(|(d, s)| d * s).sum::<f64>();
        let step = solved(matrix, slope.clone())?;
        // Twice the energy that the step gains where its model is right.
        let gain = decrease(&step);
        if gain <= LEAST_GAIN * energy {
            return Some(points);
        }
        let shares = [1.0, 0.5, 0.25, 0.125].into_iter();
        let tries = shares.map(|share| {
            let mut moved = points.clone();
            for (p, d) in moved[1..].iter_mut().zip(step.chunks(2)) {
                *p = *p + Vector::new(d[0], d[1]) * share;
            }
            (self::energy(&moved, metric, &mut near), moved)
        });
        (energy, points) = tries.into_iter().find(|tried| gain <= KNOWN_GAIN * energy || tried.0 < energy)?;
    }
    Some(points)
}

/// Half the integral of the square of the metric speed.
fn energy(points: &[Point], metric: &dyn MetricField, near: &mut Near) -> f64 {
    let at = |&(t, weight): &(f64, f64)| {
        let (p, slope) = curve_at(points, t);
        0.5 * weight * metric.at_near(p, near).dot(slope, slope)
    };
    GAUSS.iter().map(at).sum()
}

/// Second derivatives by the inner points as if the metric were that of the place everywhere, by the rows of their lower half, and the slope, turned
/// around.
fn expansion(points: &[Point], metric: &dyn MetricField, near: &mut Near) -> (Vec<Vec<f64>>, Vec<f64>) {
    let order = points.len() - 1;
    let size = 2 * (order - 1);
    let (mut matrix, mut slope) = (vec![vec![0.0; size]; size], vec![0.0; size]);
    for (t, weight) in GAUSS {
        let (p, speed) = curve_at(points, t);
        let basis = on_curve(order, t);
        let m = metric.at_near(p, near);
        let frame = m.cholesky();
        let around = Around::of(metric, p, m, near);
        let [x, y] = around.first.map(|e| e.dot(to_frame(frame, speed), to_frame(frame, speed)));
        let (pulled, moved) = (m.apply(speed), transposed(frame, Vector::new(x, y)) * 0.5);
        for i in 0..size {
            let [value, by_t] = basis[1 + i / 2];
            let force = pulled * by_t + moved * value;
            slope[i] -= weight * if i % 2 == 0 { force.x } else { force.y };
            for j in 0..=i {
                let entry = [[m.xx, m.xy], [m.xy, m.yy]][i % 2][j % 2];
                matrix[i][j] += weight * entry * by_t * basis[1 + j / 2][1];
            }
        }
    }
    (matrix, slope)
}
