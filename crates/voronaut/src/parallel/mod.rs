//! Loops on all cores, in one place: those of rayon with the feature `threads`, which is on by default; without it, and in
//! WebAssembly, where there are no threads, loops of the same names on one core. Results are the same to the bit: no loop of this
//! library depends on how its parts are shared out.

#[cfg(any(not(feature = "threads"), target_family = "wasm"))]
mod plain;

/// What loops are written with.
pub(crate) mod prelude {
    #[cfg(any(not(feature = "threads"), target_family = "wasm"))]
    pub(crate) use super::plain::*;
    #[cfg(all(feature = "threads", not(target_family = "wasm")))]
    pub(crate) use rayon::prelude::*;
}

#[cfg(any(not(feature = "threads"), target_family = "wasm"))]
pub(crate) use plain::join;
#[cfg(all(feature = "threads", not(target_family = "wasm")))]
pub(crate) use rayon::join;
