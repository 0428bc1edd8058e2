//! Voronoi cells of seeds, in the tangent planes there or of the diagram on a canvas, with their moments, which relaxation takes.

use crate::dual::{Kind, Moving};
use crate::elementary::Elementary;
use crate::error::Result;
use crate::geodesic::LocalMetric;
use crate::geometry::{Vector, to_frame};
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, VertexId};

/// A convex polygon around the origin of a tangent plane, in an orthonormal frame (metric units).
#[derive(Clone, Debug, Default)]
pub struct Cell {
    corners: Vec<Vector>,
    scratch: Vec<Vector>,
    /// What surrounds the seed.
    spokes: Vec<Vector>,
}

/// Moments of a cell about its seed, in the tangent plane there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moments {
    /// Area.
    pub mass: f64,
    /// The integral of the position vector.
    pub first: Vector,
    /// The integral of its square: the seed's share of the energy of centroidal Voronoi tessellations.
    pub second: f64,
}

impl Cell {
    /// Starts again with a square of this half-width.
    pub(crate) fn reset(&mut self, half_width: f64) {
        let w = half_width;
        self.corners.clear();
        self.corners.extend([(-w, -w), (w, -w), (w, w), (-w, w)].map(|(x, y)| Vector::new(x, y)));
    }

    /// Keeps what lies nearer to the origin than to another seed.
    pub(crate) fn cut_by_bisector(&mut self, seed: Vector) {
        self.cut(seed, 0.5 * seed.dot(seed));
    }

    /// Keeps what lies on the origin's side of the line through two points.
    pub(crate) fn cut_by_line(&mut self, a: Vector, b: Vector) {
        let normal = (a - b).perpendicular();
        let offset = normal.dot(a);
        if offset > 0.0 { self.cut(normal, offset) } else { self.cut(-normal, -offset) }
    }

    /// Keeps what lies to the left of a vector from the origin.
    pub(crate) fn keep_left_of(&mut self, direction: Vector) {
        self.cut(-direction.perpendicular(), 0.0);
    }

    /// Keeps the points x with x . normal <= offset (Sutherland and Hodgman 1974).
    fn cut(&mut self, normal: Vector, offset: f64) {
        if self.corners.iter().all(|p| p.dot(normal) - offset <= 0.0) {
            return;
        }
        self.scratch.clear();
        for (i, &p) in self.corners.iter().enumerate() {
            let q = self.corners[(i + 1) % self.corners.len()];
            let (at_p, at_q) = (p.dot(normal) - offset, q.dot(normal) - offset);
            if at_p <= 0.0 {
                self.scratch.push(p);
            }
            if (at_p < 0.0) != (at_q < 0.0) {
                self.scratch.push(p + (q - p) * (at_p / (at_p - at_q)));
            }
        }
        std::mem::swap(&mut self.corners, &mut self.scratch);
    }

    /// The cell's moments about the origin.
    pub(crate) fn moments(&self) -> Moments {
        let mut moments = Moments::default();
        for (i, &p) in self.corners.iter().enumerate() {
            let q = self.corners[(i + 1) % self.corners.len()];
            let cross = p.cross(q);
            moments.mass += 0.5 * cross;
            moments.first = moments.first + (p + q) * (cross / 6.0);
            moments.second += cross / 12.0 * (p.dot(p) + p.dot(q) + q.dot(q));
        }
        moments
    }
}

impl Moments {
    /// The centroid; the origin where the cell has no area.
    #[cfg(test)]
    fn centroid(&self) -> Vector {
        let mean = self.first * (1.0 / self.mass);
        if self.mass > 0.0 && mean.norm().is_finite() { mean } else { Vector::default() }
    }
}

impl std::ops::Add for Moments {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { mass: self.mass + other.mass, first: self.first + other.first, second: self.second + other.second }
    }
}

/// Where the moments of the cells of a triangulation's seeds come from.
pub(crate) trait CellsOf<M> {
    /// The moments of every seed's cell about the seed, in order of the vertices' ids; tangent vectors are in the
    /// orthonormal frame of [`to_frame`].
    ///
    /// # Errors
    /// [`crate::Error::Domain`] if cells are of a canvas that is not of the dual's domain or surface.
    fn moments(&self, dual: &M) -> Result<Vec<(VertexId, Moments)>>;

