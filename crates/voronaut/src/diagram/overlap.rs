//! Every cell a little beyond its borders: distances that know of one seed only.
//!
//! Where two fronts meet, values are poor on both sides, for neither crosses a face whose vertices have different colours.
//! So each seed's distances are computed once more, by themselves, on its cell and a few rings around it.

use super::{Diagram, Ground, Measure, Seed};
use crate::geodesic::NO_COLOUR;
use crate::lists::{Rows, in_order};
use crate::parallel::prelude::*;
use crate::triangulation::VertexId;
use std::borrow::Cow;
use std::collections::HashMap;

/// Rings of canvas vertices around a cell.
const RINGS: usize = 3;
/// Seeds near a vertex of which the ways from one to another are looked at: pairs are half the square of that.
const CROWD: usize = 64;
/// Cells that share the memory of one solver.
const CELLS: usize = 128;

/// The distances of canvas vertices to the seeds whose cells are near.
pub(super) struct Overlap(Rows<(u32, f64)>);

impl Overlap {
    /// The seeds near a vertex by colour, with their distances.
    pub(super) fn at(&self, v: VertexId) -> &[(u32, f64)] {
        self.0.row(v.index())
    }

    /// The nearest of them, of equally near ones the first.
    pub(super) fn nearest(&self, v: VertexId) -> Option<u32> {
        let least = self.at(v).iter().min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        least.map(|entry| entry.0)
    }

    /// The distance of a vertex to a seed, where it is known.
    pub(super) fn distance(&self, v: VertexId, colour: u32) -> Option<f64> {
        let list = self.at(v);
        list.binary_search_by_key(&colour, |e| e.0).ok().map(|i| list[i].1)
    }
}

type Patch = Vec<(VertexId, f64)>;
/// The distances of a patch's vertices to its seed.
type Measured<'m, P> = dyn FnMut(&Seed<P>, &[VertexId]) -> Vec<f64> + 'm;

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// The distances of every cell and its surroundings; computed, in parallel, when they are first asked for after a
    /// change.
    pub(super) fn overlap(&self) -> &Overlap {
        self.overlap.get_or_init(|| self.computed_overlap())
    }

    fn computed_overlap(&self) -> Overlap {
        let cells = self.cells();
        let colours: Vec<u32> = (0..self.colours() as u32).collect();
        let patches = |chunk: &[u32]| -> Vec<Patch> {
            let mut distances = self.patch_distances();
            let mut seen = vec![false; self.vertex_count()];
            chunk
                .iter()
                .map(|&colour| self.patch(colour, &cells[colour as usize], distances.as_mut(), &mut seen))
                .collect()
        };
        let patches: Vec<Patch> = colours.par_chunks(CELLS).flat_map_iter(patches).collect();
        gather(self.vertex_count(), &patches)
    }

    /// The distances of vertices to one seed after the other.
    fn patch_distances(&self) -> Box<Measured<'_, G::Place>> {
        match &self.measure {
            Measure::Chords(chords) => Box::new(|seed, vertices| {
                let ground = self.ground;
                let seed = ground.frozen(seed.at);
                let to = |&v: &VertexId| chords.length(&seed, &ground.frozen(ground.place(v)));
                vertices.iter().map(to).collect()
            }),
            Measure::Ways(solver) => {
                let mut solver = solver.patches();
                Box::new(move |seed, vertices| {
                    let starts: Vec<(VertexId, f64)> = seed.starts.iter().map(|s| (s.vertex, s.distance)).collect();
                    solver.distances(vertices, &starts)
                })
            }
        }
    }

    fn cells(&self) -> Vec<Vec<VertexId>> {
        let mut cells = vec![Vec::new(); self.colours()];
        for v in self.vertices() {
            let colour = self.label(v).colour;
            if colour != NO_COLOUR {
                cells[colour as usize].push(v);
            }
        }
        cells
    }

    fn patch(&self, colour: u32, cell: &[VertexId], measured: &mut Measured<'_, G::Place>, seen: &mut [bool]) -> Patch {
        let Some(seed) = &self.seeds[colour as usize] else { return Patch::new() };
        let topology = self.ground.topology();
        let mut vertices: Vec<VertexId> = Vec::with_capacity(2 * cell.len());
        let candidates = seed.starts.iter().map(|s| s.vertex).chain(cell.iter().copied());
        vertices.extend(candidates.filter(|v| !std::mem::replace(&mut seen[v.index()], true)));
        let mut ring = 0..vertices.len();
        for _ in 0..RINGS {
            for i in ring.clone() {
                for h in topology.star(vertices[i]) {
                    let around = [topology.target(h), topology.apex(h)];
                    vertices.extend(around.into_iter().filter(|v| !std::mem::replace(&mut seen[v.index()], true)));
                }
            }
            ring = ring.end..vertices.len();
        }
        for v in &vertices {
            seen[v.index()] = false;
        }
        let distances = measured(seed, &vertices);
        vertices.into_iter().zip(distances).filter(|(_, distance)| distance.is_finite()).collect()
    }
}

/// From lists by colour to lists by vertex.
fn gather(vertices: usize, patches: &[Patch]) -> Overlap {
    let entries = (0..)
        .zip(patches)
        .flat_map(|(colour, patch)| patch.iter().map(move |&(v, distance)| (v.0, (colour, distance))));
    Overlap(Rows::new(vertices, entries))
}

/// For pairs of seeds whose cells, with their surroundings, have canvas vertices in common: the vertex with the least sum of
/// distances to both.
pub(crate) struct Passes(HashMap<[u32; 2], (f64, VertexId)>);

impl<'a, G: Ground<'a>> Diagram<'a, G> {
    /// Where the shortest ways between seeds pass from cell to cell: all whose cells touch, or nearly do.
    pub(crate) fn passes(&self) -> Passes {
        let overlap = self.overlap();
        let mut best: HashMap<[u32; 2], (f64, VertexId)> = HashMap::new();
        for v in self.vertices() {
            let list = nearest_few(overlap.at(v));
            for (k, &(a, to_a)) in list.iter().enumerate() {
                for &(b, to_b) in &list[k + 1..] {
                    let found = best.entry([a, b]).or_insert((f64::INFINITY, v));
                    if to_a + to_b < found.0 {
                        *found = (to_a + to_b, v);
                    }
                }
            }
        }
        Passes(best)
    }
}

/// Those of the nearest seeds, by colour: more than cells that meet in a place are there only where many seeds are in one canvas face.
fn nearest_few(list: &[(u32, f64)]) -> Cow<'_, [(u32, f64)]> {
    if list.len() <= CROWD {
        return list.into();
    }
    let mut few = list.to_vec();
    few.select_nth_unstable_by(CROWD, |a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    few.truncate(CROWD);
    few.sort_by_key(|entry| entry.0);
    few.into()
}

impl Passes {
    /// The length of the way between two seeds through their pass, and the pass: never less than their distance on the canvas, and
    /// more by a share of about the square of a canvas edge's over the distance's length. `None` where their cells are not near.
    pub(crate) fn between(&self, i: u32, j: u32) -> Option<(f64, VertexId)> {
        self.0.get(&in_order([i, j])).copied()
    }
}
