//! Moving seeds until every Delaunay circle is power-protected (RR-9103, section 3.4): random perturbations of the seeds
//! around those that are not, as in the algorithms of Boissonnat et al. 2014 and, for constraints in general, Moser and
//! Tardos 2010.

use super::movers::Region;
use super::survey::{Survey, corners_of};
use crate::dual::{Dual, Kind, Moving};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geodesic::{Angles, LocalMetric, hermite};
use crate::geometry::Point;
use crate::lists::{distinct, ranked};
use crate::net::{Ball, Estimate, Memory, Net, Random, Simplices};
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::triangulation::{FaceId, Flipping, HalfEdge, Lawson, Limit, Triangulation, VertexId};
use std::collections::BTreeMap;

/// Rounds of measuring with geodesics and moving seeds, at most.
const ROUNDS: usize = 30;
/// Rounds that may pass, one after the other, without fewer unprotected simplices.
const PATIENCE: usize = 6;
/// Places tried for the seeds around one simplex, a round: with estimates, and, of these the best, with geodesics.
const TRIES: [usize; 2] = [60, 24];
/// And by the diagram on a canvas, where geodesics are not resolved; powers found there shall be this much greater.
const TRIES_ON_CANVAS: usize = 12;
const ASKED_OF_CANVAS: f64 = 1.15;
/// Vertices of that canvas per seed.
const PER_SEED: usize = 80;
/// After so many rounds without progress, and every other round from then on, the neighbours of a simplex's seeds are moved as well, and seeds on curves slide.
const WIDER: usize = 2;
/// Seeds slide along curves only as far as their edges there keep within these lengths (metric).
const SLIDING: [f64; 2] = [0.75, 1.35];
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
/// With geodesics it is this much more, since epsilon may grow by other moves.
const ASKED_OF_GEODESICS: f64 = 1.01;
/// Shares of the power asked for that are as good as none.
const LEAST_GAIN: f64 = 1e-6;
/// Flips after one move, at most: lengths that contradict each other must not make it last for ever.
const LIMIT: Limit = Limit::OfAll(60);
/// Margins closer to zero than this are ties.
const TIE: f64 = 1e-9;

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
pub(crate) struct Protected {
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
    pub net: Net,
}

/// Moves free seeds until the power protection of every interior triangle and of the edges at the border is at least a
/// share of epsilon, both measured with geodesics. What cannot be had is left and counted. Vertices are numbered anew
/// ([`Dual::reorder`]); no seed is added or removed. The result does not depend on the number of threads.
///
/// # Errors
/// The metric is found invalid at a seed.
pub(crate) fn protect(dual: &mut Dual, share: f64, progress: &dyn Progress) -> Result<Protected> {
    dual.reorder();
    let mut mender = Mender::new(dual, share);
    let (mut best, mut since, mut round, mut first) = (usize::MAX, 0, 0, None);
    loop {
        let (net, bad) = mender.measure();
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
            mender.dual.verdict()?;
            let Mender { moves, tries, .. } = mender;
            return Ok(Protected { ending, rounds: round, moves, tries, unprotected: [first, bad.len()], net });
        }
        mender.is_wide = since >= WIDER && since % 2 == 0;
        mender.mend(&bad, round, net.epsilon);
        progress.advance(1)?;
        round += 1;
    }
}

/// What places for seeds are tried with.
#[derive(Clone, Copy, PartialEq, Eq)]
enum By {
    Estimates,
    Geodesics,
}

/// The seeds of a dual in a triangulation that is embedded nowhere, as geodesics want it.
struct Mender<'a, 'b> {
    dual: &'a mut Dual<'b>,
    share: f64,
    positions: Vec<Point>,
    locals: Vec<LocalMetric>,
    topology: Triangulation,
    /// By how much more power than asked for estimates must have at each seed.
    excess: Vec<f64>,
    survey: Survey,
    is_wide: bool,
    random: Random,
    moves: u64,
    tries: u64,
}

/// A move on trial, and how to take it back.
struct Trial {
    v: VertexId,
    from: (Point, LocalMetric),
    flips: Vec<HalfEdge>,
}

impl<'a, 'b> Mender<'a, 'b> {
    fn new(dual: &'a mut Dual<'b>, share: f64) -> Self {
        let slots = dual.topology().vertex_slots();
        Self {
            share,
            positions: dual.planar().positions.clone(),
            locals: dual.locals().to_vec(),
            topology: dual.topology().clone(),
            excess: vec![ASKED[0]; slots],
            survey: Survey::default(),
            is_wide: false,
            random: Random::new(slots as u64),
            moves: 0,
            tries: 0,
            dual,
        }
    }

    /// Triangulates and measures with geodesics; the seeds of what is unprotected, worst first.
    fn measure(&mut self) -> (Net, Vec<Vec<VertexId>>) {
        let (net, topology) = self.survey.take(self.dual, &self.positions, &self.topology);
        self.topology = topology.unwrap_or_else(|| self.topology.clone());
        let bad = self.unprotected(&net);
        (net, bad)
    }

