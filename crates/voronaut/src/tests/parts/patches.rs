//! Parts sewn from patches: each is a piece of the plane, triangulated there and then bent into space. Patches fit
//! because curves that two of them share are sampled at the same points.

use std::collections::HashMap;
use std::f64::consts::TAU;
use voronaut::geometry::{Orientation, Point, Point3, Vector3, orientation};
use voronaut::mesh::Mesh;
use voronaut::net::Random;
use voronaut::planar::{Planar, delaunay};
use voronaut::triangulation::{Constraint, VertexId};

/// A point of a patch's plane.
pub(crate) type Flat = [f64; 2];

/// How finely patches are cut up.
#[derive(Clone, Copy)]
pub(crate) struct Grain {
    /// The length of edges on curves, and inside, on average.
    pub(crate) edge: f64,
    /// As exporters do: no vertices on straight lines nor inside faces.
    pub(crate) is_cad: bool,
}

/// In long thin triangles things look so many times as large across as they are.
const STRETCH: f64 = 30.0;

impl Grain {
    fn parts(&self, length: f64) -> usize {
        // Two patches compute the length of the curve they share in two ways.
        ((length / self.edge - 1e-6).ceil() as usize).max(1)
    }

    /// Points of a straight line without its end.
    pub(crate) fn line(&self, from: Flat, to: Flat) -> Vec<Flat> {
        let count = if self.is_cad { 1 } else { self.parts((to[0] - from[0]).hypot(to[1] - from[1])) };
        between(from, to, count)
    }

    /// Angles that cut up an arc, without the last: at least eight for a circle.
    pub(crate) fn angles(&self, radius: f64, from: f64, to: f64) -> Vec<f64> {
        let turn = (to - from).abs();
        let count = self.parts(radius * turn).max((8.0 * turn / TAU).round() as usize);
        (0..count).map(|i| from + (to - from) * i as f64 / count as f64).collect()
    }
}

fn between(from: Flat, to: Flat, count: usize) -> Vec<Flat> {
    let at = |i: usize, k: usize| {
        if (to[k] - from[k]).abs() <= 0.0 { from[k] } else { from[k] + (to[k] - from[k]) * i as f64 / count as f64 }
    };
    (0..count).map(|i| [at(i, 0), at(i, 1)]).collect()
}

/// A plane in space: u along the first axis, v along the second, their cross product outwards.
#[derive(Clone, Copy)]
pub(crate) struct Plane {
    pub(crate) origin: Point3,
    pub(crate) axes: [Vector3; 2],
}

impl Plane {
    pub(crate) fn at(&self, [u, v]: Flat) -> Point3 {
        self.origin + self.axes[0] * u + self.axes[1] * v
    }

    pub(crate) fn flatten(&self, p: Point3) -> Flat {
        self.axes.map(|axis| axis.dot(p - self.origin))
    }
}

/// A surface in the making.
pub(crate) struct Sewing {
    pub(crate) grain: Grain,
    mesh: Mesh,
    found: HashMap<[i64; 3], u32>,
    random: Random,
}

/// Points are one if they are the same to this length.
const SAME: f64 = 1e-8;

impl Sewing {
    pub(crate) fn new(grain: Grain) -> Self {
        Self { grain, mesh: Mesh::default(), found: HashMap::new(), random: Random::new(9) }
    }

    /// The mesh.
    pub(crate) fn finish(mut self) -> Mesh {
        self.mesh.point_labels = vec![0; self.mesh.points.len()];
        self.mesh
    }

    /// Adds the part of a patch within closed outlines, holes among them. `at` bends it; it is a length but for little.
    pub(crate) fn patch(&mut self, label: i32, outlines: &[Vec<Flat>], at: impl Fn(Flat) -> Point3) {
        self.stretched(label, outlines, 1.0, at);
    }

    /// The same of a patch that is straight along v, where long triangles are no further from it than short ones.
    pub(crate) fn straight_patch(&mut self, label: i32, outlines: &[Vec<Flat>], at: impl Fn(Flat) -> Point3) {
        let stretch = if self.grain.is_cad { STRETCH } else { 1.0 };
        self.stretched(label, outlines, stretch, at);
    }

