//! All witnesses of the nerve (RR-9103, section 6.4 and Figure 7), to be drawn.

use super::{Diagram, Ground};
use crate::geodesic::NO_COLOUR;
use crate::geometry::Point;
use crate::triangulation::FaceId;

/// The canvas faces that witness simplices of the nerve.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Witnesses {
    /// Faces with three colours: they witness a Voronoi vertex.
    pub vertices: Vec<FaceId>,
    /// Faces with two colours: two of their edges witness a Voronoi edge.
    pub edges: Vec<FaceId>,
}

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// All witnesses, in order: faces of the canvas that distances travel on, as for [`Diagram::nerve`].
    pub fn witnesses(&self) -> Witnesses {
        let topology = self.ground.topology();
        let mut witnesses = Witnesses::default();
        for f in topology.faces() {
            let [a, b, c] = topology.corners(f).map(|v| self.label(v).colour);
            if [a, b, c].contains(&NO_COLOUR) || (a == b && b == c) {
                continue;
            }
            let has_three = a != b && b != c && c != a;
            if has_three { witnesses.vertices.push(f) } else { witnesses.edges.push(f) }
        }
        witnesses
    }
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
        let canvas = Canvas::intrinsic(&domain, &swirl, 4000).unwrap();
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
