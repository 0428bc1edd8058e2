//! Metrics at the vertices of a surface's own triangles, from solutions and other metrics, as [`Pipeline`] makes them in the plane.

use super::field::{GradedAt, MetricOptions};
use super::surface_field::{SurfaceSource, named, spread_values};
use crate::error::Result;
use crate::geometry::{TangentPlane, Tensor, Tensor3};
use crate::manifold::Manifold;
use crate::manifold::surface::FeatureOptions;
use crate::manifold::surface::metric::{CovariantHessian, Spec, SurfaceMetric, TangentPlanes, filled, hessians_on};
use crate::mesh::{Solution, SolutionValues};
use crate::metric::Norm;
use crate::metric::nodal::{Limit, Limits, Outcome, Pipeline, Source, Vertices, complexity, weighted};

/// The metric that several make at the vertices of a surface: steps, limits and figures are those of [`Pipeline`], tensors those of tangent
/// planes. The surface is cut along its features, so that each of its sides has a metric of its own; a vertex of several sides then gets a
/// tensor that is as fine in each as that asks for. Tensors of space are in the order of the surface's vertices.
///
/// Second derivatives come from [`SurfaceSource::Function`] by recovery, and from `hessian:EXPR` as they are.
///
/// # Errors
/// As of [`Pipeline::run`] and [`super::metric_on_surface`].
pub fn metric_at_vertices(
    pipeline: &Pipeline,
    surface: Manifold,
    sources: Vec<SurfaceSource>,
) -> Result<(Outcome, Solution)> {
    let manifold = surface.cut(&FeatureOptions::default())?;
    let vertices = TangentPlanes::to_join(&manifold);
    let pipeline = Pipeline { limits: spread(&pipeline.limits, &manifold)?, ..pipeline.clone() };
    let sources = sources.into_iter().map(|source| at(source, &manifold, &vertices)).collect::<Result<Vec<_>>>()?;
    let made = pipeline.run_on(&vertices, &sources)?;
    let joined = vertices.joined(&made.tensors);
    let tensors = vertices.seen(&joined);
    let entries = joined[..manifold.seams().vertices_before()].iter().map(|m| m.to_disk()).collect();
    let outcome = Outcome { complexity: complexity(&vertices, &tensors), tensors, ..made };
    Ok((outcome, Solution { dimension: 3, values: SolutionValues::Tensor3(entries) }))
}

/// What a source says at the vertices.
fn at(source: SurfaceSource, manifold: &Manifold, vertices: &TangentPlanes) -> Result<Source> {
    let surface = manifold.surface();
    match source {
        SurfaceSource::Implied => Ok(Source::Metric(vertices.implied()?)),
        SurfaceSource::Function(values) => {
            let recovered = hessians_on(surface, &spread_values(values, manifold)?)?;
            let known: Vec<Tensor> = recovered.iter().flatten().map(|found| found.1).collect();
            let mut absolute = weighted(&known, Norm::GREATEST)?.into_iter();
            let mut in_space =
                |found: &(TangentPlane, Tensor)| absolute.next().map(|m| found.0.extend(m, m.eigen().large));
            let known: Vec<Option<Tensor3>> = recovered.iter().map(|found| in_space(found.as_ref()?)).collect();
            // A vertex with neighbours that know nothing either asks for nothing: less than any that does.
            let least = known.iter().flatten().map(|m| m.eigen().values[2]).fold(f64::INFINITY, f64::min);
            let nothing = Tensor3::IDENTITY * if least.is_finite() { least } else { 1.0 };
            let filled = filled(surface, &known, nothing);
            let signed = |(found, filled): (&Option<(TangentPlane, Tensor)>, Tensor3)| {
                found.as_ref().map_or(filled, |(plane, hessian)| plane.extend(*hessian, 0.0))
            };
            let hessians: Vec<Tensor3> = recovered.iter().zip(filled).map(signed).collect();
            Ok(Source::Hessian(vertices.seen(&hessians)))
        }
        SurfaceSource::Named(Spec::Hessian(function)) => {
            let field = CovariantHessian::new(function, manifold, Norm::default())?;
            let hessian = |v: u32| {
                let second = vertices.place(manifold, v).map(|place| field.second_derivatives(&place));
                second.map_or(Tensor3::default(), |(plane, hessian)| plane.extend(hessian, 0.0))
            };
            let hessians: Vec<Tensor3> = (0..vertices.count() as u32).map(hessian).collect();
            Ok(Source::Hessian(vertices.seen(&hessians)))
        }
        _ => {
            let (field, _) = named(source, manifold, &MetricOptions::default(), GradedAt::Scale(1.0))?;
            let tensor = |v: u32| vertices.place(manifold, v).map_or(Tensor3::IDENTITY, |place| field.at(&place));
            let tensors: Vec<Tensor3> = (0..vertices.count() as u32).map(tensor).collect();
            Ok(Source::Metric(vertices.seen(&tensors)))
        }
    }
}