    /// Whether steps that raise the energy are taken back.
    fn lower_energy(&self) -> bool {
        true
    }
}

/// The cells of [`Cells::Tangent`](super::Cells::Tangent), on surfaces, too: each is cut in the tangent plane at the seed, by bisectors with its neighbours,
/// which are seen through the second-order logarithm map, and by the domain's segments. Lengths at rough seeds must have been measured.
pub(crate) struct Tangent;

impl<M: Moving> CellsOf<M> for Tangent {
    fn moments(&self, dual: &M) -> Result<Vec<(VertexId, Moments)>> {
        let seeds: Vec<VertexId> = dual.topology().vertices().collect();
        let of = |cell: &mut Cell, v: VertexId| (v, View::at(dual, v).moments(cell));
        Ok(seeds.into_par_iter().with_min_len(256).map_init(Cell::default, of).collect())
    }
}

/// What the neighbourhood looks like in the tangent plane at a seed.
struct View<'a, M> {
    dual: &'a M,
    seed: VertexId,
    frame: [f64; 3],
    /// The inverses of the frame's diagonal.
    inverse: [f64; 2],
}

impl<'a, M: Moving> View<'a, M> {
    fn at(dual: &'a M, seed: VertexId) -> Self {
        let frame = dual.local(seed).tensor.cholesky();
        Self { dual, seed, frame, inverse: [1.0 / frame[0], 1.0 / frame[2]] }
    }

    fn moments(&self, cell: &mut Cell) -> Moments {
        let topology = self.dual.topology();
        let mut spokes = std::mem::take(&mut cell.spokes);
        spokes.clear();
        spokes.extend(topology.star(self.seed).map(|h| self.neighbour(h)));
        let moments = if topology.is_border_vertex(self.seed) {
            self.border_moments(cell, &spokes)
        } else {
            if !self.is_by_centres(cell, &spokes) {
                cell.reset(width(&spokes));
                self.cut(cell, &spokes);
            }
            cell.moments()
        };
        cell.spokes = spokes;
        moments
    }

    /// Puts into a cell the centres of the circles through the seed and two neighbours, one after the other, and says whether they are its
    /// corners, as where seeds are relaxed: each bisector is gone along from one to the next, once around, and nothing else would cut it.
    fn is_by_centres(&self, cell: &mut Cell, spokes: &[Vector]) -> bool {
        let following = || spokes.iter().zip(spokes.iter().cycle().skip(1));
        cell.corners.clear();
        cell.corners.extend(following().map(|(&u, &v)| centre(u, v)));
        let corners = &cell.corners;
        let Some(&last) = corners.last() else { return false };
        let before = std::iter::once(&last).chain(corners);
        let goes_on =
            |((&from, &to), &spoke): ((&Vector, &Vector), &Vector)| (to - from).dot(spoke.perpendicular()) >= 0.0;
        let turns = following().filter(|(u, v)| u.y < 0.0 && v.y >= 0.0).count();
        let width = width(spokes);
        turns == 1
            && following().all(|(&u, &v)| u.cross(v) > 0.0)
            && before.zip(corners).zip(spokes).all(goes_on)
            && corners.iter().all(|corner| corner.x.abs() <= width && corner.y.abs() <= width)
            && self.dual.topology().star(self.seed).zip(corners).all(|(h, &corner)| self.is_free_beyond(h, corner))
    }

    /// Whether neither a constraint nor the seed beyond the edge opposite to this one cuts off the corner towards that edge.
    fn is_free_beyond(&self, h: HalfEdge, corner: Vector) -> bool {
        let topology = self.dual.topology();
        let Some(t) = topology.twin(h.next()).filter(|_| !topology.is_fixed(h.next())) else { return false };
        if self.dual.local(self.seed).is_rough {
            return true;
        }
        let beyond = self.image(topology.apex(t), 0.0);
        corner.dot(beyond) <= 0.5 * beyond.dot(beyond)
    }

