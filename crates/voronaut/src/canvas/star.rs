//! The star of a vertex in the constrained Delaunay triangulation in its own metric (RR-9103, section 7.1), found from any
//! embedded triangulation of the vertices: gift wrapping around the vertex, each circle searched for what it holds.
//!
//! Positions are taken into an orthonormal frame of the metric first; there the predicate is exact, and four points on one
//! circle are told apart by their numbers. So vertices with the same tensor agree on every triangle.

use crate::geometry::{Orientation, Point, Tensor, Vector, in_circle, orientation, signed_area};
use crate::planar::Planar;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};

/// Circles are searched with this share more of their squared radius: their centres are rounded.
const SLACK: f64 = 1e-9;

/// The triangles around a vertex, each by its other two vertices, counter-clockwise, with the region it lies in.
pub(super) type Star = Vec<Spoke>;

/// A triangle of a star: with the vertex itself it is counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Spoke {
    pub(super) ends: [VertexId; 2],
    pub(super) region: i32,
}

/// Whether the star of a vertex has the triangle of the vertex and these two.
pub(super) fn has(star: &[Spoke], ends: [VertexId; 2]) -> bool {
    star.iter().any(|spoke| spoke.ends == ends)
}

/// The star of a vertex in a triangulation as it is.
pub(super) fn as_it_is(topology: &Triangulation, v: VertexId) -> Star {
    let spoke = |h| Spoke { ends: [topology.target(h), topology.apex(h)], region: topology.region(h.face()) };
    topology.star(v).map(spoke).collect()
}

/// Centre (in the plane) and radius (in the metric) of a triangle's circle in one tensor; `None` where it is flat.
pub(super) fn circle(tensor: Tensor, [v, a, b]: [Point; 3]) -> Option<(Point, f64)> {
    let (p, q) = (a - v, b - v);
    let (pp, qq, pq) = (tensor.dot(p, p), tensor.dot(q, q), tensor.dot(p, q));
    let twice = 2.0 * (pp * qq - pq * pq);
    let to_centre = p * (qq * (pp - pq) / twice) + q * (pp * (qq - pq) / twice);
    let radius = tensor.length(to_centre);
    (twice > 0.0 && radius.is_finite()).then(|| (v + to_centre, radius))
}

/// Searches stars; its memory is used again from one to the next.
pub(super) struct Finder<'a> {
    planar: &'a Planar,
    seen_faces: Vec<u32>,
    seen_vertices: Vec<u32>,
    stamp: u32,
    faces: Vec<FaceId>,
    candidates: Vec<VertexId>,
    /// An orthonormal one of the tensor: see [`Tensor::cholesky`].
    frame: [f64; 3],
    /// Whether the last search met a fixed edge.
    is_barred: bool,
}

/// A part of the plane around a vertex between two fixed edges (or all of it).
struct Sector {
    faces: Vec<FaceId>,
    ring: Vec<VertexId>,
    region: i32,
    is_whole: bool,
}

impl<'a> Finder<'a> {
    pub(super) fn new(planar: &'a Planar) -> Self {
        Self {
            planar,
            seen_faces: vec![0; planar.topology.face_slots()],
            seen_vertices: vec![0; planar.topology.vertex_slots()],
            stamp: 0,
            faces: Vec::new(),
            candidates: Vec::new(),
            frame: [1.0, 0.0, 1.0],
            is_barred: false,
        }
    }

    /// The star of a vertex in a tensor. `None` where rounding leads wrapping astray.
    pub(super) fn star(&mut self, v: VertexId, tensor: Tensor) -> Option<Star> {
        self.frame = tensor.cholesky();
        let mut star = Star::new();
        for sector in sectors(self.planar, v) {
            let [first, last] = if sector.is_whole {
                let nearest = self.nearest(v, &sector)?;
                [nearest, nearest]
            } else {
                [*sector.ring.first()?, *sector.ring.last()?]
            };
            let mut at = first;
            loop {
                let next = self.next(v, at, &sector)?;
                star.push(Spoke { ends: [at, next], region: sector.region });
                at = next;
                if at == last {
                    break;
                }
                if star.len() > self.planar.positions.len() {
                    return None;
                }
            }
        }
        Some(star)
    }

