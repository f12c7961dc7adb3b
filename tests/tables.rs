//! Tables from outside are checked: what is wrong is named, and what passes never fails to be read.

use proptest::prelude::*;
use tltl::automaton::{Automaton, Tables, Transitions};
use tltl::robustness::Op;
use tltl::{Acceptor, Formula, Shared, Task};
use tltl_compiler::check;
use tltl_compiler::minimize::minimize;
use tltl_compiler::source::Source;
use tltl_compiler::translate::{Budget, translate};
use tltlc::tables::automaton;

use crate::random::{self, Bytes, Choices as _};

fn compiled(formula: &str) -> Automaton {
    let module = check::formula(&Source::new("formula", formula)).unwrap();
    automaton(&minimize(&translate(&module.tasks[0].spec, Budget::SHOWN).unwrap())).unwrap()
}

/// Of the right kind, but with eleven propositions, which are too many for a dense table.
fn diagram() -> Automaton {
    compiled("a0 T a1 T a2 T a3 T a4 T a5 T a6 T a7 T a8 T a9 T a10")
}

/// Replaces one entry.
fn set<T: Clone>(table: &mut Shared<[T]>, at: usize, value: T) {
    let mut entries = table.to_vec();
    entries[at] = value;
    *table = entries.into();
}

/// Replaces one entry of the table of transitions.
fn set_next(tables: &mut Tables, at: usize, value: u32) {
    match &mut tables.transitions {
        Transitions::Table { next, .. } => set(next, at, value),
        Transitions::Diagram { roots, .. } => set(roots, at, value),
    }
}

/// What a change of tables is refused for.
fn refused(automaton: &Automaton, change: impl FnOnce(&mut Tables)) -> String {
    let mut tables = automaton.tables().clone();
    change(&mut tables);
    Automaton::new(tables).unwrap_err().to_string()
}

#[test]
fn what_is_wrong_in_a_table_is_named() {
    // States: 0 waits, 1 accepts, 2 is the trap.
    let avoid = compiled("!b U a");
    type Change = fn(&mut Tables);
    let cases: [(&str, Change); 16] = [
        ("`states`, entry 0: 0 is not less than 0", |t| t.states = 0),
        ("`accepting`, entry 0: 3 is not less than 3", |t| t.accepting = Some(3)),
        ("`trap`, entry 0: the accepting state is not the trap", |t| t.trap = Some(1)),
        ("`class` has 4 entries, not 8", |t| {
            t.propositions = ["b", "a", "c"].into_iter().map(Shared::from).collect();
        }),
        ("`next`, entry 2: 9 is not less than 3", |t| set_next(t, 2, 9)),
        ("`next` has 9 entries, not 12", |t| match &mut t.transitions {
            Transitions::Table { width, .. } => *width = 4,
            Transitions::Diagram { .. } => unreachable!(),
        }),
        ("`class`, entry 0: 7 is not less than 3", |t| match &mut t.transitions {
            Transitions::Table { class, .. } => set(class, 0, 7),
            Transitions::Diagram { .. } => unreachable!(),
        }),
        ("`edges`, entry 0: offsets begin at 0", |t| set(&mut t.edges, 0, 1)),
        ("`edges`, entry 2: offsets do not fall", |t| set(&mut t.edges, 1, 5)),
        ("`guards`, entry 8: the last offset is the end", |t| {
            t.literals = t.literals.iter().copied().chain([0]).collect();
        }),
        ("`guards`, entry 1: a guard ends with a 0, as its cubes do", |t| {
            set(&mut t.guards, 1, 1);
        }),
        ("`literals`, entry 0: 2 is not less than 2", |t| set(&mut t.literals, 0, 3)),
        (
            "`edges`, entry 0: the targets of a state are the states that it moves to, ascending",
            |t| set(&mut t.targets, 1, 2),
        ),
        ("`edges`, entry 0: the accepting state and the trap have a self-loop only", |t| {
            t.trap = Some(0)
        }),
        ("`distance` has 2 entries, not 3", |t| t.distance = vec![1, 0].into()),
        ("`distance`, entry 0: not the distance to the accepting state", |t| {
            set(&mut t.distance, 0, 2);
        }),
    ];
    for (expected, change) in cases {
        assert_eq!(refused(&avoid, change), expected);
    }
}

