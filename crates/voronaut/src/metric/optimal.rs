//! The metric of a Hessian in whose unit meshes linear interpolation has the least error.

use super::Norm;
use crate::elementary::Elementary;
use crate::geometry::{Node, Tensor, radon_on_parts};
use std::f64::consts::FRAC_PI_3;

/// What makes metrics of Hessians: of all meshes with as many vertices, a unit mesh has the least L^p error.
///
/// The direction and ratio of sizes are those of |H|, the absolute value (Loseille and Alauzet 2011), in which triangles are equilateral. How
/// small they should be depends on the error on them, and that on the sign of det H, too: of the quadratic forms diag(1, t) an equilateral
/// triangle has its greatest error at t = 1, and at t = -1, a saddle, in L^2 sqrt(1/8) of that (Cao 2005; the two constants of Mirebeau 2010).
/// With areas A and error c(t) A sqrt(det |H|) on them, errors sum up to the least where sqrt(det M) is as c(t)^(p / (p + 1)) det(|H|)^(p / (2p + 2)):
///
/// > M = d(t) det(|H|)^(-1 / (2p + 2)) |H|,  t = det H / det |H|,  d(t) = (c(t) / c(1))^(p / (p + 1)).
///
/// d(-1) is one half in L^2. Between -1 and 1 is t where an eigenvalue was raised to a floor. With p infinite M is |H| itself, in which no unit edge
/// has an error above 1/8 in its middle: measured, the greatest errors of unit meshes that are sparser at saddles are larger.
#[derive(Clone, Debug)]
pub(crate) struct Optimal {
    norm: Norm,
    /// d at t from -1 to 1.
    densities: [f64; STEPS + 1],
}

/// Steps of t: between them d is linear, to 0.1 %.
const STEPS: usize = 32;

impl Optimal {
    /// In a norm.
    pub(crate) fn new(norm: Norm) -> Self {
        if norm.exponent().is_infinite() {
            return Self { norm, densities: [1.0; STEPS + 1] };
        }
        let nodes = radon_on_parts(PARTS);
        let most = mean_error(norm, 1.0, &nodes);
        let power = 1.0 / (1.0 + 1.0 / norm.exponent());
        let of = |i| (mean_error(norm, 2.0 * i as f64 / STEPS as f64 - 1.0, &nodes) / most).raised_to(power);
        Self { norm, densities: std::array::from_fn(of) }
    }

    /// M up to a factor that is the same everywhere, of a Hessian whose absolute eigenvalues are raised to a floor, which is positive.
    pub(crate) fn of(&self, hessian: Tensor, floor: f64) -> Tensor {
        hessian.map_both_eigenvalues(|both| {
            let [a, b] = both.map(|value| value.abs().max(floor));
            let factor = self.norm.weight(a * b, 1) * self.density((both[0] / a) * (both[1] / b));
            [a * factor, b * factor]
        })
    }

    fn density(&self, t: f64) -> f64 {
        let along = 0.5 * (t.clamp(-1.0, 1.0) + 1.0) * STEPS as f64;
        let i = (along as usize).min(STEPS - 1);
        let share = along - i as f64;
        (1.0 - share) * self.densities[i] + share * self.densities[i + 1]
    }
}

/// Errors are looked at on a triangle cut into so many times so many parts.
const PARTS: u32 = 4;
/// Turns of the triangle that the mean is over: a third of a half-turn makes it the same again.
const TURNS: usize = 6;

/// The L^p mean on an equilateral triangle, and over its turns, of the error of interpolating x² + t y².
fn mean_error(norm: Norm, t: f64, nodes: &[Node]) -> f64 {
    let sides = |turn: usize| {
        [0, 1, 2].map(|side| {
            let (sine, cosine) = (FRAC_PI_3 * (f64::from(side) + turn as f64 / TURNS as f64)).sine_and_cosine();
            cosine * cosine + t * sine * sine
        })
    };
    let error = |[a, b, c]: [f64; 3], ([u, v, w], weight): Node| ((u * v * a + v * w * b + w * u * c).abs(), weight);
    let errors = || (0..TURNS).map(sides).flat_map(|sides| nodes.iter().map(move |&node| error(sides, node)));
    let most = errors().map(|(error, _)| error).fold(0.0, f64::max);
    let mean = errors().map(|(error, weight)| weight * norm.power(error / most)).sum::<f64>() / TURNS as f64;
    most * mean.raised_to(1.0 / norm.exponent())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn densities_in_the_mean_square_are_those_of_its_closed_form() {
        let optimal = Optimal::new(Norm::default());
        for i in 0..=200 {
            let t = f64::from(i) / 100.0 - 1.0;
            let truth = ((9.0 * (1.0 + t * t) + 14.0 * t) / 32.0).cbrt();
            assert!((optimal.density(t) / truth - 1.0).abs() < 1e-3, "{t}: {} {truth}", optimal.density(t));
        }
        assert!((optimal.density(-1.0) - 0.5).abs() < 1e-12);
    }

    /// On a triangle whose error changes its sign nowhere means are those of the sum of its values at the middles of edges: (1 + t) / 2.
    #[test]
    fn densities_in_the_mean_are_those_of_its_closed_form_where_there_is_no_saddle() {
        let optimal = Optimal::new(Norm::new(1.0).unwrap());
        for i in 0..=20 {
            let t = f64::from(i) / 20.0;
            assert!((optimal.density(t) / (0.5 * (1.0 + t)).sqrt() - 1.0).abs() < 2e-3, "{t}");
        }
    }

    #[test]
    fn bowls_have_the_density_one_and_saddles_less_in_any_norm() {
        for p in [1.0, 1.5, 2.0, 4.0, 8.0, 1e3, 1e9] {
            let optimal = Optimal::new(Norm::new(p).unwrap());
            assert!((optimal.density(1.0) - 1.0).abs() < 1e-12, "{p}");
            let of_saddle = optimal.density(-1.0);
            assert!((0.45..0.76).contains(&of_saddle), "{p}: {of_saddle}");
        }
    }

    #[test]
    fn weights_take_the_size_of_a_hessian_away_but_not_all_of_it() {
        // sqrt(det) of the weighted tensor is det^(p / (2p + 2)).
        let h = Tensor::new(40.0, 3.0, 2.0);
        for (p, power) in [(1.0, 0.25), (2.0, 1.0 / 3.0), (4.0, 0.4), (f64::INFINITY, 0.5)] {
            let density = Optimal::new(Norm::new(p).unwrap()).of(h, f64::MIN_POSITIVE).determinant().sqrt();
            assert!((density / h.determinant().powf(power) - 1.0).abs() < 1e-12, "{p}");
        }
    }
}
