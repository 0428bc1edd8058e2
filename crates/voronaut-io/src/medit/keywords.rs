//! The sections of Medit's files that matter here, and their numbers in binary ones, as libMeshb has them.

/// Sections of meshes that are read.
pub(super) const SECTIONS: [(i32, &str); 15] = [
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
    (49, "Pyramids"),
];

/// Others whose names are known.
const OTHERS: [(i32, &str); 9] = [
    (19, "TangentAtEdgeVertices"),
    (20, "NormalAtVertices"),
    (54, "End"),
    (59, "Tangents"),
    (60, "Normals"),
    (62, "SolAtVertices"),
    (63, "SolAtEdges"),
    (64, "SolAtTriangles"),
    (66, "SolAtTetrahedra"),
];

/// Code and name of all that are known.
pub(super) fn keywords() -> impl Iterator<Item = (i32, &'static str)> {
    SECTIONS.into_iter().chain(OTHERS)
}

/// The code of a section that is known.
///
/// # Panics
/// If it is not.
pub(super) fn code_of(name: &str) -> i32 {
    keywords().find(|(_, known)| *known == name).expect("a section of the list").0
}
