//! What a page may ask for.

use serde::Deserialize;

/// A question: JSON, which tells how many bytes of which files come behind it.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase")]
pub(crate) enum Request {
    /// Keeps a file under its name: what comes behind.
    Hold {
        /// As users see it.
        name: String,
    },
    /// A domain as it is, to be seen.
    Look {
        /// As for the program.
        domain: String,
    },
    /// A command of the program.
    Perform {
        /// Its name.
        command: String,
        /// Its options by their names, each with its values.
        options: Vec<(String, Vec<String>)>,
        /// Seeds that stand for the file `seeds`.
        #[serde(default)]
        seeds: Vec<Vec<f64>>,
    },
    /// The last mesh as a file.
    Write {
        /// Its name, whose ending is its format.
        name: String,
    },
}
