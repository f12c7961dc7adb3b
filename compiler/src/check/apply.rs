//! Predicates and tasks with arguments.

use super::Checker;
use super::atom::Atom;
use super::role::Roles;
use crate::ast::{Arithmetic, ItemKind, Node, NodeId};
use crate::error::{Error, Kind};
use crate::predicate::{Arguments, Parameter, ParameterType, Scalar, Term, TermId};

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
        self.used.insert(item);
        let parameters = self.scope.parameters(item).to_vec();
        let Node::Call { arguments, .. } = self.ast.node(id) else { return None };
        let arguments = self.ast.arguments(arguments).to_vec();
        if let Some(error) = self.miscounted(id, callee, item, arguments.len()) {
            self.mistakes.push(error);
            return None;
        }
        let of = |argument: NodeId| terms[roles.position(argument)];
        let mut given = Vec::new();
        for (parameter, argument) in parameters.iter().zip(arguments) {
            given.push(match parameter.ty {
                ParameterType::Scalar(Scalar::Number(_)) => of(argument),
                ParameterType::Scalar(Scalar::Enum { of, .. }) => self.value_of(argument, of),
                _ => self.value(argument, None),
            });
        }
        let given: Option<Vec<_>> = given.into_iter().collect();
        self.instance(id, item, &parameters, given?)
    }

    fn instance(
        &mut self,
        id: NodeId,
        item: usize,
        parameters: &[Parameter],
        arguments: Vec<TermId>,
    ) -> Option<Atom> {
        let names = parameters.iter().map(|parameter| parameter.name.clone());
        let bound: Arguments = names.zip(arguments.iter().copied()).collect();
        let known = self.module.arena.terms().len();
        let atom = match self.ast.items()[item].kind {
            ItemKind::Predicate(..) => {
                let predicate = *self.declared.get(&item)?;
                let condition = self.module.predicates[predicate.0 as usize].condition;
                let arena = &mut self.module.arena;
                let meaning = arena.substitute(condition, &bound);
                Atom::Conditions(vec![arena.apply(predicate, arguments, meaning)])
            }
            ItemKind::Task(..) => {
                let task = self.task_id(item)?;
                self.literals(task, &bound);
                Atom::Task(task, bound)
            }
            _ => return None,
        };
        if let Some(error) = self.no_number(id, known) {
            self.mistakes.push(error);
            return None;
        }
        Some(atom)
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
        let constant = matches!(self.ast.items()[item].kind, ItemKind::Constant(_));
        constant.then(|| self.miscounted(id, callee, item, 0)).flatten()
    }

    fn miscounted(&self, id: NodeId, callee: NodeId, item: usize, found: usize) -> Option<Error> {
        let text = self.ast.quote(callee);
        let entry = &self.ast.items()[item];
        let parameters = self.scope.parameters(item);
        let message = match entry.kind {
            ItemKind::Constant(_) => format!("`{text}` is a number and takes no arguments"),
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
            ParameterType::Scalar(Scalar::Enum { of, .. }) => format!("`{}`", self.enum_name(of)),
            ParameterType::Scalar(_) => "a number".to_owned(),
            ParameterType::Host(span) => format!("`{}`", self.ast.source().slice(span)),
        }
    }
}
