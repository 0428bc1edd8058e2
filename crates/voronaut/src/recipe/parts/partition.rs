//! Where a domain is cut, and what the parts are.

use super::{FEWEST, Part, VERTICES_PER_PART, with_count};
use crate::domain::{Domain, Segment, from_mesh};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::{Point, Vector, centroid};
use crate::lists::{Rows, distinct, in_order, marked, ranked};
use crate::mesh::{EdgeSide, Edges, Mesh};
use crate::metric::{MetricField, complexities};
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::recipe::remesh_input::{Position, position_of};
use crate::recipe::settle::Stopwatch;
use crate::recipe::{Effort, Job, MeshOptions, mesh};
use crate::sampling::{MetricArc, Plan, pieces};
use std::collections::{HashMap, HashSet};

/// The label of cuts.
pub(super) const CUT: i32 = i32::MIN;
/// Vertices per part of the mesh along whose edges the domain is cut.
const COARSE: usize = 64;
/// Sweeps over its triangles that make cuts shorter.
const SWEEPS: usize = 3;

/// A domain in parts.
pub(super) struct Partition {
    /// The domain whose curves are as simple as they may be.
    pub domain: Domain,
    /// The jobs.
    pub parts: Vec<Part>,
    /// The factor on the metric by which cuts are sampled.
    pub scale: f64,
    /// Vertices of the whole.
    pub vertices: usize,
    /// What could not be met.
    pub notes: Vec<String>,
}

impl Partition {
    pub(super) fn new(
        domain: &Domain,
        field: &dyn MetricField,
        parts: Option<usize>,
        options: &MeshOptions,
        progress: &dyn Progress,
    ) -> Result<Self> {
        if domain.pslg().segments.iter().any(|segment| segment.label == CUT) {
            let what = format!("a label {CUT} in a mesh that is made in parts");
            return Err(Error::unsupported(what, "give the curve another label: this one is that of cuts"));
        }
        // The limit is that of each part.
        let (options, watch) = (MeshOptions { memory_limit: u64::MAX, ..options.clone() }, Stopwatch::new(progress));
        let mut job = Job::new(field, &options, &watch);
        let (domain, plan, count, scale) = job.plan(domain)?;
        let vertices = count - plan.copies();
        let parts = parts.unwrap_or(vertices.div_ceil(VERTICES_PER_PART));
        if parts == 0 || vertices / parts < FEWEST {
            let what = format!("{vertices} vertices in {parts} parts");
            return Err(Error::limit(what, format!("let parts have {FEWEST} vertices at least")));
        }
        let coarse = coarse_mesh(&domain, field, parts, &options, progress)?;
        let (owner, areas) = owners(&coarse, field, parts)?;
        let domains = Cuts::new(&coarse, &owner, field, scale).domains(parts)?;
        let plan = |(domain, &area)| Plan::with(domain, &[], field, area);
        let plans: Vec<Plan> = domains.iter().zip(&areas).map(plan).collect();
        let counts = counts(&domains, &plans, scale, vertices);
        let parts = domains.iter().zip(counts).map(|(domain, vertices)| Part { domain: corner_mesh(domain), vertices });
        Ok(Self { parts: parts.collect(), domain, scale, vertices, notes: job.notes })
    }
}

