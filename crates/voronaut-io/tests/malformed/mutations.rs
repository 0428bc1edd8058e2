//! Damage done to files.

use crate::reading::Reader;
use crate::sample::{Cuts, Kind, Mark, Number, Sample, in_order};

/// Every number that matters, replaced by every one that must not stand there; with words on what was done.
pub(crate) fn lies(sample: &Sample) -> impl Iterator<Item = (String, Vec<u8>)> {
    sample.marks.iter().flat_map(move |mark| {
        let lies = match mark.number {
            Number::Text => text_lies(sample, mark),
            number => binary_lies(sample, mark.kind, number),
        };
        lies.into_iter().map(move |lie| {
            let what = format!("{:?} at byte {} made {}", mark.kind, mark.place.start, lie.escape_ascii());
            let (before, after) = (&sample.bytes[..mark.place.start], &sample.bytes[mark.place.end..]);
            (what, [before, &lie, after].concat())
        })
    })
}

/// The file cut off wherever that must be seen.
pub(crate) fn cuts(sample: &Sample) -> impl Iterator<Item = (String, Vec<u8>)> {
    let whole = sample.bytes.trim_ascii_end().len();
    let must_fail = move |length: &usize| match &sample.cuts {
        Cuts::Bytes(ends) => !ends.contains(length),
        Cuts::Words(ends) => {
            let left = words(&sample.bytes[..*length]);
            !ends.iter().any(|&end| left == end || left == end + 1)
        }
    };
    (0..whole).filter(must_fail).map(|length| (format!("cut off at {length}"), sample.bytes[..length].to_vec()))
}

/// So many files with one to three damages each.
pub(crate) fn random(sample: &Sample, count: usize) -> impl Iterator<Item = Vec<u8>> {
    let mut dice = Dice(sample.bytes.len() as u64);
    (0..count).map(move |_| {
        let mut bytes = sample.bytes.clone();
        for _ in 0..=dice.roll(3) {
            damage(&mut bytes, &mut dice);
        }
        bytes
    })
}

const NO_WHOLE_NUMBERS: [&str; 6] = ["1e18", "1e308", "nan", "0.5", "x", "99999999999999999999"];
const HUGE: [i64; 5] = [1 << 31, 1 << 32, 1_000_000_000_000_000_000, i64::MAX, -1];

fn text_lies(sample: &Sample, mark: &Mark) -> Vec<Vec<u8>> {
    let text = std::str::from_utf8(&sample.bytes[mark.place.clone()]).expect("text");
    let whole = || text.parse::<i64>().expect("a whole number");
    let numbers = match mark.kind {
        Kind::Coordinate => {
            return ["nan", "inf", "-inf", "1e999", "x", "--1", "0x1"].map(|x| x.as_bytes().into()).into();
        }
        Kind::Count => false_counts(whole()),
        Kind::Reference => false_references(sample),
        Kind::Dimension => vec![0, 1, 4, 5 - whole(), -2, 1 << 32],
        Kind::Position => panic!("texts have no positions"),
    };
    let numbers = numbers.into_iter().map(|x| x.to_string().into_bytes());
    numbers.chain(NO_WHOLE_NUMBERS.map(|x| x.as_bytes().into())).collect()
}

fn binary_lies(sample: &Sample, kind: Kind, number: Number) -> Vec<Vec<u8>> {
    let (big, value) = match number {
        Number::F32(big) => {
            return [f32::NAN, f32::INFINITY, f32::NEG_INFINITY].map(|x| in_order(&x.to_le_bytes(), big)).into();
        }
        Number::F64(big) => {
            return [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|x| in_order(&x.to_le_bytes(), big)).into();
        }
        Number::I32(value, big) => (big, value.into()),
        Number::I64(value, big) => (big, value),
        Number::U8(value) => (false, value.into()),
        Number::Text => panic!("not binary"),
    };
    let mut numbers = match kind {
        Kind::Count => false_counts(value),
        Kind::Reference => false_references(sample),
        Kind::Dimension => vec![0, 1, 4, 5 - value, -2],
        Kind::Position => vec![-1, 4, value - 4, value + 4, 1 << 30],
        Kind::Coordinate => panic!("no whole number"),
    };
    numbers.extend([i32::MAX, i32::MIN].map(i64::from));
    let fits = |x: &i64| match number {
        Number::U8(_) => u8::try_from(*x).is_ok(),
        Number::I32(..) => i32::try_from(*x).is_ok(),
        _ => true,
    };
    numbers.retain(fits);
    let size = match number {
        Number::U8(_) => 1,
        Number::I32(..) => 4,
        _ => 8,
    };
    numbers.into_iter().map(|x| in_order(&x.to_le_bytes()[..size], big)).collect()
}

