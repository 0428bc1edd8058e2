//! Lengths, shapes and angles of a mesh in a metric.

use super::curved::{shape, side_length};
use super::faults::{Position, middle};
use super::tensors::tensor_near;
use crate::curved::Rule;
use crate::error::{Error, Result};
use crate::geodesic::is_unit;
use crate::geometry::{Point, Point3, Tensor};
use crate::lists::marked;
use crate::mesh::{EdgeSide, Edges, Mesh};
use crate::metric::{MetricField, Near};
use crate::parallel::prelude::*;

/// The figures of a mesh in a metric field. They do not change when mesh and metric are pulled back by the same
/// affine map.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct MetricQuality {
    /// Metric lengths of all edges.
    pub metric_edge_length: EdgeLengths,
    /// Metric lengths of the edges that touch no boundary vertex; `None` where there are none.
    pub interior_edge_length: Option<EdgeLengths>,
    /// Shape of the triangles.
    pub quality: Quality,
    /// Angles of the triangles.
    pub angle: Angles,
    /// Where the metric is honoured least.
    pub worst: Worst,
}

/// Metric lengths of edges: the integral of sqrt(e' M e) along the edge by Gauss-Legendre, of 5 points for a straight one.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct EdgeLengths {
    /// Shortest.
    pub min: f64,
    /// Arithmetic mean.
    pub mean: f64,
    /// Longest.
    pub max: f64,
    /// Standard deviation (of the whole population).
    pub std: f64,
    /// Share of the edges whose length is in [1/sqrt 2, sqrt 2].
    pub unit_fraction: f64,
}

/// 4 sqrt 3 A / (sum of the squared side lengths), A and sides in the metric M of the triangle, the log-Euclidean mean
/// of the tensors at its vertices: 1 for an equilateral triangle, 0 for a flat one, negative for an inverted one. Of a curved
/// triangle the mean over it of 2 sqrt(det C) / tr C, which is the same of a straight one in one metric: C is M as the equilateral
/// triangle sees it through the triangle's map.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Quality {
    /// Of the worst triangle.
    pub min: f64,
    /// Arithmetic mean over triangles.
    pub mean: f64,
}

/// Degrees, in the metric M of the triangle (see [`Quality`]).
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Angles {
    /// The smallest angle of the mesh.
    pub min: f64,
    /// The mean over triangles of the smallest angle of each.
    pub mean_min: f64,
}

/// Where to look.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Worst {
    /// The triangle with the least quality, by its centroid.
    pub triangle: Spot,
    /// The edge of the greatest metric length, by its midpoint.
    pub longest_edge: Spot,
    /// The edge of the least metric length, by its midpoint.
    pub shortest_edge: Spot,
}

/// A figure, and the place it was taken.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Spot {
    /// The figure.
    pub value: f64,
    /// Where.
    pub at: Position,
}

/// Of a planar mesh.
pub(super) fn in_plane(mesh: &Mesh, metric: &dyn MetricField) -> Result<MetricQuality> {
    demand_planar(mesh)?;
    if mesh.curved.is_some() {
        mesh.check_numbers()?;
        let rule = Rule::fine(mesh);
        let length = |side: &_| side_length(mesh, side, metric);
        let shape = |t| shape(mesh, &rule, t, metric).map(|[quality, angle]| Shape::new(quality, angle));
        return figures(mesh, length, shape, Position::in_plane);
    }
    let (corners, mean) = Corners::of(mesh, metric)?;
    let shape = |t: usize| Ok(Shape::of(mean(mesh.triangles[t]), mesh.corners_of(mesh.triangles[t])));
    figures(mesh, |side| corners.edge_length(side.ends), shape, Position::in_plane)
}

/// A planar mesh in a metric: the logarithms of the tensors at its vertices, and where the field found these.
pub(super) struct Corners<'a> {
    mesh: &'a Mesh,
    metric: &'a dyn MetricField,
    near: Vec<Near>,
}

/// What is measured one after the other, such as vertices.
const PART: usize = 256;
/// What is measured in parallel before it is put together: many parts for each core, and little memory.
const BLOCK: usize = 256 * PART;

