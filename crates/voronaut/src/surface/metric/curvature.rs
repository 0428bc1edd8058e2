//! The metric of principal curvatures.

use super::{CurvatureFigures, Sampled, SurfaceMetric, fit_curvatures};
use crate::error::Result;
use crate::geometry::Tensor3;
use crate::parallel::prelude::*;
use crate::surface::{Curvatures, Implicit, Place, Surface, curvatures};
use crate::triangulation::VertexId;

/// The smallest curvature that counts, unless told otherwise, over the bounding box's diagonal: a radius of ten diagonals
/// is flat.
pub(crate) const FLOOR: f64 = 0.1;

/// The curvature metric of RR-9103, 15.1, of a surface f = 0, from exact derivatives of f at the place, which is on the
/// surface or near it (then of the level surface there); see [`Curvatures::metric`](crate::surface::Curvatures::metric).
/// Where grad f = 0 (a cone's apex) there are no curvatures: the value there is not finite.
#[derive(Clone, Debug)]
pub(crate) struct ImplicitCurvature<I> {
    /// f.
    pub f: I,
    /// Smaller curvatures count as this; positive, in units of 1 / length.
    pub floor: f64,
}

impl<I: Implicit> SurfaceMetric for ImplicitCurvature<I> {
    fn at(&self, place: &Place) -> Tensor3 {
        let found = curvatures(&self.f.jet(place.position));
        found.map_or(Tensor3::IDENTITY * f64::NAN, |c| c.metric([self.floor, f64::INFINITY]))
    }
}

/// The curvature metric of a mesh: from [`fit_curvatures`] at vertices, log-Euclidean between them.
///
/// It is a metric on every surface, bounded by what the triangles can tell: curvatures below `floor` count as that, and those above
/// 2 pi / l, l the mean length of the edges at the vertex, as that: no more than a full turn over an edge. (At a fold, a spike or a
/// needle a fit may say anything.) A vertex without a fit gets the mean of its neighbours'
/// logarithms; the floor, if these have none either.
///
/// # Errors
/// As [`Sampled::new`]: where `floor` is not positive and finite.
pub(crate) fn sampled_curvature(surface: &Surface, floor: f64) -> Result<Sampled> {
    let fitted = fit_curvatures(surface);
    let caps: Vec<f64> = (0..fitted.len() as u32).into_par_iter().map(|v| cap(surface, VertexId(v))).collect();
    let metric = |(c, cap): (&Option<Curvatures>, &f64)| c.map(|c| c.metric([floor, *cap]));
    let fits: Vec<Option<Tensor3>> = fitted.iter().zip(&caps).map(metric).collect();
    let t = surface.topology();
    let tensor = |v: u32| {
        let around = || t.around(VertexId(v)).filter_map(|w| fits[w.index()]);
        fits[v as usize].or_else(|| mean(around())).unwrap_or(Tensor3::IDENTITY * floor)
    };
    let tensors: Vec<Tensor3> = (0..fits.len() as u32).map(tensor).collect();
    let bent = || fitted.iter().zip(&caps).filter_map(|(c, cap)| Some((c.as_ref()?.values.map(f64::abs), *cap)));
    let figures = CurvatureFigures {
        floor,
        floored: bent().filter(|(values, _)| values[1] < floor).count(),
        capped: bent().filter(|(values, cap)| values[0] > cap.max(floor)).count(),
        unfitted: t.vertices().filter(|v| fitted[v.index()].is_none()).count(),
        greatest: bent().map(|(values, cap)| values[0].min(cap).max(floor)).fold(floor, f64::max),
    };
    Ok(Sampled::new(surface, &tensors)?.with_figures(figures))
}

/// The greatest curvature that edges at a vertex can tell; no number of a vertex without edges, which has no fit either.
fn cap(surface: &Surface, v: VertexId) -> f64 {
    let ends = surface.topology().around(v).map(|w| surface.position(w).distance(surface.position(v)));
    let (count, sum) = ends.fold((0.0, 0.0), |(count, sum), length| (count + 1.0, sum + length));
    std::f64::consts::TAU * count / sum
}

/// The log-Euclidean mean.
fn mean(tensors: impl Iterator<Item = Tensor3>) -> Option<Tensor3> {
    let (count, sum) = tensors.fold((0.0, Tensor3::default()), |(count, sum), m| (count + 1.0, sum + m.log()));
    (count > 0.0).then(|| (sum * (1.0 / count)).exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::TangentPlane;
    use crate::metric::{Expression, Variables};
    use crate::surface::torus;

    #[test]
    fn meshes_and_equations_agree() {
        let f = Expression::parse("(sqrt(x^2+y^2)-2)^2+z^2-0.49", Variables::Space).unwrap();
        let exact = ImplicitCurvature { f, floor: 0.05 };
        let error = |edge: f64| {
            let surface = torus(2.0, 0.7, edge).unwrap();
            let fitted = sampled_curvature(&surface, 0.05).unwrap();
            let difference = |v| {
                let place = surface.place_of(v)?;
                let plane = TangentPlane::new(surface.vertex_normal(v)?);
                let [a, b] = [exact.at(&place), fitted.at(&place)].map(|m| plane.restrict(m));
                Some((a.xx - b.xx).abs().max((a.xy - b.xy).abs()).max((a.yy - b.yy).abs()))
            };
            surface.topology().vertices().filter_map(difference).fold(0.0, f64::max)
        };
        let errors = [0.2, 0.1, 0.05].map(error);
        println!("curvature metric of a torus, fitted, largest errors: {errors:?}");
        assert!(errors[1] < 0.5 * errors[0] && errors[2] < 0.5 * errors[1] && errors[2] < 0.05, "{errors:?}");
    }

    #[test]
    fn an_apex_has_no_metric() {
        let f = Expression::parse("x^2+y^2-z^2", Variables::Space).unwrap();
        let surface = torus(2.0, 0.7, 1.0).unwrap();
        let place = Place {
            position: crate::geometry::Point3::default(),
            ..surface.place(crate::triangulation::FaceId(0), [1.0, 0.0, 0.0])
        };
        assert!(!ImplicitCurvature { f, floor: 0.1 }.at(&place).is_positive_definite());
    }
}
