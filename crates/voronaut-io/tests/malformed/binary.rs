//! Valid binary files.

use crate::reading::Reader;
use crate::sample::{Binary, Kind, Sample};
use voronaut::mesh::{Mesh, SolutionValues};
use voronaut_io::{Field, Fields, vtk};

pub(crate) fn samples() -> Vec<Sample> {
    let mut samples = vec![stl(), ply(false), ply(true), strips(false), strips(true)];
    for (version, big) in [(1, false), (2, false), (2, true), (3, true), (4, false), (4, true)] {
        samples.push(Medit::new(version, big).mesh(if version < 3 { 2 } else { 3 }));
        samples.push(Medit::new(version, big).curved());
        samples.push(Medit::new(version, big).solutions(if version < 3 { 2 } else { 3 }));
    }
    samples.extend([gmsh_2(false), gmsh_4(true)]);
    samples.extend(vtk_files());
    samples
}

const COUNT: Option<Kind> = Some(Kind::Count);
const REFERENCE: Option<Kind> = Some(Kind::Reference);

/// A file of libMeshb's.
struct Medit {
    file: Binary,
    version: i32,
}

impl Medit {
    fn new(version: i32, big: bool) -> Self {
        let mut file = Binary::new(big);
        file.i32(1, None);
        file.i32(version, None);
        Self { file, version }
    }

    fn mesh(mut self, dimension: i32) -> Sample {
        self.dimension(dimension);
        let points = [([0.5, 0.0, 0.0], -1), ([1.0, 0.25, 0.5], 2), ([0.0, 1.0, 0.0], 3)];
        self.section(4, 3, |own| {
            for (point, label) in points {
                point[..dimension as usize].iter().for_each(|&x| own.real(x));
                own.whole(label, None);
            }
        });
        self.elements(5, &[[1, 2], [2, 3], [3, 1]]);
        self.elements(6, &[[1, 2, 3], [3, 2, 1]]);
        self.elements(7, &[[1, 2, 3, 2]]);
        self.elements(8, &[[1, 2, 3, 1], [3, 2, 1, 3]]);
        self.numbers(13, &[2], REFERENCE);
        self.numbers(15, &[1, 3], REFERENCE);
        // There are as many edges as vertices, but fewer triangles.
        self.numbers(14, &[2], REFERENCE);
        self.numbers(16, &[1, 3], REFERENCE);
        self.numbers(17, &[2], None);
        self.finish("a.meshb", Reader::Medit)
    }

    /// A triangle of order 3 with one of its edges, and in which order that has its nodes.
    fn curved(mut self) -> Sample {
        self.dimension(2);
        self.section(4, 10, |own| {
            for i in 0..10 {
                own.real(f64::from(i % 4));
                own.real(f64::from(i / 4) / 2.0);
                own.whole(0, None);
            }
        });
        self.elements(92, &[[4, 8, 6, 5]]);
        self.elements(90, &[[1, 4, 8, 2, 3, 5, 6, 7, 9, 10]]);
        self.section(128, 4, |own| own.wholes(&[0, 3, 2, 1], None));
        self.numbers(16, &[1], None);
        self.finish("curved.meshb", Reader::Medit)
    }

    fn solutions(mut self, dimension: i32) -> Sample {
        self.dimension(dimension);
        let entries = if dimension == 2 { 3 } else { 6 };
        self.section(62, 2, |own| {
            own.file.i32s(&[1, 3], COUNT);
            (0..2 * entries).for_each(|i| own.real(f64::from(i) / 2.0));
        });
        self.section(64, 1, |own| {
            own.file.i32s(&[2, 1, 2], COUNT);
            (0..=dimension).for_each(|i| own.real(f64::from(i)));
        });
        self.finish("a.solb", Reader::Sol)
    }

    fn dimension(&mut self, dimension: i32) {
        self.keyword(3, |own| own.file.i32(dimension, Some(Kind::Dimension)));
    }

    fn elements<const N: usize>(&mut self, code: i32, elements: &[[i32; N]]) {
        self.section(code, elements.len(), |own| {
            for element in elements {
                own.wholes(element, REFERENCE);
                own.whole(i32::MIN, None);
            }
        });
    }

    fn numbers(&mut self, code: i32, numbers: &[i32], kind: Option<Kind>) {
        self.section(code, numbers.len(), |own| own.wholes(numbers, kind));
    }

    fn section(&mut self, code: i32, rows: usize, body: impl Fn(&mut Self)) {
        self.keyword(code, |own| {
            own.whole(small(rows), COUNT);
            body(own);
        });
    }

