//! Curves of a domain simplified within a distance, which tells what of the input's vertices the mesh keeps; and sizes for which
//! chords stay as close to them.

use crate::domain::{Chain, Domain, Pair, Pslg, curves_in_step};
use crate::elementary::Elementary;
use crate::geodesic::chord;
use crate::geometry::{Aabb, BoxTree, Orientation, Point, Tensor, Vector, kept_within, orientation, widened};
use crate::lists::distinct;
use crate::metric::MetricField;
use std::collections::HashSet;

/// The domain with fewer vertices along its curves: about one per unit of metric length, more where an edge would
/// stray farther than `tolerance` (Euclidean) from the vertices that it skips. Ends of curves stay, loops keep at
/// least three vertices, and where simplified curves would meet, they are kept finer, if need be as they were. Curves of periodic pairs
/// keep the same vertices.
pub(crate) fn simplify(domain: &Domain, pairs: &[Pair], field: &dyn MetricField, tolerance: f64) -> Domain {
    let pslg = domain.pslg();
    let curves = curves_in_step(pslg, pairs);
    let neighbours = Neighbours::new(pslg);
    let mut allowed = tolerance;
    for _ in 0..6 {
        let thinned: Vec<Chain> =
            curves.iter().flat_map(|curve| thin(pslg, curve, field, allowed, &neighbours)).collect();
        if let Ok(simplified) = Domain::new(&pslg.with_chains(&thinned)) {
            return simplified;
        }
        allowed *= 0.25;
    }
    domain.clone()
}

/// Steps along a curve are shortened by up to this where fewer vertices come of it: a chord that strays by next to nothing would be cut
/// in two.
const SHORTER: [f64; 3] = [0.94, 0.88, 0.82];

/// A curve, or two in step, with fewer vertices.
fn thin(pslg: &Pslg, chains: &[Chain], field: &dyn MetricField, tolerance: f64, neighbours: &Neighbours) -> Vec<Chain> {
    let point = |&v: &u32| pslg.points[v as usize];
    let all: Vec<Vec<Point>> = chains.iter().map(|chain| chain.vertices.iter().map(point).collect()).collect();
    let behind = lengths_behind(&all, field);
    let n = behind.len() - 1;
    let is_loop = chains[0].vertices[0] == chains[0].vertices[n];
    let steps = |step: f64| {
        let kept = distinct(even_steps(&behind, step));
        if is_loop && kept.len() < 4 { distinct([0, n / 3, 2 * n / 3, n]) } else { kept }
    };
    // No chord strays farther than the tolerance, or leaves another vertex on its wrong side.
    let strays = |[i, j]: [usize; 2]| {
        let distance =
            |points: &Vec<Point>, k: usize| points[k].distance(points[k].nearest_between(points[i], points[j]));
        let farthest = |k: usize| all.iter().map(|points| distance(points, k)).fold(0.0, f64::max);
        let (far, k) = (i + 1..j).map(|k| (farthest(k), k)).max_by(|a, b| a.0.total_cmp(&b.0))?;
        let mut sides = chains.iter().zip(&all);
        let crosses = sides.any(|(chain, points)| neighbours.any_between(&points[i..=j], &chain.vertices[i..=j]));
        (far > tolerance || crosses).then_some(k)
    };
    let within = |steps: &[usize]| -> Vec<usize> {
        let inner = steps.windows(2).flat_map(|pair| kept_within([pair[0], pair[1]], strays));
        [steps[0]].into_iter().chain(inner).collect()
    };
    let first = steps(1.0);
    let mut kept = within(&first);
    if kept.len() > first.len() {
        let others = SHORTER.map(|step| within(&steps(step)));
        kept = others.into_iter().fold(kept, |best, other| if other.len() < best.len() { other } else { best });
    }
    let thinned =
        |chain: &Chain| Chain { vertices: kept.iter().map(|&i| chain.vertices[i]).collect(), ..chain.clone() };
    chains.iter().map(thinned).collect()
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
    let mut behind = vec![0.0];
    for i in 1..all[0].len() {
        let longest = all.iter().map(|points| chord(field, points[i - 1], points[i])).fold(0.0, f64::max);
        behind.push(behind[i - 1] + longest);
    }
    behind
}

