//! From the root down: what each operand has to be, and what negates it.

use super::{Checker, intent};
use crate::ast::{Comparison, Infix, Node, NodeId, Prefix};
use crate::error::{Error, Kind};
use crate::predicate::{Function, ParameterType, Scalar};

/// What an expression has to be where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// A formula of a task, under the negation `negated`: the `!`, or the `=>` whose left side it is.
    Formula { negated: Option<NodeId> },
    /// A condition of one state.
    Condition,
    /// A number.
    Number,
    /// The left part of a comparison chain.
    Chain,
    /// A part of a place or of a Rust expression; whoever stands above reads it.
    Part,
    /// There is a mistake here, already told.
    Broken,
}

/// The roles of the nodes of one expression.
pub(super) struct Roles {
    first: u32,
    roles: Vec<Role>,
}

impl Roles {
    pub(super) fn of(&self, id: NodeId) -> Role {
        self.roles[self.position(id)]
    }

    /// Where `id` stands among the nodes of the expression.
    pub(super) fn position(&self, id: NodeId) -> usize {
        (id.0 - self.first) as usize
    }

    /// The nodes of the expression with their roles, operands first.
    pub(super) fn iter(&self) -> impl Iterator<Item = (NodeId, Role)> {
        (self.first..).map(NodeId).zip(self.roles.iter().copied())
    }

    fn set(&mut self, id: NodeId, role: Role) {
        let position = self.position(id);
        self.roles[position] = role;
    }
}

