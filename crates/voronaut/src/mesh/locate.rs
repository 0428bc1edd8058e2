//! Where in a planar mesh a point is, and which triangles a box may meet.

use super::edges::NONE;
use super::{Edges, Mesh};
use crate::error::{Error, Result};
use crate::geometry::{Aabb, BoxTree, Point, Vector};
use crate::parallel::join;

/// The triangles of a planar mesh, ready for searches by any number of threads. Triangles may be oriented either way, overlap, or
/// have no area.
#[derive(Clone, Debug)]
pub(crate) struct Locator {
    faces: Vec<Face>,
    /// The boxes of pieces of triangles, with the triangles' numbers.
    pieces: BoxTree<u32, 2>,
}

/// A triangle, and those beyond its edges from corner i to the next; [`NONE`] at the border.
#[derive(Clone, Copy, Debug)]
struct Face {
    corners: [Point; 3],
    beyond: [u32; 3],
}

/// The point of a mesh that is nearest to a point: the point itself, if it is in the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Located {
    /// A triangle that holds the nearest point, by its number from 0.
    pub triangle: u32,
    /// Barycentric coordinates there of the nearest point: none is negative, their sum is one.
    pub weights: [f64; 3],
    /// How far the nearest point is (Euclidean); zero in the mesh.
    pub distance: f64,
}

/// Boxes may be so many times larger than their triangles before these are cut.
const ROOMY: f64 = 8.0;
/// A triangle is cut into so many pieces at most; all of them only so far that there are no more than so many for each in the mean,
/// or so many in all: of a few thousand needles each may be cut into hundreds.
const PIECES_OF_ONE: usize = 1024;
const PIECES: usize = 16;
const PIECES_IN_ALL: usize = 1 << 18;
/// Pieces of a triangle whose neighbourhood is looked for.
const PIECES_OF_QUERY: usize = 32;

/// Triangles that are walked through before the tree is asked: it costs about as much.
const STEPS: usize = 16;

impl Locator {
    /// The locator of a mesh that messages call `name`.
    ///
    /// # Errors
    /// [`Error::Domain`] where the mesh has no triangles, is not planar, not finite, or refers to vertices it does not have.
    pub(crate) fn new(mesh: &Mesh, name: &str) -> Result<Self> {
        Self::check(mesh, name)?;
        let corners: Vec<[Point; 3]> = mesh.triangles.iter().map(|&t| mesh.corners_of(t)).collect();
        let (pieces, twins) = join(|| pieces(&corners), || Edges::of(&mesh.triangles).twins());
        let across = |half_edge: &u32| if *half_edge == NONE { NONE } else { half_edge / 3 };
        let face = |(i, corners)| Face { corners, beyond: [0, 1, 2].map(|k| across(&twins[3 * i + k])) };
        Ok(Self { faces: corners.into_iter().enumerate().map(face).collect(), pieces })
    }

    /// Whether a mesh is planar, finite, and has triangles of vertices that exist; `name` is what messages call it.
    ///
    /// # Errors
    /// As for [`Locator::new`].
    pub(crate) fn check(mesh: &Mesh, name: &str) -> Result<()> {
        if let Some(i) = mesh.points.iter().position(|p| p[2] != 0.0 && p[2].is_finite()) {
            let (what, place) =
                (format!("z = {} is not zero", mesh.points[i][2]), format!("{} of {name}", mesh.describe(i)));
            return Err(Error::domain(what, place, "the mesh must lie in the plane z = 0"));
        }
        Self::check_numbers(mesh, name)
    }

