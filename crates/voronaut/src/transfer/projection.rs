//! Fields projected: the least L2 distance to the old field, or the mean over each triangle.

use super::cover::Cover;
use super::ground::Ground;
use super::loads::{Load, Old, shares};
use super::mass::{MassMatrix, areas, balance, bounded, share_missing};
use super::{Field, Kind, Overshoot, Place};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::sparse::dot;

/// All fields on the new mesh; metrics as they were interpolated.
pub(super) fn project(
    ground: &Ground,
    [old, new]: [&Mesh; 2],
    fields: &[Field],
    interpolated: Vec<Field>,
    cover: Cover,
    overshoot: Overshoot,
) -> Result<(Vec<Field>, Cover)> {
    let [linear, constant] = [Place::Vertices, Place::Triangles].map(|place| columns(fields, place));
    let read = |columns: &[Column]| columns.iter().map(|column| column.read(fields)).collect();
    let sources = Old { mesh: old, ground, linear: read(&linear), constant: read(&constant) };
    let loads = sources.loads(new);
    let shares = shares(&loads, old, new);
    shares.demand(ground.is_planar())?;
    let (there, here) = (areas(old), areas(new));
    let [old_matrix, matrix] = [(old, &there), (new, &here)].map(|(mesh, areas)| MassMatrix::new(mesh, areas));
    let mut carried = interpolated;
    for (c, column) in linear.iter().enumerate() {
        let target = dot(&sources.linear[c], &old_matrix.lumped);
        let values = nodal(&matrix, &loads, c, &column.read(&carried), target, overshoot);
        column.write(&mut carried, &values);
    }
    for (c, column) in constant.iter().enumerate() {
        let target = dot(&sources.constant[c], &there);
        let mut values: Vec<f64> = loads.iter().map(|load| load.means[c]).collect();
        balance(&mut values, &here, target);
        column.write(&mut carried, &values);
    }
    Ok((carried, Cover { areas: Some(shares), ..cover }))
}

/// One component at the vertices, from its interpolation.
fn nodal(
    matrix: &MassMatrix<'_>,
    loads: &[Load],
    component: usize,
    interpolated: &[f64],
    target: f64,
    overshoot: Overshoot,
) -> Vec<f64> {
    let masses = &matrix.lumped;
    let load = matrix.assemble(|t, corner| matrix.areas[t] * loads[t].products[component][corner]);
    let mut values = matrix.solve(&load, interpolated.to_owned());
    balance(&mut values, masses, target);
    if overshoot == Overshoot::Kept {
        return values;
    }
    // Means over hat functions are within the bounds and have the mass of the covered part: what brings them to the target
    // brings the bounds to where it can be met.
    let mean = |v: usize| if masses[v] > 0.0 { load[v] / masses[v] } else { interpolated[v] };
    let means: Vec<f64> = (0..masses.len()).map(mean).collect();
    let share = share_missing(&means, masses, target);
    let moved = |u: f64| u + share * u.abs();
    let bounds = |v: usize| {
        let ranges = matrix.fan(v).filter(|&(t, _)| matrix.areas[t] > 0.0).map(|(t, _)| loads[t].ranges[component]);
        let (low, high) = ranges.fold((f64::INFINITY, f64::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        if low <= high { (moved(low), moved(high)) } else { (values[v], values[v]) }
    };
    let bounds: Vec<(f64, f64)> = (0..masses.len()).map(bounds).collect();
    bounded(matrix, values, &bounds)
}

/// A component of one of the fields.
struct Column {
    field: usize,
    component: usize,
    width: usize,
    /// A power of two near the greatest magnitude: squares of values in this unit neither over- nor underflow.
    unit: f64,
}

/// The components of all fields of one place but metrics.
fn columns(fields: &[Field], place: Place) -> Vec<Column> {
    let chosen =
        fields.iter().enumerate().filter(|(_, field)| field.place == place && matches!(field.kind, Kind::Linear(_)));
    let columns = chosen.flat_map(|(field, of)| {
        let width = of.components();
        (0..width).map(move |component| {
            let unit = unit(of.values.iter().skip(component).step_by(width));
            Column { field, component, width, unit }
        })
    });
    columns.collect()
}

impl Column {
    fn read(&self, fields: &[Field]) -> Vec<f64> {
        fields[self.field].values.iter().skip(self.component).step_by(self.width).map(|u| u / self.unit).collect()
    }

    fn write(&self, fields: &mut [Field], values: &[f64]) {
        let slots = fields[self.field].values.iter_mut().skip(self.component).step_by(self.width);
        slots.zip(values).for_each(|(slot, &value)| *slot = value * self.unit);
    }
}

fn unit<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    /// Powers of two beyond this are near those that overflow.
    const MOST: f64 = 1000.0;
    let greatest = values.fold(0.0_f64, |most, u| most.max(u.abs()));
    if greatest > 0.0 { 2.0_f64.powi(greatest.binary_logarithm().clamp(-MOST, MOST) as i32) } else { 1.0 }
}
