//! Scenes of meshes and of surfaces.

use super::super::svg::{Shade, spread};
use super::{Fill, Scene, SceneTriangle, Stroke};
use voronaut::geometry::Point3;
use voronaut::mesh::Mesh;
use voronaut::quality::Edges;
use voronaut::surface::Surface;

impl Scene {
    /// The triangles of a mesh, flat, with all edges; its border and its labelled edges are stronger. Triangles with
    /// vertices that do not exist are left out.
    pub fn of_mesh(mesh: &Mesh, shade: Shade) -> Self {
        let exists = |v: &u32| (*v as usize) < mesh.points.len();
        let labels = mesh.triangle_labels.iter().copied().chain(std::iter::repeat(0));
        let (used, labels): (Vec<[u32; 3]>, Vec<i32>) =
            mesh.triangles.iter().copied().zip(labels).filter(|(triangle, _)| triangle.iter().all(exists)).unzip();
        let at = |v: u32| Point3::from(mesh.points[v as usize]);
        let corners: Vec<[Point3; 3]> = used.iter().map(|triangle| triangle.map(at)).collect();
        let fills = fills(&corners, &labels, shade);
        let triangles =
            corners.iter().zip(fills).map(|(&corners, fill)| SceneTriangle { corners, normals: None, fill });
        let edges = Edges::of(&used);
        let (inner, mut border): (Vec<_>, Vec<_>) = edges.iter().partition(|(_, half_edges)| half_edges.len() > 1);
        border.extend(mesh.edges.iter().filter(|[a, b]| edges.contains(*a, *b)).map(|&ends| (ends, [].as_slice())));
        let line = |(ends, _): ([u32; 2], &[(u64, u32)])| ends.map(at).to_vec();
        Self { triangles: triangles.collect(), lines: Vec::new() }
            .with(inner.into_iter().map(line), Stroke::Edge)
            .with(border.into_iter().map(line), Stroke::Border)
    }

    /// A surface without a mesh: plain and smooth, with its borders and fixed edges.
    pub fn of_surface(surface: &Surface) -> Self {
        let topology = surface.topology();
        let triangle = |f| {
            let flat = surface.normal(f);
            let normals = topology.corners(f).map(|v| surface.vertex_normal(v).unwrap_or(flat));
            SceneTriangle { corners: surface.triangle(f), normals: Some(normals), fill: Fill::Plain }
        };
        let is_line = |h: &_| topology.twin(*h).is_none() || topology.is_fixed(*h);
        let line = |h| vec![surface.position(topology.origin(h)), surface.position(topology.target(h))];
        let lines: Vec<Vec<Point3>> = topology.edges().filter(is_line).map(line).collect();
        Self { triangles: topology.faces().map(triangle).collect(), lines: Vec::new() }.with(lines, Stroke::Border)
    }
}

/// The fill of each triangle, by its Euclidean size (and its region) or its Euclidean shape.
fn fills(corners: &[[Point3; 3]], labels: &[i32], shade: Shade) -> Vec<Fill> {
    if shade == Shade::Quality {
        return corners.iter().map(|&corners| Fill::Quality(shape(corners))).collect();
    }
    let mut regions = labels.to_vec();
    regions.sort_unstable();
    regions.dedup();
    let sizes: Vec<f64> = corners.iter().map(|&corners| double_area(corners).ln()).collect();
    let [low, high] = spread(&sizes);
    let fill = |(label, size): (&i32, &f64)| Fill::Level {
        region: regions.binary_search(label).unwrap_or(0),
        share: ((high - size) / (high - low)).clamp(0.0, 1.0),
    };
    labels.iter().zip(&sizes).map(fill).collect()
}

fn double_area([a, b, c]: [Point3; 3]) -> f64 {
    (b - a).cross(c - a).norm()
}

/// Euclidean 4 sqrt 3 A / (sum of squared sides).
fn shape([a, b, c]: [Point3; 3]) -> f64 {
    let squares: f64 = [b - a, c - b, a - c].iter().map(|side| side.dot(*side)).sum();
    if squares > 0.0 { 2.0 * 3.0_f64.sqrt() * double_area([a, b, c]) / squares } else { 0.0 }
}
