//! The state in C, and the predicates over it: robustness and truth.
//!
//! The operations are those of the generated Rust (`emit::predicates` of the compiler), in the same
//! order, so that the two agree to the last bit wherever the C compiler keeps to IEEE 754.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use tltl_compiler::ast::Comparison;
use tltl_compiler::predicate::{
    Condition, ConditionId, Function, Module, Number, Numeric, ParameterType, Scalar, State, Step,
    Struct, Task, Term, TermId, Type,
};

use super::names::Names;
use super::{Refused, comment};

/// Expressions deeper than this are cut by a local, as in Rust.
const DEPTH: u32 = 12;

/// The two readings of a predicate.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Reading {
    /// The robustness, a `double`; NaN if it is none.
    Robustness,
    /// 1 or 0, or -1 if the robustness is not a number.
    Truth,
}

/// The types of a source in C.
pub(super) struct Types<'a> {
    module: &'a Module,
    pub(super) names: Names,
    /// The names of the enumerations, and of their values.
    enums: Vec<(String, Vec<String>)>,
    structs: Vec<String>,
    /// The name of the state's type.
    pub(super) state: String,
}

impl<'a> Types<'a> {
    pub(super) fn new(module: &'a Module, mut names: Names) -> Self {
        let mut enums = Vec::new();
        for one in &module.enums {
            let name = names.outer(&one.name);
            let value = |value: &String| names.outer(&format!("{}_{value}", one.name));
            enums.push((name, one.variants.iter().map(value).collect()));
        }
        let structs = module.structs.iter().map(|one| names.outer(&one.name)).collect();
        let state = match &module.state {
            State::Declared(state) => names.outer(&state.name),
            _ => format!("{}_state", names.prefix),
        };
        Self { module, names, enums, structs, state }
    }

    /// The declarations of all types, the state and the arguments last.
    ///
    /// # Errors
    /// If a parameter of the task has a type of Rust.
    pub(super) fn declarations(&mut self, task: &Task) -> Result<String, Refused> {
        let module = self.module;
        let mut text = String::new();
        for (one, (name, values)) in module.enums.iter().zip(&self.enums) {
            let none = format!("{name}_none = -1");
            let values = values.iter().enumerate().map(|(i, value)| format!("{value} = {i}"));
            let values: Vec<String> = [none].into_iter().chain(values).collect();
            let about = documentation(&one.docs);
            let _ = writeln!(text, "{about}typedef enum {{ {} }} {name};\n", values.join(", "));
        }
        for (i, one) in module.structs.iter().enumerate() {
            let name = self.structs[i].clone();
            text += &self.structure(one, &name);
        }
        let state = self.state.clone();
        match &module.state {
            State::Declared(declared) => text += &self.structure(declared, &state),
            _ => text += &self.free(task, &state),
        }
        if !task.parameters.is_empty() {
            text += "/* What the task takes. */\ntypedef struct {\n";
            for parameter in &task.parameters {
                let ParameterType::Scalar(scalar) = parameter.ty else {
                    return Err(Refused::Parameter(parameter.name.clone()));
                };
                let name = self.names.member(&parameter.name);
                let unit = parameter.unit.as_ref().map(|unit| module.units.text(unit));
                let declared = self.declared(&Type::Scalar(scalar), name);
                let _ = writeln!(text, "    {declared};{}", unit.map(in_unit).unwrap_or_default());
            }
            let _ = writeln!(text, "}} {}_arguments;\n", self.names.prefix);
        }
        Ok(text)
    }

    fn structure(&mut self, of: &Struct, name: &str) -> String {
        let mut text = format!("{}typedef struct {{\n", documentation(&of.docs));
        for field in &of.fields {
            let unit = field.unit.as_ref().map(|unit| self.module.units.text(unit));
            let about: Vec<String> = field.docs.iter().map(|line| comment(line.trim())).collect();
            let about =
                about.join(" ") + &unit.map(|unit| format!(" [{unit}]")).unwrap_or_default();
            let member = self.names.member(&field.name);
            let declared = self.declared(&field.ty, member);
            let about = match about.trim() {
                "" => String::new(),
                about => format!(" /* {about} */"),
            };
            let _ = writeln!(text, "    {declared};{about}");
        }
        if of.fields.is_empty() {
            text += "    char unused;\n";
        }
        text + &format!("}} {name};\n\n")
    }

