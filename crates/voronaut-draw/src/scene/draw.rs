//! The picture of a scene: an image of its triangles, and its lines over it.

use super::super::frame::PathData;
use super::super::simplify::simplify;
use super::light::Bodies;
use super::view::{Camera, View};
use super::visible::Screen;
use super::{Pen, Scene, Stroke};
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
    let [width, height] = camera.frame.size();
    let bodies = Bodies::new(scene, &camera);
    let image = crate::data_url(&bodies.pixels(), width as u32)?;
    let mut text = camera.frame.paper(0.0, "image", &format!("href=\"{image}\""));
    text.push_str("<g fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n");
    let screen = Screen { bodies: &bodies, touch: TOUCH * width.max(height) };
    for stroke in Stroke::ALL {
        lines(&mut text, scene, stroke, &screen, &camera);
    }
    text.push_str("</g>\n</svg>\n");
    Ok(text)
}

/// The lines with a stroke: one path of those that lie where the surface faces the eye, others for those where it does
/// less and less, which are thinner.
fn lines(text: &mut String, scene: &Scene, stroke: Stroke, screen: &Screen, camera: &Camera) {
    let (frame, pen) = (&camera.frame, stroke.pen());
    let of_stroke = scene.lines.iter().filter(|line| line.stroke == stroke);
    let placed: Vec<Vec<[f64; 3]>> =
        of_stroke.filter_map(|line| line.points.iter().map(|&p| camera.place(p)).collect()).collect();
    let mut paths: [PathData; THINNER.len()] = Default::default();
    for part in placed.iter().flat_map(|line| screen.visible(line)) {
        let class =
            if pen.is_thinned { THINNER.iter().filter(|&&share| FULL * part.facing < share).count() } else { 0 };
        let path = &mut paths[class.min(THINNER.len() - 1)];
        let points: Vec<[i64; 2]> = part.points.iter().map(|&p| frame.quanta_at(p)).collect();
        match points[..] {
            [dot] => path.dot(dot),
            _ => path.polyline(&simplify(&points, &[], false, frame.quanta(TOLERANCE)), false),
        }
    }
    let width = frame.quanta(width(&pen, &placed));
    for (path, share) in paths.iter().zip(THINNER).filter(|(path, _)| !path.text().is_empty()) {
        path.draw(text, &format!(r#"stroke="{}" stroke-width="{:.1}""#, pen.ink, width * share));
    }
}

/// The width of lines in pixels: the finer the mesh they make, the thinner.
fn width(pen: &Pen, lines: &[Vec<[f64; 3]>]) -> f64 {
    let length = |line: &Vec<[f64; 3]>| line.windows(2).map(|ends| distance(ends[0], ends[1])).sum::<f64>();
    let mut lengths: Vec<f64> = lines.iter().map(length).collect();
    lengths.sort_unstable_by(f64::total_cmp);
    let typical = lengths.get(lengths.len() / 2).copied().unwrap_or(0.0);
    if pen.share > 0.0 { (pen.share * typical).clamp(THINNEST, pen.widest) } else { pen.widest }
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    p.iter().zip(q).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}
