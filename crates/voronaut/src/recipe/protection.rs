//! Protected seeds: the last moves, and what the report says of the net.

use super::dual::compared;
use super::plane::Job;
use super::surface_pass::{Checked, Pass, Setting};
use super::{MeshOptions, Seeding};
use crate::canvas::{self, Canvas};
use crate::diagram::{Diagram, RESOLVE_ROUNDS, SurfaceDiagram, resolve};
use crate::dual::{Dual, Moving, Road};
use crate::error::{Error, Result};
use crate::figures;
use crate::geodesic::Method;
use crate::geometry::Point;
use crate::manifold::Place;
use crate::net::{Ball, Net};
use crate::optimise::{Ending, Protected, measured, measured_on_surface, protect, protect_on_surface};
use crate::sampling::Plan;

/// Refuses to look for what there cannot be: equilateral triangles, which are protected best, are by sqrt(3) epsilon.
///
/// # Errors
/// [`Error::Unsupported`] of more.
pub(super) fn demand_possible(options: &MeshOptions) -> Result<()> {
    let asked = options.protection;
    if options.seeding != Seeding::Protected || asked <= 3.0_f64.sqrt() {
        return Ok(());
    }
    let help = "lower `protection`: equilateral triangles are protected by sqrt(3) epsilon; 0.2 is met by most meshes";
    Err(Error::unsupported(format!("protection by {asked} epsilon"), help))
}

impl Job<'_> {
    /// With [`Seeding::Protected`], moves seeds until their simplices are protected.
    ///
    /// # Errors
    /// The metric is found invalid at a seed.
    pub(super) fn protect(
        &mut self,
        plan: &Plan,
        dual: &mut Dual,
    ) -> Result<Option<(Protected, figures::CanvasNerve)>> {
        if self.options.seeding != Seeding::Protected {
            return Ok(None);
        }
        self.progress.begin("protecting", 1)?;
        let protected = self.watch.time("protect", || protect(dual, self.options.protection, self.progress))?;
        self.progress.begin("comparing with a canvas", 1)?;
        let nerve = self.watch.time("raw_nerve", || self.raw_nerve(plan, dual))?;
        self.notes.extend(notes(&protected, self.options, nerve));
        Ok(Some((protected, nerve)))
    }

    /// The nerve of the vertices on a canvas that is refined where it does not tell Voronoi vertices apart, held against the
    /// exact dual. (Where the domain touches itself in points, of the vertices there only one counts.)
    fn raw_nerve(&self, plan: &Plan, dual: &Dual) -> Result<figures::CanvasNerve> {
        let number = plan.numbering(dual);
        let mut seeds: Vec<(u32, Point)> =
            dual.topology().vertices().map(|v| (number[v.index()], dual.position(v))).collect();
        seeds.sort_by_key(|seed| seed.0);
        seeds.dedup_by_key(|seed| seed.0);
        let seeds: Vec<Point> = seeds.into_iter().map(|seed| seed.1).collect();
        let field = dual.field();
        let size = canvas::size_for(seeds.len(), self.options.canvas_size);
        let resolved = resolve(Canvas::intrinsic(plan.domain.planar(), field, size)?, field, &seeds, RESOLVE_ROUNDS)?;
        let diagram = Diagram::new(&resolved.canvas, field, &seeds)?;
        let nerve = super::dual(&diagram, Road::Both, self.progress).raw_nerve;
        let canvas_vertices = resolved.canvas.vertex_count();
        Ok(figures::CanvasNerve { canvas_vertices, rounds: resolved.rounds, unwitnessed: resolved.unwitnessed, nerve })
    }

    /// The net of the mesh's vertices, by their numbers in the mesh, where it is wanted, and how protection went.
    pub(super) fn net(
        &mut self,
        plan: &Plan,
        dual: &Dual,
        protected: Option<(Protected, figures::CanvasNerve)>,
    ) -> (Option<Net>, Option<figures::Protection>) {
        let account = protected.as_ref().map(|(protected, nerve)| account(protected, self.options, *nerve));
        let net = match protected {
            Some((protected, _)) => protected.net,
            None if self.options.net => self.watch.time("net", || measured(dual)),
            None => return (None, None),
        };
        let number = plan.numbering(dual);
        (Some(numbered(net, |v| number[v as usize])), account)
    }
}

