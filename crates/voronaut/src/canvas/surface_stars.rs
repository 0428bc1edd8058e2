//! The star set of a surface: every vertex has its Delaunay star in its tangent plane and its own metric, and what methods
//! without triangles travel on.

use super::draped::Draped;
use super::star::{Finder, Spoke, Star, as_it_is, circle};
use super::{Canvas, StarFigures, StarSet};
use crate::geodesic::{Graph, Sight};
use crate::geometry::{Orientation, Point, Point3, TangentPlane, Tensor, Vector, orientation};
use crate::parallel::prelude::*;
use crate::planar::Planar;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Rings of vertices around a vertex that its star is looked for in.
const RINGS: usize = 4;
/// Rounds in which vertices that the rings touch from two sides are closed in.
const PINCHES: usize = 8;
/// The cosine of the angle by which a surface turns between two vertices that see each other straight: a chord of a circle is
/// shorter than such an arc by 0.7 % at most.
const FLAT: f64 = 0.92;

/// The stars of all vertices. Where the surface turns away within its rings, a vertex has its star in the triangulation.
pub(super) fn star_set(draped: &Draped) -> StarSet {
    let vertices = (0..draped.topology.vertex_slots() as u32).into_par_iter().map(VertexId);
    let found: Vec<(Star, f64, bool)> = vertices.with_min_len(64).map(|v| star(draped, v)).collect();
    let unsettled = found.iter().filter(|star| !star.2).count();
    let radius = found.iter().map(|star| star.1).fold(0.0, f64::max);
    let stars: Vec<Star> = found.into_iter().map(|star| star.0).collect();
    let figures = StarFigures { radius, unsettled, ..StarFigures::of(&stars, |_, _| None) };
    StarSet { stars, figures }
}

/// The star of a vertex, its greatest circumradius, and whether it is Delaunay.
fn star(draped: &Draped, v: VertexId) -> (Star, f64, bool) {
    let plane = draped.plane(v);
    let tensor = plane.restrict(draped.tensor(v));
    let found = Patch::around(draped, v, &plane).and_then(|patch| {
        let star = Finder::new(&patch.planar).star(VertexId(0), tensor)?;
        let corners = |spoke: &Spoke| [VertexId(0), spoke.ends[0], spoke.ends[1]].map(|u| patch.planar.position(u));
        let radii = star.iter().filter_map(|spoke| circle(tensor, corners(spoke))).map(|(_, radius)| radius);
        let radius = radii.fold(0.0, f64::max);
        let named = |spoke: &Spoke| Spoke { ends: spoke.ends.map(|u| patch.names[u.index()]), ..*spoke };
        Some((star.iter().map(named).collect(), radius, true))
    });
    found.unwrap_or_else(|| (as_it_is(&draped.topology, v), 0.0, false))
}

/// Some rings of faces around a vertex, in its tangent plane; the vertex comes first.
struct Patch {
    planar: Planar,
    names: Vec<VertexId>,
}

impl Patch {
    /// `None` where a face comes out turned over.
    fn around(draped: &Draped, v: VertexId, plane: &TangentPlane) -> Option<Self> {
        let topology = &draped.topology;
        let faces = faces_around(topology, v)?;
        let mut names = vec![v];
        let mut number: HashMap<VertexId, u32> = HashMap::from([(v, 0)]);
        let mut number_of = |w: VertexId| {
            *number.entry(w).or_insert_with(|| {
                names.push(w);
                names.len() as u32 - 1
            })
        };
        let triangles: Vec<[u32; 3]> = faces.iter().map(|&f| topology.corners(f).map(&mut number_of)).collect();
        let origin = draped.position(v);
        let flat = |u: &VertexId| Point::default() + plane.flatten(draped.position(*u) - origin);
        let positions: Vec<Point> = names.iter().map(flat).collect();
        let is_upright = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| positions[i as usize]);
            orientation(a, b, c) == Orientation::Left
        };
        let topology = Triangulation::from_triangles(names.len(), &triangles, &vec![0; triangles.len()]);
        let is_whole = topology.check().is_ok() && triangles.iter().all(is_upright);
        is_whole.then_some(Self { planar: Planar { topology, positions }, names })
    }
}

