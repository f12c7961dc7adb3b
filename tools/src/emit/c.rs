//! A task as a C99 header: its automaton, its predicates, and the monitor that reads one state at a
//! time.
//!
//! The header is all that a program needs: it includes `<math.h>`, `<stdbool.h>` and `<stdint.h>`,
//! allocates nothing, has no state outside of what the caller holds, and calls nothing but functions of
//! `<math.h>` that a predicate names. It is C++ too. Its functions give the bits of the generated Rust,
//! where the C compiler keeps to IEEE 754.
//!
//! | in C | what it does |
//! | --- | --- |
//! | `T_next(&q, &s)` | moves the state of the automaton, one integer; 0, or which predicate is not a number |
//! | `T_verdict(q)`, `T_distance(q)` | satisfied, lost or open; the moves that are left |
//! | `T_progress(q, &s)`, `T_rho(i, &s)`, `T_holds(i, &s)` | robustness of progress, and the predicates |
//! | `T_start(&m)`, `T_step(&m, &s)` | a monitor with the robustness so far, and what it can still become |
//!
//! # Limits
//!
//! A predicate that is Rust code, a parameter of a Rust type, a factored task, and an automaton without
//! a formula are refused; so is an automaton with more states, nodes or literals than 16 bits count.
//! A formula that cannot be [followed](Unfollowed) has no monitor, only the automaton, and its header
//! says why.
//!
//! ```
//! use tltl_compiler::translate::Budget;
//!
//! let task = tltlc::task::compile("!wet U home", Budget::default())?;
//! let compiled = task.entry().file().compiled();
//! let header = tltlc::emit::c::header(&compiled.module, task.entry().task(), task.dfa())?;
//! assert!(header.contains("static inline int task_step(task_monitor *m, const task_state *s)"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod names;
mod online;
mod predicates;

use std::fmt::{self, Write as _};

use tltl_compiler::dfa::Dfa;
use tltl_compiler::emit::rust::sizes;
use tltl_compiler::predicate::{Module, Task};
use tltl_compiler::source::visible;
use tltl_compiler::tables::{Tables, Transitions, tables};

use names::Names;
use online::Monitor;
use predicates::{Reading, Types};

/// Why a task has no header.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refused {
    /// A predicate is Rust code, of this text.
    Rust(String),
    /// A parameter of the task, of this name, has a type of Rust.
    Parameter(String),
    /// There are more of these than 65,535.
    Large(&'static str, usize),
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rust(text) => write!(f, "`{text}` is Rust code, which a C program cannot run"),
            Self::Parameter(name) => {
                write!(
                    f,
                    "the type of the parameter `{name}` is one of Rust, which C does not have"
                )
            }
            Self::Large(what, count) => {
                write!(f, "the automaton has {count} {what}, and a C header up to {MOST}")
            }
        }
    }
}

impl std::error::Error for Refused {}

/// Why the robustness of a formula is not followed while a trajectory grows.
///
/// A maximum of minima is no minimum of maxima: where φ ∧ ψ may start at several instants, two numbers
/// do not say whether both start at the same one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unfollowed {
    /// An operand of an operator that would have to be a state formula.
    Form {
        /// The operator.
        operator: &'static str,
        /// Its operand.
        operand: String,
    },
    /// There are so many operators, where so many are allowed.
    Operators(usize, usize),
    /// The windows of the bounds have so many cells, where so many are allowed.
    Cells(usize, usize),
}

impl fmt::Display for Unfollowed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Form { operator: "&&", operand } => write!(
                f,
                "below F, U, T and bounds one side of && is a condition on one state, and `{operand}` is not"
            ),
            Self::Form { operator, operand } => write!(
                f,
                "what {operator} asks for meanwhile is a condition on one state, and `{operand}` is not"
            ),
            Self::Operators(found, most) => {
                write!(f, "the formula has {found} operators, and a monitor follows up to {most}")
            }
            Self::Cells(found, most) => {
                write!(f, "the bounds add up to {found} steps, and a monitor follows up to {most}")
            }
        }
    }
}

/// The largest number of 16 bits.
const MOST: usize = u16::MAX as usize;

/// The names of what every header has, without its prefix.
const OURS: [&str; 36] = [
    "state",
    "arguments",
    "monitor",
    "STATES",
    "PREDICATES",
    "INITIAL",
    "TLTL_H",
    "ACCEPTING",
    "TRAP",
    "min",
    "max",
    "less",
    "greater",
    "positive",
    "not_negative",
    "zero",
    "index",
    "rho",
    "holds",
    "name",
    "next",
    "verdict",
    "distance",
    "progress",
    "start",
    "step",
    "delay",
    "slide_min",
    "slide_max",
    "fill",
    "cell",
    "push",
    "lower",
    "forget",
    "rho_",
    "holds_",
];

