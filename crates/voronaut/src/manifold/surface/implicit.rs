//! Surfaces f(x, y, z) = 0: their curvatures, and the way onto them.

use crate::geometry::{Jet3, Point3, TangentPlane, Tensor3, Vector3};
use crate::metric::Expression;

/// A function of space whose zeros are a surface.
pub trait Implicit: Sync {
    /// f at a point.
    fn value(&self, p: Point3) -> f64;

    /// f, its gradient and its Hessian at a point.
    fn jet(&self, p: Point3) -> Jet3;
}

impl Implicit for Expression {
    fn value(&self, p: Point3) -> f64 {
        self.at(p.x, p.y, p.z)
    }

    fn jet(&self, p: Point3) -> Jet3 {
        Expression::jet(self, p)
    }
}

/// Principal curvatures at a point of a surface, in units of 1 / length; positive where the surface bends away from its
/// normal, as a sphere does from its outer one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Curvatures {
    /// First that of the larger absolute value.
    pub values: [f64; 2],
    /// Unit tangents along which the surface bends so, perpendicular to each other.
    pub axes: [Vector3; 2],
    /// Unit normal.
    pub normal: Vector3,
}

impl Curvatures {
    /// From the symmetric shape operator in the coordinates of a tangent plane.
    pub(super) fn of(shape: crate::geometry::Tensor, plane: &TangentPlane) -> Self {
        let eigen = shape.eigen();
        let (values, axes) = ([eigen.large, eigen.small], [eigen.axis, eigen.axis.perpendicular()]);
        let [i, j] = if values[0].abs() >= values[1].abs() { [0, 1] } else { [1, 0] };
        Self { values: [values[i], values[j]], axes: [i, j].map(|k| plane.lift(axes[k])), normal: plane.normal }
    }

    /// The metric of RR-9103, 15.1: eigenvalues |c| along the principal directions, at least `floor` (positive), so that
    /// it stays positive definite where the surface is flat, and at most `cap`. An edge of metric length 1 strays about an eighth of a unit of
    /// length from the surface. Across it, where no edge sees anything, the larger of both.
    pub(crate) fn metric(&self, [floor, cap]: [f64; 2]) -> Tensor3 {
        let [most, least] = self.values.map(|c| c.abs().min(cap).max(floor));
        Tensor3::from_axes([self.axes[0], self.axes[1], self.normal], [most, least, most])
    }
}

/// The principal curvatures of the level surface of f through a point, with grad f as normal: the eigenvalues of
/// P (H / |grad f|) P in the tangent plane (RR-9103, 15.1; as printed H is multiplied by |grad f|: for a sphere of radius
/// R that gives 4 R, not 1 / R). `None` where the gradient is zero or not finite.
pub(crate) fn curvatures(jet: &Jet3) -> Option<Curvatures> {
    let normal = jet.gradient.unit()?;
    let plane = TangentPlane::new(normal);
    let shape = plane.restrict(jet.hessian) * (1.0 / jet.gradient.norm());
    Some(Curvatures::of(shape, &plane))
}

/// Newton's steps, most of which a good start does not need.
const STEPS: usize = 50;

/// The point of f = 0 that Newton's method along the gradient reaches from `p`, with |f| / |grad f| at most `tolerance`
/// (a length); `None` where it goes farther than `reach` from `p`, or finds no gradient.
pub(crate) fn project(f: &dyn Implicit, p: Point3, reach: f64, tolerance: f64) -> Option<Point3> {
    project_pinned(f, p, Pins::default(), reach, tolerance)
}

/// The point of f = 0 that Newton's method along a unit vector reaches from `p`, to `tolerance` (a length), and the surface's normal there; `None` where
/// it goes farther than `reach` from `p`, or the gradient's cosine with the vector is less than `least` on the way.
pub(crate) fn project_along(
    f: &dyn Implicit,
    p: Point3,
    up: Vector3,
    least: f64,
    [reach, tolerance]: [f64; 2],
) -> Option<(Point3, Vector3)> {
    let mut height = 0.0_f64;
    for _ in 0..STEPS {
        let q = p + up * height;
        let jet = f.jet(q);
        let normal = jet.gradient.unit()?;
        let slope = normal.dot(up);
        if slope.is_nan() || slope < least || height.abs() > reach {
            return None;
        }
        let step = jet.value / jet.gradient.dot(up);
        if step.abs() <= tolerance {
            return Some((q, normal));
        }
        height -= step;
    }
    None
}

/// Which coordinates of a point stay as they are.
pub(super) type Pins = [bool; 3];

