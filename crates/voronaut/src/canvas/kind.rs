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
    /// `starset`: the Delaunay stars of the vertices, each in its vertex's own metric: a graph, not a triangulation.
    StarSet,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 3] = [Kind::Intrinsic, Kind::Isotropic, Kind::StarSet];

    /// Nothing for a canvas that is a triangulation, as fast marching and the diagram need it.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for a star set.
    pub fn demand_triangulation(self) -> Result<()> {
        if self != Kind::StarSet {
            return Ok(());
        }
        let what = "fast marching (--geodesic march) on a star set, which has no triangles to march through".into();
        let help = "star sets serve methods that travel on graphs (stvd, dijkstra, konukoglu); for marching choose \
                    --canvas intrinsic or isotropic"
            .into();
        Err(Error::Unsupported { what, help })
    }
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
            assert_eq!(kind.demand_triangulation().is_ok(), kind != Kind::StarSet);
        }
        let error = "grid".parse::<Kind>().unwrap_err();
        assert_eq!(error.to_string(), "canvas grid: no such canvas");
        assert_eq!(error.help(), "choose intrinsic, isotropic or starset");
        let error = Kind::StarSet.demand_triangulation().unwrap_err();
        assert!(error.to_string().contains("no triangles to march through"), "{error}");
        assert!(error.help().contains("stvd"), "{}", error.help());
    }
}
