//! Distances from given points by any of the methods, and the ways back.

use super::assemble::to_mesh;
use super::descend::{At, Descent};
use super::seeds::{Care, Start};
use super::{Diagram, Flat, Ground, Measure, solver, sources};
use crate::canvas::{Border, Canvas, Draped, Way};
use crate::error::{Error, Result};
use crate::geodesic::{Heat, MarchCounters, Method, Polyline, bowed_chord, straighten};
use crate::geometry::{Point, Point3};
use crate::mesh::Mesh;
use crate::metric::MetricField;
use crate::triangulation::{FaceId, VertexId};

/// A place on an edge: its ends, and the share of the way from the first to the second; a vertex twice for that.
type OnEdge = ([VertexId; 2], f64);

/// The distance of every canvas vertex from the nearest of given places: of the plane, or a [`SurfaceDistances`].
pub struct Distances<'a, G: Ground<'a> = Flat<'a>> {
    ground: G,
    method: Method,
    from: Vec<G::Place>,
    starts: Vec<Vec<Start>>,
    values: Vec<f64>,
    parents: Vec<Option<VertexId>>,
    counters: Option<MarchCounters>,
}

impl<'a, G: Ground<'a>> Distances<'a, G> {
    fn by_method(ground: G, from: &[G::Place], method: Method) -> Result<Self> {
        let starts = ground.starts_of_all(from, false, Care::Full)?;
        let (values, parents, counters) = match method {
            Method::Lbr => (ground.on_lattice(from, &starts)?, Vec::new(), None),
            Method::Heat => (Heat::on(ground.topology())?.distances(&sources(ground, &starts))?, Vec::new(), None),
            _ => {
                let ways = Measure::Ways(solver(ground, method)?);
                let diagram = Diagram::made(ground, from, starts.clone(), ways);
                let parents = diagram.vertices().map(|v| diagram.parent(v)).collect();
                (diagram.vertices().map(|v| diagram.distance(v)).collect(), parents, Some(*diagram.counters()))
            }
        };
        Ok(Self { ground, method, from: from.to_vec(), starts, values, parents, counters })
    }

    /// The metric distances of the canvas vertices, in order; infinite where no point is reached.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Work of the method, where it propagates.
    pub fn counters(&self) -> Option<&MarchCounters> {
        self.counters.as_ref()
    }

    /// The vertex that a vertex has its distance from, where the method knows one: it is nearer.
    pub(crate) fn parent(&self, v: VertexId) -> Option<VertexId> {
        self.parents.get(v.index()).copied().flatten()
    }

    /// What goes down these distances.
    fn descend<T>(&self, go: impl FnOnce(&Descent<'_, G>) -> T) -> T {
        let distance = |v: VertexId| self.values[v.index()];
        go(&Descent { ground: self.ground, distance: &distance, parent: &|v| self.parent(v) })
    }

    /// The lines of equal distance at these distances: pieces within embedded canvas faces, by where they begin and end.
    fn pieces<'b>(&'b self, levels: &'b [f64]) -> impl Iterator<Item = [OnEdge; 2]> + 'b {
        let embedded = self.ground.embedded();
        let corners = move |f: FaceId| embedded.corners(f).map(|v| (v, self.values[v.index()]));
        let reached = embedded.faces().map(corners).filter(|corners| corners.iter().all(|c| c.1.is_finite()));
        reached.flat_map(|corners| levels.iter().filter_map(move |&level| piece(corners, level)))
    }

    /// The embedded canvas as a mesh with the distances of its points, and with a path, by its points and their distances, as
    /// labelled edges between points of its own, behind the others. Points are labelled 0, those of the path 1.
    fn mesh_with(&self, along: &[[f64; 3]], distances: impl Iterator<Item = f64>) -> (Mesh, Vec<f64>) {
        let first = self.values.len() as u32;
        let segments = along.len().saturating_sub(1) as u32;
        let mut mesh = Mesh {
            point_labels: [vec![0; first as usize], vec![1; along.len()]].concat(),
            edges: (first..first + segments).map(|v| [v, v + 1]).collect(),
            edge_labels: vec![1; segments as usize],
            ..to_mesh(self.ground)
        };
        mesh.points.extend(along);
        (mesh, self.values.iter().copied().chain(distances).collect())
    }
}

