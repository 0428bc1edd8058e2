//! The sizes that keep a mesh close to its surface, and to the curves on it: borders, and edges that are fixed.

use super::{Sizes, fit_curvatures, grade, grade_tensors};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::{TangentPlane, Tensor, Tensor3, Vector3};
use crate::manifold::surface::{Curvatures, Surface};
use crate::mesh::Solution;
use crate::metric::{Bounds, require};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

/// c in h = sqrt(c hausd / curvature), the size that keeps unit meshes within `hausd` of a surface. An edge of length h alone is
/// an eighth of h^2 times the curvature away, an equilateral triangle a sixth; but edges of unit meshes are up to a third longer.
/// Measured on a sphere and a torus, vertices on them: mesh and surface are 0.9 `hausd` apart with c = 4, and 0.74 and 0.69 with 3,
/// which leaves room for what curvatures at vertices do not tell. With 2.5
/// distances come out below mmgs's for the same `hausd` (`scripts/compare_mmgs.py`), which are about 0.65 of what is asked for.
pub(crate) const SAGITTA: f64 = 2.5;

/// c in h = c hausd / turn, the size for an edge between facets that are wider: one of length h across its middle, with its ends on
/// both, is h turn / 4 away.
const KINK: f64 = 4.0;

/// What sizes are to be made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizing {
    /// How far (Euclidean) a mesh with these sizes may be from the surface; positive.
    pub hausd: f64,
    /// No size is less; positive.
    pub h_min: f64,
    /// No size is more, and flat parts have this one.
    pub h_max: f64,
    /// Between neighbouring edges sizes grow by this factor at most, by the law of [`grade`](crate::metric::nodal::grade);
    /// `None`: as they will. Of tensors in the tangent planes.
    pub hgrad: Option<f64>,
    /// Whether sizes follow the principal directions.
    pub anisotropic: bool,
}

impl Sizing {
    /// The sizes of a surface: sqrt(`SAGITTA` hausd / c) of the larger principal curvature c, and of that of borders and fixed
    /// edges, and 4 hausd / t at edges between facets wider than that, whose normals differ by an angle t; anisotropic, of both curvatures along their
    /// directions alone. Given sizes or tensors, one per vertex slot, are kept where they are
    /// less (of tensors the intersection, then anisotropic). Limits come next, gradation last.
    ///
    /// A surface may be cut along its features: what is said is of each side's own.
    ///
    /// # Errors
    /// [`Error::Parse`](crate::Error::Parse) that names a parameter out of range; [`Error::Metric`](crate::Error::Metric) where what is given is not one metric, or size, for each vertex.
    pub fn sizes(&self, surface: &Surface, given: Option<&Solution>) -> Result<Sizes> {
        self.check()?;
        let given = given.map(Sizes::of).transpose()?;
        // Whether it is a metric.
        given.as_ref().map(|given| given.field(surface)).transpose()?;
        let curvatures = fit_curvatures(surface);
        let asked = |v: usize| given.as_ref().map(|given| given.tensor(v));
        let is_tensor = matches!(given, Some(Sizes::Anisotropic(_)));
        let slots = (0..curvatures.len()).into_par_iter();
        if self.anisotropic || is_tensor {
            let tensor = |v: usize| self.tensor(surface, v, curvatures[v].as_ref(), asked(v));
            let mut tensors: Vec<Tensor3> = slots.map(tensor).collect();
            if let Some(hgrad) = self.hgrad {
                grade_tensors(surface, &mut tensors, hgrad, &self.limits().into())?;
            }
            return Ok(Sizes::Anisotropic(tensors));
        }
        let mut sizes: Vec<f64> = slots.map(|v| self.size(surface, v, curvatures[v].as_ref(), asked(v))).collect();
        if let Some(hgrad) = self.hgrad {
            grade(surface, &mut sizes, hgrad)?;
        }
        Ok(Sizes::Isotropic(sizes))
    }

    /// Whether the parameters make sense.
    ///
    /// # Errors
    /// [`Error::Parse`](crate::Error::Parse) that names one that does not.
    pub(crate) fn check(&self) -> Result<()> {
        self.limits().check()?;
        let is_distance = self.hausd > 0.0 && self.hausd.is_finite();
        require(is_distance, "sizes", "hausd", self.hausd, "positive and finite: a distance")?;
        let hgrad = self.hgrad.unwrap_or(1.0);
        let needed = "at least 1 and finite: the factor by which sizes grow from edge to edge";
        require(hgrad >= 1.0 && hgrad.is_finite(), "sizes", "hgrad", hgrad, needed)
    }

