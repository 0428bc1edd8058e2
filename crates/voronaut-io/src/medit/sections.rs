//! Medit's files as a sequence of sections, each a keyword and numbers: as text, and in libMeshb's binary form.

use crate::codec::{At, Form, Kind, Order, Sink, Source};
use std::io::{self, BufRead, Write};
use std::str::FromStr;
use voronaut::Result;

/// The numbers of a file, one after the other, section by section. In binary files each section begins with its keyword's code and
/// the byte where the next begins.
pub(crate) struct Sections<'a> {
    pub(crate) source: Source<'a>,
    version: i64,
    /// The section that was begun last, for messages.
    section: String,
    /// Where the next section of a binary file begins; `None` behind the last.
    next: Option<u64>,
    /// What `Dimension` says, if it was read.
    pub(crate) dimension: Option<u8>,
}

impl<'a> Sections<'a> {
    /// Reads the head of a file, which tells whether it is text or binary, and of which byte order and version.
    ///
    /// # Errors
    /// [`Error::Parse`](voronaut::Error::Parse) of what begins otherwise, and of versions but 1 to 4;
    /// [`Error::Io`](voronaut::Error::Io) of what cannot be read.
    pub(crate) fn new(from: impl BufRead + 'a, file: &'a str) -> Result<Self> {
        let mut source = Source::new(from, file);
        // Text begins with a letter or white space, binary files with the number 1 in four bytes.
        let version = match source.ahead()?.first() {
            Some(1) => read_binary_head(&mut source, Order::Little)?,
            Some(0) => read_binary_head(&mut source, Order::Big)?,
            _ => read_head(&mut source)?,
        };
        let next = Some(source.position());
        Ok(Self { source, version, section: "the head of the file".to_owned(), next, dimension: None })
    }

    /// The keyword of the next section, as the format spells it where it is known; `None` behind the last.
    ///
    /// # Errors
    /// [`Error::Parse`](voronaut::Error::Parse) where the section before holds more or fewer numbers than it announced.
    pub(crate) fn next_section(&mut self) -> Result<Option<String>> {
        let found = if self.source.is_binary() { self.next_code()? } else { self.next_keyword()? };
        if let Some(name) = &found {
            self.section.clone_from(name);
        }
        Ok(found)
    }

    /// Passes over the rest of the section.
    ///
    /// # Errors
    /// As of [`Sections::numbers`].
    pub(crate) fn skip_section(&mut self) -> Result<()> {
        if self.source.is_binary() {
            let Some(next) = self.next else { return Ok(()) };
            return self.source.skip_bytes(next.saturating_sub(self.source.position()), At::head(&self.section));
        }
        while let Some(word) = self.source.next_word()? {
            if is_keyword(word.text) {
                self.source.unread();
                break;
            }
        }
        Ok(())
    }

    /// The number of rows of the section.
    ///
    /// # Errors
    /// As of [`Sections::whole`]; of numbers below 0.
    pub(crate) fn count(&mut self) -> Result<u64> {
        let kind = self.whole_kind();
        self.source.whole(kind, At::head(&self.section))
    }

    /// The next whole number: a vertex, a label.
    ///
    /// # Errors
    /// [`Error::Parse`](voronaut::Error::Parse) with line or byte where the file ends, or holds no such number.
    pub(crate) fn whole<T: TryFrom<i64> + FromStr>(&mut self, at: At<'_>) -> Result<T> {
        self.source.whole(self.whole_kind(), at)
    }

    /// As [`Sections::whole`], of the numbers that have 32 bits in all versions: the dimension, and the types of solutions.
    ///
    /// # Errors
    /// As of [`Sections::whole`].
    pub(crate) fn short<T: TryFrom<i64> + FromStr>(&mut self, at: At<'_>) -> Result<T> {
        self.source.whole(Kind::Signed(4), at)
    }

    /// The next finite numbers.
    ///
    /// # Errors
    /// As of [`Sections::whole`].
    pub(crate) fn numbers<const N: usize>(&mut self, at: At<'_>) -> Result<[f64; N]> {
        self.source.numbers(Kind::Float(if self.version == 1 { 4 } else { 8 }), at)
    }

