//! How metric edge lengths and angles are distributed, with straight edges and with geodesic ones (RR-9103, figure 20).

use super::geodesics::{Found, MeasuredEdge, geodesic, measure};
use super::planar_quality::{
    Corners, EdgeLengths, angle, collect, demand_planar, demand_vertices, edge_length, tensor,
};
use super::surface_quality::Field;
use crate::error::Result;
use crate::geometry::{Point, Tensor};
use crate::manifold::Manifold;
use crate::manifold::surface::metric::SurfaceMetric;
use crate::mesh::{EdgeSide, Edges, Mesh};
use crate::metric::MetricField;
use crate::parallel::prelude::*;

/// A figure of the mesh with straight edges, and the same with geodesic edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Both<T> {
    /// With straight edges: the SRDT, if the mesh is one.
    pub straight: T,
    /// With geodesic edges: the RDT, if the mesh is one.
    pub geodesic: T,
}

/// Values counted in bins.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Histogram {
    /// Where bins begin, in increasing order. Each ends where the next begins; the last also has all that is larger.
    pub bounds: Vec<f64>,
    /// How many values each bin has: two lists of as many entries as there are bounds, their fields beside these.
    #[serde(flatten)]
    pub counts: Both<Vec<usize>>,
    /// Arithmetic means of the values; not a number of none.
    pub mean: Both<f64>,
    /// Standard deviations (of the whole population).
    pub std: Both<f64>,
}

/// The distributions of a mesh in a metric.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Histograms {
    /// Metric lengths of all edges.
    pub edge_length: Histogram,
    /// Share of the edges whose length is in [1/sqrt 2, sqrt 2]; not a number of none.
    pub unit_fraction: Both<f64>,
    /// All angles of all triangles, in degrees from 0 to 180. Between straight edges in the triangle's own metric (see
    /// [`Quality`](super::Quality)), where the three sum to 180; between geodesics at the vertex, in the metric there, where
    /// they need not.
    pub angle: Histogram,
    /// Edges for which no geodesic was found: among the geodesic figures theirs are those of the straight edge.
    pub geodesics_not_found: usize,
    /// Edges on the border of the domain whose geodesic would leave the domain; they, too, count as straight.
    pub geodesics_on_border: usize,
}

/// Width of the bins of lengths, and where the last begins.
const LENGTHS: (f64, f64) = (0.05, 2.0);
/// Width of the bins of angles, and where the last begins, in degrees.
const ANGLES: (f64, f64) = (3.0, 177.0);

/// Of a planar mesh.
pub(super) fn in_plane(mesh: &Mesh, metric: &dyn MetricField) -> Result<Histograms> {
    demand_planar(mesh)?;
    let edges = Edges::of(&mesh.triangles);
    let edge = |side: &EdgeSide, inside: Option<f64>| {
        let ends = side.ends.map(|v| mesh.point(v));
        Ok(geodesic(metric, ends, edge_length(ends, metric)?, inside))
    };
    let measured = measure(mesh, &edges, edge)?;
    let (_, mean) = Corners::of(mesh, metric)?;
    let straight = straight_angles(mesh, |t| Some((mean(t), mesh.corners_of(t))));
    let curved =
        geodesic_angles(mesh, &edges, &measured, |v, from, to| Ok(angle(tensor(metric, mesh.point(v))?, from, to)))?;
    Ok(of(&measured, &Both { straight, geodesic: curved }))
}

/// Of the mesh of a surface.
pub(super) fn on_surface(mesh: &Mesh, manifold: &Manifold, metric: &dyn SurfaceMetric) -> Result<Histograms> {
    demand_vertices(mesh)?;
    let field = Field::new(manifold, metric);
    let edges = Edges::of(&mesh.triangles);
    let measured = measure(mesh, &edges, |side, inside| field.geodesic(mesh, side, inside))?;
    let flattened = field.flattened(mesh)?;
    let curved = geodesic_angles(mesh, &edges, &measured, |v, from, to| {
        let (m, plane) = field.tangential(mesh.position(v))?;
        Ok(angle(m, plane.flatten(from), plane.flatten(to)))
    })?;
    Ok(of(&measured, &Both { straight: straight_angles(mesh, flattened), geodesic: curved }))
}

