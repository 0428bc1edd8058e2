//! Metrics at the vertices of a planar mesh, one tensor each, and what adapters of meshes do with them.
//!
//! Between vertices they are log-Euclidean, as [`Sampled`](super::Sampled) has them. [`Pipeline`] does the operations below in
//! the one order that meets all that was asked for; parameters have the names that `PETSc` and animate give them.
//!
//! | operation | what it is |
//! |---|---|
//! | [`recover_hessian`](super::recover_hessian) | second derivatives of a solution |
//! | `enforce_spd` | their absolute values, with a floor |
//! | [`intersect`], [`average`] | one metric of several |
//! | [`implied`] | the metric in which a mesh is as even as can be |
//! | [`isotropic`] | of sizes |
//! | [`restrict`] | within least and greatest sizes and a greatest anisotropy |
//! | [`grade`] | with sizes that grow slowly |

mod combine;
mod complexity;
mod gradation;
mod implied;
mod pipeline;
mod restrict;
mod solve;
mod spd;
#[cfg(test)]
pub(super) mod test_meshes;

pub use combine::{average, intersect};
pub use complexity::complexity;
pub(crate) use gradation::Gradation;
pub use gradation::grade;
pub use implied::{implied, isotropic};
pub use pipeline::{COMPLEXITY_PER_VERTEX, Combination, Outcome, Pipeline, Source, Touched};
pub use restrict::{Limit, Limits, restrict};
pub(crate) use spd::{absolute, enforce_spd, size};