    fn stretched(&mut self, label: i32, outlines: &[Vec<Flat>], stretch: f64, at: impl Fn(Flat) -> Point3) {
        let mut points: Vec<Flat> = outlines.concat();
        if !self.grain.is_cad {
            points.extend(self.inside(outlines));
        }
        let numbers: Vec<u32> = points.iter().map(|&p| self.vertex(at(p))).collect();
        let flat: Vec<Point> = points.iter().map(|p| Point::new(p[0] * stretch, p[1])).collect();
        let mut planar = delaunay(&flat).expect("different points");
        let mut first = 0;
        for outline in outlines {
            constrain(&mut planar, first, outline.len() as u32);
            first += outline.len() as u32;
        }
        for f in planar.topology.faces() {
            let corners = planar.topology.corners(f).map(VertexId::index);
            if corners.iter().any(|&v| v >= points.len()) {
                continue;
            }
            let middle = [0, 1].map(|k| corners.iter().map(|&v| points[v][k]).sum::<f64>() / 3.0);
            let is_flat = orientation(flat[corners[0]], flat[corners[1]], flat[corners[2]]) != Orientation::Left;
            if is_inside(outlines, middle) && !is_flat {
                self.mesh.triangles.push(corners.map(|v| numbers[v]));
                self.mesh.triangle_labels.push(label);
            }
        }
    }

    /// The vertex there, a new one if there is none.
    pub(crate) fn vertex(&mut self, p: Point3) -> u32 {
        let next = self.mesh.points.len() as u32;
        let key = p.to_array().map(|x| (x / SAME).round() as i64);
        let number = *self.found.entry(key).or_insert(next);
        if number == next {
            self.mesh.points.push(p.to_array());
        }
        number
    }

    /// Marks a closed chain of edges with a label, and its first vertices of each part as corners if it has several.
    pub(crate) fn mark_edge(&mut self, ends: [Point3; 2], label: i32) {
        let ends = ends.map(|p| self.vertex(p));
        self.mesh.edges.push(ends);
        self.mesh.edge_labels.push(label);
    }

    pub(crate) fn mark_corner(&mut self, p: Point3) {
        let number = self.vertex(p);
        self.mesh.corners.push(number);
    }

    /// A triangular grid, shaken, well away from the outlines.
    fn inside(&mut self, outlines: &[Vec<Flat>]) -> Vec<Flat> {
        const SHAKE: f64 = 0.22;
        const AWAY: f64 = 0.55;
        let edge = self.grain.edge;
        let all = outlines.concat();
        let low = [0, 1].map(|k| all.iter().map(|p| p[k]).fold(f64::INFINITY, f64::min));
        let high = [0, 1].map(|k| all.iter().map(|p| p[k]).fold(f64::NEG_INFINITY, f64::max));
        let row = 0.75_f64.sqrt() * edge;
        let mut found = Vec::new();
        for j in 0..=((high[1] - low[1]) / row) as usize {
            for i in 0..=((high[0] - low[0]) / edge) as usize + 1 {
                // A vector in the disk of that radius, evenly.
                let (radius, angle) = (SHAKE * self.random.number().sqrt(), TAU * self.random.number());
                let shift = [radius * angle.cos(), radius * angle.sin()];
                let x = low[0] + edge * (i as f64 + 0.5 * (j % 2) as f64 + shift[0]);
                let y = low[1] + row * (j as f64 + 0.5) + edge * shift[1];
                if is_inside(outlines, [x, y]) && all_sides(outlines).all(|s| distance([x, y], s) > AWAY * edge) {
                    found.push([x, y]);
                }
            }
        }
        found
    }
}

fn constrain(planar: &mut Planar, first: u32, count: u32) {
    for i in 0..count {
        let ends = [i, (i + 1) % count].map(|i| VertexId(first + i));
        planar.constrain(ends[0], ends[1], Constraint(first + i)).expect("outlines do not cross");
    }
}

fn all_sides(outlines: &[Vec<Flat>]) -> impl Iterator<Item = [Flat; 2]> + '_ {
    outlines.iter().flat_map(|o| (0..o.len()).map(|i| [o[i], o[(i + 1) % o.len()]]))
}

/// By the parity of the sides that a ray crosses.
fn is_inside(outlines: &[Vec<Flat>], [x, y]: Flat) -> bool {
    let crosses =
        |[a, b]: &[Flat; 2]| (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
    all_sides(outlines).filter(crosses).count() % 2 == 1
}

fn distance(p: Flat, [a, b]: [Flat; 2]) -> f64 {
    let (d, e) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let t = ((d[0] * e[0] + d[1] * e[1]) / (d[0] * d[0] + d[1] * d[1])).clamp(0.0, 1.0);
    (e[0] - t * d[0]).hypot(e[1] - t * d[1])
}
