//! Domains from meshes: the area of the triangles, or what the edges enclose.

use super::distinct::{check_points, listed, merge_segments};
use super::{Filling, Pslg, Segment, Side};
use crate::error::{Error, Result};
use crate::geometry::{Orientation, orientation};
use crate::lists::{in_order, marked};
use crate::mesh::{EdgeSide, Edges, Mesh, Network};

/// The domain of a planar mesh.
///
/// With triangles (oriented either way): their area, in regions by their labels; segments are the edges that the mesh
/// lists, then those of one triangle or between regions that it does not list (label 0). Without triangles: what the
/// edges enclose, alternating from outside in if two edges meet at every vertex, else all of it. Edges keep the
/// direction of the list. Kept are the vertices of segments, corners of edges and triangles, and all required
/// vertices; `names` has the numbers of the mesh if vertices were left out.
///
/// # Errors
///
/// [`Error::Unsupported`] of z other than 0. [`Error::Domain`] with the place of: neither edges nor triangles, two
/// vertices with the same coordinates, an edge without length, edges between the same vertices with different labels,
/// an edge with three triangles or two on the same side, an edge that is no triangle's, a triangle without area.
/// [`Error::Mesh`] of numbers beyond the lists they refer to.
pub fn from_mesh(mesh: &Mesh) -> Result<Pslg> {
    mesh.check_numbers()?;
    mesh.demand_straight()?;
    check_planar(mesh)?;
    let used = used_vertices(mesh);
    let in_use = (0..).zip(&used).filter(|&(_, &used)| used).map(|(vertex, _)| (vertex, mesh.point(vertex)));
    check_points(in_use, name)?;
    let segments = listed_segments(mesh)?;
    let (segments, filling) = if mesh.triangles.is_empty() {
        let filling = filling_of(&segments, mesh.points.len());
        (segments, filling)
    } else {
        (with_sides(mesh, segments)?, Filling::Sides)
    };
    if segments.is_empty() {
        let help = "give a mesh with triangles, or with the edges of the boundary";
        return Err(Error::domain("a mesh with neither edges nor triangles", "its sections Edges and Triangles", help));
    }
    Ok(compact(mesh, &used, segments, filling))
}

fn check_planar(mesh: &Mesh) -> Result<()> {
    let finite = |p: &[f64; 3]| p.iter().all(|x| x.is_finite());
    if let Some(vertex) = mesh.points.iter().position(|p| !finite(p)) {
        let place = format!("vertex {} {:?}", vertex + 1, mesh.points[vertex]);
        return Err(Error::domain("a coordinate is not finite", place, "remove or correct the vertex"));
    }
    let Some(vertex) = mesh.points.iter().position(|p| p[2] != 0.0) else { return Ok(()) };
    let what = format!("a surface as domain (vertex {} has z = {})", vertex + 1, mesh.points[vertex][2]);
    Err(Error::unsupported(what, "give a planar mesh: Dimension 2, or z = 0 at every vertex"))
}

/// Vertices of triangles and edges, and the required ones.
fn used_vertices(mesh: &Mesh) -> Vec<bool> {
    let elements = mesh.triangles.as_flattened().iter().chain(mesh.edges.as_flattened());
    marked(mesh.points.len(), elements.chain(&mesh.required_points).copied())
}

fn listed_segments(mesh: &Mesh) -> Result<Vec<Segment>> {
    let required = marked(mesh.edges.len(), mesh.required_edges.iter().copied());
    let segments =
        mesh.edges.iter().zip(required).enumerate().map(|(index, (&ends, required))| {
            listed(ends, mesh.edge_labels.get(index).copied().unwrap_or(0), required)
        });
    merge_segments(segments, "edge", 1, |vertex| mesh.describe(vertex as usize))
}

fn filling_of(segments: &[Segment], vertices: usize) -> Filling {
    let network = Network::new(vertices, segments.iter().map(|segment| segment.ends));
    if network.vertices().all(|v| network.at(v).len() == 2) {
        return Filling::EvenOdd;
    }
    Filling::Enclosed { holes: Vec::new(), regions: Vec::new() }
}

/// Gives listed segments the sides that the triangles tell, and adds the boundaries and interfaces not listed.
fn with_sides(mesh: &Mesh, mut segments: Vec<Segment>) -> Result<Vec<Segment>> {
    let edges = sides_of_edges(mesh)?;
    let mut is_listed = vec![false; edges.len()];
    for segment in &mut segments {
        let ends = in_order(segment.ends);
        let Ok(index) = edges.binary_search_by_key(&ends, |edge| edge.ends) else {
            let help = "remove the edge, or all triangles (then the edges alone are the domain)";
            return Err(edge_error(mesh, "an edge in the list is no edge of a triangle", segment.ends, help));
        };
        is_listed[index] = true;
        let edge = if ends == segment.ends { edges[index] } else { edges[index].turned() };
        (segment.left, segment.right) = (edge.left, edge.right);
    }
    let unlisted = edges.into_iter().zip(is_listed).filter(|(edge, is_listed)| !is_listed && edge.left != edge.right);
    // Boundaries run with the domain on their left.
    segments.extend(unlisted.map(|(edge, _)| if edge.left == Side::Outside { edge.turned() } else { edge }));
    Ok(segments)
}

