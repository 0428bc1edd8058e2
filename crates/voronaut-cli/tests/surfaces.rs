//! Surfaces: `check` of their meshes (every format, faults, distances to a surface, figures in a metric on it), `mesh`, `dual`.

use crate::common::{Place, stderr};
use serde_json::Value;
use voronaut::manifold::Manifold;
use voronaut::manifold::surface::torus;
use voronaut::mesh::Mesh;
use voronaut_io::write_mesh;

fn put(place: &Place, name: &str, mesh: &Mesh) {
    write_mesh(mesh, &place.path().join(name)).unwrap();
}

fn text(place: &Place, name: &str) -> String {
    String::from_utf8(place.read(name)).unwrap()
}

fn json(place: &Place, name: &str) -> Value {
    serde_json::from_slice(&place.read(name)).unwrap()
}

/// Runs `check`, which succeeds, and returns its report and what it printed.
fn checked(place: &Place, words: &[&str]) -> (Value, String) {
    let output = place.run(&[&["check"], words, &["--report", "r.json"]].concat());
    assert!(output.status.success(), "{words:?}: {}", stderr(&output));
    (serde_json::from_slice(&place.read("r.json")).unwrap(), String::from_utf8(output.stdout).unwrap())
}

fn refused(place: &Place, words: &[&str], expected: &[&str]) {
    let output = place.run(&[&["check"], words].concat());
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{words:?}: {said}");
    for part in expected {
        assert!(said.contains(part), "{words:?}: {part:?} is not in {said}");
    }
}

fn number(report: &Value, path: &str) -> f64 {
    report.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {report}"))
}

fn sphere(radius: f64, edge: f64) -> Mesh {
    Manifold::shape(&format!("sphere:{radius}"), Some(edge)).unwrap().surface().to_mesh()
}

#[test]
fn meshes_of_every_format_are_read() {
    let place = Place::new();
    let mesh = torus(2.0, 0.7, 0.4).unwrap().to_mesh();
    for name in ["a.mesh", "a.obj", "a.off", "a.ply", "a.stl"] {
        put(&place, name, &mesh);
        let (report, said) = checked(&place, &[name]);
        assert_eq!(
            (&report["valid"], &report["euler"], &report["boundary_loops"]),
            (&true.into(), &0.into(), &0.into())
        );
        assert_eq!(report["vertices"], mesh.points.len());
        assert!(report["fidelity"].is_null() && said.contains("valid        yes"), "{said}");
        assert!((number(&report, "/area") - 55.0).abs() < 3.0);
    }
}

#[test]
fn a_mesh_is_held_against_its_surface() {
    let place = Place::new();
    let mesh = sphere(1.0, 0.3);
    put(&place, "a.off", &mesh);
    let (report, said) = checked(&place, &["a.off", "--domain", "sphere:1"]);
    // Inscribed: what is missing is the greatest sagitta, about edge^2 / 6 for an equilateral triangle.
    let hausdorff = number(&report, "/fidelity/hausdorff");
    assert!(hausdorff > 0.003 && hausdorff < 0.015, "{hausdorff}");
    assert!((number(&report, "/fidelity/hausdorff_share") - hausdorff / 12.0_f64.sqrt()).abs() < 1e-3);
    assert!(
        number(&report, "/fidelity/rms") < hausdorff && number(&report, "/fidelity/vertex_to_surface/value") < 1e-14
    );
    assert!(number(&report, "/fidelity/normal_deviation/max/value") < 3.0);
    assert_eq!(report["fidelity"]["folded"], 0);
    assert_eq!(report["fidelity"]["at"].as_array().unwrap().len(), 3);
    for line in ["to surface", "from surface", "vertices     off by", "0 triangles folded over"] {
        assert!(said.contains(line), "{line}: {said}");
    }
    // Against itself, as a file.
    let (report, _) = checked(&place, &["a.off", "--domain", "a.off"]);
    assert!(number(&report, "/fidelity/hausdorff") < 1e-14);
}

