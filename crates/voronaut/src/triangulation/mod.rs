//! The one triangulation structure for canvas and mesh: half-edges in triangles, a metric length per edge.
//!
//! Its topology never reads positions. Self-edges and multi-edges are allowed (flips by length can make them), so
//! edges are half-edges, never pairs of vertices. See [`crate::planar`] for an embedding in the plane.

mod check;
mod halve;
mod ids;
mod lawson;
mod operations;
mod renumber;

pub(crate) use check::Broken;
pub(crate) use halve::Corner;
pub use ids::{Constraint, FaceId, HalfEdge, VertexId};
pub use lawson::Limit;
pub(crate) use lawson::{Flipping, Lawson, Rounds, flip_from, flip_in_rounds};

use crate::lists::{Rows, in_order};
use crate::parallel::{copy_over, prelude::*};
use ids::NONE;
use smallvec::{SmallVec, smallvec};

/// Faces that are worth a thread's while.
const FACES: usize = 256;

/// A triangulation: half-edge `3 f + i` is the i-th edge of face f, counter-clockwise.
///
/// Per half-edge it keeps the origin, the twin, the metric length (the same on both sides, NaN where not yet known)
/// and the constraint (boundary or feature) that the edge is part of. Removed faces and vertices leave holes in the
/// numbering that later insertions fill.
#[derive(Clone, Debug, Default)]
pub struct Triangulation {
    origin: Vec<VertexId>,
    twin: Vec<u32>,
    length: Vec<f64>,
    constraint: Vec<u32>,
    region: Vec<i32>,
    start: Vec<u32>,
    free_faces: Vec<FaceId>,
    free_vertices: Vec<VertexId>,
}

impl Triangulation {
    /// Builds the structure from counter-clockwise triangles over `vertex_count` vertices.
    ///
    /// Two triangles that traverse an edge in opposite directions become neighbours. The caller guarantees that no
    /// edge is traversed twice in the same direction and that the triangles around each vertex form one fan;
    /// [`Triangulation::check`] tells.
    pub(crate) fn from_triangles(vertex_count: usize, triangles: &[[u32; 3]], regions: &[i32]) -> Self {
        let mut result = Self::apart(vertex_count, triangles, regions.to_vec());
        result.pair_twins();
        for h in (0..result.origin.len() as u32).map(HalfEdge) {
            result.set_start(h);
        }
        result
    }

    /// Builds the structure from counter-clockwise triangles that are glued as told: half-edge `3 i + k` is side k of triangle i,
    /// and a twin names this one back. Edges may be doubled; vertices may have several fans
    /// ([`Triangulation::split_pinched_vertices`]).
    pub(crate) fn glued(vertex_count: usize, triangles: &[[u32; 3]], twins: &[Option<u32>]) -> Self {
        let mut result = Self::apart(vertex_count, triangles, vec![0; triangles.len()]);
        for (h, twin) in (0..).zip(twins) {
            if let Some(t) = twin.filter(|&t| h < t) {
                result.glue(HalfEdge(h), HalfEdge(t));
            }
        }
        for h in (0..result.origin.len() as u32).map(HalfEdge) {
            result.set_start(h);
        }
        result
    }

    /// Triangles that are not glued yet.
    fn apart(vertex_count: usize, triangles: &[[u32; 3]], region: Vec<i32>) -> Self {
        debug_assert_eq!(triangles.len(), region.len(), "each has its region");
        let slots = 3 * triangles.len();
        Self {
            origin: triangles.as_flattened().iter().map(|&v| VertexId(v)).collect(),
            twin: vec![NONE; slots],
            length: vec![f64::NAN; slots],
            constraint: vec![NONE; slots],
            region,
            start: vec![NONE; vertex_count],
            ..Self::default()
        }
    }

