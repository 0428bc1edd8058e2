//! Files that are written and read back, files of other programs, and damaged ones.

use super::*;
use crate::codec::Form;
use crate::{Field, Fields};
use voronaut::mesh::{Mesh, SolutionValues};

/// One square in two regions: labelled points, curves and surfaces, two views. Written by Gmsh 4.15.2 through its Python module (but for
/// 4.0 binary, which Gmsh does not write).
const FOUR_ONE: &[u8] = include_bytes!("../../tests/data/gmsh/4.1.msh");
const FOUR_ONE_BINARY: &[u8] = include_bytes!("../../tests/data/gmsh/4.1-binary.msh");
/// With `Mesh.SaveParametric`, without views.
const FOUR_ONE_PARAMETRIC: &[u8] = include_bytes!("../../tests/data/gmsh/4.1-parametric.msh");
const FOUR: &[u8] = include_bytes!("../../tests/data/gmsh/4.0.msh");
const TWO: &[u8] = include_bytes!("../../tests/data/gmsh/2.2.msh");
const TWO_BINARY: &[u8] = include_bytes!("../../tests/data/gmsh/2.2-binary.msh");
/// Two triangles and an edge, written by meshio 5.3.5.
const FOUR_BINARY: &[u8] = include_bytes!("../../tests/data/gmsh/4.0-binary.msh");

const EVERY: [(Version, Form); 4] = [
    (Version::V4_1, Form::Text),
    (Version::V4_1, Form::Binary),
    (Version::V2_2, Form::Text),
    (Version::V2_2, Form::Binary),
];

/// Sorted by label, as files are.
fn sample(z: f64) -> Mesh {
    Mesh {
        points: vec![[0.1, -1e-300, 0.0], [1.0 / 3.0, 0.0, z], [0.0, 1e22, -0.0], [1.0, 1.0, 0.0], [5.0, 5.0, 0.0]],
        point_labels: vec![1, -2, 0, 7, 0],
        triangles: vec![[3, 2, 1], [0, 1, 2], [0, 2, 3]],
        triangle_labels: vec![i32::MIN, 0, 1],
        edges: vec![[0, 1], [2, 0], [1, 3]],
        edge_labels: vec![0, 8, i32::MAX],
        corners: vec![1, 2],
        required_points: vec![0, 2],
        ridges: vec![1, 2],
        required_edges: vec![2],
        required_triangles: vec![1],
        periodic: Vec::new(),
        curved: None,
    }
}

fn fields(is_planar: bool) -> Fields {
    let field = |name: &str, values| Field { name: name.into(), values };
    let vector = |components, count: usize| {
        let numbers = (1..).take(count * components).map(|i: u32| f64::from(i) / 3.0).collect();
        SolutionValues::Vector { components, numbers }
    };
    let tensors = if is_planar {
        SolutionValues::Tensor(vec![[1.0, 0.1, 2.0]; 5])
    } else {
        SolutionValues::Tensor3(vec![[1.0, 0.1, 2.0, 0.3, 0.4, 3.0]; 5])
    };
    let vertices = vec![
        field("size, # 1", SolutionValues::Scalar(vec![0.1, 1e-300, 3.0, 4.0, 5.0])),
        field("v", vector(if is_planar { 2 } else { 3 }, 5)),
        field("metric", tensors),
    ];
    Fields {
        vertices,
        triangles: vec![field("e", SolutionValues::Scalar(vec![0.25, 0.5, 0.75])), field("w", vector(3, 3))],
    }
}

fn written(mesh: &Mesh, fields: &Fields, version: Version, form: Form) -> Vec<u8> {
    let mut out = Vec::new();
    write(mesh, fields, version, form, &mut out).unwrap();
    out
}

fn bits(mesh: &Mesh) -> Vec<[u64; 3]> {
    mesh.points.iter().map(|point| point.map(f64::to_bits)).collect()
}

fn message(file: &[u8]) -> String {
    let error = read(file, "a.msh").unwrap_err();
    assert!(!error.help().is_empty(), "{error}");
    error.to_string()
}

