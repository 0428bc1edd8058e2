//! Domains that need no file, and the texts that name them.

use super::{Domain, Pslg, Segment, Side};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::Point;
use crate::metric::name_and_rest;
use std::f64::consts::FRAC_PI_2;

/// The rectangle between two corners: region 1, its boundary labelled 1 (bottom), 2 (right), 3 (top) and 4 (left).
///
/// # Errors
///
/// [`Error::Domain`] unless the coordinates and the extent are finite, and `min` is less than `max` in both.
pub(crate) fn rect(min: Point, max: Point) -> Result<Pslg> {
    let extent = max - min;
    if !(extent.x.is_finite() && extent.y.is_finite()) {
        return Err(shape_error("a rectangle whose coordinates or extent are not finite", min, max));
    }
    if !(min.x < max.x && min.y < max.y) {
        return Err(shape_error("a rectangle needs x0 < x1 and y0 < y1; this one has its corners", min, max));
    }
    let points = vec![min, Point::new(max.x, min.y), max, Point::new(min.x, max.y)];
    Ok(region_inside(points, |side| SIDES[side], 0.0))
}

/// The disk as a polygon of 4096 vertices on its circle: region 1, boundary label 1.
///
/// Its tolerance is a hundredth of the radius, so that a mesh may use longer chords.
///
/// # Errors
///
/// [`Error::Domain`] unless centre and radius are finite, the radius is positive, and large enough beside the centre's
/// coordinates to tell neighbouring vertices apart.
pub(crate) fn disk(centre: Point, radius: f64) -> Result<Pslg> {
    if !(radius > 0.0 && radius.is_finite() && centre.is_finite()) {
        let place = format!("centre {centre}, radius {radius}");
        let help = "give a finite centre and a positive, finite radius";
        return Err(Error::domain("a disk without a positive radius or a finite centre", place, help));
    }
    let points: Vec<_> = (0..CIRCLE).map(|step| on_circle(centre, radius, step)).collect();
    let is_distinct = (0..CIRCLE).all(|step| points[step] != points[(step + 1) % CIRCLE]);
    let rounding = f64::EPSILON * (centre.x.abs().max(centre.y.abs()) + radius);
    if is_distinct && rounding < ROUNDING * radius && points.iter().all(|p| p.is_finite()) {
        return Ok(region_inside(points, |_| 1, TOLERANCE * radius));
    }
    let what = "a disk too small or too large for its vertices to have distinct, finite coordinates";
    let help = "move the centre to the origin, or choose other units";
    Err(Error::domain(what, format!("centre {centre}, radius {radius}"), help))
}

/// Labels of a rectangle's sides, from the bottom on.
const SIDES: [i32; 4] = [1, 2, 3, 4];

/// Vertices of a disk's polygon; a multiple of four. Its chords are within 3e-7 of the radius.
const CIRCLE: usize = 4096;

/// How far mesh edges may stray from a disk's circle, by default, as a fraction of its radius.
const TOLERANCE: f64 = 1e-2;

/// How coarse floating-point numbers may be near a disk, as a fraction of its radius: far less than its chords
/// (1.5e-3), which then neither vanish nor cross.
const ROUNDING: f64 = 1e-4;

/// Vertex `step` of a disk's polygon; exact where the circle meets the axes.
fn on_circle(centre: Point, radius: f64, step: usize) -> Point {
    const QUARTER: usize = CIRCLE / 4;
    let (sin, cos) = (FRAC_PI_2 * (step % QUARTER) as f64 / QUARTER as f64).sine_and_cosine();
    let (x, y) = match step / QUARTER {
        0 => (cos, sin),
        1 => (-sin, cos),
        2 => (-cos, -sin),
        _ => (sin, -cos),
    };
    Point::new(centre.x + radius * x, centre.y + radius * y)
}

/// Region 1 inside a counter-clockwise polygon.
fn region_inside(points: Vec<Point>, label: impl Fn(usize) -> i32, tolerance: f64) -> Pslg {
    let count = points.len();
    let segment = |side: usize| Segment {
        ends: [side as u32, ((side + 1) % count) as u32],
        label: label(side),
        required: false,
        left: Side::Region(1),
        right: Side::Outside,
    };
    Pslg {
        segments: (0..count).map(segment).collect(),
        point_labels: vec![0; count],
        points,
        tolerance,
        ..Pslg::default()
    }
}

fn shape_error(what: &str, min: Point, max: Point) -> Error {
    let help = "give the lower left corner, then the upper right one: rect:x0,y0,x1,y1";
    Error::domain(what, format!("{min}, {max}"), help)
}

/// What users write for surfaces that need no file.
const SURFACES: [&str; 4] = ["sphere", "torus", "chair", "implicit"];
/// How shapes are written, for messages.
pub(crate) const SHAPES: &str = "rect:x0,y0,x1,y1 or disk:cx,cy,r";

impl Domain {
    /// The shape that a text names: `rect:x0,y0,x1,y1` or `disk:cx,cy,r`.
    ///
    /// # Errors
    /// [`Error::Parse`] of a text that names none, or has other numbers; [`Error::Domain`] of a shape without area;
    /// [`Error::Unsupported`] of a surface.
    pub fn shape(text: &str) -> Result<Self> {
        let unknown = || Error::parse(text, "no such shape", format!("give {SHAPES}"));
        Self::new(&shape(text).ok_or_else(unknown)??)
    }
}

