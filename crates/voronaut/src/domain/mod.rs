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
pub use repair::{repaired_graph, repaired_polygons};
#[cfg(test)]
pub(crate) use shapes::rect;
pub use shapes::shape;
pub(crate) use shapes::{name_and_rest, read_numbers};
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

impl Domain {
    /// The graph: corners and segments, without the vertices in the middle of straight runs.
    pub fn pslg(&self) -> &Pslg {
        &self.pslg
    }

    /// The triangulated corners.
    pub fn planar(&self) -> &Planar {
        &self.planar
    }

    /// For each vertex slot of [`Domain::planar`] the point of the graph that it stands for.
    pub(crate) fn sources(&self) -> &[Option<u32>] {
        &self.sources
    }

    /// The segments between the domain and its outside, without interfaces and inner features.
    pub fn boundary(&self) -> Vec<(Point, Point)> {
        let t = &self.planar.topology;
        t.borders().map(|h| self.planar.ends(h).into()).collect()
    }

    /// Triangles that cover the domain exactly.
    pub(crate) fn triangles(&self) -> Vec<[Point; 3]> {
        self.planar.topology.faces().map(|f| self.planar.triangle(f)).collect()
    }

    /// Euclidean area.
    pub fn area(&self) -> f64 {
        self.planar.area()
    }

    /// The smallest axis-aligned box around the domain.
    pub fn bounds(&self) -> Aabb {
        let used = self.planar.topology.vertices().map(|v| self.planar.position(v));
        Aabb::of(used).expect("a domain has at least one triangle")
    }
}
