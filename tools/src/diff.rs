//! Compares two automata: whether they have the same meaning, and if not, a shortest trace on which
//! they differ.
//!
//! Propositions of tasks are the same if their definitions are ([`of_definitions`]), those of bare
//! automata if they have the same name ([`diff`]); a proposition of only one side is free in the
//! other. Both automata are brought over the union of the propositions, and the pairs of states that
//! can be reached are searched breadth-first until one letter leads to different verdicts. That pair
//! is the nearest, so its trace is a shortest one.
//!
//! The search visits at most the product of the numbers of states. Hopcroft and Karp's union-find
//! (1971) would visit at most their sum, and would not find a *shortest* trace; automata of tasks
//! are small enough for the product.

mod joint;
mod witness;

use std::fmt;

use rustc_hash::FxHashSet;

use crate::product::{Aligned, Pairs, union};
use crate::trace::{Letter, Trace, first_letters};
use tltl_compiler::arithmetic::possible_conditions;
use tltl_compiler::bdd::{Bdd, Diagram, Node, Operation};
use tltl_compiler::dfa::{Dfa, State};
use tltl_compiler::predicate::{Condition, ConditionId, Module, State as Declared, Task};
use tltl_compiler::proposition::Proposition;

use joint::Joint;
use witness::Witness;

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
        /// For each instant a state of the world with these truth values: the names of what the
        /// predicates read, with their values. Empty where nothing is known of the predicates but
        /// their names.
        states: Vec<Vec<(String, String)>>,
        /// Whether the first accepts it.
        first: bool,
        /// Whether the second accepts it.
        second: bool,
    },
    /// They differ only on traces with truth values for which no state was found: those of this
    /// one, the shortest. Whether a state has them is beyond the arithmetic here.
    Unknown(Trace),
}

impl fmt::Display for Difference {
    /// One line if there is none; else the trace, an instant a line, and both verdicts.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (trace, states, first, second) = match self {
            Self::None => return f.write_str("equal: every trajectory has the same verdict\n"),
            Self::Unknown(trace) => {
                return writeln!(
                    f,
                    "undecided: no state was found for these truth values, and they would tell them \
                     apart\n\n  {trace}"
                );
            }
            Self::Trace { trace, states, first, second } => (trace, states, first, second),
        };
        writeln!(f, "different: this trajectory tells them apart\n")?;
        for (t, letter) in trace.letters.iter().enumerate() {
            let one =
                Trace { propositions: trace.propositions.clone(), letters: vec![letter.clone()] };
            write!(f, "  {t:>3}  {one}")?;
            let state = states.get(t).map(Vec::as_slice).unwrap_or_default();
            let state: Vec<_> =
                state.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            let before = if state.is_empty() { "" } else { "  at " };
            writeln!(f, "{before}{}", state.join(", "))?;
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
/// let Difference::Trace { trace, first, second, .. } = diff(loose.dfa(), strict.dfa()) else {
///     panic!("they differ");
/// };
/// assert_eq!(trace.to_string(), "{b}; {a}");
/// assert_eq!((first, second), (true, false));
/// assert_eq!(diff(loose.dfa(), loose.dfa()), Difference::None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn diff(first: &Dfa, second: &Dfa) -> Difference {
    Search::new([first, second], union(&first.propositions, &second.propositions)).run()
}

/// One side of a comparison.
#[derive(Clone, Copy, Debug)]
pub enum Side<'a> {
    /// A task, whose predicates have definitions, and its automaton.
    Task(&'a Module, &'a Task, &'a Dfa),
    /// An automaton that came without a formula: its propositions are names.
    Automaton(&'a Dfa),
}

impl Side<'_> {
    fn dfa(&self) -> &Dfa {
        match self {
            Self::Task(_, _, dfa) | Self::Automaton(dfa) => dfa,
        }
    }

    /// Whether its source declares what its names mean.
    fn declares(&self) -> bool {
        matches!(self, Self::Task(module, ..) if !matches!(module.state, Declared::Free))
    }

    /// The condition of each proposition in the joint module.
    fn conditions(&self, joint: &mut Joint) -> Vec<ConditionId> {
        match self {
            Self::Task(module, task, _) => joint.task(module, task),
            Self::Automaton(dfa) => {
                dfa.propositions.iter().map(|one| joint.free(&one.name)).collect()
            }
        }
    }
}