    /// Whether a mesh of a surface is finite and has triangles of vertices that exist.
    ///
    /// # Errors
    /// As for [`Locator::new`].
    pub(crate) fn check_numbers(mesh: &Mesh, name: &str) -> Result<()> {
        if mesh.triangles.is_empty() {
            return Err(Error::domain(
                "no triangles",
                name,
                "give a mesh with triangles: values lie between its vertices",
            ));
        }
        if let Some(i) = mesh.points.iter().position(|p| !p.iter().all(|c| c.is_finite())) {
            let place = format!("{} of {name}", mesh.describe(i));
            return Err(Error::domain("a coordinate is not finite", place, "correct the mesh"));
        }
        let count = mesh.points.len();
        if let Some(i) = mesh.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= count)) {
            let what = format!("triangle {} refers to a vertex beyond the last, {count}", i + 1);
            return Err(Error::domain(what, name, "correct the mesh"));
        }
        mesh.demand_straight()
    }

    /// The point of the mesh that is nearest to `p`; `None` where `p` is not finite.
    pub(crate) fn locate(&self, p: Point) -> Option<Located> {
        if !p.is_finite() {
            // No box is farther than another: all would be looked into.
            return None;
        }
        let at = [p.x, p.y];
        let corners = |&triangle: &u32| self.faces[triangle as usize].corners;
        let located = |&triangle: &u32, (square, weights): (f64, [f64; 3])| Located {
            triangle,
            weights,
            distance: square.sqrt(),
        };
        // Mostly a triangle holds the point, and no distance is asked for.
        let mut around = self.pieces.meeting([at, at]);
        around.find_map(|piece| Some(located(piece, (0.0, weights_within(corners(piece), p)?)))).or_else(|| {
            let piece = self.pieces.nearest(at, |piece| nearest_point(corners(piece), p).0)?;
            Some(located(piece, nearest_point(corners(piece), p)))
        })
    }

    /// The same from a triangle that may be near: by walking, as far as that leads. Beyond the border the tree is asked for what is
    /// nearer than the triangle there.
    pub(crate) fn locate_from(&self, start: Option<u32>, p: Point) -> Option<Located> {
        let mut at = start.unwrap_or(NONE);
        for _ in 0..STEPS {
            let Some(&Face { corners, beyond }) = self.faces.get(at as usize) else { break };
            match within(corners, p) {
                Ok(weights) => return Some(Located { triangle: at, weights, distance: 0.0 }),
                Err(edge) if beyond[edge] == NONE && p.is_finite() => return Some(self.nearer_than(at, p)),
                Err(edge) => at = beyond[edge],
            }
        }
        self.locate(p)
    }

    /// The nearest point of the mesh, from a triangle that may have it.
    fn nearer_than(&self, triangle: u32, p: Point) -> Located {
        let found = |triangle: u32| nearest_point(self.faces[triangle as usize].corners, p);
        let nearer = self.pieces.nearer([p.x, p.y], found(triangle).0, |&piece| found(piece).0);
        let triangle = nearer.copied().unwrap_or(triangle);
        let (square, weights) = found(triangle);
        Located { triangle, weights, distance: square.sqrt() }
    }

    /// The corners of a triangle.
    pub(crate) fn corners(&self, triangle: u32) -> [Point; 3] {
        self.faces[triangle as usize].corners
    }

    /// Puts into `found` the numbers, ascending, of all triangles that meet the triangle `corners`, and of some that only pass
    /// near it.
    pub(crate) fn near(&self, corners: [Point; 3], found: &mut Vec<u32>) {
        found.clear();
        cut(corners, PIECES_OF_QUERY, &mut |piece| {
            found.extend(self.pieces.meeting(piece.into()).copied());
        });
        found.sort_unstable();
        found.dedup();
    }
}

/// The boxes of pieces of triangles.
fn pieces(triangles: &[[Point; 3]]) -> BoxTree<u32, 2> {
    let mut found: Vec<(Aabb, u32)> = Vec::with_capacity(triangles.len());
    let most = most_pieces(triangles);
    for (i, &triangle) in (0..).zip(triangles) {
        cut(triangle, most, &mut |piece| found.push((piece, i)));
    }
    BoxTree::new(found.into_iter().map(|(piece, triangle)| (piece.into(), triangle)))
}

/// Into how many pieces one triangle may be cut, so that there are not too many.
fn most_pieces(triangles: &[[Point; 3]]) -> usize {
    let wanted: Vec<usize> = triangles.iter().map(|&corners| wanted_pieces(corners)).collect();
    let allowed = (PIECES * triangles.len()).max(PIECES_IN_ALL);
    let is_allowed = |most: &usize| wanted.iter().map(|&count| count.min(*most)).sum::<usize>() <= allowed;
    std::iter::successors(Some(PIECES_OF_ONE), |most| Some(most / 2))
        .take_while(|&most| most > 1)
        .find(is_allowed)
        .unwrap_or(1)
}

