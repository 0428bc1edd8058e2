//! The local Delaunay algorithm as a mesher (RR-9103, section 7.1): stars are refined until they agree, and are then the
//! triangles of a mesh.

use super::agreement::Before;
use super::buckets::Buckets;
use super::relocate::{Quiet, relocate};
use super::star::Spoke;
use super::star_set::{StarFigures, Stars};
use super::steiner::{Placed, Steiner};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Point, Vector};
use crate::metric::MetricField;
use crate::planar::Planar;
use crate::triangulation::{HalfEdge, Triangulation, VertexId};
use std::collections::HashSet;

/// A simplex is cut if its circumradius is more than so many times its shortest edge: rho zero of the authors.
const RATIO: f64 = 3.0;
/// The picking ball's radius, as a share of the circumradius: the authors' delta.
const PICKING: f64 = 0.3;
/// Places tried in it, the circumcentre first: the authors' number.
const TRIES: usize = 60;

/// More inconsistent simplices than this, for each vertex, are not worth cutting: that makes more of them.
const HOPELESS: f64 = 0.1;
/// Rounds in a row that leave no fewer inconsistent simplices than one before are so many at most.
const PATIENCE: usize = 3;
/// What to do where stars do not come to agree.
pub(crate) const NEEDS_MORE: &str =
    "star sets need far more vertices where the metric turns fast: use `mesher=voronoi`";

/// When and how far to refine.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Consistency {
    /// The greatest circumradius of a simplex, in the metric of a vertex.
    pub radius: f64,
    /// Refinement is given up at so many vertices.
    pub most: usize,
}

/// A consistent star set as a triangulation, and what it took.
#[derive(Clone, Debug)]
pub(crate) struct Consistent {
    /// The triangles, with the constraints and regions of the domain. Vertices that it started from keep their ids. Each triangle is
    /// counter-clockwise; that none overlap is for the caller to check.
    pub planar: Planar,
    /// The star set.
    pub figures: StarFigures,
    /// How its refinement went.
    pub counters: PickCounters,
}

/// Vertices by the reason they were put in, and tries. Deterministic.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct PickCounters {
    /// For simplices that were too large.
    pub for_size: u64,
    /// For those whose circumradius was too large beside their shortest edge.
    pub for_shape: u64,
    /// For inconsistent ones, at a place that leaves fewer of them.
    pub picked: u64,
    /// For inconsistent ones, at their circumcentre, for want of such a place.
    pub unpicked: u64,
    /// Vertices that were moved instead.
    pub moved: u64,
    /// Places tried.
    pub tries: u64,
}

/// Moves free vertices of a triangulation and refines its stars until all are small, well shaped and consistent.
///
/// # Errors
/// [`Error::Metric`]; [`Error::Limit`] with a place where stars disagree when there are too many vertices, too many
/// inconsistencies to begin with, or no fewer after some rounds;
/// [`Error::Mesh`] where rounding leaves no room to refine, or the stars agree and are no triangulation.
pub(crate) fn consistent(start: Planar, field: &dyn MetricField, asked: Consistency) -> Result<Consistent> {
    let stars = Stars::new(Steiner::metric(start, field)?);
    let (large, thin, counters) = (Buckets::default(), Buckets::default(), PickCounters::default());
    let mut picker = Picker { stars, asked, large, thin, counters, quiet: Quiet::default(), random: 1 };
    picker.note(&all_vertices(&picker.stars));
    let mut rounds = 0;
    let (mut least, mut idle) = (usize::MAX, 0);
    loop {
        rounds += 1;
        picker.settle()?;
        let inconsistent = picker.inconsistent();
        if inconsistent.is_empty() {
            break;
        }
        idle = if inconsistent.len() < least { 0 } else { idle + 1 };
        least = least.min(inconsistent.len());
        let share = inconsistent.len() as f64 / picker.stars.steiner.planar.topology.vertex_count() as f64;
        if share > HOPELESS || idle == PATIENCE {
            return Err(picker.not_agreed(inconsistent[0].0));
        }
        picker.make_consistent(inconsistent)?;
    }
    let figures = StarFigures { rounds, ..picker.stars.figures() };
    Ok(Consistent { planar: union(&picker.stars)?, figures, counters: picker.counters })
}

fn all_vertices(stars: &Stars) -> Vec<VertexId> {
    stars.steiner.planar.topology.vertices().collect()
}

/// A simplex of the star of its first vertex.
type Simplex = (VertexId, [VertexId; 2]);

struct Picker<'a> {
    stars: Stars<'a>,
    asked: Consistency,
    large: Buckets<Simplex>,
    thin: Buckets<Simplex>,
    counters: PickCounters,
    quiet: Quiet,
    random: u64,
}

