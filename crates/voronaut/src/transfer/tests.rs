//! Laws of transfer: what comes back, what is kept, how errors fall.

use super::mass::areas;
use super::*;
use crate::geometry::{Point, Tensor, Vector};
use crate::metric::{MetricField, Sampled};
use crate::sparse::dot;
use crate::test_cases::cases;
use proptest::prelude::*;
use std::f64::consts::TAU;

type Carry = fn(&Mesh, &Mesh, &[Field]) -> Result<(Vec<Carried>, Cover)>;

const ALL: [Carry; 3] =
    [interpolate, |o, n, f| conservative(o, n, f, Overshoot::Spread), |o, n, f| conservative(o, n, f, Overshoot::Kept)];

/// The unit square as 2 n^2 triangles of mixed orientation and diagonals; vertices inside moved by up to `wobble` of a side.
fn square(n: u32, wobble: f64, seed: f64) -> Mesh {
    let step = 1.0 / f64::from(n);
    let noise = |i: u32, j: u32| {
        let is_inside = !(i.is_multiple_of(n) || j.is_multiple_of(n));
        wobble * step * (f64::from(i * 7 + j * 13) * 1.7 + seed).sin() * f64::from(u8::from(is_inside))
    };
    let position = |k: u32| {
        let (i, j) = (k % (n + 1), k / (n + 1));
        [f64::from(i) * step + noise(i, j), f64::from(j) * step + noise(j, i), 0.0]
    };
    let cell = |k: u32| {
        let a = k % n + k / n * (n + 1);
        let (b, c, d) = (a + 1, a + n + 1, a + n + 2);
        if (k + seed as u32).is_multiple_of(3) { [[a, b, c], [b, c, d]] } else { [[a, b, d], [a, c, d]] }
    };
    Mesh {
        points: (0..(n + 1) * (n + 1)).map(position).collect(),
        triangles: (0..n * n).flat_map(cell).collect(),
        ..Mesh::default()
    }
}

/// A fan of rings around the origin, its border a regular polygon of `n` corners, which is turned.
fn disk(n: u32, turn: f64) -> Mesh {
    let rings = n / 6;
    let mut mesh = Mesh { points: vec![[0.0; 3]], ..Mesh::default() };
    for ring in 1..=rings {
        for i in 0..n {
            let (r, angle) = (f64::from(ring) / f64::from(rings), turn + TAU * f64::from(i) / f64::from(n));
            mesh.points.push([r * angle.cos(), r * angle.sin(), 0.0]);
            let at = |ring: u32, i: u32| if ring == 0 { 0 } else { 1 + (ring - 1) * n + i % n };
            mesh.triangles.push([at(ring - 1, i), at(ring, i), at(ring, i + 1)]);
            if ring > 1 {
                mesh.triangles.push([at(ring - 1, i), at(ring, i + 1), at(ring - 1, i + 1)]);
            }
        }
    }
    mesh
}

fn moved(mut mesh: Mesh, scale: f64, turn: f64, shift: Vector) -> Mesh {
    for p in &mut mesh.points {
        let (x, y) = (p[0] * turn.cos() - p[1] * turn.sin(), p[0] * turn.sin() + p[1] * turn.cos());
        *p = [scale * (x + shift.x), scale * (y + shift.y), 0.0];
    }
    mesh
}

/// Every triangle cut into four.
fn refined(mesh: &Mesh) -> Mesh {
    let mut fine = Mesh { points: mesh.points.clone(), ..Mesh::default() };
    for &[a, b, c] in &mesh.triangles {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(p, q)| {
            let m = mesh.point(p.min(q)).midpoint(mesh.point(p.max(q)));
            let known = fine.points.iter().position(|p| p.map(f64::to_bits) == [m.x, m.y, 0.0].map(f64::to_bits));
            known.unwrap_or_else(|| {
                fine.points.push([m.x, m.y, 0.0]);
                fine.points.len() - 1
            }) as u32
        });
        fine.triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    fine
}

fn sampled(mesh: &Mesh, f: impl Fn(Point) -> f64) -> Field {
    let values = (0..mesh.points.len() as u32).map(|v| f(mesh.point(v))).collect();
    Field { place: Place::Vertices, kind: Kind::Linear(1), values }
}

