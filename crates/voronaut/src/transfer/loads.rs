//! What the old fields bring to every triangle of the new mesh: integrals over its intersections with old triangles.

use super::clip::{Frame, Overlap};
use super::cover::Shares;
use super::ground::Ground;
use super::interpolation::mean;
use super::mass::areas;
use crate::geometry::Point3;
use crate::mesh::{Located, Mesh};
use crate::parallel::prelude::*;

/// The old fields on a mesh, component by component: those that are linear on triangles, by vertex, and those that are constant
/// there, by triangle.
pub(super) struct Old<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) ground: &'a Ground,
    pub(super) linear: Vec<Vec<f64>>,
    pub(super) constant: Vec<Vec<f64>>,
}

/// What a new triangle gets, per unit of its area.
#[derive(Clone)]
pub(super) struct Load {
    /// The share of it that is covered.
    covered: f64,
    /// The integrals of the barycentric coordinates over what is covered.
    ones: [f64; 3],
    /// Of each linear component the integral of it times the barycentric coordinate of each corner.
    pub(super) products: Vec<[f64; 3]>,
    /// The least and the greatest value of each of them on the triangle.
    pub(super) ranges: Vec<(f64, f64)>,
    /// The mean of each component that is constant on old triangles.
    pub(super) means: Vec<f64>,
}

/// Uncovered shares of a triangle up to this one are rounding: what covers the rest counts for all.
const GAP: f64 = 1e-9;

impl Old<'_> {
    /// The loads of all triangles of the new mesh; those without area get none.
    pub(super) fn loads(&self, new: &Mesh) -> Vec<Load> {
        let none = Load {
            covered: 0.0,
            ones: [0.0; 3],
            products: vec![[0.0; 3]; self.linear.len()],
            ranges: vec![(f64::INFINITY, f64::NEG_INFINITY); self.linear.len()],
            means: vec![0.0; self.constant.len()],
        };
        let of_one = |near: &mut Vec<u32>, &triangle: &[u32; 3]| {
            let mut load = none.clone();
            load.gather(self, new.positions_of(triangle), near);
            load
        };
        new.triangles.par_iter().map_init(Vec::new, of_one).collect()
    }

    fn at_corners(&self, component: usize, triangle: u32) -> [f64; 3] {
        self.mesh.triangles[triangle as usize].map(|v| self.linear[component][v as usize])
    }
}

/// Which shares of the areas only one of the meshes covers.
pub(super) fn shares(loads: &[Load], old: &Mesh, new: &Mesh) -> Shares {
    let (mut total, mut uncovered, mut overlapped, mut met) = (0.0, 0.0, 0.0, 0.0);
    for (area, &Load { covered, .. }) in areas(new).into_iter().zip(loads) {
        total += area;
        uncovered += area * (1.0 - covered).max(0.0);
        overlapped += area * (covered - 1.0).max(0.0);
        met += area * covered;
    }
    let there: f64 = areas(old).iter().sum();
    let share = |part: f64, of: f64| if part > GAP * of { part / of } else { 0.0 };
    Shares { uncovered: share(uncovered, total), left: share(there - met, there), overlapped: share(overlapped, total) }
}

impl Load {
    fn gather(&mut self, old: &Old<'_>, corners: [Point3; 3], near: &mut Vec<u32>) {
        let flat = old.ground.flat(corners);
        let Some(frame) = Frame::new(corners.map(|p| flat.of(p))) else { return };
        old.ground.near(corners, near);
        for &triangle in near.iter() {
            let vertices = old.mesh.triangles[triangle as usize];
            if let Some(overlap) = frame.overlap(old.mesh.positions_of(vertices).map(|p| flat.of(p))) {
                self.add(old, triangle, &overlap);
            }
        }
        if 1.0 - self.covered > GAP { self.fill(old, corners) } else { self.settle() }
    }

    fn add(&mut self, old: &Old<'_>, triangle: u32, overlap: &Overlap) {
        self.covered += overlap.share;
        for (one, row) in self.ones.iter_mut().zip(&overlap.products) {
            *one += row.iter().sum::<f64>();
        }
        for (c, products) in self.products.iter_mut().enumerate() {
            let values = old.at_corners(c, triangle);
            for (product, row) in products.iter_mut().zip(&overlap.products) {
                *product += row[0] * values[0] + row[1] * values[1] + row[2] * values[2];
            }
            widen(&mut self.ranges[c], overlap.range(values));
        }
        for (mean, values) in self.means.iter_mut().zip(&old.constant) {
            *mean += overlap.share * values[triangle as usize];
        }
    }

    /// What is not covered has the value nearest to its centroid.
    fn fill(&mut self, old: &Old<'_>, [a, b, c]: [Point3; 3]) {
        let gaps = self.ones.map(|one| 1.0 / 3.0 - one);
        let gap = 1.0 - self.covered;
        let centroid = a + (b - a) * (gaps[1] / gap) + (c - a) * (gaps[2] / gap);
        let Some(Located { triangle, weights, .. }) = old.ground.locate(centroid) else { return };
        for (c, products) in self.products.iter_mut().enumerate() {
            let value = mean(old.at_corners(c, triangle), weights);
            for (product, gap) in products.iter_mut().zip(gaps) {
                *product += gap * value;
            }
            widen(&mut self.ranges[c], (value, value));
        }
        for (mean, values) in self.means.iter_mut().zip(&old.constant) {
            *mean += gap * values[triangle as usize];
        }
    }

    /// Makes integrals those over the whole triangle where rounding, or an old mesh that overlaps itself, left more or less.
    fn settle(&mut self) {
        for products in &mut self.products {
            for (product, one) in products.iter_mut().zip(self.ones) {
                *product /= 3.0 * one;
            }
        }
        self.means.iter_mut().for_each(|mean| *mean /= self.covered);
    }
}

fn widen(range: &mut (f64, f64), (low, high): (f64, f64)) {
    *range = (range.0.min(low), range.1.max(high));
}
