//! Where the metric is not met: counted, explained, drawn, refused.

use crate::common::{Place, stderr};
use serde_json::Value;

fn stdout(place: &Place, words: &[&str]) -> String {
    let output = place.run(words);
    assert!(output.status.success(), "{words:?}: {}", stderr(&output));
    String::from_utf8(output.stdout).unwrap()
}

fn report(place: &Place, name: &str) -> Value {
    serde_json::from_slice(&place.read(name)).unwrap()
}

fn count(report: &Value, cause: &str) -> u64 {
    report["unmet"]["by_cause"][cause]["count"].as_u64().unwrap()
}

/// A square with a cut of 0.01 in one corner.
const CUT: &str = "5 2 0 0\n1 0 0\n2 10 0\n3 10 10\n4 0.01 10\n5 0 9.99\n5 0\n1 1 2\n2 2 3\n3 3 4\n4 4 5\n5 5 1\n0\n";

#[test]
fn a_tiny_edge_of_the_domain_is_the_boundary_s() {
    let place = Place::new();
    place.put("cut.poly", CUT);
    let words = ["mesh", "cut.poly", "--metric", "uniform", "-n", "150", "-o", "a.mesh", "--report", "a.json"];
    let says = stdout(&place, &words);
    let made = report(&place, "a.json");
    let found = &made["unmet"]["by_cause"]["boundary"];
    let worst = &found["worst"];
    assert!(found["short"].as_u64().unwrap() >= 1 && worst["length"].as_f64().unwrap() < 0.05, "{made:#}");
    assert!((worst["at"][0].as_f64().unwrap() - 0.005).abs() < 1e-9, "{worst}");
    assert!(says.contains("not met") && says.contains("% boundary") && says.contains(", boundary"), "{says}");
    // All the figures agree.
    let unmet = &made["unmet"];
    let causes = unmet["by_cause"].as_object().unwrap();
    assert_eq!(causes.keys().map(String::as_str).collect::<Vec<_>>(), ["boundary", "count", "irregular", "turning"]);
    assert_eq!(causes.keys().map(|cause| count(&made, cause)).sum::<u64>(), unmet["edges"].as_u64().unwrap());
    for found in causes.values() {
        let [all, short, long] = ["count", "short", "long"].map(|key| found[key].as_u64().unwrap());
        assert_eq!((all, all == 0), (short + long, found["worst"].is_null()));
    }
    let unit = made["metric_edge_length"]["unit_fraction"].as_f64().unwrap();
    assert!((unmet["share"].as_f64().unwrap() - (1.0 - unit)).abs() < 1e-12);
}

#[test]
fn a_metric_four_times_as_dense_asks_for_more_vertices() {
    let place = Place::new();
    let mesh = ["mesh", "rect:-1,-1,1,1", "--metric", "shock:phi=1", "-n", "600", "-o", "a.mesh", "--report", "a.json"];
    stdout(&place, &mesh);
    let made = report(&place, "a.json");
    let scale = made["metric_scale"].as_f64().unwrap();
    let check = |factor: f64| {
        let scale = (factor * scale).to_string();
        let words = ["check", "a.mesh", "--metric", "shock:phi=1", "--metric-scale", &scale, "--report", "b.json"];
        (stdout(&place, &words), report(&place, "b.json"))
    };
    assert_eq!(check(1.0).1["unmet"], made["unmet"]);
    let (says, found) = check(4.0);
    let by_count = &found["unmet"]["by_cause"]["count"];
    assert!(by_count["share"].as_f64().unwrap() > 0.9 && by_count["short"] == 0, "{:#}", found["unmet"]);
    assert!(says.contains("% count"), "{says}");
    // And one four times as sparse for fewer.
    let by_count = &check(0.25).1["unmet"]["by_cause"]["count"];
    assert!(by_count["share"].as_f64().unwrap() > 0.9 && by_count["long"] == 0, "{by_count:#}");
}

#[test]
fn a_hard_shock_turns_too_fast_for_straight_edges() {
    let place = Place::new();
    let shock = ["mesh", "rect:-1,-1,1,1", "--metric", "shock:phi=10,lambda=0.06", "-n", "1000", "-o", "a.mesh"];
    let says = stdout(&place, &[&shock[..], &["--report", "a.json"]].concat());
    let made = report(&place, "a.json");
    let all = made["unmet"]["edges"].as_u64().unwrap();
    assert!(all > 500 && 10 * count(&made, "turning") > 9 * all, "{:#}", made["unmet"]);
    assert!(says.contains("% turning metric"), "{says}");
}

