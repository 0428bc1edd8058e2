//! Metrics whose distances from a point are known. The benchmark `methods` measures on them, too.

use std::f64::consts::PI;
use voronaut::canvas::Canvas;
use voronaut::diagram::Distances;
use voronaut::geometry::{Point, Tensor};
use voronaut::manifold::domain::Domain;
use voronaut::triangulation::VertexId;

/// A metric on a domain, and its distances from a point.
pub(crate) struct Case {
    /// What it is called in tables.
    pub(crate) name: &'static str,
    /// As [`Domain::shape`] takes it.
    pub(crate) domain: String,
    /// The metric.
    pub(crate) metric: Box<dyn Fn(Point) -> Tensor + Sync>,
    /// Where distances start.
    pub(crate) from: Point,
    /// The distance of a point; `None` where the geodesic may leave the domain.
    pub(crate) exact: Box<dyn Fn(Point) -> Option<f64> + Sync>,
}

/// Vertices nearer to the source than this share of the farthest one are not measured: relative errors say little there, and
/// distances around the source are exact by construction.
const NEAR: f64 = 0.05;

impl Case {
    /// The domain of the case.
    pub(crate) fn domain(&self) -> Domain {
        Domain::shape(&self.domain).unwrap()
    }

    /// Greatest and mean relative error over the vertices that are reached, with known distance, and not near the source.
    pub(crate) fn errors(&self, canvas: &Canvas, found: &Distances) -> [f64; 2] {
        let pairs = found.values().iter().zip(0..).map(|(d, v)| (canvas.position(VertexId(v)), d));
        let known: Vec<(f64, f64)> = pairs.filter_map(|(p, &d)| Some((d, (self.exact)(p)?))).collect();
        relative_errors(&known)
    }
}

/// Greatest and mean relative error of found distances, each with the exact one, that are finite and not near the source.
pub(crate) fn relative_errors(known: &[(f64, f64)]) -> [f64; 2] {
    let farthest = known.iter().fold(0.0, |farthest: f64, &(_, exact)| farthest.max(exact));
    let measured = known.iter().filter(|(d, exact)| d.is_finite() && *exact > NEAR * farthest);
    let errors: Vec<f64> = measured.map(|(d, exact)| (d / exact - 1.0).abs()).collect();
    [errors.iter().copied().fold(0.0, f64::max), errors.iter().sum::<f64>() / errors.len() as f64]
}

/// A flat metric that turns: the pull-back of the Euclidean one by (x, y) to (x / anisotropy, y + height sin(pi x)) on
/// the square from -1 to 1, so that distances are those of the images wherever the straight line between these is the
/// image of a curve in the square (looked up at [`LOOKS`] points).
///
/// Its eigenvalues' product is 1 / anisotropy^2 everywhere, and the ratio of their roots is the anisotropy at crests and troughs
/// (x = 1/2, -1/2), and 1 + (pi height)^2 times that, nearly, on the flanks between, where the long axis turns by the arc
/// tangent of pi height to either side.
pub(crate) fn turning(anisotropy: f64, height: f64) -> Case {
    let image = move |p: Point| Point::new(p.x / anisotropy, p.y + height * (PI * p.x).sin());
    let from = Point::new(0.1, -0.2);
    let exact = move |p: Point| {
        let inside = |k: u32| {
            let at = image(from).lerp(image(p), f64::from(k) / f64::from(LOOKS));
            (at.y - height * (PI * at.x * anisotropy).sin()).abs() <= 1.0
        };
        (1..LOOKS).all(inside).then(|| image(p).distance(image(from)))
    };
    let metric = move |p: Point| {
        let slope = height * PI * (PI * p.x).cos();
        Tensor::new(1.0 / (anisotropy * anisotropy) + slope * slope, slope, 1.0)
    };
    let domain = "rect:-1,-1,1,1".to_string();
    Case { name: "turning", domain, metric: Box::new(metric), from, exact: Box::new(exact) }
}

/// Points at which straight lines are looked up.
const LOOKS: u32 = 64;

/// A curved metric: the hyperbolic half-plane (curvature -1), with all of it, the domain too, stretched in x by the anisotropy,
/// which is the same everywhere.
pub(crate) fn half_plane(anisotropy: f64) -> Case {
    const TOP: f64 = 3.0;
    let from = Point::new(0.2 * anisotropy, 1.3);
    let exact = move |p: Point| {
        let (dx, dy) = ((p.x - from.x) / anisotropy, p.y - from.y);
        // Geodesics are arcs around points of the line y = 0: at this abscissa, seen from the source.
        let centre = 0.5 * dx + 0.5 * (p.y + from.y) * dy / dx;
        let is_bow = centre * (dx - centre) > 0.0;
        let inside = !is_bow || centre.hypot(from.y) <= TOP;
        inside.then(|| 2.0 * (0.5 * dx.hypot(dy) / (p.y * from.y).sqrt()).asinh())
    };
    let scale = anisotropy * anisotropy;
    let metric = move |p: Point| Tensor::new(1.0 / scale, 0.0, 1.0) * (1.0 / (p.y * p.y));
    let domain = format!("rect:{},0.5,{},{TOP}", -2.0 * anisotropy, 2.0 * anisotropy);
    Case { name: "half-plane", domain, metric: Box::new(metric), from, exact: Box::new(exact) }
}
