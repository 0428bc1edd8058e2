//! Geodesics of a triangulation that is known by its lengths: a strip of faces is laid out flat, the path in it pulled taut,
//! and where it bends around a vertex that it may pass on the other side, the strip does (Xin and Wang 2007).
//!
//! The result is exact for the polyhedral surface that the lengths make, whatever it is embedded in, if at all; it is the
//! shortest of the paths that pass vertices as it does, which need not be the shortest of all.

use super::edge_path::edge_path;
use super::in_circle::opposite;
use crate::elementary::Elementary;
use crate::geometry::Point;
use crate::triangulation::{HalfEdge, Triangulation, VertexId};
use std::f64::consts::PI;

/// A path bends around a vertex if the angle that it leaves on the other side is less than a straight one by more than this.
const BENT: f64 = 1e-12;
/// Vertices passed on the other side at most, for each face of the first strip and some more: each makes it shorter.
const SWITCHES_PER_FACE: usize = 16;

/// A locally shortest path between two vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Taut {
    /// Its metric length.
    pub length: f64,
    /// The edges that it crosses, in order, each by its side on the face that the path leaves, and where: the share of the
    /// way from the half-edge's origin to its target. 0 or 1 where it bends around that end.
    pub crossings: Vec<(HalfEdge, f64)>,
    /// Vertices that it passes through: those that it bends around, at the border or where there is more than a full angle
    /// around them, and any that are on its way.
    pub bends: usize,
}

/// The locally shortest path from one vertex to another that is found from the shortest way along edges; `None` where there
/// is no way. All edges have lengths that make triangles.
///
/// A vertex passed on one side may hide a shorter path on the other (across a hole, or behind a peak); between near vertices
/// on a fine triangulation this is the shortest path.
pub(crate) fn taut(topology: &Triangulation, from: VertexId, to: VertexId) -> Option<Taut> {
    if from == to {
        return Some(Taut::default());
    }
    let edges = edge_path(topology, from, to)?;
    let straight = Taut { length: edges.iter().map(|&h| topology.length(h)).sum(), ..Taut::default() };
    if edges.len() == 1 {
        return Some(straight);
    }
    let mut strip = Strip { topology, from, to, portals: Vec::new() };
    if !strip.along(&edges) {
        // Walls on both sides of an inner vertex: the way along edges is all there is.
        return Some(Taut { bends: edges.len() - 1, ..straight });
    }
    Some(strip.pulled())
}

/// Faces from one vertex to another, by the edges between them: sides on the face that is left, whose target is to the left.
struct Strip<'a> {
    topology: &'a Triangulation,
    from: VertexId,
    to: VertexId,
    portals: Vec<HalfEdge>,
}

/// A vertex that the taut path touches.
#[derive(Clone, Copy)]
struct Bend {
    /// Its portal, and whether it is the left end of it.
    portal: usize,
    is_left: bool,
    at: Point,
}

