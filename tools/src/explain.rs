//! Explains a task to a person: in words, by shortest trajectories, and state by state.
//!
//! The words come from the formula, everything else from the automaton. So a reader sees what will
//! be rewarded, which may differ from what the author meant; a surprise here is a mistake found
//! before training.
//!
//! Each state is explained by three answers, all exact: the quickest way to acceptance, the
//! literals without which no way exists, and the guard that loses the task.

mod needs;
mod words;

use std::fmt;

use crate::emit::sum::Sum;
use crate::emit::text;
use crate::task::Verdict;
use crate::trace::{Trace, shortest};
use needs::Needs;
use tltl_compiler::dfa::{Dfa, Guards, Size, State};
use tltl_compiler::spec::Spec;

/// A task explained. It prints as the text of `tltlc explain`, without the line of the title.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::{explain::explain, task::compile};
///
/// let task = compile("!wet U home", Budget::default())?;
/// let told = explain(&task.entry().task().spec, task.dfa());
/// assert_eq!((told.size.states, told.falls.len()), (3, 1));
/// assert!(told.to_string().contains("How the task is lost\n\n  in state 0 when wet && !home"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Explanation {
    /// The task in plain English, one string a line; empty if the formula is too large to retell.
    pub words: Vec<String>,
    /// The numbers of states and edges.
    pub size: Size,
    /// A shortest trajectory that satisfies the task; `None` if there is none.
    pub satisfying: Option<Trace>,
    /// A shortest trajectory after which the task is lost for good; `None` if it cannot be lost.
    pub losing: Option<Trace>,
    /// A shortest trajectory that does not satisfy the task, lost or still open; `None` if all do.
    pub unsatisfying: Option<Trace>,
    /// The explanation of each state, in their order; of the first [`MOST_STATES`] only.
    pub states: Vec<StateExplanation>,
    /// The edges into the trap: the state, and the guard as text.
    pub falls: Vec<(State, String)>,
}

/// The explanation of an automaton state: what the task still asks for there.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::{explain::explain, task::compile};
///
/// let task = compile("fetch T bring", Budget::default())?;
/// let states = explain(&task.entry().task().spec, task.dfa()).states;
/// assert!(states[0].moves == Some(2) && states[0].way == ["fetch", "bring"]);
/// assert!(states[1].needs == ["bring"] && states[1].avoid.is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct StateExplanation {
    /// The state.
    pub state: State,
    /// Its verdict. In a state that is not open the lists below are empty.
    pub verdict: Verdict,
    /// The number of moves to the accepting state at least; `None` if it cannot be reached.
    pub moves: Option<u32>,
    /// The literals that must hold at some instant still to come, whatever else happens; none that
    /// another of them brings along, as `x < 1` does `x < 2`.
    pub needs: Vec<String>,
    /// The guards along a shortest way to acceptance, one a move, of the first [`MOST_TOLD`] moves.
    pub way: Vec<String>,
    /// The guard that loses the task at the next instant, if there is one.
    pub avoid: Option<String>,
}

/// The most states that are explained one by one: nobody reads more, and each costs a search for
/// each literal.
pub const MOST_STATES: usize = 64;

/// The most moves of a way that are told: a bound of a thousand instants is as many guards, from each of
/// as many states.
pub const MOST_TOLD: usize = 50;

/// Explains a task, given its formula and its automaton.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::{explain::explain, task::compile};
///
/// let task = compile("!wet U home", Budget::default())?;
/// let told = explain(&task.entry().task().spec, task.dfa());
/// assert_eq!(told.words, ["not wet, at every instant until home, which must come"]);
/// assert_eq!(told.satisfying.map(|trace| trace.to_string()).as_deref(), Some("{home}"));
/// assert_eq!(told.states[0].needs, ["home"]);
/// assert_eq!(told.states[0].avoid.as_deref(), Some("wet && !home"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn explain(spec: &Spec, dfa: &Dfa) -> Explanation {
    Explanation { words: retold(spec), ..explain_automaton(dfa) }
}

