//! Random domains, valid by construction, of the shapes that break meshers. Each is drawn in a box of about unit size
//! and then turned, scaled and moved.

use super::random::{Random, polar};
use std::f64::consts::TAU;
use voronaut::geometry::{Point, Vector};
use voronaut::manifold::domain::{Filling, Pslg, Segment, Side};

/// A domain in the making.
#[derive(Default)]
pub(crate) struct Sketch {
    points: Vec<Point>,
    segments: Vec<[u32; 2]>,
    /// Closed curves and what they add to the area: 1, or -1 for a hole.
    loops: Vec<(Vec<u32>, f64)>,
    holes: Vec<Point>,
    regions: Vec<(Point, i32)>,
}

/// Where a sketch is put.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    pub(crate) angle: f64,
    pub(crate) scale: f64,
    pub(crate) offset: Vector,
}

/// A domain and what is known of it.
pub(crate) struct Drawn {
    pub(crate) shape: &'static str,
    pub(crate) pslg: Pslg,
    pub(crate) placement: Placement,
    pub(crate) area: f64,
}

type Family = (&'static str, fn(&mut Random, &mut Sketch));

const FAMILIES: [Family; 15] = [
    ("star", star),
    ("jagged", jagged),
    ("holes and islands", holes_and_islands),
    ("components", components),
    ("holes that touch in a point", touching_holes),
    ("sliver", sliver),
    ("slot", slot),
    ("spikes", spikes),
    ("notches", notches),
    ("islands that almost touch", near_islands),
    ("holes that almost touch", near_holes),
    ("channel", channel),
    ("thin ring", thin_ring),
    ("features", features),
    ("regions", regions),
];

/// The domain of a case.
pub(crate) fn draw(random: &mut Random) -> Drawn {
    let (shape, family) = FAMILIES[random.whole(0, FAMILIES.len() as u32 - 1) as usize];
    let mut sketch = Sketch::default();
    family(random, &mut sketch);
    let placement = Placement::draw(random);
    let one_label = random.chance(0.25);
    let (pslg, area) = sketch.place(placement, one_label);
    Drawn { shape, pslg, placement, area }
}

impl Placement {
    fn draw(random: &mut Random) -> Self {
        let angle = if random.chance(0.5) { random.turn() } else { 0.0 };
        let scale = if random.chance(0.5) { 1.0 } else { random.size(1e-9, 1e9) };
        let far = if random.chance(0.15) { 1e6 * scale } else { 0.0 };
        Self { angle, scale, offset: Vector::new(far, -0.7 * far) }
    }

    pub(crate) fn apply(&self, p: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        Point::default() + Vector::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y) * self.scale + self.offset
    }

    pub(crate) fn undo(&self, p: Point) -> Point {
        let (sin, cos) = self.angle.sin_cos();
        let v = p - self.offset - Point::default();
        Point::default() + Vector::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x) * (1.0 / self.scale)
    }
}

impl Sketch {
    fn add(&mut self, p: Point) -> u32 {
        self.points.push(p);
        self.points.len() as u32 - 1
    }

    /// A closed curve through points that are there; `sign` is what it adds to the area.
    fn close(&mut self, ids: Vec<u32>, sign: f64) {
        let next = ids.iter().cycle().skip(1);
        self.segments.extend(ids.iter().zip(next).map(|(&a, &b)| [a, b]));
        self.loops.push((ids, sign));
    }

    fn outline(&mut self, points: impl IntoIterator<Item = Point>, sign: f64) -> Vec<u32> {
        let ids: Vec<u32> = points.into_iter().map(|p| self.add(p)).collect();
        self.close(ids.clone(), sign);
        ids
    }

    fn open(&mut self, ids: &[u32]) {
        self.segments.extend(ids.windows(2).map(|w| [w[0], w[1]]));
    }

