//! Parquet, with the feature `parquet`: row group by row group, and of each only the columns that
//! the task reads.
//!
//! A row has one value in a column. Columns in structs are called by their path, `pose.x`; lists
//! and maps are refused, and so are timestamps, decimals and whatever else is no plain number. A
//! value that is null is an empty field.

use std::borrow::Cow;
use std::fs::File;
use std::path::Path;

use parquet::basic::{ConvertedType, LogicalType, Type};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::DataType;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::schema::types::ColumnDescriptor;
use tltl_compiler::ast::quoted;

use super::delimited::columns;
use super::place::Place;
use super::{At, is_real, number};

/// The most rows that are decoded at once.
const ROWS: usize = 1 << 12;

/// A record in Parquet.
pub(super) struct Parquet<'a> {
    name: &'a str,
    file: SerializedFileReader<File>,
    /// The column of each place.
    columns: Vec<Column>,
    /// The next row group.
    group: usize,
    /// The rows of the group before it that are not decoded yet.
    left: usize,
    /// The rows that are decoded, and the next of them.
    decoded: usize,
    at: usize,
    /// The next row of the file.
    row: usize,
}

/// A column of the file.
struct Column {
    /// Its number.
    number: usize,
    /// The definition level of a value that is not null.
    full: i16,
    /// Whether its whole numbers are stored as if they had a sign, and have none.
    unsigned: bool,
    /// Its part of the row group.
    reader: Option<ColumnReader>,
    /// Its values in the rows that are decoded.
    cells: Vec<Cell>,
}

/// A value.
#[derive(Clone)]
enum Cell {
    Null,
    Truth(bool),
    Whole(i128),
    Real(f64),
    Text(String),
}

impl<'a> Parquet<'a> {
    /// Reads what a file says of its columns, and finds the column of each place.
    pub(super) fn open(name: &'a str, path: &Path, places: &[Place<'_>]) -> Result<Self, String> {
        let file = File::open(path).map_err(|error| format!("cannot read {name}: {error}"))?;
        let file = SerializedFileReader::new(file).map_err(|error| broken(name, &error))?;
        let schema = file.metadata().file_metadata().schema_descr();
        let names: Vec<String> = schema.columns().iter().map(|column| called(column)).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let found = columns(name, &names, places).map_err(|missing| {
            let is_part = |list: &&str| places.iter().any(|place| place.steps[0] == **list);
            let lists = schema.columns().iter().zip(&names).filter(|(column, _)| is_list(column));
            let list = lists.map(|(_, name)| *name).find(is_part);
            list.map_or(missing, |list| format!("{name}: {}", a_list(list)))
        })?;
        let mut columns = Vec::new();
        for number in found {
            let column = schema.column(number);
            if let Some(what) = unreadable(&column, names[number]) {
                return Err(format!("{name}: {what}"));
            }
            columns.push(Column {
                number,
                full: column.max_def_level(),
                unsigned: is_unsigned(&column),
                reader: None,
                cells: Vec::new(),
            });
        }
        Ok(Self { name, file, columns, group: 0, left: 0, decoded: 0, at: 0, row: 0 })
    }

    /// The next row: appends the number of each place that the task reads, and hands the text of
    /// the episode's place to `episode`. `None` at the end.
    pub(super) fn next(
        &mut self,
        places: &[Place<'_>],
        values: &mut Vec<f64>,
        episode: &mut dyn FnMut(&str),
    ) -> Result<Option<At>, String> {
        if self.at == self.decoded && !self.decode().map_err(|error| broken(self.name, &error))? {
            return Ok(None);
        }
        let at = At::Row(self.row);
        for (place, column) in places.iter().zip(&self.columns) {
            let failed = |what| format!("{}{at}: {what}", self.name);
            match (place.input, &column.cells[self.at]) {
                (None, cell) => episode(&cell.text()),
                (Some(input), Cell::Whole(value)) if is_real(input) => values.push(*value as f64),
                (Some(input), Cell::Real(value)) if is_real(input) && !value.is_nan() => {
                    values.push(*value);
                }
                (Some(input), cell) => values.push(number(&cell.text(), input).map_err(failed)?),
            }
        }
        self.at += 1;
        self.row += 1;
        Ok(Some(at))
    }

    /// Decodes the next rows; `false` if there are none.
    fn decode(&mut self) -> Result<bool, ParquetError> {
        while self.left == 0 {
            if self.group == self.file.num_row_groups() {
                return Ok(false);
            }
            let group = self.file.get_row_group(self.group)?;
            self.left = usize::try_from(group.metadata().num_rows())?;
            for column in &mut self.columns {
                column.reader = Some(group.get_column_reader(column.number)?);
            }
            self.group += 1;
        }
        self.decoded = self.left.min(ROWS);
        for column in &mut self.columns {
            column.decode(self.decoded)?;
        }
        (self.left, self.at) = (self.left - self.decoded, 0);
        Ok(true)
    }
}

