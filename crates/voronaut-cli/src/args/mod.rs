//! What users type.

mod values;

pub(crate) use values::{
    CanvasSize, Coordinates, EdgesOut, Show, default_memory_limit, in_bytes, not_negative, positive,
};

use crate::adapt::{self, LoopArgs};
use crate::convert::{self, ConvertArgs};
use crate::interpolate::{self, InterpolateArgs};
use crate::nodal::{self, MetricArgs};
use crate::remesh::{self, RemeshArgs};
use clap::{Args, Parser, Subcommand, value_parser};
use std::path::PathBuf;
use values::{canvas_size, coordinates, window};
use voronaut::canvas;
use voronaut::certificate::Constants;
use voronaut::diagram;
use voronaut::dual::Road;
use voronaut::formats::TensorOrder;
use voronaut::geodesic::Method;
use voronaut::geometry::Aabb;
use voronaut::metric::{Bounds, MOST_SWEEPS, Norm, Recovery};
use voronaut::output::Picture;
use voronaut::recipe::{Centroid, MeshOptions, Mesher, MetricOptions, SMOOTH_METRIC, Seeding};
use voronaut::surface::FeatureOptions;
use voronaut::surface::RepairOptions;

/// Anisotropic triangle meshes from a Riemannian metric field.
#[derive(Debug, Parser)]
#[command(version, propagate_version = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Mesh a domain: valid, with edges of length one in a metric
    #[command(after_help = MESH_EXAMPLES)]
    Mesh(MeshArgs),
    /// Voronoi diagram and dual of the seeds given: none is added or moved
    #[command(after_help = DUAL_EXAMPLES)]
    Dual(DualArgs),
    /// Distances in a metric from given points to everywhere, and the shortest path to one
    #[command(after_help = DISTANCE_EXAMPLES)]
    Distance(DistanceArgs),
    /// Mesh a surface anew, with the options of mmgs
    #[command(after_help = remesh::EXAMPLES)]
    Remesh(RemeshArgs),
    /// Carry a solution from one planar mesh to another
    #[command(after_help = interpolate::EXAMPLES)]
    Interpolate(InterpolateArgs),
    /// Make a metric at the vertices of a mesh: from solutions, combined, limited, graded, of a complexity
    #[command(after_help = nodal::EXAMPLES)]
    Metric(MetricArgs),
    /// Adapt the mesh of a planar domain to a formula or a solver, again and again
    #[command(after_help = adapt::EXAMPLES)]
    Loop(Box<LoopArgs>),
    /// Read a file in one format and write it in another
    #[command(after_help = convert::EXAMPLES, visible_alias = "translate")]
    Convert(ConvertArgs),
    /// Examine a mesh: validity, quality in a metric, distance to its domain
    #[command(after_help = CHECK_EXAMPLES)]
    Check(CheckArgs),
}

const MESH_EXAMPLES: &str = "\
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

const DUAL_EXAMPLES: &str = "\
Line i of FILE, `x y` (of a surface `x y z`, on it or near), is seed and vertex i. DOMAIN and METRIC are as for `mesh`; the metric is used as it is.

With --edges geodesic OUT holds the seeds first, then the points of the geodesics; edges are their segments (in a .vtu one
polyline cell for each), labelled with the number of the edge, and triangles cut up the region of each Riemannian triangle,
labelled with its number, both from 1. Lengths are in the report and in the .vtu.

Examples:
  voronaut dual rect:-2,-2,2,2 --metric swirl --seeds seeds.txt -o dual.mesh
  voronaut dual rect:-2,-2,2,2 --metric swirl --seeds seeds.txt -o rdt.vtu --edges geodesic --picture rdt.png --show geodesics
  voronaut dual sea.geojson --metric boundary:h0=2 --seeds ports.txt -o dual.vtu --diagram cells.vtu --report run.json";

