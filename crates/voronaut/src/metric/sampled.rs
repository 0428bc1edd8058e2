//! A metric given at the vertices of a background mesh.

use super::nodal::{isotropic, of_triangle};
use super::validate::{BACKGROUND, check_at_vertices};
use super::{MetricField, Near};
use crate::error::Result;
use crate::geometry::{Aabb, Point, Tensor};
use crate::lists::{distinct, marked};
use crate::mesh::{Located, Locator, Mesh};

/// Rings of triangles around those that meet a domain: derivatives are taken a little outside.
const RINGS: usize = 2;

/// Tensors at the vertices of a planar triangle mesh; inside triangles the log-Euclidean interpolation, exp of the
/// linear interpolation of log M, which is positive definite and between the sizes at the corners.
///
/// Outside the mesh the value is that at the nearest point of the mesh. The field is continuous but for outside points
/// equally near to two parts of the mesh.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// Logarithms, one per vertex.
    logs: Vec<Tensor>,
    /// The tensor, where all vertices have the same: nothing has to be looked for.
    same: Option<Tensor>,
    /// The vertices of every triangle.
    triangles: Vec<[u32; 3]>,
    locator: Locator,
}

impl Sampled {
    /// The field of one tensor per vertex.
    ///
    /// # Errors
    /// [`Error::Metric`](crate::Error::Metric) where the numbers of tensors and vertices differ, or a tensor is not finite and positive
    /// definite; [`Error::Domain`](crate::Error::Domain) where the background has no triangles, is not planar, not finite, or refers to
    /// vertices it does not have.
    pub fn new(background: &Mesh, tensors: &[Tensor]) -> Result<Self> {
        check_at_vertices(background, tensors)?;
        let locator = Locator::new(background, BACKGROUND)?;
        let logs: Vec<Tensor> = tensors.iter().map(|tensor| tensor.log()).collect();
        Ok(Self { same: same(&logs), logs, triangles: background.triangles.clone(), locator })
    }

    /// The isotropic field of one size per vertex: log-linear, so that a size half-way is the geometric mean.
    ///
    /// # Errors
    /// As [`Sampled::new`]; [`Error::Metric`] where a size is not positive and finite.
    pub(crate) fn sizes(background: &Mesh, sizes: &[f64]) -> Result<Self> {
        Self::new(background, &isotropic(background, sizes)?)
    }

    /// The same with other logarithms at the vertices.
    pub(super) fn with_logarithms(self, logs: Vec<Tensor>) -> Self {
        Self { same: same(&logs), logs, ..self }
    }
}

/// The exponential of logarithms that are all the same.
fn same(logs: &[Tensor]) -> Option<Tensor> {
    let first = *logs.first()?;
    logs.iter().all(|log| *log == first).then(|| first.exp())
}

impl MetricField for Sampled {
    fn at(&self, p: Point) -> Tensor {
        self.at_near(p, &mut Near::default())
    }

    fn at_near(&self, p: Point, near: &mut Near) -> Tensor {
        if let Some(tensor) = self.same.filter(|_| p.is_finite()) {
            return tensor;
        }
        let Some(Located { triangle, weights, .. }) = self.locator.locate_from(near.place, p) else {
            return Tensor::new(f64::NAN, f64::NAN, f64::NAN);
        };
        near.place = Some(triangle);
        let [a, b, c] = self.triangles[triangle as usize].map(|v| self.logs[v as usize]);
        (a * weights[0] + b * weights[1] + c * weights[2]).exp()
    }

    fn integral(&self, area: f64, bounds: Aabb, share: f64) -> Option<f64> {
        let corners = |t: usize| self.locator.corners(t as u32);
        let own = Aabb::of((0..self.triangles.len()).flat_map(corners))?;
        let longest = share * bounds.extent().x.max(bounds.extent().y);
        if bounds.min.distance(own.min).max(bounds.max.distance(own.max)) > longest {
            return None;
        }
        let of = |(t, triangle): (usize, &[u32; 3])| {
            let [a, b, c] = corners(t);
            let double_area = (b - a).cross(c - a).abs();
            let logs = triangle.map(|v| 0.5 * (self.logs[v as usize].xx + self.logs[v as usize].yy));
            [of_triangle(double_area, logs), 0.5 * double_area]
        };
        let parts = self.triangles.iter().enumerate().map(of);
        let [integral, all] = parts.fold([0.0; 2], |[integral, all], [own, part]| [integral + own, all + part]);
        ((area - all).abs() <= share * area).then(|| integral * (area / all))
    }

