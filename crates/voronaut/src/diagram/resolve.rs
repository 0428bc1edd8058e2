//! Refining the canvas where it does not tell Voronoi vertices apart, until it captures the nerve (RR-9103, section 6.4).

use super::{Diagram, NerveTriangle};
use crate::canvas::Canvas;
use crate::error::Result;
use crate::geodesic::chord;
use crate::geometry::Point;
use crate::lists::distinct;
use crate::metric::MetricField;
use crate::triangulation::{FaceId, VertexId};

/// Simplices whose longest edge is shorter than this share of the distance to the nearest seed are not refined: cells that
/// meet there do so, as far as computed distances tell, in one point.
const TINY: f64 = 1e-3;

/// A canvas that was refined for its seeds, and how far that went.
#[derive(Debug)]
pub struct Resolved {
    /// The canvas.
    pub canvas: Canvas,
    /// Rounds of refinement.
    pub rounds: u32,
    /// Places that are left: three cells that meet (`Diagram::sharp_nerve`) without a simplex of three colours of their
    /// own, and simplices of three colours whose cells do not meet.
    pub unwitnessed: usize,
}

/// Rounds of [`resolve`] after which the nerve of protected seeds is as a rule witnessed.
pub const RESOLVE_ROUNDS: u32 = 8;

/// Refines a canvas until its simplices with three colours (`Diagram::witnesses_of_triangles`) are the nerve of the seeds'
/// cells as drawn within faces (`Diagram::sharp_nerve`), each alone in its face: around the places where they are not,
/// again and again. Ends when there are no such places, after so many rounds, or when the simplices there are tiny beside
/// the cells.
///
/// # Errors
/// A seed is outside the domain, or the metric not positive definite at a new vertex.
pub fn resolve(canvas: Canvas, field: &dyn MetricField, seeds: &[Point], rounds: u32) -> Result<Resolved> {
    let mut resolved = Resolved { canvas, rounds: 0, unwitnessed: 0 };
    loop {
        let (places, around) = {
            let diagram = Diagram::new(&resolved.canvas, field, seeds)?;
            let places = unresolved(&diagram);
            let around = coarse(&diagram, &places);
            (places, around)
        };
        resolved.unwitnessed = places.len();
        if around.is_empty() || resolved.rounds == rounds {
            return Ok(resolved);
        }
        resolved.canvas = resolved.canvas.refined(field, &around)?;
        resolved.rounds += 1;
    }
}

/// The simplices where raw and sharp nerve differ, or where several triangles of the sharp one lie in one face.
fn unresolved(diagram: &Diagram) -> Vec<[VertexId; 3]> {
    let topology = diagram.canvas().topology();
    let (raw, sharp) = (diagram.witnesses_of_triangles(), diagram.sharp_nerve());
    let is_raw = |t: &&NerveTriangle| raw.binary_search_by_key(&t.colours, |w| w.0).is_ok();
    let is_sharp = |colours: [u32; 3]| sharp.triangles.binary_search_by_key(&colours, |t| t.colours).is_ok();
    let mut faces: Vec<FaceId> = sharp.triangles.iter().filter(|t| !is_raw(t)).map(|t| t.witness).collect();
    let mut witnesses: Vec<FaceId> = sharp.triangles.iter().map(|t| t.witness).collect();
    witnesses.sort_unstable();
    faces.extend(witnesses.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]));
    let extra = raw.into_iter().filter(|w| !is_sharp(w.0)).map(|w| w.1);
    distinct(faces).into_iter().map(|f| topology.corners(f)).chain(extra).collect()
}

/// The corners of the simplices that are not tiny.
fn coarse(diagram: &Diagram, simplices: &[[VertexId; 3]]) -> Vec<VertexId> {
    let canvas = diagram.canvas();
    let is_coarse = |&&[a, b, c]: &&[VertexId; 3]| {
        let side = |[u, v]: [VertexId; 2]| chord(diagram.ground.field, canvas.position(u), canvas.position(v));
        let longest = [[a, b], [b, c], [c, a]].map(side).into_iter().fold(0.0, f64::max);
        let nearest = [a, b, c].map(|v| diagram.distance(v)).into_iter().fold(f64::INFINITY, f64::min);
        longest > TINY * nearest
    };
    distinct(simplices.iter().filter(is_coarse).copied().flatten())
}
