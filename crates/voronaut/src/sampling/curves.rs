//! Curves of a domain simplified within a distance, which tells what of the input's vertices the mesh keeps; and sizes for which
//! chords stay as close to them.

use crate::elementary::Elementary;
use crate::error::Result;
use crate::geodesic::chord_by;
use crate::geometry::{Aabb, BoxTree, Orientation, Point, Tensor, Vector, kept_within, orientation, widened};
use crate::lists::distinct;
use crate::manifold::domain::{Chain, Pair, Pslg, curves_in_step};
use crate::metric::{MetricField, nearby};
use crate::parallel::prelude::*;
use std::collections::HashSet;

/// A domain of a graph with fewer vertices along its curves: about one per unit of metric length, more where an edge would
/// stray farther than `tolerance` (Euclidean) from the vertices that it skips. Ends of curves stay, loops keep at
/// least three vertices, and where simplified curves would meet, they are kept finer, if need be as they were. Curves of periodic pairs
/// keep the same vertices.
pub(crate) fn simplify<D>(
    pslg: &Pslg,
    pairs: &[Pair],
    field: &dyn MetricField,
    tolerance: f64,
    domain: impl Fn(&Pslg) -> Result<D>,
) -> Option<D> {
    let curves = curves_in_step(pslg, pairs);
    let neighbours = Neighbours::new(pslg);
    let mut allowed = tolerance;
    for _ in 0..6 {
        let of_one = |curve: &Vec<Chain>| thin(pslg, curve, field, allowed, &neighbours);
        let thinned: Vec<Chain> = curves.par_iter().flat_map_iter(of_one).collect();
        if let Ok(simplified) = domain(&pslg.with_chains(&thinned)) {
            return Some(simplified);
        }
        allowed *= 0.25;
    }
    None
}

/// A curve, or two in step, with fewer vertices.
fn thin(pslg: &Pslg, chains: &[Chain], field: &dyn MetricField, tolerance: f64, neighbours: &Neighbours) -> Vec<Chain> {
    let point = |&v: &u32| pslg.points[v as usize];
    let all: Vec<Vec<Point>> = chains.iter().map(|chain| chain.vertices.iter().map(point).collect()).collect();
    let behind = lengths_behind(&all, field);
    let n = behind.len() - 1;
    let farthest = |[i, j]: [usize; 2], k: usize| {
        let distance = |points: &Vec<Point>| points[k].distance(points[k].nearest_between(points[i], points[j]));
        all.iter().map(distance).fold(0.0, f64::max)
    };
    let strays = |[i, j]: [usize; 2]| {
        let far = (i + 1..j).map(|k| (farthest([i, j], k), k)).max_by(|a, b| a.0.total_cmp(&b.0));
        far.unwrap_or_default()
    };
    let (stations, spared) = stations(&behind, strays, tolerance);
    let fits = |[i, j]: [usize; 2]| {
        stations[i + 1..j].iter().all(|&k| farthest([stations[i], stations[j]], k) <= (1.0 - spared) * tolerance)
    };
    let mut kept = evenest(&stations, &behind, fits);
    if chains[0].vertices[0] == chains[0].vertices[n] && kept.len() < 4 {
        kept = distinct([0, n / 3, 2 * n / 3, n]);
    }
    // No chord strays farther than the tolerance, or leaves another vertex on its wrong side.
    let is_beyond = |[i, j]: [usize; 2]| {
        let mut sides = chains.iter().zip(&all);
        let (far, k) = strays([i, j]);
        let mut crosses =
            || sides.any(|(chain, points)| neighbours.any_between(&points[i..=j], &chain.vertices[i..=j]));
        (j > i + 1 && (far > tolerance || crosses())).then_some(k)
    };
    let inner = kept.windows(2).flat_map(|pair| kept_within([pair[0], pair[1]], is_beyond));
    let kept: Vec<usize> = std::iter::once(0).chain(inner).collect();
    let thinned =
        |chain: &Chain| Chain { vertices: kept.iter().map(|&i| chain.vertices[i]).collect(), ..chain.clone() };
    chains.iter().map(thinned).collect()
}

/// Stations of a curve are no farther apart (metric), where it has vertices.
const APART: f64 = 0.125;
/// What lies between stations is no farther from their chords than these shares of the tolerance, the first for which there are not too
/// many: so many for each that the tolerance itself asks for.
const SPARED: [f64; 2] = [0.01, 0.1];
const STATIONS: usize = 16;

