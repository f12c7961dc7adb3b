//! Files that are whole or not there: checkpoints of learners and studies.
//!
//! [`write()`] [replaces](file::replace) a file as a whole, so that a process killed at any point
//! leaves the old file or the new one. [`read`] refuses what is cut
//! short, changed, or another kind of file. The content is bytes: serialise with whatever you like
//! (serde_json reads floats back exactly with its feature `float_roundtrip`).
//!
//! The format is one line, `tltl-checkpoint 1 KIND LENGTH CHECKSUM`, then the content. The checksum
//! is 64-bit FNV-1a over the content: against accidents, not against forgery.

use core::fmt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::string::{String, ToString};
use std::vec::Vec;

use crate::checksum::fnv;
use crate::file;

/// The first word of the file: what says that it is ours before anything else is read.
const MAGIC: &str = "tltl-checkpoint";
const VERSION: &str = "1";

/// Why a checkpoint cannot be read.
///
/// Each names the file. All but `Io` mean that the file was read and is not what was asked for.
#[derive(Debug)]
pub enum Error {
    /// The file cannot be opened or read.
    Io(PathBuf, io::Error),
    /// It is not a checkpoint.
    Foreign(PathBuf),
    /// It is of another version of the format.
    Version(PathBuf, String),
    /// It is a checkpoint of something else.
    Kind {
        /// The file.
        path: PathBuf,
        /// What it holds.
        found: String,
        /// What was asked for.
        expected: String,
    },
    /// It is shorter or longer than it says.
    Length {
        /// The file.
        path: PathBuf,
        /// The bytes of content that are there.
        found: usize,
        /// The bytes that should be.
        expected: usize,
    },
    /// Its content has changed since it was written.
    Corrupt(PathBuf),
}

impl fmt::Display for Error {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Foreign(path) => write!(f, "{}: not a checkpoint", path.display()),
            Self::Version(path, found) => write!(
                f,
                "{}: a checkpoint of version {found}; this library reads {VERSION}",
                path.display()
            ),
            Self::Kind { path, found, expected } => {
                write!(f, "{}: a checkpoint of `{found}`, not of `{expected}`", path.display())
            }
            Self::Length { path, found, expected } => write!(
                f,
                "{}: cut short or added to: {found} bytes of content, not {expected}",
                path.display()
            ),
            Self::Corrupt(path) => {
                write!(f, "{}: corrupt: the checksum does not fit", path.display())
            }
        }
    }
}

impl std::error::Error for Error {}

/// Writes `content` to `path` so that the file is whole whenever it is there; `kind`, one word,
/// says what it is.
///
/// ```
/// use tltl::{checkpoint, model, prelude::*};
///
/// let mut env = ModelEnv::new(model::from_fn(2, 1, |s, _| [(1 - s, 1.0)]))?;
/// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 1) })?;
/// let mut learner = Learner::new(&task, Settings::default(), 7);
/// learner.train(&mut env, 100)?;
///
/// let path = std::env::temp_dir().join(format!("tltl-write-{}.checkpoint", std::process::id()));
/// checkpoint::write(&path, "learner", &serde_json::to_vec(&learner.checkpoint())?)?;
/// let saved = checkpoint::read(&path, "learner")?.expect("it was written just now");
/// assert_eq!(Learner::resume(&task, serde_json::from_slice(&saved)?)?, learner);
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
///
/// # Errors
/// If the file cannot be written; what was there before is then still there.
///
/// # Panics
/// If `kind` is empty or has white space in it.
#[track_caller]
#[inline]
pub fn write(path: &Path, kind: &str, content: &[u8]) -> Result<(), Error> {
    assert!(!kind.is_empty() && !kind.contains(char::is_whitespace), "a kind is one word");
    let header = std::format!(
        "{MAGIC} {VERSION} {kind} {} {:016x}\n",
        content.len(),
        fnv(content.iter().copied())
    );
    let whole = [header.as_bytes(), content].concat();
    file::replace(path, &whole).map_err(|error| Error::Io(path.to_path_buf(), error))
}

/// The content of the checkpoint at `path`, if it is one of `kind` and whole; `None` if there is no
/// such file.
///
/// No file is no error, for that is how a study starts: `None` says to begin from nothing.
///
/// ```
/// use tltl::checkpoint::{self, Error};
///
/// let path = std::env::temp_dir().join(format!("tltl-read-{}.checkpoint", std::process::id()));
/// assert!(matches!(checkpoint::read(&path, "study"), Ok(None)));
/// checkpoint::write(&path, "study", b"seed 1: 98 %")?;
/// assert!(matches!(checkpoint::read(&path, "learner"), Err(Error::Kind { .. })));
///
/// let mut bytes = std::fs::read(&path)?;
/// bytes.pop(); // as a full disk would leave it
/// std::fs::write(&path, bytes)?;
/// let error = checkpoint::read(&path, "study").unwrap_err();
/// assert!(error.to_string().ends_with("cut short or added to: 11 bytes of content, not 12"));
/// # std::fs::remove_file(path)?;
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
///
/// # Errors
/// If the file cannot be read, or is not what it should be.
#[inline]
pub fn read(path: &Path, kind: &str) -> Result<Option<Vec<u8>>, Error> {
    match fs::read(path) {
        Ok(bytes) => check(path, kind, &bytes).map(|content| Some(content.to_vec())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(Error::Io(path.to_path_buf(), error)),
    }
}

/// From the outside in: is it ours, of this version, of this kind, whole, unchanged. So each error
/// names the first thing that is wrong, and a file of a later version is never called corrupt.
#[inline]
fn check<'a>(path: &Path, kind: &str, bytes: &'a [u8]) -> Result<&'a [u8], Error> {
    let foreign = || Error::Foreign(path.to_path_buf());
    let end = bytes.iter().position(|&byte| byte == b'\n').ok_or_else(foreign)?;
    let header = core::str::from_utf8(&bytes[..end]).map_err(|_| foreign())?;
    let words: Vec<&str> = header.split(' ').collect();
    let [MAGIC, version, found, length, sum] = words[..] else { return Err(foreign()) };
    if version != VERSION {
        return Err(Error::Version(path.to_path_buf(), version.to_string()));
    }
    if found != kind {
        let (found, expected) = (found.to_string(), kind.to_string());
        return Err(Error::Kind { path: path.to_path_buf(), found, expected });
    }
    let content = &bytes[end + 1..];
    let expected: usize = length.parse().map_err(|_| foreign())?;
    if content.len() != expected {
        return Err(Error::Length { path: path.to_path_buf(), found: content.len(), expected });
    }
    let whole = u64::from_str_radix(sum, 16) == Ok(fnv(content.iter().copied()));
    if whole { Ok(content) } else { Err(Error::Corrupt(path.to_path_buf())) }
}
