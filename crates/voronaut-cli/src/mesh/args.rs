//! What users of `voronaut mesh` type.

use crate::options::{Damage, Memory, MetricChoices, Outputs, Run, Show, not_negative, positive};
use clap::{Args, value_parser};
use serde_json::{Value, json};
use std::path::PathBuf;
use voronaut::canvas;
use voronaut::dual::Road;
use voronaut::geodesic::Method;
use voronaut::recipe::{Centroid, MeshOptions, Mesher, Seeding};
use voronaut::surface::FeatureOptions;

pub(crate) const EXAMPLES: &str = "\
DOMAIN  a file: .mesh, .meshb, .msh, .vtu, .vtp (boundary edges or triangles; of volumes the boundary), .poly, .geojson; or a shape: rect:x0,y0,x1,y1, disk:cx,cy,r;
        or a surface: .obj, .off, .ply, .stl and the first five; sphere:r, torus:R,r, chair, 'implicit:EXPR;x0,y0,z0,x1,y1,z1'
METRIC  uniform, uniform:m11,m12,m22, swirl[:nu=3,field=authors], shock[:phi=10,lambda=0.6],
        'formula:m11; m12; m22' in x and y, boundary:h0=,growth=,aspect=,h_max=, or a file .sol or .solb;
        on surfaces: uniform, curvature[:floor=C], shock, 'formula:m11; m12; m22; m13; m23; m33' in x, y, z, or a .sol;
        an eigenvalue 1/h^2 asks for edges of length h along its eigenvector

Examples:
  voronaut mesh rect:0,0,2,1 --metric uniform -n 2000 -o plate.mesh
  voronaut mesh disk:0,0,1 --metric swirl -n 4000 -o swirl.vtu --picture swirl.svg
  voronaut mesh rect:-1,-1,1,1 --metric 'formula:1/(0.01 + 0.2*abs(y))^2; 0; 25' -o layer.mesh
  voronaut mesh wing.mesh --metric wing.sol --h-min 1e-4 --a-max 100 -o adapted.mesh --report run.json
  voronaut mesh sea.geojson --metric boundary:h0=2,growth=1.3 -n 20000 -o sea.mesh -q
  voronaut mesh spot.obj --metric curvature -n 1020 --fit -o spot-1020.obj --picture spot.png --show cells,mesh";

