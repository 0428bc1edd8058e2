//! `convert`: from every format to every other, and what goes along.

use crate::common::{Place, stderr};
use voronaut::manifold::domain::Domain;
use voronaut::mesh::{Mesh, SolutionValues};
use voronaut_io::read_pslg;

/// A rectangle of regions 5 and 6 (-6 where labels may be negative) with labelled sides, a labelled interface, corners and what is required.
const PLANE: &str = "MeshVersionFormatted 2\nDimension 2\nVertices 6\n0 0 1\n1.1 0 2\n2 0.1 0\n2 1 0\n1 1 0\n0 1 4\nEdges 7\n1 2 1\n2 3 1\n\
                     3 4 2\n4 5 3\n5 6 3\n6 1 4\n2 5 9\nTriangles 4\n1 2 5 5\n1 5 6 5\n2 3 4 6\n2 4 5 6\nCorners 2\n1\n4\n\
                     RequiredVertices 1\n2\nRidges 1\n7\nRequiredEdges 1\n1\nRequiredTriangles 1\n3\nEnd\n";

const VALUES: &str = "MeshVersionFormatted 2\nDimension 2\nSolAtVertices 6\n3 1 2 3\n0.1 1 2 4 0.5 1\n0.2 1 2 4 0.5 1\n0.3 1 2 4 0.5 1\n\
                      0.4 1 2 4 0.5 1\n0.5 1 2 4 0.5 1\n0.6 1 2 4 0.5 1\nSolAtTriangles 4\n1 1\n1\n2\n3\n4\nEnd\n";

fn place() -> Place {
    let place = Place::new();
    place.put("in.mesh", PLANE);
    place.put("in.sol", VALUES);
    place
}

fn done(place: &Place, words: &str) -> String {
    let output = place.run(&words.split_whitespace().collect::<Vec<_>>());
    assert_eq!(output.status.code(), Some(0), "{words}: {}", stderr(&output));
    stderr(&output)
}

fn mesh(place: &Place, name: &str) -> Mesh {
    voronaut_io::read(&place.path().join(name)).unwrap().mesh
}

#[test]
fn formats_that_hold_everything_give_it_back() {
    let place = place();
    let truth = mesh(&place, "in.mesh");
    let mut before = "in.mesh".to_owned();
    for ending in ["meshb", "vtu", "vtp", "mesh"] {
        let next = format!("out.{ending}");
        let told = done(&place, &format!("convert {before} {next}"));
        assert!(told.contains("6 vertices, 4 triangles, 7 labelled edges") && !told.contains("left out"), "{told}");
        before = next;
    }
    assert_eq!(mesh(&place, "out.mesh"), truth);
}

#[test]
fn gmsh_s_elements_are_sorted_by_label_and_mark() {
    let place = place();
    let truth = mesh(&place, "in.mesh");
    let corners = |mesh: &Mesh, triangle: u32| mesh.triangles[triangle as usize];
    for options in ["", "--binary", "--msh-version 2.2", "--msh-version 2.2 --binary"] {
        let told = done(&place, &format!("convert in.mesh out.msh {options}"));
        assert_eq!(told.contains("left out"), options.contains("2.2"), "{told}");
        done(&place, "convert out.msh out.mesh");
        let again = mesh(&place, "out.mesh");
        let sorted = |mesh: &Mesh| {
            let edges = mesh.edges.iter().zip(&mesh.edge_labels).map(|(e, l)| (*l, e.to_vec()));
            let triangles = mesh.triangles.iter().zip(&mesh.triangle_labels).map(|(t, l)| (*l, t.to_vec()));
            let mut all: Vec<_> = edges.chain(triangles).collect();
            all.sort_unstable();
            all
        };
        assert_eq!(sorted(&again), sorted(&truth), "{options}");
        assert_eq!((&again.points, &again.point_labels), (&truth.points, &truth.point_labels), "{options}");
        assert_eq!((&again.corners, &again.required_points), (&truth.corners, &truth.required_points), "{options}");
        let kept = usize::from(!options.contains("2.2"));
        assert_eq!((again.ridges.len(), again.required_edges.len()), (kept, kept), "{options}");
        if let [required] = again.required_triangles[..] {
            assert_eq!(corners(&again, required), corners(&truth, truth.required_triangles[0]));
        }
    }
}

