//! Which diagram.

use crate::error::named;
use crate::geometry::Point;
use crate::metric::MetricField;

/// By what distance a place is given to its nearest seed; its names are those users type (`--voronoi`).
///
/// The last two measure along the straight segment, with one tensor for all of it: what they call near may be far on the
/// way, and in a domain with holes or bays they see through walls. Their cells may fall into parts of which only one holds
/// the seed (`Diagram::orphans`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Kind {
    /// `riemannian`: by the geodesic distance, along the canvas.
    #[default]
    Riemannian,
    /// `du-wang`: |x - p| in the metric at the place x (Du and Wang 2005).
    DuWang,
    /// `labelle-shewchuk`: |x - p| in the metric at the seed p (Labelle and Shewchuk 2003).
    LabelleShewchuk,
}

named!(Kind, "Voronoi diagram", [Riemannian = "riemannian", DuWang = "du-wang", LabelleShewchuk = "labelle-shewchuk"]);

/// Which tensor a chord is measured with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Chords {
    /// That at the seed (Labelle and Shewchuk).
    InMetricOfSeed,
    /// That at the place whose distance it is (Du and Wang).
    InMetricOfPlace,
}

impl Chords {
    /// The distance of a place from a seed.
    pub(super) fn measured(self, field: &dyn MetricField, seed: Point, place: Point) -> f64 {
        let frozen_at = match self {
            Chords::InMetricOfSeed => seed,
            Chords::InMetricOfPlace => place,
        };
        field.at(frozen_at).length(place - seed)
    }
}