    fn unprotected(&self, net: &Net) -> Vec<Vec<VertexId>> {
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

    fn mend_one(&mut self, seeds: &[VertexId], by: By, asked: f64, radius: f64) {
        let movable = self.movable(seeds);
        let mut found = if self.survey.is_by_canvas(seeds) {
            self.places_on_canvas(seeds, &movable, asked, radius).unwrap_or_default()
        } else {
            self.places(&movable, by, asked, radius)
        };
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        if by == By::Geodesics && !self.survey.is_by_canvas(seeds) {
            found = self.best_by_geodesics(&found, asked).into_iter().collect();
        }
        // The mesh with straight edges may not let a seed go where it should: then the next best place.
        let mut useful = found.into_iter().take_while(|place| place.0 > LEAST_GAIN);
        if let Some((_, v, to)) = useful.find(|&(_, v, to)| self.dual.relocate(v, to)) {
            self.try_move(v, to);
            self.moves += 1;
        }
    }

    /// The free seeds among these; where there are none, or that did not help, others around as well.
    fn movable(&self, seeds: &[VertexId]) -> Vec<VertexId> {
        let is_free = |v: &VertexId| self.dual.kind(*v) == Kind::Free;
        let free: Vec<VertexId> = seeds.iter().copied().filter(is_free).collect();
        if !self.is_wide && !free.is_empty() {
            return free;
        }
        let star = |&v: &VertexId| self.topology.around(v);
        let on_curves = seeds.iter().copied().filter(|&v| self.dual.kind(v) == Kind::Curve);
        distinct(seeds.iter().flat_map(star).filter(is_free).chain(on_curves).chain(free))
    }

    /// Places for seeds by what they gain, estimated; until one gains everything, if estimates are to decide.
    fn places(&mut self, movable: &[VertexId], by: By, asked: f64, radius: f64) -> Vec<(f64, VertexId, Point)> {
        let mut memory = Memory::default();
        let before: Vec<f64> = movable.iter().map(|&v| self.shortfall(v, By::Estimates, asked, &mut memory)).collect();
        let mut found = Vec::new();
        for k in 0..if movable.is_empty() { 0 } else { TRIES[0].max(4 * movable.len()) } {
            let (v, before) = (movable[k % movable.len()], before[k % movable.len()]);
            let to = self.place_near(v, radius);
            if self.dual.kind(v) == Kind::Free && !self.dual.is_inside(v, to) {
                continue;
            }
            let gain = before - self.shortfall_at(v, to, By::Estimates, asked, &mut memory);
            found.push((gain, v, to));
            if by == By::Estimates && gain > LEAST_GAIN && gain >= before - LEAST_GAIN {
                // All that was missing around the seed is there.
                break;
            }
        }
        found
    }

    /// Places for seeds by what they gain in the diagram on a canvas around a simplex.
    fn places_on_canvas(
        &mut self,
        seeds: &[VertexId],
        movable: &[VertexId],
        asked: f64,
        radius: f64,
    ) -> Option<Vec<(f64, VertexId, Point)>> {
        let region = Region::around(self.dual, seeds, PER_SEED)?;
        let missing = |ball: &Ball<3>| (1.0 - ball.power / (asked * ASKED_OF_CANVAS)).max(0.0);
        let shortfall = |this: &Self, v: VertexId, to: Point| {
            let at = |u: VertexId| if u == v { to } else { this.positions[u.index()] };
            Some(region.circles(this.dual, at)?.iter().map(missing).sum::<f64>())
        };
        let before = shortfall(self, seeds[0], self.positions[seeds[0].index()])?;
        if before <= LEAST_GAIN || movable.is_empty() {
            return None;
        }
        let seeds = movable.iter().cycle().take(TRIES_ON_CANVAS);
        let places: Vec<(VertexId, Point)> = seeds.map(|&v| (v, self.place_near(v, radius))).collect();
        self.tries += places.len() as u64;
        let this = &*self;
        let found: Vec<Option<f64>> = places.par_iter().map(|&(v, to)| shortfall(this, v, to)).collect();
        let gains = found.iter().zip(&places).filter_map(|(after, &(v, to))| Some((before - (*after)?, v, to)));
        Some(gains.collect())
    }

    /// The best of the first places by geodesics.
    fn best_by_geodesics(&mut self, found: &[(f64, VertexId, Point)], asked: f64) -> Option<(f64, VertexId, Point)> {
        let mut memory = Memory::default();
        let mut before: BTreeMap<VertexId, f64> = BTreeMap::new();
        let mut best: Option<(f64, VertexId, Point)> = None;
        for &(_, v, to) in found.iter().take(TRIES[1]) {
            let before = *before.entry(v).or_insert_with(|| self.shortfall(v, By::Geodesics, asked, &mut memory));
            let gain = before - self.shortfall_at(v, to, By::Geodesics, asked, &mut memory);
            if best.is_none_or(|b| gain > b.0) {
                best = Some((gain, v, to));
            }
            if gain > LEAST_GAIN && gain >= before - LEAST_GAIN {
                break;
            }
        }
        best
    }

    fn shortfall_at(&mut self, v: VertexId, to: Point, by: By, asked: f64, memory: &mut Memory) -> f64 {
        self.tries += 1;
        let trial = self.try_move(v, to);
        let shortfall = self.shortfall(v, by, asked, memory);
        self.take_back(&trial);
        shortfall
    }

    fn shortfall(&self, v: VertexId, by: By, asked: f64, memory: &mut Memory) -> f64 {
        let Self { dual, topology, positions, locals, .. } = self;
        let estimate = Estimate { dual, topology, positions, locals };
        let faces = estimate.around(v);
        match by {
            By::Estimates => estimate.shortfall(&faces, |u| asked * self.excess[u.index()]),
            By::Geodesics => self.exact_shortfall(&faces, asked * ASKED_OF_GEODESICS, memory),
        }
    }

    /// [`Estimate::shortfall`] by geodesics.
    fn exact_shortfall(&self, faces: &[FaceId], asked: f64, memory: &mut Memory) -> f64 {
        let topology = &self.topology;
        // The powers of seeds count that the neighbours of the faces' corners are.
        let corners = faces.iter().flat_map(|&f| topology.corners(f));
        let wide = distinct(corners.flat_map(|v| topology.star(v).map(HalfEdge::face)));
        let border = faces.iter().flat_map(|f| f.half_edges()).filter(|&h| topology.twin(h).is_none());
        let border: Vec<[u32; 2]> = border.map(|h| topology.ends(h).map(|v| v.0)).collect();
        let triangles = corners_of(topology, wide.into_iter());
        let own = corners_of(topology, faces.iter().copied());
        let is_inside = |seed: u32, p: Point| self.dual.is_inside(VertexId(seed), p);
        let found = Simplices { seeds: &self.positions, triangles: &triangles, border: &border, is_inside: &is_inside };
        let net = Net::measure_some(self.dual.field(), &found, &own, memory);
        let powers = net.interior().map(|ball| ball.power).chain(net.border.iter().map(|ball| ball.power));
        net.unmeasured as f64 + powers.map(|power| (1.0 - power / asked).max(0.0)).sum::<f64>()
    }

    /// A random point within a distance of a seed; on its curve, of a seed that is bound to one.
    fn place_near(&mut self, v: VertexId, radius: f64) -> Point {
        let local = &self.locals[v.index()];
        let step = local.exp(self.random.in_ball(local.tensor, radius));
        if self.dual.kind(v) == Kind::Curve {
            self.dual.slid(v, step, SLIDING)
        } else {
            self.positions[v.index()] + step
        }
    }

    fn try_move(&mut self, v: VertexId, to: Point) -> Trial {
        let from = (self.positions[v.index()], self.locals[v.index()]);
        self.positions[v.index()] = to;
        self.locals[v.index()] = LocalMetric::at(self.dual.field(), to);
        Trial { v, from, flips: self.flip_around(v) }
    }

    fn take_back(&mut self, trial: &Trial) {
        for &h in trial.flips.iter().rev() {
            // Four flips of an edge are none.
            (0..3).for_each(|_| self.topology.flip(h));
        }
        (self.positions[trial.v.index()], self.locals[trial.v.index()]) = trial.from;
    }

    /// Flips around a seed; returns them in order.
    fn flip_around(&mut self, v: VertexId) -> Vec<HalfEdge> {
        let mut lawson = Lawson::default();
        lawson.queue(self.topology.star(v).flat_map(|h| [h, h.next()]));
        lawson.pass(self, LIMIT).to_vec()
    }
}

impl Flipping for Mender<'_, '_> {
    fn topology(&mut self) -> &mut Triangulation {
        &mut self.topology
    }

    /// By lengths from expansions.
    fn wants_flip(&mut self, h: HalfEdge) -> bool {
        let Some([a, b, c, d]) = self.topology.quad(h).filter(|_| self.topology.can_flip(h)) else { return false };
        let (at, local) = (&self.positions, &self.locals);
        let length = |u: VertexId, v: VertexId| {
            let (u, v) = (u.index(), v.index());
            hermite(at[u], &local[u], at[v], &local[v]).value
        };
        let angles = Angles::from_lengths(length(a, b), [length(a, c), length(b, c)], [length(a, d), length(b, d)]);
        angles.margin() < -TIE
    }
}

/// The power of a circle and the seeds that it depends on.
fn around<const N: usize>(ball: &Ball<N>) -> (f64, Vec<VertexId>) {
    (ball.power, ball.corners.iter().copied().chain(ball.nearest).map(VertexId).collect())
}
