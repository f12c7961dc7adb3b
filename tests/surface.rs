//! The syntax of bounds, `ensuring` and `<=>`: what each spelling means, in terms of formulas whose
//! meaning is tested elsewhere, or the kind of its mistake; and random texts against the definitions
//! of their operators, read off the tree before anything is rewritten.

use std::ops::RangeInclusive;

use proptest::prelude::*;
use tltl_compiler::ast::{Ast, Infix, ItemKind, Node, NodeId, Prefix};
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::error::Errors;
use tltl_compiler::parse;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::diff::{Difference, diff};

fn read(text: &str) -> Result<Compiled, Errors> {
    let budget = Budget { states: 10_000, ..Budget::default() };
    compile::formula(&Source::new("<formula>", text), budget)
}

/// Whether two formulas have the same models, their propositions matched by name.
fn alike(one: &Compiled, two: &Compiled) -> bool {
    let [one, two] = [one, two].map(|compiled| &compiled.automata[0].propositional);
    matches!(diff(one, two), Difference::None)
}

#[test]
fn every_spelling_means_what_it_must() {
    for line in include_str!("data/surface.jsonl").lines() {
        let row: serde_json::Value = serde_json::from_str(line).unwrap();
        let text = row["text"].as_str().unwrap();
        match (read(text), row["means"].as_str()) {
            (Ok(found), Some(means)) => {
                let expected = read(means).unwrap_or_else(|errors| panic!("{means}: {errors}"));
                assert!(alike(&found, &expected), "{text} is not {means}");
                let printed = found.module.tasks[0].spec.to_string();
                assert!(alike(&read(&printed).unwrap(), &expected), "{text} prints as {printed}");
            }
            (Err(errors), None) => {
                assert_eq!(errors.first().kind().name(), row["kind"], "{text}");
            }
            (found, _) => panic!("{text}: {:?}", found.map(drop)),
        }
    }
}

#[test]
fn a_block_of_the_macro_may_begin_with_its_step() {
    let text = "step 0.1 s; state s: S; predicate a = s.x > 1; task t = F[0.1 s, 0.35 s] a;";
    let compiled = compile::fragment(&Source::new("tltl!", text), Budget::default()).unwrap();
    assert_eq!(compiled.module.tasks[0].spec.to_string(), "F[1,3] a");
}

/// A trajectory: the propositions `a`, `b`, `c` of each state.
type Trace = [[bool; 3]];

/// Whether a formula holds at instant `i` of a trajectory, by the definitions. "Always" and its
/// like are those of the trajectory as a whole, so that a negation of them is what it should be.
fn holds(ast: &Ast, id: NodeId, trace: &Trace, i: usize) -> bool {
    let at = |id, j| holds(ast, id, trace, j);
    let window = window(ast, id).map(|steps| i + steps.start()..(i + steps.end() + 1));
    let rest = window.clone().unwrap_or(i..trace.len());
    let mut within = rest.clone().take_while(|j| *j < trace.len());
    match *ast.node(id) {
        Node::Name => {
            trace[i][["a", "b", "c"].iter().position(|name| *name == ast.text(id)).unwrap()]
        }
        Node::Prefix(Prefix::Not, a) => !at(a, i),
        Node::Prefix(Prefix::Next, a) => {
            let next = window.map_or(i + 1, |window| window.end - 1);
            next < trace.len() && at(a, next)
        }
        Node::Prefix(Prefix::Eventually, a) => within.any(|j| at(a, j)),
        Node::Prefix(Prefix::Always, a) => rest.clone().all(|j| j < trace.len() && at(a, j)),
        Node::Infix(Infix::And, a, b) => at(a, i) && at(b, i),
        Node::Infix(Infix::Or, a, b) => at(a, i) || at(b, i),
        Node::Infix(Infix::Implies, a, b) => !at(a, i) || at(b, i),
        Node::Infix(Infix::Iff, a, b) => at(a, i) == at(b, i),
        Node::Infix(Infix::Until, a, b) => within.any(|j| at(b, j) && (i..j).all(|k| at(a, k))),
        Node::Infix(Infix::WeakUntil, a, b) => {
            let all = (i..trace.len()).all(|j| at(a, j));
            all || within.any(|j| at(b, j) && (i..j).all(|k| at(a, k)))
        }
        Node::Infix(Infix::Release, a, b) => within.all(|j| at(b, j) || (i..j).any(|k| at(a, k))),
        Node::Infix(Infix::Then, a, b) => (i..trace.len()).any(|k| {
            let steps = self::window(ast, id)
                .map_or(k + 1..trace.len(), |steps| k + steps.start()..k + steps.end() + 1);
            at(a, k) && steps.take_while(|j| *j < trace.len()).any(|j| at(b, j))
        }),
        Node::Infix(Infix::Ensuring, a, p) => {
            let first = (i..trace.len()).find(|n| holds(ast, a, &trace[..=*n], i));
            first.is_some_and(|n| (i..=n).all(|k| at(p, k)))
        }
        ref other => panic!("{other:?}"),
    }
}

