//! Lengths, shapes and angles of the mesh of a surface in a metric on that surface.

use super::faults::Position;
use super::geodesics::{Found, MeasuredEdge, geodesic};
use super::planar_quality::{GAUSS, MetricQuality, Shape, collect, demand_vertices, fault, figures};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::{Point, Point3, Seen, TangentPlane, Tensor, Vector, Vector3};
use crate::manifold::surface::metric::{SurfaceMetric, check_tensor3};
use crate::manifold::{Chart, Manifold};
use crate::mesh::{EdgeSide, Mesh};
use crate::metric::MetricField;

/// Of the mesh of a surface.
pub(super) fn on_surface(mesh: &Mesh, surface: &Manifold, metric: &dyn SurfaceMetric) -> Result<MetricQuality> {
    demand_vertices(mesh)?;
    let field = Field::new(surface, metric);
    let shape = field.shapes(mesh)?;
    let length = |side: &EdgeSide| field.length(side.ends.map(|v| mesh.position(v)));
    figures(mesh, length, |t| Ok(shape(mesh.triangles[t])), Position::from)
}

/// A metric field, and where to look it up.
pub(super) struct Field<'a> {
    surface: &'a Manifold,
    metric: &'a dyn SurfaceMetric,
}

impl<'a> Field<'a> {
    pub(super) fn new(surface: &'a Manifold, metric: &'a dyn SurfaceMetric) -> Self {
        surface.prepare();
        Self { surface, metric }
    }

    /// What the metric is at the closest place.
    fn at(&self, p: Point3) -> Result<Seen> {
        let not_finite = || fault("a position is not finite", &p.to_string());
        let place = self.surface.closest_of_triangles(p).ok_or_else(not_finite)?.place;
        let tensor = self.metric.at(&place);
        check_tensor3(tensor, || place.position.to_string())?;
        Ok(Seen { tensor, normal: self.surface.normal_between(&place) })
    }

    /// The metric around a place, as the tangent plane there sees it, and a vector in it, of its own length; `None` where the
    /// vector has no tangent part. Where the metric is none, tensors are not finite.
    pub(super) fn around(&self, p: Point3, edge: Vector3) -> Option<(impl MetricField + '_, Vector)> {
        let plane = TangentPlane::new(self.at(p).ok()?.normal);
        let tangent = edge - plane.normal * edge.dot(plane.normal);
        let flat = plane.flatten(tangent.unit()? * edge.norm());
        let at = move |q: Point| {
            let seen = self.at(p + plane.lift(q - Point::default()));
            seen.map_or(Tensor::isotropic(f64::NAN), |seen| seen.in_plane(&plane))
        };
        Some((at, flat))
    }

    /// What the metric says of tangents at the closest place, and their plane.
    pub(super) fn tangential(&self, p: Point3) -> Result<(Tensor, TangentPlane)> {
        let seen = self.at(p)?;
        let plane = TangentPlane::new(seen.normal);
        Ok((plane.restrict(seen.tensor), plane))
    }

    /// An edge, straight and as a geodesic of the chart at its middle; `inside` is where the surface lies of an edge on its border.
    pub(super) fn geodesic(&self, mesh: &Mesh, side: &EdgeSide, inside: Option<f64>) -> Result<MeasuredEdge<Vector3>> {
        let [a, b] = side.ends.map(|v| mesh.position(v));
        let straight = self.length([a, b])?;
        let chord = MeasuredEdge { straight, geodesic: straight, directions: [b - a, a - b], found: Found::No };
        let closest = |p: Point3| {
            let place = self.surface.closest_of_triangles(p)?.place;
            self.surface.lift(&place, p)
        };
        let Some(middle) = closest(a.lerp(b, 0.5)) else { return Ok(chord) };
        let chart = Chart::new(self.surface, self.metric, middle, self.surface.normal(&middle));
        let ends = [a, b].map(|p| chart.flatten(p));
        // Seen from the side that its triangle turns to, which is the chart's or the other.
        let [p, q, r] = mesh.positions_of(mesh.triangles[side.half_edge as usize / 3]);
        let turns = (q - p).cross(r - p).dot(self.surface.normal(&middle)).signum();
        let found = geodesic(&chart, ends, straight, inside.map(|side| side * turns));
        let places = ends.map(|end| chart.place(end));
        let ([Some(from), Some(to)], Found::Geodesic) = (places, found.found) else {
            return Ok(MeasuredEdge { found: found.found, ..chord });
        };
        let [ahead, back] = found.directions;
        Ok(MeasuredEdge {
            directions: [chart.tangent(&from, ahead), chart.tangent(&to, back)],
            geodesic: found.geodesic,
            ..MeasuredEdge { found: Found::Geodesic, ..chord }
        })
    }

