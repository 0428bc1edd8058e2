//! The nerve of the diagram and its witnesses (RR-9103, section 6.4 and Figure 7).

use super::{Diagram, Ground};
use crate::geodesic::NO_COLOUR;
use crate::geometry::Point;
use crate::triangulation::{FaceId, HalfEdge, VertexId, smallest_first};

/// Two cells that touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NerveEdge {
    /// The two colours, the smaller first.
    pub colours: [u32; 2],
    /// A canvas edge between the two cells: the half-edge with the smallest id.
    pub witness: HalfEdge,
    /// Such an edge on the border of the domain, if there is one.
    pub border: Option<HalfEdge>,
}

/// Three cells that meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NerveTriangle {
    /// The three colours counter-clockwise as their cells lie around the witness, the smallest first.
    pub colours: [u32; 3],
    /// A canvas face with a vertex in each of the three cells: the one with the smallest id.
    pub witness: FaceId,
    /// How many canvas faces witness it.
    pub witnesses: u32,
    /// The fourth seed nearest to where the three cells meet, and how far it is from making that place its own: the
    /// squares of the distances to it and to the three differ by this share of the latter. `None` where no other seed is
    /// near, and in [`Diagram::nerve`], which does not know the place.
    pub fourth: Option<(u32, f64)>,
    /// The squared distance of that place from the three; `None` in [`Diagram::nerve`].
    pub square: Option<f64>,
}

/// The simplices that the canvas witnesses, each with a witness; sorted by colours.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Nerve {
    /// Colours with a cell, and the canvas vertex of the cell that is nearest to its seed.
    pub vertices: Vec<(u32, VertexId)>,
    /// Pairs of cells that share a canvas edge.
    pub edges: Vec<NerveEdge>,
    /// Triples of cells that share a canvas face. The same three colours, turning the other way, are another triangle.
    pub triangles: Vec<NerveTriangle>,
}

impl Nerve {
    /// From all witnesses: one of each simplex is kept, that with the smallest id.
    pub(super) fn new(
        vertices: Vec<(u32, VertexId)>,
        mut edges: Vec<NerveEdge>,
        mut triangles: Vec<NerveTriangle>,
    ) -> Self {
        edges.sort_unstable_by_key(|e| (e.colours, e.witness));
        edges.dedup_by(|later, first| {
            let same = later.colours == first.colours;
            first.border = if same { first.border.or(later.border) } else { first.border };
            same
        });
        triangles.sort_unstable_by_key(|t| (t.colours, t.witness));
        triangles.dedup_by(|later, first| {
            let same = later.colours == first.colours;
            if same {
                first.witnesses += 1;
                first.fourth = nearer(first.fourth, later.fourth);
            }
            same
        });
        Self { vertices, edges, triangles }
    }

    /// The sides of those triangles that a test picks, the smaller colour first; those of two such triangles twice.
    pub(crate) fn sides<'a>(
        &'a self,
        pick: impl Fn(&NerveTriangle) -> bool + 'a,
    ) -> impl Iterator<Item = [u32; 2]> + 'a {
        let picked = self.triangles.iter().filter(move |t| pick(t)).map(|t| t.colours);
        picked.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).map(|[a, b]| [a.min(b), a.max(b)])
    }
}

