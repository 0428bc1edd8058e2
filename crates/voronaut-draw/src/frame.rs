//! From the plane to the paper: a frame around a mesh, and compact path data in it.

use std::fmt::Write;
use voronaut::geometry::{Aabb, Point};

/// Maps the plane to whole numbers, the paper's quanta: y down, aspect kept, a margin all around.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    bounds: Aabb,
    /// Pixels per unit of length.
    scale: f64,
    margin: f64,
    /// Pixels per quantum.
    quantum: f64,
}

/// The margin, as a share of the longer side of the picture.
const MARGIN: f64 = 0.02;

/// Whatever lies farther out, in quanta, is drawn here: sums of such numbers do not overflow.
const FAR: f64 = 1e12;

impl Frame {
    /// A frame whose longer side has so many pixels, fine enough for details of `detail` pixels.
    pub(super) fn new(bounds: Aabb, longer_side: f64, detail: impl Fn(f64) -> f64) -> Self {
        let margin = (MARGIN * longer_side).max(1.0);
        let extent = bounds.extent().x.max(bounds.extent().y);
        let scale = if extent > 0.0 { (longer_side - 2.0 * margin) / extent } else { 1.0 };
        let quantum = 10.0_f64.powf((0.05 * detail(scale)).log10().floor()).clamp(1e-4, 1e-2);
        Self { bounds, scale, margin, quantum }
    }

    /// Width and height of the picture in whole pixels.
    pub(super) fn size(&self) -> [f64; 2] {
        let extent = self.bounds.extent();
        [extent.x, extent.y].map(|side| (side * self.scale + 2.0 * self.margin).ceil())
    }

