//! Gmsh's format `.msh` (Geuzaine and Remacle 2009; chapter "File formats" of Gmsh's manual), as text and binary.

mod blocks;
mod data;
mod elements;
mod groups;
mod kinds;
mod reader;
mod sections;
mod tags;
mod writer;

use super::codec::{Form, Source};
use super::{Document, Fields};
use blocks::Blocks;
use reader::Reader;
use std::fmt;
use std::io::{self, BufRead, Write};
use std::str::FromStr;
use voronaut::mesh::Mesh;
use voronaut::{Error, Result};

/// A version of the format that is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// What older programs read.
    V2_2,
    /// Gmsh's own since version 4.1 of the program.
    V4_1,
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if *self == Self::V2_2 { "2.2" } else { "4.1" })
    }
}

impl FromStr for Version {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        match text {
            "2.2" => Ok(Self::V2_2),
            "4.1" => Ok(Self::V4_1),
            _ => Err(Error::parse("version of .msh", format!("'{text}' is not written"), "write 4.1 or 2.2")),
        }
    }
}

/// Reads a mesh and the values on it from a file of version 2 to 2.2, 4.0 or 4.1, text or binary of either byte order.
///
/// Vertices are the nodes in the order of the file, used or not, whatever their tags. Triangles and edges are the elements of types
/// 2 and 1; quadrangles are cut in two along their better diagonal. Tetrahedra, hexahedra, prisms and pyramids are left out with a
/// note; where there are neither triangles nor quadrangles the mesh is their boundary, with their labels, and where labels differ what
/// is between them. Elements of type 15 (points) are corners; but where
/// there is a physical group of points named `corners`, only those in it are.
///
/// A label is the tag of the physical group, or else of the entity (0 in version 2 where there is neither). Of several groups it is
/// the first that is listed: Gmsh lists them in `$Entities`, and in version 2 by repeating elements, which the mesh gets once.
/// Vertices without element of type 15 have label 0. The groups that [`write()`] names mean labels and marks again; other names of groups
/// are not kept.
///
/// `$NodeData` and `$ElementData` are fields: of 9 numbers a tensor, if it is symmetric (row by row in the file), else a vector.
/// On a planar mesh vectors and tensors whose z entries are all 0 are planar. Vertices that no triangle uses may lack a value:
/// they get 0. Fields with no value on any vertex or triangle, and values on other elements, are left out. Of a name that occurs again
/// (Gmsh's time steps) later fields are called `NAME_STEP`. All other sections are passed over. Memory follows the file, never a count
/// written in it.
///
/// # Errors
///
/// [`Error::Parse`] with the line, or in binary files the byte, of what is not as announced.
/// [`Error::Unsupported`] of other versions, of curved elements with their numbers, of
/// meshes in partitions. [`Error::Io`] of a file that cannot be read.
pub fn read(source: impl BufRead, place: &str) -> Result<Document> {
    Reader::default().read(Blocks::new(Source::verbatim(source, place))?)
}

/// Writes a mesh and fields as a file that [`read`] turns into the same vertices, to the last bit, and the same triangles and
/// edges, sorted by label.
///
/// Triangles come first, then edges, then the vertices with a label or a mark as elements of type 15, each with a physical group and an
/// entity per label and marks. The group's tag is the label. Gmsh has no tags below 1: such a label has the least tag that
/// is no label, and the group is named `triangle label -3`, `edge label 0` or `vertex label -1`. Marks are groups as well: `corners`,
/// `required vertices`, `ridges`, `required edges` and `required triangles`. In version 2.2, where Gmsh repeats elements for each
/// of their groups, those of edges and triangles are not written.
///
/// Fields are `$NodeData` and `$ElementData`; vectors of two numbers get a third, 0; tensors are written row by row with 9 numbers.
/// Other fields of several numbers are one field `NAME_0`, `NAME_1`, ... each. So that meshio reads fields of triangles, in
/// version 4.1 edges and points have values too: of a triangle at their first vertex, 0 where there is none. Of files of version 2.2
/// Gmsh leaves out vertices without element.
///
/// # Errors
/// What `out` says; more elements than version 2.2 or fields have tags for.
pub fn write(mesh: &Mesh, fields: &Fields, version: Version, form: Form, out: &mut dyn Write) -> io::Result<()> {
    writer::write(mesh, fields, version, form, out)
}

#[cfg(test)]
mod tests;
