//! An order of elimination that fills the factor little.

use super::Symmetric;
use std::ops::Range;

/// Levels of vertices that are not of the part to be cut, and of those of it that no search has come to.
const OUTSIDE: u32 = u32::MAX;
const UNSEEN: u32 = u32::MAX - 1;
/// How often a search begins anew where the last one ended: then it begins at one end of the part, or nearly so.
const FAR_SEARCHES: usize = 2;
/// A cut leaves at least this share of a part on either side, where a level does.
const LEAST_SIDE: f64 = 0.3;

/// An order of the rows by nested dissection through level sets (George and Liu 1981, chapter 8): the graph of the matrix is cut
/// by a few vertices, which come last, behind those of either side, and sides are cut in the same way, down to single vertices.
///
/// A cut is a level of a breadth-first search from a vertex at one end of the graph. On triangulations of 60,000 to 250,000
/// vertices factors have 2 to 2.5 n log2 n entries; in George and Liu's analysis of square grids it is 31/8 n log2 n in the limit.
pub(crate) fn nested_dissection(matrix: &Symmetric) -> Vec<u32> {
    let n = matrix.size();
    let order = (0..n as u32).collect();
    let mut dissection = Dissection { matrix, order, level: vec![OUTSIDE; n], found: Vec::new(), starts: Vec::new() };
    // Not by recursion: parts may be nested as deeply as there are vertices.
    let mut parts: Vec<_> = std::iter::once(0..n).collect();
    while let Some(part) = parts.pop() {
        // Two vertices are as good in either order.
        if part.len() > 2 {
            dissection.cut(part, &mut parts);
        }
    }
    dissection.order
}

struct Dissection<'a> {
    matrix: &'a Symmetric,
    /// Vertices; parts are ranges of it.
    order: Vec<u32>,
    /// The level of each vertex in the last search.
    level: Vec<u32>,
    /// What the last search found: level m from `starts[m]` to `starts[m + 1]`.
    found: Vec<u32>,
    starts: Vec<usize>,
}

impl Dissection<'_> {
    /// Orders a part as far as a cut does, and adds what it leaves to the parts.
    fn cut(&mut self, part: Range<usize>, parts: &mut Vec<Range<usize>>) {
        self.mark(part.clone(), UNSEEN);
        self.search(self.order[part.start]);
        if self.found.len() < part.len() {
            self.separate(part.clone(), parts);
        } else {
            self.bisect(part.clone(), parts);
        }
        self.mark(part, OUTSIDE);
    }

    fn mark(&mut self, part: Range<usize>, level: u32) {
        for &v in &self.order[part] {
            self.level[v as usize] = level;
        }
    }

    /// Finds all that is connected with a vertex, breadth first, among vertices not seen yet.
    fn search(&mut self, first: u32) {
        self.found.clear();
        self.starts.clear();
        self.found.push(first);
        self.level[first as usize] = 0;
        let mut start = 0;
        while start < self.found.len() {
            self.starts.push(start);
            let (end, next) = (self.found.len(), self.starts.len() as u32);
            for at in start..end {
                for &u in self.matrix.neighbours(self.found[at] as usize) {
                    if self.level[u as usize] == UNSEEN {
                        self.level[u as usize] = next;
                        self.found.push(u);
                    }
                }
            }
            start = end;
        }
        self.starts.push(start);
    }

    /// Connected components one after the other.
    fn separate(&mut self, part: Range<usize>, parts: &mut Vec<Range<usize>>) {
        self.mark(part.clone(), UNSEEN);
        let (before, mut start) = (self.order[part.clone()].to_vec(), part.start);
        for v in before {
            if self.level[v as usize] == UNSEEN {
                self.search(v);
                let end = start + self.found.len();
                self.order[start..end].copy_from_slice(&self.found);
                parts.push(start..end);
                start = end;
            }
        }
    }

    /// One side, the other side, and the vertices between, of a connected part.
    fn bisect(&mut self, part: Range<usize>, parts: &mut Vec<Range<usize>>) {
        for _ in 0..FAR_SEARCHES {
            let last = self.found[self.found.len() - 1];
            self.mark(part.clone(), UNSEEN);
            self.search(last);
        }
        let Some(level) = self.best_level() else { return };
        let (start, end) = (self.starts[level], self.starts[level + 1]);
        let is_next = |u: &u32| self.level[*u as usize] == level as u32 + 1;
        let cuts = |v: &u32| self.matrix.neighbours(*v as usize).iter().any(is_next);
        let (between, side): (Vec<u32>, Vec<u32>) = self.found[start..end].iter().partition(|v| cuts(v));
        let ordered = [&self.found[..start], &side, &self.found[end..], &between].concat();
        self.order[part.clone()].copy_from_slice(&ordered);
        let (middle, last) = (part.start + start + side.len(), part.end - between.len());
        parts.extend([part.start..middle, middle..last]);
    }

    /// The smallest level with enough on either side, or else that which cuts most evenly; `None` where there is none between the
    /// first and the last: all vertices are neighbours of one, and mostly of each other.
    fn best_level(&self) -> Option<usize> {
        let count = self.found.len();
        let sides = |m: usize| [self.starts[m], count - self.starts[m + 1]];
        let is_fair = |m: &usize| sides(*m).iter().all(|&side| side as f64 >= LEAST_SIDE * count as f64);
        let inner = 1..self.starts.len().saturating_sub(2);
        let smallest = inner.clone().filter(is_fair).min_by_key(|&m| self.starts[m + 1] - self.starts[m]);
        smallest.or_else(|| inner.min_by_key(|&m| sides(m)[0].abs_diff(sides(m)[1])))
    }
}
