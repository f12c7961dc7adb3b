//! Formula to automaton, through decision diagrams: no valuation is ever enumerated.
//!
//! # Method
//!
//! The demand that a formula makes on a trajectory from here on splits into a demand on this state
//! and a demand on the rest. Its *expansion* is a Boolean function of both: of the propositions
//! (read now) and of *obligations* (subformulas that must hold at the next state, which must
//! exist). One diagram holds both, propositions above obligations. So an expansion that is cut at
//! the boundary is a transition function whose leaves are Boolean functions of obligations, and
//! these functions are the states of the automaton: ⊤ is acceptance, ⊥ the trap. A state expands by
//! putting the expansion of each of its obligations in its place. Obligations are strong: `X true`
//! is one, and not ⊤.
//!
//! With φ′ for the obligation to satisfy φ at the next state:
//!
//! ```text
//! exp(Xφ)    = φ′
//! exp(Fφ)    = exp(φ) ∨ (Fφ)′
//! exp(φ U ψ) = exp(ψ) ∨ exp(φ) ∧ (φ U ψ)′
//! exp(φ T ψ) = exp(φ) ∧ (Fψ)′ ∨ (φ T ψ)′
//! ```
//!
//! An operator with a bound is due with one step less, and is its operand when no step is left:
//!
//! ```text
//! exp(X[n] φ)     = (X[n-1] φ)′
//! exp(F[0,n] φ)   = exp(φ) ∨ (F[0,n-1] φ)′
//! exp(G[0,n] φ)   = exp(φ) ∧ (G[0,n-1] φ)′
//! exp(φ U[0,n] ψ) = exp(ψ) ∨ exp(φ) ∧ (φ U[0,n-1] ψ)′
//! ```
//!
//! No bound is written out: the obligations of an operator are a range of levels, and only those
//! that some state has are ever expanded (`obligation`).
//!
//! # Sources
//!
//! LTL on finite traces and its automata: De Giacomo and Vardi, "Linear Temporal Logic and Linear
//! Dynamic Logic on Finite Traces" (2013). The construction is the derivative construction
//! (Brzozowski, 1964) with a canonical form for positive combinations. Decision diagrams for it:
//! Zhu, Tabajara, Li, Pu and Vardi, "Symbolic LTLf Synthesis" (2017); multi-terminal ones, with
//! states as leaves: Duret-Lutz and others, "Engineering an LTLf Synthesis Tool" (2025), in Spot.
//!
//! # Why this way
//!
//! A formula in the co-safe fragment has no negated temporal operator, so all functions of
//! obligations are monotone: expanding a state needs ∧ and ∨ only. States that have the same
//! expansion read every continuation alike and are one state; this merges most of what
//! [`minimize`](crate::minimize::minimize) would merge later.
//!
//! # Cost and weakness
//!
//! The cost is the number of states times the size of their diagrams, and both can be exponential
//! in the formula: n unordered goals have 2^n states, whatever the method. A bound costs what its
//! states cost: `F[0,10000] a`, 10,003 states, takes 4 ms. A [`Budget`] bounds it.
//! The known weakness is the order of the levels: that of first appearance, never searched for.
//! Nothing here looks at a clock.
//!
//! ```
//! use tltl_compiler::{check, source::Source, translate::{Budget, translate}};
//!
//! let module = check::formula(&Source::new("formula", "a T b"))?;
//! let dfa = translate(&module.tasks[0].spec, Budget::EMITTED).unwrap();
//! assert_eq!((dfa.len(), dfa.trap), (3, None));
//! // `a` now is the first step, `b` at a later state the second.
//! let first = dfa.next(0, |proposition| proposition == 0);
//! let second = dfa.next(first, |proposition| proposition == 1);
//! assert_eq!(Some(second), dfa.accepting);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

mod obligation;

use std::fmt;

use crate::arena::{Memo, Seen};
use crate::bdd::{Bdd, Diagram, Node};
use crate::dfa::{Dfa, State};
use crate::spec::{Formula, FormulaId, Spec};

use obligation::Obligations;

