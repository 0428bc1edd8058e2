//! A mesh in parts: each made by a process of its own, which is this program again, or wherever the caller says; what is done is kept.

use crate::options::Run;
use crate::watch;
use crate::world::{PartsMaker, World};
use clap::Args;
use serde_json::{Map, Value};
use std::ffi::OsString;
use std::fmt;
use std::fs::File;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use voronaut::geometry::{Aabb, Aabb3};
use voronaut::manifold::Manifold;
use voronaut::manifold::domain::Domain;
use voronaut::manifold::surface::metric::SurfaceMetric;
use voronaut::mesh::{Mesh, Solution, SolutionValues};
use voronaut::metric::{Expression, MetricField, Norm, Uniform};
use voronaut::progress::Progress;
use voronaut::recipe::{
    Aim, MeshOptions, Meshed, Part, mesh_in_parts, mesh_part, mesh_surface_in_parts, mesh_surface_part,
};
use voronaut::{Error, Result};
use voronaut_io::{Fields, Format, Scratch};

/// Whether a mesh is made in parts, or is one of them.
#[derive(Clone, Debug, Args)]
pub(crate) struct InParts {
    /// Make the mesh in K parts, or in parts of about 100,000 vertices (auto), as many at a time as --threads says, each by
    /// a process of its own; the mesh depends on the number of parts, not on who makes them
    #[arg(long, value_name = "K", value_parser = parts)]
    pub(crate) parts: Option<Parts>,
    /// With --parts: a folder for parts that are done; a run that was stopped goes on from them
    #[arg(long, value_name = "DIR", requires = "parts")]
    parts_dir: Option<PathBuf>,
    /// One part of a mesh in parts: so many vertices, in the domain of a file
    #[arg(long, value_name = "N,FILE", value_parser = job, hide = true)]
    pub(crate) part: Option<Job>,
}

/// How many parts a mesh is made in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Parts(Option<usize>);

impl fmt::Display for Parts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            None => f.write_str("auto"),
            Some(count) => count.fmt(f),
        }
    }
}

/// `auto` or a number.
fn parts(text: &str) -> std::result::Result<Parts, String> {
    let count = || text.parse::<usize>().ok().filter(|&count| count > 0).map(|count| Parts(Some(count)));
    let auto = (text == "auto").then_some(Parts(None));
    auto.or_else(count).ok_or_else(|| "neither auto nor a number of parts, 1 or more".into())
}

/// The job of a part: how many vertices, and what its domain is in.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    vertices: usize,
    domain: PathBuf,
}

/// `N,FILE`.
fn job(text: &str) -> std::result::Result<Job, String> {
    let found = text.split_once(',').and_then(|(count, file)| Some((count.parse().ok()?, file)));
    let (vertices, file) = found.ok_or("not N,FILE")?;
    Ok(Job { vertices, domain: file.into() })
}

