//! The verdicts on RR-9103's theorems, from what was measured. Pure functions.

use super::constants::{Constants, Figures, centre_shift, greatest};
use super::convexity::Convexity;
use super::verdict::{Condition, Outcome, Verdict};

/// What was measured of seeds, metric and canvas. Lengths are of the metric but for those called Euclidean.
#[derive(Clone, Debug)]
pub(crate) struct Evidence {
    /// Which formulas.
    pub constants: Constants,
    /// The net of the cells that end at other cells.
    pub net: Figures,
    /// The greatest distortion around a covered seed.
    pub psi: f64,
    /// The eigenvalues of the tensor, the smaller first, where it is the same everywhere.
    pub uniform: Option<[f64; 2]>,
    /// Half the longest canvas edge between vertices of inner cells.
    pub size: f64,
    /// The same, Euclidean.
    pub euclidean_size: f64,
    /// The greatest error of distances on the canvas that was found.
    pub distance_error: f64,
    /// Convex disks.
    pub convexity: Convexity,
    /// What keeps the seeds from being a net, or there is nothing to speak of.
    pub doubt: Option<String>,
}

const NERVE: &str = "the canvas's three-coloured faces are the dual";
const STRAIGHT: &str = "the dual with straight edges is embedded";
const EDGE: &str = "half the longest canvas edge is below s0";

/// Below this share of epsilon delta may be an error of the lengths that it comes from: its square is that of a difference of
/// squares.
const CERTAIN: f64 = 1e-3;

/// Whether two eigenvalues are the same but for rounding.
fn is_round([small, large]: [f64; 2]) -> bool {
    large - small <= 1e-9 * large
}

impl Evidence {
    /// Verdicts on Theorems 9.1, 9.9 and 9.10, on section 9.4, on Theorem 10.20 and Lemma 11.2, in this order.
    pub(crate) fn verdicts(&self) -> Vec<Verdict> {
        let embedded = self.geodesic_dual();
        let straight = self.straight_dual(&embedded);
        let arbitrary = self.nerve("9.10", NERVE, 0.0, vec![]);
        vec![self.euclidean(), self.of_uniform(), arbitrary, self.with_errors(), embedded, straight]
    }

    /// Verdicts on the same theorems on a surface, in charts, but for Lemma 11.2: section 12 has no constants for straight edges in
    /// space.
    pub(super) fn on_surface(&self) -> Vec<Verdict> {
        let why = "section 12 gives no constants for straight edges in space".to_string();
        let straight = Verdict::new("11.2", STRAIGHT, vec![], Some(why));
        let of_plane = self.verdicts().into_iter().filter(|verdict| verdict.theorem != "11.2");
        of_plane.chain([straight]).collect()
    }

    fn protected(&self) -> Condition {
        let what = "the net is power-protected: delta above a thousandth of epsilon";
        Condition::above(what, self.net.delta, CERTAIN * self.net.epsilon)
    }

    fn euclidean(&self) -> Verdict {
        let size = self.constants.uniform_size(&self.net);
        let conditions = vec![
            Condition::fact("the metric is Euclidean, but for scale", self.uniform.is_some_and(is_round)),
            self.protected(),
            Condition::below(EDGE, self.size, size),
        ];
        Verdict::new("9.1", NERVE, conditions, self.doubt.clone()).asking(size)
    }

    fn of_uniform(&self) -> Verdict {
        let size = self.constants.uniform_size(&self.net);
        let edge = match (self.constants, self.uniform) {
            // The report bounds Euclidean lengths.
            (Constants::Printed, Some(eigenvalues)) => {
                let what = "half the longest canvas edge (Euclidean) is below alpha s0";
                Condition::below(what, self.euclidean_size, self.constants.alpha(eigenvalues) * size)
            }
            _ => Condition::below(EDGE, self.size, size),
        };
        let is_uniform = Condition::fact("the metric is the same everywhere", self.uniform.is_some());
        Verdict::new("9.9", NERVE, vec![is_uniform, self.protected(), edge], self.doubt.clone()).asking(size)
    }

    fn with_errors(&self) -> Verdict {
        // What errors leave of the sizing field: none where they are as large as the slack of the net.
        let what = "the error of distances is below what the net allows";
        let condition = Condition::below(what, self.distance_error, self.greatest_error());
        let says = "the same, with the distances that the canvas computes";
        self.nerve("9.4", says, self.distance_error, vec![condition])
    }

    fn nerve(&self, theorem: &'static str, says: &'static str, error: f64, more: Vec<Condition>) -> Verdict {
        let allowed = self.constants.distortion_allowed(&self.net);
        let what = "psi0 - 1 within 6 epsilon of a seed is below what the net allows";
        let mut conditions = vec![self.protected(), Condition::below(what, self.psi - 1.0, allowed - 1.0)];
        conditions.extend(more);
        let size = self.constants.size(&self.net, self.psi, error);
        let none = if error.is_nan() { error } else { self.none() };
        conditions.push(Condition::below(EDGE, self.size, size.unwrap_or(none)));
        Verdict::new(theorem, says, conditions, self.doubt.clone()).asking(size.unwrap_or(0.0))
    }

    /// The greatest error of distances with which some canvas would do; 0 where none does without errors.
    fn greatest_error(&self) -> f64 {
        let is_enough = |error: f64| self.constants.size(&self.net, self.psi, error).is_some();
        if is_enough(0.0) { greatest([0.0, self.net.epsilon], is_enough) } else { self.none() }
    }

