//! A mesh and fields from the pieces of a file.

use super::cells::{Shapes, refuse_foreign, types};
use super::data::{Data, Joined};
use super::grid::{Array, CELLS, Grid, Piece};
use crate::codec::Place;
use crate::curved::Raised;
use crate::{Document, Fields};
use voronaut::mesh::Mesh;
use voronaut::{Error, Result};

/// Joins the pieces of a file.
///
/// # Errors
/// As of [`super::read`].
pub(super) fn assemble(grid: Grid<'_>) -> Result<Document> {
    let mut assembly = Assembly { file: grid.file, ..Assembly::default() };
    let mut last = 0;
    for piece in grid.pieces {
        last = piece.byte;
        assembly.append(piece)?;
    }
    let is_planar = assembly.mesh.is_planar();
    let [vertices, triangles] = [assembly.vertices, assembly.triangles].map(|joined| joined.finish(is_planar));
    let mut document = Document { mesh: assembly.mesh, fields: Fields { vertices, triangles }, notes: assembly.notes };
    assembly.raised.finish(&mut document, Place::byte(assembly.file, last))?;
    Ok(document)
}

#[derive(Default)]
struct Assembly<'a> {
    file: &'a str,
    mesh: Mesh,
    raised: Raised,
    vertices: Joined<'a>,
    triangles: Joined<'a>,
    notes: Vec<String>,
}

impl<'a> Assembly<'a> {
    fn append(&mut self, mut piece: Piece<'a>) -> Result<()> {
        let base = self.mesh.points.len();
        if base as u64 + piece.points > u32::MAX.into() || piece.count("CellData") > u32::MAX.into() {
            let what = format!("more than {} points or cells", u32::MAX);
            return Err(self.error(&piece, &what, "give a smaller mesh"));
        }
        self.append_points(&mut piece)?;
        let mut shapes = Shapes::default();
        let mut cells = 0;
        for section in CELLS {
            self.read_cells(&mut piece, section, cells, &mut shapes)?;
            cells += piece.count(section) as u32;
        }
        let (mut of_points, mut of_cells) = (Vec::new(), Vec::new());
        for mut array in std::mem::take(&mut piece.arrays) {
            match array.section {
                "PointData" => of_points.push(array),
                "CellData" => of_cells.push(array),
                others if piece.count(others) == 0 => drop(array.take_reals(0)?),
                _ => {}
            }
        }
        let count = piece.points;
        self.append_point_data(Data::read(of_points, count)?, base, count as usize)?;
        let data = Data::read(of_cells, cells.into())?;
        self.notes.extend(shapes.take_skin(&self.mesh.points[base..], |cell| data.label(cell)));
        for vertex in shapes.triangles.as_flattened_mut().iter_mut().chain(shapes.edges.as_flattened_mut()) {
            *vertex += base as u32;
        }
        self.raised.append(std::mem::take(&mut shapes.raised), base as u32, self.mesh.edges.len() as u32);
        self.append_cells(data, shapes, cells as usize)
    }

    fn append_points(&mut self, piece: &mut Piece<'a>) -> Result<()> {
        let count = piece.points;
        if count == 0 {
            return Ok(());
        }
        let Some(mut array) = piece.take("Points", None) else {
            return Err(self.error(piece, "a piece without the array of its points", "check that the file is whole"));
        };
        if array.components.unwrap_or(3) != 3 {
            let what = format!("has {} components, where points have 3", array.components.unwrap_or(3));
            return Err(array.error(&what, "write three coordinates, the third 0 in the plane"));
        }
        let numbers = array.take_reals(3 * count)?;
        if let Some(i) = numbers.iter().position(|number| !number.is_finite()) {
            let what = format!("holds {}, which is not finite, as a coordinate of point {}", numbers[i], i / 3 + 1);
            return Err(array.error(&what, "remove or correct the point"));
        }
        self.mesh.points.extend_from_slice(numbers.as_chunks().0);
        Ok(())
    }

    /// Cells of a section, whose numbers begin with `first`.
    fn read_cells(&self, piece: &mut Piece<'a>, section: &str, first: u32, to: &mut Shapes) -> Result<()> {
        let count = piece.count(section);
        if count == 0 {
            return Ok(());
        }
        let (mut kinds, all) = match section {
            "Cells" => {
                let kinds = self.take(piece, section, "types")?.take_wholes(count)?;
                refuse_foreign(&kinds, self.file)?;
                (kinds.into_iter().map(|kind| kind as u8).collect(), types::EMPTY)
            }
            "Verts" => return Ok(()),
            "Lines" => (Vec::new(), types::POLY_LINE),
            "Strips" => (Vec::new(), types::TRIANGLE_STRIP),
            _ => (Vec::new(), types::POLYGON),
        };
        let mut offsets = self.take(piece, section, "offsets")?;
        let ends = offsets.take_wholes(count)?;
        let fault = |what: String| offsets.error(&what, "check the cells, and that the file is whole");
        // Only now it is known that there are as many cells as the file says.
        kinds.resize(ends.len(), all);
        let starts = || std::iter::once(0).chain(ends.iter().copied());
        let mut cells = starts().zip(&ends).enumerate();
        if let Some((i, (start, end))) = cells.find(|(_, (start, end))| *end < start) {
            let what = format!("says that cell {} ends at {end}, behind which it begins, at {start}", i + 1);
            return Err(fault(what));
        }
        let vertices = self.read_connectivity(piece, section, ends.last().copied().unwrap_or(0) as u64)?;
        let points = &self.mesh.points[self.mesh.points.len() - piece.points as usize..];
        for (i, ((start, &end), kind)) in starts().zip(&ends).zip(kinds).enumerate() {
            let cell = &vertices[start as usize..end as usize];
            let pushed = to.push(first + i as u32, kind, cell, points);
            pushed.map_err(|right| fault(format!("gives cell {} {} vertices: {right}", i + 1, cell.len())))?;
        }
        Ok(())
    }

