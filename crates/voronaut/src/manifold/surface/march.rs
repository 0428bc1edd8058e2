//! A first mesh of a surface f = 0 by marching tetrahedra (Doi and Koide 1991), with grid vertices near the surface moved
//! onto it, as isosurface stuffing does (Labelle and Shewchuk 2007).

use super::implicit::{Pins, project_pinned};
use super::remesh::remesh;
use super::sheets::demand_one_sheet;
use super::tetrahedra::{Crossings, Grid};
use super::{Implicit, Surface};
use crate::error::{Error, Result};
use crate::geometry::{Aabb3, Point3};
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use std::collections::HashMap;

/// Grid steps along the longest side of the box unless an edge length is asked for.
const DEFAULT_STEPS: f64 = 64.0;

/// Edges of the mesh are about so long, in steps of the grid.
const EDGE: f64 = 0.9;

/// Crossings nearer to a grid vertex than this part of their edge become one vertex: that avoids slivers.
const NEAR: f64 = 0.3;

/// How near to f = 0 vertices are, in diagonals of the box: |f| / |grad f|.
const TOLERANCE: f64 = 1e-12;

/// Steps of the search for a zero between two grid vertices.
const ROOT_STEPS: usize = 200;

/// A mesh of f = 0 within a box, f < 0 behind it. Watertight but where the surface leaves the box: there it has a
/// border, in the sides of the box. Edges are about `edge` long, by default 0.9 times a 64th of the box's longest side, and
/// shorter where the surface bends more than 0.4 along them, down to a 32nd of that. Of a smooth surface no triangle is a
/// needle, or makes more than 45 degrees with the surface at its corners. What is thinner than the diagonals of the grid's
/// cubes, 1.93 edges, is lost, or comes out as it can, with needles and edges across it; so do creases and other singular
/// places. Vertices are on the surface: |f| / |grad f| is at most 1e-12 of the box's diagonal.
///
/// # Errors
/// [`Error::Domain`] of an empty box or edge length, where f has no zero on the grid, is not a number, or jumps across zero, and where
/// sheets of f = 0 cross in a line;
/// [`Error::Limit`] of a grid of more than 5e7 points, or more than 1e7 vertices.
pub(crate) fn mesh_implicit(f: &dyn Implicit, bounds: Aabb3, edge: Option<f64>) -> Result<Surface> {
    let extent = bounds.extent();
    if !(extent.x > 0.0 && extent.y > 0.0 && extent.z > 0.0 && bounds.diagonal().is_finite()) {
        let place = format!("{} - {}", bounds.min, bounds.max);
        return Err(Error::domain("an empty box", place, "give x0 < x1, y0 < y1, z0 < z1, all finite"));
    }
    let edge = edge.unwrap_or(EDGE * extent.x.max(extent.y).max(extent.z) / DEFAULT_STEPS);
    if edge.is_nan() || edge <= 0.0 {
        return Err(Error::domain("no positive edge length", format!("edge = {edge}"), "ask for a positive length"));
    }
    let grid = Grid::new(f, bounds, edge / EDGE)?;
    let crossings = grid.crossings();
    if crossings.triangles.is_empty() {
        return Err(no_zero(&grid, bounds));
    }
    let edges = crossings.edges.par_iter();
    let [least, most] = grid.range();
    let largest = most.max(-least);
    let zeros: Vec<f64> = edges.map(|&[a, b]| zero(f, &grid, [a, b], largest)).collect::<Result<_>>()?;
    let on_surface: Vec<Point3> = crossings.edges.iter().zip(&zeros).map(|(edge, &t)| grid.between(*edge, t)).collect();
    demand_one_sheet(f, &on_surface, grid.step(), bounds)?;
    let tolerance = TOLERANCE * bounds.diagonal();
    let assembled = |near| Surface::new(&assemble(f, &grid, &crossings, &zeros, near, tolerance)?);
    // Moving grid vertices may pinch what is thinner than the grid; without that the mesh is always a surface.
    let surface = assembled(NEAR).or_else(|_| assembled(0.0))?;
    remesh(&surface, f, bounds, edge, tolerance)
}

/// Where f changes sign on the edge from a to b, as a part of its length: regula falsi, the Illinois way (Dowell and
/// Jarratt 1971). Strictly between the ends. `largest` is the largest absolute value on the grid.
///
/// # Errors
/// [`Error::Domain`] of a pole, where f changes sign through infinity.
fn zero(f: &dyn Implicit, grid: &Grid, [a, b]: [usize; 2], largest: f64) -> Result<f64> {
    /// So near to an end vertices would coincide.
    const MARGIN: f64 = 1e-3;
    let (start, end) = (grid.position(a), grid.position(b));
    let (mut low, mut high) = ((0.0, grid.value(a)), (1.0, grid.value(b)));
    let (mut t, mut value) = low;
    for _ in 0..ROOT_STEPS {
        let weighted = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
        // Infinite values have no secant.
        t = if weighted > low.0 && weighted < high.0 { weighted } else { f64::midpoint(low.0, high.0) };
        value = f.value(start.lerp(end, t));
        if value == 0.0 || high.0 - low.0 < 1e-15 {
            break;
        }
        if value < 0.0 {
            low = (t, value);
            high.1 *= 0.5;
        } else {
            high = (t, value);
            low.1 *= 0.5;
        }
    }
    if value.abs() <= largest { Ok(t.clamp(MARGIN, 1.0 - MARGIN)) } else { Err(not_reached(start.lerp(end, t))) }
}