/// Explains an automaton that came without a formula: all but the words.
///
/// ```
/// use tltl_compiler::{hoa, source::Source};
/// use tltlc::explain::explain_automaton;
///
/// let text = "HOA: v1 Start: 0 AP: 1 \"a\" Acceptance: 1 Inf(0)
///     --BODY-- State: 0 [0] 1 State: 1 {0} [t] 1 --END--";
/// let told = explain_automaton(&hoa::read(&Source::new("now.hoa", text)).unwrap().dfa);
/// assert_eq!(told.states[0].avoid.as_deref(), Some("!a"));
/// ```
#[must_use]
pub fn explain_automaton(dfa: &Dfa) -> Explanation {
    let (mut guards, mut needs) = (Guards::new(dfa), Needs::new(dfa));
    let accepts = |q: State| dfa.accepting == Some(q);
    let distances = dfa.distances();
    let states = dfa.states().take(MOST_STATES);
    Explanation {
        words: Vec::new(),
        size: dfa.size(),
        satisfying: shortest(dfa, 0, &accepts),
        losing: dfa.trap.and_then(|trap| shortest(dfa, 0, &|q| q == trap)),
        unsatisfying: shortest(dfa, 0, &|q| !accepts(q)),
        states: states.map(|q| state(dfa, &mut guards, &mut needs, &distances, q)).collect(),
        falls: dfa.states().filter_map(|q| Some((q, fall(dfa, &mut guards, q)?))).collect(),
    }
}

/// The task in plain English, one string a line; empty if the formula is too large to retell.
///
/// ```
/// let task = tltlc::task::compile("F a", tltl_compiler::translate::Budget::default())?;
/// assert_eq!(tltlc::explain::retold(&task.entry().task().spec), ["at some instant a"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn retold(spec: &Spec) -> Vec<String> {
    words::retell(spec)
}

/// The explanation of these states alone, in their order. Each costs a search for each literal.
///
/// ```
/// let task = tltlc::task::compile("a T b", tltl_compiler::translate::Budget::default())?;
/// let told = tltlc::explain::of_states(task.dfa(), &[1]);
/// assert_eq!((told.len(), &told[0].needs[..]), (1, &["b".to_owned()][..]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn of_states(dfa: &Dfa, states: &[State]) -> Vec<StateExplanation> {
    let (mut guards, mut needs, distances) = (Guards::new(dfa), Needs::new(dfa), dfa.distances());
    states.iter().map(|&q| state(dfa, &mut guards, &mut needs, &distances, q)).collect()
}

/// The guard of the edge into the trap, if there is one.
fn fall(dfa: &Dfa, guards: &mut Guards<'_>, q: State) -> Option<String> {
    let cubes = guards.edge(q, dfa.trap.filter(|trap| *trap != q)?);
    (!cubes.is_empty()).then(|| Sum::new(&dfa.propositions, &cubes).to_string())
}

/// The explanation of one state.
fn state(
    dfa: &Dfa,
    guards: &mut Guards<'_>,
    needs: &mut Needs,
    distances: &[Option<u32>],
    q: State,
) -> StateExplanation {
    let verdict = match q {
        _ if dfa.accepting == Some(q) => Verdict::Satisfied,
        _ if dfa.trap == Some(q) => Verdict::Lost,
        _ => Verdict::Open,
    };
    let open = verdict == Verdict::Open;
    StateExplanation {
        state: q,
        verdict,
        moves: distances[q as usize],
        needs: if open { needs.of(q) } else { Vec::new() },
        way: if open { way(dfa, guards, distances, q) } else { Vec::new() },
        avoid: fall(dfa, guards, q).filter(|_| open),
    }
}

