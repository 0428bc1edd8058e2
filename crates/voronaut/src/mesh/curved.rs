//! Triangles of order 2 and 3.

use super::{EdgeSide, Edges};
use crate::error::{Error, Result};

/// Nodes of triangles of order 2 or 3, beyond their corners: each triangle is the image of the reference triangle under the
/// polynomial through its nodes (Lagrange, equidistant).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curved {
    /// The degree of the polynomials: 2 or 3.
    pub order: usize,
    /// Positions of the nodes that are not vertices. Neighbours share those of their edge; boundary edges have those of their triangle.
    pub nodes: Vec<[f64; 3]>,
    /// Numbers into `nodes`, from 0, `nodes_per_triangle` for each of the mesh's triangles: those of the edge from corner 0 to corner 1,
    /// in that direction, of that from 1 to 2, of that from 2 to 0, and for order 3 the one in the interior.
    pub triangles: Vec<u32>,
}

impl Curved {
    /// Nodes of an edge between its ends.
    pub(crate) fn nodes_per_edge(&self) -> usize {
        self.order - 1
    }

    /// Nodes of a triangle that are not its corners.
    pub(crate) fn nodes_per_triangle(&self) -> usize {
        (self.order + 1) * (self.order + 2) / 2 - 3
    }

    /// The numbers of a triangle's nodes beyond its corners.
    pub(crate) fn triangle(&self, triangle: usize) -> &[u32] {
        let count = self.nodes_per_triangle();
        &self.triangles[triangle * count..][..count]
    }

    /// The numbers of the nodes of a triangle's side from one corner to the next, in that direction.
    pub(crate) fn side(&self, triangle: usize, side: usize) -> &[u32] {
        let count = self.nodes_per_edge();
        &self.triangle(triangle)[side * count..][..count]
    }

    /// Whether triangles have nodes that exist, and neighbours those of their edge in common.
    pub(super) fn check_numbers(&self, corners: &[[u32; 3]]) -> Result<()> {
        if !(2..=3).contains(&self.order) {
            let what = format!("triangles of order {}", self.order);
            return Err(Error::mesh(what, "a curved mesh", "use order 2 or 3"));
        }
        let (triangles, count) = (corners.len(), self.nodes_per_triangle());
        if self.triangles.len() != triangles * count {
            let what = format!("{} numbers of nodes for {triangles} triangles", self.triangles.len());
            return Err(Error::mesh(what, "a curved mesh", format!("give {count} for each triangle")));
        }
        if let Some(number) = self.triangles.iter().find(|&&node| node as usize >= self.nodes.len()) {
            let place = format!("a list of {} nodes", self.nodes.len());
            return Err(Error::mesh(format!("node {number} (from 0) does not exist"), place, "correct the number"));
        }
        let edges = Edges::of(corners);
        let Some(torn) =
            edges.iter().find(|sides| sides[1..].iter().any(|s| self.nodes_of(s) != self.nodes_of(&sides[0])))
        else {
            return Ok(());
        };
        let [a, b] = torn[0].ends.map(|v| v + 1);
        let what = format!("the triangles beside the edge {a}-{b} have different nodes there");
        Err(Error::mesh(what, "a curved mesh", "let neighbours share the nodes of their edge"))
    }

    /// The numbers of the nodes of a side, from the smaller vertex to the larger.
    fn nodes_of(&self, side: &EdgeSide) -> Vec<u32> {
        let mut nodes = self.side(side.triangle(), side.half_edge as usize % 3).to_vec();
        if !side.forward {
            nodes.reverse();
        }
        nodes
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;

    /// Two triangles of order 3 with the edge 1-2 in common.
    fn pair() -> Mesh {
        let triangles = vec![0, 1, 2, 3, 4, 5, 6, 3, 2, 7, 8, 9, 10, 11];
        let curved = Curved { order: 3, nodes: vec![[0.0; 3]; 12], triangles };
        Mesh {
            points: vec![[0.0; 3]; 4],
            triangles: vec![[0, 1, 2], [2, 1, 3]],
            curved: Some(curved),
            ..Mesh::default()
        }
    }

    fn message(change: impl FnOnce(&mut Curved)) -> String {
        let mut mesh = pair();
        change(mesh.curved.as_mut().unwrap());
        mesh.check_numbers().unwrap_err().to_string()
    }

    #[test]
    fn nodes_exist_and_are_shared() {
        assert!(pair().check_numbers().is_ok());
        assert!(message(|c| c.order = 4).contains("triangles of order 4"));
        assert!(message(|c| c.order = 2).contains("14 numbers of nodes for 2 triangles"));
        assert!(message(|c| c.triangles[13] = 12).contains("node 12 (from 0) does not exist at a list of 12 nodes"));
        assert!(message(|c| c.triangles.swap(7, 8)).contains("beside the edge 2-3 have different nodes"));
    }
}
