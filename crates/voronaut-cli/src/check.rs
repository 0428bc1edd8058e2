//! `voronaut check`: examines a mesh that is there.

use crate::fields;
use crate::options::{Creases, Damage, MetricChoices, Outputs, Run, Show, positive, refuse};
use crate::world::World;
use crate::{account, curves, files, pictures};
use clap::Args;
use serde_json::json;
use std::path::PathBuf;
use voronaut::manifold::Manifold;
use voronaut::manifold::domain::{Domain, from_mesh};
use voronaut::manifold::surface::Mended;
use voronaut::manifold::surface::metric::Scaled;
use voronaut::mesh::Mesh;
use voronaut::metric::{Expression, MetricField, Snapshot, Variables};
use voronaut::quality::{
    Meetings, Unmet, fidelity, interpolation_error, interpolation_error_on, surface_fidelity, validity, validity_on,
};
use voronaut::recipe::GradedAt;
use voronaut::{Error, Result};
use voronaut_draw::Layers;
use voronaut_io::{Document, Given, Report, Strayed};

pub(crate) const EXAMPLES: &str = "\
Exits with 1 if the mesh is not valid; the report is written all the same.

The mesh of a surface (some z is not 0) is held against a surface as DOMAIN: sphere:r, torus:R,r, chair,
implicit:EXPR;x0,y0,z0,x1,y1,z1, or a file .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl. METRIC is then uniform, curvature[:floor=C],
shock[:phi=10,lambda=0.6], 'formula:m11; m12; m22; m13; m23; m33' in x, y, z, or a file .sol of the domain's file.

Examples:
  voronaut check plate.mesh
  voronaut check cow.ply --domain spot.obj --metric curvature --metric-scale 310 --report check.json
  voronaut check swirl.mesh --metric swirl --metric-scale 1873.2 --report check.json
  voronaut check adapted.mesh --metric wing.sol --background wing.mesh --domain wing.mesh";

#[derive(Debug, Args)]
pub(crate) struct CheckArgs {
    /// The mesh: .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl
    pub(crate) mesh: PathBuf,
    /// Measure lengths, shapes and angles in this metric (as for `mesh`)
    #[arg(long)]
    pub(crate) metric: Option<String>,
    /// A factor on the metric tensor, such as `metric_scale` of a report
    #[arg(long, value_name = "FACTOR", value_parser = positive, requires = "metric")]
    pub(crate) metric_scale: Option<f64>,
    /// Measure the error of interpolation of this function of x and y, by polynomials of the triangles' order, on a surface (of order 1) of x,
    /// y and z, in the L^p norm of --norm
    #[arg(long, value_name = "EXPR")]
    pub(crate) function: Option<String>,
    /// Measure the distance to the boundary of this domain (as for `mesh`), or to this surface [default of a metric on a surface:
    /// the mesh itself]
    #[arg(long)]
    pub(crate) domain: Option<String>,
    #[command(flatten)]
    pub(crate) metric_choices: MetricChoices,
    #[command(flatten)]
    pub(crate) creases: Creases,
    #[command(flatten)]
    pub(crate) outputs: Outputs,
    #[command(flatten)]
    pub(crate) damage: Damage,
    #[command(flatten)]
    pub(crate) run: Run,
}

/// Examines a mesh. The report is written for any mesh; figures in a metric and pictures are for valid ones.
pub(crate) fn run(args: &CheckArgs, world: &World) -> Result<()> {
    let start = world.seconds();
    files::demand_writable(None, None, None, &args.outputs, &args.run)?;
    demand_drawable(args)?;
    let Document { mesh, notes, .. } = world.document(&args.mesh)?;
    demand_for_curves(args, &mesh)?;
    let read = |spec: &str| world.given(spec, args.damage.options());
    let (given, mended) = args.domain.as_deref().map(read).transpose()?.unzip();
    let found = match &given {
        Some(Given::Surface(input)) => validity_on(&mesh, &Meetings::of(input.whole_mesh())),
        _ => validity(&mesh),
    };
    let fault = found.demand();
    let meets = found.meetings.note();
    let mut report = Report::new(&mesh, found);
    report.notes = notes;
    curves::report(&mut report, &mesh);
    report.options = json!({
        "mesh": args.mesh, "metric": args.metric, "metric_scale": args.metric_scale, "domain": args.domain, "function": args.function, "norm": args.metric_choices.norm.to_string(),
        "background": args.metric_choices.background, "bounds": args.metric_choices.bounds(),
        "smooth_metric": args.metric_choices.smooth_metric, "tensor_order": args.metric_choices.tensor_order, "gradation": args.metric_choices.gradation, "repair": args.damage.repair,
    });
    if let Err(fault) = fault {
        report.seconds.total = world.seconds() - start;
        files::finish(world, &args.mesh, &args.outputs, None, &report, &args.run)?;
        return Err(fault);
    }
    report.metric_scale = args.metric.is_some().then_some(args.metric_scale.unwrap_or(1.0));
    report.notes.extend(mended.iter().flat_map(Mended::sentences).chain(meets));
    let picture = match given {
        Some(Given::Surface(input)) => on_surface(args, world, &mesh, Some(input), &mut report)?,
        None if !mesh.is_planar() => on_surface(args, world, &mesh, None, &mut report)?,
        Some(Given::Plane(domain)) => in_plane(args, world, &mesh, Some(&domain), &mut report)?,
        None => in_plane(args, world, &mesh, None, &mut report)?,
    };
    report.seconds.total = world.seconds() - start;
    files::finish(world, &args.mesh, &args.outputs, picture, &report, &args.run)
}

