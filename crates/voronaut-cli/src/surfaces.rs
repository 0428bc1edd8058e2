//! `voronaut mesh` and `voronaut dual` on a surface.

use crate::args::{CanvasSize, DualArgs, EdgesOut, MeshArgs, Outputs, Show};
use crate::files;
use crate::metric::{self, Scaled};
use crate::progress::Bar;
use crate::seeds::SeedFile;
use crate::summary;
use std::path::Path;
use std::time::Instant;
use voronaut::canvas::{self, Canvas};
use voronaut::diagram::{Kind, SurfaceDiagram};
use voronaut::geodesic::Method;
use voronaut::geometry::Point3;
use voronaut::mesh::Mesh;
use voronaut::output::{self, Report, Scene, Shade, Stroke, View, report};
use voronaut::quality::{Meetings, surface_quality, surface_unmet, validity_on};
use voronaut::recipe::{self, SeedDual};
use voronaut::sampling;
use voronaut::surface::metric::SurfaceMetric;
use voronaut::surface::{Input, Mended, Place};
use voronaut::triangulation::VertexId;
use voronaut::{Error, Result};

/// Meshes a surface. Nothing is written unless the mesh is valid.
pub(crate) fn mesh(args: &MeshArgs, input: Input, mended: &Mended, start: Instant) -> Result<()> {
    demand_supported(&args.outputs)?;
    let whole = args.outputs.picture.is_some().then(|| Input::new(input.surface.clone(), input.implicit.clone()));
    let input = &input.cut(&args.features())?;
    let metric = metric::on_surface(&args.metric, input, &args.metric_choices)?;
    let meshed = {
        let bar = Bar::new(args.run.quiet, args.run.verbose);
        recipe::mesh_surface(input, metric.as_ref(), &args.options(), &bar)?
    };
    let found = validity_on(&meshed.mesh, &Meetings::of(input.whole_mesh()));
    found.demand().map_err(crate::mesh::ours)?;
    let meets = found.meetings.note();
    let scaled = Scaled { field: metric.as_ref(), factor: meshed.metric_scale };
    let figures = surface_quality(&meshed.mesh, &input.surface, &scaled)?;
    let mut report = Report::new(found, meshed.mesh.points.len(), meshed.mesh.triangles.len()).with_quality(&figures);
    crate::mesh::fill_in(&mut report, &meshed, crate::mesh::options(args));
    report.curvature = metric.curvature_figures();
    report.unmet = Some(surface_unmet(&meshed.mesh, &input.surface, &scaled)?.figures());
    report.notes.extend(mended.sentences().chain(meets));
    report.fidelity = meshed.fidelity.map(|found| report::Strayed::Surface(found.into()));
    report.seconds = report::Seconds { stages: meshed.seconds.clone(), total: start.elapsed().as_secs_f64() };
    // Cells are drawn across creases.
    let picture = args.outputs.picture.as_deref().zip(whole.as_ref()).map(|(path, whole)| {
        let metric = metric::on_surface(&args.metric, whole, &args.metric_choices)?;
        let places = places(whole, &meshed.mesh)?;
        let size = canvas::size_for(places.len(), args.canvas_size);
        let (canvas, at) = Canvas::on_surface(args.canvas, whole, metric.as_ref(), size, &places)?;
        let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::March)?;
        Ok::<_, Error>((path, drawn(&args.outputs, &diagram, &meshed.mesh)?))
    });
    write(picture.transpose()?, &args.outputs, &meshed.mesh, &args.out, &report)?;
    summary::print(&args.out.display().to_string(), &report, &args.run);
    Ok(())
}

