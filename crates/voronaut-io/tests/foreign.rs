//! Files of other programs: what they hold is what these programs say they wrote.

use std::path::PathBuf;
use voronaut::manifold::domain::{Domain, from_mesh};
use voronaut::manifold::surface::Surface;
use voronaut::mesh::{Mesh, SolutionValues};
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

/// Where the nodes of a triangle are, in barycentric coordinates times its order: corners, then as [`Curved`] has them.
fn places(order: usize) -> Vec<[usize; 3]> {
    let corners = [[order, 0, 0], [0, order, 0], [0, 0, order]];
    let sides = (0..3).flat_map(|side| {
        (1..order).map(move |i| {
            let mut place = [0; 3];
            (place[side], place[(side + 1) % 3]) = (order - i, i);
            place
        })
    });
    corners.into_iter().chain(sides).chain((order == 3).then_some([1; 3])).collect()
}

/// The disk of the unit circle: seven triangles around its centre, whose outer sides are curved.
#[test]
fn curved_triangles_have_their_nodes_in_order() {
    let names = [2, 3].map(|order| {
        let medit = format!("medit/gmsh-order-{order}.mesh");
        let forms = if order == 2 { ["2.2-binary", "4.1"] } else { ["2.2", "4.1-binary"] };
        let [two, four] = forms.map(|form| format!("gmsh/order-{order}-{form}.msh"));
        (order, [two, four, medit, format!("vtk/vtk-order-{order}.vtu")])
    });
    for (order, name) in names.iter().flat_map(|(order, names)| names.iter().map(move |name| (*order, name))) {
        let mesh = voronaut_io::read(&file("..").join(name)).unwrap().mesh;
        let curved = mesh.curved.as_ref().expect(name);
        let inner = (order + 1) * (order + 2) / 2 - 3;
        let counts = (mesh.points.len(), mesh.triangles.len(), mesh.edges.len(), curved.order, curved.nodes.len());
        // Fourteen edges with their nodes, and seven interiors for order 3.
        assert_eq!(counts, (8, 7, 7, order, 14 * (order - 1) + if order == 3 { 7 } else { 0 }), "{name}");
        assert!(mesh.check_numbers().is_ok(), "{name}");
        let mut bent = 0;
        for (i, &triangle) in mesh.triangles.iter().enumerate() {
            let corners = mesh.corners_of(triangle);
            for (&node, place) in curved.triangles[i * inner..][..inner].iter().zip(&places(order)[3..]) {
                let at = |axis: usize| {
                    let x = |k: usize| place[k] as f64 / order as f64 * [corners[k].x, corners[k].y][axis];
                    x(0) + x(1) + x(2)
                };
                let [x, y, z] = curved.nodes[node as usize];
                // A third of the way on the chord of a seventh of the circle is 0.29, and the bow is 0.1.
                let off = (x - at(0)).hypot(y - at(1));
                assert!(off < 0.11 && z == 0.0, "{name}: {off}");
                bent += usize::from(off > 0.05);
            }
        }
        assert!(bent >= 7 * (order - 1), "{name}: {bent}");
        let label = if name.starts_with("medit") { 1 } else { 5 };
        assert!(mesh.edge_labels.iter().all(|&l| l == label || name.starts_with("vtk")), "{name}");
    }
}
