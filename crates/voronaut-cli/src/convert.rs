//! `voronaut convert`: from one format to another.

use crate::aside::say_aside;
use crate::options::{Limits, Run};
use crate::summary;
use crate::{curves, files};
use clap::Args;
use std::path::{Path, PathBuf};
use voronaut::manifold::domain::{Pslg, from_mesh, to_mesh, to_poly, to_polygons};
use voronaut::mesh::Mesh;
use voronaut::{Error, Result};
use voronaut_io::gmsh::Version;
use voronaut_io::medit::Form;
use voronaut_io::{Document, Fields, Format, ending, geojson, lost_in_outline, poly, read_pslg};

pub(crate) const EXAMPLES: &str = "\
IN   a mesh: .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply, .stl; a planar domain: .poly, .geojson, rect:..., disk:...; or values:
     .sol, .solb
OUT  of the same kinds; a mesh becomes a .poly or .geojson if it is planar, and a domain a mesh of nothing but its own points

Labels, labelled edges, corners and what is required go along as far as OUT has a place for them; what is left out is said. Values of a
.sol go along with --sol; of a .vtu, .msh or .ply they do anyway. Beside a .mesh they are written to OUT's name ending in .sol, which
`remesh` takes for sizes; a file of that name is replaced.

Examples:
  voronaut convert wing.msh wing.meshb
  voronaut convert curved.msh corners.stl --order 1
  voronaut convert adapted.mesh adapted.vtu --sol adapted.sol
  voronaut convert sea.geojson sea.poly
  voronaut convert metric.sol metric.solb";

#[derive(Debug, Args)]
pub(crate) struct ConvertArgs {
    /// What to read
    #[arg(value_name = "IN")]
    from: PathBuf,
    /// What to write
    #[arg(value_name = "OUT")]
    to: PathBuf,
    /// Values at the vertices or triangles of IN that go along
    #[arg(long, value_name = "FILE")]
    sol: Option<PathBuf>,
    /// Version of a .msh: 4.1 or 2.2
    #[arg(long, value_name = "VERSION", default_value_t = Version::V4_1)]
    msh_version: Version,
    /// Leave out the curves of triangles of order 2 or 3: 1, which keeps the vertices and straight triangles between them
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=1))]
    order: Option<u8>,
    /// Write a .msh or .ply as a binary file
    #[arg(long)]
    binary: bool,
    /// Say nothing but errors
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    limits: Limits,
}

impl ConvertArgs {
    /// Limits, and how much is said.
    pub(crate) fn run(&self) -> Run {
        Run { report: None, threads: None, limits: self.limits, quiet: self.quiet, verbose: false }
    }
}

/// Converts a file.
pub(crate) fn run(args: &ConvertArgs) -> Result<()> {
    voronaut_io::demand_directory(&args.to)?;
    let from = if is_shape(&args.from) { Kind::Outline } else { Kind::of(&args.from) };
    let told = match (from, Kind::of(&args.to)) {
        (Kind::Values, Kind::Values) => {
            let values = voronaut_io::read_solutions(&args.from)?;
            voronaut_io::write_solutions(&values, &args.to)?;
            format!("{} solutions at vertices, {} at triangles", values.vertices.len(), values.triangles.len())
        }
        (Kind::Values, _) | (_, Kind::Values) => {
            let what = format!("{} and {}: values and a mesh", args.from.display(), args.to.display());
            let help =
                "convert values to .sol or .solb, or a mesh with its values: convert IN.mesh OUT.vtu --sol IN.sol";
            return Err(Error::unsupported(what, help));
        }
        (from, Kind::Outline) => outline(args, from)?,
        (from, Kind::Mesh) => mesh(args, from)?,
    };
    if !args.quiet {
        say_aside(&format!("{}: {told}", args.to.display()));
    }
    Ok(())
}

/// The mesh to convert, straight if that is asked for.
fn document(args: &ConvertArgs) -> Result<Document> {
    let mut document = voronaut_io::read(&args.from)?;
    if args.order == Some(1) {
        document.mesh.curved = None;
    }
    Ok(document)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Mesh,
    Outline,
    Values,
}

impl Kind {
    /// That of a file by its ending.
    fn of(path: &Path) -> Self {
        match ending(path).as_deref() {
            Some("sol" | "solb") => Self::Values,
            Some("poly" | "geojson" | "json") => Self::Outline,
            _ => Self::Mesh,
        }
    }
}

/// Whether a name is none of a file, but a shape such as `disk:0,0,1`.
fn is_shape(path: &Path) -> bool {
    path.to_string_lossy().contains(':') && Format::of_ending(path).is_none()
}

