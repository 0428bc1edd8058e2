//! The few verbs that change a triangulation. None of them reads positions; whether the result is embedded is the
//! caller's to know ([`crate::planar`]).

use super::ids::NONE;
use super::{FACES, FaceId, HalfEdge, Triangulation, VertexId};
use crate::lists::distinct;
use crate::parallel::prelude::*;

impl Triangulation {
    /// Which of many moves can be made all at once, by vertex slot: none of corners of faces that would turn over by what is left of
    /// them, which the caller tells. Without moves no face does.
    pub(crate) fn movable_together(
        &self,
        mut moves: Vec<bool>,
        would_turn: impl Fn(FaceId, &[bool]) -> bool + Sync,
    ) -> Vec<bool> {
        let faces = (0..self.face_slots() as u32).into_par_iter().with_min_len(FACES).map(FaceId);
        let mut turned: Vec<FaceId> = faces.filter(|&f| self.is_face(f) && would_turn(f, &moves)).collect();
        while !turned.is_empty() {
            let corners = distinct(turned.iter().flat_map(|&f| self.corners(f)));
            let back: Vec<VertexId> = corners.into_iter().filter(|v| moves[v.index()]).collect();
            for v in &back {
                moves[v.index()] = false;
            }
            let around = distinct(back.iter().flat_map(|&v| self.star(v)).map(HalfEdge::face));
            turned = around.into_iter().filter(|&f| would_turn(f, &moves)).collect();
        }
        moves
    }

    /// A new vertex that belongs to no face yet.
    pub(crate) fn add_vertex(&mut self) -> VertexId {
        self.free_vertices.pop().unwrap_or_else(|| {
            self.start.push(NONE);
            VertexId(self.start.len() as u32 - 1)
        })
    }

    /// Replaces the edge by the other diagonal of its two faces.
    ///
    /// ```text
    ///        c                    c
    ///      / | \                /   \
    ///     /  |  \              /     \
    ///    a --h-> b    =>      a       b    with h : d -> c  (the twin: c -> d)
    ///     \  |  /              \     /
    ///      \ | /                \   /
    ///        d                    d
    /// ```
    ///
    /// (drawn with h from a to b, faces a b c and b a d). The new edge's length is NaN. The caller owes an edge with
    /// two different faces and no constraint; outer edges of the two may be glued to each other.
    pub(crate) fn flip(&mut self, h: HalfEdge) {
        let t = self.twin(h).expect("a border edge has one face and cannot be flipped");
        debug_assert!(!self.is_fixed(h), "a constrained edge cannot be flipped");
        let (c, d) = (self.apex(h), self.apex(t));
        let (bc, ca, ad, db) = (h.next(), h.prev(), t.next(), t.prev());
        let (from, to) = ([ca, ad, db, bc], [h.next(), h.prev(), t.next(), t.prev()]);
        let outer = from.map(|e| self.take(e).with_moved_twin(from, to));
        for (slot, record) in to.into_iter().zip(outer) {
            self.put(slot, record);
        }
        self.origin[h.index()] = d;
        self.origin[t.index()] = c;
        self.length[h.index()] = f64::NAN;
        self.length[t.index()] = f64::NAN;
        for e in h.face().half_edges().into_iter().chain(t.face().half_edges()) {
            self.set_start(e);
        }
    }

    /// Puts a vertex inside a face: three faces instead of one. The face's own edges keep their slots' lengths.
    pub(crate) fn split_face(&mut self, f: FaceId, v: VertexId) {
        let [ab, bc, ca] = f.half_edges();
        let [a, b, c] = self.corners(f);
        let region = self.region(f);
        let (outer_bc, outer_ca) = (self.take(bc), self.take(ca));
        let second = self.push_face([b, c, v], region);
        let third = self.push_face([c, a, v], region);
        self.put(second.half_edges()[0], outer_bc);
        self.put(third.half_edges()[0], outer_ca);
        self.clear(bc, b);
        self.clear(ca, v);
        let [_, second_cv, second_vb] = second.half_edges();
        let [_, third_av, third_vc] = third.half_edges();
        self.glue(bc, second_vb);
        self.glue(second_cv, third_vc);
        self.glue(third_av, ca);
        for e in [ab, bc, ca].into_iter().chain(second.half_edges()).chain(third.half_edges()) {
            self.set_start(e);
        }
    }

