//! The metric of a surface as a user writes it.

use super::{Constant, CovariantHessian, FLOOR, ImplicitCurvature, Sampled, SurfaceMetric, sampled_curvature};
use crate::error::{Error, Result};
use crate::geometry::Tensor3;
use crate::manifold::Manifold;
use crate::mesh::Solution;
use crate::metric::{
    Bounded, Bounds, Expression, MetricSpec, Norm, Parameters, Shock, SpaceFormula, Variables, name_and_rest, require,
};

/// What a METRIC text says of a surface.
#[derive(Clone, Debug)]
pub enum Spec {
    /// `uniform`: the surface's own lengths.
    Uniform,
    /// `shock` or `shock:phi=10,lambda=0.6`.
    Shock(Shock),
    /// `formula:m11; m12; m22; m13; m23; m33`.
    Formula(SpaceFormula),
    /// `curvature` or `curvature:floor=C`: curvatures below C (1 / length) count as C.
    Curvature(Option<f64>),
    /// `hessian:EXPR`: of the second derivatives of a function of x, y and z.
    Hessian(Expression),
}

impl Spec {
    /// Reads a METRIC text; parameters are checked.
    ///
    /// # Errors
    /// [`Error::Parse`] that names the part at fault; [`Error::Unsupported`] of metrics of the plane.
    pub fn parse(text: &str) -> Result<Self> {
        let text = text.trim();
        let (name, parameters) = name_and_rest(text);
        match name {
            "uniform" if parameters.is_none() => Ok(Self::Uniform),
            "formula" => Ok(Self::Formula(SpaceFormula::parse(parameters.unwrap_or_default())?)),
            "curvature" => curvature(&Parameters::read("curvature", parameters, &["floor"])?),
            "hessian" => {
                let text = parameters.unwrap_or_default();
                Ok(Self::Hessian(Expression::named(text, Variables::Space, "metric hessian")?))
            }
            "uniform" | "swirl" | "boundary" => Err(planar(text)),
            // Shocks are written as in the plane.
            _ => match MetricSpec::parse(text)? {
                MetricSpec::Shock(shock) => Ok(Self::Shock(shock)),
                _ => Err(planar(text)),
            },
        }
    }
}

/// The field that a specification names on a surface, within limits; that of a function's second derivatives is for the L2 norm
/// ([`crate::recipe::metric_on_surface`] has more to choose). Curvatures are exact where the surface has an equation, else fitted.
///
/// # Errors
/// The limits contradict each other; no curvature could be fitted.
pub fn field(spec: &Spec, manifold: &Manifold, bounds: Bounds) -> Result<Box<dyn SurfaceMetric>> {
    let field: Box<dyn SurfaceMetric> = match spec {
        Spec::Uniform => Box::new(Constant(Tensor3::IDENTITY)),
        Spec::Shock(shock) => Box::new(*shock),
        Spec::Formula(formula) => Box::new(formula.clone()),
        Spec::Curvature(floor) => {
            let floor = floor.unwrap_or_else(|| FLOOR / manifold.bounds().diagonal());
            match &manifold.implicit {
                Some(f) => Box::new(ImplicitCurvature { f: f.clone(), floor }),
                None => Box::new(sampled_curvature(&manifold.surface, floor)?),
            }
        }
        Spec::Hessian(function) => Box::new(CovariantHessian::new(function, manifold, Norm::default())?),
    };
    within(field, bounds)
}

/// The field of values at the vertices that a surface had before it was cut.
///
/// # Errors
/// There is not one value per vertex; the values are no metric.
pub(crate) fn field_of_values(solution: &Solution, manifold: &Manifold) -> Result<Sampled> {
    Sampled::from_solution(&manifold.surface, &manifold.spread(solution)?)
}

/// A field within limits.
///
/// # Errors
/// The limits contradict each other.
pub(crate) fn within(field: Box<dyn SurfaceMetric>, bounds: Bounds) -> Result<Box<dyn SurfaceMetric>> {
    if bounds == Bounds::default() { Ok(field) } else { Ok(Box::new(Bounded::new(field, bounds)?)) }
}

