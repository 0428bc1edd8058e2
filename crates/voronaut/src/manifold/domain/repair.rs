//! Outlines whose lines cross, lie on each other or nearly meet, made graphs that [`Domain::new`](super::Domain::new) accepts.

use super::build::{check_entries, triangulate};
use super::polygons::lines;
use super::sides::{Covers, differing, faces_beside};
use super::{Filling, Polygons, Pslg, Segment, Side};
use crate::error::{Error, Result, counted};
use crate::geometry::{
    Aabb, Bounds, BoxTree, Point, around, meeting_pairs, orientation, segment_intersection, widened,
};
use crate::lists::{distinct, in_order, marked};
use std::collections::{BTreeMap, HashMap};

/// What is nearer to each other than this share of the diagonal is at one place.
const NEAR: f64 = 1e-9;
/// Joining points and cutting lines moves lines, which may then meet others: so often at most.
const ROUNDS: usize = 32;

/// The domain that polygons cover, whatever their rings do: of places that several polygons cover the first has the say, and what a
/// ring runs over twice counts for nothing. With what was done, in words.
///
/// Points nearer than 1e-9 of the diagonal are one; lines are cut where they cross, and where another's end is as near. n log n for n
/// segments, and as much for every round of that.
///
/// # Errors
/// [`Error::Domain`] of coordinates that are not finite or out of range, and of polygons without any area.
pub fn repaired_polygons(polygons: &Polygons) -> Result<(Pslg, Vec<String>)> {
    let (graph, polygon_of) = lines(polygons);
    let pieces = graph.segments.iter().zip(polygon_of).map(|(&segment, polygon)| Piece { segment, of: vec![polygon] });
    let mut work = Work::new(&graph, pieces.collect())?;
    work.arrange(|piece| !piece.of.is_empty())?;
    let arranged = work.graph(&graph).of_segments();
    let planar = triangulate(&arranged)?;
    let covers = Covers::new(&planar, |segment| &work.pieces[segment as usize].of);
    let side =
        |polygon: Option<u32>| polygon.map_or(Side::Outside, |p| Side::Region(polygons.polygons[p as usize].region));
    let beside = faces_beside(&arranged, &planar).into_iter();
    let segments = beside.zip(&arranged.segments).filter_map(|(faces, &segment)| {
        let [left, right] = faces.map(|f| covers.first(f));
        (left != right).then_some(Segment { left: side(left), right: side(right), ..segment })
    });
    let made = Pslg { segments: segments.collect(), filling: Filling::Sides, ..arranged.clone() }.of_segments();
    check_entries(&made)?;
    let shared = said(covers.shared(), "[area|areas] of several polygons [is|are] the first one's");
    Ok((made, work.notes().chain(shared).collect()))
}

/// A graph with its points that are one joined, and its lines cut where they meet; as [`repaired_polygons`] does.
///
/// # Errors
/// [`Error::Domain`] of coordinates that are not finite or out of range.
pub fn repaired_graph(graph: &Pslg) -> Result<(Pslg, Vec<String>)> {
    let pieces = graph.segments.iter().map(|&segment| Piece { segment, of: Vec::new() });
    let mut work = Work::new(graph, pieces.collect())?;
    work.arrange(|_| true)?;
    Ok((work.graph(graph), work.notes().collect()))
}

/// A part of a line.
#[derive(Clone)]
struct Piece {
    segment: Segment,
    /// The polygons whose rings run over it an odd number of times, in order.
    of: Vec<u32>,
}

struct Work {
    points: Vec<Point>,
    pieces: Vec<Piece>,
    near: f64,
    /// Points of the input; the others are where lines cross.
    given: usize,
    /// The point that each one was joined to: itself, or one before it.
    joined: Vec<u32>,
    /// Where lines were cut.
    cuts: usize,
}

/// A piece that is cut, how far along it, and the point there.
type Cut = (u32, f64, u32);

