//! Questions as a page asks them, of the library as it is natively.

use crate::{Desk, Window};
use serde_json::{Value, json};
use std::sync::Mutex;

/// What a page would see.
#[derive(Default)]
struct Seen {
    stages: Mutex<Vec<String>>,
    triangles: Mutex<Vec<usize>>,
    clock: Mutex<f64>,
}

impl Window for Seen {
    /// A second for each look.
    fn seconds(&self) -> f64 {
        let mut clock = self.clock.lock().unwrap();
        *clock += 1.0;
        *clock
    }

    fn stage(&self, name: &str, _total: u64) {
        self.stages.lock().unwrap().push(name.into());
    }

    fn done(&self, _units: u64) {}

    fn sketch(&self, points: &[[f64; 3]], triangles: &[[u32; 3]]) {
        assert!(triangles.as_flattened().iter().all(|&v| (v as usize) < points.len()));
        self.triangles.lock().unwrap().push(triangles.len());
    }
}

/// An answer: what it tells, and its bytes.
fn ask(desk: &mut Desk, question: &Value, bytes: &[u8], window: &Seen) -> (Value, Vec<u8>) {
    let text = question.to_string();
    let asked = [&(text.len() as u32).to_le_bytes(), text.as_bytes(), bytes].concat();
    let answer = desk.asked(&asked, window);
    let (length, rest) = answer.split_first_chunk().unwrap();
    let (text, bytes) = rest.split_at(u32::from_le_bytes(*length) as usize);
    assert_eq!((4 + text.len()) % 8, 0, "numbers are read in place");
    (serde_json::from_slice(text).unwrap(), bytes.to_vec())
}

fn mesh(domain: &str, metric: &str) -> Value {
    let options = [
        ("domain", domain),
        ("metric", metric),
        ("vertices", "300"),
        ("out", "a.mesh"),
        ("view", "a.html"),
        ("memory_limit", "3"),
    ];
    json!({ "do": "perform", "command": "mesh", "options": options.map(|(name, value)| (name, [value])) })
}

const SQUARE: &[u8] = b"4 2 0 0\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n4 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n0\n";

#[test]
fn a_file_is_seen_meshed_and_written() {
    let (mut desk, seen) = (Desk::default(), Seen::default());
    let (told, _) = ask(&mut desk, &json!({ "do": "hold", "name": "square.poly" }), SQUARE, &seen);
    assert_eq!(told, json!({}));
    let (told, _) = ask(&mut desk, &json!({ "do": "look", "domain": "square.poly" }), &[], &seen);
    assert_eq!([&told["planar"], &told["segments"]["bytes"]], [&json!(true), &json!(32)]);
    let (told, bytes) = ask(&mut desk, &mesh("square.poly", "uniform"), &[], &seen);
    assert_eq!([&told["report"]["vertices"], &told["report"]["valid"]], [&json!(300), &json!(true)], "{told}");
    let part = |name: &str| ["at", "bytes"].map(|key| told[name][key].as_u64().unwrap() as usize);
    let [at, length] = part("page");
    assert!(String::from_utf8_lossy(&bytes[at..at + length]).contains("<script type=\"application/json\""));
    let triangles = part("triangles")[1] / 12;
    assert_eq!(told["report"]["triangles"], triangles);
    for stage in ["planning", "seeding", "relaxing", "settling edges", "checking"] {
        assert!(seen.stages.lock().unwrap().iter().any(|it| it == stage), "{stage}");
    }
    let sketches = seen.triangles.lock().unwrap();
    assert!(sketches.len() > 3 && sketches.last() == Some(&triangles), "{sketches:?}");
    let (_, file) = ask(&mut desk, &json!({ "do": "write", "name": "a.mesh" }), &[], &Seen::default());
    assert!(file.starts_with(b"MeshVersionFormatted"));
}

#[test]
fn faults_are_the_program_s() {
    let (mut desk, seen) = (Desk::default(), Seen::default());
    let mut fault = |question: &Value, bytes: &[u8]| ask(&mut desk, question, bytes, &seen).0["fault"].clone();
    let formula = fault(&mesh("rect:0,0,1,1", "formula:1/(x; 0; 1"), &[]);
    assert_eq!([&formula["kind"], &formula["place"]], ["text", "formula m11, column 5"]);
    let metric = fault(&mesh("rect:0,0,1,1", "formula:x - 2; 0; 1"), &[]);
    assert_eq!(metric["kind"], "metric");
    let broken = fault(&json!({ "do": "hold", "name": "a.mesh" }), b"MeshVersionFormatted 2\nDimension x\n");
    assert!(broken["place"].as_str().unwrap().starts_with("a.mesh:2"), "{broken}");
    let usage = fault(&json!({ "do": "perform", "command": "mesh", "options": [["vertices", ["2"]]] }), &[]);
    assert_eq!(usage["kind"], "usage");
    assert_eq!(fault(&json!({ "do": "write", "name": "a.mesh" }), &[])["what"], "a.mesh: there is no mesh yet");
    assert_eq!(fault(&json!({ "do": "dance" }), &[])["place"], "question");
}

#[test]
fn seeds_have_cells_and_ways_a_length() {
    let (mut desk, seen) = (Desk::default(), Seen::default());
    let options = |more: &[(&str, &str)]| -> Vec<(String, Vec<String>)> {
        let all = [("domain", "rect:0,0,1,1"), ("metric", "uniform"), ("canvas_size", "400")];
        all.iter().chain(more).map(|&(name, value)| (name.into(), vec![value.into()])).collect()
    };
    let mut given = options(&[("seeds", "seeds"), ("out", "a.mesh"), ("view", "a.html")]);
    given.push(("cells".into(), vec![]));
    let seeds = [[0.2, 0.2], [0.8, 0.3], [0.4, 0.8]];
    let question = json!({ "do": "perform", "command": "dual", "options": given, "seeds": seeds });
    let (told, bytes) = ask(&mut desk, &question, &[], &seen);
    assert_eq!(told["report"]["triangles"], 1, "{told}");
    assert!(String::from_utf8_lossy(&bytes).contains("\"canvas\""));
    let given = options(&[("from", "0.1,0.5"), ("to", "0.9,0.5"), ("out", "a.vtu")]);
    let (told, _) = ask(&mut desk, &json!({ "do": "perform", "command": "distance", "options": given }), &[], &seen);
    assert!((told["report"]["distance"].as_f64().unwrap() - 0.8).abs() < 1e-3, "{told}");
    assert!(told["path"]["bytes"].as_u64().unwrap() >= 48);
}
