//! From a graph back to what files hold: outlines (`.poly`, `.geojson`), and a mesh of nothing but its points.

use super::build::{check_entries, triangulate};
use super::sides::Areas;
use super::{Pslg, Side};
use crate::error::Result;
use crate::formats::geojson::{Polygon, Ring};
use crate::formats::poly::Region;
use crate::formats::{Poly, Polygons};
use crate::geometry::{Point, signed_area};
use crate::mesh::Mesh;
use crate::planar::Planar;
use crate::triangulation::{FaceId, HalfEdge};
use std::collections::{BTreeMap, HashMap};

/// The `.poly` file of a graph: all its points and segments with their labels, a point in each hole, a point and the label of each
/// region. What is required has no place there, but for points on no segment.
///
/// # Errors
/// As of [`Domain::new`](super::Domain::new).
pub fn to_poly(pslg: &Pslg) -> Result<Poly> {
    let outlined = Outlined::new(pslg)?;
    let mut poly = Poly {
        points: pslg.points.clone(),
        point_markers: pslg.point_labels.clone(),
        first: 1,
        segments: pslg.segments.iter().map(|segment| segment.ends).collect(),
        segment_markers: pslg.segments.iter().map(|segment| segment.label).collect(),
        ..Poly::default()
    };
    for (side, point) in outlined.areas.inner_points(&outlined.planar) {
        match side {
            Side::Region(label) => poly.regions.push(Region { point, attribute: label.into(), max_area: None }),
            Side::Outside | Side::Unknown => poly.holes.push(point),
        }
    }
    Ok(poly)
}

/// The polygons of a graph, one for each connected part of a region, with a label for each ring: that of most of its segments
/// on the boundary, or else between regions.
///
/// # Errors
/// As of [`Domain::new`](super::Domain::new).
pub fn to_polygons(pslg: &Pslg) -> Result<Polygons> {
    let outlined = Outlined::new(pslg)?;
    let parts = outlined.parts();
    let mut polygons: Vec<Polygon> = Vec::new();
    let mut number_of = BTreeMap::new();
    let mut rings: Vec<(u32, Ring)> = outlined.rings(pslg, &parts);
    // Outer rings first: they are the counter-clockwise ones.
    rings.sort_by_key(|(_, ring)| area(&ring.points) <= 0.0);
    for (part, ring) in rings {
        let index = *number_of.entry(part).or_insert_with(|| {
            let region = parts.regions[part as usize];
            polygons.push(Polygon { feature: polygons.len() + 1, number: 1, region, rings: Vec::new() });
            polygons.len() - 1
        });
        polygons[index].rings.push(ring);
    }
    Ok(Polygons { polygons })
}

/// A triangulation of a graph without further vertices: all its points, its segments as labelled edges, triangles with the labels of
/// their regions.
///
/// # Errors
/// As of [`Domain::new`](super::Domain::new).
pub fn to_mesh(pslg: &Pslg) -> Result<Mesh> {
    let outlined = Outlined::new(pslg)?;
    let topology = &outlined.planar.topology;
    let mut mesh = Mesh {
        points: pslg.points.iter().map(|p| [p.x, p.y, 0.0]).collect(),
        point_labels: pslg.point_labels.clone(),
        edges: pslg.segments.iter().map(|segment| segment.ends).collect(),
        edge_labels: pslg.segments.iter().map(|segment| segment.label).collect(),
        required_points: pslg.required_points.clone(),
        required_edges: (0..).zip(&pslg.segments).filter(|(_, segment)| segment.required).map(|(i, _)| i).collect(),
        ..Mesh::default()
    };
    for f in topology.faces() {
        if let Side::Region(label) = outlined.areas.of(f) {
            mesh.triangles.push(topology.corners(f).map(|v| v.0));
            mesh.triangle_labels.push(label);
        }
    }
    Ok(mesh)
}

/// The connected parts of regions.
struct Parts {
    /// Of each face slot, or [`NONE`].
    part_of: Vec<u32>,
    /// The label of each.
    regions: Vec<i32>,
}

const NONE: u32 = u32::MAX;

/// A triangulated graph, and what its areas are.
struct Outlined {
    planar: Planar,
    areas: Areas,
}

