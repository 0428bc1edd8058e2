//! Samples of a surface and of its mesh, and the closest point of the other for each.

use super::closest::{Foot, Sheet, area_vector};
use crate::geometry::{Point3, Vector3};
use crate::parallel::prelude::*;
use crate::surface::{Nearest, Surface};
use crate::triangulation::{FaceId, VertexId};

/// A point of the surface, and the part of the surface's area that it stands for.
#[derive(Clone, Copy)]
struct Sample {
    place: Point3,
    weight: f64,
}

/// What is measured: fixed samples of the surface, and samples of the mesh that move with it.
pub(super) struct Samples<'a> {
    pub(super) surface: Sheet<'a>,
    of_surface: Vec<Sample>,
}

/// The closest points to all samples.
pub(super) struct Assignment {
    /// Of each sample of the surface, on the mesh.
    to_mesh: Vec<Foot>,
    /// Of each sample of the mesh, on the surface.
    to_surface: Vec<Foot>,
    /// Mean square distance, the mean of both directions.
    pub(super) mean_square: f64,
    /// The greatest distance.
    pub(super) greatest: f64,
}

/// A point of the mesh and one of the surface that should be as near as can be.
pub(super) struct Pair {
    /// The triangle of the mesh.
    pub(super) face: FaceId,
    /// Where in it.
    pub(super) weights: [f64; 3],
    /// The unit direction along which their distance is measured.
    pub(super) direction: Vector3,
    /// How far the mesh is to move along it.
    pub(super) gap: f64,
    /// Part of all pairs.
    pub(super) weight: f64,
}

/// Sides of a triangle of the mesh are cut into so many parts; its samples are the middles of the square of that many parts,
/// and its corners: the tip of an ear that has come out too far shows nowhere else.
const PARTS: usize = 4;
const CORNERS: usize = PARTS * PARTS;
const PER_TRIANGLE: usize = CORNERS + 3;
/// The sample in the middle of a triangle: the second upright part of the second row.
const MIDDLE: usize = 8;
/// The part of a triangle's area that a corner stands for: with it, means of quadratic functions are exact.
const CORNER_SHARE: f64 = 1.0 / 147.0;

/// A pair at the root mean square distance weighs this part more than one without distance, those further apart more by
/// the square, ...
const FARTHER: f64 = 0.1;
/// ... up to this many times.
const FARTHEST: f64 = 100.0;

/// Distances below this part of the root mean square have no direction of their own at a vertex or an edge.
const NEAR: f64 = 0.1;

impl Assignment {
    /// Where on the surface the middle of a triangle of the mesh is closest.
    pub(super) fn below(&self, f: FaceId) -> FaceId {
        self.to_surface[PER_TRIANGLE * f.index() + MIDDLE].face
    }

    /// A factor on the weight of a pair: what is far apart, tips above all, is drawn together more, for less than a per cent
    /// of the root mean square distance.
    fn urgency(&self, foot: &Foot) -> f64 {
        1.0 + FARTHER * (foot.square() / self.mean_square).min(FARTHEST)
    }
}

impl<'a> Samples<'a> {
    /// About `count` samples of the surface, even by area, and all its vertices.
    pub(super) fn new(surface: &'a Surface, count: usize) -> Self {
        Self { surface: Sheet::of(surface), of_surface: of_surface(surface, count) }
    }

    /// Closest points among all triangles of a mesh, which `whole` is as a surface.
    pub(super) fn assign(&self, surface: &Surface, mesh: &Surface) -> Assignment {
        let sheet = Sheet::of(mesh);
        let trees = [Nearest::new(surface), Nearest::new(mesh)];
        let find = |tree: &Nearest, of: &Surface, p: Point3| tree.closest(of, p).map_or(FaceId(0), |c| c.place.face);
        self.measured(
            &sheet,
            |_, p| sheet.foot(find(&trees[1], mesh, p), p),
            |_, p| self.surface.foot(find(&trees[0], surface, p), p),
        )
    }

