//! A planar domain in parts: cut along edges of a coarse mesh in the same metric.

use super::bisect::{areas_of, counts, owners};
use super::region::{refuse_label, submesh};
use super::stitch::{Kept, Position};
use super::{COARSE, Divisible, Make, Part, Partition, in_parts, number_of_parts, with_count};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geodesic::chord_by;
use crate::geometry::{Point, Point3, Tensor, centroid};
use crate::lists::{Rows, distinct, in_order};
use crate::manifold::domain::{Domain, Segment, from_mesh};
use crate::mesh::{EdgeSide, Edges, Mesh};
use crate::metric::{MetricField, Sampled, complexities, nearby};
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::quality::{self, Validity};
use crate::recipe::plane::{Case, Job};
use crate::recipe::stopwatch::Stopwatch;
use crate::recipe::{Aim, Effort, MeshOptions, Meshed, mesh, mesh_for};
use crate::sampling::{MetricArc, Plan, pieces};
use std::collections::{HashMap, HashSet};

/// The mesh of a part of a planar domain. The field is asked where the part has no metric of its own.
///
/// # Errors
/// As of [`mesh_for`].
pub fn mesh_part(
    part: &Part,
    field: &dyn MetricField,
    aim: Option<Aim>,
    options: &MeshOptions,
    progress: &dyn Progress,
) -> Result<Mesh> {
    let domain = from_mesh(&part.domain)?.validated()?;
    let own = part.metric.as_ref().map(|(mesh, tensors)| Sampled::new(mesh, tensors)).transpose()?;
    let field = own.as_ref().map_or(field, |own| own);
    Ok(mesh_for(&domain, field, aim, &with_count(options, part.vertices), progress)?.mesh)
}

/// Meshes a planar domain by a metric in so many parts, or in parts of about 100,000 vertices. There are three rounds of [`Part`]s: the
/// parts themselves (`parts`), strips along the cuts (`strips`), and what is around the ends of strips that meet (`junctions`). The outer
/// edges of these stay. With an aim, parts ask for the metric as a whole. The meshes of a round are the business of `make`, which has its name, and
/// hands them over in the order of its parts: by [`mesh_part`], wherever that may be. The number of vertices is met exactly.
///
/// # Errors
/// As of [`mesh_for`], and of `make`. [`Error::Unsupported`](crate::Error::Unsupported) of options that need the whole domain: periodic pairs, the net, star sets,
/// seeding other than by sizes. [`Error::Limit`](crate::Error::Limit) where parts would have fewer than 1,000 vertices.
pub fn mesh_in_parts(
    domain: &Domain,
    field: &dyn MetricField,
    aim: Option<Aim>,
    parts: Option<usize>,
    options: &MeshOptions,
    make: Make,
    progress: &dyn Progress,
) -> Result<Meshed> {
    in_parts(&InPlane { domain, field, is_whole: aim.is_some() }, parts, options, make, progress)
}

/// A domain with its metric.
#[derive(Clone, Copy)]
struct InPlane<'a> {
    domain: &'a Domain,
    field: &'a dyn MetricField,
    /// Whether parts need all of it.
    is_whole: bool,
}

