//! Riemannian triangles by barycentric coordinates: grids of Karcher means.

use super::{Realisation, View};
use crate::geodesic::{Fineness, Paths, karcher_mean, place_at, reached};
use crate::geometry::{Orientation, Point, orientation};
use crate::metric::nearby;
use crate::parallel::prelude::*;

/// A Riemannian triangle in pieces: the images of barycentric coordinates that are multiples of 1/n.
#[derive(Clone, Debug, PartialEq)]
pub struct Grid<P = Point> {
    /// Pieces per side.
    pub sides: usize,
    /// Row by row: row i has the coordinate i/n of the third corner, and goes from the first corner's side to the second's.
    pub points: Vec<P>,
}

impl<P: Copy> Grid<P> {
    /// The point with j/n of the second corner and i/n of the third; i + j is at most n.
    pub(crate) fn at(&self, j: usize, i: usize) -> P {
        // Rows before this one have n + 1, n, ... points.
        self.points[i * (2 * self.sides + 3 - i) / 2 + j]
    }

    /// The lines on which one coordinate is a multiple of 1/n, without the sides.
    pub fn lines(&self) -> Vec<Vec<P>> {
        let n = self.sides;
        let line = |k: usize, point: &dyn Fn(usize) -> P| (0..=n - k).map(point).collect();
        let of_one =
            |k: usize| [line(k, &|j| self.at(j, k)), line(k, &|i| self.at(k, i)), line(k, &|j| self.at(j, n - k - j))];
        (1..n).flat_map(of_one).collect()
    }
}

impl Grid {
    /// Whether all its straight pieces are counter-clockwise, so that the map is one-to-one as far as it shows.
    pub(crate) fn is_embedded(&self) -> bool {
        let is_left = |a, b, c| orientation(a, b, c) == Orientation::Left;
        let n = self.sides;
        (0..n).all(|i| {
            let upward = |j: usize| is_left(self.at(j, i), self.at(j + 1, i), self.at(j, i + 1));
            let downward = |j: usize| is_left(self.at(j + 1, i), self.at(j + 1, i + 1), self.at(j, i + 1));
            (0..n - i).all(upward) && (1..n - i).all(|j| downward(j - 1))
        })
    }
}

impl<P: Copy + Into<[f64; 3]> + Send + Sync> Realisation<P> {
    /// [`Realisation::grids`] of triangles as they are seen.
    pub(super) fn seen_as_grids<V: View<P>>(
        &self,
        view: impl Fn([u32; 3]) -> Option<V> + Sync,
        sides: usize,
    ) -> Vec<Option<Grid<P>>> {
        let paths = Paths::default();
        let grid = |&triangle: &[u32; 3]| {
            let view = view(triangle)?;
            let Grid { sides, points } = self.grid(&view, &paths, triangle, sides.max(1)).filter(Grid::is_embedded)?;
            let points = points.into_iter().map(|p| view.lifted(p)).collect::<Option<_>>()?;
            Some(Grid { sides, points })
        };
        self.triangles.par_iter().map(grid).collect()
    }

    fn grid(&self, view: &impl View<P>, paths: &Paths, [a, b, c]: [u32; 3], n: usize) -> Option<Grid> {
        let corners = [a, b, c].map(|i| view.flat(self.seeds[i as usize]));
        let [ab, bc, ac] = [[a, b], [b, c], [a, c]].map(|pair| self.side(view, pair, n));
        let [ab, bc, ac] = [ab?, bc?, ac?];
        let mut points = Vec::with_capacity((n + 1) * (n + 2) / 2);
        for i in 0..=n {
            for j in 0..=n - i {
                let weights = [n - i - j, j, i].map(|k| k as f64);
                points.push(match (j, i) {
                    (j, 0) => ab[j],
                    (0, i) => ac[i],
                    (j, i) if i + j == n => bc[i],
                    _ => karcher_mean(paths, view.field(), corners, weights, Fineness::MIDDLE)?,
                });
            }
        }
        Some(Grid { sides: n, points })
    }

    /// An edge at equal metric lengths.
    fn side(&self, view: &impl View<P>, [from, to]: [u32; 2], n: usize) -> Option<Vec<Point>> {
        let points = self.edges[self.edge_between(from, to)?].from(from);
        let line: Vec<Point> = points.into_iter().map(|p| view.flat(p)).collect();
        let reached = reached(nearby(view.field()), &line);
        let (total, last) = (reached[line.len() - 1], line[line.len() - 1]);
        let inner = (1..n).map(|k| place_at(&line, &reached, total * k as f64 / n as f64).0);
        Some([line[0]].into_iter().chain(inner).chain([last]).collect())
    }
}
