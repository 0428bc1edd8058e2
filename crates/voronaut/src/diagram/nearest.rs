//! The nearest of many sites where each, or the place that asks, has its own tensor.
//!
//! A tree of boxes over the sites. A chord v has v' M v >= v.x^2 det M / M.yy and likewise by y, whatever its other
//! coordinate: what a box is away by either coordinate bounds the length of every chord to it from below.

use crate::geometry::{Aabb, Point, Tensor};

/// A point with its tensor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Site {
    pub(super) at: Point,
    pub(super) colour: u32,
    pub(super) tensor: Tensor,
}

/// See the [module](self).
pub(super) struct Nearest {
    sites: Vec<Site>,
    /// The whole first; of a node that is split its two halves stand together.
    nodes: Vec<Node>,
}

struct Node {
    bounds: Aabb,
    /// The least of [`floors`] of the sites.
    floors: [f64; 2],
    holds: Holds,
}

enum Holds {
    Sites(std::ops::Range<usize>),
    /// The node of the first half; that of the other is next to it.
    Halves(usize),
}

/// Boxes with so many sites are not split.
const LEAF: usize = 6;
/// Bounds stay clear of rounding by this share.
const ROUNDING: f64 = 1e-12;

impl Nearest {
    pub(super) fn new(mut sites: Vec<Site>) -> Self {
        let mut nodes = Vec::new();
        if !sites.is_empty() {
            nodes.push(Node::over(&sites, 0));
            split(&mut nodes, 0, &mut sites, 0);
        }
        Self { sites, nodes }
    }

    /// The least length of a chord to a site and that site's colour, of equal lengths the smallest colour; in the given
    /// metric or, if none is, in each site's own. `None` without sites.
    pub(super) fn find(&self, place: Point, frozen: Option<Tensor>) -> Option<(f64, u32)> {
        let mut search = Search { place, frozen: frozen.map(|tensor| (tensor, floors(tensor))), best: None };
        if !self.nodes.is_empty() {
            self.search(0, &mut search);
        }
        search.best
    }

    fn search(&self, node: usize, search: &mut Search) {
        match &self.nodes[node].holds {
            Holds::Sites(range) => self.sites[range.clone()].iter().for_each(|site| search.visit(site)),
            &Holds::Halves(first) => {
                let halves = [first, first + 1].map(|half| (search.bound(&self.nodes[half]), half));
                let order = if halves[1].0 < halves[0].0 { [1, 0] } else { [0, 1] };
                for (bound, half) in order.map(|i| halves[i]) {
                    if search.may_hold(bound) {
                        self.search(half, search);
                    }
                }
            }
        }
    }
}

impl Node {
    /// A leaf over sites that begin at this number.
    fn over(sites: &[Site], begin: usize) -> Self {
        let at = sites[0].at;
        let bounds = Aabb::of(sites.iter().map(|site| site.at)).unwrap_or(Aabb { min: at, max: at });
        let least = |a: [f64; 2], b: [f64; 2]| [a[0].min(b[0]), a[1].min(b[1])];
        let floors = sites.iter().map(|site| floors(site.tensor)).fold([f64::INFINITY; 2], least);
        Self { bounds, floors, holds: Holds::Sites(begin..begin + sites.len()) }
    }
}

/// Splits a leaf at the median of the longer side, and its halves, until they are small.
fn split(nodes: &mut Vec<Node>, node: usize, sites: &mut [Site], begin: usize) {
    if sites.len() <= LEAF {
        return;
    }
    let extent = nodes[node].bounds.extent();
    let key = |site: &Site| if extent.x > extent.y { site.at.x } else { site.at.y };
    let middle = sites.len() / 2;
    sites.select_nth_unstable_by(middle, |a, b| key(a).total_cmp(&key(b)));
    let (low, high) = sites.split_at_mut(middle);
    let first = nodes.len();
    nodes[node].holds = Holds::Halves(first);
    nodes.push(Node::over(low, begin));
    nodes.push(Node::over(high, begin + middle));
    split(nodes, first, low, begin);
    split(nodes, first + 1, high, begin + middle);
}

/// The least of v' M v over all v with v.x = 1, and with v.y = 1.
fn floors(tensor: Tensor) -> [f64; 2] {
    let determinant = tensor.determinant();
    [determinant / tensor.yy, determinant / tensor.xx]
}

struct Search {
    place: Point,
    frozen: Option<(Tensor, [f64; 2])>,
    best: Option<(f64, u32)>,
}

impl Search {
    fn visit(&mut self, site: &Site) {
        let tensor = self.frozen.map_or(site.tensor, |frozen| frozen.0);
        let found = (tensor.length(self.place - site.at), site.colour);
        if self.best.is_none_or(|best| found.0 < best.0 || (found.0 <= best.0 && found.1 < best.1)) {
            self.best = Some(found);
        }
    }

    /// What the square of no chord to a site of the node is below.
    fn bound(&self, node: &Node) -> f64 {
        let Aabb { min, max } = node.bounds;
        let x = (min.x - self.place.x).max(self.place.x - max.x).max(0.0);
        let y = (min.y - self.place.y).max(self.place.y - max.y).max(0.0);
        let floors = self.frozen.map_or(node.floors, |frozen| frozen.1);
        (1.0 - ROUNDING) * (floors[0] * x * x).max(floors[1] * y * y)
    }

    fn may_hold(&self, bound: f64) -> bool {
        self.best.is_none_or(|(least, _)| bound <= least * least)
    }
}