    fn limits(&self) -> Bounds {
        Bounds { h_min: Some(self.h_min), h_max: Some(self.h_max), a_max: None }
    }

    /// The size for a curvature.
    fn of_curvature(&self, curvature: f64) -> f64 {
        let size = (SAGITTA * self.hausd / curvature.abs()).sqrt();
        if size.is_nan() { self.h_max } else { size.clamp(self.h_min, self.h_max) }
    }

    fn size(&self, surface: &Surface, v: usize, curvatures: Option<&Curvatures>, asked: Option<Tensor3>) -> f64 {
        let of_surface = curvatures.map(|c| self.of_curvature(c.values[0]));
        let of_curve = bend(surface, VertexId(v as u32)).map(|bend| self.of_curvature(bend.curvature));
        let asked = asked.map(|tensor| 1.0 / tensor.xx.sqrt());
        let of_kinks = kinks(surface, VertexId(v as u32)).map(|(turn, width)| (KINK * self.hausd / turn, width));
        let of_kinks = of_kinks.filter(|(size, width)| size < width).map(|(size, _)| size);
        let sizes = [of_surface, of_curve, asked].into_iter().flatten().chain(of_kinks);
        sizes.fold(self.h_max, f64::min).max(self.h_min)
    }

    fn tensor(&self, surface: &Surface, v: usize, curvatures: Option<&Curvatures>, asked: Option<Tensor3>) -> Tensor3 {
        let Some(c) = curvatures else { return Tensor3::isotropic(self.h_max) };
        let plane = TangentPlane::new(c.normal);
        let eigenvalue = |size: f64| 1.0 / (size * size);
        let [along, across] = c.values.map(|c| eigenvalue(self.of_curvature(c)));
        let of_surface = Tensor::from_axis(plane.flatten(c.axes[0]), along, across);
        let of_curve = bend(surface, VertexId(v as u32)).map(|bend| {
            let tangent = plane.flatten(bend.tangent);
            let along = eigenvalue(self.of_curvature(bend.curvature));
            // A tangent that leaves the plane is seen from aside, and asks for less.
            Tensor::from_axis(tangent, along, eigenvalue(self.h_max))
        });
        let asked = asked.map(|tensor| plane.restrict(tensor));
        let all = [of_curve, asked].into_iter().flatten().fold(of_surface, Tensor::intersection);
        let tensor = self.limits().clamp(all);
        plane.extend(tensor, tensor.eigen().large)
    }
}

/// The angles by which the normal turns over edges at a vertex that are not features, each with the lesser height of the two facets there.
fn kinks(surface: &Surface, v: VertexId) -> impl Iterator<Item = (f64, f64)> {
    let t = surface.topology();
    t.star(v).filter(|&h| !t.is_fixed(h)).filter_map(move |h| {
        let faces = [h, t.twin(h)?].map(|side| surface.triangle(side.face()));
        let double = faces.map(|[a, b, c]| (b - a).cross(c - a));
        let turn = double[0].cross(double[1]).norm().arctangent_over(double[0].dot(double[1]));
        let [from, to] = t.ends(h).map(|end| surface.position(end));
        Some((turn, double[0].norm().min(double[1].norm()) / from.distance(to)))
    })
}

/// How a curve bends at a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bend {
    /// Its curvature, in 1 / length.
    pub(super) curvature: f64,
    /// Unit tangent.
    pub(super) tangent: Vector3,
}

/// Turns by more than this, in degrees, are corners, which ask for nothing: they are kept as they are.
const CORNER: f64 = 45.0;

