//! `voronaut mesh`: from the command line to the library and back. All calls of the mesher are here.

use crate::fields;
use crate::options::{
    Creases, Damage, MetricChoices, Outputs, Paged, Paired, Run, Show, not_negative, positive, refuse,
};
use crate::pages::{self, Drawn};
use crate::parts::{self, InParts};
use crate::world::World;
use crate::{account, curves, files, pictures};
use clap::{Args, value_parser};
use serde_json::{Value, json};
use std::borrow::Cow;
use std::path::PathBuf;
use voronaut::Result;
use voronaut::canvas::{self, Canvas};
use voronaut::diagram::{Diagram, Kind, SurfaceDiagram};
use voronaut::dual::Road;
use voronaut::geodesic::Method;
use voronaut::geometry::Point;
use voronaut::manifold::domain::Domain;
use voronaut::manifold::surface::Mended;
use voronaut::manifold::surface::metric::{Finer, Scaled, Spec};
use voronaut::manifold::{Manifold, Riemannian};
use voronaut::mesh::Mesh;
use voronaut::metric::{Expression, MetricField};
use voronaut::quality::{InterpolationError, Unmet, interpolation_error, interpolation_error_on};
use voronaut::realisation::Realisation;
use voronaut::recipe::{
    self, Aim, Boundary, Centroid, Effort, GradedAt, Idle, MeshOptions, Meshed, Mesher, Seeding, Task,
};
use voronaut_draw::{Layers, Sheet};
use voronaut_io::{Format, Given, Report};

pub(crate) const EXAMPLES: &str = "\
DOMAIN  a file: .mesh, .meshb, .msh, .su2, .vtu, .vtp (boundary edges or triangles; of volumes the boundary), .poly, .geojson; or a shape: rect:x0,y0,x1,y1, disk:cx,cy,r;
        or a surface: .obj, .off, .ply, .stl and the first five; sphere:r, torus:R,r, chair, 'implicit:EXPR;x0,y0,z0,x1,y1,z1'
METRIC  uniform, uniform:m11,m12,m22, swirl[:nu=3,field=authors], shock[:phi=10,lambda=0.6],
        'formula:m11; m12; m22' in x and y, boundary:h0=,growth=,aspect=,h_max=,
        hessian:EXPR or hessian:FILE.sol (for the least error of interpolation), or a file .sol or .solb;
        on surfaces: uniform, curvature[:floor=C], shock, 'formula:m11; m12; m22; m13; m23; m33' and hessian:EXPR in x, y, z,
        hessian:FILE.sol, or a .sol;
        an eigenvalue 1/h^2 asks for edges of length h along its eigenvector

Examples:
  voronaut mesh rect:0,0,2,1 --metric uniform -n 2000 -o plate.mesh
  voronaut mesh disk:0,0,1 --metric swirl -n 4000 -o swirl.vtu --picture swirl.svg
  voronaut mesh rect:-1,-1,1,1 --metric 'formula:1/(0.01 + 0.2*abs(y))^2; 0; 25' -o layer.mesh
  voronaut mesh disk:0,0,1 --metric swirl:field=printed -n 1000 --order 3 -o curved.msh --picture curved.svg
  voronaut mesh wing.mesh --metric wing.sol --h-min 1e-4 --a-max 100 -o adapted.mesh --report run.json
  voronaut mesh sea.geojson --metric boundary:h0=2,growth=1.3 -n 20000 -o sea.mesh -q
  voronaut mesh sea.geojson --metric boundary:h0=0.1,growth=1.1 -n 2000000 --parts auto --parts-dir parts -o sea.meshb
  voronaut mesh sphere:1 --metric 'hessian:tanh(10*(x + 0.2*z))' -n 2000 -o front.mesh
  voronaut mesh spot.obj --metric curvature -n 1020 --fit -o spot-1020.obj --picture spot.png --show cells,mesh";

