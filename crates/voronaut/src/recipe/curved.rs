//! Meshes of order 2 and 3.

use super::plane::Case;
use super::stopwatch::Stopwatch;
use super::{Aim, Boundary, MeshOptions, Meshed, Mesher};
use crate::curved::{Away, POWERS, Tempered, curved, interpolating, onto_surface};
use crate::error::{Error, Result};
use crate::geometry::Point;
use crate::manifold::Manifold;
use crate::manifold::domain::Splines;
use crate::mesh::Mesh;
use crate::metric::{Scaled, complexity};
use crate::optimise::{Patience, polishing_norm};
use crate::quality::{self, Meetings, Validity};

/// Half the square root of 3: the metric area that a unit mesh has for each vertex, two equilateral triangles.
const AREA_PER_VERTEX: f64 = 0.866_025_403_784_438_6;

/// Refuses an order that there is none of, and what does not go with curved triangles.
///
/// # Errors
/// [`Error::Unsupported`].
pub(super) fn demand_possible(options: &MeshOptions) -> Result<()> {
    if !(1..=3).contains(&options.order) {
        let what = format!("triangles of order {}", options.order);
        return Err(Error::unsupported(what, "use `order` 1, 2 or 3"));
    }
    let refused = [
        ("`mesher=starset`", options.mesher == Mesher::StarSet),
        ("`periodic`", !options.periodic.is_empty()),
        ("`net`", options.net),
    ];
    let found = refused.into_iter().find(|(_, is_set)| options.order > 1 && *is_set);
    found.map_or(Ok(()), |(name, _)| Err(Error::unsupported(format!("{name} with curved triangles"), "use `order` 1")))
}

/// Meshes a domain with triangles of order 2 or 3. For a function whose derivatives are known, [`mesh_for_function`]; else they follow the metric.
///
/// # Errors
/// As for [`mesh_for`].
pub(super) fn mesh_curved(case: &Case) -> Result<Meshed> {
    let is_known = |aim: &Aim| aim.function.jet(case.domain.planar().triangles()[0][0]).is_some();
    match case.aim {
        Some(aim) if is_known(&aim) => mesh_for_function(case, aim),
        _ => {
            let mut meshed = mesh_by_metric(case)?;
            let note = "curved triangles follow the metric: they are polished for functions whose derivatives are known, formulas";
            meshed.notes.extend(case.aim.map(|_| note.into()));
            Ok(meshed)
        }
    }
}

/// First a straight mesh of the metric, which is that of interpolation by polynomials of the order; then all points are moved to where the error is
/// least.
fn mesh_for_function(case: &Case, aim: Aim) -> Result<Meshed> {
    let (options, progress, watch) = (case.options, case.progress, Stopwatch::new(case.progress));
    let straight = MeshOptions { order: 1, ..options.clone() };
    let start = Case { aim: None, options: &straight, ..*case }.mesh_straight(options.polish == 0)?;
    let unit = Scaled { field: case.field, factor: start.metric_scale };
    let curves = curves(case);
    let patience = Patience { steps: options.polish, gain: options.effort.gain_of_polishing() };
    let target = (aim.function, polishing_norm(aim.norm));
    let work = || interpolating(&start.mesh, curves.as_ref(), &unit, options.order, target, patience, progress);
    let (mesh, away, polished) = watch.time("polish", work)?;
    finished(Meshed { polished: Some(polished), ..start }, mesh, away, &watch, curves.is_some())
}

/// First a straight mesh of the metric made less anisotropic, then curved, and on to the metric as it is. With a number of vertices given the factor on the
/// metric is that for which all triangles of so many vertices, but for the boundary's, could have the area of equilateral ones with unit sides.
fn mesh_by_metric(case: &Case) -> Result<Meshed> {
    let Case { field, options, progress, .. } = *case;
    let watch = Stopwatch::new(progress);
    let mild = Tempered { field, power: POWERS[0] };
    let straight = MeshOptions { order: 1, ..options.clone() };
    let start = Case { field: &mild, aim: None, options: &straight, ..*case }.mesh()?;
    let metric_scale = match (options.vertices, options.complexity) {
        (Some(count), _) => count as f64 * AREA_PER_VERTEX / complexity(field, &case.domain.planar().triangles())?,
        _ => start.metric_scale,
    };
    let unit = Scaled { field, factor: metric_scale };
    let curves = curves(case);
    let (mesh, away) = watch.time("curve", || curved(&start.mesh, curves.as_ref(), &unit, options.order, progress))?;
    finished(Meshed { metric_scale, ..start }, mesh, away, &watch, curves.is_some())
}

/// The curved mesh, checked, in place of the straight one that it started from; with a note of points that are away from their curves.
fn finished(start: Meshed, mesh: Mesh, away: Away, watch: &Stopwatch, is_bent: bool) -> Result<Meshed> {
    let validity = watch.time("check", || demand_valid(&mesh, is_bent))?;
    let note = |(count, at): (usize, Point)| {
        format!("{count} points of the boundary are not on its curve, for triangles would fold: the first at {at}")
    };
    let notes = start.notes.iter().cloned().chain(away.map(note)).collect();
    Ok(Meshed { mesh, validity, seconds: [start.seconds.clone(), watch.seconds()].concat(), notes, ..start })
}

/// # Errors
/// [`Error::Domain`] where curves of a boundary that was bent meet, which their chords do not; else as [`quality::check`].
fn demand_valid(mesh: &Mesh, is_bent: bool) -> Result<Validity> {
    let found = quality::validity(mesh);
    match &found.first_fault {
        Some(fault) if is_bent && found.overlaps > 0 => {
            let help = "use `boundary=polyline`, or give the curves more vertices there";
            Err(Error::domain(format!("curves of the boundary meet: {}", fault.what), fault.place.clone(), help))
        }
        _ => found.demand().map(|()| found),
    }
}

/// Refuses curved triangles of a surface whose curves are not known, or whose vertices are elsewhere.
///
/// # Errors
/// [`Error::Unsupported`].
pub(super) fn demand_possible_on(manifold: &Manifold, options: &MeshOptions) -> Result<()> {
    if options.order > 1 && manifold.equation().is_none() {
        let help = "give an equation (`sphere:`, `torus:`, or f = 0), or use `order` 1";
        return Err(Error::unsupported("curved triangles on a surface of triangles", help));
    }
    if options.order > 1 && options.fit {
        return Err(Error::unsupported("`fit` with curved triangles", "leave out `fit`: nodes are on the surface"));
    }
    demand_possible(options)
}

/// Makes the triangles of a mesh of an equation's surface curved, with their nodes on it.
///
/// # Errors
/// The mesh would not be valid.
pub(super) fn curve_onto(meshed: &mut Meshed, manifold: &Manifold, meetings: &Meetings, order: usize) -> Result<()> {
    if order == 1 {
        return Ok(());
    }
    if let Some((count, at)) = onto_surface(&mut meshed.mesh, manifold, order) {
        meshed.notes.push(format!(
            "{count} nodes are not on the surface, for triangles would fold or it was not found: the first is near {at}"
        ));
    }
    meshed.validity = quality::validity_on(&meshed.mesh, meetings);
    meshed.validity.demand()
}

/// The curves that boundaries are bent onto, if they are. That a domain allows chords to stray says that its segments stand for a curve.
fn curves(case: &Case) -> Option<Splines> {
    let graph = case.domain.pslg();
    let is_bent = match case.options.boundary {
        Boundary::Polyline => false,
        Boundary::Spline => true,
        Boundary::Auto => graph.tolerance > 0.0,
    };
    is_bent.then(|| Splines::of(graph))
}
