//! Files of this writer, of others, by hand, and damaged ones.

use super::*;
use crate::Field;
use voronaut::mesh::SolutionValues;

fn sample(z: f64) -> Document {
    let mesh = Mesh {
        points: vec![[0.1, -1e-300, 0.0], [1.0 / 3.0, 0.0, z], [0.0, 1e22, 0.0], [1.0, 1.0, 0.0]],
        point_labels: vec![1, -2, 0, 7],
        triangles: vec![[0, 1, 2], [3, 2, 1]],
        triangle_labels: vec![5, i32::MIN],
        edges: vec![[0, 1], [2, 0], [3, 1]],
        edge_labels: vec![9, 8, i32::MAX],
        corners: vec![2],
        required_points: vec![0, 3],
        ridges: vec![0, 2],
        required_edges: vec![1],
        required_triangles: vec![1],
        periodic: Vec::new(),
        curved: None,
    };
    let field = |name: &str, values| Field { name: name.into(), values };
    let tensor = |i: f64| [1.0 + i, 0.1 * i, 2.0, 0.5, -0.3, 1e-5 + i];
    let plane = |i: f64| [1.0 + i, 0.1 * i, 2.0];
    let vector = |components: usize| SolutionValues::Vector {
        components,
        numbers: (0..4 * components).map(|i| 0.1 + i as f64).collect(),
    };
    let tensors = SolutionValues::Tensor3([0.0, 1.0, 2.0, 3.0].map(tensor).to_vec());
    let mut vertices = vec![
        field("u", SolutionValues::Scalar(vec![0.1, f64::MIN_POSITIVE, -1e308, 4.0])),
        field("<a & \"b\">'\u{e9}", SolutionValues::Scalar(vec![1.0; 4])),
        field("field_label", SolutionValues::Scalar(vec![0.5; 4])),
        field("wind", vector(3)),
        field("slope", vector(2)),
        field("six", vector(6)),
        field("nine", vector(9)),
        field("stress", tensors),
    ];
    let triangles = vec![
        field("error", SolutionValues::Scalar(vec![0.25, 0.125])),
        field("flux", SolutionValues::Vector { components: 4, numbers: (0..8).map(f64::from).collect() }),
        field("strain", SolutionValues::Tensor3(vec![tensor(0.5), tensor(1.5)])),
    ];
    if z == 0.0 {
        vertices.push(field("metric", SolutionValues::Tensor([0.0, 1.0, 2.0, 3.0].map(plane).to_vec())));
    }
    Document { fields: Fields { vertices, triangles }, ..mesh.into() }
}

type Writer = fn(&Mesh, &Fields, &mut dyn Write) -> io::Result<()>;

const WRITERS: [Writer; 2] = [write_vtu, write_vtp];

fn written(document: &Document, write: Writer) -> Vec<u8> {
    let mut out = Vec::new();
    write(&document.mesh, &document.fields, &mut out).unwrap();
    out
}

#[test]
fn what_is_written_reads_back() {
    for document in [sample(0.0), sample(2.5)] {
        for write in WRITERS {
            assert_eq!(read(written(&document, write).as_slice(), "a").unwrap(), document);
        }
    }
    let points = vec![[1.0, -0.0, 0.0]];
    let bare = Document::from(Mesh { points, point_labels: vec![0], ..Mesh::default() });
    for document in [bare, Document::default()] {
        for write in WRITERS {
            assert_eq!(read(written(&document, write).as_slice(), "a").unwrap(), document);
        }
    }
}

