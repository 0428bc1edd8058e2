//! Everything that a solution file holds, carried at once.

use super::{Carried, Cover, Field, Kind, Overshoot, Place, conservative, interpolate};
use crate::error::Result;
use crate::mesh::{Mesh, SolutionValues, Solutions};

/// How solutions are carried; every parameter has one name (flag, TOML key, Python keyword).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TransferOptions {
    /// Whether integrals over the domain are kept ([`conservative`]), else [`interpolate`].
    pub conservative: bool,
    /// What happens beyond the bounds of the old field, if they are.
    pub overshoot: Overshoot,
    /// Whether symmetric tensors are no metrics: each entry is then carried for itself.
    pub linear_tensors: bool,
}

/// Carries all solutions of `old` to `new`. What comes back has their types and order; with it what became of each, those on
/// vertices first.
///
/// # Errors
/// As of [`conservative`]; [`crate::Error::Unsupported`] of metrics of space on planar meshes, and of the plane on surfaces.
pub fn carry(
    old: &Mesh,
    new: &Mesh,
    given: &Solutions,
    options: TransferOptions,
) -> Result<(Solutions, Vec<Carried>, Cover)> {
    let fields = fields(given, options.linear_tensors);
    let (carried, cover) = if options.conservative {
        conservative(old, new, &fields, options.overshoot)?
    } else {
        interpolate(old, new, &fields)?
    };
    Ok((solutions(given, &carried), carried, cover))
}

fn fields(given: &Solutions, linear_tensors: bool) -> Vec<Field> {
    let on_vertices = given.vertices.iter().map(|values| (Place::Vertices, values));
    let on_triangles = given.triangles.iter().map(|values| (Place::Triangles, values));
    let field = |(place, values): (Place, &SolutionValues)| {
        let kind = match values {
            SolutionValues::Tensor(_) if !linear_tensors => Kind::Metric,
            SolutionValues::Tensor3(_) if !linear_tensors => Kind::SpaceMetric,
            SolutionValues::Scalar(_) => Kind::Linear(1),
            SolutionValues::Vector { components, .. } => Kind::Linear(*components),
            SolutionValues::Tensor(_) => Kind::Linear(3),
            SolutionValues::Tensor3(_) => Kind::Linear(6),
        };
        let numbers = (0..values.count()).flat_map(|i| values.row(i)).copied().collect();
        Field { place, kind, values: numbers }
    };
    on_vertices.chain(on_triangles).map(field).collect()
}

/// What was carried, in the order and of the types of what was given.
fn solutions(given: &Solutions, carried: &[Carried]) -> Solutions {
    let (vertices, triangles) = carried.split_at(given.vertices.len());
    let same = |values: &[SolutionValues], carried: &[Carried]| {
        let pairs = values.iter().zip(carried);
        pairs.map(|(values, carried)| values.with_numbers(&carried.field.values)).collect()
    };
    Solutions {
        dimension: given.dimension,
        vertices: same(&given.vertices, vertices),
        triangles: same(&given.triangles, triangles),
    }
}
