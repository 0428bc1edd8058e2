//! Places tried for seeds that stand in a plane with a metric, by the power protection of the simplices around: random ones, by
//! estimates, and the best of these by geodesics.

use super::survey::corners_of;
use crate::geodesic::{Angles, LocalMetric, hermite};
use crate::geometry::{Point, Vector};
use crate::lists::distinct;
use crate::net::{Estimate, Memory, Net, Random, Simplices, Terrain};
use crate::triangulation::{FaceId, Flipping, HalfEdge, Lawson, Limit, Triangulation, VertexId};
use std::collections::BTreeMap;

/// Places tried for the seeds around one simplex, a round: with estimates, and, of these the best, with geodesics.
const TRIES: [usize; 2] = [60, 24];
/// With geodesics it is this much more power, since epsilon may grow by other moves.
const ASKED_OF_GEODESICS: f64 = 1.01;
/// Shares of the power asked for that are as good as none.
pub(super) const LEAST_GAIN: f64 = 1e-6;
/// Flips after one move, at most: lengths that contradict each other must not make it last for ever.
const LIMIT: Limit = Limit::OfAll(60);
/// Margins closer to zero than this are ties.
const TIE: f64 = 1e-9;

/// What places for seeds are tried with.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum By {
    Estimates,
    Geodesics,
}

/// What is asked of places for seeds.
pub(super) struct Wish<'a> {
    pub(super) by: By,
    /// The power of simplices.
    pub(super) asked: f64,
    /// By how much more power than asked for estimates must have at each seed.
    pub(super) excess: &'a [f64],
    /// How far seeds may move.
    pub(super) radius: f64,
}

/// Random steps, and how many places were tried.
pub(super) struct Luck {
    pub(super) random: Random,
    pub(super) tries: u64,
}

/// A place for a seed and by how much less simplices around it miss the power asked for, in shares of it.
pub(super) type Found<P> = (f64, VertexId, P);

/// The best first.
pub(super) fn sort<P>(found: &mut [Found<P>]) {
    found.sort_by(|a, b| b.0.total_cmp(&a.0));
}

/// Seeds in a plane, in a triangulation that is embedded nowhere, as geodesics want it.
pub(super) struct Stand {
    pub(super) positions: Vec<Point>,
    pub(super) locals: Vec<LocalMetric>,
    pub(super) topology: Triangulation,
}

/// A move on trial, and how to take it back.
struct Trial {
    v: VertexId,
    from: (Point, LocalMetric),
    flips: Vec<HalfEdge>,
}

impl Stand {
    /// Where a random step no longer than a radius leads from a seed.
    pub(super) fn step(&self, v: VertexId, radius: f64, luck: &mut Luck) -> Vector {
        let local = &self.locals[v.index()];
        local.exp(luck.random.in_ball(local.tensor, radius))
    }

    /// Moves a seed, and flips around it.
    pub(super) fn relocate(&mut self, terrain: &dyn Terrain, v: VertexId, to: Point) {
        self.try_move(terrain, v, to);
    }