#[derive(Debug, Args)]
pub(crate) struct MeshArgs {
    /// What to mesh: a file or a shape
    pub(crate) domain: String,
    /// Sizes and directions of the edges (see below)
    #[arg(long)]
    pub(crate) metric: String,
    /// Vertices the mesh should have; one factor scales the metric to meet it
    #[arg(short = 'n', long, value_name = "N", value_parser = value_parser!(u32).range(3..), conflicts_with = "complexity")]
    pub(crate) vertices: Option<u32>,
    /// Integral of sqrt(det M) over the domain; one factor scales the metric to meet it
    #[arg(long, value_name = "C", value_parser = positive)]
    pub(crate) complexity: Option<f64>,
    /// The mesh file: .mesh, .meshb, .msh, .vtu, .vtp, .obj, .off, .ply or .stl
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    /// How far (Euclidean) edges may stray from the boundary [default: the domain's own tolerance]; of a surface: mesh and surface
    /// from each other, by more vertices unless -n says how many
    #[arg(long, value_name = "D", value_parser = not_negative)]
    pub(crate) hausd: Option<f64>,
    /// Surfaces: vertices where mesh and surface are closest in the sense of least squares, instead of on the surface
    #[arg(long)]
    pub(crate) fit: bool,
    /// Edges of a surface where its normal turns by more than this angle are creases: they are kept, as borders, listed edges and
    /// edges between labels are, and with them the corners where such curves turn by as much
    #[arg(long, value_name = "DEGREES", value_parser = positive, default_value_t = FeatureOptions::DEFAULT_ANGLE)]
    pub(crate) ar: f64,
    /// Look for no creases and corners by angles
    #[arg(long, conflicts_with = "ar")]
    pub(crate) nr: bool,
    /// What makes the mesh: voronoi, or starset (Delaunay stars in the metrics of their vertices, refined until they agree: to
    /// compare; -n then sets the scale only)
    #[arg(long, value_name = "HOW", default_value_t = MeshOptions::default().mesher)]
    pub(crate) mesher: Mesher,
    /// Steps of Riemannian Lloyd relaxation
    #[arg(long, value_name = "STEPS", default_value_t = MeshOptions::default().lloyd)]
    pub(crate) lloyd: usize,
    /// The centroids seeds are relaxed to: tangent (of cells in tangent planes), canvas (of the diagram's cells) or weighted
    /// (equation 9 of the report, to compare)
    #[arg(long, value_name = "WHICH", default_value_t = MeshOptions::default().centroid)]
    pub(crate) centroid: Centroid,
    /// With hessian metrics: sweeps in which vertices move and edges flip so that the error of linear interpolation falls, at
    /// most; 0 for the metric's unit mesh. Not with limits on the metric
    #[arg(long, value_name = "SWEEPS", default_value_t = MeshOptions::default().polish)]
    pub(crate) polish: usize,
    /// What decides on the edges: geodesic (their lengths), canvas (the diagram on one) or both (the diagram where lengths cannot)
    #[arg(long, value_name = "ROAD", default_value_t = MeshOptions::default().dual)]
    pub(crate) dual: Road,
    /// How distances on the canvas are computed where the diagram decides: march, stvd[:window=8], dijkstra or konukoglu
    #[arg(long, value_name = "METHOD", default_value_t = MeshOptions::default().geodesic)]
    pub(crate) geodesic: Method,
    /// Where interior seeds come to lie: sizing (at circumcentres), farthest (from all seeds, on a canvas) or protected
    /// (sizing, and power-protected)
    #[arg(long, value_name = "HOW", default_value_t = MeshOptions::default().seeding)]
    pub(crate) seeding: Seeding,
    /// With --seeding protected: the protection asked for, as a share of the greatest circumradius
    #[arg(long, value_name = "SHARE", value_parser = not_negative, allow_negative_numbers = true, default_value_t = MeshOptions::default().protection)]
    pub(crate) protection: f64,
    /// With --seeding protected: where a seed may be picked around a circumcentre, as a share of the circumradius
    #[arg(long, value_name = "SHARE", value_parser = not_negative, allow_negative_numbers = true, default_value_t = MeshOptions::default().picking_radius)]
    pub(crate) picking_radius: f64,
    /// Measure the net of the vertices: epsilon, mu, lambda, power protection (in the report)
    #[arg(long)]
    pub(crate) net: bool,
    /// What distances travel on, where a canvas is used: intrinsic, isotropic or starset (see `dual`)
    #[arg(long, value_name = "WHICH", default_value_t = MeshOptions::default().canvas)]
    pub(crate) canvas: canvas::Kind,
    /// Canvas vertices per seed, where a canvas is used
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..), default_value_t = MeshOptions::default().canvas_size)]
    pub(crate) canvas_size: u32,
    #[command(flatten)]
    pub(crate) memory: Memory,
    #[command(flatten)]
    pub(crate) outputs: Outputs,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

impl MeshArgs {
    pub(crate) fn features(&self) -> FeatureOptions {
        FeatureOptions { ar: (!self.nr).then_some(self.ar) }
    }

    pub(crate) fn options(&self) -> MeshOptions {
        MeshOptions {
            vertices: self.vertices.map(|vertices| vertices as usize),
            complexity: self.complexity,
            hausd: self.hausd,
            fit: self.fit,
            stiffness: MeshOptions::default().stiffness,
            mesher: self.mesher,
            lloyd: self.lloyd,
            centroid: self.centroid,
            polish: self.polish,
            dual: self.dual,
            geodesic: self.geodesic,
            seeding: self.seeding,
            protection: self.protection,
            picking_radius: self.picking_radius,
            net: self.net || self.outputs.shows(Show::Protection),
            canvas: self.canvas,
            canvas_size: self.canvas_size,
            memory_limit: self.memory.bytes(),
        }
    }

    /// All options, as used.
    pub(super) fn as_used(&self) -> Value {
        let bounds = self.metric_choices.bounds();
        let mut options = json!(self.options());
        let more = json!({
            "domain": self.domain, "metric": self.metric, "out": self.out, "background": self.metric_choices.background,
            "smooth_metric": self.metric_choices.smooth_metric, "tensor_order": self.metric_choices.tensor_order, "gradation": self.metric_choices.gradation,
            "norm": self.metric_choices.norm.to_string(), "recovery": self.metric_choices.recovery,
            "ar": self.features().ar, "h_min": bounds.h_min, "h_max": bounds.h_max, "a_max": bounds.a_max,
            "picture": self.outputs.picture, "pixels": self.outputs.pixels, "histograms": self.outputs.histograms, "report": self.run.report, "threads": self.run.threads,
            "repair": self.damage.repair,
        });
        if let (Value::Object(options), Value::Object(more)) = (&mut options, more) {
            options.extend(more);
        }
        options
    }
}