/// How the curve bends on which a vertex lies: that of the border and of fixed edges. The circle through the vertex and its
/// neighbours on the curve has the curvature 2 sin(turn) / |chord| (Menger 1930), exact where all are on a circle. `None` off
/// curves, where other than two of their edges meet, and at corners.
pub(super) fn bend(surface: &Surface, v: VertexId) -> Option<Bend> {
    let ends: Vec<VertexId> = surface.topology().along_fixed(v).collect();
    let &[before, after] = ends.as_slice() else { return None };
    let at = surface.position(v);
    let [u, w] = [at - surface.position(before), surface.position(after) - at];
    let turn = u.cross(w).norm().arctangent_over(u.dot(w));
    let chord = u + w;
    let tangent = chord.unit().filter(|_| turn.to_degrees() <= CORNER)?;
    Some(Bend { curvature: 2.0 * turn.sine() / chord.norm(), tangent })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point3, Vector3};
    use crate::manifold::surface::{sphere, torus};
    use crate::mesh::{Mesh, SolutionValues};
    use std::f64::consts::TAU;

    const LOOSE: Sizing = Sizing { hausd: 0.01, h_min: 1e-3, h_max: 100.0, hgrad: None, anisotropic: false };

    fn isotropic(sizing: &Sizing, surface: &Surface) -> Vec<f64> {
        match sizing.sizes(surface, None).unwrap() {
            Sizes::Isotropic(sizes) => sizes,
            Sizes::Anisotropic(_) => panic!("isotropic sizes were asked for"),
        }
    }

    fn anisotropic(sizing: Sizing, surface: &Surface, given: Option<&Solution>) -> Vec<Tensor3> {
        match (Sizing { anisotropic: given.is_none(), ..sizing }).sizes(surface, given).unwrap() {
            Sizes::Anisotropic(tensors) => tensors,
            Sizes::Isotropic(_) => panic!("tensors were asked for"),
        }
    }

    /// An open tube of this radius around the z axis.
    fn tube(radius: f64, height: f64, around: u32, rings: u32) -> Surface {
        let at = |i: u32, j: u32| {
            let angle = TAU * (f64::from(i) + 0.5 * f64::from(j % 2)) / f64::from(around);
            [radius * angle.cos(), radius * angle.sin(), height * f64::from(j) / f64::from(rings)]
        };
        let points = (0..=rings).flat_map(|j| (0..around).map(move |i| at(i, j))).collect();
        let number = |i: u32, j: u32| i % around + j * around;
        let triangles = (0..rings).flat_map(|j| {
            (0..around).flat_map(move |i| {
                let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
                if j % 2 == 0 { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] }
            })
        });
        Surface::new(&Mesh { points, triangles: triangles.collect(), ..Mesh::default() }).unwrap()
    }

    /// Curvatures at vertices know nothing of kinks between facets that are wider than edges.
    #[test]
    fn kinks_between_wide_facets_ask_for_sizes_by_their_angle() {
        let tube = tube(1.0, 2.0, 12, 4);
        let fine = Sizing { hausd: 1e-3, h_min: 1e-6, ..LOOSE };
        let widest = (0..tube.positions().len() as u32).flat_map(|v| kinks(&tube, VertexId(v)));
        let widest = widest.map(|(turn, _)| turn).fold(0.0, f64::max);
        let sizes = isotropic(&fine, &tube);
        assert!(sizes.iter().all(|&h| h >= KINK * 1e-3 / widest && h < 0.03), "{widest} {sizes:?}");
        // Where facets are narrower, curvatures are right.
        let coarse = isotropic(&Sizing { hausd: 0.1, ..fine }, &tube);
        assert!(coarse.iter().all(|&h| h > KINK * 0.1 / widest / 4.0), "{coarse:?}");
        assert!(coarse.iter().all(|&h| h > 0.3), "{coarse:?}");
    }

    /// The sizes that a tensor asks for along two unit tangents.
    fn along(tensor: Tensor3, tangents: [Vector3; 2]) -> [f64; 2] {
        tangents.map(|t| 1.0 / tensor.length(t))
    }

    /// Fitted curvatures are right to the second order in edge / radius, and so are sizes.
    fn is_near(found: f64, expected: f64, edge_over_radius: f64) -> bool {
        (found / expected - 1.0).abs() <= edge_over_radius * edge_over_radius
    }

    #[test]
    fn spheres_and_tubes_have_the_size_of_their_radius() {
        let expected = |radius: f64| (SAGITTA * 0.01 * radius).sqrt();
        for h in isotropic(&LOOSE, &sphere(2.0, 0.2).unwrap()) {
            assert!(is_near(h, expected(2.0), 0.1), "{h}");
        }
        // On its rims too, where curvatures are seen from one side, and which bend as it does.
        let surface = tube(0.5, 2.0, 48, 30);
        for h in isotropic(&LOOSE, &surface) {
            assert!(is_near(h, expected(0.5), TAU / 48.0), "{h}");
        }
        for (v, tensor) in anisotropic(LOOSE, &surface, None).into_iter().enumerate() {
            let p = surface.position(VertexId(v as u32));
            let [round, up] = along(tensor, [Vector3::new(-p.y, p.x, 0.0) * 2.0, Vector3::new(0.0, 0.0, 1.0)]);
            // Where nothing bends, an error of second order is all there is: of 2 (edge / radius)^2 in the curvature.
            let straight = (SAGITTA * 0.01 / 2.0).sqrt() / (TAU / 48.0);
            assert!(is_near(round, expected(0.5), TAU / 48.0) && up > straight, "{round} {up}");
        }
    }

    #[test]
    fn tori_have_sizes_along_both_circles() {
        let surface = torus(2.0, 0.7, 0.05).unwrap();
        for (v, tensor) in anisotropic(LOOSE, &surface, None).into_iter().enumerate() {
            let p = surface.position(VertexId(v as u32));
            let r = p.x.hypot(p.y);
            let ring = Vector3::new(-p.y, p.x, 0.0) * (1.0 / r);
            let out = p - Point3::new(2.0 * p.x / r, 2.0 * p.y / r, 0.0);
            let [long, short] = along(tensor, [ring, ring.cross(out) * (1.0 / 0.7)]);
            let expected = |curvature: f64| (SAGITTA * 0.01 / curvature.abs()).sqrt();
            assert!((short / expected(1.0 / 0.7) - 1.0).abs() < 0.01, "{short}");
            let truth = (r - 2.0) / 0.7 / r;
            assert!(truth.abs() < 0.1 || (long / expected(truth) - 1.0).abs() < 0.05, "{long} at {truth}");
        }
    }

    #[test]
    fn limits_and_given_sizes_are_kept() {
        let surface = sphere(1.0, 0.2).unwrap();
        let natural = (SAGITTA * 0.01_f64).sqrt();
        let check = |sizing: Sizing, given: Option<f64>, expected: f64, edge_over_radius: f64| {
            let values = |h: f64| SolutionValues::Scalar(vec![h; surface.positions().len()]);
            let given = given.map(|h| Solution { dimension: 3, values: values(h) });
            let Sizes::Isotropic(sizes) = sizing.sizes(&surface, given.as_ref()).unwrap() else { panic!("isotropic") };
            assert!(sizes.iter().all(|&h| is_near(h, expected, edge_over_radius)), "{} not {expected}", sizes[0]);
        };
        check(Sizing { h_max: 0.1, ..LOOSE }, None, 0.1, 1e-6);
        check(Sizing { h_min: 0.5, ..LOOSE }, None, 0.5, 1e-6);
        check(LOOSE, Some(5.0), natural, 0.2);
        check(LOOSE, Some(0.05), 0.05, 1e-6);
        check(Sizing { h_min: 0.1, ..LOOSE }, Some(0.05), 0.1, 1e-6);
        let thin = [400.0, 0.0, 1.0, 0.0, 0.0, 1.0];
        let values = SolutionValues::Tensor3(vec![thin; surface.positions().len()]);
        let tensors = anisotropic(LOOSE, &surface, Some(&Solution { dimension: 3, values }));
        for (curvatures, tensor) in fit_curvatures(&surface).into_iter().zip(tensors) {
            let plane = TangentPlane::new(curvatures.unwrap().normal);
            let x = plane.flatten(Vector3::new(1.0, 0.0, 0.0));
            let found = plane.restrict(tensor);
            // Both are in it: the sphere's own size, to the second order, and 1 / 20 along x.
            let wide = 1.0 / found.eigen().small.sqrt();
            assert!(wide < 1.04 * natural && found.length(x) > 20.0 * x.dot(x) - 1e-9, "{found:?}");
        }
    }

    #[test]
    fn small_sizes_are_approached_slowly() {
        let surface = torus(2.0, 0.7, 0.2).unwrap();
        let sizing = Sizing { hgrad: Some(1.3), ..LOOSE };
        let values = surface.positions().iter().map(|p| if p.x > 2.5 { 0.01 } else { 1.0 }).collect();
        let given = Solution { dimension: 3, values: SolutionValues::Scalar(values) };
        let Sizes::Isotropic(sizes) = sizing.sizes(&surface, Some(&given)).unwrap() else { panic!("isotropic") };
        let t = surface.topology();
        for h in t.edges() {
            let [v, w] = [t.origin(h), t.target(h)];
            let most = 1.3_f64.ln() * surface.position(v).distance(surface.position(w));
            assert!((sizes[v.index()] - sizes[w.index()]).abs() <= most * (1.0 + 1e-6));
        }
        assert!(sizes.iter().any(|&h| h > 0.1));
    }

    /// Where the torus bends less it is coarse beside what was asked for on one side; graded, no edge asks for more than what its ends have
    /// grown to.
    #[test]
    fn tensors_are_graded_too() {
        let surface = torus(2.0, 0.7, 0.12).unwrap();
        let thin = |p: &Point3| {
            if p.x > 2.0 { [2.5e3, 0.0, 2.5e3, 0.0, 0.0, 2.5e3] } else { [1e-4, 0.0, 1e-4, 0.0, 0.0, 1e-4] }
        };
        let values = SolutionValues::Tensor3(surface.positions().iter().map(thin).collect());
        let given = Solution { dimension: 3, values };
        let tensors = |hgrad| anisotropic(Sizing { hausd: 0.1, hgrad, ..LOOSE }, &surface, Some(&given));
        let (plain, graded) = (tensors(None), tensors(Some(1.2)));
        let ratio = |tensors: &[Tensor3]| {
            let sizes = |v: VertexId, w: VertexId| {
                let way = surface.position(w) - surface.position(v);
                [v, w].map(|v| way.norm() / tensors[v.index()].length(way))
            };
            let edges = surface.topology().edges().map(|h| surface.topology().ends(h));
            let change = |[v, w]: [VertexId; 2]| {
                let [h, k] = sizes(v, w);
                (h - k).abs() / surface.position(v).distance(surface.position(w))
            };
            edges.map(change).fold(0.0, f64::max)
        };
        // Sizes grow by ln(1.2) per length, but for the law's mixed space, turning planes and what is settled.
        let [before, after] = [&plain, &graded].map(|tensors| ratio(tensors));
        assert!(before > 2.0 && after < 2.0 * 1.2_f64.ln(), "{before} {after}");
        for (v, (before, after)) in plain.iter().zip(&graded).enumerate() {
            let plane = TangentPlane::new(surface.vertex_normal(VertexId(v as u32)).unwrap());
            let [before, after] = [before, after].map(|m| plane.restrict(*m).determinant());
            assert!(after > 0.9 * before, "no coarser: {before} {after}");
        }
    }

    #[test]
    fn what_is_out_of_range_is_named() {
        let surface = sphere(1.0, 1.0).unwrap();
        for (sizing, expected) in [
            (Sizing { hausd: 0.0, ..LOOSE }, "hausd = 0"),
            (Sizing { hausd: f64::NAN, ..LOOSE }, "hausd = NaN"),
            (Sizing { h_min: 0.0, ..LOOSE }, "h_min = 0"),
            (Sizing { h_min: 200.0, ..LOOSE }, "h_min = 200 is larger than h_max = 100"),
            (Sizing { hgrad: Some(0.9), ..LOOSE }, "hgrad = 0.9"),
        ] {
            let error = sizing.sizes(&surface, None).unwrap_err();
            assert!(error.to_string().contains(expected) && !error.help().is_empty(), "{error}");
        }
        let given = Solution { dimension: 3, values: SolutionValues::Scalar(vec![1.0]) };
        let error = LOOSE.sizes(&surface, Some(&given)).unwrap_err().to_string();
        assert!(error.contains("1 values for"), "{error}");
    }

    /// A fan of triangles around the origin: its rim a circle of this radius with vertices at uneven angles.
    fn plate(radius: f64, count: u32) -> Surface {
        let angle = |i: u32| TAU * (f64::from(i) + 0.3 * f64::from(i).sin()) / f64::from(count);
        let rim = (0..count).map(|i| [radius * angle(i).cos(), radius * angle(i).sin(), 1.0]);
        let points = [[0.0, 0.0, 1.0]].into_iter().chain(rim).collect();
        let triangles = (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count]).collect();
        Surface::new(&Mesh { points, triangles, ..Mesh::default() }).unwrap()
    }

    #[test]
    fn circles_have_the_curvature_of_their_radius() {
        let surface = plate(3.0, 24);
        assert_eq!(bend(&surface, VertexId(0)), None, "off the border");
        for v in (1..25).map(VertexId) {
            let found = bend(&surface, v).unwrap();
            assert!((found.curvature * 3.0 - 1.0).abs() < 1e-12, "{found:?}");
            assert!(found.tangent.dot(surface.position(v) - crate::geometry::Point3::new(0.0, 0.0, 1.0)).abs() < 0.3);
        }
    }

    #[test]
    fn corners_and_forks_do_not_bend() {
        let square = plate(1.0, 5);
        assert!((1..6).all(|v| bend(&square, VertexId(v)).is_none()), "turns of 72 degrees, about");
        let fork = Mesh { edges: vec![[0, 1], [0, 9], [0, 17]], ..plate(1.0, 24).to_mesh() };
        let surface = Surface::new(&fork).unwrap();
        assert!([0, 1, 9, 17].into_iter().all(|v| bend(&surface, VertexId(v)).is_none()));
        let line = Mesh { edges: vec![[0, 1], [0, 13]], ..plate(1.0, 24).to_mesh() };
        let found = bend(&Surface::new(&line).unwrap(), VertexId(0)).unwrap();
        assert!(found.curvature < 0.3, "nearly straight through the middle: {found:?}");
    }
}
