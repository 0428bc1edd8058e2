//! On a sheet that unrolls into the plane the Riemannian Delaunay triangulation is that of the unrolled seeds.

use super::random::Random;
use crate::canvas::{Canvas, Kind, size_for};
use crate::diagram::SurfaceDiagram;
use crate::dual::Road;
use crate::geodesic::Method;
use crate::geometry::{Point, Tensor3};
use crate::manifold::Place;
use crate::manifold::surface::metric::Constant;
use crate::planar::{Planar, delaunay};
use crate::progress::Silent;
use crate::recipe::dual;
use crate::tests::wavy::Wavy;
use crate::triangulation::{FaceId, HalfEdge, smallest_first};
use std::collections::HashSet;

const SEEDS: usize = 2000;
/// Sines of the angle by which four seeds miss lying on a circle, below which flips are forgiven.
const MARGIN: f64 = 1e-5;

/// The centre of the circle through three points, and its radius.
fn circle([a, b, c]: [Point; 3]) -> (Point, f64) {
    let (u, v) = (b - a, c - a);
    let to_centre = (u.perpendicular() * v.dot(v) - v.perpendicular() * u.dot(u)) * (0.5 / u.cross(v));
    (a + to_centre, to_centre.norm())
}

/// The sine of the sum of the angles opposite to an edge.
fn margin(flat: &Planar, h: HalfEdge) -> f64 {
    let Some(t) = flat.topology.twin(h) else { return f64::INFINITY };
    let [a, b] = flat.ends(h);
    let [c, d] = [h, t].map(|h| flat.position(flat.topology.apex(h)));
    let angle = |at: Point, p: Point, q: Point| (p - at).cross(q - at).atan2((p - at).dot(q - at));
    (angle(c, a, b) + angle(d, b, a)).sin().abs()
}

/// The Delaunay triangles whose circles stay within the rectangle, each with the least margin of its edges.
fn truth(flat: &Planar, length: f64) -> Vec<([u32; 3], f64)> {
    let is_within = |f: &FaceId| {
        let corners = flat.topology.corners(*f);
        let (centre, radius) = circle(flat.triangle(*f));
        let room = centre.x.min(length - centre.x).min(centre.y + 1.0).min(1.0 - centre.y);
        corners.iter().all(|v| v.index() < SEEDS) && radius < room
    };
    let margins = |f: FaceId| f.half_edges().map(|h| margin(flat, h)).into_iter().fold(f64::INFINITY, f64::min);
    let inner = flat.topology.faces().filter(is_within);
    inner.map(|f| (smallest_first(flat.topology.corners(f).map(|v| v.0)), margins(f))).collect()
}

/// Every kind of canvas leads to the flat Delaunay triangulation.
#[test]
fn duals_on_a_sheet_are_delaunay_unrolled() {
    let (sheet, mut random) = (Wavy::new(81), Random(88_172_645_463_325_252));
    let manifold = sheet.manifold(25);
    let wanted = (0..SEEDS).map(|_| Point::new(sheet.length() * random.next(), 2.0 * random.next() - 1.0));
    let places: Vec<Place> = wanted.map(|p| manifold.closest(sheet.rolled(p)).unwrap()).collect();
    let unrolled: Vec<Point> = places.iter().map(|place| sheet.unrolled(place.position)).collect();
    let truth = truth(&delaunay(&unrolled).unwrap(), sheet.length());
    assert!(truth.len() > 3400, "{}", truth.len());
    let metric = Constant(Tensor3::IDENTITY);
    for kind in Kind::ALL {
        let (canvas, at) = Canvas::on_surface(kind, &manifold, &metric, size_for(SEEDS, 60), &places).unwrap();
        let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::March).unwrap();
        let dual = dual(&diagram, Road::Geodesic, &Silent);
        let found: HashSet<[u32; 3]> = dual.triangles.iter().copied().map(smallest_first).collect();
        let missing: Vec<_> = truth.iter().filter(|t| !found.contains(&t.0)).collect();
        let wrong = missing.iter().filter(|t| t.1 > MARGIN).count();
        println!(
            "{kind}: {} triangles, {} of {} missing, {wrong} above {MARGIN}",
            found.len(),
            missing.len(),
            truth.len()
        );
        assert!(wrong == 0 && 1000 * missing.len() <= truth.len(), "{kind}: {missing:?}");
    }
}
