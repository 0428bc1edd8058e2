//! The vertices of a mesh that correspond, because two curves of the boundary were sampled as one.

use crate::error::{Error, Result};
use crate::geometry::Point;
use crate::manifold::domain::Pair;
use crate::mesh::{Mesh, Network, Periodic};
use crate::sampling::Plan;
use std::collections::HashMap;

/// The corresponding vertices of a mesh of the domain, by its pairs of curves.
///
/// # Errors
/// [`Error::Limit`] where rounding left the one curve another vertex than the other.
pub(super) fn correspondence(mesh: &Mesh, plan: &Plan) -> Result<Vec<Periodic>> {
    plan.pairs.iter().map(|pair| of_pair(mesh, &plan.domain.pslg().points, pair)).collect()
}

fn of_pair(mesh: &Mesh, points: &[Point], pair: &Pair) -> Result<Periodic> {
    let corners: [Vec<Point>; 2] = pair.runs.each_ref().map(|run| run.iter().map(|&v| points[v as usize]).collect());
    let [first, second] = [0, 1].map(|side| path(mesh, pair.labels[side], corners[side][0]));
    let numbers = corners.each_ref().map(|corners| corners.iter().map(|&p| key(p)).zip(0..).collect());
    let number = |side: usize, v: u32| -> Option<usize> {
        let numbers: &HashMap<[u64; 2], usize> = &numbers[side];
        numbers.get(&key(mesh.point(v))).copied()
    };
    let mut off: f64 = 0.0;
    let mut is_partner = |&(&a, &b): &(&u32, &u32)| {
        let (image, there) = (pair.motion.image(mesh.point(a)), mesh.point(b));
        let corner = number(0, a);
        if corner.is_some() {
            off = off.max(image.distance(there));
        }
        corner == number(1, b) && (corner.is_some() || key(image) == key(there))
    };
    let differs = first.iter().zip(&second).find(|ends| !is_partner(ends)).map(|(&a, _)| a);
    if first.len() != second.len() || differs.is_some() {
        let at = differs.or(first.last().copied()).map_or_else(String::new, |v| format!(" at {}", mesh.point(v)));
        let [a, b] = pair.labels;
        let what = format!("rounding leaves no room for the same edges on the curves with labels {a} and {b}{at}");
        return Err(Error::limit(what, "give more exact coordinates, or a coarser metric there"));
    }
    Ok(Periodic {
        labels: pair.labels,
        rotation: pair.motion.rotation,
        translation: pair.motion.translation,
        off,
        vertices: first.into_iter().zip(second).map(|(a, b)| [a, b]).collect(),
    })
}

/// A position as a key, -0 counting as 0.
fn key(p: Point) -> [u64; 2] {
    [p.x + 0.0, p.y + 0.0].map(f64::to_bits)
}

/// The vertices along the edges with a label, which are one path, from the end that is here.
fn path(mesh: &Mesh, label: i32, from: Point) -> Vec<u32> {
    let listed = mesh.edges.iter().zip(&mesh.edge_labels).filter(|(_, l)| **l == label);
    let network = Network::new(mesh.points.len(), listed.map(|(&ends, _)| ends));
    let mut path = Vec::new();
    for (start, edges) in network.chains(|v| network.at(v).len() != 2) {
        path.push(start);
        for edge in edges {
            path.push(network.across(path[path.len() - 1], edge));
        }
    }
    if path.last().is_some_and(|&v| mesh.point(v) == from) {
        path.reverse();
    }
    path
}
