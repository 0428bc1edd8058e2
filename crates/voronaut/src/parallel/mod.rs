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

use prelude::*;

/// Bytes that are worth a thread's while to copy.
const COPIED: usize = 1 << 19;

/// Makes a list another one, in the memory that it has.
pub(crate) fn copy_over<T: Copy + Send + Sync>(to: &mut Vec<T>, from: &[T]) {
    let part = (COPIED / size_of::<T>().max(1)).max(1);
    if to.len() == from.len() {
        to.par_chunks_mut(part).zip(from.par_chunks(part)).for_each(|(to, from)| to.copy_from_slice(from));
    } else {
        *to = from.par_iter().with_min_len(part).copied().collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_becomes_another_of_any_length() {
        let many = 3 * COPIED / size_of::<usize>();
        for (before, length) in [(0, 5), (9, 5), (5, 5), (many, many), (2, many + 1)] {
            let from: Vec<usize> = (0..length).collect();
            let mut to = vec![7; before];
            copy_over(&mut to, &from);
            assert_eq!(to, from);
        }
    }
}
