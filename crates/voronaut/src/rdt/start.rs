//! From triangles that are nearly a triangulation to one.

use super::fill::Outline;
use super::{Judge, RdtCounters};
use crate::diagram::Nerve;
use crate::geometry::Vector;
use std::collections::{BTreeMap, BTreeSet};

/// Loops of at most this many sides are filled.
const SMALL: usize = 16;
/// A hole that no triangles fill is made larger so many times, by those around it.
const GROWING: usize = 3;

/// The triangles to start from, oriented, and the pairs of seeds whose cells touch at the border of the domain.
#[derive(Clone, Debug, Default)]
pub struct Start {
    /// Triangles by their seeds' numbers, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// Pairs, the smaller number first: edges between them may have a triangle on one side only.
    pub at_border: BTreeSet<[u32; 2]>,
}

impl Start {
    /// The triangles of a nerve, best [`sharp`](crate::diagram::Diagram::sharp_nerve).
    pub fn from_nerve(nerve: &Nerve) -> Self {
        Self {
            triangles: nerve.triangles.iter().map(|t| t.colours).collect(),
            at_border: nerve.edges.iter().filter(|e| e.border.is_some()).map(|e| e.colours).collect(),
        }
    }

    /// Triangles in which no oriented side occurs twice, with small holes filled.
    pub(super) fn triangulated(&self, judge: &dyn Judge, counters: &mut RdtCounters) -> Vec<[u32; 3]> {
        let mut sides = Sides { judge, next: BTreeMap::new() };
        let mut candidates: Vec<[u32; 3]> = self.triangles.iter().copied().filter(|&t| sides.are_seeds(t)).collect();
        // Those with the smallest circles first: of two that claim a side the Delaunay one, mostly.
        candidates.sort_by(|&a, &b| sides.size(a).total_cmp(&sides.size(b)).then(a.cmp(&b)));
        for triangle in candidates {
            sides.add(triangle);
        }
        counters.dropped = (self.triangles.len() - sides.next.len() / 3) as u64;
        for _ in 0..GROWING {
            let defects = self.fill_holes(&mut sides, counters);
            if defects.is_empty() {
                break;
            }
            counters.dropped += sides.remove_along(&defects);
        }
        self.fill_holes(&mut sides, counters);
        sides.triangles()
    }

    /// Fills what can be filled; returns the holes that cannot.
    fn fill_holes(&self, sides: &mut Sides, counters: &mut RdtCounters) -> Vec<Vec<u32>> {
        let mut defects = Vec::new();
        for outline in sides.outlines() {
            let parts = if self.is_hole(&outline, sides) { vec![outline.clone()] } else { self.open_parts(&outline) };
            for part in parts {
                let filling = Outline { corners: part.clone(), sides }.triangulated();
                if filling.len() + 2 == part.len() {
                    counters.filled += filling.into_iter().filter(|&triangle| sides.add(triangle)).count() as u64;
                } else if part.len() == outline.len() {
                    defects.push(part);
                }
            }
        }
        defects
    }

    /// Whether a loop is a hole in the triangles and not the domain's: small, turning the right way, most of its sides away
    /// from the border.
    fn is_hole(&self, outline: &[u32], sides: &Sides) -> bool {
        let at_border = (0..outline.len()).filter(|&i| self.touches_border(outline, i)).count();
        outline.len() <= SMALL && 2 * at_border < outline.len() && sides.judge.encloses(outline)
    }

    /// Whether side i of a loop joins cells that touch at the border.
    fn touches_border(&self, outline: &[u32], i: usize) -> bool {
        let (a, b) = (outline[i % outline.len()], outline[(i + 1) % outline.len()]);
        self.at_border.contains(&[a.min(b), a.max(b)])
    }

    /// The runs of sides, two or more, of a loop along the border that do not touch the border: triangles are missing
    /// there. Each is a polygon, closed by the side that is to be.
    fn open_parts(&self, outline: &[u32]) -> Vec<Vec<u32>> {
        let n = outline.len();
        let is_open = |i: usize| !self.touches_border(outline, i);
        let Some(first) = (0..n).find(|&i| !is_open(i)) else { return Vec::new() };
        let mut parts = Vec::new();
        let mut part: Vec<u32> = Vec::new();
        for i in first + 1..=first + n {
            if is_open(i) {
                part.push(outline[i % n]);
            } else if !part.is_empty() {
                part.push(outline[i % n]);
                let done = std::mem::take(&mut part);
                if (3..=SMALL).contains(&done.len()) {
                    parts.push(done);
                }
            }
        }
        parts
    }
}

/// The sides of triangles accepted so far: which triangle has the side a -> b.
pub(super) struct Sides<'a> {
    judge: &'a dyn Judge,
    next: BTreeMap<(u32, u32), u32>,
}

impl Sides<'_> {
    fn are_seeds(&self, [a, b, c]: [u32; 3]) -> bool {
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
    fn triangles(&self) -> Vec<[u32; 3]> {
        let all = self.next.iter().map(|(&(a, b), &c)| [a, b, c]);
        all.filter(|&[a, b, c]| a < b && a < c).collect()
    }

    /// Removes the triangles beside loops; returns how many.
    fn remove_along(&mut self, loops: &[Vec<u32>]) -> u64 {
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

    /// See [`Judge::size`].
    pub(super) fn size(&self, triangle: [u32; 3]) -> f64 {
        self.judge.size(triangle)
    }

    /// The loops of sides with a triangle on one side only: the missing triangles lie to their left. Each is simple.
    fn outlines(&self) -> Vec<Vec<u32>> {
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
    let angle = v.cross(u).atan2(v.dot(u));
    if angle > 0.0 { angle } else { angle + std::f64::consts::TAU }
}