    /// The state of a bare formula: a number for each of its names.
    fn free(&mut self, task: &Task, name: &str) -> String {
        let module = self.module;
        let root =
            |id: &tltl_compiler::predicate::PredicateId| module.predicates[id.0 as usize].condition;
        let conditions = module.conditions_of(task.predicates.iter().map(root).collect());
        let mut text = "typedef struct {\n".to_owned();
        for id in module.terms_of(&conditions) {
            if let Term::Variable(of) = module.arena.term(id) {
                let _ = writeln!(text, "    double {};", self.variable(of));
            }
        }
        for id in conditions {
            if let Condition::Free(of) = module.arena.condition(id) {
                let member = self.names.member(of);
                let _ = writeln!(text, "    double {member}; /* holds if it is positive */");
            }
        }
        if text.ends_with("{\n") {
            text += "    char unused;\n";
        }
        text + &format!("}} {name};\n\n")
    }

    /// A variable may have the name of a proposition.
    fn variable(&mut self, name: &str) -> String {
        self.names.member(&format!("r#{name}"))
    }

    /// A declaration without the `;` behind it.
    fn declared(&self, ty: &Type, name: String) -> String {
        match ty {
            Type::Scalar(Scalar::Number(numeric)) => format!("{} {name}", number_type(*numeric)),
            Type::Scalar(Scalar::Bool) => format!("bool {name}"),
            Type::Scalar(Scalar::Enum { of, .. }) => {
                format!("{} {name}", self.enums[*of as usize].0)
            }
            Type::Struct(of) => format!("{} {name}", self.structs[*of as usize]),
            Type::Array(element, length) => {
                self.declared(element, format!("{name}[{}]", (*length).max(1)))
            }
            Type::Table(element, of) => {
                let length = self.enums[*of as usize].1.len();
                self.declared(element, format!("{name}[{length}]"))
            }
        }
    }

    /// The body of the function that reads a condition in one way.
    ///
    /// # Errors
    /// If it is Rust code.
    pub(super) fn body(&mut self, root: ConditionId, reading: Reading) -> Result<String, Refused> {
        let mut writer = Writer {
            module: self.module,
            uses: uses(self.module, root),
            types: self,
            reading,
            terms: BTreeMap::new(),
            conditions: BTreeMap::new(),
            locals: String::new(),
        };
        let code = writer.all(root)?;
        let locals = writer.locals;
        let can_fail = code.contains("&nan") || locals.contains("&nan");
        let (flag, type_of) = match reading {
            Reading::Robustness => ("NAN", "double"),
            Reading::Truth => ("-1", "int"),
        };
        let code = bare(&code);
        Ok(match can_fail {
            false => format!("{locals}    return {code};\n"),
            true => format!(
                "    int nan = 0;\n{locals}    const {type_of} value = {code};\n    \
                 return nan ? {flag} : value;\n"
            ),
        })
    }
}

/// An expression without brackets around all of it.
fn bare(code: &str) -> &str {
    let Some(inner) = code.strip_prefix('(').and_then(|code| code.strip_suffix(')')) else {
        return code;
    };
    let mut depth = 0_i32;
    let closes_early = inner.chars().any(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth < 0
    });
    if closes_early { code } else { inner }
}

fn documentation(docs: &[String]) -> String {
    let lines: Vec<String> = docs.iter().map(|line| comment(line.trim())).collect();
    if lines.is_empty() { String::new() } else { format!("/* {} */\n", lines.join("\n * ")) }
}

fn in_unit(unit: String) -> String {
    format!(" /* [{}] */", comment(&unit))
}

