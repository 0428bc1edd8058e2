//! `.msh`, Gmsh's in all versions and `FreeFEM`'s.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::medit::Form;
use voronaut_io::{Document, freefem, gmsh};
use voronaut_fuzz::{PLACE, assert_same_document, check_document, check_mesh, read, written};

fuzz_target!(|input: &[u8]| {
    if let Some(mesh) = read(input, || freefem::read(input, PLACE)) {
        check_mesh(&mesh);
    }
    let Some(document) = read(input, || gmsh::read(input, PLACE)) else { return };
    check_document(&document);
    for version in [gmsh::Version::V2_2, gmsh::Version::V4_1] {
        let again = |document: &Document, form| {
            let file = written(|out| gmsh::write(&document.mesh, &document.fields, version, form, out));
            gmsh::read(file.as_slice(), PLACE).expect("its own file")
        };
        // Triangles and edges are sorted by their labels: from then on nothing changes any more.
        let sorted = again(&document, Form::Text);
        assert_eq!(sorted.mesh.points, document.mesh.points);
        assert_eq!(sorted.mesh.triangles.len(), document.mesh.triangles.len());
        check_document(&sorted);
        let all = [&sorted.fields.vertices, &sorted.fields.triangles];
        if all
            .into_iter()
            .any(|fields| fields.iter().enumerate().any(|(i, a)| fields[..i].iter().any(|b| a.name == b.name)))
        {
            // Of the same name and step: such fields get other names each time.
            return;
        }
        assert_same_document(&again(&sorted, Form::Text), &sorted);
        assert_same_document(&again(&sorted, Form::Binary), &sorted);
    }
});
