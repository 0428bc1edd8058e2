//! The metric of a function's derivatives: known at every point, or, second ones, recovered from a solution at the vertices of a mesh.

use super::complexity::{PIECES, start};
use super::form::Form;
use super::nodal::size;
use super::{MetricField, Near, Norm, Optimal, Recovery, Sampled, ScalarField, Snapshot, recover_hessian};
use crate::error::{Error, Result};
use crate::geometry::{Jet, Point, Tensor, Vector, centroid};
use crate::mesh::{Located, Locator, Mesh};

/// The metric in which a unit mesh has the least L^p error of interpolating a function by polynomials of degree 1 (`Optimal`), 2 or 3 (on straight
/// triangles; Mirebeau 2010: what bounds the form of the next derivatives, times `Norm::weight`). It is
/// defined up to a factor: scale it to a number of vertices or a complexity.
#[derive(Clone, Debug)]
pub struct Hessian {
    function: Snapshot,
    norm: Norm,
    optimal: Optimal,
    floor: f64,
    degree: usize,
}

impl Hessian {
    /// Of a function on a domain that these triangles cover, for polynomials of a degree.
    ///
    /// # Errors
    /// [`Error::Metric`] where a derivative is not finite, or where all are zero; [`Error::Domain`] of triangles that are
    /// not finite.
    pub(crate) fn new(function: Snapshot, norm: Norm, degree: usize, domain: &[[Point; 3]]) -> Result<Self> {
        let mut found = Self { function, norm, optimal: Optimal::new(norm), floor: 0.0, degree };
        let (mut sum, mut total) = (0.0, 0.0);
        for (triangle, _) in start(domain, PIECES)? {
            let ([a, b, c], middle) = (triangle, centroid(triangle));
            let greatest = found.size(middle);
            if !greatest.is_finite() {
                let what = format!("the function's {} are not finite", found.derivatives());
                let help = format!(
                    "give a function with {} derivatives in the whole domain",
                    ["two", "three", "four"][degree - 1]
                );
                return Err(Error::metric(what, middle.to_string(), help));
            }
            let area = (b - a).cross(c - a).abs();
            (sum, total) = (sum + area * greatest, total + area);
        }
        found.floor = FLOOR * sum / total;
        if found.floor > 0.0 {
            return Ok(found);
        }
        let help = "what is linear needs no mesh, and kinks and jumps have no second derivatives: use another metric, or give values at \
                    the vertices of a fine mesh (hessian:FILE.sol)";
        Err(Error::metric(
            format!("the function's {} vanish everywhere", found.derivatives()),
            "all points looked at",
            help,
        ))
    }

    fn derivatives(&self) -> String {
        format!("{} derivatives", ["second", "third", "fourth"][self.degree - 1])
    }

    fn form(&self, p: Point) -> Form {
        let order = self.degree + 1;
        Form::of_values(order, |v| self.function.derivative(p, v, order))
    }

    /// The greater eigenvalue of what the metric is made of.
    fn size(&self, p: Point) -> f64 {
        if self.degree == 1 { size(self.function.second_derivatives(p)) } else { self.form(p).size() }
    }
}

impl MetricField for Hessian {
    fn at(&self, p: Point) -> Tensor {
        if self.degree == 1 {
            return self.optimal.of(self.function.second_derivatives(p), self.floor);
        }
        let bounding = self.form(p).bounding(self.floor);
        bounding * self.norm.weight(bounding.determinant(), self.degree)
    }
}

/// The floor of absolute eigenvalues, as a share of the mean over the domain of the greater one: where a function is linear in
/// some direction, longer edges would gain nothing, and make a metric that no straight edges can honour. Measured: a hundredth
/// of it makes errors larger by 1 to 3 %, for the mesh cannot follow; ten times as much by 4 %.
pub(crate) const FLOOR: f64 = 1e-4;

/// The function that is quadratic on every triangle, has a solution's values at the vertices, and there, as well as a continuous
/// function can, its recovered second derivatives: linear interpolation and, of each edge e, -e'He / 8 in the middle.
///
/// Outside the mesh the value is that at the nearest point.
#[derive(Clone, Debug)]
pub(crate) struct Recovered {
    values: Vec<f64>,
    hessians: Vec<Tensor>,
    mesh: Mesh,
    locator: Locator,
}

impl Recovered {
    /// Of one value per vertex of a planar mesh.
    ///
    /// # Errors
    /// As for [`recover_hessian`].
    pub(crate) fn new(mesh: &Mesh, values: &[f64], recovery: Recovery) -> Result<Self> {
        let hessians = recover_hessian(mesh, values, recovery)?;
        let locator = Locator::new(mesh, "the mesh of the solution")?;
        Ok(Self { values: values.to_vec(), hessians, mesh: mesh.clone(), locator })
    }

