//! What an example shows while it runs and leaves behind: progress, a table of verdicts, files.

use std::error::Error;
use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use tltl::learn::TrainError;
use tltl::prelude::*;
use tltl::solve::Certificate;
use tltl_compiler::compile;
use tltl_compiler::dfa::{Automata, Dfa};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

/// Trains until `total` steps have been taken, with a bar as that of [`in_slices`].
///
/// # Errors
/// As [`Learner::train`].
pub fn train<E: FiniteEnv>(
    learner: &mut Learner,
    env: &mut E,
    total: u64,
) -> Result<(), TrainError> {
    let formula = learner.task().formula().to_owned();
    in_slices(formula, total, |until| learner.train(env, until).map(|()| learner.steps()))
}

/// Trains in fifty slices, with a bar that shows how far it is, silent in a pipe. `train` is given
/// the number of steps in all, and gives that of those taken.
///
/// # Errors
/// Those of `train`.
pub fn in_slices<F>(
    what: String,
    total: u64,
    mut train: impl FnMut(u64) -> Result<u64, F>,
) -> Result<(), F> {
    let style = "{prefix:>24} {wide_bar} {human_pos} steps, {per_sec}, {eta} left";
    let style = ProgressStyle::with_template(style).expect("a template of indicatif");
    let bar = ProgressBar::new(total).with_prefix(what);
    bar.set_style(style);
    bar.enable_steady_tick(Duration::from_millis(100));
    for slice in 1..=50 {
        let steps = train(total * slice / 50)?;
        bar.set_position(steps.min(total));
    }
    bar.finish_and_clear();
    Ok(())
}

/// The automata of the tasks in a file, in their order: for pictures and for sizes. Nothing that
/// learns or runs reads the file.
///
/// # Errors
/// If there is a mistake in the file, as the compiler reports it.
pub fn automata(name: &str, text: &str) -> Result<Vec<Automata>, String> {
    let compiled = compile::file(&Source::new(name, text), Budget::default());
    Ok(compiled.map_err(|errors| errors.to_string())?.automata)
}

/// What the columns of [`verdicts`] are.
const COLUMNS: &str = "\
states, edges  of the minimal automaton, loops included; in brackets those that a state can take
P(sat)         how likely the policy satisfies the task, mean over all start cells
E[steps]       how many steps that takes where it is satisfied; optimum: the fewest that any policy
               takes which satisfies the task as likely as possible
optimal at     the share of pairs of a live automaton state and a cell whose action is best for the
               reward, to within 1e-6 of it";

/// Prints what policies are worth, one a line: a name, the task's automata, the certificate; and
/// what the columns are.
pub fn verdicts(rows: &[(&str, &Automata, Certificate)]) {
    let steps = |steps: Option<f64>| steps.map_or("-".into(), |steps| format!("{steps:.4}"));
    println!(
        "{:<37}{:>7}{:>10}{:>11}{:>11}{:>10}{:>11}",
        "task", "states", "edges", "P(sat)", "E[steps]", "optimum", "optimal at"
    );
    for (what, automata, certificate) in rows {
        println!(
            "{what:<37}{}{:>11.6}{:>11}{:>10}{:>9.2} %",
            size(automata),
            certificate.satisfied,
            steps(certificate.steps),
            steps(certificate.optimal_steps),
            100.0 * certificate.fraction_optimal
        );
    }
    println!("\n{COLUMNS}");
}

/// How big an automaton is: its states, and its edges with self-loops, first with the predicates
/// as free propositions, then those that some state of the world can take.
fn size(automata: &Automata) -> String {
    let edges = |dfa: &Dfa| dfa.size().edges + dfa.size().self_loops;
    let (propositional, possible) = (edges(&automata.propositional), edges(&automata.dfa));
    format!("{:>7}{propositional:>5} ({possible})", automata.dfa.len())
}

/// Where an example puts its files.
pub struct Folder(PathBuf);

impl Folder {
    /// The folder of the first argument of the program, `otherwise` without one; it is made if it is
    /// not there.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn of_arguments(otherwise: &str) -> Result<Self, Box<dyn Error>> {
        Self::at(std::env::args_os().nth(1).unwrap_or(OsString::from(otherwise)))
    }

    /// A folder, which is made if it is not there.
    ///
    /// # Errors
    /// If it cannot be made.
    pub fn at(folder: impl Into<PathBuf>) -> Result<Self, Box<dyn Error>> {
        let folder = folder.into();
        std::fs::create_dir_all(&folder)?;
        Ok(Self(folder))
    }

    /// Writes a file, and prints where it is.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, name: &str, content: &str) -> Result<(), Box<dyn Error>> {
        let path = self.0.join(name);
        tltl::file::replace(&path, content.as_bytes())?;
        println!("wrote {}", path.display());
        Ok(())
    }
}
