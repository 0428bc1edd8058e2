//! A surface from what users write for it: a shape, an equation, or a file.

use super::files::{in_file, neither};
use super::{Document, Format, read};
use std::path::Path;
use voronaut::Result;
use voronaut::surface::{self, Input, Mended, RepairOptions, Surface, repaired};

/// Reads a surface: `sphere:r`, `torus:R,r`, `chair`, `implicit:EXPR;x0,y0,z0,x1,y1,z1`, with edges about as long as `edge`, or a
/// file `.mesh`, `.meshb`, `.msh`, `.vtu`, `.vtp`, `.obj`, `.off`, `.ply` or `.stl`, mended as the options say ([`repaired`]), with
/// what was mended.
///
/// # Errors
/// [`Error::Io`](voronaut::Error::Io) of a file that cannot be read; [`Error::Parse`](voronaut::Error::Parse) of a text that is not what
/// its format asks for; [`Error::Domain`](voronaut::Error::Domain) of what makes no surface; [`Error::Limit`](voronaut::Error::Limit) of
/// too many triangles.
pub fn read_surface(spec: &str, edge: Option<f64>, options: RepairOptions) -> Result<(Input, Mended)> {
    if let Some(shape) = surface::shape(spec, edge) {
        return Ok((shape?, Mended::default()));
    }
    if Format::of_ending(Path::new(spec)).is_none() {
        return Err(neither(spec, SURFACES));
    }
    let (surface, mended) = of_document(spec, &read(Path::new(spec))?, options)?;
    Ok((Input::new(surface, None), mended))
}

/// What users write for a surface, for messages.
pub(crate) const SURFACES: &str = "sphere:r, torus:R,r, chair, implicit:EXPR;x0,y0,z0,x1,y1,z1, or a surface in a file .mesh, .meshb, .msh, .vtu, .vtp, .obj, .off, .ply or .stl";

