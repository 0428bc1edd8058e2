//! Polishing: vertices move and edges flip so that the error of linear interpolation of a given function falls.
//!
//! A unit mesh of the metric of a Hessian has the least error among meshes whose triangles are equilateral in it and small
//! against the scale on which the Hessian changes (Loseille and Alauzet 2011). Real triangles are neither, and where the
//! function is saddle-shaped longer ones are as good. The last tenth is gained on the error itself.

mod frame;
mod moves;
mod objective;
mod on_surface;
mod plane;

use super::Patience;
use crate::dual::{Dual, Kind, SurfaceDual};
use crate::error::{Error, Result};
use crate::geometry::{Jet, Vector};
use crate::metric::{Expression, Near, Norm, ScalarField};
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};
use frame::Frame;
pub(crate) use objective::polishing_norm;
use objective::{Objective, Place};
use on_surface::OnSurface;
use plane::Flat;

/// No triangle may become worse than this for it, unless it was: quality in the mean tensor of its corners.
const POOR: f64 = 0.05;

/// How polishing went.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Polished {
    /// The L^p norm of the error before the first sweep and after each, by seven values of the function in each triangle.
    /// With p above 8 the L^8 norm.
    pub error: Vec<f64>,
    /// Flips done.
    pub flips: u64,
    /// Moves done.
    pub moves: u64,
}

/// Lowers the L^p error of linear interpolation of a function by at most so many sweeps of flips and moves; ends early where a sweep
/// gains too little.
///
/// The number of vertices stays; corners and constraints stay, vertices of segments slide along them. Each move and flip lowers
/// the error as seven values of the function in each triangle show it, keeps the triangulation embedded, and leaves the poorest of
/// the triangles around it no poorer than it was, or better than 0.05, in the metric where the vertices were at first. Edges are not those of the metric's dual afterwards. The
/// result does not depend on the number of threads.
///
/// # Errors
/// [`Error::Metric`] where the function is not finite at a vertex, or the metric no metric at one that has moved.
pub(crate) fn polish(
    dual: &mut Dual,
    function: &dyn ScalarField,
    norm: Norm,
    patience: Patience,
    progress: &dyn Progress,
) -> Result<Polished> {
    let (polished, flat) = polished(Flat::new(dual, function), norm, patience, progress)?;
    if let Some(Flat { planar, .. }) = flat {
        dual.take_over(planar);
        dual.verdict()?;
    }
    Ok(polished)
}

/// The same on a surface, of a function of space: seeds stay on it, those of features where they are, and no triangle comes to lean over.
///
/// # Errors
/// As of [`polish`].
pub(crate) fn polish_on_surface(
    dual: &mut SurfaceDual,
    function: &Expression,
    norm: Norm,
    patience: Patience,
    progress: &dyn Progress,
) -> Result<Polished> {
    let (polished, changed) = polished(OnSurface::new(dual, function), norm, patience, progress)?;
    if changed.is_some() {
        let factor = crate::dual::Moving::factor(dual);
        dual.rescale(factor)?;
    }
    Ok(polished)
}

/// Triangles whose vertices move and whose edges flip, of the plane or on a surface, and the function that they are for.
trait Sheet: Sync {
    /// Where a vertex is.
    type At: Copy + Send + Sync;

    /// Topology.
    fn topology(&self) -> &Triangulation;
    /// What holds a vertex.
    fn kind(&self, v: VertexId) -> Kind;
    /// Where vertices are, by id.
    fn places(&self) -> Vec<Self::At>;
    /// Where that is, for messages.
    fn describe(&self, v: VertexId) -> String;
    /// The directions in which a vertex of a segment can move.
    fn on_segment(&self, v: VertexId) -> Option<Frame>;
    /// Where a vertex is, seen from another.
    fn offset(&self, from: VertexId, to: VertexId) -> Vector;
    /// Where a vertex comes to be by a step in a frame.
    fn stepped(&self, v: VertexId, frame: &Frame, step: [f64; 2]) -> Option<Self::At>;
    /// The area of a triangle; not positive where it is turned over.
    fn area(&self, corners: [Self::At; 3]) -> f64;
    /// The function at a vertex.
    fn value(&self, at: Self::At) -> f64;
    /// The function in a triangle, at barycentric coordinates.
    fn value_within(&self, corners: [Self::At; 3], weights: [f64; 3], near: &mut Near) -> f64;
    /// The function in a triangle, and its derivatives in the directions of a frame; `None` where these are not known.
    fn jet_within(&self, _: [Self::At; 3], _: [f64; 3], _: &Frame, _: &mut Near) -> Option<Jet> {
        None
    }
    /// Quality, in the mean tensor of three vertices, of a triangle with these corners: 1 of an equilateral one.
    fn shape(&self, vertices: [VertexId; 3], corners: [Self::At; 3]) -> f64;
    /// Whether an edge may be flipped.
    fn may_flip(&self, h: HalfEdge) -> bool;
    /// Flips an edge, and says whether it did.
    fn flip(&mut self, h: HalfEdge) -> bool;
    /// Moves a vertex, and says whether it did.
    fn move_vertex(&mut self, v: VertexId, to: Self::At) -> bool;
}

