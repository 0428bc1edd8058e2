//! The files a run writes: tried before the work, written after it.

use crate::options::{Outputs, Run};
use crate::summary;
use crate::world::World;
use std::path::Path;
use voronaut::manifold::Riemannian;
use voronaut::mesh::{Mesh, SolutionValues, Solutions};
use voronaut::quality::{self, Histograms};
use voronaut::{Error, Result};
use voronaut_io::{Fields, Format, Report, ending};

/// Refuses, before any work, outputs that could not be written: endings, directories, one name used twice. `more` is
/// what is written beside a mesh; a page is one, too.
pub(crate) fn demand_writable(
    mesh: Option<&Path>,
    more: Option<&Path>,
    page: Option<&Path>,
    outputs: &Outputs,
    run: &Run,
) -> Result<()> {
    let (picture, histograms) = (outputs.picture.as_deref(), outputs.histograms.as_deref());
    mesh.map(Format::from_path).transpose()?;
    picture.map(voronaut_draw::is_png).transpose()?;
    if let Some(path) = histograms.filter(|path| ending(path).as_deref() != Some("svg")) {
        let what = format!("histograms in {}", path.display());
        return Err(Error::unsupported(what, "end the name of the histograms in .svg"));
    }
    page.map(demand_page).transpose()?;
    demand_apart([mesh, more, page, picture, histograms, run.report.as_deref()])
}

/// Refuses, before any work, a page whose name browsers would not open as one.
pub(crate) fn demand_page(path: &Path) -> Result<()> {
    if matches!(ending(path).as_deref(), Some("html" | "htm")) {
        return Ok(());
    }
    let what = format!("{} does not end like a page", path.display());
    Err(Error::unsupported(what, "end the name of the page in .html"))
}

/// Refuses, before any work, a file of values that could not be written, or is the report's.
pub(crate) fn demand_solution(file: &Path, run: &Run) -> Result<()> {
    if !matches!(ending(file).as_deref(), Some("sol" | "solb")) {
        let what = format!("{} does not end like a solution file", file.display());
        return Err(Error::unsupported(what, "end the name of OUT in .sol or .solb"));
    }
    demand_apart([Some(file), run.report.as_deref()])
}

/// Refuses files in no directory, and one name used twice.
pub(crate) fn demand_apart<'a>(files: impl IntoIterator<Item = Option<&'a Path>>) -> Result<()> {
    let mut seen = Vec::new();
    for file in files.into_iter().flatten() {
        let place = voronaut_io::place(file)?;
        if seen.contains(&place) {
            let what = "two outputs have the same name";
            return Err(Error::parse(file.display().to_string(), what, "give each output a name of its own"));
        }
        seen.push(place);
    }
    Ok(())
}

/// Values of which there is not one for each vertex or triangle of a mesh.
pub(crate) struct Miscounted {
    /// Their section of the file.
    pub(crate) section: &'static str,
    pub(crate) found: usize,
    pub(crate) needed: usize,
    /// What the mesh has so many of as are needed.
    pub(crate) places: &'static str,
}

/// The first values that are not those of a mesh, by their number.
pub(crate) fn miscounted(values: &Solutions, mesh: &Mesh) -> Option<Miscounted> {
    let of_vertices = ("SolAtVertices", &values.vertices, mesh.points.len(), "vertices");
    let of_triangles = ("SolAtTriangles", &values.triangles, mesh.triangles.len(), "triangles");
    [of_vertices, of_triangles].into_iter().find_map(|(section, solutions, needed, places)| {
        let found = solutions.iter().map(SolutionValues::count).find(|&found| found != needed)?;
        Some(Miscounted { section, found, needed, places })
    })
}

/// The values of a file as fields of the mesh that they belong to.
pub(crate) fn values_of(mesh: &Mesh, values: Solutions, file: &Path) -> Result<Fields> {
    if let Some(Miscounted { found, needed, places, .. }) = miscounted(&values, mesh) {
        let what = format!("{found} values, and the mesh has {needed} {places}");
        return Err(Error::parse(file.display().to_string(), what, "give the values that belong to the mesh"));
    }
    Ok(Fields::of_solutions(values))
}

/// The distributions of lengths and angles, if they are to be drawn.
pub(crate) fn histograms(outputs: &Outputs, mesh: &Mesh, on: Riemannian) -> Result<Option<Histograms>> {
    outputs.histograms.is_some().then(|| quality::histograms(mesh, on)).transpose()
}

/// Writes what is beside a mesh, picture, histograms and report, as far as asked for, and says what was found.
pub(crate) fn finish(
    world: &World,
    mesh: &Path,
    outputs: &Outputs,
    picture: Option<String>,
    report: &Report,
    run: &Run,
) -> Result<()> {
    world.go_on()?;
    write_picture(picture, outputs.picture.as_deref())?;
    if let (Some(path), Some(found)) = (&outputs.histograms, &report.histograms) {
        voronaut_io::write(path, voronaut_draw::histograms_svg(found).as_bytes())?;
    }
    world.write_report(report.to_json(), run)?;
    summary::print(mesh, report, run);
    Ok(())
}

/// Writes a picture, if there is one, in the format its name ends in, as a whole or not at all.
pub(crate) fn write_picture(svg: Option<String>, path: Option<&Path>) -> Result<()> {
    let Some((svg, path)) = svg.zip(path) else { return Ok(()) };
    voronaut_io::write(path, &voronaut_draw::picture_bytes(&svg, path)?)
}
