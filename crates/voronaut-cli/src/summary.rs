//! What a run says when it is done: one screen on stdout.

use crate::aside::say_aside;
use crate::flags::flagged;
use crate::options::Run;
use serde_json::Value;
use std::io::Write as _;
use std::path::Path;
use voronaut::certificate::{Certificate, Condition, Outcome, Verdict};
use voronaut::quality::{Cause, CauseFigures, Deviation, Farthest, Needles, Position, Spot, SurfaceFidelity};
use voronaut_io::{Report, Strayed};

/// How wide the names of figures are.
pub(crate) const WIDTH: usize = 12;

/// A name and a text for each line.
type Lines = Vec<(String, String)>;

/// Prints the figures of a report unless told to be quiet, and its notes on stderr.
pub(crate) fn print(title: &Path, report: &Report, run: &Run) {
    if !run.quiet {
        say(&title.display().to_string(), WIDTH, summary(report, run.verbose));
        notes(&report.notes, false);
    }
}

/// Prints a title, and lines of a name, so wide, and a text.
pub(crate) fn say(title: &str, width: usize, lines: Lines) {
    let lines = lines.into_iter().map(|(name, text)| format!("  {name:<width$} {text}\n"));
    out(&format!("{title}\n{}", lines.collect::<String>()));
}

/// Prints a text.
pub(crate) fn out(text: &str) {
    // Whoever closed the other end of a pipe has seen enough.
    let _ = std::io::stdout().write_all(text.as_bytes());
}

/// Says on stderr what is worth knowing, unless told to be quiet.
pub(crate) fn notes(notes: impl IntoIterator<Item: AsRef<str>>, is_quiet: bool) {
    if !is_quiet {
        for note in notes {
            say_aside(&format!("note: {}", flagged(note.as_ref())));
        }
    }
}

/// Prints what a run of `distance` has found, from its report, unless told to be quiet.
pub(crate) fn print_distance(title: &Path, told: &Value, run: &Run) {
    if run.quiet {
        return;
    }
    let all = [
        ("distance", &told["distance"]),
        ("path", &told["path_length"]),
        ("farthest", &told["farthest"]),
        ("canvas", &told["canvas"]["vertices"]),
        ("seconds", &told["seconds"]["total"]),
    ];
    let known = all.into_iter().filter(|(_, value)| !value.is_null());
    say(&title.display().to_string(), WIDTH, known.map(|(name, value)| (name.into(), value.to_string())).collect());
    notes(told["notes"].as_array().into_iter().flatten().filter_map(Value::as_str), false);
    if let Some(count) = told["unreached"].as_u64().filter(|&count| count > 0) {
        say_aside(&format!("note: {count} canvas vertices are not reached: infinite in the file"));
    }
}

/// Prints what a run of `metric` has made, from its report, unless told to be quiet.
pub(crate) fn print_metric(title: &Path, told: &Value, run: &Run) {
    if run.quiet {
        return;
    }
    let number = |value: &Value| value.as_f64().map_or("unknown".into(), |x| format!("{x:.4e}"));
    let touched = |name: &str| format!("{name} {}", told["touched"][name]);
    let limits = ["h_min", "h_max", "a_max", "gradation"].map(touched).join(", ");
    let (complexity, vertices) = (&told["complexity"], &told["expected_vertices"]);
    let lines = [
        ("complexity", format!("{complexity}   (a unit mesh of about {vertices} vertices)")),
        ("sizes", format!("{} to {}", number(&told["size"]["min"]), number(&told["size"]["max"]))),
        ("anisotropy", format!("{} at most", number(&told["anisotropy"]["max"]))),
        ("factor", format!("{}   (on the combined metric)", told["factor"])),
        ("touched", format!("of {} vertices: {limits}", told["vertices"])),
        ("time", format!("{:.2} s", told["seconds"]["total"].as_f64().unwrap_or(0.0))),
    ];
    say(&title.display().to_string(), WIDTH, lines.map(|(name, text)| (name.into(), text)).to_vec());
}

