//! Edges in a network, and the chains that they make.

/// Edges between vertices, by their numbers, and those at each vertex.
pub(crate) struct Network {
    ends: Vec<[u32; 2]>,
    at: Vec<Vec<u32>>,
}

impl Network {
    /// Of so many vertices.
    pub(crate) fn new(vertices: usize, edges: impl Iterator<Item = [u32; 2]>) -> Self {
        let (ends, mut at): (Vec<[u32; 2]>, _) = (edges.collect(), vec![Vec::new(); vertices]);
        for (i, v) in (0..).zip(&ends).flat_map(|(i, ends)| ends.map(|v| (i, v))) {
            at[v as usize].push(i);
        }
        Self { ends, at }
    }

    /// All vertices that have edges.
    pub(crate) fn vertices(&self) -> impl Iterator<Item = u32> {
        (0..).zip(&self.at).filter(|(_, at)| !at.is_empty()).map(|(v, _)| v)
    }

    /// The edges at a vertex.
    pub(crate) fn at(&self, v: u32) -> &[u32] {
        &self.at[v as usize]
    }

    /// The end of an edge that is not this one.
    pub(crate) fn across(&self, v: u32, edge: u32) -> u32 {
        let [a, b] = self.ends[edge as usize];
        if a == v { b } else { a }
    }

    /// Takes an edge from the vertices that it is at.
    pub(crate) fn remove(&mut self, edge: u32) {
        for v in self.ends[edge as usize] {
            self.at[v as usize].retain(|&other| other != edge);
        }
    }

    /// Chains of edges, each with the vertex where it begins: first those from one stop to another, then the closed ones between.
    pub(crate) fn chains(&self, is_stop: impl Fn(u32) -> bool) -> Vec<(u32, Vec<u32>)> {
        let mut used = vec![false; self.ends.len()];
        let mut chains = Vec::new();
        for start in self.vertices().filter(|&v| is_stop(v)).chain(self.vertices()) {
            for &first in self.at(start) {
                let (mut v, mut next, mut chain) = (start, Some(first).filter(|&i| !used[i as usize]), Vec::new());
                while let Some(i) = next {
                    used[i as usize] = true;
                    chain.push(i);
                    v = self.across(v, i);
                    next = self.at(v).iter().copied().find(|&j| !used[j as usize] && !is_stop(v));
                }
                chains.extend((!chain.is_empty()).then_some((start, chain)));
            }
        }
        chains
    }
}
