//! `.stl`: coordinates in single precision, vertices joined by them.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::{Fields, Format, stl};
use voronaut_fuzz::{PLACE, assert_same, check_mesh, read, written};

fuzz_target!(|input: &[u8]| {
    let Some(mesh) = read(input, || stl::read(input, PLACE)) else { return };
    check_mesh(&mesh);
    if mesh.points.as_flattened().iter().any(|&x| !(x as f32).is_finite()) {
        return;
    }
    let again = |mesh| stl::read(written(|out| Format::Stl.write(mesh, &Fields::default(), out)).as_slice(), PLACE).expect("its own file");
    let rounded = again(&mesh);
    check_mesh(&rounded);
    assert_eq!(rounded.triangles.len(), mesh.triangles.len());
    // Once rounded nothing changes any more.
    assert_same(&again(&rounded), &rounded);
});
