//! A mesh on the bench: triangles that come and go, and which vertices are at one place. Sets of numbers.

use super::RepairOptions;
use super::mended::{Damage, Mended};
use crate::geometry::{Aabb3, Point3};
use crate::lists::{Classes, in_order};
use crate::manifold::surface::build;
use crate::mesh::{Edges, Mesh, edges_of};
use std::collections::HashMap;

/// A mesh in the course of repair.
pub(super) struct Work<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) options: RepairOptions,
    /// Corners by the vertex numbers of the mesh.
    pub(super) triangles: Vec<[u32; 3]>,
    /// The triangle of the mesh that each is, or is a part of.
    pub(super) sources: Vec<u32>,
    /// Vertices that are at one place.
    pub(super) places: Classes,
    /// Edges that were cut, by the places of their ends, and the vertices on them from the first end to the second.
    pub(super) cuts: HashMap<[u32; 2], Vec<u32>>,
    /// The diagonal of the bounding box of all triangles.
    pub(super) diagonal: f64,
    pub(super) mended: Mended,
}

impl<'a> Work<'a> {
    /// Everything as it is in the mesh.
    pub(super) fn new(mesh: &'a Mesh, options: RepairOptions) -> Self {
        let used = mesh.triangles.as_flattened().iter().map(|&v| mesh.position(v));
        let bounds = Aabb3::of(used.filter(|p| p.is_finite()));
        Self {
            mesh,
            options,
            triangles: mesh.triangles.clone(),
            sources: (0..mesh.triangles.len() as u32).collect(),
            places: Classes::new(mesh.points.len()),
            cuts: HashMap::new(),
            diagonal: bounds.map_or(0.0, |bounds| bounds.diagonal()),
            mended: Mended::default(),
        }
    }

    /// Where a vertex is: where the first of its place is.
    pub(super) fn position(&self, v: u32) -> Point3 {
        self.mesh.position(self.places.of(v))
    }

    /// The corners of a triangle.
    pub(super) fn corners(&self, t: usize) -> [Point3; 3] {
        self.triangles[t].map(|v| self.position(v))
    }

    /// The ends of side k of triangle t, at 3 t + k, in its direction: vertex numbers.
    pub(super) fn ends(&self, side: u32) -> [u32; 2] {
        edges_of(self.triangles[side as usize / 3])[side as usize % 3]
    }

    /// The places of a triangle's corners.
    pub(super) fn places_of(&self, t: usize) -> [u32; 3] {
        self.triangles[t].map(|v| self.places.of(v))
    }

    /// The edges of all triangles, by places.
    pub(super) fn edges(&self) -> Edges<'static> {
        Edges::of((0..self.triangles.len()).map(|t| self.places_of(t)).collect::<Vec<_>>())
    }

    /// A vertex, for messages.
    pub(super) fn vertex(&self, v: u32) -> String {
        build::vertex(v, self.mesh.position(v))
    }

    /// An edge, for messages.
    pub(super) fn edge(&self, [a, b]: [u32; 2]) -> String {
        format!("{} - {}", self.vertex(a), self.vertex(b))
    }

    /// The number of a triangle in the mesh, from 1.
    pub(super) fn number(&self, t: usize) -> u32 {
        self.sources[t] + 1
    }

    /// Counts a triangle as mended.
    pub(super) fn note_triangle(&mut self, kind: Damage, t: usize) {
        let place = format!("triangle {} at {}", self.number(t), self.vertex(self.triangles[t][0]));
        self.mended.add(kind, place);
    }

    /// Takes away the marked triangles, and counts them as mended.
    pub(super) fn drop_damaged(&mut self, kind: Damage, is_marked: &[bool]) {
        (0..is_marked.len()).filter(|&t| is_marked[t]).for_each(|t| self.note_triangle(kind, t));
        self.drop_marked(is_marked);
    }

    /// Takes away the marked triangles.
    pub(super) fn drop_marked(&mut self, is_marked: &[bool]) {
        let kept = || is_marked.iter().map(|marked| !marked);
        let mut keep = kept();
        self.triangles.retain(|_| keep.next().unwrap_or(true));
        let mut keep = kept();
        self.sources.retain(|_| keep.next().unwrap_or(true));
    }

    /// Cuts a triangle into a fan around the corner opposite to side k, at vertices on that side in their order.
    pub(super) fn cut(&mut self, t: usize, k: usize, inside: &[u32]) {
        let triangle = self.triangles[t];
        let [a, b, apex] = [0, 1, 2].map(|i| triangle[(k + i) % 3]);
        let chain: Vec<u32> = [a].iter().chain(inside).chain(&[b]).copied().collect();
        let (source, mut parts) = (self.sources[t], chain.windows(2).map(|ends| [ends[0], ends[1], apex]));
        self.triangles[t] = parts.next().unwrap_or(triangle);
        self.triangles.extend(parts);
        self.sources.resize(self.triangles.len(), source);
        let [p, q] = [a, b].map(|v| self.places.of(v));
        let mut ordered = inside.to_vec();
        if p > q {
            ordered.reverse();
        }
        self.cuts.entry(in_order([p, q])).or_insert(ordered);
    }
}