/// Into how many pieces a triangle has to be cut for their boxes together not to be too roomy.
fn wanted_pieces(corners: [Point; 3]) -> usize {
    let [a, b, c] = corners;
    let extent = Aabb::of(corners).map_or(Vector::default(), |whole| whole.extent());
    let roomy = extent.x * extent.y / (0.5 * ROOMY * (b - a).cross(c - a).abs());
    // Not a number where there is no extent: one piece.
    (roomy.ceil() as usize).clamp(1, PIECES_OF_ONE)
}

/// Calls back with boxes that hold a triangle together: one, or, where that would be much larger than the triangle, those of so many
/// slices across its longest side, whose boxes are as much smaller. Without that the boxes of needles overlap, and a search
/// looks into hundreds.
fn cut(corners: [Point; 3], most: usize, found: &mut impl FnMut(Aabb)) {
    let Some(whole) = Aabb::of(corners) else { return };
    let count = wanted_pieces(corners).min(most);
    if count == 1 {
        return found(whole);
    }
    let [a, b, c] = corners;
    let sides = [(a, b, c), (b, c, a), (c, a, b)];
    let (p, q, apex) =
        sides.into_iter().max_by(|s, t| s.0.distance(s.1).total_cmp(&t.0.distance(t.1))).unwrap_or((a, b, c));
    let at_apex = ((apex - p).dot(q - p) / (q - p).dot(q - p)).clamp(0.0, 1.0);
    let section = |t: f64| {
        let other = match t {
            _ if t < at_apex => p.lerp(apex, t / at_apex),
            _ if t > at_apex => apex.lerp(q, (t - at_apex) / (1.0 - at_apex)),
            _ => apex,
        };
        [p.lerp(q, t), other]
    };
    for slice in 0..count {
        let [from, to] = [slice, slice + 1].map(|i| i as f64 / count as f64);
        let holds_apex = (from..=to).contains(&at_apex).then_some(apex);
        if let Some(slice) = Aabb::of(section(from).into_iter().chain(section(to)).chain(holds_apex)) {
            found(padded(slice));
        }
    }
}

/// A box and what rounding may have left out.
fn padded(b: Aabb) -> Aabb {
    let pad = |low: f64, high: f64| 4.0 * f64::EPSILON * low.abs().max(high.abs());
    let by = Vector::new(pad(b.min.x, b.max.x), pad(b.min.y, b.max.y));
    Aabb { min: b.min - by, max: b.max + by }
}

/// The barycentric coordinates of `p` in a triangle of either orientation that holds it.
fn weights_within(corners: [Point; 3], p: Point) -> Option<[f64; 3]> {
    within(corners, p).ok()
}

/// The same, or the edge, from its corner of this number to the next, that `p` is farthest beyond.
fn within([a, b, c]: [Point; 3], p: Point) -> std::result::Result<[f64; 3], usize> {
    let areas = [(b - p).cross(c - p), (c - p).cross(a - p), (a - p).cross(b - p)];
    let total: f64 = areas.iter().sum();
    if total != 0.0 && areas.iter().all(|area| area * total >= 0.0) {
        return Ok(areas.map(|area| area / total));
    }
    let [bc, ca, ab] = areas.map(|area| area * total);
    Err(if ab <= bc && ab <= ca {
        0
    } else if bc <= ca {
        1
    } else {
        2
    })
}

