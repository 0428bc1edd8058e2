//! Surfaces that need no file, and the texts that name them.

use super::super::Manifold;
use super::{Surface, mesh_implicit};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Aabb3, Point3, Vector3};
use crate::lists::in_order;
use crate::manifold::domain::read_numbers;
use crate::mesh::{Mesh, edges_of};
use crate::metric::{Expression, Variables, name_and_rest};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// The chair of RR-9103 with k = 5, a = 0.95, b = 0.8: (x^2 + y^2 + z^2 - a k^2)^2 -
/// b ((z - k)^2 - 2 x^2) ((z + k)^2 - 2 y^2).
pub(super) const CHAIR: &str = "(x^2+y^2+z^2-0.95*5^2)^2 - 0.8*((z-5)^2-2*x^2)*((z+5)^2-2*y^2)";

/// Half the side of a box around the chair.
const CHAIR_BOX: f64 = 6.0;

/// More vertices than this no shape is made of.
const MOST_VERTICES: f64 = 5e7;

/// The sphere around the origin: an icosahedron whose triangles are cut into four, and their vertices pushed onto the
/// sphere, until no edge is longer than `edge`.
///
/// # Errors
/// [`Error::Domain`] unless radius and edge length are positive and finite; [`Error::Limit`] of too many vertices.
pub(crate) fn sphere(radius: f64, edge: f64) -> Result<Surface> {
    check("sphere", &[radius, edge])?;
    check_count(4.0 * TAU * (radius / edge).powi(2))?;
    let (mut points, mut triangles) = icosahedron();
    let longest = |points: &[Vector3], triangles: &[[u32; 3]]| {
        let edges = triangles.iter().copied().flat_map(edges_of);
        edges.map(|[a, b]| (points[a as usize] - points[b as usize]).norm()).fold(0.0, f64::max)
    };
    while longest(&points, &triangles) * radius > edge {
        triangles = halve(&mut points, &triangles);
    }
    let points = points.into_iter().map(|v| (Point3::default() + v * radius).to_array()).collect();
    Surface::new(&Mesh { points, triangle_labels: vec![1; triangles.len()], triangles, ..Mesh::default() })
}

