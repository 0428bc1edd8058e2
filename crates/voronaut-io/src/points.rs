//! Lists of points: a line `x y` (or `x y z`) each; empty lines and what follows `#` say nothing.

use super::codec::Place;
use voronaut::Result;

/// Reads points of two coordinates or three, each with its line from 1. To two a third may be added that is 0. `name` is the file's,
/// for messages.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) with the line that is no point.
pub fn read<const N: usize>(text: &str, name: &str) -> Result<Vec<(usize, [f64; N])>> {
    let numbers = if N == 2 { "two numbers, x y" } else { "three numbers, x y z" };
    let rows = text.lines().map(|line| line.split('#').next().unwrap_or_default().trim());
    let fault = |line, row: &str| {
        let shown: String = row.chars().take(40).collect();
        Place::line(name, line).error(format!("'{shown}' is no point"), format!("write {numbers}, on each line"))
    };
    let read = |(line, row)| Ok((line, point(row).ok_or_else(|| fault(line, row))?));
    (1..).zip(rows).filter(|(_, row)| !row.is_empty()).map(read).collect()
}

fn point<const N: usize>(row: &str) -> Option<[f64; N]> {
    let number = |word: &str| word.parse().ok().filter(|x: &f64| x.is_finite());
    let numbers: Vec<f64> = row.split_whitespace().map(number).collect::<Option<_>>()?;
    match numbers[..] {
        [x, y, 0.0] if N == 2 => [x, y].as_slice().try_into().ok(),
        _ => numbers.try_into().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_read_and_faults_named() {
        let points = read("# seeds\n 1 2\n\n-3e2\t4.5 0 # third\n", "s.txt").unwrap();
        assert_eq!(points, [(2, [1.0, 2.0]), (4, [-300.0, 4.5])]);
        for bad in ["1", "1 2 3", "a b", "1 nan", "1 2 0 0"] {
            let error = read::<2>(&format!("0 0\n{bad}"), "s.txt").unwrap_err();
            assert!(error.to_string().starts_with("s.txt:2:"), "{error}");
        }
        assert!(read::<2>("", "s.txt").unwrap().is_empty());
        assert_eq!(read("1 2 -3\n", "s.txt").unwrap(), [(1, [1.0, 2.0, -3.0])]);
        for bad in ["1 2", "1 2 inf", "1 2 3 4"] {
            let error = read::<3>(bad, "s.txt").unwrap_err();
            assert!(error.to_string().starts_with("s.txt:1:") && error.help().contains("x y z"), "{error}");
        }
    }
}
