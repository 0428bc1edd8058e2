//! The worst triangles mended: their corners move to where the least quality of the triangles around them is greatest. And seeds moved to where more of
//! their edges are of unit length.

use crate::dual::{Kind, Moving, sites};
use crate::elementary::Elementary;
use crate::geodesic::is_unit;
use crate::geometry::{NEEDLE, Vector, from_frame};
use crate::lists::{distinct, least_ranked, marked, ranked};
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};
use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// Lengths of the moves that are tried (metric length), and directions of each.
const LENGTHS: [f64; 4] = [0.2, 0.1, 0.05, SHORTEST];
const SHORTEST: f64 = 0.02;
const WAYS: usize = 12;
/// A move must raise the least quality by this at least.
const GAIN: f64 = 1e-3;
/// Edges whose metric length has a logarithm of at most this size are well within the unit range.
const UNIT: f64 = 0.3;
/// Below this quality edges around may all be as far from unit length as one is, and lengths do not count beside an edge that must stay whole and is too
/// long: every way off it may make others worse.
const POOR: f64 = 2.0 * NEEDLE;
/// So much the mean quality around a seed may fall where more of its edges are of unit length then. With 0 the share of these rises by three tenths less (a hard
/// shock of 4,000 vertices, 45 %: 51 % for 54 %), with 0.02 mean quality falls by a hundredth where the metric is not resolved.
const LOSS: f64 = 5e-3;
/// Moves of one seed.
const MOVES: usize = 6;
/// So many seeds are looked at together, on all cores, before the first of them moves.
const TOGETHER: usize = 256;

/// Moves corners of poor triangles, each to where the least quality of the triangles around it is greatest, by trial; quality as it is
/// measured of a mesh, in the log-Euclidean mean of the tensors at the corners.
///
/// Relaxation equalises cells, of which a triangle beside the tip of a cape knows little. The energy may rise a little. From one call to the
/// next the metric's factor stays, and seeds where they are; edges may be flipped.
pub(crate) struct Mending<M: Moving> {
    /// Of seeds that no trial was better for: where they and their neighbours were.
    in_vain: BTreeMap<(VertexId, Purpose), Ring<M::Site>>,
    /// The seeds' sites, by id, ready.
    sites: Vec<M::Site>,
    /// Seeds that have moved since.
    moved: Vec<VertexId>,
    /// By slot of a face, its corners when it was measured last, and its quality.
    faces: Vec<([VertexId; 3], f64)>,
}

/// What a seed moves for.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Purpose {
    /// The least quality around it, where no edge leaves the unit range.
    Quality,
    /// The same, and where a triangle is a needle whatever edges become.
    Needles,
    /// Unit edges, where triangles are hardly worse.
    Lengths,
}

impl<M: Moving> Default for Mending<M> {
    fn default() -> Self {
        Self { in_vain: BTreeMap::new(), sites: Vec::new(), moved: Vec::new(), faces: Vec::new() }
    }
}

impl<M: Moving> Mending<M> {
    /// Moves the free corners of the poorest triangles, at most so many. Returns how many seeds moved.
    pub(crate) fn worst(&mut self, dual: &mut M, most: usize) -> usize {
        let poorest = least_ranked(self.below(dual, f64::INFINITY), most);
        self.corners(dual, poorest, Purpose::Quality)
    }

    /// The same of all triangles that are needles, or nearly, whatever lengths become: what the mesh is measured by asks for the metric at the closest
    /// places, and may find less.
    pub(crate) fn needles(&mut self, dual: &mut M) -> usize {
        let poor = ranked(self.below(dual, POOR));
        self.corners(dual, poor, Purpose::Needles)
    }

    /// Moves free ends of edges that are not of unit length, each once. Returns how many moved.
    pub(crate) fn lengths(&mut self, dual: &mut M) -> usize {
        self.measure(dual);
        let topology = dual.topology();
        let edges = topology.edges_with(|_| true);
        let is_off = |&&h: &&HalfEdge| {
            let [u, v] = topology.ends(h);
            !is_unit(dual.chord(u, [u, v].map(|v| self.sites[v.index()])))
        };
        let off: Vec<HalfEdge> = edges.par_iter().with_min_len(256).filter(is_off).copied().collect();
        let ends = off.into_iter().flat_map(|h| topology.ends(h)).collect();
        self.move_each(dual, ends, Purpose::Lengths)
    }

