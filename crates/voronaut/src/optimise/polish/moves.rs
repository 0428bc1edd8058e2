//! Moves that lower the error.

use super::colours::colours;
use super::error::Place;
use super::{Freedom, Work, is_allowed};
use crate::geometry::{Point, Vector};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

/// Step of the differences that derivatives are taken by, as a share of the neighbours' mean distance.
const STEP: f64 = 0.03;
/// Longest move, in the same unit.
const LONGEST: f64 = 0.5;
/// Shorter moves that are tried when a move does not lower the error, and by how much they are shorter.
const TRIALS: usize = 5;
const SHORTER: f64 = 0.4;
/// A second derivative is at least this share of the greatest.
const LEAST_CURVATURE: f64 = 1e-3;

impl Work<'_> {
    /// Moves every vertex once, those of one colour at a time. Returns how many moved.
    pub(super) fn move_all(&mut self) -> u64 {
        let mut moved = 0;
        for group in colours(&self.planar.topology, &self.freedoms) {
            let better: Vec<Option<Place>> = group.par_iter().with_min_len(16).map(|&v| self.better(v)).collect();
            for (v, place) in group.into_iter().zip(better) {
                let Some(place) = place else { continue };
                if self.planar.move_vertex(v, place.at) {
                    self.places[v.index()] = place;
                    moved += 1;
                }
            }
        }
        moved
    }

    /// Where a vertex would better be: a step of Newton's method on the error around it.
    fn better(&self, v: VertexId) -> Option<Place> {
        let topology = &self.planar.topology;
        let ring: Vec<[VertexId; 2]> = topology.star(v).map(|h| [topology.target(h), topology.apex(h)]).collect();
        let corners = |place: Place, [a, b]: [VertexId; 2]| [place, self.place(a), self.place(b)];
        let error_at = |place: Place| -> f64 { ring.iter().map(|&side| self.objective.of(corners(place, side))).sum() };
        let shape_at = |place: Place| {
            ring.iter().map(|&[a, b]| self.shape([v, a, b], corners(place, [a, b]))).fold(f64::INFINITY, f64::min)
        };
        let frame = self.frame(v, &ring)?;
        let here = self.place(v);
        let place = |step: [f64; 2]| self.objective.place(frame.at(here.at, step));
        let now = error_at(here);
        let [mut x, mut y] = frame.newton(now, |step| error_at(place(step)))?;
        for _ in 0..TRIALS {
            let there = place([x, y]);
            if error_at(there) < now && is_allowed(shape_at(here), shape_at(there)) {
                return Some(there);
            }
            (x, y) = (x * SHORTER, y * SHORTER);
        }
        None
    }

    /// The directions and lengths in which a vertex can move: those of the ellipse of inertia of its neighbours.
    fn frame(&self, v: VertexId, ring: &[[VertexId; 2]]) -> Option<Frame> {
        let here = self.place(v).at;
        if self.freedoms[v.index()] == Freedom::Along {
            let [a, b] = self.planar.neighbours_on_segment(v)?;
            let share = (here - a).dot(b - a) / (b - a).dot(b - a);
            return Some(Frame { segment: Some(([a, b], share)), first: (b - a) * 0.5, second: None });
        }
        let around: Vec<Vector> = ring.iter().flatten().map(|&u| self.place(u).at - here).collect();
        let mean = |of: fn(&Vector) -> f64| around.iter().map(of).sum::<f64>() / around.len() as f64;
        let (xx, xy, yy) = (mean(|d| d.x * d.x), mean(|d| d.x * d.y), mean(|d| d.y * d.y));
        let first = Vector::new(xx.sqrt(), xy / xx.sqrt());
        let rest = (yy - first.y * first.y).max(0.0).sqrt();
        (first.x > 0.0 && rest > 0.0).then_some(Frame { segment: None, first, second: Some(Vector::new(0.0, rest)) })
    }
}

/// One or two directions, of the length of a typical edge that way.
struct Frame {
    /// The ends of the segment that a vertex slides along, and where between them it is: steps do not add up their rounding.
    segment: Option<([Point; 2], f64)>,
    first: Vector,
    second: Option<Vector>,
}

impl Frame {
    fn at(&self, from: Point, [x, y]: [f64; 2]) -> Point {
        match self.segment {
            Some(([a, b], share)) => a.lerp(b, share + 0.5 * x),
            None => from + self.first * x + self.second.unwrap_or_default() * y,
        }
    }

    /// The step to the minimum of a quadratic through values around, made convex where it is not.
    fn newton(&self, now: f64, error: impl Fn([f64; 2]) -> f64) -> Option<[f64; 2]> {
        let h = STEP;
        let (right, left) = (error([h, 0.0]), error([-h, 0.0]));
        let (gx, xx) = ((right - left) / (2.0 * h), (right - 2.0 * now + left) / (h * h));
        let step = if self.second.is_some() {
            let (up, down) = (error([0.0, h]), error([0.0, -h]));
            let (gy, yy) = ((up - down) / (2.0 * h), (up - 2.0 * now + down) / (h * h));
            let corners = error([h, h]) + error([-h, -h]);
            let xy = (corners - right - left - up - down + 2.0 * now) / (2.0 * h * h);
            descent([gx, gy], [xx, xy, yy])?
        } else {
            [-gx / xx.abs(), 0.0]
        };
        let length = step[0].hypot(step[1]);
        let share = (LONGEST / length).min(1.0);
        length.is_finite().then(|| step.map(|s| s * share))
    }
}

/// Minus the inverse of a symmetric matrix, of which eigenvalues count by their size, times a gradient. `None` where that is
/// not finite.
fn descent([gx, gy]: [f64; 2], [xx, xy, yy]: [f64; 3]) -> Option<[f64; 2]> {
    let (mean, half) = (0.5 * (xx + yy), 0.5 * (xx - yy));
    let radius = half.hypot(xy);
    let (sine, cosine) = (0.5 * xy.atan2(half)).sin_cos();
    let [large, small] = [mean + radius, mean - radius].map(f64::abs);
    let least = LEAST_CURVATURE * large.max(small);
    let along = -(gx * cosine + gy * sine) / large.max(least);
    let across = -(gy * cosine - gx * sine) / small.max(least);
    let step = [along * cosine - across * sine, along * sine + across * cosine];
    step.iter().all(|s| s.is_finite()).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_minimum_of_a_quadratic_is_found_at_once() {
        let (first, second) = (Vector::new(1.0, 0.0), Some(Vector::new(0.0, 1.0)));
        let frame = Frame { segment: None, first, second };
        let error = |[x, y]: [f64; 2]| 3.0 * (x - 0.1).powi(2) + 2.0 * (x - 0.1) * (y + 0.2) + (y + 0.2).powi(2);
        let [x, y] = frame.newton(error([0.0, 0.0]), error).unwrap();
        assert!((x - 0.1).abs() < 1e-9 && (y + 0.2).abs() < 1e-9, "{x} {y}");
    }

    #[test]
    fn where_it_is_not_convex_the_step_goes_downhill() {
        let [x, y] = descent([1.0, -2.0], [-3.0, 0.5, -1.0]).unwrap();
        assert!(x - 2.0 * y < 0.0, "{x} {y}");
        assert_eq!(descent([1.0, f64::NAN], [1.0, 0.0, 1.0]), None);
        assert_eq!(descent([0.0, 0.0], [0.0, 0.0, 0.0]), None);
    }
}
