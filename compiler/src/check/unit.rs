//! Units: the unit of each number of an expression, from the leaves up.
//!
//! This is a pass of its own, and it runs only in sources that declare a unit. A number without a
//! declared unit may be in any, so a mistake is reported only where two declared units meet: units
//! can be added to a source one field at a time. A number with a mistake fits everything, and so
//! does whatever is made of it.
//!
//! Terms are shared by their values, which have no units, so this pass goes over the expressions as
//! they were written.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "state Car { x: f64 in m, speed: f64 in m/s }\ntask stop = F x < speed";
//! let errors = check::file(&Source::new("car.tltl", text)).unwrap_err();
//! let message = "`x` is in m, but `speed` is in m/s: they cannot be compared";
//! assert_eq!((errors.first().kind().name(), errors.first().message()), ("unit", message));
//! // A time makes a distance of a speed.
//! let gap = text.replace("task", "const gap in s = 2\ntask").replace("< speed", "< speed * gap");
//! assert!(check::file(&Source::new("car.tltl", gap)).is_ok());
//! ```

use super::role::{Role, Roles};
use crate::ast::{Arithmetic, Infix, Prefix, quoted};
use crate::error::{Error, Kind};
use crate::predicate::{Function, TermId};
use crate::resolve::{Callee, Expression, ExpressionId, Name, Resolved, large_unit};
use crate::unit::Unit;

/// The knowledge about the unit of a number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    /// Nothing: it is not declared.
    Free,
    /// There is a mistake in it, which has been reported.
    Broken,
    /// It is made of written numbers alone and fits any unit, as 1 does in `x < 1`. As a factor
    /// beside a unit it is plain.
    Written,
    /// It is this unit.
    In(Unit),
}

impl From<Option<Unit>> for Measure {
    fn from(unit: Option<Unit>) -> Self {
        unit.map_or(Self::Free, Self::In)
    }
}

/// The state of the pass over one item.
pub(super) struct Measuring<'r> {
    pub(super) resolved: &'r Resolved<'r>,
    pub(super) item: usize,
    /// The units of the constants, by item.
    pub(super) constants: &'r [Measure],
    pub(super) roles: &'r Roles,
    /// The terms of the expressions that are numbers. One without a term has a mistake.
    pub(super) terms: &'r [Option<TermId>],
    /// The units of the expressions so far, by their position in the item.
    pub(super) known: Vec<Measure>,
    pub(super) mistakes: &'r mut Vec<Error>,
}

