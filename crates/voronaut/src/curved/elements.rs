//! A curved mesh in the making: triangles by their Bezier points, what holds these, and which triangles are neighbours.

use super::bezier::{MOST, exponents, interior_of_sides, nodes_of_curve, side};
use super::jacobian::{Bound, bound};
use super::rules::Rule;
use crate::geometry::{Point, Vector};
use crate::lists::marked;
use crate::mesh::edges::{NONE, next};
use crate::mesh::{Curved, Edges, Mesh};

/// Halvings after which a triangle counts as not valid, while it is moved and in the end.
pub(crate) const HALVINGS: u32 = 8;

/// What holds a Bezier point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Hold {
    /// Nothing.
    Free,
    /// It slides on a straight part of the boundary, or of an interface, between corners.
    Along([Point; 2]),
    /// It stays.
    Fixed,
}

/// See the [module](self).
#[derive(Clone)]
pub(crate) struct Elements {
    pub(super) order: usize,
    /// Bezier points, the vertices first.
    pub(super) points: Vec<Point>,
    pub(super) holds: Vec<Hold>,
    pub(super) vertices: usize,
    /// The numbers of a triangle's Bezier points.
    pub(super) triangles: Vec<[u32; MOST]>,
    /// Of half-edges the ones on the other side; `NONE` on the boundary.
    pub(super) twins: Vec<u32>,
    /// Whether half-edges are of the boundary or an interface.
    pub(super) is_held: Vec<bool>,
}

impl Elements {
    /// The triangles of a straight mesh as such of order 2. Its corners stay, and so do its required vertices.
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let edges = Edges::of(&mesh.triangles);
        let is_fixed = marked(mesh.points.len(), mesh.corners.iter().chain(&mesh.required_points).copied());
        let straight = Straight::of(mesh, &is_fixed);
        let mut points: Vec<Point> = (0..mesh.points.len() as u32).map(|v| mesh.point(v)).collect();
        let mut holds: Vec<Hold> =
            (0..points.len()).map(|v| if is_fixed[v] { Hold::Fixed } else { straight.hold(v) }).collect();
        let mut triangles: Vec<[u32; MOST]> = mesh
            .triangles
            .iter()
            .map(|&[a, b, c]| {
                let mut numbers = [NONE; MOST];
                numbers[..3].copy_from_slice(&[a, b, c]);
                numbers
            })
            .collect();
        let mut is_held = vec![false; 3 * triangles.len()];
        for sides in edges.iter() {
            let ends = sides[0].ends;
            let along = straight.between(ends);
            for s in sides {
                is_held[s.half_edge as usize] = along.is_some();
                triangles[s.triangle()][3 + s.half_edge as usize % 3] = points.len() as u32;
            }
            points.push(mesh.point(ends[0]).midpoint(mesh.point(ends[1])));
            holds.push(along.map_or(Hold::Free, Hold::Along));
        }
        Self { order: 2, points, holds, vertices: mesh.points.len(), triangles, twins: edges.twins(), is_held }
    }

    /// How many Bezier points a triangle has.
    pub(super) fn count(&self) -> usize {
        exponents(self.order).len()
    }

    /// The numbers of a triangle's points.
    pub(super) fn numbers(&self, triangle: usize) -> &[u32] {
        &self.triangles[triangle][..self.count()]
    }

    /// The positions of a triangle's points among these.
    pub(super) fn of_triangle(&self, points: &[Point], triangle: usize) -> [Point; MOST] {
        let mut found = [Point::default(); MOST];
        for (p, &number) in found.iter_mut().zip(self.numbers(triangle)) {
            *p = points[number as usize];
        }
        found
    }

    /// The bound of a triangle's Jacobian, with its points among these.
    pub(super) fn bound(&self, points: &[Point], triangle: usize) -> Bound {
        bound(&self.of_triangle(points, triangle)[..self.count()], self.order, HALVINGS)
    }

    /// The numbers of the points of each side, of inner ones once, from the triangle with the lesser number.
    pub(super) fn sides(&self) -> impl Iterator<Item = Vec<u32>> {
        (0..3 * self.triangles.len())
            .filter(|&h| self.twins[h] == NONE || h < self.twins[h] as usize)
            .map(|h| self.side(h))
    }

    /// The numbers of the points of a half-edge.
    pub(super) fn side(&self, half_edge: usize) -> Vec<u32> {
        side(self.order, half_edge % 3).map(|i| self.triangles[half_edge / 3][i]).collect()
    }

    /// The same triangles by polynomials of order 3.
    #[must_use]
    pub(crate) fn raised(&self) -> Self {
        let mut raised = Self {
            order: 3,
            points: self.points[..self.vertices].to_vec(),
            holds: self.holds[..self.vertices].to_vec(),
            ..self.clone()
        };
        for h in (0..self.twins.len()).filter(|&h| self.twins[h] == NONE || h < self.twins[h] as usize) {
            let [a, b, c] = [0, 1, 2].map(|i| self.side(h)[i] as usize);
            let first = raised.points.len() as u32;
            for end in [a, c] {
                raised.points.push(self.points[end].lerp(self.points[b], 2.0 / 3.0));
                raised.holds.push(self.holds[b]);
            }
            raised.number_side(h, [first, first + 1]);
        }
        for t in 0..self.triangles.len() {
            raised.triangles[t][9] = raised.points.len() as u32;
            raised.points.push(Point::default());
            raised.holds.push(Hold::Free);
            let points = raised.of_triangle(&raised.points, t);
            *raised.points.last_mut().expect("one was added") = interior_of_sides(&points);
        }
        raised
    }

    /// Numbers the inner points of a cubic side, for both triangles.
    fn number_side(&mut self, half_edge: usize, [p, q]: [u32; 2]) {
        let at = |h: usize| (h / 3, 3 + 2 * (h % 3));
        let (t, start) = at(half_edge);
        (self.triangles[t][start], self.triangles[t][start + 1]) = (p, q);
        let twin = self.twins[half_edge];
        if twin != NONE {
            let (t, start) = at(twin as usize);
            (self.triangles[t][start], self.triangles[t][start + 1]) = (q, p);
        }
    }

    /// The vertices of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [u32; 3] {
        let t = &self.triangles[triangle];
        [t[0], t[1], t[2]]
    }

    /// A mesh with these triangles, and what else a mesh of the same vertices has.
    pub(crate) fn to_mesh(&self, like: &Mesh) -> Mesh {
        let mut mesh = like.clone();
        let space = |p: &Point| [p.x, p.y, 0.0];
        mesh.points = self.points[..self.vertices].iter().map(space).collect();
        mesh.triangles = (0..self.triangles.len()).map(|t| self.corners(t)).collect();
        let mut nodes: Vec<[f64; 3]> = self.points[self.vertices..].iter().map(space).collect();
        let first = self.vertices as u32;
        for numbers in self.sides() {
            let points: Vec<Point> = numbers.iter().map(|&n| self.points[n as usize]).collect();
            for (number, node) in numbers[1..].iter().zip(nodes_of_curve(&points)) {
                nodes[(number - first) as usize] = space(&self.within(*number, node));
            }
        }
        let middle = Rule::middle(self.order);
        for t in 0..self.triangles.len() * usize::from(self.order == 3) {
            let number = self.triangles[t][9] - first;
            nodes[number as usize] = space(&middle.image(&self.of_triangle(&self.points, t)));
        }
        let triangles = (0..self.triangles.len()).flat_map(|t| &self.numbers(t)[3..]).map(|n| n - first).collect();
        mesh.curved = Some(Curved { order: self.order, nodes, triangles });
        mesh
    }

    /// A place, put where what holds a point allows it.
    pub(super) fn within(&self, point: u32, place: Point) -> Point {
        match self.holds[point as usize] {
            Hold::Free => place,
            Hold::Fixed => self.points[point as usize],
            Hold::Along([a, b]) => place.nearest_between(a, b),
        }
    }

    /// The vertex that a half-edge leaves.
    pub(super) fn origin(&self, half_edge: usize) -> u32 {
        self.triangles[half_edge / 3][half_edge % 3]
    }

    /// The half-edges that leave the vertex that one leaves.
    pub(super) fn around(&self, start: usize) -> impl Iterator<Item = usize> {
        let on = |h: usize| (self.twins[h] != NONE).then(|| Self::next(self.twins[h] as usize));
        let back = |h: usize| {
            let twin = self.twins[Self::next(Self::next(h))];
            (twin != NONE).then_some(twin as usize)
        };
        let (mut found, mut at) = (vec![start], start);
        while let Some(h) = back(at).filter(|&h| h != start) {
            found.push(h);
            at = h;
        }
        if back(at).is_none() {
            at = start;
            while let Some(h) = on(at) {
                found.push(h);
                at = h;
            }
        }
        found.into_iter()
    }

    /// The half-edge after one around its triangle.
    pub(super) fn next(half_edge: usize) -> usize {
        next(half_edge as u32) as usize
    }
}

