//! Curved triangles and edges as files have them: elements list their nodes behind their corners, in the order of [`Curved`], and all
//! nodes are points like vertices. So it is in Gmsh's files, in VTK's and, by default, in Medit's.

use super::codec::Place;
use super::document::Row;
use super::{Document, Fields};
use std::borrow::Cow;
use std::io;
use voronaut::mesh::{Curved, Edges, Mesh};
use voronaut::{Error, Result};

/// Where the nodes of a triangle of order 2 are, by their barycentric coordinates, times the order: corners first.
const QUADRATIC: [[u8; 3]; 6] = [[2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 1, 0], [0, 1, 1], [1, 0, 1]];

/// As [`QUADRATIC`], of order 3.
const CUBIC: [[u8; 3]; 10] =
    [[3, 0, 0], [0, 3, 0], [0, 0, 3], [2, 1, 0], [1, 2, 0], [0, 2, 1], [0, 1, 2], [1, 0, 2], [2, 0, 1], [1, 1, 1]];

/// Barycentric coordinates of the nodes of a triangle, times its order (1 to 3): corners first.
pub(super) fn places(order: usize) -> &'static [[u8; 3]] {
    const LINEAR: &[[u8; 3]] = &[[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    [LINEAR, &QUADRATIC, &CUBIC][order - 1]
}

/// Curved elements as a reader finds them, by the numbers of points.
#[derive(Default)]
pub(super) struct Raised {
    /// Of each curved triangle the points behind its corners.
    triangles: Vec<u32>,
    /// How many triangles there are of order 2, and of order 3.
    counts: [usize; 2],
    /// Curved edges by their numbers in the mesh, and the points behind their ends.
    edges: Vec<(u32, Vec<u32>)>,
}

impl Raised {
    /// The next triangle of the mesh is curved, and has these 3 or 7 nodes behind its corners.
    pub(super) fn triangle(&mut self, nodes: &[u32]) {
        self.triangles.extend(nodes);
        self.counts[usize::from(nodes.len() > 3)] += 1;
    }

    /// An edge of the mesh is curved, and has these 1 or 2 nodes behind its ends.
    pub(super) fn edge(&mut self, edge: usize, nodes: &[u32]) {
        self.edges.push((edge as u32, nodes.to_vec()));
    }

    /// Appends the elements of a mesh that is appended to one with so many points and edges.
    pub(super) fn append(&mut self, other: Self, points: u32, edges: u32) {
        let moved = |nodes: Vec<u32>| nodes.into_iter().map(|node| node + points);
        self.triangles.extend(moved(other.triangles));
        self.edges.extend(other.edges.into_iter().map(|(edge, nodes)| (edge + edges, moved(nodes).collect())));
        self.counts = [0, 1].map(|i| self.counts[i] + other.counts[i]);
    }

    /// Makes the nodes of a document's mesh what they are, where they are points like vertices. Values there are left out with a note.
    ///
    /// # Errors
    /// [`Error::Unsupported`] of triangles of different orders; [`Error::Parse`] of nodes that are vertices elsewhere, and of curved
    /// edges that are not those of a triangle.
    pub(super) fn finish(self, document: &mut Document, place: Place<'_>) -> Result<()> {
        if self.edges.is_empty() && self.triangles.is_empty() {
            return Ok(());
        }
        let order = self.order(&document.mesh, place.file)?;
        let vertices = self.vertices(&document.mesh, place)?;
        renumber(&mut document.mesh, &vertices, self.triangles, order);
        let edges = self.edges.iter().map(|(edge, nodes)| (*edge, nodes.as_slice()));
        demand_sides(&document.mesh, edges, &vertices, place)?;
        document.mesh.check_numbers().map_err(|error| place.error(error.to_string(), error.help()))?;
        let inside = vertices.iter().filter(|vertex| vertex.is_err()).count();
        if inside > 0 && !document.fields.vertices.is_empty() {
            let kept: Vec<Row> = (0..).zip(&vertices).filter(|(_, v)| v.is_ok()).map(|(i, _)| vec![(i, 1.0)]).collect();
            document.fields.vertices.iter_mut().for_each(|field| *field = field.combined(&kept));
            document
                .notes
                .push(format!("values at {inside} nodes of curved triangles that are no vertices are left out"));
        }
        Ok(())
    }

    /// The order of all triangles.
    fn order(&self, mesh: &Mesh, file: &str) -> Result<usize> {
        let counts = [mesh.triangles.len() - self.counts.iter().sum::<usize>(), self.counts[0], self.counts[1]];
        let mut there = (1..).zip(counts).filter(|(_, count)| *count > 0);
        match (there.next(), there.next()) {
            (Some((order @ 2.., _)), None) => Ok(order),
            (Some((one, few)), Some((other, many))) => {
                let what = format!("{few} triangles of order {one} beside {many} of order {other} in {file}");
                Err(Error::unsupported(what, "give all triangles the same order"))
            }
            _ => {
                let what = format!("{} curved edges without curved triangles in {file}", self.edges.len());
                Err(Error::unsupported(what, "give a mesh of curved triangles, or straight edges"))
            }
        }
    }

    /// The number of each point among the vertices, or else among the nodes.
    fn vertices(&self, mesh: &Mesh, place: Place<'_>) -> Result<Vec<Number>> {
        let mut is_node = vec![false; mesh.points.len()];
        for &node in self.triangles.iter().chain(self.edges.iter().flat_map(|(_, nodes)| nodes)) {
            is_node[node as usize] = true;
        }
        let corners = mesh.triangles.as_flattened().iter().chain(mesh.edges.as_flattened());
        let mut all = corners.chain(&mesh.corners).chain(&mesh.required_points);
        if let Some(both) = all.find(|&&v| is_node[v as usize]) {
            let what = format!("point {} (from 1) is a vertex, and a node inside a curved element", both + 1);
            return Err(place.error(what, "give curved elements nodes of their own"));
        }
        let mut next = [0; 2];
        let number = |is_node: bool| {
            let number = next[usize::from(is_node)];
            next[usize::from(is_node)] += 1;
            if is_node { Err(number) } else { Ok(number) }
        };
        Ok(is_node.into_iter().map(number).collect())
    }
}

/// What a point is: a vertex, or else a node, by its number among them.
type Number = std::result::Result<u32, u32>;

/// Separates vertices from nodes, and numbers them in the order of the points.
fn renumber(mesh: &mut Mesh, numbers: &[Number], triangles: Vec<u32>, order: usize) {
    let points = std::mem::take(&mut mesh.points);
    let mut nodes = Vec::new();
    for (point, number) in points.into_iter().zip(numbers) {
        if number.is_ok() { mesh.points.push(point) } else { nodes.push(point) }
    }
    let mut numbered = numbers.iter();
    mesh.point_labels.retain(|_| numbered.next().is_some_and(std::result::Result::is_ok));
    let either = |v: &mut u32| *v = numbers[*v as usize].unwrap_or_else(|node| node);
    mesh.triangles.as_flattened_mut().iter_mut().for_each(either);
    mesh.edges.as_flattened_mut().iter_mut().for_each(either);
    mesh.corners.iter_mut().chain(&mut mesh.required_points).for_each(either);
    let mut triangles = triangles;
    triangles.iter_mut().for_each(either);
    mesh.curved = Some(Curved { order, nodes, triangles });
}

/// Refuses curved edges that have other nodes than the triangles beside them, or no such triangle.
fn demand_sides<'a>(
    mesh: &Mesh,
    edges: impl Iterator<Item = (u32, &'a [u32])>,
    numbers: &[Number],
    place: Place<'_>,
) -> Result<()> {
    let Ok(elements) = Elements::new(mesh) else {
        let what = "an edge that no curved triangle has";
        return Err(place.error(what, "list edges of triangles alone, or straight triangles"));
    };
    for (edge, nodes) in edges {
        let own = nodes.iter().map(|&node| numbers[node as usize].unwrap_or_else(|node| node));
        if !own.eq(elements.between(edge as usize).iter().copied()) {
            let [a, b] = mesh.edges[edge as usize].map(|v| v + 1);
            let what = format!("the curved edge between vertices {a} and {b} has other nodes than its triangle");
            return Err(place.error(what, "let edges and triangles share their nodes"));
        }
    }
    Ok(())
}

/// The elements of a mesh that is written: their points are its vertices, and then the nodes of curved triangles.
pub(super) struct Elements<'a> {
    mesh: &'a Mesh,
    /// Of vertices, then of nodes.
    pub(super) points: Cow<'a, [[f64; 3]]>,
    /// The order of triangles and edges.
    pub(super) order: usize,
    /// Of each edge the nodes between its ends, in its direction.
    edges: Vec<u32>,
}