    /// The metric of the second derivatives, as [`super::Hessian`] has it of a formula.
    ///
    /// # Errors
    /// [`Error::Metric`] where all are zero.
    pub(crate) fn metric(&self, norm: Norm) -> Result<Sampled> {
        let size = self.mean_size();
        let floor = FLOOR * size;
        let area = 0.5 * self.mesh.triangles.iter().map(|&triangle| self.mesh.double_area(triangle)).sum::<f64>();
        if size > rounding(&self.values, area) && floor > 0.0 {
            let optimal = Optimal::new(norm);
            let tensors: Vec<Tensor> = self.hessians.iter().map(|&h| optimal.of(h, floor)).collect();
            return Sampled::new(&self.mesh, &tensors);
        }
        let help = "its interpolation is exact on any mesh: use another metric, such as uniform";
        Err(Error::metric("the solution's second derivatives vanish everywhere", "the whole mesh", help))
    }

    /// The mean over the mesh's area of the greater absolute eigenvalue.
    fn mean_size(&self) -> f64 {
        let (mut sum, mut total) = (0.0, 0.0);
        for &triangle in &self.mesh.triangles {
            let area = self.mesh.double_area(triangle);
            sum += area * triangle.map(|v| size(self.hessians[v as usize])).iter().sum::<f64>() / 3.0;
            total += area;
        }
        sum / total
    }
}

/// Second derivatives that rounding of values alone could make up, at the vertices of a mesh of so much area.
pub(crate) fn rounding(values: &[f64], area: f64) -> f64 {
    let greatest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    100.0 * f64::EPSILON * greatest * values.len() as f64 / area
}

impl Recovered {
    /// The triangle that the nearest point of the mesh is in, and its barycentric coordinates there.
    fn place(&self, p: Point, near: &mut Near) -> Option<(u32, [f64; 3])> {
        let Located { triangle, weights, .. } = self.locator.locate_from(near.place, p)?;
        near.place = Some(triangle);
        Some((triangle, weights))
    }

    /// In a triangle the function is the sum of values times weights, less that of bends times the products of an edge's two weights.
    fn coefficients(&self, triangle: u32) -> [(f64, f64); 3] {
        let vertices = self.mesh.triangles[triangle as usize];
        std::array::from_fn(|i| {
            let [u, v] = [vertices[i], vertices[(i + 1) % 3]];
            let edge = self.mesh.point(v) - self.mesh.point(u);
            let sum = self.hessians[u as usize] + self.hessians[v as usize];
            // 4 of the shape function in the middle times e' (sum / 2) e / 8.
            (self.values[u as usize], 0.25 * sum.dot(edge, edge))
        })
    }
}

impl ScalarField for Recovered {
    fn value(&self, p: Point) -> f64 {
        self.value_near(p, &mut Near::default())
    }

    fn jet(&self, p: Point) -> Option<Jet> {
        self.jet_near(p, &mut Near::default())
    }

    fn value_near(&self, p: Point, near: &mut Near) -> f64 {
        let Some((triangle, weights)) = self.place(p, near) else { return f64::NAN };
        let of = |(i, (value, bend)): (usize, &(f64, f64))| weights[i] * (value - bend * weights[(i + 1) % 3]);
        self.coefficients(triangle).iter().enumerate().map(of).sum()
    }

