//! What of a line is in front.

use super::depth::SAMPLES;
use super::light::Bodies;

/// Lines are looked at every so many pixels.
const STEP: f64 = 0.4;
/// What of a line is seen over a shorter length, in pixels, while the rest is hidden, is not drawn.
const SHORTEST: f64 = 1.6;
/// What is hidden over a shorter length, between two parts that are seen, is drawn.
const GAP: f64 = 1.0;

/// A part of a line that is seen.
pub(super) struct Part {
    /// Its points in pixels.
    pub(super) points: Vec<[f64; 2]>,
    /// How much the surface it lies on faces the eye, as the mean cosine; 1 of lines elsewhere.
    pub(super) facing: f64,
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
pub(super) struct Screen<'a> {
    pub(super) bodies: &'a Bodies,
    /// How far behind a surface a line may be, in pixels, and still be on it.
    pub(super) touch: f64,
}

impl Screen<'_> {
    /// The parts of a line that are seen.
    pub(super) fn visible(&self, line: &[[f64; 3]]) -> Vec<Part> {
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