/// The canvas faces that witness simplices of the nerve.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Witnesses {
    /// Faces with three colours: they witness a Voronoi vertex.
    pub vertices: Vec<FaceId>,
    /// Faces with two colours: two of their edges witness a Voronoi edge.
    pub edges: Vec<FaceId>,
}

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// Reads the nerve off the canvas, as the report does: from canvas edges with two colours, faces with three.
    pub fn nerve(&self) -> Nerve {
        Nerve::new(self.coloured_vertices(), self.bicoloured_edges(), self.tricoloured_faces())
    }

    /// All witnesses (RR-9103, section 6.4 and Figure 7), in order: faces of the canvas that distances travel on, as for
    /// [`Diagram::nerve`].
    pub fn witnesses(&self) -> Witnesses {
        let topology = self.ground.topology();
        let mut witnesses = Witnesses::default();
        for f in topology.faces() {
            let corners = topology.corners(f);
            let [a, b, c] = self.colours_at(corners);
            if self.three_colours(corners).is_some() {
                witnesses.vertices.push(f);
            } else if ![a, b, c].contains(&NO_COLOUR) && (a != b || b != c) {
                witnesses.edges.push(f);
            }
        }
        witnesses
    }

    /// The triangles of the nerve as the report reads them off the canvas (Figure 7), with a witness each: a canvas simplex
    /// with vertices of three colours, which are turned and sorted as in [`Nerve::triangles`]. Of a star set they are the
    /// simplices of any star, which where stars disagree may exclude each other; else the faces.
    pub(crate) fn witnesses_of_triangles(&self) -> Vec<([u32; 3], [VertexId; 3])> {
        let coloured = |simplex| Some((self.three_colours(simplex)?, simplex));
        let mut found: Vec<([u32; 3], [VertexId; 3])> = match self.ground.stars() {
            None => {
                let topology = self.ground.topology();
                topology.faces().filter_map(|f| coloured(topology.corners(f))).collect()
            }
            Some(stars) => {
                let vertices = self.vertices();
                let simplices = vertices.flat_map(|v| stars.star(v).map(move |[a, b]| [v, a, b]));
                simplices.filter_map(coloured).collect()
            }
        };
        found.sort_unstable();
        found.dedup_by_key(|witness| witness.0);
        found
    }

    /// The colours of some vertices, [`NO_COLOUR`] of those that no seed reaches.
    pub(crate) fn colours_at<const N: usize>(&self, vertices: [VertexId; N]) -> [u32; N] {
        vertices.map(|v| self.label(v).colour)
    }

    /// The colours of three vertices, if they are three.
    pub(super) fn three_colours(&self, vertices: [VertexId; 3]) -> Option<[u32; 3]> {
        let [a, b, c] = self.colours_at(vertices);
        let distinct = a != b && b != c && c != a && [a, b, c].iter().all(|&x| x != NO_COLOUR);
        distinct.then_some(smallest_first([a, b, c]))
    }

    pub(super) fn coloured_vertices(&self) -> Vec<(u32, VertexId)> {
        let mut first = vec![None; self.colours()];
        for v in self.vertices() {
            if let Some(colour) = self.colour(v) {
                let best: &mut Option<VertexId> = &mut first[colour as usize];
                if best.is_none_or(|b| self.distance(v) < self.distance(b)) {
                    *best = Some(v);
                }
            }
        }
        first.into_iter().enumerate().filter_map(|(colour, v)| Some((colour as u32, v?))).collect()
    }

    fn bicoloured_edges(&self) -> Vec<NerveEdge> {
        let topology = self.ground.topology();
        let between = |h: HalfEdge| {
            let [a, b] = self.colours_at(topology.ends(h));
            let border = topology.twin(h).is_none().then_some(h);
            (a != b && a != NO_COLOUR && b != NO_COLOUR).then(|| NerveEdge {
                colours: [a.min(b), a.max(b)],
                witness: h,
                border,
            })
        };
        topology.edges().filter_map(between).collect()
    }

    fn tricoloured_faces(&self) -> Vec<NerveTriangle> {
        let topology = self.ground.topology();
        let of_face = |witness: FaceId| {
            let colours = self.three_colours(topology.corners(witness))?;
            Some(NerveTriangle { colours, witness, witnesses: 1, fourth: None, square: None })
        };
        topology.faces().filter_map(of_face).collect()
    }
}

fn nearer(a: Option<(u32, f64)>, b: Option<(u32, f64)>) -> Option<(u32, f64)> {
    a.into_iter().chain(b).min_by(|a, b| a.1.total_cmp(&b.1))
}

impl Diagram<'_> {
    /// The corners of faces of the canvas that distances travel on. Sides that flips have made are no straight lines in
    /// the plane; triangles drawn from these points are their chords.
    pub fn corners_of(&self, faces: &[FaceId]) -> Vec<[Point; 3]> {
        let topology = self.ground.topology();
        faces.iter().map(|&f| topology.corners(f).map(|v| self.ground.canvas.position(v))).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::canvas::Canvas;
    use crate::diagram::Diagram;
    use crate::diagram::test_diagrams::{plate_with_hole, seeds_of};
    use crate::metric::Swirl;

    #[test]
    fn witnesses_have_the_colours_of_what_they_witness() {
        let (domain, swirl) = (plate_with_hole(), Swirl::default());
        let canvas = Canvas::intrinsic(domain.planar(), &swirl, 4000).unwrap();
        let diagram = Diagram::new(&canvas, &swirl, &seeds_of(&domain, 40)).unwrap();
        let witnesses = diagram.witnesses();
        let colours = |f| {
            let mut colours = canvas.topology().corners(f).map(|v| diagram.colour(v).unwrap()).to_vec();
            colours.sort_unstable();
            colours.dedup();
            colours.len()
        };
        assert!(witnesses.vertices.iter().all(|&f| colours(f) == 3));
        assert!(witnesses.edges.iter().all(|&f| colours(f) == 2));
        let nerve = diagram.nerve();
        let counted: u32 = nerve.triangles.iter().map(|t| t.witnesses).sum();
        assert_eq!(witnesses.vertices.len(), counted as usize);
        assert!(nerve.triangles.iter().all(|t| witnesses.vertices.contains(&t.witness)));
        assert!(witnesses.edges.len() > nerve.edges.len());
    }
}
