//! Gmsh's sections, read in turn into a mesh.

use super::data;
use super::groups::{Groups, Mark, Marks};
use super::kinds::{EDGE, Kind, POINT, QUADRANGLE, TRIANGLE};
use super::source::Source;
use super::tags::Tags;
use crate::error::{Error, Result};
use crate::formats::words::{At, shortened};
use crate::formats::{Document, Fields};
use crate::mesh::Mesh;
use std::collections::BTreeMap;

/// How the sections of a file are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Layout {
    /// Versions 2 to 2.2: elements with their tags.
    Two,
    /// Version 4.0: blocks of entities.
    Four,
    /// Version 4.1: blocks of entities, tags in 64 bits.
    FourOne,
}

/// A file, as far as it is read.
pub(super) struct Reader<'a> {
    pub(super) source: Source<'a>,
    layout: Layout,
    seen: Vec<&'static str>,
    groups: Groups,
    /// The physical groups of entities, by dimension and tag.
    entities: BTreeMap<(u8, i32), Vec<i32>>,
    pub(super) nodes: Tags,
    pub(super) elements: Tags,
    /// The element that each triangle comes from, counted in the order of the file.
    pub(super) triangle_elements: Vec<u32>,
    /// Elements that a triangle mesh cannot hold.
    foreign: BTreeMap<&'static str, u64>,
    pub(super) mesh: Mesh,
    pub(super) fields: Fields,
}

/// An element of the file that is in the mesh.
#[derive(Default)]
struct Piece {
    code: i32,
    nodes: [u32; 4],
    entity: i32,
    groups: Vec<i32>,
    /// Which of the mesh's vertices, edges or triangles it is, or begins with.
    index: u32,
}

/// Sections that are read once; `NodeData` and `ElementData` are read as often as they come, all others are passed over.
const SECTIONS: [&str; 4] = ["PhysicalNames", "Entities", "Nodes", "Elements"];

impl<'a> Reader<'a> {
    /// Reads the head of a file.
    ///
    /// # Errors
    /// [`Error::Parse`] of what is none; [`Error::Unsupported`] of versions but 2 to 2.2, 4.0 and 4.1.
    pub(super) fn new(mut source: Source<'a>) -> Result<Self> {
        loop {
            match source.next_section()?.as_deref() {
                Some("MeshFormat") => break,
                Some("NOD") => return Err(unsupported("version 1", &source)),
                Some(other) => source.skip_section(other)?,
                None => return Err(source.error("the file has no section MeshFormat", "give a file that Gmsh wrote")),
            }
        }
        let layout = read_format(&mut source)?;
        Ok(Self {
            source,
            layout,
            seen: Vec::new(),
            groups: Groups::default(),
            entities: BTreeMap::new(),
            nodes: Tags::default(),
            elements: Tags::default(),
            triangle_elements: Vec::new(),
            foreign: BTreeMap::new(),
            mesh: Mesh::default(),
            fields: Fields::default(),
        })
    }

    /// Reads the sections behind the head.
    pub(super) fn read(mut self) -> Result<Document> {
        while let Some(section) = self.source.next_section()? {
            self.read_section(&section)?;
        }
        if !self.seen.contains(&"Nodes") {
            let what = "the file has no section Nodes";
            return Err(self.source.error(what, "save the mesh with the views; check that the file is whole"));
        }
        let mesh = &mut self.mesh;
        let marked = [&mut mesh.corners, &mut mesh.required_points, &mut mesh.ridges, &mut mesh.required_edges];
        for list in marked.into_iter().chain([&mut mesh.required_triangles]) {
            list.sort_unstable();
            list.dedup();
        }
        Ok(Document { mesh: self.mesh, fields: self.fields })
    }

