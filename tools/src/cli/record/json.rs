//! JSON: one object a line (JSON Lines), an array of objects, or an object of columns.
//!
//! A place may be a key of its own, in any of its [spellings](super::place), or nested:
//! `{"pose": {"x": 1}}`. Lines are read one by one; an array, or columns, as a whole. `NaN` and
//! `Infinity` are read as Python writes them, and a NaN is refused where the task reads it. So is an
//! object that has a key twice.

use serde_json::{Error, Map, Value};

use super::lines::{Lines, is_idle};
use super::place::{Place, find};
use super::unique::Unique;
use super::{At, is_real, number};

/// A record in JSON.
pub(super) struct Json<'a> {
    lines: Lines<'a>,
    /// The states of an array or of columns, with their numbers; `None` for JSON Lines.
    states: Option<std::iter::Enumerate<std::vec::IntoIter<Value>>>,
    /// For each place the key that it was found under last, where that is not its own.
    keys: Vec<Option<String>>,
}

impl<'a> Json<'a> {
    /// A record whose next line begins with `{` or `[`.
    pub(super) fn new(mut lines: Lines<'a>, places: &[Place<'_>]) -> Result<Self, String> {
        let mut text = Vec::new();
        lines.append(&mut text)?;
        let (document, is_line) = match value(&text) {
            Ok(document) => (document, true),
            Err(error) => (whole(&mut lines, &text, &error)?, false),
        };
        let found = states(&document, places).map_err(|what| format!("{}: {what}", lines.name))?;
        let states = match found {
            None if is_line => {
                lines.give_back(text);
                None
            }
            None => Some(vec![document]),
            states => states,
        };
        let states = states.map(|states| states.into_iter().enumerate());
        Ok(Self { lines, states, keys: vec![None; places.len()] })
    }

    /// The next state: appends the number of each place that the task reads, and hands the text of
    /// the episode's place to `episode`. `None` at the end.
    pub(super) fn next(
        &mut self,
        places: &[Place<'_>],
        values: &mut Vec<f64>,
        episode: &mut dyn FnMut(&str),
    ) -> Result<Option<At>, String> {
        let Some((at, state)) = self.state()? else { return Ok(None) };
        let name = self.lines.name;
        for (place, key) in places.iter().zip(&mut self.keys) {
            let failed = |what| format!("{name}{at}: {what}");
            let found = lookup(&state, place, key).map_err(failed)?;
            let found = found.ok_or_else(|| failed(format!("there is no `{}`", place.column)))?;
            match (place.input, found) {
                (None, found) => episode(&episode_name(found)),
                (Some(input), Value::Number(number)) if is_real(input) => {
                    values.extend(number.as_f64());
                }
                (Some(input), found) => values.push(number(&text(found), input).map_err(failed)?),
            }
        }
        Ok(Some(at))
    }

    /// The next state, whatever it holds.
    fn state(&mut self) -> Result<Option<(At, Value)>, String> {
        if let Some(states) = &mut self.states {
            return Ok(states.next().map(|(row, state)| (At::Row(row), state)));
        }
        let mut text = Vec::new();
        while self.lines.append(&mut text)? {
            if !is_idle(&text) {
                let (name, line) = (self.lines.name, self.lines.number);
                return match value(&text) {
                    Ok(state) => Ok(Some((At::Line(line), state))),
                    Err(error) => Err(not_json(name, line, &error)),
                };
            }
            text.clear();
        }
        Ok(None)
    }
}

/// One document of all lines, of which `text` is the first and `error` its fault on its own.
fn whole(lines: &mut Lines<'_>, text: &[u8], error: &Error) -> Result<Value, String> {
    let (mut all, first) = (text.to_vec(), lines.number);
    all.push(b'\n');
    while lines.append(&mut all)? {
        all.push(b'\n');
    }
    // An end that comes too early is that of the last line.
    value(all.trim_ascii_end()).map_err(|whole| {
        let is_array = text.trim_ascii_start().starts_with(b"[");
        // An object that is cut off at the end of its line is meant as one of many lines.
        if is_array || error.is_eof() {
            not_json(lines.name, first + whole.line() - 1, &whole)
        } else {
            not_json(lines.name, first, error)
        }
    })
}

fn not_json(name: &str, line: usize, error: &Error) -> String {
    let text = error.to_string();
    let what = match text.split_once(" at line ") {
        Some((what, _)) if error.is_data() => what,
        Some(("number out of range", _)) => "this number is too large",
        _ => "this is not JSON",
    };
    format!("{name}:{line}:{}: {what}", error.column())
}

/// A JSON value. What is not UTF-8 becomes U+FFFD, which is no number and no name.
fn value(text: &[u8]) -> Result<Value, Error> {
    let read = serde_json::from_slice(text).or_else(|error: Error| {
        let again = serde_json::from_str(&without_names(text));
        again.map_err(|second| if second.is_data() { second } else { error })
    });
    read.map(|Unique(value)| value)
}