#[test]
fn what_is_written_reads_back() {
    for (z, (version, form)) in [0.0, 2.5].into_iter().flat_map(|z| EVERY.map(|every| (z, every))) {
        let (mut mesh, fields) = (sample(z), fields(z == 0.0));
        let again = read(written(&mesh, &fields, version, form).as_slice(), "a.msh").unwrap();
        assert_eq!(bits(&again.mesh), bits(&mesh));
        if version == Version::V2_2 {
            (mesh.ridges, mesh.required_edges, mesh.required_triangles) = Default::default();
        }
        assert_eq!(again, Document { fields, ..mesh.into() }, "{version:?} {form:?}");
    }
}

#[test]
fn elements_are_sorted_by_label_with_their_values() {
    let mesh = Mesh {
        points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        triangles: vec![[0, 1, 2], [1, 2, 0], [2, 0, 1]],
        triangle_labels: vec![4, 2, 4],
        ..Mesh::default()
    };
    let values = SolutionValues::Vector { components: 4, numbers: (0..12).map(f64::from).collect() };
    let fields = Fields { triangles: vec![Field { name: "a \"b\"".into(), values }], ..Fields::default() };
    for (version, form) in EVERY {
        let again = read(written(&mesh, &fields, version, form).as_slice(), "a.msh").unwrap();
        assert_eq!(again.mesh.triangles, [[1, 2, 0], [0, 1, 2], [2, 0, 1]]);
        assert_eq!((again.mesh.triangle_labels, again.mesh.point_labels), (vec![2, 4, 4], vec![0; 3]));
        let names: Vec<_> = again.fields.triangles.iter().map(|field| field.name.as_str()).collect();
        assert_eq!(names, ["a 'b'_0", "a 'b'_1", "a 'b'_2", "a 'b'_3"]);
        assert_eq!(again.fields.triangles[3].values, SolutionValues::Scalar(vec![7.0, 3.0, 11.0]));
    }
}

#[test]
fn meshes_with_little_in_them() {
    let points = Mesh { points: vec![[0.5; 3], [1.0; 3]], point_labels: vec![0, 0], ..Mesh::default() };
    let labels = Mesh { point_labels: vec![-3, 2], ..points.clone() };
    let edges = Mesh { edges: vec![[0, 1]], edge_labels: vec![0], ..points.clone() };
    for mesh in [Mesh::default(), points, labels, edges] {
        for (version, form) in EVERY {
            let again = read(written(&mesh, &Fields::default(), version, form).as_slice(), "a.msh").unwrap();
            assert_eq!(again.mesh, mesh, "{version:?} {form:?}");
        }
    }
}

#[test]
fn a_file_as_it_is_written() {
    let mesh = Mesh {
        points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.5, 0.0]],
        triangles: vec![[0, 1, 2]],
        corners: vec![1],
        ..Mesh::default()
    };
    let fields = Fields {
        vertices: vec![Field { name: "m".into(), values: SolutionValues::Tensor(vec![[1.0, 0.5, 2.0]; 3]) }],
        triangles: vec![Field { name: "e".into(), values: SolutionValues::Scalar(vec![2.5]) }],
    };
    let names =
        "$PhysicalNames\n3\n0 1 \"vertex label 0\"\n0 2 \"corners\"\n2 1 \"triangle label 0\"\n$EndPhysicalNames\n";
    let data = "$NodeData\n1\n\"m\"\n1\n0\n3\n0\n9\n3\n1 1 0.5 0 0.5 2 0 0 0 0\n2 1 0.5 0 0.5 2 0 0 0 0\n3 1 0.5 0 0.5 2 0 0 0 0\n\
                $EndNodeData\n$ElementData\n1\n\"e\"\n1\n0\n3\n0\n1\n";
    let four = format!(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n{names}$Entities\n1 0 1 0\n1 1 0 0 2 1 2\n1 0 0 0 1 1.5 0 1 1 0\n$EndEntities\n\
         $Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1.5 0\n$EndNodes\n\
         $Elements\n2 2 1 2\n2 1 2 1\n1 1 2 3\n0 1 15 1\n2 2\n$EndElements\n{data}2\n1 2.5\n2 2.5\n$EndElementData\n"
    );
    let two = format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n{names}$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1.5 0\n$EndNodes\n\
         $Elements\n3\n1 2 2 1 1 1 2 3\n2 15 2 1 1 2\n3 15 2 2 1 2\n$EndElements\n{data}1\n1 2.5\n$EndElementData\n"
    );
    assert_eq!(String::from_utf8(written(&mesh, &fields, Version::V4_1, Form::Text)).unwrap(), four);
    assert_eq!(String::from_utf8(written(&mesh, &fields, Version::V2_2, Form::Text)).unwrap(), two);
}