    /// Puts a vertex on an edge; both halves inherit the constraint. Returns the half-edge from the new vertex to the
    /// old target; `h` itself now ends at the new vertex.
    pub(crate) fn split_edge(&mut self, h: HalfEdge, v: VertexId) -> HalfEdge {
        let twin = self.twin(h);
        let constraint = self.constraint[h.index()];
        let lower = self.halve(h, v);
        let mut touched = vec![h, lower];
        if let Some(t) = twin {
            let upper = self.halve(t, v);
            self.glue(h, upper);
            self.glue(lower, t);
            touched.extend([t, upper]);
            self.constraint[upper.index()] = constraint;
        } else {
            self.twin[h.index()] = NONE;
        }
        self.constraint[lower.index()] = constraint;
        for e in touched.into_iter().flat_map(|e| e.face().half_edges()) {
            self.set_start(e);
        }
        lower
    }

    /// Cuts the face left of h: a -> b (apex c) into a v c, which keeps the slot, and v b c, which is new. Returns
    /// the half-edge v -> b.
    fn halve(&mut self, h: HalfEdge, v: VertexId) -> HalfEdge {
        let (b, c) = (self.target(h), self.apex(h));
        let bc = h.next();
        let outer = self.take(bc);
        let region = self.region(h.face());
        let new = self.push_face([v, b, c], region);
        let [vb, new_bc, cv] = new.half_edges();
        self.put(new_bc, outer);
        self.clear(bc, v);
        self.length[h.index()] = f64::NAN;
        self.glue(bc, cv);
        vb
    }

    /// Removes an interior vertex with exactly three faces: one face instead.
    ///
    /// # Panics
    /// If the vertex has not three faces, or lies on the border.
    pub(crate) fn remove_degree_three(&mut self, v: VertexId) {
        let spokes: Vec<HalfEdge> = self.star(v).collect();
        assert!(spokes.len() == 3 && !self.is_border_vertex(v), "only an interior vertex of degree three");
        let links = [spokes[0], spokes[1], spokes[2]].map(HalfEdge::next);
        let kept = links[0].face();
        let outer = links.map(|e| self.take(e));
        for (slot, record) in kept.half_edges().into_iter().zip(outer) {
            self.put(slot, record);
        }
        for e in &links[1..] {
            self.kill(e.face());
        }
        self.start[v.index()] = NONE;
        self.free_vertices.push(v);
        for e in kept.half_edges() {
            self.set_start(e);
        }
    }

    /// Whether [`Triangulation::collapse`] keeps every vertex in one fan and makes no edge double: the ends of the edge
    /// have no common neighbours but the apexes of its faces, and no apex would be left with two faces or none; an
    /// inner edge has no more than one end on the border (the link condition; Dey et al. 1999).
    pub(crate) fn can_collapse(&self, h: HalfEdge) -> bool {
        let (a, b, twin) = (self.origin(h), self.target(h), self.twin(h));
        if a == b || twin.is_some() && self.is_border_vertex(a) && self.is_border_vertex(b) {
            return false;
        }
        let sides = [Some(h), twin];
        let apexes = sides.map(|side| side.map(|side| self.apex(side)));
        let stays = |&apex: &VertexId| {
            let least = if self.is_border_vertex(apex) { 1 } else { 3 };
            self.star(apex).nth(least).is_some()
        };
        let [few, many] = if self.has_fewer(a, b) { [a, b] } else { [b, a] };
        let others = self.neighbours(few).into_iter().filter(|&v| v != many && !apexes.contains(&Some(v)));
        apexes.iter().flatten().all(stays)
            && apexes[0] != apexes[1]
            && others.into_iter().all(|v| self.around(v).all(|w| w != many))
    }

