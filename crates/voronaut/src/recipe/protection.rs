//! Protected seeds: the last moves, and what the report says of the net.

use super::{Job, MeshOptions, Seeding};
use crate::canvas::{self, Canvas};
use crate::diagram::{Diagram, RESOLVE_ROUNDS, resolve};
use crate::domain::Domain;
use crate::dual::{Dual, Moving, Road};
use crate::error::{Error, Result};
use crate::figures;
use crate::geometry::Point;
use crate::net::{Ball, Net};
use crate::optimise::{Ending, Protected, measured, protect};

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
        domain: &Domain,
        dual: &mut Dual,
    ) -> Result<Option<(Protected, figures::CanvasNerve)>> {
        if self.options.seeding != Seeding::Protected {
            return Ok(None);
        }
        self.progress.begin("protecting", 1)?;
        let protected = self.watch.time("protect", || protect(dual, self.options.protection, self.progress))?;
        let left = protected.unprotected[1];
        if protected.ending != Ending::Protected {
            let asked = self.options.protection;
            self.notes.push(format!("{left} simplices are less power-protected than by {asked} epsilon"));
        }
        if protected.net.unmeasured > 0 {
            let unknown = protected.net.unmeasured;
            self.notes.push(format!(
                "{unknown} simplices have no circle that geodesics find: whether they are protected is unknown"
            ));
        }
        self.progress.begin("comparing with a canvas", 1)?;
        let nerve = self.watch.time("raw_nerve", || self.raw_nerve(domain, dual))?;
        if nerve.nerve.missing + nerve.nerve.extra > 0 {
            let figures::RawNerve { missing, extra, .. } = nerve.nerve;
            self.notes.push(format!(
                "the nerve on a canvas lacks {missing} triangles of the exact dual and has {extra} others"
            ));
        }
        Ok(Some((protected, nerve)))
    }

    /// The nerve of the vertices on a canvas that is refined where it does not tell Voronoi vertices apart, held against the
    /// exact dual. (Where the domain touches itself in points, of the vertices there only one counts.)
    fn raw_nerve(&self, domain: &Domain, dual: &Dual) -> Result<figures::CanvasNerve> {
        let number = dual.numbering(domain);
        let mut seeds: Vec<(u32, Point)> =
            dual.topology().vertices().map(|v| (number[v.index()], dual.position(v))).collect();
        seeds.sort_by_key(|seed| seed.0);
        seeds.dedup_by_key(|seed| seed.0);
        let seeds: Vec<Point> = seeds.into_iter().map(|seed| seed.1).collect();
        let field = dual.field();
        let size = canvas::size_for(seeds.len(), self.options.canvas_size);
        let resolved = resolve(Canvas::intrinsic(domain, field, size)?, field, &seeds, RESOLVE_ROUNDS)?;
        let diagram = Diagram::new(&resolved.canvas, field, &seeds)?;
        let nerve = super::dual(&diagram, field, Road::Both, self.progress).raw_nerve;
        let canvas_vertices = resolved.canvas.vertex_count();
        Ok(figures::CanvasNerve { canvas_vertices, rounds: resolved.rounds, unwitnessed: resolved.unwitnessed, nerve })
    }

    /// The net of the mesh's vertices, by their numbers in the mesh, where it is wanted, and how protection went.
    pub(super) fn net(
        &mut self,
        domain: &Domain,
        dual: &Dual,
        protected: Option<(Protected, figures::CanvasNerve)>,
    ) -> (Option<Net>, Option<figures::Protection>) {
        let account = protected.as_ref().map(|(protected, nerve)| self.account(protected, *nerve));
        let net = match protected {
            Some((protected, _)) => protected.net,
            None if self.options.net => self.watch.time("net", || measured(dual)),
            None => return (None, None),
        };
        let number = dual.numbering(domain);
        (Some(numbered(net, &number)), account)
    }

    fn account(&self, protected: &Protected, raw_nerve: figures::CanvasNerve) -> figures::Protection {
        let [before, after] = protected.unprotected;
        figures::Protection {
            asked: self.options.protection,
            ending: protected.ending,
            rounds: protected.rounds,
            moves: protected.moves,
            tries: protected.tries,
            unprotected_before: before,
            unprotected: after,
            raw_nerve,
        }
    }
}

fn numbered(mut net: Net, number: &[u32]) -> Net {
    net.triangles.iter_mut().for_each(|ball| renumber(ball, number));
    net.border.iter_mut().for_each(|ball| renumber(ball, number));
    net.unknown.iter_mut().flatten().for_each(|corner| *corner = number[*corner as usize]);
    net
}

fn renumber<const N: usize>(ball: &mut Ball<N>, number: &[u32]) {
    let new = |v: u32| number[v as usize];
    ball.corners = ball.corners.map(new);
    ball.nearest = ball.nearest.map(new);
}