#[test]
fn arrays_lie_where_the_head_says() {
    let file = written(&sample(0.0), write_vtu);
    let raw = file.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
    let head = std::str::from_utf8(&file[..raw]).unwrap();
    let array = |name: &str| {
        let offset = head.split(&format!("Name=\"{name}\"")).last().unwrap().split("offset=\"").nth(1).unwrap();
        let offset: usize = offset.split('"').next().unwrap().parse().unwrap();
        let size = u64::from_le_bytes(file[raw + offset..][..8].try_into().unwrap()) as usize;
        &file[raw + offset + 8..][..size]
    };
    let bytes = |numbers: &[i64]| numbers.iter().flat_map(|x| x.to_le_bytes()).collect::<Vec<_>>();
    let labels: Vec<u8> = [5, i32::MIN, 9, 8, i32::MAX].iter().flat_map(|x| x.to_le_bytes()).collect();
    assert_eq!(array("label"), labels);
    assert_eq!(array("Points")[24..32], (1.0_f64 / 3.0).to_le_bytes());
    assert_eq!(array("connectivity"), bytes(&[0, 1, 2, 3, 2, 1, 0, 1, 2, 0, 3, 1]));
    assert_eq!(array("offsets"), bytes(&[3, 6, 8, 10, 12]));
    assert_eq!(array("types"), [5, 5, 3, 3, 3]);
    assert_eq!(array("required"), [0, 1, 0, 1, 0]);
    assert_eq!(array("error")[..16], [0.25_f64.to_le_bytes(), 0.125_f64.to_le_bytes()].concat());
    assert!(array("error")[16..].as_chunks().0.iter().all(|&number| f64::from_le_bytes(number).is_nan()));
    // Tensors are rows of the matrix.
    let metric: Vec<f64> = array("metric")[72..144].as_chunks().0.iter().map(|&x| f64::from_le_bytes(x)).collect();
    assert_eq!(metric.map_bits(), [2.0, 0.1, 0.0, 0.1, 2.0, 0.0, 0.0, 0.0, 0.0].map_bits());
    assert!(file.ends_with(b"</VTKFile>\n"));
}

trait Bits {
    fn map_bits(&self) -> Vec<u64>;
}

impl Bits for [f64] {
    fn map_bits(&self) -> Vec<u64> {
        self.iter().map(|x| x.to_bits()).collect()
    }
}

#[test]
fn files_of_vtk_and_meshio_in_all_encodings() {
    let files: [(&str, &[u8]); 7] = [
        ("binary zlib", include_bytes!("../../tests/data/vtk/vtk-binary-zlib-32-big.vtu")),
        ("base64 zlib", include_bytes!("../../tests/data/vtk/vtk-appended-base64-zlib-64.vtp")),
        ("raw zlib", include_bytes!("../../tests/data/vtk/vtk-appended-raw-zlib-32-big.vtu")),
        ("raw", include_bytes!("../../tests/data/vtk/vtk-appended-raw-64.vtp")),
        ("binary", include_bytes!("../../tests/data/vtk/vtk-binary-32.vtp")),
        ("meshio's text", include_bytes!("../../tests/data/vtk/meshio-ascii.vtu")),
        ("meshio's zlib", include_bytes!("../../tests/data/vtk/meshio-zlib.vtu")),
    ];
    for (name, file) in files {
        let Document { mesh, fields, .. } = read(file, name).unwrap();
        let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [2.0, 0.5, 0.0]];
        assert_eq!(mesh.points, points, "{name}");
        assert_eq!(mesh.point_labels, [1, 2, 3, 4, 5]);
        assert_eq!((mesh.triangles, mesh.triangle_labels), (vec![[0, 1, 2], [0, 2, 3], [1, 4, 2]], vec![7, 7, 6]));
        assert_eq!((mesh.edges, mesh.edge_labels), (vec![[0, 1]], vec![8]));
        let [u, metric, wind] = fields.vertices.as_slice() else { panic!("{name}: {:?}", fields.vertices) };
        assert_eq!([&u.name, &metric.name, &wind.name], ["u", "metric", "wind"]);
        assert!(matches!(&u.values, SolutionValues::Scalar(u) if u.len() == 5 && (u[3] - 0.3).abs() < 1e-15));
        // Its zz is 1: not a tensor of the plane.
        let expected = [1.0, 2.0, 3.0, 4.0, 5.0].map(|i| [i, 0.5, 2.0, 0.0, 0.0, 1.0]).to_vec();
        assert_eq!(metric.values, SolutionValues::Tensor3(expected));
        assert_eq!(wind.values, SolutionValues::Vector { components: 2, numbers: [1.5, -2.0].repeat(5) });
        let expected = Field { name: "e".into(), values: SolutionValues::Scalar(vec![0.25, 0.25, 0.5]) };
        assert_eq!(fields.triangles, [expected]);
    }
}