#[test]
fn what_is_left_out_is_said() {
    let place = place();
    for (ending, words) in [
        (
            "obj",
            "3 labels of vertices, 7 labels of edges, 3 corners and required vertices, 3 ridges, required edges and triangles",
        ),
        ("off", "3 labels of vertices, 4 labels of triangles, 7 labelled edges"),
        ("stl", "7 labelled edges"),
        ("ply", "7 labelled edges, 3 corners"),
    ] {
        let told = done(&place, &format!("convert in.mesh out.{ending}"));
        assert!(told.contains("no place for them: ") && told.contains(words), "{told}");
        let found = mesh(&place, &format!("out.{ending}"));
        assert_eq!((found.points.len(), found.triangles.len()), (6, 4));
    }
    assert_eq!(mesh(&place, "out.ply").triangle_labels, [5, 5, 6, 6]);
    assert_eq!(done(&place, "convert in.mesh out.off --quiet"), "");
}

#[test]
fn values_go_along() {
    let place = place();
    let truth = voronaut_io::read_solutions(&place.path().join("in.sol")).unwrap();
    for way in [["a.vtu", "a.mesh", "a.sol"], ["b.msh", "b.meshb", "b.solb"], ["c.vtp", "c.mesh", "c.sol"]] {
        done(&place, &format!("convert in.mesh {} --sol in.sol", way[0]));
        let told = done(&place, &format!("convert {} {}", way[0], way[1]));
        assert!(told.contains("metric") && told.contains(&format!(" in {}", way[2])), "{told}");
        let again = voronaut_io::read_solutions(&place.path().join(way[2])).unwrap();
        let find = |wanted: &SolutionValues| again.vertices.iter().chain(&again.triangles).any(|found| found == wanted);
        assert!(truth.vertices.iter().all(find), "{again:?}");
        // Gmsh's triangles are sorted by label and mark, and their values with them.
        assert!(way[0] == "b.msh" || truth.triangles.iter().all(find), "{again:?}");
    }
    done(&place, "convert in.sol out.solb");
    done(&place, "convert out.solb out.sol");

    let words =
        |text: Vec<u8>| String::from_utf8(text).unwrap().split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(words(place.read("out.sol")), words(VALUES.into()));
    assert_eq!(voronaut_io::read_solutions(&place.path().join("out.solb")).unwrap(), truth);
    place.put("short.sol", "MeshVersionFormatted 2 Dimension 2 SolAtVertices 1 1 1 0.5");
    let output = place.run(&["convert", "in.mesh", "short.vtu", "--sol", "short.sol"]);
    assert_eq!(output.status.code(), Some(1));
    assert!(stderr(&output).contains("short.sol: 1 values, and the mesh has 6 vertices"), "{}", stderr(&output));
    assert!(!place.files().contains(&"short.vtu".into()));
}

#[test]
fn outlines_become_meshes_and_meshes_outlines() {
    let place = place();
    let area = |name: &str| Domain::new(&read_pslg(place.path().join(name).to_str().unwrap()).unwrap()).unwrap().area();
    let truth = area("in.mesh");
    let told = done(&place, "convert in.mesh out.poly");
    let lost = "3 corners and required vertices, 3 ridges, required edges and triangles";
    assert!(told.ends_with(&format!("no place for them: {lost}\n")), "{told}");
    done(&place, "convert out.poly out.geojson");
    let told = done(&place, "convert out.geojson back.mesh");
    assert!(told.contains("6 vertices, 4 triangles"), "{told}");
    for name in ["out.poly", "out.geojson", "back.mesh"] {
        assert!((area(name) - truth).abs() < 1e-12, "{name}");
    }
    let mut regions = mesh(&place, "back.mesh").triangle_labels;
    regions.sort_unstable();
    assert_eq!(regions, [5, 5, 6, 6]);
    done(&place, "convert disk:0,0,1 disk.poly -q");
    assert!((area("disk.poly") - std::f64::consts::PI).abs() < 1e-5);
}

#[test]
fn what_cannot_be_is_refused() {
    let place = place();
    place.put("cut.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 3\n2 1 0 3\n1\n2\n");
    for (words, expected) in [
        ("convert in.mesh out.xyz", "out.xyz does not end like a mesh file"),
        ("convert in.sol out.vtu", "values and a mesh"),
        ("convert in.mesh out.poly --sol in.sol", "values (in.sol) in out.poly"),
        ("convert none.mesh out.vtu", "none.mesh: "),
        ("convert cut.msh out.vtu", "cut.msh:8: "),
        ("convert in.mesh no/where/out.vtu", "no/where"),
        ("convert in.mesh rect:0,0,1,1", "rect:0,0,1,1 does not end like a mesh file"),
    ] {
        let output = place.run(&words.split_whitespace().collect::<Vec<_>>());
        assert_eq!(output.status.code(), Some(1), "{words}");
        assert!(stderr(&output).contains(expected), "{words}: {}", stderr(&output));
        assert!(stderr(&output).contains("help: "), "{words}: {}", stderr(&output));
    }
    assert_eq!(place.files(), ["cut.msh", "in.mesh", "in.sol"]);
}