/// The triangles. A grid vertex with a crossing nearer than `near` is moved onto the surface and takes the place of all
/// crossings on its edges; nearest crossings go first, and leave their neighbours where they are.
fn assemble(
    f: &dyn Implicit,
    grid: &Grid,
    crossings: &Crossings,
    zeros: &[f64],
    near: f64,
    tolerance: f64,
) -> Result<Mesh> {
    let at = |c: usize| grid.between(crossings.edges[c], zeros[c]);
    let sides = |c: usize| crossings.edges[c].map(|end| grid.sides(end));
    let pins = |[a, b]: [[i8; 3]; 2]| [0, 1, 2].map(|i| a[i] != 0 && a[i] == b[i]);
    // Where Newton's method starts, and where else if that fails; it leaves no side of the box.
    let mut starts: Vec<([Point3; 2], Pins)> = Vec::new();
    let mut moved: HashMap<usize, u32> = HashMap::new();
    let mut order: Vec<usize> = (0..zeros.len()).filter(|&c| zeros[c].min(1.0 - zeros[c]) < near).collect();
    order.sort_by(|&c, &d| zeros[c].min(1.0 - zeros[c]).total_cmp(&zeros[d].min(1.0 - zeros[d])).then(c.cmp(&d)));
    for c in order {
        let nearer = usize::from(zeros[c] > 0.5);
        let (ends, sides) = (crossings.edges[c], sides(c));
        let pinned = pins([sides[nearer]; 2]);
        if pinned == pins(sides) && !ends.iter().any(|end| moved.contains_key(end)) {
            moved.insert(ends[nearer], starts.len() as u32);
            starts.push(([grid.position(ends[nearer]), at(c)], pinned));
        }
    }
    let mut vertex_of = Vec::with_capacity(zeros.len());
    for (c, (&[a, b], &t)) in crossings.edges.iter().zip(zeros).enumerate() {
        let [first, second] = if t < 0.5 { [a, b] } else { [b, a] };
        vertex_of.push(moved.get(&first).or_else(|| moved.get(&second)).copied().unwrap_or_else(|| {
            starts.push(([at(c); 2], pins(sides(c))));
            starts.len() as u32 - 1
        }));
    }
    let triangles = crossings.triangles.iter().map(|triangle| triangle.map(|c| vertex_of[c as usize]));
    let triangles: Vec<[u32; 3]> = triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect();
    let reach = 2.0 * grid.step();
    let land = |&([p, q], pins): &([Point3; 2], Pins)| {
        let onto = |p| project_pinned(f, p, pins, reach, tolerance);
        onto(p).or_else(|| onto(q)).ok_or(q)
    };
    compact(&starts.par_iter().map(land).collect::<Vec<_>>(), triangles)
}

/// The mesh without vertices that no triangle has.
///
/// # Errors
/// [`Error::Domain`] of a vertex from which the surface was not reached.
fn compact(landed: &[std::result::Result<Point3, Point3>], mut triangles: Vec<[u32; 3]>) -> Result<Mesh> {
    let mut number = vec![u32::MAX; landed.len()];
    let mut points = Vec::new();
    for vertex in triangles.as_flattened_mut() {
        let slot = &mut number[*vertex as usize];
        if *slot == u32::MAX {
            *slot = points.len() as u32;
            points.push(landed[*vertex as usize].map_err(not_reached)?.to_array());
        }
        *vertex = *slot;
    }
    Ok(Mesh {
        point_labels: vec![0; points.len()],
        triangle_labels: vec![1; triangles.len()],
        points,
        triangles,
        ..Mesh::default()
    })
}

fn not_reached(p: Point3) -> Error {
    let help =
        "f must be smooth, with a gradient that is not zero, where it is zero: simplify it, or choose shorter edges";
    Error::domain("f changes sign, but its zero is not reached along its gradient", p.to_string(), help)
}

