//! All tests of what is public, in one program, but for those that measure memory (`malformed`).

mod foreign;
mod outlines;
mod polys;
