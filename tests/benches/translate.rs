//! From formula to minimal automaton: families that grow, their states asserted, the time beside
//! what others measured, and how it grows. Then from automaton to text, in each form that lists all
//! edges, the edges asserted.
//!
//! `cargo bench -p tltl-tests --bench translate`; with `TLTLC=target/release/tltlc` (a path from
//! `tests`, or absolute) before it, the times of whole runs of the tool too. Times are the least of some repetitions on this
//! machine. The figures for Spot are *from elsewhere*: its finite-trace translation, in process, on
//! an idle machine with two cores; they are anchors, not measurements of this bench.

use std::ffi::OsStr;
use std::fmt::{Display, Write as _};
use std::hint::black_box;
use std::process::{Command, Stdio};
use std::time::Instant;

use tltl_compiler::check;
use tltl_compiler::compile;
use tltl_compiler::dfa::Dfa;
use tltl_compiler::minimize::minimize;
use tltl_compiler::source::Source;
use tltl_compiler::translate::{Budget, translate};
use tltlc::emit::{dot, hoa, json, mermaid, rust};

struct Case {
    family: &'static str,
    n: usize,
    formula: String,
    states: usize,
    /// Milliseconds that Spot takes, from elsewhere.
    spot: Option<(f64, f64)>,
}

fn main() {
    let header = ["family", "n", "states", "parse+check", "translate", "minimize", "all, ms"];
    let [family, n, states, check, translate, minimize, all] = header;
    println!(
        "{family:<22}{n:>5}{states:>8}{check:>13}{translate:>11}{minimize:>10}{all:>10}  \
         {:>22}  growth",
        "Spot (from elsewhere)"
    );
    let mut before: Option<(&str, usize, f64)> = None;
    for case in cases() {
        let [check, translate, minimize] = measured(&case);
        let all = check + translate + minimize;
        let spot = match case.spot {
            Some((least, most)) if least == most => format!("{least}: {:.0} x", least / all),
            Some((least, most)) => format!("{least}-{most}: {:.0} x", least / all),
            None => String::new(),
        };
        let growth = before.filter(|(family, ..)| *family == case.family).map(|(_, n, time)| {
            let power = (all / time).ln() / (case.n as f64 / n as f64).ln();
            format!("n^{power:.1}")
        });
        println!(
            "{:<22}{:>5}{:>8}{check:>13.3}{translate:>11.3}{minimize:>10.3}{all:>10.3}  {spot:>22}  {}",
            case.family,
            case.n,
            case.states,
            growth.unwrap_or_default()
        );
        before = Some((case.family, case.n, all));
    }
    println!("\npeak memory {} MiB", peak());
    written();
}

/// The formulas of the table of forms: a family, its size, and the edges of the automaton; `None`
/// where they are too many to be written.
fn forms_of() -> Vec<(&'static str, usize, String, Option<usize>)> {
    let goals = |n, goal: &dyn Fn(&String) -> String| {
        names("a", n).iter().map(goal).collect::<Vec<_>>().join(" && ")
    };
    let eventually = |a: &String| format!("F {a}");
    let until = names("a", 15).into_iter().reduce(|until, a| format!("({until} U {a})"));
    vec![
        ("unordered goals", 10, goals(10, &eventually), Some(3_usize.pow(10))),
        ("unordered goals", 12, goals(12, &eventually), Some(3_usize.pow(12))),
        (
            "reach-avoid",
            12,
            goals(12, &|a| format!("(!h U {a})")),
            Some(3_usize.pow(12) + (1 << 12)),
        ),
        ("nested U", 14, until.unwrap_or_default(), None),
        ("F[0,n] a", 10_000, "F[0,10000] a".to_owned(), Some(20_004)),
        ("a U[0,n] b", 1_000, "a U[0,1000] b".to_owned(), Some(3_004)),
    ]
}