#[test]
fn volumes_have_their_boundary_where_there_are_no_triangles() {
    let read_cells = |connectivity: &str, offsets: &str, types: &str, labels: &str| {
        let piece = format!(
            r#"<Piece NumberOfPoints="5" NumberOfCells="2"><Points><DataArray type="Float64" NumberOfComponents="3">
            0 0 0 1 0 0 0 1 0 0 0 1 0 0 -1</DataArray></Points><CellData><DataArray type="Int32" Name="label">{labels}</DataArray>
            </CellData><Cells><DataArray type="Int32" Name="connectivity">{connectivity}</DataArray><DataArray type="Int32"
            Name="offsets">{offsets}</DataArray><DataArray type="UInt8" Name="types">{types}</DataArray></Cells></Piece>"#
        );
        read(file(&piece).as_bytes(), "a").unwrap()
    };
    let found = read_cells("0 1 2 3 0 1 2 4", "4 8", "10 10", "7 3");
    assert_eq!(found.mesh.triangle_labels, [7, 7, 7, 3, 3, 3, 3]);
    assert_eq!(found.notes, ["of 2 tetrahedra the boundary was taken, for the file lists no triangles"]);
    let found = read_cells("0 1 2 3 0 1 2", "4 7", "10 5", "7 3");
    assert_eq!((found.mesh.triangles, found.mesh.triangle_labels), (vec![[0, 1, 2]], vec![3]));
    assert_eq!(found.notes, ["1 tetrahedron left out: the surface is the 1 triangle that the file lists"]);
}

const PIECE: &str = r#"<Piece NumberOfPoints="3" NumberOfCells="2"><PointData>
<DataArray type="Float32" Name="h">1 2 3</DataArray></PointData><CellData>
<DataArray type="Int64" Name="Material">-3 4</DataArray>
<DataArray type="Float64" Name="e" NumberOfComponents="">0.5 nan</DataArray>
</CellData><Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 0 1e0 0</DataArray></Points>
<Cells><DataArray type="Int32" Name="connectivity">0 1 2 2 0</DataArray>
<DataArray type="Int32" Name="offsets">3 5</DataArray><DataArray type="UInt8" Name="types">5 3</DataArray></Cells></Piece>"#;

fn file(body: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?><VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>{body}</UnstructuredGrid></VTKFile>"
    )
}

#[test]
fn pieces_are_joined() {
    let empty = r#"<Piece NumberOfPoints="0" NumberOfCells="0"><PointData/></Piece>"#;
    let found = read(file(&[empty, PIECE, PIECE].concat()).as_bytes(), "a").unwrap();
    let mesh = found.mesh;
    assert_eq!((mesh.points.len(), mesh.triangles, mesh.edges), (6, vec![[0, 1, 2], [3, 4, 5]], vec![[2, 0], [5, 3]]));
    assert_eq!((mesh.triangle_labels, mesh.edge_labels), (vec![-3, -3], vec![4, 4]));
    let fields = found.fields;
    assert_eq!(fields.vertices[0].values, SolutionValues::Scalar(vec![1.0, 2.0, 3.0, 1.0, 2.0, 3.0]));
    assert_eq!(fields.triangles[0].values, SolutionValues::Scalar(vec![0.5, 0.5]));
    let others = [PIECE, &PIECE.replace("Name=\"h\"", "Name=\"k\"")].concat();
    let message = read(file(&others).as_bytes(), "a").unwrap_err().to_string();
    assert!(message.ends_with("array 'h' is not in all pieces, or not with as many components"), "{message}");
    let more = PIECE.replace("<PointData>", "<PointData><DataArray type=\"Int8\" Name=\"k\">7 8 9</DataArray>");
    let message = read(file(&[PIECE, &more].concat()).as_bytes(), "a").unwrap_err().to_string();
    assert!(message.starts_with("a, byte ") && message.ends_with("array 'k' is not in all pieces"), "{message}");
}

