//! Periodic pairs: boundary curves, named by two labels, that a rigid motion maps onto each other.

use super::{Chain, Domain, Pslg};
use crate::error::{Error, Result};
use crate::geometry::{Motion, Point};
use crate::lists::{distinct, in_order};
use crate::triangulation::{HalfEdge, VertexId};
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// Two curves of the boundary in step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pair {
    /// Their labels.
    pub labels: [i32; 2],
    /// What brings the first to the second.
    pub motion: Motion,
    /// Points of the graph along each, in step: those of the first with the domain on the left, of the second on the right.
    pub runs: [Vec<u32>; 2],
}

/// How far the image of the one curve may be from the other, as a share of its length: files often have six digits.
const TOLERANCE: f64 = 1e-5;
/// Lengths that differ by more than this share are those of different curves.
const UNEQUAL: f64 = 0.05;
/// Places along both curves from which the motion is first estimated.
const PLACES: usize = 16;

/// The periodic pairs of a domain by their labels, and the domain without corners that only one curve of a pair has and that are next to
/// none: in the middle of a straight run one curve may have kept vertices, to rounding, and the other not.
///
/// # Errors
/// [`Error::Domain`] of labels that are not those of a run of boundary segments from one end to another, or that no motion maps onto each other:
/// with the corner that does not fit, and by how much.
pub(crate) fn paired(domain: &Domain, asked: &[[i32; 2]]) -> Result<(Domain, Vec<Pair>)> {
    demand_distinct(asked)?;
    let mut domain = domain.clone();
    let mut pairs = pairs_of(&domain, asked)?;
    let lone: BTreeSet<u32> = pairs.iter().flat_map(|(_, lone)| lone.iter().copied()).collect();
    if !lone.is_empty() {
        let mut chains = domain.pslg().chains();
        for chain in &mut chains {
            let last = chain.vertices.len() - 1;
            let vertices = chain.vertices.iter().enumerate();
            let kept = vertices.filter(|&(i, v)| i == 0 || i == last || !lone.contains(v));
            chain.vertices = kept.map(|(_, &v)| v).collect();
        }
        domain = Domain::new(&domain.pslg().with_chains(&chains))?;
        pairs = pairs_of(&domain, asked)?;
    }
    let whole = |(pair, lone): (Pair, Vec<u32>)| match lone.first() {
        None => Ok(pair),
        Some(&corner) => Err(no_partner(domain.pslg(), pair.labels, corner, "other curves or marks begin there", None)),
    };
    let pairs = pairs.into_iter().map(whole).collect::<Result<_>>()?;
    Ok((domain, pairs))
}

/// Refuses labels that are named twice.
fn demand_distinct(asked: &[[i32; 2]]) -> Result<()> {
    let mut labels = BTreeSet::new();
    match asked.as_flattened().iter().find(|&&label| !labels.insert(label)) {
        None => Ok(()),
        Some(label) => {
            let help = "give each of the curves a label of its own, and name it in one pair of `periodic`";
            Err(Error::unsupported(format!("label {label} twice in `periodic`"), help))
        }
    }
}

/// The pairs, each with the points that have no partner.
fn pairs_of(domain: &Domain, asked: &[[i32; 2]]) -> Result<Vec<(Pair, Vec<u32>)>> {
    asked.iter().map(|&labels| pair(domain, labels)).collect()
}

fn pair(domain: &Domain, labels: [i32; 2]) -> Result<(Pair, Vec<u32>)> {
    let pslg = domain.pslg();
    let [first, mut second] = [run(domain, labels[0])?, run(domain, labels[1])?];
    second.reverse();
    let runs = [first, second];
    let curves = runs.each_ref().map(|run| run.iter().map(|&v| pslg.points[v as usize]).collect::<Vec<_>>());
    let behind = curves.each_ref().map(|curve| lengths_behind(curve));
    let lengths = behind.each_ref().map(|behind| behind[behind.len() - 1]);
    if (lengths[0] - lengths[1]).abs() > UNEQUAL * lengths[0].max(lengths[1]) {
        let what = format!(
            "the curves with labels {} and {} have lengths {} and {}",
            labels[0], labels[1], lengths[0], lengths[1]
        );
        return Err(Error::domain(what, pslg.describe(runs[1][0]), CONGRUENT));
    }
    let tolerance = TOLERANCE * lengths[0];
    let (motion, matched) = motion(&curves, &behind, tolerance);
    let image: Vec<Point> = curves[0].iter().map(|&p| motion.image(p)).collect();
    let lone = lone([&image, &curves[1]], &matched, tolerance).map_err(|(side, i, off)| {
        no_partner(pslg, [labels[side], labels[1 - side]], runs[side][i], "the curves do not fit there", Some(off))
    })?;
    let lone = lone.into_iter().map(|[side, i]| runs[side][i]).collect();
    let runs = [0, 1].map(|i| matched.iter().map(|at| runs[i][at[i]]).collect());
    Ok((Pair { labels, motion, runs }, lone))
}

