//! How far the mesh of a surface strays from it: in distance, and in direction.

use super::faults::Position;
use super::planar_quality::{Spot, demand_vertices, fault, spot};
use super::sampled_distance::{Sample, Sampled, sample};
use crate::curved::{Place, Rule, points_in_space};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geometry::{Point3, Vector3};
use crate::lists::distinct;
use crate::manifold::Manifold;
use crate::manifold::surface::{Nearest, closest_zero};
use crate::mesh::Mesh;
use crate::parallel::prelude::*;
use crate::triangulation::FaceId;

/// Euclidean distances between a mesh and a surface, and angles between their normals.
///
/// A surface with an equation is f = 0 itself: its triangles only tell where to look, and every sample is projected.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct SurfaceFidelity {
    /// Both sides together: the greater Hausdorff distance, and the root of the mean of the squared distances over both areas.
    #[serde(flatten)]
    pub both: Deviation,
    /// From points of the mesh to the surface.
    pub mesh_to_surface: Deviation,
    /// From points of the surface to the mesh.
    pub surface_to_mesh: Deviation,
    /// Of triangles of order 2 and 3: from points of these to the surface, at 28 places of each. All else is of straight ones between their corners.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curved: Option<Deviation>,
    /// The greatest distance of a vertex in use to the surface; with an equation, |f| / |grad f|.
    pub vertex_to_surface: Spot,
    /// Angles between the normals of triangles and of the surface.
    pub normal_deviation: NormalDeviation,
    /// Triangles folded over: their normal deviates by more than 90 degrees.
    pub folded: usize,
    /// Whether the mesh as a whole is turned the other way than the surface; then its normals were reversed first.
    pub reversed: bool,
    /// The diagonal of the surface's bounding box, of which shares are taken.
    pub diagonal: f64,
}

/// Distances from samples: corners, points of edges and points inside triangles, denser where the greatest distance may be.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Deviation {
    /// The greatest distance: a lower bound of the Hausdorff distance, less than 1 % below it where distances are smooth
    /// between the first samples, about a quarter of an edge apart.
    pub hausdorff: f64,
    /// The same as a share of the diagonal.
    pub hausdorff_share: f64,
    /// The root mean square distance, weighted by area.
    pub rms: f64,
    /// The same as a share of the diagonal.
    pub rms_share: f64,
    /// The point that is so far away.
    pub at: Position,
}

/// Degrees between the normal of a triangle and that of the surface at the place closest to its centroid: the gradient, where
/// there is an equation, else the normal of the triangle there.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct NormalDeviation {
    /// The mean, weighted by area.
    pub mean: f64,
    /// The greatest, and the centroid of its triangle.
    pub max: Spot,
}

/// Compares the mesh of a surface with that surface, in parallel; the same bits for any number of threads.
///
/// # Errors
/// [`Error::Mesh`](crate::Error::Mesh) of a mesh without triangles, with vertices that do not exist, or with positions that are
/// not finite.
pub fn surface_fidelity(mesh: &Mesh, surface: &Manifold) -> Result<SurfaceFidelity> {
    demand_vertices(mesh)?;
    let triangles: Vec<[Point3; 3]> = mesh.triangles.iter().map(|&t| mesh.positions_of(t)).collect();
    if let Some(p) = triangles.as_flattened().iter().find(|p| !p.is_finite()) {
        return Err(fault("a position is not finite", &p.to_string()));
    }
    let target = Target { surface };
    surface.prepare();
    let floor = NOTHING * target.diagonal();
    let there = sample(&triangles, floor, |at| Sample { at, distance: target.closest(at).position.distance(at) });
    let tree = Nearest::of(triangles.iter().copied());
    let back = |p: Point3| {
        let at = target.lift(p);
        Sample { at, distance: tree.distance(at).unwrap_or(f64::NAN) }
    };
    let back = sample(&surface.topology().faces().map(|f| surface.triangle(f)).collect::<Vec<_>>(), floor, back);
    let (Some(there), Some(back)) = (there, back) else {
        return Err(fault("there are no triangles", "the array of triangles"));
    };
    let normals = Normals::of(&triangles, &target);
    Ok(SurfaceFidelity {
        both: Deviation::of(&together(there, back), target.diagonal()),
        mesh_to_surface: Deviation::of(&there, target.diagonal()),
        surface_to_mesh: Deviation::of(&back, target.diagonal()),
        curved: of_curved(mesh, &target).map(|found| Deviation::of(&found, target.diagonal())),
        vertex_to_surface: farthest_vertex(mesh, &target),
        normal_deviation: normals.deviation,
        folded: normals.folded,
        reversed: normals.reversed,
        diagonal: target.diagonal(),
    })
}

