//! Points, tensors and exact predicates: the vocabulary of everything below.

mod point;
mod predicates;
mod tensor;

pub use point::{Aabb, Point, Readable, Vector};
pub use predicates::{Orientation, in_circle, orientation, segment_intersection, signed_area};
pub use tensor::{Eigen, Tensor};
