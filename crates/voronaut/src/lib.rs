//! Anisotropic triangle meshes from a Riemannian metric field.
//!
//! A *metric field* gives a symmetric positive definite tensor M at every point of a planar domain. It says how long an
//! edge e is, sqrt(e' M e), and with that how large a triangle should be, which way it should point and how thin it
//! should be: a *unit mesh* has edges of metric length one. This crate makes unit meshes. What it returns is always a
//! valid mesh; what the metric asked for and could not be had is counted, not hidden.
//!
//! # From a polygon to a measured mesh
//!
//! A [`Domain`](manifold::domain::Domain) is a polygon with holes, regions and labels, validated once and for all. It comes from
//! rings, from a shape, or from a graph of points and segments (files are read by the crate `voronaut-io`):
//!
//! ```
//! use voronaut::manifold::domain::{Domain, Polygon, Polygons, Ring, from_polygons};
//! use voronaut::geometry::Point;
//!
//! let ring = |x0, y0, x1, y1, label| Ring {
//!     points: vec![Point::new(x0, y0), Point::new(x1, y0), Point::new(x1, y1), Point::new(x0, y1)],
//!     label,
//! };
//! let rings = vec![ring(0.0, 0.0, 4.0, 2.0, 1), ring(1.0, 0.5, 2.0, 1.5, 2)];
//! let polygons = vec![Polygon { feature: 1, number: 1, region: 1, rings }];
//! let plate_with_a_hole = Domain::new(&from_polygons(&Polygons { polygons })?)?;
//! assert_eq!(plate_with_a_hole.area(), 7.0);
//! assert_eq!(Domain::shape("rect:0,0,4,2")?.area(), 8.0);
//! # Ok::<(), voronaut::Error>(())
//! ```
//!
//! A metric is anything that implements [`MetricField`](metric::MetricField), closures among them. This one asks for
//! edges of length 0.5 along x, and across it 0.05 near the line y = 1, more elsewhere. The whole pipeline is one
//! function, [`recipe::mesh`]; its options have defaults, here all but the number of vertices:
//!
//! ```
//! # use voronaut::manifold::domain::Domain;
//! # let plate = Domain::shape("rect:0,0,4,2")?;
//! use voronaut::geometry::{Point, Tensor};
//! use voronaut::progress::Silent;
//! use voronaut::recipe::{self, MeshOptions};
//!
//! let metric = |p: Point| {
//!     let across = 0.05 + 0.2 * (p.y - 1.0).abs();
//!     Tensor::new(1.0 / (0.5 * 0.5), 0.0, 1.0 / (across * across))
//! };
//! let options = MeshOptions { vertices: Some(400), ..MeshOptions::default() };
//! let meshed = recipe::mesh(&plate, &metric, &options, &Silent)?;
//! assert!(meshed.mesh.points.len().abs_diff(400) <= 4);
//! # Ok::<(), voronaut::Error>(())
//! ```
//!
//! The metric was scaled by one factor, [`Meshed::metric_scale`](recipe::Meshed::metric_scale), to meet that number. In
//! the scaled metric the mesh can be measured (`voronaut-draw` draws it):
//!
//! ```
//! # use voronaut::manifold::domain::Domain;
//! # use voronaut::geometry::{Point, Tensor};
//! # use voronaut::{progress::Silent, recipe::{self, MeshOptions}};
//! # let plate = Domain::shape("rect:0,0,4,2")?;
//! # let metric = |p: Point| {
//! #     let across = 0.05 + 0.2 * (p.y - 1.0).abs();
//! #     Tensor::new(1.0 / (0.5 * 0.5), 0.0, 1.0 / (across * across))
//! # };
//! # let options = MeshOptions { vertices: Some(400), ..MeshOptions::default() };
//! # let meshed = recipe::mesh(&plate, &metric, &options, &Silent)?;
//! use voronaut::metric::Scaled;
//! use voronaut::quality::{metric_quality, validity};
//!
//! let unit = Scaled { field: &metric, factor: meshed.metric_scale };
//! assert!(validity(&meshed.mesh).valid);
//! let figures = metric_quality(&meshed.mesh, &unit)?;
//! assert!(figures.metric_edge_length.unit_fraction > 0.8);
//! # Ok::<(), voronaut::Error>(())
//! ```
//!
//! # Where to look
//!
//! The modules below stand in the order of the flow of data, and each uses only those above it: `ARCHITECTURE.md` in the
//! repository has the map and the invariants, `DESIGN.md` the reasons, `docs/measurements.md` the figures. Errors say what is wrong and
//! where; [`Error::help`] says what to do about it.

// Tests may take any machine's sines.
#![cfg_attr(not(test), warn(clippy::disallowed_methods))]

// In the order of the flow of data; each module uses only those above it (held by tests/architecture).
mod error;
pub mod progress;
mod parallel;
mod lists;
mod elementary;
mod sparse;
pub mod geometry;
pub mod mesh;
pub mod triangulation;
pub mod planar;
pub mod metric;
pub mod manifold;
pub mod transfer;
pub mod geodesic;
mod in_circle;
pub mod canvas;
pub mod diagram;
pub mod rdt;
pub mod dual;
pub mod net;
pub mod certificate;
pub mod sampling;
pub mod optimise;
mod curved;
pub mod quality;
pub mod realisation;
pub mod figures;
pub mod recipe;

// Cases that benchmarks share name the library.
#[cfg(test)]
extern crate self as voronaut;
#[cfg(test)]
mod test_cases;
#[cfg(test)]
mod tests;

pub use error::{Error, Result};

/// The README's examples are tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;

/// Those of the crate's own README, too.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct CrateReadme;

/// And that of the book's first page.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/start.md")]
struct Start;
