//! Meshes and values as arrays of numpy, and back. What leaves is not copied.

use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use voronaut::geometry::Tensor;
use voronaut::mesh::{Curved, Mesh, Periodic, SolutionValues, Solutions};
use voronaut_io::{Document, Field, Fields};

/// Lists of vertices, edges and triangles by their numbers, as a mesh has them.
const LISTS: [&str; 5] = ["corners", "required_points", "ridges", "required_edges", "required_triangles"];

/// The mesh of a dictionary of arrays, which the package has checked: `points` (N, 3), `triangles` (M, 3), `edges` (K, 2), a label
/// for each, and lists of numbers.
pub(crate) fn mesh_of(given: &Bound<PyDict>) -> PyResult<Mesh> {
    let [corners, required_points, ridges, required_edges, required_triangles] = LISTS.map(|name| list(given, name));
    Ok(Mesh {
        points: rows(given, "points")?,
        point_labels: list(given, "point_labels")?,
        triangles: rows(given, "triangles")?,
        triangle_labels: list(given, "triangle_labels")?,
        edges: rows(given, "edges")?,
        edge_labels: list(given, "edge_labels")?,
        corners: corners?,
        required_points: required_points?,
        ridges: ridges?,
        required_edges: required_edges?,
        required_triangles: required_triangles?,
        periodic: pairs_of(given)?,
        curved: curved_of(given)?,
    })
}

/// The nodes of triangles of order 2 or 3: `nodes` (K, 3) and `curved_triangles`, three numbers or seven for each triangle.
fn curved_of(given: &Bound<PyDict>) -> PyResult<Option<Curved>> {
    let Some(array) = given.get_item("curved_triangles")? else { return Ok(None) };
    let numbers: PyReadonlyArray2<u32> = array.extract()?;
    let order = if numbers.as_array().ncols() == 3 { 2 } else { 3 };
    Ok(Some(Curved { order, nodes: rows(given, "nodes")?, triangles: numbers.as_slice()?.to_vec() }))
}

/// Curves that correspond: labels, cosine and sine, translation, how far corners are off, and vertices (N, 2).
type Pair<V> = ([i32; 2], [f64; 2], [f64; 2], f64, V);

fn pairs_of(given: &Bound<PyDict>) -> PyResult<Vec<Periodic>> {
    let Some(all) = given.get_item("periodic")? else { return Ok(Vec::new()) };
    let pair = |(labels, rotation, translation, off, vertices): Pair<PyReadonlyArray2<u32>>| {
        Ok(Periodic { labels, rotation, translation, off, vertices: vertices.as_slice()?.as_chunks().0.to_vec() })
    };
    all.extract::<Vec<_>>()?.into_iter().map(pair).collect()
}

fn of_pairs(py: Python, pairs: Vec<Periodic>) -> PyResult<Vec<Pair<Py<PyAny>>>> {
    let pair = |pair: Periodic| {
        let count = pair.vertices.len();
        let vertices = PyArray1::from_vec(py, pair.vertices.into_flattened()).reshape([count, 2])?;
        Ok((pair.labels, pair.rotation, pair.translation, pair.off, vertices.into_any().unbind()))
    };
    pairs.into_iter().map(pair).collect()
}

/// A mesh with its fields, `vertex_fields` and `triangle_fields` by their names.
pub(crate) fn document_of(given: &Bound<PyDict>) -> PyResult<Document> {
    let fields = Fields { vertices: fields(given, "vertex_fields")?, triangles: fields(given, "triangle_fields")? };
    Ok(Document { mesh: mesh_of(given)?, fields, notes: Vec::new() })
}

fn fields(given: &Bound<PyDict>, name: &str) -> PyResult<Vec<Field>> {
    let Some(all) = given.get_item(name)? else { return Ok(Vec::new()) };
    let field =
        |(name, values): (Bound<PyAny>, Bound<PyAny>)| Ok(Field { name: name.extract()?, values: values_of(&values)? });
    all.cast::<PyDict>()?.iter().map(field).collect()
}

/// Values of one or more numbers each: sizes, vectors, or tensors of 3 or 6 entries where their kind says so.
pub(crate) fn values_of(given: &Bound<PyAny>) -> PyResult<SolutionValues> {
    let (kind, numbers): (String, PyReadonlyArray2<f64>) = given.extract()?;
    let components = numbers.as_array().ncols();
    let numbers = numbers.as_slice()?.to_vec();
    Ok(match (kind.as_str(), components) {
        ("tensor", 3) => SolutionValues::Tensor(numbers.as_chunks().0.to_vec()),
        ("tensor", 6) => SolutionValues::Tensor3(numbers.as_chunks().0.to_vec()),
        (_, 1) => SolutionValues::Scalar(numbers),
        _ => SolutionValues::Vector { components, numbers },
    })
}