impl<'a> Corners<'a> {
    /// Measures the vertices of triangles; and what gives the log-Euclidean mean of the tensors at the corners of a triangle.
    ///
    /// # Errors
    /// [`Error::Metric`] where a tensor at a vertex is not positive definite.
    pub(super) fn of(
        mesh: &'a Mesh,
        metric: &'a dyn MetricField,
    ) -> Result<(Self, impl Fn([u32; 3]) -> Tensor + Sync + use<>)> {
        let used = mesh.used_vertices();
        let vertices: Vec<u32> = (0..mesh.points.len() as u32).collect();
        // Vertices with numbers next to each other are mostly near each other.
        let part = |vertices: &[u32]| -> Result<Vec<(Tensor, Near)>> {
            let mut near = Near::default();
            let mut at = |&v: &u32| {
                let used = used[v as usize].then(|| tensor_near(metric, mesh.point(v), &mut near)).transpose()?;
                Ok((used.map_or_else(Tensor::default, Tensor::log), near))
            };
            vertices.iter().map(&mut at).collect()
        };
        let (logarithms, near): (Vec<Tensor>, Vec<Near>) = collect_parts(&vertices, part)?.into_iter().unzip();
        let mean = move |triangle: [u32; 3]| {
            let [a, b, c] = triangle.map(|v| logarithms[v as usize]);
            ((a + b + c) * (1.0 / 3.0)).exp()
        };
        Ok((Self { mesh, metric, near }, mean))
    }

    /// The metric length of an edge, see [`edge_length`].
    ///
    /// # Errors
    /// [`Error::Metric`] where the tensor at a Gauss point is not positive definite.
    pub(super) fn edge_length(&self, ends: [u32; 2]) -> Result<f64> {
        length_near(ends.map(|v| self.mesh.point(v)), self.metric, self.near[ends[0] as usize])
    }
}

/// The figures of a mesh from the metric length of each edge, by its first side, and the shape of each triangle, by its number.
///
/// # Errors
/// [`Error::Mesh`] without triangles, and the first error of a length or a shape.
pub(super) fn figures(
    mesh: &Mesh,
    length: impl Fn(&EdgeSide) -> Result<f64> + Sync + Send,
    shape: impl Fn(usize) -> Result<Shape> + Sync + Send,
    position: impl Fn(Point3) -> Position,
) -> Result<MetricQuality> {
    let shapes = Shapes::of(mesh, shape, &position, |_, _| ())?;
    let edges = Edges::of(&mesh.triangles);
    let lengths = of_edges(&edges, length)?;
    let ends: Vec<[u32; 2]> = edges.ends().collect();
    summed(mesh, &edges, &ends, &lengths, &shapes, position)
        .ok_or_else(|| fault("there are no triangles", "the array of triangles"))
}

/// The figures of the shapes of triangles, summed in order.
pub(super) struct Shapes {
    quality: Quality,
    angle: Angles,
    worst: Spot,
}

impl Shapes {
    /// Of all triangles, by their numbers; `see` is shown each with its quality and its smallest angle.
    ///
    /// # Errors
    /// The first of a shape.
    pub(super) fn of(
        mesh: &Mesh,
        shape: impl Fn(usize) -> Result<Shape> + Sync + Send,
        position: impl Fn(Point3) -> Position,
        mut see: impl FnMut(usize, [f64; 2]),
    ) -> Result<Self> {
        let (mut least, mut sum) = ([f64::INFINITY; 2], [0.0; 2]);
        let mut worst: Option<(usize, f64)> = None;
        let count = mesh.triangles.len();
        for start in (0..count).step_by(BLOCK) {
            let numbers: Vec<usize> = (start..count.min(start + BLOCK)).collect();
            for (t, found) in numbers.iter().copied().zip(collect(&numbers, |&t| Ok(shape(t)?.figures()))?) {
                (0..2).for_each(|i| (least[i], sum[i]) = (least[i].min(found[i]), sum[i] + found[i]));
                if worst.is_none_or(|(_, worst)| found[0].total_cmp(&worst).is_lt()) {
                    worst = Some((t, found[0]));
                }
                see(t, found);
            }
        }
        let mean = sum.map(|sum| sum / count as f64);
        let spot = |(t, value): (usize, f64)| Spot { value, at: position(middle(mesh, &mesh.triangles[t])) };
        Ok(Self {
            quality: Quality { min: least[0], mean: mean[0] },
            angle: Angles { min: least[1], mean_min: mean[1] },
            worst: worst.map_or(NOWHERE, spot),
        })
    }
}

