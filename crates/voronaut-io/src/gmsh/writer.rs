//! Meshes as Gmsh's sections.

use super::Version;
use super::data::Column;
use super::elements::{EDGES, POINT, TRIANGLES};
use super::groups::{MARKS, Marks, Numbering};
use crate::Fields;
use crate::codec::{Form, Sink};
use crate::curved::Elements;
use crate::document::{labels, marked};
use std::collections::BTreeMap;
use std::io::{self, Write};
use voronaut::mesh::Mesh;

/// Writes a mesh and fields as a file that [`read`](super::read) turns into the same vertices, to the last bit, and the same triangles and
/// edges, sorted by label.
///
/// Triangles come first, then edges, then the vertices with a label or a mark as elements of type 15, each with a physical group and an
/// entity per label and marks. The group's tag is the label. Gmsh has no tags below 1: such a label has the least tag that
/// is no label, and the group is named `triangle label -3`, `edge label 0` or `vertex label -1`. Marks are groups as well: `corners`,
/// `required vertices`, `ridges`, `required edges` and `required triangles`. In version 2.2, where Gmsh repeats elements for each
/// of their groups, those of edges and triangles are not written.
///
/// Nodes of curved triangles follow the vertices, with values between those at vertices.
///
/// Curves that correspond ([`Mesh::periodic`]) are in `$Periodic`, where the first is the master.
///
/// Fields are `$NodeData` and `$ElementData`; vectors of two numbers get a third, 0; tensors are written row by row with 9 numbers.
/// Other fields of several numbers are one field `NAME_0`, `NAME_1`, ... each. So that meshio reads fields of triangles, in
/// version 4.1 edges and points have values too: of a triangle at their first vertex, 0 where there is none. Of files of version 2.2
/// Gmsh leaves out vertices without element.
///
/// # Errors
/// What `out` says; more elements than version 2.2 or fields have tags for; labelled edges of a curved mesh that no triangle has.
pub fn write(mesh: &Mesh, fields: &Fields, version: Version, form: Form, out: &mut dyn Write) -> io::Result<()> {
    let plan = Plan::new(mesh)?;
    let mut sink = begin(version, form, out)?;
    plan.write_names(&mut sink)?;
    match version {
        Version::V4_1 => plan.write_4(&mut sink)?,
        Version::V2_2 => plan.write_2(&mut sink)?,
    }
    plan.write_periodic(version, &mut sink)?;
    for column in plan.elements.fields(fields).vertices.iter().flat_map(Column::of) {
        write_data("NodeData", &column, (0..plan.elements.points.len()).map(Some), &mut sink)?;
    }
    let rows = if fields.triangles.is_empty() { Vec::new() } else { plan.triangles_of_elements(version) };
    for column in fields.triangles.iter().flat_map(Column::of) {
        write_data("ElementData", &column, rows.iter().copied(), &mut sink)?;
    }
    Ok(())
}

/// Which elements a mesh becomes, and in what order: triangles, edges, points, each by label and marks.
pub(super) struct Plan<'a> {
    pub(super) mesh: &'a Mesh,
    elements: Elements<'a>,
    pub(super) parts: Vec<Part>,
    groups: Vec<Numbering>,
}

/// The elements of an entity: those of one dimension with the same label and marks.
pub(super) struct Part {
    pub(super) dimension: u8,
    /// Their label and marks.
    pub(super) key: (i32, Marks),
    /// The tag of the entity.
    pub(super) entity: i32,
    /// The physical groups of the entity.
    groups: Vec<i32>,
    /// Vertices, edges or triangles.
    pub(super) elements: Vec<u32>,
}

impl<'a> Plan<'a> {
    fn new(mesh: &'a Mesh) -> io::Result<Self> {
        let (mut parts, mut groups): (Vec<Part>, Vec<Numbering>) = (Vec::new(), Vec::new());
        for (dimension, count, labels) in [
            (2, mesh.triangles.len(), &mesh.triangle_labels),
            (1, mesh.edges.len(), &mesh.edge_labels),
            (0, mesh.points.len(), &mesh.point_labels),
        ] {
            let sorted = sort(mesh, dimension, count, labels);
            let mut numbering = Numbering::new(dimension, sorted.keys().map(|&(label, _)| label));
            let first = parts.len();
            for (entity, (key, elements)) in (1..).zip(sorted) {
                parts.push(Part { dimension, key, entity, groups: numbering.tags(key.0, key.1), elements });
            }
            numbering.keep_used(&parts[first..].iter().flat_map(|part| part.groups.iter().copied()).collect());
            groups.push(numbering);
        }
        Ok(Self { mesh, elements: Elements::new(mesh)?, parts, groups })
    }