impl Strip<'_> {
    /// The strip beside a way along edges, past each vertex on the side of the smaller angle; says whether there is one.
    fn along(&mut self, edges: &[HalfEdge]) -> bool {
        let topology = self.topology;
        let mut at = self.from;
        let mut was_left = None;
        for pair in edges.windows(2) {
            let v = if topology.origin(pair[0]) == at { topology.target(pair[0]) } else { topology.origin(pair[0]) };
            let [left, right] = [true, false].map(|is_left| self.past(v, pair, is_left));
            let is_left = match (&left, &right) {
                (None, None) => return false,
                (Some(left), Some(right)) => left.1 <= right.1,
                (left, _) => left.is_some(),
            };
            if was_left.is_some_and(|was| was != is_left) {
                // From one side of the edge to the other.
                let side = self.directed(pair[0], v, !is_left);
                self.portals.extend(side);
            }
            self.portals.extend(if is_left { left } else { right }.into_iter().flat_map(|found| found.0));
            (at, was_left) = (v, Some(is_left));
        }
        self.trim();
        true
    }

    /// The side of an edge on its left (or right), seen on the way to v; `None` where there is no face.
    fn directed(&self, edge: HalfEdge, v: VertexId, is_left: bool) -> Option<HalfEdge> {
        if (self.topology.target(edge) == v) == is_left { Some(edge) } else { self.topology.twin(edge) }
    }

    /// The portals past a vertex to its left (or right), from one edge to the next, and the angle between these; `None`
    /// across a border.
    fn past(&self, v: VertexId, pair: &[HalfEdge], is_left: bool) -> Option<(Vec<HalfEdge>, f64)> {
        let first = self.directed(pair[0], v, is_left)?;
        // The side of the next edge that is in the last face: on the way to v, left and right are exchanged.
        let last = self.directed(pair[1], v, !is_left)?;
        let (mut portals, mut angle) = (Vec::new(), 0.0);
        for portal in self.fan(first, is_left) {
            angle += self.angle_at(v, portal);
            if portal == last {
                return Some((portals, angle));
            }
            portals.push(portal);
        }
        None
    }

    /// The portals out of one face after the other around the left (or right) end of a half-edge, from its face on.
    fn fan(&self, from: HalfEdge, is_left: bool) -> impl Iterator<Item = HalfEdge> {
        let out = move |h: HalfEdge| if is_left { h.next() } else { h.prev() };
        std::iter::successors(Some(out(from)), move |&portal| self.topology.twin(portal).map(out))
    }

    /// The angle at a vertex in the face of a half-edge that begins or ends there.
    fn angle_at(&self, v: VertexId, h: HalfEdge) -> f64 {
        let out = if self.topology.origin(h) == v { h } else { h.next() };
        let [a, b, c] = [out, out.prev(), out.next()].map(|e| self.topology.length(e));
        let ((cosine, sine), _) = opposite(c, a, b);
        sine.arctangent_over(cosine)
    }

    /// Drops portals that are crossed back at once, and those at the ends of the path.
    fn trim(&mut self) {
        let topology = self.topology;
        let mut kept: Vec<HalfEdge> = Vec::with_capacity(self.portals.len());
        for &portal in &self.portals {
            if kept.last().is_some_and(|&last| topology.twin(last) == Some(portal)) {
                kept.pop();
            } else {
                kept.push(portal);
            }
        }
        let touches = |h: HalfEdge, v: VertexId| topology.ends(h).contains(&v);
        let first = kept.iter().position(|&h| !touches(h, self.from)).unwrap_or(kept.len());
        kept.drain(..first);
        let last = kept.iter().rposition(|&h| !touches(h, self.to)).map_or(0, |i| i + 1);
        kept.truncate(last);
        self.portals = kept;
    }

    /// Pulls taut, and passes vertices on the other side as long as that makes the path shorter.
    fn pulled(mut self) -> Taut {
        let most = SWITCHES_PER_FACE * (self.portals.len() + 4);
        for _ in 0..most {
            let Some(layout) = self.laid_out() else { break };
            let bends = layout.bends();
            let path = layout.path(&bends);
            let switched = bends.iter().enumerate().find_map(|(i, &bend)| {
                let [before, at, after] = [path[i], path[i + 1], path[i + 2]];
                self.switched(bend, (before - at).turn(after - at))
            });
            let Some(portals) = switched else { return layout.taut(&self.portals, &bends) };
            self.portals = portals;
            self.trim();
        }
        self.laid_out().map_or_else(|| self.one_edge(), |layout| layout.taut(&self.portals, &layout.bends()))
    }

    /// Both ends are in one face.
    fn one_edge(&self) -> Taut {
        let length = self.topology.edge_between(self.from, self.to);
        Taut { length: length.map_or(f64::NAN, |h| self.topology.length(h)), ..Taut::default() }
    }

    /// The portals with a bend's vertex passed on the other side; `None` where the path is no shorter there.
    fn switched(&self, bend: Bend, turn: f64) -> Option<Vec<HalfEdge>> {
        let topology = self.topology;
        let end = |h: HalfEdge| if bend.is_left { topology.target(h) } else { topology.origin(h) };
        let v = end(self.portals[bend.portal]);
        if topology.is_border_vertex(v) {
            return None;
        }
        let around: f64 = topology.star(v).map(|h| self.angle_at(v, h)).sum();
        if around - (2.0 * PI - turn) >= PI - BENT {
            return None;
        }
        let before = self.portals[..bend.portal].iter().rev().take_while(|&&h| end(h) == v).count();
        let after = self.portals[bend.portal..].iter().take_while(|&&h| end(h) == v).count();
        let (first, last) = (bend.portal - before, bend.portal + after - 1);
        let goal = topology.twin(self.portals[last])?.face();
        let mut portals = self.portals[..first].to_vec();
        for portal in self.fan(self.portals[first], bend.is_left) {
            portals.push(portal);
            if topology.twin(portal)?.face() == goal {
                break;
            }
        }
        portals.extend(&self.portals[last + 1..]);
        Some(portals)
    }

    /// The strip in the plane; `None` of a strip of one face.
    fn laid_out(&self) -> Option<Layout> {
        let topology = self.topology;
        let &first = self.portals.first()?;
        let (mut right, mut left) = (Point::default(), Point::new(topology.length(first), 0.0));
        let from = apex_over(right, left, topology.length(first.prev()), topology.length(first.next()));
        let mut layout = Layout { from, to: Point::default(), ends: Vec::with_capacity(self.portals.len()) };
        for (i, &portal) in self.portals.iter().enumerate() {
            layout.ends.push([left, right]);
            let across = topology.twin(portal)?;
            let apex = apex_over(left, right, topology.length(across.prev()), topology.length(across.next()));
            match self.portals.get(i + 1) {
                Some(&next) if next == across.next() => left = apex,
                Some(_) => right = apex,
                None => layout.to = apex,
            }
        }
        Some(layout)
    }
}