    /// The edges of needles.
    pub(crate) fn edges_of_needles(&mut self, dual: &M) -> Vec<HalfEdge> {
        self.measure(dual);
        let needles = (0..)
            .map(FaceId)
            .zip(&self.faces)
            .filter(|(f, (_, quality))| dual.topology().is_face(*f) && *quality < NEEDLE);
        distinct(needles.flat_map(|(f, _)| f.half_edges()).map(|h| dual.topology().canonical(h)))
    }

    /// The triangles of less quality, with that.
    fn below(&mut self, dual: &M, limit: f64) -> Vec<(f64, [VertexId; 3])> {
        self.measure(dual);
        let faces = (0..self.faces.len()).into_par_iter().with_min_len(1024);
        let here = faces.filter(|&f| dual.topology().is_face(FaceId(f as u32))).map(|f| self.faces[f]);
        here.filter(|(_, quality)| *quality < limit).map(|(corners, quality)| (quality, corners)).collect()
    }

    /// Measures triangles that have changed since the last time.
    fn measure(&mut self, dual: &M) {
        let topology = dual.topology();
        let moved = marked(topology.vertex_slots(), self.moved.iter().map(|v| v.0));
        if self.sites.is_empty() {
            self.sites = sites(dual).into_par_iter().with_min_len(64).map(|site| dual.ready(site)).collect();
        }
        self.moved.clear();
        self.faces.resize(topology.face_slots(), ([VertexId(u32::MAX); 3], f64::NAN));
        let sites = &self.sites;
        self.faces.par_iter_mut().enumerate().with_min_len(256).for_each(|(f, (known, quality))| {
            let f = FaceId(f as u32);
            if topology.is_face(f) {
                let corners = topology.corners(f);
                if *known != corners || corners.iter().any(|v| moved[v.index()]) {
                    (*known, *quality) = (corners, dual.quality(corners.map(|v| sites[v.index()])));
                }
            }
        });
    }

    fn corners(&mut self, dual: &mut M, triangles: Vec<(f64, [VertexId; 3])>, purpose: Purpose) -> usize {
        self.move_each(dual, triangles.into_iter().flat_map(|(_, corners)| corners).collect(), purpose)
    }

    /// Moves the free ones of some seeds, each once. Returns how many moved.
    ///
    /// Many that are no neighbours are looked at before the first one moves; those whose triangles were flipped by their turn are looked at again.
    fn move_each(&mut self, dual: &mut M, seeds: Vec<VertexId>, purpose: Purpose) -> usize {
        let mut is_new = vec![true; dual.topology().vertex_slots()];
        let free = seeds.into_iter().filter(|&v| dual.kind(v) == Kind::Free && std::mem::take(&mut is_new[v.index()]));
        let mut queue: VecDeque<VertexId> = free.collect();
        let mut count = 0;
        while !queue.is_empty() {
            let together = apart(dual.topology(), &mut queue);
            let views = together.par_iter().map(|&v| self.view(dual, v, purpose));
            let views: Vec<View<M::Site>> = views.collect();
            for (v, view) in together.into_iter().zip(views) {
                if !view.is_of(dual, v) {
                    queue.push_front(v);
                } else if let Some(&by) = view.better.iter().find(|&&by| dual.shift_by(v, by)) {
                    dual.settle_move(v);
                    self.note(dual, v);
                    let is_worth = view.is_worth(dual, v, purpose, &self.sites);
                    if !is_worth && went_back(dual, v, by) {
                        self.note(dual, v);
                    } else {
                        count += 1;
                    }
                } else if purpose != Purpose::Lengths {
                    self.in_vain.insert((v, purpose), view.ring);
                }
            }
        }
        count
    }

    /// Notes where a seed has moved to.
    fn note(&mut self, dual: &M, v: VertexId) {
        self.moved.push(v);
        self.sites[v.index()] = dual.ready(dual.site(v));
    }

    /// What is around a seed, and where it would be better.
    fn view(&self, dual: &M, v: VertexId, purpose: Purpose) -> View<M::Site> {
        let ring = Ring::of(dual, v, &self.sites);
        let better = match purpose {
            _ if self.in_vain.get(&(v, purpose)) == Some(&ring) => Vec::new(),
            Purpose::Lengths => ring.fitter(dual, v),
            _ => ring.climbed(dual, v, ring.limits(dual, v, purpose)),
        };
        View { links: links(dual, v).collect(), ring, better }
    }
}

