//! Symmetric 3 x 3 tensors: the metric M of space, of which a surface sees what lies in its tangent planes.

use super::linear::linear;
use super::{Point, Point3, Tensor, Vector, Vector3};
use crate::elementary::Elementary;

/// The symmetric matrix ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)); a metric when positive definite.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tensor3 {
    /// First diagonal entry.
    pub xx: f64,
    /// First and second coordinate.
    pub xy: f64,
    /// Second diagonal entry.
    pub yy: f64,
    /// First and third coordinate.
    pub xz: f64,
    /// Second and third coordinate.
    pub yz: f64,
    /// Third diagonal entry.
    pub zz: f64,
}

/// Eigenvalues in descending order, and unit eigenvectors in the same order, perpendicular to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Eigen3 {
    /// From the largest down.
    pub values: [f64; 3],
    /// One of each value.
    pub axes: [Vector3; 3],
}

/// An orthonormal frame of a tangent plane: (u, v, normal) is right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentPlane {
    /// First axis of the plane.
    pub u: Vector3,
    /// Second axis of the plane.
    pub v: Vector3,
    /// Perpendicular to the plane.
    pub normal: Vector3,
}

linear!(Tensor3: xx, xy, yy, xz, yz, zz);

impl Tensor3 {
    /// The identity: Euclidean length.
    pub(crate) const IDENTITY: Tensor3 = Tensor3::from_disk([1.0, 0.0, 1.0, 0.0, 0.0, 1.0]);

    /// The tensor with entries m11 m12 m22 m13 m23 m33: the order of Medit's `.sol` files.
    pub const fn from_disk([xx, xy, yy, xz, yz, zz]: [f64; 6]) -> Self {
        Self { xx, xy, yy, xz, yz, zz }
    }

    /// m11 m12 m22 m13 m23 m33: the order of Medit's `.sol` files.
    pub const fn to_disk(self) -> [f64; 6] {
        [self.xx, self.xy, self.yy, self.xz, self.yz, self.zz]
    }

    /// The tensor that asks for Euclidean size `h` in every direction: identity / h^2.
    pub(crate) fn isotropic(h: f64) -> Self {
        Self::IDENTITY * (1.0 / (h * h))
    }

    /// v v'.
    pub(crate) fn square(v: Vector3) -> Self {
        Self::from_disk([v.x * v.x, v.x * v.y, v.y * v.y, v.x * v.z, v.y * v.z, v.z * v.z])
    }

    /// u v' + v u'.
    pub(crate) fn symmetric_product(u: Vector3, v: Vector3) -> Self {
        let (xy, xz, yz) = (u.x * v.y + u.y * v.x, u.x * v.z + u.z * v.x, u.y * v.z + u.z * v.y);
        Self::from_disk([2.0 * u.x * v.x, xy, 2.0 * u.y * v.y, xz, yz, 2.0 * u.z * v.z])
    }

    /// The tensor with these eigenvalues along these axes, which are perpendicular units.
    pub(crate) fn from_axes(axes: [Vector3; 3], values: [f64; 3]) -> Self {
        axes.into_iter().zip(values).fold(Self::default(), |sum, (axis, value)| sum + Self::square(axis) * value)
    }

    /// The sum of three, weighted.
    pub(crate) fn weighted(tensors: [Self; 3], weights: [f64; 3]) -> Self {
        tensors.into_iter().zip(weights).fold(Self::default(), |sum, (tensor, weight)| sum + tensor * weight)
    }

    /// F M F.
    pub(super) fn along(self, frame: Self) -> Self {
        let columns = [
            Vector3::new(frame.xx, frame.xy, frame.xz),
            Vector3::new(frame.xy, frame.yy, frame.yz),
            Vector3::new(frame.xz, frame.yz, frame.zz),
        ];
        let entry = |i: usize, j: usize| self.dot(columns[i], columns[j]);
        Self::from_disk([entry(0, 0), entry(0, 1), entry(1, 1), entry(0, 2), entry(1, 2), entry(2, 2)])
    }

