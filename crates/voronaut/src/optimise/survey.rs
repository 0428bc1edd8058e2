//! The Riemannian Delaunay triangulation of a dual's seeds, which straight edges need not follow, and its net; and which seeds
//! rest while others are relaxed.

use super::movers::{Region, State};
use crate::dual::{Dual, Moving};
use crate::geometry::Point;
use crate::lists::{distinct, in_order};
use crate::net::{Ball, Memory, Net, Simplices};
use crate::rdt;
use crate::rdt::{Rdt, Start, Trust};
use crate::triangulation::{FaceId, Triangulation, VertexId};

/// How often the region where a canvas decides grows at most, from one survey to the next; and the share of the seeds that
/// it may have: elsewhere what geodesics do not tell stays unknown.
const GROWING: usize = 4;
const LARGEST: f64 = 0.3;
/// Canvas vertices per seed there.
const PER_SEED: usize = 200;

/// Surveys of seeds of which few move in between.
#[derive(Default)]
pub(super) struct Survey {
    memory: Memory,
    tests: rdt::Memory,
    region: Option<Region>,
}

impl Survey {
    /// Triangulates, from a triangulation that is nearly right, and measures: with geodesics, and where these are not
    /// resolved by the diagram on a canvas. The topology is `None` where vertices had to be made two.
    pub(super) fn take(
        &mut self,
        dual: &Dual,
        positions: &[Point],
        start: &Triangulation,
    ) -> (Net, Option<Triangulation>) {
        let mut surveyed = self.take_once(dual, positions, start);
        for _ in 0..GROWING {
            let doubtful = self.doubtful(&surveyed.0);
            if doubtful.is_empty() || !self.grow(dual, &doubtful) {
                break;
            }
            surveyed = self.take_once(dual, positions, start);
        }
        surveyed
    }

    /// The seeds of triangles beside the region that have no circle, or one with a seed in it although in-circle tests put
    /// them there: then lengths of geodesics contradict each other.
    fn doubtful(&self, net: &Net) -> Vec<u32> {
        let turned_over = net.interior().filter(|ball| ball.power < 0.0).map(|ball| ball.corners);
        let all = net.unknown.iter().copied().chain(turned_over);
        all.filter(|corners| !self.region.as_ref().is_some_and(|region| region.touches(corners))).flatten().collect()
    }

    /// Whether a canvas decides on the triangles of some of these seeds.
    pub(super) fn is_by_canvas(&self, seeds: &[VertexId]) -> bool {
        self.region.as_ref().is_some_and(|region| seeds.iter().any(|v| region.touches(&[v.0])))
    }

    fn grow(&mut self, dual: &Dual, unknown: &[u32]) -> bool {
        let unknown = unknown.iter().map(|&i| VertexId(i));
        let seeds = distinct(unknown.chain(self.region.iter().flat_map(Region::seeds)));
        let has_room = (seeds.len() as f64) < LARGEST * dual.topology().vertex_count() as f64;
        let grown = has_room.then(|| Region::around(dual, &seeds, PER_SEED)).flatten();
        let has_grown = grown.is_some();
        self.region = grown.or(self.region.take());
        has_grown
    }

    fn take_once(&mut self, dual: &Dual, positions: &[Point], start: &Triangulation) -> (Net, Option<Triangulation>) {
        let found = |region: &Region| region.circles(dual, |v| positions[v.index()]);
        let mut circles = self.region.as_ref().and_then(found);
        if circles.is_none() {
            // Seeds have left the part of the domain that the canvas covers.
            self.region = self.region.as_ref().and_then(|region| Region::around(dual, &region.core, PER_SEED));
            circles = self.region.as_ref().and_then(found);
        }
        let region = self.region.as_ref().filter(|_| circles.is_some());
        let circles = circles.unwrap_or_default();
        // The diagram's triangles stand around the region's seeds: no length is good enough there.
        let vetoed = |i: u32, j: u32| region.is_some_and(|region| region.touches(&[i, j])).then_some((0.0, 0.0));
        let trust = Trust { reference: Some(&vetoed), ..Trust::default() };
        let with_circles = |mut triangles: Vec<[u32; 3]>| {
            triangles.retain(|corners| !region.is_some_and(|region| region.touches(corners)));
            triangles.extend(circles.iter().map(|ball| ball.corners));
            triangles
        };
        let triangles = with_circles(corners_of(start, start.faces()));
        let at_border = border_of(start).into_iter().map(in_order).collect();
        let tests = std::mem::take(&mut self.tests);
        let rdt = Rdt::again(dual.field(), positions, &Start { triangles, at_border }, trust, tests);
        // Of the region's seeds the diagram has all simplices: where cells touch twice no triangulation can hold them.
        let triangles = with_circles(rdt.triangles());
        let topology = (rdt.counters().split == 0).then(|| rdt.topology().clone());
        self.tests = rdt.into_memory();
        (measure(dual, positions, &triangles, &circles, &mut self.memory), topology)
    }
}

