//! What is reported of any mesh that we made.

use crate::curves;
use serde_json::Value;
use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};
use voronaut::figures::NetFigures;
use voronaut::manifold::Manifold;
use voronaut::manifold::surface::Mended;
use voronaut::manifold::surface::metric::{Scaled, SurfaceMetric};
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::quality::{Unmet, metric_quality, surface_quality, surface_unmet, unmet};
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

/// The report of a planar mesh, in a metric; and its edges that are not of unit length. Neither is measured where nobody is told.
pub(crate) fn in_plane(
    meshed: &Meshed,
    metric: &dyn MetricField,
    options: Value,
    is_told: bool,
) -> Result<(Report, Unmet)> {
    let (mut report, mut unmet) = (report(meshed, options), Unmet::default());
    if is_told {
        unmet = measure_in_plane(&mut report, &meshed.mesh, metric)?;
        report.closed_form = closed_form(meshed, &unmet);
    }
    Ok((report, unmet))
}

/// The report of the mesh of a surface, in a metric that is still to be scaled; and its edges that are
/// not of unit length. Neither is measured where nobody is told.
pub(crate) fn on_surface(
    meshed: &Meshed,
    input: &Manifold,
    mended: &Mended,
    metric: &dyn SurfaceMetric,
    options: Value,
    is_told: bool,
) -> Result<(Report, Unmet)> {
    let meets = meshed.validity.meetings.note();
    let scaled = Scaled { field: metric, factor: meshed.metric_scale };
    let (mut report, mut unmet) = (report(meshed, options), Unmet::default());
    if is_told {
        unmet = measure_on_surface(&mut report, &meshed.mesh, input, &scaled)?;
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

/// Adds what a planar mesh is in a metric; its edges that are not of unit length.
pub(crate) fn measure_in_plane(report: &mut Report, mesh: &Mesh, metric: &dyn MetricField) -> Result<Unmet> {
    let unmet = unmet(mesh, metric, |_| ())?;
    match &unmet.quality {
        Some(quality) => report.add_quality(quality),
        None => report.add_quality(&metric_quality(mesh, metric)?),
    }
    report.unmet = Some(unmet.figures());
    Ok(unmet)
}

/// Adds what the mesh of a surface is in a metric; its edges that are not of unit length.
pub(crate) fn measure_on_surface(
    report: &mut Report,
    mesh: &Mesh,
    surface: &Manifold,
    metric: &Scaled,
) -> Result<Unmet> {
    report.curvature = metric.field.curvature_figures();
    let unmet = surface_unmet(mesh, surface, metric, |_| ())?;
    match &unmet.quality {
        Some(quality) => report.add_quality(quality),
        None => report.add_quality(&surface_quality(mesh, surface, metric)?),
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