const DISTANCE_EXAMPLES: &str = "\
DOMAIN and METRIC are as for `mesh`, or a surface and a metric on it as for `check`; the metric is used as it is. Points near a
surface are moved onto it. METHOD: march (fast marching by lengths, the most accurate),
stvd[:window=8] (Campen 2013), dijkstra, konukoglu (recursive fast marching, 2007), lbr (FM-LBR on a grid of the plane, Mirebeau
2014), heat (Crane 2013).
OUT has the canvas with point data `distance`; the path's points come behind the canvas's, its segments are line cells.

Examples:
  voronaut distance rect:-2,-2,2,2 --metric swirl --from 1,0.5 -o distance.vtu --picture distance.png
  voronaut distance sea.geojson --metric boundary:h0=2 --from 10,20 --from 300,-40 --to 90,80 -o way.vtu --report way.json
  voronaut distance torus:2,0.7 --metric curvature --from 2.7,0,0 --to -1.3,0,0 -o torus.vtu --picture torus.png";

const CHECK_EXAMPLES: &str = "\
Exits with 1 if the mesh is not valid; the report is written all the same.

The mesh of a surface (some z is not 0) is held against a surface as DOMAIN: sphere:r, torus:R,r, chair,
implicit:EXPR;x0,y0,z0,x1,y1,z1, or a file .mesh, .meshb, .msh, .vtu, .vtp, .obj, .off, .ply or .stl. METRIC is then uniform, curvature[:floor=C],
shock[:phi=10,lambda=0.6], 'formula:m11; m12; m22; m13; m23; m33' in x, y, z, or a file .sol of the domain's file.

Examples:
  voronaut check plate.mesh
  voronaut check cow.ply --domain spot.obj --metric curvature --metric-scale 310 --report check.json
  voronaut check swirl.mesh --metric swirl --metric-scale 1873.2 --report check.json
  voronaut check adapted.mesh --metric wing.sol --background wing.mesh --domain wing.mesh";

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
    /// Refuse work that is estimated to need more memory than this
    #[arg(long, value_name = "GIB", value_parser = positive, default_value_t = default_memory_limit())]
    pub(crate) memory_limit: f64,
    #[command(flatten)]
    pub(crate) outputs: Outputs,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

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
    /// Canvas vertices per seed, 150,000 in all at least, for up to 300 seeds; or certified: as many as the theorems ask for
    #[arg(long, value_name = "N", value_parser = canvas_size, default_value_t = CanvasSize::default())]
    pub(crate) canvas_size: CanvasSize,
    /// Say which of the report's theorems hold of these seeds and this canvas, by how much others miss, and what it would take
    #[arg(long)]
    pub(crate) certify: bool,
    /// The formulas of these theorems: corrected, or printed (with the report's errors, to compare)
    #[arg(long, value_name = "WHICH", default_value_t = Constants::default())]
    pub(crate) constants: Constants,
    /// Refuse work that is estimated to need more memory than this
    #[arg(long, value_name = "GIB", value_parser = positive, default_value_t = default_memory_limit())]
    memory_limit: f64,
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
    /// Refuse work that is estimated to need more memory than this
    #[arg(long, value_name = "GIB", value_parser = positive, default_value_t = default_memory_limit())]
    memory_limit: f64,
    /// Draw the distances, lines of equal distance and the path: .svg or .png
    #[arg(long, value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
    /// Pixels of the picture's longer side
    #[arg(long, value_name = "PIXELS", default_value_t = Picture::default().width, value_parser = value_parser!(u32).range(16..=16_000), requires = "picture")]
    pub(crate) pixels: u32,
    /// Write all figures as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