#[test]
fn what_is_wrong_in_a_diagram_is_named() {
    let nodes = |tables: &mut Tables, at: usize, node: [u32; 3]| match &mut tables.transitions {
        Transitions::Diagram { nodes, .. } => set(nodes, at, node),
        Transitions::Table { .. } => unreachable!(),
    };
    let sequence = diagram();
    let leaf = Transitions::LEAF;
    let circle = refused(&sequence, |t| nodes(t, 3, [0, leaf, 3]));
    assert_eq!(circle, "`nodes`, entry 3: 3 is not less than 3");
    let state = refused(&sequence, |t| nodes(t, 0, [0, leaf + 12, leaf]));
    assert_eq!(state, "`nodes`, entry 0: 12 is not less than 12");
    let proposition = refused(&sequence, |t| nodes(t, 0, [11, leaf, leaf]));
    assert_eq!(proposition, "`nodes`, entry 0: 11 is not less than 11");
    let root = refused(&sequence, |t| set_next(t, 1, 4_000));
    assert!(root.starts_with("`roots`, entry 1: 4000 is not less than"), "{root}");
}

#[test]
fn formulas_of_other_automata_are_refused() {
    let automaton = compiled("!b U a");
    let other = Formula::new("F c", vec![Op::Is(2), Op::Eventually(0)]).unwrap();
    let error = Task::new("other", other, automaton, ()).unwrap_err();
    assert_eq!(error.to_string(), "`operators`, entry 0: 2 is not less than 2");
}

/// Reads an automaton in every way; nothing may be out of range.
fn read(automaton: &Automaton) {
    let count = automaton.propositions().len();
    for q in 0..automaton.states() {
        for v in 0..1_u32 << count.min(6) {
            let next = automaton.next(q, |i| Ok::<_, ()>(v >> (i % 6) & 1 == 1)).unwrap();
            assert!(automaton.edges_from(q).any(|edge| edge.to == next), "δ is where edges are");
        }
        let guards = automaton.edges_from(q).map(|edge| edge.guard);
        for guard in guards.chain([automaton.progress(q)]) {
            assert!(
                guard.cubes().flatten().all(|p| (1..=count).contains(&(p.unsigned_abs() as usize)))
            );
        }
        assert!(automaton.distance(q).is_none_or(|distance| distance < automaton.states()));
    }
}

/// Changes an entry that `choices` choose, if there is one.
fn alter<T: Copy>(table: &mut Shared<[T]>, choices: &mut Bytes<'_>, by: impl FnOnce(T, u32) -> T) {
    let at = choices.choose(table.len().clamp(1, 250) as u32) as usize;
    if let Some(&old) = table.get(at) {
        set(table, at, by(old, choices.choose(5)));
    }
}

/// Changes one number somewhere by little.
fn change(tables: &mut Tables, choices: &mut Bytes<'_>) {
    let near = |old: u32, by| old.wrapping_add(by).wrapping_sub(2);
    match choices.choose(8) {
        0 => alter(&mut tables.edges, choices, near),
        1 => alter(&mut tables.targets, choices, near),
        2 => alter(&mut tables.guards, choices, near),
        3 => alter(&mut tables.distance, choices, near),
        4 => tables.accepting = Some(choices.choose(9)).filter(|q| *q < 8),
        5 => tables.trap = Some(choices.choose(9)).filter(|q| *q < 8),
        6 => alter(&mut tables.literals, choices, |old, by| old + by as i32 - 2),
        _ => match &mut tables.transitions {
            Transitions::Table { next, .. } => alter(next, choices, near),
            Transitions::Diagram { nodes, roots } => {
                alter(roots, choices, near);
                alter(nodes, choices, |[p, low, high], by| [p + by / 4, near(low, by), high]);
            }
        },
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn changed_tables_are_refused_or_still_an_automaton(
        formula in prop::collection::vec(any::<u8>(), 0..60),
        changes in prop::collection::vec(any::<u8>(), 4..40),
        wide in any::<bool>(),
    ) {
        let automaton = match wide {
            true => diagram(),
            false => compiled(&random::formula(&mut Bytes(&formula), 3, 6)),
        };
        read(&automaton);
        let mut choices = Bytes(&changes);
        let mut tables = automaton.tables().clone();
        for _ in 0..1 + choices.choose(3) {
            change(&mut tables, &mut choices);
        }
        if let Ok(changed) = Automaton::new(tables) {
            read(&changed);
        }
    }
}
