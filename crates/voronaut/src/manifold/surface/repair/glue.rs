//! Which sides of triangles are glued to each other, and small pieces that this leaves loose.

use super::mended::Damage;
use super::work::Work;
use crate::error::{Error, Result};
use crate::geometry::Vector3;
use crate::lists::{Classes, in_order};
use crate::mesh::EdgeSide;
use crate::mesh::edges::NONE;

/// For side k of triangle t, at 3 t + k, the side it is glued to, or [`NONE`].
pub(super) type Twins = Vec<u32>;

/// Where more sides than this meet, none are paired by how straight they go on.
const PAIRED: usize = 16;

/// Glues sides that lie between the same places (after "Cutting and Stitching", Gueziec et al. 2001).
///
/// Two sides alone are glued, whatever their vertex numbers: that is how soups become surfaces. Of more, those are that share
/// their numbers in pairs; the others are borders that lie on each other, and stay borders, or with repair are glued where
/// they go on straightest. So a surface by its numbers is never made worse.
///
/// # Errors
/// [`Error::Domain`] of an edge that more than two triangles share by number, unless damage is to be repaired.
pub(super) fn glue(work: &mut Work) -> Result<Twins> {
    let mut twins = vec![NONE; 3 * work.triangles.len()];
    for group in work.edges().iter() {
        match &*group {
            [_] => {}
            [s, t] if is_fold(work, s, t) => {}
            [s, t] => join(&mut twins, s, t),
            group => glue_many(work, &mut twins, group)?,
        }
    }
    Ok(twins)
}

/// The vertex numbers of a side, the smaller first.
pub(super) fn numbers(work: &Work, side: u32) -> [u32; 2] {
    in_order(work.ends(side))
}

/// Whether two triangles at the same places would be glued back to back though their numbers do not ask for it.
fn is_fold(work: &Work, s: &EdgeSide, t: &EdgeSide) -> bool {
    let places = |side: &EdgeSide| in_order(work.places_of(side.triangle()));
    numbers(work, s.half_edge) != numbers(work, t.half_edge) && places(s) == places(t)
}

fn join(twins: &mut Twins, s: &EdgeSide, t: &EdgeSide) {
    (twins[s.half_edge as usize], twins[t.half_edge as usize]) = (t.half_edge, s.half_edge);
}

fn glue_many(work: &mut Work, twins: &mut Twins, group: &[EdgeSide]) -> Result<()> {
    let mut keyed: Vec<([u32; 2], EdgeSide)> = group.iter().map(|s| (numbers(work, s.half_edge), *s)).collect();
    keyed.sort_unstable();
    let mut left = Vec::new();
    for same in keyed.chunk_by(|s, t| s.0 == t.0) {
        match same {
            [(_, s), (_, t)] => join(twins, s, t),
            [(_, s)] => left.push(*s),
            _ => {
                let sides: Vec<EdgeSide> = same.iter().map(|s| s.1).collect();
                cut_edge(work, twins, same[0].0, &sides)?;
            }
        }
    }
    if left.len() > 1 {
        if work.options.repair {
            glue_straightest(work, twins, &left);
        } else {
            work.mended.add(Damage::Borders, work.edge(group[0].ends));
        }
    }
    Ok(())
}

/// An edge that three triangles or more share by number.
fn cut_edge(work: &mut Work, twins: &mut Twins, ends: [u32; 2], sides: &[EdgeSide]) -> Result<()> {
    let place = work.edge(ends);
    if !work.options.repair {
        let [s, t, u] = [0, 1, 2].map(|i| work.number(sides[i].triangle()));
        let what = format!("an edge of {} triangles (among them {s}, {t} and {u})", sides.len());
        let help = "leave at most two triangles at every edge, or run again with `repair`";
        return Err(Error::domain(what, place, help));
    }
    work.mended.add(Damage::Edge, place);
    glue_straightest(work, twins, sides);
    Ok(())
}

fn glue_straightest(work: &Work, twins: &mut Twins, sides: &[EdgeSide]) {
    if sides.len() > PAIRED {
        return;
    }
    let away: Vec<Option<Vector3>> = sides.iter().map(|side| direction(work, side)).collect();
    let mut pairs = Vec::new();
    for i in 0..sides.len() {
        for j in i + 1..sides.len() {
            let (Some(u), Some(v)) = (away[i], away[j]) else { continue };
            if is_fold(work, &sides[i], &sides[j]) {
                continue;
            }
            // Triangles that pass the edge in opposite directions belong together rather than others.
            let agree = if sides[i].forward == sides[j].forward { 0.0 } else { 0.5 };
            pairs.push((u.dot(v) - agree, i, j));
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let mut is_taken = vec![false; sides.len()];
    for (_, i, j) in pairs {
        if !is_taken[i] && !is_taken[j] {
            (is_taken[i], is_taken[j]) = (true, true);
            join(twins, &sides[i], &sides[j]);
        }
    }
}

/// From a side into its triangle, perpendicular to the side.
fn direction(work: &Work, side: &EdgeSide) -> Option<Vector3> {
    let (k, p) = (side.half_edge as usize % 3, work.corners(side.triangle()));
    let [a, b, apex] = [0, 1, 2].map(|i| p[(k + i) % 3]);
    let along = (b - a).unit()?;
    let off = apex - a;
    (off - along * off.dot(along)).unit()
}

/// Pieces of so many triangles at most are dropped,
const MOST: usize = 8;
/// if what they touch has so many times as many at least.
const LARGER: usize = 8;

/// Drops small pieces that touch another part of the surface at an edge that they are not glued to: fins. Says whether there
/// were any; the other sides there may then be glued.
pub(super) fn drop_fins(work: &mut Work, twins: &Twins) -> bool {
    let mut pieces = Classes::new(work.triangles.len());
    for (side, &twin) in (0..).zip(twins).filter(|(_, twin)| **twin != NONE) {
        pieces.join(side / 3, twin / 3);
    }
    pieces.flatten();
    let mut sizes = vec![0_usize; work.triangles.len()];
    (0..work.triangles.len() as u32).for_each(|t| sizes[pieces.of(t) as usize] += 1);
    let mut is_fin = vec![false; work.triangles.len()];
    for group in work.edges().iter().filter(|group| group.len() > 2) {
        let largest = group.iter().map(|side| sizes[pieces.of(side.half_edge / 3) as usize]).max().unwrap_or(0);
        for piece in group.iter().map(|side| pieces.of(side.half_edge / 3) as usize) {
            is_fin[piece] |= sizes[piece] <= MOST && LARGER * sizes[piece] <= largest;
        }
    }
    let marked: Vec<bool> = (0..work.triangles.len() as u32).map(|t| is_fin[pieces.of(t) as usize]).collect();
    work.drop_damaged(Damage::Fin, &marked);
    marked.contains(&true)
}
