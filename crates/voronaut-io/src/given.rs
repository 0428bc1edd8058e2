//! What the user writes for a surface (a shape, an equation, or a file), or for a domain that may be one or lie in the plane.

use super::files::{ending, in_file, neither};
use super::{DOMAINS, Document, Format, as_outline, read, read_outline};
use std::path::Path;
use voronaut::Result;
use voronaut::manifold::Manifold;
use voronaut::manifold::domain::{Domain, Pslg, from_mesh};
use voronaut::manifold::surface::{self, Mended, RepairOptions, Surface, repaired};

/// A domain: of the plane, or a surface in space.
#[derive(Debug)]
pub enum Given {
    /// A planar domain.
    Plane(Domain),
    /// A surface.
    Surface(Manifold),
}

impl Given {
    /// Reads what the user wrote, with what was mended, and what readers left out. `sphere:`, `torus:`, `chair`, `implicit:` and files
    /// `.obj`, `.off`, `.ply` and `.stl` are surfaces; a `.mesh` is one if it has triangles and some z is not 0. All else is a planar
    /// domain. What is in files is mended as the options say.
    ///
    /// # Errors
    /// As for the surface that it may be, and [`read_domain`](super::read_domain); of what is neither, the help names both.
    pub fn read(spec: &str, options: RepairOptions) -> Result<(Self, Mended)> {
        let surface = || read_surface(spec, options).map(|(input, mended)| (Self::Surface(input), mended));
        let plane = || plane(read_outline(spec, options)?, &[]);
        let name = spec.split(':').next().unwrap_or_default().trim();
        let path = Path::new(spec);
        match ending(path).as_deref() {
            _ if ["sphere", "torus", "chair", "implicit"].contains(&name) => surface(),
            _ if ["rect", "disk"].contains(&name) => plane(),
            Some("geojson" | "json" | "poly") => plane(),
            _ if Format::of_ending(path).is_some_and(Format::may_be_planar) => {
                Self::of_document(spec, &read(path)?, true, options)
            }
            _ if Format::of_ending(path).is_some() => surface(),
            _ => Err(neither(spec, &format!("{DOMAINS}; or {SURFACES}"))),
        }
    }

    /// What a document is, which messages name: a surface, mended as the options say, if it has triangles and some z is not 0, or where
    /// it cannot be planar.
    ///
    /// # Errors
    /// As of [`repaired`], [`Surface::new`], [`from_mesh`] and [`Domain::new`].
    pub fn of_document(
        name: &str,
        document: &Document,
        may_be_planar: bool,
        options: RepairOptions,
    ) -> Result<(Self, Mended)> {
        if may_be_planar && (document.mesh.triangles.is_empty() || document.mesh.is_planar()) {
            let outline = from_mesh(&document.mesh).and_then(|graph| as_outline(graph, options));
            return plane(outline.map_err(|error| in_file(name, error))?, &document.notes);
        }
        let (surface, mended) = surface_of(name, document, options)?;
        Ok((Self::Surface(Manifold::new(surface, None)), mended))
    }
}

/// The domain of a graph, with what the reader of its file says and what was mended.
fn plane((outline, mended): (Pslg, Vec<String>), notes: &[String]) -> Result<(Given, Mended)> {
    let notes: Vec<String> = notes.iter().cloned().chain(mended).collect();
    Ok((Given::Plane(Domain::new(&outline)?), Mended::default().with_notes(&notes)))
}

/// Reads a surface: `sphere:r`, `torus:R,r`, `chair`, `implicit:EXPR;x0,y0,z0,x1,y1,z1`, or a file `.mesh`, `.meshb`,
/// `.msh`, `.su2`, `.vtu`, `.vtp`, `.obj`, `.off`, `.ply` or `.stl`, mended as the options say ([`repaired`]), with what was mended.
///
/// # Errors
/// [`Error::Io`](voronaut::Error::Io) of a file that cannot be read; [`Error::Parse`](voronaut::Error::Parse) of a text that is not what
/// its format asks for; [`Error::Domain`](voronaut::Error::Domain) of what makes no surface; [`Error::Limit`](voronaut::Error::Limit) of
/// too many triangles.
pub fn read_surface(spec: &str, options: RepairOptions) -> Result<(Manifold, Mended)> {
    if let Some(shape) = surface::shape(spec, None) {
        return Ok((shape?, Mended::default()));
    }
    if Format::of_ending(Path::new(spec)).is_none() {
        return Err(neither(spec, SURFACES));
    }
    let (surface, mended) = surface_of(spec, &read(Path::new(spec))?, options)?;
    Ok((Manifold::new(surface, None), mended))
}

/// What users write for a surface, for messages.
const SURFACES: &str = "sphere:r, torus:R,r, chair, implicit:EXPR;x0,y0,z0,x1,y1,z1, or a surface in a file .mesh, .meshb, .msh, .su2, .vtu, .vtp, .obj, .off, .ply or .stl";

