//! Compares two automata: whether they have the same meaning, and if not, a shortest trace on which
//! they differ.
//!
//! Propositions are the same if they have the same name; a proposition of only one automaton is
//! free in the other. Both automata are brought over the union of the propositions, and the pairs
//! of states that can be reached are searched breadth-first until the verdicts of a pair differ.
//! That pair is the nearest, so its trace is a shortest one.
//!
//! The search visits at most the product of the numbers of states. Hopcroft and Karp's union-find
//! (1971) would visit at most their sum, and would not find a *shortest* trace; automata of tasks
//! are small enough for the product.

use std::fmt;

use rustc_hash::FxHashSet;

use crate::product::{Aligned, Pairs, union};
use crate::trace::{Letter, Trace, first_letters};
use tltl_compiler::bdd::{Bdd, Diagram, Operation};
use tltl_compiler::dfa::{Dfa, State};
use tltl_compiler::proposition::Proposition;

/// The result of a comparison.
///
/// It prints one line if the automata are equal; else the trace, an instant a line, and both
/// verdicts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// Every trace has the same verdict in both.
    None,
    /// A trace tells them apart.
    Trace {
        /// A shortest such trace, over the propositions of both.
        trace: Trace,
        /// Whether the first accepts it.
        first: bool,
        /// Whether the second accepts it.
        second: bool,
    },
}

impl fmt::Display for Difference {
    /// One line if there is none; else the trace, an instant a line, and both verdicts.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Trace { trace, first, second } = self else {
            return f.write_str("equal: every trajectory has the same verdict\n");
        };
        writeln!(f, "different: this trajectory tells them apart\n")?;
        for (t, letter) in trace.letters.iter().enumerate() {
            let one =
                Trace { propositions: trace.propositions.clone(), letters: vec![letter.clone()] };
            writeln!(f, "  {t:>3}  {one}")?;
        }
        let verdict = |accepts: bool| if accepts { "satisfied" } else { "not satisfied" };
        writeln!(f, "\nfirst:  {}\nsecond: {}", verdict(*first), verdict(*second))
    }
}

/// Compares two automata. Letters that arithmetic excludes in one of them are left out of the
/// comparison.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::diff::{Difference, diff};
/// use tltlc::task::compile;
///
/// let [loose, strict] = ["F a && F b", "F (a && b)"].map(|f| compile(f, Budget::default()));
/// let (loose, strict) = (loose?, strict?);
/// let Difference::Trace { trace, first, second } = diff(loose.dfa(), strict.dfa()) else {
///     panic!("they differ");
/// };
/// assert_eq!(trace.to_string(), "{b}; {a}");
/// assert_eq!((first, second), (true, false));
/// assert_eq!(diff(loose.dfa(), loose.dfa()), Difference::None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn diff(first: &Dfa, second: &Dfa) -> Difference {
    let propositions = union(&first.propositions, &second.propositions);
    let mut diagram = Diagram::default();
    let sides = [first, second].map(|dfa| Aligned::new(dfa, &propositions, &mut diagram));
    let possible = diagram.and(sides[0].possible, sides[1].possible);
    let pairs = Pairs::default();
    Search { propositions, diagram, sides, possible, pairs }.run()
}

/// The breadth-first search over pairs of states, one of each automaton.
struct Search {
    propositions: Vec<Proposition>,
    diagram: Diagram,
    sides: [Aligned; 2],
    /// The letters that can occur in both automata.
    possible: Bdd,
    pairs: Pairs,
}

/// A pair of states that was met, the index of the step before it, and the letter between them.
struct Step {
    pair: [State; 2],
    before: usize,
    letter: Letter,
}

impl Search {
    /// Searches until two verdicts differ, or no new pair is left. `steps` is the queue as well.
    fn run(mut self) -> Difference {
        let mut steps = vec![Step { pair: [0, 0], before: 0, letter: Letter::new() }];
        // Before the first letter nothing has been read, and the verdict of the empty trace does
        // not count: the pair of initial states is not marked as met, so that it counts if a letter
        // leads back to it.
        let mut met = FxHashSet::default();
        let mut at = 0;
        while let Some(&Step { pair, .. }) = steps.get(at) {
            for (pair, letter) in self.successors(pair) {
                if !met.insert(pair) {
                    continue;
                }
                steps.push(Step { pair, before: at, letter });
                let [first, second] = [0, 1].map(|i| self.sides[i].accepting == Some(pair[i]));
                if first != second {
                    let trace = Trace { propositions: self.propositions, letters: letters(&steps) };
                    return Difference::Trace { trace, first, second };
                }
            }
            at += 1;
        }
        Difference::None
    }

    /// The pairs that follow a pair, each with the first letter that leads there.
    fn successors(&mut self, [p, q]: [State; 2]) -> Vec<([State; 2], Letter)> {
        let width = self.propositions.len();
        let [a, b] = &self.sides;
        let (f, g) = (a.transitions[p as usize], b.transitions[q as usize]);
        let pairing = Operation::new(width as u32);
        let moves = self.diagram.apply(pairing, f, g, &mut |_, f, g| {
            Some(Bdd::leaf(self.pairs.number([f.value()?, g.value()?])))
        });
        let moves = first_letters(&self.diagram, width, moves, self.possible);
        moves.into_iter().map(|(pair, letter)| (self.pairs.get(pair), letter)).collect()
    }
}

/// The letters that lead to the last step.
fn letters(steps: &[Step]) -> Vec<Letter> {
    let mut letters = Vec::new();
    let mut at = steps.len() - 1;
    while at > 0 {
        letters.push(steps[at].letter.clone());
        at = steps[at].before;
    }
    letters.reverse();
    letters
}
