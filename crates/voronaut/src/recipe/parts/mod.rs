//! One mesh in parts that can be made anywhere: a domain or a surface is cut, each part is an ordinary job whose cuts are
//! sampled first, and what was cut is made anew when the parts are one mesh again. The result depends on the input and the number of
//! parts alone, not on who makes the parts.

mod bisect;
mod plane;
mod region;
mod regions;
mod stitch;
mod surface;
#[cfg(test)]
mod test_surfaces;
#[cfg(test)]
mod tests;

use super::stopwatch::Stopwatch;
use super::{MeshOptions, Meshed, Mesher, Seeding, closed_form_scale};
use crate::elementary::Elementary;
use crate::error::{Error, Result};
use crate::geometry::Tensor;
use crate::lists::marked;
use crate::mesh::{Edges, Mesh};
use crate::progress::Progress;
use crate::quality::Validity;
pub use plane::{mesh_in_parts, mesh_part};
use stitch::{Joiner, Kept, Whole};
pub use surface::{mesh_surface_in_parts, mesh_surface_part};

/// Vertices of a part, where the number of parts follows from that of vertices: a minute's work.
const VERTICES_PER_PART: usize = 100_000;
/// No part has fewer: strips around its cuts would be most of it.
const FEWEST: usize = 1_000;
/// Edges that are measured at once: many for each core, and little memory.
const AT_ONCE: usize = 1 << 16;
/// Vertices per part of the triangles along whose edges is cut.
const COARSE: usize = 64;

/// A job of a mesh in parts, for [`mesh_part`] or [`mesh_surface_part`].
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its domain, as a mesh of its corners; of a surface its triangles, with all features as listed edges. Edges towards other parts have the
    /// label `i32::MIN` unless the domain has one there, and stay.
    pub domain: Mesh,
    /// Vertices of its mesh; in the plane exactly.
    pub vertices: usize,
    /// In the plane the metric there, where that is interpolated in a mesh: that part of it, with tensors at its vertices.
    pub metric: Option<(Mesh, Vec<Tensor>)>,
}

impl Part {
    fn new(on: &impl Divisible, domain: Mesh, vertices: usize) -> Self {
        let metric = on.metric_on(&domain);
        Self { domain, vertices, metric }
    }
}

/// What is divided: a planar domain or a surface, with its metric.
trait Divisible {
    /// Cuts it into so many parts, or into as many as there should be.
    fn partition(&self, parts: Option<usize>, options: &MeshOptions, progress: &dyn Progress) -> Result<Partition>;

    /// Adds to what is required of the whole what the parts have made of it.
    fn note_kept(&self, _kept: &mut Kept, _joined: &Mesh) {}

    /// The domain of a region of the mesh that is to be made anew. Its outer edges are required.
    fn job(&self, region: Mesh) -> Result<Mesh>;

    /// See [`Part::metric`].
    fn metric_on(&self, _domain: &Mesh) -> Option<(Mesh, Vec<Tensor>)> {
        None
    }

    /// That the whole is valid.
    fn check(&self, mesh: &Mesh) -> Result<Validity>;

    /// The logarithms of the metric lengths of edges.
    fn logarithms(&self, mesh: &Mesh, edges: &[[u32; 2]]) -> Vec<f64>;
}

/// What is divided, in parts.
struct Partition {
    /// The jobs.
    parts: Vec<Part>,
    /// The factor on the metric by which cuts are sampled.
    scale: f64,
    /// The integral of sqrt(det M) without it.
    complexity: f64,
    /// Vertices of the whole.
    vertices: usize,
    /// What is required of it.
    kept: Kept,
    /// What could not be met.
    notes: Vec<String>,
}