#[test]
fn edges_are_drawn_by_cause_with_a_legend() {
    let place = Place::new();
    place.put("cut.poly", CUT);
    let mesh = ["mesh", "cut.poly", "--metric", "uniform", "-n", "150", "-o", "a.mesh", "-q", "--report", "a.json"];
    stdout(&place, &[&mesh[..], &["--picture", "a.svg", "--show", "unmet"]].concat());
    let scale = report(&place, "a.json")["metric_scale"].to_string();
    let check = ["check", "a.mesh", "--metric", "uniform", "--metric-scale", &scale, "-q"];
    stdout(&place, &[&check[..], &["--picture", "b.svg", "--show", "unmet"]].concat());
    stdout(&place, &[&check[..], &["--picture", "plain.svg"]].concat());
    stdout(&place, &[&check[..], &["--picture", "b.png", "--show", "unmet"]].concat());
    let [a, b, plain] = ["a.svg", "b.svg", "plain.svg"].map(|name| String::from_utf8(place.read(name)).unwrap());
    assert_eq!(a, b);
    let height =
        |text: &str| text.split("height=\"").nth(1).unwrap().split('"').next().unwrap().parse::<f64>().unwrap();
    assert!(height(&a) > height(&plain) + 50.0 && a.contains("stroke-opacity=\"0.3\""));
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let place = Place::new();
    place.put("seeds.txt", "0.1 0.1\n0.9 0.2\n0.5 0.8\n");
    stdout(&place, &["mesh", "rect:0,0,1,1", "--metric", "uniform", "-n", "20", "-o", "a.mesh", "-q"]);
    let before = place.files();
    let picture = ["--picture", "a.svg", "--show", "unmet"];
    let dual = ["dual", "rect:0,0,1,1", "--metric", "uniform", "--seeds", "seeds.txt", "-o", "d.mesh"];
    for (words, says) in [
        (&["check", "a.mesh"][..], "give the --metric"),
        (&dual, "voronaut check"),
        (&["mesh", "sphere:1", "--metric", "uniform", "-n", "50", "-o", "s.mesh", "--show", "cells"], "on a surface"),
    ] {
        let output = place.run(&[words, &picture].concat());
        assert_eq!(output.status.code(), Some(1), "{words:?}");
        assert!(stderr(&output).contains(says), "{words:?}: {}", stderr(&output));
    }
    assert_eq!(place.files(), before);
}

#[test]
fn surfaces_have_causes_too() {
    let place = Place::new();
    stdout(&place, &["mesh", "sphere:1", "--metric", "uniform", "-n", "200", "-o", "s.mesh", "--report", "s.json"]);
    let made = report(&place, "s.json");
    let scale = (4.0 * made["metric_scale"].as_f64().unwrap()).to_string();
    let check = ["check", "s.mesh", "--domain", "sphere:1", "--metric", "uniform", "--metric-scale", &scale];
    stdout(&place, &[&check[..], &["--report", "c.json", "-q"]].concat());
    let found = report(&place, "c.json");
    assert!(found["unmet"]["by_cause"]["count"]["share"].as_f64().unwrap() > 0.9, "{:#}", found["unmet"]);
    assert_eq!(found["unmet"]["by_cause"]["count"]["worst"]["at"].as_array().unwrap().len(), 3);
    // Their colours, and a legend under the picture.
    let pictures = ["--picture", "a.svg", "--pixels", "200", "-q"];
    stdout(&place, &[&check[..], &pictures].concat());
    stdout(&place, &[&check[..], &["--show", "unmet", "--picture", "b.svg", "--pixels", "200", "-q"]].concat());
    let [plain, shown] = ["a.svg", "b.svg"].map(|name| String::from_utf8(place.read(name)).unwrap());
    let height =
        |text: &str| text.split("height=\"").nth(1).unwrap().split('"').next().unwrap().parse::<f64>().unwrap();
    assert!(height(&shown) > height(&plain) + 10.0 && shown.matches("<path").count() > plain.matches("<path").count());
}

/// N sqrt(3) / 2 over the complexity, which is the area of the metric: where straight edges cannot honour a metric the factor that is met
/// is less, and unit edges are fewer at what N asks for.
#[test]
fn unit_edges_are_told_at_the_factor_that_n_asks_for() {
    let place = Place::new();
    let made = |domain: &str, metric: &str, name: &str| {
        let words = ["mesh", domain, "--metric", metric, "-n", "400", "-o", name, "--report", "a.json"];
        let says = stdout(&place, &words);
        let made = report(&place, "a.json");
        let [scale, share] = ["metric_scale", "unit_fraction"].map(|key| made["closed_form"][key].as_f64().unwrap());
        assert!(says.contains(&format!("{:.1} % at the metric scale that N asks for", 100.0 * share)), "{says}");
        (scale, share, made)
    };
    let area = 4.0 * std::f64::consts::PI;
    for (domain, metric, name, complexity) in
        [("rect:0,0,2,1", "uniform:9,0,4", "a.mesh", 12.0), ("sphere:1", "uniform", "s.mesh", area)]
    {
        let (scale, share, _) = made(domain, metric, name);
        let asked = 400.0 * 0.75_f64.sqrt() / complexity;
        assert!((scale / asked - 1.0).abs() < 0.015 && share > 0.9, "{domain}: {scale} {asked} {share}");
    }
    let (scale, share, swirl) = made("rect:-2,-2,2,2", "swirl", "w.mesh");
    assert!(swirl["metric_scale"].as_f64().unwrap() < 0.95 * scale, "{swirl:#}");
    assert!(share < swirl["metric_edge_length"]["unit_fraction"].as_f64().unwrap(), "{share}");
    // Without a number nothing is asked for.
    stdout(&place, &["mesh", "rect:0,0,2,1", "--metric", "uniform:90,0,90", "-o", "b.mesh", "--report", "b.json"]);
    assert!(report(&place, "b.json").get("closed_form").is_none());
}
