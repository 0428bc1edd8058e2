//! Sizes for which chords stay close to the curves of a domain.

use super::curves::distance_to_segment;
use super::simplify;
use crate::domain::{Chain, Domain, Pslg};
use crate::geometry::{Aabb, BoxTree, Point, Tensor, Vector, widened};
use std::collections::HashSet;

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
        let coarse = simplify(domain, &move |_: Point| Tensor::isotropic(long), hausd);
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
            around.filter(|bent| distance_to_segment(p, bent.ends[0], bent.ends[1]) <= reach).collect();
        let first = direction(near.first()?);
        let sum = near[1..].iter().map(|bent| direction(bent)).fold(first, |sum, d| sum + d * d.dot(first).signum());
        let logarithms: f64 = near.iter().map(|bent| bent.size.ln()).sum();
        Some(((logarithms / near.len() as f64).exp(), sum * (1.0 / sum.norm())))
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