/// What is around a seed.
struct View<S> {
    /// The triangles by their other corners.
    links: Vec<[VertexId; 2]>,
    ring: Ring<S>,
    /// Moves by which the least quality there is greater, the best first.
    better: Vec<Vector>,
}

impl<S: Copy + PartialEq + Send + Sync> View<S> {
    /// Whether the triangles around the seed are those that were seen.
    fn is_of<M: Moving<Site = S>>(&self, dual: &M, v: VertexId) -> bool {
        links(dual, v).eq(self.links.iter().copied())
    }

    /// Whether a seed that has moved is better off: edges may have been flipped.
    fn is_worth<M: Moving<Site = S>>(&self, dual: &M, v: VertexId, purpose: Purpose, sites: &[S]) -> bool {
        let fit = |ring: &Ring<S>| ring.fit(dual, v, ring.centre, None);
        let is_better = |(now, was): (Fit, Fit)| match purpose {
            Purpose::Lengths => now.is_worth(&was),
            _ => now.least > was.least,
        };
        self.is_of(dual, v) || fit(&Ring::of(dual, v, sites)).zip(fit(&self.ring)).is_some_and(is_better)
    }
}

/// How fit the triangles around a seed are.
#[derive(Clone, Copy, Debug)]
struct Fit {
    /// The share of its edges that are not of unit length.
    astray: f64,
    /// In the mean.
    quality: f64,
    least: f64,
}

impl Fit {
    /// Whether it is worth a move: more unit edges, and triangles that are hardly worse in the mean, none poorer than the poorest was.
    fn is_worth(&self, was: &Self) -> bool {
        self.astray < was.astray && self.quality >= was.quality - LOSS && self.least >= was.least
    }
}

/// How far edges may leave the unit range for the sake of quality, those that get farther out.
#[derive(Clone, Copy)]
struct Limits {
    /// The greatest size of the logarithm of a length, around needles or nearly; elsewhere none may.
    misfit: f64,
    /// Where the least quality is below this, lengths do not count.
    quality: f64,
}

/// A seed's place, and the triangles around it by their other corners.
#[derive(PartialEq)]
struct Ring<S> {
    centre: S,
    links: Vec<[S; 2]>,
}

impl<S: Copy + PartialEq + Send + Sync> Ring<S> {
    fn of<M: Moving<Site = S>>(dual: &M, v: VertexId, sites: &[S]) -> Self {
        let site = |v: VertexId| sites[v.index()];
        Self { centre: site(v), links: links(dual, v).map(|link| link.map(site)).collect() }
    }

    /// No edge may leave the unit range, or get farther out, unless needles come first, or the quality is poor beside an edge that must stay whole
    /// and is too long; where it is poor elsewhere, none may be farther out than one is.
    fn limits<M: Moving<Site = S>>(&self, dual: &M, v: VertexId, purpose: Purpose) -> Limits {
        let topology = dual.topology();
        let is_long = |h: HalfEdge| {
            let ends = topology.ends(h).map(|u| dual.site(u));
            topology.is_fixed(h) && dual.straight_length(ends).logarithm() > UNIT
        };
        let is_beside = topology.star(v).any(|h| is_long(h.next()));
        let misfits = self.links.iter().map(|&[u, _]| misfit(dual, [self.centre, u]));
        let quality = match purpose {
            _ if is_beside => POOR,
            Purpose::Needles => NEEDLE,
            _ => f64::NEG_INFINITY,
        };
        Limits { misfit: misfits.fold(UNIT, f64::max), quality }
    }

    /// How fit the triangles would be if the seed at the centre were there, unless that is not worth a move.
    fn fit<M: Moving<Site = S>>(&self, dual: &M, v: VertexId, site: S, was: Option<&Fit>) -> Option<Fit> {
        let count = self.links.len() as f64;
        let floor = was.map_or(f64::NEG_INFINITY, |was| was.least);
        let mut qualities = self.links.iter().map(|&[a, b]| dual.quality([site, a, b]));
        let (least, sum) = qualities.try_fold((f64::INFINITY, 0.0), |(least, sum), quality| {
            (quality >= floor).then_some((quality.min(least), sum + quality))
        })?;
        let mut fit = Fit { astray: 0.0, quality: sum / count, least };
        let is_worth = |fit: &Fit| was.is_none_or(|was| fit.is_worth(was));
        let (mut astray, mut ready) = (0.0, None);
        for &[u, _] in &self.links {
            if !is_worth(&fit) {
                return None;
            }
            let site = *ready.get_or_insert_with(|| dual.ready(site));
            astray += f64::from(u8::from(!is_unit(dual.chord(v, [site, u]))));
            fit.astray = astray / count;
        }
        is_worth(&fit).then_some(fit)
    }

