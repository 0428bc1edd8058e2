//! A curved mesh in the making: triangles by their Bezier points, what holds these, and which triangles are neighbours.

use super::bezier::{MOST, exponents, interior_of_sides, nodes_of_curve, side};
use super::jacobian::{Bound, bound};
use super::rules::Rule;
use crate::geometry::{Point, Vector};
use crate::lists::{in_order, marked};
use crate::mesh::edges::{NONE, edges_of, next};
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
    /// Of each vertex the one of the straight mesh that it was; `NONE` of those that came later.
    pub(super) sources: Vec<u32>,
    /// The numbers of a triangle's Bezier points.
    pub(super) triangles: Vec<[u32; MOST]>,
    /// Triangles' labels.
    pub(super) labels: Vec<i32>,
    /// Of half-edges the ones on the other side; `NONE` on the boundary.
    pub(super) twins: Vec<u32>,
    /// Of half-edges the labelled edges of the straight mesh that they are of; `NONE` elsewhere.
    pub(super) held: Vec<u32>,
}

/// A vertex by itself.
#[derive(Clone, Copy)]
pub(super) struct Vertex {
    pub(super) place: Point,
    pub(super) hold: Hold,
    pub(super) source: u32,
}

/// What a side of a triangle is of: a labelled edge of the straight mesh, `NONE` inside, and whether it is bent onto a curve, where it stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Side {
    pub(super) held: u32,
    pub(super) is_bent: bool,
}

impl Side {
    /// A side inside.
    pub(super) const FREE: Self = Self { held: NONE, is_bent: false };
}

/// A triangle by itself: its vertices, its Bezier points, what its sides are of, and its label.
#[derive(Clone, Copy)]
pub(super) struct Loose {
    pub(super) corners: [u32; 3],
    pub(super) points: [Point; MOST],
    pub(super) sides: [Side; 3],
    pub(super) label: i32,
}