/// The figures of a mesh from its edges with their ends and metric lengths, and those of its triangles; none without triangles.
pub(super) fn summed(
    mesh: &Mesh,
    edges: &Edges,
    ends: &[[u32; 2]],
    lengths: &[f64],
    shapes: &Shapes,
    position: impl Fn(Point3) -> Position,
) -> Option<MetricQuality> {
    let on_boundary = marked(mesh.points.len(), edges.boundary().flat_map(|side| side.ends));
    let is_interior = |ends: &[u32; 2]| ends.iter().all(|&v| !on_boundary[v as usize]);
    let interior = || ends.iter().zip(lengths).filter(|(ends, _)| is_interior(ends)).map(|(_, &length)| length);
    let of_edge = |e: usize| position(middle(mesh, &ends[e]));
    Some(MetricQuality {
        metric_edge_length: EdgeLengths::of(|| lengths.iter().copied())?,
        interior_edge_length: EdgeLengths::of(interior),
        quality: shapes.quality,
        angle: shapes.angle,
        worst: Worst {
            triangle: shapes.worst,
            longest_edge: spot(lengths, |l| -l, of_edge).map(|length| -length),
            shortest_edge: spot(lengths, |&l| l, of_edge),
        },
    })
}

impl EdgeLengths {
    /// Of lengths that can be gone through again; none of none.
    pub(super) fn of<I: Iterator<Item = f64>>(lengths: impl Fn() -> I) -> Option<Self> {
        let count = lengths().count() as f64;
        let mean = lengths().sum::<f64>() / count;
        (count > 0.0).then(|| Self {
            min: lengths().fold(f64::INFINITY, f64::min),
            mean,
            max: lengths().fold(f64::NEG_INFINITY, f64::max),
            std: (lengths().map(|length| (length - mean) * (length - mean)).sum::<f64>() / count).sqrt(),
            unit_fraction: lengths().filter(|&length| is_unit(length)).count() as f64 / count,
        })
    }
}

impl Spot {
    pub(super) fn map(self, f: impl Fn(f64) -> f64) -> Self {
        Self { value: f(self.value), at: self.at }
    }
}

pub(super) use super::tensors::{angle, tensor};
pub(super) use crate::curved::GAUSS;

/// Metric length of the straight edge.
pub(super) fn edge_length(ends: [Point; 2], metric: &dyn MetricField) -> Result<f64> {
    length_near(ends, metric, Near::default())
}

fn length_near([a, b]: [Point; 2], metric: &dyn MetricField, mut near: Near) -> Result<f64> {
    GAUSS.iter().map(|&(t, weight)| Ok(weight * tensor_near(metric, a.lerp(b, t), &mut near)?.length(b - a))).sum()
}

/// Quality and smallest angle (degrees) of a triangle in its own metric.
#[derive(Default)]
pub(super) struct Shape {
    pub(super) quality: f64,
    angle: f64,
}

impl Shape {
    /// With this quality, and this smallest angle in radians.
    pub(super) fn new(quality: f64, angle: f64) -> Self {
        Shape { quality: if quality.is_nan() { 0.0 } else { quality }, angle: angle.to_degrees() }
    }

    /// Of the triangle with these corners in the metric m.
    pub(super) fn of(m: Tensor, [a, b, c]: [Point; 3]) -> Self {
        let (ab, bc, ca) = (b - a, c - b, a - c);
        let smallest = angle(m, ab, -ca).min(angle(m, bc, -ab)).min(angle(m, ca, -bc));
        Self::new(m.shape([a, b, c]), smallest)
    }