    fn at(&self, v: VertexId) -> Point {
        let (p, [a, b, c]) = (self.planar.position(v), self.frame);
        Point::new(a * p.x + b * p.y, c * p.y)
    }

    /// The nearest vertex that can be seen.
    fn nearest(&mut self, v: VertexId, sector: &Sector) -> Option<VertexId> {
        let centre = self.at(v);
        let distance = |finder: &Self, u: VertexId| finder.at(u).distance(centre);
        let reach = sector.ring.iter().map(|&u| distance(self, u)).fold(f64::INFINITY, f64::min);
        self.start(v);
        self.search(sector, centre, reach * reach * (1.0 + SLACK));
        let mut found: Vec<(f64, VertexId)> = self.candidates.iter().map(|&u| (distance(self, u), u)).collect();
        found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        found.into_iter().map(|(_, u)| u).find(|&u| !self.is_barred || self.sees(v, u, sector))
    }

    /// The third vertex of the Delaunay triangle left of v-u.
    fn next(&mut self, v: VertexId, u: VertexId, sector: &Sector) -> Option<VertexId> {
        self.start(v);
        self.is_barred = !sector.is_whole;
        self.take(u);
        let (p, q) = (self.planar.position(v), self.planar.position(u));
        for &w in &sector.ring {
            self.take(w);
        }
        let mut rejected = vec![u];
        let mut begin = 0;
        let mut best: Option<VertexId> = None;
        loop {
            let is_new = best.is_none();
            for i in begin..self.candidates.len() {
                let w = self.candidates[i];
                let is_left = || orientation(p, q, self.planar.position(w)) == Orientation::Left;
                if !rejected.contains(&w) && is_left() && best.is_none_or(|b| self.is_inside([v, u, b], w)) {
                    best = Some(w);
                }
            }
            begin = self.candidates.len();
            let found = best?;
            if is_new {
                let (centre, square) = centre([self.at(v), self.at(u), self.at(found)])?;
                self.search(sector, centre, square * (1.0 + SLACK));
                if begin < self.candidates.len() {
                    continue;
                }
            }
            if !self.is_barred || (self.sees(v, found, sector) && self.sees_far(u, found)) {
                return Some(found);
            }
            rejected.push(found);
            (best, begin) = (None, 0);
        }
    }

    /// Begins a search.
    fn start(&mut self, v: VertexId) {
        self.stamp += 1;
        self.candidates.clear();
        self.is_barred = false;
        self.seen_vertices[v.index()] = self.stamp;
    }

    fn take(&mut self, w: VertexId) {
        if self.seen_vertices[w.index()] != self.stamp {
            self.seen_vertices[w.index()] = self.stamp;
            self.candidates.push(w);
        }
    }

    /// Takes the vertices in a circle of the frame, from the faces of a sector on, across no fixed edge.
    fn search(&mut self, sector: &Sector, centre: Point, square: f64) {
        // Faces are seen anew for each circle.
        let vertices = self.stamp;
        self.stamp += 1;
        for &f in &sector.faces {
            self.seen_faces[f.index()] = self.stamp;
        }
        self.faces.clone_from(&sector.faces);
        let planar = self.planar;
        while let Some(f) = self.faces.pop() {
            for h in f.half_edges() {
                let [w, to] = planar.topology.ends(h);
                let (a, b) = (self.at(w), self.at(to));
                let is_taken = [vertices, self.stamp].contains(&self.seen_vertices[w.index()]);
                if !is_taken && (a - centre).dot(a - centre) <= square {
                    self.seen_vertices[w.index()] = self.stamp;
                    self.candidates.push(w);
                }
                if square_distance(centre, a, b) > square {
                    continue;
                }
                let Some(t) = planar.topology.twin(h).filter(|_| !planar.topology.is_fixed(h)) else {
                    self.is_barred = true;
                    continue;
                };
                if self.seen_faces[t.face().index()] != self.stamp {
                    self.seen_faces[t.face().index()] = self.stamp;
                    self.faces.push(t.face());
                }
            }
        }
        for i in 0..self.candidates.len() {
            self.seen_vertices[self.candidates[i].index()] = self.stamp;
        }
    }