#[test]
fn files_of_gmsh() {
    let truth = read(FOUR_ONE, "4.1.msh").unwrap();
    let mesh = &truth.mesh;
    assert_eq!((mesh.points.len(), mesh.edges.len(), mesh.triangles.len()), (11, 10, 12));
    assert_eq!((&mesh.corners, &mesh.point_labels), (&vec![0], &[vec![7], vec![0; 10]].concat()));
    assert_eq!(mesh.edge_labels, [11, 11, 11, 11, 12, 12, 12, 12, 12, 12]);
    assert_eq!(mesh.triangle_labels, [[21; 6], [22; 6]].concat());
    assert_eq!((mesh.triangles[0], mesh.edges[0]), ([5, 8, 9], [0, 4]));
    assert_eq!(mesh.points[4][0].to_bits(), 0.499_999_999_998_694_3_f64.to_bits());
    let [nodal, elemental] = [&truth.fields.vertices, &truth.fields.triangles];
    assert_eq!((nodal[0].name.as_str(), nodal.len(), elemental.len()), ("u v", 1, 1));
    assert_eq!(nodal[0].values, SolutionValues::Scalar((0..11).map(f64::from).collect()));
    assert_eq!((elemental[0].name.as_str(), elemental[0].values.row(5)), ("el", [5.0, 0.0, 1.0].as_slice()));
    for (file, same_bits, has_fields) in [
        (FOUR_ONE_BINARY, false, true),
        (FOUR, true, true),
        (TWO, true, true),
        (TWO_BINARY, false, true),
        (FOUR_ONE_PARAMETRIC, true, false),
    ] {
        let mut found = read(file, "a.msh").unwrap();
        if !same_bits {
            let mut pairs = found.mesh.points.iter().flatten().zip(mesh.points.iter().flatten());
            assert!(pairs.all(|(x, y)| (x - y).abs() < 1e-15));
            found.mesh.points.clone_from(&mesh.points);
        }
        if !has_fields {
            assert_eq!(std::mem::replace(&mut found.fields, truth.fields.clone()), Fields::default());
        }
        assert_eq!(found, truth);
    }
    let four = read(FOUR_BINARY, "a.msh").unwrap().mesh;
    assert_eq!((four.triangles, four.edges), (vec![[0, 1, 2], [0, 2, 3]], vec![[0, 1]]));
    assert_eq!(four.points[3].map(f64::to_bits), [0.0_f64, 1.0, 0.5].map(f64::to_bits));
}

/// Tags with gaps and out of order, two blocks with parameters, a quadrangle, an entity without and one with several groups.
const FOUR_ONE_HEAD: &str = "$Comments\nwhatever # \"\n$EndComments\n$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n\
                             2 5 \"label 7\"\n$EndPhysicalNames\n$Entities\n0 1 1 0\n3 0 0 0 0 0 0 0 0\n\
                             9 0 0 0 inf nan 0 2 -5 6 1 -3\n$EndEntities\n";
const NODES: &str = "$Nodes\n2 5 3 70\n1 3 1 2\n70\n3\n0 0 0 0.5\n1 0 0 0.25\n2 9 1 3\n10\n11\n9\n1 1 0 0 0\n0 1 0 0 0\n8 8 0 0 0\n$EndNodes\n";
const ELEMENTS: &str = "$Elements\n2 3 2 90\n2 9 3 1\n90 70 3 10 11\n1 3 1 2\n2 70 3\n5 10 3\n$EndElements\n";