/// The vertices of a curve that are looked at, by their indices, so that it takes little time to choose of them; and the share of the
/// tolerance that the others need. `strays` says how far a curve is from a chord, and where.
fn stations(behind: &[f64], strays: impl Fn([usize; 2]) -> (f64, usize), tolerance: f64) -> (Vec<usize>, f64) {
    let n = behind.len() - 1;
    let within = |share: f64| -> Vec<usize> {
        let cut = |[i, j]: [usize; 2]| {
            if j - i > 1 && behind[j] - behind[i] > APART {
                let middle = 0.5 * (behind[i] + behind[j]);
                return Some(behind.partition_point(|&length| length < middle).clamp(i + 1, j - 1));
            }
            let (far, k) = strays([i, j]);
            (far > share * tolerance).then_some(k)
        };
        std::iter::once(0).chain(kept_within([0, n], cut)).collect()
    };
    let most = STATIONS * within(1.0).len();
    let fine = within(SPARED[0]);
    let (stations, spared) = if fine.len() > most { (within(SPARED[1]), SPARED[1]) } else { (fine, SPARED[0]) };
    let spared = if stations.len() > n { 0.0 } else { spared };
    (stations, spared)
}

/// The longest edge (metric) that is looked at: it will be cut in two.
const LONGEST: f64 = 1.5;
/// The search for the start of an edge ends at so many in a row that do not fit.
const IN_VAIN: usize = 4;

/// The stations at which edges end that are as near to unit length as may be, by the sum of the squares of their logarithms; all fit
/// that are between neighbours, of others `fits` says so. By dynamic programming (Bellman 1961).
fn evenest(stations: &[usize], behind: &[f64], fits: impl Fn([usize; 2]) -> bool) -> Vec<usize> {
    let mut best: Vec<(f64, usize)> = vec![(0.0, 0)];
    for j in 1..stations.len() {
        let (mut least, mut from, mut in_vain) = (f64::INFINITY, j - 1, 0);
        for i in (0..j).rev() {
            let length = behind[stations[j]] - behind[stations[i]];
            let are_beside = i + 1 == j;
            if !are_beside && (length > LONGEST || in_vain == IN_VAIN) {
                break;
            }
            let cost = best[i].0 + unevenness(length);
            if are_beside || (cost < least && fits([i, j])) {
                (least, from, in_vain) = (cost, i, 0);
            } else if cost < least {
                in_vain += 1;
            }
        }
        best.push((least, from));
    }
    let before = |&j: &usize| (j > 0).then(|| best[j].1);
    let mut kept: Vec<usize> = std::iter::successors(Some(stations.len() - 1), before).map(|j| stations[j]).collect();
    kept.reverse();
    kept
}

/// The sum of the squared logarithms of the edges that a stretch of this metric length is cut into.
fn unevenness(length: f64) -> f64 {
    let pieces = length.round().max(1.0);
    pieces * (length.max(f64::MIN_POSITIVE) / pieces).logarithm().powi(2)
}

/// All vertices of the domain, to see which of them a chord would leave on its other side.
struct Neighbours(BoxTree<(Point, u32), 2>);

impl Neighbours {
    fn new(pslg: &Pslg) -> Self {
        Self(BoxTree::new((0..).zip(&pslg.points).map(|(i, &p)| ([[p.x, p.y]; 2], (p, i)))))
    }

    /// Whether a vertex that is not part of the run lies between the run and its chord (de Berg, van Kreveld and
    /// Schirra 1998): the chord would change on which side of the curve that vertex is.
    fn any_between(&self, run: &[Point], vertices: &[u32]) -> bool {
        let Some(bounds) = Aabb::of(run.iter().copied()).filter(|_| run.len() > 2) else { return false };
        self.0.meeting(bounds.into()).any(|(p, i)| !vertices.contains(i) && is_inside(run, *p))
    }
}

/// Even-odd test of a point against a closed polygon.
fn is_inside(polygon: &[Point], p: Point) -> bool {
    let mut inside = false;
    for (i, &b) in polygon.iter().enumerate() {
        let a = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (low, high) = if a.y < b.y { (a, b) } else { (b, a) };
        inside ^= low.y <= p.y && p.y < high.y && orientation(low, high, p) == Orientation::Left;
    }
    inside
}

/// The metric length of a polyline up to each of its points; of several in step, that which is greatest of each of their segments.
fn lengths_behind(all: &[Vec<Point>], field: &dyn MetricField) -> Vec<f64> {
    let at: Vec<_> = all.iter().map(|_| nearby(field)).collect();
    let mut behind = vec![0.0];
    for i in 1..all[0].len() {
        let lengths = all.iter().zip(&at).map(|(points, at)| chord_by(at, points[i - 1], points[i]));
        let longest = lengths.fold(0.0, f64::max);
        behind.push(behind[i - 1] + longest);
    }
    behind
}

