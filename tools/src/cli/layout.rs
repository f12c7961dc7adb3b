//! `tltlc fmt`: task files, laid out by [`format`](mod@crate::format).

use std::path::{Path, PathBuf};

use tltl_compiler::parse;
use tltl_compiler::source::Source;

use crate::format::format;

use super::{Exit, Outcome, Report, Streams, input, streams};

/// Lays out files in place, or says which are not laid out; the path `-` goes from the input to the
/// output.
pub(super) fn run(paths: &[PathBuf], check: bool, streams: &mut Streams<'_>) -> Outcome {
    streams::read_once(paths.iter().map(PathBuf::as_path))?;
    let mut all_well = true;
    for path in paths {
        all_well &= one(path, check, streams)?;
    }
    Ok(Exit::of(all_well))
}

/// One file; whether it is, or now is, laid out. A file with mistakes is reported and left alone.
fn one(path: &Path, check: bool, streams: &mut Streams<'_>) -> Result<bool, String> {
    let name = path.display().to_string();
    let source = Source::new(name.as_str(), streams.read(path)?);
    if input::judged(&source, parse::file(&source), Report::Human, streams)?.is_none() {
        return Ok(false);
    }
    let Some(laid_out) = format(source.text()) else {
        return Err(format!("{name}: cannot be laid out without changing it; nothing is written"));
    };
    let same = laid_out == source.text();
    if check {
        if !same {
            streams.print(&format!("{name}: not laid out; run `tltlc fmt {name}`"))?;
        }
        return Ok(same);
    }
    if path == Path::new("-") {
        streams.out.print_raw(&laid_out)?;
    } else if !same {
        streams::write(path, &laid_out)?;
    }
    Ok(true)
}