fn curvature(parameters: &Parameters) -> Result<Spec> {
    if parameters.get("floor").is_none() {
        return Ok(Spec::Curvature(None));
    }
    let mut floor = f64::NAN;
    parameters.set("floor", &mut floor)?;
    let needed = "finite and positive: where the surface is flatter, it counts as so curved (1 / length)";
    require(floor > 0.0 && floor.is_finite(), "metric curvature", "floor", floor, needed)?;
    Ok(Spec::Curvature(Some(floor)))
}

fn planar(text: &str) -> Error {
    let help = "on surfaces: uniform, curvature:floor=C, shock:phi=10,lambda=0.6, 'formula:m11; m12; m22; m13; m23; m33', \
                'hessian:EXPR' in x, y and z, FILE.sol, hessian:FILE.sol";
    Error::unsupported(format!("metric {text} on a surface"), help)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::TangentPlane;
    use crate::manifold::Manifold;

    #[test]
    fn every_metric_has_a_field() {
        let manifold = Manifold::shape("sphere:2", Some(0.5)).unwrap();
        let place = manifold.place_of(crate::triangulation::VertexId(7)).unwrap();
        let normal = (place.position - crate::geometry::Point3::default()) * 0.5;
        let plane = TangentPlane::new(normal);
        for (text, expected) in [
            ("uniform", Some(1.0)),
            ("curvature", Some(0.5)),
            ("curvature:floor=3", Some(3.0)),
            ("formula:9; 0; 9; 0; 0; 9", Some(9.0)),
            ("shock:phi=0", Some(1.0)),
            ("shock", None),
        ] {
            let field = field(&Spec::parse(text).unwrap(), &manifold, Bounds::default()).unwrap();
            let m = plane.restrict(field.at(&place));
            assert!(m.is_positive_definite());
            if let Some(expected) = expected {
                let error = (m.xx - expected).abs() + m.xy.abs() + (m.yy - expected).abs();
                assert!(error < 1e-12, "{text}: {m:?}");
            }
            let bounds = Bounds { h_max: Some(0.1), ..Bounds::default() };
            let bounded = super::field(&Spec::parse(text).unwrap(), &manifold, bounds).unwrap();
            let sizes = TangentPlane::new(place.normal).restrict(bounded.at(&place)).eigen();
            assert!(sizes.small > 100.0 - 1e-9, "{text}: {sizes:?}");
        }
    }

    #[test]
    fn shocks_are_thin_across_their_gradient() {
        let manifold = Manifold::shape("sphere:2", Some(0.5)).unwrap();
        let field = field(&Spec::parse("shock").unwrap(), &manifold, Bounds::default()).unwrap();
        let place = manifold.place_of(crate::triangulation::VertexId(0)).unwrap();
        let m = field.at(&place);
        assert!(m.xx > 1.0 && m.determinant() > 1.0);
        assert_eq!([m.xz, m.yz, m.zz].map(f64::to_bits), [0.0_f64, 0.0, 1.0].map(f64::to_bits));
    }

    #[test]
    fn mistakes_are_named() {
        for (text, message, help) in [
            ("swirl", "not supported: metric swirl on a surface", "curvature:floor=C"),
            ("uniform:1,0,1", "not supported: metric uniform:1,0,1 on a surface", "formula:m11"),
            ("boundary:h0=1", "not supported: metric boundary:h0=1 on a surface", "FILE.sol"),
            ("curvature:floor=0", "metric curvature: floor = 0", "floor must be finite and positive"),
            ("curvature:foo=1", "metric curvature: unknown key `foo`", "keys among floor"),
            ("shock:phi=-1", "metric shock: phi = -1", "at least 0"),
            ("formula:1;0;1", "formula, column 6: six entries were expected, not 3", "m11; m12; m22; m13; m23; m33"),
            ("curvy", "metric: `curvy` is not a metric", "metrics: uniform"),
        ] {
            let error = Spec::parse(text).unwrap_err();
            assert!(error.to_string().starts_with(message), "{text}: {error}");
            assert!(error.help().contains(help), "{text}: {}", error.help());
        }
    }
}
