//! The cells as they are drawn: closed outlines whose borders run smoothly within canvas faces.
//!
//! Along an embedded canvas edge the squares of the distances to two seeds differ by what is nearly a linear function
//! (exactly that on a flat canvas), so the border crosses the edge where the interpolated difference vanishes. In a face
//! with three colours the borders meet in the point where all three squares agree. Each edge is crossed at most once and
//! in the same point from both sides: the outlines fit together without gaps and cover the domain.

use super::Diagram;
use super::envelope::{Near, meeting};
use super::overlap::Overlap;
use crate::geodesic::NO_COLOUR;
use crate::geometry::Point;
use crate::lists::distinct;
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// The cells of a diagram as plain data, in the user's coordinates.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells {
    /// Position of each seed, by colour; `None` of removed seeds.
    pub seeds: Vec<Option<Point>>,
    /// Each cell by colour: outer outlines counter-clockwise, those of holes in it clockwise; empty where the cell holds
    /// no canvas vertex.
    pub outlines: Vec<Vec<Outline>>,
    /// Pairs of colours whose cells share a border, the smaller first, sorted.
    pub neighbours: Vec<[u32; 2]>,
    /// The border of the domain, as closed polylines (the first point is not repeated).
    pub border: Vec<Vec<Point>>,
    /// Features within the domain, piece by piece.
    pub features: Vec<[Point; 2]>,
}

/// A closed polyline; the first point is not repeated.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outline {
    /// Its points, in order.
    pub points: Vec<Point>,
    /// Which of them are corners, where three cells meet or two at the border of the domain; increasing.
    pub corners: Vec<u32>,
    /// Whether it bounds an orphan: a part of the cell without the seed (`Diagram::orphans`).
    pub is_orphan: bool,
}

impl Cells {
    /// Whether a cell has a part without its seed.
    pub fn has_orphans(&self) -> bool {
        self.outlines.iter().flatten().any(|outline| outline.is_orphan)
    }
}

impl Diagram<'_> {
    /// The outlines of all cells. Distances are computed anew around every cell, as for `Diagram::sharp_nerve`; a
    /// canvas vertex belongs to the cell that is nearest by these.
    pub fn to_cells(&self) -> Cells {
        let cutter = Cutter::new(self);
        let mut pieces = cutter.pieces();
        let topology = &self.ground.canvas.embedded().topology;
        let borders = topology.borders();
        let mut loops: Vec<Piece> =
            borders.map(|h| Piece { colour: 0, from: topology.origin(h).0, to: topology.target(h).0 }).collect();
        let mut outlines = vec![Vec::new(); self.colours()];
        for (colour, chain) in chains(&mut pieces) {
            let is_orphan = cutter.bounds_orphan(colour, &chain);
            outlines[colour as usize].push(Outline { is_orphan, ..cutter.outline(&chain) });
        }
        let features = topology.edges().filter(|&h| topology.twin(h).is_some() && topology.is_fixed(h));
        Cells {
            seeds: (0..self.colours() as u32).map(|colour| self.seed(colour)).collect(),
            outlines,
            neighbours: cutter.neighbours(),
            border: chains(&mut loops).into_iter().map(|(_, chain)| cutter.outline(&chain).points).collect(),
            features: features.map(|h| self.ground.canvas.embedded().ends(h)).collect(),
        }
    }
}

/// A piece of an outline, the cell of the colour on its left, between two nodes: canvas vertices first, then half-edges
/// (the point where a border crosses the edge), then faces (the point where three borders meet).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Piece {
    colour: u32,
    from: u32,
    to: u32,
}

struct Cutter<'d, 'a> {
    diagram: &'d Diagram<'a>,
    overlap: &'d Overlap,
    colours: Vec<u32>,
    is_orphan: Vec<bool>,
}

impl<'d, 'a> Cutter<'d, 'a> {
    fn new(diagram: &'d Diagram<'a>) -> Self {
        let overlap = diagram.overlap();
        let nearest = |v: u32| overlap.nearest(VertexId(v)).unwrap_or(diagram.label(VertexId(v)).colour);
        let colours = (0..diagram.ground.canvas.vertex_count() as u32).into_par_iter().map(nearest).collect();
        let mut is_orphan = vec![false; diagram.ground.canvas.vertex_count()];
        diagram.orphans().into_iter().for_each(|v| is_orphan[v.index()] = true);
        Self { diagram, overlap, colours, is_orphan }
    }

    fn colour(&self, v: VertexId) -> u32 {
        self.colours[v.index()]
    }

