//! What a set of seeds is as a net (RR-9103, sections 3.1 and 3.4): how well it covers a domain (epsilon), how far its
//! seeds are apart (mu), and how far every Delaunay circle is from holding a fourth seed (delta, the power protection).
//!
//! `Net::measure` is exact up to the error of geodesics. `Estimate` is the cheap version for seeds that come, go and
//! move: the same figures from expansions of the metric (`LocalMetric`).

mod estimate;
mod measure;
mod on_canvas;
mod seen;
mod random;

pub(crate) use estimate::Estimate;
pub(crate) use measure::Memory;
pub(crate) use on_canvas::circles_on_canvas;
pub use random::Random;
pub(crate) use seen::{SeedsOnSurface, Terrain, View};

use crate::geometry::Point;
use crate::lists::distinct;
use crate::manifold::Place;
use crate::mesh::edges_of;
use crate::metric::MetricField;
use crate::triangulation::smallest_first;
use measure::Measure;
use seen::{Flat, Seeds};
use std::collections::HashSet;

/// A Delaunay circle: of a triangle, or of an edge at the border of the domain, where its centre is on that edge. Its centre is a point, or
/// a place of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<const N: usize, P = Point> {
    /// The seeds on the circle.
    pub corners: [u32; N],
    /// The centre: a vertex of the Voronoi diagram where it lies in the domain.
    pub centre: P,
    /// The radius, in the metric.
    pub radius: f64,
    /// The least power (squared distance from the centre less squared radius) of a seed near the triangle that is no
    /// corner of it: the square of the power protection; negative of a triangle that is not Delaunay. Infinite where
    /// there is no other seed.
    pub power: f64,
    /// The seed of that power.
    pub nearest: Option<u32>,
    /// Whether the centre is in the domain, as its triangle sees it. The others are no simplices of the Voronoi diagram's
    /// dual, which ends at the border.
    pub is_interior: bool,
}

impl<const N: usize, P> Ball<N, P> {
    /// The power protection delta: 0 where there is none.
    pub fn protection(&self) -> f64 {
        self.power.max(0.0).sqrt()
    }
}

/// The circles of a net, and what follows from them. Lengths are those of the metric.
#[derive(Clone, Debug, PartialEq)]
pub struct Net<P = Point> {
    /// Of the triangles, in their order, without those that have no circle.
    pub triangles: Vec<Ball<3, P>>,
    /// Of the edges at the border: where the border of two cells meets that of the domain.
    pub border: Vec<Ball<2, P>>,
    /// Border edges and triangles with their circumcentre in the domain, as one tensor has it, of which no circle was found:
    /// they are nearly straight, or geodesics are not resolved.
    pub unmeasured: usize,
    /// The triangles among them.
    pub unknown: Vec<[u32; 3]>,
    /// Triangles whose circles geodesics did not find and distances on a canvas did (`circles_on_canvas`).
    pub by_canvas: usize,
    /// Lengths, of those that mu and powers are from, for which chords stand in where geodesics are not resolved: these are
    /// no shorter than the lengths. Lengths that a memory knew are not counted again.
    pub by_chord: usize,
    /// How far a point of the domain is from its nearest seed at most: the greatest radius of the circles with centres
    /// in the domain and no seed in them.
    pub epsilon: f64,
    /// The least distance between two seeds.
    pub mu: f64,
}

impl<P> Default for Net<P> {
    fn default() -> Self {
        Self {
            triangles: Vec::new(),
            border: Vec::new(),
            unmeasured: 0,
            unknown: Vec::new(),
            by_canvas: 0,
            by_chord: 0,
            epsilon: 0.0,
            mu: 0.0,
        }
    }
}

/// A triangulation of seeds whose circles are asked for.
#[derive(Clone, Copy)]
pub(crate) struct Simplices<'a> {
    /// The seeds.
    pub seeds: &'a [Point],
    /// Riemannian Delaunay triangles by their seeds, counter-clockwise.
    pub triangles: &'a [[u32; 3]],
    /// Edges that are pieces of the domain's border, straight, with both seeds on it.
    pub border: &'a [[u32; 2]],
    /// Whether a point is in the domain, as the triangle sees it that has the seed for a corner.
    pub is_inside: &'a (dyn Fn(u32, Point) -> bool + Sync),
}

impl Net {
    /// Measures with geodesics, in parallel. The field may measure in any unit.
    ///
    /// For every triangle all seeds are asked that share an edge with one of its corners: a seed in its circle need not
    /// be opposite to one of its sides. Distances know of no holes.
    pub(crate) fn measure(field: &dyn MetricField, found: &Simplices) -> Self {
        Self::measure_beside(field, found, &[], &mut Memory::default())
    }

