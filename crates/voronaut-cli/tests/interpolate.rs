//! `interpolate`: files, figures and messages.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::fmt::Write as _;
use voronaut::mesh::{Mesh, SolutionValues, Solutions};
use voronaut_io::{sol, write_mesh};

/// The unit square in n x n squares, each cut in two.
fn square(n: u32) -> Mesh {
    let at = |k: u32| f64::from(k) / f64::from(n);
    Mesh {
        points: (0..(n + 1) * (n + 1)).map(|k| [at(k % (n + 1)), at(k / (n + 1)), 0.0]).collect(),
        triangles: (0..n * n)
            .map(|k| k % n + k / n * (n + 1))
            .flat_map(|a| [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]])
            .collect(),
        ..Mesh::default()
    }
}

/// Squares of 5 and 8 to a side, and a file of a linear function, its gradient, a metric, and 0 or 1 on triangles.
fn place() -> Place {
    let place = Place::new();
    for (name, n) in [("old.mesh", 5), ("new.mesh", 8)] {
        write_mesh(&square(n), &place.path().join(name)).unwrap();
    }
    let mut text = "MeshVersionFormatted 2 Dimension 2 SolAtVertices 36 3 1 2 3\n".to_string();
    for [x, y, _] in square(5).points {
        let _ = writeln!(text, "{} 2 -3 {} 0 4", 2.0 * x - 3.0 * y, if x < 0.5 { 1.0 } else { 100.0 });
    }
    text += "SolAtTriangles 50 1 1\n";
    text += &"0\n1\n".repeat(25);
    place.put("all.sol", text);
    place
}

fn done(place: &Place, words: &str) -> String {
    let output = place.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(0), "{words}: {}", stderr(&output));
    String::from_utf8(output.stdout).unwrap()
}

fn solutions(place: &Place, name: &str) -> Solutions {
    sol::read_all(place.read(name).as_slice(), name).unwrap()
}

#[test]
fn every_field_of_a_file_is_carried() {
    for more in ["", " --conservative", " --conservative --overshoot"] {
        let place = place();
        let told = done(&place, &format!("interpolate old.mesh new.mesh all.sol -o out.sol{more}"));
        assert!(told.starts_with("out.sol (") && told.lines().count() == 1 + 1 + 2 + 3 + 1, "{told}");
        let carried = solutions(&place, "out.sol");
        let [SolutionValues::Scalar(u), SolutionValues::Vector { numbers: g, .. }, SolutionValues::Tensor(m)] =
            &carried.vertices[..]
        else {
            panic!("{carried:?}")
        };
        for (v, [x, y, _]) in square(8).points.into_iter().enumerate() {
            assert!((u[v] - (2.0 * x - 3.0 * y)).abs() < 1e-12);
            assert!((g[2 * v] - 2.0).abs() < 1e-12 && (g[2 * v + 1] + 3.0).abs() < 1e-12);
            // The logarithm is linear between 0.4 and 0.6.
            let m11 = 100.0_f64.powf(((x - 0.4) / 0.2).clamp(0.0, 1.0));
            assert!((m[v][0] - m11).abs() < 1e-9 && m[v][1].abs() < 1e-12 && (m[v][2] - 4.0).abs() < 1e-12, "{m:?}");
        }
        let [SolutionValues::Scalar(c)] = &carried.triangles[..] else { panic!("{carried:?}") };
        assert_eq!(c.len(), 128);
        // Means, but for rounding.
        assert!(c.iter().all(|c| (-1e-15..=1.0 + 1e-15).contains(c)));
        let mean = c.iter().sum::<f64>() / 128.0;
        assert!((mean - 0.5).abs() < if more.is_empty() { 0.1 } else { 1e-14 }, "{mean}");
    }
}