/// Limits at the vertices of the surface, as limits at those that it has since it was cut.
fn spread(limits: &Limits, manifold: &Manifold) -> Result<Limits> {
    limits.check(manifold.seams().vertices_before())?;
    let originals = manifold.seams().originals();
    let spread = |limit: &Option<Limit>| match limit {
        Some(Limit::Field(values)) => Some(Limit::Field(originals.iter().map(|&v| values[v as usize]).collect())),
        other => other.clone(),
    };
    Ok(Limits { h_min: spread(&limits.h_min), h_max: spread(&limits.h_max), a_max: spread(&limits.a_max) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::{sphere, torus};
    use crate::mesh::Mesh;
    use crate::metric::{Bounds, recover_hessian};
    use crate::test_cases::cube;
    use std::collections::BTreeMap;

    fn tensors(solution: &Solution) -> Vec<Tensor3> {
        let SolutionValues::Tensor3(entries) = &solution.values else { panic!("tensors of space") };
        entries.iter().map(|&entries| Tensor3::from_disk(entries)).collect()
    }

    fn sizes(values: Vec<f64>) -> Solution {
        Solution { dimension: 3, values: SolutionValues::Scalar(values) }
    }

    fn norm(p: f64) -> Norm {
        Norm::new(p).unwrap()
    }

    /// The unit cube, its sides sharing vertices.
    fn welded_cube(n: u32) -> Mesh {
        let mut mesh = cube(n, 0.0);
        let mut number = BTreeMap::new();
        let mut points = Vec::new();
        let to: Vec<u32> = mesh
            .points
            .iter()
            .map(|p| {
                *number.entry(p.map(f64::to_bits)).or_insert_with(|| {
                    points.push(*p);
                    points.len() as u32 - 1
                })
            })
            .collect();
        mesh.triangles.iter_mut().flatten().for_each(|v| *v = to[*v as usize]);
        Mesh { points, triangles: mesh.triangles, ..Mesh::default() }
    }

    /// A tilted square as 2 n^2 triangles, and the same in the plane.
    fn tilted(n: u32) -> (Mesh, Mesh, [crate::geometry::Vector3; 2]) {
        let flat = crate::metric::nodal::test_meshes::grid(n, 0.3);
        let axes = [crate::geometry::Vector3::new(0.6, 0.0, 0.8), crate::geometry::Vector3::new(0.0, 1.0, 0.0)];
        let lifted = |p: &[f64; 3]| (crate::geometry::Point3::default() + axes[0] * p[0] + axes[1] * p[1]).to_array();
        (Mesh { points: flat.points.iter().map(lifted).collect(), ..flat.clone() }, flat, axes)
    }

    /// What the pipeline makes in the plane it makes on a plane in space.
    #[test]
    fn a_tilted_plane_is_the_plane() {
        let (mesh, flat, axes) = tilted(12);
        let values: Vec<f64> = flat.points.iter().map(|p| (4.0 * p[0]).sin() + p[0] * p[1]).collect();
        let given: Vec<f64> = flat.points.iter().map(|p| 0.05 + 0.1 * p[1]).collect();
        let pipeline = Pipeline {
            norm: norm(2.0),
            target_complexity: Some(700.0),
            limits: Bounds { h_min: Some(0.01), h_max: Some(0.3), a_max: Some(20.0) }.into(),
            gradation_factor: Some(1.3),
            ..Pipeline::default()
        };
        let in_plane = pipeline
            .run(
                &flat,
                &[
                    Source::Hessian(recover_hessian(&flat, &values, crate::metric::Recovery::Fit).unwrap()),
                    Source::Metric(crate::metric::nodal::isotropic(&flat, &given).unwrap()),
                    Source::Metric(crate::metric::nodal::implied(&flat).unwrap()),
                ],
            )
            .unwrap();
        let given = sizes(given);
        let sources = vec![SurfaceSource::Function(&values), SurfaceSource::Values(&given), SurfaceSource::Implied];
        let (made, solution) = metric_at_vertices(&pipeline, Manifold::of(&mesh).unwrap(), sources).unwrap();
        assert!((made.complexity / 700.0 - 1.0).abs() < 1e-6, "{}", made.complexity);
        // Gradation between planes settles to a hundredth of a size.
        for (found, truth) in tensors(&solution).iter().zip(&in_plane.tensors) {
            let m = Tensor::new(found.dot(axes[0], axes[0]), found.dot(axes[0], axes[1]), found.dot(axes[1], axes[1]));
            let d = m + *truth * -1.0;
            assert!(d.xx.abs() + d.xy.abs() + d.yy.abs() < 0.05 * (truth.xx + truth.yy), "{m:?} {truth:?}");
        }
    }

    /// Along great circles of the unit sphere x is a sine: its second derivatives are -x in all directions.
    #[test]
    fn coordinates_of_the_sphere_have_the_sizes_of_their_closed_form() {
        let surface = || Manifold::new(sphere(1.0, 0.08).unwrap(), None);
        let values: Vec<f64> = surface().positions().iter().map(|p| p.x).collect();
        let x = Spec::parse("hessian:x").unwrap();
        let complexity = 2000.0;
        let pipeline =
            Pipeline { norm: norm(f64::INFINITY), target_complexity: Some(complexity), ..Pipeline::default() };
        // In the maximum norm M = c |x| I; the integral of |x| over the sphere is 2 pi.
        let c = complexity / std::f64::consts::TAU;
        for source in [SurfaceSource::Function(&values), SurfaceSource::Named(&x)] {
            let (made, solution) = metric_at_vertices(&pipeline, surface(), vec![source]).unwrap();
            assert!((made.complexity / complexity - 1.0).abs() < 1e-9);
            for (m, p) in tensors(&solution).iter().zip(surface().positions()).filter(|(_, p)| p.x.abs() > 0.2) {
                let plane = TangentPlane::new((*p - crate::geometry::Point3::default()).unit().unwrap());
                let d = plane.restrict(*m) + Tensor::IDENTITY * (-c * p.x.abs());
                assert!(d.xx.abs() + d.xy.abs() + d.yy.abs() < 0.03 * c, "{p} {d:?}");
            }
        }
    }

    #[test]
    fn even_triangles_imply_sizes_that_count_them() {
        let surface = Manifold::new(torus(2.0, 0.7, 0.1).unwrap(), None);
        let triangles = surface.topology().faces().count() as f64;
        let (made, _) = metric_at_vertices(&Pipeline::default(), surface, vec![SurfaceSource::Implied]).unwrap();
        let count = made.complexity / (0.75_f64.sqrt() / 2.0);
        assert!((count / triangles - 1.0).abs() < 0.02, "{count} of {triangles}");
    }

    /// On a cube sides meet at right angles: sizes come out as they went in, and what is asked for on one side across its border is no
    /// finer on the others.
    #[test]
    fn sides_of_a_crease_have_one_tensor() {
        let mesh = welded_cube(6);
        let surface = || Manifold::of(&mesh).unwrap();
        let given = sizes(vec![0.2; mesh.points.len()]);
        let pipeline = Pipeline { gradation_factor: None, ..Pipeline::default() };
        let (made, solution) = metric_at_vertices(&pipeline, surface(), vec![SurfaceSource::Values(&given)]).unwrap();
        assert!(tensors(&solution).iter().all(|m| (m.xx - 25.0).abs() + m.xy.abs() + (m.zz - 25.0).abs() < 1e-9));
        assert!((made.complexity / 150.0 - 1.0).abs() < 1e-9, "{}", made.complexity);
        let thin = Spec::parse("formula:1; 0; 4; 0; 0; 400").unwrap();
        let (made, solution) =
            metric_at_vertices(&Pipeline::default(), surface(), vec![SurfaceSource::Named(&thin)]).unwrap();
        let sides = 2.0 * (2.0 + 20.0 + 40.0);
        assert!((made.complexity / sides - 1.0).abs() < 1e-9, "{}", made.complexity);
        for (m, p) in tensors(&solution).iter().zip(surface().positions()) {
            let is_crease = p.to_array().iter().filter(|x| (*x - 0.5).abs() > 0.499).count() > 1;
            let d = *m + Tensor3::from_disk([1.0, 0.0, 4.0, 0.0, 0.0, 400.0]) * -1.0;
            assert!(!is_crease || d.to_disk().iter().all(|entry| entry.abs() < 1e-9), "{p} {m:?}");
        }
    }

    #[test]
    fn limits_of_vertices_are_those_of_the_file() {
        let mesh = welded_cube(4);
        let surface = || Manifold::of(&mesh).unwrap();
        let uniform = Spec::parse("uniform").unwrap();
        let limit = |h_max: Vec<f64>| Pipeline {
            limits: Limits { h_max: Some(Limit::Field(h_max)), ..Limits::default() },
            ..Pipeline::default()
        };
        let made = |pipeline: &Pipeline| metric_at_vertices(pipeline, surface(), vec![SurfaceSource::Named(&uniform)]);
        let wanted: Vec<f64> = (0..mesh.points.len()).map(|v| if v % 2 == 0 { 0.5 } else { 3.0 }).collect();
        let (_, solution) = made(&limit(wanted)).unwrap();
        for (v, m) in tensors(&solution).iter().enumerate() {
            assert!((m.xx - if v % 2 == 0 { 4.0 } else { 1.0 }).abs() < 1e-9, "{v} {m:?}");
        }
        let error = made(&limit(vec![1.0; 7])).unwrap_err();
        assert!(error.to_string().contains("h_max has 7 values for"), "{error}");
    }
}
