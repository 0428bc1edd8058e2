//! What users type for more than one command.

mod values;

pub(crate) use values::{
    CanvasSize, Coordinates, EdgesOut, Show, canvas_size, coordinates, finite, not_negative, positive,
};

use clap::{Args, value_parser};
use std::path::PathBuf;
pub(crate) use values::GIB;
use values::{default_memory_limit, pairs, window};
use voronaut::geometry::Aabb;
use voronaut::manifold::surface::{FeatureOptions, RepairOptions};
use voronaut::mesh::TensorOrder;
use voronaut::metric::{Bounds, MOST_SWEEPS, Norm, Recovery};
use voronaut::recipe::MetricOptions;
use voronaut::{Error, Result};
use voronaut_draw::Picture;

#[derive(Clone, Debug, Args)]
pub(crate) struct MetricChoices {
    /// The degree of the polynomials by which functions are interpolated: the order of the triangles.
    #[arg(skip = 1_usize)]
    degree: usize,
    /// Least Euclidean size the metric may ask for
    #[arg(long, value_name = "H", value_parser = positive)]
    h_min: Option<f64>,
    /// Greatest Euclidean size the metric may ask for
    #[arg(long, value_name = "H", value_parser = positive)]
    h_max: Option<f64>,
    /// With hessian metrics: p of the L^p norm in which the error of interpolation is to be least: 1, 2, 4, ... or inf
    #[arg(long, value_name = "P", default_value_t = Norm::default())]
    pub(crate) norm: Norm,
    /// With hessian:FILE.sol: how second derivatives are recovered, by a quadratic around each vertex (fit) or a double projection
    /// (l2)
    #[arg(long, value_name = "HOW", default_value_t = Recovery::default())]
    pub(crate) recovery: Recovery,
    /// Greatest ratio of the two sizes at a point, at least 1
    #[arg(long, value_name = "RATIO", value_parser = positive)]
    a_max: Option<f64>,
    /// Sizes of neighbouring edges differ by about this factor at most, such as 1.3; sampled on a background as
    /// --smooth-metric has it [default: no gradation]
    #[arg(long, value_name = "FACTOR", value_parser = positive)]
    pub(crate) gradation: Option<f64>,
    /// Sweeps of Laplacian smoothing of the metric; K reach over sqrt(K)/400 of the domain's width in the metric (of a .sol
    /// file, over sqrt(K)/2 edges of its mesh), and what changes over less is lost
    #[arg(long, value_name = "K", value_parser = value_parser!(u32).range(..=i64::from(MOST_SWEEPS)), allow_negative_numbers = true, default_value_t = MetricOptions::default().smooth_metric)]
    pub(crate) smooth_metric: u32,
    /// In which order tensors in files have their entries: disk (m11 m12 m22 m13 m23 m33, as .sol files have), upper (m11 m12 m13 m22
    /// m23 m33) or diagonal (m11 m22 m33 m12 m23 m13)
    #[arg(long, value_name = "ORDER", default_value_t = TensorOrder::default())]
    pub(crate) tensor_order: TensorOrder,
    /// The mesh on which a .sol metric is given [default: the domain's own]
    #[arg(long, value_name = "MESH")]
    pub(crate) background: Option<PathBuf>,
}

/// Curves of the boundary that correspond.
#[derive(Debug, Args)]
pub(crate) struct Paired {
    /// In the plane: edges on the boundary curves with labels A and B correspond, which are equal but for a rotation and a
    /// translation; for several pairs several times
    #[arg(long, value_name = "A,B", value_parser = pairs, allow_hyphen_values = true)]
    periodic: Vec<Vec<[i32; 2]>>,
}

impl Paired {
    /// The pairs of labels.
    pub(crate) fn pairs(&self) -> Vec<[i32; 2]> {
        self.periodic.concat()
    }
}

#[derive(Debug, Args)]
pub(crate) struct Damage {
    /// Mend what is else refused with its place. Surfaces: T-junctions, edges of three triangles, sheets that meet in a point; and small
    /// holes are closed. (Duplicates and triangles without area go, and seams are welded, anyway.) Outlines: points nearer than 1e-9 of
    /// the diagonal are joined, lines cut where they cross, and where polygons overlap the first has the say
    #[arg(long)]
    pub(crate) repair: bool,
}

impl Damage {
    /// What may be done to what files hold.
    pub(crate) fn options(&self) -> RepairOptions {
        RepairOptions { repair: self.repair }
    }
}

/// Where surfaces are creased.
#[derive(Debug, Args)]
pub(crate) struct Creases {
    /// Edges of a surface where its normal turns by more than this angle are creases: they are kept, as borders, listed edges and
    /// edges between labels are, and with them the corners where such curves turn by as much. Metrics know nothing of what is beyond
    #[arg(long, value_name = "DEGREES", value_parser = positive, default_value_t = FeatureOptions::DEFAULT_ANGLE)]
    ar: f64,
    /// Look for no creases and corners by angles
    #[arg(long, conflicts_with = "ar")]
    nr: bool,
}

