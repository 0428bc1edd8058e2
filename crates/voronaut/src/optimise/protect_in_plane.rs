//! Protecting the seeds of the plane: with the border's edges, along which seeds slide, and by a canvas where geodesics are not resolved.

use super::movers::Region;
use super::protect::{Protected, Protecting, protected};
use super::survey::Survey;
use super::trials::{Found, LEAST_GAIN, Luck, Search, Stand, Wish, sort};
use crate::dual::{Dual, Kind, Moving};
use crate::error::Result;
use crate::geometry::{Point, Vector};
use crate::net::{Ball, Net};
use crate::parallel::prelude::*;
use crate::progress::Progress;
use crate::triangulation::{Triangulation, VertexId};

/// Places tried by the diagram on a canvas; powers found there shall be this much greater.
const TRIES_ON_CANVAS: usize = 12;
const ASKED_OF_CANVAS: f64 = 1.15;
/// Vertices of that canvas per seed.
const PER_SEED: usize = 80;
/// Seeds slide along curves only as far as their edges there keep within these lengths (metric).
const SLIDING: [f64; 2] = [0.75, 1.35];

/// Protects the seeds of a dual; the edges at the border count as well. Vertices are numbered anew ([`Dual::reorder`]).
///
/// # Errors
/// The metric is found invalid at a seed.
pub(crate) fn protect(dual: &mut Dual, share: f64, progress: &dyn Progress) -> Result<Protected> {
    dual.reorder();
    let stand = Stand {
        positions: dual.planar().positions.clone(),
        locals: dual.locals().to_vec(),
        topology: dual.topology().clone(),
    };
    protected(&mut InPlane { dual, stand, survey: Survey::default() }, share, progress)
}

struct InPlane<'a, 'b> {
    dual: &'a mut Dual<'b>,
    stand: Stand,
    survey: Survey,
}

/// Where a step leads a seed; on its curve, if it is bound to one.
fn reached(dual: &Dual, v: VertexId, from: Point, step: Vector) -> Point {
    if dual.kind(v) == Kind::Curve { dual.slid(v, step, SLIDING) } else { from + step }
}

impl InPlane<'_, '_> {
    /// Places for seeds by what they gain in the diagram on a canvas around a simplex.
    fn tried_on_canvas(
        &mut self,
        simplex: &[VertexId],
        movable: &[VertexId],
        wish: &Wish,
        luck: &mut Luck,
    ) -> Option<Vec<Found<Point>>> {
        let region = Region::around(self.dual, simplex, PER_SEED)?;
        let missing = |ball: &Ball<3>| (1.0 - ball.power / (wish.asked * ASKED_OF_CANVAS)).max(0.0);
        let (dual, stand) = (&*self.dual, &self.stand);
        let shortfall = |v: VertexId, to: Point| {
            let at = |u: VertexId| if u == v { to } else { stand.positions[u.index()] };
            Some(region.circles(dual, at)?.iter().map(missing).sum::<f64>())
        };
        let before = shortfall(simplex[0], stand.positions[simplex[0].index()])?;
        if before <= LEAST_GAIN || movable.is_empty() {
            return None;
        }
        let mut near = |v: VertexId| reached(dual, v, stand.positions[v.index()], stand.step(v, wish.radius, luck));
        let seeds = movable.iter().cycle().take(TRIES_ON_CANVAS);
        let places: Vec<(VertexId, Point)> = seeds.map(|&v| (v, near(v))).collect();
        luck.tries += places.len() as u64;
        let found: Vec<Option<f64>> = places.par_iter().map(|&(v, to)| shortfall(v, to)).collect();
        let gains = found.iter().zip(&places).filter_map(|(after, &(v, to))| Some((before - (*after)?, v, to)));
        let mut gains: Vec<Found<Point>> = gains.collect();
        sort(&mut gains);
        Some(gains)
    }
}

impl Protecting for InPlane<'_, '_> {
    type Place = Point;

    fn topology(&self) -> &Triangulation {
        &self.stand.topology
    }

    fn kind(&self, v: VertexId) -> Kind {
        self.dual.kind(v)
    }

    /// Triangulates as well.
    fn measure(&mut self) -> Net {
        let (net, topology) = self.survey.take(self.dual, &self.stand.positions, &self.stand.topology);
        self.stand.topology = topology.unwrap_or_else(|| self.stand.topology.clone());
        net
    }

    fn places(
        &mut self,
        _movable: &[VertexId],
        search: impl FnOnce(&mut Search) -> Vec<Found<Point>>,
    ) -> Vec<Found<Point>> {
        let dual = &*self.dual;
        let reach = |v: VertexId, from: Point, step: Vector| {
            let to = reached(dual, v, from, step);
            (dual.kind(v) != Kind::Free || dual.is_inside(v, to)).then_some(to)
        };
        search(&mut Search { terrain: dual, stand: &mut self.stand, reach: &reach })
    }

    fn places_on_canvas(
        &mut self,
        simplex: &[VertexId],
        movable: &[VertexId],
        wish: &Wish,
        luck: &mut Luck,
    ) -> Option<Vec<Found<Point>>> {
        let is_by_canvas = self.survey.is_by_canvas(simplex);
        is_by_canvas.then(|| self.tried_on_canvas(simplex, movable, wish, luck).unwrap_or_default())
    }

    fn relocate(&mut self, v: VertexId, to: Point) -> bool {
        let is_done = self.dual.relocate(v, to);
        if is_done {
            self.stand.relocate(self.dual, v, to);
        }
        is_done
    }

    fn verdict(&self) -> Result<()> {
        self.dual.verdict()
    }
}
