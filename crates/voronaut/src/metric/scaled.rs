//! A metric field times a factor: how a mesh is given its number of vertices.

use super::MetricField;
use crate::geometry::{Point, Tensor};

/// The field `factor` M: metric lengths grow by sqrt(factor), the complexity (see [`complexity`](super::complexity()))
/// by `factor`. The factor is positive and finite; any other gives tensors that
/// `check_tensor` rejects.
#[derive(Clone, Copy)]
pub struct Scaled<'a> {
    /// The field M.
    pub field: &'a dyn MetricField,
    /// What its tensors are multiplied by.
    pub factor: f64,
}

impl MetricField for Scaled<'_> {
    fn at(&self, p: Point) -> Tensor {
        self.field.at(p) * self.factor
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metric::Uniform;

    #[test]
    fn scales_the_tensor() {
        let field = Uniform(Tensor::new(2.0, 0.5, 1.0));
        let scaled = Scaled { field: &field, factor: 4.0 };
        assert_eq!(scaled.at(Point::new(3.0, 1.0)), Tensor::new(8.0, 2.0, 4.0));
    }
}
