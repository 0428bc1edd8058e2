//! The edges of curved triangles: quadratic and cubic Bézier curves, which polynomials of order 2 and 3 are exactly.

use voronaut::geometry::{Point, Point3, Vector};
use voronaut::mesh::{Edges, Mesh};

/// Pieces in which pages draw an edge: of a cubic they are within a part in a hundred of its bow.
const PIECES: usize = 12;

/// The Bézier control points between the ends of all edges of a mesh; none of a straight mesh.
pub(super) struct Curves {
    /// By the ends, the smaller first, in increasing order.
    all: Vec<([u32; 2], Vec<Point3>)>,
}

impl Curves {
    /// Edges with nodes that are not there or not finite are straight.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let Some(curved) = &mesh.curved else { return Self { all: Vec::new() } };
        let (inside, between) = ((curved.order + 1) * (curved.order + 2) / 2 - 3, curved.order - 1);
        let curve = |ends: [u32; 2], triangle: usize, side: usize, forward: bool| {
            let numbers = curved.triangles.get(triangle * inside + side * between..)?.get(..between)?;
            let mut nodes: Vec<Point3> =
                numbers.iter().map(|&n| curved.nodes.get(n as usize).map(|&p| p.into())).collect::<Option<_>>()?;
            if !forward {
                nodes.reverse();
            }
            let [from, to] = ends.map(|v| mesh.points.get(v as usize).map(|&p| Point3::from(p)));
            let controls = controls(from?, &nodes, to?);
            let is_finite = controls.iter().all(|p| p.to_array().iter().all(|x| x.is_finite()));
            is_finite.then_some((ends, controls))
        };
        let edges = Edges::of(&mesh.triangles);
        let sides = edges.iter().map(|sides| sides[0]);
        let all = sides.filter_map(|s| curve(s.ends, s.triangle(), s.half_edge as usize % 3, s.forward));
        Self { all: all.collect() }
    }

    /// The control points between two vertices, in that direction: none where the edge is straight.
    pub(super) fn between(&self, ends: [u32; 2]) -> Vec<Point3> {
        let [a, b] = ends;
        let Ok(found) = self.all.binary_search_by_key(&[a.min(b), a.max(b)], |(ends, _)| *ends) else {
            return Vec::new();
        };
        let mut controls = self.all[found].1.clone();
        if a > b {
            controls.reverse();
        }
        controls
    }

    /// All control points: between them and the vertices is the mesh.
    pub(super) fn controls(&self) -> impl Iterator<Item = Point3> {
        self.all.iter().flat_map(|(_, controls)| controls.iter().copied())
    }

    /// Twice the area of a planar triangle of either orientation, between its curves.
    pub(super) fn double_area(&self, mesh: &Mesh, triangle: [u32; 3]) -> f64 {
        if self.all.is_empty() {
            return mesh.double_area(triangle);
        }
        let origin = mesh.point(triangle[0]);
        let swept = |ends: [u32; 2]| {
            let between = self.between(ends).into_iter().map(|p| Point::new(p.x, p.y));
            let all = std::iter::once(mesh.point(ends[0])).chain(between).chain([mesh.point(ends[1])]);
            swept(&all.map(|p| p - origin).collect::<Vec<_>>())
        };
        let [a, b, c] = triangle;
        [[a, b], [b, c], [c, a]].into_iter().map(swept).sum::<f64>().abs()
    }

    /// The edges as points along them, with their ends.
    pub(super) fn polylines(&self, mesh: &Mesh) -> Vec<Vec<Point3>> {
        let polyline = |(ends, controls): &([u32; 2], Vec<Point3>)| {
            let [from, to] = ends.map(|v| mesh.position(v));
            let all: Vec<Point3> = std::iter::once(from).chain(controls.iter().copied()).chain([to]).collect();
            (0..=PIECES).map(|i| bezier(&all, i as f64 / PIECES as f64)).collect()
        };
        self.all.iter().map(polyline).collect()
    }
}

