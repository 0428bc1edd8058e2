//! Neighbouring seeds as held apart by springs: a guess of the energy's second derivatives that knows what Lloyd's does not, that seeds
//! push each other.
//!
//! The energy couples neighbours at distance d, whose cells have a side of length l in common, by 2 / d times the integral over
//! that side of (y - x)(y - x')^T (Liu et al. 2009): by -d l / 2 along their edge and, in a hexagonal tessellation, by a ninth of
//! that across it. The first alone is what a spring does. Its stiffness, d l / 2, is twice what the edge has of a cell's area;
//! here all edges of a seed have equal shares.

use super::movers::Mover;
use super::quasi_newton::{add, dot};
use crate::dual::Moving;
use crate::geometry::{Tensor, Vector, to_frame};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

/// Steps of conjugate gradients: with five relaxation goes as far in a step as with the exact solution (flat metric, 4,000 seeds, five steps: mean quality 0.968 with
/// either).
const STEPS: usize = 5;
/// A seed is held where it is by a spring of this share of its cell's area as well, so that what is far away has no say. Less, and more steps
/// raise the energy where the metric is rough in places; more, and there are more steps (0.02 to 1 tried).
const ANCHOR: f64 = 0.1;
/// The share of their stiffness that springs have here. Whole, steps are short, what is remembered of them makes the next too long, and these
/// raise the energy; less than 0.4 is too long by itself (0.25 to 1 tried, on six metrics).
const STIFFNESS: f64 = 0.45;
/// Seeds that are worth a thread's while.
const PART: usize = 512;

/// Springs between seeds that can move, and from these to those that cannot or are rough. Vectors are in orthonormal frames of the metric at the seeds.
pub(super) struct Springs {
    parts: Vec<Part>,
    /// By seed: where it goes, pulled at alone.
    inverses: Vec<Tensor>,
    anchors: Vec<f64>,
}

/// The springs of [`PART`] seeds.
struct Part {
    /// Where each seed's end.
    ends: Vec<usize>,
    springs: Vec<Spring>,
}

/// One end of a spring: how much it is drawn out for moves of the seed there and of the other, times the root of its stiffness.
struct Spring {
    here: [f32; 2],
    there: [f32; 2],
    other: u32,
}

impl Springs {
    /// Of seeds that can move.
    pub(super) fn new(dual: &impl Moving, seeds: &[Mover]) -> Self {
        let net = Net::new(dual, seeds);
        let numbers = (0..seeds.len()).into_par_iter();
        let parts = seeds.par_chunks(PART).enumerate().map(|(k, part)| net.part(PART * k, part)).collect();
        let anchors: Vec<f64> = seeds.iter().map(|seed| ANCHOR * seed.mass).collect();
        let mut springs = Self { parts, inverses: Vec::new(), anchors };
        let inverse = |i: usize| springs.inverse(i, net.ends[i].line);
        springs.inverses = numbers.with_min_len(PART).map(inverse).collect();
        springs
    }

    /// Where seeds that are pulled at come to rest, nearly; pulls are covectors.
    pub(super) fn give_way(&self, pulls: &[Vector]) -> Vec<Vector> {
        let mut left = pulls.to_vec();
        let mut moves = vec![Vector::default(); pulls.len()];
        let mut direction = self.alone(&left);
        let mut square = dot(&left, &direction);
        for _ in 0..STEPS {
            let force = self.force(&direction);
            let share = square / dot(&direction, &force);
            if !share.is_finite() {
                break;
            }
            add(&mut moves, &direction, share);
            add(&mut left, &force, -share);
            let next = self.alone(&left);
            let before = std::mem::replace(&mut square, dot(&left, &next));
            let turn = square / before;
            direction.par_iter_mut().zip(&next).with_min_len(PART).for_each(|(d, &n)| *d = n + *d * turn);
        }
        moves
    }

    /// How far each seed would go if all others stayed.
    fn alone(&self, pulls: &[Vector]) -> Vec<Vector> {
        let each = pulls.par_iter().zip(&self.inverses).with_min_len(PART);
        each.map(|(&pull, inverse)| inverse.apply(pull)).collect()
    }

    /// The force that it takes to move seeds.
    fn force(&self, moves: &[Vector]) -> Vec<Vector> {
        let mut forces = vec![Vector::default(); moves.len()];
        let parts = forces.par_chunks_mut(PART).zip(&self.parts).enumerate();
        parts.for_each(|(k, (forces, part))| {
            for (j, force) in forces.iter_mut().enumerate() {
                let i = PART * k + j;
                let pushed = part.of(j).iter().fold(Vector::default(), |sum, spring| {
                    let [here, there] = [spring.here, spring.there].map(long);
                    sum + here * (here.dot(moves[i]) + there.dot(moves[spring.other as usize]))
                });
                *force = pushed + moves[i] * self.anchors[i];
            }
        });
        forces
    }

    fn inverse(&self, i: usize, line: Option<Vector>) -> Tensor {
        let springs = self.parts[i / PART].of(i % PART).iter();
        let anchor = Tensor::new(self.anchors[i], 0.0, self.anchors[i]);
        let all = springs.fold(anchor, |sum, spring| sum + Tensor::square(long(spring.here)));
        line.map_or_else(|| all.inverse(), |line| Tensor::square(line) * (1.0 / all.dot(line, line)))
    }
}

impl Part {
    fn of(&self, seed: usize) -> &[Spring] {
        let start = if seed == 0 { 0 } else { self.ends[seed - 1] };
        &self.springs[start..self.ends[seed]]
    }
}

fn long([x, y]: [f32; 2]) -> Vector {
    Vector::new(x.into(), y.into())
}

/// Nothing exact comes of a guess.
fn short(v: Vector) -> [f32; 2] {
    [v.x as f32, v.y as f32]
}

