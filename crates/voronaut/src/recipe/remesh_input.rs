//! A planar mesh that is to be made anew: its domain, what of it is to be there again, and the sizes by which it is made.

use super::field::{background_vertices, even, tensors};
use crate::domain::{Domain, Pslg, from_mesh};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Point, Tensor};
use crate::lists::{distinct, in_order, marked};
use crate::mesh::{EdgeSide, Edges, Mesh, Solution, SolutionValues};
use crate::metric::nodal::{Pipeline, Source, complexity, implied, isotropic};
use crate::metric::{Bounds, MetricField, Sampled, check_at_vertices, nearby};
use crate::planar::delaunay;
use crate::sampling::CurveSizes;
use crate::surface::FeatureOptions;
use crate::surface::metric::Sizing;
use std::collections::{HashMap, HashSet};

/// What of a planar mesh is kept, besides boundary, interfaces, labels and what is required.
#[derive(Clone, Copy, Debug, Default)]
pub struct Keep {
    /// Which turns of curves are corners.
    pub features: FeatureOptions,
    /// The vertices and edges of all curves.
    pub curves: bool,
    /// Listed edges inside a region that are not required.
    pub inner_edges: bool,
    /// Whether sizes at required edges are as elsewhere, and not those of the edges if these are shorter.
    pub plain_sizes: bool,
}

/// A planar domain, and the mesh that it comes from if it has triangles.
#[derive(Debug)]
pub struct RemeshInput {
    /// The domain; turns are required points of it.
    pub domain: Domain,
    /// What was kept.
    pub keep: Keep,
    /// The mesh that values at vertices belong to: what was given, or a triangulation of its vertices.
    pub(super) given: Mesh,
    /// Edges of the list that are of no use, and were left out: they are no edges of triangles, or lie inside a region.
    pub left_out: usize,
    corners: HashSet<Position>,
    required: HashSet<Position>,
    required_edges: HashSet<[Position; 2]>,
    /// The mean length of the required edges, and of those that are kept, at each of their ends.
    pub(super) required_lengths: HashMap<Position, f64>,
}

/// A position to the last bit.
pub(super) type Position = [u64; 2];

impl RemeshInput {
    /// From a mesh.
    ///
    /// # Errors
    /// As of [`from_mesh`] and [`Domain::new`]; [`Error::Unsupported`] of required triangles.
    pub fn of_mesh(mesh: Mesh, keep: Keep) -> Result<Self> {
        mesh.check_numbers()?;
        mesh.demand_straight()?;
        if !mesh.required_triangles.is_empty() {
            let what = format!("{} RequiredTriangles of a planar mesh", mesh.required_triangles.len());
            let help = "require their edges (RequiredEdges), or leave them out of the mesh and put them back";
            return Err(Error::unsupported(what, help));
        }
        let (mesh, left_out) = without_useless_edges(mesh, keep.inner_edges);
        let own = |points: &[u32]| points.iter().map(|&v| position(mesh.points[v as usize])).collect();
        let required_edges = mesh
            .required_edges
            .iter()
            .map(|&e| in_order(mesh.edges[e as usize].map(|v| position(mesh.points[v as usize]))));
        let input = Self::of_graph(from_mesh(&mesh)?, keep)?;
        let corners: HashSet<Position> = own(&mesh.corners);
        Ok(Self {
            left_out,
            corners: &input.corners | &corners,
            required: own(&mesh.required_points),
            required_edges: required_edges.collect(),
            given: mesh,
            ..input
        })
    }

