//! Medit's sections of curved elements, and of the order in which these have their nodes.

use super::{Of, Reader, Sections, Writer};
use crate::codec::At;
use crate::curved::{Raised, places};
use std::io;
use voronaut::mesh::Mesh;
use voronaut::{Error, Result};

/// Sections of curved elements, those of their orders of nodes, their dimensions and orders.
const SECTIONS: [(&str, &str, u8, usize); 4] = [
    ("EdgesP2", "EdgesP2Ordering", 1, 2),
    ("EdgesP3", "EdgesP3Ordering", 1, 3),
    ("TrianglesP2", "TrianglesP2Ordering", 2, 2),
    ("TrianglesP3", "TrianglesP3Ordering", 2, 3),
];

/// Curved elements as they stand in the file, by the entries of [`SECTIONS`].
#[derive(Default)]
pub(super) struct Curves {
    /// Points of the elements, as many for each as the section says.
    points: [Vec<u32>; 4],
    labels: [Vec<i32>; 4],
    /// Where each of an element's points is among its nodes; nothing where the file does not say.
    orders: [Option<Vec<usize>>; 4],
}

impl Reader {
    /// Reads a section of curved elements, or of their order of nodes, or else refuses Bézier points.
    pub(super) fn read_curved(&mut self, name: &str, from: &mut Sections<'_>) -> Result<()> {
        for (i, (elements, ordering, dimension, order)) in SECTIONS.into_iter().enumerate() {
            if name == elements {
                for at in At::rows(name, from.count()?) {
                    for _ in 0..nodes(dimension, order).len() {
                        let point = self.reference(Of::Vertices, from, at)?;
                        self.curves.points[i].push(point);
                    }
                    self.curves.labels[i].push(from.whole(at)?);
                }
                return Ok(());
            }
            if name == ordering {
                self.curves.orders[i] = Some(read_order(name, dimension, order, from)?);
                return Ok(());
            }
        }
        if from.whole::<i64>(At::head(name))? == 0 {
            return Ok(());
        }
        let what = format!("curved elements by Bézier points ({name} in {})", from.source.place());
        Err(Error::unsupported(what, "write the nodes that elements pass through (Lagrange)"))
    }
}

/// The order of an element's points in the file: where each is among its nodes.
fn read_order(name: &str, dimension: u8, order: usize, from: &mut Sections<'_>) -> Result<Vec<usize>> {
    let (nodes, count) = (nodes(dimension, order), from.count()?);
    let mut places = Vec::new();
    for at in At::rows(name, count) {
        let mut place = [0; 3];
        for coordinate in &mut place[..coordinates(dimension)] {
            *coordinate = from.whole::<u8>(at)?;
        }
        let known = nodes.iter().position(|node| *node == place).filter(|node| !places.contains(node));
        let Some(node) = known else {
            let what = format!("a node that elements do not have, or have twice ({at})");
            let help = format!("give barycentric coordinates times {order}; of edges one number from 0 to {order}");
            return Err(from.source.error(what, help));
        };
        places.push(node);
    }
    if places.len() == nodes.len() {
        return Ok(places);
    }
    let what = format!("{name} has {count} rows, where elements have {} nodes", nodes.len());
    Err(from.source.error(what, "give a row for each node"))
}

impl Curves {
    /// How many elements of a dimension there are.
    pub(super) fn count(&self, dimension: u8) -> usize {
        let of = SECTIONS.iter().zip(&self.labels).filter(|((.., of, _), _)| *of == dimension);
        of.map(|(_, labels)| labels.len()).sum()
    }

    /// Appends the elements to a mesh.
    ///
    /// # Errors
    /// [`Error::Unsupported`] of edges of different orders.
    pub(super) fn take(self, mesh: &mut Mesh, file: &str) -> Result<Raised> {
        let mut raised = Raised::default();
        for (i, (points, labels)) in self.points.into_iter().zip(self.labels).enumerate() {
            let (name, _, dimension, order) = SECTIONS[i];
            if dimension == 1 && !(labels.is_empty() || mesh.edges.is_empty()) {
                let what = format!("{name} beside edges of another order in {file}");
                return Err(Error::unsupported(what, "give all edges the same order"));
            }
            let count = nodes(dimension, order).len();
            for element in points.chunks_exact(count) {
                let mut ordered = element.to_vec();
                for (point, &place) in element.iter().zip(self.orders[i].iter().flatten()) {
                    ordered[place] = *point;
                }
                if dimension == 1 {
                    mesh.edges.push([ordered[0], ordered[1]]);
                    raised.edge(mesh.edges.len() - 1, &ordered[2..]);
                } else {
                    mesh.triangles.push([ordered[0], ordered[1], ordered[2]]);
                    raised.triangle(&ordered[3..]);
                }
            }
            if dimension == 1 { mesh.edge_labels.extend(labels) } else { mesh.triangle_labels.extend(labels) }
        }
        Ok(raised)
    }
}

/// Writes in which order the elements have their nodes, so that readers with an order of their own see it.
pub(super) fn write_order(writer: &mut Writer<'_>, dimension: u8, order: usize) -> io::Result<()> {
    let Some((_, name, ..)) = SECTIONS.iter().find(|(.., of, known)| (*of, *known) == (dimension, order)) else {
        return Ok(());
    };
    let (nodes, width) = (nodes(dimension, order), coordinates(dimension));
    writer.section(name, nodes.len(), 4 * width, &[])?;
    nodes.iter().try_for_each(|node| writer.sink.row(node[..width].iter().map(|&x| i32::from(x))))
}

/// How many numbers say where a node is.
fn coordinates(dimension: u8) -> usize {
    if dimension == 1 { 1 } else { 3 }
}

/// Where the nodes of an element are: of an edge, how far from its first end.
fn nodes(dimension: u8, order: usize) -> Vec<[u8; 3]> {
    if dimension == 1 {
        let order = order as u8;
        return [0, order].into_iter().chain(1..order).map(|i| [i, 0, 0]).collect();
    }
    places(order).to_vec()
}
