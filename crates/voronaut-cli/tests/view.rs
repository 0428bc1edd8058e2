//! `voronaut view`, and `--view` of other commands: one file that needs no other.

use crate::common::{Place, stderr};
use serde_json::Value;

fn runs(place: &Place, words: &[&str]) {
    let output = place.run(words);
    assert!(output.status.success(), "{words:?}: {}", stderr(&output));
}

fn page(place: &Place, name: &str) -> String {
    String::from_utf8(place.read(name)).unwrap()
}

/// What the page says of its meshes.
fn description(page: &str) -> Value {
    let (_, rest) = page.split_once("id=\"description\">").expect("a description");
    serde_json::from_str(rest.split_once("</script>").expect("an end").0).expect("JSON")
}

const DISK: [&str; 8] = ["mesh", "disk:0,0,1", "--metric", "uniform", "-n", "60", "-o", "a.mesh"];

#[test]
fn meshes_and_duals_have_pages_with_cells_and_geodesics() {
    let place = Place::new();
    runs(&place, &[&DISK[..], &["--view", "a.html", "--cells", "-q"]].concat());
    let told = description(&page(&place, "a.html"));
    let mesh = &told["meshes"][0];
    assert_eq!((mesh["name"].as_str(), mesh["vertices"].as_u64()), (Some("a"), Some(60)));
    let names: Vec<&str> =
        mesh["fields"].as_array().unwrap().iter().filter_map(|field| field["name"].as_str()).collect();
    assert_eq!(names, ["quality", "smallest angle", "length", "cause"]);
    assert!(
        mesh["canvas"]["triangles"].as_u64() > Some(2000) && mesh["curves"]["counts"]["count"].as_u64() > Some(100)
    );

    runs(
        &place,
        &["mesh", "sphere:1", "--metric", "curvature", "-n", "80", "-o", "s.mesh", "--view", "s.html", "--cells", "-q"],
    );
    let told = description(&page(&place, "s.html"));
    let mesh = &told["meshes"][0];
    assert_eq!((mesh["planar"].as_bool(), mesh["tensors"].as_array().map(Vec::len)), (Some(false), Some(6)));
    assert!(mesh["canvas"]["triangles"].as_u64() > Some(2000));

    place.put("seeds.txt", "0 0\n0.5 0.1\n0.1 0.6\n-0.4 0.2\n-0.1 -0.5\n");
    let dual = ["dual", "disk:0,0,1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "d.mesh"];
    runs(&place, &[&dual[..], &["--view", "d.html", "--cells", "-q"]].concat());
    assert_eq!(description(&page(&place, "d.html"))["meshes"][0]["vertices"], 5);
}

#[test]
fn any_meshes_and_their_fields_are_viewed() {
    let place = Place::new();
    runs(&place, &[&DISK[..], &["-q"]].concat());
    place.put(
        "u.sol",
        format!("MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n60\n1 1\n{}End\n", "0.5\n".repeat(60)),
    );
    runs(&place, &["view", "a.mesh", "--sol", "u.sol", "-o", "u.html", "--title", "A & <B>", "-q"]);
    let text = page(&place, "u.html");
    assert!(text.contains("<title>A &amp; &lt;B></title>"));
    assert_eq!(description(&text)["meshes"][0]["fields"][0]["name"], "solution");

    let metric = ["--metric", "swirl", "--metric-scale", "3", "--report", "r.json", "-q"];
    runs(&place, &[&["view", "a.mesh", "a.mesh", "-o", "two.html"], &metric[..]].concat());
    let text = page(&place, "two.html");
    assert_eq!(description(&text)["meshes"].as_array().map(Vec::len), Some(2));
    let report: Value = serde_json::from_slice(&place.read("r.json")).unwrap();
    assert_eq!(report["bytes"].as_u64(), Some(text.len() as u64));
}

#[test]
fn what_cannot_be_viewed_is_refused_and_leaves_no_page() {
    let place = Place::new();
    runs(&place, &[&DISK[..], &["-q"]].concat());
    place.put("u.sol", "MeshVersionFormatted 2\nDimension 2\nSolAtVertices\n1\n1 1\n0.5\nEnd\n");
    place.put("points.mesh", "MeshVersionFormatted 2\nDimension 2\nVertices\n1\n0 0 0\nEnd\n");
    for (words, expected) in [
        (&["view", "a.mesh", "-o", "a.png"][..], "does not end like a page"),
        (&["view", "none.mesh", "-o", "p.html"], "none.mesh"),
        (&["view", "points.mesh", "-o", "p.html"], "no triangles"),
        (&["view", "a.mesh", "--sol", "u.sol", "-o", "p.html"], "1 values, and the mesh has 60 vertices"),
        (&["view", "a.mesh", "a.mesh", "--sol", "u.sol", "-o", "p.html"], "--sol with several meshes"),
        (&["view", "a.mesh", "-o", "p.html", "--report", "p.html"], "two outputs have the same name"),
        (&["view", "a.mesh", "-o", "nowhere/p.html"], "nowhere"),
        (&["mesh", "disk:0,0,1", "--metric", "uniform", "-o", "b.mesh", "--view", "b.svg"], "does not end like a page"),
    ] {
        let output = place.run(words);
        assert_eq!(output.status.code(), Some(1), "{words:?}");
        assert!(stderr(&output).contains(expected), "{words:?}: {}", stderr(&output));
    }
    assert_eq!(place.run(&["view", "a.mesh", "-o", "p.html", "--cells"]).status.code(), Some(2), "cells take a metric");
    assert_eq!(place.files(), ["a.mesh", "points.mesh", "u.sol"]);
}
