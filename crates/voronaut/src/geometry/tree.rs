//! A static binary tree of boxes: which of many points, segments or triangles are near a place.
//!
//! Flat, built once, read by any number of threads without allocating; what is found first of several that are equally near
//! depends on the items alone.

use super::{Aabb, Aabb3, Point};
use crate::lists::in_order;
use crate::parallel::{join, prelude::*};

/// Items in boxes of so many dimensions.
#[derive(Clone, Debug)]
pub(crate) struct BoxTree<T, const D: usize> {
    /// Those of a leaf stand beside each other.
    items: Vec<(Bounds<D>, T)>,
    /// In depth-first order: the first child of an inner node follows it.
    nodes: Vec<Node<D>>,
}

/// The least and the largest coordinates.
pub(crate) type Bounds<const D: usize> = [[f64; D]; 2];

/// A box, and either items (`count > 0`) from position `next`, or a second child at `next`.
#[derive(Clone, Copy, Debug)]
struct Node<const D: usize> {
    bounds: Bounds<D>,
    next: u32,
    count: u32,
}

/// Items per leaf.
const LEAF: usize = 4;

/// Halves of so many items and more are built side by side.
const APART: usize = 2048;

/// Median splits halve the items, so that 2^32 of them are at most this deep.
const MAX_DEPTH: usize = 32;

impl<T, const D: usize> BoxTree<T, D> {
    /// The tree of items, each with a box that holds it.
    pub(crate) fn new(items: impl IntoIterator<Item = (Bounds<D>, T)>) -> Self {
        let mut items: Vec<Option<(Bounds<D>, T)>> = items.into_iter().map(Some).collect();
        let boxes: Vec<Bounds<D>> = items.iter().flatten().map(|item| item.0).collect();
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::with_capacity(boxes.len());
        if !boxes.is_empty() {
            build(&boxes, &mut order, 0, &mut nodes);
        }
        Self { items: order.into_iter().filter_map(|i| items[i as usize].take()).collect(), nodes }
    }

    /// The items whose boxes have a point in common with a box, if only of their borders.
    pub(crate) fn meeting(&self, bounds: Bounds<D>) -> impl Iterator<Item = &T> {
        let mut pending = [0; MAX_DEPTH + 1];
        let mut count = usize::from(!self.nodes.is_empty());
        let leaves = std::iter::from_fn(move || {
            while count > 0 {
                count -= 1;
                let index: usize = pending[count];
                let node = &self.nodes[index];
                if !boxes_meet(&node.bounds, &bounds) {
                    continue;
                }
                if node.count > 0 {
                    return Some(self.leaf(node));
                }
                pending[count] = node.next as usize;
                pending[count + 1] = index + 1;
                count += 2;
            }
            None
        });
        leaves.flatten().filter(move |(own, _)| boxes_meet(own, &bounds)).map(|(_, item)| item)
    }

    /// The item with the least squared distance from `p`, of several the first that is met; `None` of no item.
    pub(crate) fn nearest(&self, p: [f64; D], square: impl Fn(&T) -> f64) -> Option<&T> {
        self.nearer(p, f64::INFINITY, square)
    }

    /// The same of those alone that are nearer than a squared distance; at infinity all are.
    pub(crate) fn nearer(&self, p: [f64; D], within: f64, square: impl Fn(&T) -> f64) -> Option<&T> {
        let (mut best, mut item_there) = (within, None);
        self.search(p, within, |_, item| {
            let found = square(item);
            if found < best || (item_there.is_none() && within == f64::INFINITY) {
                (best, item_there) = (found.min(best), Some(item));
            }
            best
        });
        item_there
    }

    /// Calls `visit` with all items whose box is nearer to `p` than the bound, nearer boxes first, and their places in the tree. `visit`
    /// returns the new bound, a squared distance.
    pub(crate) fn search<'a>(&'a self, p: [f64; D], bound: f64, visit: impl FnMut(u32, &'a T) -> f64) {
        self.search_by(bound, |bounds| squared_distance(bounds, p), visit);
    }

    /// What is at a place in the tree.
    pub(crate) fn item(&self, place: u32) -> Option<&T> {
        self.items.get(place as usize).map(|(_, item)| item)
    }