/// A chord of length h is h^2 / 8 times the curvature away from its curve.
const SAGITTA: f64 = 8.0;

/// The sizes that curves of a domain ask for: sqrt(8 `hausd` / curvature), as mmg2d has it, but never less than about the length of
/// the curve's own segment, for that is the curve: there is nothing between its ends to be close to. A segment that does not bend asks
/// for about its length, for it will be an edge, or more than one. Curves are simplified by the same distance first, so that what is
/// smaller is no bend; a vertex that turns by more than `ar` (degrees) is a corner and none either. Required segments ask for nothing.
pub(crate) struct CurveSizes {
    segments: BoxTree<SizedSegment, 2>,
    hausd: f64,
}

/// A segment with the size that it asks for.
struct SizedSegment {
    ends: [Point; 2],
    size: f64,
}

impl CurveSizes {
    /// Measures the curves.
    pub(crate) fn new(pslg: &Pslg, hausd: f64, ar: f64) -> Self {
        let extent = Aabb::of(pslg.points.iter().copied()).map_or(Vector::default(), |bounds| bounds.extent());
        let long = extent.x.max(extent.y);
        let coarse = simplify(pslg, &[], &move |_: Point| Tensor::isotropic(long), hausd, Pslg::validated);
        let pslg = coarse.as_ref().map_or(pslg, |coarse| coarse.pslg());
        let required: HashSet<u32> = pslg.required_points.iter().copied().collect();
        let chains = pslg.chains();
        let free = chains.iter().filter(|chain| !chain.kind.required);
        let sized = free.flat_map(|chain| sized(pslg, &required, chain, hausd, ar));
        let boxed = |one: SizedSegment| Some((Aabb::of(one.ends)?.into(), one));
        Self { segments: BoxTree::new(sized.filter_map(boxed)), hausd }
    }

    /// The size of the segments within `hausd` of a point, which are at most two as a rule, in the (geometric) mean, and their
    /// direction (of length one); `None` where there is none.
    pub(crate) fn at(&self, p: Point) -> Option<(f64, Vector)> {
        let reach = self.hausd.max(f64::MIN_POSITIVE.sqrt());
        let around = self.segments.meeting(widened([[p.x, p.y]; 2], reach));
        let near: Vec<&SizedSegment> =
            around.filter(|bent| p.distance(p.nearest_between(bent.ends[0], bent.ends[1])) <= reach).collect();
        let first = direction(near.first()?);
        let sum = near[1..].iter().map(|bent| direction(bent)).fold(first, |sum, d| sum + d * d.dot(first).signum());
        let logarithms: f64 = near.iter().map(|bent| bent.size.logarithm()).sum();
        Some(((logarithms / near.len() as f64).exponential(), sum * (1.0 / sum.norm())))
    }
}

fn direction(bent: &SizedSegment) -> Vector {
    let along = bent.ends[1] - bent.ends[0];
    along * (1.0 / along.norm())
}

/// The segments of a curve with their sizes.
fn sized(pslg: &Pslg, required: &HashSet<u32>, chain: &Chain, hausd: f64, ar: f64) -> Vec<SizedSegment> {
    let points: Vec<Point> = chain.vertices.iter().map(|&v| pslg.points[v as usize]).collect();
    let last = points.len() - 1;
    let is_loop = chain.vertices[0] == chain.vertices[last] && !required.contains(&chain.vertices[0]);
    let bend = |i: usize| match i % last {
        0 if is_loop => curvature([points[last - 1], points[0], points[1]], ar),
        0 => 0.0,
        i => curvature([points[i - 1], points[i], points[i + 1]], ar),
    };
    let sizes: Vec<f64> = (0..=last).map(|i| (SAGITTA * hausd / bend(i)).sqrt()).collect();
    let segments = points.windows(2).zip(sizes.windows(2));
    let found = segments.map(|(p, h)| {
        let (bend, own) = (h[0].min(h[1]), p[0].distance(p[1]));
        let size = if bend.is_finite() { bend.max(own) } else { own };
        SizedSegment { ends: [p[0], p[1]], size }
    });
    found.collect()
}

