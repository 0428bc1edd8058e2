//! A wavy sheet of triangles, which unrolls into a rectangle: every distance on it is known to rounding.

use crate::geometry::{Point, Point3};
use crate::manifold::Manifold;
use crate::mesh::Mesh;

/// z = 0.2 sin(3 x) over the square from -1 to 1, sampled on a grid: flat between columns of vertices.
pub(crate) struct Wavy {
    /// The columns, and how far each is along the sheet.
    columns: Vec<(f64, f64)>,
}

fn height(x: f64) -> f64 {
    0.2 * (3.0 * x).sin()
}

impl Wavy {
    /// A sheet with so many columns of vertices.
    pub(crate) fn new(columns: u32) -> Self {
        let x = |i: u32| 2.0 * f64::from(i) / f64::from(columns - 1) - 1.0;
        let mut found = vec![(-1.0, 0.0)];
        for i in 1..columns {
            let (before, along) = found[found.len() - 1];
            found.push((x(i), along + (x(i) - before).hypot(height(x(i)) - height(before))));
        }
        Self { columns: found }
    }

    /// Its triangles, with so many rows of vertices.
    pub(crate) fn manifold(&self, rows: u32) -> Manifold {
        let n = self.columns.len() as u32;
        let y = |j: u32| 2.0 * f64::from(j) / f64::from(rows - 1) - 1.0;
        let points = (0..rows).flat_map(|j| self.columns.iter().map(move |&(x, _)| [x, y(j), height(x)])).collect();
        let cells = (0..rows - 1).flat_map(|j| (0..n - 1).map(move |i| j * n + i));
        let triangles: Vec<[u32; 3]> = cells.flat_map(|v| [[v, v + 1, v + n + 1], [v, v + n + 1, v + n]]).collect();
        let triangle_labels = vec![1; triangles.len()];
        let mesh = Mesh { points, triangles, triangle_labels, ..Mesh::default() };
        Manifold::of(&mesh).unwrap()
    }

    /// How long it is unrolled; its width is 2.
    pub(crate) fn length(&self) -> f64 {
        self.columns[self.columns.len() - 1].1
    }

    /// Where a point of the sheet comes to lie: from 0 along the sheet, from -1 across.
    pub(crate) fn unrolled(&self, p: Point3) -> Point {
        let i = self.columns.partition_point(|c| c.0 <= p.x).clamp(1, self.columns.len() - 1);
        let [(x0, u0), (x1, u1)] = [self.columns[i - 1], self.columns[i]];
        Point::new(u0 + (p.x - x0) / (x1 - x0) * (u1 - u0), p.y)
    }

    /// The point of the sheet that comes to lie there.
    pub(crate) fn rolled(&self, p: Point) -> Point3 {
        let i = self.columns.partition_point(|c| c.1 <= p.x).clamp(1, self.columns.len() - 1);
        let [(x0, u0), (x1, u1)] = [self.columns[i - 1], self.columns[i]];
        let t = (p.x - u0) / (u1 - u0);
        Point3::new(x0, p.y, height(x0)).lerp(Point3::new(x1, p.y, height(x1)), t)
    }
}
