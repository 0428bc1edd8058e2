//! Domains from polygons.

use super::distinct::{key, listed};
use super::{Pslg, Segment, Side};
use crate::error::{Error, Result};
use crate::geometry::{Orientation, Point, orientation};
use crate::lists::in_order;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// The polygons of a file, in its order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygons {
    /// At least one, if read from a file.
    pub polygons: Vec<Polygon>,
}

/// An area: what its first ring encloses but its other rings do not.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// The feature it comes from, counted from 1.
    pub feature: usize,
    /// Which polygon of the feature it is, counted from 1.
    pub number: usize,
    /// The label of its region.
    pub region: i32,
    /// The outer ring, then the holes; in the orientation of the file, which may be either.
    pub rings: Vec<Ring>,
}

/// A closed line.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// At least three positions, of which consecutive ones that are equal count once; the closing position is left out.
    pub points: Vec<Point>,
    /// The label of the boundary along it.
    pub label: i32,
}

/// The domain covered by polygons, each of them a region with its label.
///
/// Rings may be oriented either way; segments keep their direction. Equal positions are one vertex. A segment of two
/// polygons is an interface: it keeps the label of the first.
///
/// # Errors
///
/// [`Error::Domain`] of no polygon, a ring without area, a ring that runs over the same segment twice, and polygons
/// that lie on the same side of a segment. Other overlaps and crossings are not looked for here.
pub fn from_polygons(polygons: &Polygons) -> Result<Pslg> {
    let mut builder = Builder::of(polygons);
    for polygon in &polygons.polygons {
        for (index, ring) in polygon.rings.iter().enumerate() {
            builder.add_ring(polygon, index, ring)?;
        }
    }
    if builder.segments.is_empty() {
        return Err(Error::domain("no polygon", "the list of polygons", "give at least one polygon"));
    }
    Ok(builder.finished())
}

/// The segments of all rings as they are, whatever they do, and the polygon of each.
pub(super) fn lines(polygons: &Polygons) -> (Pslg, Vec<u32>) {
    let (mut builder, mut polygon_of) = (Builder::of(polygons), Vec::new());
    for (number, polygon) in (0..).zip(&polygons.polygons) {
        for (index, ring) in polygon.rings.iter().enumerate() {
            let vertices = builder.vertices_of(polygon, index, &corners(ring));
            let ends = vertices.iter().copied().zip(vertices.iter().copied().cycle().skip(1));
            builder.segments.extend(ends.filter(|(a, b)| a != b).map(|(a, b)| listed([a, b], ring.label, false)));
            polygon_of.resize(builder.segments.len(), number);
        }
    }
    (builder.finished(), polygon_of)
}

#[derive(Default)]
struct Builder {
    /// Whether there is one polygon only, which messages need not name.
    single: bool,
    points: Vec<Point>,
    names: Vec<String>,
    vertices: HashMap<[u64; 2], u32>,
    segments: Vec<Segment>,
    /// Which entry of `segments` joins two vertices.
    joined: HashMap<[u32; 2], usize>,
    /// For each segment the number of the ring that came last.
    last_ring: Vec<usize>,
    rings: usize,
}

impl Builder {
    fn of(polygons: &Polygons) -> Self {
        Self { single: polygons.polygons.len() == 1, ..Self::default() }
    }

    fn finished(self) -> Pslg {
        Pslg {
            point_labels: vec![0; self.points.len()],
            points: self.points,
            segments: self.segments,
            names: self.names,
            ..Pslg::default()
        }
    }

    fn add_ring(&mut self, polygon: &Polygon, index: usize, ring: &Ring) -> Result<()> {
        let corners = corners(ring);
        let points: Vec<Point> = corners.iter().map(|&(_, p)| p).collect();
        let Some(is_counter_clockwise) = is_counter_clockwise(&points) else {
            let name = self.ring_name(polygon, index);
            let place = format!("{name}, position 1 {}", points.first().copied().unwrap_or_default());
            return Err(Error::domain(
                "a ring without area",
                place,
                "remove the ring, correct its positions, or have it left out (`repair`)",
            ));
        };
        let is_outer = index == 0;
        let region_is_left = is_counter_clockwise == is_outer;
        let vertices = self.vertices_of(polygon, index, &corners);
        self.rings += 1;
        for (position, &a) in vertices.iter().enumerate() {
            let b = vertices[(position + 1) % vertices.len()];
            self.claim([a, b], region_is_left, polygon.region, ring.label)?;
        }
        Ok(())
    }

