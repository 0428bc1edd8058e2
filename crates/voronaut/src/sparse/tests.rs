//! Factors, orders and conjugate gradients together.

use super::*;
use crate::test_cases::cases;
use proptest::prelude::*;

/// The Laplacian of a square grid, and something on the diagonal.
fn grid(side: u32, diagonal: f64) -> Symmetric {
    let mut entries = Vec::new();
    for v in 0..side * side {
        let joined = [(v % side > 0).then(|| v - 1), v.checked_sub(side)];
        for u in joined.into_iter().flatten() {
            entries.extend([(v, u, -1.0), (v, v, 1.0), (u, u, 1.0)]);
        }
    }
    let size = (side * side) as usize;
    Symmetric::from_triplets(size, &entries).plus_diagonal(&vec![diagonal; size])
}

/// A matrix with more on the diagonal than beside it, by up to ten orders of magnitude; in parts, and with rows that are empty
/// beside the diagonal.
fn definite() -> impl Strategy<Value = Symmetric> {
    let entry = |size: u32| (0..size, 0..size, -1.0..1.0, -5_i32..5);
    (1_u32..60).prop_flat_map(move |size| {
        proptest::collection::vec(entry(size), 0..150).prop_map(move |entries| {
            let beside = entries
                .iter()
                .map(|&(i, j, value, power): &(u32, u32, f64, i32)| (i.max(j), i.min(j), value * 10_f64.powi(power)));
            let on = |(i, j, value): (u32, u32, f64)| {
                [(i, j, value), (i, i, 1.01 * value.abs()), (j, j, 1.01 * value.abs())]
            };
            let entries: Vec<_> = beside.filter(|&(i, j, _)| i != j).flat_map(on).collect();
            Symmetric::from_triplets(size as usize, &entries).plus_diagonal(&vec![1e-5; size as usize])
        })
    })
}

fn is_permutation(order: &[u32], size: usize) -> bool {
    let mut sorted = order.to_vec();
    sorted.sort_unstable();
    sorted.into_iter().eq(0..size as u32)
}

/// The greatest residual, as a share of what it is the rounding of.
fn residual(matrix: &Symmetric, values: &[f64], right: &[f64]) -> f64 {
    let greatest = |v: &[f64]| v.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let norm = (0..matrix.size()).map(|i| matrix.row(i).map(|(_, a)| a.abs()).sum()).fold(0.0, f64::max);
    let missing: Vec<f64> = matrix.times(values).iter().zip(right).map(|(a, b)| a - b).collect();
    greatest(&missing) / (norm * greatest(values) + greatest(right))
}

proptest! {
    #![proptest_config(cases(256))]
    #[test]
    fn factors_solve_to_rounding_in_any_order(matrix in definite(), turn in 0_usize..60, unit in -1.0..1.0) {
        let right: Vec<f64> = (0..matrix.size()).map(|i| unit + (i as f64).sin()).collect();
        let mut natural: Vec<u32> = (0..matrix.size() as u32).collect();
        natural.rotate_left(turn % matrix.size());
        let dissected = Elimination::of(&matrix);
        prop_assert!(is_permutation(&nested_dissection(&matrix), matrix.size()));
        for elimination in [dissected, Elimination::in_order(&matrix, natural)] {
            let found = Cholesky::of(&matrix, &elimination).unwrap().solve(&right);
            prop_assert!(residual(&matrix, &found, &right) < 1e-14);
        }
    }

    #[test]
    fn a_negative_eigenvalue_is_refused(matrix in definite(), row in 0_usize..60) {
        let mut down = vec![0.0; matrix.size()];
        let row = row % matrix.size();
        down[row] = -1.001 * matrix.diagonal()[row];
        let indefinite = matrix.plus_diagonal(&down);
        prop_assert!(Cholesky::of(&indefinite, &Elimination::of(&indefinite)).is_none());
    }
}

#[test]
fn entries_of_one_place_are_summed_and_the_upper_half_is_the_lower_one() {
    let entries = [(1, 0, 2.0), (0, 1, 7.0), (2, 2, 1.0), (1, 0, 0.5), (2, 2, 3.0), (2, 1, -1.0), (3, 0, 4.0)];
    let matrix = Symmetric::from_triplets(5, &entries);
    let rows: Vec<Vec<(usize, f64)>> = (0..5).map(|i| matrix.row(i).collect()).collect();
    assert_eq!(rows[0], [(0, 0.0), (1, 2.5), (3, 4.0)]);
    assert_eq!(rows[1], [(0, 2.5), (1, 0.0), (2, -1.0)]);
    assert_eq!(rows[2], [(1, -1.0), (2, 4.0)]);
    assert_eq!(rows[4], [(4, 0.0)]);
    assert_eq!(matrix.diagonal(), [0.0, 0.0, 4.0, 0.0, 0.0]);
    assert_eq!(matrix.times(&[1.0, 2.0, 3.0, 4.0, 5.0]), [21.0, -0.5, 10.0, 4.0, 0.0]);
}