    /// [`BoxTree::search`] by any distance of boxes: that of one is no more than that of what it holds.
    pub(crate) fn search_by<'a>(
        &'a self,
        mut bound: f64,
        distance: impl Fn(&Bounds<D>) -> f64,
        mut visit: impl FnMut(u32, &'a T) -> f64,
    ) {
        let mut pending = [(0, 0.0); MAX_DEPTH];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let (mut index, nearest) = pending[count];
            if nearest >= bound {
                continue;
            }
            loop {
                let node = &self.nodes[index];
                if node.count > 0 {
                    for (place, (bounds, item)) in (node.next..).zip(self.leaf(node)) {
                        // Both are infinite far out.
                        if distance(bounds) <= bound {
                            bound = visit(place, item);
                        }
                    }
                    break;
                }
                let first = (index + 1, distance(&self.nodes[index + 1].bounds));
                let second = (node.next as usize, distance(&self.nodes[node.next as usize].bounds));
                let (near, far) = if second.1 < first.1 { (second, first) } else { (first, second) };
                if far.1 < bound {
                    pending[count] = far;
                    count += 1;
                }
                if near.1 >= bound {
                    break;
                }
                index = near.0;
            }
        }
    }

    fn leaf(&self, node: &Node<D>) -> &[(Bounds<D>, T)] {
        &self.items[node.next as usize..(node.next + node.count) as usize]
    }
}

impl From<Aabb> for Bounds<2> {
    fn from(Aabb { min, max }: Aabb) -> Self {
        [[min.x, min.y], [max.x, max.y]]
    }
}

impl From<Aabb3> for Bounds<3> {
    fn from(Aabb3 { min, max }: Aabb3) -> Self {
        [min.to_array(), max.to_array()]
    }
}

/// What `met` makes of the numbers of boxes that meet, in order, the smaller number first; only of pairs of which one at least is
/// `asked` for. O(n log n) where boxes meet few others.
pub(crate) fn meeting_pairs<const D: usize, T: Send>(
    boxes: &[Bounds<D>],
    asked: impl Fn(usize) -> bool + Sync,
    met: impl Fn([usize; 2]) -> Option<T> + Sync,
) -> Vec<([usize; 2], T)> {
    let tree = BoxTree::new(boxes.iter().copied().zip(0..));
    let of_one = |i: usize| {
        // Of two that are asked for, the smaller one looks.
        let others = tree.meeting(boxes[i]).copied().filter(|&j| if asked(j) { i < j } else { i != j });
        others.map(|j| in_order([i, j])).filter_map(|pair| Some((pair, met(pair)?))).collect::<Vec<_>>()
    };
    let looking = (0..boxes.len()).into_par_iter().filter(|&i| asked(i));
    let mut all: Vec<([usize; 2], T)> = looking.flat_map_iter(of_one).collect();
    all.sort_unstable_by_key(|met| met.0);
    all
}

/// The box of a segment.
pub(crate) fn around([p, q]: [Point; 2]) -> Bounds<2> {
    [[p.x.min(q.x), p.y.min(q.y)], [p.x.max(q.x), p.y.max(q.y)]]
}

/// What is within so much of a box.
pub(crate) fn widened<const D: usize>([low, high]: Bounds<D>, by: f64) -> Bounds<D> {
    [low.map(|x| x - by), high.map(|x| x + by)]
}

/// Adds the nodes of a tree of these boxes, whose items begin at a position.
fn build<const D: usize>(boxes: &[Bounds<D>], order: &mut [u32], position: usize, nodes: &mut Vec<Node<D>>) {
    let bounds = order.iter().map(|&i| boxes[i as usize]).reduce(union).expect("a node holds at least one item");
    let index = nodes.len();
    if order.len() <= LEAF {
        nodes.push(Node { bounds, next: position as u32, count: order.len() as u32 });
        return;
    }
    nodes.push(Node { bounds, next: 0, count: 0 });
    let extent = |k: &usize| bounds[1][*k] - bounds[0][*k];
    let longest = (0..D).max_by(|j, k| extent(j).total_cmp(&extent(k))).unwrap_or(0);
    let middle_of = |i: &u32| {
        let [low, high] = boxes[*i as usize].map(|corner| corner[longest]);
        0.5 * low + 0.5 * high
    };
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |i, j| middle_of(i).total_cmp(&middle_of(j)).then(i.cmp(j)));
    let (lower, upper) = order.split_at_mut(middle);
    if middle < APART {
        build(boxes, lower, position, nodes);
        nodes[index].next = nodes.len() as u32;
        build(boxes, upper, position + middle, nodes);
        return;
    }
    let apart = |order, position| {
        let mut own = Vec::new();
        build(boxes, order, position, &mut own);
        own
    };
    let halves = join(|| apart(lower, position), || apart(upper, position + middle));
    for half in [halves.0, halves.1] {
        let first = nodes.len() as u32;
        nodes[index].next = first;
        let placed = |node: Node<D>| if node.count == 0 { Node { next: node.next + first, ..node } } else { node };
        nodes.extend(half.into_iter().map(placed));
    }
}