fn on_triangles(mesh: &Mesh, f: impl Fn(Point) -> f64) -> Field {
    let centroid = |t: &[u32; 3]| {
        let [a, b, c] = mesh.corners_of(*t);
        a + ((b - a) + (c - a)) * (1.0 / 3.0)
    };
    let values = mesh.triangles.iter().map(|t| f(centroid(t))).collect();
    Field { place: Place::Triangles, kind: Kind::Linear(1), values }
}

/// Something without any order, between 0 and 1.
fn rough(p: Point) -> f64 {
    (9e4 * (12.9 * p.x + 78.2 * p.y).sin()).rem_euclid(1.0)
}

/// A front that is steep even between two vertices.
fn front(p: Point) -> f64 {
    f64::from(u8::from(p.x + 0.4 * p.y > 0.613))
}

fn worst(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// The least of all heights of triangles.
fn least_height(mesh: &Mesh) -> f64 {
    let height = |(t, area): (&[u32; 3], f64)| {
        let [a, b, c] = mesh.corners_of(*t);
        2.0 * area / a.distance(b).max(b.distance(c)).max(c.distance(a))
    };
    mesh.triangles.iter().zip(areas(mesh)).map(height).fold(f64::INFINITY, f64::min)
}

/// The mass as a share of the mass of magnitudes.
fn drift(carried: &Carried, mesh: &Mesh) -> f64 {
    let size = areas(mesh).iter().sum::<f64>() * carried.before[0].max.abs().max(carried.before[0].min.abs());
    (carried.after[0].mass - carried.before[0].mass).abs() / size
}

/// The L2 norm of the difference of a field and a function, by a rule of degree five on every triangle's quarters.
fn distance(mesh: &Mesh, field: &Field, f: impl Fn(Point) -> f64) -> f64 {
    let mut sum = 0.0;
    for (&t, area) in mesh.triangles.iter().zip(areas(mesh)) {
        let ([a, b, c], [fa, fb, fc]) = (mesh.corners_of(t), t.map(|v| field.values[v as usize]));
        for i in 0..8 {
            for j in 0..8 - i {
                let (s, t) = ((f64::from(i) + 1.0 / 3.0) / 8.0, (f64::from(j) + 1.0 / 3.0) / 8.0);
                let u = fa + s * (fb - fa) + t * (fc - fa);
                sum += area / 36.0 * (u - f(a + (b - a) * s + (c - a) * t)).powi(2);
            }
        }
    }
    sum.sqrt()
}

#[test]
fn the_same_mesh_gives_values_back() {
    for mesh in [square(7, 0.4, 0.3), moved(square(7, 0.4, 1.3), 1e-9, 0.7, Vector::new(0.3, 5.0)), disk(24, 0.1)] {
        let fields = [sampled(&mesh, rough), on_triangles(&mesh, rough), sampled(&mesh, front)];
        for carry in ALL {
            let (carried, cover) = carry(&mesh, &mesh, &fields).unwrap();
            for (field, carried) in fields.iter().zip(&carried) {
                assert!(
                    worst(&field.values, &carried.field.values) < 1e-11,
                    "{}",
                    worst(&field.values, &carried.field.values)
                );
            }
            assert_eq!(cover.outside, 0);
        }
        assert_eq!(interpolate(&mesh, &mesh, &fields).unwrap().0[0].field, fields[0]);
    }
}

#[test]
fn a_refinement_has_the_same_field() {
    let old = square(5, 0.4, 0.3);
    let new = refined(&old);
    let field = sampled(&old, rough);
    let truth = interpolate(&old, &new, std::slice::from_ref(&field)).unwrap().0.remove(0).field;
    assert_eq!(truth.values[..field.values.len()], field.values);
    for carry in ALL {
        let (carried, _) = carry(&old, &new, std::slice::from_ref(&field)).unwrap();
        assert!(worst(&carried[0].field.values, &truth.values) < 1e-12);
    }
    // And what is constant on triangles is so on their quarters.
    let (carried, _) = conservative(&old, &new, &[on_triangles(&old, rough)], Overshoot::Spread).unwrap();
    let quarters = on_triangles(&old, rough).values.into_iter().flat_map(|u| [u; 4]).collect::<Vec<f64>>();
    assert!(worst(&carried[0].field.values, &quarters) < 1e-12);
}

proptest! {
    #![proptest_config(cases(40))]

    #[test]
    fn linear_functions_are_reproduced_and_masses_kept(
        sides in (3_u32..14, 3_u32..14), seeds in (0.0..9.0, 0.0..9.0), power in -9_i32..10, turn in 0.0..6.3,
        shift in (-3.0..3.0, -3.0..3.0), slope in (-2.0..2.0, -2.0..2.0), squeeze in prop_oneof![Just(1.0), Just(1e-4)],
        grade in prop_oneof![Just(1), Just(5)],
    ) {
        let scale = 10.0_f64.powi(power);
        let place = |mut mesh: Mesh| {
            mesh.points.iter_mut().for_each(|p| p[1] *= squeeze);
            moved(mesh, scale, turn, Vector::new(shift.0, shift.1))
        };
        // Graded meshes have thin triangles, flat in the one and upright in the other.
        let wobble = if grade > 1 { 0.0 } else { 0.4 };
        let (mut old, mut new) = (square(sides.0, wobble, seeds.0), square(sides.1, wobble, seeds.1));
        old.points.iter_mut().for_each(|p| p[1] = p[1].powi(grade));
        new.points.iter_mut().for_each(|p| p[0] = p[0].powi(grade));
        let (old, new) = (place(old), place(new));
        let linear = |p: Point| 1.0 + (slope.0 * p.x + slope.1 * p.y) / scale;
        // Rounded coordinates move the borders of both meshes, and so much of the thinnest triangle there is not covered; that part
        // of what the function differs by on it is missing from its load.
        let size = |mesh: &Mesh| mesh.points.as_flattened().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let rounding = f64::EPSILON * size(&old) / least_height(&old).min(least_height(&new));
        let fields = [sampled(&old, linear), sampled(&old, |p| rough(p) - 0.5), on_triangles(&old, rough)];
        for (i, carry) in ALL.into_iter().enumerate() {
            let (carried, cover) = carry(&old, &new, &fields).unwrap();
            let error = worst(&carried[0].field.values, &sampled(&new, linear).values);
            prop_assert!(error < 1e-13 + rounding, "{error}, {rounding} of rounding");
            prop_assert!(i == 0 || carried.iter().all(|c| drift(c, &new) < 1e-13), "{carried:?}");
            prop_assert_eq!(cover.outside, 0);
            prop_assert!(cover.areas.is_none_or(|s| s.uncovered == 0.0 && s.left == 0.0 && s.overlapped == 0.0), "{cover:?}");
        }
    }

    #[test]
    fn bounds_are_kept(sides in (3_u32..14, 3_u32..14), seeds in (0.0..9.0, 0.0..9.0), is_rough in any::<bool>()) {
        let (old, new) = (square(sides.0, 0.4, seeds.0), square(sides.1, 0.4, seeds.1));
        let field = sampled(&old, |p| if is_rough { rough(p) } else { front(p) });
        let (carried, _) = conservative(&old, &new, &[field.clone(), on_triangles(&old, rough)], Overshoot::Spread).unwrap();
        let bounds = bounds_by_triangles(&old, &new, &field);
        for (u, (low, high)) in carried[0].field.values.iter().zip(bounds) {
            prop_assert!((low - 1e-14..=high + 1e-14).contains(u), "{low} {u} {high}");
        }
        prop_assert!(carried[1].after[0].min >= carried[1].before[0].min - 1e-14);
        prop_assert!(carried[1].after[0].max <= carried[1].before[0].max + 1e-14);
        prop_assert!(carried.iter().all(|c| drift(c, &new) < 1e-13));
    }

    #[test]
    fn an_intersection_is_the_same_from_both_sides(all in prop::collection::vec((-1.0..1.0, -1.0..1.0), 6)) {
        let p: Vec<Point> = all.into_iter().map(|(x, y)| Point::new(x, y)).collect();
        let (a, b) = ([p[0], p[1], p[2]], [p[3], p[4], p[5]]);
        let area = |t: [Point; 3]| (t[1] - t[0]).cross(t[2] - t[0]).abs();
        prop_assume!(area(a) > 1e-3 && area(b) > 1e-3);
        let (there, back) = (clip::Frame::new(a).unwrap().overlap(b), clip::Frame::new(b).unwrap().overlap(a));
        let products = |found: &Option<clip::Overlap>, i: usize, k: usize| found.as_ref().map_or(0.0, |o| o.products[i][k]);
        for (i, k) in (0..9).map(|i| (i / 3, i % 3)) {
            let (one, other) = (area(a) * products(&there, i, k), area(b) * products(&back, k, i));
            prop_assert!((one - other).abs() < 1e-12, "{one} {other}");
        }
        let sum = there.as_ref().map_or(0.0, |o| o.products.as_flattened().iter().sum());
        prop_assert!((there.map_or(0.0, |o| o.share) - sum).abs() < 1e-12);
    }
}

/// At every new vertex, the range of values at corners of old triangles that meet a triangle there, borders included.
fn bounds_by_triangles(old: &Mesh, new: &Mesh, field: &Field) -> Vec<(f64, f64)> {
    let mut bounds = vec![(f64::INFINITY, f64::NEG_INFINITY); new.points.len()];
    for &t in &new.triangles {
        for &s in old.triangles.iter().filter(|&&s| !are_apart(new.corners_of(t), old.corners_of(s))) {
            for (&v, &w) in t.iter().flat_map(|v| s.iter().map(move |w| (v, w))) {
                let (u, bounds) = (field.values[w as usize], &mut bounds[v as usize]);
                *bounds = (bounds.0.min(u), bounds.1.max(u));
            }
        }
    }
    bounds
}

/// Whether a line along a side of one of the triangles separates them.
fn are_apart(a: [Point; 3], b: [Point; 3]) -> bool {
    let side = |a: [Point; 3], b: [Point; 3], i: usize| {
        let (p, along) = (a[i], a[(i + 1) % 3] - a[i]);
        let inner = along.cross(a[(i + 2) % 3] - p);
        b.iter().all(|&q| along.cross(q - p) * inner < 0.0)
    };
    (0..3).any(|i| side(a, b, i) || side(b, a, i))
}

#[test]
fn smooth_functions_converge_with_second_order() {
    let f = |p: Point| (3.0 * p.x).sin() * (2.0 * p.y + 1.0).cos();
    for carry in ALL {
        let error = |n: u32| {
            let (old, new) = (square(n, 0.3, 0.4), square(n + n / 4, 0.3, 2.0));
            let (carried, _) = carry(&old, &new, &[sampled(&old, f)]).unwrap();
            distance(&new, &carried[0].field, f)
        };
        let errors = [error(12), error(24), error(48)];
        assert!(errors[1] < 0.29 * errors[0] && errors[2] < 0.27 * errors[1], "{errors:?}");
    }
}

#[test]
fn means_over_triangles_converge_with_first_order() {
    let f = |p: Point| (3.0 * p.x).sin() * (2.0 * p.y + 1.0).cos();
    for carry in ALL {
        let error = |n: u32| {
            let (old, new) = (square(n, 0.3, 0.4), square(n + n / 4, 0.3, 2.0));
            let (carried, _) = carry(&old, &new, &[on_triangles(&old, f)]).unwrap();
            let squares: Vec<f64> = carried[0]
                .field
                .values
                .iter()
                .zip(on_triangles(&new, f).values)
                .map(|(a, b)| (a - b) * (a - b))
                .collect();
            dot(&squares, &areas(&new)).sqrt()
        };
        let (coarse, fine) = (error(16), error(32));
        assert!(fine < 0.56 * coarse, "{coarse} {fine}");
    }
}

#[test]
fn values_of_any_magnitude_are_carried() {
    let (old, new) = (square(8, 0.3, 0.4), square(11, 0.3, 2.0));
    let scaled = |factor: f64| [sampled(&old, |p| factor * rough(p)), on_triangles(&old, |p| factor * rough(p))];
    for carry in ALL {
        let (plain, _) = carry(&old, &new, &scaled(1.0)).unwrap();
        for power in [-1000, -600, 600, 1000] {
            let factor = 2.0_f64.powi(power);
            let (carried, _) = carry(&old, &new, &scaled(factor)).unwrap();
            for (plain, carried) in plain.iter().zip(carried) {
                let values: Vec<f64> = carried.field.values.iter().map(|u| u / factor).collect();
                assert_eq!(plain.field.values, values);
            }
        }
    }
}

#[test]
fn fronts_overshoot_unless_spread() {
    let (old, new) = (square(40, 0.3, 0.4), square(33, 0.3, 2.0));
    let field = sampled(&old, front);
    let carry = |overshoot| conservative(&old, &new, std::slice::from_ref(&field), overshoot).unwrap().0.remove(0);
    let (kept, spread) = (carry(Overshoot::Kept), carry(Overshoot::Spread));
    assert!(kept.after[0].max > 1.05 && kept.after[0].min < -0.05, "{:?}", kept.after);
    assert!(spread.after[0].max <= 1.0 && spread.after[0].min >= 0.0, "{:?}", spread.after);
    assert!(drift(&kept, &new) < 1e-14 && drift(&spread, &new) < 1e-14);
    // Far from the front, nothing is spread.
    let far = (0..new.points.len()).filter(|&v| new.points[v][0] < 0.1);
    assert!(far.map(|v| spread.field.values[v].abs()).fold(0.0, f64::max) == 0.0);
}

#[test]
fn other_chords_of_a_curve_keep_the_mass() {
    let (old, new) = (disk(36, 0.0), disk(54, 0.2));
    let bump = |p: Point| (1.0 - p.x).powi(2) + 0.1;
    let fields = [sampled(&old, bump), on_triangles(&old, bump), sampled(&old, |_| 2.0), sampled(&old, |p| p.x)];
    for overshoot in [Overshoot::Spread, Overshoot::Kept] {
        let (carried, cover) = conservative(&old, &new, &fields, overshoot).unwrap();
        assert!(carried.iter().all(|c| drift(c, &new) < 1e-13), "{carried:?}");
        let shares = cover.areas.unwrap();
        let [there, here] = [&old, &new].map(|mesh| areas(mesh).iter().sum::<f64>());
        assert!((shares.uncovered * here - shares.left * there - (here - there)).abs() < 1e-12, "{shares:?}");
        assert!(shares.uncovered > 1e-4 && cover.outside > 0 && cover.farthest < 0.01);
        // What was constant has the mean that keeps the mass, everywhere.
        assert!(carried[2].field.values.iter().all(|u| (u - 2.0 * there / here).abs() < 1e-12));
        assert!(carried[0].after[0].min > 0.0);
    }
}

#[test]
fn metrics_are_interpolated_by_their_logarithms() {
    let (old, new) = (square(6, 0.3, 0.4), square(9, 0.3, 2.0));
    let tensor = |p: Point| Tensor::from_axis(Vector::new(p.x.cos(), p.x.sin()), 100.0 * (1.0 + p.x), 1.0 + p.y);
    let tensors: Vec<Tensor> = (0..old.points.len() as u32).map(|v| tensor(old.point(v))).collect();
    let values = tensors.iter().flat_map(|m| [m.xx, m.xy, m.yy]).collect();
    let field = Field { place: Place::Vertices, kind: Kind::Metric, values };
    let between = Sampled::new(&old, &tensors).unwrap();
    for carry in ALL {
        let (carried, _) = carry(&old, &new, std::slice::from_ref(&field)).unwrap();
        for (v, row) in carried[0].field.values.chunks_exact(3).enumerate() {
            let m = between.at(new.point(v as u32));
            assert!(worst(row, &[m.xx, m.xy, m.yy]) < 1e-10, "{row:?} {m:?}");
        }
    }
}

#[test]
fn fields_of_several_components_are_carried_together_as_alone() {
    let (old, new) = (square(8, 0.3, 0.4), square(11, 0.3, 2.0));
    let (one, two, flat) = (sampled(&old, rough), sampled(&old, front), on_triangles(&old, rough));
    let both = one.values.iter().zip(&two.values).flat_map(|(&a, &b)| [a, b]).collect();
    let vector = Field { place: Place::Vertices, kind: Kind::Linear(2), values: both };
    for carry in ALL {
        let (all, _) = carry(&old, &new, &[vector.clone(), flat.clone(), one.clone()]).unwrap();
        let alone = |field: &Field| carry(&old, &new, std::slice::from_ref(field)).unwrap().0.remove(0);
        let (first, second) = (alone(&one), alone(&two));
        let joined: Vec<f64> =
            first.field.values.iter().zip(&second.field.values).flat_map(|(&a, &b)| [a, b]).collect();
        assert_eq!(all[0].field.values, joined);
        assert_eq!((all[0].after[1], &all[1], &all[2]), (second.after[0], &alone(&flat), &first));
    }
}

#[test]
fn triangles_without_area_or_turned_over_change_nothing() {
    let (old, new) = (square(8, 0.3, 0.4), square(11, 0.3, 2.0));
    let field = sampled(&old, rough);
    let mut odd = old.clone();
    odd.triangles.iter_mut().step_by(3).for_each(|t| t.swap(0, 1));
    odd.triangles.extend([[0, 0, 0], [0, 1, 1], [0, 1, 2]]);
    let mut odd_new = new.clone();
    odd_new.triangles.extend([[3, 3, 3], [0, 1, 2]]);
    odd_new.points.push([0.5, 0.5, 0.0]);
    for carry in ALL {
        let (plain, _) = carry(&old, &new, std::slice::from_ref(&field)).unwrap();
        let (other, _) = carry(&odd, &odd_new, std::slice::from_ref(&field)).unwrap();
        let (alone, values) = other[0].field.values.split_last().unwrap();
        assert!(worst(&plain[0].field.values, values) < 1e-12);
        // A vertex of no triangle has the old field's value.
        assert!((0.0..1.0).contains(alone));
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let (old, new) = (square(30, 0.3, 0.4), square(27, 0.3, 2.0));
    let fields = [sampled(&old, rough), on_triangles(&old, rough)];
    for carry in ALL {
        let [one, three] =
            [1, 3].map(|threads| crate::test_cases::on_threads(threads, || carry(&old, &new, &fields).unwrap()));
        assert_eq!(one, three);
    }
}

#[test]
fn bad_input_is_named() {
    let (old, new) = (square(4, 0.0, 0.0), square(5, 0.0, 0.0));
    let good = sampled(&old, rough);
    let message = |old: &Mesh, new: &Mesh, field: Field| {
        let error = conservative(old, new, &[good.clone(), field], Overshoot::Spread).unwrap_err();
        assert!(!error.help().is_empty());
        error.to_string()
    };
    let with = |values: Vec<f64>, kind| Field { place: Place::Vertices, kind, values };
    let told = message(&old, &new, with(vec![0.0; 24], Kind::Linear(1)));
    assert_eq!(told, "invalid mesh: 24 values for 25 vertices at field 2");
    let told = message(&old, &new, Field { place: Place::Triangles, ..good.clone() });
    assert_eq!(told, "invalid mesh: 25 values for 32 triangles at field 2");
    let mut values = vec![0.0; 50];
    values[9] = f64::NAN;
    let told = message(&old, &new, with(values, Kind::Linear(2)));
    assert_eq!(told, "invalid mesh: the value is NaN at vertex 5 (1, 0), field 2");
    let told = message(&old, &new, with(vec![1.0; 75], Kind::Metric));
    assert_eq!(
        told,
        "invalid metric: the tensor m11 = 1, m12 = 1, m22 = 1 is not positive definite at vertex 1 (0, 0), field 2"
    );
    let told = message(&old, &moved(new.clone(), 1.0, 0.0, Vector::new(0.2, 0.0)), good.clone());
    assert_eq!(
        told,
        "invalid domain: the new mesh ((0.2, 0) to (1.2, 1)) reaches beyond the old one at the old mesh ((0, 0) to (1, 1))"
    );
    assert!(message(&old, &Mesh::default(), good.clone()).contains("no triangles at the new mesh"));
}

#[test]
fn meshes_of_other_domains_are_refused() {
    let (old, new) = (square(10, 0.0, 0.0), square(12, 0.0, 0.0));
    let field = |mesh: &Mesh| [sampled(mesh, rough)];
    let without = |mesh: &Mesh, range: std::ops::Range<usize>| {
        let mut mesh = mesh.clone();
        mesh.triangles.drain(range);
        mesh
    };
    let mut twice = old.clone();
    twice.triangles.extend_from_slice(&old.triangles[..40]);
    for (old, new, expected) in [
        (&without(&old, 80..100), &new, "10.0 % of the new mesh's area are outside the old mesh"),
        (&old, &without(&new, 120..144), "8.3 % of the old mesh's area are outside the new mesh"),
        (&twice, &new, "20.0 % of the new mesh's area are covered more than once"),
    ] {
        let told = conservative(old, new, &field(old), Overshoot::Spread).unwrap_err().to_string();
        assert!(told.contains(expected), "{told}");
    }
}
