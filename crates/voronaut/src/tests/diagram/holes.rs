//! Distances and duals in a domain with holes, against shortest paths around their corners.

use super::common::{halton, vertices};
use crate::canvas::Canvas;
use crate::diagram::Diagram;
use crate::geometry::{Point, Tensor};
use crate::manifold::domain::{Domain, Filling, Pslg, Segment, Side, rect};
use crate::metric::Uniform;
use crate::planar::delaunay;
use std::collections::{BTreeMap, BTreeSet};

/// A rectangle with two holes that leave a passage of 0.02 between them.
fn passage() -> (Domain, Vec<Vec<Point>>) {
    let corners = |x0: f64, y0: f64, x1: f64, y1: f64| -> Vec<Point> {
        [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(|(x, y)| Point::new(x, y)).to_vec()
    };
    let outlines = vec![corners(0.0, 0.0, 4.0, 2.0), corners(1.9, 0.0625, 2.1, 1.0), corners(1.9, 1.02, 2.1, 1.9375)];
    let mut pslg: Pslg = rect(Point::new(0.0, 0.0), Point::new(1.0, 1.0)).unwrap();
    (pslg.points, pslg.segments) = (Vec::new(), Vec::new());
    for outline in &outlines {
        let first = pslg.points.len() as u32;
        pslg.points.extend(outline);
        pslg.segments.extend((0..4).map(|i| Segment {
            ends: [first + i, first + (i + 1) % 4],
            label: 1,
            required: false,
            left: Side::Unknown,
            right: Side::Unknown,
        }));
    }
    pslg.point_labels = vec![0; pslg.points.len()];
    pslg.filling = Filling::EvenOdd;
    (Domain::new(&pslg).unwrap(), outlines[1..].to_vec())
}

#[test]
fn distances_go_around_holes_and_through_the_passage() {
    let (domain, holes) = passage();
    let from = Point::new(0.7, 0.9);
    for tensor in [Tensor::IDENTITY, Tensor::new(1.0, 0.5, 4.0)] {
        // With a uniform metric shortest paths are straight between the holes' corners: a graph of sight.
        let nodes: Vec<Point> = std::iter::once(from).chain(holes.iter().flatten().copied()).collect();
        let mut to = vec![f64::INFINITY; nodes.len()];
        to[0] = 0.0;
        for _ in 0..nodes.len() {
            for i in 0..nodes.len() {
                for j in 0..nodes.len() {
                    if sees(nodes[i], nodes[j], &holes) {
                        to[j] = to[j].min(to[i] + tensor.length(nodes[j] - nodes[i]));
                    }
                }
            }
        }
        let field = Uniform(tensor);
        let canvas = Canvas::intrinsic(domain.planar(), &field, 20_000).unwrap();
        let diagram = Diagram::new(&canvas, &field, &[from]).unwrap();
        let mut behind = 0;
        for v in vertices(&canvas).step_by(23) {
            let p = canvas.position(v);
            let ways = nodes.iter().zip(&to).filter(|(n, _)| sees(**n, p, &holes));
            let exact = ways.map(|(n, d)| d + tensor.length(p - *n)).fold(f64::INFINITY, f64::min);
            assert!((diagram.distance(v) - exact).abs() < 0.01 * exact + 0.01, "{p}: {} {exact}", diagram.distance(v));
            behind += usize::from(!sees(from, p, &holes));
        }
        assert!(behind > 100, "most of the right half is out of sight");
    }
}

#[test]
fn seeds_are_found_behind_holes() {
    let (domain, holes) = passage();
    let canvas = Canvas::intrinsic(domain.planar(), &Uniform::default(), 3000).unwrap();
    for (x, y) in (1..500).map(halton) {
        let p = Point::new(4.2 * x - 0.1, 2.2 * y - 0.1);
        let inside = p.x >= 0.0 && p.x <= 4.0 && p.y >= 0.0 && p.y <= 2.0;
        let in_hole = holes.iter().any(|h| p.x > h[0].x && p.x < h[2].x && p.y > h[0].y && p.y < h[2].y);
        assert_eq!(canvas.locate(p).is_some(), inside && !in_hole, "{p}");
    }
}

/// Whether the straight way between two points meets the inside of no rectangle (its corners counter-clockwise from
/// the lower left): clipped, exact but for rounding.
fn sees(a: Point, b: Point, holes: &[Vec<Point>]) -> bool {
    holes.iter().all(|hole| {
        let mut inside = (0.0_f64, 1.0_f64);
        for (from, to, low, high) in [(a.x, b.x, hole[0].x, hole[2].x), (a.y, b.y, hole[0].y, hole[2].y)] {
            let (low, high) = (low + 1e-9, high - 1e-9);
            let at = |x: f64| (x - from) / (to - from);
            if (to - from).abs() < 1e-12 {
                if from <= low || from >= high {
                    return true;
                }
            } else {
                inside = (inside.0.max(at(low).min(at(high))), inside.1.min(at(low).max(at(high))));
            }
        }
        inside.0 >= inside.1
    })
}

/// Shortest ways in a uniform metric: straight, or from corner to corner of the holes.
struct Sight<'a> {
    tensor: Tensor,
    holes: &'a [Vec<Point>],
    corners: Vec<Point>,
    /// From each seed to each corner.
    to_corners: Vec<Vec<f64>>,
    seeds: &'a [Point],
}

