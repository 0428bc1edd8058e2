//! A picture of a mesh.

use super::cells::{self, Layers};
use super::colours::Tint;
use super::frame::{Frame, PathData};
use super::{colours, ellipses, strokes, unmet};
use std::collections::BTreeMap;
use std::fmt::Write;
use voronaut::diagram::Cells;
use voronaut::geometry::{Aabb, Point};
use voronaut::mesh::Mesh;
use voronaut::metric::MetricField;
use voronaut::quality::Edges;
use voronaut::{Error, Result};

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture {
    /// The triangles and edges of the mesh.
    pub mesh: bool,
    /// Balls of the metric around a well-spaced subset of the vertices.
    pub ellipses: bool,
    /// How triangles are filled.
    pub shade: Shade,
    /// Pixels of the longer side.
    pub width: u32,
    /// What is seen; `None`: everything.
    pub window: Option<Aabb>,
}

/// How triangles are filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shade {
    /// By the logarithm of their area, a hue per region: the smaller, the stronger.
    Size,
    /// By their Euclidean shape: from pale (equilateral) to warm (flat).
    Quality,
}

impl Default for Picture {
    fn default() -> Self {
        Self { mesh: true, ellipses: false, shade: Shade::Size, width: 1600, window: None }
    }
}

/// Draws a mesh, seen along z, as the text of an SVG file: one path per class of colour or line width, y up, white
/// background, the boundary and labelled edges on top. Triangles with a vertex that does not exist or is not finite are
/// left out.
///
/// # Errors
/// [`Error::Unsupported`] for ellipses without a metric, [`Error::Metric`] where it is not positive definite.
pub fn svg(mesh: &Mesh, metric: Option<&dyn MetricField>, picture: &Picture) -> Result<String> {
    svg_with(mesh, metric, picture, &Layers::default())
}

