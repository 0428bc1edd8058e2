//! A planar straight-line graph as a user brings it: not yet validated.

use crate::geometry::Point;
use crate::lists::marked;

/// What lies on one side of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The input does not say; it follows from the rest.
    Unknown,
    /// Not part of the domain.
    Outside,
    /// The region with this label.
    Region(i32),
}

/// A straight piece of boundary, interface or feature curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Vertex numbers of its ends.
    pub ends: [u32; 2],
    /// The user's label.
    pub label: i32,
    /// Whether the segment must be an edge of the mesh as it is, never split.
    pub required: bool,
    /// What lies left of the direction `ends[0]` to `ends[1]`.
    pub left: Side,
    /// What lies right of it.
    pub right: Side,
}

impl Segment {
    /// The same segment in the other direction.
    #[must_use]
    pub(super) fn turned(self) -> Self {
        let [a, b] = self.ends;
        Self { ends: [b, a], left: self.right, right: self.left, ..self }
    }
}

/// How areas are told apart where the sides of the segments do not say.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Filling {
    /// Every segment says what lies on both sides.
    #[default]
    Sides,
    /// Areas enclosed by segments alternate: in, out (a hole), in again (an island) ...
    EvenOdd,
    /// Every enclosed area belongs to the domain but for those that hold a hole point; region points label areas.
    Enclosed {
        /// One point inside each hole.
        holes: Vec<Point>,
        /// A point inside a region, and its label.
        regions: Vec<(Point, i32)>,
    },
}

/// A planar straight-line graph: the raw form of every planar domain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pslg {
    /// Positions.
    pub points: Vec<Point>,
    /// One label per point.
    pub point_labels: Vec<i32>,
    /// Points that stay vertices even in the middle of a straight run (Medit's `Corners`, `RequiredVertices`).
    pub required_points: Vec<u32>,
    /// Boundary, interfaces and features.
    pub segments: Vec<Segment>,
    /// How areas are told apart.
    pub filling: Filling,
    /// How far (Euclidean) mesh edges may stray from the segments; zero keeps every corner. A disk sets it, and
    /// `--hausd` overrides it.
    pub tolerance: f64,
    /// For each point a name for messages, such as `ring 3, position 17` or `vertex 12`; empty if points are
    /// numbered as in the file (from 1).
    pub names: Vec<String>,
}

impl Pslg {
    /// The same graph of some of its points, among which are all ends of segments and required ones.
    pub(super) fn with_points(self, kept: &[bool]) -> Self {
        let old: Vec<u32> = (0..).zip(kept).filter(|(_, kept)| **kept).map(|(v, _)| v).collect();
        if old.len() == self.points.len() {
            return self;
        }
        let mut number = vec![0; kept.len()];
        (0..).zip(&old).for_each(|(new, &v)| number[v as usize] = new);
        let renumbered = |ends: [u32; 2]| ends.map(|v| number[v as usize]);
        Self {
            points: old.iter().map(|&v| self.points[v as usize]).collect(),
            point_labels: old.iter().map(|&v| self.point_labels[v as usize]).collect(),
            names: old.iter().map(|&v| self.name(v)).collect(),
            required_points: self.required_points.iter().map(|&v| number[v as usize]).collect(),
            segments: self.segments.iter().map(|s| Segment { ends: renumbered(s.ends), ..*s }).collect(),
            ..self
        }
    }

    /// The same graph without points that no segment has.
    pub(super) fn of_segments(self) -> Self {
        let used = marked(self.points.len(), self.segments.iter().flat_map(|segment| segment.ends));
        self.with_points(&used)
    }

    /// The name of a point in the input.
    pub(crate) fn name(&self, point: u32) -> String {
        self.names.get(point as usize).map_or_else(|| format!("vertex {}", point + 1), Clone::clone)
    }

    /// How to name a point in a message: its name in the input and its coordinates.
    pub(crate) fn describe(&self, point: u32) -> String {
        format!("{} {}", self.name(point), self.points[point as usize])
    }

    /// How to name a segment in a message: by its two ends.
    pub(crate) fn describe_segment(&self, segment: u32) -> String {
        let [a, b] = self.segments[segment as usize].ends;
        format!("{} - {}", self.describe(a), self.describe(b))
    }
}
