//! What was mended of a surface, in numbers and in words.

use crate::error::counted;
use serde::Serialize;

/// What was found wrong with a mesh of a surface, and mended or left; and what the reader of its file says.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Mended {
    mends: Vec<Mend>,
    #[serde(skip)]
    notes: Vec<String>,
}

/// One kind of damage.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Mend {
    /// Which.
    pub kind: Damage,
    /// How often.
    pub count: usize,
    /// Where, the first few times; vertices and triangles have the numbers of the file, from 1.
    pub places: Vec<String>,
}

/// Kinds of damage, in the order in which they are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Damage {
    /// Triangles at a vertex whose coordinates are not finite: dropped (with repair).
    NotFinite,
    /// Vertices at the place of another: joined to it.
    Welded,
    /// Triangles with a vertex twice or without area: dropped, their neighbours joined.
    Degenerate,
    /// Triangles with the vertices of another: dropped.
    Duplicate,
    /// Edges with vertices inside them: their triangles cut there (with repair).
    TJunction,
    /// Edges of more than two triangles: cut, the straightest pairs stay together (with repair).
    Edge,
    /// Triangles of small pieces that hang on such an edge: dropped (with repair).
    Fin,
    /// Edges where more than two borders lie on each other: left as borders.
    Borders,
    /// Edges at which a one-sided surface was cut open (with repair).
    OneSided,
    /// Seams that stay open because closing them would make a one-sided surface.
    Seam,
    /// Vertices in which sheets met in a point: one for each sheet (with repair).
    Point,
    /// Triangles that turn another way than most of their component: turned.
    Turned,
    /// Small holes: closed (with repair).
    Closed,
    /// Small holes: left open.
    Open,
    /// Entries of the list of edges that are edges of no triangle, or twice in it: dropped.
    Listed,
}

impl Damage {
    /// What it is and what was done: of `[one|many]` the first word is said of one.
    fn words(self) -> &'static str {
        match self {
            Self::NotFinite => {
                "[triangle with a coordinate that is|triangles with coordinates that are] not finite [was|were] dropped"
            }
            Self::Welded => "[vertex|vertices] at the place of another [was|were] welded to it",
            Self::Degenerate => "[triangle|triangles] without area [was|were] dropped",
            Self::Duplicate => "duplicate [triangle was|triangles were] dropped",
            Self::TJunction => {
                "[T-junction was|T-junctions were] closed by cutting the [triangle beside it|triangles beside them]"
            }
            Self::Edge => "[edge|edges] of more than two triangles [was|were] cut",
            Self::Fin => {
                "[triangle of a small piece at an edge|triangles of small pieces at edges] of more than two triangles \
                 [was|were] dropped"
            }
            Self::Borders => "[edge|edges] where more than two borders meet [was|were] left open",
            Self::OneSided => "[edge|edges] of a one-sided surface [was|were] cut open",
            Self::Seam => "seam [edge was|edges were] left open: closed, the surface would be one-sided",
            Self::Point => "[vertex|vertices] in which sheets met in a point only [was|were] split",
            Self::Turned => "[triangle was|triangles were] turned to agree with [its|their] neighbours",
            Self::Closed => "small [hole was|holes were] closed",
            Self::Open => "small [hole was|holes were] left open (`repair` closes what looks like damage)",
            Self::Listed => {
                "listed [edge was|edges were] dropped: no triangle has [it, or it is|them, or they are] there twice"
            }
        }
    }
}

/// Places that are kept of each kind.
const PLACES: usize = 3;

impl Mended {
    /// How often a kind of damage was found.
    pub(crate) fn count(&self, kind: Damage) -> usize {
        self.mends.iter().find(|mend| mend.kind == kind).map_or(0, |mend| mend.count)
    }

    /// As it is, behind what the reader of the file says.
    #[must_use]
    pub fn with_notes(self, notes: &[String]) -> Self {
        Self { notes: notes.to_vec(), ..self }
    }

    /// What the reader of the file says, and one sentence for each kind, for users: "3 duplicate triangles were dropped (first: triangle 7)".
    pub fn sentences(&self) -> impl Iterator<Item = String> + '_ {
        let mends = self.mends.iter().map(|mend| {
            let first = mend.places.first().map(|place| format!(" (first: {place})")).unwrap_or_default();
            format!("{}{first}", counted(mend.count, mend.kind.words()))
        });
        self.notes.iter().cloned().chain(mends)
    }

    /// What was found in another look, at what the first one made.
    pub(super) fn append(&mut self, more: Self) {
        for mend in more.mends {
            match self.mends.iter_mut().find(|known| known.kind == mend.kind) {
                Some(known) => {
                    known.count += mend.count;
                    known.places.extend(mend.places);
                    known.places.truncate(PLACES);
                }
                None => self.mends.push(mend),
            }
        }
    }

    /// Whether the mesh had to be changed; triangles are turned by [`Surface::new`](crate::manifold::surface::Surface::new) anyway.
    pub(super) fn changes_the_mesh(&self) -> bool {
        let is_told_only = |kind| matches!(kind, Damage::Turned | Damage::Open | Damage::Borders | Damage::Seam);
        self.mends.iter().any(|mend| !is_told_only(mend.kind))
    }

    pub(super) fn add(&mut self, kind: Damage, place: String) {
        let at = match self.mends.binary_search_by_key(&kind, |mend| mend.kind) {
            Ok(at) => at,
            Err(at) => {
                self.mends.insert(at, Mend { kind, count: 0, places: Vec::new() });
                at
            }
        };
        let mend = &mut self.mends[at];
        mend.count += 1;
        if mend.places.len() < PLACES {
            mend.places.push(place);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sentences_count_and_name_the_first() {
        let mut mended = Mended::default();
        for i in [7, 9, 11, 13] {
            mended.add(Damage::Duplicate, format!("triangle {i}"));
        }
        mended.add(Damage::Welded, "vertex 2".into());
        let said: Vec<_> = mended.sentences().collect();
        assert_eq!(
            said,
            [
                "1 vertex at the place of another was welded to it (first: vertex 2)",
                "4 duplicate triangles were dropped (first: triangle 7)",
            ]
        );
        let told = serde_json::to_string(&mended).unwrap();
        assert!(
            told.ends_with(r#"{"kind":"duplicate","count":4,"places":["triangle 7","triangle 9","triangle 11"]}]"#)
        );
        assert_eq!((mended.count(Damage::Duplicate), mended.count(Damage::Edge)), (4, 0));
    }
}
