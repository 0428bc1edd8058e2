//! A grid whose cells know which items may be nearest to a place in them, each from when it is first asked.

use super::{Aabb, Point};
use std::sync::OnceLock;

/// Cells for each item, and at most. Of the places where the metric of a coast of 5,422 segments is evaluated 97 % have at most 16 candidates with 16 cells a
/// segment, 7 in the mean; with 64 it is 99.9 %, and 4.
const SHARE: usize = 64;
const MOST: usize = 1 << 20;
/// More candidates than these are not held: a tree is as quick.
const FEW: usize = 32;
/// Cells count as wider by this share, for rounding.
const SLACK: f64 = 1e-3;

/// See the [module](self).
#[derive(Clone, Debug)]
pub(crate) struct Candidates {
    low: Point,
    side: f64,
    columns: usize,
    rows: usize,
    /// Row by row; empty where there are too many.
    cells: Vec<OnceLock<Box<[u32]>>>,
}

impl Candidates {
    /// A grid on a box for so many items.
    pub(crate) fn new(bounds: Aabb, items: usize) -> Self {
        let extent = bounds.max - bounds.min;
        let count = (SHARE * items).min(MOST) as f64;
        let side = (extent.x * extent.y / count).sqrt().max(extent.x.max(extent.y) / count);
        let along = |extent: f64| if side > 0.0 && side.is_finite() { (extent / side).floor() as usize + 1 } else { 0 };
        let (columns, rows) = (along(extent.x), along(extent.y));
        Self { low: bounds.min, side, columns, rows, cells: vec![OnceLock::new(); columns * rows] }
    }

    /// The items that may be nearest to a place, or tie with those that are: what `find` has for the middle of its cell and a distance, all that are no farther
    /// from there than the nearest one and that distance. `None` outside the box, and where they are too many.
    pub(crate) fn at(&self, p: Point, find: impl FnOnce(Point, f64) -> Vec<u32>) -> Option<&[u32]> {
        let place = (p - self.low) * (1.0 / self.side);
        let is_inside = place.x >= 0.0 && place.x < self.columns as f64 && place.y >= 0.0 && place.y < self.rows as f64;
        if !is_inside {
            return None;
        }
        let (column, row) = (place.x as usize, place.y as usize);
        let found = self.cells[row * self.columns + column].get_or_init(|| {
            let middle = |low: f64, i: usize| low + self.side * (i as f64 + 0.5);
            let centre = Point::new(middle(self.low.x, column), middle(self.low.y, row));
            // From the centre to a place in the cell, and back.
            let found = find(centre, 2.0 * self.side * std::f64::consts::FRAC_1_SQRT_2 * (1.0 + SLACK));
            if found.len() > FEW { Box::default() } else { found.into() }
        });
        (!found.is_empty()).then_some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_cover_their_box_and_know_what_they_were_told() {
        let bounds = Aabb { min: Point::new(-1.0, 2.0), max: Point::new(3.0, 4.0) };
        let grid = Candidates::new(bounds, 10);
        for p in [bounds.min, bounds.max, Point::new(0.3, 2.9)] {
            let told = grid.at(p, |centre, within| {
                assert!(centre.distance(p) <= 0.5 * within);
                vec![7]
            });
            assert_eq!(told, Some(&[7][..]));
            assert_eq!(grid.at(p, |_, _| unreachable!()), Some(&[7][..]));
        }
        for p in [Point::new(-1.1, 3.0), Point::new(0.0, 5.0), Point::new(f64::NAN, 3.0)] {
            assert_eq!(grid.at(p, |_, _| vec![7]), None);
        }
    }

    #[test]
    fn too_many_are_none() {
        let grid = Candidates::new(Aabb { min: Point::new(0.0, 0.0), max: Point::new(1.0, 0.0) }, 1);
        assert_eq!(grid.at(Point::new(0.5, 0.0), |_, _| (0..100).collect()), None);
        let point = Candidates::new(Aabb { min: Point::new(1.0, 1.0), max: Point::new(1.0, 1.0) }, 1);
        assert_eq!(point.at(Point::new(1.0, 1.0), |_, _| vec![7]), None);
    }
}