/// All edges of the triangles without labels, from the smaller to the larger vertex, in the order of their ends.
fn sides_of_edges(mesh: &Mesh) -> Result<Vec<Segment>> {
    let turns = (0..).zip(&mesh.triangles).map(|(triangle, &corners)| is_counter_clockwise(mesh, triangle, corners));
    let turns = turns.collect::<Result<Vec<bool>>>()?;
    Edges::of(&mesh.triangles).iter().map(|group| sides_of_edge(mesh, &group, &turns)).collect()
}

/// The sides of an edge from the triangles at it, of which there may be one on each side.
fn sides_of_edge(mesh: &Mesh, group: &[EdgeSide], turns: &[bool]) -> Result<Segment> {
    let ends = group[0].ends;
    let mut found = Segment { left: Side::Outside, right: Side::Outside, ..listed(ends, 0, false) };
    for side in group {
        let is_left = turns[side.triangle()] == side.forward;
        let own = if is_left { &mut found.left } else { &mut found.right };
        *own = Side::Region(mesh.triangle_labels.get(side.triangle()).copied().unwrap_or(0));
    }
    let [first, last] = [0, group.len() - 1].map(|i| group[i].triangle() + 1);
    match group.len() {
        2 if [found.left, found.right].contains(&Side::Outside) => {
            let triangles = format!("triangles {first} and {last}");
            let what = format!("overlapping triangles: {triangles} lie on the same side of an edge");
            Err(edge_error(mesh, what, ends, "remove one of the triangles"))
        }
        1 | 2 => Ok(found),
        count => {
            let triangles = format!("{count} triangles (the first is {first}, the last {last})");
            let what = format!("a non-manifold edge of {triangles}");
            Err(edge_error(mesh, what, ends, "leave at most two triangles at each edge"))
        }
    }
}

fn is_counter_clockwise(mesh: &Mesh, triangle: u32, vertices: [u32; 3]) -> Result<bool> {
    let [a, b, c] = mesh.corners_of(vertices);
    match orientation(a, b, c) {
        Orientation::Left => Ok(true),
        Orientation::Right => Ok(false),
        Orientation::Collinear => {
            let place = vertices.map(|vertex| mesh.describe(vertex as usize)).join(", ");
            let what = format!("triangle {} has no area", u64::from(triangle) + 1);
            Err(Error::domain(what, place, "remove the triangle, or move its vertices apart"))
        }
    }
}

/// Leaves out the vertices that the domain does not need, and renumbers.
fn compact(mesh: &Mesh, used: &[bool], segments: Vec<Segment>, filling: Filling) -> Pslg {
    let all = 0..mesh.points.len() as u32;
    let corners = mesh.corners.iter().filter(|&&vertex| used[vertex as usize]);
    let required = marked(mesh.points.len(), corners.chain(&mesh.required_points).copied());
    let mut kept = required.clone();
    segments.iter().flat_map(|segment| segment.ends).for_each(|vertex| kept[vertex as usize] = true);
    let label = |vertex: u32| mesh.point_labels.get(vertex as usize).copied().unwrap_or(0);
    let graph = Pslg {
        points: all.clone().map(|vertex| mesh.point(vertex)).collect(),
        point_labels: all.clone().map(label).collect(),
        required_points: all.filter(|&vertex| required[vertex as usize]).collect(),
        segments,
        filling,
        ..Pslg::default()
    };
    graph.with_points(&kept)
}

fn edge_error(mesh: &Mesh, what: impl Into<String>, ends: [u32; 2], help: &str) -> Error {
    Error::domain(what, ends.map(|vertex| mesh.describe(vertex as usize)).join(" - "), help)
}

