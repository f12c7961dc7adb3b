//! Units: what each number of an expression is measured in, from the leaves up.
//!
//! A pass of its own, and only in sources that declare a unit. What has no declared unit may be in
//! any, so that a mistake is told only where two declared units meet. What has a mistake in it goes
//! with everything, and so does what is made of it. Terms are shared by their values, which have
//! no units, so this goes over the nodes as they were written.

use super::Checker;
use super::role::{Role, Roles};
use crate::ast::{Arithmetic, Ast, Infix, Node, NodeId, Prefix, WrittenUnit};
use crate::error::{Error, Kind};
use crate::predicate::{Function, TermId, Type};
use crate::source::Span;
use crate::unit::{MOST_NAMES, MOST_POWER, Unit, Units};

/// What a number is measured in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    /// Nobody says.
    Free,
    /// There is a mistake in it, already told.
    Broken,
    /// Whatever is needed: it is made of written numbers. A factor of nothing else is plain.
    Written,
    /// This.
    In(Unit),
}

/// The measures of the nodes of one expression, as far as they are known.
struct Measures<'r> {
    roles: &'r Roles,
    terms: &'r [Option<TermId>],
    known: Vec<Measure>,
}

impl Measures<'_> {
    fn of(&self, id: NodeId) -> &Measure {
        &self.known[self.roles.position(id)]
    }
}