/// The bound of an operator in steps.
fn window(ast: &Ast, id: NodeId) -> Option<RangeInclusive<usize>> {
    let bound = ast.entry(id).bound.as_ref()?;
    let ends: Vec<usize> =
        bound.ends.iter().map(|end| ast.text(end.node).parse().unwrap()).collect();
    let then = matches!(ast.node(id), Node::Infix(Infix::Then, ..));
    Some(if let [first, last] = ends[..] { first..=last } else { usize::from(then)..=ends[0] })
}

fn state_formula() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(vec!["a", "b", "c", "!a", "!c"]).prop_map(str::to_owned);
    leaf.prop_recursive(2, 5, 2, |inner| {
        let op = prop::sample::select(vec!["&&", "||", "<=>", "=>"]);
        (any::<bool>(), inner.clone(), op, inner)
            .prop_map(|(not, a, op, b)| format!("{}({a} {op} {b})", if not { "!" } else { "" }))
    })
}

/// A text of the language; brackets stand only where two operators of one level meet.
fn text() -> impl Strategy<Value = String> {
    let prefix = vec![
        "F ", "X ", "F[1,2]", "F[<=3] ", "G[0,2]", "G[1] ", "X[2] ", "◇[2,2]", "[][0,1]", "!G !",
    ];
    let infix = vec!["&&", "||", "U", "T", "U[1,3]", "U[<=2]", "T[1,2]", "T[<=3]"];
    let vanishing = vec!["R", "W"];
    state_formula().prop_recursive(4, 10, 2, move |inner| {
        let two = (inner.clone(), prop::sample::select(infix.clone()), inner.clone());
        let negated = (state_formula(), prop::sample::select(vanishing.clone()), state_formula());
        prop_oneof![
            3 => (prop::sample::select(prefix.clone()), inner.clone()).prop_map(|(op, a)| format!("{op}({a})")),
            3 => two.prop_map(|(a, op, b)| format!("(({a}) {op} ({b}))")),
            1 => negated.prop_map(|(a, op, b)| format!("!({a} {op} {b})")),
            1 => (state_formula(), inner.clone()).prop_map(|(p, a)| format!("({p} => {a})")),
            2 => (inner, state_formula()).prop_map(|(a, p)| format!("({a} ensuring {p})")),
        ]
    })
}

/// The state after one more letter.
fn step(dfa: &Dfa, q: u32, letter: [bool; 3]) -> u32 {
    let named =
        |p: u32| ["a", "b", "c"].iter().position(|name| dfa.propositions[p as usize] == *name);
    dfa.next(q, |p| letter[named(p).unwrap()])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn automata_read_what_the_definitions_say(text in text(), trace in prop::collection::vec(any::<[bool; 3]>(), 1..8)) {
        let ast = parse::formula(&Source::new("<formula>", text.as_str())).unwrap();
        let ItemKind::Task(_, root) = ast.items()[0].kind else { panic!() };
        let dfa = match read(&text) {
            Ok(compiled) => compiled.automata[0].dfa.clone(),
            Err(errors) => {
                let kind = errors.first().kind().name();
                prop_assert!(["negated-temporal", "unsupported-operator", "budget"].contains(&kind), "{text}: {errors}");
                return Ok(());
            }
        };
        let mut q = 0;
        for length in 1..=trace.len() {
            q = step(&dfa, q, trace[length - 1]);
            prop_assert_eq!(dfa.accepting == Some(q), holds(&ast, root, &trace[..length], 0), "{} up to {}", text, length);
        }
    }
}
