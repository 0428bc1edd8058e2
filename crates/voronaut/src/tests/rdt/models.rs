//! Surfaces in which circles are known in closed form, and what a triangulation of seeds is worth beside them.

use crate::canvas::Canvas;
use crate::diagram::Diagram;
use crate::geometry::{Point, Tensor, Vector};
use crate::manifold::domain::{Domain, rect};
use crate::metric::MetricField;
use crate::planar::{Planar, delaunay};
use crate::rdt::{Edge, Rdt, Start, Trust};
use std::collections::{BTreeMap, BTreeSet};

/// A generator of even numbers in [0, 1): splitmix64.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

pub(crate) type Map<'a> = &'a (dyn Fn(Point) -> Point + Sync);

/// A surface of constant curvature: a map to a plane in which circles of the metric are circles.
pub(crate) struct Model<'a> {
    pub name: &'a str,
    /// Lower left and upper right corner of the domain.
    pub corners: [Point; 2],
    pub map: Map<'a>,
    pub metric: &'a dyn MetricField,
    pub curvature: f64,
}

impl Model<'_> {
    pub(crate) fn domain(&self) -> Domain {
        let [low, high] = self.corners;
        Domain::new(&rect(low, high).unwrap()).unwrap()
    }

    /// Distance of two points by their images.
    fn distance(&self, p: Point, q: Point) -> f64 {
        let d = p.distance(q);
        if self.curvature < 0.0 {
            2.0 * (0.5 * d / (p.y * q.y).sqrt()).asinh()
        } else if self.curvature > 0.0 {
            let size = |p: Point| 1.0 + p.x * p.x + p.y * p.y;
            2.0 * (d / (size(p) * size(q)).sqrt()).min(1.0).asin()
        } else {
            d
        }
    }

    /// The centre in the surface of a circle of the image, and its radius there.
    fn true_circle(&self, centre: Point, radius: f64) -> Option<(Point, f64)> {
        if self.curvature < 0.0 {
            let y2 = centre.y * centre.y - radius * radius;
            let true_centre = Point::new(centre.x, y2.max(0.0).sqrt());
            (y2 > 0.0).then(|| (true_centre, 0.5 * ((centre.y + radius) / (centre.y - radius)).ln()))
        } else if self.curvature > 0.0 {
            // Along the ray through the origin the circle spans the angles 2 atan(r).
            let r = centre.x.hypot(centre.y).max(1e-300);
            let [near, far] = [r - radius, r + radius].map(|s| 2.0 * s.atan());
            let middle = (0.25 * (near + far)).tan() / r;
            Some((Point::new(centre.x * middle, centre.y * middle), 0.5 * (far - near)))
        } else {
            Some((centre, radius))
        }
    }

    /// Random seeds, no two closer than the spacing.
    pub(crate) fn seeds(&self, tries: usize, spacing: f64, seed: u64) -> Vec<Point> {
        let mut random = Random(seed);
        let [low, high] = self.corners;
        let mut seeds: Vec<(Point, Point)> = Vec::new();
        let per = 40.0;
        let key = |p: Point| {
            (((p.x - low.x) / (high.x - low.x) * per) as i64, ((p.y - low.y) / (high.y - low.y) * per) as i64)
        };
        let (mut boxes, wide) = (BTreeMap::<(i64, i64), Vec<u32>>::new(), self.curvature != 0.0);
        for _ in 0..tries {
            let p = Point::new(low.x + (high.x - low.x) * random.next(), low.y + (high.y - low.y) * random.next());
            let image = (self.map)(p);
            let at =
                if wide { key(p) } else { ((image.x / spacing).floor() as i64, (image.y / spacing).floor() as i64) };
            let reach = if wide { 8 } else { 1 };
            let mut near = (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| (i, j)));
            let is_free = near.all(|(i, j)| {
                let list = boxes.get(&(at.0 + i, at.1 + j));
                list.is_none_or(|l| l.iter().all(|&k| self.distance(seeds[k as usize].1, image) > spacing))
            });
            if is_free {
                boxes.entry(at).or_default().push(seeds.len() as u32);
                seeds.push((p, image));
            }
        }
        seeds.into_iter().map(|s| s.0).collect()
    }
}

