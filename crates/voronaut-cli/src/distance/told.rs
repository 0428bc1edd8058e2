//! What is written and said of distances.

use super::args::DistanceArgs;
use serde_json::{Value, json};
use std::time::Instant;
use voronaut::canvas::CanvasFigures;
use voronaut::diagram::{Distances, Ground};
use voronaut::mesh::Mesh;
use voronaut_io::Seconds;

/// What is written.
pub(super) struct Made {
    pub(super) mesh: Mesh,
    pub(super) distances: Vec<f64>,
    pub(super) picture: Option<String>,
    pub(super) told: Value,
}

/// Where distances start, and what was found of the point that was asked for: its distance, the path's length and points.
pub(super) struct Asked {
    pub(super) from: Vec<Vec<f64>>,
    pub(super) to: Option<Vec<f64>>,
    pub(super) distance: Option<f64>,
    pub(super) path: Option<(f64, usize)>,
}

/// The report: `distance` and `path_length` to the point that was asked for, both null without one.
pub(super) fn told<'a, G: Ground<'a>>(
    args: &DistanceArgs,
    found: &Distances<'a, G>,
    asked: &Asked,
    canvas: &CanvasFigures,
    seconds: &Seconds,
) -> Value {
    let reached = found.values().iter().filter(|d| d.is_finite());
    let unreached = found.values().len() - reached.clone().count();
    json!({
        "from": asked.from, "to": asked.to,
        "distance": asked.distance.filter(|d| d.is_finite()),
        "path_length": asked.path.map(|path| path.0), "path_points": asked.path.map(|path| path.1),
        "farthest": reached.copied().fold(0.0, f64::max), "unreached": unreached,
        "geodesic": args.geodesic, "canvas": canvas, "counters": found.counters(),
        "seconds": seconds, "peak_memory_bytes": voronaut_io::peak_memory_bytes(), "version": env!("CARGO_PKG_VERSION"),
        "options": {
            "domain": args.domain, "metric": args.metric, "out": args.out, "canvas": args.canvas,
            "canvas_size": args.canvas_size, "geodesic": args.geodesic, "background": args.metric_choices.background,
            "bounds": args.metric_choices.bounds(), "smooth_metric": args.metric_choices.smooth_metric, "tensor_order": args.metric_choices.tensor_order, "gradation": args.metric_choices.gradation, "picture": args.picture,
            "pixels": args.pixels, "report": args.report, "threads": args.run.threads,
            "repair": args.damage.repair,
        },
    })
}

/// From the times at which stages ended, and the last one now.
pub(super) fn seconds(ends: &[f64; 3], start: Instant) -> Seconds {
    let ([read, made, solved], total) = (ends, start.elapsed().as_secs_f64());
    let stages = vec![("read", *read), ("canvas", made - read), ("distances", solved - made), ("path", total - solved)];
    Seconds { stages, total }
}

/// Lines of equal distance in a picture.
const ISOLINES: u32 = 20;

/// The levels of lines of equal distance.
pub(super) fn levels(values: &[f64]) -> Vec<f64> {
    let most = values.iter().copied().filter(|d| d.is_finite()).fold(0.0, f64::max);
    (1..ISOLINES).map(|i| most * f64::from(i) / f64::from(ISOLINES)).collect()
}
