//! The surface's own triangulation, made as fine as a metric asks for: edges split that are too long, vertices contracted that are
//! too many. Every state is a triangulation of the surface whose triangles stand upright on it, or as upright as those of the
//! surface itself; so where vertices are held it is the surface.

use crate::geometry::{Point3, Tensor3, Vector3};
use crate::surface::metric::SurfaceMetric;
use crate::surface::{Input, Place};
use crate::triangulation::{HalfEdge, Triangulation, VertexId};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Edges longer than this (metric) are split.
const LONG: f64 = 1.0;
/// Contraction makes no edge longer than this, as long as there is another way.
const LONGEST: f64 = 2.0;
/// The least cosine between a new triangle's normal and those of the surface at its corners.
const UPRIGHT: f64 = 0.5;
/// New triangles of less quality in the metric have to be better than those before.
const FAIR: f64 = 0.2;
/// Passes over all that may be contracted, at most: what one does makes room for the next.
const PASSES: usize = 8;
/// Passes over all edges that are too long, at most: each halves them.
const HALVINGS: usize = 40;
/// Vertices with more triangles together are not made one: all would gather at a few.
const CROWD: usize = 24;
/// Vertices at most, as a multiple of those wanted and of those of the surface together.
const MOST: usize = 8;

/// What is wanted of a triangulation.
pub struct Wanted<'a> {
    /// Places on the border of patches, or at their vertices, that shall be vertices; the only ones of the border.
    pub given: &'a [Place],
    /// The factor on the metric for which edges are of unit length.
    pub factor: f64,
    /// Vertices.
    pub count: usize,
    /// Balls in which all vertices of the surface are kept: centres and radii (Euclidean).
    pub held: &'a [(Point3, f64)],
}

/// A triangulation of a surface.
pub struct Adapted {
    /// Its vertices: first the given ones, in order.
    pub places: Vec<Place>,
    /// How they hang together.
    pub topology: Triangulation,
    /// Vertices of the surface on the border of patches that could not be contracted: more places should be given there.
    pub stuck: Vec<VertexId>,
}

/// Adapts the triangles of a surface. `None` where two of the given places are one vertex.
pub fn adapted(input: &Input, metric: &dyn SurfaceMetric, wanted: &Wanted) -> Option<Adapted> {
    let mut work = Work::new(input, metric, wanted)?;
    // Large triangles turn over less easily; where the border cannot be had of them, smaller ones may let it go.
    work.contract_border();
    work.split_long(MOST * (wanted.count + input.surface.positions().len()));
    work.contract_border();
    if work.stuck().is_empty() {
        for manner in [Manner::Fair, Manner::Upright] {
            work.contract_inside(wanted.count, manner);
        }
    }
    Some(work.finished(wanted.given.len()))
}

/// How much a contraction has to look to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Manner {
    /// Triangles stay upright and fair, edges not too long.
    Fair,
    /// Triangles stay upright.
    Upright,
}

struct Work<'a> {
    input: &'a Input,
    metric: &'a dyn SurfaceMetric,
    root: f64,
    topology: Triangulation,
    vertices: Vec<Vertex>,
}

#[derive(Clone, Copy)]
struct Vertex {
    place: Place,
    normal: Vector3,
    tensor: Tensor3,
    /// The number of the given place that it is.
    given: Option<u32>,
    is_held: bool,
}

impl Vertex {
    /// Whether it may be contracted.
    fn may_go(&self) -> bool {
        self.given.is_none() && !self.is_held
    }
}

impl<'a> Work<'a> {
    fn new(input: &'a Input, metric: &'a dyn SurfaceMetric, wanted: &Wanted) -> Option<Self> {
        let topology = input.surface.topology().clone();
        let nowhere = input.surface.place(topology.faces().next()?, [1.0, 0.0, 0.0]);
        let slots = (0..topology.vertex_slots() as u32).map(VertexId);
        let places: Vec<Place> = slots.map(|v| input.surface.place_of(v).unwrap_or(nowhere)).collect();
        let root = wanted.factor.sqrt();
        let mut work = Self { input, metric, root, topology, vertices: Vec::new() };
        for place in places {
            let is_held = wanted.held.iter().any(|(centre, radius)| centre.distance(place.position) <= *radius);
            let vertex = work.vertex(place);
            work.vertices.push(Vertex { is_held, ..vertex });
        }
        work.put_given(wanted.given)?;
        Some(work)
    }

