//! From a graph as the user brings it to a valid domain.

use super::sides::Areas;
use super::{Domain, Pslg, Side};
use crate::error::{Error, Result};
use crate::geometry::segment_intersection;
use crate::planar::{Crossing, Planar, delaunay};
use crate::triangulation::{Constraint, VertexId};

impl Pslg {
    /// The domain of this graph, by [`Domain::new`].
    pub(crate) fn validated(&self) -> Result<Domain> {
        Domain::new(self)
    }
}

impl Domain {
    /// Validates a graph: finite coordinates, no duplicate points, no crossings, a closed boundary around some area.
    ///
    /// # Errors
    /// [`Error::Domain`] with the first fault and its place.
    pub fn new(pslg: &Pslg) -> Result<Self> {
        check_entries(pslg)?;
        let pslg = pslg.without_straight_vertices();
        let mut planar = triangulate(&pslg)?;
        let areas = Areas::classify(&pslg, &planar)?;
        for f in planar.topology.faces().collect::<Vec<_>>() {
            if let Side::Region(label) = areas.of(f) {
                planar.topology.set_region(f, label);
            }
        }
        let mut sources: Vec<Option<u32>> = (0..pslg.points.len() as u32).map(Some).collect();
        sources.extend([None; 3]);
        planar.topology.retain_faces(|f| matches!(areas.of(f), Side::Region(_)));
        for (v, source) in (0..).zip(&mut sources) {
            if !planar.topology.is_vertex(VertexId(v)) {
                *source = None;
            }
        }
        split_pinches(&mut planar, &mut sources);
        debug_assert!(planar.topology.check().is_ok() && planar.is_embedded());
        Ok(Self { pslg, planar, sources })
    }
}

pub(super) fn check_entries(pslg: &Pslg) -> Result<()> {
    if let Some(bad) = pslg.points.iter().position(|p| !p.is_finite()) {
        let help = "every coordinate must be a finite number";
        return Err(Error::domain("a coordinate is not finite", pslg.describe(bad as u32), help));
    }
    // Exact predicates multiply up to four coordinates: beyond these sizes the products leave the range of f64.
    let extreme = |x: f64| x != 0.0 && !(1e-60..=1e60).contains(&x.abs());
    if let Some(bad) = pslg.points.iter().position(|p| p.x.abs() > 1e60 || p.y.abs() > 1e60) {
        let help = "choose another unit of length";
        return Err(Error::domain("a coordinate is larger than 1e60", pslg.describe(bad as u32), help));
    }
    let spread = crate::geometry::Aabb::of(pslg.points.iter().copied()).map(|b| b.extent());
    if pslg.segments.len() < 3 || spread.is_none_or(|e| e.x <= 0.0 || e.y <= 0.0 || extreme(e.x.max(e.y))) {
        let help = "give at least three points that are not on one line, joined by a closed boundary";
        return Err(Error::domain("the boundary encloses no area", "the whole input", help));
    }
    let degenerate = |s: &super::Segment| s.ends[0] == s.ends[1];
    if let Some(bad) = pslg.segments.iter().position(degenerate) {
        let help = "remove it";
        return Err(Error::domain("a segment has length zero", pslg.describe_segment(bad as u32), help));
    }
    Ok(())
}

pub(super) fn triangulate(pslg: &Pslg) -> Result<Planar> {
    let mut planar = delaunay(&pslg.points).map_err(|[i, j]| {
        let place = format!("{} and {}", pslg.describe(i), pslg.name(j));
        Error::domain("two points have the same position", place, "merge them into one vertex")
    })?;
    for (i, segment) in pslg.segments.iter().enumerate() {
        let [a, b] = segment.ends.map(VertexId);
        planar
            .constrain(a, b, Constraint(i as u32))
            .map_err(|crossing| crossing_error(pslg, &planar, i as u32, crossing))?;
    }
    Ok(planar)
}

fn crossing_error(pslg: &Pslg, planar: &Planar, segment: u32, crossing: Crossing) -> Error {
    let [a, b] = pslg.segments[segment as usize].ends.map(VertexId).map(|v| planar.position(v));
    let [c, d] = crossing.edge.map(|v| planar.position(v));
    let place = format!(
        "{}: segment {} meets segment {}",
        segment_intersection(a, b, c, d),
        pslg.describe_segment(segment),
        pslg.describe_segment(crossing.with.0),
    );
    let help = "boundaries may touch only at common vertices: split the two segments there, move one of them, or have them cut (`repair`)";
    Error::domain("the boundary crosses or overlaps itself", place, help)
}

