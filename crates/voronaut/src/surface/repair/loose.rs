//! Pieces that cutting leaves loose.

use super::classes::Classes;
use super::glue::{NONE, Twins};
use super::mended::Damage;
use super::work::Work;

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
    for group in work.sides().chunk_by(|s, t| s.ends == t.ends).filter(|group| group.len() > 2) {
        let largest = group.iter().map(|side| sizes[pieces.of(side.triangle) as usize]).max().unwrap_or(0);
        for piece in group.iter().map(|side| pieces.of(side.triangle) as usize) {
            is_fin[piece] |= sizes[piece] <= MOST && LARGER * sizes[piece] <= largest;
        }
    }
    let marked: Vec<bool> = (0..work.triangles.len() as u32).map(|t| is_fin[pieces.of(t) as usize]).collect();
    for t in (0..marked.len()).filter(|&t| marked[t]) {
        work.note_triangle(Damage::Fin, t);
    }
    work.drop_marked(&marked);
    marked.contains(&true)
}