    /// Moves of the seed at the centre after which more of its edges are of unit length, the best first.
    fn fitter<M: Moving<Site = S>>(&self, dual: &M, v: VertexId) -> Vec<Vector> {
        let Some(now) = self.fit(dual, v, self.centre, None).filter(|now| now.astray > 0.0) else { return Vec::new() };
        let ways = ways(dual.local(v).tensor.cholesky());
        let tried: Vec<Vector> = LENGTHS.iter().flat_map(|&length| ways.iter().map(move |&by| by * length)).collect();
        let fit = |&by: &Vector| self.fit(dual, v, dual.site_after(v, by)?, Some(&now));
        let fits: Vec<Option<Fit>> = tried.par_iter().with_min_len(WAYS / 2).map(fit).collect();
        let mut better: Vec<(Vector, Fit)> =
            tried.into_iter().zip(fits).filter_map(|(by, fit)| Some((by, fit?))).collect();
        better.sort_by(|(_, a), (_, b)| a.astray.total_cmp(&b.astray).then(b.quality.total_cmp(&a.quality)));
        better.into_iter().map(|(by, _)| by).collect()
    }

    /// Moves of the seed at the centre by which the least quality is greater, the best first: where one trial after the other leads to, then what
    /// the first trials find.
    fn climbed<M: Moving<Site = S>>(&self, dual: &M, v: VertexId, limits: Limits) -> Vec<Vector> {
        let mut better = self.better(dual, v, self.centre, Vector::default(), limits);
        for _ in 1..MOVES {
            let further = better.first().and_then(|&by| Some((by, dual.site_after(v, by)?)));
            let further = further.and_then(|(by, here)| self.better(dual, v, here, by, limits).first().copied());
            let Some(by) = further else { break };
            better.insert(0, by);
        }
        better
    }

    /// Moves of the seed at the centre by which the least quality is greater than after it has moved already, the best first.
    fn better<M: Moving<Site = S>>(
        &self,
        dual: &M,
        v: VertexId,
        here: S,
        moved: Vector,
        limits: Limits,
    ) -> Vec<Vector> {
        // The poorest triangle first: it tells of most trials that they are no better.
        let by_quality = ranked(self.links.iter().zip(0..).map(|(&[a, b], i)| (dual.quality([here, a, b]), i)));
        let now = by_quality.first().map_or(f64::NEG_INFINITY, |&(quality, _)| quality);
        let links: Vec<[S; 2]> = by_quality.into_iter().map(|(_, i): (f64, usize)| self.links[i]).collect();
        // The least quality around, where that is at least so much.
        let least = |site: S, floor: f64| {
            links.iter().map(|&[a, b]| dual.quality([site, a, b])).try_fold(f64::INFINITY, |least, quality| {
                let least = least.min(quality);
                (least >= floor).then_some(least)
            })
        };
        // Where the metric is even, quality is nowhere less on the way to a place where it is greater: triangles of at least some quality have their
        // corners in convex sets.
        let rises = |by: &Vector| {
            now < 0.0 || dual.site_after(v, moved + *by * SHORTEST).is_some_and(|at| least(at, now).is_some())
        };
        let ways = ways(dual.local(v).tensor.cholesky());
        let rising: Vec<Vector> = ways.into_par_iter().with_min_len(WAYS / 4).filter(rises).collect();
        let tried: Vec<Vector> =
            LENGTHS.iter().flat_map(|&length| rising.iter().map(move |&by| moved + by * length)).collect();
        let most = match now {
            _ if now < limits.quality => f64::INFINITY,
            _ if now < POOR => limits.misfit,
            _ => UNIT,
        };
        let gained = |&by: &Vector| {
            let site = dual.site_after(v, by)?;
            let quality = least(site, now + GAIN)?;
            let site = dual.ready(site);
            let is_fit = |&[u, _]: &[S; 2]| {
                let misfit = misfit(dual, [site, u]);
                misfit <= most || misfit <= self::misfit(dual, [self.centre, u])
            };
            links.iter().all(is_fit).then_some(quality)
        };
        let gains: Vec<Option<f64>> = tried.par_iter().with_min_len(WAYS / 2).map(gained).collect();
        let better = ranked(gains.into_iter().enumerate().filter_map(|(i, gain)| Some((-gain?, i))));
        better.into_iter().map(|(_, i)| tried[i]).collect()
    }
}

