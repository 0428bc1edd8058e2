//! Scenes of values on a surface.

use super::coloured::normals;
use super::{Fill, Scene, SceneTriangle};
use voronaut::geometry::Point3;

/// Steps of colour.
const BANDS: f64 = 40.0;

impl Scene {
    /// A surface whose vertices have values from 0 up, smooth: each triangle by the mean of its corners, the less, the
    /// stronger; plain where that is not finite. Triangles with vertices that do not exist are left out.
    pub fn of_values(positions: &[Point3], triangles: &[[u32; 3]], values: &[f64]) -> Self {
        let exists = |v: &u32| (*v as usize) < positions.len().min(values.len());
        let triangles: Vec<[u32; 3]> = triangles.iter().copied().filter(|t| t.iter().all(exists)).collect();
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
        Self { triangles: triangles.iter().map(triangle).collect(), lines: Vec::new() }
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
