//! Canvases of surfaces: only their constructors differ from those of the plane.

use super::draped::{Draped, Size};
use super::surface_stars::star_set;
use super::{Canvas, CanvasCounters, Kind, flip};
use crate::error::{Error, Result};
use crate::geometry::{Aabb3, Point3};
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::{Manifold, Place};
use crate::mesh::Mesh;
use crate::triangulation::VertexId;

impl<'s> Canvas<Draped<'s>> {
    /// The canvas of a kind on a surface, with about so many vertices (more if the surface has more), and some places as
    /// vertices, which are returned: one for each, in order.
    ///
    /// The surface's triangles are halved at their longest edges: longest in the metric or, of an isotropic canvas, beside
    /// `isotropic_size`. On an equation's surface new vertices are moved onto f = 0. Lengths are
    /// taken along the surface; the flips that follow are those of the plane.
    ///
    /// # Errors
    /// [`Error::Metric`] where the metric is not positive definite at a vertex; [`Error::Domain`] of two places that
    /// are one.
    pub fn on_surface(
        kind: Kind,
        manifold: &'s Manifold,
        metric: &'s dyn SurfaceMetric,
        vertices: usize,
        seeds: &[Place],
    ) -> Result<(Self, Vec<VertexId>)> {
        let mut counters = CanvasCounters::default();
        let mut draped = Draped::new(manifold, metric)?;
        let size = if kind == Kind::Isotropic { Size::Isotropic } else { Size::Metric };
        draped.refine(size, vertices.saturating_sub(seeds.len()), &mut counters)?;
        let at = draped.insert_all(seeds)?;
        demand_distinct(&at, seeds)?;
        draped.settle_lengths(&mut counters)?;
        let order = along_a_curve(&draped);
        let mut number = vec![VertexId(u32::MAX); draped.topology.vertex_slots()];
        (0..).zip(&order).for_each(|(new, old)| number[old.index()] = VertexId(new));
        let at = at.into_iter().map(|v| number[v.index()]).collect();
        let embedded = draped.renumbered(&order);
        let mut topology = embedded.topology.clone();
        counters.flips = flip::to_intrinsic_delaunay(&mut topology);
        let stars = (kind == Kind::StarSet).then(|| star_set(&embedded));
        Ok((Self { embedded, topology, stars, kind, counters }, at))
    }

    /// The same vertices on the surface: the triangulation that points and paths are on.
    pub fn draped(&self) -> &Draped<'s> {
        &self.embedded
    }
}

fn demand_distinct(at: &[VertexId], seeds: &[Place]) -> Result<()> {
    let mut order: Vec<usize> = (0..at.len()).collect();
    order.sort_by_key(|&i| (at[i], i));
    match order.windows(2).find(|pair| at[pair[0]] == at[pair[1]]) {
        None => Ok(()),
        Some(pair) => {
            let what = format!("seeds {} and {} are at the same place", pair[0] + 1, pair[1] + 1);
            Err(Error::domain(what, seeds[pair[0]].position.to_string(), "remove one of them"))
        }
    }
}

/// All vertices in the order of a curve through space, for the sake of the cache.
fn along_a_curve(draped: &Draped) -> Vec<VertexId> {
    let mut vertices: Vec<VertexId> = draped.topology.vertices().collect();
    let bounds = Aabb3::of(vertices.iter().map(|&v| draped.position(v)));
    let key = |p: Point3| {
        let (offset, size) = bounds.map_or(Default::default(), |b| (p - b.min, b.extent()));
        let cell = |x: f64, most: f64| if most > 0.0 { (x / most * 1023.0) as u32 } else { 0 };
        spread(cell(offset.x, size.x)) | spread(cell(offset.y, size.y)) << 1 | spread(cell(offset.z, size.z)) << 2
    };
    vertices.sort_by_cached_key(|&v| (key(draped.position(v)), v));
    vertices
}

/// Ten bits with two zeros before each (Morton 1966).
fn spread(cell: u32) -> u32 {
    (0..10).map(|bit| (cell >> bit & 1) << (3 * bit)).sum()
}

/// The surface's triangles, halved at their longest edges in the metric until there are so many vertices. Edges are not measured.
///
/// # Errors
/// [`Error::Metric`](crate::Error::Metric) where the metric is not positive definite at a vertex.
pub(crate) fn even_on_surface<'s>(
    manifold: &'s Manifold,
    metric: &'s dyn SurfaceMetric,
    vertices: usize,
) -> Result<Draped<'s>> {
    let mut draped = Draped::new(manifold, metric)?;
    draped.refine(Size::Metric, vertices, &mut CanvasCounters::default())?;
    Ok(draped)
}

impl Draped<'_> {
    /// As one of its own: every face a triangle.
    ///
    /// # Errors
    /// [`Error::Domain`](crate::Error::Domain) of faces without area.
    pub(crate) fn to_manifold(&self) -> Result<Manifold> {
        Manifold::of(&Mesh {
            points: (0..self.topology.vertex_slots() as u32).map(|v| self.position(VertexId(v)).to_array()).collect(),
            triangles: self.topology.faces().map(|f| self.topology.corners(f).map(|v| v.0)).collect(),
            ..Mesh::default()
        })
    }
}