/// The header of a task, whose automaton is `dfa`.
///
/// # Errors
/// If a part of the task cannot be written in C.
pub fn header(module: &Module, task: &Task, dfa: &Dfa) -> Result<String, Refused> {
    let names = Names::new(task.name.as_deref().unwrap_or("task"), &OURS);
    let mut types = Types::new(module, names);
    let declarations = types.declarations(task)?;
    let fixed = Fixed {
        prefix: types.names.prefix.clone(),
        state: types.state.clone(),
        has_arguments: !task.parameters.is_empty(),
    };
    let mut readings = String::new();
    for (i, predicate) in task.predicates.iter().enumerate() {
        let condition = module.predicates[predicate.0 as usize].condition;
        for (reading, declared) in
            [(Reading::Robustness, "double $_rho_"), (Reading::Truth, "int $_holds_")]
        {
            readings += &fixed.text(&format!("static inline {declared}{i}($Aconst $S *s)\n{{\n"));
            let body = types.body(condition, reading)?;
            let _ = writeln!(readings, "{}{body}}}\n", fixed.unused_in(&body));
        }
    }
    let tables = tables(dfa);
    let monitor = online::monitor(&task.spec, &fixed.prefix);
    let mut functions = readings;
    functions += &fixed.text(&all_predicates(&tables));
    functions += &fixed.text(&automaton(&tables)?);
    if let Ok(monitor) = &monitor {
        functions += &fixed.text(&monitor_of(monitor, tables.propositions.len()));
    }
    let mut text = about(task, dfa, &monitor);
    text += &fixed.text(PREAMBLE);
    text += &declarations;
    text += &fixed.helpers(&functions);
    text += &functions;
    text += "#endif\n";
    Ok(text)
}

/// What stands for `$` in the text of this module.
struct Fixed {
    prefix: String,
    state: String,
    has_arguments: bool,
}

impl Fixed {
    /// `$_` is the prefix, `$S` the type of the state, `$A` the parameter for the arguments of the
    /// task, `$P` what is passed on for it, `$U` the statements of a function that uses neither.
    fn text(&self, template: &str) -> String {
        let (parameter, passed) = match self.has_arguments {
            true => ("const $_arguments *p, ", "p, "),
            false => ("", ""),
        };
        let text = template.replace("$A", parameter).replace("$P", passed);
        let text = text.replace("$U", &self.unused_in(""));
        text.replace("$_", &format!("{}_", self.prefix)).replace("$S", &self.state)
    }

    /// Statements that use the parameters that a function does not use.
    fn unused_in(&self, body: &str) -> String {
        let names = if self.has_arguments { &["p", "s"][..] } else { &["s"] };
        let unused = names.iter().filter(|name| !body.contains(&format!("{name}->")));
        unused.map(|name| format!("    (void){name};\n")).collect()
    }

    /// The helpers that some functions call, and those that these call, in their order.
    fn helpers(&self, functions: &str) -> String {
        let mut needed = String::new();
        for helper in HELPERS.split("\n\n").collect::<Vec<_>>().into_iter().rev() {
            let name = helper.split("$_").nth(1).and_then(|rest| rest.split('(').next());
            let call = self.text(&format!("$_{}(", name.unwrap_or_default()));
            if functions.contains(&call) || needed.contains(&call) {
                needed = self.text(helper.trim_end()) + "\n\n" + &needed;
            }
        }
        needed
    }
}

/// Text of the author's within a comment, which it must not end.
fn comment(text: &str) -> String {
    visible(text).replace("*/", "* /").replace("/*", "/ *")
}

/// A string of C: octal escapes for all but ASCII, and for what could begin a trigraph.
fn string(text: &str) -> String {
    let mut written = "\"".to_owned();
    for byte in text.bytes() {
        match byte {
            b'"' | b'\\' | b'?' => written.extend(['\\', byte.into()]),
            b' '..=b'~' => written.push(byte.into()),
            byte => {
                let _ = write!(written, "\\{byte:03o}");
            }
        }
    }
    written + "\""
}

/// The comment at the top.
fn about(task: &Task, dfa: &Dfa, monitor: &Result<Monitor, Unfollowed>) -> String {
    let mut text = format!("/* {}: {}\n", comment(&task.title()), comment(&task.text));
    for line in &task.docs {
        let _ = writeln!(text, " * {}", comment(line.trim()));
    }
    let version = env!("CARGO_PKG_VERSION");
    let _ = write!(
        text,
        " *\n * {} Written by tltlc {version}; C99, and C++.\n * Predicates:\n",
        sizes(dfa)
    );
    for (i, one) in dfa.propositions.iter().enumerate() {
        let _ = writeln!(text, " *   {i}: {}", comment(&one.name));
    }
    if let Err(why) = monitor {
        let why = comment(&why.to_string());
        let _ = writeln!(text, " *\n * There is no monitor of the robustness: {why}.");
    }
    text + " */\n"
}

