//! What is reported of any mesh that we made.

use crate::curves;
use serde_json::Value;
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};
use voronaut::figures::NetFigures;
use voronaut::manifold::Riemannian;
use voronaut::manifold::surface::Mended;
use voronaut::mesh::Mesh;
use voronaut::quality::{Unmet, metric_quality, unmet};
use voronaut::recipe::Meshed;
use voronaut::{Error, Result};
use voronaut_io::{ClosedForm, Report, Seconds, Strayed};

/// A mesh of ours that is not valid is our fault, not the user's.
pub(crate) fn ours(error: Error) -> Error {
    match error {
        Error::Mesh { what, place, .. } => {
            let help = "this is a fault of voronaut: nothing was written; please report it with the input";
            Error::mesh(what, place, help)
        }
        other => other,
    }
}

/// The report of a mesh in the metric times the factor that it was made for; and its edges that are not of unit length. Neither is measured where nobody
/// is told.
pub(crate) fn of(
    meshed: &Meshed,
    on: Riemannian,
    mended: &Mended,
    options: Value,
    is_told: bool,
) -> Result<(Report, Unmet)> {
    let meets = meshed.validity.meetings.note();
    let (mut report, mut unmet) = (report(meshed, options), Unmet::default());
    if is_told {
        unmet = measure(&mut report, &meshed.mesh, on)?;
        report.closed_form = closed_form(meshed, &unmet);
    }
    report.notes.extend(mended.sentences().chain(meets));
    report.fidelity = meshed.fidelity.map(|found| Strayed::Surface(found.into()));
    Ok((report, unmet))
}

/// The share of unit edges at the factor that the number of vertices asks for; of straight edges, for curved ones have that factor.
fn closed_form(meshed: &Meshed, unmet: &Unmet) -> Option<ClosedForm> {
    let is_straight = meshed.mesh.curved.is_none();
    let metric_scale = meshed.closed_form_scale.filter(|_| is_straight && !unmet.lengths.is_empty())?;
    let ratio = (metric_scale / meshed.metric_scale).sqrt();
    let is_unit = |length: &&f64| (FRAC_1_SQRT_2..=SQRT_2).contains(&(*length * ratio));
    let unit_fraction = unmet.lengths.iter().filter(is_unit).count() as f64 / unmet.lengths.len() as f64;
    Some(ClosedForm { metric_scale, unit_fraction })
}

/// Adds what a mesh is in a metric; its edges that are not of unit length.
pub(crate) fn measure(report: &mut Report, mesh: &Mesh, on: Riemannian) -> Result<Unmet> {
    if let Riemannian::Surface(_, metric) = on {
        report.curvature = metric.curvature_figures();
    }
    let unmet = unmet(mesh, on, |_| ())?;
    match &unmet.quality {
        Some(quality) => report.add_quality(quality),
        None => report.add_quality(&metric_quality(mesh, on)?),
    }
    report.unmet = Some(unmet.figures());
    Ok(unmet)
}

/// The parts that are the same for plane and surface, and the options as used.
fn report(meshed: &Meshed, options: Value) -> Report {
    let is_voronoi = meshed.star_set.is_none();
    let mut report = Report {
        star_set: meshed.star_set,
        dual: is_voronoi.then(|| meshed.dual.clone()),
        relaxation: is_voronoi.then(|| meshed.relaxation.clone()),
        polished: meshed.polished.clone().filter(|_| is_voronoi),
        canvas: meshed.canvas,
        diagram: meshed.diagram.clone(),
        metric_scale: Some(meshed.metric_scale),
        net: meshed.net.as_ref().map(NetFigures::of).or_else(|| meshed.surface_net.as_ref().map(NetFigures::of)),
        protection: meshed.protection,
        notes: meshed.notes.clone(),
        seconds: Seconds { stages: meshed.seconds.clone(), total: 0.0 },
        options,
        ..Report::new(&meshed.mesh, meshed.validity.clone())
    };
    curves::report(&mut report, &meshed.mesh);
    report
}

/// Two objects of a report as one.
pub(crate) fn joined(mut one: Value, other: Value) -> Value {
    if let (Value::Object(one), Value::Object(other)) = (&mut one, other) {
        one.extend(other);
    }
    one
}
