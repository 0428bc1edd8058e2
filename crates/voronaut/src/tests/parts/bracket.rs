//! A bracket: an L drawn out, rounded inside and outside its bend, with a hole through each arm, and a boss on its foot from
//! which a pipe leaves sideways.

use super::patches::{Flat, Grain, Plane, Sewing};
use super::shapes::{Extrusion, Piece};
use std::f64::consts::{PI, TAU};
use voronaut::geometry::{Point3, Vector3};
use voronaut::mesh::Mesh;

/// The greatest curvature: that of the holes and the pipe.
pub(crate) const CURVATURE: f64 = 4.0;

/// Evenly cut up, about 9,000 triangles.
pub(crate) fn even() -> Mesh {
    sewn(Grain { edge: 0.08, is_cad: false })
}

/// As exporters do it: vertices on curves alone.
pub(crate) fn cad() -> Mesh {
    sewn(Grain { edge: 0.015, is_cad: true })
}

const X: Vector3 = Vector3::new(1.0, 0.0, 0.0);
const Y: Vector3 = Vector3::new(0.0, 1.0, 0.0);
const Z: Vector3 = Vector3::new(0.0, 0.0, 1.0);

const DEPTH: f64 = 2.0;
/// A face's v is measured from y = DEPTH down.
const FOOT: f64 = 0.6;
/// The hole through the foot, along z, and the one through the upright, along x.
const HOLE: Tube = Tube { centre: Point3::new(2.5, 0.4, 0.0), frame: [Y, X, Z], radius: 0.25 };
const PASSAGE: Tube = Tube { centre: Point3::new(0.0, 1.0, 1.6), frame: [Z, Y, X], radius: 0.3 };
/// The boss, whose seam is opposite the pipe, and the pipe, along y.
const BOSS: Tube =
    Tube { centre: Point3::new(1.8, 1.2, 0.0), frame: [Vector3::new(0.0, -1.0, 0.0), X, Z], radius: 0.5 };
const PIPE: Tube = Tube { centre: Point3::new(1.8, 1.2, 1.05), frame: [Z, X, Y], radius: 0.25 };
const BOSS_TOP: f64 = 1.5;
const PIPE_END: f64 = 1.0;

/// A cylinder about an axis through a point; (first, second, axis) turns right where its outside is out, else left.
#[derive(Clone, Copy)]
struct Tube {
    centre: Point3,
    frame: [Vector3; 3],
    radius: f64,
}

impl Tube {
    fn at(&self, angle: f64, along: f64) -> Point3 {
        let [e, f, axis] = self.frame;
        self.centre + e * (self.radius * angle.cos()) + f * (self.radius * angle.sin()) + axis * along
    }

    /// Angles of its rims' vertices, without the last.
    fn angles(&self, grain: &Grain) -> Vec<f64> {
        grain.angles(self.radius, 0.0, TAU)
    }

    fn rim(&self, grain: &Grain, along: f64) -> Vec<Point3> {
        self.angles(grain).into_iter().map(|t| self.at(t, along)).collect()
    }

    /// Adds its wall between two curves around, given by how far along the axis they are at an angle.
    fn sew(&self, sewing: &mut Sewing, label: i32, [low, high]: [&dyn Fn(f64) -> f64; 2], holes: Vec<Vec<Flat>>) {
        let grain = sewing.grain;
        let (r, angles) = (self.radius, self.angles(&grain));
        let end = r * TAU;
        let mut outline: Vec<Flat> = angles.iter().map(|&t| [r * t, low(t)]).collect();
        outline.extend(grain.line([end, low(0.0)], [end, high(0.0)]));
        outline.push([end, high(0.0)]);
        outline.extend(angles.iter().rev().map(|&t| [r * t, high(t)]));
        outline.extend(grain.line([0.0, high(0.0)], [0.0, low(0.0)]).into_iter().skip(1));
        let outlines: Vec<_> = [outline].into_iter().chain(holes).collect();
        sewing.straight_patch(label, &outlines, |[u, v]| self.at(u / r, v));
    }
}

/// How far along the pipe the boss ends: |(x, y) - axis of the boss| is its radius.
fn pipe_start(angle: f64) -> f64 {
    let x = PIPE.radius * angle.sin();
    (BOSS.radius * BOSS.radius - x * x).sqrt()
}

/// A point of the pipe's first curve on the boss, unrolled.
fn on_boss(angle: f64) -> Flat {
    let p = PIPE.at(angle, pipe_start(angle)) - BOSS.centre;
    let [e, f, axis] = BOSS.frame;
    [BOSS.radius * f.dot(p).atan2(e.dot(p)).rem_euclid(TAU), axis.dot(p)]
}

fn sewn(grain: Grain) -> Mesh {
    let mut sewing = Sewing::new(grain);
    let profile = [
        Piece::Line([0.4, 0.0], [3.0, 0.0]),
        Piece::Line([3.0, 0.0], [3.0, FOOT]),
        Piece::Line([3.0, FOOT], [0.9, FOOT]),
        Piece::Arc([0.9, 0.9], 0.3, [1.5 * PI, PI]),
        Piece::Line([0.6, 0.9], [0.6, 2.2]),
        Piece::Line([0.6, 2.2], [0.0, 2.2]),
        Piece::Line([0.0, 2.2], [0.0, 0.4]),
        Piece::Arc([0.4, 0.4], 0.4, [PI, 1.5 * PI]),
    ];
    let plane = |origin: Point3, along: Vector3| Plane { origin, axes: [along, -Y] };
    let flat = |plane: Plane, curve: Vec<Point3>| curve.into_iter().map(|p| plane.flatten(p)).collect::<Vec<_>>();
    let holes = |piece: usize| match piece {
        0 => vec![flat(plane(Point3::new(0.4, DEPTH, 0.0), X), HOLE.rim(&grain, 0.0))],
        2 => {
            let top = plane(Point3::new(3.0, DEPTH, FOOT), -X);
            vec![flat(top, HOLE.rim(&grain, FOOT)), flat(top, BOSS.rim(&grain, FOOT))]
        }
        4 => vec![flat(plane(Point3::new(0.6, DEPTH, 0.9), Z), PASSAGE.rim(&grain, 0.6))],
        6 => vec![flat(plane(Point3::new(0.0, DEPTH, 2.2), -Z), PASSAGE.rim(&grain, 0.0))],
        _ => Vec::new(),
    };
    let straight = |p: Point3| p;
    Extrusion { depth: DEPTH, pieces: &profile, bend: &straight }.sew(&mut sewing, holes, |_| Vec::new());
    HOLE.sew(&mut sewing, 11, [&|_| 0.0, &|_| FOOT], Vec::new());
    PASSAGE.sew(&mut sewing, 12, [&|_| 0.0, &|_| 0.6], Vec::new());
    let window = PIPE.angles(&grain).into_iter().map(on_boss).collect();
    BOSS.sew(&mut sewing, 13, [&|_| FOOT, &|_| BOSS_TOP], vec![window]);
    PIPE.sew(&mut sewing, 14, [&pipe_start, &|_| PIPE_END], Vec::new());
    for (label, tube, along) in [(15, BOSS, BOSS_TOP), (16, PIPE, PIPE_END)] {
        let [e, f, axis] = tube.frame;
        let lid = Plane { origin: tube.centre + axis * along, axes: [e, f] };
        let rim = flat(lid, tube.rim(&grain, along));
        sewing.patch(label, &[rim], |p| lid.at(p));
    }
    sewing.finish()
}
