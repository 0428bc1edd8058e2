//! Domains from Triangle's files.

use voronaut::Result;
use voronaut::geometry::Point;
use voronaut::manifold::domain::{Filling, Pslg, from_poly};
use voronaut_io::poly;

fn pslg(text: &str) -> Result<Pslg> {
    from_poly(&poly::read(text.as_bytes(), "a.poly")?)
}

#[test]
fn holes_regions_and_isolated_points() {
    let text = "4 2 0 1\n0 0 0 1\n1 1 0 2\n2 .1 .1 3\n3 0 1 4\n4 1\n0 0 1 5\n1 1 3 5\n2 3 0 6\n3 0 3 6\n1\n1 .2 .2\n1\n1 .3 .3 8\n";
    let pslg = pslg(text).unwrap();
    assert_eq!(pslg.segments.len(), 3, "the last segment repeats the third");
    assert_eq!(pslg.required_points, [2]);
    assert_eq!(pslg.point_labels, [1, 2, 3, 4]);
    assert_eq!(pslg.points[3], Point::new(0.0, 1.0));
    let holes = vec![Point::new(0.2, 0.2)];
    assert_eq!(pslg.filling, Filling::Enclosed { holes, regions: vec![(Point::new(0.3, 0.3), 8)] });
}

#[test]
fn errors_name_vertices_and_segments() {
    let square = "4\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n";
    for (text, expected) in [
        ("2\n0 0 0\n1 -0 0\n1\n0 0 1\n".into(), "vertex 0 and vertex 1 have the same coordinates at (-0, 0)"),
        (
            format!("{square}1\n1 2 2\n"),
            "segment 1 has no length: both its ends are the same vertex at vertex 2 (1, 0)",
        ),
        (
            format!("{square}2 1\n1 1 2 3\n2 2 1 4\n"),
            "segments 1 and 2 join the same vertices with different labels 3 and 4 at vertex 2 (1, 0) - vertex 1 (0, 0)",
        ),
        (format!("{square}0\n"), "a .poly file without segments"),
        (format!("{square}1\n1 1 2\n0\n1\n1 .5 .25 1.5\n"), "the regional attribute 1.5 is no label at (0.5, 0.25)"),
    ] {
        let error = pslg(&text).unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
        assert!(!error.help().is_empty());
    }
}
