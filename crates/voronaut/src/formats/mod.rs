//! formats

pub mod medit;
