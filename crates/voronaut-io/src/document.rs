//! What a file holds: a mesh, values on it, and what a mesh cannot hold.

use std::collections::HashSet;
use voronaut::mesh::{Mesh, SolutionValues, Solutions};
use voronaut::{Error, Result};

/// Points of the mesh with their weights, of which a point's value is the sum.
pub(super) type Row = Vec<(u32, f64)>;

/// A mesh, and named values on its vertices and triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// The mesh.
    pub mesh: Mesh,
    /// The values.
    pub fields: Fields,
    /// What the file holds and the mesh does not, where that is a surprise: one sentence each, for users.
    pub notes: Vec<String>,
}

/// Named values on a mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Fields {
    /// One entry per vertex each.
    pub vertices: Vec<Field>,
    /// One entry per triangle each.
    pub triangles: Vec<Field>,
}

/// Values with a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// What the file calls them.
    pub name: String,
    /// One entry per vertex or triangle.
    pub values: SolutionValues,
}

impl Fields {
    /// The solutions of a `.sol` file, which have no names: a tensor is called `metric`, others `solution`, and numbered from the second.
    pub fn of_solutions(solutions: Solutions) -> Self {
        Self { vertices: named(solutions.vertices), triangles: named(solutions.triangles) }
    }

    /// Joins other fields to these.
    pub fn extend(&mut self, more: Self) {
        self.vertices.extend(more.vertices);
        self.triangles.extend(more.triangles);
    }

    /// What a `.sol` file beside a mesh holds of the fields: their values without names. Vectors that do not have as many components as
    /// the mesh has coordinates are one scalar for each component.
    ///
    /// # Errors
    /// [`Error::Unsupported`] of tensors of the plane on a mesh that is not planar, and of those of space that leave the plane of one
    /// that is.
    pub fn into_solutions(self, mesh: &Mesh) -> Result<Solutions> {
        let dimension = if mesh.is_planar() { 2 } else { 3 };
        let values = |fields: Vec<Field>| {
            let values = fields.into_iter().map(|field| field.into_solutions(dimension));
            Ok(values.collect::<Result<Vec<_>>>()?.concat())
        };
        Ok(Solutions { dimension, vertices: values(self.vertices)?, triangles: values(self.triangles)? })
    }
}

/// Names that differ from each other and from those that mean something in a format: others begin with `field_`, and are numbered
/// where that is taken, too.
pub(super) fn distinct_names(wanted: impl Iterator<Item = String>, reserved: &[&str]) -> Vec<String> {
    let mut taken: HashSet<String> = reserved.iter().map(|name| (*name).to_owned()).collect();
    let distinct = |name: String| {
        let spare = (1..).map(|n| if n == 1 { format!("field_{name}") } else { format!("field_{name}_{n}") });
        let given = std::iter::once(name.clone()).filter(|name| !name.is_empty());
        let found = given.chain(spare).find(|name| !taken.contains(name)).unwrap_or_default();
        taken.insert(found.clone());
        found
    };
    wanted.map(distinct).collect()
}

impl Field {
    /// How many numbers an entry has in space: tensors are whole matrices, and vectors of a plane have a third coordinate, for Gmsh and
    /// VTK have but vectors of three.
    pub(super) fn width(&self, is_planar: bool) -> usize {
        match &self.values {
            SolutionValues::Tensor(_) | SolutionValues::Tensor3(_) => 9,
            SolutionValues::Vector { components: 2, .. } if is_planar => 3,
            others => others.components(),
        }
    }

    /// Number `k` of entry `i` in space.
    pub(super) fn number(&self, i: usize, k: usize) -> f64 {
        const IN_SPACE: [usize; 9] = [0, 1, 3, 1, 2, 4, 3, 4, 5];
        const IN_PLANE: [usize; 9] = [0, 1, 3, 1, 2, 3, 3, 3, 3];
        let place = match &self.values {
            SolutionValues::Tensor(_) => IN_PLANE[k],
            SolutionValues::Tensor3(_) => IN_SPACE[k],
            _ => k,
        };
        self.values.row(i).get(place).copied().unwrap_or(0.0)
    }