/// The surface that a document holds, mended, with what was mended.
fn surface_of(name: &str, document: &Document, options: RepairOptions) -> Result<(Surface, Mended)> {
    let made = repaired(&document.mesh, options)
        .and_then(|(mesh, mended)| Ok((Surface::new(&mesh)?, mended.with_notes(&document.notes))));
    made.map_err(|error| in_file(name, error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{obj, off, ply, stl};
    use proptest::prelude::*;
    use std::io::Write;
    use voronaut::manifold::surface::metric::{Spec, field};
    use voronaut::metric::Bounds;

    fn data(name: &str) -> String {
        format!("{}/../../data/{name}", env!("CARGO_MANIFEST_DIR"))
    }

    #[test]
    fn spot_and_bob() {
        let spot = read_surface(&data("spot.obj"), RepairOptions::default()).unwrap().0;
        let spot = spot.surface();
        let components = spot.components();
        assert_eq!((spot.positions().len(), components.len()), (2930, 1));
        assert_eq!((components[0].genus(), components[0].borders, spot.turned()), (0, 0, 0));
        let bob = read_surface(&data("bob_small.obj"), RepairOptions::default()).unwrap().0;
        let bob = bob.surface();
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
            read_surface(file.path().to_str().unwrap(), RepairOptions::default())
                .unwrap()
                .0
                .surface()
                .euler_characteristic(),
            2
        );
        let mut file = tempfile::Builder::new().suffix(".obj").tempfile().unwrap();
        file.write_all(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 3 2 1\nf 1 2 4\nf 1 2 5\nv 1 1 1\n").unwrap();
        let path = file.path().to_str().unwrap();
        let error = read_surface(path, RepairOptions::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            format!(
                "invalid domain: an edge of 3 triangles (among them 1, 3 and 4) at {path}, vertex 1 (0, 0, 0) - vertex 2 (1, 0, 0)"
            )
        );
        let (mended, notes) = read_surface(path, RepairOptions { repair: true }).unwrap();
        let notes: Vec<_> = notes.sentences().collect();
        assert_eq!((mended.topology().face_count(), notes.len()), (3, 4), "{notes:?}");
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
            let error = read_surface(spec, RepairOptions::default()).unwrap_err();
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
                prop_assert!(Surface::new(&surface.to_mesh()).is_ok());
                prop_assert!(surface.components().iter().all(|c| c.genus() >= 0));
                let input = Manifold::new(surface, None);
                let Ok(metric) = field(&Spec::Curvature(None), &input, Bounds::default()) else { continue };
                for face in input.topology().faces() {
                    let place = input.closest(input.triangle(face)[0]);
                    prop_assert!(place.is_ok_and(|place| !metric.at(&place).xx.is_nan()));
                }
            }
        }
    }

    fn file(ending: &str, content: &str) -> tempfile::NamedTempFile {
        let mut file = tempfile::Builder::new().suffix(ending).tempfile().unwrap();
        file.write_all(content.as_bytes()).unwrap();
        file
    }

    fn is_surface(spec: &str) -> bool {
        matches!(Given::read(spec, RepairOptions::default()).unwrap().0, Given::Surface(_))
    }

    #[test]
    fn shapes_and_files_are_told_apart() {
        assert!(
            is_surface("sphere:1")
                && is_surface(" torus: 2, 0.7")
                && is_surface("implicit:x^2+y^2+z^2-1;-2,-2,-2,2,2,2")
        );
        assert!(!is_surface("rect:0,0,1,1") && !is_surface("disk:0,0,1"));
        let mesh = |z: f64, triangles: &str| {
            let text =
                format!("MeshVersionFormatted 2 Dimension 3 Vertices 3 0 0 0 0 1 0 0 0 0 1 {z} 0\n{triangles} End");
            file(".MESH", &text)
        };
        let triangle = "Triangles 1 1 2 3 0";
        assert!(is_surface(mesh(0.5, triangle).path().to_str().unwrap()));
        assert!(!is_surface(mesh(0.0, triangle).path().to_str().unwrap()));
        assert!(!is_surface(mesh(0.0, "Edges 3 1 2 1 2 3 1 3 1 1").path().to_str().unwrap()));
        let off = file(".Off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
        assert!(is_surface(off.path().to_str().unwrap()), "planar, and yet a surface by its ending");
        let poly = file(".poly", "3\n1 0 0\n2 1 0\n3 0 1\n3\n1 1 2\n2 2 3\n3 3 1\n");
        assert!(!is_surface(poly.path().to_str().unwrap()));
    }

    #[test]
    fn mistakes_are_named_with_what_works() {
        for (spec, expected) in [
            ("sphere", "sphere: neither a shape"),
            ("torus:1", "torus:1: 1 numbers where 2 are expected"),
            ("rect:0,0,1", "rect:0,0,1: 3 numbers"),
            ("no/such.mesh", "no/such.mesh: "),
            ("no/such.ply", "no/such.ply: "),
            ("no/such.msh", "no/such.msh: "),
            ("no/such.poly", "no/such.poly: "),
        ] {
            let error = Given::read(spec, RepairOptions::default()).unwrap_err();
            assert!(error.to_string().starts_with(expected) && !error.help().is_empty(), "{error}");
        }
        for spec in ["", "cube:1", "part.step", "mesh"] {
            let error = Given::read(spec, RepairOptions::default()).unwrap_err();
            assert!(error.to_string().contains("neither a shape nor a file"), "{error}");
            assert!(error.help().contains(".geojson") && error.help().contains("torus:R,r"), "{}", error.help());
        }
        let curve = file(".mesh", "MeshVersionFormatted 2 Dimension 3 Vertices 2 0 0 0 0 1 0 1 0 Edges 1 1 2 0 End");
        let error = Given::read(curve.path().to_str().unwrap(), RepairOptions::default()).unwrap_err();
        assert!(error.to_string().contains("vertex 2 has z = 1"), "{error}");
        let lone =
            file(".mesh", "MeshVersionFormatted 2 Dimension 3 Vertices 3 0 0 1 0 1 0 0 0 2 0 -1 0 Triangles 1 1 2 3 0");
        let error = Given::read(lone.path().to_str().unwrap(), RepairOptions::default()).unwrap_err().to_string();
        assert!(
            error.contains("no triangles are left: 1 triangle without area")
                && error.contains(lone.path().to_str().unwrap()),
            "{error}"
        );
    }
}
