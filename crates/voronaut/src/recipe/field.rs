//! From what the user says of a metric to the field itself: limits, then smoothing and gradation on a mesh that it is sampled on.

use super::Aim;
use crate::canvas::{self, COARSE};
use crate::error::{Error, Result};
use crate::geometry::{Point, Tensor, Vector};
use crate::mesh::{Mesh, SolutionValues};
use crate::metric::nodal::{COMPLEXITY_PER_VERTEX, Pipeline, Source, Vertices, complexity};
use crate::metric::{
    Boundary, Bounded, Bounds, Hessian, MetricField, MetricSpec, Norm, Recovered, Recovery, Sampled, ScalarField,
    Snapshot, complexity as complexity_of, rough_complexity, smoothed,
};
use crate::optimise::polishing_norm;
use crate::planar::Planar;
use crate::quality::interpolation_error;
use std::borrow::Cow;

/// What is done to a metric in the plane, in this order: recovery of second derivatives and the norm they are weighted for, limits,
/// smoothing, gradation. Every parameter has one name (flag, TOML key, Python keyword).
#[derive(Clone, Debug, PartialEq)]
pub struct MetricOptions {
    /// Least and greatest sizes, greatest anisotropy.
    pub bounds: Bounds,
    /// The norm in which the error of interpolation is to be least.
    pub norm: Norm,
    /// The degree of the polynomials by which a formula is to be interpolated, that of the order of triangles: 1, 2 or 3. (Solutions are interpolated
    /// linearly.)
    pub degree: usize,
    /// How second derivatives are recovered from a solution.
    pub recovery: Recovery,
    /// Sweeps of smoothing.
    pub smooth_metric: u32,
    /// How fast sizes may grow; `None` for no gradation.
    pub gradation: Option<f64>,
}

impl Default for MetricOptions {
    fn default() -> Self {
        Self {
            bounds: Bounds::default(),
            norm: Norm::default(),
            degree: 1,
            recovery: Recovery::default(),
            smooth_metric: 0,
            gradation: None,
        }
    }
}

/// A metric in the plane.
pub struct PlanarMetric {
    /// The field.
    pub field: Box<dyn MetricField>,
    /// The function whose interpolation it is for, if it is for one and nothing else was asked of it.
    pub function: Option<Box<dyn ScalarField>>,
    /// The error to which that function is known: zero of a formula; of a solution that of its interpolation on its own mesh.
    pub known_to: f64,
    /// The multiple of the field in which limits on sizes are meant: one, but for Hessians, whose units are those of the function.
    scale: f64,
}

impl PlanarMetric {
    /// A metric that is for no function.
    pub fn plain(field: impl MetricField + 'static) -> Self {
        Self { field: Box::new(field), function: None, known_to: 0.0, scale: 1.0 }
    }

    /// What a mesh by it is for.
    pub fn aim(&self, norm: Norm) -> Option<Aim<'_>> {
        let known_to = self.known_to;
        self.function.as_deref().map(|function| Aim { function, norm, known_to })
    }
}

/// In the metric of second derivatives no size is greater than this share of the domain's extent: where a function is linear in some
/// direction, longer edges would gain nothing, and make a metric that no straight edges can honour.
pub(super) const LONGEST: f64 = 1.0 / 3.0;

/// The field that a specification names on a domain; `at` is the multiple of the metric in which edges are to have length one, for
/// gradation.
///
/// # Errors
/// The limits contradict each other; smoothing asks for too many sweeps; as of [`crate::metric::nodal::Pipeline::run`].
pub fn metric(spec: &MetricSpec, domain: &Planar, options: &MetricOptions, at: GradedAt) -> Result<PlanarMetric> {
    finished(named(spec, domain, options, at)?, domain, None, options, at)
}

/// The field of sizes or tensors at the vertices of a mesh; `place` names the values in messages.
///
/// # Errors
/// As of [`metric()`]; there is not one value per vertex; the values are no metric in the plane.
pub fn metric_of_values(
    mesh: &Mesh,
    values: &SolutionValues,
    place: &str,
    domain: &Planar,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let field = match values {
        SolutionValues::Scalar(sizes) => Sampled::sizes(mesh, sizes)?,
        _ => Sampled::new(mesh, &tensors(values, place)?)?,
    };
    finished(PlanarMetric::plain(field), domain, Some(mesh), options, at)
}

/// The metric that a solver's solution on a mesh of the domain asks for: that of its recovered second derivatives, if it is a
/// scalar; itself, if it is a tensor.
///
/// # Errors
/// As of [`metric`].
pub fn metric_of_solution(
    mesh: &Mesh,
    values: &SolutionValues,
    domain: &Planar,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let named = match values {
        SolutionValues::Scalar(values) => recovered(mesh, values, domain, options, at)?,
        _ => PlanarMetric::plain(Sampled::new(mesh, &tensors(values, "the solution")?)?),
    };
    finished(named, domain, Some(mesh), options, at)
}