    /// The field whose entries are sums of these, with weights.
    pub(super) fn combined(&self, rows: &[Row]) -> Self {
        let components = self.values.components();
        let sum = |row: &Row, k: usize| {
            let weighted = row.iter().map(|&(i, weight)| weight * self.values.row(i as usize)[k]);
            weighted.reduce(|a, b| a + b).unwrap_or(0.0)
        };
        let numbers: Vec<f64> = rows.iter().flat_map(|row| (0..components).map(move |k| sum(row, k))).collect();
        let values = match self.values {
            SolutionValues::Scalar(_) => SolutionValues::Scalar(numbers),
            SolutionValues::Vector { components, .. } => SolutionValues::Vector { components, numbers },
            SolutionValues::Tensor(_) => SolutionValues::Tensor(numbers.as_chunks().0.to_vec()),
            SolutionValues::Tensor3(_) => SolutionValues::Tensor3(numbers.as_chunks().0.to_vec()),
        };
        Self { name: self.name.clone(), values }
    }

    fn into_solutions(self, dimension: u8) -> Result<Vec<SolutionValues>> {
        match self.values {
            SolutionValues::Vector { components, ref numbers } if components != usize::from(dimension) => {
                let column = |i| SolutionValues::Scalar(numbers.iter().copied().skip(i).step_by(components).collect());
                Ok((0..components).map(column).collect())
            }
            SolutionValues::Tensor(_) if dimension == 3 => Err(unfit(&self.name, "the plane", "is not planar")),
            SolutionValues::Tensor3(entries) if dimension == 2 => {
                let planar = |&[xx, xy, yy, xz, yz, _]: &[f64; 6]| (xz == 0.0 && yz == 0.0).then_some([xx, xy, yy]);
                let tensors = entries.iter().map(planar).collect::<Option<Vec<_>>>();
                Ok(vec![SolutionValues::Tensor(tensors.ok_or_else(|| unfit(&self.name, "space", "is planar"))?)])
            }
            values => Ok(vec![values]),
        }
    }
}

/// Labels, and 0 for ever behind them: where some are missing that is what they are.
pub(super) fn labels(labels: &[i32]) -> impl Iterator<Item = i32> + Clone {
    labels.iter().copied().chain(std::iter::repeat(0))
}

/// What is marked in a mesh: corners, required vertices, ridges, required edges, required triangles.
pub(super) fn marked(mesh: &Mesh) -> [&[u32]; 5] {
    [&mesh.corners, &mesh.required_points, &mesh.ridges, &mesh.required_edges, &mesh.required_triangles]
}

/// As [`marked`], to be changed.
pub(super) fn marked_mut(mesh: &mut Mesh) -> [&mut Vec<u32>; 5] {
    let Mesh { corners, required_points, ridges, required_edges, required_triangles, .. } = mesh;
    [corners, required_points, ridges, required_edges, required_triangles]
}

/// A mesh whose vertices, triangles and edges have the label 0 where they have none.
pub(super) fn labelled(mut mesh: Mesh) -> Mesh {
    mesh.point_labels.resize(mesh.points.len(), 0);
    mesh.triangle_labels.resize(mesh.triangles.len(), 0);
    mesh.edge_labels.resize(mesh.edges.len(), 0);
    mesh
}

fn unfit(name: &str, of: &str, mesh: &str) -> Error {
    let what = format!("the tensors of {of} '{name}' beside a mesh that {mesh}");
    Error::unsupported(what, "give tensors of the mesh's own dimension")
}

fn named(values: Vec<SolutionValues>) -> Vec<Field> {
    let mut counts = [0; 2];
    let name = |values: SolutionValues| {
        let is_tensor = matches!(values, SolutionValues::Tensor(_) | SolutionValues::Tensor3(_));
        let (name, count) = if is_tensor { ("metric", &mut counts[0]) } else { ("solution", &mut counts[1]) };
        *count += 1;
        let name = if *count == 1 { name.to_owned() } else { format!("{name}_{count}") };
        Field { name, values }
    };
    values.into_iter().map(name).collect()
}

impl From<Mesh> for Document {
    fn from(mesh: Mesh) -> Self {
        Self { mesh, ..Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_differ() {
        let wanted = ["u", "", "label", "u", "u", "field_u"].map(str::to_owned);
        let names = distinct_names(wanted.into_iter(), &["label"]);
        assert_eq!(names, ["u", "field_", "field_label", "field_u", "field_u_2", "field_field_u"]);
    }
}
