//! Files in both forms, and what is wrong with them.

use super::*;

const HEAD: &str = "MeshVersionFormatted 2\nDimension\n2\nVertices\n3\n0 0 1\n1 0 2 # right\n0 1.D0 3\n";

fn sample(z: f64) -> Mesh {
    Mesh {
        points: vec![[0.1, -1e-300, 0.0], [1.0 / 3.0, 0.0, z], [0.0, 1e22, 0.0], [1.0, 1.0, 0.0]],
        point_labels: vec![1, -2, 0, 7],
        triangles: vec![[0, 1, 2], [3, 2, 1]],
        triangle_labels: vec![5, i32::MIN],
        edges: vec![[0, 1], [2, 0]],
        edge_labels: vec![9, 8],
        corners: vec![2],
        required_points: vec![0, 3],
        ridges: vec![0, 1],
        required_edges: vec![1],
        required_triangles: vec![1],
        periodic: Vec::new(),
        curved: None,
    }
}

fn message(body: &str) -> String {
    let error = read(format!("{HEAD}{body}").as_bytes(), "a.mesh").unwrap_err();
    assert!(!error.help().is_empty(), "{error}");
    error.to_string()
}

fn written(mesh: &Mesh, form: Form) -> Vec<u8> {
    let mut out = Vec::new();
    write(mesh, form, &mut out).unwrap();
    out
}

#[test]
fn what_is_written_reads_back() {
    for mesh in [sample(0.0), sample(2.5)] {
        for form in [Form::Text, Form::Binary] {
            assert_eq!(read(written(&mesh, form).as_slice(), "a.mesh").unwrap().mesh, mesh);
        }
    }
    let bare = Mesh { points: vec![[1.0, 2.0, 0.0]], ..Mesh::default() };
    let text = String::from_utf8(written(&bare, Form::Text)).unwrap();
    assert_eq!(text, "MeshVersionFormatted 2\n\nDimension 2\n\nVertices\n1\n1 2 0\n\nEnd\n");
}

/// A binary file of one triangle, each number written as its version has it.
fn binary(version: i32, big_endian: bool) -> Vec<u8> {
    let mut file = Vec::new();
    let mut push = |bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        if big_endian {
            bytes.reverse();
        }
        file.extend(bytes);
        i64::try_from(file.len()).unwrap()
    };
    let integer = |x: i64| if version == 4 { x.to_le_bytes().to_vec() } else { (x as i32).to_le_bytes().to_vec() };
    let position = |x: i64| if version < 3 { (x as i32).to_le_bytes().to_vec() } else { x.to_le_bytes().to_vec() };
    let real = |x: f64| if version == 1 { (x as f32).to_le_bytes().to_vec() } else { x.to_le_bytes().to_vec() };
    let (wide, long) = (if version < 3 { 4 } else { 8 }, if version == 4 { 8 } else { 4 });
    push(&1_i32.to_le_bytes());
    push(&version.to_le_bytes());
    push(&3_i32.to_le_bytes());
    push(&position(8 + 4 + wide + 4));
    let mut end = push(&2_i32.to_le_bytes());
    let float = if version == 1 { 4 } else { 8 };
    push(&4_i32.to_le_bytes());
    push(&position(end + 4 + wide + long + 3 * (2 * float + long)));
    end = push(&integer(3));
    for (x, y, label) in [(0.5, 0.0, -1), (1.0, 0.25, 2), (0.0, 1.0, 3)] {
        push(&real(x));
        push(&real(y));
        end = push(&integer(label));
    }
    push(&6_i32.to_le_bytes());
    push(&position(end + 4 + wide + long + 4 * long));
    for number in [1, 1, 2, 3, 7] {
        push(&integer(number));
    }
    push(&54_i32.to_le_bytes());
    push(&position(0));
    file
}

#[test]
fn binary_files_of_all_versions() {
    for version in 1..=4 {
        for big_endian in [false, true] {
            let mesh = read(binary(version, big_endian).as_slice(), "a.meshb").unwrap().mesh;
            assert_eq!(mesh.points, [[0.5, 0.0, 0.0], [1.0, 0.25, 0.0], [0.0, 1.0, 0.0]], "{version}");
            assert_eq!((mesh.point_labels, mesh.triangles), (vec![-1, 2, 3], vec![[0, 1, 2]]));
            assert_eq!(mesh.triangle_labels, [7]);
        }
    }
    let own = Mesh {
        points: vec![[0.5, 0.0, 0.0], [1.0, 0.25, 0.0], [0.0, 1.0, 0.0]],
        point_labels: vec![-1, 2, 3],
        triangles: vec![[0, 1, 2]],
        triangle_labels: vec![7],
        ..Mesh::default()
    };
    assert_eq!(written(&own, Form::Binary), binary(2, false));
}

