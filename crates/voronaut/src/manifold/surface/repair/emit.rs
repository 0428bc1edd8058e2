//! The mesh that comes out, with all its lists renumbered.

use super::fans::Sewn;
use super::mended::Damage;
use super::work::Work;
use crate::lists::{distinct, in_order, marked};
use crate::mesh::edges::NONE;
use crate::mesh::{EdgeSide, Edges, Mesh, edges_of};
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};

/// The mesh of the triangles as sewn. Vertices keep their numbers, used or not, and those that were added follow; triangles and
/// edges keep their order and labels.
pub(super) fn emit(work: &mut Work, sewn: &Sewn) -> Mesh {
    let mesh = work.mesh;
    let label = |labels: &[i32], i: u32| labels.get(i as usize).copied().unwrap_or(0);
    let vertices = (0..mesh.points.len() as u32).chain(sewn.added.iter().map(|added| added.1));
    // What has no labels gets none.
    let vertices = vertices.filter(|_| !mesh.point_labels.is_empty());
    let triangles = sewn.sources.iter().filter(|_| !mesh.triangle_labels.is_empty());
    let edges = Listed::of(work, sewn);
    let copies = copies(work, sewn);
    let all_copies = |list: &[u32]| -> Vec<u32> {
        let of = |v: &u32| copies.get(v).cloned().unwrap_or_else(|| vec![*v]);
        list.iter().flat_map(of).collect()
    };
    let entries = |list: &[u32]| -> Vec<u32> { list.iter().flat_map(|&i| edges.entries[i as usize].clone()).collect() };
    let required = marked(mesh.triangles.len(), mesh.required_triangles.iter().copied());
    let is_of_file = |t: usize| sewn.numbers[t] != [NONE; 3];
    Mesh {
        points: points(work, sewn),
        point_labels: vertices.map(|v| label(&mesh.point_labels, v)).collect(),
        triangles: sewn.triangles.clone(),
        triangle_labels: triangles.map(|&t| label(&mesh.triangle_labels, t)).collect(),
        edge_labels: edges.sources.iter().map(|&i| label(&mesh.edge_labels, i)).collect(),
        corners: all_copies(&mesh.corners),
        required_points: all_copies(&mesh.required_points),
        ridges: entries(&mesh.ridges),
        required_edges: entries(&mesh.required_edges),
        required_triangles: (0..sewn.triangles.len())
            .filter(|&t| is_of_file(t) && required[sewn.sources[t] as usize])
            .map(|t| t as u32)
            .collect(),
        edges: edges.ends,
        periodic: Vec::new(),
        curved: None,
    }
}

/// Positions; vertices of no triangle that are not finite come to the origin, where nobody looks.
fn points(work: &Work, sewn: &Sewn) -> Vec<[f64; 3]> {
    let mut points = harmless(work.mesh);
    for &v in sewn.triangles.as_flattened() {
        if (v as usize) < work.mesh.points.len() {
            points[v as usize] = work.position(v).to_array();
        }
    }
    points.extend(sewn.added.iter().map(|added| added.0.to_array()));
    points
}

/// Positions, the origin for those that are not finite.
pub(super) fn harmless(mesh: &Mesh) -> Vec<[f64; 3]> {
    let finite = |p: &[f64; 3]| if p.iter().all(|x| x.is_finite()) { *p } else { [0.0; 3] };
    mesh.points.iter().map(finite).collect()
}

/// For each vertex number of the mesh the vertices that it has become, where these are not itself.
fn copies(work: &Work, sewn: &Sewn) -> HashMap<u32, Vec<u32>> {
    let corners = sewn.numbers.as_flattened().iter().zip(sewn.triangles.as_flattened());
    let pairs = distinct(corners.map(|(&number, &v)| (number, v)).filter(|p| p.0 != NONE));
    let mut copies: HashMap<u32, Vec<u32>> = HashMap::new();
    let mut at_place: HashMap<u32, u32> = HashMap::new();
    for (number, v) in pairs {
        copies.entry(number).or_default().push(v);
        at_place.entry(work.places.of(number)).or_insert(v);
    }
    // Vertices all of whose triangles are gone: what is at their place stands for them.
    for v in work.mesh.corners.iter().chain(&work.mesh.required_points) {
        if let Some(&there) = at_place.get(&work.places.of(*v)) {
            copies.entry(*v).or_insert_with(|| vec![there]);
        }
    }
    copies
}

