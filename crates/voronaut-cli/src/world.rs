//! Where commands read what is named, and where what they make goes: files and a terminal, or the arrays of a caller.

use crate::aside::say_aside;
use crate::options::{MetricChoices, Paged, Run};
use crate::progress::Bar;
use crate::seeds::SeedRows;
use std::cell::RefCell;
use std::collections::HashMap;
use std::ffi::OsString;
use std::path::Path;
use std::sync::Mutex;
use std::time::Instant;
use voronaut::geometry::Tensor;
use voronaut::manifold::Manifold;
use voronaut::manifold::domain::{Domain, Pslg, from_polygons, repaired_graph, repaired_polygons};
use voronaut::manifold::surface::metric::SurfaceMetric;
use voronaut::manifold::surface::{Mended, RepairOptions};
use voronaut::mesh::{Mesh, Solution, SolutionValues, Solutions};
use voronaut::progress::Progress;
use voronaut::realisation::Realisation;
use voronaut::recipe::{self, GradedAt, MetricOptions, Origin, Part, PlanarMetric};
use voronaut::{Error, Result};
use voronaut_io::{
    Document, Fields, Format, Given, MetricFiles, MetricSource, geojson, points, read_metric, read_text, surface_metric,
};

/// A metric that a caller has.
pub trait HeldMetric: Send {
    /// What it is made of.
    fn origin(&self) -> Origin;
    /// As a field in the plane; `at` is the multiple in which edges are to have length one.
    ///
    /// # Errors
    /// It is none there.
    fn in_plane(&self, domain: &Domain, options: &MetricOptions, at: GradedAt) -> Result<PlanarMetric>;
    /// As a field on a surface; `at` as in the plane.
    ///
    /// # Errors
    /// It is none there.
    fn on_surface(&self, input: &Manifold, options: &MetricOptions, at: GradedAt) -> Result<Box<dyn SurfaceMetric>>;
}

/// Makes the meshes of parts, in their order; the name is that of the round.
pub type PartsMaker = Box<dyn FnMut(&'static str, &[Part], &mut dyn FnMut(Mesh)) -> Result<()> + Send>;

/// What a caller holds, by the words that stand for it among those of a command.
#[derive(Default)]
pub struct Held {
    /// Meshes: domains, surfaces, what is checked or carried from and to.
    pub documents: HashMap<String, Document>,
    /// Domains as the text of `GeoJSON`.
    pub polygons: HashMap<String, String>,
    /// Domains as their graphs.
    pub outlines: HashMap<String, Pslg>,
    /// Metrics.
    pub metrics: HashMap<String, Box<dyn HeldMetric>>,
    /// Values on meshes.
    pub solutions: HashMap<String, Solutions>,
    /// Seeds, all of two or all of three coordinates.
    pub seeds: HashMap<String, Vec<Vec<f64>>>,
    /// Who makes the parts of a mesh; the command itself if it is nobody.
    pub parts_maker: Option<Mutex<PartsMaker>>,
    /// Whether pages are kept, whatever they are called, and not written.
    pub keeps_pages: bool,
}

impl Held {
    /// The domain that a word stands for; that of others is what they say by themselves.
    ///
    /// # Errors
    /// What is held is no domain; as of [`Given::read`] of other words.
    pub fn given(&self, spec: &str, options: RepairOptions) -> Result<(Given, Mended)> {
        let plane = |(outline, notes): (Pslg, Vec<String>)| {
            Ok((Given::Plane(Domain::new(&outline)?), Mended::default().with_notes(&notes)))
        };
        if let Some(document) = named(&self.documents, Path::new(spec)) {
            let may_be_planar = Format::of_ending(Path::new(spec)).is_none_or(Format::may_be_planar);
            return Given::of_document(spec, document, may_be_planar, options);
        }
        if let Some(outline) = named(&self.outlines, Path::new(spec)) {
            return plane(if options.repair { repaired_graph(outline)? } else { (outline.clone(), Vec::new()) });
        }
        match named(&self.polygons, Path::new(spec)) {
            Some(text) => {
                let polygons = geojson::read(text, spec)?;
                plane(if options.repair {
                    repaired_polygons(&polygons)?
                } else {
                    (from_polygons(&polygons)?, Vec::new())
                })
            }
            None => Given::read(spec, options),
        }
    }
}

/// What stands under a word; `remesh` adds an ending to words.
fn named<'a, T>(all: &'a HashMap<String, T>, word: &Path) -> Option<&'a T> {
    let found = |path: &Path| all.get(path.to_str()?);
    found(word).or_else(|| found(&word.with_extension("")))
}

