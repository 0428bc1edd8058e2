//! Pictures of surfaces in space: shaded triangles as pixels, lines on them as vectors, cut where they are hidden.
//!
//! | module | what it is |
//! |---|---|
//! | `view` | from where a scene is seen; from space to pixels |
//! | `depth` | which triangle is nearest, at nine samples per pixel |
//! | `light` | from samples to shaded pixels |
//! | `draw` | the picture: an image, and lines over it as far as they are in front |
//! | `faces` | scenes of meshes, and of values on surfaces |
//! | `coloured`, `borders` | scenes of coloured canvases: cells with smooth borders |

mod borders;
mod coloured;
mod depth;
mod draw;
mod faces;
mod light;
#[cfg(all(test, feature = "png"))]
mod tests;
mod view;

pub use draw::draw_surface;
pub use view::View;

use super::colours::{self, Tint};
use std::borrow::Cow;
use voronaut::geometry::{Point3, Vector3};
use voronaut::quality::{Cause, Unmet};

/// Triangles and lines in space, to be drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// What hides and is hidden.
    pub(crate) triangles: Vec<SceneTriangle>,
    /// Lines on the triangles or elsewhere; those of one point are dots.
    pub(crate) lines: Vec<SceneLine>,
    /// What a legend of causes is drawn of.
    pub(crate) unmet: Option<Unmet>,
}

/// A triangle of a scene. Its front is where its corners are counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SceneTriangle {
    /// Where its corners are.
    pub corners: [Point3; 3],
    /// Unit normals at its corners, for a smooth shade; without them the triangle is flat.
    pub normals: Option<[Vector3; 3]>,
    /// Its colour.
    pub fill: Fill,
}

/// The colour of a triangle, before light falls on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Fill {
    /// That of a surface without any.
    Plain,
    /// That of a cell.
    Cell {
        /// Which of the palette's hues; any number.
        hue: usize,
        /// A variation that is seen only beside another; any number.
        shade: usize,
    },
    /// That of a part of a cell without its seed.
    Orphan,
    /// A hue for each region, strong at 1 and pale at 0.
    Level {
        /// The number of the region.
        region: usize,
        /// From 0 to 1.
        share: f64,
    },
}

/// A polyline of a scene.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SceneLine {
    /// Its points in order; a single one is a dot.
    pub points: Vec<Point3>,
    /// How it is drawn.
    pub stroke: Stroke,
}

/// How a line is drawn. Those that come later here lie over those before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stroke {
    /// Between cells: white.
    Cell,
    /// A line of equal value: thin.
    Level,
    /// An edge of a mesh: thin.
    Edge,
    /// A border or a feature of a surface.
    Border,
    /// An edge that is too long, or too short, by the number of its cause.
    TooLong(usize),
    /// The same.
    TooShort(usize),
    /// A geodesic edge: the thickest.
    Geodesic,
    /// A seed, as a line of one point.
    Seed,
}

impl Scene {
    /// The scene with more lines in it.
    #[must_use]
    pub fn with(mut self, lines: impl IntoIterator<Item = Vec<Point3>>, stroke: Stroke) -> Self {
        self.lines.extend(lines.into_iter().map(|points| SceneLine { points, stroke }));
        self
    }

    /// All points, of triangles and of lines.
    fn points(&self) -> impl Iterator<Item = Point3> {
        let corners = self.triangles.iter().flat_map(|triangle| triangle.corners);
        corners.chain(self.lines.iter().flat_map(|line| line.points.iter().copied()))
    }
}

impl Fill {
    fn colour(self) -> String {
        match self {
            Fill::Plain => colours::SURFACE.into(),
            Fill::Cell { hue, shade } => colours::cell(hue, shade, Tint::Full),
            Fill::Orphan => colours::ORPHAN[0].into(),
            Fill::Level { region, share } => colours::fill(region, share.clamp(0.0, 1.0)),
        }
    }
}

impl Stroke {
    /// In the order in which they are drawn.
    fn all() -> impl Iterator<Item = Stroke> {
        let causes = || 0..Cause::ALL.len();
        [Stroke::Cell, Stroke::Level, Stroke::Edge, Stroke::Border]
            .into_iter()
            .chain(causes().map(Stroke::TooLong))
            .chain(causes().map(Stroke::TooShort))
            .chain([Stroke::Geodesic, Stroke::Seed])
    }

    fn pen(self) -> Pen {
        let (ink, share, widest, is_thinned): (Cow<str>, f64, f64, bool) = match self {
            Stroke::Cell => (colours::CELL_BORDER.into(), 0.045, 1.2, true),
            Stroke::Level => (colours::GRID.into(), 1.0, 0.8, true),
            Stroke::Edge => (colours::EDGE.into(), 0.05, 1.0, true),
            Stroke::Border => (colours::BOUNDARY.into(), 1.0, 1.6, false),
            Stroke::TooLong(cause) => (colours::cause(cause, false).into(), 0.26, 2.4, true),
            Stroke::TooShort(cause) => (colours::cause(cause, true).into(), 0.26, 2.4, true),
            Stroke::Geodesic => (colours::GEODESIC.into(), 0.06, 1.9, true),
            Stroke::Seed => (colours::SEED.into(), 0.0, 4.2, false),
        };
        Pen { ink, share, widest, is_thinned }
    }
}

/// What a stroke is drawn with.
struct Pen {
    ink: Cow<'static, str>,
    /// Its width as a share of the length of typical lines, and at most, in pixels.
    share: f64,
    widest: f64,
    /// Whether it is thinner where the surface is seen from the side, for many may crowd there.
    is_thinned: bool,
}

/// The triangles whose vertices are among the first `count`.
fn existing(triangles: &[[u32; 3]], count: usize) -> Vec<[u32; 3]> {
    triangles.iter().copied().filter(|t| t.iter().all(|&v| (v as usize) < count)).collect()
}
