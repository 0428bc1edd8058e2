//! Lists of points: a line `x y` (or `x y z`) each; empty lines and what follows `#` say nothing.

use super::codec::Place;
use voronaut::Result;
use voronaut::geometry::{Point, Point3};

/// Reads planar points; a third coordinate must be 0. `name` is the file's, for messages.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) with the line that is no point.
pub fn read(text: &str, name: &str) -> Result<Vec<Point>> {
    let point = |numbers: &[f64]| match *numbers {
        [x, y] | [x, y, 0.0] => Some(Point::new(x, y)).filter(|p| p.is_finite()),
        _ => None,
    };
    parse(text, name, "write two numbers, x y, on each line", point)
}

/// Reads points of space. `name` is the file's, for messages.
///
/// # Errors
/// [`Error::Parse`](voronaut::Error::Parse) with the line that is no point.
pub fn read_in_space(text: &str, name: &str) -> Result<Vec<Point3>> {
    let point = |numbers: &[f64]| match *numbers {
        [x, y, z] => Some(Point3::new(x, y, z)).filter(|p| p.is_finite()),
        _ => None,
    };
    parse(text, name, "write three numbers, x y z, on each line", point)
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

fn parse<T>(text: &str, name: &str, help: &str, point: impl Fn(&[f64]) -> Option<T>) -> Result<Vec<T>> {
    let read = |(line, row): (usize, &str)| {
        let numbers = row.split_whitespace().map(|word| word.parse().ok()).collect::<Option<Vec<f64>>>();
        numbers.and_then(|numbers| point(&numbers)).ok_or_else(|| {
            let shown: String = row.chars().take(40).collect();
            Place::line(name, line).error(format!("'{shown}' is no point"), help)
        })
    };
    rows(text).map(read).collect()
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