/// Bounds on the work of a translation. They count things and never look at a clock: the same
/// source always gives the same answer, on every machine.
///
/// ```
/// use tltl_compiler::{check, source::Source, translate::{Budget, Resource, translate}};
///
/// let goals: Vec<String> = (0..17).map(|i| format!("F g{i}")).collect();
/// let module = check::formula(&Source::new("formula", goals.join(" && ")))?;
/// // 2^17 states, and the first one leads to all of them: it is not even left.
/// let exceeded = translate(&module.tasks[0].spec, Budget::EMITTED).unwrap_err();
/// assert_eq!((exceeded.what, exceeded.limit), (Resource::States, 1 << 14));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// States of the automaton before minimization.
    pub states: usize,
    /// Nodes of decision diagrams, and a quarter of the steps of the operations that make them: a
    /// measure of both memory and time.
    pub nodes: usize,
    /// Edges of the minimal automaton. Each gets a guard where the automaton is written out.
    pub edges: usize,
    /// Products (cubes) of one guard. A guard can have exponentially more products than its diagram
    /// has nodes.
    pub products: usize,
}

impl Budget {
    /// For automata that become Rust: 16,384 states, about a million nodes and 32,768 edges, two for
    /// each state: a state of `F[0,n] a` waits or accepts. At these limits an unoptimized macro runs
    /// for about a second and writes about two megabytes of code.
    pub const EMITTED: Self =
        Self { states: 1 << 14, nodes: 1 << 20, edges: 1 << 15, products: 1 << 12 };

    /// For automata that are only looked at: 262,144 states, four million nodes, any number of
    /// edges and 65,536 products of one guard. At these limits a translation takes a second or two
    /// and 0.7 GB; fourteen unordered goals are within them.
    pub const SHOWN: Self =
        Self { states: 1 << 18, nodes: 1 << 22, edges: usize::MAX, products: 1 << 16 };
}

impl Default for Budget {
    /// [`Budget::EMITTED`].
    fn default() -> Self {
        Self::EMITTED
    }
}

/// A resource that a [`Budget`] limits. Its text is that of messages.
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
    /// Operators of one formula, or obligations of one state. A path in a decision diagram has at
    /// most [`Diagram::MAX_LEVELS`] levels, so no budget allows more.
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
    /// The resource that ran out.
    pub what: Resource,
    /// The limit that was passed.
    pub limit: usize,
}

/// Translates a formula. The automaton is complete and reachable, with at most one accepting state
/// and at most one trap, but not yet minimal.
///
/// ```
/// use tltl_compiler::{check, minimize::minimize, source::Source, translate::{Budget, translate}};
///
/// let module = check::formula(&Source::new("formula", "X true"))?;
/// let dfa = translate(&module.tasks[0].spec, Budget::default()).unwrap();
/// // The first state is read, then any second one.
/// let second = dfa.next(0, |_| false);
/// assert_eq!(Some(dfa.next(second, |_| false)), dfa.accepting);
/// assert_eq!(minimize(&dfa).len(), 3);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// If the budget does not suffice. The work done until then is bounded by the budget.
pub fn translate(spec: &Spec, budget: Budget) -> Result<Dfa, Exceeded> {
    let mut translation = Translation::new(spec, budget)?;
    translation.expand_formulas()?;
    let known = translation.states_of_bound().unwrap_or(0);
    let known = usize::try_from(known).unwrap_or(usize::MAX);
    translation.check(Resource::States, known, budget.states)?;
    translation.explore()
}

/// The number of states of the minimal automaton, without the automaton: `None` unless the formula
/// is one operator with a bound over conditions on one state, behind a delay or not.
///
/// ```
/// use tltl_compiler::{source::Span, spec::Spec, translate::{Budget, states_of_bound, translate}};
///
/// let mut spec = Spec::new(vec!["a".into()]);
/// let at = Span::default();
/// let a = spec.literal(0, false, at);
/// let soon = spec.eventually_in(5..=100_000, a, at);
/// spec.set_root(soon);
/// assert_eq!(states_of_bound(&spec, Budget::EMITTED), Some(100_003));
/// assert!(translate(&spec, Budget::EMITTED).is_err());
/// ```
#[must_use]
pub fn states_of_bound(spec: &Spec, budget: Budget) -> Option<u64> {
    let mut translation = Translation::new(spec, budget).ok()?;
    translation.expand_formulas().ok()?;
    translation.states_of_bound()
}

