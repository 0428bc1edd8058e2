//! The files a run writes: tried before the work, written after it.

use crate::args::{Outputs, Run, Show};
use std::path::Path;
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::output::{self, Format, Picture, PictureFormat, Report};
use voronaut::{Error, Result};

/// Refuses, before any work, outputs that could not be written: endings, directories, one name used twice.
pub(crate) fn demand_writable(mesh: Option<&Path>, outputs: &Outputs) -> Result<()> {
    mesh.map(Format::from_path).transpose()?;
    outputs.picture.as_deref().map(PictureFormat::from_path).transpose()?;
    let files = [mesh, outputs.picture.as_deref(), outputs.report.as_deref()];
    let mut seen = Vec::new();
    for file in files.into_iter().flatten() {
        let place = output::place(file)?;
        if seen.contains(&place) {
            let what = "two outputs have the same name";
            return Err(Error::parse(file.display().to_string(), what, "give each output a name of its own"));
        }
        seen.push(place);
    }
    Ok(())
}

/// Writes mesh, picture and report, as far as asked for. The picture is drawn before anything is written.
pub(crate) fn write(
    mesh_file: Option<&Path>,
    outputs: &Outputs,
    mesh: &Mesh,
    metric: Option<&dyn MetricField>,
    report: &Report,
) -> Result<()> {
    let picture = outputs.picture.as_deref().map(|path| Ok((path, draw(outputs, mesh, metric)?))).transpose()?;
    mesh_file.map(|path| output::write_mesh(mesh, path)).transpose()?;
    picture.map(|(path, svg)| output::write_picture(&svg, path)).transpose()?;
    write_report(outputs, report)
}

/// Writes the report, if asked for.
pub(crate) fn write_report(outputs: &Outputs, report: &Report) -> Result<()> {
    outputs.report.as_deref().map_or(Ok(()), |path| output::write(path, report.to_json().as_bytes()))
}

/// Uses so many threads from now on.
pub(crate) fn set_threads(run: &Run) -> Result<()> {
    let Some(threads) = run.threads else { return Ok(()) };
    let built = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global();
    let help = "ask for fewer threads";
    built.map_err(|error| Error::Limit { what: format!("{threads} threads: {error}"), help: help.into() })
}

fn draw(outputs: &Outputs, mesh: &Mesh, metric: Option<&dyn MetricField>) -> Result<String> {
    let shows = |what| outputs.show.contains(&what);
    let picture = Picture {
        mesh: shows(Show::Mesh),
        ellipses: shows(Show::Ellipses),
        width: outputs.pixels,
        ..Picture::default()
    };
    output::svg(mesh, metric, &picture)
}
