//! The sizes by which a planar mesh is made anew.

use super::field::{background_vertices, even, tensors};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Point, Tensor};
use crate::manifold::domain::{Position, RemeshInput, position_of};
use crate::manifold::surface::FeatureOptions;
use crate::manifold::surface::metric::Sizing;
use crate::mesh::{Mesh, Solution, SolutionValues};
use crate::metric::nodal::{Pipeline, Source, complexity, implied, isotropic};
use crate::metric::{Bounds, MetricField, Sampled, check_at_vertices, nearby};
use crate::planar::{Planar, delaunay};
use crate::sampling::CurveSizes;
use std::collections::HashMap;

/// What sizes are asked for, besides those of curves and the greatest one.
#[derive(Clone, Debug)]
pub enum Asked {
    /// None.
    Nothing,
    /// Those that the mesh has.
    Own,
    /// Sizes or tensors at its vertices.
    Values(SolutionValues),
}

/// Sizes or tensors at the vertices of a mesh.
#[derive(Clone, Debug)]
pub struct RemeshSizes {
    mesh: Mesh,
    tensors: Vec<Tensor>,
    is_anisotropic: bool,
}

impl RemeshInput {
    /// What is asked for, as fine along curves as these need to be within `hausd` (`CurveSizes`) and at required edges as these are,
    /// within limits, graded ([`crate::metric::nodal::grade`]): at the vertices of the mesh, if sizes there are asked for, else at those of a
    /// triangulation that is fine enough.
    ///
    /// # Errors
    /// Parameters out of range; values that are no metric at the vertices; no triangles whose sizes could be kept.
    pub fn sizes(&self, asked: &Asked, sizing: &Sizing) -> Result<RemeshSizes> {
        sizing.check()?;
        let is_anisotropic = match asked {
            Asked::Values(values) => !matches!(values, SolutionValues::Scalar(_)),
            Asked::Nothing | Asked::Own => sizing.anisotropic,
        };
        let ar = self.keep.features.ar.unwrap_or(FeatureOptions::DEFAULT_ANGLE);
        let curves = CurveSizes::new(self.domain.pslg(), sizing.hausd, ar);
        let making = Making { curves, required: &self.required_lengths, sizing, is_anisotropic };
        match asked {
            Asked::Nothing => making.on_background(self.domain.planar()),
            Asked::Own => making.at_vertices(self.given.clone(), Some(self.own(is_anisotropic)?)),
            Asked::Values(values) => {
                let mesh = triangulated(&self.given)?;
                let tensors = metric(&mesh, values)?;
                making.at_vertices(mesh, Some(tensors))
            }
        }
    }

    /// The metric that the mesh implies, or the size of as much area.
    fn own(&self, is_anisotropic: bool) -> Result<Vec<Tensor>> {
        if self.given.triangles.is_empty() {
            let help = "leave out -optim, or give a mesh with triangles";
            return Err(Error::unsupported("the sizes of a domain without a mesh (-optim)", help));
        }
        let even = |m: Tensor| Tensor::isotropic(m.determinant().raised_to(-0.25));
        let implied = implied(&self.given)?;
        Ok(if is_anisotropic { implied } else { implied.into_iter().map(even).collect() })
    }

    /// The limits on sizes (least, greatest) where none are given, as mmg2d has them: 0.001 and 2 times the domain's extent; with values,
    /// a tenth of the least and ten times the greatest size.
    ///
    /// # Errors
    /// Values that are no metric at the vertices.
    pub fn default_limits(&self, asked: &Asked) -> Result<[f64; 2]> {
        let Asked::Values(values) = asked else {
            let extent = self.domain.bounds().extent();
            return Ok([1e-3, 2.0].map(|share| share * extent.x.max(extent.y)));
        };
        let mesh = triangulated(&self.given)?;
        let sizes =
            metric(&mesh, values)?.into_iter().map(|m| [m.eigen().large, m.eigen().small].map(|x| x.raised_to(-0.5)));
        let [least, most] = sizes.fold([f64::INFINITY, 0.0], |[a, b]: [f64; 2], [h, g]| [a.min(h), b.max(g)]);
        Ok([0.1 * least, 10.0 * most])
    }
}

impl RemeshSizes {
    /// The field of these values, log-Euclidean between vertices.
    ///
    /// # Errors
    /// As [`Sampled::new`].
    pub fn field(&self) -> Result<Sampled> {
        Sampled::new(&self.mesh, &self.tensors)
    }

    /// A field's values at points, sizes or tensors as these are.
    pub fn solution(&self, field: &dyn MetricField, points: &[[f64; 3]]) -> Solution {
        let at = nearby(field);
        let tensors = points.iter().map(|p| at(Point::new(p[0], p[1])));
        let values = if self.is_anisotropic {
            SolutionValues::Tensor(tensors.map(|m| [m.xx, m.xy, m.yy]).collect())
        } else {
            SolutionValues::Scalar(tensors.map(|m| m.xx.raised_to(-0.5)).collect())
        };
        Solution { dimension: 2, values }
    }
}

