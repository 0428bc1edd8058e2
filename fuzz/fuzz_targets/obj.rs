//! `.obj`: labels of edges have no place there, and triangles come back in the order of their labels.
#![no_main]

use libfuzzer_sys::fuzz_target;
use voronaut_io::{Document, Fields, Format, obj};
use voronaut_fuzz::{PLACE, assert_same, check_mesh, read, written};

fuzz_target!(|input: &[u8]| {
    let Some(Document { mut mesh, .. }) = read(input, || obj::read(input, PLACE)) else { return };
    check_mesh(&mesh);
    let file = written(|out| Format::Obj.write(&mesh, &Fields::default(), out));
    let again = obj::read(file.as_slice(), PLACE).expect("its own file").mesh;
    let mut order: Vec<usize> = (0..mesh.triangles.len()).collect();
    order.sort_by_key(|&i| mesh.triangle_labels[i]);
    mesh.triangles = order.iter().map(|&i| mesh.triangles[i]).collect();
    mesh.triangle_labels = order.iter().map(|&i| mesh.triangle_labels[i]).collect();
    assert_same(&again, &mesh);
});
