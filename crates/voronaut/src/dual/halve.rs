//! Long edges halved all at once.

use super::{Dual, Effort, Kind, Moving};
use crate::geometry::Point;
use crate::geodesic::LocalMetric;
use crate::parallel::prelude::*;
use crate::planar::Origin;
use crate::triangulation::HalfEdge;

impl Dual<'_> {
    /// Halves edges longer than `above` (metric length), the longest ones where they are more than `most`, and flips. Ids change.
    pub(crate) fn halve_longer(&mut self, above: f64, most: usize) {
        let cuts: Vec<(HalfEdge, Point)> = self.longest(above, most).into_iter().map(|h| (h, self.middle(h))).collect();
        let (planar, origins) = self.planar.halved(&cuts);
        let field = self.field;
        let seed = |(&origin, &p): (&Origin, &Point)| match origin {
            Origin::Vertex(v) => (self.locals[v.index()], self.kinds[v.index()]),
            Origin::Edge(h) => {
                let near = self.local(self.topology().origin(h)).near;
                let kind = if self.topology().is_fixed(h) { Kind::Curve } else { Kind::Free };
                (LocalMetric::at_near(&field, p, near), kind)
            }
        };
        let seeds: Vec<(LocalMetric, Kind)> = origins.par_iter().zip(&planar.positions).with_min_len(256).map(seed).collect();
        (self.locals, self.kinds) = seeds.into_iter().unzip();
        for v in 0..self.locals.len() {
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
        let edges: Vec<HalfEdge> = topology.edges().filter(|&h| may_be_cut(h)).collect();
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
