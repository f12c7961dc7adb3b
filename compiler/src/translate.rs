//! Formula to automaton, through decision diagrams: no valuation is ever enumerated.
//!
//! What a formula asks of a trajectory from here on is split into what it asks of this state and
//! what of the rest: its *expansion*, a Boolean function of the propositions (read now) and of
//! *obligations* (subformulas that must hold at the next state, which must exist). One diagram
//! holds both, propositions above obligations, so an expansion cut at the boundary is a transition
//! function whose leaves are Boolean functions of obligations. Those are the automaton's states:
//! ⊤ is acceptance, ⊥ the trap. A state expands by putting the expansion of each of its
//! obligations in its place. Obligations are strong: `X true` is one, and not ⊤.
//!
//! This is the derivative construction of LTLf with a canonical form for positive combinations (as
//! in Spot's finite-trace translation and in "Zhu et al., Symbolic LTLf synthesis, 2017"). Two
//! states with the same expansion read every continuation alike and are one state. The cost
//! is the number of states times the size of their diagrams; a [`Budget`] bounds it. The known
//! weakness is the order of the levels, which is that of first appearance and never searched for.

use std::fmt;

use rustc_hash::FxHashSet;

use crate::arena::Memo;
use crate::bdd::{Bdd, Diagram, Node};
use crate::dfa::{Dfa, State};
use crate::spec::{Formula, FormulaId, Spec};

/// Bounds on the work of a translation. They count, they never look at a clock: the same source
/// always gives the same answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// States of the automaton before minimisation.
    pub states: usize,
    /// Nodes of decision diagrams, a measure of both memory and time.
    pub nodes: usize,
    /// Edges of the minimal automaton, each of which gets a guard where it is written out.
    pub edges: usize,
    /// Products of one guard.
    pub products: usize,
}

impl Budget {
    /// For what becomes Rust: 16,384 states, about a million nodes and 16,384 edges, which is a
    /// second in an unoptimised macro and two megabytes of generated code.
    pub const EMITTED: Self =
        Self { states: 1 << 14, nodes: 1 << 20, edges: 1 << 14, products: 1 << 12 };

    /// For what is only looked at: a million states, fifty million nodes, any number of edges
    /// and 65,536 products of one guard, which is a minute and a few gigabytes.
    pub const SHOWN: Self =
        Self { states: 1_000_000, nodes: 50_000_000, edges: usize::MAX, products: 1 << 16 };
}

impl Default for Budget {
    /// [`Budget::EMITTED`].
    fn default() -> Self {
        Self::EMITTED
    }
}

/// What a [`Budget`] limits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resource {
    /// [`Budget::states`]
    States,
    /// [`Budget::nodes`]
    Nodes,
    /// [`Budget::edges`]
    Edges,
    /// [`Budget::products`]
    Products,
    /// Operators of one formula, as many as a decision diagram has levels: no budget allows more.
    Operators,
}

impl fmt::Display for Resource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::States => "states",
            Self::Nodes => "nodes",
            Self::Edges => "edges",
            Self::Products => "products of one guard",
            Self::Operators => "operators",
        })
    }
}

/// A formula needs more than the [`Budget`] allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exceeded {
    /// What ran out.
    pub what: Resource,
    /// How many were allowed.
    pub limit: usize,
}

/// Translates a formula; the automaton is complete and reachable, but not yet minimal.
///
/// # Errors
/// If the budget does not suffice.
pub fn translate(spec: &Spec, budget: Budget) -> Result<Dfa, Exceeded> {
    let mut translation = Translation::new(spec, budget)?;
    translation.expand_formulas()?;
    translation.explore()
}

struct Translation<'a> {
    spec: &'a Spec,
    budget: Budget,
    /// Expansions, and functions of obligations alone.
    functions: Diagram,
    /// The number of propositions: lower levels are propositions, higher ones obligations.
    propositions: u32,
    /// The level of the obligation that a formula is, if it can be one.
    level: Vec<u32>,
    /// The formula of each obligation, by level above the propositions.
    obligations: Vec<FormulaId>,
    /// What each formula asks of this state and of the rest.
    expansion: Vec<Bdd>,
    /// The expansion of each function of obligations met so far.
    expanded: Memo<Bdd, Bdd>,
    /// The state that an expansion is.
    states: Memo<Bdd, State>,
    /// The expansion of each state, in order of discovery.
    roots: Vec<Bdd>,
    accepting: Option<State>,
    /// The transition function so far.
    transitions: Diagram,
    /// Where each expansion, or part of one above the obligations, went in it.
    targets: Memo<Bdd, Bdd>,
}

