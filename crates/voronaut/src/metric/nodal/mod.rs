//! Metrics at the vertices of a mesh.
