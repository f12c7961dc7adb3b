//! Which letters can occur: how arithmetic ties the predicates of a task.
//!
//! Two predicates are not free propositions when arithmetic ties them: no state has both `x < 3`
//! and `x > 5`. Without this knowledge an automaton has edges that no trajectory takes, states that
//! nothing reaches, and a task that cannot be satisfied looks as if it could.
//!
//! # Method
//!
//! Every comparison is brought into the form *linear form ⋚ threshold*. The thresholds of one form
//! cut the number line into cells, and every state is in exactly one of them. Cells without a value
//! are dropped: an integer has none between two neighbours, and a field none outside its type. A
//! decision diagram with the propositions above the cuts relates the two; a valuation is possible
//! iff the diagram below it is not empty.
//!
//! Forms that share variables (`x < 1`, `y < 1`, `x + y > 2`) are related by deciding which
//! combinations of their cells have a real point, see [`linear`](crate::linear). This is the eager
//! way of SMT with difference and linear constraints: predicates are few, and all their relations
//! are wanted, not one model.
//!
//! # What it never does
//!
//! All arithmetic is exact and rational, on the numbers that the source writes. Non-linear terms,
//! and sums of very many, count as variables of their own, and predicates too entangled to relate
//! within [`NODE_LIMIT`] nodes or [`WORK_LIMIT`] coefficients count as independent. That is sound:
//! it leaves letters possible that are not, and never removes one that is. Integers are relaxed to
//! reals across forms, so `2*x == 2*y + 1` counts as possible.
//!
//! ```
//! use tltl_compiler::{arithmetic, check, source::Source};
//!
//! let module = check::formula(&Source::new("formula", "F (x < 3) && F (x > 5)"))?;
//! let possible = arithmetic::possible(&module, &module.tasks[0]);
//! assert!(!possible.all());
//! // No state is below 3 and above 5; each alone can be.
//! assert!(possible.excludes(&[(0, true), (1, true)]));
//! assert_eq!(possible.values(), [(true, true), (true, true)]);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

mod form;
mod relation;

use crate::bdd::{Bdd, Diagram, Node};
use crate::dfa::Dfa;
use crate::predicate::{ConditionId, Module, PredicateId, Task};

use relation::Analysis;

/// Predicates whose relation needs more nodes than this count as independent. An unoptimized macro
/// makes so many in a second.
pub const NODE_LIMIT: usize = 1 << 17;
/// Linear forms count as independent if relating them takes more work than this: coefficients that
/// are looked at while their systems of inequalities are decided. An unoptimized macro looks at a
/// million in a fifth of a second.
pub const WORK_LIMIT: usize = 1 << 20;

/// The letters of a task that can occur: a Boolean function of its propositions.
///
/// Invariant: at least one letter can occur, since every component of related predicates has a
/// state.
///
/// ```
/// use tltl_compiler::{arithmetic, check, source::Source};
///
/// let module = check::formula(&Source::new("formula", "F (x < 1 && x < 3)"))?;
/// let possible = arithmetic::possible(&module, &module.tasks[0]);
/// // Below 1 and not below 3: no number is. Of the four letters three are left.
/// assert!(possible.excludes(&[(0, true), (1, false)]) && !possible.all());
/// assert!(!possible.excludes(&[(0, false), (1, true)]));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
pub struct Possible {
    propositions: usize,
    diagram: Diagram,
    letters: Bdd,
}

/// The letters that can occur: those valuations of the task's propositions that some state has.
#[must_use]
pub fn possible(module: &Module, task: &Task) -> Possible {
    let condition = |id: &PredicateId| module.predicates[id.0 as usize].condition;
    let roots: Vec<ConditionId> = task.predicates.iter().map(condition).collect();
    possible_conditions(module, &roots)
}

/// The valuations of some conditions, taken as propositions in this order, that some state has.
/// Conditions that share no variable are related apart, and the results conjoined.
///
/// ```
/// use tltl_compiler::{arithmetic, check, source::Source};
///
/// let text = "state S { x: i8 }\npredicate p = x > 3\npredicate q = x < 4\ntask t = F (p && q)\n";
/// let module = check::file(&Source::new("s.tltl", text))?;
/// let conditions: Vec<_> = module.predicates.iter().map(|known| known.condition).collect();
/// let possible = arithmetic::possible_conditions(&module, &conditions);
/// // No integer is between 3 and 4.
/// assert!(possible.excludes(&[(0, true), (1, true)]));
/// assert!(possible.excludes(&[(0, false), (1, false)]));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[must_use]
pub fn possible_conditions(module: &Module, roots: &[ConditionId]) -> Possible {
    let analysis = Analysis::new(module, roots);
    let (propositions, diagram) = (roots.len(), Diagram::default());
    let mut possible = Possible { propositions, diagram, letters: Bdd::TRUE };
    for component in analysis.components(roots) {
        if let Some(letters) = analysis.relate(roots, &component, &mut possible.diagram) {
            possible.letters = possible.diagram.and(possible.letters, letters);
        }
    }
    possible
}

impl Possible {
    /// Whether every letter can occur.
    #[must_use]
    pub fn all(&self) -> bool {
        self.letters == Bdd::TRUE
    }

