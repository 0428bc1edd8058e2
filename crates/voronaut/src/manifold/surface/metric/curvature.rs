//! The metric of principal curvatures, and these at the vertices of a mesh.

use super::{CurvatureFigures, Sampled, SurfaceMetric};
use crate::error::Result;
use crate::geometry::{Point3, TangentPlane, Tensor, Tensor3, Vector};
use crate::manifold::Place;
use crate::manifold::surface::{Curvatures, Implicit, Surface, curvatures};
use crate::metric::least_squares;
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;

/// The smallest curvature that counts, unless told otherwise, over the bounding box's diagonal: a radius of ten diagonals
/// is flat.
pub(crate) const FLOOR: f64 = 0.1;

/// The curvature metric of RR-9103, 15.1, of a surface f = 0, from exact derivatives of f at the place, which is on the
/// surface or near it (then of the level surface there); see [`Curvatures::metric`](crate::manifold::surface::Curvatures::metric).
/// Where grad f = 0 (a cone's apex) there are no curvatures: the value there is not finite.
#[derive(Clone, Debug)]
pub(crate) struct ImplicitCurvature<I> {
    /// f.
    pub f: I,
    /// Smaller curvatures count as this; positive, in units of 1 / length.
    pub floor: f64,
}

impl<I: Implicit> SurfaceMetric for ImplicitCurvature<I> {
    fn at(&self, place: &Place) -> Tensor3 {
        let found = curvatures(&self.f.jet(place.position));
        found.map_or(Tensor3::IDENTITY * f64::NAN, |c| c.metric([self.floor, f64::INFINITY]))
    }
}

/// The curvature metric of a mesh: from [`fit_curvatures`] at vertices, log-Euclidean between them.
///
/// It is a metric on every surface, bounded by what the triangles can tell: curvatures below `floor` count as that, and those above
/// 2 pi / l, l the mean length of the edges at the vertex, as that: no more than a full turn over an edge. (At a fold, a spike or a
/// needle a fit may say anything.) A vertex without a fit gets the mean of its neighbours'
/// logarithms; the floor, if these have none either.
///
/// # Errors
/// As [`Sampled::new`]: where `floor` is not positive and finite.
pub(crate) fn sampled_curvature(surface: &Surface, floor: f64) -> Result<Sampled> {
    let fitted = fit_curvatures(surface);
    let caps: Vec<f64> = (0..fitted.len() as u32).into_par_iter().map(|v| cap(surface, VertexId(v))).collect();
    let metric = |(c, cap): (&Option<Curvatures>, &f64)| c.map(|c| c.metric([floor, *cap]));
    let fits: Vec<Option<Tensor3>> = fitted.iter().zip(&caps).map(metric).collect();
    let t = surface.topology();
    let bent = || fitted.iter().zip(&caps).filter_map(|(c, cap)| Some((c.as_ref()?.values.map(f64::abs), *cap)));
    let figures = CurvatureFigures {
        floor,
        floored: bent().filter(|(values, _)| values[1] < floor).count(),
        capped: bent().filter(|(values, cap)| values[0] > cap.max(floor)).count(),
        unfitted: t.vertices().filter(|v| fitted[v.index()].is_none()).count(),
        greatest: bent().map(|(values, cap)| values[0].min(cap).max(floor)).fold(floor, f64::max),
    };
    Ok(Sampled::filled(surface, &fits, Tensor3::IDENTITY * floor)?.with_figures(figures))
}

/// The greatest curvature that edges at a vertex can tell; no number of a vertex without edges, which has no fit either.
fn cap(surface: &Surface, v: VertexId) -> f64 {
    let ends = surface.topology().around(v).map(|w| surface.position(w).distance(surface.position(v)));
    let (count, sum) = ends.fold((0.0, 0.0), |(count, sum), length| (count + 1.0, sum + length));
    std::f64::consts::TAU * count / sum
}

/// Principal curvatures at every vertex by fitting a polynomial of degree three over the tangent plane to the vertices of
/// its two rings of neighbours (Cazals and Pouget 2005, "jets"). Where vertices are on a smooth surface, curvatures are
/// right to the second order in the length of edges, however irregular the mesh: theirs is a proof, which averages of
/// normals (Rusinkiewicz 2004) do not have. Noise is not smoothed. With too few neighbours the degree is two, the order one.
///
/// One entry per vertex slot: `None` of vertices without triangles, or where those around have no common side or make no finite
/// fit (needles without height).
pub(crate) fn fit_curvatures(surface: &Surface) -> Vec<Option<Curvatures>> {
    let slots = surface.positions().len() as u32;
    (0..slots).into_par_iter().map(|v| fit(surface, VertexId(v))).collect()
}

