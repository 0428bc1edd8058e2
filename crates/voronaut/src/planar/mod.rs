//! planar
