//! `.off`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::{Fields, Format, off};
use voronaut_fuzz::{PLACE, assert_same, check_mesh, read, written};

fuzz_target!(|input: &[u8]| {
    let Some(mesh) = read(input, || off::read(input, PLACE)) else { return };
    check_mesh(&mesh);
    let file = written(|out| Format::Off.write(&mesh, &Fields::default(), out));
    assert_same(&off::read(file.as_slice(), PLACE).expect("its own file"), &mesh);
});