    fn vertex(&self, place: Place) -> Vertex {
        let (normal, tensor) = (self.input.normal(&place), self.metric.at(&place));
        Vertex { place, normal, tensor, given: None, is_held: false }
    }

    /// Makes the given places vertices: those at corners are some already, others cut edges, in their order along these.
    fn put_given(&mut self, given: &[Place]) -> Option<()> {
        let mut on_edges: BTreeMap<[VertexId; 2], Vec<(f64, u32)>> = BTreeMap::new();
        for (i, place) in (0..).zip(given) {
            let corners = self.topology.corners(place.face);
            if let Some(k) = (0..3).find(|&k| place.weights[k] >= 1.0) {
                let vertex = &mut self.vertices[corners[k].index()];
                if vertex.given.replace(i).is_some() {
                    return None;
                }
                continue;
            }
            let least = (0..3).min_by(|&j, &k| place.weights[j].total_cmp(&place.weights[k]))?;
            let ends = [corners[(least + 1) % 3], corners[(least + 2) % 3]];
            on_edges.entry(ends).or_default().push((place.weights[(least + 2) % 3], i));
        }
        for ([from, to], mut stations) in on_edges {
            stations.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
            let mut h = self.topology.find(from, to)?;
            for (_, i) in stations {
                let vertex = Vertex { given: Some(i), ..self.vertex(given[i as usize]) };
                h = self.split(h, vertex);
            }
        }
        Some(())
    }

    /// Puts a vertex on an edge; what is left of the edge behind it.
    fn split(&mut self, h: HalfEdge, vertex: Vertex) -> HalfEdge {
        let v = self.topology.add_vertex();
        if v.index() >= self.vertices.len() {
            self.vertices.resize(v.index() + 1, vertex);
        }
        self.vertices[v.index()] = vertex;
        self.topology.split_edge(h, v)
    }

    fn at(&self, v: VertexId) -> &Vertex {
        &self.vertices[v.index()]
    }

    /// The metric length of the chord between two vertices: the mean of those in the metrics at its ends.
    fn length(&self, v: VertexId, w: VertexId) -> f64 {
        let [v, w] = [v, w].map(|v| self.at(v));
        let chord = w.place.position - v.place.position;
        0.5 * self.root * (v.tensor.length(chord) + w.tensor.length(chord))
    }

    fn ends(&self, h: HalfEdge) -> [VertexId; 2] {
        [self.topology.origin(h), self.topology.target(h)]
    }

    /// Splits edges inside patches in the middle, the longest first, until none is too long, but for those of triangles with a
    /// longer edge on the border: as that stays, fans of ever smaller triangles would grow on it. As no edge was flipped, all that is
    /// cut lies in the surface's own triangles.
    fn split_long(&mut self, most: usize) {
        for _ in 0..HALVINGS {
            let long = self.topology.edges().filter(|&h| self.is_long(h)).map(|h| (self.length_of(h), h));
            let mut long: Vec<(f64, HalfEdge)> = long.collect();
            long.sort_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
            let before = self.topology.vertex_count();
            for (_, h) in long {
                // Splits beside it may have put another edge into this slot.
                if self.topology.vertex_count() < most && self.is_long(h) {
                    self.split_in_the_middle(h);
                }
            }
            if self.topology.vertex_count() == before {
                return;
            }
        }
    }

    fn length_of(&self, h: HalfEdge) -> f64 {
        let [v, w] = self.ends(h);
        self.length(v, w)
    }

    fn is_long(&self, h: HalfEdge) -> bool {
        let t = &self.topology;
        let Some(twin) = t.twin(h) else { return false };
        let length = self.length_of(h);
        let is_longest = |other: HalfEdge| t.twin(other).is_some() || self.length_of(other) <= length;
        length > LONG && [h.next(), h.prev(), twin.next(), twin.prev()].into_iter().all(is_longest)
    }