    /// Becomes another one, in the memory that this one has.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        copy_over(&mut self.origin, &other.origin);
        copy_over(&mut self.twin, &other.twin);
        copy_over(&mut self.length, &other.length);
        copy_over(&mut self.constraint, &other.constraint);
        copy_over(&mut self.region, &other.region);
        copy_over(&mut self.start, &other.start);
        self.free_faces.clone_from(&other.free_faces);
        self.free_vertices.clone_from(&other.free_vertices);
    }

    fn pair_twins(&mut self) {
        let ends = |h: u32| in_order(self.ends(HalfEdge(h)));
        let by_first = Rows::new(self.start.len(), (0..self.origin.len() as u32).map(|h| (ends(h)[0].0, h)));
        // Of the half-edges of one edge the first and the second, the third and the fourth.
        let pairs = |first: usize| {
            let sides = by_first.row(first);
            let mut pairs: SmallVec<[[HalfEdge; 2]; 8]> = SmallVec::new();
            let mut paired: SmallVec<[bool; 16]> = smallvec![false; sides.len()];
            for (i, &h) in sides.iter().enumerate() {
                let joins = |j: &usize| !paired[*j] && ends(sides[*j]) == ends(h);
                if !paired[i]
                    && let Some(j) = (i + 1..sides.len()).find(joins)
                {
                    pairs.push([h, sides[j]].map(HalfEdge));
                    paired[j] = true;
                }
            }
            pairs
        };
        let all = (0..by_first.count()).into_par_iter().with_min_len(FACES).flat_map_iter(pairs);
        for [h, t] in all.collect::<Vec<_>>() {
            self.glue(h, t);
        }
    }

    /// Number of vertex slots; some may be dead.
    pub(crate) fn vertex_slots(&self) -> usize {
        self.start.len()
    }

    /// Number of living vertices.
    pub(crate) fn vertex_count(&self) -> usize {
        self.start.len() - self.free_vertices.len()
    }

    /// Number of living faces.
    pub fn face_count(&self) -> usize {
        self.region.len() - self.free_faces.len()
    }

    /// Number of face slots; some may be dead.
    pub(crate) fn face_slots(&self) -> usize {
        self.region.len()
    }

    /// All living vertices that belong to a face, in order of their ids.
    pub(crate) fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        (0..self.start.len() as u32).map(VertexId).filter(|&v| self.is_vertex(v))
    }

    /// All living faces.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> + Clone + '_ {
        (0..self.region.len() as u32).map(FaceId).filter(|&f| self.is_face(f))
    }

    /// One half-edge of every edge: that with the smaller id, or the only one at the border.
    pub fn edges(&self) -> impl Iterator<Item = HalfEdge> + '_ {
        self.faces().flat_map(FaceId::half_edges).filter(|&h| self.twin(h).is_none_or(|t| h < t))
    }

    /// Those of [`Triangulation::edges`] of which something holds, in their order; asked in parallel.
    pub(crate) fn edges_with(&self, holds: impl Fn(HalfEdge) -> bool + Sync) -> Vec<HalfEdge> {
        let slots = (0..self.face_slots() as u32).into_par_iter().with_min_len(FACES);
        slots.flat_map_iter(|f| self.edges_of(FaceId(f))).filter(|&h| holds(h)).collect()
    }

    /// Those of [`Triangulation::edges`] that a face slot has.
    pub(crate) fn edges_of(&self, f: FaceId) -> impl Iterator<Item = HalfEdge> + '_ {
        let edges = f.half_edges().into_iter().filter(|&h| self.canonical(h) == h);
        edges.take(if self.is_face(f) { 3 } else { 0 })
    }

    /// The edges at the border, by face.
    pub(crate) fn borders(&self) -> impl Iterator<Item = HalfEdge> + '_ {
        self.faces().flat_map(FaceId::half_edges).filter(|&h| self.twin(h).is_none())
    }

    /// Whether the slot holds a vertex of some face.
    pub(crate) fn is_vertex(&self, v: VertexId) -> bool {
        self.start[v.index()] != NONE
    }

    /// Whether the slot holds a face.
    pub(crate) fn is_face(&self, f: FaceId) -> bool {
        self.origin[3 * f.index()] != VertexId(NONE)
    }

    /// The vertex that a half-edge leaves.
    pub fn origin(&self, h: HalfEdge) -> VertexId {
        self.origin[h.index()]
    }

    /// The vertex that a half-edge reaches.
    pub fn target(&self, h: HalfEdge) -> VertexId {
        self.origin[h.next().index()]
    }

    /// The vertices that a half-edge leaves and reaches.
    pub(crate) fn ends(&self, h: HalfEdge) -> [VertexId; 2] {
        [self.origin(h), self.target(h)]
    }

    /// The vertex opposite to a half-edge in its face.
    pub(crate) fn apex(&self, h: HalfEdge) -> VertexId {
        self.origin[h.prev().index()]
    }

    /// The other side of the edge; `None` at the border.
    pub(crate) fn twin(&self, h: HalfEdge) -> Option<HalfEdge> {
        let t = self.twin[h.index()];
        (t != NONE).then_some(HalfEdge(t))
    }

    /// The sides of the edge: this one, and the other if there is one.
    pub(crate) fn sides(&self, h: HalfEdge) -> impl Iterator<Item = HalfEdge> + use<> {
        [Some(h), self.twin(h)].into_iter().flatten()
    }

    /// The side of the edge with the smaller id.
    pub(crate) fn canonical(&self, h: HalfEdge) -> HalfEdge {
        self.twin(h).map_or(h, |t| h.min(t))
    }

    /// The ends of an edge, from and to, and what is opposite to it on the left and on the right; `None` at the border.
    pub(crate) fn quad(&self, h: HalfEdge) -> Option<[VertexId; 4]> {
        let t = self.twin(h)?;
        Some([self.origin(h), self.target(h), self.apex(h), self.apex(t)])
    }

    /// Whether an edge has two faces and no constraint, and its flip makes no edge between vertices that one joins already.
    pub(crate) fn can_flip(&self, h: HalfEdge) -> bool {
        let joins = |u, v| self.around(u).any(|w| w == v);
        !self.is_fixed(h) && self.quad(h).is_some_and(|[_, _, c, d]| c != d && !joins(c, d))
    }

    /// The three vertices of a face, counter-clockwise.
    pub fn corners(&self, f: FaceId) -> [VertexId; 3] {
        f.half_edges().map(|h| self.origin(h))
    }

    /// Metric length of the edge; NaN where not known.
    pub(crate) fn length(&self, h: HalfEdge) -> f64 {
        self.length[h.index()]
    }

    /// Sets the metric length of the edge, on both sides.
    pub(crate) fn set_length(&mut self, h: HalfEdge, length: f64) {
        self.length[h.index()] = length;
        if let Some(t) = self.twin(h) {
            self.length[t.index()] = length;
        }
    }

    /// Multiplies all lengths.
    pub(crate) fn stretch(&mut self, factor: f64) {
        self.length.par_iter_mut().with_min_len(3 * FACES).for_each(|length| *length *= factor);
    }

    /// Lengths become what a function of both ends, in either order, and of the length of before says; NaN is one that is not known.
    pub(crate) fn change_lengths(&mut self, change: impl Fn([VertexId; 2], f64) -> f64 + Sync) {
        let faces = self.length.par_chunks_mut(3).zip(self.origin.par_chunks(3));
        faces.with_min_len(FACES).for_each(|(lengths, corners)| {
            for k in 0..3 {
                if corners[k] != VertexId(NONE) {
                    lengths[k] = change([corners[k], corners[(k + 1) % 3]], lengths[k]);
                }
            }
        });
    }

    /// The constraint that the edge is part of.
    pub(crate) fn constraint(&self, h: HalfEdge) -> Option<Constraint> {
        let c = self.constraint[h.index()];
        (c != NONE).then_some(Constraint(c))
    }

    /// Marks the edge as part of a constraint, on both sides.
    pub(crate) fn set_constraint(&mut self, h: HalfEdge, constraint: Constraint) {
        self.constraint[h.index()] = constraint.0;
        if let Some(t) = self.twin(h) {
            self.constraint[t.index()] = constraint.0;
        }
    }

    /// Takes the edge out of its constraint, on both sides.
    pub(crate) fn clear_constraint(&mut self, h: HalfEdge) {
        self.set_constraint(h, Constraint(NONE));
    }

    /// Whether a flip may not remove the edge: it is constrained, or at the border.
    pub(crate) fn is_fixed(&self, h: HalfEdge) -> bool {
        self.constraint[h.index()] != NONE || self.twin[h.index()] == NONE
    }

    /// Label of the region a face lies in.
    pub fn region(&self, f: FaceId) -> i32 {
        self.region[f.index()]
    }

    /// Sets the label of the region a face lies in.
    pub(crate) fn set_region(&mut self, f: FaceId, region: i32) {
        self.region[f.index()] = region;
    }

    /// Some half-edge that leaves the vertex; at the border the one whose right side is the border.
    pub(crate) fn start(&self, v: VertexId) -> Option<HalfEdge> {
        let h = self.start[v.index()];
        (h != NONE).then_some(HalfEdge(h))
    }

    /// The half-edges that leave a vertex, counter-clockwise; at the border from one end of the fan to the other.
    pub(crate) fn star(&self, v: VertexId) -> Star<'_> {
        let first = self.start(v);
        Star { triangulation: self, first, next: first }
    }

    /// The vertices to which fixed edges lead from one, those of the border included.
    pub(crate) fn along_fixed(&self, v: VertexId) -> impl Iterator<Item = VertexId> {
        let ends = self.star(v).flat_map(|h| {
            let ahead = self.is_fixed(h).then(|| self.target(h));
            // The side that comes back to the vertex has a half-edge of the star on its other side, but for the border.
            let is_last = self.twin(h.prev()).is_none();
            [ahead, is_last.then(|| self.apex(h))]
        });
        ends.flatten()
    }

    /// The neighbours of a vertex, face by face: each is there twice, but those at the ends of a border vertex's fan.
    pub(crate) fn around(&self, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.star(v).flat_map(|h| [self.target(h), self.apex(h)])
    }

    /// A half-edge of every edge at a vertex, counter-clockwise: of the last one at the border that which comes in.
    pub(crate) fn spokes(&self, v: VertexId) -> impl Iterator<Item = HalfEdge> + '_ {
        let coming_in = |h: HalfEdge| Some(h.prev()).filter(|&h| self.twin(h).is_none());
        self.star(v).flat_map(move |h| std::iter::once(h).chain(coming_in(h)))
    }

    /// Whether the vertex lies on the border.
    pub(crate) fn is_border_vertex(&self, v: VertexId) -> bool {
        self.start(v).is_some_and(|h| self.twin(h).is_none())
    }

    /// Vertices minus edges plus faces.
    pub(crate) fn euler_characteristic(&self) -> isize {
        let [v, e] = [self.vertices().count(), self.edges().count()].map(usize::cast_signed);
        v - e + self.face_count().cast_signed()
    }

    /// The connected part that each vertex slot belongs to, by the first vertex of it.
    pub(crate) fn vertex_parts(&self) -> Vec<usize> {
        let mut part = vec![usize::MAX; self.vertex_slots()];
        for first in 0..part.len() {
            let mut stack = vec![first];
            while let Some(v) = stack.pop() {
                if part[v] == usize::MAX {
                    part[v] = first;
                    stack.extend(self.around(VertexId(v as u32)).map(VertexId::index));
                }
            }
        }
        part
    }

    /// The closed curves of the border, each as its half-edges in order, the faces on their left.
    pub(crate) fn border_loops(&self) -> Vec<Vec<HalfEdge>> {
        let mut seen = vec![false; 3 * self.face_slots()];
        let mut loops = Vec::new();
        for start in self.edges().filter(|&h| self.twin(h).is_none()) {
            let mut curve = Vec::new();
            let mut next = Some(start);
            while let Some(h) = next.filter(|h| !seen[h.index()]) {
                seen[h.index()] = true;
                curve.push(h);
                // A border vertex starts at its border.
                next = self.start(self.target(h));
            }
            if !curve.is_empty() {
                loops.push(curve);
            }
        }
        loops
    }

    /// The parts of faces that hang together across half-edges for which `joins` holds (of both sides or none): the part of
    /// each face slot, and the faces of each part, in the order in which neighbours are found.
    pub(crate) fn parts(&self, joins: impl Fn(HalfEdge) -> bool) -> (Vec<u32>, Vec<Vec<FaceId>>) {
        let mut part_of = vec![NONE; self.face_slots()];
        let mut parts: Vec<Vec<FaceId>> = Vec::new();
        for start in self.faces() {
            let (mut part, mut next) = (vec![start], 0);
            if part_of[start.index()] != NONE {
                continue;
            }
            part_of[start.index()] = parts.len() as u32;
            while let Some(&f) = part.get(next) {
                next += 1;
                for h in f.half_edges().into_iter().filter(|&h| joins(h)) {
                    let Some(beside) = self.twin(h).map(HalfEdge::face) else { continue };
                    if part_of[beside.index()] == NONE {
                        part_of[beside.index()] = parts.len() as u32;
                        part.push(beside);
                    }
                }
            }
            parts.push(part);
        }
        (part_of, parts)
    }

    /// The half-edge from a to b, if a face has it (the first of several).
    pub(crate) fn find(&self, a: VertexId, b: VertexId) -> Option<HalfEdge> {
        self.star(a).find(|&h| self.target(h) == b)
    }

    /// A side of the edge between two vertices, that from a to b if a face has it.
    pub(crate) fn edge_between(&self, a: VertexId, b: VertexId) -> Option<HalfEdge> {
        self.find(a, b).or_else(|| self.find(b, a))
    }
}

/// The half-edges that leave a vertex, counter-clockwise. See [`Triangulation::star`].
#[derive(Clone)]
pub(crate) struct Star<'a> {
    triangulation: &'a Triangulation,
    first: Option<HalfEdge>,
    next: Option<HalfEdge>,
}

impl Iterator for Star<'_> {
    type Item = HalfEdge;

    fn next(&mut self) -> Option<HalfEdge> {
        let h = self.next?;
        self.next = self.triangulation.twin(h.prev()).filter(|&n| Some(n) != self.first);
        Some(h)
    }
}

/// The same cycle of three, its smallest member first.
pub(crate) fn smallest_first<T: PartialOrd + Copy>([a, b, c]: [T; 3]) -> [T; 3] {
    if a < b && a < c {
        [a, b, c]
    } else if b < c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}
