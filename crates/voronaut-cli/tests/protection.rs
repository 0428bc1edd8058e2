//! `--seeding protected`, `--protection`, `--picking-radius`, `--net` and `--show protection`: done, reported, refused.

use crate::common::{Place, stderr};
use serde_json::Value;

const SQUARE: [&str; 8] = ["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "200", "-o", "a.mesh"];

fn runs(place: &Place, words: &[&str]) -> Value {
    let output = place.run(&[words, &["--report", "a.json", "-q"]].concat());
    assert!(output.status.success(), "{words:?}: {}", stderr(&output));
    serde_json::from_slice(&place.read("a.json")).unwrap()
}

#[test]
fn protected_meshes_say_how_protected_they_are() {
    let place = Place::new();
    for lloyd in ["0", "40"] {
        let made =
            runs(&place, &[&SQUARE[..], &["--seeding", "protected", "--lloyd", lloyd, "--canvas-size", "20"]].concat());
        let (net, protection) = (&made["net"], &made["protection"]);
        assert_eq!(made["vertices"], 200);
        assert!(net["delta_over_epsilon"].as_f64().unwrap() >= 0.2, "{net}");
        assert!(net["border_delta_over_epsilon"].as_f64().unwrap() >= 0.2, "{net}");
        assert_eq!((&net["unmeasured"], &net["by_canvas"]), (&0.into(), &0.into()));
        assert_eq!((&protection["ending"], &protection["unprotected"]), (&"protected".into(), &0.into()));
        let nerve = &protection["raw_nerve"];
        assert_eq!((&nerve["missing"], &nerve["extra"], &nerve["triangles"]), (&0.into(), &0.into(), &net["interior"]));
        assert!(nerve["canvas_vertices"].as_u64().unwrap() > 200 * 20);
    }
}

#[test]
fn what_is_asked_for_is_in_the_report() {
    let place = Place::new();
    let more = [
        "--seeding",
        "protected",
        "--canvas-size",
        "5",
        "--lloyd",
        "0",
        "--protection",
        "0.1",
        "--picking-radius",
        "0.2",
    ];
    let made = runs(&place, &[&SQUARE[..], &more].concat());
    assert_eq!((&made["protection"]["asked"], &made["options"]["picking_radius"]), (&0.1.into(), &0.2.into()));
    assert_eq!(made["options"]["seeding"], "protected");
}

#[test]
fn a_net_is_measured_only_where_it_is_wanted() {
    let place = Place::new();
    let plain = runs(&place, &SQUARE);
    assert!(plain["net"].is_null() && plain["protection"].is_null());
    let measured = runs(&place, &[&SQUARE[..], &["--net"]].concat());
    assert!(measured["protection"].is_null());
    let [epsilon, mu, lambda] = ["epsilon", "mu", "lambda"].map(|key| measured["net"][key].as_f64().unwrap());
    assert!(epsilon > 0.5 && epsilon < 1.1 && mu > 0.3 && (lambda - mu / epsilon).abs() < 1e-9, "{epsilon} {mu}");

    place.put("seeds.txt", "0.2 0.2\n0.8 0.3\n0.5 0.9\n");
    let dual = ["dual", "rect:0,0,1,1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "d.mesh"];
    assert!(runs(&place, &dual)["net"].is_null());
    let net = &runs(&place, &[&dual[..], &["--net"]].concat())["net"];
    // Farthest is (0, 0.7), where the cells of the first and the third seed meet on the border; canvas vertices there are
    // 0.003 apart.
    assert!((net["epsilon"].as_f64().unwrap() - 0.29_f64.sqrt()).abs() < 1.5e-3, "{net}");
    assert!((net["mu"].as_f64().unwrap() - 0.37_f64.sqrt()).abs() < 1e-6, "{net}");
}

#[test]
fn protection_is_drawn() {
    let place = Place::new();
    let made = runs(&place, &[&SQUARE[..], &["--show", "protection", "--picture", "a.svg"]].concat());
    assert!(made["net"]["interior"].as_u64().unwrap() > 200);
    let text = String::from_utf8(place.read("a.svg")).unwrap();
    assert!(text.starts_with("<svg") && text.ends_with("</svg>\n"));
    let plain = runs(&place, &[&SQUARE[..], &["--picture", "b.svg"]].concat());
    assert!(plain["net"].is_null() && place.read("b.svg") != place.read("a.svg"));
}

#[test]
fn shares_that_are_none_are_refused() {
    let place = Place::new();
    for (more, says) in [
        (["--protection", "-0.1"], "-0.1"),
        (["--protection", "much"], "invalid value 'much'"),
        (["--picking-radius", "-1"], "-1"),
        (["--picking-radius", "nan"], "nan"),
        (["--seeding", "guarded"], "invalid value 'guarded'"),
    ] {
        let output = place.run(&[&SQUARE[..], &more].concat());
        assert_eq!(output.status.code(), Some(2), "{more:?}: {}", stderr(&output));
        assert!(stderr(&output).contains(says), "{more:?}: {}", stderr(&output));
    }
    assert!(place.files().is_empty());
}