impl<'a> Distances<'a> {
    /// Distances by a method from points of the domain.
    ///
    /// # Errors
    /// [`crate::Error::Domain`] of a point outside the domain; [`crate::Error::Unsupported`] where rounding leaves heat no factor.
    pub fn new(canvas: &'a Canvas, field: &'a dyn MetricField, from: &[Point], method: Method) -> Result<Self> {
        Self::by_method(Flat { canvas, field }, from, method)
    }

    /// The distance of a point of the domain, interpolated in the canvas face that holds it as in flat space; where all its
    /// corners see the same one of the given points, the length of the way straight there. `None` outside the domain,
    /// infinite where no point is reached.
    pub fn at(&self, p: Point) -> Option<f64> {
        let weights = self.ground.canvas.weights(p)?;
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
        let straight = beside.map(|(&q, _)| bowed_chord(self.ground.field, q, p));
        straight.min_by(f64::total_cmp).or(Some(between))
    }

    /// Metric length of a side of a face.
    fn side(&self, v: VertexId, u: VertexId) -> f64 {
        let topology = self.ground.embedded();
        topology.edge_between(v, u).map_or(0.0, |h| topology.length(h))
    }

    /// The way from a point of the domain to the nearest of the given points: with [`Method::March`] the geodesic
    /// ([`super::Paths::geodesic`]); else down the method's own distances, by M^-1 grad d in each face and by parents where
    /// that does not lead on, as good as these distances are.
    ///
    /// # Errors
    /// [`crate::Error::Domain`] of a point outside the domain, or one from where the distances lead to none of the points.
    pub fn path(&self, to: Point) -> Result<Polyline> {
        let Flat { canvas, field } = self.ground;
        let seeds: Vec<(Point, &[Start])> =
            self.from.iter().zip(&self.starts).map(|(&at, starts)| (at, starts.as_slice())).collect();
        let points = self.descend(|descent| descent.polyline(to, &seeds))?;
        if self.method == Method::March {
            return Ok(straighten(field, &points, &Border::of(canvas)));
        }
        Ok(Polyline { length: Polyline::length_of(field, &points), points })
    }

    /// The canvas as a mesh with the distances of its points, and with a path as labelled edges between points of its own,
    /// behind the others, if there is one. Points are labelled 0, those of the path 1.
    pub fn to_mesh(&self, path: Option<&Polyline>) -> (Mesh, Vec<f64>) {
        let along: &[Point] = path.map_or(&[], |path| &path.points);
        let flat: Vec<[f64; 3]> = along.iter().map(|p| [p.x, p.y, 0.0]).collect();
        self.mesh_with(&flat, along.iter().map(|&p| self.at(p).unwrap_or(f64::INFINITY)))
    }

    /// The lines of equal distance at these distances: pieces within canvas faces, two points each.
    pub fn isolines(&self, levels: &[f64]) -> Vec<[Point; 2]> {
        let canvas = self.ground.canvas;
        let at = |([a, b], t): OnEdge| canvas.position(a).lerp(canvas.position(b), t);
        self.pieces(levels).map(|piece| piece.map(at)).collect()
    }
}

/// The distance of every vertex of a surface's canvas from the nearest of given vertices.
pub type SurfaceDistances<'a> = Distances<'a, &'a Canvas<Draped<'a>>>;

impl<'a> SurfaceDistances<'a> {
    /// Distances by a method from vertices of a surface's canvas, which was made with them.
    ///
    /// # Errors
    /// [`Error::Domain`] of what is no canvas vertex; [`Error::Unsupported`] of [`Method::Lbr`];
    /// [`Error::Unsupported`] where rounding leaves heat no factor.
    pub fn on_surface(canvas: &'a Canvas<Draped<'a>>, from: &[VertexId], method: Method) -> Result<Self> {
        Self::by_method(canvas, from, method)
    }