#[test]
fn labels_and_names() {
    let with = |old: &str, new: &str| read(file(&PIECE.replace(old, new)).as_bytes(), "a").unwrap();
    let more = "<CellData><DataArray type=\"Int8\" Name=\"label\">7 8</DataArray>";
    let found = with("<CellData>", more);
    assert_eq!((found.mesh.triangle_labels, found.mesh.edge_labels), (vec![7], vec![8]));
    assert_eq!(found.fields.triangles[0].name, "Material");
    // Labels have no fractions, and nobody else's marks are taken for this library's.
    let found = with("\"Int64\" Name=\"Material\"", "\"Float64\" Name=\"required\"");
    assert_eq!((found.mesh.triangle_labels, found.fields.triangles.len()), (vec![0], 2));
    assert!(found.mesh.required_triangles.is_empty());
    assert_eq!(with("Name=\"h\"", "Name=\"a&lt;&#233;\u{fc}\"").fields.vertices[0].name, "a<\u{e9}\u{fc}");
    // Strings, later time steps, other elements and what is of no use to a mesh are passed over.
    let more = "<PointData><DataArray type=\"String\" Name=\"s\">1</DataArray><Array type=\"String\">x</Array>\
                <DataArray type=\"Int8\" Name=\"h\" TimeStep=\"1\">9</DataArray>";
    assert_eq!(with("<PointData>", more), with("", ""));
    let nested = "1 2 3<InformationKey><Value>9</Value></InformationKey><!-- 4 --> ";
    assert_eq!(with("1 2 3", nested), with("", ""));
    let mut latin = file(PIECE).into_bytes();
    let at = latin.windows(3).position(|three| three == b"\"h\"").unwrap();
    latin[at + 1] = 0xe9;
    assert_eq!(read(latin.as_slice(), "a").unwrap().fields.vertices[0].name, "\u{e9}");
}

