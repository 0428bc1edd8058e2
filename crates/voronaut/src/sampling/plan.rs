//! How fine the metric must be for a mesh of so many vertices, and what that mesh will need.

use super::segments::{MetricArc, pieces};
use crate::canvas;
use crate::domain::Domain;
use crate::error::{Error, Result};
use crate::metric::{MetricField, complexity, rough_complexity};
use crate::triangulation::HalfEdge;
use rayon::prelude::*;

/// What the size of the mesh should follow from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Target {
    /// This many vertices; the metric is scaled to that.
    Vertices(usize),
    /// This integral of sqrt(det M); the metric is scaled to that.
    Complexity(f64),
    /// The metric as it is.
    Metric,
}

/// Metric area of the equilateral triangle with unit edges.
const UNIT_TRIANGLE: f64 = 0.433_012_701_892_219_3;
/// Bytes that a vertex of the mesh costs at the peak, with its two triangles: measured 0.5 to 0.7 kB, with a reserve.
const BYTES_PER_VERTEX: f64 = 1200.0;

/// A domain measured by a metric.
pub(crate) struct Plan {
    /// The integral of sqrt(det M).
    pub complexity: f64,
    /// One half-edge of every constrained edge of the domain's triangulation, and whether it must stay whole.
    pub edges: Vec<(HalfEdge, bool)>,
    /// Their metric lengths.
    pub arcs: Vec<MetricArc>,
    corners: usize,
    copies: usize,
}

impl Plan {
    /// Measures the domain, in parallel, as accurately as the target needs.
    ///
    /// # Errors
    /// The metric is not positive definite somewhere, or its complexity not finite.
    pub(crate) fn new(domain: &Domain, field: &dyn MetricField, target: Target) -> Result<Self> {
        let planar = domain.planar();
        let required = |h| planar.topology.constraint(h).is_some_and(|c| domain.pslg().segments[c.0 as usize].required);
        let constrained = planar.topology.edges().filter(|&h| planar.topology.constraint(h).is_some());
        let edges: Vec<(HalfEdge, bool)> = constrained.map(|h| (h, required(h))).collect();
        let arcs = edges.par_iter().map(|&(h, _)| planar.ends(h)).map(|[a, b]| MetricArc::new(field, a, b)).collect();
        // Elsewhere the integral is only where the search for scale or count starts.
        let integral = if matches!(target, Target::Complexity(_)) { complexity } else { rough_complexity };
        let complexity = integral(field, &domain.triangles())?;
        Ok(Self { complexity, edges, arcs, corners: planar.topology.vertex_count(), copies: copies(domain) })
    }

    /// Vertices of the domain itself, with copies: no mesh has fewer.
    pub(crate) fn corners(&self) -> usize {
        self.corners
    }

    /// Vertices that are there twice while meshing, and joined in the mesh: where the domain touches itself in a point.
    pub(crate) fn copies(&self) -> usize {
        self.copies
    }

    /// Vertices on the boundary and interfaces when the metric is multiplied by `scale`.
    pub(crate) fn boundary_vertices(&self, scale: f64) -> f64 {
        let cuts = |(arc, &(_, required)): (&MetricArc, &(HalfEdge, bool))| {
            if required { 0.0 } else { pieces(arc.length() * scale.sqrt()) as f64 - 1.0 }
        };
        self.corners as f64 + self.arcs.iter().zip(&self.edges).map(cuts).sum::<f64>()
    }

    /// Expected vertices of the unit mesh of the metric times `scale`: half its triangles plus half its boundary
    /// (Euler), with all triangles equilateral.
    pub(crate) fn expected_vertices(&self, scale: f64) -> f64 {
        let boundary = self.boundary_vertices(scale);
        boundary.max(0.5 * scale * self.complexity / UNIT_TRIANGLE + 0.5 * boundary)
    }

    /// The largest scale for which no more than `count` vertices are expected; where the corners alone are more, the
    /// scale at which the metric asks for no vertex beside them.
    pub(crate) fn scale_for(&self, count: f64) -> f64 {
        let mut low = count * UNIT_TRIANGLE / self.complexity;
        while self.expected_vertices(low) > count {
            if self.expected_vertices(low) <= self.corners as f64 {
                return low;
            }
            low *= 0.5;
        }
        let mut high = low.max(f64::MIN_POSITIVE);
        while self.expected_vertices(high) <= count {
            high *= 2.0;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if self.expected_vertices(middle) <= count { low = middle } else { high = middle }
        }
        low
    }

    /// Vertex count (with copies) and metric factor to start from.
    ///
    /// # Errors
    /// [`Error::Limit`] where the mesh is estimated to need more memory than `memory_limit` bytes, or more vertices
    /// than ids can number.
    pub(crate) fn start(&self, target: Target, memory_limit: u64) -> Result<(usize, f64)> {
        let (count, scale) = match target {
            Target::Vertices(n) => ((n + self.copies) as f64, self.scale_for((n + self.copies) as f64)),
            Target::Complexity(c) => (self.expected_vertices(c / self.complexity), c / self.complexity),
            Target::Metric => (self.expected_vertices(1.0), 1.0),
        };
        demand_memory(count, 0.0, memory_limit)?;
        Ok((count.round().max(3.0) as usize, scale))
    }
}

fn copies(domain: &Domain) -> usize {
    let mut sources: Vec<u32> = domain.sources().iter().flatten().copied().collect();
    let all = sources.len();
    sources.sort_unstable();
    sources.dedup();
    all - sources.len()
}

/// Demands that a mesh of so many vertices, made with a canvas of so many (0: none), fits into `limit` bytes.
///
/// # Errors
/// [`Error::Limit`] where it is estimated not to, or where ids could not number all vertices.
pub fn demand_memory(vertices: f64, canvas: f64, limit: u64) -> Result<()> {
    let needed = vertices * BYTES_PER_VERTEX + canvas * canvas::BYTES_PER_VERTEX;
    let ids = f64::from(u32::MAX) / 8.0;
    if needed <= limit as f64 && vertices.max(canvas) < ids {
        return Ok(());
    }
    let mib = |bytes: f64| format!("{:.0} MiB", bytes / f64::from(1 << 20));
    let (needed, limit) = (mib(needed), mib(limit as f64));
    let (and_canvas, coarser) = if canvas > 0.0 {
        (format!(" and {canvas:.3e} of a canvas"), ", fewer canvas vertices per seed (`canvas_size`)")
    } else {
        (String::new(), "")
    };
    let work = format!("about {vertices:.3e} vertices{and_canvas}");
    let what = format!("{work} are estimated to need {needed} of memory; the limit is {limit}");
    let help =
        format!("ask for fewer vertices (`vertices`){coarser}, a coarser metric (`h_min`), or raise `memory_limit`");
    Err(Error::Limit { what, help })
}
