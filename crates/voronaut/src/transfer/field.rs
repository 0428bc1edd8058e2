//! Fields on a mesh, and what is said of them before and after.

use super::mass::areas;
use crate::error::{Error, Result};
use crate::geometry::{Tensor, Tensor3};
use crate::mesh::Mesh;
use crate::metric::{check_tensor_at, check_tensor3};
use serde::Serialize;

/// Values on a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// What has a value.
    pub place: Place,
    /// What a value is.
    pub kind: Kind,
    /// The components of the first value, then those of the second, and so on.
    pub values: Vec<f64>,
}

/// What has a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Place {
    /// Vertices; between them the field is linear (the logarithm of a metric is).
    Vertices,
    /// Triangles.
    Triangles,
}

/// What a value is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// So many numbers, each carried for itself: scalars, vectors, tensors that are no metric.
    Linear(usize),
    /// A metric m11, m12, m22, carried by its logarithm.
    Metric,
    /// One of space, m11, m12, m22, m13, m23, m33, on a surface, carried so, too.
    SpaceMetric,
}

/// A field on the new mesh, and its components here and there.
#[derive(Clone, Debug, PartialEq)]
pub struct Carried {
    /// On the new mesh.
    pub field: Field,
    /// Each component on the old mesh.
    pub before: Vec<Extent>,
    /// Each component on the new mesh.
    pub after: Vec<Extent>,
}

/// The range of a component, and its integral.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Extent {
    /// The least value.
    pub min: f64,
    /// The greatest value.
    pub max: f64,
    /// The integral over the mesh, triangles of either orientation counting alike.
    pub mass: f64,
}

impl Field {
    /// Numbers that a value has.
    pub fn components(&self) -> usize {
        match self.kind {
            Kind::Linear(components) => components,
            Kind::Metric => 3,
            Kind::SpaceMetric => 6,
        }
    }

    /// Whether it has a value for all that needs one, finite and, where that is said, positive definite. `number` is its place among
    /// the fields, for messages.
    pub(super) fn check(&self, old: &Mesh, number: usize, in_plane: bool) -> Result<()> {
        let (needed, what) = match self.place {
            Place::Vertices => (old.points.len(), "vertices"),
            Place::Triangles => (old.triangles.len(), "triangles"),
        };
        let components = self.components();
        if components == 0 || self.values.len() != needed * components {
            let found = self.values.len() as f64 / components.max(1) as f64;
            let what = format!("{found} values for {needed} {what}");
            let help = format!("a field has one value for each of the old mesh's {needed}, in the same order");
            return Err(Error::mesh(what, format!("field {number}"), help));
        }
        if let Some(i) = self.values.iter().position(|value| !value.is_finite()) {
            let (what, place) =
                (format!("the value is {}", self.values[i]), self.describe(old, i / components, number));
            return Err(Error::mesh(what, place, "correct the value: it must be finite"));
        }
        let refused = match self.kind {
            Kind::Metric if !in_plane => {
                Some(("metrics of the plane on the mesh of a surface", "3 (m11 m12 m22 m13 m23 m33)"))
            }
            Kind::SpaceMetric if in_plane => Some(("metrics of space on planar meshes", "2 (m11 m12 m22)")),
            _ => None,
        };
        if let Some((what, dimension)) = refused {
            let help = format!(
                "save the tensors with Dimension {dimension}, or say that they are no metrics: `linear_tensors`"
            );
            return Err(Error::unsupported(what, help));
        }
        if self.kind == Kind::SpaceMetric {
            for (i, row) in self.values.chunks_exact(6).enumerate() {
                check_tensor3(tensor3(row), || self.describe(old, i, number))?;
            }
        }
        if self.kind == Kind::Metric {
            for (i, row) in self.values.chunks_exact(3).enumerate() {
                check_tensor_at(Tensor::new(row[0], row[1], row[2]), || self.describe(old, i, number))?;
            }
        }
        Ok(())
    }

    fn describe(&self, old: &Mesh, row: usize, number: usize) -> String {
        match self.place {
            Place::Vertices => format!("{}, field {number}", old.describe(row)),
            Place::Triangles => format!("triangle {}, field {number}", row + 1),
        }
    }

    /// The numbers that are linear between vertices: the values, or the logarithms of metrics.
    pub(super) fn linear(&self) -> Vec<f64> {
        self.mapped(Tensor::log, Tensor3::log)
    }

    /// A field of the same kind from what is linear.
    pub(super) fn with_linear(&self, values: Vec<f64>) -> Self {
        let linear = Self { values, ..*self };
        let values = linear.mapped(Tensor::exp, Tensor3::exp);
        Self { values, ..*self }
    }

    fn mapped(&self, map: impl Fn(Tensor) -> Tensor, in_space: impl Fn(Tensor3) -> Tensor3) -> Vec<f64> {
        let tensor = |row: &[f64]| {
            let Tensor { xx, xy, yy } = map(Tensor::new(row[0], row[1], row[2]));
            [xx, xy, yy]
        };
        match self.kind {
            Kind::Linear(_) => self.values.clone(),
            Kind::Metric => self.values.chunks_exact(3).flat_map(tensor).collect(),
            Kind::SpaceMetric => self.values.chunks_exact(6).flat_map(|row| in_space(tensor3(row)).to_disk()).collect(),
        }
    }

    /// Range and integral of each component; `areas` are those of the mesh's triangles.
    fn extents(&self, mesh: &Mesh, areas: &[f64]) -> Vec<Extent> {
        let n = self.components();
        let of = |c: usize| {
            let at = |i: usize| self.values[i * n + c];
            let mass = match self.place {
                Place::Triangles => areas.iter().enumerate().map(|(t, area)| area * at(t)).sum(),
                Place::Vertices => {
                    let mean = |t: &[u32; 3]| t.iter().map(|&v| at(v as usize)).sum::<f64>() / 3.0;
                    mesh.triangles.iter().zip(areas).map(|(t, area)| area * mean(t)).sum()
                }
            };
            let all = || self.values.iter().skip(c).step_by(n).copied();
            Extent { min: all().fold(f64::INFINITY, f64::min), max: all().fold(f64::NEG_INFINITY, f64::max), mass }
        };
        (0..n).map(of).collect()
    }
}

fn tensor3(row: &[f64]) -> Tensor3 {
    Tensor3::from_disk(std::array::from_fn(|i| row[i]))
}

/// Fields of the new mesh beside those of the old.
pub(super) fn compared(old: &Mesh, new: &Mesh, fields: &[Field], carried: Vec<Field>) -> Vec<Carried> {
    let (there, here) = (areas(old), areas(new));
    let beside = |(before, field): (&Field, Field)| {
        let (before, after) = (before.extents(old, &there), field.extents(new, &here));
        Carried { field, before, after }
    };
    fields.iter().zip(carried).map(beside).collect()
}
