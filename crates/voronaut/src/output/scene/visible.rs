//! What of a line is in front.

use super::depth::{DepthMap, SAMPLES};
use super::light::Bodies;

/// Lines are looked at every so many pixels.
const STEP: f64 = 0.4;
/// What of a line is seen over a shorter length, in pixels, while the rest is hidden, is not drawn.
const SHORTEST: f64 = 1.6;
/// What is hidden over a shorter length, between two parts that are seen, is drawn.
const GAP: f64 = 1.0;

/// A point of a line in pixels, how far along it is, and whether it is seen.
#[derive(Clone, Copy, Debug)]
struct Sample {
    at: [f64; 2],
    along: f64,
    is_seen: bool,
}

/// The bodies that hide lines.
pub(super) struct Screen<'a> {
    pub(super) map: &'a DepthMap,
    pub(super) bodies: &'a Bodies,
    /// How far behind a surface a line may be, in pixels, and still be on it.
    pub(super) touch: f64,
}

impl Screen<'_> {
    /// The parts of a line that are seen, as polylines in pixels.
    pub(super) fn visible(&self, line: &[[f64; 3]]) -> Vec<Vec<[f64; 2]>> {
        let mut samples = self.samples(line);
        heal(&mut samples);
        let is_whole = samples.iter().all(|sample| sample.is_seen);
        let is_long = |run: &[Sample]| is_whole || run[run.len() - 1].along - run[0].along >= SHORTEST;
        let runs = samples.chunk_by(|a, b| a.is_seen == b.is_seen).filter(|run| run[0].is_seen && is_long(run));
        runs.map(|run| run.iter().map(|sample| sample.at).collect()).collect()
    }

    fn samples(&self, line: &[[f64; 3]]) -> Vec<Sample> {
        let Some(&first) = line.first() else { return Vec::new() };
        let mut samples = vec![Sample { at: [first[0], first[1]], along: 0.0, is_seen: self.sees(first) }];
        let mut before = 0.0;
        for ends in line.windows(2) {
            let [p, q] = [ends[0], ends[1]];
            let length = (q[0] - p[0]).hypot(q[1] - p[1]);
            let steps = (length / STEP).ceil().max(1.0);
            for step in 1..=steps as u32 {
                let t = f64::from(step) / steps;
                let at = [0, 1, 2].map(|i| p[i] + t * (q[i] - p[i]));
                samples.push(Sample { at: [at[0], at[1]], along: before + t * length, is_seen: self.sees(at) });
            }
            before += length;
        }
        samples
    }

    /// Whether nothing is before a point.
    fn sees(&self, [x, y, depth]: [f64; 3]) -> bool {
        let [x, y] = [x, y].map(|pixels| pixels * SAMPLES as f64);
        let in_front = self.map.at(x, y).map(|id| self.bodies.facet(id).depth(x, y) / SAMPLES as f64);
        in_front.is_none_or(|surface| surface <= depth + self.touch)
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
