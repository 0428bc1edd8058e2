//! Distances from given points by any of the methods, and the ways back.

use super::descend::Descent;
use super::seeds::{self, Care, Start};
use super::{Diagram, Flat, solver};
use crate::canvas::{Border, Canvas};
use crate::error::Result;
use crate::geodesic::{Heat, Lattice, MarchCounters, Method, Polyline, Sources, bowed_chord, straighten};
use crate::geometry::{Aabb, Point};
use crate::mesh::Mesh;
use crate::metric::MetricField;
use crate::triangulation::VertexId;

/// The distance of every canvas vertex from the nearest of given points.
pub struct Distances<'a> {
    canvas: &'a Canvas,
    field: &'a dyn MetricField,
    method: Method,
    from: Vec<Point>,
    starts: Vec<Vec<Start>>,
    values: Vec<f64>,
    parents: Vec<Option<VertexId>>,
    counters: Option<MarchCounters>,
}

impl<'a> Distances<'a> {
    /// Distances by a method from points of the domain.
    ///
    /// # Errors
    /// [`crate::Error::Domain`] of a point outside the domain; as for [`Heat::on`].
    pub fn new(canvas: &'a Canvas, field: &'a dyn MetricField, from: &[Point], method: Method) -> Result<Self> {
        let starts = seeds::starts_of_all(canvas, field, from, false, Care::Full)?;
        let (values, parents, counters) = match method {
            Method::Lbr => (on_lattice(canvas, field, from, &starts), Vec::new(), None),
            Method::Heat => (Heat::on(canvas.topology())?.distances(&sources(canvas, &starts))?, Vec::new(), None),
            _ => {
                let solver = solver(Flat { canvas, field }, method)?;
                let diagram = Diagram::from_starts(canvas, field, from, starts.clone(), solver);
                let vertices = || (0..canvas.vertex_count() as u32).map(VertexId);
                let parents = vertices().map(|v| diagram.parent(v)).collect();
                (vertices().map(|v| diagram.distance(v)).collect(), parents, Some(*diagram.counters()))
            }
        };
        Ok(Self { canvas, field, method, from: from.to_vec(), starts, values, parents, counters })
    }

    /// The metric distances of the canvas vertices, in order; infinite where no point is reached.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// How they were computed.
    pub fn method(&self) -> Method {
        self.method
    }

    /// Work of the method, where it propagates.
    pub fn counters(&self) -> Option<&MarchCounters> {
        self.counters.as_ref()
    }

    /// The vertex that a vertex has its distance from, where the method knows one: it is nearer.
    pub fn parent(&self, v: VertexId) -> Option<VertexId> {
        self.parents.get(v.index()).copied().flatten()
    }

    /// The distance of a point of the domain, interpolated in the canvas face that holds it as in flat space; where all its
    /// corners see the same one of the given points, the length of the way straight there. `None` outside the domain,
    /// infinite where no point is reached.
    pub fn at(&self, p: Point) -> Option<f64> {
        let weights = self.canvas.weights(p)?;
        // In flat space: the sum of w d^2 less that of w_i w_j |v_i v_j|^2 over the sides.
        let mut square: f64 = weights.iter().map(|&(v, weight)| weight * self.values[v.index()].powi(2)).sum();
        for (i, &(v, of_v)) in weights.iter().enumerate() {
            for &(u, of_u) in &weights[..i] {
                square -= of_v * of_u * self.side(v, u).powi(2);
            }
        }
        let between = square.max(0.0).sqrt();
        let beside = self.from.iter().zip(&self.starts).filter(|(_, starts)| {
            let is_start = |v: VertexId| starts.iter().any(|start| start.vertex == v);
            weights.iter().all(|&(v, _)| is_start(v))
        });
        let straight = beside.map(|(&q, _)| bowed_chord(self.field, q, p));
        straight.min_by(f64::total_cmp).or(Some(between))
    }

    /// Metric length of a side of a face.
    fn side(&self, v: VertexId, u: VertexId) -> f64 {
        let topology = &self.canvas.embedded().topology;
        topology.find(v, u).or_else(|| topology.find(u, v)).map_or(0.0, |h| topology.length(h))
    }

