//! Protected seeds: the last moves, and what the report says of the net.

use super::{Job, Seeding};
use crate::domain::Domain;
use crate::dual::Dual;
use crate::error::Result;
use crate::net::{Ball, Net};
use crate::optimise::{Ending, Protected, measured, protect};
use crate::output::report;

impl Job<'_> {
    /// With [`Seeding::Protected`], moves seeds until their simplices are protected.
    ///
    /// # Errors
    /// The metric is found invalid at a seed.
    pub(super) fn protect(&mut self, dual: &mut Dual) -> Result<Option<Protected>> {
        if self.options.seeding != Seeding::Protected {
            return Ok(None);
        }
        self.progress.stage("protecting", 1);
        let protected = self.timed("protect", |job| protect(dual, job.options.protection, job.progress))?;
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
        Ok(Some(protected))
    }

    /// The net of the mesh's vertices, by their numbers in the mesh, where it is wanted, and how protection went.
    pub(super) fn net(
        &mut self,
        domain: &Domain,
        dual: &Dual,
        protected: Option<Protected>,
    ) -> (Option<Net>, Option<report::Protection>) {
        let account = protected.as_ref().map(|p| self.account(p));
        let net = match protected {
            Some(protected) => protected.net,
            None if self.options.net => self.timed("net", |_| measured(dual)),
            None => return (None, None),
        };
        let number = dual.numbering(domain);
        (Some(numbered(net, &number)), account)
    }

    fn account(&self, protected: &Protected) -> report::Protection {
        let [before, after] = protected.unprotected;
        report::Protection {
            asked: self.options.protection,
            ending: protected.ending,
            rounds: protected.rounds,
            moves: protected.moves,
            tries: protected.tries,
            unprotected_before: before,
            unprotected: after,
        }
    }
}

fn numbered(mut net: Net, number: &[u32]) -> Net {
    net.triangles.iter_mut().for_each(|ball| renumber(ball, number));
    net.border.iter_mut().for_each(|ball| renumber(ball, number));
    net
}

fn renumber<const N: usize>(ball: &mut Ball<N>, number: &[u32]) {
    let new = |v: u32| number[v as usize];
    ball.corners = ball.corners.map(new);
    ball.nearest = ball.nearest.map(new);
}