#[derive(Debug, Args)]
pub(crate) struct MeshArgs {
    /// What to mesh: a file or a shape
    pub(crate) domain: String,
    /// Sizes and directions of the edges (see below)
    #[arg(long)]
    pub(crate) metric: String,
    /// Vertices the mesh should have; one factor scales the metric to meet it
    #[arg(short = 'n', long, value_name = "N", value_parser = value_parser!(u32).range(3..), conflicts_with = "complexity")]
    pub(crate) vertices: Option<u32>,
    /// Integral of sqrt(det M) over the domain; one factor scales the metric to meet it
    #[arg(long, value_name = "C", value_parser = positive)]
    pub(crate) complexity: Option<f64>,
    /// The mesh file: .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl
    #[arg(short, long, value_name = "OUT")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    /// How far (Euclidean) edges may stray from the boundary [default: the domain's own tolerance]; of a surface: mesh and surface
    /// from each other, by more vertices unless -n says how many
    #[arg(long, value_name = "D", value_parser = not_negative)]
    pub(crate) hausd: Option<f64>,
    /// In the plane: leave the edges of the domain's curves as they are, every one an edge of the mesh
    #[arg(long, conflicts_with = "hausd")]
    pub(crate) required: bool,
    /// The order of triangles: 1, straight; 2 or 3, curved: in the plane to follow the metric, or with hessian:EXPR so that interpolation by
    /// polynomials of that order has the least error; on sphere:, torus: and f = 0 to follow the surface (.msh, .vtu, .mesh and .meshb hold them)
    #[arg(long, value_name = "N", value_parser = value_parser!(u8).range(1..=3), default_value_t = MeshOptions::default().order as u8)]
    pub(crate) order: u8,
    /// What boundaries of curved triangles are: auto (the circle of disk:, else polyline), polyline (the domain's own straight
    /// segments), or spline (smooth curves through its vertices; corners of more than 45 degrees stay)
    #[arg(long, value_name = "HOW", default_value_t = MeshOptions::default().boundary)]
    pub(crate) boundary: Boundary,
    #[command(flatten)]
    pub(crate) paired: Paired,
    /// Surfaces: vertices where mesh and surface are closest in the sense of least squares, instead of on the surface
    #[arg(long)]
    pub(crate) fit: bool,
    #[command(flatten)]
    pub(crate) creases: Creases,
    /// What makes the mesh: voronoi, or starset (Delaunay stars in the metrics of their vertices, refined until they agree: to
    /// compare; -n then sets the scale only)
    #[arg(long, value_name = "HOW", default_value_t = MeshOptions::default().mesher)]
    pub(crate) mesher: Mesher,
    /// How much work is spent on what is left to gain: fast, normal or best
    #[arg(long, value_name = "HOW", default_value_t = MeshOptions::default().effort)]
    pub(crate) effort: Effort,
    /// Steps of Riemannian Lloyd relaxation, at most
    #[arg(long, value_name = "STEPS", default_value_t = MeshOptions::default().lloyd)]
    pub(crate) lloyd: usize,
    /// The centroids seeds are relaxed to: tangent (of cells in tangent planes), canvas (of the diagram's cells) or weighted
    /// (equation 9 of the report, to compare)
    #[arg(long, value_name = "WHICH", default_value_t = MeshOptions::default().centroid)]
    pub(crate) centroid: Centroid,
    /// With hessian metrics: sweeps in which vertices move and edges flip so that the error of interpolation falls, at most; 0 for
    /// the metric's unit mesh. Not with limits on the metric
    #[arg(long, value_name = "SWEEPS", default_value_t = MeshOptions::default().polish)]
    pub(crate) polish: usize,
    /// What decides on the edges: geodesic (their lengths), canvas (the diagram on one) or both (the diagram where lengths cannot)
    #[arg(long, value_name = "ROAD", default_value_t = MeshOptions::default().dual)]
    pub(crate) dual: Road,
    /// How distances on the canvas are computed where the diagram decides: march, stvd[:window=8], dijkstra or konukoglu
    #[arg(long, value_name = "METHOD", default_value_t = MeshOptions::default().geodesic)]
    pub(crate) geodesic: Method,
    /// Where interior seeds come to lie: sizing (at circumcentres), farthest (from all seeds, on a canvas) or protected
    /// (sizing, and power-protected)
    #[arg(long, value_name = "HOW", default_value_t = MeshOptions::default().seeding)]
    pub(crate) seeding: Seeding,
    /// With --seeding protected: the protection asked for, as a share of the greatest circumradius
    #[arg(long, value_name = "SHARE", value_parser = not_negative, allow_negative_numbers = true, default_value_t = MeshOptions::default().protection)]
    pub(crate) protection: f64,
    /// In the plane with --seeding protected: where a seed may be picked around a circumcentre, as a share of the circumradius
    #[arg(long, value_name = "SHARE", value_parser = not_negative, allow_negative_numbers = true, default_value_t = MeshOptions::default().picking_radius)]
    pub(crate) picking_radius: f64,
    /// Measure the net of the vertices: epsilon, mu, lambda, power protection (in the report)
    #[arg(long)]
    pub(crate) net: bool,
    /// What distances travel on, where a canvas is used: intrinsic, isotropic or starset (see `dual`)
    #[arg(long, value_name = "WHICH", default_value_t = MeshOptions::default().canvas)]
    pub(crate) canvas: canvas::Kind,
    /// Canvas vertices per seed, where a canvas is used
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..), default_value_t = MeshOptions::default().canvas_size)]
    pub(crate) canvas_size: u32,
    #[command(flatten)]
    pub(crate) in_parts: InParts,
    #[command(flatten)]
    pub(crate) outputs: Outputs,
    #[command(flatten)]
    pub(crate) paged: Paged,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

