//! Nodes of triangles on a surface f = 0, moved along it to where triangles are nearest to it.
//!
//! Between nodes that are on the surface triangles of order p are away from it by the power p + 1 of their size, wherever on it nodes are. What is left at
//! that power has fewer numbers than nodes have ways to go along the surface: for p = 2 one for each side and each triangle, five for each vertex, where
//! nodes have six. Where the surface bends, going along it a little, a higher power of the size, makes up for these: the power is p + 2 then.

use super::bezier::{MOST, bernstein, exponents, points_of_nodes};
use crate::geometry::{Point, Point3, TangentPlane, Vector3};
use crate::manifold::Manifold;
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use crate::sparse::conjugate_gradients;

/// Gauss and Newton's steps, and steps of conjugate gradients for each. On tori of 250 to 16,000 vertices two and 20 leave triangles of order 2 as near but
/// for a twentieth, those of order 3 up to 1.8 times as far away.
const STEPS: usize = 3;
const CONJUGATE_STEPS: usize = 60;
/// A node goes by this share of the longest edge around at most in a step, and to go so far costs as much as all that is seen around a node. On the
/// coarsest of these tori a thirtieth leaves 1.8 times the distance, a sixtieth 2.6 times; with a tenth no node went farther than a thirtieth.
const SHARE: f64 = 0.1;

/// The triangles whose nodes slide.
pub(super) struct Sliding<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) manifold: &'a Manifold,
    pub(super) order: usize,
    /// The numbers of each triangle's nodes, one triangle after the other.
    pub(super) triangles: &'a [u32],
    /// Which coordinates of nodes stay.
    pub(super) pins: &'a [[bool; 3]],
}

/// What is seen of a triangle: squares of its distances from the surface, half the derivative of their sum by where its nodes go along their tangents, and
/// half the second one where distances change linearly, all rows of it.
struct Seen {
    square: f64,
    slope: Vec<f64>,
    curvature: Vec<f64>,
}

/// What holds a node.
struct Spring {
    /// What it costs to go along the surface, by the square of the length.
    stiffness: f64,
    /// How far it goes in a step at most.
    reach: f64,
}

