//! Gmsh's sections, read in turn into a mesh.

use super::blocks::{Blocks, INT, Layout, REAL, SIZE, end_section, next_section, skip_section, unsupported};
use super::groups::Groups;
use super::tags::Tags;
use crate::codec::{At, several};
use crate::curved::Raised;
use crate::document::marked_mut;
use crate::volumes::Volumes;
use crate::{Document, Fields};
use std::collections::BTreeMap;
use voronaut::Result;
use voronaut::mesh::Mesh;

/// What a file holds, as far as it is read.
#[derive(Default)]
pub(super) struct Reader {
    seen: Vec<&'static str>,
    pub(super) groups: Groups,
    /// The physical groups of entities, by dimension and tag.
    pub(super) entities: BTreeMap<(u8, i32), Vec<i32>>,
    pub(super) nodes: Tags,
    pub(super) elements: Tags,
    /// The element that was read last.
    pub(super) last: Piece,
    /// The element that each triangle comes from, counted in the order of the file.
    pub(super) triangle_elements: Vec<u32>,
    pub(super) volumes: Volumes,
    pub(super) raised: Raised,
    /// Elements of which a triangle mesh can hold nothing.
    pub(super) foreign: BTreeMap<&'static str, u64>,
    pub(super) mesh: Mesh,
    pub(super) fields: Fields,
    pub(super) notes: Vec<String>,
}

/// An element of the file that is in the mesh.
#[derive(Default)]
pub(super) struct Piece {
    pub(super) code: i32,
    pub(super) nodes: Corners,
    pub(super) entity: i32,
    pub(super) groups: Vec<i32>,
    /// Which of the mesh's vertices, edges or triangles it is, or begins with.
    pub(super) index: u32,
}

/// The nodes of an element, and zeros behind them: a triangle of order 3 has most.
pub(super) type Corners = [u32; 10];

/// Sections that are read once; `NodeData` and `ElementData` are read as often as they come, all others are passed over.
const SECTIONS: [&str; 4] = ["PhysicalNames", "Entities", "Nodes", "Elements"];

impl Reader {
    /// Reads the sections behind the head.
    ///
    /// # Errors
    /// As of [`super::read`].
    pub(super) fn read(mut self, mut from: Blocks<'_>) -> Result<Document> {
        while let Some(section) = next_section(&mut from.source)? {
            self.read_section(&section, &mut from)?;
        }
        if !self.seen.contains(&"Nodes") {
            let what = "the file has no section Nodes";
            return Err(from.source.error(what, "save the mesh with the views; check that the file is whole"));
        }
        for list in marked_mut(&mut self.mesh) {
            list.sort_unstable();
            list.dedup();
        }
        let mut document = Document { mesh: self.mesh, fields: self.fields, notes: self.notes };
        self.raised.finish(&mut document, from.source.place())?;
        Ok(document)
    }

    fn read_section(&mut self, section: &str, from: &mut Blocks<'_>) -> Result<()> {
        match section {
            "NodeData" | "ElementData" => {
                self.demand_nodes(section, from)?;
                self.read_data(section, from)?;
                return end_section(&mut from.source, section);
            }
            "PartitionedEntities" => return Err(unsupported("a mesh in partitions", &from.source)),
            "ParametricNodes" => return Err(unsupported("nodes with parameters in version 2", &from.source)),
            _ => {}
        }
        let Some(&name) = SECTIONS.iter().find(|name| **name == section) else {
            return skip_section(&mut from.source, section);
        };
        if self.seen.contains(&name) {
            return Err(from.source.error(format!("a second section {name}"), "join both sections into one"));
        }
        self.seen.push(name);
        match name {
            "PhysicalNames" => self.read_names(from)?,
            "Entities" => self.read_entities(from)?,
            "Nodes" => self.read_nodes(from)?,
            _ => self.read_elements(from)?,
        }
        end_section(&mut from.source, name)
    }

    /// Refuses elements before nodes, values before nodes, and elements behind values.
    pub(super) fn demand_nodes(&self, section: &str, from: &Blocks<'_>) -> Result<()> {
        let what = if !self.seen.contains(&"Nodes") {
            format!("{section} comes before Nodes")
        } else if section == "Elements" && !(self.fields.vertices.is_empty() && self.fields.triangles.is_empty()) {
            "Elements comes behind the values on them".to_owned()
        } else {
            return Ok(());
        };
        let help = "save the mesh with its values, in the order Nodes, Elements, NodeData, ElementData";
        Err(from.source.error(what, help))
    }

    fn read_names(&mut self, from: &mut Blocks<'_>) -> Result<()> {
        let head = At::head("PhysicalNames");
        for at in At::rows(head.section, from.source.word(head)?.whole(head)?) {
            let (dimension, tag) = (from.source.word(at)?.whole(at)?, from.source.word(at)?.whole(at)?);
            let name = from.source.rest_of_row(at)?;
            self.groups.name(dimension, tag, name.trim_matches('"'));
        }
        Ok(())
    }

    fn read_entities(&mut self, from: &mut Blocks<'_>) -> Result<()> {
        let (section, layout, source) = ("Entities", from.layout, &mut from.source);
        let counts: [u64; 4] = several(|| source.whole(SIZE, At::head(section)))?;
        for (dimension, count) in (0..).zip(counts) {
            for at in At::rows(section, count) {
                let tag = source.whole(INT, at)?;
                let ends = if dimension == 0 && layout == Layout::FourOne { 1 } else { 2 };
                source.skip(3 * ends, REAL, at)?;
                let mut groups = Vec::new();
                for _ in 0..source.whole::<u64>(SIZE, at)? {
                    // A negative tag turns the entity round.
                    groups.push(source.whole::<i32>(INT, at)?.saturating_abs());
                }
                let bounds: u64 = if dimension == 0 { 0 } else { source.whole(SIZE, at)? };
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

    fn read_nodes(&mut self, from: &mut Blocks<'_>) -> Result<()> {
        let (section, layout, mut tags) = ("Nodes", from.layout, Vec::new());
        let (blocks, total) = from.read_totals(section)?;
        for _ in 0..blocks {
            let (mut parameters, mut count, at) = (0, total, At::head(section));
            if layout != Layout::Two {
                let (dimension, _) = from.read_entity(at)?;
                let is_parametric = from.source.whole::<i32>(INT, at)? != 0;
                parameters = if is_parametric { dimension.into() } else { 0 };
                count = from.source.whole(SIZE, at)?;
            }
            let rows = from.block(section, tags.len(), count, total)?;
            if layout == Layout::FourOne {
                for at in rows.clone() {
                    tags.push(from.tag(at)?);
                }
            }
            for at in rows {
                if layout != Layout::FourOne {
                    tags.push(from.tag(at)?);
                }
                self.mesh.points.push(from.source.numbers(REAL, at)?);
                from.source.skip(parameters, REAL, at)?;
            }
        }
        from.demand_all(section, tags.len(), total)?;
        self.nodes = from.index(&tags, "node", section)?;
        self.mesh.point_labels = vec![0; tags.len()];
        Ok(())
    }
}