#[test]
fn sparse_tags_quadrangles_and_data_of_some() {
    let skipped = "$Periodic\n1\n1 1 2\n0\n1\n1 2\n$EndPeriodic\n$ElementNodeData\n$$ 1\n$EndElementNodeData\n";
    let nodal =
        "$NodeData\n2\n\"u\"\n\"scheme\"\n1\n0.5\n4\n3\n3\n4\n0\n11 1 2 0\n70 3 4 0\n3 5 6 0\n10 7 8 0\n$EndNodeData\n";
    let elemental = "$ElementData\n1\n\"e\"\n0\n3\n0\n1\n2\n90 4\n2 1\n$EndElementData\n\
                     $ElementData\n1\n\"e\"\n0\n3\n1\n1\n1\n90 5\n$EndElementData\n\
                     $ElementData\n1\n\"edges\"\n0\n3\n1\n1\n1\n2 5\n$EndElementData\n";
    let text = [FOUR_ONE_HEAD, NODES, skipped, ELEMENTS, nodal, elemental].concat();
    let Document { mesh, fields, .. } = read(text.as_bytes(), "a.msh").unwrap();
    assert_eq!((mesh.points.len(), mesh.points[2], mesh.points[4]), (5, [1.0, 1.0, 0.0], [8.0, 8.0, 0.0]));
    assert_eq!((mesh.triangles, mesh.triangle_labels), (vec![[0, 1, 2], [0, 2, 3]], vec![5, 5]));
    assert_eq!((mesh.edges, mesh.edge_labels), (vec![[0, 1], [2, 1]], vec![3, 3]));
    let numbers = vec![3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 1.0, 2.0, 0.0, 0.0];
    assert_eq!(fields.vertices[0].values, SolutionValues::Vector { components: 2, numbers });
    let found: Vec<_> = fields.triangles.iter().map(|field| (field.name.as_str(), field.values.row(1))).collect();
    assert_eq!(found, [("e", [4.0].as_slice()), ("e_1", &[5.0])]);
}

#[test]
fn volumes_have_their_boundary_where_there_are_no_triangles() {
    let points = "1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -1\n6 9 9 9\n";
    let head = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n6\n{points}$EndNodes\n$Elements\n");
    let data = "$ElementData\n1\n\"e\"\n0\n3\n0\n1\n2\n1 0.5\n2 1.5\n$EndElementData\n";
    let cells = "1 4 2 7 1 1 2 3 4\n2 4 2 3 1 2 1 3 5\n";
    let found = read(format!("{head}2\n{cells}$EndElements\n{data}").as_bytes(), "a.msh").unwrap();
    assert_eq!(found.mesh.triangle_labels, [7, 7, 7, 3, 3, 3, 3]);
    let values = SolutionValues::Scalar(vec![0.5, 0.5, 0.5, 1.5, 1.5, 1.5, 1.5]);
    assert_eq!((found.mesh.points.len(), &found.fields.triangles[0].values), (6, &values));
    assert_eq!(found.notes, ["of 2 tetrahedra the boundary was taken, for the file lists no triangles"]);
    let found = read(format!("{head}3\n{cells}3 2 2 4 1 1 2 3\n$EndElements\n").as_bytes(), "a.msh").unwrap();
    assert_eq!((found.mesh.triangles, found.mesh.triangle_labels), (vec![[0, 1, 2]], vec![4]));
    assert_eq!(found.notes, ["2 tetrahedra left out: the surface is the 1 triangle that the file lists"]);
    let (from, to) = ("2 4 2 3 1 2 1 3 5", "2 4 2 3 1 2 1 3 8");
    let error = read(format!("{head}2\n{cells}$EndElements\n").replace(from, to).as_bytes(), "a.msh").unwrap_err();
    assert!(error.to_string().starts_with("a.msh:16: node 8 does not exist"), "{error}");
}