/// The torus around the z axis: a tube of radius `tube` along a circle of radius `ring`, as a grid in its two angles with
/// edges of about `edge`; vertices are on it.
///
/// # Errors
/// [`Error::Domain`] unless all are positive and finite and the tube thinner than the ring; [`Error::Limit`] of too many
/// vertices.
pub fn torus(ring: f64, tube: f64, edge: f64) -> Result<Surface> {
    check("torus", &[ring, tube, edge])?;
    if tube >= ring {
        let place = format!("torus:{ring},{tube}");
        return Err(Error::domain(
            "a torus whose tube meets itself",
            place,
            "give R > r: first the ring, then the tube",
        ));
    }
    let around = |radius: f64| (TAU * radius / edge).ceil().max(3.0);
    let (long, short) = (around(ring + tube), around(tube));
    check_count(long * short)?;
    let (long, short) = (long as u32, short as u32);
    let at = |i: u32, j: u32| {
        // Every other row is shifted by half a step: triangles come out nearly equilateral.
        let shift = 0.5 * f64::from(j % 2);
        let (sin_u, cos_u) = (TAU * (f64::from(i) + shift) / f64::from(long)).sine_and_cosine();
        let (sin_v, cos_v) = (TAU * f64::from(j) / f64::from(short)).sine_and_cosine();
        let r = ring + tube * cos_v;
        [r * cos_u, r * sin_u, tube * sin_v]
    };
    let number = |i: u32, j: u32| i % long + j % short * long;
    let cell = |(i, j): (u32, u32)| {
        let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
        // The shifted row above lies half a step ahead; above a shifted row the next lies behind, but for the seam.
        if j % 2 == 0 { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
    };
    let cells = (0..short).flat_map(|j| (0..long).map(move |i| (i, j)));
    let triangles: Vec<[u32; 3]> = cells.flat_map(cell).collect();
    let points = (0..short).flat_map(|j| (0..long).map(move |i| at(i, j))).collect();
    Surface::new(&Mesh { points, triangle_labels: vec![1; triangles.len()], triangles, ..Mesh::default() })
}

/// The chair of RR-9103, k = 5, a = 0.95, b = 0.8, with edges of about `edge` (by default a 64th of 12).
///
/// # Errors
/// As for `mesh_implicit`.
pub(crate) fn chair(edge: Option<f64>) -> Result<Surface> {
    let corner = |s: f64| Point3::new(s, s, s);
    let f = Expression::parse(CHAIR, Variables::Space)?;
    mesh_implicit(&f, Aabb3 { min: corner(-CHAIR_BOX), max: corner(CHAIR_BOX) }, edge)
}

fn check(name: &str, lengths: &[f64]) -> Result<()> {
    if lengths.iter().all(|length| *length > 0.0 && length.is_finite()) {
        return Ok(());
    }
    let what = format!("a {name} whose radii and edge length are not all positive and finite");
    let given: Vec<String> = lengths.iter().map(f64::to_string).collect();
    Err(Error::domain(what, given.join(", "), "give positive, finite numbers"))
}

fn check_count(needed: f64) -> Result<()> {
    if needed <= MOST_VERTICES {
        return Ok(());
    }
    let what = format!("about {needed:.0} vertices for the shape; at most {MOST_VERTICES:.0}");
    Err(Error::limit(what, "ask for longer edges"))
}

fn icosahedron() -> (Vec<Vector3>, Vec<[u32; 3]>) {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut points = Vec::new();
    for (s, t) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        points.extend([Vector3::new(s, t, 0.0), Vector3::new(0.0, s, t), Vector3::new(t, 0.0, s)]);
    }
    let points: Vec<Vector3> = points.into_iter().map(|v| v * (1.0 / golden.hypotenuse(1.0))).collect();
    // Neighbours are those nearer than a right angle.
    let near = |a: usize, b: usize| points[a].dot(points[b]) > 0.0;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in (a + 1..12).filter(|&b| near(a, b)) {
            for c in (b + 1..12).filter(|&c| near(a, c) && near(b, c)) {
                let outward = (points[b] - points[a]).cross(points[c] - points[a]).dot(points[a]) > 0.0;
                triangles.push(if outward { [a, b, c] } else { [a, c, b] }.map(|v| v as u32));
            }
        }
    }
    (points, triangles)
}

/// Every triangle as four, with the middles of edges pushed onto the unit sphere.
fn halve(points: &mut Vec<Vector3>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles: HashMap<[u32; 2], u32> = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry(in_order([a, b])).or_insert_with(|| {
            let sum = points[a as usize] + points[b as usize];
            points.push(sum * (1.0 / sum.norm()));
            points.len() as u32 - 1
        })
    };
    let four = |&[a, b, c]: &[u32; 3]| {
        let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    };
    triangles.iter().flat_map(four).collect()
}

/// How surfaces that need no file are written, for messages.
pub(crate) const SHAPES: &str = "sphere:r, torus:R,r, chair or implicit:EXPR;x0,y0,z0,x1,y1,z1";
/// Edges of shapes are this part of their diagonal, unless told otherwise.
const DEFAULT_EDGE: f64 = 1.0 / 64.0;

impl Manifold {
    /// The shape that a text names: `sphere:r`, `torus:R,r`, `chair` or `implicit:EXPR;x0,y0,z0,x1,y1,z1`, with edges about as
    /// long as `edge`.
    ///
    /// # Errors
    /// As of [`shape`]; [`Error::Parse`] of a text that names none.
    pub fn shape(text: &str, edge: Option<f64>) -> Result<Self> {
        let unknown = || Error::parse(text, "no such shape", format!("give {SHAPES}"));
        shape(text, edge).ok_or_else(unknown)?
    }
}