fn number_type(numeric: Numeric) -> String {
    match numeric {
        Numeric::F64 => "double".to_owned(),
        Numeric::F32 => "float".to_owned(),
        whole => {
            let (sign, bits) = whole.name().split_at(1);
            format!("{}int{bits}_t", if sign == "u" { "u" } else { "" })
        }
    }
}

/// A number in C. Rust prints the shortest decimal that reads back as the same number.
fn number(value: f64) -> String {
    if value < 0.0 { format!("(-{:?})", -value) } else { format!("{value:?}") }
}

/// How often a condition needs each other condition and each term.
fn uses(module: &Module, root: ConditionId) -> (BTreeMap<u32, u32>, BTreeMap<u32, u32>) {
    let (mut of_conditions, mut of_terms) = (BTreeMap::new(), BTreeMap::new());
    let conditions = module.conditions_of(vec![root]);
    for &id in &conditions {
        for operand in operands(module, id) {
            *of_conditions.entry(operand.0).or_insert(0) += 1;
        }
        if let Condition::Compare(_, a, b) = module.arena.condition(id) {
            [a, b].into_iter().for_each(|a| *of_terms.entry(a.0).or_insert(0) += 1);
        }
    }
    for id in module.terms_of(&conditions) {
        for operand in module.arena.term(id).operands() {
            *of_terms.entry(operand.0).or_insert(0) += 1;
        }
    }
    (of_conditions, of_terms)
}

/// The conditions that a condition is made of; of another predicate what it means.
fn operands(module: &Module, id: ConditionId) -> Vec<ConditionId> {
    match module.arena.condition(id) {
        Condition::Is(predicate) => vec![module.predicates[predicate.0 as usize].condition],
        condition => condition.operands(),
    }
}

/// An expression and its depth.
#[derive(Clone)]
struct Written(String, u32);

/// Writes one condition, operands first.
struct Writer<'t, 'a> {
    module: &'a Module,
    types: &'t mut Types<'a>,
    reading: Reading,
    uses: (BTreeMap<u32, u32>, BTreeMap<u32, u32>),
    terms: BTreeMap<TermId, Written>,
    conditions: BTreeMap<ConditionId, Written>,
    locals: String,
}

impl Writer<'_, '_> {
    fn all(&mut self, root: ConditionId) -> Result<String, Refused> {
        let conditions = self.module.conditions_of(vec![root]);
        for id in self.module.terms_of(&conditions) {
            let written = self.term(id)?;
            let is_long = written.1 > 0 && self.uses.1.get(&id.0).is_some_and(|&uses| uses > 1);
            let written = self.kept(written, is_long, "double", format!("t{}", id.0));
            self.terms.insert(id, written);
        }
        for id in conditions {
            let written = self.condition(id)?;
            let is_long = written.1 > 0 && self.uses.0.get(&id.0).is_some_and(|&uses| uses > 1);
            let type_of = if self.reading == Reading::Robustness { "double" } else { "int" };
            let written = self.kept(written, is_long, type_of, format!("c{}", id.0));
            self.conditions.insert(id, written);
        }
        Ok(self.conditions[&root].0.clone())
    }

    /// The expression, or a local if it is used more than once or lies deep.
    fn kept(&mut self, of: Written, is_long: bool, type_of: &str, name: String) -> Written {
        if !is_long && of.1 <= DEPTH {
            return of;
        }
        let _ = writeln!(self.locals, "    const {type_of} {name} = {};", of.0);
        Written(name, 0)
    }

