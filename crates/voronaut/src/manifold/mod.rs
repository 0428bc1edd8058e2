//! Where meshes live: planar domains, surfaces of triangles, surfaces f = 0.
//!
//! | module | what it is |
//! |---|---|
//! | here | a [`Manifold`]: triangles, the curves on them that are kept, and a rule by which points come onto it: what all work on surfaces goes by |
//! | `place` | a point of it, and where that is |
//! | `riemannian` | a metric on what a mesh lives on |
//! | `chart` | a part of it seen as a part of the plane; the way over a chord |
//! | [`domain`] | planar domains, and their own triangulation, which is their one chart |
//! | [`surface`] | surfaces of triangles and of equations, their features, and metrics on them |

mod chart;
pub mod domain;
mod place;
mod riemannian;
pub mod surface;

pub(crate) use chart::Chart;
pub use place::Place;
pub use riemannian::Riemannian;

use crate::error::{Error, Result};
use crate::geometry::{Aabb3, Point3, Vector3};
use crate::mesh::{Mesh, Solution};
use crate::metric::Expression;
use crate::parallel::prelude::*;
use crate::triangulation::{FaceId, HalfEdge, Triangulation, VertexId};
use domain::Domain;
use std::sync::OnceLock;
use surface::{
    Closest, Component, FeatureGraph, FeatureOptions, Nearest, Seams, Surface, Whole, check_count, closest_weights,
    cut, project, project_along, project_pinned,
};

/// Where a mesh lives: triangles that are flat, in space, or near an equation's surface f = 0; the curves on them that a mesh is to keep; and how
/// points come onto it.
#[derive(Debug)]
pub struct Manifold {
    /// Its triangles.
    surface: Surface,
    /// Its equation, if it has one: then vertices are on it, and normals and curvatures are exact.
    implicit: Option<Expression>,
    /// Where the surface is open, or was cut open.
    seams: Seams,
    /// Unit normals, one per vertex slot.
    normals: Vec<Vector3>,
    /// Vertices that are the tip of something pointed, as far as that is known of triangles, in order; and the least cosine between their normals
    /// and those of their triangles.
    tips: Box<[(VertexId, f64)]>,
    /// The diagonal of its bounding box.
    diagonal: f64,
    nearest: OnceLock<Nearest>,
}

/// Newton's method ends when a step is no longer than this share of the diagonal.
const ON_SURFACE: f64 = 1e-14;
/// It leads no farther away than this share of the diagonal.
const REACH: f64 = 0.25;
/// Where the normal at a vertex is farther (degrees) from those of all its triangles it is the tip of something pointed.
const POINTED: f64 = FeatureOptions::DEFAULT_ANGLE;
/// The faces passed in search of a closest point, at most, and those after which a tree is asked.
const FEW_FACES: usize = 512;
const FACES: usize = 4096;
/// A point this far from the surface, as a share of the diagonal, is not meant to be on it.
pub(crate) const OFF_SURFACE: f64 = 1e-2;

impl Manifold {
    /// A surface with its equation, if it has one, on which its vertices are.
    pub fn new(surface: Surface, implicit: Option<Expression>) -> Self {
        let seams = Seams::uncut(&surface);
        Self::with_seams(surface, implicit, seams)
    }

    /// The triangles of a mesh, not cut.
    ///
    /// # Errors
    /// As for [`Surface::new`].
    pub fn of(mesh: &Mesh) -> Result<Self> {
        Ok(Self::new(Surface::new(mesh)?, None))
    }

    /// A planar domain: the plane is a surface with one flat chart. It is cut open along its segments, so that a mesh keeps them, and a metric of the
    /// plane is that of its tensors in the plane z = 0.
    ///
    /// # Errors
    /// As for [`Surface::new`], of triangles that rounding leaves without area.
    pub fn flat(domain: &Domain) -> Result<Self> {
        let corner = |v: VertexId| domain.sources()[v.index()];
        Self::of(&domain.mesh_of(domain.planar(), corner))?.cut(&FeatureOptions { ar: None })
    }

