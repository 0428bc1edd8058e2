//! Moves and flips that lower the error. Vertices move in groups without edges between them: those of a group can move at once.

use super::frame::Frame;
use super::objective::Place;
use super::{Sheet, Work, is_allowed};
use crate::dual::Kind;
use crate::elementary::Elementary;
use crate::geometry::{Jet, Vector};
use crate::metric::Near;
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, Rounds, Triangulation, VertexId, flip_in_rounds};

/// Moves shorter than this change too little for neighbours to be tried again.
const SMALL: f64 = 0.03;
/// Shorter moves that are tried when a move does not lower the error, and by how much they are shorter.
const TRIALS: usize = 5;
const SHORTER: f64 = 0.4;

impl<S: Sheet> Work<S> {
    /// Moves every vertex that is awake once, those of one colour at a time. Returns how many moved. Awake are then those around moves
    /// that were not [`SMALL`].
    pub(super) fn move_all(&mut self) -> u64 {
        let mut moved = 0;
        let awake = std::mem::replace(&mut self.awake, vec![false; self.places.len()]);
        let is_tried = |v: VertexId| awake[v.index()] && !matches!(self.sheet.kind(v), Kind::Corner(_) | Kind::Held);
        for group in colours(self.sheet.topology(), is_tried) {
            let better: Vec<Option<(Place<S::At>, f64)>> =
                group.par_iter().with_min_len(16).map(|&v| self.better(v)).collect();
            for (v, better) in group.into_iter().zip(better) {
                let Some((place, step)) = better else { continue };
                if self.sheet.move_vertex(v, place.at) {
                    self.places[v.index()] = place;
                    self.has_moved[v.index()] = true;
                    moved += 1;
                    if step > SMALL {
                        self.wake(v);
                    }
                }
            }
        }
        moved
    }

    /// A vertex and its neighbours are to be tried again.
    fn wake(&mut self, v: VertexId) {
        self.awake[v.index()] = true;
        for u in self.sheet.topology().around(v) {
            self.awake[u.index()] = true;
        }
    }

    /// Where a vertex would better be, and how far that is in the unit of [`STEP`]: a step of Newton's method on the error around it.
    fn better(&self, v: VertexId) -> Option<(Place<S::At>, f64)> {
        let topology = self.sheet.topology();
        let ring: Vec<[VertexId; 2]> = topology.star(v).map(|h| [topology.target(h), topology.apex(h)]).collect();
        let corners = |place: Place<S::At>, [a, b]: [VertexId; 2]| [place, self.place(a), self.place(b)];
        let error_at = |place: Place<S::At>| -> f64 {
            ring.iter().map(|&side| self.objective.of(&self.sheet, corners(place, side))).sum()
        };
        let shape_at = |place: Place<S::At>| {
            ring.iter().map(|&[a, b]| self.shape([v, a, b], corners(place, [a, b]))).fold(f64::INFINITY, f64::min)
        };
        let frame = self.frame(v, &ring)?;
        let here = self.place(v);
        let place = |step: [f64; 2]| {
            let at = self.sheet.stepped(v, &frame, step)?;
            Some(Place { at, value: self.sheet.value(at) })
        };
        let around = match self.expansion(v, &ring, &frame) {
            Some(jet) => jet,
            None => frame.differences(error_at(here), |step| place(step).map_or(f64::INFINITY, error_at)),
        };
        let (now, [mut x, mut y]) = (around.value, frame.newton(around)?);
        for _ in 0..TRIALS {
            let there = place([x, y])?;
            if error_at(there) < now && is_allowed(shape_at(here), shape_at(there)) {
                return Some((there, x.hypotenuse(y)));
            }
            (x, y) = (x * SHORTER, y * SHORTER);
        }
        None
    }

    /// The error around a vertex, by derivatives of the function in a frame, where these are known.
    fn expansion(&self, v: VertexId, ring: &[[VertexId; 2]], frame: &Frame) -> Option<Jet> {
        let here = self.place(v);
        let known = self.sheet.jet_within([here.at; 3], [1.0, 0.0, 0.0], frame, &mut Near::default())?;
        let moved = [[1.0, 0.0], [0.0, 1.0]].map(|step| self.sheet.stepped(v, frame, step));
        ring.iter().try_fold(Jet::default(), |sum, &[a, b]| {
            let corners = [here, self.place(a), self.place(b)];
            Some(sum + self.objective.expansion(&self.sheet, corners, frame, known, moved)?)
        })
    }

