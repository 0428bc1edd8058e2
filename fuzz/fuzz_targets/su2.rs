//! `.su2`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_fuzz::{PLACE, check_mesh, read, written};
use voronaut_io::{Fields, Format, su2};

fuzz_target!(|input: &[u8]| {
    let Some(document) = read(input, || su2::read(input, PLACE)) else { return };
    check_mesh(&document.mesh);
    let write = |mesh: &voronaut::mesh::Mesh| written(|out| Format::Su2.write(mesh, &Fields::default(), out));
    let file = write(&document.mesh);
    let again = su2::read(file.as_slice(), PLACE).expect("its own file").mesh;
    assert_eq!(again.triangles.len(), document.mesh.triangles.len());
    assert_eq!(write(&again), file);
});
