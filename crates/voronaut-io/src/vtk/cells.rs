//! Cells of VTK as triangles and edges.

use crate::curved::Raised;
use crate::cutting::cut;
use crate::volumes::Volumes;
use std::collections::BTreeMap;
use voronaut::{Error, Result};

/// The types of cells that this reader and writer know, by VTK's numbers; 1 and 2 are vertices.
pub(super) mod types {
    pub(in crate::vtk) const EMPTY: u8 = 0;
    pub(crate) const LINE: u8 = 3;
    pub(crate) const POLY_LINE: u8 = 4;
    pub(in crate::vtk) const TRIANGLE: u8 = 5;
    pub(in crate::vtk) const TRIANGLE_STRIP: u8 = 6;
    pub(in crate::vtk) const POLYGON: u8 = 7;
    pub(in crate::vtk) const PIXEL: u8 = 8;
    pub(in crate::vtk) const QUAD: u8 = 9;
    pub(in crate::vtk) const TETRAHEDRON: u8 = 10;
    pub(in crate::vtk) const VOXEL: u8 = 11;
    pub(in crate::vtk) const HEXAHEDRON: u8 = 12;
    pub(in crate::vtk) const WEDGE: u8 = 13;
    pub(in crate::vtk) const PYRAMID: u8 = 14;
    pub(in crate::vtk) const QUADRATIC_EDGE: u8 = 21;
    pub(in crate::vtk) const QUADRATIC_TRIANGLE: u8 = 22;
    pub(in crate::vtk) const LAGRANGE_CURVE: u8 = 68;
    pub(in crate::vtk) const LAGRANGE_TRIANGLE: u8 = 69;
    /// Types that are read beside those up to pyramids.
    pub(in crate::vtk) const CURVED: [u8; 4] = [QUADRATIC_EDGE, QUADRATIC_TRIANGLE, LAGRANGE_CURVE, LAGRANGE_TRIANGLE];
    /// Edges and triangles by their order, from 1.
    pub(in crate::vtk) const EDGES: [u8; 3] = [LINE, QUADRATIC_EDGE, LAGRANGE_CURVE];
    pub(in crate::vtk) const TRIANGLES: [u8; 3] = [TRIANGLE, QUADRATIC_TRIANGLE, LAGRANGE_TRIANGLE];
}

/// What cells of other types are called; those not listed are of higher order.
const FOREIGN: [(u8, &str); 3] = [(15, "pentagonal prisms"), (16, "hexagonal prisms"), (42, "polyhedra")];

/// Triangles and edges, and the cells they are from.
#[derive(Default)]
pub(super) struct Shapes {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) edges: Vec<[u32; 2]>,
    /// The cell of each triangle.
    pub(super) of_triangles: Vec<u32>,
    /// The cell of each edge.
    pub(super) of_edges: Vec<u32>,
    pub(super) volumes: Volumes,
    pub(super) raised: Raised,
}

impl Shapes {
    /// Appends a cell of a type that [`refuse_foreign`] lets pass. Polygons are cut along diagonals that suit them; `points` are
    /// what its vertices number.
    ///
    /// # Errors
    /// How many vertices such a cell has, where it is a wrong number.
    pub(super) fn push(
        &mut self,
        cell: u32,
        kind: u8,
        vertices: &[u32],
        points: &[[f64; 3]],
    ) -> std::result::Result<(), &'static str> {
        let (least, most, right) = right(kind);
        if !(least..=most).contains(&vertices.len()) {
            return Err(right);
        }
        match (kind, vertices) {
            (types::QUADRATIC_EDGE | types::LAGRANGE_CURVE, &[a, b, ref nodes @ ..]) => {
                self.edges.push([a, b]);
                if !nodes.is_empty() {
                    self.raised.edge(self.edges.len() - 1, nodes);
                }
            }
            (types::QUADRATIC_TRIANGLE | types::LAGRANGE_TRIANGLE, &[a, b, c, ref nodes @ ..]) => {
                self.triangles.push([a, b, c]);
                match nodes.len() {
                    0 => {}
                    3 | 7 => self.raised.triangle(nodes),
                    _ => return Err(right),
                }
            }
            (types::LINE | types::POLY_LINE, _) => {
                self.edges.extend(vertices.windows(2).map(|ends| [ends[0], ends[1]]));
            }
            (types::TRIANGLE_STRIP, _) => {
                let turned = |(i, v): (usize, &[u32])| if i % 2 == 0 { [v[0], v[1], v[2]] } else { [v[1], v[0], v[2]] };
                self.triangles.extend(vertices.windows(3).enumerate().map(turned));
            }
            (types::PIXEL, &[a, b, c, d]) => cut(points, &[a, b, d, c], &mut self.triangles),
            (types::TRIANGLE | types::POLYGON | types::QUAD, _) => cut(points, vertices, &mut self.triangles),
            (types::VOXEL, &[a, b, c, d, e, f, g, h]) => {
                self.volumes.push(&[a, b, d, c, e, f, h, g], 0, cell);
            }
            (types::TETRAHEDRON.., _) => drop(self.volumes.push(vertices, 0, cell)),
            _ => {}
        }
        self.of_edges.resize(self.edges.len(), cell);
        self.of_triangles.resize(self.triangles.len(), cell);
        Ok(())
    }

    /// The outside of the volumes as triangles, where there are no others; `label` is that of a cell. What to tell of it.
    pub(super) fn take_skin(&mut self, points: &[[f64; 3]], label: impl Fn(usize) -> i32) -> Option<String> {
        let note = self.volumes.note(self.triangles.len());
        if self.triangles.is_empty() {
            self.volumes.relabel(label);
            let skin = self.volumes.skin(points);
            (self.triangles, self.of_triangles) = (skin.triangles, skin.elements);
        }
        note
    }
}

