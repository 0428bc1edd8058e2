//! `.ply`: our files have no edges.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::medit::Form;
use voronaut_io::ply;
use voronaut_fuzz::{PLACE, assert_same_document, check_document, read, written};

fuzz_target!(|input: &[u8]| {
    let Some(mut document) = read(input, || ply::read(input, PLACE)) else { return };
    check_document(&document);
    document.mesh.edges.clear();
    document.mesh.edge_labels.clear();
    for form in [Form::Text, Form::Binary] {
        let file = written(|out| ply::write(&document.mesh, &document.fields, form, out));
        let again = ply::read(file.as_slice(), PLACE).expect("its own file");
        assert_same_document(&again, &document);
    }
});
