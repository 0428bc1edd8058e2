//! Holes of a few sides, cut into triangles: roughly right will do, for flips follow.

use super::sides::Sides;

/// A polygon, counter-clockwise, to be filled.
pub(super) struct Outline<'a, 'b> {
    pub(super) corners: Vec<u32>,
    pub(super) sides: &'a Sides<'b>,
}

impl Outline<'_, '_> {
    /// Triangles that fill it, ear by ear, the one with the smallest circle first. Where no ear turns the right way the
    /// rest stays open.
    pub(super) fn triangulated(mut self) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        while self.corners.len() > 2 {
            let n = self.corners.len();
            let best = (0..n).map(|i| (i, self.ear(i))).min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((i, size)) = best else { break };
            if !size.is_finite() {
                break;
            }
            triangles.push(self.corners_at(i));
            self.corners.remove((i + 1) % n);
        }
        triangles
    }

    fn corners_at(&self, i: usize) -> [u32; 3] {
        let n = self.corners.len();
        [self.corners[i], self.corners[(i + 1) % n], self.corners[(i + 2) % n]]
    }

    /// The size of the ear at i; infinite where there is none.
    fn ear(&self, i: usize) -> f64 {
        let [a, b, c] = self.corners_at(i);
        // The last ear closes on a side that is there or, of an open part, on none.
        let is_last = self.corners.len() == 3;
        if !is_last && (self.sides.has(a, c) || self.sides.has(c, a)) {
            return f64::INFINITY;
        }
        self.sides.size([a, b, c])
    }
}
