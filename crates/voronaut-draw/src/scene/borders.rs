//! Borders between the cells of a coloured canvas: where they cut its edges, and as lines.

use super::super::shades::distinct;
use voronaut::geometry::Point3;

/// Not there.
const NONE: usize = usize::MAX;
/// Cuts stay this far from the ends of their edges, as a share of these.
const LEAST: f64 = 0.03;
/// How often borders are pulled straight: enough for steps of several edges.
const ROUNDS: usize = 40;

/// Borders as a graph. Its nodes are the cuts, one on each edge between two colours, and after them the junctions, one in
/// the middle of each triangle with three.
pub(super) struct Borders<'a> {
    positions: &'a [Point3],
    /// The edges that are cut, smaller vertex first, sorted.
    edges: Vec<[u32; 2]>,
    /// Where, from the first vertex (0) to the second (1).
    shares: Vec<f64>,
    /// The nodes on both sides of each cut.
    links: Vec<[usize; 2]>,
    /// The cuts around each junction.
    junctions: Vec<[usize; 3]>,
}

impl<'a> Borders<'a> {
    /// Cuts the edges of triangles, whose vertices exist, where their colours change.
    pub(super) fn new(positions: &'a [Point3], triangles: &[[u32; 3]], colours: &[Option<u32>]) -> Self {
        let differ = |[a, b]: &[u32; 2]| colours[*a as usize] != colours[*b as usize];
        let edges = distinct(triangles.iter().flat_map(|&t| sides(t)).filter(differ));
        let count = edges.len();
        let (shares, links) = (vec![0.5; count], vec![[NONE; 2]; count]);
        let mut borders = Self { positions, edges, shares, links, junctions: Vec::new() };
        for &triangle in triangles {
            borders.connect(triangle);
        }
        for _ in 0..ROUNDS {
            borders.straighten();
        }
        borders
    }

    /// The edges that are cut.
    pub(super) fn edges(&self) -> &[[u32; 2]] {
        &self.edges
    }

    /// Where the edge from a to b is cut, as a share of the way; `None` where it is not.
    pub(super) fn share(&self, [a, b]: [u32; 2]) -> Option<f64> {
        let share = self.shares[self.edges.binary_search(&[a.min(b), a.max(b)]).ok()?];
        Some(if a < b { share } else { 1.0 - share })
    }

    /// The borders from junction to junction, and closed ones.
    pub(super) fn lines(&self) -> Vec<Vec<Point3>> {
        let mut seen = vec![false; self.edges.len()];
        let mut lines = Vec::new();
        let of_junctions = self.junctions.iter().enumerate();
        let from_junctions = of_junctions.flat_map(|(k, cuts)| cuts.map(|cut| [self.edges.len() + k, cut]));
        let ends = (0..self.links.len()).filter(|&cut| self.links[cut].contains(&NONE)).map(|cut| [NONE, cut]);
        let closed = (0..self.links.len()).map(|cut| [self.links[cut][0], cut]);
        for [before, start] in from_junctions.chain(ends).chain(closed) {
            if !seen[start] {
                let nodes = self.walk(before, start, &mut seen);
                lines.push(nodes.into_iter().filter_map(|node| self.position(node)).collect());
            }
        }
        lines
    }

    /// From a node over one beside it to the next junction, or to the end, or around.
    fn walk(&self, mut before: usize, start: usize, seen: &mut [bool]) -> Vec<usize> {
        let (mut nodes, mut node) = (vec![before], start);
        loop {
            nodes.push(node);
            match seen.get_mut(node) {
                Some(seen) if !*seen => *seen = true,
                _ => return nodes,
            }
            let [a, b] = self.links[node];
            (before, node) = (node, if a == before { b } else { a });
        }
    }

    fn connect(&mut self, triangle: [u32; 3]) {
        let found = sides(triangle).map(|side| self.edges.binary_search(&side).unwrap_or(NONE));
        let cuts: Vec<usize> = found.into_iter().filter(|&cut| cut != NONE).collect();
        match cuts[..] {
            [a, b] => {
                self.link(a, b);
                self.link(b, a);
            }
            [a, b, c] => {
                let junction = self.edges.len() + self.junctions.len();
                for cut in [a, b, c] {
                    self.link(cut, junction);
                }
                self.junctions.push([a, b, c]);
            }
            _ => {}
        }
    }