    /// Reads the 2 or 3 of `Dimension`.
    ///
    /// # Errors
    /// [`Error::Parse`](voronaut::Error::Parse) of any other number.
    pub(crate) fn read_dimension(&mut self) -> Result<()> {
        let dimension: i64 = self.short(At::head("Dimension"))?;
        if !matches!(dimension, 2 | 3) {
            let what = format!("Dimension {dimension}, where 2 or 3 is expected");
            return Err(self.source.error(what, "write Dimension 2 for a planar file"));
        }
        self.dimension = Some(dimension as u8);
        Ok(())
    }

    /// The dimension, which the section needs.
    ///
    /// # Errors
    /// [`Error::Parse`](voronaut::Error::Parse) if there was none before.
    pub(crate) fn known_dimension(&self) -> Result<u8> {
        self.dimension.ok_or_else(|| {
            let what = format!("{} comes before Dimension", self.section);
            self.source.error(what, "write 'Dimension 2' below MeshVersionFormatted")
        })
    }

    fn whole_kind(&self) -> Kind {
        Kind::Signed(if self.version == 4 { 8 } else { 4 })
    }

    fn next_keyword(&mut self) -> Result<Option<String>> {
        let Some(word) = self.source.next_word()? else { return Ok(None) };
        if word.text.eq_ignore_ascii_case("End") {
            return Ok(None);
        }
        if is_keyword(word.text) {
            let known = KEYWORDS.into_iter().find(|(_, name)| name.eq_ignore_ascii_case(word.text));
            return Ok(Some(known.map_or(word.text, |(_, name)| name).to_owned()));
        }
        let before = &self.section;
        let what =
            format!("'{}' where the next section should begin: {before} is longer than announced", word.quoted());
        Err(word.place.error(what, format!("check the count of {before}, and the Dimension, against the rows below")))
    }

    fn next_code(&mut self) -> Result<Option<String>> {
        let (source, before) = (&mut self.source, &self.section);
        let Some(next) = self.next else { return Ok(None) };
        if source.position() != next {
            let what = format!("{before} ends here, and the file says that the next section begins at byte {next}");
            return Err(source.error(what, format!("check the count of {before}, the Dimension and the version")));
        }
        if source.is_at_end()? {
            return Err(source.error("the file ends without End", "the file is cut off: write it again"));
        }
        let at = At::head("a section");
        let code: i32 = source.whole(Kind::Signed(4), at)?;
        let next: i64 = source.whole(Kind::Signed(if self.version < 3 { 4 } else { 8 }), at)?;
        if code == code_of("End") {
            return Ok(None);
        }
        let here = source.position();
        self.next = match u64::try_from(next) {
            Ok(0) => None,
            Ok(next) if next >= here => Some(next),
            _ => {
                let what = format!("the section after this one should begin at byte {next}, which is before its own");
                return Err(source.error(what, "the file is damaged: write it again"));
            }
        };
        let known = KEYWORDS.into_iter().find(|(known, _)| *known == code);
        Ok(Some(known.map_or_else(|| format!("section {code}"), |(_, name)| name.to_owned())))
    }
}

/// The sections that matter here, and their numbers in binary files, as libMeshb has them: first [`READ`] sections of meshes that
/// are read, then others whose names are known.
pub(super) const KEYWORDS: [(i32, &str); 33] = [
    (3, "Dimension"),
    (4, "Vertices"),
    (5, "Edges"),
    (6, "Triangles"),
    (7, "Quadrilaterals"),
    (8, "Tetrahedra"),
    (9, "Prisms"),
    (10, "Hexahedra"),
    (13, "Corners"),
    (14, "Ridges"),
    (15, "RequiredVertices"),
    (16, "RequiredEdges"),
    (17, "RequiredTriangles"),
    (18, "RequiredQuadrilaterals"),
    (49, "Pyramids"),
    (24, "TrianglesP2"),
    (25, "EdgesP2"),
    (90, "TrianglesP3"),
    (92, "EdgesP3"),
    (125, "BezierBasis"),
    (127, "EdgesP2Ordering"),
    (128, "EdgesP3Ordering"),
    (129, "TrianglesP2Ordering"),
    (130, "TrianglesP3Ordering"),
    (19, "TangentAtEdgeVertices"),
    (20, "NormalAtVertices"),
    (54, "End"),
    (59, "Tangents"),
    (60, "Normals"),
    (62, "SolAtVertices"),
    (63, "SolAtEdges"),
    (64, "SolAtTriangles"),
    (66, "SolAtTetrahedra"),
];

