//! The methods by their names.

use crate::error::{Error, Result};
use std::fmt;
use std::str::FromStr;

/// How distances are computed (`--geodesic`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// `march`: fast marching by lengths on the intrinsic canvas (`Marching`).
    #[default]
    March,
    /// `stvd`, or `stvd:window=8`: short-term vector Dijkstra (`Stvd`).
    Stvd {
        /// How many edges count as one straight piece.
        window: usize,
    },
    /// `dijkstra`: along the edges of the canvas (`Dijkstra`).
    Dijkstra,
    /// `konukoglu`: recursive anisotropic fast marching (`Konukoglu`).
    Konukoglu,
    /// `lbr`: FM-LBR on a Cartesian grid of its own (`Lattice`); distances only.
    Lbr,
    /// `heat`: the heat method (`Heat`); distances only.
    Heat,
}

/// The window of [`Method::Stvd`] unless told otherwise: that of the report's authors.
pub(crate) const STVD_WINDOW: usize = 8;

impl Method {
    /// All methods, those with a parameter at its default.
    pub const ALL: [Method; 6] =
        [Self::March, Self::Stvd { window: STVD_WINDOW }, Self::Dijkstra, Self::Konukoglu, Self::Lbr, Self::Heat];

    /// Whether it gives every vertex the colour of its source, so that diagrams can be made by it.
    pub(crate) fn drives_diagrams(self) -> bool {
        !matches!(self, Self::Lbr | Self::Heat)
    }

    /// Refuses methods that do not drive diagrams.
    ///
    /// # Errors
    /// [`Error::Unsupported`], with those that do.
    pub fn demand_diagrams(self) -> Result<()> {
        if self.drives_diagrams() {
            return Ok(());
        }
        let what = format!("a diagram by {self}, which gives distances alone");
        Err(Error::unsupported(what, format!("use one of {}", Self::names(Self::drives_diagrams))))
    }

    /// The names of some methods, for messages.
    pub(crate) fn names(of: impl Fn(Self) -> bool) -> String {
        let names: Vec<&str> = Self::ALL.into_iter().filter(|&method| of(method)).map(Self::name).collect();
        names.join(", ")
    }

    /// The name without parameters.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Method::March => "march",
            Method::Stvd { .. } => "stvd",
            Method::Dijkstra => "dijkstra",
            Method::Konukoglu => "konukoglu",
            Method::Lbr => "lbr",
            Method::Heat => "heat",
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())?;
        match self {
            Method::Stvd { window } if *window != STVD_WINDOW => write!(f, ":window={window}"),
            _ => Ok(()),
        }
    }
}

impl serde::Serialize for Method {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl FromStr for Method {
    type Err = Error;

    /// # Errors
    /// [`Error::Parse`] of another name, or a window that is no number from 1 up.
    fn from_str(text: &str) -> Result<Self> {
        if let Some(parameters) = text.strip_prefix("stvd:") {
            let window = parameters.strip_prefix("window=").and_then(|number| number.parse().ok());
            let help = "write stvd:window=8, with a number of edges from 1 up";
            let window = window.filter(|&w: &usize| w > 0);
            return window
                .map(|window| Method::Stvd { window })
                .ok_or_else(|| Error::parse(format!("geodesic {text}"), "no such window", help));
        }
        Self::ALL.into_iter().find(|method| method.name() == text).ok_or_else(|| {
            let help = format!("choose one of {}", Self::names(|_| true));
            Error::parse(format!("geodesic {text}"), "no such method", help)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for method in Method::ALL.into_iter().chain([Method::Stvd { window: 20 }]) {
            assert_eq!(method.to_string().parse::<Method>().unwrap(), method);
        }
        assert_eq!("stvd:window=8".parse::<Method>().unwrap(), Method::Stvd { window: 8 });
        let error = "stvd:window=0".parse::<Method>().unwrap_err();
        assert!(error.to_string().contains("no such window") && error.help().contains("window=8"));
        let error = "mmp".parse::<Method>().unwrap_err();
        assert_eq!(error.to_string(), "geodesic mmp: no such method");
        assert!(error.help().contains("march, stvd, dijkstra"), "{}", error.help());
    }
}