    /// A third neighbour, where more than two triangles share an edge, is left out.
    fn link(&mut self, cut: usize, node: usize) {
        if let Some(free) = self.links[cut].iter_mut().find(|link| **link == NONE) {
            *free = node;
        }
    }

    /// Moves each cut along its edge towards the middle of its neighbours.
    fn straighten(&mut self) {
        let moved = |cut: usize| {
            let [p, q] = self.links[cut].map(|node| self.position(node));
            let [a, b] = self.edges[cut].map(|v| self.positions[v as usize]);
            let (along, wanted) = (b - a, p?.lerp(q?, 0.5));
            let share = (wanted - a).dot(along) / along.dot(along);
            share.is_finite().then(|| 0.5 * (self.shares[cut] + share.clamp(LEAST, 1.0 - LEAST)))
        };
        self.shares = (0..self.edges.len()).map(|cut| moved(cut).unwrap_or(self.shares[cut])).collect();
    }

    /// Where a node is; `None` of none.
    fn position(&self, node: usize) -> Option<Point3> {
        if let Some([a, b]) = self.edges.get(node) {
            let [a, b] = [a, b].map(|v| self.positions[*v as usize]);
            return Some(a.lerp(b, self.shares[node]));
        }
        let cuts = self.junctions.get(node.checked_sub(self.edges.len())?)?;
        let [p, q, r] = cuts.map(|cut| self.position(cut).unwrap_or_default());
        Some(p.lerp(q, 0.5).lerp(r, 1.0 / 3.0))
    }
}

/// The edges of a triangle, smaller vertex first.
fn sides([a, b, c]: [u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of so many vertices a side, by the rule for their colours.
    fn grid(side: u32, colour: impl Fn(f64, f64) -> u32) -> (Vec<Point3>, Vec<[u32; 3]>, Vec<Option<u32>>) {
        let points: Vec<Point3> =
            (0..side * side).map(|i| Point3::new(f64::from(i % side), f64::from(i / side), 0.0)).collect();
        let corner = |i: u32| (i % (side - 1)) + side * (i / (side - 1));
        let halves = |a: u32| [[a, a + 1, a + side + 1], [a, a + side + 1, a + side]];
        let triangles = (0..(side - 1) * (side - 1)).flat_map(|i| halves(corner(i))).collect();
        let colours = points.iter().map(|p| Some(colour(p.x, p.y))).collect();
        (points, triangles, colours)
    }

    #[test]
    fn borders_become_straight() {
        let (points, triangles, colours) = grid(30, |x, y| u32::from(0.37 * x + y > 20.2));
        let borders = Borders::new(&points, &triangles, &colours);
        let lines = borders.lines();
        assert_eq!(lines.len(), 1);
        // The ends are fixed; between them the steps of half an edge are gone.
        let inner = &lines[0][4..lines[0].len() - 4];
        let off = inner.iter().map(|p| (0.37 * p.x + p.y - 20.2).abs()).fold(0.0, f64::max);
        assert!(inner.len() > 20 && off < 0.35, "{off}");
        let turn = |w: &[Point3]| (w[1] - w[0]).unit().unwrap().dot((w[2] - w[1]).unit().unwrap());
        // Middles of edges would turn by 45 degrees at each step.
        assert!(inner.windows(3).all(|w| turn(w) > 30.0_f64.to_radians().cos()));
    }

    #[test]
    fn every_cut_is_on_one_line() {
        let (points, triangles, colours) =
            grid(
                25,
                |x, y| if (x - 12.0).hypot(y - 6.0) < 3.5 { 9 } else { u32::from(x > 11.3) + 2 * u32::from(y > 13.4) },
            );
        let borders = Borders::new(&points, &triangles, &colours);
        let lines = borders.lines();
        // Four ends at the border of the grid, two junctions or more where the colours meet, and the disk.
        assert!(!borders.junctions.is_empty());
        let inner: usize = lines.iter().map(|line| line.windows(2).count()).sum();
        let two: usize = triangles
            .iter()
            .filter(|&&t| sides(t).iter().filter(|&&s| borders.share(s).is_some()).count() == 2)
            .count();
        assert_eq!(inner, two + 3 * borders.junctions.len());
    }
}
