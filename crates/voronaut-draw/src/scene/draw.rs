//! The picture of a scene: an image of its triangles, and its lines over it.

use super::super::frame::PathData;
use super::super::simplify::simplify;
use super::depth::DepthMap;
use super::light::Bodies;
use super::view::{Camera, View};
use super::visible::Screen;
use super::{Scene, Stroke};
use std::fmt::Write;
use voronaut::Result;

/// Lines are straightened by at most so many pixels.
const TOLERANCE: f64 = 0.1;
/// How far behind a surface a line may be and still be on it, as a share of the picture's longer side. Lines that join
/// points of a surface are chords: those of a circle that fills the picture are nearer to it than this if they are shorter
/// than a fifth of its radius.
const TOUCH: f64 = 0.003;
/// Widths where the surface is seen from the side, as shares of the full width, which is had from the cosine 1 / `FULL` on.
const THINNER: [f64; 4] = [1.0, 0.75, 0.5, 0.35];
const FULL: f64 = 1.7;
/// The thinnest line where the surface faces the eye, in pixels.
const THINNEST: f64 = 0.25;

/// Draws a scene as the text of an SVG file: triangles as an image of shaded pixels (PNG, with white around), smooth where
/// they have normals, the backs of triangles in a darker and warmer shade; lines over it as paths, one for
/// each class of width, without what is hidden by triangles. The side of triangles that is seen more is taken for the front. What has points
/// that are not finite is left out.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) for a view from nowhere, [`Error::Limit`](voronaut::Error::Limit) for more than 5000
/// pixels, [`Error::Unsupported`](voronaut::Error::Unsupported) if the library was built without PNG.
pub fn draw_surface(scene: &Scene, view: &View) -> Result<String> {
    let camera = Camera::new(scene, view)?;
    let size = camera.frame.size();
    let mut map = DepthMap::new(size);
    let bodies = Bodies::new(scene, &camera, &mut map);
    let [width, height] = size;
    let [w, h] = size.map(|side| camera.frame.quanta(side).round());
    let image = super::super::image::data_url(&bodies.pixels(&map), width as u32)?;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {w} {h}\">\n\
         <image width=\"{w}\" height=\"{h}\" href=\"{image}\"/>\n\
         <g fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n"
    );
    let screen = Screen { map: &map, bodies: &bodies, touch: TOUCH * width.max(height) };
    for stroke in Stroke::ALL {
        lines(&mut text, scene, stroke, &screen, &camera);
    }
    text.push_str("</g>\n</svg>\n");
    Ok(text)
}

/// The lines with a stroke: one path of those that lie where the surface faces the eye, others for those where it does
/// less and less, which are thinner.
fn lines(text: &mut String, scene: &Scene, stroke: Stroke, screen: &Screen, camera: &Camera) {
    let frame = &camera.frame;
    let of_stroke = scene.lines.iter().filter(|line| line.stroke == stroke);
    let placed: Vec<Vec<[f64; 3]>> =
        of_stroke.filter_map(|line| line.points.iter().map(|&p| camera.place(p)).collect()).collect();
    let mut paths: [PathData; THINNER.len()] = Default::default();
    for part in placed.iter().flat_map(|line| screen.visible(line)) {
        let class =
            if stroke.is_thinned() { THINNER.iter().filter(|&&share| FULL * part.facing < share).count() } else { 0 };
        let path = &mut paths[class.min(THINNER.len() - 1)];
        let points: Vec<[i64; 2]> = part.points.iter().map(|&p| frame.quanta_at(p)).collect();
        match points[..] {
            [dot] => path.dot(dot),
            _ => path.polyline(&simplify(&points, &[], false, frame.quanta(TOLERANCE)), false),
        }
    }
    let width = frame.quanta(width(stroke, &placed));
    for (path, share) in paths.iter().zip(THINNER).filter(|(path, _)| !path.text().is_empty()) {
        let (ink, width) = (stroke.ink(), width * share);
        let _ = writeln!(text, r#"<path stroke="{ink}" stroke-width="{width:.1}" d="{}"/>"#, path.text());
    }
}

/// The width of lines in pixels: the finer the mesh they make, the thinner.
fn width(stroke: Stroke, lines: &[Vec<[f64; 3]>]) -> f64 {
    let [share, most] = stroke.width();
    let length = |line: &Vec<[f64; 3]>| line.windows(2).map(|ends| distance(ends[0], ends[1])).sum::<f64>();
    let mut lengths: Vec<f64> = lines.iter().map(length).collect();
    lengths.sort_unstable_by(f64::total_cmp);
    let typical = lengths.get(lengths.len() / 2).copied().unwrap_or(0.0);
    if share > 0.0 { (share * typical).clamp(THINNEST, most) } else { most }
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    p.iter().zip(q).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}
