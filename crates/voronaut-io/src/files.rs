//! Mesh files by the endings of their names.

use super::codec::Form;
use super::{Document, Fields, freefem, gmsh, medit, obj, off, ply, sol, stl, su2, vtk};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::mem;
use std::path::Path;
use voronaut::mesh::{Mesh, Solution, Solutions};
use voronaut::{Error, Result};

/// A format of meshes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Medit's `.mesh` and `.meshb`: everything a [`Mesh`] holds.
    Medit(Form),
    /// Gmsh's `.msh`, version 4.1 as text unless asked otherwise; read also that of `FreeFEM`: everything a [`Mesh`] holds, and fields.
    Gmsh(gmsh::Version, Form),
    /// Wavefront's `.obj`: positions, triangles grouped by region label, labelled edges without their labels.
    Obj,
    /// Geomview's `.off` as text: positions and triangles.
    Off,
    /// Stanford's `.ply`, text unless asked otherwise, coordinates as doubles: positions, triangles, their labels and fields.
    Ply(Form),
    /// Stereolithography `.stl`; written binary: triangles without shared vertices, coordinates rounded to single precision.
    Stl,
    /// SU2's `.su2`: positions and triangles; in the plane the labels of boundary edges, in space those of triangles.
    Su2,
    /// VTK's `.vtu`, an unstructured grid: everything a [`Mesh`] holds, and fields.
    Vtu,
    /// VTK's `.vtp`, polygons: everything a [`Mesh`] holds, and fields.
    Vtp,
}

/// Every format, and how names of its files end.
const ENDINGS: [(&str, Format); 10] = [
    ("mesh", Format::Medit(Form::Text)),
    ("meshb", Format::Medit(Form::Binary)),
    ("msh", Format::Gmsh(gmsh::Version::V4_1, Form::Text)),
    ("obj", Format::Obj),
    ("off", Format::Off),
    ("ply", Format::Ply(Form::Text)),
    ("stl", Format::Stl),
    ("su2", Format::Su2),
    ("vtu", Format::Vtu),
    ("vtp", Format::Vtp),
];

/// How names of mesh files end, for messages.
pub(crate) const MESH_ENDINGS: &str = ".mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl";

impl Format {
    /// The format a file name asks for by its ending, in upper or lower case; `None` of other endings.
    pub fn of_ending(path: &Path) -> Option<Self> {
        let ending = ending(path)?;
        ENDINGS.iter().find(|(known, _)| *known == ending).map(|&(_, format)| format)
    }

    /// The format a file name asks for by its ending, in upper or lower case.
    ///
    /// # Errors
    /// [`Error::Unsupported`], with the endings that work.
    pub fn from_path(path: &Path) -> Result<Self> {
        Self::of_ending(path).ok_or_else(|| {
            let what = format!("{} does not end like a mesh file", path.display());
            Error::unsupported(what, format!("end the name of the mesh file in {MESH_ENDINGS}"))
        })
    }

    /// Whether the format says which faces and edges belong to curves and regions, and may hold a planar domain.
    pub fn may_be_planar(self) -> bool {
        matches!(self, Format::Medit(_) | Format::Gmsh(..) | Format::Su2 | Format::Vtu | Format::Vtp)
    }

    /// Refuses triangles of an order that the format has no place for.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where the order is not 1, with the endings that work.
    pub fn demand_order(self, order: usize) -> Result<()> {
        if order == 1 || matches!(self, Format::Medit(_) | Format::Gmsh(..) | Format::Vtu) {
            return Ok(());
        }
        let name = ENDINGS.iter().find(|(_, format)| mem::discriminant(format) == mem::discriminant(&self));
        let what = format!("triangles of order {order} in a file .{}", name.map_or("", |(ending, _)| ending));
        Err(Error::unsupported(
            what,
            "write .msh, .vtu, .mesh or .meshb, which hold curves, or straight triangles: `order` 1",
        ))
    }

    /// Reads a document, which messages call by its place.
    ///
    /// # Errors
    /// [`Error::Parse`] of what is not as the format asks.
    pub fn read(self, mut source: impl BufRead, place: &str) -> Result<Document> {
        match self {
            Format::Medit(_) => medit::read(source, place),
            Format::Gmsh(..) if begins_with_number(&mut source, place)? => Ok(freefem::read(source, place)?.into()),
            Format::Gmsh(..) => gmsh::read(source, place),
            Format::Obj => obj::read(source, place),
            Format::Off => Ok(off::read(source, place)?.into()),
            Format::Ply(_) => ply::read(source, place),
            Format::Stl => Ok(stl::read(source, place)?.into()),
            Format::Su2 => su2::read(source, place),
            Format::Vtu | Format::Vtp => vtk::read(source, place),
        }
    }

