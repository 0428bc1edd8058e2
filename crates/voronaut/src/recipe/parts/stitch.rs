//! Meshes of parts as one: vertices on curves are those at the same position.

use super::bisect::{NOWHERE, join_around};
use super::region::{CUT, submesh};
use super::{Divisible, Part};
use crate::error::{Error, Result};
use crate::lists::{Rows, distinct, in_order, marked};
use crate::mesh::{EdgeSide, Edges, Mesh};
use std::collections::{HashMap, HashSet};

/// What is made anew gets so many vertices more or less at most, as a share.
const MOST_MORE: f64 = 0.1;

/// Where a vertex is, to the bit.
pub(super) type Position = [u64; 3];

pub(super) fn position_of(p: [f64; 3]) -> Position {
    p.map(f64::to_bits)
}

/// What is required of the whole, where parts have to keep more.
#[derive(Default)]
pub(super) struct Kept {
    pub(super) corners: HashSet<Position>,
    pub(super) points: HashSet<Position>,
    pub(super) edges: HashSet<[Position; 2]>,
    pub(super) ridges: HashSet<[Position; 2]>,
}

/// The mesh in the making.
pub(super) struct Whole {
    kept: Kept,
    pub(super) mesh: Mesh,
    /// Edges between parts that are none of the domain's.
    pub(super) cuts: Vec<[u32; 2]>,
    /// The part of each triangle.
    pub(super) owners: Vec<u32>,
    /// Vertices where cuts meet.
    pub(super) junctions: Vec<u32>,
}

impl Whole {
    /// The meshes of all parts, joined.
    pub(super) fn of_parts(on: &impl Divisible, mut kept: Kept, joiner: Joiner) -> Self {
        on.note_kept(&mut kept, &joiner.mesh);
        let mut whole =
            Self { kept, mesh: Mesh::default(), cuts: Vec::new(), owners: Vec::new(), junctions: Vec::new() };
        whole.close(joiner);
        whole.cuts = distinct(std::mem::take(&mut whole.cuts));
        whole.junctions = whole.meetings();
        whole
    }

    /// The jobs of regions: their outer edges stay. Together they have as many vertices more as the whole lacks, as far as that is no more
    /// than a tenth of each.
    ///
    /// # Errors
    /// None that a valid mesh could cause.
    pub(super) fn jobs(&self, on: &impl Divisible, regions: &[Vec<u32>], vertices: usize) -> Result<Vec<Part>> {
        let edges = Edges::of(&self.mesh.triangles);
        let region = self.region_of(regions);
        let is_rim = |sides: &[EdgeSide]| matches!(sides, [s, t] if region[s.triangle()] != region[t.triangle()]);
        let rim: Vec<[u32; 2]> = edges.iter().filter(|sides| is_rim(sides)).map(|sides| sides[0].ends).collect();
        let triangles = regions.iter().map(Vec::len).sum::<usize>().max(1);
        let more = (vertices as f64 - self.mesh.points.len() as f64) / triangles as f64;
        // A triangle comes with half a vertex.
        let more = more.clamp(-0.5 * MOST_MORE, 0.5 * MOST_MORE);
        let (mut sum, mut given) = (0.0, 0.0);
        let job = |triangles: &Vec<u32>| {
            let (mut part, on_rim) = submesh(&self.mesh, triangles, &rim);
            part.require(on_rim);
            sum += more * triangles.len() as f64;
            let vertices = part.points.len().saturating_add_signed((sum.round() - given) as isize);
            given = sum.round();
            Ok(Part::new(on, on.job(part)?, vertices))
        };
        regions.iter().map(job).collect()
    }

    /// Regions in which triangles hang together around each vertex: what does not is left out, or is another's.
    ///
    /// # Errors
    /// [`Error::Limit`] where none are found.
    pub(super) fn hanging_together(&self, regions: &[Vec<u32>]) -> Result<Vec<Vec<u32>>> {
        let mut region = self.region_of(regions);
        if !join_around(&self.mesh.triangles, &mut region) {
            return Err(Error::limit(
                "strips along cuts that touch themselves",
                "ask for fewer parts, or more vertices",
            ));
        }
        let labelled = (0..).zip(&region).filter(|(_, it)| **it != NOWHERE).map(|(t, &label): (u32, _)| (label, t));
        let rows = Rows::new(regions.len(), labelled);
        let all = (0..regions.len()).map(|label| rows.row(label).to_vec());
        Ok(all.filter(|triangles| !triangles.is_empty()).collect())
    }

