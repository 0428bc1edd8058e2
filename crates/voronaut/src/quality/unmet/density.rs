//! How dense the vertices of a mesh are around an edge, for its metric.

use super::RANGE;

/// The edges of a mesh and the logarithms of their metric lengths, by vertices.
pub(super) struct Density<'a> {
    ends: &'a [[u32; 2]],
    logarithms: Vec<f64>,
    /// Of each edge whether it tells of the density.
    tells: Vec<bool>,
    /// The edges at each vertex, one vertex after the other, and where each vertex's begin.
    at: Vec<u32>,
    first: Vec<u32>,
}

impl<'a> Density<'a> {
    /// Of edges with these lengths; those that do not tell are left out.
    pub(super) fn of(vertices: usize, ends: &'a [[u32; 2]], lengths: &[f64], tells: impl Fn(usize) -> bool) -> Self {
        let mut first = vec![0_u32; vertices + 1];
        for &v in ends.as_flattened() {
            first[v as usize + 1] += 1;
        }
        for v in 0..vertices {
            first[v + 1] += first[v];
        }
        let mut next = first.clone();
        let mut at = vec![0_u32; 2 * ends.len()];
        for (e, pair) in ends.iter().enumerate() {
            for &v in pair {
                at[next[v as usize] as usize] = e as u32;
                next[v as usize] += 1;
            }
        }
        let logarithms = lengths.iter().map(|length| length.ln()).collect();
        Self { ends, logarithms, tells: (0..ends.len()).map(tells).collect(), at, first }
    }

    /// Whether an edge's length is what it is because of the density around: of the edges at its ends and at their neighbours
    /// the logarithms of lengths spread (standard deviation) no more than those of unit edges may, their mean is the greater
    /// part of the edge's own, and what is left of that is in the range of unit edges.
    pub(super) fn explains(&self, edge: usize) -> bool {
        let patch = self.patch(edge);
        let count = patch.len() as f64;
        let mean = patch.iter().map(|&e| self.logarithms[e as usize]).sum::<f64>() / count;
        let variance = patch.iter().map(|&e| (self.logarithms[e as usize] - mean).powi(2)).sum::<f64>() / count;
        let own = self.logarithms[edge];
        variance <= RANGE * RANGE && (own - mean).abs() <= RANGE && mean / own >= 0.5
    }

    /// The edges at the ends of an edge and at their neighbours that tell, in order.
    fn patch(&self, edge: usize) -> Vec<u32> {
        let around = |v: u32| &self.at[self.first[v as usize] as usize..self.first[v as usize + 1] as usize];
        let mut vertices: Vec<u32> =
            self.ends[edge].iter().flat_map(|&v| around(v)).flat_map(|&e| self.ends[e as usize]).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut edges: Vec<u32> = vertices.into_iter().flat_map(|v| around(v).iter().copied()).collect();
        edges.sort_unstable();
        edges.dedup();
        edges.retain(|&e| self.tells[e as usize]);
        edges
    }
}
