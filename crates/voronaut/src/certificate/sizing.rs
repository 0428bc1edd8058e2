//! What a sizing field costs, and how fine a canvas is.

use crate::canvas::Canvas;
use crate::diagram::Diagram;
use crate::domain::Domain;
use crate::error::Result;
use crate::geometry::{Point, Vector};
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use serde::Serialize;

/// Vertices that a canvas would take, estimated: half its triangles, each with an area of s0^2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Of an intrinsic canvas, whose triangles are as long in all directions of the metric.
    pub intrinsic: f64,
    /// Of an isotropic one, as fine everywhere as the metric is in its finest direction.
    pub isotropic: f64,
}

/// The area of a domain in the metric, and in the isotropic metrics of the greater eigenvalues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Area {
    intrinsic: f64,
    isotropic: f64,
}

impl Area {
    /// From the faces of a canvas, with one tensor in each.
    pub(crate) fn of(canvas: &Canvas, field: &dyn MetricField) -> Self {
        let planar = canvas.embedded();
        let triangles: Vec<[Point; 3]> = planar.topology.faces().map(|f| planar.triangle(f)).collect();
        let measured = |&[a, b, c]: &[Point; 3]| {
            let tensor = field.at(Point::centroid([a, b, c]));
            let area = 0.5 * Vector::cross(b - a, c - a);
            [area * tensor.determinant().max(0.0).sqrt(), area * tensor.eigen().large]
        };
        let areas: Vec<[f64; 2]> = triangles.par_iter().with_min_len(1024).map(measured).collect();
        let [intrinsic, isotropic] = [0, 1].map(|i| areas.iter().map(|area| area[i]).sum());
        Self { intrinsic, isotropic }
    }

    /// What a canvas with a sizing field costs.
    pub(crate) fn cost(&self, size: f64) -> Cost {
        let per_vertex = 2.0 * size * size;
        Cost { intrinsic: self.intrinsic / per_vertex, isotropic: self.isotropic / per_vertex }
    }
}

/// The longest edge that distances travel on, in the metric.
pub fn longest_edge(canvas: &Canvas) -> f64 {
    let topology = canvas.topology();
    topology.edges().map(|h| topology.length(h)).fold(0.0, f64::max)
}

/// Half the longest edge between vertices of the cells that a test picks: in the metric, and Euclidean.
pub(super) fn half_longest(diagram: &Diagram, is_picked: impl Fn(u32) -> bool) -> [f64; 2] {
    let canvas = diagram.canvas();
    let topology = canvas.topology();
    let mut longest = [0.0_f64; 2];
    for h in topology.edges() {
        let ends = topology.ends(h);
        if ends.iter().all(|&v| diagram.colour(v).is_some_and(&is_picked)) {
            let euclidean = canvas.position(ends[0]).distance(canvas.position(ends[1]));
            longest = [longest[0].max(topology.length(h)), longest[1].max(euclidean)];
        }
    }
    // Where there are none nothing is known.
    longest.map(|length| if length > 0.0 { 0.5 * length } else { f64::NAN })
}

/// An intrinsic canvas of which no edge is longer than `2 size` in the metric, by as many vertices as that takes; and
/// what made it end: `None` if it would take more than `most` vertices.
///
/// # Errors
/// As for [`Canvas::intrinsic`].
pub(crate) fn sized_canvas(
    domain: &Domain,
    field: &dyn MetricField,
    size: f64,
    start: f64,
    most: f64,
) -> Result<Option<Canvas>> {
    let mut vertices = start.max(100.0);
    while vertices <= most {
        let canvas = Canvas::intrinsic(domain, field, vertices as usize)?;
        let excess = longest_edge(&canvas) / (2.0 * size);
        if excess < 1.0 {
            return Ok(Some(canvas));
        }
        vertices = vertices.max(canvas.vertex_count() as f64) * (excess * excess).clamp(1.1, 4.0);
    }
    Ok(None)
}
