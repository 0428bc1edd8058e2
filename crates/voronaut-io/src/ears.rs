//! Polygons in space, seen flat; their triangles by cutting off ears (Meisters 1975), those of the best shape first.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use voronaut::geometry::{Point, Point3, Vector3, signed_area};

/// A polygon seen from the side that it turns left on, near the origin and about as large as one.
pub(super) struct Seen {
    /// Its corners in the coordinate plane that it is most parallel to, as exact as the file has them.
    pub(super) flat: Vec<Point>,
    corners: Vec<Vector3>,
    normal: Option<Vector3>,
}

impl Seen {
    pub(super) fn new(points: &[[f64; 3]], polygon: &[u32]) -> Self {
        let position = |&v: &u32| Point3::from(points[v as usize]);
        let origin = polygon.first().map_or(Point3::default(), position);
        let mut corners: Vec<Vector3> = polygon.iter().map(|v| position(v) - origin).collect();
        let size = corners.iter().map(|c| c.x.abs().max(c.y.abs()).max(c.z.abs())).fold(f64::MIN_POSITIVE, f64::max);
        for corner in &mut corners {
            *corner = *corner * (1.0 / size);
        }
        // Newell's normal: of the polygon's shadows on the coordinate planes it is the areas.
        let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
        let area = pairs.fold(Vector3::new(0.0, 0.0, 0.0), |sum, (&a, &b)| sum + a.cross(b));
        let flat = polygon.iter().map(|v| flattened(points[*v as usize], area)).collect();
        Self { flat, corners, normal: area.unit() }
    }

    /// How good the triangle of three corners is: 1 if it is equilateral and upright, 0 without area, below that turned round.
    pub(super) fn shape(&self, triangle: [u32; 3]) -> f64 {
        let [a, b, c] = triangle.map(|i| self.corners[i as usize]);
        let (sides, area) = ([b - a, c - b, a - c], (b - a).cross(c - a));
        let squares: f64 = sides.iter().map(|side| side.dot(*side)).sum();
        let area = self.normal.map_or_else(|| area.norm(), |normal| area.dot(normal));
        if squares > 0.0 { 2.0 * 3.0_f64.sqrt() * area / squares } else { 0.0 }
    }
}

/// A point without the coordinate along which the area is largest; to the left stays to the left.
fn flattened([x, y, z]: [f64; 3], area: Vector3) -> Point {
    let [along_x, along_y, along_z] = [area.x.abs(), area.y.abs(), area.z.abs()];
    let (u, v, sign) = if along_x > along_y && along_x > along_z {
        (y, z, area.x)
    } else if along_y > along_z {
        (z, x, area.y)
    } else {
        (x, y, area.z)
    };
    if sign < 0.0 { Point::new(v, u) } else { Point::new(u, v) }
}

/// A polygon whose ears are cut off one by one.
pub(super) struct Ears<'a> {
    seen: &'a Seen,
    /// The corners beside each one, of those that are left.
    before: Vec<u32>,
    after: Vec<u32>,
    /// How often a corner's neighbours changed; `GONE` of one that was cut off.
    changes: Vec<u32>,
    /// All corners, from left to right; only those that are not convex can be in the way of an ear.
    sorted: Vec<u32>,
    is_convex: Vec<bool>,
    /// Candidates: shape, corner, and the corner's changes when that was found.
    candidates: BinaryHeap<(i64, Reverse<u32>, u32)>,
}

const GONE: u32 = u32::MAX;

/// So often all corners are looked at again once no ear is known; what is left then is cut into a fan. A simple polygon takes a
/// few, and one that crosses itself could take as many as it has corners.
const MOST_ROUNDS: usize = 64;

impl<'a> Ears<'a> {
    /// The triangles of a polygon of three or more corners, by their numbers.
    pub(super) fn cut(seen: &'a Seen) -> Vec<[u32; 3]> {
        let mut ears = Self::new(seen);
        let mut triangles = Vec::with_capacity(seen.flat.len().saturating_sub(2));
        let mut first = 0;
        for _ in 0..MOST_ROUNDS {
            let before = triangles.len();
            ears.refill(first);
            while triangles.len() + 3 < seen.flat.len() {
                let Some(ear) = ears.next_ear() else { break };
                triangles.push(ears.corners(ear));
                first = ears.cut_off(ear);
            }
            if triangles.len() + 3 >= seen.flat.len() {
                break;
            }
            if triangles.len() == before {
                // No ear: the polygon crosses or touches itself.
                let best = ears.left(first).max_by_key(|&i| (ears.shape(i), Reverse(i))).unwrap_or(first);
                triangles.push(ears.corners(best));
                first = ears.cut_off(best);
            }
        }
        let rest: Vec<u32> = ears.left(first).collect();
        triangles.extend(rest[1..].windows(2).map(|pair| [rest[0], pair[0], pair[1]]));
        triangles
    }

