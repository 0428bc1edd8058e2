//! `.mesh` and `.meshb`.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::Document;
use voronaut_io::medit::{self, Form};
use voronaut_fuzz::{PLACE, assert_same, check_mesh, read, written};

fuzz_target!(|input: &[u8]| {
    let Some(Document { mesh, .. }) = read(input, || medit::read(input, PLACE)) else { return };
    check_mesh(&mesh);
    for form in [Form::Text, Form::Binary] {
        let file = written(|out| medit::write(&mesh, form, out));
        assert_same(&medit::read(file.as_slice(), PLACE).expect("its own file").mesh, &mesh);
    }
});
