//! Curves of the domain: maximal runs of segments between the vertices where something happens.

use super::{Pslg, Segment, Side};
use crate::geometry::{Point, signed_area};
use crate::lists::marked;
use crate::mesh::Network;

/// A run of segments with one label and one pair of sides; its inner vertices belong to no other segment.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Chain {
    /// Vertices in order; a closed curve ends with the vertex it starts with.
    pub vertices: Vec<u32>,
    /// The segments' label, sides and so on; `ends` is that of the first segment.
    pub kind: Segment,
}

impl Pslg {
    /// Cuts the segments into curves. A curve ends where segments fork or end, where label or sides change, at
    /// required points, and at both ends of required segments.
    pub(crate) fn chains(&self) -> Vec<Chain> {
        let network = self.network();
        let is_node = self.nodes(&network);
        let chain = |(start, segments): (u32, Vec<u32>)| {
            let first = self.segments[segments[0] as usize];
            let kind = if first.ends[0] == start { first } else { first.turned() };
            let mut vertices = vec![start];
            for s in segments {
                vertices.push(network.across(vertices[vertices.len() - 1], s));
            }
            Chain { vertices, kind }
        };
        network.chains(|v| is_node[v as usize]).into_iter().map(chain).collect()
    }

    /// The same graph with other vertices along its curves. Points that no curve uses any more are dropped, but for
    /// required ones.
    #[must_use]
    pub(crate) fn with_chains(&self, chains: &[Chain]) -> Pslg {
        let used = chains.iter().flat_map(|c| &c.vertices).chain(&self.required_points);
        let kept = marked(self.points.len(), used.copied());
        let segments =
            chains.iter().flat_map(|c| c.vertices.windows(2).map(|w| Segment { ends: [w[0], w[1]], ..c.kind }));
        Pslg { segments: segments.collect(), ..self.clone() }.with_points(&kept)
    }

    /// Drops the vertices in the middle of straight runs: those that lie on the chord to within the rounding of the
    /// coordinates.
    #[must_use]
    pub(crate) fn without_straight_vertices(&self) -> Pslg {
        let is_node = self.nodes(&self.network());
        let mut chains = self.chains();
        for chain in &mut chains {
            self.straighten(chain, is_node[chain.vertices[0] as usize]);
        }
        self.with_chains(&chains)
    }

    /// Vertices where curves end or fork, and those where one turns by more than the angle (degrees), if it is given.
    pub(crate) fn corners(&self, angle: Option<f64>) -> Vec<u32> {
        let network = self.network();
        let is_corner = |&v: &u32| match *network.at(v) {
            [s, t] => {
                let [before, at, after] = [network.across(v, s), v, network.across(v, t)].map(|v| self.point(v));
                let turn = (at - before).turn(after - at);
                angle.is_some_and(|angle| turn.to_degrees() > angle)
            }
            _ => true,
        };
        network.vertices().filter(is_corner).collect()
    }

    /// Drops a curve's straight vertices. A closed curve that starts at a node keeps it; any other starts anew at a
    /// corner.
    fn straighten(&self, chain: &mut Chain, starts_at_node: bool) {
        let n = chain.vertices.len();
        if chain.vertices[0] == chain.vertices[n - 1] && !starts_at_node {
            let corner = (0..n - 1).find(|&i| {
                let [a, b, c] = [i + n - 2, i, i + 1].map(|j| self.point(chain.vertices[j % (n - 1)]));
                !on_chord(a, b, c)
            });
            chain.vertices.pop();
            chain.vertices.rotate_left(corner.unwrap_or(0));
            chain.vertices.push(chain.vertices[0]);
        }
        let mut kept = vec![chain.vertices[0]];
        // Of those between, the corners of their hull are farthest from any chord.
        let mut run: [Vec<u32>; 2] = Default::default();
        for &v in &chain.vertices[1..] {
            let anchor = self.point(kept[kept.len() - 1]);
            let is_straight = run.iter().flatten().all(|&m| on_chord(anchor, self.point(m), self.point(v)));
            if !is_straight {
                kept.extend(run[0].last());
                run = Default::default();
            }
            self.extend_hull(&mut run, v);
        }
        kept.extend(run[0].last());
        chain.vertices = kept;
    }

    /// Adds a vertex to the two sides of the hull of vertices that come one behind the other (Andrew 1979).
    fn extend_hull(&self, sides: &mut [Vec<u32>; 2], v: u32) {
        for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
            while let [.., a, b] = side[..]
                && sign * signed_area(self.point(a), self.point(b), self.point(v)) >= 0.0
            {
                side.pop();
            }
            side.push(v);
        }
    }

    /// The segments, by their vertices.
    pub(super) fn network(&self) -> Network {
        Network::new(self.points.len(), self.segments.iter().map(|segment| segment.ends))
    }

    fn nodes(&self, network: &Network) -> Vec<bool> {
        let is_node = |v: u32| match *network.at(v) {
            [s, t] => {
                let (s, t) = (self.segments[s as usize], self.segments[t as usize]);
                let [l, r] = sides_arriving(&s, v);
                let [other_r, other_l] = sides_arriving(&t, v);
                s.label != t.label || [l, r] != [other_l, other_r] || s.required || t.required
            }
            _ => true,
        };
        let mut is_node: Vec<bool> = (0..self.points.len() as u32).map(is_node).collect();
        self.required_points.iter().for_each(|&v| is_node[v as usize] = true);
        is_node
    }

    fn point(&self, v: u32) -> Point {
        self.points[v as usize]
    }
}

