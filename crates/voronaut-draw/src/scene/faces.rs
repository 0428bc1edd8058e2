//! Scenes of meshes, and of values on surfaces.

use super::super::shades::{self, BANDS};
use super::coloured::normals;
use super::{Fill, Scene, SceneTriangle, Stroke, existing};
use voronaut::geometry::Point3;
use voronaut::mesh::{Edges, Mesh};
use voronaut::quality::Unmet;

impl Scene {
    /// The triangles of a mesh, flat, by their size, with all edges; its border and its labelled edges are stronger; over them those
    /// that are not of unit length, by their causes, with a legend. Triangles with vertices that do not exist or are not finite are left out.
    pub fn of_mesh(mesh: &Mesh, unmet: Option<&Unmet>) -> Self {
        let (used, labels) = shades::drawable(mesh);
        let at = |v: u32| Point3::from(mesh.points[v as usize]);
        let corners: Vec<[Point3; 3]> = used.iter().map(|triangle| triangle.map(at)).collect();
        let double_areas = corners.iter().map(|&[a, b, c]| (b - a).cross(c - a).norm());
        let fills = shades::sizes(double_areas, &labels);
        let triangle = |(&corners, (region, share)): (&[Point3; 3], (usize, f64))| SceneTriangle {
            corners,
            normals: None,
            fill: Fill::Level { region, share },
        };
        let edges = Edges::of(&used);
        let inner = edges.iter().filter(|sides| sides.len() > 1).map(|sides| sides[0].ends);
        let listed = mesh.edges.iter().copied().filter(|&ends| !edges.at(ends).is_empty());
        let border = edges.boundary().map(|side| side.ends).chain(listed);
        let line = |ends: [u32; 2]| ends.map(at).to_vec();
        let triangles = corners.iter().zip(fills).map(triangle).collect();
        let mut scene = Self { triangles, unmet: unmet.cloned(), ..Self::default() }
            .with(inner.map(line), Stroke::Edge)
            .with(border.map(line), Stroke::Border);
        for edge in unmet.iter().flat_map(|unmet| &unmet.edges).filter(|edge| !edges.at(edge.edge).is_empty()) {
            let cause = edge.cause as usize;
            let stroke = if edge.is_short() { Stroke::TooShort(cause) } else { Stroke::TooLong(cause) };
            scene = scene.with([line(edge.edge)], stroke);
        }
        scene
    }

    /// A surface whose vertices have values from 0 up, smooth: each triangle by the mean of its corners, the less, the
    /// stronger; plain where that is not finite. Triangles with vertices that do not exist are left out.
    pub fn of_values(positions: &[Point3], triangles: &[[u32; 3]], values: &[f64]) -> Self {
        let triangles = existing(triangles, positions.len().min(values.len()));
        let normals = normals(positions, &triangles);
        let most = values.iter().copied().filter(|value| value.is_finite()).fold(f64::MIN_POSITIVE, f64::max);
        let fill = |t: [u32; 3]| {
            let mean = t.iter().map(|&v| values[v as usize] / 3.0).sum::<f64>() / most;
            let share = ((1.0 - mean) * BANDS).round() / BANDS;
            if mean.is_finite() { Fill::Level { region: 0, share } } else { Fill::Plain }
        };
        let triangle = |&t: &[u32; 3]| SceneTriangle {
            corners: t.map(|v| positions[v as usize]),
            normals: Some(t.map(|v| normals[v as usize])),
            fill: fill(t),
        };
        Self { triangles: triangles.iter().map(triangle).collect(), ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn less_is_stronger_and_what_is_not_reached_is_plain() {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
        let fills = |values: &[f64]| -> Vec<Fill> {
            let triangles = [[0, 1, 2], [0, 2, 3], [0, 1, 9]];
            Scene::of_values(&points, &triangles, values).triangles.iter().map(|triangle| triangle.fill).collect()
        };
        let level = |share: f64| Fill::Level { region: 0, share };
        assert_eq!(fills(&[0.0, 0.0, 0.0, 3.0]), [level(1.0), level(27.0 / 40.0)]);
        assert_eq!(fills(&[2.0, 2.0, 2.0, f64::INFINITY]), [level(0.0), Fill::Plain]);
        assert_eq!(fills(&[0.0; 4]), [level(1.0); 2]);
    }
}
