//! Curved meshes on the command line: converted, examined, drawn, and refused by name where they would be flattened.

use crate::common::{Place, stderr};
use voronaut::mesh::Mesh;

/// The unit disk in seven triangles around its centre.
const DISKS: [(usize, &[u8]); 2] = [
    (2, include_bytes!("../../voronaut-io/tests/data/gmsh/order-2-4.1.msh")),
    (3, include_bytes!("../../voronaut-io/tests/data/gmsh/order-3-2.2.msh")),
];

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

fn place(disk: &[u8]) -> Place {
    let place = Place::new();
    place.put("disk.msh", disk);
    place
}

fn done(place: &Place, words: &str) -> String {
    let output = place.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(0), "{words}: {}", stderr(&output));
    stderr(&output)
}

fn mesh(place: &Place, name: &str) -> Mesh {
    voronaut_io::read(&place.path().join(name)).unwrap().mesh
}

#[test]
fn formats_with_curves_give_them_back() {
    for (order, disk) in DISKS {
        let place = place(disk);
        let truth = mesh(&place, "disk.msh");
        let told = done(&place, "convert disk.msh a.meshb");
        let nodes = truth.curved.as_ref().unwrap().nodes.len();
        assert!(told.contains(&format!("of order {order}, with {nodes} nodes beside the vertices")), "{told}");
        done(&place, "convert a.meshb a.vtu");
        done(&place, "convert a.vtu a.mesh");
        done(&place, "convert a.mesh a.msh --binary --msh-version 2.2");
        for name in ["a.meshb", "a.vtu", "a.mesh", "a.msh"] {
            assert_eq!(mesh(&place, name), truth, "{name}");
        }
    }
}

