//! The command line: arguments in, any stage of the compiler or any tool out.
//!
//! Each command is a module with a function `run`; the work is done by the modules of the library,
//! and this one only chooses the words. [`main`] is a function of its arguments and [`Streams`], so
//! that tests and other programs can call it: `tests/cli/cases.txt` of this package holds commands
//! with their whole output.
//!
//! Results go to the output, messages to the error stream. Exit codes: 0 all is well; 1 a source
//! has mistakes, two tasks differ, a trajectory does not satisfy its task, or a file is not laid
//! out; 2 the arguments or a file are at fault.
//!
//! The doc comments of the argument types in this module are the help texts of the program.

mod arguments;
mod automaton;
mod input;
mod layout;
mod limits;
mod record;
mod run;
mod streams;
mod subject;
mod tell;

use std::borrow::Cow;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};
use tltl_compiler::error::Style;
use tltl_compiler::translate::Budget;

use crate::emit::policy;
use crate::lsp;

use limits::Limits;

pub use streams::{Output, Streams, style};

/// The way in which a run ends, and its exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// All is well.
    Success,
    /// A source has mistakes, two tasks differ, a trajectory does not satisfy its task, or a file is
    /// not laid out.
    Mistaken,
    /// The arguments or a file are at fault.
    Failed,
}

impl Exit {
    /// The exit code of the process: 0, 1 or 2.
    #[must_use]
    pub fn code(self) -> u8 {
        self as u8
    }

    /// The exit of a command that judges: success if all is well.
    fn of(all_well: bool) -> Self {
        if all_well { Self::Success } else { Self::Mistaken }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        exit.code().into()
    }
}

/// Compiles scTLTL task specifications to minimal automata and Rust source.
#[derive(Parser)]
#[command(
    name = "tltlc",
    version,
    after_help = "Exit codes: 0 all is well; 1 a source has mistakes, two tasks differ, a \
                  trajectory does not satisfy its task, or a file is not laid out; 2 the \
                  arguments or a file are at fault.\n\
                  Colours are for terminals only; NO_COLOR turns them off."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Checks task files and automata in HOA: reports every mistake and warning, writes nothing.
    Check {
        /// The files; `-` is the standard input.
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// How to report.
        #[arg(long, value_enum, default_value_t = Report::Human)]
        format: Report,
        #[command(flatten)]
        limits: Limits,
    },
    /// Tells in plain English what a task asks for, and what each automaton state still does.
    Explain {
        /// A formula, a task file, FILE:TASK, or an automaton in HOA.
        #[arg(value_name = "FORMULA|FILE")]
        subject: String,
        /// The task of the file; may be left out if there is only one.
        #[arg(long)]
        task: Option<String>,
        /// The form to write.
        #[arg(long, value_enum, default_value_t = PageFormat::Text)]
        format: PageFormat,
        #[command(flatten)]
        limits: Limits,
    },
    /// Tells whether two tasks mean the same; if not, shows a shortest trajectory between them.
    ///
    /// A predicate is its definition: a name equals what it stands for, and two versions of a file
    /// that give one name two meanings differ. Names of a bare formula, and of an automaton in HOA,
    /// are those of the other side.
    Diff {
        /// A formula, a task file with one task, FILE:TASK, or an automaton in HOA.
        #[arg(value_name = "FORMULA|FILE[:TASK]")]
        first: String,
        /// The other one.
        #[arg(value_name = "FORMULA|FILE[:TASK]")]
        second: String,
        #[command(flatten)]
        limits: Limits,
    },
    /// Runs recorded trajectories: verdict, robustness, and the automaton row by row.
    ///
    /// Of several trajectories the text has one line each, and a summary.
    Run(Run),
    /// Lays out task files in place; comments, spellings and line breaks stay.
    ///
    /// All lines end as the first one does; a byte order mark is left out.
    Fmt {
        /// The task files; `-` takes the standard input to the standard output.
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// Write nothing; say which files are not laid out.
        #[arg(long)]
        check: bool,
    },
    /// Shows the automaton of a formula, of each formula of a list, or of a task of a file.
    Automaton(Automaton),
    /// Serves editors: diagnostics, explanations, completion, definitions, renaming, layout.
    ///
    /// It speaks the Language Server Protocol over the standard streams. Editors start it.
    Lsp {
        /// Nothing: the standard streams are the only way. Some editors say so.
        #[arg(long)]
        stdio: bool,
    },
    /// Turns a saved policy into a Rust source file that stands alone.
    Policy {
        /// The policy, as JSON; `-` is the standard input.
        file: PathBuf,
        /// Where to write the Rust source; the standard output if left out.
        #[arg(short, long)]
        output: Option<PathBuf>,
    },
}

