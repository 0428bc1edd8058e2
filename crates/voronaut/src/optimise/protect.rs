//! Moving seeds until every Delaunay circle is power-protected (RR-9103, section 3.4): random perturbations of the seeds
//! around those that are not, as in the algorithms of Boissonnat et al. 2014 and, for constraints in general, Moser and
//! Tardos 2010.

use super::trials::{By, Found, LEAST_GAIN, Luck, Search, Wish};
use crate::dual::Kind;
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::Point;
use crate::lists::{distinct, ranked};
use crate::net::{Ball, Net, Random};
use crate::progress::Progress;
use crate::triangulation::{Triangulation, VertexId};

/// Rounds of measuring with geodesics and moving seeds, at most.
const ROUNDS: usize = 30;
/// Rounds that may pass, one after the other, without fewer unprotected simplices.
const PATIENCE: usize = 6;
/// After so many rounds without progress, and every other round from then on, the neighbours of a simplex's seeds are moved as well, and seeds on curves slide.
const WIDER: usize = 2;
/// From this round on, and while no more than so many simplices are unprotected, places are tried with geodesics.
const GEODESICS: (usize, usize) = (2, 20);
/// Seeds are moved within a ball of this radius, as a share of epsilon: at first, and at most.
const BALL: [f64; 2] = [0.15, 0.5];
/// It grows by this factor from round to round.
const GROWTH: f64 = 1.15;
/// Estimates are asked for this much more power than geodesics, and for more by this factor wherever geodesics found less
/// than the estimates had said.
const ASKED: [f64; 2] = [1.03, 1.1];
/// At most by this factor.
const MOST_ASKED: f64 = 1.5;

/// How it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Ending {
    /// Every interior simplex is protected.
    Protected,
    /// Rounds went by without progress.
    Stalled,
    /// The last round that is allowed was over.
    OutOfRounds,
}

/// What was done, and the net that is left.
#[derive(Clone, Debug)]
pub(crate) struct Protected<P = Point> {
    /// Why it ended.
    pub ending: Ending,
    /// Rounds of moves.
    pub rounds: usize,
    /// Seeds moved, counted every time.
    pub moves: u64,
    /// Places tried.
    pub tries: u64,
    /// Triangles and border edges that were less protected than asked for at the beginning, and that are now.
    pub unprotected: [usize; 2],
    /// The net, measured with geodesics; seeds are numbered like vertices.
    pub net: Net<P>,
}

/// Seeds that can be protected, in the plane or on a surface.
pub(super) trait Protecting {
    /// Where a seed is.
    type Place: Copy + PartialEq + Send + Sync;

    /// Which seeds are neighbours, as last measured.
    fn topology(&self) -> &Triangulation;
    /// What holds a seed.
    fn kind(&self, v: VertexId) -> Kind;
    /// Measures with geodesics.
    fn measure(&mut self) -> Net<Self::Place>;
    /// Places for seeds around a simplex, the best first, from a search where all of them are seen; none where they are not.
    fn places(
        &mut self,
        movable: &[VertexId],
        search: impl FnOnce(&mut Search) -> Vec<Found<Point>>,
    ) -> Vec<Found<Self::Place>>;
    /// The same where a canvas decides on a simplex, if one does.
    fn places_on_canvas(
        &mut self,
        _simplex: &[VertexId],
        _movable: &[VertexId],
        _wish: &Wish,
        _luck: &mut Luck,
    ) -> Option<Vec<Found<Self::Place>>> {
        None
    }
    /// Moves a seed of the mesh, unless a triangle would turn over; says whether it did.
    fn relocate(&mut self, v: VertexId, to: Self::Place) -> bool;
    /// # Errors
    /// The metric is invalid at a seed.
    fn verdict(&self) -> Result<()>;
}

