//! [`Resolved`] to [`Module`]: types, units, negation normal form, co-safety.
//!
//! The stages of one item, in this order:
//!
//! | stage | direction | what it makes |
//! | --- | --- | --- |
//! | `role` | root to leaves | what each operand must be (a number, a formula) and whether it is negated |
//! | `lower` | leaves to root | the terms of the numbers |
//! | `unit` | leaves to root | the unit of each number, checked |
//! | `atom` | leaves | the conditions of comparisons, names and applied predicates, or other tasks |
//! | `condition` | leaves to root | the condition of a predicate |
//! | `spec` | leaves to root | the [`Spec`] of a task |
//!
//! All are loops over the arena, so depth costs nothing. A mistake is noted once, where it is made;
//! whatever depends on it has no term or formula (`None`), and the later stages pass over it in
//! silence.
//!
//! Co-safety is a matter of roles: negation is pushed to the leaves while roles are given, and a
//! temporal operator that has to be negated is refused there. So the [`Spec`] needs no check of its
//! own.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let module = check::formula(&Source::new("formula", "!(a || b) U c"))?;
//! assert_eq!(module.tasks[0].spec.to_string(), "(!a && !b) U c");
//! let errors = check::formula(&Source::new("formula", "!F a")).unwrap_err();
//! assert_eq!(errors.first().kind().name(), "negated-temporal");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

mod apply;
mod atom;
mod attribute;
mod bound;
mod condition;
mod intent;
mod lower;
mod proposition;
mod role;
mod spec;
mod unit;
mod value;

use crate::ast::{Ast, Item, ItemKind};
use crate::error::{Error, Errors, Kind};
use crate::parse;
use crate::predicate::{ConditionId, Constant, Module, Predicate, PredicateId, Task, TermId};
use crate::resolve::{ExpressionId, Names, Resolved, resolve};
use crate::source::{Source, Span};
use crate::spec::Spec;
use atom::Atoms;
use lower::Lowering;
use proposition::Propositions;
use role::{Role, Roles};
use unit::{Measure, Measuring};

/// Parses and checks a bare formula: a module of one task without a name.
///
/// # Errors
/// All mistakes that it has.
pub fn formula(source: &Source) -> Result<Module, Errors> {
    finish(parse::recover_formula(source), Names::Free)
}

/// Parses and checks a task file.
///
/// ```
/// use tltl_compiler::{check, source::Source};
///
/// let text = "state S { d: f64 in m }\npredicate near = d < 2\ntask go = F near\n";
/// let module = check::file(&Source::new("go.tltl", text))?;
/// assert_eq!(module.tasks[0].name.as_deref(), Some("go"));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// All mistakes that it has, of form and of meaning.
pub fn file(source: &Source) -> Result<Module, Errors> {
    let (ast, mut mistakes) = parse::recover_file(source);
    if ast.items().is_empty() && mistakes.is_empty() {
        let error = Error::new(Kind::Syntax, "this file declares nothing", Span::default());
        mistakes.push(error.help(
            "declare the state and a task, such as `state Cell { x: f64 }` and `task go = F (x > 1)`",
        ));
    }
    finish((ast, mistakes), Names::Declared)
}

/// Parses and checks the input of `tltl!{ … }`; with a state of its own, it is a task file.
///
/// ```
/// use tltl_compiler::{check, predicate::Condition, source::Source};
///
/// // Without a header, names are values in scope that are predicates.
/// let module = check::fragment(&Source::new("macro", "F at_home"))?;
/// let condition = module.arena.condition(module.predicates[0].condition);
/// assert!(matches!(condition, Condition::Value { text, .. } if text == "at_home"));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// All mistakes that it has, of form and of meaning.
pub fn fragment(source: &Source) -> Result<Module, Errors> {
    let parsed = parse::recover_fragment(source);
    let is_state = |item: &Item| matches!(item.kind, ItemKind::State(_));
    let names = if parsed.0.items().iter().any(is_state) { Names::Declared } else { Names::Host };
    finish(parsed, names)
}

