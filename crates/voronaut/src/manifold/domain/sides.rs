//! Which triangles lie in the domain, and in which region.

use super::{Filling, Pslg, Segment, Side};
use crate::error::{Error, Result};
use crate::geometry::{Point, centroid, signed_area};
use crate::lists::distinct;
use crate::planar::{Location, Planar};
use crate::triangulation::{FaceId, HalfEdge, VertexId};
use std::collections::VecDeque;

const OPEN_HELP: &str = "close the boundary: every end of a segment must meet another segment of the same outline";

/// The areas into which constrained edges cut the plane, and what each is.
pub(super) struct Areas {
    area_of: Vec<u32>,
    sides: Vec<Side>,
}

impl Areas {
    /// Finds the areas of a triangulation (with its far triangle) and classifies them.
    ///
    /// # Errors
    /// The boundary is open, encloses nothing, or contradicts itself.
    pub(super) fn classify(pslg: &Pslg, planar: &Planar) -> Result<Self> {
        let (area_of, areas) = planar.topology.parts(|h| !planar.topology.is_fixed(h));
        let mut areas = Self { area_of, sides: vec![Side::Unknown; areas.len()] };
        let outer = areas.area_of[far_face(planar).index()] as usize;
        areas.sides[outer] = Side::Outside;
        match &pslg.filling {
            Filling::Sides => areas.read_segments(pslg, planar)?,
            Filling::EvenOdd => areas.alternate(planar),
            Filling::Enclosed { holes, regions } => areas.fill(planar, holes, regions),
        }
        areas.reject_useless_segments(pslg, planar)?;
        Ok(areas)
    }

    /// What a face is part of.
    pub(super) fn of(&self, f: FaceId) -> Side {
        self.sides[self.area_of[f.index()] as usize]
    }

    /// A point inside each bounded area, the centroid of its fattest triangle, and what the area is.
    pub(super) fn inner_points(&self, planar: &Planar) -> Vec<(Side, Point)> {
        let mut best = vec![(0.0, Point::default()); self.sides.len()];
        for f in planar.topology.faces() {
            let triangle = planar.triangle(f);
            let [a, b, c] = triangle;
            let perimeter = a.distance(b) + b.distance(c) + c.distance(a);
            let radius = signed_area(a, b, c) / perimeter;
            let known = &mut best[self.area_of[f.index()] as usize];
            if radius > known.0 {
                *known = (radius, centroid(triangle));
            }
        }
        let outer = self.area_of[far_face(planar).index()] as usize;
        let bounded = self.sides.iter().zip(best).enumerate().filter(|(area, _)| *area != outer);
        bounded.map(|(_, (&side, (_, point)))| (side, point)).collect()
    }

    fn read_segments(&mut self, pslg: &Pslg, planar: &Planar) -> Result<()> {
        for h in constrained_half_edges(planar) {
            let (segment, said) = said_of_left(pslg, planar, h);
            let known = &mut self.sides[self.area_of[h.face().index()] as usize];
            match (*known, said) {
                (_, Side::Unknown) => {}
                (Side::Unknown, _) => *known = said,
                (k, s) if k == s => {}
                _ => {
                    let place = format!("segment {}", pslg.describe_segment(segment));
                    let help = "close the boundary, and let regions neither overlap nor leak into each other";
                    return Err(Error::domain("the same area is given two meanings", place, help));
                }
            }
        }
        Ok(())
    }

    /// Areas alternate between out and in with every crossing of a constrained edge.
    fn alternate(&mut self, planar: &Planar) {
        let covers = Covers::new(planar, |_| &[0]);
        for (side, of) in self.sides.iter_mut().zip(&covers.of) {
            *side = if of.is_empty() { Side::Outside } else { Side::Region(1) };
        }
    }

    fn fill(&mut self, planar: &Planar, holes: &[Point], regions: &[(Point, i32)]) {
        let holes = holes.iter().map(|&p| (p, Side::Outside));
        let regions_marked = regions.iter().map(|&(p, label)| (p, Side::Region(label)));
        for (p, side) in holes.chain(regions_marked) {
            if let Some(f) = containing_face(planar, p) {
                let area = &mut self.sides[self.area_of[f.index()] as usize];
                if *area == Side::Unknown {
                    *area = side;
                }
            }
        }
        let default = Side::Region(i32::from(regions.is_empty()));
        self.sides.iter_mut().filter(|s| **s == Side::Unknown).for_each(|s| *s = default);
    }