    /// The same surface cut open along its features, so that a mesh keeps them. On an equation's surface no creases are looked
    /// for.
    ///
    /// # Errors
    /// As for [`Surface::new`].
    pub fn cut(self, options: &FeatureOptions) -> Result<Self> {
        let options = if self.implicit.is_some() { &FeatureOptions { ar: None } } else { options };
        let (surface, seams) = cut(&self.surface, options)?;
        // Of an equation's surface creases are not looked for; its border bends all the same.
        let seams = if self.implicit.is_some() && surface.positions().len() == self.surface.positions().len() {
            self.seams
        } else {
            seams
        };
        Ok(Self::with_seams(surface, self.implicit, seams))
    }

    /// A part of this surface, cut open along its listed features: what counts as being on the equation's surface is the same for all parts.
    ///
    /// # Errors
    /// As for [`Surface::new`].
    pub(crate) fn part(&self, mesh: &Mesh) -> Result<Self> {
        let (part, seams) = cut(&Surface::new(mesh)?, &FeatureOptions { ar: None })?;
        Ok(Self { diagonal: self.diagonal, ..Self::with_seams(part, self.implicit.clone(), seams) })
    }

    /// The triangles of the surface before it was cut, by its vertices then.
    pub fn whole_mesh(&self) -> Mesh {
        let t = self.surface.topology();
        let before = self.seams.vertices_before();
        Mesh {
            points: self.surface.positions()[..before].iter().map(|p| p.to_array()).collect(),
            point_labels: self.surface.point_labels()[..before].to_vec(),
            triangles: t.faces().map(|f| t.corners(f).map(|v| self.seams.original(v).0)).collect(),
            triangle_labels: t.faces().map(|f| t.region(f)).collect(),
            ..Mesh::default()
        }
    }

    /// Whether a place is on the border, or so near to it (barycentric).
    pub(crate) fn is_at_border(&self, place: &Place, near: f64) -> bool {
        let t = self.surface.topology();
        let [ab, bc, ca] = place.face.half_edges();
        let beside = [(bc, 0), (ca, 1), (ab, 2)].into_iter();
        let at_edge = beside.clone().any(|(h, i)| place.weights[i] <= near && t.twin(h).is_none());
        let corners = t.corners(place.face);
        at_edge || (0..3).any(|i| place.weights[i] >= 1.0 - near && t.is_border_vertex(corners[i]))
    }

    /// A solution at the vertices of the surface before it was cut, as one at the vertices that it has now.
    ///
    /// # Errors
    /// [`Error::Metric`] where it has not one entry per vertex.
    pub fn spread(&self, solution: &Solution) -> Result<Solution> {
        check_count(solution.count(), self.seams.vertices_before())?;
        Ok(solution.of_vertices(&self.seams.originals()))
    }

    fn with_seams(surface: Surface, implicit: Option<Expression>, seams: Seams) -> Self {
        let up = Vector3::new(0.0, 0.0, 1.0);
        let slots = (0..surface.positions().len() as u32).into_par_iter().with_min_len(256).map(VertexId);
        let normals = slots.map(|v| surface.vertex_normal(v).unwrap_or(up)).collect();
        let diagonal = surface.bounds().diagonal();
        let tips = if implicit.is_some() { Box::default() } else { surface.tips(POINTED).into() };
        Self { surface, implicit, seams, normals, tips, diagonal, nearest: OnceLock::new() }
    }

    /// The least cosine between the normal at a vertex and those of its triangles, if it is a pointed tip.
    fn tip(&self, v: VertexId) -> Option<f64> {
        let found = self.tips.binary_search_by_key(&v, |tip| tip.0);
        found.ok().map(|i| self.tips[i].1)
    }

    /// What triangles with a corner at a place are to face: the normal there. The triangles at a pointed tip may face away from it as far as the
    /// surface's own do: there it is so much longer that these face it as if it were theirs.
    pub(crate) fn facing(&self, place: &Place) -> Vector3 {
        let normal = self.normal(place);
        let corner = (0..3).find(|&k| place.weights[k] >= 1.0 && self.implicit.is_none());
        let tip = corner.and_then(|k| self.tip(self.surface.topology().corners(place.face)[k]));
        tip.filter(|&least| least > 0.0).map_or(normal, |least| normal * (1.0 / least))
    }

    /// Its triangles.
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// Its equation, if it has one.
    pub fn equation(&self) -> Option<&Expression> {
        self.implicit.as_ref()
    }

    /// Its triangles and how they hang together; where it was cut open, as if on both sides of the cut there were nothing.
    pub fn topology(&self) -> &Triangulation {
        self.surface.topology()
    }