/// Indices of the points nearest to equal steps of about this metric length along a polyline, ends included.
fn even_steps(behind: &[f64], step: f64) -> Vec<usize> {
    let total = behind[behind.len() - 1];
    let steps = ((total / step).round() as usize).clamp(1, behind.len());
    let nearest = |k: usize| {
        let target = total * k as f64 / steps as f64;
        let after = behind.partition_point(|&l| l < target).min(behind.len() - 1);
        let before = after.saturating_sub(1);
        if target - behind[before] < behind[after] - target { before } else { after }
    };
    let mut kept: Vec<usize> = (1..steps).map(nearest).collect();
    kept.extend([0, behind.len() - 1]);
    kept
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

/// The size that a segment's length is right for, as a multiple: an edge as long has metric length 0.84, half-way from the least that is
/// of unit length. With 1 there are a tenth more vertices along a coast, and fewer edges of unit length in the metric given.
const OWN: f64 = 1.189_207_115_002_721;

/// A segment with the size that it asks for.
struct SizedSegment {
    ends: [Point; 2],
    size: f64,
}

impl CurveSizes {
    /// Measures the curves.
    pub(crate) fn new(domain: &Domain, hausd: f64, ar: f64) -> Self {
        let extent = domain.bounds().extent();
        let long = extent.x.max(extent.y);
        let coarse = simplify(domain, &[], &move |_: Point| Tensor::isotropic(long), hausd);
        let pslg = coarse.pslg();
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
        let (bend, own) = (h[0].min(h[1]), OWN * p[0].distance(p[1]));
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

    #[test]
    fn a_circle_is_cut_at_unit_length_or_finer_where_the_tolerance_asks() {
        let domain = Domain::shape("disk:0,0,1").unwrap();
        let size = |h: f64| move |_: Point| Tensor::isotropic(h);
        let sides = |h: f64, tolerance: f64| simplify(&domain, &[], &size(h), tolerance).boundary().len();
        assert_eq!(sides(0.1, 1.0), 63);
        assert!(sides(10.0, 1e-2) >= 22 && sides(10.0, 1e-2) < 60, "{}", sides(10.0, 1e-2));
        assert!(sides(10.0, 10.0) >= 3);
    }

    #[test]
    fn chords_that_stray_by_next_to_nothing_are_not_halved() {
        let domain = Domain::shape("disk:0,0,1").unwrap();
        for hausd in [1e-3, 2e-3, 5e-3] {
            let unit = (SAGITTA * hausd).sqrt();
            let sides = simplify(&domain, &[], &|_: Point| Tensor::isotropic(unit), hausd).boundary();
            let lengths: Vec<f64> = sides.iter().map(|(a, b)| a.distance(*b) / unit).collect();
            assert!(lengths.iter().all(|length| (0.7..1.1).contains(length)), "{hausd}: {lengths:?}");
        }
    }

    #[test]
    fn corners_of_a_square_stay_within_a_small_tolerance() {
        let square = Domain::shape("rect:0,0,1,1").unwrap();
        assert_eq!(simplify(&square, &[], &|_: Point| Tensor::isotropic(100.0), 0.01).boundary().len(), 4);
    }

    /// A disc, and a size that is asked for nowhere.
    fn asked(spec: &str, hausd: f64, p: Point) -> Option<f64> {
        let domain = Domain::shape(spec).unwrap();
        CurveSizes::new(&domain, hausd, 45.0).at(p).map(|(h, _)| h)
    }

    #[test]
    fn circles_have_the_size_of_their_radius() {
        for (radius, hausd) in [(1.0, 0.01), (1.0, 1e-4), (50.0, 0.1)] {
            let angle = 0.7_f64;
            let on = Point::new(radius * angle.cos(), radius * angle.sin());
            let expected = (8.0 * hausd * radius).sqrt();
            let found = asked(&format!("disk:0,0,{radius}"), hausd, on).unwrap();
            // No less than a segment asks for, and these are nearly as long as the distance allows.
            assert!((0.99..=1.01 * OWN).contains(&(found / expected)), "{found} {expected}");
            assert_eq!(asked(&format!("disk:0,0,{radius}"), hausd, Point::new(0.0, 0.0)), None);
        }
    }

    #[test]
    fn directions_are_those_of_the_curve() {
        let domain = Domain::shape("disk:0,0,1").unwrap();
        let sizes = CurveSizes::new(&domain, 1e-4, 45.0);
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
            assert!((found / (OWN * expected) - 1.0).abs() < 1e-12, "{found} at {p}");
        }
    }
}
