//! The library's error: what went wrong, where, and what to do about it.

mod counted;
mod named;

pub(crate) use counted::counted;
pub(crate) use named::{named, unknown};

use std::path::PathBuf;

/// The result of every fallible function of this crate.
pub type Result<T> = std::result::Result<T, Error>;

/// What can go wrong, grouped by stage. [`Display`](std::fmt::Display) says what and where;
/// [`Error::help`] says what to do.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file could not be read or written.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A text (a file, a specification on the command line) is not what its format asks for.
    #[error("{place}: {what}")]
    Parse {
        /// Where: `FILE:LINE`, or the part of a specification.
        place: String,
        /// What is wrong there.
        what: String,
        /// What to do.
        help: String,
    },
    /// The domain is not a valid planar domain (self-crossing, open, empty, duplicate points).
    #[error("invalid domain: {what} at {place}")]
    Domain {
        /// What is wrong.
        what: String,
        /// Where: coordinates, and vertices or segments by number.
        place: String,
        /// What to do.
        help: String,
    },
    /// The metric is not symmetric positive definite, or not finite, at a point of the domain.
    #[error("invalid metric: {what} at {place}")]
    Metric {
        /// What is wrong.
        what: String,
        /// Where: coordinates, or an entry of a file.
        place: String,
        /// What to do.
        help: String,
    },
    /// The request cannot be met within a stated limit (memory), estimated before the work.
    #[error("limit exceeded: {what}")]
    Limit {
        /// What would be needed, and the limit.
        what: String,
        /// What to do.
        help: String,
    },
    /// A mesh is not valid. The mesher never writes such a mesh.
    #[error("invalid mesh: {what} at {place}")]
    Mesh {
        /// What is wrong.
        what: String,
        /// Where.
        place: String,
        /// What to do.
        help: String,
    },
    /// The work was to stop: [`Progress::is_stopped`](crate::progress::Progress::is_stopped).
    #[error("stopped before the end")]
    Stopped,
    /// Something that a later version will do.
    #[error("not supported: {what}")]
    Unsupported {
        /// What was asked.
        what: String,
        /// What to do instead.
        help: String,
    },
}

impl Error {
    /// What the user can do about it: one sentence, or empty.
    pub fn help(&self) -> &str {
        match self {
            Error::Io { .. } => "check the path and its permissions",
            Error::Stopped => "give it more time",
            Error::Parse { help, .. }
            | Error::Domain { help, .. }
            | Error::Metric { help, .. }
            | Error::Limit { help, .. }
            | Error::Mesh { help, .. }
            | Error::Unsupported { help, .. } => help,
        }
    }

    /// An [`Error::Io`] from its two parts.
    pub fn io(path: impl Into<PathBuf>, source: std::io::Error) -> Self {
        Error::Io { path: path.into(), source }
    }

    /// A [`Error::Parse`] from its three parts.
    pub fn parse(place: impl Into<String>, what: impl Into<String>, help: impl Into<String>) -> Self {
        Error::Parse { place: place.into(), what: what.into(), help: help.into() }
    }

    /// A [`Error::Domain`] from its three parts.
    pub fn domain(what: impl Into<String>, place: impl Into<String>, help: impl Into<String>) -> Self {
        Error::Domain { what: what.into(), place: place.into(), help: help.into() }
    }

    /// A [`Error::Metric`] from its three parts.
    pub fn metric(what: impl Into<String>, place: impl Into<String>, help: impl Into<String>) -> Self {
        Error::Metric { what: what.into(), place: place.into(), help: help.into() }
    }
    /// A [`Error::Limit`] from its two parts.
    pub fn limit(what: impl Into<String>, help: impl Into<String>) -> Self {
        Error::Limit { what: what.into(), help: help.into() }
    }

    /// A [`Error::Mesh`] from its three parts.
    pub fn mesh(what: impl Into<String>, place: impl Into<String>, help: impl Into<String>) -> Self {
        Error::Mesh { what: what.into(), place: place.into(), help: help.into() }
    }

    /// An [`Error::Unsupported`] from its two parts.
    pub fn unsupported(what: impl Into<String>, help: impl Into<String>) -> Self {
        Error::Unsupported { what: what.into(), help: help.into() }
    }
}