/// The curvature of the circle through three points of a curve; zero where it turns by more than the angle.
fn curvature([a, b, c]: [Point; 3], ar: f64) -> f64 {
    let (u, v) = (b - a, c - b);
    if u.turn(v).to_degrees() > ar {
        return 0.0;
    }
    2.0 * u.cross(v).abs() / (u.norm() * v.norm() * (c - a).norm())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Tensor;
    use crate::manifold::domain::Domain;
    use crate::test_cases::plate;

    fn simplified(domain: &Domain, field: &dyn MetricField, tolerance: f64) -> Domain {
        simplify(domain.pslg(), &[], field, tolerance, Pslg::validated).unwrap_or_else(|| domain.clone())
    }

    #[test]
    fn a_circle_is_cut_at_unit_length_or_finer_where_the_tolerance_asks() {
        let domain = Domain::shape("disk:0,0,1").unwrap();
        let size = |h: f64| move |_: Point| Tensor::isotropic(h);
        let sides = |h: f64, tolerance: f64| simplified(&domain, &size(h), tolerance).boundary().len();
        // To within the eighth of an edge by which vertices are looked at.
        assert!((62..=64).contains(&sides(0.1, 1.0)), "{}", sides(0.1, 1.0));
        assert!(sides(10.0, 1e-2) >= 22 && sides(10.0, 1e-2) < 60, "{}", sides(10.0, 1e-2));
        assert!(sides(10.0, 10.0) >= 3);
    }

    #[test]
    fn chords_that_stray_by_next_to_nothing_are_not_halved() {
        let domain = Domain::shape("disk:0,0,1").unwrap();
        for hausd in [1e-3, 2e-3, 5e-3] {
            let unit = (SAGITTA * hausd).sqrt();
            let sides = simplified(&domain, &|_: Point| Tensor::isotropic(unit), hausd).boundary();
            let lengths: Vec<f64> = sides.iter().map(|(a, b)| a.distance(*b) / unit).collect();
            assert!(lengths.iter().all(|length| (0.7..1.1).contains(length)), "{hausd}: {lengths:?}");
        }
    }

    #[test]
    fn edges_are_as_even_as_the_vertices_of_a_curve_let_them_be() {
        // Six sides of a circle make an edge, seven stray too far, and neither goes into 200: steps that stray must not be halved.
        let circle = (0..200).map(|i| (f64::from(i) * std::f64::consts::TAU / 200.0).sin_cos());
        let ring: Vec<[f64; 2]> = circle.map(|(sin, cos)| [cos, sin]).collect();
        let unit = 6.37 * std::f64::consts::TAU / 200.0;
        let sides = simplified(&plate(&[&ring]), &|_: Point| Tensor::isotropic(unit), 5e-3).boundary();
        let lengths: Vec<f64> = sides.iter().map(|(a, b)| a.distance(*b) / unit).collect();
        assert!(lengths.iter().all(|length| (0.75..1.2).contains(length)), "{lengths:?}");
    }

    #[test]
    fn corners_of_a_square_stay_within_a_small_tolerance() {
        let square = Domain::shape("rect:0,0,1,1").unwrap();
        assert_eq!(simplified(&square, &|_: Point| Tensor::isotropic(100.0), 0.01).boundary().len(), 4);
    }

    /// A disc, and a size that is asked for nowhere.
    fn asked(spec: &str, hausd: f64, p: Point) -> Option<f64> {
        let domain = Domain::shape(spec).unwrap();
        CurveSizes::new(domain.pslg(), hausd, 45.0).at(p).map(|(h, _)| h)
    }

    #[test]
    fn circles_have_the_size_of_their_radius() {
        for (radius, hausd) in [(1.0, 0.01), (1.0, 1e-4), (50.0, 0.1)] {
            let angle = 0.7_f64;
            let on = Point::new(radius * angle.cos(), radius * angle.sin());
            let expected = (8.0 * hausd * radius).sqrt();
            let found = asked(&format!("disk:0,0,{radius}"), hausd, on).unwrap();
            assert!((0.99..=1.01).contains(&(found / expected)), "{found} {expected}");
            assert_eq!(asked(&format!("disk:0,0,{radius}"), hausd, Point::new(0.0, 0.0)), None);
        }
    }

    #[test]
    fn directions_are_those_of_the_curve() {
        let domain = Domain::shape("disk:0,0,1").unwrap();
        let sizes = CurveSizes::new(domain.pslg(), 1e-4, 45.0);
        for (_, (a, b)) in (0..40).zip(domain.boundary()) {
            let (_, along) = sizes.at(a).unwrap();
            assert!(along.turn(b - a).min(along.turn(a - b)).to_degrees() < 2.0, "{a}");
        }
    }

    #[test]
    fn what_is_straight_asks_for_its_length() {
        for (p, expected) in
            [(Point::new(0.0, 0.5), 1.0), (Point::new(1.0, 0.0), 2.0), (Point::new(0.0, 0.0), 2.0_f64.sqrt())]
        {
            let found = asked("rect:0,0,2,1", 0.01, p).unwrap();
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} at {p}");
        }
    }
}
