//! The command line: arguments in, any stage of the compiler out.
//!
//! Exit codes: 0 all is well; 1 a source has mistakes, two tasks differ, a trajectory does not
//! satisfy its task, or a file is not laid out; 2 the arguments or a file are at fault.

mod arguments;
mod automaton;
mod input;
mod layout;
mod record;
mod run;
mod subject;
mod tell;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args, Parser, Subcommand, ValueEnum};
use tltl_compiler::emit::policy;

/// The exit code of what is wrong with a source or a trajectory, not with the arguments.
const MISTAKEN: u8 = 1;

/// Compiles scTLTL task specifications to automata, and policies to Rust.
#[derive(Parser)]
#[command(
    name = "tltlc",
    version,
    about,
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
    /// Checks task files: reports every mistake and warning, writes nothing.
    Check {
        /// The task files; `-` is the standard input.
        #[arg(required = true)]
        files: Vec<PathBuf>,
        /// How to report.
        #[arg(long, value_enum, default_value_t = Report::Human)]
        format: Report,
    },
    /// Tells in plain English what a task asks for, and what each automaton state still does.
    Explain {
        /// A formula, a task file, or FILE:TASK.
        #[arg(value_name = "FORMULA|FILE")]
        subject: String,
        /// The task of the file; may be left out if there is only one.
        #[arg(long)]
        task: Option<String>,
    },
    /// Tells whether two tasks mean the same; if not, shows a shortest trajectory between them.
    ///
    /// Propositions are the same if they have the same name.
    Diff {
        /// A formula, a task file with one task, FILE:TASK, or an automaton in HOA.
        #[arg(value_name = "FORMULA|FILE[:TASK]")]
        first: String,
        /// The other one.
        #[arg(value_name = "FORMULA|FILE[:TASK]")]
        second: String,
    },
    /// Runs a recorded trajectory: verdict, robustness, and the automaton row by row.
    Run(Run),
    /// Lays out task files in place; comments, spellings and line breaks stay.
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
    /// The task file; `-` is the standard input.
    #[arg(required_unless_present_any = ["formula", "formulas"])]
    file: Option<PathBuf>,
    /// The task of the file; may be left out if there is only one.
    #[arg(long, requires = "file")]
    task: Option<String>,
    /// A formula whose names are free propositions.
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
}

#[derive(Args)]
struct Run {
    /// A task file or FILE:TASK; or a formula, whose propositions are read as robustness.
    #[arg(value_name = "FILE|FORMULA")]
    subject: String,
    /// The trajectory, CSV or JSON Lines, one state a row; `-` is the standard input. Columns have
    /// the names of the state's fields: `x`, `pose.x`, `joints[2]`; others are ignored.
    trace: PathBuf,
    /// The task of the file, with what it takes: `deliver(apple, fridge)`; may be left out if there
    /// is only one.
    #[arg(long)]
    task: Option<String>,
    /// The form to write.
    #[arg(long, value_enum, default_value_t = RowFormat::Text)]
    format: RowFormat,
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
}

/// Runs the command that the process was given.
pub(crate) fn run() -> ExitCode {
    let outcome = match Arguments::parse().command {
        Command::Check { files, format } => input::check(&files, format),
        Command::Explain { subject, task } => tell::explain(&subject, task.as_deref()),
        Command::Diff { first, second } => tell::difference(&first, &second),
        Command::Run(arguments) => run::run(&arguments),
        Command::Fmt { files, check } => layout::run(&files, check),
        Command::Automaton(arguments) => automaton::run(&arguments),
        Command::Policy { file, output } => write_policy(&file, output),
    };
    outcome.unwrap_or_else(|message| {
        input::complain(&format!("tltlc: {message}"));
        ExitCode::from(2)
    })
}

/// What a command ends with; `Err` is a fault of the arguments or of a file.
type Outcome = Result<ExitCode, String>;

fn write_policy(file: &Path, output: Option<PathBuf>) -> Outcome {
    let name = file.display();
    let rust = policy::rust(&input::read(file)?).map_err(|error| format!("{name}: {error}"))?;
    match output {
        None => print(&rust),
        Some(path) => std::fs::write(&path, rust)
            .map(|()| ExitCode::SUCCESS)
            .map_err(|error| format!("cannot write {}: {error}", path.display())),
    }
}

/// Writes to the standard output; a reader that went away is not a fault.
fn print(text: &str) -> Outcome {
    let mut out = std::io::stdout().lock();
    let end = if text.ends_with('\n') || text.is_empty() { "" } else { "\n" };
    match write!(out, "{text}{end}").and_then(|()| out.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(format!("cannot write: {error}"))
        }
        _ => Ok(ExitCode::SUCCESS),
    }
}