impl Divisible for InPlane<'_> {
    fn partition(&self, parts: Option<usize>, options: &MeshOptions, progress: &dyn Progress) -> Result<Partition> {
        let field = self.field;
        self.domain.pslg().segments.iter().try_for_each(|segment| refuse_label(segment.label))?;
        // The limit is that of each part.
        let (options, watch) = (MeshOptions { memory_limit: u64::MAX, ..options.clone() }, Stopwatch::new(progress));
        let mut job = Job::new(&Case { domain: self.domain, field, aim: None, options: &options, progress }, &watch);
        let (plan, count, scale) = job.plan()?;
        let vertices = count - plan.copies();
        let parts = number_of_parts(vertices, parts)?;
        let coarse = coarse_mesh(&plan.domain, field, parts, &options, progress)?;
        let corners: Vec<[Point; 3]> = coarse.triangles.iter().map(|&triangle| coarse.corners_of(triangle)).collect();
        let areas = complexities(field, &corners)?;
        let centres: Vec<Point3> = corners.iter().map(|&corners| in_space(centroid(corners))).collect();
        let owner = owners(&coarse.triangles, &centres, &areas, parts);
        let domains = Cuts::new(&coarse, &owner, field, scale).domains(parts)?;
        let of_part = |(domain, area)| Plan::with(domain, Vec::new(), field, area);
        let plans: Vec<Plan> = domains.into_iter().zip(areas_of(&owner, &areas, parts)).map(of_part).collect();
        let counts = counts_of(&plans, scale, vertices);
        let part = |(plan, vertices): (&Plan, usize)| Part::new(self, corner_mesh(&plan.domain), vertices);
        let parts = plans.iter().zip(counts).map(part);
        let (complexity, kept) = (plan.complexity, kept(&plan.domain));
        Ok(Partition { parts: parts.collect(), scale, complexity, vertices, notes: job.notes, kept })
    }

    /// That of a domain whose straight runs have no vertices inside.
    fn job(&self, region: Mesh) -> Result<Mesh> {
        Ok(corner_mesh(&Domain::new(&from_mesh(&region)?)?))
    }

    fn metric_on(&self, domain: &Mesh) -> Option<(Mesh, Vec<Tensor>)> {
        if self.is_whole { None } else { self.field.excerpt(domain) }
    }

    fn check(&self, mesh: &Mesh) -> Result<Validity> {
        let found = quality::validity(mesh);
        found.demand().map(|()| found)
    }

    fn logarithms(&self, mesh: &Mesh, edges: &[[u32; 2]]) -> Vec<f64> {
        let of_chunk = |chunk: &[[u32; 2]]| {
            let at = nearby(self.field);
            let logarithm =
                |&[a, b]: &[u32; 2]| chord_by(&at, mesh.point(a), mesh.point(b)).max(f64::MIN_POSITIVE).logarithm();
            chunk.iter().map(logarithm).collect::<Vec<f64>>()
        };
        edges.par_chunks(1024).flat_map_iter(of_chunk).collect()
    }
}

fn in_space(p: Point) -> Point3 {
    Point3::new(p.x, p.y, 0.0)
}

fn position_of(p: Point) -> Position {
    super::stitch::position_of([p.x, p.y, 0.0])
}

/// Corners and required edges are those of the domain, not those that parts have to keep.
fn kept(domain: &Domain) -> Kept {
    let graph = domain.pslg();
    let place = |v: u32| position_of(graph.points[v as usize]);
    let required = graph.segments.iter().filter(|segment| segment.required);
    Kept {
        corners: (0..graph.points.len() as u32).map(place).collect(),
        points: graph.required_points.iter().map(|&v| place(v)).collect(),
        edges: required.map(|segment| in_order(segment.ends.map(place))).collect(),
        ridges: HashSet::new(),
    }
}

/// A domain as a mesh of its corners.
fn corner_mesh(domain: &Domain) -> Mesh {
    domain.mesh_of(domain.planar(), |v| domain.sources()[v.index()])
}

/// A mesh in the same metric with few vertices: its edges are short in the metric for what they part.
fn coarse_mesh(
    domain: &Domain,
    field: &dyn MetricField,
    parts: usize,
    options: &MeshOptions,
    progress: &dyn Progress,
) -> Result<Mesh> {
    let corners = domain.planar().topology.vertex_count();
    let options = MeshOptions { effort: Effort::Fast, ..with_count(options, corners + COARSE * parts) };
    Ok(mesh(domain, field, &options, progress)?.mesh)
}