    /// Closest points after vertices have moved, found from those before.
    pub(super) fn follow(&self, mesh: &Sheet, before: &Assignment) -> Assignment {
        self.measured(
            mesh,
            |i, p| mesh.descend(before.to_mesh[i].face, p),
            |i, p| self.surface.descend(before.to_surface[i].face, p),
        )
    }

    fn measured(
        &self,
        mesh: &Sheet,
        on_mesh: impl Fn(usize, Point3) -> Foot + Sync,
        on_surface: impl Fn(usize, Point3) -> Foot + Sync,
    ) -> Assignment {
        let to_mesh: Vec<Foot> = self.of_surface.par_iter().enumerate().map(|(i, s)| on_mesh(i, s.place)).collect();
        let count = PER_TRIANGLE * mesh.topology.face_slots();
        let to_surface: Vec<Foot> = (0..count).into_par_iter().map(|i| on_surface(i, of_mesh(mesh, i).0)).collect();
        let mut sums = [[0.0; 2]; 2];
        for (foot, s) in to_mesh.iter().zip(&self.of_surface) {
            sums[0][0] += s.weight * foot.square();
            sums[0][1] += s.weight;
        }
        for (i, foot) in to_surface.iter().enumerate() {
            let (_, weight) = of_mesh(mesh, i);
            sums[1][0] += weight * foot.square();
            sums[1][1] += weight;
        }
        let [a, b] = sums.map(|[sum, weight]| sum / weight);
        let greatest = to_mesh.iter().chain(&to_surface).map(Foot::square).fold(0.0, f64::max).sqrt();
        Assignment { to_mesh, to_surface, mean_square: 0.5 * (a + b), greatest }
    }

    /// All pairs of samples and their closest points; weights of each direction sum to one.
    pub(super) fn pairs<'b>(&'b self, mesh: &'b Sheet, at: &'b Assignment) -> impl Iterator<Item = Pair> + 'b {
        let near = NEAR * at.mean_square.sqrt();
        let total: f64 = self.of_surface.iter().map(|s| s.weight).sum();
        let area: f64 = mesh.topology.faces().map(|f| 0.5 * mesh.area_vector(f).norm()).sum();
        let to_mesh = at.to_mesh.iter().zip(&self.of_surface).map(move |(foot, s)| {
            let direction = mesh.direction(foot, near);
            let gap = direction.dot(foot.offset);
            let weight = s.weight / total * at.urgency(foot);
            Pair { face: foot.face, weights: foot.weights, direction, gap, weight }
        });
        let to_surface = at.to_surface.iter().enumerate().map(move |(i, foot)| {
            let direction = self.surface.direction(foot, near);
            let gap = -direction.dot(foot.offset);
            let (face, weights) = on_lattice(i);
            let weight = of_mesh(mesh, i).1 / area * at.urgency(foot);
            Pair { face, weights, direction, gap, weight }
        });
        to_mesh.chain(to_surface)
    }
}

/// A sample of the mesh: its triangle and barycentric coordinates.
fn on_lattice(i: usize) -> (FaceId, [f64; 3]) {
    let (face, k) = (FaceId((i / PER_TRIANGLE) as u32), i % PER_TRIANGLE);
    if k >= CORNERS {
        return (face, [0, 1, 2].map(|corner| if corner == k - CORNERS { 1.0 } else { 0.0 }));
    }
    // Parts in rows: of every row the upright ones, then those upside down.
    let before = |row: usize| CORNERS - (PARTS - row) * (PARTS - row);
    let row = (0..PARTS).rev().find(|&row| before(row) <= k).unwrap_or(0);
    let (rest, upright) = (k - before(row), PARTS - row);
    let (column, third) = if rest < upright { (rest, 1.0 / 3.0) } else { (rest - upright, 2.0 / 3.0) };
    let (s, t) = ((column as f64 + third) / PARTS as f64, (row as f64 + third) / PARTS as f64);
    (face, [1.0 - s - t, s, t])
}

