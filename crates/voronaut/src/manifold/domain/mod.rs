//! Planar domains: polygons with holes, components, regions and features, validated once and for all.

mod assemble;
mod build;
mod chains;
mod distinct;
mod from_mesh;
mod outlines;
mod periodic;
mod poly;
mod polygons;
mod pslg;
mod remesh_input;
mod repair;
mod shapes;
mod sides;
mod splines;

pub(crate) use chains::Chain;
pub use from_mesh::from_mesh;
pub use outlines::{to_mesh, to_poly, to_polygons};
pub(crate) use periodic::{Pair, curves_in_step, paired};
pub use poly::{Poly, PolyRegion, from_poly};
pub use polygons::{Polygon, Polygons, Ring, from_polygons};
pub use pslg::{Filling, Pslg, Segment, Side};
pub use remesh_input::{Keep, RemeshInput};
pub(crate) use remesh_input::{Position, position_of};
pub use repair::{repaired_graph, repaired_polygons};
pub(crate) use shapes::read_numbers;
#[cfg(test)]
pub(crate) use shapes::rect;
pub use shapes::shape;
pub(crate) use splines::Splines;

use crate::geometry::{Aabb, Point};
use crate::planar::Planar;

/// A valid planar domain: its boundary crosses nothing, encloses an area, and every triangle of that area knows its
/// region.
///
/// It holds the constrained Delaunay triangulation of its corners, which is where meshing starts. Constraint i of the
/// triangulation is segment i of the graph. Vertices where two parts of the domain touch in a point are split, one
/// per part.
#[derive(Clone, Debug)]
pub struct Domain {
    pslg: Pslg,
    planar: Planar,
    sources: Vec<Option<u32>>,
}

/// The triangulated corners of a domain, and what is known of them.
#[derive(Clone, Copy)]
pub(crate) struct Corners<'a> {
    /// Their triangulation.
    pub planar: &'a Planar,
    /// For each of its vertex slots the point of the graph that it stands for.
    pub sources: &'a [Option<u32>],
    /// The segments that its constraints are.
    pub segments: &'a [Segment],
}

impl Domain {
    /// The graph: corners and segments, without the vertices in the middle of straight runs.
    pub fn pslg(&self) -> &Pslg {
        &self.pslg
    }

    /// The triangulated corners.
    pub fn planar(&self) -> &Planar {
        &self.planar
    }

    /// What a mesh of it starts from.
    pub(crate) fn corners(&self) -> Corners<'_> {
        Corners { planar: &self.planar, sources: &self.sources, segments: &self.pslg.segments }
    }

    /// For each vertex slot of [`Domain::planar`] the point of the graph that it stands for.
    pub(crate) fn sources(&self) -> &[Option<u32>] {
        &self.sources
    }

    /// The segments between the domain and its outside, without interfaces and inner features.
    pub fn boundary(&self) -> Vec<(Point, Point)> {
        self.planar.boundary()
    }

    /// Euclidean area.
    pub fn area(&self) -> f64 {
        self.planar.area()
    }

    /// The smallest axis-aligned box around the domain.
    pub fn bounds(&self) -> Aabb {
        self.planar.bounds().expect("a domain has at least one triangle")
    }
}
