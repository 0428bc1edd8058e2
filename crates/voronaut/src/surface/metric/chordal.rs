//! Edges so short that a mesh stays near its surface.

use super::graded::{graded, grown};
use super::{Sampled, SurfaceMetric, fit_curvatures};
use crate::error::{Error, Result};
use crate::geometry::{Point3, TangentPlane, Tensor, Tensor3};
use crate::metric::Expression;
use crate::surface::{Curvatures, Input, Place, curvatures};

/// In a principal direction of curvature k edges are at most sqrt(CHORD D / |k|) long, for a distance D. An equilateral
/// triangle of such edges on a sphere is D away for a factor of 6; those of unit meshes are less regular. What it was chosen
/// by is in DESIGN.md.
pub const CHORD: f64 = 3.5;
/// Away from where the surface bends more, sizes grow by this times the distance.
const GROWTH: f64 = 0.5;

/// A field whose unit meshes stay within a distance D of the surface: in the tangent plane, the intersection
/// ([`Tensor::intersection`]) of another field with the metric that has the eigenvalue |k| / (CHORD D) along each principal
/// direction, k its curvature. Flat places leave the other field as it is, bit for bit.
///
/// What a field says of the normal direction becomes the larger tangential eigenvalue where it is changed. Curvatures tell
/// of faces: edges on creases and borders that bend within a flat face are not held near their curve.
pub struct Chordal<F> {
    field: F,
    bend: Bend,
}

/// The metric that curvatures ask for.
enum Bend {
    /// By an equation.
    Exact(Exact),
    /// Fitted at vertices, and graded.
    Fitted(Sampled),
}

/// By the equation f = 0: curvatures below the floor count as the floor, and are multiplied by a share.
struct Exact {
    f: Expression,
    floor: f64,
    share: f64,
}

impl<F: SurfaceMetric> Chordal<F> {
    /// The field with edges as short as a distance asks for, which is in the units of the surface. Where the surface has an
    /// equation, curvatures are exact, at the place and half an edge away from it on either side; else they are fitted at
    /// vertices ([`fit_curvatures`]), with log-Euclidean interpolation between them. Sizes grow by at most half the distance
    /// from where they are smaller. Where there are no curvatures (a cone's apex) the field is left as it is.
    ///
    /// # Errors
    /// [`Error::Parse`] of a distance that is not positive and finite; [`Error::Metric`] where curvatures are not finite.
    pub fn new(field: F, input: &Input, distance: f64) -> Result<Self> {
        if !(distance > 0.0 && distance.is_finite()) {
            let help = "give a positive length: how far mesh and surface may be from each other";
            return Err(Error::parse("hausd", format!("the distance {distance}"), help));
        }
        let share = 1.0 / (CHORD * distance);
        // No edge need be shorter than the diagonal where the surface is this flat.
        let floor = 1.0 / (share * input.diagonal() * input.diagonal());
        let bend = if let Some(f) = &input.implicit {
            Bend::Exact(Exact { f: f.clone(), floor, share })
        } else {
            let tensor = |c: Option<Curvatures>| c.map_or(Tensor3::IDENTITY * floor, |c| c.metric(floor)) * share;
            let tensors: Vec<Tensor3> = fit_curvatures(&input.surface).into_iter().map(tensor).collect();
            Bend::Fitted(Sampled::new(&input.surface, &graded(&input.surface, &tensors, GROWTH))?)
        };
        Ok(Self { field, bend })
    }
}

impl<F: SurfaceMetric> SurfaceMetric for Chordal<F> {
    fn at(&self, place: &Place) -> Tensor3 {
        let tensor = self.field.at(place);
        let plane = TangentPlane::new(place.normal);
        let own = plane.restrict(tensor);
        if !own.is_positive_definite() {
            return tensor;
        }
        let both = match &self.bend {
            Bend::Fitted(sampled) => own.intersection(plane.restrict(sampled.at(place))),
            Bend::Exact(exact) => exact.intersected(own, place.position, &plane),
        };
        if both == own { tensor } else { plane.extend(both, both.eigen().large) }
    }
}

