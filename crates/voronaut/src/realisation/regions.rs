//! Riemannian triangles as regions of the plane or of a surface: what lies between three geodesics, cut into straight triangles.

use super::{GeodesicEdge, Realisation, View};
use crate::geometry::{Orientation, Point, Tensor, holds, orientation};
use crate::mesh::Mesh;
use crate::parallel::prelude::*;

impl<P: Copy + Into<[f64; 3]> + Send + Sync> Realisation<P> {
    /// The vertices of each edge in [`Realisation::to_mesh`], from its first seed to its second.
    pub fn lines(&self) -> Vec<Vec<u32>> {
        let mut next = self.seeds.len() as u32;
        let line = |GeodesicEdge { ends, points, .. }: &GeodesicEdge<P>| {
            let first = next;
            next += inner(points).len() as u32;
            [ends[0]].into_iter().chain(first..next).chain([ends[1]]).collect()
        };
        self.edges.iter().map(line).collect()
    }

    /// The number of the edge between two seeds.
    pub(crate) fn edge_between(&self, a: u32, b: u32) -> Option<usize> {
        self.edges.binary_search_by_key(&[a.min(b), a.max(b)], |edge| edge.ends).ok()
    }

    /// The realisation as a mesh: the seeds in order, then the inner points of the polylines, edge by edge; the segments of
    /// each polyline as edges labelled with its number, and each Riemannian triangle as the straight triangles that it is
    /// cut into, labelled with its number, numbers from 1. It is a valid mesh if no edges cross and no region is open; on a
    /// surface its vertices are on that, and triangles span from one to the next.
    pub fn to_mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let inner = self.edges.iter().flat_map(|edge| inner(&edge.points));
        mesh.points = self.seeds.iter().chain(inner).map(|&p| p.into()).collect();
        mesh.point_labels = vec![0; mesh.points.len()];
        for (line, label) in self.lines().iter().zip(1..) {
            mesh.edges.extend(line.windows(2).map(|w| [w[0], w[1]]));
            mesh.edge_labels.resize(mesh.edges.len(), label);
        }
        for (region, label) in self.regions.iter().zip(1..) {
            mesh.triangles.extend(region);
            mesh.triangle_labels.resize(mesh.triangles.len(), label);
        }
        mesh
    }

    /// Each triangle's region, cut into straight triangles by the numbers of [`Realisation::to_mesh`], in the first view that it can be cut in;
    /// empty where its edges bound no region, counter-clockwise, in any.
    pub(super) fn cut<Views>(&self, views: impl Fn([u32; 3]) -> Views + Sync) -> Vec<Vec<[u32; 3]>>
    where
        Views: IntoIterator<Item: View<P>>,
    {
        let lines = self.lines();
        let one = |&t: &[u32; 3]| views(t).into_iter().find_map(|view| self.cut_one(&view, t, &lines));
        self.triangles.par_iter().map(|t| one(t).unwrap_or_default()).collect()
    }

    fn cut_one<V: View<P>>(&self, view: &V, [a, b, c]: [u32; 3], lines: &[Vec<u32>]) -> Option<Vec<[u32; 3]>> {
        let mut corners = Vec::new();
        for (i, [from, to]) in [[a, b], [b, c], [c, a]].into_iter().enumerate() {
            let edge = self.edge_between(from, to)?;
            let mut numbers = lines[edge].clone();
            if from > to {
                numbers.reverse();
            }
            let last = numbers.len() - 1;
            let points = self.edges[edge].from(from).into_iter();
            // Where it begins the edge before ends.
            let sides = |k: usize| match k {
                _ if V::IS_SHARED => 0,
                0 => 1 << i | 1 << ((i + 2) % 3),
                _ => 1 << i,
            };
            let corner = |(k, (number, p))| Corner { number, at: view.flat(p), sides: sides(k) };
            corners.extend(numbers.into_iter().zip(points).take(last).enumerate().map(corner));
        }
        let middle = Point::centroid([a, b, c].map(|i| view.flat(self.seeds[i as usize])));
        let region = Region { corners, tensor: view.field().at(middle) };
        let by_ears = region.clone().cut();
        by_ears.or_else(|| if V::IS_SHARED { None } else { region.cut_as_may_be() })
    }
}

fn inner<P>(points: &[P]) -> &[P] {
    points.get(1..points.len().saturating_sub(1)).unwrap_or_default()
}

/// A polygon, counter-clockwise, that ears are cut off.
#[derive(Clone)]
struct Region {
    corners: Vec<Corner>,
    tensor: Tensor,
}

#[derive(Clone, Copy)]
struct Corner {
    number: u32,
    at: Point,
    /// A bit for each side of the triangle that it is on, between two corners of which nothing is cut: the triangle across would cut
    /// there, too. None where that cannot be.
    sides: u8,
}