    fn jet_near(&self, p: Point, near: &mut Near) -> Option<Jet> {
        let (triangle, weights) = self.place(p, near)?;
        let corners = self.locator.corners(triangle);
        let inverse = 1.0 / (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let weights: [Jet; 3] = std::array::from_fn(|i| {
            let across = corners[(i + 2) % 3] - corners[(i + 1) % 3];
            Jet { value: weights[i], gradient: Vector::new(-across.y, across.x) * inverse, hessian: Tensor::default() }
        });
        let of =
            |(i, (value, bend)): (usize, &(f64, f64))| weights[i] * (Jet::from(*value) - weights[(i + 1) % 3] * *bend);
        let sum = self.coefficients(triangle).iter().enumerate().map(of).fold(Jet::default(), |sum, part| sum + part);
        inverse.is_finite().then_some(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::super::nodal::test_meshes::grid;
    use super::*;
    use crate::metric::MetricField;
    use crate::metric::{Expression, Variables};

    fn hessian(text: &str, norm: Norm) -> Result<Hessian> {
        of_degree(text, norm, 1)
    }

    fn of_degree(text: &str, norm: Norm, degree: usize) -> Result<Hessian> {
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Point::new(x, y));
        let halves = [[square[0], square[1], square[2]], [square[0], square[2], square[3]]];
        Hessian::new(Expression::parse(text, Variables::Plane)?.into(), norm, degree, &halves)
    }

    fn assert_close(a: Tensor, b: Tensor) {
        let d = a + b * -1.0;
        assert!(d.xx.abs() + d.xy.abs() + d.yy.abs() < 1e-12 * (b.xx + b.yy), "{a:?} {b:?}");
    }

    #[test]
    fn of_quadratics_it_is_constant_and_half_as_dense_at_saddles() {
        // Second derivatives 8, -2 along and across (0.6, 0.8).
        let text = "4*(0.6*x + 0.8*y)^2 - (0.8*x - 0.6*y)^2";
        let truth = Tensor::from_axis(crate::geometry::Vector::new(0.6, 0.8), 8.0, 2.0);
        for p in [Point::new(0.1, 0.9), Point::new(0.5, 0.5)] {
            assert_close(hessian(text, Norm::new(f64::INFINITY).unwrap()).unwrap().at(p), truth);
            assert_close(hessian(text, Norm::default()).unwrap().at(p), truth * (0.5 * 16.0_f64.powf(-1.0 / 6.0)));
        }
    }

    #[test]
    fn of_cubics_and_quartics_it_is_constant_and_of_their_directions() {
        // The form of third derivatives is 6 (8 a^3 + b^3), that of fourth ones 24 (16 a^4 + b^4), along and across (0.6, 0.8).
        let (a, b) = ("(0.6*x + 0.8*y)", "(0.8*x - 0.6*y)");
        let texts = [
            (2, format!("8*{a}^3 + {b}^3"), 6.0_f64.powf(2.0 / 3.0)),
            (3, format!("16*{a}^4 + {b}^4"), 24.0_f64.sqrt()),
        ];
        for (degree, text, size) in texts {
            let truth = Tensor::from_axis(crate::geometry::Vector::new(0.6, 0.8), 4.0, 1.0) * size;
            let power = -1.0 / ((degree as f64 + 1.0) * 2.0 + 2.0);
            for p in [Point::new(0.1, 0.9), Point::new(0.5, 0.5)] {
                let field = |norm| of_degree(&text, norm, degree).unwrap().at(p);
                assert_close(field(Norm::new(f64::INFINITY).unwrap()), truth);
                assert_close(field(Norm::default()), truth * truth.determinant().powf(power));
            }
        }
        let message = of_degree("x*x + x*y", Norm::default(), 2).unwrap_err().to_string();
        assert!(message.contains("the function's third derivatives vanish everywhere"), "{message}");
    }

    #[test]
    fn what_says_nothing_gets_the_floor() {
        let field = hessian("x^2 / 2", Norm::new(f64::INFINITY).unwrap()).unwrap();
        assert_close(field.at(Point::new(0.3, 0.3)), Tensor::new(1.0, 0.0, FLOOR));
    }

    #[test]
    fn what_has_no_second_derivatives_is_refused() {
        let message = |text| hessian(text, Norm::default()).unwrap_err().to_string();
        assert!(message("3*x - y + 1").contains("vanish everywhere"));
        assert!(message("sqrt(x - 0.5)").contains("second derivatives are not finite at ("));
        assert!(message("x +").contains("expression, column"));
    }

    fn recovered(f: impl Fn(Point) -> f64) -> Recovered {
        let mesh = grid(12, 0.4);
        let values: Vec<f64> = (0..mesh.points.len() as u32).map(|v| f(mesh.point(v))).collect();
        Recovered::new(&mesh, &values, Recovery::Fit).unwrap()
    }

    #[test]
    fn quadratics_are_reproduced_between_the_vertices() {
        let f = |p: Point| 3.0 * p.x * p.x - p.x * p.y + 0.5 * p.y * p.y + p.x - 2.0;
        let found = recovered(f);
        for i in 0..200 {
            let p = Point::new((f64::from(i) * 0.618).fract(), (f64::from(i) * 0.414).fract());
            assert!((found.value(p) - f(p)).abs() < 1e-9, "{p}");
            let jet = found.jet(p).unwrap();
            assert_eq!(jet.value.to_bits(), found.value(p).to_bits());
            let slope = jet.gradient - crate::geometry::Vector::new(6.0 * p.x - p.y + 1.0, p.y - p.x);
            let bend = jet.hessian + Tensor::new(6.0, -1.0, 1.0) * -1.0;
            assert!(slope.norm() < 1e-6 && size(bend) < 1e-5, "{p}: {jet:?}");
        }
        // Second derivatives ((6, -1), (-1, 1)), positive definite.
        let m = found.metric(Norm::new(f64::INFINITY).unwrap()).unwrap().at(Point::new(0.4, 0.7));
        assert!((m.xx - 6.0).abs() + (m.xy + 1.0).abs() + (m.yy - 1.0).abs() < 1e-7, "{m:?}");
    }

    #[test]
    fn what_is_linear_but_for_rounding_has_no_metric() {
        for linear in [0.0, 1.0, 1e6] {
            let error =
                recovered(|p| 1.0 + linear * (p.x + 2.0 * p.y)).metric(Norm::default()).unwrap_err().to_string();
            assert!(error.contains("vanish everywhere"), "{linear}: {error}");
        }
    }
}
