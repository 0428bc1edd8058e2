//! Triangles by their sides, and the loops of sides that lack one.

use super::Judge;
use crate::elementary::Elementary;
use crate::geometry::Vector;
use std::collections::BTreeMap;

/// The sides of triangles accepted so far: which triangle has the side a -> b.
pub(super) struct Sides<'a> {
    pub(super) judge: &'a dyn Judge,
    next: BTreeMap<(u32, u32), u32>,
}

impl<'a> Sides<'a> {
    /// None yet.
    pub(super) fn new(judge: &'a dyn Judge) -> Self {
        Self { judge, next: BTreeMap::new() }
    }

    /// How many triangles there are.
    pub(super) fn count(&self) -> usize {
        self.next.len() / 3
    }

    pub(super) fn are_seeds(&self, [a, b, c]: [u32; 3]) -> bool {
        a != b && b != c && c != a && [a, b, c].into_iter().all(|i| self.judge.is_seed(i))
    }

    pub(super) fn has(&self, a: u32, b: u32) -> bool {
        self.next.contains_key(&(a, b))
    }

    /// Adds a triangle unless one of its sides is taken.
    pub(super) fn add(&mut self, [a, b, c]: [u32; 3]) -> bool {
        let sides = [(a, b, c), (b, c, a), (c, a, b)];
        let is_free = sides.iter().all(|&(from, to, _)| !self.has(from, to));
        if is_free {
            self.next.extend(sides.map(|(from, to, apex)| ((from, to), apex)));
        }
        is_free
    }

    /// The triangles accepted, the smallest corner of each first, sorted.
    pub(super) fn triangles(&self) -> Vec<[u32; 3]> {
        let all = self.next.iter().map(|(&(a, b), &c)| [a, b, c]);
        all.filter(|&[a, b, c]| a < b && a < c).collect()
    }

    /// Removes the triangles beside loops; returns how many.
    pub(super) fn remove_along(&mut self, loops: &[Vec<u32>]) -> u64 {
        let before = self.next.len();
        for corners in loops {
            for (&a, &b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                if let Some(&c) = self.next.get(&(b, a)) {
                    for side in [(b, a), (a, c), (c, b)] {
                        self.next.remove(&side);
                    }
                }
            }
        }
        ((before - self.next.len()) / 3) as u64
    }

    /// The loops of sides with a triangle on one side only: the missing triangles lie to their left. Each is simple.
    pub(super) fn outlines(&self) -> Vec<Vec<u32>> {
        let mut leaving: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for &(a, b) in self.next.keys().filter(|&&(a, b)| !self.has(b, a)) {
            leaving.entry(b).or_default().push(a);
        }
        let mut outlines = Vec::new();
        while let Some((&first, _)) = leaving.iter().find(|(_, targets)| !targets.is_empty()) {
            let mut walk: Vec<u32> = vec![first];
            let mut at = first;
            let mut from = None;
            while let Some(next) = self.turn(from, at, &mut leaving) {
                (from, at) = (Some(at), next);
                if let Some(place) = walk.iter().position(|&v| v == at) {
                    outlines.push(walk.split_off(place));
                }
                walk.push(at);
            }
        }
        outlines.retain(|outline| outline.len() > 2);
        outlines
    }

    /// The next vertex of a loop that has come to `at`: where several sides leave, the first clockwise from where the loop
    /// came from.
    fn turn(&self, from: Option<u32>, at: u32, leaving: &mut BTreeMap<u32, Vec<u32>>) -> Option<u32> {
        let targets = leaving.get_mut(&at).filter(|targets| !targets.is_empty())?;
        let direction = |v: u32| self.judge.direction(at, v);
        let best = match from {
            Some(from) if targets.len() > 1 => {
                let back = direction(from);
                let angle = |&i: &usize| clockwise(back, direction(targets[i]));
                (0..targets.len()).min_by(|a, b| angle(a).total_cmp(&angle(b)))?
            }
            _ => 0,
        };
        Some(targets.swap_remove(best))
    }
}

/// The angle from u clockwise to v, in (0, 2 pi].
fn clockwise(u: Vector, v: Vector) -> f64 {
    let angle = v.cross(u).arctangent_over(v.dot(u));
    if angle > 0.0 { angle } else { angle + std::f64::consts::TAU }
}
