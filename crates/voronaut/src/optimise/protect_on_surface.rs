//! Protecting the seeds of a surface: places are tried in charts around simplices, and the mesh's own triangles are measured. Edges at borders
//! are not, and seeds there, and on features, stay.

use super::protect::{Protected, Protecting, protected};
use super::trials::{Found, Search, Stand};
use crate::dual::{Kind, Moving, SurfaceDual};
use crate::error::Result;
use crate::geodesic::LocalMetric;
use crate::geometry::{Point, Vector};
use crate::lists::distinct;
use crate::manifold::Place;
use crate::manifold::surface::metric::Scaled;
use crate::net::{Memory, Net, SeedsOnSurface, Terrain, View};
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::triangulation::{Triangulation, VertexId};

/// Rings of seeds around one that circles of its triangles, and of those that touch its neighbours, depend on.
const RINGS: usize = 3;

/// Protects the seeds of a surface's dual.
///
/// # Errors
/// None: seeds that the metric is not valid at do not move.
pub(crate) fn protect_on_surface(
    dual: &mut SurfaceDual,
    share: f64,
    progress: &dyn Progress,
) -> Result<Protected<Place>> {
    let metric = Scaled { field: dual.metric(), factor: dual.factor() };
    let seeds = SeedsOnSurface::new(dual.manifold(), &metric, dual.places().to_vec());
    let mut ground = OnSurface { dual, seeds, memory: Memory::default() };
    let protected = protected(&mut ground, share, progress)?;
    let net = Net::on_surface(&ground.seeds, &ground.dual.triangles(), &mut ground.memory);
    Ok(Protected { net, ..protected })
}

/// The net of a dual's seeds, from its triangles.
pub(crate) fn measured_on_surface(dual: &SurfaceDual) -> Net<Place> {
    let metric = Scaled { field: dual.metric(), factor: dual.factor() };
    let seeds = SeedsOnSurface::new(dual.manifold(), &metric, dual.places().to_vec());
    Net::on_surface(&seeds, &dual.triangles(), &mut Memory::default())
}

struct OnSurface<'a, 'b> {
    dual: &'a mut SurfaceDual<'b>,
    seeds: SeedsOnSurface<'a>,
    memory: Memory<Place>,
}

impl OnSurface<'_, '_> {
    /// The seeds around some, as far as they are seen, in the triangles between them.
    fn stand(&self, view: &impl View, seeds: &[VertexId]) -> Stand {
        let topology = self.dual.topology();
        let mut near = seeds.to_vec();
        for _ in 0..RINGS {
            near = distinct(near.iter().flat_map(|&v| topology.around(v)).chain(near.iter().copied()));
        }
        let seen: Vec<(VertexId, Point)> = near.into_iter().filter_map(|v| Some((v, view.seed(v.0)?))).collect();
        let measured = |&(v, p): &(VertexId, Point)| (v, p, LocalMetric::at(view.field(), p));
        let measured: Vec<(VertexId, Point, LocalMetric)> = seen.par_iter().map(measured).collect();
        let slots = topology.vertex_slots();
        let (mut positions, mut locals) = (vec![Point::default(); slots], vec![LocalMetric::default(); slots]);
        let mut is_seen = vec![false; slots];
        for (v, p, local) in measured {
            (positions[v.index()], locals[v.index()]) = (p, local);
            is_seen[v.index()] = local.tensor.is_positive_definite();
        }
        let mut part = topology.clone();
        part.retain_faces(|f| topology.corners(f).iter().all(|v| is_seen[v.index()]));
        Stand { positions, locals, topology: part }
    }
}

impl Protecting for OnSurface<'_, '_> {
    type Place = Place;

    fn topology(&self) -> &Triangulation {
        self.dual.topology()
    }

    fn kind(&self, v: VertexId) -> Kind {
        self.dual.kind(v)
    }

    /// All but mu, which takes as long as the rest.
    fn measure(&mut self) -> Net<Place> {
        Net::circles_on_surface(&self.seeds, &self.dual.triangles(), &mut self.memory)
    }

    fn places(
        &mut self,
        movable: &[VertexId],
        search: impl FnOnce(&mut Search) -> Vec<Found<Point>>,
    ) -> Vec<Found<Place>> {
        let numbers: Vec<u32> = movable.iter().map(|v| v.0).collect();
        let Some(view) = self.seeds.view(&numbers) else { return Vec::new() };
        let mut stand = self.stand(&view, movable);
        let reach = |v: VertexId, from: Point, step: Vector| Some(from + step).filter(|&to| view.is_inside(v.0, to));
        let found = search(&mut Search { terrain: &view, stand: &mut stand, reach: &reach });
        found.into_iter().filter_map(|(gain, v, to)| Some((gain, v, view.place(to)?))).collect()
    }

    fn relocate(&mut self, v: VertexId, to: Place) -> bool {
        let is_done = self.dual.relocate(v, &to);
        if is_done {
            self.seeds.put(v.0, self.dual.places()[v.index()]);
        }
        is_done
    }

    fn verdict(&self) -> Result<()> {
        Ok(())
    }
}