    /// The limit where no size would do: 0, but unknown where net or distortion was not measured.
    fn none(&self) -> f64 {
        if (self.net.epsilon + self.psi).is_nan() { f64::NAN } else { 0.0 }
    }

    fn geodesic_dual(&self) -> Verdict {
        let Convexity { radius, bend, .. } = self.convexity;
        let conditions = vec![
            Condition::below("epsilon is below a sixth of the convexity radius", self.net.epsilon, radius / 6.0),
            Condition::above("no three vertices of a triangle are on a geodesic: sides' excess above 0", bend, 0.0),
            // The dual of four cells that meet is no triangle.
            self.protected(),
        ];
        let doubt = self.doubt.clone().or_else(|| self.convexity.doubt());
        Verdict::new("10.20", "the dual with geodesic edges is embedded", conditions, doubt)
    }

    fn straight_dual(&self, geodesic: &Verdict) -> Verdict {
        let (net, psi) = (&self.net, self.psi);
        let least = self.constants.straightness(psi);
        let mut conditions = vec![Condition::above("lambda^2 is above its bound", net.lambda().powi(2), least)];
        if self.constants == Constants::Corrected {
            let shift = centre_shift(net, psi).unwrap_or(f64::INFINITY);
            let what = "circumcentres shift by less than psi0 epsilon";
            conditions.push(Condition::below(what, shift, psi * net.epsilon));
        }
        let open = || (geodesic.outcome != Outcome::Holds).then(|| "Theorem 10.20, which it builds on".to_string());
        let doubt = self.doubt.clone().or_else(open);
        Verdict::new("11.2", STRAIGHT, conditions, doubt)
    }
}

impl Verdict {
    fn asking(self, size: f64) -> Self {
        Self { size: (size > 0.0).then_some(size), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn evidence() -> Evidence {
        let net = Figures { epsilon: 1.0, mu: 1.2, delta: 1.0 };
        let convexity = Convexity { radius: f64::INFINITY, bend: 0.3, ..Convexity::default() };
        Evidence {
            constants: Constants::Corrected,
            net,
            psi: 1.0,
            uniform: Some([1.0, 1.0]),
            size: 0.9 * Constants::Corrected.uniform_size(&net),
            euclidean_size: 1.0,
            distance_error: 1e-6,
            convexity,
            doubt: None,
        }
    }

    fn holding(evidence: &Evidence) -> Vec<&'static str> {
        evidence.verdicts().into_iter().filter(Verdict::holds).map(|verdict| verdict.theorem).collect()
    }

    #[test]
    fn everything_holds_of_a_good_net_on_a_fine_canvas_and_each_flaw_has_its_theorems() {
        let good = evidence();
        assert_eq!(holding(&good), ["9.1", "9.9", "9.10", "9.4", "10.20", "11.2"]);
        let turned = Evidence { uniform: Some([1.0, 4.0]), ..good.clone() };
        assert_eq!(holding(&turned), ["9.9", "9.10", "9.4", "10.20", "11.2"]);
        let varied = Evidence { uniform: None, psi: 1.0001, ..good.clone() };
        assert_eq!(holding(&varied), ["9.10", "9.4", "10.20", "11.2"]);
        let coarse = Evidence { size: 2.0 * good.size, ..good.clone() };
        assert_eq!(holding(&coarse), ["10.20", "11.2"]);
        let wrong = Evidence { distance_error: 0.5, ..good.clone() };
        assert_eq!(holding(&wrong), ["9.1", "9.9", "9.10", "10.20", "11.2"]);
        let bare = Evidence { net: Figures { delta: 0.0, ..good.net }, ..good.clone() };
        assert!(holding(&bare).is_empty());
        let curved = Evidence { convexity: Convexity { radius: 5.0, ..good.convexity }, ..good.clone() };
        assert_eq!(holding(&curved), ["9.1", "9.9", "9.10", "9.4"]);
        assert!(holding(&Evidence { doubt: Some("why".into()), ..good }).is_empty());
    }

    #[test]
    fn sizes_are_those_that_make_theorems_hold() {
        let varied = Evidence { uniform: None, psi: 1.002, ..evidence() };
        let size = varied.verdicts()[3].size.unwrap();
        let with = |size: f64| (Evidence { size, ..varied.clone() }).verdicts()[3].holds();
        assert!(with(0.999 * size) && !with(1.001 * size));
        let far = Evidence { psi: 1.2, ..varied };
        assert_eq!(far.verdicts()[2].size, None);
        assert!(far.verdicts()[2].factor > 10.0);
    }

    #[test]
    fn the_report_s_alpha_refuses_what_is_fine_and_passes_what_is_coarse() {
        let with = |eigenvalues, euclidean_size| {
            let evidence =
                Evidence { constants: Constants::Printed, uniform: Some(eigenvalues), euclidean_size, ..evidence() };
            evidence.verdicts()[1].holds()
        };
        let asked = Constants::Printed.uniform_size(&evidence().net);
        // In the metric 100 I a Euclidean length is ten times as long: the report lets it be a hundred times too long
        // instead.
        assert!(with([100.0, 100.0], 5.0 * asked));
        assert!(!with([0.01, 0.01], 5.0 * asked));
    }
}
