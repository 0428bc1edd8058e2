//! Valid texts. `Sample::text` says what the signs in them mean.

use crate::reading::Reader;
use crate::sample::Sample;

pub(crate) fn samples() -> Vec<Sample> {
    vec![
        Sample::text("plane.mesh", Reader::Medit, 1..5, PLANE),
        Sample::text("space.mesh", Reader::Medit, 1..4, SPACE),
        Sample::text("volume.mesh", Reader::Medit, 1..6, VOLUME),
        Sample::text("curved.mesh", Reader::Medit, 1..7, CURVED),
        Sample::text("tensors.sol", Reader::Sol, 0..0, TENSORS),
        Sample::text("several.sol", Reader::Sol, 0..0, SEVERAL),
        Sample::text("a.obj", Reader::Obj, 1..5, OBJ),
        Sample::text("rows.obj", Reader::Obj, 1..5, OBJ_ROWS),
        Sample::text("a.off", Reader::Off, 0..4, OFF),
        Sample::text("a.ply", Reader::Ply, 0..4, PLY),
        Sample::text("strips.ply", Reader::Ply, 0..4, STRIPS),
        Sample::text("a.stl", Reader::Stl, 0..0, STL),
        Sample::text("a.poly", Reader::Poly, 1..5, POLY),
        Sample::text("a.geojson", Reader::Geojson, 0..0, GEOJSON),
        Sample::text("free.msh", Reader::Freefem, 1..5, FREEFEM),
        Sample::text("2.2.msh", Reader::Gmsh, 1..5, GMSH_2),
        Sample::text("volume.msh", Reader::Gmsh, 1..6, GMSH_VOLUME),
        Sample::text("curved.msh", Reader::Gmsh, 1..8, GMSH_CURVED),
        Sample::text("4.1.msh", Reader::Gmsh, 1..5, GMSH_4),
        Sample::text("a.vtu", Reader::Vtk, 0..4, VTU),
        Sample::text("curved.vtu", Reader::Vtk, 0..6, VTU_CURVED),
        Sample::text("volume.vtu", Reader::Vtk, 0..5, VTU_VOLUME),
        Sample::text("a.vtp", Reader::Vtk, 0..4, VTP),
        Sample::text("plane.txt", Reader::Points, 0..0, POINTS),
        Sample::text("space.txt", Reader::Points, 0..0, ";~0 ~0; ~1\n;~0.5 ~-1 ~1e-3\n;"),
    ]
}

/// What refers to edges and triangles comes last: it has less to refer to than vertices.
const PLANE: &str = "MeshVersionFormatted 2\nDimension ^2\nVertices\n!4\n~0 ~0 1\n~1 ~0 -2\n~1 ~1.5e-3 0\n~0 ~1.D0 7\n;
Edges !3\n@1 @2 5\n@2 @3 6\n@3 @4 6\n;\nTriangles\n!2\n@1 @2 @3 1\n@1 @3 @4 -2147483648\n;\nCorners\n!2\n@2\n@4\n;
RequiredVertices !2\n@1\n@4\n;RequiredEdges !1\n2\n;Ridges !1\n3\n;RequiredTriangles\n!1\n2\n;End\n";

const SPACE: &str =
    "MeshVersionFormatted 1\nDimension\n^3\n# in space\nTriangles !2\n@3 @2 @1 6\n@1 @2 @3 7\nNormals 1\n0 0 1
Quadrilaterals 0\nVertices !3\n~0 ~0 ~0 0\n~0 ~1 ~0 0\n~0 ~0 ~1.25 5\n;";

const VOLUME: &str = "MeshVersionFormatted 2\nDimension ^3\nVertices !5\n~0 ~0 ~0.5 0\n~1 ~0 ~0.5 0\n~0 ~1 ~0.5 0
~0 ~0 ~1.5 5\n~0.5 ~0.5 ~-0.5 1\n;Tetrahedra !2\n@1 @2 @3 @4 7\n@1 @3 @2 @5 8\n;Pyramids !1\n@1 @2 @3 @4 @5 9\n;
Quadrilaterals !2\n@1 @2 @3 @4 5\n@5 @4 @3 @2 6\n;RequiredQuadrilaterals !1\n2\n;End\n";