#[test]
fn metrics_on_surfaces_are_measured() {
    let place = Place::new();
    let mesh = sphere(2.0, 0.5);
    put(&place, "a.mesh", &mesh);
    let edges = mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let longest = edges.map(|[a, b]| mesh.position(a).distance(mesh.position(b))).fold(0.0, f64::max);
    let max = |words: &[&str]| {
        let (report, said) = checked(&place, &[&["a.mesh"], words].concat());
        assert!(said.contains("unit edges") && number(&report, "/quality/min") > 0.8, "{said}");
        assert_eq!(report["worst"]["longest_edge"]["at"].as_array().unwrap().len(), 3);
        number(&report, "/metric_edge_length/max")
    };
    assert!((max(&["--metric", "uniform"]) - longest).abs() < 1e-12, "the mesh itself is the surface");
    assert!((max(&["--metric", "uniform", "--metric-scale", "9"]) - 3.0 * longest).abs() < 1e-12);
    assert!((max(&["--metric", "uniform", "--h-max", "0.1"]) - 10.0 * longest).abs() < 1e-9);
    // Curvature 1 / 2: lengths times its root; exact on the equation.
    let curved = max(&["--metric", "curvature", "--domain", "sphere:2"]);
    assert!((curved / longest - 0.5_f64.sqrt()).abs() < 0.02, "{curved} {longest}");
    let count = mesh.points.len();
    let solution = format!("MeshVersionFormatted 2 Dimension 3 SolAtVertices {count} 1 1\n{}", "0.5\n".repeat(count));
    place.put("a.sol", solution);
    assert!((max(&["--metric", "a.sol"]) - 2.0 * longest).abs() < 1e-12);
    assert!((max(&["--metric", "a.sol", "--domain", "a.mesh"]) - 2.0 * longest).abs() < 1e-12);
    refused(&place, &["a.mesh", "--metric", "a.sol", "--domain", "sphere:2"], &["values for", "the surface"]);
}

/// A cylinder of radius 1 and height 2 with its lids: its rims are creases by their angle alone.
fn can(sides: u32) -> Mesh {
    let turn = std::f64::consts::TAU / f64::from(sides);
    let rim = |z: f64| (0..sides).map(move |i| [(f64::from(i) * turn).cos(), (f64::from(i) * turn).sin(), z]);
    let points: Vec<[f64; 3]> = rim(0.0).chain(rim(2.0)).chain([[0.0; 3], [0.0, 0.0, 2.0]]).collect();
    let around = |i: u32| {
        let (a, b, low, high) = (i, (i + 1) % sides, 2 * sides, 2 * sides + 1);
        [[a, b, sides + b], [a, sides + b, sides + a], [b, a, low], [sides + a, sides + b, high]]
    };
    Mesh { points, triangles: (0..sides).flat_map(around).collect(), ..Mesh::default() }
}

#[test]
fn a_mesh_of_what_has_creases_is_judged_as_it_was_made() {
    let place = Place::new();
    put(&place, "can.off", &can(24));
    let output =
        place.run(&["mesh", "can.off", "--metric", "curvature", "-n", "300", "-o", "o.mesh", "--report", "made.json"]);
    assert!(output.status.success(), "{}", stderr(&output));
    let made = json(&place, "made.json");
    let scale = made["metric_scale"].to_string();
    let asked = ["o.mesh", "--domain", "can.off", "--metric", "curvature", "--metric-scale", &scale];
    let (found, _) = checked(&place, &asked);
    let (whole, _) = checked(&place, &[&asked[..], &["--nr"]].concat());
    for figure in ["/metric_edge_length/unit_fraction", "/metric_edge_length/mean", "/quality/mean", "/quality/min"] {
        let [made, found, whole] = [&made, &found, &whole].map(|report| number(report, figure));
        assert!((made - found).abs() < 1e-9 * made, "{figure}: {made} {found}");
        assert!((made - whole).abs() > 1e-3 * made, "{figure}: {whole} across the rims");
    }
    let flat = ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "20", "-o", "flat.mesh"];
    assert!(place.run(&flat).status.success());
    refused(&place, &["flat.mesh", "--ar", "30"], &["--ar in the plane", "leave out --ar"]);
}

#[test]
fn faults_of_surfaces_are_found_and_reported() {
    let place = Place::new();
    // One vertex of the torus through to the other side.
    let mut mesh = torus(2.0, 0.7, 0.4).unwrap().to_mesh();
    let last = mesh.points.len() - 1;
    mesh.points[last] = mesh.points[last].map(|x| -x);
    put(&place, "a.ply", &mesh);
    refused(&place, &["a.ply", "--report", "r.json"], &["invalid mesh: triangles", "meet at ("]);
    let report: Value = serde_json::from_slice(&place.read("r.json")).unwrap();
    assert_eq!(report["valid"], false);
    assert!(number(&report, "/overlaps") > 1.0 && number(&report, "/non_manifold_vertices") == 0.0);
}