/// A strip laid out flat: its ends, and the left and right ends of its portals.
struct Layout {
    from: Point,
    to: Point,
    ends: Vec<[Point; 2]>,
}

impl Layout {
    /// The vertices that the shortest path in the strip bends around (Lee and Preparata 1984), in order.
    fn bends(&self) -> Vec<Bend> {
        let mut bends = Vec::new();
        let (mut apex, mut start) = (self.from, 0);
        while let Some(bend) = self.next_bend(apex, start) {
            (apex, start) = (bend.at, self.past(bend));
            bends.push(bend);
        }
        bends
    }

    /// The first bend of the path that is at the apex before a portal: the funnel from there closes at it.
    fn next_bend(&self, apex: Point, start: usize) -> Option<Bend> {
        let [mut left, mut right] = [None::<Bend>; 2];
        for portal in start..=self.ends.len() {
            let [at_left, at_right] = self.ends.get(portal).copied().unwrap_or([self.to; 2]);
            if right.is_none_or(|r| turn(apex, r.at, at_right) >= 0.0) {
                if let Some(l) = left.filter(|l| turn(apex, l.at, at_right) > 0.0) {
                    return Some(l);
                }
                right = Some(Bend { portal, is_left: false, at: at_right });
            }
            if left.is_none_or(|l| turn(apex, l.at, at_left) <= 0.0) {
                if let Some(r) = right.filter(|r| turn(apex, r.at, at_left) < 0.0) {
                    return Some(r);
                }
                left = Some(Bend { portal, is_left: true, at: at_left });
            }
        }
        None
    }

    /// The first portal behind a bend that does not end in it.
    fn past(&self, bend: Bend) -> usize {
        let same = |ends: &&[Point; 2]| ends[usize::from(!bend.is_left)] == bend.at;
        bend.portal + self.ends[bend.portal..].iter().take_while(same).count()
    }

    fn path(&self, bends: &[Bend]) -> Vec<Point> {
        let inner = bends.iter().map(|bend| bend.at);
        std::iter::once(self.from).chain(inner).chain(std::iter::once(self.to)).collect()
    }

    fn taut(&self, portals: &[HalfEdge], bends: &[Bend]) -> Taut {
        let path = self.path(bends);
        let length = path.windows(2).map(|w| w[0].distance(w[1])).sum();
        let mut crossings = Vec::with_capacity(portals.len());
        let mut piece = 0;
        for (i, (&portal, &[left, right])) in portals.iter().zip(&self.ends).enumerate() {
            // A bend's portals before the one that it is known by are crossed at it, too.
            while bends.get(piece).is_some_and(|b| i >= b.portal && self.ends[i][usize::from(!b.is_left)] != b.at) {
                piece += 1;
            }
            let [p, q] = [path[piece], path[piece + 1]];
            let (at_right, at_left) = (turn(p, q, right), turn(p, q, left));
            let share = at_right / (at_right - at_left);
            crossings.push((portal, if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 }));
        }
        Taut { length, crossings, bends: bends.len() }
    }
}