/// The shape that a text names; `None` if it names none.
///
/// # Errors
/// [`Error::Parse`] of numbers and equations that are none; [`Error::Domain`] of what makes no surface; [`Error::Limit`] of too
/// many triangles.
pub fn shape(text: &str, edge: Option<f64>) -> Option<Result<Manifold>> {
    let (name, rest) = name_and_rest(text);
    match (name.trim(), rest) {
        ("sphere", Some(numbers)) => Some(read_sphere(text, numbers, edge)),
        ("torus", Some(numbers)) => Some(read_torus(text, numbers, edge)),
        ("chair", None) => Some(chair(edge).and_then(|surface| with_equation(surface, CHAIR))),
        ("implicit", Some(rest)) => Some(read_implicit(text, rest, edge)),
        _ => None,
    }
}

fn read_sphere(text: &str, numbers: &str, edge: Option<f64>) -> Result<Manifold> {
    let [r] = read_numbers(text, numbers, "sphere:r")?;
    let surface = sphere(r, edge.unwrap_or(12.0_f64.sqrt() * r * DEFAULT_EDGE))?;
    with_equation(surface, &format!("x^2+y^2+z^2-{r:e}^2"))
}

fn read_torus(text: &str, numbers: &str, edge: Option<f64>) -> Result<Manifold> {
    let [ring, tube] = read_numbers(text, numbers, "torus:R,r")?;
    let size = (ring + tube).hypotenuse(ring + tube).hypotenuse(tube) * 2.0;
    let surface = torus(ring, tube, edge.unwrap_or(size * DEFAULT_EDGE))?;
    with_equation(surface, &format!("(sqrt(x^2+y^2)-{ring:e})^2+z^2-{tube:e}^2"))
}

fn with_equation(surface: Surface, equation: &str) -> Result<Manifold> {
    Ok(Manifold::new(surface, Some(Expression::parse(equation, Variables::Space)?)))
}

