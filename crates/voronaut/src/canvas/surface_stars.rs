//! The star set of a surface: every vertex has its Delaunay star in its tangent plane and its own metric, and what methods
//! without triangles travel on.

use super::draped::Draped;
use super::star::{Finder, Spoke, Star, circle};
use super::{Canvas, StarFigures, StarSet};
use crate::geodesic::{Graph, Sight};
use crate::geometry::{Orientation, Point, Point3, TangentPlane, Tensor, Tensor3, Vector, orientation};
use crate::planar::Planar;
use crate::triangulation::{Triangulation, VertexId};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// Rings of vertices around a vertex that its star is looked for in.
const RINGS: usize = 4;

/// The stars of all vertices. Where the surface turns away within its rings, a vertex has its star in the triangulation.
pub(super) fn star_set(draped: &Draped) -> StarSet {
    let vertices = (0..draped.topology.vertex_slots() as u32).into_par_iter().map(VertexId);
    let found: Vec<(Star, f64, bool)> = vertices.with_min_len(64).map(|v| star(draped, v)).collect();
    let unsettled = found.iter().filter(|star| !star.2).count();
    let radius = found.iter().map(|star| star.1).fold(0.0, f64::max);
    let stars: Vec<Star> = found.into_iter().map(|star| star.0).collect();
    let figures = StarFigures { unsettled, radius, ..StarFigures::of(&stars, |_, _| None) };
    StarSet::of(stars, figures)
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
    let topology = &draped.topology;
    let embedded = || {
        let spoke = |h| Spoke { ends: [topology.target(h), topology.apex(h)], region: topology.region(h.face()) };
        (topology.star(v).map(spoke).collect(), 0.0, false)
    };
    found.unwrap_or_else(embedded)
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
        let mut names = vec![v];
        let mut number: HashMap<VertexId, u32> = HashMap::from([(v, 0)]);
        let mut triangles = Vec::new();
        let mut seen: Vec<_> = Vec::new();
        let mut ring = 0..1;
        for _ in 0..RINGS {
            for u in names[ring.clone()].to_vec() {
                for h in topology.star(u) {
                    if seen.contains(&h.face()) {
                        continue;
                    }
                    seen.push(h.face());
                    triangles.push(topology.corners(h.face()).map(|w| {
                        *number.entry(w).or_insert_with(|| {
                            names.push(w);
                            names.len() as u32 - 1
                        })
                    }));
                }
            }
            ring = ring.end..names.len();
        }
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
        let [u, v] = [turned.u, turned.v].map(|axis| there.flatten(axis));
        Tensor::new(tensor.dot(u, u), tensor.dot(u, v), tensor.dot(v, v))
    }
}

impl Canvas<Draped<'_>> {
    /// The vertices with their tensors, each in a frame of its tangent plane, and the edges of [`Canvas::draped`], of a star
    /// set those of its stars, with lengths along the surface, for methods that know no triangles.
    pub fn surface_graph(&self) -> Graph {
        let draped = self.draped();
        let topology = draped.topology();
        let vertices = || (0..self.vertex_count() as u32).into_par_iter().with_min_len(1024).map(VertexId);
        let planes: Vec<TangentPlane> = vertices().map(|v| draped.plane(v)).collect();
        let tensors = vertices().map(|v| planes[v.index()].restrict(draped.tensor(v))).collect();
        let of_edges = || {
            let mut neighbours = vec![Vec::new(); self.vertex_count()];
            for h in topology.edges() {
                neighbours[topology.origin(h).index()].push(topology.target(h).0);
            }
            neighbours
        };
        let neighbours = self.stars().map_or_else(of_edges, StarSet::neighbours);
        let positions: Vec<Point3> = (0..self.vertex_count() as u32).map(|v| draped.position(VertexId(v))).collect();
        let known = |a, b| topology.find(a, b).or_else(|| topology.find(b, a)).map(|h| topology.length(h));
        let straight = |a: VertexId, b: VertexId| {
            let e = draped.position(b) - draped.position(a);
            let said_by = |m: Tensor3| m.length(e);
            0.5 * (said_by(draped.tensor(a)) + said_by(draped.tensor(b)))
        };
        Graph::seen_by(Arc::new(OnSurface { positions, planes }), tensors, &neighbours)
            .with_lengths(|a, b| known(a, b).unwrap_or_else(|| straight(a.min(b), a.max(b))))
    }
}
