//! From the canvas face that holds a Voronoi vertex to its witness (RR-9103, proof of Lemma 9.3, Figure 10).

use crate::diagram::{Diagram, Ground};
use crate::geometry::Point3;
use crate::lists::ranked;
use crate::net::Ball;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};
use serde::Serialize;

/// How walks to the witnesses of Voronoi vertices ended. Deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Walks {
    /// Voronoi vertices walked from: of the covered cells.
    pub started: usize,
    /// Those whose witness was found.
    pub found: usize,
    /// Of these, those of which the report's walk, towards the missing seed, went the wrong way along the border of the
    /// two cells; the other way led there.
    pub turned: usize,
    /// Faces passed, on average and at most: 0 where the first face is the witness.
    pub mean_steps: f64,
    /// See `mean_steps`.
    pub max_steps: usize,
}

impl Walks {
    /// Walks from the centre of each circle.
    pub(super) fn of<'a, 'b, G: Ground<'a>, P: Copy + 'b>(
        diagram: &Diagram<'a, G>,
        face: impl Fn(P) -> Option<FaceId>,
        balls: impl Iterator<Item = &'b Ball<3, P>>,
    ) -> Self {
        let (mut walks, mut steps) = (Self::default(), 0);
        for ball in balls {
            walks.started += 1;
            if let Some(found) = face(ball.centre).and_then(|at| walk(diagram, ball.corners, at)) {
                walks.found += 1;
                walks.turned += usize::from(found.turned);
                walks.max_steps = walks.max_steps.max(found.steps);
                steps += found.steps;
            }
        }
        walks.mean_steps = if walks.found > 0 { steps as f64 / walks.found as f64 } else { 0.0 };
        walks
    }
}

/// The end of a walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Found {
    /// A face whose vertices have the three colours.
    pub witness: FaceId,
    /// Faces passed.
    pub steps: usize,
    /// Whether the first way was the wrong one.
    pub turned: bool,
}

/// Walks from a face of the embedded canvas, where the cells of three colours meet, between two of the cells towards the
/// seed of the third, as far as faces have no other colour. `None` where that leads to no witness: the canvas is too
/// coarse.
///
/// On an intrinsic canvas, whose faces are not those of the plane, the walk starts in the first face with three or else
/// two of the colours around the corners of the embedded one.
pub(crate) fn walk<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, colours: [u32; 3], at: FaceId) -> Option<Found> {
    let first = start(diagram, colours, at)?;
    let found = colours_of(diagram, first);
    let Some(&missing) = colours.iter().find(|colour| !found.contains(colour)) else {
        return Some(Found { witness: first, steps: 0, turned: false });
    };
    let ground = diagram.ground();
    let towards = ground.frozen(diagram.seed(missing)?).at;
    let distance = |ends: [VertexId; 2]| {
        let [p, q] = ends.map(|v| Point3::from(ground.coordinates(v)));
        p.lerp(q, 0.5).distance(towards)
    };
    let doors = first.half_edges().into_iter().filter_map(|h| {
        let ends = topology(diagram).ends(h);
        let [from, to] = diagram.colours_at(ends);
        (from != to).then(|| (distance(ends), h))
    });
    ranked(doors).into_iter().enumerate().find_map(|(i, (_, door))| {
        let (witness, steps) = between(diagram, door, missing)?;
        Some(Found { witness, steps, turned: i > 0 })
    })
}

/// Goes through edges whose ends differ, from face to face, until a face has another colour.
fn between<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, mut door: HalfEdge, missing: u32) -> Option<(FaceId, usize)> {
    let topology = topology(diagram);
    for steps in 1..=topology.face_count() {
        let entry = topology.twin(door)?;
        let [third] = diagram.colours_at([topology.apex(entry)]);
        let [from, to] = diagram.colours_at(topology.ends(entry));
        if third == missing {
            return Some((entry.face(), steps));
        }
        door = match third {
            _ if third == from => entry.next(),
            _ if third == to => entry.prev(),
            _ => return None,
        };
    }
    None
}

fn start<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, colours: [u32; 3], at: FaceId) -> Option<FaceId> {
    let topology = topology(diagram);
    let own = diagram.ground().embedded().corners(at);
    let near = own.into_iter().flat_map(|v| topology.star(v).map(HalfEdge::face));
    let mut candidates: Vec<(usize, bool, FaceId)> = near
        .filter_map(|f| {
            let found = colours_of(diagram, f);
            let [a, b, c] = found;
            let distinct = if a == b && b == c { 1 } else { 2 + usize::from(a != b && b != c && c != a) };
            let is_own = topology.corners(f).iter().all(|v| own.contains(v));
            found.iter().all(|colour| colours.contains(colour)).then_some((3 - distinct, !is_own, f))
        })
        .filter(|candidate| candidate.0 < 2)
        .collect();
    // The face of the plane itself, where it is one, is where the report starts.
    candidates.sort_unstable_by_key(|&(missing, is_other, f)| (is_other, missing, f));
    candidates.first().map(|candidate| candidate.2)
}

fn colours_of<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, f: FaceId) -> [u32; 3] {
    diagram.colours_at(topology(diagram).corners(f))
}

fn topology<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>) -> &'a Triangulation {
    diagram.ground().topology()
}
