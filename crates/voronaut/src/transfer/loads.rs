//! What the old fields bring to every triangle of the new mesh: integrals over its intersections with old triangles.

use super::clip::{Frame, Overlap};
use super::cover::Shares;
use super::interpolation::mean;
use super::mass::areas;
use crate::geometry::Point;
use crate::mesh::{Located, Locator, Mesh};
use crate::parallel::prelude::*;

/// Values of several components, row by row.
pub(super) struct Rows {
    /// Components of a row.
    pub(super) width: usize,
    /// One row for each vertex or triangle.
    pub(super) values: Vec<f64>,
}

/// The old fields on a mesh: components that are linear on triangles, and components that are constant there.
pub(super) struct Old<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) locator: &'a Locator,
    pub(super) linear: Rows,
    pub(super) constant: Rows,
}

/// What every new triangle gets, per unit of its area.
pub(super) struct Loads {
    width: usize,
    stride: usize,
    all: Vec<f64>,
}

/// Uncovered shares of a triangle up to this one are rounding: what covers the rest counts for all.
const GAP: f64 = 1e-9;

impl Rows {
    pub(super) fn column(&self, component: usize) -> Vec<f64> {
        self.values.iter().skip(component).step_by(self.width).copied().collect()
    }

    fn corners(&self, triangle: [u32; 3], component: usize) -> [f64; 3] {
        triangle.map(|v| self.values[v as usize * self.width + component])
    }
}

impl Loads {
    /// The loads of all triangles of the new mesh; those without area get none.
    pub(super) fn new(old: &Old<'_>, new: &Mesh) -> Self {
        let width = old.linear.width;
        let stride = 1 + 5 * width + old.constant.width;
        let mut all = vec![0.0; stride * new.triangles.len()];
        all.par_chunks_mut(stride).zip(&new.triangles).for_each_init(Vec::new, |near, (slots, &triangle)| {
            let corners = new.corners_of(triangle);
            if let Some(frame) = Frame::new(corners) {
                Gathering::new(old, slots).gather(&frame, corners, near);
            }
        });
        Self { width, stride, all }
    }

    /// The integral of a component times the barycentric coordinate of each corner.
    pub(super) fn products(&self, triangle: usize, component: usize) -> [f64; 3] {
        let slots = &self.all[triangle * self.stride + 1 + 3 * component..];
        [slots[0], slots[1], slots[2]]
    }

    /// The least and the greatest value of a component on the triangle.
    pub(super) fn range(&self, triangle: usize, component: usize) -> (f64, f64) {
        let slots = &self.all[triangle * self.stride + 1 + 3 * self.width + 2 * component..];
        (slots[0], slots[1])
    }

    /// The mean of a component that is constant on old triangles.
    pub(super) fn mean(&self, triangle: usize, component: usize) -> f64 {
        self.all[triangle * self.stride + 1 + 5 * self.width + component]
    }

    /// Which shares of the areas only one of the meshes covers.
    pub(super) fn shares(&self, old: &Mesh, new: &Mesh) -> Shares {
        let (mut total, mut uncovered, mut overlapped, mut met) = (0.0, 0.0, 0.0, 0.0);
        for (area, slots) in areas(new).into_iter().zip(self.all.chunks_exact(self.stride)) {
            total += area;
            uncovered += area * (1.0 - slots[0]).max(0.0);
            overlapped += area * (slots[0] - 1.0).max(0.0);
            met += area * slots[0];
        }
        let there: f64 = areas(old).iter().sum();
        let share = |part: f64, of: f64| if part > GAP * of { part / of } else { 0.0 };
        Shares {
            uncovered: share(uncovered, total),
            left: share(there - met, there),
            overlapped: share(overlapped, total),
        }
    }
}

/// The loads of one triangle in the making: the covered share, then integrals, ranges and means.
struct Gathering<'a> {
    old: &'a Old<'a>,
    covered: &'a mut f64,
    products: &'a mut [f64],
    ranges: &'a mut [f64],
    means: &'a mut [f64],
    /// The integrals of the barycentric coordinates over what is covered.
    ones: [f64; 3],
}

impl<'a> Gathering<'a> {
    fn new(old: &'a Old<'a>, slots: &'a mut [f64]) -> Self {
        let (covered, slots) = slots.split_first_mut().expect("a slot for the covered share");
        let (products, slots) = slots.split_at_mut(3 * old.linear.width);
        let (ranges, means) = slots.split_at_mut(2 * old.linear.width);
        for range in ranges.chunks_exact_mut(2) {
            (range[0], range[1]) = (f64::INFINITY, f64::NEG_INFINITY);
        }
        Self { old, covered, products, ranges, means, ones: [0.0; 3] }
    }

    fn gather(&mut self, frame: &Frame, corners: [Point; 3], near: &mut Vec<u32>) {
        self.old.locator.near(corners, near);
        for &triangle in near.iter() {
            let vertices = self.old.mesh.triangles[triangle as usize];
            if let Some(overlap) = frame.overlap(self.old.mesh.corners_of(vertices)) {
                self.add(triangle, vertices, &overlap);
            }
        }
        if 1.0 - *self.covered > GAP { self.fill(corners) } else { self.settle() }
    }

    fn add(&mut self, triangle: u32, vertices: [u32; 3], overlap: &Overlap) {
        *self.covered += overlap.share;
        for (one, row) in self.ones.iter_mut().zip(&overlap.products) {
            *one += row.iter().sum::<f64>();
        }
        for c in 0..self.old.linear.width {
            let values = self.old.linear.corners(vertices, c);
            for (product, row) in self.products[3 * c..][..3].iter_mut().zip(&overlap.products) {
                *product += row[0] * values[0] + row[1] * values[1] + row[2] * values[2];
            }
            let (low, high) = overlap.range(values);
            self.widen(c, low, high);
        }
        for (c, mean) in self.means.iter_mut().enumerate() {
            *mean += overlap.share * self.old.constant.values[triangle as usize * self.old.constant.width + c];
        }
    }

    fn widen(&mut self, component: usize, low: f64, high: f64) {
        let range = &mut self.ranges[2 * component..][..2];
        (range[0], range[1]) = (range[0].min(low), range[1].max(high));
    }

    /// What is not covered has the value nearest to its centroid.
    fn fill(&mut self, [a, b, c]: [Point; 3]) {
        let gaps = self.ones.map(|one| 1.0 / 3.0 - one);
        let gap = 1.0 - *self.covered;
        let centroid = a + (b - a) * (gaps[1] / gap) + (c - a) * (gaps[2] / gap);
        let Some(Located { triangle, weights, .. }) = self.old.locator.locate(centroid) else { return };
        for c in 0..self.old.linear.width {
            let value = mean(self.old.linear.corners(self.old.mesh.triangles[triangle as usize], c), weights);
            for (product, gap) in self.products[3 * c..][..3].iter_mut().zip(gaps) {
                *product += gap * value;
            }
            self.widen(c, value, value);
        }
        for (c, mean) in self.means.iter_mut().enumerate() {
            *mean += gap * self.old.constant.values[triangle as usize * self.old.constant.width + c];
        }
    }

    /// Makes integrals those over the whole triangle where rounding, or an old mesh that overlaps itself, left more or less.
    fn settle(&mut self) {
        for values in self.products.chunks_exact_mut(3) {
            for (product, one) in values.iter_mut().zip(self.ones) {
                *product /= 3.0 * one;
            }
        }
        self.means.iter_mut().for_each(|mean| *mean /= *self.covered);
    }
}
