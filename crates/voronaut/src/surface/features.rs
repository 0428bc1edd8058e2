//! Which edges of a surface are features: what a mesh of it has to keep.

use super::Surface;
use crate::triangulation::{Constraint, HalfEdge};

/// What counts as a feature besides borders, edges of the input's list, and edges between triangles of different labels.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct FeatureOptions {
    /// Edges where the normal turns by more than this angle (degrees) are creases, and features that turn by more have a
    /// corner there; `None`: neither is looked for.
    pub ar: Option<f64>,
}

impl FeatureOptions {
    /// The angle (degrees) unless another is given.
    pub const DEFAULT_ANGLE: f64 = 45.0;
}

impl Default for FeatureOptions {
    fn default() -> Self {
        Self { ar: Some(Self::DEFAULT_ANGLE) }
    }
}

/// What is known of a feature edge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Mark {
    /// The user's label; 0 for none.
    pub label: i32,
    /// Whether the surface has a crease there, or ends, as far as it was looked for or is listed.
    pub is_ridge: bool,
    /// Whether it has to stay as it is.
    pub is_required: bool,
}

impl Surface {
    /// Whether an edge is a feature whatever its angle: of the list, of a required triangle, on the border, between labels.
    pub(super) fn is_given(&self, h: HalfEdge) -> bool {
        self.feature(h, &FeatureOptions { ar: None }).is_some()
    }

    /// What the input says of an edge, and what its triangles do; `None` of an edge that is no feature.
    pub(crate) fn feature(&self, h: HalfEdge, options: &FeatureOptions) -> Option<Mark> {
        let t = &self.topology;
        let listed = t.constraint(h).map(|Constraint(i)| self.marks[i as usize]);
        let is_required = [Some(h), t.twin(h)].into_iter().flatten().any(|side| self.is_required(side));
        let is_ridge = options.ar.is_some_and(|angle| self.turns(h, angle));
        let is_interface = t.twin(h).is_none_or(|twin| t.region(twin.face()) != t.region(h.face()));
        let found = Mark { is_ridge, is_required, ..Mark::default() };
        let mark = listed.unwrap_or_default();
        (listed.is_some() || is_required || is_ridge || is_interface).then_some(Mark {
            label: mark.label,
            is_ridge: mark.is_ridge || found.is_ridge,
            is_required: mark.is_required || found.is_required,
        })
    }

    fn is_required(&self, side: HalfEdge) -> bool {
        self.required_triangles.binary_search(&side.face()).is_ok()
    }

    /// Whether the normals on both sides of an edge differ by more than an angle. At the border the surface turns back.
    fn turns(&self, h: HalfEdge, angle: f64) -> bool {
        let Some(twin) = self.topology.twin(h) else { return true };
        self.normal(h.face()).dot(self.normal(twin.face())) < angle.to_radians().cos()
    }
}