pub(super) const READ: usize = 24;

/// The code of a section that is known.
///
/// # Panics
/// If it is not.
fn code_of(name: &str) -> i32 {
    KEYWORDS.iter().find(|(_, known)| *known == name).expect("a section of the list").0
}

const VERSIONS: std::ops::RangeInclusive<i64> = 1..=4;

/// Reads `MeshVersionFormatted V`, which opens every text.
fn read_head(source: &mut Source<'_>) -> Result<i64> {
    let at = At::head("MeshVersionFormatted");
    let word = source.word(at)?;
    if !word.text.eq_ignore_ascii_case(at.section) {
        let what = format!("the file begins with '{}', not with MeshVersionFormatted", word.quoted());
        return Err(word.place.error(what, "give a file in one of Medit's formats"));
    }
    let word = source.word(at)?;
    let version = word.whole(at)?;
    // bamg's manual writes 0, and as text all versions read alike.
    if version == 0 || VERSIONS.contains(&version) {
        return Ok(version);
    }
    Err(word.place.error(format!("MeshVersionFormatted {version} does not exist"), "save the file as version 2"))
}

/// Reads the number 1 that tells the byte order, and the version.
fn read_binary_head(source: &mut Source<'_>, order: Order) -> Result<i64> {
    source.be_binary(order);
    let at = At::head("the file");
    if source.whole::<i32>(Kind::Signed(4), at)? != 1 {
        let what = "the file begins neither with MeshVersionFormatted nor with the number 1 in four bytes";
        return Err(source.place_of(0).error(what, "give a file in one of Medit's formats"));
    }
    let version = source.whole(Kind::Signed(4), at)?;
    if VERSIONS.contains(&version) {
        return Ok(version);
    }
    Err(source.place_of(4).error(format!("version {version} does not exist"), "save the file as version 2"))
}

fn is_keyword(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_alphabetic())
}

/// A file that is being written.
pub(crate) struct Writer<'a> {
    /// Where the numbers of a section go.
    pub(crate) sink: Sink<'a>,
    /// Whether positions have 64 bits.
    is_wide: bool,
}

/// Binary files that may have more bytes get positions of 64 bits; half of what 32 bits could say.
const NARROW: u64 = 1 << 30;

impl<'a> Writer<'a> {
    /// Writes the head of a file, which will have `bytes` bytes if it is binary, at most.
    pub(crate) fn new(form: Form, dimension: u8, bytes: u64, out: &'a mut dyn Write) -> io::Result<Self> {
        let mut writer = Self { sink: Sink::new(form, out), is_wide: bytes > NARROW };
        if writer.sink.is_binary() {
            writer.sink.put_all([1, if writer.is_wide { 3 } else { 2 }]);
            writer.keyword("Dimension", 4);
            writer.sink.put(i32::from(dimension));
        } else {
            writer.sink.line(format_args!("MeshVersionFormatted 2\n\nDimension {dimension}"))?;
        }
        Ok(writer)
    }

    /// Begins a section of so many rows, of so many bytes each if it is binary, behind `head` numbers of 32 bits.
    pub(crate) fn section(&mut self, name: &str, rows: usize, bytes: usize, head: &[i32]) -> io::Result<()> {
        if self.sink.is_binary() {
            self.keyword(name, 4 + 4 * head.len() as u64 + rows as u64 * bytes as u64);
            let rows = i32::try_from(rows).map_err(|_| io::Error::other("more than 2^31 rows in a binary section"))?;
            self.sink.put(rows);
        } else {
            self.sink.line(format_args!("\n{name}\n{rows}"))?;
        }
        self.sink.row(head.iter().copied())
    }