    fn read_section(&mut self, section: &str) -> Result<()> {
        match section {
            "NodeData" | "ElementData" => {
                self.demand_nodes(section)?;
                data::read(self, section)?;
                return self.source.end_section(section);
            }
            "PartitionedEntities" => return Err(unsupported("a mesh in partitions", &self.source)),
            "ParametricNodes" => return Err(unsupported("nodes with parameters in version 2", &self.source)),
            _ => {}
        }
        let Some(&name) = SECTIONS.iter().find(|name| **name == section) else {
            return self.source.skip_section(section);
        };
        if self.seen.contains(&name) {
            return Err(self.source.error(format!("a second section {name}"), "join both sections into one"));
        }
        self.seen.push(name);
        match name {
            "PhysicalNames" => self.read_names()?,
            "Entities" => self.read_entities()?,
            "Nodes" => self.read_nodes()?,
            _ => self.read_elements()?,
        }
        self.source.end_section(name)
    }

    fn demand_nodes(&self, section: &str) -> Result<()> {
        let what = if !self.seen.contains(&"Nodes") {
            format!("{section} comes before Nodes")
        } else if section == "Elements" && !(self.fields.vertices.is_empty() && self.fields.triangles.is_empty()) {
            "Elements comes behind the values on them".to_owned()
        } else {
            return Ok(());
        };
        Err(self.source.error(what, "save the sections in the order Nodes, Elements, NodeData, ElementData"))
    }

    fn read_names(&mut self) -> Result<()> {
        let section = "PhysicalNames";
        let count = self.source.text(At::head(section))?;
        for at in At::rows(section, count) {
            let (dimension, tag) = (self.source.text(at)?, self.source.text(at)?);
            let name = self.source.rest_of_line(at)?;
            self.groups.name(dimension, tag, name.trim_matches('"'));
        }
        Ok(())
    }

    fn read_entities(&mut self) -> Result<()> {
        let (section, source) = ("Entities", &mut self.source);
        let mut counts = [0; 4];
        for count in &mut counts {
            *count = source.size(At::head(section))?;
        }
        for (dimension, count) in (0..).zip(counts) {
            for at in At::rows(section, count) {
                let tag = source.int(at)?;
                let corners = if dimension == 0 && self.layout == Layout::FourOne { 1 } else { 2 };
                source.skip_numbers(3 * corners, at)?;
                let mut groups = Vec::new();
                for _ in 0..source.size(at)? {
                    // A negative tag turns the entity round.
                    groups.push(source.int::<i32>(at)?.saturating_abs());
                }
                let bounds = if dimension == 0 { 0 } else { source.size(at)? };
                for _ in 0..bounds {
                    source.int::<i32>(at)?;
                }
                if !groups.is_empty() {
                    self.entities.insert((dimension, tag), groups);
                }
            }
        }
        Ok(())
    }

    fn read_nodes(&mut self) -> Result<()> {
        let tags = if self.layout == Layout::Two { self.read_nodes_2()? } else { self.read_nodes_4()? };
        self.nodes = self.index(&tags, "node", "Nodes")?;
        self.mesh.point_labels = vec![0; tags.len()];
        Ok(())
    }

    fn read_nodes_2(&mut self) -> Result<Vec<u64>> {
        let section = "Nodes";
        let (count, mut tags) = (self.source.text(At::head(section))?, Vec::new());
        for at in At::rows(section, count) {
            tags.push(self.tag(at)?);
            self.read_point(0, at)?;
        }
        Ok(tags)
    }

    fn read_nodes_4(&mut self) -> Result<Vec<u64>> {
        let section = "Nodes";
        let (blocks, total) = self.read_totals(section)?;
        let mut tags = Vec::new();
        for _ in 0..blocks {
            let at = At::head(section);
            let (dimension, _) = self.read_entity(at)?;
            let is_parametric = self.source.int::<i32>(at)? != 0;
            let parameters = if is_parametric { u64::from(dimension) } else { 0 };
            let count = self.source.size(at)?;
            let before = tags.len() as u64;
            self.demand_room(section, before, count, total)?;
            let rows = || (before + 1..=before + count).map(|row| At { section, row, rows: total });
            if self.layout == Layout::FourOne {
                for at in rows() {
                    tags.push(self.tag(at)?);
                }
            }
            for at in rows() {
                if self.layout == Layout::Four {
                    tags.push(self.tag(at)?);
                }
                self.read_point(parameters, at)?;
            }
        }
        self.demand_all(section, tags.len() as u64, total)?;
        Ok(tags)
    }

