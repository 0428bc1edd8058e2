//! The filtered in-circle test: each level costs more and errs less, and runs only where the one before it cannot tell.

use super::Dual;
use crate::geodesic::{Angles, Length, bent_chord, frozen_margin, hermite, path_energy};
use crate::geometry::Tensor;
use crate::triangulation::{HalfEdge, VertexId};

/// Number of levels: frozen tensor, expansions at the vertices, quadrature along the chords, path energy with 8
/// segments.
pub const LEVELS: usize = 4;

/// Quadrilaterals whose shorter diagonal is longer than this (metric length) are settled by the frozen tensor: local
/// expansions say nothing so far away, and such edges are on their way to be split. So are, with
/// [`Effort::Local`], quadrilaterals at a rough vertex: expansions say nothing of them, and while seeds still move the
/// dearer levels are not worth their price.
const LONG: f64 = 3.0;

/// How far up the levels a test may climb.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// To lengths from the expansions at the vertices: no evaluation of the field.
    Local = 1,
    /// To quadrature along the chords.
    Chord = 2,
    /// To the last level: path energy.
    Full = 3,
}

/// The outcome of an in-circle test: the sine of the sum of the two angles that face the edge (see
/// [`crate::geodesic::Angles`]); negative where the edge should be flipped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// The sine.
    pub value: f64,
    /// Estimated error of `value`.
    pub error: f64,
    /// The level that settled it.
    pub level: usize,
}

impl Margin {
    /// Whether the sign is settled.
    pub fn is_certain(&self) -> bool {
        self.value.abs() > self.error
    }
}

/// The four corners of the two faces at an edge a-b: c to the left, d to the right of a -> b.
struct Quad {
    a: VertexId,
    b: VertexId,
    c: VertexId,
    d: VertexId,
}

impl Dual<'_> {
    /// The margin of an edge with two faces.
    pub fn margin(&mut self, h: HalfEdge, effort: Effort) -> Margin {
        let t = self.topology().twin(h).expect("an edge with two faces");
        let topology = self.topology();
        let quad = Quad { a: topology.origin(h), b: topology.target(h), c: topology.apex(h), d: topology.apex(t) };
        let is_rough = [quad.a, quad.b, quad.c, quad.d].iter().any(|&v| self.local(v).is_rough);
        let mut margin = self.frozen(&quad);
        if is_rough && effort == Effort::Local {
            margin.error = 0.0;
        }
        let levels = if is_rough { 2..=(effort as usize).min(2) } else { 1..=effort as usize };
        for level in levels {
            if margin.is_certain() {
                break;
            }
            match self.by_lengths(&quad, level) {
                Some(better) => margin = better,
                None => margin.error = 0.0,
            }
        }
        self.counters.tests[margin.level] += 1;
        self.counters.uncertain += u64::from(!margin.is_certain());
        margin
    }

    /// Level 0: the mean tensor of the four corners; its error from how much the corners' tensors differ.
    fn frozen(&self, quad: &Quad) -> Margin {
        let [a, b, c, d] = [quad.a, quad.b, quad.c, quad.d].map(|v| self.position(v));
        let tensors = [quad.a, quad.b, quad.c, quad.d].map(|v| self.local(v).tensor);
        let mean = tensors.iter().fold(Tensor::default(), |sum, &t| sum + t) * 0.25;
        let value = frozen_margin(mean, [a - c, b - c], [b - d, a - d]);
        let spread = |v| {
            let reference = mean.dot(v, v);
            tensors.iter().map(|t| (t.dot(v, v) / reference - 1.0).abs()).fold(0.0, f64::max)
        };
        let error = spread(b - a).max(spread(d - c));
        let is_long = mean.length(b - a).min(mean.length(d - c)) > LONG;
        Margin { value, error: if is_long { 0.0 } else { error }, level: 0 }
    }

    /// The margin from five lengths; `None` where they make no triangles, and the level before has to do.
    fn by_lengths(&self, quad: &Quad, level: usize) -> Option<Margin> {
        let length = |u: VertexId, v: VertexId| self.length_between(u, v, level);
        let Quad { a, b, c, d } = *quad;
        let (ab, ac, bc, ad, bd) = (length(a, b), length(a, c), length(b, c), length(a, d), length(b, d));
        let relative = [ab, ac, bc, ad, bd].iter().map(|l| l.error).fold(0.0, f64::max);
        let angles = Angles::from_lengths(ab.value, [ac.value, bc.value], [ad.value, bd.value]);
        (!angles.is_flat()).then(|| Margin { value: angles.margin(), error: angles.error(relative), level })
    }

    fn length_between(&self, u: VertexId, v: VertexId, level: usize) -> Length {
        let (p, q) = (self.position(u), self.position(v));
        match level {
            1 => hermite(p, self.local(u), q, self.local(v)),
            2 => bent_chord(&self.field, p, self.local(u), q, self.local(v)),
            _ => path_energy(&self.field, p, q, 8),
        }
    }
}
