//! From where a scene is seen, and the way from space to pixels.

use super::super::frame::Frame;
use super::Scene;
use voronaut::geometry::{Aabb, Aabb3, Point, Point3, Vector3};
use voronaut::{Error, Result};

/// From where a scene is seen, in parallel projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From the scene to the eye; of any length.
    pub from: Vector3,
    /// What is upright in the picture, as far as `from` leaves it; of any length.
    pub up: Vector3,
    /// Pixels of the longer side.
    pub pixels: u32,
}

/// The least and the most pixels of the longer side.
const SMALLEST: u32 = 16;
const LARGEST: u32 = 5000;
/// What lies flat along z has less than so much of the smaller one of its other extents.
const FLAT: f64 = 0.6;
/// Coordinates beyond this are not drawn: their squares overflow.
const HUGE: f64 = 1e140;

impl Default for View {
    /// From above (y), a side, and from where z is negative: there models of animals tend to have their faces.
    fn default() -> Self {
        Self { from: Vector3::new(-0.6, 0.35, -1.0), up: Vector3::new(0.0, 1.0, 0.0), pixels: 1600 }
    }
}

impl View {
    /// A view of what fills a box: the default, and of what lies flat along z, from above (z) instead.
    pub fn of(bounds: Aabb3) -> Self {
        let extent = bounds.extent();
        let lies_flat = extent.z < FLAT * extent.x.min(extent.y);
        let above = Self { from: Vector3::new(0.35, -1.0, 0.85), up: Vector3::new(0.0, 0.0, 1.0), ..Self::default() };
        if lies_flat { above } else { Self::default() }
    }
}

/// Maps space to pixels: x to the right, y down, and a third coordinate towards the eye, in pixels too.
pub(super) struct Camera {
    /// To the right, up, and to the eye.
    axes: [Vector3; 3],
    /// Somewhere in the scene.
    origin: Point3,
    pub(super) frame: Frame,
}

impl Camera {
    /// A camera that sees the whole scene.
    ///
    /// # Errors
    /// [`Error::Parse`] for directions that are none, [`Error::Limit`] for too many pixels.
    pub(super) fn new(scene: &Scene, view: &View) -> Result<Self> {
        if view.pixels > LARGEST {
            let what = format!("a picture of a surface {} pixels wide; the limit is {LARGEST} pixels", view.pixels);
            return Err(Error::limit(what, "make the picture narrower"));
        }
        let axes = axes(view)?;
        let drawable = || scene.points().filter(|&p| is_drawable(p));
        let origin = drawable().next().unwrap_or_default();
        let flat = drawable().map(|p| Point::new(axes[0].dot(p - origin), axes[1].dot(p - origin)));
        let none = Aabb { min: Point::default(), max: Point::default() };
        let frame = Frame::new(Aabb::of(flat).unwrap_or(none), f64::from(view.pixels.max(SMALLEST)), |_| 1.0);
        Ok(Self { axes, origin, frame })
    }

    /// A point in pixels; `None` where it is not finite.
    pub(super) fn place(&self, p: Point3) -> Option<[f64; 3]> {
        let [x, y, towards] = self.axes.map(|axis| axis.dot(p - self.origin));
        let [x, y] = self.frame.pixels_at(Point::new(x, y));
        is_drawable(p).then_some([x, y, self.frame.pixels(towards)])
    }

    /// A direction: its parts to the right, up and to the eye.
    pub(super) fn turn(&self, v: Vector3) -> Vector3 {
        let [x, y, z] = self.axes.map(|axis| axis.dot(v));
        Vector3::new(x, y, z)
    }
}

fn is_drawable(p: Point3) -> bool {
    p.to_array().iter().all(|x| x.abs() < HUGE)
}

/// To the right, up, and to the eye: orthogonal unit vectors.
fn axes(view: &View) -> Result<[Vector3; 3]> {
    let help = "give a direction that is finite and not zero, such as (0, 0, 1)";
    let what = |name: &str, v: Vector3| format!("the direction {name} is ({}, {}, {})", v.x, v.y, v.z);
    let towards = view.from.unit().ok_or_else(|| Error::parse("view", what("to the eye", view.from), help))?;
    let up = view.up.unit().ok_or_else(|| Error::parse("view", what("upwards", view.up), help))?;
    // Where up is the direction of the eye itself, any direction will do.
    let right = up.cross(towards);
    let right = if right.norm() > 1e-9 { right.unit().unwrap_or_default() } else { towards.perpendicular() };
    Ok([right, towards.cross(right), towards])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_a_right_handed_frame() {
        let up = Vector3::new(0.0, 0.0, 2.0);
        for from in [Vector3::new(3.0, -1.0, 0.5), Vector3::new(0.0, 0.0, 7.0), Vector3::new(0.0, 0.0, -1.0)] {
            let [x, y, z] = axes(&View { from, up, pixels: 100 }).unwrap();
            assert!((x.cross(y) - z).norm() < 1e-12 && (z - from.unit().unwrap()).norm() < 1e-12);
            assert!(up.dot(x).abs() < 1e-12 && up.dot(y) >= 0.0);
        }
    }

    #[test]
    fn directions_that_are_none_are_named() {
        let (zero, nan) = (Vector3::default(), Vector3::new(f64::NAN, 0.0, 1.0));
        for (view, name) in [
            (View { from: zero, ..View::default() }, "to the eye"),
            (View { from: nan, ..View::default() }, "to the eye"),
            (View { up: zero, ..View::default() }, "upwards"),
        ] {
            let error = Camera::new(&Scene::default(), &view).err().unwrap();
            assert!(error.to_string().contains(name), "{error}");
        }
        let error = Camera::new(&Scene::default(), &View { pixels: 100_000, ..View::default() }).err().unwrap();
        assert!(matches!(error, Error::Limit { .. }), "{error}");
    }

    #[test]
    fn what_lies_flat_is_seen_from_above() {
        let of = |z: f64| View::of(Aabb3 { min: Point3::default(), max: Point3::new(2.0, 2.0, z) });
        assert_eq!(of(0.5).up, Vector3::new(0.0, 0.0, 1.0));
        assert_eq!(of(2.0), View::default());
    }
}
