//! Many moves in one call are the same moves one by one.

use proptest::prelude::*;
use tltl::Acceptor;
use tltl::automaton::{Automaton, Transitions};
use tltl_compiler::translate::Budget;
use tltlc::task;

use crate::random::{self, Bytes, Choices};

/// Every state under every letter, and some trajectories, in both forms of letters.
fn agree(automaton: &Automaton, choices: &mut impl Choices) -> Result<(), TestCaseError> {
    let count = automaton.propositions().len();
    let mut letter = || (0..64).fold(0, |bits, _| bits << 1 | u64::from(choices.choose(2)));
    let letters: Vec<u64> = (0..300).map(|_| letter()).collect();
    let labels: Vec<bool> =
        letters.iter().flat_map(|bits| (0..count).map(move |i| bits >> i & 1 == 1)).collect();
    let next = |q: u32, bits: u64| automaton.next(q, |i| Ok::<_, ()>(bits >> i & 1 == 1)).unwrap();

    let before: Vec<u32> = (0..300).map(|row| row % automaton.states()).collect();
    let expected: Vec<u32> = before.iter().zip(&letters).map(|(&q, &bits)| next(q, bits)).collect();
    let (mut by_bits, mut by_labels) = (before.clone(), before.clone());
    automaton.step_batch(&mut by_bits, &letters[..]);
    automaton.step_batch(&mut by_labels, &labels[..]);
    prop_assert_eq!(&by_bits, &expected);
    prop_assert_eq!(&by_labels, &expected);
    if let Some(bytes) = automaton.by_bytes() {
        let (mut by_bits, mut by_labels) = (before.clone(), before);
        bytes.step_batch(&mut by_bits, &letters[..]);
        bytes.step_batch(&mut by_labels, &labels[..]);
        prop_assert_eq!(&by_bits, &expected);
        prop_assert_eq!(&by_labels, &expected);
    }

    let follow = |q: &mut u32, &bits: &u64| {
        *q = next(*q, bits);
        Some(*q)
    };
    for first in 0..automaton.states().min(9) {
        let expected: Vec<u32> = letters[..40].iter().scan(first, follow).collect();
        let (mut by_bits, mut by_labels) = ([0; 40], [0; 40]);
        let last = automaton.run(first, &letters[..40], &mut by_bits);
        prop_assert_eq!(Some(&last), expected.last());
        automaton.run(first, &labels[..40 * count], &mut by_labels);
        prop_assert_eq!(&by_bits[..], &expected);
        prop_assert_eq!(&by_labels[..], &expected);
    }
    Ok(())
}

fn automaton(formula: &str) -> Automaton {
    task::compile(formula, Budget::default()).unwrap().automaton().clone()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn tables(bytes in prop::collection::vec(any::<u8>(), 0..100), seed in any::<u64>()) {
        let mut choices = Bytes(&bytes);
        let names = 1 + choices.choose(5);
        let operators = choices.choose(10);
        let automaton = automaton(&random::formula(&mut choices, names, operators));
        // A few of these formulas need so many states that a diagram is smaller.
        prop_assume!(matches!(automaton.tables().transitions, Transitions::Table { .. }));
        agree(&automaton, &mut random::Seeded(seed))?;
    }
}

#[test]
fn diagrams() {
    let order = "a T b T c T d T e T f && F g && (!h U i) && F (j || k && l)";
    let wide: Vec<_> = (0..64).map(|i| format!("p{i}")).collect();
    for formula in [order, &wide.join(" T ")] {
        let automaton = automaton(formula);
        let is_diagram = matches!(automaton.tables().transitions, Transitions::Diagram { .. });
        assert!(is_diagram && automaton.by_bytes().is_some(), "{formula}");
        (0..40).for_each(|seed| agree(&automaton, &mut random::Seeded(seed)).unwrap());
    }
}

#[test]
fn nothing_is_moved_by_nothing() {
    let automaton = automaton("a T b");
    automaton.step_batch(&mut [], &[0_u64; 0][..]);
    assert_eq!(automaton.run(1, &[false; 0][..], &mut []), 1);
    // There is one letter where there are no propositions.
    let always = task::compile("X X true", Budget::default()).unwrap();
    let mut states = [0; 3];
    always.automaton().run(0, &[][..] as &[bool], &mut states);
    assert_eq!(states, [1, 2, 3]);
    assert!(always.is_accepting(3));
}

#[test]
#[should_panic(expected = "a label for each proposition")]
fn labels_of_another_automaton_are_refused() {
    automaton("a T b").step_batch(&mut [0, 0], &[true; 3][..]);
}
