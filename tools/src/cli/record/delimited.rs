//! Comma-separated values (RFC 4180), with semicolons or tabs in place of commas if the header has
//! them, or with the separator that a first line `sep=…` names, as spreadsheets write it.
//!
//! A row is kept as its bytes and the places of its fields: a field is decoded only if the task
//! reads it, so what else a log holds need not be UTF-8, and a message can say where in its line a
//! field begins.

use std::borrow::Cow;
use std::ops::Range;

use tltl_compiler::ast::quoted;

use super::lines::Lines;
use super::place::{Place, find};
use super::{At, number};

/// The most bytes of a row. A quote that nothing closes would else make one row of the file.
const MOST: usize = 1 << 20;

/// A record whose first row is the header.
pub(super) struct Delimited<'a> {
    rows: Rows<'a>,
    /// The column of each place.
    columns: Vec<usize>,
    /// The number of columns.
    width: usize,
}

impl<'a> Delimited<'a> {
    /// Reads the header, and finds the column of each place; `None` without a header.
    pub(super) fn new(lines: Lines<'a>, places: &[Place<'_>]) -> Result<Option<Self>, String> {
        let mut rows = Rows::new(lines)?;
        if !rows.next(|_| false)? {
            return Ok(None);
        }
        let header: Vec<_> = (0..rows.fields.len()).map(|column| rows.field(column)).collect();
        let header: Vec<&str> = header.iter().map(|column| &**column).collect();
        let columns = columns(rows.lines.name, &header, places)?;
        Ok(Some(Self { width: rows.fields.len(), columns, rows }))
    }

    /// The next row: appends the number of each place that the task reads, and hands the text of
    /// the episode's place to `episode`. `None` at the end.
    pub(super) fn next(
        &mut self,
        places: &[Place<'_>],
        values: &mut Vec<f64>,
        episode: &mut dyn FnMut(&str),
    ) -> Result<Option<At>, String> {
        let (width, reads_first) = (self.width, self.columns.contains(&0));
        // Nothing that a task reads begins so.
        if !self.rows.next(|fields| reads_first || fields != width)? {
            return Ok(None);
        }
        let (rows, line) = (&self.rows, self.rows.line);
        let name = rows.lines.name;
        if rows.fields.len() != width {
            let found = rows.fields.len();
            let fields = if found == 1 { "field" } else { "fields" };
            let what = format!("{name}:{line}: {found} {fields}, but the header has");
            let commas = rows.delimiter == b',' && found == 2 * width;
            let hint = if commas { ": write a decimal point, not a comma" } else { "" };
            return Err(format!("{what} {width}{hint}"));
        }
        for (place, &column) in places.iter().zip(&self.columns) {
            let failed = |what| format!("{name}:{line}:{}: {what}", rows.place(column));
            match (place.input, rows.field(column)) {
                (None, text) => episode(&text),
                (Some(input), _) if std::str::from_utf8(rows.bytes(column)).is_err() => {
                    return Err(failed(format!("`{}` is not UTF-8", input.name)));
                }
                (Some(input), text) => values.push(number(&text, input).map_err(failed)?),
            }
        }
        Ok(Some(At::Line(line)))
    }
}