impl Picker<'_> {
    /// Queues what is large in some stars, by how large it is, or thin, by how thin.
    fn note(&mut self, dirty: &[VertexId]) {
        for &v in dirty {
            for &Spoke { ends, .. } in &self.stars.by_vertex[v.index()] {
                let Some((_, radius)) = self.stars.circle(v, ends) else { continue };
                let tensor = self.stars.steiner.tensors[v.index()];
                let [p, q, r] = [v, ends[0], ends[1]].map(|u| self.stars.steiner.planar.position(u));
                let shortest = tensor.length(q - p).min(tensor.length(r - q)).min(tensor.length(p - r));
                if radius > self.asked.radius {
                    self.large.push(radius, (v, ends));
                } else if radius > RATIO * shortest {
                    self.thin.push(radius / shortest, (v, ends));
                }
            }
        }
    }

    /// Cuts large simplices, then thin ones, until there are none; returns how many.
    fn cut_bad(&mut self) -> Result<u64> {
        let mut cut = 0;
        loop {
            let large = self.large.pop();
            let Some((v, ends)) = large.or_else(|| self.thin.pop()) else { return Ok(cut) };
            let Some((centre, radius)) = self.circle((v, ends)) else { continue };
            let placed = self.stars.place(v, centre, radius)?;
            if let Placed::Inserted(new) | Placed::Halved(new) = placed {
                cut += 1;
                *(if large.is_some() { &mut self.counters.for_size } else { &mut self.counters.for_shape }) += 1;
                self.keep(new);
                self.demand_room(v)?;
            }
            if matches!(placed, Placed::Halved(_)) {
                self.note(&[v]);
            }
        }
    }

    /// Moves vertices, and cuts what is large or thin.
    fn settle(&mut self) -> Result<()> {
        self.cut_bad()?;
        self.counters.moved += relocate(&mut self.stars.steiner, self.asked.radius, &mut self.quiet)?;
        loop {
            // What mending may have missed is found here.
            self.stars.update_all();
            self.note(&all_vertices(&self.stars));
            if self.cut_bad()? == 0 {
                return Ok(());
            }
        }
    }

    /// The circle of a simplex that its star still has.
    fn circle(&self, (v, ends): Simplex) -> Option<(Point, f64)> {
        self.stars.circle(v, ends).filter(|_| self.stars.has(v, ends))
    }

    fn demand_room(&self, v: VertexId) -> Result<()> {
        if self.stars.steiner.planar.topology.vertex_count() <= self.asked.most {
            return Ok(());
        }
        Err(self.not_agreed(v))
    }

    fn not_agreed(&self, v: VertexId) -> Error {
        let count = self.stars.steiner.planar.topology.vertex_count();
        let place = self.stars.steiner.planar.position(v);
        let what = format!("the stars do not agree with {count} vertices, for example at {place}");
        Error::limit(what, NEEDS_MORE)
    }

    /// All simplices that not all of their vertices' stars have.
    fn inconsistent(&self) -> Vec<Simplex> {
        let mut found = Vec::new();
        for v in all_vertices(&self.stars) {
            let spokes = self.stars.by_vertex[v.index()].iter().map(|spoke| (v, spoke.ends));
            found.extend(spokes.filter(|&simplex| self.is_inconsistent(simplex)));
        }
        found
    }

    /// Whether a star has a simplex, and another has not.
    fn is_inconsistent(&self, (v, ends): Simplex) -> bool {
        self.stars.has(v, ends) && !self.stars.agree([v, ends[0], ends[1]])
    }

    /// Cuts inconsistent simplices, the largest first, of those near each other one.
    fn make_consistent(&mut self, mut inconsistent: Vec<Simplex>) -> Result<()> {
        let radius = |s: &Simplex| self.stars.circle(s.0, s.1).map_or(0.0, |(_, radius)| radius);
        inconsistent.sort_by(|s, t| radius(t).total_cmp(&radius(s)).then(s.cmp(t)));
        let mut touched: HashSet<VertexId> = HashSet::new();
        for &(v, ends) in &inconsistent {
            if [v, ends[0], ends[1]].iter().any(|u| touched.contains(u)) || !self.is_inconsistent((v, ends)) {
                continue;
            }
            if let Some(new) = self.pick(v, ends)? {
                touched.extend([v, ends[0], ends[1]]);
                touched.extend(self.stars.by_vertex[new.index()].iter().flat_map(|spoke| spoke.ends));
                self.demand_room(v)?;
                self.cut_bad()?;
            }
        }
        if touched.is_empty() {
            let place = self.stars.steiner.planar.position(inconsistent[0].0).to_string();
            return Err(not_meshed("stars disagree where rounding leaves no room to refine them", place));
        }
        Ok(())
    }

    /// Puts a vertex near the centre of an inconsistent simplex, where that leaves the fewest inconsistent ones.
    fn pick(&mut self, v: VertexId, ends: [VertexId; 2]) -> Result<Option<VertexId>> {
        let Some((centre, radius)) = self.stars.circle(v, ends) else { return Ok(None) };
        let mut best: Option<(isize, Point)> = None;
        for attempt in 0..TRIES {
            self.counters.tries += 1;
            let place = if attempt == 0 { centre } else { centre + self.in_ball(v, radius) };
            match self.stars.place(v, place, radius)? {
                Placed::Refused => {}
                Placed::Halved(new) => {
                    self.counters.picked += 1;
                    return Ok(Some(self.keep(new)));
                }
                Placed::Inserted(new) => {
                    let (left, change) = self.tried(new);
                    if left == 0 {
                        self.counters.picked += 1;
                        return Ok(Some(new));
                    }
                    if best.is_none_or(|(least, _)| change < least) {
                        best = Some((change, place));
                    }
                }
            }
        }
        let place = best.map_or(centre, |(_, place)| place);
        let gain = best.is_some_and(|(change, _)| change < 0);
        if let Placed::Inserted(new) | Placed::Halved(new) = self.stars.place(v, place, radius)? {
            *(if gain { &mut self.counters.picked } else { &mut self.counters.unpicked }) += 1;
            return Ok(Some(self.keep(new)));
        }
        Ok(None)
    }

    /// A vector to somewhere in the picking ball.
    fn in_ball(&mut self, v: VertexId, radius: f64) -> Vector {
        let [a, b, c] = self.stars.steiner.tensors[v.index()].cholesky();
        let (x, y) = self.in_disk();
        Vector::new((x - b * y / c) / a, y / c) * (PICKING * radius)
    }

    fn keep(&mut self, new: VertexId) -> VertexId {
        let dirty = self.stars.mend(&[new]);
        self.changed(&dirty);
        new
    }

    fn changed(&mut self, dirty: &[VertexId]) {
        self.quiet.wake(dirty.iter().copied());
        self.note(dirty);
    }

    /// Says how many inconsistent simplices a new vertex leaves around it, and how many more than there were. Unless it leaves
    /// none it is taken out again.
    fn tried(&mut self, new: VertexId) -> (usize, isize) {
        self.stars.make_room();
        let dirty = self.stars.changed_by(new);
        let before = Before::of(&self.stars, dirty.iter().copied());
        self.stars.mend(&[new]);
        let [had, left] = before.disagreements(&self.stars);
        if left == 0 || !self.stars.steiner.take_out(new) {
            self.changed(&dirty);
            return (0, 0);
        }
        before.restore(&mut self.stars);
        self.stars.by_vertex[new.index()].clear();
        (left, left.cast_signed() - had.cast_signed())
    }

    /// A point of the unit disk, evenly distributed.
    fn in_disk(&mut self) -> (f64, f64) {
        let mut next = || {
            self.random = self.random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.random >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (radius, (sine, cosine)) = (next().sqrt(), (std::f64::consts::TAU * next()).sine_and_cosine());
        (radius * cosine, radius * sine)
    }
}