/// Terms of a polynomial of degree three in two variables; those of degree two and less stand first.
const CUBIC: usize = 10;
const QUADRATIC: usize = 6;
/// A polynomial of degree three has so many neighbours to fit, at least.
const ENOUGH: usize = 14;
/// Two rings of six and twelve, the vertex itself, and room: few lists grow.
const FEW: usize = 32;

fn fit(surface: &Surface, v: VertexId) -> Option<Curvatures> {
    let normal = surface.vertex_normal(v)?;
    let plane = TangentPlane::new(normal);
    let origin = surface.position(v);
    let around = two_rings(surface, v, &plane);
    let size = around.iter().map(|&p| plane.flatten(p - origin).norm()).fold(0.0, f64::max);
    if size == 0.0 {
        return None;
    }
    let sample = |p: Point3| (plane.flatten(p - origin) * (1.0 / size), (p - origin).dot(normal) / size);
    let samples: Vec<(Vector, f64)> = around.into_iter().chain([origin]).map(sample).collect();
    let [_, x, y, xx, xy, yy] =
        if samples.len() > ENOUGH { polynomial::<CUBIC>(&samples) } else { polynomial::<QUADRATIC>(&samples) };
    let found = of_graph(&plane, [x, y], Tensor::new(2.0 * xx, xy, 2.0 * yy) * (1.0 / size));
    found.values.iter().all(|value| value.is_finite()).then_some(found)
}

/// The first coefficients of a polynomial of so many terms that fits heights over a plane.
fn polynomial<const TERMS: usize>(samples: &[(Vector, f64)]) -> [f64; QUADRATIC] {
    let terms = |p: Vector| -> [f64; TERMS] {
        let all = monomials(p.x, p.y);
        std::array::from_fn(|k| all[k])
    };
    let mut rows: Vec<[f64; TERMS]> = samples.iter().map(|sample| terms(sample.0)).collect();
    let mut heights: Vec<f64> = samples.iter().map(|sample| sample.1).collect();
    let found = least_squares(&mut rows, &mut heights).coefficients;
    std::array::from_fn(|k| found[k])
}

/// Neighbours and their neighbours, without those on triangles that face away: they are of another sheet.
fn two_rings(surface: &Surface, v: VertexId, plane: &TangentPlane) -> Vec<Point3> {
    let t = surface.topology();
    // Lists that grow in one thread wait for another one's memory.
    let mut found = Vec::with_capacity(FEW);
    found.push(v);
    let mut ring = 0..1;
    for _ in 0..2 {
        let next = found.len();
        for i in ring {
            let spokes = t.star(found[i]).filter(|&h| surface.normal(h.face()).dot(plane.normal) > 0.0);
            for h in spokes {
                // Both ends of the far side: at the border one of them has no spoke of its own.
                for w in [t.target(h), t.apex(h)] {
                    if !found.contains(&w) {
                        found.push(w);
                    }
                }
            }
        }
        ring = next..found.len();
    }
    found[1..].iter().map(|&w| surface.position(w)).collect()
}

fn monomials(x: f64, y: f64) -> [f64; CUBIC] {
    [1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y]
}

