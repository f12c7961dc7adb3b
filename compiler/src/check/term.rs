//! Numbers: from the leaves up, with constants folded.

use super::Checker;
use super::role::{Role, Roles};
use crate::ast::quoted;
use crate::ast::{Arithmetic, Infix, ItemKind, Node, NodeId, Prefix};
use crate::error::{Error, Kind};
use crate::predicate::{
    Function, Number, Numeric, ParameterType, Scalar, Step, Term, TermId, Type,
};
use crate::source::Span;

use super::Names;
use super::name;

/// What a place of the declared state is.
pub(super) struct Place {
    pub(super) steps: Vec<Step>,
    pub(super) scalar: Scalar,
}

/// A step on the way to a place.
pub(super) enum Pending {
    /// One that is known.
    Step(Step),
    /// The element of a table at an index, of an enumeration.
    Element(NodeId, u32),
    /// The element at an index, which is no constant, of an array of this length.
    At(NodeId, u32),
}

/// The deepest nesting of indices.
const INDICES: usize = 4;

impl Checker<'_> {
    /// The term of each node that is a number, by its position in the expression.
    pub(super) fn terms(&mut self, root: NodeId, roles: &Roles) -> Vec<Option<TermId>> {
        let mut terms = Vec::new();
        for (id, role) in roles.iter() {
            let term = match role {
                Role::Number => self.term(id, roles, &terms),
                _ => None,
            };
            terms.push(term);
            if id == root {
                break;
            }
        }
        terms
    }

    fn term(&mut self, id: NodeId, roles: &Roles, terms: &[Option<TermId>]) -> Option<TermId> {
        let of = |operand: NodeId| terms[roles.position(operand)];
        match self.ast.node(id) {
            Node::Number(value) => Some(self.number(*value)),
            Node::Prefix(Prefix::Minus, operand) => {
                let operand = of(*operand)?;
                match self.module.arena.constant(operand) {
                    Some(value) => Some(self.number(-value)),
                    None => Some(self.module.arena.add_term(Term::Negate(operand))),
                }
            }
            Node::Infix(Infix::Calculate(op), left, right) => {
                let (op, left, right) = (*op, of(*left)?, of(*right)?);
                self.calculate(id, op, left, right)
            }
            Node::Call { arguments, .. } if self.function(id).is_some() => {
                let arguments: Vec<_> =
                    self.ast.arguments(arguments).iter().map(|argument| of(*argument)).collect();
                let (function, count) = self.function(id)?;
                self.call(id, function, count, &arguments)
            }
            _ => self.number_leaf(id),
        }
    }

    pub(super) fn number(&mut self, value: f64) -> TermId {
        // One zero: the sign of zero is no part of any meaning here.
        self.module.arena.add_term(Term::Number(Number(value + 0.0)))
    }

    fn calculate(
        &mut self,
        id: NodeId,
        op: Arithmetic,
        left: TermId,
        right: TermId,
    ) -> Option<TermId> {
        let arena = &mut self.module.arena;
        match (arena.constant(left), arena.constant(right)) {
            (_, Some(0.0)) if op == Arithmetic::Divide => {
                let message = format!("`{}` divides by zero", self.ast.quote(id));
                self.mistakes.push(Error::new(Kind::Number, message, self.ast.span(id)));
                None
            }
            (Some(x), Some(y)) => self.folded(id, op.value(x, y)),
            _ => Some(arena.add_term(Term::Calculate(op, left, right))),
        }
    }

    /// A calculated constant, if it is a number.
    fn folded(&mut self, id: NodeId, value: f64) -> Option<TermId> {
        if value.is_finite() {
            return Some(self.number(value));
        }
        let what = if value.is_nan() { "is not a number" } else { "is too large for a number" };
        let message = format!("`{}` {what}", self.ast.quote(id));
        self.mistakes.push(Error::new(Kind::Number, message, self.ast.span(id)));
        None
    }

    fn call(
        &mut self,
        id: NodeId,
        function: Function,
        count: usize,
        arguments: &[Option<TermId>],
    ) -> Option<TermId> {
        let many = matches!(function, Function::Min | Function::Max) && arguments.len() > 2;
        if arguments.len() != count && !many {
            let s = if count == 1 { "" } else { "s" };
            let message = format!(
                "`{}` takes {count} argument{s}, and there {} {}",
                function.name(),
                if arguments.len() == 1 { "is" } else { "are" },
                arguments.len()
            );
            self.mistakes.push(Error::new(Kind::Type, message, self.ast.span(id)));
            return None;
        }
        let mut term = arguments[0]?;
        if count == 1 {
            return self.apply(id, function, term, None);
        }
        for argument in &arguments[1..] {
            term = self.apply(id, function, term, Some((*argument)?))?;
        }
        Some(term)
    }

    fn apply(
        &mut self,
        id: NodeId,
        function: Function,
        x: TermId,
        y: Option<TermId>,
    ) -> Option<TermId> {
        let arena = &mut self.module.arena;
        let values = (arena.constant(x), y.map_or(Some(0.0), |y| arena.constant(y)));
        match values {
            (Some(x), Some(y)) => self.folded(id, function.value(x, y)),
            _ => Some(arena.add_term(Term::Call(function, x, y))),
        }
    }

    /// A number that is not calculated: a constant, a place, a variable, a Rust expression.
    fn number_leaf(&mut self, id: NodeId) -> Option<TermId> {
        if let Some(parameter) = self.parameter(id) {
            let term = Term::Parameter { name: parameter.name.clone(), ty: parameter.ty };
            match parameter.ty {
                ParameterType::Scalar(Scalar::Number(_)) => {
                    return Some(self.module.arena.add_term(term));
                }
                ParameterType::Scalar(Scalar::Bool) => {
                    let error = self.truth_instead(id);
                    self.mistakes.push(error);
                    return None;
                }
                _ => {}
            }
        } else if let (Node::Name, Some(item)) = (self.ast.node(id), self.item(id)) {
            return self.number_item(id, item);
        } else if let Some((callee, item)) = self.applied(id) {
            if let Some(error) = self.called_number(id, callee, item) {
                self.mistakes.push(error);
                return None;
            }
            return self.number_item(id, item);
        }
        if let Some(sort) = self.sort(id) {
            let error = self.value_instead(id, sort, "a number");
            self.mistakes.push(error);
            return None;
        }
        match self.names {
            Names::Host => {
                self.refuse_unlike_rust(id)?;
                Some(self.host_term(id, false))
            }
            Names::Declared => {
                let place = self.place(id)?;
                if place.scalar == Scalar::Bool {
                    let error = self.truth_instead(id);
                    self.mistakes.push(error);
                    return None;
                }
                let Place { steps, scalar } = place;
                Some(self.module.arena.add_term(Term::Place { steps, scalar }))
            }
            Names::Free => {
                let text = self.free_name(id, false)?;
                Some(self.module.arena.add_term(Term::Variable(text)))
            }
        }
    }

    /// The error for a truth value where a number should stand.
    fn truth_instead(&self, id: NodeId) -> Error {
        let text = self.ast.quote(id);
        let message = format!("`{text}` is true or false, but a number is needed here");
        Error::new(Kind::Type, message, self.ast.span(id))
            .help(format!("it is a formula by itself: write `{text}` or `!{text}`"))
    }

    fn number_item(&mut self, id: NodeId, item: usize) -> Option<TermId> {
        self.items[item].used = true;
        let what = match self.ast.items()[item].kind {
            ItemKind::Constant(..) => {
                let value = self.items[item].value?;
                return Some(self.number(value));
            }
            ItemKind::Predicate(..) => "predicate",
            ItemKind::Task(..) => "task",
            _ => return None,
        };
        let message = format!("`{}` is a {what}, but a number is needed here", self.ast.quote(id));
        let declared = self.ast.items()[item].name;
        self.mistakes.push(
            Error::new(Kind::Type, message, self.ast.span(id)).related(declared, "declared here"),
        );
        None
    }

    /// The item that the name `id` is.
    pub(super) fn item(&self, id: NodeId) -> Option<usize> {
        self.scope.item(self.ast.text(id))
    }

    /// The text of an expression without blanks and comments that make no difference.
    pub(super) fn compact(&self, id: NodeId) -> String {
        crate::token::compact(self.ast.text(id))
    }

    /// The name of a free proposition or variable; a name is one or the other throughout.
    pub(super) fn free_name(&mut self, id: NodeId, formula: bool) -> Option<String> {
        let span = self.ast.span(id);
        if let Some(error) = self.not_a_free_name(id) {
            self.mistakes.push(error);
            return None;
        }
        let text = self.compact(id);
        let (first, place) = *self.free.entry(text.clone()).or_insert((formula, span));
        if first == formula {
            return Some(text);
        }
        let kind = |formula| if formula { "a proposition" } else { "a number" };
        let message = format!("`{text}` is {} here and {} elsewhere", kind(formula), kind(first));
        self.mistakes.push(
            Error::new(Kind::Type, message, span)
                .related(place, format!("{} here", kind(first)))
                .help("give one of the two another name"),
        );
        None
    }

    /// The error for an expression that has no name of its own.
    fn not_a_free_name(&self, id: NodeId) -> Option<Error> {
        let mut at = id;
        loop {
            match self.ast.node(at) {
                Node::Name => return None,
                Node::Field { base, .. } | Node::Index { base, .. } => at = *base,
                Node::Call { callee, .. } => return Some(self.unknown_function(*callee)),
                _ => return Some(self.not_a_place(at)),
            }
        }
    }

    /// The error for a part of `id`, which has none.
    pub(super) fn not_a_place(&self, id: NodeId) -> Error {
        let text = self.ast.quote(id);
        let message = match self.ast.node(id) {
            Node::Number(_) => format!("`{text}` is a number, and has no parts"),
            _ => format!("`{text}` is a Rust expression, which only the macro can read"),
        };
        Error::new(Kind::Type, message, self.ast.span(id))
    }

    pub(super) fn unknown_function(&self, callee: NodeId) -> Error {
        let text = self.ast.quote(callee);
        let message = format!("there is no function `{text}`");
        let error = Error::new(Kind::UnknownName, message, self.ast.span(callee));
        let names = Function::ALL.map(|(name, ..)| name);
        match name::nearest(&text, &mut names.into_iter()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(format!("the functions are {}", names.join(", "))),
        }
    }

    /// The place of the declared state that `id` names.
    pub(super) fn place(&mut self, id: NodeId) -> Option<Place> {
        match self.find_place(id, 0) {
            Ok((pending, scalar)) => Some(Place { steps: self.steps(pending)?, scalar }),
            Err(error) => {
                let told =
                    error.kind() == Kind::UnknownName && self.scope.is_broken(self.ast.text(id));
                if !told {
                    self.mistakes.push(error);
                }
                None
            }
        }
    }

    /// The steps to the place `id`, which stands within `depth` indices of others.
    pub(super) fn find_place(
        &self,
        id: NodeId,
        depth: usize,
    ) -> Result<(Vec<Pending>, Scalar), Error> {
        let mut path = vec![id];
        loop {
            let last = path[path.len() - 1];
            match self.ast.node(last) {
                Node::Field { base, .. } | Node::Index { base, .. } => path.push(*base),
                Node::Name => break,
                Node::Call { callee, .. } => return Err(self.unknown_function(*callee)),
                _ => return Err(self.not_a_place(last)),
            }
        }
        let mut ty: Option<&Type> = None;
        let mut steps = Vec::new();
        for id in path.into_iter().rev() {
            let (step, next) = self.step(id, ty, depth)?;
            steps.push(step);
            ty = Some(next);
        }
        let Some(Type::Scalar(scalar)) = ty else {
            return Err(self.not_a_scalar(id, ty));
        };
        Ok((steps, *scalar))
    }

    /// The step that `id` takes from a place of type `ty` (the state itself if `None`).
    fn step<'t>(
        &'t self,
        id: NodeId,
        ty: Option<&'t Type>,
        depth: usize,
    ) -> Result<(Pending, &'t Type), Error> {
        let (name, span) = match self.ast.node(id) {
            Node::Index { index, .. } => return self.index(id, *index, ty, depth),
            Node::Field { field, .. } => (self.ast.source().slice(*field), *field),
            _ => (self.ast.text(id), self.ast.span(id)),
        };
        let fields = self.scope.fields_of(ty);
        match fields.iter().find(|field| field.name == name) {
            Some(field) => Ok((Pending::Step(Step::Field(name.to_owned())), &field.ty)),
            None if ty.is_none() => Err(self.unknown(name, span)),
            None => {
                let error =
                    Error::new(Kind::UnknownName, format!("there is no field `{name}`"), span);
                let names = || fields.iter().map(|field| field.name.as_str());
                Err(match name::nearest(name, &mut names()) {
                    Some(near) => error.help(format!("did you mean `{near}`?")),
                    None if fields.is_empty() => error.help("this is not a struct"),
                    None => error
                        .help(format!("the fields are {}", names().collect::<Vec<_>>().join(", "))),
                })
            }
        }
    }

    fn index<'t>(
        &'t self,
        id: NodeId,
        index: NodeId,
        ty: Option<&'t Type>,
        depth: usize,
    ) -> Result<(Pending, &'t Type), Error> {
        let span = self.ast.span(index);
        match ty {
            Some(Type::Table(element, of)) if depth < INDICES => {
                self.table_index(index, *of, depth)?;
                Ok((Pending::Element(index, *of), element))
            }
            Some(Type::Table(..)) => {
                let message = format!("indices nest more than {INDICES} deep");
                Err(Error::new(Kind::Nesting, message, span))
            }
            Some(Type::Array(element, length)) => {
                Ok((self.array_step(index, *length, depth)?, element))
            }
            _ => {
                let message = format!("`{}` indexes what is not an array", self.ast.quote(id));
                Err(Error::new(Kind::Type, message, self.ast.span(id)))
            }
        }
    }

    /// Whether `index` can be an index of a table; what it is of is checked with its value.
    fn table_index(&self, index: NodeId, of: u32, depth: usize) -> Result<(), Error> {
        if self.sort_within(index, depth + 1).is_some() {
            return Ok(());
        }
        let (text, name) = (self.ast.quote(index), self.enum_name(of));
        let variants = &self.scope.enums[of as usize].variants;
        let message = format!("`{text}` is not a value of `{name}`, which indexes this array");
        let error = Error::new(Kind::Type, message, self.ast.span(index));
        Err(match name::nearest(&text, &mut variants.iter().map(String::as_str)) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help("an index is a value of the enumeration, a parameter or a field"),
        })
    }

    /// The step to an element of an array: at a known number, or at one that is known when the
    /// program runs.
    fn array_step(&self, index: NodeId, length: u32, depth: usize) -> Result<Pending, Error> {
        let named =
            matches!(self.ast.node(index), Node::Name | Node::Field { .. } | Node::Index { .. });
        let scalar = match self.parameter(index) {
            Some(parameter) => parameter.ty.scalar(),
            None if named && depth < INDICES && self.item(index).is_none() => {
                self.find_place(index, depth + 1).ok().map(|(_, scalar)| scalar)
            }
            None => None,
        };
        let Some(scalar) = scalar else {
            return self.array_index(index, length).map(|at| Pending::Step(Step::Index(at)));
        };
        match scalar.whole() {
            Some(_) if self.parameter(index).is_some() => Ok(Pending::At(index, length)),
            Some((0.., last)) if last < length.into() => Ok(Pending::At(index, length)),
            found => Err(self.not_an_index(index, scalar, length, found.is_some())),
        }
    }

    /// The error for a place, or a parameter, that an array of `length` is not indexed by.
    pub(super) fn not_an_index(
        &self,
        index: NodeId,
        scalar: Scalar,
        length: u32,
        whole: bool,
    ) -> Error {
        let (text, span) = (self.ast.quote(index), self.ast.span(index));
        if !whole {
            let message = format!("`{text}` is {}, and an index is a whole number", a_type(scalar));
            let error = Error::new(Kind::Type, message, span);
            return match self.parameter(index) {
                Some(_) => error.help(format!("declare it as a whole number: `{text}: u8`")),
                None => error.help("an index is a whole number, a constant or a parameter"),
            };
        }
        let ty = scalar.name();
        let message = format!(
            "`{text}` may be beyond an array of {length} elements: it is {}",
            a_type(scalar)
        );
        Error::new(Kind::Type, message, span).help(format!(
            "index by a parameter, whose value the program vouches for: `predicate p(i: {ty}) = …[i]`"
        ))
    }

    /// The parameter or the place that is an index.
    pub(super) fn index_term(&mut self, id: NodeId) -> Option<TermId> {
        if let Some(parameter) = self.parameter(id) {
            let term = Term::Parameter { name: parameter.name.clone(), ty: parameter.ty };
            return Some(self.module.arena.add_term(term));
        }
        let Place { steps, scalar } = self.place(id)?;
        Some(self.module.arena.add_term(Term::Place { steps, scalar }))
    }

    fn array_index(&self, index: NodeId, length: u32) -> Result<u32, Error> {
        let (text, span) = (self.ast.text(index), self.ast.span(index));
        let value = match self.ast.node(index) {
            Node::Number(value) => Some(*value),
            Node::Name => {
                let item = self.scope.item(text);
                item.and_then(|item| self.items[item].value)
            }
            _ => None,
        };
        let Some(value) = value.filter(|value| value.fract() == 0.0 && *value >= 0.0) else {
            let message = format!("`{text}` cannot be an index");
            return Err(Error::new(Kind::Type, message, span).help(
                "an index is a whole number, a constant or a parameter; declare the array as `[…; Room]` to index it by an enumeration",
            ));
        };
        if value >= f64::from(length) {
            let message = format!("index {value} is beyond an array of {length} elements");
            return Err(Error::new(Kind::Type, message, span).help(elements(length)));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked above")]
        Ok(value as u32)
    }

    fn not_a_scalar(&self, id: NodeId, ty: Option<&Type>) -> Error {
        let text = self.ast.quote(id);
        let (what, example) = match ty {
            Some(Type::Array(..)) => ("an array", format!("`{text}[0]`")),
            Some(Type::Table(_, of)) => {
                let known = &self.scope.enums[*of as usize];
                let first = known.variants.first().map_or("value", String::as_str);
                ("an array", format!("`{text}[{first}]`"))
            }
            _ => {
                let field = self.scope.fields_of(ty).first();
                ("a struct", format!("`{text}.{}`", field.map_or("field", |field| &field.name)))
            }
        };
        let message = format!("`{text}` is {what}, but a number or a truth value is needed here");
        Error::new(Kind::Type, message, self.ast.span(id))
            .help(format!("name a part of it, such as {example}"))
    }

    /// The error for a name that nothing declares.
    pub(super) fn unknown(&self, name: &str, span: Span) -> Error {
        let error = Error::new(
            Kind::UnknownName,
            format!("nothing here is called `{}`", quoted(name)),
            span,
        );
        let parameters = self.parameters.iter().map(|known| known.name.as_str());
        if let Some(near) = name::nearest(name, &mut self.scope.names().chain(parameters)) {
            return error.help(format!("did you mean `{near}`?"));
        }
        if self.scope.has_state() {
            error.help("declare it: `predicate name = …`, or a field of the state")
        } else {
            error.help("declare the state first: `state Name { x: f64 }`")
        }
    }
}

/// How the elements of an array are numbered.
pub(super) fn elements(length: u32) -> String {
    format!("the elements are numbered from 0 to {}", length.saturating_sub(1))
}

/// A type as a sentence has it.
pub(super) fn a_type(scalar: Scalar) -> String {
    let name = scalar.name();
    match scalar {
        Scalar::Number(Numeric::U8 | Numeric::U16 | Numeric::U32 | Numeric::U64) => {
            format!("a `{name}`")
        }
        Scalar::Number(_) => format!("an `{name}`"),
        Scalar::Bool => "true or false".to_owned(),
        Scalar::Enum { .. } => "a value of an enumeration".to_owned(),
    }
}