/// The metric that a function at one time asks for.
///
/// # Errors
/// As of [`metric`].
pub fn metric_of_function(
    function: &Snapshot,
    domain: &Planar,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    finished(optimal(function, domain, options, at)?, domain, None, options, at)
}

/// A field that is there, times the factor that gives it a complexity, if one is asked for; then within limits, smoothed and graded.
///
/// # Errors
/// As of [`metric`].
pub fn metric_of_field(
    field: Box<dyn MetricField>,
    target_complexity: Option<f64>,
    domain: &Planar,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let field = match target_complexity {
        None => field,
        Some(target) => {
            let factor = target / complexity_of(field.as_ref(), &domain.triangles())?;
            Box::new(move |p: Point| field.at(p) * factor)
        }
    };
    finished(PlanarMetric::plain(field), domain, None, options, at)
}

/// The metric of a function that is slow to call and takes many points at once: sampled at the vertices of a background, first of one
/// that is even, then twice of one that is even in the metric so far, with four times the vertices that the mesh will have.
///
/// # Errors
/// As of [`metric`]; what the function says; its values are no metric.
pub fn metric_of_samples(
    mut sample: impl FnMut(&[Point]) -> Result<Vec<Tensor>>,
    domain: &Planar,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let mut sampled = |mesh: &Mesh| {
        let points: Vec<Point> = (0..mesh.points.len() as u32).map(|v| mesh.point(v)).collect();
        Sampled::new(mesh, &sample(&points)?)
    };
    let even_everywhere = |_: Point| Tensor::isotropic(1.0);
    let mut mesh = even(&even_everywhere, domain, COARSE, FIRST_SAMPLES)?;
    let mut field = sampled(&mesh)?;
    for _ in 0..2 {
        mesh = even(&field, domain, COARSE, vertices_for(&field, domain, at)?)?;
        field = sampled(&mesh)?;
    }
    finished(PlanarMetric::plain(field), domain, Some(&mesh), options, at)
}

/// The field that a text names on a domain, when nothing else is asked of it and there is no file.
///
/// # Errors
/// As of [`MetricSpec::parse`] and [`metric`].
#[cfg(test)]
pub(crate) fn metric_named(text: &str, domain: &Planar) -> Result<Box<dyn MetricField>> {
    let made = metric(&MetricSpec::parse(text)?, domain, &MetricOptions::default(), GradedAt::Scale(1.0))?;
    Ok(made.field)
}

fn named(spec: &MetricSpec, domain: &Planar, options: &MetricOptions, at: GradedAt) -> Result<PlanarMetric> {
    Ok(match spec {
        MetricSpec::Uniform(field) => PlanarMetric::plain(*field),
        MetricSpec::Swirl(field) => PlanarMetric::plain(*field),
        MetricSpec::Shock(field) => PlanarMetric::plain(*field),
        MetricSpec::Formula(field) => PlanarMetric::plain(field.clone()),
        MetricSpec::Boundary(sizes) => PlanarMetric::plain(Boundary::new(&domain.boundary(), *sizes)?),
        MetricSpec::Hessian(function) => return optimal(&function.clone().into(), domain, options, at),
    })
}

fn optimal(function: &Snapshot, domain: &Planar, options: &MetricOptions, at: GradedAt) -> Result<PlanarMetric> {
    let field = Hessian::new(function.clone(), options.norm, options.degree, &domain.triangles())?;
    let (field, scale) = within_domain(field, domain, at)?;
    Ok(PlanarMetric { field: Box::new(field), function: Some(Box::new(function.clone())), known_to: 0.0, scale })
}

fn recovered(
    mesh: &Mesh,
    values: &[f64],
    domain: &Planar,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    let function = Recovered::new(mesh, values, options.recovery)?;
    let (field, scale) = within_domain(function.metric(options.norm)?, domain, at)?;
    // In the norm that polishing goes by.
    let known_to = interpolation_error(mesh, &function, polishing_norm(options.norm))?.norm;
    Ok(PlanarMetric { field: Box::new(field), function: Some(Box::new(function)), known_to, scale })
}

