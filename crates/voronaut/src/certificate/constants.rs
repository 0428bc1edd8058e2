//! The formulas of RR-9103's conditions, corrected and as printed. Pure functions of a net's figures.

use crate::elementary::Elementary;
use serde::Serialize;

use crate::error::named;

/// Which formulas: those derived in `docs/guarantees.md`, or the report's own, to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Constants {
    /// With the report's errors corrected.
    #[default]
    Corrected,
    /// As printed. What they say is no guarantee.
    Printed,
}

named!(Constants, "constants", [Corrected = "corrected", Printed = "printed"]);

/// A power-protected net (RR-9103, sections 3.3 and 3.4), in lengths of one metric.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// No point is farther from its nearest seed.
    pub epsilon: f64,
    /// No two seeds are nearer to each other.
    pub mu: f64,
    /// No Voronoi vertex is protected less: the root of the least power of a fourth seed.
    pub delta: f64,
}

impl Figures {
    /// mu / epsilon.
    pub(crate) fn lambda(&self) -> f64 {
        self.mu / self.epsilon
    }

    /// How far a vertex of a Voronoi cell is at least from the edges that do not end there, in a uniform metric (Lemma
    /// 9.5; its statement has 8 where its proof gives 4): delta^2 mu sqrt(1 - (mu / 2 epsilon)^2) / (4 epsilon^2).
    pub(crate) fn separation(&self) -> f64 {
        self.delta.powi(2) * self.mu / (4.0 * self.epsilon.powi(2)) * self.sine_of_corner()
    }

    /// The diameter below which a convex set meets only cells that have a Voronoi vertex in common, in a uniform metric
    /// (`docs/guarantees.md`, Lemma A): the separation, and two thirds of mu, below which it cannot meet three sides of
    /// one cell.
    pub(crate) fn resolution(&self) -> f64 {
        self.separation().min(2.0 / 3.0 * self.mu)
    }

    fn sine_of_corner(&self) -> f64 {
        (1.0 - (0.5 * self.lambda()).powi(2)).max(0.0).sqrt()
    }
}

impl Constants {
    /// The sizing field that Theorem 9.1 asks of a canvas, in the metric, which is uniform: no edge is longer than 2
    /// `s0`.
    pub(crate) fn uniform_size(self, net: &Figures) -> f64 {
        match self {
            Constants::Corrected => 0.5 * net.resolution(),
            Constants::Printed => 0.5 * net.separation(),
        }
    }

    /// The Euclidean length that is no longer than one of the metric, in any direction (Theorem 9.9). The report has
    /// the square root of the least eigenvalue where it is one over that of the greatest.
    pub(crate) fn alpha(self, [small, large]: [f64; 2]) -> f64 {
        match self {
            Constants::Corrected => 1.0 / large.sqrt(),
            Constants::Printed => small.sqrt(),
        }
    }

    /// The sizing field, in the metric, that Theorem 9.10 asks of a canvas around a cell within whose surroundings
    /// tensors are distorted by no more than `psi`; with distances that are wrong by no more than `error` (section
    /// 9.4). `None` where no canvas is fine enough: the net must be better, or denser.
    pub(crate) fn size(self, net: &Figures, psi: f64, error: f64) -> Option<f64> {
        let size = match self {
            Constants::Corrected => corrected_size(net, psi, error)?,
            Constants::Printed => printed_size(net, psi * (1.0 + error / net.epsilon))?,
        };
        (size > 0.0).then_some(size)
    }

    /// The greatest distortion with which there is such a size; 1 where there is none even without distortion.
    pub(crate) fn distortion_allowed(self, net: &Figures) -> f64 {
        greatest([1.0, 2.0], |psi| self.size(net, psi, 0.0).is_some())
    }

    /// What lambda^2 must exceed for straight edges (Lemma 11.2).
    pub(crate) fn straightness(self, psi: f64) -> f64 {
        let tube = (psi.powi(2) - psi.powi(-2)).max(0.0).sqrt();
        match self {
            Constants::Corrected => 4.0 * psi.powi(3) * tube,
            Constants::Printed => 2.0 * psi.powi(4) * tube,
        }
    }
}

