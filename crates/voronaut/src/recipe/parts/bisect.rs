//! Triangles in parts of like metric area, by recursive bisection; and labels of triangles that hang together around each vertex.

use crate::geometry::{Point3, Tensor3, Vector3};
use crate::lists::{marked, ranked};
use crate::mesh::Edges;
use crate::mesh::edges::{NONE, fans, previous};
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// Sweeps over triangles that make cuts shorter.
const SWEEPS: usize = 3;
/// Sweeps that let the triangles of a label hang together, at most; each mends what the one before has left, or made.
const MENDINGS: usize = 64;

/// The part of each triangle, by recursive bisection of their metric areas across the longest extent of what is cut.
pub(super) fn owners(triangles: &[[u32; 3]], centres: &[Point3], areas: &[f64], parts: usize) -> Vec<u32> {
    let mut owner = vec![0; triangles.len()];
    Weighed { centres, areas }.bisect((0..triangles.len() as u32).collect(), 0..parts as u32, &mut owner);
    shorten(triangles, &mut owner);
    owner
}

/// The metric area of each part.
pub(super) fn areas_of(owner: &[u32], areas: &[f64], parts: usize) -> Vec<f64> {
    let mut of_parts = vec![0.0; parts];
    owner.iter().zip(areas).for_each(|(&part, area)| of_parts[part as usize] += area);
    of_parts
}

struct Weighed<'a> {
    centres: &'a [Point3],
    areas: &'a [f64],
}

impl Weighed<'_> {
    fn bisect(&self, triangles: Vec<u32>, parts: std::ops::Range<u32>, owner: &mut [u32]) {
        if parts.len() < 2 || triangles.len() < 2 {
            for t in triangles {
                owner[t as usize] = parts.start;
            }
            return;
        }
        let middle = parts.start + parts.len() as u32 / 2;
        let (axis, whole) = self.longest_axis(&triangles);
        let along = |&t: &u32| (axis.dot(self.centres[t as usize] - Point3::default()), t);
        let sorted: Vec<u32> = ranked(triangles.iter().map(along)).into_iter().map(|(_, t)| t).collect();
        let share = whole * f64::from(middle - parts.start) / parts.len() as f64;
        let mut behind = 0.0;
        let ahead = sorted.iter().position(|&t| {
            let half = 0.5 * self.areas[t as usize];
            behind += 2.0 * half;
            behind - half > share
        });
        let cut = ahead.unwrap_or(sorted.len()).clamp(1, sorted.len() - 1);
        let (first, second) = sorted.split_at(cut);
        self.bisect(first.to_vec(), parts.start..middle, owner);
        self.bisect(second.to_vec(), middle..parts.end, owner);
    }

    /// The direction in which the metric area of triangles is spread most, and that area.
    fn longest_axis(&self, triangles: &[u32]) -> (Vector3, f64) {
        let weighed =
            || triangles.iter().map(|&t| (self.areas[t as usize], self.centres[t as usize] - Point3::default()));
        let whole: f64 = weighed().map(|(area, _)| area).sum();
        let mean = weighed().fold(Vector3::default(), |sum, (area, p)| sum + p * (area / whole));
        let spread = weighed().fold(Tensor3::default(), |sum, (area, p)| sum + Tensor3::square(p - mean) * area);
        (spread.eigen().axes[0], whole)
    }
}

/// Gives triangles to the part that two of their neighbours have.
fn shorten(triangles: &[[u32; 3]], owner: &mut [u32]) {
    let twins = Edges::of(triangles).twins();
    let neighbour = |half_edge: usize| twins[half_edge] as usize / 3;
    for _ in 0..SWEEPS {
        for t in 0..owner.len() {
            let around = [0, 1, 2].map(|i| owner.get(neighbour(3 * t + i)).copied());
            let twice = (0..3).find(|&i| around[i].is_some() && around[i] == around[(i + 1) % 3]);
            if let Some(other) = twice.and_then(|i| around[i]) {
                owner[t] = other;
            }
        }
    }
}

/// The label of triangles that are in nothing.
pub(super) const NOWHERE: u32 = u32::MAX;

