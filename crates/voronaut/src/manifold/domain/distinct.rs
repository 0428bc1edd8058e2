//! What domains from files have in common: points and segments have to be distinct.

use super::{Segment, Side};
use crate::error::{Error, Result};
use crate::geometry::Point;
use crate::lists::in_order;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

/// A position as a key: equal for equal positions, -0 counting as 0.
pub(super) fn key(p: Point) -> [u64; 2] {
    [(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits()]
}

/// Checks that no two of the points, each given with its number, have the same coordinates.
///
/// # Errors
///
/// [`Error::Domain`] with the names, by `name`, of the first two that do.
pub(super) fn check_points(points: impl Iterator<Item = (u32, Point)>, name: impl Fn(u32) -> String) -> Result<()> {
    let mut known = HashMap::new();
    for (number, point) in points {
        if let Some(earlier) = known.insert(key(point), number) {
            let what = format!("{} and {} have the same coordinates", name(earlier), name(number));
            let help = "merge the two vertices into one";
            return Err(Error::domain(what, point.to_string(), help));
        }
    }
    Ok(())
}

/// A segment as a file lists it; nothing is known about its sides.
pub(super) fn listed(ends: [u32; 2], label: i32, required: bool) -> Segment {
    Segment { ends, label, required, left: Side::Unknown, right: Side::Unknown }
}

/// Merges segments between the same points: the first stays, and is required if one of them is.
///
/// Messages call the segments `noun` with their number, from `first`, and describe points by `describe`.
///
/// # Errors
///
/// [`Error::Domain`] of a segment without length, and of segments between the same points with different labels.
pub(super) fn merge_segments(
    segments: impl Iterator<Item = Segment>,
    noun: &str,
    first: usize,
    describe: impl Fn(u32) -> String,
) -> Result<Vec<Segment>> {
    let mut merged: Vec<Segment> = Vec::new();
    // Where in `merged` a segment is, and its number.
    let mut known: HashMap<[u32; 2], (usize, usize)> = HashMap::new();
    for (number, segment) in (first..).zip(segments) {
        let [a, b] = segment.ends;
        if a == b {
            let what = format!("{noun} {number} has no length: both its ends are the same vertex");
            return Err(Error::domain(what, describe(a), format!("remove the {noun}, or correct its ends")));
        }
        match known.entry(in_order(segment.ends)) {
            Entry::Vacant(entry) => {
                entry.insert((merged.len(), number));
                merged.push(segment);
            }
            Entry::Occupied(entry) => {
                let (index, earlier) = *entry.get();
                let kept = &mut merged[index];
                if kept.label != segment.label {
                    let labels = format!("labels {} and {}", kept.label, segment.label);
                    let what = format!("{noun}s {earlier} and {number} join the same vertices with different {labels}");
                    let place = format!("{} - {}", describe(a), describe(b));
                    return Err(Error::domain(what, place, "keep one of the two"));
                }
                kept.required |= segment.required;
            }
        }
    }
    Ok(merged)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_segments_are_merged() {
        let segments = [listed([4, 2], 1, false), listed([2, 3], 1, false), listed([2, 4], 1, true)];
        let merged = merge_segments(segments.into_iter(), "edge", 1, |v| format!("vertex {v}")).unwrap();
        assert_eq!(merged, [listed([4, 2], 1, true), listed([2, 3], 1, false)]);
    }

    #[test]
    fn the_first_repeated_point_is_named() {
        let points = [(0.0, 1.0), (0.0, 2.0), (-0.0, 1.0), (0.0, 2.0)].map(|(x, y)| Point::new(x, y));
        let error = check_points((5..).zip(points), |v| format!("vertex {v}")).unwrap_err();
        assert!(error.to_string().contains("vertex 5 and vertex 7 have the same coordinates at (-0, 1)"), "{error}");
    }
}
