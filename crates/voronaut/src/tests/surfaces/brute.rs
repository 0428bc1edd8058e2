//! On an ellipsoid and on a torus the dual is that of an independent one, by force: exact distances on the triangles from every seed to
//! all vertices around, by windows of straight ways (Chen and Han 1990), which bend at vertices with more than a full turn around them,
//! and where three of them are equal and no other is less.

use super::random::Random;
use crate::canvas::{Canvas, Kind, size_for};
use crate::diagram::SurfaceDiagram;
use crate::dual::Road;
use crate::geodesic::Method;
use crate::geometry::Tensor3;
use crate::lists::{distinct, in_order};
use crate::manifold::surface::Surface;
use crate::manifold::surface::metric::Constant;
use crate::manifold::{Manifold, Place};
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use crate::progress::Silent;
use crate::recipe::dual;
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::collections::{BTreeMap, HashMap};
use std::f64::consts::PI;

type Flat = [f64; 2];

fn cross(p: Flat, q: Flat) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

fn norm(p: Flat) -> f64 {
    p[0].hypot(p[1])
}

/// The third corner of a triangle, to the right of the way from a to b, by its distances to these.
fn beyond(a: Flat, b: Flat, to_a: f64, to_b: f64) -> Flat {
    let (x, y) = (b[0] - a[0], b[1] - a[1]);
    let length = x.hypot(y);
    let along = (to_a * to_a - to_b * to_b + length * length) / (2.0 * length);
    let across = (to_a * to_a - along * along).max(0.0).sqrt();
    [a[0] + (along * x + across * y) / length, a[1] + (along * y - across * x) / length]
}

/// An edge as it is seen straight on from a vertex, which is at the origin: its ends, counter-clockwise, and between which directions.
struct Window {
    edge: HalfEdge,
    ends: [Flat; 2],
    cone: [Flat; 2],
    /// How far the source is from that vertex.
    before: f64,
}

impl Window {
    /// The nearest that can be seen of the edge, at least.
    fn nearest(&self) -> f64 {
        let [a, b] = self.ends;
        let [right, left] = self.cone;
        if cross(right, left) <= NARROW * norm(right) * norm(left) {
            return f64::INFINITY;
        }
        let along = [b[0] - a[0], b[1] - a[1]];
        let at = |direction: Flat| cross(a, direction) / cross(direction, along);
        let foot = -(a[0] * along[0] + a[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        let [from, to] = self.cone.map(at);
        let t = foot.clamp(from.min(to), from.max(to));
        self.before + norm([a[0] + t * along[0], a[1] + t * along[1]])
    }
}

/// Directions this near to each other (radians) are one, and the windows on both sides of it see what lies there.
const NARROW: f64 = 1e-12;

/// Straight ways from a source, over unfolded triangles.
struct Wave<'a> {
    surface: &'a Surface,
    found: HashMap<VertexId, f64>,
    windows: Vec<Window>,
}

impl Wave<'_> {
    fn length(&self, u: VertexId, v: VertexId) -> f64 {
        self.surface.position(u).distance(self.surface.position(v))
    }

    /// The angle of a half-edge's face where it begins.
    fn angle(&self, h: HalfEdge) -> f64 {
        let t = self.surface.topology();
        let p = self.surface.position(t.origin(h));
        let [u, v] = [t.target(h), t.apex(h)].map(|w| self.surface.position(w) - p);
        u.cross(v).norm().atan2(u.dot(v))
    }

    /// A way has come to a vertex, which is so far from the source. If no other was shorter, and there is more than a full turn around
    /// it, ways go on from there with no less than half a turn on either side. It came in so far beyond a half-edge that leaves it.
    fn arrive(&mut self, v: VertexId, distance: f64, (first, turned): (HalfEdge, f64)) {
        let known = self.found.entry(v).or_insert(f64::INFINITY);
        if distance >= *known {
            return;
        }
        *known = distance;
        let t = self.surface.topology();
        let fan: Vec<HalfEdge> = t.star(v).collect();
        let start = fan.iter().position(|&h| h == first).expect("it leaves the vertex");
        let angles: Vec<f64> = fan.iter().map(|&h| self.angle(h)).collect();
        let [from, to] = [turned + PI, turned + angles.iter().sum::<f64>() - PI];
        let mut at = 0.0;
        for k in (start..start + fan.len()).map(|k| k % fan.len()) {
            let (low, high) = ((from - at).max(0.0), (to - at).min(angles[k]));
            at += angles[k];
            if low < high {
                self.look(fan[k], [low, high], distance);
            }
        }
    }