/// Moves free seeds until the power protection of every interior simplex is at least a share of epsilon, both measured with geodesics. What
/// cannot be had is left and counted. No seed is added or removed. The result does not depend on the number of threads.
///
/// # Errors
/// The metric is found invalid at a seed.
pub(super) fn protected<G: Protecting>(
    ground: &mut G,
    share: f64,
    progress: &dyn Progress,
) -> Result<Protected<G::Place>> {
    let mut mender = Mender::new(ground, share);
    let (mut best, mut since, mut round, mut first) = (usize::MAX, 0, 0, None);
    loop {
        let net = mender.ground.measure();
        let bad = mender.unprotected(&net);
        let first = *first.get_or_insert(bad.len());
        since = if bad.len() < best { 0 } else { since + 1 };
        best = best.min(bad.len());
        let ending = match round {
            _ if bad.is_empty() => Some(Ending::Protected),
            ROUNDS => Some(Ending::OutOfRounds),
            _ if since > PATIENCE => Some(Ending::Stalled),
            _ => None,
        };
        if let Some(ending) = ending {
            mender.ground.verdict()?;
            let Mender { moves, luck: Luck { tries, .. }, .. } = mender;
            return Ok(Protected { ending, rounds: round, moves, tries, unprotected: [first, bad.len()], net });
        }
        mender.is_wide = since >= WIDER && since % 2 == 0;
        mender.mend(&bad, round, net.epsilon);
        progress.advance(1)?;
        round += 1;
    }
}

/// Moves the seeds of a ground.
struct Mender<'a, G> {
    ground: &'a mut G,
    share: f64,
    /// By how much more power than asked for estimates must have at each seed.
    excess: Vec<f64>,
    is_wide: bool,
    luck: Luck,
    moves: u64,
}

impl<'a, G: Protecting> Mender<'a, G> {
    fn new(ground: &'a mut G, share: f64) -> Self {
        let slots = ground.topology().vertex_slots();
        let luck = Luck { random: Random::new(slots as u64), tries: 0 };
        Self { ground, share, excess: vec![ASKED[0]; slots], is_wide: false, luck, moves: 0 }
    }

    /// The seeds of what is unprotected, worst first.
    fn unprotected(&self, net: &Net<G::Place>) -> Vec<Vec<VertexId>> {
        let asked = self.share * net.epsilon;
        let triangles = net.interior().filter(|ball| ball.protection() < asked).map(around);
        let border = net.border.iter().filter(|ball| ball.protection() < asked).map(around);
        let unknown = net.unknown.iter().map(|corners| (f64::NEG_INFINITY, corners.map(VertexId).to_vec()));
        ranked(triangles.chain(border).chain(unknown)).into_iter().map(|(_, seeds)| seeds).collect()
    }

    /// One round: for each simplex, the best of the places tried for its seeds.
    fn mend(&mut self, bad: &[Vec<VertexId>], round: usize, epsilon: f64) {
        let radius = epsilon * (BALL[0] * GROWTH.raised_to(round as f64)).min(BALL[1]);
        let asked = (self.share * epsilon).powi(2);
        let by = if round >= GEODESICS.0 && bad.len() <= GEODESICS.1 { By::Geodesics } else { By::Estimates };
        for seeds in bad {
            if round > 0 {
                let more = |excess: f64| (excess * ASKED[1]).min(MOST_ASKED);
                for v in seeds {
                    self.excess[v.index()] = more(self.excess[v.index()]);
                }
            }
            self.mend_one(seeds, by, asked, radius);
        }
    }

    fn mend_one(&mut self, simplex: &[VertexId], by: By, asked: f64, radius: f64) {
        let movable = self.movable(simplex);
        let Self { ground, excess, luck, .. } = self;
        let wish = Wish { by, asked, excess, radius };
        let found = match ground.places_on_canvas(simplex, &movable, &wish, luck) {
            Some(found) => found,
            None => ground.places(&movable, |search| search.places(&movable, &wish, luck)),
        };
        // The mesh with straight edges may not let a seed go where it should: then the next best place.
        let mut useful = found.into_iter().take_while(|place| place.0 > LEAST_GAIN);
        if useful.any(|(_, v, to)| ground.relocate(v, to)) {
            self.moves += 1;
        }
    }

    /// The free seeds among these; where there are none, or that did not help, others around as well.
    fn movable(&self, seeds: &[VertexId]) -> Vec<VertexId> {
        let is_free = |v: &VertexId| self.ground.kind(*v) == Kind::Free;
        let free: Vec<VertexId> = seeds.iter().copied().filter(is_free).collect();
        if !self.is_wide && !free.is_empty() {
            return free;
        }
        let star = |&v: &VertexId| self.ground.topology().around(v);
        let on_curves = seeds.iter().copied().filter(|&v| self.ground.kind(v) == Kind::Curve);
        distinct(seeds.iter().flat_map(star).filter(is_free).chain(on_curves).chain(free))
    }
}

/// The power of a circle and the seeds that it depends on.
fn around<const N: usize, P>(ball: &Ball<N, P>) -> (f64, Vec<VertexId>) {
    (ball.power, ball.corners.iter().copied().chain(ball.nearest).map(VertexId).collect())
}
