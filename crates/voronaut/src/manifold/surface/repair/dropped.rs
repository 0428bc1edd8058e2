//! Triangles that are no part of a surface: with coordinates that are not finite, without area, or there twice.

use super::mended::Damage;
use super::work::Work;
use crate::error::{Error, Result};
use crate::lists::in_order;
use crate::manifold::surface::build::has_area;
use crate::mesh::{Edges, edges_of};

/// Drops triangles with coordinates that are not finite, if damage is to be repaired.
///
/// # Errors
/// [`Error::Domain`] with the vertex, if it is not.
pub(super) fn drop_not_finite(work: &mut Work) -> Result<()> {
    let is_finite = |v: u32| work.mesh.position(v).is_finite();
    let marked: Vec<bool> = work.triangles.iter().map(|t| !t.iter().all(|&v| is_finite(v))).collect();
    let Some(first) = marked.iter().position(|&marked| marked) else { return Ok(()) };
    if !work.options.repair {
        let at = work.triangles[first].into_iter().find(|&v| !is_finite(v)).unwrap_or_default();
        let help = "correct the vertex, or run again with `repair`: its triangles are dropped then";
        return Err(Error::domain("a coordinate is not finite", work.vertex(at), help));
    }
    work.drop_damaged(Damage::NotFinite, &marked);
    Ok(())
}

/// A side this much shorter than the longest is a point, where the triangle has no area.
const NEEDLE: f64 = 1e-12;
/// Flat triangles that lie in a row take turns; rows are short.
const ROUNDS: usize = 32;

/// Drops triangles with a vertex (or a place) twice and those without area, and lets their neighbours meet: the short side of a
/// needle becomes one place; what lies beyond the long side of a cap is cut at the vertex on that side, as by a flip.
///
/// # Errors
/// [`Error::Domain`] with the triangle, where flat triangles lie on flat ones without end; with repair they are dropped.
pub(super) fn drop_degenerate(work: &mut Work) -> Result<()> {
    for _ in 0..ROUNDS {
        drop_repeated(work);
        let flat: Vec<usize> = (0..work.triangles.len()).filter(|&t| !has_area(work.corners(t))).collect();
        if flat.is_empty() {
            return Ok(());
        }
        if !collapse_needles(work, &flat) {
            flip_caps(work, &flat);
        }
    }
    drop_repeated(work);
    let marked: Vec<bool> = (0..work.triangles.len()).map(|t| !has_area(work.corners(t))).collect();
    let Some(first) = marked.iter().position(|&marked| marked) else { return Ok(()) };
    if !work.options.repair {
        let what = format!("triangle {} has no area", work.number(first));
        let help = "remove it and join its neighbours, or run again with `repair`";
        return Err(Error::domain(what, work.triangles[first].map(|v| work.vertex(v)).join(", "), help));
    }
    work.drop_damaged(Damage::Degenerate, &marked);
    Ok(())
}

fn drop_repeated(work: &mut Work) {
    let is_repeated = |[a, b, c]: [u32; 3]| a == b || b == c || c == a;
    let marked: Vec<bool> = (0..work.triangles.len()).map(|t| is_repeated(work.places_of(t))).collect();
    work.drop_damaged(Damage::Degenerate, &marked);
}

/// The lengths of the sides from corner k to k + 1.
fn lengths(work: &Work, t: usize) -> [f64; 3] {
    let p = work.corners(t);
    [0, 1, 2].map(|k| p[k].distance(p[(k + 1) % 3]))
}

/// Whether there was any.
fn collapse_needles(work: &mut Work, flat: &[usize]) -> bool {
    let mut any = false;
    for &t in flat {
        let lengths = lengths(work, t);
        let longest = lengths.into_iter().fold(0.0, f64::max);
        for (length, [p, q]) in lengths.into_iter().zip(edges_of(work.triangles[t])) {
            if length <= NEEDLE * longest {
                any |= work.places.join(p, q);
            }
        }
    }
    work.places.flatten();
    any
}

fn flip_caps(work: &mut Work, flat: &[usize]) {
    let edges = work.edges();
    let (mut is_touched, mut is_dropped) = (vec![false; work.triangles.len()], vec![false; work.triangles.len()]);
    for &t in flat {
        let lengths = lengths(work, t);
        let k = (1..3).fold(0, |most, k| if lengths[k] > lengths[most] { k } else { most });
        let [a, b, middle] = [0, 1, 2].map(|i| work.triangles[t][(k + i) % 3]);
        let [p, q] = [a, b].map(|v| work.places.of(v));
        let beyond = edges.at([p, q]);
        if beyond.iter().any(|side| is_touched[side.triangle()]) {
            continue;
        }
        for side in &beyond {
            let s = side.triangle();
            is_touched[s] = true;
            if s != t {
                work.cut(s, side.half_edge as usize % 3, &[middle]);
            }
        }
        is_dropped[t] = true;
        work.note_triangle(Damage::Degenerate, t);
    }
    is_dropped.resize(work.triangles.len(), false);
    work.drop_marked(&is_dropped);
}

/// Drops duplicate triangles to one.
///
/// Those with the same vertices are duplicates, whichever way they turn. Those at the same places, with vertices of their own,
/// are so only where the vertex numbers do not make them parts of surfaces that lie on each other (the walls of two boxes
/// side by side): where one hangs on nothing, or hangs on an edge of more than two triangles that it shares with the other.
pub(super) fn drop_duplicates(work: &mut Work) {
    let numbers: Vec<_> = work.triangles.iter().copied().map(in_order).collect();
    drop_of_groups(work, &numbers, |group| (0..group.len()).map(|i| i > 0).collect());
    let places: Vec<_> = (0..work.triangles.len()).map(|t| in_order(work.places_of(t))).collect();
    let triangles = work.triangles.clone();
    let by_number = Edges::of(&triangles);
    drop_of_groups(work, &places, |group| {
        let mut doubtful: Vec<bool> = group.iter().map(|&t| is_doubtful(t, group, &triangles, &by_number)).collect();
        if doubtful.iter().all(|&doubtful| doubtful) {
            doubtful[0] = false;
        }
        doubtful
    });
}

/// Drops of the triangles with the same key those that are chosen.
fn drop_of_groups(work: &mut Work, keys: &[[u32; 3]], choose: impl Fn(&[usize]) -> Vec<bool>) {
    let mut order: Vec<usize> = (0..keys.len()).collect();
    order.sort_by_key(|&t| keys[t]);
    let mut marked = vec![false; keys.len()];
    for group in order.chunk_by(|&s, &t| keys[s] == keys[t]).filter(|group| group.len() > 1) {
        for (&t, is_chosen) in group.iter().zip(choose(group)) {
            marked[t] = is_chosen;
        }
    }
    work.drop_damaged(Damage::Duplicate, &marked);
}

/// Triangles of a group that are compared with each other, at most.
const COMPARED: usize = 16;

fn is_doubtful(t: usize, group: &[usize], triangles: &[[u32; 3]], by_number: &Edges) -> bool {
    let own = edges_of(triangles[t]).map(in_order);
    let counts = own.map(|ends| by_number.at(ends).len());
    if counts == [1; 3] {
        return true;
    }
    let has = |s: usize, [p, q]: [u32; 2]| triangles[s].contains(&p) && triangles[s].contains(&q);
    let is_shared = |ends| group.iter().take(COMPARED).any(|&s| s != t && has(s, ends));
    own.into_iter().zip(counts).any(|(ends, count)| count > 2 && is_shared(ends))
}
