//! The Riemannian Delaunay triangulation of unprotected seeds against closed forms: flat space seen through maps of the plane,
//! the half-plane, the sphere.

mod models;
mod robust;

use crate::geometry::{Point, Tensor};
use crate::metric::MetricField;
use models::{Map, Model, SQUARE, pulled_back, run};

#[test]
fn uniform() {
    let (sin, cos) = 0.6_f64.sin_cos();
    let map = move |p: Point| Point::new(cos * p.x + sin * p.y, 30.0 * (cos * p.y - sin * p.x));
    let metric = pulled_back(move |_| [cos, sin, -30.0 * sin, 30.0 * cos]);
    let model = Model { name: "uniform 30:1", corners: SQUARE, map: &map, metric: &metric, curvature: 0.0 };
    run(&model, 40_000, 0.14, 40);
}

#[test]
fn waves() {
    let pi = std::f64::consts::PI;
    let map = move |p: Point| Point::new(0.1 * p.x, p.y + 0.25 * (pi * p.x).sin());
    let metric = pulled_back(move |p| [0.1, 0.0, 0.25 * pi * (pi * p.x).cos(), 1.0]);
    let model = Model { name: "waves", corners: SQUARE, map: &map, metric: &metric, curvature: 0.0 };
    run(&model, 60_000, 0.0085, 40);
}

#[test]
fn vortex() {
    // Turn by an angle that grows with the distance from the centre: cells wind around it.
    let turn = |r2: f64| (2.2 * (1.0 - 0.5 * r2), -2.2);
    let map = move |p: Point| {
        let (sin, cos) = turn(p.x * p.x + p.y * p.y).0.sin_cos();
        Point::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y)
    };
    let metric = pulled_back(move |p| {
        let (angle, slope) = turn(p.x * p.x + p.y * p.y);
        let (sin, cos) = angle.sin_cos();
        let (x, y) = (cos * p.x - sin * p.y, sin * p.x + cos * p.y);
        [cos - y * slope * p.x, -sin - y * slope * p.y, sin + x * slope * p.x, cos + x * slope * p.y]
    });
    let model = Model { name: "vortex", corners: SQUARE, map: &map, metric: &metric, curvature: 0.0 };
    run(&model, 60_000, 0.027, 40);
}

#[test]
fn half_plane() {
    let corners = [Point::new(-1.0, 0.25), Point::new(1.0, 2.25)];
    let metric = |p: Point| Tensor::isotropic(p.y);
    let model = Model { name: "half-plane", corners, map: &|p| p, metric: &metric, curvature: -1.0 };
    run(&model, 60_000, 0.034, 40);
}

#[test]
fn sphere() {
    let corners = [Point::new(-1.5, -1.5), Point::new(1.5, 1.5)];
    let metric = |p: Point| Tensor::isotropic(0.5 * (1.0 + p.x * p.x + p.y * p.y));
    let model = Model { name: "sphere", corners, map: &|p| p, metric: &metric, curvature: 1.0 };
    run(&model, 60_000, 0.04, 40);
}

#[test]
fn other_flat_spaces() {
    let shear = |p: Point| {
        let x = p.x + 0.3 * (3.0 * p.y).sin();
        Point::new(x, (p.y + 0.5 * (2.0 * x).sin()) / 8.0)
    };
    let shear_metric = pulled_back(|p| {
        let (x, slope) = (p.x + 0.3 * (3.0 * p.y).sin(), 0.9 * (3.0 * p.y).cos());
        let c = (2.0 * x).cos();
        [1.0, slope, c / 8.0, (1.0 + c * slope) / 8.0]
    });
    // z + z^2 / 4 - z^3 / 10: isotropic.
    let conformal = |p: Point| {
        let (x, y) = (p.x, p.y);
        let (x2, y2) = (x * x - y * y, 2.0 * x * y);
        Point::new(x + 0.25 * x2 - 0.1 * (x * x2 - y * y2), y + 0.25 * y2 - 0.1 * (x * y2 + y * x2))
    };
    let conformal_metric = pulled_back(|p| {
        let (x2, y2) = (p.x * p.x - p.y * p.y, 2.0 * p.x * p.y);
        let (a, b) = (1.0 + 0.5 * p.x - 0.3 * x2, 0.5 * p.y - 0.3 * y2);
        [a, -b, b, a]
    });
    let polar = |p: Point| {
        let (sin, cos) = (1.8 * p.y).sin_cos();
        Point::new((1.2 * p.x).exp() * cos, (1.2 * p.x).exp() * sin)
    };
    let polar_metric = pulled_back(|p| {
        let (sin, cos) = (1.8 * p.y).sin_cos();
        let r = (1.2 * p.x).exp();
        [1.2 * r * cos, -1.8 * r * sin, 1.2 * r * sin, 1.8 * r * cos]
    });
    // Layers: y is stretched thirtyfold in a band that waves.
    let band = |p: Point| Point::new(p.x, p.y + 1.5 * ((p.y - 0.3 * (2.0 * p.x).sin()) / 0.15).tanh());
    let band_metric = pulled_back(|p| {
        let slope = 10.0 * ((p.y - 0.3 * (2.0 * p.x).sin()) / 0.15).cosh().powi(-2);
        [1.0, 0.0, -0.6 * (2.0 * p.x).cos() * slope, 1.0 + slope]
    });
    let all: [(&str, Map, &dyn MetricField, f64); 4] = [
        ("shear", &shear, &shear_metric, 0.0095),
        ("conformal", &conformal, &conformal_metric, 0.035),
        ("polar", &polar, &polar_metric, 0.06),
        ("band", &band, &band_metric, 0.055),
    ];
    for (name, map, metric, spacing) in all {
        let model = Model { name, corners: SQUARE, map, metric, curvature: 0.0 };
        run(&model, 15_000, 1.8 * spacing, 40);
    }
}

#[test]
fn few_seeds_and_other_scales() {
    let pi = std::f64::consts::PI;
    for scale in [1.0, 1e-9, 1e9] {
        let map = move |p: Point| Point::new(0.1 * p.x / scale, p.y / scale + 0.25 * (pi * p.x / scale).sin());
        let metric = pulled_back(move |p| [0.1, 0.0, 0.25 * pi * (pi * p.x / scale).cos(), 1.0].map(|x| x / scale));
        let corners = SQUARE.map(|p| Point::new(p.x * scale, p.y * scale));
        let model = Model { name: "waves", corners, map: &map, metric: &metric, curvature: 0.0 };
        for (spacing, per_seed) in [(0.11, 100), (0.06, 60), (0.025, 40)] {
            run(&model, 20_000, spacing, per_seed);
        }
    }
    let metric = |p: Point| Tensor::isotropic(p.y);
    let corners = [Point::new(-1.0, 0.25), Point::new(1.0, 2.25)];
    let model = Model { name: "half-plane", corners, map: &|p| p, metric: &metric, curvature: -1.0 };
    for spacing in [0.6, 0.35] {
        run(&model, 2000, spacing, 100);
    }
    let metric = |p: Point| Tensor::isotropic(0.5 * (1.0 + p.x * p.x + p.y * p.y));
    let model = Model { name: "sphere", corners: SQUARE, map: &|p| p, metric: &metric, curvature: 1.0 };
    for spacing in [0.5, 0.25] {
        run(&model, 2000, spacing, 100);
    }
}
