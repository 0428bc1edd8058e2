//! Second-order forward differentiation: numbers that carry their gradient and their Hessian.

use super::linear::linear;
use super::{Tensor, Tensor3, Vector, Vector3};
use std::ops::{Div, Mul};

/// A type of jets, with gradients and Hessians of the types given. Arithmetic follows the chain rule (Griewank and Walther 2008):
/// derivatives are exact but for rounding.
macro_rules! jets {
    ($(#[$what:meta])* $jet:ident, $vector:ident, $tensor:ident) => {
        $(#[$what])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct $jet {
            /// The value.
            pub value: f64,
            /// First derivatives.
            pub gradient: $vector,
            /// Second derivatives.
            pub hessian: $tensor,
        }

        linear!($jet: value, gradient, hessian);

        impl $jet {
            /// Whether all derivatives vanish.
            pub(crate) fn is_constant(&self) -> bool {
                self.gradient == $vector::default() && self.hessian == $tensor::default()
            }

            /// g(f): g's value at f, and its first and second derivative there.
            #[must_use]
            pub(crate) fn chain(self, value: f64, [first, second]: [f64; 2]) -> Self {
                if self.is_constant() {
                    // Also where g has no derivative, as sqrt at zero.
                    return value.into();
                }
                let hessian = self.hessian * first + $tensor::square(self.gradient) * second;
                Self { value, gradient: self.gradient * first, hessian }
            }

            /// g(f, h): g's value there, and its derivatives by the first, the second, and then by both twice (11, 12, 22).
            #[must_use]
            pub(crate) fn chain2(self, other: Self, value: f64, first: [f64; 2], second: [f64; 3]) -> Self {
                if other.is_constant() {
                    return self.chain(value, [first[0], second[0]]);
                }
                if self.is_constant() {
                    return other.chain(value, [first[1], second[2]]);
                }
                let mixed = $tensor::symmetric_product(self.gradient, other.gradient) * second[1];
                let [a, b] = [self.chain(0.0, [first[0], second[0]]), other.chain(0.0, [first[1], second[2]])];
                Self { value, gradient: a.gradient + b.gradient, hessian: a.hessian + b.hessian + mixed }
            }
        }

        impl Mul for $jet {
            type Output = Self;
            fn mul(self, other: Self) -> Self {
                self.chain2(other, self.value * other.value, [other.value, self.value], [0.0, 1.0, 0.0])
            }
        }

        impl Div for $jet {
            type Output = Self;
            fn div(self, other: Self) -> Self {
                let inverse = 1.0 / other.value;
                let quotient = self.value * inverse;
                let second = [0.0, -inverse * inverse, 2.0 * quotient * inverse * inverse];
                self.chain2(other, self.value / other.value, [inverse, -quotient * inverse], second)
            }
        }

        /// A function that is the same everywhere.
        impl From<f64> for $jet {
            fn from(value: f64) -> Self {
                Self { value, ..Self::default() }
            }
        }
    };
}

jets! {
    /// A function's value at a point of space with its first and second derivatives there.
    Jet3, Vector3, Tensor3
}

jets! {
    /// A function's value at a point of the plane with its first and second derivatives there.
    Jet, Vector, Tensor
}

impl Jet3 {
    /// The coordinates x, y and z as functions.
    pub(crate) fn coordinates(x: f64, y: f64, z: f64) -> [Self; 3] {
        let axes = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 1.0, 0.0), Vector3::new(0.0, 0.0, 1.0)];
        let values = [x, y, z];
        std::array::from_fn(|i| Self { value: values[i], gradient: axes[i], hessian: Tensor3::default() })
    }
}

impl Jet {
    /// The coordinates x and y as functions.
    pub(crate) fn coordinates(x: f64, y: f64) -> [Self; 2] {
        [(x, [1.0, 0.0]), (y, [0.0, 1.0])].map(|(value, [by_x, by_y])| Self {
            value,
            gradient: Vector::new(by_x, by_y),
            hessian: Tensor::default(),
        })
    }

    /// In variables that are the shares of two vectors in a step.
    #[must_use]
    pub(crate) fn along(self, [p, q]: [Vector; 2]) -> Self {
        let gradient = Vector::new(self.gradient.dot(p), self.gradient.dot(q));
        Self { gradient, hessian: self.hessian.along([p, q]), ..self }
    }

    /// Of what is seen at a place that moves by a share of each step.
    #[must_use]
    pub(crate) fn slowed(self, share: f64) -> Self {
        Self { gradient: self.gradient * share, hessian: self.hessian * (share * share), ..self }
    }
}
