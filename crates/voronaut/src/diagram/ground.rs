//! What a diagram lies on: a canvas of the plane or of a surface, with the metric it was made with.

use super::kind::Chords;
use super::lattice;
use super::seeds::{self, Care, Start};
use super::{Measure, Seed, SurfaceDiagram};
use crate::canvas::{Canvas, Draped, StarSet};
use crate::error::{Error, Result};
use crate::geodesic::{Dijkstra, Geodesic, Graph, Konukoglu, Marching, Method, Propagation, Stvd};
use crate::geometry::Point;
use crate::metric::MetricField;
use crate::triangulation::{Triangulation, VertexId};
use std::convert::Infallible;

/// A canvas with its metric. All that a diagram knows of the plane or of a surface it knows through this.
pub trait Ground<'a>: Copy + Send + Sync {
    /// Where a seed can be.
    type Place: Copy + Send + Sync;
    /// How distances that are straight come about, where there are any.
    type Straight: Straight<'a, Self> + Send + Sync;

    /// What distances travel on.
    fn topology(&self) -> &'a Triangulation;
    /// The same vertices, triangulated where they are: what is drawn.
    fn embedded(&self) -> &'a Triangulation;
    /// The stars, if it is a star set.
    fn stars(&self) -> Option<&'a StarSet>;
    /// Where a canvas vertex is.
    fn place(&self, v: VertexId) -> Self::Place;
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

/// Distances that do not follow the canvas.
pub trait Straight<'a, G: Ground<'a>> {
    /// The distance of a place from a seed.
    fn length(&self, ground: G, seed: G::Place, place: G::Place) -> f64;
    /// Every canvas vertex with its nearest seed.
    fn propagate(&self, ground: G, seeds: &[Option<Seed<G::Place>>]) -> Propagation;
}

/// A canvas of the plane.
#[derive(Clone, Copy)]
pub struct Flat<'a> {
    pub(super) canvas: &'a Canvas,
    pub(super) field: &'a dyn MetricField,
}

impl<'a> Ground<'a> for Flat<'a> {
    type Place = Point;
    type Straight = Chords;

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

    fn graph(&self) -> Graph {
        self.canvas.graph(self.field)
    }

    fn starts(&self, seed: Point) -> Result<Vec<Start>> {
        seeds::starts(self.canvas, self.field, seed)
    }

    fn starts_of_all(&self, seeds: &[Point], are_vertices: bool, care: Care) -> Result<Vec<Vec<Start>>> {
        seeds::starts_of_all(self.canvas, self.field, seeds, are_vertices, care)
    }

    fn starts_at_vertex(&self, v: VertexId, care: Care) -> Vec<Start> {
        seeds::starts_at_vertex(self.canvas, self.field, v, care)
    }

    fn on_lattice(&self, from: &[Point], starts: &[Vec<Start>]) -> Result<Vec<f64>> {
        Ok(lattice::distances(self.canvas, self.field, from, starts))
    }
}

/// A canvas of a surface has its metric with it, and seeds are vertices of it: the canvas was made with them.
impl<'a> Ground<'a> for &'a Canvas<Draped<'a>> {
    type Place = VertexId;
    type Straight = Infallible;

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
        let (what, lbr) = ("distances by lbr on a surface, which has no Cartesian grid".into(), Method::Lbr);
        let others: Vec<&str> = Method::ALL.iter().filter(|&&m| m != lbr).map(|m| m.name()).collect();
        Err(Error::Unsupported { what, help: format!("use one of {}", others.join(", ")) })
    }
}

impl<'a, G: Ground<'a>> Straight<'a, G> for Infallible {
    fn length(&self, _ground: G, _seed: G::Place, _place: G::Place) -> f64 {
        match *self {}
    }

    fn propagate(&self, _ground: G, _seeds: &[Option<Seed<G::Place>>]) -> Propagation {
        match *self {}
    }
}

impl<'a> SurfaceDiagram<'a> {
    /// The diagram of seeds at vertices of a surface's canvas, by one of the methods.
    ///
    /// # Errors
    /// [`Error::Domain`] of a seed that is no canvas vertex; [`Error::Unsupported`] of a method that does not drive diagrams.
    pub fn on_surface(canvas: &'a Canvas<Draped<'a>>, seeds: &[VertexId], method: Method) -> Result<Self> {
        method.demand_diagrams()?;
        let starts = canvas.starts_of_all(seeds, false, Care::Full)?;
        Ok(Self::made(canvas, seeds, starts, Measure::Ways(solver(canvas, method)?)))
    }

    /// The canvas.
    pub fn canvas(&self) -> &'a Canvas<Draped<'a>> {
        self.ground
    }
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