    fn read_point(&mut self, parameters: u64, at: At<'_>) -> Result<()> {
        let source = &mut self.source;
        self.mesh.points.push([source.number(at)?, source.number(at)?, source.number(at)?]);
        source.skip_numbers(parameters, at)
    }

    fn read_elements(&mut self) -> Result<()> {
        self.demand_nodes("Elements")?;
        let tags = match (self.layout, self.source.is_binary()) {
            (Layout::Two, false) => self.read_elements_2()?,
            (Layout::Two, true) => self.read_binary_elements_2()?,
            _ => self.read_elements_4()?,
        };
        self.elements = self.index(&tags, "element", "Elements")?;
        if self.foreign.is_empty() {
            return Ok(());
        }
        let counts: Vec<String> = self.foreign.iter().map(|(name, count)| format!("{count} {name}")).collect();
        let what = format!("{} ({})", counts.join(", "), self.source.place());
        let help = "give a mesh of straight triangles: in Gmsh mesh in 2 dimensions with Mesh.ElementOrder = 1";
        Err(Error::Unsupported { what, help: help.into() })
    }

    fn read_elements_2(&mut self) -> Result<Vec<u64>> {
        let section = "Elements";
        let count = self.source.text(At::head(section))?;
        let (mut tags, mut last) = (Vec::new(), Piece::default());
        for at in At::rows(section, count) {
            tags.push(self.tag(at)?);
            let kind = self.read_kind(at)?;
            let attributes = self.source.int(at)?;
            self.read_element_2(kind, attributes, &mut last, tags.len() as u32 - 1, at)?;
        }
        Ok(tags)
    }

    fn read_binary_elements_2(&mut self) -> Result<Vec<u64>> {
        let section = "Elements";
        let total = self.source.text(At::head(section))?;
        let (mut tags, mut last) = (Vec::new(), Piece::default());
        while (tags.len() as u64) < total {
            let done = tags.len() as u64;
            let at = At { section, row: done + 1, rows: total };
            let kind = self.read_kind(at)?;
            let count = self.source.int::<u32>(at)?.into();
            let attributes = self.source.int(at)?;
            self.demand_room(section, done, count, total)?;
            for row in done + 1..=done + count {
                let at = At { section, row, rows: total };
                tags.push(self.tag(at)?);
                self.read_element_2(kind, attributes, &mut last, tags.len() as u32 - 1, at)?;
            }
        }
        Ok(tags)
    }

    /// Reads an element behind its tag: attributes (physical group, entity, ...) and nodes. Gmsh repeats the elements that are in several
    /// groups, once for each: of these the mesh gets one.
    fn read_element_2(&mut self, kind: Kind, attributes: u32, last: &mut Piece, element: u32, at: At<'_>) -> Result<()> {
        let mut known = [0; 2];
        for i in 0..attributes as usize {
            let attribute: i32 = self.source.int(at)?;
            if let Some(place) = known.get_mut(i) {
                *place = attribute;
            }
        }
        let [group, entity] = known;
        let Some(nodes) = self.read_corners(kind, at)? else { return Ok(()) };
        let group = (group != 0).then_some(group);
        if (kind.code, nodes, entity) == (last.code, last.nodes, last.entity)
            && group.is_some_and(|group| !last.groups.contains(&group))
            && !last.groups.is_empty()
        {
            last.groups.extend(group);
        } else {
            let index = self.add(kind, nodes, element);
            *last = Piece { code: kind.code, nodes, entity, groups: group.into_iter().collect(), index };
        }
        let (label, marks) = self.groups.of(dimension_of(kind.code), &last.groups, entity);
        self.label(kind.code, last.index, label, marks);
        Ok(())
    }