    /// The pieces of all outlines; none around what no seed reaches.
    fn pieces(&self) -> Vec<Piece> {
        let topology = &self.diagram.ground.canvas.embedded().topology;
        let mut pieces = Vec::new();
        for f in topology.faces() {
            self.cut(f, &mut pieces);
            for h in f.half_edges().into_iter().filter(|&h| topology.twin(h).is_none()) {
                let [u, v] = topology.ends(h);
                if self.colour(u) == self.colour(v) {
                    pieces.push(Piece { colour: self.colour(u), from: u.0, to: v.0 });
                } else {
                    let middle = self.crossing_node(h);
                    pieces.push(Piece { colour: self.colour(u), from: u.0, to: middle });
                    pieces.push(Piece { colour: self.colour(v), from: middle, to: v.0 });
                }
            }
        }
        pieces.retain(|p| p.colour != NO_COLOUR);
        pieces
    }

    /// The borders within a face: around each corner whose cell does not have the whole face.
    fn cut(&self, f: FaceId, pieces: &mut Vec<Piece>) {
        let topology = &self.diagram.ground.canvas.embedded().topology;
        let half_edges = f.half_edges();
        let colours = topology.corners(f).map(|v| self.colour(v));
        let all_differ = colours[0] != colours[1] && colours[1] != colours[2] && colours[2] != colours[0];
        for corner in 0..3 {
            let [own, next, last] = [0, 1, 2].map(|i| colours[(corner + i) % 3]);
            if own == next || own == last {
                continue;
            }
            let [from, to] = [half_edges[corner], half_edges[(corner + 2) % 3]].map(|h| self.crossing_node(h));
            if all_differ {
                let centre = (self.vertices() + 3 * topology.face_slots()) as u32 + f.0;
                pieces.extend([Piece { colour: own, from, to: centre }, Piece { colour: own, from: centre, to }]);
            } else {
                pieces.extend([Piece { colour: own, from, to }, Piece { colour: next, from: to, to: from }]);
            }
        }
    }

    fn vertices(&self) -> usize {
        self.colours.len()
    }

    fn crossing_node(&self, h: HalfEdge) -> u32 {
        let side = self.diagram.ground.canvas.embedded().topology.twin(h).map_or(h, |t| t.min(h));
        self.vertices() as u32 + side.0
    }

    fn outline(&self, chain: &[u32]) -> Outline {
        let topology = &self.diagram.ground.canvas.embedded().topology;
        let (vertices, half_edges) = (self.vertices() as u32, 3 * topology.face_slots() as u32);
        let mut outline = Outline::default();
        for &node in chain {
            let (point, is_corner) = if node < vertices {
                (self.diagram.ground.canvas.position(VertexId(node)), false)
            } else if node < vertices + half_edges {
                let h = HalfEdge(node - vertices);
                (self.crossing(h), topology.twin(h).is_none())
            } else {
                (self.meeting(FaceId(node - vertices - half_edges)), true)
            };
            if is_corner {
                outline.corners.push(outline.points.len() as u32);
            }
            outline.points.push(point);
        }
        outline
    }

    /// Whether a chain goes around orphans: vertices of its colour beside it are all of them. (In the embedded canvas an
    /// orphan may hang together with its cell by an edge that the canvas proper does not have.)
    fn bounds_orphan(&self, colour: u32, chain: &[u32]) -> bool {
        let topology = &self.diagram.ground.canvas.embedded().topology;
        let half_edges = self.vertices() as u32..(self.vertices() + 3 * topology.face_slots()) as u32;
        let crossed =
            chain.iter().filter(|node| half_edges.contains(node)).map(|node| HalfEdge(node - half_edges.start));
        let beside = crossed.flat_map(|h| topology.ends(h));
        let mut own = beside.filter(|&v| self.colour(v) == colour).peekable();
        own.peek().is_some() && own.all(|v| self.is_orphan[v.index()])
    }

