//! Sizes that grow no faster than they may.

use crate::geometry::{TangentPlane, Tensor, Tensor3};
use crate::surface::Surface;
use crate::triangulation::VertexId;

/// Tensors at vertices, one per slot, intersected with what neighbours allow: at a distance d from a vertex each of its two sizes
/// may be larger by `growth` times d, in the same directions (Alauzet 2010, gradation in physical space). Directions go from one
/// tangent plane to the other by the smallest rotation. Distances are along edges. Tensors only become larger; where nothing
/// changes, they come back bit for bit. Those of vertices without triangles, or that are no metric, are left alone.
pub(super) fn graded(surface: &Surface, tensors: &[Tensor3], growth: f64) -> Vec<Tensor3> {
    let t = surface.topology();
    let mut at: Vec<Option<(TangentPlane, Tensor)>> = vec![None; tensors.len()];
    for v in t.vertices() {
        let plane = surface.vertex_normal(v).map(TangentPlane::new);
        let own = plane.map(|plane| (plane, plane.restrict(tensors[v.index()])));
        at[v.index()] = own.filter(|(_, m)| m.is_positive_definite());
    }
    let mut edges: Vec<[VertexId; 2]> = t.edges().map(|h| [t.origin(h), t.target(h)]).collect();
    let mut found = tensors.to_vec();
    for _ in 0..SWEEPS {
        let mut is_done = true;
        for &[v, w] in &edges {
            let step = growth * surface.position(v).distance(surface.position(w));
            for [from, to] in [[v, w], [w, v]] {
                let (Some(source), Some(target)) = (at[from.index()], at[to.index()]) else { continue };
                let Some(m) = allowed(source, target, step) else { continue };
                is_done = false;
                at[to.index()] = Some((target.0, m));
                found[to.index()] = target.0.extend(m, m.eigen().large);
            }
        }
        if is_done {
            break;
        }
        edges.reverse();
    }
    found
}

/// Sweeps over all edges, there and back, at most.
const SWEEPS: usize = 60;
/// Changes of the determinant by a smaller share are none.
const CHANGE: f64 = 1e-3;

/// The target's tensor within what its neighbour allows so far away; `None` where it is so already.
fn allowed(source: (TangentPlane, Tensor), target: (TangentPlane, Tensor), step: f64) -> Option<Tensor> {
    let both = target.1.intersection(grown(source, &target.0, step)?);
    (both.determinant() > target.1.determinant() * (1.0 + CHANGE)).then_some(both)
}

/// A tensor with its sizes larger by `step`, in another tangent plane; `None` where that faces away.
pub(super) fn grown((from, m): (TangentPlane, Tensor), to: &TangentPlane, step: f64) -> Option<Tensor> {
    let larger = m.map_eigenvalues(|value| (1.0 / value.sqrt() + step).powi(-2));
    (from.normal.dot(to.normal) > 0.0).then(|| to.restrict(from.turned(to.normal).extend(larger, 0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::{sphere, torus};

    /// Edges along which a size grows faster than allowed, as a share of all.
    fn too_fast(surface: &Surface, tensors: &[Tensor3], growth: f64) -> usize {
        let t = surface.topology();
        let size = |v: VertexId| 1.0 / tensors[v.index()].xx.sqrt();
        let steep = |&h: &crate::triangulation::HalfEdge| {
            let (v, w) = (t.origin(h), t.target(h));
            (size(v) - size(w)).abs() > growth * surface.position(v).distance(surface.position(w)) * 1.01
        };
        t.edges().filter(steep).count()
    }

    #[test]
    fn a_small_size_spreads_as_far_as_it_may() {
        let surface = sphere(1.0, 0.1).unwrap();
        let mut tensors = vec![Tensor3::IDENTITY; surface.positions().len()];
        tensors[0] = Tensor3::isotropic(0.01);
        assert!(too_fast(&surface, &tensors, 0.3) > 0);
        let found = graded(&surface, &tensors, 0.3);
        let at = surface.position(VertexId(0));
        for v in surface.topology().vertices() {
            let plane = TangentPlane::new(surface.vertex_normal(v).unwrap());
            let size = 1.0 / plane.restrict(found[v.index()]).eigen().small.sqrt();
            let away = at.distance(surface.position(v));
            // Along edges it is farther than on the sphere, by the share of a zigzag at most.
            let arc = 2.0 * (0.5 * away).min(1.0).asin();
            assert!(size >= (0.01 + 0.3 * away).min(1.0) * 0.999 - 1e-12, "{size} {away}");
            assert!(size <= (0.01 + 0.3 * arc * 1.25).min(1.0) * 1.001 || away < 1e-9, "{size} {away}");
        }
    }

    #[test]
    fn what_grows_slowly_comes_back_to_the_bit_and_twice_is_once() {
        let surface = torus(2.0, 0.7, 0.2).unwrap();
        let even = vec![Tensor3::isotropic(0.5); surface.positions().len()];
        assert_eq!(graded(&surface, &even, 0.5), even);
        let mut spotted = even.clone();
        spotted[17] = Tensor3::isotropic(0.02);
        let once = graded(&surface, &spotted, 0.5);
        let twice = graded(&surface, &once, 0.5);
        for (a, b) in once.iter().zip(&twice) {
            assert!((b.determinant() / a.determinant() - 1.0).abs() < 1e-2, "{a:?} {b:?}");
        }
        assert!(once.iter().zip(&even).filter(|(a, b)| a != b).count() > 10);
    }
}