/// Resolves and checks the items that could be parsed, together with the mistakes of form in the
/// others. So an author sees mistakes of both kinds at once.
fn finish((ast, mut mistakes): (Ast, Vec<Error>), names: Names) -> Result<Module, Errors> {
    let numbers = mistakes.iter().filter(|mistake| mistake.kind() == Kind::Number);
    let numbers: Vec<Span> = numbers.map(Error::span).collect();
    let resolved = resolve(&ast, names, &mut mistakes);
    mistakes.extend(attribute::misplaced(&ast));
    let mut checker = Checker::new(&resolved);
    resolved.order.iter().for_each(|item| checker.item(*item));
    let (module, found) = checker.finish();
    mistakes.extend(found);
    // A number that cannot be represented counts as 1 so that checking can go on; a mistake about
    // that 1 would not be the author's.
    mistakes.retain(|mistake| mistake.kind() == Kind::Number || !numbers.contains(&mistake.span()));
    let of_form = mistakes.iter_mut().filter(|mistake| mistake.kind() == Kind::Syntax);
    of_form.for_each(|mistake| mistake.keep_helps(&is_welcome));
    Errors::check(mistakes).map(|()| module)
}

/// Whether advice is no formula, or one that is accepted: the words of another tool may say, in ours,
/// what this language has not.
fn is_welcome(help: &str) -> bool {
    let advised = help.strip_prefix("write `").and_then(|help| help.strip_suffix('`'));
    advised.is_none_or(|text| {
        let source = Source::new("advice", text);
        parse::formula(&source).is_err() || formula(&source).is_ok()
    })
}

/// A module under construction.
struct Checker<'r> {
    /// The source, its names resolved.
    resolved: &'r Resolved<'r>,
    /// The terms and conditions so far, and all mistakes.
    lowering: Lowering<'r>,
    /// The predicates so far.
    propositions: Propositions,
    /// The constants so far.
    constants: Vec<Constant>,
    /// The unit of each constant, by its item.
    measures: Vec<Measure>,
    /// The tasks checked so far, by their number; `None` for one with a mistake.
    tasks: Vec<Option<Task>>,
}

impl<'r> Checker<'r> {
    /// An empty module.
    fn new(resolved: &'r Resolved<'r>) -> Self {
        let items = resolved.ast.items().len();
        Self {
            resolved,
            lowering: Lowering::new(resolved),
            propositions: Propositions::new(items),
            constants: Vec::new(),
            measures: vec![Measure::Free; items],
            tasks: vec![None; resolved.scope.task_count()],
        }
    }

    /// Checks an item. The items that it uses have been checked before.
    fn item(&mut self, item: usize) {
        let resolved = self.resolved;
        let Some((first, root)) = resolved.expressions[item] else { return };
        let role = match resolved.item(item).kind {
            ItemKind::Constant(..) => Role::Number,
            ItemKind::Predicate(..) => Role::Condition,
            _ => Role::FORMULA,
        };
        let known = self.lowering.mistakes.len();
        self.lowering.item = item;
        let roles = role::roles(resolved, (first, root), role, &mut self.lowering.mistakes);
        let terms = self.lowering.terms(&roles);
        let measure = self.measure(root, &roles, &terms);
        match role {
            Role::Number if terms.last().is_some_and(Option::is_some) => {
                self.constant(item, root, measure);
            }
            Role::Condition => {
                if let Some(condition) = self.atoms(&roles, &terms).condition() {
                    self.predicate(item, condition);
                }
            }
            Role::Formula { .. } => {
                if let Some((spec, predicates)) = spec::spec(self.atoms(&roles, &terms)) {
                    self.task(item, root, spec, predicates);
                }
            }
            _ => {}
        }
        self.forget_unclear(item, known);
    }

