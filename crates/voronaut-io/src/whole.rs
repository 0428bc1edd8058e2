//! Files that appear as a whole or not at all.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use voronaut::{Error, Result};

/// Writes a file by way of a temporary one in the same directory, which takes its name once it is complete: whoever
/// reads the name sees the old file or the new one. Permissions are those of the old file, or those that any new file
/// gets; a symbolic link stays one. What is no regular file (a pipe, `/dev/stdout`) is written directly.
///
/// # Errors
/// [`Error::Io`] with the path.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    write_with(path, |out| out.write_all(bytes))
}

/// As [`write()`], of a file that is written piece by piece, and never in memory as a whole.
///
/// # Errors
/// [`Error::Io`] with the path, of what `fill` says too.
pub fn write_with(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<()> {
    demand_directory(path)?;
    replace(path, fill).map_err(|source| Error::io(path, source))
}

/// Checks, before long work, that a file can be put at a path: its directory exists and it is no directory itself.
///
/// # Errors
/// [`Error::Io`] with the directory that is missing, or the path that is a directory.
pub fn demand_directory(path: &Path) -> Result<()> {
    let fault = |path: &Path, kind: io::ErrorKind| Error::io(path, kind.into());
    let directory = directory(path);
    if path.file_name().is_none() || path.is_dir() {
        return Err(fault(path, io::ErrorKind::IsADirectory));
    }
    match fs::metadata(&directory) {
        Ok(found) if found.is_dir() => Ok(()),
        Ok(_) => Err(fault(&directory, io::ErrorKind::NotADirectory)),
        Err(source) => Err(Error::io(directory, source)),
    }
}

/// The one name of the file at a path, by which two spellings of it (`a.obj`, `./a.obj`) are known to be the same.
///
/// # Errors
/// As [`demand_directory`].
pub fn place(path: &Path) -> Result<PathBuf> {
    demand_directory(path)?;
    let directory = fs::canonicalize(directory(path)).map_err(|source| Error::io(path, source))?;
    let place = followed(&directory.join(path.file_name().unwrap_or_default()));
    let place = place.map_err(|source| Error::io(path, source))?;
    // A link may say where it leads in roundabout ways.
    let target = fs::canonicalize(self::directory(&place)).ok().zip(place.file_name());
    Ok(target.map(|(directory, name)| directory.join(name)).unwrap_or(place))
}

/// Where a chain of symbolic links ends, whether there is a file or not.
fn followed(path: &Path) -> io::Result<PathBuf> {
    /// As many as Linux follows.
    const LINKS: usize = 40;
    let mut path = path.to_path_buf();
    for _ in 0..LINKS {
        match fs::read_link(&path) {
            Ok(target) => path = directory(&path).join(target),
            Err(_) => return Ok(path),
        }
    }
    Err(io::Error::other("too many symbolic links"))
}

/// Temporary files and directories that are not yet gone. Whoever makes one, or gives it its name, holds the lock.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes the temporary files and directories that there are, and lets no other thread make one, or finish a file, ever after: for a
/// program that ends in the midst of its work.
pub fn abandon() {
    let mut left = unfinished();
    for path in left.drain(..) {
        // What cannot be removed is no reason to go on.
        let _ = fs::remove_file(&path).or_else(|_| fs::remove_dir_all(&path));
    }
    std::mem::forget(left);
}

/// A directory for temporary files, which goes with this value, or with [`abandon`].
pub struct Scratch {
    directory: tempfile::TempDir,
}

impl Scratch {
    /// # Errors
    /// [`Error::Io`] with the directory in which none can be made.
    pub fn new() -> Result<Self> {
        let mut unfinished = unfinished();
        let made = tempfile::Builder::new().prefix("voronaut-").tempdir();
        let directory = made.map_err(|source| Error::io(std::env::temp_dir(), source))?;
        unfinished.push(directory.path().to_path_buf());
        Ok(Self { directory })
    }
}

impl AsRef<Path> for Scratch {
    fn as_ref(&self) -> &Path {
        self.directory.path()
    }
}

fn replace(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let old = fs::metadata(path).ok();
    if old.as_ref().is_some_and(|old| !old.is_file()) {
        return buffered(&mut fs::OpenOptions::new().write(true).open(path)?, fill);
    }
    let target = followed(path)?;
    let mut file = {
        let mut unfinished = unfinished();
        let file = builder().tempfile_in(directory(&target))?;
        unfinished.push(file.path().to_path_buf());
        file
    };
    let temporary = file.path().to_path_buf();
    buffered(file.as_file_mut(), fill)?;
    if let Some(old) = old {
        file.as_file().set_permissions(old.permissions())?;
    }
    let mut unfinished = unfinished();
    file.persist(&target).map_err(|failed| failed.error)?;
    unfinished.retain(|path| *path != temporary);
    Ok(())
}

fn buffered(file: &mut fs::File, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    const BUFFER: usize = 1 << 17;
    let mut out = io::BufWriter::with_capacity(BUFFER, file);
    fill(&mut out)?;
    out.flush()
}

fn directory(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent.into(),
        _ => PathBuf::from("."),
    }
}

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".voronaut-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Temporary files are private by default; the umask takes away from this what it takes from any new file.
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn replaces_as_a_whole_and_leaves_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("mesh.obj");
        write(&path, b"first and longer").unwrap();
        write(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    /// However a link says where it leads.
    #[test]
    #[cfg(unix)]
    fn a_link_and_what_it_leads_to_are_one_place() {
        let directory = tempfile::tempdir().unwrap();
        let at = |name: &str| directory.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        std::os::unix::fs::symlink("sub/../real.mesh", at("link.mesh")).unwrap();
        assert_eq!(place(&at("link.mesh")).unwrap(), place(&at("real.mesh")).unwrap());
    }

    #[test]
    fn missing_directory_is_named() {
        let directory = tempfile::tempdir().unwrap();
        let error = write(&directory.path().join("nowhere/mesh.obj"), b"").unwrap_err();
        assert!(error.to_string().contains("nowhere:"), "{error}");
        assert!(write(directory.path(), b"").is_err());
        assert!(write(Path::new(""), b"").is_err());
        assert!(write(Path::new(".."), b"").is_err());
    }

    #[cfg(unix)]
    #[test]
    fn permissions_are_those_of_any_new_file() {
        use std::os::unix::fs::PermissionsExt;
        let directory = tempfile::tempdir().unwrap();
        let (ours, plain) = (directory.path().join("ours"), directory.path().join("plain"));
        write(&ours, b"").unwrap();
        fs::write(&plain, b"").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
        fs::set_permissions(&ours, fs::Permissions::from_mode(0o640)).unwrap();
        write(&ours, b"again").unwrap();
        assert_eq!(mode(&ours) & 0o777, 0o640);
    }

    #[cfg(unix)]
    #[test]
    fn links_stay_links_and_devices_devices() {
        let directory = tempfile::tempdir().unwrap();
        let (file, link) = (directory.path().join("file"), directory.path().join("link"));
        fs::write(&file, b"old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write(&link, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        write(Path::new("/dev/null"), b"gone").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}