    /// From a graph that no mesh belongs to.
    ///
    /// # Errors
    /// As of [`Domain::new`].
    pub fn of_graph(mut pslg: Pslg, keep: Keep) -> Result<Self> {
        let at = |pslg: &Pslg, v: u32| position_of(pslg.points[v as usize]);
        let required: HashSet<Position> = pslg.required_points.iter().map(|&v| at(&pslg, v)).collect();
        let is_required = pslg.segments.iter().filter(|segment| segment.required);
        let required_edges = is_required.map(|segment| in_order(segment.ends.map(|v| at(&pslg, v)))).collect();
        let turns = pslg.corners(keep.features.ar);
        let corners = turns.iter().map(|&v| at(&pslg, v)).collect();
        pslg.required_points = distinct(pslg.required_points.into_iter().chain(turns));
        pslg.segments.iter_mut().for_each(|segment| segment.required |= keep.curves);
        let required_lengths = if keep.plain_sizes { HashMap::new() } else { required_lengths(&pslg) };
        let domain = Domain::new(&pslg)?;
        Ok(Self {
            domain,
            keep,
            given: Mesh::default(),
            left_out: 0,
            corners,
            required,
            required_edges,
            required_lengths,
        })
    }

    /// Tells of a mesh of the domain what was asked for by the user, and not only while it was made: corners, required vertices and
    /// edges.
    pub fn mark(&self, mesh: &mut Mesh) {
        let at = |v: u32| position(mesh.points[v as usize]);
        mesh.corners.retain(|&v| self.corners.contains(&at(v)));
        mesh.required_points.retain(|&v| self.required.contains(&at(v)));
        mesh.required_edges.retain(|&e| self.required_edges.contains(&in_order(mesh.edges[e as usize].map(at))));
    }
}

fn position([x, y, _]: [f64; 3]) -> Position {
    position_of(Point::new(x, y))
}

pub(super) fn position_of(p: Point) -> Position {
    [p.x.to_bits(), p.y.to_bits()]
}

fn required_lengths(pslg: &Pslg) -> HashMap<Position, f64> {
    let mut sums: HashMap<Position, (f64, f64)> = HashMap::new();
    for segment in pslg.segments.iter().filter(|segment| segment.required) {
        let ends = segment.ends.map(|v| pslg.points[v as usize]);
        for p in ends {
            let (sum, count) = sums.entry(position_of(p)).or_default();
            (*sum, *count) = (*sum + ends[0].distance(ends[1]), *count + 1.0);
        }
    }
    sums.into_iter().map(|(p, (sum, count))| (p, sum / count)).collect()
}

/// The mesh without edges that are no triangle's, and without those inside a region that are not required unless they are to be kept;
/// and how many these were. As mmg2d has it.
fn without_useless_edges(mut mesh: Mesh, inner: bool) -> (Mesh, usize) {
    if mesh.triangles.is_empty() {
        return (mesh, 0);
    }
    let edges = Edges::of(&mesh.triangles);
    let label = |side: &EdgeSide| mesh.triangle_labels.get(side.triangle()).copied().unwrap_or(0);
    let is_required = marked(mesh.edges.len(), mesh.required_edges.iter().copied());
    let is_kept = |e: usize| match &*edges.at(mesh.edges[e]) {
        [s, t] => label(s) != label(t) || inner || is_required[e],
        sides => !sides.is_empty(),
    };
    let kept: Vec<usize> = (0..mesh.edges.len()).filter(|&e| is_kept(e)).collect();
    let left_out = mesh.edges.len() - kept.len();
    mesh.required_edges = (0..).zip(&kept).filter(|&(_, &e)| is_required[e]).map(|(new, _)| new).collect();
    mesh.ridges.clear();
    mesh.edge_labels = kept.iter().map(|&e| mesh.edge_labels.get(e).copied().unwrap_or(0)).collect();
    mesh.edges = kept.iter().map(|&e| mesh.edges[e]).collect();
    (mesh, left_out)
}

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
        let curves = CurveSizes::new(&self.domain, sizing.hausd, ar);
        let making = Making { curves, required: &self.required_lengths, sizing, is_anisotropic };
        match asked {
            Asked::Nothing => making.on_background(&self.domain),
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
    fn on_background(&self, domain: &Domain) -> Result<RemeshSizes> {
        let uniform = Tensor::isotropic(self.sizing.h_max);
        let first = domain.planar().topology.vertex_count() + FIRST;
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
