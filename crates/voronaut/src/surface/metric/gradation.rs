//! Sizes that grow slowly.

use crate::geometry::Point3;
use crate::surface::Surface;
use crate::triangulation::VertexId;
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// Lowers sizes, one per vertex slot, until along every edge of length l they grow by no more than l ln(hgrad):
/// h(y) <= h(x) + ln(hgrad) l, the law of Alauzet 2010 in physical space, for which neighbouring edges grow by about the
/// factor `hgrad`. The result is the largest such field below the given one, found as Dijkstra's distances are, from the
/// smallest size up; so no size is less than the least one given.
///
/// Vertices at equal positions, as they are where a surface was cut, end with equal sizes. `hgrad` is at least 1 (then all
/// that hangs together has one size); sizes are positive, and finite where there are triangles.
pub(crate) fn grade(surface: &Surface, sizes: &mut [f64], hgrad: f64) {
    let growth = hgrad.ln();
    let copies = Copies::of(surface);
    // Positive numbers have the order of their bits.
    let mut queue: BinaryHeap<Reverse<(u64, u32)>> =
        surface.topology().vertices().map(|v| Reverse((sizes[v.index()].to_bits(), v.0))).collect();
    while let Some(Reverse((bits, v))) = queue.pop() {
        let (size, v) = (f64::from_bits(bits), VertexId(v));
        if size > sizes[v.index()] {
            continue;
        }
        let neighbours =
            around(surface, v).map(|w| (w, size + growth * surface.position(v).distance(surface.position(w))));
        for (w, most) in neighbours.chain(copies.at(surface.position(v)).map(|w| (w, size))) {
            if most < sizes[w.index()] {
                sizes[w.index()] = most;
                queue.push(Reverse((most.to_bits(), w.0)));
            }
        }
    }
}

/// The vertices that share an edge with one, some of them twice.
fn around(surface: &Surface, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
    let t = surface.topology();
    t.star(v).flat_map(move |h| [t.target(h), t.apex(h)])
}

/// Vertices at equal positions.
struct Copies(HashMap<[u64; 3], Vec<VertexId>>);

impl Copies {
    fn of(surface: &Surface) -> Self {
        let mut all: HashMap<_, Vec<VertexId>> = HashMap::new();
        // Only what is cut has copies, and a cut is a border.
        for v in surface.topology().vertices().filter(|&v| surface.topology().is_border_vertex(v)) {
            all.entry(key(surface.position(v))).or_default().push(v);
        }
        all.retain(|_, vertices| vertices.len() > 1);
        Self(all)
    }

    fn at(&self, p: Point3) -> impl Iterator<Item = VertexId> + '_ {
        self.0.get(&key(p)).into_iter().flatten().copied()
    }
}

/// Adding 0 makes one zero of both.
fn key(p: Point3) -> [u64; 3] {
    p.to_array().map(|x| (x + 0.0).to_bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::surface::torus;
    use crate::test_cases::cases;
    use proptest::prelude::*;

    /// The torus, its triangles apart but for their positions.
    fn soup(surface: &Surface) -> Surface {
        let mesh = surface.to_mesh();
        let points = mesh.triangles.iter().flatten().map(|&v| mesh.points[v as usize]).collect();
        let triangles = (0..mesh.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        Surface::new(&Mesh { points, triangles, ..Mesh::default() }).unwrap()
    }

    proptest! {
        #![proptest_config(cases(24))]
        #[test]
        fn sizes_obey_the_law_and_no_more(seed in 0..1_000_000_u32, hgrad in 1.0..3.0_f64, spread in 0.1..6.0_f64) {
            let surface = torus(2.0, 0.7, 0.4).unwrap();
            let noise = |i: usize| ((i as f64 + f64::from(seed)) * 12.9898).sin() * spread;
            let given: Vec<f64> = (0..surface.positions().len()).map(|i| noise(i).exp()).collect();
            let mut sizes = given.clone();
            grade(&surface, &mut sizes, hgrad);
            for v in surface.topology().vertices() {
                let (size, given) = (sizes[v.index()], given[v.index()]);
                // The most that any neighbour allows.
                let reach = |w: VertexId| sizes[w.index()] + hgrad.ln() * surface.position(v).distance(surface.position(w));
                let most = around(&surface, v).map(reach).fold(f64::INFINITY, f64::min);
                prop_assert!(size <= most * (1.0 + 1e-12), "{} over {}", size, most);
                prop_assert!((size - given.min(most)).abs() <= 1e-12 * size, "{}, not {} or {}", size, given, most);
            }
        }
    }

    #[test]
    fn a_cut_surface_is_graded_as_the_whole() {
        let surface = torus(2.0, 0.7, 0.4).unwrap();
        let given: Vec<f64> = surface.positions().iter().map(|p| if p.x > 2.6 { 0.01 } else { 5.0 }).collect();
        let mut whole = given.clone();
        grade(&surface, &mut whole, 1.3);
        let soup = soup(&surface);
        let mut apart: Vec<f64> = soup.positions().iter().map(|p| if p.x > 2.6 { 0.01 } else { 5.0 }).collect();
        grade(&soup, &mut apart, 1.3);
        let mesh = surface.to_mesh();
        for (i, &v) in mesh.triangles.iter().flatten().enumerate() {
            assert_eq!(apart[i].to_bits(), whole[v as usize].to_bits());
        }
        assert!(whole.iter().any(|&h| h > 0.5) && whole.iter().all(|&h| h < 5.0));
    }
}