fn name(vertex: u32) -> String {
    format!("vertex {}", u64::from(vertex) + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two regions, 4 left and 5 right of x = 1, the first in two triangles: vertices 1 to 6 of a 2 x 1 rectangle
    /// from (0, 0), and an unused one before them.
    fn two_regions() -> Mesh {
        let corners = [(9.0, 9.0), (0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (0.0, 1.0)];
        Mesh {
            points: corners.map(|(x, y)| [x, y, 0.0]).to_vec(),
            point_labels: (0..7).collect(),
            triangles: vec![[1, 2, 5], [1, 6, 5], [2, 3, 4], [4, 2, 5]],
            triangle_labels: vec![4, 4, 5, 5],
            edges: vec![[2, 1], [1, 5]],
            edge_labels: vec![7, 8],
            corners: vec![0, 1],
            required_points: vec![3],
            required_edges: vec![1],
            ..Mesh::default()
        }
    }

    fn segment(pslg: &Pslg, ends: [u32; 2]) -> Segment {
        *pslg.segments.iter().find(|s| s.ends == ends).unwrap_or_else(|| panic!("{ends:?} in {pslg:?}"))
    }

    #[test]
    fn triangles_tell_regions() {
        let pslg = from_mesh(&two_regions()).unwrap();
        assert_eq!((pslg.points.len(), pslg.segments.len(), &pslg.filling), (6, 8, &Filling::Sides));
        let listed = segment(&pslg, [1, 0]);
        assert_eq!((listed.label, listed.left, listed.right), (7, Side::Outside, Side::Region(4)));
        let feature = segment(&pslg, [0, 4]);
        assert_eq!((feature.left, feature.right, feature.required), (Side::Region(4), Side::Region(4), true));
        let interface = segment(&pslg, [1, 4]);
        assert_eq!((interface.left, interface.right, interface.label), (Side::Region(4), Side::Region(5), 0));
        let right = segment(&pslg, [2, 3]);
        assert_eq!((right.left, right.right), (Side::Region(5), Side::Outside));
        assert_eq!(pslg.required_points, [0, 2]);
        assert_eq!((pslg.describe(0), pslg.point_labels[0]), ("vertex 2 (0, 0)".into(), 1));
    }

    #[test]
    fn interior_vertices_are_left_out() {
        let points = [(0.0, 0.0), (3.0, 0.0), (0.0, 3.0), (1.0, 1.0)].map(|(x, y)| [x, y, 0.0]).to_vec();
        let triangles = vec![[0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let pslg = from_mesh(&Mesh { points, triangles, ..Mesh::default() }).unwrap();
        assert_eq!((pslg.points.len(), pslg.segments.len()), (3, 3));
        assert!(pslg.segments.iter().all(|s| s.left == Side::Region(0) && s.right == Side::Outside));
    }

    #[test]
    fn edges_alone_enclose() {
        let boundary = vec![[1, 3], [3, 4], [4, 6], [6, 1], [1, 6]];
        let mut mesh = Mesh { triangles: vec![], edges: boundary, edge_labels: vec![1; 5], ..two_regions() };
        let pslg = from_mesh(&mesh).unwrap();
        assert_eq!((pslg.segments.len(), &pslg.filling), (4, &Filling::EvenOdd));
        assert!(pslg.segments.iter().all(|s| s.left == Side::Unknown));
        mesh.edges.push([1, 4]);
        assert_eq!(from_mesh(&mesh).unwrap().filling, Filling::Enclosed { holes: vec![], regions: vec![] });
    }

    fn message(change: impl Fn(&mut Mesh)) -> String {
        let mut mesh = two_regions();
        change(&mut mesh);
        let error = from_mesh(&mesh).unwrap_err();
        assert!(!error.help().is_empty(), "{error}");
        error.to_string()
    }

    #[test]
    fn bad_triangles_are_refused_with_their_place() {
        let three = message(|m| m.triangles.push([2, 5, 6]));
        assert!(
            three.contains(
                "a non-manifold edge of 3 triangles (the first is 1, the last 5) at vertex 3 (1, 0) - vertex 6 (1, 1)"
            ),
            "{three}"
        );
        let same = message(|m| m.triangles.push([1, 2, 4]));
        assert!(
            same.contains("triangles 1 and 5 lie on the same side of an edge at vertex 2 (0, 0) - vertex 3 (1, 0)"),
            "{same}"
        );
        let flat = message(|m| m.triangles.push([1, 2, 3]));
        assert!(flat.contains("triangle 5 has no area at vertex 2 (0, 0), vertex 3 (1, 0), vertex 4 (2, 0)"), "{flat}");
        let beyond = message(|m| m.triangles.push([1, 2, 70]));
        assert!(beyond.contains("vertex 70 (from 0) does not exist at a list of 7 vertices"), "{beyond}");
    }

    #[test]
    fn bad_vertices_and_edges_are_refused_with_their_place() {
        for (message, expected) in [
            (message(|m| m.points[5] = [-0.0, 1.0, 0.0]), "vertex 6 and vertex 7 have the same coordinates at (0, 1)"),
            (message(|m| m.points[3][2] = 0.5), "not supported: a surface as domain (vertex 4 has z = 0.5)"),
            (message(|m| m.points[3][1] = f64::NAN), "a coordinate is not finite at vertex 4 [2.0, NaN, 0.0]"),
            (
                message(|m| m.edges[0] = [2, 2]),
                "edge 1 has no length: both its ends are the same vertex at vertex 3 (1, 0)",
            ),
            (message(|m| m.edges[1] = [1, 2]), "edges 1 and 2 join the same vertices with different labels 7 and 8"),
            (
                message(|m| m.edges[1] = [1, 4]),
                "an edge in the list is no edge of a triangle at vertex 2 (0, 0) - vertex 5 (2, 1)",
            ),
            (
                message(|m| *m = Mesh { points: m.points.clone(), ..Mesh::default() }),
                "a mesh with neither edges nor triangles",
            ),
        ] {
            assert!(message.contains(expected), "{message}");
        }
    }
}