fn union<const D: usize>(a: Bounds<D>, b: Bounds<D>) -> Bounds<D> {
    [std::array::from_fn(|k| a[0][k].min(b[0][k])), std::array::from_fn(|k| a[1][k].max(b[1][k]))]
}

/// Whether two boxes have a point in common, if only of their borders.
pub(super) fn boxes_meet<const D: usize>([a_low, a_high]: &Bounds<D>, [b_low, b_high]: &Bounds<D>) -> bool {
    (0..D).all(|k| a_low[k] <= b_high[k] && b_low[k] <= a_high[k])
}

fn squared_distance<const D: usize>([low, high]: &Bounds<D>, p: [f64; D]) -> f64 {
    // Comparisons are one instruction each, where `f64::max` looks for NaN as well.
    let larger = |a: f64, b: f64| if a > b { a } else { b };
    let outside = |k: usize| larger(larger(low[k] - p[k], p[k] - high[k]), 0.0);
    (0..D).map(|k| outside(k) * outside(k)).sum()
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact results are the point")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn square<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
        (0..D).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum()
    }

    proptest! {
        #[test]
        fn finds_the_nearest_of_many_points(
            points in prop::collection::vec(prop::array::uniform3(-1.0..1.0), 1..200),
            p in prop::array::uniform3(-2.0..2.0),
        ) {
            let tree = BoxTree::new(points.iter().map(|&q| ([q, q], q)));
            let found = *tree.nearest(p, |&q| square(p, q)).unwrap();
            let truth = points.iter().map(|&q| square(p, q)).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(square(p, found), truth);
        }

        #[test]
        fn finds_the_boxes_that_meet_one(
            corners in prop::collection::vec((-1.0..1.0, -1.0..1.0, 0.0..0.3, 0.0..0.3), 1..200),
        ) {
            let boxes: Vec<Bounds<2>> = corners.into_iter().map(|(x, y, w, h)| [[x, y], [x + w, y + h]]).collect();
            let tree = BoxTree::new(boxes.iter().copied().zip(0..));
            let mut seen: Vec<usize> = tree.meeting(boxes[0]).copied().collect();
            seen.sort_unstable();
            let truth: Vec<usize> = (0..boxes.len()).filter(|&i| boxes_meet(&boxes[i], &boxes[0])).collect();
            prop_assert_eq!(seen, truth);
        }
    }

    #[test]
    fn halves_that_are_built_apart_are_one_tree() {
        let point = |i: usize| [i, i * i].map(|k| (k as f64 * std::f64::consts::SQRT_2).fract());
        let count = 3 * APART;
        let tree = BoxTree::new((0..count).map(|i| ([point(i); 2], i)));
        for i in 0..count {
            assert_eq!(tree.nearest(point(i), |&j| square(point(i), point(j))), Some(&i));
        }
    }

    #[test]
    fn an_empty_tree_has_no_items() {
        let tree: BoxTree<(), 2> = BoxTree::new([]);
        assert!(tree.nearest([0.0; 2], |()| 0.0).is_none());
        assert_eq!(tree.meeting([[-1.0; 2], [1.0; 2]]).count(), 0);
    }

    #[test]
    fn many_equal_boxes_are_split_all_the_same() {
        let tree = BoxTree::new([[[1.0, 1.0], [2.0, 2.0]]; 100].into_iter().zip(0..));
        let mut seen = [false; 100];
        tree.search([0.0; 2], f64::INFINITY, |_, &i: &usize| {
            seen[i] = true;
            f64::INFINITY
        });
        assert!(seen.iter().all(|&s| s));
    }

    #[test]
    fn distances_beyond_numbers_are_found_all_the_same() {
        let tree = BoxTree::new([([[1e300; 2]; 2], 7)]);
        assert_eq!(tree.nearest([0.0; 2], |_| f64::INFINITY), Some(&7));
    }
}
