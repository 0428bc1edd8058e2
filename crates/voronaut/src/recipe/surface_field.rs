//! From what the user says of a metric on a surface to the field itself, as `field` has it of the plane: limits, then smoothing and
//! gradation at the vertices of triangles on the surface.

use super::field::{BACKGROUND_VERTICES, FEWEST, GradedAt, LONGEST, MetricOptions, background_vertices, graded_at};
use crate::canvas::{Draped, even_on_surface};
use crate::error::Result;
use crate::geometry::{Point3, Tensor3};
use crate::lists::Rows;
use crate::manifold::surface::metric::{
    CovariantHessian, CurvatureFigures, Sampled, Spec, SurfaceMetric, TangentPlanes, area_of_surface, field,
    field_of_values, recovered_on, within,
};
use crate::manifold::surface::{FeatureOptions, Nearest, closest_weights};
use crate::manifold::{Manifold, Place};
use crate::mesh::{Mesh, Solution, SolutionValues, coincident};
use crate::metric::nodal::Vertices;
use crate::metric::{Bounds, swept};
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, VertexId};
use std::collections::BTreeMap;

/// What a metric on a surface is made of.
pub enum SurfaceSource<'a> {
    /// A name with parameters, or a formula.
    Named(&'a Spec),
    /// Sizes or tensors at the vertices that the surface had before it was cut.
    Values(&'a Solution),
    /// A function's values there, whose interpolation the mesh is for.
    Function(&'a [f64]),
    /// What a solver finds at the vertices of a mesh of the surface: a function's values, or tensors.
    Solution(&'a Mesh, &'a SolutionValues),
    /// What the surface's own triangles ask for: the metric in which they are as even as can be.
    Implied,
    /// A function that takes many points at once, and gives sizes or tensors.
    Samples(Box<Sample<'a>>),
}

type Sample<'a> = dyn FnOnce(&[Point3]) -> Result<SolutionValues> + 'a;

/// The metric on a surface; `at` is the multiple of it in which edges are to have length one, for gradation and for limits on that of a
/// function.
///
/// # Errors
/// The limits contradict each other; there is not one value per vertex, or it is no metric; the function has no second derivatives;
/// smoothing asks for too many sweeps; the gradation is no factor.
pub fn metric_on_surface(
    source: SurfaceSource,
    manifold: &Manifold,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<Box<dyn SurfaceMetric>> {
    options.bounds.check()?;
    let has_vertices = !matches!(source, SurfaceSource::Named(_) | SurfaceSource::Solution(..));
    let (field, scale) = named(source, manifold, options, at)?;
    let field = within(field, options.bounds.times(scale))?;
    let vertices = |count: usize| if has_vertices { 0 } else { count };
    let field = match options.smooth_metric {
        0 => field,
        sweeps => Box::new(smoothed(field.as_ref(), manifold, vertices(BACKGROUND_VERTICES), sweeps)?),
    };
    let Some(factor) = options.gradation else { return Ok(field) };
    let count = vertices(count_for(field.as_ref(), manifold, at)?);
    let once = Background::new(manifold, field.as_ref(), count)?.graded(field.as_ref(), factor, at)?;
    if has_vertices {
        return Ok(Box::new(once));
    }
    // Where the metric is to be finer than it was, triangles that are even in what it was are too large.
    let background = Background::new(manifold, &once, count_for(&once, manifold, at)?)?;
    Ok(Box::new(background.graded(field.as_ref(), factor, at)?))
}

/// The field, and the multiple in which limits on sizes are meant: one, but for second derivatives, whose units are the function's.
pub(super) fn named(
    source: SurfaceSource,
    manifold: &Manifold,
    options: &MetricOptions,
    at: GradedAt,
) -> Result<(Box<dyn SurfaceMetric>, f64)> {
    let plain = |field: Box<dyn SurfaceMetric>| Ok((field, 1.0));
    let values = |values| Solution { dimension: 3, values };
    match source {
        SurfaceSource::Named(Spec::Hessian(function)) => {
            within_surface(Box::new(CovariantHessian::new(function, manifold, options.norm)?), manifold, at)
        }
        SurfaceSource::Named(spec) => plain(field(spec, manifold, Bounds::default())?),
        SurfaceSource::Values(solution) => plain(Box::new(field_of_values(solution, manifold)?)),
        SurfaceSource::Samples(sample) => {
            let sampled = values(sample(manifold.positions())?);
            plain(Box::new(Sampled::from_solution(manifold.surface(), &sampled)?))
        }
        SurfaceSource::Implied => {
            let vertices = TangentPlanes::to_join(manifold);
            plain(Box::new(Sampled::new(manifold.surface(), &vertices.extended(&vertices.implied()?))?))
        }
        SurfaceSource::Function(given) => within_surface(Box::new(recovered(given, manifold, options)?), manifold, at),
        SurfaceSource::Solution(mesh, given) => {
            let own = Manifold::of(mesh)?.cut(&FeatureOptions::default())?;
            own.prepare();
            match given {
                SolutionValues::Scalar(given) => {
                    let field = Elsewhere { field: recovered(given, &own, options)?, there: own };
                    within_surface(Box::new(field), manifold, at)
                }
                _ => plain(Box::new(Elsewhere { field: field_of_values(&values(given.clone()), &own)?, there: own })),
            }
        }
    }
}

/// The metric of second derivatives recovered from values at the vertices that a surface had before it was cut.
fn recovered(given: &[f64], manifold: &Manifold, options: &MetricOptions) -> Result<Sampled> {
    recovered_on(manifold, &spread_values(given, manifold)?, options.norm)
}

/// Values at the vertices that a surface had before it was cut, at those that it has now.
pub(super) fn spread_values(given: &[f64], manifold: &Manifold) -> Result<Vec<f64>> {
    let spread = manifold.spread(&Solution { dimension: 3, values: SolutionValues::Scalar(given.to_vec()) })?;
    let SolutionValues::Scalar(spread) = spread.values else { unreachable!("of the type that was given") };
    Ok(spread)
}

/// A field on another triangulation of the surface, at the closest place there that faces the same way.
struct Elsewhere {
    field: Sampled,
    there: Manifold,
}

impl SurfaceMetric for Elsewhere {
    fn at(&self, place: &Place) -> Tensor3 {
        match self.there.closest_facing(place.position, place.normal) {
            Some(there) => self.field.at(&there),
            None => Tensor3::IDENTITY * f64::NAN,
        }
    }
}

/// The field with sizes of at most [`LONGEST`] of the surface's extent, in the multiple in which edges have length one; and that
/// multiple.
fn within_surface(
    field: Box<dyn SurfaceMetric>,
    manifold: &Manifold,
    at: GradedAt,
) -> Result<(Box<dyn SurfaceMetric>, f64)> {
    let scale = match at {
        GradedAt::Scale(scale) => scale,
        GradedAt::Complexity(target) => target / area_of_surface(manifold, field.as_ref(), FEWEST)?,
    };
    let extent = manifold.bounds().extent();
    let h_max = Some(LONGEST * extent.x.max(extent.y).max(extent.z) * scale.sqrt());
    Ok((within(field, Bounds { h_max, ..Bounds::default() })?, scale))
}

/// How many vertices the triangles have on which a metric is graded.
fn count_for(field: &dyn SurfaceMetric, manifold: &Manifold, at: GradedAt) -> Result<usize> {
    let complexity = match at {
        GradedAt::Complexity(target) => target,
        GradedAt::Scale(scale) => scale * area_of_surface(manifold, field, FEWEST)?,
    };
    Ok(background_vertices(complexity, FEWEST))
}

fn smoothed(field: &dyn SurfaceMetric, manifold: &Manifold, vertices: usize, sweeps: u32) -> Result<OnBackground> {
    let background = Background::new(manifold, field, vertices)?;
    let logs = background.tensors(field).par_iter().map(|tensor| tensor.log()).collect();
    Ok(OnBackground::new(&background.draped, swept(&background.vertices.around(), logs, sweeps)?, field))
}

/// Triangles on a surface, at whose vertices metrics are sampled.
struct Background<'s> {
    draped: Draped<'s>,
    vertices: TangentPlanes,
}

impl<'s> Background<'s> {
    /// Even in a metric, with so many vertices, and all that the surface has.
    fn new(manifold: &'s Manifold, metric: &'s dyn SurfaceMetric, vertices: usize) -> Result<Self> {
        let draped = even_on_surface(manifold, metric, vertices)?;
        let t = draped.topology();
        let slots = t.vertex_slots() as u32;
        let planes = (0..slots).into_par_iter().map(|v| draped.plane(VertexId(v))).collect();
        let positions = (0..slots).map(|v| draped.position(VertexId(v))).collect();
        let triangles = t.faces().map(|f| t.corners(f).map(|v| v.0)).collect();
        // Only what is cut has copies, and a cut is a border.
        let border = t.vertices().filter(|&v| t.is_border_vertex(v)).map(|v| (v.0, draped.position(v)));
        let copies = coincident(border);
        Ok(Self { vertices: TangentPlanes::new(positions, planes, triangles, copies), draped })
    }

    fn tensors(&self, field: &dyn SurfaceMetric) -> Vec<Tensor3> {
        let slots = self.vertices.count() as u32;
        (0..slots).into_par_iter().map(|v| field.at(self.draped.place(VertexId(v)))).collect()
    }

    /// The field graded in tangent planes, by the law of [`crate::metric::nodal::grade`]: what a neighbour asks for comes with the
    /// smallest rotation that takes its plane here. In the multiple that is asked for; what comes back is in the field's own units.
    fn graded(&self, field: &dyn SurfaceMetric, factor: f64, at: GradedAt) -> Result<OnBackground> {
        let tensors = self.tensors(field);
        let flat = self.vertices.seen(&tensors);
        let graded = graded_at(&self.vertices, &flat, factor, at)?;
        let extended = self.vertices.extended(&graded);
        let back = |v: usize| if graded[v] == flat[v] { tensors[v] } else { extended[v] }.log();
        let logs = (0..flat.len()).into_par_iter().map(back).collect();
        Ok(OnBackground::new(&self.draped, logs, field))
    }
}

/// Linear between logarithms at the vertices of triangles on a surface.
struct OnBackground {
    logs: Vec<Tensor3>,
    corners: Vec<[u32; 3]>,
    positions: Vec<Point3>,
    /// The triangles in each of the surface's own,
    at_home: Rows<u32>,
    /// in trees where they are many.
    trees: BTreeMap<u32, Nearest>,
    figures: Option<CurvatureFigures>,
}

/// More triangles are looked for in a tree.
const FEW: usize = 8;

impl OnBackground {
    fn new(draped: &Draped, logs: Vec<Tensor3>, field: &dyn SurfaceMetric) -> Self {
        let t = draped.topology();
        let (faces, corners): (Vec<FaceId>, Vec<[u32; 3]>) = t.faces().map(|f| (f, t.corners(f).map(|v| v.0))).unzip();
        let positions: Vec<Point3> = (0..logs.len() as u32).map(|v| draped.position(VertexId(v))).collect();
        let homes = draped.manifold().topology().face_slots();
        let mut pairs: Vec<(u32, u32)> = faces.iter().zip(0..).map(|(&f, i)| (draped.home(f).0, i)).collect();
        pairs.sort_unstable();
        let at_home = Rows::new(homes, pairs.into_iter());
        let many = (0..homes as u32).filter(|&home| at_home.row(home as usize).len() > FEW);
        let tree = |home: u32| {
            let triangles =
                at_home.row(home as usize).iter().map(|&i| corners[i as usize].map(|v| positions[v as usize]));
            (home, Nearest::of(triangles))
        };
        let trees = many.map(tree).collect();
        Self { logs, corners, positions, at_home, trees, figures: field.curvature_figures() }
    }
}

impl SurfaceMetric for OnBackground {
    fn at(&self, place: &Place) -> Tensor3 {
        let row = self.at_home.row(place.face.index());
        let at = |&i: &u32| {
            let corners = self.corners[i as usize].map(|v| self.positions[v as usize]);
            let weights = closest_weights(corners, place.position);
            (i, weights, Point3::weighted(corners, weights).distance(place.position))
        };
        let found = if row.len() > FEW {
            self.trees[&place.face.0].closest_of(place.position).map(|(k, weights, _)| (row[k as usize], weights))
        } else {
            row.iter().map(at).min_by(|a, b| a.2.total_cmp(&b.2)).map(|(i, weights, _)| (i, weights))
        };
        let Some((i, weights)) = found else { return Tensor3::IDENTITY * f64::NAN };
        Tensor3::weighted(self.corners[i as usize].map(|v| self.logs[v as usize]), weights).exp()
    }

    fn curvature_figures(&self) -> Option<CurvatureFigures> {
        self.figures
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{TangentPlane, Tensor};
    use crate::manifold::surface::metric::grade;
    use crate::metric::Norm;
    use crate::test_cases::cube;

    fn spec(text: &str) -> Spec {
        Spec::parse(text).unwrap()
    }

    fn tangential(field: &dyn SurfaceMetric, place: &Place) -> Tensor {
        TangentPlane::new(place.normal).restrict(field.at(place))
    }

    fn places(manifold: &Manifold) -> impl Iterator<Item = Place> {
        manifold.topology().faces().map(|f| manifold.place(f, [0.2, 0.3, 0.5]))
    }

    /// The sides of a cube, each by itself.
    fn sides(n: u32) -> Manifold {
        Manifold::of(&cube(n, 0.0)).unwrap()
    }

    #[test]
    fn uniform_metrics_stay() {
        for manifold in [sides(3), Manifold::shape("torus:2,0.7", Some(0.5)).unwrap()] {
            for options in [
                MetricOptions { gradation: Some(1.2), ..MetricOptions::default() },
                MetricOptions { smooth_metric: 7, ..MetricOptions::default() },
            ] {
                let at = GradedAt::Complexity(200.0);
                let uniform = spec("formula:9; 0; 9; 0; 0; 9");
                let field = metric_on_surface(SurfaceSource::Named(&uniform), &manifold, &options, at).unwrap();
                for place in places(&manifold) {
                    let d = tangential(field.as_ref(), &place) + Tensor::IDENTITY * -9.0;
                    assert!(d.xx.abs() + d.xy.abs() + d.yy.abs() < 1e-9, "{d:?}");
                }
            }
        }
    }

    /// Sizes that are the same in all directions are graded by lengths alone, over creases as on flat sides.
    #[test]
    fn sizes_are_graded_as_sizes() {
        let manifold = sides(6);
        let mut sizes: Vec<f64> =
            manifold.positions().iter().map(|p| if p.x + p.y < 0.1 && p.z > 0.4 { 0.01 } else { 2.0 }).collect();
        let values = Solution { dimension: 3, values: SolutionValues::Scalar(sizes.clone()) };
        let options = MetricOptions { gradation: Some(1.4), ..MetricOptions::default() };
        let field =
            metric_on_surface(SurfaceSource::Values(&values), &manifold, &options, GradedAt::Scale(1.0)).unwrap();
        grade(manifold.surface(), &mut sizes, 1.4).unwrap();
        let mut changed = 0;
        for v in manifold.topology().vertices() {
            let place = manifold.place_of(v).unwrap();
            let found = tangential(field.as_ref(), &place);
            let size = sizes[v.index()];
            changed += usize::from(size > 0.011 && size < 1.9);
            assert!(
                (found.xx.sqrt() * size - 1.0).abs() < 0.05 && found.xy.abs() < 1e-9 * found.xx,
                "{found:?} {size}"
            );
        }
        assert!(changed > 100, "{changed}");
    }

    #[test]
    fn graded_metrics_are_finer_and_in_the_units_given() {
        let manifold = Manifold::shape("sphere:1", Some(0.3)).unwrap();
        let jump = spec("formula:if(x<0,400,1); 0; if(x<0,4,1); 0; 0; 4");
        let plain = MetricOptions::default();
        let graded = MetricOptions { gradation: Some(1.3), ..plain.clone() };
        let at = GradedAt::Complexity(3000.0);
        let of = |options| metric_on_surface(SurfaceSource::Named(&jump), &manifold, options, at).unwrap();
        let (before, after) = (of(&plain), of(&graded));
        let mut finer = 0;
        // The vertices of the surface are those of any background, and nothing is between them there.
        for v in manifold.topology().vertices() {
            let place = manifold.place_of(v).unwrap();
            let place = manifold.lift(&place, place.position).unwrap();
            let [m, n] = [&before, &after].map(|field| tangential(field.as_ref(), &place));
            assert!(n.determinant() > (1.0 - 1e-9) * m.determinant(), "{} {m:?} {n:?}", place.position);
            finer += usize::from(n.determinant() > 1.5 * m.determinant());
        }
        assert!(finer > 10, "{finer}");
    }

    /// What a solver finds on a mesh of the surface makes the metric that its formula has.
    #[test]
    fn solutions_on_other_meshes_make_metrics() {
        let manifold = Manifold::shape("sphere:1", Some(0.3)).unwrap();
        let mesh = crate::manifold::surface::sphere(1.0, 0.08).unwrap().to_mesh();
        let values = mesh.points.iter().map(|p| (2.0 * p[0]).sin()).collect();
        let options = MetricOptions { norm: Norm::new(f64::INFINITY).unwrap(), ..MetricOptions::default() };
        let at = GradedAt::Scale(1.0);
        let solution = SolutionValues::Scalar(values);
        let found = metric_on_surface(SurfaceSource::Solution(&mesh, &solution), &manifold, &options, at).unwrap();
        let truth =
            metric_on_surface(SurfaceSource::Named(&spec("hessian:sin(2*x)")), &manifold, &options, at).unwrap();
        let [mut sum, mut worst] = [0.0_f64; 2];
        for place in places(&manifold) {
            let place = manifold.lift(&place, place.position).unwrap();
            let [found, truth] = [&found, &truth].map(|field| tangential(field.as_ref(), &place).eigen().large);
            (sum, worst) = (sum + truth, worst.max((found - truth).abs()));
        }
        let mean = sum / places(&manifold).count() as f64;
        assert!(worst < 0.15 * mean, "{worst} of {mean}");
    }
}
