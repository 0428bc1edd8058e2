//! Orphans: what of a cell does not hang together with its seed (RR-9103, section 1; Labelle and Shewchuk 2003).

use super::{Diagram, Ground};
use crate::geodesic::NO_COLOUR;
use crate::triangulation::{Triangulation, VertexId};

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// Canvas vertices that canvas edges of their colour do not connect to their seed (to a vertex of its colour in its
    /// sight), in order. Fronts leave none but where a cell is thinner than the canvas is fine.
    pub(crate) fn orphans(&self) -> Vec<VertexId> {
        let mut all = self.orphan_components().concat();
        all.sort_unstable();
        all
    }

    /// The orphans in connected sets of one colour, each in order, sets in the order of their first vertices: the orphan
    /// cells of the literature, as far as the canvas resolves them.
    pub fn orphan_components(&self) -> Vec<Vec<VertexId>> {
        let starts = (0..).zip(&self.seeds).flat_map(|(colour, seed)| {
            let starts = seed.iter().flat_map(|seed| &seed.starts).map(|start| start.vertex);
            starts.filter(move |&v| self.label(v).colour == colour)
        });
        components(self.ground.topology(), |v| self.label(v).colour, starts)
    }
}

/// The connected sets of one colour that hold none of the given vertices.
fn components(
    topology: &Triangulation,
    colour: impl Fn(VertexId) -> u32,
    from: impl Iterator<Item = VertexId>,
) -> Vec<Vec<VertexId>> {
    let mut reached = vec![false; topology.vertex_slots()];
    // The set of a vertex's colour around it, in order; none if it was reached before.
    let mut flood = |from: VertexId| {
        if std::mem::replace(&mut reached[from.index()], true) {
            return None;
        }
        let (mut set, mut next) = (vec![from], 0);
        while let Some(&v) = set.get(next) {
            next += 1;
            let same = topology.around(v).filter(|&y| colour(y) == colour(from));
            set.extend(same.filter(|y| !std::mem::replace(&mut reached[y.index()], true)));
        }
        set.sort_unstable();
        Some(set)
    };
    from.for_each(|v| drop(flood(v)));
    let vertices = (0..topology.vertex_slots() as u32).map(VertexId).filter(|&v| colour(v) != NO_COLOUR);
    vertices.filter_map(flood).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Canvas;
    use crate::diagram::Kind;
    use crate::diagram::test_diagrams::{plate_with_hole, seeds_of};
    use crate::geodesic::Method;
    use crate::geometry::{Point, Tensor};
    use crate::manifold::domain::Domain;
    use crate::metric::Swirl;

    #[test]
    fn islands_are_counted_one_by_one() {
        let domain = Domain::shape("rect:0,0,4,1").unwrap();
        let canvas = Canvas::intrinsic(domain.planar(), &|_: Point| Tensor::IDENTITY, 4000).unwrap();
        let [first, second] = [Point::new(2.5, 0.3), Point::new(3.5, 0.7)];
        // The left half is 0's, the right one 1's but for two disks; a third is out of reach of everyone.
        let colour = |v: VertexId| {
            let p = canvas.position(v);
            match p {
                _ if p.distance(Point::new(1.0, 0.5)) < 0.2 => NO_COLOUR,
                _ if p.distance(first) < 0.2 || p.distance(second) < 0.2 => 0,
                _ => u32::from(p.x > 2.0),
            }
        };
        let nearest = |p: Point| {
            let all = (0..canvas.vertex_count() as u32).map(VertexId);
            all.min_by(|&a, &b| canvas.position(a).distance(p).total_cmp(&canvas.position(b).distance(p))).unwrap()
        };
        let seeds = [nearest(Point::new(0.5, 0.5)), nearest(Point::new(3.0, 0.5))];
        let mut found = components(canvas.topology(), colour, seeds.into_iter());
        found.sort_by(|a, b| canvas.position(a[0]).x.total_cmp(&canvas.position(b[0]).x));
        let disk = |centre: Point| {
            let all = (0..canvas.vertex_count() as u32).map(VertexId);
            all.filter(|&v| canvas.position(v).distance(centre) < 0.2).collect::<Vec<_>>()
        };
        assert_eq!(found, [disk(first), disk(second)]);
        assert!(found[0].len() > 50);
        // Without a seed the whole right part is one more.
        assert_eq!(components(canvas.topology(), colour, seeds[..1].iter().copied()).len(), 3);
    }

    #[test]
    fn the_swirl_makes_orphans_of_chords_and_none_of_geodesics() {
        let (domain, swirl) = (Domain::shape("rect:-2,-2,2,2").unwrap(), Swirl::default());
        let canvas = Canvas::intrinsic(domain.planar(), &swirl, 20_000).unwrap();
        let seeds = seeds_of(&plate_with_hole(), 80);
        let components = Kind::ALL.map(|kind| Diagram::of_kind(kind, &canvas, &swirl, &seeds, Method::March).unwrap());
        let [ours, du_wang, labelle] = components.map(|diagram| {
            let components = diagram.orphan_components();
            assert_eq!(components.iter().map(Vec::len).sum::<usize>(), diagram.orphans().len());
            components.len()
        });
        assert!(ours == 0 && du_wang > 10 && labelle > 10, "{ours} {du_wang} {labelle}");
    }
}
