//! What the user writes for a domain, which may lie in the plane or be a surface.

use super::files::{ending, neither};
use super::surface::of_document;
use super::{DOMAINS, Format, SURFACES, read, read_domain, read_surface};
use std::path::Path;
use voronaut::Result;
use voronaut::domain::Domain;
use voronaut::surface::{Input, Mended, RepairOptions};

/// A domain: of the plane, or a surface in space.
#[derive(Debug)]
pub enum Given {
    /// A planar domain.
    Plane(Domain),
    /// A surface.
    Surface(Input),
}

impl Given {
    /// Reads what the user wrote. `sphere:`, `torus:`, `chair`, `implicit:` and files `.obj`, `.off`, `.ply` and `.stl` are
    /// surfaces; a `.mesh` is one if it has triangles and some z is not 0. All else is a planar domain. `edge` is as for
    /// [`read_surface`].
    ///
    /// # Errors
    /// As for [`read_surface`] and [`read_domain`]; of what is neither, the help names both.
    pub fn read(spec: &str, edge: Option<f64>) -> Result<Self> {
        Ok(Self::read_with(spec, edge, RepairOptions::default())?.0)
    }

    /// As [`Given::read`], and surfaces in files are mended as the options say, with what was mended, and what readers left out.
    ///
    /// # Errors
    /// As for [`Given::read`].
    pub fn read_with(spec: &str, edge: Option<f64>, options: RepairOptions) -> Result<(Self, Mended)> {
        let surface = || read_surface(spec, edge, options).map(|(input, mended)| (Self::Surface(input), mended));
        let plane = |notes: &[String]| Ok((Self::Plane(read_domain(spec)?), Mended::default().with_notes(notes)));
        let name = spec.split(':').next().unwrap_or_default().trim();
        let path = Path::new(spec);
        match ending(path).as_deref() {
            _ if ["sphere", "torus", "chair", "implicit"].contains(&name) => surface(),
            _ if ["rect", "disk"].contains(&name) => plane(&[]),
            Some("geojson" | "json" | "poly") => plane(&[]),
            _ if Format::of_ending(path).is_some_and(Format::may_be_planar) => {
                let document = read(path)?;
                if document.mesh.triangles.is_empty() || document.mesh.is_planar() {
                    return plane(&document.notes);
                }
                let (surface, mended) = of_document(spec, &document, options)?;
                Ok((Self::Surface(Input::new(surface, None)), mended))
            }
            _ if Format::of_ending(path).is_some() => surface(),
            _ => Err(neither(spec, &format!("{DOMAINS}; or {SURFACES}"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    fn file(ending: &str, content: &str) -> tempfile::NamedTempFile {
        let mut file = tempfile::Builder::new().suffix(ending).tempfile().unwrap();
        file.write_all(content.as_bytes()).unwrap();
        file
    }

    fn is_surface(spec: &str) -> bool {
        matches!(Given::read(spec, Some(0.5)).unwrap(), Given::Surface(_))
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
            let error = Given::read(spec, None).unwrap_err();
            assert!(error.to_string().starts_with(expected) && !error.help().is_empty(), "{error}");
        }
        for spec in ["", "cube:1", "part.step", "mesh"] {
            let error = Given::read(spec, None).unwrap_err();
            assert!(error.to_string().contains("neither a shape nor a file"), "{error}");
            assert!(error.help().contains(".geojson") && error.help().contains("torus:R,r"), "{}", error.help());
        }
        let curve = file(".mesh", "MeshVersionFormatted 2 Dimension 3 Vertices 2 0 0 0 0 1 0 1 0 Edges 1 1 2 0 End");
        let error = Given::read(curve.path().to_str().unwrap(), None).unwrap_err();
        assert!(error.to_string().contains("vertex 2 has z = 1"), "{error}");
        let lone =
            file(".mesh", "MeshVersionFormatted 2 Dimension 3 Vertices 3 0 0 1 0 1 0 0 0 2 0 -1 0 Triangles 1 1 2 3 0");
        let error = Given::read(lone.path().to_str().unwrap(), None).unwrap_err().to_string();
        assert!(
            error.contains("no triangles are left: 1 triangle without area")
                && error.contains(lone.path().to_str().unwrap()),
            "{error}"
        );
    }
}