impl Column {
    /// Decodes that many rows.
    fn decode(&mut self, rows: usize) -> Result<(), ParquetError> {
        let (full, unsigned, cells) = (self.full, self.unsigned, &mut self.cells);
        match &mut self.reader {
            Some(ColumnReader::BoolColumnReader(reader)) => {
                read(reader, rows, full, cells, &|value| Cell::Truth(*value))
            }
            Some(ColumnReader::Int32ColumnReader(reader)) => {
                let whole =
                    |value: &i32| if unsigned { (*value as u32).into() } else { (*value).into() };
                read(reader, rows, full, cells, &|value| Cell::Whole(whole(value)))
            }
            Some(ColumnReader::Int64ColumnReader(reader)) => {
                let whole =
                    |value: &i64| if unsigned { (*value as u64).into() } else { (*value).into() };
                read(reader, rows, full, cells, &|value| Cell::Whole(whole(value)))
            }
            Some(ColumnReader::FloatColumnReader(reader)) => {
                read(reader, rows, full, cells, &|value| Cell::Real((*value).into()))
            }
            Some(ColumnReader::DoubleColumnReader(reader)) => {
                read(reader, rows, full, cells, &|value| Cell::Real(*value))
            }
            Some(ColumnReader::ByteArrayColumnReader(reader)) => {
                read(reader, rows, full, cells, &|value| {
                    Cell::Text(String::from_utf8_lossy(value.data()).into_owned())
                })
            }
            _ => {
                Err(ParquetError::General("a column is of another type than the file says".into()))
            }
        }
    }
}

/// Reads that many values of a column in the place of `cells`, those that are null among them.
fn read<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: usize,
    full: i16,
    cells: &mut Vec<Cell>,
    cell: &dyn Fn(&T::T) -> Cell,
) -> Result<(), ParquetError> {
    let (mut levels, mut values) = (Vec::new(), Vec::new());
    let (records, ..) = reader.read_records(rows, Some(&mut levels), None, &mut values)?;
    if records != rows {
        return Err(ParquetError::EOF("a column has fewer values than rows".into()));
    }
    // Without optional parts there are no levels.
    levels.resize(rows, full);
    let mut values = values.iter().map(cell);
    cells.clear();
    for level in levels {
        let value = if level == full { values.next() } else { None };
        cells.push(value.unwrap_or(Cell::Null));
    }
    Ok(())
}

impl Cell {
    /// The value as the text that a field of CSV would have.
    fn text(&self) -> Cow<'_, str> {
        match self {
            Self::Null => Cow::Borrowed(""),
            Self::Truth(truth) => Cow::Borrowed(if *truth { "true" } else { "false" }),
            Self::Whole(value) => Cow::Owned(value.to_string()),
            Self::Real(value) => Cow::Owned(value.to_string()),
            Self::Text(text) => Cow::Borrowed(text),
        }
    }
}

/// The name of a column: its path, and of what is in a list the name of the list.
fn called(column: &ColumnDescriptor) -> String {
    if is_list(column) { column.path().parts()[0].clone() } else { column.path().string() }
}

/// Whether a row can have several values in a column.
fn is_list(column: &ColumnDescriptor) -> bool {
    column.max_rep_level() > 0
}

/// Whether the whole numbers of a column have no sign.
fn is_unsigned(column: &ColumnDescriptor) -> bool {
    use ConvertedType as C;
    match column.logical_type_ref() {
        Some(LogicalType::Integer(of)) => !of.is_signed,
        _ => matches!(column.converted_type(), C::UINT_8 | C::UINT_16 | C::UINT_32 | C::UINT_64),
    }
}

/// The reason why no task reads a column.
fn unreadable(column: &ColumnDescriptor, name: &str) -> Option<String> {
    if is_list(column) {
        return Some(a_list(name));
    }
    use {ConvertedType as C, LogicalType as L, Type as T};
    let what = match (column.logical_type_ref(), column.converted_type(), column.physical_type()) {
        (Some(L::Timestamp(_) | L::Date | L::Time(_)), ..)
        | (
            _,
            C::DATE | C::TIME_MILLIS | C::TIME_MICROS | C::TIMESTAMP_MILLIS | C::TIMESTAMP_MICROS,
            _,
        )
        | (.., T::INT96) => "times",
        (Some(L::Decimal(_)), ..) | (_, C::DECIMAL, _) => "decimals",
        (.., T::FIXED_LEN_BYTE_ARRAY) => "values of a fixed number of bytes",
        _ => return None,
    };
    Some(format!(
        "the column `{}` holds {what}; floating-point and whole numbers, truth values and texts are \
         read",
        quoted(name)
    ))
}

/// The message for a column of lists or maps.
fn a_list(name: &str) -> String {
    let name = quoted(name);
    format!(
        "`{name}` holds a list in each row; make a column of each element that the task reads, such as \
         `{name}[0]`"
    )
}

/// The message for a file that cannot be decoded.
fn broken(name: &str, error: &ParquetError) -> String {
    format!("{name}: this is not Parquet, or not all of it ({error})")
}
