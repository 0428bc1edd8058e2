//! The intersection of two metrics: the coarsest one that is nowhere coarser than either.

use super::{Eigen3, Tensor, Tensor3};

impl Tensor {
    /// The intersection of a metric with another tensor: of all tensors M with v' M v at least as large as that of both for
    /// every v, the one with the smallest determinant. Its unit disk is the largest ellipse about the origin inside both.
    ///
    /// By simultaneous reduction (Alauzet 2010): there is a basis in which both are diagonal, and there the larger
    /// of each pair of entries counts. It is commutative, and goes along with every linear change of coordinates; it is
    /// not associative: of three or more there is `Tensor::intersection_with_all`. `self` is positive definite; `other` need not be: where it says nothing, `self` counts. Where one
    /// is above the other everywhere, the answer is that one, bit for bit.
    #[must_use]
    pub(crate) fn intersection(self, other: Tensor) -> Tensor {
        // F' F = self: in the coordinates F v `self` is the identity.
        let [frame, inverse] = self.frames();
        let eigen = other.along(inverse).eigen();
        if eigen.large <= 1.0 {
            return self;
        }
        if eigen.small >= 1.0 {
            return other;
        }
        Tensor::from_axis(eigen.axis, eigen.large, 1.0).along(frame)
    }
}

impl Tensor3 {
    /// The same in space, of two metrics.
    #[must_use]
    pub(crate) fn intersection(self, other: Tensor3) -> Tensor3 {
        let Eigen3 { values, axes } = self.eigen();
        // In the coordinates S v, S S = self, `self` is the identity.
        let root = Tensor3::from_axes(axes, values.map(f64::sqrt));
        let inverse = Tensor3::from_axes(axes, values.map(|value| 1.0 / value.sqrt()));
        let eigen = other.along(inverse).eigen();
        if eigen.values[0] <= 1.0 {
            return self;
        }
        if eigen.values[2] >= 1.0 {
            return other;
        }
        Tensor3::from_axes(eigen.axes, eigen.values.map(|value| value.max(1.0))).along(root)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vector;
    use proptest::prelude::*;

    /// Anisotropies up to a hundred, sizes from a tenth to ten.
    fn metrics() -> impl Strategy<Value = Tensor> {
        (-2.0..2.0, -2.0..2.0, 0.0..std::f64::consts::PI).prop_map(|(large, small, angle): (f64, f64, f64)| {
            Tensor::from_axis(Vector::new(angle.cos(), angle.sin()), 10_f64.powf(large), 10_f64.powf(small))
        })
    }

    fn size(m: Tensor) -> f64 {
        m.xx + m.yy
    }

    fn difference(a: Tensor, b: Tensor) -> f64 {
        let d = a + b * -1.0;
        (d.xx.abs() + d.xy.abs() + d.yy.abs()) / size(a)
    }

    /// The smallest of (v' M v) / (v' N v) over all v: the smaller eigenvalue in coordinates in which N is the identity. (Directions
    /// that are tried one by one miss the one in which thin ellipses touch.)
    fn least_ratio(m: Tensor, n: Tensor) -> f64 {
        let [a, b, c] = n.cholesky();
        changed(m, [Vector::new(1.0 / a, 0.0), Vector::new(-b / (a * c), 1.0 / c)]).eigen().small
    }

    /// F' M F.
    fn changed(m: Tensor, [f, g]: [Vector; 2]) -> Tensor {
        Tensor::new(m.dot(f, f), m.dot(f, g), m.dot(g, g))
    }

    proptest! {
        #[test]
        fn it_is_below_neither(a in metrics(), b in metrics()) {
            let m = a.intersection(b);
            prop_assert!(m.is_positive_definite());
            prop_assert!(least_ratio(m, a) > 1.0 - 1e-9 && least_ratio(m, b) > 1.0 - 1e-9, "{m:?}");
        }

        #[test]
        fn the_order_does_not_matter(a in metrics(), b in metrics()) {
            prop_assert!(difference(a.intersection(b), b.intersection(a)) < 1e-9);
        }

        /// Everything else that is below neither has the larger determinant: every such tensor is the intersection plus
        /// something, or at least not below it.
        #[test]
        fn none_is_larger(a in metrics(), b in metrics(), other in metrics()) {
            let m = a.intersection(b);
            // The smallest multiple of the other that is below neither.
            let up = other * (1.0 / least_ratio(other, a).min(least_ratio(other, b)));
            prop_assert!(up.determinant() >= m.determinant() * (1.0 - 1e-8), "{m:?} {up:?}");
            // And what is a little less than the intersection in any direction is below one of both: the squares of the shares that
            // the two directions in which it touches have of any other one add up to one or more.
            let e = other.eigen().axis;
            let less = m + Tensor::from_axis(e, 1.0, 0.0) * (-1e-3 * m.dot(e, e));
            prop_assert!(least_ratio(less, a).min(least_ratio(less, b)) < 1.0 - 4e-4 || !less.is_positive_definite(), "{less:?}");
        }

        #[test]
        fn it_goes_along_with_changes_of_coordinates(a in metrics(), b in metrics(), x in -2.0..2.0, y in 0.5..2.0) {
            let basis = [Vector::new(1.0, x), Vector::new(-0.5 * x, y)];
            let (before, after) = (a.intersection(b), changed(a, basis).intersection(changed(b, basis)));
            prop_assert!(difference(changed(before, basis), after) < 1e-6, "{before:?} {after:?}");
        }

        #[test]
        fn the_larger_one_comes_back_to_the_bit(a in metrics(), b in metrics()) {
            let up = a + b;
            prop_assert_eq!(a.intersection(up), up);
            prop_assert_eq!(up.intersection(a), up);
            prop_assert!(difference(a.intersection(a), a) < 1e-12);
            let m = a.intersection(b);
            prop_assert!(difference(m.intersection(a), m) < 1e-9 && difference(m.intersection(b), m) < 1e-9);
        }
    }

    #[test]
    fn of_ellipses_with_common_axes_the_smaller_sizes_count() {
        let m = Tensor::new(4.0, 0.0, 1.0).intersection(Tensor::new(1.0, 0.0, 9.0));
        assert!(difference(m, Tensor::new(4.0, 0.0, 9.0)) < 1e-15, "{m:?}");
    }

    #[test]
    fn what_says_nothing_in_a_direction_changes_nothing_there() {
        let axis = Vector::new(0.6, 0.8);
        let m = Tensor::new(2.0, 0.0, 2.0).intersection(Tensor::from_axis(axis, 8.0, 0.0));
        assert!(difference(m, Tensor::from_axis(axis, 8.0, 2.0)) < 1e-15, "{m:?}");
        assert_eq!(Tensor::IDENTITY.intersection(Tensor::default()), Tensor::IDENTITY);
    }
}