/// Who makes the meshes of a round of parts, and hands them over in their order, so that there need not be all at once; the round has a name.
type Make<'a> = &'a mut dyn FnMut(&'static str, &[Part], &mut dyn FnMut(Mesh)) -> Result<()>;

fn in_parts(
    on: &impl Divisible,
    parts: Option<usize>,
    options: &MeshOptions,
    make: Make,
    progress: &dyn Progress,
) -> Result<Meshed> {
    demand_divisible(options)?;
    let watch = Stopwatch::new(progress);
    let cut = watch.time("partition", || on.partition(parts, options, progress))?;
    let mut notes = cut.notes;
    let mut joiner = Joiner::of_parts(cut.parts.len());
    watch.time("parts", || make("parts", &cut.parts, &mut |mesh| joiner.add(&mesh)))?;
    drop(cut.parts);
    let mut whole = watch.time("stitch", || Whole::of_parts(on, cut.kept, joiner));
    let strips = whole.strips();
    remake(on, &mut whole, ("strips", &strips, cut.vertices), make, &watch)?;
    let junctions = whole.junctions();
    remake(on, &mut whole, ("junctions", &junctions, cut.vertices), make, &watch)?;
    progress.begin("checking", 1)?;
    let mesh = whole.into_mesh();
    let validity = watch.time("check", || on.check(&mesh))?;
    if mesh.points.len() != cut.vertices {
        notes.push(format!("{} vertices were asked for, but parts leave room for {}", cut.vertices, mesh.points.len()));
    }
    let metric_scale = if options.vertices.is_some() { unit_factor(on, &mesh) } else { cut.scale };
    let closed_form_scale = options.vertices.map(|count| closed_form_scale(count, cut.complexity));
    Ok(Meshed { mesh, validity, metric_scale, closed_form_scale, seconds: watch.seconds(), notes, ..Meshed::default() })
}

/// Lets the regions of a round be made anew, so that the whole then has so many vertices.
fn remake(
    on: &impl Divisible,
    whole: &mut Whole,
    (round, regions, vertices): (&'static str, &[Vec<u32>], usize),
    make: Make,
    watch: &Stopwatch,
) -> Result<()> {
    if regions.is_empty() {
        return Ok(());
    }
    let regions = whole.hanging_together(regions)?;
    let jobs = watch.time("stitch", || whole.jobs(on, &regions, vertices))?;
    let mut joiner = watch.time("stitch", || whole.without(&regions));
    watch.time(round, || make(round, &jobs, &mut |mesh| joiner.add(&mesh)))?;
    whole.close(joiner);
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
        (options.order > 1, "curved triangles", "`order`"),
    ];
    match whole.into_iter().find(|(is_asked, ..)| *is_asked) {
        None => Ok(()),
        Some((_, what, option)) => {
            let help = format!("leave out {option}, or `parts`: it is for the mesh as a whole");
            Err(Error::unsupported(format!("{what} of a mesh in parts"), help))
        }
    }
}

/// How many parts there are of so many vertices.
fn number_of_parts(vertices: usize, asked: Option<usize>) -> Result<usize> {
    let parts = asked.unwrap_or(vertices.div_ceil(VERTICES_PER_PART));
    if parts == 0 || vertices / parts < FEWEST {
        let what = format!("{vertices} vertices in {parts} parts");
        return Err(Error::limit(what, format!("let parts have {FEWEST} vertices at least")));
    }
    Ok(parts)
}

/// The factor on the metric for which edges that touch no curve have unit length in the (geometric) mean, as it is of meshes of one piece.
fn unit_factor(on: &impl Divisible, mesh: &Mesh) -> f64 {
    let on_curve = marked(mesh.points.len(), mesh.edges.as_flattened().iter().copied());
    let edges = Edges::of(&mesh.triangles);
    let mut ends = edges.ends().filter(|ends| ends.iter().all(|&v| !on_curve[v as usize]));
    let (mut sum, mut count) = (0.0, 0);
    loop {
        let some: Vec<[u32; 2]> = ends.by_ref().take(AT_ONCE).collect();
        if some.is_empty() {
            return (-2.0 * sum / f64::from(count.max(1))).exponential();
        }
        sum = on.logarithms(mesh, &some).iter().fold(sum, |sum, logarithm| sum + logarithm);
        count += some.len() as u32;
    }
}
