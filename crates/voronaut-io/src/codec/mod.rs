//! Numbers in files, as words of text or as bytes: what all formats are read and written by.
//!
//! Who reads says how wide a number is; whether it is text, and which of its bytes comes first, knows the [`Source`]. It never trusts a
//! count: memory follows what is there, and what is not there is an error with its [`Place`]. Who writes puts one number after the
//! other into a [`Sink`].

mod kinds;
mod places;
mod sink;
mod source;

pub use kinds::Form;
pub(crate) use kinds::{Kind, Order};
pub(crate) use places::{At, Largest, Place, Text, shortened};
pub(crate) use sink::{Number, Shortest, Sink};
pub(crate) use source::{Counted, Source};

use voronaut::Result;

/// As many as are asked for, one by one.
///
/// # Errors
/// The first that there is.
pub(crate) fn several<T: Copy + Default, const N: usize>(mut next: impl FnMut() -> Result<T>) -> Result<[T; N]> {
    let mut found = [T::default(); N];
    for item in &mut found {
        *item = next()?;
    }
    Ok(found)
}
