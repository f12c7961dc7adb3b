//! Terms: the numbers of an expression in the arena of the module, constants folded, from the
//! leaves up.
//!
//! Folding shows mistakes that no run should meet: a division by a constant zero, a constant that
//! is infinite or not a number. They are refused here, so a term of the module that is constant is
//! finite.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let module = check::formula(&Source::new("formula", "F (x < 2 * 3 - 1)"))?;
//! assert_eq!(module.tasks[0].spec.propositions(), ["x < 5"]);
//! let errors = check::formula(&Source::new("formula", "F (x < 1 / 0)")).unwrap_err();
//! assert_eq!(errors.first().kind().name(), "number");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use super::apply::miscounted;
use super::role::{Role, Roles};
use crate::ast::{Arithmetic, Infix, ItemKind};
use crate::error::{Error, Kind};
use crate::intern::Map;
use crate::predicate::{Arena, ConditionId, Function, ParameterType, Scalar, Term, TermId};
use crate::resolve::{Callee, Expression, ExpressionId, Name, Names, Resolved};
use crate::source::Span;
use crate::token::{compact, unquoted};

/// The terms of a module under construction.
pub(super) struct Lowering<'r> {
    pub(super) resolved: &'r Resolved<'r>,
    /// The item whose expression is being read.
    pub(super) item: usize,
    /// The terms and conditions so far.
    pub(super) arena: Arena,
    /// The places of comparisons and applied predicates in the source.
    pub(super) places: Vec<(ConditionId, Span)>,
    /// The mistakes so far, in the order in which they were found.
    pub(super) mistakes: Vec<Error>,
    /// For each name that is declared outside of the source, whether its first use is a formula,
    /// and the place of that use.
    pub(super) free: Map<String, (bool, Span)>,
}

impl<'r> Lowering<'r> {
    /// An empty arena.
    pub(super) fn new(resolved: &'r Resolved<'r>) -> Self {
        Self {
            resolved,
            item: 0,
            arena: Arena::default(),
            places: Vec::new(),
            mistakes: Vec::new(),
            free: Map::default(),
        }
    }

    /// Notes a mistake. Returns `None`, so that nothing more is said about the expression that has
    /// it.
    pub(super) fn refuse<T>(&mut self, error: Error) -> Option<T> {
        self.mistakes.push(error);
        None
    }

    /// Notes a place of a condition, and returns the condition.
    pub(super) fn placed(&mut self, condition: ConditionId, span: Span) -> ConditionId {
        self.places.push((condition, span));
        condition
    }

    /// The term of each expression that is a number, by its position in the item; `None` for other
    /// expressions and for mistakes.
    pub(super) fn terms(&mut self, roles: &Roles) -> Vec<Option<TermId>> {
        let mut terms = Vec::new();
        for (id, role) in roles.iter() {
            let term = match role {
                Role::Number => self.term(id, roles, &terms),
                _ => None,
            };
            terms.push(term);
        }
        terms
    }

    /// The term of one number, given those of its operands.
    fn term(
        &mut self,
        id: ExpressionId,
        roles: &Roles,
        terms: &[Option<TermId>],
    ) -> Option<TermId> {
        let of = |operand: &ExpressionId| terms[roles.position(*operand)];
        match &self.resolved[id].expression {
            Expression::Number(value) => Some(self.arena.number(*value)),
            Expression::Prefix(_, operand) => Some(self.arena.folded(Term::Negate(of(operand)?))),
            Expression::Infix(Infix::Calculate(op), left, right) => {
                let (left, right) = (of(left)?, of(right)?);
                let zero = self.arena.constant(right) == Some(0.0);
                if *op == Arithmetic::Divide && zero {
                    return self.no_number(id, "divides by zero");
                }
                self.calculated(id, Term::Calculate(*op, left, right))
            }
            Expression::Call(Callee { function: Some(function), .. }, arguments) => {
                let arguments: Vec<_> = arguments.iter().map(of).collect();
                self.call(id, *function, &arguments)
            }
            _ => self.leaf(id),
        }
    }