/// Straight parts of boundaries and interfaces: for each vertex on one its ends, and for each of their edges.
struct Straight<'a> {
    mesh: &'a Mesh,
    is_fixed: &'a [bool],
    /// The neighbours of each vertex along labelled edges.
    neighbours: Vec<Vec<u32>>,
}

impl<'a> Straight<'a> {
    fn of(mesh: &'a Mesh, is_fixed: &'a [bool]) -> Self {
        let mut neighbours = vec![Vec::new(); mesh.points.len()];
        for &[a, b] in &mesh.edges {
            neighbours[a as usize].push(b);
            neighbours[b as usize].push(a);
        }
        Self { mesh, is_fixed, neighbours }
    }

    fn hold(&self, vertex: usize) -> Hold {
        match self.neighbours[vertex][..] {
            [] => Hold::Free,
            [a, b] => Hold::Along([self.end(vertex as u32, a), self.end(vertex as u32, b)]),
            _ => Hold::Fixed,
        }
    }

    /// The ends of the part that an edge is of, if it is labelled.
    fn between(&self, [a, b]: [u32; 2]) -> Option<[Point; 2]> {
        self.neighbours[a as usize].contains(&b).then(|| [self.end(b, a), self.end(a, b)])
    }

    /// The corner at the end of the way that goes from one vertex over another.
    fn end(&self, mut from: u32, mut at: u32) -> Point {
        let start = from;
        while !self.is_fixed[at as usize] && at != start {
            let [a, b] = self.neighbours[at as usize][..] else { break };
            (from, at) = (at, if a == from { b } else { a });
        }
        self.mesh.point(at)
    }
}

/// The directions in which a point may move.
pub(super) fn axes(hold: Hold) -> impl Iterator<Item = Vector> {
    let axes = match hold {
        Hold::Free => [Some(Vector::new(1.0, 0.0)), Some(Vector::new(0.0, 1.0))],
        Hold::Along([a, b]) => [Some((b - a) * (1.0 / (b - a).norm())), None],
        Hold::Fixed => [None; 2],
    };
    axes.into_iter().flatten()
}
