//! Files of other programs: what they hold is what these programs say they wrote.

use std::path::PathBuf;
use voronaut::domain::{Domain, from_mesh};
use voronaut::mesh::{Mesh, SolutionValues};
use voronaut::surface::Surface;
use voronaut_io::sol;

/// A file of `tests/data/medit`, whose README says what wrote it.
fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/medit").join(name)
}

fn mesh(name: &str) -> Mesh {
    voronaut_io::read(&file(name)).unwrap().mesh
}

fn labels(of: &[i32]) -> Vec<i32> {
    let mut labels = of.to_vec();
    labels.sort_unstable();
    labels.dedup();
    labels
}

#[test]
fn mmg2d_as_text_and_binary() {
    let [text, binary] = ["mmg2d.mesh", "mmg2d.meshb"].map(mesh);
    assert_eq!((text.points.len(), text.edges.len(), text.triangles.len()), (12, 11, 12));
    assert_eq!((text.corners.len(), text.required_points.len(), text.required_edges.len()), (4, 6, 1));
    assert_eq!((labels(&text.edge_labels), labels(&text.triangle_labels)), (vec![1, 2, 3, 4, 9], vec![5, 6]));
    // mmg2d rounds the numbers of its text.
    for (a, b) in text.points.iter().zip(&binary.points) {
        assert!(a.iter().zip(b).all(|(x, y)| (x - y).abs() < 1e-12));
    }
    assert_eq!(Mesh { points: text.points.clone(), ..binary }, text);
    let domain = Domain::new(&from_mesh(&text).unwrap()).unwrap();
    assert!((domain.area() - 2.0).abs() < 1e-12);
    let sizes = sol::read(voronaut_io::open(&file("mmg2d.sol")).unwrap(), "mmg2d.sol").unwrap();
    assert!(matches!(sizes.values, SolutionValues::Scalar(sizes) if sizes.len() == 12));
}

#[test]
fn mmgs_as_text_and_binary() {
    let [text, binary] = ["mmgs.mesh", "mmgs.meshb"].map(mesh);
    assert_eq!((text.points.len(), text.edges.len(), text.triangles.len()), (26, 24, 48));
    assert_eq!((text.corners.len(), text.required_points.len(), text.ridges.len()), (8, 8, 24));
    assert_eq!(labels(&text.triangle_labels), [1, 2, 3, 4, 5, 6]);
    assert_eq!((&text.triangles, &text.edges, &text.ridges), (&binary.triangles, &binary.edges, &binary.ridges));
    assert_eq!(Surface::new(&binary).unwrap().euler_characteristic(), 2);
}

#[test]
fn bamg_in_its_own_format_and_in_that_of_freefem() {
    let [own, freefem] = ["bamg.mesh", "bamg.msh"].map(mesh);
    assert_eq!((own.points.len(), own.edges.len(), own.triangles.len()), (40, 20, 58));
    assert_eq!(labels(&own.edge_labels), [1, 2, 3, 4]);
    assert_eq!(
        (&own.triangles, &own.edges, &own.edge_labels),
        (&freefem.triangles, &freefem.edges, &freefem.edge_labels)
    );
    let area = |mesh: &Mesh| Domain::new(&from_mesh(mesh).unwrap()).unwrap().area();
    assert!((area(&own) - 1.0).abs() < 1e-12 && (area(&freefem) - 1.0).abs() < 1e-12);
}