#[test]
fn damaged_files() {
    let message = |old: &str, new: &str| {
        assert!(PIECE.contains(old), "{old}");
        let error = read(file(&PIECE.replacen(old, new, 1)).as_bytes(), "a").unwrap_err();
        assert!(!error.help().is_empty(), "{error}");
        error.to_string()
    };
    for (old, new, expected) in [
        (
            "Points=\"3\"",
            "Points=\"1e18\"",
            "byte 72: NumberOfPoints=\"1e18\" is not a whole number from 0 to 4294967295",
        ),
        ("Points=\"3\"", "Points=\"4294967295\"", "array '' holds 9 numbers, where 12884901885 are needed"),
        ("Cells=\"2\"", "Cells=\"-2\"", "NumberOfCells=\"-2\" is not a whole number from 0 to 4294967295"),
        ("NumberOfCells=\"2\"", "", "a piece without NumberOfCells"),
        ("Cells=\"2\"", "Cells=\"1\"", "array 'types' holds more than 1 numbers"),
        ("Cells=\"2\"", "Cells=\"0\"", "array 'connectivity' holds more than 0 numbers"),
        ("Components=\"3\"", "Components=\"2\"", "array '' has 2 components, where points have 3"),
        ("Components=\"3\"", "Components=\"many\"", "array '' has 'many' components"),
        (
            "Name=\"h\"",
            "Name=\"h\" NumberOfComponents=\"18446744073709551615\"",
            "numbers, where 18446744073709551615 are needed",
        ),
        ("0 1e0 0<", "0 nan 0<", "array '' holds NaN, which is not finite, as a coordinate of point 3"),
        ("0 1e0 0<", "0 1e0 x<", "array '' holds 'x', which is not a number (number 9 of 9)"),
        ("1 2 3", "1 inf 3", "array 'h' holds inf, which is not finite, in entry 2"),
        ("0.5 nan", "nan 0.5", "array 'e' holds NaN, which is not finite, in entry 1"),
        ("-3 4", "-3 4000000000", "array 'Material' holds the label 4000000000, which is out of range (entry 2 of 2)"),
        ("0 1 2 2 0", "0 1 3 2 0", "array 'connectivity' holds point 3 (number 3 of 5): the piece has 3, from 0"),
        ("0 1 2 2 0", "0 1 -2 2 0", "array 'connectivity' holds point -2 (number 3 of 5): the piece has 3, from 0"),
        ("0 1 2 2 0", "0 1 2 2", "array 'connectivity' holds 4 numbers, where 5 are needed"),
        ("3 5<", "3 1<", "array 'offsets' says that cell 2 ends at 1, behind which it begins, at 3"),
        (
            "3 5<",
            "3 9000000000000000000<",
            "array 'connectivity' holds 5 numbers, where 9000000000000000000 are needed",
        ),
        ("3 5<", "2 5<", "array 'offsets' gives cell 1 2 vertices: a triangle has 3"),
        (">3 5<", ">3<", "array 'offsets' holds 1 numbers, where 2 are needed"),
        ("5 3<", "5<", "array 'types' holds 1 numbers, where 2 are needed"),
        ("5 3<", "10 10<", "array 'offsets' gives cell 1 3 vertices: a tetrahedron has 4"),
        ("5 3<", "42 42<", "not supported: 2 cells of type 42 (polyhedra) in a"),
        ("5 3<", "23 3<", "not supported: 1 cells of type 23 (of higher order or unknown) in a"),
        ("\"UInt8\" Name=\"types\"", "\"Float32\" Name=\"types\"", "array 'types' holds floating point numbers"),
        ("Name=\"types\"", "Name=\"kinds\"", "Cells of a piece without an array 'types' of one component"),
        ("\"ascii\"", "\"hex\"", "array '' has the format 'hex'"),
        ("\"ascii\"", "\"appended\"", "array '' has the offset ''"),
        ("\"ascii\"", "\"appended\" offset=\"0\"", "array '' is in a section AppendedData, which is not there"),
        ("\"ascii\"", "\"binary\"", "array '' ends before all is there that its sizes announce"),
        ("1 2 3", "1 &two; 3", "an '&' among the numbers of an array"),
        ("Name=\"h\"", "Name=\"&bomb;\"", "bomb"),
        ("</Points>", "</Pints>", "`</Points>`"),
    ] {
        let message = message(old, new);
        assert!(message.contains(expected), "{message}\n{expected}");
    }
}

#[test]
fn what_is_no_such_file() {
    for (text, expected) in [
        ("# vtk DataFile Version 3.0\nx\nASCII\n", "a, byte 0: the file does not begin with the tag VTKFile"),
        ("<html><VTKFile/></html>", "a, byte 0: the file does not begin with the tag VTKFile"),
        ("\u{89}HDF\r\n\u{1a}\n<", "the file does not begin with the tag VTKFile"),
        ("<VTKFile type=\"ImageData\"/>", "not supported: a is a VTK file of type 'ImageData'"),
        ("<VTKFile type=\"PolyData\"><PolyData>", "a, byte 35: the file ends in the midst of its tags"),
        ("<VTKFile type=\"PolyData\"><PolyData/></VTKFile>", "a, byte 46: no PolyData with a piece in it"),
        ("<VTKFile type=\"PolyData\" byte_order=\"Middle\"/>", "an unknown byte_order 'Middle'"),
        ("<VTKFile type=\"PolyData\" header_type=\"UInt16\"/>", "an unknown header_type 'UInt16'"),
        ("", "a, byte 0: no UnstructuredGrid with a piece in it"),
    ] {
        let message = read(text.as_bytes(), "a").unwrap_err().to_string();
        assert!(message.contains(expected), "{message}\n{expected}");
    }
    let lz4 = "UnstructuredGrid\" compressor=\"vtkLZ4DataCompressor\">";
    let text = file(&PIECE.replace("\"ascii\"", "\"binary\"")).replace("UnstructuredGrid\">", lz4);
    let message = read(text.as_bytes(), "a").unwrap_err().to_string();
    assert_eq!(message, "not supported: a is compressed by 'vtkLZ4DataCompressor'");
    let deep = file(&(PIECE.to_owned() + &"<a>".repeat(1 << 20)));
    assert!(read(deep.as_bytes(), "a").unwrap_err().to_string().contains("expected `</a>`"));
}