/// [`svg`] with the cells of a diagram instead of filled triangles, and what else the layers hold; the border drawn on top
/// is then that of the cells' domain.
///
/// # Errors
/// As for [`svg`].
pub fn svg_with(
    mesh: &Mesh,
    metric: Option<&dyn MetricField>,
    picture: &Picture,
    layers: &Layers<'_>,
) -> Result<String> {
    let (triangles, labels) = drawable(mesh);
    let edges = Edges::of(&triangles);
    let heights: Vec<f64> = triangles.iter().map(|&t| least_height(mesh, t)).collect();
    let frame = frame(mesh, &triangles, &heights, *picture, layers.cells);
    let pixels: Vec<f64> = heights.iter().map(|&height| frame.pixels(height)).collect();

    let mut text = head(&frame, layers.unmet.map_or(0.0, |_| unmet::legend_height(&frame)));
    if let Some(found) = layers.cells {
        let has_lines = picture.mesh || picture.ellipses || !layers.geodesics.is_empty();
        let tint = if has_lines { Tint::Soft } else { Tint::Full };
        let is_ground = layers.witnesses.is_some() || found.has_orphans();
        match layers.factors {
            Some(factors) => cells::factors(&mut text, found, factors, &frame),
            None => cells::cells(&mut text, found, &frame, if is_ground { Tint::Pale } else { tint }),
        }
    } else {
        let one_class = || vec![colours::DOMAIN.to_string(); triangles.len()];
        let fills = match (layers.protection, layers.values) {
            (Some(protection), _) => triangles.iter().map(|&t| protection.fill(t)).collect(),
            (None, Some(values)) => bands(&triangles, values),
            (None, None) if picture.mesh && layers.unmet.is_none() => classes(mesh, &triangles, &labels, picture.shade),
            (None, None) => one_class(),
        };
        fill(&mut text, mesh, &frame, &triangles, &fills);
    }
    if let Some(faces) = layers.witnesses {
        cells::witnesses(&mut text, faces, &frame);
    }
    if picture.mesh {
        let sides = if layers.cells.is_some() { 1 } else { 2 };
        let opacity = layers.unmet.map_or(1.0, |_| unmet::PALE);
        let _ = writeln!(text, r#"<g stroke-opacity="{opacity}">"#);
        strokes::edges_of(&mut text, mesh, &edges, sides, &pixels, &frame);
        text.push_str("</g>\n");
    }
    if picture.ellipses {
        let is_faint = picture.mesh || layers.cells.is_some();
        ellipses::ellipses(&mut text, mesh, &edges, metric.ok_or_else(no_metric)?, &frame, is_faint)?;
    }
    let thickness = layers.cells.map_or(10.0, |found| cells::typical(found, &frame)[0]);
    if !layers.grids.is_empty() {
        cells::grids(&mut text, layers.grids, thickness, &frame);
    }
    if !layers.geodesics.is_empty() {
        cells::geodesics(&mut text, layers.geodesics, thickness, &frame);
    }
    if let Some(found) = layers.cells {
        cells::seeds(&mut text, found, &frame);
        cells::border(&mut text, found, &frame);
    } else {
        strokes::boundary(&mut text, mesh, &edges, &frame);
    }
    if let Some(found) = layers.unmet {
        unmet::edges(&mut text, mesh, &edges, found, &pixels, &frame);
        unmet::legend(&mut text, found, &frame);
    }
    text.push_str("</svg>\n");
    Ok(text)
}

/// A frame around what is to be seen, or the domain as far as it is known, fine enough for thin triangles or cells.
fn frame(mesh: &Mesh, triangles: &[[u32; 3]], heights: &[f64], picture: Picture, cells: Option<&Cells>) -> Frame {
    let border = cells.iter().flat_map(|c| c.border.iter().flatten().copied());
    let corners = triangles.as_flattened().iter().map(|&v| mesh.point(v));
    let bounds = picture
        .window
        .or_else(|| Aabb::of(border.chain(corners)))
        .unwrap_or(Aabb { min: Point::default(), max: Point::default() });
    let width = f64::from(picture.width.max(16));
    // Lines between cells and along triangles are drawn: both tell how fine the paper must be.
    let coarse = Frame::new(bounds, width, |_| 1.0);
    let thin = cells.map_or(f64::INFINITY, |found| cells::typical(found, &coarse)[1]);
    let drawn = if picture.mesh || cells.is_none() { low_percentile(heights) } else { f64::INFINITY };
    Frame::new(bounds, width, |scale| thin.min(scale * drawn))
}

/// How many levels of colour there are per region.
const LEVELS: usize = 12;

fn no_metric() -> Error {
    let what = "a picture of the metric's ellipses without a metric".into();
    Error::Unsupported { what, help: "give a metric, or show the mesh only".into() }
}

/// The triangles whose vertices exist and are finite, and their labels.
fn drawable(mesh: &Mesh) -> (Vec<[u32; 3]>, Vec<i32>) {
    let exists = |v: &u32| (*v as usize) < mesh.points.len() && mesh.point(*v).is_finite();
    let labels = mesh.triangle_labels.iter().copied().chain(std::iter::repeat(0));
    mesh.triangles.iter().copied().zip(labels).filter(|(triangle, _)| triangle.iter().all(exists)).unzip()
}

/// The paper: a frame, and so many pixels below it.
fn head(frame: &Frame, below: f64) -> String {
    let [width, height] = frame.size();
    let height = height + below;
    let [w, h] = [width, height].map(|side| frame.quanta(side).round());
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {w} {h}\">\n\
         <rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n"
    )
}