    /// The letters as a function in another diagram, whose level i is proposition i.
    ///
    /// ```
    /// use tltl_compiler::{arithmetic, bdd::Diagram, check, source::Source};
    ///
    /// let module = check::formula(&Source::new("formula", "F (x < 3) && F (x > 5)"))?;
    /// let possible = arithmetic::possible(&module, &module.tasks[0]);
    /// let mut diagram = Diagram::default();
    /// let letters = possible.letters(&mut diagram);
    /// assert_eq!(diagram.evaluate(letters, &|_| true), 0, "not both");
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    #[must_use]
    pub fn letters(&self, diagram: &mut Diagram) -> Bdd {
        diagram.import(&self.diagram, self.letters)
    }

    /// For each proposition whether it can be true, and whether it can be false. Linear in the
    /// diagram.
    #[must_use]
    pub fn values(&self) -> Vec<(bool, bool)> {
        // Every path leads to ⊤ and takes some letters that can occur: a proposition that it skips
        // has both values. Skips are counted where they begin and taken back where they end.
        let mut skips = vec![0_isize; self.propositions + 1];
        let mut values = vec![(false, false); self.propositions];
        let mut skip = |from: usize, to: Bdd| {
            let node = self.diagram.get(to);
            skips[from] += 1;
            skips[node.map_or(self.propositions, |node| node.level as usize)] -= 1;
        };
        skip(0, self.letters);
        for place in self.diagram.postorder(&[self.letters]) {
            let Node { level, low, high } = self.diagram.nodes()[place as usize];
            let level = level as usize;
            values[level].0 |= high != Bdd::FALSE;
            values[level].1 |= low != Bdd::FALSE;
            [low, high]
                .into_iter()
                .filter(|&to| to != Bdd::FALSE)
                .for_each(|to| skip(level + 1, to));
        }
        let mut open = 0;
        for (values, skips) in values.iter_mut().zip(skips) {
            open += skips;
            *values = if open > 0 { (true, true) } else { *values };
        }
        values
    }

    /// Whether no possible letter has all of these values. Linear in the diagram.
    #[must_use]
    pub fn excludes(&self, literals: &[(u32, bool)]) -> bool {
        let mut fixed = vec![None; self.propositions];
        literals.iter().for_each(|&(proposition, value)| fixed[proposition as usize] = Some(value));
        let mut seen = vec![false; self.diagram.nodes().len()];
        let mut open = vec![self.letters];
        while let Some(f) = open.pop() {
            match f.index() {
                None if f == Bdd::TRUE => return false,
                Some(place) if !std::mem::replace(&mut seen[place as usize], true) => {
                    let Node { level, low, high } = self.diagram.nodes()[place as usize];
                    let value = fixed[level as usize];
                    open.extend((value != Some(true)).then_some(low));
                    open.extend((value != Some(false)).then_some(high));
                }
                _ => {}
            }
        }
        true
    }

    /// The automaton without the edges that only impossible letters take.
    ///
    /// States and the accepting state stay; [`minimize`](crate::minimize::minimize) then merges
    /// states that no possible letter tells apart. The result is minimal over the possible letters,
    /// because *constrain* makes the diagrams of two states equal iff they agree on all of those.
    ///
    /// ```
    /// use tltl_compiler::{arithmetic, check, minimize::minimize, source::Source};
    /// use tltl_compiler::translate::{Budget, translate};
    ///
    /// let module = check::formula(&Source::new("formula", "F (x < 1 && x > 3) || F (x < 0)"))?;
    /// let task = &module.tasks[0];
    /// let dfa = minimize(&translate(&task.spec, Budget::EMITTED).unwrap());
    /// let restricted = minimize(&arithmetic::possible(&module, task).restrict(&dfa));
    /// assert_eq!((dfa.len(), restricted.len()), (2, 2));
    /// assert!(restricted.diagram.nodes().len() < dfa.diagram.nodes().len());
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    #[must_use]
    pub fn restrict(&self, dfa: &Dfa) -> Dfa {
        let mut diagram = dfa.diagram.clone();
        let letters = self.letters(&mut diagram);
        let roots: Vec<Bdd> =
            dfa.transitions.iter().map(|&root| diagram.constrain(root, letters)).collect();
        let (diagram, transitions) = diagram.map_leaves(&roots, &Bdd::leaf);
        let mut restricted = Dfa {
            propositions: dfa.propositions.clone(),
            diagram,
            transitions,
            accepting: dfa.accepting,
            trap: dfa.trap,
            possible: None,
        };
        self.settle_initial(&mut restricted);
        restricted
    }

    /// Lets the initial state accept if every possible letter leads it to acceptance: a trajectory
    /// has at least one letter.
    fn settle_initial(&self, dfa: &mut Dfa) {
        if let Some(accepting) = dfa.accepting
            && dfa.transitions[0] == Bdd::leaf(accepting)
        {
            dfa.transitions[0] = Bdd::leaf(0);
            dfa.accepting = Some(0);
        }
    }

    /// Writes the possible letters into an automaton, where its guards use them.
    pub fn attach(&self, dfa: &mut Dfa) {
        if !self.all() {
            dfa.possible = Some(dfa.diagram.import(&self.diagram, self.letters));
        }
    }
}
