//! `voronaut dual`, and `voronaut mesh` on a canvas: seeds kept, exact duals, faults by their place, complete reports.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::collections::BTreeSet;
use voronaut::geometry::{Point, Vector};
use voronaut::mesh::Mesh;
use voronaut::planar::delaunay;
use voronaut_io::medit;

/// Random points between two corners, the same on every machine.
fn scattered(count: usize, low: f64, high: f64, salt: u64) -> Vec<Point> {
    let mut state = salt;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
    };
    (0..count).map(|_| Point::new(next(), next())).collect()
}

fn seed_file(seeds: &[Point]) -> String {
    seeds.iter().fold("# seeds\n".into(), |text, p| text + &format!("{} {}\n", p.x, p.y))
}

/// Runs a command that must succeed; returns what it said on stderr.
fn runs(place: &Place, words: &[&str]) -> String {
    let output = place.run(words);
    let said = stderr(&output);
    assert!(output.status.success(), "{words:?}: {said}");
    said
}

fn mesh(place: &Place, name: &str) -> Mesh {
    medit::read(place.read(name).as_slice(), name).unwrap().mesh
}

fn report(place: &Place, name: &str) -> Value {
    serde_json::from_slice(&place.read(name)).unwrap()
}

const SQUARE: &str = "rect:-2,-2,2,2";

fn dual<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&["dual", SQUARE, "--seeds", "seeds.txt", "-o", "out.mesh", "-q"][..], more].concat()
}

/// A place with 20 seeds whose dual in the swirl has inverted straight triangles.
fn swirled() -> Place {
    let place = Place::new();
    place.put("seeds.txt", seed_file(&scattered(20, -2.0, 2.0, 5)));
    place
}

/// The square of the length of e is e' M e with M = (4, 1; 1, 1): this map makes it Euclidean.
fn image(p: Point) -> Point {
    Point::new(2.0 * p.x + 0.5 * p.y, 0.75_f64.sqrt() * p.y)
}

/// Delaunay triangles of the images whose circumcircles lie, but for a margin, in the image of the square.
fn inner_delaunay(seeds: &[Point]) -> BTreeSet<[u32; 3]> {
    let images: Vec<Point> = seeds.iter().map(|&p| image(p)).collect();
    let exact = delaunay(&images).unwrap();
    let is_inner = |t: &[u32; 3]| {
        if t.iter().any(|&v| v as usize >= images.len()) {
            return false;
        }
        let [a, b, c] = t.map(|v| images[v as usize]);
        let (u, v) = (b - a, c - a);
        let x = Vector::new(u.dot(u) * v.y - v.dot(v) * u.y, v.dot(v) * u.x - u.dot(u) * v.x) * (0.5 / u.cross(v));
        (0..64).all(|i| {
            let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 64.0).sin_cos();
            let q = a + x + Vector::new(cos, sin) * x.norm();
            let y = q.y / 0.75_f64.sqrt();
            y.abs() < 1.99 && (0.5 * q.x - 0.25 * y).abs() < 1.99
        })
    };
    exact.topology.faces().map(|f| exact.topology.corners(f).map(|v| v.0)).filter(is_inner).map(sorted).collect()
}

fn sorted(mut t: [u32; 3]) -> [u32; 3] {
    t.sort_unstable();
    t
}

#[test]
fn seeds_are_vertices_in_order_and_uniform_duals_are_delaunay() {
    let place = Place::new();
    let seeds = scattered(150, -1.99, 1.99, 1);
    place.put("seeds.txt", seed_file(&seeds));
    let truth = inner_delaunay(&seeds);
    assert!(truth.len() > 150, "{}", truth.len());
    for road in ["geodesic", "canvas", "both"] {
        runs(&place, &dual(&["--metric", "uniform:4,1,1", "--dual", road, "--canvas-size", "16"]));
        let mesh = mesh(&place, "out.mesh");
        let points: Vec<Point> = mesh.points.iter().map(|p| Point::new(p[0], p[1])).collect();
        assert_eq!(points, seeds, "{road}");
        let found: BTreeSet<[u32; 3]> = mesh.triangles.iter().copied().map(sorted).collect();
        // The nerve alone errs where four seeds are nearly on a circle.
        let missing = truth.difference(&found).count();
        assert!(missing <= usize::from(road == "canvas"), "{road}: {missing}");
        // What else there is leans on the border of the domain.
        assert!(found.len() < truth.len() + 120, "{road}: {} and {}", found.len(), truth.len());
    }
}