    fn new(seen: &'a Seen) -> Self {
        let count = seen.flat.len() as u32;
        let mut sorted: Vec<u32> = (0..count).collect();
        sorted.sort_by(|&i, &j| seen.flat[i as usize].x.total_cmp(&seen.flat[j as usize].x));
        let mut ears = Self {
            seen,
            before: (0..count).map(|i| (i + count - 1) % count).collect(),
            after: (0..count).map(|i| (i + 1) % count).collect(),
            changes: vec![0; count as usize],
            sorted,
            is_convex: vec![false; count as usize],
            candidates: BinaryHeap::new(),
        };
        (0..count).for_each(|i| ears.is_convex[i as usize] = ears.turns_left(i));
        ears
    }

    fn corners(&self, i: u32) -> [u32; 3] {
        [self.before[i as usize], i, self.after[i as usize]]
    }

    fn turns_left(&self, i: u32) -> bool {
        let [a, b, c] = self.corners(i).map(|j| self.seen.flat[j as usize]);
        signed_area(a, b, c) > 0.0
    }

    /// The shape of the triangle at a corner, in steps that rounding does not see.
    fn shape(&self, i: u32) -> i64 {
        const STEPS: f64 = 1e9;
        (self.seen.shape(self.corners(i)) * STEPS) as i64
    }

    /// The corners that are left, from one of them on.
    fn left(&self, first: u32) -> impl Iterator<Item = u32> + '_ {
        let next = move |&i: &u32| Some(self.after[i as usize]).filter(|&next| next != first);
        std::iter::successors(Some(first), next)
    }

    fn refill(&mut self, first: u32) {
        self.candidates.clear();
        for i in self.left(first).collect::<Vec<u32>>() {
            self.push(i);
        }
    }

    fn push(&mut self, i: u32) {
        if self.is_convex[i as usize] {
            self.candidates.push((self.shape(i), Reverse(i), self.changes[i as usize]));
        }
    }

    /// The best ear that is known; what proves to be none is left out until all are looked at again.
    fn next_ear(&mut self) -> Option<u32> {
        while let Some((_, Reverse(i), changes)) = self.candidates.pop() {
            if self.changes[i as usize] == changes && self.is_free(i) {
                return Some(i);
            }
        }
        None
    }

    /// Whether no other corner lies in the triangle at this one, or on its sides; those at the place of its own do not count, for
    /// there the polygon touches itself.
    fn is_free(&self, i: u32) -> bool {
        let flat = |j: u32| self.seen.flat[j as usize];
        let triangle = self.corners(i).map(flat);
        let [a, b, c] = triangle;
        let (least, most) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
        let start = self.sorted.partition_point(|&j| flat(j).x < least);
        let near = self.sorted[start..].iter().take_while(|&&j| flat(j).x <= most);
        let mut blunt = near.filter(|&&j| !self.is_convex[j as usize] && self.changes[j as usize] != GONE);
        !blunt.any(|&j| {
            let p = flat(j);
            let is_corner = triangle.contains(&p);
            !is_corner && [[a, b], [b, c], [c, a]].iter().all(|&[from, to]| signed_area(from, to, p) >= 0.0)
        })
    }

    /// Cuts off the triangle at a corner, and gives the corner behind it.
    fn cut_off(&mut self, i: u32) -> u32 {
        let [before, _, after] = self.corners(i);
        (self.after[before as usize], self.before[after as usize]) = (after, before);
        self.changes[i as usize] = GONE;
        for neighbour in [before, after] {
            self.changes[neighbour as usize] += 1;
            self.is_convex[neighbour as usize] = self.turns_left(neighbour);
            self.push(neighbour);
        }
        after
    }
}
