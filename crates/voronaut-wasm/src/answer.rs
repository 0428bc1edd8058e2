//! Answers: the length of a JSON text, the text, and bytes that it tells the places of.

use serde_json::{Value, json};
use voronaut::Error;
use voronaut_cli::{Usage, flagged};

/// An answer in the making.
pub(crate) struct Answer {
    told: Value,
    bytes: Vec<u8>,
}

/// What is not as it was asked.
pub(crate) enum Fault {
    /// Of the input or the result.
    Error(Error),
    /// Of the options.
    Usage(Usage),
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Self::Error(error)
    }
}

impl Answer {
    pub(crate) fn new(told: Value) -> Self {
        Self { told, bytes: Vec::new() }
    }

    /// Adds bytes under a name.
    pub(crate) fn with(mut self, name: &str, bytes: &[u8]) -> Self {
        // Numbers of eight bytes are read in place.
        self.bytes.resize(self.bytes.len().next_multiple_of(8), 0);
        self.told[name] = json!({ "at": self.bytes.len(), "bytes": bytes.len() });
        self.bytes.extend(bytes);
        self
    }

    /// Adds points under a name.
    pub(crate) fn with_points(self, name: &str, points: &[[f64; 3]]) -> Self {
        let bytes: Vec<u8> = points.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        self.with(name, &bytes)
    }

    /// Adds numbers of points under a name.
    pub(crate) fn with_numbers(self, name: &str, numbers: impl Iterator<Item = u32>) -> Self {
        let bytes: Vec<u8> = numbers.flat_map(u32::to_le_bytes).collect();
        self.with(name, &bytes)
    }

    /// What the program would say of a fault.
    pub(crate) fn of_fault(fault: &Fault) -> Self {
        let told = match fault {
            Fault::Usage(usage) => json!({ "kind": "usage", "what": usage.what, "help": "", "place": "" }),
            Fault::Error(error) => {
                let (kind, place) = match error {
                    Error::Io { path, .. } => ("file", path.display().to_string()),
                    Error::Parse { place, .. } => ("text", place.clone()),
                    Error::Domain { place, .. } => ("domain", place.clone()),
                    Error::Metric { place, .. } => ("metric", place.clone()),
                    Error::Mesh { place, .. } => ("mesh", place.clone()),
                    _ => ("work", String::new()),
                };
                json!({ "kind": kind, "what": flagged(&error.to_string()), "help": flagged(error.help()), "place": place })
            }
        };
        Self::new(json!({ "fault": told }))
    }

    /// As it is sent.
    pub(crate) fn packed(self) -> Vec<u8> {
        let mut text = self.told.to_string();
        // Bytes begin at a multiple of eight.
        text.extend(std::iter::repeat_n(' ', (4 + text.len()).next_multiple_of(8) - 4 - text.len()));
        let mut all = (text.len() as u32).to_le_bytes().to_vec();
        all.extend(text.as_bytes());
        all.extend(self.bytes);
        all
    }
}