    fn split_in_the_middle(&mut self, h: HalfEdge) {
        let [p, q] = self.ends(h).map(|v| self.at(v).place);
        if let Some(place) = self.input.lift(&p, p.position.lerp(q.position, 0.5)) {
            let vertex = self.vertex(place);
            self.split(h, vertex);
        }
    }

    /// Contracts the vertices of the border that are not given along it.
    fn contract_border(&mut self) {
        for _ in 0..PASSES {
            let before = self.topology.vertex_count();
            for v in self.stuck() {
                self.contract_along_border(v);
            }
            if self.topology.vertex_count() == before {
                return;
            }
        }
    }

    /// Vertices of the border that are not given.
    fn stuck(&self) -> Vec<VertexId> {
        let is_extra = |v: &VertexId| self.topology.is_border_vertex(*v) && self.at(*v).given.is_none();
        self.topology.vertices().filter(is_extra).collect()
    }

    /// Contracts a vertex of the border onto the neighbour along it with which triangles turn away least.
    fn contract_along_border(&mut self, v: VertexId) {
        let t = &self.topology;
        let out = t.star(v).find(|&h| t.twin(h).is_none());
        let back = t.star(v).last().map(HalfEdge::prev).filter(|&h| t.twin(h).is_none());
        let ways = [out, back].into_iter().flatten().filter(|&h| t.can_collapse(h));
        let worst = |h: HalfEdge| {
            let to = if t.origin(h) == v { t.target(h) } else { t.origin(h) };
            self.moved(v, to).map(|after| self.leaning(after)).fold(1.0, f64::min)
        };
        let best = ways.map(|h| (worst(h), h)).max_by(|x, y| x.0.total_cmp(&y.0).then(y.1.cmp(&x.1)));
        let before = t.star(v).map(|h| self.leaning([v, t.target(h), t.apex(h)])).fold(1.0, f64::min);
        if let Some((after, h)) = best
            && (after >= UPRIGHT || after >= before)
        {
            self.collapse(v, h);
        }
    }

    fn collapse(&mut self, gone: VertexId, h: HalfEdge) {
        if self.topology.origin(h) == gone { self.topology.collapse(h) } else { self.topology.collapse_back(h) }
    }

    /// Contracts vertices inside patches over their edges, the shortest first, until so many vertices are left.
    fn contract_inside(&mut self, count: usize, manner: Manner) {
        for _ in 0..PASSES {
            let before = self.topology.vertex_count();
            let edges: Vec<HalfEdge> = self.topology.edges().collect();
            let mut queue: BinaryHeap<Reverse<(u64, VertexId, VertexId)>> = BinaryHeap::new();
            queue.extend(edges.into_iter().map(|h| self.ends(h)).map(|[v, w]| self.entry(v, w)));
            while self.topology.vertex_count() > count
                && let Some(Reverse((_, v, w))) = queue.pop()
            {
                let t = &self.topology;
                let is_there = |v| t.is_vertex(v);
                let Some(h) = (is_there(v) && is_there(w)).then(|| t.find(v, w).or_else(|| t.find(w, v))).flatten()
                else {
                    continue;
                };
                let link = [v, w].map(|v| self.link(v)).concat();
                if let Some(kept) = self.contract(h, manner) {
                    let others = link.into_iter().flatten().filter(|&v| v != kept && self.topology.is_vertex(v));
                    queue.extend(others.map(|other| self.entry(kept, other)));
                }
            }
            if self.topology.vertex_count() == before || self.topology.vertex_count() <= count {
                return;
            }
        }
    }

    /// Positive numbers have the order of their bits.
    fn entry(&self, v: VertexId, w: VertexId) -> Reverse<(u64, VertexId, VertexId)> {
        Reverse((self.length(v, w).to_bits(), v.min(w), v.max(w)))
    }