const CURVED: &str =
    "MeshVersionFormatted 2\nDimension ^2\nVertices\n!6\n~0 ~0 1\n~1 ~0 -2\n~0 ~1.5e-3 0\n~0.5 ~-0.1 0\n~0.5 ~0.5 0
~0 ~0.5 0\n;EdgesP2 !1\n@1 @2 @4 6\n;\nTrianglesP2\n!1\n@4 @1 @2 @3 @5 @6 1\n;TrianglesP2Ordering !6
!1 1 0\n!2 0 0\n!0 2 0\n!0 0 2\n!0 1 1\n!1 0 1\n;RequiredEdges !1\n1\n;End\n";

const TENSORS: &str =
    "MeshVersionFormatted 2\n\nDimension ^2\n\nSolAtVertices\n!3\n!1 !3\n~1 ~0.5 ~2\n~1.D0 ~0 ~1e-9\n~3 ~0 ~3\n;End\n";

const SEVERAL: &str =
    "MeshVersionFormatted 2\nDimension\n^3\nSolAtVertices !2\n!3 1 2 3\n~0.5 ~1 ~2 ~3 ~1 ~0 ~1 ~0 ~0 ~1
~0.25 ~1 ~2 ~3 ~4 ~0 ~4 ~0 ~0 ~4\n;SolAtTriangles\n!2\n!1 1\n~7\n~8\n;End\n";

const OBJ: &str =
    ";mtllib a.mtl\n;v ~0 ~0 ~0\n;v ~1 ~0 ~0 ;# corner\n;v ~1 ~1 ~0\n;v ~0 ~1e-3 ~0.5\n;vt ;0 0\n;g region_-7
;f @1 @2 @3\n;f @1/2/3 @3//1 @4/2\n;g other\n;f @4 @3 @2\n;l @1 @2\n;l @2 @3\n;";

const OBJ_ROWS: &str = ";v ~0 ~0 ~0 ;1 ;0 ;0\n;v ~1 ~0 \\\n~0 ;1 ;0 ;0\n;v ~1 ~1 ~0\n;v ~0 ~1e-3 ~0.5\n;p ;1\n;f @1 @2 \\\n@3 ;@4\n;f -4 \\\n\\\n-3 -2;\n";

const OFF: &str =
    "OFF\n!4 !3 0\n~0 ~0 ~0\n~1 ~0 ~0\n~1 ~1 ~0\n~0 ~1 ~0.5\n4 @0 @1 @2 @3 \n!3 @2 @1 @0 # a comment\n!3 @3 @2 @1\n;";

const PLY: &str = "ply\nformat ascii 1.0\ncomment by hand\nelement vertex !4\nproperty float x\nproperty uchar shade
property double y\nproperty float z\nproperty double u\nelement face !3\nproperty list uchar int vertex_indices
property list ushort short extra\nelement edge !1\nproperty int vertex1\nproperty int vertex2\nproperty int label\nend_header
~0 ~9 ~0.25 ~0 ~0.5\n~1 ~9 ~0.25 ~0 ~0.5\n~1 ~9 ~1.25 ~0 ~0.5\n~0 ~9 ~1.25 ~0.5 ~0.5\n!3 @0 @1 @2 1 -7
!3 @2 @3 @0 0\n!4 @0 @1 @2 @3 1 0.5\n@0 @1 5\n;";

const STRIPS: &str = "ply\nformat ascii 1.0\nelement vertex !4\nproperty float x\nproperty float y\nproperty float z
element tristrips !2\nproperty list int int vertex_indices\nend_header\n~0 ~0 ~0.5\n~1 ~0 ~0.5\n~1 ~1 ~0.5\n~0 ~1 ~1.5
!7 @0 @1 @2 -1 @3 @2 @1\n!4 @1 @2 @3 -1\n;";

const STL: &str = "solid a facet of life\nfacet normal nan 0 1\nouter loop\nvertex ~0 ~0 ~0\nvertex ~1 ~0 ~0\nvertex ~0 ~1 ~0
endloop\nendfacet\nfacet normal 0 0 1\nouter loop\nvertex ~1 ~0 ~0\nvertex ~1 ~1 ~0\nvertex ~-0 ~1 ~0.5\nendloop\nendfacet
endsolid; life\n;";

const POLY: &str =
    "# a square\n!4 ^2 !1 !1\n1 ~0 ~0 0.5 1\n2 ~1 ~0 0.5 1\n3 ~1 ~1 0.5 2\n4 ~0 ~1e-1 0.5 0\n!4 !1\n1 @1 @2 1