/// Takes seeds from the front of a queue of which no two are neighbours; those passed over stay in front.
fn apart(topology: &Triangulation, queue: &mut VecDeque<VertexId>) -> Vec<VertexId> {
    let (mut taken, mut passed, mut beside) = (Vec::new(), Vec::new(), BTreeSet::new());
    while taken.len().max(passed.len()) < TOGETHER
        && let Some(v) = queue.pop_front()
    {
        if beside.contains(&v) {
            passed.push(v);
        } else {
            beside.extend(topology.star(v).map(|h| topology.target(h)));
            taken.push(v);
        }
    }
    passed.into_iter().rev().for_each(|v| queue.push_front(v));
    taken
}

/// Moves a seed back; says whether it did.
fn went_back<M: Moving>(dual: &mut M, v: VertexId, by: Vector) -> bool {
    let is_back = dual.shift_by(v, -by);
    if is_back {
        dual.settle_move(v);
    }
    is_back
}

/// The triangles around a seed by their other corners.
fn links<M: Moving>(dual: &M, v: VertexId) -> impl Iterator<Item = [VertexId; 2]> {
    let topology = dual.topology();
    topology.star(v).map(|h| [topology.target(h), topology.apex(h)])
}

/// The size of the logarithm of an edge's length.
fn misfit<M: Moving>(dual: &M, ends: [M::Site; 2]) -> f64 {
    dual.straight_length(ends).logarithm().abs()
}

/// Unit vectors all around.
fn ways(frame: [f64; 3]) -> Vec<Vector> {
    // In turns of thirty degrees.
    const LONG: f64 = 0.866_025_403_784_438_6;
    let half = [[1.0, 0.0], [LONG, 0.5], [0.5, LONG], [0.0, 1.0], [-0.5, LONG], [-LONG, 0.5]];
    let half: [Vector; WAYS / 2] = half.map(|[x, y]| from_frame(frame, Vector::new(x, y)));
    half.into_iter().chain(half.map(|way| -way)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::springs::tests::seeded;
    use super::*;
    use crate::dual::Dual;
    use crate::geometry::{Point, Tensor};
    use crate::manifold::domain::Domain;
    use crate::metric::{MetricField, Shock};

    /// Of all edges and triangles.
    fn fit(dual: &Dual) -> Fit {
        let topology = dual.topology();
        let lengths =
            topology.edges().map(|h| topology.ends(h)).map(|[u, v]| dual.chord(u, [u, v].map(|v| dual.site(v))));
        let astray = lengths.filter(|&length| !is_unit(length)).count() as f64 / topology.edges().count() as f64;
        let qualities = topology.faces().map(|f| dual.quality(topology.corners(f).map(|v| dual.site(v))));
        let (least, sum) = qualities.fold((f64::INFINITY, 0.0), |(least, sum), q| (q.min(least), sum + q));
        Fit { astray, quality: sum / topology.face_count() as f64, least }
    }

    #[test]
    fn more_edges_are_of_unit_length_and_triangles_are_hardly_worse() {
        let domain = Domain::shape("rect:-1,-1,1,1").unwrap();
        let even = |_: Point| Tensor::new(9.0, 2.0, 1.0);
        let fields: [&dyn MetricField; 3] =
            [&Shock { phi: 1.0, lambda: 0.6 }, &Shock { phi: 10.0, lambda: 0.3 }, &even];
        for (field, more) in fields.into_iter().zip([0.02, 0.05, 0.0]) {
            let mut dual = seeded(&domain, field);
            let was = fit(&dual);
            let moved = Mending::default().lengths(&mut dual);
            let now = fit(&dual);
            assert!(dual.planar().is_embedded());
            assert!(moved > 0 && now.astray < was.astray - more, "{} {} {moved}", was.astray, now.astray);
            assert!(now.quality > was.quality - LOSS && now.least >= was.least, "{now:?} {was:?}");
        }
    }
}