/// The list of edges, renumbered.
struct Listed {
    ends: Vec<[u32; 2]>,
    /// The entry of the mesh's list that each comes from.
    sources: Vec<u32>,
    /// For each entry of the mesh's list the entries it has become.
    entries: Vec<Vec<u32>>,
}

impl Listed {
    fn of(work: &mut Work, sewn: &Sewn) -> Self {
        let mesh = work.mesh;
        let known = Known::of(work, sewn);
        let mut first: HashMap<[u32; 2], (u32, [u32; 2])> = HashMap::new();
        let mut edges = Self { ends: Vec::new(), sources: Vec::new(), entries: vec![Vec::new(); mesh.edges.len()] };
        for (i, &listed) in (0..).zip(&mesh.edges) {
            let mut found = known.find(work, listed);
            if found.is_empty() && known.of_file.at(listed).is_empty() && !work.options.repair {
                // Not lost by repair: the mistake is in the list, and is told as one.
                found.push(listed);
            }
            let before = edges.ends.len();
            for ends in found {
                let (sorted, numbers) = (in_order(ends), in_order(listed));
                // The same edge listed twice by number is a mistake in the list, unless labels agree.
                let twin = first.get(&sorted).filter(|twin| twin.1 != numbers || work.options.repair);
                if let Some(&(at, _)) = twin {
                    edges.entries[i as usize].push(at);
                    continue;
                }
                first.entry(sorted).or_insert((edges.ends.len() as u32, numbers));
                edges.entries[i as usize].push(edges.ends.len() as u32);
                edges.ends.push(ends);
                edges.sources.push(i);
            }
            if edges.ends.len() == before {
                let place = format!("edge {} of the list, {}", i + 1, work.edge(listed));
                work.mended.add(Damage::Listed, place);
            }
        }
        edges
    }
}

/// Sides of triangles, by which edges of the list are found again.
struct Known<'a> {
    sewn: &'a Sewn,
    /// Of the triangles as sewn, by the vertex numbers of the mesh,
    by_number: Edges<'a>,
    /// and by places.
    by_place: Edges<'a>,
    /// Of the mesh as it was.
    of_file: Edges<'a>,
}

impl<'a> Known<'a> {
    fn of(work: &Work<'a>, sewn: &'a Sewn) -> Self {
        let place = |v: u32| if v == NONE { NONE } else { work.places.of(v) };
        let places: Vec<[u32; 3]> = sewn.numbers.iter().map(|numbers| numbers.map(place)).collect();
        // Most meshes list no edges.
        let all: [Cow<'a, [[u32; 3]]>; 3] = [(&sewn.numbers).into(), places.into(), (&work.mesh.triangles).into()];
        let edges = |list| Edges::of(if work.mesh.edges.is_empty() { Cow::default() } else { list });
        let [by_number, by_place, of_file] = all.map(edges);
        Self { sewn, by_number, by_place, of_file }
    }

    /// What sides have become, each once, in the direction that leaves `from`.
    fn ends(&self, sides: &[EdgeSide], from: u32) -> Vec<[u32; 2]> {
        let mut found = Vec::new();
        for side in sides {
            let [a, b] = edges_of(self.sewn.triangles[side.triangle()])[side.half_edge as usize % 3];
            let ends = if side.directed()[0] == from { [a, b] } else { [b, a] };
            if !found.contains(&ends) {
                found.push(ends);
            }
        }
        found
    }

    /// What an edge of the list has become, in its direction.
    fn find(&self, work: &Work, [v, w]: [u32; 2]) -> Vec<[u32; 2]> {
        let mut found = self.ends(&self.by_number.at([v, w]), v);
        if !found.is_empty() {
            return found;
        }
        let mut left = vec![[v, w].map(|v| work.places.of(v))];
        // Every cut is followed once: cuts of cuts that led back would never end.
        let mut is_followed = HashSet::new();
        while let Some([p, q]) = left.pop() {
            let (key, sides) = (in_order([p, q]), self.by_place.at([p, q]));
            found.extend(self.ends(&sides, p));
            if sides.is_empty()
                && let Some(inside) = work.cuts.get(&key).filter(|_| is_followed.insert(key))
            {
                let mut chain: Vec<u32> = [key[0]].iter().chain(inside).chain(&[key[1]]).copied().collect();
                if p > q {
                    chain.reverse();
                }
                left.extend(chain.windows(2).rev().map(|ends| [ends[0], ends[1]].map(|v| work.places.of(v))));
            }
        }
        found
    }
}
