//! What users of `voronaut distance` type.

use crate::options::{Coordinates, Damage, Memory, MetricChoices, Run, coordinates};
use clap::{Args, value_parser};
use std::path::PathBuf;
use voronaut::canvas;
use voronaut::geodesic::Method;
use voronaut_draw::Picture;

pub(crate) const EXAMPLES: &str = "\
DOMAIN and METRIC are as for `mesh`, or a surface and a metric on it as for `check`; the metric is used as it is. Points near a
surface are moved onto it. METHOD: march (fast marching by lengths, the most accurate),
stvd[:window=8] (Campen 2013), dijkstra, konukoglu (recursive fast marching, 2007), lbr (FM-LBR on a grid of the plane, Mirebeau
2014), heat (Crane 2013).
OUT has the canvas with point data `distance`; the path's points come behind the canvas's, its segments are line cells.

Examples:
  voronaut distance rect:-2,-2,2,2 --metric swirl --from 1,0.5 -o distance.vtu --picture distance.png
  voronaut distance sea.geojson --metric boundary:h0=2 --from 10,20 --from 300,-40 --to 90,80 -o way.vtu --report way.json
  voronaut distance torus:2,0.7 --metric curvature --from 2.7,0,0 --to -1.3,0,0 -o torus.vtu --picture torus.png";

#[derive(Debug, Args)]
pub(crate) struct DistanceArgs {
    /// The domain: a file or a shape
    pub(crate) domain: String,
    /// The metric in which distances are measured
    #[arg(long)]
    pub(crate) metric: String,
    /// Where distances start: a point of the domain; may be given more than once
    #[arg(long, value_name = "X,Y[,Z]", value_parser = coordinates, required = true, allow_hyphen_values = true)]
    pub(crate) from: Vec<Coordinates>,
    /// Trace the shortest path from this point to the nearest of those
    #[arg(long, value_name = "X,Y[,Z]", value_parser = coordinates, allow_hyphen_values = true)]
    pub(crate) to: Option<Coordinates>,
    /// The distances on the canvas, and the path: .vtu
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// How distances are computed
    #[arg(long, value_name = "METHOD", default_value_t = Method::default())]
    pub(crate) geodesic: Method,
    /// What distances travel on: intrinsic, isotropic or starset (see `dual`)
    #[arg(long, value_name = "WHICH", default_value_t = canvas::Kind::default())]
    pub(crate) canvas: canvas::Kind,
    /// Vertices of the canvas, in all
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..), default_value_t = CANVAS_VERTICES)]
    pub(crate) canvas_size: u32,
    #[command(flatten)]
    pub(crate) memory: Memory,
    /// Draw the distances, lines of equal distance and the path: .svg or .png
    #[arg(long, value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
    /// Pixels of the picture's longer side
    #[arg(long, value_name = "PIXELS", default_value_t = Picture::default().width, value_parser = value_parser!(u32).range(16..=16_000), requires = "picture")]
    pub(crate) pixels: u32,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

/// Vertices of the canvas of `distance`: marching errs by about a thousandth then, in half a second.
const CANVAS_VERTICES: u32 = 40_000;