impl<'a> Setting<'a> {
    /// [`Job::protect`] of a pass whose mesh is valid, with seeds inside patches moved. Where what comes out is no mesh it stays as it was.
    ///
    /// # Errors
    /// The canvas finds the metric invalid somewhere.
    pub(super) fn protect(
        &self,
        pass: &mut Pass<'a>,
        checked: &mut Checked,
        said: &mut Vec<String>,
    ) -> Result<Option<(Net<Place>, figures::Protection)>> {
        if self.options.seeding != Seeding::Protected {
            return Ok(None);
        }
        self.progress.begin("protecting", 1)?;
        let before = pass.dual.save();
        let protect = || protect_on_surface(&mut pass.dual, self.options.protection, self.progress);
        let mut protected = self.watch.time("protect", protect)?;
        let better = self.checked(pass)?;
        if better.faulty.is_empty() {
            *checked = better;
            if self.options.dual != Road::Canvas {
                // What is told of its edges is of those that are there now.
                self.settle_edges(pass)?;
            }
        } else {
            pass.dual.take_back(&before);
            protected.net = measured_on_surface(&pass.dual);
            (protected.ending, protected.unprotected[1]) = (Ending::Stalled, protected.unprotected[0]);
            said.push(format!("not protected: {} triangles would meet or fold over", better.faulty.len()));
        }
        self.progress.begin("comparing with a canvas", 1)?;
        let nerve = self.watch.time("raw_nerve", || self.raw_nerve(pass, &protected.net))?;
        said.extend(notes(&protected, self.options, nerve));
        let account = account(&protected, self.options, nerve);
        Ok(Some((numbered(protected.net, |place| pass.vertex(place)), account)))
    }

    /// The nerve of the seeds on a canvas that has them for vertices and is not refined, held against the triangles whose cells meet.
    fn raw_nerve(&self, pass: &Pass, net: &Net<Place>) -> Result<figures::CanvasNerve> {
        let places = pass.dual.places();
        let size = self.canvas_size(places.len());
        let (canvas, at) = Canvas::on_surface(canvas::Kind::Intrinsic, self.manifold, self.metric, size, places)?;
        let diagram = SurfaceDiagram::on_surface(&canvas, &at, Method::default())?;
        let exact: Vec<[u32; 3]> = net.interior().map(|ball| ball.corners).collect();
        let nerve = compared(&diagram, &exact);
        let canvas_vertices = canvas.topology().vertex_count();
        Ok(figures::CanvasNerve { canvas_vertices, rounds: 0, unwitnessed: nerve.missing, nerve })
    }

    /// The net of a pass's seeds, by their numbers in the mesh.
    pub(super) fn net(&self, pass: &Pass) -> Net<Place> {
        numbered(self.watch.time("net", || measured_on_surface(&pass.dual)), |place| pass.vertex(place))
    }
}

/// What to tell the user.
fn notes<P>(protected: &Protected<P>, options: &MeshOptions, nerve: figures::CanvasNerve) -> Vec<String> {
    let (asked, left, unknown) = (options.protection, protected.unprotected[1], protected.net.unmeasured);
    let figures::RawNerve { missing, extra, .. } = nerve.nerve;
    let told = [
        (
            protected.ending != Ending::Protected,
            format!("{left} simplices are less power-protected than by {asked} epsilon"),
        ),
        (
            unknown > 0,
            format!("{unknown} simplices have no circle that geodesics find: whether they are protected is unknown"),
        ),
        (
            missing + extra > 0,
            format!("the nerve on a canvas lacks {missing} triangles of the exact dual and has {extra} others"),
        ),
    ];
    told.into_iter().filter_map(|(is_so, note)| is_so.then_some(note)).collect()
}

fn account<P>(protected: &Protected<P>, options: &MeshOptions, raw_nerve: figures::CanvasNerve) -> figures::Protection {
    let [before, after] = protected.unprotected;
    figures::Protection {
        asked: options.protection,
        ending: protected.ending,
        rounds: protected.rounds,
        moves: protected.moves,
        tries: protected.tries,
        unprotected_before: before,
        unprotected: after,
        raw_nerve,
    }
}

fn numbered<P>(mut net: Net<P>, number: impl Fn(u32) -> u32) -> Net<P> {
    net.triangles.iter_mut().for_each(|ball| renumber(ball, &number));
    net.border.iter_mut().for_each(|ball| renumber(ball, &number));
    net.unknown.iter_mut().flatten().for_each(|corner| *corner = number(*corner));
    net
}

fn renumber<const N: usize, P>(ball: &mut Ball<N, P>, number: &impl Fn(u32) -> u32) {
    ball.corners = std::array::from_fn(|k| number(ball.corners[k]));
    ball.nearest = ball.nearest.map(number);
}
