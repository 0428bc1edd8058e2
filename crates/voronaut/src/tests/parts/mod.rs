//! Parts as a modeller would export them, exact by construction, with the features that they are known to have. The
//! example `parts` writes them, `tests/features` meshes them.
//!
//! | part | what it is | what its file tells of features |
//! |---|---|---|
//! | `cube` | the unit cube | labels of sides |
//! | `cube_plain` | the same | nothing: angles must do |
//! | `bracket` | two fillets, two through holes, a boss and a pipe that leaves it: circles, a quartic curve in space | everything |
//! | `bracket_cad` | the same in long thin triangles, as exporters of .stl make them | labels of faces |
//! | `patch` | a curved sheet over an L with a hole | labels of border edges, corners |
//! | `two` | a sphere of two materials, which meet in a wave | labels of materials |
//! | `blade` | a wedge of ten degrees with a thin rim, bent | labels of faces |

mod bracket;
pub(crate) mod chains;
mod patches;
mod shapes;

use chains::Features;
use std::sync::OnceLock;
use voronaut::mesh::Mesh;

/// A surface and the features that it is known to have, whether its file tells of them or not.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) name: &'static str,
    /// As it is written.
    pub(crate) mesh: Mesh,
    /// Chains of edges of `mesh`, and corners.
    pub(crate) features: Features,
    /// The greatest curvature of its faces, in units of 1 / length.
    pub(crate) curvature: f64,
}

impl Part {
    /// All edges between labels and of the border are features; vertices that the mesh lists as corners are corners.
    fn new(name: &'static str, mesh: Mesh, curvature: f64) -> Self {
        let features = Features::of(&mesh);
        Self { name, mesh, features, curvature }
    }

    /// The same surface, whose file lists every feature: edges labelled by the number of their chain, creases of more than
    /// forty-five degrees as ridges, corners.
    pub(crate) fn listed(mut self) -> Self {
        self.features.list(&mut self.mesh);
        self
    }

    /// The same surface with one label for all: features must be found by angle.
    fn plain(mut self, name: &'static str) -> Self {
        self.name = name;
        self.mesh.triangle_labels.fill(1);
        self
    }

    /// Whether triangles tell their face.
    pub(crate) fn is_labelled(&self) -> bool {
        self.mesh.triangle_labels.iter().any(|&label| label != self.mesh.triangle_labels[0])
    }
}

/// Every part of the table above, made once.
pub(crate) fn all() -> Vec<Part> {
    static ALL: OnceLock<Vec<Part>> = OnceLock::new();
    let made = || {
        vec![
            shapes::cube(8),
            shapes::cube(8).plain("cube_plain"),
            Part::new("bracket", bracket::even(), bracket::CURVATURE).listed(),
            Part::new("bracket_cad", bracket::cad(), bracket::CURVATURE),
            shapes::patch(),
            shapes::two(),
            shapes::blade(),
        ]
    };
    ALL.get_or_init(made).clone()
}
