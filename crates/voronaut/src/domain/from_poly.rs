//! Domains from Triangle's `.poly` files.

use super::distinct::{check_points, listed, merge_segments};
use super::{Filling, Pslg};
use crate::error::{Error, Result};
use crate::formats::Poly;
use crate::geometry::Point;

/// The domain of a `.poly` file: all that its segments enclose, but for the holes.
///
/// Vertices on no segment become required points. Regional attributes label regions; area constraints are left to
/// the metric. Messages number vertices and segments as the file does.
///
/// # Errors
///
/// [`Error::Domain`] of no segments, of two vertices with the same coordinates, a segment without length, segments
/// between the same vertices with different labels, a regional attribute that is no label (an integer of 32 bits).
pub fn from_poly(poly: &Poly) -> Result<Pslg> {
    let name = |vertex: u32| format!("vertex {}", u64::from(vertex) + u64::from(poly.first));
    if poly.segments.is_empty() {
        let help = "list the boundary in the segments of the .poly file";
        return Err(Error::domain("a .poly file without segments", "its list of segments", help));
    }
    check_points((0..).zip(poly.points.iter().copied()), name)?;
    let describe = |vertex: u32| format!("{} {}", name(vertex), poly.points[vertex as usize]);
    let segments = poly.segments.iter().zip(&poly.segment_markers).map(|(&ends, &label)| listed(ends, label, false));
    let segments = merge_segments(segments, "segment", poly.first as usize, describe)?;
    let mut isolated = vec![true; poly.points.len()];
    for vertex in segments.iter().flat_map(|segment| segment.ends) {
        isolated[vertex as usize] = false;
    }
    let regions = poly.regions.iter().map(region).collect::<Result<_>>()?;
    let count = poly.points.len() as u32;
    Ok(Pslg {
        points: poly.points.clone(),
        point_labels: poly.point_markers.clone(),
        required_points: (0..count).filter(|&vertex| isolated[vertex as usize]).collect(),
        segments,
        filling: Filling::Enclosed { holes: poly.holes.clone(), regions },
        tolerance: 0.0,
        names: if poly.first == 0 { (0..count).map(name).collect() } else { Vec::new() },
    })
}

fn region(region: &crate::formats::poly::Region) -> Result<(Point, i32)> {
    let attribute = region.attribute;
    if attribute.fract() == 0.0 && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&attribute) {
        return Ok((region.point, attribute as i32));
    }
    let what = format!("the regional attribute {attribute} is no label");
    Err(Error::domain(what, region.point.to_string(), "label regions by integers (of 32 bits)"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::poly;

    fn pslg(text: &str) -> Result<Pslg> {
        from_poly(&poly::read(text.as_bytes(), "a.poly")?)
    }

    #[test]
    fn holes_regions_and_isolated_points() {
        let text = "4 2 0 1\n0 0 0 1\n1 1 0 2\n2 .1 .1 3\n3 0 1 4\n4 1\n0 0 1 5\n1 1 3 5\n2 3 0 6\n3 0 3 6\n1\n1 .2 .2\n1\n1 .3 .3 8\n";
        let pslg = pslg(text).unwrap();
        assert_eq!(pslg.segments.len(), 3, "the last segment repeats the third");
        assert_eq!(pslg.required_points, [2]);
        assert_eq!(pslg.point_labels, [1, 2, 3, 4]);
        assert_eq!(pslg.describe(3), "vertex 3 (0, 1)");
        let holes = vec![Point::new(0.2, 0.2)];
        assert_eq!(pslg.filling, Filling::Enclosed { holes, regions: vec![(Point::new(0.3, 0.3), 8)] });
    }

    #[test]
    fn errors_name_vertices_and_segments() {
        let square = "4\n1 0 0\n2 1 0\n3 1 1\n4 0 1\n";
        for (text, expected) in [
            ("2\n0 0 0\n1 -0 0\n1\n0 0 1\n".into(), "vertex 0 and vertex 1 have the same coordinates at (-0, 0)"),
            (
                format!("{square}1\n1 2 2\n"),
                "segment 1 has no length: both its ends are the same vertex at vertex 2 (1, 0)",
            ),
            (
                format!("{square}2 1\n1 1 2 3\n2 2 1 4\n"),
                "segments 1 and 2 join the same vertices with different labels 3 and 4 at vertex 2 (1, 0) - vertex 1 (0, 0)",
            ),
            (format!("{square}0\n"), "a .poly file without segments"),
            (
                format!("{square}1\n1 1 2\n0\n1\n1 .5 .25 1.5\n"),
                "the regional attribute 1.5 is no label at (0.5, 0.25)",
            ),
        ] {
            let error = pslg(&text).unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert!(!error.help().is_empty());
        }
    }
}
