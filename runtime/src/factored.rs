//! Conjunctions whose parts run side by side.
//!
//! The automaton of n unordered goals has 2^n states; their n automata together have 2n. A
//! [`Factored`] task, which `#[factored]` asks for, keeps the parts of a conjunction apart: its state
//! is one automaton state for each part, it is accepted when all parts are and lost when one is.
//!
//! Parts that share a proposition can be lost *together* while each could still go on alone: with
//! `!b U a` and `!a U b`, neither a nor b may come first. The compiler joins such parts into one if
//! their product is small, and then every dead end is the trap of a part. Otherwise
//! [`Factored::joint_dead_ends`] says that some may not be recognised.
//!
//! A factored task becomes a [`Monitor`](crate::Monitor) as [`Numbered`], which numbers the tuples of
//! states. For learning in a finite world, `Labelled::of_factored` (module `augmented`, feature
//! `alloc`) numbers only the tuples that the world reaches.

mod numbered;

use core::fmt;

pub use numbered::{Numbered, TooManyStates};

use crate::automaton::Automaton;
#[cfg(feature = "alloc")]
use crate::automaton::TableError;
use crate::monitor::Acceptor;
use crate::robustness::{self, NotANumber, Predicates, letter, unreadable};
use crate::shared::Shared;
use crate::task::{Error, Formula, Reader, Task};

/// One part of a factored task: a formula with its automaton, and which of the task's predicates it
/// is about.
///
/// [`Factored::new`] shows how parts are made by hand; the compiler makes them for `#[factored]`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its formula; propositions are numbered as in `automaton`.
    pub formula: Formula,
    /// Its minimal automaton.
    pub automaton: Automaton,
    /// For each proposition of the automaton the number of the task's predicate.
    pub predicates: Shared<[u32]>,
}

/// Whether all dead ends of a factored task are traps of its parts.
///
/// ```
/// use tltl::factored::JointDeadEnds;
/// use tltl::tltl;
///
/// // Neither may come before the other: lost from the start, and known to be, as the parts were joined.
/// let task = tltl! { #[factored] |s: &(bool, bool)| !s.1 U s.0 && !s.0 U s.1 };
/// assert_eq!((task.joint_dead_ends(), task.len()), (JointDeadEnds::None, 1));
/// assert!(!task.is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointDeadEnds {
    /// They are: parts that share propositions have been joined.
    None,
    /// Some parts share propositions and their product is too large: a state in which each part
    /// could go on but not all together is not recognised as lost.
    NotSearched,
}

/// A conjunction whose parts run side by side, over the predicates `P`.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// let goals = tltl::tltl! { #[factored] |s: &[bool; 3]| F s[0] && F s[1] && F s[2] };
/// let mut q = [0; 3]; // one automaton state for each part
/// for s in [[true, false, false], [false, true, true]] {
///     goals.next(&mut q, &s)?;
/// }
/// assert!(goals.is_accepting(&q));
/// # }
/// # Ok::<(), tltl::task::Error>(())
/// ```
#[derive(Clone)]
pub struct Factored<P> {
    name: Shared<str>,
    formula: Formula,
    parts: Shared<[Part]>,
    joint: JointDeadEnds,
    predicates: P,
    /// Whether the predicates were generated with these parts.
    is_generated: bool,
}

/// Name, formula and sizes: predicates are code.
impl<P> fmt::Debug for Factored<P> {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Factored")
            .field("name", &self.name)
            .field("formula", &self.formula.text)
            .field("parts", &self.parts.len())
            .field("joint", &self.joint)
            .finish_non_exhaustive()
    }
}

impl<P> Factored<P> {
    /// The factored task of parts that a program made at run time; `text` is the whole formula. The
    /// numbers in [`Part::predicates`] must be those of `predicates`, which alone knows how many it
    /// has.
    ///
    /// # Errors
    /// If a part does not have a predicate for each proposition of its automaton, or its formula is
    /// about a proposition that its automaton does not have.
    ///
    /// ```
    /// # #[cfg(feature = "macros")] {
    /// use tltl::factored::{Factored, JointDeadEnds, Part};
    /// use tltl::{Acceptor, tltl};
    /// # use tltl::robustness::{NotANumber, Predicates};
    /// # struct Bits;
    /// # impl Predicates<u8> for Bits {
    /// #     fn robustness(&self, i: usize, s: &u8) -> f64 { f64::from(s >> i & 1) - 0.5 }
    /// #     fn holds(&self, i: usize, s: &u8) -> Result<bool, NotANumber> { Ok(s >> i & 1 == 1) }
    /// # }
    ///
    /// // Eight times `F`, each over a bit of the state.
    /// let once = tltl! { |s: &(bool, bool)| F s.0 };
    /// let part = |i| Part {
    ///     formula: once.formula().clone(),
    ///     automaton: once.automaton().clone(),
    ///     predicates: vec![i].into(),
    /// };
    /// let parts: Vec<Part> = (0..8).map(part).collect();
    /// let bits = Factored::new("bits", "all bits", parts, JointDeadEnds::None, Bits)?;
    /// assert_eq!(bits.satisfied(&[0x0f_u8, 0xf0]), Ok(true));
    /// # }
    /// # Ok::<(), tltl::automaton::TableError>(())
    /// ```
    #[cfg(feature = "alloc")]
    #[inline]
    pub fn new(
        name: impl Into<Shared<str>>,
        text: impl Into<Shared<str>>,
        parts: impl Into<Shared<[Part]>>,
        joint: JointDeadEnds,
        predicates: P,
    ) -> Result<Self, TableError> {
        let parts = parts.into();
        for Part { formula, automaton, predicates } in &*parts {
            let propositions = automaton.propositions().len();
            crate::automaton::check_length("predicates", predicates.len(), propositions)?;
            crate::formula::check_operators(formula.operators(), propositions)?;
        }
        let made = Self::trusted(name.into(), text.into(), parts, joint, predicates);
        Ok(Self { is_generated: false, ..made })
    }