const CONGRUENT: &str =
    "the two curves of a pair have to be equal but for a rotation and a translation: give them the same corners";

/// That a point of the first label has no partner on the second.
fn no_partner(pslg: &Pslg, labels: [i32; 2], point: u32, why: &str, off: Option<f64>) -> Error {
    let off = off.map_or_else(String::new, |off| format!(": it is {off:.3e} off"));
    let [of, on] = labels;
    let what = format!("a corner of label {of} has no partner on label {on}{off} ({why})");
    Error::domain(what, pslg.describe(point), CONGRUENT)
}

/// The points along the boundary segments with a label, the domain being on the left.
fn run(domain: &Domain, label: i32) -> Result<Vec<u32>> {
    let (pslg, topology) = (domain.pslg(), &domain.planar().topology);
    let ours = pslg.segments.iter().position(|segment| segment.label == label);
    let Some(first) = ours else {
        let labels = distinct(pslg.segments.iter().map(|segment| segment.label));
        let labels: Vec<String> = labels.iter().map(i32::to_string).collect();
        let what = format!("no boundary has label {label}");
        return Err(Error::domain(
            what,
            "`periodic`",
            format!("labels of the domain's curves are {}", labels.join(", ")),
        ));
    };
    let fault = |what: &str, point: u32| {
        let what = format!("the segments with label {label} {what}");
        let help = "a periodic pair needs two runs of boundary segments, each from one end to another: give each run a label of its own";
        Err(Error::domain(what, pslg.describe(point), help))
    };
    let source = |v: VertexId| domain.sources()[v.index()].expect("a corner of the domain is a point of its graph");
    let is_ours = |&h: &HalfEdge| topology.constraint(h).is_some_and(|c| pslg.segments[c.0 as usize].label == label);
    let mut next = BTreeMap::new();
    for h in topology.borders().filter(is_ours) {
        let [from, to] = topology.ends(h).map(source);
        if next.insert(from, to).is_some() {
            return fault("fork", from);
        }
    }
    if next.len() < pslg.segments.iter().filter(|segment| segment.label == label).count() {
        return fault(
            "are not all at the boundary: some have the domain on both sides, the first of all beginning",
            pslg.segments[first].ends[0],
        );
    }
    let ends: BTreeSet<u32> = next.values().copied().collect();
    let starts: Vec<u32> = next.keys().copied().filter(|v| !ends.contains(v)).collect();
    match starts[..] {
        [start] => {
            let run: Vec<u32> = std::iter::successors(Some(start), |v| next.get(v).copied()).collect();
            if run.len() <= next.len() { fault("close", run[0]) } else { Ok(run) }
        }
        [] => fault("close", pslg.segments[first].ends[0]),
        [_, other, ..] => fault(&format!("are in {} pieces, one of them beginning", starts.len()), other),
    }
}

/// The length of a polyline up to each of its points.
fn lengths_behind(points: &[Point]) -> Vec<f64> {
    let mut behind = vec![0.0];
    for pair in points.windows(2) {
        behind.push(behind[behind.len() - 1] + pair[0].distance(pair[1]));
    }
    behind
}

/// Places at equal steps along a polyline, its ends among them.
fn along(points: &[Point], behind: &[f64]) -> Vec<Point> {
    let last = points.len() - 1;
    let place = |k: usize| {
        let target = behind[last] * k as f64 / PLACES as f64;
        let i = behind.partition_point(|&l| l < target).clamp(1, last);
        points[i - 1].lerp(points[i], (target - behind[i - 1]) / (behind[i] - behind[i - 1]))
    };
    (0..=PLACES)
        .map(|k| match k {
            0 => points[0],
            PLACES => points[last],
            k => place(k),
        })
        .collect()
}