impl Sliding<'_> {
    /// Moves nodes that are on the surface to where the squares of the triangles' distances from it are least, beside what it costs to go there.
    pub(super) fn slide(&self, nodes: &mut Vec<Option<Point3>>) {
        let start = nodes.clone();
        let weights = weights(self.order);
        let see = |nodes: &[Option<Point3>], tangents: &[[Vector3; 2]]| -> Vec<Seen> {
            let count = self.triangles.len() / self.per_triangle();
            (0..count).into_par_iter().map(|t| self.see(t, &weights, nodes, tangents)).collect()
        };
        let mut tangents = self.tangents(nodes);
        let mut seen = see(nodes, &tangents);
        let springs = self.springs(&seen);
        let cost = |seen: &[Seen], nodes: &[Option<Point3>]| -> f64 {
            let of_node = |(n, spring): (usize, &Spring)| spring.stiffness * gone(start[n], nodes[n]).norm().powi(2);
            seen.iter().map(|it| it.square).sum::<f64>() + springs.iter().enumerate().map(of_node).sum::<f64>()
        };
        for _ in 0..STEPS {
            let back: Vec<f64> = (0..nodes.len())
                .flat_map(|n| tangents[n].map(|way| springs[n].stiffness * gone(start[n], nodes[n]).dot(way)))
                .collect();
            let step = self.step(&seen, &springs, &back);
            let moved = |n: usize| -> Option<Point3> {
                let (from, [u, v]) = (nodes[n]?, tangents[n]);
                let way = u * step[2 * n] + v * step[2 * n + 1];
                let share = (springs[n].reach / way.norm()).min(1.0);
                self.manifold.onto(from + way * share, self.pins[n]).or(Some(from))
            };
            let moved: Vec<Option<Point3>> = (0..nodes.len()).into_par_iter().map(moved).collect();
            let tangents_there = self.tangents(&moved);
            let next = see(&moved, &tangents_there);
            let gains = cost(&next, &moved) < cost(&seen, nodes);
            if !gains {
                break;
            }
            (*nodes, tangents, seen) = (moved, tangents_there, next);
        }
    }

    fn per_triangle(&self) -> usize {
        exponents(self.order).len() - 3
    }

    fn of_triangle(&self, triangle: usize) -> &[u32] {
        &self.triangles[self.per_triangle() * triangle..][..self.per_triangle()]
    }

    /// Unit vectors along which nodes may go; zero where they may not.
    fn tangents(&self, nodes: &[Option<Point3>]) -> Vec<[Vector3; 2]> {
        let of_node = |n: usize| {
            let normal = self.normal(nodes[n]?)?.1;
            let axes = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)];
            let mut pinned =
                axes.into_iter().zip(self.pins[n]).filter_map(|(axis, is_pinned)| is_pinned.then_some(axis));
            match (pinned.next(), pinned.next()) {
                (None, _) => Some(TangentPlane::new(normal)).map(|plane| [plane.u, plane.v]),
                (Some(axis), None) => Some([normal.cross(axis).unit()?, Vector3::default()]),
                _ => None,
            }
        };
        (0..nodes.len()).into_par_iter().map(|n| of_node(n).unwrap_or_default()).collect()
    }

    /// The distance to the surface, to first order, and its gradient.
    fn normal(&self, p: Point3) -> Option<(f64, Vector3)> {
        let jet = self.manifold.equation()?.jet(p);
        let (distance, normal) = (jet.value / jet.gradient.norm(), jet.gradient.unit()?);
        distance.is_finite().then_some((distance, normal))
    }

    fn see(&self, triangle: usize, weights: &[Vec<f64>], nodes: &[Option<Point3>], tangents: &[[Vector3; 2]]) -> Seen {
        let numbers = self.of_triangle(triangle);
        let unknowns = 2 * numbers.len();
        let mut seen = Seen { square: 0.0, slope: vec![0.0; unknowns], curvature: vec![0.0; unknowns * unknowns] };
        let corners = self.mesh.positions_of(self.mesh.triangles[triangle]);
        let Some(inner) = numbers.iter().map(|&n| nodes[n as usize]).collect::<Option<Vec<Point3>>>() else {
            return seen;
        };
        for weights in weights {
            let sum = corners.iter().chain(&inner).zip(weights);
            let place = sum.fold(Vector3::default(), |sum, (&p, &w)| sum + (p - Point3::default()) * w);
            let Some((distance, normal)) = self.normal(Point3::default() + place) else { continue };
            let ways = numbers.iter().zip(&weights[3..]);
            let form: Vec<f64> =
                ways.flat_map(|(&n, &w)| tangents[n as usize].map(|way| w * normal.dot(way))).collect();
            seen.square += distance * distance;
            for (i, one) in form.iter().enumerate() {
                seen.slope[i] += distance * one;
                let row = &mut seen.curvature[unknowns * i..][..unknowns];
                row.iter_mut().zip(&form).for_each(|(entry, other)| *entry += one * other);
            }
        }
        seen
    }

    /// What holds each node.
    fn springs(&self, seen: &[Seen]) -> Vec<Spring> {
        let (mut squares, mut reach) = (vec![0.0; self.pins.len()], vec![0.0_f64; self.pins.len()]);
        for (t, seen) in seen.iter().enumerate() {
            let [a, b, c] = self.mesh.positions_of(self.mesh.triangles[t]);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            for &n in self.of_triangle(t) {
                squares[n as usize] += seen.square;
                reach[n as usize] = reach[n as usize].max(SHARE * longest);
            }
        }
        let of_node = |(&square, &reach): (&f64, &f64)| Spring { stiffness: square / (reach * reach), reach };
        squares.iter().zip(&reach).map(of_node).collect()
    }

    /// How far nodes are to go along their tangents.
    fn step(&self, seen: &[Seen], springs: &[Spring], back: &[f64]) -> Vec<f64> {
        let rows = |t: usize| self.of_triangle(t).iter().flat_map(|&n| [2 * n as usize, 2 * n as usize + 1]);
        let mut right: Vec<f64> = back.iter().map(|x| -x).collect();
        let stiffness: Vec<f64> = springs.iter().flat_map(|spring| [spring.stiffness; 2]).collect();
        let mut diagonal = stiffness.clone();
        for (t, seen) in seen.iter().enumerate() {
            for (i, row) in rows(t).enumerate() {
                right[row] -= seen.slope[i];
                diagonal[row] += seen.curvature[(seen.slope.len() + 1) * i];
            }
        }
        let times = |x: &[f64]| {
            let of_triangle = |(t, seen): (usize, &Seen)| -> Vec<f64> {
                let x: Vec<f64> = rows(t).map(|row| x[row]).collect();
                seen.curvature.chunks(x.len()).map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum()).collect()
            };
            let images: Vec<Vec<f64>> = seen.par_iter().enumerate().map(of_triangle).collect();
            let mut sum: Vec<f64> = x.iter().zip(&stiffness).map(|(x, s)| x * s).collect();
            for (t, image) in images.iter().enumerate() {
                rows(t).zip(image).for_each(|(row, value)| sum[row] += value);
            }
            sum
        };
        conjugate_gradients(times, &diagonal, &right, vec![0.0; right.len()], CONJUGATE_STEPS)
    }
}

/// How far a node is from where it started.
fn gone(start: Option<Point3>, now: Option<Point3>) -> Vector3 {
    start.zip(now).map_or_else(Vector3::default, |(start, now)| now - start)
}

/// The weights of a triangle's nodes at places between them: those of a lattice of half the steps that are no nodes.
fn weights(order: usize) -> Vec<Vec<f64>> {
    let count = exponents(order).len();
    let steps = 2 * order;
    let lattice = (0..=steps).flat_map(|i| (0..=steps - i).map(move |j| [i, j, steps - i - j]));
    let of_place = |place: [usize; 3]| -> Vec<f64> {
        let basis = bernstein(order, place.map(|i| i as f64 / steps as f64));
        let of_node = |n: usize| -> f64 {
            let mut nodes = [Point::default(); MOST];
            nodes[n].x = 1.0;
            points_of_nodes(&nodes, order)[..count].iter().zip(basis).map(|(p, b)| p.x * b).sum()
        };
        (0..count).map(of_node).collect()
    };
    lattice.filter(|place| place.iter().any(|i| i % 2 == 1)).map(of_place).collect()
}