    fn try_move(&mut self, terrain: &dyn Terrain, v: VertexId, to: Point) -> Trial {
        let from = (self.positions[v.index()], self.locals[v.index()]);
        self.positions[v.index()] = to;
        self.locals[v.index()] = LocalMetric::at(terrain.field(), to);
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

impl Flipping for Stand {
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

/// A search for places in a terrain.
pub(super) struct Search<'a> {
    pub(super) terrain: &'a dyn Terrain,
    pub(super) stand: &'a mut Stand,
    /// Where a step leads a seed from a point, if it may go there.
    pub(super) reach: &'a dyn Fn(VertexId, Point, Vector) -> Option<Point>,
}

impl Search<'_> {
    /// Places for some seeds that may move, the best first: as estimated, or by geodesics that one that is best of these.
    pub(super) fn places(&mut self, movable: &[VertexId], wish: &Wish, luck: &mut Luck) -> Vec<Found<Point>> {
        let mut found = self.estimated(movable, wish, luck);
        sort(&mut found);
        match wish.by {
            By::Estimates => found,
            By::Geodesics => self.best_by_geodesics(&found, wish, luck).into_iter().collect(),
        }
    }

    /// Places for seeds by what they gain, estimated; until one gains everything, if estimates are to decide.
    fn estimated(&mut self, movable: &[VertexId], wish: &Wish, luck: &mut Luck) -> Vec<Found<Point>> {
        let before: Vec<f64> = movable.iter().map(|&v| self.estimated_shortfall(v, wish)).collect();
        let mut found = Vec::new();
        if !self.terrain.is_whole() && wish.by == By::Estimates && before.iter().all(|&before| before <= LEAST_GAIN) {
            // Circles that geodesics do not find: no estimate tells what would mend them, and there is no canvas here.
            return found;
        }
        for k in 0..if movable.is_empty() { 0 } else { TRIES[0].max(4 * movable.len()) } {
            let (v, before) = (movable[k % movable.len()], before[k % movable.len()]);
            let step = self.stand.step(v, wish.radius, luck);
            let Some(to) = (self.reach)(v, self.stand.positions[v.index()], step) else { continue };
            let gain = before - self.tried(v, to, luck, |this| this.estimated_shortfall(v, wish));
            found.push((gain, v, to));
            if wish.by == By::Estimates && gain > LEAST_GAIN && gain >= before - LEAST_GAIN {
                // All that was missing around the seed is there.
                break;
            }
        }
        found
    }

    /// The best of the first places by geodesics.
    fn best_by_geodesics(&mut self, found: &[Found<Point>], wish: &Wish, luck: &mut Luck) -> Option<Found<Point>> {
        let mut memory = Memory::default();
        let mut before: BTreeMap<VertexId, f64> = BTreeMap::new();
        let mut best: Option<Found<Point>> = None;
        for &(_, v, to) in found.iter().take(TRIES[1]) {
            let before = *before.entry(v).or_insert_with(|| self.exact_shortfall(v, wish, &mut memory));
            let gain = before - self.tried(v, to, luck, |this| this.exact_shortfall(v, wish, &mut memory));
            if best.is_none_or(|b| gain > b.0) {
                best = Some((gain, v, to));
            }
            if gain > LEAST_GAIN && gain >= before - LEAST_GAIN {
                break;
            }
        }
        best
    }

    /// What is found with a seed elsewhere.
    fn tried(&mut self, v: VertexId, to: Point, luck: &mut Luck, find: impl FnOnce(&Self) -> f64) -> f64 {
        luck.tries += 1;
        let trial = self.stand.try_move(self.terrain, v, to);
        let found = find(self);
        self.stand.take_back(&trial);
        found
    }

    fn estimate(&self) -> Estimate<'_> {
        let Stand { topology, positions, locals } = &*self.stand;
        Estimate { terrain: self.terrain, topology, positions, locals }
    }

    fn estimated_shortfall(&self, v: VertexId, wish: &Wish) -> f64 {
        let estimate = self.estimate();
        estimate.shortfall(&estimate.around(v), |u| wish.asked * wish.excess[u.index()])
    }

    /// [`Estimate::shortfall`] by geodesics.
    fn exact_shortfall(&self, v: VertexId, wish: &Wish, memory: &mut Memory) -> f64 {
        let (terrain, topology) = (self.terrain, &self.stand.topology);
        let faces: Vec<FaceId> = self.estimate().around(v);
        // The powers of seeds count that the neighbours of the faces' corners are.
        let corners = faces.iter().flat_map(|&f| topology.corners(f));
        let wide = distinct(corners.flat_map(|v| topology.star(v).map(HalfEdge::face)));
        let is_border = |h: &HalfEdge| terrain.is_whole() && topology.twin(*h).is_none();
        let border = faces.iter().flat_map(|f| f.half_edges()).filter(is_border);
        let border: Vec<[u32; 2]> = border.map(|h| topology.ends(h).map(|v| v.0)).collect();
        let triangles = corners_of(topology, wide.into_iter());
        let own = corners_of(topology, faces.iter().copied());
        let is_inside = |seed: u32, p: Point| terrain.is_inside(seed, p);
        let seeds = &self.stand.positions;
        let found = Simplices { seeds, triangles: &triangles, border: &border, is_inside: &is_inside };
        let net = Net::measure_some(terrain.field(), &found, &own, memory);
        let powers = net.interior().map(|ball| ball.power).chain(net.border.iter().map(|ball| ball.power));
        let asked = wish.asked * ASKED_OF_GEODESICS;
        net.unmeasured as f64 + powers.map(|power| (1.0 - power / asked).max(0.0)).sum::<f64>()
    }
}