#[test]
fn labels_of_version_2() {
    let text = "$MeshFormat\n2 0 8\n$EndMeshFormat\n$Nodes\n3\n1 0 0 0\n2 1 0 0\n4 0 1 0\n$EndNodes\n$Elements\n7\n\
                1 2 2 6 1 1 2 4\n2 2 2 5 1 1 2 4\n3 2 2 0 9 1 2 4\n4 2 0 1 2 4\n5 2 4 -3 9 2 1 1 2 4\n6 2 2 -3 9 1 2 4\n\
                7 15 1 4 2\n$EndElements\n";
    let mesh = read(text.as_bytes(), "a.msh").unwrap().mesh;
    assert_eq!(mesh.triangle_labels, [6, 9, 0, -3, -3]);
    assert_eq!((mesh.point_labels, mesh.corners), (vec![0, 4, 0], vec![1]));
}

/// A binary file of one triangle with a value.
fn binary(version: Version, big_endian: bool) -> Vec<u8> {
    let order = |mut bytes: Vec<u8>| {
        if big_endian {
            bytes.reverse();
        }
        bytes
    };
    let int = |i: i32| order(i.to_le_bytes().into());
    let size = |i: u64| order(i.to_le_bytes().into());
    let number = |x: f64| order(x.to_le_bytes().into());
    let point = [0.5, -0.25, 1e300];
    let points: Vec<u8> = point.into_iter().flat_map(|x| [number(x), number(1.0), number(x)].concat()).collect();
    let ints = |numbers: &[i32]| numbers.iter().flat_map(|&i| int(i)).collect::<Vec<u8>>();
    let sizes = |numbers: &[u64]| numbers.iter().flat_map(|&i| size(i)).collect::<Vec<u8>>();
    let body = match version {
        Version::V4_1 => [
            b"$Entities\n".to_vec(),
            sizes(&[0, 0, 1, 0]),
            int(2),
            [number(0.0), number(f64::NAN)].concat().repeat(3),
            size(1),
            int(30),
            size(1),
            int(-4),
            b"\n$EndEntities\n$Nodes\n".to_vec(),
            sizes(&[1, 3, 1, 3]),
            ints(&[2, 2, 0]),
            sizes(&[3, 7, 8, 9]),
            points,
            b"\n$EndNodes\n$Elements\n".to_vec(),
            sizes(&[1, 1, 5, 5]),
            ints(&[2, 2, 2]),
            sizes(&[1, 5, 9, 8, 7]),
        ]
        .concat(),
        Version::V2_2 => [
            b"$Nodes\n3\n".to_vec(),
            (7..).zip(points.chunks(24)).flat_map(|(tag, point)| [&int(tag), point].concat()).collect(),
            b"\n$EndNodes\n$Elements\n1\n".to_vec(),
            ints(&[2, 1, 3, 5, 30, 2, 0, 9, 8, 7]),
        ]
        .concat(),
    };
    let name = if version == Version::V4_1 { "4.1" } else { "2.2" };
    let data = "\n$EndElements\n$Junk\n\0\n\n$EndJunk\n$ElementData\n1\n\"e\"\n1\n0\n3\n0\n1\n1\n";
    [
        format!("$MeshFormat\n{name} 1 8\n").into_bytes(),
        int(1),
        b"\n$EndMeshFormat\n".to_vec(),
        body,
        data.into(),
        int(5),
        number(2.5),
        b"\n$EndElementData\n".to_vec(),
    ]
    .concat()
}

#[test]
fn binary_files_of_either_order() {
    for (version, big_endian) in
        [(Version::V4_1, false), (Version::V4_1, true), (Version::V2_2, false), (Version::V2_2, true)]
    {
        let Document { mesh, fields, .. } = read(binary(version, big_endian).as_slice(), "a.msh").unwrap();
        assert_eq!(bits(&mesh)[2], [1e300, 1.0, 1e300].map(f64::to_bits));
        assert_eq!((mesh.triangles, mesh.triangle_labels), (vec![[2, 1, 0]], vec![30]));
        assert_eq!(fields.triangles, [Field { name: "e".into(), values: SolutionValues::Scalar(vec![2.5]) }]);
    }
}