/// The column of each place in a file that has columns of these names. All missing columns are
/// reported at once.
pub(super) fn columns(
    name: &str,
    header: &[&str],
    places: &[Place<'_>],
) -> Result<Vec<usize>, String> {
    let mut columns = Vec::new();
    let mut missing = Vec::new();
    for place in places {
        match find(header, place).map_err(|what| format!("{name}: {what}"))? {
            Some(column) => columns.push(column),
            None if place.input.is_none() => {
                let (column, found) = (place.column, listed(header));
                return Err(format!(
                    "{name}: episodes are told apart by the column `{column}`; the file has {found}"
                ));
            }
            None => missing.push(place.column),
        }
    }
    if missing.is_empty() { Ok(columns) } else { Err(lacking(name, &missing, header)) }
}

/// The message for a header without some of the columns.
fn lacking(name: &str, missing: &[&str], header: &[&str]) -> String {
    let word = if missing.len() == 1 { "the column" } else { "the columns" };
    let (lacks, found) = (listed(missing), listed(header));
    let mut text = format!("{name}: the task reads {word} {lacks}; the file has {found}");
    let signs = [('/', "division"), ('-', "subtraction"), ('+', "addition"), ('*', "a product")];
    for (sign, operation) in signs {
        let parts = |column: &&&str| {
            column.contains(sign) && column.split(sign).all(|part| missing.contains(&part.trim()))
        };
        if let Some(column) = header.iter().find(parts) {
            text.push_str(&format!(
                "; in a formula `{column}` is {operation}: write a name there, and --map 'NAME={column}'"
            ));
        }
    }
    text
}

/// The most names of columns that a message lists.
const LISTED: usize = 40;

/// Names of columns, as many and as much of each as a sentence bears.
fn listed(names: &[&str]) -> String {
    let shown = names.iter().take(LISTED).map(|name| format!("`{}`", quoted(name)));
    let more = names.len().saturating_sub(LISTED);
    let more = (more > 0).then(|| format!("… and {more} more"));
    shown.chain(more).collect::<Vec<_>>().join(", ")
}

/// The rows of a file, without those that are blank.
struct Rows<'a> {
    lines: Lines<'a>,
    delimiter: u8,
    /// The row.
    text: Vec<u8>,
    fields: Vec<Range<usize>>,
    /// Its first line, from 1.
    line: usize,
}

impl<'a> Rows<'a> {
    /// Rows whose delimiter is the one that the first line names, or else the first of `,`, `;` and
    /// tab that it has outside quotes.
    fn new(mut lines: Lines<'a>) -> Result<Self, String> {
        let mut first = Vec::new();
        lines.append(&mut first)?;
        let named = match first.trim_ascii() {
            [b's' | b'S', b'e' | b'E', b'p' | b'P', b'=', delimiter] => Some(*delimiter),
            // A tab at the end of the line has been trimmed.
            b"sep=" => Some(b'\t'),
            _ => None,
        };
        let unquoted = first.split(|byte| *byte == b'"').step_by(2);
        let has = |delimiter: &u8| unquoted.clone().any(|part| part.contains(delimiter));
        let delimiter = named.or_else(|| [b',', b';', b'\t'].into_iter().find(has));
        if named.is_none() {
            lines.give_back(first);
        }
        let delimiter = delimiter.unwrap_or(b',');
        Ok(Self { lines, delimiter, text: Vec::new(), fields: Vec::new(), line: 0 })
    }

    /// Reads the next row that is not blank; `false` at the end. Of lines that begin with `#`, those
    /// are comments of whose number of fields `is_comment` says so.
    fn next(&mut self, is_comment: impl Fn(usize) -> bool) -> Result<bool, String> {
        loop {
            self.text.clear();
            if !self.lines.append(&mut self.text)? {
                return Ok(false);
            }
            self.line = self.lines.number;
            let open = self.split();
            if self.text.starts_with(b"#") && (open || is_comment(self.fields.len())) {
                continue;
            }
            if open {
                self.close()?;
            }
            if self.fields.len() > 1 || !self.field(0).is_empty() {
                return Ok(true);
            }
        }
    }

    /// Finds the fields of the row; whether a quote in it is open at its end.
    fn split(&mut self) -> bool {
        self.fields.clear();
        let (mut start, mut open) = (0, false);
        for (at, &byte) in self.text.iter().enumerate() {
            if byte == self.delimiter && !open {
                self.fields.push(start..at);
                start = at + 1;
            } else if byte == b'"' && self.text[start..].trim_ascii_start().starts_with(b"\"") {
                open = !open;
            }
        }
        self.fields.push(start..self.text.len());
        open
    }

    /// Appends lines until the open quote of the row is closed. Only an odd number of quotes can
    /// close it.
    fn close(&mut self) -> Result<(), String> {
        loop {
            self.text.push(b'\n');
            let start = self.text.len();
            if self.text.len() > MOST || !self.lines.append(&mut self.text)? {
                return Err(format!("{}:{}: a quote is not closed", self.lines.name, self.line));
            }
            let quotes = self.text[start..].iter().filter(|byte| **byte == b'"').count();
            if quotes % 2 == 1 && !self.split() {
                return Ok(());
            }
        }
    }

