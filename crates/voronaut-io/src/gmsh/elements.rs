//! Gmsh's elements: triangles, edges and points of the mesh, with their labels and marks.

use super::blocks::{Blocks, INT, Layout, SIZE};
use super::groups::{CORNER, Marks};
use super::reader::{Corners, Piece, Reader};
use crate::codec::At;
use crate::cutting::cut;
use crate::document::marked_mut;
use voronaut::{Error, Result};

impl Reader {
    /// Reads the section, behind its name.
    pub(super) fn read_elements(&mut self, from: &mut Blocks<'_>) -> Result<()> {
        self.demand_nodes("Elements", from)?;
        let is_two = from.layout == Layout::Two;
        let tags = if is_two { self.read_elements_2(from)? } else { self.read_elements_4(from)? };
        self.elements = from.index(&tags, "element", "Elements")?;
        if self.foreign.is_empty() {
            self.take_skin();
            return Ok(());
        }
        let counts: Vec<String> = self.foreign.iter().map(|(name, count)| format!("{count} {name}")).collect();
        let what = format!("{} ({})", counts.join(", "), from.source.place());
        let help =
            "give a mesh of triangles of order 1 to 3: in Gmsh mesh in 2 dimensions with Mesh.ElementOrder = 1, 2 or 3";
        Err(Error::unsupported(what, help))
    }

    /// Volumes are left out beside triangles; without them the mesh is their outside.
    fn take_skin(&mut self) {
        self.notes.extend(self.volumes.note(self.mesh.triangles.len()));
        if self.mesh.triangles.is_empty() {
            let skin = self.volumes.skin(&self.mesh.points);
            self.triangle_elements = skin.elements;
            (self.mesh.triangles, self.mesh.triangle_labels) = (skin.triangles, skin.labels);
        }
    }

    /// In text each element is a block of its own, with its tag in front.
    fn read_elements_2(&mut self, from: &mut Blocks<'_>) -> Result<Vec<u64>> {
        let (section, is_text, mut tags) = ("Elements", !from.source.is_binary(), Vec::new());
        let (_, total) = from.read_totals(section)?;
        while (tags.len() as u64) < total {
            let at = At { section, row: tags.len() as u64 + 1, rows: total };
            let first = if is_text { Some(from.tag(at)?) } else { None };
            let kind = read_kind(from, at)?;
            let count = if is_text { 1 } else { from.source.whole::<u32>(INT, at)?.into() };
            let attributes = from.source.whole(INT, at)?;
            for at in from.block(section, tags.len(), count, total)? {
                tags.push(first.map_or_else(|| from.tag(at), Ok)?);
                self.read_element_2(kind, attributes, tags.len() as u32 - 1, from, at)?;
            }
        }
        Ok(tags)
    }

    /// Reads an element behind its tag: attributes (physical group, entity, ...) and nodes. Gmsh repeats the elements that are in several
    /// groups, once for each: of these the mesh gets one.
    fn read_element_2(
        &mut self,
        kind: Kind,
        attributes: u32,
        element: u32,
        from: &mut Blocks<'_>,
        at: At<'_>,
    ) -> Result<()> {
        let mut known = [0; 2];
        for i in 0..attributes as usize {
            let attribute: i32 = from.source.whole(INT, at)?;
            if let Some(place) = known.get_mut(i) {
                *place = attribute;
            }
        }
        let [group, entity] = known;
        let Some(nodes) = self.read_corners(kind, from, at)? else { return Ok(()) };
        let group = (group != 0).then_some(group);
        let last = &mut self.last;
        if (kind.code, nodes, entity) == (last.code, last.nodes, last.entity)
            && group.is_some_and(|group| !last.groups.contains(&group))
            && (1..MOST_GROUPS).contains(&last.groups.len())
        {
            last.groups.extend(group);
        } else {
            let (code, index) = (kind.code, self.add(kind, nodes, element));
            self.last = Piece { code, nodes, entity, groups: group.into_iter().collect(), index };
        }
        let (label, marks) = self.groups.of(kind.dimension(), &self.last.groups, entity);
        self.label(kind, self.last.index, label, marks);
        Ok(())
    }

    fn read_elements_4(&mut self, from: &mut Blocks<'_>) -> Result<Vec<u64>> {
        let section = "Elements";
        let (blocks, total) = from.read_totals(section)?;
        let mut tags = Vec::new();
        for _ in 0..blocks {
            let at = At::head(section);
            let (dimension, entity) = from.read_entity(at)?;
            let kind = read_kind(from, at)?;
            let groups = self.entities.get(&(dimension, entity)).map(Vec::as_slice).unwrap_or_default();
            let (label, marks) = self.groups.of(dimension, groups, entity);
            let count = from.source.whole(SIZE, at)?;
            for at in from.block(section, tags.len(), count, total)? {
                tags.push(from.tag(at)?);
                if let Some(nodes) = self.read_corners(kind, from, at)? {
                    let index = self.add(kind, nodes, tags.len() as u32 - 1);
                    self.label(kind, index, label, marks);
                }
            }
        }
        from.demand_all(section, tags.len(), total)?;
        Ok(tags)
    }