    fn write_names(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        let count: usize = self.groups.iter().map(|numbering| numbering.names.len()).sum();
        if count == 0 {
            return Ok(());
        }
        sink.line(format_args!("$PhysicalNames\n{count}"))?;
        for numbering in self.groups.iter().rev() {
            for (tag, name) in &numbering.names {
                sink.line(format_args!("{} {tag} \"{name}\"", numbering.dimension))?;
            }
        }
        sink.line(format_args!("$EndPhysicalNames"))
    }

    fn write_4(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        let count = |dimension: u8| self.parts.iter().filter(|part| part.dimension == dimension).count() as u64;
        sink.line(format_args!("$Entities"))?;
        // Nodes have to belong to something.
        let is_bare = self.parts.is_empty();
        sink.row([count(0), count(1), count(2) + u64::from(is_bare), 0])?;
        for dimension in 0..3 {
            for part in self.parts.iter().filter(|part| part.dimension == dimension) {
                self.write_entity(part, sink)?;
            }
        }
        if is_bare {
            let key = (0, Marks::default());
            self.write_entity(&Part { dimension: 2, key, entity: 1, groups: vec![], elements: vec![] }, sink)?;
        }
        write_end("Entities", sink)?;
        self.write_nodes_4(sink)?;
        self.write_elements_4(sink)
    }

    fn write_entity(&self, part: &Part, sink: &mut Sink<'_>) -> io::Result<()> {
        let ([lower, upper], is_point) = (self.bounds(part), part.dimension == 0);
        sink.put(part.entity);
        sink.put_all(lower);
        sink.put_all(upper.into_iter().filter(|_| !is_point));
        sink.put(part.groups.len() as u64);
        sink.put_all(part.groups.iter().copied());
        // No entities bound it.
        sink.row(Some(0_u64).filter(|_| !is_point))
    }

    /// The smallest box around the elements of an entity.
    fn bounds(&self, part: &Part) -> [[f64; 3]; 2] {
        let vertices = || part.elements.iter().flat_map(|element| self.nodes(part.dimension, element));
        let extreme = |of: fn(f64, f64) -> f64| {
            let points = vertices().map(|v| self.elements.points[v as usize]);
            points.reduce(|a, b| [0, 1, 2].map(|i| of(a[i], b[i]))).unwrap_or_default()
        };
        [extreme(f64::min), extreme(f64::max)]
    }

    fn write_nodes_4(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        let count = self.elements.points.len() as u64;
        let blocks = u64::from(count > 0);
        sink.line(format_args!("$Nodes"))?;
        sink.row([blocks, count, blocks, count])?;
        if count > 0 {
            let dimension = self.parts.first().map_or(2, |part| part.dimension);
            sink.put_all([i32::from(dimension), 1, 0]);
            sink.row([count])?;
            (1..=count).try_for_each(|tag| sink.row([tag]))?;
        }
        self.elements.points.iter().try_for_each(|point| sink.row(*point))?;
        write_end("Nodes", sink)
    }

    fn write_elements_4(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        let count = self.parts.iter().map(|part| part.elements.len() as u64).sum();
        sink.line(format_args!("$Elements"))?;
        sink.row([self.parts.len() as u64, count, u64::from(count > 0), count])?;
        let mut tags = 1_u64..;
        for part in &self.parts {
            sink.put_all([part.dimension.into(), part.entity, self.kind(part.dimension)]);
            sink.row([part.elements.len() as u64])?;
            for (element, tag) in part.elements.iter().zip(&mut tags) {
                sink.put(tag);
                sink.row(self.nodes(part.dimension, element).map(|v| u64::from(v) + 1))?;
            }
        }
        write_end("Elements", sink)
    }

    fn write_2(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        let count = self.parts.iter().map(Part::count_2).sum();
        demand_tags(count)?;
        let points = &self.elements.points;
        demand_tags(points.len())?;
        sink.line(format_args!("$Nodes\n{}", points.len()))?;
        for (tag, point) in (1_i32..).zip(points.iter()) {
            sink.put(tag);
            sink.row(*point)?;
        }
        write_end("Nodes", sink)?;
        sink.line(format_args!("$Elements\n{count}"))?;
        let mut tag = 0;
        for part in &self.parts {
            if sink.is_binary() {
                sink.put_all([self.kind(part.dimension), (part.count_2() as u32).cast_signed(), 2]);
            }
            for element in &part.elements {
                for &group in part.groups_2() {
                    tag += 1;
                    sink.put(tag);
                    if !sink.is_binary() {
                        sink.put_all([self.kind(part.dimension), 2]);
                    }
                    sink.put_all([group, part.entity]);
                    sink.row(self.nodes(part.dimension, element).map(|v| v + 1))?;
                }
            }
        }
        write_end("Elements", sink)
    }

