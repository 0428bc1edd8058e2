//! From the dual to the mesh that leaves the program.

use super::{Dual, Kind};
use crate::domain::Domain;
use crate::mesh::Mesh;
use crate::triangulation::VertexId;

impl Dual<'_> {
    /// The mesh, by `Domain::mesh_of`.
    pub(crate) fn to_mesh(&self, domain: &Domain) -> Mesh {
        domain.mesh_of(self.planar(), |v| self.corner(v))
    }

    /// The number in [`Dual::to_mesh`] of each vertex by id; `u32::MAX` of those that are none.
    pub(crate) fn numbering(&self, domain: &Domain) -> Vec<u32> {
        domain.numbering(self.planar(), |v| self.corner(v))
    }

    /// The point of the domain's graph that a vertex is.
    fn corner(&self, v: VertexId) -> Option<u32> {
        if let Kind::Corner(point) = self.kind(v) { Some(point) } else { None }
    }
}
