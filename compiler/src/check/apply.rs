//! Predicates and tasks with arguments.

use super::atom::Atom;
use super::expand::MOST_NODES;
use super::role::Roles;
use super::term::{Place, a_type, elements};
use super::{Checker, Names};
use crate::ast::{Arithmetic, ItemKind, Node, NodeId};
use crate::error::{Error, Kind};
use crate::predicate::{
    Arguments, ConditionId, Number, Numeric, Parameter, ParameterType, Scalar, Step, Term, TermId,
};

impl Checker<'_> {
    /// The callee and the item that the call `id` applies: a predicate, a task or a constant.
    pub(super) fn applied(&self, id: NodeId) -> Option<(NodeId, usize)> {
        let Node::Call { callee, .. } = self.ast.node(id) else { return None };
        let name = matches!(self.ast.node(*callee), Node::Name);
        Some((*callee, self.item(*callee).filter(|_| name)?))
    }

    /// What the call `id` of a predicate or a task means.
    pub(super) fn application(
        &mut self,
        id: NodeId,
        roles: &Roles,
        terms: &[Option<TermId>],
    ) -> Option<Atom> {
        let (callee, item) = self.applied(id)?;
        self.items[item].used = true;
        let broken = matches!(self.ast.items()[item].kind, ItemKind::Broken(_));
        if broken || !self.scope.unclear(item).is_empty() {
            return None;
        }
        let parameters = self.scope.parameters(item).to_vec();
        let Node::Call { arguments, .. } = self.ast.node(id) else { return None };
        let arguments = self.ast.arguments(arguments).to_vec();
        if let Some(error) = self.miscounted(id, callee, item, arguments.len()) {
            self.mistakes.push(error);
            return None;
        }
        let of = |argument: NodeId| terms[roles.position(argument)];
        let mut given = Vec::new();
        for (parameter, &argument) in parameters.iter().zip(&arguments) {
            given.push(match parameter.ty {
                ParameterType::Scalar(scalar @ Scalar::Number(_)) => {
                    of(argument).and_then(|term| self.number_argument(argument, term, scalar))
                }
                ParameterType::Scalar(Scalar::Bool) => self.truth_argument(argument),
                ParameterType::Scalar(Scalar::Enum { of, optional }) => {
                    self.value_of(argument, of, optional)
                }
                ParameterType::Host(_) => self.value(argument, None),
            });
        }
        let given: Option<Vec<_>> = given.into_iter().collect();
        let given: Vec<_> = arguments.into_iter().zip(given?).collect();
        self.instance(id, item, &parameters, &given)
    }

    /// The number `term` as an argument of this type: for a type of whole numbers a constant that
    /// it has, or what is always one of its values.
    fn number_argument(&mut self, id: NodeId, term: TermId, ty: Scalar) -> Option<TermId> {
        let Some((least, most)) = ty.whole() else { return Some(term) };
        let known = self.module.arena.term(term);
        let within = |(low, high): (i128, i128)| least <= low && high <= most;
        let fits = match known {
            Term::Number(Number(value)) => {
                value.fract() == 0.0 && within((*value as i128, *value as i128))
            }
            Term::Place { scalar, .. }
            | Term::Parameter { ty: ParameterType::Scalar(scalar), .. } => {
                scalar.whole().is_some_and(within)
            }
            Term::Host { .. } => true,
            _ => false,
        };
        if fits {
            return Some(term);
        }
        let (text, wanted) = (self.ast.quote(id), a_type(ty));
        let what = match known {
            Term::Number(Number(value)) if value.fract() == 0.0 => format!("`{text}` is beyond it"),
            Term::Number(_) => format!("`{text}` is not whole"),
            Term::Place { scalar, .. }
            | Term::Parameter { ty: ParameterType::Scalar(scalar), .. } => {
                format!("`{text}` is {}", a_type(*scalar))
            }
            _ => format!("`{text}` is calculated"),
        };
        let message = format!("{wanted} is needed here, and {what}");
        self.mistakes.push(
            Error::new(Kind::Type, message, self.ast.span(id))
                .help(format!("its values are the whole numbers from {least} to {most}")),
        );
        None
    }

    /// The truth value `id` as an argument.
    fn truth_argument(&mut self, id: NodeId) -> Option<TermId> {
        let node = self.ast.node(id);
        let named = matches!(node, Node::Name | Node::Field { .. } | Node::Index { .. });
        let rust = named || matches!(node, Node::Call { .. } | Node::Verbatim);
        let is_item = self.item(id).is_some() || self.applied(id).is_some();
        let term = match (node, self.parameter(id)) {
            (Node::Truth(value), _) => Some(Term::Truth(*value)),
            (_, Some(Parameter { name, ty: ty @ ParameterType::Scalar(Scalar::Bool), .. })) => {
                Some(Term::Parameter { name: name.clone(), ty: *ty })
            }
            (_, None) if self.names == Names::Host && rust && !is_item => {
                self.refuse_unlike_rust(id)?;
                return Some(self.host_term(id, false));
            }
            (_, None) if self.names == Names::Declared && named && !is_item => {
                match self.place(id)? {
                    Place { steps, scalar: Scalar::Bool } => {
                        Some(Term::Place { steps, scalar: Scalar::Bool })
                    }
                    _ => None,
                }
            }
            _ => None,
        };
        if let Some(term) = term {
            return Some(self.module.arena.add_term(term));
        }
        if let Some(item) = self.item(id) {
            self.items[item].used = true;
        }
        let message = format!("a `bool` is needed here, and `{}` is none", self.ast.quote(id));
        self.mistakes.push(
            Error::new(Kind::Type, message, self.ast.span(id))
                .help("it is `true`, `false`, or a parameter or a field of that type"),
        );
        None
    }

    fn instance(
        &mut self,
        id: NodeId,
        item: usize,
        parameters: &[Parameter],
        given: &[(NodeId, TermId)],
    ) -> Option<Atom> {
        let names = parameters.iter().map(|parameter| parameter.name.clone());
        let arguments: Vec<_> = given.iter().map(|(_, term)| *term).collect();
        let bound: Arguments = names.zip(arguments.iter().copied()).collect();
        let known = self.module.arena.terms().len();
        let atom = match self.ast.items()[item].kind {
            ItemKind::Predicate(..) => {
                let predicate = self.items[item].predicate?;
                let condition = self.module.predicates[predicate.0 as usize].condition;
                let meaning = self.substituted(condition, &bound, id)?;
                let applied = self.module.arena.apply(predicate, arguments, meaning);
                Atom::Conditions(vec![self.placed(applied, self.ast.span(id))])
            }
            ItemKind::Task(..) => {
                let task = self.task_id(item)?;
                self.literals(task, &bound, id);
                Atom::Task(task, bound)
            }
            _ => return None,
        };
        if let Some(error) = self.no_number(id, known).or_else(|| self.no_element(known, given)) {
            self.mistakes.push(error);
            return None;
        }
        Some(atom)
    }

    /// A condition with arguments in the place of parameters; `None` where that is too large to be
    /// written out, which is told once.
    pub(super) fn substituted(
        &mut self,
        condition: ConditionId,
        arguments: &Arguments,
        id: NodeId,
    ) -> Option<ConditionId> {
        let key = (condition, arguments.clone());
        if let Some(known) = self.instances.get(&key) {
            return Some(*known);
        }
        let room = self.room?;
        let condition = self.module.arena.substitute(condition, arguments);
        self.room = room.checked_sub(self.module.arena.written_size(condition));
        if self.room.is_none() {
            let message = format!(
                "written out, the predicates with arguments have more than {MOST_NODES} operators and operands"
            );
            self.mistakes.push(
                Error::new(Kind::Budget, message, self.ast.span(id))
                    .label("up to here")
                    .help("each use of a predicate is written out with its arguments, so a chain of definitions that use one another twice doubles at each step"),
            );
            return None;
        }
        self.instances.insert(key, condition);
        Some(condition)
    }

    /// The error if one of the terms since `known`, made by putting arguments in the place of
    /// parameters, divides by zero or is no number.
    fn no_number(&self, id: NodeId, known: usize) -> Option<Error> {
        let arena = &self.module.arena;
        let bad = |term: &Term| match term {
            Term::Calculate(Arithmetic::Divide, _, b) if arena.constant(*b) == Some(0.0) => true,
            Term::Negate(_) | Term::Calculate(..) | Term::Call(..) => {
                term.operands().iter().all(|operand| arena.constant(*operand).is_some())
            }
            _ => false,
        };
        let place = known + arena.terms()[known..].iter().position(bad)?;
        let text = self.module.display_term(TermId(u32::try_from(place).ok()?));
        let message = format!("with these arguments, `{text}` is not a number");
        Some(Error::new(Kind::Number, message, self.ast.span(id)))
    }

    /// The error if one of the terms since `known` is an element of an array that there is not, or
    /// may not be.
    fn no_element(&self, known: usize, given: &[(NodeId, TermId)]) -> Option<Error> {
        let arena = &self.module.arena;
        let made = (known..arena.terms().len()).filter_map(|at| u32::try_from(at).ok());
        for place in made.map(TermId) {
            let Term::Place { steps, .. } = arena.term(place) else { continue };
            for step in steps {
                let Step::At { index, length } = *step else { continue };
                let first = given.first().map(|(argument, _)| *argument);
                let of =
                    given.iter().find(|(_, term)| *term == index).map(|(argument, _)| *argument);
                let argument = of.or(first)?;
                match arena.term(index) {
                    Term::Number(_) => {
                        let text = self.module.display_term(place);
                        let message = format!("`{text}` is beyond an array of {length} elements");
                        let error = Error::new(Kind::Type, message, self.ast.span(argument));
                        return Some(error.help(elements(length)));
                    }
                    Term::Place { scalar, .. }
                        if scalar
                            .whole()
                            .is_none_or(|(least, most)| least < 0 || most >= length.into()) =>
                    {
                        return Some(self.not_an_index(argument, *scalar, length, true));
                    }
                    _ => {}
                }
            }
        }
        None
    }

    /// The error for the use of `item` without the arguments that it takes.
    pub(super) fn without_arguments(&self, id: NodeId, item: usize) -> Error {
        let text = self.ast.quote(id);
        let message = format!("`{text}` takes {}", self.takes(item));
        let names: Vec<_> =
            self.scope.parameters(item).iter().map(|known| known.name.as_str()).collect();
        Error::new(Kind::Type, message, self.ast.span(id))
            .related(self.ast.items()[item].name, "declared here")
            .help(format!("write `{text}({})`", names.join(", ")))
    }

    /// The error for a constant with arguments.
    pub(super) fn called_number(&self, id: NodeId, callee: NodeId, item: usize) -> Option<Error> {
        let constant = matches!(self.ast.items()[item].kind, ItemKind::Constant(..));
        constant.then(|| self.miscounted(id, callee, item, 0)).flatten()
    }

    fn miscounted(&self, id: NodeId, callee: NodeId, item: usize, found: usize) -> Option<Error> {
        let text = self.ast.quote(callee);
        let entry = &self.ast.items()[item];
        let parameters = self.scope.parameters(item);
        let message = match entry.kind {
            ItemKind::Constant(..) => format!("`{text}` is a number and takes no arguments"),
            _ if parameters.is_empty() => format!("`{text}` takes no arguments: write it alone"),
            _ if parameters.len() == found => return None,
            _ => {
                let are = if found == 1 { "is" } else { "are" };
                format!("`{text}` takes {}, and there {are} {found}", self.takes(item))
            }
        };
        Some(
            Error::new(Kind::Type, message, self.ast.span(id)).related(entry.name, "declared here"),
        )
    }

    /// How many arguments an item takes, and of which types.
    fn takes(&self, item: usize) -> String {
        let parameters = self.scope.parameters(item);
        let types: Vec<_> = parameters.iter().map(|known| self.type_name(known.ty)).collect();
        let s = if types.len() == 1 { "" } else { "s" };
        format!("{} argument{s} ({})", types.len(), types.join(", "))
    }

    fn type_name(&self, ty: ParameterType) -> String {
        match ty {
            ParameterType::Scalar(Scalar::Enum { of, optional }) => {
                format!("`{}{}`", self.enum_name(of), if optional { "?" } else { "" })
            }
            ParameterType::Scalar(Scalar::Number(Numeric::F64)) => "a number".to_owned(),
            ParameterType::Scalar(scalar) => format!("`{}`", scalar.name()),
            ParameterType::Host(span) => format!("`{}`", self.ast.source().slice(span)),
        }
    }
}
