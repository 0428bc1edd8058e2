//! The files a run writes: tried before the work, written after it.

use crate::options::{Outputs, Run, Show};
use std::collections::BTreeMap;
use std::path::Path;
use voronaut::certificate::Certificate;
use voronaut::diagram::{Cells, Diagram};
use voronaut::geometry::Point;
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::net::Net;
use voronaut::quality::{self, Histograms, Unmet};
use voronaut::realisation::{Grid, Realisation};
use voronaut::{Error, Result};
use voronaut_draw::{Layers, Picture, PictureFormat, Protection};
use voronaut_io::{Format, Report};

/// Pieces per side in which pictures show a Riemannian triangle.
const PIECES: usize = 4;

/// Refuses, before any work, outputs that could not be written: endings, directories, one name used twice. `more` is
/// what is written beside a mesh.
pub(crate) fn demand_writable(mesh: Option<&Path>, more: Option<&Path>, outputs: &Outputs) -> Result<()> {
    mesh.map(Format::from_path).transpose()?;
    outputs.picture.as_deref().map(PictureFormat::from_path).transpose()?;
    outputs.histograms.as_deref().map(demand_histograms).transpose()?;
    let files = [mesh, more, outputs.picture.as_deref(), outputs.histograms.as_deref(), outputs.report.as_deref()];
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

/// What a picture shows of a diagram.
#[derive(Default)]
pub(crate) struct Drawn {
    cells: Option<Cells>,
    witnesses: Option<[Vec<[Point; 3]>; 2]>,
    geodesics: Vec<Vec<Point>>,
    grids: Vec<Vec<Point>>,
    protection: Option<Protection>,
    factors: Option<BTreeMap<u32, f64>>,
    unmet: Option<Unmet>,
}

impl Drawn {
    /// Whether the picture, if there is one, needs a diagram.
    pub(crate) fn is_wanted(outputs: &Outputs) -> bool {
        outputs.picture.is_some() && outputs.show.iter().any(|show| show.is_of_diagram())
    }

    /// Whether the dual's seeds are to be measured as a net: for the report, or the picture.
    pub(crate) fn needs_net(outputs: &Outputs) -> bool {
        outputs.report.is_some() || outputs.show.contains(&Show::Protection)
    }

    /// Whether the picture, if there is one, shows a mesh with geodesic edges.
    pub(crate) fn has_geodesics(outputs: &Outputs) -> bool {
        outputs.picture.is_some() && outputs.show.iter().any(|show| matches!(show, Show::Geodesics | Show::Triangles))
    }

    /// With triangles by the protection of a net, of which so much was asked for, if the picture shows that.
    pub(crate) fn with_net(mut self, outputs: &Outputs, net: Option<&Net>, asked: f64) -> Self {
        let net = net.filter(|_| outputs.show.contains(&Show::Protection));
        self.protection = net.map(|net| Protection::new(net, asked));
        self
    }

    /// With cells by the factor by which they miss a certificate's conditions, if the picture shows that.
    pub(crate) fn with_certificate(mut self, outputs: &Outputs, certificate: Option<&Certificate>) -> Self {
        let certificate = certificate.filter(|_| outputs.show.contains(&Show::Certificate));
        self.factors = certificate.map(|found| found.cells.iter().map(|cell| (cell.seed, cell.factor)).collect());
        self
    }

    /// With the edges that are not of unit length, if the picture shows them.
    pub(crate) fn with_unmet(mut self, outputs: &Outputs, unmet: Option<Unmet>) -> Self {
        self.unmet = unmet.filter(|_| outputs.show.contains(&Show::Unmet));
        self
    }

    /// As far as asked for, from a diagram whose seeds are the mesh's vertices, and the mesh with geodesic edges if that is
    /// there already.
    pub(crate) fn from_diagram(
        outputs: &Outputs,
        diagram: &Diagram,
        mesh: &Mesh,
        field: &dyn MetricField,
        realisation: Option<&Realisation>,
    ) -> Self {
        if !Self::is_wanted(outputs) {
            return Self::default();
        }
        let witnesses = outputs.show.contains(&Show::Witnesses).then(|| {
            let found = diagram.witnesses();
            [diagram.corners_of(&found.vertices), diagram.corners_of(&found.edges)]
        });
        let mut drawn = Self { cells: Some(diagram.to_cells()), witnesses, ..Self::default() };
        if Self::has_geodesics(outputs) {
            let own = realisation.is_none().then(|| Realisation::new(diagram, field, &mesh.triangles));
            if let Some(found) = realisation.or(own.as_ref()) {
                drawn.geodesics = found.edges.iter().map(|edge| edge.points.clone()).collect();
                if outputs.show.contains(&Show::Triangles) {
                    let grids = found.grids(field, PIECES);
                    drawn.grids = grids.iter().flatten().flat_map(Grid::lines).collect();
                }
            }
        }
        drawn
    }

    fn layers(&self) -> Layers<'_> {
        let witnesses = self.witnesses.as_ref().map(|[vertices, edges]| [vertices.as_slice(), edges.as_slice()]);
        Layers {
            cells: self.cells.as_ref(),
            witnesses,
            geodesics: &self.geodesics,
            protection: self.protection.as_ref(),
            values: None,
            grids: &self.grids,
            factors: self.factors.as_ref(),
            unmet: self.unmet.as_ref(),
        }
    }
}