#[test]
fn inverted_triangles_are_counted_and_strictly_refused() {
    let place = swirled();
    let words = ["--metric", "swirl", "--report", "out.json", "--canvas-size", "10"];
    let quiet: Vec<&str> = dual(&words).into_iter().filter(|&word| word != "-q").collect();
    let said = runs(&place, &quiet);
    let found = report(&place, "out.json");
    let inverted = found["inverted"].as_u64().unwrap();
    assert!(inverted > 0 && found["valid"] == false, "{found}");
    assert!(said.contains(&format!("{inverted} straight triangles come out inverted")), "{said}");
    let clockwise = |mesh: &Mesh| {
        let at = |t: [u32; 3]| t.map(|v| mesh.point(v));
        mesh.triangles.iter().filter(|&&t| (at(t)[1] - at(t)[0]).cross(at(t)[2] - at(t)[0]) <= 0.0).count()
    };
    assert_eq!(clockwise(&mesh(&place, "out.mesh")) as u64, inverted);
    let place = swirled();
    let output = place.run(&dual(&[&words[..], &["--strict", "--diagram", "cells.vtu"]].concat()));
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("inverted"), "{}", stderr(&output));
    assert_eq!(place.files(), ["out.json", "seeds.txt"], "the report says why; no mesh, no diagram");
    assert_eq!(report(&place, "out.json")["inverted"], inverted);
}

#[test]
fn duals_that_embed_pass_strictly() {
    let place = Place::new();
    place.put("seeds.txt", seed_file(&scattered(60, -2.0, 2.0, 3)));
    runs(&place, &dual(&["--metric", "uniform", "--strict", "--report", "out.json", "--canvas-size", "10"]));
    let found = report(&place, "out.json");
    assert_eq!((&found["valid"], &found["inverted"], &found["vertices"]), (&true.into(), &0.into(), &60.into()));
}

/// What stands before the raw data of a .vtu file, and the tags that it leaves open.
fn head(file: &[u8]) -> (String, &str) {
    let raw = file.windows(2).position(|pair| pair == b"\n_").unwrap();
    (String::from_utf8(file[..raw].to_vec()).unwrap(), "</AppendedData></VTKFile>")
}

/// The bytes of an array of a .vtu file, each entry as an array of N.
fn array<const N: usize>(file: &[u8], name: &str) -> Vec<[u8; N]> {
    let (head, _) = head(file);
    let from = head.find(&format!("Name=\"{name}\"")).unwrap_or_else(|| panic!("no {name}"));
    let offset = head[from..].split("offset=\"").nth(1).unwrap().split('"').next().unwrap();
    let at = head.len() + 2 + offset.parse::<usize>().unwrap();
    let size = u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;
    file[at + 8..at + 8 + size].chunks_exact(N).map(|chunk| chunk.try_into().unwrap()).collect()
}

fn colours(file: &[u8]) -> Vec<i32> {
    array(file, "colour").into_iter().map(i32::from_le_bytes).collect()
}