    /// Whether d is in the circle of a counter-clockwise triangle, in the frame; of points on it, by their numbers: it is as
    /// if each were lifted a little, those with smaller numbers infinitely more.
    fn is_inside(&self, [a, b, c]: [VertexId; 3], d: VertexId) -> bool {
        let [p, q, r, s] = [a, b, c, d].map(|v| self.at(v));
        let exact = in_circle(p, q, r, s);
        if exact != 0.0 {
            return exact > 0.0;
        }
        let mut lifts = [
            (a, signed_area(q, r, s)),
            (b, -signed_area(p, r, s)),
            (c, signed_area(p, q, s)),
            (d, -signed_area(p, q, r)),
        ];
        lifts.sort_by_key(|lift| lift.0);
        lifts.iter().map(|lift| lift.1).find(|&sign| sign != 0.0).is_some_and(|sign| sign > 0.0)
    }

    /// Whether the straight way from v into a sector to w crosses no fixed edge.
    fn sees(&self, v: VertexId, w: VertexId, sector: &Sector) -> bool {
        if sector.ring.contains(&w) {
            return true;
        }
        let Some(crossed) = self.planar.edges_between(v, w) else { return false };
        sector.faces.contains(&crossed[0].face()) && !crossed.iter().any(|&h| self.planar.topology.is_fixed(h))
    }

    /// Whether two vertices are joined, or could be across no fixed edge.
    fn sees_far(&self, a: VertexId, b: VertexId) -> bool {
        let topology = &self.planar.topology;
        let is_free = |crossed: Vec<HalfEdge>| !crossed.into_iter().any(|h| topology.is_fixed(h));
        topology.edge_between(a, b).is_some() || self.planar.edges_between(a, b).is_some_and(is_free)
    }
}

/// The parts between the fixed edges at a vertex.
fn sectors(planar: &Planar, v: VertexId) -> Vec<Sector> {
    let topology = &planar.topology;
    let mut spokes: Vec<HalfEdge> = topology.star(v).collect();
    let first_fixed = spokes.iter().position(|&h| topology.is_fixed(h));
    let Some(first) = first_fixed else {
        let ring = spokes.iter().map(|&h| topology.target(h)).collect();
        let faces: Vec<FaceId> = spokes.iter().map(|h| h.face()).collect();
        let region = faces.first().map_or(0, |&f| topology.region(f));
        return vec![Sector { faces, ring, region, is_whole: true }];
    };
    spokes.rotate_left(first);
    let mut sectors: Vec<Sector> = Vec::new();
    for h in spokes {
        if topology.is_fixed(h) {
            let (ring, region) = (vec![topology.target(h)], topology.region(h.face()));
            sectors.push(Sector { faces: Vec::new(), ring, region, is_whole: false });
        }
        if let Some(sector) = sectors.last_mut() {
            sector.faces.push(h.face());
            sector.ring.push(topology.apex(h));
        }
    }
    sectors
}

/// Centre and squared radius of a triangle's Euclidean circle; `None` where it is flat but for rounding.
pub(super) fn centre([a, b, c]: [Point; 3]) -> Option<(Point, f64)> {
    let (u, v) = (b - a, c - a);
    let (uu, vv, twice) = (u.dot(u), v.dot(v), 2.0 * u.cross(v));
    let to_centre = Vector::new(v.y * uu - u.y * vv, u.x * vv - v.x * uu) * (1.0 / twice);
    let square = to_centre.dot(to_centre);
    (twice > 0.0 && square.is_finite()).then(|| (a + to_centre, square))
}

fn square_distance(p: Point, a: Point, b: Point) -> f64 {
    let off = p - p.nearest_between(a, b);
    off.dot(off)
}
