//! `remesh`: mmgs's options, files and exit codes.

use crate::common::{Place, stderr};
use serde_json::Value;
use voronaut::manifold::surface::torus;
use voronaut::mesh::{Mesh, SolutionValues};
use voronaut_io::{medit, sol, write_mesh};

/// A directory with a torus of radii 2 and 0.7 in `ring.mesh`.
fn place() -> Place {
    let place = Place::new();
    write_mesh(&torus(2.0, 0.7, 0.3).unwrap().to_mesh(), &place.path().join("ring.mesh")).unwrap();
    place
}

fn mesh(place: &Place, name: &str) -> Mesh {
    medit::read(place.read(name).as_slice(), name).unwrap().mesh
}

fn solution(place: &Place, name: &str) -> SolutionValues {
    sol::read(place.read(name).as_slice(), name).unwrap().values
}

fn done(place: &Place, words: &str) -> String {
    let output = place.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(0), "{words}: {}", stderr(&output));
    stderr(&output)
}

/// Sizes at every vertex of the torus.
fn sizes(place: &Place, name: &str, size: &str) {
    let count = mesh(place, "ring.mesh").points.len();
    let kind = if size.contains(' ') { 3 } else { 1 };
    let rows = format!("{size}\n").repeat(count);
    place.put(name, format!("MeshVersionFormatted 2 Dimension 3 SolAtVertices {count} 1 {kind}\n{rows}"));
}

#[test]
fn mesh_and_sizes_come_out_next_to_the_surface() {
    let place = place();
    done(&place, "remesh ring -hausd 0.05 -hmax 0.5 -v 0 --report run.json");
    assert_eq!(place.files(), ["ring.mesh", "ring.o.mesh", "ring.o.sol", "run.json"]);
    let mesh = mesh(&place, "ring.o.mesh");
    let SolutionValues::Scalar(sizes) = solution(&place, "ring.o.sol") else { panic!("sizes") };
    assert_eq!(sizes.len(), mesh.points.len());
    // sqrt(3 * 0.05 * 0.7) asks for about 0.32 on the thin tube.
    assert!(sizes.iter().all(|h| (0.25..0.37).contains(h)), "{sizes:?}");
    let report: Value = serde_json::from_slice(&place.read("run.json")).unwrap();
    assert_eq!((report["valid"].as_bool(), report["euler"].as_i64()), (Some(true), Some(0)));
    assert!(report["fidelity"]["hausdorff"].as_f64().unwrap() <= 0.05);
    assert!(report["metric_edge_length"]["unit_fraction"].as_f64().unwrap() > 0.9);
    assert_eq!(report["options"]["hausd"].as_f64(), Some(0.05));
    assert_eq!(report["options"]["hmax"].as_f64(), Some(0.5));
}

#[test]
fn files_are_named_as_mmgs_names_them() {
    let place = place();
    for (words, out) in [
        ("ring.mesh fine", ["fine.mesh", "fine.sol"]),
        ("-in ring -out other.mesh", ["other.mesh", "other.sol"]),
        ("-in ring.mesh third.obj", ["third.obj", "third.sol"]),
        ("ring.mesh -o fourth", ["fourth.mesh", "fourth.sol"]),
    ] {
        done(&place, &format!("remesh {words} -hsiz 0.9 -hausd 1 -q"));
        assert!(out.iter().all(|name| place.files().contains(&(*name).into())), "{words}: {:?}", place.files());
    }
}

#[test]
fn metrics_are_given_or_found() {
    let place = place();
    let smallest = |name: &str| match solution(&place, name) {
        SolutionValues::Scalar(sizes) => sizes.into_iter().fold(f64::INFINITY, f64::min),
        _ => panic!("sizes"),
    };
    sizes(&place, "asked.sol", "0.6");
    done(&place, "remesh ring.mesh a.mesh -sol asked.sol -hausd 1 -q");
    assert!((smallest("a.sol") - 0.6).abs() < 1e-9);
    // The distance to the surface asks for less.
    done(&place, "remesh ring.mesh b.mesh -met asked.sol -hausd 0.05 -q");
    assert!(smallest("b.sol") < 0.37);
    // Next to the surface, by its name.
    sizes(&place, "ring.sol", "0.7");
    done(&place, "remesh ring.mesh c.mesh -hausd 1 -q");
    assert!((smallest("c.sol") - 0.7).abs() < 1e-9);
    // One size for all is told; it is not looked for.
    done(&place, "remesh ring.mesh d.mesh -hsiz 0.9 -hausd 2 -q");
    assert!((smallest("d.sol") - 0.9).abs() < 1e-9);
    sizes(&place, "thin.sol", "1 0 1 0 0 6");
    done(&place, "remesh ring.mesh e.mesh -sol thin.sol -hausd 1 -q");
    assert!(matches!(solution(&place, "e.sol"), SolutionValues::Tensor3(_)));
}

#[test]
fn other_options_of_mmgs_are_taken_with_a_warning() {
    let place = place();
    let said = done(
        &place,
        "remesh ring.mesh a.mesh -hsiz 0.9 -hausd 1 -noswap -xreg -rmc 0.1 -hgradreq -1 -m 4000 -v 0 -nofem",
    );
    for option in ["-noswap", "-xreg", "-rmc", "-hgradreq", "-nofem"] {
        assert!(said.contains(&format!("warning: {option} changes nothing: ")), "{option}: {said}");
    }
}

#[test]
fn what_is_wrong_is_said_and_nothing_is_written() {
    let place = place();
    place.put("short.sol", "MeshVersionFormatted 2 Dimension 3 SolAtVertices 1 1 1 0.5");
    let before = place.files();
    for (words, message) in [
        ("remesh", "required"),
        ("remesh none.mesh", "none.mesh"),
        ("remesh ring.mesh -ls 0.5", "not supported: remesh -ls"),
        ("remesh ring.mesh -wrong", "-w"),
        ("remesh ring.mesh a.mesh b.mesh", "b.mesh"),
        ("remesh ring.mesh -hausd", "hausd"),
        ("remesh ring.mesh -hausd 0", "hausd"),
        ("remesh ring.mesh -hmin 2 -hmax 1", "h_min = 2 is larger than h_max = 1"),
        ("remesh ring.mesh -hgrad 0.5", "hgrad = 0.5"),
        ("remesh ring.mesh -hsiz 1 -sol short.sol", "cannot be used with"),
        ("remesh ring.mesh -sol short.sol", "1 values for"),
        ("remesh ring.mesh a.vtk", "vtk"),
        ("remesh ring.mesh nowhere/a.mesh", "nowhere"),
        ("remesh ring.mesh -m 1 -hsiz 0.01", "limit exceeded"),
    ] {
        // mmg's code where it writes no mesh, and ours for wrong usage.
        let output = place.run(&words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(2), "{words}: {}", stderr(&output));
        assert!(stderr(&output).contains(message), "{words}: {}", stderr(&output));
    }
    assert_eq!(place.files(), before);
}