    fn read_connectivity(&self, piece: &mut Piece<'a>, section: &str, count: u64) -> Result<Vec<u32>> {
        if count == 0 {
            return Ok(Vec::new());
        }
        let mut array = self.take(piece, section, "connectivity")?;
        let (numbers, points) = (array.take_wholes(count)?, piece.points);
        let vertex = |(i, number): (usize, i64)| match u32::try_from(number) {
            Ok(vertex) if u64::from(vertex) < points => Ok(vertex),
            _ => {
                let what =
                    format!("holds point {number} (number {} of {count}): the piece has {points}, from 0", i + 1);
                Err(array.error(&what, "correct the cell"))
            }
        };
        numbers.into_iter().enumerate().map(vertex).collect()
    }

    fn take(&self, piece: &mut Piece<'a>, section: &str, name: &str) -> Result<Array<'a>> {
        let array = piece.take(section, Some(name)).filter(|array| array.components.unwrap_or(1) == 1);
        array.ok_or_else(|| {
            let what = format!("{section} of a piece without an array '{name}' of one component");
            self.error(piece, &what, "check that the file is whole, and that a VTK program wrote it")
        })
    }

    fn append_point_data(&mut self, data: Data<'a>, base: usize, count: usize) -> Result<()> {
        self.mesh.point_labels.extend((0..count).map(|i| data.label(i)));
        self.mesh.corners.extend(data.marked("corner", base, 0..count));
        self.mesh.required_points.extend(data.marked("required", base, 0..count));
        if count == 0 {
            return Ok(());
        }
        data.fields.iter().try_for_each(|field| field.check(None))?;
        self.vertices.append(data.fields)
    }

    fn append_cells(&mut self, mut data: Data<'a>, shapes: Shapes, cells: usize) -> Result<()> {
        let (triangles, edges) = (self.mesh.triangles.len(), self.mesh.edges.len());
        let of = |cells: &[u32]| cells.iter().map(|&cell| cell as usize).collect::<Vec<_>>().into_iter();
        let (of_triangles, of_edges) = (of(&shapes.of_triangles), of(&shapes.of_edges));
        self.mesh.triangle_labels.extend(of_triangles.clone().map(|cell| data.label(cell)));
        self.mesh.edge_labels.extend(of_edges.clone().map(|cell| data.label(cell)));
        self.mesh.required_triangles.extend(data.marked("required", triangles, of_triangles));
        self.mesh.required_edges.extend(data.marked("required", edges, of_edges.clone()));
        self.mesh.ridges.extend(data.marked("ridge", edges, of_edges));
        self.mesh.triangles.extend(shapes.triangles);
        self.mesh.edges.extend(shapes.edges);
        if shapes.of_triangles.is_empty() {
            return Ok(());
        }
        demand_moderate_cuts(&data, shapes.of_triangles.len(), cells, self.file)?;
        for field in &mut data.fields {
            field.select(&shapes.of_triangles);
            field.check(Some(&shapes.of_triangles))?;
        }
        self.triangles.append(data.fields)
    }

    fn error(&self, piece: &Piece<'_>, what: &str, help: &str) -> Error {
        Place::byte(self.file, piece.byte).error(what, help)
    }
}

/// Refuses fields whose values would take far more memory than the file: of polygons with many vertices, each triangle of which
/// repeats all numbers.
fn demand_moderate_cuts(data: &Data<'_>, triangles: usize, cells: usize, file: &str) -> Result<()> {
    const ALWAYS: usize = 1 << 24;
    const MOST_PER_CELL: usize = 64;
    let components = data.fields.iter().fold(0_usize, |sum, field| sum.saturating_add(field.components));
    let numbers = components.saturating_mul(triangles);
    if numbers <= ALWAYS || triangles / MOST_PER_CELL < cells {
        return Ok(());
    }
    let what = format!("{file}: {cells} cells are cut into {triangles} triangles, with {numbers} values on them");
    Err(Error::limit(what, "triangulate the polygons, or remove the data on cells"))
}