    /// M v.
    pub(crate) fn apply(self, v: Vector3) -> Vector3 {
        Vector3::new(
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }

    /// u' M v.
    pub(crate) fn dot(self, u: Vector3, v: Vector3) -> f64 {
        u.dot(self.apply(v))
    }

    /// Metric area of the parallelogram of two vectors.
    pub(crate) fn area(self, u: Vector3, v: Vector3) -> f64 {
        let mixed = self.dot(u, v);
        (self.dot(u, u) * self.dot(v, v) - mixed * mixed).max(0.0).sqrt()
    }

    /// Quality of a triangle in this metric: 1 of an equilateral one, 0 without area.
    pub(crate) fn shape(self, [a, b, c]: [Point3; 3]) -> f64 {
        let (u, v) = (b - a, c - a);
        3.0_f64.sqrt() * self.area(u, v) / (self.dot(u, u) + self.dot(v, v) - self.dot(u, v))
    }

    /// Metric length of a vector: sqrt(v' M v).
    pub(crate) fn length(self, v: Vector3) -> f64 {
        self.dot(v, v).max(0.0).sqrt()
    }

    /// Determinant; it cancels where eigenvalues differ by more than about 1e8.
    pub(crate) fn determinant(self) -> f64 {
        let minor = Tensor::new(self.yy, self.yz, self.zz).determinant();
        let second = self.xy * self.zz - self.yz * self.xz;
        let third = self.xy * self.yz - self.yy * self.xz;
        self.xx * minor - self.xy * second + self.xz * third
    }

    /// Whether all entries are finite.
    pub(crate) fn is_finite(self) -> bool {
        self.to_disk().iter().all(|entry| entry.is_finite())
    }

    /// Whether all entries are finite and all eigenvalues positive (Cholesky's pivots are).
    pub fn is_positive_definite(self) -> bool {
        if !self.is_finite() || self.xx <= 0.0 {
            return false;
        }
        let (y, z) = (self.xy / self.xx, self.xz / self.xx);
        let rest = Tensor::new(self.yy - y * self.xy, self.yz - y * self.xz, self.zz - z * self.xz);
        rest.is_positive_definite()
    }

    /// Eigenvalues and axes by Jacobi's rotations (Golub and Van Loan 2013, section 8.5): any symmetric tensor with
    /// finite entries, each eigenvalue to about 1e-16 of the largest.
    pub(crate) fn eigen(self) -> Eigen3 {
        let mut m = [[self.xx, self.xy, self.xz], [self.xy, self.yy, self.yz], [self.xz, self.yz, self.zz]];
        let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for _ in 0..SWEEPS {
            if m[0][1] == 0.0 && m[0][2] == 0.0 && m[1][2] == 0.0 {
                break;
            }
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                rotate(&mut m, &mut axes, p, q);
            }
        }
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| m[j][j].total_cmp(&m[i][i]));
        let axis = |i: usize| Vector3::new(axes[0][i], axes[1][i], axes[2][i]);
        Eigen3 { values: order.map(|i| m[i][i]), axes: order.map(axis) }
    }

    /// The symmetric tensor with the same axes and each eigenvalue mapped by `f`.
    #[must_use]
    pub(crate) fn map_eigenvalues(self, f: impl Fn(f64) -> f64) -> Tensor3 {
        let Eigen3 { values, axes } = self.eigen();
        Tensor3::from_axes(axes, values.map(f))
    }

    /// Matrix logarithm of a positive definite tensor.
    #[must_use]
    pub(crate) fn log(self) -> Tensor3 {
        self.map_eigenvalues(Elementary::logarithm)
    }

    /// Matrix exponential of a symmetric tensor; positive definite. By Taylor's series and squaring (Moler and Van Loan 2003), of the
    /// coefficients of I, S and S^2 alone: metric fields on surfaces live by it.
    #[must_use]
    pub(crate) fn exp(self) -> Tensor3 {
        let mean = (self.xx + self.yy + self.zz) / 3.0;
        let deviation = self + Tensor3::IDENTITY * -mean;
        let square = deviation.squared();
        // Without a trace S^3 = q S + d I (Cayley and Hamilton), and no eigenvalue has a square above 4 q / 3.
        let q = 0.5 * (square.xx + square.yy + square.zz);
        let halvings = halvings(q * (4.0 / 3.0) / (SMALL * SMALL));
        if halvings > MOST_HALVINGS {
            return self.map_eigenvalues(Elementary::exponential);
        }
        let share = 1.0 / f64::from(1_u32 << halvings);
        let (q, d) = (q * share * share, deviation.determinant() * share * share * share);
        let series = [1.0 + d * power_sum(&POWERS[3], q, d), power_sum(&POWERS[1], q, d), power_sum(&POWERS[2], q, d)];
        let twice = |[a, b, c]: [f64; 3]| {
            let (cubes, fourths) = (2.0 * b * c, c * c);
            [a * a + cubes * d, 2.0 * a * b + cubes * q + fourths * d, 2.0 * a * c + b * b + fourths * q]
        };
        let [a, b, c] = (0..halvings).fold(series, |root, _| twice(root));
        (Tensor3::IDENTITY * a + deviation * (b * share) + square * (c * share * share)) * mean.exponential()
    }

    /// The product with itself.
    fn squared(self) -> Tensor3 {
        let Tensor3 { xx, xy, yy, xz, yz, zz } = self;
        Tensor3 {
            xx: xx * xx + xy * xy + xz * xz,
            xy: xy * (xx + yy) + xz * yz,
            yy: xy * xy + yy * yy + yz * yz,
            xz: xz * (xx + zz) + xy * yz,
            yz: yz * (yy + zz) + xy * xz,
            zz: xz * xz + yz * yz + zz * zz,
        }
    }
}