    /// The nodes of an element; `None` of one of which a triangle mesh can hold nothing, which is counted.
    fn read_corners(&mut self, kind: Kind, from: &mut Blocks<'_>, at: At<'_>) -> Result<Option<Corners>> {
        let mut nodes = Corners::default();
        for i in 0..kind.nodes {
            let tag = from.tag(at)?;
            let Some(node) = self.nodes.find(tag) else {
                let help = "check the tag, and that the section Nodes is whole";
                return Err(from.source.error(format!("node {tag} does not exist ({at})"), help));
            };
            if let Some(place) = nodes.get_mut(i) {
                *place = node;
            }
        }
        let Shape::Foreign(name) = kind.shape else { return Ok(Some(nodes)) };
        *self.foreign.entry(name).or_default() += 1;
        Ok(None)
    }

    /// Takes an element in, and gives the number of the vertex, the edge, the first triangle or the cell of a volume that it is.
    fn add(&mut self, kind: Kind, nodes: Corners, element: u32) -> u32 {
        let (mesh, nodes) = (&mut self.mesh, &nodes[..kind.nodes]);
        match kind.shape {
            Shape::Edge => {
                mesh.edges.push([nodes[0], nodes[1]]);
                mesh.edge_labels.push(0);
                if let curve @ [_, ..] = &nodes[2..] {
                    self.raised.edge(mesh.edges.len() - 1, curve);
                }
                mesh.edges.len() as u32 - 1
            }
            Shape::Face | Shape::Curved => {
                let index = mesh.triangles.len();
                if matches!(kind.shape, Shape::Curved) {
                    mesh.triangles.push([nodes[0], nodes[1], nodes[2]]);
                    self.raised.triangle(&nodes[3..]);
                } else {
                    cut(&mesh.points, nodes, &mut mesh.triangles);
                }
                mesh.triangle_labels.resize(mesh.triangles.len(), 0);
                self.triangle_elements.resize(mesh.triangles.len(), element);
                index as u32
            }
            Shape::Solid => self.volumes.push(nodes, 0, element),
            Shape::Point | Shape::Foreign(_) => nodes[0],
        }
    }

    /// Labels and marks what [`Reader::add`] gave.
    fn label(&mut self, kind: Kind, index: u32, label: i32, marks: Marks) {
        let mesh = &mut self.mesh;
        let (labels, count) = match kind.shape {
            Shape::Point => (&mut mesh.point_labels, 1),
            Shape::Edge => (&mut mesh.edge_labels, 1),
            Shape::Face => (&mut mesh.triangle_labels, kind.nodes - 2),
            Shape::Curved => (&mut mesh.triangle_labels, 1),
            Shape::Solid | Shape::Foreign(_) => return self.volumes.label(index, label),
        };
        labels[index as usize..][..count].fill(label);
        // All points are, where no group says which.
        let is_corner = kind.code == POINT && !self.groups.marks.contains(CORNER);
        for (mark, list) in marked_mut(mesh).into_iter().enumerate() {
            if marks.contains(mark) || is_corner && mark == CORNER {
                list.extend((index..).take(count));
            }
        }
    }
}

fn read_kind(from: &mut Blocks<'_>, at: At<'_>) -> Result<Kind> {
    let code = from.source.whole(INT, at)?;
    Kind::of(code).ok_or_else(|| {
        let what = format!("elements of type {code} ({at}; {})", from.source.place());
        Error::unsupported(what, "give a mesh of triangles of order 1 to 3, edges and points")
    })
}

/// An element repeated more often than this is not taken for one in so many groups.
const MOST_GROUPS: usize = 256;

/// What is written, by order where there are several.
pub(super) const EDGES: [i32; 3] = [1, 8, 26];
pub(super) const TRIANGLES: [i32; 3] = [2, 9, 21];
pub(super) const POINT: i32 = 15;

/// A type of elements.
#[derive(Clone, Copy)]
struct Kind {
    /// What files call it.
    code: i32,
    /// How many nodes an element has.
    nodes: usize,
    shape: Shape,
}

/// What a triangle mesh makes of elements of a type.
#[derive(Clone, Copy)]
enum Shape {
    Point,
    /// An edge, its ends first.
    Edge,
    /// A triangle, or a quadrangle that is cut in two.
    Face,
    /// A curved triangle, its corners first.
    Curved,
    /// A cell with straight edges, of which the outside may be taken.
    Solid,
    /// Nothing: what such elements are called.
    Foreign(&'static str),
}

impl Kind {
    /// The type that files call `code`; `None` of others.
    fn of(code: i32) -> Option<Self> {
        let nodes = match code {
            36 => 16,
            92 => 64,
            93 => 125,
            _ => *NODES.get(usize::try_from(code).ok()?.checked_sub(1)?)?,
        };
        let shape = match code {
            POINT => Shape::Point,
            1 | 8 | 26 => Shape::Edge,
            2 | 3 => Shape::Face,
            9 | 21 => Shape::Curved,
            4..=7 => Shape::Solid,
            27 | 28 => Shape::Foreign("curved edges of order 4 or 5"),
            20 | 22..=25 => Shape::Foreign("curved triangles of order 4 or 5, or without inner nodes"),
            10 | 16 | 36 => Shape::Foreign("curved quadrangles"),
            _ => Shape::Foreign("curved volume elements"),
        };
        Some(Self { code, nodes, shape })
    }

    fn dimension(self) -> u8 {
        match self.shape {
            Shape::Point => 0,
            Shape::Edge => 1,
            Shape::Face | Shape::Curved => 2,
            Shape::Solid | Shape::Foreign(_) => 3,
        }
    }
}

/// How many nodes elements of types 1 to 31 have, after "Node ordering" and "MSH file format" of Gmsh's manual.
const NODES: [usize; 31] =
    [2, 3, 4, 4, 8, 6, 5, 3, 6, 9, 10, 27, 18, 14, 1, 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5, 6, 20, 35, 56];
