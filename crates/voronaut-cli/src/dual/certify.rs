//! `voronaut dual --certify`: the certificate, and how it is told.

use super::args::DualArgs;
use voronaut::certificate::{Certificate, Condition, Outcome, Verdict};
use voronaut::diagram::Diagram;
use voronaut::net::Net;

/// The certificate, if it is wanted and the net was measured.
pub(crate) fn certificate(
    args: &DualArgs,
    diagram: &Diagram,
    exact: &[[u32; 3]],
    net: Option<&Net>,
) -> Option<Certificate> {
    let net = net.filter(|_| args.is_certified())?;
    Some(Certificate::new(diagram, exact, net, args.constants))
}

/// A certificate in lines of a name and a text: what was measured, then the theorems.
pub(crate) fn lines(found: &Certificate) -> Vec<(String, String)> {
    let net = &found.net;
    let (covered, left) = (found.covered, found.border_not_covered);
    let mut lines = vec![
        (
            "covered".into(),
            format!("{covered} seeds; {left} are within {:.3e} of the border: not covered", found.border_distance),
        ),
        (
            "net".into(),
            format!(
                "epsilon {:.3e}, mu {:.3e}, delta {:.3e} (lambda {:.3}, delta/epsilon {:.3})",
                net.epsilon,
                net.mu,
                net.delta,
                found.lambda,
                net.delta / net.epsilon
            ),
        ),
        ("distortion".into(), format!("psi0 - 1 = {:.3e} (sampled within 6 epsilon)", found.psi - 1.0)),
        (
            "sizes".into(),
            format!("half the longest canvas edge {:.3e}; distances err by {:.1e}", found.size, found.distance_error),
        ),
    ];
    lines.extend(found.verdicts.iter().map(|verdict| (verdict.theorem.to_string(), told(verdict))));
    let asked = match (found.asked_size, found.asked_canvas) {
        (Some(size), Some(cost)) => {
            let (intrinsic, isotropic) = (cost.intrinsic, cost.isotropic);
            format!("s0 = {size:.3e}: about {intrinsic:.1e} canvas vertices (isotropic {isotropic:.1e})")
        }
        _ => "no canvas would do: the net must be denser, or better protected".into(),
    };
    lines.push(("to certify".into(), asked));
    let walks = &found.walks;
    let (ended, started) = (walks.found, walks.started);
    let (mean, most) = (walks.mean_steps, walks.max_steps);
    lines.push((
        "walks".into(),
        format!("{ended} of {started} Voronoi vertices witnessed, {mean:.2} steps ({most} at most)"),
    ));
    lines
}

fn told(verdict: &Verdict) -> String {
    let outcome = match verdict.outcome {
        Outcome::Holds => format!("holds: {} (factor {:.3})", verdict.says, verdict.factor),
        Outcome::Fails => format!("fails: {}", verdict.says),
        Outcome::NotMeasured => {
            let why = verdict.not_measured.as_deref().unwrap_or_default();
            return format!("not measured: {why}");
        }
    };
    let missed: Vec<String> = verdict.conditions.iter().filter(|c| !c.holds).map(missed).collect();
    [&[outcome][..], &missed].concat().join("\n                 ")
}

fn missed(condition: &Condition) -> String {
    let Condition { what, measured, limit, factor, .. } = condition;
    if factor.is_finite() {
        return format!("not so: {what}: {measured:.3e} against {limit:.3e}, by {factor:.3}");
    }
    format!("not so: {what}")
}
