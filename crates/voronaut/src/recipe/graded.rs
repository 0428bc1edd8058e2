//! A metric on a domain, graded.

use super::background::sampling;
use crate::domain::Domain;
use crate::error::Result;
use crate::geometry::Tensor;
use crate::mesh::Mesh;
use crate::metric::nodal::{COMPLEXITY_PER_VERTEX, Pipeline, Source, complexity};
use crate::metric::{MetricField, Sampled};

/// In which multiple of a metric edges are to have length one, when it is graded: gradation is a law between neighbouring
/// edges, and scaling a metric changes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GradedAt {
    /// In the metric times this factor.
    Scale(f64),
    /// In the multiple that has this complexity when it is graded.
    Complexity(f64),
}

impl GradedAt {
    /// For a mesh of so many vertices, or of a complexity; else for the metric as it is.
    pub fn of(vertices: Option<usize>, complexity: Option<f64>) -> Self {
        let asked = vertices.map(|count| COMPLEXITY_PER_VERTEX * count as f64).or(complexity);
        asked.map_or(GradedAt::Scale(1.0), GradedAt::Complexity)
    }
}

/// The field graded ([`crate::metric::nodal::grade`]) at the vertices of a background: its own mesh if it is a `.sol` file, else a
/// triangulation of the domain as for smoothing, but even in the graded metric. Without a factor, the field as it is, to the bit.
/// What comes back is in the units of the field given, whatever multiple was graded.
///
/// # Errors
/// As of [`Pipeline::run`]; the background is missing or no mesh.
pub(super) fn grade_metric(
    field: Box<dyn MetricField>,
    domain: &Domain,
    own: Option<&Mesh>,
    gradation_factor: Option<f64>,
    at: GradedAt,
) -> Result<Box<dyn MetricField>> {
    let Some(factor) = gradation_factor else { return Ok(field) };
    let sampled = graded(field.as_ref(), sampling(field.as_ref(), domain, own)?.as_ref(), factor, at)?;
    if own.is_some() {
        return Ok(Box::new(sampled));
    }
    // The metric as it was is coarse where it is to be finer; what was made of it there has a background that is fine enough.
    let mesh = sampling(&sampled, domain, None)?;
    Ok(Box::new(graded(field.as_ref(), mesh.as_ref(), factor, at)?))
}

/// The field graded at the vertices of a mesh, in its own units.
fn graded(field: &dyn MetricField, mesh: &Mesh, factor: f64, at: GradedAt) -> Result<Sampled> {
    let (scale, target_complexity) = match at {
        GradedAt::Scale(scale) => (scale, None),
        GradedAt::Complexity(target) => (1.0, Some(target)),
    };
    let vertices = 0..mesh.points.len() as u32;
    let given: Vec<Tensor> = vertices.map(|v| field.at(mesh.point(v)) * scale).collect();
    // Refuses what is no metric before it is scaled.
    Sampled::new(mesh, &given)?;
    let own = complexity(mesh, &given);
    let pipeline = Pipeline { target_complexity, gradation_factor: Some(factor), ..Pipeline::default() };
    let made = pipeline.run(mesh, &[Source::Metric(given)])?;
    let back = 1.0 / (scale * made.factor * target_complexity.map_or(1.0, |target| target / own));
    let tensors: Vec<Tensor> = made.tensors.iter().map(|&tensor| tensor * back).collect();
    Sampled::new(mesh, &tensors)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Vector};

    /// Sizes that jump by a thousand, across and along.
    fn jumping(p: Point) -> Tensor {
        if p.x < 0.5 { Tensor::new(1e6, 0.0, 1e4) } else { Tensor::new(1.0, 0.0, 1.0) }
    }

    fn jump(at: GradedAt, factor: f64) -> Box<dyn MetricField> {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        grade_metric(Box::new(jumping), &domain, None, Some(factor), at).unwrap()
    }

    #[test]
    fn sizes_grow_by_the_factor_and_not_more() {
        let field = jump(GradedAt::Scale(1.0), 1.3);
        let size = |x: f64| 1.0 / field.at(Point::new(x, 0.5)).length(Vector::new(1.0, 0.0));
        assert!((size(0.2) / 1e-3 - 1.0).abs() < 1e-6);
        // Across: 0.001 + ln(1.3) d, for both factors of the law are the same there; ways over edges of even triangles are up to
        // 2 / sqrt(3) as long as straight ones, and between vertices logarithms are linear.
        for d in [0.1, 0.3] {
            let expected = 1e-3 + 1.3_f64.ln() * d;
            let ratio = size(0.5 + d) / expected;
            assert!(ratio > 0.9 && ratio < 1.3, "{d}: {ratio}");
        }
    }

    #[test]
    fn what_is_graded_is_the_metric_of_the_mesh() {
        // With a hundredth of the vertices edges are ten times as long, and so is the way over which they grow.
        let [coarse, fine] = [3e3, 3e5].map(|target| jump(GradedAt::Complexity(target), 1.3));
        let at = |field: &dyn MetricField, x| field.at(Point::new(x, 0.5)).xx;
        assert!(
            (at(coarse.as_ref(), 0.2) / 1e6 - 1.0).abs() < 1e-6 && (at(fine.as_ref(), 0.2) / 1e6 - 1.0).abs() < 1e-6
        );
        assert!(at(coarse.as_ref(), 0.7) > 10.0 * at(fine.as_ref(), 0.7));
    }

    #[test]
    fn without_a_factor_nothing_happens() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let same = grade_metric(Box::new(jumping), &domain, None, None, GradedAt::Complexity(9.0)).unwrap();
        assert_eq!(same.at(Point::new(0.25, 0.123)), jumping(Point::new(0.25, 0.123)));
        assert_eq!(GradedAt::of(None, Some(7.0)), GradedAt::Complexity(7.0));
        assert_eq!(GradedAt::of(None, None), GradedAt::Scale(1.0));
    }
}
