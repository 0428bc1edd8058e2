//! Whether the triangles that are glued can all turn the same way.

use super::glue::{NONE, Twins, numbers};
use super::mended::Damage;
use super::work::{Classes, Work};
use crate::error::Result;
use crate::surface::build::one_sided;

/// Opens what makes the surface one-sided, and counts the triangles that [`Surface::new`](crate::surface::Surface::new) will
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
    note_turned(work, &mut turns);
    Ok(())
}

/// Whether two triangles pass the edge between them in opposite directions.
fn are_opposite(work: &Work, side: u32, twin: u32) -> bool {
    let [from, to] = [side, twin].map(|side| work.places.of(work.ends(side)[0]));
    from != to
}

/// The fewer of each component are turned.
fn note_turned(work: &mut Work, turns: &mut Turns) {
    let found: Vec<(u32, bool)> = (0..work.triangles.len() as u32).map(|t| turns.of(t)).collect();
    let mut counts = vec![[0_usize; 2]; found.len()];
    for &(first, is_turned) in &found {
        counts[first as usize][usize::from(is_turned)] += 1;
    }
    for (t, &(first, is_turned)) in found.iter().enumerate() {
        let [as_first, others] = counts[first as usize];
        if is_turned == (others <= as_first) && as_first.min(others) > 0 {
            work.note_triangle(Damage::Turned, t);
        }
    }
}

/// Which triangles turn as others do: t as it is, and t + count turned.
struct Turns {
    count: u32,
    same: Classes,
}

impl Turns {
    fn new(count: usize) -> Self {
        Self { count: count as u32, same: Classes::new(2 * count) }
    }

    /// The first triangle of the same component, and whether this one turns against it.
    fn of(&mut self, t: u32) -> (u32, bool) {
        let [own, against] = [t, t + self.count].map(|t| self.same.shorten(t));
        (own.min(against), against < own)
    }

    /// Makes one component of two, where one triangle is to turn against the other or not; false if they already turn otherwise.
    fn join(&mut self, s: u32, t: u32, is_against: bool) -> bool {
        let [like, unlike] = if is_against { [t + self.count, t] } else { [t, t + self.count] };
        if self.same.shorten(s) == self.same.shorten(unlike) {
            return false;
        }
        self.same.join(s, like);
        self.same.join(s + self.count, unlike);
        true
    }
}
