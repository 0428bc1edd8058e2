//! The dual of given seeds, in the plane or on a surface: none is added, none moved.

use crate::canvas::{Canvas, Draped};
use crate::certificate::{Certificate, Constants};
use crate::diagram::{Diagram, Flat, Ground, Kind, Nerve, NerveTriangle, SurfaceDiagram};
use crate::dual::Road;
use crate::figures;
use crate::geometry::{Point, Point3};
use crate::lists::in_order;
use crate::manifold::{Manifold, Place};
use crate::mesh::Mesh;
use crate::net::{Memory, Net, SeedsOnSurface, Simplices};
use crate::planar::Location;
use crate::progress::Progress;
use crate::rdt::{Edge, Judge, OnSurface, Rdt, Start, Trust};
use crate::realisation::Realisation;
use crate::triangulation::HalfEdge;
use std::collections::HashSet;

/// Lengths found from the metric alone may differ by this share from those on the canvas, through whose vertices ways lead:
/// more says that they are of another way.
const CANVAS_ERROR: f64 = 0.03;
/// With [`Road::Both`] the nerve stands where the margin by lengths is within its error and that is larger than this.
const DOUBT: f64 = 0.05;
/// The nerve is not sure of a place that a fourth seed would win if squares of distances were off by this share.
const NERVE_ERROR: f64 = 0.01;

/// The dual of a diagram's seeds.
#[derive(Clone, Debug)]
pub struct SeedDual {
    /// Triangles by their seeds, counter-clockwise as the cells lie.
    pub triangles: Vec<[u32; 3]>,
    /// The nerve, sharp within canvas faces if the diagram is Riemannian.
    pub nerve: Nerve,
    /// The triangles of the exact dual: what in-circle tests make of the nerve, whatever the road.
    pub exact: Vec<[u32; 3]>,
    /// What canvas faces of three colours alone have of it; of a star set, simplices of stars.
    pub raw_nerve: figures::RawNerve,
    /// How the edges were settled. Margins are those by lengths; edges are numbered by their seeds.
    pub account: figures::Dual,
    /// Time of the nerve and of the in-circle tests, by the clock of who watches.
    pub seconds: Vec<(&'static str, f64)>,
}

/// A ground, of the plane or of a surface, on which geodesics tell more of seeds than a canvas does.
pub trait Measured<'a>: Ground<'a> {
    /// Where seeds are.
    type Seed: Copy + PartialEq + Send + Sync;
    /// What lines are of.
    type Point: Copy + Into<[f64; 3]> + Send + Sync;

