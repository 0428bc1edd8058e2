//! Domains from Triangle's `.poly` files.

use super::distinct::{check_points, listed, merge_segments};
use super::{Filling, Pslg};
use crate::error::{Error, Result};
use crate::geometry::Point;
use crate::lists::marked;

/// What a `.poly` file of Triangle says (Shewchuk): a planar straight-line graph with holes and regions.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Poly {
    /// Positions.
    pub points: Vec<Point>,
    /// One boundary marker per point; 0 where the file has none.
    pub point_markers: Vec<i32>,
    /// The number of the first vertex in the file, 0 or 1; in this struct vertices are numbered from 0.
    pub first: u32,
    /// Vertex numbers of the ends of each segment.
    pub segments: Vec<[u32; 2]>,
    /// One boundary marker per segment; 0 where the file has none.
    pub segment_markers: Vec<i32>,
    /// One point in each hole.
    pub holes: Vec<Point>,
    /// Regional attributes.
    pub regions: Vec<PolyRegion>,
}

/// A point in a region, and what holds there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolyRegion {
    /// A point of the region.
    pub point: Point,
    /// The attribute of all triangles of the region.
    pub attribute: f64,
    /// Largest area of a triangle there, if the file gives one.
    pub max_area: Option<f64>,
}

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
    let is_joined = marked(poly.points.len(), segments.iter().flat_map(|segment| segment.ends));
    let regions = poly.regions.iter().map(region).collect::<Result<_>>()?;
    let count = poly.points.len() as u32;
    Ok(Pslg {
        points: poly.points.clone(),
        point_labels: poly.point_markers.clone(),
        required_points: (0..count).filter(|&vertex| !is_joined[vertex as usize]).collect(),
        segments,
        filling: Filling::Enclosed { holes: poly.holes.clone(), regions },
        names: if poly.first == 0 { (0..count).map(name).collect() } else { Vec::new() },
        ..Pslg::default()
    })
}

fn region(region: &PolyRegion) -> Result<(Point, i32)> {
    let attribute = region.attribute;
    if attribute.fract() == 0.0 && (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&attribute) {
        return Ok((region.point, attribute as i32));
    }
    let what = format!("the regional attribute {attribute} is no label");
    Err(Error::domain(what, region.point.to_string(), "label regions by integers (of 32 bits)"))
}
