//! The local Delaunay algorithm as a mesher (RR-9103, section 7.1): stars are refined until they agree, and are then the
//! triangles of a mesh.

use super::buckets::Buckets;
use super::star::Star;
use super::star_set::{StarFigures, Stars};
use super::steiner::{Placed, Steiner};
use crate::domain::Domain;
use crate::error::{Error, Result};
use crate::geometry::{Point, Vector};
use crate::metric::MetricField;
use crate::planar::Planar;
use crate::triangulation::{HalfEdge, Triangulation, VertexId};
use std::collections::{HashMap, HashSet};

/// A simplex is cut if its circumradius is more than so many times its shortest edge: rho zero of the authors.
const RATIO: f64 = 3.0;
/// A new inconsistent simplex is tolerated if its circumradius is so many times that of the simplex cut: the authors' beta.
const BETA: f64 = 2.5;
/// The picking ball's radius, as a share of the circumradius: the authors' delta.
const PICKING: f64 = 0.3;
/// Places tried in it, the circumcentre first: the authors' number.
const TRIES: usize = 60;

/// When and how far to refine.
#[derive(Clone, Copy, Debug)]
pub struct Consistency {
    /// The greatest circumradius of a simplex, in the metric of a vertex.
    pub radius: f64,
    /// Refinement is given up at so many vertices.
    pub most: usize,
}

/// A consistent star set as a triangulation, and what it took.
#[derive(Clone, Debug)]
pub struct Consistent {
    /// The triangles, with the constraints and regions of the domain. Vertices of the domain keep their ids. Each triangle is
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
    /// For inconsistent ones, at a place that makes no new small inconsistency.
    pub picked: u64,
    /// For inconsistent ones, at their circumcentre, for want of such a place.
    pub unpicked: u64,
    /// Places tried.
    pub tries: u64,
}