    /// Both.
    pub(super) fn figures(&self) -> [f64; 2] {
        [self.quality, self.angle]
    }
}
/// Maps in parallel; the error is that of the first item that has one, for any number of threads.
pub(super) fn collect<T: Sync, U: Send>(items: &[T], f: impl Fn(&T) -> Result<U> + Sync + Send) -> Result<Vec<U>> {
    collect_parts(items, |part| part.iter().map(&f).collect())
}

/// Maps parts of [`PART`] items in parallel; the error is that of the first part that has one, for any number of threads.
fn collect_parts<T: Sync, U: Send>(items: &[T], f: impl Fn(&[T]) -> Result<Vec<U>> + Sync + Send) -> Result<Vec<U>> {
    let mut all = Vec::with_capacity(items.len());
    for block in items.chunks(BLOCK) {
        let parts: Vec<Result<Vec<U>>> = block.par_chunks(PART).map(&f).collect();
        for part in parts {
            all.append(&mut part?);
        }
    }
    Ok(all)
}

/// Measures all edges in parallel, by their first sides, in their order.
pub(super) fn of_edges<U: Send>(edges: &Edges, f: impl Fn(&EdgeSide) -> Result<U> + Sync + Send) -> Result<Vec<U>> {
    collect(&edges.firsts(), |&half_edge| f(&edges.side(half_edge)))
}

/// Of nothing.
const NOWHERE: Spot = Spot { value: f64::NAN, at: Position::Plane([f64::NAN; 2]) };

/// The first of the least figures, and its place.
pub(super) fn spot<T>(items: &[T], figure: impl Fn(&T) -> f64, place: impl Fn(usize) -> Position) -> Spot {
    let least = items.iter().map(figure).enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    least.map_or(NOWHERE, |(index, value)| Spot { value, at: place(index) })
}

/// Refuses triangles with vertices that do not exist.
pub(super) fn demand_vertices(mesh: &Mesh) -> Result<()> {
    if mesh.triangles.as_flattened().iter().any(|&v| v as usize >= mesh.points.len()) {
        return Err(fault("a triangle names a vertex that does not exist", "the array of triangles"));
    }
    Ok(())
}

pub(super) fn demand_planar(mesh: &Mesh) -> Result<()> {
    demand_vertices(mesh)?;
    if mesh.is_planar() {
        return Ok(());
    }
    let what = "a metric of the plane on the mesh of a surface";
    Err(Error::unsupported(what, "use a planar mesh (z = 0)"))
}

pub(super) fn fault(what: &str, place: &str) -> Error {
    Error::mesh(what, place, "check that the file is complete")
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "the truths are exact")]
mod tests {
    use super::super::metric_quality;
    use super::super::test_meshes::{grid, lattice, mesh};
    use super::*;
    use crate::geometry::Vector;
    use std::f64::consts::SQRT_2;

