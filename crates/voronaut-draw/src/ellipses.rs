//! The metric as ellipses: its balls around a well-spaced subset of the vertices.

use super::frame::PathData;
use super::strokes::Sheet;
use super::{colours, palette};
use std::collections::VecDeque;
use std::fmt::Write;
use voronaut::geometry::Tensor;
use voronaut::mesh::{Edges, Mesh};
use voronaut::metric::MetricField;
use voronaut::{Error, Result};

/// About how many ellipses a picture can hold and still be read.
const LIMIT: f64 = 900.0;
/// Least distance of two centres, in radii: they touch at 2.
const SPACING: f64 = 2.1;

/// One SVG path of metric balls, the points within metric distance r of a vertex in the vertex's own tensor. r is 1 on
/// small meshes and grows where unit balls would be too many to see; the SVG's description says which. Faint ones let
/// a mesh below be seen.
///
/// # Errors
/// [`Error::Metric`] where the metric is not positive definite at a vertex.
pub(super) fn ellipses(svg: &mut String, sheet: &Sheet, metric: &dyn MetricField, faint: bool) -> Result<()> {
    let Sheet { mesh, edges, frame, .. } = *sheet;
    let tensors = tensors(mesh, edges, metric)?;
    let radius = (mesh.points.len() as f64 / (SPACING * SPACING * LIMIT)).sqrt().max(1.0);
    let mut path = PathData::default();
    let opacity = if faint { 0.07 } else { 0.16 };
    for v in Packing::new(mesh, edges, &tensors, SPACING * radius).centres() {
        let Some(tensor) = tensors[v as usize] else { continue };
        let (eigen, centre) = (tensor.eigen(), mesh.point(v));
        let axes = [eigen.large, eigen.small].map(|value| radius / value.sqrt());
        let ends = [centre + eigen.axis * axes[0], centre - eigen.axis * axes[0]].map(|p| frame.place(p));
        let quanta = axes.map(|axis| (frame.quanta(frame.pixels(axis)).round() as i64).clamp(1, 1 << 40));
        path.ellipse(ends, quanta, -eigen.axis.y.atan2(eigen.axis.x).to_degrees());
    }
    let (ink, width) = (colours::ELLIPSE, frame.quanta(1.0));
    let style = format!(r#"fill="{ink}" fill-opacity="{opacity}" stroke="{ink}" stroke-width="{width:.1}""#);
    let _ = writeln!(svg, "<path {style} d=\"{}\"><desc>metric balls of radius {radius:.3}</desc></path>", path.text());
    Ok(())
}

/// The tensors at the vertices of triangles.
fn tensors(mesh: &Mesh, edges: &Edges, metric: &dyn MetricField) -> Result<Vec<Option<Tensor>>> {
    let mut tensors = vec![None; mesh.points.len()];
    for v in edges.ends().flatten() {
        if tensors[v as usize].is_none() {
            let (p, tensor) = (mesh.point(v), metric.at(mesh.point(v)));
            if !tensor.is_positive_definite() {
                let what = format!("({}, {}, {}) is not positive definite", tensor.xx, tensor.xy, tensor.yy);
                return Err(Error::metric(what, p.to_string(), "mend the metric there, or give bounds on it"));
            }
            tensors[v as usize] = Some(tensor);
        }
    }
    Ok(tensors)
}

/// Chooses vertices no two of which are closer than `distance` in the metric, each next one at the rim of the balls
/// around those before; on the boundary only if all vertices are.
struct Packing<'a> {
    mesh: &'a Mesh,
    tensors: &'a [Option<Tensor>],
    distance: f64,
    /// Of each vertex, in increasing order.
    neighbours: Vec<Vec<u32>>,
    /// Vertices that cannot become centres but lead to others.
    avoided: Vec<bool>,
    covered: Vec<bool>,
    /// The last centre from which each vertex was looked at.
    seen_from: Vec<u32>,
    rim: VecDeque<u32>,
}

impl<'a> Packing<'a> {
    fn new(mesh: &'a Mesh, edges: &Edges, tensors: &'a [Option<Tensor>], distance: f64) -> Self {
        let count = mesh.points.len();
        let mut avoided = vec![false; count];
        for v in edges.boundary().flat_map(|side| side.ends) {
            avoided[v as usize] = true;
        }
        if (0..count).all(|v| avoided[v] || tensors[v].is_none()) {
            avoided.fill(false);
        }
        let neighbours = palette::adjacency(count, edges.ends());
        let (covered, seen_from) = (vec![false; count], vec![u32::MAX; count]);
        Self { mesh, tensors, distance, neighbours, avoided, covered, seen_from, rim: VecDeque::new() }
    }

    fn centres(mut self) -> Vec<u32> {
        let mut centres = Vec::new();
        for start in (0..self.mesh.points.len() as u32).filter(|&v| self.tensors[v as usize].is_some()) {
            self.rim.push_back(start);
            while let Some(v) = self.rim.pop_front() {
                if std::mem::replace(&mut self.covered[v as usize], true) {
                    continue;
                }
                if self.avoided[v as usize] {
                    self.rim.extend(&self.neighbours[v as usize]);
                } else {
                    centres.push(v);
                    self.cover(v);
                }
            }
        }
        centres
    }

    /// Covers the vertices near a centre, and puts those around them on the rim.
    fn cover(&mut self, centre: u32) {
        let mut ball = vec![centre];
        while let Some(v) = ball.pop() {
            for &u in &self.neighbours[v as usize] {
                if std::mem::replace(&mut self.seen_from[u as usize], centre) == centre {
                    continue;
                }
                let offset = self.mesh.point(u) - self.mesh.point(centre);
                let is_near = |w: u32| self.tensors[w as usize].is_some_and(|m| m.length(offset) < self.distance);
                if is_near(centre) || is_near(u) {
                    self.covered[u as usize] = true;
                    ball.push(u);
                } else if !self.covered[u as usize] {
                    self.rim.push_back(u);
                }
            }
        }
    }
}
