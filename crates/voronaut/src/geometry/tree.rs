//! A static binary tree of boxes: which of many segments or triangles is nearest to a point.
//!
//! Flat, built once, read by any number of threads without allocating; half the time of a general R-tree's nearest
//! neighbour on the boundaries it is used for, and ties come with the same search.

use super::{Aabb, Point};

/// Boxes of numbered items; the items of a leaf have consecutive *positions* in [`BoxTree::new`]'s order.
#[derive(Clone, Debug)]
pub(crate) struct BoxTree {
    /// In depth-first order: the first child of an inner node follows it.
    nodes: Vec<Node>,
}

/// A box, and either items (`count > 0`) from position `next`, or a second child at `next`.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    next: u32,
    count: u32,
}

/// Items per leaf.
const LEAF: usize = 4;

/// Median splits halve the items, so that 2^32 of them are at most this deep.
const MAX_DEPTH: usize = 32;

impl BoxTree {
    /// The tree, and the item at each position. Callers store their items in that order.
    pub(crate) fn new(boxes: &[Aabb]) -> (Self, Vec<u32>) {
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        let mut nodes = Vec::with_capacity(boxes.len());
        if !boxes.is_empty() {
            build(boxes, &mut order, 0, &mut nodes);
        }
        (Self { nodes }, order)
    }

    /// Calls `visit` with the positions of all items whose box meets `bounds`, and of some others near them.
    pub(crate) fn overlapping(&self, bounds: &Aabb, mut visit: impl FnMut(usize)) {
        let mut pending = [0; MAX_DEPTH + 1];
        let mut count = usize::from(!self.nodes.is_empty());
        while count > 0 {
            count -= 1;
            let index = pending[count];
            let node = &self.nodes[index];
            if !node.bounds.meets(bounds) {
                continue;
            }
            if node.count > 0 {
                (node.next..node.next + node.count).for_each(|item| visit(item as usize));
            } else {
                pending[count] = node.next as usize;
                pending[count + 1] = index + 1;
                count += 2;
            }
        }
    }

    /// Calls `visit` with the positions of all items whose box is nearer to `p` than the bound, nearer boxes first.
    /// `visit` returns the new bound, a squared distance; it starts at infinity.
    pub(crate) fn search(&self, p: Point, mut visit: impl FnMut(usize) -> f64) {
        let mut pending = [(0, 0.0); MAX_DEPTH];
        let mut count = usize::from(!self.nodes.is_empty());
        let mut bound = f64::INFINITY;
        while count > 0 {
            count -= 1;
            let (mut index, distance) = pending[count];
            if distance >= bound {
                continue;
            }
            loop {
                let node = &self.nodes[index];
                if node.count > 0 {
                    for item in node.next..node.next + node.count {
                        bound = visit(item as usize);
                    }
                    break;
                }
                let first = (index + 1, squared_distance(&self.nodes[index + 1].bounds, p));
                let second = (node.next as usize, squared_distance(&self.nodes[node.next as usize].bounds, p));
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
}

fn build(boxes: &[Aabb], order: &mut [u32], position: usize, nodes: &mut Vec<Node>) {
    let bounds = Aabb::of(order.iter().flat_map(|&i| [boxes[i as usize].min, boxes[i as usize].max]))
        .expect("a node holds at least one item");
    let index = nodes.len();
    if order.len() <= LEAF {
        nodes.push(Node { bounds, next: position as u32, count: order.len() as u32 });
        return;
    }
    nodes.push(Node { bounds, next: 0, count: 0 });
    let extent = bounds.extent();
    let key = |i: &u32| {
        let centre = boxes[*i as usize].centre();
        if extent.x > extent.y { centre.x } else { centre.y }
    };
    let middle = order.len() / 2;
    order.select_nth_unstable_by(middle, |i, j| key(i).total_cmp(&key(j)).then(i.cmp(j)));
    let (lower, upper) = order.split_at_mut(middle);
    build(boxes, lower, position, nodes);
    nodes[index].next = nodes.len() as u32;
    build(boxes, upper, position + middle, nodes);
}

fn squared_distance(bounds: &Aabb, p: Point) -> f64 {
    let x = (bounds.min.x - p.x).max(p.x - bounds.max.x).max(0.0);
    let y = (bounds.min.y - p.y).max(p.y - bounds.max.y).max(0.0);
    x * x + y * y
}

#[cfg(test)]
#[expect(clippy::float_cmp, reason = "exact results are the point")]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn finds_the_nearest_of_many_points(
            points in prop::collection::vec((-1.0..1.0, -1.0..1.0), 1..200),
            query in (-2.0..2.0, -2.0..2.0),
        ) {
            let points: Vec<Point> = points.into_iter().map(|(x, y)| Point::new(x, y)).collect();
            let boxes: Vec<Aabb> = points.iter().map(|&p| Aabb { min: p, max: p }).collect();
            let (tree, order) = BoxTree::new(&boxes);
            let p = Point::new(query.0, query.1);
            let mut best = f64::INFINITY;
            tree.search(p, |position| {
                best = best.min((points[order[position] as usize] - p).dot(points[order[position] as usize] - p));
                best
            });
            let truth = points.iter().map(|&q| (q - p).dot(q - p)).fold(f64::INFINITY, f64::min);
            prop_assert_eq!(best, truth);
        }
    }

    proptest! {
        #[test]
        fn finds_all_boxes_that_overlap_one(
            corners in prop::collection::vec((-1.0..1.0, -1.0..1.0, 0.0..0.3, 0.0..0.3), 1..200),
        ) {
            let boxed = |(x, y, w, h)| Aabb { min: Point::new(x, y), max: Point::new(x + w, y + h) };
            let boxes: Vec<Aabb> = corners.into_iter().map(boxed).collect();
            let (tree, order) = BoxTree::new(&boxes);
            let mut seen = vec![0; boxes.len()];
            tree.overlapping(&boxes[0], |position| seen[order[position] as usize] += 1);
            prop_assert!(boxes.iter().zip(&seen).all(|(b, &count)| count == 1 || count == 0 && !b.meets(&boxes[0])));
        }
    }

    #[test]
    fn an_empty_tree_has_no_items() {
        let (tree, order) = BoxTree::new(&[]);
        tree.search(Point::default(), |_| panic!("no item to visit"));
        assert!(order.is_empty());
    }

    #[test]
    fn many_equal_boxes_are_split_all_the_same() {
        let same = Aabb { min: Point::new(1.0, 1.0), max: Point::new(2.0, 2.0) };
        let (tree, order) = BoxTree::new(&[same; 100]);
        let mut seen = vec![false; order.len()];
        tree.search(Point::default(), |position| {
            seen[position] = true;
            f64::INFINITY
        });
        assert!(seen.iter().all(|&s| s));
    }
}
