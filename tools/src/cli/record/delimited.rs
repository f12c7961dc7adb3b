//! Comma-separated values (RFC 4180), with semicolons or tabs in place of commas if the header has
//! them.
//!
//! The crate `csv` splits the text. It does not say where in a line a field begins, and accepts a
//! quote that the end of the file cuts off; both are found here, for messages.

use csv::{ReaderBuilder, StringRecord};

use super::{Input, State, number};

/// Reads a record whose first row is the header.
pub(super) fn read(name: &str, text: &str, inputs: &[Input]) -> Result<Vec<State>, String> {
    let mut rows = Rows::new(name, text);
    let Some(header) = rows.next()? else { return Ok(Vec::new()) };
    let columns = columns(name, &header, inputs)?;
    let mut states = Vec::new();
    while let Some(row) = rows.next()? {
        let line = row.line;
        if row.record.len() != header.record.len() {
            let (here, there) = (row.record.len(), header.record.len());
            return Err(format!("{name}:{line}: {here} fields, but the header has {there}"));
        }
        let value = |(input, &column): (&Input, &usize)| {
            number(row.field(column), input)
                .map_err(|what| format!("{name}:{line}:{}: {what}", row.place(column)))
        };
        let values = inputs.iter().zip(&columns).map(value).collect::<Result<_, _>>()?;
        states.push(State { line, values });
    }
    Ok(states)
}

/// The column of each input. All missing columns are reported at once.
fn columns(name: &str, header: &Row<'_>, inputs: &[Input]) -> Result<Vec<usize>, String> {
    let header: Vec<&str> = header.record.iter().map(str::trim).collect();
    let named = |input: &Input| header.iter().position(|column| *column == input.name);
    let missing: Vec<_> = inputs.iter().filter(|input| named(input).is_none()).collect();
    if !missing.is_empty() {
        let missing: Vec<_> = missing.iter().map(|input| format!("`{}`", input.name)).collect();
        let found: Vec<_> = header.iter().map(|column| format!("`{column}`")).collect();
        let word = if missing.len() == 1 { "the column" } else { "the columns" };
        let (missing, found) = (missing.join(", "), found.join(", "));
        return Err(format!("{name}: the task reads {word} {missing}; the file has {found}"));
    }
    for (at, column) in header.iter().enumerate() {
        let wanted = inputs.iter().any(|input| input.name == *column);
        if wanted && header[..at].contains(column) {
            return Err(format!("{name}: two columns are called `{column}`"));
        }
    }
    Ok(inputs.iter().filter_map(named).collect())
}

/// The rows of a text, without those that are blank.
struct Rows<'a> {
    name: &'a str,
    text: &'a str,
    reader: csv::Reader<&'a [u8]>,
}

impl<'a> Rows<'a> {
    /// A reader whose delimiter is the first of `,`, `;` and tab that the header has.
    fn new(name: &'a str, text: &'a str) -> Self {
        let header = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
        let delimiter = [',', ';', '\t'].into_iter().find(|&delimiter| header.contains(delimiter));
        let reader = ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .delimiter(delimiter.unwrap_or(',') as u8)
            .from_reader(text.as_bytes());
        Self { name, text, reader }
    }

    /// The next row that is not blank; `None` at the end.
    fn next(&mut self) -> Result<Option<Row<'a>>, String> {
        let mut record = StringRecord::new();
        loop {
            let (name, from) = (self.name, self.reader.position().clone());
            let more = self.reader.read_record(&mut record);
            if !more.map_err(|error| format!("{name}: {error}"))? {
                return Ok(None);
            }
            // The reader's place is before the blank lines that it skips.
            let text = &self.text[from.byte() as usize..self.reader.position().byte() as usize];
            let row = text.trim_start_matches(['\r', '\n']);
            let blank = text[..text.len() - row.len()].matches('\n').count();
            let row = Row { line: from.line() as usize + blank, text: row, record };
            if row.is_open() {
                return Err(format!("{name}:{}: a quote is not closed", row.line));
            }
            if row.record.len() > 1 || !row.field(0).is_empty() {
                return Ok(Some(row));
            }
            record = row.record;
        }
    }
}

/// One row, split into fields, and its text.
struct Row<'a> {
    /// Its first line, from 1.
    line: usize,
    text: &'a str,
    record: StringRecord,
}

impl Row<'_> {
    /// A field without blanks around it.
    fn field(&self, column: usize) -> &str {
        self.record.get(column).unwrap_or_default().trim()
    }

    /// For each field the byte in which it begins, and the one after the end of the last.
    fn starts(&self) -> impl Iterator<Item = usize> {
        let mut at = 0;
        let ends = self.record.iter().map(move |field| {
            // Beyond the text where quotes are not as the RFC has them: `"a"b"c"`.
            let quoted = self.text.get(at..).is_some_and(|rest| rest.starts_with('"'));
            // Quotes around it, and those in it twice.
            let quotes = if quoted { 2 + field.matches('"').count() } else { 0 };
            at += field.len() + quotes + 1;
            at
        });
        std::iter::once(0).chain(ends)
    }

    /// The column of the text in which a field begins, in characters from 1.
    fn place(&self, column: usize) -> usize {
        let start = self.starts().nth(column).unwrap_or_default();
        self.text.get(..start).unwrap_or(self.text).chars().count() + 1
    }

    /// Whether the last field begins with a quote that nothing closes. The crate would take the
    /// rest of the file for that field.
    fn is_open(&self) -> bool {
        let row = self.text.trim_end_matches(['\r', '\n']);
        let last = self
            .starts()
            .nth(self.record.len().saturating_sub(1))
            .and_then(|start| row.get(start..));
        last.is_some_and(|last| last.starts_with('"') && last.matches('"').count() % 2 == 1)
    }
}

#[cfg(test)]
mod tests {
    use super::Rows;

    /// A field with its line and its place.
    type Field = (usize, usize, String);

    fn fields(text: &str) -> Result<Vec<Vec<Field>>, String> {
        let mut rows = Rows::new("f", text);
        let mut all = Vec::new();
        while let Some(row) = rows.next()? {
            let field = |i| (row.line, row.place(i), row.field(i).to_owned());
            all.push((0..row.record.len()).map(field).collect());
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
        assert_eq!(fields("a\tb\r\n1\t2\r\n").unwrap()[1][1], (2, 3, "2".to_owned()));
    }

    #[test]
    fn a_quote_that_is_not_closed_swallows_no_row() {
        assert_eq!(fields("a,b\n1,\"2\n3,4\n").unwrap_err(), "f:2: a quote is not closed");
        assert_eq!(fields("a,\"b").unwrap_err(), "f:1: a quote is not closed");
        assert_eq!(fields("a,b\n5\",\"6\"").unwrap()[1][0].2, "5\"");
        assert_eq!(fields("a,b\n1,\"2\"\"\"\n").unwrap()[1][1].2, "2\"");
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
