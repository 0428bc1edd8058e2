//! Orders of convergence, exactness, and what few vertices tell.

use super::super::nodal::test_meshes::grid;
use super::*;
use crate::geometry::{Point, Vector};
use crate::test_cases::cases;
use proptest::prelude::*;

/// A function with its second derivatives.
type Known = (fn(Point) -> f64, fn(Point) -> Tensor);

const SMOOTH: Known = (
    |p| (3.0 * p.x + 1.0).sin() * (2.0 * p.y).cos() + p.x * p.x * p.y,
    |p| {
        let ((s, c), (t, d)) = ((3.0 * p.x + 1.0).sin_cos(), (2.0 * p.y).sin_cos());
        Tensor::new(-9.0 * s * d + 2.0 * p.y, -6.0 * c * t + 2.0 * p.x, -4.0 * s * d)
    },
);

/// A layer at x = 0, in units in which its second derivative there is one.
const LAYER: Known = (|p| WIDTH * WIDTH * (-p.x / WIDTH).exp(), |p| Tensor::new((-p.x / WIDTH).exp(), 0.0, 0.0));
const WIDTH: f64 = 0.02;

fn values(mesh: &Mesh, f: impl Fn(Point) -> f64) -> Vec<f64> {
    (0..mesh.points.len() as u32).map(|v| f(mesh.point(v))).collect()
}

fn norm(h: Tensor) -> f64 {
    (h.xx * h.xx + 2.0 * h.xy * h.xy + h.yy * h.yy).sqrt()
}

/// The root mean square of the errors at the vertices inside, of those at the border, and the greatest.
fn errors(mesh: &Mesh, (f, hessian): Known, recovery: Recovery) -> [f64; 3] {
    let found = recover_hessian(mesh, &values(mesh, f), recovery).unwrap();
    let (mut sums, mut counts, mut greatest) = ([0.0; 2], [0.0; 2], 0.0_f64);
    for (v, h) in found.into_iter().enumerate() {
        let error = norm(h + hessian(mesh.point(v as u32)) * -1.0);
        let [x, y, _] = mesh.points[v];
        let side = usize::from(x * (1.0 - x) * y * (1.0 - y) == 0.0);
        sums[side] += error * error;
        counts[side] += 1.0;
        greatest = greatest.max(error);
    }
    [(sums[0] / counts[0]).sqrt(), (sums[1] / counts[1]).sqrt(), greatest]
}

/// Between a mesh and one four times as fine: the orders by which errors fall.
fn orders(mesh: impl Fn(u32) -> Mesh, known: Known, recovery: Recovery) -> [f64; 3] {
    let [coarse, fine] = [32, 128].map(|n| errors(&mesh(n), known, recovery));
    [0, 1, 2].map(|i| 0.5 * (coarse[i] / fine[i]).log2())
}

/// Columns that become narrower towards x = 0: the layer has as many of them as the rest.
fn graded(n: u32, jitter: f64) -> Mesh {
    let mut mesh = grid(n, jitter);
    for [x, ..] in &mut mesh.points {
        *x = (4.0 * *x).exp_m1() / 4_f64.exp_m1();
    }
    mesh
}

#[test]
fn fits_converge_with_second_order_where_stencils_are_symmetric_and_else_with_first() {
    // A quadratic errs by the third derivatives times the size; of a stencil that is its own mirror image these cancel.
    let [inside, border, greatest] = orders(|n| grid(n, 0.0), SMOOTH, Recovery::Fit);
    assert!(inside > 1.95 && border > 0.95 && greatest > 0.95, "{inside} {border} {greatest}");
    let [inside, border, _] = orders(|n| grid(n, 0.4), SMOOTH, Recovery::Fit);
    assert!(inside > 0.95 && border > 0.9, "{inside} {border}");
}

#[test]
fn fits_converge_on_anisotropic_meshes_of_layers() {
    let [inside, border, _] = orders(|n| graded(n, 0.0), LAYER, Recovery::Fit);
    assert!(inside > 1.9 && border > 0.95, "{inside} {border}");
    let [inside, border, _] = orders(|n| graded(n, 0.4), LAYER, Recovery::Fit);
    assert!(inside > 0.9 && border > 0.9, "{inside} {border}");
    // A few triangles across the layer.
    let [inside, border, greatest] = errors(&graded(16, 0.4), LAYER, Recovery::Fit);
    assert!(inside < 0.04 && border < 0.2 && greatest < 0.4, "{inside} {border} {greatest}");
}

#[test]
fn projections_converge_on_even_meshes_and_stay_bounded_on_others() {
    // Averages of gradients are of second order at the centre of a symmetric star, and so are those of their derivatives; the
    // vertices next to the border see gradients there that are extrapolated, which costs one order.
    let [inside, border, greatest] = orders(|n| grid(n, 0.0), SMOOTH, Recovery::L2);
    assert!(inside > 1.4 && border > 0.95 && greatest > 0.9, "{inside} {border} {greatest}");
    // On others gradients are of first order only, and their derivatives of none.
    let [[coarse, ..], [fine, ..]] = [32, 64].map(|n| errors(&grid(n, 0.4), SMOOTH, Recovery::L2));
    let size = 9.0;
    assert!(coarse < 0.2 * size && fine < 0.2 * size, "{coarse} {fine}");
}

fn quadratic([a, b, c]: [f64; 3]) -> impl Fn(Vector) -> f64 {
    move |d| 0.5 * (a * d.x * d.x + 2.0 * b * d.x * d.y + c * d.y * d.y)
}