#[test]
fn nine_numbers_are_a_tensor_if_they_are_symmetric() {
    let mesh = Mesh { points: vec![[0.0; 3]], ..Mesh::default() };
    let text = String::from_utf8(written(&mesh, &Fields::default(), Version::V4_1, Form::Text)).unwrap();
    for (numbers, expected) in [
        ("1 2 0 2 3 -0 0 0 0", SolutionValues::Tensor(vec![[1.0, 2.0, 3.0]])),
        ("1 2 0 2 3 0 0 0 4", SolutionValues::Tensor3(vec![[1.0, 2.0, 3.0, 0.0, 0.0, 4.0]])),
        ("1 2 3 2 4 5 3 5 6", SolutionValues::Tensor3(vec![[1.0, 2.0, 4.0, 3.0, 5.0, 6.0]])),
        ("1 2 3 4 5 6 7 8 9", SolutionValues::Vector { components: 9, numbers: (1..10).map(f64::from).collect() }),
    ] {
        let file = format!("{text}$NodeData\n1\n\"m\"\n0\n3\n0\n9\n1\n1 {numbers}\n$EndNodeData\n");
        assert_eq!(read(file.as_bytes(), "a.msh").unwrap().fields.vertices[0].values, expected);
    }
}

#[test]
fn errors_say_what_and_where() {
    let (head, nodes) = (FOUR_ONE_HEAD.len(), FOUR_ONE_HEAD.len() + NODES.len());
    let text = [FOUR_ONE_HEAD, NODES, ELEMENTS].concat();
    let with = |from: &str, to: &str| {
        assert!(text[head..].contains(from), "{from}");
        message(format!("{}{}", &text[..head], text[head..].replacen(from, to, 1)).as_bytes())
    };
    for (from, to, expected) in [
        ("2 5 3 70", "2 6 3 70", "a.msh:29: Nodes announces 6, and its blocks hold 5"),
        ("2 5 3 70", "2 4 3 70", "a.msh:23: a block of 3 behind 2 others, where Nodes announces 4 in all"),
        ("2 5 3 70", "1 2 3 70", "a.msh:23: '2' where $EndNodes should be: Nodes is longer than announced"),
        ("2 5 3 70", "3 5 3 70", "a.msh:30: '$EndNodes' is not a whole number (the head of Nodes)"),
        ("1 3 1 2\n70", "1 3 1 99999999999999\n70", "a.msh:18: a block of 99999999999999 behind 0 others, where Nodes"),
        ("1 3 1 2\n70", "4 3 1 2\n70", "a.msh:18: an entity of dimension 4 (the head of Nodes)"),
        ("1 0 0 0.25", "1 nan 0 0.25", "a.msh:22: 'nan' is not a finite number (row 2 of 5 of Nodes)"),
        ("10\n11\n9\n", "10\n11\n3\n", "a.msh:29: node 3 is there twice (rows 2 and 5 of Nodes)"),
        ("2 3 2 90", "2 2 2 90", "a.msh:35: a block of 2 behind 1 others, where Elements announces 2 in all"),
        ("90 70 3 10 11", "90 70 3 10 12", "a.msh:34: node 12 does not exist (row 1 of 3 of Elements)"),
        ("90 70 3 10 11", "90 70 3 10 -1", "a.msh:34: '-1' is out of range (row 1 of 3 of Elements)"),
        ("5 10 3", "90 10 3", "a.msh:37: element 90 is there twice (rows 1 and 3 of Elements)"),
        ("1 3 1 2\n2 70", "1 3 99 2\n2 70", "not supported: elements of type 99 (the head of Elements; a.msh:35)"),
        (
            "2 9 3 1\n90 70 3 10 11",
            "2 9 8 1\n90 70 3 10",
            "not supported: 1 curved edges without curved triangles in a.msh",
        ),
        ("5 10 3", "5 10 3\n6 10 3", "a.msh:38: '6' where $EndElements should be: Elements is longer than announced"),
        ("$EndElements\n", "", "a.msh:37: the file ends without $EndElements"),
        ("$EndElements\n", "$EndElements\njunk", "a.msh:39: 'junk' where a section such as $Nodes should begin"),
        ("$EndElements\n", "$EndElements\n$Future\n1\n", "a.msh:39: $Future, which begins here, has no $EndFuture"),
        ("$EndElements\n", "$EndElements\n$Nodes\n", "a.msh:39: a second section Nodes"),
        ("$Nodes", "$Elements", "a.msh:16: Elements comes before Nodes"),
        ("$Nodes", "$PartitionedEntities", "not supported: a mesh in partitions of Gmsh's format (a.msh:16)"),
    ] {
        let message = with(from, to);
        assert!(message.starts_with(expected), "{message}");
    }
    assert_eq!(message(&text.as_bytes()[..nodes - 18]), "a.msh:29: the file ends in row 5 of 5 of Nodes");
}

