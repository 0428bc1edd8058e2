//! Edges cut in two, many at once.

use super::{Planar, is_left};
use crate::geometry::Point;
use crate::triangulation::{Corner, FaceId, HalfEdge};

impl Planar {
    /// The triangulation with edges cut at points on them, and what each of its vertices was, as [`crate::triangulation::Triangulation::halved`] has
    /// it; where rounding would turn a triangle over, the edges of its face stay whole.
    pub(crate) fn halved(&self, cuts: &[HalfEdge], points: &[Point]) -> (Planar, Vec<Corner>) {
        let position = |corner: Corner| match corner {
            Corner::Vertex(v) => self.position(v),
            Corner::Cut(i) => points[i as usize],
        };
        let stands = |_: FaceId, part: [Corner; 3]| {
            let [a, b, c] = part.map(position);
            is_left(a, b, c)
        };
        let (topology, origins) = self.topology.halved(cuts, stands);
        let positions = origins.iter().map(|&corner| position(corner)).collect();
        (Planar { topology, positions }, origins)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar::delaunay;
    use crate::triangulation::Constraint;

    /// Scattered points, of whose triangulation one edge inside is constrained and one face has a region of its own.
    fn scattered() -> Planar {
        let points: Vec<Point> = (0..40).map(|i| Point::new(f64::from(i * 7 % 40), f64::from(i * i % 23))).collect();
        let mut planar = delaunay(&points).unwrap();
        let edge = planar.topology.edges().find(|&h| planar.topology.twin(h).is_some()).unwrap();
        planar.topology.set_constraint(edge, Constraint(3));
        planar
    }

    fn middles(planar: &Planar, which: impl Fn(usize) -> bool) -> (Vec<HalfEdge>, Vec<Point>) {
        let edges = planar.topology.edges().enumerate().filter(|&(i, _)| which(i));
        edges.map(|(_, h)| (h, planar.ends(h)[0].midpoint(planar.ends(h)[1]))).unzip()
    }

    #[test]
    fn any_edges_can_be_halved() {
        let planar = scattered();
        let constrained = |planar: &Planar| {
            let edges = planar.topology.edges().filter(|&h| planar.topology.constraint(h) == Some(Constraint(3)));
            edges.map(|h| planar.ends(h)[0].distance(planar.ends(h)[1])).collect::<Vec<f64>>()
        };
        for every in [1, 2, 3, 5, usize::MAX] {
            let (cuts, points) = middles(&planar, |i| i.is_multiple_of(every));
            let (halved, origins) = planar.halved(&cuts, &points);
            halved.topology.check().unwrap();
            assert!(halved.is_embedded());
            assert_eq!(halved.topology.vertex_count(), planar.topology.vertex_count() + cuts.len());
            assert!((halved.area() - planar.area()).abs() < 1e-9 * planar.area());
            assert!((constrained(&halved).iter().sum::<f64>() - constrained(&planar)[0]).abs() < 1e-12);
            for (&origin, &p) in origins.iter().zip(&halved.positions) {
                match origin {
                    Corner::Vertex(v) => assert_eq!(p, planar.position(v)),
                    Corner::Cut(i) => assert_eq!(p, points[i as usize]),
                }
            }
        }
        let (cuts, points) = middles(&planar, |_| true);
        assert_eq!(planar.halved(&cuts, &points).0.topology.face_count(), 4 * planar.topology.face_count());
    }

    #[test]
    fn where_a_cut_would_turn_a_triangle_over_edges_stay_whole() {
        let planar = scattered();
        let (cuts, mut points) = middles(&planar, |_| true);
        // Far off its edge.
        points[20] = Point::new(1e3, 1e3);
        let (halved, origins) = planar.halved(&cuts, &points);
        halved.topology.check().unwrap();
        assert!(halved.is_embedded() && !origins.contains(&Corner::Cut(20)));
        let whole = cuts.len() + planar.topology.vertex_count() - halved.topology.vertex_count();
        assert!((1..=5).contains(&whole), "{whole}");
    }
}