impl MeshArgs {
    /// Threads and limits: a part has one thread, for others are made beside it.
    pub(crate) fn run(&self) -> Cow<'_, Run> {
        match self.in_parts.part {
            None => Cow::Borrowed(&self.run),
            Some(_) => Cow::Owned(Run { threads: Some(1), ..self.run.clone() }),
        }
    }

    pub(crate) fn options(&self) -> MeshOptions {
        MeshOptions {
            vertices: self.vertices.map(|vertices| vertices as usize),
            complexity: self.complexity,
            hausd: self.hausd,
            order: self.order.into(),
            boundary: self.boundary,
            periodic: self.paired.pairs(),
            fit: self.fit,
            stiffness: MeshOptions::default().stiffness,
            mesher: self.mesher,
            effort: self.effort,
            lloyd: self.lloyd,
            centroid: self.centroid,
            polish: self.polish,
            dual: self.dual,
            geodesic: self.geodesic,
            seeding: self.seeding,
            protection: self.protection,
            picking_radius: self.picking_radius,
            net: self.net || self.outputs.shows(Show::Protection),
            canvas: self.canvas,
            canvas_size: self.canvas_size,
            memory_limit: self.run.limits.memory(),
        }
    }

    /// The canvas of cells on the page, if it shows them.
    fn drawn(&self) -> Option<Drawn> {
        self.paged.cells.then_some(Drawn { kind: self.canvas, size: self.canvas_size })
    }

    /// The options that have no say; an error if one of them is set.
    fn idle(&self, on_surface: bool, world: &World) -> Result<Vec<Idle>> {
        let is_pictured = self.outputs.picture.is_some() && self.outputs.need_diagram();
        let is_drawn = is_pictured || self.paged.cells;
        let task = Task { is_drawn, ..fields::task(world, &self.metric, &self.metric_choices, on_surface) };
        let idle = [self.options().idle(task), self.metric_choices.options().idle(task)].concat();
        idle.iter().try_for_each(Idle::demand_unset)?;
        Ok(idle)
    }

    /// All options as used, without those that have no say.
    fn as_used(&self, idle: &[Idle]) -> Value {
        let bounds = self.metric_choices.bounds();
        let more = json!({
            "domain": self.domain, "metric": self.metric, "out": self.out, "background": self.metric_choices.background,
            "smooth_metric": self.metric_choices.smooth_metric, "tensor_order": self.metric_choices.tensor_order, "gradation": self.metric_choices.gradation,
            "norm": self.metric_choices.norm.to_string(), "recovery": self.metric_choices.recovery,
            "ar": self.creases.options().ar, "h_min": bounds.h_min, "h_max": bounds.h_max, "a_max": bounds.a_max,
            "picture": self.outputs.picture, "view": self.paged.view, "cells": self.paged.cells, "pixels": self.outputs.pixels, "histograms": self.outputs.histograms, "report": self.run.report, "threads": self.run.threads,
            "repair": self.damage.repair, "required": self.required,
            "parts": self.in_parts.parts.map(|parts| parts.to_string()),
        });
        let mut options = account::joined(json!(self.options()), more);
        if let Some(options) = options.as_object_mut() {
            options.retain(|name, _| idle.iter().all(|idle| idle.option != name));
        }
        options
    }
}