/// For each vertex of the surface the greatest distance between mesh and surface that is seen at some points of its triangles, or of
/// those of the mesh there: corners, middles of edges and centroids.
pub(crate) fn distances_around(mesh: &Mesh, surface: &Manifold) -> Vec<f64> {
    surface.prepare();
    let target = Target { surface };
    let triangles: Vec<[Point3; 3]> = mesh.triangles.iter().map(|&t| mesh.positions_of(t)).collect();
    let tree = Nearest::of(triangles.iter().copied());
    let there = triangles.par_iter().flat_map_iter(|&corners| {
        places_of(corners).into_iter().filter_map(|p| {
            let found = surface.closest_of_triangles(p)?;
            let distance = surface.equation().map_or(found.distance, |_| target.closest(p).position.distance(p));
            Some((found.place.face, distance))
        })
    });
    let faces: Vec<FaceId> = surface.topology().faces().collect();
    let back = faces.par_iter().flat_map_iter(|&f| {
        let points = places_of(surface.triangle(f)).into_iter();
        points.filter_map(|p| Some((f, tree.distance(target.lift(p))?))).collect::<Vec<_>>()
    });
    let found: Vec<(FaceId, f64)> = there.chain(back).collect();
    let mut most = vec![0.0_f64; surface.positions().len()];
    for (f, distance) in found {
        for v in surface.topology().corners(f) {
            most[v.index()] = most[v.index()].max(distance);
        }
    }
    most
}

fn places_of([a, b, c]: [Point3; 3]) -> [Point3; 7] {
    let centroid = Point3::weighted([a, b, c], [1.0 / 3.0; 3]);
    [a, b, c, a.lerp(b, 0.5), b.lerp(c, 0.5), c.lerp(a, 0.5), centroid]
}

/// Distances below this share of the diagonal are rounding.
const NOTHING: f64 = 1e-14;
/// Points are on f = 0 to this share of the diagonal.
const ON_ZERO: f64 = 1e-13;

/// The surface, as something to be near to.
struct Target<'a> {
    surface: &'a Manifold,
}

/// The closest point of the surface, and the unit normal there.
struct Foot {
    position: Point3,
    normal: Vector3,
}

impl Target<'_> {
    fn diagonal(&self) -> f64 {
        self.surface.diagonal()
    }

    /// The closest point of the surface to `p`, which is finite; of its triangles, where there is no way onto f = 0.
    fn closest(&self, p: Point3) -> Foot {
        let Some(found) = self.surface.closest_of_triangles(p) else {
            return Foot { position: p, normal: Vector3::default() };
        };
        let place = found.place;
        let zero = self.surface.equation().and_then(|f| {
            let from = |start| closest_zero(f, p, start, self.diagonal(), ON_ZERO * self.diagonal());
            // Far from the surface the way along gradients may miss the closest part; the triangles know which that is.
            let q = from(p).filter(|q| q.distance(p) <= found.distance).or_else(|| from(place.position))?;
            Some(Foot { position: q, normal: f.jet(q).gradient.unit()? })
        });
        zero.unwrap_or(Foot { position: place.position, normal: place.normal })
    }

    /// The point of the surface that a point of its triangles stands for.
    fn lift(&self, p: Point3) -> Point3 {
        let zero =
            self.surface.equation().and_then(|f| closest_zero(f, p, p, self.diagonal(), ON_ZERO * self.diagonal()));
        zero.unwrap_or(p)
    }

    /// How far a vertex is off.
    fn miss(&self, p: Point3) -> f64 {
        let by_equation = self.surface.equation().map(|f| f.jet(p)).map(|jet| jet.value.abs() / jet.gradient.norm());
        by_equation.filter(|miss| miss.is_finite()).unwrap_or_else(|| self.closest(p).position.distance(p))
    }
}

