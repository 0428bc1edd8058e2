//! The vertices around one, and coordinates in which they lie evenly around it.

use super::super::neighbours::Neighbours;
use crate::geometry::{Point, Tensor, Vector};
use crate::mesh::Mesh;

/// Vertices by their rings around one: ring k are those k edges away.
pub(super) struct Rings<'a> {
    around: &'a Neighbours,
    found: Vec<u32>,
    /// Where the last ring begins.
    last: usize,
}

impl<'a> Rings<'a> {
    pub(super) fn new(around: &'a Neighbours, v: usize) -> Self {
        Self { around, found: vec![v as u32], last: 0 }
    }

    /// Adds a ring; false where nothing is left to add.
    pub(super) fn grow(&mut self) -> bool {
        let (start, end) = (self.last, self.found.len());
        let next: Vec<u32> = self.found[start..].iter().flat_map(|&v| self.around.at(v as usize)).copied().collect();
        for v in next {
            // Few enough that looking through them beats a set.
            if !self.found.contains(&v) {
                self.found.push(v);
            }
        }
        self.last = end;
        self.found.len() > end
    }

    /// All but the vertex itself, nearer rings first.
    pub(super) fn vertices(&self) -> &[u32] {
        &self.found[1..]
    }
}

/// Less than this share of its square is the rounding of a covariance's determinant.
const FLAT: f64 = 1e-24;

/// Linear coordinates in which vertices around a centre have the identity as their covariance: on meshes of any anisotropy they
/// see each other at distances of about one.
pub(super) struct Frame {
    centre: Point,
    factor: [f64; 3],
}

impl Frame {
    /// `None` where all lie on one line with the centre, or on the centre.
    pub(super) fn of(mesh: &Mesh, centre: Point, vertices: &[u32]) -> Option<Self> {
        let offsets = vertices.iter().map(|&v| mesh.point(v) - centre);
        let longest = offsets.clone().map(Vector::norm).fold(0.0, f64::max);
        if longest == 0.0 {
            return None;
        }
        // Scaled first: squares of small lengths underflow, and so do their determinants.
        let covariance = offsets
            .map(|d| d * (1.0 / longest))
            .fold(Tensor::default(), |sum, d| sum + Tensor::square(d) * (1.0 / vertices.len() as f64));
        let trace = covariance.xx + covariance.yy;
        if covariance.determinant() <= FLAT * trace * trace {
            return None;
        }
        let factor = covariance.inverse().cholesky().map(|entry| entry / longest);
        Some(Self { centre, factor })
    }

    /// A point in these coordinates.
    pub(super) fn place(&self, p: Point) -> Vector {
        let ([a, b, c], d) = (self.factor, p - self.centre);
        Vector::new(a * d.x + b * d.y, c * d.y)
    }

    /// Second derivatives by x and y from those by these coordinates: F' H F.
    pub(super) fn back(&self, h: Tensor) -> Tensor {
        let [a, b, c] = self.factor;
        h.along([Vector::new(a, 0.0), Vector::new(b, c)])
    }
}
