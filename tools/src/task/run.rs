//! Recorded trajectories, run through a task.
//!
//! Predicates are evaluated for the whole trajectory at once, column by column; then the automaton
//! walks over the labels. A [`Run`] has one entry for each row, so that it can be plotted beside
//! the recording.

use std::convert::Infallible;
use std::fmt;

use serde::Serialize;
use tltl::automaton::{Automaton, Guard};
use tltl::{Acceptor, robustness};

use super::{Factored, Task};
use crate::evaluate::{Columns, Evaluator, NotANumber, Scratch};

/// The verdict of a task on the trajectory so far. The last two are final: no later state changes
/// them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// The trajectory can still be continued to either of the others.
    Open,
    /// The trajectory satisfies the task, and so does every continuation.
    Satisfied,
    /// No continuation satisfies the task.
    Lost,
}

/// In a word: `open`, `satisfied`, `lost`.
impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Open => "open",
            Self::Satisfied => "satisfied",
            Self::Lost => "lost",
        })
    }
}

/// The result of running a trajectory of n rows.
///
/// Its verdict is that of the last row; everything else is row by row.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::evaluate::{Columns, Scratch};
/// use tltlc::task::{Verdict, compile};
///
/// // Lost in row 1, and it stays so.
/// let task = compile("!wet U home", Budget::default())?;
/// let rows = Columns::of_rows(3, 2, &[-1.0, -1.0, 1.0, -1.0, -1.0, 1.0])?;
/// let run = task.run(&rows, &mut Scratch::default())?;
/// assert_eq!(run.verdicts, [Verdict::Open, Verdict::Lost, Verdict::Lost]);
/// assert_eq!((run.since(), run.progress[2]), (Some(1), f64::NEG_INFINITY));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// The automaton's state after each row: n entries; for a factored task n times the number of
    /// parts, row after row.
    pub states: Vec<u32>,
    /// The verdict after each row: n entries.
    pub verdicts: Vec<Verdict>,
    /// For each row ρ(s, D_φ^q), where q is the state before the row: the robustness of moving on.
    /// It is positive if the automaton moves on, and -∞ where the verdict is final.
    pub progress: Vec<f64>,
    /// The robustness of the whole trajectory; -∞ if it is empty.
    pub robustness: f64,
}

impl Run {
    /// The verdict after the last row; an empty trajectory is [open](Verdict::Open).
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        self.verdicts.last().copied().unwrap_or(Verdict::Open)
    }

    /// The first row, from 0, after which the task had its final verdict of this run; `None` for an
    /// empty trajectory.
    #[must_use]
    pub fn since(&self) -> Option<usize> {
        let last = self.verdict();
        self.verdicts.iter().position(|verdict| *verdict == last)
    }
}

impl Task {
    /// Runs a trajectory, one state a row, from the initial state.
    ///
    /// # Errors
    /// The first predicate that is not a number, in the first row in which there is one.
    ///
    /// # Panics
    /// If the number of columns is not the number of inputs.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    /// use tltlc::evaluate::{Columns, Scratch};
    /// use tltlc::task::{Verdict, compile};
    ///
    /// let task = compile("(x < 1) T (x > 2)", Budget::default())?;
    /// let x = Columns::of_rows(4, 1, &[3.0, 0.0, 1.5, 2.5])?;
    /// let run = task.run(&x, &mut Scratch::default())?;
    /// assert_eq!(run.states, [0, 1, 1, 2]);
    /// assert_eq!(run.progress, [-2.0, 1.0, -0.5, 0.5]);
    /// assert_eq!((run.verdict(), run.since()), (Verdict::Satisfied, Some(3)));
    /// assert_eq!(run.robustness, 0.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[track_caller]
    pub fn run(&self, columns: &Columns<'_>, scratch: &mut Scratch) -> Result<Run, NotANumber> {
        let automaton = self.automaton();
        let read = Reading::new(self.evaluator(), columns, scratch)?;
        let robustness = match self.entry().is_automaton() {
            true => self.best_run(&read),
            false => read.robustness,
        };
        let mut states = vec![Automaton::INITIAL; columns.rows()];
        automaton.run(Automaton::INITIAL, &read.labels[..], &mut states);
        let before = std::iter::once(&Automaton::INITIAL).chain(&states);
        let progress = before
            .zip(read.rows())
            .map(|(&q, rho)| robustness::guard(automaton.progress(q), |i| rho[i]));
        Ok(Run {
            progress: progress.collect(),
            verdicts: states.iter().map(|&q| verdict(automaton, q)).collect(),
            robustness,
            states,
        })
    }

    /// The robustness of the trajectory that the rows are: of the formula, or of the
    /// [best run](robustness::best_run) of an automaton without one; -∞ for an empty trajectory.
    ///
    /// # Errors
    /// The first predicate that is not a number, in the first row in which there is one.
    ///
    /// # Panics
    /// If the number of columns is not the number of inputs.
    ///
    /// ```
    /// use tltl_compiler::source::Source;
    /// use tltlc::evaluate::{Columns, Scratch};
    /// use tltlc::task::{Bound, TaskFile};
    ///
    /// let text = "HOA: v1 Start: 0 AP: 1 \"a\" Acceptance: 1 Inf(0)
    ///     --BODY-- State: 0 [0] 1 [!0] 0 State: 1 {0} [t] 1 --END--";
    /// let file = TaskFile::of_automaton(Source::new("eventually.hoa", text))?;
    /// let Bound::Plain(task) = file.find(None)?.bind(&[])? else { panic!("it has one automaton") };
    /// // Wait at −3, with 3 to spare, then accept with 2.
    /// let a = Columns::of_rows(2, 1, &[-3.0, 2.0])?;
    /// assert_eq!(task.robustness(&a, &mut Scratch::default())?, 2.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[track_caller]
    pub fn robustness(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
    ) -> Result<f64, NotANumber> {
        match self.entry().is_automaton() {
            true => Ok(self.best_run(&Reading::new(self.evaluator(), columns, scratch)?)),
            false => self.evaluator().robustness(columns, scratch),
        }
    }

