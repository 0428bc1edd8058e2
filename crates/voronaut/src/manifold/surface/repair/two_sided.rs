//! Whether the triangles that are glued can all turn the same way.

use super::glue::{Twins, numbers};
use super::mended::Damage;
use super::work::Work;
use crate::error::Result;
use crate::manifold::surface::build::{Turns, one_sided};
use crate::mesh::edges::NONE;

/// Opens what makes the surface one-sided, and counts the triangles that [`Surface::new`](crate::manifold::surface::Surface::new) will
/// turn.
///
/// Sides that share their vertex numbers come first. Those at the same places only, whose gluing would make a Moebius strip of
/// a ribbon, stay open.
///
/// # Errors
/// [`Error::Domain`](crate::Error::Domain) of a surface that is one-sided by its numbers, unless damage is to be repaired:
/// then it is cut open.
pub(super) fn demand(work: &mut Work, twins: &mut Twins) -> Result<()> {
    let mut turns = Turns::new(work.triangles.len());
    for is_by_number in [true, false] {
        for side in 0..twins.len() as u32 {
            let twin = twins[side as usize];
            let same = || numbers(work, side) == numbers(work, twin);
            if twin == NONE || twin < side || same() != is_by_number {
                continue;
            }
            if turns.join(side / 3, twin / 3, !are_opposite(work, side, twin)) {
                continue;
            }
            let place = work.edge(numbers(work, side));
            if is_by_number && !work.options.repair {
                return Err(one_sided(place));
            }
            work.mended.add(if is_by_number { Damage::OneSided } else { Damage::Seam }, place);
            (twins[side as usize], twins[twin as usize]) = (NONE, NONE);
        }
    }
    turns.minorities().into_iter().for_each(|t| work.note_triangle(Damage::Turned, t));
    Ok(())
}

/// Whether two triangles pass the edge between them in opposite directions.
fn are_opposite(work: &Work, side: u32, twin: u32) -> bool {
    let [from, to] = [side, twin].map(|side| work.places.of(work.ends(side)[0]));
    from != to
}