impl<'a> Sight<'a> {
    fn new(tensor: Tensor, holes: &'a [Vec<Point>], seeds: &'a [Point]) -> Self {
        let corners: Vec<Point> = holes.iter().flatten().copied().collect();
        let way = |a: Point, b: Point| if sees(a, b, holes) { tensor.length(b - a) } else { f64::INFINITY };
        let from_seed = |&seed: &Point| {
            let mut to: Vec<f64> = corners.iter().map(|&c| way(seed, c)).collect();
            for _ in 0..corners.len() {
                for (i, &c) in corners.iter().enumerate() {
                    let over = to.iter().zip(&corners).map(|(d, &e)| d + way(e, c)).fold(to[i], f64::min);
                    to[i] = over;
                }
            }
            to
        };
        let to_corners = seeds.iter().map(from_seed).collect();
        Self { tensor, holes, corners, to_corners, seeds }
    }

    /// The distance of a point from every seed.
    fn distances(&self, p: Point) -> Vec<f64> {
        let way = |a: Point| if sees(a, p, self.holes) { self.tensor.length(p - a) } else { f64::INFINITY };
        let last: Vec<f64> = self.corners.iter().map(|&c| way(c)).collect();
        let around = |to: &Vec<f64>| to.iter().zip(&last).map(|(a, b)| a + b).fold(f64::INFINITY, f64::min);
        self.seeds.iter().zip(&self.to_corners).map(|(&seed, to)| way(seed).min(around(to))).collect()
    }
}

/// Seeds all over the domain, and one on each side of a wall and of the passage.
fn seeds_around(holes: &[Vec<Point>]) -> Vec<Point> {
    let mut seeds = [(1.85, 0.5), (2.15, 0.5), (1.85, 1.4), (2.15, 1.4), (1.88, 1.01), (2.12, 1.01)]
        .map(|(x, y)| Point::new(x, y))
        .to_vec();
    for p in (1..200).map(halton).map(|(x, y)| Point::new(4.0 * x, 2.0 * y)) {
        let in_hole = holes.iter().any(|h| p.x > h[0].x && p.x < h[2].x && p.y > h[0].y && p.y < h[2].y);
        if !in_hole && seeds.iter().all(|q| q.distance(p) > 0.22) {
            seeds.push(p);
        }
    }
    seeds
}

const STEP: f64 = 1.0 / 64.0;

