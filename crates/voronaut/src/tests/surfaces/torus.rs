//! The dual of seeds on a torus is one.

use super::random::Random;
use crate::canvas::{Canvas, Kind, size_for};
use crate::diagram::SurfaceDiagram;
use crate::dual::Road;
use crate::geodesic::Method;
use crate::geometry::{Point3, Tensor3};
use crate::manifold::surface::metric::Constant;
use crate::manifold::{Manifold, Place};
use crate::progress::Silent;
use crate::recipe::dual;
use std::collections::HashMap;
use std::f64::consts::TAU;

#[test]
fn duals_on_a_torus_are_closed_with_characteristic_zero() {
    let (manifold, metric) = (Manifold::shape("torus:2,0.7", None).unwrap(), Constant(Tensor3::IDENTITY));
    let mut random = Random(88_172_645_463_325_252);
    let mut seed = || {
        let (around, across) = (TAU * random.next(), TAU * random.next());
        let r = 2.0 + 0.7 * across.cos();
        manifold.closest(Point3::new(r * around.cos(), r * around.sin(), 0.7 * across.sin())).unwrap()
    };
    let places: Vec<Place> = (0..1000).map(|_| seed()).collect();
    let (canvas, at) =
        Canvas::on_surface(Kind::Intrinsic, &manifold, &metric, size_for(places.len(), 60), &places).unwrap();
    let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::March).unwrap();
    let triangles = dual(&diagram, Road::Geodesic, &Silent).triangles;
    let mut sides: HashMap<[u32; 2], u32> = HashMap::new();
    for [a, b, c] in &triangles {
        for side in [[*a, *b], [*b, *c], [*c, *a]] {
            *sides.entry(side).or_default() += 1;
        }
    }
    // Each edge once in either direction.
    assert!(sides.iter().all(|(&[a, b], &count)| count == 1 && sides.contains_key(&[b, a])));
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    println!("{} vertices, {} edges, {} triangles", used.len(), sides.len() / 2, triangles.len());
    assert_eq!(used.len(), places.len());
    assert_eq!(used.len() + triangles.len(), sides.len() / 2);
    // The side that faces out is the surface's.
    let is_out = |&[a, b, c]: &[u32; 3]| {
        let [p, q, r] = [a, b, c].map(|v| places[v as usize]);
        (q.position - p.position).cross(r.position - p.position).dot(p.normal + q.normal + r.normal) > 0.0
    };
    let out = triangles.iter().filter(|t| is_out(t)).count();
    assert!(out == triangles.len(), "{out} of {} face out", triangles.len());
}