/// The triangles of consistent stars as one triangulation.
fn union(stars: &Stars) -> Result<Planar> {
    let embedded = &stars.steiner.planar;
    let (mut triangles, mut regions) = (Vec::new(), Vec::new());
    let mut sides: HashSet<[u32; 2]> = HashSet::new();
    for v in all_vertices(stars) {
        for spoke in stars.by_vertex[v.index()].iter().filter(|s| v < s.ends[0] && v < s.ends[1]) {
            let [a, b] = spoke.ends;
            triangles.push([v.0, a.0, b.0]);
            regions.push(spoke.region);
            if ![[v, a], [a, b], [b, v]].iter().all(|side| sides.insert(side.map(|u| u.0))) {
                let place = embedded.position(v).to_string();
                return Err(not_meshed("stars agree on triangles that overlap", place));
            }
        }
    }
    let mut topology = Triangulation::from_triangles(embedded.positions.len(), &triangles, &regions);
    for h in embedded.topology.edges() {
        let Some(constraint) = embedded.topology.constraint(h) else { continue };
        let [a, b] = embedded.topology.ends(h);
        let found: Option<HalfEdge> = topology.edge_between(a, b);
        let missing = || not_meshed("no star has an edge of the domain", embedded.position(a).to_string());
        topology.set_constraint(found.ok_or_else(missing)?, constraint);
    }
    Ok(Planar { topology, positions: embedded.positions.clone() })
}

fn not_meshed(what: &str, place: String) -> Error {
    Error::mesh(what, place, "use `mesher=voronoi`, which never depends on stars that agree")
}

/// A circumradius that simplices of a relaxed unit mesh keep below: the mean is 0.6.
pub(crate) const UNIT_RADIUS: f64 = 1.0;