fn summary(report: &Report, verbose: bool) -> Lines {
    let mut lines = Lines::new();
    let mut line = |name: &str, value: String| lines.push((name.into(), value));
    line("vertices", report.vertices.to_string());
    line("triangles", report.triangles.to_string());
    if let Some(curved) = &report.curved {
        line("order", format!("{}   ({} nodes beside the vertices)", curved["order"], curved["nodes"]));
    }
    line("valid", valid(report));
    if let Some(lengths) = report.metric_edge_length {
        let (min, mean, max) = (lengths.min, lengths.mean, lengths.max);
        let share = 100.0 * lengths.unit_fraction;
        line("unit edges", format!("{share:.1} %   (metric length {min:.3} to {max:.3}, mean {mean:.3})"));
        if let Some(found) = report.closed_form {
            let (share, scale) = (100.0 * found.unit_fraction, found.metric_scale);
            let scale = if scale < 1e-3 { format!("{scale:.5e}") } else { format!("{scale:.6}") };
            line("", format!("{share:.1} % at the metric scale that N asks for in closed form, {scale}"));
        }
    }
    for (i, says) in unmet_lines(report).into_iter().enumerate() {
        line(if i == 0 { "not met" } else { "" }, says);
    }
    if let (Some(quality), Some(angle)) = (report.quality, report.angle) {
        line("quality", format!("{:.3} mean, {:.3} min", quality.mean, quality.min));
        line("angles", format!("{:.1} deg mean of the smallest, {:.1} deg min", angle.mean_min, angle.min));
    }
    if let Some(worst) = report.worst {
        line("worst", format!("triangle at {}", place(worst.triangle)));
        line("", format!("longest edge at {}, shortest at {}", place(worst.longest_edge), place(worst.shortest_edge)));
    }
    match &report.fidelity {
        Some(Strayed::Boundary(fidelity)) => {
            line("to domain", distance(fidelity.mesh_to_domain));
            line("from domain", distance(fidelity.domain_to_mesh));
        }
        Some(Strayed::Surface(fidelity)) => {
            surface_lines(fidelity, &mut line);
        }
        None => {}
    }
    if let Some(found) = report.star_set {
        let (stars, picks) = (found.figures, found.counters);
        let (disagree, rounds) = (stars.inconsistencies, stars.rounds);
        let (picked, unpicked) = (picks.picked, picks.unpicked);
        line("stars", format!("{disagree} inconsistencies; {rounds} rounds, {picked} vertices picked, {unpicked} not"));
    }
    if let Some(found) = &report.interpolation {
        let (error, max) = (found.norm, found.max);
        line("error", format!("{error:.3e} in L^{}, {:.3e} at most, at {}", found.p, max.value, position(max.at)));
    }
    if let Some(scale) = report.metric_scale {
        line("metric scale", format!("{scale}"));
    }
    if let (Some(dual), true) = (&report.dual, verbose) {
        let tests: Vec<String> = dual.geodesic_tests.iter().map(u64::to_string).collect();
        line("tests", format!("{} by level; {} edges uncertain", tests.join(" + "), dual.uncertain));
        line("margin", format!("{:.2e}; {} blocked flips", dual.min_margin, dual.blocked_flips));
        let (differ, compared) = (dual.disagreements.len(), dual.compared);
        line("roads", format!("lengths and diagram differ on {differ} of {compared} edges compared"));
    }
    if verbose {
        report.seconds.stages.iter().for_each(|(name, time)| line(name, format!("{time:.2} s")));
    }
    if let Some(certificate) = &report.certificate {
        certificate_lines(certificate, &mut line);
    }
    let memory = report.peak_memory_bytes.map(|bytes| format!(", {} MB at most", bytes / 1_000_000));
    line("time", format!("{:.2} s{}", report.seconds.total, memory.unwrap_or_default()));
    lines
}

/// How many edges are not of unit length, and why, and how many triangles are needles; nothing where there are none.
fn unmet_lines(report: &Report) -> Vec<String> {
    let Some(unmet) = report.unmet.as_ref().filter(|unmet| unmet.edges > 0) else { return Vec::new() };
    let needles = unmet.needles.poorest.first().map(|first| {
        let Needles { count, forced, .. } = unmet.needles;
        format!(
            "{count} needles, {forced} of them forced by features; the first at {}: {:.1e}",
            position(first.at),
            first.quality
        )
    });
    let causes = unmet.by_cause.iter().filter(|(_, found)| found.count > 0);
    let shares = causes.clone().map(|(cause, found)| format!("{} {}", share(found.share), cause.name()));
    let of_edges = format!("{} of edges: {}", share(unmet.share), shares.collect::<Vec<_>>().join(", "));
    let far = |(_, found): &(&Cause, &CauseFigures)| found.worst.map_or(0.0, |worst| worst.length.ln().abs());
    let worst = causes.max_by(|a, b| far(a).total_cmp(&far(b)));
    let says = |(cause, found): (&Cause, &CauseFigures)| {
        found.worst.map(|worst| format!("worst at {}: {:.3}, {}", position(worst.at), worst.length, cause.name()))
    };
    [Some(of_edges), worst.and_then(says), needles].into_iter().flatten().collect()
}

