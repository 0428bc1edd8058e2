//! Values of the old field at points of the new mesh.

use super::cover::Cover;
use super::ground::Ground;
use super::{Field, Place};
use crate::geometry::{Aabb3, Point3};
use crate::manifold::OFF_SURFACE;
use crate::mesh::{Located, Mesh};
use crate::parallel::prelude::*;

/// Points farther from the old mesh than this share of its extent are outside it, not on its border.
const ROUNDING: f64 = 1e-9;

/// All fields on the new mesh. Points are found once for all fields of vertices, and once for those of triangles.
pub(super) fn interpolate(ground: &Ground, old: &Mesh, new: &Mesh, fields: &[Field]) -> (Vec<Field>, Cover) {
    let vertices: Vec<Point3> = (0..new.points.len() as u32).map(|v| new.position(v)).collect();
    let vertices = located(ground, &vertices);
    let on_triangles = fields.iter().any(|field| field.place == Place::Triangles);
    let centroid = |&t: &[u32; 3]| Point3::weighted(new.positions_of(t), [1.0 / 3.0; 3]);
    let centroids: Vec<Point3> = if on_triangles { new.triangles.iter().map(centroid).collect() } else { vec![] };
    let centroids = located(ground, &centroids);
    let carried = fields.iter().map(|field| match field.place {
        Place::Vertices => at_vertices(old, field, &vertices),
        Place::Triangles => {
            let n = field.components();
            let row = |found: &Located| &field.values[found.triangle as usize * n..][..n];
            Field { values: centroids.iter().flat_map(row).copied().collect(), ..*field }
        }
    });
    (carried.collect(), cover(ground, old, &vertices))
}

fn at_vertices(old: &Mesh, field: &Field, vertices: &[Located]) -> Field {
    let (n, linear) = (field.components(), field.linear());
    let value = |found: &Located, c: usize| {
        let corners = old.triangles[found.triangle as usize].map(|v| linear[v as usize * n + c]);
        mean(corners, found.weights)
    };
    field.with_linear(vertices.iter().flat_map(|found| (0..n).map(move |c| value(found, c))).collect())
}

/// The weighted mean, between the least and the greatest value in spite of rounding.
pub(super) fn mean([a, b, c]: [f64; 3], weights: [f64; 3]) -> f64 {
    (a * weights[0] + b * weights[1] + c * weights[2]).clamp(a.min(b).min(c), a.max(b).max(c))
}

fn located(ground: &Ground, points: &[Point3]) -> Vec<Located> {
    points.par_iter().map(|&p| ground.locate(p).expect("checked: points are finite, and there are triangles")).collect()
}

/// On a surface every vertex may be a little off the old triangles: more than a share of the extent is outside.
fn cover(ground: &Ground, old: &Mesh, vertices: &[Located]) -> Cover {
    let bounds = Aabb3::of((0..old.points.len() as u32).map(|v| old.position(v)));
    let share = if ground.is_planar() { ROUNDING } else { OFF_SURFACE };
    let rounding = bounds.map_or(0.0, |bounds| bounds.extent().norm() * share);
    let outside = vertices.iter().filter(|found| found.distance > rounding);
    let farthest = outside.clone().map(|found| found.distance).fold(0.0, f64::max);
    Cover { outside: outside.count(), farthest, areas: None }
}
