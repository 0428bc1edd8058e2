//! The same mesh, bit for bit, for any number of threads.

use voronaut::manifold::domain::Domain;
use voronaut::metric::{MetricField, Shock, Swirl};
use voronaut::progress::Silent;
use voronaut::recipe::{self, MeshOptions, Meshed};

fn mesh_with(threads: usize, domain: &Domain, metric: &dyn MetricField, vertices: usize) -> Meshed {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let options = MeshOptions { vertices: Some(vertices), ..MeshOptions::default() };
    pool.install(|| recipe::mesh(domain, metric, &options, &Silent)).expect("a mesh")
}

#[test]
fn threads_do_not_change_a_bit_of_the_mesh() {
    let domain = Domain::shape("rect:-2,-2,2,2").expect("a rectangle");
    let smooth = Shock { phi: 1.0, lambda: 0.6 };
    let even = Shock { phi: 0.1, lambda: 0.6 };
    // The last one starts from a coarser mesh.
    for (metric, vertices) in [(&smooth as &dyn MetricField, 600), (&Swirl::default(), 600), (&even, 9_000)] {
        let one = mesh_with(1, &domain, metric, vertices);
        assert_eq!(one.mesh.points.len(), vertices);
        for threads in [2, 3] {
            let several = mesh_with(threads, &domain, metric, vertices);
            assert_eq!(one.mesh, several.mesh);
            assert_eq!(one.metric_scale.to_bits(), several.metric_scale.to_bits());
            assert_eq!((&one.dual, &one.canvas, &one.diagram), (&several.dual, &several.canvas, &several.diagram));
        }
    }
}
