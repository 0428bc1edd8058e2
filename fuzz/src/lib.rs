//! What holds of every reader, whatever it is given.

use peak_alloc::PeakAlloc;
use voronaut::{Error, Result};
use voronaut::mesh::SolutionValues;
use voronaut_io::{Document, Field, Fields};
use voronaut::mesh::Mesh;

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// What messages call the input.
pub const PLACE: &str = "input";

/// Bytes that reading may take beyond a multiple of the input's: buffers, and tables of a fixed size.
const BUFFERS: usize = 1 << 20;
/// What a byte of the input may become: a digit and a space are an entry of some lists, which grow by doubling.
const GROWTH: usize = 400;

/// What a reader makes of the input, if it accepts it.
///
/// # Panics
/// If it takes memory that the input does not account for, or refuses with an error that does not say what, where and what to do.
pub fn read<T>(input: &[u8], reader: impl FnOnce() -> Result<T>) -> Option<T> {
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let found = reader();
    let taken = MEMORY.peak_usage().saturating_sub(before);
    assert!(taken <= BUFFERS + GROWTH * input.len(), "{taken} bytes of memory for {} bytes of input", input.len());
    found.map_err(|error| check_error(&error)).ok()
}

fn check_error(error: &Error) {
    assert!(!error.help().is_empty(), "no help: {error}");
    let place = match error {
        Error::Parse { place, .. } | Error::Domain { place, .. } => place,
        Error::Unsupported { what, .. } | Error::Limit { what, .. } => what,
        _ => panic!("a reader does not say: {error}"),
    };
    assert!(place.contains(PLACE), "no place: {error}");
    let is_number = |c: char| c.is_ascii_digit();
    let numbered = [":", ", byte ", ", feature "]
        .iter()
        .any(|mark| place.split(&format!("{PLACE}{mark}")).skip(1).any(|rest| rest.starts_with(is_number)));
    assert!(numbered || !matches!(error, Error::Parse { .. }), "neither line nor byte: {error}");
}

/// Checks that a mesh is one: all numbers refer to something, coordinates are finite, and each element has its label.
///
/// # Panics
/// If not.
pub fn check_mesh(mesh: &Mesh) {
    mesh.check_numbers().expect("numbers that refer to something");
    assert!(mesh.points.as_flattened().iter().all(|x| x.is_finite()));
    let counts = [mesh.points.len(), mesh.triangles.len(), mesh.edges.len()];
    assert_eq!(counts, [&mesh.point_labels, &mesh.triangle_labels, &mesh.edge_labels].map(Vec::len));
}

/// As [`check_mesh`], and that each field has finite values everywhere.
///
/// # Panics
/// If not.
pub fn check_document(document: &Document) {
    check_mesh(&document.mesh);
    let Fields { vertices, triangles } = &document.fields;
    for (fields, count) in [(vertices, document.mesh.points.len()), (triangles, document.mesh.triangles.len())] {
        for field in fields {
            assert_eq!(field.values.count(), count, "{}", field.name);
            assert!(numbers(&field.values).iter().all(|x| x.is_finite()), "{}", field.name);
        }
    }
}

/// Checks that two meshes are the same, to the bit.
///
/// # Panics
/// If they differ.
pub fn assert_same(found: &Mesh, truth: &Mesh) {
    assert_eq!(found, truth);
    // Planar files do not say whether z is 0 or -0.
    let bits = |[x, y, z]: &[f64; 3]| [x.to_bits(), y.to_bits(), (z + 0.0).to_bits()];
    assert!(found.points.iter().map(bits).eq(truth.points.iter().map(bits)), "{found:?} {truth:?}");
}

/// As [`assert_same`], with fields.
///
/// # Panics
/// If they differ.
pub fn assert_same_document(found: &Document, truth: &Document) {
    assert_same(&found.mesh, &truth.mesh);
    for (found, truth) in
        [(&found.fields.vertices, &truth.fields.vertices), (&found.fields.triangles, &truth.fields.triangles)]
    {
        let names = |fields: &[Field]| fields.iter().map(|field| field.name.clone()).collect::<Vec<_>>();
        assert_eq!(names(found), names(truth));
        found.iter().zip(truth).for_each(|(found, truth)| assert_same_values(&found.values, &truth.values));
    }
}

/// Checks that two lists of values are the same, to the bit.
///
/// # Panics
/// If they differ.
pub fn assert_same_values(found: &SolutionValues, truth: &SolutionValues) {
    assert_eq!(found, truth);
    let bits = |values: &SolutionValues| numbers(values).iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(found), bits(truth));
}

/// What a writer writes.
///
/// # Panics
/// If it fails: there is nothing that could.
pub fn written(write: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()>) -> Vec<u8> {
    let mut out = Vec::new();
    write(&mut out).expect("memory takes everything");
    out
}

fn numbers(values: &SolutionValues) -> Vec<f64> {
    (0..values.count()).flat_map(|i| values.row(i)).copied().collect()
}
