//! A surface cut open along its features into patches.
//!
//! Every patch then is a surface with a border, and what works on such surfaces (distances, diagrams, normals, curvatures)
//! knows nothing of what lies beyond a crease. Vertices on features have a copy in each patch, faces keep their numbers. What
//! is put onto a feature is put onto all of its sides, so that meshes of the patches fit together again.

use super::Surface;
use super::features::{Curve, FeatureGraph, FeatureOptions};
use crate::error::Result;
use crate::lists::marked;
use crate::triangulation::{FaceId, HalfEdge, VertexId};

/// Where a surface was cut open, or is open: its feature curves, and the copies of their vertices.
///
/// The vertices of curves are those of the surface before; one that now has copies has the same number as before in one patch.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seams {
    /// Feature curves and what has to be kept.
    pub features: FeatureGraph,
    whole: Whole,
    /// For each vertex before, its numbers now.
    copies: Vec<Vec<VertexId>>,
    /// For each vertex now, its number before.
    originals: Vec<VertexId>,
}

/// The topology of a surface before it was cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Whole {
    /// Vertices minus edges plus triangles.
    pub euler: isize,
    /// How many closed curves its border consists of.
    pub borders: usize,
}

impl Whole {
    fn of(surface: &Surface) -> Self {
        Self { euler: surface.euler_characteristic(), borders: surface.border_loops().len() }
    }
}

impl Seams {
    /// The borders of a surface that is not cut: they bend where they turn by 45 degrees.
    pub(crate) fn uncut(surface: &Surface) -> Self {
        let all = surface.curves(&FeatureOptions::default());
        let borders: Vec<Curve> = all.curves.into_iter().filter(Curve::is_border).collect();
        let on_border = |v: &VertexId| surface.topology().is_border_vertex(*v);
        let [stops, corners] = [all.stops, all.corners].map(|list| list.into_iter().filter(on_border).collect());
        let slots = (0..surface.positions().len() as u32).map(VertexId);
        Self {
            features: FeatureGraph { curves: borders, stops, corners },
            whole: Whole::of(surface),
            copies: slots.clone().map(|v| vec![v]).collect(),
            originals: slots.collect(),
        }
    }

    /// The numbers that a vertex of the surface before has now.
    pub(crate) fn copies(&self, v: VertexId) -> &[VertexId] {
        &self.copies[v.index()]
    }

    /// The topology of the surface before.
    pub(crate) fn whole(&self) -> Whole {
        self.whole
    }

    /// How many vertices there were before.
    pub(crate) fn vertices_before(&self) -> usize {
        self.copies.len()
    }

    /// The numbers that all vertices had before.
    pub(crate) fn originals(&self) -> Vec<u32> {
        self.originals.iter().map(|v| v.0).collect()
    }

    /// The number that a vertex had before.
    pub(crate) fn original(&self, v: VertexId) -> VertexId {
        self.originals[v.index()]
    }
}

/// A surface cut open along its features.
///
/// # Errors
/// As for [`Surface::new`]: none of a surface that was one, but for its size.
pub(crate) fn cut(surface: &Surface, options: &FeatureOptions) -> Result<(Surface, Seams)> {
    let features = surface.curves(options);
    let sides = features.curves.iter().flat_map(|curve| &curve.edges).flat_map(|edge| edge.sides).flatten();
    let is_cut = marked(3 * surface.topology().face_slots(), sides.map(|side| side.index() as u32));
    let mut mesh = surface.to_mesh();
    let before = mesh.points.len();
    let mut originals: Vec<VertexId> = (0..before as u32).map(VertexId).collect();
    let mut copies: Vec<Vec<VertexId>> = originals.iter().map(|&v| vec![v]).collect();
    let faces: Vec<FaceId> = surface.topology().faces().collect();
    for v in surface.topology().vertices() {
        for sector in sectors(surface, v, &is_cut).into_iter().skip(1) {
            let copy = VertexId(mesh.points.len() as u32);
            mesh.points.push(mesh.points[v.index()]);
            mesh.point_labels.push(mesh.point_labels[v.index()]);
            originals.push(v);
            copies[v.index()].push(copy);
            for h in sector {
                let row = faces.binary_search(&h.face()).expect("a face of the surface");
                mesh.triangles[row][h.index() % 3] = copy.0;
            }
        }
    }
    // FeatureGraph have the marks of edges, and tell which are where.
    (mesh.edges, mesh.edge_labels) = (Vec::new(), Vec::new());
    (mesh.ridges, mesh.required_edges) = (Vec::new(), Vec::new());
    Ok((Surface::new(&mesh)?, Seams { features, whole: Whole::of(surface), copies, originals }))
}

