//! Seeds inside the patches of a surface: farthest points (RR-9103, section 13), and a triangulation of all seeds.

use super::contract::contracted;
use super::farthest::Farthest;
use crate::canvas::{Canvas, Draped};
use crate::diagram::SurfaceDiagram;
use crate::error::{Error, Result};
use crate::geodesic::Method;
use crate::progress::Progress;
use crate::rdt::{OnSurface, Rdt};
use crate::triangulation::{HalfEdge, Triangulation, VertexId};

/// Rounds of seeds for what contraction leaves, each of twice as many.
const ROUNDS: usize = 10;

/// Seeds of a surface, with a triangulation of the surface.
pub(crate) struct Seeded<'a> {
    /// The diagram on the canvas.
    pub diagram: SurfaceDiagram<'a>,
    /// The triangles by their colours: those of the Riemannian Delaunay triangulation where that is one of the surface, else
    /// those of the contracted canvas.
    pub triangles: Vec<[u32; 3]>,
    /// Seeds that were put in because fewer do not make the surface.
    pub added: usize,
}

/// As many seeds as asked for: those that are given, on borders, and others at canvas vertices inside, where `may_hold` lets
/// them be. More where fewer do not make a triangulation of the surface.
///
/// # Errors
/// [`crate::Error::Unsupported`] of a method that drives no diagrams; [`crate::Error::Domain`] where so many rounds of seeds make
/// no triangulation.
pub(crate) fn seed_surface<'a>(
    canvas: &'a Canvas<Draped<'a>>,
    given: &[VertexId],
    count: usize,
    method: Method,
    may_hold: impl Fn(VertexId) -> bool,
    progress: &dyn Progress,
) -> Result<Seeded<'a>> {
    let mut diagram = SurfaceDiagram::on_surface(canvas, given, method)?;
    let topology = canvas.draped().topology();
    let mut farthest = Farthest::new(&diagram, |v| !topology.is_border_vertex(v) && may_hold(v));
    let mut reported = 0;
    while diagram.colours() < count {
        let Some((v, _)) = farthest.pop(&diagram) else { break };
        diagram.insert_at_vertex(v);
        if diagram.colours() >= reported + 256 {
            progress.done((diagram.colours() - reported) as u64);
            reported = diagram.colours();
        }
    }
    triangulated(diagram)
}

/// The triangulation of a diagram's seeds; adds seeds if it must.
///
/// # Errors
/// As for `seed_surface`.
pub(crate) fn triangulated(diagram: SurfaceDiagram) -> Result<Seeded> {
    let (dual, poor) = surface_triangulation(&diagram);
    if poor.is_empty() {
        return Ok(Seeded { triangles: dual.triangles(), diagram, added: 0 });
    }
    triangulated_upright(diagram)
}

/// The triangulation of a diagram's seeds by contraction of the canvas: its triangles stand upright on the surface if that can
/// be, whatever the metric says. Adds seeds if it must.
///
/// # Errors
/// As for [`seed_surface`].
pub(crate) fn triangulated_upright(mut diagram: SurfaceDiagram) -> Result<Seeded> {
    let before = diagram.colours();
    for round in 0..ROUNDS {
        let (triangles, left) = contracted(&diagram);
        if left.is_empty() {
            let added = diagram.colours() - before;
            return Ok(Seeded { diagram, triangles, added });
        }
        for _ in 0..1 << round {
            let farthest = left.iter().max_by(|&&v, &&w| diagram.distance(v).total_cmp(&diagram.distance(w)));
            if let Some(&v) = farthest.filter(|&&v| diagram.distance(v) > 0.0) {
                diagram.insert_at_vertex(v);
            }
        }
    }
    let (_, left) = contracted(&diagram);
    let place =
        left.first().map_or_else(|| "the surface".to_owned(), |&v| diagram.canvas().draped().position(v).to_string());
    let help = "ask for more vertices (`vertices`), or a finer canvas (`canvas_size`)";
    Err(Error::domain("too few vertices for a mesh of the surface's topology", place, help))
}

/// The dual of a diagram's seeds, and the colours around which it is no triangulation of the surface.
fn surface_triangulation<'a>(diagram: &SurfaceDiagram<'a>) -> (Rdt<OnSurface<'a>>, Vec<u32>) {
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