/// The field with sizes of at most [`LONGEST`] of the domain's extent, in the multiple in which edges have length one; and that
/// multiple.
fn within_domain<F: MetricField + 'static>(field: F, domain: &Planar, at: GradedAt) -> Result<(Bounded<F>, f64)> {
    let scale = match at {
        GradedAt::Scale(scale) => scale,
        GradedAt::Complexity(target) => target / rough_complexity(&field, &domain.triangles())?,
    };
    let extent = domain.bounds().map_or(Vector::default(), |bounds| bounds.extent());
    let h_max = Some(LONGEST * extent.x.max(extent.y) * scale.sqrt());
    Ok((Bounded::new(field, Bounds { h_max, ..Bounds::default() })?, scale))
}

/// The tensors of values that are tensors of the plane; `place` names them in messages.
pub(super) fn tensors(values: &SolutionValues, place: &str) -> Result<Vec<Tensor>> {
    let SolutionValues::Tensor(entries) = values else {
        let help = "give one size (type 1) or one tensor m11 m12 m22 (type 3) per vertex, in dimension 2";
        return Err(Error::parse(place, "the values are no planar metric", help));
    };
    Ok(entries.iter().map(|&[xx, xy, yy]| Tensor::new(xx, xy, yy)).collect())
}

/// Limits, then smoothing, then gradation. A function counts only where none of them was asked for.
fn finished(
    named: PlanarMetric,
    domain: &Planar,
    own: Option<&Mesh>,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<PlanarMetric> {
    options.bounds.check()?;
    let PlanarMetric { field, function, known_to, scale } = named;
    let bounds = options.bounds.times(scale);
    let field: Box<dyn MetricField> =
        if bounds == Bounds::default() { field } else { Box::new(Bounded::new(field, bounds)?) };
    let field = smooth_metric(field, domain, own, options.smooth_metric)?;
    let field = grade_metric(field, domain, own, options.gradation, at)?;
    Ok(PlanarMetric { field, function: function.filter(|_| !options.is_limiting()), known_to, scale })
}

/// Vertices of the background on which a metric is smoothed that has none of its own, and the most of one on which it is graded.
pub(super) const BACKGROUND_VERTICES: usize = 40_000;
/// So many times the vertices of the mesh, two to an edge, has the background of a metric that is graded,
const FINER: f64 = 4.0;
/// and at least so many.
pub(super) const FEWEST: usize = 1_000;

/// Vertices of the first background of a metric that is sampled: what is finer than a hundredth of a square is found by them.
const FIRST_SAMPLES: usize = 10_000;

/// How many vertices the background of a metric has that is graded for a mesh of a complexity; `fewest` at least.
pub(super) fn background_vertices(complexity: f64, fewest: usize) -> usize {
    let expected = complexity / COMPLEXITY_PER_VERTEX;
    (FINER * expected).clamp(fewest as f64, BACKGROUND_VERTICES as f64) as usize
}

/// A triangulation of the domain that is even in the metric, with so many vertices, and all of the domain's own; `coarse` as of
/// [`canvas::even`].
pub(super) fn even(field: &dyn MetricField, domain: &Planar, coarse: usize, vertices: usize) -> Result<Mesh> {
    let Planar { topology, positions } = canvas::even(domain, field, coarse, vertices)?;
    Ok(Mesh {
        points: positions.iter().map(|p| [p.x, p.y, 0.0]).collect(),
        triangles: topology.faces().map(|face| topology.corners(face).map(|v| v.0)).collect(),
        ..Mesh::default()
    })
}

/// The field after so many sweeps of smoothing ([`smoothed`]), on its own mesh or one that is even in it, with
/// [`BACKGROUND_VERTICES`] (and all of the domain's own). With no sweeps, the field as it is, to the bit.
///
/// On the latter, K sweeps smooth with a standard deviation of about sqrt(K) / 400 of the domain's width in the metric, or half the
/// square root of K N / 40,000 edges of a mesh that has N vertices.
///
/// # Errors
/// As for [`smoothed`].
pub(super) fn smooth_metric(
    field: Box<dyn MetricField>,
    domain: &Planar,
    own: Option<&Mesh>,
    sweeps: u32,
) -> Result<Box<dyn MetricField>> {
    if sweeps == 0 {
        return Ok(field);
    }
    let mesh = match own {
        Some(mesh) => Cow::Borrowed(mesh),
        None => Cow::Owned(even(field.as_ref(), domain, COARSE, BACKGROUND_VERTICES)?),
    };
    Ok(Box::new(smoothed(field.as_ref(), &mesh, sweeps)?))
}

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
/// triangulation of the domain ([`background_vertices`]) that is even in the graded metric. Without a factor, the field as it is,
/// to the bit. What comes back is in the units of the field given, whatever multiple was graded.
///
/// # Errors
/// As of [`Pipeline::run`]; the background is missing or no mesh.
pub(super) fn grade_metric(
    field: Box<dyn MetricField>,
    domain: &Planar,
    own: Option<&Mesh>,
    gradation_factor: Option<f64>,
    at: GradedAt,
) -> Result<Box<dyn MetricField>> {
    let Some(factor) = gradation_factor else { return Ok(field) };
    let graded = |mesh: &Mesh| graded(field.as_ref(), mesh, factor, at);
    if let Some(mesh) = own {
        return Ok(Box::new(graded(mesh)?));
    }
    let sampled = graded(&even(field.as_ref(), domain, COARSE, vertices_for(field.as_ref(), domain, at)?)?)?;
    // The metric as it was is coarse where it is to be finer; what was made of it there has a background that is fine enough.
    Ok(Box::new(graded(&even(&sampled, domain, COARSE, vertices_for(&sampled, domain, at)?)?)?))
}

/// How many vertices the background of a metric has.
fn vertices_for(field: &dyn MetricField, domain: &Planar, at: GradedAt) -> Result<usize> {
    match at {
        GradedAt::Complexity(target) => Ok(background_vertices(target, FEWEST)),
        GradedAt::Scale(scale) => {
            rough_complexity(field, &domain.triangles()).map(|own| background_vertices(scale * own, FEWEST))
        }
    }
}

/// The field graded at the vertices of a mesh, in its own units.
fn graded(field: &dyn MetricField, mesh: &Mesh, factor: f64, at: GradedAt) -> Result<Sampled> {
    let given: Vec<Tensor> = (0..mesh.points.len() as u32).map(|v| field.at(mesh.point(v))).collect();
    Sampled::new(mesh, &graded_at(mesh, &given, factor, at)?)
}

/// Tensors graded at vertices, of the plane or of a surface, in their own units.
pub(super) fn graded_at(on: &impl Vertices, tensors: &[Tensor], factor: f64, at: GradedAt) -> Result<Vec<Tensor>> {
    let (scale, target_complexity) = match at {
        GradedAt::Scale(scale) => (scale, None),
        GradedAt::Complexity(target) => (1.0, Some(target)),
    };
    let given: Vec<Tensor> = tensors.iter().map(|&tensor| tensor * scale).collect();
    // Refuses what is no metric before it is scaled.
    on.check(&given)?;
    let own = complexity(on, &given);
    let pipeline = Pipeline { target_complexity, gradation_factor: Some(factor), ..Pipeline::default() };
    let made = pipeline.run_on(on, &[Source::Metric(given)])?;
    let back = 1.0 / (scale * made.factor * target_complexity.map_or(1.0, |target| target / own));
    Ok(made.tensors.iter().map(|&tensor| tensor * back).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;
    use crate::manifold::domain::Domain;

    /// Sizes that jump by a thousand, across and along.
    fn jumping(p: Point) -> Tensor {
        if p.x < 0.5 { Tensor::new(1e6, 0.0, 1e4) } else { Tensor::new(1.0, 0.0, 1.0) }
    }

    fn jump(at: GradedAt, factor: f64) -> Box<dyn MetricField> {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        grade_metric(Box::new(jumping), domain.planar(), None, Some(factor), at).unwrap()
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
    fn samples_follow_the_field() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let layer = |p: Point| {
            let across = 0.002 + 0.3 * (p.y - 0.37).abs();
            Tensor::new(25.0, 0.0, across.powi(-2))
        };
        let mut calls = 0;
        let sample = |points: &[Point]| {
            calls += 1;
            Ok(points.iter().map(|&p| layer(p)).collect())
        };
        let made = metric_of_samples(sample, domain.planar(), &MetricOptions::default(), GradedAt::Complexity(1000.0))
            .unwrap();
        assert_eq!(calls, 3);
        for p in [Point::new(0.3, 0.37), Point::new(0.51, 0.3704), Point::new(0.2, 0.9)] {
            let ratio = made.field.at(p).yy / layer(p).yy;
            assert!(ratio > 0.8 && ratio < 1.25, "{p}: {ratio}");
        }
        let nothing = metric_of_samples(
            |p| Ok(vec![Tensor::new(f64::NAN, 0.0, 1.0); p.len()]),
            domain.planar(),
            &MetricOptions::default(),
            GradedAt::Scale(1.0),
        );
        assert!(matches!(nothing, Err(Error::Metric { .. })));
    }

    #[test]
    fn without_a_factor_nothing_happens() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let same = grade_metric(Box::new(jumping), domain.planar(), None, None, GradedAt::Complexity(9.0)).unwrap();
        assert_eq!(same.at(Point::new(0.25, 0.123)), jumping(Point::new(0.25, 0.123)));
        assert_eq!(GradedAt::of(None, Some(7.0)), GradedAt::Complexity(7.0));
        assert_eq!(GradedAt::of(None, None), GradedAt::Scale(1.0));
    }
}