    fn excerpt(&self, domain: &Mesh) -> Option<(Mesh, Vec<Tensor>)> {
        if domain.triangles.is_empty() || !self.reaches(domain) {
            return None;
        }
        let mut near = vec![false; self.triangles.len()];
        let mut found = Vec::new();
        for &triangle in &domain.triangles {
            self.locator.near(domain.corners_of(triangle), &mut found);
            for &t in &found {
                near[t as usize] = true;
            }
        }
        for _ in 0..RINGS {
            let taken = self.triangles.iter().zip(&near).filter(|(_, near)| **near);
            let at = marked(self.logs.len(), taken.flat_map(|(triangle, _)| *triangle));
            for (triangle, near) in self.triangles.iter().zip(&mut near) {
                *near |= triangle.iter().any(|&v| at[v as usize]);
            }
        }
        let taken = || self.triangles.iter().zip(&near).filter(|(_, near)| **near).map(|(triangle, _)| *triangle);
        let used = distinct(taken().flatten());
        let number = |v: u32| used.partition_point(|&u| u < v) as u32;
        let positions = self.positions();
        let mesh = Mesh {
            points: used.iter().map(|&v| positions[v as usize]).collect(),
            triangles: taken().map(|triangle| triangle.map(number)).collect(),
            ..Mesh::default()
        };
        Some((mesh, used.iter().map(|&v| self.logs[v as usize].exp()).collect()))
    }
}

impl Sampled {
    /// Whether all vertices of a domain are in the mesh, or no farther from it than its triangles there are long.
    fn reaches(&self, domain: &Mesh) -> bool {
        let mut near = None;
        (0..domain.points.len() as u32).all(|v| {
            let Some(found) = self.locator.locate_from(near, domain.point(v)) else { return false };
            near = Some(found.triangle);
            let [a, b, c] = self.locator.corners(found.triangle);
            found.distance <= a.distance(b).max(b.distance(c)).max(c.distance(a))
        })
    }

    /// Where the vertices are that triangles have.
    fn positions(&self) -> Vec<[f64; 3]> {
        let mut positions = vec![[0.0; 3]; self.logs.len()];
        for (t, triangle) in (0..).zip(&self.triangles) {
            for (&v, p) in triangle.iter().zip(self.locator.corners(t)) {
                positions[v as usize] = [p.x, p.y, 0.0];
            }
        }
        positions
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;
    use proptest::prelude::*;

    /// The unit square as 2 n^2 triangles of mixed orientation, vertices moved a little.
    fn grid(n: u32) -> Mesh {
        let step = 1.0 / f64::from(n);
        let wobble =
            |i: u32, j: u32| 0.2 * step * f64::from(i * 7 + j * 13).sin() * f64::from(u8::from(i % n * (j % n) > 0));
        let position = |k: u32| {
            let (i, j) = (k % (n + 1), k / (n + 1));
            [f64::from(i) * step + wobble(i, j), f64::from(j) * step + wobble(j, i), 0.0]
        };
        let cell = |k: u32| {
            let a = k % n + k / n * (n + 1);
            [[a, a + 1, a + n + 2], [a, a + n + 1, a + n + 2]]
        };
        Mesh {
            points: (0..(n + 1) * (n + 1)).map(position).collect(),
            triangles: (0..n * n).flat_map(cell).collect(),
            ..Mesh::default()
        }
    }

    fn smooth(p: Point) -> Tensor {
        let angle = p.x + 2.0 * p.y;
        Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 100.0 * (1.0 + p.x), 1.0 + p.y)
    }

    fn sampled(mesh: &Mesh) -> Sampled {
        let tensors: Vec<Tensor> = (0..mesh.points.len() as u32).map(|v| smooth(mesh.point(v))).collect();
        Sampled::new(mesh, &tensors).unwrap()
    }

