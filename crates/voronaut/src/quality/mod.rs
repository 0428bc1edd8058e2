//! What a mesh is worth: valid or not, good or not in a metric, close or not to its domain.

mod crossings;
mod edges;
mod embedding;
mod fidelity;
mod geodesics;
mod histogram;
mod metric_quality;
mod segments;
#[cfg(test)]
mod test_meshes;
mod validity;

pub use crossings::{Crossing, crossing_edges, crossings};
pub use fidelity::{Farthest, Fidelity, fidelity};
pub use histogram::{Both, Histogram, Histograms, histograms};
pub use metric_quality::{Angles, EdgeLengths, MetricQuality, Quality, Spot, Worst, metric_quality};
pub use validity::{Fault, Validity, check, validity};

pub(crate) use edges::Edges;
#[cfg(test)]
pub(crate) use test_meshes::{grid, mesh};
