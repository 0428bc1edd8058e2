//! Values on vertices and triangles: scalars (sizes), vectors and symmetric tensors (metrics).

use crate::error::{Error, Result};

/// Values on the vertices of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// 2 or 3: the coordinates of the mesh's vertices.
    pub dimension: u8,
    /// One entry per vertex.
    pub values: SolutionValues,
}

impl Solution {
    /// The entries of some vertices, in their order.
    ///
    /// # Panics
    /// If there is no such vertex.
    #[must_use]
    pub(crate) fn of_vertices(&self, vertices: &[u32]) -> Self {
        let numbers: Vec<f64> = vertices.iter().flat_map(|&v| self.values.row(v as usize)).copied().collect();
        Self { dimension: self.dimension, values: self.values.with_numbers(&numbers) }
    }

    /// How many vertices it has entries of.
    pub(crate) fn count(&self) -> usize {
        self.values.count()
    }
}

/// Everything that a `.sol` file holds: any number of solutions on vertices and on triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Solutions {
    /// 2 or 3: the coordinates of the mesh's vertices.
    pub dimension: u8,
    /// One entry per vertex each.
    pub vertices: Vec<SolutionValues>,
    /// One entry per triangle each.
    pub triangles: Vec<SolutionValues>,
}

/// The entries of a solution, in the order of the vertices or triangles.
#[derive(Clone, Debug, PartialEq)]
pub enum SolutionValues {
    /// One number each; as a metric: a size h, not 1/h^2.
    Scalar(Vec<f64>),
    /// Several numbers each, one entry after the other. In `.sol` files there are as many as the dimension says.
    Vector {
        /// How many numbers an entry has; at least 1.
        components: usize,
        /// The entries' numbers.
        numbers: Vec<f64>,
    },
    /// Dimension 2: m11 m12 m22.
    Tensor(Vec<[f64; 3]>),
    /// Dimension 3, in the order on disk (the lower triangle): m11 m12 m22 m13 m23 m33.
    Tensor3(Vec<[f64; 6]>),
}

impl SolutionValues {
    /// How many entries there are.
    pub fn count(&self) -> usize {
        self.numbers().len() / self.components()
    }

    /// How many numbers an entry has.
    pub fn components(&self) -> usize {
        match self {
            SolutionValues::Scalar(_) => 1,
            SolutionValues::Vector { components, .. } => *components,
            SolutionValues::Tensor(_) => 3,
            SolutionValues::Tensor3(_) => 6,
        }
    }

    /// The numbers of entry `i`.
    ///
    /// # Panics
    /// If there is no such entry.
    pub fn row(&self, i: usize) -> &[f64] {
        &self.numbers()[i * self.components()..][..self.components()]
    }

    /// The numbers of all entries, one after the other.
    fn numbers(&self) -> &[f64] {
        match self {
            SolutionValues::Scalar(numbers) | SolutionValues::Vector { numbers, .. } => numbers,
            SolutionValues::Tensor(entries) => entries.as_flattened(),
            SolutionValues::Tensor3(entries) => entries.as_flattened(),
        }
    }

    /// Entries from their numbers in space, so many each, as Gmsh and VTK have them: one is a scalar, nine are the rows of a tensor, if
    /// all are symmetric, others a vector. On a planar mesh vectors and tensors whose z entries are all 0 are those of the plane.
    pub fn in_space(numbers: Vec<f64>, components: usize, is_planar: bool) -> Self {
        let rows = || numbers.chunks_exact(components);
        let is_symmetric = |m: &[f64]| [(1, 3), (2, 6), (5, 7)].into_iter().all(|(i, j)| m[i] - m[j] == 0.0);
        match components {
            1 => SolutionValues::Scalar(numbers),
            3 if is_planar && rows().all(|row| row[2] == 0.0) => {
                SolutionValues::Vector { components: 2, numbers: rows().flat_map(|row| [row[0], row[1]]).collect() }
            }
            9 if !rows().all(is_symmetric) => SolutionValues::Vector { components, numbers },
            9 if is_planar && rows().all(|m| m[2] == 0.0 && m[5] == 0.0 && m[8] == 0.0) => {
                SolutionValues::Tensor(rows().map(|m| [m[0], m[1], m[4]]).collect())
            }
            9 => SolutionValues::Tensor3(rows().map(|m| [m[0], m[1], m[4], m[2], m[5], m[8]]).collect()),
            _ => SolutionValues::Vector { components, numbers },
        }
    }