/// Where a sample of the mesh is, and the area that it stands for.
fn of_mesh(mesh: &Sheet, i: usize) -> (Point3, f64) {
    let (face, weights) = on_lattice(i);
    let corners = mesh.triangle(face);
    let of_part = (1.0 - 3.0 * CORNER_SHARE) / CORNERS as f64;
    let share = if i % PER_TRIANGLE < CORNERS { of_part } else { CORNER_SHARE };
    (Point3::weighted(corners, weights), 0.5 * area_vector(corners).norm() * share)
}

fn of_surface(surface: &Surface, count: usize) -> Vec<Sample> {
    let t = surface.topology();
    let vertices = t.vertices().count();
    let total = surface.area();
    let step = total / count as f64;
    let mut samples = Vec::with_capacity(count + vertices);
    let (mut reached, mut k) = (0.0, 0_usize);
    for f in t.faces() {
        reached += 0.5 * surface.area_vector(f).norm();
        while k < count && (k as f64 + 0.5) * step < reached {
            let place = Point3::weighted(surface.triangle(f), scattered(k));
            samples.push(Sample { place, weight: step });
            k += 1;
        }
    }
    let share = vertices as f64 / count as f64;
    let star_area = |v: VertexId| t.star(v).map(|h| surface.area_vector(h.face()).norm() / 6.0).sum::<f64>();
    samples.extend(t.vertices().map(|v| Sample { place: surface.position(v), weight: share * star_area(v) }));
    samples
}

/// The k-th of points that fill a triangle evenly, as barycentric coordinates: the additive sequence of Roberts 2018 in the
/// unit square, folded at its diagonal.
fn scattered(k: usize) -> [f64; 3] {
    let [s, t] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2].map(|step: f64| (0.5 + step * k as f64).fract());
    let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
    [1.0 - s - t, s, t]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::torus;

    #[test]
    fn means_over_the_mesh_are_exact_of_quadratic_functions() {
        let surface = torus(2.0, 0.7, 0.9).unwrap();
        let sheet = Sheet::of(&surface);
        for f in surface.topology().faces().take(10) {
            let numbers = (0..PER_TRIANGLE).map(|k| PER_TRIANGLE * f.index() + k);
            let [a, b, c] = surface.triangle(f);
            let area = 0.5 * surface.area_vector(f).norm();
            let (mut sum, mut weights) = (0.0, 0.0);
            for i in numbers {
                let (p, weight) = of_mesh(&sheet, i);
                sum += weight * p.x * p.x;
                weights += weight;
            }
            let exact = area * (a.x * a.x + b.x * b.x + c.x * c.x + a.x * b.x + b.x * c.x + c.x * a.x) / 6.0;
            assert!((weights / area - 1.0).abs() < 1e-13 && (sum / exact - 1.0).abs() < 1e-12, "{sum} {exact}");
            let middle = of_mesh(&sheet, PER_TRIANGLE * f.index() + MIDDLE).0;
            assert!(middle.distance(Point3::weighted([a, b, c], [1.0 / 3.0; 3])) < 1e-14);
        }
    }

    #[test]
    fn samples_of_the_surface_are_even() {
        let surface = torus(2.0, 0.7, 0.2).unwrap();
        let samples = of_surface(&surface, 10_000);
        assert_eq!(samples.len(), 10_000 + surface.positions().len());
        let total: f64 = samples.iter().map(|s| s.weight).sum();
        let mean = |f: &dyn Fn(Point3) -> f64| samples.iter().map(|s| s.weight * f(s.place)).sum::<f64>() / total;
        // Of a torus: x^2 has the mean (R^2 + 3/2 r^2) / 2, z^2 has r^2 / 2.
        assert!(mean(&|p| p.x).abs() < 0.01 && mean(&|p| p.z).abs() < 0.01);
        assert!((mean(&|p| p.x * p.x) / 2.3675 - 1.0).abs() < 0.01, "{}", mean(&|p| p.x * p.x));
        assert!((mean(&|p| p.z * p.z) / 0.245 - 1.0).abs() < 0.02, "{}", mean(&|p| p.z * p.z));
    }
}
