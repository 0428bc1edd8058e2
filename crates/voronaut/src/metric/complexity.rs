//! The complexity of a metric: its area of a domain, proportional to the vertices of a unit mesh.

use super::validate::check_tensor;
use super::{MetricField, Near};
use crate::error::{Error, Result};
use crate::geometry::{Aabb, Point, combine, radon};
use crate::parallel::prelude::*;

/// The integral of sqrt(det M) over triangles that do not overlap, to a relative error of about 1e-4 of the total.
///
/// Adaptive: a 7-point rule of degree 5 (Radon), against itself on the four quarters of a triangle; those that
/// contribute most of the error are cut further: in four, or in two where the metric varies across one edge only
/// (layers along a boundary). It starts from at least 8,192 pieces of like area, so that layers a thousand times
/// thinner than the domain are seen, and costs at most 35 evaluations for each of up to 16,384 pieces and each triangle
/// given, plus 2^24. Parallel; the same result, bit for bit, for any number of threads.
///
/// # Errors
/// [`Error::Metric`] where the tensor is not finite and positive definite, or where the error is still above 5 % of
/// the total after that many evaluations (the metric has a singularity that cannot be integrated); [`Error::Domain`]
/// of a triangle that is not finite.
pub fn complexity(field: &dyn MetricField, triangles: &[[Point; 3]]) -> Result<f64> {
    if let Some(total) = in_closed_form(field, triangles, SAME) {
        return settle(total, 0.0, None);
    }
    let Integral { total, error, worst } = adapt(field, start(triangles, PIECES)?, TOLERANCE, MAX_EVALUATIONS)?;
    settle(total, error, worst.as_ref())
}

/// A rough value of [`complexity`], to about 1 %, for no more than 2^20 evaluations after the start; never refused for
/// what its error may be.
///
/// # Errors
/// As [`complexity`], for tensors and triangles that are not valid, and where the value is not finite.
pub(crate) fn rough_complexity(field: &dyn MetricField, triangles: &[[Point; 3]]) -> Result<f64> {
    if let Some(total) = in_closed_form(field, triangles, ROUGH_TOLERANCE) {
        return settle(total, 0.0, None);
    }
    let pieces = start(triangles, ROUGH_PIECES)?;
    let Integral { total, worst, .. } = adapt(field, pieces, ROUGH_TOLERANCE, MAX_EVALUATIONS >> 4)?;
    settle(total, 0.0, worst.as_ref())
}

/// A rough value of [`complexity`] of each of many triangles.
///
/// # Errors
/// As [`rough_complexity`].
pub(crate) fn complexities(field: &dyn MetricField, triangles: &[[Point; 3]]) -> Result<Vec<f64>> {
    let share = triangles.len().max(1);
    let one = |&triangle: &[Point; 3]| {
        let pieces = start(&[triangle], (PIECES / share as f64).max(1.0))?;
        let Integral { total, worst, .. } = adapt(field, pieces, ROUGH_TOLERANCE, (MAX_EVALUATIONS >> 4) / share)?;
        settle(total, 0.0, worst.as_ref())
    };
    triangles.par_iter().map(one).collect()
}

/// The integral in closed form, if the field is given on just these triangles as a whole, but for a share of them.
fn in_closed_form(field: &dyn MetricField, triangles: &[[Point; 3]], share: f64) -> Option<f64> {
    let all = triangles.iter().map(|&triangle| area(triangle)).sum();
    field.integral(all, Aabb::of(triangles.iter().flatten().copied())?, share)
}

struct Integral {
    total: f64,
    error: f64,
    worst: Option<Piece>,
}

fn adapt(field: &dyn MetricField, pieces: Vec<Measured>, tolerance: f64, max_evaluations: usize) -> Result<Integral> {
    let mut pieces = measure(field, pieces)?;
    let (mut spent, mut rounds) = (0, 0);
    loop {
        let total: f64 = pieces.iter().map(Piece::integral).sum();
        let error: f64 = pieces.iter().map(Piece::error).sum();
        if error <= tolerance * total && total.is_finite() {
            return Ok(Integral { total, error, worst: None });
        }
        let allowed = negligible(&pieces, 0.5 * tolerance * total);
        let (kept, cut): (Vec<Piece>, Vec<Piece>) = pieces.into_iter().partition(|piece| piece.error() <= allowed);
        let parts: Vec<Measured> = cut.iter().flat_map(Piece::cut).collect();
        spent += parts.len() * EVALUATIONS_PER_PART;
        rounds += 1;
        if spent > max_evaluations || rounds > ROUNDS || parts.is_empty() {
            let worst = cut.into_iter().chain(kept).max_by(|a, b| a.error().total_cmp(&b.error()));
            return Ok(Integral { total, error, worst });
        }
        pieces = kept;
        pieces.extend(measure(field, parts)?);
    }
}

