//! Metric lengths of the embedded edges, and what to do where three of them make no triangle.
//!
//! An edge has the length of the geodesic between its ends, not of its chord: where the metric turns within an edge, chords
//! are too long by the same share on every canvas triangle, and that share adds up along a front. (Pull-back of flat
//! space at anisotropy around 35, 10,000 vertices: distances err by 2.7 % in the mean with chords, by 0.12 % with geodesics.)

use super::CanvasCounters;
use super::refine::is_beside_flat;
use crate::error::{Error, Result};
use crate::geodesic::{bowed_between, bowed_chord};
use crate::geometry::Tensor;
use crate::metric::{MetricField, check_tensor};
use crate::planar::Planar;
use crate::triangulation::{FaceId, HalfEdge};
use rayon::prelude::*;

/// An edge longer than the other two of its face together, by more than this share of them, is split; less is
/// curvature, and the edge is shortened.
const BROKEN: f64 = 1e-3;
/// Repairs at most, as a share of the vertices: they end where the metric is resolved, and at jumps they do not.
const REPAIRS: f64 = 0.02;
/// Edges shorter than this share of their mean are not split: at a jump of the metric halving does not end.
const SHORTEST: f64 = 1e-2;

/// Measures every edge whose length is not yet known, in parallel, and makes the lengths of every face those of a triangle.
///
/// # Errors
/// A length is not finite, or the metric is not positive definite at a new vertex.
pub(super) fn measure(planar: &mut Planar, field: &dyn MetricField, counters: &mut CanvasCounters) -> Result<()> {
    let edges: Vec<HalfEdge> = planar.topology.edges().filter(|&h| planar.topology.length(h).is_nan()).collect();
    let lengths: Vec<f64> = if edges.len() > planar.positions.len() {
        // Each vertex ends some six edges.
        let tensors: Vec<Tensor> = planar.positions.par_iter().with_min_len(1024).map(|&p| field.at(p)).collect();
        let ends = |h| [planar.topology.origin(h), planar.topology.target(h)].map(|v| tensors[v.index()]);
        edges.par_iter().with_min_len(1024).map(|&h| bowed_between(field, planar.ends(h), ends(h))).collect()
    } else {
        edges.par_iter().with_min_len(1024).map(|&h| geodesic(planar, field, h)).collect()
    };
    for (&h, length) in edges.iter().zip(lengths) {
        set(planar, h, length)?;
    }
    repair(planar, field, counters)?;
    counters.shortened += shorten(planar);
    Ok(())
}

fn geodesic(planar: &Planar, field: &dyn MetricField, h: HalfEdge) -> f64 {
    let [p, q] = planar.ends(h);
    bowed_chord(field, p, q)
}

fn set(planar: &mut Planar, h: HalfEdge, length: f64) -> Result<()> {
    if !(length > 0.0 && length.is_finite()) {
        let [p, q] = planar.ends(h);
        let what = format!("the length from {p} to {q} is {length}");
        let help = "give a metric that is positive definite and neither vanishes nor overflows on the domain";
        return Err(Error::metric(what, p.midpoint(q).to_string(), help));
    }
    planar.topology.set_length(h, length);
    Ok(())
}

/// Splits the edges that are far too long for their faces.
fn repair(planar: &mut Planar, field: &dyn MetricField, counters: &mut CanvasCounters) -> Result<()> {
    let mut faces: Vec<FaceId> = planar.topology.faces().collect();
    let most = (planar.positions.len() as f64 * REPAIRS) as u64 + 100;
    let shortest = SHORTEST * mean_length(planar);
    let mut repairs = 0;
    while let Some(f) = faces.pop() {
        let (h, excess) = longest(planar, f);
        let is_tiny = planar.topology.length(h) < shortest || is_beside_flat(planar, h);
        if excess <= BROKEN || repairs == most || is_tiny {
            continue;
        }
        let [p, q] = planar.ends(h);
        let middle = p.midpoint(q);
        check_tensor(field.at(middle), middle)?;
        let Some((v, _)) = planar.insert_on_edge(h, middle) else { continue };
        repairs += 1;
        let star: Vec<HalfEdge> = planar.topology.star(v).collect();
        for h in star.iter().flat_map(|&h| [h, h.prev()]) {
            set(planar, h, geodesic(planar, field, h))?;
        }
        faces.extend(star.into_iter().map(HalfEdge::face));
    }
    counters.repairs += repairs;
    Ok(())
}

fn mean_length(planar: &Planar) -> f64 {
    let lengths = planar.topology.edges().map(|h| planar.topology.length(h));
    lengths.sum::<f64>() / planar.topology.edges().count().max(1) as f64
}

/// Shortens edges until no face breaks the triangle inequality: a detour along the other two edges is a path, too.
fn shorten(planar: &mut Planar) -> u64 {
    let mut faces: Vec<FaceId> = planar.topology.faces().collect();
    let mut shortened = 0;
    while let Some(f) = faces.pop() {
        let (h, excess) = longest(planar, f);
        if excess > 0.0 {
            let others = planar.topology.length(h.next()) + planar.topology.length(h.prev());
            planar.topology.set_length(h, others);
            shortened += 1;
            faces.extend(planar.topology.twin(h).map(HalfEdge::face));
        }
    }
    shortened
}

/// The longest edge of a face, and by what share it exceeds the sum of the others.
fn longest(planar: &Planar, f: FaceId) -> (HalfEdge, f64) {
    let length = |h: HalfEdge| planar.topology.length(h);
    let [a, b, c] = f.half_edges();
    let longer = if length(b) > length(a) { b } else { a };
    let h = if length(c) > length(longer) { c } else { longer };
    let others = length(h.next()) + length(h.prev());
    (h, length(h) / others - 1.0)
}
