//! The parameters of a task, and the values that replace them.
//!
//! Binding is substitution: the value becomes a constant in the conditions of the predicates, in a
//! copy of the compiled module. The automaton does not depend on parameters, so it is never
//! rebuilt. Checks are those of the generated Rust, made here instead of by rustc: number and names
//! of the arguments, their types and units, and that no index lies outside its array.

use std::fmt;
use std::sync::Arc;

use tltl_compiler::predicate::{
    Module, Number, Parameter as Declared, ParameterType, Scalar, Task, Term,
};

/// A value for a parameter of a task.
///
/// A text is read as the language would read it in this place: the name of a value of an
/// enumeration, with or without the name of the enumeration, `none`, `true`, a number, or the name
/// of a constant of the file. A number or a truth value fits only a parameter of such a type.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::task::TaskFile;
///
/// let source = Source::new("kitchen.tltl", "
///     enum Object { apple, mug }
///     state Kitchen { holding: Object? }
///     predicate hold(o: Object) = holding == o
///     task grasp(o: Object) = F hold(o)");
/// let grasp = TaskFile::new(source, Budget::default())?.find(None)?;
/// assert!(grasp.bind(&[("o", "apple".into())]).is_ok());
/// assert!(grasp.bind(&[("o", "Object::mug".into())]).is_ok());
/// let refused = grasp.bind(&[("o", 1.0.into())]).unwrap_err();
/// assert_eq!(refused.to_string(), "`grasp` takes `o: Object`, and `1` is not one of apple, mug");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Number(f64),
    /// A truth value.
    Truth(bool),
    /// Any value, as text.
    Text(String),
}

impl From<f64> for Value {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

impl From<bool> for Value {
    fn from(truth: bool) -> Self {
        Self::Truth(truth)
    }
}

impl From<&str> for Value {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(f),
            Self::Truth(truth) => truth.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}

/// The arguments of a task by the names of its parameters, shared by all clones of the task.
pub(super) type Arguments = Arc<[(String, Value)]>;

/// A parameter of a task, described for the caller who has to give it a value.
///
/// It prints as the source declares it: `far: f64 in m`.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::task::TaskFile;
///
/// let source = Source::new("kitchen.tltl", "
///     enum Object { apple, mug }
///     state Kitchen { holding: Object?, x: f64 in m }
///     task grasp(o: Object?, far: f64 in m) = F (holding == o && x < far)");
/// let grasp = TaskFile::new(source, Budget::default())?.find(None)?;
/// let [o, far] = &grasp.parameters()[..] else { panic!("two parameters") };
/// assert_eq!((o.to_string(), far.to_string()), ("o: Object?".into(), "far: f64 in m".into()));
/// assert!(far.values.is_empty() && o.values == ["apple", "mug", "none"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// The name of its type in the language: `f64`, `bool`, `Object?`.
    pub ty: String,
    /// The unit that the source declares for it, as text: `m/s`. Arguments are plain numbers in
    /// this unit; nothing is converted.
    pub unit: Option<String>,
    /// The names of its values, if its type is finite: those of the enumeration, `none` last if it
    /// is optional, or `true` and `false`. Empty for a number.
    pub values: Vec<String>,
}

impl Parameter {
    pub(super) fn new(module: &Module, declared: &Declared) -> Self {
        let (ty, values) = match declared.ty {
            ParameterType::Scalar(Scalar::Enum { of, optional }) => {
                let known = &module.enums[of as usize];
                let mark = if optional { "?" } else { "" };
                let none = optional.then(|| "none".to_owned());
                let values = known.variants.iter().cloned().chain(none).collect();
                (format!("{}{mark}", known.name), values)
            }
            ParameterType::Scalar(Scalar::Bool) => {
                ("bool".to_owned(), ["true", "false"].map(str::to_owned).to_vec())
            }
            ParameterType::Scalar(scalar) => (scalar.name().to_owned(), Vec::new()),
            ParameterType::Host(_) => ("a type of Rust".to_owned(), Vec::new()),
        };
        let unit = declared.unit.as_ref().map(|unit| module.units.text(unit));
        Self { name: declared.name.clone(), ty, unit, values }
    }
}

/// As the source declares it, and the unit: `d: f64 in m`.
impl fmt::Display for Parameter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.name, self.ty)?;
        self.unit.as_ref().map_or(Ok(()), |unit| write!(f, " in {unit}"))
    }
}

/// The parameters in words, for messages: `no arguments`, `1 argument (d: f64)`.
pub(crate) fn listed(parameters: &[Parameter]) -> String {
    let named: Vec<_> = parameters.iter().map(Parameter::to_string).collect();
    match parameters.len() {
        0 => "no arguments".to_owned(),
        1 => format!("1 argument ({})", named[0]),
        count => format!("{count} arguments ({})", named.join(", ")),
    }
}

/// The reason why a task does not take some arguments, in one sentence.
///
/// It names the task, what it takes, and the argument at fault; it ends without a full stop.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::task::TaskFile;
///
/// let source = Source::new("dock.tltl", "state Robot { x: f64 }\ntask dock(far: f64) = F x > far");
/// let dock = TaskFile::new(source, Budget::default())?.find(None)?;
/// let error = dock.bind(&[("near", 1.0.into())]).unwrap_err();
/// assert_eq!(error.to_string(), "`dock` takes 1 argument (far: f64), and none is called `near`");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ArgumentError(String);

