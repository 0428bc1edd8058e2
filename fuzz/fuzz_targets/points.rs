//! Lists of points, of the plane and of space.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::points;
use voronaut_fuzz::{PLACE, read};

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    if let Some(found) = read(input, || points::read(text, PLACE)) {
        assert!(found.iter().all(|p| p.is_finite()));
        assert_eq!(found.len(), points::lines(text).len());
    }
    if let Some(found) = read(input, || points::read_in_space(text, PLACE)) {
        assert!(found.iter().all(|p| p.is_finite()));
    }
});