impl<'a> Translation<'a> {
    fn new(spec: &'a Spec, budget: Budget) -> Result<Self, Exceeded> {
        let mut translation = Self {
            spec,
            budget,
            functions: Diagram::with_limit(budget.nodes),
            propositions: spec.propositions().len() as u32,
            level: vec![u32::MAX; spec.formulas().len()],
            obligations: Vec::new(),
            expansion: vec![Bdd::FALSE; spec.formulas().len()],
            expanded: Memo::default(),
            states: Memo::default(),
            roots: Vec::new(),
            accepting: None,
            transitions: Diagram::default(),
            targets: Memo::default(),
        };
        translation.number_obligations()?;
        Ok(translation)
    }

    /// Gives a level to every subformula that may be asked of the next state, inner ones first:
    /// a chain of goals then shares the diagrams of what it has already asked.
    fn number_obligations(&mut self) -> Result<(), Exceeded> {
        let reachable = self.spec.reachable();
        let mut asked = vec![false; reachable.len()];
        for (id, formula) in self.spec.formulas().filter(|(id, _)| reachable[id.0 as usize]) {
            match formula {
                Formula::Next(a) => asked[a.0 as usize] = true,
                Formula::Eventually(_) | Formula::Until(..) => asked[id.0 as usize] = true,
                Formula::Then(_, b) => {
                    asked[id.0 as usize] = true;
                    asked[b.0 as usize] = true;
                }
                _ => {}
            }
        }
        for (id, _) in self.spec.formulas().filter(|(id, _)| asked[id.0 as usize]) {
            self.level[id.0 as usize] = self.propositions + self.obligations.len() as u32;
            self.obligations.push(id);
        }
        let levels = self.propositions as usize + self.obligations.len();
        self.check(Resource::Operators, levels, Diagram::MAX_LEVELS as usize)
    }

    fn expand_formulas(&mut self) -> Result<(), Exceeded> {
        let needed = self.needed();
        for (id, formula) in self.spec.formulas().filter(|(id, _)| needed[id.0 as usize]) {
            self.expansion[id.0 as usize] = self.expansion_of(id, formula);
            self.check_nodes()?;
        }
        Ok(())
    }

    /// The formulas whose expansion is asked for by itself: not the inner `&&` of a chain of them.
    fn needed(&self) -> Vec<bool> {
        let mut needed = vec![false; self.spec.formulas().len()];
        needed[self.spec.root().0 as usize] = true;
        for (id, formula) in self.spec.formulas().rev() {
            if needed[id.0 as usize] {
                let operands = match formula {
                    Formula::And(..) | Formula::Or(..) => self.chain(id),
                    _ => formula.operands().collect(),
                };
                operands.iter().for_each(|operand| needed[operand.0 as usize] = true);
            }
        }
        needed
    }

    /// The operands of a chain of one and the same operator, left to right, each once.
    fn chain(&self, root: FormulaId) -> Vec<FormulaId> {
        let conjunction = |id| matches!(self.spec.formula(id), Formula::And(..));
        let disjunction = |id| matches!(self.spec.formula(id), Formula::Or(..));
        let mut seen = FxHashSet::default();
        let mut operands = Vec::new();
        let mut stack = vec![root];
        while let Some(id) = stack.pop() {
            if !seen.insert(id.0) {
                continue;
            }
            let same = if conjunction(root) { conjunction(id) } else { disjunction(id) };
            if same {
                stack.extend(self.spec.formula(id).operands().rev());
            } else {
                operands.push(id);
            }
        }
        operands
    }