/// A share in per cent; never nothing of something.
fn share(share: f64) -> String {
    if share > 0.0 && share < 0.0005 { "< 0.1 %".into() } else { format!("{:.1} %", 100.0 * share) }
}

fn valid(report: &Report) -> String {
    let found = &report.validity;
    match &found.first_fault {
        None => format!("yes   (Euler number {}, boundary loops {})", found.euler, found.boundary_loops),
        Some(fault) => format!("no: {fault}"),
    }
}

/// How far the mesh of a surface strays from it.
fn surface_lines(found: &SurfaceFidelity, mut line: impl FnMut(&str, String)) {
    let side = |side: Deviation| {
        let (most, share, rms) = (side.hausdorff, 100.0 * side.hausdorff_share, side.rms);
        format!("{most:.3e} at most ({share:.2e} % of the diagonal), rms {rms:.3e}, at {}", position(side.at))
    };
    line("to surface", side(found.mesh_to_surface));
    line("from surface", side(found.surface_to_mesh));
    if let Some(curved) = found.curved {
        line("with curves", side(curved));
    }
    let (vertices, normals) = (found.vertex_to_surface, found.normal_deviation);
    line("vertices", format!("off by {:.3e} at most, at {}", vertices.value, position(vertices.at)));
    let (mean, most, at) = (normals.mean, normals.max.value, position(normals.max.at));
    line("normals", format!("{mean:.2} deg mean, {most:.2} deg at {at}; {} triangles folded over", found.folded));
}

fn place(spot: Spot) -> String {
    format!("{}: {:.3}", position(spot.at), spot.value)
}

fn position(at: Position) -> String {
    let coordinates: Vec<String> = at.coordinates().iter().map(|x| format!("{x:.6}")).collect();
    format!("({})", coordinates.join(", "))
}

fn distance(farthest: Option<Farthest>) -> String {
    farthest
        .map_or("nothing to measure".into(), |far| format!("{:.3e} at ({}, {})", far.distance, far.at[0], far.at[1]))
}

/// A certificate: what was measured, then the theorems.
fn certificate_lines(found: &Certificate, mut line: impl FnMut(&str, String)) {
    let (covered, left, border) = (found.covered, found.border_not_covered, found.border_distance);
    let (epsilon, mu, delta, lambda) = (found.net.epsilon, found.net.mu, found.net.delta, found.lambda);
    if covered == 0 {
        line("covered", format!("none of {left} seeds: all are too near to the border"));
    } else {
        line("covered", format!("{covered} seeds; {left} are within {border:.3e} of the border: not covered"));
        let ratios = format!("lambda {lambda:.3}, delta/epsilon {:.3}", delta / epsilon);
        line("net", format!("epsilon {epsilon:.3e}, mu {mu:.3e}, delta {delta:.3e} ({ratios})"));
        line("distortion", format!("psi0 - 1 = {:.3e} (sampled within 6 epsilon)", found.psi - 1.0));
        let (size, error) = (found.size, found.distance_error);
        line("sizes", format!("half the longest canvas edge {size:.3e}; distances err by {error:.1e}"));
    }
    found.verdicts.iter().for_each(|verdict| line(verdict.theorem, told(verdict)));
    let asked = match (found.asked_size, found.asked_canvas) {
        (Some(size), Some(cost)) => {
            let (intrinsic, isotropic) = (cost.intrinsic, cost.isotropic);
            format!("s0 = {size:.3e}: about {intrinsic:.1e} canvas vertices (isotropic {isotropic:.1e})")
        }
        _ => "no canvas would do: the net must be denser, or better protected".into(),
    };
    line("to certify", asked);
    let walks = &found.walks;
    let (ended, started, mean, most) = (walks.found, walks.started, walks.mean_steps, walks.max_steps);
    line("walks", format!("{ended} of {started} Voronoi vertices witnessed, {mean:.2} steps ({most} at most)"));
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
