//! What is said of a theorem: its conditions, measured, and whether it holds.

use serde::Serialize;

/// Whether a theorem's conclusion is guaranteed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// All conditions hold, and all were checked.
    Holds,
    /// A condition does not hold. The conclusion may still be true.
    Fails,
    /// No condition that was checked fails, and not all were.
    NotMeasured,
}

/// A condition of a theorem.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Condition {
    /// In words.
    pub what: &'static str,
    /// What was measured.
    pub measured: f64,
    /// What it must be below, or above.
    pub limit: f64,
    /// By what the measured value misses the limit: 1 at the limit, less where the condition holds, infinite where no
    /// factor would do.
    pub factor: f64,
    /// Whether the condition holds.
    pub holds: bool,
}

impl Condition {
    /// `measured < limit`, both not negative.
    pub(crate) fn below(what: &'static str, measured: f64, limit: f64) -> Self {
        let factor = if measured == 0.0 && limit > 0.0 { 0.0 } else { measured / limit };
        let holds = measured < limit;
        Self { what, measured, limit, factor: if limit > 0.0 { factor } else { f64::INFINITY }, holds }
    }

    /// `measured > limit`, both not negative.
    pub(crate) fn above(what: &'static str, measured: f64, limit: f64) -> Self {
        let inverse = Self::below(what, limit, measured);
        Self { measured, limit, ..inverse }
    }

    /// A fact: it is so, or it is not.
    pub(crate) fn fact(what: &'static str, is_so: bool) -> Self {
        let factor = if is_so { 0.0 } else { f64::INFINITY };
        Self { what, measured: f64::from(u8::from(is_so)), limit: 1.0, factor, holds: is_so }
    }
}

/// What is said of a theorem.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Its number in RR-9103.
    pub theorem: &'static str,
    /// What it guarantees, of the covered cells.
    pub says: &'static str,
    /// Whether it does.
    pub outcome: Outcome,
    /// The greatest factor by which a condition is missed; below 1 where all hold.
    pub factor: f64,
    /// Its conditions.
    pub conditions: Vec<Condition>,
    /// Why a hypothesis could not be checked.
    pub not_measured: Option<String>,
    /// The sizing field s0 that it asks of the canvas, in the metric: no edge is longer than twice that. `None` where
    /// no canvas would do, or it asks none.
    pub size: Option<f64>,
}

impl Verdict {
    pub(super) fn new(
        theorem: &'static str,
        says: &'static str,
        conditions: Vec<Condition>,
        not_measured: Option<String>,
    ) -> Self {
        let is_unknown = |condition: &Condition| condition.measured.is_nan() || condition.limit.is_nan();
        let unknown = conditions.iter().find(|condition| is_unknown(condition));
        let not_measured =
            not_measured.or_else(|| unknown.map(|condition| format!("no figure for: {}", condition.what)));
        let outcome = match &not_measured {
            _ if conditions.iter().any(|condition| !condition.holds && !is_unknown(condition)) => Outcome::Fails,
            Some(_) => Outcome::NotMeasured,
            None => Outcome::Holds,
        };
        let factor = conditions.iter().map(|condition| condition.factor).fold(0.0, f64::max);
        Self { theorem, says, outcome, factor, conditions, not_measured, size: None }
    }

    /// Whether the theorem's conclusion is guaranteed.
    pub(crate) fn holds(&self) -> bool {
        self.outcome == Outcome::Holds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_not_measured_never_holds() {
        let good = Condition::below("small", 1.0, 2.0);
        let bad = Condition::above("large", 1.0, 2.0);
        let outcome = |conditions: &[Condition], doubt: Option<&str>| {
            Verdict::new("0", "nothing", conditions.to_vec(), doubt.map(String::from)).outcome
        };
        assert_eq!(outcome(&[good], None), Outcome::Holds);
        assert_eq!(outcome(&[good], Some("why")), Outcome::NotMeasured);
        assert_eq!(outcome(&[good, bad], Some("why")), Outcome::Fails);
        let nan = Condition::below("nothing known", f64::NAN, 2.0);
        assert_eq!(outcome(&[nan], None), Outcome::NotMeasured);
        assert_eq!(outcome(&[nan, bad], None), Outcome::Fails);
        assert!((good.factor - 0.5).abs() < 1e-15 && (bad.factor - 2.0).abs() < 1e-15);
        assert!(Condition::fact("no", false).factor.is_infinite());
    }
}