/// The guards along a shortest way from `q` to acceptance. Of several edges, and of several
/// products of a guard, the one with the fewest literals is shown.
fn way(dfa: &Dfa, guards: &mut Guards<'_>, distances: &[Option<u32>], mut q: State) -> Vec<String> {
    let mut way = Vec::new();
    let still = |left: &u32, told: usize| *left > 0 && told < MOST_TOLD;
    while let Some(left) = distances[q as usize].filter(|left| still(left, way.len())) {
        let edges = guards.edges(q).into_iter();
        let nearer =
            edges.filter(|(to, _)| distances[*to as usize].is_some_and(|moves| moves < left));
        let shortest = nearer.filter_map(|(to, guard)| {
            let cube = guards.cubes(guard).into_iter().min_by_key(Vec::len)?;
            Some((to, cube))
        });
        let Some((to, cube)) = shortest.min_by_key(|(_, cube)| cube.len()) else { break };
        way.push(Sum::new(&dfa.propositions, &[cube]).to_string());
        q = to;
    }
    way
}

/// The guard D_φ^q as text: the condition on a state of the world under which the automaton leaves
/// `q`, and not into the trap.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("!wet U home", Budget::default())?;
/// assert_eq!(tltlc::explain::progress(task.dfa(), 0), "home");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn progress(dfa: &Dfa, q: State) -> String {
    let cubes = Guards::new(dfa).progress(q);
    Sum::new(&dfa.propositions, &cubes).to_string()
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.words.is_empty() {
            writeln!(f, "The task\n")?;
            self.words.iter().try_for_each(|line| writeln!(f, "  {line}"))?;
            writeln!(f)?;
        }
        writeln!(f, "Its automaton\n")?;
        text::sizes(self.size).lines().try_for_each(|line| writeln!(f, "  {}", line.trim_end()))?;
        writeln!(f, "\nTrajectories\n")?;
        self.traces(f)?;
        writeln!(f, "\nWhat each state still asks for\n")?;
        self.states.iter().try_for_each(|state| write!(f, "{state}"))?;
        if self.size.states > self.states.len() {
            writeln!(f, "  … and {} more", self.size.states - self.states.len())?;
        }
        self.trap(f)
    }
}

impl Explanation {
    fn traces(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.satisfying {
            Some(trace) => writeln!(f, "  shortest that satisfies the task:   {trace}")?,
            None => writeln!(f, "  no trajectory satisfies the task")?,
        }
        match (&self.losing, &self.unsatisfying) {
            (Some(trace), _) => writeln!(f, "  shortest that loses it for good:    {trace}"),
            (None, Some(trace)) => {
                writeln!(f, "  shortest that does not satisfy it:   {trace}")?;
                writeln!(f, "  none loses it for good")
            }
            (None, None) => writeln!(f, "  every trajectory satisfies it"),
        }
    }

    fn trap(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.falls.is_empty() {
            return Ok(());
        }
        writeln!(f, "\nHow the task is lost\n")?;
        self.falls.iter().try_for_each(|(q, when)| writeln!(f, "  in state {q} when {when}"))
    }
}

impl StateExplanation {
    /// The number of moves that `way` leaves out.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    ///
    /// let task = tltlc::task::compile("X[60] p", Budget::default())?;
    /// let told = tltlc::explain::explain(&task.entry().task().spec, task.dfa());
    /// assert_eq!((told.states[0].way.len(), told.states[0].untold()), (50, 11));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn untold(&self) -> usize {
        self.moves.map_or(0, |moves| (moves as usize).saturating_sub(self.way.len()))
    }
}

impl fmt::Display for StateExplanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "  {:>3}  ", self.state)?;
        match (self.verdict, self.moves) {
            (Verdict::Satisfied, _) => return writeln!(f, "nothing: the task is satisfied"),
            (Verdict::Lost, _) => return writeln!(f, "the task is lost"),
            (Verdict::Open, None) => return writeln!(f, "the task cannot be satisfied any more"),
            (Verdict::Open, Some(_)) => {
                write!(f, "quickest: {}", self.way.join(", then "))?;
                match self.untold() {
                    0 => writeln!(f)?,
                    more => writeln!(f, ", and {more} moves more")?,
                }
            }
        }
        if !self.needs.is_empty() {
            writeln!(f, "       cannot do without: {}", self.needs.join(", "))?;
        }
        match &self.avoid {
            Some(guard) => writeln!(f, "       lost by: {guard}"),
            None => Ok(()),
        }
    }
}