/// The functions that choose a predicate by its number.
fn all_predicates(tables: &Tables) -> String {
    let mut text = String::new();
    let count = tables.propositions.len();
    for (kind, name, none) in [("double", "rho", "NAN"), ("int", "holds", "-1")] {
        let what = if name == "rho" { RHO } else { HOLDS };
        let _ =
            write!(text, "{what}static inline {kind} $_{name}(unsigned i, $Aconst $S *s)\n{{\n");
        text += if count == 0 { "$U" } else { "" };
        text += "    switch (i) {\n";
        for i in 0..count {
            let _ = writeln!(text, "    case {i}: return $_{name}_{i}($Ps);");
        }
        let _ = writeln!(text, "    default: return {none};\n    }}\n}}\n");
    }
    text += "/* What predicate i is called. */\nstatic inline const char *$_name(unsigned i)\n{\n    switch (i) {\n";
    for (i, name) in tables.propositions.iter().enumerate() {
        let name = string(name).replace('$', "\\044");
        let _ = writeln!(text, "    case {i}: return {name};");
    }
    text + "    default: return \"\";\n    }\n}\n\n"
}

/// The automaton.
fn automaton(tables: &Tables) -> Result<String, Refused> {
    let states = tables.states as usize;
    let count = tables.propositions.len();
    fits("states", states)?;
    fits("predicates", count)?;
    let literals = tables.guards[states] as usize;
    fits("literals of progress", literals)?;
    let mut text = format!("enum {{ $_STATES = {states}, $_PREDICATES = {count}, $_INITIAL = 0");
    let ends = [("ACCEPTING", tables.accepting, 1), ("TRAP", tables.trap, -1)];
    let mut verdicts = String::new();
    for (name, q, verdict) in ends {
        if let Some(q) = q {
            let _ = write!(text, ", $_{name} = {q}");
            let _ = writeln!(verdicts, "    case $_{name}: return {verdict};");
        }
    }
    text += " };\n\n";
    text += NEXT;
    match &tables.transitions {
        Transitions::Table { class, width, next } => {
            text += &array("class_of", class.iter().copied());
            text += &array("next", next.iter().map(|&q| q as u16));
            text += "    unsigned letter = 0;\n";
            text += if count == 0 { "$U" } else { "    int holds;\n" };
            text += "    if (*q >= $_STATES) return -1;\n";
            for i in 0..count {
                let _ = writeln!(text, "    holds = $_holds_{i}($Ps);");
                let _ = writeln!(text, "    if (holds < 0) return {};", i + 1);
                let _ = writeln!(text, "    letter |= (unsigned)holds << {i};");
            }
            let _ = writeln!(
                text,
                "    *q = next[*q * {width}u + class_of[letter]];\n    return 0;\n}}\n"
            );
        }
        Transitions::Diagram { nodes, roots } => {
            fits("nodes and states", nodes.len() + states)?;
            let reference = |at: u32| match at.checked_sub(Transitions::LEAF) {
                Some(q) => (nodes.len() + q as usize) as u16,
                None => at as u16,
            };
            let fields = nodes
                .iter()
                .flat_map(|&[i, low, high]| [i as u16, reference(low), reference(high)]);
            text += &array("nodes", fields);
            text += &array("roots", roots.iter().map(|&root| reference(root)));
            let _ = write!(text, "{}", DESCEND.replace("NODES", &nodes.len().to_string()));
        }
    }
    text += &VERDICT.replace("CASES", &verdicts);
    text += DISTANCE;
    text += &array("moves", tables.distance.iter().map(|&n| u16::try_from(n).unwrap_or(u16::MAX)));
    text += "    return q < $_STATES ? moves[q] : UINT16_MAX;\n}\n\n";
    text += PROGRESS;
    text += &array("from", tables.guards[..=states].iter().map(|&at| at as u16));
    text += &array("literals", tables.literals[..literals].iter().copied());
    text += GUARD;
    Ok(text)
}

fn fits(what: &'static str, count: usize) -> Result<(), Refused> {
    if count <= MOST { Ok(()) } else { Err(Refused::Large(what, count)) }
}

/// An array of the narrowest type that holds its entries.
fn array(name: &str, entries: impl Iterator<Item = impl Into<i64>>) -> String {
    let mut entries: Vec<i64> = entries.map(Into::into).collect();
    if entries.is_empty() {
        entries.push(0);
    }
    let within = |low: i64, high: i64| entries.iter().all(|&entry| low <= entry && entry <= high);
    let kind = match () {
        () if within(0, 255) => "uint8_t",
        () if within(0, MOST as i64) => "uint16_t",
        () if within(-128, 127) => "int8_t",
        () if within(-32768, 32767) => "int16_t",
        () => "int32_t",
    };
    let mut text = format!("    static const {kind} {name}[{}] = {{", entries.len());
    for (i, entry) in entries.iter().enumerate() {
        let space = if i % 16 == 0 { "\n        " } else { " " };
        let _ = write!(text, "{space}{entry},");
    }
    text + "\n    };\n"
}

