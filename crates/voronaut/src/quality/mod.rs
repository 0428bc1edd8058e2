//! What a mesh is worth: valid or not, good or not in a metric, close or not to its domain.

mod curved;
mod curved_boundary;
mod embedding;
mod faults;
mod geodesics;
mod histogram;
mod interpolation;
mod meetings;
mod planar_quality;
mod fidelity;
mod riemannian;
mod sampled_distance;
mod self_intersections;
mod surface_fidelity;
mod surface_quality;
mod tensors;
#[cfg(test)]
mod test_meshes;
mod unmet;
mod validity;

pub use faults::{Fault, Position};
pub use fidelity::{Farthest, Fidelity, fidelity};
pub use histogram::{Both, Histogram, Histograms};
pub use interpolation::{Exponent, InterpolationError, interpolation_error, interpolation_error_on};
pub use meetings::{Excused, Meetings};
pub use planar_quality::{Angles, EdgeLengths, MetricQuality, Quality, Spot, Worst};
pub use riemannian::{histograms, metric_quality, unmet};
pub(crate) use self_intersections::crossings;
pub use self_intersections::{Crossing, crossing_edges};
pub(crate) use surface_fidelity::distances_around;
pub use surface_fidelity::{Deviation, NormalDeviation, SurfaceFidelity, surface_fidelity};
pub use unmet::{Cause, CauseFigures, Needle, Needles, Unmet, UnmetEdge, UnmetFigures, WorstEdge};
pub(crate) use validity::examined_on;
pub use validity::{Validity, check, validity, validity_on};
