//! What moves and flips of a mesh in the making on a surface change, to come back to.

use super::Kind;
use crate::geodesic::LocalMetric;
use crate::geometry::{Point3, TangentPlane, Tensor3, Vector3};
use crate::manifold::Place;
use crate::parallel::copy_over;
use crate::triangulation::Triangulation;

/// What moves and flips change. Vertex i of the topology is seed i.
#[derive(Default)]
pub(crate) struct State {
    pub(super) topology: Triangulation,
    pub(super) places: Vec<Place>,
    pub(super) planes: Vec<TangentPlane>,
    /// What the triangles at a seed are to face.
    pub(super) facing: Vec<Vector3>,
    pub(super) locals: Vec<LocalMetric>,
    pub(super) measured: Vec<Measured>,
    pub(super) kinds: Vec<Kind>,
}

impl State {
    /// Becomes another one, in the memory that this one has.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.topology.copy_from(&other.topology);
        copy_over(&mut self.places, &other.places);
        copy_over(&mut self.planes, &other.planes);
        copy_over(&mut self.facing, &other.facing);
        copy_over(&mut self.locals, &other.locals);
        copy_over(&mut self.measured, &other.measured);
        copy_over(&mut self.kinds, &other.kinds);
    }
}

/// Where the metric of a seed was measured, and what it is there, not scaled.
#[derive(Clone, Copy, Default)]
pub(super) struct Measured {
    pub(super) at: Point3,
    pub(super) tensor: Tensor3,
}
