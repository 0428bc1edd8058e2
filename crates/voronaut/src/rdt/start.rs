//! From triangles that are nearly a triangulation to one.

use super::sides::Sides;
use super::{Judge, RdtCounters};
use crate::diagram::Nerve;
use std::collections::BTreeSet;

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
    pub(crate) fn from_nerve(nerve: &Nerve) -> Self {
        Self {
            triangles: nerve.triangles.iter().map(|t| t.colours).collect(),
            at_border: nerve.edges.iter().filter(|e| e.border.is_some()).map(|e| e.colours).collect(),
        }
    }

    /// Triangles in which no oriented side occurs twice, with small holes filled; and how many were dropped and filled in.
    pub(super) fn triangulated(&self, judge: &dyn Judge) -> (Vec<[u32; 3]>, RdtCounters) {
        let mut sides = Sides::new(judge);
        let mut candidates: Vec<[u32; 3]> = self.triangles.iter().copied().filter(|&t| sides.are_seeds(t)).collect();
        // Those with the smallest circles first: of two that claim a side the Delaunay one, mostly.
        candidates.sort_by(|&a, &b| judge.size(a).total_cmp(&judge.size(b)).then(a.cmp(&b)));
        for triangle in candidates {
            sides.add(triangle);
        }
        let (mut dropped, mut filled) = ((self.triangles.len() - sides.count()) as u64, 0);
        for _ in 0..GROWING {
            let defects = self.fill_holes(&mut sides, &mut filled);
            if defects.is_empty() {
                break;
            }
            dropped += sides.remove_along(&defects);
        }
        self.fill_holes(&mut sides, &mut filled);
        (sides.triangles(), RdtCounters { dropped, filled, ..RdtCounters::default() })
    }

    /// Fills what can be filled; returns the holes that cannot.
    fn fill_holes(&self, sides: &mut Sides, filled: &mut u64) -> Vec<Vec<u32>> {
        let mut defects = Vec::new();
        for outline in sides.outlines() {
            let parts = if self.is_hole(&outline, sides) { vec![outline.clone()] } else { self.open_parts(&outline) };
            for part in parts {
                let filling = filling(part.clone(), sides);
                if filling.len() + 2 == part.len() {
                    *filled += filling.into_iter().filter(|&triangle| sides.add(triangle)).count() as u64;
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

/// Triangles that fill a polygon, counter-clockwise, ear by ear, the one with the smallest circle first: roughly right will do,
/// for flips follow. Where no ear turns the right way the rest stays open.
fn filling(mut corners: Vec<u32>, sides: &Sides) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    while corners.len() > 2 {
        let n = corners.len();
        let ear = |i: usize| [0, 1, 2].map(|k| corners[(i + k) % n]);
        // The last ear closes on a side that is there or, of an open part, on none.
        let is_free = |[a, _, c]: [u32; 3]| n == 3 || !(sides.has(a, c) || sides.has(c, a));
        let sizes = (0..n).filter(|&i| is_free(ear(i))).map(|i| (i, sides.judge.size(ear(i))));
        let best = sizes.filter(|(_, size)| size.is_finite()).min_by(|a, b| a.1.total_cmp(&b.1));
        let Some((i, _)) = best else { break };
        triangles.push(ear(i));
        corners.remove((i + 1) % n);
    }
    triangles
}