    /// A keyword, where the next stands, and what is between.
    fn keyword(&mut self, code: i32, body: impl Fn(&mut Self)) {
        self.file.i32(code, None);
        let mut trial = Self { file: Binary::new(self.file.big), version: self.version };
        body(&mut trial);
        let size = if self.version < 3 { 4 } else { 8 };
        let next = self.file.bytes.len() + size + trial.file.bytes.len();
        if size == 4 {
            self.file.i32(small(next), Some(Kind::Position));
        } else {
            self.file.i64(small(next).into(), Some(Kind::Position));
        }
        body(self);
    }

    fn wholes(&mut self, numbers: &[i32], kind: Option<Kind>) {
        for &number in numbers {
            self.whole(number, kind);
        }
    }

    fn whole(&mut self, number: i32, kind: Option<Kind>) {
        if self.version == 4 { self.file.i64(number.into(), kind) } else { self.file.i32(number, kind) }
    }

    fn real(&mut self, number: f64) {
        if self.version == 1 { self.file.f32(number as f32) } else { self.file.f64(number) }
    }

    fn finish(mut self, name: &'static str, reader: Reader) -> Sample {
        self.file.i32(54, None);
        self.file.raw(if self.version < 3 { &[0; 4] } else { &[0; 8] });
        let references = if name == "curved.meshb" { 1..11 } else { 1..4 };
        self.file.finish(name, reader, references)
    }
}

fn small(number: usize) -> i32 {
    number.try_into().expect("a small number")
}

fn stl() -> Sample {
    let mut file = Binary::new(false);
    file.raw(format!("{:80}", "solid, says a binary file").as_bytes());
    file.i32(2, COUNT);
    for triangle in [[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0], [1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.5]] {
        file.raw(&[0; 12]);
        file.f32s(&triangle);
        file.raw(&[0; 2]);
    }
    file.finish("b.stl", Reader::Stl, 0..0)
}

fn ply(big: bool) -> Sample {
    let mut file = Binary::new(big);
    let order = if big { "big" } else { "little" };
    file.raw(format!("ply\nformat binary_{order}_endian 1.0\n").as_bytes());
    file.raw(b"element vertex 4\nproperty float x\nproperty double y\nproperty float z\nproperty uchar red\nproperty int label\n");
    file.raw(
        b"property double u\nelement face 2\nproperty list int int vertex_index\nproperty list uchar short extra\n",
    );
    file.raw(b"property float error\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n");
    for (i, [x, y]) in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].into_iter().enumerate() {
        file.f32(x);
        file.f64(y.into());
        file.f32(0.5);
        file.byte(255, None);
        file.i32(-7, None);
        file.f64(i as f64 / 3.0);
    }
    for face in [[0, 1, 2], [2, 3, 0]] {
        file.i32(3, COUNT);
        file.i32s(&face, REFERENCE);
        file.byte(1, COUNT);
        file.raw(&[0; 2]);
        file.f32(0.5);
    }
    file.i32(3, REFERENCE);
    file.i32(0, REFERENCE);
    file.finish(if big { "big.ply" } else { "little.ply" }, Reader::Ply, 0..4)
}

fn strips(big: bool) -> Sample {
    let mut file = Binary::new(big);
    let order = if big { "big" } else { "little" };
    file.raw(format!("ply\nformat binary_{order}_endian 1.0\n").as_bytes());
    file.raw(b"element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement tristrips 1\n");
    file.raw(b"property list int int vertex_indices\nend_header\n");
    file.f32s(&[0.0, 0.0, 0.5, 1.0, 0.0, 0.5, 1.0, 1.0, 0.5, 0.0, 1.0, 0.5]);
    file.i32(7, COUNT);
    file.i32s(&[0, 1, 2], REFERENCE);
    file.i32(-1, None);
    file.i32s(&[3, 2, 1], REFERENCE);
    file.finish(if big { "big strips.ply" } else { "little strips.ply" }, Reader::Ply, 0..4)
}