#[test]
fn what_is_not_there_for_surfaces_is_said() {
    let place = Place::new();
    put(&place, "a.off", &sphere(1.0, 0.5));
    let uniform = ["a.off", "--metric", "uniform"];
    for (more, expected) in [
        (&["--recovery", "l2"][..], "not supported: --recovery"),
        (&["--background", "a.off"], "not supported: --background"),
        (&["--domain", "rect:0,0,1,1"], "not supported: a.off is not planar"),
        (&["--h-min", "2", "--h-max", "1"], "h_min"),
    ] {
        refused(&place, &[&uniform[..], more].concat(), &[expected, "help: "]);
    }
    refused(&place, &["a.off", "--metric", "swirl"], &["not supported: metric swirl on a surface"]);
    refused(&place, &["a.off", "--domain", "cube:1"], &["neither a shape nor a file", "torus:R,r", ".geojson"]);
    refused(&place, &["a.xyz"], &["a.xyz", ".off"]);
    assert_eq!(place.files(), ["a.off"]);
}

#[test]
fn planar_meshes_of_surface_formats_stay_planar() {
    let place = Place::new();
    place.put("a.off", "OFF 4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n");
    let (report, _) = checked(&place, &["a.off", "--metric", "uniform:4,0,4", "--domain", "rect:0,0,1,1"]);
    assert!((number(&report, "/metric_edge_length/min") - 2.0).abs() < 1e-12);
    assert_eq!(report["worst"]["longest_edge"]["at"].as_array().unwrap().len(), 2);
    assert!(number(&report, "/fidelity/mesh_to_domain/distance") < 1e-15);
    let (report, _) = checked(&place, &["a.off", "--metric", "uniform:4,0,4"]);
    assert!((number(&report, "/metric_edge_length/min") - 2.0).abs() < 1e-12);
    // Held against a surface that happens to be flat.
    let (report, _) = checked(&place, &["a.off", "--metric", "uniform", "--domain", "a.off"]);
    assert!(number(&report, "/fidelity/hausdorff") < 1e-15);
    assert!((number(&report, "/metric_edge_length/min") - 1.0).abs() < 1e-12);
}