fn together(there: Sampled, back: Sampled) -> Sampled {
    let farthest = if back.farthest.distance > there.farthest.distance { back.farthest } else { there.farthest };
    Sampled { farthest, squares: there.squares + back.squares, area: there.area + back.area }
}

impl Deviation {
    fn of(sampled: &Sampled, diagonal: f64) -> Self {
        let (hausdorff, rms) = (sampled.farthest.distance, (sampled.squares / sampled.area).sqrt());
        let at = sampled.farthest.at.into();
        Self { hausdorff, hausdorff_share: hausdorff / diagonal, rms, rms_share: rms / diagonal, at }
    }
}

/// Distances of curved triangles; parts of the straight ones' areas are their weights.
fn of_curved(mesh: &Mesh, target: &Target) -> Option<Sampled> {
    mesh.curved.as_ref()?;
    let rule = Rule::fine(mesh);
    let of_triangle = |t: usize| -> Vec<(Sample, f64)> {
        let [a, b, c] = mesh.positions_of(mesh.triangles[t]);
        let area = 0.5 * (b - a).cross(c - a).norm();
        let points = points_in_space(mesh, t);
        let of_place = |place: &Place| {
            let at = place.image_in_space(&points);
            (Sample { at, distance: target.closest(at).position.distance(at) }, place.weight * area)
        };
        rule.places.iter().map(of_place).collect()
    };
    let all: Vec<Vec<(Sample, f64)>> = (0..mesh.triangles.len()).into_par_iter().map(of_triangle).collect();
    let single =
        |&(sample, area): &(Sample, f64)| Sampled { farthest: sample, squares: sample.distance.powi(2) * area, area };
    all.iter().flatten().map(single).reduce(together)
}

fn farthest_vertex(mesh: &Mesh, target: &Target) -> Spot {
    let used = distinct(mesh.triangles.as_flattened().iter().copied());
    let misses: Vec<f64> = used.par_iter().map(|&v| target.miss(mesh.position(v))).collect();
    spot(&misses, |miss| -miss, |i| mesh.position(used[i]).into()).map(|miss| -miss)
}

/// How the directions of triangles differ from the surface's.
struct Normals {
    deviation: NormalDeviation,
    folded: usize,
    reversed: bool,
}

impl Normals {
    fn of(triangles: &[[Point3; 3]], target: &Target) -> Self {
        let centroid = |t: [Point3; 3]| Point3::weighted(t, [1.0 / 3.0; 3]);
        // Twice the area and the angle, in radians.
        let compare = |&t: &[Point3; 3]| {
            let vector = (t[1] - t[0]).cross(t[2] - t[0]);
            let normal = target.closest(centroid(t)).normal;
            (vector.norm(), vector.cross(normal).norm().arctangent_over(vector.dot(normal)))
        };
        let mut found: Vec<(f64, f64)> = triangles.par_iter().map(compare).collect();
        let reversed = found.iter().map(|(area, angle)| area * angle.cosine()).sum::<f64>() < 0.0;
        if reversed {
            for (_, angle) in &mut found {
                *angle = std::f64::consts::PI - *angle;
            }
        }
        let area: f64 = found.iter().map(|(area, _)| area).sum();
        let sum: f64 = found.iter().map(|(area, angle)| area * angle.to_degrees()).sum();
        let max = spot(&found, |(_, angle)| -angle, |t| centroid(triangles[t]).into());
        Self {
            deviation: NormalDeviation { mean: sum / area, max: max.map(|angle| -angle.to_degrees()) },
            folded: found.iter().filter(|(_, angle)| *angle > std::f64::consts::FRAC_PI_2).count(),
            reversed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::Manifold;
    use crate::manifold::surface::{sphere, torus};

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance * b.abs(), "{a} is not {b}");
    }

    fn moved(mut mesh: Mesh, by: [f64; 3]) -> Mesh {
        mesh.points.iter_mut().for_each(|p| *p = [p[0] + by[0], p[1] + by[1], p[2] + by[2]]);
        mesh
    }

