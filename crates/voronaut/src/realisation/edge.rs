//! An edge of a dual as a geodesic.

use crate::geometry::Point;

/// How an edge was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Found {
    /// As a polynomial, from the metric alone; it stays in the domain.
    Smooth,
    /// On the canvas, straightened.
    Traced,
    /// One of either kind, moved aside (by 2e-5 of its way) from the way of another edge that it crossed, as far as they run
    /// together.
    Parted,
}

/// An edge as a geodesic.
#[derive(Clone, Debug, PartialEq)]
pub struct GeodesicEdge {
    /// Its seeds, smaller first.
    pub ends: [u32; 2],
    /// The geodesic from the first to the second, as a polyline.
    pub points: Vec<Point>,
    /// Metric length of the geodesic.
    pub length: f64,
    /// Estimated relative error of the length (not a bound); how much shorter another way may be is not in it.
    pub error: f64,
    /// How it was found.
    pub found: Found,
}

impl AsRef<[Point]> for GeodesicEdge {
    fn as_ref(&self) -> &[Point] {
        &self.points
    }
}
