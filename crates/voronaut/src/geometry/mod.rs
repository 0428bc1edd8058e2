//! Points, tensors and exact predicates: the vocabulary of everything below.

mod candidates;
mod contact;
mod intersection;
mod jet;
mod joint;
mod linear;
mod motion;
mod point;
mod predicates;
mod quadrature;
mod tensor;
mod tensor3;
mod tree;

pub(crate) use candidates::Candidates;
pub(crate) use contact::{Corners, contacts, is_flat};
pub use jet::{Jet, Jet3};
pub(crate) use motion::Motion;
pub use point::{Aabb, Aabb3, Point, Point3, Vector, Vector3};
pub(crate) use point::{Readable, kept_within};
pub use predicates::{Orientation, orientation, signed_area};
pub(crate) use predicates::{centroid, holds, in_circle, segment_intersection, signed_volume};
pub(crate) use quadrature::{Node, combine, radon, radon_on_parts};
pub use tensor::{Eigen, Tensor};
pub(crate) use tensor::{from_frame, to_frame};
pub(crate) use tensor3::{Eigen3, Seen};
pub use tensor3::{TangentPlane, Tensor3};
pub(crate) use tree::{Bounds, BoxTree, around, meeting_pairs, widened};

/// Triangles of less quality than this, of 1, are needles: their height is less than about a fortieth of their longest side.
pub(crate) const NEEDLE: f64 = 0.05;
