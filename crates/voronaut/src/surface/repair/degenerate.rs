//! Triangles with a vertex twice, and without area.

use super::mended::Damage;
use super::work::Work;
use crate::error::{Error, Result};
use crate::surface::build::has_area;

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
    (0..marked.len()).filter(|&t| marked[t]).for_each(|t| work.note_triangle(Damage::Degenerate, t));
    work.drop_marked(&marked);
    Ok(())
}

fn drop_repeated(work: &mut Work) {
    let is_repeated = |[a, b, c]: [u32; 3]| a == b || b == c || c == a;
    let marked: Vec<bool> = (0..work.triangles.len()).map(|t| is_repeated(work.places_of(t))).collect();
    (0..marked.len()).filter(|&t| marked[t]).for_each(|t| work.note_triangle(Damage::Degenerate, t));
    work.drop_marked(&marked);
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
        let [a, b, c] = work.triangles[t];
        for (length, [p, q]) in lengths.into_iter().zip([[a, b], [b, c], [c, a]]) {
            if length <= NEEDLE * longest {
                any |= work.places.join(p, q);
            }
        }
    }
    work.places.flatten();
    any
}

fn flip_caps(work: &mut Work, flat: &[usize]) {
    let sides = work.sides();
    let (mut is_touched, mut is_dropped) = (vec![false; work.triangles.len()], vec![false; work.triangles.len()]);
    for &t in flat {
        let lengths = lengths(work, t);
        let k = (1..3).fold(0, |most, k| if lengths[k] > lengths[most] { k } else { most });
        let [a, b, middle] = [0, 1, 2].map(|i| work.triangles[t][(k + i) % 3]);
        let [p, q] = [a, b].map(|v| work.places.of(v));
        let ends = [p.min(q), p.max(q)];
        let start = sides.partition_point(|side| side.ends < ends);
        let beyond: Vec<_> = sides[start..].iter().take_while(|side| side.ends == ends).collect();
        if beyond.iter().any(|side| is_touched[side.triangle as usize]) {
            continue;
        }
        for side in beyond {
            let s = side.triangle as usize;
            is_touched[s] = true;
            if s != t {
                let k = work.side_index(side);
                work.cut(s, k, &[middle]);
            }
        }
        is_dropped[t] = true;
        work.note_triangle(Damage::Degenerate, t);
    }
    is_dropped.resize(work.triangles.len(), false);
    work.drop_marked(&is_dropped);
}