#[test]
fn matrices_that_are_not_positive_definite_are_refused() {
    let refused = |matrix: &Symmetric| Cholesky::of(matrix, &Elimination::of(matrix)).is_none();
    assert!(refused(&Symmetric::from_triplets(3, &[(0, 0, 1.0), (1, 1, 1.0)])), "singular");
    assert!(refused(&grid(9, -1e-3)), "a constant has negative energy");
    assert!(refused(&grid(9, f64::NAN)) && refused(&grid(9, f64::INFINITY)));
    assert!(!refused(&grid(9, 1e-3)));
    assert!(!refused(&Symmetric::from_triplets(0, &[])), "no rows, no pivots");
}

#[test]
fn dissection_fills_a_grid_little() {
    let matrix = grid(60, 0.0);
    let natural = Elimination::in_order(&matrix, (0..3600).collect()).entries();
    assert!(natural > 3500 * 60, "a band: {natural}");
    let dissected = Elimination::of(&matrix).entries();
    assert!(dissected < natural * 3 / 10, "{dissected} of {natural}");
    let larger = Elimination::of(&grid(240, 0.0)).entries();
    assert!(larger < 25 * dissected, "n log n, not n^1.5: {larger} after {dissected}");
}

/// Graphs that have no short cuts, or nothing to cut, or levels of one vertex.
#[test]
fn any_graph_is_put_in_an_order() {
    let size = 3000;
    let star = |hub: u32| -> Vec<(u32, u32)> { (0..size).map(|v| (v.max(hub), v.min(hub))).collect() };
    let path: Vec<(u32, u32)> = (1..size).map(|v| (v, v - 1)).collect();
    let complete: Vec<(u32, u32)> = (0..60).flat_map(|i| (0..i).map(move |j| (i, j))).collect();
    let wheel = [star(7), path.clone()].concat();
    for (edges, most) in
        [(star(7), 2 * size), (path, 3 * size), (wheel, 5 * size), (complete, 5000), (Vec::new(), size)]
    {
        let entries: Vec<_> = edges.into_iter().map(|(i, j)| (i, j, 1.0)).collect();
        let matrix = Symmetric::from_triplets(size as usize, &entries);
        let order = nested_dissection(&matrix);
        assert!(is_permutation(&order, size as usize));
        let entries = Elimination::in_order(&matrix, order).entries();
        assert!(entries <= most as usize, "{entries} of {most}");
    }
}

/// On a long line the solution for a source at its end is sinh(t (n - i)), which falls to 1e-280.
#[test]
fn factors_keep_the_relative_accuracy_of_small_values() {
    let (n, t) = (300_u32, 2.15_f64);
    let line: Vec<_> = (1..n).map(|i| (i, i - 1, -1.0)).collect();
    let matrix = Symmetric::from_triplets(n as usize, &line).plus_diagonal(&vec![2.0 * t.cosh(); n as usize]);
    let mut right = vec![0.0; n as usize];
    right[0] = 1.0;
    let exact = |i: u32| {
        (-t * f64::from(i + 1)).exp() * (-2.0 * t * f64::from(n - i)).exp_m1() / (-2.0 * t * f64::from(n + 1)).exp_m1()
    };
    let worst = |found: &[f64]| (0..n).map(|i| (found[i as usize] / exact(i) - 1.0).abs()).fold(0.0, f64::max);
    assert!(exact(n - 1) < 1e-279);
    let by_factor = Cholesky::of(&matrix, &Elimination::of(&matrix)).unwrap().solve(&right);
    assert!(worst(&by_factor) < 1e-12, "{}", worst(&by_factor));
    let guess = vec![0.0; n as usize];
    let by_gradients = conjugate_gradients(|x| matrix.times(x), &matrix.diagonal(), &right, guess, 1000);
    assert!(residual(&matrix, &by_gradients, &right) < 1e-15 && worst(&by_gradients) > 0.5, "small ones are lost");
}

#[test]
fn conjugate_gradients_solve_what_is_near_its_diagonal() {
    // The mass matrix of two triangles per square, of sizes that differ by 1e6; the last vertex has no area.
    let (side, mut entries) = (20_u32, Vec::new());
    let mut triangle = |corners: [u32; 3], area: f64| {
        for i in corners {
            entries.extend(corners.map(|j| (i, j, if i == j { area / 6.0 } else { area / 12.0 })));
        }
    };
    for v in (0..side * (side - 1)).filter(|v| v % side + 1 < side) {
        let area = 10_f64.powf(f64::from(v % 7));
        triangle([v, v + 1, v + side], area);
        triangle([v + 1, v + side + 1, v + side], 2.0 * area);
    }
    let size = (side * side) as usize;
    let matrix = Symmetric::from_triplets(size + 1, &entries);
    let exact: Vec<f64> = (0..=size).map(|i| (i as f64).cos()).collect();
    let mut guess = vec![0.0; size];
    guess.push(exact[size]);
    let found = conjugate_gradients(|x| matrix.times(x), &matrix.diagonal(), &matrix.times(&exact), guess, 60);
    assert!(found.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-12));
}