fn gmsh_2(big: bool) -> Sample {
    let mut file = Binary::new(big);
    file.raw(b"$MeshFormat\n2.2 1 8\n");
    file.i32(1, None);
    file.raw(b"\n$EndMeshFormat\n$Nodes\n4\n");
    for (tag, [x, y]) in (1..).zip(SQUARE) {
        file.i32(tag, None);
        file.f64s(&[x, y, 0.0]);
    }
    file.end("$EndNodes");
    file.raw(b"$Elements\n3\n");
    for (kind, tag, elements) in [(1, 1, &[[1, 2, 0]][..]), (2, 2, &[[1, 2, 3], [1, 3, 4]])] {
        file.i32s(&[kind, small(elements.len())], None);
        file.i32(2, COUNT);
        for (tag, element) in (tag..).zip(elements) {
            file.i32s(&[tag, 7, 1], None);
            file.i32s(&element[..=kind as usize], REFERENCE);
        }
    }
    file.end("$EndElements");
    file.finish("2.2-binary.msh", Reader::Gmsh, 1..5)
}

fn gmsh_4(big: bool) -> Sample {
    let mut file = Binary::new(big);
    file.raw(b"$MeshFormat\n4.1 1 8\n");
    file.i32(1, None);
    file.raw(b"\n$EndMeshFormat\n$Entities\n");
    file.i64s(&[0, 1, 1, 0], COUNT);
    for group in [5, 7] {
        file.i32(1, None);
        file.raw(&[0; 6 * 8]);
        file.i64(1, COUNT);
        file.i32(group, None);
        file.i64(0, COUNT);
    }
    file.raw(b"\n$EndEntities\n$Nodes\n");
    file.i64s(&[1, 4], COUNT);
    file.i64s(&[1, 4], None);
    file.i32s(&[2, 1, 0], None);
    file.i64(4, COUNT);
    file.i64s(&[1, 2, 3, 4], None);
    file.f64s(SQUARE.map(|[x, y]| [x, y, 0.5]).as_flattened());
    file.end("$EndNodes");
    file.raw(b"$Elements\n");
    file.i64s(&[2, 3], COUNT);
    file.i64s(&[1, 3], None);
    for (dimension, tag, elements) in [(1, 1, &[[1, 2, 0]][..]), (2, 2, &[[1, 2, 3], [1, 3, 4]])] {
        file.i32s(&[dimension, 1, dimension], None);
        file.i64(small(elements.len()).into(), COUNT);
        for (tag, element) in (tag..).zip(elements) {
            file.i64(tag, None);
            file.i64s(&element[..=dimension as usize], REFERENCE);
        }
    }
    file.end("$EndElements");
    file.raw(b"$NodeData\n1\n\"u\"\n1\n0.0\n3\n0\n1\n4\n");
    for tag in 1..=4 {
        file.i32(tag, REFERENCE);
        file.f64(0.5);
    }
    file.end("$EndNodeData");
    file.finish("4.1-binary.msh", Reader::Gmsh, 1..5)
}

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 0.1]];

/// Our own files, and those of other programs.
fn vtk_files() -> Vec<Sample> {
    let mesh = Mesh {
        points: SQUARE.map(|[x, y]| [x, y, 0.0]).into(),
        point_labels: vec![1, -2, 3, i32::MIN],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        triangle_labels: vec![7, 8],
        edges: vec![[0, 1]],
        edge_labels: vec![9],
        required_edges: vec![0],
        ..Mesh::default()
    };
    let values = SolutionValues::Tensor(vec![[1.0, 0.5, 2.0]; 4]);
    let fields = Fields { vertices: vec![Field { name: "metric".into(), values }], triangles: Vec::new() };
    let (mut vtu, mut vtp) = (Vec::new(), Vec::new());
    vtk::write_vtu(&mesh, &fields, &mut vtu).expect("memory");
    vtk::write_vtp(&mesh, &fields, &mut vtp).expect("memory");
    let mut samples = vec![arrays("own.vtu", &vtu), arrays("own.vtp", &vtp)];
    let zlib = include_bytes!("../data/vtk/vtk-appended-raw-zlib-32-big.vtu");
    let base64 = include_bytes!("../data/vtk/vtk-appended-base64-zlib-64.vtp");
    samples.extend([arrays("zlib.vtu", zlib), arrays("base64.vtp", base64)]);
    let meshio = include_bytes!("../data/vtk/meshio-zlib.vtu");
    samples.push(Sample::opaque("meshio.vtu", Reader::Vtk, meshio.to_vec(), meshio.trim_ascii_end().len()));
    samples
}

/// A file that ends with arrays, behind which nothing matters.
fn arrays(name: &'static str, file: &[u8]) -> Sample {
    let end = b"</AppendedData>";
    let end = file.windows(end.len()).rposition(|window| window == end).expect("the end of the arrays");
    Sample::opaque(name, Reader::Vtk, file.to_vec(), file[..end].trim_ascii_end().len())
}
