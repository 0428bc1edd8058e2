//! `voronaut check`: examines a mesh that is there.

use crate::args::{CheckArgs, Show};
use crate::files::{Drawn, MeshFile};
use crate::{files, summary};
use serde_json::json;
use std::path::Path;
use std::time::Instant;
use voronaut::domain::{Domain, read_text};
use voronaut::formats::medit;
use voronaut::geometry::Point;
use voronaut::mesh::Mesh;
use voronaut::metric::{MetricField, MetricSpec};
use voronaut::output::Report;
use voronaut::quality::{fidelity, metric_quality, validity};
use voronaut::recipe;
use voronaut::{Error, Result};

/// Examines a mesh. The report is written for any mesh; figures in a metric and pictures are for valid ones.
pub(crate) fn run(args: &CheckArgs) -> Result<()> {
    let start = Instant::now();
    files::demand_writable(None, None, &args.outputs)?;
    if Drawn::is_wanted(&args.outputs) || args.outputs.show.contains(&Show::Protection) {
        let what = "a picture of cells of a mesh that is only checked".into();
        return Err(Error::Unsupported { what, help: "give its vertices to voronaut dual as seeds".into() });
    }
    files::set_threads(&args.run)?;
    let mesh = read(&args.mesh)?;
    let found = validity(&mesh);
    let fault = found.demand();
    let mut report = Report::new(found, mesh.points.len(), mesh.triangles.len());
    report.options = json!({
        "mesh": args.mesh, "metric": args.metric, "metric_scale": args.metric_scale, "domain": args.domain,
        "background": args.metric_choices.background, "bounds": args.metric_choices.bounds(),
        "smooth_metric": args.metric_choices.smooth_metric,
    });
    if let Err(fault) = fault {
        report.seconds.total = start.elapsed().as_secs_f64();
        files::write_report(&args.outputs, &report)?;
        summary::print(&args.mesh.display().to_string(), &report, &args.run);
        return Err(fault);
    }
    let domain = args.domain.as_deref().map(Domain::read).transpose()?;
    let metric = args.metric.as_deref().map(|text| metric(args, text, domain.as_ref())).transpose()?;
    report.metric_scale = args.metric.is_some().then_some(args.metric_scale.unwrap_or(1.0));
    if let Some(metric) = &metric {
        report = report.with_quality(&metric_quality(&mesh, metric.as_ref())?);
        report.histograms = files::histograms(&args.outputs, &mesh, metric.as_ref())?;
    }
    report.fidelity = domain.map(|domain| fidelity(&mesh, &domain.boundary()));
    report.seconds.total = start.elapsed().as_secs_f64();
    files::write(&MeshFile::None, &args.outputs, &mesh, metric.as_deref(), &report, &Drawn::default())?;
    summary::print(&args.mesh.display().to_string(), &report, &args.run);
    Ok(())
}

fn read(path: &Path) -> Result<Mesh> {
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("mesh")) {
        let what = format!("{} does not end in .mesh", path.display());
        return Err(Error::Unsupported { what, help: "convert the mesh to Medit's text format".into() });
    }
    medit::read(&read_text(path)?, &path.display().to_string())
}

/// The metric, times its factor. A `.sol` file belongs to the background mesh, else to the domain's, else to the mesh.
fn metric(args: &CheckArgs, text: &str, domain: Option<&Domain>) -> Result<Box<dyn MetricField>> {
    let bounds = args.metric_choices.bounds();
    bounds.check()?;
    let spec = MetricSpec::parse(text)?;
    let own_file = args.domain.as_deref().map_or(args.mesh.as_path(), Path::new);
    let own = matches!(spec, MetricSpec::File(_)).then_some(own_file);
    let background = args.metric_choices.background.as_deref().or(own);
    let own;
    let domain = if let Some(domain) = domain {
        domain
    } else {
        own = Domain::read(&args.mesh.to_string_lossy())?;
        &own
    };
    let metric = recipe::metric(&spec, domain, background, bounds)?;
    let metric = recipe::smooth_metric(metric, domain, background, args.metric_choices.smooth_metric)?;
    let scale = args.metric_scale.unwrap_or(1.0);
    Ok(Box::new(move |p: Point| metric.at(p) * scale))
}