/// The edges of a coarse mesh along which a domain is cut.
struct Cuts<'a> {
    coarse: &'a Mesh,
    owner: &'a [u32],
    /// The points at which they are cut themselves, from the end with the smaller number, by the positions of their ends.
    points: HashMap<[Position; 2], Vec<Point>>,
    ends: Vec<[u32; 2]>,
}

impl<'a> Cuts<'a> {
    fn new(coarse: &'a Mesh, owner: &'a [u32], field: &dyn MetricField, scale: f64) -> Self {
        let edges = Edges::of(&coarse.triangles);
        let is_cut = |sides: &[EdgeSide]| sides.iter().any(|s| owner[s.triangle()] != owner[sides[0].triangle()]);
        let ends: Vec<[u32; 2]> = edges.iter().filter(|sides| is_cut(sides)).map(|sides| sides[0].ends).collect();
        let whole: HashSet<[u32; 2]> =
            coarse.required_edges.iter().map(|&e| in_order(coarse.edges[e as usize])).collect();
        let sampled = |ends: &[u32; 2]| {
            let [a, b] = ends.map(|v| coarse.point(v));
            let arc = MetricArc::of_chord(field, [a, b]);
            let n = if whole.contains(ends) { 1 } else { pieces(arc.length() * scale.sqrt()) };
            let points = (1..n).map(|k| a.lerp(b, arc.parameter(k as f64 / n as f64)));
            ([a, b].map(position_of), points.collect())
        };
        let points = ends.par_iter().map(sampled).collect::<Vec<_>>().into_iter().collect();
        Self { coarse, owner, points, ends }
    }

    fn domains(&self, parts: usize) -> Result<Vec<Domain>> {
        let triangles = Rows::new(parts, (0..).zip(self.owner).map(|(t, &part)| (part, t)));
        (0..parts).map(|part| self.domain(triangles.row(part))).collect()
    }

    /// The domain of some triangles, with its cuts as required edges.
    fn domain(&self, triangles: &[u32]) -> Result<Domain> {
        let (mut part, cuts) = submesh(self.coarse, triangles, &self.ends);
        part.require(cuts);
        let mut pslg = from_mesh(&part)?;
        let mut segments = Vec::with_capacity(pslg.segments.len());
        for segment in std::mem::take(&mut pslg.segments) {
            let cut = self.between(segment.ends.map(|v| position_of(pslg.points[v as usize])));
            let required = segment.required || cut.is_some();
            let mut last = segment.ends[0];
            for p in cut.unwrap_or_default() {
                let new = pslg.points.len() as u32;
                pslg.points.push(p);
                pslg.point_labels.push(0);
                segments.push(Segment { ends: [last, new], required, ..segment });
                last = new;
            }
            segments.push(Segment { ends: [last, segment.ends[1]], required, ..segment });
        }
        pslg.segments = segments;
        pslg.names.clear();
        Domain::new(&pslg)
    }
}

impl Cuts<'_> {
    /// The points of the cut between two places, if there is one.
    fn between(&self, [a, b]: [Position; 2]) -> Option<Vec<Point>> {
        let backward = || self.points.get(&[b, a]).map(|points| points.iter().rev().copied().collect());
        self.points.get(&[a, b]).cloned().or_else(backward)
    }
}

/// How many vertices the parts have, those on cuts each counted in two.
fn counts_of(plans: &[Plan], scale: f64, vertices: usize) -> Vec<usize> {
    let corners = plans.iter().flat_map(|plan| plan.domain.pslg().points.iter().map(|&p| position_of(p)));
    let all = corners.clone().count();
    let shared = all - distinct(corners).len();
    let fixed: Vec<f64> = plans.iter().map(|plan| plan.boundary_vertices(scale) - plan.copies() as f64).collect();
    let inside: Vec<f64> =
        plans.iter().map(|plan| plan.expected_vertices(scale) - plan.boundary_vertices(scale)).collect();
    counts(&fixed, &inside, (vertices + shared) as f64)
}
