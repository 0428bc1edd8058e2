use super::work::leaning;
use super::*;
use crate::geometry::Tensor3;
use crate::manifold::Manifold;
use crate::manifold::surface::Surface;
use crate::manifold::surface::metric::Constant;
use crate::mesh::Mesh;

fn metric(edge: f64) -> Constant {
    Constant(Tensor3::IDENTITY * edge.powi(-2))
}

fn of(manifold: &Manifold, edge: f64, count: usize, held: &[Held]) -> Adapted {
    adapted(manifold, &metric(edge), &Wanted { given: &[], factor: 1.0, count, held: Holding::Near(held) }).unwrap()
}

/// Corners of all triangles, each triangle turned such that its least corner is first.
fn corners(places: &[Place], topology: &Triangulation) -> Vec<[[u64; 3]; 3]> {
    let bits = |v: VertexId| places[v.index()].position.to_array().map(f64::to_bits);
    let turned = |[a, b, c]: [[u64; 3]; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap();
    let mut found: Vec<_> = topology.faces().map(|f| turned(topology.corners(f).map(bits))).collect();
    found.sort_unstable();
    found
}

#[test]
fn the_number_is_met_and_triangles_stand_upright() {
    for (spec, edge, count) in [("sphere:1", 0.4, 100), ("torus:2,0.7", 0.3, 400), ("sphere:1", 0.05, 6000)] {
        let manifold = Manifold::shape(spec, Some(0.15)).unwrap();
        let found = of(&manifold, edge, count, &[]);
        assert_eq!(found.places.len(), count, "{spec}");
        assert_eq!(found.topology.euler_characteristic(), manifold.surface().euler_characteristic());
        found.topology.check().unwrap();
        let metric = metric(edge);
        let work = Work::of(&manifold, &metric, 1.0, found.topology, found.places);
        let least = work.topology.faces().map(|f| leaning(work.topology.corners(f).map(|v| work.at(v))));
        assert!(least.fold(1.0, f64::min) >= UPRIGHT, "{spec}");
    }
}

#[test]
fn where_all_is_held_it_is_the_surface() {
    let manifold = Manifold::shape("torus:2,0.7", Some(0.4)).unwrap();
    let found = of(&manifold, 5.0, 10, &[Held { corners: [Point3::default(); 3], within: 10.0 }]);
    let all = manifold.topology();
    let places: Vec<Place> = all.vertices().map(|v| manifold.place_of(v).unwrap()).collect();
    assert_eq!(corners(&found.places, &found.topology), corners(&places, all));
    assert_eq!(found.staying, places.len());
}

#[test]
fn points_of_no_triangle_do_not_count() {
    let mesh = Manifold::shape("sphere:1", Some(0.3)).unwrap().whole_mesh();
    let points = mesh.points.iter().copied().chain((0..200).map(|i| [f64::from(i), 9.0, 9.0])).collect();
    let manifold = Manifold::new(Surface::new(&Mesh { points, ..mesh }).unwrap(), None);
    assert_eq!(of(&manifold, 0.5, 60, &[]).places.len(), 60);
}

#[test]
fn exchange_keeps_the_number_and_what_stays() {
    let manifold = Manifold::shape("sphere:1", Some(0.3)).unwrap();
    let start = of(&manifold, 0.5, 60, &[]);
    // Edges are far too long in this metric.
    let found = exchanged(&manifold, &metric(0.1), 1.0, &start.places, &start.topology, 5);
    assert_eq!((found.places.len(), found.staying), (60, 5));
    let positions = |places: &[Place]| places[..5].iter().map(|place| place.position).collect::<Vec<_>>();
    assert_eq!(positions(&found.places), positions(&start.places));
    assert_ne!(corners(&found.places, &found.topology), corners(&start.places, &start.topology));
}
