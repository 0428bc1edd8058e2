//! Finding the face of the embedded triangulation that holds a point, in any domain.

use super::Canvas;
use crate::elementary::Elementary;
use crate::geometry::{Aabb, BoxTree, Point, holds, widened};
use crate::planar::{Location, Planar, hilbert_order};
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::collections::HashMap;
use std::sync::OnceLock;

/// Points outside the domain by no more than this, as a share of the largest coordinate, are on its border.
const ROUNDING: f64 = 1e-14;

/// Where to start walks from, and what to fall back on where holes bar the way.
#[derive(Debug)]
pub(super) struct Finder {
    anchors: Vec<VertexId>,
    tree: OnceLock<BoxTree<FaceId, 2>>,
    /// Vertices that share their position with others, by position: the fans of pinched vertices.
    copies: HashMap<[u64; 2], Vec<VertexId>>,
    /// What holds the domain; far from it predicates overflow.
    bounds: Option<Aabb>,
    /// What coordinates may err by in the computations that made them.
    rounding: f64,
}

impl Finder {
    pub(super) fn new(planar: &Planar) -> Self {
        // Jump and walk (Mücke, Saias and Zhu 1999): the nearest of a cube root of all vertices is a cube root's walk
        // away. Along the Hilbert curve every k-th vertex is a well-spread sample.
        let step = (planar.positions.len() as f64).raised_to(2.0 / 3.0).ceil().max(1.0) as usize;
        let anchors = (0..planar.positions.len() as u32).step_by(step).map(VertexId).collect();
        let largest = planar.positions.iter().map(|p| p.x.abs().max(p.y.abs())).fold(0.0, f64::max);
        let bounds = Aabb::of(planar.positions.iter().copied());
        Self { anchors, tree: OnceLock::new(), copies: copies(planar), bounds, rounding: ROUNDING * largest }
    }
}

impl Canvas {
    /// The face, edge or vertex of the embedded triangulation that holds a point; `None` outside the domain. A point
    /// that rounding has put beside a slanted border is on it.
    pub(crate) fn locate(&self, p: Point) -> Option<Location> {
        let near = |v: &&VertexId| self.position(**v).distance(p);
        let anchor = self.embedded.finder.anchors.iter().min_by(|a, b| near(a).total_cmp(&near(b)))?;
        self.locate_from(self.embedded.planar.topology.start(*anchor)?.face(), p)
    }

    /// [`Canvas::locate`] for a point that is near a face.
    pub(crate) fn locate_from(&self, near: FaceId, p: Point) -> Option<Location> {
        let Finder { bounds: Some(bounds), rounding, .. } = &self.embedded.finder else { return None };
        let is_between = |x: f64, low: f64, high: f64| x >= low - rounding && x <= high + rounding;
        if !is_between(p.x, bounds.min.x, bounds.max.x) || !is_between(p.y, bounds.min.y, bounds.max.y) {
            return None;
        }
        match self.embedded.planar.walk(near, p, false) {
            Location::Behind(h) if self.is_beside(h, p) => Some(Location::Edge(h)),
            Location::Behind(_) => self.search(p),
            found => Some(found),
        }
    }

    /// The number of the first of some points that is outside the domain.
    pub fn first_outside(&self, points: &[Point]) -> Option<usize> {
        self.locate_all(points).iter().position(Option::is_none)
    }

    /// [`Canvas::locate`] for many points.
    pub(crate) fn locate_all(&self, points: &[Point]) -> Vec<Option<Location>> {
        let mut locations: Vec<Option<Location>> = vec![None; points.len()];
        let mut near: Option<FaceId> = None;
        for i in hilbert_order(points).into_iter().map(|i| i as usize) {
            let found = near.map_or_else(|| self.locate(points[i]), |f| self.locate_from(f, points[i]));
            near = found.and_then(|location| self.face_of(location)).or(near);
            locations[i] = found;
        }
        locations
    }

    /// The corners of the embedded face that holds a point, with its barycentric coordinates where they are not zero; `None`
    /// outside the domain.
    pub(crate) fn weights(&self, p: Point) -> Option<Vec<(VertexId, f64)>> {
        let location = self.locate(p)?;
        if let Location::Vertex(v) = location {
            return Some(vec![(v, 1.0)]);
        }
        let f = self.face_of(location)?;
        let [a, b, c] = self.embedded.planar.triangle(f);
        let areas = [(b, c), (c, a), (a, b)].map(|(u, v)| (u - p).cross(v - p).max(0.0));
        let sum: f64 = areas.iter().sum();
        let all = self.embedded.planar.topology.corners(f).into_iter().zip(areas.map(|area| area / sum));
        Some(all.filter(|w| w.1 > 0.0).collect())
    }

    /// The vertices at the position of a vertex, in order: more than one where the domain touches itself in a point, one
    /// for each fan of faces.
    pub(crate) fn copies(&self, v: VertexId) -> Vec<VertexId> {
        self.embedded.finder.copies.get(&key(self.position(v))).map_or_else(|| vec![v], Clone::clone)
    }

    /// The face of the embedded triangulation at a place, one of several.
    pub(crate) fn face_of(&self, location: Location) -> Option<FaceId> {
        match location {
            Location::Face(f) => Some(f),
            Location::Edge(h) | Location::Behind(h) => Some(h.face()),
            Location::Vertex(v) => self.embedded.planar.topology.start(v).map(HalfEdge::face),
        }
    }

    /// Looks at all faces whose boxes hold the point. The tree is made when it is first needed.
    fn search(&self, p: Point) -> Option<Location> {
        let tree = self.embedded.finder.tree.get_or_init(|| boxes(&self.embedded.planar));
        let around = widened([[p.x, p.y]; 2], self.embedded.finder.rounding);
        let topology = &self.embedded.planar.topology;
        let near = || tree.meeting(around).copied();
        let holds = |f: &FaceId| holds(self.embedded.planar.triangle(*f), p);
        // From a face that holds the point the walk ends at once.
        let inside = near().filter(holds).min().map(|face| self.embedded.planar.walk(face, p, false));
        let at_border = |h: &HalfEdge| topology.twin(*h).is_none() && self.is_beside(*h, p);
        inside.or_else(|| near().flat_map(FaceId::half_edges).filter(at_border).min().map(Location::Edge))
    }

    /// Whether a point lies, but for rounding, on an edge.
    fn is_beside(&self, h: HalfEdge, p: Point) -> bool {
        let [a, b] = self.embedded.planar.ends(h);
        p.nearest_between(a, b).distance(p) <= self.embedded.finder.rounding
    }
}

/// One key for a position, whatever the signs of its zeros.
fn key(p: Point) -> [u64; 2] {
    [p.x + 0.0, p.y + 0.0].map(f64::to_bits)
}

fn copies(planar: &Planar) -> HashMap<[u64; 2], Vec<VertexId>> {
    let topology = &planar.topology;
    let borders = topology.borders();
    let mut at: HashMap<[u64; 2], Vec<VertexId>> = HashMap::new();
    // A vertex starts one side of the border.
    for v in borders.map(|h| topology.origin(h)) {
        at.entry(key(planar.position(v))).or_default().push(v);
    }
    at.retain(|_, vertices| vertices.len() > 1);
    for vertices in at.values_mut() {
        vertices.sort_unstable();
    }
    at
}

fn boxes(planar: &Planar) -> BoxTree<FaceId, 2> {
    BoxTree::new(planar.topology.faces().filter_map(|face| Some((Aabb::of(planar.triangle(face))?.into(), face))))
}
