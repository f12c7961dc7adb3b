//! Names of columns, and the places of a state that they are.
//!
//! A place `pose.x` or `joints[2]` is found under its own name, or under another usual spelling of
//! its path: `/pose/x`, `pose/x`, `joints.2`, `joints/2`, each with its unit behind it or without,
//! `x [m]`, `x (m)`. A unit must be the one that the source declares, for numbers are not converted.

use tltl_compiler::ast::quoted;

use crate::evaluate::Input;

/// One column that is wanted.
pub(in crate::cli) struct Place<'a> {
    /// The input that it fills; `None` for the column that tells episodes apart.
    pub(super) input: Option<&'a Input>,
    /// The name to look for.
    pub(super) column: &'a str,
    /// Its path.
    pub(super) steps: Vec<String>,
    /// Whether the user has chosen the column. Its unit is then the user's affair.
    is_chosen: bool,
}

impl<'a> Place<'a> {
    /// The place of an input, or of the episode, in the column that the user has `chosen`, or else
    /// in the one called like the input.
    pub(in crate::cli) fn new(input: Option<&'a Input>, chosen: Option<&'a str>) -> Self {
        let own = input.map_or("episode", |input| &input.name);
        let column = chosen.unwrap_or(own).trim();
        let steps = steps(without_unit(column).0).map(str::to_owned).collect();
        Self { input, column, steps, is_chosen: chosen.is_some() }
    }
}

/// The steps of a path: `pose`, `x`; `joints`, `2`.
fn steps(path: &str) -> impl Iterator<Item = &str> {
    let steps = path.split(['.', '/', '[']);
    steps.map(|step| step.trim().trim_end_matches(']').trim_end()).filter(|step| !step.is_empty())
}

/// A name without the unit behind it, and the unit. Digits in brackets are an index.
fn without_unit(column: &str) -> (&str, Option<&str>) {
    let column = column.trim();
    for (open, close) in [('[', ']'), ('(', ')')] {
        let parts = column.strip_suffix(close).and_then(|rest| rest.rsplit_once(open));
        if let Some((path, unit)) = parts
            && !path.trim().is_empty()
            && !unit.bytes().all(|byte| byte.is_ascii_digit())
        {
            return (path.trim(), Some(unit.trim()));
        }
    }
    (column, None)
}

/// The index of the name that is this place: its own, or else another spelling of it.
///
/// # Errors
/// If two names are, or the name has another unit than the place.
pub(super) fn find(names: &[&str], place: &Place<'_>) -> Result<Option<usize>, String> {
    let own = |name: &&str| name.trim() == place.column;
    let spelled = |name: &&str| steps(without_unit(name).0).eq(&place.steps);
    let is_this: &dyn Fn(&&str) -> bool = if names.iter().any(own) { &own } else { &spelled };
    let mut found = names.iter().enumerate().filter(|(_, name)| is_this(name));
    let Some((index, name)) = found.next() else { return Ok(None) };
    if let Some((_, second)) = found.next() {
        let [first, other] = [name, second].map(|name| quoted(name.trim()));
        return Err(match name.trim() == second.trim() {
            true => format!("two columns are called `{first}`"),
            false => format!("`{first}` and `{other}` are both `{}`", place.column),
        });
    }
    check_unit(name, place).map(|()| Some(index))
}

/// The unit behind the name of a column, against that of the place.
fn check_unit(column: &str, place: &Place<'_>) -> Result<(), String> {
    let declared = place.input.and_then(|input| input.unit.as_deref());
    match (declared, without_unit(column).1) {
        (Some(declared), Some(unit)) if !place.is_chosen && written(declared) != written(unit) => {
            let (name, column, unit) = (place.column, quoted(column), quoted(unit));
            Err(format!(
                "the column `{column}` is in {unit}, and `{name}` is in {declared}; numbers are \
                 not converted (--map '{name}={column}' reads them as they stand)"
            ))
        }
        _ => Ok(()),
    }
}

/// A unit in one of its spellings: `m/s²` is `m/s^2`.
fn written(unit: &str) -> String {
    let plain = unit.replace(['·', '⋅'], "*").replace('²', "^2").replace('³', "^3");
    plain.chars().filter(|c| !c.is_whitespace()).collect()
}

#[cfg(test)]
mod tests {
    use super::{Place, find, steps, without_unit};

    #[test]
    fn a_path_has_many_spellings() {
        for path in ["pose.joints[2]", "/pose/joints/2", "pose/joints[2]", "pose.joints.2"] {
            assert!(steps(path).eq(["pose", "joints", "2"]), "{path}");
        }
        assert_eq!(without_unit("x [m/s]"), ("x", Some("m/s")));
        assert_eq!(without_unit(" x(m) "), ("x", Some("m")));
        assert_eq!(without_unit("joints [2]"), ("joints [2]", None));
        assert_eq!(without_unit("[m]"), ("[m]", None));
    }

    #[test]
    fn its_own_name_comes_first_and_two_others_are_refused() {
        let place = Place::new(None, Some("a.b"));
        assert_eq!(find(&["/a/b", "a.b"], &place), Ok(Some(1)));
        assert_eq!(find(&["a", "b"], &place), Ok(None));
        let both = "`/a/b` and `a.b [m]` are both `a.b`";
        assert_eq!(find(&["/a/b", "a.b [m]"], &place), Err(both.to_owned()));
    }
}