/// What springs are made of.
struct Net<'a, M> {
    dual: &'a M,
    /// By seed that can move.
    ends: Vec<End>,
    /// By vertex: its number among these; of rough seeds none.
    numbers: Vec<Option<u32>>,
}

#[derive(Clone, Copy)]
struct End {
    frame: [f64; 3],
    /// The line that it is on.
    line: Option<Vector>,
    /// The stiffness that it gives each of its springs.
    share: f64,
}

impl<'a, M: Moving> Net<'a, M> {
    fn new(dual: &'a M, seeds: &[Mover]) -> Self {
        let topology = dual.topology();
        let mut numbers = vec![None; topology.vertex_slots()];
        for (seed, i) in seeds.iter().zip(0..) {
            numbers[seed.id.index()] = Some(i).filter(|_| !seed.is_rough);
        }
        let end = |seed: &Mover| {
            let frame = dual.local(seed.id).tensor.cholesky();
            let share = STIFFNESS * seed.mass / topology.spokes(seed.id).count() as f64;
            End { frame, line: seed.line(frame), share }
        };
        Self { dual, ends: seeds.par_iter().with_min_len(PART).map(end).collect(), numbers }
    }

    fn part(&self, first: usize, seeds: &[Mover]) -> Part {
        let topology = self.dual.topology();
        let mut part = Part { ends: Vec::with_capacity(seeds.len()), springs: Vec::with_capacity(7 * seeds.len()) };
        for (i, seed) in (first..).zip(seeds) {
            if !seed.is_rough {
                let others = topology.spokes(seed.id).flat_map(|h| topology.ends(h)).filter(|&u| u != seed.id);
                part.springs.extend(others.map(|u| self.spring(i, seed.id, u)));
            }
            part.ends.push(part.springs.len());
        }
        part
    }

    fn spring(&self, i: usize, v: VertexId, u: VertexId) -> Spring {
        let here = &self.ends[i];
        let Some(j) = self.numbers[u.index()] else {
            let stiffness = (2.0 * here.share).sqrt();
            return Spring { here: short(self.way(here, [v, u]) * stiffness), there: [0.0; 2], other: i as u32 };
        };
        let there = &self.ends[j as usize];
        let stiffness = (here.share + there.share).max(0.0).sqrt();
        let [here, there] = [self.way(here, [v, u]), self.way(there, [u, v])].map(|way| short(way * stiffness));
        Spring { here, there, other: j }
    }

    /// The unit vector from a seed towards another, as far as the first can go that way.
    fn way(&self, end: &End, [from, to]: [VertexId; 2]) -> Vector {
        let offset = to_frame(end.frame, self.dual.offset(from, to));
        let way = offset * (1.0 / offset.norm());
        end.line.map_or(way, |line| line * line.dot(way))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::cell::Tangent;
    use super::super::movers::State;
    use super::*;
    use crate::dual::Dual;
    use crate::manifold::domain::Domain;
    use crate::metric::{MetricField, Scaled, Uniform};
    use crate::progress::Silent;
    use crate::sampling::{Fill, Plan, Target, refine, sample_segments};

    /// A dual as refinement leaves it.
    pub(crate) fn seeded<'a>(domain: &Domain, field: &'a dyn MetricField) -> Dual<'a> {
        let plan = Plan::new(domain.clone(), Vec::new(), field, Target::Vertices(400)).unwrap();
        let scaled = Scaled { field, factor: plan.scale_for(400.0) };
        let mut dual = Dual::new(domain.corners(), scaled).unwrap();
        sample_segments(&mut dual, &plan.edges, &plan.arcs, scaled.factor, 0);
        refine(&mut dual, Fill::AtMost(400), &Silent).unwrap();
        dual
    }

    /// Vectors without an order, along the line of a seed that is on one.
    fn scattered(springs: &Springs, seed: f64) -> Vec<Vector> {
        let any = |i: usize| Vector::new((seed * i as f64).sin(), (seed + 2.0 * i as f64).cos());
        springs.alone(&(0..springs.anchors.len()).map(any).collect::<Vec<Vector>>())
    }

    #[test]
    fn forces_are_those_of_springs() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let field = Uniform(Tensor::new(9.0, 2.0, 1.0));
        let dual = seeded(&domain, &field);
        let state = State::of(&dual, &Tangent).unwrap();
        let springs = Springs::new(&dual, &state.seeds);
        let [u, v] = [0.7, 1.3].map(|seed| scattered(&springs, seed));
        let [there, back] = [dot(&u, &springs.force(&v)), dot(&v, &springs.force(&u))];
        assert!((there - back).abs() < 1e-5 * there.abs().max(1.0), "{there} {back}");
        assert!(dot(&u, &springs.force(&u)) > 0.0);
        // What is pulled at with the force that it takes to move it goes there, nearly.
        let came = springs.give_way(&springs.force(&u));
        let off: Vec<Vector> = came.iter().zip(&u).map(|(&a, &b)| a - b).collect();
        assert!(dot(&off, &off) < 0.01 * dot(&u, &u), "{} {}", dot(&off, &off), dot(&u, &u));
        // All together springs inside hold nothing but anchors.
        let together = vec![Vector::new(1.0, 0.0); u.len()];
        let topology = dual.topology();
        let is_inside = |v: VertexId| topology.star(v).all(|h| !topology.is_border_vertex(topology.target(h)));
        for (i, force) in springs.force(&together).into_iter().enumerate() {
            let seed = &state.seeds[i];
            if !topology.is_border_vertex(seed.id) && is_inside(seed.id) {
                let off = force - Vector::new(springs.anchors[i], 0.0);
                assert!(off.norm() < 1e-6 * seed.mass, "{force:?} {}", springs.anchors[i]);
            }
        }
    }
}
