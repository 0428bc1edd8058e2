//! The triangles of a mesh in an order in which each is told by one small number, mostly: what lies across the oldest open edge.
//!
//! The border of what is told is kept as rings of open edges. Across the oldest of them lies nothing, or a triangle whose third
//! vertex is new, or the next one along the ring, or the one before, or any other, which is then named. Meshes need not be manifold:
//! what cannot be reached starts anew. The page does the same backwards (`viewer/src/decode.ts`).

use super::bytes::Planes;
use voronaut::mesh::{Edges, Mesh};

/// No half-edge, gate or number.
const NONE: u32 = u32::MAX;

/// What lies across an open edge. A triangle that starts anew is [`START`] and a bit for each of its corners that is new.
const NOTHING: u8 = 0;
const NEW: u8 = 1;
const AFTER: u8 = 2;
const BEFORE: u8 = 3;
const CLOSES: u8 = 4;
const OTHER: u8 = 5;
const START: u8 = 6;

/// How a new vertex is foretold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Guess {
    /// Where the vertex before it is.
    Last,
    /// Opposite to the third of these over the edge between the others: a parallelogram.
    Across([u32; 3]),
}

/// A mesh in its new order.
#[derive(Debug, Default)]
pub(super) struct Order {
    /// What lies across each open edge, in turn.
    pub(super) steps: Vec<u8>,
    /// Vertices that steps name: how many have come since.
    pub(super) named: Planes,
    /// The old numbers of the vertices.
    pub(super) vertices: Vec<u32>,
    /// How each vertex is foretold, by old numbers.
    pub(super) guesses: Vec<Guess>,
    /// The old numbers of the triangles.
    pub(super) triangles: Vec<u32>,
    /// By new numbers of vertices.
    pub(super) corners: Vec<[u32; 3]>,
    /// New numbers of vertices by old ones.
    pub(super) numbers: Vec<u32>,
}

/// An open edge, as the triangle beyond would pass it.
#[derive(Clone, Copy)]
struct Gate {
    ends: [u32; 2],
    /// The third vertex of the triangle on this side.
    behind: u32,
    /// The half-edge of the triangle beyond; none on a border.
    half_edge: u32,
    is_open: bool,
    /// Its neighbours in its ring.
    before: u32,
    after: u32,
}

struct Walk<'a> {
    mesh: &'a Mesh,
    twins: Vec<u32>,
    is_told: Vec<bool>,
    gates: Vec<Gate>,
    /// The last gate that starts in a vertex, by old numbers.
    starting: Vec<u32>,
    order: Order,
}

impl Order {
    /// The order of a mesh: vertices without triangles come last.
    pub(super) fn of(mesh: &Mesh) -> Self {
        let mut walk = Walk {
            mesh,
            twins: twins(&mesh.triangles),
            is_told: vec![false; mesh.triangles.len()],
            gates: Vec::new(),
            starting: vec![NONE; mesh.points.len()],
            order: Order { numbers: vec![NONE; mesh.points.len()], ..Order::default() },
        };
        let mut gate = 0;
        for t in 0..mesh.triangles.len() as u32 {
            if !walk.is_told[t as usize] {
                walk.start(t);
            }
            while gate < walk.gates.len() {
                if walk.gates[gate].is_open {
                    walk.pass(gate as u32);
                }
                gate += 1;
            }
        }
        for v in 0..mesh.points.len() as u32 {
            if walk.order.numbers[v as usize] == NONE {
                walk.add(v, Guess::Last);
            }
        }
        walk.order
    }
}

/// For each half-edge the one that runs against it, of edges of two triangles.
fn twins(triangles: &[[u32; 3]]) -> Vec<u32> {
    let mut twins = vec![NONE; 3 * triangles.len()];
    for sides in Edges::of(triangles).iter() {
        if let [s, t] = *sides
            && s.forward != t.forward
        {
            twins[s.half_edge as usize] = t.half_edge;
            twins[t.half_edge as usize] = s.half_edge;
        }
    }
    twins
}

