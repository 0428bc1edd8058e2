//! The closest point of a surface.

use super::super::Place;
use super::Surface;
use crate::geometry::{Aabb3, BoxTree, Point3, Vector3};
use crate::triangulation::FaceId;

/// The triangles of a surface in a tree of boxes: one search costs about the logarithm of their number.
#[derive(Clone, Debug)]
pub(crate) struct Nearest {
    tree: BoxTree<Triangle, 3>,
}

/// What of a surface is closest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Closest {
    /// The closest point, and where on the surface it is.
    pub place: Place,
    /// Its distance.
    pub distance: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Triangle {
    corners: [Point3; 3],
    face: FaceId,
}

impl Nearest {
    /// Puts all triangles of a surface into a tree.
    pub(crate) fn new(surface: &Surface) -> Self {
        Self::numbered(surface.topology().faces().map(|face| Triangle { corners: surface.triangle(face), face }))
    }

    /// Puts triangles of no surface into a tree; they are numbered.
    pub(crate) fn of(triangles: impl Iterator<Item = [Point3; 3]>) -> Self {
        Self::numbered(triangles.zip(0..).map(|(corners, i)| Triangle { corners, face: FaceId(i) }))
    }

    fn numbered(triangles: impl Iterator<Item = Triangle>) -> Self {
        Self { tree: BoxTree::new(triangles.filter_map(|t| Some((Aabb3::of(t.corners)?.into(), t)))) }
    }

    /// The distance of `p` to the closest triangle. `None` without triangles, or where `p` is not finite.
    pub(crate) fn distance(&self, p: Point3) -> Option<f64> {
        Some(self.closest_of(p)?.2)
    }

    /// The point of the surface that is closest to `p`; of several, one. `surface` is the one the tree was made of.
    /// `None` where `p` is not finite.
    pub(crate) fn closest(&self, surface: &Surface, p: Point3) -> Option<Closest> {
        if !p.is_finite() {
            return None;
        }
        let found = self.nearest(p)?;
        let place = surface.place(found.face, closest_weights(found.corners, p));
        Some(Closest { place, distance: place.position.distance(p) })
    }

    /// The place that is closest to a finite point, of triangles that face the way of a normal; of all where none does.
    pub(crate) fn closest_facing(&self, surface: &Surface, p: Point3, normal: Vector3) -> Option<Place> {
        let is_facing = |[a, b, c]: [Point3; 3]| (b - a).cross(c - a).dot(normal) > 0.0;
        let square = |t: &Triangle| if is_facing(t.corners) { t.square(p) } else { f64::INFINITY };
        let found = self.tree.nearest(p.to_array(), square).filter(|found| is_facing(found.corners));
        let found = found.or_else(|| self.nearest(p))?;
        Some(surface.place(found.face, closest_weights(found.corners, p)))
    }

    /// The number of the closest triangle, of those put in, the weights of its closest point, and how far that is. `None` as of
    /// [`Nearest::distance`].
    pub(crate) fn closest_of(&self, p: Point3) -> Option<(u32, [f64; 3], f64)> {
        let found = if p.is_finite() { self.nearest(p) } else { None }?;
        let weights = closest_weights(found.corners, p);
        Some((found.face.0, weights, Point3::weighted(found.corners, weights).distance(p)))
    }

    /// The numbers of triangles whose boxes meet a box, with their corners.
    pub(crate) fn meeting(&self, bounds: Aabb3) -> impl Iterator<Item = (u32, [Point3; 3])> {
        self.tree.meeting(bounds.into()).map(|t| (t.face.0, t.corners))
    }

    /// The triangle that is closest to a finite point, if its squared distance is less than this; at infinity any is.
    pub(crate) fn nearer(&self, p: Point3, than: f64) -> Option<FaceId> {
        self.tree.nearer(p.to_array(), than, |t| t.square(p)).map(|t| t.face)
    }