    /// The directions and lengths in which a vertex can move: those of the ellipse of inertia of its neighbours.
    fn frame(&self, v: VertexId, ring: &[[VertexId; 2]]) -> Option<Frame> {
        if self.sheet.kind(v) == Kind::Curve {
            return self.sheet.on_segment(v);
        }
        let around: Vec<Vector> = ring.iter().flatten().map(|&u| self.sheet.offset(v, u)).collect();
        let mean = |of: fn(&Vector) -> f64| around.iter().map(of).sum::<f64>() / around.len() as f64;
        let (xx, xy, yy) = (mean(|d| d.x * d.x), mean(|d| d.x * d.y), mean(|d| d.y * d.y));
        let first = Vector::new(xx.sqrt(), xy / xx.sqrt());
        let rest = (yy - first.y * first.y).max(0.0).sqrt();
        (first.x > 0.0 && rest > 0.0).then_some(Frame { segment: None, first, second: Some(Vector::new(0.0, rest)) })
    }
}

/// The vertices that can move, by colour: greedily, in the order of their ids.
pub(super) fn colours(topology: &Triangulation, can_move: impl Fn(VertexId) -> bool) -> Vec<Vec<VertexId>> {
    const NONE: u16 = u16::MAX;
    let mut colour = vec![NONE; topology.vertex_slots()];
    let mut groups: Vec<Vec<VertexId>> = Vec::new();
    let mut is_taken: Vec<bool> = Vec::new();
    for v in topology.vertices().filter(|&v| can_move(v)) {
        is_taken.clear();
        is_taken.resize(groups.len() + 1, false);
        for u in topology.around(v) {
            if let Some(taken) = is_taken.get_mut(usize::from(colour[u.index()])) {
                *taken = true;
            }
        }
        let free = is_taken.iter().position(|taken| !taken).unwrap_or(groups.len());
        if free == groups.len() {
            groups.push(Vec::new());
        }
        colour[v.index()] = free as u16;
        groups[free].push(v);
    }
    groups
}

/// Rounds of flips in a sweep, at most: the next sweep has more.
const ROUNDS: usize = 8;
/// A flip gains this share of the two triangles' error at least.
const GAIN: f64 = 1e-9;

impl<S: Sheet> Work<S> {
    /// Flips until no edge gains by it; the greatest gains first. Returns how many flips.
    pub(super) fn flip_all(&mut self) -> u64 {
        flip_in_rounds(self, ROUNDS)
    }

    /// By how much a flip would lower the error, of which all shares are known; `None` where it would not, or may not be.
    fn gain(&self, h: HalfEdge) -> Option<f64> {
        let [a, b, c, d] = self.sheet.topology().quad(h).filter(|_| self.sheet.may_flip(h))?;
        let of = |vertices: [VertexId; 3]| self.objective.of(&self.sheet, self.places_of(vertices));
        let (old, new) = ([[a, b, c], [b, a, d]], [[d, b, c], [c, a, d]]);
        let before: f64 = self.sheet.topology().sides(h).map(|side| self.shares[side.face().index()]).sum();
        let gain = before - new.into_iter().map(of).sum::<f64>();
        if gain.is_nan() || gain <= GAIN * before {
            return None;
        }
        let least = |faces: [[VertexId; 3]; 2]| {
            faces.into_iter().map(|f| self.shape(f, self.places_of(f))).fold(f64::INFINITY, f64::min)
        };
        is_allowed(least(old), least(new)).then_some(gain)
    }

    fn places_of(&self, vertices: [VertexId; 3]) -> [Place<S::At>; 3] {
        vertices.map(|v| self.place(v))
    }
}

impl<S: Sheet> Rounds for Work<S> {
    fn topology(&self) -> &Triangulation {
        self.sheet.topology()
    }

