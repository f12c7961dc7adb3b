//! The lines of a file, one after the other, without the file as a whole.

use std::io::BufRead;

/// A file as lines that end in `\n`, `\r\n` or, where the first line ends so, in `\r` alone.
pub(super) struct Lines<'a> {
    /// The name of the file in messages.
    pub(super) name: &'a str,
    reader: Box<dyn BufRead + 'a>,
    /// The byte in which lines end.
    end: u8,
    /// The line that was read last, from 1.
    pub(super) number: usize,
    /// A line that was read and is to be read again.
    again: Option<Vec<u8>>,
}

impl<'a> Lines<'a> {
    /// The lines of a text in UTF-8, behind its byte order mark if it has one; an error if the file
    /// begins as no text does.
    pub(super) fn new(name: &'a str, mut reader: Box<dyn BufRead + 'a>) -> Result<Self, String> {
        let first = reader.fill_buf().map_err(|error| unreadable(name, &error))?;
        if matches!(first, [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [0, _, ..] | [_, 0, ..]) {
            return Err(format!("{name}: this is UTF-16; save it as UTF-8"));
        }
        let ends = |byte: &u8| matches!(byte, b'\n' | b'\r');
        let head = first.iter().position(ends);
        // What stands in no line of names, or in no text at all.
        let strange = |&(at, byte): &(usize, &u8)| {
            let named = at < head.unwrap_or(first.len()) && !b"\t\x1b".contains(byte);
            *byte == 0 || byte.is_ascii_control() && named
        };
        if let Some((at, byte)) = first.iter().enumerate().find(strange) {
            return Err(format!(
                "{name}: this is no text: its byte {} is 0x{byte:02x}; a recording is CSV, JSON or \
                 Parquet",
                at + 1
            ));
        }
        let end = match head.map(|at| &first[at..]) {
            Some([b'\r', next, ..]) if *next != b'\n' => b'\r',
            _ => b'\n',
        };
        let mark = first.starts_with("\u{feff}".as_bytes());
        reader.consume(if mark { 3 } else { 0 });
        Ok(Self { name, reader, end, number: 0, again: None })
    }

    /// Appends the next line, without its end, to `text`; `false` if there is none.
    pub(super) fn append(&mut self, text: &mut Vec<u8>) -> Result<bool, String> {
        self.number += 1;
        if let Some(line) = self.again.take() {
            text.extend_from_slice(&line);
            return Ok(true);
        }
        let start = text.len();
        let read = self.reader.read_until(self.end, text);
        if read.map_err(|error| unreadable(self.name, &error))? == 0 {
            return Ok(false);
        }
        for end in [self.end, b'\r'] {
            if text.len() > start && text.last() == Some(&end) {
                text.pop();
            }
        }
        Ok(true)
    }

    /// The first byte of the first line that is neither blank nor a comment; `None` if there is no
    /// such line. The next line is then that one.
    pub(super) fn first(&mut self) -> Result<Option<u8>, String> {
        let mut text = Vec::new();
        while self.append(&mut text)? {
            if !is_idle(&text) {
                let first = text.trim_ascii_start().first().copied();
                self.give_back(text);
                return Ok(first);
            }
            text.clear();
        }
        Ok(None)
    }

    /// Gives the line that was read last back, to be read again.
    pub(super) fn give_back(&mut self, line: Vec<u8>) {
        self.number -= 1;
        self.again = Some(line);
    }
}

/// Whether a line has nothing in it, or is a comment.
pub(super) fn is_idle(line: &[u8]) -> bool {
    line.trim_ascii_start().first().is_none_or(|&byte| byte == b'#')
}

fn unreadable(name: &str, error: &std::io::Error) -> String {
    format!("cannot read {name}: {error}")
}
