//! Which canvas.

use crate::error::named;

/// The discretisation that distances travel on; its names are those users type (`--canvas`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// `intrinsic`: refined evenly in the metric, geodesic edge lengths, flipped by lengths alone.
    #[default]
    Intrinsic,
    /// `isotropic`: a Euclidean Delaunay triangulation as fine everywhere as the metric is in its finest direction.
    Isotropic,
    /// `starset`: even in the metric, with the Delaunay stars of the vertices, each in its vertex's own metric, as the graph
    /// that methods without triangles travel on.
    StarSet,
}

named!(Kind, "canvas", [Intrinsic = "intrinsic", Isotropic = "isotropic", StarSet = "starset"]);