/// The surface that a file holds, which messages name, mended as the options say ([`repaired`]), with what was mended.
///
/// # Errors
/// As of [`repaired`] and [`Surface::new`].
pub fn of_document(file: &str, document: &Document, options: RepairOptions) -> Result<(Surface, Mended)> {
    let made = repaired(&document.mesh, options)
        .and_then(|(mesh, mended)| Ok((Surface::new(&mesh)?, mended.with_notes(&document.notes))));
    made.map_err(|error| in_file(file, error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{obj, off, ply, stl};
    use proptest::prelude::*;
    use std::io::Write;

    fn data(name: &str) -> String {
        format!("{}/../../data/{name}", env!("CARGO_MANIFEST_DIR"))
    }

    #[test]
    fn spot_and_bob() {
        let spot = read_surface(&data("spot.obj"), None, RepairOptions::default()).unwrap().0.surface;
        let components = spot.components();
        assert_eq!((spot.positions().len(), components.len()), (2930, 1));
        assert_eq!((components[0].genus(), components[0].borders, spot.turned()), (0, 0, 0));
        let bob = read_surface(&data("bob_small.obj"), None, RepairOptions::default()).unwrap().0.surface;
        let components = bob.components();
        assert_eq!((bob.positions().len(), components.len()), (250, 1));
        assert_eq!((components[0].genus(), components[0].borders, bob.turned()), (1, 0, 0));
    }

    #[test]
    fn files_by_their_endings() {
        let text = "OFF 4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
        let mut file = tempfile::Builder::new().suffix(".OFF").tempfile().unwrap();
        file.write_all(text.as_bytes()).unwrap();
        assert_eq!(
            read_surface(file.path().to_str().unwrap(), None, RepairOptions::default())
                .unwrap()
                .0
                .surface
                .euler_characteristic(),
            2
        );
        let mut file = tempfile::Builder::new().suffix(".obj").tempfile().unwrap();
        file.write_all(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 3 2 1\nf 1 2 4\nf 1 2 5\nv 1 1 1\n").unwrap();
        let path = file.path().to_str().unwrap();
        let error = read_surface(path, None, RepairOptions::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "invalid domain: an edge of 3 triangles (among them 1, 3 and 4) at {path}, vertex 1 (0, 0, 0) - vertex 2 (1, 0, 0)"
            )
        );
        let (mended, notes) = read_surface(path, None, RepairOptions { repair: true }).unwrap();
        let notes: Vec<_> = notes.sentences().collect();
        assert_eq!((mended.surface.topology().face_count(), notes.len()), (3, 4), "{notes:?}");
    }

    #[test]
    fn bad_specifications() {
        for (spec, expected) in [
            ("sphere:1,2", "sphere:1,2: 2 numbers where 1 are expected"),
            ("sphere:x", "sphere:x: 'x' is not a number"),
            ("sphere:-1", "invalid domain: a sphere whose radii"),
            ("torus:1,2", "invalid domain: a torus whose tube meets itself"),
            ("sphere", "sphere: neither a shape nor a file"),
            ("chair:1", "chair:1: neither a shape nor a file"),
            ("implicit:x", "implicit:x: an equation without its box"),
            ("implicit:x+;0,0,0,1,1,1", "expression, column 3: a value was expected"),
            ("implicit:x;0,0,0,1,1", "implicit:x;0,0,0,1,1: 5 numbers where 6 are expected"),
            ("implicit:x;0,0,0,0,1,1", "invalid domain: an empty box at (0, 0, 0) - (0, 1, 1)"),
            ("no/such/file.stl", "no/such/file.stl: "),
        ] {
            let error = read_surface(spec, None, RepairOptions::default()).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }

    /// Words that surface files may hold, in any order, behind a beginning that makes sense.
    fn soup() -> impl Strategy<Value = String> {
        let words = [
            "0",
            "1",
            "2",
            "3",
            "-1",
            "0.5",
            "1e308",
            "9999999999999999999",
            "nan",
            "\n",
            "#",
            "v 0 0 1\n",
            "f 1 2 3\n",
            "f 1/2/3 -1",
            "l 1 2",
            "3 0 1 2\n",
            "3 2 1 3\n",
            "facet normal 0 0 1 outer loop",
            "vertex 1 0 0",
            "vertex 0 1 1",
            "vertex 0 0 0",
            "endloop endfacet\n",
            "endsolid",
            "element face 2\n",
            "property float x\n",
            "property list uchar int vertex_indices\n",
            "end_header\n",
            "\u{e9}",
        ];
        let opening = prop::sample::select(vec![
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n",
            "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n",
            "solid a\nfacet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet\n",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n",
            "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty int x\nproperty char y\nproperty short z\n",
            "",
        ]);
        let rest = prop::collection::vec(prop::sample::select(words.to_vec()), 0..24);
        (opening, rest).prop_map(|(opening, rest)| opening.to_owned() + &rest.join(" "))
    }

    proptest! {
        #[test]
        fn no_file_makes_a_reader_panic(text in soup()) {
            let bytes = text.as_bytes();
            let [obj, ply] = [obj::read(bytes, "a"), ply::read(bytes, "a")].map(|found| found.map(|found| found.mesh));
            let found = [obj, off::read(bytes, "a"), ply, stl::read(bytes, "a")];
            for mesh in found.iter().flatten() {
                let _ = repaired(mesh, RepairOptions { repair: true });
            }
            for surface in found.into_iter().flatten().filter_map(|mesh| Surface::new(&mesh).ok()) {
                prop_assert!(surface.topology().check().is_ok());
                prop_assert!(surface.components().iter().all(|c| c.genus() >= 0));
                let fitted = voronaut::surface::metric::fit_curvatures(&surface);
                prop_assert!(fitted.iter().flatten().all(|c| c.values.iter().all(|value| !value.is_nan())));
            }
        }
    }
}