#[test]
fn damaged_binary_files() {
    let message = |at: usize, number: i32| {
        let mut file = binary(2, false);
        file[at..at + 4].copy_from_slice(&number.to_le_bytes());
        read(file.as_slice(), "a.meshb").unwrap_err().to_string()
    };
    for (at, number, expected) in [
        (28, 2, "a.meshb, byte 72: Vertices ends here, and the file says that the next section begins at byte 92"),
        (28, i32::MAX, "a.meshb, byte 128: the file ends in row 5 of 2147483647 of Vertices"),
        (28, -1, "a.meshb, byte 32: '-1' is out of range (the head of Vertices)"),
        (104, 4, "a.meshb, byte 108: vertex 4 does not exist: the file lists 3"),
        (104, 0, "a.meshb, byte 108: vertex 0 does not exist (row 1 of 1 of Triangles)"),
        (16, 4, "a.meshb, byte 20: Dimension 4, where 2 or 3 is expected"),
        (20, 8, "a.meshb, byte 36: vertex 0 does not exist (row 1 of 3 of Tetrahedra)"),
    ] {
        let message = message(at, number);
        assert!(message.starts_with(expected) || message.contains(expected), "{message}");
    }
    let whole = binary(2, false);
    for length in 0..whole.len() - 8 {
        assert!(read(&whole[..length], "a.meshb").is_err(), "{length}");
    }
}

#[test]
fn other_sections_are_passed_over() {
    let body = "Normals 2 0 0 1\n-1.e0 0 .5\nRidges 1 1\nQuadrilaterals\n0\nFuture\n9 9\nEDGES 1 1 2 4\nEnd\nrest";
    let mesh = read(format!("{HEAD}{body}").as_bytes(), "a.mesh").unwrap().mesh;
    assert_eq!(mesh.point(2), voronaut::geometry::Point::new(0.0, 1.0));
    assert_eq!((mesh.edges, mesh.edge_labels), (vec![[0, 1]], vec![4]));
    assert_eq!(mesh.point_labels, [1, 2, 3]);
}

const CUBE: &str = "MeshVersionFormatted 2 Dimension 3 Vertices 9 0 0 0 1 1 0 0 1 1 1 0 1 0 1 0 1 0 0 1 1 1 0 1 1 \
                    1 1 1 1 0 1 1 1 5 5 5 5\n";

#[test]
fn quadrilaterals_are_cut_behind_the_triangles() {
    let body =
        "RequiredQuadrilaterals 1 2 Quadrilaterals 2 2 3 4 1 8 5 6 7 8 9 Triangles 1 1 2 6 7 RequiredTriangles 1 1";
    let found = read(format!("{CUBE}{body}").as_bytes(), "a.mesh").unwrap();
    let mesh = found.mesh;
    assert_eq!(mesh.triangles, [[0, 1, 5], [2, 3, 0], [2, 0, 1], [4, 5, 6], [4, 6, 7]]);
    assert_eq!((mesh.triangle_labels, mesh.required_triangles), (vec![7, 8, 8, 9, 9], vec![0, 3, 4]));
    assert!(found.notes.is_empty());
}

#[test]
fn volumes_are_left_out_beside_triangles_and_have_a_boundary_without() {
    let cells = "Hexahedra 1 1 2 3 4 5 6 7 8 3 Tetrahedra 1 5 6 7 9 4 RequiredTetrahedra 1 1 ";
    let found = read(format!("{CUBE}{cells}Triangles 1 1 2 3 7 End").as_bytes(), "a.mesh").unwrap();
    assert_eq!((found.mesh.triangles, found.mesh.points.len()), (vec![[0, 1, 2]], 9));
    let told = "1 tetrahedron, 1 hexahedron left out: the surface is the 1 triangle that the file lists";
    assert_eq!(found.notes, [told]);
    let found = read(format!("{CUBE}{cells}").as_bytes(), "a.mesh").unwrap();
    assert_eq!(found.mesh.triangles.len(), 16);
    assert_eq!(found.mesh.triangle_labels.iter().filter(|label| **label == 3).count(), 12);
    assert!(found.notes[0].starts_with("of 1 tetrahedron, 1 hexahedron the boundary was taken"));
}