    fn ring_name(&self, polygon: &Polygon, index: usize) -> String {
        if self.single {
            return format!("ring {}", index + 1);
        }
        format!("feature {}, polygon {}, ring {}", polygon.feature, polygon.number, index + 1)
    }

    fn vertices_of(&mut self, polygon: &Polygon, ring: usize, corners: &[(usize, Point)]) -> Vec<u32> {
        let name = self.ring_name(polygon, ring);
        corners.iter().map(|&(position, p)| self.vertex(p, position, &name)).collect()
    }

    fn vertex(&mut self, p: Point, position: usize, ring: &str) -> u32 {
        *self.vertices.entry(key(p)).or_insert_with(|| {
            self.points.push(p);
            self.names.push(format!("{ring}, position {position}"));
            self.points.len() as u32 - 1
        })
    }

    /// Puts a region on one side of the segment between two vertices.
    fn claim(&mut self, ends: [u32; 2], left: bool, region: i32, label: i32) -> Result<()> {
        let index = match self.joined.entry(in_order(ends)) {
            Entry::Occupied(entry) => *entry.get(),
            Entry::Vacant(entry) => {
                entry.insert(self.segments.len());
                let (left, right) = (Side::Outside, Side::Outside);
                self.segments.push(Segment { ends, label, required: false, left, right });
                self.last_ring.push(0);
                self.segments.len() - 1
            }
        };
        if self.last_ring[index] == self.rings {
            let help = "remove the part of the ring that runs forth and back, or have it left out (`repair`)";
            return Err(self.segment_error("a ring runs over a segment twice", ends, help));
        }
        self.last_ring[index] = self.rings;
        let segment = &mut self.segments[index];
        let side = if left == (segment.ends == ends) { &mut segment.left } else { &mut segment.right };
        if let Side::Region(earlier) = *side {
            let what = format!("overlapping polygons: regions {earlier} and {region} on the same side of a segment");
            return Err(self.segment_error(
                &what,
                ends,
                "cut the overlap out of one of the polygons, or leave it to the first (`repair`)",
            ));
        }
        *side = Side::Region(region);
        Ok(())
    }

    fn segment_error(&self, what: &str, ends: [u32; 2], help: &str) -> Error {
        let [a, b] = ends.map(|v| format!("{} {}", self.names[v as usize], self.points[v as usize]));
        Error::domain(what, format!("{a} - {b}"), help)
    }
}

/// The positions of a ring with their numbers, counted from 1, without repetitions of the one before.
fn corners(ring: &Ring) -> Vec<(usize, Point)> {
    let mut corners: Vec<(usize, Point)> = (1..).zip(ring.points.iter().copied()).collect();
    corners.dedup_by(|next, last| next.1 == last.1);
    while corners.len() > 1 && corners.first().map(|c| c.1) == corners.last().map(|c| c.1) {
        corners.pop();
    }
    corners
}

/// The orientation of a closed line that does not cross itself; `None` if it encloses nothing.
pub(super) fn is_counter_clockwise(points: &[Point]) -> Option<bool> {
    let origin = *points.first()?;
    let (mut area, mut size) = (0.0, 0.0);
    for index in 0..points.len() {
        let (a, b) = (points[index] - origin, points[(index + 1) % points.len()] - origin);
        area += a.cross(b);
        size += (a.x * b.y).abs() + (a.y * b.x).abs();
    }
    // The sum of n terms is off by less than n roundings of their sizes.
    if f64::abs(area) > size * f64::EPSILON * (points.len() as f64 + 4.0) {
        return Some(area > 0.0);
    }
    turns_left_at_its_corner(points)
}

