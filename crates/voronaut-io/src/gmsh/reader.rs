//! Gmsh's sections, read in turn into a mesh.

use super::groups::Groups;
use super::sections::{INT, REAL, SIZE, end_section, next_section, read_one, skip_section};
use super::tags::Tags;
use crate::codec::{At, Source, shortened};
use crate::volumes::Volumes;
use crate::{Document, Fields};
use std::collections::BTreeMap;
use voronaut::mesh::Mesh;
use voronaut::{Error, Result};

/// How the sections of a file are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Layout {
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
    pub(super) layout: Layout,
    seen: Vec<&'static str>,
    pub(super) groups: Groups,
    /// The physical groups of entities, by dimension and tag.
    pub(super) entities: BTreeMap<(u8, i32), Vec<i32>>,
    pub(super) nodes: Tags,
    pub(super) elements: Tags,
    /// The element that each triangle comes from, counted in the order of the file.
    pub(super) triangle_elements: Vec<u32>,
    pub(super) volumes: Volumes,
    /// The element that each cell of a volume is.
    pub(super) volume_elements: Vec<u32>,
    /// Elements of which a triangle mesh can hold nothing.
    pub(super) foreign: BTreeMap<&'static str, u64>,
    pub(super) mesh: Mesh,
    pub(super) fields: Fields,
    pub(super) notes: Vec<String>,
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
            match next_section(&mut source)?.as_deref() {
                Some("MeshFormat") => break,
                Some("NOD") => return Err(unsupported("version 1", &source)),
                Some(other) => skip_section(&mut source, other)?,
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
            volumes: Volumes::default(),
            volume_elements: Vec::new(),
            foreign: BTreeMap::new(),
            mesh: Mesh::default(),
            fields: Fields::default(),
            notes: Vec::new(),
        })
    }

    /// Reads the sections behind the head.
    pub(super) fn read(mut self) -> Result<Document> {
        while let Some(section) = next_section(&mut self.source)? {
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
        Ok(Document { mesh: self.mesh, fields: self.fields, notes: self.notes })
    }

    fn read_section(&mut self, section: &str) -> Result<()> {
        match section {
            "NodeData" | "ElementData" => {
                self.demand_nodes(section)?;
                self.read_data(section)?;
                return end_section(&mut self.source, section);
            }
            "PartitionedEntities" => return Err(unsupported("a mesh in partitions", &self.source)),
            "ParametricNodes" => return Err(unsupported("nodes with parameters in version 2", &self.source)),
            _ => {}
        }
        let Some(&name) = SECTIONS.iter().find(|name| **name == section) else {
            return skip_section(&mut self.source, section);
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
        end_section(&mut self.source, name)
    }

    /// Refuses elements before nodes, values before nodes, and elements behind values.
    pub(super) fn demand_nodes(&self, section: &str) -> Result<()> {
        let what = if !self.seen.contains(&"Nodes") {
            format!("{section} comes before Nodes")
        } else if section == "Elements" && !(self.fields.vertices.is_empty() && self.fields.triangles.is_empty()) {
            "Elements comes behind the values on them".to_owned()
        } else {
            return Ok(());
        };
        let help = "save the mesh with its values, in the order Nodes, Elements, NodeData, ElementData";
        Err(self.source.error(what, help))
    }

    fn read_names(&mut self) -> Result<()> {
        for at in self.text_rows("PhysicalNames")? {
            let (dimension, tag) = (self.source.word(at)?.whole(at)?, self.source.word(at)?.whole(at)?);
            let name = self.source.rest_of_row(at)?;
            self.groups.name(dimension, tag, name.trim_matches('"'));
        }
        Ok(())
    }

    fn read_entities(&mut self) -> Result<()> {
        let (section, source) = ("Entities", &mut self.source);
        let (mut counts, at) = ([0; 4], At::head(section));
        for count in &mut counts {
            *count = source.whole(SIZE, at)?;
        }
        for (dimension, count) in (0..).zip(counts) {
            for at in At::rows(section, count) {
                let tag = source.whole(INT, at)?;
                let ends = if dimension == 0 && self.layout == Layout::FourOne { 1 } else { 2 };
                source.skip(3 * ends, REAL, at)?;
                let mut groups = Vec::new();
                for _ in 0..source.whole::<u64>(SIZE, at)? {
                    // A negative tag turns the entity round.
                    groups.push(source.whole::<i32>(INT, at)?.saturating_abs());
                }
                let bounds = if dimension == 0 { 0 } else { source.whole(SIZE, at)? };
                for _ in 0..bounds {
                    source.whole::<i32>(INT, at)?;
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
        let mut tags = Vec::new();
        for at in self.text_rows("Nodes")? {
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
            let is_parametric = self.source.whole::<i32>(INT, at)? != 0;
            let parameters = if is_parametric { u64::from(dimension) } else { 0 };
            let count = self.source.whole(SIZE, at)?;
            let rows = self.block(section, tags.len(), count, total)?;
            if self.layout == Layout::FourOne {
                for at in rows.clone() {
                    tags.push(self.tag(at)?);
                }
            }
            for at in rows {
                if self.layout == Layout::Four {
                    tags.push(self.tag(at)?);
                }
                self.read_point(parameters, at)?;
            }
        }
        self.demand_all(section, tags.len(), total)?;
        Ok(tags)
    }

    fn read_point(&mut self, parameters: u64, at: At<'_>) -> Result<()> {
        let source = &mut self.source;
        self.mesh.points.push(source.numbers(REAL, at)?);
        source.skip(parameters, REAL, at)
    }

    /// All rows of a section that begins with their number on a line of text.
    pub(super) fn text_rows<'s>(&mut self, section: &'s str) -> Result<impl Iterator<Item = At<'s>> + use<'s>> {
        let at = At::head(section);
        Ok(At::rows(section, self.source.word(at)?.whole(at)?))
    }

    /// The numbers of blocks and of rows of a section of version 4.
    pub(super) fn read_totals(&mut self, section: &str) -> Result<(u64, u64)> {
        let at = At::head(section);
        let totals = (self.source.whole(SIZE, at)?, self.source.whole(SIZE, at)?);
        if self.layout == Layout::FourOne {
            // The least and the greatest tag.
            let _: [u64; 2] = [self.source.whole(SIZE, at)?, self.source.whole(SIZE, at)?];
        }
        Ok(totals)
    }

    /// Dimension and tag of the entity of a block.
    pub(super) fn read_entity(&mut self, at: At<'_>) -> Result<(u8, i32)> {
        let (first, second): (i32, i32) = (self.source.whole(INT, at)?, self.source.whole(INT, at)?);
        let (dimension, tag) = if self.layout == Layout::Four { (second, first) } else { (first, second) };
        if (0..=3).contains(&dimension) {
            return Ok((dimension as u8, tag));
        }
        let what = format!("an entity of dimension {dimension} ({at})");
        Err(self.source.error(what, format!("check the counts of {}, and the version", at.section)))
    }

    /// The tag of a node or an element.
    pub(super) fn tag(&mut self, at: At<'_>) -> Result<u64> {
        let is_wide = self.layout == Layout::FourOne;
        if is_wide { self.source.whole(SIZE, at) } else { Ok(self.source.whole::<u32>(INT, at)?.into()) }
    }

    /// The rows of a block of so many behind `done` others; refuses more than `total` in all.
    pub(super) fn block<'s>(
        &self,
        section: &'s str,
        done: usize,
        count: u64,
        total: u64,
    ) -> Result<impl Iterator<Item = At<'s>> + Clone + use<'s>> {
        let done = done as u64;
        if count <= total.saturating_sub(done) {
            return Ok((done + 1..=done + count).map(move |row| At { section, row, rows: total }));
        }
        let what = format!("a block of {count} behind {done} others, where {section} announces {total} in all");
        Err(self.source.error(what, format!("check the counts of {section}")))
    }

    /// Refuses blocks that hold `done` rows where there are `total`.
    pub(super) fn demand_all(&self, section: &str, done: usize, total: u64) -> Result<()> {
        if done as u64 == total {
            return Ok(());
        }
        let what = format!("{section} announces {total}, and its blocks hold {done}");
        Err(self.source.error(what, "check the counts of the blocks, and that the file is whole"))
    }

    /// The entries of all tags; refuses one that is there twice.
    pub(super) fn index(&self, tags: &[u64], of: &str, section: &str) -> Result<Tags> {
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
    let version = source.word(at)?.text.to_owned();
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
    let (form, size): (u32, u32) = (source.word(at)?.whole(at)?, source.word(at)?.whole(at)?);
    if form > 1 {
        let what = format!("form {form}, where 0 (text) or 1 (binary) is expected");
        return Err(source.error(what, "save the file again"));
    }
    if size != 8 {
        let what = format!("numbers of {size} bytes, where 8 are expected");
        return Err(source.error(what, "save the file on a machine of 64 bits, or correct the data-size"));
    }
    if form == 1 {
        read_one(source)?;
    }
    end_section(source, "MeshFormat")?;
    Ok(layout)
}

fn unsupported(what: &str, source: &Source<'_>) -> Error {
    let what = format!("{what} of Gmsh's format ({})", source.place());
    Error::Unsupported { what, help: "save the mesh as version 4.1 or 2.2, as a whole and without parameters".into() }
}
