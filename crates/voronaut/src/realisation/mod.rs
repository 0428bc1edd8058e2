//! The Riemannian Delaunay triangulation as it lies in the plane (Rouxel-Labbé et al. 2017, section 10) or on a surface (section
//! 12): geodesic edges as polylines, and the triangles between them.

mod crossed;
mod edges;
mod on_surface;
mod regions;
mod simplices;
mod untangle;

pub use simplices::Grid;

use crate::diagram::Diagram;
use crate::geometry::Point;
use crate::mesh::Edges;
use crate::metric::MetricField;
use crate::quality::crossings;

/// See the [module](self). A `Realisation` lies in the plane, a `Realisation<Point3>` on a surface.
#[derive(Clone, Debug, Default)]
pub struct Realisation<P = Point> {
    /// The seeds, in order.
    pub seeds: Vec<P>,
    /// The triangles that it is of, by their seeds.
    pub triangles: Vec<[u32; 3]>,
    /// Their edges, each once, in order of its seeds, smaller first.
    pub edges: Vec<GeodesicEdge<P>>,
    /// Pairs of edges, by number, that meet elsewhere than at a seed.
    pub crossing: Vec<[u32; 2]>,
    /// For each triangle the straight ones that it is cut into, by the vertices of [`Realisation::to_mesh`]; none where its
    /// edges bound no region, counter-clockwise.
    pub regions: Vec<Vec<[u32; 3]>>,
}

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

/// An edge as a geodesic, as reports have it but for its points.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(bound = "")]
pub struct GeodesicEdge<P = Point> {
    /// Its seeds, smaller first, numbered from 0.
    #[serde(rename = "edge")]
    pub ends: [u32; 2],
    /// The geodesic from the first to the second, as a polyline.
    #[serde(skip)]
    pub points: Vec<P>,
    /// Metric length of the geodesic.
    pub length: f64,
    /// Estimated relative error of the length (not a bound); how much shorter another way may be is not in it.
    pub error: f64,
    /// How it was found.
    pub found: Found,
}

/// What a triangle is seen in: the plane that it lies in, or a chart of the surface.
trait View<P>: Sync {
    /// Whether triangles on both sides of an edge see it alike.
    const IS_SHARED: bool;
    /// The metric.
    fn field(&self) -> &dyn MetricField;
    /// Where a point is seen.
    fn flat(&self, at: P) -> Point;
    /// What is seen at a point; `None` where nothing is.
    fn lifted(&self, at: Point) -> Option<P>;
}

impl View<Point> for &dyn MetricField {
    const IS_SHARED: bool = true;

    fn field(&self) -> &dyn MetricField {
        *self
    }

    fn flat(&self, at: Point) -> Point {
        at
    }

    fn lifted(&self, at: Point) -> Option<Point> {
        Some(at)
    }
}

impl AsRef<[Point]> for GeodesicEdge {
    fn as_ref(&self) -> &[Point] {
        &self.points
    }
}

impl<P: Copy> GeodesicEdge<P> {
    /// Its points from one of its seeds on.
    fn from(&self, seed: u32) -> Vec<P> {
        let mut points = self.points.clone();
        if self.ends[0] != seed {
            points.reverse();
        }
        points
    }
}

impl Realisation {
    /// Of triangles of a diagram's seeds, such as its nerve or a dual.
    pub fn new(diagram: &Diagram, triangles: &[[u32; 3]]) -> Self {
        let field = diagram.ground().field;
        let pairs: Vec<[u32; 2]> = Edges::of(triangles).ends().collect();
        let edges = edges::of(diagram, field, &pairs);
        let mut crossing: Vec<[u32; 2]> = crossings(&edges).iter().map(|c| c.paths).collect();
        crossing.dedup();
        let seeds = (0..diagram.colours() as u32).map(|i| diagram.seed(i).unwrap_or_default()).collect();
        let mut found = Self { seeds, triangles: triangles.to_vec(), edges, crossing, regions: Vec::new() };
        found.regions = found.cut(|_| [field]);
        found
    }

    /// The triangles in n by n pieces: sides are the edges as drawn, at equal metric lengths, and points inside are
    /// `karcher_mean`s. `None` where there are none, or pieces turn over: the triangle is too large for its curvature,
    /// or leads around a hole.
    pub fn grids(&self, field: &dyn MetricField, sides: usize) -> Vec<Option<Grid>> {
        self.seen_as_grids(|_| Some(field), sides)
    }
}

impl<P> Realisation<P> {
    /// Triangles whose edges bound no region.
    pub fn open(&self) -> usize {
        self.regions.iter().filter(|region| region.is_empty()).count()
    }
}
