//! Pictures of meshes and diagrams, of the plane and of surfaces, as far as they are asked for.

use crate::options::{Outputs, Show, refuse};
use voronaut::diagram::{Diagram, SurfaceDiagram};
use voronaut::geometry::{Aabb3, Point3};
use voronaut::manifold::Manifold;
use voronaut::mesh::{Edges, Mesh};
use voronaut::metric::MetricField;
use voronaut::net::Net;
use voronaut::quality::Unmet;
use voronaut::realisation::{Grid, Realisation};
use voronaut::triangulation::VertexId;
use voronaut::{Error, Result};
use voronaut_draw::{Layers, Picture, Protection, Scene, Stroke, View};

/// Pieces per side in which pictures show a Riemannian triangle.
const PIECES: usize = 4;
/// Points for each of the straight pieces of its lines, on a surface.
const POINTS: usize = 8;

/// What the picture shows of a diagram, and of the mesh with geodesic edges.
pub(crate) fn layers(
    outputs: &Outputs,
    diagram: &Diagram,
    field: &dyn MetricField,
    curved: Option<&Realisation>,
) -> Layers {
    if !outputs.need_diagram() {
        return Layers::default();
    }
    let witnesses = outputs.shows(Show::Witnesses).then(|| {
        let found = diagram.witnesses();
        [diagram.corners_of(&found.vertices), diagram.corners_of(&found.edges)]
    });
    let mut layers = Layers { cells: Some(diagram.to_cells()), witnesses, ..Layers::default() };
    if let Some(found) = curved.filter(|_| outputs.have_geodesics()) {
        layers.geodesics = found.edges.iter().map(|edge| edge.points.clone()).collect();
        if outputs.shows(Show::Triangles) {
            let grids = found.grids(field, PIECES);
            layers.grids = grids.iter().flatten().flat_map(Grid::lines).collect();
        }
    }
    layers
}

/// Triangles by the protection of a net, of which so much was asked for, if the picture shows that.
pub(crate) fn protection(outputs: &Outputs, net: Option<&Net>, asked: f64) -> Option<Protection> {
    net.filter(|_| outputs.shows(Show::Protection)).map(|net| Protection::new(net, asked))
}

/// A planar mesh, if there is to be a picture of it.
pub(crate) fn in_plane(
    outputs: &Outputs,
    mesh: &Mesh,
    metric: Option<&dyn MetricField>,
    layers: &Layers,
) -> Result<Option<String>> {
    let picture = Picture {
        mesh: [Show::Mesh, Show::Protection, Show::Unmet].into_iter().any(|show| outputs.shows(show)),
        ellipses: outputs.shows(Show::Ellipses),
        width: outputs.pixels,
        window: outputs.window,
    };
    outputs.picture.as_ref().map(|_| voronaut_draw::svg_with(mesh, metric, &picture, layers)).transpose()
}

/// The mesh of a surface, with its edges that are not of unit length if these are to be shown.
pub(crate) fn of_surface_mesh(outputs: &Outputs, mesh: &Mesh, unmet: &Unmet) -> Result<String> {
    let scene = Scene::of_mesh(mesh, Some(unmet).filter(|_| outputs.shows(Show::Unmet)));
    let Some(bounds) = Aabb3::of((0..mesh.points.len() as u32).map(|v| mesh.position(v))) else {
        return Err(Error::unsupported("a picture of a mesh without vertices", "leave out --picture"));
    };
    voronaut_draw::draw_surface(&scene, &View { pixels: outputs.pixels, ..View::of(bounds) })
}

/// Whether a picture on a surface needs a diagram.
pub(crate) fn need_diagram_on_surface(outputs: &Outputs) -> bool {
    outputs.shows(Show::Cells) || outputs.have_geodesics()
}

/// The mesh of a surface, the cells of its vertices, its edges as geodesics, its Riemannian triangles.
pub(crate) fn on_surface(
    outputs: &Outputs,
    diagram: &SurfaceDiagram,
    mesh: &Mesh,
    curved: Option<&Realisation<Point3>>,
) -> Result<String> {
    let is_of_canvas = need_diagram_on_surface(outputs);
    let mut scene =
        if is_of_canvas { coloured(diagram, outputs.shows(Show::Cells)) } else { Scene::of_mesh(mesh, None) };
    if let Some(found) = curved.filter(|_| outputs.have_geodesics()) {
        scene = scene.with(found.edges.iter().map(|edge| edge.points.clone()), Stroke::Geodesic);
        if outputs.shows(Show::Triangles) {
            let grids = found.grids_on_surface(diagram, PIECES);
            let input = diagram.canvas().draped().manifold();
            let lines = grids.iter().flatten().flat_map(Grid::lines).map(|line| along(input, &line));
            scene = scene.with(lines, Stroke::Level);
        }
    } else if outputs.shows(Show::Mesh) && is_of_canvas {
        let edges = Edges::of(&mesh.triangles);
        scene = scene.with(edges.ends().map(|ends| ends.map(|v| mesh.position(v)).to_vec()), Stroke::Edge);
    }
    let view = View { pixels: outputs.pixels, ..View::of(diagram.canvas().draped().manifold().bounds()) };
    voronaut_draw::draw_surface(&scene, &view)
}

/// A line with more points, all on the surface, so that none of it is hidden.
fn along(input: &Manifold, line: &[Point3]) -> Vec<Point3> {
    let between = |ends: &[Point3]| {
        let [p, q] = [ends[0], ends[1]];
        (0..POINTS).map(move |k| p.lerp(q, k as f64 / POINTS as f64))
    };
    let points = line.windows(2).flat_map(between).chain(line.last().copied());
    points.map(|p| input.closest(p).map_or(p, |place| place.position)).collect()
}

fn coloured(diagram: &SurfaceDiagram, are_cells: bool) -> Scene {
    let draped = diagram.canvas().draped();
    let vertices = || (0..diagram.vertex_count() as u32).map(VertexId);
    let positions: Vec<Point3> = vertices().map(|v| draped.position(v)).collect();
    let topology = draped.topology();
    let triangles: Vec<[u32; 3]> = topology.faces().map(|f| topology.corners(f).map(|v| v.0)).collect();
    let colours: Vec<Option<u32>> = vertices().map(|v| diagram.colour(v).filter(|_| are_cells)).collect();
    let orphans = if are_cells { diagram.orphan_components().concat() } else { Vec::new() };
    Scene::of_canvas(&positions, &triangles, &colours, &orphans)
}

/// Refuses what there is no picture of on surfaces, by name.
pub(crate) fn demand_of_surfaces(outputs: &Outputs) -> Result<()> {
    let is_shown =
        |show: &Show| matches!(show, Show::Mesh | Show::Cells | Show::Geodesics | Show::Triangles | Show::Unmet);
    let all = [
        (outputs.window.is_some(), "--window"),
        (!outputs.show.iter().all(is_shown), "--show of anything but mesh, cells, geodesics, triangles and unmet"),
        (outputs.shows(Show::Unmet) && need_diagram_on_surface(outputs), "--show unmet with cells or geodesics"),
    ];
    refuse(all.map(|(is_asked, what)| (is_asked, format!("{what} on a surface"), format!("leave out {what}"))))
}