2 @2 @3 1\n3 @3 @4 2\n4 @4 @1 -2\n;!1\n1 ~0.5 ~0.5\n;!2\n1 ~0.1 ~0.1 ~7 ~0.5\n2 ~0.2 ~0.2 ~8\n;";

const GEOJSON: &str = "{\"type\": \"FeatureCollection\", \"features\": [
{\"type\": \"Feature\", \"properties\": {\"region\": 5, \"boundary\": [3, 4]}, \"geometry\":
{\"type\": \"Polygon\", \"coordinates\": [[[~0, ~0], [~4, ~0], [~4, ~4], [~0, ~4], [~0, ~0]],
[[~1, ~1], [~1, ~2], [~2, ~2], [~1, ~1]]]}},
{\"type\": \"Feature\", \"properties\": null, \"geometry\": null},
{\"type\": \"Feature\", \"properties\": {\"ref\": \"x\", \"label\": 7.0}, \"geometry\": {\"type\": \"MultiPolygon\",
\"coordinates\": [[[[~0, ~0], [~4e-1, ~0], [~4, ~4], [~0, ~0]]]]}}]}\n";

const POINTS: &str = ";# ;seeds\n ~1 ~2\n;\n~-3e2\t~4.5; ~0; # third\n;~7 ~8\n;";

const FREEFEM: &str = "!4 !2 !2\n~0 ~0 1\n~1 ~0 2\n~1 ~1 3\n~0 ~1 4\n@1 @2 @3 7\n@1 @3 @4 8\n@1 @2 5\n@3 @4 6\n;";

const GMSH_2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n!1\n2 7 \"triangle label -3\"\n$EndPhysicalNames
$Nodes\n!4\n1 ~0 ~0 ~0\n2 ~1 ~0 ~0\n3 ~1 ~1 ~0\n4 ~0 ~1e-1 ~0.5\n$EndNodes\n;$Elements\n!5\n1 15 2 1 1 @2\n2 1 2 5 1 @1 @2
3 2 2 7 1 @1 @2 @3\n4 2 2 8 1 @1 @3 @4\n5 3 !2 8 1 @1 @2 @3 @4\n$EndElements\n;
$NodeData\n!1\n\"u\"\n!1\n0.0\n!3\n0\n!1\n!4\n@1 ~0.5\n@2 ~0.5\n@3 ~1e-3\n@4 ~0.5\n$EndNodeData\n;";

const GMSH_CURVED: &str =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n!7\n1 ~0 ~0 ~0\n2 ~1 ~0 ~0\n3 ~0 ~1e-1 ~0.5\n4 ~0.5 ~0 ~0
5 ~0.5 ~0.5 ~0\n6 ~0 ~0.5 ~0\n7 ~3 ~3 ~0\n$EndNodes\n;$Elements\n!2\n1 8 2 5 1 @1 @2 @4\n2 9 !2 8 1 @1 @2 @3 @4 @5 @6
$EndElements\n;$NodeData\n!1\n\"u\"\n!1\n0.0\n!3\n0\n!1\n!3\n@1 ~0.5\n@2 ~0.5\n@3 ~1e-3\n$EndNodeData\n;";

const GMSH_VOLUME: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n!5\n1 ~0 ~0 ~0\n2 ~1 ~0 ~0\n3 ~1 ~1 ~0
4 ~0 ~1e-1 ~0.5\n5 ~0 ~0 ~-1\n$EndNodes\n;$Elements\n!3\n1 4 !2 7 1 @1 @2 @3 @4\n2 4 2 8 1 @1 @3 @2 @5\n3 7 2 8 1 @1 @2 @3 @4 @5
$EndElements\n;$ElementData\n!1\n\"e\"\n!1\n0.0\n!3\n0\n!1\n!3\n1 ~0.5\n2 ~0.5\n3 ~1e-3\n$EndElementData\n;";

const GMSH_4: &str =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n!0 !1 !1 !0\n1 0 0 0 1 1 1 !1 5 !0\n1 0 0 0 1 1 1 !1 7 !1 1
$EndEntities\n$Nodes\n!2 !4 1 4\n2 1 0 !1\n1\n~0 ~0 ~0\n2 1 0 !3\n2\n3\n4\n~1 ~0 ~0\n~1 ~1 ~0\n~0 ~1 ~0.5\n$EndNodes\n;
$Elements\n!2 !4 1 4\n1 1 1 !2\n1 @1 @2\n2 @2 @3\n2 1 2 !2\n3 @1 @2 @3\n4 @1 @3 @4\n$EndElements\n;
$ElementData\n!1\n\"error\"\n!1\n0.0\n!3\n0\n!3\n!2\n3 ~0.5 ~1 ~2\n4 ~0.5 ~1 ~3\n$EndElementData\n;";

const VTU: &str =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">
<UnstructuredGrid>\n<Piece NumberOfPoints=\"!4\" NumberOfCells=\"!3\">\n<PointData>
<DataArray type=\"Int32\" Name=\"label\" format=\"ascii\">1 1 2 3</DataArray>
<DataArray type=\"Float64\" Name=\"u\" NumberOfComponents=\"2\" format=\"ascii\">~1 ~2 ~3 ~4 ~5e-1 ~6 ~7 ~8</DataArray>
</PointData>\n<CellData>\n<DataArray type=\"UInt8\" Name=\"required\" format=\"ascii\">0 1 1</DataArray>\n</CellData>
<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"!3\" format=\"ascii\">
~0 ~0 ~0\n~1 ~0 ~0\n~1 ~1 ~0\n~0 ~1e-1 ~0.5\n</DataArray>\n</Points>\n<Cells>
<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">@0 @1 @2 @2 @3 @0 @0 @1</DataArray>
<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">!3 !6 !8</DataArray>
<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5 5 3</DataArray>
</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";

const VTU_CURVED: &str = "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">
<UnstructuredGrid>\n<Piece NumberOfPoints=\"!6\" NumberOfCells=\"!2\">\n<PointData>
<DataArray type=\"Float64\" Name=\"u\" format=\"ascii\">~1 ~2 ~3 ~4 ~5e-1 ~6</DataArray>
</PointData>\n<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"!3\" format=\"ascii\">
~0 ~0 ~0\n~1 ~0 ~0\n~0 ~1e-1 ~0.5\n~0.5 ~0 ~0\n~0.5 ~0.5 ~0\n~0 ~0.5 ~0\n</DataArray>\n</Points>\n<Cells>
<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">@0 @1 @2 @3 @4 @5 @0 @1 @3</DataArray>
<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">!6 !9</DataArray>
<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">22 68</DataArray>
</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";

const VTU_VOLUME: &str = "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">
<UnstructuredGrid>\n<Piece NumberOfPoints=\"!5\" NumberOfCells=\"!2\">\n<CellData>
<DataArray type=\"Int32\" Name=\"label\" format=\"ascii\">7 8</DataArray>\n</CellData>
<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"!3\" format=\"ascii\">
~0 ~0 ~0\n~1 ~0 ~0\n~1 ~1 ~0\n~0 ~1e-1 ~0.5\n~0 ~0 ~-1\n</DataArray>\n</Points>\n<Cells>
<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">@0 @1 @2 @3 @0 @1 @2 @3 @4</DataArray>
<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">!4 !9</DataArray>
<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 14</DataArray>
</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";

const VTP: &str = "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\">
<PolyData>\n<Piece NumberOfPoints=\"!4\" NumberOfVerts=\"0\" NumberOfLines=\"!1\" NumberOfStrips=\"!1\" NumberOfPolys=\"!2\">
<CellData>\n<DataArray type=\"Int32\" Name=\"label\" format=\"ascii\">5 6 7 8</DataArray>\n</CellData>
<Points>\n<DataArray type=\"Float32\" Name=\"Points\" NumberOfComponents=\"!3\" format=\"ascii\">
~0 ~0 ~0\n~1 ~0 ~0\n~1 ~1 ~0\n~0 ~1e-1 ~0.5\n</DataArray>\n</Points>\n<Lines>
<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">@0 @1 @2</DataArray>
<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">!3</DataArray>\n</Lines>\n<Strips>
<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">@0 @1 @2 @3</DataArray>
<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">!4</DataArray>\n</Strips>\n<Polys>
<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">@0 @1 @2 @3 @0 @1 @3</DataArray>
<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">4 !7</DataArray>\n</Polys>
</Piece>\n</PolyData>\n</VTKFile>\n";