    /// For generated code, whose parts are right by construction.
    #[doc(hidden)]
    pub const fn trusted(
        name: Shared<str>,
        text: Shared<str>,
        parts: Shared<[Part]>,
        joint: JointDeadEnds,
        predicates: P,
    ) -> Self {
        let formula = Formula::trusted(text, Shared::from_static(&[]));
        Self { name, formula, parts, joint, predicates, is_generated: true }
    }

    /// The task's name; its formula if it has none.
    #[must_use]
    #[inline]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The formula; its operators are those of the [parts](Self::part).
    #[must_use]
    pub const fn formula(&self) -> &Formula {
        &self.formula
    }

    /// The number of parts, which is the length of a state.
    #[must_use]
    #[inline]
    pub fn len(&self) -> usize {
        self.parts.len()
    }

    /// Whether there are no parts; never so for a compiled task.
    #[must_use]
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Whether all dead ends are traps of the parts.
    #[must_use]
    pub const fn joint_dead_ends(&self) -> JointDeadEnds {
        self.joint
    }

    /// Part `i` as a task of its own.
    ///
    /// # Panics
    /// If there is no part `i`.
    ///
    /// ```
    /// # #[cfg(feature = "macros")] {
    /// use tltl::{Acceptor, tltl};
    ///
    /// let goals = tltl! { #[factored] |s: &[bool; 3]| F s[0] && F s[1] && F s[2] };
    /// assert_eq!(goals.part(1).formula().text(), "F s[1]");
    /// # }
    /// ```
    #[must_use]
    #[inline]
    pub fn part(&self, i: usize) -> Task<Select<'_, P>> {
        let part = &self.parts[i];
        Task::trusted(
            part.formula.text.clone(),
            self.parts.project(|parts| &parts[i].formula),
            self.parts.project(|parts| &parts[i].automaton),
            self.reader(part).predicates,
        )
    }

    /// Moves every part on `s`: `q[i] = δ_i(q[i], s)`. A state starts as all 0.
    ///
    /// # Errors
    /// If a predicate that decides a move is not a number. Of a compiled task of up to ten predicates no
    /// part has moved then, of others those before it have.
    ///
    /// # Panics
    /// If `q` does not have one state for each part, or one that is not a state of its part.
    pub fn next<S: ?Sized>(&self, q: &mut [u32], s: &S) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        assert_eq!(q.len(), self.parts.len(), "one automaton state for each part");
        if self.is_generated && P::DENSE > 0 {
            // A predicate that several parts read is evaluated once.
            let (letter, false) = letter(&self.predicates, s) else {
                return Err(self.unreadable(s));
            };
            for (part, q) in self.parts.iter().zip(q) {
                let chosen = part.predicates.iter().enumerate();
                let own = chosen.fold(0, |own, (i, &p)| own | (letter >> p & 1) << i);
                part.automaton.expect_state(*q);
                *q = part.automaton.of_letter(*q, own);
            }
            return Ok(());
        }
        for (part, q) in self.readers().zip(q) {
            *q = part.next(*q, s)?;
        }
        Ok(())
    }

    #[cold]
    #[inline(never)]
    fn unreadable<S: ?Sized>(&self, s: &S) -> Error
    where
        P: Predicates<S>,
    {
        let p = unreadable(&self.predicates, s) as u32;
        let name = self.parts.iter().find_map(|part| {
            let i = part.predicates.iter().position(|&of| of == p)?;
            part.automaton.propositions().get(i).cloned()
        });
        Error { predicate: name.unwrap_or(Shared::from_static("")), instant: None }
    }

    /// Whether all parts accept.
    #[must_use]
    #[inline]
    pub fn is_accepting(&self, q: &[u32]) -> bool {
        self.automata().zip(q).all(|(automaton, &q)| automaton.is_accepting(q))
    }

    /// Whether a part is lost.
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let task = tltl! { #[factored] |s: &(bool, bool, bool)| !s.0 U s.1 && F s.2 };
    /// let mut q = vec![0; task.len()];
    /// task.next(&mut q, &(true, false, true))?;
    /// assert!(task.is_lost(&q) && !task.is_accepting(&q), "one part is done, the other is lost");
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn is_lost(&self, q: &[u32]) -> bool {
        self.automata().zip(q).any(|(automaton, &q)| automaton.is_trap(q))
    }

    /// The same task over other predicates, which must be numbered as these are.
    #[must_use]
    #[inline]
    pub fn with_predicates<Q>(&self, predicates: Q) -> Factored<Q> {
        let (name, formula, parts) = (self.name.clone(), self.formula.clone(), self.parts.clone());
        Factored { name, formula, parts, joint: self.joint, predicates, is_generated: false }
    }

    /// By how much `s` makes a part move on from `q` and loses none: ρ(s, D_φ^q) of the whole; -∞ where
    /// it is decided.
    ///
    /// # Errors
    /// If a predicate is not a number.
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let task = tltl! { #[factored] |s: &[f64; 2]| F ({ s[0] } > 3) && F ({ s[1] } > 9) };
    /// assert_eq!(task.progress_robustness(&[0, 0], &[5.0, 8.0]), Ok(2.0));
    /// assert_eq!(task.progress_robustness(&[1, 0], &[5.0, 8.0]), Ok(-1.0));
    /// ```
    #[inline]
    pub fn progress_robustness<S: ?Sized>(&self, q: &[u32], s: &S) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        if self.is_accepting(q) || self.is_lost(q) {
            return Ok(f64::NEG_INFINITY);
        }
        self.progress(q.iter().copied(), s)
    }

    /// For two parts (D₁ ∧ ¬τ₂) ∨ (D₂ ∧ ¬τ₁), where τᵢ is the guard into trap i: progress of one part
    /// that loses none of the others, as in a product.
    #[inline]
    fn progress<S: ?Sized>(&self, q: impl Iterator<Item = u32> + Clone, s: &S) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        robustness::progress_of_all(
            self.readers().zip(q.clone()).map(|(part, q)| part.trap(q, s)),
            self.readers().zip(q).map(|(part, q)| part.progress(q, s)),
        )
    }

    /// Robustness of a whole trajectory: the least of the parts'; -∞ for an empty one.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    pub fn robustness<S>(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        let mut parts = self.readers().map(|part| part.robustness(trajectory, &mut []));
        parts.try_fold(f64::INFINITY, |least, rho| Ok(least.min(rho?)))
    }

    /// Whether a trajectory satisfies the task: whether it satisfies every part.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    pub fn satisfied<S>(&self, trajectory: &[S]) -> Result<bool, Error>
    where
        P: Predicates<S>,
    {
        for part in self.readers() {
            if !part.satisfied(trajectory)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    #[inline]
    fn automata(&self) -> impl Iterator<Item = &Automaton> + Clone {
        self.parts.iter().map(|part| &part.automaton)
    }

    #[inline]
    fn readers(&self) -> impl Iterator<Item = Reader<'_, Select<'_, P>>> {
        self.parts.iter().map(|part| self.reader(part))
    }

    #[inline]
    fn reader<'a>(&'a self, part: &'a Part) -> Reader<'a, Select<'a, P>> {
        let Part { formula, automaton, predicates } = part;
        let predicates = Select { predicates: &self.predicates, chosen: predicates };
        Reader { formula, automaton, predicates, is_generated: false }
    }
}

