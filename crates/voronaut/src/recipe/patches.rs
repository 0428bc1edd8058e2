//! Patches of a cut surface put together again: one mesh, with the features that it keeps.

use crate::geometry::Point3;
use crate::lists::in_order;
use crate::manifold::{Manifold, Place};
use crate::mesh::Mesh;
use crate::sampling::{FeatureEdge, FeatureSeeds};
use crate::triangulation::VertexId;
use std::collections::{BTreeMap, BTreeSet};

/// The seeds of a cut surface: those on features, with a place on each side, and then those inside patches, with one each.
pub(super) struct Patched<'a> {
    pub(super) manifold: &'a Manifold,
    pub(super) features: &'a FeatureSeeds,
    /// Of the places on features, the seed that each belongs to.
    pub(super) owners: &'a [u32],
}

impl Patched<'_> {
    /// The vertex of the mesh that a place is.
    pub(super) fn vertex(&self, place: u32) -> u32 {
        let inside = || place - self.owners.len() as u32 + self.features.seeds.len() as u32;
        self.owners.get(place as usize).copied().unwrap_or_else(inside)
    }

    /// One mesh of the triangles of all patches, with features, labels and what is required.
    pub(super) fn mesh(&self, places: &[Place], triangles: &[[u32; 3]]) -> Mesh {
        let t = self.manifold.topology();
        let on_features = self.features.seeds.iter().map(|seed| seed.places[0].position);
        let inside = places[self.owners.len()..].iter().map(|place| place.position);
        let points: Vec<[f64; 3]> = on_features.chain(inside).map(Point3::to_array).collect();
        let point_label = |v: VertexId| self.manifold.point_labels()[v.index()];
        let mut point_labels: Vec<i32> =
            self.features.seeds.iter().map(|seed| seed.stop.map_or(0, point_label)).collect();
        point_labels.resize(points.len(), 0);
        let corners = |t: &[u32; 3]| t.map(|place| self.vertex(place));
        let mut mesh = Mesh {
            points,
            point_labels,
            triangle_labels: triangles.iter().map(|&[a, ..]| t.region(places[a as usize].face)).collect(),
            triangles: triangles.iter().map(corners).collect(),
            ..Mesh::default()
        };
        self.mark(&mut mesh);
        mesh
    }

    /// Edges of features, corners, and what is required.
    fn mark(&self, mesh: &mut Mesh) {
        let features = self.manifold.features();
        for &FeatureEdge { ends, mark, .. } in &self.features.edges {
            let i = mesh.edges.len() as u32;
            mesh.edges.push(ends);
            mesh.edge_labels.push(mark.label);
            mesh.ridges.extend(mark.is_ridge.then_some(i));
            mesh.required_edges.extend(mark.is_required.then_some(i));
        }
        let stops = (0..).zip(&self.features.seeds).filter_map(|(i, seed)| Some((seed.stop?, i)));
        let seed_at: BTreeMap<VertexId, u32> = stops.collect();
        let seeds = |list: &[VertexId]| list.iter().filter_map(|v| seed_at.get(v).copied()).collect();
        mesh.corners = seeds(&features.corners);
        mesh.required_points = seeds(self.manifold.required_points());
        let required: BTreeSet<[u32; 3]> = self.required_triangles(&seed_at).into_iter().collect();
        let is_required = |t: &[u32; 3]| !required.is_empty() && required.contains(&in_order(*t));
        mesh.required_triangles = (0..).zip(&mesh.triangles).filter(|(_, t)| is_required(t)).map(|(i, _)| i).collect();
    }

    fn required_triangles(&self, seed_at: &BTreeMap<VertexId, u32>) -> Vec<[u32; 3]> {
        let surface = self.manifold;
        let of = |&f| {
            let [a, b, c] =
                surface.topology().corners(f).map(|v| seed_at.get(&self.manifold.seams().original(v)).copied());
            Some(in_order([a?, b?, c?]))
        };
        surface.required_triangles().iter().filter_map(of).collect()
    }
}
