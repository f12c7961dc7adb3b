//! Warnings: what compiles and is hardly meant.
//!
//! They are made here and not by the compiler, because macros cannot warn on stable Rust: every
//! user of the macros would build them, and none would see one.
//!
//! Each kind is a function of what it needs, and no more:
//!
//! | of | needs | finds |
//! | --- | --- | --- |
//! | `order` | the source as it was written | operators that order less than they seem to |
//! | `pasted` | a bare formula as it was written | names that are operators or constants in other tools |
//! | `unused` | the source as it was written | predicates and constants that nothing uses |
//! | `certain` | a task and its automaton | what always holds; in a bare formula also what never does |
//! | `vacuity` | a task and its automaton | parts that could be left out |

mod certain;
mod order;
mod pasted;
mod unused;
mod vacuity;

use tltl_compiler::ast::{Ast, Item, ItemKind, NodeId};
use tltl_compiler::compile::Compiled;
use tltl_compiler::dfa::Automata;
use tltl_compiler::error::Error;
use tltl_compiler::parse;
use tltl_compiler::predicate::Task;
use tltl_compiler::source::{Source, Span};

/// The most warnings of a source: as many as the compiler reports errors.
const MOST: usize = 100;

/// What the author of a source should look at, in its order. `compiled` is what the compiler made
/// of this source, a formula or a task file.
///
/// It is deterministic, and bounded: large formulas and automata are not searched for parts that do
/// not matter.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let source = Source::new("formula", "F a T b");
/// let compiled = compile::formula(&source, Budget::default())?;
/// let warnings = tltlc::lint::warnings(&source, &compiled);
/// assert_eq!(warnings[0].kind().name(), "intent");
/// assert!(warnings[0].message().ends_with("which does not order a before b"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn warnings(source: &Source, compiled: &Compiled) -> Vec<Error> {
    let module = &compiled.module;
    // A bare formula is a task without a name.
    let is_bare = tasks(compiled).any(|(task, _)| task.name.is_none());
    let read = if is_bare { parse::recover_formula } else { parse::recover_file };
    let mut warnings = written(&read(source));
    for (task, automata) in tasks(compiled) {
        warnings.extend(certain::predicates(module, task, automata));
    }
    warnings.extend(certain::tasks(compiled));
    for (task, automata) in module.tasks.iter().zip(&compiled.automata) {
        warnings.extend(vacuity::warnings(module, task, automata));
    }
    warnings.sort_by_key(Error::span);
    // Tasks share predicates, and each of them finds what is wrong with one.
    warnings.dedup();
    warnings.truncate(MOST);
    warnings
}

/// The warnings that the text alone gives, whether or not it compiles: `parsed` is what could be
/// read of it, with the mistakes of form. Where there are some, what could not be read may be the
/// use of anything.
///
/// ```
/// use tltl_compiler::{parse, source::Source};
///
/// let text = "state S { x: f64 }\nconst far = 3\ntask t = F (x < near)\n";
/// let parsed = parse::recover_file(&Source::new("s.tltl", text));
/// let warnings = tltlc::lint::written(&parsed);
/// assert_eq!(warnings[0].message(), "constant `far` is never used");
/// ```
#[must_use]
pub fn written((ast, mistakes): &(Ast, Vec<Error>)) -> Vec<Error> {
    let mut warnings: Vec<Error> = nodes(ast).filter_map(|id| order::warning(ast, id)).collect();
    if mistakes.is_empty() {
        warnings.extend(unused::warnings(ast));
    }
    let is_bare =
        |item: &Item| matches!(item.kind, ItemKind::Task(..)) && item.name == Span::default();
    if ast.items().iter().any(is_bare) {
        warnings.extend(pasted::warnings(ast));
    }
    warnings
}

/// The tasks that have an automaton: those that are not factored, and the parts of the others.
fn tasks(compiled: &Compiled) -> impl Iterator<Item = (&Task, &Automata)> {
    let parts = compiled.factored.iter().flat_map(|factored| &factored.parts);
    let whole = compiled.module.tasks.iter().zip(&compiled.automata);
    whole.chain(parts.map(|part| (&part.task, &part.automata)))
}