/// By bisection the greatest number of a range for which something is so, as it is for all smaller ones; the least one where it
/// is so for none.
pub(super) fn greatest([mut low, mut high]: [f64; 2], is_so: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if is_so(middle) { low = middle } else { high = middle }
    }
    low
}

/// The slack omega of squared distances (Lemma 5.5, erratum): d'(p)^2 - d'(q)^2 where the computed distance of p is no
/// greater than that of q, and d(p) no more than epsilon + 2 `error`.
pub(crate) fn slack(net: &Figures, psi: f64, error: f64) -> f64 {
    let reach = net.epsilon + 2.0 * error;
    (psi.powi(2) - psi.powi(-2)) * reach.powi(2) + 4.0 * error * reach / psi.powi(2)
}

/// How far the circumcentres of a Delaunay triangle are apart in the metric and in a uniform one (Lemma 5.13, erratum),
/// in the latter: the least fixed point of chi = eta / sin(asin(mu'' / (2 (psi epsilon + chi))) / 2). `None` where
/// there is none.
pub(crate) fn centre_shift(net: &Figures, psi: f64) -> Option<f64> {
    let reach = psi * net.epsilon;
    let square = (net.mu / psi).powi(2) - ((psi - 1.0 / psi) * net.epsilon).powi(2);
    if square <= 0.0 {
        return None;
    }
    let side = square.sqrt() / psi.powi(2);
    let eta = slack(net, psi, 0.0) / (2.0 * side);
    let mut shift = 0.0;
    for _ in 0..200 {
        let next = eta / (0.5 * (0.5 * side / (reach + shift)).min(1.0).arcsine()).sine();
        if !next.is_finite() || next > 10.0 * reach {
            return None;
        }
        if next - shift <= 1e-12 * reach {
            // A little above the fixed point, where the map lies below the diagonal.
            return Some(next * (1.0 + 1e-9));
        }
        shift = next;
    }
    None
}

/// The net in the uniform metric of a cell's seed (Lemmas 5.2 and 5.15, erratum); `None` where protection is lost.
pub(crate) fn frozen(net: &Figures, psi: f64) -> Option<Figures> {
    let shift = centre_shift(net, psi)?;
    let far = net.epsilon.hypotenuse(net.delta) / psi + psi * net.epsilon;
    let square = (net.delta / psi).powi(2) - slack(net, psi, 0.0) - 2.0 * shift * far;
    (square > 0.0).then(|| Figures { epsilon: psi * net.epsilon, mu: net.mu / psi, delta: square.sqrt() })
}

fn corrected_size(net: &Figures, psi: f64, error: f64) -> Option<f64> {
    let uniform = frozen(net, psi)?;
    let omega = slack(net, psi, error);
    let moved = omega / (omega + uniform.mu.powi(2)) * psi * (net.epsilon + 2.0 * error);
    Some((0.5 * uniform.resolution() - moved) / psi)
}

/// The difference of roots in the report's chi0.
fn roots(net: &Figures, psi: f64) -> f64 {
    let x = 0.5 * net.lambda() / psi.powi(2);
    (1.0 + x).sqrt() - (1.0 - x).max(0.0).sqrt()
}

/// Inequalities (3) and (5) and the size of section 9.3, as printed.
fn printed_size(net: &Figures, psi: f64) -> Option<f64> {
    let Figures { epsilon, delta, .. } = *net;
    let grown = psi.powi(2) - 1.0;
    let shift = 8.0 * epsilon * grown / (net.lambda() * roots(net, psi));
    let least =
        4.0 * (shift * psi).powi(2) + 4.0 * shift * psi.powi(3) * epsilon + (psi.powi(4) - 1.0) * epsilon.powi(2);
    if delta.powi(2) <= least {
        return None;
    }
    let shift = shift * psi.powi(3);
    let square = (delta / psi).powi(2) + (psi.powi(-2) - psi.powi(2)) * (epsilon + shift).powi(2)
        - 4.0 * epsilon * shift / psi.powi(2);
    let (reach, mu) = (psi * epsilon, net.mu / psi);
    let eta = 4.0 * reach.powi(2) * grown / mu;
    let edge = square / (4.0 * reach) - 2.0 * eta * ((2.0 * reach / mu).powi(2) - 1.0).max(0.0).sqrt();
    let sine = mu / reach * (1.0 - (0.5 * mu / reach).powi(2)).max(0.0).sqrt();
    Some(0.5 * (sine * edge).min(edge))
}

