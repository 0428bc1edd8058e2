//! Words in pictures, as lines: a PNG has no fonts.

use super::frame::{Frame, PathData};

/// Units between letters.
const GAP: f64 = 2.2;
/// Units of a space.
const SPACE: f64 = 2.0;
/// Where letters without a tail stand, in units from the lowest point of those with one.
const BASE: f64 = 2.0;

/// Adds words to a path, to be stroked, whose baseline begins at a place in pixels; a capital would be six units (pixels each)
/// high. What is not in [`strokes`] is left out.
pub(super) fn write(path: &mut PathData, words: &str, [x, y]: [f64; 2], unit: f64, frame: &Frame) {
    let mut left = x;
    for letter in words.chars() {
        for line in lines(letter) {
            let at = |p: &[f64; 2]| frame.quanta_at([left + unit * p[0], y - unit * (p[1] - BASE)]);
            path.polyline(&line.iter().map(at).collect::<Vec<_>>(), false);
        }
        left += unit * advance(letter);
    }
}

fn advance(letter: char) -> f64 {
    lines(letter).flatten().map(|p| p[0]).reduce(f64::max).unwrap_or(SPACE) + GAP
}

/// The points of the lines of a letter: right and up.
fn lines(letter: char) -> impl Iterator<Item = Vec<[f64; 2]>> {
    let digit = |byte: u8| f64::from(byte - b'0');
    let points = move |line: &str| line.as_bytes().chunks_exact(2).map(|p| [digit(p[0]), digit(p[1])]).collect();
    strokes(letter).split(' ').filter(|line| !line.is_empty()).map(points)
}

/// The lines of a letter, each the digits of its points: right and up. Small letters are four units high.
fn strokes(letter: char) -> &'static str {
    match letter {
        'a' => "4642 4536160503123243",
        'b' => "0802 0516364543321203",
        'c' => "4536160503123243",
        'd' => "4842 4536160503123243",
        'e' => "04444536160503123243",
        'f' => "38281712 0636",
        'g' => "4641301001 4536160503123243",
        'h' => "0802 0516364542",
        'i' => "0602 0808",
        'j' => "161100 1818",
        'k' => "0802 0336 1432",
        'l' => "0802",
        'm' => "0602 0516263532 3546566562",
        'n' => "0602 0516364542",
        'o' => "051636454332120305",
        'p' => "0600 0516364543321203",
        'q' => "4640 4536160503123243",
        'r' => "0602 051636",
        's' => "45361605143443321203",
        't' => "18132232 0636",
        'u' => "0603123243 4642",
        'v' => "062246",
        'w' => "0612355266",
        'x' => "0642 4602",
        'y' => "0622 4610",
        'z' => "06460242",
        '0' => "071838474332120307",
        '1' => "172822",
        '2' => "07183847460242",
        '3' => "084825354443321203",
        '4' => "32380444",
        '5' => "480805354443321203",
        '6' => "4738180703123243443504",
        '7' => "084812",
        '8' => "15060718384746351504031232434435",
        '9' => "0312324347381807061546",
        '%' => "0258 0718271607 3443524334",
        '.' => "0202",
        ',' => "1201",
        ':' => "0202 0505",
        '-' => "0434",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use voronaut::geometry::{Aabb, Point};

    #[test]
    fn small_letters_and_figures_are_there_and_differ() {
        let all: Vec<&str> = ('a'..='z').chain('0'..='9').chain("%.,:-".chars()).map(strokes).collect();
        for (i, lines) in all.iter().enumerate() {
            assert!(lines.split_whitespace().all(|line| line.len() >= 4 && line.len() % 2 == 0), "{lines}");
            assert!(!lines.is_empty() && !all[..i].contains(lines), "{lines}");
        }
    }

    #[test]
    fn words_are_as_wide_as_they_are_drawn() {
        let bounds = Aabb { min: Point::default(), max: Point::new(1.0, 1.0) };
        let frame = Frame::new(bounds, 100.0, |_| 1.0);
        let mut path = PathData::default();
        write(&mut path, "l l", [10.0, 50.0], 2.0, &frame);
        let mut second = PathData::default();
        write(&mut second, "l", [10.0, 50.0], 2.0, &frame);
        write(&mut second, "l", [10.0 + 2.0 * (advance('l') + advance(' ')), 50.0], 2.0, &frame);
        assert_eq!(path.text(), second.text());
    }
}
