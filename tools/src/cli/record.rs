//! Recorded trajectories: CSV and JSON Lines, one state a row.
//!
//! Columns are matched by name to the places that the task reads: `x`, `pose.x`, `joints[2]`. In
//! JSON Lines a place may also be nested (`{"pose": {"x": 1}}`). Other columns are ignored, so a
//! log need not be cut to the task. Every number must be one of its type: an overflow, or a NaN, is
//! an error that names line and column, and never a state that satisfies or loses a task.

mod delimited;

use serde_json::Value;
use tltl_compiler::predicate::Scalar;

use crate::evaluate::{Input, InputKind};

/// One state: its line, for messages, and its numbers in the order of the inputs.
pub(super) struct State {
    /// Its line in the file, from 1.
    pub(super) line: usize,
    pub(super) values: Vec<f64>,
}

/// Reads a record; `name` is its name in messages. A text that begins with `{` is JSON Lines, any
/// other CSV.
pub(super) fn read(name: &str, text: &str, inputs: &[Input]) -> Result<Vec<State>, String> {
    let text = text.trim_start_matches('\u{feff}');
    let states = if text.trim_start().starts_with('{') {
        json_lines(name, text, inputs)?
    } else {
        delimited::read(name, text, inputs)?
    };
    if states.is_empty() {
        return Err(format!("{name}: a trajectory has at least one state, and this has none"));
    }
    Ok(states)
}

/// Reads one JSON object a line; blank lines are skipped.
fn json_lines(name: &str, text: &str, inputs: &[Input]) -> Result<Vec<State>, String> {
    let mut states = Vec::new();
    let lines = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    for (line, text) in lines {
        let state: Value = serde_json::from_str(text)
            .map_err(|error| format!("{name}:{line}:{}: this is not JSON", error.column()))?;
        let value = |input: &Input| {
            let found = lookup(&state, &input.name)
                .ok_or_else(|| format!("{name}:{line}: there is no `{}`", input.name))?;
            let text = found.as_str().map_or_else(|| found.to_string(), str::to_owned);
            number(&text, input).map_err(|what| format!("{name}:{line}: {what}"))
        };
        states.push(State { line, values: inputs.iter().map(value).collect::<Result<_, _>>()? });
    }
    Ok(states)
}

/// The value of a place: under its whole name, or step by step through objects and arrays.
fn lookup<'a>(state: &'a Value, name: &str) -> Option<&'a Value> {
    if let Some(value) = state.get(name) {
        return Some(value);
    }
    let steps = name.split(['.', '[']).map(|step| step.trim_end_matches(']'));
    steps.into_iter().try_fold(state, |value, step| match value {
        Value::Array(elements) => elements.get(step.parse::<usize>().ok()?),
        other => other.get(step),
    })
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
                return Err(format!("`{text}` is no value of `{name}`: {}", values.join(", ")));
            };
            Some(number as f64)
        }
        (InputKind::Proposition, "true" | "True") => Some(1.0),
        (InputKind::Proposition, "false" | "False") => Some(-1.0),
        _ => typed(text, ty),
    };
    match value {
        Some(value) if value.is_nan() => Err(format!("`{name}` is not a number (NaN)")),
        Some(value) => Ok(value),
        None => Err(format!("`{text}` is no `{ty}`, which `{name}` is")),
    }
}

/// A truth value, in the spellings of Rust, Python, R and spreadsheets.
fn truth(text: &str) -> Option<f64> {
    match text {
        "true" | "True" | "TRUE" | "1" | "1.0" => Some(1.0),
        "false" | "False" | "FALSE" | "0" | "0.0" => Some(0.0),
        _ => None,
    }
}

/// A number of the Rust type `ty`, as the arithmetic of the predicates reads it.
fn typed(text: &str, ty: &str) -> Option<f64> {
    let (least, most) = match ty {
        "f64" => return text.parse().ok(),
        "f32" => return text.parse::<f32>().ok().map(f64::from),
        _ => Scalar::named(ty)?.whole()?,
    };
    // Other programs write whole numbers as `3.0`.
    let whole = text.split_once('.').filter(|(_, rest)| rest.bytes().all(|digit| digit == b'0'));
    let value: i128 = whole.map_or(text, |(whole, _)| whole).parse().ok()?;
    (least <= value && value <= most).then_some(value as f64)
}
