//! Few colours for many cells, so that neighbours differ.

use std::collections::BinaryHeap;

/// One of `classes` classes for each of `count` cells: neighbours get different ones, and of those allowed the one that
/// `likeness` (of two classes, from 0 up) makes most unlike those of the neighbours; then the rarest.
///
/// Cells are taken by the number of classes among their neighbours, most first (DSATUR, Brélaz 1979). Where a cell has
/// neighbours in all classes, one of them is like it.
pub(super) fn colour(
    count: usize,
    neighbours: &[[u32; 2]],
    classes: usize,
    likeness: impl Fn(usize, usize) -> f64,
) -> Vec<usize> {
    let around = adjacency(count, neighbours.iter().copied());
    let mut class: Vec<Option<usize>> = vec![None; count];
    let mut taken = vec![0_u64; count];
    let mut used = vec![0_usize; classes];
    let key = |taken: u64, cell: usize| (taken.count_ones(), around[cell].len(), count - cell);
    let mut queue: BinaryHeap<_> = (0..count).map(|cell| key(0, cell)).collect();
    while let Some((saturation, _, from_end)) = queue.pop() {
        let cell = count - from_end;
        if class[cell].is_some() || saturation != taken[cell].count_ones() {
            continue;
        }
        let cost = |c: usize| {
            let near = around[cell].iter().filter_map(|&n| class[n as usize]);
            let clash = if taken[cell] >> c & 1 == 1 { 1e6 } else { 0.0 };
            clash + near.map(|other| likeness(c, other)).sum::<f64>() + used[c] as f64 / (count as f64)
        };
        let best = (0..classes).min_by(|&a, &b| cost(a).total_cmp(&cost(b))).unwrap_or(0);
        class[cell] = Some(best);
        used[best] += 1;
        for &n in around[cell].iter().filter(|&&n| class[n as usize].is_none()) {
            taken[n as usize] |= 1 << best;
            queue.push(key(taken[n as usize], n as usize));
        }
    }
    class.into_iter().map(Option::unwrap_or_default).collect()
}

/// The neighbours of each of `count` cells; in increasing order if pairs are, the smaller first.
pub(super) fn adjacency(count: usize, neighbours: impl Iterator<Item = [u32; 2]>) -> Vec<Vec<u32>> {
    let mut around = vec![Vec::new(); count];
    for [a, b] in neighbours {
        around[a as usize].push(b);
        around[b as usize].push(a);
    }
    around
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_differ() {
        // A triangulated grid, planar and with degree six.
        let side = 30_u32;
        let at = |i: u32, j: u32| i * side + j;
        let mut pairs = Vec::new();
        for i in 0..side {
            for j in 0..side {
                if j + 1 < side {
                    pairs.push([at(i, j), at(i, j + 1)]);
                }
                if i + 1 < side {
                    pairs.push([at(i, j), at(i + 1, j)]);
                }
                if i + 1 < side && j + 1 < side {
                    pairs.push([at(i, j), at(i + 1, j + 1)]);
                }
            }
        }
        let likeness = |a: usize, b: usize| 1.0 / (1.0 + a.abs_diff(b) as f64);
        let class = colour((side * side) as usize, &pairs, 6, likeness);
        assert!(pairs.iter().all(|&[a, b]| class[a as usize] != class[b as usize]));
        for c in 0..6 {
            assert!(class.iter().filter(|&&x| x == c).count() > 50, "class {c} is hardly used");
        }
        assert_eq!(colour(2, &[[0, 1]], 1, likeness), [0, 0]);
    }
}
