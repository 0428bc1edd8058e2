//! The sections of Medit's files that matter here, and their numbers in binary ones.

/// Code and name, as libMeshb has them.
pub(super) const KEYWORDS: [(i32, &str); 24] = [
    (3, "Dimension"),
    (4, "Vertices"),
    (5, "Edges"),
    (6, "Triangles"),
    (7, "Quadrilaterals"),
    (8, "Tetrahedra"),
    (9, "Prisms"),
    (10, "Hexahedra"),
    (13, "Corners"),
    (14, "Ridges"),
    (15, "RequiredVertices"),
    (16, "RequiredEdges"),
    (17, "RequiredTriangles"),
    (18, "RequiredQuadrilaterals"),
    (19, "TangentAtEdgeVertices"),
    (20, "NormalAtVertices"),
    (49, "Pyramids"),
    (54, "End"),
    (59, "Tangents"),
    (60, "Normals"),
    (62, "SolAtVertices"),
    (63, "SolAtEdges"),
    (64, "SolAtTriangles"),
    (66, "SolAtTetrahedra"),
];

/// The code of a section of the list.
///
/// # Panics
/// If it is not in the list.
pub(super) fn code_of(name: &str) -> i32 {
    KEYWORDS.iter().find(|(_, known)| *known == name).expect("a section of the list").0
}
