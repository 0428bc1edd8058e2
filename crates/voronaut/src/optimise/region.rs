//! Where geodesics are not resolved: seeds whose triangles and circles a diagram on a canvas around them decides on.

use crate::canvas::Canvas;
use crate::dual::Dual;
use crate::geometry::Point;
use crate::net::{Ball, circles_on_canvas};
use crate::triangulation::VertexId;

/// Rings of triangles of the mesh around a region's seeds that its canvas covers: their cells are then whole.
const RINGS: usize = 2;

/// Seeds, and a canvas that holds their cells.
pub(super) struct Region {
    canvas: Canvas,
    core: Vec<VertexId>,
    near: Vec<VertexId>,
    is_inner: Vec<bool>,
}

impl Region {
    /// Of some seeds and their neighbours, with so many canvas vertices per seed. `None` where the metric is no metric there.
    pub(super) fn around(dual: &Dual, seeds: &[VertexId], per_seed: usize) -> Option<Self> {
        let topology = dual.topology();
        let mut is_inner = vec![false; topology.vertex_slots()];
        for &v in seeds {
            is_inner[v.index()] = true;
            topology.star(v).for_each(|h| is_inner[topology.target(h).index()] = true);
        }
        let inner: Vec<VertexId> = topology.vertices().filter(|v| is_inner[v.index()]).collect();
        let part = dual.part_around(&inner, RINGS);
        let near: Vec<VertexId> = part.topology.vertices().collect();
        let canvas = Canvas::intrinsic_from(part, dual.scaled_field(), per_seed * near.len()).ok()?;
        Some(Self { canvas, core: seeds.to_vec(), near, is_inner })
    }

    /// The region around the same seeds where they are now.
    pub(super) fn anew(&self, dual: &Dual, per_seed: usize) -> Option<Self> {
        Self::around(dual, &self.core, per_seed)
    }

    /// Whether all of these are its seeds.
    pub(super) fn holds(&self, seeds: &[u32]) -> bool {
        seeds.iter().all(|&i| self.is_inner.get(i as usize) == Some(&true))
    }

    /// Whether one of these is its seed.
    pub(super) fn touches(&self, seeds: &[u32]) -> bool {
        seeds.iter().any(|&i| self.holds(&[i]))
    }

    /// Its seeds.
    pub(super) fn seeds(&self) -> impl Iterator<Item = VertexId> {
        self.is_inner.iter().enumerate().filter(|(_, inner)| **inner).map(|(i, _)| VertexId(i as u32))
    }

    /// The circles of the triangles with a seed of its own, all seeds being somewhere; `None` where one lies outside the
    /// canvas.
    pub(super) fn circles(&self, dual: &Dual, at: impl Fn(VertexId) -> Point) -> Option<Vec<Ball<3>>> {
        let seeds: Vec<(u32, Point)> = self.near.iter().map(|&v| (v.0, at(v))).collect();
        let mut balls = circles_on_canvas(&self.canvas, dual.scaled_field(), &seeds).ok()?;
        balls.retain(|ball| self.touches(&ball.corners));
        Some(balls)
    }
}