impl Outlined {
    fn new(pslg: &Pslg) -> Result<Self> {
        check_entries(pslg)?;
        let planar = triangulate(pslg)?;
        let areas = Areas::classify(pslg, &planar)?;
        Ok(Self { planar, areas })
    }

    /// Whether the two sides of an edge are not of one region.
    fn is_border(&self, h: HalfEdge) -> bool {
        self.planar.topology.twin(h).is_none_or(|t| self.areas.of(t.face()) != self.areas.of(h.face()))
    }

    /// The connected parts of regions.
    fn parts(&self) -> Parts {
        let topology = &self.planar.topology;
        let mut part_of = vec![NONE; topology.face_slots()];
        let mut regions = Vec::new();
        for seed in topology.faces() {
            let Side::Region(region) = self.areas.of(seed) else { continue };
            if part_of[seed.index()] != NONE {
                continue;
            }
            let part = regions.len() as u32;
            regions.push(region);
            part_of[seed.index()] = part;
            let mut stack = vec![seed];
            while let Some(f) = stack.pop() {
                let inner = f.half_edges().into_iter().filter(|&h| !self.is_border(h)).filter_map(|h| topology.twin(h));
                for g in inner.map(HalfEdge::face).collect::<Vec<_>>() {
                    if part_of[g.index()] == NONE {
                        part_of[g.index()] = part;
                        stack.push(g);
                    }
                }
            }
        }
        Parts { part_of, regions }
    }

    /// The borders of all parts, each with the part on its left, cut where they come back to a vertex.
    fn rings(&self, pslg: &Pslg, parts: &Parts) -> Vec<(u32, Ring)> {
        let topology = &self.planar.topology;
        let mut rings = Vec::new();
        let mut used = vec![false; 3 * topology.face_slots()];
        let all = topology.faces().filter(|f| parts.part_of[f.index()] != NONE).flat_map(FaceId::half_edges);
        for start in all.filter(|&h| self.is_border(h)) {
            let (mut walk, mut place) = (Vec::new(), HashMap::new());
            let mut h = start;
            while !used[h.index()] {
                used[h.index()] = true;
                let origin = topology.origin(h);
                if let Some(&seen) = place.get(&origin) {
                    let cut = walk.split_off(seen);
                    for &e in &cut {
                        place.remove(&topology.origin(e));
                    }
                    rings.push((parts.part_of[h.face().index()], self.ring(pslg, &cut)));
                }
                place.insert(origin, walk.len());
                walk.push(h);
                h = self.next_on_border(h);
            }
            if !walk.is_empty() {
                rings.push((parts.part_of[start.face().index()], self.ring(pslg, &walk)));
            }
        }
        rings
    }

    fn next_on_border(&self, h: HalfEdge) -> HalfEdge {
        let mut next = h.next();
        while !self.is_border(next) {
            next = self.planar.topology.twin(next).expect("an inner edge").next();
        }
        next
    }

    fn ring(&self, pslg: &Pslg, walk: &[HalfEdge]) -> Ring {
        let topology = &self.planar.topology;
        let is_outer = |h: HalfEdge| topology.twin(h).is_none_or(|t| self.areas.of(t.face()) == Side::Outside);
        let mut counts: BTreeMap<i32, [usize; 2]> = BTreeMap::new();
        for &h in walk {
            if let Some(constraint) = topology.constraint(h) {
                let count = counts.entry(pslg.segments[constraint.0 as usize].label).or_default();
                count[usize::from(!is_outer(h))] += 1;
            }
        }
        // Of as many the least.
        let most = counts.into_iter().rev().max_by_key(|&(_, count)| count);
        let label = most.map_or(0, |(label, _)| label);
        Ring { points: walk.iter().map(|&h| self.planar.ends(h)[0]).collect(), label }
    }
}