    /// A segment with the outside on both sides bounds nothing: the outline that it should be part of is open.
    fn reject_useless_segments(&self, pslg: &Pslg, planar: &Planar) -> Result<()> {
        let outside = |f: FaceId| !matches!(self.of(f), Side::Region(_));
        let useless = constrained_half_edges(planar)
            .find(|&h| outside(h.face()) && planar.topology.twin(h).is_none_or(|t| outside(t.face())));
        let Some(h) = useless else { return Ok(()) };
        let segment = planar.topology.constraint(h).expect("constrained").0;
        let network = pslg.network();
        let loose_end = network.vertices().find(|&v| network.at(v).len() == 1);
        let place =
            loose_end.map_or_else(|| format!("segment {}", pslg.describe_segment(segment)), |v| pslg.describe(v));
        Err(Error::domain("the boundary is open, or a segment lies outside of the domain,", place, OPEN_HELP))
    }
}

/// What lines are around: the numbers of closed lines that one crosses an odd number of times on the way from an area to the outside.
pub(super) struct Covers {
    area_of: Vec<u32>,
    /// Of each area, in order.
    of: Vec<Vec<u32>>,
}

impl Covers {
    /// `lines` are the numbers of the closed lines that a segment is part of, in order.
    pub(super) fn new<'a>(planar: &Planar, lines: impl Fn(u32) -> &'a [u32]) -> Self {
        let (area_of, areas) = planar.topology.parts(|h| !planar.topology.is_fixed(h));
        let area = |h: HalfEdge| area_of[h.face().index()];
        let mut neighbours = vec![Vec::new(); areas.len()];
        for h in constrained_half_edges(planar) {
            if let (Some(t), Some(constraint)) = (planar.topology.twin(h), planar.topology.constraint(h)) {
                neighbours[area(h) as usize].push((area(t), constraint.0));
            }
        }
        let mut of: Vec<Option<Vec<u32>>> = vec![None; areas.len()];
        let outer = area_of[far_face(planar).index()];
        of[outer as usize] = Some(Vec::new());
        let mut queue = VecDeque::from([outer]);
        while let Some(from) = queue.pop_front() {
            let known = of[from as usize].clone().unwrap_or_default();
            for &(to, segment) in &neighbours[from as usize] {
                if of[to as usize].is_none() {
                    of[to as usize] = Some(differing(&known, lines(segment)));
                    queue.push_back(to);
                }
            }
        }
        Self { area_of, of: of.into_iter().map(Option::unwrap_or_default).collect() }
    }

    /// The first of the lines around a face.
    pub(super) fn first(&self, f: FaceId) -> Option<u32> {
        self.of[self.area_of[f.index()] as usize].first().copied()
    }

    /// How many areas several are around.
    pub(super) fn shared(&self) -> usize {
        self.of.iter().filter(|of| of.len() > 1).count()
    }
}

/// What is in one of two lists, but not in both; in order.
pub(super) fn differing(one: &[u32], other: &[u32]) -> Vec<u32> {
    let only = |a: &[u32], b: &[u32]| a.iter().copied().filter(|x| !b.contains(x)).collect::<Vec<u32>>();
    distinct(only(one, other).into_iter().chain(only(other, one)))
}

/// The faces left and right of each segment of a graph that has no points inside segments.
pub(super) fn faces_beside(pslg: &Pslg, planar: &Planar) -> Vec<[FaceId; 2]> {
    let beside = |segment: &Segment| {
        let [a, b] = segment.ends.map(VertexId);
        let side = |from, to| planar.topology.find(from, to).expect("a segment is an edge").face();
        [side(a, b), side(b, a)]
    };
    pslg.segments.iter().map(beside).collect()
}

fn constrained_half_edges(planar: &Planar) -> impl Iterator<Item = HalfEdge> + '_ {
    let all = planar.topology.faces().flat_map(FaceId::half_edges);
    all.filter(|&h| planar.topology.constraint(h).is_some())
}

/// The segment that a half-edge is part of, and what it says of the half-edge's left.
fn said_of_left(pslg: &Pslg, planar: &Planar, h: HalfEdge) -> (u32, Side) {
    let index = planar.topology.constraint(h).expect("constrained").0;
    let segment = pslg.segments[index as usize];
    let [from, to] = planar.ends(h);
    let [a, b] = segment.ends.map(|v| pslg.points[v as usize]);
    (index, if (to - from).dot(b - a) > 0.0 { segment.left } else { segment.right })
}

fn far_face(planar: &Planar) -> FaceId {
    let far = VertexId(planar.topology.vertex_slots() as u32 - 1);
    planar.topology.start(far).expect("the far triangle's vertices are in use").face()
}

fn containing_face(planar: &Planar, p: Point) -> Option<FaceId> {
    match planar.walk(far_face(planar), p, false) {
        Location::Face(f) => Some(f),
        Location::Edge(h) => Some(h.face()),
        Location::Vertex(v) => planar.topology.start(v).map(HalfEdge::face),
        Location::Behind(_) => None,
    }
}