fn circle([a, b, c]: [Point; 3]) -> (Point, f64) {
    let (u, v) = (b - a, c - a);
    let x = Vector::new(u.dot(u) * v.y - v.dot(v) * u.y, v.dot(v) * u.x - u.dot(u) * v.x) * (0.5 / u.cross(v));
    (a + x, x.norm())
}

/// The margin by closed form: the power by true distances.
fn exact_margin(model: &Model, images: &[Point], [a, b, c, d]: [u32; 4]) -> Option<f64> {
    let [a, b, c, d] = [a, b, c, d].map(|i| images[i as usize]);
    // Written as the in-circle determinant of the image where the surface is flat.
    let to = |p: Point, q: Point| model.distance(p, q);
    let (centre, radius) = circle([a, b, c]);
    let (true_centre, true_radius) = model.true_circle(centre, radius)?;
    let away = to(d, true_centre);
    let power = (away - true_radius) * (away + true_radius);
    let (x, y, z) = (to(a, b), to(b, c), to(c, a));
    let s = 0.5 * (x + y + z);
    let area = (s * (s - x) * (s - y) * (s - z)).max(0.0).sqrt();
    Some(2.0 * area * power / (to(c, a) * to(c, b) * to(d, b) * to(d, a)))
}

/// What a triangulation is worth.
#[derive(Debug, Default)]
pub(crate) struct Outcome {
    pub interior: usize,
    /// Interior triangles missing or too many, and those missing whose margins exceed 1e-6.
    pub wrong: usize,
    pub wrong_clear: usize,
    /// Edges between interior triangles; those whose margin is off by more than its error; those with the wrong sign,
    /// claimed certain.
    pub edges: usize,
    pub dishonest: usize,
    pub wrong_sign: usize,
}

impl Outcome {
    pub(crate) fn demand(&self) {
        assert!(self.interior > 0 && self.edges > 0, "nothing was compared: {self:?}");
        assert_eq!((self.wrong_clear, self.wrong_sign, self.dishonest), (0, 0, 0), "{self:?}");
        assert!(self.wrong as f64 <= 2e-4 * self.interior as f64, "{self:?}");
    }
}

/// Random seeds, triangulated from the sharp nerve on a canvas, must come out right.
pub(crate) fn run(model: &Model, tries: usize, spacing: f64, per_seed: usize) -> Outcome {
    let seeds = model.seeds(tries, spacing, 1);
    let canvas = Canvas::intrinsic(model.domain().planar(), model.metric, per_seed * seeds.len()).unwrap();
    let nerve = Diagram::new(&canvas, model.metric, &seeds).unwrap().sharp_nerve();
    let outcome = check(model, &seeds, &Start::from_nerve(&nerve));
    outcome.demand();
    outcome
}

/// The Euclidean Delaunay triangulation of the seeds: for a metric that stretches, a start as far off as can be.
pub(crate) fn straight_delaunay(seeds: &[Point]) -> Start {
    let plain = delaunay(seeds).unwrap();
    let corners = plain.topology.faces().map(|f| plain.topology.corners(f).map(|v| v.0));
    let triangles = corners.filter(|t| t.iter().all(|&v| (v as usize) < seeds.len())).collect();
    Start { triangles, ..Start::default() }
}

/// Triangulates seeds from a start and holds the outcome against the closed form.
pub(crate) fn check(model: &Model, seeds: &[Point], start: &Start) -> Outcome {
    let rdt = Rdt::new(model.metric, seeds, start, Trust::default());
    rdt.topology().check().unwrap();
    let truth = Truth::new(model, seeds);
    let found: BTreeSet<[u32; 3]> = rdt.triangles().into_iter().filter(|&t| truth.is_inside(t)).map(sorted).collect();
    let missing: Vec<&[u32; 3]> = truth.interior.difference(&found).collect();
    let mut outcome = Outcome {
        interior: truth.interior.len(),
        wrong: missing.len().max(found.difference(&truth.interior).count()),
        wrong_clear: missing.iter().filter(|t| truth.least[**t] > 1e-6).count(),
        ..Outcome::default()
    };
    rdt.edges().iter().for_each(|edge| truth.compare(edge, &mut outcome));
    let (counters, disagreements) = (rdt.counters(), rdt.disagreements().len());
    println!("{}: {} seeds, {outcome:?}, {disagreements} disagreements, {counters:?}", model.name, seeds.len());
    outcome
}