impl Measuring<'_> {
    /// Checks the units in the expression, and returns that of its `root`.
    pub(super) fn measure(mut self, root: ExpressionId) -> Measure {
        if !self.resolved.scope.has_units() {
            return Measure::Free;
        }
        for (id, role) in self.roles.iter() {
            let measure = match role {
                Role::Number => self.number(id),
                Role::Condition | Role::Formula { .. } => self.atom(id),
                _ => Measure::Free,
            };
            self.known.push(measure);
        }
        let measure = self.of(root);
        match self.resolved.constant(self.item) {
            Some(_) => self.constant(root, measure),
            None => measure,
        }
    }

    /// The unit of an expression that has been measured.
    fn of(&self, id: ExpressionId) -> Measure {
        self.known[self.roles.position(id)].clone()
    }

    /// Notes a mistake; what is made of the number is not checked any more.
    fn refuse(&mut self, error: Error) -> Measure {
        self.mistakes.push(error);
        Measure::Broken
    }

    /// The error for the unit of the number `id`.
    fn error(&self, id: ExpressionId, message: String) -> Error {
        Error::new(Kind::Unit, message, self.resolved[id].outer)
    }

    /// Checks a comparison, or the arguments of a predicate or task. Neither has a unit itself.
    fn atom(&mut self, id: ExpressionId) -> Measure {
        match &self.resolved[id].expression {
            Expression::Infix(Infix::Compare(_), ..) => {
                let sides = self.resolved.chain(id).into_iter().flat_map(|link| link.sides);
                let mut operands: Vec<_> = sides.collect();
                // Neighbours in a chain share an operand.
                operands.dedup();
                self.agree(&operands, "they cannot be compared");
            }
            Expression::Call(Callee { item: Some(item), .. }, arguments) => {
                self.arguments(*item, arguments);
            }
            _ => {}
        }
        Measure::Free
    }

    /// Checks arguments against the units of the parameters.
    fn arguments(&mut self, item: usize, arguments: &[ExpressionId]) {
        let resolved = self.resolved;
        let parameters = resolved.scope.parameters(item);
        if parameters.len() != arguments.len() {
            return;
        }
        for (parameter, &argument) in parameters.iter().zip(arguments) {
            let (Measure::In(found), Some(wanted)) = (self.of(argument), &parameter.unit) else {
                continue;
            };
            if found != *wanted {
                let (text, callee) = (resolved.quote(argument), quoted(resolved.item_name(item)));
                let (is, takes) = (self.is_in(&found), self.within(wanted));
                let name = &parameter.name;
                let message = format!("`{text}` {is}, but `{callee}` takes `{name}` {takes}");
                let error = self.error(argument, message);
                let error = error.related(parameter.span, self.label(wanted));
                self.mistakes.push(self.converted(error, argument, &found, wanted));
            }
        }
    }

    /// The unit of the constant of this item, whose expression has the unit `found`. The declared
    /// one counts.
    fn constant(&mut self, root: ExpressionId, found: Measure) -> Measure {
        let resolved = self.resolved;
        let Some((wanted, place)) = resolved.scope.constant_unit(self.item) else { return found };
        if let Measure::In(found) = &found
            && found != wanted
        {
            let (text, name) = (resolved.quote(root), resolved.item_name(self.item));
            let (is, within) = (self.is_in(found), self.within(wanted));
            let message = format!("`{text}` {is}, but `{name}` is declared {within}");
            let error = self.error(root, message).related(*place, "declared here");
            self.mistakes.push(self.converted(error, root, found, wanted));
        }
        Measure::In(wanted.clone())
    }

    /// The unit of one number, from those of its operands.
    fn number(&mut self, id: ExpressionId) -> Measure {
        if self.terms[self.roles.position(id)].is_none() {
            return Measure::Broken;
        }
        match &self.resolved[id].expression {
            Expression::Number(_) => Measure::Written,
            Expression::Prefix(Prefix::Minus, operand) => self.of(*operand),
            Expression::Infix(Infix::Calculate(op), left, right) => {
                self.calculated(id, *op, [*left, *right])
            }
            Expression::Call(Callee { function: Some(function), .. }, arguments) => {
                self.called(id, *function, arguments)
            }
            Expression::Name(Name::Parameter { number, .. }) => {
                self.resolved.scope.parameters(self.item)[*number as usize].unit.clone().into()
            }
            Expression::Name(Name::Item(item, _)) => self.constants[*item].clone(),
            Expression::Name(Name::Place(place, _)) => place.unit.clone().into(),
            _ => Measure::Free,
        }
    }

    /// The unit of a calculation.
    fn calculated(
        &mut self,
        id: ExpressionId,
        op: Arithmetic,
        sides: [ExpressionId; 2],
    ) -> Measure {
        match op {
            Arithmetic::Add => self.agree(&sides, "they cannot be added"),
            Arithmetic::Subtract => self.agree(&sides, "one cannot be taken from the other"),
            Arithmetic::Multiply | Arithmetic::Divide => self.product(id, op, sides),
        }
    }

    /// The unit of numbers that must all be in one; `purpose` ends the sentence if they are not.
    fn agree(&mut self, operands: &[ExpressionId], purpose: &str) -> Measure {
        let mut common: Option<(ExpressionId, Unit)> = None;
        let (mut written, mut broken) = (true, false);
        for &operand in operands {
            let measure = self.of(operand);
            written &= measure == Measure::Written;
            broken |= measure == Measure::Broken;
            let Measure::In(unit) = measure else { continue };
            match &common {
                None => common = Some((operand, unit)),
                Some((_, first)) if *first == unit => {}
                Some(first) => {
                    self.mistakes.push(self.unequal(first, &(operand, unit), purpose));
                    broken = true;
                }
            }
        }
        match common {
            _ if broken => Measure::Broken,
            Some((_, unit)) => Measure::In(unit),
            None if written => Measure::Written,
            None => Measure::Free,
        }
    }

    /// The error for two numbers of different units.
    fn unequal(
        &self,
        (a, first): &(ExpressionId, Unit),
        (b, second): &(ExpressionId, Unit),
        purpose: &str,
    ) -> Error {
        let (place, other) = (self.resolved[*a].outer, self.resolved[*b].outer);
        let (one, two) = (self.resolved.quote(*a), self.resolved.quote(*b));
        let (is, other_is) = (self.is_in(first), self.is_in(second));
        let message = format!("`{one}` {is}, but `{two}` {other_is}: {purpose}");
        let error = Error::new(Kind::Unit, message, place.to(other))
            .related(place, self.label(first))
            .related(other, self.label(second));
        self.converted(error, *b, second, first)
    }

    /// The unit of a product or a quotient.
    fn product(&mut self, id: ExpressionId, op: Arithmetic, sides: [ExpressionId; 2]) -> Measure {
        let unit = |measure| match measure {
            Measure::In(unit) => unit,
            _ => Unit::default(),
        };
        let (left, right) = match sides.map(|side| self.of(side)) {
            [Measure::Written, Measure::Written] => return Measure::Written,
            [Measure::Broken, _] | [_, Measure::Broken] => return Measure::Broken,
            [Measure::Free, _] | [_, Measure::Free] => return Measure::Free,
            [left, right] => (unit(left), unit(right)),
        };
        let divides = op == Arithmetic::Divide;
        self.bounded(id, if divides { left.over(&right) } else { left.times(&right) })
    }

    /// The unit, or the error that it is beyond the bounds.
    fn bounded(&mut self, id: ExpressionId, unit: Option<Unit>) -> Measure {
        if let Some(unit) = unit {
            return Measure::In(unit);
        }
        let message = format!("the unit of `{}` is too large", self.resolved.quote(id));
        self.refuse(large_unit(message, self.resolved[id].outer))
    }

    /// The unit of a function's value.
    fn called(
        &mut self,
        id: ExpressionId,
        function: Function,
        arguments: &[ExpressionId],
    ) -> Measure {
        let Some(&first) = arguments.first() else { return Measure::Free };
        match (function, self.of(first)) {
            (Function::Min | Function::Max | Function::Hypot | Function::Atan2, _) => {
                let message = format!("`{}` takes numbers of one unit", function.name());
                match self.agree(arguments, &message) {
                    Measure::In(_) if function == Function::Atan2 => Measure::Free,
                    measure => measure,
                }
            }
            (Function::Pow, _) => match arguments {
                [_, exponent] => self.power(id, first, *exponent),
                _ => Measure::Free,
            },
            (Function::Sqrt, Measure::In(unit)) => self.root(id, first, &unit),
            (Function::Abs | Function::Floor | Function::Ceil, measure) => measure,
            (_, Measure::In(unit)) => self.plain_argument(first, function, &unit),
            (_, measure) => measure,
        }
    }

    /// The unit of a square root.
    fn root(&mut self, id: ExpressionId, operand: ExpressionId, unit: &Unit) -> Measure {
        if let Some(root) = unit.root() {
            return Measure::In(root);
        }
        let (text, is) = (self.resolved.quote(operand), self.is_in(unit));
        let message = format!("`{}` has no unit, for `{text}` {is}", self.resolved.quote(id));
        let error = self.error(operand, message);
        self.refuse(error.help("a square root halves each power of a unit, so it must be even"))
    }

    /// The unit of a function that takes an angle or a plain number. `rad` is the one name with a
    /// meaning here: it is plain to `sin`, `cos` and `tan`.
    fn plain_argument(&mut self, id: ExpressionId, function: Function, unit: &Unit) -> Measure {
        let turns = matches!(function, Function::Sin | Function::Cos | Function::Tan);
        let angle = matches!(function, Function::Asin | Function::Acos | Function::Atan);
        let units = &self.resolved.scope.units;
        let is_called = |name: &str| units.find(name).is_some_and(|name| unit.is_name(name));
        if unit.is_plain() || turns && is_called("rad") {
            return if angle { Measure::Free } else { Measure::In(Unit::default()) };
        }
        let degrees = ["deg", "degree", "degrees"].into_iter().find(|name| is_called(name));
        let (text, name, is) = (self.resolved.quote(id), function.name(), self.is_in(unit));
        let takes = if turns { "an angle in rad" } else { "a plain number" };
        let error = self.error(id, format!("`{name}` takes {takes}, but `{text}` {is}"));
        self.refuse(match degrees {
            Some(deg) if turns => error.help(format!(
                "declare `const rad_per_{deg} in rad/{deg} = 0.017453292519943295` and write `{name}({} * rad_per_{deg})`",
                self.factor(id)
            )),
            _ if turns => error.help("an angle is in rad, or a plain number"),
            _ => error.help("divide it by something of the same unit first"),
        })
    }

    /// The unit of a power. The exponent of a base that has a unit must be a known integer, for the
    /// unit depends on its value.
    fn power(&mut self, id: ExpressionId, base: ExpressionId, exponent: ExpressionId) -> Measure {
        let unit = match (self.of(base), self.of(exponent)) {
            (_, Measure::Broken) => return Measure::Broken,
            (_, Measure::In(unit)) if !unit.is_plain() => {
                let (text, is) = (self.resolved.quote(exponent), self.is_in(&unit));
                let message = format!("an exponent is a plain number, but `{text}` {is}");
                return self.refuse(self.error(exponent, message));
            }
            (Measure::In(unit), _) if !unit.is_plain() => unit,
            (Measure::Written, above) => return above,
            (measure, _) => return measure,
        };
        let power = self.resolved[exponent].value;
        if let Some(value) = power.filter(|value| value.fract() == 0.0) {
            #[allow(clippy::cast_possible_truncation, reason = "beyond the bounds either way")]
            return self.bounded(id, unit.power(value as i32));
        }
        let (text, is) = (self.resolved.quote(base), self.is_in(&unit));
        let message = format!("the unit of this power is not known, for `{text}` {is}");
        let error =
            self.error(base, message).help("what has a unit is raised to a known whole number");
        self.refuse(error.related(self.resolved[exponent].outer, "this is not a whole number"))
    }

    /// Adds a help on how to write `id`, which is in the unit `found`, in the unit `wanted`, if the
    /// two differ by one name.
    fn converted(&self, error: Error, id: ExpressionId, found: &Unit, wanted: &Unit) -> Error {
        let Some((to, from)) = wanted.over(found).and_then(|factor| factor.ratio()) else {
            return error;
        };
        let units = &self.resolved.scope.units;
        let (to, from) = (units.text_of(to), units.text_of(from));
        let constant = format!("{to}_per_{from}").replace("r#", "");
        let product = format!("{} * {constant}", self.factor(id));
        error.help(format!(
            "if both measure the same, declare `const {constant} in {to}/{from} = …` and write `{product}`"
        ))
    }

    /// The text of an expression as the factor of a product.
    fn factor(&self, id: ExpressionId) -> String {
        use Arithmetic::{Add, Subtract};
        let text = self.resolved.quote(id);
        match &self.resolved[id].expression {
            Expression::Infix(Infix::Calculate(Add | Subtract), ..) => format!("({text})"),
            _ => text,
        }
    }

    /// A unit as a label has it.
    fn label(&self, unit: &Unit) -> String {
        match unit.is_plain() {
            true => "a plain number".to_owned(),
            false => format!("in {}", self.resolved.scope.units.text(unit)),
        }
    }

    /// A unit as the predicate of a sentence.
    fn is_in(&self, unit: &Unit) -> String {
        format!("is {}", self.label(unit))
    }

    /// A unit after "takes" or "declared".
    fn within(&self, unit: &Unit) -> String {
        format!("{}{}", if unit.is_plain() { "as " } else { "" }, self.label(unit))
    }
}