    /// Whether one vertex has no more neighbours than another, in as many steps as the one with fewer has.
    fn has_fewer(&self, v: VertexId, w: VertexId) -> bool {
        let (mut of_v, mut of_w) = (self.star(v), self.star(w));
        loop {
            match (of_v.next(), of_w.next()) {
                (None, _) => return true,
                (_, None) => return false,
                _ => {}
            }
        }
    }

    /// The vertices that an edge joins to this one.
    fn neighbours(&self, v: VertexId) -> Vec<VertexId> {
        distinct(self.around(v))
    }

    /// Removes the origin of an edge: its edges end at the edge's target instead, and the faces of the edge vanish.
    /// Lengths of all edges at the target become NaN. The caller owes [`Triangulation::can_collapse`].
    pub(crate) fn collapse(&mut self, h: HalfEdge) {
        self.merge(h, self.target(h));
    }

    /// Removes the target of an edge, as [`Triangulation::collapse`] does its origin.
    pub(crate) fn collapse_back(&mut self, h: HalfEdge) {
        self.merge(h, self.origin(h));
    }

    /// Makes the ends of an edge one of them.
    fn merge(&mut self, h: HalfEdge, kept: VertexId) {
        let (a, b) = (self.origin(h), self.target(h));
        let fan: Vec<HalfEdge> = self.star(a).chain(self.star(b)).collect();
        for &e in &fan {
            self.origin[e.index()] = kept;
        }
        let gone = if kept == a { b } else { a };
        let mut touched = fan;
        for side in [Some(h), self.twin(h)].into_iter().flatten() {
            let outer = [side.next(), side.prev()].map(|e| self.twin(e));
            let constraint = self.constraint(side.next()).or_else(|| self.constraint(side.prev()));
            self.kill(side.face());
            match outer {
                [Some(e), Some(g)] => self.glue(e, g),
                [one, other] => one.or(other).into_iter().for_each(|e| self.twin[e.index()] = NONE),
            }
            for e in outer.into_iter().flatten() {
                self.constraint[e.index()] = constraint.map_or(NONE, |c| c.0);
                touched.extend(e.face().half_edges());
            }
        }
        self.start[gone.index()] = NONE;
        self.free_vertices.push(gone);
        touched.retain(|e| self.is_face(e.face()));
        for e in touched {
            self.set_start(e);
        }
        for e in self.star(kept).collect::<Vec<_>>() {
            self.set_length(e, f64::NAN);
            self.set_length(e.prev(), f64::NAN);
        }
    }

    /// Removes faces; edges between a removed and a kept face become border. Vertices left without a face are freed.
    pub(crate) fn retain_faces(&mut self, keep: impl Fn(FaceId) -> bool) {
        let doomed: Vec<FaceId> = self.faces().filter(|&f| !keep(f)).collect();
        for &f in &doomed {
            for h in f.half_edges() {
                if let Some(t) = self.twin(h) {
                    self.twin[t.index()] = NONE;
                }
            }
            self.kill(f);
        }
        let living: Vec<HalfEdge> = self.faces().flat_map(FaceId::half_edges).collect();
        let mut start = vec![NONE; self.start.len()];
        std::mem::swap(&mut start, &mut self.start);
        for h in living {
            self.set_start(h);
        }
        for (v, &old) in start.iter().enumerate() {
            if old != NONE && self.start[v] == NONE {
                self.free_vertices.push(VertexId(v as u32));
            }
        }
    }