    /// Where the border between the cells of an edge's ends crosses it.
    fn crossing(&self, h: HalfEdge) -> Point {
        let embedded = self.diagram.ground.canvas.embedded();
        let ends = embedded.topology.ends(h);
        let [p, q] = embedded.ends(h);
        let lead = ends.map(|v| self.square(v, self.colour(ends[1])) - self.square(v, self.colour(ends[0])));
        let t = lead[0] / (lead[0] - lead[1]);
        if t.is_finite() {
            return p.lerp(q, t.clamp(0.0, 1.0));
        }
        // Where one is not known beyond its cell: as if both fronts came along the edge.
        let [d, e] = ends.map(|v| self.diagram.distance(v));
        let t = 0.5 * (1.0 + (e - d) / embedded.topology.length(h));
        p.lerp(q, if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.5 })
    }

    /// Where the three cells of a face's corners meet, kept in the face.
    fn meeting(&self, f: FaceId) -> Point {
        let embedded = self.diagram.ground.canvas.embedded();
        let corners = embedded.topology.corners(f);
        let near = corners.map(|v| {
            let colour = self.colour(v);
            Near { colour, squares: corners.map(|w| self.square(w, colour)) }
        });
        let weights = meeting([&near[0], &near[1], &near[2]]).map_or([1.0; 3], |(weights, _)| weights);
        let inside = weights.map(|w| w.max(0.0));
        let sum: f64 = inside.iter().sum();
        let [a, b, c] = embedded.triangle(f);
        a + ((b - a) * inside[1] + (c - a) * inside[2]) * (1.0 / sum)
    }

    /// The squared distance to a seed; infinite where it is not known.
    fn square(&self, v: VertexId, colour: u32) -> f64 {
        self.overlap.distance(v, colour).map_or(f64::INFINITY, |d| d * d)
    }

    fn neighbours(&self) -> Vec<[u32; 2]> {
        let topology = &self.diagram.ground.canvas.embedded().topology;
        let ends = topology.edges().map(|h| topology.ends(h).map(|v| self.colour(v)));
        let border = ends.filter(|&[a, b]| a != b && a != NO_COLOUR && b != NO_COLOUR);
        distinct(border.map(|[a, b]| [a.min(b), a.max(b)]))
    }
}

/// Joins pieces to closed chains of nodes, colour by colour. Around every node the pieces of a colour alternate between
/// coming and going, once each.
fn chains(pieces: &mut [Piece]) -> Vec<(u32, Vec<u32>)> {
    pieces.sort_unstable();
    let mut is_done = vec![false; pieces.len()];
    let mut chains = Vec::new();
    for first in 0..pieces.len() {
        let (colour, mut at, mut chain) = (pieces[first].colour, first, Vec::new());
        while !std::mem::replace(&mut is_done[at], true) {
            chain.push(pieces[at].from);
            let key = (colour, pieces[at].to);
            at = pieces.binary_search_by_key(&key, |p| (p.colour, p.from)).unwrap_or(first);
        }
        if !chain.is_empty() {
            chains.push((colour, chain));
        }
    }
    chains
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Canvas;
    use crate::diagram::test_diagrams::{plate_with_hole, seeds_of};
    use crate::error::Result;
    use crate::manifold::domain::Domain;
    use crate::metric::{MetricField, Swirl};

    fn area(points: &[Point]) -> f64 {
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).map(|(p, q)| 0.5 * (p.x * q.y - q.x * p.y)).sum()
    }

    fn of_seeds(domain: &Domain, field: &dyn MetricField, seeds: &[Point], vertices: usize) -> Result<Cells> {
        let canvas = Canvas::intrinsic(domain.planar(), field, vertices)?;
        Ok(Diagram::new(&canvas, field, seeds)?.to_cells())
    }

    #[test]
    fn outlines_cover_the_domain_once() {
        let domain = plate_with_hole();
        let seeds = seeds_of(&domain, 40);
        let cells = of_seeds(&domain, &Swirl::default(), &seeds, 4000).unwrap();
        let areas: Vec<f64> = cells.outlines.iter().map(|c| c.iter().map(|o| area(&o.points)).sum()).collect();
        assert!(areas.iter().all(|&a| a > 0.0), "{areas:?}");
        assert!((areas.iter().sum::<f64>() - domain.area()).abs() < 1e-9 * domain.area());
        let inside: f64 = cells.border.iter().map(|b| area(b)).sum();
        assert!((inside - domain.area()).abs() < 1e-9 * domain.area());
        assert!(cells.neighbours.iter().all(|&[a, b]| a < b && (b as usize) < seeds.len()));
    }

    #[test]
    fn borders_of_a_flat_metric_are_bisectors() {
        let domain = Domain::shape("rect:0,0,2,1").unwrap();
        let seeds = [Point::new(0.5, 0.52), Point::new(1.5, 0.48)];
        let uniform = |_: Point| crate::geometry::Tensor::IDENTITY;
        let cells = of_seeds(&domain, &uniform, &seeds, 2000).unwrap();
        let outline = &cells.outlines[0][0];
        assert_eq!(outline.corners.len(), 2, "the bisector's ends");
        let on_bisector = outline.points.iter().filter(|p| p.distance(seeds[0]) > p.distance(seeds[1]) - 1e-6);
        assert!(on_bisector.clone().count() > 10);
        for p in on_bisector {
            assert!((p.distance(seeds[0]) - p.distance(seeds[1])).abs() < 1e-6, "{p}");
        }
        assert!((area(&outline.points) - 1.0).abs() < 1e-6);
    }
}
