//! Fast marching on a Cartesian grid of its own, with stencils from lattice basis reduction.

use super::Label;
use super::front::Front;
use super::length::chord;
use super::straighten::Obstacles;
use super::update::plane_crossing;
use crate::geometry::{Aabb, Point, Tensor, Vector};
use crate::lists::Rows;
use crate::metric::MetricField;
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

/// Nodes within so many steps of a source, along each axis, get their distance by a straight line.
const SIGHT: i64 = 2;

/// FM-LBR (Mirebeau 2014): fast marching by lattice basis reduction.
///
/// At every node the six neighbours come from a basis of the grid that is reduced in the node's metric (Selling's
/// obtuse superbase), so that angles between them are acute and one pass suffices, however anisotropic the metric. First order
/// where the metric varies little within a stencil; that is about as many nodes wide as the metric is anisotropic, and where it
/// leaves the domain or the metric turns within it distances are poor, and nodes may not be reached at all.
pub(crate) struct Lattice<'a> {
    field: &'a dyn MetricField,
    obstacles: &'a dyn Obstacles,
    origin: Point,
    step: Vector,
    columns: i64,
    rows: i64,
    /// For each node the offsets of its neighbours, around it, and whether the way there is free; `None` outside.
    stencils: Vec<Option<Stencil>>,
    /// For each node those in whose stencil it is, and its place there.
    users: Rows<(u32, u8)>,
}

#[derive(Clone, Copy, Debug)]
struct Stencil {
    /// In units of steps.
    metric: Tensor,
    offsets: [(i64, i64); 6],
    is_free: [bool; 6],
}

impl<'a> Lattice<'a> {
    /// A grid of about so many nodes over a rectangle. `is_inside` tells of many points which are in the domain, and
    /// obstacles which straight ways leave it.
    pub(crate) fn new(
        bounds: Aabb,
        nodes: usize,
        field: &'a dyn MetricField,
        is_inside: impl Fn(&[Point]) -> Vec<bool>,
        obstacles: &'a dyn Obstacles,
    ) -> Self {
        let extent = bounds.extent();
        let side = (extent.x * extent.y / nodes.max(4) as f64).sqrt();
        let [columns, rows] = [extent.x, extent.y].map(|length| (length / side).round().max(1.0) as i64 + 1);
        let step = Vector::new(extent.x / (columns - 1) as f64, extent.y / (rows - 1) as f64);
        let (stencils, users) = (Vec::new(), Rows::default());
        let mut lattice = Self { field, obstacles, origin: bounds.min, step, columns, rows, stencils, users };
        let points: Vec<Point> = (0..(columns * rows) as usize).map(|i| lattice.point(i)).collect();
        let inside = is_inside(&points);
        lattice.stencils = (0..points.len()).into_par_iter().map(|i| inside[i].then(|| lattice.stencil(i))).collect();
        lattice.users = lattice.users();
        lattice
    }

    /// The distances of points of the domain from the nearest source; infinite where no node beside them is reached.
    pub(crate) fn distances(&self, sources: &[Point], at: &[Point]) -> Vec<f64> {
        let values = self.march(sources);
        at.par_iter().map(|&p| self.sample(&values, p)).collect()
    }

    /// Column and row of a node.
    fn place(&self, i: usize) -> (i64, i64) {
        let i = i.cast_signed() as i64;
        (i % self.columns, i / self.columns)
    }

    fn point(&self, i: usize) -> Point {
        let (column, row) = self.place(i);
        self.origin + Vector::new(self.step.x * column as f64, self.step.y * row as f64)
    }

    fn stencil(&self, i: usize) -> Stencil {
        let (m, h) = (self.field.at(self.point(i)), self.step);
        let metric = Tensor::new(m.xx * h.x * h.x, m.xy * h.x * h.y, m.yy * h.y * h.y);
        let offsets = acute_hexagon(metric);
        let at = self.point(i);
        let is_free = offsets.map(|o| self.neighbour(i, o).is_some_and(|j| !self.obstacles.bars(at, self.point(j))));
        Stencil { metric, offsets, is_free }
    }

    fn neighbour(&self, i: usize, (dx, dy): (i64, i64)) -> Option<usize> {
        let (column, row) = self.place(i);
        let (column, row) = (column + dx, row + dy);
        let is_there = (0..self.columns).contains(&column) && (0..self.rows).contains(&row);
        is_there.then(|| (row * self.columns + column) as usize)
    }

    fn users(&self) -> Rows<(u32, u8)> {
        let stencils = (0..).zip(&self.stencils).filter_map(|(i, stencil)| Some((i, stencil.as_ref()?)));
        let free =
            stencils.flat_map(|(i, stencil)| (0..6).filter(|&k| stencil.is_free[k]).map(move |k| (i, stencil, k)));
        let used = free.filter_map(|(i, stencil, k)| {
            let j = self.neighbour(i as usize, stencil.offsets[k]).filter(|&j| self.stencils[j].is_some())?;
            Some((j as u32, (i, k as u8)))
        });
        Rows::new(self.stencils.len(), used)
    }

