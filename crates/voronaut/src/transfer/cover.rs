//! How well the old mesh covers the new one.

use super::ground::ASIDE;
use crate::error::{Error, Result};
use crate::geometry::{Aabb3, Point, Point3, Vector3};
use crate::mesh::Mesh;
use serde::Serialize;

/// How well the old mesh covers the new one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cover {
    /// Vertices of the new mesh that are outside the old one, by more than rounding.
    pub outside: usize,
    /// How far the farthest of them is (Euclidean).
    pub farthest: f64,
    /// Shares of areas; of conservative transfer only.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub areas: Option<Shares>,
}

/// Shares of areas that only one of the two meshes covers.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shares {
    /// Of the new mesh's area: what no triangle of the old mesh covers.
    pub uncovered: f64,
    /// Of the old mesh's area: what no triangle of the new mesh covers.
    pub left: f64,
    /// Of the new mesh's area: what triangles of the old mesh cover more than once.
    pub overlapped: f64,
}

/// How far the new mesh may reach beyond the old one, as a share of the old one's extent, and how much of an area may be missing:
/// curves are meshed by chords.
const OVERHANG: f64 = 0.05;
/// How much of an area may be missing on a surface, where all triangles are chords: on a sphere those with sides of a radian have 20 % less
/// than what they span, and both meshes may have such.
const AREAS_ON_SURFACE: f64 = 0.25;

/// Beyond its mesh a field goes on with the nearest value: right for a sliver along a curved boundary, a mistake anywhere
/// else.
pub(super) fn demand_extent(old: &Mesh, new: &Mesh) -> Result<()> {
    let of = |mesh: &Mesh| {
        let used = mesh.triangles.as_flattened().iter();
        Aabb3::of(used.map(|&v| mesh.position(v)))
    };
    let (Some(cover), Some(bounds)) = (of(old), of(new)) else { return Ok(()) };
    let (mut allowed, lower, upper) = (cover.extent() * OVERHANG, cover.min - bounds.min, bounds.max - cover.max);
    if !old.is_planar() {
        // As far as either mesh strays from the surface, in any direction: a plane may be tilted.
        let longest = |mesh: &Mesh| {
            mesh.triangles.iter().map(|&t| Point3::longest_side(mesh.positions_of(t))).fold(0.0, f64::max)
        };
        let most = ASIDE * longest(old).max(longest(new));
        allowed = Vector3::new(allowed.x.max(most), allowed.y.max(most), allowed.z.max(most));
    }
    if lower.x.max(upper.x) <= allowed.x && lower.y.max(upper.y) <= allowed.y && lower.z.max(upper.z) <= allowed.z {
        return Ok(());
    }
    let corner = |p: Point3| if old.is_planar() { Point::new(p.x, p.y).to_string() } else { p.to_string() };
    let what = format!("the new mesh ({} to {}) reaches beyond the old one", corner(bounds.min), corner(bounds.max));
    let place = format!("the old mesh ({} to {})", corner(cover.min), corner(cover.max));
    Err(Error::domain(what, place, "give two meshes of one domain, in the same coordinates"))
}

impl Shares {
    /// Whether the meshes are of one domain.
    pub(super) fn demand(&self, in_plane: bool) -> Result<()> {
        let most = if in_plane { OVERHANG } else { AREAS_ON_SURFACE };
        let found = [
            (self.uncovered, "of the new mesh's area are outside the old mesh"),
            (self.left, "of the old mesh's area are outside the new mesh"),
            (self.overlapped, "of the new mesh's area are covered more than once: the old mesh overlaps itself"),
        ];
        let Some((share, what)) = found.into_iter().find(|(share, _)| *share > most) else { return Ok(()) };
        let what = format!("{:.1} % {what}", 100.0 * share);
        let help = "give two valid meshes of one domain, or interpolate instead of conserving the integral";
        Err(Error::domain(what, "the two meshes", help))
    }
}