/// What a command made for a caller.
#[derive(Default)]
pub struct Made {
    /// The mesh.
    pub mesh: Option<Mesh>,
    /// A canvas, with colours as labels, and distances at its vertices.
    pub canvas: Option<(Mesh, Vec<f64>)>,
    /// Values at the mesh's vertices and triangles.
    pub solutions: Option<Solutions>,
    /// A page, HTML.
    pub page: Option<String>,
    /// The report, JSON.
    pub report: Option<String>,
    /// What there is to say besides.
    pub warnings: Vec<String>,
}

/// Where a command reads and writes.
pub struct World<'a> {
    held: Option<(Held, &'a dyn Progress)>,
    /// The words that start the program again.
    again: Vec<OsString>,
    /// When it began; a caller's progress has a clock.
    start: Option<Instant>,
    made: RefCell<Made>,
}

impl<'a> World<'a> {
    /// Files, and a terminal; and the words that start the program again.
    pub(crate) fn of_files(again: Vec<OsString>) -> Self {
        Self { held: None, again, start: Some(Instant::now()), made: RefCell::default() }
    }

    /// What a caller holds, and its progress. What commands make is kept; files that options name are read and written all the same.
    pub fn of_caller(held: Held, progress: &'a dyn Progress) -> Self {
        Self { held: Some((held, progress)), again: Vec::new(), start: None, made: RefCell::default() }
    }

    /// What was made for the caller.
    pub fn into_made(self) -> Made {
        self.made.into_inner()
    }

    /// The words that start the program again, where there is one.
    pub(crate) fn again(&self) -> Option<&[OsString]> {
        self.is_files().then_some(&self.again)
    }

    /// Who makes the parts of a mesh for the caller.
    pub(crate) fn parts_maker(&self) -> Option<&Mutex<PartsMaker>> {
        self.held.as_ref().and_then(|(held, _)| held.parts_maker.as_ref())
    }

    pub(crate) fn is_files(&self) -> bool {
        self.held.is_none()
    }

    /// What the clock says: of a caller that of its progress, for there may be no other (WebAssembly).
    pub(crate) fn seconds(&self) -> f64 {
        let since = |start: &Instant| start.elapsed().as_secs_f64();
        self.held.as_ref().map_or_else(|| self.start.as_ref().map_or(0.0, since), |(_, progress)| progress.seconds())
    }

    /// Whether pages are the caller's.
    fn keeps_pages(&self) -> bool {
        self.held.as_ref().is_some_and(|(held, _)| held.keeps_pages)
    }