/// Vertices of the canvas of `distance`: marching errs by about a thousandth then, in half a second.
const CANVAS_VERTICES: u32 = 40_000;

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// The mesh: .mesh, .meshb, .msh, .vtu, .vtp, .obj, .off, .ply or .stl
    pub(crate) mesh: PathBuf,
    /// Measure lengths, shapes and angles in this metric (as for `mesh`)
    #[arg(long)]
    pub(crate) metric: Option<String>,
    /// A factor on the metric tensor, such as `metric_scale` of a report
    #[arg(long, value_name = "FACTOR", value_parser = positive, requires = "metric")]
    pub(crate) metric_scale: Option<f64>,
    /// In the plane: measure the error of linear interpolation of this function of x and y, in the L^p norm of --norm
    #[arg(long, value_name = "EXPR")]
    pub(crate) function: Option<String>,
    /// Measure the distance to the boundary of this domain (as for `mesh`), or to this surface [default of a metric on a surface:
    /// the mesh itself]
    #[arg(long)]
    pub(crate) domain: Option<String>,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    #[command(flatten)]
    pub(crate) outputs: Outputs,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

#[derive(Debug, Args)]
pub(crate) struct MetricChoices {
    /// Least Euclidean size the metric may ask for
    #[arg(long, value_name = "H", value_parser = positive)]
    h_min: Option<f64>,
    /// Greatest Euclidean size the metric may ask for
    #[arg(long, value_name = "H", value_parser = positive)]
    h_max: Option<f64>,
    /// With hessian metrics: p of the L^p norm in which the error of linear interpolation is to be least: 1, 2, 4, ... or inf
    #[arg(long, value_name = "P", default_value_t = Norm::default())]
    pub(crate) norm: Norm,
    /// With hessian:FILE.sol: how second derivatives are recovered, by a quadratic around each vertex (fit) or a double projection
    /// (l2)
    #[arg(long, value_name = "HOW", default_value_t = Recovery::default())]
    pub(crate) recovery: Recovery,
    /// Greatest ratio of the two sizes at a point, at least 1
    #[arg(long, value_name = "RATIO", value_parser = positive)]
    a_max: Option<f64>,
    /// Sizes of neighbouring edges differ by about this factor at most, such as 1.3; in the plane, sampled on a background as
    /// --smooth-metric has it [default: no gradation]
    #[arg(long, value_name = "FACTOR", value_parser = positive)]
    pub(crate) gradation: Option<f64>,
    /// Sweeps of Laplacian smoothing of the metric; K reach over sqrt(K)/400 of the domain's width in the metric (of a .sol
    /// file, over sqrt(K)/2 edges of its mesh), and what changes over less is lost
    #[arg(long, value_name = "K", value_parser = value_parser!(u32).range(..=i64::from(MOST_SWEEPS)), allow_negative_numbers = true, default_value_t = SMOOTH_METRIC)]
    pub(crate) smooth_metric: u32,
    /// In which order tensors in files have their entries: disk (m11 m12 m22 m13 m23 m33, as .sol files have), upper (m11 m12 m13 m22
    /// m23 m33) or diagonal (m11 m22 m33 m12 m23 m13)
    #[arg(long, value_name = "ORDER", default_value_t = TensorOrder::default())]
    pub(crate) tensor_order: TensorOrder,
    /// The mesh on which a .sol metric is given [default: the domain's own]
    #[arg(long, value_name = "MESH")]
    pub(crate) background: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Damage {
    /// Surfaces in files: mend what is else refused with its place: T-junctions, edges of three triangles, sheets that meet in a
    /// point; and close small holes. Duplicates and triangles without area go, and seams are welded, anyway
    #[arg(long)]
    pub(crate) repair: bool,
}

impl Damage {
    /// What may be done to the meshes of surfaces.
    pub(crate) fn options(&self) -> RepairOptions {
        RepairOptions { repair: self.repair }
    }
}

#[derive(Debug, Args)]
pub(crate) struct Outputs {
    /// Draw a picture: .svg or .png
    #[arg(long, value_name = "FILE")]
    pub(crate) picture: Option<PathBuf>,
    /// What the picture shows
    #[arg(long, value_delimiter = ',', default_value = "mesh", requires = "picture")]
    pub(crate) show: Vec<Show>,
    /// Pixels of the picture's longer side
    #[arg(long, value_name = "PIXELS", default_value_t = Picture::default().width, value_parser = value_parser!(u32).range(16..=16_000), requires = "picture")]
    pub(crate) pixels: u32,
    /// What the picture is cut to: x0,y0,x1,y1 [default: everything]
    #[arg(long, value_name = "BOX", value_parser = window, allow_hyphen_values = true, requires = "picture")]
    pub(crate) window: Option<Aabb>,
    /// Draw how metric edge lengths and angles are distributed, with straight and with geodesic edges: .svg
    #[arg(long, value_name = "FILE", requires = "metric")]
    pub(crate) histograms: Option<PathBuf>,
    /// Write all figures as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct Run {
    /// Threads to use [default: all]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,
    /// Say nothing but errors
    #[arg(short, long, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say more: stages, counters
    #[arg(short, long)]
    pub(crate) verbose: bool,
}

impl MetricChoices {
    pub(crate) fn bounds(&self) -> Bounds {
        Bounds { h_min: self.h_min, h_max: self.h_max, a_max: self.a_max }
    }