/// The distributions of what was measured.
fn of<V>(measured: &[MeasuredEdge<V>], angles: &Both<Vec<f64>>) -> Histograms {
    let lengths = Both {
        straight: measured.iter().map(|e| e.straight).collect::<Vec<_>>(),
        geodesic: measured.iter().map(|e| e.geodesic).collect(),
    };
    let count = |found| measured.iter().filter(|edge| edge.found == found).count();
    let unit =
        |lengths: &[f64]| EdgeLengths::of(|| lengths.iter().copied()).map_or(f64::NAN, |figures| figures.unit_fraction);
    Histograms {
        unit_fraction: Both { straight: unit(&lengths.straight), geodesic: unit(&lengths.geodesic) },
        edge_length: Histogram::of(LENGTHS, &lengths),
        angle: Histogram::of(ANGLES, angles),
        geodesics_not_found: count(Found::No),
        geodesics_on_border: count(Found::OnBorder),
    }
}

impl Histogram {
    /// Of values from 0 up, in bins of this width, the last of which begins at `last`.
    fn of((width, last): (f64, f64), values: &Both<Vec<f64>>) -> Self {
        let bins = (last / width).round() as usize + 1;
        let count = |values: &[f64]| {
            let mut counts = vec![0; bins];
            for value in values {
                counts[((value / width) as usize).min(bins - 1)] += 1;
            }
            counts
        };
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let deviation = |values: &[f64]| {
            let centre = mean(values);
            mean(&values.iter().map(|value| (value - centre).powi(2)).collect::<Vec<_>>()).sqrt()
        };
        Self {
            // Not multiples of the width, which would have the rounding of 0.05 in them.
            bounds: (0..bins).map(|i| last * i as f64 / (bins - 1) as f64).collect(),
            counts: Both { straight: count(&values.straight), geodesic: count(&values.geodesic) },
            mean: Both { straight: mean(&values.straight), geodesic: mean(&values.geodesic) },
            std: Both { straight: deviation(&values.straight), geodesic: deviation(&values.geodesic) },
        }
    }
}

/// The three angles of each triangle between its straight edges, laid out flat in its metric; none of what has no area in space.
fn straight_angles(mesh: &Mesh, laid_out: impl Fn([u32; 3]) -> Option<(Tensor, [Point; 3])> + Sync + Send) -> Vec<f64> {
    let of_triangle = |&triangle: &[u32; 3]| {
        let Some((m, [a, b, c])) = laid_out(triangle) else { return [0.0; 3] };
        [angle(m, b - a, c - a), angle(m, c - b, a - b), angle(m, a - c, b - c)].map(unsigned)
    };
    mesh.triangles.par_iter().map(of_triangle).collect::<Vec<_>>().into_flattened()
}

/// The three angles of each triangle between the geodesics that leave its vertices.
fn geodesic_angles<V: Copy + Sync>(
    mesh: &Mesh,
    edges: &Edges,
    measured: &[MeasuredEdge<V>],
    between: impl Fn(u32, V, V) -> Result<f64> + Sync + Send,
) -> Result<Vec<f64>> {
    let mut edge_of = vec![0; 3 * mesh.triangles.len()];
    for (edge, sides) in edges.iter().enumerate() {
        for side in sides {
            edge_of[side.half_edge as usize] = edge;
        }
    }
    let numbers: Vec<usize> = (0..mesh.triangles.len()).collect();
    let angles = collect(&numbers, |&t| {
        let triangle = mesh.triangles[t];
        // From a corner towards the one after it, and from that one back.
        let sides = [0, 1, 2].map(|i| {
            let [ahead, back] = measured[edge_of[3 * t + i]].directions;
            if triangle[i] < triangle[(i + 1) % 3] { [ahead, back] } else { [back, ahead] }
        });
        let mut angles = [0.0; 3];
        for (i, found) in angles.iter_mut().enumerate() {
            *found = unsigned(between(triangle[i], sides[i][0], sides[(i + 2) % 3][1])?);
        }
        Ok(angles)
    });
    Ok(angles?.into_flattened())
}