    fn close(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-9 * b.abs().max(1.0), "{a} is not {b}");
    }

    fn assert_close(a: &MetricQuality, b: &MetricQuality) {
        let (la, lb) = (a.metric_edge_length, b.metric_edge_length);
        close(la.min, lb.min);
        close(la.mean, lb.mean);
        close(la.max, lb.max);
        close(la.std, lb.std);
        close(la.unit_fraction, lb.unit_fraction);
        close(a.quality.min, b.quality.min);
        close(a.quality.mean, b.quality.mean);
        close(a.angle.min, b.angle.min);
        close(a.angle.mean_min, b.angle.mean_min);
    }

    /// The linear map with rows (a, b), (c, d), and the metric that makes it an isometry onto the Euclidean plane.
    fn pull_back(mesh: &Mesh, [a, b, c, d]: [f64; 4]) -> (Mesh, Tensor) {
        let determinant = a * d - b * c;
        let mut image = mesh.clone();
        image.points.iter_mut().for_each(|p| *p = [a * p[0] + b * p[1], c * p[0] + d * p[1], 0.0]);
        let (first, second) = (Vector::new(d, -b) * (1.0 / determinant), Vector::new(-c, a) * (1.0 / determinant));
        let m = Tensor::new(
            first.x * first.x + second.x * second.x,
            first.x * first.y + second.x * second.y,
            first.y * first.y + second.y * second.y,
        );
        (image, m)
    }

    #[test]
    fn equilateral_lattice_is_perfect() {
        let found = metric_quality(&lattice(8), &|_: Point| Tensor::IDENTITY).unwrap();
        let lengths = found.metric_edge_length;
        assert_eq!(lengths.unit_fraction, 1.0);
        for figure in [lengths.min, lengths.mean, lengths.max, found.quality.min, found.quality.mean] {
            close(figure, 1.0);
        }
        close(found.angle.min, 60.0);
        close(found.angle.mean_min, 60.0);
        assert!(lengths.std < 1e-12);
        close(found.interior_edge_length.unwrap().mean, 1.0);
        assert_eq!(metric_quality(&lattice(1), &|_: Point| Tensor::IDENTITY).unwrap().interior_edge_length, None);
    }

    #[test]
    fn two_right_triangles() {
        let found = metric_quality(&grid(1, 1), &|_: Point| Tensor::IDENTITY).unwrap();
        close(found.metric_edge_length.mean, (4.0 + SQRT_2) / 5.0);
        close(found.quality.min, 3.0_f64.sqrt() / 2.0);
        close(found.angle.min, 45.0);
        assert_eq!(found.worst.longest_edge.at, Position::Plane([0.5, 0.5]));
    }

    #[test]
    fn affine_pull_back_changes_nothing() {
        let truth = metric_quality(&lattice(6), &|_: Point| Tensor::IDENTITY).unwrap();
        for map in [[1e3, 0.0, 0.0, 1.0], [2.0, 30.0, -0.1, 4.0], [1e-9, 0.0, 0.0, 1e-9], [1e9, 3e8, 0.0, 2e9]] {
            let (image, m) = pull_back(&lattice(6), map);
            assert_close(&metric_quality(&image, &|_: Point| m).unwrap(), &truth);
        }
    }

    #[test]
    fn quadrature_follows_a_metric_that_varies() {
        // Length of (0, 0)-(1, 0) with sqrt(xx) = 1 + x^3 is 5/4, exact for polynomials up to degree 9.
        let metric = |p: Point| Tensor::new((1.0 + p.x.powi(3)).powi(2), 0.0, 1.0);
        close(edge_length([Point::new(0.0, 0.0), Point::new(1.0, 0.0)], &metric).unwrap(), 1.25);
    }

    #[test]
    fn bad_metric_and_bad_mesh_are_errors() {
        let bad = |p: Point| if p.x > 3.5 { Tensor::new(1.0, 2.0, 1.0) } else { Tensor::IDENTITY };
        assert!(matches!(metric_quality(&grid(4, 4), &bad), Err(Error::Metric { .. })));
        let nan = |_: Point| Tensor::new(f64::NAN, 0.0, 1.0);
        assert!(matches!(metric_quality(&grid(4, 4), &nan), Err(Error::Metric { .. })));
        assert!(matches!(metric_quality(&Mesh::default(), &bad), Err(Error::Mesh { .. })));
        let missing = mesh(&[[0.0, 0.0]], &[[0, 1, 2]]);
        assert!(matches!(metric_quality(&missing, &bad), Err(Error::Mesh { .. })));
        let nowhere = mesh(&[[0.0, 0.0], [f64::NAN, 0.0], [0.0, 1.0]], &[[0, 1, 2]]);
        assert!(metric_quality(&nowhere, &|_: Point| Tensor::IDENTITY).is_ok());
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits() {
        let metric = |p: Point| Tensor::new(1.0 + p.x * p.x, 0.3, 2.0 + p.y.sin());
        let with = |threads| crate::test_cases::on_threads(threads, || metric_quality(&grid(70, 70), &metric).unwrap());
        assert_eq!(with(1), with(5));
    }
}