    /// Looks over the face of a half-edge from where it begins, between two angles from it.
    fn look(&mut self, h: HalfEdge, angles: [f64; 2], before: f64) {
        let t = self.surface.topology();
        let [v, a, b] = [t.origin(h), t.target(h), t.apex(h)];
        let (to_a, to_b, whole) = (self.length(v, a), self.length(v, b), self.angle(h));
        let direction = |angle: f64| [angle.cos(), angle.sin()];
        let ends = [[to_a, 0.0], direction(whole).map(|x| x * to_b)];
        self.windows.push(Window { edge: h.next(), ends, cone: angles.map(direction), before });
        if let Some(twin) = t.twin(h).filter(|_| angles[0] <= 0.0) {
            self.arrive(a, before + to_a, (twin, 0.0));
        }
    }

    /// Goes on beyond the edge of a window.
    fn pass(&mut self, window: &Window) {
        let t = self.surface.topology();
        let Some(twin) = t.twin(window.edge) else { return };
        let ([a, b], [right, left]) = (window.ends, window.cone);
        let (u, v, w) = (t.origin(window.edge), t.target(window.edge), t.apex(twin));
        let c = beyond(a, b, self.length(u, w), self.length(v, w));
        let (is_left_of_right, is_right_of_left) = (cross(right, c) >= 0.0, cross(c, left) >= 0.0);
        let through = |edge: HalfEdge, ends: [Flat; 2], cone: [Flat; 2]| Window { edge, ends, cone, ..*window };
        if is_left_of_right {
            self.windows.push(through(twin.next(), [a, c], [right, if is_right_of_left { c } else { left }]));
        }
        if is_right_of_left {
            self.windows.push(through(twin.prev(), [c, b], [if is_left_of_right { c } else { right }, left]));
        }
        // What two windows have between them is seen by one, at least.
        let is_within = |u: Flat, v: Flat| cross(u, v) >= -NARROW * norm(u) * norm(v);
        if is_within(right, c) && is_within(c, left) {
            let (back, side) = ([-c[0], -c[1]], [b[0] - c[0], b[1] - c[1]]);
            let turned = cross(side, back).atan2(side[0] * back[0] + side[1] * back[1]);
            self.arrive(w, window.before + norm(c), (twin.prev(), turned));
        }
    }
}

/// The distances of the vertices around one, as far as `reach`.
fn seen_from(surface: &Surface, source: VertexId, reach: f64) -> HashMap<VertexId, f64> {
    let mut wave = Wave { surface, found: HashMap::from([(source, 0.0)]), windows: Vec::new() };
    for h in surface.topology().star(source) {
        let whole = wave.angle(h);
        wave.look(h, [0.0, whole], 0.0);
    }
    while let Some(window) = wave.windows.pop() {
        if window.nearest() < reach {
            wave.pass(&window);
        }
    }
    wave.found.retain(|_, distance| *distance <= reach);
    wave.found
}