    fn march(&self, sources: &[Point]) -> Vec<f64> {
        let mut values = vec![f64::INFINITY; self.stencils.len()];
        let mut is_known = vec![false; self.stencils.len()];
        let mut front = Front::new(values.len());
        let offer = |values: &mut Vec<f64>, front: &mut Front, i: usize, distance: f64| {
            if distance < values[i] {
                values[i] = distance;
                front.set(VertexId(i as u32), &Label::of_source(distance, 0));
            }
        };
        for &source in sources {
            for i in self.around(source, SIGHT) {
                if !self.obstacles.bars(source, self.point(i)) {
                    offer(&mut values, &mut front, i, chord(self.field, source, self.point(i)));
                }
            }
        }
        while let Some(VertexId(j)) = front.pop() {
            is_known[j as usize] = true;
            for &(i, k) in self.users.row(j as usize) {
                if !is_known[i as usize] {
                    let distance = self.reach(i as usize, usize::from(k), &values, &is_known);
                    offer(&mut values, &mut front, i as usize, distance);
                }
            }
        }
        values
    }

    /// The distance of node i from what is known at the k-th node of its stencil and those beside that.
    fn reach(&self, i: usize, k: usize, values: &[f64], is_known: &[bool]) -> f64 {
        let Some(stencil) = &self.stencils[i] else { return f64::INFINITY };
        let at = |k: usize| {
            let j = self.neighbour(i, stencil.offsets[k]).filter(|&j| is_known[j] && stencil.is_free[k]);
            let offset = Vector::new(stencil.offsets[k].0 as f64, stencil.offsets[k].1 as f64);
            j.map(|j| (offset, values[j]))
        };
        let Some((u, at_u)) = at(k) else { return f64::INFINITY };
        let straight = at_u + stencil.metric.length(u);
        let beside = [(k + 1) % 6, (k + 5) % 6].into_iter().filter_map(at);
        let across = beside.filter_map(|(w, at_w)| plane_crossing(stencil.metric, [u, w], [at_u, at_w]));
        across.fold(straight, f64::min)
    }

    /// Nodes of the domain within so many steps of a point.
    fn around(&self, p: Point, reach: i64) -> Vec<usize> {
        let cell = |x: f64, step: f64| (x / step).floor() as i64;
        let (column, row) = (cell(p.x - self.origin.x, self.step.x), cell(p.y - self.origin.y, self.step.y));
        let near = |low: i64, count: i64| (low + 1 - reach).max(0)..(low + 1 + reach).min(count);
        let nodes = near(row, self.rows).flat_map(|r| near(column, self.columns).map(move |c| (r, c)));
        let indices = nodes.map(|(r, c)| (r * self.columns + c) as usize);
        indices.filter(|&i| self.stencils[i].is_some()).collect()
    }

    /// Bilinear where all four nodes around a point are reached, else from the best of those that are in sight.
    fn sample(&self, values: &[f64], p: Point) -> f64 {
        let corners = self.around(p, 1);
        let share = |i: usize| {
            let d = self.point(i) - p;
            (1.0 - d.x.abs() / self.step.x).max(0.0) * (1.0 - d.y.abs() / self.step.y).max(0.0)
        };
        let blend: f64 = corners.iter().map(|&i| share(i)).sum();
        let value: f64 = corners.iter().filter(|&&i| share(i) > 0.0).map(|&i| share(i) * values[i]).sum();
        if (blend - 1.0).abs() < 1e-9 && value.is_finite() {
            return value;
        }
        let reached = corners.into_iter().filter(|&i| values[i].is_finite() && !self.obstacles.bars(p, self.point(i)));
        reached.map(|i| values[i] + chord(self.field, self.point(i), p)).fold(f64::INFINITY, f64::min)
    }
}

/// Six vectors of the lattice around the origin, each at most at a right angle with the next in the metric, every two a basis.
fn acute_hexagon(metric: Tensor) -> [(i64, i64); 6] {
    let vector = |b: (i64, i64)| Vector::new(b.0 as f64, b.1 as f64);
    let dot = |a, b| metric.dot(vector(a), vector(b));
    let (mut short, mut long) = ((1, 0), (0, 1));
    // Gauss's reduction: as Euclid's algorithm it is over after a number of rounds like the logarithm of the anisotropy.
    for _ in 0..200 {
        if dot(long, long) < dot(short, short) {
            std::mem::swap(&mut short, &mut long);
        }
        let times = (dot(short, long) / dot(short, short)).round() as i64;
        if times == 0 {
            break;
        }
        long = (long.0 - times * short.0, long.1 - times * short.1);
    }
    if dot(short, long) > 0.0 {
        long = (-long.0, -long.1);
    }
    // short, long and minus their sum are an obtuse superbase.
    let sum = (short.0 + long.0, short.1 + long.1);
    let minus = |b: (i64, i64)| (-b.0, -b.1);
    [short, sum, long, minus(short), minus(sum), minus(long)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stencils_are_acute_at_any_anisotropy() {
        for i in 0..300 {
            let angle = 0.37 * f64::from(i);
            let ratio = 10.0_f64.powf(f64::from(i % 9));
            let metric = Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), ratio, 1.0);
            let hexagon = acute_hexagon(metric).map(|(x, y)| Vector::new(x as f64, y as f64));
            for k in 0..6 {
                let (u, w) = (hexagon[k], hexagon[(k + 1) % 6]);
                assert!((u.cross(w).abs() - 1.0).abs() < 1e-9, "a basis");
                let scale = metric.length(u) * metric.length(w);
                assert!(metric.dot(u, w) > -1e-6 * scale, "{ratio} {angle}");
            }
        }
    }
}
