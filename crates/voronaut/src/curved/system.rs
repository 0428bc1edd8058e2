//! The system of equations of a Newton step: which unknowns there are, where terms add to its matrix, and in which order it is factored.

use super::elements::{Elements, axes};
use super::term::{Expansion, Freedom};
use crate::geometry::{Point, Tensor, Vector};
use crate::mesh::edges::NONE;
use crate::parallel::prelude::*;
use crate::sparse::{Cholesky, Elimination, Symmetric, nested_dissection};

/// What is damped beside the matrix, as a share of its diagonal, where it has no factor: at first, and how it grows.
const DAMPING: f64 = 1e-9;
const MORE_DAMPING: f64 = 100.0;
/// Beyond that no step is taken.
const MOST_DAMPING: f64 = 1e3;
/// How much stiffer a point is held to a given step than by its neighbours.
const GIVEN: f64 = 1e7;

/// The points of a term, what of them may move, and where its second derivatives go.
pub(super) struct Member {
    pub(super) numbers: Vec<u32>,
    pub(super) freedoms: Vec<Freedom>,
    /// Places in the matrix of the entries of the lower half, by rows, and of their mirror images.
    places: Vec<[u32; 2]>,
}

/// See the [module](self).
pub(super) struct System {
    /// All triangles, then all sides.
    pub(super) members: Vec<Member>,
    /// Of each point its first unknown.
    first: Vec<u32>,
    matrix: Symmetric,
    elimination: Elimination,
}

impl System {
    /// That of a mesh as it is connected.
    pub(super) fn of(elements: &Elements) -> Self {
        let mut first = vec![0];
        for &hold in &elements.holds {
            first.push(first[first.len() - 1] + axes(hold).count() as u32);
        }
        let triangles = (0..elements.triangles.len()).map(|t| elements.numbers(t).to_vec());
        let mut members: Vec<Member> =
            triangles.chain(elements.sides()).map(|numbers| Member::of(numbers, elements, &first)).collect();
        // Sides are of triangles.
        let rows = |member: &Member| member.freedoms.iter().map(|f| f.row).collect();
        let groups: Vec<Vec<u32>> = members[..elements.triangles.len()].iter().map(rows).collect();
        let matrix = Symmetric::of_groups(first[first.len() - 1] as usize, &groups);
        members.par_iter_mut().for_each(|member| member.find_places(&matrix));
        let elimination = Elimination::in_order(&matrix, order(elements, &first));
        Self { members, first, matrix, elimination }
    }

    /// The step of each point that the terms ask for; where some have steps given, that of the others which costs least beside; with tensors given,
    /// half the square of a step's length in them costs beside. None where no matrix has a factor.
    pub(super) fn step(
        &mut self,
        expansions: &[Expansion],
        elements: &Elements,
        given: &[(u32, Vector)],
        held: &[Tensor],
    ) -> Option<Vec<Vector>> {
        self.matrix.clear();
        let mut slope = vec![0.0; self.matrix.size()];
        for (member, expansion) in self.members.iter().zip(expansions) {
            for (freedom, value) in member.freedoms.iter().zip(expansion.slope) {
                slope[freedom.row as usize] -= value;
            }
            for (&[place, mirror], &value) in member.places.iter().zip(&expansion.curvature) {
                self.matrix.add(place, value);
                if mirror != place {
                    self.matrix.add(mirror, value);
                }
            }
        }
        if !given.is_empty() {
            slope.fill(0.0);
        }
        for &(p, step) in given {
            for (row, value) in (self.first[p as usize]..).zip([step.x, step.y]) {
                let weight = GIVEN * self.matrix.diagonal_at(row as usize);
                slope[row as usize] = weight * value;
                self.matrix.add(self.matrix.place(row as usize, row as usize), weight);
            }
        }
        for (p, tensor) in held.iter().enumerate() {
            let rows = axes(elements.holds[p]).zip(self.first[p] as usize..);
            for (a, row) in rows.clone() {
                rows.clone().for_each(|(b, column)| self.matrix.add(self.matrix.place(row, column), tensor.dot(a, b)));
            }
        }
        let steps = self.factor()?.solve(&slope);
        let of_point = |p: usize| {
            axes(elements.holds[p])
                .zip(&steps[self.first[p] as usize..])
                .fold(Vector::default(), |sum, (axis, &step)| sum + axis * step)
        };
        Some((0..elements.points.len()).map(of_point).collect())
    }

