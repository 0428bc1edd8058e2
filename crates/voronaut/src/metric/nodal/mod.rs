//! Metrics at the vertices of a mesh, one tensor each, and what adapters of meshes do with them.
//!
//! On a surface tensors are those of tangent planes ([`crate::recipe::metric_at_vertices`]). Between vertices they are log-Euclidean, as
//! [`Sampled`](super::Sampled) has them. [`Pipeline`] does the operations below in
//! the one order that meets all that was asked for; parameters have the names that `PETSc` and animate give them.
//!
//! | operation | what it is |
//! |---|---|
//! | [`recover_hessian`](super::recover_hessian) | second derivatives of a solution |
//! | `weighted` | the metric for interpolation that they make |
//! | [`intersect`], [`average`] | one metric of several |
//! | [`implied`] | the metric in which a mesh is as even as can be |
//! | [`isotropic`] | of sizes |
//! | `restrict` | within least and greatest sizes and a greatest anisotropy |
//! | [`grade`] | with sizes that grow slowly |

mod combine;
mod complexity;
mod gradation;
mod implied;
mod pipeline;
mod restrict;
mod solve;
mod vertices;
mod weighted;
#[cfg(test)]
pub(crate) mod test_meshes;

pub use combine::{average, intersect};
pub(crate) use complexity::complexity;
pub(super) use complexity::of_triangle;
pub(crate) use gradation::Gradation;
pub use gradation::grade;
pub(crate) use implied::implied_by;
pub use implied::{implied, isotropic};
pub use pipeline::{COMPLEXITY_PER_VERTEX, Combination, Outcome, Pipeline, Source, Touched};
pub use restrict::{Limit, Limits};
pub(crate) use vertices::Vertices;
pub(crate) use weighted::{size, weighted};