/// From the gradient and the Hessian of a height over a plane to curvatures: the shape operator in the graph's own tangent
/// plane. Heights grow along the normal, so that a sphere's Hessian is negative and its curvatures positive.
fn of_graph(plane: &TangentPlane, [x, y]: [f64; 2], hessian: Tensor) -> Curvatures {
    let slant = (1.0 + x * x + y * y).sqrt();
    let normal = (plane.normal + plane.u * -x + plane.v * -y) * (1.0 / slant);
    let own = TangentPlane::new(normal);
    // A tangent of the graph with plane coordinates d bends by d' H d / slant.
    let [a, b] = [own.u, own.v].map(|axis| plane.flatten(axis));
    let bend = |d, e| -hessian.dot(d, e) / slant;
    Curvatures::of(Tensor::new(bend(a, a), bend(a, b), bend(b, b)), &own)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::TangentPlane;
    use crate::manifold::surface::{sphere, torus};
    use crate::mesh::Mesh;
    use crate::metric::{Expression, Variables};

    #[test]
    fn meshes_and_equations_agree() {
        let f = Expression::parse("(sqrt(x^2+y^2)-2)^2+z^2-0.49", Variables::Space).unwrap();
        let exact = ImplicitCurvature { f, floor: 0.05 };
        let error = |edge: f64| {
            let surface = torus(2.0, 0.7, edge).unwrap();
            let fitted = sampled_curvature(&surface, 0.05).unwrap();
            let difference = |v| {
                let place = surface.place_of(v)?;
                let plane = TangentPlane::new(surface.vertex_normal(v)?);
                let [a, b] = [exact.at(&place), fitted.at(&place)].map(|m| plane.restrict(m));
                Some((a.xx - b.xx).abs().max((a.xy - b.xy).abs()).max((a.yy - b.yy).abs()))
            };
            surface.topology().vertices().filter_map(difference).fold(0.0, f64::max)
        };
        let errors = [0.2, 0.1, 0.05].map(error);
        println!("curvature metric of a torus, fitted, largest errors: {errors:?}");
        assert!(errors[1] < 0.5 * errors[0] && errors[2] < 0.5 * errors[1] && errors[2] < 0.05, "{errors:?}");
    }

    #[test]
    fn an_apex_has_no_metric() {
        let f = Expression::parse("x^2+y^2-z^2", Variables::Space).unwrap();
        let surface = torus(2.0, 0.7, 1.0).unwrap();
        let place = Place {
            position: crate::geometry::Point3::default(),
            ..surface.place(crate::triangulation::FaceId(0), [1.0, 0.0, 0.0])
        };
        assert!(!ImplicitCurvature { f, floor: 0.1 }.at(&place).is_positive_definite());
    }

    /// The largest errors of both curvatures at all vertices, against the truth at a point.
    fn error(surface: &Surface, truth: impl Fn(Point3) -> [f64; 2]) -> f64 {
        let fitted = fit_curvatures(surface);
        let of_vertex = |v: VertexId| {
            let truth = truth(surface.position(v));
            let values = fitted[v.index()].expect("curvatures").values;
            (values[0] - truth[0]).abs().max((values[1] - truth[1]).abs())
        };
        surface.topology().vertices().map(of_vertex).fold(0.0, f64::max)
    }

    /// The surface with every vertex moved along by up to a quarter of an edge, and pushed back by `onto`.
    fn shaken(surface: &Surface, edge: f64, onto: impl Fn(Point3) -> Point3) -> Surface {
        let mut mesh = surface.to_mesh();
        for (i, p) in mesh.points.iter_mut().enumerate() {
            let i = i as f64;
            let shift = [1.3, 2.9, 4.7].map(|k| 0.15 * edge * (k * 12.9898 * i).sin());
            *p = onto(Point3::new(p[0] + shift[0], p[1] + shift[1], p[2] + shift[2])).to_array();
        }
        Surface::new(&mesh).unwrap()
    }

    fn orders(errors: &[f64]) -> Vec<f64> {
        errors.windows(2).map(|pair| (pair[0] / pair[1]).log2()).collect()
    }

    fn on_torus(p: Point3) -> Point3 {
        let ring = Point3::new(2.0 * p.x / p.x.hypot(p.y), 2.0 * p.y / p.x.hypot(p.y), 0.0);
        ring + (p - ring) * (0.7 / (p - ring).norm())
    }

    #[test]
    fn spheres_have_the_curvature_of_their_radius() {
        let edges = [0.8, 0.4, 0.2];
        let errors = edges.map(|edge| {
            let round = |p: Point3| Point3::default() + (p - Point3::default()).unit().unwrap() * 2.0;
            error(&shaken(&sphere(2.0, edge).unwrap(), edge, round), |_| [0.5, 0.5])
        });
        println!("sphere, shaken: errors {errors:?}, orders {:?}", orders(&errors));
        assert!(orders(&errors).iter().all(|&order| order > 1.6), "{errors:?}");
    }

    #[test]
    fn tori_have_the_curvatures_of_both_radii() {
        let truth = |p: Point3| {
            let r = p.x.hypot(p.y);
            let mut values = [1.0 / 0.7, (r - 2.0) / 0.7 / r];
            values.sort_by(|a, b| b.abs().total_cmp(&a.abs()));
            values
        };
        let edges = [0.2, 0.1, 0.05];
        let even = edges.map(|edge| error(&torus(2.0, 0.7, edge).unwrap(), truth));
        let errors = edges.map(|edge| error(&shaken(&torus(2.0, 0.7, edge).unwrap(), edge, on_torus), truth));
        println!("torus: errors {even:?}, orders {:?}", orders(&even));
        println!("torus, shaken: errors {errors:?}, orders {:?}", orders(&errors));
        assert!(orders(&even).iter().chain(&orders(&errors)).all(|&order| order > 1.6), "{even:?} {errors:?}");
    }

    #[test]
    fn few_neighbours_are_enough_for_something_finite() {
        let points = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        let tetrahedron = Surface::new(&Mesh { points: points.clone(), triangles, ..Mesh::default() }).unwrap();
        let triangle = Surface::new(&Mesh { points, triangles: vec![[0, 1, 2]], ..Mesh::default() }).unwrap();
        for c in fit_curvatures(&tetrahedron).iter().flatten().chain(fit_curvatures(&triangle).iter().flatten()) {
            assert!(c.values.iter().all(|value| value.is_finite() && value.abs() < 100.0), "{c:?}");
        }
        assert!(fit_curvatures(&triangle)[3].is_none());
        let flat = fit_curvatures(&triangle)[0].unwrap();
        assert!(flat.values.iter().all(|value| value.abs() < 1e-9), "{flat:?}");
    }
}