/// The text with strings in place of the names that Python gives to numbers.
fn without_names(text: &[u8]) -> String {
    let text = String::from_utf8_lossy(text);
    let (mut written, mut rest, mut in_string) = (String::new(), &*text, false);
    while let Some(first) = rest.chars().next() {
        let names = [("NaN", "\"NaN\""), ("-Infinity", "\"-inf\""), ("Infinity", "\"inf\"")];
        let named = names.iter().find(|(name, _)| !in_string && rest.starts_with(name));
        let (length, instead) = match named {
            Some((name, instead)) => (name.len(), *instead),
            None if in_string && first == '\\' => {
                let length = 1 + rest[1..].chars().next().map_or(0, char::len_utf8);
                (length, &rest[..length])
            }
            None => (first.len_utf8(), &rest[..first.len_utf8()]),
        };
        in_string ^= first == '"';
        written.push_str(instead);
        rest = &rest[length..];
    }
    written
}

/// A value as the text that a field of CSV would have.
fn text(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// The name of an episode. Programs write one number as `1` and as `1.0`.
fn episode_name(value: &Value) -> String {
    match value.as_f64().filter(|_| value.is_f64()) {
        Some(number) => (number + 0.0).to_string(),
        None => text(value),
    }
}

/// The states of an array of objects, or of an object of columns; `None` for a single state.
fn states(document: &Value, places: &[Place<'_>]) -> Result<Option<Vec<Value>>, String> {
    let single = |place| lookup(document, place, &mut None).ok().flatten();
    match document {
        Value::Array(states) => Ok(Some(states.clone())),
        _ if places.iter().all(|place| single(place).is_some_and(|value| !value.is_array())) => {
            Ok(None)
        }
        document => columns(document, places),
    }
}

/// The rows of an object that has a column for each place; `None` if it has not.
fn columns(document: &Value, places: &[Place<'_>]) -> Result<Option<Vec<Value>>, String> {
    let mut states: Vec<Map<String, Value>> = Vec::new();
    let mut first: Option<(&str, usize)> = None;
    for place in places {
        let Some(column) = column(document, place) else { return Ok(None) };
        let (before, rows) = *first.get_or_insert((place.column, column.len()));
        if column.len() != rows {
            let (name, here) = (place.column, column.len());
            return Err(format!("the column `{before}` has {rows} rows, and `{name}` has {here}"));
        }
        states.resize_with(rows, Map::new);
        for (state, value) in states.iter_mut().zip(column) {
            state.insert(place.column.to_string(), value.clone());
        }
    }
    Ok(first.map(|_| states.into_iter().map(Value::Object).collect()))
}

/// The values of a place, where the keys of its path lead to an array with one for each row.
fn column<'a>(document: &'a Value, place: &Place<'_>) -> Option<Vec<&'a Value>> {
    let (mut value, mut rest) = match keyed(document, place).ok()? {
        Some(key) => (document.get(key)?, &[][..]),
        None => (document, &place.steps[..]),
    };
    loop {
        match (value, rest) {
            (Value::Array(rows), _) => {
                let single = |row| nested(row, rest).filter(|value| !value.is_array());
                return rows.iter().map(single).collect();
            }
            (object, [step, after @ ..]) => (value, rest) = (object.get(step)?, after),
            (_, []) => return None,
        }
    }
}

/// The value of a place in a state: under its own name, step by step through objects and arrays, or
/// under another spelling, which is kept in `known`.
fn lookup<'a>(
    state: &'a Value,
    place: &Place<'_>,
    known: &mut Option<String>,
) -> Result<Option<&'a Value>, String> {
    let own = state.get(known.as_deref().unwrap_or(place.column));
    if let Some(value) = own.or_else(|| nested(state, &place.steps)) {
        return Ok(Some(value));
    }
    *known = keyed(state, place)?;
    Ok(known.as_deref().and_then(|key| state.get(key)))
}

/// The key of an object that is a spelling of the place.
fn keyed(state: &Value, place: &Place<'_>) -> Result<Option<String>, String> {
    let Some(object) = state.as_object() else { return Ok(None) };
    let keys: Vec<&str> = object.keys().map(String::as_str).collect();
    Ok(find(&keys, place)?.map(|index| keys[index].to_owned()))
}

/// The value at the end of a path through objects and arrays.
fn nested<'a>(value: &'a Value, steps: &[String]) -> Option<&'a Value> {
    steps.iter().try_fold(value, |value, step| match value {
        Value::Array(elements) => elements.get(step.parse::<usize>().ok()?),
        other => other.get(step),
    })
}
