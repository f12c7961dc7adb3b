//! Recordings: any bytes as one get an answer, never a crash; and one that is well-formed, in any of
//! the forms, has for each episode and row the verdict and the robustness of the states in it.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde_json::Value;
use tltl_compiler::spec::Spec;
use tltlc::cli::Exit;
use tltlc::{semantics, task};

use super::{BUDGET, tool};
use crate::random::{self, Bytes, Choices};

/// The names that formulas have here, with columns that they are mapped to.
const COLUMNS: [(&str, &str); 3] = [("a", "a"), ("b", "/odom/b"), ("c", "late, \"c\"")];

/// Numbers and truth values as CSV and JSON have them, and what they are as robustness.
const VALUES: [(&str, &str, f64); 9] = [
    ("1", "1", 1.0),
    ("0", "0", 0.0),
    ("-2.5", "-2.5", -2.5),
    ("1e3", "1e3", 1000.0),
    ("True", "\"True\"", 1.0),
    ("F", "false", -1.0),
    ("inf", "Infinity", f64::INFINITY),
    ("\"0.1\"", "0.1", 0.1),
    ("-0.0", "-0.0", 0.0),
];

/// A state: the place of each of its three numbers among [`VALUES`], and the number of its episode.
type State = ([usize; 3], u32);

/// Runs the target: the first byte chooses whether the others are a recording or the choices of one.
pub fn run(bytes: &[u8]) {
    match bytes.split_first() {
        Some((kind, rest)) if kind % 2 == 0 => anything(u32::from(kind / 2), rest),
        Some((_, rest)) => well_formed(&mut Bytes(rest)),
        None => {}
    }
}

/// Any bytes: an answer, which is a result or a message.
fn anything(options: u32, bytes: &[u8]) {
    let mut arguments = vec!["run", "a U[0,2] (b && x > 1.5)", "-"];
    for (bit, option) in ["--episode=e", "--map=x=/pose/0/x", "--format=csv"].iter().enumerate() {
        if options >> bit & 1 == 1 {
            arguments.push(option);
        }
    }
    let (exit, [out, err]) = tool(&arguments, bytes);
    let told = if exit == Exit::Failed { &err } else { &out };
    assert!(!told.is_empty(), "{arguments:?}");
    assert_eq!(exit == Exit::Failed, !err.is_empty(), "{arguments:?}: {err}");
}

fn well_formed(choices: &mut Bytes<'_>) {
    let operators = choices.choose(6);
    let formula = random::formula(choices, 3, operators);
    let Ok(task) = task::compile(&formula, BUDGET) else { return };
    if task.inputs().is_empty() {
        return;
    }
    let spec = &task.entry().task().spec;
    let states: Vec<State> = (0..1 + choices.choose(9))
        .map(|_| {
            ([(); 3].map(|()| choices.choose(VALUES.len() as u32) as usize), choices.choose(3))
        })
        .collect();
    let recording = match choices.choose(4) {
        0 => lines(choices, &states, "", "\n", ""),
        1 => lines(choices, &states, "[", ",\n", "]"),
        2 => columns(&states),
        _ => delimited(choices, &states),
    };
    let mut arguments = vec!["run", &formula, "-", "--format=json", "--episode=run"];
    let maps = COLUMNS.map(|(name, column)| format!("--map={name}={column}"));
    let is_read = |name: &str| task.inputs().iter().any(|input| input.name == name);
    let needed = COLUMNS.iter().zip(&maps).filter(|((name, _), _)| is_read(name));
    arguments.extend(needed.map(|(_, map)| map.as_str()));
    let (exit, [out, err]) = tool(&arguments, recording.as_bytes());
    assert_ne!(exit, Exit::Failed, "{err}{arguments:?}\n{recording}");
    rows(spec, &states, &out).unwrap_or_else(|what| panic!("{what}\n{arguments:?}\n{recording}"));
}

