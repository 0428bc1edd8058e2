//! Values on vertices and triangles: scalars (sizes), vectors and symmetric tensors (metrics).

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
    pub fn of_vertices(&self, vertices: &[u32]) -> Self {
        fn taken<T: Clone>(entries: &[T], vertices: &[u32]) -> Vec<T> {
            vertices.iter().map(|&v| entries[v as usize].clone()).collect()
        }
        let values = match &self.values {
            SolutionValues::Scalar(entries) => SolutionValues::Scalar(taken(entries, vertices)),
            &SolutionValues::Vector { components, ref numbers } => {
                let row = |&v: &u32| &numbers[v as usize * components..][..components];
                SolutionValues::Vector { components, numbers: vertices.iter().flat_map(row).copied().collect() }
            }
            SolutionValues::Tensor(entries) => SolutionValues::Tensor(taken(entries, vertices)),
            SolutionValues::Tensor3(entries) => SolutionValues::Tensor3(taken(entries, vertices)),
        };
        Self { dimension: self.dimension, values }
    }

    /// How many vertices it has entries of.
    pub fn count(&self) -> usize {
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
        match self {
            SolutionValues::Scalar(entries) => entries.len(),
            SolutionValues::Vector { components, numbers } => numbers.len() / components,
            SolutionValues::Tensor(entries) => entries.len(),
            SolutionValues::Tensor3(entries) => entries.len(),
        }
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
        match self {
            SolutionValues::Scalar(entries) => std::slice::from_ref(&entries[i]),
            SolutionValues::Vector { components, numbers } => &numbers[i * components..][..*components],
            SolutionValues::Tensor(entries) => &entries[i],
            SolutionValues::Tensor3(entries) => &entries[i],
        }
    }

    /// Entries of the same type from their numbers, one after the other.
    #[must_use]
    pub fn with_numbers(&self, numbers: &[f64]) -> Self {
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