    /// The bytes of a field as they stand, without blanks around them.
    fn bytes(&self, column: usize) -> &[u8] {
        self.text[self.fields[column].clone()].trim_ascii()
    }

    /// A field without quotes and blanks around it.
    fn field(&self, column: usize) -> Cow<'_, str> {
        let text = String::from_utf8_lossy(self.bytes(column));
        let quoted = text.strip_prefix('"').and_then(|text| text.strip_suffix('"'));
        match quoted {
            Some(inner) => Cow::Owned(inner.replace("\"\"", "\"").trim().to_owned()),
            None => text,
        }
    }

    /// The column of the text in which a field begins, in characters from 1.
    fn place(&self, column: usize) -> usize {
        let before = &self.text[..self.fields[column].start];
        String::from_utf8_lossy(before).chars().count() + 1
    }
}

#[cfg(test)]
mod tests {
    use super::super::lines::Lines;
    use super::Rows;

    /// A field with its line and its place.
    type Field = (usize, usize, String);

    fn fields(text: &str) -> Result<Vec<Vec<Field>>, String> {
        let mut lines = Lines::new("f", Box::new(text.as_bytes()))?;
        lines.first()?;
        let mut rows = Rows::new(lines)?;
        let mut all = Vec::new();
        while rows.next(|fields| fields != 2)? {
            let field = |i| (rows.line, rows.place(i), rows.field(i).into_owned());
            all.push((0..rows.fields.len()).map(field).collect());
        }
        Ok(all)
    }

    #[test]
    fn fields_know_where_they_stand() {
        let text = "\n \r\na, b\n\n\"1;\"\"é\"\"\",2\n\"x\ny\",\"\"\n";
        let found = fields(text).unwrap();
        let expected = [
            [(3, 1, "a"), (3, 3, "b")],
            [(5, 1, "1;\"é\""), (5, 11, "2")],
            [(6, 1, "x\ny"), (6, 7, "")],
        ];
        assert_eq!(found, expected.map(|row| row.map(|(l, c, f)| (l, c, f.to_owned())).to_vec()));
        assert_eq!(fields("a;b\n1,5;2").unwrap()[1][0].2, "1,5");
        let quoted = fields("a; \"b, c\"\n1; \"x; \"\"y\"\"\"").unwrap();
        assert_eq!((&*quoted[0][1].2, &*quoted[1][1].2), ("b, c", "x; \"y\""));
        assert_eq!(fields("a\tb\r\n1\t2\r\n").unwrap()[1][1], (2, 3, "2".to_owned()));
        assert_eq!(fields("a,b\r1,2\r\r3,4").unwrap()[2][1], (4, 3, "4".to_owned()));
    }

    #[test]
    fn comments_and_the_name_of_the_separator_are_no_rows() {
        let text = "# by hand, \"late\n\nsep=;\na;b\n# pause\n#1;2\n# \"so;\"\n";
        let found = fields(text).unwrap();
        assert_eq!(found.len(), 2);
        assert_eq!(found[1][0], (6, 1, "#1".to_owned()));
    }

    #[test]
    fn a_quote_that_is_not_closed_swallows_no_row() {
        assert_eq!(fields("a,b\n1,\"2\n3,4\n").unwrap_err(), "f:2: a quote is not closed");
        assert_eq!(fields("a,\"b").unwrap_err(), "f:1: a quote is not closed");
        assert_eq!(fields("a,b\n5\",\"6\"").unwrap()[1][0].2, "5\"");
        assert_eq!(fields("a,b\n1,\"2\"\"\"\n").unwrap()[1][1].2, "2\"");
        let endless = "a,b\n1,\"".to_owned() + &"2\n".repeat(1 << 20);
        assert_eq!(fields(&endless).unwrap_err(), "f:2: a quote is not closed");
    }

    #[test]
    fn any_quotes_are_read_or_refused() {
        let characters = ['"', ',', 'é', '\n', ' '];
        for number in 0..5_u32.pow(6) {
            let digit = |i| characters[(number / 5_u32.pow(i) % 5) as usize];
            let _ = fields(&(0..6).map(digit).collect::<String>());
        }
    }
}
