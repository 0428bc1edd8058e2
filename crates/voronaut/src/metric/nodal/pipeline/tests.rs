//! Targets met, limits kept, sources on one scale.

use super::super::complexity::scaled_to;
use super::super::test_meshes::{grid, tensors_at};
use super::super::weighted::weighted;
use super::super::{Limit, grade};
use super::*;
use crate::geometry::Vector;
use crate::metric::Bounds;
use crate::test_cases::cases;
use proptest::prelude::*;

/// Across the line y = x / 3 + 0.4 a layer of this width.
fn layer(mesh: &Mesh, width: f64) -> Vec<Tensor> {
    let normal = Vector::new(-1.0, 3.0) * 10_f64.powf(-0.5);
    tensors_at(mesh, |p| {
        let d = (p.y - p.x / 3.0 - 0.4) / width;
        Tensor::from_axis(normal, -d * (-d * d).exp() / (width * width), 1.0 + p.x)
    })
}

fn hessians(count: usize) -> impl Strategy<Value = Vec<Tensor>> {
    let one = (-50.0..50.0, -50.0..50.0, -50.0..50.0).prop_map(|(a, b, c)| Tensor::new(a, b, c));
    proptest::collection::vec(one, count)
}

/// Limits around sizes of 0.05.
fn limits() -> impl Strategy<Value = Limits> {
    let size = || prop_oneof![Just(None), (0.3..0.9_f64).prop_map(Some)];
    let ratio = prop_oneof![Just(None), (1.0..20.0_f64).prop_map(Some)];
    (size(), size(), ratio).prop_map(|(low, high, a_max)| {
        Bounds { h_min: low.map(|x| 0.05 * x), h_max: high.map(|x| 0.05 / x), a_max }.into()
    })
}

proptest! {
    #![proptest_config(cases(96))]
    #[test]
    fn the_complexity_is_met_within_limits_and_graded(
        [a, b] in [hessians(64), hessians(64)],
        limits in limits(),
        gradation_factor in prop_oneof![Just(None), (1.05..2.0_f64).prop_map(Some)],
    ) {
        let mesh = grid(7, 0.3);
        // Sizes of 0.05 everywhere.
        let target = 1.0 / (0.05 * 0.05);
        let pipeline = Pipeline { target_complexity: Some(target), limits, gradation_factor, ..Pipeline::default() };
        let found = pipeline.run(&mesh, &[Source::Hessian(a), Source::Hessian(b)]).unwrap();
        prop_assert!((complexity(&mesh, &found.tensors) / target - 1.0).abs() < MET, "{}", found.complexity);
        for (v, m) in found.tensors.iter().enumerate() {
            let (bounds, e) = (pipeline.limits.at(v), m.eigen());
            let [shorter, longer] = [e.large, e.small].map(|value| 1.0 / value.sqrt());
            prop_assert!(bounds.h_min.is_none_or(|h| shorter >= h * (1.0 - MET)), "{shorter} at {v}");
            prop_assert!(bounds.h_max.is_none_or(|h| longer <= h * (1.0 + MET)), "{longer} at {v}");
            prop_assert!(bounds.a_max.is_none_or(|a| longer <= a * shorter * (1.0 + MET)), "{longer} at {v}");
        }
        if let (Some(factor), true) = (gradation_factor, pipeline.limits == Limits::default()) {
            prop_assert_eq!(grade(&mesh, &found.tensors, factor).unwrap(), found.tensors);
        }
    }
}

#[test]
fn without_limits_it_is_normalisation() {
    let mesh = grid(16, 0.2);
    let pipeline = Pipeline { target_complexity: Some(500.0), ..Pipeline::default() };
    let found = pipeline.run(&mesh, &[Source::Hessian(layer(&mesh, 0.1))]).unwrap();
    let normalised = scaled_to(&mesh, &weighted(&layer(&mesh, 0.1), Norm::default()).unwrap(), 500.0).unwrap();
    assert_eq!(found.tensors, normalised);
    assert_eq!((found.factor.to_bits(), found.touched), (1.0_f64.to_bits(), Touched::default()));
}

