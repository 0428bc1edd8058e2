//! What users of `voronaut metric` type.

use crate::options::{Run, positive};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use std::str::FromStr;
use voronaut::mesh::TensorOrder;
use voronaut::metric::{Norm, Recovery};

pub(crate) const EXAMPLES: &str = "\
METRIC  as for `mesh` (uniform, shock, swirl, boundary:h0=, 'formula:m11; m12; m22', FILE.sol with tensors or sizes), or
        hessian:FILE.sol    second derivatives of a solution on MESH, recovered
        'hessian:EXPR'      those of an expression in x and y, exact; with --recovery, recovered from its values
        implied             the metric in which MESH is as even as can be

What is done, in this order: absolute values of Hessians and their weights for the norm; one complexity for all metrics, if one is
asked for; combination; limits on sizes, then on the anisotropy; gradation; and last the factor that makes the complexity of what
comes out the one asked for.

A unit mesh has about 1.15 vertices for each unit of complexity.

Examples:
  voronaut metric wing.mesh --metric hessian:mach.sol --complexity 5000 --h-min 1e-5 --gradation 1.5 -o wing.sol
  voronaut metric wing.mesh --metric hessian:mach.sol --metric hessian:density.sol --norm 4 --complexity 5000 -o wing.sol
  voronaut metric plate.mesh --metric 'hessian:tanh(40*(y - x))' --complexity 2000 -o plate.sol --report plate.json
  voronaut metric plate.mesh --metric implied --metric sizes.sol --combine average --weights 1,3 -o plate.sol
  voronaut mesh wing.mesh --metric wing.sol -o adapted.mesh";

#[derive(Debug, Args)]
pub(crate) struct MetricArgs {
    /// The planar mesh at whose vertices the metric is made: .mesh, .meshb, .msh, .vtu, .vtp, .obj, .off, .ply or .stl
    pub(crate) mesh: PathBuf,
    /// Where the metric comes from (see below); may be given more than once
    #[arg(long, value_name = "METRIC", required = true)]
    pub(crate) metric: Vec<String>,
    /// The metric, one tensor m11 m12 m22 per vertex: .sol
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// What several metrics become: one as fine as each, or their log-Euclidean mean
    #[arg(long, value_enum, value_name = "HOW", default_value_t = Combine::Intersect)]
    pub(crate) combine: Combine,
    /// With --combine average: a weight for each metric [default: all the same]
    #[arg(long, value_name = "W,W", value_delimiter = ',')]
    pub(crate) weights: Vec<f64>,
    /// The L^p norm in which the interpolation error of Hessians' functions is to be least: 1, 2, 4, inf
    #[arg(long, value_name = "P", default_value_t = Norm::default())]
    pub(crate) norm: Norm,
    /// Integral of sqrt(det M) over the mesh [default: metrics are not scaled]
    #[arg(long, value_name = "C", value_parser = positive)]
    pub(crate) complexity: Option<f64>,
    /// Least Euclidean size: a number, or one for each vertex
    #[arg(long, value_name = "H|FILE.sol")]
    pub(crate) h_min: Option<LimitText>,
    /// Greatest Euclidean size
    #[arg(long, value_name = "H|FILE.sol")]
    pub(crate) h_max: Option<LimitText>,
    /// Greatest ratio of the two sizes at a point, at least 1
    #[arg(long, value_name = "RATIO|FILE.sol")]
    pub(crate) a_max: Option<LimitText>,
    /// Sizes of neighbouring edges differ by about this factor at most, such as 1.3 [default: no gradation]
    #[arg(long, value_name = "FACTOR", value_parser = positive)]
    pub(crate) gradation: Option<f64>,
    /// How second derivatives are recovered from values: fit (a quadratic around each vertex) or l2 (a double projection)
    #[arg(long, value_name = "HOW")]
    pub(crate) recovery: Option<Recovery>,
    /// In which order tensors in files have their entries: disk (m11 m12 m22, as .sol files have) or diagonal (m11 m22 m12)
    #[arg(long, value_name = "ORDER", default_value_t = TensorOrder::default())]
    pub(crate) tensor_order: TensorOrder,
    /// The mesh on which a .sol metric is given, if that is not MESH
    #[arg(long, value_name = "MESH")]
    pub(crate) background: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) run: Run,
}

/// How metrics are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Combine {
    /// As fine as each
    Intersect,
    /// The log-Euclidean mean
    Average,
}

/// A limit as it is typed.
#[derive(Clone, Debug)]
pub(crate) enum LimitText {
    /// The same everywhere.
    Number(f64),
    /// In a file.
    File(PathBuf),
}

impl FromStr for LimitText {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text.to_ascii_lowercase().ends_with(".sol") {
            return Ok(LimitText::File(text.into()));
        }
        positive(text).map(LimitText::Number).map_err(|_| "neither a positive number nor a file .sol".into())
    }
}

impl LimitText {
    /// As reports have it.
    pub(crate) fn as_used(&self) -> serde_json::Value {
        match self {
            LimitText::Number(value) => (*value).into(),
            LimitText::File(path) => path.display().to_string().into(),
        }
    }
}