/// Meshes a domain. Nothing is written unless the mesh is valid.
pub(crate) fn run(args: &MeshArgs, world: &World) -> Result<()> {
    let start = world.seconds();
    let view = world.page_file(&args.paged);
    files::demand_writable(world.file(&args.out), None, view, &args.outputs, &args.run)?;
    demand_for_curves(args, world)?;
    if let Some(job) = &args.in_parts.part
        && parts::one_by_itself(job, world, &args.run, &args.options())?
    {
        return Ok(());
    }
    args.metric_choices.bounds().check()?;
    let (given, mended) = world.given(&args.domain, args.damage.options())?;
    match given {
        Given::Surface(input) => on_surface(args, world, input, &mended, start),
        Given::Plane(domain) if args.required => in_plane(args, world, &required(&domain)?, &mended, start),
        Given::Plane(domain) => in_plane(args, world, &domain, &mended, start),
    }
}

/// Refuses what there is not of curved triangles, if they are asked for.
fn demand_for_curves(args: &MeshArgs, world: &World) -> Result<()> {
    if args.order == 1 {
        return Ok(());
    }
    if let Some(out) = world.file(&args.out) {
        Format::from_path(out)?.demand_order(args.order.into())?;
    }
    let parts = (args.in_parts.is_asked(), "--parts with curved triangles", "leave out --parts, or use --order 1");
    refuse([parts])?;
    curves::demand_drawable(&args.outputs)
}

/// The domain with all its curves' edges required.
fn required(domain: &Domain) -> Result<Domain> {
    let mut pslg = domain.pslg().clone();
    pslg.segments.iter_mut().for_each(|segment| segment.required = true);
    Domain::new(&pslg)
}