    fn read_elements_4(&mut self) -> Result<Vec<u64>> {
        let section = "Elements";
        let (blocks, total) = self.read_totals(section)?;
        let mut tags = Vec::new();
        for _ in 0..blocks {
            let at = At::head(section);
            let (dimension, entity) = self.read_entity(at)?;
            let kind = self.read_kind(at)?;
            let groups = self.entities.get(&(dimension, entity)).map(Vec::as_slice).unwrap_or_default();
            let (label, marks) = self.groups.of(dimension, groups, entity);
            let (before, count) = (tags.len() as u64, self.source.size(at)?);
            self.demand_room(section, before, count, total)?;
            for row in before + 1..=before + count {
                let at = At { section, row, rows: total };
                tags.push(self.tag(at)?);
                if let Some(nodes) = self.read_corners(kind, at)? {
                    let index = self.add(kind, nodes, tags.len() as u32 - 1);
                    self.label(kind.code, index, label, marks);
                }
            }
        }
        self.demand_all(section, tags.len() as u64, total)?;
        Ok(tags)
    }

    fn read_kind(&mut self, at: At<'_>) -> Result<Kind> {
        let code = self.source.int(at)?;
        Kind::of(code).ok_or_else(|| {
            let what = format!("elements of type {code} ({at}; {})", self.source.place());
            Error::Unsupported { what, help: "give a mesh of straight triangles, edges and points".into() }
        })
    }

    /// The nodes of an element; `None` of one that a triangle mesh cannot hold, which is counted.
    fn read_corners(&mut self, kind: Kind, at: At<'_>) -> Result<Option<[u32; 4]>> {
        let mut nodes = [0; 4];
        for i in 0..kind.nodes {
            let tag = self.tag(at)?;
            let Some(node) = self.nodes.find(tag) else {
                let help = "check the tag, and that the section Nodes is whole";
                return Err(self.source.error(format!("node {tag} does not exist ({at})"), help));
            };
            if let Some(place) = nodes.get_mut(i) {
                *place = node;
            }
        }
        if kind.is_flat() {
            return Ok(Some(nodes));
        }
        *self.foreign.entry(kind.name).or_default() += 1;
        Ok(None)
    }

    /// Takes an element into the mesh, and gives the number of the vertex, the edge or the first triangle that it is.
    fn add(&mut self, kind: Kind, [a, b, c, d]: [u32; 4], element: u32) -> u32 {
        let mesh = &mut self.mesh;
        match kind.code {
            POINT => a,
            EDGE => {
                mesh.edges.push([a, b]);
                mesh.edge_labels.push(0);
                mesh.edges.len() as u32 - 1
            }
            _ => {
                let index = mesh.triangles.len();
                mesh.triangles.push([a, b, c]);
                if kind.code == QUADRANGLE {
                    mesh.triangles.push([a, c, d]);
                }
                mesh.triangle_labels.resize(mesh.triangles.len(), 0);
                self.triangle_elements.resize(mesh.triangles.len(), element);
                index as u32
            }
        }
    }

    /// Labels and marks what [`Reader::add`] gave.
    fn label(&mut self, code: i32, index: u32, label: i32, marks: Marks) {
        let all_are_corners = !self.groups.have(Mark::Corner);
        let mesh = &mut self.mesh;
        let mut mark = |list: &mut Vec<u32>, mark| {
            if marks.contains(mark) {
                list.push(index);
            }
        };
        match code {
            POINT => {
                mesh.point_labels[index as usize] = label;
                mark(&mut mesh.corners, Mark::Corner);
                mark(&mut mesh.required_points, Mark::RequiredVertex);
                if all_are_corners {
                    mesh.corners.push(index);
                }
            }
            EDGE => {
                mesh.edge_labels[index as usize] = label;
                mark(&mut mesh.ridges, Mark::Ridge);
                mark(&mut mesh.required_edges, Mark::RequiredEdge);
            }
            _ => {
                let count = if code == QUADRANGLE { 2 } else { 1 };
                mesh.triangle_labels[index as usize..][..count].fill(label);
                mark(&mut mesh.required_triangles, Mark::RequiredTriangle);
            }
        }
    }

