//! The complexity of a metric: its area of a domain, proportional to the vertices of a unit mesh.

use super::MetricField;
use super::validate::check_tensor;
use crate::error::{Error, Result};
use crate::geometry::Point;
use rayon::prelude::*;

/// The integral of sqrt(det M) over triangles that do not overlap, to a relative error of about 1e-4 of the total.
///
/// Adaptive: a 7-point rule of degree 5 (Radon), against itself on the two halves of a triangle cut across its longest
/// edge; triangles that contribute most of the error are cut further. It starts from at least 16,384 pieces, so that
/// layers a thousand times thinner than the domain are seen, and costs at most 21 evaluations for each of these and
/// each triangle given, plus 2^23. Parallel; the same result, bit for bit, for any number of threads.
///
/// # Errors
/// [`Error::Metric`] where the tensor is not finite and positive definite, or where the error is still above 5 % of
/// the total after that many evaluations (the metric has a singularity that cannot be integrated); [`Error::Domain`]
/// of a triangle that is not finite.
pub fn complexity(field: &dyn MetricField, triangles: &[[Point; 3]]) -> Result<f64> {
    let mut pieces = measure(field, start(triangles)?)?;
    let mut spent = 0;
    loop {
        let total: f64 = pieces.iter().map(Piece::integral).sum();
        let error: f64 = pieces.iter().map(Piece::error).sum();
        if error <= TOLERANCE * total {
            return Ok(total);
        }
        // Pieces below this make up half the tolerance, so that one above it exists.
        let allowed = 0.5 * TOLERANCE * total / pieces.len() as f64;
        let (kept, cut): (Vec<Piece>, Vec<Piece>) = pieces.into_iter().partition(|piece| piece.error() <= allowed);
        spent += 2 * EVALUATIONS_PER_CUT * cut.len();
        if spent > MAX_EVALUATIONS || cut.is_empty() {
            let worst = cut.iter().chain(&kept).max_by(|a, b| a.error().total_cmp(&b.error()));
            return settle(total, error, worst);
        }
        let halves =
            cut.iter().flat_map(|piece| bisect(piece.triangle).into_iter().zip(piece.halves.map(Some))).collect();
        pieces = kept;
        pieces.extend(measure(field, halves)?);
    }
}

/// Error of the result, relative to it; the estimate is that of the coarser rule, so that the truth is mostly better.
const TOLERANCE: f64 = 1e-4;
/// Pieces to start from.
const PIECES: f64 = 16_384.0;
/// Evaluations after the start.
const MAX_EVALUATIONS: usize = 1 << 23;
/// Evaluations that a piece costs when its own integral is known: its two halves'.
const EVALUATIONS_PER_CUT: usize = 2 * 7;
/// Above this estimate of the relative error the integral is not trusted.
const HOPELESS: f64 = 0.05;

/// A triangle with its integral, by one rule and by one on each half.
struct Piece {
    triangle: [Point; 3],
    whole: f64,
    halves: [f64; 2],
}

impl Piece {
    fn integral(&self) -> f64 {
        self.halves[0] + self.halves[1]
    }

    fn error(&self) -> f64 {
        (self.whole - self.integral()).abs()
    }
}

type Measured = ([Point; 3], Option<f64>);

/// The triangles with area, cut until none is larger than a share of the total.
fn start(triangles: &[[Point; 3]]) -> Result<Vec<Measured>> {
    if let Some(i) = triangles.iter().position(|t| !area(*t).is_finite()) {
        let [a, b, c] = triangles[i];
        return Err(Error::domain(
            "a triangle is not finite",
            format!("triangle {} with corners {a}, {b}, {c}", i + 1),
            "check the coordinates of the domain",
        ));
    }
    let largest = triangles.iter().map(|&t| area(t)).sum::<f64>() / PIECES;
    let mut pieces = Vec::new();
    for &triangle in triangles {
        let mut pending = vec![triangle];
        while let Some(t) = pending.pop() {
            if area(t) > largest {
                pending.extend(bisect(t));
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
        let [first, second] = bisect(triangle);
        Ok(Piece { triangle, whole, halves: [integrate(field, first)?, integrate(field, second)?] })
    };
    // Collected before the first error is looked for, or threads would race for whose is reported.
    let pieces: Vec<Result<Piece>> = triangles.into_par_iter().with_min_len(64).map(piece).collect();
    pieces.into_iter().collect()
}

/// Radon's rule: exact for polynomials of degree 5.
fn integrate(field: &dyn MetricField, [a, b, c]: [Point; 3]) -> Result<f64> {
    let density = |u: f64, v: f64, w: f64| {
        let p = Point::new(u * a.x + v * b.x + w * c.x, u * a.y + v * b.y + w * c.y);
        let tensor = field.at(p);
        check_tensor(tensor, p)?;
        Ok(tensor.determinant().sqrt())
    };
    let root = 15f64.sqrt();
    let third = 1.0 / 3.0;
    let mut sum = 9.0 / 40.0 * density(third, third, third)?;
    for sign in [-1.0, 1.0] {
        let near = (6.0 + sign * root) / 21.0;
        let far = 1.0 - 2.0 * near;
        let values = density(far, near, near)? + density(near, far, near)? + density(near, near, far)?;
        sum += (155.0 + sign * root) / 1200.0 * values;
    }
    Ok(sum * area([a, b, c]))
}

/// The two halves of a triangle cut across its longest edge.
fn bisect([a, b, c]: [Point; 3]) -> [[Point; 3]; 2] {
    let square = |p: Point, q: Point| (q - p).dot(q - p);
    let (ab, bc, ca) = (square(a, b), square(b, c), square(c, a));
    let [a, b, c] = if ab >= bc && ab >= ca {
        [a, b, c]
    } else if bc >= ca {
        [b, c, a]
    } else {
        [c, a, b]
    };
    let middle = a.midpoint(b);
    [[a, middle, c], [middle, b, c]]
}

fn area([a, b, c]: [Point; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).abs()
}

/// The result when no more evaluations are allowed.
fn settle(total: f64, error: f64, worst: Option<&Piece>) -> Result<f64> {
    if error <= HOPELESS * total {
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
mod tests {
    use super::*;
    use crate::geometry::{Tensor, Vector};
    use crate::metric::{Shock, Uniform};
    use std::sync::atomic::{AtomicUsize, Ordering};

    fn rectangle(x0: f64, y0: f64, x1: f64, y1: f64) -> [[Point; 3]; 2] {
        let [a, b, c, d] = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| Point::new(x, y));
        [[a, b, c], [a, c, d]]
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
    fn thin_triangles_are_no_trouble() {
        let field = |p: Point| Tensor::new(1.0 + p.x * p.x, 0.0, 1.0 + p.x * p.x);
        assert_close(complexity(&field, &rectangle(0.0, 0.0, 100.0, 1e-6)).unwrap(), 1e-6 * (100.0 + 1e6 / 3.0));
    }

    #[test]
    fn integrable_singularities_are_integrated() {
        // sqrt(det M) = 1 / r over the unit square around 0: 4 ln(1 + sqrt 2) / ... by symmetry, 8 triangles.
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
                    println!("{gaussian} {width} {angle:.2} {error:.2e} {count}");
                    assert!(error.abs() < 1e-4, "{gaussian} {width} {angle:.2}: {error:.2e}, {count} evaluations");
                }
            }
        }
    }

    #[test]
    fn threads_do_not_change_a_bit() {
        let triangles = rectangle(-1.0, -1.0, 1.0, 1.0);
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| complexity(&Shock { phi: 10.0, lambda: 0.01 }, &triangles)).unwrap()
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