    /// A call of a function of numbers. One with more arguments than two is a chain of calls.
    fn call(
        &mut self,
        id: ExpressionId,
        function: Function,
        arguments: &[Option<TermId>],
    ) -> Option<TermId> {
        if !function.takes(arguments.len()) {
            let (wanted, found) = (function.arity(), arguments.len());
            let s = if wanted == 1 { "" } else { "s" };
            let are = if found == 1 { "is" } else { "are" };
            let name = function.name();
            let message = format!("`{name}` takes {wanted} argument{s}, and there {are} {found}");
            return self.refuse(self.resolved.type_error(id, message));
        }
        let (first, rest) = arguments.split_first()?;
        let first = (*first)?;
        if rest.is_empty() {
            return self.calculated(id, Term::Call(function, first, None));
        }
        rest.iter().try_fold(first, |term, argument| {
            self.calculated(id, Term::Call(function, term, Some((*argument)?)))
        })
    }

    /// A calculation. If all of it is known it becomes its value, which must be finite.
    fn calculated(&mut self, id: ExpressionId, term: Term) -> Option<TermId> {
        match self.arena.value(&term) {
            Some(value) if value.is_nan() => self.no_number(id, "is not a number"),
            Some(value) if value.is_infinite() => self.no_number(id, "is too large for a number"),
            _ => Some(self.arena.folded(term)),
        }
    }

    /// Refuses a calculation without a finite value.
    fn no_number(&mut self, id: ExpressionId, what: &str) -> Option<TermId> {
        let message = format!("`{}` {what}", self.resolved.quote(id));
        self.refuse(Error::new(Kind::Number, message, self.resolved.span(id)))
    }

    /// A number that is not calculated: a constant, a place, a variable, a Rust expression.
    fn leaf(&mut self, id: ExpressionId) -> Option<TermId> {
        match &self.resolved[id].expression {
            Expression::Call(Callee { item: Some(item), .. }, _)
                if self.resolved.is_constant(*item) =>
            {
                self.mistakes.extend(miscounted(self.resolved, id, *item, 0));
                return None;
            }
            Expression::Call(Callee { item: Some(item), .. }, _)
            | Expression::Name(Name::Item(item, _)) => return self.number_item(id, *item),
            Expression::Name(Name::Parameter {
                ty: ty @ ParameterType::Scalar(scalar), ..
            }) => match scalar {
                Scalar::Number(_) => return Some(self.parameter(id, *ty)),
                Scalar::Bool => return self.truth_instead(id),
                Scalar::Enum { .. } => {}
            },
            Expression::Name(Name::Free) => {
                let text = self.free_name(id, false)?;
                return Some(self.arena.add_term(Term::Variable(text)));
            }
            _ => {}
        }
        if let Some(sort) = self.resolved.sort(id) {
            return self.refuse(self.value_instead(id, sort, "a number"));
        }
        if self.resolved.names == Names::Host {
            return self.rust(id, false);
        }
        match self.place(id)? {
            (_, Scalar::Bool) => self.truth_instead(id),
            (term, _) => Some(term),
        }
    }

    /// Refuses a truth value where a number should stand.
    fn truth_instead(&mut self, id: ExpressionId) -> Option<TermId> {
        let text = self.resolved.quote(id);
        let message = format!("`{text}` is true or false, but a number is needed here");
        self.refuse(
            self.resolved
                .type_error(id, message)
                .help(format!("it is a formula by itself: write `{text}` or `!{text}`")),
        )
    }

    /// An item where a number should stand: a constant, or a mistake.
    fn number_item(&mut self, id: ExpressionId, item: usize) -> Option<TermId> {
        let entry = self.resolved.item(item);
        let what = match entry.kind {
            ItemKind::Constant(..) => {
                return self.resolved.constant(item).map(|value| self.arena.number(value));
            }
            ItemKind::Predicate(..) => "predicate",
            ItemKind::Task(..) => "task",
            _ => return None,
        };
        let text = self.resolved.quote(id);
        let message = format!("`{text}` is a {what}, but a number is needed here");
        self.refuse(self.resolved.type_error(id, message).related(entry.name, "declared here"))
    }