    fn error(a: Tensor, b: Tensor) -> f64 {
        ((a.xx - b.xx).abs() + (a.xy - b.xy).abs() + (a.yy - b.yy).abs()) / (b.xx + b.yy)
    }

    #[test]
    fn vertices_keep_their_tensors() {
        let mesh = grid(9);
        let field = sampled(&mesh);
        for v in 0..mesh.points.len() as u32 {
            let p = mesh.point(v);
            assert!(error(field.at(p), smooth(p)) < 1e-10, "{p}");
        }
    }

    #[test]
    fn interpolation_converges_with_second_order() {
        let worst = |n| {
            let field = sampled(&grid(n));
            let at = |i: u32| Point::new((f64::from(i) * 0.618).fract(), (f64::from(i) * 0.414).fract());
            (0..2000).map(|i| error(field.at(at(i)), smooth(at(i)))).fold(0.0, f64::max)
        };
        let (coarse, fine) = (worst(20), worst(40));
        assert!(fine < 0.33 * coarse && fine < 0.02, "{coarse} {fine}");
    }

    #[test]
    fn a_constant_tensor_is_reproduced_everywhere() {
        let mesh = grid(5);
        let m = Tensor::new(5.0, -2.0, 3.0);
        let field = Sampled::new(&mesh, &vec![m; mesh.points.len()]).unwrap();
        for p in [Point::new(0.3, 0.4), Point::new(0.0, 1.0), Point::new(-7.0, 3.0), Point::new(0.5, 1e9)] {
            assert!(error(field.at(p), m) < 1e-14, "{p}");
        }
    }

    #[test]
    fn outside_is_the_nearest_point_of_the_mesh() {
        let field = sampled(&grid(6));
        for (p, q) in [((-0.5, 0.3), (0.0, 0.3)), ((0.77, 1.4), (0.77, 1.0)), ((3.0, -2.0), (1.0, 0.0))] {
            let (outside, nearest) = (field.at(Point::new(p.0, p.1)), field.at(Point::new(q.0, q.1)));
            assert!(error(outside, nearest) < 1e-12, "{p:?}");
        }
    }

    proptest! {
        #[test]
        fn a_small_step_changes_little(x in -0.2..1.2, y in -0.2..1.2, angle in 0.0..6.3) {
            let field = sampled(&grid(8));
            let (p, step) = (Point::new(x, y), Vector::new(f64::cos(angle), f64::sin(angle)) * 1e-7);
            prop_assert!(error(field.at(p + step), field.at(p)) < 1e-5);
        }
    }

    #[test]
    fn where_it_was_found_last_changes_nothing() {
        let field = sampled(&grid(8));
        let mut near = Near::default();
        for i in 0..300 {
            let p = Point::new(1.3 * (f64::from(i) * 0.618).fract() - 0.1, 1.3 * (f64::from(i) * 0.414).fract() - 0.1);
            assert!(error(field.at_near(p, &mut near), field.at(p)) < 1e-14, "{p}");
        }
    }

    #[test]
    fn triangles_without_area_are_harmless() {
        let mut mesh = grid(3);
        mesh.triangles.extend([[0, 0, 0], [0, 1, 1], [0, 1, 2]]);
        let field = sampled(&mesh);
        assert!(field.at(Point::new(0.3, -0.2)).is_positive_definite());
        assert!(field.at(Point::new(f64::NAN, 0.0)).xx.is_nan());
    }

    #[test]
    fn thin_triangles_are_found_as_thick_ones() {
        // Turned by 45 degrees and a thousand times longer than wide.
        let turn = |[x, y, _]: [f64; 3]| [x + 1e-3 * y, x - 1e-3 * y, 0.0];
        let (thick, mut thin) = (grid(8), grid(8));
        thin.points.iter_mut().for_each(|p| *p = turn(*p));
        let tensors: Vec<Tensor> = (0..thick.points.len() as u32).map(|v| smooth(thick.point(v))).collect();
        let [thick, thin] = [thick, thin].map(|mesh| Sampled::new(&mesh, &tensors).unwrap());
        for i in 0..500 {
            let p = [(f64::from(i) * 0.618).fract(), (f64::from(i) * 0.414).fract(), 0.0];
            let [x, y, _] = turn(p);
            assert!(error(thin.at(Point::new(x, y)), thick.at(Point::new(p[0], p[1]))) < 1e-9, "{p:?}");
        }
    }

