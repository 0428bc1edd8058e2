//! Euclidean Delaunay triangulation of points, by insertion along a Hilbert curve and exact flips.

use super::order::hilbert_order;
use super::{Location, Planar};
use crate::geometry::{Aabb, Point, in_circle};
use crate::lists::in_order;
use crate::triangulation::{FaceId, Flipping, HalfEdge, Lawson, Limit, Triangulation, VertexId};

/// The Delaunay triangulation of the points inside a triangle far around them.
///
/// Vertex i is point i; the last three vertices are the far triangle's. Points are finite and at least one.
///
/// # Errors
/// The numbers of two points at the same position.
pub fn delaunay(points: &[Point]) -> Result<Planar, [u32; 2]> {
    let far = far_triangle(points);
    let n = points.len() as u32;
    let mut planar = Planar {
        topology: Triangulation::from_triangles(points.len() + 3, &[[n, n + 1, n + 2]], &[0]),
        positions: points.iter().copied().chain(far).collect(),
    };
    let mut face = FaceId(0);
    let mut lawson = Lawson::default();
    for i in hilbert_order(points) {
        let p = points[i as usize];
        let v = VertexId(i);
        match planar.walk(face, p, false) {
            Location::Face(f) => planar.topology.split_face(f, v),
            Location::Edge(h) => _ = planar.topology.split_edge(h, v),
            Location::Vertex(other) => return Err(in_order([other.0, i])),
            Location::Behind(_) => unreachable!("the far triangle holds every point"),
        }
        lawson.queue(planar.topology.star(v).map(HalfEdge::next));
        planar.legalise(&mut lawson);
        face = planar.topology.start(v).expect("just inserted").face();
    }
    Ok(planar)
}

impl Planar {
    /// Lawson's flips in the Euclidean plane from the edges that were queued outwards; constrained edges stay. What was constrained Delaunay but for these edges is so again.
    pub(crate) fn legalise(&mut self, lawson: &mut Lawson) {
        lawson.pass(self, Limit::None);
    }
}

impl Flipping for Planar {
    fn topology(&mut self) -> &mut Triangulation {
        &mut self.topology
    }

    fn wants_flip(&mut self, h: HalfEdge) -> bool {
        let Some(quad) = self.topology.quad(h).filter(|_| !self.topology.is_fixed(h)) else { return false };
        let [a, b, c, d] = quad.map(|v| self.position(v));
        in_circle(a, b, c, d) > 0.0 && self.is_convex(h)
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
        let is_in_circle = |h: HalfEdge| {
            let [a, b, c, d] = planar.topology.quad(h)?.map(|v| planar.position(v));
            Some(in_circle(a, b, c, d) > 0.0)
        };
        assert!(planar.topology.edges().all(|h| is_in_circle(h) != Some(true)));
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
        assert_eq!(delaunay(&points).unwrap_err(), [7, 50]);
    }
}