/// The shape that a text names, or why it is none in the plane; `None` if it names none.
pub fn shape(spec: &str) -> Option<Result<Pslg>> {
    let (name, numbers) = name_and_rest(spec);
    match (name, numbers) {
        ("rect", Some(numbers)) => Some(
            read_numbers(spec, numbers, "rect:x0,y0,x1,y1")
                .and_then(|[x0, y0, x1, y1]| rect(Point::new(x0, y0), Point::new(x1, y1))),
        ),
        ("disk", Some(numbers)) => {
            Some(read_numbers(spec, numbers, "disk:cx,cy,r").and_then(|[x, y, r]| disk(Point::new(x, y), r)))
        }
        _ if SURFACES.contains(&name) => Some(Err(not_planar(format!("the surface {spec} as planar domain")))),
        _ => None,
    }
}

/// The comma-separated numbers of a shape.
///
/// # Errors
/// [`Error::Parse`] of more, fewer, or what is no number.
pub(crate) fn read_numbers<const N: usize>(spec: &str, numbers: &str, usage: &str) -> Result<[f64; N]> {
    let error = |what: String| Error::parse(spec, what, format!("write {usage}"));
    let words: Vec<_> = numbers.split(',').map(str::trim).collect();
    if words.len() != N {
        return Err(error(format!("{} numbers where {N} are expected", words.len())));
    }
    let mut values = [0.0; N];
    for (value, word) in values.iter_mut().zip(words) {
        *value = word.parse().map_err(|_| error(format!("'{word}' is not a number")))?;
    }
    Ok(values)
}

fn not_planar(what: String) -> Error {
    Error::unsupported(what, format!("give {SHAPES}, or a planar domain in a file"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_has_its_sides_labelled() {
        let pslg = rect(Point::new(-1.0, 0.0), Point::new(2.0, 1.0)).unwrap();
        let bottom = pslg.segments[0];
        assert!(bottom.ends.iter().all(|&v| pslg.points[v as usize].y == 0.0));
        assert_eq!((bottom.left, bottom.right), (Side::Region(1), Side::Outside));
        assert_eq!(pslg.segments.iter().map(|s| s.label).collect::<Vec<_>>(), [1, 2, 3, 4]);
        assert!(pslg.tolerance == 0.0);
    }

    #[test]
    fn a_disk_is_a_polygon_on_its_circle() {
        let pslg = disk(Point::new(1.0, -2.0), 3.0).unwrap();
        assert_eq!((pslg.points.len(), pslg.segments.len()), (4096, 4096));
        assert_eq!(pslg.points[1024], Point::new(1.0, 1.0));
        let centre = Point::new(1.0, -2.0);
        assert!(pslg.points.iter().all(|p| (p.distance(centre) - 3.0).abs() < 1e-14));
        assert!((pslg.tolerance - 3e-2).abs() < 1e-15);
        assert!(pslg.segments.iter().all(|s| s.label == 1 && s.left == Side::Region(1)));
    }

    #[test]
    fn bad_shapes_are_refused() {
        let p = Point::new;
        for (shape, expected) in [
            (rect(p(1.0, 0.0), p(1.0, 1.0)), "x0 < x1 and y0 < y1; this one has its corners at (1, 0), (1, 1)"),
            (rect(p(0.0, 0.0), p(f64::NAN, 1.0)), "not finite at (0, 0), (NaN, 1)"),
            (rect(p(-1e308, 0.0), p(1e308, 1.0)), "not finite"),
            (disk(p(0.0, 0.0), 0.0), "positive radius or a finite centre at centre (0, 0), radius 0"),
            (disk(p(0.0, f64::INFINITY), 1.0), "finite centre at centre (0, inf), radius 1"),
            (disk(p(1e16, 0.0), 1e-3), "distinct, finite coordinates at centre (10000000000000000, 0), radius 0.001"),
            (disk(p(0.0, 0.0), 1e-322), "distinct, finite coordinates"),
            (disk(p(0.0, 1e13), 1.0), "distinct, finite coordinates"),
            (disk(p(1e308, 0.0), 1.7e308), "distinct, finite coordinates"),
        ] {
            let error = shape.expect_err(expected);
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }

    #[test]
    fn shapes_are_read() {
        assert_eq!(Domain::shape("rect: 0, 0,1e0,2").unwrap().pslg().points.len(), 4);
        assert_eq!(shape("disk:0,0,1").unwrap().unwrap().points.len(), 4096);
        assert!(shape("mesh").is_none() && shape("rect").is_none() && shape("").is_none());
    }

    #[test]
    fn mistakes_are_named() {
        for (text, expected) in [
            ("rect:0,0,1", "rect:0,0,1: 3 numbers where 4 are expected"),
            ("disk:0,x,1", "disk:0,x,1: 'x' is not a number"),
            ("rect:0,0,0,1", "invalid domain: a rectangle needs x0 < x1"),
            ("disk:0,0,nan", "invalid domain: a disk without a positive radius"),
            ("sphere:1", "not supported: the surface sphere:1 as planar domain"),
            ("chair", "not supported: the surface chair as planar domain"),
            ("", ": no such shape"),
        ] {
            let error = Domain::shape(text).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
