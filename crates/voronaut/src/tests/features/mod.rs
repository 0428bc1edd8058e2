//! Surfaces with creases, fillets, borders and materials: features stay where they are, to the last bit at corners.

mod common;
mod mutations;
mod required;

use crate::manifold::Manifold;
use crate::manifold::surface::metric::{Spec, field};
use crate::manifold::surface::{FeatureOptions, Surface};
use crate::metric::Bounds;
use crate::progress::Silent;
use crate::recipe::{MeshOptions, mesh_surface};
use crate::tests::parts::Part;
use common::faults;

/// What is meshed: the part with its features. The only place where these tests say how that is done.
fn manifold(part: &Part) -> Manifold {
    Manifold::of(&part.mesh).unwrap().cut(&FeatureOptions::default()).unwrap()
}

/// How far mesh and part may be apart: each is as far from the smooth surface as a triangle of its longest edges, k h^2 / 6, with the
/// greatest curvature k. Edges of the mesh are even ones, by half longer in the uniform metric; by the curvature metric they are
/// up to three times as long, where the surface is flat, and may end where it is not.
fn distance(part: &Part, surface: &Surface, count: usize, metric: &str) -> f64 {
    let longer = if metric == "uniform" { 1.5 } else { 3.0 };
    let even = longer * (surface.area() * 2.0 / 3.0_f64.sqrt() / count as f64).sqrt();
    let t = surface.topology();
    let own =
        t.edges().map(|h| surface.position(t.origin(h)).distance(surface.position(t.target(h)))).fold(0.0, f64::max);
    part.curvature * (even * even + own * own) / 6.0 + 1e-9 * surface.bounds().diagonal()
}

/// Meshes a part with all that a distance asks for.
fn keeps_distance(name: &str, share: f64) {
    let part = crate::tests::parts::all().into_iter().find(|part| part.name == name).unwrap();
    let manifold = manifold(&part);
    let hausd = share * manifold.diagonal();
    let field = field(
        &Spec::parse("uniform").unwrap(),
        &manifold,
        Bounds { h_max: Some(0.2 * manifold.diagonal()), ..Bounds::default() },
    )
    .unwrap();
    let options = MeshOptions { hausd: Some(hausd), ..MeshOptions::default() };
    let mesh = mesh_surface(&manifold, field.as_ref(), None, &options, &Silent).unwrap().mesh;
    let found = faults(&part, &mesh, hausd);
    println!("{name} within {hausd:.2e}: {} vertices, {} faults", mesh.points.len(), found.len());
    assert!(found.is_empty(), "{name}:\n{}", found[..found.len().min(8)].join("\n"));
}

#[test]
fn distances_are_kept_where_they_are_asked_for() {
    for (name, share) in [("cube", 1e-3), ("two", 4e-3), ("patch", 4e-3), ("bracket", 4e-3)] {
        keeps_distance(name, share);
    }
}

/// Meshes a part with every number of vertices and checks all that is known of it.
fn keeps_features(name: &str, metric: &str, counts: &[usize]) {
    let part = crate::tests::parts::all().into_iter().find(|part| part.name == name).unwrap();
    let manifold = manifold(&part);
    let field = field(&Spec::parse(metric).unwrap(), &manifold, Bounds::default()).unwrap();
    for &count in counts {
        let options = MeshOptions { vertices: Some(count), ..MeshOptions::default() };
        let mesh = mesh_surface(&manifold, field.as_ref(), None, &options, &Silent).unwrap().mesh;
        let found = faults(&part, &mesh, distance(&part, manifold.surface(), count, metric));
        println!("{name} {metric} {count}: {} vertices, {} faults", mesh.points.len(), found.len());
        assert!(found.is_empty(), "{name} {metric} {count}:\n{}", found[..found.len().min(8)].join("\n"));
        // Curves take the vertices they need.
        assert!(mesh.points.len() * 5 > count * 4 && mesh.points.len() * 2 < count * 3, "{}", mesh.points.len());
    }
}

/// Tests of a part with both metrics, and with many vertices if asked for.
macro_rules! parts_keep_features {
    ($($name:ident)*) => { $(
        mod $name {
            #[test]
            fn uniform() {
                super::keeps_features(stringify!($name), "uniform", &[500, 2000]);
            }

            #[test]
            fn curvature() {
                super::keeps_features(stringify!($name), "curvature", &[500, 2000]);
            }

            #[test]
            fn many_vertices() {
                super::keeps_features(stringify!($name), "uniform", &[5000]);
                super::keeps_features(stringify!($name), "curvature", &[5000]);
            }
        }
    )* };
}

parts_keep_features! { cube cube_plain bracket bracket_cad patch two blade }
