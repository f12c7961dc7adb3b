//! [`Ast`] to [`Module`]: names, types, negation normal form, co-safety.
//!
//! The stages of one expression: `role` goes from the root down and decides what each operand
//! has to be, a number or a formula, and whether it stands under a negation; `term` and
//! `atom` go from the leaves up and resolve names and comparisons, and `unit` what numbers are
//! measured in; `formula` builds the [`Spec`](crate::spec::Spec). All are loops over the arena. A
//! mistake is noted once, where it is made, and what depends on it is left alone.

mod apply;
mod atom;
mod attribute;
mod expand;
mod formula;
mod intent;
mod name;
mod order;
mod role;
mod scope;
mod term;
mod unit;
mod value;

use rustc_hash::FxHashMap;

use crate::ast::{Ast, ItemKind, NodeId};
use crate::error::{Error, Errors, Kind};
use crate::parse;
use crate::predicate::{
    Arena, Arguments, ConditionId, Constant, Module, Parameter, ParameterType, Predicate,
    PredicateId, Scalar, State, Task, TaskId,
};
use crate::source::{Source, Span};
use expand::{Environment, Expanded};
use scope::Scope;
use unit::Measure;

/// What a name may be that the source does not declare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Names {
    /// A bare formula: any name is a proposition, or a real variable inside a comparison.
    Free,
    /// The macro: a Rust value in scope, or an expression over the state.
    Host,
    /// A task file: nothing.
    Declared,
}

/// Checks a parsed source.
///
/// # Errors
/// All mistakes of meaning that it has.
pub fn check(ast: &Ast, names: Names) -> Result<Module, Errors> {
    finish(ast, names, Vec::new())
}

/// Parses and checks a bare formula: a module of one task without a name.
///
/// # Errors
/// All mistakes that it has.
pub fn formula(source: &Source) -> Result<Module, Errors> {
    let (ast, mistakes) = parse::recover_formula(source);
    finish(&ast, Names::Free, mistakes)
}

/// Parses and checks a task file.
///
/// # Errors
/// All mistakes that it has, of form and of meaning.
pub fn file(source: &Source) -> Result<Module, Errors> {
    let (ast, mistakes) = parse::recover_file(source);
    finish(&ast, Names::Declared, mistakes)
}

/// Parses and checks what stands inside `tltl!{ … }`.
///
/// # Errors
/// All mistakes that it has, of form and of meaning.
pub fn fragment(source: &Source) -> Result<Module, Errors> {
    let (ast, mistakes) = parse::recover_fragment(source);
    finish(&ast, Names::Host, mistakes)
}

fn finish(ast: &Ast, names: Names, mistakes: Vec<Error>) -> Result<Module, Errors> {
    let broken = !mistakes.is_empty();
    let numbers = mistakes.iter().filter(|mistake| mistake.kind() == Kind::Number);
    let numbers: Vec<Span> = numbers.map(Error::span).collect();
    let mut mistakes = mistakes;
    let scope = Scope::new(ast, names, &mut mistakes);
    let expanded = expand::expand(ast, &scope, &mut mistakes);
    let mut checker = Checker::new(ast, &expanded, scope, names, mistakes);
    checker.items();
    if !broken {
        checker.warn_unused();
    }
    let Checker { mut module, mut mistakes, tasks, .. } = checker;
    // What stands in the place of a number that is none is not its author's.
    mistakes.retain(|mistake| mistake.kind() == Kind::Number || !numbers.contains(&mistake.span()));
    module.warnings = Errors::split(mistakes)?;
    module.tasks = tasks.into_iter().flatten().collect();
    Ok(module)
}

/// The state of checking one source.
struct Checker<'a> {
    /// The source as it was written.
    written: &'a Ast,
    /// The source without quantifiers.
    ast: &'a Ast,
    /// What the names bound by quantifiers stand for around an expression.
    bound: &'a FxHashMap<NodeId, Environment>,
    /// The parameters of the item that is being checked.
    parameters: Vec<Parameter>,
    names: Names,
    scope: Scope<'a>,
    module: Module,
    /// The tasks that are checked, by their place among the tasks of the source.
    tasks: Vec<Option<Task>>,
    mistakes: Vec<Error>,
    /// What is known of each item.
    items: Vec<Checked>,
    /// The predicate that a condition is, and whether it is its negation.
    known: FxHashMap<ConditionId, (PredicateId, bool)>,
    /// Where each name that is declared outside of the source stands first, and whether as a
    /// formula there.
    free: FxHashMap<String, (bool, Span)>,
    /// What conditions with parameters are with arguments.
    instances: FxHashMap<(ConditionId, Arguments), ConditionId>,
    /// How many more operators and operands these may have, written out.
    room: Option<usize>,
}

/// What checking has found out about an item.
#[derive(Clone, Default)]
struct Checked {
    /// Whether something uses it.
    used: bool,
    /// The value of a constant.
    value: Option<f64>,
    /// What a constant is measured in.
    measure: Option<Measure>,
    /// The predicate that it declares.
    predicate: Option<PredicateId>,
}