    #[test]
    fn sizes_interpolate_geometrically() {
        let mesh = Mesh {
            points: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let field = Sampled::sizes(&mesh, &[0.1, 10.0, 0.1]).unwrap();
        assert!(error(field.at(Point::new(0.5, 0.0)), Tensor::IDENTITY) < 1e-12);
    }

    /// Two triangles that fill a box.
    fn filled(low: [f64; 2], high: [f64; 2]) -> Mesh {
        let points =
            vec![[low[0], low[1], 0.0], [high[0], low[1], 0.0], [high[0], high[1], 0.0], [low[0], high[1], 0.0]];
        Mesh { points, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() }
    }

    #[test]
    fn an_excerpt_says_the_same_where_it_is_of() {
        let field = sampled(&grid(40));
        let (mesh, tensors) = field.excerpt(&filled([0.3, 0.6], [0.5, 0.7])).unwrap();
        assert!(mesh.triangles.len() < 600, "{} of 3,200", mesh.triangles.len());
        let part = Sampled::new(&mesh, &tensors).unwrap();
        for i in 0..500 {
            // A triangle farther out than its box.
            let p =
                Point::new(0.28 + 0.24 * (f64::from(i) * 0.618).fract(), 0.58 + 0.14 * (f64::from(i) * 0.414).fract());
            assert!(error(part.at(p), field.at(p)) < 1e-13, "{p}");
        }
    }

    #[test]
    fn there_is_no_excerpt_where_the_mesh_is_not() {
        let field = sampled(&grid(10));
        assert!(field.excerpt(&filled([0.9, 0.9], [1.05, 1.05])).is_some(), "a sliver outside");
        assert!(field.excerpt(&filled([0.9, 0.9], [2.0, 2.0])).is_none());
        assert!(field.excerpt(&Mesh::default()).is_none());
    }

    #[test]
    fn bad_input_is_named() {
        let mesh = grid(2);
        let mut tensors = vec![Tensor::IDENTITY; 9];
        let message = |result: Result<Sampled>| result.unwrap_err().to_string();
        assert_eq!(
            message(Sampled::new(&mesh, &tensors[1..])),
            "invalid metric: 8 tensors for 9 vertices at the background mesh"
        );
        assert!(message(Sampled::sizes(&mesh, &[1.0])).contains("1 sizes for 9 vertices"));
        tensors[2] = Tensor::new(1.0, 2.0, 1.0);
        assert_eq!(
            message(Sampled::new(&mesh, &tensors)),
            "invalid metric: the tensor m11 = 1, m12 = 2, m22 = 1 is not positive definite at vertex 3 (1, 0)"
        );
        let mut sizes = [1.0; 9];
        sizes[3] = -0.5;
        assert_eq!(
            message(Sampled::sizes(&mesh, &sizes)),
            "invalid metric: the size h = -0.5 is not positive and finite at vertex 4 (0, 0.5)"
        );
        sizes[3] = 1e-200;
        assert!(message(Sampled::sizes(&mesh, &sizes)).contains("m11 = inf"));
    }

    #[test]
    fn bad_backgrounds_are_named() {
        let message = |mesh: &Mesh| Sampled::sizes(mesh, &[1.0; 9]).unwrap_err().to_string();
        assert!(message(&Mesh { triangles: vec![], ..grid(2) }).contains("no triangles at the background mesh"));
        assert!(
            message(&Mesh { triangles: vec![[0, 1, 9]], ..grid(2) })
                .contains("triangle 1 refers to a vertex beyond the last, 9")
        );
        let mut mesh = grid(2);
        mesh.points[8][2] = 0.25;
        assert_eq!(
            message(&mesh),
            "invalid domain: z = 0.25 is not zero at vertex 9 (1, 1) of the background mesh of the metric"
        );
        mesh.points[8] = [f64::NAN, 1.0, 0.0];
        assert_eq!(
            message(&mesh),
            "invalid domain: a coordinate is not finite at vertex 9 (NaN, 1) of the background mesh of the metric"
        );
    }
}
