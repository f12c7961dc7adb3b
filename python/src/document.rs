//! Documents of policies: written to files, read from them, and emitted as Rust.

use std::path::{Path, PathBuf};

use pyo3::prelude::*;

use super::error::wrong;

/// What a document says.
pub(crate) fn parsed<T>(document: serde_json::Result<T>) -> PyResult<T> {
    document.map_err(|error| wrong(error.to_string()))
}

/// Writes a text to a file, which is replaced as a whole.
pub(crate) fn save(py: Python<'_>, path: &Path, text: &str) -> PyResult<()> {
    Ok(py.detach(|| tltl::file::replace(path, text.as_bytes()))?)
}

/// The text of a file.
pub(crate) fn load(py: Python<'_>, path: PathBuf) -> PyResult<String> {
    Ok(py.detach(|| std::fs::read_to_string(path))?)
}

/// Rust source, which is written to a file too if there is a `path`.
pub(crate) fn emitted(py: Python<'_>, source: String, path: Option<PathBuf>) -> PyResult<String> {
    if let Some(path) = path {
        save(py, &path, &source)?;
    }
    Ok(source)
}
