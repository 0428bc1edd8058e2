//! Polygons in space cut into triangles along diagonals that suit them.

use super::ears::{Ears, Seen};

/// Polygons of a file whose vertices may come behind them.
#[derive(Default)]
pub(super) struct Polygons {
    vertices: Vec<u32>,
    /// Where in `vertices` each polygon ends.
    ends: Vec<usize>,
    labels: Vec<i32>,
}

/// What one diagonal of a quadrilateral must be better by, so that rounding does not choose between equals.
const BETTER: f64 = 1e-6;

impl Polygons {
    /// A polygon of three or more vertices.
    pub(super) fn push(&mut self, polygon: &[u32]) {
        self.vertices.extend(polygon);
        self.ends.push(self.vertices.len());
    }

    /// Gives a label to the polygons that have none yet.
    pub(super) fn label(&mut self, label: i32) {
        self.labels.resize(self.ends.len(), label);
    }

    /// All triangles, in the order of the polygons, with their labels; all vertices must be there.
    pub(super) fn cut(mut self, points: &[[f64; 3]]) -> (Vec<[u32; 3]>, Vec<i32>) {
        self.label(0);
        let (mut triangles, mut labels, mut start) = (Vec::new(), Vec::new(), 0);
        for (end, label) in self.ends.into_iter().zip(self.labels) {
            cut(points, &self.vertices[start..end], &mut triangles);
            labels.resize(triangles.len(), label);
            start = end;
        }
        (triangles, labels)
    }
}

