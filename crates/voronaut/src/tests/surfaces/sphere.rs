//! On a sphere with its own metric the Riemannian Delaunay triangulation is the convex hull.

use super::random::Random;
use crate::canvas::{Canvas, Kind};
use crate::diagram::SurfaceDiagram;
use crate::dual::Road;
use crate::geodesic::Method;
use crate::geometry::{Point3, Tensor3};
use crate::manifold::surface::metric::Constant;
use crate::manifold::{Manifold, Place};
use crate::progress::Silent;
use crate::recipe;
use crate::triangulation::smallest_first;
use std::collections::HashSet;

/// Random points of the unit sphere.
fn seeds(count: usize) -> Vec<Point3> {
    let mut random = Random(88_172_645_463_325_252);
    let mut point = || {
        let (z, angle) = (2.0 * random.next() - 1.0, std::f64::consts::TAU * random.next());
        let r = (1.0 - z * z).sqrt();
        Point3::new(r * angle.cos(), r * angle.sin(), z)
    };
    (0..count).map(|_| point()).collect()
}

/// How far the seed that is farthest out of a triangle's plane is: negative for a face of the hull. As a margin: the power of
/// the seed, times twice the triangle's area, over the product of the four edges to its neighbours.
fn farthest_out(seeds: &[Point3], [a, b, c]: [u32; 3]) -> f64 {
    let [p, q, r] = [a, b, c].map(|i| seeds[i as usize]);
    let normal = (q - p).cross(r - p);
    let scale = p.distance(q).max(q.distance(r)).max(r.distance(p)).powi(4);
    let others = (0..).zip(seeds).filter(|(i, _)| ![a, b, c].contains(i));
    others.map(|(_, &s)| 2.0 * normal.dot(s - p) / scale).fold(f64::NEG_INFINITY, f64::max)
}

fn dual_of(seeds: &[Point3], per_seed: usize) -> Vec<[u32; 3]> {
    let manifold = Manifold::shape("sphere:1", None).unwrap();
    let metric = Constant(Tensor3::IDENTITY);
    let places: Vec<Place> = seeds.iter().map(|&p| manifold.closest(p).unwrap()).collect();
    let (canvas, at) =
        Canvas::on_surface(Kind::Intrinsic, &manifold, &metric, per_seed * seeds.len(), &places).unwrap();
    let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::March).unwrap();
    assert_eq!(diagram.orphans().len(), 0);
    recipe::dual(&diagram, Road::Both, &Silent).triangles
}

#[test]
fn the_dual_of_random_seeds_is_the_convex_hull() {
    for (count, per_seed) in [(3000, 20), (300, 60), (40, 60)] {
        let seeds = seeds(count);
        let triangles = dual_of(&seeds, per_seed);
        let distinct: HashSet<[u32; 3]> = triangles.iter().map(|&t| smallest_first(t)).collect();
        assert_eq!((triangles.len(), distinct.len()), (2 * count - 4, 2 * count - 4));
        let out: Vec<f64> = triangles.iter().map(|&t| farthest_out(&seeds, t)).filter(|&out| out > 0.0).collect();
        let clearly = out.iter().filter(|&&out| out > 1e-5).count();
        println!("{count} seeds, {per_seed} canvas vertices each: {} wrong, {clearly} above 1e-5", out.len());
        assert!(clearly == 0 && 1000 * out.len() <= triangles.len(), "{out:?}");
    }
}