/// Refines the stars of a domain's corners until all are small, well shaped and consistent.
///
/// # Errors
/// [`Error::Metric`]; [`Error::Limit`] with a place where stars disagree when there are too many vertices;
/// [`Error::Mesh`] where rounding leaves no room to refine, or the stars agree and are no triangulation.
pub fn consistent(domain: &Domain, field: &dyn MetricField, asked: Consistency) -> Result<Consistent> {
    let stars = Stars::new(Steiner::metric(domain.planar().clone(), field)?);
    let (large, thin, counters) = (Buckets::default(), Buckets::default(), PickCounters::default());
    let mut picker = Picker { stars, asked, large, thin, counters, random: 1 };
    let all: Vec<VertexId> = picker.stars.steiner.planar.topology.vertices().collect();
    picker.note(&all);
    let mut rounds = 0;
    loop {
        picker.cut_bad()?;
        rounds += 1;
        // What mending may have missed is found here.
        picker.stars.update_all();
        picker.note(&all_vertices(&picker.stars));
        if picker.cut_bad()? > 0 {
            continue;
        }
        let inconsistent = picker.inconsistent();
        if inconsistent.is_empty() {
            break;
        }
        picker.make_consistent(&inconsistent)?;
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
    random: u64,
}

impl Picker<'_> {
    /// Queues what is large or thin in some stars.
    fn note(&mut self, dirty: &[VertexId]) {
        for &v in dirty {
            for spoke in &self.stars.by_vertex[v.index()] {
                let Some((_, radius)) = self.stars.circle(v, spoke.ends) else { continue };
                let tensor = self.stars.steiner.tensors[v.index()];
                let [p, q, r] = [v, spoke.ends[0], spoke.ends[1]].map(|u| self.stars.steiner.planar.position(u));
                let shortest = tensor.length(q - p).min(tensor.length(r - q)).min(tensor.length(p - r));
                if radius > self.asked.radius {
                    self.large.push(radius, (v, spoke.ends));
                } else if radius > RATIO * shortest {
                    self.thin.push(radius / shortest, (v, spoke.ends));
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
                let dirty = self.stars.mend(&[new]);
                self.note(&dirty);
                self.demand_room(v)?;
            }
            if matches!(placed, Placed::Halved(_)) {
                self.note(&[v]);
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
        let (most, place) = (self.asked.most, self.stars.steiner.planar.position(v));
        let what = format!("the stars do not agree with {most} vertices, for example at {place}");
        let help = "star sets need far more vertices where the metric turns fast: use --mesher voronoi".into();
        Err(Error::Limit { what, help })
    }

    /// All simplices that not all of their vertices' stars have.
    fn inconsistent(&self) -> Vec<Simplex> {
        let mut found = Vec::new();
        for v in all_vertices(&self.stars) {
            let spokes = self.stars.by_vertex[v.index()].iter().map(|spoke| spoke.ends);
            found.extend(spokes.filter(|&[a, b]| !self.stars.agree([v, a, b])).map(|ends| (v, ends)));
        }
        found
    }

    /// Cuts inconsistent simplices that are still there when it is their turn.
    fn make_consistent(&mut self, inconsistent: &[Simplex]) -> Result<()> {
        let mut is_idle = true;
        for &(v, ends) in inconsistent {
            if self.circle((v, ends)).is_some() && !self.stars.agree([v, ends[0], ends[1]]) && self.pick(v, ends)? {
                is_idle = false;
                self.demand_room(v)?;
                self.cut_bad()?;
            }
        }
        if is_idle {
            let place = self.stars.steiner.planar.position(inconsistent[0].0).to_string();
            return Err(not_meshed("stars disagree where rounding leaves no room to refine them", place));
        }
        Ok(())
    }

    /// Puts a vertex near the centre of an inconsistent simplex, where that makes no new inconsistency that is small; else
    /// at its centre (`pick_valid`). Says whether there is a new vertex.
    fn pick(&mut self, v: VertexId, ends: [VertexId; 2]) -> Result<bool> {
        let Some((centre, radius)) = self.stars.circle(v, ends) else { return Ok(false) };
        let [a, b, c] = self.stars.steiner.tensors[v.index()].cholesky();
        for attempt in 0..TRIES {
            self.counters.tries += 1;
            let (x, y) = if attempt == 0 { (0.0, 0.0) } else { self.in_disk() };
            let away = Vector::new((x - b * y / c) / a, y / c) * (PICKING * radius);
            match self.stars.place(v, centre + away, radius)? {
                Placed::Refused => {}
                Placed::Halved(new) => {
                    self.counters.picked += 1;
                    return Ok(self.keep(new));
                }
                Placed::Inserted(new) => {
                    if self.is_kept(new, BETA * radius) {
                        self.counters.picked += 1;
                        return Ok(true);
                    }
                }
            }
        }
        if let Placed::Inserted(new) | Placed::Halved(new) = self.stars.place(v, centre, radius)? {
            self.counters.unpicked += 1;
            return Ok(self.keep(new));
        }
        Ok(false)
    }

    fn keep(&mut self, new: VertexId) -> bool {
        let dirty = self.stars.mend(&[new]);
        self.note(&dirty);
        true
    }

    /// Keeps a vertex if the inconsistent simplices that it makes are all larger than a circumradius; else takes it out.
    fn is_kept(&mut self, new: VertexId, least: f64) -> bool {
        self.stars.make_room();
        let dirty = self.stars.changed_by(new);
        let before: HashMap<VertexId, Star> =
            dirty.iter().map(|&w| (w, self.stars.by_vertex[w.index()].clone())).collect();
        self.stars.mend(&[new]);
        if !self.makes_small(&before, least) || !self.stars.steiner.take_out(new) {
            self.note(&dirty);
            return true;
        }
        for (w, star) in before {
            self.stars.by_vertex[w.index()] = star;
        }
        self.stars.by_vertex[new.index()].clear();
        false
    }

    /// Whether stars disagree now, and did not before, on a simplex with a circumradius below `least`.
    fn makes_small(&self, before: &HashMap<VertexId, Star>, least: f64) -> bool {
        let had = |v: VertexId, ends: [VertexId; 2]| {
            before.get(&v).map_or_else(|| self.stars.has(v, ends), |star| star.iter().any(|spoke| spoke.ends == ends))
        };
        let turns = |v: VertexId, [a, b]: [VertexId; 2]| [(v, [a, b]), (a, [b, v]), (b, [v, a])];
        let is_new = |v: VertexId, ends: [VertexId; 2]| {
            let held = turns(v, ends).iter().filter(|&&(u, others)| had(u, others)).count();
            let holders = turns(v, ends).into_iter().filter(|&(u, others)| self.stars.has(u, others));
            let holders: Vec<Simplex> = holders.collect();
            let is_small = |&(u, others): &Simplex| self.stars.circle(u, others).is_some_and(|(_, r)| r < least);
            (held == 0 || held == 3) && holders.len() < 3 && holders.iter().any(is_small)
        };
        let now = before.keys().flat_map(|&w| self.stars.by_vertex[w.index()].iter().map(move |spoke| (w, spoke.ends)));
        let then = before.iter().flat_map(|(&w, star)| star.iter().map(move |spoke| (w, spoke.ends)));
        now.chain(then).any(|(w, ends)| is_new(w, ends))
    }

    /// A point of the unit disk, evenly distributed.
    fn in_disk(&mut self) -> (f64, f64) {
        let mut next = || {
            self.random = self.random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.random >> 11) as f64 / (1_u64 << 53) as f64
        };
        let (radius, (sine, cosine)) = (next().sqrt(), (std::f64::consts::TAU * next()).sin_cos());
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
        let [a, b] = [embedded.topology.origin(h), embedded.topology.target(h)];
        let found: Option<HalfEdge> = topology.find(a, b).or_else(|| topology.find(b, a));
        let missing = || not_meshed("no star has an edge of the domain", embedded.position(a).to_string());
        topology.set_constraint(found.ok_or_else(missing)?, constraint);
    }
    Ok(Planar { topology, positions: embedded.positions.clone() })
}

fn not_meshed(what: &str, place: String) -> Error {
    Error::Mesh {
        what: what.into(),
        place,
        help: "use --mesher voronoi, which never depends on stars that agree".into(),
    }
}

/// The radius for which simplices are unit on the average: the mean circumradius of refinement is about this share of
/// what it refines to.
pub const UNIT_RADIUS: f64 = 0.8;