    fn factor(&self) -> Option<Cholesky> {
        let mut damping = DAMPING;
        while damping < MOST_DAMPING {
            let added: Vec<f64> = (0..self.matrix.size()).map(|i| damping * self.matrix.diagonal_at(i)).collect();
            let factor = Cholesky::of(&self.matrix.clone().plus_diagonal(&added), &self.elimination);
            if factor.is_some() {
                return factor;
            }
            damping *= MORE_DAMPING;
        }
        None
    }
}

impl Member {
    fn of(numbers: Vec<u32>, elements: &Elements, first: &[u32]) -> Self {
        let freedoms = freedoms(&numbers, elements, |n| Some(first[n as usize]));
        Self { numbers, freedoms, places: Vec::new() }
    }

    fn find_places(&mut self, matrix: &Symmetric) {
        let rows: Vec<usize> = self.freedoms.iter().map(|f| f.row as usize).collect();
        for (a, &i) in rows.iter().enumerate() {
            let places = rows[..=a].iter().map(|&j| [matrix.place(i, j), matrix.place(j, i)]);
            self.places.extend(places);
        }
    }

    /// The positions of the term's points.
    pub(super) fn points(&self, points: &[Point]) -> Vec<Point> {
        self.numbers.iter().map(|&n| points[n as usize]).collect()
    }
}

/// What may move of some points; the number of a point's first unknown is for the caller to say, and none of points that are to stay.
pub(super) fn freedoms(numbers: &[u32], elements: &Elements, first: impl Fn(u32) -> Option<u32>) -> Vec<Freedom> {
    let mut freedoms = Vec::new();
    for (point, &number) in numbers.iter().enumerate() {
        let Some(first) = first(number) else { continue };
        for (row, axis) in (first..).zip(axes(elements.holds[number as usize])) {
            freedoms.push(Freedom { point, axis, row });
        }
    }
    freedoms
}

/// The order in which unknowns are eliminated: vertices by nested dissection, and just before a vertex what is beside it of
/// triangles and sides whose other vertices come later. Where vertices separate a mesh, so do they with the sides between them.
fn order(elements: &Elements, first: &[u32]) -> Vec<u32> {
    let edges = elements.sides().map(|side| {
        let (a, b) = (side[0], side[side.len() - 1]);
        (a.max(b), a.min(b), 0.0)
    });
    let graph = Symmetric::from_triplets(elements.vertices(), &edges.collect::<Vec<_>>());
    let mut place = vec![0; elements.vertices()];
    for (k, v) in (0_u32..).zip(nested_dissection(&graph)) {
        place[v as usize] = k;
    }
    // Ranks: of the vertex before which a point goes, then interior points, those of sides, the vertex.
    let mut ranks: Vec<(u32, u8)> = vec![(NONE, 0); elements.points.len()];
    for t in 0..elements.triangles.len() {
        let (numbers, corners) = (elements.numbers(t), elements.corners(t).map(|v| place[v as usize]));
        for (i, &n) in numbers.iter().enumerate() {
            let inner = elements.order - 1;
            ranks[n as usize] = if i < 3 {
                (corners[i], 2)
            } else if i < 3 + 3 * inner {
                let side = (i - 3) / inner;
                (corners[side].min(corners[(side + 1) % 3]), 1)
            } else {
                (corners[0].min(corners[1]).min(corners[2]), 0)
            };
        }
    }
    let mut points: Vec<u32> = (0..elements.points.len() as u32).collect();
    points.sort_by_key(|&p| ranks[p as usize]);
    points.into_iter().flat_map(|p| first[p as usize]..first[p as usize + 1]).collect()
}
