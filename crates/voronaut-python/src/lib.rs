//! The extension of the Python package `voronaut`: arrays in, commands, arrays out. The package beside it says what users see.

mod arrays;
mod declared;
mod faults;
mod metrics;
mod work;

use metrics::{Metric, Shaping};
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use std::collections::HashMap;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};
use voronaut::geometry::Tensor;
use voronaut::mesh::Mesh;
use voronaut::recipe::Part;
use voronaut_cli::{Held, Job, Made, PartsMaker};
use voronaut_io::{Document, ending};
use work::{Course, Terms};

/// The extension; the package `voronaut` is what to use.
#[pymodule]
mod _voronaut {
    #[pymodule_export]
    use super::{commands, main, metric_at, perform, read, write};
}

/// Performs a command with options, each with its texts, on what is held under the words that stand for it: kind by kind, `documents`,
/// `polygons`, `metrics`, `solutions`, `seeds`. Returns a dictionary of what was made.
#[pyfunction]
fn perform<'py>(
    py: Python<'py>,
    command: &str,
    options: Vec<(String, Vec<String>)>,
    held: &Bound<'py, PyDict>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let job = Job::new(command, &options).map_err(faults::usage)?;
    let course = Arc::new(Course::new());
    let held = held_of(held, &course)?;
    let terms = Terms { threads: job.threads(), time_limit: job.time_limit(), callback: progress.as_ref() };
    let own = course.clone();
    let made = work::wait(py, &course, &terms, move || job.perform(held, &&*own))?;
    told(py, made)
}

fn held_of(given: &Bound<PyDict>, course: &Arc<Course>) -> PyResult<Held> {
    let mut held = Held::default();
    for (kind, all) in given.iter() {
        let all: HashMap<String, Bound<PyAny>> = all.extract()?;
        for (word, value) in all {
            match kind.extract::<&str>()? {
                "documents" => drop(held.documents.insert(word, arrays::document_of(value.cast()?)?)),
                "polygons" => drop(held.polygons.insert(word, value.extract()?)),
                "parts" => held.parts_maker = Some(Mutex::new(maker(value.unbind(), course.clone()))),
                "metrics" => drop(held.metrics.insert(word, Box::new(Metric::of(&value, course)?))),
                "solutions" => {
                    let document = arrays::document_of(value.cast()?)?;
                    let dimension = if document.mesh.is_planar() { 2 } else { 3 };
                    let values =
                        |fields: Vec<voronaut_io::Field>| fields.into_iter().map(|field| field.values).collect();
                    let (vertices, triangles) = (values(document.fields.vertices), values(document.fields.triangles));
                    held.solutions.insert(word, voronaut::mesh::Solutions { dimension, vertices, triangles });
                }
                _ => {
                    let rows: PyReadonlyArray2<f64> = value.extract()?;
                    held.seeds.insert(word, rows.as_array().rows().into_iter().map(|row| row.to_vec()).collect());
                }
            }
        }
    }
    Ok(held)
}

/// A function of a round's name and its parts, each a mesh, its number of vertices and its metric, if it has one of its own, that returns
/// their meshes.
fn maker(function: Py<PyAny>, course: Arc<Course>) -> PartsMaker {
    Box::new(move |round, parts, take| {
        course.call(|py| {
            let metric = |(mesh, tensors): &(Mesh, Vec<Tensor>)| arrays::of_metric(py, mesh.clone(), tensors);
            let part = |part: &Part| {
                let metric = part.metric.as_ref().map(metric).transpose()?;
                Ok((arrays::of_mesh(py, part.domain.clone())?, part.vertices, metric))
            };
            let parts = parts.iter().map(part).collect::<PyResult<Vec<_>>>()?;
            let made = function.bind(py).call1((round, parts))?;
            made.try_iter()?.try_for_each(|mesh| arrays::mesh_of(mesh?.cast()?).map(&mut *take))
        })
    })
}

fn told(py: Python<'_>, made: Made) -> PyResult<Bound<'_, PyDict>> {
    let told = PyDict::new(py);
    told.set_item("mesh", made.mesh.map(|mesh| arrays::of_mesh(py, mesh)).transpose()?)?;
    if let Some((mesh, distances)) = made.canvas {
        told.set_item("canvas", arrays::of_mesh(py, mesh)?)?;
        told.set_item("distances", PyArray1::from_vec(py, distances))?;
    }
    told.set_item("solutions", made.solutions.map(|all| arrays::of_solutions(py, all)).transpose()?)?;
    told.set_item("page", made.page)?;
    told.set_item("report", made.report)?;
    told.set_item("warnings", made.warnings)?;
    Ok(told)
}

/// Reads a file by its ending: a mesh with fields, or values without a mesh.
#[pyfunction]
fn read(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyDict>> {
    let (course, terms) = (Arc::new(Course::new()), Terms::default());
    if matches!(ending(&path).as_deref(), Some("sol" | "solb")) {
        let solutions = work::wait(py, &course, &terms, move || voronaut_io::read_solutions(&path))?;
        return told(py, Made { solutions: Some(solutions), ..Made::default() });
    }
    let document = work::wait(py, &course, &terms, move || voronaut_io::read(&path))?;
    arrays::of_document(py, document)
}

/// Writes a mesh with its fields by the ending of the name.
#[pyfunction]
fn write(py: Python, path: PathBuf, mesh: &Bound<PyDict>) -> PyResult<()> {
    let Document { mesh, fields, .. } = arrays::document_of(mesh)?;
    let done = py.detach(|| {
        if matches!(ending(&path).as_deref(), Some("sol" | "solb")) {
            return voronaut_io::write_solutions(&fields.into_solutions(&mesh)?, &path);
        }
        voronaut_io::write_document(&mesh, &fields, &path)
    });
    done.map_err(|error| faults::exception(py, &error))
}

/// The tensors that metrics make at the vertices of a planar mesh, in the order of `voronaut metric`, and their complexity.
#[pyfunction]
fn metric_at<'py>(
    py: Python<'py>,
    mesh: &Bound<'py, PyDict>,
    metrics: Vec<Bound<'py, PyAny>>,
    shaping: Shaping<'py>,
) -> PyResult<Bound<'py, PyTuple>> {
    let course = Arc::new(Course::new());
    let mesh = arrays::mesh_of(mesh)?;
    let metrics = metrics.iter().map(|metric| Metric::of(metric, &course)).collect::<PyResult<Vec<_>>>()?;
    let pipeline = shaping.pipeline(py)?;
    let made = work::wait(py, &course, &Terms::default(), move || metrics::at_vertices(&pipeline, &mesh, &metrics))?;
    let flat: Vec<f64> = made.tensors.iter().flat_map(|m| [m.xx, m.xy, m.yy]).collect();
    let tensors = PyArray1::from_vec(py, flat).reshape([made.tensors.len(), 3])?;
    (tensors, made.complexity).into_pyobject(py)
}

/// Every command with its options, as JSON.
#[pyfunction]
fn commands() -> String {
    declared::commands().to_string()
}

/// The program: the words that start it, and those after them, as a shell has them. Returns the exit code.
#[pyfunction]
fn main(program: Vec<OsString>, words: Vec<OsString>) -> u8 {
    voronaut_cli::run(program, words)
}