    fn nearest(&self, p: Point3) -> Option<&Triangle> {
        self.tree.nearest(p.to_array(), |t| t.square(p))
    }
}

impl Triangle {
    /// The squared distance of a point.
    fn square(&self, p: Point3) -> f64 {
        let offset = Point3::weighted(self.corners, closest_weights(self.corners, p)) - p;
        offset.dot(offset)
    }
}

/// Barycentric coordinates of the point of a triangle that is closest to `p`.
pub(crate) fn closest_weights([a, b, c]: [Point3; 3], p: Point3) -> [f64; 3] {
    let normal = (b - a).cross(c - a);
    let part = |q: Point3, r: Point3| normal.dot((q - p).cross(r - p));
    let parts = [part(b, c), part(c, a), part(a, b)];
    let total = normal.dot(normal);
    if total > 0.0 && parts.iter().all(|&part| part >= 0.0) {
        let [_, s, t] = parts.map(|part| part / total);
        return [1.0 - s - t, s, t];
    }
    // Only a side that the point is beyond can be closest.
    match parts.map(|part| part < 0.0) {
        [true, false, false] => {
            let t = p.share_between(b, c);
            [0.0, 1.0 - t, t]
        }
        [false, true, false] => {
            let t = p.share_between(c, a);
            [t, 0.0, 1.0 - t]
        }
        [false, false, true] => {
            let t = p.share_between(a, b);
            [1.0 - t, t, 0.0]
        }
        _ => p.nearest_on_sides([a, b, c]).1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::torus;
    use crate::test_cases::cases;
    use proptest::prelude::*;

    /// Distance to a triangle by narrowing both of its coordinates: slow, simple, and of other arithmetic.
    fn by_narrowing([a, b, c]: [Point3; 3], p: Point3) -> f64 {
        fn least(most: f64, f: &dyn Fn(f64) -> f64) -> f64 {
            let (mut low, mut high) = (0.0, most);
            for _ in 0..100 {
                let (s, t) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                if f(s) < f(t) { high = t } else { low = s }
            }
            f(0.5 * (low + high))
        }
        // Convex in both together, and so is what is left of it when one is chosen best.
        least(1.0, &|u| least(1.0 - u, &|v| (a + (b - a) * u + (c - a) * v).distance(p)))
    }

    proptest! {
        #![proptest_config(cases(64))]
        #[test]
        fn distance_to_one_triangle(q in prop::array::uniform12(-1.0..1.0)) {
            let [a, b, c, p] = [0, 3, 6, 9].map(|i| Point3::new(q[i], q[i + 1], q[i + 2]));
            let distance = Point3::weighted([a, b, c], closest_weights([a, b, c], p)).distance(p);
            prop_assert!((distance - by_narrowing([a, b, c], p)).abs() < 1e-7, "{distance}");
        }

        #[test]
        fn the_tree_finds_what_a_loop_finds(x in -4.0..4.0, y in -4.0..4.0, z in -2.0..2.0) {
            let surface = torus(2.0, 0.7, 0.8).unwrap();
            let p = Point3::new(x, y, z);
            let truth = surface.topology().faces().map(|f| {
                let corners = surface.triangle(f);
                Point3::weighted(corners, closest_weights(corners, p)).distance(p)
            });
            let truth = truth.fold(f64::INFINITY, f64::min);
            let found = Nearest::new(&surface).closest(&surface, p).unwrap();
            prop_assert!((found.distance - truth).abs() < 1e-13);
            prop_assert!((found.place.weights.iter().sum::<f64>() - 1.0).abs() < 1e-14);
            prop_assert!(found.place.weights.iter().all(|&w| w >= -1e-14));
        }
    }

    #[test]
    fn places_that_are_not_finite_have_no_closest_point() {
        let surface = torus(2.0, 0.7, 0.8).unwrap();
        assert_eq!(Nearest::new(&surface).closest(&surface, Point3::new(f64::NAN, 0.0, 0.0)), None);
    }
}
