//! Lists of points: a line `x y` (or `x y z`) each; empty lines and what follows `#` say nothing.

use voronaut::geometry::{Point, Point3};
use voronaut::{Error, Result};

/// Reads planar points; a third coordinate must be 0. `name` is the file's, for messages.
///
/// # Errors
/// [`Error::Parse`] with the line that is no point.
pub fn read(text: &str, name: &str) -> Result<Vec<Point>> {
    let help = "write two numbers, x y, on each line";
    rows(text).map(|(number, row)| point(row).ok_or_else(|| fault(name, number, row, help))).collect()
}

/// Reads points of space. `name` is the file's, for messages.
///
/// # Errors
/// [`Error::Parse`] with the line that is no point.
pub fn read_in_space(text: &str, name: &str) -> Result<Vec<Point3>> {
    let help = "write three numbers, x y z, on each line";
    let point = |row: &str| match numbers(row)?[..] {
        [x, y, z] => Some(Point3::new(x, y, z)).filter(|p| p.is_finite()),
        _ => None,
    };
    rows(text).map(|(number, row)| point(row).ok_or_else(|| fault(name, number, row, help))).collect()
}

/// The line of each point of a text that [`read`] reads, from 1.
pub fn lines(text: &str) -> Vec<usize> {
    rows(text).map(|(number, _)| number).collect()
}

/// What is on the lines that say something, with their numbers.
fn rows(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let rows = text.lines().map(|line| line.split('#').next().unwrap_or_default().trim());
    (1..).zip(rows).filter(|(_, row)| !row.is_empty())
}

fn point(line: &str) -> Option<Point> {
    let p = match numbers(line)?[..] {
        [x, y] | [x, y, 0.0] => Point::new(x, y),
        _ => return None,
    };
    p.is_finite().then_some(p)
}

fn numbers(line: &str) -> Option<Vec<f64>> {
    line.split_whitespace().map(|word| word.parse().ok()).collect()
}

fn fault(name: &str, line: usize, text: &str, help: &str) -> Error {
    let shown: String = text.chars().take(40).collect();
    Error::parse(format!("{name}:{line}"), format!("'{shown}' is no point"), help)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_read_and_faults_named() {
        let points = read("# seeds\n 1 2\n\n-3e2\t4.5 0 # third\n", "s.txt").unwrap();
        assert_eq!(points, [Point::new(1.0, 2.0), Point::new(-300.0, 4.5)]);
        assert_eq!(lines("# seeds\n 1 2\n\n-3e2\t4.5 0 # third\n"), [2, 4]);
        for bad in ["1", "1 2 3", "a b", "1 nan", "1 2 0 0"] {
            let error = read(&format!("0 0\n{bad}"), "s.txt").unwrap_err();
            assert!(error.to_string().starts_with("s.txt:2:"), "{error}");
        }
        assert!(read("", "s.txt").unwrap().is_empty());
        assert_eq!(read_in_space("1 2 -3\n", "s.txt").unwrap(), [Point3::new(1.0, 2.0, -3.0)]);
        for bad in ["1 2", "1 2 inf", "1 2 3 4"] {
            let error = read_in_space(bad, "s.txt").unwrap_err();
            assert!(error.to_string().starts_with("s.txt:1:") && error.help().contains("x y z"), "{error}");
        }
    }
}