    /// The shapes of the triangles of a mesh.
    ///
    /// # Errors
    /// A position is not finite; the metric at a vertex in use is none.
    pub(super) fn shapes<'m>(&self, mesh: &'m Mesh) -> Result<impl Fn([u32; 3]) -> Shape + use<'m>> {
        let flattened = self.flattened(mesh)?;
        Ok(move |t: [u32; 3]| flattened(t).map_or(Shape::default(), |(metric, corners)| Shape::of(metric, corners)))
    }

    /// The triangles of a mesh laid out flat, each in the mean of the metric at its corners.
    ///
    /// # Errors
    /// As of [`Field::shapes`].
    pub(super) fn flattened<'m>(&self, mesh: &'m Mesh) -> Result<impl Fn([u32; 3]) -> Option<Flattened> + use<'m>> {
        let used = mesh.used_vertices();
        let vertices: Vec<u32> = (0..mesh.points.len() as u32).collect();
        let seen = |v: u32| used[v as usize].then(|| self.at(mesh.position(v))).transpose();
        let tensors = collect(&vertices, |&v| seen(v))?;
        Ok(move |t: [u32; 3]| {
            let corners = t.map(|v| tensors[v as usize]);
            let [Some(a), Some(b), Some(c)] = corners else { return None };
            Seen::flattened(mesh.positions_of(t), [a, b, c])
        })
    }

    /// The length of a straight edge.
    pub(super) fn length(&self, [a, b]: [Point3; 2]) -> Result<f64> {
        let part = |&(t, weight): &(f64, f64)| Ok(weight * length(self.at(a.lerp(b, t))?, b - a));
        GAUSS.iter().map(part).sum()
    }
}

/// A triangle laid out flat, and the metric there.
pub(super) type Flattened = (Tensor, [Point; 3]);

