//! Finding the face of the embedded triangulation that holds a point, in any domain.

use super::Canvas;
use crate::geometry::{Orientation, Point, orientation};
use crate::planar::{Location, Planar};
use crate::triangulation::{FaceId, VertexId};
use rstar::{AABB, RTree, RTreeObject};
use std::sync::OnceLock;

/// Where to start walks from, and what to fall back on where holes bar the way.
#[derive(Debug)]
pub(super) struct Finder {
    anchors: Vec<VertexId>,
    tree: OnceLock<RTree<Boxed>>,
}

impl Finder {
    pub(super) fn new(planar: &Planar) -> Self {
        // Jump and walk (Mücke, Saias and Zhu 1999): the nearest of a cube root of all vertices is a cube root's walk
        // away. Along the Hilbert curve every k-th vertex is a well-spread sample.
        let step = (planar.positions.len() as f64).powf(2.0 / 3.0).ceil().max(1.0) as usize;
        let anchors = (0..planar.positions.len() as u32).step_by(step).map(VertexId).collect();
        Self { anchors, tree: OnceLock::new() }
    }
}

impl Canvas {
    /// The face, edge or vertex of the embedded triangulation that holds a point; `None` outside the domain.
    pub fn locate(&self, p: Point) -> Option<Location> {
        if !p.is_finite() {
            return None;
        }
        let near = |v: &&VertexId| self.position(**v).distance(p);
        let anchor = self.finder.anchors.iter().min_by(|a, b| near(a).total_cmp(&near(b)))?;
        self.locate_from(self.embedded.topology.start(*anchor)?.face(), p)
    }

    /// [`Canvas::locate`] for a point that is near a face.
    pub fn locate_from(&self, near: FaceId, p: Point) -> Option<Location> {
        match self.embedded.walk(near, p, false) {
            Location::Behind(_) => self.search(p),
            found => Some(found),
        }
    }

    /// Looks at all faces whose boxes hold the point. The tree is made when it is first needed.
    fn search(&self, p: Point) -> Option<Location> {
        let tree = self.finder.tree.get_or_init(|| RTree::bulk_load(boxes(&self.embedded)));
        let at_point = AABB::from_point([p.x, p.y]);
        let holds = |f: &FaceId| {
            let [a, b, c] = self.embedded.triangle(*f);
            [(a, b), (b, c), (c, a)].iter().all(|&(u, v)| orientation(u, v, p) != Orientation::Right)
        };
        let face = tree.locate_in_envelope_intersecting(at_point).map(|boxed| boxed.face).filter(holds).min()?;
        // From a face that holds the point the walk ends at once.
        Some(self.embedded.walk(face, p, false))
    }
}

#[derive(Debug)]
struct Boxed {
    face: FaceId,
    envelope: AABB<[f64; 2]>,
}

impl RTreeObject for Boxed {
    type Envelope = AABB<[f64; 2]>;
    fn envelope(&self) -> Self::Envelope {
        self.envelope
    }
}

fn boxes(planar: &Planar) -> Vec<Boxed> {
    let boxed = |face: FaceId| {
        let corners = planar.triangle(face).map(|p| [p.x, p.y]);
        Boxed { face, envelope: AABB::from_points(&corners) }
    };
    planar.topology.faces().map(boxed).collect()
}