/// The exact triangulation.
struct Truth<'a> {
    model: &'a Model<'a>,
    images: Vec<Point>,
    /// The image of the domain's border, in points.
    border: Vec<Point>,
    /// Triangles whose circle lies inside the domain.
    interior: BTreeSet<[u32; 3]>,
    /// The least margin of a triangle's edges says how degenerate it is.
    least: BTreeMap<[u32; 3], f64>,
}

impl<'a> Truth<'a> {
    fn new(model: &'a Model, seeds: &[Point]) -> Self {
        let images: Vec<Point> = seeds.iter().map(|&p| (model.map)(p)).collect();
        let [low, high] = model.corners;
        let (right, left) = (Point::new(high.x, low.y), Point::new(low.x, high.y));
        let side = |a: Point, b: Point| (0..2000).map(move |i| a.lerp(b, f64::from(i) / 2000.0));
        let around = side(low, right).chain(side(right, high)).chain(side(high, left)).chain(side(left, low));
        let border = around.map(|p| (model.map)(p)).collect();
        let exact = delaunay(&images).unwrap();
        let mut truth = Self { model, images, border, interior: BTreeSet::new(), least: BTreeMap::new() };
        let corners = exact.topology.faces().map(|f| exact.topology.corners(f).map(|v| v.0));
        truth.interior = corners.filter(|&t| truth.is_inside(t)).map(sorted).collect();
        truth.weigh(&exact);
        truth
    }

    fn weigh(&mut self, exact: &Planar) {
        let topology = &exact.topology;
        for h in topology.edges() {
            let Some(t) = topology.twin(h) else { continue };
            let quad = [topology.origin(h), topology.target(h), topology.apex(h), topology.apex(t)].map(|v| v.0);
            if quad.iter().any(|&v| v as usize >= self.images.len()) {
                continue;
            }
            let Some(margin) = exact_margin(self.model, &self.images, quad) else { continue };
            for f in [h.face(), t.face()] {
                let least = self.least.entry(sorted(topology.corners(f).map(|v| v.0))).or_insert(f64::INFINITY);
                *least = least.min(margin);
            }
        }
    }

    /// Whether the circle of three seeds lies inside the domain: no point of the border is in it, and seeds are.
    fn is_inside(&self, t: [u32; 3]) -> bool {
        if t.iter().any(|&v| v as usize >= self.images.len()) {
            return false;
        }
        let (centre, radius) = circle(t.map(|v| self.images[v as usize]));
        radius.is_finite() && self.border.iter().all(|q| q.distance(centre) > radius * (1.0 + 1e-6))
    }

    fn compare(&self, edge: &Edge, outcome: &mut Outcome) {
        let ([Some(c), Some(d)], Some(margin), [a, b]) = (edge.apexes, edge.margin, edge.ends) else { return };
        if !self.is_inside([a, b, c]) || !self.is_inside([b, a, d]) {
            return;
        }
        let Some(exact) = exact_margin(self.model, &self.images, [a, b, c, d]) else { return };
        outcome.edges += 1;
        outcome.dishonest += usize::from((margin.value - exact).abs() > 1.001 * margin.error + 1e-9);
        outcome.wrong_sign += usize::from(margin.is_certain() && exact.abs() > 1e-12 && margin.value * exact < 0.0);
    }
}

fn sorted(mut t: [u32; 3]) -> [u32; 3] {
    t.sort_unstable();
    t
}

/// The metric of flat space through a map, from its Jacobian ((a, b), (c, d)).
pub(crate) fn pulled_back(jacobian: impl Fn(Point) -> [f64; 4] + Sync) -> impl MetricField {
    move |p: Point| {
        let [a, b, c, d] = jacobian(p);
        Tensor::new(a * a + c * c, a * b + c * d, b * b + d * d)
    }
}

pub(crate) const SQUARE: [Point; 2] = [Point::new(-1.0, -1.0), Point::new(1.0, 1.0)];
