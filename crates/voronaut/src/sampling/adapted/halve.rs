//! Finer triangulations from coarser ones: edges inside patches cut in two, and those on the border at places that are given.

use super::work::{Vertex, Work, leaning, quality};
use super::{Adapted, TOO_LONG, UPRIGHT};
use crate::manifold::surface::metric::SurfaceMetric;
use crate::manifold::{Manifold, Place};
use crate::parallel::prelude::*;
use crate::triangulation::{Corner, FaceId, HalfEdge, Triangulation, VertexId};
use std::collections::BTreeMap;

/// A triangulation of a surface, and what is wanted of a finer one.
pub(crate) struct Halving<'a> {
    /// Its vertices.
    pub places: &'a [Place],
    /// How they hang together.
    pub topology: &'a Triangulation,
    /// Places on the border of patches that shall be vertices; the only ones of the border.
    pub given: &'a [Place],
    /// Of these, which are vertices already: the first ones, in this order.
    pub are_there: &'a [bool],
    /// The factor on the metric for which edges are of unit length.
    pub factor: f64,
    /// Vertices.
    pub count: usize,
}

/// The triangulation with vertices in the middles of edges that are too long, and at all places that are given.
pub(crate) fn halved(manifold: &Manifold, metric: &dyn SurfaceMetric, halving: &Halving) -> Adapted {
    let Halving { places, topology, given, are_there, factor, count } = *halving;
    let mut work = Work::of(manifold, metric, factor, topology.clone(), places.to_vec());
    let there = (0..).zip(are_there).filter(|(_, is_there)| **is_there).map(|(i, _)| i);
    for (vertex, i) in work.vertices.iter_mut().zip(there) {
        vertex.given = Some(i);
    }
    let long = work.longest(TOO_LONG, count.saturating_sub(places.len()));
    work.cut_border(given, are_there);
    work.halve(long);
    work.split_long(count);
    work.contract_to(count);
    work.finished()
}

impl Work<'_> {
    /// Edges inside patches that are longer than so much, no more than so many, and the vertices in their middles.
    fn longest(&self, longer: f64, most: usize) -> Vec<([VertexId; 2], Option<Vertex>)> {
        let mut long = self.longest_first(|h| self.exceeds(h, longer));
        long.truncate(most);
        let middle = |&h: &HalfEdge| (self.topology.ends(h), self.middle(h));
        long.par_iter().with_min_len(16).map(middle).collect()
    }

    /// Cuts edges at vertices, all at once, but where that would turn a triangle away from the surface, or make the first needle.
    fn halve(&mut self, edges: Vec<([VertexId; 2], Option<Vertex>)>) {
        let t = &self.topology;
        let cuts = edges.into_par_iter().with_min_len(256);
        let cuts = cuts.filter_map(|(ends, vertex)| Some((t.edge_between(ends[0], ends[1])?, vertex?)));
        let (cuts, middles): (Vec<HalfEdge>, Vec<Vertex>) = cuts.unzip();
        let vertex = |corner: Corner| match corner {
            Corner::Vertex(v) => self.at(v),
            Corner::Cut(i) => &middles[i as usize],
        };
        let stands = |f: FaceId, part: [Corner; 3]| {
            let whole = t.corners(f);
            let (upright, least) = (self.leaning(whole).min(UPRIGHT), self.least_of_parts(&[whole]));
            let part = part.map(vertex);
            leaning(part) >= upright && quality(part) >= least
        };
        let (topology, origins) = t.halved(&cuts, stands);
        let vertices = origins.par_iter().with_min_len(1024).map(|&corner| *vertex(corner)).collect();
        (self.topology, self.vertices, self.unused) = (topology, vertices, 0);
    }

    /// Makes all given places vertices: each is on the edge that goes on from the last one before it on its border.
    fn cut_border(&mut self, given: &[Place], are_there: &[bool]) {
        let stations = Stations::new(self.manifold);
        let mut order: Vec<(usize, f64, usize)> =
            (0..).zip(given).filter_map(|(i, place)| stations.of(place).map(|(curve, at)| (curve, at, i))).collect();
        order.sort_by(|x, y| x.0.cmp(&y.0).then(x.1.total_cmp(&y.1)).then(x.2.cmp(&y.2)));
        let mut vertices: BTreeMap<usize, VertexId> = BTreeMap::new();
        vertices.extend(self.topology.vertices().filter_map(|v| Some((self.at(v).given? as usize, v))));
        for curve in order.chunk_by(|x, y| x.0 == y.0) {
            let Some(first) = curve.iter().position(|&(_, _, i)| are_there[i]) else { continue };
            let mut behind = curve[first].2;
            for &(_, _, i) in curve[first + 1..].iter().chain(&curve[..first]) {
                if let Some(h) = self.topology.start(vertices[&behind]).filter(|_| !are_there[i]) {
                    let vertex = Vertex { given: Some(i as u32), ..self.vertex(given[i]) };
                    let rest = self.split(h, vertex);
                    vertices.insert(i, self.topology.origin(rest));
                }
                behind = i;
            }
        }
    }
}

