//! Triangles that are there more than once.

use super::mended::Damage;
use super::work::Work;
use crate::surface::orient::{Side, sides};

/// Drops duplicate triangles to one.
///
/// Those with the same vertices are duplicates, whichever way they turn. Those at the same places, with vertices of their own,
/// are so only where the vertex numbers do not make them parts of surfaces that lie on each other (the walls of two boxes
/// side by side): where one hangs on nothing, or hangs on an edge of more than two triangles that it shares with the other.
pub(super) fn drop_duplicates(work: &mut Work) {
    let sorted = |mut triangle: [u32; 3]| {
        triangle.sort_unstable();
        triangle
    };
    let numbers: Vec<_> = work.triangles.iter().map(|&triangle| sorted(triangle)).collect();
    drop_of_groups(work, &numbers, |group| (0..group.len()).map(|i| i > 0).collect());
    let places: Vec<_> = (0..work.triangles.len()).map(|t| sorted(work.places_of(t))).collect();
    let by_number = sides(&work.triangles);
    let triangles = work.triangles.clone();
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
    for t in (0..marked.len()).filter(|&t| marked[t]) {
        work.note_triangle(Damage::Duplicate, t);
    }
    work.drop_marked(&marked);
}

/// Triangles of a group that are compared with each other, at most.
const COMPARED: usize = 16;

fn is_doubtful(t: usize, group: &[usize], triangles: &[[u32; 3]], by_number: &[Side]) -> bool {
    let [a, b, c] = triangles[t];
    let own = [[a, b], [b, c], [c, a]].map(|[p, q]| [p.min(q), p.max(q)]);
    let count = |ends: [u32; 2]| {
        let start = by_number.partition_point(|side| side.ends < ends);
        by_number[start..].iter().take_while(|side| side.ends == ends).take(3).count()
    };
    let counts = own.map(count);
    if counts == [1; 3] {
        return true;
    }
    let has = |s: usize, [p, q]: [u32; 2]| triangles[s].contains(&p) && triangles[s].contains(&q);
    let is_shared = |ends| group.iter().take(COMPARED).any(|&s| s != t && has(s, ends));
    own.into_iter().zip(counts).any(|(ends, count)| count > 2 && is_shared(ends))
}