#[test]
fn triangles_may_come_before_vertices() {
    let text = "MeshVersionFormatted 1 Dimension 3 Triangles 1 3 2 1 6 Vertices 3 0 0 0 0 1 0 0 0 0 1 0 0";
    assert_eq!(read(text.as_bytes(), "a.mesh").unwrap().mesh.triangles, [[2, 1, 0]]);
}

#[test]
fn errors_say_what_and_where() {
    for (body, expected) in [
        ("Triangles 1\n1 2 4 0", "a.mesh:10: vertex 4 does not exist: the file lists 3"),
        ("Triangles 1\n1 2 0 0", "a.mesh:10: vertex 0 does not exist (row 1 of 1 of Triangles)"),
        ("Triangles 1\n1 2 -3 0", "a.mesh:10: '-3' is out of range (row 1 of 1 of Triangles)"),
        ("Edges 1\n1 2 0.5", "a.mesh:10: '0.5' is not a whole number (row 1 of 1 of Edges)"),
        ("Edges 1\n1 99999999999 0", "a.mesh:10: '99999999999' is out of range (row 1 of 1 of Edges)"),
        ("Edges\n1\n1 2 0\nRequiredEdges\n1\n2", "a.mesh:14: edge 2 does not exist: the file lists 1"),
        (
            "Triangles 1000000000000000000\n1 2 3 0\n",
            "a.mesh:10: the text ends in row 2 of 1000000000000000000 of Triangles",
        ),
        ("Triangles 1e18", "a.mesh:9: '1e18' is not a whole number (the head of Triangles)"),
        ("Triangles", "a.mesh:9: the text ends in the head of Triangles"),
        ("Triangles 1\n1 2 3 0\n1 2 3 0", "a.mesh:11: '1' where the next section should begin: Triangles is longer"),
        ("Triangles 2\n1 2 3 0\nEnd", "a.mesh:11: 'End' is not a whole number (row 2 of 2 of Triangles)"),
        ("Vertices 0", "a.mesh:9: a second section Vertices"),
        ("Tetrahedra 1\n1 2 3 4 0", "a.mesh:10: vertex 4 does not exist: the file lists 3"),
        ("Hexahedra 1\n1 2 3 1 2 3 1", "a.mesh:10: the text ends in row 1 of 1 of Hexahedra"),
        (
            "Quadrilaterals 1\n1 2 3 3 0\nRequiredQuadrilaterals 1 2",
            "a.mesh:11: quadrilateral 2 does not exist: the file lists 1",
        ),
    ] {
        let message = message(body);
        assert!(message.contains(expected), "{message}");
    }
}

#[test]
fn bad_beginnings() {
    for (text, expected) in [
        ("", "a.mesh:1: the text ends in the head of MeshVersionFormatted"),
        ("solid cube", "a.mesh:1: the file begins with 'solid', not with MeshVersionFormatted"),
        ("MeshVersionFormatted 9", "a.mesh:1: MeshVersionFormatted 9 does not exist"),
        ("MeshVersionFormatted 2\nDimension 4", "a.mesh:2: Dimension 4, where 2 or 3 is expected"),
        ("MeshVersionFormatted 2\nVertices 1", "a.mesh:2: Vertices comes before Dimension"),
        ("MeshVersionFormatted 2\nDimension 2\nEnd", "a.mesh:3: the file has no section Vertices"),
        (
            "MeshVersionFormatted 2\nDimension 2\nVertices 1\n0 nan 0",
            "a.mesh:4: 'nan' is not a finite number (row 1 of 1 of Vertices)",
        ),
        (
            "MeshVersionFormatted 2\nDimension 3\nVertices 2\n0 0 0\n1 1 0\n",
            "a.mesh:5: the text ends in row 2 of 2 of Vertices",
        ),
    ] {
        let error = read(text.as_bytes(), "a.mesh").unwrap_err();
        assert!(error.to_string().contains(expected), "{error}");
        assert!(!error.help().is_empty());
    }
}