    /// At the border the cell is a part of a disc: one or, at reflex corners, several convex ones.
    fn border_moments(&self, cell: &mut Cell, spokes: &[Vector]) -> Moments {
        let topology = self.dual.topology();
        let Some(last) = topology.star(self.seed).last().map(|h| self.beyond(h)) else { return Moments::default() };
        let width = width(spokes).max(last.norm());
        let is_convex =
            matches!(self.dual.kind(self.seed), Kind::Curve | Kind::Held) || turn(spokes, last) <= std::f64::consts::PI;
        let sectors: Vec<[Vector; 2]> = if is_convex {
            vec![[spokes[0], last]]
        } else {
            spokes.iter().copied().zip(spokes.iter().copied().skip(1).chain([last])).map(|(a, b)| [a, b]).collect()
        };
        let mut sum = Moments::default();
        for [from, to] in sectors {
            cell.reset(width);
            cell.keep_left_of(from);
            cell.keep_left_of(-to);
            cell.cut_by_bisector(last);
            self.cut(cell, spokes);
            sum = sum + cell.moments();
        }
        sum
    }

    /// Cuts by what lies around.
    fn cut(&self, cell: &mut Cell, spokes: &[Vector]) {
        let topology = self.dual.topology();
        let is_rough = self.dual.local(self.seed).is_rough;
        for (h, &spoke) in topology.star(self.seed).zip(spokes) {
            cell.cut_by_bisector(spoke);
            if topology.is_fixed(h.next()) {
                cell.cut_by_line(spoke, self.beyond(h));
            } else if let Some(t) = topology.twin(h.next()).filter(|_| !is_rough) {
                // Not needed where every edge is Delaunay; where one is not, cells would overlap.
                cell.cut_by_bisector(self.image(topology.apex(t), 0.0));
            }
        }
    }

    /// The target of a half-edge from the seed.
    fn neighbour(&self, h: HalfEdge) -> Vector {
        let topology = self.dual.topology();
        self.image(topology.target(h), topology.length(h))
    }

    /// The apex of its face.
    fn beyond(&self, h: HalfEdge) -> Vector {
        let topology = self.dual.topology();
        self.image(topology.apex(h), topology.length(h.prev()))
    }

    fn image(&self, u: VertexId, length: f64) -> Vector {
        let local = self.dual.local(self.seed);
        let w = self.log(local, self.dual.offset(self.seed, u));
        // No expansion gives lengths in a rough field; quadrature does.
        if local.is_rough { w * (length / w.norm()) } else { w }
    }

    /// [`LocalMetric::log`] in the frame, whose inverses are known.
    fn log(&self, local: &LocalMetric, d: Vector) -> Vector {
        let ([_, b, _], [by_a, by_c]) = (self.frame, self.inverse);
        let (w, bend) = (to_frame(self.frame, d), local.bend(d) * 0.5);
        let x = bend.x * by_a;
        w + bounded(Vector::new(x, (bend.y - b * x) * by_c), w)
    }
}

/// A correction of a vector in an orthonormal frame, cut to a third of it as in [`LocalMetric::log`].
fn bounded(correction: Vector, w: Vector) -> Vector {
    let (square, limit) = (correction.dot(correction), w.dot(w) / 9.0);
    if square <= limit {
        correction
    } else if square.is_finite() {
        correction * (limit / square).sqrt()
    } else {
        Vector::default()
    }
}

/// The longest spoke.
fn width(spokes: &[Vector]) -> f64 {
    spokes.iter().map(|w| w.dot(*w)).fold(0.0, f64::max).sqrt()
}

/// The centre of the circle through the origin and two points.
fn centre(u: Vector, v: Vector) -> Vector {
    (u.perpendicular() * v.dot(v) - v.perpendicular() * u.dot(u)) * (0.5 / u.cross(v))
}