/// The state of a translation. Two diagrams grow: `functions`, over propositions and obligations,
/// and `transitions`, over propositions alone with states as leaves.
struct Translation<'a> {
    spec: &'a Spec,
    budget: Budget,
    /// Expansions, and functions of obligations alone. Its size is what the budget of nodes bounds.
    functions: Diagram,
    /// The number of propositions: lower levels are propositions, higher ones obligations.
    propositions: u32,
    obligations: Obligations,
    /// The expansion of each formula; [`Bdd::FALSE`] for those that are not [needed](Self::needed).
    expansion: Vec<Bdd>,
    /// The expansion of each function of obligations met so far. Shared by all states: a chain of
    /// goals expands each of its tails once.
    expanded: Memo<Bdd, Bdd>,
    /// The number of each state, by its expansion rather than by its function of obligations: two
    /// functions with one expansion are one state.
    states: Memo<Bdd, State>,
    /// The expansion of each state, in order of discovery. States from `transitions.len()` on in
    /// [`explore`](Self::explore) are not explored yet.
    roots: Vec<Bdd>,
    accepting: Option<State>,
    /// The transition function so far.
    transitions: Diagram,
    /// The image in `transitions` of each expansion, and of each part of one above the obligations.
    targets: Memo<Bdd, Bdd>,
}

impl<'a> Translation<'a> {
    /// A translation with nothing done but the numbering of obligations.
    ///
    /// # Errors
    /// If there are more levels than a diagram may have.
    fn new(spec: &'a Spec, budget: Budget) -> Result<Self, Exceeded> {
        let obligations = Obligations::new(spec)
            .ok_or(Exceeded { what: Resource::States, limit: budget.states })?;
        let operators = obligations.operators();
        let translation = Self {
            spec,
            budget,
            functions: Diagram::with_limit(budget.nodes).chained(obligations.chains()),
            propositions: spec.propositions().len() as u32,
            obligations,
            expansion: vec![Bdd::FALSE; spec.formulas().len()],
            expanded: Memo::default(),
            states: Memo::default(),
            roots: Vec::new(),
            accepting: None,
            transitions: Diagram::default(),
            targets: Memo::default(),
        };
        translation.check(Resource::Operators, operators, Diagram::MAX_LEVELS as usize)?;
        Ok(translation)
    }

    /// Computes the expansions of all needed formulas, operands first.
    fn expand_formulas(&mut self) -> Result<(), Exceeded> {
        let needed = self.needed();
        for (id, formula) in self.spec.formulas().filter(|(id, _)| needed[id.0 as usize]) {
            self.expansion[id.0 as usize] = match formula {
                Formula::And(..) | Formula::Or(..) => self.expansion_of_chain(id, formula)?,
                _ => self.expansion_of(id, formula),
            };
            self.check_nodes()?;
        }
        Ok(())
    }

    /// The expansion of a chain of `&&` or `||`.
    ///
    /// From the right: later operands mostly stand lower in the diagram, and each step then touches
    /// only the top of the result so far. A result that leads to more demands than there may be
    /// states is not carried on; they are counted as often as the diagram has doubled.
    fn expansion_of_chain(&mut self, id: FormulaId, formula: Formula) -> Result<Bdd, Exceeded> {
        let is_conjunction = matches!(formula, Formula::And(..));
        let mut rest = if is_conjunction { Bdd::TRUE } else { Bdd::FALSE };
        let mut counted = self.functions.nodes().len();
        for &operand in self.chain(id).iter().rev() {
            let operand = self.expansion[operand.0 as usize];
            rest = match is_conjunction {
                true => self.functions.and(operand, rest),
                false => self.functions.or(operand, rest),
            };
            if self.functions.nodes().len() / 2 > counted {
                counted = self.functions.nodes().len();
                self.check_demands(rest)?;
            }
        }
        Ok(rest)
    }

    /// The formulas whose expansion is used by itself. The inner `&&` of a chain of them is not: a
    /// chain is conjoined from the right, and the expansions of its prefixes would be work for
    /// nothing.
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