    fn best_run(&self, read: &Reading) -> f64 {
        let automaton = self.automaton();
        let cells = || vec![0.0; automaton.states() as usize];
        let width = self.evaluator().propositions();
        let rho = |i, t| Ok::<_, Infallible>(read.rho[t * width + i]);
        let Ok(rho) = robustness::best_run(automaton, read.rows, &mut cells(), &mut cells(), rho);
        rho
    }
}

impl Factored {
    /// Runs a trajectory, one state a row, from the tuple of initial states.
    ///
    /// # Errors
    /// The first predicate that is not a number, in the first row in which there is one.
    ///
    /// # Panics
    /// If the number of columns is not the number of inputs.
    #[track_caller]
    pub fn run(&self, columns: &Columns<'_>, scratch: &mut Scratch) -> Result<Run, NotANumber> {
        let read = Reading::new(self.evaluator(), columns, scratch)?;
        let (rows, count) = (columns.rows(), self.parts().len());
        let mut states = vec![Automaton::INITIAL; rows * count];
        for (part, task) in self.parts().iter().enumerate() {
            let mut column = vec![Automaton::INITIAL; rows];
            let labels = self.labels_of(part, &read.labels);
            task.automaton().run(Automaton::INITIAL, &labels[..], &mut column);
            let places = states.iter_mut().skip(part).step_by(count);
            places.zip(column).for_each(|(place, q)| *place = q);
        }
        let initial = vec![Automaton::INITIAL; count];
        let before = std::iter::once(&initial[..]).chain(states.chunks_exact(count));
        Ok(Run {
            progress: before.zip(read.rows()).map(|(q, rho)| self.progress(q, rho)).collect(),
            verdicts: states.chunks_exact(count).map(|q| self.verdict(q)).collect(),
            robustness: read.robustness,
            states,
        })
    }

    fn verdict(&self, q: &[u32]) -> Verdict {
        let parts = || self.parts().iter().zip(q).map(|(part, &q)| verdict(part.automaton(), q));
        if parts().all(|part| part == Verdict::Satisfied) {
            Verdict::Satisfied
        } else if parts().any(|part| part == Verdict::Lost) {
            Verdict::Lost
        } else {
            Verdict::Open
        }
    }

    /// ρ(s, D_φ^q) of the whole task in a row in which the predicates have robustness `rho`.
    ///
    /// The tuple moves on where a part moves on and no part is lost; the formula for that is the
    /// runtime's, so that learning at run time and learning by macro pay the same.
    fn progress(&self, q: &[u32], rho: &[f64]) -> f64 {
        if self.verdict(q) != Verdict::Open {
            return f64::NEG_INFINITY;
        }
        let rho = |part, guard| {
            Ok::<_, Infallible>(robustness::guard(guard, |i| rho[self.place(part, i)]))
        };
        let parts = || self.parts().iter().map(Task::automaton).zip(q).enumerate();
        let losing = parts().map(|(part, (automaton, &q))| {
            let trap = automaton.trap();
            rho(part, trap.map_or(Guard::FALSE, |trap| automaton.edge_guard(q, trap)))
        });
        let progress = parts().map(|(part, (automaton, &q))| rho(part, automaton.progress(q)));
        let Ok(progress) = robustness::progress_of_all(losing, progress);
        progress
    }
}

/// The predicates and the formula of a task, evaluated on a trajectory.
struct Reading {
    /// Shape (rows, predicates), row after row; so is `rho`.
    labels: Vec<bool>,
    rho: Vec<f64>,
    rows: usize,
    robustness: f64,
}

impl Reading {
    #[track_caller]
    fn new(
        evaluator: &Evaluator,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
    ) -> Result<Self, NotANumber> {
        let rows = columns.rows();
        let count = rows * evaluator.propositions();
        let (mut labels, mut rho) = (vec![false; count], vec![0.0; count]);
        evaluator.labels(columns, scratch, &mut labels)?;
        evaluator.rho(columns, scratch, &mut rho)?;
        Ok(Self { labels, rho, rows, robustness: evaluator.robustness(columns, scratch)? })
    }

    /// The robustness of the predicates in each row.
    fn rows(&self) -> impl Iterator<Item = &[f64]> {
        let width = self.rho.len().checked_div(self.rows).unwrap_or(0);
        (0..self.rows).map(move |row| &self.rho[row * width..][..width])
    }
}

pub(super) fn verdict(automaton: &Automaton, q: u32) -> Verdict {
    if automaton.is_accepting(q) {
        Verdict::Satisfied
    } else if automaton.is_trap(q) {
        Verdict::Lost
    } else {
        Verdict::Open
    }
}