    /// The region of each triangle, or [`NOWHERE`].
    fn region_of(&self, regions: &[Vec<u32>]) -> Vec<u32> {
        let mut region = vec![NOWHERE; self.mesh.triangles.len()];
        for (number, triangles) in (0..).zip(regions) {
            for &t in triangles {
                region[t as usize] = number;
            }
        }
        region
    }

    /// Takes regions out. What is in their place is to be added to what stays, region by region.
    pub(super) fn without(&mut self, regions: &[Vec<u32>]) -> Joiner {
        let (mut mesh, mut owners) = (std::mem::take(&mut self.mesh), std::mem::take(&mut self.owners));
        let coming: Vec<u32> = regions.iter().map(|region| owners[region[0] as usize]).collect();
        let goes = marked(mesh.triangles.len(), regions.iter().flatten().copied());
        let corners = |of_going: bool| {
            let all = mesh.triangles.iter().zip(&goes).filter(move |(_, goes)| **goes == of_going);
            all.flat_map(|(corners, _)| *corners)
        };
        let [stays, is_near] = [corners(false), corners(true)].map(|corners| marked(mesh.points.len(), corners));
        let edges = Edges::of(&mesh.triangles);
        let listed = mesh.edges.iter().map(|&ends| edges.at(ends).iter().any(|side| !goes[side.triangle()]));
        let is_listed: Vec<bool> = listed.collect();
        drop(edges);
        let number = numbers(&stays);
        let near = (0..number.len()).filter(|&v| stays[v] && is_near[v]);
        let at = near.map(|v| (position_of(mesh.points[v]), number[v])).collect();
        let triangle_stays: Vec<bool> = goes.iter().map(|goes| !goes).collect();
        renumber(&mut mesh.required_triangles, &numbers(&triangle_stays));
        keep(&mut mesh.points, &stays);
        keep(&mut mesh.point_labels, &stays);
        keep(&mut mesh.triangles, &triangle_stays);
        keep(&mut mesh.triangle_labels, &triangle_stays);
        keep(&mut owners, &triangle_stays);
        keep(&mut mesh.edges, &is_listed);
        keep(&mut mesh.edge_labels, &is_listed);
        let all = mesh.triangles.as_flattened_mut().iter_mut().chain(mesh.edges.as_flattened_mut());
        all.chain(&mut self.junctions).for_each(|v| *v = number[*v as usize]);
        renumber(&mut mesh.corners, &number);
        renumber(&mut mesh.required_points, &number);
        // Those of the whole are found again when all is there.
        (mesh.required_edges, mesh.ridges) = (Vec::new(), Vec::new());
        let listed = mesh.edges.iter().map(|&ends| in_order(ends)).collect();
        Joiner { mesh, owners, cuts: Vec::new(), at, listed, coming: coming.into_iter() }
    }

    /// Its mesh, and nothing else.
    pub(super) fn into_mesh(self) -> Mesh {
        self.mesh
    }

    /// Makes what was joined the whole.
    pub(super) fn close(&mut self, joiner: Joiner) {
        (self.mesh, self.owners, self.cuts) = (joiner.mesh, joiner.owners, joiner.cuts);
        self.mark_required();
    }

    /// What is required is what is of the whole, not what parts had to keep.
    fn mark_required(&mut self) {
        let (mesh, kept) = (&mut self.mesh, &self.kept);
        let points = std::mem::take(&mut mesh.points);
        let at = |v: u32| position_of(points[v as usize]);
        for (list, kept) in [(&mut mesh.corners, &kept.corners), (&mut mesh.required_points, &kept.points)] {
            *list = distinct(list.iter().copied().filter(|&v| kept.contains(&at(v))));
        }
        for (list, kept) in [(&mut mesh.required_edges, &kept.edges), (&mut mesh.ridges, &kept.ridges)] {
            let is_in = |ends: &[u32; 2]| kept.contains(&in_order(ends.map(at)));
            *list = (0..).zip(&mesh.edges).filter(|(_, ends)| is_in(ends)).map(|(i, _)| i).collect();
        }
        mesh.points = points;
    }
}