fn read_implicit(spec: &str, rest: &str, edge: Option<f64>) -> Result<Manifold> {
    const USAGE: &str = "implicit:EXPR;x0,y0,z0,x1,y1,z1";
    let Some((equation, numbers)) = rest.rsplit_once(';') else {
        return Err(Error::parse(spec, "an equation without its box", format!("write {USAGE}")));
    };
    let f = Expression::parse(equation, Variables::Space)?;
    let [x0, y0, z0, x1, y1, z1] = read_numbers(spec, numbers, USAGE)?;
    let bounds = Aabb3 { min: Point3::new(x0, y0, z0), max: Point3::new(x1, y1, z1) };
    Ok(Manifold::new(mesh_implicit(&f, bounds, edge)?, Some(f)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::Implicit;

    #[test]
    fn spheres_are_round_and_closed() {
        for (radius, edge, count) in [(1.0, 2.0, 12), (3.0, 1.0, 162), (3.0, 0.9, 642), (1e-6, 3.5e-7, 162)] {
            let surface = sphere(radius, edge).unwrap();
            assert_eq!(surface.positions().len(), count);
            assert_eq!((surface.euler_characteristic(), surface.border_loops().len(), surface.turned()), (2, 0, 0));
            for &p in surface.positions() {
                assert!(((p - Point3::default()).norm() / radius - 1.0).abs() < 1e-15);
            }
            assert!(
                surface
                    .topology()
                    .faces()
                    .all(|f| surface.normal(f).dot(surface.triangle(f)[0] - Point3::default()) > 0.0)
            );
        }
    }

    #[test]
    fn tori_are_on_their_equation_and_closed() {
        for (ring, tube, edge) in [(2.0, 0.7, 0.3), (2.0, 0.7, 0.1), (5.0, 0.1, 1.0), (1.0, 0.99, 0.2)] {
            let surface = torus(ring, tube, edge).unwrap();
            assert_eq!((surface.euler_characteristic(), surface.border_loops().len(), surface.turned()), (0, 0, 0));
            assert_eq!(surface.components().iter().map(super::super::Component::genus).collect::<Vec<_>>(), [1]);
            for p in surface.positions() {
                assert!(((p.x.hypot(p.y) - ring).hypot(p.z) / tube - 1.0).abs() < 1e-12);
            }
            for f in surface.topology().faces() {
                let [a, ..] = surface.triangle(f);
                let middle = Point3::new(a.x, a.y, 0.0);
                let scale = ring / (middle - Point3::default()).norm();
                let centre = Point3::new(middle.x * scale, middle.y * scale, 0.0);
                assert!(edge > tube || surface.normal(f).dot(a - centre) > 0.0, "normals point out");
            }
        }
    }

    #[test]
    fn the_chair_is_closed_smooth_and_in_its_box() {
        let surface = chair(None).unwrap();
        let components = surface.components();
        assert_eq!((components.len(), components[0].euler_characteristic, components[0].borders), (1, -4, 0));
        // The same on a finer grid: nothing is lost between grid points.
        assert_eq!(chair(Some(0.1)).unwrap().euler_characteristic(), -4);
        let f = Expression::parse(CHAIR, Variables::Space).unwrap();
        let slopes = surface.positions().iter().map(|&p| Implicit::jet(&f, p).gradient.norm());
        let least = slopes.fold(f64::INFINITY, f64::min);
        assert!(least > 1.0, "smooth: {least}");
        let bounds = surface.bounds();
        assert!([bounds.min, bounds.max].iter().flat_map(|p| p.to_array()).all(|x| x.abs() < 5.9), "{bounds:?}");
    }

    #[test]
    fn senseless_sizes_are_named() {
        for (error, expected) in [
            (sphere(-1.0, 1.0).unwrap_err(), "a sphere whose radii and edge length are not all positive"),
            (sphere(1.0, 1e-9).unwrap_err(), "limit exceeded: about"),
            (torus(1.0, 2.0, 0.1).unwrap_err(), "a torus whose tube meets itself at torus:1,2"),
            (torus(1.0, f64::NAN, 0.1).unwrap_err(), "a torus whose radii and edge length are not all positive"),
        ] {
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }

    #[test]
    fn shapes_lie_on_their_equations() {
        for (spec, genus) in [("sphere:2", 0), ("torus: 2, 0.5", 1), ("implicit:x^2+y^2+2*z^2-1;-2,-2,-2,2,2,2", 0)] {
            let Manifold { surface, implicit, .. } = Manifold::shape(spec, None).unwrap();
            let f = implicit.unwrap();
            let components = surface.components();
            assert_eq!((components.len(), components[0].genus()), (1, genus), "{spec}");
            let size = surface.bounds().diagonal();
            for &p in surface.positions() {
                let jet = Implicit::jet(&f, p);
                assert!(jet.value.abs() < 1e-11 * size * jet.gradient.norm(), "{spec}: {p}");
            }
            let edges: Vec<_> = surface.topology().edges().collect();
            assert!((1_000..100_000).contains(&edges.len()), "{spec}: {}", edges.len());
        }
    }

    #[test]
    fn mistakes_are_named() {
        for (text, expected) in [
            ("sphere:1,2", "sphere:1,2: 2 numbers where 1 are expected"),
            ("sphere:x", "sphere:x: 'x' is not a number"),
            ("sphere:-1", "invalid domain: a sphere whose radii"),
            ("torus:1,2", "invalid domain: a torus whose tube meets itself"),
            ("sphere", "sphere: no such shape"),
            ("chair:1", "chair:1: no such shape"),
            ("implicit:x", "implicit:x: an equation without its box"),
            ("implicit:x+;0,0,0,1,1,1", "expression, column 3: a value was expected"),
            ("implicit:x;0,0,0,1,1", "implicit:x;0,0,0,1,1: 5 numbers where 6 are expected"),
            ("implicit:x;0,0,0,0,1,1", "invalid domain: an empty box at (0, 0, 0) - (0, 1, 1)"),
        ] {
            let error = Manifold::shape(text, None).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
