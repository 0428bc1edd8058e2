//! Curves that correspond, as Gmsh's section `Periodic`: entities, the motion between them, and their nodes.

use super::Version;
use super::writer::{Part, Plan, write_end};
use crate::codec::{Shortest, Sink};
use std::collections::BTreeSet;
use std::io;
use voronaut::mesh::Periodic;

/// Two entities of edges that correspond.
struct Link<'a> {
    pair: &'a Periodic,
    /// The tags of the second and of the first curve, whose nodes Gmsh calls those of the master.
    tags: [i32; 2],
    /// The tags of their nodes, in this order.
    nodes: Vec<[u64; 2]>,
}

impl Plan<'_> {
    /// Writes the section, if there is something for it. In version 2.2 it is text in binary files, too, as Gmsh has it.
    pub(super) fn write_periodic(&self, version: Version, sink: &mut Sink<'_>) -> io::Result<()> {
        let links = self.links();
        if links.is_empty() {
            return Ok(());
        }
        sink.line(format_args!("$Periodic"))?;
        match version {
            Version::V4_1 => sink.row([links.len() as u64])?,
            Version::V2_2 => sink.line(format_args!("{}", links.len()))?,
        }
        for link in &links {
            match version {
                Version::V4_1 => link.write_4(sink)?,
                Version::V2_2 => link.write_2(sink)?,
            }
        }
        match version {
            Version::V4_1 => write_end("Periodic", sink),
            Version::V2_2 => sink.line(format_args!("$EndPeriodic")),
        }
    }

    /// The entities of each pair: of those with its labels two that have the same marks.
    fn links(&self) -> Vec<Link<'_>> {
        let parts = |label: i32| self.parts.iter().filter(move |part| part.dimension == 1 && part.key.0 == label);
        let mut links = Vec::new();
        for pair in &self.mesh.periodic {
            for part in parts(pair.labels[1]) {
                let Some(master) = parts(pair.labels[0]).find(|master| master.key.1 == part.key.1) else { continue };
                let [own, theirs] = [part, master].map(|part| self.vertices_of(part));
                let both = pair.vertices.iter().filter(|[a, b]| own.contains(b) && theirs.contains(a));
                let nodes = both.map(|&[a, b]| [b, a].map(|v| u64::from(v) + 1)).collect();
                links.push(Link { pair, tags: [part.entity, master.entity], nodes });
            }
        }
        links
    }

    fn vertices_of(&self, part: &Part) -> BTreeSet<u32> {
        part.elements.iter().flat_map(|edge| self.mesh.edges[*edge as usize]).collect()
    }
}

impl Link<'_> {
    /// The motion as a matrix of four rows for points (x, y, z, 1).
    fn matrix(&self) -> [f64; 16] {
        let ([c, s], [u, v]) = (self.pair.rotation, self.pair.translation);
        [c, 0.0 - s, 0.0, u, s, c, 0.0, v, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    }

    fn write_4(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        sink.put(1_i32);
        sink.row(self.tags)?;
        let matrix = self.matrix();
        sink.put(matrix.len() as u64);
        sink.row(matrix)?;
        sink.row([self.nodes.len() as u64])?;
        self.nodes.iter().try_for_each(|&nodes| sink.row(nodes))
    }

    fn write_2(&self, sink: &mut Sink<'_>) -> io::Result<()> {
        let ([own, master], matrix) = (self.tags, self.matrix().map(|x| Shortest(x).to_string()).join(" "));
        sink.line(format_args!("1 {own} {master}\nAffine {matrix}\n{}", self.nodes.len()))?;
        self.nodes.iter().try_for_each(|[own, master]| sink.line(format_args!("{own} {master}")))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fields;
    use crate::codec::Form;
    use voronaut::mesh::Mesh;

    /// A square whose left side, from the lower corner to the upper one, is moved to the right; one of its edges is required, as is its
    /// partner.
    fn square() -> Mesh {
        let pair = Periodic {
            labels: [4, 2],
            rotation: [1.0, 0.0],
            translation: [1.0, 0.0],
            vertices: vec![[0, 1], [5, 4], [3, 2]],
            ..Periodic::default()
        };
        Mesh {
            points: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.5, 0.0], [0.0, 0.5, 0.0]],
            triangles: vec![[0, 1, 4], [0, 4, 5], [5, 4, 2], [5, 2, 3]],
            edges: vec![[0, 1], [1, 4], [4, 2], [2, 3], [3, 5], [5, 0]],
            edge_labels: vec![1, 2, 2, 3, 4, 4],
            required_edges: vec![2, 4],
            periodic: vec![pair],
            ..Mesh::default()
        }
    }

    fn written(version: Version, form: Form) -> Vec<u8> {
        let mut out = Vec::new();
        crate::gmsh::write(&square(), &Fields::default(), version, form, &mut out).unwrap();
        out
    }

    #[test]
    fn entities_with_the_same_marks_correspond() {
        let section = |version| {
            let text = String::from_utf8(written(version, Form::Text)).unwrap();
            text[text.find("$Periodic").unwrap()..].to_owned()
        };
        let matrix = "1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1";
        let four =
            format!("$Periodic\n2\n1 2 5\n16 {matrix}\n2\n2 1\n5 6\n1 3 6\n16 {matrix}\n2\n5 6\n3 4\n$EndPeriodic\n");
        assert_eq!(section(Version::V4_1), four);
        assert_eq!(section(Version::V2_2), four.replace("16 ", "Affine "));
    }

    #[test]
    fn the_rest_reads_back() {
        for (version, form) in
            [Version::V4_1, Version::V2_2].into_iter().flat_map(|v| [(v, Form::Text), (v, Form::Binary)])
        {
            let mesh = crate::gmsh::read(written(version, form).as_slice(), "a.msh").unwrap().mesh;
            assert_eq!((mesh.points, mesh.triangles), (square().points, square().triangles), "{version} {form:?}");
        }
    }
}