    /// The operands of a chain of one and the same operator, left to right, each once. Operators
    /// are shared, so a chain can be a graph; visiting each once keeps the walk linear.
    fn chain(&self, root: FormulaId) -> Vec<FormulaId> {
        let conjunction = |id| matches!(self.spec.formula(id), Formula::And(..));
        let disjunction = |id| matches!(self.spec.formula(id), Formula::Or(..));
        let mut seen = Seen::default();
        let mut operands = Vec::new();
        let mut stack = vec![root];
        while let Some(id) = stack.pop() {
            if !seen.insert(id) {
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

    /// The expansion of one formula from those of its operands; the equations are those of the
    /// module's docs. An operator may have another bound than that of `id`.
    fn expansion_of(&mut self, id: FormulaId, formula: Formula) -> Bdd {
        let of = |this: &Self, a: FormulaId| this.expansion[a.0 as usize];
        match formula {
            Formula::True => Bdd::TRUE,
            Formula::False => Bdd::FALSE,
            Formula::Literal { proposition, negated } => {
                self.functions.literal((proposition, !negated))
            }
            // A chain is expanded as a whole, before.
            Formula::And(..) | Formula::Or(..) => of(self, id),
            Formula::Next(a) | Formula::Delay(1, a) => self.later(a),
            Formula::Delay(..) => self.again(id, formula),
            Formula::Within(0, a) | Formula::Throughout(0, a) => of(self, a),
            Formula::UntilWithin(0, _, b) => of(self, b),
            Formula::Eventually(a) | Formula::Within(_, a) => {
                let (now, again) = (of(self, a), self.again(id, formula));
                self.functions.or(now, again)
            }
            Formula::Throughout(_, a) => {
                let (now, again) = (of(self, a), self.again(id, formula));
                self.functions.and(now, again)
            }
            Formula::Until(a, b) | Formula::UntilWithin(_, a, b) => {
                let again = self.again(id, formula);
                let (hold, done) = (of(self, a), of(self, b));
                let later = self.functions.and(hold, again);
                self.functions.or(done, later)
            }
            Formula::Then(a, b) => {
                let (again, second) = (self.again(id, formula), self.later(b));
                let first = of(self, a);
                let first = self.functions.and(first, second);
                self.functions.or(first, again)
            }
        }
    }

    /// The obligation to satisfy a formula at the next state.
    fn later(&mut self, a: FormulaId) -> Bdd {
        self.functions.variable(self.obligations.level(a, self.spec.formula(a)))
    }

    /// The obligation to satisfy `formula`, the operator of `id` with any bound, at the next state,
    /// with one step less if it has a bound.
    fn again(&mut self, id: FormulaId, formula: Formula) -> Bdd {
        let fewer = formula.bound().map_or(formula, |n| formula.with_bound(n - 1));
        self.functions.variable(self.obligations.level(id, fewer))
    }

    /// Replaces every obligation in `f` by its expansion. A loop, for a chain of obligations is
    /// as long as its bound.
    fn expand(&mut self, f: Bdd) -> Bdd {
        if let Some(known) = self.known_expansion(f) {
            return known;
        }
        let mut open = vec![f];
        while let Some(&f) = open.last() {
            let Node { level, low, high } = self.functions.get(f).expect("leaves are known");
            match (self.known_expansion(low), self.known_expansion(high)) {
                (Some(on_low), Some(on_high)) => {
                    let expansion = self.expand_node(level, on_low, on_high);
                    self.expanded.insert(f, expansion);
                    open.pop();
                }
                (None, _) => open.push(low),
                (_, None) => open.push(high),
            }
        }
        self.known_expansion(f).expect("it was just expanded")
    }

    /// The expansion of `f`, if it is known; a leaf is its own.
    fn known_expansion(&self, f: Bdd) -> Option<Bdd> {
        if f.value().is_some() { Some(f) } else { self.expanded.get(f) }
    }

    /// The expansion of a node from those of its children.
    ///
    /// Functions of obligations are monotone, so a node is `low ∨ (obligation ∧ high)`, and no
    /// negation of an expansion is needed.
    fn expand_node(&mut self, level: u32, low: Bdd, high: Bdd) -> Bdd {
        let due = self.due(level);
        let high = self.functions.and(due, high);
        self.functions.or(low, high)
    }

    /// The expansion of the obligation of a level.
    fn due(&mut self, level: u32) -> Bdd {
        let (id, formula) = self.obligations.due(level);
        match formula.bound() {
            None => self.expansion[id.0 as usize],
            Some(_) => self.expansion_of(id, formula),
        }
    }

    /// The number of states of the minimal automaton, if the formula is one operator with the bound
    /// n over conditions on one state, behind a delay or not.
    ///
    /// They are n + 3: one for each number of steps that are left, one for the last, the accepting
    /// state and the trap. All are different: with k steps left, the trap is k + 1 letters away for
    /// F and U and acceptance for G. A delay adds its steps, each further from acceptance.
    fn states_of_bound(&mut self) -> Option<u64> {
        let (mut id, mut states) = (self.spec.root(), 3);
        loop {
            match self.spec.formula(id) {
                Formula::Next(a) => (id, states) = (a, states + 1),
                Formula::Delay(n, a) => (id, states) = (a, states + u64::from(n)),
                Formula::Within(n, a) | Formula::Throughout(n, a) => {
                    return self.is_condition(a).then_some(states + u64::from(n));
                }
                Formula::UntilWithin(n, a, b) => {
                    let conditions = self.is_condition(a) && self.is_condition(b);
                    let of = |part: FormulaId| self.expansion[part.0 as usize];
                    let (hold, done) = (of(a), of(b));
                    let waits = conditions && self.functions.minus(hold, done) != Bdd::FALSE;
                    return waits.then_some(states + u64::from(n));
                }
                _ => return self.is_condition(id).then_some(states),
            }
        }
    }

    /// Whether a formula is a condition on one state that holds in some states and not in others.
    fn is_condition(&self, id: FormulaId) -> bool {
        let f = self.expansion[id.0 as usize];
        let mut nodes = self.functions.postorder(&[f]).into_iter();
        let asks = |node: u32| self.functions.nodes()[node as usize].level < self.propositions;
        f.index().is_some() && nodes.all(asks)
    }

    /// Explores the states breadth-first from the formula's own expansion.
    ///
    /// A formula whose expansion is ⊤ is satisfied by every trajectory: its initial state accepts.
    fn explore(mut self) -> Result<Dfa, Exceeded> {
        let root = self.expansion[self.spec.root().0 as usize];
        if root == Bdd::TRUE {
            self.accepting_state();
        } else {
            self.state(root);
        }
        let mut transitions = Vec::new();
        while let Some(&root) = self.roots.get(transitions.len()) {
            self.check_demands(root)?;
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

    /// Checks the number of demands that letters lead to from an expansion and that were not met
    /// before: functions of obligations, of which only those with one expansion are one state. To
    /// count them costs a step each, to expand those of a large conjunction a hundred times as much;
    /// so what has twice as many as the automaton may have states is refused before.
    fn check_demands(&self, root: Bdd) -> Result<(), Exceeded> {
        let (most, mut demands) = (2 * self.budget.states, 0);
        if self.functions.nodes().len() <= most {
            return Ok(());
        }
        let (mut seen, mut stack) = (Seen::default(), vec![root]);
        while let Some(f) = stack.pop() {
            if demands > most || self.targets.get(f).is_some() || !seen.insert(f) {
                continue;
            }
            match self.functions.get(f) {
                Some(Node { level, low, high }) if level < self.propositions => {
                    stack.extend([high, low]);
                }
                _ => demands += 1,
            }
        }
        match demands > most {
            true => Err(Exceeded { what: Resource::States, limit: self.budget.states }),
            false => Ok(()),
        }
    }

    /// The transition function of an expansion: its part above the obligations, with states as
    /// leaves.
    fn target(&mut self, f: Bdd) -> Bdd {
        if let Some(known) = self.targets.get(f) {
            return known;
        }
        if self.roots.len() > self.budget.states {
            // One letter can lead to many states. What is too much already need not be finished.
            return Bdd::FALSE;
        }
        let target = match self.functions.get(f) {
            Some(Node { level, low, high }) if level < self.propositions => {
                let (low, high) = (self.target(low), self.target(high));
                self.transitions.node(level, low, high)
            }
            // Nothing more is asked: this letter accepts, and no further state is needed.
            None if f == Bdd::TRUE => Bdd::leaf(self.accepting_state()),
            _ => {
                let expansion = self.expand(f);
                Bdd::leaf(self.state(expansion))
            }
        };
        self.targets.insert(f, target);
        target
    }

    /// The accepting state, added if it is new. It is not the state of [`Bdd::TRUE`] in `states`: ⊤
    /// as a function of obligations asks for nothing more, so it accepts already on the letter that
    /// leads to it.
    fn accepting_state(&mut self) -> State {
        let fresh = self.roots.len() as State;
        let state = *self.accepting.get_or_insert(fresh);
        if state == fresh {
            self.roots.push(Bdd::TRUE);
        }
        state
    }

    /// The number of the state with this expansion, added if it is new.
    fn state(&mut self, expansion: Bdd) -> State {
        let fresh = self.roots.len() as State;
        let state = self.states.get_or_insert(expansion, fresh);
        if state == fresh {
            self.roots.push(expansion);
        }
        state
    }

    /// Checks the size of the diagram against the budget.
    fn check_nodes(&self) -> Result<(), Exceeded> {
        if self.functions.is_too_deep() {
            return Err(Exceeded {
                what: Resource::Operators,
                limit: Diagram::MAX_LEVELS as usize,
            });
        }
        match self.functions.is_exhausted() {
            true => Err(Exceeded { what: Resource::Nodes, limit: self.budget.nodes }),
            false => Ok(()),
        }
    }

    /// Checks a count against a limit.
    fn check(&self, what: Resource, count: usize, limit: usize) -> Result<(), Exceeded> {
        if count > limit { Err(Exceeded { what, limit }) } else { Ok(()) }
    }
}