/// A mesh with tensors at its vertices.
pub(crate) fn of_metric<'py>(py: Python<'py>, mesh: Mesh, tensors: &[Tensor]) -> PyResult<Bound<'py, PyDict>> {
    let (told, fields) = (of_mesh(py, mesh)?, PyDict::new(py));
    let entries = tensors.iter().map(|tensor| [tensor.xx, tensor.xy, tensor.yy]).collect();
    fields.set_item("metric", of_values(py, SolutionValues::Tensor(entries))?)?;
    told.set_item("vertex_fields", fields)?;
    Ok(told)
}

/// What values are, and their numbers.
type Kinded = (&'static str, Py<PyAny>);

/// Values with what they are: `scalar`, `vector` or `tensor`, and (N, components) numbers.
pub(crate) fn of_values(py: Python, values: SolutionValues) -> PyResult<Kinded> {
    let components = values.components();
    let (kind, numbers) = match values {
        SolutionValues::Scalar(numbers) => ("scalar", numbers),
        SolutionValues::Vector { numbers, .. } => ("vector", numbers),
        SolutionValues::Tensor(entries) => ("tensor", entries.into_flattened()),
        SolutionValues::Tensor3(entries) => ("tensor", entries.into_flattened()),
    };
    let count = numbers.len() / components;
    let array = PyArray1::from_vec(py, numbers).reshape([count, components])?;
    Ok((kind, array.into_any().unbind()))
}

/// The values of vertices and of triangles, in their order.
pub(crate) fn of_solutions(py: Python, solutions: Solutions) -> PyResult<[Vec<Kinded>; 2]> {
    let arrays =
        |all: Vec<SolutionValues>| all.into_iter().map(|values| of_values(py, values)).collect::<PyResult<_>>();
    Ok([arrays(solutions.vertices)?, arrays(solutions.triangles)?])
}

/// The rows of an array of the mesh; none where it has none.
fn rows<T: numpy::Element + Copy, const N: usize>(given: &Bound<PyDict>, name: &str) -> PyResult<Vec<[T; N]>> {
    let Some(array) = given.get_item(name)? else { return Ok(Vec::new()) };
    let array: PyReadonlyArray2<T> = array.extract()?;
    if array.as_array().ncols() != N {
        return Err(PyValueError::new_err(format!("{name} has {} columns, not {N}", array.as_array().ncols())));
    }
    Ok(array.as_slice()?.as_chunks().0.to_vec())
}

fn list<T: numpy::Element + Copy>(given: &Bound<PyDict>, name: &str) -> PyResult<Vec<T>> {
    let Some(array) = given.get_item(name)? else { return Ok(Vec::new()) };
    let array: numpy::PyReadonlyArray1<T> = array.extract()?;
    Ok(array.as_slice()?.to_vec())
}

/// A mesh as a dictionary of arrays, which own its memory.
pub(crate) fn of_mesh(py: Python<'_>, mesh: Mesh) -> PyResult<Bound<'_, PyDict>> {
    let made = PyDict::new(py);
    made.set_item("is_planar", mesh.is_planar())?;
    let [points, triangles, edges] = [mesh.points.len(), mesh.triangles.len(), mesh.edges.len()];
    made.set_item("points", PyArray1::from_vec(py, mesh.points.into_flattened()).reshape([points, 3])?)?;
    made.set_item("triangles", PyArray1::from_vec(py, mesh.triangles.into_flattened()).reshape([triangles, 3])?)?;
    made.set_item("edges", PyArray1::from_vec(py, mesh.edges.into_flattened()).reshape([edges, 2])?)?;
    made.set_item("point_labels", PyArray1::from_vec(py, mesh.point_labels))?;
    made.set_item("triangle_labels", PyArray1::from_vec(py, mesh.triangle_labels))?;
    made.set_item("edge_labels", PyArray1::from_vec(py, mesh.edge_labels))?;
    let lists = [mesh.corners, mesh.required_points, mesh.ridges, mesh.required_edges, mesh.required_triangles];
    for (name, list) in LISTS.into_iter().zip(lists) {
        made.set_item(name, PyArray1::from_vec(py, list))?;
    }
    made.set_item("periodic", of_pairs(py, mesh.periodic)?)?;
    if let Some(curved) = mesh.curved {
        let (nodes, columns) = (curved.nodes.len(), if curved.order == 2 { 3 } else { 7 });
        made.set_item("nodes", PyArray1::from_vec(py, curved.nodes.into_flattened()).reshape([nodes, 3])?)?;
        let numbers = PyArray1::from_vec(py, curved.triangles).reshape([triangles, columns])?;
        made.set_item("curved_triangles", numbers)?;
    }
    Ok(made)
}

/// A mesh with its fields.
pub(crate) fn of_document(py: Python<'_>, document: Document) -> PyResult<Bound<'_, PyDict>> {
    let made = of_mesh(py, document.mesh)?;
    for (name, fields) in [("vertex_fields", document.fields.vertices), ("triangle_fields", document.fields.triangles)]
    {
        let all = PyDict::new(py);
        for field in fields {
            all.set_item(field.name, of_values(py, field.values)?)?;
        }
        made.set_item(name, all)?;
    }
    made.set_item("notes", document.notes)?;
    Ok(made)
}