fn outline(args: &ConvertArgs, from: Kind) -> Result<String> {
    if let Some(sol) = &args.sol {
        let what = format!("values ({}) in {}", sol.display(), args.to.display());
        return Err(Error::unsupported(what, "leave out --sol: outlines hold none"));
    }
    let (pslg, document) = if from == Kind::Mesh {
        let document = document(args)?;
        (from_mesh(&document.mesh)?, document)
    } else {
        let pslg = read_pslg(&name(&args.from))?;
        let document = Mesh { point_labels: pslg.point_labels.clone(), ..Mesh::default() }.into();
        (pslg, document)
    };
    summary::notes(&document.notes, args.quiet);
    let is_poly = ending(&args.to).as_deref() == Some("poly");
    let told = if is_poly { write_poly(&args.to, &pslg)? } else { write_geojson(&args.to, &pslg)? };
    Ok(with_lost(vec![told], &lost_in_outline(is_poly, &document.mesh, &document.fields)))
}

fn write_poly(path: &Path, pslg: &Pslg) -> Result<String> {
    let found = to_poly(pslg)?;
    voronaut_io::write_with(path, |out| poly::write(&found, out))?;
    let [points, segments] = [found.points.len(), found.segments.len()];
    let [holes, regions] = [found.holes.len(), found.regions.len()];
    Ok(format!("{points} points, {segments} segments, {holes} holes, {regions} regions"))
}

fn write_geojson(path: &Path, pslg: &Pslg) -> Result<String> {
    let found = to_polygons(pslg)?;
    voronaut_io::write_with(path, |out| geojson::write(&found, out))?;
    let rings: usize = found.polygons.iter().map(|polygon| polygon.rings.len()).sum();
    Ok(format!("{} polygons, {rings} rings; a ring has one label, that of most of its boundary", found.polygons.len()))
}

/// What was written, and what was not.
fn with_lost(mut told: Vec<String>, lost: &[String]) -> String {
    if !lost.is_empty() {
        told.push(format!("left out, for the format has no place for them: {}", lost.join(", ")));
    }
    told.join("; ")
}

fn mesh(args: &ConvertArgs, from: Kind) -> Result<String> {
    let form = if args.binary { Form::Binary } else { Form::Text };
    let format = match Format::from_path(&args.to)? {
        Format::Gmsh(..) => Format::Gmsh(args.msh_version, form),
        Format::Ply(_) => Format::Ply(form),
        other => other,
    };
    let Document { mesh, mut fields, notes } = match from {
        Kind::Mesh => document(args)?,
        _ => to_mesh(&read_pslg(&name(&args.from))?)?.into(),
    };
    format.demand_order(curves::order_of(&mesh))?;
    if let Some(sol) = &args.sol {
        let values = voronaut_io::read_solutions(sol)?;
        fields.extend(files::values_of(&mesh, values, sol)?);
    }
    let lost = format.lost(&mesh, &fields);
    let mut told = vec![format!(
        "{} vertices, {} triangles, {} labelled edges",
        mesh.points.len(),
        mesh.triangles.len(),
        mesh.edges.len()
    )];
    if let Some(curved) = &mesh.curved {
        told.push(format!("of order {}, with {} nodes beside the vertices", curved.order, curved.nodes.len()));
    }
    let beside = beside(&args.to, format, &fields);
    if beside.is_some() && mesh.curved.is_some() {
        let what = "values beside a curved .mesh, which has nodes that are no vertices";
        return Err(Error::unsupported(what, "write a .vtu or .msh"));
    }
    let solutions = beside.as_ref().map(|_| fields.clone().into_solutions(&mesh)).transpose()?;
    voronaut_io::write_with(&args.to, |out| format.write(&mesh, &fields, out))?;
    if let (Some(beside), Some(solutions)) = (beside, solutions) {
        voronaut_io::write_solutions(&solutions, &beside)?;
        let names = fields.vertices.iter().chain(&fields.triangles).map(|field| field.name.as_str());
        told.push(format!("{} in {}", names.collect::<Vec<_>>().join(", "), beside.display()));
    }
    summary::notes(&notes, args.quiet);
    Ok(with_lost(told, &lost))
}

/// The file that fields go to where the mesh's format has no place for them but has files of values.
fn beside(mesh: &Path, format: Format, fields: &Fields) -> Option<PathBuf> {
    let Format::Medit(form) = format else { return None };
    let is_empty = fields.vertices.is_empty() && fields.triangles.is_empty();
    let ending = if form == Form::Binary { "solb" } else { "sol" };
    (!is_empty).then(|| mesh.with_extension(ending))
}

fn name(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}
