//! The dual of seeds on a surface.

use super::dual::{SeedDual, account, compared, left_out};
use crate::diagram::SurfaceDiagram;
use crate::dual::Road;
use crate::geometry::Point3;
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::rdt::{OnSurface, Rdt};
use crate::surface::{Input, Place};

/// The dual of a diagram's seeds on a surface, by the road that is asked for; see [`super::dual()`].
pub fn surface_dual(diagram: &SurfaceDiagram, road: Road, progress: &dyn Progress) -> SeedDual {
    let start = progress.seconds();
    let nerve = diagram.sharp_nerve();
    let read = progress.seconds();
    let (glued, copies) = diagram.glued_nerve();
    let rdt = Rdt::from_glued(OnSurface::new(diagram), diagram.colours(), glued, &copies);
    let seconds = vec![("nerve", read - start), ("tests", progress.seconds() - read)];
    let triangles = match road {
        Road::Canvas => nerve.triangles.iter().map(|t| t.colours).collect(),
        Road::Geodesic => rdt.triangles(),
        Road::Both => rdt.triangles().into_iter().chain(left_out(&rdt, &nerve)).collect(),
    };
    let account = account(&rdt, &nerve, road);
    let exact = rdt.triangles();
    let raw_nerve = compared(diagram, &exact);
    SeedDual { triangles, nerve, exact, raw_nerve, account, seconds }
}

/// Triangles of seeds on a surface as a mesh: vertex i is seed i, with the region labels of the surface.
pub fn surface_mesh(input: &Input, places: &[Place], triangles: Vec<[u32; 3]>) -> Mesh {
    let topology = input.surface.topology();
    let label = |t: &[u32; 3]| {
        let corners = t.map(|v| places[v as usize].position);
        let middle = Point3::weighted(corners, [1.0 / 3.0; 3]);
        let place = input.lift(&places[t[0] as usize], middle).unwrap_or(places[t[0] as usize]);
        topology.region(place.face)
    };
    Mesh {
        points: places.iter().map(|place| place.position.to_array()).collect(),
        point_labels: vec![0; places.len()],
        triangle_labels: triangles.iter().map(label).collect(),
        triangles,
        ..Mesh::default()
    }
}