/// The rows of a result are those of the states, by the definitions.
fn rows(spec: &Spec, states: &[State], out: &str) -> Result<(), String> {
    let results = out.lines().map(|line| serde_json::from_str::<Value>(line).expect("it is JSON"));
    let mut results = results.filter(|result| result.get("row").is_some());
    let names: Vec<usize> = random::places(spec.propositions());
    let mut episodes = BTreeMap::<u32, Vec<[usize; 3]>>::new();
    for &(values, episode) in states {
        let known = episodes.entry(episode).or_default();
        known.push(values);
        let rho = |p: u32, t: usize| VALUES[known[t][names[p as usize]]].2;
        let robustness = semantics::robustness(spec, known.len(), rho);
        let satisfied = semantics::satisfied(spec, known.len(), |p, t| rho(p, t) > 0.0);
        let found = results.next().ok_or("a row is missing")?;
        let same = found["trajectory"] == format!("-: run {episode}")
            && found["row"] == known.len() - 1
            && (found["verdict"] == "satisfied") == satisfied
            && found["robustness"].as_f64() == Some(robustness).filter(|rho| rho.is_finite());
        if !same {
            return Err(format!("{found}, but {satisfied} by {robustness}"));
        }
    }
    if results.next().is_some() { Err("a row is too many".to_owned()) } else { Ok(()) }
}

/// A state as an object, some of whose keys are nested.
fn object(choices: &mut Bytes<'_>, (values, episode): State) -> String {
    let [a, b, c] = values.map(|value| VALUES[value].1);
    match choices.choose(3) {
        0 => format!(
            "{{\"run\": {episode}, \"a\": {a}, \"odom\": {{\"b\": {b}}}, \"late, \\\"c\\\"\": {c}}}"
        ),
        1 => format!(
            "{{\"/odom/b\":{b},\"late, \\\"c\\\"\":{c},\"NaN\":[\"}}\"],\"run\":\"{episode}\",\"a\":{a}}}"
        ),
        _ => format!(
            "{{ \"odom.b\": {b}, \"a\": {a}, \"late, \\\"c\\\"\": {c}, \"run\": {episode}, \"x\": NaN }}"
        ),
    }
}

/// Objects, one after the other.
fn lines(
    choices: &mut Bytes<'_>,
    states: &[State],
    before: &str,
    between: &str,
    after: &str,
) -> String {
    let objects: Vec<String> = states.iter().map(|&state| object(choices, state)).collect();
    format!("{before}{}{after}", objects.join(between))
}

/// An object of columns.
fn columns(states: &[State]) -> String {
    let column = |place: usize| {
        let values: Vec<_> = states.iter().map(|(values, _)| VALUES[values[place]].1).collect();
        values.join(", ")
    };
    let episodes: Vec<_> = states.iter().map(|(_, episode)| episode.to_string()).collect();
    format!(
        "{{\"run\": [{}],\n\"a\": [{}],\n\"odom\": {{\"b\": [{}]}},\n\"late, \\\"c\\\"\": [{}], \"n\": 1}}",
        episodes.join(", "),
        column(0),
        column(1),
        column(2)
    )
}

/// Separated values: by any of the separators, with comments, blanks and columns that nobody reads.
fn delimited(choices: &mut Bytes<'_>, states: &[State]) -> String {
    let separator = [",", ";", "\t"][choices.choose(3) as usize];
    let end = ["\n", "\r\n"][choices.choose(2) as usize];
    let mut text = String::new();
    if choices.choose(2) == 1 {
        let _ = write!(text, "# made by hand{end}{end}");
    }
    if choices.choose(2) == 1 {
        let _ = write!(text, "sep={separator}{end}");
    }
    let order = choices.choose(4) as usize;
    let mut row = |fields: [String; 4]| {
        let blank = [" ", "", ""][choices.choose(3) as usize];
        let fields = [0, 1, 2, 3].map(|at| format!("{blank}{}", fields[(at + order) % 4]));
        let _ = write!(text, "{}{separator}\"n;,\t\"{end}", fields.join(separator));
    };
    row(["run".to_owned(), "a".to_owned(), "odom/b".to_owned(), "\"late, \"\"c\"\"\"".to_owned()]);
    for (values, episode) in states {
        let [a, b, c] = values.map(|value| VALUES[value].0.to_owned());
        row([episode.to_string(), a, b, c]);
    }
    text
}
