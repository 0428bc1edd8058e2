//! What readers make of a file, and whether that is good.

use crate::sample::Sample;
use peak_alloc::PeakAlloc;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, MutexGuard, PoisonError};
use voronaut::{Error, Result};
use voronaut_io::{Document, freefem, geojson, gmsh, medit, obj, off, ply, points, poly, sol, stl, vtk};

#[global_allocator]
static MEMORY: PeakAlloc = PeakAlloc;

/// What must be held while files are read: all memory is counted together.
pub(crate) fn one_at_a_time() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// No file here has more than some thousand bytes; what readers may need for that, with buffers.
const MOST_MEMORY: usize = 1 << 20;

const PLACE: &str = "the file";

/// Which reader a file is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reader {
    Freefem,
    Geojson,
    Gmsh,
    Medit,
    Obj,
    Off,
    Ply,
    Points,
    Poly,
    Sol,
    Stl,
    Vtk,
}

/// What came of it.
#[derive(Debug)]
pub(crate) enum Outcome {
    /// A mesh or the like, all of whose numbers refer to something and are finite.
    Sound,
    /// An error that says what, where and what to do.
    Refused,
    /// Anything else: what is wrong.
    #[expect(dead_code, reason = "shown when the test fails")]
    Fault(String),
}

/// Reads bytes as a sample's format.
pub(crate) fn read(sample: &Sample, bytes: &[u8]) -> Outcome {
    MEMORY.reset_peak_usage();
    let before = MEMORY.current_usage();
    let found = catch_unwind(AssertUnwindSafe(|| read_as(sample.reader, bytes)));
    let taken = MEMORY.peak_usage().saturating_sub(before);
    if taken > MOST_MEMORY {
        return Outcome::Fault(format!("{taken} bytes of memory"));
    }
    match found {
        Err(_) => Outcome::Fault("a panic".into()),
        Ok(Ok(true)) => Outcome::Sound,
        Ok(Ok(false)) => Outcome::Fault("read, but not sound".into()),
        Ok(Err(error)) if is_good(&error) => Outcome::Refused,
        Ok(Err(error)) => Outcome::Fault(format!("an error that does not say what it should: {error:?}")),
    }
}

/// Whether what was read is sound.
fn read_as(reader: Reader, bytes: &[u8]) -> Result<bool> {
    let text = || {
        let help = "readers of whole texts get no others: read_text";
        std::str::from_utf8(bytes).map_err(|_| Error::parse(format!("{PLACE}:1"), "no text", help))
    };
    let document = match reader {
        Reader::Freefem => freefem::read(bytes, PLACE)?.into(),
        Reader::Gmsh => gmsh::read(bytes, PLACE)?,
        Reader::Vtk => vtk::read(bytes, PLACE)?,
        Reader::Medit => medit::read(bytes, PLACE)?,
        Reader::Obj => obj::read(bytes, PLACE)?,
        Reader::Off => off::read(bytes, PLACE)?.into(),
        Reader::Ply => ply::read(bytes, PLACE)?,
        Reader::Stl => stl::read(bytes, PLACE)?.into(),
        Reader::Sol => {
            let read = sol::read_all(bytes, PLACE)?;
            let all = || read.vertices.iter().chain(&read.triangles);
            let is_finite =
                all().all(|values| (0..values.count()).all(|i| values.row(i).iter().all(|x| x.is_finite())));
            return Ok(is_finite && all().next().is_some());
        }
        Reader::Poly => {
            let read = poly::read(bytes, PLACE)?;
            let points = read.points.iter().chain(&read.holes).all(|p| p.is_finite());
            return Ok(points && read.segments.as_flattened().iter().all(|&v| (v as usize) < read.points.len()));
        }
        Reader::Points => {
            let text = text()?;
            let (plane, space) = (points::read::<2>(text, PLACE), points::read::<3>(text, PLACE));
            return Ok(if let Ok(points) = plane {
                points.iter().flat_map(|(_, p)| p).all(|x| x.is_finite())
            } else {
                space?.iter().flat_map(|(_, p)| p).all(|x| x.is_finite())
            });
        }
        Reader::Geojson => {
            let read = geojson::read(text()?, PLACE)?;
            let mut points = read.polygons.iter().flat_map(|p| &p.rings).flat_map(|ring| &ring.points);
            return Ok(points.all(|p| p.is_finite()));
        }
    };
    Ok(is_sound(&document))
}

fn is_sound(document: &Document) -> bool {
    let mesh = &document.mesh;
    let counts = [mesh.points.len(), mesh.triangles.len(), mesh.edges.len()];
    let fields = [(&document.fields.vertices, counts[0]), (&document.fields.triangles, counts[1])];
    mesh.check_numbers().is_ok()
        && mesh.points.as_flattened().iter().all(|x| x.is_finite())
        && counts == [&mesh.point_labels, &mesh.triangle_labels, &mesh.edge_labels].map(Vec::len)
        && fields.iter().all(|(fields, count)| fields.iter().all(|field| field.values.count() == *count))
}

/// Whether an error says what to do, and where it is: in which file, and if that is malformed, in which line, byte or feature.
fn is_good(error: &Error) -> bool {
    let place = match error {
        Error::Parse { place, .. } | Error::Domain { place, .. } => place,
        Error::Unsupported { what, .. } => return what.contains(PLACE) && !error.help().is_empty(),
        _ => return false,
    };
    let is_digit = |rest: &str| rest.starts_with(|c: char| c.is_ascii_digit());
    let mut behind = place.split(PLACE).skip(1);
    let marks = [":", ", byte ", ", feature "];
    let is_numbered = behind.any(|rest| marks.iter().any(|mark| rest.strip_prefix(mark).is_some_and(is_digit)));
    !error.help().is_empty() && is_numbered
}
