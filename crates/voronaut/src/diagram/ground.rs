//! What a diagram lies on: a canvas of the plane or of a surface, with the metric it was made with.

use super::seeds::{self, Care, Start};
use super::{Flat, Frozen};
use crate::canvas::{Border, Canvas, Draped, StarSet};
use crate::error::{Error, Result};
use crate::geodesic::{Dijkstra, Geodesic, Graph, Konukoglu, Lattice, Marching, Method, Sources, Stvd, layout};
use crate::geometry::{Aabb, Point, Point3, TangentPlane, Tensor};
use crate::planar::Location;
use crate::triangulation::{FaceId, Triangulation, VertexId};

/// A canvas with its metric. All that a diagram knows of the plane or of a surface it knows through this.
pub trait Ground<'a>: Copy + Send + Sync {
    /// Where a seed can be.
    type Place: Copy + Send + Sync;

    /// What distances travel on.
    fn topology(&self) -> &'a Triangulation;
    /// The same vertices, triangulated where they are: what is drawn.
    fn embedded(&self) -> &'a Triangulation;
    /// The stars, if it is a star set.
    fn stars(&self) -> Option<&'a StarSet>;
    /// Where a canvas vertex is.
    fn place(&self, v: VertexId) -> Self::Place;
    /// The coordinates of a canvas vertex.
    fn coordinates(&self, v: VertexId) -> [f64; 3];
    /// Where a place is in space, with its tangent plane and the metric there.
    fn frozen(&self, place: Self::Place) -> Frozen;
    /// The label that the domain or the surface has where a face of [`Ground::embedded`] is.
    fn region(&self, f: FaceId) -> i32;
    /// The corners of a face of [`Ground::embedded`], laid out in the plane.
    fn triangle(&self, f: FaceId) -> [Point; 3];
    /// The metric at a place of a face, as that is laid out.
    fn metric(&self, at: Point) -> Tensor;
    /// What methods without triangles travel on.
    fn graph(&self) -> Graph;
    /// The starts of a seed.
    ///
    /// # Errors
    /// The seed is outside the domain.
    fn starts(&self, seed: Self::Place) -> Result<Vec<Start>>;
    /// The starts of seeds, which may be the vertices of a mesh of the domain.
    ///
    /// # Errors
    /// A seed is outside the domain.
    fn starts_of_all(&self, seeds: &[Self::Place], are_vertices: bool, care: Care) -> Result<Vec<Vec<Start>>>;
    /// The starts of a seed at a canvas vertex.
    fn starts_at_vertex(&self, v: VertexId, care: Care) -> Vec<Start>;
    /// The distances of all canvas vertices from places with these starts by [`Method::Lbr`].
    ///
    /// # Errors
    /// [`Error::Unsupported`] where there is no grid.
    fn on_lattice(&self, from: &[Self::Place], starts: &[Vec<Start>]) -> Result<Vec<f64>>;
}

impl<'a> Ground<'a> for Flat<'a> {
    type Place = Point;

    fn topology(&self) -> &'a Triangulation {
        self.canvas.topology()
    }

    fn embedded(&self) -> &'a Triangulation {
        &self.canvas.embedded().topology
    }

    fn stars(&self) -> Option<&'a StarSet> {
        self.canvas.stars()
    }

    fn place(&self, v: VertexId) -> Point {
        self.canvas.position(v)
    }

    fn coordinates(&self, v: VertexId) -> [f64; 3] {
        let Point { x, y } = self.canvas.position(v);
        [x, y, 0.0]
    }

    fn frozen(&self, p: Point) -> Frozen {
        Frozen { at: Point3::new(p.x, p.y, 0.0), plane: TangentPlane::FLAT, tensor: self.field.at(p) }
    }

    fn region(&self, f: FaceId) -> i32 {
        self.embedded().region(f)
    }

    fn triangle(&self, f: FaceId) -> [Point; 3] {
        self.canvas.embedded().triangle(f)
    }

    fn metric(&self, at: Point) -> Tensor {
        self.field.at(at)
    }

    fn graph(&self) -> Graph {
        self.canvas.graph(self.field)
    }

    fn starts(&self, seed: Point) -> Result<Vec<Start>> {
        let location = self.canvas.locate(seed).ok_or_else(|| seeds::outside(seed.to_string()))?;
        Ok(seeds::starts_in(*self, seed, &seeds::places(self.canvas, location), Care::Full))
    }

    fn starts_of_all(&self, seeds: &[Point], are_vertices: bool, care: Care) -> Result<Vec<Vec<Start>>> {
        seeds::starts_of_all(*self, seeds, are_vertices, care)
    }

    fn starts_at_vertex(&self, v: VertexId, care: Care) -> Vec<Start> {
        seeds::starts_in(*self, self.place(v), &seeds::places(self.canvas, Location::Vertex(v)), care)
    }

    /// By FM-LBR on as many nodes as the canvas has vertices; vertices in sight of a point have the length of the way
    /// there.
    fn on_lattice(&self, from: &[Point], starts: &[Vec<Start>]) -> Result<Vec<f64>> {
        let Flat { canvas, field } = *self;
        let positions = &canvas.embedded().positions;
        let Some(bounds) = Aabb::of(positions.iter().copied()) else { return Ok(Vec::new()) };
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
        Ok(values)
    }
}