/// A domain with its metric, for whole meshes and parts of them.
#[derive(Clone, Copy)]
pub(crate) enum Field<'a> {
    /// Of the plane, and what the metric is for.
    Plane(&'a Domain, &'a dyn MetricField, Option<Aim<'a>>),
    /// Of a surface, and the function that the metric is for.
    Surface(&'a Manifold, &'a dyn SurfaceMetric, Option<(&'a Expression, Norm)>),
}

/// What is done with the meshes of a round, one after the other.
type Take<'a> = &'a mut dyn FnMut(Mesh);
/// Who makes the meshes of a round, which has a name.
type Make<'a> = &'a mut dyn FnMut(&'static str, &[Part], Take) -> Result<()>;

impl Field<'_> {
    fn part(&self, part: &Part, options: &MeshOptions, progress: &dyn Progress) -> Result<Mesh> {
        match *self {
            Field::Plane(_, metric, aim) => mesh_part(part, metric, aim, options, progress),
            Field::Surface(input, metric, aim) => mesh_surface_part(part, input, metric, aim, options, progress),
        }
    }

    fn whole(
        &self,
        parts: Option<usize>,
        options: &MeshOptions,
        make: Make,
        progress: &dyn Progress,
    ) -> Result<Meshed> {
        match *self {
            Field::Plane(domain, metric, aim) => mesh_in_parts(domain, metric, aim, parts, options, make, progress),
            Field::Surface(input, metric, _) => mesh_surface_in_parts(input, metric, parts, options, make, progress),
        }
    }
}

/// The mesh of one part, and where it goes.
pub(crate) fn one(job: &Job, world: &World, run: &Run, field: Field, options: &MeshOptions) -> Result<()> {
    let part = Part { domain: world.document(&job.domain)?.mesh, vertices: job.vertices, metric: None };
    write(job, world, run, field.part(&part, options, &*world.progress(run))?)
}

/// The same, if the part came with its metric: then nothing else is read.
pub(crate) fn one_by_itself(job: &Job, world: &World, run: &Run, options: &MeshOptions) -> Result<bool> {
    let metric = world.metric_at_vertices(&metric_name(&job.domain))?;
    if metric.is_some() {
        let part = Part { domain: world.document(&job.domain)?.mesh, vertices: job.vertices, metric };
        write(job, world, run, mesh_part(&part, &Uniform::default(), None, options, &*world.progress(run))?)?;
        return Ok(true);
    }
    Ok(false)
}

fn write(job: &Job, world: &World, run: &Run, mesh: Mesh) -> Result<()> {
    world.write_mesh(mesh, &done_name(&job.domain))?;
    // Files that the user named are of the whole.
    world.write_report("{}".into(), &Run { report: None, ..run.clone() })
}

/// Where the mesh of a job goes: `strips-3-job.meshb` becomes `strips-3.meshb`.
fn done_name(job: &Path) -> PathBuf {
    renamed(job, ".")
}

/// Where the metric of a part is, if it has one of its own: `strips-3-metric.meshb`, and tensors beside it.
fn metric_name(job: &Path) -> PathBuf {
    renamed(job, "-metric.")
}

fn renamed(job: &Path, end: &str) -> PathBuf {
    let name = job.file_name().map(|name| name.to_string_lossy().replace("-job.", end)).unwrap_or_default();
    job.with_file_name(name)
}

impl InParts {
    /// Whether a mesh is made in parts, or is one.
    pub(crate) fn is_asked(&self) -> bool {
        self.parts.is_some() || self.part.is_some()
    }

    /// The whole mesh; `used` are all options.
    pub(crate) fn all(
        &self,
        world: &World,
        run: &Run,
        field: Field,
        options: &MeshOptions,
        used: &Value,
    ) -> Result<Meshed> {
        let progress = &*world.progress(run);
        let count = self.parts.and_then(|parts| parts.0);
        if let Some(again) = world.again() {
            let folder = Folder::open(self.parts_dir.as_deref(), used)?;
            let processes = run.threads.map_or_else(cores, usize::from);
            let workers = Workers { again, folder: folder.path(), processes, progress };
            return field.whole(count, options, &mut |round, parts, take| workers.make(round, parts, take), progress);
        }
        if let Some(maker) = world.parts_maker() {
            return field.whole(count, options, &mut |round, parts, take| made(maker, round, parts, take), progress);
        }
        let mut all = |_, parts: &[Part], take: Take| {
            parts.iter().try_for_each(|part| field.part(part, options, progress).map(&mut *take))
        };
        field.whole(count, options, &mut all, progress)
    }
}

fn made(maker: &Mutex<PartsMaker>, round: &'static str, parts: &[Part], take: Take) -> Result<()> {
    maker.lock().unwrap_or_else(PoisonError::into_inner)(round, parts, take)
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Where jobs and their meshes are: a folder that is kept, or one that goes.
enum Folder {
    Kept(PathBuf),
    Scratch(Scratch),
}

/// What of the options does not matter to parts.
const BESIDE: [&str; 12] = [
    "out",
    "picture",
    "view",
    "cells",
    "pixels",
    "histograms",
    "report",
    "threads",
    "memory_limit",
    "net",
    "canvas",
    "canvas_size",
];

/// Options that may name files.
const FILES: [&str; 3] = ["domain", "metric", "background"];

/// The file that an option names, and a number for what is in it: the same name may stand for other values tomorrow.
fn contents(option: &Value) -> Option<(String, Value)> {
    let text = option.as_str()?;
    let name = text.strip_prefix("hessian:").unwrap_or(text);
    let mut hasher = DefaultHasher::new();
    std::fs::read(name).ok()?.hash(&mut hasher);
    Some((name.into(), format!("{:016x}", hasher.finish()).into()))
}

impl Folder {
    /// # Errors
    /// [`Error::Unsupported`] where a folder has the parts of another job; [`Error::Io`] of files.
    fn open(kept: Option<&Path>, options: &Value) -> Result<Self> {
        let Some(kept) = kept else { return Ok(Self::Scratch(Scratch::new()?)) };
        std::fs::create_dir_all(kept).map_err(|source| Error::io(kept, source))?;
        let mut options = options.clone();
        if let Some(options) = options.as_object_mut() {
            options.retain(|name, _| !BESIDE.contains(&name.as_str()));
            let files: Map<String, Value> = FILES.iter().filter_map(|&name| contents(options.get(name)?)).collect();
            options.extend([("files".into(), files.into()), ("version".into(), env!("CARGO_PKG_VERSION").into())]);
        }
        let (file, text) = (kept.join("job.json"), format!("{options:#}\n"));
        if file.exists() && voronaut_io::read_text(&file)? != text {
            let what = format!("{} holds the parts of another job (see its job.json)", kept.display());
            return Err(Error::unsupported(what, "name another folder, or empty this one"));
        }
        voronaut_io::write(&file, text.as_bytes())?;
        Ok(Self::Kept(kept.into()))
    }

    fn path(&self) -> &Path {
        match self {
            Self::Kept(path) => path,
            Self::Scratch(scratch) => scratch.as_ref(),
        }
    }
}

/// Processes that are this program again.
struct Workers<'a> {
    /// The words that started it.
    again: &'a [OsString],
    folder: &'a Path,
    processes: usize,
    progress: &'a dyn Progress,
}

impl Workers<'_> {
    /// The meshes of a round, those with the most vertices first.
    fn make(&self, round: &'static str, parts: &[Part], take: Take) -> Result<()> {
        self.progress.stage(round, parts.len() as u64);
        let mut order: Vec<usize> = (0..parts.len()).collect();
        order.sort_by_key(|&i| std::cmp::Reverse(parts[i].vertices));
        let (next, fault) = (AtomicUsize::new(0), Mutex::new(None));
        let failed = || fault.lock().unwrap_or_else(PoisonError::into_inner);
        let work = || {
            while let Some(&i) = order.get(next.fetch_add(1, Ordering::Relaxed)).filter(|_| failed().is_none()) {
                match self.perform(round, i, &parts[i]) {
                    Ok(()) => self.progress.done(1),
                    Err(error) => drop(failed().get_or_insert(error)),
                }
            }
        };
        std::thread::scope(|scope| (0..self.processes.min(parts.len())).for_each(|_| drop(scope.spawn(work))));
        if let Some(error) = fault.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(error);
        }
        let read = |i: usize| voronaut_io::read(&done_name(&self.job(round, i)));
        (0..parts.len()).try_for_each(|i| read(i).map(|document| take(document.mesh)))
    }

    fn job(&self, round: &str, i: usize) -> PathBuf {
        self.folder.join(format!("{round}-{i}-job.meshb"))
    }

    /// Makes one mesh, unless it is there.
    fn perform(&self, round: &str, i: usize, part: &Part) -> Result<()> {
        let job = self.job(round, i);
        let (done, log) = (done_name(&job), job.with_extension("log"));
        let mut bytes = Vec::new();
        let written = Format::from_path(&job)?.write(&part.domain, &Fields::default(), &mut bytes);
        written.map_err(|source| Error::io(&job, source))?;
        if std::fs::read(&job).is_ok_and(|old| old == bytes) && done.exists() {
            return Ok(());
        }
        let _ = std::fs::remove_file(&done);
        voronaut_io::write(&job, &bytes)?;
        let metric = metric_name(&job);
        if let Some((mesh, tensors)) = &part.metric {
            voronaut_io::write_mesh(mesh, &metric)?;
            let values =
                SolutionValues::Tensor(tensors.iter().map(|tensor| [tensor.xx, tensor.xy, tensor.yy]).collect());
            voronaut_io::write_solution(&Solution { dimension: 2, values }, &metric.with_extension("solb"))?;
        }
        let mut value = OsString::from(format!("--part={},", part.vertices));
        value.push(&job);
        let said = File::create(&log).map_err(|source| Error::io(&log, source))?;
        let mut command = Command::new(&self.again[0]);
        let words = self.again.iter().position(|word| word == "mesh").unwrap_or(0) + 1;
        command.args(&self.again[1..words]).arg(value).args(&self.again[words..]);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(said);
        let status = watch::run(&mut command).map_err(|source| Error::io(Path::new(&self.again[0]), source))?;
        if status.success() && done.exists() {
            for file in [log, metric.with_extension("solb"), metric] {
                let _ = std::fs::remove_file(file);
            }
            return Ok(());
        }
        let said = voronaut_io::read_text(&log).unwrap_or_default();
        let line = |start: &str| said.lines().find_map(|line| line.trim_start().strip_prefix(start).map(str::to_owned));
        let what = line("error: ").unwrap_or_else(|| format!("its process ended with {status}"));
        let help = line("help: ").unwrap_or_else(|| "start again with the same folder (--parts-dir)".into());
        Err(Error::parse(place_of(round, i, part), what, help))
    }
}

/// Which part it is, and where.
fn place_of(round: &str, i: usize, part: &Part) -> String {
    let vertices = 0..part.domain.points.len() as u32;
    let place = if part.domain.is_planar() {
        Aabb::of(vertices.map(|v| part.domain.point(v))).map(|b| format!(", from {} to {}", b.min, b.max))
    } else {
        Aabb3::of(vertices.map(|v| part.domain.position(v))).map(|b| format!(", from {} to {}", b.min, b.max))
    };
    format!("{round} {i}{}", place.unwrap_or_default())
}
