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
use reading::{Outcome, one_at_a_time, read};
use sample::Sample;

/// Fewest mutations of a sample.
const FEWEST: usize = 200;

#[test]
fn text_files() {
    survive(&text::samples());
}

#[test]
fn binary_files() {
    survive(&binary::samples());
}

/// Damages files in every way, and lists what readers make of them that they should not.
fn survive(samples: &[Sample]) {
    let _guard = one_at_a_time();
    let mut faults = Vec::new();
    for sample in samples {
        if !matches!(read(sample, &sample.bytes), Outcome::Sound) {
            faults.push(format!("{}, whole: {:?}", sample.name, read(sample, &sample.bytes)));
        }
        let refused = lies(sample).chain(cuts(sample)).map(|(what, bytes)| (what, bytes, true));
        let random = random(sample, 2 * FEWEST).map(|bytes| ("damaged at random".to_owned(), bytes, false));
        let mut tried = 0;
        for (what, bytes, must_fail) in refused.chain(random) {
            tried += 1;
            let outcome = read(sample, &bytes);
            if !(matches!(outcome, Outcome::Refused) || matches!(outcome, Outcome::Sound) && !must_fail) {
                faults.push(format!("{}, {what}: {outcome:?}\n    {}", sample.name, bytes.escape_ascii()));
            }
        }
        assert!(tried >= FEWEST);
    }
    assert!(faults.is_empty(), "{} faults\n{}", faults.len(), faults.join("\n"));
}