/// Estimated error of the result, relative to it. The estimate is far too large for smooth metrics and some times too
/// small at singularities: a fifth of the 1e-4 that is promised.
const TOLERANCE: f64 = 2e-5;
/// The same for a rough value.
const ROUGH_TOLERANCE: f64 = 1e-2;
/// Two areas are the same that differ by no more than this share: far above rounding, far below what is promised.
const SAME: f64 = 1e-9;
/// Pieces to start from.
pub(super) const PIECES: f64 = 8192.0;
/// Those of a rough value: seeding corrects what it does not see.
const ROUGH_PIECES: f64 = 1024.0;
/// Evaluations after the start.
const MAX_EVALUATIONS: usize = 1 << 24;
/// Cuts one after the other, at most: after as many as two numbers have bits there is nothing between them to cut at.
const ROUNDS: usize = 128;
/// Evaluations that a new piece costs at most: its own and its four quarters'.
const EVALUATIONS_PER_PART: usize = 5 * 7;
/// The metric does not vary along an edge if it varies so much less than along the others.
const FLAT: f64 = 0.1;
/// Above this estimate of the relative error the integral is not trusted.
const HOPELESS: f64 = 0.05;

/// A triangle with its integral, by one rule and by one on each quarter.
///
/// Quarters, not halves: a cut parallel to the direction in which the metric varies would find no difference.
struct Piece {
    triangle: [Point; 3],
    whole: f64,
    quarters: [f64; 4],
}

impl Piece {
    fn integral(&self) -> f64 {
        self.quarters.iter().sum()
    }

    fn error(&self) -> f64 {
        (self.whole - self.integral()).abs()
    }

    /// Smaller pieces: where the metric does not vary along one edge, two, by a cut across another; else the quarters.
    fn cut(&self) -> Vec<Measured> {
        let [a, b, c] = self.triangle;
        let [at_a, at_b, at_c, _] = self.quarters;
        let edges = [([a, b, c], at_b - at_a), ([b, c, a], at_c - at_b), ([c, a, b], at_a - at_c)];
        let most = edges.iter().fold(0.0, |most: f64, (_, variation)| most.max(variation.abs()));
        match edges.into_iter().find(|(_, variation)| variation.abs() < FLAT * most) {
            Some(([start, end, apex], _)) if squared(end, apex) >= squared(apex, start) => {
                halve([end, apex, start]).map(|half| (half, None)).into()
            }
            Some(([start, end, apex], _)) => halve([apex, start, end]).map(|half| (half, None)).into(),
            None => quarter(self.triangle).into_iter().zip(self.quarters.map(Some)).collect(),
        }
    }
}

pub(super) type Measured = ([Point; 3], Option<f64>);

/// The largest error such that the pieces with no more make up a sum of at most `allowance`.
fn negligible(pieces: &[Piece], allowance: f64) -> f64 {
    let mut errors: Vec<f64> = pieces.iter().map(Piece::error).collect();
    errors.sort_unstable_by(f64::total_cmp);
    let mut sum = 0.0;
    let small = errors.iter().take_while(|error| {
        sum += **error;
        sum <= allowance
    });
    small.last().copied().unwrap_or(0.0)
}