/// How mistakes are reported.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Report {
    /// With the lines of the source and carets under the culprits.
    Human,
    /// One JSON object a line.
    Json,
}

#[derive(Args)]
struct Automaton {
    /// A formula, a task file, or an automaton in HOA; `-` is the standard input.
    #[arg(value_name = "FORMULA|FILE", required_unless_present_any = ["formula", "formulas"])]
    file: Option<PathBuf>,
    /// The task of the file; may be left out if there is only one.
    #[arg(long, requires = "file")]
    task: Option<String>,
    /// A formula, whatever files there are.
    #[arg(long, conflicts_with_all = ["file", "formulas"])]
    formula: Option<String>,
    /// A list of formulas, one a line; `-` is the standard input.
    #[arg(long, conflicts_with = "file")]
    formulas: Option<PathBuf>,
    /// The form to write.
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// With `--format json`: also the table of all transitions.
    #[arg(long)]
    explicit: bool,
    /// Take all predicates for free propositions, as other tools do.
    #[arg(long)]
    propositional: bool,
    #[command(flatten)]
    limits: Limits,
}

#[derive(Args)]
struct Run {
    /// A task file or FILE:TASK; or a formula or an automaton in HOA, whose propositions are read as robustness.
    #[arg(value_name = "FILE|FORMULA")]
    subject: String,
    /// The trajectories, one state a row; `-` is the standard input. CSV, JSON Lines, a JSON array
    /// of objects, or a JSON object of columns; Parquet, if `tltlc` is built with
    /// `--features parquet`. Columns have the names of the state's fields: `x`,
    /// `pose.x`, `joints[2]`; also `/pose/x`, `joints.2`, `x [m]`. Others are ignored.
    #[arg(required = true, value_name = "TRACE")]
    traces: Vec<PathBuf>,
    /// The column that a field is read from, whatever it is called: `x=/odom/pose/position/x`.
    #[arg(long, value_name = "FIELD=COLUMN")]
    map: Vec<String>,
    /// A file with one FIELD=COLUMN a line; lines that begin with `#` are comments.
    #[arg(long, value_name = "FILE")]
    map_file: Option<PathBuf>,
    /// The column that tells episodes apart. Each is a trajectory of its own; their rows may be
    /// mixed.
    #[arg(long, value_name = "COLUMN")]
    episode: Option<String>,
    /// The task of the file, with what it takes: `deliver(apple, fridge)`; may be left out if there
    /// is only one.
    #[arg(long)]
    task: Option<String>,
    /// The form to write.
    #[arg(long, value_enum, default_value_t = RowFormat::Text)]
    format: RowFormat,
    #[command(flatten)]
    limits: Limits,
}

/// The forms of a run.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum RowFormat {
    /// A table for people.
    Text,
    /// One line a row, with a header.
    Csv,
    /// One JSON object a row, and one with the verdict at the end; infinite numbers are null.
    Json,
    /// A page for a browser: automaton, states, predicates and robustness over time, with a slider.
    Html,
}

/// The forms of an explanation.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum PageFormat {
    /// Text for people.
    Text,
    /// A page for a browser.
    Html,
}

