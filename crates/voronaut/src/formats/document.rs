//! What a file holds: a mesh, and values on it.

use super::SolutionValues;
use crate::mesh::Mesh;

/// A mesh, and named values on its vertices and triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The mesh.
    pub mesh: Mesh,
    /// The values.
    pub fields: Fields,
}

/// Named values on a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fields {
    /// One entry per vertex each.
    pub vertices: Vec<Field>,
    /// One entry per triangle each.
    pub triangles: Vec<Field>,
}

/// Values with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// What the file calls them.
    pub name: String,
    /// One entry per vertex or triangle.
    pub values: SolutionValues,
}

impl From<Mesh> for Document {
    fn from(mesh: Mesh) -> Self {
        Self { mesh, fields: Fields::default() }
    }
}
