//! `.poly`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::poly;
use voronaut_fuzz::{PLACE, read, written};

fuzz_target!(|input: &[u8]| {
    let Some(poly) = read(input, || poly::read(input, PLACE)) else { return };
    let counts = [poly.points.len(), poly.segments.len()];
    assert_eq!(counts, [poly.point_markers.len(), poly.segment_markers.len()]);
    assert!(poly.segments.as_flattened().iter().all(|&v| (v as usize) < counts[0]));
    let places = poly.points.iter().chain(&poly.holes).chain(poly.regions.iter().map(|region| &region.point));
    assert!(places.into_iter().all(|p| p.is_finite()));
    let file = written(|out| poly::write(&poly, out));
    assert_eq!(poly::read(file.as_slice(), PLACE).expect("its own file"), poly);
});
