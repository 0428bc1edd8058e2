//! Which canvas.

use crate::error::{Error, Result};
use std::fmt;
use std::str::FromStr;

/// The discretisation that distances travel on; its names are those users type (`--canvas`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// `intrinsic`: refined evenly in the metric, geodesic edge lengths, flipped by lengths alone.
    #[default]
    Intrinsic,
    /// `isotropic`: a Euclidean Delaunay triangulation as fine everywhere as the metric is in its finest direction.
    Isotropic,
    /// `starset`: even in the metric, with the Delaunay stars of the vertices, each in its vertex's own metric, as the graph
    /// that methods without triangles travel on.
    StarSet,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 3] = [Kind::Intrinsic, Kind::Isotropic, Kind::StarSet];
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Kind::Intrinsic => "intrinsic",
            Kind::Isotropic => "isotropic",
            Kind::StarSet => "starset",
        })
    }
}

impl FromStr for Kind {
    type Err = Error;

    /// # Errors
    /// [`Error::Parse`] of any other name.
    fn from_str(name: &str) -> Result<Self> {
        match name {
            "intrinsic" => Ok(Kind::Intrinsic),
            "isotropic" => Ok(Kind::Isotropic),
            "starset" => Ok(Kind::StarSet),
            _ => {
                Err(Error::parse(format!("canvas {name}"), "no such canvas", "choose intrinsic, isotropic or starset"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_written_and_others_refused() {
        for kind in Kind::ALL {
            assert_eq!(kind.to_string().parse::<Kind>().unwrap(), kind);
        }
        let error = "grid".parse::<Kind>().unwrap_err();
        assert_eq!(error.to_string(), "canvas grid: no such canvas");
        assert_eq!(error.help(), "choose intrinsic, isotropic or starset");
    }
}
