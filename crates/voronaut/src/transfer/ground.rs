//! Where on the old mesh places of the new one are: in the plane by its locator, on a surface by closest points, of triangles that face
//! the same way.

use crate::error::Result;
use crate::geometry::{Aabb3, Point, Point3, TangentPlane, Vector, Vector3};
use crate::manifold::surface::Nearest;
use crate::mesh::{Located, Locator, Mesh};

/// An old mesh, ready for searches by any number of threads.
pub(super) enum Ground {
    Plane(Locator),
    Surface(Nearest),
}

/// Old and new triangles are looked for from each other as far as this share of the longest side of the new one: a mesh strays from a
/// surface by an eighth of its sides where these turn by a radian.
pub(super) const ASIDE: f64 = 0.25;
/// Triangles whose normals are farther apart than the angle of this cosine are of other sides of the surface.
const FACING: f64 = 0.25;

impl Ground {
    /// For two meshes: both planar, or both of a surface.
    ///
    /// # Errors
    /// [`Error::Domain`] where a mesh has no triangles, is not finite, or refers to vertices it does not have; where one is planar and
    /// the other is not.
    pub(super) fn new(old: &Mesh, new: &Mesh) -> Result<Self> {
        if old.is_planar() || new.is_planar() {
            let locator = Locator::new(old, "the old mesh")?;
            Locator::check(new, "the new mesh")?;
            return Ok(Self::Plane(locator));
        }
        Locator::check_numbers(old, "the old mesh")?;
        Locator::check_numbers(new, "the new mesh")?;
        Ok(Self::Surface(Nearest::of(old.triangles.iter().map(|&t| old.positions_of(t)))))
    }

    pub(super) fn is_planar(&self) -> bool {
        matches!(self, Self::Plane(_))
    }

    /// The point of the old mesh that is nearest to a finite one.
    pub(super) fn locate(&self, p: Point3) -> Option<Located> {
        match self {
            Self::Plane(locator) => locator.locate(Point::new(p.x, p.y)),
            Self::Surface(nearest) => {
                let (triangle, weights, distance) = nearest.closest_of(p)?;
                Some(Located { triangle, weights, distance })
            }
        }
    }

    /// Puts into `found` the numbers, ascending, of all old triangles that may have area in common with a new one.
    pub(super) fn near(&self, triangle: [Point3; 3], found: &mut Vec<u32>) {
        match self {
            Self::Plane(locator) => locator.near(triangle.map(|p| Point::new(p.x, p.y)), found),
            Self::Surface(nearest) => {
                found.clear();
                let Some(bounds) = Aabb3::of(triangle) else { return };
                let aside = ASIDE * Point3::longest_side(triangle);
                let margin = Vector3::new(aside, aside, aside);
                let bounds = Aabb3 { min: bounds.min + margin * -1.0, max: bounds.max + margin };
                let normal = across(triangle);
                let is_facing = |corners: [Point3; 3]| {
                    let other = across(corners);
                    other.dot(normal) > FACING * other.norm() * normal.norm()
                };
                found.extend(nearest.meeting(bounds).filter(|&(_, corners)| is_facing(corners)).map(|(i, _)| i));
                found.sort_unstable();
            }
        }
    }

    /// The plane that a new triangle and what is near it are seen in.
    pub(super) fn flat(&self, triangle: [Point3; 3]) -> Flat {
        let plane = match self {
            Self::Plane(_) => None,
            Self::Surface(_) => across(triangle).unit().map(TangentPlane::new),
        };
        Flat { origin: triangle[0], plane }
    }
}

fn across([a, b, c]: [Point3; 3]) -> Vector3 {
    (b - a).cross(c - a)
}

/// A plane that points are seen in: x and y, or that of a triangle.
pub(super) struct Flat {
    origin: Point3,
    plane: Option<TangentPlane>,
}

impl Flat {
    pub(super) fn of(&self, p: Point3) -> Point {
        let Some(plane) = &self.plane else { return Point::new(p.x, p.y) };
        let Vector { x, y } = plane.flatten(p - self.origin);
        Point::new(x, y)
    }
}
