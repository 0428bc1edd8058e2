//! The front of a propagation: an indexed 4-ary heap of the vertices whose labels are still to be settled.
//!
//! In the words of RR-9103, section 6.3: a vertex in the heap is TRIAL; outside it is KNOWN if it has a label, else FAR.

use super::Label;
use crate::triangulation::VertexId;

const ABSENT: u32 = u32::MAX;
const ARITY: usize = 4;

/// Vertices by the key they were last given, smallest first; keys are compared by distance, then colour, then vertex,
/// so that the order is the same on every machine.
#[derive(Clone, Debug, Default)]
pub(super) struct Front {
    heap: Vec<Entry>,
    place: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Entry {
    distance: f64,
    colour: u32,
    vertex: u32,
}

impl Entry {
    fn is_before(self, other: Self) -> bool {
        if self.distance.to_bits() == other.distance.to_bits() {
            return (self.colour, self.vertex) < (other.colour, other.vertex);
        }
        self.distance < other.distance
    }
}

impl Front {
    pub(super) fn new(vertices: usize) -> Self {
        Self { heap: Vec::new(), place: vec![ABSENT; vertices] }
    }

    /// Puts the vertex in the heap, or moves it there.
    pub(super) fn set(&mut self, v: VertexId, key: &Label) {
        let entry = Entry { distance: key.distance, colour: key.colour, vertex: v.0 };
        let at = self.place[v.index()];
        if at == ABSENT {
            self.heap.push(entry);
            self.rise(self.heap.len() - 1, entry);
        } else if entry.is_before(self.heap[at as usize]) {
            self.rise(at as usize, entry);
        } else {
            self.sink(at as usize, entry);
        }
    }

    /// Puts the vertex in by the lesser of its labels if it differs from the one that is due, else takes it out.
    pub(super) fn put(&mut self, v: VertexId, label: &Label, due: &Label) {
        if label == due {
            self.remove(v);
        } else {
            self.set(v, if due.is_before(label) { due } else { label });
        }
    }

    /// Takes the vertex out, if it is there.
    fn remove(&mut self, v: VertexId) {
        let at = self.place[v.index()];
        if at == ABSENT {
            return;
        }
        self.place[v.index()] = ABSENT;
        let Some(last) = self.heap.pop() else { return };
        if last.vertex == v.0 {
            return;
        }
        let at = at as usize;
        if at > 0 && last.is_before(self.heap[(at - 1) / ARITY]) {
            self.rise(at, last);
        } else {
            self.sink(at, last);
        }
    }

    /// Takes out the vertex with the smallest key.
    pub(super) fn pop(&mut self) -> Option<VertexId> {
        let first = self.heap.first()?;
        let v = VertexId(first.vertex);
        self.remove(v);
        Some(v)
    }

    fn rise(&mut self, mut at: usize, entry: Entry) {
        while at > 0 {
            let parent = (at - 1) / ARITY;
            if !entry.is_before(self.heap[parent]) {
                break;
            }
            self.write(at, self.heap[parent]);
            at = parent;
        }
        self.write(at, entry);
    }

    fn sink(&mut self, mut at: usize, entry: Entry) {
        loop {
            let children = ARITY * at + 1..(ARITY * at + 1 + ARITY).min(self.heap.len());
            let before = |a: usize, b: usize| if self.heap[b].is_before(self.heap[a]) { b } else { a };
            let Some(least) = children.reduce(before) else { break };
            if !self.heap[least].is_before(entry) {
                break;
            }
            self.write(at, self.heap[least]);
            at = least;
        }
        self.write(at, entry);
    }

    fn write(&mut self, at: usize, entry: Entry) {
        self.heap[at] = entry;
        self.place[entry.vertex as usize] = at as u32;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pops_in_order_whatever_was_changed() {
        let n = 500;
        let mut front = Front::new(n);
        let key = |k: usize| Label { distance: (k % 97) as f64, colour: (k % 5) as u32, support: 0 };
        let mut keys: Vec<Option<usize>> = vec![None; n];
        for step in 0..4000_usize {
            let (v, k) = ((step * 7919) % n, (step * step * 31 + 7) % 1009);
            let id = VertexId(v as u32);
            if step % 6 == 5 {
                front.remove(id);
                keys[v] = None;
            } else {
                front.set(id, &key(k));
                keys[v] = Some(k);
            }
        }
        let mut expected: Vec<(usize, usize, usize)> =
            keys.iter().enumerate().filter_map(|(v, k)| k.map(|k| (k % 97, k % 5, v))).collect();
        expected.sort_unstable();
        let popped: Vec<usize> = std::iter::from_fn(|| front.pop()).map(VertexId::index).collect();
        assert_eq!(popped, expected.iter().map(|e| e.2).collect::<Vec<_>>());
    }
}
