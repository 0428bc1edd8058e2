//! Meshes that stay within a distance of their surface, by a metric that knows its curvature.

use voronaut::geometry::Tensor3;
use voronaut::progress::Silent;
use voronaut::quality::{surface_fidelity, validity};
use voronaut::recipe::{MeshOptions, mesh_surface};
use voronaut::surface::metric::{Chordal, Constant};
use voronaut::surface::{Implicit, read};

/// The unit mesh of a field that asks for next to nothing but a distance is closer, and not much closer.
fn stays_within(spec: &str, distance: f64) {
    let input = read(spec, None).unwrap();
    let nothing = Constant(Tensor3::isotropic(1e3 * input.diagonal()));
    let field = Chordal::new(nothing, &input, distance).unwrap();
    let found = mesh_surface(&input, &field, &MeshOptions::default(), &Silent).unwrap();
    assert!(validity(&found.mesh).valid);
    let implicit = input.implicit.as_ref().map(|f| f as &dyn Implicit);
    let both = surface_fidelity(&found.mesh, &input.surface, implicit).unwrap().both;
    let (greatest, rms) = (both.hausdorff / distance, both.rms / distance);
    println!("{spec}, {distance:.2e}: {} vertices, greatest {greatest:.3}, rms {rms:.3}", found.mesh.points.len());
    assert!(greatest <= 1.0 && greatest > 0.5, "{spec}: {greatest}");
}

#[test]
fn unit_meshes_of_equations_are_just_within_the_distance() {
    stays_within("sphere:1", 5e-3);
    stays_within("torus:2,0.7", 2e-2);
}

#[test]
#[ignore = "takes minutes"]
fn so_is_one_of_three_thousand_vertices() {
    stays_within("chair", 1e-2);
}