    /// Writes a mesh and fields as far as the format can hold them.
    ///
    /// # Errors
    /// What `out` says; curved triangles that it has no place for.
    pub fn write(self, mesh: &Mesh, fields: &Fields, out: &mut dyn Write) -> io::Result<()> {
        self.demand_order(order(mesh)).map_err(io::Error::other)?;
        match self {
            Format::Medit(form) => medit::write(mesh, form, out),
            Format::Gmsh(version, form) => gmsh::write(mesh, fields, version, form, out),
            Format::Obj => obj::write(mesh, out),
            Format::Off => off::write(mesh, out),
            Format::Ply(form) => ply::write(mesh, fields, form, out),
            Format::Stl => stl::write(mesh, out),
            Format::Su2 => su2::write(mesh, out),
            Format::Vtu => vtk::write_vtu(mesh, fields, out),
            Format::Vtp => vtk::write_vtp(mesh, fields, out),
        }
    }
}

/// Reads a mesh file by the ending of its name. Only a buffer of the file is in memory beside the document.
///
/// # Errors
/// [`Error::Io`] of a file that cannot be read; [`Error::Parse`] of another ending, and of what is not as its format asks.
pub fn read(path: &Path) -> Result<Document> {
    let place = path.display().to_string();
    let Some(format) = Format::of_ending(path) else {
        let help = format!("give a mesh in a file {MESH_ENDINGS}");
        return Err(Error::parse(place, "the name does not end like that of a mesh that can be read", help));
    };
    format.read(open(path)?, &place)
}

/// The order of a mesh's triangles.
pub(crate) fn order(mesh: &Mesh) -> usize {
    mesh.curved.as_ref().map_or(1, |curved| curved.order)
}

/// How a name ends, in lower case.
pub fn ending(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// What is wrong with a text that should be a shape or the name of a file of a kind.
pub(super) fn neither(spec: &str, kinds: &str) -> Error {
    Error::parse(spec, "neither a shape nor a file with an ending that is known", format!("give {kinds}"))
}

/// Adds the file to the place of an error of what it holds.
pub fn in_file(file: &str, error: Error) -> Error {
    match error {
        Error::Domain { what, place, help } => Error::domain(what, format!("{file}, {place}"), help),
        Error::Unsupported { what, help } => Error::unsupported(format!("{what} in {file}"), help),
        other => other,
    }
}

/// Whether a file is `FreeFEM`'s where another of the same ending is Gmsh's.
fn begins_with_number(source: &mut impl BufRead, place: &str) -> Result<bool> {
    let start = source.fill_buf().map_err(|source| Error::io(place, source))?;
    Ok(start.trim_ascii_start().first().is_some_and(u8::is_ascii_digit))
}

/// Reads a `.sol` or `.solb` file with one value per vertex.
///
/// # Errors
/// As of [`open`] and [`sol::read`].
pub(crate) fn read_solution(path: &Path) -> Result<Solution> {
    sol::read(open(path)?, &path.display().to_string())
}

/// Reads a `.sol` or `.solb` file with any number of values per vertex and triangle.
///
/// # Errors
/// As of [`open`] and [`sol::read_all`].
pub fn read_solutions(path: &Path) -> Result<Solutions> {
    sol::read_all(open(path)?, &path.display().to_string())
}

/// Reads a text file as a whole.
///
/// # Errors
/// As of [`open`]; [`Error::Parse`] where it is blank, or no text.
pub fn read_text(path: &Path) -> Result<String> {
    let place = || path.display().to_string();
    let mut bytes = Vec::new();
    open(path)?.read_to_end(&mut bytes).map_err(|source| Error::io(path, source))?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let what = format!("not a text in UTF-8 (byte {})", error.utf8_error().valid_up_to() + 1);
        Error::parse(place(), what, "save the file as UTF-8 text; this format has no binary form that is read")
    })?;
    if text.trim().is_empty() {
        return Err(Error::parse(place(), "the file is empty", "check that the program that wrote it had finished"));
    }
    Ok(text)
}

/// Opens a file to be read through a buffer.
///
/// # Errors
/// [`Error::Io`] where it cannot be read; [`Error::Parse`] where it is empty.
pub fn open(path: &Path) -> Result<BufReader<File>> {
    const BUFFER: usize = 1 << 17;
    let fault = |source| Error::io(path, source);
    let file = File::open(path).map_err(fault)?;
    let found = file.metadata().map_err(fault)?;
    if found.is_dir() {
        return Err(fault(io::ErrorKind::IsADirectory.into()));
    }
    if found.is_file() && found.len() == 0 {
        let help = "check that the program that wrote it had finished";
        return Err(Error::parse(path.display().to_string(), "the file is empty", help));
    }
    Ok(BufReader::with_capacity(BUFFER, file))
}