    /// The points of a vertex, an edge or a triangle, corners first.
    pub(super) fn nodes<'b>(&'b self, dimension: u8, element: &'b u32) -> impl Iterator<Item = u32> + use<'a, 'b> {
        self.elements.nodes(dimension, element)
    }

    /// The type of elements of a dimension.
    fn kind(&self, dimension: u8) -> i32 {
        let curve = self.elements.order - 1;
        [POINT, EDGES[curve], TRIANGLES[curve]][usize::from(dimension)]
    }

    /// The triangle whose value each element has. Version 4.1: meshio reads values of elements only where all elements have one, so an
    /// edge or a point has that of a triangle at its first vertex; `None` where there is none. Version 2.2: of triangles alone, for there
    /// meshio 5.3.5 reads values only where there is nothing else.
    fn triangles_of_elements(&self, version: Version) -> Vec<Option<usize>> {
        let mut at = vec![None; self.mesh.points.len()];
        for (i, triangle) in self.mesh.triangles.iter().enumerate() {
            for &vertex in triangle {
                at[vertex as usize] = Some(i);
            }
        }
        let parts = self.parts.iter().filter(|part| part.dimension == 2 || version == Version::V4_1);
        let of = |part: &Part, element: &u32| match part.dimension {
            2 => Some(*element as usize),
            dimension => self.nodes(dimension, element).next().and_then(|v| at[v as usize]),
        };
        parts.flat_map(|part| part.elements.iter().map(move |element| of(part, element))).collect()
    }
}

impl Part {
    /// The groups for which version 2.2 has the elements, once each. Those of marks are left out but for points, so that edges and
    /// triangles are there once.
    fn groups_2(&self) -> &[i32] {
        if self.dimension == 0 { &self.groups } else { &self.groups[..self.groups.len().min(1)] }
    }

    /// How many elements it is in version 2.2.
    fn count_2(&self) -> usize {
        self.groups_2().len() * self.elements.len()
    }
}

/// Elements by label and marks, each list in the order of the mesh.
type Sorted = BTreeMap<(i32, Marks), Vec<u32>>;

/// All elements of a dimension, but for vertices without label and marks, which need none.
fn sort(mesh: &Mesh, dimension: u8, count: usize, given: &[i32]) -> Sorted {
    let mut marks = vec![Marks::default(); count];
    for (mark, (list, (of, _))) in marked(mesh).into_iter().zip(MARKS).enumerate() {
        if of == dimension {
            for &i in list {
                marks[i as usize].insert(mark);
            }
        }
    }
    let mut sorted = Sorted::new();
    for (i, key) in (0..).zip(labels(given).zip(marks)) {
        if dimension > 0 || key != (0, Marks::default()) {
            sorted.entry(key).or_default().push(i);
        }
    }
    sorted
}

/// Writes values of nodes or elements, zeros where there is no `row`.
fn write_data(
    section: &str,
    column: &Column<'_>,
    rows: impl ExactSizeIterator<Item = Option<usize>>,
    sink: &mut Sink<'_>,
) -> io::Result<()> {
    let (name, components, count) = (&column.name, column.components, rows.len());
    demand_tags(count)?;
    sink.line(format_args!("${section}\n1\n\"{name}\"\n1\n0\n3\n0\n{components}\n{count}"))?;
    for (tag, row) in (1_i32..).zip(rows) {
        sink.put(tag);
        sink.row(column.row(row))?;
    }
    write_end(section, sink)
}

fn demand_tags(count: usize) -> io::Result<()> {
    let what = "more than 2^31 nodes or elements, for which Gmsh has no tags";
    i32::try_from(count).map(drop).map_err(|_| io::Error::other(what))
}

/// Begins to write a file.
fn begin(version: Version, form: Form, out: &mut dyn Write) -> io::Result<Sink<'_>> {
    let mut sink = Sink::new(form, out);
    sink.line(format_args!("$MeshFormat\n{version} {} 8", i32::from(sink.is_binary())))?;
    if sink.is_binary() {
        sink.put(1_i32);
    }
    write_end("MeshFormat", &mut sink)?;
    Ok(sink)
}

/// Writes the line that ends a section.
pub(super) fn write_end(section: &str, sink: &mut Sink<'_>) -> io::Result<()> {
    if sink.is_binary() {
        // Behind the bytes of a block a line begins.
        sink.line(format_args!(""))?;
    }
    sink.line(format_args!("$End{section}"))
}