/// The angle from the first spoke to the last.
fn turn(spokes: &[Vector], last: Vector) -> f64 {
    let to = spokes.iter().copied().skip(1).chain([last]);
    spokes.iter().zip(to).map(|(a, b)| a.cross(b).arctangent_over(a.dot(b))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use crate::geometry::{Point, Tensor};
    use crate::manifold::domain::Domain;
    use crate::metric::{Scaled, Shock};
    use crate::progress::Silent;
    use crate::sampling::{Fill, Plan, Target, refine, sample_segments};

    #[test]
    fn the_cell_of_a_square_lattice_is_a_square() {
        let mut cell = Cell::default();
        cell.reset(10.0);
        for (x, y) in [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -3.0)] {
            cell.cut_by_bisector(Vector::new(x, y));
        }
        let moments = cell.moments();
        let c = moments.centroid();
        assert!(c.x.abs() < 1e-15 && (c.y + 0.5).abs() < 1e-15, "{c:?}");
        // A rectangle of 1 by 2 from y = -1.5 to 0.5.
        assert!((moments.mass - 2.0).abs() < 1e-15 && (moments.second - (1.0 / 6.0 + 3.5 / 3.0)).abs() < 1e-14);
        cell.cut_by_line(Vector::new(-5.0, -0.5), Vector::new(5.0, -0.5));
        assert!(cell.moments().centroid().norm() < 1e-15);
    }

    /// Seeds as refinement leaves them: of every third the cell is told by centres, and is the one that bisectors cut.
    #[test]
    fn corners_of_cells_are_centres_of_circles() {
        let domain = Domain::shape("rect:-1,-1,1,1").unwrap();
        let field = Shock { phi: 1.0, lambda: 0.6 };
        let plan = Plan::new(domain.clone(), Vec::new(), &field, Target::Vertices(400)).unwrap();
        let scaled = Scaled { field: &field, factor: plan.scale_for(400.0) };
        let mut dual = Dual::new(domain.corners(), scaled).unwrap();
        sample_segments(&mut dual, &plan.edges, &plan.arcs, scaled.factor, 0);
        refine(&mut dual, Fill::AtMost(400), &Silent).unwrap();
        dual.measure();
        let (mut told, mut seeds) = (0, 0);
        for v in dual.topology().vertices().filter(|&v| !dual.topology().is_border_vertex(v)) {
            let (view, mut cell) = (View::at(&dual, v), Cell::default());
            let spokes: Vec<Vector> = dual.topology().star(v).map(|h| view.neighbour(h)).collect();
            seeds += 1;
            if !view.is_by_centres(&mut cell, &spokes) {
                continue;
            }
            told += 1;
            let by_centres = cell.moments();
            cell.reset(width(&spokes));
            view.cut(&mut cell, &spokes);
            let by_cuts = cell.moments();
            let off = (by_centres.first - by_cuts.first).norm() + (by_centres.mass - by_cuts.mass).abs();
            assert!(off < 1e-9 && (by_centres.second - by_cuts.second).abs() < 1e-9, "{by_centres:?} {by_cuts:?}");
        }
        assert!(3 * told > seeds && seeds > 250, "{told} of {seeds}");
    }

    #[test]
    fn logarithms_in_the_frame_are_logarithms() {
        let domain = Domain::shape("rect:0,0,1,1").unwrap();
        let field = |p: Point| Tensor::new(4.0 + 3.0 * p.x, 0.5 * p.y, 3.0 - p.x + p.y);
        let dual = Dual::new(domain.corners(), Scaled { field: &field, factor: 1.0 }).unwrap();
        for v in dual.topology().vertices() {
            let (view, local) = (View::at(&dual, v), dual.local(v));
            for d in [Vector::new(0.3, 0.1), Vector::new(-2.0, 3.0), Vector::new(0.0, 1e-9)] {
                let (found, truth) = (view.log(local, d), to_frame(view.frame, local.log(d)));
                assert!((found - truth).norm() < 1e-13 * truth.norm(), "{found:?} {truth:?}");
            }
        }
    }

    #[test]
    fn half_planes_keep_what_is_left() {
        let mut cell = Cell::default();
        cell.reset(1.0);
        cell.keep_left_of(Vector::new(1.0, 0.0));
        let moments = cell.moments();
        assert!((moments.mass - 2.0).abs() < 1e-15 && (moments.centroid().y - 0.5).abs() < 1e-15);
        assert_eq!(Cell::default().moments().centroid(), Vector::default());
    }
}
