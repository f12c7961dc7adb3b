//! The arguments of a task on the command line: `deliver(apple, fridge)`, as one task calls another
//! in the language.

use crate::task::{Parameter, Value, listed};

/// The name and the arguments of `name(argument, …)`; no arguments if there are no brackets. No
/// argument has a comma in it: values are names and numbers.
pub(super) fn split(text: &str) -> Result<(&str, Option<Vec<&str>>), String> {
    let Some((name, rest)) = text.split_once('(') else { return Ok((text.trim(), None)) };
    let Some(inner) = rest.trim_end().strip_suffix(')') else {
        return Err(format!("`{text}` is not closed: write `{}(…)`", name.trim()));
    };
    let given = inner.split(',').map(str::trim).collect();
    let given = if inner.trim().is_empty() { Vec::new() } else { given };
    Ok((name.trim(), Some(given)))
}

/// The arguments, given by position, with the names of the parameters of a task.
pub(super) fn named<'a>(
    name: Option<&str>,
    parameters: &'a [Parameter],
    given: &[&str],
) -> Result<Vec<(&'a str, Value)>, String> {
    let (count, takes) = (given.len(), listed(parameters));
    let name = name.unwrap_or("the formula");
    if count == parameters.len() {
        let names = parameters.iter().map(|parameter| parameter.name.as_str());
        return Ok(names.zip(given.iter().map(|&text| Value::from(text))).collect());
    }
    Err(if parameters.is_empty() {
        format!("`{name}` takes {takes}: write --task {name}")
    } else {
        let are = if count == 1 { "is" } else { "are" };
        format!("`{name}` takes {takes}, and there {are} {count}: write --task '{name}(…)'")
    })
}
