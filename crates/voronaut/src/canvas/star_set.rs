//! Star sets (RR-9103, section 7): the Delaunay star of every vertex in its own metric, whether or not the stars agree.

use super::star::{Finder, Spoke, Star, as_it_is, circle, has};
use super::steiner::{Placed, Steiner};
use super::{CanvasCounters, refine, renumbered};
use crate::error::Result;
use crate::geometry::Point;
use crate::lists::distinct;
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use crate::planar::Planar;
use crate::triangulation::{HalfEdge, VertexId};
use std::collections::HashSet;

/// The share of the vertices that the embedded triangulation is refined to before stars are.
const FROM_EMBEDDED: f64 = 0.7;
/// Stars are searched in parts of so many at least.
const PART: usize = 512;

/// The stars of the vertices of a canvas, cut by the domain's boundary and by its inner features. A graph, not a
/// triangulation: a simplex may be in the star of one of its vertices and not in that of another, an *inconsistency*.
///
/// Deterministic, for any number of threads.
#[derive(Debug)]
pub struct StarSet {
    pub(super) stars: Vec<Star>,
    pub(super) figures: StarFigures,
}

/// A star set in numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct StarFigures {
    /// Vertices.
    pub vertices: usize,
    /// Simplices that are in the star of one of their vertices and not in that of another.
    pub inconsistencies: usize,
    /// Simplices of any star, each once.
    pub simplices: usize,
    /// The greatest circumradius of a star's simplex, in the metric of the star.
    pub radius: f64,
    /// Of stars made consistent, passes over all of them in search of inconsistencies.
    pub rounds: usize,
    /// Stars that rounding kept from being found: they are those of the embedded triangulation.
    pub unsettled: usize,
}

/// Refines a triangulation to so many vertices (more if it has more), even in the metric: to a part of them as for
/// [`super::Canvas::intrinsic`], then at circumcentres of the largest simplices of stars. A centre that encroaches the
/// boundary halves it instead.
///
/// # Errors
/// The metric is not positive definite at a vertex.
pub(super) fn refine(
    planar: Planar,
    field: &dyn MetricField,
    vertices: usize,
    counters: &mut CanvasCounters,
) -> Result<Planar> {
    let start = (FROM_EMBEDDED * vertices as f64) as usize;
    let planar = refine::refine(planar, field, refine::COARSE, start, counters)?;
    let mut stars = Stars::new(Steiner::metric(renumbered(&planar), field)?);
    loop {
        let missing = vertices.saturating_sub(stars.steiner.planar.topology.vertex_count());
        let placed = if missing == 0 { 0 } else { stars.refine_largest(missing)? };
        counters.splits += placed as u64;
        if placed == 0 {
            return Ok(stars.steiner.planar);
        }
    }
}

impl StarSet {
    /// The stars of all vertices of an embedded triangulation, none of whose slots is empty.
    ///
    /// # Errors
    /// The metric is not positive definite at a vertex.
    pub(super) fn new(embedded: &Planar, field: &dyn MetricField) -> Result<Self> {
        let stars = Stars::new(Steiner::metric(embedded.clone(), field)?);
        Ok(Self { figures: stars.figures(), stars: stars.by_vertex })
    }

    /// Every vertex with those in its star.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = [VertexId; 2]> + '_ {
        let vertices = (0..self.stars.len() as u32).map(VertexId);
        vertices.flat_map(|v| self.star(v).flatten().map(move |u| [v, u]))
    }

    /// The simplices of the star of a vertex, each by its other two vertices, counter-clockwise.
    pub(crate) fn star(&self, v: VertexId) -> impl Iterator<Item = [VertexId; 2]> + '_ {
        self.stars[v.index()].iter().map(|spoke| spoke.ends)
    }

    /// The star set in numbers.
    pub(crate) fn figures(&self) -> &StarFigures {
        &self.figures
    }
}

/// Stars over an embedded triangulation that both grow.
pub(super) struct Stars<'a> {
    pub(super) steiner: Steiner<'a>,
    pub(super) by_vertex: Vec<Star>,
    unsettled: usize,
}

impl<'a> Stars<'a> {
    /// The stars of all vertices of a triangulation.
    pub(super) fn new(steiner: Steiner<'a>) -> Self {
        let mut stars = Self { steiner, by_vertex: Vec::new(), unsettled: 0 };
        stars.update_all();
        stars
    }

    /// Finds all stars anew.
    pub(super) fn update_all(&mut self) {
        let all: Vec<VertexId> = self.steiner.planar.topology.vertices().collect();
        self.by_vertex = vec![Star::new(); self.steiner.planar.topology.vertex_slots()];
        self.unsettled = self.update(&all);
    }

    /// Finds some stars anew, in parallel; returns how many could not be found.
    pub(super) fn update(&mut self, dirty: &[VertexId]) -> usize {
        let steiner = &self.steiner;
        let find = |finder: &mut Finder, &v: &VertexId| finder.star(v, steiner.tensors[v.index()]);
        let parts = dirty.par_chunks(PART).map_init(
            || Finder::new(&steiner.planar),
            |finder, part| part.iter().map(|v| find(finder, v)).collect::<Vec<_>>(),
        );
        let found: Vec<Option<Star>> = parts.flatten_iter().collect();
        let mut unsettled = 0;
        for (&v, star) in dirty.iter().zip(found) {
            unsettled += usize::from(star.is_none());
            self.by_vertex[v.index()] = star.unwrap_or_else(|| as_it_is(&steiner.planar.topology, v));
        }
        unsettled
    }

    /// The circle of a simplex of v's star, in v's metric.
    pub(super) fn circle(&self, v: VertexId, [a, b]: [VertexId; 2]) -> Option<(Point, f64)> {
        circle(self.steiner.tensors[v.index()], [v, a, b].map(|u| self.steiner.planar.position(u)))
    }

