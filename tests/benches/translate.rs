//! From formula to minimal automaton: families that grow, their states asserted, the time beside
//! what others measured, and how it grows. Then from automaton to text, in each form that lists all
//! edges, the edges asserted.
//!
//! `cargo bench -p tltl-tests --bench translate`. Times are the least of some repetitions on this
//! machine. The figures for Spot are *from elsewhere*: its finite-trace translation, in process, on
//! an idle machine with two cores; they are anchors, not measurements of this bench.

use std::fmt::Write as _;
use std::hint::black_box;
use std::time::Instant;

use tltl_compiler::check;
use tltl_compiler::compile;
use tltl_compiler::minimize::minimize;
use tltl_compiler::source::Source;
use tltl_compiler::translate::{Budget, translate};
use tltlc::emit::{dot, hoa, json, mermaid};

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

/// The time that it takes to write an automaton, beside that of making it, in milliseconds.
fn written() {
    println!("\n{:<22}{:>5}{:>9}", "family", "n", "edges");
    let is_large = |case: &Case| ["unordered goals", "reach-avoid"].contains(&case.family);
    for case in cases().into_iter().filter(|case| is_large(case) && case.n <= 12) {
        let source = Source::new("formula", case.formula.as_str());
        let dfa = compile::formula(&source, Budget::SHOWN)
            .expect("it is a formula")
            .automata
            .remove(0)
            .dfa;
        let size = dfa.size();
        let edges = size.edges + size.self_loops;
        print!("{:<22}{:>5}{edges:>9}", case.family, case.n);
        for form in ["json", "hoa", "dot", "mermaid"] {
            let made = || {
                let text = match form {
                    "json" => json::automaton("", &dfa),
                    "hoa" => hoa::automaton("", &dfa),
                    "dot" => dot::automaton("", &dfa),
                    _ => mermaid::automaton("", &dfa),
                };
                text.expect("it is small enough")
            };
            let lines = made().to_string().lines().count();
            assert!((edges..edges + 2 * dfa.len()).contains(&lines), "{form} has {lines} lines");
            let (mut least, mut bytes) = (f64::INFINITY, Bytes::default());
            for _ in 0..5 {
                bytes.0 = 0;
                let start = Instant::now();
                write!(bytes, "{}", made()).expect("nothing fails");
                least = least.min(start.elapsed().as_secs_f64() * 1e3);
            }
            print!("{form:>9} {least:.1} ms, {:.1} MB", bytes.0 as f64 / 1e6);
        }
        println!();
    }
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