/// The nodes of all expressions.
fn nodes(ast: &Ast) -> impl Iterator<Item = NodeId> {
    let roots = ast.items().iter().filter_map(|item| match item.kind {
        ItemKind::Constant(_, root) | ItemKind::Predicate(_, root) | ItemKind::Task(_, root) => {
            Some(root)
        }
        _ => None,
    });
    roots.flat_map(|root| (ast.first(root).0..=root.0).map(NodeId))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tltl_compiler::compile;
    use tltl_compiler::translate::Budget;

    /// The warnings of a file, a line each.
    fn told(text: &str) -> Vec<String> {
        let source = Source::new("source", text);
        let compiled = compile::file(&source, Budget::default()).unwrap();
        let line = |warning: &Error| format!("{}: {}", warning.kind().name(), warning.message());
        warnings(&source, &compiled).iter().map(line).collect()
    }

    #[test]
    fn what_is_hardly_meant_is_found_once() {
        const STATE: &str = "state S { x: f64 in m, y: f64 in 1, on: [bool; 2] }\n";
        for (text, expected) in [
            ("predicate p = x < 1", &[][..]),
            ("predicate p = x < 1\ntask t = F on[0]", &["unused: predicate `p` is never used"]),
            ("const n = 1\ntask t = F on[n]", &[]),
            ("const n = 1\ntask t(d: f64 in m) = F x < d", &[]),
            ("const n = 1\ntask t = F on[0]", &["unused: constant `n` is never used"]),
            (
                "predicate p = x < 1 || x > 0\n#[factored]\ntask t = F p && F (y < 1)",
                &["valid: the predicate `p` always holds"],
            ),
            (
                "predicate p = x < 1 || x > 0\ntask t = F (p && y < 1)\ntask u = F (p && y > 1)",
                &["valid: the predicate `p` always holds"],
            ),
            (
                "#[factored]\ntask t = F (x < 1 || x >= 1) && F (y < 1 || y >= 1)",
                &["valid: task `t` is always satisfied"],
            ),
            (
                "task t = for all i in 0..2: (F on[i] T x < 1) && F y < 1",
                &[
                    "intent: `F on[i] T (x < 1)` reads `(F on[i]) T (x < 1)`, which does not order on[i] before x < 1",
                ],
            ),
            (
                "task t = x < 1 U F y < 1",
                &[
                    "vacuous: `x < 1` does not matter: `F y < 1` already looks ahead, so `U` need not wait for it",
                ],
            ),
        ] {
            assert_eq!(told(&format!("{STATE}{text}\n")), expected, "{text}");
        }
    }

    /// Whether a bare formula has an `intent` warning, and what it says to write.
    fn asked(text: &str) -> Vec<String> {
        let warnings = written(&parse::recover_formula(&Source::new("formula", text)));
        warnings.iter().map(|warning| warning.helps()[0].clone()).collect()
    }

    #[test]
    fn pasted_operators_are_asked_about() {
        for (text, apart) in [
            ("Fa && b", "F a"),
            ("GFp0", "G F p0"),
            ("XXa U b", "X X a"),
            ("q || Xp1", "X p1"),
            ("Fgoal && !goal", "F goal"),
            ("FGsafe", "F G safe"),
            ("Xdone", "X done"),
            ("Fgoal && b", "F goal"),
            ("Fridge && ridge", "F ridge"),
            ("F (Xa == 3)", "X a"),
        ] {
            assert_eq!(asked(text), [format!("for the operators, write `{apart}`")], "{text}");
        }
        let words = ["last", "end", "tt", "ff", "TRUE", "True", "FALSE", "False"];
        for word in words {
            assert_eq!(asked(&format!("F ({word} && a)")).len(), 1, "{word}");
        }
        for name in [
            "Fridge", "Floor", "Garage", "Xenon", "X1", "FA", "InFridge", "F_a", "fa", "first",
            "s.Fa", "Frob_1x", "GPS", "r#Fa",
        ] {
            assert_eq!(asked(&format!("F ({name} && a)")), [""; 0], "{name}");
        }
        assert_eq!(asked("for some Fa in {goal, key}: F Fa"), [""; 0]);
        let file = "state S { Fa: bool, last: bool }\ntask t = F (Fa && last)\n";
        assert_eq!(told(file), [""; 0]);
    }

    #[test]
    fn suggestions_keep_their_brackets() {
        for (text, written) in [
            ("F (lit || door) T (door && key)", "(lit || door) T (door && key)"),
            ("F (h > 4 && v < 1) T (h <= 0)", "(h > 4 && v < 1) T (h <= 0)"),
            ("((p && q) T (q || r)) T (p || r)", "(p && q) T ((q || r) T (p || r))"),
            ("(a T X b) T[<=3] c", "a T ((X b) T[<=3] c)"),
            ("F a T[1,2] (b => c)", "a T[1,2] (b => c)"),
            ("(a T[1,2] b) T (c && d)", "a T[1,2] (b && X F (c && d))"),
            ("(a T[1,2] b) T[<=3] c", "a T[1,2] (b && F[1,3] c)"),
            ("(a || b) U F (c && d)", "(a || b) U (c && d)"),
            ("a U[1,2] F x < 3", "a U[1,2] (x < 3)"),
        ] {
            let found = asked(text);
            assert!(found[0].contains(&format!("write `{written}`")), "{text}: {found:?}");
            assert!(parse::formula(&Source::new("written", written)).is_ok());
        }
        assert_eq!(asked("a U F[0,3] b"), [""; 0]);
        // No suggestion loses a bound.
        assert_eq!(asked("F[0,2] a T b"), ["to keep this meaning, write the brackets"]);
    }
}
