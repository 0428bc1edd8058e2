//! Lists of points, of the plane and of space.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::points;
use voronaut_fuzz::{PLACE, read};

fuzz_target!(|input: &[u8]| {
    let Ok(text) = std::str::from_utf8(input) else { return };
    if let Some(found) = read(input, || points::read::<2>(text, PLACE)) {
        assert!(found.iter().flat_map(|(_, p)| p).all(|x| x.is_finite()));
        assert!(found.is_sorted_by(|(a, _), (b, _)| a < b));
    }
    if let Some(found) = read(input, || points::read::<3>(text, PLACE)) {
        assert!(found.iter().flat_map(|(_, p)| p).all(|x| x.is_finite()));
    }
});