    /// The name of the page of a run that makes a mesh, if it is that of a file.
    pub(crate) fn page_file<'p>(&self, paged: &'p Paged) -> Option<&'p Path> {
        paged.view.as_deref().filter(|_| !self.keeps_pages())
    }

    /// Whether the coloured canvas is kept though no file is named for it.
    pub(crate) fn keeps_diagrams(&self) -> bool {
        !self.is_files()
    }

    /// The name of an output, if it is that of a file.
    pub(crate) fn file<'p>(&self, path: &'p Path) -> Option<&'p Path> {
        self.is_files().then_some(path)
    }

    /// What the caller holds of a kind under a word.
    fn held<T>(&self, kind: impl Fn(&Held) -> &HashMap<String, T>, word: &Path) -> Option<&T> {
        named(self.held.as_ref().map(|(held, _)| kind(held))?, word)
    }

    pub(crate) fn document(&self, path: &Path) -> Result<Document> {
        self.held(|held| &held.documents, path).map_or_else(|| voronaut_io::read(path), |found| Ok(found.clone()))
    }

    /// A mesh with tensors at its vertices, if there is one of this name: of files the tensors are in a `.solb` beside it.
    pub(crate) fn metric_at_vertices(&self, path: &Path) -> Result<Option<(Mesh, Vec<Tensor>)>> {
        let (mesh, values) = if let Some((held, _)) = &self.held {
            let Some(document) = named(&held.documents, path) else { return Ok(None) };
            (document.mesh.clone(), document.fields.vertices.first().map(|field| field.values.clone()))
        } else {
            let values = path.with_extension("solb");
            if !values.exists() {
                return Ok(None);
            }
            (voronaut_io::read(path)?.mesh, voronaut_io::read_solutions(&values)?.vertices.into_iter().next())
        };
        let Some(SolutionValues::Tensor(entries)) = values else { return Ok(None) };
        Ok(Some((mesh, entries.into_iter().map(|[xx, xy, yy]| Tensor::new(xx, xy, yy)).collect())))
    }

    pub(crate) fn given(&self, spec: &str, options: RepairOptions) -> Result<(Given, Mended)> {
        self.held.as_ref().map_or_else(|| Given::read(spec, options), |(held, _)| held.given(spec, options))
    }

    /// What the caller's metric is made of, if it is the caller's.
    pub(crate) fn metric_origin(&self, word: &str) -> Option<Origin> {
        self.held(|held| &held.metrics, Path::new(word)).map(|metric| metric.origin())
    }

    /// The metric of a planar domain that a word names; `own` is what the domain was read from.
    pub(crate) fn planar_metric(
        &self,
        word: &str,
        domain: &Domain,
        own: &str,
        choices: &MetricChoices,
        at: GradedAt,
    ) -> Result<PlanarMetric> {
        let options = choices.options();
        if let Some(metric) = self.held(|held| &held.metrics, Path::new(word)) {
            return metric.in_plane(domain, &options, at);
        }
        let (source, own, background) = (MetricSource::parse(word)?, Path::new(own), choices.background.as_deref());
        let own_mesh = self.held(|held| &held.documents, own).filter(|_| background.is_none());
        match (&source, own_mesh) {
            (MetricSource::File(path) | MetricSource::Hessian(path), Some(Document { mesh, .. })) => {
                let values = read_metric(path, choices.tensor_order)?.values;
                match source {
                    MetricSource::File(_) => {
                        recipe::metric_of_values(mesh, &values, word, domain.planar(), &options, at)
                    }
                    _ => recipe::metric_of_solution(mesh, &values, domain.planar(), &options, at),
                }
            }
            _ => MetricFiles { own: Some(own), background, order: choices.tensor_order }
                .metric(&source, domain, &options, at),
        }
    }

    pub(crate) fn surface_metric(
        &self,
        word: &str,
        input: &Manifold,
        choices: &MetricChoices,
        at: GradedAt,
    ) -> Result<Box<dyn SurfaceMetric>> {
        match self.held(|held| &held.metrics, Path::new(word)) {
            Some(metric) => metric.on_surface(input, &choices.options(), at),
            None => surface_metric(word, input, &choices.options(), choices.tensor_order, at),
        }
    }

    pub(crate) fn solutions(&self, path: &Path) -> Result<Solutions> {
        self.held(|held| &held.solutions, path).map_or_else(|| voronaut_io::read_solutions(path), |it| Ok(it.clone()))
    }

    /// One value for each vertex.
    pub(crate) fn solution(&self, path: &Path) -> Result<Solution> {
        let Solutions { dimension, mut vertices, triangles } = self.solutions(path)?;
        if let (Some(values), true) = (vertices.pop(), vertices.is_empty() && triangles.is_empty()) {
            return Ok(Solution { dimension, values });
        }
        let what = "there is more than one value per vertex, or none";
        Err(Error::parse(path.display().to_string(), what, "give one"))
    }

    /// Seeds, each with its place.
    pub(crate) fn seeds<const N: usize>(&self, path: &Path) -> Result<SeedRows<N>> {
        let name = path.display().to_string();
        let Some(given) = self.held(|held| &held.seeds, path) else {
            let rows = points::read(&read_text(path)?, &name)?;
            return Ok(SeedRows { name, before_number: ":", rows });
        };
        let row = |(i, row): (usize, &Vec<f64>)| {
            row.as_slice().try_into().map(|row| (i, row)).map_err(|_| {
                let what = format!("{} coordinates where {N} are expected", row.len());
                Error::parse(format!("{name}, row {i}"), what, "two in the plane, three on a surface")
            })
        };
        let rows = given.iter().enumerate().map(row).collect::<Result<_>>()?;
        Ok(SeedRows { name, before_number: ", row ", rows })
    }

    pub(crate) fn progress(&self, run: &Run) -> Box<dyn Progress + '_> {
        match self.held {
            None => Box::new(Bar::new(run)),
            Some((_, progress)) => Box::new(Told(progress)),
        }
    }

    pub(crate) fn write_mesh(&self, mesh: Mesh, path: &Path) -> Result<()> {
        self.write(mesh, |mesh| voronaut_io::write_mesh(mesh, path), |made| &mut made.mesh)
    }

    pub(crate) fn write_mesh_as(&self, format: Format, mesh: Mesh, path: &Path) -> Result<()> {
        let write = |mesh: &Mesh| voronaut_io::write_with(path, |out| format.write(mesh, &Fields::default(), out));
        self.write(mesh, write, |made| &mut made.mesh)
    }

    pub(crate) fn write_realisation<P: Copy + Into<[f64; 3]> + Send + Sync>(
        &self,
        curved: &Realisation<P>,
        path: &Path,
    ) -> Result<()> {
        match self.held {
            None => voronaut_io::write_realisation(curved, path),
            Some(_) => self.write_mesh(curved.to_mesh(), path),
        }
    }

    /// A canvas with its distances, to a file if one is named.
    pub(crate) fn write_diagram(&self, found: (Mesh, Vec<f64>), path: Option<&Path>) -> Result<()> {
        let write = |(canvas, distances): &(Mesh, Vec<f64>)| {
            path.map_or(Ok(()), |path| voronaut_io::write_diagram(canvas, distances, path))
        };
        self.write(found, write, |made| &mut made.canvas)
    }

    /// The page of a run that makes a mesh: a file that is named, unless the caller keeps pages.
    pub(crate) fn write_page_beside(&self, page: String, path: &Path) -> Result<()> {
        if self.keeps_pages() { self.write_page(page, path) } else { voronaut_io::write(path, page.as_bytes()) }
    }

    pub(crate) fn write_page(&self, page: String, path: &Path) -> Result<()> {
        self.write(page, |page| voronaut_io::write(path, page.as_bytes()), |made| &mut made.page)
    }

    pub(crate) fn write_solutions(&self, solutions: Solutions, path: &Path) -> Result<()> {
        self.write(solutions, |it| voronaut_io::write_solutions(it, path), |made| &mut made.solutions)
    }

    pub(crate) fn write_solution(&self, solution: Solution, path: &Path) -> Result<()> {
        let Solution { dimension, values } = solution;
        let write = |it: &Solutions| {
            let values = it.vertices.first().cloned().unwrap_or(SolutionValues::Scalar(Vec::new()));
            voronaut_io::write_solution(&Solution { dimension, values }, path)
        };
        let solutions = Solutions { dimension, vertices: vec![values], triangles: Vec::new() };
        self.write(solutions, write, |made| &mut made.solutions)
    }

    fn write<T>(
        &self,
        value: T,
        to_file: impl FnOnce(&T) -> Result<()>,
        kept: impl FnOnce(&mut Made) -> &mut Option<T>,
    ) -> Result<()> {
        if self.is_files() {
            return to_file(&value);
        }
        *kept(&mut self.made.borrow_mut()) = Some(value);
        Ok(())
    }

    /// Whether to go on, for the caller may not wait any more: asked before files are written.
    pub(crate) fn go_on(&self) -> Result<()> {
        let is_stopped = self.held.as_ref().is_some_and(|(_, progress)| progress.is_stopped());
        if is_stopped { Err(Error::Stopped) } else { Ok(()) }
    }

    /// Whether somebody is told what a run has made, in figures.
    pub(crate) fn tells(&self, run: &Run) -> bool {
        !self.is_files() || !run.quiet || run.report.is_some()
    }

    /// Writes the report, if a file is named for it.
    pub(crate) fn write_report(&self, text: String, run: &Run) -> Result<()> {
        run.write_report(&text)?;
        self.write(text, |_| Ok(()), |made| &mut made.report)
    }

    /// Says what the user should know, of a kind: `warning`, `note`.
    pub(crate) fn say(&self, kind: &str, text: &str) {
        if self.is_files() {
            say_aside(&format!("{kind}: {text}"));
        } else {
            self.made.borrow_mut().warnings.push(text.into());
        }
    }
}

/// Progress that somebody else watches.
struct Told<'a>(&'a dyn Progress);

impl Progress for Told<'_> {
    fn stage(&self, name: &'static str, total: u64) {
        self.0.stage(name, total);
    }

    fn done(&self, units: u64) {
        self.0.done(units);
    }

    fn seconds(&self) -> f64 {
        self.0.seconds()
    }

    fn is_stopped(&self) -> bool {
        self.0.is_stopped()
    }

    fn sketch(&self, draw: &dyn Fn() -> (Vec<[f64; 3]>, Vec<[u32; 3]>)) {
        self.0.sketch(draw);
    }
}