fn no_zero(grid: &Grid, bounds: Aabb3) -> Error {
    let [least, most] = grid.range();
    let what = format!("f has no zero: on the grid its values are between {least} and {most}");
    let place = format!("the box {} - {}", bounds.min, bounds.max);
    Error::domain(what, place, "choose a box that holds the surface, or shorter edges; f must change its sign there")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::Component;
    use crate::metric::{Expression, Variables};

    fn mesh(text: &str, half: f64, edge: Option<f64>) -> Result<Surface> {
        let f = Expression::parse(text, Variables::Space).unwrap();
        let corner = |s: f64| Point3::new(s * half, s * half, s * half);
        mesh_implicit(&f, Aabb3 { min: corner(-1.0), max: corner(1.0) }, edge)
    }

    /// The smallest angle in degrees, and the mean length of edges.
    fn shape(surface: &Surface) -> (f64, f64) {
        let t = surface.topology();
        let angle = t
            .faces()
            .flat_map(crate::triangulation::FaceId::half_edges)
            .map(|h| surface.angle(h))
            .fold(f64::INFINITY, f64::min);
        let lengths: Vec<f64> =
            t.edges().map(|h| surface.position(t.origin(h)).distance(surface.position(t.target(h)))).collect();
        (angle.to_degrees(), lengths.iter().sum::<f64>() / lengths.len() as f64)
    }

    fn genera(surface: &Surface) -> Vec<(isize, usize)> {
        surface.components().iter().map(|c: &Component| (c.genus(), c.borders)).collect()
    }

    #[test]
    fn closed_surfaces_are_watertight_and_of_their_genus() {
        // Edges are as long as asked for where the surface bends gently, and the last one does not everywhere.
        for (text, half, edge, expected, lengths) in [
            ("x^2+y^2+z^2-1", 1.5, None, vec![(0, 0)], 0.8..1.2),
            ("x^2+y^2+z^2-1", 2.0, None, vec![(0, 0)], 0.8..1.2),
            ("(sqrt(x^2+y^2)-2)^2+z^2-0.49", 3.0, Some(0.1), vec![(1, 0)], 0.8..1.2),
            ("min((x-1)^2+y^2+z^2, (x+1)^2+y^2+z^2)-0.36", 2.0, None, vec![(0, 0), (0, 0)], 0.8..1.2),
            ("(x*(x-1)^2*(x-2)+y^2)^2+z^2-0.01", 2.5, Some(0.04), vec![(2, 0)], 0.4..1.2),
        ] {
            let surface = mesh(text, half, edge).unwrap();
            assert_eq!(genera(&surface), expected, "{text}");
            assert_eq!(surface.turned(), 0, "{text}");
            let (angle, length) = shape(&surface);
            let asked = edge.unwrap_or(half / 32.0 * EDGE);
            println!("{text}: smallest angle {angle:.1}, mean edge {:.2} of what was asked", length / asked);
            assert!(lengths.contains(&(length / asked)), "{text}: {length}");
            assert!(angle > 15.0, "{text}: {angle}");
        }
    }

    #[test]
    fn vertices_are_on_the_surface_and_normals_point_to_where_f_is_positive() {
        let surface = mesh("x^2+y^2+z^2-1", 1.5, Some(0.1)).unwrap();
        for &p in surface.positions() {
            assert!(((p - Point3::default()).norm() - 1.0).abs() < 1e-11);
        }
        for f in surface.topology().faces() {
            assert!(surface.normal(f).dot(surface.triangle(f)[0] - Point3::default()) > 0.9);
        }
        assert!((surface.area() / (4.0 * std::f64::consts::PI) - 1.0).abs() < 0.01);
    }

    #[test]
    fn a_surface_that_leaves_its_box_has_a_border_there() {
        let surface = mesh("x^2+y^2-0.25", 1.0, Some(0.1)).unwrap();
        assert_eq!(genera(&surface), [(0, 2)]);
        assert!(surface.border_loops().iter().flatten().all(|&h| {
            let p = surface.position(surface.topology().origin(h));
            (p.z.abs() - 1.0).abs() < 1e-12
        }));
    }

    #[test]
    fn what_has_no_surface_is_named() {
        for (text, half, edge, expected) in [
            ("x^2+y^2+z^2+1", 1.0, None, "invalid domain: f has no zero: on the grid its values are between 1"),
            ("x^2+y^2", 1.0, None, "f has no zero: on the grid its values are between 0"),
            ("sqrt(x)-0.5", 1.0, None, "invalid domain: f is not a number at (-1, -1, -1)"),
            ("1/(x-0.01)", 1.0, None, "f changes sign, but its zero is not reached along its gradient at ("),
            ("x", 0.0, None, "an empty box at (-0, -0, -0) - (0, 0, 0)"),
            ("x", 1.0, Some(1e-3), "limit exceeded: a grid of 5841725401 points"),
            ("x", 1.0, Some(1e-300), "limit exceeded: a grid of inf points"),
            ("x", 1.0, Some(-0.1), "no positive edge length at edge = -0.1"),
        ] {
            let error = mesh(text, half, edge).map(|found| found.positions().len()).unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }

    #[test]
    fn zeros_at_grid_vertices_and_thin_sheets_make_surfaces_all_the_same() {
        for (text, edge) in
            [("x+y*0", 0.25), ("abs(x+y)+abs(z)-0.5", 0.25), ("x^2-0.0009", 0.19), ("x^2+y^2-z^2-0.01", 0.1)]
        {
            let surface = mesh(text, 1.0, Some(edge)).unwrap_or_else(|error| panic!("{text}: {error}"));
            surface.topology().check().unwrap();
        }
    }
}
