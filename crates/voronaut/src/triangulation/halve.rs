//! Edges cut in two, many at once: the triangulation is made anew, in the order in which it was.

use super::{Constraint, FaceId, HalfEdge, Triangulation, VertexId};
use crate::parallel::prelude::*;

/// A corner of a part of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Corner {
    /// This vertex.
    Vertex(VertexId),
    /// Where the edge of this number is cut.
    Cut(u32),
}

/// No cut, and no number yet.
const NONE: u32 = u32::MAX;

impl Triangulation {
    /// The triangulation with edges cut in two, each named by one of its sides, and what each of its vertices was. Constraints and regions are
    /// kept, lengths are not. Where a part of a face may not stand the edges of the face stay whole. Vertices and faces are numbered in the order
    /// of the faces before.
    pub(crate) fn halved(
        &self,
        cuts: &[HalfEdge],
        stands: impl Fn(FaceId, [Corner; 3]) -> bool + Sync,
    ) -> (Triangulation, Vec<Corner>) {
        let cutting = Cutting::new(self, cuts, stands);
        let slots = (0..self.face_slots() as u32).into_par_iter().map(FaceId).with_min_len(256);
        let parts: Vec<(FaceId, [Corner; 3])> =
            slots.filter(|&f| self.is_face(f)).flat_map_iter(|f| cutting.parts(f).map(move |part| (f, part))).collect();
        let mut made = Numbered {
            vertices: vec![NONE; self.vertex_slots()],
            cuts: vec![NONE; cuts.len()],
            origins: Vec::with_capacity(self.vertex_count() + cuts.len()),
        };
        let triangles: Vec<[u32; 3]> = parts.iter().map(|(_, part)| part.map(|corner| made.number(corner))).collect();
        let regions: Vec<i32> = parts.iter().map(|&(f, _)| self.region(f)).collect();
        let mut topology = Triangulation::from_triangles(made.origins.len(), &triangles, &regions);
        let sides = parts.par_iter().enumerate().with_min_len(256);
        let constraints: Vec<(HalfEdge, Constraint)> =
            sides.flat_map_iter(|(i, &(f, part))| cutting.constraints(f, part, 3 * i as u32)).collect();
        for (h, constraint) in constraints {
            topology.set_constraint(h, constraint);
        }
        (topology, made.origins)
    }
}

struct Cutting<'a> {
    topology: &'a Triangulation,
    /// The cut of each half-edge.
    of: Vec<u32>,
}

impl<'a> Cutting<'a> {
    fn new(
        topology: &'a Triangulation,
        cuts: &[HalfEdge],
        stands: impl Fn(FaceId, [Corner; 3]) -> bool + Sync,
    ) -> Self {
        let mut cutting = Self { topology, of: vec![NONE; 3 * topology.face_slots()] };
        for (i, &h) in (0..).zip(cuts) {
            topology.sides(h).for_each(|h| cutting.of[h.index()] = i);
        }
        let stand = |cutting: &Self, f: FaceId| cutting.parts(f).all(|part| stands(f, part));
        let faces = cuts.par_iter().with_min_len(256).flat_map_iter(|&h| topology.sides(h)).map(HalfEdge::face);
        let mut pending: Vec<FaceId> = faces.filter(|&f| !stand(&cutting, f)).collect();
        while let Some(f) = pending.pop() {
            if stand(&cutting, f) {
                continue;
            }
            for h in f.half_edges().into_iter().filter(|h| cutting.of[h.index()] != NONE).collect::<Vec<_>>() {
                for side in topology.sides(h) {
                    cutting.of[side.index()] = NONE;
                    pending.push(side.face());
                }
            }
        }
        cutting
    }

    /// The triangles that a face becomes.
    fn parts(&self, f: FaceId) -> impl Iterator<Item = [Corner; 3]> + use<> {
        let sides = f.half_edges();
        let cuts = sides.map(|h| Some(self.of[h.index()]).filter(|&cut| cut != NONE).map(Corner::Cut));
        let corners = self.topology.corners(f).map(Corner::Vertex);
        // Turned so that the sides that are cut come first.
        let turn = match cuts.map(|cut| cut.is_some()) {
            [false, true, _] => 1,
            [_, false, true] => 2,
            _ => 0,
        };
        let [a, b, c] = [0, 1, 2].map(|i| corners[(i + turn) % 3]);
        let parts = match [0, 1, 2].map(|i| cuts[(i + turn) % 3]) {
            [Some(p), Some(q), Some(r)] => [Some([a, p, r]), Some([p, b, q]), Some([r, q, c]), Some([p, q, r])],
            [Some(p), Some(q), None] => [Some([p, b, q]), Some([p, q, c]), Some([a, p, c]), None],
            [Some(p), None, None] => [Some([a, p, c]), Some([p, b, c]), None, None],
            _ => [Some([a, b, c]), None, None, None],
        };
        parts.into_iter().flatten()
    }

    /// The constraints of a part of a face, whose half-edges are numbered from one on.
    fn constraints(&self, f: FaceId, part: [Corner; 3], first: u32) -> impl Iterator<Item = (HalfEdge, Constraint)> {
        let is_constrained = f.half_edges().into_iter().any(|h| self.topology.constraint(h).is_some());
        (0..if is_constrained { 3 } else { 0 }).filter_map(move |i| {
            let side = self.side(f, [part[i], part[(i + 1) % 3]])?;
            Some((HalfEdge(first + i as u32), self.topology.constraint(side)?))
        })
    }

    /// The side of a face that an edge between two corners is part of, if it is one.
    fn side(&self, f: FaceId, ends: [Corner; 2]) -> Option<HalfEdge> {
        let is_on = |h: HalfEdge, corner: Corner| match corner {
            Corner::Vertex(v) => self.topology.ends(h).contains(&v),
            Corner::Cut(i) => self.of[h.index()] == i,
        };
        f.half_edges().into_iter().find(|&h| ends.into_iter().all(|corner| is_on(h, corner)))
    }
}

/// The new numbers of vertices and cuts, and what has each number.
struct Numbered {
    vertices: Vec<u32>,
    cuts: Vec<u32>,
    origins: Vec<Corner>,
}

impl Numbered {
    fn number(&mut self, corner: Corner) -> u32 {
        let slot = match corner {
            Corner::Vertex(v) => &mut self.vertices[v.index()],
            Corner::Cut(i) => &mut self.cuts[i as usize],
        };
        if *slot == NONE {
            *slot = self.origins.len() as u32;
            self.origins.push(corner);
        }
        *slot
    }
}