    /// Positions, one per vertex slot.
    pub fn positions(&self) -> &[Point3] {
        self.surface.positions()
    }

    /// The corners of a triangle.
    pub fn triangle(&self, f: FaceId) -> [Point3; 3] {
        self.surface.triangle(f)
    }

    /// The place with these barycentric coordinates in a triangle.
    pub(crate) fn place(&self, face: FaceId, weights: [f64; 3]) -> Place {
        self.surface.place(face, weights)
    }

    /// The place of a triangle that is closest to a point.
    pub(crate) fn closest_on(&self, face: FaceId, p: Point3) -> Place {
        self.surface.closest_on(face, p)
    }

    /// A vertex as a place: a corner of one of its triangles. `None` of a vertex without triangles.
    pub fn place_of(&self, v: VertexId) -> Option<Place> {
        self.surface.place_of(v)
    }

    /// The smallest box around its triangles.
    pub fn bounds(&self) -> Aabb3 {
        self.surface.bounds()
    }

    /// The unit normal between those of a place's triangle's corners.
    pub(crate) fn normal_between(&self, place: &Place) -> Vector3 {
        self.surface.normal_at(place)
    }

    /// The normal of a triangle with the length of twice its area.
    pub(crate) fn area_vector(&self, f: FaceId) -> Vector3 {
        self.surface.area_vector(f)
    }

    /// The area of its triangles.
    pub(crate) fn area(&self) -> f64 {
        self.surface.area()
    }

    /// Its connected parts.
    pub(crate) fn components(&self) -> Vec<Component> {
        self.surface.components()
    }

    /// One label per vertex slot; 0 for none.
    pub(crate) fn point_labels(&self) -> &[i32] {
        self.surface.point_labels()
    }

    /// Vertices that a mesh has to have, in order.
    pub(crate) fn required_points(&self) -> &[VertexId] {
        self.surface.required_points()
    }

    /// Triangles that a mesh has to have, in order.
    pub(crate) fn required_triangles(&self) -> &[FaceId] {
        self.surface.required_triangles()
    }

    /// The unit normal between those of a vertex's triangles.
    pub(crate) fn vertex_normal(&self, v: VertexId) -> Vector3 {
        self.normals[v.index()]
    }

    /// The curves that a mesh keeps, from corner to corner.
    pub(crate) fn features(&self) -> &FeatureGraph {
        &self.seams.features
    }

    /// What vertices and curves were before it was cut.
    pub(crate) fn seams(&self) -> &Seams {
        &self.seams
    }

    /// Euler number and borders, before it was cut.
    pub(crate) fn whole(&self) -> Whole {
        self.seams.whole()
    }

    /// The diagonal of the bounding box of its triangles.
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// The closest place of the surface; of an equation's one to which Newton's method leads from the closest triangle.
    ///
    /// # Errors
    /// [`Error::Domain`] where the point is not finite, or farther than a hundredth of the diagonal from the surface.
    pub fn closest(&self, p: Point3) -> Result<Place> {
        let found = self.nearest().closest(&self.surface, p).and_then(|found| self.lift(&found.place, p));
        let is_near = |place: &Place| place.position.distance(p) <= OFF_SURFACE * self.diagonal;
        found.filter(is_near).ok_or_else(|| {
            let help = "give points on the surface, or within a hundredth of its diagonal from it";
            Error::domain("a point off the surface", p.to_string(), help)
        })
    }

    /// The place of the triangles that is closest to a finite point, among those that face the way of a normal.
    pub(crate) fn closest_facing(&self, p: Point3, normal: Vector3) -> Option<Place> {
        self.nearest().closest_facing(&self.surface, p, normal)
    }

    /// The place of its triangles that is closest to a finite point, and how far that is.
    pub(crate) fn closest_of_triangles(&self, p: Point3) -> Option<Closest> {
        self.nearest().closest(&self.surface, p)
    }

    /// Its triangle that is closest to a finite point, if the squared distance is less than this; at infinity any is.
    pub(crate) fn nearer(&self, p: Point3, than: f64) -> Option<FaceId> {
        self.nearest().nearer(p, than)
    }

    /// Makes ready what closest points are found by, before a loop in which all cores would.
    pub(crate) fn prepare(&self) {
        self.nearest();
    }

    fn nearest(&self) -> &Nearest {
        // Made on all cores, and so not under a lock: who waits for the rest of it may take up a part of a loop that asks for it, too.
        let made = self.nearest.get().is_none().then(|| Nearest::new(&self.surface));
        self.nearest.get_or_init(|| made.expect("made if there was none"))
    }

