//! Meshes as they come, made surfaces: damage mended, or named with its place.
//!
//! | module | what it does |
//! |---|---|
//! | `work` | a mesh on the bench; sets of numbers |
//! | `dropped` | triangles that are not finite, without area, or there twice |
//! | `weld` | vertices at one place |
//! | `t_junctions` | vertices inside edges |
//! | `glue`, `two_sided`, `fans` | which sides meet, and fins that this leaves loose; not one-sided; one vertex per fan |
//! | `holes` | small holes |
//! | `emit` | lists and labels, renumbered |
//! | `mended` | what was done, in numbers and words |

mod dropped;
mod emit;
mod fans;
mod glue;
mod holes;
mod mended;
mod t_junctions;
mod two_sided;
mod weld;
mod work;

#[cfg(test)]
mod tests;

pub(crate) use mended::Damage;
pub use mended::Mended;

use crate::error::{Error, Result};
use crate::lists::distinct;
use crate::manifold::surface::Surface;
use crate::mesh::Mesh;
use crate::mesh::edges::NONE;
use work::Work;

/// What may be done to a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RepairOptions {
    /// Whether damage that cannot be mended without guessing is mended, too: triangles at coordinates that are not finite
    /// dropped, T-junctions closed by cutting triangles, edges of more than two triangles (of which fins are
    /// dropped) and vertices in which sheets meet cut, one-sided surfaces cut open, small holes closed.
    pub repair: bool,
}

/// A mesh that [`Surface::new`] accepts, and what was mended for that.
///
/// Always: vertices at one place are welded where that closes a seam (exactly there, and on borders within 1e-9 of the
/// diagonal and 1e-2 of the edges), never where the surface would stop being one; triangles without area and duplicates are
/// dropped. The rest is up to the options. A mesh without damage comes back as it is. Vertices keep their numbers, and new
/// ones follow; triangles keep their order. Borders are no damage. n log n in all; deterministic.
///
/// # Errors
/// [`Error::Mesh`] and [`Error::Domain`] as [`Surface::new`]: of damage that the options do not allow to mend, of a list of
/// edges that does not fit, and where no triangles are left.
pub fn repaired(mesh: &Mesh, options: RepairOptions) -> Result<(Mesh, Mended)> {
    let (mut made, mut mended) = looked_over(mesh, options)?;
    let mut looks = 1;
    while let Err(error) = Surface::new(&made) {
        if !options.repair || looks == LOOKS {
            return Err(error);
        }
        let (again, more) = looked_over(&made, options)?;
        mended.append(more);
        (made, looks) = (again, looks + 1);
    }
    Ok((made, mended))
}

/// What cutting and closing leave behind is looked over again, so often in all.
const LOOKS: usize = 3;

/// All repairs, once.
fn looked_over(mesh: &Mesh, options: RepairOptions) -> Result<(Mesh, Mended)> {
    mesh.check_numbers()?;
    mesh.demand_straight()?;
    let mut work = Work::new(mesh, options);
    dropped::drop_not_finite(&mut work)?;
    weld::find_places(&mut work);
    drop_triangles(&mut work)?;
    if t_junctions::close(&mut work)? {
        drop_triangles(&mut work)?;
    }
    let mut twins = glue::glue(&mut work)?;
    if work.mended.count(Damage::Edge) > 0 && glue::drop_fins(&mut work, &twins) {
        twins = glue::glue(&mut work)?;
    }
    two_sided::demand(&mut work, &mut twins)?;
    let mut sewn = fans::sew(&mut work, &twins)?;
    note_welded(&mut work, &sewn);
    holes::close(&mut work, &mut sewn);
    let made = emit::emit(&mut work, &sewn);
    if made.triangles.is_empty() && !mesh.triangles.is_empty() {
        let said: Vec<String> = work.mended.sentences().collect();
        let what = format!("no triangles are left: {}", said.join(", "));
        return Err(Error::domain(what, "the mesh", "give a surface of triangles with area"));
    }
    let made =
        if work.mended.changes_the_mesh() { made } else { Mesh { points: emit::harmless(mesh), ..mesh.clone() } };
    Ok((made, work.mended))
}

fn drop_triangles(work: &mut Work) -> Result<()> {
    dropped::drop_degenerate(work)?;
    dropped::drop_duplicates(work);
    Ok(())
}

/// Counts vertices that were joined to another.
fn note_welded(work: &mut Work, sewn: &fans::Sewn) {
    let corners = sewn.numbers.as_flattened().iter().zip(sewn.triangles.as_flattened());
    let pairs = distinct(corners.filter(|c| *c.0 != NONE).map(|(&number, &v)| [v, number]));
    for pair in pairs.windows(2).filter(|pair| pair[0][0] == pair[1][0]) {
        work.mended.add(Damage::Welded, work.vertex(pair[1][1]));
    }
}