    fn rectangle(&mut self, min: Point, max: Point, sign: f64) -> Vec<u32> {
        self.outline([min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)], sign)
    }

    fn place(self, placement: Placement, one_label: bool) -> (Pslg, f64) {
        let points: Vec<Point> = self.points.iter().map(|&p| placement.apply(p)).collect();
        let area = self.loops.iter().map(|(ids, sign)| sign * area_of(&points, ids)).sum();
        let segments = (1..).zip(&self.segments).map(|(number, &ends)| Segment {
            ends,
            label: if one_label { 7 } else { number },
            required: false,
            left: Side::Unknown,
            right: Side::Unknown,
        });
        let filling = if self.holes.is_empty() && self.regions.is_empty() {
            Filling::EvenOdd
        } else {
            let place = |&p: &Point| placement.apply(p);
            Filling::Enclosed {
                holes: self.holes.iter().map(place).collect(),
                regions: self.regions.iter().map(|(p, label)| (place(p), *label)).collect(),
            }
        };
        let pslg = Pslg {
            segments: segments.collect(),
            point_labels: vec![0; points.len()],
            points,
            required_points: Vec::new(),
            filling,
            tolerance: 0.0,
            names: Vec::new(),
        };
        (pslg, area)
    }
}

/// The unsigned area within a closed curve, relative to its first point: exact to rounding wherever it lies.
fn area_of(points: &[Point], ids: &[u32]) -> f64 {
    let at = |i: usize| points[ids[i] as usize] - points[ids[0] as usize];
    0.5 * (2..ids.len()).map(|i| at(i - 1).cross(at(i))).sum::<f64>().abs()
}

/// Corners of a star-shaped polygon: at increasing angles, no two more than half a turn apart.
fn star_points(random: &mut Random, count: u32, centre: Point, radii: (f64, f64)) -> Vec<Point> {
    let start = random.turn();
    let angle =
        |i: u32, random: &mut Random| start + TAU * (f64::from(i) + random.within(0.0, 0.45)) / f64::from(count);
    (0..count).map(|i| polar(centre, angle(i, random), random.within(radii.0, radii.1))).collect()
}

fn star(random: &mut Random, sketch: &mut Sketch) {
    let count = random.whole(3, 60);
    sketch.outline(star_points(random, count.max(4), Point::default(), (0.3, 1.0)), 1.0);
}

/// A coast: radii from a twentieth to one.
fn jagged(random: &mut Random, sketch: &mut Sketch) {
    let count = random.whole(20, 150);
    sketch.outline(star_points(random, count, Point::default(), (0.05, 1.0)), 1.0);
}

fn holes_and_islands(random: &mut Random, sketch: &mut Sketch) {
    let count = random.whole(16, 40);
    sketch.outline(star_points(random, count, Point::default(), (0.75, 1.0)), 1.0);
    for cell in 0..9 {
        if random.chance(0.4) {
            continue;
        }
        let centre = Point::new(0.25 * f64::from(cell % 3 - 1), 0.25 * f64::from(cell / 3 - 1));
        let mut outer = random.size(0.01, 0.11);
        let mut sign = -1.0;
        // A hole, perhaps an island in it, perhaps a pond on the island.
        for _ in 0..random.whole(1, 3) {
            let count = random.whole(8, 12);
            sketch.outline(star_points(random, count, centre, (0.6 * outer, outer)), sign);
            outer *= 0.4;
            sign = -sign;
        }
    }
}

fn components(random: &mut Random, sketch: &mut Sketch) {
    for i in 0..random.whole(2, 5) {
        let radius = random.size(1e-3, 1.0);
        let count = random.whole(5, 20);
        sketch.outline(star_points(random, count, Point::new(2.1 * f64::from(i), 0.0), (0.4 * radius, radius)), 1.0);
    }
}

/// A row of lozenges that share corners, perhaps with the outline on the left, too.
fn touching_holes(random: &mut Random, sketch: &mut Sketch) {
    let count = random.whole(2, 8);
    let half = random.size(1e-4, 0.8) / f64::from(count);
    let mut at = -1.0;
    let outline = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0), (-1.0, 0.0)].map(|(x, y)| Point::new(x, y));
    let mut ids: Vec<u32> = outline.into_iter().map(|p| sketch.add(p)).collect();
    let mut left = ids[4];
    if random.chance(0.5) {
        ids.pop();
        at = -0.9;
        left = sketch.add(Point::new(at, 0.0));
    }
    sketch.close(ids, 1.0);
    for _ in 0..count {
        let (middle, height) = (at + half, random.size(1e-5, 0.9));
        at += 2.0 * half;
        let [below, right, above] =
            [(middle, -height), (at, 0.0), (middle, height)].map(|(x, y)| sketch.add(Point::new(x, y)));
        sketch.close(vec![left, below, right, above], -1.0);
        left = right;
    }
}