/// Pairs whose cells touch, by how many edges of a grid run from one cell to the other; and pairs that are the two
/// nearest seeds of some point of the grid, as far as the grid can tell.
fn touching(sight: &Sight) -> (BTreeMap<[u32; 2], u32>, BTreeSet<[u32; 2]>) {
    let (columns, rows) = (256_usize, 128_usize);
    let at = |i: usize| Point::new((i % columns) as f64 * STEP + 0.003, (i / columns) as f64 * STEP + 0.003);
    let all: Vec<Vec<f64>> = (0..columns * rows).map(|i| sight.distances(at(i))).collect();
    let nearest = |d: &Vec<f64>| (0..d.len()).min_by(|&a, &b| d[a].total_cmp(&d[b])).unwrap_or(0);
    let pair = |a: usize, b: usize| [a.min(b) as u32, a.max(b) as u32];
    let (mut seen, mut possible) = (BTreeMap::new(), BTreeSet::new());
    for (i, distances) in all.iter().enumerate().filter(|(_, d)| d[nearest(d)].is_finite()) {
        let first = nearest(distances);
        let right = (i % columns + 1 < columns).then_some(i + 1);
        for j in [right, Some(i + columns)].into_iter().flatten().filter(|&j| j < all.len()) {
            let other = nearest(&all[j]);
            if other != first && sees(at(i), at(j), sight.holes) {
                *seen.entry(pair(first, other)).or_insert(0) += 1;
            }
        }
        // Within a step in each direction every distance changes by less than this.
        let slack = 4.0 * STEP * sight.tensor.eigen().large.sqrt();
        let near: Vec<usize> = (0..distances.len()).filter(|&k| distances[k] < distances[first] + slack).collect();
        possible.extend(near.iter().flat_map(|&a| near.iter().filter(move |&&b| b > a).map(move |&b| pair(a, b))));
    }
    (seen, possible)
}

#[test]
fn duals_go_around_holes_and_through_the_passage() {
    let (domain, holes) = passage();
    let seeds = seeds_around(&holes);
    for tensor in [Tensor::IDENTITY, Tensor::new(1.0, 0.5, 4.0)] {
        let (seen, possible) = touching(&Sight::new(tensor, &holes, &seeds));
        let field = Uniform(tensor);
        let canvas = Canvas::intrinsic(domain.planar(), &field, 100 * seeds.len()).unwrap();
        let nerve = Diagram::new(&canvas, &field, &seeds).unwrap().sharp_nerve();
        let found: BTreeSet<[u32; 2]> = nerve.edges.iter().map(|e| e.colours).collect();
        let missing: Vec<_> = seen.iter().filter(|&(pair, &edges)| edges > 3 && !found.contains(pair)).collect();
        let extra: Vec<_> = found.difference(&possible).collect();
        assert!(missing.is_empty() && extra.is_empty(), "missing {missing:?}, extra {extra:?}");
        assert!(seen.len() > 2 * seeds.len(), "{} pairs of {} seeds", seen.len(), seeds.len());
        // Beside the walls, 0.3 apart, the plane would join them; through the passage they are joined.
        assert!(!found.contains(&[0, 1]) && !found.contains(&[2, 3]) && found.contains(&[4, 5]), "{found:?}");
        let images = delaunay(&seeds.iter().map(|p| stretched(tensor, *p)).collect::<Vec<_>>()).unwrap();
        let plain = images.topology.edges().map(|h| [images.topology.origin(h).0, images.topology.target(h).0]);
        let walled = plain.filter(|&[a, b]| !found.contains(&[a.min(b), a.max(b)])).count();
        assert!(walled > 5, "the walls make a difference: {walled}");
        let is_seen = |&[a, b]: &[u32; 2]| sees(seeds[a as usize], seeds[b as usize], &holes);
        assert!(found.iter().filter(|pair| !is_seen(pair)).all(|pair| possible.contains(pair)));
    }
}

/// A point's image under a map whose pull-back of the Euclidean metric is the tensor.
fn stretched(tensor: Tensor, p: Point) -> Point {
    let [l11, l21, l22] = tensor.cholesky();
    Point::new(l11 * p.x + l21 * p.y, l22 * p.y)
}