/// The dual of seeds on a surface.
pub(crate) fn dual(args: &DualArgs, input: &Input, mended: &Mended, start: Instant) -> Result<()> {
    demand_supported(&args.outputs)?;
    demand_dual(args)?;
    let metric = metric::on_surface(&args.metric, input, &args.metric_choices)?;
    let (file, seeds) = SeedFile::read_in_space(&args.seeds)?;
    let places = file.on_surface(input, &seeds)?;
    let mut stages = vec![("read", start.elapsed().as_secs_f64())];
    let mut begin = Instant::now();
    let mut stage = |stages: &mut Vec<_>, name: &'static str| {
        stages.push((name, begin.elapsed().as_secs_f64()));
        begin = Instant::now();
    };
    let CanvasSize::PerSeed(per_seed) = args.canvas_size else { return Err(unsupported("--canvas-size certified")) };
    let size = canvas::size_for(places.len(), per_seed);
    sampling::demand_memory(places.len() as f64, size as f64, args.memory_limit())?;
    let (canvas, at) = Canvas::on_surface(args.canvas, input, metric.as_ref(), size, &places)?;
    stage(&mut stages, "canvas");
    let diagram = SurfaceDiagram::on_surface(&canvas, &at, args.geodesic)?;
    stage(&mut stages, "diagram");
    let SeedDual { triangles, account, seconds, raw_nerve, .. } = recipe::surface_dual(&diagram, args.dual);
    let mesh = recipe::surface_mesh(input, &places, triangles);
    stage(&mut stages, "dual");
    stages.extend(seconds);
    let found = validity_on(&mesh, &Meetings::of(input.whole_mesh()));
    let meets = found.meetings.note();
    let is_valid = found.valid;
    let mut report = Report::new(found, mesh.points.len(), mesh.triangles.len());
    if is_valid {
        report = report.with_quality(&surface_quality(&mesh, &input.surface, metric.as_ref())?);
    }
    report.dual = Some(account);
    report.canvas = Some(canvas.figures());
    report.diagram = Some(report::Diagram { raw_nerve: Some(raw_nerve), ..report::Diagram::of(&diagram) });
    report.notes.extend(mended.sentences().chain(meets));
    if !is_valid {
        report.notes.push("straight triangles of the dual do not make a valid mesh of these seeds".into());
    }
    report.options = crate::dual::options(args);
    report.seconds = report::Seconds { stages, total: start.elapsed().as_secs_f64() };
    if args.strict {
        report.validity.demand().or_else(|fault| files::write_report(&args.outputs, &report).and(Err(fault)))?;
    }
    let picture = args.outputs.picture.as_deref().map(|path| Ok((path, drawn(&args.outputs, &diagram, &mesh)?)));
    let picture = picture.transpose()?;
    let written = if args.edges == EdgesOut::Geodesic { with_geodesics(&diagram, &mesh) } else { mesh };
    write(picture, &args.outputs, &written, &args.out, &report)?;
    if let Some(path) = &args.diagram {
        let (canvas, distances) = diagram.to_coloured_surface();
        output::write_diagram(&canvas, &distances, path)?;
    }
    summary::print(&args.out.display().to_string(), &report, &args.run);
    Ok(())
}

fn write(picture: Option<(&Path, String)>, outputs: &Outputs, mesh: &Mesh, out: &Path, report: &Report) -> Result<()> {
    output::write_mesh(mesh, out)?;
    picture.map(|(path, svg)| output::write_picture(&svg, path)).transpose()?;
    files::write_report(outputs, report)
}

/// The vertices of a mesh on the surface.
fn places(input: &Input, mesh: &Mesh) -> Result<Vec<Place>> {
    mesh.points.iter().map(|&p| input.closest(p.into())).collect()
}

