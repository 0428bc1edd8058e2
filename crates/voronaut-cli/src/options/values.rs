//! Values as they are typed, and how they are read.

use clap::ValueEnum;
use serde::Serialize;
use std::fmt;
use voronaut::canvas::VERTICES_PER_SEED;
use voronaut::geometry::{Aabb, Point, Point3};
use voronaut::recipe::MeshOptions;

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Show {
    /// Triangles
    Mesh,
    /// Balls of the metric
    Ellipses,
    /// Voronoi cells of the vertices
    Cells,
    /// Canvas triangles that witness Voronoi vertices (red) and edges (grey), over cells
    Witnesses,
    /// Edges of the dual as geodesics, over cells
    Geodesics,
    /// Riemannian triangles with lines of equal barycentric coordinates, over cells
    Triangles,
    /// Triangles by their power protection: blue where it is less than asked for, pale where there is much
    Protection,
    /// Edges that are not of unit length, coloured by why that is, with a legend: dark where too short, light where too long
    Unmet,
    /// Cells by the factor by which they miss the conditions of the certificate (`dual`): green where they hold
    Certificate,
}

impl Show {
    /// Whether it takes a diagram to show it.
    pub(crate) fn is_of_diagram(self) -> bool {
        matches!(self, Show::Cells | Show::Witnesses | Show::Geodesics | Show::Triangles | Show::Certificate)
    }
}

/// How the edges of a dual are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub(crate) enum EdgesOut {
    /// Straight
    Straight,
    /// As geodesics
    Geodesic,
}

/// How fine the canvas of a dual is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CanvasSize {
    /// So many vertices per seed.
    PerSeed(u32),
    /// As fine as its certificate asks.
    Certified,
}

impl Default for CanvasSize {
    fn default() -> Self {
        CanvasSize::PerSeed(VERTICES_PER_SEED)
    }
}

impl fmt::Display for CanvasSize {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            CanvasSize::PerSeed(count) => write!(f, "{count}"),
            CanvasSize::Certified => f.write_str("certified"),
        }
    }
}

/// Bytes of a gibibyte.
pub(crate) const GIB: f64 = 1_073_741_824.0;

pub(super) fn default_memory_limit() -> f64 {
    MeshOptions::default().memory_limit as f64 / GIB
}

/// A list of finite numbers; `None` where one is not.
pub(crate) fn finite(text: &str) -> Option<Vec<f64>> {
    let number = |word: &str| word.trim().parse().ok().filter(|x: &f64| x.is_finite());
    text.split(',').map(number).collect()
}

/// A box by two of its corners.
pub(super) fn window(text: &str) -> Result<Aabb, String> {
    let Some(&[x0, y0, x1, y1]) = finite(text).as_deref() else {
        return Err("not four finite numbers x0,y0,x1,y1".into());
    };
    let has_room = |b: &Aabb| b.extent().x > 0.0 && b.extent().y > 0.0 && b.extent().norm().is_finite();
    let corners = [Point::new(x0, y0), Point::new(x1, y1)];
    Aabb::of(corners).filter(has_room).ok_or_else(|| "the box is empty or not finite".into())
}

/// A point as it was written.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Coordinates {
    /// Of the plane.
    Plane(Point),
    /// Of space.
    Space(Point3),
}

pub(crate) fn coordinates(text: &str) -> Result<Coordinates, String> {
    match finite(text).as_deref() {
        Some(&[x, y]) => Ok(Coordinates::Plane(Point::new(x, y))),
        Some(&[x, y, z]) => Ok(Coordinates::Space(Point3::new(x, y, z))),
        _ => Err("not a point: write two numbers, X,Y, or on a surface three, X,Y,Z".into()),
    }
}

pub(crate) fn canvas_size(text: &str) -> Result<CanvasSize, String> {
    match text.parse::<u32>() {
        _ if text == "certified" => Ok(CanvasSize::Certified),
        Ok(count) if count > 0 => Ok(CanvasSize::PerSeed(count)),
        _ => Err("not a number from 1 up, nor `certified`".into()),
    }
}

/// Pairs of labels, one after the other.
pub(super) fn pairs(text: &str) -> Result<Vec<[i32; 2]>, String> {
    let labels: Option<Vec<i32>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    match labels.as_deref().map(<[i32]>::as_chunks) {
        Some((pairs, [])) => Ok(pairs.to_vec()),
        _ => Err("not two labels A,B".into()),
    }
}

pub(crate) fn positive(text: &str) -> Result<f64, String> {
    not_negative(text).ok().filter(|&value| value > 0.0).ok_or_else(|| "not a positive number".into())
}

pub(crate) fn not_negative(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value: &f64| value.is_finite() && *value >= 0.0);
    value.ok_or_else(|| "not a number from 0 up".into())
}