fn split_pinches(planar: &mut Planar, sources: &mut Vec<Option<u32>>) {
    for (copy, original) in planar.topology.split_pinched_vertices() {
        let slots = planar.topology.vertex_slots();
        planar.positions.resize(slots, planar.position(original));
        planar.positions[copy.index()] = planar.position(original);
        sources.resize(slots, None);
        sources[copy.index()] = sources[original.index()];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::manifold::domain::{Filling, Segment, rect};

    /// Closed loops of points, as an even-odd domain.
    fn loops(outlines: &[&[(f64, f64)]]) -> Pslg {
        let mut pslg = rect(Point::new(0.0, 0.0), Point::new(1.0, 1.0)).unwrap();
        (pslg.points, pslg.segments) = (Vec::new(), Vec::new());
        for outline in outlines {
            let (first, n) = (pslg.points.len() as u32, outline.len() as u32);
            pslg.points.extend(outline.iter().map(|&(x, y)| Point::new(x, y)));
            pslg.segments.extend((0..n).map(|i| Segment {
                ends: [first + i, first + (i + 1) % n],
                label: 1,
                required: false,
                left: Side::Unknown,
                right: Side::Unknown,
            }));
        }
        pslg.point_labels = vec![0; pslg.points.len()];
        pslg.filling = Filling::EvenOdd;
        pslg
    }

    const OUTER: &[(f64, f64)] = &[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];

    #[test]
    fn holes_and_islands_alternate() {
        let hole: &[(f64, f64)] = &[(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)];
        let island: &[(f64, f64)] = &[(1.5, 1.5), (2.5, 1.5), (2.5, 2.5), (1.5, 2.5)];
        let domain = Domain::new(&loops(&[OUTER, hole, island])).unwrap();
        assert!((domain.area() - 13.0).abs() < 1e-14);
        assert_eq!(domain.boundary().len(), 12);
        domain.planar().topology.check().unwrap();
    }

    #[test]
    fn a_hole_that_touches_the_outline_in_a_point_is_fine() {
        let hole: &[(f64, f64)] = &[(2.0, 0.0), (3.0, 2.0), (1.0, 2.0)];
        let domain = Domain::new(&loops(&[OUTER, hole])).unwrap();
        assert!((domain.area() - 14.0).abs() < 1e-14);
        domain.planar().topology.check().unwrap();
        let at_touch =
            domain.planar().topology.vertices().filter(|&v| domain.planar().position(v) == Point::new(2.0, 0.0));
        assert_eq!(at_touch.count(), 2, "one vertex for each side of the pinch");
    }

    fn fault(pslg: &Pslg) -> String {
        let error = Domain::new(pslg).unwrap_err();
        assert!(!error.help().is_empty());
        error.to_string()
    }

    #[test]
    fn self_crossing_is_refused_with_the_place() {
        let bow_tie: &[(f64, f64)] = &[(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)];
        let message = fault(&loops(&[bow_tie]));
        assert!(message.contains("crosses") && message.contains("(1, 1)") && message.contains("vertex 3"), "{message}");
    }

    #[test]
    fn overlapping_edges_are_refused() {
        let neighbour: &[(f64, f64)] = &[(1.0, 4.0), (2.0, 4.0), (2.0, 5.0), (1.0, 5.0)];
        assert!(fault(&loops(&[OUTER, neighbour])).contains("overlaps"));
    }

    #[test]
    fn open_boundaries_are_refused_with_the_loose_end() {
        let mut open = loops(&[OUTER]);
        open.segments.pop();
        let message = fault(&open);
        assert!(message.contains("open") && message.contains("vertex 1 (0, 0)"), "{message}");
        open.filling = Filling::Enclosed { holes: Vec::new(), regions: Vec::new() };
        assert!(fault(&open).contains("open"));
    }

    #[test]
    fn duplicate_points_and_bad_numbers_are_refused() {
        let twice: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0), (-1.0, 1.0)];
        assert!(fault(&loops(&[twice])).contains("vertex 1 (0, 0) and vertex 4"));
        let nan: &[(f64, f64)] = &[(0.0, 0.0), (1.0, f64::NAN), (1.0, 1.0)];
        assert!(fault(&loops(&[nan])).contains("not finite at vertex 2"));
        let line: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)];
        assert!(fault(&loops(&[line])).contains("encloses no area"));
        let line: &[(f64, f64)] = &[(0.0, 0.0), (1.0, 1.0), (2.0, 2.0)];
        fault(&loops(&[line]));
    }

    #[test]
    fn slivers_of_a_millionth_are_domains() {
        for scale in [1e-9, 1.0, 1e9] {
            let sliver = [(0.0, 0.0), (scale, 0.0), (scale, 1e-6 * scale), (0.0, 1e-6 * scale)];
            let domain = Domain::new(&loops(&[&sliver])).unwrap();
            assert!((domain.area() / (1e-6 * scale * scale) - 1.0).abs() < 1e-9);
        }
    }
}
