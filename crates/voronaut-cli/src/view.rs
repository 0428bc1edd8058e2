//! `voronaut view`: a page to look at meshes with.

use crate::fields;
use crate::options::{Creases, Damage, MetricChoices, Run, positive, refuse};
use crate::pages::{self, Drawn};
use crate::stages::Stages;
use crate::world::World;
use crate::{curves, files, summary};
use clap::{Args, value_parser};
use serde_json::json;
use std::path::{Path, PathBuf};
use voronaut::canvas;
use voronaut::canvas::VERTICES_PER_SEED;
use voronaut::manifold::Manifold;
use voronaut::manifold::domain::{Domain, from_mesh};
use voronaut::manifold::surface::metric::Scaled;
use voronaut::recipe::GradedAt;
use voronaut::{Error, Result};
use voronaut_draw::Sheet;
use voronaut_io::{Document, Given};

pub(crate) const EXAMPLES: &str = "\
The page is one file that needs no network, no server and no program but a browser. It has lengths, angles and quality in METRIC (without it, Euclidean
ones), labels, and the fields of the files. Of several meshes, such as those of the steps of a loop, it shows one after the other, or two side by
side. Coordinates are kept to 26 bits along the longest side of the mesh, values in single precision. Vertices and triangles keep their numbers, up
to 250,000 triangles; a page holds up to 5,000,000.

Examples:
  voronaut view plate.mesh -o plate.html
  voronaut view swirl.mesh --metric swirl --metric-scale 1873.2 --cells -o swirl.html
  voronaut view adapted.vtu -o pressure.html --title 'Pressure on the adapted mesh'
  voronaut view step-1.mesh step-2.mesh step-3.mesh -o steps.html";

#[derive(Debug, Args)]
pub(crate) struct ViewArgs {
    /// Meshes: .mesh, .meshb, .msh, .vtu, .vtp, .obj, .off, .ply or .stl
    #[arg(value_name = "MESH", required = true)]
    pub(crate) meshes: Vec<PathBuf>,
    /// The page: .html
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    /// Show lengths, shapes and angles in this metric (as for `mesh`)
    #[arg(long)]
    pub(crate) metric: Option<String>,
    /// A factor on the metric tensor, such as `metric_scale` of a report
    #[arg(long, value_name = "FACTOR", value_parser = positive, requires = "metric")]
    pub(crate) metric_scale: Option<f64>,
    /// The domain or the surface that the metric is given on (as for `mesh`) [default: the mesh]
    #[arg(long, requires = "metric")]
    pub(crate) domain: Option<String>,
    /// Show Voronoi cells of the vertices in the metric, distances from them, and edges as geodesics
    #[arg(long, requires = "metric")]
    pub(crate) cells: bool,
    /// With --cells: canvas vertices per seed
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..), default_value_t = VERTICES_PER_SEED, requires = "cells")]
    pub(crate) canvas_size: u32,
    /// Values at the vertices or triangles of the mesh, if it is one: a .sol
    #[arg(long, value_name = "FILE")]
    pub(crate) sol: Option<PathBuf>,
    /// What stands above the page [default: the names of the meshes]
    #[arg(long, value_name = "TEXT")]
    pub(crate) title: Option<String>,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    #[command(flatten)]
    pub(crate) creases: Creases,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

/// Writes the page.
pub(crate) fn run(args: &ViewArgs, world: &World) -> Result<()> {
    let mut stages = Stages::start(world);
    files::demand_page(&args.out)?;
    files::demand_apart([world.file(&args.out), args.run.report.as_deref()])?;
    args.metric_choices.bounds().check()?;
    let is_ambiguous = args.sol.is_some() && args.meshes.len() > 1;
    refuse([(is_ambiguous, "--sol with several meshes", "give files that hold their values, such as .vtu")])?;
    let progress = world.progress(&args.run);
    progress.stage("meshes", args.meshes.len() as u64);
    let mut sheets = Vec::new();
    for path in &args.meshes {
        sheets.push(sheet(args, world, path)?);
        progress.done(1);
    }
    stages.end("meshes");
    progress.stage("page", 1);
    let title = args.title.clone().unwrap_or_else(|| title(&sheets));
    let page = voronaut_draw::page(&title, &sheets)?;
    stages.end("page");
    drop(progress);
    world.go_on()?;
    let (bytes, triangles) = (page.len(), sheets.iter().map(|sheet| sheet.mesh.triangles.len()).sum::<usize>());
    world.write_page(page, &args.out)?;
    stages.end("write");
    let report = json!({ "meshes": sheets.len(), "triangles": triangles, "bytes": bytes, "seconds": stages.seconds(Vec::new()) });
    world.write_report(format!("{report:#}\n"), &args.run)?;
    if world.is_files() && !args.run.quiet {
        let size = format!("{:.2} MB", bytes as f64 / 1e6);
        let lines = [("meshes", sheets.len().to_string()), ("triangles", triangles.to_string()), ("size", size)];
        let lines = lines.map(|(name, text)| (name.to_owned(), text));
        summary::say(&args.out.display().to_string(), summary::WIDTH, lines.into());
    }
    Ok(())
}