    /// Entries of the same type from their numbers, one after the other.
    #[must_use]
    pub(crate) fn with_numbers(&self, numbers: &[f64]) -> Self {
        match self {
            SolutionValues::Scalar(_) => SolutionValues::Scalar(numbers.to_vec()),
            &SolutionValues::Vector { components, .. } => {
                SolutionValues::Vector { components, numbers: numbers.to_vec() }
            }
            SolutionValues::Tensor(_) => SolutionValues::Tensor(numbers.as_chunks().0.to_vec()),
            SolutionValues::Tensor3(_) => SolutionValues::Tensor3(numbers.as_chunks().0.to_vec()),
        }
    }
}

/// In which order the different entries of a symmetric tensor are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum TensorOrder {
    /// That of `.sol` files, the lower triangle: m11 m12 m22 m13 m23 m33 (in the plane m11 m12 m22).
    #[default]
    Disk,
    /// The upper triangle, as mmg's API and gmsh have it: m11 m12 m13 m22 m23 m33 (in the plane m11 m12 m22).
    Upper,
    /// The diagonal first, as VTK and tucanos have it: m11 m22 m33 m12 m23 m13 (in the plane m11 m22 m12).
    Diagonal,
}

impl TensorOrder {
    /// Every order.
    pub const ALL: [Self; 3] = [Self::Disk, Self::Upper, Self::Diagonal];

    /// The entries' names in order, of tensors of space or of the plane.
    pub fn entries(self, is_space: bool) -> &'static str {
        match (self, is_space) {
            (Self::Disk, true) => "m11 m12 m22 m13 m23 m33",
            (Self::Upper, true) => "m11 m12 m13 m22 m23 m33",
            (Self::Diagonal, true) => "m11 m22 m33 m12 m23 m13",
            (Self::Disk | Self::Upper, false) => "m11 m12 m22",
            (Self::Diagonal, false) => "m11 m22 m12",
        }
    }

    /// Where in this order the entries stand that the order on disk has in turn.
    fn places(self) -> [usize; 6] {
        match self {
            Self::Disk => [0, 1, 2, 3, 4, 5],
            Self::Upper => [0, 1, 3, 2, 4, 5],
            Self::Diagonal => [0, 3, 1, 5, 4, 2],
        }
    }

    fn planar_places(self) -> [usize; 3] {
        if self == Self::Diagonal { [0, 2, 1] } else { [0, 1, 2] }
    }
}

impl std::fmt::Display for TensorOrder {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Disk => "disk",
            Self::Upper => "upper",
            Self::Diagonal => "diagonal",
        })
    }
}

impl std::str::FromStr for TensorOrder {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|order| order.to_string() == text).ok_or_else(|| {
            let help = "write disk (m11 m12 m22 m13 m23 m33), upper (m11 m12 m13 m22 m23 m33) or diagonal (m11 m22 m33 m12 m23 m13)";
            Error::parse("tensor order", format!("'{text}' is not an order"), help)
        })
    }
}

impl SolutionValues {
    /// The same tensors in the order on disk, if these are in another; what is no tensor stays as it is.
    #[must_use]
    pub fn from_order(self, order: TensorOrder) -> Self {
        self.arranged(order.planar_places(), order.places())
    }

    /// The same tensors in another order, if these are in that on disk: undoes [`SolutionValues::from_order`].
    #[must_use]
    pub fn to_order(self, order: TensorOrder) -> Self {
        fn inverse<const N: usize>(places: [usize; N]) -> [usize; N] {
            std::array::from_fn(|i| places.iter().position(|&place| place == i).expect("every place once"))
        }
        self.arranged(inverse(order.planar_places()), inverse(order.places()))
    }

    /// The same tensors, their entries taken from these places.
    fn arranged(mut self, planar: [usize; 3], space: [usize; 6]) -> Self {
        match &mut self {
            Self::Tensor(entries) => entries.iter_mut().for_each(|e| *e = planar.map(|i| e[i])),
            Self::Tensor3(entries) => entries.iter_mut().for_each(|e| *e = space.map(|i| e[i])),
            Self::Scalar(_) | Self::Vector { .. } => {}
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_make_entries_of_the_same_type() {
        for (values, numbers) in [
            (SolutionValues::Scalar(vec![1.0, 2.0]), [1.0, 2.0].as_slice()),
            (SolutionValues::Vector { components: 3, numbers: vec![1.0, 2.0, 3.0] }, &[1.0, 2.0, 3.0]),
            (SolutionValues::Tensor(vec![[1.0, 2.0, 3.0]]), &[1.0, 2.0, 3.0]),
            (SolutionValues::Tensor3(vec![[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]]), &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]),
        ] {
            let rows: Vec<f64> = (0..values.count()).flat_map(|i| values.row(i)).copied().collect();
            assert_eq!(rows, numbers);
            assert_eq!(values.with_numbers(numbers), values);
        }
    }
}
