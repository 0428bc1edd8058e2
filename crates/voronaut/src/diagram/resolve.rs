//! Refining the canvas where it does not tell Voronoi vertices apart, until it captures the nerve (RR-9103, section 6.4).

use super::{Diagram, Nerve, NerveTriangle};
use crate::canvas::Canvas;
use crate::error::Result;
use crate::geometry::Point;
use crate::metric::MetricField;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// Faces whose longest edge is shorter than this share of the distance to the nearest seed are not refined: cells that
/// meet there do so, as far as computed distances tell, in one point.
const TINY: f64 = 1e-3;

/// A canvas that was refined for its seeds, and how far that went.
#[derive(Debug)]
pub struct Resolved {
    /// The canvas.
    pub canvas: Canvas,
    /// Rounds of refinement.
    pub rounds: u32,
    /// Places that are left: three cells that meet ([`Diagram::sharp_nerve`]) without a face of three colours of their
    /// own, and faces of three colours whose cells do not meet.
    pub unwitnessed: usize,
}

/// Rounds of [`resolve`] after which the nerve of protected seeds is as a rule witnessed.
pub const RESOLVE_ROUNDS: u32 = 8;

/// Refines a canvas until its faces with three colours ([`Diagram::nerve`]) are the nerve of the seeds' cells as drawn
/// within faces ([`Diagram::sharp_nerve`]), each alone in its face: around the places where they are not, again and
/// again. Ends when there are no such places, after so many rounds, or when the faces there are tiny beside the cells.
///
/// # Errors
/// A seed is outside the domain, or the metric not positive definite at a new vertex.
pub fn resolve(canvas: Canvas, field: &dyn MetricField, seeds: &[Point], rounds: u32) -> Result<Resolved> {
    let mut resolved = Resolved { canvas, rounds: 0, unwitnessed: 0 };
    loop {
        let (places, around) = {
            let diagram = Diagram::new(&resolved.canvas, field, seeds)?;
            let places = unresolved(&diagram.nerve(), &diagram.sharp_nerve());
            let around = vertices_of(&diagram, &places);
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

/// The faces where raw and sharp nerve differ, or where several triangles of the sharp one lie in one face.
fn unresolved(raw: &Nerve, sharp: &Nerve) -> Vec<FaceId> {
    let lacks =
        |nerve: &Nerve, t: &NerveTriangle| nerve.triangles.binary_search_by_key(&t.colours, |o| o.colours).is_err();
    let missing = sharp.triangles.iter().filter(|t| lacks(raw, t));
    let extra = raw.triangles.iter().filter(|t| lacks(sharp, t));
    let mut places: Vec<FaceId> = missing.chain(extra).map(|t| t.witness).collect();
    let mut witnesses: Vec<FaceId> = sharp.triangles.iter().map(|t| t.witness).collect();
    witnesses.sort_unstable();
    places.extend(witnesses.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]));
    places.sort_unstable();
    places.dedup();
    places
}

/// The corners of the faces that are not tiny.
fn vertices_of(diagram: &Diagram, faces: &[FaceId]) -> Vec<VertexId> {
    let topology = diagram.canvas().topology();
    let is_coarse = |&f: &FaceId| {
        let longest = f.half_edges().map(|h: HalfEdge| topology.length(h)).into_iter().fold(0.0, f64::max);
        let nearest = topology.corners(f).map(|v| diagram.distance(v)).into_iter().fold(f64::INFINITY, f64::min);
        longest > TINY * nearest
    };
    let mut corners: Vec<VertexId> =
        faces.iter().copied().filter(is_coarse).flat_map(|f| topology.corners(f)).collect();
    corners.sort_unstable();
    corners.dedup();
    corners
}