/// The orientation from the exact turn at the smallest point (by x, then y), where the line is convex.
fn turns_left_at_its_corner(points: &[Point]) -> Option<bool> {
    let order = |&a: &usize, &b: &usize| points[a].x.total_cmp(&points[b].x).then(points[a].y.total_cmp(&points[b].y));
    let corner = (0..points.len()).min_by(order)?;
    let (before, after) = ((corner + points.len() - 1) % points.len(), (corner + 1) % points.len());
    match orientation(points[before], points[corner], points[after]) {
        Orientation::Left => Some(true),
        Orientation::Right => Some(false),
        Orientation::Collinear => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(points: &[(f64, f64)], label: i32) -> Ring {
        Ring { points: points.iter().map(|&(x, y)| Point::new(x, y)).collect(), label }
    }

    fn square(x: f64, region: i32) -> Polygon {
        let rings = vec![ring(&[(x, 0.0), (x + 1.0, 0.0), (x + 1.0, 1.0), (x, 1.0)], 10 + region)];
        Polygon { feature: region as usize, number: 1, region, rings }
    }

    fn domain(polygons: Vec<Polygon>) -> Result<Pslg> {
        from_polygons(&Polygons { polygons })
    }

    #[test]
    fn sides_follow_from_either_orientation() {
        let hole = [(0.2, 0.2), (0.8, 0.2), (0.5, 0.8)];
        for reversed in 0..4 {
            let mut polygon = square(0.0, 7);
            polygon.rings.push(ring(&hole, 2));
            for (index, ring) in polygon.rings.iter_mut().enumerate() {
                if reversed >> index & 1 == 1 {
                    ring.points.reverse();
                }
            }
            let pslg = domain(vec![polygon]).unwrap();
            assert_eq!((pslg.points.len(), pslg.segments.len()), (7, 7));
            for (number, segment) in pslg.segments.iter().enumerate() {
                let (is_hole, flipped) = (number >= 4, reversed >> usize::from(number >= 4) & 1 == 1);
                let inside = if is_hole == flipped { segment.left } else { segment.right };
                let outside = if is_hole == flipped { segment.right } else { segment.left };
                assert_eq!((inside, outside), (Side::Region(7), Side::Outside), "segment {number}");
            }
        }
    }

    #[test]
    fn repeated_positions_count_once() {
        let mut polygon = square(0.0, 7);
        let points = &mut polygon.rings[0].points;
        *points = [0, 0, 1, 2, 2, 2, 3, 0, 0].map(|i| points[i]).to_vec();
        let (repeated, plain) = (domain(vec![polygon]).unwrap(), domain(vec![square(0.0, 7)]).unwrap());
        assert_eq!((repeated.points, repeated.segments), (plain.points, plain.segments));
        assert_eq!(repeated.names[3], "ring 1, position 7");
    }

    #[test]
    fn neighbours_share_an_interface() {
        let mut right = square(1.0, 2);
        right.rings[0].points.reverse();
        let pslg = domain(vec![square(0.0, 1), right]).unwrap();
        assert_eq!((pslg.points.len(), pslg.segments.len()), (6, 7));
        let interfaces: Vec<_> =
            pslg.segments.iter().filter(|s| s.left != Side::Outside && s.right != Side::Outside).collect();
        assert_eq!(interfaces.len(), 1);
        assert_eq!((interfaces[0].left, interfaces[0].right), (Side::Region(1), Side::Region(2)));
        assert_eq!(interfaces[0].label, 11);
        assert_eq!(pslg.describe(4), "feature 2, polygon 1, ring 1, position 2 (2, 1)");
    }

    #[test]
    fn minus_zero_is_zero() {
        let mut left = square(-1.0, 1);
        left.rings[0].points[1] = Point::new(0.0, -0.0);
        assert_eq!(domain(vec![left, square(-0.0, 2)]).unwrap().points.len(), 6);
    }

    #[test]
    fn thin_rings_are_oriented_exactly() {
        let thin = ring(&[(0.1, 0.1), (0.3, 0.3), (0.7, 0.7), (0.5, 0.500_000_000_000_000_1)], 1);
        let mut backwards = thin.points.clone();
        backwards.reverse();
        assert_eq!(is_counter_clockwise(&thin.points), Some(true));
        assert_eq!(is_counter_clockwise(&backwards), Some(false));
    }

    #[test]
    fn bad_rings_are_refused_with_their_place() {
        let polygon = |points: &[_]| vec![Polygon { rings: vec![ring(points, 1)], ..square(0.0, 1) }];
        for (polygons, expected) in [
            (
                vec![square(0.0, 1), square(0.0, 2)],
                "overlapping polygons: regions 1 and 2 on the same side of a segment at feature 1, polygon 1, ring 1, position 1 (0, 0) - feature 1, polygon 1, ring 1, position 2 (1, 0)",
            ),
            (polygon(&[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)]), "a ring without area at ring 1, position 1 (0, 0)"),
            (
                polygon(&[(0.0, 0.0), (1.0, 0.0), (3.0, 0.0), (1.0, 0.0), (1.0, 1.0)]),
                "a ring runs over a segment twice at ring 1, position 3 (3, 0) - ring 1, position 2 (1, 0)",
            ),
            (vec![], "no polygon"),
        ] {
            let error = domain(polygons).unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