/// The triangles with area, cut until none is larger than a share of the total.
pub(super) fn start(triangles: &[[Point; 3]], count: f64) -> Result<Vec<Measured>> {
    if let Some(i) = triangles.iter().position(|t| !area(*t).is_finite()) {
        let [a, b, c] = triangles[i];
        return Err(Error::domain(
            "a triangle is not finite",
            format!("triangle {} with corners {a}, {b}, {c}", i + 1),
            "check the coordinates of the domain",
        ));
    }
    let largest = triangles.iter().map(|&t| area(t)).sum::<f64>() / count;
    let mut pieces = Vec::new();
    for &triangle in triangles {
        let mut pending = vec![triangle];
        while let Some(t) = pending.pop() {
            // Between neighbouring numbers there is no middle.
            let halves = bisect(t);
            if area(t) > largest && halves.iter().all(|&half| area(half) < area(t)) {
                pending.extend(halves);
            } else if area(t) > 0.0 {
                pieces.push((t, None));
            }
        }
    }
    Ok(pieces)
}

/// Pieces from triangles, some of whose integrals are known; in the same order.
fn measure(field: &dyn MetricField, triangles: Vec<Measured>) -> Result<Vec<Piece>> {
    let piece = |(triangle, known): Measured| {
        let whole = known.map_or_else(|| integrate(field, triangle), Ok)?;
        let [a, b, c, d] = quarter(triangle);
        let quarters = [integrate(field, a)?, integrate(field, b)?, integrate(field, c)?, integrate(field, d)?];
        Ok(Piece { triangle, whole, quarters })
    };
    // Collected before the first error is looked for, or threads would race for whose is reported.
    let pieces: Vec<Result<Piece>> = triangles.into_par_iter().with_min_len(64).map(piece).collect();
    pieces.into_iter().collect()
}

fn integrate(field: &dyn MetricField, triangle: [Point; 3]) -> Result<f64> {
    let (mut sum, mut near) = (0.0, Near::default());
    for (at, weight) in radon() {
        let p = combine(at, triangle);
        let tensor = field.at_near(p, &mut near);
        check_tensor(tensor, p)?;
        sum += weight * tensor.determinant().sqrt();
    }
    Ok(sum * area(triangle))
}

/// The two halves of a triangle cut across its longest edge.
fn bisect([a, b, c]: [Point; 3]) -> [[Point; 3]; 2] {
    let (ab, bc, ca) = (squared(a, b), squared(b, c), squared(c, a));
    if ab >= bc && ab >= ca {
        halve([a, b, c])
    } else if bc >= ca {
        halve([b, c, a])
    } else {
        halve([c, a, b])
    }
}

/// The two halves of a triangle cut across its first edge.
fn halve([a, b, c]: [Point; 3]) -> [[Point; 3]; 2] {
    let middle = a.midpoint(b);
    [[a, middle, c], [middle, b, c]]
}

fn squared(a: Point, b: Point) -> f64 {
    (b - a).dot(b - a)
}