/// The inner control points of the polynomial curve through points at equal steps of its parameter.
fn controls(from: Point3, nodes: &[Point3], to: Point3) -> Vec<Point3> {
    let sum = |weights: &[f64]| {
        let points = std::iter::once(&from).chain(nodes).chain([&to]);
        let weighted = points.zip(weights).map(|(p, w)| p.to_array().map(|x| w * x));
        let sum = weighted.reduce(|a, b| [a[0] + b[0], a[1] + b[1], a[2] + b[2]]);
        Point3::from(sum.unwrap_or_default())
    };
    // The Bernstein polynomials at the nodes, inverted.
    if nodes.len() == 1 {
        return vec![sum(&[-0.5, 2.0, -0.5])];
    }
    let near = [-5.0 / 6.0, 3.0, -1.5, 1.0 / 3.0];
    vec![sum(&near), sum(&[near[3], near[2], near[1], near[0]])]
}

/// Twice the area that the ray to a Bézier curve sweeps: the integral of x dy - y dx.
fn swept(controls: &[Vector]) -> f64 {
    let across = |i: usize, j: usize| controls[i].cross(controls[j]);
    match controls.len() {
        2 => across(0, 1),
        3 => (2.0 * across(0, 1) + across(0, 2) + 2.0 * across(1, 2)) / 3.0,
        _ => {
            let far = 6.0 * across(0, 1) + 3.0 * across(0, 2) + across(0, 3);
            (far + 3.0 * across(1, 2) + 3.0 * across(1, 3) + 6.0 * across(2, 3)) / 10.0
        }
    }
}

/// A point of a Bézier curve, by de Casteljau's algorithm.
fn bezier(controls: &[Point3], at: f64) -> Point3 {
    let mut points = controls.to_vec();
    while points.len() > 1 {
        points = points.windows(2).map(|pair| pair[0] + (pair[1] - pair[0]) * at).collect();
    }
    points[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::bowed;

    #[test]
    fn curves_pass_through_their_nodes() {
        for order in [2, 3] {
            let mesh = bowed(order);
            let curved = mesh.curved.as_ref().unwrap();
            let curves = Curves::of(&mesh);
            assert_eq!(curves.all.len(), 5);
            let ends = [mesh.position(0), mesh.position(1)];
            let all = [vec![ends[0]], curves.between([0, 1]), vec![ends[1]]].concat();
            for i in 1..order {
                let node = Point3::from(curved.nodes[i - 1]);
                assert!(bezier(&all, i as f64 / order as f64).distance(node) < 1e-15);
            }
            let back: Vec<Point3> = curves.between([1, 0]).into_iter().rev().collect();
            assert_eq!(back, curves.between([0, 1]));
            let polylines = curves.polylines(&mesh);
            assert_eq!((polylines.len(), polylines[0].len()), (5, PIECES + 1));
            assert_eq!((polylines[0][0], polylines[0][PIECES]), (ends[0], ends[1]));
        }
    }

    #[test]
    fn areas_are_between_curves() {
        for (order, bow) in [(2, 0.8 / 6.0), (3, 0.9 / 6.0)] {
            let mesh = bowed(order);
            let areas = mesh.triangles.iter().map(|&t| 0.5 * Curves::of(&mesh).double_area(&mesh, t));
            // The parabolas 0.8 x (1 - x) through (1/2, 0.2), and 0.9 x (1 - x) through (1/3, 0.2) and (2/3, 0.2).
            for (area, truth) in areas.zip([0.5 + bow, 0.5]) {
                assert!((area - truth).abs() < 1e-14, "{area} {truth}");
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_straight() {
        let mut mesh = bowed(2);
        mesh.curved.as_mut().unwrap().nodes[0][1] = f64::NAN;
        assert!(Curves::of(&mesh).between([0, 1]).is_empty() && !Curves::of(&mesh).between([1, 2]).is_empty());
        assert!(Curves::of(&Mesh::default()).all.is_empty());
    }
}