/// Every tag is closed by its own name.
fn assert_well_formed(text: &str) {
    let mut open: Vec<&str> = Vec::new();
    for tag in text.split('<').skip(1).map(|rest| &rest[..rest.find('>').expect("a tag ends")]) {
        let name = tag.trim_start_matches('/').split_whitespace().next().unwrap_or_default();
        match tag {
            _ if tag.starts_with(['?', '!']) || tag.ends_with('/') => {}
            _ if tag.starts_with('/') => assert_eq!(open.pop(), Some(name)),
            _ => open.push(name),
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn diagrams_are_written_with_colours_and_distances() {
    let place = swirled();
    runs(
        &place,
        &dual(&["--metric", "shock:phi=1", "--diagram", "cells.vtu", "--report", "out.json", "--canvas-size", "10"]),
    );
    let file = place.read("cells.vtu");
    let (text, rest) = head(&file);
    assert_well_formed(&(text.clone() + rest));
    let distances: Vec<f64> = array(&file, "distance").into_iter().map(f64::from_le_bytes).collect();
    let colours = colours(&file);
    let vertices = report(&place, "out.json")["canvas"]["vertices"].as_u64().unwrap() as usize;
    assert_eq!((colours.len(), distances.len()), (vertices, vertices));
    assert!(text.contains(&format!("NumberOfPoints=\"{vertices}\"")));
    assert_eq!(colours.into_iter().collect::<BTreeSet<_>>(), (0..20).collect());
    assert!(distances.iter().all(|d| *d >= 0.0 && *d < 20.0));
}

#[test]
fn reports_are_complete() {
    let place = swirled();
    let picture = ["--picture", "out.svg", "--show", "mesh,cells,witnesses,geodesics"];
    for road in ["geodesic", "canvas", "both"] {
        let words = ["--metric", "swirl", "--dual", road, "--report", "out.json", "--canvas-size", "12"];
        runs(&place, &dual(&[&words[..], &picture].concat()));
        let found = report(&place, "out.json");
        assert_eq!((&found["canvas"]["kind"], &found["options"]["dual"]), (&"intrinsic".into(), &road.into()));
        assert!(found["canvas"]["vertices"].as_u64().unwrap() >= 30_000);
        assert_eq!(found["diagram"]["orphans"], 0);
        let dual = &found["dual"];
        assert!(dual["geodesic_tests"].as_array().unwrap().iter().any(|count| count.as_u64() > Some(0)), "{dual}");
        let listed = dual["uncertain_edges"].as_array().unwrap();
        assert_eq!(dual["uncertain"], listed.len());
        assert!(dual["min_margin"].is_number() && dual["blocked_flips"].is_u64(), "{dual}");
        for edge in dual["disagreements"].as_array().unwrap().iter().chain(listed) {
            assert!(edge["edge"].as_array().is_some_and(|ends| ends.len() == 2), "{edge}");
            assert!(edge["margin"].is_number() && edge.get("error").is_some(), "{edge}");
        }
        for stage in ["read", "canvas", "diagram", "dual", "total"] {
            assert!(found["seconds"][stage].is_number(), "{stage}");
        }
        assert!(found["peak_memory_bytes"].is_u64() && found["version"].is_string());
        assert_well_formed(&String::from_utf8(place.read("out.svg")).unwrap());
    }
}

/// A command that must fail with these words on stderr, and leave no file.
fn refused(place: &Place, words: &[&str], expected: &[&str]) {
    let before = place.files();
    let output = place.run(words);
    let said = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{words:?}: {said}");
    assert!(said.starts_with("error: ") && said.contains("\n  help: "), "{words:?}: {said}");
    assert!(expected.iter().all(|part| said.contains(part)), "{words:?}: {expected:?} in {said}");
    assert_eq!(place.files(), before, "{words:?} left files");
}

#[test]
fn bad_seeds_are_named_by_their_line() {
    let with = |text: &[u8], expected: &[&str]| {
        let place = Place::new();
        place.put("seeds.txt", text);
        for road in ["canvas", "both"] {
            refused(&place, &dual(&["--metric", "uniform", "--dual", road]), expected);
        }
    };
    with(b"# corners\n0 0\n\n1 1 # fine\n3 0.5\n1 0\n", &["seeds.txt:5", "(3, 0.5)", "outside the domain"]);
    with(b"0 0\n1e300 -1e300\n1 0\n", &["seeds.txt:2", "outside the domain"]);
    with(b"0 0\nnan 1\n", &["seeds.txt:2", "'nan 1' is no point"]);
    with(b"0 0\n1 0\n1 1 1\n", &["seeds.txt:3", "'1 1 1' is no point"]);
    with(b"0 0\n1\n", &["seeds.txt:2", "two numbers"]);
    with(b"0 0\n1 0\n\n0 1\n1 0\n", &["seeds.txt:5", "(1, 0)", "line 2"]);
    with(b"0 0\n1 0\n-0 0\n", &["seeds.txt:3", "line 1"]);
    with(b"", &["seeds.txt", "empty"]);
    with(b"# none\n\n", &["seeds.txt", "no seed"]);
    with(b"\xff\xfe0", &["seeds.txt", "not a text in UTF-8 (byte 1)"]);
    refused(&Place::new(), &dual(&["--metric", "uniform"]), &["seeds.txt", "No such file"]);
}

#[test]
fn bad_outputs_and_limits_are_refused_before_the_work() {
    let place = swirled();
    let with = |more: &[&'static str], expected: &[&str]| {
        let words = ["dual", SQUARE, "--metric", "uniform", "--seeds", "seeds.txt"];
        refused(&place, &[&words[..], more].concat(), expected);
    };
    with(&["-o", "out.svg"], &["out.svg", ".mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl"]);
    with(&["-o", "out.mesh", "--diagram", "out.svg"], &["out.svg", ".vtu"]);
    with(&["-o", "out.mesh", "--picture", "out.vtu"], &["out.vtu", ".svg or .png"]);
    with(&["-o", "out.mesh", "--diagram", "nowhere/out.vtu"], &["nowhere"]);
    with(&["-o", "out.vtu", "--diagram", "./out.vtu"], &["two outputs have the same name"]);
    with(&["-o", "out.mesh", "--memory-limit", "0.01"], &["limit exceeded", "MiB", "--memory-limit"]);
    with(&["-o", "out.mesh", "--canvas-size", "4000000000"], &["limit exceeded", "--canvas-size"]);
}

#[test]
fn one_seed_or_two_have_cells_but_no_triangles() {
    for count in 1..3 {
        let place = Place::new();
        place.put("seeds.txt", seed_file(&scattered(count, -1.0, 1.0, 2)));
        let words = ["--metric", "swirl", "--diagram", "cells.vtu", "--canvas-size", "6"];
        let said = runs(&place, &[&dual(&words)[..6], &words].concat());
        assert!(said.contains("no triangles"), "{said}");
        assert_eq!((mesh(&place, "out.mesh").points.len(), mesh(&place, "out.mesh").triangles.len()), (count, 0));
        let found: BTreeSet<i32> = colours(&place.read("cells.vtu")).into_iter().collect();
        assert_eq!(found, (0..).take(count).collect());
        let output = place.run(&dual(&["--metric", "swirl", "--strict", "--canvas-size", "6"]));
        assert_eq!(output.status.code(), Some(1), "no mesh is not a valid mesh");
    }
}

/// Two regions (5 and 6), a hole, labels 11 to 16.
const PLATE: &str = "10 2 0 0\n1 0 0\n2 2 0\n3 4 0\n4 4 2\n5 2 2\n6 0 2\n7 0.5 0.5\n8 1 0.5\n9 1 1\n10 0.5 1\n\
                     11 1\n1 1 2 11\n2 2 3 11\n3 3 4 12\n4 4 5 13\n5 5 6 13\n6 6 1 14\n7 2 5 15\n\
                     8 7 8 16\n9 8 9 16\n10 9 10 16\n11 10 7 16\n1\n1 0.7 0.7\n2\n1 0.1 0.1 5\n2 3 1 6\n";

#[test]
fn labels_of_the_border_are_carried() {
    let place = Place::new();
    place.put("plate.poly", PLATE);
    let grid = (0..16 * 8).map(|i| Point::new(0.13 + 0.25 * f64::from(i % 16), 0.12 + 0.25 * f64::from(i / 16)));
    let is_outside = |p: &Point| p.x > 0.45 && p.x < 1.05 && p.y > 0.45 && p.y < 1.05;
    place.put("seeds.txt", seed_file(&grid.filter(|p| !is_outside(p)).collect::<Vec<_>>()));
    let words = ["dual", "plate.poly", "--metric", "uniform:1,0.1,2", "--seeds", "seeds.txt", "-o", "out.mesh"];
    runs(&place, &words);
    let mesh = mesh(&place, "out.mesh");
    let labels: BTreeSet<i32> = mesh.edge_labels.iter().copied().collect();
    assert!([11, 12, 13, 14, 16].iter().all(|label| labels.contains(label)), "{labels:?}");
    assert!(!labels.contains(&15), "the border between regions is no border of the domain: {labels:?}");
    for (&edge, label) in mesh.edges.iter().zip(&mesh.edge_labels) {
        let [p, q] = edge.map(|v| mesh.point(v));
        let is_near = match label {
            11 => p.y.max(q.y) < 0.2,
            12 => p.x.min(q.x) > 3.8,
            13 => p.y.min(q.y) > 1.8,
            14 => p.x.max(q.x) < 0.2,
            _ => p.lerp(q, 0.5).distance(Point::new(0.75, 0.75)) < 0.6,
        };
        assert!(is_near, "{label}: {p} {q}");
    }
    let regions: BTreeSet<i32> = mesh.triangle_labels.iter().copied().collect();
    assert_eq!(regions, [5, 6].into());
}

/// A sea with islands, one of them with a lake.
const SEA: &str = r#"{"type":"MultiPolygon","coordinates":[
    [[[0,0],[9,0.5],[10,4],[8,7],[5,6.5],[1,8],[-1,3],[0,0]],
     [[2,2],[2,4],[3,4.5],[4,3],[3.5,1.8],[2,2]], [[4.1,3],[6,4],[6.5,3],[5,2],[4.1,3]], [[7,4],[7,5],[8,4.5],[7,4]]],
    [[[2.4,2.5],[3.2,2.6],[3,3.6],[2.4,2.5]]]]}"#;

/// Meshes with a report, held against `check`; returns the report.
fn meshed(place: &Place, words: &[&str]) -> Value {
    runs(place, &[&["mesh"][..], words, &["-o", "out.mesh", "--report", "out.json", "-q"]].concat());
    runs(place, &["check", "out.mesh", "--domain", words[0], "-q"]);
    let found = report(place, "out.json");
    assert_eq!(found["valid"], true, "{words:?}");
    found
}

#[test]
fn meshes_by_every_road_are_valid_and_have_the_count() {
    let place = Place::new();
    for (road, metric) in [("geodesic", "swirl"), ("canvas", "swirl"), ("both", "swirl"), ("canvas", "shock:phi=1")] {
        let size = if road == "geodesic" { &[][..] } else { &["--canvas-size", "30"] };
        let words = [SQUARE, "--metric", metric, "-n", "600", "--dual", road];
        let found = meshed(&place, &[&words[..], size].concat());
        assert_eq!((&found["vertices"], &found["options"]["dual"]), (&600.into(), &road.into()));
        let listed = found["dual"]["uncertain_edges"].as_array().unwrap().len();
        assert_eq!(found["dual"]["uncertain"], listed);
        if road == "canvas" {
            assert!(found["canvas"]["vertices"].as_u64() > Some(0) && found["diagram"]["orphans"] == 0, "{found}");
            assert!(found["dual"]["compared"].as_u64() > Some(1000), "{found}");
        }
        if road == "geodesic" {
            assert!(found["canvas"].is_null() && found["diagram"].is_null());
        }
    }
}

#[test]
fn farthest_points_mesh_seas_with_islands() {
    let place = Place::new();
    place.put("sea.geojson", SEA);
    let metric = "boundary:h0=0.2,growth=1.3,aspect=2,h_max=2";
    let words = ["sea.geojson", "--metric", metric, "--seeding", "farthest"];
    let found = meshed(&place, &[&words[..], &["-n", "800"]].concat());
    assert_eq!((&found["vertices"], &found["options"]["seeding"]), (&800.into(), &"farthest".into()));
    assert_eq!((&found["boundary_loops"], &found["diagram"]["orphans"]), (&5.into(), &0.into()));
    assert!(found["canvas"]["vertices"].as_u64() >= Some(48_000), "{}", found["canvas"]);
    assert!(found["seconds"]["canvas"].is_number());
    assert!(found["metric_edge_length"]["unit_fraction"].as_f64() > Some(0.8), "{}", found["metric_edge_length"]);
    let found = meshed(&place, &[&words[..], &["--complexity", "500"]].concat());
    assert!(found["vertices"].as_u64().is_some_and(|n| (400..900).contains(&n)), "{}", found["vertices"]);
}

#[test]
fn cells_are_shown() {
    let place = Place::new();
    let picture = ["--picture", "out.svg", "--show", "cells,mesh"];
    meshed(&place, &[&[SQUARE, "--metric", "swirl", "-n", "200"][..], &picture].concat());
    let text = String::from_utf8(place.read("out.svg")).unwrap();
    assert_well_formed(&text);
    runs(&place, &["mesh", SQUARE, "--metric", "swirl", "-n", "200", "-o", "b.mesh", "-q", "--picture", "b.svg"]);
    assert!(text.len() > place.read("b.svg").len() + 10_000, "cells take room");
}

#[test]
fn threads_do_not_change_a_byte() {
    let place = swirled();
    place.put("sea.geojson", SEA);
    let with = |words: &[&str], threads| {
        runs(&place, &[words, &["-o", "out.mesh", "-q", "--threads", threads]].concat());
        place.read("out.mesh")
    };
    let metric = "boundary:h0=0.2,growth=1.3,aspect=2,h_max=2";
    for words in [
        &["dual", SQUARE, "--metric", "swirl", "--seeds", "seeds.txt", "--canvas-size", "10"][..],
        &["mesh", SQUARE, "--metric", "swirl", "-n", "300", "--dual", "canvas"],
        &["mesh", "sea.geojson", "--metric", metric, "-n", "400", "--seeding", "farthest"],
    ] {
        assert!(with(words, "1") == with(words, "2"), "{words:?}");
    }
}

#[test]
fn canvases_are_chosen_and_named_in_the_report() {
    let place = Place::new();
    place.put("seeds.txt", seed_file(&scattered(12, 0.1, 0.9, 5)));
    let few = ["--canvas-size", "6", "--report", "r.json"];
    let base = ["dual", "rect:0,0,1,1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "d.mesh", "-q"];
    runs(&place, &[&base[..], &["--canvas", "isotropic"], &few].concat());
    assert_eq!(report(&place, "r.json")["canvas"]["kind"], "isotropic");
    for method in ["march", "konukoglu"] {
        let words = ["--canvas", "starset", "--geodesic", method];
        runs(&place, &[&base[..], &words, &few].concat());
        let report = report(&place, "r.json");
        assert_eq!((&report["canvas"]["kind"], report["valid"].as_bool()), (&Value::from("starset"), Some(true)));
        assert_eq!(report["canvas"]["stars"]["inconsistencies"], 0, "one metric");
    }
}

#[test]
fn the_star_set_mesher_reports_its_stars() {
    let place = Place::new();
    let words =
        ["mesh", "rect:0,0,2,1", "--metric", "uniform:30,5,1", "-n", "300", "--mesher", "starset", "-o", "m.mesh"];
    runs(&place, &[&words[..], &["--report", "r.json"]].concat());
    let report = report(&place, "r.json");
    assert_eq!((&report["valid"], &report["star_set"]["inconsistencies"]), (&Value::Bool(true), &Value::from(0)));
    assert_eq!(report["star_set"]["vertices"], report["vertices"]);
}

#[test]
fn other_diagrams_have_orphans_that_are_counted_and_drawn() {
    let place = Place::new();
    place.put("seeds.txt", seed_file(&scattered(100, -2.0, 2.0, 5)));
    let red = "#d8293c";
    for kind in ["riemannian", "du-wang", "labelle-shewchuk"] {
        let more = ["--metric", "swirl", "--voronoi", kind, "--canvas-size", "15", "--picture", "out.svg"];
        let outputs = ["--show", "cells", "--report", "out.json"];
        runs(&place, &dual(&[&more[..], &outputs].concat()));
        let (found, has_orphans) = (report(&place, "out.json"), kind != "riemannian");
        assert_eq!(found["options"]["voronoi"], kind);
        let [vertices, components] =
            ["orphans", "orphan_components"].map(|name| found["diagram"][name].as_u64().unwrap());
        assert!(vertices >= components && (components > 0) == has_orphans, "{kind}: {vertices} {components}");
        assert_eq!(found["diagram"]["raw_nerve"].is_null(), has_orphans);
        let picture = String::from_utf8(place.read("out.svg")).unwrap();
        assert_eq!(picture.contains(red), has_orphans, "{kind}");
    }
}

#[test]
fn what_only_geodesics_have_is_refused_of_other_diagrams() {
    let place = swirled();
    for more in [
        &["--edges", "geodesic"][..],
        &["--geodesic", "dijkstra"],
        &["--picture", "out.svg", "--show", "geodesics"],
        &["--picture", "out.svg", "--show", "protection"],
    ] {
        let output = place.run(&dual(&[&["--metric", "swirl", "--voronoi", "du-wang"][..], more].concat()));
        let said = stderr(&output);
        assert!(!output.status.success() && said.contains("straight distances"), "{more:?}: {said}");
    }
    let output = place.run(&dual(&["--metric", "swirl", "--voronoi", "power"]));
    assert!(stderr(&output).contains("no such Voronoi diagram"), "{}", stderr(&output));
}