    /// The name of a free proposition or variable. A name must be the same of the two throughout,
    /// and the first use decides.
    pub(super) fn free_name(&mut self, id: ExpressionId, formula: bool) -> Option<String> {
        let span = self.resolved.span(id);
        let text = unquoted(&compact(self.resolved.text(id))).to_owned();
        let (first, place) = *self.free.get_or_insert(text.clone(), (formula, span));
        if first == formula {
            return Some(text);
        }
        let kind = |formula| if formula { "a proposition" } else { "a number" };
        let message = format!("`{text}` is {} here and {} elsewhere", kind(formula), kind(first));
        self.refuse(
            Error::new(Kind::Type, message, span)
                .related(place, format!("{} here", kind(first)))
                .help("give one of the two another name"),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::role::roles;
    use crate::resolve::tests::{messages, read};

    const FILE: &str = "enum Room { hall, attic }
        state S { x: f64, on: bool, room: Room, a: [f64; 2], t: [u8; Room] }
        const half = 1 / 2
        task go = F on
        ";

    /// The term of the number `text`, and what is refused.
    fn term(names: Names, before: &str, text: &str) -> (Option<String>, Vec<String>) {
        let text = format!("{before}task last(i: u8, r: Room) = F {text} < 99");
        let (term, mistakes) = read(names, &text, |resolved, item, mistakes| {
            let expressions = resolved.expressions[item].unwrap();
            let roles = roles(resolved, expressions, Role::FORMULA, mistakes);
            let mut lowering = Lowering::new(resolved);
            lowering.item = item;
            let terms = lowering.terms(&roles);
            mistakes.append(&mut lowering.mistakes);
            // The last three are the 99, `<` and `F`.
            let term = terms[terms.len() - 4];
            term.map(|term| lowering.arena.display(term).to_string())
        });
        (term, messages(mistakes))
    }

    #[test]
    fn numbers_are_lowered_and_folded() {
        for (text, expected) in [
            ("x + 2 * 3", "x + 6"),
            ("-(half - 1)", "0.5"),
            ("-x", "-x"),
            ("min(1, 2, x)", "min(1, x)"),
            ("max(x, half, 3)", "max(max(x, 0.5), 3)"),
            ("a[1]", "a[1]"),
            ("t[r]", "t[r]"),
            ("t[room]", "t[room]"),
        ] {
            let found = term(Names::Declared, FILE, text);
            assert_eq!(found, (Some(expected.to_owned()), vec![]), "{text}");
        }
        let rust = term(Names::Host, "state s: S; enum Room { hall } ", "s.f(i) + 1");
        assert_eq!(rust, (Some("s.f(i) + 1".to_owned()), vec![]));
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for (text, expected) in [
            ("1 / (half - 0.5)", "`1 / (half - 0.5)` divides by zero"),
            ("sqrt(0 - 1)", "`sqrt(0 - 1)` is not a number"),
            ("exp(1000)", "`exp(1000)` is too large for a number"),
            ("hypot(x)", "`hypot` takes 2 arguments, and there is 1"),
            ("on", "`on` is true or false, but a number is needed here"),
            ("room", "`room` is a value and no number, so `<` says nothing about it"),
            ("go", "`go` is a task, but a number is needed here"),
            ("half(1)", "`half` is a number and takes no arguments"),
            ("a", "`a` is an array, but a number or a truth value is needed here"),
            ("t[on]", "`on` is not a value of `Room`, which indexes this array"),
        ] {
            assert_eq!(
                term(Names::Declared, FILE, text),
                (None, vec![expected.to_owned()]),
                "{text}"
            );
        }
    }
}
