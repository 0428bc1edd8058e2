//! Loops on all cores, in one place: those of rayon with the feature `threads`, which is on by default; without it loops of the
//! same names on one core, for where there are no threads (WebAssembly). Results are the same to the bit: no loop of this
//! library depends on how its parts are shared out.

#[cfg(not(feature = "threads"))]
mod plain;

/// What loops are written with.
pub(crate) mod prelude {
    #[cfg(not(feature = "threads"))]
    pub(crate) use super::plain::*;
    #[cfg(feature = "threads")]
    pub(crate) use rayon::prelude::*;
}

#[cfg(not(feature = "threads"))]
pub(crate) use plain::join;
#[cfg(feature = "threads")]
pub(crate) use rayon::join;
