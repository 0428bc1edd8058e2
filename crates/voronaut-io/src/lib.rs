//! Files of voronaut: bytes to plain structs and back; domains, surfaces, metrics and reports from and to files.
//!
//! Each format has a module that reads from any [`BufRead`](std::io::BufRead) and writes to any [`Write`](std::io::Write), and knows
//! nothing of files: messages name the line or the byte. [`read`], [`read_domain`] and [`Given`] open files by
//! what users write; [`write_mesh`] and its like leave a file there as a whole or not at all.

mod codec;
mod curved;
mod cutting;
mod document;
mod domain;
mod ears;
mod files;
mod given;
mod losses;
mod metric;
mod report;
mod volumes;
mod whole;
mod write;

pub mod freefem;
pub mod geojson;
pub mod gmsh;
pub mod medit;
pub mod obj;
pub mod off;
pub mod ply;
pub mod points;
pub mod poly;
pub mod sol;
pub mod stl;
pub mod su2;
pub mod vtk;

pub use document::{Document, Field, Fields};
pub(crate) use domain::DOMAINS;
pub(crate) use domain::{as_outline, read_outline};
pub use domain::{read_domain, read_pslg};
pub use files::{Format, ending, in_file, open, read, read_solutions, read_text};
pub use given::{Given, read_surface};
pub use losses::lost_in_outline;
pub use metric::{MetricFiles, MetricSource, metric_origin, read_metric, surface_metric};
pub use report::{ClosedForm, Report, Seconds, Strayed, peak_memory_bytes};
pub use whole::{Scratch, abandon, demand_directory, place, write, write_with};
pub use write::{
    demand_diagram, write_diagram, write_document, write_mesh, write_realisation, write_solution, write_solutions,
};

/// The README's examples are tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