#[test]
fn errors_in_values() {
    let with = |rest: &str| message([FOUR_ONE_HEAD, NODES, ELEMENTS, "$NodeData\n", rest].concat().as_bytes());
    for (rest, expected) in [
        ("1\n\"u\"\n0\n3\n0\n1\n1\n4 1", "a.msh:47: node 4 does not exist (row 1 of 1 of NodeData)"),
        ("1\n\"u\"\n0\n3\n0\n1\n2\n3 1\n3 2", "a.msh:48: node 3 has two values (row 2 of 2 of NodeData)"),
        ("1\n\"u\"\n0\n3\n0\n1\n2\n3 1\n9 2\n$EndNodeData", "a.msh:39: NodeData 'u' has no values on 3 vertices of"),
        ("1\n\"u\"\n0\n3\n0\n1\n1\n3 inf", "a.msh:47: 'inf' is not a finite number (row 1 of 1 of NodeData)"),
        ("1\n\"u\"\n0\n3\n0\n1\n99999999999\n3 1", "a.msh:47: the file ends in row 2 of 99999999999 of NodeData"),
        ("1\n\"u\"\n0\n3\n0\n0\n1\n3 1", "a.msh:46: NodeData 'u' has values of 0 numbers"),
        ("1\n\"u\"\n0\n3\n0\n1\n-1\n3 1", "a.msh:46: NodeData 'u' has values of 1 numbers, or a negative number of"),
        (
            "1\n\"u\"\n0\n3\n0\n4000000000\n1\n",
            "not supported: NodeData 'u' of 4000000000 numbers per value (a.msh:46)",
        ),
        ("0\n0\n2\n0\n1\n", "a.msh:44: NodeData '' has fewer than three integer tags"),
        ("x", "a.msh:40: 'x' is not a whole number (the head of NodeData)"),
    ] {
        let message = with(rest);
        assert!(message.starts_with(expected), "{message}");
    }
    let elements = format!(
        "{FOUR_ONE_HEAD}{NODES}$NodeData\n0\n0\n3\n0\n1\n5\n3 1\n9 1\n10 1\n11 1\n70 1\n$EndNodeData\n{ELEMENTS}"
    );
    assert!(message(elements.as_bytes()).starts_with("a.msh:44: Elements comes behind the values on them"));
}