fn in_plane(args: &MeshArgs, world: &World, domain: &Domain, mended: &Mended, start: f64) -> Result<()> {
    args.creases.demand_unset()?;
    let idle = args.idle(false, world)?;
    let (outputs, options) = (&args.outputs, args.options());
    let at = GradedAt::of(options.vertices, args.complexity);
    let choices = args.metric_choices.of_degree(options.order);
    let made = fields::in_plane(world, &args.metric, domain, &args.domain, &choices, at)?;
    let (metric, aim) = (made.field.as_ref(), made.aim(args.metric_choices.norm));
    let field = parts::Field::Plane(domain, metric, aim);
    if let Some(job) = &args.in_parts.part {
        return parts::one(job, world, &args.run, field, &options);
    }
    let mut used = args.as_used(&idle);
    // Creases are of surfaces.
    used["ar"] = Value::Null;
    let meshed = match args.in_parts.parts {
        Some(_) => args.in_parts.all(world, &args.run, field, &options, &used)?,
        None => recipe::mesh_for(domain, metric, aim, &options, &*world.progress(&args.run))?,
    };
    let mesh = &meshed.mesh;
    curves::demand_made(mesh, options.order)?;
    let scaled = |p: Point| metric.at(p) * meshed.metric_scale;
    let is_told = world.tells(&args.run) || outputs.picture.is_some();
    let on = Riemannian::from(&scaled);
    let (mut report, unmet) = account::of(&meshed, on, mended, used, is_told)?;
    if args.in_parts.parts.is_some() {
        // Each part has its own, of which nothing is kept.
        (report.dual, report.relaxation) = (None, None);
    }
    report.histograms = files::histograms(outputs, mesh, on)?;
    let error = |aim: Aim| interpolation_error(mesh, aim.function, aim.norm);
    report.interpolation = aim.map(error).transpose()?;
    report.seconds.total = world.seconds() - start;
    let sheet = pages::of(&args.paged, &args.out, &meshed.mesh, |sheet| {
        pages::measured(sheet, on, meshed.mesh.curved.is_none())?;
        args.drawn().map_or(Ok(()), |drawn| pages::with_cells(sheet, domain, &scaled, drawn))
    })?;
    let layers = Layers {
        protection: pictures::protection(outputs, meshed.net.as_ref(), args.protection),
        unmet: Some(unmet).filter(|_| outputs.shows(Show::Unmet)),
        ..cells(args, domain, mesh, &scaled)?
    };
    let picture = pictures::in_plane(outputs, mesh, Some(&scaled), &layers)?;
    finish(args, world, meshed.mesh, picture, sheet, &report)
}

/// The diagram of the mesh's vertices, made only to be drawn.
fn cells(args: &MeshArgs, domain: &Domain, mesh: &Mesh, metric: &dyn MetricField) -> Result<Layers> {
    if !args.outputs.need_diagram() {
        return Ok(Layers::default());
    }
    let seeds: Vec<Point> = mesh.points.iter().map(|p| Point::new(p[0], p[1])).collect();
    let size = (args.canvas_size as usize).saturating_mul(seeds.len());
    let canvas = Canvas::new(args.canvas, domain.planar(), metric, size)?;
    let diagram = Diagram::new(&canvas, metric, &seeds)?;
    let curved = args.outputs.have_geodesics().then(|| Realisation::new(&diagram, &mesh.triangles));
    Ok(pictures::layers(&args.outputs, &diagram, metric, curved.as_ref()))
}

fn on_surface(args: &MeshArgs, world: &World, input: Manifold, mended: &Mended, start: f64) -> Result<()> {
    let required = "leave out --required: it is for planar domains; list required edges in the surface's file";
    refuse([(args.required, "--required on a surface", required)])?;
    pictures::demand_of_surfaces(&args.outputs)?;
    let idle = args.idle(true, world)?;
    let is_whole = args.outputs.picture.is_some() || args.drawn().is_some();
    let whole = is_whole.then(|| Manifold::new(input.surface().clone(), input.equation().cloned()));
    let input = &input.cut(&args.creases.options())?;
    let at = GradedAt::of(args.options().vertices, args.complexity);
    let metric = fields::on_surface(world, &args.metric, input, &args.metric_choices, at)?;
    let aim = aimed(args);
    let aim = aim.as_ref().map(|function| (function, args.metric_choices.norm));
    let (options, field) = (args.options(), parts::Field::Surface(input, metric.as_ref(), aim));
    if let Some(job) = &args.in_parts.part {
        return parts::one(job, world, &args.run, field, &options);
    }
    let mut used = args.as_used(&idle);
    if args.dual == Road::Both {
        // Lengths decide, unless it is the canvas.
        used["dual"] = json!(Road::Geodesic);
    }
    let meshed = match args.in_parts.parts {
        Some(_) => args.in_parts.all(world, &args.run, field, &options, &used)?,
        None => recipe::mesh_surface(input, metric.as_ref(), aim, &options, &*world.progress(&args.run))?,
    };
    let made_for = Finer { field: metric.as_ref(), surface: input.surface(), logs: &meshed.finer };
    let is_told = world.tells(&args.run) || args.outputs.picture.is_some();
    let scaled = Scaled { field: &made_for, factor: meshed.metric_scale };
    let on = Riemannian::from((input, &scaled));
    let (mut report, unmet) = account::of(&meshed, on, mended, used, is_told)?;
    if args.in_parts.parts.is_some() {
        // As in the plane.
        (report.dual, report.relaxation) = (None, None);
    }
    report.interpolation = interpolated(args, input, &meshed.mesh)?;
    report.seconds.total = world.seconds() - start;
    let drawn = whole.as_ref().filter(|_| args.outputs.picture.is_some());
    let picture = drawn.map(|whole| drawn_on(args, world, whole, &meshed, &unmet)).transpose()?;
    report.histograms = files::histograms(&args.outputs, &meshed.mesh, on)?;
    let sheet = pages::of(&args.paged, &args.out, &meshed.mesh, |sheet| {
        pages::measured(sheet, on, true)?;
        let (Some(whole), Some(drawn)) = (&whole, args.drawn()) else { return Ok(()) };
        let at = GradedAt::Scale(meshed.metric_scale);
        let field = fields::on_surface(world, &args.metric, whole, &args.metric_choices, at)?;
        pages::with_cells_on(sheet, whole, &Scaled { field: field.as_ref(), factor: meshed.metric_scale }, drawn)
    })?;
    finish(args, world, meshed.mesh, picture, sheet, &report)
}

