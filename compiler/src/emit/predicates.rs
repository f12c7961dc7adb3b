//! Conditions and terms as Rust expressions: the typed robustness function of each predicate, and
//! its truth.
//!
//! Both readings are written from the same terms, with the same operations in the same order, so
//! they round alike and cannot disagree: `a < b` has robustness `b - a` and holds if that is
//! positive. The evaluator of the tools reads recorded states by the same rules, and a test
//! compares the two bit by bit.
//!
//! A condition that is used once becomes part of the expression around it. One that is used several
//! times, or lies deep, gets a `let` of its own. So the code is as long as the arena, however often
//! something is used, and never nested beyond a fixed depth, however deep the author nests.

use proc_macro2::{Delimiter, Group, Ident, Literal, Span as TokenSpan, TokenStream, TokenTree};
use quote::{quote, quote_spanned};

use crate::arena;
use crate::ast::{Arithmetic, Comparison};
use crate::emit::names::{Names, ident};
use crate::intern::Map;
use crate::predicate::{
    Binding, Condition, ConditionId, Module, Number, Numeric, ParameterType, PredicateId, Scalar,
    State, Step, Term, TermId,
};
use crate::reserved::bare;
use crate::source::Span;

/// Expressions deeper than this are cut by a `let`: rustc reads nested expressions by recursion.
/// Few expressions that fit on a line are deeper, so most code stays one expression.
const DEPTH: u32 = 12;

/// The two readings of a condition.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Reading {
    /// The robustness, an `f64`.
    Robustness,
    /// The truth, a `bool`, in a function that returns a `Result`.
    Truth,
}

/// The surroundings of the written code.
pub(super) struct Scope<'a> {
    /// The module that declares the predicates.
    pub(super) module: &'a Module,
    /// The path of the runtime crate.
    pub(super) runtime: TokenStream,
    /// The Rust tokens at a place of the source.
    host: &'a dyn Fn(Span) -> TokenStream,
    /// The names of locals and parameters.
    pub(super) names: Names,
    /// The name of the state: the author's own word, exactly as the author's code has it, or a
    /// local.
    pub(super) state: Ident,
}

impl<'a> Scope<'a> {
    /// The surroundings of the code of a module.
    pub(super) fn new(
        module: &'a Module,
        runtime: TokenStream,
        host: &'a dyn Fn(Span) -> TokenStream,
        names: Names,
    ) -> Self {
        let state = match &module.state {
            State::Host { name, span, .. } => word(&host(*span), name),
            _ => names.local("s"),
        };
        Self { module, runtime, host, names, state }
    }