fn measure(dual: &Dual, seeds: &[Point], triangles: &[[u32; 3]], known: &[Ball<3>], memory: &mut Memory) -> Net {
    let border = border_of(dual.topology());
    let is_inside = |seed: u32, p: Point| dual.is_inside(VertexId(seed), p);
    let found = Simplices { seeds, triangles, border: &border, is_inside: &is_inside };
    Net::measure_beside(dual.field(), &found, known, memory)
}

/// Corners of faces by their numbers.
pub(super) fn corners_of(topology: &Triangulation, faces: impl Iterator<Item = FaceId>) -> Vec<[u32; 3]> {
    faces.map(|f| topology.corners(f).map(|v| v.0)).collect()
}

fn border_of(topology: &Triangulation) -> Vec<[u32; 2]> {
    topology.borders().map(|h| topology.ends(h).map(|v| v.0)).collect()
}

/// The Riemannian Delaunay triangulation of a dual's seeds, measured.
pub(crate) fn measured(dual: &Dual) -> Net {
    let seeds: Vec<Point> = (0..dual.topology().vertex_slots() as u32).map(|v| dual.position(VertexId(v))).collect();
    Survey::default().take(dual, &seeds, dual.topology()).0
}

/// A seed rests for twice as many steps as the last time, up to this many.
const LONGEST: u16 = 64;
/// As many seeds are blamed as explain the rise so many times over.
const SURPLUS: f64 = 2.0;

/// Seeds that rest, because around them the energy rose: where the metric is rough, or edges cannot be flipped, the
/// energy jumps, and a few such places would keep all others from moving.
pub(super) struct Rest {
    /// Steps that each seed rests for still, and will rest for the next time.
    steps: Vec<[u16; 2]>,
}

impl Rest {
    /// Nobody rests.
    pub(super) fn new(seeds: usize) -> Self {
        Self { steps: vec![[0, 1]; seeds] }
    }

    /// Whether a seed moves.
    pub(super) fn is_awake(&self, seed: usize) -> bool {
        self.steps[seed][0] == 0
    }

    /// Begins a step.
    pub(super) fn next_step(&mut self) {
        self.steps.iter_mut().for_each(|[left, _]| *left = left.saturating_sub(1));
    }

    /// Puts the seeds to rest around which the energy rose most, with their neighbours. Returns how many.
    pub(super) fn blame(&mut self, dual: &impl Moving, before: &State, after: &State) -> usize {
        let topology = dual.topology();
        let rise = rise_around(dual, before, after);
        let rise_at = |i: usize| rise[before.seeds[i].id.index()];
        let mut order: Vec<usize> = (0..before.seeds.len()).filter(|&i| self.is_awake(i) && rise_at(i) > 0.0).collect();
        order.sort_by(|&i, &j| rise_at(j).total_cmp(&rise_at(i)).then(i.cmp(&j)));
        let mut is_blamed = vec![false; topology.vertex_slots()];
        let mut unexplained = SURPLUS * (after.energy - before.energy);
        for i in order {
            let v = before.seeds[i].id;
            if unexplained < 0.0 {
                break;
            }
            if !is_blamed[v.index()] {
                unexplained -= rise_at(i);
                is_blamed[v.index()] = true;
                topology.star(v).for_each(|h| is_blamed[topology.target(h).index()] = true);
            }
        }
        let mut count = 0;
        for (seed, steps) in before.seeds.iter().zip(&mut self.steps) {
            if is_blamed[seed.id.index()] && steps[0] == 0 {
                *steps = [steps[1], (2 * steps[1]).min(LONGEST)];
                count += 1;
            }
        }
        count
    }
}

/// By how much the energy of the cells at and around each seed has risen, by its id.
fn rise_around(dual: &impl Moving, before: &State, after: &State) -> Vec<f64> {
    let topology = dual.topology();
    let mut rise = vec![0.0; topology.vertex_slots()];
    for (&(v, was), &(_, now)) in before.shares.iter().zip(&after.shares) {
        rise[v.index()] += now - was;
        topology.star(v).for_each(|h| rise[topology.target(h).index()] += now - was);
    }
    rise
}