    /// What is asked of a metric in the plane.
    pub(crate) fn options(&self) -> MetricOptions {
        MetricOptions {
            bounds: self.bounds(),
            norm: self.norm,
            recovery: self.recovery,
            smooth_metric: self.smooth_metric,
            tensor_order: self.tensor_order,
            gradation: self.gradation,
            background: self.background.clone(),
        }
    }
}

impl DualArgs {
    /// In bytes.
    pub(crate) fn memory_limit(&self) -> u64 {
        in_bytes(self.memory_limit)
    }
}

impl DistanceArgs {
    /// In bytes.
    pub(crate) fn memory_limit(&self) -> u64 {
        in_bytes(self.memory_limit)
    }
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
            net: self.net || self.outputs.show.contains(&Show::Protection),
            canvas: self.canvas,
            canvas_size: self.canvas_size,
            memory_limit: in_bytes(self.memory_limit),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn definitions_are_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn defaults_are_the_library_s() {
        let words = ["voronaut", "mesh", "rect:0,0,1,1", "--metric", "uniform", "-o", "a.mesh"];
        let Command::Mesh(args) = Arguments::try_parse_from(words).unwrap().command else { unreachable!() };
        let (ours, theirs) = (args.options(), MeshOptions::default());
        assert_eq!(format!("{ours:?}"), format!("{theirs:?}"));
    }

    #[test]
    fn nonsense_is_wrong_usage() {
        let base = ["voronaut", "mesh", "rect:0,0,1,1", "--metric", "uniform", "-o", "a.mesh"];
        for more in [
            &["-n", "2"][..],
            &["-n", "100", "--complexity", "3"],
            &["--h-min", "nan"],
            &["--hausd", "-1"],
            &["--threads", "0"],
            &["--seeding", "nearest"],
            &["--protection", "-0.1"],
            &["--picking-radius", "nan"],
            &["--canvas", "grid"],
            &["--mesher", "grid"],
            &["--canvas-size", "0"],
            &["--smooth-metric", "-1"],
            &["--smooth-metric", "10001"],
            &["--smooth-metric", "1.5"],
            &["--show", "mesh"],
            &["--pixels", "800"],
            &["--window", "0,0,1,1"],
            &["--window", "0,0,1", "--picture", "a.svg"],
            &["--window", "0,0,1,nan", "--picture", "a.svg"],
            &["--window", "0,1,1,1", "--picture", "a.svg"],
            &["--pixels", "8", "--picture", "a.svg"],
            &["--show", "stars", "--picture", "a.svg"],
            &["-q", "-v"],
        ] {
            let error = Arguments::try_parse_from(base.iter().chain(more)).unwrap_err();
            assert_eq!(error.exit_code(), 2, "{more:?}");
        }
    }
}
