//! One mesh in parts that can be made anywhere: a domain is cut along edges of a coarse mesh, each part is an ordinary job whose cuts are
//! sampled first, and what was cut is made anew when the parts are one mesh again. The result depends on the input and the number of
//! parts alone, not on who makes the parts.

mod partition;
mod regions;
mod stitch;
#[cfg(test)]
mod tests;

use super::settle::Stopwatch;
use super::{Aim, MeshOptions, Meshed, Mesher, Seeding, closed_form_scale, mesh_for};
use crate::domain::{Domain, from_mesh};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geodesic::{chord_by, nearby};
use crate::lists::marked;
use crate::mesh::{Edges, Mesh};
use crate::metric::{MetricField, rough_complexity};
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::quality;
use partition::Partition;
use stitch::Whole;

/// Vertices of a part, where the number of parts follows from that of vertices: a minute's work.
const VERTICES_PER_PART: usize = 100_000;
/// No part has fewer: strips around its cuts would be most of it.
const FEWEST: usize = 1_000;

/// A job of a mesh in parts, for [`mesh_part`].
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its domain, as a mesh of its corners. Edges towards other parts are required, and have the label `i32::MIN` unless the domain has
    /// one there.
    pub domain: Mesh,
    /// Vertices of its mesh, exactly.
    pub vertices: usize,
}

/// The mesh of a part.
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
    let domain = Domain::new(&from_mesh(&part.domain)?)?;
    Ok(mesh_for(&domain, field, aim, &with_count(options, part.vertices), progress)?.mesh)
}

/// Meshes a planar domain by a metric in so many parts, or in parts of about 100,000 vertices. There are three rounds of [`Part`]s: the
/// parts themselves (`parts`), strips along the cuts (`strips`), and what is around the ends of strips that meet (`junctions`). The outer
/// edges of these stay. The meshes of a round, in the order of its parts, are the business of `make`, which has its name: by [`mesh_part`],
/// wherever that may be. The number of vertices is met exactly.
///
/// # Errors
/// As of [`mesh_for`], and of `make`. [`Error::Unsupported`] of options that need the whole domain: periodic pairs, the net, star sets,
/// seeding other than by sizes. [`Error::Limit`] where parts would have fewer than 1,000 vertices.
pub fn mesh_in_parts(
    domain: &Domain,
    field: &dyn MetricField,
    parts: Option<usize>,
    options: &MeshOptions,
    make: &mut impl FnMut(&'static str, &[Part]) -> Result<Vec<Mesh>>,
    progress: &dyn Progress,
) -> Result<Meshed> {
    demand_divisible(options)?;
    let watch = Stopwatch::new(progress);
    let cut = watch.time("partition", || Partition::new(domain, field, parts, options, progress))?;
    let mut notes = cut.notes;
    let meshes = watch.time("parts", || make("parts", &cut.parts))?;
    let mut whole = watch.time("stitch", || Whole::of_parts(cut.domain, &meshes));
    drop(meshes);
    let strips = watch.time("stitch", || whole.strips());
    remake(&mut whole, "strips", &strips, make, &watch)?;
    let junctions = watch.time("stitch", || whole.junctions());
    remake(&mut whole, "junctions", &junctions, make, &watch)?;
    progress.begin("checking", 1)?;
    let mesh = whole.mesh;
    watch.time("check", || quality::check(&mesh))?;
    if mesh.points.len() != cut.vertices {
        notes.push(format!(
            "{} vertices were asked for, but rounding leaves room for {}",
            cut.vertices,
            mesh.points.len()
        ));
    }
    let metric_scale = if options.vertices.is_some() { unit_factor(&mesh, field) } else { cut.scale };
    let closed_form_scale = match options.vertices {
        Some(count) => Some(closed_form_scale(count, rough_complexity(field, &domain.triangles())?)),
        None => None,
    };
    Ok(Meshed { mesh, metric_scale, closed_form_scale, seconds: watch.seconds(), notes, ..Meshed::default() })
}

/// Lets regions be made anew.
fn remake(
    whole: &mut Whole,
    round: &'static str,
    regions: &[Vec<u32>],
    make: &mut impl FnMut(&'static str, &[Part]) -> Result<Vec<Mesh>>,
    watch: &Stopwatch,
) -> Result<()> {
    if regions.is_empty() {
        return Ok(());
    }
    let jobs = watch.time("stitch", || whole.jobs(regions))?;
    let meshes = watch.time(round, || make(round, &jobs))?;
    watch.time("stitch", || whole.replace(regions, &meshes));
    Ok(())
}

/// Options of a mesh with so many vertices whose domain's corners all stay.
fn with_count(options: &MeshOptions, vertices: usize) -> MeshOptions {
    MeshOptions { vertices: Some(vertices), complexity: None, hausd: Some(0.0), ..options.clone() }
}

fn demand_divisible(options: &MeshOptions) -> Result<()> {
    let whole = [
        (!options.periodic.is_empty(), "periodic boundaries", "`periodic`"),
        (options.net, "the net", "`net`"),
        (options.mesher == Mesher::StarSet, "star sets", "`mesher`"),
        (options.seeding != Seeding::Sizing, "seeding other than by sizes", "`seeding`"),
    ];
    match whole.into_iter().find(|(is_asked, ..)| *is_asked) {
        None => Ok(()),
        Some((_, what, option)) => {
            let help = format!("leave out {option}, or `parts`: it is for the mesh as a whole");
            Err(Error::unsupported(format!("{what} of a mesh in parts"), help))
        }
    }
}

/// The factor on the metric for which edges that touch no curve of the domain have unit length in the (geometric) mean, as it is of
/// meshes of one piece.
fn unit_factor(mesh: &Mesh, field: &dyn MetricField) -> f64 {
    let on_curve = marked(mesh.points.len(), mesh.edges.as_flattened().iter().copied());
    let edges = Edges::of(&mesh.triangles);
    let ends: Vec<[u32; 2]> = edges.ends().filter(|ends| ends.iter().all(|&v| !on_curve[v as usize])).collect();
    let logarithms: Vec<f64> = ends
        .par_chunks(1024)
        .flat_map_iter(|chunk| {
            let at = nearby(field);
            let logarithm =
                |&[a, b]: &[u32; 2]| chord_by(&at, mesh.point(a), mesh.point(b)).max(f64::MIN_POSITIVE).logarithm();
            chunk.iter().map(logarithm).collect::<Vec<f64>>()
        })
        .collect();
    let count = logarithms.len().max(1) as f64;
    (-2.0 * logarithms.iter().sum::<f64>() / count).exponential()
}