    /// Checks the units of an item, and returns that of its root.
    fn measure(&mut self, root: ExpressionId, roles: &Roles, terms: &[Option<TermId>]) -> Measure {
        let measuring = Measuring {
            resolved: self.resolved,
            item: self.lowering.item,
            constants: &self.measures,
            roles,
            terms,
            known: Vec::new(),
            mistakes: &mut self.lowering.mistakes,
        };
        measuring.measure(root)
    }

    /// What the leaves of an item are made from.
    fn atoms<'c>(&'c mut self, roles: &'c Roles, terms: &'c [Option<TermId>]) -> Atoms<'c, 'r> {
        Atoms {
            resolved: self.resolved,
            lowering: &mut self.lowering,
            propositions: &mut self.propositions,
            tasks: &self.tasks,
            roles,
            terms,
        }
    }

    /// Drops the mistakes of an item about parameters whose types have mistakes: they follow from
    /// those. `known` is the number of mistakes before the item.
    fn forget_unclear(&mut self, item: usize, known: usize) {
        let unclear = self.resolved.scope.unclear(item);
        let source = self.resolved.ast.source();
        let found = self.lowering.mistakes.split_off(known);
        let is_own = |error: &Error| !unclear.iter().any(|name| name == source.slice(error.span()));
        self.lowering.mistakes.extend(found.into_iter().filter(is_own));
    }

    /// Adds a constant. Its value was computed while names were resolved.
    fn constant(&mut self, item: usize, root: ExpressionId, measure: Measure) {
        let Some(value) = self.resolved.constant(item) else {
            let message = "a constant is made of numbers and other constants only";
            let error = Error::new(Kind::Type, message, self.resolved.span(root));
            return self.lowering.mistakes.push(error);
        };
        let unit = match &measure {
            Measure::In(unit) => Some(unit.clone()),
            _ => None,
        };
        self.measures[item] = measure;
        let name = self.resolved.item_name(item).to_owned();
        let docs = self.resolved.item(item).docs.clone();
        self.constants.push(Constant { name, docs, value, unit });
    }

    /// Adds a declared predicate.
    fn predicate(&mut self, item: usize, condition: ConditionId) {
        let entry = self.resolved.item(item);
        let id = self.propositions.add(Predicate {
            name: self.resolved.item_name(item).to_owned(),
            declared: true,
            parameters: self.resolved.scope.parameters(item).to_vec(),
            docs: entry.docs.clone(),
            span: entry.name,
            condition,
        });
        self.propositions.declared[item] = Some(id);
    }

    /// Adds a task.
    fn task(&mut self, item: usize, root: ExpressionId, spec: Spec, predicates: Vec<PredicateId>) {
        let (resolved, ast) = (self.resolved, self.resolved.ast);
        let (entry, name) = (resolved.item(item), resolved.item_name(item));
        let task = Task {
            name: (!name.is_empty()).then(|| name.to_owned()),
            docs: entry.docs.clone(),
            span: if name.is_empty() { resolved[root].outer } else { entry.name },
            parameters: resolved.scope.parameters(item).to_vec(),
            text: match entry.kind {
                ItemKind::Task(_, root) => ast.display(root).to_string(),
                _ => String::new(),
            },
            spec,
            predicates,
            parts: spec::parts(resolved, root),
            options: attribute::options(ast, &entry.attributes, &mut self.lowering.mistakes),
        };
        if let Some(id) = resolved.scope.task_id(item) {
            self.tasks[id.0 as usize] = Some(task);
        }
    }

    /// The module, and the mistakes.
    fn finish(self) -> (Module, Vec<Error>) {
        let (ast, scope) = (self.resolved.ast, &self.resolved.scope);
        let module = Module {
            docs: ast.docs().to_vec(),
            state: scope.state(),
            structs: scope.structs.clone(),
            enums: scope.enums.clone(),
            units: scope.units.clone(),
            constants: self.constants,
            predicates: self.propositions.predicates,
            arena: self.lowering.arena,
            places: self.lowering.places,
            tasks: self.tasks.into_iter().flatten().collect(),
        };
        (module, self.lowering.mistakes)
    }
}
