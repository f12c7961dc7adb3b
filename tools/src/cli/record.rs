//! Recorded trajectories, one state a row: CSV, JSON Lines, JSON as one document, and Parquet.
//!
//! Columns are matched to the places that the task reads by their [names](place). Other columns are
//! ignored, so a log need not be cut to the task. Every number must be one of its type: an overflow,
//! or a NaN, is an error that names line and column, and never a state that satisfies or loses a
//! task.
//!
//! Rows are read one by one, so a recording may be larger than the memory.

mod delimited;
mod json;
mod lines;
#[cfg(feature = "parquet")]
mod parquet;
mod place;
mod unique;

use std::fmt;
use std::io::BufRead;
use std::path::Path;

use tltl_compiler::ast::quoted;
use tltl_compiler::predicate::{Numeric, Scalar};

use crate::evaluate::{Input, InputKind};

use delimited::Delimited;
use json::Json;
use lines::Lines;

pub(super) use place::Place;

/// Where a row stands in its file, as messages say it after the name of the file.
#[derive(Clone, Copy)]
pub(super) enum At {
    /// A line, from 1.
    Line(usize),
    /// A row of a document, from 0.
    Row(usize),
}

impl fmt::Display for At {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, ":{line}"),
            Self::Row(row) => write!(f, ": row {row}"),
        }
    }
}

/// A recording that is being read.
pub(super) struct Record<'a> {
    places: &'a [Place<'a>],
    rows: Rows<'a>,
}