/// Squared distance of `p` to a triangle of either orientation, even without area, and the barycentric coordinates
/// of the nearest point.
fn nearest_point(corners: [Point; 3], p: Point) -> (f64, [f64; 3]) {
    weights_within(corners, p).map_or_else(|| p.nearest_on_sides(corners), |weights| (0.0, weights))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_of_needles_hold_them_and_are_counted() {
        for width in [0.5, 0.05, 1e-3, 1e-6] {
            let (a, b) = (Point::new(3.0, -1.0), Point::new(4.0, 0.0));
            for apex in [b + Vector::new(-width, width), a.lerp(b, 0.3) + Vector::new(-width, width)] {
                let mut boxes = Vec::new();
                cut([a, b, apex], 1024, &mut |piece| boxes.push(piece));
                assert_eq!(boxes.len(), wanted_pieces([a, b, apex]));
                for i in 0..200 {
                    let u = (f64::from(i) * 0.618).fract();
                    let v = (1.0 - u) * (f64::from(i) * 0.414).fract();
                    let p = a + (b - a) * u + (apex - a) * v;
                    let holds = |piece: &Aabb| {
                        piece.min.x <= p.x && p.x <= piece.max.x && piece.min.y <= p.y && p.y <= piece.max.y
                    };
                    assert!(boxes.iter().any(holds), "{width} {p}");
                }
            }
        }
    }
    use proptest::prelude::*;

    /// Triangles at random: of any shape, overlapping, some without area.
    fn triangles() -> impl Strategy<Value = Mesh> {
        let corner = (0.0..1.0, 0.0..1.0);
        let size = prop_oneof![Just(0.0), 0.0..1.0];
        prop::collection::vec((corner.clone(), (-0.2..0.2, -0.2..0.2), (-0.2..0.2, -0.2..0.2), size), 1..40).prop_map(
            |all| {
                let mut mesh = Mesh::default();
                for ((x, y), u, v, size) in all {
                    let first = mesh.points.len() as u32;
                    mesh.points.extend([[x, y, 0.0], [x + u.0, y + u.1, 0.0], [x + size * v.0, y + size * v.1, 0.0]]);
                    mesh.triangles.push([first, first + 1, first + 2]);
                }
                mesh
            },
        )
    }

    proptest! {
        #[test]
        fn location_agrees_with_brute_force(mesh in triangles(), x in -0.5..1.5, y in -0.5..1.5) {
            let locator = Locator::new(&mesh, "it").unwrap();
            let p = Point::new(x, y);
            let squares = mesh.triangles.iter().map(|&t| nearest_point(mesh.corners_of(t), p).0);
            let truth = squares.fold(f64::INFINITY, f64::min).sqrt();
            let found = locator.locate(p).unwrap();
            let [a, b, c] = mesh.corners_of(mesh.triangles[found.triangle as usize]);
            let w = found.weights;
            let q = Point::new(a.x * w[0] + b.x * w[1] + c.x * w[2], a.y * w[0] + b.y * w[1] + c.y * w[2]);
            prop_assert!((p.distance(q) - truth).abs() < 1e-13 && (found.distance - truth).abs() < 1e-14);
            prop_assert!(w.iter().all(|w| *w >= 0.0) && (w.iter().sum::<f64>() - 1.0).abs() < 1e-14);
        }

        #[test]
        fn walks_end_where_the_point_is(mesh in triangles(), x in -0.5..1.5, y in -0.5..1.5, start in 0..50_u32) {
            let locator = Locator::new(&mesh, "it").unwrap();
            let p = Point::new(x, y);
            let found = locator.locate_from(Some(start), p).unwrap();
            prop_assert!((found.distance - locator.locate(p).unwrap().distance).abs() < 1e-14);
            let [a, b, c] = mesh.corners_of(mesh.triangles[found.triangle as usize]);
            let q = Point::default() + [a, b, c].iter().zip(found.weights).fold(Vector::default(), |sum, (corner, w)| {
                sum + (*corner - Point::default()) * w
            });
            prop_assert!((p.distance(q) - found.distance).abs() < 1e-13);
        }

        #[test]
        fn triangles_that_hold_a_point_of_a_triangle_are_near_it(mesh in triangles(), r in 0.0..1.0, s in 0.0..1.0) {
            let locator = Locator::new(&mesh, "it").unwrap();
            let [a, b, c] = mesh.corners_of(mesh.triangles[0]);
            let p = a.lerp(b, r).lerp(c, s);
            let mut near = Vec::new();
            locator.near([a, b, c], &mut near);
            for (i, &t) in mesh.triangles.iter().enumerate() {
                prop_assert!(near.contains(&(i as u32)) || nearest_point(mesh.corners_of(t), p).0 > 0.0);
            }
        }
    }
}
