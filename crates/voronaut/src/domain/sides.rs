//! Which triangles lie in the domain, and in which region.

use super::{Filling, Pslg, Side};
use crate::error::{Error, Result};
use crate::geometry::{Point, centroid, signed_area};
use crate::planar::{Location, Planar};
use crate::triangulation::{FaceId, HalfEdge};

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
            Filling::EvenOdd => areas.alternate(planar, outer),
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
    fn alternate(&mut self, planar: &Planar, outer: usize) {
        let mut neighbours = vec![Vec::new(); self.sides.len()];
        for h in constrained_half_edges(planar) {
            if let Some(t) = planar.topology.twin(h) {
                let [a, b] = [h, t].map(|e| self.area_of[e.face().index()] as usize);
                neighbours[a].push(b);
            }
        }
        let mut queue = std::collections::VecDeque::from([outer]);
        while let Some(a) = queue.pop_front() {
            let beyond = if self.sides[a] == Side::Outside { Side::Region(1) } else { Side::Outside };
            for &b in &neighbours[a] {
                if self.sides[b] == Side::Unknown {
                    self.sides[b] = beyond;
                    queue.push_back(b);
                }
            }
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
    let far = crate::triangulation::VertexId(planar.topology.vertex_slots() as u32 - 1);
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