    fn expansion_of(&mut self, id: FormulaId, formula: Formula) -> Bdd {
        let of = |this: &Self, a: FormulaId| this.expansion[a.0 as usize];
        match formula {
            Formula::True => Bdd::TRUE,
            Formula::False => Bdd::FALSE,
            Formula::Literal { proposition, negated } => {
                self.functions.literal((proposition, !negated))
            }
            // From the right: what is written later mostly stands lower in the diagram, and each
            // step then touches only the top of what is there.
            Formula::And(..) => self.chain(id).iter().rev().fold(Bdd::TRUE, |rest, &operand| {
                self.functions.and(self.expansion[operand.0 as usize], rest)
            }),
            Formula::Or(..) => self.chain(id).iter().rev().fold(Bdd::FALSE, |rest, &operand| {
                self.functions.or(self.expansion[operand.0 as usize], rest)
            }),
            Formula::Next(a) => self.functions.variable(self.level[a.0 as usize]),
            Formula::Eventually(a) => {
                let again = self.functions.variable(self.level[id.0 as usize]);
                let now = of(self, a);
                self.functions.or(now, again)
            }
            Formula::Until(a, b) => {
                let again = self.functions.variable(self.level[id.0 as usize]);
                let (hold, done) = (of(self, a), of(self, b));
                let later = self.functions.and(hold, again);
                self.functions.or(done, later)
            }
            Formula::Then(a, b) => {
                let again = self.functions.variable(self.level[id.0 as usize]);
                let second = self.functions.variable(self.level[b.0 as usize]);
                let first = of(self, a);
                let first = self.functions.and(first, second);
                self.functions.or(first, again)
            }
        }
    }

    /// Puts the expansion of every obligation of `f` in its place. Functions of obligations are
    /// monotone, so a node is `low ∨ (obligation ∧ high)`.
    fn expand(&mut self, f: Bdd) -> Bdd {
        let Some(Node { level, low, high }) = self.functions.get(f) else { return f };
        if let Some(known) = self.expanded.get(f) {
            return known;
        }
        let (low, high) = (self.expand(low), self.expand(high));
        let due = self.obligations[(level - self.propositions) as usize];
        let due = self.expansion[due.0 as usize];
        let high = self.functions.and(due, high);
        let expansion = self.functions.or(low, high);
        self.expanded.insert(f, expansion);
        expansion
    }

    fn explore(mut self) -> Result<Dfa, Exceeded> {
        let root = self.expansion[self.spec.root().0 as usize];
        if root == Bdd::TRUE {
            self.accepting_state();
        } else {
            self.state(root);
        }
        let mut transitions = Vec::new();
        while let Some(&root) = self.roots.get(transitions.len()) {
            let target = self.target(root);
            transitions.push(target);
            self.check_nodes()?;
            self.check(Resource::States, self.roots.len(), self.budget.states)?;
        }
        Ok(Dfa {
            propositions: self.spec.propositions().to_vec(),
            diagram: self.transitions,
            transitions,
            accepting: self.accepting,
            trap: self.states.get(Bdd::FALSE),
            possible: None,
        })
    }

    /// The transitions of an expansion: its part above the obligations.
    fn target(&mut self, f: Bdd) -> Bdd {
        if let Some(known) = self.targets.get(f) {
            return known;
        }
        let target = match self.functions.get(f) {
            Some(Node { level, low, high }) if level < self.propositions => {
                let (low, high) = (self.target(low), self.target(high));
                self.transitions.node(level, low, high)
            }
            None if f == Bdd::TRUE => Bdd::leaf(self.accepting_state()),
            _ => {
                let expansion = self.expand(f);
                Bdd::leaf(self.state(expansion))
            }
        };
        self.targets.insert(f, target);
        target
    }

    fn accepting_state(&mut self) -> State {
        let fresh = self.roots.len() as State;
        let state = *self.accepting.get_or_insert(fresh);
        if state == fresh {
            self.roots.push(Bdd::TRUE);
        }
        state
    }

    fn state(&mut self, expansion: Bdd) -> State {
        let fresh = self.roots.len() as State;
        let state = self.states.get_or_insert(expansion, fresh);
        if state == fresh {
            self.roots.push(expansion);
        }
        state
    }

    fn check_nodes(&self) -> Result<(), Exceeded> {
        self.check(Resource::Nodes, self.functions.nodes().len(), self.budget.nodes)
    }

    fn check(&self, what: Resource, count: usize, limit: usize) -> Result<(), Exceeded> {
        if count > limit { Err(Exceeded { what, limit }) } else { Ok(()) }
    }
}