/// The metric length of a vector of its Euclidean length that points along its part in the tangent plane; the mean over
/// directions, roughly, of one that has no such part.
fn length(Seen { tensor, normal }: Seen, edge: Vector3) -> f64 {
    let tangent = edge - normal * edge.dot(normal);
    match tangent.unit() {
        Some(direction) => tensor.length(direction) * edge.norm(),
        None => TangentPlane::new(normal).restrict(tensor).determinant().raised_to(0.25) * edge.norm(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::metric_quality;
    use super::super::test_meshes::grid;
    use super::*;
    use crate::geometry::{Tensor, Tensor3};
    use crate::manifold::Place;
    use crate::manifold::surface::metric::Constant;
    use crate::manifold::surface::{sphere, torus};

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance * b.abs(), "{a} is not {b}");
    }

    fn assert_close(a: &MetricQuality, b: &MetricQuality, tolerance: f64) {
        let (la, lb) = (a.metric_edge_length, b.metric_edge_length);
        for (a, b) in [
            (la.min, lb.min),
            (la.mean, lb.mean),
            (la.max, lb.max),
            (a.quality.min, b.quality.min),
            (a.quality.mean, b.quality.mean),
            (a.angle.min, b.angle.min),
            (a.angle.mean_min, b.angle.mean_min),
            (a.worst.longest_edge.value, b.worst.longest_edge.value),
        ] {
            close(a, b, tolerance);
        }
    }

    /// A rotation, its rows.
    fn rotation() -> [Vector3; 3] {
        let axis = Vector3::new(0.48, 0.6, 0.64);
        let u = axis.perpendicular();
        [u, axis.cross(u), axis]
    }

    fn rotate(p: Point3) -> Point3 {
        let v = p - Point3::default();
        let [a, b, c] = rotation().map(|row| row.dot(v));
        Point3::new(a, b, c)
    }

    fn bent() -> Mesh {
        let mut mesh = grid(6, 5);
        mesh.points.iter_mut().for_each(|p| *p = [p[0] + 0.05 * p[1] * p[1], p[1] - 0.02 * p[0] * p[1], 0.0]);
        mesh
    }

    #[test]
    fn planes_in_space_are_planes() {
        let flat = bent();
        let planar = |p: Point| Tensor::new(3.0 + p.x.sin(), 0.4 * p.y.cos(), 1.0 + 0.1 * p.x * p.y);
        let truth = metric_quality(&flat, &planar).unwrap();
        let mut turned = flat.clone();
        turned.points.iter_mut().for_each(|p| *p = rotate(Point3::from(*p)).to_array());
        // The planar field, with whatever normal eigenvalue, in the coordinates of space.
        let rows = rotation();
        let columns = [0, 1, 2].map(|i| {
            let [x, y, z] = rows.map(|row| [row.x, row.y, row.z][i]);
            Vector3::new(x, y, z)
        });
        let field = |p: Point3| {
            let v = p - Point3::default();
            let m = planar(Point::new(columns[0].dot(v), columns[1].dot(v)));
            TangentPlane { u: columns[0], v: columns[1], normal: columns[2] }.extend(m, 1e5)
        };
        let surface = Manifold::of(&turned).unwrap();
        let found = metric_quality(&turned, (&surface, &field)).unwrap();
        assert_close(&found, &truth, 1e-9);
        assert_eq!(found.interior_edge_length.is_some(), truth.interior_edge_length.is_some());
        let [p, q] = [found, truth].map(|found| found.worst.triangle.at);
        let flat = Point3::new(q.coordinates()[0], q.coordinates()[1], 0.0);
        let Position::Space(at) = p else { panic!("three coordinates") };
        assert!(rotate(flat).distance(at.into()) < 1e-12);
    }

    /// Large along the normal of every place.
    struct Thick;

    impl SurfaceMetric for Thick {
        fn at(&self, place: &Place) -> Tensor3 {
            Tensor3::IDENTITY + Tensor3::square(place.normal) * 1e4
        }
    }

    #[test]
    fn the_normal_is_not_seen() {
        let surface = Manifold::new(sphere(2.0, 0.4).unwrap(), None);
        let mesh = torus(1.5, 0.4, 0.2).unwrap().to_mesh();
        let truth = metric_quality(&mesh, (&surface, &Constant(Tensor3::IDENTITY))).unwrap();
        assert_close(&metric_quality(&mesh, (&surface, &Thick)).unwrap(), &truth, 1e-9);
        let longest = truth.metric_edge_length.max;
        let edges = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let lengths = edges.map(|[a, b]| mesh.position(a).distance(mesh.position(b)));
        close(longest, lengths.fold(0.0, f64::max), 1e-12);
    }

    #[test]
    fn a_rolled_sheet_is_the_sheet() {
        let sheet = bent();
        let m = Tensor::new(9.0, 2.0, 1.0);
        let truth = metric_quality(&sheet, &|_: Point| m).unwrap();
        // Unit steps around a cylinder: what chords and tangents see differs by the square of 1 / radius.
        for radius in [20.0, 80.0] {
            let mut rolled = sheet.clone();
            for p in &mut rolled.points {
                let angle = p[0] / radius;
                *p = [radius * angle.sin(), p[1], radius * angle.cos()];
            }
            let field = |p: Point3| {
                let from_axis = p.x.hypot(p.z);
                let around = Vector3::new(p.z / from_axis, 0.0, -p.x / from_axis);
                let along = Vector3::new(0.0, 1.0, 0.0);
                TangentPlane { u: around, v: along, normal: around.cross(along) }.extend(m, 77.0)
            };
            let found = metric_quality(&rolled, (&Manifold::of(&rolled).unwrap(), &field)).unwrap();
            assert_close(&found, &truth, 5.0 / (radius * radius));
        }
    }

    #[test]
    fn faults_are_errors_and_threads_do_not_matter() {
        let surface = Manifold::new(sphere(2.0, 0.4).unwrap(), None);
        let mesh = surface.whole_mesh();
        let nan = metric_quality(&mesh, (&surface, &|_: Point3| Tensor3::IDENTITY * f64::NAN));
        assert!(matches!(nan, Err(crate::Error::Metric { .. })));
        let empty = metric_quality(&Mesh::default(), (&surface, &Constant(Tensor3::IDENTITY)));
        assert!(matches!(empty, Err(crate::Error::Mesh { .. })));
        let mut broken = mesh.clone();
        broken.points[0][1] = f64::NAN;
        let broken = metric_quality(&broken, (&surface, &Constant(Tensor3::IDENTITY)));
        assert!(matches!(broken, Err(crate::Error::Mesh { .. })));
        let field = |p: Point3| Tensor3::from_disk([2.0 + p.x.sin(), 0.1, 2.0, 0.1, 0.1, 1.0 + p.y * p.y]);
        let with =
            |threads| crate::test_cases::on_threads(threads, || metric_quality(&mesh, (&surface, &field)).unwrap());
        assert_eq!(with(1), with(3));
    }
}