impl Exact {
    /// A tensor of a tangent plane, with what the surface asks for there and around.
    fn intersected(&self, own: Tensor, at: Point3, plane: &TangentPlane) -> Tensor {
        let Some(here) = self.tensor(at) else { return own };
        let both = grown(here, plane, 0.0).map_or(own, |m| own.intersection(m));
        let eigen = here.1.eigen();
        // The surface does not look like its tangent plane farther away than its radius of curvature.
        let radius = self.share / eigen.large;
        let ways = [(eigen.axis, eigen.large), (eigen.axis.perpendicular(), eigen.small)];
        let around = ways.into_iter().flat_map(|(axis, value)| {
            let step = 0.5 * radius.min(1.0 / value.sqrt());
            [step, -step].map(|step| (at + here.0.lift(axis) * step, step.abs()))
        });
        around.fold(both, |both, (at, step)| {
            let m = self.tensor(at).and_then(|there| grown(there, plane, GROWTH * step));
            m.map_or(both, |m| both.intersection(m))
        })
    }

    /// What the level surface through a point asks for in its tangent plane; `None` where it has none.
    fn tensor(&self, at: Point3) -> Option<(TangentPlane, Tensor)> {
        let found = curvatures(&self.f.jet(at))?;
        let plane = TangentPlane::new(found.normal);
        let m = plane.restrict(found.metric(self.floor) * self.share);
        m.is_positive_definite().then_some((plane, m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::Bounds;
    use crate::surface::metric::{Constant, Spec, field};
    use crate::surface::read;
    use crate::triangulation::VertexId;

    #[test]
    fn sizes_are_those_of_the_curvature_or_smaller_ones_of_the_field() {
        let input = read("sphere:2", None).unwrap();
        let place = input.surface.place_of(VertexId(5)).unwrap();
        let sizes = |h: f64, distance: f64| {
            let found = Chordal::new(Constant(Tensor3::isotropic(h)), &input, distance).unwrap().at(&place);
            let normal = (place.position - crate::geometry::Point3::default()) * 0.5;
            let eigen = TangentPlane::new(normal).restrict(found).eigen();
            [eigen.large, eigen.small].map(|value| 1.0 / value.sqrt())
        };
        // k = 1 / 2.
        let asked = (CHORD * 0.01 * 2.0).sqrt();
        // Places of triangles have normals of triangles.
        assert!(sizes(1.0, 0.01).iter().all(|size| (size / asked - 1.0).abs() < 1e-2), "{:?}", sizes(1.0, 0.01));
        assert!(sizes(0.05, 0.01).iter().all(|size| (size / 0.05 - 1.0).abs() < 1e-9));
    }

    #[test]
    fn flat_places_are_left_alone_to_the_bit() {
        let input = read("implicit:z-0.1*x;-1,-1,-1,1,1,1", None).unwrap();
        let own = Tensor3::from_disk([40.0, 3.0, 90.0, -1.0, 2.0, 7.0]);
        let found = Chordal::new(Constant(own), &input, 1e-4).unwrap();
        for f in input.surface.topology().faces() {
            assert_eq!(found.at(&input.surface.place(f, [0.2, 0.3, 0.5])), own);
        }
    }

    #[test]
    fn it_is_below_neither_field() {
        let input = read("torus:2,0.7", None).unwrap();
        let shock = field(&Spec::parse("shock").unwrap(), &input, Bounds::default()).unwrap();
        let found = Chordal::new(shock.as_ref(), &input, 1e-3).unwrap();
        let curvature = field(&Spec::parse("curvature:floor=1e-9").unwrap(), &input, Bounds::default()).unwrap();
        for f in input.surface.topology().faces().step_by(5) {
            // Triangles are off the surface, and so are their normals.
            let place = input.surface.place(f, [0.4, 0.4, 0.2]);
            let place = input.lift(&place, place.position).unwrap();
            let plane = TangentPlane::new(place.normal);
            let near = curvature.at(&place) * (1.0 / (CHORD * 1e-3));
            let [m, a, b] = [found.at(&place), shock.at(&place), near].map(|m| plane.restrict(m));
            for i in 0..36 {
                let v = crate::geometry::Vector::new((0.1 * f64::from(i)).cos(), (0.1 * f64::from(i)).sin());
                assert!(m.dot(v, v) >= a.dot(v, v).max(b.dot(v, v)) * (1.0 - 1e-9), "{m:?} {a:?} {b:?}");
            }
        }
    }

    #[test]
    fn senseless_distances_are_named() {
        let input = read("sphere:1", Some(0.5)).unwrap();
        for distance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let error = Chordal::new(Constant(Tensor3::IDENTITY), &input, distance).err().unwrap();
            assert!(error.to_string().contains("hausd"), "{error}");
        }
    }
}
