//! On an ellipsoid the dual is that of an independent one, by force: exact distances on the triangles from every seed to all vertices
//! around, by windows of straight ways (Chen and Han 1990), and where three of them are equal and no other is less. (Where a surface is
//! a saddle, as a torus is inside, shortest ways bend at vertices, of which windows know nothing.)

use super::random::Random;
use crate::canvas::{Canvas, Kind, size_for};
use crate::diagram::SurfaceDiagram;
use crate::dual::Road;
use crate::geodesic::Method;
use crate::geometry::Tensor3;
use crate::lists::{distinct, in_order};
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use crate::progress::Silent;
use crate::recipe::surface_dual;
use crate::surface::metric::Constant;
use crate::surface::{Input, Place, Surface};
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::collections::{BTreeMap, HashMap};

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

/// An edge as it is seen straight on from the source, which is at the origin: its ends, counter-clockwise, and between which
/// directions.
struct Window {
    edge: HalfEdge,
    ends: [Flat; 2],
    cone: [Flat; 2],
}

impl Window {
    /// The nearest that can be seen of the edge, at least.
    fn nearest(&self) -> f64 {
        let [a, b] = self.ends;
        let along = [b[0] - a[0], b[1] - a[1]];
        let at = |direction: Flat| cross(a, direction) / cross(direction, along);
        let foot = -(a[0] * along[0] + a[1] * along[1]) / (along[0] * along[0] + along[1] * along[1]);
        let [from, to] = self.cone.map(at);
        let t = foot.clamp(from.min(to), from.max(to));
        norm([a[0] + t * along[0], a[1] + t * along[1]])
    }
}

/// The distances of the vertices that are seen from one over unfolded triangles, as far as `reach`.
fn seen_from(surface: &Surface, source: VertexId, reach: f64) -> HashMap<VertexId, f64> {
    let t = surface.topology();
    let length = |u: VertexId, v: VertexId| surface.position(u).distance(surface.position(v));
    let mut found: HashMap<VertexId, f64> = HashMap::from([(source, 0.0)]);
    let mut windows: Vec<Window> = Vec::new();
    for h in t.star(source) {
        let [u, v] = [t.target(h), t.apex(h)];
        let a = [length(source, u), 0.0];
        found.insert(u, a[0]);
        // To the left of the way from the origin to a.
        let b = beyond(a, [0.0; 2], length(u, v), length(source, v));
        windows.push(Window { edge: h.next(), ends: [a, b], cone: [a, b] });
    }
    while let Some(window) = windows.pop() {
        let Some(twin) = t.twin(window.edge).filter(|_| window.nearest() < reach) else { continue };
        let ([a, b], [right, left]) = (window.ends, window.cone);
        let (u, v, w) = (t.origin(window.edge), t.target(window.edge), t.apex(twin));
        let c = beyond(a, b, length(u, w), length(v, w));
        let (is_left_of_right, is_right_of_left) = (cross(right, c) >= 0.0, cross(c, left) >= 0.0);
        if is_left_of_right && is_right_of_left {
            let known = found.entry(w).or_insert(f64::INFINITY);
            *known = known.min(norm(c));
        }
        let through = |edge: HalfEdge, ends: [Flat; 2], cone: [Flat; 2]| Window { edge, ends, cone };
        if is_left_of_right {
            windows.push(through(twin.next(), [a, c], [right, if is_right_of_left { c } else { left }]));
        }
        if is_right_of_left {
            windows.push(through(twin.prev(), [c, b], [if is_left_of_right { c } else { right }, left]));
        }
    }
    found.retain(|_, distance| *distance <= reach);
    found
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
fn ellipsoid(fineness: f64) -> Input {
    let sphere = Input::shape("sphere:1", Some(fineness)).unwrap().surface.to_mesh();
    let points = sphere.points.iter().map(|&[x, y, z]| [x, 0.7 * y, 0.5 * z]).collect();
    Input::new(Surface::new(&Mesh { points, ..sphere }).unwrap(), None)
}

fn compare(input: &Input, count: usize) {
    let seeds = seeded(&input.surface, count);
    let forced = by_force(&input.surface, &seeds);
    let metric = Constant(Tensor3::IDENTITY);
    let places: Vec<Place> = seeds.iter().map(|&v| input.surface.place_of(v).unwrap()).collect();
    let size = size_for(places.len(), 20);
    let (canvas, at) = Canvas::on_surface(Kind::Intrinsic, input, &metric, size, &places).unwrap();
    let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::March).unwrap();
    let ours = distinct(surface_dual(&diagram, Road::Both, &Silent).triangles.into_iter().map(in_order));
    let wrong: Vec<_> = forced.iter().filter(|(t, _)| ours.binary_search(t).is_err()).collect();
    let clearly = wrong.iter().filter(|(_, gap)| **gap > 1e-3).count();
    let expected = (2 * (seeds.len().cast_signed() - input.surface.euler_characteristic())) as usize;
    let others = ours.iter().filter(|t| !forced.contains_key(*t)).count();
    println!(
        "{} vertices; of {expected} triangles {} by force and {} ours; {} missing ({clearly} above 1e-3), {others} others",
        input.surface.positions().len(),
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
fn duals_are_those_that_force_finds() {
    for (fineness, count) in [(0.06, 300), (0.02, 3000)] {
        compare(&ellipsoid(fineness), count);
    }
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