/// How many vertices a cell of a type has, at least and at most, and how messages say so.
fn right(kind: u8) -> (usize, usize, &'static str) {
    match kind {
        types::LINE => (2, 2, "a line has 2"),
        types::POLY_LINE => (2, usize::MAX, "a polyline has 2 or more"),
        types::TRIANGLE => (3, 3, "a triangle has 3"),
        types::PIXEL | types::QUAD => (4, 4, "a quadrilateral has 4"),
        types::POLYGON | types::TRIANGLE_STRIP => (3, usize::MAX, "polygons and strips have 3 or more"),
        types::TETRAHEDRON => (4, 4, "a tetrahedron has 4"),
        types::VOXEL => (8, 8, "a voxel has 8"),
        types::HEXAHEDRON => (8, 8, "a hexahedron has 8"),
        types::WEDGE => (6, 6, "a wedge has 6"),
        types::PYRAMID => (5, 5, "a pyramid has 5"),
        types::QUADRATIC_EDGE => (3, 3, "a quadratic edge has 3"),
        types::QUADRATIC_TRIANGLE => (6, 6, "a quadratic triangle has 6"),
        types::LAGRANGE_CURVE => (2, 4, "Lagrange curves of order 1, 2 and 3, which are read, have 2, 3 and 4"),
        types::LAGRANGE_TRIANGLE => (3, 10, "Lagrange triangles of order 1, 2 and 3, which are read, have 3, 6 and 10"),
        _ => (0, usize::MAX, ""),
    }
}

/// Refuses cells that are neither points, lines nor polygons, nor curved lines or triangles, nor volumes of few straight edges.
///
/// # Errors
/// [`Error::Unsupported`] with their count.
pub(super) fn refuse_foreign(kinds: &[i64], place: &str) -> Result<()> {
    let known = i64::from(types::EMPTY)..=i64::from(types::PYRAMID);
    let is_known = |kind: &i64| known.contains(kind) || types::CURVED.iter().any(|&curved| i64::from(curved) == *kind);
    let mut counts = BTreeMap::new();
    for kind in kinds.iter().filter(|kind| !is_known(kind)) {
        *counts.entry(*kind).or_insert(0_u64) += 1;
    }
    let Some((kind, count)) = counts.into_iter().max_by_key(|&(_, count)| count) else { return Ok(()) };
    let name = FOREIGN.iter().find(|(known, _)| i64::from(*known) == kind);
    let name = name.map_or("of higher order or unknown", |(_, name)| name);
    let what = format!("{count} cells of type {kind} ({name}) in {place}");
    let help = "give a mesh of triangles: in ParaView, the filters Extract Surface and Triangulate make one";
    Err(Error::unsupported(what, help))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_cut() {
        let mut shapes = Shapes::default();
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [-0.5, 0.5, 0.0], [0.0, 0.4, 0.0]];
        for (cell, (kind, vertices)) in [
            (types::TRIANGLE, &[0, 1, 2][..]),
            (1, &[5]),
            (types::QUAD, &[0, 1, 2, 3]),
            (types::POLY_LINE, &[4, 5, 6]),
            (types::POLYGON, &[1, 2, 3, 4, 5]),
            (types::TRIANGLE_STRIP, &[1, 2, 3, 4]),
            (types::PIXEL, &[0, 1, 3, 2]),
            (types::LINE, &[2, 1]),
            (2, &[1, 2, 3]),
        ]
        .into_iter()
        .enumerate()
        {
            shapes.push(cell as u32, kind, vertices, &points).unwrap();
        }
        let expected = [
            [0, 1, 2],
            [0, 1, 2],
            [0, 2, 3],
            [5, 1, 2],
            [3, 4, 5],
            [5, 2, 3],
            [1, 2, 3],
            [3, 2, 4],
            [0, 1, 2],
            [0, 2, 3],
        ];
        assert_eq!(shapes.triangles, expected);
        assert_eq!(shapes.of_triangles, [0, 2, 2, 4, 4, 4, 5, 5, 6, 6]);
        assert_eq!((shapes.edges, shapes.of_edges), (vec![[4, 5], [5, 6], [2, 1]], vec![3, 3, 7]));
    }

    #[test]
    fn wrong_numbers_of_vertices() {
        for (kind, count, message) in [
            (types::LINE, 3, "a line has 2"),
            (types::POLY_LINE, 1, "a polyline has 2 or more"),
            (types::TRIANGLE, 4, "a triangle has 3"),
            (types::QUAD, 3, "a quadrilateral has 4"),
            (types::PIXEL, 5, "a quadrilateral has 4"),
            (types::POLYGON, 2, "polygons and strips have 3 or more"),
            (types::TRIANGLE_STRIP, 0, "polygons and strips have 3 or more"),
            (types::TETRAHEDRON, 5, "a tetrahedron has 4"),
            (types::VOXEL, 4, "a voxel has 8"),
            (types::HEXAHEDRON, 6, "a hexahedron has 8"),
            (types::WEDGE, 4, "a wedge has 6"),
            (types::PYRAMID, 4, "a pyramid has 5"),
            (types::QUADRATIC_EDGE, 4, "a quadratic edge has 3"),
            (types::QUADRATIC_TRIANGLE, 7, "a quadratic triangle has 6"),
            (types::LAGRANGE_CURVE, 5, "Lagrange curves of order 1, 2 and 3, which are read, have 2, 3 and 4"),
            (types::LAGRANGE_TRIANGLE, 9, "Lagrange triangles of order 1, 2 and 3, which are read, have 3, 6 and 10"),
        ] {
            assert_eq!(Shapes::default().push(0, kind, &[0; 9][..count], &[[0.0; 3]]).unwrap_err(), message);
        }
    }
}