impl Checker<'_> {
    /// The roles in the expression `root`, which itself has to be a `role`.
    pub(super) fn roles(&mut self, root: NodeId, role: Role) -> Roles {
        let first = self.ast.first(root).0;
        let count = (root.0 - first + 1) as usize;
        let mut roles = Roles { first, roles: vec![Role::Part; count] };
        roles.set(root, role);
        for id in (first..=root.0).rev().map(NodeId) {
            self.descend(id, &mut roles);
        }
        roles
    }

    fn descend(&mut self, id: NodeId, roles: &mut Roles) {
        match roles.of(id) {
            Role::Part => {}
            Role::Broken => self.give(id, roles, Role::Broken),
            Role::Number => self.descend_number(id, roles),
            Role::Chain => self.descend_comparison(id, roles),
            Role::Condition => self.descend_formula(id, roles, Role::Condition, None),
            role @ Role::Formula { negated } => self.descend_formula(id, roles, role, negated),
        }
    }

    /// Gives all operands of `id` the same role.
    fn give(&self, id: NodeId, roles: &mut Roles, role: Role) {
        for operand in self.ast.operands(id) {
            roles.set(operand, role);
        }
    }

    fn descend_formula(&mut self, id: NodeId, roles: &mut Roles, role: Role, by: Option<NodeId>) {
        let flipped = match role {
            Role::Formula { .. } => Role::Formula { negated: by.is_none().then_some(id) },
            other => other,
        };
        match *self.ast.node(id) {
            Node::Prefix(Prefix::Not, operand) => roles.set(operand, flipped),
            Node::Infix(Infix::And | Infix::Or, ..) => self.give(id, roles, role),
            Node::Infix(Infix::Implies, left, right) => {
                roles.set(left, flipped);
                roles.set(right, role);
            }
            Node::Prefix(Prefix::Eventually | Prefix::Next, _)
            | Node::Infix(Infix::Until | Infix::Then, ..) => {
                self.descend_temporal(id, roles, role, by)
            }
            Node::Infix(Infix::Compare(_), ..) => self.descend_comparison(id, roles),
            Node::Number(_)
            | Node::Text
            | Node::Prefix(Prefix::Minus, _)
            | Node::Infix(Infix::Calculate(_), ..) => {
                self.refuse(id, roles, self.not_a_formula(id))
            }
            Node::Call { ref arguments, .. } if self.applied(id).is_some() => {
                let arguments = self.ast.arguments(arguments).to_vec();
                self.descend_application(id, &arguments, roles);
            }
            Node::Call { .. } if self.function(id).is_some() => {
                self.refuse(id, roles, self.not_a_formula(id));
            }
            _ => {}
        }
    }

    fn descend_temporal(&mut self, id: NodeId, roles: &mut Roles, role: Role, by: Option<NodeId>) {
        if role == Role::Condition {
            return self.refuse(id, roles, self.temporal_predicate(id));
        }
        if let Some(warning) = intent::warning(self.ast, id) {
            self.mistakes.push(warning);
        }
        if let Some(negation) = by {
            let error = intent::negated(self.ast, id, negation);
            self.mistakes.push(error);
            // The rest of the formula may hold mistakes of its own.
        }
        self.give(id, roles, Role::Formula { negated: None });
    }

    fn descend_comparison(&mut self, id: NodeId, roles: &mut Roles) {
        let Node::Infix(Infix::Compare(_), left, right) = *self.ast.node(id) else { return };
        if let Some(truth) = [left, right].into_iter().find(|side| self.is_truth(*side)) {
            return self.refuse(id, roles, self.compared_truth(truth));
        }
        let chained = self.is_chained(left);
        let value = |side: &NodeId| self.sort(*side).is_some();
        if let Some(side) = [left, right].into_iter().skip(usize::from(chained)).find(value) {
            if let Some(error) = self.ordered_values(id, side, chained) {
                self.refuse(id, roles, error);
            }
            return;
        }
        roles.set(left, if chained { Role::Chain } else { Role::Number });
        roles.set(right, Role::Number);
    }

    /// A number is an operand of its own; a value is read with the predicate or task.
    fn descend_application(&self, id: NodeId, arguments: &[NodeId], roles: &mut Roles) {
        let Some((_, item)) = self.applied(id) else { return };
        for (argument, parameter) in arguments.iter().zip(self.scope.parameters(item)) {
            if let ParameterType::Scalar(Scalar::Number(_)) = parameter.ty {
                roles.set(*argument, Role::Number);
            }
        }
    }

    /// The error for values that are compared as if they had an order.
    fn ordered_values(&self, id: NodeId, side: NodeId, chained: bool) -> Option<Error> {
        let operator = self.ast.entry(id).operator;
        let symbol = self.ast.source().slice(operator);
        let text = self.ast.quote(side);
        match *self.ast.node(id) {
            Node::Infix(Infix::Compare(Comparison::Equal | Comparison::Unequal), ..)
                if !chained =>
            {
                None
            }
            _ if chained => Some(
                Error::new(
                    Kind::Chain,
                    format!("`{text}` is a value, and values are compared two at a time"),
                    operator,
                )
                .help("write each comparison, with `&&` between them"),
            ),
            _ => Some(
                Error::new(
                    Kind::Type,
                    format!(
                        "`{text}` is a value and no number, so `{symbol}` says nothing about it"
                    ),
                    operator,
                )
                .help("values are compared with `==` and `!=` only"),
            ),
        }
    }

    fn is_truth(&self, id: NodeId) -> bool {
        matches!(self.ast.node(id), Node::Truth(_))
    }

    fn compared_truth(&self, truth: NodeId) -> Error {
        let message = "truth values are not compared";
        Error::new(Kind::Type, message, self.ast.span(truth))
            .help("for `p == true` write `p`, for `p == false` write `!p`")
    }

    /// Whether the left operand of a comparison is the part of a chain before it.
    pub(super) fn is_chained(&self, left: NodeId) -> bool {
        matches!(self.ast.node(left), Node::Infix(Infix::Compare(_), ..))
            && !self.ast.entry(left).is_bracketed()
    }

    fn descend_number(&mut self, id: NodeId, roles: &mut Roles) {
        match self.ast.node(id) {
            Node::Prefix(Prefix::Minus, _) | Node::Infix(Infix::Calculate(_), ..) => {
                self.give(id, roles, Role::Number);
            }
            Node::Call { arguments, .. } if self.function(id).is_some() => {
                for argument in self.ast.arguments(arguments) {
                    roles.set(*argument, Role::Number);
                }
            }
            Node::Truth(_) | Node::Prefix(..) | Node::Infix(..) | Node::Quantified { .. } => {
                self.refuse(id, roles, self.not_a_number(id));
            }
            _ => {}
        }
    }

    /// The function of numbers that a call calls.
    pub(super) fn function(&self, id: NodeId) -> Option<(Function, usize)> {
        let Node::Call { callee, .. } = self.ast.node(id) else { return None };
        matches!(self.ast.node(*callee), Node::Name)
            .then(|| Function::named(self.ast.text(*callee)))
            .flatten()
    }

    fn refuse(&mut self, id: NodeId, roles: &mut Roles, error: Error) {
        self.mistakes.push(error);
        roles.set(id, Role::Broken);
        self.give(id, roles, Role::Broken);
    }

    fn not_a_formula(&self, id: NodeId) -> Error {
        let text = self.ast.quote(id);
        let message = format!("`{text}` is a number, but a formula is needed here");
        Error::new(Kind::Type, message, self.ast.entry(id).outer)
            .help(format!("compare it with something, such as `{text} < 1`"))
    }

    fn not_a_number(&self, id: NodeId) -> Error {
        let text = self.ast.quote(id);
        let message = format!("`{text}` is true or false, but a number is needed here");
        Error::new(Kind::Type, message, self.ast.entry(id).outer)
            .help("comparisons and arithmetic take numbers; `!`, `&&` and `F` give none")
    }

    fn temporal_predicate(&self, id: NodeId) -> Error {
        let entry = self.ast.entry(id);
        let symbol = self.ast.source().slice(entry.operator);
        let message = format!("a predicate speaks of one state, so `{symbol}` cannot stand in it");
        Error::new(Kind::Type, message, entry.operator)
            .help("declare it as a `task`: a task can be used inside other tasks")
    }
}
