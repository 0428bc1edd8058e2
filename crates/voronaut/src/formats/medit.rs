//! Stub: the real one comes with the other branch.

use crate::error::Result;
use crate::mesh::Mesh;

/// Stub.
///
/// # Errors
/// Always.
pub fn read(_text: &str, place: &str) -> Result<Mesh> {
    Err(crate::Error::parse(place, "stub", ""))
}

/// Stub.
pub fn write(_mesh: &Mesh) -> String {
    String::new()
}