impl fmt::Display for ArgumentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for ArgumentError {}

/// Replaces the parameters of `task` by `given` values in the conditions of all its predicates.
///
/// `module` is a copy of the caller's; other tasks in it keep their parameters only as long as they
/// share no predicate with this one, so it serves this task alone.
pub(super) fn bind(
    module: &mut Module,
    task: &Task,
    given: &[(&str, Value)],
) -> Result<(), ArgumentError> {
    let name = task.name.as_deref().unwrap_or("the formula");
    let values = matched(module, task, given)
        .map_err(|(takes, but)| ArgumentError(format!("`{name}` takes {takes}, and {but}")))?;
    let mut arguments = Vec::new();
    for (parameter, value) in task.parameters.iter().zip(values) {
        let term = term(module, parameter, value).map_err(|but| {
            let wanted = Parameter::new(module, parameter);
            ArgumentError(format!("`{name}` takes `{wanted}`, and `{value}` is {but}"))
        })?;
        arguments.push((parameter.name.clone(), module.arena.add_term(term)));
    }
    for predicate in &task.predicates {
        let condition = &mut module.predicates[predicate.0 as usize].condition;
        *condition = module.arena.substitute(*condition, &arguments);
    }
    match module.missing_element(task) {
        Some((place, length)) => Err(ArgumentError(format!(
            "with these arguments, `{}` is beyond an array of {length} elements",
            module.display_term(place)
        ))),
        None => Ok(()),
    }
}

/// The value of each parameter in the order of the declaration; or the words for what the task
/// takes and for what is wrong with the arguments.
fn matched<'a>(
    module: &Module,
    task: &Task,
    given: &'a [(&str, Value)],
) -> Result<Vec<&'a Value>, (String, String)> {
    let names: Vec<_> = task.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    let parameters = task.parameters.iter().map(|known| Parameter::new(module, known));
    let wrong = |but| Err((listed(&parameters.collect::<Vec<_>>()), but));
    for (at, (name, _)) in given.iter().enumerate() {
        if !names.contains(name) {
            return wrong(format!("none is called `{name}`"));
        }
        if given[..at].iter().any(|(earlier, _)| earlier == name) {
            return wrong(format!("`{name}` is given twice"));
        }
    }
    let value = |name: &&str| given.iter().find(|(given, _)| given == name).map(|(_, value)| value);
    match names.iter().find(|name| value(name).is_none()) {
        Some(missing) => wrong(format!("`{missing}` is missing")),
        None => Ok(names.iter().filter_map(value).collect()),
    }
}

/// The value as a term of the parameter's type, or the words for the values that would fit.
fn term(module: &Module, parameter: &Declared, value: &Value) -> Result<Term, String> {
    if let Value::Text(text) = value
        && let Some(unit) = other_unit(module, parameter, text)
    {
        return Err(format!("in {unit}"));
    }
    let term = parameter.ty.scalar().and_then(|scalar| match value {
        Value::Number(number) => self::number(scalar, *number),
        Value::Truth(truth) => (scalar == Scalar::Bool).then_some(Term::Truth(*truth)),
        Value::Text(text) => read(module, scalar, text),
    });
    term.ok_or_else(|| format!("not one of {}", values(module, parameter)))
}

/// The unit of the constant called `text`, if it differs from the unit of the parameter. A plain
/// number has no unit to compare.
fn other_unit(module: &Module, parameter: &Declared, text: &str) -> Option<String> {
    let constant = module.constants.iter().find(|known| known.name == text)?;
    let (wanted, found) = (parameter.unit.as_ref()?, constant.unit.as_ref()?);
    (wanted != found).then(|| module.units.text(found))
}

/// The values of a parameter in words: a list of names, or a range of numbers.
fn values(module: &Module, parameter: &Declared) -> String {
    let named = Parameter::new(module, parameter).values;
    match parameter.ty {
        _ if !named.is_empty() => named.join(", "),
        ParameterType::Scalar(scalar) => match scalar.whole() {
            Some((least, most)) => format!("the whole numbers from {least} to {most}"),
            None => "the numbers".to_owned(),
        },
        ParameterType::Host(_) => "what the command line can say".to_owned(),
    }
}

/// Reads `text` as a value of this type; `None` if it is not one.
fn read(module: &Module, scalar: Scalar, text: &str) -> Option<Term> {
    match scalar {
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
        Scalar::Number(_) => {
            let constant = module.constants.iter().find(|known| known.name == text);
            let value = constant.map_or_else(|| text.parse().ok(), |known| Some(known.value))?;
            number(scalar, value)
        }
    }
}

/// `value` as a number of this type; `None` if the type does not have it.
///
/// Adding 0 turns -0 into 0: otherwise two arguments that compare equal would print, and hash,
/// differently.
fn number(scalar: Scalar, value: f64) -> Option<Term> {
    let fits = match (scalar, scalar.whole()) {
        (Scalar::Bool | Scalar::Enum { .. }, _) => false,
        (_, Some((least, most))) => {
            value.fract() == 0.0 && (least..=most).contains(&(value as i128))
        }
        (_, None) => value.is_finite(),
    };
    fits.then_some(Term::Number(Number(value + 0.0)))
}