    /// The place of the surface that a point near a place is nearest to: found from triangle to triangle or, on an equation's
    /// surface, by Newton's method, with the given place's triangle. `None` where the latter leads nowhere.
    pub(crate) fn lift(&self, near: &Place, p: Point3) -> Option<Place> {
        match &self.implicit {
            Some(f) => {
                let position = project(f, p, REACH * self.diagonal, ON_SURFACE * self.diagonal)?;
                Some(Place { position, normal: f.jet(position).gradient.unit()?, ..*near })
            }
            None => p.is_finite().then(|| self.walk(near, p)),
        }
    }

    /// The place straight above or below a point near a place, where a unit vector is up: found as by [`Manifold::lift`]. `None` where there is none,
    /// or a normal on the way has a lesser cosine with up.
    pub(crate) fn lift_along(&self, near: &Place, p: Point3, up: Vector3, least: f64) -> Option<Place> {
        let Some(f) = &self.implicit else { return self.walk_along(near.face, p, up, least) };
        let within = [REACH * self.diagonal, ON_SURFACE * self.diagonal / least];
        let (position, normal) = project_along(f, p, up, least, within)?;
        Some(Place { position, normal, ..*near })
    }

    /// From triangle to triangle across the side that a point is farthest beyond, seen from above, until it is in one.
    fn walk_along(&self, from: FaceId, p: Point3, up: Vector3, least: f64) -> Option<Place> {
        let mut face = from;
        for _ in 0..FEW_FACES {
            let [a, b, c] = self.surface.triangle(face);
            let slope = self.surface.normal(face).dot(up);
            if slope.is_nan() || slope <= least {
                return None;
            }
            let area = (b - a).cross(c - a).dot(up);
            let share = |u: Point3, v: Point3| (u - p).cross(v - p).dot(up) / area;
            let weights = [share(b, c), share(c, a), share(a, b)];
            let [ab, bc, ca] = face.half_edges();
            let sides = [(weights[0], bc), (weights[1], ca), (weights[2], ab)];
            let farthest = sides.into_iter().fold(sides[0], |most, side| if side.0 < most.0 { side } else { most });
            if farthest.0 >= 0.0 {
                return Some(self.surface.place(face, weights));
            }
            face = self.surface.topology().twin(farthest.1)?.face();
        }
        None
    }

    /// The point of an equation's surface to which Newton's method leads from a point near it, with some coordinates as they are; `None` where it leads
    /// nowhere, or there is no equation.
    pub(crate) fn onto(&self, p: Point3, pinned: [bool; 3]) -> Option<Point3> {
        let f = self.implicit.as_ref()?;
        project_pinned(f, p, pinned, REACH * self.diagonal, ON_SURFACE * self.diagonal)
    }

    /// The place of a point that lies on the surface's triangles, but for rounding; for that of an equation what [`Manifold::lift`] says.
    pub(crate) fn place_on_triangles(&self, near: &Place, p: Point3) -> Option<Place> {
        if self.implicit.is_some() { self.lift(near, p) } else { Some(self.nearest().closest(&self.surface, p)?.place) }
    }

    /// From triangle to triangle as long as that leads nearer to a point: across the edges that the closest point lies on, or else
    /// around its corner. Where that takes long, from what is closest of all, unless it is another side of the surface.
    fn walk(&self, from: &Place, p: Point3) -> Place {
        let topology = self.surface.topology();
        let mut best = self.reached(from.face, p);
        for step in 0..FACES {
            if step == FEW_FACES {
                let closest =
                    self.nearest().closest(&self.surface, p).filter(|it| it.place.normal.dot(from.normal) > 0.0);
                let closest = closest.map(|found| self.reached(found.place.face, p));
                best = closest.filter(|closest| closest.square < best.square).unwrap_or(best);
            }
            let [ab, bc, ca] = best.face.half_edges();
            let [a, b, c] = best.weights.map(|w| w <= 0.0);
            let across =
                [(c, ab), (a, bc), (b, ca)].into_iter().filter(|edge| edge.0).filter_map(|e| topology.twin(e.1));
            let corner = [(b && c, ab), (c && a, bc), (a && b, ca)].into_iter().find(|at| at.0).map(|at| at.1);
            let around = || corner.into_iter().flat_map(|h| topology.star(topology.origin(h)));
            let nearer = |h: HalfEdge| Some(self.reached(h.face(), p)).filter(|next| next.square < best.square);
            let nearest = |x: &Reached, y: &Reached| x.square.total_cmp(&y.square);
            let next = across.filter_map(nearer).min_by(nearest);
            match next.or_else(|| around().filter_map(nearer).min_by(nearest)) {
                Some(next) => best = next,
                None => break,
            }
        }
        self.surface.place(best.face, best.weights)
    }

