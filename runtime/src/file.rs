//! Files that are replaced as a whole: whoever reads one finds the old content or the new.
//!
//! The content is written to a file beside it, flushed to the disk and renamed over the old one, so
//! neither a full disk nor a killed process costs what was there. A process that is killed leaves
//! the file beside behind; the next one that replaces the same file removes it.

use std::ffi::OsString;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

/// The end of the name of a file that is not finished.
const UNFINISHED: &str = ".tltl.tmp";

/// Replaces the content of the file at `path`, or makes the file. It keeps its permissions and, as
/// far as the process may give it away, its owner; a symbolic link keeps pointing at it. What is no
/// file, such as a pipe, is written to.
///
/// ```
/// use tltl::file;
///
/// let path = std::env::temp_dir().join(format!("tltl-replace-{}", std::process::id()));
/// file::replace(&path, b"old")?;
/// file::replace(&path, b"new")?;
/// assert_eq!(std::fs::read(&path)?, b"new");
/// # std::fs::remove_file(path)?;
/// # Ok::<(), std::io::Error>(())
/// ```
///
/// # Errors
/// If it cannot be written, or may not be. What was there before is then still there.
#[inline]
pub fn replace(path: &Path, content: &[u8]) -> io::Result<()> {
    // A link is not replaced, but the file that it points at.
    let path = &fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let before = match OpenOptions::new().write(true).open(path) {
        Ok(mut file) => {
            let before = file.metadata()?;
            if !before.is_file() {
                return file.write_all(content);
            }
            Some(before)
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    remove_orphans(path);
    let beside = beside(path, std::process::id());
    let put = || {
        write(&beside, content, before.as_ref())?;
        fs::rename(&beside, path)
    };
    put().inspect_err(|_| {
        let _ = fs::remove_file(&beside);
    })?;
    sync_folder(path)
}

/// Writes a file and flushes it: the content must be on the disk before the name is, or a power
/// failure can leave an empty file under the right name.
#[inline]
fn write(path: &Path, content: &[u8], like: Option<&Metadata>) -> io::Result<()> {
    let mut file = File::create(path)?;
    if let Some(like) = like {
        // Before there is content that others may not read.
        own(path, like);
        file.set_permissions(like.permissions())?;
    }
    file.write_all(content)?;
    file.sync_all()
}

/// Gives a file the owner of another, where the process may.
#[cfg(unix)]
#[inline]
fn own(path: &Path, like: &Metadata) {
    use std::os::unix::fs::{MetadataExt as _, chown};
    let _ = chown(path, Some(like.uid()), Some(like.gid()));
}

#[cfg(not(unix))]
#[inline]
fn own(_: &Path, _: &Metadata) {}

/// The name under which a process writes a file before it is renamed.
#[inline]
fn beside(path: &Path, process: u32) -> PathBuf {
    let mut name = start(path);
    name.push(std::format!("{process}{UNFINISHED}"));
    path.with_file_name(name)
}

/// The start of the names of a file's unfinished versions.
#[inline]
fn start(path: &Path) -> OsString {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(".");
    name
}

/// Removes what killed processes have left beside a file. Where the system does not show which
/// processes there are, only what the number of this one has left is overwritten.
#[inline]
fn remove_orphans(path: &Path) {
    let Ok(entries) = fs::read_dir(folder(path)) else { return };
    if !Path::new("/proc/self").exists() {
        return;
    }
    let start = start(path);
    for entry in entries.flatten() {
        let name = entry.file_name();
        let rest = name.as_encoded_bytes().strip_prefix(start.as_encoded_bytes());
        let process = rest.and_then(|rest| rest.strip_suffix(UNFINISHED.as_bytes()));
        let process = process.and_then(|process| str::from_utf8(process).ok()?.parse::<u32>().ok());
        if process.is_some_and(|process| !Path::new(&std::format!("/proc/{process}")).exists()) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

#[inline]
fn folder(path: &Path) -> &Path {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.unwrap_or(Path::new("."))
}

/// Makes the renaming last; only Unix lets a folder be opened for that.
#[inline]
fn sync_folder(path: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder(path))?.sync_all() } else { Ok(()) }
}
