//! How large a surface is in a metric.

use super::{SurfaceMetric, check_tensor3};
use crate::error::Result;
use crate::geometry::{Point3, Tensor3};
use crate::manifold::{Manifold, Place};
use crate::parallel::prelude::*;
use crate::triangulation::FaceId;

/// Pieces that are enough, as a share of those asked for.
const ENOUGH: f64 = 0.7;
/// Times that pieces get smaller, at most: to half of their size; and halvings of one triangle, which leave nothing of it that counts.
const PASSES: usize = 64;
const HALVINGS: u32 = 64;

/// The metric area of a surface, the integral of sqrt(det M) over it: by the trapezoidal rule on about twice so many triangles as there
/// are to be vertices, even in the metric, or on the surface's own where these are more.
///
/// The surface's triangles are halved at their longest edges, each by itself; on an equation's surface new corners are moved onto f = 0.
///
/// # Errors
/// [`Error::Metric`](crate::Error::Metric) where the metric is not positive definite at a corner.
pub(crate) fn area_of_surface(manifold: &Manifold, metric: &dyn SurfaceMetric, vertices: usize) -> Result<f64> {
    let (ground, wanted) = (Ground { manifold, metric }, 2 * vertices);
    let faces: Vec<FaceId> = manifold.topology().faces().collect();
    let pieces: Result<Vec<Piece>> = faces.into_par_iter().with_min_len(64).map(|face| ground.piece(face)).collect();
    let pieces = pieces?;
    let mut limit = pieces.iter().map(Piece::first_edge).fold(0.0, f64::max);
    let mut found = Measured { count: pieces.len(), area: pieces.iter().map(Piece::area).sum() };
    for _ in 0..PASSES {
        let share = found.count as f64 / wanted as f64;
        if share >= ENOUGH {
            break;
        }
        // Four times as many are half as long; in a quarter of a pass more may come to light than was seen before.
        limit *= share.sqrt().max(0.5);
        let each = pieces.par_iter().with_min_len(16).map(|piece| {
            let mut inside = Measured::default();
            ground.measure(piece, limit, (wanted, HALVINGS), &mut inside).map(|()| inside)
        });
        let each: Vec<Measured> = each.collect::<Result<_>>()?;
        found = each.iter().fold(Measured::default(), |sum, inside| Measured {
            count: sum.count + inside.count,
            area: sum.area + inside.area,
        });
    }
    Ok(found.area)
}

/// Pieces, and their area.
#[derive(Clone, Copy, Default)]
struct Measured {
    count: usize,
    area: f64,
}

struct Ground<'a> {
    manifold: &'a Manifold,
    metric: &'a dyn SurfaceMetric,
}

/// A corner of a piece, in the triangle of the surface that the piece is of.
#[derive(Clone, Copy)]
struct Corner {
    weights: [f64; 3],
    position: Point3,
    tensor: Tensor3,
}

/// A part of a triangle of the surface. Its longest edge, in the mean of its tensors, is that from the first corner to the second.
///
/// By the tensors at its own ends alone an edge across a layer would never be the longest, and pieces on it be halved without end.
#[derive(Clone, Copy)]
struct Piece {
    face: FaceId,
    corners: [Corner; 3],
}

impl Piece {
    fn new(face: FaceId, corners: &[Corner; 3]) -> Self {
        let turned = |first: usize| Self { face, corners: [0, 1, 2].map(|k| corners[(first + k) % 3]) };
        let [a, b, c] = [0, 1, 2].map(turned);
        [b, c].into_iter().fold(a, |best, other| if other.first_edge() > best.first_edge() { other } else { best })
    }

    fn first_edge(&self) -> f64 {
        let [p, q, r] = self.corners;
        ((p.tensor + q.tensor + r.tensor) * (1.0 / 3.0)).length(q.position - p.position)
    }

    fn area(&self) -> f64 {
        let [a, b, c] = self.corners.map(|corner| corner.position);
        let at = |corner: &Corner| 0.5 * corner.tensor.area(b - a, c - a);
        self.corners.iter().map(at).sum::<f64>() / 3.0
    }
}

impl Ground<'_> {
    fn piece(&self, face: FaceId) -> Result<Piece> {
        let [a, b, c] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
            .map(|weights| self.corner(face, weights, Point3::weighted(self.manifold.triangle(face), weights)));
        Ok(Piece::new(face, &[a?, b?, c?]))
    }

    fn corner(&self, face: FaceId, weights: [f64; 3], near: Point3) -> Result<Corner> {
        let mut place = Place { position: near, ..self.manifold.place(face, weights) };
        if self.manifold.equation().is_some() {
            // Where f = 0 is not found the triangle is as good.
            place = self.manifold.lift(&place, near).unwrap_or(place);
        }
        let tensor = self.metric.at(&place);
        check_tensor3(tensor, || place.position.to_string())?;
        Ok(Corner { weights, position: place.position, tensor })
    }

    /// Adds a piece to what was measured, by halves where it is longer than a limit, as long as there are not so many and it was not halved so often.
    fn measure(&self, piece: &Piece, limit: f64, (most, left): (usize, u32), found: &mut Measured) -> Result<()> {
        if piece.first_edge() <= limit || found.count >= most || left == 0 {
            *found = Measured { count: found.count + 1, area: found.area + piece.area() };
            return Ok(());
        }
        let Piece { face, corners: [a, b, c] } = *piece;
        let weights = [0, 1, 2].map(|k| 0.5 * (a.weights[k] + b.weights[k]));
        let middle = self.corner(face, weights, a.position.lerp(b.position, 0.5))?;
        self.measure(&Piece::new(face, &[a, middle, c]), limit, (most, left - 1), found)?;
        self.measure(&Piece::new(face, &[middle, b, c]), limit, (most, left - 1), found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::manifold::surface::metric::Constant;

    #[test]
    fn areas_are_those_of_closed_forms() {
        let sphere = Manifold::shape("sphere:1", None).unwrap();
        let area = |metric: &dyn SurfaceMetric| area_of_surface(&sphere, metric, 20_000).unwrap();
        let exact = 4.0 * std::f64::consts::PI;
        assert!((area(&Constant(Tensor3::IDENTITY * 9.0)) / (9.0 * exact) - 1.0).abs() < 1e-3);
        // The integral of exp(a z) over the sphere is its area times sinh(a) / a.
        let steep = |p: Point3| Tensor3::IDENTITY * (6.0 * p.z).exp();
        assert!((area(&steep) / (exact * 6.0_f64.sinh() / 6.0) - 1.0).abs() < 2e-3);
    }

    #[test]
    fn a_layer_inside_large_triangles_is_found() {
        let cube =
            Manifold::new(crate::manifold::surface::Surface::new(&crate::test_cases::cube(1, 0.0)).unwrap(), None);
        let along_x = |x: f64| 1.0 + 400.0 * (-(x - 0.3).powi(2) / 0.005).exp();
        let layer = |p: Point3| Tensor3::from_disk([along_x(p.x), 0.0, 1.0, 0.0, 0.0, 1.0]);
        // Two sides do not see x, four do.
        let steps = 10_000;
        let across: f64 = (0..steps).map(|i| along_x((f64::from(i) + 0.5) / f64::from(steps)).sqrt()).sum();
        let exact = 2.0 + 4.0 * across / f64::from(steps);
        let off = |vertices: usize| (area_of_surface(&cube, &layer, vertices).unwrap() / exact - 1.0).abs();
        assert!(off(20_000) < 3e-3 && off(160_000) < 6e-4, "{} {}", off(20_000), off(160_000));
    }
}