    /// The way from a point of the domain to the nearest of the given points: with [`Method::March`] the geodesic
    /// ([`super::Paths::geodesic`]); else down the method's own distances, by M^-1 grad d in each face and by parents where
    /// that does not lead on, as good as these distances are.
    ///
    /// # Errors
    /// [`crate::Error::Domain`] of a point outside the domain, or one from where the distances lead to none of the points.
    pub fn path(&self, to: Point) -> Result<Polyline> {
        let seeds: Vec<(Point, &[Start])> =
            self.from.iter().zip(&self.starts).map(|(&at, starts)| (at, starts.as_slice())).collect();
        let distance = |v: VertexId| self.values[v.index()];
        let parent = |v: VertexId| self.parent(v);
        let descent =
            Descent { canvas: self.canvas, field: self.field, seeds: &seeds, distance: &distance, parent: &parent };
        let points = descent.trace(to)?;
        if self.method == Method::March {
            return Ok(straighten(self.field, &points, &Border::of(self.canvas)));
        }
        Ok(Polyline { length: Polyline::length_of(self.field, &points), points })
    }

    /// The canvas as a mesh with the distances of its points, and with a path as labelled edges between points of its own,
    /// behind the others, if there is one. Points are labelled 0, those of the path 1.
    pub fn to_mesh(&self, path: Option<&Polyline>) -> (Mesh, Vec<f64>) {
        let embedded = self.canvas.embedded();
        let along: &[Point] = path.map_or(&[], |path| &path.points);
        let first = embedded.positions.len() as u32;
        let segments = along.len().saturating_sub(1) as u32;
        let faces = || embedded.topology.faces();
        let mesh = Mesh {
            points: embedded.positions.iter().chain(along).map(|p| [p.x, p.y, 0.0]).collect(),
            point_labels: [vec![0; embedded.positions.len()], vec![1; along.len()]].concat(),
            triangles: faces().map(|f| embedded.topology.corners(f).map(|v| v.0)).collect(),
            triangle_labels: faces().map(|f| embedded.topology.region(f)).collect(),
            edges: (first..first + segments).map(|v| [v, v + 1]).collect(),
            edge_labels: vec![1; segments as usize],
            ..Mesh::default()
        };
        let of_path = along.iter().map(|&p| self.at(p).unwrap_or(f64::INFINITY));
        (mesh, self.values.iter().copied().chain(of_path).collect())
    }

    /// The lines of equal distance at these distances: pieces within canvas faces, two points each.
    pub fn isolines(&self, levels: &[f64]) -> Vec<[Point; 2]> {
        let embedded = self.canvas.embedded();
        let mut pieces = Vec::new();
        for f in embedded.topology.faces() {
            let corners = embedded.topology.corners(f).map(|v| (self.canvas.position(v), self.values[v.index()]));
            if corners.iter().all(|c| c.1.is_finite()) {
                pieces.extend(levels.iter().filter_map(|&level| piece(corners, level)));
            }
        }
        pieces
    }
}

/// By [`Lattice`] on as many nodes as the canvas has vertices; vertices in sight of a point have the length of the way there.
fn on_lattice(canvas: &Canvas, field: &dyn MetricField, from: &[Point], starts: &[Vec<Start>]) -> Vec<f64> {
    let positions = &canvas.embedded().positions;
    let Some(bounds) = Aabb::of(positions.iter().copied()) else { return Vec::new() };
    let extent = bounds.extent();
    // What of the box is outside the domain costs no nodes.
    let nodes = positions.len() as f64 * (extent.x * extent.y / canvas.embedded().area()).min(100.0);
    let border = Border::of(canvas);
    let is_inside = |points: &[Point]| canvas.locate_all(points).iter().map(Option::is_some).collect();
    let mut values = Lattice::new(bounds, nodes as usize, field, is_inside, &border).distances(from, positions);
    for start in starts.iter().flatten() {
        let value = &mut values[start.vertex.index()];
        *value = value.min(start.distance);
    }
    values
}

fn sources(canvas: &Canvas, starts: &[Vec<Start>]) -> Sources {
    let mut sources = Sources::new(canvas.vertex_count());
    for (colour, starts) in starts.iter().enumerate() {
        for start in starts {
            sources.add(start.vertex, start.distance, colour as u32);
        }
    }
    sources
}

/// Where a function that is linear on a triangle has a value.
fn piece(corners: [(Point, f64); 3], level: f64) -> Option<[Point; 2]> {
    let [a, b, c] = corners;
    let crossing = |(p, at_p): (Point, f64), (q, at_q): (Point, f64)| {
        ((at_p < level) != (at_q < level)).then(|| p.lerp(q, (level - at_p) / (at_q - at_p)))
    };
    let mut found = [crossing(a, b), crossing(b, c), crossing(c, a)].into_iter().flatten();
    Some([found.next()?, found.next()?])
}
