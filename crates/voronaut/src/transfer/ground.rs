//! Where on the old mesh places of the new one are: in the plane by its locator, on a surface by closest points, of triangles that face
//! the same way.

use crate::error::Result;
use crate::geometry::{Aabb3, BoxTree, Point, Point3, TangentPlane, Vector, Vector3};
use crate::mesh::{Located, Locator, Mesh};
use crate::surface::closest_weights;

/// An old mesh, ready for searches by any number of threads.
pub(super) enum Ground {
    Plane(Locator),
    Surface { corners: Vec<[Point3; 3]>, tree: BoxTree<u32, 3> },
}

/// Old and new triangles are looked for from each other as far as this share of the longest side of the new one: a mesh strays from a
/// surface by an eighth of its sides where these turn by a radian.
const ASIDE: f64 = 0.25;
/// Triangles whose normals are farther apart than the angle of this cosine are of other sides of the surface.
const FACING: f64 = 0.25;

impl Ground {
    /// For two meshes: planar if both are.
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
        let corners: Vec<[Point3; 3]> = old.triangles.iter().map(|&t| old.positions_of(t)).collect();
        let boxed = corners.iter().zip(0..).filter_map(|(&corners, i)| Some((Aabb3::of(corners)?.into(), i)));
        let tree = BoxTree::new(boxed);
        Ok(Self::Surface { corners, tree })
    }

    pub(super) fn is_planar(&self) -> bool {
        matches!(self, Self::Plane(_))
    }

    /// The point of the old mesh that is nearest to a finite one.
    pub(super) fn locate(&self, p: Point3) -> Option<Located> {
        match self {
            Self::Plane(locator) => locator.locate(Point::new(p.x, p.y)),
            Self::Surface { corners, tree } => {
                let found = |&triangle: &u32| {
                    let corners = corners[triangle as usize];
                    let weights = closest_weights(corners, p);
                    (Point3::weighted(corners, weights).distance(p), weights)
                };
                let &triangle = tree.nearest(p.to_array(), |triangle| found(triangle).0.powi(2))?;
                let (distance, weights) = found(&triangle);
                Some(Located { triangle, weights, distance })
            }
        }
    }

    /// Puts into `found` the numbers, ascending, of all old triangles that may have area in common with a new one.
    pub(super) fn near(&self, triangle: [Point3; 3], found: &mut Vec<u32>) {
        match self {
            Self::Plane(locator) => locator.near(triangle.map(|p| Point::new(p.x, p.y)), found),
            Self::Surface { corners, tree } => {
                found.clear();
                let Some(bounds) = Aabb3::of(triangle) else { return };
                let aside = ASIDE * Point3::longest_side(triangle);
                let margin = Vector3::new(aside, aside, aside);
                let bounds = Aabb3 { min: bounds.min + margin * -1.0, max: bounds.max + margin };
                let normal = across(triangle);
                let is_facing = |&&i: &&u32| {
                    let other = across(corners[i as usize]);
                    other.dot(normal) > FACING * other.norm() * normal.norm()
                };
                found.extend(tree.meeting(bounds.into()).filter(is_facing).copied());
                found.sort_unstable();
            }
        }
    }

    /// The plane that a new triangle and what is near it are seen in.
    pub(super) fn flat(&self, triangle: [Point3; 3]) -> Flat {
        let plane = match self {
            Self::Plane(_) => None,
            Self::Surface { .. } => across(triangle).unit().map(TangentPlane::new),
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
