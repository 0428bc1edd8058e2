//! Polishing: vertices move and edges flip so that the error of linear interpolation of a given function falls.
//!
//! A unit mesh of the metric of a Hessian has the least error among meshes whose triangles are equilateral in it and small
//! against the scale on which the Hessian changes (Loseille and Alauzet 2011). Real triangles are neither, and where the
//! function is saddle-shaped longer ones are as good. The last tenth is gained on the error itself.

mod moves;

use super::Patience;
use crate::dual::Dual;
use crate::error::{Error, Result};
use crate::metric::{Norm, ScalarField};
use crate::parallel::prelude::*;
use crate::planar::Planar;
use crate::progress::Progress;
use crate::triangulation::VertexId;
pub(crate) use moves::polishing_norm;
use moves::{Objective, Place};

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
    Patience { steps: sweeps, gain }: Patience,
    progress: &dyn Progress,
) -> Result<Polished> {
    let mut polished = Polished::default();
    let Some(mut work) = Work::new(dual, function, norm)? else { return Ok(polished) };
    polished.error.push(work.norm());
    if sweeps == 0 {
        return Ok(polished);
    }
    for _ in 0..sweeps {
        polished.flips += work.flip_all();
        polished.moves += work.move_all();
        let before = polished.error.last().copied().unwrap_or_default();
        polished.error.push(work.norm());
        progress.advance(1)?;
        if work.norm() > (1.0 - gain) * before {
            break;
        }
    }
    polished.flips += work.flip_all();
    if let Some(last) = polished.error.last_mut() {
        *last = work.norm();
    }
    let planar = work.planar;
    dual.take_over(planar);
    dual.verdict()?;
    Ok(polished)
}

/// A triangulation with the function's values at its vertices, and the dual that it was made of, with the metric where they were.
struct Work<'a> {
    dual: &'a Dual<'a>,
    objective: Objective<'a>,
    planar: Planar,
    places: Vec<Place>,
    /// Whether something may be gained around a vertex: it or a neighbour has moved, or an edge around it was flipped, since it was tried.
    awake: Vec<bool>,
}

impl<'a> Work<'a> {
    /// `None` where the function is the same everywhere.
    fn new(dual: &'a Dual, function: &'a dyn ScalarField, norm: Norm) -> Result<Option<Self>> {
        let planar = dual.planar().clone();
        let values: Vec<f64> = planar.positions.par_iter().map(|&p| function.value(p)).collect();
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for v in planar.topology.vertices() {
            let value = values[v.index()];
            if !value.is_finite() {
                let what = format!("the function is {value}");
                let help = "give a function that is finite in the whole domain";
                return Err(Error::metric(what, planar.position(v).to_string(), help));
            }
            (least, most) = (least.min(value), most.max(value));
        }
        Ok((most > least).then(|| Self {
            dual,
            objective: Objective::new(function, norm, most - least),
            places: planar.positions.iter().zip(values).map(|(&at, value)| Place { at, value }).collect(),
            awake: vec![true; planar.positions.len()],
            planar,
        }))
    }

    fn place(&self, v: VertexId) -> Place {
        self.places[v.index()]
    }

    /// The norm of the error on all faces.
    fn norm(&self) -> f64 {
        let faces: Vec<_> = self.planar.topology.faces().collect();
        let share = |&f| self.objective.of(self.planar.topology.corners(f).map(|v| self.place(v)));
        let shares: Vec<f64> = faces.par_iter().with_min_len(64).map(share).collect();
        self.objective.norm(shares.iter().sum())
    }

    /// Quality in the mean tensor of three vertices of a triangle with these corners: 1 of an equilateral one.
    fn shape(&self, vertices: [VertexId; 3], corners: [Place; 3]) -> f64 {
        self.dual.mean_tensor(vertices).shape(corners.map(|corner| corner.at))
    }
}

/// Whether shapes may go from one least quality to another.
fn is_allowed(before: f64, after: f64) -> bool {
    after > POOR || after > before
}