    /// Contracts one end of an edge onto the other, if that may be: the end with which the worst triangle is the better.
    /// Returns the end that is left.
    fn contract(&mut self, h: HalfEdge, manner: Manner) -> Option<VertexId> {
        let t = &self.topology;
        let [v, w] = self.ends(h);
        let may_go = |v: VertexId| self.at(v).may_go() && !t.is_border_vertex(v);
        let is_crowded = t.star(v).count() + t.star(w).count() > CROWD;
        if is_crowded || !(may_go(v) || may_go(w)) || !t.can_collapse(h) {
            return None;
        }
        let ways = [(v, w), (w, v)].into_iter().filter(|&(gone, _)| may_go(gone));
        let allowed = ways.filter_map(|(gone, kept)| Some((self.worth(gone, kept, manner)?, gone, kept)));
        let (_, gone, kept) = allowed.max_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)))?;
        self.collapse(gone, h);
        Some(kept)
    }

    /// The least quality of the triangles that would be there if a vertex went to the place of a neighbour; nothing if they may not.
    fn worth(&self, gone: VertexId, kept: VertexId, manner: Manner) -> Option<f64> {
        let t = &self.topology;
        let star = || t.star(gone).map(|h| [gone, t.target(h), t.apex(h)]);
        let upright = star().map(|corners| self.leaning(corners)).fold(1.0, f64::min).min(UPRIGHT);
        let fair = star().map(|corners| self.quality(corners)).fold(1.0, f64::min).min(FAIR);
        let mut worst = 1.0_f64;
        for corners in self.moved(gone, kept) {
            let quality = self.quality(corners);
            let is_long = || self.length(corners[0], corners[1]).max(self.length(corners[0], corners[2])) > LONGEST;
            let leans = self.leaning(corners) < upright || quality <= 0.0;
            if leans || manner == Manner::Fair && (quality < fair || is_long()) {
                return None;
            }
            worst = worst.min(quality);
        }
        Some(worst)
    }

    /// The edges opposite of a vertex.
    fn link(&self, v: VertexId) -> Vec<[VertexId; 2]> {
        let t = &self.topology;
        t.star(v).map(|h| [t.target(h), t.apex(h)]).collect()
    }

    /// The triangles around a vertex that stay when it goes to another's place, with that one first.
    fn moved(&self, gone: VertexId, kept: VertexId) -> impl Iterator<Item = [VertexId; 3]> {
        let t = &self.topology;
        let links = t.star(gone).map(|h| [t.target(h), t.apex(h)]);
        links.filter(move |link| !link.contains(&kept)).map(move |[a, b]| [kept, a, b])
    }

    /// The least cosine between a triangle's normal and those of the surface at its corners; -1 without area.
    fn leaning(&self, corners: [VertexId; 3]) -> f64 {
        let [a, b, c] = corners.map(|v| self.at(v).place.position);
        let Some(normal) = (b - a).cross(c - a).unit() else { return -1.0 };
        corners.iter().map(|v| self.at(*v).normal.dot(normal)).fold(1.0, f64::min)
    }

    /// Quality by metric lengths: 1 of an equilateral triangle.
    fn quality(&self, [a, b, c]: [VertexId; 3]) -> f64 {
        let [x, y, z] = [self.length(a, b), self.length(b, c), self.length(c, a)];
        let square = (x + y + z) * (x + y - z) * (x - y + z) * (y + z - x);
        3.0_f64.sqrt() * square.max(0.0).sqrt() / (x * x + y * y + z * z)
    }

    fn finished(self, given: usize) -> Adapted {
        let t = &self.topology;
        let mut number = vec![u32::MAX; t.vertex_slots()];
        let mut places: Vec<Option<Place>> = vec![None; given];
        for v in t.vertices() {
            let vertex = self.at(v);
            number[v.index()] = vertex.given.unwrap_or_else(|| {
                places.push(None);
                places.len() as u32 - 1
            });
            places[number[v.index()] as usize] = Some(vertex.place);
        }
        let triangles: Vec<[u32; 3]> = t.faces().map(|f| t.corners(f).map(|v| number[v.index()])).collect();
        let stuck = self.stuck();
        let places: Vec<Place> = places.into_iter().flatten().collect();
        let topology = Triangulation::from_triangles(places.len(), &triangles, &vec![0; triangles.len()]);
        Adapted { places, topology, stuck }
    }
}