/// A triangle or a strip of width 1e-6 and more.
fn sliver(random: &mut Random, sketch: &mut Sketch) {
    let width = random.size(1e-6, 1e-3);
    if random.chance(0.5) {
        let apex = Point::new(random.within(-0.5, 1.5), width);
        sketch.outline([Point::default(), Point::new(1.0, 0.0), apex], 1.0);
    } else {
        sketch.rectangle(Point::default(), Point::new(1.0, width), 1.0);
    }
}

/// Two rooms with a slot of width 1e-6 and more between them.
fn slot(random: &mut Random, sketch: &mut Sketch) {
    let (w, length) = (random.size(1e-6, 1e-2), random.within(0.1, 1.0));
    let right = 1.0 + length;
    let corners = [(0.0, -0.5), (1.0, -0.5), (1.0, 0.0), (right, 0.0), (right, -0.3), (right + 1.0, -0.3)];
    let more = [(right + 1.0, 0.8), (right, 0.8), (right, w), (1.0, w), (1.0, 0.5), (0.0, 0.5)];
    sketch.outline(corners.into_iter().chain(more).map(|(x, y)| Point::new(x, y)), 1.0);
}

/// Spikes of one degree on a small core.
fn spikes(random: &mut Random, sketch: &mut Sketch) {
    let count = random.whole(3, 12);
    let degree = TAU / 360.0 * random.size(0.1, 3.0);
    let length = random.within(0.5, 1.0);
    // The spike's sides meet at the angle; its feet lie on the core at this half-angle.
    let core = 0.1;
    let foot = (length - core) * (0.5 * degree).tan();
    let points = (0..count).flat_map(|i| {
        let angle = TAU * f64::from(i) / f64::from(count);
        let (out, across) = (polar(Point::default(), angle, 1.0) - Point::default(), foot);
        let side = out.perpendicular() * across;
        let base = Point::default() + out * core;
        [base + side * -1.0, Point::default() + out * length, base + side]
    });
    sketch.outline(points, 1.0);
}

/// A square with cracks: notches of one degree, and less, from the left.
fn notches(random: &mut Random, sketch: &mut Sketch) {
    let count = random.whole(1, 6);
    let mut points = vec![Point::default(), Point::new(1.0, 0.0), Point::new(1.0, 1.0), Point::new(0.0, 1.0)];
    for i in (0..count).rev() {
        let y = (f64::from(i) + 0.5) / f64::from(count);
        let (depth, half) = (random.within(0.2, 0.9), random.size(1e-7, 1e-2));
        points.extend([Point::new(0.0, y + half), Point::new(depth, y), Point::new(0.0, y - half)]);
    }
    sketch.outline(points, 1.0);
}

/// A grid of squares with gaps down to a billionth.
fn near_squares(random: &mut Random, sketch: &mut Sketch, sign: f64) {
    let gap = random.size(1e-9, 1e-5);
    let (columns, rows) = (random.whole(1, 4), random.whole(2, 4));
    for cell in 0..columns * rows {
        let min = Point::new(f64::from(cell % columns) * (0.2 + gap), f64::from(cell / columns) * (0.2 + gap));
        sketch.rectangle(min, min + Vector::new(0.2, 0.2), sign);
    }
}

fn near_islands(random: &mut Random, sketch: &mut Sketch) {
    near_squares(random, sketch, 1.0);
}

fn near_holes(random: &mut Random, sketch: &mut Sketch) {
    let margin = random.size(1e-7, 1.0);
    sketch.rectangle(Point::new(-margin, -margin), Point::new(1.5, 1.5), 1.0);
    near_squares(random, sketch, -1.0);
}

