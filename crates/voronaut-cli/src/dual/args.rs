//! What users of `voronaut dual` type.

use crate::options::{CanvasSize, Damage, EdgesOut, Memory, MetricChoices, Outputs, Run, Show, canvas_size};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::PathBuf;
use voronaut::canvas;
use voronaut::certificate::Constants;
use voronaut::diagram;
use voronaut::dual::Road;
use voronaut::geodesic::Method;

pub(crate) const EXAMPLES: &str = "\
Line i of FILE, `x y` (of a surface `x y z`, on it or near), is seed and vertex i. DOMAIN and METRIC are as for `mesh`; the metric is used as it is.

With --edges geodesic OUT holds the seeds first, then the points of the geodesics; edges are their segments (in a .vtu one
polyline cell for each), labelled with the number of the edge, and triangles cut up the region of each Riemannian triangle,
labelled with its number, both from 1. Lengths are in the report and in the .vtu.

Examples:
  voronaut dual rect:-2,-2,2,2 --metric swirl --seeds seeds.txt -o dual.mesh
  voronaut dual rect:-2,-2,2,2 --metric swirl --seeds seeds.txt -o rdt.vtu --edges geodesic --picture rdt.png --show geodesics
  voronaut dual sea.geojson --metric boundary:h0=2 --seeds ports.txt -o dual.vtu --diagram cells.vtu --report run.json";

#[derive(Debug, Args)]
pub(crate) struct DualArgs {
    /// The domain: a file or a shape
    pub(crate) domain: String,
    /// The metric in which distances are measured
    #[arg(long)]
    pub(crate) metric: String,
    /// The seeds: a file with a line `x y` for each
    #[arg(long, value_name = "FILE")]
    pub(crate) seeds: PathBuf,
    /// The dual: .mesh, .meshb, .msh, .vtu, .vtp, .obj, .off, .ply or .stl
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// Write the coloured canvas, with colours and distances: .vtu
    #[arg(long, value_name = "FILE")]
    pub(crate) diagram: Option<PathBuf>,
    /// What decides on the edges: geodesic (their lengths), canvas (the diagram on one) or both (the diagram where lengths cannot)
    #[arg(long, value_name = "ROAD", default_value_t = Road::default())]
    pub(crate) dual: Road,
    /// Which Voronoi diagram: riemannian, or, by straight distances, du-wang (in the metric of the place) or labelle-shewchuk (in
    /// that of the seed). Of these two OUT has the nerve as the canvas shows it, whatever --dual says; --show cells has their
    /// orphans in red
    #[arg(long, value_name = "WHICH", default_value_t = diagram::Kind::default())]
    pub(crate) voronoi: diagram::Kind,
    /// How distances on the canvas are computed: march, stvd[:window=8], dijkstra or konukoglu
    #[arg(long, value_name = "METHOD", default_value_t = Method::default())]
    pub(crate) geodesic: Method,
    /// How OUT has the edges: straight, or as the geodesics that they are (polylines, with the regions between them)
    #[arg(long, value_enum, value_name = "HOW", default_value_t = EdgesOut::Straight)]
    pub(crate) edges: EdgesOut,
    /// What distances travel on: intrinsic (even in the metric), isotropic (Euclidean Delaunay, as fine as the metric's finest
    /// direction) or starset (even in the metric; methods on graphs travel along Delaunay stars, each in its own metric)
    #[arg(long, value_name = "WHICH", default_value_t = canvas::Kind::default())]
    pub(crate) canvas: canvas::Kind,
    /// Canvas vertices per seed, of which up to 300 count as 2,500; or certified: as many as the theorems ask for
    #[arg(long, value_name = "N", value_parser = canvas_size, default_value_t = CanvasSize::default())]
    pub(crate) canvas_size: CanvasSize,
    /// Say which of the report's theorems hold of these seeds and this canvas, by how much others miss, and what it would take
    #[arg(long)]
    pub(crate) certify: bool,
    /// The formulas of these theorems: corrected, or printed (with the report's errors, to compare)
    #[arg(long, value_name = "WHICH", default_value_t = Constants::default())]
    pub(crate) constants: Constants,
    #[command(flatten)]
    pub(crate) memory: Memory,
    /// Exit with 1 if what OUT would hold is not embedded: straight triangles inverted, edges that cross
    #[arg(long)]
    pub(crate) strict: bool,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    #[command(flatten)]
    pub(crate) outputs: Outputs,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

impl DualArgs {
    /// Whether the seeds are to be certified: where that is asked for, or a canvas or a picture needs it.
    pub(super) fn is_certified(&self) -> bool {
        self.certify || self.canvas_size == CanvasSize::Certified || self.outputs.shows(Show::Certificate)
    }

    /// All options, as used.
    pub(super) fn as_used(&self) -> Value {
        let canvas_size = match self.canvas_size {
            CanvasSize::PerSeed(count) => json!(count),
            CanvasSize::Certified => json!("certified"),
        };
        json!({
            "domain": self.domain, "metric": self.metric, "seeds": self.seeds, "out": self.out, "diagram": self.diagram,
            "canvas": self.canvas, "canvas_size": canvas_size,
            "voronoi": self.voronoi, "certify": self.certify, "constants": self.constants, "geodesic": self.geodesic, "dual": self.dual, "edges": self.edges.to_possible_value().map(|value| value.get_name().to_string()), "strict": self.strict,
            "background": self.metric_choices.background, "bounds": self.metric_choices.bounds(),
            "smooth_metric": self.metric_choices.smooth_metric, "tensor_order": self.metric_choices.tensor_order, "gradation": self.metric_choices.gradation,
            "picture": self.outputs.picture, "histograms": self.outputs.histograms, "report": self.run.report, "threads": self.run.threads,
            "repair": self.damage.repair,
        })
    }
}