/// One path per colour. Each is also stroked a little, or the background would shine through between neighbours.
fn fill(text: &mut String, mesh: &Mesh, frame: &Frame, triangles: &[[u32; 3]], colours: &[String]) {
    let mut paths: BTreeMap<&str, PathData> = BTreeMap::new();
    for (&triangle, colour) in triangles.iter().zip(colours) {
        paths.entry(colour).or_default().polyline(&triangle.map(|v| frame.place(mesh.point(v))), true);
    }
    let _ = writeln!(text, r#"<g stroke-width="{:.1}" stroke-linejoin="round">"#, frame.quanta(0.4));
    for (colour, path) in paths {
        let _ = writeln!(text, r#"<path fill="{colour}" stroke="{colour}" d="{}"/>"#, path.text());
    }
    text.push_str("</g>\n");
}

/// The colour of each triangle.
fn classes(mesh: &Mesh, triangles: &[[u32; 3]], labels: &[i32], shade: Shade) -> Vec<String> {
    let level = |share: f64| (share * (LEVELS - 1) as f64).round() / (LEVELS - 1) as f64;
    if shade == Shade::Quality {
        return triangles.iter().map(|&t| colours::quality_fill(level(shape(mesh, t)))).collect();
    }
    let mut regions = labels.to_vec();
    regions.sort_unstable();
    regions.dedup();
    let sizes: Vec<f64> = triangles.iter().map(|&t| double_area(mesh, t).ln()).collect();
    let [low, high] = spread(&sizes);
    let share = |size: f64| ((high - size) / (high - low)).clamp(0.0, 1.0);
    let region = |label: &i32| regions.binary_search(label).unwrap_or(0);
    labels.iter().zip(&sizes).map(|(label, &size)| colours::fill(region(label), level(share(size)))).collect()
}

/// The fill of each triangle by the mean of the values at its corners: the less, the stronger; grey where that is not finite.
fn bands(triangles: &[[u32; 3]], values: &[f64]) -> Vec<String> {
    const BANDS: f64 = 40.0;
    let mean = |t: &[u32; 3]| t.iter().map(|&v| values.get(v as usize).copied().unwrap_or(f64::NAN)).sum::<f64>() / 3.0;
    let most = triangles.iter().map(mean).filter(|value| value.is_finite()).fold(0.0, f64::max);
    let level = |value: f64| ((1.0 - value / most) * BANDS).round() / BANDS;
    let of = |value: f64| if value.is_finite() { colours::fill(0, level(value)) } else { colours::UNKNOWN.into() };
    triangles.iter().map(|t| of(mean(t))).collect()
}

/// The range of sizes that the levels of colour span: all but the outermost hundredths, at least a factor of four.
pub(super) fn spread(sizes: &[f64]) -> [f64; 2] {
    let mut sorted: Vec<f64> = sizes.iter().copied().filter(|size| size.is_finite()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| sorted.get((share * sorted.len() as f64) as usize).copied().unwrap_or(0.0);
    let (low, high) = (at(0.01), at(0.99));
    let missing = (4.0_f64.ln() - (high - low)).max(0.0);
    [low - 0.5 * missing, high + 0.5 * missing]
}

fn low_percentile(heights: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = heights.iter().copied().filter(|height| *height > 0.0).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    sorted.get(sorted.len() / 50).copied().unwrap_or(1.0)
}

fn double_area(mesh: &Mesh, triangle: [u32; 3]) -> f64 {
    let [a, b, c] = mesh.corners_of(triangle);
    (b - a).cross(c - a).abs()
}

/// The height over the longest side.
fn least_height(mesh: &Mesh, triangle: [u32; 3]) -> f64 {
    let [a, b, c] = mesh.corners_of(triangle);
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    if longest > 0.0 { double_area(mesh, triangle) / longest } else { 0.0 }
}

/// Euclidean 4 sqrt 3 A / (sum of squared sides).
fn shape(mesh: &Mesh, triangle: [u32; 3]) -> f64 {
    let [a, b, c] = mesh.corners_of(triangle);
    let squares: f64 = [b - a, c - b, a - c].iter().map(|side| side.dot(*side)).sum();
    if squares > 0.0 { 2.0 * 3.0_f64.sqrt() * double_area(mesh, triangle) / squares } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::{grid, mesh};
    use voronaut::geometry::Tensor;

    #[test]
    fn one_path_per_class() {
        let text = svg(&grid(40, 40), None, &Picture::default()).unwrap();
        assert!(text.matches("<path").count() < 8, "{}", text.matches("<path").count());
        assert!(text.len() < 50 * 3200, "{} bytes", text.len());
    }

    #[test]
    fn nothing_and_nonsense_are_drawn_as_nothing() {
        let nonsense =
            mesh(&[[f64::NAN, 0.0], [1e300, -1e300], [0.0, 1.0]], &[[0, 1, 2], [0, 1, 9], [1, 1, 2], [2, 2, 2]]);
        let nan = |_: Point| Tensor::new(f64::NAN, 0.0, 1.0);
        let both = Picture { ellipses: true, ..Picture::default() };
        for picture in [Picture::default(), Picture { shade: Shade::Quality, width: 0, ..Picture::default() }] {
            assert!(svg(&Mesh::default(), None, &picture).unwrap().ends_with("</svg>\n"));
            assert!(!svg(&nonsense, None, &picture).unwrap().contains("NaN"));
        }
        for h in [1e-60, 1e60] {
            assert!(svg(&grid(2, 2), Some(&|_| Tensor::isotropic(h)), &both).unwrap().ends_with("</svg>\n"));
        }
        assert!(matches!(svg(&grid(2, 2), Some(&nan), &both), Err(Error::Metric { .. })));
        assert!(matches!(svg(&grid(2, 2), None, &both), Err(Error::Unsupported { .. })));
    }

    #[test]
    fn scale_of_the_domain_does_not_matter() {
        let draw = |scale: f64| {
            let mut scaled = grid(5, 5);
            scaled.points.iter_mut().for_each(|p| *p = p.map(|x| x * scale));
            let metric = move |_: Point| Tensor::isotropic(scale);
            svg(&scaled, Some(&metric), &Picture { ellipses: true, ..Picture::default() }).unwrap()
        };
        assert_eq!(draw(1.0), draw(2.0_f64.powi(-30)));
        assert_eq!(draw(1.0), draw(2.0_f64.powi(30)));
    }
}