/// A mesh, the cells of its vertices, its edges as geodesics.
fn drawn(outputs: &Outputs, diagram: &SurfaceDiagram, mesh: &Mesh) -> Result<String> {
    let shows = |what| outputs.show.contains(&what);
    let draped = diagram.canvas().draped();
    let is_of_canvas = shows(Show::Cells) || shows(Show::Geodesics);
    let mut scene =
        if is_of_canvas { coloured(diagram, shows(Show::Cells)) } else { Scene::of_mesh(mesh, Shade::Size) };
    let edges = edges(mesh);
    if shows(Show::Geodesics) {
        scene = scene.with(edges.iter().filter_map(|&ends| geodesic(diagram, ends)), Stroke::Geodesic);
    } else if shows(Show::Mesh) && is_of_canvas {
        scene = scene.with(edges.iter().map(|ends| ends.map(|v| mesh.position(v)).to_vec()), Stroke::Edge);
    }
    let view = View { pixels: outputs.pixels, ..View::of(draped.input().surface.bounds()) };
    output::draw_surface(&scene, &view)
}

fn coloured(diagram: &SurfaceDiagram, are_cells: bool) -> Scene {
    let draped = diagram.canvas().draped();
    let vertices = || (0..diagram.vertex_count() as u32).map(VertexId);
    let positions: Vec<Point3> = vertices().map(|v| draped.position(v)).collect();
    let topology = draped.topology();
    let triangles: Vec<[u32; 3]> = topology.faces().map(|f| topology.corners(f).map(|v| v.0)).collect();
    let colours: Vec<Option<u32>> = vertices().map(|v| diagram.colour(v).filter(|_| are_cells)).collect();
    Scene::of_canvas(&positions, &triangles, &colours)
}

/// The edges of a mesh, in order, the smaller vertex first.
fn edges(mesh: &Mesh) -> Vec<[u32; 2]> {
    let sides = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut edges: Vec<[u32; 2]> = sides.map(|[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The points of the geodesic between two seeds.
fn geodesic(diagram: &SurfaceDiagram, ends: [u32; 2]) -> Option<Vec<Point3>> {
    let [from, to] = ends.map(|colour| diagram.seed(colour));
    diagram.canvas().draped().geodesic(from?, to?).map(|way| way.points)
}

/// A mesh with the points of its geodesic edges behind the seeds, and their segments as edges, labelled with the number of the
/// edge from 1.
fn with_geodesics(diagram: &SurfaceDiagram, mesh: &Mesh) -> Mesh {
    let mut all = Mesh { edges: Vec::new(), edge_labels: Vec::new(), ..mesh.clone() };
    for (label, ends) in (1..).zip(edges(mesh)) {
        let Some(points) = geodesic(diagram, ends) else { continue };
        let mut before = ends[0];
        for p in &points[1..points.len() - 1] {
            all.points.push(p.to_array());
            all.point_labels.push(0);
            let here = all.points.len() as u32 - 1;
            all.edges.push([before, here]);
            before = here;
        }
        all.edges.push([before, ends[1]]);
        all.edge_labels.resize(all.edges.len(), label);
    }
    all
}

/// Refuses what is not there for surfaces.
fn demand_supported(outputs: &Outputs) -> Result<()> {
    let is_shown = |show: &Show| matches!(show, Show::Mesh | Show::Cells | Show::Geodesics);
    let refused = [
        (outputs.histograms.is_some(), "--histograms"),
        (outputs.window.is_some(), "--window"),
        (!outputs.show.iter().all(is_shown), "--show of anything but mesh, cells and geodesics"),
    ];
    refused.into_iter().find(|refused| refused.0).map_or(Ok(()), |(_, what)| Err(unsupported(what)))
}

fn demand_dual(args: &DualArgs) -> Result<()> {
    let refused = [
        (args.voronoi != Kind::Riemannian, "--voronoi"),
        (args.certify, "--certify"),
        (matches!(args.canvas_size, CanvasSize::Certified), "--canvas-size certified"),
    ];
    refused.into_iter().find(|refused| refused.0).map_or(Ok(()), |(_, what)| Err(unsupported(what)))
}

fn unsupported(what: &str) -> Error {
    Error::Unsupported { what: format!("{what} on a surface"), help: format!("leave out {what}") }
}
