//! `voronaut dual --edges`: what the files hold, what is counted, what `--strict` refuses.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::fmt::Write as _;

const SHOCK: [&str; 6] = ["dual", "rect:-1,-1,1,1", "--metric", "shock:phi=1,lambda=0.6", "--canvas-size", "12"];
const COUNT: usize = 120;

/// A place with seeds whose dual does not embed with straight edges.
fn place() -> Place {
    let place = Place::new();
    let part = |i: usize, a: f64| 1.98 * ((0.5 + i as f64 * a) % 1.0) - 0.99;
    let mut text = String::new();
    for i in 1..=COUNT {
        let _ = writeln!(text, "{} {}", part(i, 0.754_877_666), part(i, 0.569_840_291));
    }
    place.put("seeds.txt", text);
    place
}

fn words<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [&SHOCK[..], &["--seeds", "seeds.txt"], more].concat()
}

fn report(place: &Place, name: &str) -> Value {
    serde_json::from_slice(&place.read(name)).expect("JSON")
}

#[test]
fn the_mesh_is_valid_and_begins_with_the_seeds() {
    let place = place();
    let more = ["-o", "a.mesh", "--edges", "geodesic", "--report", "a.json", "--strict"];
    let output = place.run(&words(&more));
    assert!(output.status.success(), "{}", stderr(&output));
    assert!(place.run(&["check", "a.mesh"]).status.success());
    let text = String::from_utf8(place.read("a.mesh")).expect("UTF-8");
    let seeds = String::from_utf8(place.read("seeds.txt")).expect("UTF-8");
    let vertices = text.lines().skip_while(|line| line.trim() != "Vertices").skip(2);
    let numbers = |line: &str| -> Vec<f64> { line.split_whitespace().take(2).map(|w| w.parse().expect("x")).collect() };
    for (vertex, seed) in vertices.zip(seeds.lines()) {
        assert_eq!(numbers(vertex), numbers(seed));
    }
    let dual = &report(&place, "a.json")["dual"];
    assert!(dual["crossing_edges"].as_u64() > Some(0), "{}", dual["crossing_edges"]);
    assert_eq!((dual["crossing_geodesics"].as_u64(), dual["open_regions"].as_u64()), (Some(0), Some(0)));
    let edges = dual["geodesic_edges"].as_array().expect("a list");
    assert!(edges.len() > 2 * COUNT);
    assert!(edges.iter().all(|edge| edge["length"].as_f64() > Some(0.0) && edge["edge"][1].is_u64()));
}

#[test]
fn straight_edges_that_cross_are_said_and_refused_when_strict() {
    let place = place();
    let output = place.run(&words(&["-o", "a.mesh", "--report", "a.json"]));
    assert!(output.status.success() && stderr(&output).contains("straight edges cross"), "{}", stderr(&output));
    let dual = &report(&place, "a.json")["dual"];
    assert!(dual["crossing_edges"].as_u64() > Some(0) && dual.get("crossing_geodesics").is_none());
    let output = place.run(&words(&["-o", "b.mesh", "--strict"]));
    assert_eq!(output.status.code(), Some(1), "{}", stderr(&output));
    assert_eq!(place.files(), ["a.json", "a.mesh", "seeds.txt"]);
}

#[test]
fn every_format_and_picture_is_written_whatever_the_threads() {
    let place = place();
    for (threads, out) in [("1", "one.vtu"), ("2", "two.vtu")] {
        let output = place.run(&words(&["-o", out, "--edges", "geodesic", "-q", "--threads", threads]));
        assert!(output.status.success() && output.stderr.is_empty(), "{}", stderr(&output));
    }
    assert!(place.read("one.vtu") == place.read("two.vtu"));
    let head = String::from_utf8_lossy(&place.read("one.vtu")).into_owned();
    assert!(["\"seeds\"", "\"length\"", "\"label\""].iter().all(|name| head.contains(name)));
    let more = ["-o", "a.obj", "--edges", "geodesic", "--picture", "a.svg", "--show", "cells,triangles", "-q"];
    assert!(place.run(&words(&more)).status.success());
    let lines = String::from_utf8(place.read("a.obj")).expect("UTF-8");
    assert!(lines.lines().any(|line| line.starts_with("l ")) && lines.lines().any(|line| line.starts_with("f ")));
    assert!(String::from_utf8(place.read("a.svg")).expect("UTF-8").ends_with("</svg>\n"));
}

#[test]
fn other_edges_are_wrong_usage() {
    let place = place();
    let output = place.run(&words(&["-o", "a.mesh", "--edges", "wavy"]));
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(place.files(), ["seeds.txt"]);
}
