//! Order along a Hilbert curve, so that what is near in the plane is near in memory.

use super::Planar;
use crate::geometry::{Aabb, Point};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

impl Planar {
    /// The vertices along a Hilbert curve.
    pub(crate) fn along_curve(&self) -> Vec<VertexId> {
        let living: Vec<VertexId> = self.topology.vertices().collect();
        let points: Vec<Point> = living.par_iter().with_min_len(1024).map(|&v| self.position(v)).collect();
        hilbert_order(&points).into_iter().map(|i| living[i as usize]).collect()
    }

    /// The same triangulation with vertices and faces numbered along a Hilbert curve, without dead slots;
    /// and for each new vertex its old id.
    pub(crate) fn reordered(&self) -> (Planar, Vec<VertexId>) {
        let old = self.along_curve();
        let topology = self.topology.renumbered_by_corners(&old);
        let positions = old.par_iter().with_min_len(1024).map(|&v| self.position(v)).collect();
        (Planar { topology, positions }, old)
    }

    /// Its connected parts, each with the vertices of before that its own are. No vertex has several fans.
    pub(crate) fn pieces(&self) -> Vec<(Planar, Vec<VertexId>)> {
        let placed = |(topology, old): (_, Vec<VertexId>)| {
            (Planar { topology, positions: old.iter().map(|&v| self.position(v)).collect() }, old)
        };
        self.topology.pieces().into_iter().map(placed).collect()
    }
}

/// Indices of the points along a Hilbert curve on a 65,536 x 65,536 grid: neighbours in the order are near in the plane.
pub(crate) fn hilbert_order(points: &[Point]) -> Vec<u32> {
    let Some(bounds) = Aabb::of(points.iter().copied()) else { return Vec::new() };
    let extent = bounds.extent();
    let scale = 65_535.0 / extent.x.max(extent.y).max(f64::MIN_POSITIVE);
    let keyed = |(i, p): (usize, &Point)| {
        let cell = (*p - bounds.min) * scale;
        (hilbert_index(cell.x as u32, cell.y as u32), i as u32)
    };
    let mut keyed: Vec<(u32, u32)> = points.par_iter().enumerate().with_min_len(4096).map(keyed).collect();
    keyed.par_sort_unstable();
    keyed.into_iter().map(|(_, i)| i).collect()
}

fn hilbert_index(mut x: u32, mut y: u32) -> u32 {
    let mut index = 0;
    let mut side = 1 << 15;
    while side > 0 {
        let (right, top) = (u32::from(x & side > 0), u32::from(y & side > 0));
        index += side * side * ((3 * right) ^ top);
        if top == 0 {
            if right == 1 {
                x = 65_535 - x;
                y = 65_535 - y;
            }
            std::mem::swap(&mut x, &mut y);
        }
        side >>= 1;
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar::delaunay;
    use crate::triangulation::Constraint;

    #[test]
    fn reordering_keeps_the_triangulation() {
        let points: Vec<Point> = (0..40).map(|i| Point::new(f64::from(i * 7 % 40), f64::from(i * i % 23))).collect();
        let mut planar = delaunay(&points).unwrap();
        let edge = planar.topology.edges().find(|&h| planar.topology.twin(h).is_some()).unwrap();
        planar.topology.set_constraint(edge, Constraint(3));
        let (new, old) = planar.reordered();
        new.topology.check().unwrap();
        assert!(new.is_embedded());
        assert_eq!(new.topology.face_count(), planar.topology.face_count());
        assert!(old.iter().enumerate().all(|(i, &v)| new.positions[i] == planar.position(v)));
        let constrained: Vec<_> = new.topology.edges().filter(|&h| new.topology.constraint(h).is_some()).collect();
        assert_eq!(constrained.len(), 1);
    }
}