impl Elements {
    /// The triangles of a straight mesh as such of order 2. Its corners stay, and so do its required vertices.
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let is_fixed = marked(mesh.points.len(), mesh.corners.iter().chain(&mesh.required_points).copied());
        let straight = Straight::of(mesh, &is_fixed);
        let vertex = |v: u32| {
            let hold = if is_fixed[v as usize] { Hold::Fixed } else { straight.hold(v) };
            Vertex { place: mesh.point(v), hold, source: v }
        };
        let vertices: Vec<Vertex> = (0..mesh.points.len() as u32).map(vertex).collect();
        let mut labelled: Vec<([u32; 2], u32)> = (0..).zip(&mesh.edges).map(|(i, &ends)| (in_order(ends), i)).collect();
        labelled.sort_unstable();
        let label_of = |ends: [u32; 2]| {
            let at = labelled.binary_search_by_key(&in_order(ends), |entry| entry.0);
            at.map_or(NONE, |at| labelled[at].1)
        };
        let loose = |(&corners, &label): (&[u32; 3], &i32)| {
            let [a, b, c] = mesh.corners_of(corners);
            let mut points = [Point::default(); MOST];
            points[..6].copy_from_slice(&[a, b, c, a.midpoint(b), b.midpoint(c), c.midpoint(a)]);
            let sides = edges_of(corners).map(|ends| Side { held: label_of(ends), is_bent: false });
            Loose { corners, points, sides, label }
        };
        let triangles: Vec<Loose> = mesh.triangles.iter().zip(&mesh.triangle_labels).map(loose).collect();
        Self::assembled(2, &vertices, &triangles)
    }

    /// Those of vertices and triangles by themselves; sides have the points of the first triangle that has them.
    pub(super) fn assembled(order: usize, vertices: &[Vertex], loose: &[Loose]) -> Self {
        let corners: Vec<[u32; 3]> = loose.iter().map(|t| t.corners).collect();
        let edges = Edges::of(&corners);
        let mut found = Self {
            order,
            points: vertices.iter().map(|v| v.place).collect(),
            holds: vertices.iter().map(|v| v.hold).collect(),
            sources: vertices.iter().map(|v| v.source).collect(),
            triangles: vec![[NONE; MOST]; loose.len()],
            labels: loose.iter().map(|t| t.label).collect(),
            twins: edges.twins(),
            held: loose.iter().flat_map(|t| t.sides.map(|side| side.held)).collect(),
        };
        for sides in edges.iter() {
            let first = found.points.len() as u32;
            let half_edge = sides[0].half_edge as usize;
            let triangle = &loose[half_edge / 3];
            let hold = found.hold(triangle, half_edge);
            let numbers: Vec<u32> = (first..).take(order - 1).collect();
            for i in side(order, half_edge % 3).skip(1).take(order - 1) {
                found.points.push(triangle.points[i]);
                found.holds.push(hold);
            }
            found.number_side(half_edge, &numbers);
        }
        for (numbers, triangle) in found.triangles.iter_mut().zip(loose) {
            numbers[..3].copy_from_slice(&triangle.corners);
            if order == 3 {
                numbers[9] = found.points.len() as u32;
                found.points.push(triangle.points[9]);
                found.holds.push(Hold::Free);
            }
        }
        found
    }

    /// What holds the inner points of a side: of a labelled one the straight part that an end slides on, or else that between both ends.
    fn hold(&self, triangle: &Loose, half_edge: usize) -> Hold {
        let side = triangle.sides[half_edge % 3];
        if side.is_bent || side.held == NONE {
            return if side.is_bent { Hold::Fixed } else { Hold::Free };
        }
        let ends = edges_of(triangle.corners)[half_edge % 3].map(|v| v as usize);
        let slides =
            ends.into_iter().find_map(|v| if let Hold::Along(line) = self.holds[v] { Some(line) } else { None });
        Hold::Along(slides.unwrap_or(ends.map(|v| self.points[v])))
    }

    /// The triangles by themselves.
    pub(super) fn loose(&self) -> Vec<Loose> {
        let is_bent = |h: usize| self.holds[self.side(h)[1] as usize] == Hold::Fixed;
        let one = |t: usize| Loose {
            corners: self.corners(t),
            points: self.of_triangle(&self.points, t),
            sides: [3 * t, 3 * t + 1, 3 * t + 2].map(|h| Side { held: self.held[h], is_bent: is_bent(h) }),
            label: self.labels[t],
        };
        (0..self.triangles.len()).map(one).collect()
    }

    /// The vertices by themselves.
    pub(super) fn loose_vertices(&self) -> Vec<Vertex> {
        let one = |v: usize| Vertex { place: self.points[v], hold: self.holds[v], source: self.sources[v] };
        (0..self.sources.len()).map(one).collect()
    }

    /// How many vertices there are.
    pub(super) fn vertices(&self) -> usize {
        self.sources.len()
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
        let raise = |mut triangle: Loose| {
            let old = triangle.points;
            for s in 0..3 {
                let ends = [s, (s + 1) % 3];
                for (i, end) in ends.into_iter().enumerate() {
                    triangle.points[3 + 2 * s + i] = old[end].lerp(old[3 + s], 2.0 / 3.0);
                }
            }
            triangle.points[9] = interior_of_sides(&triangle.points);
            triangle
        };
        let triangles: Vec<Loose> = self.loose().into_iter().map(raise).collect();
        Self::assembled(3, &self.loose_vertices(), &triangles)
    }

    /// Numbers the inner points of a side, for both triangles.
    fn number_side(&mut self, half_edge: usize, numbers: &[u32]) {
        let at = |h: usize| (h / 3, 3 + numbers.len() * (h % 3));
        let (t, start) = at(half_edge);
        self.triangles[t][start..start + numbers.len()].copy_from_slice(numbers);
        let twin = self.twins[half_edge];
        if twin != NONE {
            let (t, start) = at(twin as usize);
            let there = &mut self.triangles[t][start..start + numbers.len()];
            there.copy_from_slice(numbers);
            there.reverse();
        }
    }

    /// The vertices of a triangle.
    pub(super) fn corners(&self, triangle: usize) -> [u32; 3] {
        let t = &self.triangles[triangle];
        [t[0], t[1], t[2]]
    }

    /// The mesh: its labels are those of the straight mesh that it was.
    pub(crate) fn to_mesh(&self, straight: &Mesh) -> Mesh {
        let space = |p: &Point| [p.x, p.y, 0.0];
        let count = self.vertices();
        let mut now = vec![NONE; straight.points.len()];
        for (v, &source) in (0..).zip(&self.sources).filter(|(_, source)| **source != NONE) {
            now[source as usize] = v;
        }
        let of_list = |list: &[u32]| list.iter().map(|&v| now[v as usize]).collect();
        let label = |&source: &u32| if source == NONE { 0 } else { straight.point_labels[source as usize] };
        let mut mesh = Mesh {
            points: self.points[..count].iter().map(space).collect(),
            point_labels: self.sources.iter().map(label).collect(),
            triangles: (0..self.triangles.len()).map(|t| self.corners(t)).collect(),
            triangle_labels: self.labels.clone(),
            corners: of_list(&straight.corners),
            required_points: of_list(&straight.required_points),
            ..Mesh::default()
        };
        self.add_edges(straight, &mut mesh);
        mesh.curved = Some(self.nodes());
        mesh
    }

    /// Labelled edges, each in the direction of the one that it is of.
    fn add_edges(&self, straight: &Mesh, mesh: &mut Mesh) {
        let required = marked(straight.edges.len(), straight.required_edges.iter().copied());
        let once = (0..self.twins.len()).filter(|&h| self.twins[h] == NONE || h < self.twins[h] as usize);
        for h in once.filter(|&h| self.held[h] != NONE) {
            let source = self.held[h] as usize;
            let [a, b] = [h, Self::next(h)].map(|h| self.origin(h));
            let [from, to] = straight.edges[source].map(|v| straight.point(v));
            let is_along = (to - from).dot(mesh.point(b) - mesh.point(a)) > 0.0;
            if required[source] {
                mesh.required_edges.push(mesh.edges.len() as u32);
            }
            mesh.edges.push(if is_along { [a, b] } else { [b, a] });
            mesh.edge_labels.push(straight.edge_labels[source]);
        }
    }

    /// The nodes of the triangles.
    fn nodes(&self) -> Curved {
        let space = |p: Point| [p.x, p.y, 0.0];
        let first = self.vertices() as u32;
        let mut nodes = vec![[0.0; 3]; self.points.len() - self.vertices()];
        for numbers in self.sides() {
            let points: Vec<Point> = numbers.iter().map(|&n| self.points[n as usize]).collect();
            for (&number, node) in numbers[1..].iter().zip(nodes_of_curve(&points)) {
                nodes[(number - first) as usize] = space(self.within(number, node));
            }
        }
        let middle = Rule::middle(self.order);
        for t in 0..self.triangles.len() * usize::from(self.order == 3) {
            let number = self.triangles[t][9] - first;
            nodes[number as usize] = space(middle.image(&self.of_triangle(&self.points, t)));
        }
        let triangles = (0..self.triangles.len()).flat_map(|t| &self.numbers(t)[3..]).map(|n| n - first).collect();
        Curved { order: self.order, nodes, triangles }
    }

    /// A place, put where what holds a point allows it.
    pub(super) fn within(&self, point: u32, place: Point) -> Point {
        match self.holds[point as usize] {
            Hold::Free | Hold::Fixed => place,
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

    fn hold(&self, vertex: u32) -> Hold {
        match self.neighbours[vertex as usize][..] {
            [] => Hold::Free,
            [a, b] => Hold::Along([self.end(vertex, a), self.end(vertex, b)]),
            _ => Hold::Fixed,
        }
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
pub(super) fn axes(hold: Hold) -> impl Iterator<Item = Vector> + Clone {
    let axes = match hold {
        Hold::Free => [Some(Vector::new(1.0, 0.0)), Some(Vector::new(0.0, 1.0))],
        Hold::Along([a, b]) => [Some((b - a) * (1.0 / (b - a).norm())), None],
        Hold::Fixed => [None; 2],
    };
    axes.into_iter().flatten()
}