/// Appends the triangles of a polygon: two less than it has vertices, turned like it.
///
/// A quadrilateral is cut along the diagonal whose worse triangle has the better shape, seen along the mean normal: one that lies
/// outside a reflex corner turns its triangles round, which is worst of all. Of equals it is the diagonal with the least vertex
/// number, so that a quadrilateral is cut alike from wherever it is begun and on both sides. With more vertices, ears are cut off, the
/// best first ([`Ears`]). Polygons that cross themselves are cut somehow.
pub(super) fn cut(points: &[[f64; 3]], polygon: &[u32], to: &mut Vec<[u32; 3]>) {
    match *polygon {
        [a, b, c] => to.push([a, b, c]),
        [a, b, c, d] => {
            let seen = Seen::new(points, polygon);
            let worse = |one, other| f64::min(seen.shape(one), seen.shape(other));
            let (through_a, through_b) = (worse([0, 1, 2], [0, 2, 3]), worse([1, 2, 3], [1, 3, 0]));
            let is_equal = (through_b - through_a).abs() <= BETTER;
            let b_is_better = if is_equal { b.min(d) < a.min(c) } else { through_b > through_a };
            to.extend(if b_is_better { [[b, c, d], [b, d, a]] } else { [[a, b, c], [a, c, d]] });
        }
        _ => {
            let ears = Ears::cut(&Seen::new(points, polygon));
            to.extend(ears.into_iter().map(|ear| ear.map(|i| polygon[i as usize])));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn cut_of(points: &[[f64; 3]]) -> Vec<[u32; 3]> {
        let mut triangles = Vec::new();
        cut(points, &(0..points.len() as u32).collect::<Vec<_>>(), &mut triangles);
        triangles
    }

    /// Points of the plane, put upright and elsewhere, so that no axis is special.
    fn upright(points: &[[f64; 2]]) -> Vec<[f64; 3]> {
        points.iter().map(|[x, y]| [1e3 + 0.8 * x - 0.3 * y, 0.6 * x + 0.4 * y, y * 0.9]).collect()
    }

    /// The signed areas of the triangles of a polygon in the plane.
    fn areas(points: &[[f64; 2]], triangles: &[[u32; 3]]) -> Vec<f64> {
        let area = |triangle: &[u32; 3]| {
            let [a, b, c] = triangle.map(|v| points[v as usize]);
            ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0
        };
        triangles.iter().map(area).collect()
    }

    fn polygon_area(points: &[[f64; 2]]) -> f64 {
        let next = points.iter().cycle().skip(1);
        points.iter().zip(next).map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum::<f64>() / 2.0
    }

    #[test]
    fn quadrilaterals_take_the_better_diagonal() {
        let kite = [[0.0, 0.0], [2.0, -0.5], [4.0, 0.0], [2.0, 0.5]];
        assert_eq!(cut_of(&upright(&kite)), [[1, 2, 3], [1, 3, 0]]);
        let reflex = [[0.0, 0.0], [4.0, 4.0], [0.0, 1.0], [-4.0, 4.0]];
        assert_eq!(cut_of(&upright(&reflex)), [[0, 1, 2], [0, 2, 3]]);
        let turned = [reflex[1], reflex[2], reflex[3], reflex[0]];
        assert_eq!(cut_of(&upright(&turned)), [[1, 2, 3], [1, 3, 0]]);
        for scale in [1e-200, 1e-9, 1.0, 1e9, 1e200] {
            let points: Vec<_> = upright(&kite).into_iter().map(|p| p.map(|x| x * scale)).collect();
            assert_eq!(cut_of(&points), [[1, 2, 3], [1, 3, 0]], "{scale}");
        }
    }

    #[test]
    fn a_square_is_cut_alike_from_everywhere() {
        let square = [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.1, 0.1, 0.0], [0.0, 0.1, 0.0]];
        let diagonals = [[0, 1, 2, 3], [1, 2, 3, 0], [3, 0, 1, 2], [3, 2, 1, 0], [2, 1, 0, 3]].map(|polygon| {
            let mut triangles = Vec::new();
            cut(&square, &polygon, &mut triangles);
            triangles.iter().all(|triangle| triangle.contains(&0) && triangle.contains(&2))
        });
        assert_eq!(diagonals, [true; 5]);
    }

    #[test]
    fn polygons_that_are_none_are_cut_all_the_same() {
        for points in [
            vec![[0.0; 3]; 4],
            vec![[1.0, 2.0, 3.0]; 7],
            vec![[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0], [4.0, 0.0, 0.0]],
            vec![[1e308, -1e308, 0.0], [-1e308, 1e308, 0.0], [1e308, 1e308, 1e308], [0.0; 3], [-1e308; 3]],
        ] {
            assert_eq!(cut_of(&points).len(), points.len() - 2);
        }
        // A pentagram: five times round, and no ear.
        let star: Vec<_> = (0..5).map(|i| (f64::from(i) * 0.8 * std::f64::consts::PI).sin_cos()).collect();
        assert_eq!(cut_of(&star.iter().map(|&(y, x)| [x, y, 0.0]).collect::<Vec<_>>()).len(), 3);
    }

    #[test]
    fn a_hole_that_a_bridge_joins_to_the_outline_stays_one() {
        let points = [
            [0.0, 0.0],
            [3.0, 0.0],
            [3.0, 3.0],
            [0.0, 3.0],
            [0.0, 0.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
        ];
        let triangles = cut_of(&upright(&points));
        let found = areas(&points, &triangles);
        assert!(found.iter().all(|area| *area > -1e-12), "{found:?}");
        assert!((found.iter().sum::<f64>() - 8.0).abs() < 1e-9);
    }

    #[test]
    fn many_vertices_take_no_time() {
        let comb = |i: u32| match i % 4 {
            0 => [f64::from(i), 0.0],
            1 => [f64::from(i), 100.0],
            2 => [f64::from(i), 90.0],
            _ => [f64::from(i), 0.5],
        };
        let mut points: Vec<_> = (0..40_000).map(comb).collect();
        points.extend([[40_000.0, -50.0], [0.0, -50.0]]);
        points.reverse();
        let triangles = cut_of(&upright(&points));
        let found = areas(&points, &triangles);
        assert!(found.iter().all(|area| *area >= 0.0));
        assert!((found.iter().sum::<f64>() / polygon_area(&points) - 1.0).abs() < 1e-9);
    }

    proptest! {
        /// Polygons around a centre are simple, and reflex where they like.
        #[test]
        fn no_triangle_folds_over(radii in prop::collection::vec(0.05_f64..1.0, 4..40)) {
            let turn = std::f64::consts::TAU / radii.len() as f64;
            let points: Vec<_> = radii.iter().zip(0_u32..).map(|(r, i)| {
                let (sin, cos) = (turn * f64::from(i)).sin_cos();
                [r * cos, r * sin]
            }).collect();
            let triangles = cut_of(&upright(&points));
            let found = areas(&points, &triangles);
            prop_assert_eq!(found.len(), points.len() - 2);
            prop_assert!(found.iter().all(|area| *area > -1e-12), "{:?}", found);
            prop_assert!((found.iter().sum::<f64>() - polygon_area(&points)).abs() < 1e-12);
        }
    }
}