    fn condition(&mut self, id: ConditionId) -> Result<Written, Refused> {
        let robust = self.reading == Reading::Robustness;
        let prefix = self.types.names.prefix.clone();
        let of = |id: &ConditionId| self.conditions[id].clone();
        Ok(match self.module.arena.condition(id) {
            Condition::Truth(value) => Written(truth(*value, robust).to_owned(), 0),
            Condition::Not(a) => {
                let Written(a, depth) = of(a);
                let code = if robust { format!("(-{a})") } else { format!("({a} == 0)") };
                Written(code, depth + 1)
            }
            Condition::And(a, b) => binary(&prefix, robust, "min", "&", of(a), of(b)),
            Condition::Or(a, b) => binary(&prefix, robust, "max", "|", of(a), of(b)),
            Condition::Compare(comparison, a, b) => {
                let is_value = [a, b].iter().any(|term| self.module.arena.is_value(**term));
                let [a, b] = [a, b].map(|term| self.terms[term].clone());
                match is_value {
                    true => values(robust, *comparison, a, b),
                    false => comparison_of(&prefix, robust, *comparison, a, b),
                }
            }
            Condition::Bool(place) => {
                let Written(place, depth) = self.terms[place].clone();
                Written(one_or_minus_one(robust, place), depth + 1)
            }
            Condition::Is(_) | Condition::Apply { .. } => of(&operands(self.module, id)[0]),
            Condition::Free(name) => {
                let member = self.types.names.member(name);
                let rho = Written(format!("s->{member}"), 0);
                match robust {
                    true => rho,
                    false => {
                        let zero = Written("0.0".to_owned(), 0);
                        comparison_of(&prefix, false, Comparison::Greater, rho, zero)
                    }
                }
            }
            Condition::Value { text, .. } => return Err(Refused::Rust(text.clone())),
        })
    }

    fn term(&mut self, id: TermId) -> Result<Written, Refused> {
        let prefix = &self.types.names.prefix;
        let of = |id: &TermId| self.terms[id].clone();
        Ok(match self.module.arena.term(id) {
            Term::Number(Number(value)) => Written(number(*value), 0),
            Term::Variant { of, number, .. } => {
                Written(format!("(int){}", self.types.enums[*of as usize].1[*number as usize]), 0)
            }
            Term::Absent => Written("-1".to_owned(), 0),
            Term::Truth(value) => Written(u8::from(*value).to_string(), 0),
            Term::Variable(name) => Written(format!("s->{}", self.types.variable(name)), 0),
            Term::Place { steps, scalar } => {
                let place = self.place(steps);
                Written(read(&place, *scalar), 0)
            }
            Term::Parameter { name, ty: ParameterType::Scalar(scalar) } => {
                Written(read(&format!("p->{}", self.types.names.member(name)), *scalar), 0)
            }
            Term::Parameter { name, .. } => return Err(Refused::Parameter(name.clone())),
            Term::Host { text, .. } => return Err(Refused::Rust(text.clone())),
            Term::Negate(a) => {
                let Written(a, depth) = of(a);
                Written(format!("(-{a})"), depth + 1)
            }
            Term::Calculate(operator, a, b) => {
                let (Written(a, one), Written(b, other)) = (of(a), of(b));
                Written(format!("({a} {} {b})", operator.symbol()), one.max(other) + 1)
            }
            Term::Call(function, a, b) => {
                let Written(a, one) = of(a);
                let name = function_name(prefix, *function);
                match b.as_ref().map(of) {
                    None => Written(format!("{name}({a})"), one + 1),
                    Some(Written(b, other)) => {
                        Written(format!("{name}({a}, {b})"), one.max(other) + 1)
                    }
                }
            }
        })
    }

    /// A place within the state. An index that is known only when the program runs is checked: in C
    /// an enumeration may have any number.
    fn place(&mut self, steps: &[Step]) -> String {
        let mut place = "s".to_owned();
        for step in steps {
            match step {
                Step::Field(name) => {
                    let arrow = if place == "s" { "->" } else { "." };
                    place = format!("{place}{arrow}{}", self.types.names.member(name));
                }
                Step::Index(index) => place = format!("{place}[{index}]"),
                Step::Element(index) => place = self.element(&place, *index, None),
                Step::At { index, length } => place = self.element(&place, *index, Some(*length)),
            }
        }
        place
    }

