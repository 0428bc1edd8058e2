//! Where the shortest ways between neighbouring seeds pass from cell to cell, and how long they are.

use super::{Diagram, Ground};
use crate::triangulation::VertexId;
use std::collections::HashMap;

/// For pairs of seeds whose cells, with their surroundings, have canvas vertices in common: the vertex with the least sum of
/// distances to both.
pub(crate) struct Passes {
    best: HashMap<[u32; 2], (f64, VertexId)>,
}

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// The passes between all seeds whose cells touch, or nearly do.
    pub(crate) fn passes(&self) -> Passes {
        let overlap = self.overlap();
        let mut best: HashMap<[u32; 2], (f64, VertexId)> = HashMap::new();
        for v in (0..self.vertex_count() as u32).map(VertexId) {
            let list = overlap.at(v);
            for (k, &(a, to_a)) in list.iter().enumerate() {
                for &(b, to_b) in &list[k + 1..] {
                    let found = best.entry([a, b]).or_insert((f64::INFINITY, v));
                    if to_a + to_b < found.0 {
                        *found = (to_a + to_b, v);
                    }
                }
            }
        }
        Passes { best }
    }
}

impl Passes {
    /// The length of the way between two seeds through their pass: never less than their distance on the canvas, and more
    /// by a share of about the square of a canvas edge's over the distance's length. `None` where their cells are not
    /// near.
    pub(crate) fn distance(&self, i: u32, j: u32) -> Option<f64> {
        self.best.get(&[i.min(j), i.max(j)]).map(|found| found.0)
    }

    /// The pass between two seeds.
    pub(crate) fn vertex(&self, i: u32, j: u32) -> Option<VertexId> {
        self.best.get(&[i.min(j), i.max(j)]).map(|found| found.1)
    }
}