/// A form as the tool calls it, and the automaton in it; `None` if it is too large for the form.
type Form = (&'static str, for<'a> fn(&'a Source, &'a Dfa) -> Option<Box<dyn Display + 'a>>);

/// The forms that list all edges. Rust is within the limits of the macros.
const FORMS: [Form; 5] = [
    ("json", |_, dfa| Some(Box::new(json::automaton("", dfa).ok()?))),
    ("hoa", |_, dfa| Some(Box::new(hoa::automaton("", dfa).ok()?))),
    ("dot", |_, dfa| Some(Box::new(dot::automaton("", dfa).ok()?))),
    ("mermaid", |_, dfa| Some(Box::new(mermaid::automaton("", dfa).ok()?))),
    ("rust", |source, _| {
        let compiled = compile::formula(source, Budget::EMITTED).ok()?;
        Some(Box::new(rust::file(&compiled)))
    }),
];

/// The CPU time that it takes to write an automaton, or to say that it is too large, in
/// milliseconds of this process, and that of `tltlc automaton` from the text of the formula to that of the
/// automaton, over one of `F a`, if `TLTLC` names that program. Rust includes making the automaton.
fn written() {
    let program = std::env::var_os("TLTLC");
    println!(
        "\n{:<17}{:>6}{:>8}{:>9}  {:>27}",
        "family", "n", "edges", "make, ms", "form: ms here / of tltlc, MB"
    );
    for (family, n, formula, edges) in forms_of() {
        let source = Source::new("formula", formula.as_str());
        let (dfa, making) = spent(|| {
            compile::formula(&source, Budget::SHOWN).expect("it is small").automata.remove(0).dfa
        });
        let count = edges.map_or("-".to_owned(), |edges| edges.to_string());
        print!("{family:<17}{n:>6}{count:>8}{making:>9.1}");
        for (form, made) in FORMS {
            let (bytes, here) = spent(|| {
                let mut bytes = Bytes::default();
                let text = made(&source, &dfa);
                text.map(|text| write!(bytes, "{text}").map(|()| bytes).expect("nothing fails"))
            });
            if let (Some(text), Some(edges), true) = (made(&source, &dfa), edges, form != "rust") {
                let lines = text.to_string().lines().count();
                assert!(
                    (edges..edges + 2 * dfa.len() + 9).contains(&lines),
                    "{form}: {lines} lines"
                );
            }
            let as_expected = form == "rust" || bytes.is_some() == edges.is_some();
            assert!(as_expected, "{family} as {form}");
            print!("  {form}: {here:.1}");
            if let Some(program) = &program {
                let empty = process(program, form, "F a");
                print!(" / {:.0}", process(program, form, &formula) - empty);
            }
            match bytes {
                Some(Bytes(bytes)) => print!(", {:.1}", bytes as f64 / 1e6),
                None => print!(", refused"),
            }
        }
        println!();
    }
}

/// What `work` gives, and its CPU milliseconds: the mean of as many times as fill a fifth of a
/// second, for the system counts in steps of some milliseconds; by the clock where it does not say.
fn spent<T>(work: impl Fn() -> T) -> (T, f64) {
    let start = Instant::now();
    let now = || {
        let spent = std::fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
        let spent = spent.split(' ').next().and_then(|field| field.parse::<f64>().ok());
        spent.map_or_else(|| start.elapsed().as_secs_f64() * 1e3, |nanoseconds| nanoseconds / 1e6)
    };
    let (before, mut times) = (now(), 0.0);
    loop {
        let result = black_box(work());
        times += 1.0;
        if now() - before > 200.0 {
            return (result, (now() - before) / times);
        }
    }
}

/// The CPU milliseconds of a run of the tool, the mean of twenty: those that the system counts are
/// ten each.
fn process(program: &OsStr, form: &str, formula: &str) -> f64 {
    let ticks = || {
        let status = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
        let fields = status.rsplit(')').next().unwrap_or_default().split_whitespace();
        fields.skip(13).take(2).filter_map(|field| field.parse::<f64>().ok()).sum::<f64>()
    };
    let (start, runs) = (ticks(), 20);
    for _ in 0..runs {
        let arguments = ["automaton", "--formula", formula, "--format", form];
        let run = Command::new(program)
            .args(arguments)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        run.expect("TLTLC is a program");
    }
    (ticks() - start) * 10.0 / f64::from(runs)
}

/// How much was written.
#[derive(Default)]
struct Bytes(usize);

impl std::fmt::Write for Bytes {
    fn write_str(&mut self, piece: &str) -> std::fmt::Result {
        self.0 += piece.len();
        Ok(())
    }
}

/// The milliseconds of parsing and checking, translation and minimisation.
fn measured(case: &Case) -> [f64; 3] {
    let mut least = [f64::INFINITY; 3];
    let start = Instant::now();
    let mut rounds = 0;
    while rounds < 3 || start.elapsed().as_secs_f64() < 0.3 {
        for (least, time) in least.iter_mut().zip(once(case)) {
            *least = least.min(time);
        }
        rounds += 1;
        if start.elapsed().as_secs_f64() > 5.0 {
            break;
        }
    }
    least
}

fn once(case: &Case) -> [f64; 3] {
    let milliseconds = |start: Instant| start.elapsed().as_secs_f64() * 1e3;
    let start = Instant::now();
    let source = Source::new("formula", case.formula.as_str());
    let module = check::formula(black_box(&source)).expect("it is a formula");
    let checked = milliseconds(start);
    let start = Instant::now();
    let raw = translate(&module.tasks[0].spec, Budget::SHOWN).expect("it is within the budget");
    let translated = milliseconds(start);
    let start = Instant::now();
    let minimal = minimize(black_box(&raw));
    let minimized = milliseconds(start);
    assert_eq!(minimal.len(), case.states, "{} {}", case.family, case.n);
    [checked, translated, minimized]
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    let mut add = |family, n: usize, formula: String, states, spot: Option<(f64, f64)>| {
        cases.push(Case { family, n, formula, states, spot });
    };
    for (n, spot) in [(10, None), (20, Some((15.0, 33.0))), (40, None), (80, None), (160, None)] {
        add("nested goals", n, nested(n), n + 1, spot);
    }
    for (n, spot) in
        [(10, None), (20, None), (40, Some((8.5, 8.5))), (80, Some((27.0, 41.0))), (160, None)]
    {
        add("ordered goals (U)", n, ordered(n), n + 2, spot);
    }
    for (n, spot) in [(40, Some((8.5, 8.5))), (80, Some((27.0, 41.0))), (160, None)] {
        add("then-chain (T)", n, names("a", n).join(" T "), n + 1, spot);
    }
    for (n, spot) in [(8, None), (10, Some((33.0, 33.0))), (12, Some((139.0, 139.0))), (14, None)] {
        let goals: Vec<_> = names("a", n).iter().map(|a| format!("F {a}")).collect();
        let spot = if n == 14 { Some((40_000.0, 40_000.0)) } else { spot };
        add("unordered goals", n, goals.join(" && "), 1 << n, spot);
    }
    for (n, spot) in [(8, None), (10, None), (12, Some((520.0, 520.0)))] {
        let goals: Vec<_> = names("a", n).iter().map(|a| format!("(!h U {a})")).collect();
        add("reach-avoid", n, goals.join(" && "), (1 << n) + 1, spot);
    }
    for (n, spot) in [(8, None), (12, None), (16, Some((1_700.0, 1_700.0)))] {
        let formula = format!("F(a && {}b)", "X ".repeat(n));
        add("F(a && X^n b)", n, formula, (1 << n) + 1, spot);
    }
    for n in [100, 1000, 10_000] {
        add("F[0,n] a", n, format!("F[0,{n}] a"), n + 3, None);
    }
    for n in [100, 1000, 10_000] {
        add("a U[0,n] b", n, format!("a U[0,{n}] b"), n + 3, None);
    }
    for n in [10, 100, 300] {
        let formula = format!("F[0,{n}] (a && F[0,{n}] b)");
        add("F[0,n](a && F[0,n] b)", n, formula, (n + 2) * (n + 3) / 2, None);
    }
    cases
}

fn names(prefix: &str, n: usize) -> Vec<String> {
    (1..=n).map(|i| format!("{prefix}{i}")).collect()
}

/// `F(a1 && X F(a2 && …))`
fn nested(n: usize) -> String {
    let mut formula = String::new();
    for (i, name) in names("a", n).iter().enumerate() {
        let _ = write!(formula, "{}F({name}", if i == 0 { "" } else { " && X " });
    }
    formula + &")".repeat(n)
}

/// `(!a2 U a1) && (!a3 U a2) && … && F an`
fn ordered(n: usize) -> String {
    let names = names("a", n);
    let mut formula = String::new();
    for pair in names.windows(2) {
        let _ = write!(formula, "(!{} U {}) && ", pair[1], pair[0]);
    }
    formula + &format!("F {}", names[n - 1])
}

/// The largest memory of this process, in MiB; 0 where the system does not say.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<u64>().ok());
    kib.unwrap_or(0) / 1024
}