enum Rows<'a> {
    Delimited(Delimited<'a>),
    Json(Json<'a>),
    #[cfg(feature = "parquet")]
    Parquet(Box<parquet::Parquet<'a>>),
    /// There is nothing to read.
    None,
}

impl<'a> Record<'a> {
    /// A recording; `name` is its name in messages. One that begins as Parquet does is read from
    /// `path`; of the others, one whose first line, comments apart, begins with `{` or `[` is JSON,
    /// any other CSV.
    pub(super) fn new(
        name: &'a str,
        path: &Path,
        mut reader: Box<dyn BufRead + 'a>,
        places: &'a [Place<'a>],
    ) -> Result<Self, String> {
        let start = reader.fill_buf().map_err(|error| format!("cannot read {name}: {error}"))?;
        if is_parquet(start) {
            return Ok(Self { places, rows: Rows::parquet(name, path, places)? });
        }
        let mut lines = Lines::new(name, reader)?;
        let rows = match lines.first()? {
            None => Rows::None,
            Some(b'{' | b'[') => Rows::Json(Json::new(lines, places)?),
            Some(_) => Delimited::new(lines, places)?.map_or(Rows::None, Rows::Delimited),
        };
        Ok(Self { places, rows })
    }

    /// Reads the next row: appends the number of each input to `values`, and hands the name of its
    /// episode to `episode`, if there is a place for it. `None` at the end.
    pub(super) fn next(
        &mut self,
        values: &mut Vec<f64>,
        episode: &mut dyn FnMut(&str),
    ) -> Result<Option<At>, String> {
        match &mut self.rows {
            Rows::Delimited(rows) => rows.next(self.places, values, episode),
            Rows::Json(rows) => rows.next(self.places, values, episode),
            #[cfg(feature = "parquet")]
            Rows::Parquet(rows) => rows.next(self.places, values, episode),
            Rows::None => Ok(None),
        }
    }
}

impl<'a> Rows<'a> {
    #[cfg(feature = "parquet")]
    fn parquet(name: &'a str, path: &Path, places: &[Place<'_>]) -> Result<Self, String> {
        if path == Path::new("-") {
            return Err("Parquet is read from its end, so not from the standard input".into());
        }
        parquet::Parquet::open(name, path, places).map(Box::new).map(Self::Parquet)
    }

    #[cfg(not(feature = "parquet"))]
    fn parquet(name: &str, _: &Path, _: &[Place<'_>]) -> Result<Self, String> {
        Err(format!(
            "{name}: this is Parquet, which `tltlc` reads if it is built with `--features parquet`; or \
             make it CSV: python -c \"import pandas; \
             pandas.read_parquet('run.parquet').to_csv('run.csv', index=False)\""
        ))
    }
}

/// Whether a file that begins so is Parquet, and not the CSV of a column called `PAR1`.
fn is_parquet(start: &[u8]) -> bool {
    let is_text = |byte: &u8| !byte.is_ascii_control() || b"\t\r\n".contains(byte);
    start.starts_with(b"PAR1") && !start.get(4).is_none_or(is_text)
}

/// Whether every number is one of the input's type.
fn is_real(input: &Input) -> bool {
    use InputKind::{Place, Proposition, Variable};
    matches!(input.kind, Variable | Proposition | Place(Scalar::Number(Numeric::F64)))
}

/// The number that a field is, in the type of the input.
fn number(text: &str, input: &Input) -> Result<f64, String> {
    let Input { name, kind, values, .. } = input;
    let ty = match kind {
        InputKind::Place(scalar) => scalar.name(),
        InputKind::Variable | InputKind::Proposition => "f64",
    };
    let value = match (kind, text) {
        (InputKind::Place(Scalar::Enum { optional: true, .. }), "" | "none" | "null") => Some(-1.0),
        (_, "") => return Err(format!("`{name}` is empty")),
        (InputKind::Place(Scalar::Bool), _) => truth(text),
        (InputKind::Place(Scalar::Enum { .. }), _) => {
            let known = values.iter().position(|value| value == text);
            let Some(number) = known else {
                let text = quoted(text);
                return Err(format!("`{text}` is no value of `{name}`: {}", values.join(", ")));
            };
            Some(number as f64)
        }
        // As a number it is robustness: 0 does not hold, and nothing is known of how far.
        (InputKind::Proposition, _) => typed(text, ty).or_else(|| Some(2.0 * truth(text)? - 1.0)),
        _ => typed(text, ty),
    };
    match value {
        Some(value) if value.is_nan() => Err(format!("`{name}` is not a number (NaN)")),
        Some(value) => Ok(value),
        None => {
            let hint =
                if is_decimal_comma(text) { ": write a decimal point, not a comma" } else { "" };
            Err(format!("`{}` is no `{ty}`, which `{name}` is{hint}", quoted(text)))
        }
    }
}

/// Whether a comma stands where a number has its decimal point.
fn is_decimal_comma(text: &str) -> bool {
    text.contains(',') && text.replacen(',', ".", 1).parse::<f64>().is_ok()
}

/// A truth value, in the spellings of Rust, Python, R and spreadsheets.
fn truth(text: &str) -> Option<f64> {
    match text {
        "true" | "True" | "TRUE" | "T" | "1" | "1.0" => Some(1.0),
        "false" | "False" | "FALSE" | "F" | "0" | "0.0" => Some(0.0),
        _ => None,
    }
}

/// A number of the Rust type `ty`, as the arithmetic of the predicates reads it.
fn typed(text: &str, ty: &str) -> Option<f64> {
    // Rust reads `1e400` as infinity, which nobody has written.
    let is_written =
        |value: &f64| value.is_finite() || !text.contains(|c: char| c.is_ascii_digit());
    let (least, most) = match ty {
        "f64" => return text.parse().ok().filter(is_written),
        "f32" => return text.parse::<f32>().ok().map(f64::from).filter(is_written),
        _ => Scalar::named(ty)?.whole()?,
    };
    // Other programs write whole numbers as `3.0`.
    let whole = text.split_once('.').filter(|(_, rest)| rest.bytes().all(|digit| digit == b'0'));
    let value: i128 = whole.map_or(text, |(whole, _)| whole).parse().ok()?;
    (least <= value && value <= most).then_some(value as f64)
}