#[test]
fn without_a_target_nothing_is_scaled() {
    let mesh = grid(4, 0.0);
    let given = vec![Tensor::new(9.0, 1.0, 4.0); 25];
    let found = Pipeline::default().run(&mesh, &[Source::Metric(given.clone())]).unwrap();
    assert_eq!((found.tensors, found.factor.to_bits()), (given, 1.0_f64.to_bits()));
    assert!((found.complexity - 35_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn what_limits_forbid_is_said_with_what_they_allow() {
    let mesh = grid(16, 0.2);
    let says = |bounds: Bounds, target, words: &str| {
        let pipeline = Pipeline {
            target_complexity: Some(target),
            limits: bounds.into(),
            gradation_factor: Some(1.3),
            ..Pipeline::default()
        };
        let error = pipeline.run(&mesh, &[Source::Hessian(layer(&mesh, 0.1))]).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    };
    let none = Bounds::default();
    says(
        Bounds { h_min: Some(0.1), ..none },
        101.0,
        "limit exceeded: a complexity of 101: within the limits it is at most 1.000000e2",
    );
    says(Bounds { h_max: Some(0.1), ..none }, 99.0, "within the limits it is at least 1.000000e2");
    says(none, 0.0, "complexity: 0 is no complexity");
    says(Bounds { h_min: Some(-1.0), ..none }, 9.0, "h_min = -1");
}

#[test]
fn touched_vertices_are_counted() {
    let mesh = grid(4, 0.0);
    let sizes: Vec<f64> = mesh.points.iter().map(|p| if p[0] < 0.1 { 0.01 } else { 1.0 }).collect();
    let source = Source::Metric(super::super::isotropic(&mesh, &sizes).unwrap());
    let bounds = Bounds { h_min: Some(0.02), h_max: Some(0.5), a_max: None };
    let pipeline = Pipeline { limits: bounds.into(), gradation_factor: Some(1.5), ..Pipeline::default() };
    let found = pipeline.run(&mesh, std::slice::from_ref(&source)).unwrap();
    // Five vertices on the left; 0.02 + ln(1.5) x is below 0.5 everywhere.
    assert_eq!(found.touched, Touched { h_min: 5, h_max: 20, a_max: 0, gradation: 20 });
    let a_max = Some(Limit::Number(3.0));
    let wide = Source::Metric(vec![Tensor::new(100.0, 0.0, 1.0); 25]);
    let pipeline = Pipeline { limits: Limits { a_max, ..Limits::default() }, ..Pipeline::default() };
    assert_eq!(pipeline.run(&mesh, &[wide]).unwrap().touched, Touched { a_max: 25, ..Touched::default() });
}

#[test]
fn sources_of_any_units_count_alike() {
    let mesh = grid(16, 0.2);
    let [a, b] = [layer(&mesh, 0.1), tensors_at(&mesh, |p| Tensor::new(1.0 + 10.0 * p.x, 0.0, 2.0))];
    let scaled: Vec<Tensor> = b.iter().map(|&h| h * 1e6).collect();
    for combination in [Combination::Intersect, Combination::Average(vec![1.0, 3.0])] {
        let pipeline = Pipeline { target_complexity: Some(900.0), combination, ..Pipeline::default() };
        let plain = pipeline.run(&mesh, &[Source::Hessian(a.clone()), Source::Hessian(b.clone())]).unwrap();
        let other = pipeline.run(&mesh, &[Source::Hessian(a.clone()), Source::Hessian(scaled.clone())]).unwrap();
        assert!(plain.tensors.iter().zip(&other.tensors).all(|(m, n)| (m.xx / n.xx - 1.0).abs() < 1e-6));
    }
}

/// mesh-adaptation/animate#178, where a complexity of 1,000 becomes one of 10^9.
#[test]
fn functions_of_one_direction_keep_to_the_complexity() {
    let mesh = grid(10, 0.0);
    let bounds = Bounds { h_min: Some(1e-5), h_max: Some(0.2), a_max: Some(10.0) };
    let pipeline = Pipeline { target_complexity: Some(1000.0), limits: bounds.into(), ..Pipeline::default() };
    let found = pipeline.run(&mesh, &[Source::Hessian(vec![Tensor::new(100.0, 0.0, 0.0); 121])]).unwrap();
    assert!((found.complexity / 1000.0 - 1.0).abs() < MET);
    // The anisotropy is the greatest allowed: 1 / (h 10 h) = 1000.
    assert!(found.tensors.iter().all(|m| (m.xx / 1e4 - 1.0).abs() < 1e-5 && (m.yy / 1e2 - 1.0).abs() < 1e-5));
}