/// The four triangles of the corners and the middles of the edges.
fn quarter([a, b, c]: [Point; 3]) -> [[Point; 3]; 4] {
    let (ab, bc, ca) = (a.midpoint(b), b.midpoint(c), c.midpoint(a));
    [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
}

fn area([a, b, c]: [Point; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).abs()
}

/// The result when no more evaluations are allowed.
fn settle(total: f64, error: f64, worst: Option<&Piece>) -> Result<f64> {
    if error <= HOPELESS * total && total.is_finite() {
        return Ok(total);
    }
    let place = worst.map_or("an unknown place".into(), |piece| piece.triangle[0].to_string());
    Err(Error::metric(
        format!("the integral of sqrt(det M) does not settle ({total:.3e} +- {error:.1e})"),
        place,
        "the metric grows without bound there; limit it with h_min",
    ))
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact results are the point")]
mod tests {
    use super::*;
    use crate::geometry::{Tensor, Vector};
    use crate::mesh::Mesh;
    use crate::metric::{Sampled, Scaled, Shock, Uniform};
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> [[Point; 3]; 2] {
        let [a, b, c, d] = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| Point::new(x, y));
        [[a, b, c], [a, c, d]]
    }

    #[test]
    fn metrics_at_vertices_of_the_domain_s_triangles_are_integrated_in_closed_form() {
        let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let mesh = Mesh { points, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        let tensors = [1.0, 400.0, 9.0, 0.5].map(|x| Tensor::new(x, 0.1, 1.0));
        let field = Sampled::new(&mesh, &tensors).unwrap();
        let square = rectangle(0.0, 0.0, 1.0, 1.0);
        let measured = complexity(&|p: Point| field.at(p), &square).unwrap();
        assert!((complexity(&field, &square).unwrap() / measured - 1.0).abs() < 1e-4);
        let twice = Scaled { field: &field, factor: 2.0 };
        assert!((rough_complexity(&twice, &square).unwrap() / (2.0 * measured) - 1.0).abs() < 1e-4);
        // Of a part of them values tell.
        let part = [square[0]];
        assert_eq!(complexity(&field, &part).unwrap(), complexity(&|p: Point| field.at(p), &part).unwrap());
    }

    fn assert_close(value: f64, truth: f64) {
        assert!((value / truth - 1.0).abs() < 1e-4, "{value}, not {truth}");
    }

    #[test]
    fn of_a_uniform_metric_is_area_times_density() {
        let field = Uniform(Tensor::new(9.0, 0.0, 4.0));
        let value = complexity(&field, &rectangle(-1.0, 0.0, 3.0, 0.5)).unwrap();
        assert!((value - 12.0).abs() < 1e-11);
        assert_eq!(complexity(&field, &[]).unwrap(), 0.0);
    }

    /// Between neighbouring numbers there is no middle to cut at: where there are few numbers, the sum over parts may not settle.
    #[test]
    fn domains_of_some_units_of_rounding_end() {
        let x = 1e7;
        for width in [1.0, 2.0, 3.0, 54.0].map(|units| units * f64::EPSILON * 8_388_608.0) {
            for triangles in [rectangle(x, 0.0, x + width, 1e-7), rectangle(x, x, x + width, x + width)] {
                let found = complexity(&Uniform(Tensor::IDENTITY), &triangles);
                assert!(found.is_err() || found.is_ok_and(f64::is_finite));
            }
        }
    }

    #[test]
    fn the_rule_is_exact_to_degree_five() {
        // The integral of x^i y^j over the triangle (0,0), (1,0), (0,1) is i! j! / (i + j + 2)!.
        let triangle = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let factorial = |n: i32| f64::from((1..=n).product::<i32>());
        for (i, j) in [(0, 0), (1, 0), (2, 1), (2, 2), (0, 4), (3, 2), (5, 0), (1, 4)] {
            let field = move |p: Point| Tensor::new((p.x.powi(i) * p.y.powi(j)).powi(2), 0.0, 1.0);
            let truth = factorial(i) * factorial(j) / factorial(i + j + 2);
            assert!((integrate(&field, triangle).unwrap() - truth).abs() < 1e-15, "{i} {j}");
        }
    }

    #[test]
    fn of_the_half_plane_is_its_hyperbolic_area() {
        let field = |p: Point| Tensor::IDENTITY * (1.0 / (p.y * p.y));
        for low in [1e-1, 1e-3, 1e-6] {
            let truth = 3.0 * (1.0 / low - 1.0 / 2.0);
            assert_close(complexity(&field, &rectangle(-1.0, low, 2.0, 2.0)).unwrap(), truth);
        }
    }

    #[test]
    fn layers_along_a_boundary_are_cheap() {
        // Boundary layers of a wing: a millionth of its length; along the walls, the area per length is the integral
        // of 1 / (h0 + d / 5)^2.
        let evaluations = AtomicUsize::new(0);
        let field = |p: Point| {
            evaluations.fetch_add(1, Ordering::Relaxed);
            Tensor::isotropic(1e-6 + 0.2 * p.y)
        };
        let truth = 3.0 * 5.0 * (1e6 - 1.0 / (1e-6 + 0.4));
        assert_close(complexity(&field, &rectangle(-1.0, 0.0, 2.0, 2.0)).unwrap(), truth);
        let count = evaluations.into_inner();
        assert!(count < 3_000_000, "{count} evaluations");
    }

    #[test]
    fn thin_triangles_are_no_trouble() {
        let field = |p: Point| Tensor::new(1.0 + p.x * p.x, 0.0, 1.0 + p.x * p.x);
        assert_close(complexity(&field, &rectangle(0.0, 0.0, 100.0, 1e-6)).unwrap(), 1e-6 * (100.0 + 1e6 / 3.0));
    }

    #[test]
    fn integrable_singularities_are_integrated() {
        // sqrt(det M) = 1 / r over the unit square around 0.
        let field = |p: Point| Tensor::IDENTITY * (1.0 / p.x.hypot(p.y));
        let truth = 4.0 * (1.0 + 2f64.sqrt()).ln();
        assert_close(complexity(&field, &rectangle(-0.5, -0.5, 0.5, 0.5)).unwrap(), truth);
    }

    /// A layer of relative width 1e-3 around a slanted line, a million times denser than its surroundings, and its
    /// integral by summation over the distance to the line.
    fn layer(angle: f64, width: f64, gaussian: bool) -> (impl Fn(Point) -> Tensor + Sync, f64) {
        let n = Vector::new(f64::cos(angle), f64::sin(angle));
        let density = move |d: f64| {
            let s = d / width;
            1.0 + 1e6 * if gaussian { (-s * s).exp() } else { 1.0 / (1.0 + s * s) }
        };
        // The length of the line n.p = d inside the unit disk's square is found by brute force below.
        let chord = move |d: f64| {
            let (start, along) = (Point::new(n.x * d, n.y * d), n.perpendicular());
            let clip = |p: f64, v: f64| {
                let (s, t) = ((-1.0 - p) / v, (1.0 - p) / v);
                (s.min(t), s.max(t))
            };
            let ((s0, s1), (t0, t1)) = (clip(start.x, along.x), clip(start.y, along.y));
            (s1.min(t1) - s0.max(t0)).max(0.0)
        };
        // d = width sinh(u) puts samples where the layer is.
        let (steps, top) = (400_000, (2.0 / width).asinh());
        let du = 2.0 * top / f64::from(steps);
        let sum: f64 = (0..steps)
            .map(|i| {
                let u = -top + (f64::from(i) + 0.5) * du;
                density(width * u.sinh()) * chord(width * u.sinh()) * width * u.cosh() * du
            })
            .sum();
        (move |p: Point| Tensor::new(density(n.x * p.x + n.y * p.y).powi(2), 0.0, 1.0), sum)
    }

    #[test]
    fn steep_layers_are_found_at_any_angle() {
        for gaussian in [false, true] {
            for width in [0.02, 2e-3] {
                for step in 0..12 {
                    let angle = 0.05 + 0.13 * f64::from(step);
                    let (field, truth) = layer(angle, width, gaussian);
                    let evaluations = AtomicUsize::new(0);
                    let counted = |p: Point| {
                        evaluations.fetch_add(1, Ordering::Relaxed);
                        field(p)
                    };
                    let value = complexity(&counted, &rectangle(-1.0, -1.0, 1.0, 1.0)).unwrap();
                    let error = value / truth - 1.0;
                    let count = evaluations.into_inner();
                    assert!(error.abs() < 1e-4, "{gaussian} {width} {angle:.2}: {error:.2e}, {count} evaluations");
                }
            }
        }
    }

    #[test]
    fn threads_do_not_change_a_bit() {
        let triangles = rectangle(-1.0, -1.0, 1.0, 1.0);
        let with = |threads| {
            crate::test_cases::on_threads(threads, || complexity(&Shock { phi: 10.0, lambda: 0.01 }, &triangles))
                .unwrap()
        };
        assert_eq!(with(1).to_bits(), with(3).to_bits());
    }

    #[test]
    fn bad_metrics_and_triangles_are_named() {
        let triangles = rectangle(-1.0, -1.0, 1.0, 1.0);
        let error = complexity(&|p: Point| Tensor::new(p.x, 0.0, 1.0), &triangles).unwrap_err();
        assert!(error.to_string().contains("not positive definite at (-"), "{error}");
        let again = complexity(&|p: Point| Tensor::new(p.x, 0.0, 1.0), &triangles).unwrap_err();
        assert_eq!(error.to_string(), again.to_string());
        let error = complexity(&|p: Point| Tensor::IDENTITY * p.x.hypot(p.y).powi(-4), &triangles).unwrap_err();
        assert!(error.to_string().contains("the integral of sqrt(det M) does not settle"), "{error}");
        assert!(error.help().contains("h_min"));
        let nan = [[Point::new(f64::NAN, 0.0), Point::new(1.0, 0.0), Point::new(0.0, 1.0)]];
        let error = complexity(&Uniform::default(), &nan).unwrap_err();
        assert!(error.to_string().contains("a triangle is not finite at triangle 1 with corners (NaN, 0)"), "{error}");
    }
}
