//! Arithmetic by components, for points' differences, tensors and jets alike.

/// Gives a type with these components sums, differences, negatives and multiples.
macro_rules! linear {
    ($vector:ident: $($component:ident),+) => {
        impl std::ops::Add for $vector {
            type Output = Self;
            fn add(self, other: Self) -> Self {
                Self { $($component: self.$component + other.$component),+ }
            }
        }

        impl std::ops::Sub for $vector {
            type Output = Self;
            fn sub(self, other: Self) -> Self {
                Self { $($component: self.$component - other.$component),+ }
            }
        }

        impl std::ops::Neg for $vector {
            type Output = Self;
            fn neg(self) -> Self {
                Self { $($component: -self.$component),+ }
            }
        }

        impl std::ops::Mul<f64> for $vector {
            type Output = Self;
            fn mul(self, s: f64) -> Self {
                Self { $($component: self.$component * s),+ }
            }
        }
    };
}

pub(super) use linear;