impl Work {
    fn new(graph: &Pslg, pieces: Vec<Piece>) -> Result<Self> {
        check_entries(graph)?;
        let extent = Aabb::of(graph.points.iter().copied()).map_or(0.0, |bounds| bounds.extent().norm());
        let points = graph.points.clone();
        let joined = (0..points.len() as u32).collect();
        Ok(Self { given: points.len(), points, pieces, near: NEAR * extent, joined, cuts: 0 })
    }

    /// Joins and cuts until nothing is left to do; pieces that do not matter go.
    fn arrange(&mut self, matters: impl Fn(&Piece) -> bool) -> Result<()> {
        let mut place = Point::default();
        for _ in 0..ROUNDS {
            self.join_points();
            self.join_pieces(&matters);
            let mut cuts = self.touches();
            if cuts.is_empty() {
                cuts = self.crossings();
            }
            let Some(&(_, _, first)) = cuts.first() else { return Ok(()) };
            place = self.points[first as usize];
            self.cuts += cuts.len();
            self.cut(cuts);
        }
        let help = "mend the lines there: they are closer to each other than 1e-9 of the diagonal, over and over";
        Err(Error::domain("lines that meet anew wherever they are cut", place.to_string(), help))
    }

    /// Each point becomes the first that is as near, but for those that were joined to another themselves.
    fn join_points(&mut self) {
        let mut cells: HashMap<[i64; 2], Vec<u32>> = HashMap::new();
        let low = Aabb::of(self.points.iter().copied()).map_or(Point::default(), |bounds| bounds.min);
        for v in 0..self.points.len() {
            let p = self.points[v];
            if self.joined[v] != v as u32 {
                continue;
            }
            let [i, j] = [p.x - low.x, p.y - low.y].map(|x| (x / self.near) as i64);
            let around = (-1..=1).flat_map(|di| (-1..=1).map(move |dj| [i + di, j + dj]));
            let others = around.filter_map(|cell| cells.get(&cell)).flatten();
            match others.copied().filter(|&u| self.points[u as usize].distance(p) <= self.near).min() {
                Some(first) => self.joined[v] = first,
                None => cells.entry([i, j]).or_default().push(v as u32),
            }
        }
        for piece in &mut self.pieces {
            piece.segment.ends = piece.segment.ends.map(|v| self.joined[v as usize]);
        }
    }

    /// Pieces between the same points become the first, which is required if one of them is. Polygons that have it twice leave it.
    fn join_pieces(&mut self, matters: impl Fn(&Piece) -> bool) {
        let mut place: HashMap<[u32; 2], usize> = HashMap::new();
        let mut kept: Vec<Piece> = Vec::with_capacity(self.pieces.len());
        for piece in self.pieces.drain(..).filter(|piece| piece.segment.ends[0] != piece.segment.ends[1]) {
            let at = *place.entry(in_order(piece.segment.ends)).or_insert(kept.len());
            match kept.get_mut(at) {
                None => kept.push(piece),
                Some(first) => {
                    first.segment.required |= piece.segment.required;
                    first.of = differing(&first.of, &piece.of);
                }
            }
        }
        kept.retain(matters);
        self.pieces = kept;
    }

    fn ends(&self, piece: u32) -> [Point; 2] {
        self.pieces[piece as usize].segment.ends.map(|v| self.points[v as usize])
    }

    /// A box around each piece.
    fn boxes(&self) -> Vec<Bounds<2>> {
        (0..self.pieces.len() as u32).map(|piece| widened(around(self.ends(piece)), self.near)).collect()
    }

    /// Ends of pieces that are on others, or as near to them.
    fn touches(&self) -> Vec<Cut> {
        let (tree, mut cuts) = (BoxTree::new(self.boxes().into_iter().zip(0_u32..)), Vec::new());
        let is_end = marked(self.points.len(), self.pieces.iter().flat_map(|piece| piece.segment.ends));
        for (v, &p) in (0..).zip(&self.points).filter(|(v, _)| is_end[*v as usize]) {
            for &piece in tree.meeting([[p.x, p.y]; 2]) {
                let [a, b] = self.ends(piece);
                let along = self.along(piece, p);
                let is_on = (0.0..=1.0).contains(&along) && a.lerp(b, along).distance(p) <= self.near;
                if is_on && !self.pieces[piece as usize].segment.ends.contains(&v) {
                    cuts.push((piece, along, v));
                }
            }
        }
        cuts
    }