/// Changes labels so that around each vertex the triangles of one label hang together by edges, as those of a surface do. Where they
/// do not, the fewer get the labels of neighbours. Says whether that came to an end.
pub(super) fn join_around(triangles: &[[u32; 3]], labels: &mut [u32]) -> bool {
    let vertices = triangles.as_flattened().iter().max().map_or(0, |&v| v as usize + 1);
    let labelled = triangles.iter().zip(labels.iter()).filter(|(_, label)| **label != NOWHERE);
    let touched = marked(vertices, labelled.flat_map(|(corners, _)| *corners));
    let is_near = |t: &usize| triangles[*t].iter().any(|&v| touched[v as usize]);
    // What is far from labels has no say.
    let near: Vec<usize> = (0..triangles.len()).filter(is_near).collect();
    let mut of_near: Vec<u32> = near.iter().map(|&t| labels[t]).collect();
    let is_done = join_near(&near.iter().map(|&t| triangles[t]).collect::<Vec<_>>(), &mut of_near);
    near.into_iter().zip(of_near).for_each(|(t, label)| labels[t] = label);
    is_done
}

fn join_near(triangles: &[[u32; 3]], labels: &mut [u32]) -> bool {
    let (corners, twins) = (triangles.as_flattened(), Edges::of(triangles).twins());
    for _ in 0..MENDINGS {
        let label = |half_edge: u32| labels[half_edge as usize / 3];
        let beyond = |half_edge: u32| Some(twins[half_edge as usize]).filter(|&twin| twin != NONE);
        let alike =
            (0..corners.len() as u32).map(|h| beyond(h).filter(|&twin| label(twin) == label(h)).unwrap_or(NONE));
        let fans = fans(&alike.collect::<Vec<_>>(), |_, _| false);
        let mut sizes = vec![0; corners.len()];
        (0..corners.len() as u32).for_each(|h| sizes[fans.of(h) as usize] += 1);
        let mut largest: BTreeMap<(u32, u32), u32> = BTreeMap::new();
        let rank = |fan: u32| (sizes[fan as usize], Reverse(fan));
        for (h, &v) in (0..).zip(corners).filter(|&(h, _)| label(h) != NOWHERE) {
            let known = largest.entry((v, label(h))).or_insert_with(|| fans.of(h));
            *known = if rank(fans.of(h)) > rank(*known) { fans.of(h) } else { *known };
        }
        let is_apart = |h: u32, v| largest.get(&(v, label(h))).is_some_and(|&largest| largest != fans.of(h));
        let apart = (0..).zip(corners).filter(|&(h, &v)| is_apart(h, v));
        let other = |h: u32| [h, previous(h)].into_iter().filter_map(beyond).map(label).find(|&it| it != label(h));
        let changes: Vec<(usize, u32)> = apart.filter_map(|(h, _)| Some((h as usize / 3, other(h)?))).collect();
        if changes.is_empty() {
            return true;
        }
        for (t, label) in changes {
            labels[t] = label;
        }
    }
    false
}

/// How many vertices parts have, that they have so many together: those that are fixed in each, and of the rest a common share of what
/// the metric asks for in each.
pub(super) fn counts(fixed: &[f64], inside: &[f64], all: f64) -> Vec<usize> {
    // Where curves take all, as of narrow channels, roundings may take more: parts have their share of what there is.
    let fixed_all = fixed.iter().sum::<f64>();
    let thinned = (all / fixed_all).min(1.0);
    let share = (all - thinned * fixed_all) / inside.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let (mut sum, mut given) = (0.0, 0);
    let count = |(fixed, inside): (&f64, &f64)| {
        sum += thinned * fixed + share * inside;
        let upto = sum.round() as usize;
        let count = upto - given;
        given = upto;
        count
    };
    fixed.iter().zip(inside).map(count).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_of_a_label_hang_together_around_a_vertex() {
        // Six triangles around a vertex, two opposite ones of a label of their own.
        let triangles: Vec<[u32; 3]> = (0..6).map(|i| [6, i, (i + 1) % 6]).collect();
        let mut labels = vec![1, 0, 0, 1, 0, NOWHERE];
        assert!(join_around(&triangles, &mut labels));
        assert_eq!(labels, [1, 0, 0, 0, 0, NOWHERE]);
    }
}
