//! Seeds on a surface: its borders at even spacing, then farthest points (RR-9103, section 13), and more where cells are no
//! discs or meet twice.

use super::farthest::Farthest;
use crate::canvas::{Canvas, Draped};
use crate::diagram::SurfaceDiagram;
use crate::error::{Error, Result};
use crate::geodesic::Method;
use crate::progress::Progress;
use crate::rdt::{OnSurface, Rdt};
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// Seeds on a closed border at least.
const LEAST_ON_BORDER: usize = 3;
/// Rounds of seeds for cells that are no discs.
const ROUNDS: usize = 40;

/// Seeds of a surface, with a triangulation of the surface: vertex i is seed i.
pub struct Seeded<'a> {
    /// The diagram on the canvas.
    pub diagram: SurfaceDiagram<'a>,
    /// The Riemannian Delaunay triangulation.
    pub dual: Rdt<OnSurface<'a>>,
    /// Seeds that were put in for the sake of cells that were no discs.
    pub added: usize,
}

/// As many seeds as asked for, at canvas vertices, borders with edges of about the length `spacing` (metric); more where
/// cells are no discs, or two of them meet twice: then their dual is no triangulation of the surface.
///
/// # Errors
/// [`Error::Unsupported`] of a method that drives no diagrams; [`Error::Domain`] where so many rounds of seeds do not make it a
/// triangulation.
pub fn seed_surface<'a>(
    canvas: &'a Canvas<Draped<'a>>,
    count: usize,
    spacing: f64,
    method: Method,
    progress: &dyn Progress,
) -> Result<Seeded<'a>> {
    let on_border: Vec<VertexId> =
        canvas.draped().borders().iter().flat_map(|curve| spaced(canvas.draped(), curve, spacing)).collect();
    let mut diagram = SurfaceDiagram::on_surface(canvas, &on_border, method)?;
    let topology = canvas.draped().topology();
    let mut farthest = Farthest::new(&diagram, |v| !topology.is_border_vertex(v));
    let mut reported = 0;
    while diagram.colours() < count {
        let Some((v, _)) = farthest.pop(&diagram) else { break };
        diagram.insert_at_vertex(v);
        if diagram.colours() >= reported + 256 {
            progress.done((diagram.colours() - reported) as u64);
            reported = diagram.colours();
        }
    }
    made_whole(diagram)
}

/// Adds seeds until the dual is a triangulation of the surface.
fn made_whole(mut diagram: SurfaceDiagram) -> Result<Seeded> {
    let before = diagram.colours();
    for _ in 0..ROUNDS {
        let (dual, poor) = surface_triangulation(&diagram);
        if poor.is_empty() {
            let added = diagram.colours() - before;
            return Ok(Seeded { diagram, dual, added });
        }
        for v in farthest_of(&diagram, &poor) {
            diagram.insert_at_vertex(v);
        }
    }
    let (_, poor) = surface_triangulation(&diagram);
    let at = poor.first().and_then(|&colour| diagram.seed(colour)).map(|v| diagram.canvas().draped().position(v));
    let help = "ask for more vertices (-n), or a finer canvas (--canvas-size)";
    let place = at.map_or_else(|| "the surface".to_owned(), |p| p.to_string());
    Err(Error::domain("cells that are no discs, whose dual is no triangulation of the surface", place, help))
}

/// The dual of a diagram's seeds, and the colours around which it is no triangulation of the surface.
pub fn surface_triangulation<'a>(diagram: &SurfaceDiagram<'a>) -> (Rdt<OnSurface<'a>>, Vec<u32>) {
    let (glued, copies) = diagram.glued_nerve();
    let dual = Rdt::from_glued(OnSurface::new(diagram), diagram.colours(), glued, &copies);
    let mut poor = no_discs(diagram);
    let topology = dual.topology();
    let is_open = |h: &HalfEdge| topology.twin(*h).is_none();
    let at_border = |v: VertexId| {
        let seed = diagram.seed(dual.seed(v));
        seed.is_some_and(|at| diagram.canvas().draped().topology().is_border_vertex(at))
    };
    for h in topology.edges().filter(is_open) {
        let ends = [topology.origin(h), topology.target(h)];
        // An edge with one face belongs between two seeds of the border.
        if !ends.iter().all(|&v| at_border(v)) {
            poor.extend(ends.map(|v| dual.seed(v)));
        }
    }
    let mut used = vec![false; diagram.colours()];
    topology.vertices().for_each(|v| used[dual.seed(v) as usize] = true);
    poor.extend((0..).zip(&used).filter(|(_, used)| !**used).map(|(colour, _)| colour));
    poor.extend(topology.vertices().filter(|v| v.index() >= diagram.colours()).map(|v| dual.seed(v)));
    poor.extend(doubled(topology).into_iter().flatten().map(|v| dual.seed(v)));
    if poor.is_empty() && topology.euler_characteristic() != diagram.canvas().draped().topology().euler_characteristic()
    {
        // Cells that are discs and meet once each make the surface; what is amiss is between the largest of them.
        poor.extend(diagram.farthest().and_then(|(v, _)| diagram.colour(v)));
    }
    poor.sort_unstable();
    poor.dedup();
    (dual, poor)
}