/// The half-edges that leave a vertex, by the sector between two cuts.
fn sectors(surface: &Surface, v: VertexId, is_cut: &[bool]) -> Vec<Vec<HalfEdge>> {
    let mut fan: Vec<HalfEdge> = surface.topology().star(v).collect();
    if let Some(first) = fan.iter().position(|h| is_cut[h.index()]) {
        fan.rotate_left(first);
    }
    let mut sectors: Vec<Vec<HalfEdge>> = Vec::new();
    for h in fan {
        match sectors.last_mut() {
            Some(sector) if !is_cut[h.index()] => sector.push(h),
            _ => sectors.push(vec![h]),
        }
    }
    sectors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::{sphere, torus};
    use crate::mesh::Mesh;

    #[test]
    fn a_cube_comes_apart_into_six_sides() {
        let points = (0..8).map(|i| [f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)]).collect();
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let cube = Surface::new(&Mesh { points, triangles, ..Mesh::default() }).unwrap();
        let (sides, seams) = cut(&cube, &FeatureOptions::default()).unwrap();
        assert_eq!((sides.positions().len(), sides.components().len()), (24, 6));
        for v in cube.topology().vertices() {
            assert_eq!(seams.copies(v).len(), 3);
            for &copy in seams.copies(v) {
                assert_eq!((seams.original(copy), sides.position(copy)), (v, cube.position(v)));
            }
        }
        for edge in seams.features.curves.iter().flat_map(|curve| &curve.edges) {
            let places = edge.places(&sides, 0.3);
            assert!(places.len() == 2 && places[0].position == places[1].position);
            for place in places {
                let on = sides.place(place.face, place.weights).position;
                assert!(on.distance(place.position) < 1e-15);
                assert!(edge.sides.iter().flatten().any(|h| h.face() == place.face));
            }
        }
    }

    #[test]
    fn surfaces_without_features_stay_whole() {
        for surface in [sphere(1.0, 0.3).unwrap(), torus(2.0, 0.7, 0.3).unwrap()] {
            let (same, seams) = cut(&surface, &FeatureOptions::default()).unwrap();
            assert_eq!(same.to_mesh(), surface.to_mesh());
            assert!(seams.features.curves.is_empty() && seams.features.stops.is_empty());
        }
    }

    #[test]
    fn a_crease_that_ends_is_a_slit() {
        // A flat sheet of 4 x 4 squares with two listed edges inside.
        let at = |i: u32, j: u32| 5 * j + i;
        let points = (0..25).map(|k| [f64::from(k % 5), f64::from(k / 5), 0.0]).collect();
        let squares = (0..4).flat_map(|j| (0..4).map(move |i| (i, j)));
        let triangles = squares
            .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]])
            .collect();
        let edges = vec![[at(1, 2), at(2, 2)], [at(3, 2), at(2, 2)]];
        let sheet = Surface::new(&Mesh { points, triangles, edges, ..Mesh::default() }).unwrap();
        let (slit, seams) = cut(&sheet, &FeatureOptions::default()).unwrap();
        let component = &slit.components()[0];
        assert_eq!((slit.positions().len(), component.borders, component.genus()), (26, 2, 0));
        let inner: Vec<&Curve> = seams.features.curves.iter().filter(|curve| !curve.is_border()).collect();
        assert_eq!((inner.len(), inner[0].edges.len()), (1, 2));
        assert_eq!(seams.features.corners.len(), 4 + 2);
    }
}
