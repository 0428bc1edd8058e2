//! `.vtu` and `.vtp`: lists of what is marked come back in ascending order.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::vtk;
use voronaut_fuzz::{PLACE, assert_same_document, check_document, read, written};

fuzz_target!(|input: &[u8]| {
    let Some(document) = read(input, || vtk::read(input, PLACE)) else { return };
    check_document(&document);
    let mut fields = document.fields.vertices.iter().chain(&document.fields.triangles);
    if fields.any(|field| field.name.contains(char::is_control)) {
        // XML has no such characters: the writer puts others in their place.
        return;
    }
    // Polygons have no place for curves.
    let writers = if document.mesh.curved.is_some() { 1 } else { 2 };
    for write in &[vtk::write_vtu, vtk::write_vtp][..writers] {
        let file = written(|out| write(&document.mesh, &document.fields, out));
        let again = vtk::read(file.as_slice(), PLACE).expect("its own file");
        assert_same_document(&again, &document);
    }
});