#[test]
fn a_sphere_is_meshed_and_the_dual_of_its_vertices_is_the_mesh() {
    let place = Place::new();
    let words = ["mesh", "sphere:1", "--metric", "uniform", "-n", "60", "--canvas-size", "20", "-o", "s.obj"];
    let output =
        place.run(&[&words[..], &["--report", "s.json", "--picture", "s.svg", "--show", "cells,mesh"]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let report = json(&place, "s.json");
    assert_eq!(
        (report["vertices"].as_u64(), report["euler"].as_i64(), report["valid"].as_bool()),
        (Some(60), Some(2), Some(true))
    );
    assert!(report["quality"]["mean"].as_f64().unwrap() > 0.95 && text(&place, "s.svg").contains("<image"));
    let seeds: Vec<String> =
        text(&place, "s.obj").lines().filter_map(|l| l.strip_prefix("v ").map(String::from)).collect();
    place.put("seeds.txt", seeds.join("\n"));
    let output = place.run(&[
        "dual",
        "sphere:1",
        "--metric",
        "uniform",
        "--seeds",
        "seeds.txt",
        "-o",
        "d.obj",
        "--report",
        "d.json",
        "--canvas-size",
        "10",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    let sides = |file: &str| {
        let mut faces: Vec<Vec<u32>> = Vec::new();
        for line in text(&place, file).lines().filter_map(|l| l.strip_prefix("f ").map(String::from)) {
            let mut face: Vec<u32> = line.split_whitespace().map(|v| v.parse().unwrap()).collect();
            face.sort_unstable();
            faces.push(face);
        }
        faces.sort_unstable();
        faces
    };
    assert_eq!(sides("s.obj"), sides("d.obj"));
    assert_eq!(json(&place, "d.json")["diagram"]["orphans"].as_u64(), Some(0));
}

#[test]
fn what_surfaces_do_not_have_is_refused_before_anything_is_written() {
    let place = Place::new();
    place.put("off.txt", "0 0 1\n0 0 1.5\n");
    place.put("flat.txt", "0 1\n");
    place.put("few.txt", "1 0 0\n0 1 0\n0 0 1\n-1 0 0\n0 -1 0\n0 0 -1\n");
    let mesh = ["mesh", "sphere:1", "--metric", "uniform", "-n", "60", "-o", "s.obj"];
    let plate = ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "60", "-o", "s.obj"];
    let dual = |seeds: &'static str| ["dual", "sphere:1", "--metric", "uniform", "--seeds", seeds, "-o", "d.obj"];
    for (words, expected) in [
        ([&mesh[..], &["--picking-radius", "0.1"]].concat(), "not supported: --picking-radius on a surface"),
        (
            [&dual("few.txt")[..], &["--canvas-size", "certified"]].concat(),
            "no canvas is certified for these seeds: psi0 - 1 within 6 epsilon",
        ),
        (
            [&dual("few.txt")[..], &["--voronoi", "du-wang", "--edges", "geodesic"]].concat(),
            "--edges geodesic with a diagram that measures straight distances",
        ),
        (dual("off.txt").to_vec(), "off.txt:2: the seed (0, 0, 1.5) is off the surface"),
        (dual("flat.txt").to_vec(), "flat.txt:1: '0 1' is no point"),
        ([&plate[..], &["--fit"]].concat(), "not supported: --fit in the plane"),
    ] {
        let before = place.files();
        let output = place.run(&words);
        let said = stderr(&output);
        assert!(output.status.code() == Some(1) && said.contains(expected), "{words:?}: {said}");
        assert_eq!(place.files(), before);
    }
}

/// Cells of straight distances fall into parts on a sphere, too, and those of geodesics do not: their regions are a mesh.
#[test]
fn orphans_and_regions_of_surfaces_are_told() {
    let place = Place::new();
    let turns = |i: u32| f64::from(i) * 2.399_963_229_728_653;
    let height = |i: u32| 1.0 - (2.0 * f64::from(i) + 1.0) / 100.0;
    let point = |i: u32| {
        let (z, r) = (height(i), (1.0 - height(i).powi(2)).sqrt());
        format!("{} {} {z}\n", r * turns(i).cos(), r * turns(i).sin())
    };
    place.put("seeds.txt", (0..100).map(point).collect::<String>());
    let metric = "shock:phi=6,lambda=0.3";
    let dual = ["dual", "sphere:1", "--metric", metric, "--seeds", "seeds.txt", "-o", "d.vtu", "--report", "d.json"];
    let orphans = |kind: &str| {
        let more = ["--voronoi", kind, "--canvas-size", "60", "--picture", "d.svg", "--show", "cells"];
        let output = place.run(&[&dual[..], &more].concat());
        assert!(output.status.success(), "{kind}: {}", stderr(&output));
        let report = json(&place, "d.json");
        assert!(report["net"].is_null() && report["options"]["voronoi"] == kind);
        report["diagram"]["orphan_components"].as_u64().unwrap()
    };
    assert!(orphans("du-wang") > 0 && orphans("labelle-shewchuk") > 0);
    assert_eq!(orphans("riemannian"), 0);
    let even = ["dual", "sphere:1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "r.obj", "--report", "r.json"];
    let drawn = ["--edges", "geodesic", "--picture", "r.svg", "--show", "triangles"];
    let output = place.run(&[&even[..], &drawn].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let found = &json(&place, "r.json")["dual"];
    assert!(found["crossing_geodesics"] == 0 && found["open_regions"] == 0, "{found}");
    let faces = text(&place, "r.obj").lines().filter(|line| line.starts_with("f ")).count();
    assert!(faces > 2000, "{faces}");
}

/// A net on a sphere is measured, and what is certified of it; Lemma 11.2 says why it is not.
#[test]
fn nets_and_certificates_of_surfaces_are_told() {
    let place = Place::new();
    let mut random = 1_u64;
    let mut number = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut point = || {
        let (z, angle) = (2.0 * number() - 1.0, std::f64::consts::TAU * number());
        let r = (1.0 - z * z).sqrt();
        format!("{} {} {z}\n", r * angle.cos(), r * angle.sin())
    };
    place.put("seeds.txt", (0..60).map(|_| point()).collect::<String>());
    let dual =
        ["dual", "sphere:1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "d.obj", "--canvas-size", "20"];
    let output = place.run(&[&dual[..], &["--net", "--certify", "--report", "d.json"]].concat());
    assert!(output.status.success(), "{}", stderr(&output));
    let report = json(&place, "d.json");
    assert_eq!((report["net"]["interior"].as_u64(), report["net"]["unmeasured"].as_u64()), (Some(116), Some(0)));
    let verdicts = report["certificate"]["verdicts"].as_array().unwrap();
    let of = |theorem: &str| verdicts.iter().find(|verdict| verdict["theorem"] == theorem).unwrap();
    assert_eq!(of("10.20")["outcome"], "fails");
    assert_eq!(of("9.10")["outcome"], "fails");
    assert!(of("11.2")["not_measured"].as_str().unwrap().contains("section 12"));
    assert!((report["certificate"]["convexity"]["curvature"].as_f64().unwrap() - 1.0).abs() < 0.01);
}
