//! Surfaces of triangles in space, closed or with borders, of any genus: validated once and for all.
//!
//! | module | what it is |
//! |---|---|
//! | `build` | from an indexed list of triangles to a [`Surface`], or what is wrong and where |
//! | `repair` | damage of meshes mended, or named |
//! | `measure` | area, normals, Euler characteristic, components, borders |
//! | `nearest` | the closest point of a surface |
//! | `features` | creases, borders, interfaces, edges of the list; the curves that they make, from corner to corner |
//! | `cut` | a surface cut open along its features into patches |
//! | `implicit`, `march` | surfaces f(x, y, z) = 0: derivatives, projection, a first mesh by marching tetrahedra |
//! | `sheets` | lines in which sheets of f = 0 meet |
//! | `level`, `remesh` | a triangulation on f = 0; better triangles for it, as fine as its curvature asks for |
//! | `shapes` | spheres, tori, chairs, and how users write them |
//! | [`metric`] | metric fields on surfaces, curvature among them |

mod build;
mod cut;
mod features;
mod implicit;
mod level;
mod march;
mod measure;
pub mod metric;
mod nearest;
mod patch;
mod remesh;
mod repair;
mod shapes;
mod sheets;
mod tetrahedra;

pub(crate) use cut::{Seams, Whole, cut};
pub(crate) use features::CUT;
pub use features::FeatureOptions;
pub(crate) use features::{Curve, CurveEdge, FeatureGraph, Mark};
pub use implicit::Implicit;
pub(crate) use implicit::{Curvatures, closest_zero, curvatures, project, project_along, project_pinned};
pub(crate) use march::mesh_implicit;
pub use measure::Component;
pub(crate) use nearest::{Closest, Nearest, closest_weights};
pub(crate) use patch::Patch;
pub use repair::{Mended, RepairOptions, repaired};
#[cfg(test)]
pub(crate) use shapes::chair;
#[cfg(test)]
pub(crate) use shapes::sphere;
pub use shapes::{shape, torus};

use super::Place;
use crate::error::{Error, Result};
use crate::geometry::{Point3, Vector3};
use crate::triangulation::{Constraint, FaceId, Triangulation, VertexId};

/// A surface of triangles: every edge has one triangle or two, the triangles around a vertex form one fan, neighbours
/// turn the same way, and no triangle is without area.
///
/// Vertices have the numbers of the input; those of no triangle belong to nothing. Regions are the labels of triangles,
/// constraint i of the topology is edge i of the input's list. Lengths of edges are not known to the topology.
#[derive(Clone, Debug)]
pub struct Surface {
    topology: Triangulation,
    positions: Vec<Point3>,
    /// Unit normals, one per face slot.
    normals: Box<[Vector3]>,
    point_labels: Vec<i32>,
    marks: Box<[Mark]>,
    corners: Box<[VertexId]>,
    required_points: Box<[VertexId]>,
    required_triangles: Vec<FaceId>,
    turned: usize,
}

impl Surface {
    /// The triangles and how they hang together.
    pub fn topology(&self) -> &Triangulation {
        &self.topology
    }

    /// Positions, one per vertex slot.
    pub fn positions(&self) -> &[Point3] {
        &self.positions
    }

    /// Where a vertex is.
    pub(crate) fn position(&self, v: VertexId) -> Point3 {
        self.positions[v.index()]
    }

    /// One label per vertex slot; 0 for none.
    pub(crate) fn point_labels(&self) -> &[i32] {
        &self.point_labels
    }

    /// What the input says of a fixed edge.
    pub(crate) fn mark(&self, constraint: Constraint) -> Mark {
        self.marks[constraint.0 as usize]
    }

    /// Vertices that the input marks as corners, in order.
    #[cfg(test)]
    pub(crate) fn corners(&self) -> &[VertexId] {
        &self.corners
    }

    /// Vertices that the input marks as required, in order.
    pub(crate) fn required_points(&self) -> &[VertexId] {
        &self.required_points
    }

    /// Triangles that the input marks as required, in order.
    pub(crate) fn required_triangles(&self) -> &[FaceId] {
        &self.required_triangles
    }

    /// How many triangles of the input were turned so that all neighbours agree.
    pub fn turned(&self) -> usize {
        self.turned
    }

    /// The corners of a triangle.
    pub fn triangle(&self, f: FaceId) -> [Point3; 3] {
        self.topology.corners(f).map(|v| self.position(v))
    }

    /// The place with these barycentric coordinates in a triangle.
    pub(crate) fn place(&self, face: FaceId, weights: [f64; 3]) -> Place {
        Place { position: Point3::weighted(self.triangle(face), weights), face, weights, normal: self.normal(face) }
    }

    /// The place of a triangle that is closest to a point.
    pub(crate) fn closest_on(&self, face: FaceId, p: Point3) -> Place {
        self.place(face, nearest::closest_weights(self.triangle(face), p))
    }

    /// A vertex as a place: a corner of one of its triangles. `None` of a vertex without triangles.
    pub(crate) fn place_of(&self, v: VertexId) -> Option<Place> {
        let h = self.topology.start(v)?;
        let mut weights = [0.0; 3];
        weights[h.index() % 3] = 1.0;
        Some(Place { position: self.position(v), ..self.place(h.face(), weights) })
    }
}

/// Whether a metric has a value for each vertex.
pub(crate) fn check_count(found: usize, needed: usize) -> Result<()> {
    if found == needed {
        return Ok(());
    }
    let help = "the metric must have one value for each vertex of the surface's file, in the same order";
    Err(Error::metric(format!("{found} values for {needed} vertices"), "the surface", help))
}