/// Some predicates of a task, numbered anew: those of one of its parts. Predicate `i` of the part is
/// predicate `chosen[i]` of the task.
///
/// [`Factored::part`] gives it to the task of a part, which then reads the states of the whole; nobody
/// makes one by hand.
pub struct Select<'a, P> {
    predicates: &'a P,
    chosen: &'a [u32],
}

impl<P> fmt::Debug for Select<'_, P> {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Select").field("chosen", &self.chosen).finish_non_exhaustive()
    }
}

impl<P> Clone for Select<'_, P> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<P> Copy for Select<'_, P> {}

impl<S: ?Sized, P: Predicates<S>> Predicates<S> for Select<'_, P> {
    #[inline]
    fn robustness(&self, i: usize, s: &S) -> f64 {
        self.predicates.robustness(self.chosen[i] as usize, s)
    }

    #[inline]
    fn holds(&self, i: usize, s: &S) -> Result<bool, NotANumber> {
        self.predicates.holds(self.chosen[i] as usize, s)
    }

    // The task's buffers are long enough: the whole formula has at least the operators of a part.
    fn with_scratch<R>(&self, cells: usize, f: impl FnOnce(&mut [f64], &mut [f64]) -> R) -> R {
        self.predicates.with_scratch(cells, f)
    }
}