/// The monitor.
fn monitor_of(monitor: &Monitor, count: usize) -> String {
    let Monitor { members, start, step, interval: [lower, upper] } = monitor;
    let mut text = format!(
        "/* Follows one trajectory. `lower` is the robustness so far, `upper` the greatest that it can still\n \
         * become if later predicates may have any value, `q` the state of the automaton. */\n\
         typedef struct {{\n    double lower, upper;\n{members}    uint16_t q, t;\n    bool begun;\n}} $_monitor;\n\n\
         /* Before the first state. */\nstatic inline void $_start($_monitor *m)\n{{\n    \
         m->lower = -INFINITY;\n    m->upper = INFINITY;\n{start}    m->q = $_INITIAL;\n    m->t = 0;\n    \
         m->begun = false;\n}}\n\n{STEP}"
    );
    for i in 0..count {
        let _ = writeln!(text, "    const double r{i} = $_rho_{i}($Ps);");
    }
    for i in 0..count {
        let _ = writeln!(text, "    if (r{i} != r{i}) return {};", i + 1);
    }
    let _ = write!(
        text,
        "    const double now = m->begun ? -INFINITY : INFINITY;\n{step}    m->lower = {lower};\n    \
         m->upper = {upper};\n    m->q = q;\n    m->begun = true;\n    m->t++;\n    return 0;\n}}\n\n"
    );
    text
}

const PREAMBLE: &str = r#"#ifndef $_TLTL_H
#define $_TLTL_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#ifdef __FAST_MATH__
#error "NaN and infinity have a meaning here: compile without -ffast-math"
#endif

"#;

/// Functions that only some headers need, an empty line between them, each after those that it calls.
/// Sliding windows are those of van Herk (1992) and of Gil and Werman (1993), monotone queues those of
/// Lemire (2006), as in the runtime.
const HELPERS: &str = include_str!("c/helpers.h");

const RHO: &str = "/* By how much predicate i holds: positive if it does, negative if not, NaN if that is not known. */\n";
const HOLDS: &str =
    "/* Whether predicate i holds: 1 or 0, or -1 if that is not known, for a number is NaN. */\n";

const NEXT: &str = r"/* Moves the state of the automaton, which begins at $_INITIAL: 0 if it did, 1 + i if predicate i is
 * not a number, -1 if q is no state. Otherwise q stays as it is. */
static inline int $_next(uint16_t *q, $Aconst $S *s)
{
";

const DESCEND: &str = r"    unsigned at;
    if (*q >= $_STATES) return -1;
    at = roots[*q];
    while (at < NODESu) {
        const int holds = $_holds(nodes[3 * at], $Ps);
        if (holds < 0) return 1 + nodes[3 * at];
        at = nodes[3 * at + 1 + (unsigned)holds];
    }
    *q = (uint16_t)(at - NODESu);
    return 0;
}

";

const VERDICT: &str = r"/* 1 if the task is satisfied, -1 if it is lost, 0 while it can go either way. */
static inline int $_verdict(uint16_t q)
{
    switch (q) {
CASES    default: return 0;
    }
}

";

const DISTANCE: &str = r"/* The least number of moves until it is satisfied; UINT16_MAX if there is no way. */
static inline uint16_t $_distance(uint16_t q)
{
";

const PROGRESS: &str = r"/* By how much a state moves q on, to another state that is not lost; NaN if that is not known. */
static inline double $_progress(uint16_t q, $Aconst $S *s)
{
";

const GUARD: &str = r"    double best = -INFINITY, least = INFINITY;
    unsigned k;
    if (q >= $_STATES) return NAN;
    for (k = from[q]; k < from[q + 1]; k++) {
        const int literal = literals[k];
        const double rho = literal ? $_rho((unsigned)(literal > 0 ? literal : -literal) - 1, $Ps) : 0;
        if (rho != rho) return NAN;
        if (literal) {
            least = $_less(least, literal > 0 ? rho : -rho);
        } else {
            best = $_greater(best, least);
            least = INFINITY;
        }
    }
    return best;
}

";

const STEP: &str = r"/* Reads the next state: 0 if it did, 1 + i if predicate i is not a number, and then m stays as it is. */
static inline int $_step($_monitor *m, $Aconst $S *s)
{
    uint16_t q = m->q;
    const int failed = $_next(&q, $Ps);
    if (failed != 0) return failed;
";