impl Walk<'_> {
    fn is_new(&self, v: u32) -> bool {
        self.order.numbers[v as usize] == NONE
    }

    fn add(&mut self, v: u32, guess: Guess) {
        self.order.numbers[v as usize] = self.order.vertices.len() as u32;
        self.order.vertices.push(v);
        self.order.guesses.push(guess);
    }

    fn name(&mut self, v: u32) {
        self.order.named.push(self.order.vertices.len() as u32 - self.order.numbers[v as usize]);
    }

    fn tell(&mut self, t: u32, corners: [u32; 3]) {
        self.is_told[t as usize] = true;
        self.order.triangles.push(t);
        self.order.corners.push(corners.map(|v| self.order.numbers[v as usize]));
    }

    /// A gate beyond a half-edge that was told; it is in no ring yet.
    fn open(&mut self, ends: [u32; 2], behind: u32, half_edge: u32) -> u32 {
        let gate = self.gates.len() as u32;
        let half_edge = self.twins[half_edge as usize];
        self.gates.push(Gate { ends, behind, half_edge, is_open: true, before: gate, after: gate });
        self.starting[ends[0] as usize] = gate;
        gate
    }

    fn link(&mut self, before: u32, after: u32) {
        self.gates[before as usize].after = after;
        self.gates[after as usize].before = before;
    }

    /// A triangle without neighbours that were told.
    fn start(&mut self, t: u32) {
        let corners = self.mesh.triangles[t as usize];
        let place = self.order.steps.len();
        self.order.steps.push(START);
        for (i, v) in corners.into_iter().enumerate() {
            if self.is_new(v) {
                self.order.steps[place] += 1 << i;
                self.add(v, Guess::Last);
            } else {
                self.name(v);
            }
        }
        self.tell(t, corners);
        let [a, b, c] = corners;
        let first = self.open([b, a], c, 3 * t);
        let second = self.open([a, c], b, 3 * t + 2);
        let third = self.open([c, b], a, 3 * t + 1);
        self.link(first, second);
        self.link(second, third);
        self.link(third, first);
    }

    /// Tells what lies beyond an open gate.
    fn pass(&mut self, gate: u32) {
        let Gate { ends: [a, b], behind, half_edge, before, after, .. } = self.gates[gate as usize];
        self.gates[gate as usize].is_open = false;
        if half_edge == NONE || self.is_told[half_edge as usize / 3] {
            self.order.steps.push(NOTHING);
            return;
        }
        let t = half_edge / 3;
        let [second, third] = [1, 2].map(|k| 3 * t + (half_edge + k) % 3);
        let v = self.mesh.triangles[t as usize][third as usize % 3];
        let leads_to = |gate: u32, half_edge: u32| {
            let gate = self.gates[gate as usize];
            gate.is_open && gate.half_edge == half_edge
        };
        let step = match (leads_to(before, third), leads_to(after, second)) {
            _ if self.is_new(v) => NEW,
            (true, true) => CLOSES,
            (true, false) => BEFORE,
            (false, true) => AFTER,
            (false, false) => OTHER,
        };
        self.order.steps.push(step);
        match step {
            NEW => self.add(v, Guess::Across([a, b, behind])),
            OTHER => self.name(v),
            _ => {}
        }
        self.tell(t, [a, b, v]);
        self.advance(step, [before, after], [a, b, v], [second, third]);
    }

    /// Moves the border over the triangle beyond a gate with these neighbours in its ring.
    fn advance(&mut self, step: u8, around: [u32; 2], [a, b, v]: [u32; 3], [second, third]: [u32; 2]) {
        // Where the ring goes on beside the edges that the triangle closes.
        let [mut from, mut to] = around;
        let [is_left, is_right] = [matches!(step, BEFORE | CLOSES), matches!(step, AFTER | CLOSES)];
        if is_left {
            self.gates[from as usize].is_open = false;
            from = self.gates[from as usize].before;
        }
        if is_right {
            self.gates[to as usize].is_open = false;
            to = self.gates[to as usize].after;
        }
        let meeting = self.starting[v as usize];
        let left = (!is_left).then(|| self.open([a, v], b, third));
        let right = (!is_right).then(|| self.open([v, b], a, second));
        let [first, last] = [left.or(right), right.or(left)];
        let (Some(first), Some(last)) = (first, last) else { return self.link(from, to) };
        self.link(from, first);
        self.link(last, to);
        if step == OTHER && meeting != NONE && self.gates[meeting as usize].is_open {
            // The ring touches itself, or another, in that vertex: it is cut there.
            let earlier = self.gates[meeting as usize].before;
            self.link(first, meeting);
            self.link(earlier, last);
        } else if first != last {
            self.link(first, last);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_meshes::{grid, mesh};

    #[test]
    fn every_triangle_and_vertex_is_told_once_with_its_turn() {
        let fin = mesh(
            &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 2.0], [9.0, 9.0]],
            &[[0, 1, 2], [1, 3, 2], [1, 4, 2]],
        );
        for mesh in [grid(7, 5), fin] {
            let order = Order::of(&mesh);
            let sorted = |list: &[u32]| {
                let mut list = list.to_vec();
                list.sort_unstable();
                list
            };
            assert_eq!(sorted(&order.vertices), (0..mesh.points.len() as u32).collect::<Vec<_>>());
            assert_eq!(sorted(&order.triangles), (0..mesh.triangles.len() as u32).collect::<Vec<_>>());
            for (&t, corners) in order.triangles.iter().zip(&order.corners) {
                let told = corners.map(|v| order.vertices[v as usize]);
                let [a, b, c] = mesh.triangles[t as usize];
                assert!([[a, b, c], [b, c, a], [c, a, b]].contains(&told));
            }
        }
    }

    #[test]
    fn a_grid_takes_one_number_for_a_triangle_and_names_next_to_nothing() {
        let order = Order::of(&grid(60, 60));
        let others = order.steps.iter().filter(|&&step| step >= OTHER).count();
        assert!(others < 10 && order.steps.len() < 2 * order.triangles.len(), "{others} {}", order.steps.len());
    }
}