    /// The greatest distance by 20 x 20 / 2 points of every triangle.
    fn dense(triangles: &[[Point3; 3]], distance: impl Fn(Point3) -> f64) -> f64 {
        const STEPS: u32 = 20;
        let of_one = |&t: &[Point3; 3]| {
            let pairs =
                (0..=STEPS).flat_map(|i| (0..=STEPS - i).map(move |j| [i, j].map(|x| f64::from(x) / f64::from(STEPS))));
            pairs.map(|[s, t_]| distance(Point3::weighted(t, [1.0 - s - t_, s, t_]))).fold(0.0, f64::max)
        };
        triangles.iter().map(of_one).fold(0.0, f64::max)
    }

    #[test]
    fn a_surface_is_on_itself() {
        for scale in [1e-9, 1.0, 1e9] {
            let mut mesh = torus(2.0, 0.7, 0.3).unwrap().to_mesh();
            mesh.points.as_flattened_mut().iter_mut().for_each(|x| *x *= scale);
            let found = surface_fidelity(&mesh, &Manifold::of(&mesh).unwrap()).unwrap();
            assert!(found.both.hausdorff_share < 1e-14 && found.both.rms_share < 1e-14, "{found:?}");
            assert!(found.normal_deviation.max.value < 1e-5 && found.folded == 0 && !found.reversed, "{found:?}");
            mesh.triangles.iter_mut().for_each(|t| t.swap(0, 1));
            let surface = Manifold::new(torus(2.0 * scale, 0.7 * scale, 0.3 * scale).unwrap(), None);
            let reversed = surface_fidelity(&mesh, &surface).unwrap();
            assert!(reversed.reversed && reversed.folded == 0 && reversed.normal_deviation.max.value < 1e-5);
        }
    }

    #[test]
    fn an_icosahedron_in_its_sphere_in_closed_form() {
        let manifold = Manifold::shape("sphere:2", Some(0.25)).unwrap();
        let mesh = sphere(2.0, 4.0).unwrap().to_mesh();
        let found = surface_fidelity(&mesh, &manifold).unwrap();
        // Circumradius 2, inradius of the icosahedron; the same from both sides.
        let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
        let edge = 2.0 / (0.5 * (golden * 5.0_f64.sqrt()).sqrt());
        let gap = 2.0 - edge * golden * golden / (2.0 * 3.0_f64.sqrt());
        for side in [found.both, found.mesh_to_surface, found.surface_to_mesh] {
            assert!(side.hausdorff <= gap * (1.0 + 1e-12) && side.hausdorff > 0.99 * gap, "{side:?} {gap}");
            close(side.hausdorff_share, side.hausdorff / manifold.bounds().diagonal(), 1e-15);
            let Position::Space(at) = side.at else { panic!("three coordinates") };
            let from_centre = (Point3::from(at) - Point3::default()).norm();
            assert!(from_centre > 2.0 - gap - 1e-9 && from_centre < 2.0 + 1e-12);
        }
        assert!(found.vertex_to_surface.value < 1e-15);
        assert!(found.normal_deviation.max.value < 1e-6 && found.folded == 0, "centroids are right below the normals");
        // By the distance 2 - |p| at many points of one triangle.
        let t = mesh.positions_of(mesh.triangles[0]);
        let (mut sum, mut count) = (0.0, 0.0);
        for (i, j) in (0..300).flat_map(|i| (0..300 - i).map(move |j| (f64::from(i), f64::from(j)))) {
            let [s, u] = [(i + 1.0 / 3.0) / 300.0, (j + 1.0 / 3.0) / 300.0];
            let d = 2.0 - (Point3::weighted(t, [1.0 - s - u, s, u]) - Point3::default()).norm();
            (sum, count) = (sum + d * d, count + 1.0);
        }
        close(found.mesh_to_surface.rms, (sum / count).sqrt(), 0.01);
    }