/// Twice the signed area of a triangle: positive where c is left of the way from a to b.
fn turn(a: Point, b: Point, c: Point) -> f64 {
    (b - a).cross(c - a)
}

/// The point to the left of the way from a to b that has these distances from both.
fn apex_over(a: Point, b: Point, from_a: f64, from_b: f64) -> Point {
    let long = a.distance(b);
    let along = (b - a) * (1.0 / long);
    let foot = 0.5 * (long + (from_a - from_b) * (from_a + from_b) / long);
    // Four areas, squared: well defined for thin faces, too.
    let sum = from_a + from_b;
    let product = (sum + long) * (sum - long) * (long + from_a - from_b) * (long - from_a + from_b);
    a + along * foot + along.perpendicular() * (0.5 * product.max(0.0).sqrt() / long)
}

#[cfg(test)]
mod tests {
    use super::*;

    type Place = [f64; 3];

    fn distance(a: Place, b: Place) -> f64 {
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// A triangulation with the lengths of straight edges in space.
    fn in_space(places: &[Place], triangles: &[[u32; 3]]) -> Triangulation {
        let mut topology = Triangulation::from_triangles(places.len(), triangles, &vec![0; triangles.len()]);
        for h in topology.edges().collect::<Vec<_>>() {
            let [a, b] = topology.ends(h).map(|v| places[v.index()]);
            topology.set_length(h, distance(a, b));
        }
        topology.check().unwrap();
        topology
    }

    /// A square of n x n cells, shaken, in pieces as a test of cells says, with its vertices' numbers by row and column.
    fn sheet(n: u32, shaken: f64, holds: impl Fn(u32, u32) -> bool) -> (Vec<Place>, Vec<[u32; 3]>) {
        let shake = |i: u32, x: f64| if i == 0 || i == n { 0.0 } else { shaken * (x * 12.9898).sin() };
        let at = |i: u32, j: u32| {
            let (x, y) = (f64::from(i), f64::from(j));
            [x + shake(i, 3.1 * x + 1.7 * y), y + shake(j, 2.3 * x - 4.9 * y), 0.0].map(|c| c / f64::from(n))
        };
        let places = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j))).collect();
        let cells = (0..n).flat_map(|j| (0..n).map(move |i| (i, j))).filter(|&(i, j)| holds(i, j));
        let triangles = |(i, j): (u32, u32)| {
            let [a, b, c, d] = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| j * (n + 1) + i);
            if (i + j) % 2 == 0 { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
        };
        (places, cells.flat_map(triangles).collect())
    }

    #[test]
    fn in_the_plane_paths_are_straight() {
        let (places, triangles) = sheet(20, 0.3, |_, _| true);
        let topology = in_space(&places, &triangles);
        let ids = |k: u32| VertexId((k * 7919) % places.len() as u32);
        for (from, to) in (0..120).map(|k| (ids(2 * k), ids(2 * k + 1))).filter(|(from, to)| from != to) {
            let [p, q] = [from, to].map(|v| places[v.index()]);
            let found = taut(&topology, from, to).unwrap();
            assert!((found.length / distance(p, q) - 1.0).abs() < 1e-12, "{from:?} {to:?} {found:?}");
            for (h, share) in found.crossings {
                let [a, b] = topology.ends(h).map(|v| places[v.index()]);
                let on = [0, 1, 2].map(|i| a[i] + share * (b[i] - a[i]));
                assert!((distance(p, on) + distance(on, q) - found.length).abs() < 1e-9, "{from:?} {to:?}");
            }
        }
    }

    #[test]
    fn around_a_hole_they_bend_at_its_corners() {
        // A hole from (0.3, 0.3) to (0.7, 0.7).
        let (places, triangles) = sheet(20, 0.0, |i, j| !((6..14).contains(&i) && (6..14).contains(&j)));
        let mut topology = in_space(&places, &triangles);
        topology.split_pinched_vertices();
        let at = |x: u32, y: u32| VertexId(y * 21 + x);
        let found = taut(&topology, at(2, 9), at(19, 8)).unwrap();
        // Below the hole: by (0.3, 0.3) and (0.7, 0.3).
        let exact = 0.2_f64.hypot(0.15) + 0.4 + 0.25_f64.hypot(0.1);
        assert!((found.length - exact).abs() < 1e-12 && found.bends >= 2, "{found:?} {exact}");
        let straight = taut(&topology, at(2, 2), at(18, 5)).unwrap();
        assert!((straight.length - 0.8_f64.hypot(0.15)).abs() < 1e-12 && straight.bends == 0, "{straight:?}");
    }

    /// The cube from 0 to 1, its faces cut into n x n cells.
    fn cube(n: u32) -> (Vec<Place>, Vec<[u32; 3]>) {
        let mut numbers = std::collections::HashMap::new();
        let (mut places, mut triangles) = (Vec::new(), Vec::new());
        let mut number = |at: [u32; 3]| {
            *numbers.entry(at).or_insert_with(|| {
                places.push(at.map(|c| f64::from(c) / f64::from(n)));
                places.len() as u32 - 1
            })
        };
        for (axis, side, i, j) in (0..3)
            .flat_map(|a| [0, n].map(|s| (a, s)))
            .flat_map(|(a, s)| (0..n).flat_map(move |i| (0..n).map(move |j| (a, s, i, j))))
        {
            let mut corner = |i: u32, j: u32| {
                let mut at = [0; 3];
                (at[axis], at[(axis + 1) % 3], at[(axis + 2) % 3]) = (side, i, j);
                number(at)
            };
            let mut quad = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            if side == 0 {
                quad.reverse();
            }
            let [a, b, c, d] = quad;
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        (places, triangles)
    }

    #[test]
    fn opposite_corners_of_a_cube_are_the_root_of_five_apart() {
        for n in [1, 2, 5] {
            let (places, triangles) = cube(n);
            let topology = in_space(&places, &triangles);
            let find = |at: Place| VertexId(places.iter().position(|&p| distance(p, at) < 1e-9).unwrap() as u32);
            for (a, b) in [([0.0; 3], [1.0; 3]), ([1.0, 0.0, 0.0], [0.0, 1.0, 1.0]), ([0.0, 1.0, 0.0], [1.0, 0.0, 1.0])]
            {
                let found = taut(&topology, find(a), find(b)).unwrap();
                assert!((found.length - 5.0_f64.sqrt()).abs() < 1e-12, "{n}: {found:?}");
            }
        }
    }

    #[test]
    fn on_finer_and_finer_spheres_they_tend_to_arcs_in_second_order() {
        let errors = [8, 16, 32].map(|n| {
            let (places, triangles) = cube(n);
            let onto = |p: &Place| {
                let at = p.map(|c| (std::f64::consts::FRAC_PI_4 * (2.0 * c - 1.0)).tan());
                at.map(|c| c / distance(at, [0.0; 3]))
            };
            let places: Vec<Place> = places.iter().map(onto).collect();
            let topology = in_space(&places, &triangles);
            let errors = (0..60).map(|k| {
                let [from, to] = [37 * k + 5, 101 * k + 60].map(|i| VertexId(i % places.len() as u32));
                let [p, q] = [from, to].map(|v| places[v.index()]);
                let arc = 2.0 * (0.5 * distance(p, q)).asin();
                // Nearly opposite places have many ways that are nearly the shortest.
                if from == to || arc > 2.5 {
                    0.0
                } else {
                    (taut(&topology, from, to).unwrap().length / arc - 1.0).abs()
                }
            });
            errors.fold(0.0, f64::max)
        });
        let orders = [0, 1].map(|i| (errors[i] / errors[i + 1]).log2());
        assert!(orders.iter().all(|order| *order > 1.7) && errors[2] < 2e-3, "{errors:?} {orders:?}");
    }

    #[test]
    fn there_is_no_way_between_two_pieces_and_none_to_go_to_oneself() {
        let (places, triangles) = sheet(6, 0.0, |i, _| i != 3);
        let topology = in_space(&places, &triangles);
        assert_eq!(taut(&topology, VertexId(0), VertexId(6)), None);
        assert_eq!(taut(&topology, VertexId(9), VertexId(9)), Some(Taut::default()));
    }
}