impl<'a> Checker<'a> {
    fn new(
        written: &'a Ast,
        expanded: &'a Expanded,
        scope: Scope<'a>,
        names: Names,
        mistakes: Vec<Error>,
    ) -> Self {
        let ast = expanded.ast.as_ref().unwrap_or(written);
        let module = Module {
            docs: ast.docs().to_vec(),
            state: scope.state(ast, names),
            structs: scope.structs.clone(),
            enums: scope.enums.clone(),
            units: scope.units.clone(),
            constants: Vec::new(),
            predicates: Vec::new(),
            arena: Arena::default(),
            places: Vec::new(),
            tasks: Vec::new(),
            warnings: Vec::new(),
        };
        let tasks = vec![None; scope.task_count()];
        Self {
            written,
            ast,
            bound: &expanded.bound,
            parameters: Vec::new(),
            names,
            scope,
            module,
            tasks,
            mistakes,
            items: vec![Checked::default(); ast.items().len()],
            known: FxHashMap::default(),
            free: FxHashMap::default(),
            instances: FxHashMap::default(),
            room: Some(expand::MOST_NODES),
        }
    }

    /// Checks all items, each after the ones that it uses.
    fn items(&mut self) {
        self.check_attributes();
        let order = order::order(self.ast, &self.scope, &mut self.mistakes);
        for item in order {
            self.parameters = self.scope.parameters(item).to_vec();
            let known = self.mistakes.len();
            match self.ast.items()[item].kind {
                ItemKind::Constant(_, root) => self.constant(item, root),
                ItemKind::Predicate(_, root) => self.predicate(item, root),
                ItemKind::Task(_, root) => self.task(item, root),
                _ => {}
            }
            // What is said of a parameter without a type follows from that.
            let unclear = self.scope.unclear(item);
            let source = self.ast.source();
            let follows = |name: &str| unclear.iter().any(|known| known == name);
            let mut place = 0..;
            self.mistakes.retain(|mistake| {
                place.next().is_none_or(|at| at < known) || !follows(source.slice(mistake.span()))
            });
        }
    }

    fn constant(&mut self, item: usize, root: NodeId) {
        let roles = self.roles(root, role::Role::Number);
        let terms = self.terms(root, &roles);
        let measure = self.units(root, &roles, &terms);
        let Some(term) = terms.last().copied().flatten() else { return };
        let Some(value) = self.module.arena.constant(term) else {
            let message = "a constant is made of numbers and other constants only";
            return self.mistakes.push(Error::new(Kind::Type, message, self.ast.span(root)));
        };
        self.items[item].value = Some(value);
        let measure = self.constant_unit(item, root, measure);
        let unit = match &measure {
            Measure::In(unit) => Some(unit.clone()),
            _ => None,
        };
        self.items[item].measure = Some(measure);
        let entry = &self.ast.items()[item];
        let name = self.ast.source().slice(entry.name).to_owned();
        self.module.constants.push(Constant { name, docs: entry.docs.clone(), value, unit });
    }

    fn predicate(&mut self, item: usize, root: NodeId) {
        let Some(condition) = self.condition(root) else { return };
        let entry = &self.ast.items()[item];
        let id = self.add_predicate(Predicate {
            name: self.ast.source().slice(entry.name).to_owned(),
            declared: true,
            parameters: self.parameters.clone(),
            docs: entry.docs.clone(),
            span: entry.name,
            condition,
        });
        self.items[item].predicate = Some(id);
    }

    fn add_predicate(&mut self, predicate: Predicate) -> PredicateId {
        let count = self.module.predicates.len();
        self.module.predicates.push(predicate);
        PredicateId(u32::try_from(count).expect("fewer than 2^32 predicates"))
    }

    /// The task that `item` declares; `None` if it is not one.
    fn task_id(&self, item: usize) -> Option<TaskId> {
        self.scope.task_id(item)
    }

    /// Warns of predicates and constants that nothing uses.
    fn warn_unused(&mut self) {
        if !self.ast.items().iter().any(|item| matches!(item.kind, ItemKind::Task(..))) {
            return;
        }
        let takes_number =
            |known: &Parameter| matches!(known.ty, ParameterType::Scalar(Scalar::Number(_)));
        let mut tasks = self.tasks.iter().flatten();
        let given = tasks.any(|task| task.parameters.iter().any(takes_number));
        for (index, item) in self.ast.items().iter().enumerate() {
            let what = match item.kind {
                ItemKind::Predicate(..) => "predicate",
                ItemKind::Constant(..) => "constant",
                _ => continue,
            };
            let name = self.ast.source().slice(item.name);
            // A number may also be an index or the end of a range, or be there to be given to a task.
            if what == "constant" && (given || self.written.mentions(name)) {
                continue;
            }
            if !self.items[index].used && self.scope.item(name) == Some(index) {
                let message = format!("{what} `{name}` is never used");
                self.mistakes.push(Error::new(Kind::Unused, message, item.name).warning());
            }
        }
    }

    /// The name that stands for the state in Rust expressions.
    fn host(&self) -> Option<&str> {
        match &self.module.state {
            State::Host { name, .. } => Some(name),
            _ => None,
        }
    }
}