#[test]
fn bad_beginnings() {
    for (text, expected) in [
        ("", "a.msh:1: the file has no section MeshFormat"),
        ("solid cube", "a.msh:1: 'solid' where a section such as $Nodes should begin"),
        ("$NOD\n1\n", "not supported: version 1 of Gmsh's format (a.msh:1)"),
        ("$MeshFormat\n3 0 8\n", "not supported: version 3 of Gmsh's format (a.msh:2)"),
        ("$MeshFormat\nx 0 8\n", "a.msh:2: 'x' is not a version of the format"),
        ("$MeshFormat\n4.1 2 8\n", "a.msh:2: form 2, where 0 (text) or 1 (binary) is expected"),
        ("$MeshFormat\n4.1 1 4\n\u{1}\0\0\0", "a.msh:2: numbers of 4 bytes, where 8 are expected"),
        ("$MeshFormat\n4.1 1 8\n\u{1}\u{1}\0\0", "a.msh, byte 20: the four bytes [1, 1, 0, 0] are not the number 1"),
        ("$MeshFormat\n4.1 1 8\n\u{1}\0", "a.msh, byte 20: the file ends in the head of MeshFormat"),
        ("$MeshFormat\n4.1 0 8\n", "a.msh:2: the file ends without $EndMeshFormat"),
        ("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", "a.msh:3: the file has no section Nodes"),
        ("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$EndNodes", "a.msh:4: '$EndNodes' where a section such as $Nodes"),
    ] {
        let message = message(text.as_bytes());
        assert!(message.starts_with(expected), "{message}");
    }
}

#[test]
fn damaged_binary_files() {
    let (four, two) = (binary(Version::V4_1, false), binary(Version::V2_2, true));
    let find =
        |file: &[u8], name: &str| file.windows(name.len()).position(|w| w == name.as_bytes()).unwrap() + name.len();
    let with = |file: &[u8], at: usize, bytes: &[u8]| {
        let mut file = file.to_vec();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        message(&file)
    };
    let (nodes, elements) = (find(&four, "$Nodes\n"), find(&four, "$Elements\n"));
    for (at, bytes, expected) in [
        (nodes, (-1_i64).to_le_bytes(), format!("a.msh, byte {}: '-1' is out of range (the head of Nodes)", nodes + 8)),
        (nodes + 8, (1_i64 << 60).to_le_bytes(), "1152921504606846976, and its blocks hold 3".into()),
        (nodes + 44, (1_i64 << 60).to_le_bytes(), format!("a.msh, byte {}: a block of 115292150460684", nodes + 52)),
        (nodes + 76, f64::NAN.to_le_bytes(), format!("a.msh, byte {}: NaN is not a finite number (row 1", nodes + 76)),
        (elements + 60, 6_i64.to_le_bytes(), format!("a.msh, byte {}: node 6 does not exist", elements + 68)),
    ] {
        let message = with(&four, at, &bytes);
        assert!(message.contains(&expected), "{message}");
    }
    let elements = find(&two, "$Elements\n1\n");
    let message = with(&two, elements + 4, &9_i32.to_be_bytes());
    assert_eq!(
        message,
        format!("a.msh, byte {}: a block of 9 behind 0 others, where Elements announces 1 in all", elements + 12)
    );
}

/// A prefix of a file is refused but where it ends with a section; no damage makes the reader panic.
#[test]
fn damaged_files_of_all_versions() {
    let own = EVERY.map(|(version, form)| written(&sample(1.0), &fields(false), version, form));
    let files = [FOUR_ONE, FOUR_ONE_BINARY, FOUR_ONE_PARAMETRIC, FOUR, FOUR_BINARY, TWO, TWO_BINARY];
    for file in files.into_iter().chain(own.iter().map(Vec::as_slice)) {
        let whole = read(file, "a.msh").unwrap();
        let nodes = file.windows(9).position(|window| window == b"$EndNodes").unwrap();
        for length in 0..file.len() {
            let prefix = file[..length].trim_ascii_end();
            let last = prefix.rsplit(|&byte| byte == b'\n').next().unwrap_or_default();
            let found = read(&file[..length], "a.msh");
            let ends_whole = last.starts_with(b"$End") && file[prefix.len()..].starts_with(b"\n");
            assert!(found.is_err() || (ends_whole && length > nodes) || found.unwrap() == whole, "{length}");
            let mut damaged = file.to_vec();
            damaged[length] = damaged[length].wrapping_mul(151).wrapping_add(length as u8 | 1);
            let _ = read(damaged.as_slice(), "a.msh");
        }
    }
}
