//! Whether the triangles that are glued can all turn the same way.

use super::glue::{NONE, Twins, numbers};
use super::mended::Damage;
use super::work::Work;
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
    for &(root, is_turned) in &found {
        counts[root as usize][usize::from(is_turned)] += 1;
    }
    for (t, &(root, is_turned)) in found.iter().enumerate() {
        let [as_root, others] = counts[root as usize];
        if is_turned == (others <= as_root) && as_root.min(others) > 0 {
            work.note_triangle(Damage::Turned, t);
        }
    }
}

/// Triangles in sets, each with whether it turns as the first of its set.
struct Turns {
    parent: Vec<(u32, bool)>,
    size: Vec<u32>,
}

impl Turns {
    fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).map(|t| (t, false)).collect(), size: vec![1; count] }
    }

    fn of(&mut self, t: u32) -> (u32, bool) {
        let (mut at, mut is_turned) = (t, false);
        while self.parent[at as usize].0 != at {
            is_turned ^= self.parent[at as usize].1;
            at = self.parent[at as usize].0;
        }
        self.parent[t as usize] = (at, is_turned);
        (at, is_turned)
    }

    /// Makes one set of two, where one triangle is to turn against the other or not; false if they already turn otherwise.
    fn join(&mut self, s: u32, t: u32, is_against: bool) -> bool {
        let ((mut root, a), (mut other, b)) = (self.of(s), self.of(t));
        if root == other {
            return (a ^ b) == is_against;
        }
        if self.size[root as usize] < self.size[other as usize] {
            std::mem::swap(&mut root, &mut other);
        }
        self.parent[other as usize] = (root, a ^ b ^ is_against);
        self.size[root as usize] += self.size[other as usize];
        true
    }
}