    /// The way from a canvas vertex to the nearest of the given ones: with [`Method::March`] the geodesic
    /// (pulled taut on the canvas); else down the method's own distances, by their gradient in each face and by parents where that
    /// does not lead on, as good as these distances are.
    ///
    /// # Errors
    /// [`Error::Domain`] where the distances lead to none of the given vertices.
    pub fn path(&self, to: VertexId) -> Result<Way> {
        let draped = self.ground.draped();
        let way = if self.method == Method::March {
            let back = std::iter::successors(Some(to), |&v| self.parent(v)).last();
            back.filter(|last| self.from.contains(last)).and_then(|last| draped.geodesic(to, last))
        } else {
            self.descend(|descent| draped.way_along(self.down(descent, to)?))
        };
        way.ok_or_else(|| {
            let help = "take a point of the surface that is reached, or a finer canvas";
            Error::domain("no way from there", draped.position(to).to_string(), help)
        })
    }

    /// From a vertex down to a corner of a face that is one of the given vertices.
    fn down(&self, descent: &Descent<'_, &'a Canvas<Draped<'a>>>, from: VertexId) -> Option<Vec<OnEdge>> {
        let topology = self.ground.embedded();
        let is_given = |v: &VertexId| self.from.contains(v);
        let (way, end) = descent.trace(At::Vertex(from), |at| match at {
            At::Vertex(v) => Some(v).filter(is_given),
            At::Face(_, f, _) => topology.corners(f).into_iter().find(is_given),
        })?;
        let on_edge = |at: At| match at {
            At::Vertex(v) => ([v, v], 0.0),
            At::Face(p, f, entered) => {
                let h = entered.unwrap_or(f.half_edges()[0]);
                let [a, b, _] = descent.corners(h);
                (topology.ends(h), a.distance(p) / a.distance(b))
            }
        };
        let mut on: Vec<OnEdge> = way.into_iter().chain([At::Vertex(end)]).map(on_edge).collect();
        on.dedup();
        Some(on)
    }

    /// The distance of a point of an edge, interpolated as in flat space.
    fn on_edge(&self, ([a, b], t): OnEdge) -> f64 {
        let [at_a, at_b] = [a, b].map(|v| self.values[v.index()]);
        let length = self.ground.draped().length_between(a, b);
        ((1.0 - t) * at_a * at_a + t * at_b * at_b - t * (1.0 - t) * length * length).max(0.0).sqrt()
    }

    /// The canvas as a mesh with the distances of its points, and with a path as labelled edges between points of its own,
    /// behind the others, if there is one. Points are labelled 0, those of the path 1; triangles as those of the surface.
    pub fn to_mesh(&self, path: Option<&Way>) -> (Mesh, Vec<f64>) {
        let along: Vec<[f64; 3]> = path.iter().flat_map(|path| &path.points).map(|p| p.to_array()).collect();
        self.mesh_with(&along, path.iter().flat_map(|path| &path.on).map(|&on| self.on_edge(on)))
    }

    /// The lines of equal distance at these distances: pieces within the triangles of the canvas, two points each.
    pub fn isolines(&self, levels: &[f64]) -> Vec<[Point3; 2]> {
        let draped = self.ground.draped();
        let at = |([a, b], t): OnEdge| draped.position(a).lerp(draped.position(b), t);
        self.pieces(levels).map(|piece| piece.map(at)).collect()
    }
}

/// Where a function that is linear on a triangle has a value.
fn piece(corners: [(VertexId, f64); 3], level: f64) -> Option<[OnEdge; 2]> {
    let [a, b, c] = corners;
    let crossing = |(p, at_p): (VertexId, f64), (q, at_q): (VertexId, f64)| {
        ((at_p < level) != (at_q < level)).then(|| ([p, q], (level - at_p) / (at_q - at_p)))
    };
    let mut found = [crossing(a, b), crossing(b, c), crossing(c, a)].into_iter().flatten();
    Some([found.next()?, found.next()?])
}
