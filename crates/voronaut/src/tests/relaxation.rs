//! What relaxation promises: the energy never rises, its minimum is known, and boundaries stay where they are.

use crate::geometry::{Point, Tensor};
use crate::manifold::domain::Domain;
use crate::mesh::Mesh;
use crate::metric::MetricField;
use crate::progress::Silent;
use crate::recipe::{self, Centroid, MeshOptions, Meshed};

fn field(text: &str, domain: &Domain) -> Box<dyn MetricField> {
    recipe::metric_named(text, domain.planar()).unwrap()
}

fn relaxed(domain: &str, metric: &dyn MetricField, vertices: usize, lloyd: usize, centroid: Centroid) -> Meshed {
    let domain = Domain::shape(domain).unwrap();
    let options = MeshOptions { vertices: Some(vertices), lloyd, centroid, canvas_size: 20, ..MeshOptions::default() };
    recipe::mesh(&domain, metric, &options, &Silent).unwrap()
}

/// Some steps on the square of side 2; few where a diagram is made in each.
fn of_spec(metric: &str, centroid: Centroid) -> Meshed {
    let square = "rect:-1,-1,1,1";
    let field = field(metric, &Domain::shape(square).unwrap());
    let steps = if centroid == Centroid::Tangent { 20 } else { 6 };
    relaxed(square, field.as_ref(), 500, steps, centroid)
}

fn rises(meshed: &Meshed) -> usize {
    meshed.relaxation.energy.windows(2).filter(|pair| pair[1] > pair[0]).count()
}

#[test]
fn the_energy_never_rises() {
    for metric in ["uniform", "shock:phi=1"] {
        let found = of_spec(metric, Centroid::Canvas);
        assert_eq!(rises(&found), 0, "{metric} on a canvas: {:?}", found.relaxation.energy);
    }
    for metric in ["uniform", "formula:1+y^2; 0; 4", "formula:9; 2*x; 2"] {
        let found = of_spec(metric, Centroid::Tangent);
        assert_eq!(rises(&found), 0, "{metric}: {:?}", found.relaxation.energy);
        assert!(found.relaxation.energy.len() > 5, "{metric}: {:?}", found.relaxation);
    }
}

#[test]
fn the_energy_comes_near_to_that_of_hexagons() {
    // The least energy of N cells of equal area A is N times a regular hexagon's, 5 A^2 / (18 sqrt 3) (Fejes Toth).
    let n = 2000;
    let found = relaxed("rect:0,0,2,1", &|_: Point| Tensor::IDENTITY, n, 40, Centroid::Tangent);
    let area = 2.0 / n as f64;
    let least = n as f64 * 5.0 * area * area / (18.0 * 3.0_f64.sqrt());
    let (first, last) = (found.relaxation.energy[0] / least, found.relaxation.energy.last().unwrap() / least);
    assert!(first > 1.1 && (1.0..1.08).contains(&last), "{first} {last}");
}

#[test]
fn the_canvas_and_the_tangent_planes_agree_on_the_energy() {
    let metric = |p: Point| Tensor::new(4.0 + p.x, 0.5, 1.0);
    let [tangent, canvas] =
        [Centroid::Tangent, Centroid::Canvas].map(|centroid| relaxed("rect:0,0,1,1", &metric, 800, 1, centroid));
    let (a, b) = (tangent.relaxation.energy[0], canvas.relaxation.energy[0]);
    assert!((a / b - 1.0).abs() < 0.02, "{a} {b}");
}

#[test]
fn the_energy_grows_with_the_square_of_the_metric_s_factor() {
    let by = |factor: f64| {
        let metric = move |p: Point| Tensor::new(2.0 + p.x, 0.0, 1.0) * factor;
        relaxed("rect:0,0,1,1", &metric, 500, 20, Centroid::Tangent).relaxation.energy
    };
    // A power of two: the same roundings.
    let (one, many) = (by(1.0), by(1024.0));
    assert_eq!(one.len(), many.len());
    for (a, b) in one.iter().zip(&many) {
        assert!((a * 1024.0 * 1024.0 / b - 1.0).abs() < 1e-9, "{a} {b}");
    }
}

/// The points of a mesh on the border of the unit square, along it.
fn border(mesh: &Mesh) -> usize {
    let is_on = |x: f64| [0.0, 1.0].contains(&x);
    mesh.points.iter().filter(|p| is_on(p[0]) || is_on(p[1])).count()
}

#[test]
fn boundary_seeds_slide_and_stay_on_the_boundary() {
    // Sampled at unit length, and then moved by what happens inside: the metric has a bump beside the border.
    let bump = |p: Point| Tensor::IDENTITY * (1.0 + 20.0 * (-40.0 * ((p.x - 0.5).powi(2) + (p.y - 0.1).powi(2))).exp());
    let [before, after] = [0, 40].map(|lloyd| relaxed("rect:0,0,1,1", &bump, 600, lloyd, Centroid::Tangent));
    assert!(border(&before.mesh) > 60 && border(&before.mesh) == border(&after.mesh));
    let bottom = |meshed: &Meshed| {
        let mut found: Vec<f64> =
            meshed.mesh.points.iter().filter(|p| p[1].abs() < f64::MIN_POSITIVE).map(|p| p[0]).collect();
        found.sort_by(f64::total_cmp);
        found
    };
    let (old, new) = (bottom(&before), bottom(&after));
    assert_eq!((old.len(), new[0], new[new.len() - 1]), (new.len(), 0.0, 1.0));
    assert!(old.iter().zip(&new).any(|(a, b)| (a - b).abs() > 1e-3), "{old:?} {new:?}");
    for corner in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]] {
        assert!(after.mesh.points.iter().any(|p| p[..2] == corner));
    }
}

#[test]
fn the_report_s_centroid_may_raise_the_energy_and_ends_higher() {
    // RR-9103, equation 9, weighs Euclidean positions: where the metric changes within a cell, it is another point.
    let [weighted, canvas] = [Centroid::Weighted, Centroid::Canvas].map(|centroid| of_spec("shock", centroid));
    assert!(rises(&weighted) > 0, "{:?}", weighted.relaxation.energy);
    assert!(weighted.relaxation.energy.last() > canvas.relaxation.energy.last());
}