    /// The state as an argument. To rustc, the author's own word is the author's code, so an unused
    /// one, or one that is not in snake case, would be reported; the attribute prevents that.
    pub(super) fn argument(&self) -> TokenStream {
        let name = &self.state;
        match &self.module.state {
            State::Host { .. } => quote! { #[allow(non_snake_case, unused_variables)] #name },
            _ => quote! { #name },
        }
    }

    /// The author's Rust at a place of the source. Braces around all of it get a generated span,
    /// because rustc would report the author's as unnecessary.
    pub(super) fn rust(&self, span: Span) -> TokenStream {
        let tokens = (self.host)(span);
        let mut trees = tokens.clone().into_iter();
        match (trees.next(), trees.next()) {
            (Some(TokenTree::Group(group)), None) if group.delimiter() == Delimiter::Brace => {
                let mut braces = Group::new(Delimiter::Brace, group.stream());
                braces.set_span(group.span().resolved_at(TokenSpan::mixed_site()));
                TokenTree::Group(braces).into()
            }
            _ => tokens,
        }
    }

    /// A condition as statements and an expression: the body of a function that has the state in
    /// scope. For the truth, that function returns a `Result`, because a comparison with NaN is an
    /// error (`?`).
    pub(super) fn condition(&self, id: ConditionId, reading: Reading) -> TokenStream {
        let needed = arena::needed(vec![id.0], &mut |id, open| {
            let condition = self.module.arena.condition(ConditionId(id));
            open.extend(operands(condition).map(|operand| operand.0));
        });
        let mut writer = Writer {
            scope: self,
            reading,
            needed,
            conditions: Vec::new(),
            terms: Map::default(),
            lets: TokenStream::new(),
        };
        let result = writer.written();
        let lets = writer.lets;
        quote! { #lets #result }
    }
}

/// What a predicate compares.
pub(super) enum Compared {
    /// Floats, if these places of the state are, whose types only rustc knows.
    Floats(Vec<TermId>),
    /// Something else as well.
    Others,
}

impl Scope<'_> {
    /// What the comparisons of a predicate compare.
    pub(super) fn compared(&self, id: ConditionId) -> Compared {
        let (mut conditions, mut terms, mut places) = (vec![id], Vec::new(), Vec::new());
        while let Some(id) = conditions.pop() {
            match *self.module.arena.condition(id) {
                Condition::Not(a) => conditions.push(a),
                Condition::And(a, b) | Condition::Or(a, b) => conditions.extend([a, b]),
                Condition::Compare(_, a, b) => terms.extend([a, b]),
                Condition::Is(predicate) => {
                    conditions.push(self.module.predicates[predicate.0 as usize].condition);
                }
                Condition::Apply { meaning, .. } => conditions.push(meaning),
                _ => return Compared::Others,
            }
        }
        while let Some(id) = terms.pop() {
            let term = self.module.arena.term(id);
            match term {
                Term::Number(_)
                | Term::Place { scalar: Scalar::Number(Numeric::F64 | Numeric::F32), .. }
                | Term::Parameter {
                    ty: ParameterType::Scalar(Scalar::Number(Numeric::F64 | Numeric::F32)),
                    ..
                } => {}
                Term::Negate(_) | Term::Calculate(..) | Term::Call(..) => {
                    terms.extend(term.operands());
                }
                Term::Host { text, bindings, .. } if bindings.is_empty() && self.is_place(text) => {
                    places.push(id);
                }
                _ => return Compared::Others,
            }
        }
        places.sort_unstable();
        places.dedup();
        Compared::Floats(places)
    }

    /// Whether Rust of the author's is a field or an element of the state and nothing more.
    fn is_place(&self, text: &str) -> bool {
        let State::Host { name, .. } = &self.module.state else { return false };
        let is_step = |c: char| c.is_alphanumeric() || "_.[]".contains(c);
        text.strip_prefix(&**name).is_some_and(|steps| steps.starts_with(['.', '[']))
            && text.chars().all(is_step)
    }

    /// Whether these places are floats, as an expression.
    pub(super) fn are_floats(&self, places: &[TermId], state: &TokenStream) -> TokenStream {
        let (runtime, argument) = (&self.runtime, self.argument());
        let asked = places.iter().map(|&id| match self.module.arena.term(id) {
            Term::Host { span, .. } => {
                let place = self.rust(*span);
                quote! { #runtime::private::is_float(|#argument: &#state| #place) }
            }
            _ => quote! { true },
        });
        quote! { true #(&& #asked)* }
    }
}

/// The conditions that a condition is made of, other predicates left out.
fn operands(condition: &Condition) -> impl Iterator<Item = ConditionId> {
    let (first, second) = match *condition {
        Condition::Not(a) => (Some(a), None),
        Condition::And(a, b) | Condition::Or(a, b) => (Some(a), Some(b)),
        _ => (None, None),
    };
    first.into_iter().chain(second)
}

/// An expression and its depth.
type Written = (TokenStream, u32);

/// Writes one condition: operands first, in order, without recursion.
struct Writer<'a> {
    /// The surroundings of the code.
    scope: &'a Scope<'a>,
    /// The reading that is written.
    reading: Reading,
    /// The conditions to be written, operands first.
    needed: Vec<u32>,
    /// The code of the conditions so far, by place in `needed`.
    conditions: Vec<Written>,
    /// The code of the terms so far.
    terms: Map<TermId, Written>,
    /// The statements before the expression.
    lets: TokenStream,
}

impl Writer<'_> {
    /// Writes all needed conditions, operands first; the last is the whole.
    fn written(&mut self) -> TokenStream {
        let mut uses = vec![0_u32; self.needed.len()];
        for &id in &self.needed {
            let condition = self.scope.module.arena.condition(ConditionId(id));
            operands(condition).for_each(|operand| uses[self.place(operand)] += 1);
        }
        for (at, uses) in uses.into_iter().enumerate() {
            let index = self.needed[at];
            let (code, depth) = self.one(ConditionId(index));
            let whole = at + 1 == self.needed.len();
            let written = if !whole && (uses > 1 || depth > DEPTH) {
                let name = self.scope.names.local(&format!("c{index}"));
                self.lets.extend(quote! { let #name = #code; });
                (quote! { #name }, 0)
            } else {
                (code, depth)
            };
            self.conditions.push(written);
        }
        self.conditions.pop().map(|(code, _)| code).unwrap_or_default()
    }

    /// The place of a condition among the needed ones, which rise.
    fn place(&self, id: ConditionId) -> usize {
        self.needed.binary_search(&id.0).expect("operands are needed")
    }

    /// The code of an operand, which has been written before.
    fn operand(&self, id: ConditionId) -> Written {
        self.conditions[self.place(id)].clone()
    }

    /// The code of one condition, from that of its operands.
    fn one(&mut self, id: ConditionId) -> Written {
        let runtime = &self.scope.runtime;
        let state = &self.scope.state;
        let robust = self.reading == Reading::Robustness;
        match self.scope.module.arena.condition(id) {
            Condition::Truth(value) => (truth(*value, robust), 0),
            Condition::Not(a) => self.unary(*a),
            Condition::And(a, b) => self.binary(*a, *b, &quote! { min }, &quote! { & }),
            Condition::Or(a, b) => self.binary(*a, *b, &quote! { max }, &quote! { | }),
            Condition::Compare(comparison, a, b) => self.comparison(*comparison, *a, *b),
            Condition::Bool(place) => {
                let place = self.leaf(*place);
                let rho = quote! { #runtime::private::truth(#place) };
                (if robust { rho } else { place }, 0)
            }
            Condition::Is(predicate) => {
                let name = ident(&self.scope.module.predicates[predicate.0 as usize].name);
                let rho = quote! { #name(#state) };
                let holds = quote! { #runtime::Predicate::holds(&#name {}, #state)? };
                (if robust { rho } else { holds }, 0)
            }
            Condition::Apply { predicate, arguments, .. } => {
                let (name, arguments) = self.application(*predicate, arguments);
                let values = arguments.iter().map(|(_, value)| value);
                let fields = arguments.iter().map(|(field, value)| quote! { #field: #value });
                let rho = quote! { #name(#state #(, #values)*) };
                let holds = quote! { #runtime::Predicate::holds(&#name { #(#fields),* }, #state)? };
                (if robust { rho } else { holds }, 0)
            }
            Condition::Value { span, bindings, .. } => {
                let value = self.bound(bindings, self.scope.rust(*span));
                let rho = quote! { #runtime::Predicate::robustness(&(#value), #state) };
                let holds = quote! { #runtime::Predicate::holds(&(#value), #state)? };
                (if robust { rho } else { holds }, 0)
            }
            // Only a bare formula has free propositions, and it is never written as Rust.
            Condition::Free(_) => (truth(false, robust), 0),
        }
    }

    /// The name of a predicate, and its parameters with their arguments.
    fn application(
        &mut self,
        predicate: PredicateId,
        arguments: &[TermId],
    ) -> (Ident, Vec<(Ident, TokenStream)>) {
        let predicate = &self.scope.module.predicates[predicate.0 as usize];
        let mut given = Vec::new();
        for (parameter, argument) in predicate.parameters.iter().zip(arguments) {
            let value = self.typed(*argument, parameter.ty.scalar());
            given.push((ident(&parameter.name), value));
        }
        (ident(&predicate.name), given)
    }

    /// A Rust expression with its parameters bound.
    ///
    /// The words that are bound are the author's own tokens, so they are in scope for the
    /// expression whatever macro it came from. All values are read before any is bound, because one
    /// may have the name of another's value.
    fn bound(&mut self, bindings: &[Binding], code: TokenStream) -> TokenStream {
        if bindings.is_empty() {
            return code;
        }
        let names = bindings.iter().map(|one| word(&code, &one.name));
        let values: Vec<_> = bindings.iter().map(|one| self.typed(one.term, one.scalar)).collect();
        quote! {{
            #[allow(non_snake_case, unused_variables)]
            let (#(#names,)*) = (#(#values,)*);
            #code
        }}
    }

    /// A term as a value of this type; of its own type if none is given.
    fn typed(&mut self, id: TermId, scalar: Option<Scalar>) -> TokenStream {
        let term = self.scope.module.arena.term(id);
        let own = match term {
            Term::Place { scalar, .. } => Some(*scalar),
            Term::Parameter { ty, .. } => ty.scalar(),
            _ => None,
        };
        match (term, scalar) {
            (Term::Number(Number(value)), Some(Scalar::Number(numeric)))
                if numeric != Numeric::F64 =>
            {
                whole(*value, numeric.name())
            }
            (Term::Number(Number(value)), None) if value.fract() == 0.0 => whole(*value, ""),
            (_, Some(Scalar::Number(Numeric::F64))) => self.term(id).0,
            (_, Some(wanted @ Scalar::Number(numeric))) if own.is_some_and(|own| own != wanted) => {
                let (name, value) = (ident(numeric.name()), self.leaf(id));
                quote! { <::core::primitive::#name as ::core::convert::From<_>>::from(#value) }
            }
            (_, Some(Scalar::Enum { optional: true, .. })) if !self.is_optional(id) => {
                let value = self.leaf(id);
                quote! { ::core::option::Option::Some(#value) }
            }
            _ => self.leaf(id),
        }
    }

    /// A negation: the negative robustness, or the opposite truth.
    fn unary(&mut self, a: ConditionId) -> Written {
        let (a, depth) = self.operand(a);
        let code = if self.reading == Reading::Robustness {
            quote! { -#a }
        } else {
            quote! { !(#a) }
        };
        (code, depth + 1)
    }

    /// A conjunction or a disjunction. Its truth evaluates both sides (`&`, not `&&`): whether a
    /// NaN on the right is an error must not depend on the left.
    fn binary(
        &mut self,
        a: ConditionId,
        b: ConditionId,
        function: &TokenStream,
        operator: &TokenStream,
    ) -> Written {
        let runtime = &self.scope.runtime;
        let ((a, deep_a), (b, deep_b)) = (self.operand(a), self.operand(b));
        let code = if self.reading == Reading::Robustness {
            quote! { #runtime::private::#function(#a, #b) }
        } else {
            quote! { (#a) #operator (#b) }
        };
        (code, deep_a.max(deep_b) + 1)
    }

    /// A comparison of numbers. Robustness is the signed distance to the threshold, for `==` the
    /// negative distance.
    fn comparison(&mut self, comparison: Comparison, a: TermId, b: TermId) -> Written {
        let arena = &self.scope.module.arena;
        if arena.is_value(a) || arena.is_value(b) {
            return self.value_comparison(comparison, a, b);
        }
        let is_finite = |id| matches!(arena.term(id), Term::Number(Number(x)) if x.is_finite());
        let finite = (is_finite(a) || is_finite(b)).then(|| quote! { finite:: });
        let ((a, deep_a), (b, deep_b)) = (self.term(a), self.term(b));
        let depth = deep_a.max(deep_b) + 1;
        let runtime = &self.scope.runtime;
        let private = quote! { #runtime::private };
        let code = if self.reading == Reading::Robustness {
            match comparison {
                Comparison::Less | Comparison::AtMost => quote! { #b - #a },
                Comparison::Greater | Comparison::AtLeast => quote! { #a - #b },
                Comparison::Equal => quote! { -#private::abs(#a - #b) },
                Comparison::Unequal => quote! { #private::abs(#a - #b) },
            }
        } else {
            match comparison {
                Comparison::Less => quote! { #private::#finite less(#a, #b)? },
                Comparison::AtMost => quote! { #private::#finite at_most(#a, #b)? },
                Comparison::Greater => quote! { #private::#finite less(#b, #a)? },
                Comparison::AtLeast => quote! { #private::#finite at_most(#b, #a)? },
                Comparison::Equal => quote! { #private::#finite equal(#a, #b)? },
                Comparison::Unequal => quote! { !#private::#finite equal(#a, #b)? },
            }
        };
        let code = if self.reading == Reading::Robustness {
            quote! { (#code) }
        } else {
            code
        };
        (code, depth)
    }

    /// Whether two values of an enumeration or two truth values are equal, with robustness ±1. If
    /// one side may be absent, both are compared as options.
    fn value_comparison(&mut self, comparison: Comparison, a: TermId, b: TermId) -> Written {
        let mut beside = |side, other| {
            let value = self.leaf(side);
            match self.is_optional(other) && !self.is_optional(side) {
                true => quote! { ::core::option::Option::Some(#value) },
                false => value,
            }
        };
        let (a, b) = (beside(a, b), beside(b, a));
        let code = match comparison {
            Comparison::Unequal => quote! { (#a != #b) },
            _ => quote! { (#a == #b) },
        };
        let runtime = &self.scope.runtime;
        match self.reading {
            Reading::Robustness => (quote! { #runtime::private::truth #code }, 0),
            Reading::Truth => (code, 0),
        }
    }

    /// Whether a value is an `Option` in the code.
    fn is_optional(&self, term: TermId) -> bool {
        match self.scope.module.arena.term(term) {
            Term::Absent => true,
            Term::Place { scalar, .. }
            | Term::Parameter { ty: ParameterType::Scalar(scalar), .. } => {
                matches!(scalar, Scalar::Enum { optional: true, .. })
            }
            _ => false,
        }
    }

    /// A term, after everything that it needs. Terms are shared by the conditions of one
    /// expression.
    fn term(&mut self, root: TermId) -> Written {
        let needed = arena::needed(vec![root.0], &mut |id, open| {
            let term = self.scope.module.arena.term(TermId(id));
            if matches!(term, Term::Negate(_) | Term::Calculate(..) | Term::Call(..)) {
                open.extend(term.operands().iter().map(|operand| operand.0));
            }
        });
        for id in needed.into_iter().map(TermId) {
            if self.terms.get(&id).is_none() {
                let (code, depth) = self.one_term(id);
                let name = self.scope.names.local(&format!("t{}", id.0));
                let written = if depth > DEPTH {
                    self.lets.extend(quote! { let #name = #code; });
                    (quote! { #name }, 0)
                } else {
                    (code, depth)
                };
                self.terms.get_or_insert(id, written);
            }
        }
        self.known_term(root)
    }

    /// The code of a term that has been written before.
    fn known_term(&self, id: TermId) -> Written {
        self.terms.get(&id).expect("operands stand first").clone()
    }

    /// The code of one term, as an `f64` if it is a number, from that of its operands.
    fn one_term(&mut self, id: TermId) -> Written {
        let runtime = &self.scope.runtime;
        match self.scope.module.arena.term(id) {
            Term::Number(Number(value)) => (number(*value), 0),
            Term::Place { scalar: Scalar::Number(Numeric::F64) | Scalar::Enum { .. }, .. }
            | Term::Variant { .. }
            | Term::Absent
            | Term::Truth(_)
            | Term::Host { value: true, .. }
            | Term::Parameter {
                ty:
                    ParameterType::Host(_)
                    | ParameterType::Scalar(
                        Scalar::Number(Numeric::F64) | Scalar::Bool | Scalar::Enum { .. },
                    ),
                ..
            } => (self.leaf(id), 0),
            Term::Place { .. } | Term::Host { .. } | Term::Parameter { .. } => {
                // If its type is wrong, rustc underlines the author's own expression.
                let span = self.span(id);
                let place = self.leaf(id);
                (quote_spanned! { span => #runtime::private::number(#place) }, 0)
            }
            // Only a bare formula has free variables, and it is never written as Rust.
            Term::Variable(_) => (number(f64::NAN), 0),
            Term::Negate(a) => {
                let (a, depth) = self.known_term(*a);
                (quote! { (-#a) }, depth + 1)
            }
            Term::Calculate(operator, a, b) => {
                let ((a, deep_a), (b, deep_b)) = (self.known_term(*a), self.known_term(*b));
                let operator = match operator {
                    Arithmetic::Add => quote! { + },
                    Arithmetic::Subtract => quote! { - },
                    Arithmetic::Multiply => quote! { * },
                    Arithmetic::Divide => quote! { / },
                };
                (quote! { (#a #operator #b) }, deep_a.max(deep_b) + 1)
            }
            Term::Call(function, a, b) => {
                let (a, deep_a) = self.known_term(*a);
                let name = ident(function.name());
                let b = b.map(|b| self.known_term(b));
                let deep_b = b.as_ref().map_or(0, |b| b.1);
                let b = b.map(|(b, _)| quote! { , #b });
                (quote! { #runtime::private::#name(#a #b) }, deep_a.max(deep_b) + 1)
            }
        }
    }

    /// The span at which the author's tokens of a term begin, for rustc's own messages.
    fn span(&self, id: TermId) -> TokenSpan {
        match self.scope.module.arena.term(id) {
            Term::Host { span, .. } => first_span(&(self.scope.host)(*span)),
            _ => TokenSpan::call_site(),
        }
    }

    /// A place within the state, a value, or a Rust expression, of its own type.
    fn leaf(&mut self, id: TermId) -> TokenStream {
        let module = self.scope.module;
        match module.arena.term(id) {
            Term::Place { steps, .. } => {
                let state = &self.scope.state;
                let steps: Vec<_> = steps.iter().map(|step| self.step(step)).collect();
                quote! { #state #(#steps)* }
            }
            Term::Host { span, bindings, .. } => {
                let host = self.scope.rust(*span);
                self.bound(bindings, quote! { (#host) })
            }
            Term::Variant { of, name, .. } => {
                let (of, name) = (ident(&module.enums[*of as usize].name), ident(name));
                quote! { #of::#name }
            }
            Term::Absent => quote! { ::core::option::Option::None },
            Term::Truth(value) => quote! { #value },
            Term::Parameter { name, .. } => {
                let name = self.scope.names.parameter(name);
                quote! { #name }
            }
            Term::Number(Number(value)) => number(*value),
            _ => TokenStream::new(),
        }
    }

    /// One step into the state: a field, or an element.
    fn step(&mut self, step: &Step) -> TokenStream {
        match step {
            Step::Field(name) => {
                let name = ident(name);
                quote! { .#name }
            }
            Step::Index(index) => {
                let index = Literal::u32_unsuffixed(*index);
                quote! { [#index] }
            }
            Step::Element(index) | Step::At { index, .. } => {
                let index = self.leaf(*index);
                quote! { [#index as ::core::primitive::usize] }
            }
        }
    }
}

/// The span at which tokens begin, within the brackets around them.
fn first_span(tokens: &TokenStream) -> TokenSpan {
    match tokens.clone().into_iter().next() {
        Some(TokenTree::Group(group)) => first_span(&group.stream()),
        Some(tree) => tree.span(),
        None => TokenSpan::call_site(),
    }
}

/// A constant condition: ±∞, the neutral and absorbing elements of minimum and maximum.
fn truth(value: bool, robust: bool) -> TokenStream {
    match (robust, value) {
        (false, value) => quote! { #value },
        (true, true) => quote! { ::core::primitive::f64::INFINITY },
        (true, false) => quote! { ::core::primitive::f64::NEG_INFINITY },
    }
}

/// A number as Rust writes it, always an `f64`.
fn number(value: f64) -> TokenStream {
    if value.is_nan() {
        return quote! { ::core::primitive::f64::NAN };
    }
    let literal = Literal::f64_suffixed(value.abs());
    if value.is_sign_negative() {
        quote! { (-#literal) }
    } else {
        quote! { #literal }
    }
}

/// An integer as Rust writes it, with the type `name`; of whatever type is needed if that is empty.
fn whole(value: f64, name: &str) -> TokenStream {
    let literal = format!("{}{name}", value.abs());
    let literal: Literal = literal.parse().unwrap_or_else(|_| Literal::f64_suffixed(value.abs()));
    if value < 0.0 {
        quote! { (-#literal) }
    } else {
        quote! { #literal }
    }
}

/// The word `name` as it stands in the author's Rust: two words of the same letters may be
/// different names if a macro made them.
fn word(code: &TokenStream, name: &str) -> Ident {
    find(code, bare(name)).unwrap_or_else(|| ident(name))
}

/// The first identifier of this name in some tokens.
fn find(code: &TokenStream, name: &str) -> Option<Ident> {
    code.clone().into_iter().find_map(|tree| match tree {
        TokenTree::Group(group) => find(&group.stream(), name),
        TokenTree::Ident(known) if bare(&known.to_string()) == name => Some(known),
        _ => None,
    })
}