/// The function that the mesh of a surface is for, if that is a formula and nothing else is asked of the metric.
fn aimed(args: &MeshArgs) -> Option<Expression> {
    match Spec::parse(&args.metric) {
        Ok(Spec::Hessian(function)) if !args.metric_choices.options().is_limiting() => Some(function),
        _ => None,
    }
}

/// The error of interpolation of the function that the mesh is for, if that is a formula.
fn interpolated(args: &MeshArgs, input: &Manifold, mesh: &Mesh) -> Result<Option<InterpolationError>> {
    let Ok(Spec::Hessian(function)) = Spec::parse(&args.metric) else { return Ok(None) };
    interpolation_error_on(mesh, input, &function, args.metric_choices.norm).map(Some)
}

/// Writes a valid mesh, and what is beside it.
fn finish(
    args: &MeshArgs,
    world: &World,
    mesh: Mesh,
    picture: Option<String>,
    sheet: Option<Sheet>,
    report: &Report,
) -> Result<()> {
    world.write_mesh(mesh, &args.out)?;
    pages::write(&args.paged, world, sheet)?;
    files::finish(world, &args.out, &args.outputs, picture, report, &args.run)
}

/// The mesh of a surface that is whole: cells are drawn across creases.
fn drawn_on(args: &MeshArgs, world: &World, whole: &Manifold, meshed: &Meshed, unmet: &Unmet) -> Result<String> {
    if !pictures::need_diagram_on_surface(&args.outputs) {
        return pictures::of_surface_mesh(&args.outputs, &meshed.mesh, unmet);
    }
    let (mesh, at) = (&meshed.mesh, GradedAt::Scale(meshed.metric_scale));
    let metric = fields::on_surface(world, &args.metric, whole, &args.metric_choices, at)?;
    let places = mesh.points.iter().map(|&p| whole.closest(p.into())).collect::<Result<Vec<_>>>()?;
    let size = canvas::size_for(places.len(), args.canvas_size);
    let (canvas, at) = Canvas::on_surface(args.canvas, whole, metric.as_ref(), size, &places)?;
    let diagram = SurfaceDiagram::of_kind_on_surface(Kind::Riemannian, &canvas, &at, Method::March)?;
    let curved = args.outputs.have_geodesics().then(|| recipe::Measured::realisation(&diagram, &mesh.triangles));
    pictures::on_surface(&args.outputs, &diagram, mesh, curved.as_ref())
}
