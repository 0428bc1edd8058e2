//! The metric of a function's second derivatives along a surface: known at every place, or recovered from values at vertices.

use super::{Sampled, SurfaceMetric, fit_curvatures};
use crate::error::{Error, Result};
use crate::geometry::{Point3, TangentPlane, Tensor, Tensor3, Vector3};
use crate::manifold::surface::{Curvatures, Implicit, Surface, check_count};
use crate::manifold::{Manifold, Place};
use crate::metric::nodal::size;
use crate::metric::{Expression, FLOOR, Neighbours, Norm, Optimal, hessian_around, rounding};
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, VertexId};

/// The metric in which a unit mesh of a surface has the least L^p error of linear interpolation of a function of space on it, as
/// [`crate::metric::Hessian`] is of the plane: the absolute value of the function's second derivatives along geodesics,
///
/// > H(t, t) = t' D²u t + (grad u . n) II(t, t),
///
/// II(t, t) n the curvature of the geodesic along t: exact of an equation's surface, else fitted at vertices
/// ([`fit_curvatures`]) and linear between them.
pub(crate) struct CovariantHessian {
    function: Expression,
    bend: Bend,
    optimal: Optimal,
    floor: f64,
}

/// How a surface bends: II(t, t) = -t' S t, S the shape operator.
enum Bend {
    Equation(Expression),
    /// S at vertex slots, and the corners of face slots.
    Fitted(Vec<Tensor3>, Vec<[u32; 3]>),
}

/// Places that the mean is taken over, at least.
const PLACES: f64 = 20_000.0;

impl CovariantHessian {
    /// Of a function of x, y and z.
    ///
    /// # Errors
    /// [`Error::Metric`] where a second derivative is not finite, or where all are zero.
    pub(crate) fn new(function: &Expression, manifold: &Manifold, norm: Norm) -> Result<Self> {
        let bend = match &manifold.implicit {
            Some(f) => Bend::Equation(f.clone()),
            None => Bend::fitted(&manifold.surface),
        };
        let mut made = Self { function: function.clone(), bend, optimal: Optimal::new(norm), floor: 0.0 };
        let mean = mean_over(&manifold.surface, |place| {
            let greatest = size(made.second_derivatives(place).1);
            if greatest.is_finite() { Ok(greatest) } else { Err(not_finite(place)) }
        })?;
        made.floor = FLOOR * mean;
        if made.floor > 0.0 { Ok(made) } else { Err(vanishing()) }
    }

    /// The function along the surface.
    pub(crate) fn second_derivatives(&self, place: &Place) -> (TangentPlane, Tensor) {
        let jet = self.function.jet(place.position);
        let (normal, shape) = self.bend.at(place);
        let plane = TangentPlane::new(normal);
        (plane, plane.restrict(jet.hessian + shape * -jet.gradient.dot(normal)))
    }
}

impl SurfaceMetric for CovariantHessian {
    fn at(&self, place: &Place) -> Tensor3 {
        let (plane, hessian) = self.second_derivatives(place);
        tangent(&plane, hessian, &self.optimal, self.floor)
    }
}

/// The metric of second derivatives in a tangent plane, with the larger eigenvalue across it.
fn tangent(plane: &TangentPlane, hessian: Tensor, optimal: &Optimal, floor: f64) -> Tensor3 {
    let wanted = optimal.of(hessian, floor);
    plane.extend(wanted, wanted.eigen().large)
}

impl Bend {
    fn fitted(surface: &Surface) -> Self {
        // Where nothing could be fitted the surface counts as flat.
        let shape =
            |c: Curvatures| Tensor3::from_axes([c.axes[0], c.axes[1], c.normal], [c.values[0], c.values[1], 0.0]);
        let shapes = fit_curvatures(surface).into_iter().map(|fit| fit.map_or(Tensor3::default(), shape)).collect();
        let t = surface.topology();
        let corners = |f: u32| if t.is_face(FaceId(f)) { t.corners(FaceId(f)).map(|v| v.0) } else { [0; 3] };
        Self::Fitted(shapes, (0..t.face_slots() as u32).map(corners).collect())
    }

