//! `dual --certify`, `--constants`, `--canvas-size certified` and `--show certificate`: said, reported, refused.

use crate::common::{Place, stderr};
use serde_json::Value;
use std::fmt::Write;

/// A triangular lattice with this spacing in the unit square.
fn lattice(spacing: f64) -> String {
    let mut text = String::new();
    for j in 0..200 {
        for i in -100..200 {
            let (x, y) = (
                spacing * (f64::from(i) + 0.5 * f64::from(j) + 0.31),
                spacing * 0.75_f64.sqrt() * (f64::from(j) + 0.4),
            );
            if x > 0.0 && x < 1.0 && y < 1.0 {
                writeln!(text, "{x} {y}").expect("a string takes all");
            }
        }
    }
    text
}

fn place() -> Place {
    let place = Place::new();
    place.put("seeds.txt", lattice(0.06));
    place
}

const DUAL: [&str; 8] = ["dual", "rect:0,0,1,1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "a.mesh"];

fn runs(place: &Place, more: &[&str]) -> (Value, String) {
    let output = place.run(&[&DUAL[..], more, &["--report", "a.json"]].concat());
    assert!(output.status.success(), "{more:?}: {}", stderr(&output));
    (serde_json::from_slice(&place.read("a.json")).unwrap(), String::from_utf8(output.stdout).unwrap())
}

fn outcome<'a>(report: &'a Value, theorem: &str) -> &'a Value {
    let verdicts = report["certificate"]["verdicts"].as_array().unwrap();
    &verdicts.iter().find(|verdict| verdict["theorem"] == theorem).unwrap()["outcome"]
}

#[test]
fn a_certificate_is_told_and_reported_only_where_it_is_wanted() {
    let place = place();
    let (plain, said) = runs(&place, &[]);
    assert!(plain.get("certificate").is_none() && !said.contains("9.10"));
    let (report, said) = runs(&place, &["--certify"]);
    for theorem in ["9.1", "9.9", "9.10", "9.4", "10.20", "11.2"] {
        assert_eq!(outcome(&report, theorem), "holds", "{theorem}: {said}");
        assert!(said.contains(&format!("  {theorem:<12} holds")), "{said}");
    }
    let found = &report["certificate"];
    let covered = found["covered"].as_u64().unwrap();
    assert!(
        covered > 0 && covered + found["border_not_covered"].as_u64().unwrap() == report["vertices"].as_u64().unwrap()
    );
    assert_eq!(found["cells"].as_array().unwrap().len() as u64, covered);
    assert!((found["mu"].as_f64().unwrap() - 0.06).abs() < 1e-8 && found["psi"] == 1.0, "{found}");
    assert_eq!((&found["walks"]["started"], &found["constants"]), (&found["walks"]["found"], &"corrected".into()));
    assert_eq!(report["options"]["certify"], true);
}

#[test]
fn printed_constants_differ_in_other_units() {
    let place = place();
    // Lengths are ten times as long, and the report's alpha ten times too large instead of too small.
    let scaled = ["--metric", "uniform:100,0,100", "--certify"];
    let with = |constants: &str| {
        let words = ["dual", "rect:0,0,1,1", "--seeds", "seeds.txt", "-o", "a.mesh", "--report", "a.json", "-q"];
        let output = place.run(&[&words[..], &scaled, &["--constants", constants]].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let report: Value = serde_json::from_slice(&place.read("a.json")).unwrap();
        let verdicts = report["certificate"]["verdicts"].as_array().unwrap().clone();
        verdicts.iter().find(|verdict| verdict["theorem"] == "9.9").unwrap()["factor"].as_f64().unwrap()
    };
    let [corrected, printed] = ["corrected", "printed"].map(with);
    assert!(printed < 0.05 * corrected, "{corrected} {printed}");
    let output = place.run(&[&DUAL[..], &["--constants", "other"]].concat());
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_certified_canvas_is_refused_by_its_estimate_or_by_the_seeds() {
    let place = place();
    let (report, _) = runs(&place, &["--canvas-size", "certified"]);
    assert_eq!((outcome(&report, "9.4"), &report["options"]["canvas_size"]), (&"holds".into(), &"certified".into()));
    let place = Place::new();
    place.put("seeds.txt", "0.2 0.2\n0.8 0.3\n0.5 0.9\n");
    let output = place.run(&[&DUAL[..], &["--canvas-size", "certified"]].concat());
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("no canvas is certified for these seeds"), "{}", stderr(&output));
    for bad in ["0", "exact", "-1"] {
        assert_eq!(place.run(&[&DUAL[..], &["--canvas-size", bad]].concat()).status.code(), Some(2), "{bad}");
    }
    assert_eq!(place.files(), ["seeds.txt"]);
}

#[test]
fn the_factors_are_drawn() {
    let place = place();
    let (report, _) = runs(&place, &["--show", "certificate", "--picture", "a.svg"]);
    assert!(report["certificate"]["covered"].as_u64().unwrap() > 0);
    let drawn = String::from_utf8(place.read("a.svg")).unwrap();
    runs(&place, &["--show", "cells", "--picture", "b.svg"]);
    assert!(drawn.starts_with("<svg") && drawn.contains("#d8d8d8") && drawn.as_bytes() != place.read("b.svg"));
}
