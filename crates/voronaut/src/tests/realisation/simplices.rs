//! Karcher means on surfaces where they are known, and the grids made of them.

use super::{realised, seeds};
use crate::geodesic::{Fineness, Paths, karcher_mean};
use crate::geometry::{Point, Tensor};
use crate::metric::MetricField;

fn mean(field: &dyn MetricField, corners: [Point; 3], weights: [f64; 3]) -> Point {
    karcher_mean(&Paths::default(), field, corners, weights, Fineness::FINEST).expect("a mean")
}

fn half_plane(p: Point) -> Tensor {
    Tensor::isotropic(p.y)
}

fn sphere(p: Point) -> Tensor {
    Tensor::isotropic(0.5 * (1.0 + p.x * p.x + p.y * p.y))
}

#[test]
fn corners_and_edges_are_reproduced() {
    let corners = [(-0.3, 1.0), (0.5, 0.8), (0.2, 1.7)].map(|(x, y)| Point::new(x, y));
    let paths = Paths::default();
    for field in [half_plane, sphere] {
        for i in 0..3 {
            let mut weights = [0.0; 3];
            weights[i] = 1.0;
            assert_eq!(mean(&field, corners, weights), corners[i]);
            let (p, q) = (corners[i], corners[(i + 1) % 3]);
            let edge = paths.curve(&field, [p, q], None, Fineness::FINEST).unwrap();
            for t in [0.1, 0.5, 0.8] {
                weights[i] = 1.0 - t;
                weights[(i + 1) % 3] = t;
                weights[(i + 2) % 3] = 0.0;
                let [at, on] = [mean(&field, corners, weights), edge.at(t)];
                assert!(at.distance(on) < 1e-6, "{i} {t} {at} {on}");
            }
        }
    }
}

#[test]
fn symmetric_triangles_have_symmetric_means() {
    let corners = [(-0.4, 1.0), (0.4, 1.0), (0.0, 2.0)].map(|(x, y)| Point::new(x, y));
    for weights in [[1.0, 1.0, 1.0], [0.3, 0.3, 0.4], [1.0, 1.0, 0.0]] {
        assert!(mean(&half_plane, corners, weights).x.abs() < 1e-6, "{weights:?}");
    }
    // Halfway along the hyperbolic geodesic between the two lower corners, a circle around (0, 0).
    assert!((mean(&half_plane, corners, [1.0, 1.0, 0.0]).y - 1.16_f64.sqrt()).abs() < 1e-6);
    // Three corners around the pole of the sphere, a third of a turn apart; and the mean in polar coordinates of two of them
    // with a third at the pole: colatitudes a, at an angle b to each other, weights w, w and 1 - 2 w.
    let on = |angle: f64, r: f64| Point::new(r * angle.cos(), r * angle.sin());
    let third = std::f64::consts::TAU / 3.0;
    let around = [0.4, 0.4 + third, 0.4 + 2.0 * third].map(|angle| on(angle, 0.6));
    assert!(mean(&sphere, around, [1.0; 3]).distance(Point::new(0.0, 0.0)) < 1e-6);
    let apart = [on(0.5, 0.4), on(-0.5, 0.4), on(0.0, 0.0)];
    let found = mean(&sphere, apart, [1.0; 3]);
    assert!(found.y.abs() < 1e-6);
    // The mean of all three minimises x^2 / 2 + d(x)^2 over points at colatitude x halfway between; by golden section.
    let energy = |x: f64| {
        let colatitude = 2.0 * 0.4_f64.atan();
        let cosine = x.cos() * colatitude.cos() + x.sin() * colatitude.sin() * 0.5_f64.cos();
        x * x + 2.0 * cosine.acos().powi(2)
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let (a, b) = (low + 0.382 * (high - low), high - 0.382 * (high - low));
        if energy(a) < energy(b) { high = b } else { low = a }
    }
    assert!((2.0 * found.x.atan() - 0.5 * (low + high)).abs() < 1e-6, "{found} {low}");
}

#[test]
fn grids_fill_their_triangles() {
    let found =
        realised("rect:-1,0.5,1,2.5", &half_plane, &seeds(60, Point::new(-1.0, 0.5), Point::new(1.0, 2.5)), 6000);
    let grids = found.grids(&half_plane, 4);
    assert_eq!(grids.len(), found.triangles.len());
    let missing = grids.iter().filter(|grid| grid.is_none()).count();
    assert!(missing * 20 <= grids.len(), "{missing} of {}", grids.len());
    for (grid, t) in grids.iter().zip(&found.triangles).filter_map(|(grid, t)| Some((grid.as_ref()?, t))) {
        assert_eq!((grid.points.len(), grid.lines().len()), (15, 9));
        let corners = [grid.at(0, 0), grid.at(4, 0), grid.at(0, 4)];
        assert_eq!(corners, t.map(|i| found.seeds[i as usize]));
    }
}
