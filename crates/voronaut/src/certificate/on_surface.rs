//! Certificates on surfaces: convex disks there, by curvature in charts and by geodesic loops.

use super::convexity::{Convexity, bend};
use super::sight::OnSurface;
use super::{Certificate, Constants, Coverage, Evidence};
use crate::canvas::{Canvas, Draped};
use crate::diagram::SurfaceDiagram;
use crate::geodesic::{Geodesic, Marching, Sources, gauss_curvature};
use crate::geometry::{Point, Vector};
use crate::manifold::{Chart, Place};
use crate::metric::Scaled;
use crate::net::Net;
use crate::parallel::prelude::*;
use crate::triangulation::{HalfEdge, VertexId};
use std::f64::consts::PI;

/// Canvas vertices at which the curvature is sampled, and seeds from which loops are looked for, at most about.
const SAMPLES: usize = 2_000;
const SOURCES: usize = 256;
/// Geodesics that leave a seed are told apart by the vertices of the ring so many edges around it that they pass.
const RING: usize = 3;

impl Certificate {
    /// Certifies a diagram on a surface, as [`Certificate::new`] does in the plane; `net` is that of its seeds (`recipe::net`).
    /// Around each seed the surface is seen in a chart. Convex disks are known on closed surfaces that have an equation only: triangles
    /// have no curvature but at their vertices.
    pub(crate) fn on_surface(
        diagram: &SurfaceDiagram,
        exact: &[[u32; 3]],
        net: &Net<Place>,
        constants: Constants,
    ) -> Self {
        let sights = OnSurface::new(diagram);
        let disks = |_: &Coverage, epsilon: f64| convexity(diagram, &sights, net, epsilon);
        Self::of(diagram, &sights, exact, net, constants, disks, Evidence::on_surface)
    }
}

fn convexity(diagram: &SurfaceDiagram, sights: &OnSurface, net: &Net<Place>, epsilon: f64) -> Convexity {
    let manifold = diagram.canvas().draped().manifold();
    let [curvature, total] = curvatures(diagram.canvas().draped(), epsilon);
    let has_border = manifold.whole().borders > 0;
    let injectivity = if has_border { f64::NAN } else { injectivity(diagram, epsilon) };
    let of_curvature = if curvature > 0.0 { 0.5 * PI / curvature.sqrt() } else { f64::INFINITY };
    let open = match () {
        () if has_border => Some("the surface has a border, where loops are not looked for"),
        () if manifold.equation().is_none() => {
            Some("the curvature: the surface has no equation, and its triangles have it at their vertices only")
        }
        () => None,
    };
    Convexity {
        curvature,
        total,
        holes: 0,
        // A minimum that does not lose what is no number.
        radius: if injectivity.is_nan() || 0.5 * injectivity < of_curvature { 0.5 * injectivity } else { of_curvature },
        injectivity: Some(injectivity),
        bend: bend(net.triangles.iter().map(|ball| ball.corners).collect(), sights),
        open,
    }
}

/// The greatest Gauss curvature at samples, and the integral of the positive ones. `unit` is a length of the metric, over a few hundredths
/// of which differences are taken.
fn curvatures(draped: &Draped, unit: f64) -> [f64; 2] {
    if draped.manifold().equation().is_none() {
        return [f64::NAN; 2];
    }
    let t = draped.topology();
    let all: Vec<VertexId> = t.vertices().collect();
    let stride = (all.len() / SAMPLES).max(1);
    let sampled: Vec<VertexId> = all.into_iter().step_by(stride).collect();
    let factor = unit.powi(-2);
    let at = |&v: &VertexId| {
        let plane = draped.plane(v);
        let chart = Chart::in_plane(draped.manifold(), draped.metric(), *draped.place(v), plane);
        // A third of the faces around a vertex is its share of the area.
        let double = |h: HalfEdge| {
            let [a, b, c] = t.corners(h.face()).map(|v| draped.position(v));
            (b - a).cross(c - a).norm()
        };
        let area = t.star(v).map(double).sum::<f64>() / 6.0;
        let density = plane.restrict(draped.tensor(v)).determinant().max(0.0).sqrt();
        (gauss_curvature(&Scaled { field: &chart, factor }, Point::default()) * factor, area * density)
    };
    let found: Vec<(f64, f64)> = sampled.par_iter().with_min_len(16).map(at).collect();
    let most = found.iter().map(|s| s.0).fold(0.0, |a: f64, b: f64| if b > a || b.is_nan() { b } else { a });
    let total =
        stride as f64 * found.iter().map(|&(k, area)| if k.is_nan() { k } else { k.max(0.0) * area }).sum::<f64>();
    [most, total]
}

