//! Two triangles beside a side, and what they are with the side on the other diagonal.

use super::bezier::MOST;
use super::elements::Elements;
use super::newton::Aim;
use super::term::curve_length;
use crate::elementary::Elementary;
use crate::geometry::Point;
use crate::mesh::edges::NONE;

/// See the [module](self): the half-edge of the one and of the other.
#[derive(Clone, Copy)]
pub(super) struct Pair(pub(super) [usize; 2]);

impl Pair {
    pub(super) fn of(elements: &Elements, half_edge: usize) -> Self {
        Self([half_edge, elements.twins[half_edge] as usize])
    }

    pub(super) fn triangles(self) -> [usize; 2] {
        self.0.map(|h| h / 3)
    }

    /// Whether the vertices opposite are neighbours already: between two vertices is one side at most.
    pub(super) fn has_other_side(self, elements: &Elements) -> bool {
        let [from, to] = self.0.map(|h| Elements::next(Elements::next(h)));
        let d = elements.origin(to);
        elements
            .around(from)
            .any(|h| elements.origin(Elements::next(h)) == d || elements.origin(Elements::next(Elements::next(h))) == d)
    }

    /// The half-edges of the new triangles but for the new side: of the first a to d and c to a, where the old side goes from a to b,
    /// with c on its left and d on its right; of the second d to b and b to c.
    fn outer(self) -> [[usize; 2]; 2] {
        let [h, twin] = self.0;
        let after = Elements::next;
        [[after(twin), after(after(h))], [after(after(twin)), after(h)]]
    }

    /// The numbers of the points of both new triangles, a d c and d b c, with the old side's points on the new one.
    pub(super) fn numbers(self, elements: &Elements) -> [[u32; MOST]; 2] {
        let order = elements.order;
        let inner = order - 1;
        let [[ad, ca], [db, bc]] = self.outer().map(|pair| pair.map(|h| elements.side(h)));
        let old = elements.side(self.0[0]);
        let mut new = old[1..order].to_vec();
        let assemble = |sides: [&[u32]; 3], corners: [u32; 3], triangle: usize| {
            let mut numbers = [NONE; MOST];
            numbers[..3].copy_from_slice(&corners);
            for (s, side) in sides.into_iter().enumerate() {
                numbers[3 + s * inner..][..inner].copy_from_slice(side);
            }
            if order == 3 {
                numbers[9] = elements.triangles[triangle][9];
            }
            numbers
        };
        let (a, d, c, b) = (ad[0], ad[order], ca[0], bc[0]);
        let [one, two] = self.triangles();
        let first = assemble([&ad[1..order], &new, &ca[1..order]], [a, d, c], one);
        new.reverse();
        [first, assemble([&db[1..order], &bc[1..order], &new], [d, b, c], two)]
    }

    /// By how much the angles opposite the side are more than a half turn together, in triangles with straight sides of the same lengths.
    pub(super) fn excess(self, elements: &Elements, aim: &Aim) -> f64 {
        let length = |h: usize| {
            let points: Vec<Point> = elements.side(h).iter().map(|&n| elements.points[n as usize]).collect();
            curve_length(&points, aim.metric)
        };
        let c = length(self.0[0]);
        let angle = |[a, b]: [f64; 2]| ((a * a + b * b - c * c) / (2.0 * a * b)).clamp(-1.0, 1.0).arccosine();
        let [h, twin] = self.0.map(|h| [Elements::next(h), Elements::next(Elements::next(h))].map(length));
        angle(h) + angle(twin) - std::f64::consts::PI
    }

    /// Puts the other diagonal where the side is, and the points of both triangles.
    pub(super) fn flip(self, elements: &mut Elements, points: &[[Point; MOST]; 2]) {
        let numbers = self.numbers(elements);
        let outer = self.outer();
        let known = outer.map(|pair| pair.map(|h| (elements.twins[h], elements.held[h])));
        let [t, s] = self.triangles();
        let count = elements.count();
        for (triangle, numbers, points) in [(t, numbers[0], points[0]), (s, numbers[1], points[1])] {
            elements.triangles[triangle] = numbers;
            for (&n, p) in numbers[..count].iter().zip(points) {
                elements.points[n as usize] = p;
            }
        }
        // Sides: a d, d c, c a and d b, b c, c d.
        let new = [[3 * t, 3 * t + 2], [3 * s, 3 * s + 1]];
        for (half_edges, known) in new.into_iter().zip(known) {
            for (h, (twin, held)) in half_edges.into_iter().zip(known) {
                (elements.twins[h], elements.held[h]) = (twin, held);
                if twin != NONE {
                    elements.twins[twin as usize] = h as u32;
                }
            }
        }
        let [dc, cd] = [3 * t + 1, 3 * s + 2];
        (elements.twins[dc], elements.twins[cd]) = (cd as u32, dc as u32);
        (elements.held[dc], elements.held[cd]) = (NONE, NONE);
    }
}
