//! A grid of cubes cut into tetrahedra, and where the edges of these change sign.

use super::Implicit;
use crate::error::{Error, Result};
use crate::geometry::{Aabb3, Point3, Vector3};
use crate::parallel::prelude::*;
use std::collections::HashMap;

/// Values of a function at the vertices of a grid.
pub(super) struct Grid {
    bounds: Aabb3,
    step: Vector3,
    /// Cubes along each axis.
    cubes: [usize; 3],
    values: Vec<f64>,
}

/// Edges of tetrahedra that change sign, each by its grid vertices (first the inner one, where f < 0), and the triangles
/// between them, by their numbers, f > 0 on the side from which they are counter-clockwise.
#[derive(Default)]
pub(super) struct Crossings {
    pub(super) edges: Vec<[usize; 2]>,
    pub(super) triangles: Vec<[u32; 3]>,
    known: HashMap<[usize; 2], u32>,
}

/// Values that a grid may have: 400 megabytes.
const MOST_VALUES: f64 = 5e7;

/// Paths along three edges of a cube from its lowest to its highest corner: one tetrahedron each (Kuhn's subdivision),
/// and the diagonals of faces are the same from both sides.
const PATHS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

impl Grid {
    /// The values of f on a box, at steps of at most `size` (but for rounding).
    ///
    /// # Errors
    /// [`Error::Limit`] of too many steps; [`Error::Domain`] where f is NaN.
    pub(super) fn new(f: &dyn Implicit, bounds: Aabb3, size: f64) -> Result<Self> {
        let extent = bounds.extent();
        let counts = [extent.x, extent.y, extent.z].map(|length| (length / size - 1e-9).ceil().max(1.0));
        let needed: f64 = counts.iter().map(|count| count + 1.0).product();
        if needed.is_nan() || needed > MOST_VALUES {
            let what = format!("a grid of {needed:.0} points for the implicit surface; at most {MOST_VALUES:.0}");
            return Err(Error::limit(what, "ask for longer edges, or choose a smaller box"));
        }
        let cubes = counts.map(|count| count as usize);
        let step = Vector3::new(extent.x / counts[0], extent.y / counts[1], extent.z / counts[2]);
        let mut grid = Self { bounds, step, cubes, values: Vec::new() };
        grid.values = (0..needed as usize).into_par_iter().map(|i| f.value(grid.position(i))).collect();
        match grid.values.iter().position(|value| value.is_nan()) {
            None => Ok(grid),
            Some(i) => {
                let help = "check the expression for roots and logarithms of negative numbers, or choose another box";
                Err(Error::domain("f is not a number", grid.position(i).to_string(), help))
            }
        }
    }

    /// The least and the largest value.
    pub(super) fn range(&self) -> [f64; 2] {
        let start = [f64::INFINITY, f64::NEG_INFINITY];
        self.values.iter().fold(start, |[least, most], &value| [least.min(value), most.max(value)])
    }

    /// The shortest step.
    pub(super) fn step(&self) -> f64 {
        self.step.x.min(self.step.y).min(self.step.z)
    }

    /// Where a vertex is; those of the sides are in the sides, exactly: what lands beyond them is outside.
    pub(super) fn position(&self, vertex: usize) -> Point3 {
        let [low, high] = [self.bounds.min, self.bounds.max].map(Point3::to_array);
        let (at, cubes) = (self.indices(vertex), self.cubes);
        let [x, y, z] = [0, 1, 2].map(|i| {
            let part = at[i] as f64 / cubes[i] as f64;
            low[i] * (1.0 - part) + high[i] * part
        });
        Point3::new(x, y, z)
    }

    /// The numbers of a vertex along the axes.
    fn indices(&self, vertex: usize) -> [usize; 3] {
        let [nx, ny, _] = self.cubes;
        [vertex % (nx + 1), vertex / (nx + 1) % (ny + 1), vertex / ((nx + 1) * (ny + 1))]
    }

    /// A point of the edge between two grid vertices, at a part of its length.
    pub(super) fn between(&self, [a, b]: [usize; 2], t: f64) -> Point3 {
        self.position(a).lerp(self.position(b), t)
    }

    /// On which sides of the box a vertex is, along each axis: 1 on the upper one, -1 on the lower one, else 0.
    pub(super) fn sides(&self, vertex: usize) -> [i8; 3] {
        let (at, cubes) = (self.indices(vertex), self.cubes);
        [0, 1, 2].map(|i| i8::from(at[i] == cubes[i]) - i8::from(at[i] == 0))
    }

    /// The value at a vertex.
    pub(super) fn value(&self, vertex: usize) -> f64 {
        self.values[vertex]
    }

    /// All crossings, in an order that depends on nothing but the grid.
    pub(super) fn crossings(&self) -> Crossings {
        let [nx, ny, nz] = self.cubes;
        let stride = [1, nx + 1, (nx + 1) * (ny + 1)];
        let mut found = Crossings::default();
        for k in 0..nz {
            for j in 0..ny {
                for i in 0..nx {
                    self.cut_cube(i + j * stride[1] + k * stride[2], stride, &mut found);
                }
            }
        }
        found
    }

    fn cut_cube(&self, low: usize, stride: [usize; 3], found: &mut Crossings) {
        let [x, y, z] = stride;
        let corners = [0, x, y, x + y, z, x + z, y + z, x + y + z].map(|offset| self.values[low + offset] < 0.0);
        if corners.iter().all(|&inner| inner == corners[0]) {
            return;
        }
        for path in PATHS {
            let second = low + stride[path[0]];
            let third = second + stride[path[1]];
            self.cut_tetrahedron([low, second, third, third + stride[path[2]]], found);
        }
    }

    fn cut_tetrahedron(&self, corners: [usize; 4], found: &mut Crossings) {
        let (inner, outer): (Vec<usize>, Vec<usize>) = corners.iter().partition(|&&v| self.values[v] < 0.0);
        let ring: Vec<[usize; 2]> = match (&inner[..], &outer[..]) {
            (&[a], &[b, c, d]) => vec![[a, b], [a, c], [a, d]],
            (&[a, b, c], &[d]) => vec![[a, d], [b, d], [c, d]],
            (&[a, b], &[c, d]) => vec![[a, c], [a, d], [b, d], [b, c]],
            _ => return,
        };
        let middle = |[a, b]: [usize; 2]| self.position(a).lerp(self.position(b), 0.5);
        let normal = (middle(ring[1]) - middle(ring[0])).cross(middle(ring[2]) - middle(ring[0]));
        let turned = normal.dot(self.position(outer[0]) - self.position(inner[0])) < 0.0;
        let numbers: Vec<u32> = ring.into_iter().map(|edge| found.number(edge)).collect();
        for pair in numbers[1..].windows(2) {
            let [a, b] = if turned { [pair[1], pair[0]] } else { [pair[0], pair[1]] };
            found.triangles.push([numbers[0], a, b]);
        }
    }
}

impl Crossings {
    fn number(&mut self, edge: [usize; 2]) -> u32 {
        *self.known.entry(edge).or_insert_with(|| {
            self.edges.push(edge);
            self.edges.len() as u32 - 1
        })
    }
}