/// What goes into the mesh file, and where that is.
pub(crate) enum MeshFile<'a> {
    /// None.
    None,
    /// The mesh itself.
    Straight(&'a Path),
    /// A dual with geodesic edges.
    Geodesic(&'a Path, &'a Realisation),
}

/// The distributions of lengths and angles, if they are to be drawn.
pub(crate) fn histograms(outputs: &Outputs, mesh: &Mesh, metric: &dyn MetricField) -> Result<Option<Histograms>> {
    outputs.histograms.is_some().then(|| quality::histograms(mesh, metric)).transpose()
}

/// Writes mesh, picture, histograms and report, as far as asked for. The picture is drawn before anything is written.
pub(crate) fn write(
    mesh_file: &MeshFile,
    outputs: &Outputs,
    mesh: &Mesh,
    metric: Option<&dyn MetricField>,
    report: &Report,
    drawn: &Drawn,
) -> Result<()> {
    let picture = outputs.picture.as_deref().map(|path| Ok((path, draw(outputs, mesh, metric, drawn)?))).transpose()?;
    match mesh_file {
        MeshFile::None => {}
        MeshFile::Straight(path) => voronaut_io::write_mesh(mesh, path)?,
        MeshFile::Geodesic(path, realisation) => voronaut_io::write_realisation(realisation, path)?,
    }
    picture.map(|(path, svg)| write_picture(&svg, path)).transpose()?;
    if let (Some(path), Some(found)) = (&outputs.histograms, &report.histograms) {
        voronaut_io::write(path, voronaut_draw::histograms_svg(found).as_bytes())?;
    }
    write_report(outputs, report)
}

/// Writes the report, if asked for.
pub(crate) fn write_report(outputs: &Outputs, report: &Report) -> Result<()> {
    outputs.report.as_deref().map_or(Ok(()), |path| voronaut_io::write(path, report.to_json().as_bytes()))
}

/// Uses so many threads from now on.
pub(crate) fn set_threads(run: &Run) -> Result<()> {
    let Some(threads) = run.threads else { return Ok(()) };
    let built = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build_global();
    let help = "ask for fewer threads";
    built.map_err(|error| Error::Limit { what: format!("{threads} threads: {error}"), help: help.into() })
}

fn draw(outputs: &Outputs, mesh: &Mesh, metric: Option<&dyn MetricField>, drawn: &Drawn) -> Result<String> {
    let shows = |what| outputs.show.contains(&what);
    let picture = Picture {
        mesh: shows(Show::Mesh) || shows(Show::Protection) || shows(Show::Unmet),
        ellipses: shows(Show::Ellipses),
        width: outputs.pixels,
        window: outputs.window,
        ..Picture::default()
    };
    voronaut_draw::svg_with(mesh, metric, &picture, &drawn.layers())
}

/// Refuses names that do not end like a drawing of histograms.
fn demand_histograms(path: &Path) -> Result<()> {
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("svg")) {
        return Ok(());
    }
    let what = format!("histograms in {}", path.display());
    Err(Error::Unsupported { what, help: "end the name of the histograms in .svg".into() })
}

/// Writes a picture in the format its name ends in, as a whole or not at all.
pub(crate) fn write_picture(svg: &str, path: &Path) -> Result<()> {
    voronaut_io::write(path, &voronaut_draw::picture_bytes(svg, path)?)
}