/// Vertices of the triangulation that sizes are made on first, besides those of the domain, and of the last one at least. With none of its
/// own in a disc with 1,200 on its borders a mesh with `hausd` took a third more time: where sizes come from borders alone they are too small in between.
const FIRST: usize = 1_000;
/// Its edges are measured by their ends from the first on: what asks for small sizes, curves and required edges, has vertices itself. The
/// number of vertices and the mean quality of meshes are those with care, within 0.2 % (a disc with holes, the Aegean).
const BY_ENDS: usize = 0;

/// What sizes are made of, wherever that is.
struct Making<'a> {
    curves: CurveSizes,
    required: &'a HashMap<Position, f64>,
    sizing: &'a Sizing,
    is_anisotropic: bool,
}

impl Making<'_> {
    fn at_vertices(&self, mesh: Mesh, given: Option<Vec<Tensor>>) -> Result<RemeshSizes> {
        let of_curves = (0..mesh.points.len() as u32).map(|v| self.of_curves(mesh.point(v))).collect();
        let sources: Vec<Source> = given.into_iter().chain([of_curves]).map(Source::Metric).collect();
        let limits = Bounds { h_min: Some(self.sizing.h_min), h_max: Some(self.sizing.h_max), a_max: None };
        let pipeline = Pipeline { limits: limits.into(), gradation_factor: self.sizing.hgrad, ..Pipeline::default() };
        let tensors = pipeline.run(&mesh, &sources)?.tensors;
        Ok(RemeshSizes { mesh, tensors, is_anisotropic: self.is_anisotropic })
    }

    /// On a triangulation that is even in what comes out, some times as fine as the mesh will be: first on one that is even.
    fn on_background(&self, domain: &Planar) -> Result<RemeshSizes> {
        let uniform = Tensor::isotropic(self.sizing.h_max);
        let first = domain.topology.vertex_count() + FIRST;
        let first = self.at_vertices(even(&move |_: Point| uniform, domain, BY_ENDS, first)?, None)?;
        if first.tensors.iter().all(|&tensor| tensor == uniform) {
            return Ok(first);
        }
        let vertices = background_vertices(complexity(&first.mesh, &first.tensors), FIRST);
        self.at_vertices(even(&first.field()?, domain, BY_ENDS, vertices)?, None)
    }

    /// What curves and required edges ask for, within the greatest size.
    fn of_curves(&self, p: Point) -> Tensor {
        let most = self.sizing.h_max;
        let required = self.required.get(&position_of(p)).map_or(most, |h| h.min(most));
        match self.curves.at(p) {
            Some((h, along)) if self.is_anisotropic => {
                let bend = Tensor::from_axis(along, 1.0 / (h * h).min(most * most), 1.0 / (most * most));
                bend.intersection(Tensor::isotropic(required))
            }
            found => Tensor::isotropic(found.map_or(required, |(h, _)| h.min(required))),
        }
    }
}

/// A mesh of the same vertices with triangles: its own, else the Delaunay triangulation.
fn triangulated(mesh: &Mesh) -> Result<Mesh> {
    if mesh.points.is_empty() {
        let what = "sizes at the vertices of a domain without a mesh";
        return Err(Error::unsupported(what, "give IN as the mesh that they belong to, such as a .mesh"));
    }
    if !mesh.triangles.is_empty() {
        return Ok(mesh.clone());
    }
    let points: Vec<Point> = (0..mesh.points.len() as u32).map(|v| mesh.point(v)).collect();
    let planar = delaunay(&points).map_err(|[i, j]| {
        let place = format!("{} and {}", mesh.describe(i as usize), mesh.describe(j as usize));
        Error::domain("two vertices have the same position", place, "merge them into one vertex")
    })?;
    let faces = planar.topology.faces().map(|face| planar.topology.corners(face).map(|v| v.0));
    let triangles = faces.filter(|corners| corners.iter().all(|&v| (v as usize) < points.len())).collect();
    Ok(Mesh { points: mesh.points.clone(), triangles, ..Mesh::default() })
}

/// Values at the vertices of a mesh as tensors.
fn metric(mesh: &Mesh, values: &SolutionValues) -> Result<Vec<Tensor>> {
    let tensors = match values {
        SolutionValues::Scalar(sizes) => isotropic(mesh, sizes)?,
        // Of a planar mesh in dimension 3.
        SolutionValues::Tensor3(entries) => entries.iter().map(|m| Tensor::new(m[0], m[1], m[2])).collect(),
        _ => tensors(values, "the metric")?,
    };
    check_at_vertices(mesh, &tensors)?;
    Ok(tensors)
}