#[test]
fn what_has_no_place_for_curves_refuses_them_by_name() {
    let place = place(DISKS[0].1);
    for (words, expected) in [
        ("convert disk.msh a.obj", "triangles of order 2 in a file .obj"),
        ("convert disk.msh a.vtp", "triangles of order 2 in a file .vtp"),
        ("convert disk.msh a.poly", "triangles of order 2, where straight ones are needed"),
        ("mesh disk.msh --metric uniform -n 50 -o a.mesh", "triangles of order 2, where straight ones are needed"),
        ("remesh disk.msh -hsiz 0.3 -o a.mesh", "triangles of order 2, where straight ones are needed"),
        ("metric disk.msh --metric uniform -o a.sol", "a metric on curved triangles"),
        ("interpolate disk.msh disk.msh u.sol -o a.sol", "triangles of order 2, where straight ones are needed"),
        ("check disk.msh --metric uniform --picture a.svg --show unmet", "--show unmet with curved triangles"),
        ("check disk.msh --metric uniform --histograms a.svg", "--histograms with curved triangles"),
        ("view disk.msh --metric uniform -o a.html", "curved triangles in a metric"),
        ("mesh disk:0,0,1 --metric uniform -n 50 --order 2 -o a.stl", "triangles of order 2 in a file .stl"),
        ("mesh disk:0,0,1 --metric uniform -n 50 --order 2 --parts 2 -o a.mesh", "--parts with curved triangles"),
        ("mesh sphere:1 --metric uniform -n 50 --order 2 --fit -o a.mesh", "--fit with curved triangles"),
        ("mesh cube.obj --metric uniform -n 50 --order 2 -o a.mesh", "curved triangles on a surface of triangles"),
        ("mesh disk:0,0,1 --metric uniform -n 50 --boundary spline -o a.mesh", "--boundary with straight triangles"),
    ] {
        place.put("cube.obj", CUBE);
        place.put("u.sol", "MeshVersionFormatted 2\nDimension 2\nSolAtVertices 8\n1 1\n1 2 3 4 5 6 7 8\nEnd\n");
        let output = place.run(&words.split_whitespace().collect::<Vec<_>>());
        // mmg's codes for mmg's words.
        let code = if words.starts_with("remesh") { 2 } else { 1 };
        assert_eq!(output.status.code(), Some(code), "{words}: {}", stderr(&output));
        assert!(stderr(&output).contains(expected), "{words}: {}", stderr(&output));
        assert!(stderr(&output).contains("help"), "{words}: {}", stderr(&output));
        for name in ["cube.obj", "u.sol"] {
            place.take(name);
        }
        assert_eq!(place.files(), ["disk.msh"], "{words}");
    }
    let output = place.run(&["mesh", "disk:0,0,1", "--metric", "uniform", "--order", "4", "-o", "a.msh"]);
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn curves_are_left_out_on_request() {
    let place = place(DISKS[1].1);
    let truth = mesh(&place, "disk.msh");
    done(&place, "convert disk.msh a.off --order 1");
    let flat = mesh(&place, "a.off");
    assert_eq!((&flat.triangles, flat.curved, flat.points), (&truth.triangles, None, truth.points));
    done(&place, "mesh a.off --metric uniform -n 20 -o b.off");
}

#[test]
fn check_and_view_know_curves() {
    for (order, disk) in DISKS {
        let place = place(disk);
        done(&place, "check disk.msh --metric uniform --report a.json --picture a.svg");
        let report: serde_json::Value = serde_json::from_slice(&place.read("a.json")).unwrap();
        assert_eq!(report["curved"]["order"], order);
        assert_eq!(report["curved"]["nodes"], if order == 2 { 14 } else { 35 });
        let drawn = String::from_utf8(place.read("a.svg")).unwrap();
        let paths: String = drawn.split(" d=\"").skip(1).filter_map(|rest| rest.split('"').next()).collect();
        // Sides of seven triangles, seven edges between them and seven of the boundary.
        assert_eq!(paths.matches(if order == 2 { 'q' } else { 'c' }).count(), 3 * 7 + 7 + 7);
        done(&place, "view disk.msh -o a.html");
    }
}

#[test]
fn meshes_of_order_2_and_3_are_made() {
    for (order, per_triangle) in [(2, 3), (3, 7)] {
        let place = Place::new();
        let words = format!(
            "mesh disk:0,0,1 --metric swirl:field=printed -n 60 --order {order} -o a.msh --report a.json --picture a.svg"
        );
        done(&place, &words);
        let report: serde_json::Value = serde_json::from_slice(&place.read("a.json")).unwrap();
        let made = mesh(&place, "a.msh");
        let curved = made.curved.as_ref().expect("curves");
        assert_eq!((curved.order, curved.triangles.len()), (order, per_triangle * made.triangles.len()));
        assert_eq!((&report["valid"], &report["options"]["order"]), (&true.into(), &order.into()));
        assert!(report["least_jacobian"].as_f64().unwrap() > 0.0);
        assert!(report.get("closed_form").is_none(), "it is measured of straight edges");
        done(&place, "check a.msh --metric swirl:field=printed --report b.json");
        let checked: serde_json::Value = serde_json::from_slice(&place.read("b.json")).unwrap();
        assert_eq!((&checked["area"], &checked["curved"]), (&report["area"], &report["curved"]));
    }
}

#[test]
fn surfaces_of_equations_have_curved_triangles() {
    let place = Place::new();
    done(&place, "mesh torus:1,0.4 --metric uniform -n 120 --order 2 -o a.vtu --report a.json");
    let report: serde_json::Value = serde_json::from_slice(&place.read("a.json")).unwrap();
    assert_eq!((&report["valid"], &report["curved"]["order"]), (&true.into(), &2.into()));
    assert!(report["notes"].to_string().contains("of straight triangles between the vertices"), "{report}");
    let curved = mesh(&place, "a.vtu").curved.expect("curves");
    for [x, y, z] in curved.nodes {
        assert!(((x.hypot(y) - 1.0).hypot(z) - 0.4).abs() < 1e-12);
    }
    done(&place, "check a.vtu --domain torus:1,0.4 --report b.json");
    let checked: serde_json::Value = serde_json::from_slice(&place.read("b.json")).unwrap();
    assert_eq!(checked["least_jacobian"], report["least_jacobian"]);
    let [straight, curved] =
        ["mesh_to_surface", "curved"].map(|side| checked["fidelity"][side]["hausdorff"].as_f64().unwrap());
    assert!(0.0 < curved && curved < 0.1 * straight, "{straight} {curved}");
}

#[test]
fn boundaries_are_bent_onto_splines_on_request() {
    let place = Place::new();
    let circle = (0..=24).map(|i| f64::from(i % 24) * std::f64::consts::TAU / 24.0);
    let points: Vec<String> = circle.map(|a| format!("[{}, {}]", a.cos(), a.sin())).collect();
    let ring = format!(r#"{{"type": "Polygon", "coordinates": [[{}]]}}"#, points.join(", "));
    place.put("ring.geojson", ring);
    let area = |words: &str| -> f64 {
        done(&place, &format!("mesh ring.geojson --metric uniform -n 80 --order 2 -o a.msh --report a.json {words}"));
        let report: serde_json::Value = serde_json::from_slice(&place.read("a.json")).unwrap();
        report["area"].as_f64().unwrap()
    };
    let polygon = 12.0 * (std::f64::consts::TAU / 24.0).sin();
    assert!((area("") - polygon).abs() < 1e-12 && (area("--boundary polyline") - polygon).abs() < 1e-12);
    assert!((area("--boundary spline") - std::f64::consts::PI).abs() < 1e-4);
    assert!((area("--boundary spline --required") - polygon).abs() < 1e-12, "required segments are straight");
}
