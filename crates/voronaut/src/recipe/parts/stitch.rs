//! Meshes of parts as one: vertices on curves are those at the same position.

use super::Part;
use super::partition::{CUT, corner_mesh, submesh};
use crate::domain::{Domain, from_mesh};
use crate::error::Result;
use crate::geometry::Point;
use crate::lists::{distinct, in_order, marked};
use crate::mesh::{EdgeSide, Edges, Mesh};
use crate::recipe::remesh_input::{Position, position_of};
use std::collections::{HashMap, HashSet};

/// The mesh in the making.
pub(super) struct Whole {
    domain: Domain,
    pub(super) mesh: Mesh,
    /// Edges between parts that are none of the domain's.
    pub(super) cuts: Vec<[u32; 2]>,
    /// The part of each triangle.
    pub(super) owners: Vec<u32>,
    /// Vertices where cuts meet.
    pub(super) junctions: Vec<u32>,
}

impl Whole {
    /// The meshes of all parts of a domain, joined.
    pub(super) fn of_parts(domain: Domain, parts: &[Mesh]) -> Self {
        let mut joiner = Joiner::default();
        (0..).zip(parts).for_each(|(owner, part)| joiner.add(part, owner));
        let Joiner { mesh, owners, mut cuts, .. } = joiner;
        cuts.sort_unstable();
        cuts.dedup();
        let mut whole = Self { domain, mesh, cuts, owners, junctions: Vec::new() };
        whole.mark_required();
        whole.junctions = whole.meetings();
        whole
    }

    /// The jobs of regions: their outer edges stay.
    ///
    /// # Errors
    /// None that a valid mesh could cause.
    pub(super) fn jobs(&self, regions: &[Vec<u32>]) -> Result<Vec<Part>> {
        let edges = Edges::of(&self.mesh.triangles);
        let region = self.region_of(regions);
        let is_rim = |sides: &[EdgeSide]| matches!(sides, [s, t] if region[s.triangle()] != region[t.triangle()]);
        let rim: Vec<[u32; 2]> = edges.iter().filter(|sides| is_rim(sides)).map(|sides| sides[0].ends).collect();
        let job = |triangles: &Vec<u32>| {
            let part = submesh(&self.mesh, triangles, &rim);
            let vertices = part.points.len();
            Ok(Part { domain: corner_mesh(&Domain::new(&from_mesh(&part)?)?), vertices })
        };
        regions.iter().map(job).collect()
    }

    /// The region of each triangle; `u32::MAX` of those in none.
    fn region_of(&self, regions: &[Vec<u32>]) -> Vec<u32> {
        let mut region = vec![u32::MAX; self.mesh.triangles.len()];
        for (number, triangles) in (0..).zip(regions) {
            for &t in triangles {
                region[t as usize] = number;
            }
        }
        region
    }

    /// Puts meshes in the place of regions.
    pub(super) fn replace(&mut self, regions: &[Vec<u32>], meshes: &[Mesh]) {
        let goes = marked(self.mesh.triangles.len(), regions.iter().flatten().copied());
        let (mut joiner, number) = self.without(&goes);
        self.junctions.iter_mut().for_each(|v| *v = number[*v as usize]);
        for (region, mesh) in regions.iter().zip(meshes) {
            joiner.add(mesh, self.owners[region[0] as usize]);
        }
        (self.mesh, self.owners, self.cuts) = (joiner.mesh, joiner.owners, Vec::new());
        self.mark_required();
    }