/// The forms of an automaton.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A table for people.
    Text,
    /// JSON.
    Json,
    /// Graphviz.
    Dot,
    /// A picture.
    Svg,
    /// A Mermaid diagram.
    Mermaid,
    /// Hanoi Omega-Automata, for Spot, Owl and others.
    Hoa,
    /// The Rust that the macros generate.
    Rust,
    /// A C99 header of a task: automaton, predicates, monitor.
    C,
}

/// Runs the command of `arguments`, the first of which is the name of the program.
///
/// It never ends the process, and writes to `streams` and to the files that the arguments name.
///
/// ```
/// use tltl_compiler::error::Style;
/// use tltlc::cli::{Exit, Output, Streams, main};
///
/// let (mut out, mut err) = (Vec::new(), Vec::new());
/// let mut streams = Streams {
///     input: &mut std::io::empty(),
///     out: Output { stream: &mut out, style: Style::Plain },
///     err: Output { stream: &mut err, style: Style::Plain },
/// };
/// let exit = main(["tltlc", "diff", "F a && F b", "F b && F a"], &mut streams);
/// assert_eq!(exit, Exit::Success);
/// assert_eq!(out, b"equal: every trajectory has the same verdict\n");
/// ```
pub fn main<I>(arguments: I, streams: &mut Streams<'_>) -> Exit
where
    I: IntoIterator<Item: Into<OsString> + Clone>,
{
    let outcome = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => run(arguments.command, streams),
        Err(error) => return usage(&error, streams),
    };
    outcome.unwrap_or_else(|message| {
        streams.complain(&format!("tltlc: {message}"));
        Exit::Failed
    })
}

/// Runs a command. This is the list of all commands with the functions behind them.
fn run(command: Command, streams: &mut Streams<'_>) -> Outcome {
    match command {
        Command::Check { files, format, limits } => {
            input::check(&files, limits.over(Budget::EMITTED), format, streams)
        }
        Command::Explain { subject, task, format, limits } => {
            tell::explain(&subject, task.as_deref(), format, limits.with_guards(), streams)
        }
        Command::Diff { first, second, limits } => {
            tell::difference(&first, &second, limits.shown(), streams)
        }
        Command::Run(arguments) => run::run(&arguments, streams),
        Command::Fmt { files, check } => layout::run(&files, check, streams),
        Command::Automaton(arguments) => automaton::run(&arguments, streams),
        Command::Lsp { stdio: _ } => lsp::serve(streams.input, streams.out.stream)
            .map(|ended| if ended { Exit::Success } else { Exit::Mistaken })
            .map_err(|error| format!("the connection fails: {error}")),
        Command::Policy { file, output } => write_policy(&file, output, streams),
    }
}

/// Writes the mistake in the arguments, or the help that they ask for. Clap would end the process
/// itself.
fn usage(error: &clap::Error, streams: &mut Streams<'_>) -> Exit {
    let output = if error.use_stderr() { &mut streams.err } else { &mut streams.out };
    let text = error.render().to_string();
    let _ = match (output.style, streams::shown(&text)) {
        (Style::Coloured, Cow::Borrowed(_)) => write!(output.stream, "{}", error.render().ansi()),
        (_, shown) => write!(output.stream, "{shown}"),
    };
    if error.use_stderr() { Exit::Failed } else { Exit::Success }
}

/// The end of a command. `Err` is a fault of the arguments or of a file, as a sentence without the
/// name of the program.
type Outcome = Result<Exit, String>;

/// `tltlc policy`: a saved policy as Rust.
fn write_policy(file: &Path, output: Option<PathBuf>, streams: &mut Streams<'_>) -> Outcome {
    let name = file.display();
    let rust = policy::rust(&streams.read(file)?).map_err(|error| format!("{name}: {error}"))?;
    match output {
        None => streams.print(&rust),
        Some(path) => streams::write(&path, &rust),
    }
}