/// The ends of edges that are there twice, or join a vertex to itself.
fn doubled(topology: &Triangulation) -> Vec<[VertexId; 2]> {
    let ends = |h: HalfEdge| [topology.origin(h), topology.target(h)];
    let mut all: Vec<[VertexId; 2]> = topology.edges().map(ends).map(|[a, b]| [a.min(b), a.max(b)]).collect();
    all.sort_unstable();
    let loops = all.iter().filter(|[a, b]| a == b).copied();
    loops.chain(all.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| pair[0])).collect()
}

/// The cells whose canvas vertices, with the edges and faces between them, are no disc.
fn no_discs(diagram: &SurfaceDiagram) -> Vec<u32> {
    let topology = diagram.canvas().topology();
    let mut count = vec![0_i64; diagram.colours()];
    let mut add = |colour: Option<u32>, what: i64| {
        if let Some(count) = colour.and_then(|colour| count.get_mut(colour as usize)) {
            *count += what;
        }
    };
    topology.vertices().for_each(|v| add(diagram.colour(v), 1));
    for h in topology.edges() {
        let [a, b] = [topology.origin(h), topology.target(h)].map(|v| diagram.colour(v));
        add(a.filter(|_| a == b), -1);
    }
    for f in topology.faces() {
        let [a, b, c] = topology.corners(f).map(|v| diagram.colour(v));
        add(a.filter(|_| a == b && b == c), 1);
    }
    (0..).zip(count).filter(|(_, count)| *count != 1).map(|(colour, _)| colour).collect()
}

/// The canvas vertex that is farthest from its seed, of each of some cells; none of a cell that is one vertex.
fn farthest_of(diagram: &SurfaceDiagram, colours: &[u32]) -> Vec<VertexId> {
    let mut best: Vec<Option<VertexId>> = vec![None; diagram.colours()];
    for v in diagram.canvas().topology().vertices() {
        if let Some(best) = diagram.colour(v).and_then(|colour| best.get_mut(colour as usize)) {
            let is_farther = best.is_none_or(|known| diagram.distance(known) < diagram.distance(v));
            if is_farther && diagram.distance(v) > 0.0 {
                *best = Some(v);
            }
        }
    }
    colours.iter().filter_map(|&colour| best[colour as usize]).collect()
}

/// Vertices of a closed curve, its corners among them, that are about so far apart.
fn spaced(draped: &Draped, curve: &[HalfEdge], spacing: f64) -> Vec<VertexId> {
    let topology = draped.topology();
    let corners: Vec<usize> = (0..curve.len()).filter(|&i| i == 0 || draped.is_corner(curve, i)).collect();
    let least = LEAST_ON_BORDER.div_ceil(corners.len());
    let mut found = Vec::new();
    for (k, &begin) in corners.iter().enumerate() {
        let end = corners.get(k + 1).copied().unwrap_or(curve.len());
        let lengths: Vec<f64> = curve[begin..end].iter().map(|&h| topology.length(h)).collect();
        let total: f64 = lengths.iter().sum();
        let parts = ((total / spacing).round() as usize).clamp(least.min(end - begin), end - begin);
        let (mut along, mut part) = (0.0, 0);
        for (h, length) in curve[begin..end].iter().zip(&lengths) {
            // The vertex nearest to the next division.
            if part < parts && along + 0.5 * length >= total * part as f64 / parts as f64 {
                found.push(topology.origin(*h));
                part += 1;
            }
            along += length;
        }
    }
    found
}
