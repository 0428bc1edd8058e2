//! Diagrams on surfaces: what their seeds are.

use super::ground::solver;
use super::seeds::Start;
use super::{Kind, Measure, SurfaceDiagram};
use crate::canvas::{Canvas, Draped};
use crate::error::Result;
use crate::geodesic::Method;
use crate::manifold::Place;
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

impl<'a> SurfaceDiagram<'a> {
    /// The diagram of seeds at vertices of a surface's canvas, by one of the methods.
    ///
    /// # Errors
    /// [`Error::Domain`](crate::Error::Domain) of a seed that is no canvas vertex; [`Error::Unsupported`](crate::Error::Unsupported) of a method that does not drive diagrams.
    pub(crate) fn on_surface(canvas: &'a Canvas<Draped<'a>>, seeds: &[VertexId], method: Method) -> Result<Self> {
        Self::of(Kind::Riemannian, canvas, seeds, method)
    }

    /// The diagram of a kind; a method is for the Riemannian one.
    ///
    /// # Errors
    /// Of a seed that is no canvas vertex; of a method that does not drive diagrams.
    pub fn of_kind_on_surface(
        kind: Kind,
        canvas: &'a Canvas<Draped<'a>>,
        seeds: &[VertexId],
        method: Method,
    ) -> Result<Self> {
        Self::of(kind, canvas, seeds, method)
    }

    /// The diagram of places of the surface, which need not be vertices of the canvas, by fast marching from the vertices around them,
    /// whose distances are along chords. Where a seed is the diagram knows of the nearest of these only.
    ///
    /// # Errors
    /// [`Error::Domain`](crate::Error::Domain) of a place off the surface.
    pub(crate) fn of_places(canvas: &'a Canvas<Draped<'a>>, places: &[Place]) -> Result<Self> {
        let homes = canvas.draped().homes();
        let around = |place: &Place| canvas.draped().around(place, &homes);
        let around: Vec<Vec<(VertexId, f64)>> =
            places.par_iter().with_min_len(16).map(around).collect::<Result<_>>()?;
        let start = |&(vertex, distance): &(VertexId, f64)| Start { vertex, distance };
        let starts: Vec<Vec<Start>> = around.iter().map(|found| found.iter().map(start).collect()).collect();
        let nearest = |found: &Vec<(VertexId, f64)>| found.iter().min_by(|x, y| x.1.total_cmp(&y.1)).map(|x| x.0);
        let seeds: Vec<VertexId> = around.iter().filter_map(nearest).collect();
        Ok(Self::made(canvas, &seeds, starts, Measure::Ways(solver(canvas, Method::March)?)))
    }

    /// The canvas.
    pub fn canvas(&self) -> &'a Canvas<Draped<'a>> {
        self.ground
    }
}