#[cfg(test)]
mod tests {
    use super::*;

    const NET: Figures = Figures { epsilon: 1.0, mu: 1.0, delta: 0.999 };

    #[test]
    fn without_distortion_all_sizes_are_that_of_the_uniform_metric() {
        let by_hand = 0.999_f64.powi(2) / 8.0 * 0.75_f64.sqrt();
        for constants in [Constants::Corrected, Constants::Printed] {
            assert!((constants.uniform_size(&NET) - by_hand).abs() < 1e-15);
            assert!((constants.size(&NET, 1.0, 0.0).unwrap() - by_hand).abs() < 1e-12);
        }
    }

    #[test]
    fn scaling_the_net_scales_the_size() {
        let large = Figures { epsilon: 7.0, mu: 7.0, delta: 7.0 * 0.999 };
        let [one, seven] = [&NET, &large].map(|net| Constants::Corrected.size(net, 1.003, 0.0).unwrap());
        assert!((seven / one - 7.0).abs() < 1e-9);
    }

    #[test]
    fn about_a_hundredth_of_distortion_is_allowed_and_less_with_less_protection() {
        let printed = Constants::Printed.distortion_allowed(&NET) - 1.0;
        let corrected = Constants::Corrected.distortion_allowed(&NET) - 1.0;
        // The report's inequality (3) alone allows 0.63 %.
        assert!(printed > 1e-3 && printed < 6.3e-3, "{printed}");
        assert!(corrected > printed && corrected < 0.02, "{corrected}");
        let weak = Figures { delta: 0.2, ..NET };
        assert!(Constants::Corrected.distortion_allowed(&weak) - 1.0 < 0.2 * corrected);
        let none = Figures { delta: 0.0, ..NET };
        assert!(Constants::Corrected.distortion_allowed(&none) - 1.0 < 1e-12);
    }

    #[test]
    fn errors_of_distances_ask_for_a_finer_canvas() {
        let with = |error| Constants::Corrected.size(&NET, 1.0005, error);
        assert!(with(0.0).unwrap() > with(0.005).unwrap());
        assert_eq!(with(0.5), None);
    }

    /// Largest distortions for straight edges with lambda = 1: 4.5 % printed, 1.4 % corrected.
    #[test]
    fn straight_edges_allow_what_the_errata_say() {
        let most = |constants: Constants| {
            let fits = |i: &u32| constants.straightness(1.0 + f64::from(*i) * 1e-4) < 1.0;
            f64::from((0..2000).take_while(fits).count() as u32) * 1e-4
        };
        assert!((most(Constants::Printed) - 0.045).abs() < 2e-3, "{}", most(Constants::Printed));
        assert!((most(Constants::Corrected) - 0.014).abs() < 2e-3, "{}", most(Constants::Corrected));
    }

    /// Triangles around random centres, radii distorted at random: the centre moves by no more than the bound says.
    #[test]
    fn circumcentres_move_by_no_more_than_the_bound() {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (psi, mut most) = (1.02_f64, 0.0_f64);
        let net = Figures { epsilon: 1.0, mu: 0.9, delta: 0.0 };
        let bound = centre_shift(&net, psi).unwrap();
        for _ in 0..20_000 {
            let corner = |angle: f64, share: f64| {
                let r = psi.powf(2.0 * share - 1.0);
                [r * angle.cos(), r * angle.sin()]
            };
            let [a, b, c] = [(); 3].map(|()| corner(std::f64::consts::TAU * next(), next().round()));
            let apart = |p: [f64; 2], q: [f64; 2]| (p[0] - q[0]).hypot(p[1] - q[1]);
            if apart(a, b).min(apart(b, c)).min(apart(c, a)) < net.mu / psi {
                continue;
            }
            let square = |p: [f64; 2]| p[0] * p[0] + p[1] * p[1];
            let ([u, v], [s, t]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
            let (right, other) = (0.5 * (square(b) - square(a)), 0.5 * (square(c) - square(a)));
            let determinant = u * t - v * s;
            most = most.max(((right * t - v * other) / determinant).hypot((u * other - right * s) / determinant));
        }
        assert!(most <= bound && most > 0.2 * bound, "{most} {bound}");
    }
}
