//! The verdicts on RR-9103's theorems, from what was measured. Pure functions.

use super::constants::{Constants, Figures, centre_shift};
use super::convexity::Convexity;
use super::verdict::{Condition, Outcome, Verdict};

/// What was measured of seeds, metric and canvas. Lengths are of the metric but for those called Euclidean.
#[derive(Clone, Debug)]
pub struct Evidence {
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
const EDGE: &str = "half the longest canvas edge is below s0";

/// Below this share of epsilon delta may be an error of the lengths that it comes from: its square is that of a difference of
/// squares.
const CERTAIN: f64 = 1e-3;

/// Verdicts on Theorems 9.1, 9.9 and 9.10, on section 9.4, on Theorem 10.20 and Lemma 11.2, in this order.
pub fn verdicts(evidence: &Evidence) -> Vec<Verdict> {
    let embedded = geodesic_dual(evidence);
    let straight = straight_dual(evidence, &embedded);
    vec![euclidean(evidence), uniform(evidence), arbitrary(evidence), with_errors(evidence), embedded, straight]
}

/// Whether two eigenvalues are the same but for rounding.
fn is_round([small, large]: [f64; 2]) -> bool {
    large - small <= 1e-9 * large
}

fn protected(evidence: &Evidence) -> Condition {
    let least = CERTAIN * evidence.net.epsilon;
    Condition::above("the net is power-protected: delta above a thousandth of epsilon", evidence.net.delta, least)
}

fn euclidean(evidence: &Evidence) -> Verdict {
    let is_euclidean = evidence.uniform.is_some_and(is_round);
    let size = evidence.constants.uniform_size(&evidence.net);
    let conditions = vec![
        Condition::fact("the metric is Euclidean, but for scale", is_euclidean),
        protected(evidence),
        Condition::below(EDGE, evidence.size, size),
    ];
    Verdict::new("9.1", NERVE, conditions, evidence.doubt.clone()).asking(size)
}

fn uniform(evidence: &Evidence) -> Verdict {
    let size = evidence.constants.uniform_size(&evidence.net);
    let edge = match (evidence.constants, evidence.uniform) {
        // The report bounds Euclidean lengths.
        (Constants::Printed, Some(eigenvalues)) => {
            let limit = evidence.constants.alpha(eigenvalues) * size;
            Condition::below(
                "half the longest canvas edge (Euclidean) is below alpha s0",
                evidence.euclidean_size,
                limit,
            )
        }
        _ => Condition::below(EDGE, evidence.size, size),
    };
    let is_uniform = Condition::fact("the metric is the same everywhere", evidence.uniform.is_some());
    Verdict::new("9.9", NERVE, vec![is_uniform, protected(evidence), edge], evidence.doubt.clone()).asking(size)
}

fn arbitrary(evidence: &Evidence) -> Verdict {
    nerve("9.10", NERVE, evidence, 0.0, vec![])
}

fn with_errors(evidence: &Evidence) -> Verdict {
    let error = evidence.distance_error;
    let says = "the same, with the distances that the canvas computes";
    // What errors leave of the sizing field: none where they are as large as the slack of the net.
    let most = greatest_error(evidence);
    nerve(
        "9.4",
        says,
        evidence,
        error,
        vec![Condition::below("the error of distances is below what the net allows", error, most)],
    )
}

fn nerve(
    theorem: &'static str,
    says: &'static str,
    evidence: &Evidence,
    error: f64,
    mut conditions: Vec<Condition>,
) -> Verdict {
    let allowed = evidence.constants.distortion_allowed(&evidence.net);
    let what = "psi0 - 1 within 6 epsilon of a seed is below what the net allows";
    conditions.insert(0, protected(evidence));
    conditions.insert(1, Condition::below(what, evidence.psi - 1.0, allowed - 1.0));
    let size = evidence.constants.size(&evidence.net, evidence.psi, error);
    let none = if error.is_nan() { error } else { none_of(evidence) };
    conditions.push(Condition::below(EDGE, evidence.size, size.unwrap_or(none)));
    let doubt = evidence.doubt.clone();
    let verdict = Verdict::new(theorem, says, conditions, doubt);
    size.map_or(verdict.clone(), |size| verdict.asking(size))
}

/// The greatest error of distances with which some canvas would do; 0 where none does without errors.
fn greatest_error(evidence: &Evidence) -> f64 {
    let (mut low, mut high) = (0.0, evidence.net.epsilon);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        let is_enough = evidence.constants.size(&evidence.net, evidence.psi, middle).is_some();
        if is_enough { low = middle } else { high = middle }
    }
    // Bisection never ends at 0.
    let is_none = evidence.constants.size(&evidence.net, evidence.psi, 0.0).is_none();
    if is_none { none_of(evidence) } else { low }
}

/// The limit where no size would do: 0, but unknown where net or distortion was not measured.
fn none_of(evidence: &Evidence) -> f64 {
    if (evidence.net.epsilon + evidence.psi).is_nan() { f64::NAN } else { 0.0 }
}

fn geodesic_dual(evidence: &Evidence) -> Verdict {
    let Convexity { radius, bend, .. } = evidence.convexity;
    let conditions = vec![
        Condition::below("epsilon is below a sixth of the convexity radius", evidence.net.epsilon, radius / 6.0),
        Condition::above("no three vertices of a triangle are on a geodesic: sides' excess above 0", bend, 0.0),
        // The dual of four cells that meet is no triangle.
        protected(evidence),
    ];
    let doubt = evidence.doubt.clone().or_else(|| evidence.convexity.doubt());
    Verdict::new("10.20", "the dual with geodesic edges is embedded", conditions, doubt)
}

fn straight_dual(evidence: &Evidence, geodesic: &Verdict) -> Verdict {
    let (net, psi) = (&evidence.net, evidence.psi);
    let least = evidence.constants.straightness(psi);
    let mut conditions = vec![Condition::above("lambda^2 is above its bound", net.lambda().powi(2), least)];
    if evidence.constants == Constants::Corrected {
        let shift = centre_shift(net, psi).unwrap_or(f64::INFINITY);
        conditions.push(Condition::below("circumcentres shift by less than psi0 epsilon", shift, psi * net.epsilon));
    }
    let doubt = evidence.doubt.clone();
    let open = || (geodesic.outcome != Outcome::Holds).then(|| "Theorem 10.20, which it builds on".to_string());
    Verdict::new("11.2", "the dual with straight edges is embedded", conditions, doubt.or_else(open))
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
        verdicts(evidence).into_iter().filter(Verdict::holds).map(|verdict| verdict.theorem).collect()
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
        let size = verdicts(&varied)[3].size.unwrap();
        let with = |size: f64| verdicts(&Evidence { size, ..varied.clone() })[3].holds();
        assert!(with(0.999 * size) && !with(1.001 * size));
        let far = Evidence { psi: 1.2, ..varied };
        assert_eq!(verdicts(&far)[2].size, None);
        assert!(verdicts(&far)[2].factor > 10.0);
    }

    #[test]
    fn the_report_s_alpha_refuses_what_is_fine_and_passes_what_is_coarse() {
        let with = |eigenvalues, euclidean_size| {
            let evidence =
                Evidence { constants: Constants::Printed, uniform: Some(eigenvalues), euclidean_size, ..evidence() };
            verdicts(&evidence)[1].holds()
        };
        let asked = Constants::Printed.uniform_size(&evidence().net);
        // In the metric 100 I a Euclidean length is ten times as long: the report lets it be a hundred times too long
        // instead.
        assert!(with([100.0, 100.0], 5.0 * asked));
        assert!(!with([0.01, 0.01], 5.0 * asked));
    }
}