    /// The numbers of blocks and of rows of a section of version 4.
    fn read_totals(&mut self, section: &str) -> Result<(u64, u64)> {
        let at = At::head(section);
        let totals = (self.source.size(at)?, self.source.size(at)?);
        if self.layout == Layout::FourOne {
            // The least and the greatest tag.
            self.source.size(at)?;
            self.source.size(at)?;
        }
        Ok(totals)
    }

    /// Dimension and tag of the entity of a block.
    fn read_entity(&mut self, at: At<'_>) -> Result<(u8, i32)> {
        let (first, second): (i32, i32) = (self.source.int(at)?, self.source.int(at)?);
        let (dimension, tag) = if self.layout == Layout::Four { (second, first) } else { (first, second) };
        match dimension {
            0..=3 => Ok((dimension as u8, tag)),
            _ => {
                let what = format!("an entity of dimension {dimension} ({at})");
                Err(self.source.error(what, format!("check the counts of {}, and the version", at.section)))
            }
        }
    }

    /// The tag of a node or an element.
    pub(super) fn tag(&mut self, at: At<'_>) -> Result<u64> {
        if self.layout == Layout::FourOne { self.source.size(at) } else { Ok(self.source.int::<u32>(at)?.into()) }
    }

    fn demand_room(&self, section: &str, done: u64, count: u64, total: u64) -> Result<()> {
        if count <= total.saturating_sub(done) {
            return Ok(());
        }
        let what = format!("a block of {count} behind {done} others, where {section} announces {total} in all");
        Err(self.source.error(what, format!("check the counts of {section}")))
    }

    fn demand_all(&self, section: &str, done: u64, total: u64) -> Result<()> {
        if done == total {
            return Ok(());
        }
        let what = format!("{section} announces {total}, and its blocks hold {done}");
        Err(self.source.error(what, "check the counts of the blocks, and that the file is whole"))
    }

    fn index(&self, tags: &[u64], of: &str, section: &str) -> Result<Tags> {
        Tags::new(tags).map_err(|(tag, [first, second])| {
            let (first, second) = (u64::from(first) + 1, u64::from(second) + 1);
            let what = format!("{of} {tag} is there twice (rows {first} and {second} of {section})");
            self.source.error(what, format!("give each {of} a tag of its own"))
        })
    }
}

/// Reads the section that opens a file: version, form, and the size of numbers.
fn read_format(source: &mut Source<'_>) -> Result<Layout> {
    let at = At::head("MeshFormat");
    let version = source.text_word(at)?.to_owned();
    let layout = match version.as_str() {
        "2" | "2.0" | "2.1" | "2.2" => Layout::Two,
        "4" | "4.0" => Layout::Four,
        "4.1" => Layout::FourOne,
        _ if version.parse::<f64>().is_ok() => {
            return Err(unsupported(&format!("version {}", shortened(&version)), source));
        }
        _ => {
            let what = format!("'{}' is not a version of the format", shortened(&version));
            return Err(source.error(what, "save the file as version 4.1"));
        }
    };
    let (form, size): (u32, u32) = (source.text(at)?, source.text(at)?);
    if form > 1 {
        return Err(source.error(format!("form {form}, where 0 (text) or 1 (binary) is expected"), "save the file again"));
    }
    if size != 8 {
        let what = format!("numbers of {size} bytes, where 8 are expected");
        return Err(source.error(what, "save the file on a machine of 64 bits, or correct the data-size"));
    }
    if form == 1 {
        source.read_one()?;
    }
    source.end_section("MeshFormat")?;
    Ok(layout)
}

fn unsupported(what: &str, source: &Source<'_>) -> Error {
    let what = format!("{what} of Gmsh's format ({})", source.place());
    Error::Unsupported { what, help: "save the mesh as version 4.1 or 2.2, as a whole and without parameters".into() }
}

fn dimension_of(code: i32) -> u8 {
    match code {
        POINT => 0,
        EDGE => 1,
        TRIANGLE | QUADRANGLE => 2,
        _ => 3,
    }
}
