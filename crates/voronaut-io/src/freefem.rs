//! `FreeFEM`'s planar meshes, `.msh` as text, which bamg writes, too (`-omsh`): counts, then vertices, triangles and edges with labels.

use super::codec::{At, Source, several};
use std::io::BufRead;
use voronaut::Result;
use voronaut::mesh::Mesh;

/// Reads a mesh: a row `VERTICES TRIANGLES EDGES`, then a row `x y label` for each vertex, `i j k label` for each triangle and
/// `i j label` for each edge. `place` names the file in messages. Memory follows the file, never a count written in it.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) with the line of what is not as announced, or not there.
pub fn read(source: impl BufRead, place: &str) -> Result<Mesh> {
    let (mut source, head) = (Source::new(source, place), At::head("the file"));
    let [vertices, triangles, edges] = several(|| source.word(head)?.whole(head))?;
    let mut mesh = Mesh::default();
    for at in At::rows("the vertices", vertices) {
        let [x, y] = several(|| source.word(at)?.number(at))?;
        mesh.points.push([x, y, 0.0]);
        mesh.point_labels.push(source.word(at)?.whole(at)?);
    }
    for at in At::rows("the triangles", triangles) {
        mesh.triangles.push(several(|| source.word(at)?.vertex(1, vertices, at))?);
        mesh.triangle_labels.push(source.word(at)?.whole(at)?);
    }
    for at in At::rows("the edges", edges) {
        mesh.edges.push(several(|| source.word(at)?.vertex(1, vertices, at))?);
        mesh.edge_labels.push(source.word(at)?.whole(at)?);
    }
    let help = "check the counts in the first row; files of Gmsh begin with $MeshFormat";
    source.demand_end("more numbers than the counts in the file announce", help)?;
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "4 2 2\n0 0 1\n1 0 2\n1 1 3\n0 1 4\n1 2 3 7\n1 3 4 8\n1 2 5\n3 4 6\n";

    #[test]
    fn a_square() {
        let mesh = read(TEXT.as_bytes(), "a.msh").unwrap();
        assert_eq!((mesh.points.len(), &mesh.point_labels[..]), (4, &[1, 2, 3, 4][..]));
        assert_eq!((&mesh.triangles[..], &mesh.triangle_labels[..]), (&[[0, 1, 2], [0, 2, 3]][..], &[7, 8][..]));
        assert_eq!((&mesh.edges[..], &mesh.edge_labels[..]), (&[[0, 1], [2, 3]][..], &[5, 6][..]));
    }

    #[test]
    fn errors_say_what_and_where() {
        for (from, to, expected) in [
            ("4 2 2", "4 2", "a.msh:2: '0.5' is not a whole number (the head of the file)"),
            ("4 2 2", "4 2 9000000000000000000", "a.msh:9: the text ends in row 3 of 9000000000000000000 of the edges"),
            ("4 2 2", "4 2 1", "a.msh:9: more numbers than the counts in the file announce"),
            ("1 3 4 8", "1 3 5 8", "a.msh:7: vertex 5 does not exist (row 2 of 2 of the triangles)"),
            ("1 3 4 8", "1 3 0 8", "a.msh:7: vertex 0 does not exist (row 2 of 2 of the triangles)"),
            ("1 0 2", "nan 0 2", "a.msh:3: 'nan' is not a finite number (row 2 of 4 of the vertices)"),
        ] {
            let text = TEXT.replacen("0 0 1", "0.5 0 1", 1).replacen(from, to, 1);
            let error = read(text.as_bytes(), "a.msh").unwrap_err();
            assert!(error.to_string().starts_with(expected) && !error.help().is_empty(), "{error}");
        }
    }
}