#[test]
fn appended_arrays_have_to_be_there() {
    let whole = written(&sample(0.0), write_vtu);
    let raw = whole.windows(2).position(|pair| pair == b"\n_").unwrap() + 2;
    let last = whole.len() - "\n  </AppendedData>\n</VTKFile>\n".len();
    for length in 0..last {
        let error = read(&whole[..length], "a").unwrap_err();
        assert!(!error.help().is_empty(), "{length}: {error}");
    }
    let message = |old: &str, new: &str| {
        let head = std::str::from_utf8(&whole[..raw]).unwrap().replacen(old, new, 1);
        read([head.as_bytes(), &whole[raw..]].concat().as_slice(), "a").unwrap_err().to_string()
    };
    // Types come first, 8 bytes of size and 5 of cells; then offsets.
    let found = message("offset=\"0\"", "offset=\"1000000\"");
    assert!(found.contains("array 'types' begins behind the end of the file"), "{found}");
    let found = message("offset=\"13\"", "offset=\"12\"");
    assert!(found.contains("array 'offsets' begins in another array"), "{found}");
    assert!(message("\"raw\"", "\"hex\"").contains("an unknown encoding 'hex'"));
    let found = message("\"raw\"", "\"base64\"");
    assert!(found.contains("array 'types' holds '\\u{5}' at a place where base64 does not have it"), "{found}");
    assert!(message("\n_", "\nx").contains("AppendedData without the '_' that its arrays begin with"));
    let mut lying = whole.clone();
    lying[raw..raw + 8].fill(0xff);
    let found = read(lying.as_slice(), "a").unwrap_err().to_string();
    assert_eq!(found, format!("a, byte {raw}: array 'types' ends before all is there that its sizes announce"));
}

#[test]
fn values_on_polygons_take_no_more_memory_than_is_fit() {
    let vertices = 40_000;
    let numbers = |count: usize, number: &str| [number, " "].concat().repeat(count);
    let (many, count) = (numbers(1000, "1"), 1000);
    let text = format!(
        "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"1\" NumberOfPolys=\"1\"><CellData><DataArray \
         type=\"Int8\" Name=\"f\" NumberOfComponents=\"{count}\">{many}</DataArray></CellData><Points><DataArray \
         type=\"Int8\">0 0 0</DataArray></Points><Polys><DataArray type=\"Int8\" Name=\"connectivity\">{}</DataArray>\
         <DataArray type=\"Int32\" Name=\"offsets\">{vertices}</DataArray></Polys></Piece></PolyData></VTKFile>",
        numbers(vertices, "0")
    );
    let message = read(text.as_bytes(), "a").unwrap_err().to_string();
    assert_eq!(message, "limit exceeded: a: 1 cells are cut into 39998 triangles, with 39998000 values on them");
}

#[test]
fn no_change_of_bytes_makes_the_reader_panic() {
    let files: [&[u8]; 3] = [
        include_bytes!("../../tests/data/vtk/vtk-appended-raw-zlib-32-big.vtu"),
        include_bytes!("../../tests/data/vtk/vtk-appended-base64-zlib-64.vtp"),
        &written(&sample(0.0), write_vtp),
    ];
    // Numerical Recipes' generator: any will do.
    let mut state = 1_u32;
    let mut random = move |below: usize| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as usize % below
    };
    for file in files {
        for _ in 0..3000 {
            let mut file = file.to_vec();
            for _ in 0..=random(3) {
                let at = random(file.len());
                match random(3) {
                    0 => file[at] = random(256) as u8,
                    1 => drop(file.drain(at..(at + 1 + random(20)).min(file.len()))),
                    _ => file.insert(at, [b'"', b'<', b'9', 0xff][random(4)]),
                }
            }
            if let Ok(document) = read(file.as_slice(), "a") {
                document.mesh.check_numbers().unwrap();
            }
        }
    }
}
