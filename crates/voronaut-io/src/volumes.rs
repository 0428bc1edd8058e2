//! Cells of volume meshes, of which a triangle mesh keeps the outside.

use super::cutting::cut;
use std::ops::Range;
use voronaut::geometry::{Point3, Vector3};

/// A kind of cell: how many vertices it has, by which it is known; what one and several are called; its sides. Vertices are in the
/// order that Medit, Gmsh and VTK share: a base, and then the apex or the opposite base.
type Solid = (usize, &'static str, &'static str, &'static [&'static [usize]]);

const SOLIDS: [Solid; 4] = [
    (4, "tetrahedron", "tetrahedra", &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]]),
    (5, "pyramid", "pyramids", &[&[0, 3, 2, 1], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]]),
    (6, "prism", "prisms", &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]]),
    (8, "hexahedron", "hexahedra", &HEXAHEDRON),
];

const HEXAHEDRON: [&[usize]; 6] =
    [&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]];

/// The cells of a file.
#[derive(Default)]
pub(super) struct Volumes {
    vertices: Vec<u32>,
    cells: Vec<Cell>,
}

struct Cell {
    /// Where its vertices are.
    corners: Range<usize>,
    label: i32,
    /// What the file counts it as.
    element: u32,
}

/// The triangles between a volume and what is not in it, and between its parts.
#[derive(Default)]
pub(super) struct Skin {
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) labels: Vec<i32>,
    /// The element that each triangle is from.
    pub(super) elements: Vec<u32>,
}

/// A side of a cell.
struct Side {
    /// Its vertices, sorted, then [`NONE`]: what it has in common with the side of the cell behind it.
    key: [u32; 4],
    cell: u32,
    /// Which one of the cell.
    number: u32,
}

const NONE: u32 = u32::MAX;

impl Volumes {
    /// A cell of 4, 5, 6 or 8 vertices that the file counts as an element. The number of the cell.
    pub(super) fn push(&mut self, vertices: &[u32], label: i32, element: u32) -> u32 {
        let start = self.vertices.len();
        self.vertices.extend(vertices);
        self.cells.push(Cell { corners: start..self.vertices.len(), label, element });
        self.cells.len() as u32 - 1
    }

    /// Gives a cell another label.
    pub(super) fn label(&mut self, cell: u32, label: i32) {
        self.cells[cell as usize].label = label;
    }

    /// Gives all cells the labels of their elements.
    pub(super) fn relabel(&mut self, label: impl Fn(usize) -> i32) {
        self.cells.iter_mut().for_each(|cell| cell.label = label(cell.element as usize));
    }

    /// What to tell of the cells beside `listed` triangles of the file; nothing where there are none.
    pub(super) fn note(&self, listed: usize) -> Option<String> {
        let count = |vertices: usize| self.cells.iter().filter(|cell| cell.corners.len() == vertices).count();
        let told = SOLIDS.iter().filter_map(|&(vertices, one, many, _)| match count(vertices) {
            0 => None,
            1 => Some(format!("1 {one}")),
            several => Some(format!("{several} {many}")),
        });
        let told = told.collect::<Vec<_>>().join(", ");
        (!self.cells.is_empty()).then(|| match listed {
            0 => format!("of {told} the boundary was taken, for the file lists no triangles"),
            1 => format!("{told} left out: the surface is the 1 triangle that the file lists"),
            _ => format!("{told} left out: the surface is the {listed} triangles that the file lists"),
        })
    }

    /// The sides of cells that no other cell has, and those between cells with different labels, once; with the label of their
    /// cell, the lesser of two; turned away from that cell. In the order of the cells. n log n.
    pub(super) fn skin(&self, points: &[[f64; 3]]) -> Skin {
        let mut sides = self.sides();
        sides.sort_unstable_by_key(|side| (side.key, side.cell, side.number));
        let label = |side: &Side| self.cells[side.cell as usize].label;
        let outer = sides.chunk_by(|a, b| a.key == b.key).filter_map(|same| {
            let least = same.iter().min_by_key(|side| label(side))?;
            (same.len() == 1 || same.iter().any(|side| label(side) != label(least))).then_some(least)
        });
        let mut outer: Vec<&Side> = outer.collect();
        outer.sort_unstable_by_key(|side| (side.cell, side.number));
        let mut skin = Skin::default();
        for side in outer {
            let cell = &self.cells[side.cell as usize];
            let corners = &self.vertices[cell.corners.clone()];
            let polygon = distinct(sides_of(corners.len())[side.number as usize], corners);
            cut(points, &turned_away(points, polygon, corners), &mut skin.triangles);
            skin.labels.resize(skin.triangles.len(), cell.label);
            skin.elements.resize(skin.triangles.len(), cell.element);
        }
        skin
    }

    /// The sides of all cells; those of collapsed cells that have no area are none.
    fn sides(&self) -> Vec<Side> {
        let mut sides = Vec::new();
        for (cell, corners) in (0..).zip(self.cells.iter().map(|cell| &self.vertices[cell.corners.clone()])) {
            for (number, side) in (0..).zip(sides_of(corners.len())) {
                let mut key = [NONE; 4];
                let polygon = distinct(side, corners);
                key[..polygon.len()].copy_from_slice(&polygon);
                key.sort_unstable();
                if polygon.len() > 2 {
                    sides.push(Side { key, cell, number });
                }
            }
        }
        sides
    }
}

