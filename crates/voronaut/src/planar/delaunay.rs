//! Euclidean Delaunay triangulation of points, by insertion along a Hilbert curve and exact flips.

use super::order::hilbert_order;
use super::{Location, Planar};
use crate::geometry::{Aabb, Point, in_circle};
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};

/// Two input points at the same position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Duplicate(pub u32, pub u32);

/// The Delaunay triangulation of the points inside a triangle far around them.
///
/// Vertex i is point i; the last three vertices are the far triangle's. Points are finite and at least one.
///
/// # Errors
/// Two points at the same position.
pub fn delaunay(points: &[Point]) -> Result<Planar, Duplicate> {
    let far = far_triangle(points);
    let n = points.len() as u32;
    let mut planar = Planar {
        topology: Triangulation::from_triangles(points.len() + 3, &[[n, n + 1, n + 2]], &[0]),
        positions: points.iter().copied().chain(far).collect(),
    };
    let mut face = FaceId(0);
    let mut stack = Vec::new();
    for i in hilbert_order(points) {
        let p = points[i as usize];
        let v = VertexId(i);
        match planar.walk(face, p, false) {
            Location::Face(f) => planar.topology.split_face(f, v),
            Location::Edge(h) => _ = planar.topology.split_edge(h, v),
            Location::Vertex(other) => return Err(Duplicate(other.0.min(i), other.0.max(i))),
            Location::Behind(_) => unreachable!("the far triangle holds every point"),
        }
        stack.extend(planar.topology.star(v).map(HalfEdge::next));
        planar.legalise(&mut stack);
        face = planar.topology.start(v).expect("just inserted").face();
    }
    Ok(planar)
}

impl Planar {
    /// Lawson's flips in the Euclidean plane from the edges on the stack outwards, until the stack is empty; constrained
    /// edges stay. What was constrained Delaunay but for these edges is so again.
    pub fn legalise(&mut self, stack: &mut Vec<HalfEdge>) {
        while let Some(h) = stack.pop() {
            if self.topology.is_fixed(h) || !self.violates_in_circle(h) || !self.is_convex(h) {
                continue;
            }
            let t = self.topology.twin(h).expect("not fixed");
            self.topology.flip(h);
            stack.extend([h.next(), h.prev(), t.next(), t.prev()]);
        }
    }

    fn violates_in_circle(&self, h: HalfEdge) -> bool {
        let Some(t) = self.topology.twin(h) else { return false };
        let [a, b, c] = [h, h.next(), h.prev()].map(|e| self.position(self.topology.origin(e)));
        in_circle(a, b, c, self.position(self.topology.apex(t))) > 0.0
    }
}

fn far_triangle(points: &[Point]) -> [Point; 3] {
    let bounds = Aabb::of(points.iter().copied()).unwrap_or(Aabb { min: Point::default(), max: Point::default() });
    let Point { x, y } = bounds.centre();
    let reach = bounds.extent().x.max(bounds.extent().y).max(f64::MIN_POSITIVE.sqrt()).max((x.abs() + y.abs()) * 1e-12);
    let r = 16.0 * reach;
    [Point::new(x - 2.0 * r, y - r), Point::new(x + 2.0 * r, y - r), Point::new(x, y + 2.0 * r)]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pseudo_random(n: usize) -> Vec<Point> {
        let mut state = 12_345_u64;
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..n).map(|_| Point::new(next(), next())).collect()
    }

    fn assert_delaunay(planar: &Planar) {
        planar.topology.check().unwrap();
        assert!(planar.is_embedded());
        assert!(planar.topology.edges().all(|h| !planar.violates_in_circle(h)));
    }

    #[test]
    fn random_points_are_delaunay_at_every_scale() {
        for scale in [1e-9, 1.0, 1e9] {
            let points: Vec<Point> = pseudo_random(2000).iter().map(|p| Point::new(p.x * scale, p.y * scale)).collect();
            assert_delaunay(&delaunay(&points).unwrap());
        }
    }

    #[test]
    fn cocircular_and_collinear_points_are_fine() {
        let grid: Vec<Point> = (0..400).map(|i| Point::new(f64::from(i % 20), f64::from(i / 20))).collect();
        assert_delaunay(&delaunay(&grid).unwrap());
        let line: Vec<Point> = (0..50).map(|i| Point::new(f64::from(i), 0.0)).collect();
        assert_delaunay(&delaunay(&line).unwrap());
    }

    #[test]
    fn duplicates_are_named() {
        let mut points = pseudo_random(50);
        points.push(points[7]);
        assert_eq!(delaunay(&points).unwrap_err(), Duplicate(7, 50));
    }
}