/// Those that are marked, in order.
fn keep<T>(list: &mut Vec<T>, marks: &[bool]) {
    let mut mark = marks.iter();
    list.retain(|_| mark.next() == Some(&true));
}

/// The new number of each that is marked; `u32::MAX` of others.
fn numbers(marks: &[bool]) -> Vec<u32> {
    let mut next = 0..;
    marks.iter().map(|&is_marked| if is_marked { next.next().unwrap_or(u32::MAX) } else { u32::MAX }).collect()
}

/// Gives things their new numbers; those that have none are left out.
fn renumber(list: &mut Vec<u32>, number: &[u32]) {
    for it in list.iter_mut() {
        *it = number[*it as usize];
    }
    list.retain(|&it| it != u32::MAX);
}

/// Meshes are joined one after the other.
#[derive(Default)]
pub(super) struct Joiner {
    mesh: Mesh,
    owners: Vec<u32>,
    cuts: Vec<[u32; 2]>,
    /// Vertices on curves.
    at: HashMap<Position, u32>,
    listed: HashSet<[u32; 2]>,
    /// Whose the meshes are that are still to come.
    coming: std::vec::IntoIter<u32>,
}

impl Joiner {
    /// Of nothing yet, for the meshes of so many parts in their order.
    pub(super) fn of_parts(parts: usize) -> Self {
        Self { coming: (0..parts as u32).collect::<Vec<_>>().into_iter(), ..Self::default() }
    }

    /// Joins the mesh that is next.
    pub(super) fn add(&mut self, part: &Mesh) {
        let owner = self.coming.next().unwrap_or(NOWHERE);
        let is_shared = marked(part.points.len(), part.edges.as_flattened().iter().copied());
        let number: Vec<u32> = (0..part.points.len())
            .map(|v| {
                if !is_shared[v] {
                    return self.push(part, v);
                }
                let place = position_of(part.points[v]);
                if let Some(&known) = self.at.get(&place) {
                    return known;
                }
                let new = self.push(part, v);
                self.at.insert(place, new);
                new
            })
            .collect();
        let at = |v: u32| number[v as usize];
        let before = self.mesh.triangles.len() as u32;
        self.mesh.required_triangles.extend(part.required_triangles.iter().map(|t| before + t));
        self.mesh.triangles.extend(part.triangles.iter().map(|t| t.map(at)));
        self.mesh.triangle_labels.extend(&part.triangle_labels);
        self.owners.extend(std::iter::repeat_n(owner, part.triangles.len()));
        self.mesh.corners.extend(part.corners.iter().copied().map(at));
        self.mesh.required_points.extend(part.required_points.iter().copied().map(at));
        let [required, ridges] =
            [&part.required_edges, &part.ridges].map(|list| marked(part.edges.len(), list.iter().copied()));
        for (i, (ends, &label)) in part.edges.iter().zip(&part.edge_labels).enumerate() {
            if let Some(new) = self.list(ends.map(at), label) {
                self.mesh.required_edges.extend(required[i].then_some(new));
                self.mesh.ridges.extend(ridges[i].then_some(new));
            }
        }
    }

    fn push(&mut self, part: &Mesh, v: usize) -> u32 {
        self.mesh.points.push(part.points[v]);
        self.mesh.point_labels.push(part.point_labels[v]);
        self.mesh.points.len() as u32 - 1
    }

    /// An edge on a curve, which several parts may have; its number if it is new.
    fn list(&mut self, ends: [u32; 2], label: i32) -> Option<u32> {
        if label == CUT {
            self.cuts.push(in_order(ends));
        } else if self.listed.insert(in_order(ends)) {
            self.mesh.edges.push(ends);
            self.mesh.edge_labels.push(label);
            return Some(self.mesh.edges.len() as u32 - 1);
        }
        None
    }
}