/// A domain as a mesh of its corners.
pub(super) fn corner_mesh(domain: &Domain) -> Mesh {
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

/// The part of each triangle, by recursive bisection of their metric area across its longest extent; and the area of each part.
fn owners(coarse: &Mesh, field: &dyn MetricField, parts: usize) -> Result<(Vec<u32>, Vec<f64>)> {
    let corners: Vec<[Point; 3]> = coarse.triangles.iter().map(|&triangle| coarse.corners_of(triangle)).collect();
    let areas = complexities(field, &corners)?;
    let weighed = Weighed { centres: corners.iter().map(|&corners| centroid(corners)).collect(), areas };
    let mut owner = vec![0; corners.len()];
    weighed.bisect((0..corners.len() as u32).collect(), 0..parts as u32, &mut owner);
    shorten(coarse, &mut owner);
    let mut of_parts = vec![0.0; parts];
    owner.iter().zip(&weighed.areas).for_each(|(&part, area)| of_parts[part as usize] += area);
    Ok((owner, of_parts))
}

struct Weighed {
    centres: Vec<Point>,
    areas: Vec<f64>,
}

impl Weighed {
    fn bisect(&self, triangles: Vec<u32>, parts: std::ops::Range<u32>, owner: &mut [u32]) {
        if parts.len() < 2 || triangles.len() < 2 {
            for t in triangles {
                owner[t as usize] = parts.start;
            }
            return;
        }
        let middle = parts.start + parts.len() as u32 / 2;
        let (axis, whole) = self.longest_axis(&triangles);
        let along = |&t: &u32| (axis.dot(self.centres[t as usize] - Point::new(0.0, 0.0)), t);
        let sorted: Vec<u32> = ranked(triangles.iter().map(along)).into_iter().map(|(_, t)| t).collect();
        let share = whole * f64::from(middle - parts.start) / parts.len() as f64;
        let mut behind = 0.0;
        let ahead = sorted.iter().position(|&t| {
            let half = 0.5 * self.areas[t as usize];
            behind += 2.0 * half;
            behind - half > share
        });
        let cut = ahead.unwrap_or(sorted.len()).clamp(1, sorted.len() - 1);
        let (first, second) = sorted.split_at(cut);
        self.bisect(first.to_vec(), parts.start..middle, owner);
        self.bisect(second.to_vec(), middle..parts.end, owner);
    }

    /// The direction in which the metric area of triangles is spread most, and that area.
    fn longest_axis(&self, triangles: &[u32]) -> (Vector, f64) {
        let weighed =
            || triangles.iter().map(|&t| (self.areas[t as usize], self.centres[t as usize] - Point::new(0.0, 0.0)));
        let whole: f64 = weighed().map(|(area, _)| area).sum();
        let mean = weighed().fold(Vector::new(0.0, 0.0), |sum, (area, p)| sum + p * (area / whole));
        let [mut xx, mut xy, mut yy] = [0.0; 3];
        for (area, p) in weighed() {
            let d = p - mean;
            xx += area * d.x * d.x;
            xy += area * d.x * d.y;
            yy += area * d.y * d.y;
        }
        // The double angle of the principal axis of the second moments.
        let (even, odd) = (xx - yy, 2.0 * xy);
        let size = even.hypotenuse(odd);
        let cosine = if size > 0.0 { even / size } else { 1.0 };
        let (x, y) = ((0.5 * (1.0 + cosine)).sqrt(), (0.5 * (1.0 - cosine)).sqrt());
        (Vector::new(x, y.copysign(odd)), whole)
    }
}

/// Gives triangles to the part that two of their neighbours have.
fn shorten(coarse: &Mesh, owner: &mut [u32]) {
    let twins = Edges::of(&coarse.triangles).twins();
    let neighbour = |half_edge: usize| twins[half_edge] as usize / 3;
    for _ in 0..SWEEPS {
        for t in 0..owner.len() {
            let around = [0, 1, 2].map(|i| owner.get(neighbour(3 * t + i)).copied());
            let twice = (0..3).find(|&i| around[i].is_some() && around[i] == around[(i + 1) % 3]);
            if let Some(other) = twice.and_then(|i| around[i]) {
                owner[t] = other;
            }
        }
    }
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
        let is_cut = |sides: &&[EdgeSide]| sides.iter().any(|s| owner[s.triangle()] != owner[sides[0].triangle()]);
        let ends: Vec<[u32; 2]> = edges.iter().filter(is_cut).map(|sides| sides[0].ends).collect();
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
        let mut pslg = from_mesh(&submesh(self.coarse, triangles, &self.ends))?;
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

/// Some triangles of a mesh with what is on them. Edges of `rim` are required there, and have the label of cuts unless they have one.
pub(super) fn submesh(mesh: &Mesh, triangles: &[u32], rim: &[[u32; 2]]) -> Mesh {
    let taken: Vec<[u32; 3]> = triangles.iter().map(|&t| mesh.triangles[t as usize]).collect();
    let is_used = marked(mesh.points.len(), taken.as_flattened().iter().copied());
    let old: Vec<u32> = (0..).zip(&is_used).filter(|(_, used)| **used).map(|(v, _)| v).collect();
    let mut number = vec![u32::MAX; mesh.points.len()];
    (0..).zip(&old).for_each(|(new, &v)| number[v as usize] = new);
    let edges = Edges::of(&taken);
    let here = |ends: [u32; 2]| !edges.at(ends).is_empty();
    let numbers = |list: &[u32]| list.iter().map(|&v| number[v as usize]).filter(|&v| v != u32::MAX).collect();
    let mut part = Mesh {
        points: old.iter().map(|&v| mesh.points[v as usize]).collect(),
        point_labels: old.iter().map(|&v| mesh.point_labels[v as usize]).collect(),
        triangles: taken.iter().map(|t| t.map(|v| number[v as usize])).collect(),
        triangle_labels: triangles.iter().map(|&t| mesh.triangle_labels[t as usize]).collect(),
        corners: numbers(&mesh.corners),
        required_points: numbers(&mesh.required_points),
        ..Mesh::default()
    };
    let mut rim: HashMap<[u32; 2], bool> =
        rim.iter().filter(|&&ends| here(ends)).map(|&ends| (in_order(ends), false)).collect();
    let required = marked(mesh.edges.len(), mesh.required_edges.iter().copied());
    for (i, &ends) in mesh.edges.iter().enumerate().filter(|(_, ends)| here(**ends)) {
        let on_rim = rim.get_mut(&in_order(ends)).map(|is_listed| *is_listed = true).is_some();
        if on_rim || required[i] {
            part.required_edges.push(part.edges.len() as u32);
        }
        part.edges.push(ends.map(|v| number[v as usize]));
        part.edge_labels.push(mesh.edge_labels[i]);
    }
    let mut cuts: Vec<[u32; 2]> = rim.into_iter().filter(|(_, is_listed)| !is_listed).map(|(ends, _)| ends).collect();
    cuts.sort_unstable();
    for ends in cuts {
        part.required_edges.push(part.edges.len() as u32);
        part.edges.push(ends.map(|v| number[v as usize]));
        part.edge_labels.push(CUT);
    }
    part
}

/// How many vertices parts have, that they have so many together: what the metric asks for in each, and a common share more or less
/// inside.
fn counts(domains: &[Domain], plans: &[Plan], scale: f64, vertices: usize) -> Vec<usize> {
    let corners = domains.iter().flat_map(|domain| domain.pslg().points.iter().map(|&p| position_of(p)));
    let all = corners.clone().count();
    let shared = all - distinct(corners).len();
    let fixed: Vec<f64> = plans.iter().map(|plan| plan.boundary_vertices(scale) - plan.copies() as f64).collect();
    let inside: Vec<f64> =
        plans.iter().map(|plan| plan.expected_vertices(scale) - plan.boundary_vertices(scale)).collect();
    let (all, fixed_all) = ((vertices + shared) as f64, fixed.iter().sum::<f64>());
    // Where curves take all, as of narrow channels, roundings may take more: parts have their share of what there is.
    let thinned = (all / fixed_all).min(1.0);
    let share = (all - thinned * fixed_all) / inside.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let (mut sum, mut given) = (0.0, 0);
    let count = |(fixed, inside): (f64, f64)| {
        sum += thinned * fixed + share * inside;
        let upto = sum.round() as usize;
        let count = upto - given;
        given = upto;
        count
    };
    fixed.into_iter().zip(inside).map(count).collect()
}