/// Some rings of faces around a vertex, and more where these touch each other in a vertex only: every vertex has one fan of
/// them. `None` where that does not come to an end soon.
fn faces_around(topology: &Triangulation, v: VertexId) -> Option<Vec<FaceId>> {
    let mut faces: Vec<FaceId> = Vec::new();
    let mut seen: HashSet<FaceId> = HashSet::new();
    let mut ring = vec![v];
    for round in 1..RINGS + PINCHES {
        let stars = ring.iter().flat_map(|&u| topology.star(u)).map(HalfEdge::face);
        faces.extend(stars.filter(|&f| seen.insert(f)));
        let sides = || faces.iter().flat_map(|f| f.half_edges());
        let outer = || sides().filter(|&h| topology.twin(h).is_none_or(|t| !seen.contains(&t.face())));
        let mut rim: Vec<VertexId> = outer().map(|h| topology.origin(h)).collect();
        rim.sort_unstable();
        let pinched: Vec<VertexId> = rim.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0]).collect();
        rim.dedup();
        if round >= RINGS && pinched.is_empty() {
            return Some(faces);
        }
        ring = if round < RINGS { rim } else { pinched };
    }
    None
}

/// Vertices of a surface, each with a frame of its tangent plane.
struct OnSurface {
    positions: Vec<Point3>,
    planes: Vec<TangentPlane>,
}

impl Sight for OnSurface {
    /// Turned into the plane by the smallest rotation: as long as it is in space.
    fn line(&self, seen_from: VertexId, from: VertexId, to: VertexId) -> Vector {
        let line = self.positions[to.index()] - self.positions[from.index()];
        let flat = self.planes[seen_from.index()].flatten(line);
        let length = flat.norm();
        if length > 0.0 { flat * (line.norm() / length) } else { flat }
    }

    fn turned(&self, seen_from: VertexId, at: VertexId, tensor: Tensor) -> Tensor {
        let [here, there] = [seen_from, at].map(|v| &self.planes[v.index()]);
        let turned = here.turned(there.normal);
        tensor.along([turned.u, turned.v].map(|axis| there.flatten(axis)))
    }

    fn is_flat(&self, from: VertexId, to: VertexId) -> bool {
        self.planes[from.index()].normal.dot(self.planes[to.index()].normal) >= FLAT
    }
}

