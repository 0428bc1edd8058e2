//! `.geojson`: our files have a feature for each polygon.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::geojson;
use voronaut_fuzz::{PLACE, read, written};

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    let Some(mut polygons) = read(input, || geojson::read(text, PLACE)) else { return };
    for (polygon, feature) in polygons.polygons.iter_mut().zip(1..) {
        let rings = &polygon.rings;
        assert!(!rings.is_empty() && rings.iter().all(|ring| ring.points.len() >= 3));
        assert!(rings.iter().flat_map(|ring| &ring.points).all(|p| p.is_finite()));
        (polygon.feature, polygon.number) = (feature, 1);
    }
    let file = written(|out| geojson::write(&polygons, out));
    let text = std::str::from_utf8(&file).expect("text");
    assert_eq!(geojson::read(text, PLACE).expect("its own file"), polygons);
});
