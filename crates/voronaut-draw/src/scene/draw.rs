//! The picture of a scene: an image of its triangles, and its lines over it, as far as they are in front.

use super::super::frame::PathData;
use super::super::shades::in_order;
use super::super::simplify::simplify;
use super::super::unmet;
use super::depth::SAMPLES;
use super::light::Bodies;
use super::view::{Camera, View};
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
    let below = scene.unmet.as_ref().map_or(0.0, |_| unmet::legend_height(&camera.frame));
    let top = if scene.unmet.is_some() { " preserveAspectRatio=\"xMidYMin\"" } else { "" };
    let mut text = camera.frame.paper(below, "image", &format!("href=\"{image}\"{top}"));
    text.push_str("<g fill=\"none\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n");
    let screen = Screen { bodies: &bodies, touch: TOUCH * width.max(height) };
    for stroke in Stroke::all() {
        lines(&mut text, scene, stroke, &screen, &camera);
    }
    text.push_str("</g>\n");
    if let Some(found) = &scene.unmet {
        unmet::legend(&mut text, found, &camera.frame);
    }
    text.push_str("</svg>\n");
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
    let lengths = in_order(lines.iter().map(length));
    let typical = lengths.get(lengths.len() / 2).copied().unwrap_or(0.0);
    if pen.share > 0.0 { (pen.share * typical).clamp(THINNEST, pen.widest) } else { pen.widest }
}

fn distance(p: [f64; 3], q: [f64; 3]) -> f64 {
    p.iter().zip(q).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// Lines are looked at every so many pixels.
const STEP: f64 = 0.4;
/// What of a line is seen over a shorter length, in pixels, while the rest is hidden, is not drawn.
const SHORTEST: f64 = 1.6;
/// What is hidden over a shorter length, between two parts that are seen, is drawn.
const GAP: f64 = 1.0;

/// A part of a line that is seen.
struct Part {
    /// Its points in pixels.
    points: Vec<[f64; 2]>,
    /// How much the surface it lies on faces the eye, as the mean cosine; 1 of lines elsewhere.
    facing: f64,
}

/// A point of a line in pixels, how far along it is, whether it is seen, and how much what it lies on faces the eye.
#[derive(Clone, Copy, Debug)]
struct Sample {
    at: [f64; 2],
    along: f64,
    is_seen: bool,
    facing: Option<f64>,
}

/// The bodies that hide lines.
struct Screen<'a> {
    bodies: &'a Bodies,
    /// How far behind a surface a line may be, in pixels, and still be on it.
    touch: f64,
}

impl Screen<'_> {
    /// The parts of a line that are seen.
    fn visible(&self, line: &[[f64; 3]]) -> Vec<Part> {
        let mut samples = self.samples(line);
        heal(&mut samples);
        let is_whole = samples.iter().all(|sample| sample.is_seen);
        let is_long = |run: &[Sample]| is_whole || run[run.len() - 1].along - run[0].along >= SHORTEST;
        let runs = samples.chunk_by(|a, b| a.is_seen == b.is_seen).filter(|run| run[0].is_seen && is_long(run));
        let facing = |run: &[Sample]| {
            let known: Vec<f64> = run.iter().filter_map(|sample| sample.facing).collect();
            if known.is_empty() { 1.0 } else { known.iter().sum::<f64>() / known.len() as f64 }
        };
        let part = |run: &[Sample]| Part { points: run.iter().map(|sample| sample.at).collect(), facing: facing(run) };
        runs.map(part).collect()
    }

    fn samples(&self, line: &[[f64; 3]]) -> Vec<Sample> {
        let Some(&first) = line.first() else { return Vec::new() };
        let mut samples = vec![self.sample(first, 0.0)];
        let mut before = 0.0;
        for ends in line.windows(2) {
            let [p, q] = [ends[0], ends[1]];
            let length = (q[0] - p[0]).hypot(q[1] - p[1]);
            let steps = (length / STEP).ceil().max(1.0);
            for step in 1..=steps as u32 {
                let t = f64::from(step) / steps;
                let at = [0, 1, 2].map(|i| p[i] + t * (q[i] - p[i]));
                samples.push(self.sample(at, before + t * length));
            }
            before += length;
        }
        samples
    }

    fn sample(&self, [x, y, depth]: [f64; 3], along: f64) -> Sample {
        let [column, row] = [x, y].map(|pixels| pixels * SAMPLES as f64);
        let nearest = self.bodies.map.at(column, row);
        let before =
            nearest.map_or(f64::NEG_INFINITY, |id| self.bodies.facet(id).depth(column, row) / SAMPLES as f64 - depth);
        let facing = nearest.filter(|_| before.abs() <= self.touch).map(|id| self.bodies.facing(id));
        Sample { at: [x, y], along, is_seen: before <= self.touch, facing }
    }
}

/// Closes gaps that are only those between samples of the map.
fn heal(samples: &mut [Sample]) {
    let hidden = |sample: &Sample| !sample.is_seen;
    let mut start = 0;
    while let Some(from) = samples[start..].iter().position(hidden).map(|offset| start + offset) {
        let to = samples[from..].iter().position(|sample| sample.is_seen).map_or(samples.len(), |offset| from + offset);
        let is_between = from > 0 && to < samples.len();
        if is_between && samples[to].along - samples[from - 1].along < GAP {
            samples[from..to].iter_mut().for_each(|sample| sample.is_seen = true);
        }
        start = to;
    }
}