fn area(points: &[Point]) -> f64 {
    let pairs = points.iter().zip(points.iter().cycle().skip(1));
    pairs.map(|(&p, &q)| signed_area(points[0], p, q)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::{Domain, from_geojson, from_poly};
    use crate::formats::{geojson, poly};

    /// A square of region 4 with a hole, in which an island of region 5 lies; the left of the square is region 6.
    const TEXT: &str = "12 2 0 1\n1 0 0 7\n2 4 0 0\n3 4 4 0\n4 0 4 0\n5 2 1 0\n6 3 1 0\n7 3 3 0\n8 2 3 0\n9 2.4 1.4 0\n\
                        10 2.8 1.4 0\n11 2.6 2 0\n12 1 0 -2\n13 0\n";

    fn graph() -> Pslg {
        let points = TEXT.replace("12 2 0 1\n", "13 2 0 1\n").replace("13 0\n", "13 1 4 0\n");
        let segments = "15 1\n1 1 12 3\n2 12 2 3\n3 2 3 3\n4 3 13 3\n5 13 4 3\n6 4 1 8\n7 5 6 9\n8 6 7 9\n9 7 8 9\n10 8 5 9\n\
                        11 9 10 2\n12 10 11 2\n13 11 9 2\n14 12 13 1\n15 1 12 3\n1\n1 2.1 1.1\n3\n1 3.5 3.5 4\n2 2.6 1.5 5\n3 0.1 0.1 6\n";
        from_poly(&poly::read(format!("{points}{segments}").as_bytes(), "a.poly").unwrap()).unwrap()
    }

    fn areas(domain: &Domain) -> Vec<(i32, f64)> {
        let topology = &domain.planar().topology;
        [4, 5, 6]
            .map(|label| {
                let faces = topology.faces().filter(|&f| topology.region(f) == label);
                (label, faces.map(|f| domain.planar().triangle(f)).map(|[a, b, c]| signed_area(a, b, c)).sum())
            })
            .to_vec()
    }

    #[test]
    fn a_graph_survives_both_formats() {
        let pslg = graph();
        let truth = areas(&Domain::new(&pslg).unwrap());
        let found = to_poly(&pslg).unwrap();
        assert_eq!((found.holes.len(), found.regions.len()), (1, 3));
        let mut text = Vec::new();
        poly::write(&found, &mut text).unwrap();
        let again = from_poly(&poly::read(text.as_slice(), "b.poly").unwrap()).unwrap();
        assert_eq!(areas(&Domain::new(&again).unwrap()), truth);
        assert_eq!((&again.points, &again.point_labels), (&pslg.points, &pslg.point_labels));
        let labels = |pslg: &Pslg| pslg.segments.iter().map(|s| (s.ends, s.label)).collect::<Vec<_>>();
        assert_eq!(labels(&again), labels(&pslg));

        let found = to_polygons(&pslg).unwrap();
        let mut text = Vec::new();
        geojson::write(&found, &mut text).unwrap();
        let read = geojson::read(std::str::from_utf8(&text).unwrap(), "b.json").unwrap();
        assert_eq!(read, found);
        let rings: Vec<_> = read.polygons.iter().map(|p| (p.region, p.rings.len(), p.rings[0].label)).collect();
        assert_eq!(rings.len(), 3);
        assert!(rings.contains(&(4, 2, 3)) && rings.contains(&(5, 1, 2)), "{rings:?}");
        let domain = Domain::new(&from_geojson(&read).unwrap()).unwrap();
        for ((label, found), (_, truth)) in areas(&domain).into_iter().zip(truth) {
            assert!((found - truth).abs() < 1e-12, "{label}: {found} {truth}");
        }
    }

    #[test]
    fn a_hole_that_touches_the_outline_is_a_ring_of_its_own() {
        let text = "7 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 2 1\n6 3 2\n7 1 2\n8 0\n";
        let touching = text.replace("5 2 1", "5 2 0.5").replace("8 0\n", "");
        let segments = "7 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 1 6\n6 6 7\n7 7 1\n1\n1 1.3 1.5\n";
        let pslg = from_poly(&poly::read(format!("{touching}{segments}").as_bytes(), "a.poly").unwrap()).unwrap();
        let found = to_polygons(&pslg).unwrap();
        assert_eq!(found.polygons.len(), 1);
        assert_eq!(found.polygons[0].rings.iter().map(|ring| ring.points.len()).collect::<Vec<_>>(), [4, 3]);
    }
}