fn false_counts(truth: i64) -> Vec<i64> {
    let mut counts = [HUGE.as_slice(), &[truth + 1, truth - 1, truth + 100, 255, 0]].concat();
    counts.retain(|&count| count != truth);
    counts
}

fn false_references(sample: &Sample) -> Vec<i64> {
    let (first, end) = (sample.references.start, sample.references.end);
    let mut references = [HUGE.as_slice(), &[first - 1, end, end + 100, first - 100]].concat();
    // There -1 is the last vertex so far.
    references.retain(|&reference| reference != -1 || sample.reader != Reader::Obj);
    references
}

fn words(bytes: &[u8]) -> usize {
    bytes.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).count()
}

/// A sequence of numbers that is the same each time (`SplitMix64`).
struct Dice(u64);

impl Dice {
    /// One of the numbers below `sides`, or 0.
    fn roll(&mut self, sides: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((x ^ (x >> 31)) % sides.max(1) as u64) as usize
    }
}

/// Words that mean something somewhere.
const WORDS: [&str; 16] = [
    "0",
    "-1",
    "1",
    "3",
    "4294967295",
    "4294967296",
    "1e18",
    "1e308",
    "nan",
    "End",
    "#",
    "\n",
    "\"",
    "Triangles",
    ">",
    "-0",
];

/// Flips a bit, puts a byte, a word or a number somewhere, or drops, doubles or swaps parts, lines or words among them.
fn damage(bytes: &mut Vec<u8>, dice: &mut Dice) {
    if bytes.is_empty() {
        return;
    }
    let at = dice.roll(bytes.len());
    match dice.roll(9) {
        0 => bytes[at] ^= 1 << dice.roll(8),
        1 => bytes[at] = dice.roll(256) as u8,
        2 => bytes.truncate(at),
        3 => {
            let word = part(bytes, at, u8::is_ascii_whitespace);
            bytes.splice(word, WORDS[dice.roll(WORDS.len())].bytes());
        }
        4 => drop(bytes.drain(part(bytes, at, |byte| *byte == b'\n'))),
        5 => {
            let line = part(bytes, at, |byte| *byte == b'\n');
            let copy = [b"\n", &bytes[line.clone()]].concat();
            bytes.splice(line.end..line.end, copy);
        }
        6 => {
            let word = part(bytes, at, u8::is_ascii_whitespace);
            let other = part(bytes, dice.roll(bytes.len()), u8::is_ascii_whitespace);
            let (first, second) = if word.start < other.start { (word, other) } else { (other, word) };
            let (a, b) = (bytes[first.clone()].to_vec(), bytes[second.clone()].to_vec());
            bytes.splice(second, a);
            bytes.splice(first, b);
        }
        7 => {
            let end = (at + 1 + dice.roll(16)).min(bytes.len());
            if dice.roll(2) == 0 {
                drop(bytes.drain(at..end));
            } else {
                bytes.splice(at..at, bytes[at..end].to_vec()).for_each(drop);
            }
        }
        _ => {
            let number = [0, 0xff, 0x7f, 0x80][dice.roll(4)];
            let end = (at + [1, 2, 4, 8][dice.roll(4)]).min(bytes.len());
            bytes[at..end].fill(number);
        }
    }
}

/// The part around a byte that has no byte of one sort, or that byte.
fn part(bytes: &[u8], at: usize, ends: impl Fn(&u8) -> bool) -> std::ops::Range<usize> {
    if ends(&bytes[at]) {
        return at..at + 1;
    }
    let start = bytes[..at].iter().rposition(&ends).map_or(0, |end| end + 1);
    let end = bytes[at..].iter().position(&ends).map_or(bytes.len(), |end| at + end);
    start..end
}
