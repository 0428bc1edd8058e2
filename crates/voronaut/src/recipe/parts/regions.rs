//! What is made anew around cuts: strips first, then what is around the ends at which they meet.

use super::stitch::Whole;
use crate::lists::{Classes, Rows, distinct, in_order};
use crate::mesh::{Edges, Mesh};

/// Layers of triangles on each side of a cut that are made anew.
const LAYERS: u32 = 8;
/// Strips end so many layers before the place where cuts meet,
const CORE: u32 = 12;
/// and so many layers around it are made anew after them: what strips have left, and as much beyond it as strips have at their sides.
const REACH: u32 = CORE + LAYERS;

/// Of vertices that are farther than anybody asks.
const FAR: u32 = u32::MAX;

impl Whole {
    /// Vertices at which the cuts between different parts meet.
    pub(super) fn meetings(&self) -> Vec<u32> {
        let pairs = self.pairs();
        let mut of_vertex: Vec<Option<[u32; 2]>> = vec![None; self.mesh.points.len()];
        let mut meetings = Vec::new();
        for (ends, &pair) in self.cuts.iter().zip(&pairs) {
            for &v in ends {
                match of_vertex[v as usize] {
                    Some(other) if other != pair => meetings.push(v),
                    _ => of_vertex[v as usize] = Some(pair),
                }
            }
        }
        distinct(meetings)
    }

    /// The parts on both sides of each cut.
    fn pairs(&self) -> Vec<[u32; 2]> {
        let edges = Edges::of(&self.mesh.triangles);
        let owner = |ends: [u32; 2], side: usize| {
            let sides = edges.at(ends);
            self.owners[sides[side.min(sides.len() - 1)].triangle()]
        };
        self.cuts.iter().map(|&ends| in_order([owner(ends, 0), owner(ends, 1)])).collect()
    }

    /// The triangles around the cuts between each two parts.
    pub(super) fn strips(&self) -> Vec<Vec<u32>> {
        let pairs = self.pairs();
        let all = distinct(pairs.iter().copied());
        let mut near = Layers::new(&self.mesh);
        for (ends, pair) in self.cuts.iter().zip(&pairs) {
            let label = all.binary_search(pair).unwrap_or_else(|at| at) as u32;
            for &v in ends {
                near.begin(v, label);
            }
        }
        near.spread(&self.mesh, LAYERS);
        let mut core = Layers::new(&self.mesh);
        self.junctions.iter().for_each(|&v| core.begin(v, 0));
        core.spread(&self.mesh, CORE);
        let label = |corners: &[u32; 3]| {
            let is_in = corners.iter().all(|&v| near.depth[v as usize] != FAR && core.depth[v as usize] == FAR);
            let nearest = corners.iter().map(|&v| (near.depth[v as usize], near.label[v as usize])).min();
            nearest.filter(|_| is_in).map(|(_, label)| label)
        };
        self.grouped(all.len(), label)
    }

    /// The triangles around the places where cuts meet; what overlaps is one.
    pub(super) fn junctions(&self) -> Vec<Vec<u32>> {
        let mut near = Layers::new(&self.mesh);
        self.junctions.iter().for_each(|&v| near.begin(v, 0));
        near.spread(&self.mesh, REACH);
        let is_in = |corners: &[u32; 3]| corners.iter().all(|&v| near.depth[v as usize] != FAR);
        let mut classes = Classes::new(self.mesh.points.len());
        for corners in self.mesh.triangles.iter().filter(|corners| is_in(corners)) {
            classes.join(corners[0], corners[1]);
            classes.join(corners[0], corners[2]);
        }
        let places = distinct(self.junctions.iter().map(|&v| classes.of(v)));
        let label = |corners: &[u32; 3]| {
            let place = is_in(corners).then(|| classes.of(corners[0]))?;
            places.binary_search(&place).ok().map(|label| label as u32)
        };
        self.grouped(places.len(), label)
    }

    /// Triangles by their labels; labels that no triangle has are left out.
    fn grouped(&self, labels: usize, label: impl Fn(&[u32; 3]) -> Option<u32>) -> Vec<Vec<u32>> {
        let labelled: Vec<(u32, u32)> =
            (0..).zip(&self.mesh.triangles).filter_map(|(t, corners)| Some((label(corners)?, t))).collect();
        let rows = Rows::new(labels, labelled.iter().copied());
        (0..labels).map(|label| rows.row(label).to_vec()).filter(|triangles| !triangles.is_empty()).collect()
    }
}

/// How many edges vertices are from where it began, and the label of the nearest beginning; of several the least.
struct Layers {
    depth: Vec<u32>,
    label: Vec<u32>,
}

impl Layers {
    fn new(mesh: &Mesh) -> Self {
        Self { depth: vec![FAR; mesh.points.len()], label: vec![FAR; mesh.points.len()] }
    }

    fn begin(&mut self, vertex: u32, label: u32) {
        self.depth[vertex as usize] = 0;
        self.label[vertex as usize] = self.label[vertex as usize].min(label);
    }

    fn spread(&mut self, mesh: &Mesh, layers: u32) {
        for layer in 0..layers {
            for corners in &mesh.triangles {
                let least = |least: u32, &v: &u32| {
                    if self.depth[v as usize] == layer { least.min(self.label[v as usize]) } else { least }
                };
                let label = corners.iter().fold(FAR, least);
                for to in corners.iter().map(|&v| v as usize).filter(|_| label != FAR) {
                    if self.depth[to] > layer {
                        self.depth[to] = layer + 1;
                        self.label[to] = self.label[to].min(label);
                    }
                }
            }
        }
    }
}