/// As [`project`], along the part of the gradient that leaves the pinned coordinates alone.
pub(crate) fn project_pinned(f: &dyn Implicit, p: Point3, pins: Pins, reach: f64, tolerance: f64) -> Option<Point3> {
    let mut q = p;
    for _ in 0..STEPS {
        let jet = f.jet(q);
        if jet.value == 0.0 {
            return Some(q);
        }
        let gradient = unpinned(jet.gradient, pins);
        let step = gradient * (jet.value / gradient.dot(gradient));
        let length = step.norm();
        if !length.is_finite() {
            return None;
        }
        if length <= tolerance {
            return Some(q);
        }
        q = q + step * -1.0;
        if q.distance(p) > reach {
            return None;
        }
    }
    None
}

/// A point of f = 0 that is closest to `p` as far as steps along the surface tell, from where [`project`] takes `start`: the
/// rest of the way is across it, to 1e-3 of the distance. `None` where `project` finds nothing from `start`.
pub(crate) fn closest_zero(f: &dyn Implicit, p: Point3, start: Point3, reach: f64, tolerance: f64) -> Option<Point3> {
    /// Across enough: its effect on the distance is half the square.
    const ACROSS: f64 = 1e-3;
    let mut q = project(f, start, reach, tolerance)?;
    for _ in 0..STEPS {
        let Some(normal) = f.jet(q).gradient.unit() else { break };
        let way = p - q;
        let along = way - normal * way.dot(normal);
        if along.norm() <= tolerance.max(ACROSS * way.norm()) {
            break;
        }
        // Steps that do not come nearer are halved: far from the surface they may lead anywhere.
        let steps = [1.0, 0.5, 0.25, 0.125].into_iter();
        let tries = steps.filter_map(|share| project(f, q + along * share, reach, tolerance));
        let Some(next) = tries.into_iter().find(|next| next.distance(p) < way.norm()) else { break };
        q = next;
    }
    Some(q)
}

/// The part of a vector along coordinates that are not pinned.
pub(super) fn unpinned(v: Vector3, [x, y, z]: Pins) -> Vector3 {
    let free = |pinned: bool, coordinate: f64| if pinned { 0.0 } else { coordinate };
    Vector3::new(free(x, v.x), free(y, v.y), free(z, v.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::Variables;

    fn surface(text: &str) -> Expression {
        Expression::parse(text, Variables::Space).unwrap()
    }

    #[test]
    fn spheres_of_any_radius_and_equation() {
        for (text, factor) in [("x^2+y^2+z^2-9", 1.0), ("(x^2+y^2+z^2)^2-81", 1.0), ("3-sqrt(x^2+y^2+z^2)", -1.0)] {
            let p = Point3::new(1.0, -2.0, 2.0);
            let c = curvatures(&surface(text).jet(p)).unwrap();
            for value in c.values {
                assert!((value * factor - 1.0 / 3.0).abs() < 1e-14, "{text}: {value}");
            }
        }
    }

    #[test]
    fn torus_in_closed_form() {
        let (big, small) = (2.0, 0.7);
        let f = surface("(sqrt(x^2+y^2)-2)^2+z^2-0.7^2");
        for step in 0..20 {
            let (around, tube) = (0.3 * f64::from(step), 0.7 * f64::from(step));
            let ring = big + small * tube.cos();
            let p = Point3::new(ring * around.cos(), ring * around.sin(), small * tube.sin());
            let mut truth = [1.0 / small, tube.cos() / ring];
            truth.sort_by(|a, b| b.abs().total_cmp(&a.abs()));
            let c = curvatures(&f.jet(p)).unwrap();
            for (value, truth) in c.values.into_iter().zip(truth) {
                assert!((value - truth).abs() < 1e-12, "{value} {truth}");
            }
            let along = Vector3::new(-around.sin(), around.cos(), 0.0);
            assert!(c.axes[1].dot(along).abs() > 1.0 - 1e-12, "the larger curvature runs around the tube");
        }
    }

    #[test]
    fn metrics_stay_positive_definite_on_flat_parts() {
        let c = curvatures(&surface("z - 2*x^2").jet(Point3::default())).unwrap();
        let m = c.metric([0.25, f64::INFINITY]);
        assert!((m.xx - 4.0).abs() < 1e-14 && (m.yy - 0.25).abs() < 1e-14 && (m.zz - 4.0).abs() < 1e-14, "{m:?}");
        assert!(curvatures(&surface("x^2+y^2-z^2").jet(Point3::default())).is_none(), "a cone's apex has no normal");
    }

    #[test]
    fn newton_lands_on_the_surface_or_says_that_it_does_not() {
        let f = surface("x^2+y^2+z^2-1");
        let p = project(&f, Point3::new(0.6, 0.5, 0.9), 1.0, 1e-14).unwrap();
        assert!(((p - Point3::default()).norm() - 1.0).abs() < 1e-14);
        assert_eq!(project(&f, Point3::new(0.1, 0.0, 0.0), 0.5, 1e-14), None, "too far");
        assert_eq!(project(&f, Point3::default(), 2.0, 1e-14), None, "no gradient");
        assert_eq!(project(&surface("x^2+1"), Point3::new(1.0, 0.0, 0.0), 2.0, 1e-14), None, "no zero");
    }
}
