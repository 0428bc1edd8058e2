//! Triangle strips: each vertex behind the first two makes a triangle with the two before it.

use super::fault;
use crate::codec::{At, Source};
use voronaut::Result;

/// The strip that is read.
#[derive(Default)]
pub(super) struct Strip {
    length: u64,
    last: [u32; 2],
}

impl Strip {
    /// The triangle that a vertex adds, turned like the first. Those with a vertex twice are none: with them programs join strips.
    pub(super) fn with(&mut self, vertex: u32) -> Option<[u32; 3]> {
        let [a, b] = self.last;
        self.last = [b, vertex];
        self.length += 1;
        let is_triangle = self.length > 2 && a != b && b != vertex && vertex != a;
        is_triangle.then_some(if self.length % 2 == 1 { [a, b, vertex] } else { [b, a, vertex] })
    }

    /// Refuses the end of a strip that is none.
    ///
    /// # Errors
    /// [`Error::Parse`](voronaut::Error::Parse) of strips of one vertex or two.
    pub(super) fn demand_triangles(&self, source: &Source<'_>, at: At<'_>) -> Result<()> {
        if !matches!(self.length, 1 | 2) {
            return Ok(());
        }
        let what = format!("a strip of {} vertices", self.length);
        Err(fault(&what, "a strip needs three vertices or more", source, at))
    }
}

#[cfg(test)]
mod tests {
    use crate::ply::read;

    /// A file of five vertices and one list of strips.
    fn file(format: &str, strips: &[i32]) -> Vec<u8> {
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 2.0, 0.5_f32]];
        let mut file = format!(
            "ply\nformat {format} 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
             element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        )
        .into_bytes();
        let count = [i32::try_from(strips.len()).unwrap()];
        let numbers = count.iter().chain(strips);
        match format {
            "ascii" => {
                points.as_flattened().iter().for_each(|x| file.extend(format!("{x} ").bytes()));
                numbers.for_each(|i| file.extend(format!("{i} ").bytes()));
            }
            "binary_little_endian" => {
                points.as_flattened().iter().for_each(|x| file.extend(x.to_le_bytes()));
                numbers.for_each(|i| file.extend(i.to_le_bytes()));
            }
            _ => {
                points.as_flattened().iter().for_each(|x| file.extend(x.to_be_bytes()));
                numbers.for_each(|i| file.extend(i.to_be_bytes()));
            }
        }
        file
    }

    const FORMATS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

    #[test]
    fn strips_are_triangles_that_turn_alike() {
        for format in FORMATS {
            let strips = [0, 1, 2, 3, 4, -1, 4, 2, 0, -1, -1, 0, 1, 2, 2, 3, 4];
            let mesh = read(file(format, &strips).as_slice(), "a.ply").unwrap().mesh;
            let expected = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 2, 0], [0, 1, 2], [3, 2, 4]];
            assert_eq!(mesh.triangles[..5], expected[..5], "{format}");
            assert_eq!((mesh.triangles.len(), mesh.triangle_labels), (6, vec![0; 6]));
            assert!(read(file(format, &[]).as_slice(), "a.ply").unwrap().mesh.triangles.is_empty());
        }
    }

    #[test]
    fn what_is_no_strip_is_named() {
        for (strips, expected) in [
            (&[0, 1, 5][..], "vertex 5 does not exist: the file lists 5, from 0"),
            (&[0, 1, -2], "vertex -2 does not exist (row 1 of 1 of tristrips)"),
            (&[0, 1, -1, 2, 3, 4], "a strip of 2 vertices (row 1 of 1 of tristrips)"),
            (&[0, 1, 2, -1, 3], "a strip of 1 vertices (row 1 of 1 of tristrips)"),
        ] {
            for format in FORMATS {
                let error = read(file(format, strips).as_slice(), "a.ply").unwrap_err();
                assert!(error.to_string().ends_with(expected) && !error.help().is_empty(), "{error}");
            }
        }
        let whole = file("ascii", &[0, 1, 2, 3]);
        let error = read(&whole[..whole.len() - 2], "a.ply").unwrap_err();
        assert!(error.to_string().contains("the text ends in row 1 of 1 of tristrips"), "{error}");
    }
}