    /// The unit normal, and what in its plane is the shape operator, at a place.
    fn at(&self, place: &Place) -> (Vector3, Tensor3) {
        match self {
            Self::Equation(f) => {
                let jet = Implicit::jet(f, place.position);
                // Where there is no normal, nothing is finite.
                (jet.gradient.unit().unwrap_or(place.normal), jet.hessian * (1.0 / jet.gradient.norm()))
            }
            Self::Fitted(shapes, corners) => {
                let shapes = corners[place.face.index()].map(|v| shapes[v as usize]);
                (place.normal, Tensor3::weighted(shapes, place.weights))
            }
        }
    }
}

/// The mean of a number over a surface, at the middles of parts of its triangles.
fn mean_over(surface: &Surface, value: impl Fn(&Place) -> Result<f64> + Sync) -> Result<f64> {
    let faces: Vec<FaceId> = surface.topology().faces().collect();
    let total: f64 = faces.iter().map(|&f| area(surface.triangle(f))).sum();
    let of_face = |&f: &FaceId| {
        let area = area(surface.triangle(f));
        let parts = (area / total * PLACES).sqrt().ceil().max(1.0) as u32;
        let step = 1.0 / f64::from(parts);
        // Upright parts and, in the gaps between them, upside-down ones.
        let middles = (0..parts).flat_map(|i| (0..parts - i).flat_map(move |j| [[i, j, 0], [i, j, 1]]));
        let mut sum = 0.0;
        for [i, j, k] in middles.filter(|&[i, j, k]| i + j + k < parts) {
            let [s, t] = [i, j].map(|i| (f64::from(i) + f64::from(1 + k) / 3.0) * step);
            sum += value(&surface.place(f, [1.0 - s - t, s, t]))?;
        }
        Ok(sum * area * step * step)
    };
    let sums = faces.par_iter().map(of_face).collect::<Result<Vec<f64>>>()?;
    Ok(sums.iter().sum::<f64>() / total)
}

/// The metric of second derivatives recovered from values at the vertices that the surface has: around each a quadratic is fitted in
/// its tangent plane, whose second derivatives in the middle are those along geodesics. Between vertices it is log-Euclidean.
///
/// Of vertices whose triangles turn away from each other no quadratic is made; these have the mean of their neighbours' logarithms.
///
/// # Errors
/// [`Error::Metric`] unless there is one finite value for each vertex, and where all second derivatives vanish.
pub(crate) fn recovered_on(manifold: &Manifold, values: &[f64], norm: Norm) -> Result<Sampled> {
    let surface = &manifold.surface;
    let found = hessians_on(surface, values)?;
    let t = surface.topology();
    let mean = weighted_mean(surface, |v| found[v.index()].as_ref().map_or(0.0, |(_, hessian)| size(*hessian)));
    let area = t.faces().map(|f| area(surface.triangle(f))).sum::<f64>();
    if mean <= rounding(values, area) || FLOOR * mean == 0.0 {
        return Err(vanishing());
    }
    let optimal = Optimal::new(norm);
    let metric = |(plane, hessian): &(TangentPlane, Tensor)| tangent(plane, *hessian, &optimal, FLOOR * mean);
    let fits: Vec<Option<Tensor3>> = found.iter().map(|found| found.as_ref().map(metric)).collect();
    let least = optimal.of(Tensor::default(), FLOOR * mean);
    Sampled::filled(surface, &fits, Tensor3::IDENTITY * least.xx)
}

