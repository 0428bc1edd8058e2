//! A planar domain from what users write for it: a shape, or a file.

use super::files::{ending, in_file, neither};
use super::{Format, geojson, open, poly, read, read_text};
use std::path::Path;
use voronaut::domain::{self, Domain, Pslg, from_mesh, from_poly, from_polygons};
use voronaut::{Error, Result};

/// Reads and validates a domain.
///
/// # Errors
/// What [`read_pslg`] and [`Domain::new`] refuse.
pub fn read_domain(spec: &str) -> Result<Domain> {
    Domain::new(&read_pslg(spec)?)
}

/// Reads the graph of a planar domain: `rect:x0,y0,x1,y1`, `disk:cx,cy,r`, or a file `.geojson`, `.json`, `.poly`, `.mesh`,
/// `.meshb`, `.msh`, `.su2`, `.vtu` or `.vtp`.
///
/// # Errors
/// [`Error::Io`] of a file that cannot be read; [`Error::Parse`] of a specification or a file that is not what its
/// format asks for, empty, or not UTF-8; [`Error::Domain`] of what makes no domain, as far as one look at points,
/// segments and rings tells; [`Error::Unsupported`] of surfaces and of formats that are not read.
pub fn read_pslg(spec: &str) -> Result<Pslg> {
    if let Some(shape) = domain::shape(spec) {
        return shape;
    }
    let path = Path::new(spec);
    let format = Format::of_ending(path);
    let pslg = match ending(path).as_deref() {
        Some("geojson" | "json") => from_polygons(&geojson::read(&read_text(path)?, spec)?),
        Some("poly") => from_poly(&poly::read(open(path)?, spec)?),
        _ if format.is_some_and(Format::may_be_planar) => from_mesh(&read(path)?.mesh),
        Some(ending) if format.is_some() => {
            let what = format!("a .{ending} file as planar domain ({spec})");
            return Err(Error::unsupported(what, format!("give {DOMAINS}")));
        }
        _ => return Err(neither(spec, DOMAINS)),
    };
    pslg.map_err(|error| in_file(spec, error))
}