/// An estimate from below of the injectivity radius: half the shortest of the geodesic loops that were found at seeds, less how far loops
/// elsewhere may be from these (the injectivity radius changes by no more than the distance), and less a canvas edge. A loop is an edge
/// to whose ends shortest ways leave the seed in directions that are more than a right angle apart.
fn injectivity(diagram: &SurfaceDiagram, epsilon: f64) -> f64 {
    let canvas = diagram.canvas();
    let topology = canvas.topology();
    let seeds: Vec<VertexId> = (0..diagram.colours() as u32).filter_map(|i| diagram.seed(i)).collect();
    let stride = (seeds.len() / SOURCES).max(1);
    let sampled: Vec<VertexId> = seeds.iter().copied().step_by(stride).collect();
    let loops: Vec<f64> = sampled.par_iter().map(|&v| shortest_loop(canvas, v)).collect();
    let shortest = loops.into_iter().fold(f64::INFINITY, |a, b| if b < a || b.is_nan() { b } else { a });
    let longest = topology.edges().map(|h| topology.length(h)).fold(0.0, f64::max);
    let mut sources = Sources::new(topology.vertex_slots());
    for &v in &sampled {
        sources.add(v, 0.0, 0);
    }
    let found = Marching::on(topology).propagate(&sources);
    let farthest =
        topology.vertices().map(|v| found.label(v).distance).filter(|d| d.is_finite()).fold(epsilon, f64::max);
    (0.5 * shortest - longest - farthest).max(0.0)
}

/// The shortest loop that leaves a vertex one way and comes back another; infinite where there is none.
fn shortest_loop(canvas: &Canvas<Draped>, v: VertexId) -> f64 {
    let (topology, draped) = (canvas.topology(), canvas.draped());
    let mut hops = vec![usize::MAX; topology.vertex_slots()];
    hops[v.index()] = 0;
    let mut ring = vec![v];
    for hop in 1..=RING {
        let around: Vec<VertexId> = ring.iter().flat_map(|&w| topology.around(w).collect::<Vec<_>>()).collect();
        ring = Vec::new();
        for w in around {
            if hops[w.index()] == usize::MAX {
                hops[w.index()] = hop;
                ring.push(w);
            }
        }
    }
    let mut sources = Sources::new(topology.vertex_slots());
    sources.add(v, 0.0, 0);
    let from_here = Marching::on(topology).propagate(&sources);
    let distance = |w: VertexId| from_here.label(w).distance;
    let mut sources = Sources::new(topology.vertex_slots());
    ring.iter().zip(0..).for_each(|(&w, colour)| sources.add(w, distance(w), colour));
    let by_ring = Marching::on(topology).propagate(&sources);
    // Directions as the metric at the seed has angles.
    let plane = draped.plane(v);
    let [frame, _] = plane.restrict(draped.tensor(v)).frames();
    let direction = |&w: &VertexId| {
        let flat = plane.flatten(draped.position(w) - draped.position(v));
        frame[0] * flat.x + frame[1] * flat.y
    };
    let directions: Vec<Vector> = ring.iter().map(direction).collect();
    let mut shortest = f64::INFINITY;
    for h in topology.edges() {
        let ends = topology.ends(h);
        if ends.iter().any(|w| hops[w.index()] <= RING || !distance(*w).is_finite()) {
            continue;
        }
        let [a, b] = ends.map(|w| directions[by_ring.label(w).colour as usize]);
        if a.dot(b) < 0.0 {
            shortest = shortest.min(distance(ends[0]) + topology.length(h) + distance(ends[1]));
        }
    }
    shortest
}
