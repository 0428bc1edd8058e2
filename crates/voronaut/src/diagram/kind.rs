//! Which diagram.

use crate::error::{Error, Result};
use std::fmt;
use std::str::FromStr;

/// By what distance a place is given to its nearest seed; its names are those users type (`--voronoi`).
///
/// The last two measure along the straight segment, with one tensor for all of it: what they call near may be far on the
/// way, and in a domain with holes or bays they see through walls. Their cells may fall into parts of which only one holds
/// the seed ([`super::Diagram::orphans`]).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// `riemannian`: by the geodesic distance, along the canvas.
    #[default]
    Riemannian,
    /// `du-wang`: |x - p| in the metric at the place x (Du and Wang 2005).
    DuWang,
    /// `labelle-shewchuk`: |x - p| in the metric at the seed p (Labelle and Shewchuk 2003).
    LabelleShewchuk,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 3] = [Kind::Riemannian, Kind::DuWang, Kind::LabelleShewchuk];
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Kind::Riemannian => "riemannian",
            Kind::DuWang => "du-wang",
            Kind::LabelleShewchuk => "labelle-shewchuk",
        })
    }
}

impl FromStr for Kind {
    type Err = Error;

    /// # Errors
    /// [`Error::Parse`] of any other name.
    fn from_str(name: &str) -> Result<Self> {
        Self::ALL.into_iter().find(|kind| kind.to_string() == name).ok_or_else(|| {
            let help = "choose riemannian, du-wang or labelle-shewchuk";
            Error::parse(format!("Voronoi diagram {name}"), "no such diagram", help)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_written_and_others_refused() {
        for kind in Kind::ALL {
            assert_eq!(kind.to_string().parse::<Kind>().unwrap(), kind);
            assert_eq!(serde_json::to_value(kind).unwrap(), kind.to_string(), "as in reports");
        }
        let error = "euclidean".parse::<Kind>().unwrap_err();
        assert_eq!(error.to_string(), "Voronoi diagram euclidean: no such diagram");
        assert_eq!(error.help(), "choose riemannian, du-wang or labelle-shewchuk");
    }
}