impl TangentPlane {
    /// The plane of x and y.
    pub(crate) const FLAT: Self =
        Self { u: Vector3::new(1.0, 0.0, 0.0), v: Vector3::new(0.0, 1.0, 0.0), normal: Vector3::new(0.0, 0.0, 1.0) };

    /// The plane perpendicular to a unit vector, with axes that depend on nothing else.
    pub fn new(normal: Vector3) -> Self {
        let u = normal.perpendicular();
        Self { u, v: normal.cross(u), normal }
    }

    /// This plane with its axes after the smallest rotation that takes its normal to another (Rodrigues); not the opposite one.
    #[must_use]
    pub(crate) fn turned(&self, normal: Vector3) -> Self {
        let sum = self.normal + normal;
        let turn = |v: Vector3| v - sum * (v.dot(sum) / (1.0 + self.normal.dot(normal)));
        Self { u: turn(self.u), v: turn(self.v), normal }
    }

    /// What a tensor says of vectors in the plane, in the plane's coordinates: B' M B with B = (u, v).
    pub fn restrict(&self, m: Tensor3) -> Tensor {
        let (mu, mv) = (m.apply(self.u), m.apply(self.v));
        Tensor::new(self.u.dot(mu), self.u.dot(mv), self.v.dot(mv))
    }

    /// The tensor of space that is `m` in the plane and has the eigenvalue `along_normal` across it.
    pub(crate) fn extend(&self, m: Tensor, along_normal: f64) -> Tensor3 {
        Tensor3::square(self.u) * m.xx
            + Tensor3::symmetric_product(self.u, self.v) * m.xy
            + Tensor3::square(self.v) * m.yy
            + Tensor3::square(self.normal) * along_normal
    }

    /// A vector's part in the plane, in the plane's coordinates.
    pub(crate) fn flatten(&self, v: Vector3) -> Vector {
        Vector::new(v.dot(self.u), v.dot(self.v))
    }

    /// The vector of space with these coordinates in the plane.
    pub(crate) fn lift(&self, v: Vector) -> Vector3 {
        self.u * v.x + self.v * v.y
    }
}

/// Taylor's series, to the power 12, is taken of tensors with eigenvalues no larger than this: what is left out is 2e-16.
const SMALL: f64 = 0.35;
/// Exponents (but for their mean) that take more halvings than this, those above 350, are left to eigenvalues.
const MOST_HALVINGS: u32 = 10;

/// Of S with S^3 = q S + d I, powers of q in rows by powers of d: exp(S) = (1 + d E(3)) I + E(1) S + E(2) S^2, where E(s) is the sum of
/// (i + j over i) q^i d^j / (2 i + 3 j + s)!, as by induction the coefficient of S^2 in S^k is that of (i + j over i) q^i d^j over all 2 i + 3 j = k - 2.
const POWERS: [[[f64; 6]; 4]; 4] = {
    let mut powers = [[[0.0; 6]; 4]; 4];
    let mut s = 1;
    while s < 4 {
        let mut j = 0;
        while j < 4 {
            let mut i = 0;
            while i < 6 && 2 * i + 3 * j <= 10 {
                let mut term = 1.0;
                let mut k = 1;
                while k <= 2 * i + 3 * j + s {
                    term /= k as f64;
                    k += 1;
                }
                let mut k = 1;
                while k <= i {
                    term = term * (j + k) as f64 / k as f64;
                    k += 1;
                }
                powers[s][j][i] = term;
                i += 1;
            }
            j += 1;
        }
        s += 1;
    }
    powers
};

/// A row of [`POWERS`] summed.
fn power_sum(rows: &[[f64; 6]; 4], q: f64, d: f64) -> f64 {
    let row = |j: usize| {
        let [a, b, c, e, f, g] = rows[j];
        match j {
            0 => ((((g * q + f) * q + e) * q + c) * q + b) * q + a,
            1 => ((e * q + c) * q + b) * q + a,
            2 => (c * q + b) * q + a,
            _ => a,
        }
    };
    ((row(3) * d + row(2)) * d + row(1)) * d + row(0)
}