/// Triangles of seeds that meet in a face: three have the same distance there, no other a smaller one, by the share (of the squared
/// distance) that is told. Squares of distances to points of one plane differ by linear functions.
fn meetings(at_corners: [&[(u32, f64)]; 3], slack: f64) -> Vec<([u32; 3], f64)> {
    let nearest = at_corners.map(|list| list.iter().map(|e| e.1).fold(f64::INFINITY, f64::min));
    let at = |corner: usize, seed: u32| at_corners[corner].iter().find(|e| e.0 == seed).map(|e| e.1);
    let may_win = |e: &&(u32, f64)| (0..3).any(|k| at(k, e.0).is_some_and(|d| d <= nearest[k] + slack));
    let squares = |&(seed, _): &(u32, f64)| Some((seed, [at(0, seed)?, at(1, seed)?, at(2, seed)?].map(|d| d * d)));
    let near: Vec<(u32, [f64; 3])> = at_corners[0].iter().filter(may_win).filter_map(squares).collect();
    let value = |q: [f64; 3], [s, t]: Flat| q[0] + s * (q[1] - q[0]) + t * (q[2] - q[0]);
    let mut found = Vec::new();
    for (i, a) in near.iter().enumerate() {
        for (j, b) in near.iter().enumerate().skip(i + 1) {
            for c in &near[j + 1..] {
                let row = |other: [f64; 3]| [0, 1, 2].map(|k| other[k] - a.1[k]);
                let (p, q) = (row(b.1), row(c.1));
                let (u, v) = ([p[1] - p[0], p[2] - p[0]], [q[1] - q[0], q[2] - q[0]]);
                let determinant = cross(u, v);
                let x = [(q[0] * u[1] - p[0] * v[1]) / determinant, (p[0] * v[0] - q[0] * u[0]) / determinant];
                let is_inside = x[0] >= -1e-9 && x[1] >= -1e-9 && x[0] + x[1] <= 1.0 + 1e-9;
                if is_inside {
                    let own = value(a.1, x);
                    let others = near.iter().filter(|e| ![a.0, b.0, c.0].contains(&e.0));
                    let gap = others.map(|e| value(e.1, x) / own - 1.0).fold(f64::INFINITY, f64::min);
                    found.extend((gap >= 0.0).then_some((in_order([a.0, b.0, c.0]), gap)));
                }
            }
        }
    }
    found
}

/// All triangles of the seeds' dual, each with the share by which a fourth seed misses it.
fn by_force(surface: &Surface, seeds: &[VertexId]) -> BTreeMap<[u32; 3], f64> {
    let spacing = (surface.area() / seeds.len() as f64).sqrt();
    let each: Vec<_> = seeds.par_iter().map(|&seed| seen_from(surface, seed, 4.0 * spacing)).collect();
    let mut at: Vec<Vec<(u32, f64)>> = vec![Vec::new(); surface.positions().len()];
    for (seed, found) in (0..).zip(each) {
        for (v, distance) in found {
            at[v.index()].push((seed, distance));
        }
    }
    let t = surface.topology();
    let faces: Vec<FaceId> = t.faces().collect();
    let of_face = |&f: &FaceId| {
        let [a, b, c] = surface.triangle(f);
        let slack = 2.0 * a.distance(b).max(b.distance(c)).max(c.distance(a));
        meetings(t.corners(f).map(|v| at[v.index()].as_slice()), slack)
    };
    faces.par_iter().map(of_face).collect::<Vec<_>>().into_iter().flatten().collect()
}

/// A surface of so many vertices at least, and seeds at random ones.
fn seeded(surface: &Surface, count: usize) -> Vec<VertexId> {
    let mut random = Random(88_172_645_463_325_252);
    let vertices = surface.positions().len();
    let mut seeds = distinct((0..count).map(|_| VertexId((random.next() * vertices as f64) as u32)));
    while seeds.len() < count {
        seeds.push(VertexId((random.next() * vertices as f64) as u32));
        seeds = distinct(seeds);
    }
    seeds
}

/// An ellipsoid with edges of about so long a part of the unit.
fn ellipsoid(fineness: f64) -> Manifold {
    let sphere = Manifold::shape("sphere:1", Some(fineness)).unwrap().surface().to_mesh();
    let points = sphere.points.iter().map(|&[x, y, z]| [x, 0.7 * y, 0.5 * z]).collect();
    Manifold::new(Surface::new(&Mesh { points, ..sphere }).unwrap(), None)
}

