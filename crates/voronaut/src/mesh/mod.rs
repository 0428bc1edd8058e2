//! The mesh that leaves the program: plain arrays, as every format and every solver wants them; and where in a planar one
//! a point is.

mod curved;
pub(crate) mod edges;
mod locate;
mod network;
mod periodic;
mod solution;

pub use curved::Curved;
pub(crate) use edges::edges_of;
pub use edges::{EdgeSide, Edges};
pub(crate) use locate::{Located, Locator};
pub(crate) use network::Network;
pub use periodic::Periodic;
pub use solution::{Solution, SolutionValues, Solutions, TensorOrder};

use crate::error::{Error, Result};
use crate::geometry::{Point, Point3};
use crate::lists::marked;
use crate::parallel::prelude::*;

/// A triangle mesh with the user's labels ("references" in Medit).
///
/// Positions have three coordinates; a planar mesh has z = 0 and its triangles are counter-clockwise.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Positions, one per vertex.
    pub points: Vec<[f64; 3]>,
    /// One label per vertex; 0 for none.
    pub point_labels: Vec<i32>,
    /// Vertex numbers, from 0.
    pub triangles: Vec<[u32; 3]>,
    /// One region label per triangle.
    pub triangle_labels: Vec<i32>,
    /// Labelled edges: the boundary and the interfaces between regions, in the direction of the input.
    pub edges: Vec<[u32; 2]>,
    /// One label per entry of `edges`.
    pub edge_labels: Vec<i32>,
    /// Vertices where a feature curve ends, bends or forks.
    pub corners: Vec<u32>,
    /// Vertices that the user marked as required.
    pub required_points: Vec<u32>,
    /// Entries of `edges` that are creases of a surface ("ridges" in Medit).
    pub ridges: Vec<u32>,
    /// Entries of `edges` that the user marked as required.
    pub required_edges: Vec<u32>,
    /// Entries of `triangles` that the user marked as required.
    pub required_triangles: Vec<u32>,
    /// Curves of the boundary whose vertices correspond.
    pub periodic: Vec<Periodic>,
    /// The triangles' nodes beyond their vertices, where they are of order 2 or 3.
    pub curved: Option<Curved>,
}

impl Mesh {
    /// The planar position of a vertex.
    pub fn point(&self, vertex: u32) -> Point {
        let [x, y, _] = self.points[vertex as usize];
        Point::new(x, y)
    }

    /// The three planar positions of a triangle.
    pub fn corners_of(&self, triangle: [u32; 3]) -> [Point; 3] {
        triangle.map(|v| self.point(v))
    }

    /// Twice the area of a planar triangle of either orientation.
    pub fn double_area(&self, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = self.corners_of(triangle);
        (b - a).cross(c - a).abs()
    }

    /// Of each vertex whether a triangle has it.
    pub(crate) fn used_vertices(&self) -> Vec<bool> {
        marked(self.points.len(), self.triangles.as_flattened().iter().copied())
    }

    /// The position of a vertex in space.
    pub fn position(&self, vertex: u32) -> Point3 {
        self.points[vertex as usize].into()
    }

    /// The three positions of a triangle in space.
    pub fn positions_of(&self, triangle: [u32; 3]) -> [Point3; 3] {
        triangle.map(|v| self.position(v))
    }

    /// Whether every position, of vertices and of curved triangles' nodes, lies in the plane z = 0.
    pub fn is_planar(&self) -> bool {
        let nodes = self.curved.iter().flat_map(|curved| &curved.nodes);
        self.points.iter().chain(nodes).all(|p| p[2] == 0.0)
    }

    /// A vertex, numbered from 1, for messages about planar meshes.
    pub(crate) fn describe(&self, vertex: usize) -> String {
        format!("vertex {} {}", vertex + 1, self.point(vertex as u32))
    }

    /// Whether triangles, edges, corners and what is required refer to vertices and edges that exist, and curved triangles to nodes
    /// that neighbours share.
    ///
    /// # Errors
    /// [`Error::Mesh`] with the number at fault.
    pub fn check_numbers(&self) -> Result<()> {
        let vertices = self.points.len();
        let referred = self.triangles.as_flattened().iter().chain(self.edges.as_flattened());
        let partners = self.periodic.iter().flat_map(|pair| pair.vertices.as_flattened());
        let listed = self.corners.iter().chain(&self.required_points).chain(partners);
        let vertex = referred.chain(listed).find(|&&v| v as usize >= vertices);
        let vertex = (vertex.copied(), "vertex", vertices, "vertices");
        let beyond = |list: &[u32], most: usize| list.iter().copied().find(|&i| i as usize >= most);
        let [edges, triangles] = [self.edges.len(), self.triangles.len()];
        let edge = (beyond(&self.required_edges, edges).or(beyond(&self.ridges, edges)), "edge", edges, "edges");
        let triangle = (beyond(&self.required_triangles, triangles), "triangle", triangles, "triangles");
        for (found, one, count, many) in [vertex, edge, triangle] {
            if let Some(number) = found {
                let (what, place) =
                    (format!("{one} {number} (from 0) does not exist"), format!("a list of {count} {many}"));
                return Err(Error::mesh(what, place, "correct the number"));
            }
        }
        self.curved.as_ref().map_or(Ok(()), |curved| curved.check_numbers(&self.triangles))
    }

    /// Refuses curved triangles where they would be taken for straight ones.
    ///
    /// # Errors
    /// [`Error::Unsupported`] with their order.
    pub(crate) fn demand_straight(&self) -> Result<()> {
        let Some(curved) = &self.curved else { return Ok(()) };
        let what = format!("triangles of order {}, where straight ones are needed", curved.order);
        Err(Error::unsupported(what, "give straight triangles: convert the mesh with `order` 1"))
    }
}

/// Vertices that lie exactly where others with smaller numbers lie, each behind the first of these.
pub(crate) fn coincident(positions: impl IntoIterator<Item = (u32, Point3)>) -> Vec<[u32; 2]> {
    // Adding 0 makes one zero of both.
    let key = |p: Point3| p.to_array().map(|x| (x + 0.0).to_bits());
    let mut keyed: Vec<([u64; 3], u32)> = positions.into_iter().map(|(v, p)| (key(p), v)).collect();
    keyed.par_sort_unstable();
    let others = keyed.chunk_by(|a, b| a.0 == b.0).flat_map(|same| same[1..].iter().map(|other| [same[0].1, other.1]));
    others.collect()
}
