//! Errors of the library as exceptions of the package.

use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use voronaut::Error;
use voronaut_cli::Usage;

/// The exception of the package that says it: `kind` names its class.
pub(crate) fn exception(py: Python, error: &Error) -> PyErr {
    let kind = match error {
        Error::Io { .. } => "FileError",
        Error::Parse { .. } => "InputError",
        Error::Domain { .. } => "DomainError",
        Error::Metric { .. } => "MetricError",
        Error::Limit { .. } => "LimitError",
        Error::Unsupported { .. } => "UnsupportedError",
        Error::Stopped => "Cancelled",
        Error::Mesh { .. } => "MeshError",
    };
    raised(py, kind, &error.to_string(), error.help()).unwrap_or_else(|error| error)
}

/// An exception of the package, with what to do.
pub(crate) fn raised(py: Python, kind: &str, what: &str, help: &str) -> PyResult<PyErr> {
    let spelt = |text: &str| voronaut_cli::as_keywords(text).replace("`vertices`", "`n`");
    let class = py.import("voronaut._errors")?.getattr(kind)?;
    Ok(PyErr::from_value(class.call1((spelt(what), spelt(help)))?))
}

/// An option that there is not is a wrong call; another value than it may have is a wrong value.
pub(crate) fn usage(Usage { what, is_unknown }: Usage) -> PyErr {
    let what = what.strip_prefix("vertices").map(|rest| format!("n{rest}")).unwrap_or(what);
    if is_unknown { PyTypeError::new_err(what) } else { PyValueError::new_err(what) }
}

/// The work came to an end that it should not have.
pub(crate) fn panicked() -> PyErr {
    PyRuntimeError::new_err("this is a fault of voronaut: please report it with the input")
}
