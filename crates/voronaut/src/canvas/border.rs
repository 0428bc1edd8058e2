//! The border of the domain as an obstacle to paths.

use super::Canvas;
use crate::geodesic::Obstacles;
use crate::geometry::{Aabb, BoxTree, Orientation, Point, around, orientation, widened};
use crate::triangulation::HalfEdge;

/// The sides of a canvas's border, and the corners around which paths can bend.
pub(crate) struct Border<'a> {
    canvas: &'a Canvas,
    /// The domain is on their left.
    sides: BoxTree<[Point; 2], 2>,
    corners: BoxTree<Point, 2>,
    /// Distances below this are rounding.
    rounding: f64,
}

/// Rounding, as a share of the domain's extent.
const ROUNDING: f64 = 1e-10;

impl<'a> Border<'a> {
    /// The border of a canvas; work in proportion to its faces.
    pub(crate) fn of(canvas: &'a Canvas) -> Self {
        let embedded = canvas.embedded();
        let topology = &embedded.topology;
        let borders = || topology.borders();
        let sides = BoxTree::new(borders().map(|h| embedded.ends(h)).map(|side| (around(side), side)));
        let corners = BoxTree::new(borders().filter_map(|h| reflex(canvas, h)).map(|p| (around([p, p]), p)));
        let extent = Aabb::of(embedded.positions.iter().copied()).map_or(0.0, |b| b.extent().norm());
        Self { canvas, sides, corners, rounding: ROUNDING * extent }
    }

    /// How far left of a side a point lies.
    fn beside([from, to]: [Point; 2], p: Point) -> f64 {
        let along = to - from;
        along.cross(p - from) / along.norm()
    }

    fn crosses(&self, side: [Point; 2], p: Point, q: Point) -> bool {
        let [dp, dq] = [p, q].map(|x| Self::beside(side, x));
        if dp.min(dq) > -self.rounding || dp.max(dq) < self.rounding {
            return false;
        }
        let along = side[1] - side[0];
        let at = (p.lerp(q, dp / (dp - dq)) - side[0]).dot(along) / along.dot(along);
        (-ROUNDING..=1.0 + ROUNDING).contains(&at)
    }
}

/// The start of a side of the border if the domain's angle there is more than straight.
fn reflex(canvas: &Canvas, h: HalfEdge) -> Option<Point> {
    let topology = &canvas.embedded().topology;
    let v = topology.origin(h);
    let last = topology.star(v).last()?;
    let before = canvas.position(topology.apex(last));
    let [at, after] = canvas.embedded().ends(h);
    (orientation(before, at, after) == Orientation::Right).then_some(at)
}

impl Obstacles for Border<'_> {
    fn bars(&self, p: Point, q: Point) -> bool {
        // Wide enough to notice the side that a segment starts just outside of: step by step it would walk away.
        let near = widened(around([p, q]), 2.0 * self.rounding);
        let mut is_near = false;
        for &side in self.sides.meeting(near) {
            if self.crosses(side, p, q) {
                return true;
            }
            is_near = true;
        }
        // A segment that starts on the border crosses nothing on its way out.
        let middle = p.midpoint(q);
        let is_beside = |&[a, b]: &[Point; 2]| middle.distance(middle.nearest_between(a, b)) <= self.rounding;
        is_near && self.canvas.locate(middle).is_none() && !self.sides.meeting(near).any(is_beside)
    }

    fn corner_between(&self, from: [Point; 2], to: [Point; 2]) -> Option<Point> {
        let bounds = Aabb::of(from.into_iter().chain(to))?;
        let holds = |[a, b, c]: [Point; 3], p: Point| {
            let sides = [(a, b), (b, c), (c, a)].map(|(u, v)| (v - u).cross(p - u));
            sides.iter().all(|&s| s >= 0.0) || sides.iter().all(|&s| s <= 0.0)
        };
        let swept =
            [[from[0], from[1], to[1]], [from[0], to[1], to[0]], [from[0], from[1], to[0]], [from[1], to[1], to[0]]];
        let inside =
            self.corners.meeting(bounds.into()).copied().filter(|&p| swept.iter().any(|&triangle| holds(triangle, p)));
        let height = |p: Point| (from[1] - from[0]).cross(p - from[0]).abs();
        inside.min_by(|&p, &q| height(p).total_cmp(&height(q)).then(p.x.total_cmp(&q.x)).then(p.y.total_cmp(&q.y)))
    }
}