    /// Ends the file.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        if !self.sink.is_binary() {
            return self.sink.line(format_args!("\nEnd"));
        }
        self.sink.put(code_of("End"));
        self.position(0);
        self.sink.end_row()
    }

    /// Begins a binary section with so many bytes behind its keyword and the position of the next.
    fn keyword(&mut self, name: &str, bytes: u64) {
        self.sink.put(code_of(name));
        self.position(self.sink.written() + if self.is_wide { 8 } else { 4 } + bytes);
    }

    fn position(&mut self, byte: u64) {
        if self.is_wide { self.sink.put(byte) } else { self.sink.put(byte as u32) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_are_told_apart_by_their_keywords() {
        let text = "meshversionformatted 2\nDimension\n3 Normals 1\n0 -1.e0 .5\nEdges 0 END 7";
        let mut sections = Sections::new(text.as_bytes(), "a.mesh").unwrap();
        let next = |sections: &mut Sections<'_>| {
            let name = sections.next_section()?;
            Result::Ok(name.map(|name| format!("{name} {}", sections.source.place())))
        };
        assert_eq!(next(&mut sections).unwrap().unwrap(), "Dimension a.mesh:2");
        sections.read_dimension().unwrap();
        assert_eq!(sections.known_dimension().unwrap(), 3);
        assert_eq!(next(&mut sections).unwrap().unwrap(), "Normals a.mesh:3");
        sections.skip_section().unwrap();
        assert_eq!(next(&mut sections).unwrap().unwrap(), "Edges a.mesh:5");
        let error = next(&mut sections).unwrap_err().to_string();
        assert!(error.starts_with("a.mesh:5: '0' where the next section should begin: Edges is longer"), "{error}");
        assert_eq!(next(&mut sections).unwrap(), None);
    }

    #[test]
    fn binary_files_of_either_order() {
        for order in [i32::to_le_bytes, i32::to_be_bytes] {
            let file: Vec<u8> = [1, 2, 3, 20, 2, 900, 28, 54, 0].into_iter().flat_map(order).collect();
            let mut sections = Sections::new(file.as_slice(), "a.meshb").unwrap();
            assert_eq!(sections.next_section().unwrap(), Some("Dimension".into()));
            let early = sections.next_section().unwrap_err();
            assert!(early.to_string().starts_with("a.meshb, byte 16: Dimension ends here, and the"), "{early}");
            sections.read_dimension().unwrap();
            assert_eq!(sections.known_dimension().unwrap(), 2);
            assert_eq!(sections.next_section().unwrap(), Some("section 900".into()));
            sections.skip_section().unwrap();
            assert_eq!(sections.next_section().unwrap(), None);
        }
        for (numbers, expected) in [
            (vec![1, 9], "a.meshb, byte 4: version 9 does not exist"),
            (vec![1], "a.meshb, byte 4: the file ends in the head of the file"),
            (vec![257, 2], "a.meshb, byte 0: the file begins neither with MeshVersionFormatted nor"),
            (vec![1, 2], "a.meshb, byte 8: the file ends without End"),
            (vec![1, 2, 4, 15, 7], "a.meshb, byte 16: the section after this one should begin at byte 15, which"),
            (vec![1, 2, 4, 60, 7], "a.meshb, byte 20: the file ends in the head of Vertices"),
        ] {
            let file: Vec<u8> = numbers.into_iter().flat_map(i32::to_le_bytes).collect();
            let read = || -> Result<()> {
                let mut sections = Sections::new(file.as_slice(), "a.meshb")?;
                while sections.next_section()?.is_some() {
                    sections.skip_section()?;
                }
                Ok(())
            };
            let error = read().unwrap_err();
            assert!(error.to_string().starts_with(expected) && !error.help().is_empty(), "{error}");
        }
    }
}