/// How often the root of a square is halved until it is at most one, or once more; very often if it is not finite.
fn halvings(square: f64) -> u32 {
    // A square below 2^e has a root below 2^(e / 2).
    let exponent = (square.to_bits() >> 52) as u32;
    (exponent.saturating_sub(1022)).div_ceil(2)
}

/// Sweeps of Jacobi's method; it converges quadratically, five or six are the rule.
const SWEEPS: usize = 30;

/// The rotation that makes the entry (p, q) zero.
fn rotate(m: &mut [[f64; 3]; 3], axes: &mut [[f64; 3]; 3], p: usize, q: usize) {
    let off = m[p][q];
    // Too small to change either diagonal entry: rotating on would never end.
    if off.abs() <= f64::EPSILON * f64::EPSILON * (m[p][p].abs() + m[q][q].abs()) {
        (m[p][q], m[q][p]) = (0.0, 0.0);
        return;
    }
    let theta = 0.5 * (m[q][q] / off - m[p][p] / off);
    let t = 1.0_f64.copysign(theta) / (theta.abs() + theta.hypotenuse(1.0));
    let cos = 1.0 / (t * t + 1.0).sqrt();
    let sin = t * cos;
    m[p][p] -= t * off;
    m[q][q] += t * off;
    (m[p][q], m[q][p]) = (0.0, 0.0);
    let r = 3 - p - q;
    let (mrp, mrq) = (m[r][p], m[r][q]);
    m[r][p] = cos * mrp - sin * mrq;
    m[r][q] = sin * mrp + cos * mrq;
    (m[p][r], m[q][r]) = (m[r][p], m[r][q]);
    for row in axes {
        (row[p], row[q]) = (cos * row[p] - sin * row[q], sin * row[p] + cos * row[q]);
    }
}

/// A tensor of space, and the normal of the surface there.
#[derive(Clone, Copy)]
pub(crate) struct Seen {
    pub(crate) tensor: Tensor3,
    pub(crate) normal: Vector3,
}

impl Seen {
    /// What the tensor says of tangents, in the coordinates of another plane, to which the smallest rotation takes them.
    pub(crate) fn in_plane(&self, plane: &TangentPlane) -> Tensor {
        // Tangent planes have no side.
        let normal = if self.normal.dot(plane.normal) < 0.0 { -self.normal } else { self.normal };
        plane.turned(normal).restrict(self.tensor)
    }