    #[test]
    fn samples_of_triangles_are_good_to_a_hundredth() {
        for (coarse, by) in [(0.9, [0.0; 3]), (0.6, [0.03, -0.02, 0.01])] {
            let surface = Manifold::new(torus(2.0, 0.7, 0.45).unwrap(), None);
            let mesh = moved(torus(2.0, 0.7, coarse).unwrap().to_mesh(), by);
            let found = surface_fidelity(&mesh, &surface).unwrap();
            let ours: Vec<_> = mesh.triangles.iter().map(|&t| mesh.positions_of(t)).collect();
            let nearest = Nearest::new(surface.surface());
            let there = dense(&ours, |p| nearest.distance(p).unwrap());
            let tree = Nearest::of(ours.iter().copied());
            let theirs: Vec<_> = surface.topology().faces().map(|f| surface.triangle(f)).collect();
            let back = dense(&theirs, |p| tree.distance(p).unwrap());
            for (side, truth, tree) in [(found.mesh_to_surface, there, &nearest), (found.surface_to_mesh, back, &tree)]
            {
                assert!(side.hausdorff >= 0.99 * truth, "{side:?} {truth}");
                let Position::Space(at) = side.at else { panic!("three coordinates") };
                close(tree.distance(at.into()).unwrap(), side.hausdorff, 1e-12);
            }
            assert!(found.both.hausdorff >= there.max(back) * 0.99 && found.both.rms <= found.both.hausdorff);
        }
    }

    #[test]
    fn distances_are_to_the_equation_not_to_its_mesh() {
        // A fine mesh of the true torus, held against a coarse first mesh with the equation.
        let manifold = Manifold::shape("torus:2,0.7", Some(0.4)).unwrap();
        let mesh = torus(2.0, 0.7, 0.15).unwrap().to_mesh();
        let exact = surface_fidelity(&mesh, &manifold).unwrap();
        let by_mesh = surface_fidelity(&mesh, &Manifold::new(manifold.surface().clone(), None)).unwrap();
        // Sagittas of edges of 0.15 and 0.4 on radius 0.7.
        assert!(exact.both.hausdorff < 8e-3 && by_mesh.both.hausdorff > 0.02, "{exact:?} {by_mesh:?}");
        assert!(exact.vertex_to_surface.value < 1e-14 && by_mesh.vertex_to_surface.value > 0.02);
        assert!(exact.normal_deviation.mean < by_mesh.normal_deviation.mean);
        // Pushed out by 0.1 along its normals it is that far away everywhere, by |f| / |grad f| to first order.
        let out = torus(2.0, 0.8, 0.1).unwrap().to_mesh();
        let found = surface_fidelity(&out, &manifold).unwrap();
        close(found.both.hausdorff, 0.1, 0.01);
        close(found.both.rms, 0.1, 0.02);
        close(found.vertex_to_surface.value, (0.8 * 0.8 - 0.7 * 0.7) / 1.6, 1e-9);
    }

    #[test]
    fn what_is_folded_is_counted() {
        let surface = Manifold::new(sphere(1.0, 0.3).unwrap(), None);
        let mut mesh = surface.whole_mesh();
        // A vertex pulled beyond its neighbours, over the surface.
        let [a, b, c] = mesh.triangles[40];
        let far = |axis: usize| {
            mesh.points[b as usize][axis] + mesh.points[c as usize][axis] - 0.9 * mesh.points[a as usize][axis]
        };
        let p = Point3::new(far(0), far(1), far(2)) - Point3::default();
        mesh.points[a as usize] = (Point3::default() + p * (1.0 / p.norm())).to_array();
        let found = surface_fidelity(&mesh, &surface).unwrap();
        assert!(found.folded >= 1 && found.folded < 6 && found.normal_deviation.max.value > 90.0, "{found:?}");
        assert!(!found.reversed);
    }

    #[test]
    fn faults_are_errors_and_threads_do_not_matter() {
        let manifold = Manifold::shape("torus:2,0.7", Some(0.4)).unwrap();
        assert!(surface_fidelity(&Mesh::default(), &manifold).is_err());
        let mesh = torus(2.0, 0.7, 0.5).unwrap().to_mesh();
        let mut broken = mesh.clone();
        broken.points[3][0] = f64::INFINITY;
        assert!(surface_fidelity(&broken, &manifold).is_err());
        broken.triangles[0][0] = u32::MAX;
        assert!(surface_fidelity(&broken, &manifold).is_err());
        let with = |threads| crate::test_cases::on_threads(threads, || surface_fidelity(&mesh, &manifold).unwrap());
        assert_eq!(with(1), with(3));
    }
}