proptest! {
    #![proptest_config(cases(48))]

    /// On the image of a square under any map with stretches of up to a thousand, in units of any size.
    #[test]
    fn fits_are_exact_for_quadratics(
        entries in proptest::array::uniform3(-1.0..1.0_f64),
        stretch in 0.0..3.0_f64,
        angle in 0.0..6.3_f64,
        unit in -9.0..9.0_f64,
        value in -9.0..9.0_f64,
    ) {
        let (unit, value, stretch) = (10_f64.powf(unit), 10_f64.powf(value), 10_f64.powf(stretch));
        let mut mesh = grid(6, 0.4);
        let (f, axis) = (quadratic(entries), Vector::new(angle.cos(), angle.sin()));
        let values = values(&mesh, |p| value * (f(p - Point::new(0.3, 0.4)) + 0.3 * p.x - 2.0));
        for [x, y, _] in &mut mesh.points {
            let moved = axis * (*x * stretch) + axis.perpendicular() * *y;
            (*x, *y) = (unit * moved.x, unit * moved.y);
        }
        for h in recover_hessian(&mesh, &values, Recovery::Fit).unwrap() {
            // Seen from the square.
            let (p, q) = (axis * (stretch * unit / value), axis.perpendicular() * unit);
            let back = [h.dot(p, axis) * stretch * unit, h.dot(p, q), h.dot(q, q) * (1.0 / value)];
            let close = back.iter().zip(entries).all(|(found, truth)| (found - truth).abs() < 1e-8);
            prop_assert!(close, "{back:?} {entries:?}");
        }
    }

    #[test]
    fn linear_functions_add_nothing(slope in proptest::array::uniform2(-3.0..3.0_f64), shift in -10.0..10.0_f64) {
        let mesh = grid(8, 0.4);
        let (f, _) = SMOOTH;
        let plain = values(&mesh, f);
        let tilted = values(&mesh, |p| f(p) + slope[0] * p.x + slope[1] * p.y + shift);
        for recovery in [Recovery::L2, Recovery::Fit] {
            let found = recover_hessian(&mesh, &plain, recovery).unwrap();
            let other = recover_hessian(&mesh, &tilted, recovery).unwrap();
            prop_assert!(found.into_iter().zip(other).all(|(g, h)| norm(g + h * -1.0) < 1e-10));
        }
    }
}

#[test]
fn projections_are_exact_for_quadratics_on_even_meshes() {
    let f = quadratic([2.0, -3.0, 5.0]);
    let mesh = grid(8, 0.0);
    for h in recover_hessian(&mesh, &values(&mesh, |p| f(p - Point::new(0.3, 0.4))), Recovery::L2).unwrap() {
        assert!(norm(h + Tensor::new(-2.0, 3.0, -5.0)) < 1e-10, "{h:?}");
    }
}

#[test]
fn what_few_vertices_determine_is_found_and_the_rest_is_finite() {
    let square = grid(1, 0.0);
    let triangle = Mesh { triangles: vec![[0, 1, 3]], ..square.clone() };
    for recovery in [Recovery::L2, Recovery::Fit] {
        // Three points, two of them alone: linear.
        let found = recover_hessian(&triangle, &values(&triangle, |p| 2.0 * p.x - p.y), recovery).unwrap();
        assert!(found.iter().all(|&h| norm(h) < 1e-12), "{recovery}: {found:?}");
        // Four: what is finite.
        let found = recover_hessian(&square, &values(&square, |p| p.x * p.y), recovery).unwrap();
        assert!(found.iter().all(|&h| norm(h).is_finite() && norm(h) < 3.0), "{recovery}: {found:?}");
    }
    // A strip of one row tells x^2, and nothing of y^2.
    let mut strip = grid(6, 0.0);
    strip.triangles.retain(|&[a, b, c]| a.max(b).max(c) < 14);
    let found = recover_hessian(&strip, &values(&strip, |p| p.x * p.x + p.y), Recovery::Fit).unwrap();
    assert!(found[..14].iter().all(|h| (h.xx - 2.0).abs() < 1e-9 && h.yy.is_finite()), "{found:?}");
    assert!(found[14..].iter().all(|&h| h == Tensor::default()));
}

#[test]
fn parts_do_not_see_each_other() {
    let mut mesh = grid(6, 0.2);
    let (count, triangles) = (mesh.points.len() as u32, mesh.triangles.clone());
    let moved: Vec<[f64; 3]> = mesh.points.iter().map(|&[x, y, z]| [x + 1.0, y, z]).collect();
    mesh.points.extend(moved);
    mesh.triangles.extend(triangles.iter().map(|t| t.map(|v| v + count)));
    let mut jump = values(&mesh, |p| p.x * p.x);
    jump[count as usize..].iter_mut().for_each(|value| *value = -*value + 100.0);
    let found = recover_hessian(&mesh, &jump, Recovery::Fit).unwrap();
    let (first, second) = found.split_at(count as usize);
    assert!(first.iter().all(|&h| norm(h + Tensor::new(-2.0, 0.0, 0.0)) < 1e-9));
    assert!(second.iter().all(|&h| norm(h + Tensor::new(2.0, 0.0, 0.0)) < 1e-9));
}

#[test]
fn what_is_no_solution_is_named() {
    let mesh = grid(1, 0.0);
    let says = |values: &[f64], words: &str| {
        let error = recover_hessian(&mesh, values, Recovery::Fit).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    };
    says(&[1.0; 3], "3 values for 4 vertices");
    says(&[1.0, 2.0, f64::INFINITY, 0.0], "value inf is not finite at vertex 3 (0, 1)");
    assert!("L2".parse::<Recovery>().is_err() && "l2".parse::<Recovery>().unwrap() == Recovery::L2);
    assert_eq!(Recovery::default().to_string().parse::<Recovery>().unwrap(), Recovery::Fit);
}
