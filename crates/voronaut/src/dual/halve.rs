//! Long edges halved all at once.

use super::{Dual, Effort, Kind, Moving};
use crate::geodesic::LocalMetric;
use crate::geometry::Point;
use crate::parallel::prelude::*;
use crate::triangulation::{Corner, HalfEdge};

impl Dual<'_> {
    /// Halves edges longer than `above` (metric length), the longest ones where they are more than `most`, and flips. Ids change.
    pub(crate) fn halve_longer(&mut self, above: f64, most: usize) {
        let cuts = self.longest(above, most);
        let points: Vec<Point> = cuts.par_iter().with_min_len(256).map(|&h| self.middle(h)).collect();
        let (planar, origins) = self.planar.halved(&cuts, &points);
        let field = self.field;
        let seed = |(&origin, &p): (&Corner, &Point)| match origin {
            Corner::Vertex(v) => (self.locals[v.index()], self.kinds[v.index()]),
            Corner::Cut(i) => {
                let h = cuts[i as usize];
                let near = self.local(self.topology().origin(h)).near;
                let kind = if self.topology().is_fixed(h) { Kind::Curve } else { Kind::Free };
                (LocalMetric::at_near(&field, p, near), kind)
            }
        };
        (self.locals, self.kinds) = origins.par_iter().zip(&planar.positions).with_min_len(256).map(seed).unzip();
        let is_bad = |v: &usize| !self.locals[*v].tensor.is_positive_definite();
        let bad: Vec<usize> = (0..self.locals.len()).into_par_iter().with_min_len(1024).filter(is_bad).collect();
        for v in bad {
            self.locals[v] = self.vetted(planar.positions[v], self.locals[v]);
        }
        self.planar = planar;
        self.touched.clear();
        self.forget();
        self.flip_all(Effort::Local);
    }

    fn longest(&self, above: f64, most: usize) -> Vec<HalfEdge> {
        let topology = self.topology();
        let may_be_cut = |h: HalfEdge| topology.constraint(h).is_none_or(|c| !self.required[c.0 as usize]);
        let edges = topology.edges_with(may_be_cut);
        let measured = edges.par_iter().with_min_len(256).map(|&h| (self.edge_length(h), h));
        let mut long: Vec<(f64, HalfEdge)> = measured.filter(|(length, _)| *length > above).collect();
        if long.len() > most {
            long.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            long.truncate(most);
        }
        long.into_iter().map(|(_, h)| h).collect()
    }

    /// Where both halves of an edge are equally long, as the tensors at its ends tell.
    fn middle(&self, h: HalfEdge) -> Point {
        let [p, q] = self.planar.ends(h);
        let [from, to] = self.topology().ends(h).map(|v| self.local(v).tensor.length(q - p));
        // Speed is linear: (from + (to - from) t / 2) t = (from + to) / 4.
        let root = (0.5 * (from * from + to * to)).sqrt();
        p.lerp(q, 0.5 * (from + to) / (from + root))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Tensor;
    use crate::manifold::domain::Domain;
    use crate::metric::Scaled;
    use crate::progress::Silent;
    use crate::sampling::{Fill, refine};

    #[test]
    fn long_edges_become_two_of_half_the_length() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let field = |p: Point| Tensor::new(100.0, 30.0, 100.0) * (1.0 + p.x);
        let mut dual = Dual::new(domain.corners(), Scaled { field: &field, factor: 1.0 }).unwrap();
        refine(&mut dual, Fill::AtMost(60), &Silent).unwrap();
        let edges: Vec<f64> = dual.topology().edges().map(|h| dual.edge_length(h)).collect();
        let (before, long) = (dual.vertex_count(), edges.iter().filter(|length| **length > 1.0).count());
        dual.halve_longer(1.0, usize::MAX);
        assert_eq!(dual.vertex_count(), before + long);
        assert!(dual.planar().is_embedded());
        dual.topology().check().unwrap();
        for v in dual.topology().vertices() {
            let p = dual.position(v);
            assert_eq!(dual.local(v).tensor, field(p));
            let is_on_side = [p.x, p.y].iter().any(|x| x.min(1.0 - x) <= 0.0);
            assert_eq!(dual.kind(v) != Kind::Free, is_on_side);
        }
        // The longest ones, where they are too many.
        dual.halve_longer(0.0, 7);
        assert_eq!(dual.vertex_count(), before + long + 7);
    }

    #[test]
    fn both_halves_are_equally_long() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let field = |p: Point| Tensor::isotropic(1.0 / (1.0 + 2.0 * p.x));
        let dual = Dual::new(domain.corners(), Scaled { field: &field, factor: 1e6 }).unwrap();
        let bottom = dual.topology().edges().find(|&h| dual.planar().ends(h).iter().all(|p| p.y == 0.0)).unwrap();
        // The speed along it grows as 1 + 2 x.
        let x = dual.middle(bottom).x;
        assert!((x + x * x - 1.0).abs() < 1e-12, "{x}");
    }
}
