//! Shortest ways on a surface between vertices of a canvas.

use super::draped::Draped;
use crate::geodesic::taut;
use crate::geometry::{Point3, Tensor3};
use crate::surface::Place;
use crate::triangulation::VertexId;

/// A geodesic of a surface.
#[derive(Clone, Debug, Default)]
pub struct Way {
    /// Its metric length.
    pub length: f64,
    /// Where it crosses the canvas's edges, with its ends: on a surface of triangles it is straight between them.
    pub points: Vec<Point3>,
}

impl Draped<'_> {
    /// The geodesic between two vertices: pulled taut from the shortest way along edges ([`taut`]), and so exact on a surface of
    /// triangles whose metric is uniform; on an equation's surface its points are moved onto f = 0 and its length is taken
    /// anew along the surface. `None` where there is no way.
    pub fn geodesic(&self, from: VertexId, to: VertexId) -> Option<Way> {
        let found = taut(self.topology(), from, to)?;
        let topology = self.topology();
        let near = |h| self.place(topology.origin(h));
        let crossing = |&(h, t): &(_, f64)| {
            let p = self.position(topology.origin(h)).lerp(self.position(topology.target(h)), t);
            (h, p)
        };
        let ends = [from, to].map(|v| *self.place(v));
        if self.input().implicit.is_none() {
            let inner = found.crossings.iter().map(|c| crossing(c).1);
            let points = [ends[0].position].into_iter().chain(inner).chain([ends[1].position]).collect();
            return Some(Way { length: found.length, points });
        }
        let lifted = found.crossings.iter().map(crossing).map(|(h, p)| self.input().lift(near(h), p));
        let mut places: Vec<Place> = vec![ends[0]];
        places.extend(lifted.collect::<Option<Vec<Place>>>()?);
        places.push(ends[1]);
        let tensors: Vec<Tensor3> = places.iter().map(|place| self.metric().at(place)).collect();
        let piece = |i: usize| self.between([&places[i], &places[i + 1]], [tensors[i], tensors[i + 1]]);
        let length = (0..places.len() - 1).map(piece).sum();
        Some(Way { length, points: places.into_iter().map(|place| place.position).collect() })
    }
}
