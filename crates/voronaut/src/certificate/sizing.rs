//! What a sizing field costs, and how fine a canvas is.

use crate::diagram::{Diagram, Frozen, Ground};
use crate::error::Result;
use crate::geometry::Point3;
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, Triangulation};
use serde::Serialize;

/// Vertices that a canvas would take, estimated: half its triangles, each with an area of s0^2.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Of an intrinsic canvas, whose triangles are as long in all directions of the metric.
    pub intrinsic: f64,
    /// Of an isotropic one, as fine everywhere as the metric is in its finest direction.
    pub isotropic: f64,
}

/// The area of a domain or surface in the metric, and in the isotropic metrics of the greater eigenvalues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Area {
    intrinsic: f64,
    isotropic: f64,
}

impl Area {
    /// From the faces of a canvas, with the mean of what their corners have.
    pub(crate) fn of<'a, G: Ground<'a>>(ground: G) -> Self {
        let topology = ground.embedded();
        let faces: Vec<FaceId> = topology.faces().collect();
        let measured = |&f: &FaceId| {
            let corners = topology.corners(f).map(|v| ground.frozen(ground.place(v)));
            let [a, b, c] = corners.map(|corner| corner.at);
            let third = (b - a).cross(c - a).norm() / 6.0;
            let densities =
                corners.map(|Frozen { tensor, .. }| [tensor.determinant().max(0.0).sqrt(), tensor.eigen().large]);
            [0, 1].map(|i| third * densities.iter().map(|density| density[i]).sum::<f64>())
        };
        let areas: Vec<[f64; 2]> = faces.par_iter().with_min_len(1024).map(measured).collect();
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
pub(crate) fn longest_edge(topology: &Triangulation) -> f64 {
    topology.edges().map(|h| topology.length(h)).fold(0.0, f64::max)
}

/// Half the longest edge between vertices of the cells that a test picks: in the metric, and Euclidean.
pub(super) fn half_longest<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, is_picked: impl Fn(u32) -> bool) -> [f64; 2] {
    let ground = diagram.ground();
    let topology = ground.topology();
    let mut longest = [0.0_f64; 2];
    for h in topology.edges() {
        let ends = topology.ends(h);
        if ends.iter().all(|&v| diagram.colour(v).is_some_and(&is_picked)) {
            let [p, q] = ends.map(|v| Point3::from(ground.coordinates(v)));
            longest = [longest[0].max(topology.length(h)), longest[1].max(p.distance(q))];
        }
    }
    // Where there are none nothing is known.
    longest.map(|length| if length > 0.0 { 0.5 * length } else { f64::NAN })
}

/// A canvas of which no edge is longer than `2 size` in the metric, made with as many vertices as that takes; `None` if it would take more
/// than `most` vertices.
///
/// # Errors
/// Those of making one.
pub(crate) fn sized_canvas<C>(
    size: f64,
    [start, most]: [f64; 2],
    make: impl Fn(usize) -> Result<C>,
    measure: impl Fn(&C) -> (f64, usize),
) -> Result<Option<C>> {
    let mut vertices = start.max(100.0);
    while vertices <= most {
        let canvas = make(vertices as usize)?;
        let (longest, count) = measure(&canvas);
        let excess = longest / (2.0 * size);
        if excess < 1.0 {
            return Ok(Some(canvas));
        }
        vertices = vertices.max(count as f64) * (excess * excess).clamp(1.1, 4.0);
    }
    Ok(None)
}
