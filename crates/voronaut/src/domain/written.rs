//! A planar domain from a text that names a shape.

use super::{Domain, Pslg, shapes};
use crate::error::{Error, Result};
use crate::geometry::Point;

/// What users write for surfaces that need no file.
const SURFACES: [&str; 4] = ["sphere", "torus", "chair", "implicit"];
/// How shapes are written, for messages.
pub(crate) const SHAPES: &str = "rect:x0,y0,x1,y1 or disk:cx,cy,r";

impl Domain {
    /// The shape that a text names: `rect:x0,y0,x1,y1` or `disk:cx,cy,r`.
    ///
    /// # Errors
    /// [`Error::Parse`] of a text that names none, or has other numbers; [`Error::Domain`] of a shape without area;
    /// [`Error::Unsupported`] of a surface.
    pub fn shape(text: &str) -> Result<Self> {
        let unknown = || Error::parse(text, "no such shape", format!("give {SHAPES}"));
        Self::new(&shape(text).ok_or_else(unknown)??)
    }
}

/// The shape that a text names, or why it is none in the plane; `None` if it names none.
pub fn shape(spec: &str) -> Option<Result<Pslg>> {
    let (name, numbers) = spec.split_once(':').map_or((spec, None), |(name, numbers)| (name, Some(numbers)));
    match (name, numbers) {
        ("rect", Some(numbers)) => Some(
            read_numbers(spec, numbers, "rect:x0,y0,x1,y1")
                .and_then(|[x0, y0, x1, y1]| shapes::rect(Point::new(x0, y0), Point::new(x1, y1))),
        ),
        ("disk", Some(numbers)) => {
            Some(read_numbers(spec, numbers, "disk:cx,cy,r").and_then(|[x, y, r]| shapes::disk(Point::new(x, y), r)))
        }
        _ if SURFACES.contains(&name) => Some(Err(not_planar(format!("the surface {spec} as planar domain")))),
        _ => None,
    }
}

/// The comma-separated numbers of a shape.
///
/// # Errors
/// [`Error::Parse`] of more, fewer, or what is no number.
pub(crate) fn read_numbers<const N: usize>(spec: &str, numbers: &str, usage: &str) -> Result<[f64; N]> {
    let error = |what: String| Error::parse(spec, what, format!("write {usage}"));
    let words: Vec<_> = numbers.split(',').map(str::trim).collect();
    if words.len() != N {
        return Err(error(format!("{} numbers where {N} are expected", words.len())));
    }
    let mut values = [0.0; N];
    for (value, word) in values.iter_mut().zip(words) {
        *value = word.parse().map_err(|_| error(format!("'{word}' is not a number")))?;
    }
    Ok(values)
}

fn not_planar(what: String) -> Error {
    Error::Unsupported { what, help: format!("give {SHAPES}, or a planar domain in a file") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_read() {
        assert_eq!(Domain::shape("rect: 0, 0,1e0,2").unwrap().pslg().points.len(), 4);
        assert_eq!(shape("disk:0,0,1").unwrap().unwrap().points.len(), 4096);
        assert!(shape("mesh").is_none() && shape("rect").is_none() && shape("").is_none());
    }

    #[test]
    fn mistakes_are_named() {
        for (text, expected) in [
            ("rect:0,0,1", "rect:0,0,1: 3 numbers where 4 are expected"),
            ("disk:0,x,1", "disk:0,x,1: 'x' is not a number"),
            ("rect:0,0,0,1", "invalid domain: a rectangle needs x0 < x1"),
            ("disk:0,0,nan", "invalid domain: a disk without a positive radius"),
            ("sphere:1", "not supported: the surface sphere:1 as planar domain"),
            ("chair", "not supported: the surface chair as planar domain"),
            ("", ": no such shape"),
        ] {
            let error = Domain::shape(text).unwrap_err();
            assert!(error.to_string().starts_with(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
