//! Higher derivatives of a function at a point, and the metric that bounds them.

use crate::elementary::Elementary;
use crate::geometry::{Tensor, Vector};

/// Directions looked at for the greatest value: from the best of them Newton's steps lead to it.
const DIRECTIONS: i32 = 16;
const STEPS: usize = 5;
/// Directions on each side in which the bound is made to hold.
const BOUNDED: i32 = 12;

/// A homogeneous polynomial of degree 3 or 4: the sum of c[i] x^(k - i) y^i.
#[derive(Clone, Copy, Debug)]
pub(super) struct Form {
    degree: usize,
    coefficients: [f64; 5],
}

impl Form {
    /// Of degree 3 or 4, from its values: derivatives of that order along vectors.
    pub(super) fn of_values(degree: usize, at: impl Fn(Vector) -> f64) -> Self {
        let [first, last, plus, minus] =
            [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, -1.0)].map(|(x, y)| at(Vector::new(x, y)));
        let (even, odd) = (0.5 * (plus + minus), 0.5 * (plus - minus));
        if degree == 3 {
            return Self { degree, coefficients: [first, odd - last, even - first, last, 0.0] };
        }
        let middle = even - first - last;
        // c[1] + 4 c[3] and their sum.
        let rest = 0.5 * (at(Vector::new(1.0, 2.0)) - first - 4.0 * middle - 16.0 * last);
        let third = (rest - odd) / 3.0;
        Self { degree, coefficients: [first, odd - third, middle, third, last] }
    }

    fn value(&self, v: Vector) -> f64 {
        // Horner's rule in both at once.
        let mut power = 1.0;
        let mut sum = 0.0;
        for c in &self.coefficients[..=self.degree] {
            sum = sum * v.x + c * power;
            power *= v.y;
        }
        sum
    }

    /// In coordinates along a unit vector and across it.
    fn along(&self, e: Vector) -> Self {
        let mut sum = [0.0; 5];
        for (i, c) in self.coefficients[..=self.degree].iter().enumerate() {
            // (x e.x - y e.y)^(k - i) (x e.y + y e.x)^i.
            let mut product = [*c, 0.0, 0.0, 0.0, 0.0];
            for factor in 0..self.degree {
                let [a, b] = if factor < self.degree - i { [e.x, -e.y] } else { [e.y, e.x] };
                for j in (0..=factor + 1).rev() {
                    product[j] = a * product[j] + if j > 0 { b * product[j - 1] } else { 0.0 };
                }
            }
            sum.iter_mut().zip(product).for_each(|(s, p)| *s += p);
        }
        Self { degree: self.degree, coefficients: sum }
    }

    /// The unit vector along which the absolute value is greatest.
    fn greatest_along(&self) -> Vector {
        let at = |i: i32| {
            let half = (2.0 * f64::from(i) + 1.0) / f64::from(DIRECTIONS) - 1.0;
            Vector::new(1.0 - half * half, 2.0 * half) * (1.0 / (1.0 + half * half))
        };
        let all = (0..DIRECTIONS).map(|i| (self.value(at(i)).abs(), at(i)));
        let (_, mut e) = all.fold((-1.0, Vector::default()), |best, next| if next.0 > best.0 { next } else { best });
        for _ in 0..STEPS {
            let [here, first, second, ..] = self.along(e).coefficients;
            let curvature = 2.0 * second - self.degree as f64 * here;
            if curvature * here >= 0.0 || first.abs() <= f64::EPSILON * here.abs() {
                break;
            }
            let to = e + Vector::new(-e.y, e.x) * (-first / curvature);
            e = to * (1.0 / to.norm());
        }
        e
    }

    /// The greatest of |C(v)|^(2/k) over unit vectors: the greater eigenvalue of [`Form::bounding`].
    pub(super) fn size(&self) -> f64 {
        self.root(self.value(self.greatest_along()))
    }

    fn root(&self, value: f64) -> f64 {
        if self.degree == 3 { (value * value).cube_root() } else { value.abs().sqrt() }
    }

    /// A tensor Q with |C(v)| <= (v'Qv)^(k/2) for all v, no eigenvalue less than a floor: by the direction in which C is greatest, and across it as little
    /// as will do. Which tensor has the least determinant of all is known (Mirebeau 2010); this one is near it, and turns with the form.
    pub(super) fn bounding(&self, floor: f64) -> Tensor {
        let e = self.greatest_along();
        let seen = self.along(e);
        let c = seen.coefficients;
        let most = self.root(c[0]).max(floor);
        let across = self.root(c[self.degree]);
        let mut least = across.max(floor);
        // Where terms reach the first one: between directions that are scaled so nothing is narrow.
        let [second, third, fourth] = [2, 3, 4].map(|i| (c[i] / c[0]).abs());
        let unit = second.max((third * third).cube_root()).max(fourth.sqrt());
        if c[0] != 0.0 && unit > 0.0 {
            let scale = 1.0 / unit.sqrt();
            for j in -BOUNDED..BOUNDED {
                let share = (f64::from(j) + 0.5) / f64::from(BOUNDED);
                let s = scale * share / (1.0 - share.abs());
                let value = seen.value(Vector::new(1.0, s));
                let bound = most + least * s * s;
                if value * value > if self.degree == 3 { bound.powi(3) } else { bound.powi(4) } {
                    least = (self.root(value) - most) / (s * s);
                }
            }
        }
        Tensor::from_axis(e, most, least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    fn form(degree: usize, coefficients: [f64; 5]) -> Form {
        Form { degree, coefficients }
    }

    fn around(count: u32) -> impl Iterator<Item = Vector> {
        (0..count).map(move |i| PI * f64::from(i) / f64::from(count)).map(|a| Vector::new(a.cos(), a.sin()))
    }

    #[test]
    fn known_forms_have_known_bounds() {
        // The real part of z^3, and of z^4: one everywhere on a circle that is met by the unit circle alone.
        for (degree, coefficients) in [(3, [1.0, 0.0, -3.0, 0.0, 0.0]), (4, [1.0, 0.0, -6.0, 0.0, 1.0])] {
            let q = form(degree, coefficients).bounding(1e-9);
            assert!((q.xx - 1.0).abs() + (q.yy - 1.0).abs() + q.xy.abs() < 0.06, "{q:?}");
        }
        // 8 x^3 + y^3.
        let q = form(3, [8.0, 0.0, 0.0, 1.0, 0.0]).bounding(1e-9);
        assert!((q.xx - 4.0).abs() + (q.yy - 1.0).abs() + q.xy.abs() < 1e-9, "{q:?}");
        // Nothing along y: the floor.
        let q = form(3, [8.0, 0.0, 0.0, 0.0, 0.0]).bounding(0.25);
        assert!((q.xx - 4.0).abs() + (q.yy - 0.25).abs() + q.xy.abs() < 1e-9, "{q:?}");
        assert_eq!(form(4, [0.0; 5]).bounding(0.5), Tensor::IDENTITY * 0.5);
    }

    proptest! {
        #[test]
        fn bounds_hold_and_are_no_larger_than_they_must(
            degree in 3_usize..=4, c in prop::array::uniform5(-1.0_f64..1.0), squeeze in 0.0_f64..3.0, turn in 0.0_f64..PI,
        ) {
            prop_assume!(c[0].abs() > 0.05);
            let thin = 10.0_f64.powf(squeeze);
            let squeezed = form(degree, std::array::from_fn(|i| c[i] * thin.powf(-(i as f64))));
            let found = squeezed.along(Vector::new(turn.cos(), turn.sin()));
            let q = found.bounding(0.0);
            let share = |v: Vector| found.root(found.value(v)) / q.dot(v, v);
            // Looked at in the frame in which the bound is the unit circle.
            let [_, axes] = q.frames();
            let most = around(720).map(|v| share(axes[0] * v.x + axes[1] * v.y)).fold(0.0, f64::max);
            prop_assert!(most < 1.1 && most > 0.9, "{most}");
        }
    }
}
