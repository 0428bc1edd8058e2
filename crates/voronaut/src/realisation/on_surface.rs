//! Realisations on surfaces: edges are pulled taut on the diagram's canvas, triangles are seen in charts.

use super::crossed::crossed;
use super::{Found, GeodesicEdge, Grid, Realisation, View};
use crate::canvas::Way;
use crate::diagram::SurfaceDiagram;
use crate::geometry::{Point, Point3};
use crate::manifold::Chart;
use crate::mesh::Edges;
use crate::metric::MetricField;
use crate::net::SeedsOnSurface;
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;
use std::iter;

/// Relative error of the length of a way that is taut on a canvas: that on a unit sphere with a canvas of 80 vertices a seed, measured
/// (`tests::surfaces::realisation`).
const OF_TAUT: f64 = 2e-3;

/// Points of a way that are as near as this (share of its length in space) are one: it crosses several edges where it goes by a vertex.
const SAME: f64 = 1e-6;

/// Points of a way without those that are the one before; both ends stay.
fn apart(mut points: Vec<Point3>) -> Vec<Point3> {
    let least = SAME * points.windows(2).map(|ends| ends[0].distance(ends[1])).sum::<f64>();
    let end = points.pop();
    points.dedup_by(|after, before| before.distance(*after) <= least);
    while points.len() > 1 && points.last().zip(end).is_some_and(|(last, end)| last.distance(end) <= least) {
        points.pop();
    }
    points.into_iter().chain(end).collect()
}

impl Realisation<Point3> {
    /// Of triangles of the seeds of a surface's diagram. An edge for which there is no way is straight, with an infinite error.
    pub(crate) fn on_surface(diagram: &SurfaceDiagram, triangles: &[[u32; 3]]) -> Self {
        let draped = diagram.canvas().draped();
        let vertex = |i: u32| diagram.seed(i).unwrap_or(VertexId(0));
        let pairs: Vec<[u32; 2]> = Edges::of(triangles).ends().collect();
        let way = |&[p, q]: &[u32; 2]| draped.geodesic(vertex(p), vertex(q));
        let ways: Vec<Option<Way>> = pairs.par_iter().map(way).collect();
        let crossing = crossed(draped.topology(), &ways);
        let edge = |(ends, way): ([u32; 2], Option<Way>)| {
            let error = if way.is_some() { OF_TAUT } else { f64::INFINITY };
            let Way { length, points, .. } = way.unwrap_or_else(|| {
                let points = ends.map(|i| draped.position(vertex(i)));
                Way { length: f64::INFINITY, points: points.to_vec(), ..Way::default() }
            });
            GeodesicEdge { ends, points: apart(points), length, error, found: Found::Traced }
        };
        let edges = pairs.into_iter().zip(ways).map(edge).collect();
        let seeds = (0..diagram.colours() as u32).map(|i| draped.position(vertex(i))).collect();
        let mut found = Self { seeds, triangles: triangles.to_vec(), edges, crossing, regions: Vec::new() };
        let charts = &SeedsOnSurface::of(diagram);
        // On a tip the surface turns away from any chart: what is cut then is seen from where all three corners are level.
        let views = |triangle: [u32; 3]| {
            let chart = iter::once_with(move || charts.chart(&triangle));
            chart.chain(iter::once_with(move || charts.facing(triangle))).flatten()
        };
        found.regions = found.cut(views);
        found
    }

    /// The triangles in n by n pieces, as [`Realisation::grids`] has them of the plane, on the surface of a diagram of these seeds.
    pub fn grids_on_surface(&self, diagram: &SurfaceDiagram, sides: usize) -> Vec<Option<Grid<Point3>>> {
        let charts = SeedsOnSurface::of(diagram);
        self.seen_as_grids(|triangle| charts.chart(&triangle), sides)
    }
}

impl View<Point3> for Chart<'_> {
    /// Each sees it bend away from itself, or towards.
    const IS_SHARED: bool = false;

    fn field(&self) -> &dyn MetricField {
        self
    }

    fn flat(&self, at: Point3) -> Point {
        self.flatten(at)
    }

    fn lifted(&self, at: Point) -> Option<Point3> {
        self.place(at).map(|place| place.position)
    }
}