/// Second derivatives recovered in the tangent planes at vertices; nothing of vertices whose triangles turn away from each other.
///
/// # Errors
/// [`Error::Metric`] unless there is one finite value for each vertex.
pub(crate) fn hessians_on(surface: &Surface, values: &[f64]) -> Result<Vec<Option<(TangentPlane, Tensor)>>> {
    check_count(values.len(), surface.positions().len())?;
    let t = surface.topology();
    if let Some(v) = t.vertices().find(|v| !values[v.index()].is_finite()) {
        let what = format!("the solution's value {} is not finite", values[v.index()]);
        return Err(Error::metric(what, format!("vertex {} {}", v.0 + 1, surface.position(v)), "correct the solution"));
    }
    let normals: Vec<Option<Vector3>> = (0..values.len() as u32).map(|v| surface.vertex_normal(VertexId(v))).collect();
    let around = Neighbours::of_triangles(values.len(), t.faces().map(|f| t.corners(f).map(|v| v.0)), []);
    let recovered = |v: u32| {
        let plane = TangentPlane::new(normals[v as usize]?);
        let origin = surface.position(VertexId(v));
        let offset = |w: u32| {
            let is_this_side = normals[w as usize]?.dot(plane.normal) > FACING;
            is_this_side.then(|| plane.flatten(surface.position(VertexId(w)) - origin))
        };
        Some((plane, hessian_around(&around, values, v, offset)?))
    };
    Ok((0..values.len() as u32).into_par_iter().map(recovered).collect())
}

/// Vertices whose normals are more than 60 degrees from one's own are of another side.
const FACING: f64 = 0.5;

/// The mean over the area of what is linear on every triangle.
fn weighted_mean(surface: &Surface, value: impl Fn(VertexId) -> f64) -> f64 {
    let t = surface.topology();
    let (mut sum, mut total) = (0.0, 0.0);
    for f in t.faces() {
        let area = area(surface.triangle(f));
        sum += area * t.corners(f).map(&value).iter().sum::<f64>() / 3.0;
        total += area;
    }
    sum / total
}

fn area([a, b, c]: [Point3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).norm()
}

fn not_finite(place: &Place) -> Error {
    let help = "give a function with two derivatives on the whole surface";
    Error::metric("the function's second derivatives are not finite", place.position.to_string(), help)
}