impl<'a> Elements<'a> {
    /// # Errors
    /// Of a curved mesh with edges that no triangle has.
    pub(super) fn new(mesh: &'a Mesh) -> io::Result<Self> {
        let Some(curved) = &mesh.curved else { return Ok(Self::of_corners(mesh)) };
        let points = Cow::Owned([mesh.points.as_slice(), &curved.nodes].concat());
        let mut elements = Self { mesh, points, order: curved.order, edges: Vec::new() };
        let sides = Edges::of(&mesh.triangles);
        for &ends in &mesh.edges {
            let Some(side) = sides.at(ends).first().copied() else {
                let [a, b] = ends.map(|v| v + 1);
                let what = format!("the edge between vertices {a} and {b} is of no triangle, and so without curve");
                return Err(io::Error::other(what));
            };
            let (start, count) = ((side.half_edge as usize % 3) * (curved.order - 1), curved.order - 1);
            let nodes = &elements.inside(side.triangle())[start..][..count];
            // The side runs from the smaller end to the larger one, or the other way round.
            let is_same_way = side.forward == (ends[0] < ends[1]);
            let nodes: Vec<u32> = if is_same_way { nodes.to_vec() } else { nodes.iter().rev().copied().collect() };
            elements.edges.extend(nodes);
        }
        Ok(elements)
    }