impl Region {
    /// The triangles that fill it; `None` if it is no simple counter-clockwise polygon.
    fn cut(mut self) -> Option<Vec<[u32; 3]>> {
        let mut triangles = Vec::with_capacity(self.corners.len());
        let mut ears: Vec<Option<f64>> = (0..self.corners.len()).map(|i| self.ear(i)).collect();
        while self.corners.len() > 3 {
            let n = self.corners.len();
            let best = |ears: &[Option<f64>]| {
                let all = ears.iter().enumerate().filter_map(|(i, shape)| Some((i, (*shape)?)));
                all.max_by(|x, y| x.1.total_cmp(&y.1)).map(|x| x.0)
            };
            // What was in the way of an ear may be gone.
            let i = best(&ears).or_else(|| {
                ears = (0..n).map(|i| self.ear(i)).collect();
                best(&ears)
            })?;
            triangles.push(self.around(i).map(|k| self.corners[k].number));
            self.corners.remove(i);
            ears.remove(i);
            for k in [(i + n - 2) % (n - 1), i % (n - 1)] {
                ears[k] = self.ear(k);
            }
        }
        let [a, b, c] = self.around(1).map(|k| self.corners[k]);
        triangles.push([a, b, c].map(|corner| corner.number));
        (orientation(a.at, b.at, c.at) == Orientation::Left).then_some(triangles)
    }

    /// The triangles that fill it, where ears lead nowhere: of all ways those whose worst shape is best, piece by piece from the smallest.
    fn cut_as_may_be(&self) -> Option<Vec<[u32; 3]>> {
        let (n, all) = (self.corners.len(), &self.corners);
        // Of the piece from one corner to another the worst shape, and the third corner of the triangle at that cut.
        let mut best: Vec<Option<(f64, usize)>> = vec![None; n * n];
        (1..n).for_each(|j| best[(j - 1) * n + j] = Some((f64::INFINITY, j)));
        for length in 2..n {
            for (i, j) in (0..n - length).map(|i| (i, i + length)) {
                let is_side = length == n - 1;
                if !is_side && all[i].sides & all[j].sides != 0 {
                    continue;
                }
                let with = |k: usize| {
                    let [(before, _), (after, _)] = [best[i * n + k]?, best[k * n + j]?];
                    Some((self.shape([i, k, j])?.min(before).min(after), k))
                };
                best[i * n + j] = (i + 1..j).filter_map(with).max_by(|x, y| x.0.total_cmp(&y.0));
            }
        }
        let (mut triangles, mut open) = (Vec::with_capacity(n), vec![(0, n - 1)]);
        while let Some((i, j)) = open.pop() {
            let (_, k) = best[i * n + j]?;
            if j > i + 1 {
                triangles.push([i, k, j].map(|corner| all[corner].number));
                open.extend([(i, k), (k, j)]);
            }
        }
        Some(triangles)
    }

    /// The shape of a triangle of its corners, the better the greater; `None` if it is not counter-clockwise.
    fn shape(&self, corners: [usize; 3]) -> Option<f64> {
        let [a, b, c] = corners.map(|k| self.corners[k].at);
        if orientation(a, b, c) != Orientation::Left {
            return None;
        }
        let squares: f64 = [b - a, c - b, a - c].iter().map(|&side| self.tensor.dot(side, side)).sum();
        Some((b - a).cross(c - a) / squares)
    }

    fn around(&self, i: usize) -> [usize; 3] {
        let n = self.corners.len();
        [(i + n - 1) % n, i, (i + 1) % n]
    }

    /// The shape of the ear at a corner, the better the greater; `None` where there is none.
    fn ear(&self, i: usize) -> Option<f64> {
        let numbers = self.around(i);
        let [before, own, after] = numbers.map(|k| self.corners[k]);
        let [a, b, c] = [before, own, after].map(|corner| corner.at);
        let shape = self.shape(numbers).filter(|_| before.sides & after.sides == 0)?;
        let mut others = self.corners.iter().enumerate().filter(|(k, _)| !numbers.contains(k));
        if others.any(|(_, corner)| holds([a, b, c], corner.at)) {
            return None;
        }
        Some(shape)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cut(points: &[(f64, f64)]) -> Option<Vec<[u32; 3]>> {
        let corner = |(number, &(x, y)): (u32, &(f64, f64))| Corner { number, at: Point::new(x, y), sides: 0 };
        let corners = (0..).zip(points).map(corner).collect();
        Region { corners, tensor: Tensor::IDENTITY }.cut()
    }

    #[test]
    fn bays_are_cut_and_knots_are_not() {
        let bay = [(0.0, 0.0), (1.0, 0.8), (2.0, 0.0), (2.0, 1.0), (1.0, 1.2), (0.0, 1.0)];
        let triangles = cut(&bay).unwrap();
        let area = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [a, b, c].map(|i| Point::new(bay[i as usize].0, bay[i as usize].1));
            0.5 * (b - a).cross(c - a)
        };
        assert_eq!(triangles.len(), 4);
        assert!(triangles.iter().all(|&t| area(t) > 0.0));
        assert!((triangles.iter().map(|&t| area(t)).sum::<f64>() - 1.4).abs() < 1e-12);
        assert!(cut(&[(0.0, 0.0), (0.0, 1.0), (1.0, 0.0)]).is_none(), "clockwise");
        assert!(cut(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)]).is_none(), "a knot");
    }
}