/// What lies left and right of a segment when walking towards `v`, one of its ends.
fn sides_arriving(segment: &Segment, v: u32) -> [Side; 2] {
    if segment.ends[1] == v { [segment.left, segment.right] } else { [segment.right, segment.left] }
}

/// Whether b lies between a and c, as far from their line as rounding of the coordinates can put it.
fn on_chord(a: Point, b: Point, c: Point) -> bool {
    let size = [a, b, c].iter().fold(0.0_f64, |m, p| m.max(p.x.abs()).max(p.y.abs()));
    let rounding = 2.0 * f64::EPSILON * size;
    signed_area(a, b, c).abs() <= rounding * (c - a).norm() && (b - a).dot(c - b) > 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::domain::Filling;

    fn polygon(points: &[(f64, f64)], labels: &[i32]) -> Pslg {
        let n = points.len() as u32;
        let segment = |i: u32| Segment {
            ends: [i, (i + 1) % n],
            label: labels[i as usize],
            required: false,
            left: Side::Region(1),
            right: Side::Outside,
        };
        Pslg {
            points: points.iter().map(|&(x, y)| Point::new(x, y)).collect(),
            point_labels: vec![0; points.len()],
            required_points: Vec::new(),
            segments: (0..n).map(segment).collect(),
            filling: Filling::Sides,
            tolerance: 0.0,
            names: Vec::new(),
        }
    }

    const SQUARE: [(f64, f64); 8] =
        [(0.5, 0.0), (0.7, 0.0), (1.0, 0.0), (1.0, 0.3), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (0.1, 0.0)];

    #[test]
    fn straight_vertices_go_and_corners_stay() {
        let clean = polygon(&SQUARE, &[1; 8]).without_straight_vertices();
        assert_eq!((clean.points.len(), clean.segments.len()), (4, 4));
        assert_eq!(clean.names.len(), 4);
        assert!(clean.names.contains(&"vertex 3".to_string()), "{:?}", clean.names);
    }

    /// Each new vertex was once held against all of its run.
    #[test]
    fn long_runs_cost_no_more_than_short_ones() {
        let n = 400_000;
        let bottom = (0..n).map(|i| (f64::from(i) / f64::from(n), 0.1 * f64::from(i) / f64::from(n)));
        let points: Vec<(f64, f64)> = bottom.chain([(1.0, 0.1), (1.0, 1.0), (0.0, 1.0)]).collect();
        let clean = polygon(&points, &vec![1; points.len()]).without_straight_vertices();
        assert_eq!(clean.points.len(), 4);
    }

    #[test]
    fn a_change_of_label_is_a_corner() {
        let mut labels = [1; 8];
        labels[0] = 2;
        let clean = polygon(&SQUARE, &labels).without_straight_vertices();
        assert_eq!(clean.points.len(), 6);
    }

    #[test]
    fn required_points_stay() {
        let mut pslg = polygon(&SQUARE, &[1; 8]);
        pslg.required_points.push(7);
        let clean = pslg.without_straight_vertices();
        assert_eq!(clean.points.len(), 5);
        assert_eq!(clean.points[clean.required_points[0] as usize], Point::new(0.1, 0.0));
        assert!(clean.segments.iter().flat_map(|s| s.ends).any(|v| v == clean.required_points[0]));
        assert_eq!(clean.segments.len(), 5);
    }

    #[test]
    fn a_fork_in_the_middle_of_a_closed_curve_s_straight_run_stays() {
        let mut pslg = polygon(&SQUARE, &[1; 8]);
        pslg.points.push(Point::new(0.5, 0.5));
        pslg.point_labels.push(0);
        let branch = Segment { ends: [0, 8], left: Side::Region(1), ..pslg.segments[0] };
        pslg.segments.push(Segment { right: Side::Region(1), ..branch });
        let clean = pslg.without_straight_vertices();
        let fork = |v: &u32| clean.points[*v as usize] == Point::new(0.5, 0.0);
        assert_eq!(clean.segments.iter().flat_map(|s| s.ends).filter(fork).count(), 3);
    }

    #[test]
    fn corners_are_turns_and_forks() {
        let mut pslg = polygon(&SQUARE, &[1; 8]);
        assert_eq!(pslg.corners(Some(45.0)), [2, 4, 5, 6]);
        assert!(pslg.corners(Some(91.0)).is_empty() && pslg.corners(None).is_empty());
        pslg.points.push(Point::new(0.5, 0.5));
        pslg.segments.push(Segment { ends: [0, 8], ..pslg.segments[0] });
        assert_eq!(pslg.corners(None), [0, 8]);
    }

    #[test]
    fn a_fine_circle_is_no_straight_run() {
        let circle: Vec<(f64, f64)> =
            (0..4096).map(|i| f64::from(i) * std::f64::consts::TAU / 4096.0).map(|t| (t.cos(), t.sin())).collect();
        assert_eq!(polygon(&circle, &[1; 4096]).without_straight_vertices().points.len(), 4096);
    }
}