    /// The element at an index; of a table the index is a value of its enumeration.
    fn element(&mut self, array: &str, index: TermId, length: Option<u32>) -> String {
        let (code, of) = match self.module.arena.term(index) {
            Term::Place { steps, scalar } => (self.place(steps), Some(*scalar)),
            Term::Parameter { name, ty } => {
                (format!("p->{}", self.types.names.member(name)), ty.scalar())
            }
            Term::Variant { number, .. } => return format!("{array}[{number}]"),
            _ => return format!("{array}[{}]", self.terms[&index].0.trim_end_matches(".0")),
        };
        let length = match of {
            Some(Scalar::Enum { of, .. }) => self.types.enums[of as usize].1.len(),
            _ => length.unwrap_or_default() as usize,
        };
        let prefix = &self.types.names.prefix;
        format!("{array}[{prefix}_index((uint64_t){code}, {length}u, &nan)]")
    }
}

/// A constant condition.
fn truth(value: bool, robust: bool) -> &'static str {
    match (robust, value) {
        (true, true) => "INFINITY",
        (true, false) => "(-INFINITY)",
        (false, true) => "1",
        (false, false) => "0",
    }
}

/// The robustness of a truth value, or its truth.
fn one_or_minus_one(robust: bool, code: String) -> String {
    if robust { format!("({code} ? 1.0 : -1.0)") } else { format!("({code} ? 1 : 0)") }
}

/// A conjunction or a disjunction. Both sides are evaluated: whether a NaN on the right is an error
/// must not depend on the left.
fn binary(
    prefix: &str,
    robust: bool,
    function: &str,
    operator: &str,
    Written(a, one): Written,
    Written(b, other): Written,
) -> Written {
    let code = match robust {
        true => format!("{prefix}_{function}({a}, {b})"),
        false => format!("({a} {operator} {b})"),
    };
    Written(code, one.max(other) + 1)
}

/// A comparison of numbers: of the difference with 0, so that robustness and truth agree.
fn comparison_of(
    prefix: &str,
    robust: bool,
    comparison: Comparison,
    Written(a, one): Written,
    Written(b, other): Written,
) -> Written {
    let code = match (robust, comparison) {
        (true, Comparison::Less | Comparison::AtMost) => format!("({b} - {a})"),
        (true, Comparison::Greater | Comparison::AtLeast) => format!("({a} - {b})"),
        (true, Comparison::Equal) => format!("(-fabs({a} - {b}))"),
        (true, Comparison::Unequal) => format!("fabs({a} - {b})"),
        (false, Comparison::Less) => format!("{prefix}_positive({b} - {a}, &nan)"),
        (false, Comparison::Greater) => format!("{prefix}_positive({a} - {b}, &nan)"),
        (false, Comparison::AtMost) => format!("{prefix}_not_negative({b} - {a}, &nan)"),
        (false, Comparison::AtLeast) => format!("{prefix}_not_negative({a} - {b}, &nan)"),
        (false, Comparison::Equal) => format!("{prefix}_zero({b} - {a}, &nan)"),
        (false, Comparison::Unequal) => format!("({prefix}_zero({b} - {a}, &nan) == 0)"),
    };
    Written(code, one.max(other) + 1)
}

/// Whether two values of an enumeration or two truth values are equal.
fn values(
    robust: bool,
    comparison: Comparison,
    Written(a, _): Written,
    Written(b, _): Written,
) -> Written {
    let symbol = if comparison == Comparison::Unequal { "!=" } else { "==" };
    Written(one_or_minus_one(robust, format!("({a} {symbol} {b})")), 1)
}

/// A place as a number of C: a `double`, or an `int` for values of enumerations and truth values.
fn read(place: &str, scalar: Scalar) -> String {
    match scalar {
        Scalar::Number(Numeric::F64) | Scalar::Bool => place.to_owned(),
        Scalar::Number(_) => format!("(double){place}"),
        Scalar::Enum { .. } => format!("(int){place}"),
    }
}

/// What C calls a function. `min` and `max` are ours, for those of C lose a NaN.
fn function_name(prefix: &str, function: Function) -> String {
    match function {
        Function::Min | Function::Max => format!("{prefix}_{}", function.name()),
        Function::Abs => "fabs".to_owned(),
        Function::Ln => "log".to_owned(),
        other => other.name().to_owned(),
    }
}