impl Canvas<Draped<'_>> {
    /// The vertices with their tensors, each in a frame of its tangent plane, and the edges of [`Canvas::draped`], of a star
    /// set those of its stars, with lengths along the surface, for methods that know no triangles.
    pub(crate) fn surface_graph(&self) -> Graph {
        let draped = self.draped();
        let vertices = || (0..self.vertex_count() as u32).into_par_iter().with_min_len(1024).map(VertexId);
        let planes: Vec<TangentPlane> = vertices().map(|v| draped.plane(v)).collect();
        let tensors = vertices().map(|v| planes[v.index()].restrict(draped.tensor(v))).collect();
        let positions: Vec<Point3> = vertices().map(|v| draped.position(v)).collect();
        Graph::seen_by(Arc::new(OnSurface { positions, planes }), tensors, self.pairs(draped.topology()))
            .with_lengths(|a, b| draped.length_between(a, b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Kind;
    use crate::geometry::Tensor3;
    use crate::manifold::Manifold;
    use crate::manifold::surface::metric::Constant;
    use crate::mesh::Mesh;

    const UNIFORM: Constant = Constant(Tensor3::IDENTITY);

    /// A square of the plane x + z = 0, one by root two.
    fn slope() -> Manifold {
        let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, -1.0], [1.0, 1.0, -1.0], [0.0, 1.0, 0.0]];
        let mesh = Mesh { points, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
        Manifold::of(&mesh).unwrap()
    }

    /// Places of a slope that follow no pattern.
    fn scattered(manifold: &Manifold) -> Vec<crate::manifold::Place> {
        let at = |i: u32| ((0.618 * f64::from(i)).fract(), (0.754_877 * f64::from(i)).fract());
        (1..300).map(at).map(|(x, y)| manifold.closest(Point3::new(x, y, -x)).unwrap()).collect()
    }

    #[test]
    fn stars_of_a_flat_surface_agree_and_are_delaunay() {
        let manifold = slope();
        // The second metric is three times as long across the slope.
        for metric in [UNIFORM, Constant(Tensor3 { yy: 9.0, ..Tensor3::IDENTITY })] {
            let (canvas, _) =
                Canvas::on_surface(Kind::StarSet, &manifold, &metric, 600, &scattered(&manifold)).unwrap();
            let stars = canvas.stars().unwrap();
            assert_eq!(stars.figures().unsettled, 0);
            // As it lies in the plane of the metric; circles at the border reach farther than the rings.
            let flat = |v: VertexId| {
                let p = canvas.draped().position(v);
                Point::new(2.0_f64.sqrt() * p.x, metric.0.yy.sqrt() * p.y)
            };
            let is_inner = |x: f64| (x - 0.5).abs() < 0.25;
            let vertices = || (0..canvas.vertex_count() as u32).map(VertexId);
            let of = |v: &VertexId| canvas.draped().position(*v);
            let inner: Vec<VertexId> = vertices().filter(|v| is_inner(of(v).x) && is_inner(of(v).y)).collect();
            assert!(inner.len() > 100);
            for v in inner {
                for [a, b] in stars.star(v) {
                    let (centre, radius) = circle(Tensor::IDENTITY, [v, a, b].map(flat)).unwrap();
                    let is_inside = |u: &VertexId| flat(*u).distance(centre) < radius * (1.0 - 1e-9);
                    assert_eq!(vertices().find(is_inside), None, "{v:?} {a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn edges_of_stars_are_as_long_as_arcs_over_them() {
        let manifold = Manifold::shape("sphere:1", None).unwrap();
        let (canvas, _) = Canvas::on_surface(Kind::StarSet, &manifold, &UNIFORM, 4000, &[]).unwrap();
        let (graph, draped) = (canvas.surface_graph(), canvas.draped());
        let mut worst: f64 = 0.0;
        for v in graph.vertices() {
            for &u in graph.neighbours(v) {
                let arc = 2.0 * (0.5 * draped.position(v).distance(draped.position(u))).asin();
                worst = worst.max((graph.length(v, u) / arc - 1.0).abs());
                assert_eq!(graph.length(v, u).to_bits(), graph.length(u, v).to_bits());
            }
        }
        assert!(worst < 1e-5, "{worst}");
    }

    #[test]
    fn vertices_see_each_other_by_rotations() {
        let manifold = Manifold::shape("sphere:1", None).unwrap();
        let (canvas, _) = Canvas::on_surface(Kind::StarSet, &manifold, &UNIFORM, 2_000, &[]).unwrap();
        let (graph, draped) = (canvas.surface_graph(), canvas.draped());
        let sight = graph.sight();
        for v in graph.vertices() {
            for &u in graph.neighbours(v) {
                let (line, back) = (sight.line(v, v, u), sight.line(v, u, v));
                assert!((line + back).norm() < 1e-15);
                assert!((line.norm() - draped.position(v).distance(draped.position(u))).abs() < 1e-15);
                // A thin ellipse along the line is one along the line in the other frame, too.
                let along = |line: Vector| Tensor::from_axis(line * (1.0 / line.norm()), 1.0, 100.0);
                let turned = sight.turned(v, u, along(sight.line(u, u, v)));
                let [found, expected] = [turned, along(line)].map(Tensor::eigen);
                assert!((found.large - expected.large).abs() < 1e-9 && (found.small - expected.small).abs() < 1e-9);
                let off = (turned.dot(line, line) / line.dot(line) - 1.0).abs();
                assert!(off < 1e-3, "{off}");
            }
        }
    }
}
