//! Changes that keep the embedding: each checks first, and does nothing where the result would not be embedded.

use super::Planar;
use crate::geometry::{Orientation, Point, orientation};
use crate::triangulation::{FaceId, HalfEdge, VertexId};

impl Planar {
    /// Puts a vertex strictly inside a face. `None` if rounding put the point on or beyond the face's edges.
    pub(crate) fn insert_in_face(&mut self, f: FaceId, p: Point) -> Option<VertexId> {
        let [a, b, c] = self.triangle(f);
        let inside = [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| is_left(u, v, p));
        inside.then(|| {
            let v = self.add_vertex(p);
            self.topology.split_face(f, v);
            v
        })
    }

    /// Puts a vertex on an edge (or where rounding put it, next to the edge). `None` if one of the new triangles would
    /// not be counter-clockwise.
    pub(crate) fn insert_on_edge(&mut self, h: HalfEdge, p: Point) -> Option<VertexId> {
        let fits = |side: HalfEdge| {
            let [a, b] = self.ends(side);
            let c = self.position(self.topology.apex(side));
            is_left(a, p, c) && is_left(p, b, c)
        };
        (fits(h) && self.topology.twin(h).is_none_or(fits)).then(|| {
            let v = self.add_vertex(p);
            self.topology.split_edge(h, v);
            v
        })
    }

    /// Moves a vertex if all its faces stay counter-clockwise; says whether it did.
    pub(crate) fn move_vertex(&mut self, v: VertexId, to: Point) -> bool {
        let topology = &self.topology;
        let fits =
            topology.star(v).all(|h| is_left(to, self.position(topology.target(h)), self.position(topology.apex(h))));
        if fits {
            self.positions[v.index()] = to;
        }
        fits
    }

    /// Removes an interior vertex that no constraint touches: flips its edges away until three are left. Says whether
    /// it could; where it could not, the vertex stays, with fewer edges.
    pub(crate) fn remove_vertex(&mut self, v: VertexId) -> bool {
        if self.topology.is_border_vertex(v) || self.topology.star(v).any(|h| self.topology.is_fixed(h)) {
            return false;
        }
        while self.topology.star(v).count() > 3 {
            let Some(spoke) = self.topology.star(v).find(|&h| self.is_convex(h)) else { return false };
            self.topology.flip(spoke);
        }
        let link: Vec<Point> = self.topology.star(v).map(|h| self.position(self.topology.target(h))).collect();
        let fits = link.len() == 3 && is_left(link[0], link[1], link[2]);
        if fits {
            self.topology.remove_degree_three(v);
        }
        fits
    }

    fn add_vertex(&mut self, p: Point) -> VertexId {
        let v = self.topology.add_vertex();
        if v.index() == self.positions.len() {
            self.positions.push(p);
        } else {
            self.positions[v.index()] = p;
        }
        v
    }
}

fn is_left(a: Point, b: Point, c: Point) -> bool {
    orientation(a, b, c) == Orientation::Left
}
