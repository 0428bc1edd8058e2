//! Flips of sides by the energy of the triangles beside them.

use super::bezier::MOST;
use super::elements::Elements;
use super::local::Local;
use super::newton::Aim;
use super::pair::Pair;
use super::rules::Rule;
use super::term::side_energy;
use crate::geometry::Point;
use crate::lists::ranked;
use crate::mesh::edges::NONE;
use crate::parallel::prelude::*;

/// Flips have to gain so much at least: what rounding and half-settled points make of none.
const LEAST_GAIN: f64 = 1e-4;
/// Flips are tried of sides that are not Delaunay by the lengths of all around, or not by more than this angle: triangles are no
/// straight ones, and better ones may be a little less Delaunay.
const HOPEFUL: f64 = 0.3;

/// Where errors are what counts, of which few triangles have most: flips are tried of pairs that cost so much, where the mean of triangles is one.
const WORTHWHILE: f64 = 0.5;

/// What a flip would make: the points of both triangles, the new side's and their inner ones among them.
struct Flipped {
    gain: f64,
    half_edge: usize,
    triangles: [[Point; MOST]; 2],
}

/// Flips sides that cost less on the other diagonal, the best first and none beside another; the number of flips.
pub(super) fn flip(elements: &mut Elements, aim: &Aim) -> usize {
    let inner: Vec<usize> = (0..elements.twins.len())
        .filter(|&h| elements.twins[h] != NONE && h < elements.twins[h] as usize && elements.held[h] == NONE)
        .collect();
    let rule = Rule::of(elements.order);
    let found: Vec<Flipped> = inner.par_iter().filter_map(|&h| tried(elements, aim, &rule, h)).collect();
    let mut is_touched = vec![false; elements.triangles.len()];
    let mut flips = 0;
    for (_, i) in ranked(found.iter().zip(0..).map(|(f, i): (&Flipped, usize)| (-f.gain, i))) {
        let pair = Pair::of(elements, found[i].half_edge);
        if pair.triangles().iter().any(|&t| is_touched[t]) || pair.has_other_side(elements) {
            continue;
        }
        pair.triangles().into_iter().for_each(|t| is_touched[t] = true);
        pair.flip(elements, &found[i].triangles);
        flips += 1;
    }
    flips
}

/// What a flip would gain, where it is valid and gains anything.
fn tried(elements: &Elements, aim: &Aim, rule: &Rule, half_edge: usize) -> Option<Flipped> {
    let pair = Pair::of(elements, half_edge);
    if aim.target.is_none() && pair.excess(elements, aim) < -HOPEFUL {
        return None;
    }
    let cost = cost(elements, aim, rule, pair);
    if aim.target.is_some() && cost < WORTHWHILE {
        return None;
    }
    let mut local = Local::of(elements, aim, rule, pair);
    if !local.is_valid() && !local.untangle() {
        return None;
    }
    let guess = local.energy();
    let gain = cost - local.settle(guess);
    (gain > LEAST_GAIN).then_some(Flipped { gain, half_edge, triangles: local.triangles })
}

/// The energy of two triangles and the side between them.
fn cost(elements: &Elements, aim: &Aim, rule: &Rule, pair: Pair) -> f64 {
    let count = elements.count();
    let of_triangle = |t: usize| aim.of_points(rule, &elements.of_triangle(&elements.points, t)[..count]);
    let side: Vec<Point> = elements.side(pair.0[0]).iter().map(|&n| elements.points[n as usize]).collect();
    let of_side = if aim.lengths > 0.0 { side_energy(&side, aim.metric, aim.lengths) } else { 0.0 };
    pair.triangles().map(of_triangle).iter().sum::<f64>() + of_side
}
