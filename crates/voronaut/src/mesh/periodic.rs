//! Vertices that correspond: those of two boundary curves that a rigid motion maps onto each other.

use serde::{Serialize, Serializer};

/// Two curves of the boundary whose edges correspond.
///
/// The partner of the vertex (x, y) is at (c x - s y + u, s x + c y + v), rounded after each operation from the left to the right, to the
/// last bit; but corners of the domain stay where the user put them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Periodic {
    /// The labels of their edges.
    pub labels: [i32; 2],
    /// The cosine c and the sine s of the angle by which the motion turns.
    pub rotation: [f64; 2],
    /// How far (u, v) it moves what it has turned.
    pub translation: [f64; 2],
    /// How far the corners of the second curve are from where the motion brings those of the first, at most.
    pub off: f64,
    /// Vertices with their partners, in order along the curves. In a report their number.
    #[serde(serialize_with = "count")]
    pub vertices: Vec<[u32; 2]>,
}

fn count<S: Serializer>(vertices: &[[u32; 2]], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_u64(vertices.len() as u64)
}
