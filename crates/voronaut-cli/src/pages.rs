//! Pages to look at meshes with: what they show of a mesh in a metric, in the plane and on surfaces.

use crate::options::Paged;
use crate::world::World;
use std::path::Path;
use voronaut::Result;
use voronaut::canvas::{self, Canvas};
use voronaut::diagram::{Diagram, Ground, Kind, SurfaceDiagram};
use voronaut::geodesic::Method;
use voronaut::geometry::{Point, Point3};
use voronaut::manifold::domain::Domain;
use voronaut::manifold::surface::metric::SurfaceMetric;
use voronaut::manifold::{Manifold, Riemannian};
use voronaut::mesh::{Mesh, SolutionValues};
use voronaut::metric::MetricField;
use voronaut::quality::unmet;
use voronaut::realisation::Realisation;
use voronaut_draw::Sheet;
use voronaut_io::{Field, Fields};

/// A canvas for cells that are drawn.
#[derive(Clone, Copy)]
pub(crate) struct Drawn {
    pub(crate) kind: canvas::Kind,
    /// Vertices per seed.
    pub(crate) size: u32,
}

/// The page's name for a mesh: that of its file without its ending.
pub(crate) fn name(path: &Path) -> String {
    path.file_stem().map_or_else(|| "mesh".into(), |stem| stem.to_string_lossy().into_owned())
}

/// A mesh with the values that its file has; a first tensor at the vertices is taken for its metric.
pub(crate) fn plain(name: String, mesh: Mesh, fields: Fields) -> Sheet {
    let mut sheet = Sheet { name, mesh, ..Sheet::default() };
    let tensors = fields.vertices.iter().find_map(|field| match &field.values {
        SolutionValues::Tensor(all) => Some(all.iter().map(|&[xx, xy, yy]| [xx, xy, yy, 0.0, 0.0, 0.0]).collect()),
        SolutionValues::Tensor3(all) => Some(all.clone()),
        _ => None,
    });
    sheet.tensors = tensors.unwrap_or_default();
    sheet.vertices = fields.vertices.into_iter().flat_map(numbers).collect();
    sheet.triangles = fields.triangles.into_iter().flat_map(numbers).collect();
    sheet
}

/// The numbers of a field one by one, with the length of a vector before its components.
fn numbers(Field { name, values }: Field) -> Vec<(String, Vec<f64>)> {
    let (count, components) = (values.count(), values.components());
    let column = |k: usize| (0..count).map(|i| values.row(i)[k]).collect::<Vec<_>>();
    let entries: Vec<String> = match &values {
        SolutionValues::Scalar(_) => return vec![(name, column(0))],
        SolutionValues::Vector { .. } => (1..=components).map(|k| k.to_string()).collect(),
        SolutionValues::Tensor(_) => ["11", "12", "22"].map(String::from).into(),
        SolutionValues::Tensor3(_) => ["11", "12", "22", "13", "23", "33"].map(String::from).into(),
    };
    let mut all: Vec<_> = (0..components).map(|k| (format!("{name} {}", entries[k]), column(k))).collect();
    if matches!(values, SolutionValues::Vector { .. }) {
        let length = |i: usize| values.row(i).iter().map(|x| x * x).sum::<f64>().sqrt();
        all.insert(0, (format!("|{name}|"), (0..count).map(length).collect()));
    }
    all
}

/// Adds a metric, and what a mesh is in it, if it is one; far from a surface there is none. Shapes of triangles are added, and edges that are not of unit
/// length.
pub(crate) fn measured(sheet: &mut Sheet, on: Riemannian, is_valid: bool) -> Result<()> {
    let tensor = |&[x, y, z]: &[f64; 3]| match on {
        Riemannian::Plane(metric) => {
            let m = metric.at(Point::new(x, y));
            [m.xx, m.xy, m.yy, 0.0, 0.0, 0.0]
        }
        Riemannian::Surface(manifold, metric) => {
            manifold.closest(Point3::new(x, y, z)).map_or([f64::NAN; 6], |place| metric.at(&place).to_disk())
        }
    };
    sheet.tensors = sheet.mesh.points.iter().map(tensor).collect();
    if is_valid {
        let (mut qualities, mut angles) = (Vec::new(), Vec::new());
        sheet.unmet = Some(unmet(&sheet.mesh, on, |[quality, angle]| {
            qualities.push(quality);
            angles.push(angle);
        })?);
        sheet.triangles.extend([("quality".into(), qualities), ("smallest angle".into(), angles)]);
    }
    Ok(())
}

/// Adds the cells of a planar mesh's vertices, distances, and its edges as geodesics.
pub(crate) fn with_cells(sheet: &mut Sheet, domain: &Domain, metric: &dyn MetricField, drawn: Drawn) -> Result<()> {
    let seeds: Vec<Point> = sheet.mesh.points.iter().map(|p| Point::new(p[0], p[1])).collect();
    let canvas = Canvas::new(drawn.kind, domain.planar(), metric, (drawn.size as usize).saturating_mul(seeds.len()))?;
    let diagram = Diagram::new(&canvas, metric, &seeds)?;
    let curved = Realisation::new(&diagram, &sheet.mesh.triangles);
    show_diagram(sheet, &diagram, &curved);
    Ok(())
}

/// Adds a diagram and geodesic edges.
pub(crate) fn show_diagram<'a, G: Ground<'a>, P: Copy + Into<[f64; 3]>>(
    sheet: &mut Sheet,
    diagram: &Diagram<'a, G>,
    curved: &Realisation<P>,
) {
    let in_space = |&p: &P| Point3::from(p.into());
    sheet.canvas = Some(diagram.to_coloured_canvas());
    sheet.curves = curved.edges.iter().map(|edge| edge.points.iter().map(in_space).collect()).collect();
}

/// Adds the cells of the vertices of the mesh of a surface that is whole, distances, and its edges as geodesics.
pub(crate) fn with_cells_on(
    sheet: &mut Sheet,
    whole: &Manifold,
    metric: &dyn SurfaceMetric,
    drawn: Drawn,
) -> Result<()> {
    let places = sheet.mesh.points.iter().map(|&p| whole.closest(p.into())).collect::<Result<Vec<_>>>()?;
    let size = canvas::size_for(places.len(), drawn.size);
    let (canvas, at) = Canvas::on_surface(drawn.kind, whole, metric, size, &places)?;
    let diagram = SurfaceDiagram::of_kind_on_surface(Kind::Riemannian, &canvas, &at, Method::March)?;
    let curved = voronaut::recipe::Measured::realisation(&diagram, &sheet.mesh.triangles);
    show_diagram(sheet, &diagram, &curved);
    Ok(())
}

/// What the page shows of a mesh that is made for a file, if there is to be a page.
pub(crate) fn of(
    paged: &Paged,
    out: &Path,
    mesh: &Mesh,
    measure: impl FnOnce(&mut Sheet) -> Result<()>,
) -> Result<Option<Sheet>> {
    if paged.view.is_none() {
        return Ok(None);
    }
    let mut sheet = plain(name(out), mesh.clone(), Fields::default());
    measure(&mut sheet)?;
    Ok(Some(sheet))
}

/// Writes the page of a run that made one mesh, if it is asked for.
pub(crate) fn write(paged: &Paged, world: &World, sheet: Option<Sheet>) -> Result<()> {
    let Some((path, sheet)) = paged.view.as_deref().zip(sheet) else { return Ok(()) };
    world.go_on()?;
    world.write_page_beside(voronaut_draw::page(&sheet.name.clone(), &[sheet])?, path)
}