    /// What stays, to be joined with what comes; and the new numbers of vertices.
    fn without(&self, goes: &[bool]) -> (Joiner, Vec<u32>) {
        let old = &self.mesh;
        let staying = || (0..old.triangles.len()).filter(|&t| !goes[t]);
        let stays = marked(old.points.len(), staying().flat_map(|t| old.triangles[t]));
        let going = (0..old.triangles.len()).filter(|&t| goes[t]).flat_map(|t| old.triangles[t]);
        let is_near = marked(old.points.len(), going);
        let mut joiner = Joiner::default();
        let mut number = vec![u32::MAX; old.points.len()];
        for v in (0..old.points.len()).filter(|&v| stays[v]) {
            number[v] = joiner.push(old, v);
            if is_near[v] {
                joiner.at.insert(position_of(old.point(v as u32)), number[v]);
            }
        }
        for t in staying() {
            joiner.mesh.triangles.push(old.triangles[t].map(|v| number[v as usize]));
            joiner.mesh.triangle_labels.push(old.triangle_labels[t]);
            joiner.owners.push(self.owners[t]);
        }
        let edges = Edges::of(&old.triangles);
        let is_kept = |ends: [u32; 2]| edges.at(ends).iter().any(|side| !goes[side.triangle()]);
        for (&ends, &label) in old.edges.iter().zip(&old.edge_labels).filter(|(ends, _)| is_kept(**ends)) {
            joiner.list(ends.map(|v| number[v as usize]), label);
        }
        let numbers = |list: &[u32]| list.iter().map(|&v| number[v as usize]).filter(|&v| v != u32::MAX).collect();
        (joiner.mesh.corners, joiner.mesh.required_points) = (numbers(&old.corners), numbers(&old.required_points));
        (joiner, number)
    }

    /// Corners and required edges are those of the domain, not those that parts had to keep.
    fn mark_required(&mut self) {
        let graph = self.domain.pslg();
        let place = |v: u32| position_of(graph.points[v as usize]);
        let corners: HashSet<Position> = (0..graph.points.len() as u32).map(place).collect();
        let points: HashSet<Position> = graph.required_points.iter().map(|&v| place(v)).collect();
        let required = graph.segments.iter().filter(|segment| segment.required);
        let required: HashSet<[Position; 2]> = required.map(|segment| in_order(segment.ends.map(place))).collect();
        let mesh = &mut self.mesh;
        let at = |v: u32, points: &[[f64; 3]]| position_of(Point::new(points[v as usize][0], points[v as usize][1]));
        for (list, kept) in [(&mut mesh.corners, &corners), (&mut mesh.required_points, &points)] {
            *list = distinct(list.iter().copied().filter(|&v| kept.contains(&at(v, &mesh.points))));
        }
        let is_required = |ends: [u32; 2]| required.contains(&in_order(ends.map(|v| at(v, &mesh.points))));
        mesh.required_edges = (0..).zip(&mesh.edges).filter(|(_, ends)| is_required(**ends)).map(|(i, _)| i).collect();
    }
}

/// Meshes are joined one after the other.
#[derive(Default)]
struct Joiner {
    mesh: Mesh,
    owners: Vec<u32>,
    cuts: Vec<[u32; 2]>,
    /// Vertices on curves.
    at: HashMap<Position, u32>,
    listed: HashSet<[u32; 2]>,
}

impl Joiner {
    fn add(&mut self, part: &Mesh, owner: u32) {
        let is_shared = marked(part.points.len(), part.edges.as_flattened().iter().copied());
        let number: Vec<u32> = (0..part.points.len())
            .map(|v| {
                if !is_shared[v] {
                    return self.push(part, v);
                }
                let place = position_of(part.point(v as u32));
                if let Some(&known) = self.at.get(&place) {
                    return known;
                }
                let new = self.push(part, v);
                self.at.insert(place, new);
                new
            })
            .collect();
        let at = |v: u32| number[v as usize];
        self.mesh.triangles.extend(part.triangles.iter().map(|t| t.map(at)));
        self.mesh.triangle_labels.extend(&part.triangle_labels);
        self.owners.extend(std::iter::repeat_n(owner, part.triangles.len()));
        self.mesh.corners.extend(part.corners.iter().copied().map(at));
        self.mesh.required_points.extend(part.required_points.iter().copied().map(at));
        for (ends, &label) in part.edges.iter().zip(&part.edge_labels) {
            self.list(ends.map(at), label);
        }
    }

    fn push(&mut self, part: &Mesh, v: usize) -> u32 {
        self.mesh.points.push(part.points[v]);
        self.mesh.point_labels.push(part.point_labels[v]);
        self.mesh.points.len() as u32 - 1
    }

    /// An edge on a curve, which several parts may have.
    fn list(&mut self, ends: [u32; 2], label: i32) {
        if label == CUT {
            self.cuts.push(in_order(ends));
        } else if self.listed.insert(in_order(ends)) {
            self.mesh.edges.push(ends);
            self.mesh.edge_labels.push(label);
        }
    }
}