/// The names of the first and the last mesh.
fn title(sheets: &[Sheet]) -> String {
    match sheets {
        [first, .., last] => format!("{} … {}", first.name, last.name),
        _ => sheets.first().map(|sheet| sheet.name.clone()).unwrap_or_default(),
    }
}

fn sheet(args: &ViewArgs, world: &World, path: &Path) -> Result<Sheet> {
    let Document { mesh, mut fields, notes } = world.document(path)?;
    summary::notes(&notes, args.run.quiet);
    mesh.check_numbers()?;
    let curved = mesh.curved.is_some() && args.metric.is_some();
    refuse([(curved, "curved triangles in a metric", "leave out --metric: voronaut check measures them")])?;
    if let Some(sol) = &args.sol {
        fields.extend(files::values_of(&mesh, world.solutions(sol)?, sol)?);
    }
    let mut sheet = pages::plain(pages::name(path), mesh, fields);
    let Some(text) = &args.metric else { return Ok(sheet) };
    let given = args.domain.as_deref().map(|domain| world.given(domain, args.damage.options())).transpose()?;
    match given.map(|(given, _)| given) {
        Some(Given::Surface(input)) => on_surface(args, world, &mut sheet, text, input)?,
        Some(Given::Plane(domain)) => in_plane(args, world, &mut sheet, text, path, &domain)?,
        None if sheet.mesh.is_planar() => {
            let domain = Domain::new(&from_mesh(&sheet.mesh)?)?;
            in_plane(args, world, &mut sheet, text, path, &domain)?;
        }
        None => {
            let input = Manifold::of(&sheet.mesh)?;
            on_surface(args, world, &mut sheet, text, input)?;
        }
    }
    Ok(sheet)
}

impl ViewArgs {
    fn drawn(&self) -> Option<Drawn> {
        self.cells.then_some(Drawn { kind: canvas::Kind::default(), size: self.canvas_size })
    }
}

fn in_plane(args: &ViewArgs, world: &World, sheet: &mut Sheet, text: &str, path: &Path, domain: &Domain) -> Result<()> {
    if !sheet.mesh.is_planar() {
        let what = format!("{} is not planar (z = 0), its domain is", path.display());
        return Err(Error::unsupported(what, "give the surface that it is a mesh of as --domain"));
    }
    args.creases.demand_unset()?;
    let own = args.domain.clone().unwrap_or_else(|| path.to_string_lossy().into_owned());
    let scale = args.metric_scale.unwrap_or(1.0);
    let choices = args.metric_choices.of_degree(curves::order_of(&sheet.mesh));
    let metric = fields::measuring(world, text, domain, &own, &choices, scale)?;
    pages::measured(sheet, metric.as_ref().into(), true)?;
    args.drawn().map_or(Ok(()), |drawn| pages::with_cells(sheet, domain, metric.as_ref(), drawn))
}

/// Figures are of the surface cut along its creases, cells are drawn across them.
fn on_surface(args: &ViewArgs, world: &World, sheet: &mut Sheet, text: &str, whole: Manifold) -> Result<()> {
    let factor = args.metric_scale.unwrap_or(1.0);
    let field =
        |input: &Manifold| fields::on_surface(world, text, input, &args.metric_choices, GradedAt::Scale(factor));
    if let Some(drawn) = args.drawn() {
        pages::with_cells_on(sheet, &whole, &Scaled { field: field(&whole)?.as_ref(), factor }, drawn)?;
    }
    let input = whole.cut(&args.creases.options())?;
    let field = field(&input)?;
    pages::measured(sheet, (&input, &Scaled { field: field.as_ref(), factor }).into(), true)
}
