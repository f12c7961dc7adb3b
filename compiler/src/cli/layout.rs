//! `tltlc fmt`.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use tltl_compiler::source::Source;
use tltl_compiler::{format, parse};

use super::{MISTAKEN, Outcome, Report, input, print};

/// Lays out files in place, or says which are not laid out; the standard input goes to the output.
pub(super) fn run(paths: &[PathBuf], check: bool) -> Outcome {
    let mut all_well = true;
    for path in paths {
        all_well &= one(path, check)?;
    }
    Ok(if all_well { ExitCode::SUCCESS } else { ExitCode::from(MISTAKEN) })
}

fn one(path: &Path, check: bool) -> Result<bool, String> {
    let name = path.display().to_string();
    let source = Source::new(name.as_str(), input::read(path)?);
    if input::judged(&source, parse::file(&source), Report::Human)?.is_none() {
        return Ok(false);
    }
    let Some(laid_out) = format::format(source.text()) else {
        return Err(format!("{name}: cannot be laid out without changing it; nothing is written"));
    };
    let same = laid_out == source.text();
    if check {
        if !same {
            print(&format!("{name}: not laid out; run `tltlc fmt {name}`"))?;
        }
        return Ok(same);
    }
    if path == Path::new("-") {
        print(&laid_out)?;
    } else if !same {
        let failed = |error| format!("cannot write {name}: {error}");
        std::fs::write(path, laid_out).map_err(failed)?;
    }
    Ok(true)
}