#[test]
fn the_report_has_ranges_and_masses() {
    let place = place();
    assert_eq!(
        done(&place, "interpolate old.mesh new.mesh all.sol -o out.sol --conservative --report run.json -q"),
        ""
    );
    assert_eq!(place.files(), ["all.sol", "new.mesh", "old.mesh", "out.sol", "run.json"]);
    let report: Value = serde_json::from_slice(&place.read("run.json")).unwrap();
    assert_eq!(report["old"]["vertices"], 36);
    assert_eq!(report["new"]["triangles"], 128);
    assert_eq!(report["method"], "conservative");
    assert_eq!((report["cover"]["outside"].as_i64(), report["cover"]["uncovered"].as_f64()), (Some(0), Some(0.0)));
    let kinds: Vec<&str> = report["fields"].as_array().unwrap().iter().map(|f| f["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["scalar", "vector", "metric", "scalar"]);
    for (field, mass) in [(0, -0.5), (3, 0.5)] {
        for time in ["before", "after"] {
            let told = report["fields"][field][time][0]["mass"].as_f64().unwrap();
            assert!((told - mass).abs() < 1e-14, "{told}");
        }
    }
    assert!(report["fields"][2]["after"][0]["mass"].is_null());
    assert!(report["seconds"]["total"].as_f64().unwrap() > 0.0);
}

#[test]
fn tensors_that_are_no_metrics_are_carried_as_they_are() {
    let place = place();
    let rows = "0 1 0\n".repeat(36);
    place.put("stress.sol", format!("MeshVersionFormatted 2 Dimension 2 SolAtVertices 36 1 3\n{rows}"));
    done(&place, "interpolate old.mesh new.mesh stress.sol -o out.sol --linear-tensors -q");
    assert_eq!(solutions(&place, "out.sol").vertices, [SolutionValues::Tensor(vec![[0.0, 1.0, 0.0]; 81])]);
}

#[test]
fn another_chord_is_noted() {
    let place = place();
    let mut round = square(8);
    round.points.iter_mut().filter(|p| p[0] > 0.99).for_each(|p| p[0] += 0.02 * p[1] * (1.0 - p[1]));
    write_mesh(&round, &place.path().join("new.mesh")).unwrap();
    let output = place.run(&["interpolate", "old.mesh", "new.mesh", "all.sol", "-o", "out.sol", "--conservative"]);
    assert_eq!(output.status.code(), Some(0), "{}", stderr(&output));
    assert!(
        stderr(&output).contains("note: 7 vertices are outside the old mesh, by up to 5.000e-3"),
        "{}",
        stderr(&output)
    );
    assert!(stderr(&output).contains("of the area is in one mesh only"), "{}", stderr(&output));
}

#[test]
fn what_is_wrong_is_said_and_nothing_is_written() {
    let place = place();
    let mut bent = square(5);
    bent.points[7][2] = 0.1;
    write_mesh(&bent, &place.path().join("bent.mesh")).unwrap();
    let mut far = square(5);
    far.points.iter_mut().for_each(|p| p[0] += 3.0);
    write_mesh(&far, &place.path().join("far.mesh")).unwrap();
    let half = Mesh { triangles: square(8).triangles[..64].to_vec(), ..square(8) };
    write_mesh(&half, &place.path().join("half.mesh")).unwrap();
    place.put("flat.sol", format!("MeshVersionFormatted 2 Dimension 2 SolAtVertices 36 1 3\n{}", "0 1 0\n".repeat(36)));
    place.put("nan.sol", "MeshVersionFormatted 2 Dimension 2 SolAtVertices 1 1 1 nan");
    place.put("none.sol", "MeshVersionFormatted 2 Dimension 2 End");
    place.put(
        "m3.sol",
        format!("MeshVersionFormatted 2 Dimension 3 SolAtVertices 36 1 3\n{}", "1 0 1 0 0 1\n".repeat(36)),
    );
    let before = place.files();
    for (words, code, message) in [
        ("old.mesh new.mesh", 2, "required"),
        ("old.mesh new.mesh all.sol -o out.sol --overshoot", 2, "--conservative"),
        ("old.mesh new.mesh all.sol -o out.mesh", 1, "out.mesh does not end like a solution file"),
        ("old.mesh new.mesh all.sol -o out.sol --report out.sol", 1, "two outputs have the same name"),
        ("old.mesh new.mesh all.sol -o nowhere/out.sol", 1, "nowhere"),
        ("none.mesh new.mesh all.sol -o out.sol", 1, "none.mesh"),
        (
            "new.mesh old.mesh all.sol -o out.sol",
            1,
            "all.sol: SolAtVertices has 36 entries, and new.mesh has 81 vertices",
        ),
        ("new.mesh old.mesh all.sol -o out.sol", 1, "help: old.mesh has 36: give the meshes in the other order"),
        ("bent.mesh new.mesh all.sol -o out.sol", 1, "is not zero at vertex"),
        ("old.mesh far.mesh all.sol -o out.sol", 1, "the new mesh ((3, 0) to (4, 1)) reaches beyond the old one"),
        (
            "old.mesh half.mesh all.sol -o out.sol --conservative",
            1,
            "50.0 % of the old mesh's area are outside the new mesh",
        ),
        ("old.mesh new.mesh flat.sol -o out.sol", 1, "is not positive definite at vertex 1 (0, 0)"),
        ("old.mesh new.mesh nan.sol -o out.sol", 1, "nan.sol:1: 'nan' is not a finite number"),
        ("old.mesh new.mesh none.sol -o out.sol", 1, "no section SolAtVertices, nor SolAtTriangles"),
        ("old.mesh new.mesh m3.sol -o out.sol", 1, "metrics of space on planar meshes"),
    ] {
        let all: Vec<&str> = std::iter::once("interpolate").chain(words.split_whitespace()).collect();
        let output = place.run(&all);
        assert_eq!(output.status.code(), Some(code), "{words}: {}", stderr(&output));
        assert!(stderr(&output).contains(message), "{words}: {}", stderr(&output));
    }
    assert_eq!(place.files(), before);
}