/// What users write for a planar domain, for messages.
pub(crate) const DOMAINS: &str = "rect:x0,y0,x1,y1, disk:cx,cy,r, or a planar domain in a file .geojson, .json, .poly, .mesh, .meshb, .msh, .su2, .vtu or .vtp";

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Document, medit, sol};
    use proptest::prelude::*;
    use std::io::Write;

    fn with_file<T>(ending: &str, content: &[u8], test: impl Fn(&str) -> T) -> T {
        let mut file = tempfile::Builder::new().suffix(ending).tempfile().unwrap();
        file.write_all(content).unwrap();
        test(file.path().to_str().unwrap())
    }

    #[test]
    fn shapes_and_files_are_read() {
        assert_eq!(read_pslg("rect: 0, 0,1e0,2").unwrap().points.len(), 4);
        assert_eq!(read_pslg("disk:0,0,1").unwrap().points.len(), 4096);
        let geojson = br#"{"type":"Polygon","coordinates":[[[0,0],[1,0],[0,1],[0,0]]]}"#;
        let poly = b"3\n1 0 0\n2 1 0\n3 0 1\n3\n1 1 2\n2 2 3\n3 3 1\n";
        let mesh = b"MeshVersionFormatted 2 Dimension 2 Vertices 3 0 0 0 1 0 0 0 1 0 Triangles 1 1 2 3 4 End";
        for (ending, content) in [(".GeoJSON", &geojson[..]), (".json", geojson), (".poly", poly), (".mesh", mesh)] {
            let pslg = with_file(ending, content, |path| read_pslg(path).unwrap());
            assert_eq!((pslg.points.len(), pslg.segments.len()), (3, 3), "{ending}");
        }
    }

    #[test]
    fn bad_specifications() {
        for (spec, expected) in [
            ("rect:0,0,1", "rect:0,0,1: 3 numbers where 4 are expected"),
            ("disk:0,x,1", "disk:0,x,1: 'x' is not a number"),
            ("rect:0,0,0,1", "invalid domain: a rectangle needs x0 < x1"),
            ("disk:0,0,nan", "invalid domain: a disk without a positive radius"),
            ("sphere:1", "not supported: the surface sphere:1 as planar domain"),
            ("chair", "not supported: the surface chair as planar domain"),
            ("part.STL", "not supported: a .stl file as planar domain (part.STL)"),
            ("mesh", "mesh: neither a shape nor a file with an ending that is known"),
            ("", ": neither a shape nor a file"),
            ("no/such/file.poly", "no/such/file.poly: "),
        ] {
            let error = read_pslg(spec).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
            assert!(!error.help().is_empty());
        }
        assert!(matches!(read_pslg("no/such/file.mesh"), Err(Error::Io { .. })));
        assert!(read_pslg("torus:2,1").unwrap_err().help().contains("rect:x0,y0,x1,y1"));
    }

    #[test]
    fn bad_files_are_named() {
        for (ending, content, expected) in [
            (".mesh", &b""[..], ": the file is empty"),
            (".geojson", b" \n\t\n", ": the file is empty"),
            (".mesh", b"Mesh\xff", ":1: not a text in UTF-8 (byte 5 of the line)"),
            (".poly", b"2\n1 0 0\n2 0 0\n1\n1 1 2\n", ", (0, 0)"),
            (".json", br#"{"type":"Point","coordinates":[0,0]}"#, ", feature 1: a Point where a Polygon"),
            (
                ".mesh",
                b"MeshVersionFormatted 2 Dimension 3 Vertices 1 0 0 1 0 End",
                " as domain (vertex 1 has z = 1) in ",
            ),
        ] {
            with_file(ending, content, |path| {
                let error = read_pslg(path).unwrap_err();
                let message = error.to_string();
                assert!(message.contains(expected) && message.contains(path), "{message}");
                assert!(!error.help().is_empty());
            });
        }
    }

    /// Words that a `.mesh` or a `.poly` file may hold, in any order.
    fn soup() -> impl Strategy<Value = String> {
        let words = [
            "0",
            "1",
            "2",
            "3",
            "4",
            "0.5",
            "-1",
            "1e308",
            "1e18",
            "9999999999999999999",
            "nan",
            "\n",
            "#",
            "Vertices 3\n",
            "Vertices 3 0 0 1 1 0 1 0 1 1",
            "Edges 2",
            "Edges 1 1 2 3",
            "Triangles 1 1 2 3",
            "Triangles 2",
            "Corners 1 1",
            "RequiredVertices",
            "RequiredEdges 1 1",
            "SolAtVertices 2",
            "1 3",
            "Dimension",
            "End",
            "Tetrahedra",
            "\u{e9}",
        ];
        let opening = prop::sample::select(vec![
            "MeshVersionFormatted 2 Dimension 2 ",
            "MeshVersionFormatted 2 Dimension 3 Vertices 4 0 0 0 1 1 0 0 1 0 1 0 1 1 1 0 1 ",
            "3 2\n1 0 0\n2 1 0\n3 0 1\n",
            "2 2 1\n0 0 0 5\n1 1 0 5\n1\n",
            "",
        ]);
        let rest = prop::collection::vec(prop::sample::select(words.to_vec()), 0..24);
        (opening, rest).prop_map(|(opening, rest)| opening.to_owned() + &rest.join(" "))
    }

    proptest! {
        #[test]
        fn no_text_makes_a_reader_panic(text in soup()) {
            let bytes = text.as_bytes();
            let _ = sol::read(bytes, "a.sol");
            if let Ok(Document { mesh, .. }) = medit::read(bytes, "a.mesh") {
                let mut written = Vec::new();
                medit::write(&mesh, medit::Form::Text, &mut written).unwrap();
                prop_assert_eq!(&medit::read(written.as_slice(), "b.mesh").unwrap().mesh, &mesh);
                let _ = from_mesh(&mesh);
            }
            if let Ok(poly) = poly::read(bytes, "a.poly") {
                let _ = from_poly(&poly);
            }
        }

        #[test]
        fn no_rings_make_the_reader_panic(
            rings in prop::collection::vec(prop::collection::vec((0..3, 0..3), 3..7), 1..4)
        ) {
            let ring = |ring: &Vec<(i32, i32)>| {
                let closed = ring.iter().chain(ring.first()).map(|(x, y)| format!("[{x},{y}]"));
                format!("[{}]", closed.collect::<Vec<_>>().join(","))
            };
            let rings: Vec<_> = rings.iter().map(ring).collect();
            let text = format!(r#"{{"type":"Polygon","coordinates":[{}]}}"#, rings.join(","));
            if let Ok(polygons) = geojson::read(&text, "a.json") {
                let _ = from_polygons(&polygons);
            }
        }
    }
}
