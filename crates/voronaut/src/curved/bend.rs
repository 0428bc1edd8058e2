//! Straight boundaries and interfaces bent onto the curves that they stand for.

use super::Away;
use super::bezier::curve_of_nodes;
use super::elements::{Elements, Hold};
use super::newton::{Aim, displace};
use crate::error::Result;
use crate::geometry::Point;
use crate::manifold::domain::Splines;
use crate::progress::Progress;

/// Steps until what is not on its curve stays away, at most: each goes half of the way at least where triangles allow it.
const STEPS: usize = 16;
/// The least Jacobian that bending may leave, far above rounding: the corner of a triangle both of whose sides there are on a smooth curve would open to a half
/// turn.
pub(super) const LEAST: f64 = 1e-6;

/// Moves the vertices and the sides on straight parts to the curves that these stand for, which they keep from then on. Returns how many points stay away,
/// because triangles would not be valid, and the first of them.
///
/// # Errors
/// The work is to stop.
pub(super) fn bend(elements: &mut Elements, curves: &Splines, aim: &Aim, progress: &dyn Progress) -> Result<Away> {
    let targets = targets(elements, curves);
    for &(p, _) in &targets {
        elements.holds[p as usize] = Hold::Free;
    }
    for step in 0..STEPS {
        if away(elements, &targets).is_empty() {
            break;
        }
        let given: Vec<_> = targets.iter().map(|&(p, to)| (p, to - elements.points[p as usize])).collect();
        // Most are not far from their curves, beside their triangles.
        displace(elements, aim, &given, step == 0);
        progress.advance(0)?;
    }
    for &(p, _) in &targets {
        elements.holds[p as usize] = Hold::Fixed;
    }
    let away = away(elements, &targets);
    Ok(away.first().map(|&first| (away.len(), first)))
}

/// Where points are that are not where they are to be, but for rounding.
fn away(elements: &Elements, targets: &[(u32, Point)]) -> Vec<Point> {
    let is_away = |&(at, to): &(Point, Point)| {
        let size = to.x.abs().max(to.y.abs()).max(at.x.abs()).max(at.y.abs());
        at.distance(to) > 4.0 * f64::EPSILON * size
    };
    let all = targets.iter().map(|&(p, to)| (elements.points[p as usize], to));
    all.filter(is_away).map(|(at, _)| at).collect()
}

/// The points of straight parts that stand for curves, and where these have them. Vertices keep their shares of the way; nodes between them are at equal
/// steps, for a polynomial through others meets a curve to second order only.
fn targets(elements: &Elements, curves: &Splines) -> Vec<(u32, Point)> {
    let mut targets = Vec::new();
    let order = elements.order;
    for numbers in elements.sides() {
        let Hold::Along([a, b]) = elements.holds[numbers[1] as usize] else { continue };
        let Some(arc) = curves.between([a, b]) else { continue };
        let ends = [numbers[0], numbers[order]];
        let [from, to] = ends.map(|v| (elements.points[v as usize] - a).dot(b - a) / (b - a).dot(b - a));
        let at = |i: usize| arc.at(from + (to - from) * i as f64 / order as f64);
        let mut nodes: Vec<Point> = (0..=order).map(at).collect();
        for (v, i) in ends.into_iter().zip([0, order]) {
            if elements.holds[v as usize] == Hold::Fixed {
                nodes[i] = elements.points[v as usize];
            } else {
                targets.push((v, nodes[i]));
            }
        }
        targets.extend(numbers[1..order].iter().copied().zip(curve_of_nodes(&nodes)));
    }
    targets.sort_unstable_by_key(|target| target.0);
    targets.dedup_by_key(|target| target.0);
    targets
}
