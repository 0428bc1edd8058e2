//! A picture of a mesh.

use super::cells::{self, Layers};
use super::colours::Tint;
use super::curves::Curves;
use super::frame::{Frame, PathData};
use super::strokes::Sheet;
use super::{colours, ellipses, shades, unmet};
use std::collections::BTreeMap;
use std::fmt::Write;
use voronaut::diagram::Cells;
use voronaut::geometry::{Aabb, Point};
use voronaut::mesh::{Edges, Mesh};
use voronaut::metric::MetricField;
use voronaut::{Error, Result};

/// What a picture shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Picture {
    /// The triangles and edges of the mesh.
    pub mesh: bool,
    /// Balls of the metric around a well-spaced subset of the vertices.
    pub ellipses: bool,
    /// Pixels of the longer side.
    pub width: u32,
    /// What is seen; `None`: everything.
    pub window: Option<Aabb>,
}

impl Default for Picture {
    fn default() -> Self {
        Self { mesh: true, ellipses: false, width: 1600, window: None }
    }
}

/// Draws a mesh, seen along z, as the text of an SVG file: one path per class of colour or line width, y up, white
/// background, triangles by the logarithm of their area, with a hue per region: the smaller, the stronger; the boundary and
/// labelled edges on top. Curved triangles have their curves, exactly. Triangles with a vertex that does not exist or is not finite are left out.
///
/// The layers may hold the cells of a diagram instead of filled triangles, and more; the border drawn on top is then that of the
/// cells' domain.
///
/// # Errors
/// [`Error::Unsupported`] for ellipses without a metric, [`Error::Metric`] where it is not positive definite.
pub fn svg_with(mesh: &Mesh, metric: Option<&dyn MetricField>, picture: &Picture, layers: &Layers) -> Result<String> {
    let (triangles, labels) = shades::drawable(mesh);
    let edges = Edges::of(&triangles);
    let curves = Curves::of(mesh);
    let areas: Vec<f64> = triangles.iter().map(|&t| curves.double_area(mesh, t)).collect();
    let heights: Vec<f64> = triangles.iter().zip(&areas).map(|(&t, &area)| least_height(mesh, t, area)).collect();
    let corners = triangles.as_flattened().iter().map(|&v| mesh.point(v));
    let outline = corners.chain(curves.controls().map(|p| Point::new(p.x, p.y)));
    let frame = frame(outline, &heights, *picture, layers.cells.as_ref());
    let pixels: Vec<f64> = heights.iter().map(|&height| frame.pixels(height)).collect();
    let sheet = Sheet { mesh, edges: &edges, heights: &pixels, frame: &frame, curves: &curves };

    let below = layers.unmet.as_ref().map_or(0.0, |_| unmet::legend_height(&frame));
    let mut text = frame.paper(below, "rect", "fill=\"#fff\"");
    if let Some(found) = &layers.cells {
        let has_lines = picture.mesh || picture.ellipses || !layers.geodesics.is_empty();
        let tint = if has_lines { Tint::Soft } else { Tint::Full };
        let is_ground = layers.witnesses.is_some() || found.has_orphans();
        match &layers.factors {
            Some(factors) => cells::factors(&mut text, found, factors, &frame),
            None => cells::cells(&mut text, found, &frame, if is_ground { Tint::Pale } else { tint }),
        }
    } else {
        let fills = match (&layers.protection, &layers.values) {
            (Some(protection), _) => triangles.iter().map(|&t| protection.fill(t)).collect(),
            (None, Some(values)) => shades::value_fills(&triangles, values),
            (None, None) if picture.mesh && layers.unmet.is_none() => shades::size_fills(areas.into_iter(), &labels),
            (None, None) => vec![colours::DOMAIN.to_string(); triangles.len()],
        };
        fill(&mut text, &sheet, &triangles, &fills);
    }
    if let Some(faces) = &layers.witnesses {
        cells::witnesses(&mut text, faces, &frame);
    }
    if picture.mesh {
        let sides = if layers.cells.is_some() { 1 } else { 2 };
        let opacity = layers.unmet.as_ref().map_or(1.0, |_| unmet::PALE);
        let _ = writeln!(text, r#"<g stroke-opacity="{opacity}">"#);
        sheet.edges_of(&mut text, sides);
        text.push_str("</g>\n");
    }
    if picture.ellipses {
        let is_faint = picture.mesh || layers.cells.is_some();
        ellipses::ellipses(&mut text, &sheet, metric.ok_or_else(no_metric)?, is_faint)?;
    }
    let thickness = layers.cells.as_ref().map_or(10.0, |found| cells::typical(found, &frame)[0]);
    cells::polylines(&mut text, layers, thickness, &frame);
    if let Some(found) = &layers.cells {
        cells::seeds(&mut text, found, &frame);
        cells::border(&mut text, found, &frame);
    } else {
        sheet.boundary(&mut text);
    }
    if let Some(found) = &layers.unmet {
        unmet::edges(&mut text, &sheet, found);
        unmet::legend(&mut text, found, &frame);
    }
    text.push_str("</svg>\n");
    Ok(text)
}

/// A frame around what is to be seen, or the domain as far as it is known, fine enough for thin triangles or cells.
fn frame(outline: impl Iterator<Item = Point>, heights: &[f64], picture: Picture, cells: Option<&Cells>) -> Frame {
    let border = cells.iter().flat_map(|c| c.border.iter().flatten().copied());
    let bounds = picture
        .window
        .or_else(|| Aabb::of(border.chain(outline)))
        .unwrap_or(Aabb { min: Point::default(), max: Point::default() });
    let width = f64::from(picture.width.max(16));
    // Lines between cells and along triangles are drawn: both tell how fine the paper must be.
    let coarse = Frame::new(bounds, width, |_| 1.0);
    let thin = cells.map_or(f64::INFINITY, |found| cells::typical(found, &coarse)[1]);
    let drawn = if picture.mesh || cells.is_none() {
        let heights = shades::in_order(heights.iter().copied().filter(|height| *height > 0.0));
        heights.get(heights.len() / 50).copied().unwrap_or(1.0)
    } else {
        f64::INFINITY
    };
    Frame::new(bounds, width, |scale| thin.min(scale * drawn))
}

fn no_metric() -> Error {
    let what = "a picture of the metric's ellipses without a metric";
    Error::unsupported(what, "give a metric, or show the mesh only")
}

/// One path per colour. Each is also stroked a little, or the background would shine through between neighbours.
fn fill(text: &mut String, sheet: &Sheet, triangles: &[[u32; 3]], colours: &[String]) {
    let mut paths: BTreeMap<&str, PathData> = BTreeMap::new();
    for (&triangle, colour) in triangles.iter().zip(colours) {
        sheet.trace(paths.entry(colour).or_default(), &triangle, true);
    }
    let _ = writeln!(text, r#"<g stroke-width="{:.1}" stroke-linejoin="round">"#, sheet.frame.quanta(0.4));
    for (colour, path) in paths {
        path.draw(text, &format!(r#"fill="{colour}" stroke="{colour}""#));
    }
    text.push_str("</g>\n");
}

/// The height over the longest side, from twice the area.
fn least_height(mesh: &Mesh, triangle: [u32; 3], double_area: f64) -> f64 {
    let [a, b, c] = mesh.corners_of(triangle);
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    if longest > 0.0 { double_area / longest } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::{bowed, grid, mesh};
    use voronaut::geometry::Tensor;

    fn svg(mesh: &Mesh, metric: Option<&dyn MetricField>, picture: &Picture) -> Result<String> {
        svg_with(mesh, metric, picture, &Layers::default())
    }

    #[test]
    fn one_path_per_class() {
        let text = svg(&grid(40, 40), None, &Picture::default()).unwrap();
        assert!(text.matches("<path").count() < 8, "{}", text.matches("<path").count());
        assert!(text.len() < 50 * 3200, "{} bytes", text.len());
    }

    #[test]
    fn curved_triangles_are_drawn_as_curves() {
        for (order, command) in [(2, 'q'), (3, 'c')] {
            let text = svg(&bowed(order), None, &Picture::default()).unwrap();
            let paths: String = text.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
            // Two triangles of three sides each, an inner edge, four on the boundary.
            assert_eq!(paths.matches(command).count(), 3 * 2 + 1 + 4, "{text}");
            assert!(!paths.contains('l'));
            let width = |text: &str| text.split("width=\"").nth(1).unwrap().split('"').next().unwrap().to_owned();
            let flat = svg(&Mesh { curved: None, ..bowed(order) }, None, &Picture::default()).unwrap();
            assert_ne!(width(&text), width(&flat), "the bow is below the corners, and seen");
        }
    }

    #[test]
    fn nothing_and_nonsense_are_drawn_as_nothing() {
        let nonsense =
            mesh(&[[f64::NAN, 0.0], [1e300, -1e300], [0.0, 1.0]], &[[0, 1, 2], [0, 1, 9], [1, 1, 2], [2, 2, 2]]);
        let nan = |_: Point| Tensor::new(f64::NAN, 0.0, 1.0);
        let both = Picture { ellipses: true, ..Picture::default() };
        for picture in [Picture::default(), Picture { width: 0, ..Picture::default() }] {
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