    /// Where pieces cross that do not touch; a new point for each.
    fn crossings(&mut self) -> Vec<Cut> {
        let crossing = |pair: [usize; 2]| {
            let [[a, b], [c, d]] = pair.map(|piece| self.ends(piece as u32));
            let parts = |a, b, c, d| orientation(a, b, c) != orientation(a, b, d);
            let is_apart = pair[0] == pair[1] || self.have_common_end(pair);
            (!is_apart && parts(a, b, c, d) && parts(c, d, a, b)).then(|| segment_intersection(a, b, c, d))
        };
        let found = meeting_pairs(&self.boxes(), |_| true, crossing);
        let mut cuts = Vec::new();
        for (pair, p) in found {
            let v = self.points.len() as u32;
            self.points.push(p);
            self.joined.push(v);
            cuts.extend(pair.map(|piece| (piece as u32, self.along(piece as u32, p), v)));
        }
        cuts
    }

    fn have_common_end(&self, pair: [usize; 2]) -> bool {
        let [one, other] = pair.map(|piece| self.pieces[piece].segment.ends);
        one.iter().any(|v| other.contains(v))
    }

    /// How far along a piece a point is: 0 at its first end, 1 at the other.
    fn along(&self, piece: u32, p: Point) -> f64 {
        let [a, b] = self.ends(piece);
        (p - a).dot(b - a) / (b - a).dot(b - a)
    }

    fn cut(&mut self, cuts: Vec<Cut>) {
        let mut along: BTreeMap<u32, Vec<(f64, u32)>> = BTreeMap::new();
        for (piece, at, v) in cuts {
            along.entry(piece).or_default().push((at, v));
        }
        for (piece, mut cuts) in along {
            cuts.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let whole = self.pieces[piece as usize].clone();
            let mut last = whole.segment.ends[0];
            for (_, v) in cuts {
                self.pieces.push(Piece { segment: Segment { ends: [last, v], ..whole.segment }, of: whole.of.clone() });
                last = v;
            }
            self.pieces[piece as usize].segment.ends[0] = last;
        }
    }

    /// The graph of all pieces.
    fn graph(&self, given: &Pslg) -> Pslg {
        let crossings = self.points.len() - self.given;
        let names = (0..self.given as u32).map(|v| given.name(v));
        let required = given.required_points.iter().map(|&v| self.joined[v as usize]);
        let stays: Vec<bool> = (0..).zip(&self.joined).map(|(v, &joined): (u32, _)| v == joined).collect();
        let graph = Pslg {
            points: self.points.clone(),
            point_labels: given.point_labels.iter().copied().chain(std::iter::repeat_n(0, crossings)).collect(),
            names: names.chain(std::iter::repeat_n("a crossing".to_owned(), crossings)).collect(),
            required_points: distinct(required),
            segments: self.pieces.iter().map(|piece| piece.segment).collect(),
            ..given.clone()
        };
        graph.with_points(&stays)
    }

    fn notes(&self) -> impl Iterator<Item = String> {
        let joined = (0..self.given as u32).filter(|&v| self.joined[v as usize] != v).count();
        let joined = said(joined, "[point was|points were] joined to [one|others] nearby");
        joined.into_iter().chain(said(self.cuts, "[line was|lines were] cut where [it meets|they meet] others"))
    }
}

