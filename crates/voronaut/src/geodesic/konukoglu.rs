//! Recursive anisotropic fast marching: fronts cross the faces at a vertex, and what they get wrong is corrected.

use super::Graph;
use super::label::{Label, Support};
use super::sweep::{Step, beyond};
use super::update::plane_crossing_by_lengths;
use crate::triangulation::VertexId;

/// A settled vertex is settled once more where its distance falls by more than this share of it.
const CORRECTION: f64 = 1e-6;

/// Recursive anisotropic fast marching (Konukoglu 2007).
///
/// A front reaches a vertex from two neighbours that are neighbours themselves, by a plane wave in the metric that gives the
/// three edges their lengths. Where the metric is anisotropic a front may have to reach a vertex before those its distance depends on, so
/// settled vertices are corrected, with all that follow from them, until none improves by more than 1e-6 of its distance.
/// The result is that of the Hopf-Lax scheme, of first order; the number of corrections grows with the anisotropy that the
/// graph does not follow. Three mutual neighbours count as a face, so that a hole of three canvas edges does not bar the way.
///
/// Labels are mended by making them anew.
#[derive(Clone, Debug)]
pub(crate) struct Konukoglu(pub Graph);

impl Step for Konukoglu {
    fn graph(&self) -> &Graph {
        &self.0
    }

    fn correction(&self) -> Option<f64> {
        Some(CORRECTION)
    }

    fn carry(&self, labels: &[Label], from: VertexId, x: VertexId) -> Label {
        let graph = &self.0;
        let label = labels[from.index()];
        let mut best = (beyond(label.distance + graph.length(from, x), label.distance), from);
        let to_from = graph.length(x, from);
        for k in common(graph.neighbours(from), graph.neighbours(x)) {
            let other = labels[k.index()];
            if other.colour != label.colour {
                continue;
            }
            let sides = [to_from, graph.length(x, k)];
            let found = plane_crossing_by_lengths(sides, graph.length(from, k), [label.distance, other.distance]);
            let nearer = if other.is_before(&label) { k } else { from };
            if let Some(distance) = found.map(|d| beyond(d, labels[nearer.index()].distance)).filter(|&d| d < best.0) {
                best = (distance, nearer);
            }
        }
        Label::new(best.0, label.colour, Support::Neighbour(best.1))
    }
}

/// What two lists in order have in common.
fn common<'a>(one: &'a [VertexId], other: &'a [VertexId]) -> impl Iterator<Item = VertexId> + 'a {
    one.iter().copied().filter(|v| other.binary_search(v).is_ok())
}