/// Compares two tasks, whose predicates are what they are defined as: two versions of a file that
/// give one name two meanings differ, and a name is equal to what it stands for. Letters that no
/// state has are left out of the comparison; the trace has a state for each letter where one is
/// found.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::diff::{Difference, Side, of_definitions};
/// use tltlc::task::TaskFile;
///
/// let file = |far: &str| {
///     let text = format!("state S {{ x: f64 }} predicate far = x > {far} task go = F far");
///     TaskFile::new(Source::new("go.tltl", text), Budget::default()).unwrap()
/// };
/// let (old, new) = (file("2"), file("3"));
/// let [one, two] = [&old, &new].map(|file| {
///     let compiled = file.compiled();
///     Side::Task(&compiled.module, &compiled.module.tasks[0], &compiled.automata[0].dfa)
/// });
/// assert_eq!(of_definitions(one, one), Difference::None);
/// let Difference::Trace { states, first, second, .. } = of_definitions(one, two) else {
///     panic!("they differ");
/// };
/// assert_eq!(states, [[("x".to_owned(), "2.5".to_owned())]]);
/// assert_eq!((first, second), (true, false));
/// ```
#[must_use]
pub fn of_definitions(first: Side<'_>, second: Side<'_>) -> Difference {
    let mut joint = Joint::new();
    // What one source declares is known before the other's names are looked up.
    let conditions = if !first.declares() && second.declares() {
        let second = second.conditions(&mut joint);
        [first.conditions(&mut joint), second]
    } else {
        let first = first.conditions(&mut joint);
        [first, second.conditions(&mut joint)]
    };
    let [one, two] = named([first.dfa(), second.dfa()], &conditions);
    let propositions = union(&one.propositions, &two.propositions);
    let fresh = two.propositions.iter().zip(&conditions[1]);
    let fresh = fresh.filter(|(name, _)| !one.propositions.contains(name)).map(|(_, id)| *id);
    let roots: Vec<ConditionId> = conditions[0].iter().copied().chain(fresh).collect();
    let mut search = Search::new([&one, &two], propositions);
    let letters = possible_conditions(&joint.module, &roots).letters(&mut search.diagram);
    search.possible = search.diagram.and(search.possible, letters);
    let is_defined =
        |id: &ConditionId| !matches!(joint.module.arena.condition(*id), Condition::Free(_));
    let defined: Vec<bool> = roots.iter().map(is_defined).collect();
    match Witness::new(&mut joint, &roots) {
        Ok(witness) => search.with_states(&defined, &witness),
        // Rust code, or parameters without values.
        Err(_) => search.run(),
    }
}

/// The most letters without a state that are left out, one after the other, before the comparison
/// is given up.
const MOST_UNREAL: usize = 64;

