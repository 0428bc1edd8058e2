//! From the nerve to a mesh: its straight realisation (RR-9103, sections 11 and 14: SRDT), and the canvas as a mesh.

use super::{Diagram, Ground, Nerve, NerveTriangle};
use crate::manifold::domain::Segment;
use crate::mesh::Mesh;
use crate::triangulation::{VertexId, smallest_first};
use std::collections::{BTreeMap, BTreeSet};

impl Diagram<'_> {
    /// Triangles of seeds (those of the nerve, or what became of them) with straight edges: vertex i is seed i, and a
    /// triangle that comes out clockwise is one that straight edges invert. Edges whose border witness lies on one of the domain's
    /// segments carry its label, as far as a triangle has them. A triangle has the region label of its witness, or, where
    /// the nerve does not have it, of a neighbour. A removed seed is no vertex of any triangle, at (0, 0).
    pub fn to_mesh(&self, triangles: Vec<[u32; 3]>, nerve: &Nerve, segments: &[Segment]) -> Mesh {
        let mut mesh = Mesh { triangle_labels: self.regions(&triangles, nerve), triangles, ..Mesh::default() };
        for colour in 0..self.colours() as u32 {
            let p = self.seed(colour).unwrap_or_default();
            mesh.points.push([p.x, p.y, 0.0]);
        }
        mesh.point_labels = vec![0; mesh.points.len()];
        let sides: BTreeSet<[u32; 2]> = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
        for edge in &nerve.edges {
            let [a, b] = edge.colours;
            let side = [[a, b], [b, a]].into_iter().find(|side| sides.contains(side));
            if let (Some(side), Some(h)) = (side, edge.border) {
                let segment = self.ground.canvas.topology().constraint(h);
                let label = segment.and_then(|c| segments.get(c.0 as usize)).map_or(0, |s| s.label);
                mesh.edges.push(side);
                mesh.edge_labels.push(label);
            }
        }
        mesh
    }

    fn regions(&self, triangles: &[[u32; 3]], nerve: &Nerve) -> Vec<i32> {
        let of = |t: &NerveTriangle| self.ground.canvas.topology().region(t.witness);
        let sides = |[a, b, c]: [u32; 3]| [[a, b], [b, c], [c, a]].map(|[u, v]| [u.min(v), u.max(v)]);
        let mut beside: BTreeMap<[u32; 2], i32> = BTreeMap::new();
        for t in &nerve.triangles {
            beside.extend(sides(t.colours).map(|side| (side, of(t))));
        }
        let region = |triangle: &[u32; 3]| {
            let colours = smallest_first(*triangle);
            let own = nerve.triangles.binary_search_by_key(&colours, |t| t.colours).map(|i| of(&nerve.triangles[i]));
            own.ok().or_else(|| sides(colours).iter().find_map(|side| beside.get(side).copied())).unwrap_or(0)
        };
        triangles.iter().map(region).collect()
    }
}

/// The embedded canvas as a mesh with the region labels of the domain or surface, its vertices without labels.
pub(super) fn to_mesh<'a, G: Ground<'a>>(ground: G) -> Mesh {
    let embedded = ground.embedded();
    Mesh {
        points: (0..embedded.vertex_slots() as u32).map(|v| ground.coordinates(VertexId(v))).collect(),
        triangles: embedded.faces().map(|f| embedded.corners(f).map(|v| v.0)).collect(),
        triangle_labels: embedded.faces().map(|f| ground.region(f)).collect(),
        ..Mesh::default()
    }
}

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// The canvas as a mesh with the region labels of the domain or surface, its vertices labelled by colour (-1 where no seed
    /// reaches), and their distances.
    pub fn to_coloured_canvas(&self) -> (Mesh, Vec<f64>) {
        let point_labels = self.propagation.labels().iter().map(|l| l.colour.cast_signed()).collect();
        let mesh = Mesh { point_labels, ..to_mesh(self.ground) };
        (mesh, self.propagation.labels().iter().map(|l| l.distance).collect())
    }
}
