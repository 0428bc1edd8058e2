//! Malformed files of every format: small valid ones are cut off, and their counts, references, dimensions and coordinates made
//! to lie one by one; each of these must be refused. Then they are damaged at random, which may leave them valid. Whatever is
//! read must be sound, and whatever is refused must say what, where and what to do. No file makes a reader take more memory than it
//! accounts for.

mod binary;
mod mutations;
mod reading;
mod sample;
mod text;

use mutations::{cuts, lies, random};
use reading::{Outcome, read};
use sample::Sample;

/// Fewest mutations of a sample.
const FEWEST: usize = 200;

#[test]
fn text_files() {
    text::samples().iter().for_each(survive);
}

#[test]
fn binary_files() {
    binary::samples().iter().for_each(survive);
}

#[test]
fn valid_files_are_read() {
    for sample in text::samples().iter().chain(&binary::samples()) {
        assert!(matches!(read(sample, &sample.bytes), Outcome::Sound), "{}: {:?}", sample.name, read(sample, &sample.bytes));
    }
}

fn survive(sample: &Sample) {
    let mut tried = 0;
    for (what, bytes) in lies(sample).chain(cuts(sample)) {
        tried += 1;
        match read(sample, &bytes) {
            Outcome::Refused => {}
            outcome => panic!("{}, {what}: {outcome:?}\n{}", sample.name, bytes.escape_ascii()),
        }
    }
    for bytes in random(sample, 2 * FEWEST) {
        tried += 1;
        match read(sample, &bytes) {
            Outcome::Refused | Outcome::Sound => {}
            outcome => panic!("{}: {outcome:?}\n{}", sample.name, bytes.escape_ascii()),
        }
    }
    assert!(tried >= FEWEST);
}
