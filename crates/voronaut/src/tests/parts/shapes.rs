//! Parts of a few faces, and solids pulled out of a profile.

use super::Part;
use super::patches::{Flat, Grain, Plane, Sewing};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use voronaut::geometry::{Point3, Vector3};

const X: Vector3 = Vector3::new(1.0, 0.0, 0.0);
const Y: Vector3 = Vector3::new(0.0, 1.0, 0.0);
const Z: Vector3 = Vector3::new(0.0, 0.0, 1.0);

/// The unit cube with so many edges along each side of a face; labels 1 to 6.
pub(crate) fn cube(count: usize) -> Part {
    let mut sewing = Sewing::new(Grain { edge: 1.0 / count as f64, is_cad: false });
    let (low, high) = (Point3::default(), Point3::new(1.0, 1.0, 1.0));
    let faces = [(low, [Y, X]), (low, [Z, Y]), (low, [X, Z]), (high, [-X, -Y]), (high, [-Y, -Z]), (high, [-Z, -X])];
    for (label, (origin, axes)) in (1..).zip(faces) {
        let outline = polygon(&sewing.grain, &[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        sewing.patch(label, &[outline], |p| Plane { origin, axes }.at(p));
    }
    Part::new("cube", sewing.finish(), 0.0)
}

/// z = 0.2 sin(3 x) cos(2 y) over an L with a round hole: sides of the L are labelled 1 to 6, the hole 7.
pub(crate) fn patch() -> Part {
    let sheet = |[x, y]: Flat| Point3::new(x, y, 0.2 * (3.0 * x).sin() * (2.0 * y).cos());
    let grain = Grain { edge: 0.06, is_cad: false };
    let mut sewing = Sewing::new(grain);
    let corners = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let hole: Vec<Flat> =
        grain.angles(0.25, 0.0, TAU).iter().map(|t| [0.5 + 0.25 * t.cos(), 0.5 + 0.25 * t.sin()]).collect();
    sewing.patch(1, &[polygon(&grain, &corners), hole.clone()], sheet);
    let sides = (0..6)
        .map(|i| grain.line(corners[i], corners[(i + 1) % 6]).into_iter().chain([corners[(i + 1) % 6]]).collect());
    let around: Vec<Flat> = hole.iter().chain(&hole[..1]).copied().collect();
    for (label, curve) in (1..).zip(sides.chain([around])) {
        let curve: Vec<Flat> = curve;
        for pair in curve.windows(2) {
            sewing.mark_edge([sheet(pair[0]), sheet(pair[1])], label);
        }
    }
    for corner in corners {
        sewing.mark_corner(sheet(corner));
    }
    // Second derivatives are at most 0.2 * 3^2.
    Part::new("patch", sewing.finish(), 1.8)
}

/// The unit sphere of materials 1 and 2, which meet a quarter of sin(3 theta) above and below the equator.
pub(crate) fn two() -> Part {
    let grain = Grain { edge: 0.09, is_cad: false };
    let mut sewing = Sewing::new(grain);
    for (label, side) in [(1, 1.0), (2, -1.0)] {
        // The plane is Lambert's azimuthal projection from a pole: areas are kept. The map turns over with the pole.
        let onto = |[a, b]: Flat| {
            let (polar, theta) = (2.0 * (0.5 * a.hypot(b)).min(1.0).asin(), (side * b).atan2(a));
            Point3::new(polar.sin() * theta.cos(), polar.sin() * theta.sin(), side * polar.cos())
        };
        let wave = |theta: &f64| {
            let rho = 2.0 * (0.5 * (FRAC_PI_2 - side * 0.25 * (3.0 * theta).sin())).sin();
            [rho * theta.cos(), side * rho * theta.sin()]
        };
        let outline = grain.angles(1.2, 0.0, TAU).iter().map(wave).collect();
        sewing.patch(label, &[outline], onto);
    }
    Part::new("two", sewing.finish(), 1.0)
}

/// A wedge that opens by ten degrees from its sharp edge along y, with a thin rim along its back; bent by a shear along z.
pub(crate) fn blade() -> Part {
    let (thick, thin) = ((PI / 36.0).tan(), 0.01);
    let corners = [[0.0, 0.0], [1.0, -thick], [1.0, -thin], [1.6, -thin], [1.6, thin], [1.0, thin], [1.0, thick]];
    let mut sewing = Sewing::new(Grain { edge: 0.06, is_cad: false });
    let bend = |p: Point3| Point3::new(p.x, p.y, p.z + 0.1 * (2.0 * p.y).sin());
    let count = corners.len();
    let pieces: Vec<Piece> = (0..count).map(|i| Piece::Line(corners[i], corners[(i + 1) % count])).collect();
    Extrusion { depth: 2.0, pieces: &pieces, bend: &bend }.sew(&mut sewing, |_| Vec::new(), |_| Vec::new());
    Part::new("blade", sewing.finish(), 0.4)
}

/// The outline through corners.
pub(crate) fn polygon(grain: &Grain, corners: &[Flat]) -> Vec<Flat> {
    let count = corners.len();
    (0..count).flat_map(|i| grain.line(corners[i], corners[(i + 1) % count])).collect()
}

/// A piece of a profile in the plane of x and z.
#[derive(Clone, Copy)]
pub(crate) enum Piece {
    Line(Flat, Flat),
    /// About a centre, with a radius, from an angle to another.
    Arc(Flat, f64, [f64; 2]),
}

impl Piece {
    pub(crate) fn length(&self) -> f64 {
        match *self {
            Piece::Line(a, b) => (b[0] - a[0]).hypot(b[1] - a[1]),
            Piece::Arc(_, radius, [from, to]) => radius * (to - from).abs(),
        }
    }

    fn at(&self, u: f64) -> Flat {
        let s = u / self.length();
        match *self {
            Piece::Line(a, b) => {
                [0, 1].map(|k| if (b[k] - a[k]).abs() <= 0.0 { a[k] } else { a[k] + (b[k] - a[k]) * s })
            }
            Piece::Arc(c, r, [from, to]) => {
                let angle = from + (to - from) * s;
                [c[0] + r * angle.cos(), c[1] + r * angle.sin()]
            }
        }
    }

    fn place(&self, u: f64, y: f64) -> Point3 {
        let [x, z] = self.at(u);
        Point3::new(x, y, z)
    }

    /// How far along it vertices are, without the last.
    fn samples(&self, grain: &Grain) -> Vec<f64> {
        match *self {
            Piece::Line(..) => grain.line([0.0, 0.0], [self.length(), 0.0]).iter().map(|p| p[0]).collect(),
            Piece::Arc(_, r, [from, to]) => grain.angles(r, from, to).iter().map(|t| r * (t - from).abs()).collect(),
        }
    }
}

/// A profile, anticlockwise in x and z, drawn out from y = 0 to its depth, then bent.
pub(crate) struct Extrusion<'a> {
    pub(crate) depth: f64,
    pub(crate) pieces: &'a [Piece],
    pub(crate) bend: &'a dyn Fn(Point3) -> Point3,
}

impl Extrusion<'_> {
    /// Adds its faces: label i + 1 for piece i, with these holes in the face's plane, then those of the ends with theirs.
    pub(crate) fn sew(
        &self,
        sewing: &mut Sewing,
        holes: impl Fn(usize) -> Vec<Vec<Flat>>,
        ends: impl Fn(usize) -> Vec<Vec<Flat>>,
    ) {
        let grain = sewing.grain;
        for ((i, label), piece) in (0..).zip(1..).zip(self.pieces) {
            let (l, d) = (piece.length(), self.depth);
            let along = piece.samples(&grain);
            let near = along.iter().map(|&u| [u, 0.0]);
            // The way back passes the same samples, end first.
            let far = along.iter().skip(1).rev().map(|&u| [u, d]).chain([[0.0, d]]);
            let mut outline: Vec<Flat> = near.collect();
            outline.extend(grain.line([l, 0.0], [l, d]));
            outline.push([l, d]);
            outline.extend(far.take(along.len()));
            outline.extend(grain.line([0.0, d], [0.0, 0.0]).into_iter().skip(1));
            let outlines: Vec<_> = [outline].into_iter().chain(holes(i)).collect();
            let at = |[u, v]: Flat| (self.bend)(piece.place(u, d - v));
            match piece {
                Piece::Line(..) => sewing.patch(label, &outlines, at),
                Piece::Arc(..) => sewing.straight_patch(label, &outlines, at),
            }
        }
        let profile: Vec<Flat> =
            self.pieces.iter().flat_map(|piece| piece.samples(&grain).into_iter().map(|u| piece.at(u))).collect();
        let label = 1 + (self.pieces.len() as u32).cast_signed();
        let outlines: Vec<_> = [profile.clone()].into_iter().chain(ends(0)).collect();
        sewing.patch(label, &outlines, |[x, z]| (self.bend)(Point3::new(x, 0.0, z)));
        let swapped: Vec<Flat> = profile.iter().map(|&[x, z]| [z, x]).collect();
        let outlines: Vec<_> = [swapped].into_iter().chain(ends(1)).collect();
        sewing.patch(label + 1, &outlines, |[z, x]| (self.bend)(Point3::new(x, self.depth, z)));
    }
}