    /// Gives every fan of faces around a vertex its own vertex, so that no vertex joins two parts of the border only
    /// by itself. Returns pairs (new vertex, the vertex that it was split from).
    pub(crate) fn split_pinched_vertices(&mut self) -> Vec<(VertexId, VertexId)> {
        let mut fans = vec![false; self.origin.len()];
        let mut copies = Vec::new();
        for v in self.vertices().collect::<Vec<_>>() {
            self.star(v).for_each(|h| fans[h.index()] = true);
        }
        for h in (0..self.origin.len() as u32).map(HalfEdge) {
            if self.is_face(h.face()) && !fans[h.index()] {
                let v = self.origin(h);
                let copy = self.add_vertex();
                self.start[copy.index()] = self.first_of_fan(h).0;
                let fan: Vec<HalfEdge> = self.star(copy).collect();
                for e in fan {
                    self.origin[e.index()] = copy;
                    fans[e.index()] = true;
                }
                copies.push((copy, v));
            }
        }
        copies
    }

    fn first_of_fan(&self, h: HalfEdge) -> HalfEdge {
        let mut first = h;
        while let Some(t) = self.twin(first) {
            first = t.next();
            if first == h {
                break;
            }
        }
        first
    }

    pub(super) fn push_face(&mut self, corners: [VertexId; 3], region: i32) -> FaceId {
        let f = self.free_faces.pop().unwrap_or_else(|| {
            self.origin.extend([VertexId(NONE); 3]);
            self.twin.extend([NONE; 3]);
            self.length.extend([f64::NAN; 3]);
            self.constraint.extend([NONE; 3]);
            self.region.push(0);
            FaceId(self.region.len() as u32 - 1)
        });
        for (h, v) in f.half_edges().into_iter().zip(corners) {
            self.clear(h, v);
        }
        self.region[f.index()] = region;
        f
    }

    fn kill(&mut self, f: FaceId) {
        for h in f.half_edges() {
            self.clear(h, VertexId(NONE));
        }
        self.free_faces.push(f);
    }

    fn clear(&mut self, h: HalfEdge, origin: VertexId) {
        self.origin[h.index()] = origin;
        self.twin[h.index()] = NONE;
        self.length[h.index()] = f64::NAN;
        self.constraint[h.index()] = NONE;
    }

    fn take(&self, h: HalfEdge) -> Record {
        let i = h.index();
        Record { origin: self.origin[i], twin: self.twin[i], length: self.length[i], constraint: self.constraint[i] }
    }

    fn put(&mut self, h: HalfEdge, record: Record) {
        let i = h.index();
        self.origin[i] = record.origin;
        self.twin[i] = record.twin;
        self.length[i] = record.length;
        self.constraint[i] = record.constraint;
        if record.twin != NONE {
            self.twin[record.twin as usize] = h.0;
        }
    }

    pub(super) fn glue(&mut self, h: HalfEdge, t: HalfEdge) {
        self.twin[h.index()] = t.0;
        self.twin[t.index()] = h.0;
    }

    /// Lets the origin of h start at h, unless it already starts at a border half-edge.
    pub(super) fn set_start(&mut self, h: HalfEdge) {
        let v = self.origin(h).index();
        let old = self.start[v];
        let keeps = old != NONE && self.origin[old as usize].index() == v && self.twin[old as usize] == NONE;
        if !keeps || self.twin[h.index()] == NONE {
            self.start[v] = h.0;
        }
    }
}

/// What a half-edge slot holds.
#[derive(Clone, Copy)]
struct Record {
    origin: VertexId,
    twin: u32,
    length: f64,
    constraint: u32,
}

impl Record {
    /// The record once the half-edges `from` have moved to `to`: where its twin is one of them, the twin moves along.
    fn with_moved_twin(mut self, from: [HalfEdge; 4], to: [HalfEdge; 4]) -> Self {
        if let Some((_, new)) = from.iter().zip(to).find(|(old, _)| old.0 == self.twin) {
            self.twin = new.0;
        }
        self
    }
}