/// The sheet, if sweeps were made.
fn polished<S: Sheet>(
    sheet: S,
    norm: Norm,
    Patience { steps: sweeps, gain }: Patience,
    progress: &dyn Progress,
) -> Result<(Polished, Option<S>)> {
    let mut polished = Polished::default();
    let Some(mut work) = Work::new(sheet, norm)? else { return Ok((polished, None)) };
    let mut error = work.norm();
    polished.error.push(error);
    if sweeps == 0 {
        return Ok((polished, None));
    }
    for _ in 0..sweeps {
        polished.flips += work.flip_all();
        polished.moves += work.move_all();
        let before = std::mem::replace(&mut error, work.norm());
        polished.error.push(error);
        progress.advance(1)?;
        if error > (1.0 - gain) * before {
            break;
        }
    }
    polished.flips += work.flip_all();
    if let Some(last) = polished.error.last_mut() {
        *last = work.norm();
    }
    Ok((polished, Some(work.sheet)))
}

/// Triangles with the function's values at their vertices.
struct Work<S: Sheet> {
    sheet: S,
    objective: Objective,
    places: Vec<Place<S::At>>,
    /// The error of each face as it was when it was last summed, or flipped.
    shares: Vec<f64>,
    /// Whether a vertex has moved since.
    has_moved: Vec<bool>,
    /// Whether something may be gained around a vertex: it or a neighbour has moved, or an edge around it was flipped, since it was tried.
    awake: Vec<bool>,
}

impl<S: Sheet> Work<S> {
    /// `None` where the function is the same everywhere.
    fn new(sheet: S, norm: Norm) -> Result<Option<Self>> {
        let place = |&at: &S::At| Place { at, value: sheet.value(at) };
        let places: Vec<Place<S::At>> = sheet.places().par_iter().map(place).collect();
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in sheet.topology().vertices() {
            let value = places[v.index()].value;
            if !value.is_finite() {
                let what = format!("the function is {value}");
                let help = "give a function that is finite in the whole domain";
                return Err(Error::metric(what, sheet.describe(v), help));
            }
            (least, most) = (least.min(value), most.max(value));
        }
        let objective = Objective::new(norm, most - least);
        let [awake, has_moved] = [true, true].map(|all| vec![all; places.len()]);
        let shares = vec![0.0; sheet.topology().face_slots()];
        Ok((most > least).then_some(Self { sheet, objective, places, shares, has_moved, awake }))
    }

    fn place(&self, v: VertexId) -> Place<S::At> {
        self.places[v.index()]
    }

    /// The norm of the error on all faces.
    fn norm(&mut self) -> f64 {
        let faces: Vec<FaceId> = self.sheet.topology().faces().collect();
        let is_old = |f: FaceId| self.sheet.topology().corners(f).iter().any(|v| self.has_moved[v.index()]);
        let share = |&f: &FaceId| if is_old(f) { self.share(f) } else { self.shares[f.index()] };
        let shares: Vec<f64> = faces.par_iter().with_min_len(64).map(share).collect();
        let sum = shares.iter().sum();
        for (f, share) in faces.into_iter().zip(shares) {
            self.shares[f.index()] = share;
        }
        self.has_moved.fill(false);
        self.objective.norm(sum)
    }

    /// The error of a face.
    fn share(&self, f: FaceId) -> f64 {
        self.objective.of(&self.sheet, self.sheet.topology().corners(f).map(|v| self.place(v)))
    }

    fn shape(&self, vertices: [VertexId; 3], corners: [Place<S::At>; 3]) -> f64 {
        self.sheet.shape(vertices, corners.map(|corner| corner.at))
    }
}

/// Whether shapes may go from one least quality to another.
fn is_allowed(before: f64, after: f64) -> bool {
    after > POOR || after > before
}
