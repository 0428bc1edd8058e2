//! Domains with periodic pairs.

use std::f64::consts::TAU;
use voronaut::geometry::Point;
use voronaut::manifold::domain::{Domain, Filling, Pslg, Segment, Side};

/// The domain within a polygon: its points in order, each with the label of the segment that begins there.
pub(super) fn polygon(corners: &[(f64, f64, i32)]) -> Domain {
    Domain::new(&graph(corners)).unwrap()
}

pub(super) fn graph(corners: &[(f64, f64, i32)]) -> Pslg {
    let n = corners.len() as u32;
    let segment = |(i, &(_, _, label)): (u32, &(f64, f64, i32))| Segment {
        ends: [i, (i + 1) % n],
        label,
        required: false,
        left: Side::Unknown,
        right: Side::Unknown,
    };
    Pslg {
        points: corners.iter().map(|&(x, y, _)| Point::new(x, y)).collect(),
        point_labels: vec![0; corners.len()],
        segments: (0..).zip(corners).map(segment).collect(),
        filling: Filling::EvenOdd,
        ..Pslg::default()
    }
}

/// The unit square with labels 1 to 4 from its lower side on.
pub(super) fn square() -> Domain {
    polygon(&[(0.0, 0.0, 1), (1.0, 0.0, 2), (1.0, 1.0, 3), (0.0, 1.0, 4)])
}

/// The thickness of the trailing edge, and of the slit from it to the far field.
pub(super) const SLIT: f64 = 0.01;

/// An aerofoil (label 1) in a round far field (2), between them an O-shaped domain that is cut open along the wake, which bends: the
/// upper side of the cut has label 3, the lower one 4, moved by [`SLIT`].
pub(super) fn aerofoil() -> Domain {
    let half = 0.5 * SLIT;
    let wake = |i: u32| {
        let t = f64::from(i) / 12.0;
        (1.0 + 5.0 * t, 0.3 * t * t)
    };
    let thickness = |x: f64| {
        half * x + 0.6 * (x.sqrt() * 0.2969 - 0.126 * x - 0.3516 * x * x + 0.2843 * x.powi(3) - 0.1036 * x.powi(4))
    };
    let surface = |i: u32| 0.5 - 0.5 * (0.5 * TAU * f64::from(i) / 40.0).cos();
    let (far_x, far_y) = wake(12);
    let mut corners = Vec::new();
    // The far field, from the upper end of the cut around to the lower one.
    let (radius, start) = ((far_x - 0.5).hypot(far_y), far_y.atan2(far_x - 0.5));
    let far = |i: u32| start + TAU * f64::from(i) / 48.0;
    corners.push((far_x, far_y + half, 2));
    corners.extend((1..48).map(|i| (0.5 + radius * far(i).cos(), radius * far(i).sin(), 2)));
    corners.extend((1..=12).rev().map(|i| (wake(i).0, wake(i).1 - half, 4)));
    corners.extend((1..=40).rev().map(|i| (surface(i), -thickness(surface(i)), 1)));
    corners.extend((0..40).map(|i| (surface(i), thickness(surface(i)), 1)));
    corners.extend((0..12).map(|i| (wake(i).0, wake(i).1 + half, 3)));
    polygon(&corners)
}

/// A sector of a ring around the origin, from radius 1 to 2: label 1 the side on the x axis, 2 the one turned by the angle; 3 inside, 4
/// outside. Each side has so many segments more than one; coordinates are rounded.
pub(super) fn sector(angle: f64, more: [u32; 2], round: impl Fn(f64) -> f64) -> Domain {
    let side = |more: u32, turned: f64, label: i32| {
        let at = move |i: u32| 1.0 + f64::from(i) / f64::from(more + 1);
        (0..=more).map(move |i| (at(i) * turned.cos(), at(i) * turned.sin(), label))
    };
    let arc = |radius: f64, label: i32| (0..8).map(move |i| (radius, f64::from(i) / 8.0, label));
    let mut corners: Vec<(f64, f64, i32)> = side(more[0], 0.0, 1).collect();
    corners.extend(arc(2.0, 4).map(|(r, t, label)| (r * (t * angle).cos(), r * (t * angle).sin(), label)));
    let mut back: Vec<(f64, f64, i32)> = side(more[1], angle, 2).collect();
    // Each segment's label is at its beginning.
    back.push((2.0 * angle.cos(), 2.0 * angle.sin(), 2));
    back.reverse();
    back.pop();
    corners.extend(back);
    corners
        .extend(arc(1.0, 3).map(|(r, t, label)| (r * ((1.0 - t) * angle).cos(), r * ((1.0 - t) * angle).sin(), label)));
    let rounded: Vec<(f64, f64, i32)> = corners.into_iter().map(|(x, y, label)| (round(x), round(y), label)).collect();
    polygon(&rounded)
}

/// A passage between two waves of so many segments, one above the other.
pub(super) fn waves(segments: u32, height: f64) -> Domain {
    let wave = |i: u32| (f64::from(i) / f64::from(segments), 0.2 * (TAU * f64::from(i) / f64::from(segments)).sin());
    let mut corners: Vec<(f64, f64, i32)> = (0..segments).map(|i| (wave(i).0, wave(i).1, 1)).collect();
    corners.push((wave(segments).0, wave(segments).1, 2));
    corners.extend((1..=segments).rev().map(|i| (wave(i).0, wave(i).1 + height, 3)));
    corners.push((wave(0).0, wave(0).1 + height, 4));
    polygon(&corners)
}