/// A canvas of a surface has its metric with it, and seeds are vertices of it: the canvas was made with them.
impl<'a> Ground<'a> for &'a Canvas<Draped<'a>> {
    type Place = VertexId;

    fn topology(&self) -> &'a Triangulation {
        Canvas::topology(*self)
    }

    fn embedded(&self) -> &'a Triangulation {
        self.draped().topology()
    }

    fn stars(&self) -> Option<&'a StarSet> {
        Canvas::stars(*self)
    }

    fn place(&self, v: VertexId) -> VertexId {
        v
    }

    fn coordinates(&self, v: VertexId) -> [f64; 3] {
        self.draped().position(v).to_array()
    }

    fn frozen(&self, v: VertexId) -> Frozen {
        let (draped, plane) = (self.draped(), self.draped().plane(v));
        Frozen { at: draped.position(v), plane, tensor: plane.restrict(draped.tensor(v)) }
    }

    fn region(&self, f: FaceId) -> i32 {
        self.draped().manifold().topology().region(self.draped().home(f))
    }

    /// By its metric lengths, in which the metric is Euclidean.
    fn triangle(&self, f: FaceId) -> [Point; 3] {
        let [base, to_end, to_start] = f.half_edges().map(|h| self.embedded().length(h));
        let (x, y) = layout(base, to_start, to_end);
        [Point::default(), Point::new(base, 0.0), Point::new(x, y)]
    }

    fn metric(&self, _at: Point) -> Tensor {
        Tensor::IDENTITY
    }

    fn graph(&self) -> Graph {
        self.surface_graph()
    }

    fn starts(&self, seed: VertexId) -> Result<Vec<Start>> {
        if seed.index() < self.vertex_count() {
            return Ok(self.starts_at_vertex(seed, Care::Full));
        }
        let help = "seeds on a surface are vertices of its canvas";
        Err(Error::domain("a seed that is no canvas vertex", format!("vertex {}", seed.0), help))
    }

    fn starts_of_all(&self, seeds: &[VertexId], _are_vertices: bool, _care: Care) -> Result<Vec<Vec<Start>>> {
        seeds.iter().map(|&seed| self.starts(seed)).collect()
    }

    fn starts_at_vertex(&self, vertex: VertexId, _care: Care) -> Vec<Start> {
        vec![Start { vertex, distance: 0.0 }]
    }

    fn on_lattice(&self, _from: &[VertexId], _starts: &[Vec<Start>]) -> Result<Vec<f64>> {
        let what = "distances by lbr on a surface, which has no Cartesian grid";
        let others = Method::names(|method| method != Method::Lbr);
        Err(Error::unsupported(what, format!("use one of {others}")))
    }
}

/// The sources that seeds with these starts make, in the order of their colours.
pub(super) fn sources<'a, G: Ground<'a>>(ground: G, starts: &[Vec<Start>]) -> Sources {
    let mut sources = Sources::new(ground.topology().vertex_slots());
    for (colour, starts) in starts.iter().enumerate() {
        for start in starts {
            sources.add(start.vertex, start.distance, colour as u32);
        }
    }
    sources
}

/// A method on what of a canvas it travels on.
///
/// # Errors
/// [`Error::Unsupported`] of a method that does not drive diagrams.
pub(super) fn solver<'a, G: Ground<'a>>(ground: G, method: Method) -> Result<Box<dyn Geodesic + 'a>> {
    method.demand_diagrams()?;
    Ok(match method {
        Method::March | Method::Lbr | Method::Heat => Box::new(Marching::on(ground.topology())),
        Method::Stvd { window } => Box::new(Stvd::on(ground.graph(), window)),
        Method::Dijkstra => Box::new(Dijkstra(ground.graph())),
        Method::Konukoglu => Box::new(Konukoglu(ground.graph())),
    })
}
