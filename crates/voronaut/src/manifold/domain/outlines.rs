//! From a graph back to what files hold: outlines (`.poly`, `.geojson`), and a mesh of nothing but its points.

use super::build::{check_entries, triangulate};
use super::polygons::is_counter_clockwise;
use super::sides::Areas;
use super::{Poly, PolyRegion, Polygon, Polygons, Pslg, Ring, Side};
use crate::error::Result;
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
            Side::Region(label) => poly.regions.push(PolyRegion { point, attribute: label.into(), max_area: None }),
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
    let mut polygons: Vec<Polygon> = Vec::new();
    let mut number_of = BTreeMap::new();
    let mut rings = outlined.rings(pslg);
    // Outer rings first: they are the counter-clockwise ones.
    rings.sort_by_key(|(_, ring)| is_counter_clockwise(&ring.points) != Some(true));
    for ((part, region), ring) in rings {
        let index = *number_of.entry(part).or_insert_with(|| {
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

    /// The borders of all connected parts of regions, each with the part on its left and its region, cut where they come back to a
    /// vertex.
    fn rings(&self, pslg: &Pslg) -> Vec<((u32, i32), Ring)> {
        let topology = &self.planar.topology;
        let (part_of, parts) = topology.parts(|h| !self.is_border(h));
        let mut rings = Vec::new();
        let mut used = vec![false; 3 * topology.face_slots()];
        for start in topology.faces().flat_map(FaceId::half_edges).filter(|&h| self.is_border(h)) {
            let part = part_of[start.face().index()];
            let Side::Region(region) = self.areas.of(parts[part as usize][0]) else { continue };
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
                    rings.push(((part, region), self.ring(pslg, &cut)));
                }
                place.insert(origin, walk.len());
                walk.push(h);
                h = self.next_on_border(h);
            }
            if !walk.is_empty() {
                rings.push(((part, region), self.ring(pslg, &walk)));
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