impl Creases {
    /// What counts as a feature.
    pub(crate) fn options(&self) -> FeatureOptions {
        FeatureOptions { ar: (!self.nr).then_some(self.ar) }
    }

    /// Refuses creases in the plane.
    pub(crate) fn demand_unset(&self) -> Result<()> {
        let is_other = !self.nr && self.options() != FeatureOptions::default();
        refuse([
            (self.nr, "--nr in the plane", "leave out --nr: it is for surfaces"),
            (is_other, "--ar in the plane", "leave out --ar: it is for surfaces"),
        ])
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
}

/// A page of a mesh that is made.
#[derive(Debug, Args)]
pub(crate) struct Paged {
    /// Write a page to look at the mesh with, in any browser (see `view`): .html
    #[arg(long, value_name = "FILE")]
    pub(crate) view: Option<PathBuf>,
    /// With --view: show Voronoi cells, distances in them, and geodesic edges, too
    #[arg(long, requires = "view")]
    pub(crate) cells: bool,
}

impl Outputs {
    pub(crate) fn shows(&self, what: Show) -> bool {
        self.show.contains(&what)
    }

    /// Whether the picture, if there is one, needs a diagram.
    pub(crate) fn need_diagram(&self) -> bool {
        self.show.iter().any(|show| show.is_of_diagram())
    }

    /// Whether the picture, if there is one, shows a mesh with geodesic edges.
    pub(crate) fn have_geodesics(&self) -> bool {
        self.shows(Show::Geodesics) || self.shows(Show::Triangles)
    }
}

/// What a run may take.
#[derive(Clone, Copy, Debug, Args)]
pub(crate) struct Limits {
    /// Stop, without an output, after so many seconds
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    pub(crate) time_limit: Option<f64>,
    /// Refuse work that is estimated to need more memory than this, and stop, without an output, where it takes more all the same
    #[arg(long, value_name = "GIB", value_parser = positive, default_value_t = default_memory_limit())]
    pub(crate) memory_limit: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { time_limit: None, memory_limit: default_memory_limit() }
    }
}

impl Limits {
    /// Bytes.
    pub(crate) fn memory(&self) -> u64 {
        (self.memory_limit * GIB) as u64
    }
}

/// More threads than machines have cores only take turns; 65,535 were not started within a minute.
const MOST_THREADS: i64 = 1024;

#[derive(Clone, Debug, Default, Args)]
pub(crate) struct Run {
    /// Write all figures as JSON
    #[arg(long, value_name = "FILE")]
    pub(crate) report: Option<PathBuf>,
    /// Threads to use [default: all]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=MOST_THREADS))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) limits: Limits,
    /// Say nothing but errors
    #[arg(short, long, conflicts_with = "verbose")]
    pub(crate) quiet: bool,
    /// Say more: stages, counters
    #[arg(short, long)]
    pub(crate) verbose: bool,
}

impl Run {
    /// Uses so many threads from now on. The one that asks is one of them: else another has to be woken for every loop, and that took a tenth of the time
    /// of small meshes.
    pub(crate) fn set_threads(&self) -> Result<()> {
        let threads = self.threads.map_or(0, usize::from);
        let built = rayon::ThreadPoolBuilder::new().num_threads(threads).use_current_thread().build_global();
        match built {
            Err(error) if threads > 0 => {
                Err(Error::limit(format!("{threads} threads: {error}"), "ask for fewer threads"))
            }
            _ => Ok(()),
        }
    }

    /// Writes the report, if asked for.
    pub(crate) fn write_report(&self, text: &str) -> Result<()> {
        self.report.as_deref().map_or(Ok(()), |path| voronaut_io::write(path, text.as_bytes()))
    }
}

/// Refuses what is not there: the first of these, of which each has whether it is asked for, what it is, and what to do.
pub(crate) fn refuse<W: Into<String>, H: Into<String>>(all: impl IntoIterator<Item = (bool, W, H)>) -> Result<()> {
    match all.into_iter().find(|(is_asked, ..)| *is_asked) {
        Some((_, what, help)) => Err(Error::unsupported(what, help)),
        None => Ok(()),
    }
}

impl MetricChoices {
    pub(crate) fn bounds(&self) -> Bounds {
        Bounds { h_min: self.h_min, h_max: self.h_max, a_max: self.a_max }
    }

    /// The same for triangles of an order.
    pub(crate) fn of_degree(&self, degree: usize) -> Self {
        Self { degree, ..self.clone() }
    }

    /// What is asked of a metric in the plane.
    pub(crate) fn options(&self) -> MetricOptions {
        MetricOptions {
            bounds: self.bounds(),
            norm: self.norm,
            degree: self.degree,
            recovery: self.recovery,
            smooth_metric: self.smooth_metric,
            gradation: self.gradation,
        }
    }
}