fn vanishing() -> Error {
    let help = "its interpolation is exact on any mesh: use another metric, such as uniform or curvature";
    Error::metric("the function's second derivatives vanish everywhere", "the whole surface", help)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::{sphere, torus};
    use crate::metric::Variables;

    fn infinite() -> Norm {
        Norm::new(f64::INFINITY).unwrap()
    }

    fn function(text: &str) -> Expression {
        Expression::parse(text, Variables::Space).unwrap()
    }

    /// The greatest difference, in the tangent plane, from what it is in closed form.
    fn greatest_error(
        field: &dyn SurfaceMetric,
        surface: &Surface,
        truth: impl Fn(&Place) -> (TangentPlane, Tensor),
    ) -> f64 {
        let error = |f: FaceId| {
            let place = surface.place(f, [0.5, 0.2, 0.3]);
            let (plane, truth) = truth(&place);
            let d = plane.restrict(field.at(&place)) + truth * -1.0;
            d.xx.abs().max(d.xy.abs()).max(d.yy.abs())
        };
        surface.topology().faces().map(error).fold(0.0, f64::max)
    }

    /// Along great circles x is a sine: its second derivatives are -x in all directions, though in space they are zero.
    fn of_x(place: &Place) -> (TangentPlane, Tensor) {
        let p = place.position - Point3::default();
        (TangentPlane::new(p.unit().unwrap()), Tensor::IDENTITY * (p.x.abs() / p.norm()).max(1e-3))
    }

    #[test]
    fn coordinates_of_the_sphere_are_curved_on_it() {
        let manifold = Manifold::shape("sphere:1", Some(0.2)).unwrap();
        let exact = CovariantHessian::new(&function("x"), &manifold, infinite()).unwrap();
        let on_equation = |place: &Place| manifold.lift(place, place.position).unwrap();
        for f in manifold.topology().faces() {
            let place = on_equation(&manifold.place(f, [0.5, 0.2, 0.3]));
            let (plane, truth) = of_x(&place);
            let d = plane.restrict(exact.at(&place)) + truth * -1.0;
            assert!(place.position.x.abs() < 1e-3 || d.xx.abs() + d.xy.abs() + d.yy.abs() < 1e-12, "{d:?}");
        }
    }

    #[test]
    fn fitted_and_recovered_ones_come_near() {
        let errors: Vec<[f64; 2]> = [0.2, 0.1]
            .map(|size| {
                let manifold = Manifold::new(sphere(1.0, size).unwrap(), None);
                let values: Vec<f64> = manifold.positions().iter().map(|p| p.x).collect();
                let fitted = CovariantHessian::new(&function("x"), &manifold, infinite()).unwrap();
                let recovered = recovered_on(&manifold, &values, infinite()).unwrap();
                let error = |field: &dyn SurfaceMetric| greatest_error(field, &manifold.surface, of_x);
                [error(&fitted), error(&recovered)]
            })
            .to_vec();
        // Fits at vertices are of second order; between them the kink of |x| at its zero is of the first.
        assert!(errors[0].iter().all(|&e| e < 0.1), "{errors:?}");
        assert!((0..2).all(|i| errors[1][i] < 0.65 * errors[0][i]), "{errors:?}");
    }

    #[test]
    fn a_tilted_plane_is_a_plane() {
        // Two triangles each of a grid, turned about an axis; u = (3 s^2 - s t + t^2 / 2) of plane coordinates s and t.
        let (along, up) = (Vector3::new(0.6, 0.0, 0.8), Vector3::new(0.0, 1.0, 0.0));
        let point = |k: u32| Point3::default() + along * f64::from(k % 9) + up * f64::from(k / 9);
        let cell = |k: u32| {
            let a = k % 8 + k / 8 * 9;
            [[a, a + 1, a + 10], [a, a + 10, a + 9]]
        };
        let mesh = crate::mesh::Mesh {
            points: (0..81).map(|k| point(k).to_array()).collect(),
            triangles: (0..64).flat_map(cell).collect(),
            ..crate::mesh::Mesh::default()
        };
        let manifold = Manifold::of(&mesh).unwrap();
        let text = "3*(0.6*x+0.8*z)^2 - (0.6*x+0.8*z)*y + 0.5*y^2";
        let values: Vec<f64> = manifold.positions().iter().map(|p| function(text).at(p.x, p.y, p.z)).collect();
        let [exact, found]: [Box<dyn SurfaceMetric>; 2] = [
            Box::new(CovariantHessian::new(&function(text), &manifold, infinite()).unwrap()),
            Box::new(recovered_on(&manifold, &values, infinite()).unwrap()),
        ];
        let plane = TangentPlane { u: along, v: up, normal: along.cross(up) };
        for field in [exact, found] {
            let error = greatest_error(field.as_ref(), &manifold.surface, |_| (plane, Tensor::new(6.0, -1.0, 1.0)));
            assert!(error < 1e-7, "{error}");
        }
    }

    #[test]
    fn what_has_no_second_derivatives_is_refused() {
        let flat = Manifold::new(
            Surface::new(&crate::mesh::Mesh {
                points: vec![[0.0; 3], [1.0, 0.0, 0.5], [0.0, 1.0, 0.5], [1.0, 1.0, 1.0]],
                triangles: vec![[0, 1, 2], [1, 3, 2]],
                ..crate::mesh::Mesh::default()
            })
            .unwrap(),
            None,
        );
        let error = CovariantHessian::new(&function("x - 2*z"), &flat, infinite()).err().unwrap();
        assert!(error.to_string().contains("vanish everywhere"), "{error}");
        let torus = Manifold::new(torus(2.0, 0.7, 0.4).unwrap(), None);
        let error = CovariantHessian::new(&function("sqrt(x)"), &torus, infinite()).err().unwrap();
        assert!(error.to_string().contains("second derivatives are not finite at ("), "{error}");
        let count = torus.surface.positions().len();
        for (values, says) in [
            (vec![1.0; count], "vanish everywhere"),
            (vec![f64::NAN; count], "the solution's value NaN is not finite at vertex 1 ("),
            (vec![1.0; 3], "3 values for"),
        ] {
            let error = recovered_on(&torus, &values, infinite()).unwrap_err();
            assert!(error.to_string().contains(says), "{error}");
        }
    }
}