/// Where places are on the border of a surface.
struct Stations<'a> {
    surface: &'a Manifold,
    /// By edge, the closed curve of the border that it is of, and how many edges of this are before it.
    edges: BTreeMap<HalfEdge, (usize, f64)>,
}

impl<'a> Stations<'a> {
    fn new(surface: &'a Manifold) -> Self {
        let (t, mut edges) = (surface.topology(), BTreeMap::new());
        for (curve, first) in t.borders().enumerate() {
            let (mut next, mut before) = (Some(first), 0.0);
            while let Some(h) = next.filter(|h| !edges.contains_key(h)) {
                edges.insert(h, (curve, before));
                before += 1.0;
                next = t.start(t.target(h));
            }
        }
        Self { surface, edges }
    }

    /// The curve, and how many edges of it are before the place.
    fn of(&self, place: &Place) -> Option<(usize, f64)> {
        let sides = place.face.half_edges();
        if let Some(corner) = (0..3).find(|&k| place.weights[k] >= 1.0) {
            let t = self.surface.topology();
            return self.edges.get(&t.start(t.origin(sides[corner]))?).copied();
        }
        let least = (0..3).min_by(|&j, &k| place.weights[j].total_cmp(&place.weights[k]))?;
        let (curve, before) = self.edges.get(&sides[(least + 1) % 3])?;
        Some((*curve, before + place.weights[(least + 2) % 3]))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Holding, Wanted, adapted};
    use super::*;
    use crate::geometry::Tensor3;
    use crate::manifold::surface::FeatureOptions;
    use crate::manifold::surface::metric::Constant;
    use crate::test_cases::cube;

    /// On a cube that is cut along its edges, every other place on these is given at first.
    #[test]
    fn finer_triangulations_have_all_places_and_next_to_all_edges_halved() {
        let manifold = Manifold::of(&cube(6, 0.0)).unwrap().cut(&FeatureOptions::default()).unwrap();
        let t = manifold.topology();
        let given: Vec<Place> =
            t.vertices().filter(|&v| t.is_border_vertex(v)).filter_map(|v| manifold.place_of(v)).collect();
        // Corners and every other one between them are there already.
        let steps = |place: &Place| place.position.to_array().map(|x| (6.0 * x).round() as i64);
        let are_there: Vec<bool> = given.iter().map(|place| steps(place).iter().all(|step| step % 2 == 0)).collect();
        let first: Vec<Place> =
            given.iter().zip(&are_there).filter(|(_, is_there)| **is_there).map(|(place, _)| *place).collect();
        assert!(2 * first.len() == given.len(), "{} {}", first.len(), given.len());
        let metric = Constant(Tensor3::IDENTITY * 9.0);
        let wanted = Wanted { given: &first, factor: 1.0, count: 6 * 16, held: Holding::Near(&[]) };
        let coarse = adapted(&manifold, &metric, &wanted).unwrap();
        assert!(coarse.stuck.is_empty());
        let (places, topology) = (&coarse.places, &coarse.topology);
        let halving = Halving { places, topology, given: &given, are_there: &are_there, factor: 4.0, count: 6 * 49 };
        let fine = halved(&manifold, &metric, &halving);
        fine.topology.check().unwrap();
        assert!(fine.stuck.is_empty() && fine.staying == given.len());
        assert_eq!(fine.places.len(), 6 * 49);
        for (place, given) in fine.places.iter().zip(&given) {
            assert_eq!(place.position, given.position);
        }
        let position = |v: VertexId| fine.places[v.index()].position;
        for h in fine.topology.edges() {
            let [a, b] = fine.topology.ends(h).map(position);
            assert!((0.25..=2.0).contains(&(6.0 * a.distance(b))), "{a} {b}");
        }
    }
}
