//! Arguments for a task with parameters: `deliver(apple, fridge)`, as a task of the language has
//! them.

use tltl_compiler::predicate::{
    Arguments, Module, Number, Parameter, ParameterType, Scalar, Task, Term,
};

/// The name and the arguments of `name(argument, …)`; no arguments if there are no brackets.
pub(super) fn split(text: &str) -> Result<(&str, Option<Vec<&str>>), String> {
    let Some((name, rest)) = text.split_once('(') else { return Ok((text.trim(), None)) };
    let Some(inner) = rest.trim_end().strip_suffix(')') else {
        return Err(format!("`{text}` is not closed: write `{}(…)`", name.trim()));
    };
    let given = inner.split(',').map(str::trim).collect();
    let given = if inner.trim().is_empty() { Vec::new() } else { given };
    Ok((name.trim(), Some(given)))
}

/// Puts arguments in the place of a task's parameters, in all that its predicates say.
pub(super) fn bind(module: &mut Module, task: &Task, given: &[&str]) -> Result<(), String> {
    let name = task.name.as_deref().unwrap_or("the formula");
    let taken: Vec<_> = task.parameters.iter().map(|known| declared(module, known)).collect();
    if given.len() != taken.len() {
        let are = if given.len() == 1 { "is" } else { "are" };
        let takes = match taken.len() {
            0 => return Err(format!("`{name}` takes no arguments: write --task {name}")),
            1 => format!("1 argument ({})", taken[0]),
            count => format!("{count} arguments ({})", taken.join(", ")),
        };
        let count = given.len();
        return Err(format!(
            "`{name}` takes {takes}, and there {are} {count}: write --task '{name}(…)'"
        ));
    }
    let mut arguments = Arguments::new();
    for (parameter, text) in task.parameters.iter().zip(given) {
        if let Some(unit) = other_unit(module, parameter, text) {
            let wanted = declared(module, parameter);
            return Err(format!("`{name}` takes `{wanted}`, and `{text}` is in {unit}"));
        }
        let term = value(module, parameter, text).ok_or_else(|| {
            let (wanted, known) = (declared(module, parameter), values(module, parameter));
            format!("`{name}` takes `{wanted}`, and `{text}` is not one of {known}")
        })?;
        arguments.push((parameter.name.clone(), module.arena.add_term(term)));
    }
    for predicate in &task.predicates {
        let condition = &mut module.predicates[predicate.0 as usize].condition;
        *condition = module.arena.substitute(*condition, &arguments);
    }
    match module.missing_element(task) {
        Some((place, length)) => {
            let place = module.display_term(place);
            Err(format!("with these arguments, `{place}` is beyond an array of {length} elements"))
        }
        None => Ok(()),
    }
}

/// The unit of the constant `text` if the parameter is in another.
fn other_unit(module: &Module, parameter: &Parameter, text: &str) -> Option<String> {
    let constant = module.constants.iter().find(|known| known.name == text)?;
    let (wanted, found) = (parameter.unit.as_ref()?, constant.unit.as_ref()?);
    (wanted != found).then(|| module.units.text(found))
}

/// `name: type`
fn declared(module: &Module, parameter: &Parameter) -> String {
    let ty = match parameter.ty {
        ParameterType::Scalar(Scalar::Enum { of, optional }) => {
            let mark = if optional { "?" } else { "" };
            format!("{}{mark}", module.enums[of as usize].name)
        }
        ParameterType::Scalar(scalar) => scalar.name().to_owned(),
        ParameterType::Host(_) => "a type of Rust".to_owned(),
    };
    let unit = parameter.unit.as_ref().map(|unit| format!(" in {}", module.units.text(unit)));
    format!("{}: {ty}{}", parameter.name, unit.unwrap_or_default())
}

/// What a parameter's values are, in words.
fn values(module: &Module, parameter: &Parameter) -> String {
    match parameter.ty {
        ParameterType::Scalar(Scalar::Enum { of, optional }) => {
            let none = if optional { ", none" } else { "" };
            module.enums[of as usize].variants.join(", ") + none
        }
        ParameterType::Scalar(Scalar::Bool) => "true, false".to_owned(),
        ParameterType::Scalar(scalar) => match scalar.whole() {
            Some((least, most)) => format!("the whole numbers from {least} to {most}"),
            None => "the numbers".to_owned(),
        },
        ParameterType::Host(_) => "what the command line can say".to_owned(),
    }
}

/// The value that `text` is for a parameter.
fn value(module: &Module, parameter: &Parameter, text: &str) -> Option<Term> {
    match parameter.ty.scalar()? {
        Scalar::Enum { optional: true, .. } if text == "none" => Some(Term::Absent),
        Scalar::Enum { of, .. } => {
            let known = &module.enums[of as usize];
            let name = match text.split_once("::") {
                Some((prefix, name)) if prefix.trim() == known.name => name.trim(),
                Some(_) => return None,
                None => text,
            };
            let number = known.variants.iter().position(|variant| variant == name)?;
            Some(Term::Variant { of, number: u32::try_from(number).ok()?, name: name.to_owned() })
        }
        Scalar::Bool => text.parse().ok().map(Term::Truth),
        scalar => {
            let constant = module.constants.iter().find(|known| known.name == text);
            let value = constant.map_or_else(|| text.parse().ok(), |known| Some(known.value))?;
            let fits = match scalar.whole() {
                Some((least, most)) => {
                    value.fract() == 0.0 && (least..=most).contains(&(value as i128))
                }
                None => value.is_finite(),
            };
            fits.then_some(Term::Number(Number(value + 0.0)))
        }
    }
}