/// The automata with propositions of one name where their conditions are one. Where one name has two
/// conditions, the propositions say whose they are.
fn named([first, second]: [&Dfa; 2], conditions: &[Vec<ConditionId>; 2]) -> [Dfa; 2] {
    let [mut one, mut two] = [first, second].map(Dfa::clone);
    let mut taken = vec![false; conditions[0].len()];
    for (mine, condition) in two.propositions.iter_mut().zip(&conditions[1]) {
        let is_it = |&i: &usize| !taken[i] && conditions[0][i] == *condition;
        match (0..taken.len()).find(is_it) {
            Some(same) => {
                taken[same] = true;
                *mine = first.propositions[same].clone();
            }
            None => {
                if let Some(other) = first.propositions.iter().position(|other| other == mine) {
                    one.propositions[other].name = format!("{} (first)", mine.name);
                }
                mine.name = match first.propositions.contains(mine) {
                    true => format!("{} (second)", mine.name),
                    false => mine.name.clone(),
                };
            }
        }
    }
    [one, two]
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
    fn new(sides: [&Dfa; 2], propositions: Vec<Proposition>) -> Self {
        let mut diagram = Diagram::default();
        let sides = sides.map(|dfa| Aligned::new(dfa, &propositions, &mut diagram));
        let possible = diagram.and(sides[0].possible, sides[1].possible);
        Self { propositions, diagram, sides, possible, pairs: Pairs::default() }
    }

    /// The shortest trace for whose letters there are states; letters for which none is found are
    /// left out, by their values of the propositions that are `defined`.
    fn with_states(mut self, defined: &[bool], witness: &Witness) -> Difference {
        let mut unreal = None;
        for _ in 0..MOST_UNREAL {
            let Difference::Trace { trace, first, second, .. } = self.run() else { break };
            let found: Vec<_> = trace.letters.iter().map(|letter| witness.state(letter)).collect();
            match found.iter().position(Option::is_none) {
                Some(none) => self.exclude(&trace.letters[none], defined),
                None => {
                    let states = found.into_iter().flatten().collect();
                    return Difference::Trace { trace, states, first, second };
                }
            }
            unreal.get_or_insert(trace);
        }
        unreal.map_or(Difference::None, Difference::Unknown)
    }

    /// Takes the letters with these values of some propositions for impossible.
    fn exclude(&mut self, letter: &Letter, defined: &[bool]) {
        let others = (0..).zip(letter).zip(defined).filter(|(_, defined)| **defined);
        let other = others.fold(Bdd::FALSE, |other, ((proposition, value), _)| {
            let literal = self.diagram.literal((proposition, !value));
            self.diagram.or(other, literal)
        });
        self.possible = self.diagram.and(self.possible, other);
    }

    /// Searches until one letter from a pair leads to two verdicts, or no new pair is left. `steps`
    /// is the queue as well.
    fn run(&mut self) -> Difference {
        let accepting = [0, 1].map(|side| self.accepting(side));
        let mut steps = vec![Step { pair: [0, 0], before: 0, letter: Letter::new() }];
        // Before the first letter nothing has been read: the pair of initial states is not marked as
        // met, so that it counts if a letter leads back to it.
        let mut met = FxHashSet::default();
        let mut at = 0;
        while let Some(&Step { pair: [p, q], .. }) = steps.get(at) {
            let verdicts = [accepting[0][p as usize], accepting[1][q as usize]];
            if let Some((letter, [first, second])) = self.parting(verdicts) {
                let mut letters = letters(&steps, at);
                letters.push(letter);
                let trace = Trace { propositions: self.propositions.clone(), letters };
                return Difference::Trace { trace, states: Vec::new(), first, second };
            }
            for (pair, letter) in self.successors([p, q]) {
                if met.insert(pair) {
                    steps.push(Step { pair, before: at, letter });
                }
            }
            at += 1;
        }
        Difference::None
    }

    /// For each state of a side the letters by which it accepts.
    fn accepting(&mut self, side: usize) -> Vec<Bdd> {
        let Aligned { transitions, accepting, .. } = &self.sides[side];
        let order = self.diagram.postorder(transitions);
        let is_it = |leaf| if Some(leaf) == *accepting { Bdd::TRUE } else { Bdd::FALSE };
        let source = self.diagram.clone();
        let images = source.fold(&order, &is_it, &mut |Node { level, low, high }| {
            self.diagram.node(level, low, high)
        });
        transitions.iter().map(|root| images.of(*root)).collect()
    }

    /// The first letter that leads to two verdicts, and the verdicts.
    fn parting(&mut self, [first, second]: [Bdd; 2]) -> Option<(Letter, [bool; 2])> {
        let both = Operation::new(self.propositions.len() as u32 + 1);
        let verdicts = self.diagram.apply(both, first, second, &mut |_, first, second| {
            Some(Bdd::leaf(first.value()? + 2 * second.value()?))
        });
        let found = first_letters(&self.diagram, self.propositions.len(), verdicts, self.possible);
        let (verdicts, letter) =
            found.into_iter().find(|(verdicts, _)| matches!(verdicts, 1 | 2))?;
        Some((letter, [verdicts == 1, verdicts == 2]))
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

/// The letters that lead to a step.
fn letters(steps: &[Step], mut at: usize) -> Vec<Letter> {
    let mut letters = Vec::new();
    while at > 0 {
        letters.push(steps[at].letter.clone());
        at = steps[at].before;
    }
    letters.reverse();
    letters
}