impl Checker<'_> {
    /// Checks the units in the expression `root`, and answers what it is measured in itself.
    pub(super) fn units(
        &mut self,
        root: NodeId,
        roles: &Roles,
        terms: &[Option<TermId>],
    ) -> Measure {
        if !self.scope.has_units() {
            return Measure::Free;
        }
        let mut measures = Measures { roles, terms, known: Vec::with_capacity(terms.len()) };
        for (id, role) in roles.iter() {
            let measure = match role {
                Role::Number => self.measure(id, &measures),
                Role::Condition | Role::Formula { .. } => {
                    self.measured_atom(id, &measures);
                    Measure::Free
                }
                _ => Measure::Free,
            };
            measures.known.push(measure);
        }
        measures.of(root).clone()
    }

    /// Checks a comparison, or what a predicate or task is applied to.
    fn measured_atom(&mut self, id: NodeId, measures: &Measures<'_>) {
        match *self.ast.node(id) {
            Node::Infix(Infix::Compare(_), ..) => {
                let chain = self.compared(id);
                self.agree(&chain, measures, "they cannot be compared");
            }
            Node::Call { .. } => self.measured_arguments(id, measures),
            _ => {}
        }
    }

    /// The operands of a chain of comparisons, left to right.
    fn compared(&self, id: NodeId) -> Vec<NodeId> {
        let mut operands = Vec::new();
        let mut at = id;
        while let Node::Infix(Infix::Compare(_), left, right) = *self.ast.node(at) {
            operands.push(right);
            if !self.is_chained(left) {
                operands.push(left);
                break;
            }
            at = left;
        }
        operands.reverse();
        operands
    }

    fn measured_arguments(&mut self, id: NodeId, measures: &Measures<'_>) {
        let (Some((callee, item)), Node::Call { arguments, .. }) =
            (self.applied(id), self.ast.node(id))
        else {
            return;
        };
        let (parameters, arguments) = (self.scope.parameters(item), self.ast.arguments(arguments));
        if parameters.len() != arguments.len() {
            return;
        }
        let mut mistakes = Vec::new();
        for (parameter, &argument) in parameters.iter().zip(arguments) {
            let (Measure::In(found), Some(wanted)) = (measures.of(argument), &parameter.unit)
            else {
                continue;
            };
            if found != wanted {
                let (text, callee) = (self.ast.quote(argument), self.ast.quote(callee));
                let (is, takes) = (self.is_in(found), self.within(wanted));
                let name = &parameter.name;
                let message = format!("`{text}` {is}, but `{callee}` takes `{name}` {takes}");
                let error = Error::new(Kind::Unit, message, self.ast.entry(argument).outer)
                    .related(parameter.span, self.label(wanted));
                mistakes.push(self.converted(error, argument, found, wanted));
            }
        }
        mistakes.into_iter().for_each(|error| self.mistakes.push(error));
    }

    /// What the constant `item` is measured in, whose value is `root`.
    pub(super) fn constant_unit(&mut self, item: usize, root: NodeId, found: Measure) -> Measure {
        let Some((wanted, place)) = self.scope.constant_unit(item).cloned() else { return found };
        if let Measure::In(found) = &found
            && *found != wanted
        {
            let (text, name) = (self.ast.quote(root), self.ast.items()[item].name);
            let (is, within) = (self.is_in(found), self.within(&wanted));
            let name = self.ast.source().slice(name);
            let message = format!("`{text}` {is}, but `{name}` is declared {within}");
            let error = Error::new(Kind::Unit, message, self.ast.entry(root).outer)
                .related(place, "declared here");
            let error = self.converted(error, root, found, &wanted);
            self.mistakes.push(error);
        }
        Measure::In(wanted)
    }

    /// What a number is measured in.
    fn measure(&mut self, id: NodeId, measures: &Measures<'_>) -> Measure {
        if measures.terms[measures.roles.position(id)].is_none() {
            return Measure::Broken;
        }
        match *self.ast.node(id) {
            Node::Number(_) => Measure::Written,
            Node::Prefix(Prefix::Minus, operand) => measures.of(operand).clone(),
            Node::Infix(Infix::Calculate(op), left, right) => match op {
                Arithmetic::Add => self.agree(&[left, right], measures, "they cannot be added"),
                Arithmetic::Subtract => {
                    self.agree(&[left, right], measures, "one cannot be taken from the other")
                }
                Arithmetic::Multiply | Arithmetic::Divide => {
                    let divides = op == Arithmetic::Divide;
                    self.product(id, divides, [measures.of(left), measures.of(right)])
                }
            },
            Node::Call { ref arguments, .. } => match self.function(id) {
                Some((function, _)) => {
                    let arguments = self.ast.arguments(arguments);
                    self.called(id, function, arguments, measures)
                }
                None => Measure::Free,
            },
            _ => self.measured_leaf(id),
        }
    }

    fn measured_leaf(&self, id: NodeId) -> Measure {
        let unit = match (self.parameter(id), self.item(id)) {
            (Some(parameter), _) => parameter.unit.clone(),
            (None, Some(item)) => {
                return self.items[item].measure.clone().unwrap_or(Measure::Free);
            }
            (None, None) => self.place_unit(id),
        };
        unit.map_or(Measure::Free, Measure::In)
    }

    /// The unit of the last field on the way to a place.
    fn place_unit(&self, id: NodeId) -> Option<Unit> {
        let mut path = vec![id];
        while let Node::Field { base, .. } | Node::Index { base, .. } =
            self.ast.node(path[path.len() - 1])
        {
            path.push(*base);
        }
        let (mut ty, mut unit): (Option<&Type>, _) = (None, None);
        for id in path.into_iter().rev() {
            let name = match (self.ast.node(id), ty) {
                (Node::Index { .. }, Some(Type::Array(element, _) | Type::Table(element, _))) => {
                    ty = Some(element);
                    continue;
                }
                (Node::Field { field, .. }, Some(_)) => self.ast.source().slice(*field),
                (Node::Name, None) => self.ast.text(id),
                _ => return None,
            };
            let field = self.scope.fields_of(ty).iter().find(|field| field.name == name)?;
            (ty, unit) = (Some(&field.ty), field.unit.clone());
        }
        unit
    }

    /// What numbers are measured in that must all be in one unit; `purpose` says what for.
    fn agree(&mut self, operands: &[NodeId], measures: &Measures<'_>, purpose: &str) -> Measure {
        let mut known: Option<(NodeId, &Unit)> = None;
        let (mut written, mut broken, mut mistakes) = (true, false, Vec::new());
        for &operand in operands {
            let measure = measures.of(operand);
            written &= *measure == Measure::Written;
            broken |= *measure == Measure::Broken;
            let Measure::In(unit) = measure else { continue };
            match known {
                None => known = Some((operand, unit)),
                Some((_, first)) if first == unit => {}
                Some(first) => mistakes.push(self.unequal([first, (operand, unit)], purpose)),
            }
        }
        broken |= !mistakes.is_empty();
        mistakes.into_iter().for_each(|error| self.mistakes.push(error));
        match known {
            _ if broken => Measure::Broken,
            Some((_, unit)) => Measure::In(unit.clone()),
            None if written => Measure::Written,
            None => Measure::Free,
        }
    }

    fn unequal(&self, [(a, first), (b, second)]: [(NodeId, &Unit); 2], purpose: &str) -> Error {
        let [place, other] = [a, b].map(|side| self.ast.entry(side).outer);
        let (one, two) = (self.ast.quote(a), self.ast.quote(b));
        let (is, other_is) = (self.is_in(first), self.is_in(second));
        let message = format!("`{one}` {is}, but `{two}` {other_is}: {purpose}");
        let error = Error::new(Kind::Unit, message, place.to(other))
            .related(place, self.label(first))
            .related(other, self.label(second));
        self.converted(error, b, second, first)
    }

    fn product(&mut self, id: NodeId, divides: bool, sides: [&Measure; 2]) -> Measure {
        let plain = Unit::default();
        let unit = match sides {
            [Measure::Written, Measure::Written] => return Measure::Written,
            [Measure::Broken, _] | [_, Measure::Broken] => return Measure::Broken,
            [Measure::Free, _] | [_, Measure::Free] => return Measure::Free,
            sides => sides.map(|side| match side {
                Measure::In(unit) => unit,
                _ => &plain,
            }),
        };
        let result = if divides { unit[0].over(unit[1]) } else { unit[0].times(unit[1]) };
        self.within_bounds(id, result)
    }

    /// What a unit is, if it is within the bounds.
    fn within_bounds(&mut self, id: NodeId, unit: Option<Unit>) -> Measure {
        if unit.is_none() {
            let message = format!("the unit of `{}` is too large", self.ast.quote(id));
            self.mistakes.push(too_large(message, self.ast.entry(id).outer));
        }
        unit.map_or(Measure::Broken, Measure::In)
    }

    fn called(
        &mut self,
        id: NodeId,
        function: Function,
        arguments: &[NodeId],
        measures: &Measures<'_>,
    ) -> Measure {
        let Some(&first) = arguments.first() else { return Measure::Free };
        let measure = measures.of(first);
        match function {
            Function::Abs | Function::Floor | Function::Ceil => measure.clone(),
            Function::Min | Function::Max | Function::Hypot | Function::Atan2 => {
                let message = format!("`{}` takes numbers of one unit", function.name());
                match self.agree(arguments, measures, &message) {
                    Measure::In(_) if function == Function::Atan2 => Measure::Free,
                    measure => measure,
                }
            }
            Function::Pow => self.measured_power(id, arguments, measures),
            Function::Sqrt => match measure {
                Measure::In(unit) => self.root(id, first, unit),
                measure => measure.clone(),
            },
            _ => match measure {
                Measure::In(unit) => self.plain_argument(first, function, unit),
                measure => measure.clone(),
            },
        }
    }

    fn root(&mut self, id: NodeId, operand: NodeId, unit: &Unit) -> Measure {
        let root = unit.root();
        if root.is_none() {
            let (text, is) = (self.ast.quote(operand), self.is_in(unit));
            let message = format!("`{}` has no unit, for `{text}` {is}", self.ast.quote(id));
            let error = Error::new(Kind::Unit, message, self.ast.entry(operand).outer);
            self.mistakes
                .push(error.help("a square root halves each power of a unit, so it must be even"));
        }
        root.map_or(Measure::Broken, Measure::In)
    }

    /// What a function is measured in that takes an angle, or else a plain number.
    fn plain_argument(&mut self, operand: NodeId, function: Function, unit: &Unit) -> Measure {
        let turns = matches!(function, Function::Sin | Function::Cos | Function::Tan);
        let angle = matches!(function, Function::Asin | Function::Acos | Function::Atan);
        let units = &self.module.units;
        let is_rad = turns && units.find("rad").is_some_and(|rad| unit.is_name(rad));
        if unit.is_plain() || is_rad {
            return if angle { Measure::Free } else { Measure::In(Unit::default()) };
        }
        let degrees = ["deg", "degree", "degrees"];
        let degrees = degrees
            .into_iter()
            .find(|name| turns && units.find(name).is_some_and(|degrees| unit.is_name(degrees)));
        let (text, name, is) = (self.ast.quote(operand), function.name(), self.is_in(unit));
        let takes = if turns { "an angle in rad" } else { "a plain number" };
        let message = format!("`{name}` takes {takes}, but `{text}` {is}");
        let error = Error::new(Kind::Unit, message, self.ast.entry(operand).outer);
        self.mistakes.push(match degrees {
            Some(deg) => error.help(format!(
                "declare `const rad_per_{deg} in rad/{deg} = 0.017453292519943295` and write `{name}({} * rad_per_{deg})`",
                self.factor(operand)
            )),
            None if turns => error.help("an angle is in rad, or a plain number"),
            None => error.help("divide it by something of the same unit first"),
        });
        Measure::Broken
    }

    fn measured_power(
        &mut self,
        id: NodeId,
        arguments: &[NodeId],
        measures: &Measures<'_>,
    ) -> Measure {
        let &[base, exponent] = arguments else { return Measure::Free };
        let above = measures.of(exponent);
        match (measures.of(base), above) {
            (_, Measure::Broken) => Measure::Broken,
            (_, Measure::In(unit)) if !unit.is_plain() => {
                let (text, is) = (self.ast.quote(exponent), self.is_in(unit));
                let message = format!("an exponent is a plain number, but `{text}` {is}");
                let place = self.ast.entry(exponent).outer;
                self.mistakes.push(Error::new(Kind::Unit, message, place));
                Measure::Broken
            }
            (Measure::In(unit), _) if !unit.is_plain() => {
                let term = measures.terms[measures.roles.position(exponent)];
                let power = term.and_then(|term| self.module.arena.constant(term));
                self.power(id, [base, exponent], unit, power)
            }
            (Measure::Written, _) => above.clone(),
            (measure, _) => measure.clone(),
        }
    }

    /// What a power is measured in whose base is in `unit`.
    fn power(
        &mut self,
        id: NodeId,
        [base, exponent]: [NodeId; 2],
        unit: &Unit,
        power: Option<f64>,
    ) -> Measure {
        if let Some(value) = power.filter(|value| value.fract() == 0.0) {
            #[allow(
                clippy::cast_possible_truncation,
                reason = "beyond the bounds before and after"
            )]
            return self.within_bounds(id, unit.power(value as i32));
        }
        let (text, is) = (self.ast.quote(base), self.is_in(unit));
        let message = format!("the unit of this power is not known, for `{text}` {is}");
        self.mistakes.push(
            Error::new(Kind::Unit, message, self.ast.entry(base).outer)
                .related(self.ast.entry(exponent).outer, "this is not a whole number")
                .help("what has a unit is raised to a known whole number"),
        );
        Measure::Broken
    }

    /// Adds how to write `id`, which is in the unit `found`, in the unit `wanted`, if that is a
    /// matter of one name.
    fn converted(&self, error: Error, id: NodeId, found: &Unit, wanted: &Unit) -> Error {
        let Some((to, from)) = wanted.over(found).and_then(|factor| factor.ratio()) else {
            return error;
        };
        let [to, from] = [to, from].map(|name| self.module.units.text_of(name));
        let constant = format!("{to}_per_{from}").replace("r#", "");
        let product = format!("{} * {constant}", self.factor(id));
        error.help(format!(
            "if both measure the same, declare `const {constant} in {to}/{from} = …` and write `{product}`"
        ))
    }

    /// The text of an expression as the factor of a product.
    fn factor(&self, id: NodeId) -> String {
        let text = self.ast.quote(id);
        match self.ast.node(id) {
            Node::Infix(Infix::Calculate(Arithmetic::Add | Arithmetic::Subtract), ..) => {
                format!("({text})")
            }
            _ => text,
        }
    }

    fn label(&self, unit: &Unit) -> String {
        match unit.is_plain() {
            true => "a plain number".to_owned(),
            false => format!("in {}", self.module.units.text(unit)),
        }
    }

    fn is_in(&self, unit: &Unit) -> String {
        format!("is {}", self.label(unit))
    }

    fn within(&self, unit: &Unit) -> String {
        format!("{}{}", if unit.is_plain() { "as " } else { "" }, self.label(unit))
    }
}

/// The unit that an author wrote.
pub(super) fn resolve(ast: &Ast, written: &WrittenUnit, units: &mut Units) -> Result<Unit, Error> {
    let mut powers = Vec::with_capacity(written.factors.len());
    for factor in &written.factors {
        let mut power = 1_i64;
        if let Some((digits, minus)) = factor.power {
            let digits = ast.source().slice(digits).replace('_', "");
            power = match digits.parse::<i64>() {
                Ok(power) if power <= MOST_POWER.into() => power * if minus { -1 } else { 1 },
                _ => return Err(too_large("this power is too large".to_owned(), factor.span)),
            };
        }
        let name = units.name(ast.source().slice(factor.name));
        powers.push((name, if factor.divides { -power } else { power }));
    }
    let unit = Unit::product(powers);
    unit.ok_or_else(|| too_large("this unit is too large".to_owned(), written.span))
}

fn too_large(message: String, span: Span) -> Error {
    Error::new(Kind::Unit, message, span).help(format!(
        "a unit is made of at most {MOST_NAMES} names, with powers from -{MOST_POWER} to {MOST_POWER}"
    ))
}