    fn wanted(&mut self, edges: &[HalfEdge]) -> Vec<(f64, HalfEdge)> {
        let is_awake = |&&h: &&HalfEdge| self.sheet.topology().ends(h).iter().any(|v| self.awake[v.index()]);
        let awake = edges.par_iter().with_min_len(64).filter(is_awake);
        awake.filter_map(|&h| Some((-self.gain(h)?, h))).collect()
    }

    fn flip(&mut self, h: HalfEdge) -> bool {
        let is_flipped = self.sheet.flip(h);
        if is_flipped {
            for side in self.sheet.topology().sides(h) {
                self.shares[side.face().index()] = self.share(side.face());
            }
            for v in self.sheet.topology().ends(h) {
                self.wake(v);
            }
        }
        is_flipped
    }
}

#[cfg(test)]
mod tests {
    use super::super::plane::Flat;
    use super::*;
    use crate::geometry::{Point, Tensor};
    use crate::manifold::domain::Domain;
    use crate::metric::{Expression, Norm, Snapshot, Variables};
    use crate::optimise::springs::tests::seeded;
    use crate::planar::delaunay;

    #[test]
    fn derivatives_of_the_error_are_those_of_its_values() {
        let text = "tanh(3*x - y) + x^3*y";
        let function = Snapshot::from(Expression::parse(text, Variables::Plane).unwrap());
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let metric = |_: Point| Tensor::isotropic(0.2);
        let dual = seeded(&domain, &metric);
        for p in [1.0, 2.0, 3.0] {
            let work = Work::new(Flat::new(&dual, &function), Norm::new(p).unwrap()).unwrap().unwrap();
            for v in work.sheet.topology().vertices().filter(|&v| work.sheet.kind(v) == Kind::Free) {
                let topology = work.sheet.topology();
                let ring: Vec<[VertexId; 2]> =
                    topology.star(v).map(|h| [topology.target(h), topology.apex(h)]).collect();
                let frame = work.frame(v, &ring).unwrap();
                let error_at = |[x, y]: [f64; 2]| -> f64 {
                    // Small steps, for differences of the function are taken where it has a third derivative, too.
                    let at = work.sheet.stepped(v, &frame, [0.01 * x, 0.01 * y]).unwrap();
                    let there = Place { at, value: work.sheet.value(at) };
                    ring.iter()
                        .map(|&[a, b]| work.objective.of(&work.sheet, [there, work.place(a), work.place(b)]))
                        .sum()
                };
                let exact = work.expansion(v, &ring, &frame).unwrap();
                let rough = frame.differences(error_at([0.0; 2]), error_at);
                assert_eq!(exact.value.to_bits(), rough.value.to_bits());
                let off = exact.gradient * 0.01 - rough.gradient;
                assert!(off.norm() < 1e-5 * (rough.gradient.norm() + exact.value), "{p}: {exact:?} {rough:?}");
                if p > 1.0 {
                    let off = exact.hessian * 1e-4 - rough.hessian;
                    let size = rough.hessian.xx.abs() + rough.hessian.yy.abs();
                    assert!(off.xx.abs() + off.xy.abs() + off.yy.abs() < 1e-2 * size, "{p}: {exact:?} {rough:?}");
                }
            }
        }
    }

    #[test]
    fn no_edge_is_inside_a_group_and_no_vertex_is_forgotten() {
        let at = |i: u32| Point::new((f64::from(i) * 0.618).fract(), (f64::from(i) * 0.414).fract());
        let points: Vec<Point> = (0..500).map(at).collect();
        let planar = delaunay(&points).unwrap();
        let groups = colours(&planar.topology, |v| v != VertexId(7));
        let mut group = vec![usize::MAX; planar.topology.vertex_slots()];
        for (i, all) in groups.iter().enumerate() {
            for v in all {
                group[v.index()] = i;
            }
        }
        let ends = |h| planar.topology.ends(h).map(|v| group[v.index()]);
        assert!(planar.topology.edges().map(ends).all(|[a, b]| a != b));
        let has_none = |v: &VertexId| group[v.index()] == usize::MAX;
        assert_eq!(planar.topology.vertices().filter(has_none).collect::<Vec<_>>(), [VertexId(7)]);
        assert!(groups.len() <= 12, "{}", groups.len());
    }
}
