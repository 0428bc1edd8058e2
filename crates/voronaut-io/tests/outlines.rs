//! Graphs as outlines, through both formats.

use voronaut::geometry::signed_area;
use voronaut::manifold::domain::{Domain, Pslg, from_poly, from_polygons, to_poly, to_polygons};
use voronaut_io::{geojson, poly};

/// A square of region 4 with a hole, in which an island of region 5 lies; the left of the square is region 6.
const TEXT: &str = "12 2 0 1\n1 0 0 7\n2 4 0 0\n3 4 4 0\n4 0 4 0\n5 2 1 0\n6 3 1 0\n7 3 3 0\n8 2 3 0\n9 2.4 1.4 0\n\
                    10 2.8 1.4 0\n11 2.6 2 0\n12 1 0 -2\n13 0\n";

fn graph() -> Pslg {
    let points = TEXT.replace("12 2 0 1\n", "13 2 0 1\n").replace("13 0\n", "13 1 4 0\n");
    let segments = "15 1\n1 1 12 3\n2 12 2 3\n3 2 3 3\n4 3 13 3\n5 13 4 3\n6 4 1 8\n7 5 6 9\n8 6 7 9\n9 7 8 9\n10 8 5 9\n\
                    11 9 10 2\n12 10 11 2\n13 11 9 2\n14 12 13 1\n15 1 12 3\n1\n1 2.1 1.1\n3\n1 3.5 3.5 4\n2 2.6 1.5 5\n3 0.1 0.1 6\n";
    from_poly(&poly::read(format!("{points}{segments}").as_bytes(), "a.poly").unwrap()).unwrap()
}

fn areas(domain: &Domain) -> Vec<(i32, f64)> {
    let topology = &domain.planar().topology;
    [4, 5, 6]
        .map(|label| {
            let faces = topology.faces().filter(|&f| topology.region(f) == label);
            (label, faces.map(|f| domain.planar().triangle(f)).map(|[a, b, c]| signed_area(a, b, c)).sum())
        })
        .to_vec()
}

#[test]
fn a_graph_survives_both_formats() {
    let pslg = graph();
    let truth = areas(&Domain::new(&pslg).unwrap());
    let found = to_poly(&pslg).unwrap();
    assert_eq!((found.holes.len(), found.regions.len()), (1, 3));
    let mut text = Vec::new();
    poly::write(&found, &mut text).unwrap();
    let again = from_poly(&poly::read(text.as_slice(), "b.poly").unwrap()).unwrap();
    assert_eq!(areas(&Domain::new(&again).unwrap()), truth);
    assert_eq!((&again.points, &again.point_labels), (&pslg.points, &pslg.point_labels));
    let labels = |pslg: &Pslg| pslg.segments.iter().map(|s| (s.ends, s.label)).collect::<Vec<_>>();
    assert_eq!(labels(&again), labels(&pslg));

    let found = to_polygons(&pslg).unwrap();
    let mut text = Vec::new();
    geojson::write(&found, &mut text).unwrap();
    let read = geojson::read(std::str::from_utf8(&text).unwrap(), "b.json").unwrap();
    assert_eq!(read, found);
    let rings: Vec<_> = read.polygons.iter().map(|p| (p.region, p.rings.len(), p.rings[0].label)).collect();
    assert_eq!(rings.len(), 3);
    assert!(rings.contains(&(4, 2, 3)) && rings.contains(&(5, 1, 2)), "{rings:?}");
    let domain = Domain::new(&from_polygons(&read).unwrap()).unwrap();
    for ((label, found), (_, truth)) in areas(&domain).into_iter().zip(truth) {
        assert!((found - truth).abs() < 1e-12, "{label}: {found} {truth}");
    }
}

#[test]
fn a_hole_that_touches_the_outline_is_a_ring_of_its_own() {
    let text = "7 2 0 0\n1 0 0\n2 4 0\n3 4 4\n4 0 4\n5 2 1\n6 3 2\n7 1 2\n8 0\n";
    let touching = text.replace("5 2 1", "5 2 0.5").replace("8 0\n", "");
    let segments = "7 0\n1 1 2\n2 2 3\n3 3 4\n4 4 1\n5 1 6\n6 6 7\n7 7 1\n1\n1 1.3 1.5\n";
    let pslg = from_poly(&poly::read(format!("{touching}{segments}").as_bytes(), "a.poly").unwrap()).unwrap();
    let found = to_polygons(&pslg).unwrap();
    assert_eq!(found.polygons.len(), 1);
    assert_eq!(found.polygons[0].rings.iter().map(|ring| ring.points.len()).collect::<Vec<_>>(), [4, 3]);
}