/// Degrees, whichever way round.
fn unsigned(angle: f64) -> f64 {
    angle.abs().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::super::histograms;
    use super::super::test_meshes::{grid, lattice, mesh};
    use super::*;
    use crate::manifold::surface::metric::Constant;
    use crate::manifold::surface::sphere;

    /// How many values the bins that touch this value have.
    fn near(histogram: &Histogram, value: f64) -> [usize; 2] {
        let width = histogram.bounds[1];
        let bins =
            || (0..histogram.bounds.len()).filter(|&i| (histogram.bounds[i] + 0.5 * width - value).abs() < 0.6 * width);
        [&histogram.counts.straight, &histogram.counts.geodesic].map(|counts| bins().map(|i| counts[i]).sum())
    }

    #[test]
    fn equilateral_lattice_has_unit_edges_and_sixty_degrees() {
        let lattice = lattice(8);
        let found = histograms(&lattice, &|_: Point| Tensor::IDENTITY).unwrap();
        let edges = Edges::of(&lattice.triangles).iter().count();
        assert_eq!(near(&found.edge_length, 1.0), [edges; 2]);
        assert_eq!(near(&found.angle, 60.0), [3 * lattice.triangles.len(); 2]);
        for mean in [found.edge_length.mean.straight, found.edge_length.mean.geodesic] {
            assert!((mean - 1.0).abs() < 1e-9, "{mean}");
        }
        assert!((found.angle.mean.straight - 60.0).abs() < 1e-9 && (found.angle.mean.geodesic - 60.0).abs() < 1e-6);
        assert!((found.unit_fraction.geodesic - 1.0).abs() < 1e-15);
        assert_eq!((found.geodesics_not_found, found.geodesics_on_border), (0, 0));
    }

    #[test]
    fn right_triangles_of_a_known_mesh() {
        // Two squares of side 0.62, cut in halves: 7 sides, 2 diagonals.
        let found = histograms(&grid(2, 1), &|_: Point| Tensor::IDENTITY * 0.62_f64.powi(2)).unwrap();
        assert_eq!((near(&found.edge_length, 0.62), near(&found.edge_length, 0.62 * 2.0_f64.sqrt())), ([7; 2], [2; 2]));
        assert_eq!((near(&found.angle, 45.0), near(&found.angle, 90.0)), ([8; 2], [4; 2]));
        assert!((found.unit_fraction.straight - 2.0 / 9.0).abs() < 1e-15);
        let far = histograms(&grid(2, 1), &|_: Point| Tensor::IDENTITY * 100.0).unwrap();
        assert_eq!(far.edge_length.counts.straight.last(), Some(&9));
    }

    #[test]
    fn hyperbolic_triangles_have_less_than_180_degrees() {
        let corners = [[0.0, 1.0], [0.5, 1.1], [0.1, 1.7]];
        let half_plane = |p: Point| Tensor::isotropic(p.y);
        let found = histograms(&mesh(&corners, &[[0, 1, 2]]), &half_plane).unwrap();
        let [a, b, c] = [[1, 2], [2, 0], [0, 1]].map(|[i, j]: [usize; 2]| {
            let [p, q] = [corners[i], corners[j]];
            (1.0 + ((p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)) / (2.0 * p[1] * q[1])).acosh()
        });
        // The hyperbolic law of cosines.
        let at =
            |a: f64, b: f64, c: f64| ((b.cosh() * c.cosh() - a.cosh()) / (b.sinh() * c.sinh())).acos().to_degrees();
        let mean = (at(a, b, c) + at(b, c, a) + at(c, a, b)) / 3.0;
        assert!(mean < 58.0 && (found.angle.mean.geodesic - mean).abs() < 1e-3, "{mean} {:?}", found.angle.mean);
        assert!((found.angle.mean.straight - 60.0).abs() < 1e-9);
        assert!((found.edge_length.mean.geodesic - (a + b + c) / 3.0).abs() < 1e-8);
        assert!(found.edge_length.mean.straight > found.edge_length.mean.geodesic);
    }

    /// Great circles of the unit sphere: lengths and angles by spherical trigonometry; seen on an equation and on its triangles.
    #[test]
    fn spherical_triangles_have_more_than_180_degrees() {
        let exact = Manifold::shape("sphere:1", Some(0.05)).unwrap();
        let mesh = sphere(1.0, 0.4).unwrap().to_mesh();
        let field = Constant(crate::geometry::Tensor3::IDENTITY);
        let at = |v: u32| mesh.position(v) - crate::geometry::Point3::default();
        let arc = |[v, w]: [u32; 2]| at(v).dot(at(w)).clamp(-1.0, 1.0).acos();
        let corner = |[a, b, c]: [u32; 3]| {
            let [a, b, c] = [arc([b, c]), arc([c, a]), arc([a, b])];
            ((a.cos() - b.cos() * c.cos()) / (b.sin() * c.sin())).acos().to_degrees()
        };
        let edges = Edges::of(&mesh.triangles);
        let count = edges.ends().count() as f64;
        let length = edges.ends().map(arc).sum::<f64>() / count;
        let chord = edges.ends().map(|[v, w]| mesh.position(v).distance(mesh.position(w))).sum::<f64>() / count;
        let angles: f64 =
            mesh.triangles.iter().map(|&[a, b, c]| corner([a, b, c]) + corner([b, c, a]) + corner([c, a, b])).sum();
        let mean = angles / (3 * mesh.triangles.len()) as f64;
        assert!(mean > 60.5, "{mean}");
        for (manifold, tolerance) in [(&exact, 1e-6), (&Manifold::new(exact.surface().clone(), None), 1e-3)] {
            let found = histograms(&mesh, (manifold, &field)).unwrap();
            assert!(
                (found.edge_length.mean.geodesic / length - 1.0).abs() < tolerance,
                "{:?} {length}",
                found.edge_length.mean
            );
            assert!((found.edge_length.mean.straight / chord - 1.0).abs() < 1e-9);
            assert!((found.angle.mean.geodesic / mean - 1.0).abs() < 10.0 * tolerance, "{:?} {mean}", found.angle.mean);
            assert!((found.angle.mean.straight - 60.0).abs() < 1e-9);
            assert_eq!((found.geodesics_not_found, found.geodesics_on_border), (0, 0));
        }
    }

    /// A tilted square is the square.
    #[test]
    fn histograms_of_a_plane_in_space_are_those_of_the_plane() {
        let mut flat = grid(6, 6);
        flat.edges = Edges::of(&flat.triangles).boundary().map(|side| side.ends).collect();
        let bent = |x: f64| Tensor::new(1.0 + x * x, 0.2, 1.5);
        let truth = histograms(&flat, &|p: Point| bent(p.x)).unwrap();
        let mut tilted = flat.clone();
        tilted.points.iter_mut().for_each(|p| *p = [0.6 * p[0], p[1], 0.8 * p[0]]);
        let [u, v] = [[0.6, 0.0, 0.8], [0.0, 1.0, 0.0]].map(|[x, y, z]| crate::geometry::Vector3::new(x, y, z));
        let field = |p: crate::geometry::Point3| {
            crate::geometry::TangentPlane { u, v, normal: u.cross(v) }.extend(bent(p.x / 0.6), 9.0)
        };
        let manifold = Manifold::of(&tilted).unwrap();
        let found = histograms(&tilted, (&manifold, &field)).unwrap();
        assert!(truth.geodesics_on_border > 0);
        assert_eq!((found.geodesics_on_border, found.geodesics_not_found), (truth.geodesics_on_border, 0));
        for (found, truth) in [
            (found.edge_length.mean, truth.edge_length.mean),
            (found.angle.mean, truth.angle.mean),
            (found.angle.std, truth.angle.std),
        ] {
            assert!((found.straight - truth.straight).abs() < 1e-6 * truth.straight, "{found:?} {truth:?}");
            assert!((found.geodesic - truth.geodesic).abs() < 1e-4 * truth.geodesic, "{found:?} {truth:?}");
        }
    }

    #[test]
    fn where_there_is_no_geodesic_the_straight_edge_stands() {
        // An edge of no length: no direction, and nothing to divide by.
        let degenerate = mesh(&[[0.0, 0.0], [0.0, 0.0], [1.0, 0.0]], &[[0, 1, 2]]);
        let found = histograms(&degenerate, &|_: Point| Tensor::IDENTITY).unwrap();
        assert_eq!(found.geodesics_not_found, 1);
        assert_eq!(found.edge_length.counts.straight, found.edge_length.counts.geodesic);
        let none = histograms(&Mesh::default(), &|_: Point| Tensor::IDENTITY).unwrap();
        assert!(none.edge_length.counts.straight.iter().all(|&count| count == 0) && none.angle.mean.straight.is_nan());
    }

    #[test]
    fn bad_metrics_and_threads() {
        let nan = |_: Point| Tensor::new(f64::NAN, 0.0, 1.0);
        assert!(matches!(histograms(&grid(2, 2), &nan), Err(crate::Error::Metric { .. })));
        let metric = |p: Point| Tensor::new(1.0 + p.x * p.x, 0.3, 2.0 + p.y.sin());
        let with = |threads| crate::test_cases::on_threads(threads, || histograms(&grid(20, 20), &metric).unwrap());
        assert_eq!(with(1), with(3));
    }
}