    /// The beginning of an SVG: the paper, with so many pixels below the frame, and on all of it an element with these attributes,
    /// such as a white `rect`.
    pub(super) fn paper(&self, below: f64, ground: &str, attributes: &str) -> String {
        let [width, height] = self.size();
        let height = height + below;
        let [w, h] = [width, height].map(|side| self.quanta(side).round());
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {w} {h}\">\n\
             <{ground} width=\"{w}\" height=\"{h}\" {attributes}/>\n"
        )
    }

    /// The attributes of a path with a fill and an ink, whose line has a width in pixels.
    pub(super) fn paint(&self, [fill, ink]: [&str; 2], width: f64) -> String {
        format!(r#"fill="{fill}" stroke="{ink}" stroke-width="{:.1}""#, self.quanta(width))
    }

    /// Quanta for a length in pixels.
    pub(super) fn quanta(&self, pixels: f64) -> f64 {
        pixels / self.quantum
    }

    /// Pixels for a length in the plane.
    pub(super) fn pixels(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// A point in quanta.
    pub(super) fn place(&self, p: Point) -> [i64; 2] {
        self.quanta_at(self.pixels_at(p))
    }

    /// A point in pixels.
    pub(super) fn pixels_at(&self, p: Point) -> [f64; 2] {
        let x = (p.x - self.bounds.min.x) * self.scale + self.margin;
        let y = (self.bounds.max.y - p.y) * self.scale + self.margin;
        [x, y]
    }

    /// A point that is given in pixels, in quanta.
    pub(super) fn quanta_at(&self, pixels: [f64; 2]) -> [i64; 2] {
        pixels.map(|pixels| self.quanta(pixels).round().clamp(-FAR, FAR) as i64)
    }
}

/// SVG path data with relative moves: a few bytes per point.
#[derive(Clone, Debug, Default)]
pub(super) struct PathData {
    text: String,
    at: [i64; 2],
}

impl PathData {
    /// Straight lines through points, all closed or none.
    pub(super) fn of<P: AsRef<[[i64; 2]]>>(lines: impl IntoIterator<Item = P>, closed: bool) -> Self {
        let mut path = Self::default();
        lines.into_iter().for_each(|points| path.polyline(points.as_ref(), closed));
        path
    }

    /// Adds straight lines through points; a closed one returns to its first point.
    pub(super) fn polyline(&mut self, points: &[[i64; 2]], closed: bool) {
        self.text.push('m');
        for &point in points {
            self.step(point);
        }
        if closed {
            self.text.push('z');
            self.at = points.first().copied().unwrap_or(self.at);
        }
    }

    /// Adds Bézier curves from a point, one behind the other: each by its control points, of which it has none to two, and its end.
    pub(super) fn curves(&mut self, from: [i64; 2], curves: &[Vec<[i64; 2]>], closed: bool) {
        self.text.push('m');
        self.step(from);
        for points in curves {
            self.text.push(['l', 'q', 'c'][points.len() - 1]);
            let start = self.at;
            for &point in points {
                self.at = start;
                self.step(point);
            }
        }
        if closed {
            self.text.push('z');
            self.at = from;
        }
    }

    /// Adds a line of no length: a dot where lines have round ends.
    pub(super) fn dot(&mut self, point: [i64; 2]) {
        self.polyline(&[point], false);
        self.text.push_str("h0");
    }

    /// Adds an ellipse: a point of it and the opposite one, its semi-axes, and the angle (degrees, clockwise on paper)
    /// of the first.
    pub(super) fn ellipse(&mut self, [from, to]: [[i64; 2]; 2], [rx, ry]: [i64; 2], degrees: f64) {
        self.text.push('m');
        self.step(from);
        for target in [to, from] {
            let _ = write!(self.text, "a{rx} {ry} {degrees:.1} 1 0");
            self.separate(target[0] - self.at[0]);
            self.step(target);
        }
        self.text.push('z');
    }

    /// Writes the path so far with these attributes.
    pub(super) fn draw(&self, svg: &mut String, attributes: &str) {
        let _ = writeln!(svg, r#"<path {attributes} d="{}"/>"#, self.text);
    }

    /// The data so far.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    fn step(&mut self, point: [i64; 2]) {
        let [dx, dy] = [point[0] - self.at[0], point[1] - self.at[1]];
        if self.text.ends_with(|last: char| last.is_ascii_digit()) {
            self.separate(dx);
        }
        let _ = write!(self.text, "{dx}");
        self.separate(dy);
        let _ = write!(self.text, "{dy}");
        self.at = point;
    }

    /// A minus sign separates numbers by itself.
    fn separate(&mut self, next: i64) {
        if next >= 0 && !self.text.ends_with(' ') {
            self.text.push(' ');
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn path_data_is_relative_and_dense() {
        let mut path = PathData::default();
        path.polyline(&[[10, 20], [13, 15], [10, 10]], true);
        path.polyline(&[[0, 0], [5, 5]], false);
        assert_eq!(path.text(), "m10 20 3-5-3-5zm-10-20 5 5");
        let mut path = PathData::default();
        path.ellipse([[10, 0], [0, 0]], [5, 2], 30.0);
        assert_eq!(path.text(), "m10 0a5 2 30.0 1 0-10 0a5 2 30.0 1 0 10 0z");
    }

    #[test]
    fn curves_are_relative_to_where_they_begin() {
        let mut path = PathData::default();
        path.curves([10, 20], &[vec![[15, 25], [20, 20]], vec![[20, 10]], vec![[12, 8], [11, 9], [10, 20]]], true);
        path.polyline(&[[10, 20], [11, 20]], false);
        assert_eq!(path.text(), "m10 20q5 5 10 0l0-10c-8-2-9-1-10 10zm0 0 1 0");
    }

    #[test]
    fn extreme_boxes_keep_their_aspect() {
        let bounds = Aabb { min: Point::new(0.0, 0.0), max: Point::new(1e9, 1.0) };
        let frame = Frame::new(bounds, 1000.0, |_| 1.0);
        let [width, height] = frame.size();
        assert!((999.0..=1001.0).contains(&width) && (40.0..=42.0).contains(&height));
        let point = Aabb { min: Point::new(3.0, 3.0), max: Point::new(3.0, 3.0) };
        assert!(Frame::new(point, 100.0, |_| 0.0).size()[0] >= 1.0);
    }
}
