//! Ways on a surface between vertices of a canvas.

use super::draped::Draped;
use crate::geodesic::taut;
use crate::geometry::{Point3, Tensor3};
use crate::manifold::Place;
use crate::triangulation::VertexId;

/// A way on a surface.
#[derive(Clone, Debug, Default)]
pub struct Way {
    /// Its metric length.
    pub length: f64,
    /// Its ends, and where it crosses the canvas's edges: on a surface of triangles it is straight between them.
    pub points: Vec<Point3>,
    /// The edge that each of them is on, and the share of the way from its first end to its second; a vertex twice if it is at
    /// that.
    pub on: Vec<([VertexId; 2], f64)>,
}

impl Draped<'_> {
    /// The geodesic between two vertices: pulled taut from the shortest way along edges (`taut`), and so exact on a surface of
    /// triangles whose metric is uniform; on an equation's surface its points are moved onto f = 0 and its length is taken
    /// anew along the surface. `None` where there is no way.
    pub(crate) fn geodesic(&self, from: VertexId, to: VertexId) -> Option<Way> {
        let found = taut(self.topology(), from, to)?;
        let topology = self.topology();
        let inner = found.crossings.iter().map(|&(h, t)| (topology.ends(h), t));
        let on: Vec<([VertexId; 2], f64)> =
            [([from, from], 0.0)].into_iter().chain(inner).chain([([to, to], 0.0)]).collect();
        let way = self.way_along(on)?;
        let is_exact = self.manifold().equation().is_none();
        Some(if is_exact { Way { length: found.length, ..way } } else { way })
    }

    /// The way that crosses edges at these places, straight between them: by its ends and shares, as [`Way::on`]. Its length
    /// is taken along the surface, onto which its points are moved where it has an equation. `None` where that fails, or there is
    /// no such edge.
    pub(crate) fn way_along(&self, on: Vec<([VertexId; 2], f64)>) -> Option<Way> {
        let place = |&([a, b], t): &([VertexId; 2], f64)| {
            if a == b {
                return Some(*self.place(a));
            }
            let p = self.position(a).lerp(self.position(b), t);
            if self.manifold().equation().is_some() {
                return self.manifold().lift(self.place(a), p);
            }
            let h = self.topology().edge_between(a, b)?;
            Some(self.manifold().closest_on(self.home(h.face()), p))
        };
        let places: Vec<Place> = on.iter().map(place).collect::<Option<_>>()?;
        let tensors: Vec<Tensor3> = places.iter().map(|place| self.metric().at(place)).collect();
        let piece = |i: usize| self.between([&places[i], &places[i + 1]], [tensors[i], tensors[i + 1]]);
        let length = (0..places.len() - 1).map(piece).sum();
        Some(Way { length, points: places.into_iter().map(|place| place.position).collect(), on })
    }

    /// The metric length between two near vertices, the same in both directions: of the edge if they have one, else of the
    /// chord, on an equation's surface of what lies over it.
    pub(crate) fn length_between(&self, a: VertexId, b: VertexId) -> f64 {
        let topology = self.topology();
        let edge = topology.edge_between(a, b);
        let ends = [a.min(b), a.max(b)];
        let chord = || self.between(ends.map(|v| self.place(v)), ends.map(|v| self.tensor(v)));
        edge.map_or_else(chord, |h| topology.length(h))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::{Canvas, Kind};
    use crate::geometry::Point;
    use crate::manifold::Manifold;
    use crate::manifold::surface::Surface;
    use crate::manifold::surface::metric::Constant;
    use crate::mesh::Mesh;

    /// A strip one wide and two long, folded upwards in the middle.
    fn folded() -> Manifold {
        let points = [[0.0, 0.0], [0.0, 1.0], [0.6, 0.0], [0.6, 1.0], [1.2, 0.0], [1.2, 1.0]];
        let height = |x: f64| 0.8 - (0.8 - x * 4.0 / 3.0).abs();
        let points = points.map(|[x, y]| [x, y, height(x)]).to_vec();
        let triangles = vec![[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]];
        Manifold::new(Surface::new(&Mesh { points, triangles, ..Mesh::default() }).unwrap(), None)
    }

    #[test]
    fn ways_on_a_folded_strip_are_straight_unfolded() {
        let (manifold, metric) = (folded(), Constant(Tensor3::IDENTITY));
        let unfolded = |p: Point3| Point::new(p.x / 0.6, p.y);
        let seeds = [(0.1, 0.2), (1.1, 0.9), (0.7, 0.05)]
            .map(|(x, y): (f64, f64)| manifold.closest(Point3::new(x, y, 0.8 - (0.8 - x * 4.0 / 3.0).abs())).unwrap());
        let (canvas, at) = Canvas::on_surface(Kind::Intrinsic, &manifold, &metric, 500, &seeds).unwrap();
        let draped = canvas.draped();
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let way = draped.geodesic(at[i], at[j]).unwrap();
            let exact = unfolded(seeds[i].position).distance(unfolded(seeds[j].position));
            assert!((way.length / exact - 1.0).abs() < 1e-12, "{} {exact}", way.length);
            let pieces: f64 = way.points.windows(2).map(|ends| ends[0].distance(ends[1])).sum();
            assert!((pieces / exact - 1.0).abs() < 1e-12, "{pieces} {exact}");
            assert_eq!((way.points[0], way.on[0]), (seeds[i].position, ([at[i], at[i]], 0.0)));
            for (&p, &([a, b], t)) in way.points.iter().zip(&way.on) {
                assert!(draped.position(a).lerp(draped.position(b), t).distance(p) < 1e-14);
            }
            let chord = draped.length_between(at[i], at[j]);
            assert!(
                (chord - seeds[i].position.distance(seeds[j].position)).abs() < 1e-15,
                "over the fold there is no edge"
            );
        }
        assert!(draped.geodesic(at[0], at[0]).unwrap().length.abs() < f64::MIN_POSITIVE);
    }

    #[test]
    fn ways_on_a_sphere_are_great_circles() {
        let (manifold, metric) = (Manifold::shape("sphere:1", None).unwrap(), Constant(Tensor3::IDENTITY));
        let seeds = [(1.0, 0.3, 0.2), (-0.4, 0.9, 0.1), (0.2, -0.5, -1.0)].map(|(x, y, z)| {
            let p = Point3::default() + (Point3::new(x, y, z) - Point3::default()).unit().unwrap();
            manifold.closest(p).unwrap()
        });
        let (canvas, at) = Canvas::on_surface(Kind::Intrinsic, &manifold, &metric, 8000, &seeds).unwrap();
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let way = canvas.draped().geodesic(at[i], at[j]).unwrap();
            let exact = 2.0 * (0.5 * seeds[i].position.distance(seeds[j].position)).asin();
            assert!((way.length / exact - 1.0).abs() < 1e-5, "{} {exact}", way.length);
            let across = (seeds[i].position - Point3::default()).cross(seeds[j].position - Point3::default());
            let off = way.points.iter().map(|&p| across.dot(p - Point3::default()).abs()).fold(0.0, f64::max);
            assert!(off < 0.01, "{off}");
        }
    }
}