/// A channel that winds to the centre.
fn channel(random: &mut Random, sketch: &mut Sketch) {
    let (turns, width) = (random.within(0.5, 4.0), random.size(1e-4, 0.06));
    let steps = (turns * 32.0) as u32;
    let bank = |radius: f64| {
        let at = move |i: u32| TAU * turns * f64::from(i) / f64::from(steps);
        move |i: u32| polar(Point::default(), at(i), 0.1 + 0.2 * at(i) / TAU + radius)
    };
    let there = (0..=steps).map(bank(width));
    sketch.outline(there.chain((0..=steps).rev().map(bank(0.0))), 1.0);
}

fn thin_ring(random: &mut Random, sketch: &mut Sketch) {
    let (count, thin) = (random.whole(5, 40), 1.0 - random.size(1e-6, 1e-2));
    let at = |i: u32, radius: f64| polar(Point::default(), TAU * f64::from(i) / f64::from(count), radius);
    sketch.outline((0..count).map(|i| at(i, 1.0)), 1.0);
    sketch.outline((0..count).map(|i| at(i, thin)), -1.0);
}

/// A square with feature curves that end inside, start at the outline, or fork.
fn features(random: &mut Random, sketch: &mut Sketch) {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.5)].map(|(x, y)| Point::new(x, y));
    let ids = sketch.outline(corners, 1.0);
    sketch.regions.push((Point::new(0.999, 0.999), 5));
    let count = random.whole(1, 12);
    let at = |i: u32, random: &mut Random| {
        Point::new(0.1 + 0.8 * f64::from(i) / f64::from(count), 0.5 + random.within(-0.1, 0.1))
    };
    let mut curve: Vec<u32> = if random.chance(0.5) { vec![ids[4]] } else { Vec::new() };
    curve.extend((0..=count).map(|i| sketch.add(at(i, random))).collect::<Vec<_>>());
    sketch.open(&curve);
    // Branches from the middle, at small angles to each other.
    let root = curve[curve.len() / 2];
    let p = sketch.points[root as usize];
    let angle = random.size(1e-3, 0.3);
    for i in 0..random.whole(0, 3) {
        let tip = sketch.add(polar(p, 0.5 * std::f64::consts::PI + angle * f64::from(i), 0.35));
        sketch.open(&[root, tip]);
    }
}

/// A square cut into regions by curves from left to right, some of them close to each other.
fn regions(random: &mut Random, sketch: &mut Sketch) {
    let (layers, steps) = (random.whole(2, 6), random.whole(1, 10));
    let levels: Vec<f64> = (0..=layers)
        .scan(0.0, |height, _| {
            let here = *height;
            *height += random.size(1e-5, 1.0);
            Some(here)
        })
        .collect();
    let top = levels[levels.len() - 1];
    let wave: Vec<f64> = (0..=steps).map(|_| random.within(-0.2, 0.2)).collect();
    // All curves are copies of one, moved up: they never meet.
    let mut rows: Vec<Vec<u32>> = Vec::new();
    for level in levels {
        let at = |(i, w): (usize, &f64)| Point::new(i as f64 / f64::from(steps), level / top + w);
        rows.push(wave.iter().enumerate().map(at).map(|p| sketch.add(p)).collect());
    }
    for (label, pair) in (1..).zip(rows.windows(2)) {
        let [below, above] = [&pair[0], &pair[1]];
        let ends = [[below[0], above[0]], [below[below.len() - 1], above[above.len() - 1]]];
        sketch.segments.extend(ends);
        let [a, b] = [below[0], above[1]].map(|v| sketch.points[v as usize]);
        let [c, d] = [below[1], above[0]].map(|v| sketch.points[v as usize]);
        let centre = a.lerp(b, 0.5).lerp(c.lerp(d, 0.5), 0.5);
        sketch.regions.push((centre, label));
    }
    for row in &rows {
        sketch.open(row);
    }
    let mut around = rows[0].clone();
    around.extend(rows[rows.len() - 1].iter().rev());
    sketch.loops.push((around, 1.0));
}
