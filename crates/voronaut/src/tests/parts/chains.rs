//! Features of a mesh as chains of its edges: where labels change, and the border.

use std::collections::{BTreeMap, BTreeSet};
use voronaut::geometry::Vector3;
use voronaut::mesh::Mesh;

/// Edges one after the other from corner to corner, or around.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chain {
    /// Along the chain; of a closed one the first is not repeated at the end.
    pub(crate) vertices: Vec<u32>,
    pub(crate) is_closed: bool,
    /// Labels on both sides, in ascending order; `None` beyond a border.
    pub(crate) sides: Sides,
}

/// Labels on the sides of an edge.
pub(crate) type Sides = [Option<i32>; 2];

/// All chains of a mesh, and its corners: vertices where chains end or fork, or that are listed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Features {
    pub(crate) chains: Vec<Chain>,
    pub(crate) corners: BTreeSet<u32>,
}

/// The triangles beside each edge, by its ends in ascending order.
pub(crate) fn beside(mesh: &Mesh) -> BTreeMap<[u32; 2], Vec<usize>> {
    let mut found: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
    for (i, t) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            found.entry(sorted([t[k], t[(k + 1) % 3]])).or_default().push(i);
        }
    }
    found
}

pub(crate) fn sorted([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Labels on both sides of an edge of these triangles.
pub(crate) fn sides(mesh: &Mesh, triangles: &[usize]) -> Sides {
    let mut sides = [0, 1].map(|i| triangles.get(i).map(|&t| mesh.triangle_labels[t]));
    sides.sort_unstable();
    sides
}

impl Features {
    /// Chains of the edges between labels and of the border, cut at listed corners too.
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let all = beside(mesh).into_iter().map(|(edge, triangles)| (edge, sides(mesh, &triangles)));
        let between: BTreeMap<_, _> = all.filter(|(_, sides)| sides[0] != sides[1]).collect();
        Self::of_edges(&between, &mesh.corners.iter().copied().collect())
    }

    /// Chains of edges, cut where more or fewer than two meet, and at vertices that are corners in any case.
    pub(crate) fn of_edges(edges: &BTreeMap<[u32; 2], Sides>, corners: &BTreeSet<u32>) -> Self {
        let mut around: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for &[a, b] in edges.keys() {
            around.entry(a).or_default().push(b);
            around.entry(b).or_default().push(a);
        }
        let forks = around.iter().filter(|(v, all)| all.len() != 2 || corners.contains(v)).map(|(&v, _)| v);
        let mut found = Self { chains: Vec::new(), corners: forks.collect() };
        let mut left: BTreeSet<[u32; 2]> = edges.keys().copied().collect();
        let from_corners = found.corners.iter().flat_map(|&v| around[&v].iter().map(move |&w| [v, w]));
        let starts: Vec<[u32; 2]> = from_corners.chain(edges.keys().copied()).collect();
        for start in starts {
            if left.contains(&sorted(start)) {
                found.chains.push(found.chain(start, &around, &mut left, edges));
            }
        }
        found
    }

    /// Follows a chain from its first edge.
    fn chain(
        &self,
        [first, second]: [u32; 2],
        around: &BTreeMap<u32, Vec<u32>>,
        left: &mut BTreeSet<[u32; 2]>,
        edges: &BTreeMap<[u32; 2], Sides>,
    ) -> Chain {
        let mut vertices = vec![first, second];
        left.remove(&sorted([first, second]));
        while let [.., before, last] = vertices[..]
            && last != first
            && !self.corners.contains(&last)
        {
            let Some(&next) = around[&last].iter().find(|&&next| next != before) else { break };
            left.remove(&sorted([last, next]));
            vertices.push(next);
        }
        let is_closed = vertices.last() == Some(&first) && !self.corners.contains(&first);
        if is_closed {
            vertices.pop();
        }
        Chain { vertices, is_closed, sides: edges[&sorted([first, second])] }
    }

    /// Writes all features into the lists of a mesh.
    pub(crate) fn list(&self, mesh: &mut Mesh) {
        let beside = beside(mesh);
        mesh.corners = self.corners.iter().copied().collect();
        (mesh.edges, mesh.edge_labels, mesh.ridges) = Default::default();
        for (label, chain) in (1..).zip(&self.chains) {
            for edge in chain.edges() {
                let normals: Vec<Vector3> = beside[&sorted(edge)].iter().map(|&t| normal(mesh, t)).collect();
                if normals.len() == 2 && normals[0].dot(normals[1]) < 0.5_f64.sqrt() {
                    mesh.ridges.push(mesh.edges.len() as u32);
                }
                mesh.edges.push(edge);
                mesh.edge_labels.push(label);
            }
        }
    }
}

impl Chain {
    /// Its edges in order.
    pub(crate) fn edges(&self) -> Vec<[u32; 2]> {
        let mut edges: Vec<_> = self.vertices.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        if let (true, [first, .., last]) = (self.is_closed, &self.vertices[..]) {
            edges.push([*last, *first]);
        }
        edges
    }
}

fn normal(mesh: &Mesh, triangle: usize) -> Vector3 {
    let [a, b, c] = mesh.positions_of(mesh.triangles[triangle]);
    (b - a).cross(c - a).unit().expect("a triangle with an area")
}