    /// Of a Riemannian diagram: see [`dual`], which takes any.
    fn dual(diagram: &Diagram<'a, Self>, road: Road, progress: &dyn Progress) -> SeedDual;
    /// See [`net`], whose epsilon knows canvas vertices, too.
    fn net(diagram: &Diagram<'a, Self>, exact: &[[u32; 3]]) -> Net<Self::Seed>;
    /// Certifies a diagram on a canvas that is a triangulation. The net is that of its seeds ([`net`]), from the triangles of their exact dual.
    /// On a surface each seed is seen in a chart, and convex disks are known of closed ones that have an equation only: triangles have no curvature but at
    /// their vertices.
    fn certificate(
        diagram: &Diagram<'a, Self>,
        exact: &[[u32; 3]],
        net: &Net<Self::Seed>,
        constants: Constants,
    ) -> Certificate;
    /// Triangles of seeds with geodesic edges: see [`Realisation::new`].
    fn realisation(diagram: &Diagram<'a, Self>, triangles: &[[u32; 3]]) -> Realisation<Self::Point>;
}

/// The dual by the road that is asked for: the nerve of the cells as drawn on the canvas, or what in-circle tests by
/// lengths of geodesics make of it, or, with both, as far as these are sure and agree with distances on the canvas. Of a
/// diagram that is not Riemannian there is one road, its nerve as canvas faces of three colours have it, nothing mended, and
/// nothing exact to compare with.
pub fn dual<'a, G: Measured<'a>>(diagram: &Diagram<'a, G>, road: Road, progress: &dyn Progress) -> SeedDual {
    if diagram.kind() == Kind::Riemannian { G::dual(diagram, road, progress) } else { as_read(diagram, progress) }
}

/// The net of a diagram's seeds, from the triangles of their exact dual. Its epsilon is the greatest of the circumradii and
/// of the distances of canvas vertices; seeds need not lie on the border, so that nothing is said of protection there. On a surface circles are found in
/// charts.
pub fn net<'a, G: Measured<'a>>(diagram: &Diagram<'a, G>, exact: &[[u32; 3]]) -> Net<G::Seed> {
    let mut net = G::net(diagram, exact);
    let farthest = diagram.farthest().map_or(0.0, |(_, distance)| distance);
    net.epsilon = if farthest.is_finite() { net.epsilon.max(farthest) } else { net.epsilon };
    net
}

impl<'a> Measured<'a> for Flat<'a> {
    type Seed = Point;
    type Point = Point;

    fn dual(diagram: &Diagram<'a>, road: Road, progress: &dyn Progress) -> SeedDual {
        let start = progress.seconds();
        let nerve = diagram.sharp_nerve();
        let passes = diagram.passes();
        let read = progress.seconds();
        let reference = |i: u32, j: u32| passes.between(i, j).map(|(distance, _)| (distance, CANVAS_ERROR * distance));
        let trust = match road {
            Road::Geodesic => Trust::default(),
            Road::Canvas | Road::Both => Trust { reference: Some(&reference), doubt: DOUBT },
        };
        let rdt = Rdt::new(diagram.ground().field, &seeds(diagram), &Start::from_nerve(&nerve), trust);
        let seconds = vec![("nerve", read - start), ("tests", progress.seconds() - read)];
        by_road(diagram, nerve, &rdt, road, seconds)
    }

    fn net(diagram: &Diagram<'a>, exact: &[[u32; 3]]) -> Net {
        let (canvas, seeds) = (diagram.canvas(), seeds(diagram));
        let at = canvas.locate_all(&seeds);
        let face = |seed: u32| match at[seed as usize]? {
            Location::Face(f) => Some(f),
            Location::Edge(h) | Location::Behind(h) => Some(h.face()),
            Location::Vertex(v) => canvas.embedded().topology.start(v).map(HalfEdge::face),
        };
        let sees = |from, p| !matches!(canvas.embedded().walk(from, p, false), Location::Behind(_));
        let is_inside = |seed: u32, p: Point| face(seed).is_some_and(|from| sees(from, p));
        let simplices = Simplices { seeds: &seeds, triangles: exact, border: &[], is_inside: &is_inside };
        Net::measure(diagram.ground().field, &simplices)
    }

    fn certificate(diagram: &Diagram<'a>, exact: &[[u32; 3]], net: &Net, constants: Constants) -> Certificate {
        Certificate::new(diagram, exact, net, constants)
    }

    fn realisation(diagram: &Diagram<'a>, triangles: &[[u32; 3]]) -> Realisation {
        Realisation::new(diagram, triangles)
    }
}

fn seeds(diagram: &Diagram) -> Vec<Point> {
    (0..diagram.colours() as u32).map(|i| diagram.seed(i).unwrap_or_default()).collect()
}

impl<'a> Measured<'a> for &'a Canvas<Draped<'a>> {
    type Seed = Place;
    type Point = Point3;

    fn dual(diagram: &SurfaceDiagram<'a>, road: Road, progress: &dyn Progress) -> SeedDual {
        let start = progress.seconds();
        let nerve = diagram.sharp_nerve();
        let read = progress.seconds();
        let (glued, copies) = diagram.glued_nerve();
        let rdt = Rdt::from_glued(OnSurface::new(diagram), diagram.colours(), glued, &copies);
        let seconds = vec![("nerve", read - start), ("tests", progress.seconds() - read)];
        by_road(diagram, nerve, &rdt, road, seconds)
    }

    fn net(diagram: &SurfaceDiagram<'a>, exact: &[[u32; 3]]) -> Net<Place> {
        Net::on_surface(&SeedsOnSurface::of(diagram), exact, &mut Memory::default())
    }

    fn certificate(
        diagram: &SurfaceDiagram<'a>,
        exact: &[[u32; 3]],
        net: &Net<Place>,
        constants: Constants,
    ) -> Certificate {
        Certificate::on_surface(diagram, exact, net, constants)
    }

    fn realisation(diagram: &SurfaceDiagram<'a>, triangles: &[[u32; 3]]) -> Realisation<Point3> {
        Realisation::on_surface(diagram, triangles)
    }
}

fn by_road<'a, G: Ground<'a>>(
    diagram: &Diagram<'a, G>,
    nerve: Nerve,
    rdt: &Rdt<impl Judge>,
    road: Road,
    seconds: Vec<(&'static str, f64)>,
) -> SeedDual {
    let exact = rdt.triangles();
    let triangles = match road {
        Road::Canvas => nerve.triangles.iter().map(|t| t.colours).collect(),
        Road::Geodesic => exact.clone(),
        Road::Both => exact.iter().copied().chain(left_out(rdt, &nerve)).collect(),
    };
    let (account, raw_nerve) = (account(rdt, &nerve, road), compared(diagram, &exact));
    SeedDual { triangles, nerve, exact, raw_nerve, account, seconds }
}

fn as_read<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, progress: &dyn Progress) -> SeedDual {
    let start = progress.seconds();
    let nerve = diagram.nerve();
    SeedDual {
        triangles: nerve.triangles.iter().map(|t| t.colours).collect(),
        nerve,
        exact: Vec::new(),
        raw_nerve: figures::RawNerve::default(),
        account: figures::Dual { min_margin: 1.0, ..figures::Dual::default() },
        seconds: vec![("nerve", progress.seconds() - start)],
    }
}

/// The raw nerve of a diagram beside the triangles of the exact dual.
pub(super) fn compared<'a, G: Ground<'a>>(diagram: &Diagram<'a, G>, exact: &[[u32; 3]]) -> figures::RawNerve {
    let turned = |&[a, b, c]: &[u32; 3]| [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().unwrap_or([a, b, c]);
    let exact: HashSet<[u32; 3]> = exact.iter().map(turned).collect();
    let raw: HashSet<[u32; 3]> = diagram.witnesses_of_triangles().into_iter().map(|witness| witness.0).collect();
    figures::RawNerve {
        triangles: raw.len(),
        missing: exact.difference(&raw).count(),
        extra: raw.difference(&exact).count(),
    }
}

/// Triangles of the nerve that no triangulation could hold beside the others, and of which it is sure: cells that touch
/// in two places.
fn left_out(rdt: &Rdt<impl Judge>, nerve: &Nerve) -> Vec<[u32; 3]> {
    let is_sure = |t: &NerveTriangle| t.fourth.is_none_or(|(_, gap)| gap >= NERVE_ERROR);
    let sure: HashSet<[u32; 3]> = nerve.triangles.iter().filter(|t| is_sure(t)).map(|t| t.colours).collect();
    rdt.dropped().iter().copied().filter(|t| sure.contains(t)).collect()
}

pub(super) fn account(rdt: &Rdt<impl Judge>, nerve: &Nerve, road: Road) -> figures::Dual {
    let edges = rdt.edges();
    let of_nerve: HashSet<[u32; 2]> = nerve.sides(|_| true).collect();
    let unsure: HashSet<[u32; 2]> = nerve.sides(|t| t.fourth.is_some_and(|(_, gap)| gap < NERVE_ERROR)).collect();
    let is_open = |edge: &&Edge| match road {
        Road::Geodesic => edge.is_uncertain(),
        Road::Canvas => unsure.contains(&in_order(edge.ends)),
        Road::Both => edge.is_uncertain() && unsure.contains(&in_order(edge.ends)),
    };
    let uncertain_edges: Vec<figures::UncertainEdge> = edges.iter().filter(is_open).map(uncertain).collect();
    let differing = rdt.disagreements().into_iter().map(|edge| disagreement(&edge, &of_nerve, road));
    let tested = edges.iter().filter(|edge| edge.margin.is_some());
    let values = tested.clone().filter(|edge| !edge.is_uncertain()).filter_map(|edge| edge.margin.map(|m| m.value));
    figures::Dual {
        geodesic_tests: rdt.counters().tests.to_vec(),
        uncertain: uncertain_edges.len(),
        min_margin: values.fold(1.0, f64::min),
        blocked_flips: (rdt.counters().blocked + rdt.counters().circling) as usize,
        compared: tested.count(),
        disagreements: differing.collect(),
        uncertain_edges,
        ..figures::Dual::default()
    }
}

fn uncertain(edge: &Edge) -> figures::UncertainEdge {
    let (margin, error) = edge.margin.map_or((0.0, f64::INFINITY), |m| (m.value, m.error));
    figures::UncertainEdge { edge: edge.ends, margin, error }
}

fn disagreement(edge: &Edge, of_nerve: &HashSet<[u32; 2]>, road: Road) -> figures::Disagreement {
    let (margin, error) = edge.margin.map_or((0.0, f64::INFINITY), |m| (m.value, m.error));
    let other = if let [Some(c), Some(d)] = edge.apexes { Some(in_order([c, d])) } else { None };
    let settled_by = if road == Road::Canvas { Road::Canvas } else { Road::Geodesic };
    let instead = other.filter(|other| of_nerve.contains(other));
    figures::Disagreement { edge: edge.ends, instead, margin, error, settled_by }
}

/// Triangles of seeds on a surface as a mesh: vertex i is seed i, with the region labels of the surface.
pub fn surface_mesh(manifold: &Manifold, places: &[Place], triangles: Vec<[u32; 3]>) -> Mesh {
    let topology = manifold.topology();
    let label = |t: &[u32; 3]| {
        let corners = t.map(|v| places[v as usize].position);
        let middle = Point3::weighted(corners, [1.0 / 3.0; 3]);
        let place = manifold.lift(&places[t[0] as usize], middle).unwrap_or(places[t[0] as usize]);
        topology.region(place.face)
    };
    Mesh {
        points: places.iter().map(|place| place.position.to_array()).collect(),
        point_labels: vec![0; places.len()],
        triangle_labels: triangles.iter().map(label).collect(),
        triangles,
        ..Mesh::default()
    }
}