    /// One round: circumcentres of the largest simplices, `most` of them, where no other was put in this round.
    fn refine_largest(&mut self, most: usize) -> Result<usize> {
        let largest = |v: u32| {
            let circles =
                self.by_vertex[v as usize].iter().filter_map(|s| Some((self.circle(VertexId(v), s.ends)?, s.ends)));
            circles.max_by(|a, b| a.0.1.total_cmp(&b.0.1)).map(|((centre, radius), ends)| (radius, v, ends, centre))
        };
        let mut all: Vec<_> = (0..self.by_vertex.len() as u32).into_par_iter().filter_map(largest).collect();
        all.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        // The largest first; never so many that small ones are cut before large ones are known.
        all.truncate(all.len().div_ceil(3));
        let mut taken: HashSet<VertexId> = HashSet::new();
        let mut dirty = Vec::new();
        let mut placed = 0;
        for (radius, v, ends, centre) in all {
            let v = VertexId(v);
            if placed == most || [v, ends[0], ends[1]].iter().any(|u| taken.contains(u)) {
                continue;
            }
            if let Placed::Inserted(new) | Placed::Halved(new) = self.place(v, centre, radius)? {
                taken.extend(self.steiner.planar.topology.star(new).map(|h| self.steiner.planar.topology.target(h)));
                taken.extend([v, ends[0], ends[1]]);
                dirty.push(new);
                placed += 1;
            }
        }
        self.mend(&dirty);
        Ok(placed)
    }

    /// Puts a vertex at a point seen from v, or on the fixed edge in its way. Stars are to be mended after.
    pub(super) fn place(&mut self, v: VertexId, p: Point, radius: f64) -> Result<Placed> {
        let planar = &self.steiner.planar;
        let towards = planar.face_towards(v, p).or_else(|| planar.topology.start(v).map(HalfEdge::face));
        let Some(from) = towards else { return Ok(Placed::Refused) };
        self.steiner.place(from, p, radius)
    }

    /// Gives new vertices empty stars.
    pub(super) fn make_room(&mut self) {
        self.by_vertex.resize(self.steiner.planar.topology.vertex_slots(), Star::new());
    }

    /// Finds the stars of new vertices, and those that they change.
    pub(super) fn mend(&mut self, new: &[VertexId]) -> Vec<VertexId> {
        self.make_room();
        let dirty = distinct(new.iter().flat_map(|&v| self.changed_by(v)));
        self.update(&dirty);
        dirty
    }

    /// The vertices whose stars a vertex changes: it is in a circle of theirs. Searched from it through the neighbourhood
    /// until two steps lead to no more.
    pub(super) fn changed_by(&self, new: VertexId) -> Vec<VertexId> {
        let topology = &self.steiner.planar.topology;
        let p = self.steiner.planar.position(new);
        let ring = |v: VertexId| topology.around(v);
        let mut changed = vec![new];
        let mut seen: HashSet<VertexId> = HashSet::from([new]);
        let mut next: Vec<(VertexId, u8)> = ring(new).map(|v| (v, 0)).collect();
        changed.extend(ring(new));
        while let Some((v, idle)) = next.pop() {
            if !seen.insert(v) {
                continue;
            }
            let holds = |spoke: &Spoke| {
                let centre = self.circle(v, spoke.ends);
                centre.is_some_and(|(c, r)| self.steiner.tensors[v.index()].length(p - c) <= r * (1.0 + 1e-9))
            };
            let idle = if self.by_vertex[v.index()].iter().any(holds) {
                changed.push(v);
                0
            } else {
                idle + 1
            };
            if idle < 2 {
                let mine = self.by_vertex[v.index()].iter().flat_map(|s| s.ends);
                next.extend(ring(v).chain(mine).filter(|u| !seen.contains(u)).map(|u| (u, idle)));
            }
        }
        distinct(changed)
    }

    /// Whether the star of v has the simplex v a b.
    pub(super) fn has(&self, v: VertexId, ends: [VertexId; 2]) -> bool {
        has(&self.by_vertex[v.index()], ends)
    }

    /// Whether all three stars have a simplex.
    pub(super) fn agree(&self, [a, b, c]: [VertexId; 3]) -> bool {
        self.has(a, [b, c]) && self.has(b, [c, a]) && self.has(c, [a, b])
    }

    /// Counts.
    pub(super) fn figures(&self) -> StarFigures {
        let radius = |v: VertexId, ends| self.circle(v, ends).map(|(_, radius)| radius);
        StarFigures { unsettled: self.unsettled, ..StarFigures::of(&self.by_vertex, radius) }
    }
}

impl StarFigures {
    /// Counts of stars, with the circumradius of a simplex of the star of a vertex.
    pub(super) fn of(stars: &[Star], radius: impl Fn(VertexId, [VertexId; 2]) -> Option<f64>) -> Self {
        let has = |v: VertexId, ends| has(&stars[v.index()], ends);
        let mut figures = Self { vertices: stars.iter().filter(|star| !star.is_empty()).count(), ..Self::default() };
        for v in (0..stars.len() as u32).map(VertexId) {
            for spoke in &stars[v.index()] {
                let [a, b] = spoke.ends;
                let others = [(a, has(a, [b, v])), (b, has(b, [v, a]))];
                // Counted at the first of the vertices that have it.
                if others.iter().all(|&(u, has)| !has || v < u) {
                    figures.simplices += 1;
                    figures.inconsistencies += usize::from(!(others[0].1 && others[1].1));
                }
                figures.radius = radius(v, spoke.ends).map_or(figures.radius, |r| figures.radius.max(r));
            }
        }
        figures
    }
}
