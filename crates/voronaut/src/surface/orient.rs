//! Triangles turned so that neighbours agree.

use crate::error::{Error, Result};
use crate::mesh::Side;

/// Turns triangles until neighbours pass their edge in opposite directions; in each component as few as possible (its
/// majority stays). Every edge has at most two `sides`. Returns how many were turned.
///
/// # Errors
/// [`Error::Domain`] of a one-sided surface (a Moebius strip, a Klein bottle), where no way of turning is right; `place`
/// says where an edge is.
pub(super) fn orient(triangles: &mut [[u32; 3]], sides: &[Side], place: impl Fn([u32; 2]) -> String) -> Result<usize> {
    let neighbours = neighbours(triangles.len(), sides);
    let mut turned: Vec<Option<bool>> = vec![None; triangles.len()];
    let mut count = 0;
    for start in 0..triangles.len() {
        if turned[start].is_some() {
            continue;
        }
        turned[start] = Some(false);
        let mut component = vec![start];
        let mut next = 0;
        while let Some(&triangle) = component.get(next) {
            next += 1;
            for &Neighbour { triangle: other, same_direction, ends } in &neighbours[triangle] {
                let needed = turned[triangle].map(|turned| turned != same_direction);
                match turned[other] {
                    None => {
                        turned[other] = needed;
                        component.push(other);
                    }
                    found if found == needed => {}
                    _ => return Err(one_sided(place(ends))),
                }
            }
        }
        count += turn(triangles, &component, &turned);
    }
    Ok(count)
}

/// A triangle across an edge.
#[derive(Clone, Copy)]
struct Neighbour {
    triangle: usize,
    same_direction: bool,
    ends: [u32; 2],
}

fn neighbours(count: usize, sides: &[Side]) -> Vec<Vec<Neighbour>> {
    let mut neighbours = vec![Vec::with_capacity(3); count];
    for pair in sides.windows(2).filter(|pair| pair[0].ends == pair[1].ends) {
        let (same_direction, ends) = (pair[0].forward == pair[1].forward, pair[0].ends);
        for [from, to] in [[0, 1], [1, 0]] {
            let neighbour = Neighbour { triangle: pair[to].triangle as usize, same_direction, ends };
            neighbours[pair[from].triangle as usize].push(neighbour);
        }
    }
    neighbours
}

/// Turns the smaller part of a component.
fn turn(triangles: &mut [[u32; 3]], component: &[usize], turned: &[Option<bool>]) -> usize {
    let marked = component.iter().filter(|&&t| turned[t] == Some(true)).count();
    let which = 2 * marked <= component.len();
    let mut count = 0;
    for &t in component.iter().filter(|&&t| turned[t] == Some(which)) {
        triangles[t].swap(1, 2);
        count += 1;
    }
    count
}

/// The error of a surface without two sides.
pub(super) fn one_sided(place: String) -> Error {
    let help =
        "only two-sided surfaces can be meshed: cut this one open (`repair` does), or correct the triangles there";
    Error::domain("a one-sided surface: its triangles cannot all turn the same way", place, help)
}