    /// [`Net::measure`] of seeds of which most are where they were when the memory was written: what depends on no seed that
    /// has moved is not measured again. The memory is of one field and one domain. Some circles may be known from a canvas
    /// ([`circles_on_canvas`]).
    pub(crate) fn measure_beside(
        field: &dyn MetricField,
        found: &Simplices,
        known: &[Ball<3>],
        memory: &mut Memory,
    ) -> Self {
        Self::measured(&Measure::new(Flat { field, found }, found.triangles, found.border), known, memory)
    }

    /// The circles of some of the triangles, and of the border edges, and nothing else: neither epsilon nor mu.
    pub(crate) fn measure_some(
        field: &dyn MetricField,
        found: &Simplices,
        wanted: &[[u32; 3]],
        memory: &mut Memory,
    ) -> Self {
        Measure::new(Flat { field, found }, found.triangles, found.border).circles(wanted, memory)
    }
}

impl Net<Place> {
    /// Measures seeds on a surface, in charts around their triangles ([`SeedsOnSurface`]); what a memory of that surface knows is not measured
    /// again.
    pub(crate) fn on_surface(seeds: &SeedsOnSurface, triangles: &[[u32; 3]], memory: &mut Memory<Place>) -> Self {
        Self::measured(&Measure::new(seeds, triangles, &[]), &[], memory)
    }

    /// The same but for mu.
    pub(crate) fn circles_on_surface(
        seeds: &SeedsOnSurface,
        triangles: &[[u32; 3]],
        memory: &mut Memory<Place>,
    ) -> Self {
        Self::circled(&Measure::new(seeds, triangles, &[]), &[], memory)
    }
}

impl<P: Copy + PartialEq + Send + Sync> Net<P> {
    fn measured<S: Seeds<Place = P>>(measure: &Measure<S>, known: &[Ball<3, P>], memory: &mut Memory<P>) -> Self {
        let net = Self::circled(measure, known, memory);
        Self { mu: measure.mu(), by_chord: measure.chords(), ..net }
    }

    fn circled<S: Seeds<Place = P>>(measure: &Measure<S>, known: &[Ball<3, P>], memory: &mut Memory<P>) -> Self {
        let of_canvas: HashSet<[u32; 3]> = known.iter().map(|ball| smallest_first(ball.corners)).collect();
        let is_open = |corners: &&[u32; 3]| !of_canvas.contains(&smallest_first(**corners));
        let wanted: Vec<[u32; 3]> = measure.all().iter().filter(is_open).copied().collect();
        let mut net = Self { by_canvas: known.len(), ..measure.circles(&wanted, memory) };
        net.triangles.extend_from_slice(known);
        // A circle with a seed in it says nothing of how far points are from seeds.
        let interior = net.interior().map(|ball| (ball.power, ball.radius));
        let circles = interior.chain(net.border.iter().map(|ball| (ball.power, ball.radius)));
        net.epsilon = circles.filter(|&(power, _)| power >= 0.0).map(|(_, radius)| radius).fold(0.0, f64::max);
        net
    }

    /// The triangles whose circumcentre is in the domain.
    pub fn interior(&self) -> impl Iterator<Item = &Ball<3, P>> {
        self.triangles.iter().filter(|ball| ball.is_interior)
    }

    /// mu / epsilon: 1 of seeds as even as can be.
    pub(crate) fn lambda(&self) -> f64 {
        self.mu / self.epsilon
    }

    /// The power protection of the interior triangles: that of the least protected; infinite where there are none.
    pub(crate) fn delta(&self) -> f64 {
        self.interior().map(Ball::protection).fold(f64::INFINITY, f64::min)
    }

    /// The power protection of the edges at the border; infinite where there are none.
    pub(crate) fn border_delta(&self) -> f64 {
        self.border.iter().map(Ball::protection).fold(f64::INFINITY, f64::min)
    }
}

/// The seeds that share a triangle with each of so many seeds, in order.
pub(crate) fn neighbours(seeds: usize, triangles: impl Iterator<Item = [u32; 3]>) -> Vec<Vec<u32>> {
    let mut neighbours: Vec<Vec<u32>> = vec![Vec::new(); seeds];
    for [i, j] in triangles.flat_map(edges_of) {
        neighbours[i as usize].push(j);
        neighbours[j as usize].push(i);
    }
    neighbours.into_iter().map(distinct).collect()
}