/// What is said of so many, if there are any.
fn said(count: usize, words: &str) -> Option<String> {
    (count > 0).then(|| counted(count, words))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::domain::{Domain, Polygon, Ring};
    use crate::test_cases::cases;
    use proptest::prelude::*;

    fn polygon(region: i32, rings: &[&[(f64, f64)]]) -> Polygon {
        let ring = |points: &&[(f64, f64)]| Ring {
            points: points.iter().map(|&(x, y)| Point::new(x, y)).collect(),
            label: 10 + region,
        };
        Polygon { feature: region as usize, number: 1, region, rings: rings.iter().map(ring).collect() }
    }

    fn square(x: f64, y: f64) -> Vec<(f64, f64)> {
        vec![(x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0)]
    }

    /// The areas of regions in order, and what was said.
    fn repaired(polygons: &[Polygon]) -> (BTreeMap<i32, f64>, Vec<String>) {
        let (graph, notes) = repaired_polygons(&Polygons { polygons: polygons.to_vec() }).unwrap();
        let domain = Domain::new(&graph).unwrap();
        let planar = domain.planar();
        let mut areas = BTreeMap::new();
        for f in planar.topology.faces() {
            let [a, b, c] = planar.triangle(f);
            *areas.entry(planar.topology.region(f)).or_insert(0.0) += 0.5 * (b - a).cross(c - a);
        }
        (areas, notes)
    }

    fn has_areas(found: &BTreeMap<i32, f64>, wanted: &[(i32, f64)]) -> bool {
        found.len() == wanted.len() && wanted.iter().all(|(region, area)| (found[region] - area).abs() < 1e-9)
    }

    #[test]
    fn what_is_right_stays() {
        let polygons = [polygon(1, &[&square(0.0, 0.0)]), polygon(2, &[&square(1.0, 0.0)])];
        let (graph, notes) = repaired_polygons(&Polygons { polygons: polygons.to_vec() }).unwrap();
        let plain = crate::manifold::domain::from_polygons(&Polygons { polygons: polygons.to_vec() }).unwrap();
        assert_eq!((graph.points, graph.segments.len(), notes.len()), (plain.points, plain.segments.len(), 0));
    }

    #[test]
    fn neighbours_that_nearly_share_a_line_share_it() {
        let right = [(1.0 + 1e-13, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0 - 2e-12, 1.0), (1.0 + 3e-13, 0.4)];
        let (areas, notes) = repaired(&[polygon(1, &[&square(0.0, 0.0)]), polygon(2, &[&right])]);
        assert!(has_areas(&areas, &[(1, 1.0), (2, 1.0)]), "{areas:?}");
        assert_eq!(notes, ["2 points were joined to others nearby", "1 line was cut where it meets others"]);
    }

    #[test]
    fn of_several_polygons_the_first_has_the_say() {
        let (areas, notes) = repaired(&[polygon(4, &[&square(0.0, 0.0)]), polygon(3, &[&square(0.5, 0.5)])]);
        assert!(has_areas(&areas, &[(3, 0.75), (4, 1.0)]), "{areas:?}");
        assert_eq!(notes, ["4 lines were cut where they meet others", "1 area of several polygons is the first one's"]);
        let twice = [polygon(1, &[&square(0.0, 0.0)]), polygon(2, &[&square(0.0, 0.0)])];
        assert!(has_areas(&repaired(&twice).0, &[(1, 1.0)]));
    }

    #[test]
    fn what_a_ring_runs_over_twice_counts_for_nothing() {
        let spike = [(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let flat = [(5.0, 5.0), (6.0, 6.0), (7.0, 7.0)];
        let dot = [(5.0, 5.0); 3];
        let (areas, notes) = repaired(&[polygon(1, &[&spike]), polygon(2, &[&flat]), polygon(3, &[&dot])]);
        assert!(has_areas(&areas, &[(1, 1.0)]), "{areas:?} {notes:?}");
        let bow = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)];
        assert!(has_areas(&repaired(&[polygon(1, &[&bow])]).0, &[(1, 0.5)]));
    }

    #[test]
    fn points_of_lines_that_vanish_cut_nothing() {
        let triangle = [(2.0, 3.0), (2.0, 0.0), (3.0, 0.0)];
        let (areas, _) = repaired(&[polygon(1, &[&triangle]), polygon(2, &[&[(2.0, 2.0), (2.0, 2.0), (0.0, 0.0)]])]);
        assert!(has_areas(&areas, &[(1, 1.5)]), "{areas:?}");
    }

    #[test]
    fn what_has_no_area_is_refused() {
        let flat = polygon(1, &[&[(0.0, 0.0), (2.0, 1.0), (4.0, 2.0)]]);
        for polygons in [vec![], vec![flat], vec![polygon(1, &[&[(0.0, f64::NAN), (1.0, 0.0), (0.0, 1.0)]])]] {
            let error = repaired_polygons(&Polygons { polygons }).unwrap_err();
            assert!(!error.help().is_empty());
        }
    }

    #[test]
    fn lines_of_a_graph_are_cut_where_they_cross() {
        let ends = [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5]];
        let points = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 0.5), (0.5, 0.5)];
        let graph = Pslg {
            points: points.map(|(x, y)| Point::new(x, y)).to_vec(),
            point_labels: vec![7; 6],
            segments: ends.map(|ends| crate::manifold::domain::distinct::listed(ends, 3, false)).to_vec(),
            filling: Filling::Enclosed { holes: vec![], regions: vec![] },
            ..Pslg::default()
        };
        let (made, notes) = repaired_graph(&graph).unwrap();
        assert_eq!((made.points.len(), made.segments.len(), made.point_labels[6]), (7, 7, 0), "{notes:?}");
        assert_eq!(made.points[6], Point::new(0.0, 0.5));
    }

    /// The lines of a polygon.
    fn lines_of(polygon: &Polygon) -> impl Iterator<Item = [Point; 2]> {
        polygon.rings.iter().flat_map(|ring| {
            let next = ring.points.iter().cycle().skip(1);
            ring.points.iter().zip(next).map(|(&a, &b)| [a, b])
        })
    }

    /// Whether a point is inside by the rule of even and odd.
    fn is_inside(polygon: &Polygon, p: Point) -> bool {
        let crosses =
            |[a, b]: [Point; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
        lines_of(polygon).filter(|&line| crosses(line)).count() % 2 == 1
    }

    fn is_near(p: Point, [a, b]: [Point; 2]) -> bool {
        let square = (b - a).dot(b - a);
        let along = if square > 0.0 { ((p - a).dot(b - a) / square).clamp(0.0, 1.0) } else { 0.0 };
        a.lerp(b, along).distance(p) < 1e-6
    }

    fn rings() -> impl Strategy<Value = Vec<Polygon>> {
        let point = (0_i32..7, 0_i32..7, -1_i32..2);
        let ring = proptest::collection::vec(point, 3..9).prop_map(|points| Ring {
            points: points
                .iter()
                .map(|&(x, y, off)| Point::new(x.into(), f64::from(y) + 1e-12 * f64::from(off)))
                .collect(),
            label: 1,
        });
        let polygon = proptest::collection::vec(ring, 1..3);
        proptest::collection::vec(polygon, 1..5).prop_map(|polygons| {
            let of = |(i, rings): (i32, _)| Polygon { feature: i as usize, number: 1, region: i, rings };
            (1..).zip(polygons).map(of).collect()
        })
    }

    proptest! {
        #![proptest_config(cases(256))]
        #[test]
        fn any_rings_make_the_domain_that_they_cover(polygons in rings()) {
            let graph = repaired_polygons(&Polygons { polygons: polygons.clone() });
            // What is refused has no area.
            let domain = graph.ok().map(|(graph, _)| Domain::new(&graph).unwrap());
            let region = |p: Point| {
                let planar = domain.as_ref()?.planar();
                let holds = |f: &crate::triangulation::FaceId| {
                    let [a, b, c] = planar.triangle(*f);
                    [[a, b], [b, c], [c, a]].iter().all(|&[u, v]| (v - u).cross(p - u) >= 0.0)
                };
                planar.topology.faces().find(holds).map(|f| planar.topology.region(f))
            };
            for (i, j) in (0..50).flat_map(|i| (0..50).map(move |j| (i, j))) {
                let p = Point::new(0.137 * f64::from(i) + 0.0113, 0.139 * f64::from(j) - 0.0177);
                let wanted = polygons.iter().find(|polygon| is_inside(polygon, p)).map(|polygon| polygon.region);
                let near = polygons.iter().flat_map(lines_of).any(|line| is_near(p, line));
                prop_assert!(near || region(p) == wanted, "{p}: {:?} for {wanted:?}", region(p));
            }
        }
    }
}
