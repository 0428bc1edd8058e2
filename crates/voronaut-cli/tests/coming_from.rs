//! Every command of ours in docs/coming-from.md runs.

use crate::common::{Place, stderr};
use voronaut::manifold::surface::torus;
use voronaut::mesh::Mesh;
use voronaut_io::write_mesh;

/// The files that the page speaks of.
fn place() -> Place {
    let place = Place::new();
    let points: Vec<[f64; 3]> = (0..121).map(|k| [f64::from(k % 11) / 10.0, f64::from(k / 11) / 10.0, 0.0]).collect();
    let cells = (0..100_u32).map(|k| k % 10 + k / 10 * 11);
    let triangles = cells.flat_map(|a| [[a, a + 1, a + 12], [a, a + 12, a + 11]]).collect();
    let values = |value: &dyn Fn(&[f64; 3]) -> String, kind: u32| {
        let text = format!("MeshVersionFormatted 2 Dimension 2 SolAtVertices 121 1 {kind}\n");
        points.iter().fold(text, |text, p| text + &value(p) + "\n")
    };
    place.put("in.sol", values(&|p| format!("{} 0 {}", 400.0 / (1.0 + p[0]), 100.0), 3));
    place.put("u.sol", values(&|p| (10.0 * (p[0] - p[1])).tanh().to_string(), 1));
    let mesh = Mesh { points: points.clone(), triangles, ..Mesh::default() };
    write_mesh(&mesh, &place.path().join("in.mesh")).unwrap();
    place.put("domain.geojson", r#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[0.8,0.9],[0.2,1],[0,0]]]}"#);
    let ring = torus(2.0, 0.7, 0.4).unwrap().to_mesh();
    write_mesh(&ring, &place.path().join("part.mesh")).unwrap();
    write_mesh(&ring, &place.path().join("part.obj")).unwrap();
    place
}

/// The words of a line; what is in quotes is one word.
fn words(line: &str) -> Vec<&str> {
    let parts = line.split('"').enumerate();
    parts.flat_map(|(i, part)| if i % 2 == 1 { vec![part] } else { part.split_whitespace().collect() }).collect()
}

#[test]
fn every_command_on_the_page_runs() {
    let page = include_str!("../../../docs/coming-from.md");
    let grey = page.split("```").skip(1).step_by(2).flat_map(str::lines);
    let commands: Vec<&str> = grey.filter(|line| line.starts_with("voronaut ")).collect();
    assert!(commands.len() > 10, "{commands:?}");
    let place = place();
    for command in commands {
        let output = place.run(&words(command)[1..]);
        assert_eq!(output.status.code(), Some(0), "{command}: {}", stderr(&output));
    }
    let made = place.files();
    assert!(made.len() > 20 && made.iter().all(|name| !place.read(name).is_empty()), "{made:?}");
}