    fn reached(&self, face: FaceId, p: Point3) -> Reached {
        let corners = self.surface.triangle(face);
        let weights = closest_weights(corners, p);
        let offset = Point3::weighted(corners, weights) - p;
        Reached { face, weights, square: offset.dot(offset) }
    }

    /// The unit normal of the surface at a place: exact of an equation, else between those of the triangle's corners. Beside a pointed tip
    /// it is that of the triangle: the normal at the tip is none of its neighbourhood.
    pub(crate) fn normal(&self, place: &Place) -> Vector3 {
        if self.implicit.is_some() {
            return place.normal;
        }
        let corners = self.surface.topology().corners(place.face);
        let at_corner = |&v: &VertexId, weight: f64| {
            let is_beside_tip = weight < 1.0 && self.tip(v).is_some();
            if is_beside_tip { place.normal } else { self.normals[v.index()] }
        };
        let weighted = corners.iter().zip(place.weights).map(|(v, weight)| at_corner(v, weight) * weight);
        weighted.fold(Vector3::default(), |sum, normal| sum + normal).unit().unwrap_or(place.normal)
    }
}

/// Where a triangle is closest to a point, and the square of the distance.
#[derive(Clone, Copy)]
struct Reached {
    face: FaceId,
    weights: [f64; 3],
    square: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_come_onto_the_surface_from_near_places() {
        for spec in ["sphere:2", "torus:2,0.5"] {
            let exact = Manifold::shape(spec, Some(0.2)).unwrap();
            let mesh = Manifold::new(exact.surface.clone(), None);
            let nearest = Nearest::new(&exact.surface);
            for v in exact.surface.topology().vertices().step_by(7) {
                let place = exact.surface.place_of(v).unwrap();
                let aside = exact.normal(&exact.lift(&place, place.position).unwrap()).perpendicular();
                for step in [0.0, 0.1, 0.3] {
                    let p = place.position + aside * step;
                    let (on_mesh, on_equation) = (mesh.lift(&place, p).unwrap(), exact.lift(&place, p).unwrap());
                    let truth = nearest.closest(&exact.surface, p).unwrap();
                    assert!((on_mesh.position.distance(p) - truth.distance).abs() < 1e-12, "{spec} {p}");
                    let f = exact.implicit.as_ref().unwrap().jet(on_equation.position);
                    assert!(f.value.abs() < 1e-12 && (f.gradient.unit().unwrap() - on_equation.normal).norm() < 1e-12);
                    assert!(mesh.normal(&on_mesh).dot(on_equation.normal) > 0.99);
                }
            }
        }
    }

    /// The tree is made on all cores, which may take up the loop's other parts meanwhile, and these ask for it as well.
    #[test]
    fn a_loop_on_all_cores_may_be_the_first_that_asks_for_closest_points() {
        let torus = Manifold::new(surface::torus(2.0, 0.7, 0.03).unwrap(), None);
        let points: Vec<Point3> = (0..400).map(|i| Point3::new(f64::from(i).sin(), f64::from(i).cos(), 0.1)).collect();
        let found: Vec<Option<Closest>> =
            crate::test_cases::on_threads(4, || points.par_iter().map(|&p| torus.closest_of_triangles(p)).collect());
        assert!(found.iter().zip(&points).all(|(found, &p)| *found == torus.closest_of_triangles(p)));
    }

    #[test]
    fn points_far_off_are_refused() {
        let sphere = Manifold::shape("sphere:1", None).unwrap();
        assert!(sphere.closest(Point3::new(0.0, 0.0, 1.01)).is_ok());
        for p in [Point3::new(0.0, 0.0, 1.1), Point3::default(), Point3::new(f64::NAN, 0.0, 1.0)] {
            assert!(sphere.closest(p).unwrap_err().to_string().contains("a point off the surface"));
        }
    }
}
