//! Gmsh's format `.msh` (Geuzaine and Remacle 2009; chapter "File formats" of Gmsh's manual), as text and binary.

mod blocks;
mod data;
mod elements;
mod groups;
mod periodic;
mod reader;
mod tags;
mod writer;

pub use writer::write;

use super::Document;
use super::codec::Source;
use blocks::Blocks;
use reader::Reader;
use std::fmt;
use std::io::BufRead;
use std::str::FromStr;
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
/// 2 and 1; or of types 9 and 8, or 21 and 26, of order 2 and 3, of which the inner nodes are no vertices, and values there left out; quadrangles are cut in two along their better diagonal. Tetrahedra, hexahedra, prisms and pyramids are left out with a
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
/// [`Error::Unsupported`] of other versions, of other curved elements with their numbers, of triangles of different orders, of
/// meshes in partitions. [`Error::Io`] of a file that cannot be read.
pub fn read(source: impl BufRead, place: &str) -> Result<Document> {
    Reader::default().read(Blocks::new(Source::verbatim(source, place))?)
}

#[cfg(test)]
mod tests;