/// The sides of a cell with so many vertices.
fn sides_of(vertices: usize) -> &'static [&'static [usize]] {
    SOLIDS.iter().find(|(known, ..)| *known == vertices).map_or(&[], |(.., sides)| sides)
}

/// The vertices of a side, each once: programs write prisms as hexahedra with the same vertex several times.
fn distinct(side: &[usize], corners: &[u32]) -> Vec<u32> {
    let mut polygon: Vec<u32> = Vec::with_capacity(side.len());
    for v in side.iter().map(|&i| corners[i]) {
        if !polygon.contains(&v) {
            polygon.push(v);
        }
    }
    polygon
}

/// A side such that its cell is behind it: programs do not agree on the order of a cell's vertices.
fn turned_away(points: &[[f64; 3]], mut polygon: Vec<u32>, corners: &[u32]) -> Vec<u32> {
    let position = |v: u32| Point3::from(points[v as usize]);
    let origin = position(polygon[0]);
    let mean = |of: &[u32]| {
        of.iter().fold(Vector3::new(0.0, 0.0, 0.0), |sum, &v| sum + (position(v) - origin)) * (1.0 / of.len() as f64)
    };
    let normal = polygon[1..].windows(2).fold(Vector3::new(0.0, 0.0, 0.0), |sum, pair| {
        sum + (position(pair[0]) - origin).cross(position(pair[1]) - origin)
    });
    if normal.dot(mean(corners) - mean(&polygon)) > 0.0 {
        polygon.reverse();
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;
    use voronaut::manifold::surface::Surface;
    use voronaut::mesh::Mesh;

    /// The corners of the unit cube, the base first.
    fn cube() -> Vec<[f64; 3]> {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        [0.0, 1.0].iter().flat_map(|&z| square.map(|[x, y]| [x, y, z])).collect()
    }

    fn volume(surface: &Surface) -> f64 {
        let faces = surface.topology().faces();
        faces
            .map(|f| {
                let [a, b, c] = surface.triangle(f).map(|p| p - Point3::default());
                a.dot(b.cross(c)) / 6.0
            })
            .sum()
    }

    fn skin_of(points: &[[f64; 3]], cells: &[(&[u32], i32)]) -> Skin {
        let mut volumes = Volumes::default();
        for &(vertices, label) in cells {
            volumes.push(vertices, label, volumes.cells.len() as u32);
        }
        volumes.skin(points)
    }

    #[test]
    fn every_kind_is_closed_and_turned_outwards() {
        let mut points = cube();
        points.push([0.5, 0.5, 2.0]);
        for (vertices, expected) in [
            (&[0, 1, 2, 3, 4, 5, 6, 7][..], 1.0),
            (&[4, 5, 6, 7, 0, 1, 2, 3], 1.0),
            (&[0, 1, 2, 2, 4, 5, 6, 6], 0.5),
            (&[0, 1, 2, 4, 5, 6], 0.5),
            (&[0, 2, 1, 4, 6, 5], 0.5),
            (&[4, 5, 6, 7, 8], 1.0 / 3.0),
            (&[0, 1, 2, 6], 1.0 / 6.0),
            (&[1, 0, 2, 6], 1.0 / 6.0),
        ] {
            let Skin { triangles, .. } = skin_of(&points, &[(vertices, 0)]);
            let surface = Surface::new(&Mesh { points: points.clone(), triangles, ..Mesh::default() }).unwrap();
            assert_eq!((surface.euler_characteristic(), surface.turned()), (2, 0), "{vertices:?}");
            assert!((volume(&surface) - expected).abs() < 1e-12, "{vertices:?}");
        }
    }

    #[test]
    fn sides_between_cells_are_there_where_labels_differ() {
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0]];
        let cells = |second| [(&[0, 1, 2, 3][..], 7), (&[0, 1, 2, 4], second)];
        let same = skin_of(&points, &cells(7));
        assert_eq!((same.triangles.len(), same.elements), (6, vec![0, 0, 0, 1, 1, 1]));
        let apart = skin_of(&points, &cells(3));
        assert_eq!((apart.labels, apart.elements), (vec![7, 7, 7, 3, 3, 3, 3], vec![0, 0, 0, 1, 1, 1, 1]));
    }

    #[test]
    fn what_is_left_out_is_told() {
        let mut volumes = Volumes::default();
        assert_eq!(volumes.note(4), None);
        volumes.push(&[0, 1, 2, 3], 0, 0);
        assert_eq!(
            volumes.note(0).unwrap(),
            "of 1 tetrahedron the boundary was taken, for the file lists no triangles"
        );
        volumes.push(&[0, 1, 2, 3, 4, 5], 0, 0);
        volumes.push(&[0, 1, 2, 3, 4, 5], 0, 0);
        let told = "1 tetrahedron, 2 prisms left out: the surface is the 9 triangles that the file lists";
        assert_eq!(volumes.note(9).unwrap(), told);
    }
}