/// The motion that brings most corners of the one curve to corners of the other, and these.
fn motion(curves: &[Vec<Point>; 2], behind: &[Vec<f64>; 2], tolerance: f64) -> (Motion, Vec<[usize; 2]>) {
    let matched = |motion: Motion, tolerance: f64| {
        let image: Vec<Point> = curves[0].iter().map(|&p| motion.image(p)).collect();
        in_step([&image, &curves[1]], behind, tolerance)
    };
    // Ends tell where a corner is out of place, places all along where the ends are close together.
    let ends = curves.each_ref().map(|curve| vec![curve[0], curve[curve.len() - 1]]);
    let places = [0, 1].map(|i| along(&curves[i], &behind[i]));
    let estimates = [ends, places].map(|[a, b]| Motion::between(&a, &b));
    let [first, second] = estimates.map(|motion| (motion, matched(motion, 4.0 * tolerance)));
    let (estimate, corners) = if second.1.len() > first.1.len() { second } else { first };
    let [a, b] = [0, 1].map(|i| corners.iter().map(|at| curves[i][at[i]]).collect::<Vec<Point>>());
    let motion = if corners.len() > 1 { Motion::between(&a, &b) } else { estimate };
    (motion, matched(motion, tolerance))
}

/// The points of two polylines, by their numbers, that are at the same places, in order.
fn in_step(curves: [&[Point]; 2], behind: &[Vec<f64>; 2], tolerance: f64) -> Vec<[usize; 2]> {
    let ([mut i, mut j], mut matched) = ([0, 0], Vec::new());
    while i < curves[0].len() && j < curves[1].len() {
        if curves[0][i].distance(curves[1][j]) <= tolerance {
            matched.push([i, j]);
            (i, j) = (i + 1, j + 1);
        } else if behind[0][i] < behind[1][j] {
            i += 1;
        } else {
            j += 1;
        }
    }
    matched
}

/// The points without partner, by their polyline and number, all of them next to the chord between those beside them that have one.
///
/// # Errors
/// One that is not, and how far it is from the other polyline.
fn lone(
    curves: [&[Point]; 2],
    matched: &[[usize; 2]],
    tolerance: f64,
) -> std::result::Result<Vec<[usize; 2]>, (usize, usize, f64)> {
    let mut lone = Vec::new();
    for side in [0, 1] {
        let (own, other) = (curves[side], curves[1 - side]);
        let kept: Vec<usize> = matched.iter().map(|at| at[side]).collect();
        let off = |i: usize| {
            let distances = other.windows(2).map(|pair| own[i].distance(own[i].nearest_between(pair[0], pair[1])));
            distances.fold(f64::INFINITY, f64::min)
        };
        // Ends have to be at ends.
        for (end, opposite) in [(0, 0), (own.len() - 1, other.len() - 1)] {
            if !kept.contains(&end) {
                return Err((side, end, own[end].distance(other[opposite])));
            }
        }
        for pair in kept.windows(2) {
            for i in pair[0] + 1..pair[1] {
                let chord = own[i].nearest_between(own[pair[0]], own[pair[1]]);
                if own[i].distance(chord) > tolerance {
                    return Err((side, i, off(i)));
                }
                lone.push([side, i]);
            }
        }
    }
    Ok(lone)
}

/// The curves of a graph, those of pairs in step: a pair's are cut where either ends, and come as two chains with as many vertices each.
pub(crate) fn curves_in_step(pslg: &Pslg, pairs: &[Pair]) -> Vec<Vec<Chain>> {
    let chains = pslg.chains();
    let ends: BTreeSet<u32> = chains.iter().flat_map(|c| [c.vertices[0], c.vertices[c.vertices.len() - 1]]).collect();
    let labels: BTreeSet<i32> = pairs.iter().flat_map(|pair| pair.labels).collect();
    let (paired, alone): (Vec<Chain>, Vec<Chain>) = chains.into_iter().partition(|c| labels.contains(&c.kind.label));
    let mut curves: Vec<Vec<Chain>> = alone.into_iter().map(|chain| vec![chain]).collect();
    let by_ends: HashMap<[u32; 2], usize> = if paired.is_empty() {
        HashMap::new()
    } else {
        pslg.segments.iter().enumerate().map(|(i, segment)| (in_order(segment.ends), i)).collect()
    };
    let chain = |run: &[u32]| {
        let kind = pslg.segments[by_ends[&in_order([run[0], run[1]])]];
        Chain { vertices: run.to_vec(), kind: if kind.ends[0] == run[0] { kind } else { kind.turned() } }
    };
    for Pair { runs, .. } in pairs {
        let last = runs[0].len() - 1;
        let is_end = |&i: &usize| i == 0 || i == last || runs.iter().any(|run| ends.contains(&run[i]));
        let cuts: Vec<usize> = (0..=last).filter(is_end).collect();
        curves.extend(cuts.windows(2).map(|cut| runs.iter().map(|run| chain(&run[cut[0]..=cut[1]])).collect()));
    }
    curves
}