fn compare(manifold: &Manifold, count: usize) {
    let seeds = seeded(manifold.surface(), count);
    let forced = by_force(manifold.surface(), &seeds);
    let metric = Constant(Tensor3::IDENTITY);
    let places: Vec<Place> = seeds.iter().map(|&v| manifold.place_of(v).unwrap()).collect();
    let size = size_for(places.len(), 20);
    let (canvas, at) = Canvas::on_surface(Kind::Intrinsic, manifold, &metric, size, &places).unwrap();
    let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::March).unwrap();
    let ours = distinct(dual(&diagram, Road::Both, &Silent).triangles.into_iter().map(in_order));
    let wrong: Vec<_> = forced.iter().filter(|(t, _)| ours.binary_search(t).is_err()).collect();
    let clearly = wrong.iter().filter(|(_, gap)| **gap > 1e-3).count();
    let expected = (2 * (seeds.len().cast_signed() - manifold.surface().euler_characteristic())) as usize;
    let others = ours.iter().filter(|t| !forced.contains_key(*t)).count();
    println!(
        "{} vertices; of {expected} triangles {} by force and {} ours; {} missing ({clearly} above 1e-3), {others} others",
        manifold.positions().len(),
        forced.len(),
        ours.len(),
        wrong.len()
    );
    assert!(clearly == 0, "{wrong:?}");
    assert!(ours.len() == expected && forced.len() * 1000 > 995 * expected);
    let ties = forced.values().filter(|gap| **gap <= 1e-3).count() + expected.saturating_sub(forced.len());
    assert!(others <= 2 * ties, "{others} others, {ties} ties");
}

#[test]
fn duals_on_an_ellipsoid_are_those_that_force_finds() {
    for (fineness, count) in [(0.06, 300), (0.02, 3000)] {
        compare(&ellipsoid(fineness), count);
    }
}

#[test]
fn duals_on_a_torus_are_those_that_force_finds() {
    let torus = Manifold::shape("torus:2,0.7", Some(0.04)).unwrap();
    compare(&Manifold::new(torus.surface().clone(), None), 3000);
}

#[test]
fn ways_around_the_edges_of_a_cube_are_unfolded() {
    let corner = |i: u32| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)];
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let (points, labels) = ((0..8).map(corner).collect(), (vec![0; 8], vec![0; 12]));
    let mesh = Mesh { points, triangles, point_labels: labels.0, triangle_labels: labels.1, ..Mesh::default() };
    let found = seen_from(&Surface::new(&mesh).unwrap(), VertexId(0), 3.0);
    for (v, expected) in [(1, 1.0), (2, 1.0), (3, 2.0_f64), (5, 2.0), (6, 2.0), (7, 5.0)] {
        assert!((found[&VertexId(v)] - expected.sqrt()).abs() < 1e-14, "{v}: {found:?}");
    }
}

#[test]
fn ways_bend_at_saddles() {
    // Six squares around a vertex, those below half a turn apart: along the edge between them and along the axis, or around.
    let ring = [
        [1, 0, 0],
        [1, 1, 0],
        [0, 1, 0],
        [-1, 1, 0],
        [-1, 0, 0],
        [-1, 0, 1],
        [0, 0, 1],
        [0, -1, 1],
        [0, -1, 0],
        [1, -1, 0],
    ];
    let points = [[0; 3]].into_iter().chain(ring).map(|p: [i32; 3]| p.map(f64::from)).collect();
    let triangles = (1..=10).map(|i| [0, i, i % 10 + 1]).collect();
    let mesh = Mesh { points, triangles, ..Mesh::default() };
    let surface = Surface::new(&mesh).unwrap();
    let found = seen_from(&surface, VertexId(2), 3.0);
    let square = |v: u32| found[&VertexId(v)].powi(2);
    // Straight over flat squares, and over the vertex in the middle.
    for (v, expected) in [(0, 2.0), (5, 5.0), (9, 5.0)] {
        assert!((square(v) - expected).abs() < 1e-14, "{v}: {found:?}");
    }
    assert!((found[&VertexId(7)] - (2.0_f64.sqrt() + 1.0)).abs() < 1e-14, "{found:?}");
}