#[cfg(test)]
mod tests {
    use crate::check;
    use crate::source::Source;

    /// The unit of the constant `text`; or the first mistake in it.
    fn unit(text: &str) -> String {
        let text = format!(
            "const m in m = 2 const s in s = 3 const deg in deg = 4 const k = m / s const it = {text}"
        );
        match check::file(&Source::new("source", text)) {
            Ok(module) => {
                let unit = module.constants.last().and_then(|constant| constant.unit.clone());
                unit.map_or("free".to_owned(), |unit| module.units.text(&unit))
            }
            Err(errors) => errors.first().message().to_owned(),
        }
    }

    #[test]
    fn units_follow_from_operators() {
        for (text, expected) in [
            ("1 + 2", "free"),
            ("2 * m", "m"),
            ("m + 1", "m"),
            ("m / s", "m/s"),
            ("k * s", "m"),
            ("m / m", "1"),
            ("sqrt(m * m)", "m"),
            ("pow(m, 1 + 1)", "m^2"),
            ("pow(2, m / m)", "1"),
            ("min(m, 2, m)", "m"),
            ("atan2(m, m)", "free"),
            ("abs(-m)", "m"),
            ("sin(m / m)", "1"),
            ("m + s", "`m` is in m, but `s` is in s: they cannot be added"),
            ("m - s", "`m` is in m, but `s` is in s: one cannot be taken from the other"),
            ("max(m, s)", "`m` is in m, but `s` is in s: `max` takes numbers of one unit"),
            ("sqrt(m)", "`sqrt(m)` has no unit, for `m` is in m"),
            ("pow(m, 0.5)", "the unit of this power is not known, for `m` is in m"),
            ("pow(m, s)", "an exponent is a plain number, but `s` is in s"),
            ("pow(m, 99) * m", "the unit of `pow(m, 99) * m` is too large"),
            ("cos(deg)", "`cos` takes an angle in rad, but `deg` is in deg"),
            ("exp(m)", "`exp` takes a plain number, but `m` is in m"),
            // One mistake is one message: what is made of it goes with everything.
            ("(m + s) * m + s", "`m` is in m, but `s` is in s: they cannot be added"),
        ] {
            assert_eq!(unit(text), expected, "{text}");
        }
    }
}