/// Refuses pictures of what a mesh that is only checked does not have.
fn demand_drawable(args: &CheckArgs) -> Result<()> {
    let outputs = &args.outputs;
    refuse([
        (
            outputs.need_diagram() || outputs.shows(Show::Protection),
            "a picture of cells of a mesh that is only checked",
            "give its vertices to voronaut dual as seeds",
        ),
        (
            args.metric.is_none() && outputs.shows(Show::Unmet),
            "a picture of where a metric is not met, without a metric",
            "give the --metric",
        ),
    ])
}

/// Refuses what there is not of curved triangles, if the mesh has them.
fn demand_for_curves(args: &CheckArgs, mesh: &Mesh) -> Result<()> {
    if mesh.curved.is_none() {
        return Ok(());
    }
    refuse([(
        args.function.is_some() && !mesh.is_planar(),
        "the error of interpolation on curved triangles of a surface",
        "leave out --function",
    )])?;
    curves::demand_drawable(&args.outputs)
}

/// Measures a planar mesh, and draws it if that is asked for.
fn in_plane(
    args: &CheckArgs,
    world: &World,
    mesh: &Mesh,
    domain: Option<&Domain>,
    report: &mut Report,
) -> Result<Option<String>> {
    if !mesh.is_planar() {
        let what = format!("{} is not planar (z = 0), its domain is", args.mesh.display());
        return Err(Error::unsupported(what, "give the surface that it is a mesh of as --domain"));
    }
    args.creases.demand_unset()?;
    let mut layers = Layers::default();
    let metric = args.metric.as_deref().map(|text| planar_metric(args, world, text, mesh, domain)).transpose()?;
    if let Some(metric) = metric.as_deref() {
        let unmet = account::measure(report, mesh, metric.into())?;
        report.histograms = files::histograms(&args.outputs, mesh, metric.into())?;
        layers.unmet = Some(unmet).filter(|_| args.outputs.shows(Show::Unmet));
    }
    if let Some(text) = &args.function {
        let function = Snapshot::from(Expression::parse(text, Variables::Plane)?);
        report.interpolation = Some(interpolation_error(mesh, &function, args.metric_choices.norm)?);
    }
    let straight = domain.filter(|_| mesh.curved.is_none());
    report.fidelity = straight.map(|domain| Strayed::Boundary(fidelity(mesh, &domain.boundary())));
    if domain.is_some() && mesh.curved.is_some() {
        report.notes.push("how far curved triangles are from the domain's boundary is not measured".into());
    }
    pictures::in_plane(&args.outputs, mesh, metric.as_deref(), &layers)
}

/// Measures the mesh of a surface, of its own triangles if no other is given, and draws it if that is asked for.
fn on_surface(
    args: &CheckArgs,
    world: &World,
    mesh: &Mesh,
    given: Option<Manifold>,
    report: &mut Report,
) -> Result<Option<String>> {
    demand_for_surfaces(args, world)?;
    report.options["ar"] = json!(args.creases.options().ar);
    let given = given.map(|whole| whole.cut(&args.creases.options())).transpose()?;
    if let Some(input) = &given {
        report.fidelity = Some(Strayed::Surface(surface_fidelity(mesh, input)?.into()));
    }
    let drawn = |unmet: &Unmet| pictures::of_surface_mesh(&args.outputs, mesh, unmet);
    let picture = |unmet: &Unmet| args.outputs.picture.as_ref().map(|_| drawn(unmet)).transpose();
    let mut unmet = Unmet::default();
    let own;
    let input = if let Some(input) = &given {
        input
    } else if args.metric.is_some() || args.function.is_some() {
        own = Manifold::of(mesh)?.cut(&args.creases.options())?;
        &own
    } else {
        return picture(&Unmet::default());
    };
    if let Some(text) = &args.function {
        let function = Expression::parse(text, Variables::Space)?;
        report.interpolation = Some(interpolation_error_on(mesh, input, &function, args.metric_choices.norm)?);
    }
    if let Some(text) = &args.metric {
        let factor = args.metric_scale.unwrap_or(1.0);
        let field = fields::on_surface(world, text, input, &args.metric_choices, GradedAt::Scale(factor))?;
        let scaled = Scaled { field: field.as_ref(), factor };
        unmet = account::measure(report, mesh, (input, &scaled).into())?;
        report.histograms = files::histograms(&args.outputs, mesh, (input, &scaled).into())?;
    }
    picture(&unmet)
}

/// Refuses what is not there for surfaces.
fn demand_for_surfaces(args: &CheckArgs, world: &World) -> Result<()> {
    pictures::demand_of_surfaces(&args.outputs)?;
    args.metric.as_ref().map_or(Ok(()), |text| fields::demand_for_surfaces(world, text, &args.metric_choices))
}

/// The metric, times its factor. A `.sol` file belongs to the background mesh, else to the domain's, else to the mesh.
fn planar_metric(
    args: &CheckArgs,
    world: &World,
    text: &str,
    mesh: &Mesh,
    domain: Option<&Domain>,
) -> Result<Box<dyn MetricField>> {
    let mesh_file = args.mesh.to_string_lossy();
    let file = args.domain.as_deref().unwrap_or(&mesh_file);
    let own;
    let domain = if let Some(domain) = domain {
        domain
    } else {
        let pslg = if mesh.curved.is_some() { from_mesh(&curves::outline(mesh))? } else { from_mesh(mesh)? };
        own = Domain::new(&pslg)?;
        &own
    };
    let scale = args.metric_scale.unwrap_or(1.0);
    let choices = args.metric_choices.of_degree(curves::order_of(mesh));
    fields::measuring(world, text, domain, file, &choices, scale)
}