    /// The elements as if they were straight.
    pub(super) fn of_corners(mesh: &'a Mesh) -> Self {
        Self { mesh, points: Cow::Borrowed(&mesh.points), order: 1, edges: Vec::new() }
    }

    /// The points of a vertex, an edge or a triangle: corners first.
    pub(super) fn nodes<'b>(
        &'b self,
        dimension: u8,
        element: &'b u32,
    ) -> impl Iterator<Item = u32> + Clone + use<'b, 'a> {
        let (corners, inside): (&[u32], &[u32]) = match dimension {
            0 => (std::slice::from_ref(element), &[]),
            1 => (&self.mesh.edges[*element as usize], self.between(*element as usize)),
            _ => (&self.mesh.triangles[*element as usize], self.inside(*element as usize)),
        };
        let first = self.mesh.points.len() as u32;
        corners.iter().copied().chain(inside.iter().map(move |node| first + node))
    }

    /// Fields with values at nodes, too: what is linear on triangles stays so.
    pub(super) fn fields(&self, fields: &'a Fields) -> Cow<'a, Fields> {
        if self.order == 1 || fields.vertices.is_empty() {
            return Cow::Borrowed(fields);
        }
        let mut rows: Vec<Row> = (0..self.points.len() as u32).map(|v| vec![(v, 1.0)]).collect();
        for (i, corners) in self.mesh.triangles.iter().enumerate() {
            for (node, place) in self.inside(i).iter().zip(&places(self.order)[3..]) {
                let weighted = corners.iter().zip(place).filter(|(_, weight)| **weight > 0);
                let weight = |weight: u8| f64::from(weight) / self.order as f64;
                rows[self.mesh.points.len() + *node as usize] = weighted.map(|(&v, &w)| (v, weight(w))).collect();
            }
        }
        // A node that no triangle has is like the first vertex.
        let count = self.mesh.points.len() as u32;
        rows.iter_mut().filter(|row| row.iter().any(|(v, _)| *v >= count)).for_each(|row| *row = vec![(0, 1.0)]);
        let vertices = fields.vertices.iter().map(|field| field.combined(&rows)).collect();
        Cow::Owned(Fields { vertices, triangles: fields.triangles.clone() })
    }

    fn inside(&self, triangle: usize) -> &[u32] {
        let Some(curved) = self.mesh.curved.as_ref().filter(|_| self.order > 1) else { return &[] };
        let count = places(curved.order).len() - 3;
        &curved.triangles[triangle * count..][..count]
    }

    fn between(&self, edge: usize) -> &[u32] {
        let count = self.order - 1;
        &self.edges[edge * count..][..count]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gmsh::Version;
    use crate::medit::Form;
    use crate::{Field, Format};
    use voronaut::mesh::SolutionValues;

    const FORMATS: [Format; 7] = [
        Format::Medit(Form::Text),
        Format::Medit(Form::Binary),
        Format::Gmsh(Version::V4_1, Form::Text),
        Format::Gmsh(Version::V4_1, Form::Binary),
        Format::Gmsh(Version::V2_2, Form::Text),
        Format::Gmsh(Version::V2_2, Form::Binary),
        Format::Vtu,
    ];

    /// A square in two triangles, with labelled edges in the direction of their triangle and against it, sorted by label.
    fn square(order: usize, z: f64) -> Document {
        let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, z], [0.0, 1.0, 0.0]];
        let triangles = vec![[0, 1, 2], [2, 3, 0]];
        let inside = if order == 2 { vec![0, 1, 2, 3, 4, 2] } else { vec![0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 5, 4, 11] };
        let count = if order == 2 { 5 } else { 12 };
        let nodes = (0..count).map(|i| [f64::from(i) / 3.0, 1e-300, z / f64::from(i + 1)]).collect();
        let mesh = Mesh {
            points: corners.to_vec(),
            point_labels: vec![0, 3, 0, -2],
            triangles,
            triangle_labels: vec![1, 2],
            edges: vec![[0, 1], [2, 1], [0, 2], [0, 3]],
            edge_labels: vec![5, 6, 7, 8],
            corners: vec![1, 3],
            required_points: vec![2],
            curved: Some(Curved { order, nodes, triangles: inside }),
            ..Mesh::default()
        };
        let field = Field { name: "u".into(), values: SolutionValues::Scalar(vec![0.1, -0.0, 1e300, 4.0]) };
        Document { fields: Fields { vertices: vec![field], triangles: Vec::new() }, ..mesh.into() }
    }

    fn read_back(format: Format, document: &Document) -> Document {
        let mut bytes = Vec::new();
        format.write(&document.mesh, &document.fields, &mut bytes).unwrap();
        format.read(bytes.as_slice(), "a").unwrap()
    }

    #[test]
    fn every_format_reads_back_the_same_bits() {
        for (format, (order, z)) in
            FORMATS.into_iter().flat_map(|f| [2, 3].map(|o| (f, (o, 0.0)))).chain([(Format::Vtu, (3, 0.5))])
        {
            let given = square(order, z);
            let found = read_back(format, &given);
            assert_eq!(found.mesh, given.mesh, "{format:?} {order}");
            if !matches!(format, Format::Medit(_)) {
                assert_eq!(found.fields, given.fields, "{format:?} {order}");
                let nodes = given.mesh.curved.as_ref().unwrap().nodes.len();
                let note = format!("values at {nodes} nodes of curved triangles that are no vertices are left out");
                assert_eq!(found.notes, [note]);
            }
        }
    }

    #[test]
    fn values_at_nodes_lie_between_those_at_corners() {
        let Document { mesh, fields, .. } = square(3, 0.0);
        let elements = Elements::new(&mesh).unwrap();
        let values = elements.fields(&fields).vertices[0].values.clone();
        let at = |point: usize| values.row(point)[0];
        // From 0.1 to -0.0, and the mean of 0.1, -0.0 and 1e300.
        for (point, truth) in [(4, 0.2 / 3.0), (5, 0.1 / 3.0), (10, 1e300 / 3.0)] {
            assert!((at(point) - truth).abs() <= 1e-15 * truth, "{point}");
        }
        assert_eq!(values.count(), 16);
    }

    #[test]
    fn other_formats_have_no_place_for_curves() {
        let Document { mesh, fields, .. } = square(2, 0.0);
        for format in [Format::Obj, Format::Off, Format::Ply(Form::Binary), Format::Stl, Format::Su2, Format::Vtp] {
            let error = format.demand_order(2).unwrap_err();
            assert!(error.to_string().contains("triangles of order 2 in a file .") && error.help().contains(".msh"));
            assert!(format.demand_order(1).is_ok());
            assert!(format.write(&mesh, &fields, &mut Vec::new()).is_err());
        }
    }

    #[test]
    fn an_edge_without_triangle_has_no_curve() {
        let mut mesh = square(2, 0.0).mesh;
        mesh.edges.push([1, 3]);
        let error = Elements::new(&mesh).err().unwrap().to_string();
        assert_eq!(error, "the edge between vertices 2 and 4 is of no triangle, and so without curve");
    }

    /// A `.mesh` of a triangle of order 2 and more sections.
    fn message(sections: &str) -> String {
        let points = "0 0 0 1 0 0 0 1 0 .5 0 0 .5 .5 0 0 .5 0 7 7 0 8 8 0";
        let text = format!("MeshVersionFormatted 2 Dimension 2\nVertices 8 {points}\n{sections}\nEnd");
        let error = Format::Medit(Form::Text).read(text.as_bytes(), "a.mesh").unwrap_err();
        assert!(!error.help().is_empty());
        error.to_string()
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let curved = "TrianglesP2 1 1 2 3 4 5 6 0\n";
        for (sections, expected) in [
            ("Triangles 1 1 2 7 0", "1 triangles of order 1 beside 1 of order 2 in a.mesh"),
            ("TrianglesP3 1 1 2 3 4 5 6 4 5 6 7 0", "1 triangles of order 2 beside 1 of order 3 in a.mesh"),
            ("EdgesP2 1 1 2 5 0", "the curved edge between vertices 1 and 2 has other nodes than its triangle"),
            ("EdgesP2 1 1 7 8 0", "an edge that no curved triangle has"),
            ("EdgesP3 1 1 2 4 8 0", "the curved edge between vertices 1 and 2 has other nodes than its triangle"),
            ("EdgesP2 1 1 2 3 0", "point 3 (from 1) is a vertex, and a node inside a curved element"),
            ("Corners 1 5", "point 5 (from 1) is a vertex, and a node inside a curved element"),
            ("Edges 1 1 2 0\nEdgesP2 1 1 2 4 0", "EdgesP2 beside edges of another order in a.mesh"),
            ("BezierBasis 1", "curved elements by Bézier points (BezierBasis in a.mesh:4)"),
            ("TrianglesP2Ordering 5\n2 0 0 0 2 0 0 0 2 1 1 0 0 1 1", "a.mesh:5: TrianglesP2Ordering has 5 rows"),
            (
                "TrianglesP2Ordering 6\n2 0 0\n0 2 0\n0 0 2\n1 1 0\n1 1 0\n1 0 1",
                "a.mesh:9: a node that elements do not",
            ),
        ] {
            let found = message(&format!("{curved}{sections}"));
            assert!(found.contains(expected) && found.contains("a.mesh"), "{sections}: {found}");
        }
        let torn = message("TrianglesP2 2 1 2 3 4 5 6 0 2 1 7 8 5 6 0");
        assert!(torn.contains("the triangles beside the edge 1-2 have different nodes"), "{torn}");
        let alone = message("EdgesP2 1 1 2 4 0");
        assert!(alone.contains("1 curved edges without curved triangles in a.mesh"), "{alone}");
    }

    #[test]
    fn orders_of_files_are_followed() {
        let text = "MeshVersionFormatted 2 Dimension 2\nVertices 6 .5 0 0 0 0 0 1 0 0 0 1 0 .5 .5 0 0 .5 0\nTrianglesP2Ordering 6
            1 1 0 2 0 0 0 2 0 0 0 2 0 1 1 1 0 1\nTrianglesP2 1 1 2 3 4 5 6 9\nEdgesP2 1 1 2 3 8\nEdgesP2Ordering 3 1 0 2\nBezierBasis 0 End";
        let mesh = Format::Medit(Form::Text).read(text.as_bytes(), "a").unwrap().mesh;
        assert_eq!((mesh.points[0], mesh.triangles, mesh.edges), ([0.0; 3], vec![[0, 1, 2]], vec![[0, 1]]));
        let curved = mesh.curved.unwrap();
        assert_eq!((curved.nodes[0], curved.triangles), ([0.5, 0.0, 0.0], vec![0, 1, 2]));
        assert_eq!((mesh.edge_labels, mesh.triangle_labels), (vec![8], vec![9]));
    }
}