    /// A triangle in its plane, and the log-Euclidean mean there of what its corners see; nothing of one without area.
    pub(crate) fn flattened([a, b, c]: [Point3; 3], corners: [Seen; 3]) -> Option<(Tensor, [Point; 3])> {
        let plane = TangentPlane::new((b - a).cross(c - a).unit()?);
        let [l, m, n] = corners.map(|seen| seen.in_plane(&plane).log());
        let flat = |p: Point3| {
            let Vector { x, y } = plane.flatten(p - a);
            Point::new(x, y)
        };
        Some((((l + m + n) * (1.0 / 3.0)).exp(), [a, b, c].map(flat)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn largest_difference(a: Tensor3, b: Tensor3) -> f64 {
        (a + b * -1.0).to_disk().into_iter().fold(0.0, |most: f64, entry| most.max(entry.abs()))
    }

    fn vectors() -> impl Strategy<Value = Vector3> {
        (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(|(x, y, z)| Vector3::new(x, y, z))
    }

    /// Right-handed orthonormal frames.
    fn frames() -> impl Strategy<Value = [Vector3; 3]> {
        (vectors(), vectors()).prop_filter_map("two independent vectors", |(a, b)| {
            let first = a.unit().filter(|_| a.norm() > 0.1)?;
            let second = first.cross(b);
            let second = second.unit().filter(|_| second.norm() > 0.1)?;
            Some([first, second, first.cross(second)])
        })
    }

    fn symmetric() -> impl Strategy<Value = Tensor3> {
        prop::array::uniform6(-5.0..5.0).prop_map(Tensor3::from_disk)
    }

    proptest! {
        #[test]
        fn eigenvalues_and_axes_make_up_the_tensor(m in symmetric()) {
            let e = m.eigen();
            prop_assert!(e.values[0] >= e.values[1] && e.values[1] >= e.values[2]);
            for i in 0..3 {
                prop_assert!((m.apply(e.axes[i]) - e.axes[i] * e.values[i]).norm() < 1e-14 * 30.0);
                prop_assert!((e.axes[i].dot(e.axes[i]) - 1.0).abs() < 1e-14);
                prop_assert!(e.axes[i].dot(e.axes[(i + 1) % 3]).abs() < 1e-14);
            }
            prop_assert!((m.determinant() - e.values.iter().product::<f64>()).abs() < 1e-11);
            let positive = e.values[2] > 1e-12;
            prop_assert!(e.values[2].abs() < 1e-12 || m.is_positive_definite() == positive);
        }

        #[test]
        fn exp_is_that_of_the_eigenvalues(axes in frames(), a in -20.0..20.0, b in -20.0..20.0, c in -20.0..20.0) {
            let (truth, found) = (Tensor3::from_axes(axes, [a, b, c].map(f64::exp)), Tensor3::from_axes(axes, [a, b, c]).exp());
            let size = [a, b, c].into_iter().fold(a, f64::max).exp();
            prop_assert!(largest_difference(found, truth) < 1e-12 * size, "{found:?} {truth:?}");
        }

        #[test]
        fn exp_undoes_log(axes in frames(), a in -8.0..8.0, b in -8.0..8.0, c in -8.0..8.0) {
            let logarithm = Tensor3::from_axes(axes, [a, b, c]);
            prop_assert!(largest_difference(logarithm.exp().log(), logarithm) < 1e-8, "{:?}", logarithm);
            prop_assert!(logarithm.exp().is_positive_definite());
        }

        #[test]
        fn lengths_are_those_of_the_axes(axes in frames(), v in vectors(), a in 0.1..10.0, b in 0.1..10.0, c in 0.1..10.0) {
            let m = Tensor3::from_axes(axes, [a, b, c]);
            let truth = axes.iter().zip([a, b, c]).map(|(axis, value)| value * axis.dot(v).powi(2)).sum::<f64>().sqrt();
            prop_assert!((m.length(v) - truth).abs() < 1e-13);
        }

        #[test]
        fn tangent_planes_keep_tangential_lengths(axes in frames(), m in symmetric(), x in -1.0..1.0, y in -1.0..1.0) {
            let plane = TangentPlane::new(axes[0]);
            let flat = Vector::new(x, y);
            let v = plane.lift(flat);
            prop_assert!((plane.flatten(v) - flat).norm() < 1e-15);
            prop_assert!((plane.restrict(m).dot(flat, flat) - m.dot(v, v)).abs() < 1e-13);
            let extended = plane.extend(plane.restrict(m), 3.0);
            prop_assert!((extended.dot(v, v) - m.dot(v, v)).abs() < 1e-13);
            prop_assert!((extended.apply(plane.normal) - plane.normal * 3.0).norm() < 1e-13);
        }
    }

    #[test]
    fn what_is_no_metric_is_told() {
        for entries in [
            [1.0, 0.0, 1.0, 0.0, 0.0, 0.0],
            [1.0, 0.0, 1.0, 0.0, 1.0, 1.0],
            [-1.0, 0.0, -1.0, 0.0, 0.0, 1.0],
            [1.0, 0.0, 1.0, 0.0, 2.0, 1.0],
            [1.0, f64::NAN, 1.0, 0.0, 0.0, 1.0],
            [f64::INFINITY, 0.0, 1.0, 0.0, 0.0, 1.0],
        ] {
            assert!(!Tensor3::from_disk(entries).is_positive_definite(), "{entries:?}");
        }
        assert!(Tensor3::from_disk([1e12, 0.0, 1.0, 0.0, 0.0, 1e-12]).is_positive_definite());
    }

    #[test]
    fn multiples_of_the_identity_are_their_own_frame() {
        let e = Tensor3::isotropic(0.5).eigen();
        assert_eq!(e.values.map(f64::to_bits), [4.0_f64; 3].map(f64::to_bits));
    }

    #[test]
    fn the_smallest_rotation_takes_one_plane_to_another() {
        let unit = |x, y, z| Vector3::new(x, y, z).unit().unwrap();
        let (from, to) = (TangentPlane::new(unit(1.0, 2.0, 2.0)), unit(-2.0, 1.0, 3.0));
        let turned = from.turned(to);
        for (axis, other) in [(turned.u, turned.v), (turned.v, turned.normal), (turned.normal, turned.u)] {
            assert!((axis.norm() - 1.0).abs() < 1e-15 && axis.dot(other).abs() < 1e-15);
        }
        // The axis of the rotation stays.
        let axis = from.normal.cross(to);
        assert!((turned.lift(from.flatten(axis)) - axis).norm() < 1e-15);
    }
}
