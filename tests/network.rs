//! Network policies: saved, refused, and emitted as Rust that says the same.
//!
//! After a change of the file's form or of the emitted source, run this with `UPDATE_NETWORK=1` and
//! read what changed.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;
use tltl::estimate::{Estimate, Interval};
use tltl::network::policy::{NetworkDocument, NetworkPolicy, NetworkPolicyError, NetworkTraining};
use tltl::network::{
    Activation, Controls, Dense, Form, Network, NetworkError, Scale, Shape, Squash,
};
use tltl::policy::States;
use tltl::reward::End;
use tltl::solve::Basis;
use tltlc::emit;

use super::random::{Choices, Seeded};

/// The emitted form of [`example`], as anybody would have it: linted and laid out with the rest.
#[path = "data/network_policy.rs"]
#[allow(unreachable_pub, dead_code, reason = "generated; no test uses all of it")]
mod emitted;

fn names(prefix: &str, count: usize) -> Vec<String> {
    (0..count).map(|i| format!("{prefix} {i}")).collect()
}

/// A number in ±`scale`.
fn number(choices: &mut impl Choices, scale: f32) -> f32 {
    (choices.choose(1 << 24) as f32 / (1 << 23) as f32 - 1.0) * scale
}

fn network(shape: Shape, mut weight: impl FnMut() -> f32) -> Network {
    let pointing = if shape.entities > 0 { 1 + shape.channels } else { 0 };
    let mut widths = vec![shape.inputs];
    widths.extend(&shape.hidden);
    widths.push(shape.heads * (shape.actions - shape.entities + pointing));
    let mut some = |count: usize| (0..count).map(|_| weight()).collect();
    let layers =
        widths.windows(2).map(|w| Dense { weights: some(w[0] * w[1]), bias: some(w[1]) }).collect();
    Network::new(shape, layers).unwrap()
}

/// A network policy for an automaton of which no more is known than its file says.
fn policy(
    task: &str,
    formula: &str,
    automaton: States,
    actions: Vec<String>,
    network: Network,
) -> Result<NetworkPolicy, NetworkPolicyError> {
    NetworkPolicy::try_from(NetworkDocument {
        format: NetworkPolicy::FORMAT.to_owned(),
        version: NetworkPolicy::VERSION,
        task: task.to_owned(),
        formula: formula.to_owned(),
        actions,
        automaton,
        inputs: Vec::new(),
        channels: Vec::new(),
        training: Vec::new(),
        estimate: None,
        network,
    })
}

/// A small policy of every feature; some of its weights look like constants, or are hard to write.
fn example() -> NetworkPolicy {
    use std::f32::consts::{E, FRAC_1_PI, LN_2, LOG10_2, PI, SQRT_2};
    let like_constants = [PI, -PI, E, LN_2, SQRT_2, FRAC_1_PI, LOG10_2, 314.0 / 100.0, 1.0 / 3.0];
    let rare = [0.0, -0.0, 1.0, 0.1, 1e-45, f32::MIN_POSITIVE, 1e10, 16_777_216.0, 123.0];
    let mut special = like_constants.into_iter().chain(rare);
    let mut choices = Seeded(1);
    let shape =
        Shape { inputs: 2, hidden: vec![4, 3], heads: 3, actions: 5, entities: 2, channels: 3 };
    let network = network(shape, || special.next().unwrap_or_else(|| number(&mut choices, 1.0)));
    let automaton = States { states: 5, initial: 0, accepting: Some(3), trap: Some(1) };
    let interval = |mean, low, high| Interval { mean, low, high };
    policy("fetch", "(!c U a) && F b", automaton, names("action number", 5), network)
        .and_then(|policy| policy.described(names("input", 2), names("channel", 3)))
        .unwrap()
        .trained(NetworkTraining {
            task: "fetch".to_owned(),
            steps: 200_000,
            episodes: 3100,
            updates: 199_000,
            gamma: 0.98,
            seed: 7,
        })
        .estimated(Estimate {
            basis: Basis::Trials,
            episodes: 1000,
            horizon: 200,
            confidence: 0.95,
            satisfied: interval(0.98, 0.97, 0.99),
            lost: interval(0.0, 0.0, 0.004),
            steps: Some(interval(21.5, 20.25, 22.75)),
        })
}

/// Compares with a file of `data`, or writes it.
fn unchanged(file: &str, text: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(file);
    if std::env::var_os("UPDATE_NETWORK").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    let known = std::fs::read_to_string(&path).unwrap();
    assert!(known == text, "{file}: run this test with UPDATE_NETWORK=1 and read what changed");
}

#[test]
fn the_file_and_the_source_are_as_they_were() {
    let text = serde_json::to_string(&example()).unwrap();
    unchanged("network_policy.json", &format!("{text}\n"));
    unchanged("network_policy.rs", &emit::policy::rust(&text).unwrap());
}

#[test]
fn network_policies_survive_the_file() {
    let saved = example();
    let text = serde_json::to_string(&saved).unwrap();
    assert_eq!(serde_json::from_str::<NetworkPolicy>(&text).unwrap(), saved);
    let bits = |policy: &NetworkPolicy| -> Vec<u32> {
        let layers = policy.network().layers().iter();
        layers.flat_map(|l| l.weights.iter().chain(&l.bias)).map(|w| w.to_bits()).collect()
    };
    assert_eq!(bits(&serde_json::from_str(&text).unwrap()), bits(&saved), "-0 is not 0");
}

#[test]
fn heads_are_the_states_in_which_the_task_goes_on() {
    let policy = example();
    assert_eq!([0, 1, 2, 3, 4].map(|q| policy.head(q)), [Some(0), None, Some(1), None, Some(2)]);
    assert_eq!([1, 3].map(|q| policy.end(q)), [Some(End::Lost), Some(End::Accepted)]);
    let (inputs, entities) = ([0.5, -1.5], [1.0, 0.0, -0.5, 2.0, 0.25, 1.0]);
    let heads = [Some(0), None, Some(1), None, Some(2)];
    for (q, head) in heads.into_iter().enumerate() {
        let values = policy.values(q as u32, &inputs, &entities);
        let expected = head.map(|head| policy.network().values(head, &inputs, &entities));
        assert_eq!(values, expected.unwrap_or(vec![0.0; 5]), "decided: nothing more can be had");
        assert_eq!(values, emitted::values(q, &inputs, &entities));
        assert_eq!(policy.act(q as u32, &inputs, &entities), emitted::act(q, &inputs, &entities));
        assert_eq!(policy.end(q as u32).is_some(), emitted::is_done(q));
    }
    let task = tltl::tltl! { |s: &f64| ({ *s } < 3.0) U ({ *s } < 1.0) };
    let states = States { states: 3, initial: 0, accepting: Some(2), trap: Some(1) };
    assert_eq!(States::of(&task), states);
}

/// The example with a change that `row` describes.
fn broken(row: &Value) -> String {
    let text = serde_json::to_string(&example()).unwrap();
    let mut json: Value = serde_json::from_str(&text).unwrap();
    if let Some(at) = row["cut"].as_u64() {
        return text[..at as usize].to_owned();
    }
    if let Some(other) = row["other"].as_str() {
        return other.to_owned();
    }
    if let Some(field) = row["without"].as_str() {
        json.as_object_mut().unwrap().remove(field).unwrap();
    } else if let Some(field) = row["add"].as_str() {
        json[field] = row["is"].clone();
    } else if let Some(field) = row["later"].as_str() {
        json["version"] = 1.into();
        json["network"][field] = row["is"].clone();
    } else {
        *json.pointer_mut(row["at"].as_str().unwrap()).unwrap() = row["is"].clone();
    }
    json.to_string()
}

#[test]
fn what_is_no_network_policy_is_refused() {
    for line in include_str!("data/network_refusals.jsonl").lines() {
        let row: Value = serde_json::from_str(line).unwrap();
        let text = broken(&row);
        let found = serde_json::from_str::<NetworkPolicy>(&text).unwrap_err().to_string();
        assert!(found.contains(row["reason"].as_str().unwrap()), "{line}\n{found}");
        let told = emit::policy::rust(&text).unwrap_err();
        // The tool knows other formats.
        let network =
            row["at"] != "/format" && row["without"] != "format" && row["other"].is_null();
        assert!(!network || told.ends_with(&found), "{line}\n{told}");
    }
}

/// Networks of every kind of shape and automaton.
fn policies() -> Vec<NetworkPolicy> {
    let mut choices = Seeded(2);
    let mut all = vec![example()];
    for (hidden, [inputs, actions, entities, channels]) in [
        (vec![], [3, 4, 0, 0]),
        (vec![], [0, 2, 2, 3]),
        (vec![], [5, 6, 2, 1]),
        (vec![1], [1, 1, 0, 0]),
        (vec![7], [12, 5, 0, 0]),
        (vec![16], [9, 8, 5, 4]),
        (vec![8, 5], [6, 3, 3, 0]),
        (vec![64, 64], [20, 12, 8, 6]),
        (vec![9, 4, 6], [10, 70, 64, 5]),
        (vec![3, 3, 3], [4, 3, 0, 0]),
    ] {
        for (states, accepting, trap) in
            [(1, None, None), (3, Some(2), None), (4, Some(1), Some(3))]
        {
            let heads =
                states as usize - usize::from(accepting.is_some()) - usize::from(trap.is_some());
            let hidden = hidden.clone();
            let shape = Shape { inputs, hidden, heads, actions, entities, channels };
            let network = network(shape, || number(&mut choices, 1.5));
            let automaton = States { states, initial: 0, accepting, trap };
            let named = |network| policy("t", "F a", automaton, names("a", actions), network);
            all.push(named(network.clone()).unwrap());
            all.push(named(formed(&network, &mut choices)).unwrap());
        }
    }
    all
}

/// The network in another form: normalised, with tanh, and with the automaton state among the inputs
/// where there is a hidden layer for it.
fn formed(network: &Network, choices: &mut impl Choices) -> Network {
    let (shape, mut layers) = (network.shape().clone(), network.layers().to_vec());
    let mut some = |count: usize, scale| (0..count).map(|_| number(choices, scale)).collect();
    let mean = some(shape.inputs, 1.0);
    let deviation: Vec<f32> = some(shape.inputs, 2.0);
    let deviation = deviation.into_iter().map(|x| x.abs() + 0.25).collect();
    let scale = Some(Scale { mean, deviation, clip: 5.0 });
    let mut states = Vec::new();
    if let Some(units) = shape.hidden.first() {
        states = some(units * shape.heads, 1.0);
        let last = layers.last_mut().unwrap();
        let width = last.bias.len() / shape.heads;
        let rows = last.weights.chunks(width * shape.heads);
        last.weights = rows.flat_map(|row| row[..width].to_vec()).collect();
        last.bias.truncate(width);
    }
    // Every other one acts by numbers: both ways, in turn.
    let controls = (choices.choose(2) == 0).then(|| {
        let squash = if choices.choose(2) == 0 { Squash::Tanh } else { Squash::Clip };
        let low: Vec<f32> = (0..shape.actions).map(|_| number(choices, 2.0)).collect();
        let high = low.iter().map(|low| low + number(choices, 2.0).abs()).collect();
        Controls { squash, low, high }
    });
    let form = Form { activation: Activation::Tanh, scale, states, controls };
    Network::with_form(shape, layers, form).unwrap()
}

#[test]
fn a_form_must_fit_its_network() {
    let shape =
        Shape { inputs: 1, hidden: vec![2], heads: 2, actions: 1, entities: 0, channels: 0 };
    let layer =
        |weights: usize, bias: usize| Dense { weights: vec![0.5; weights], bias: vec![0.0; bias] };
    let scale =
        |mean: Vec<f32>, deviation: f32, clip| Scale { mean, deviation: vec![deviation], clip };
    let made = |scale: Option<Scale>, states: Vec<f32>, heads| {
        let layers = vec![layer(2, 2), layer(2 * heads, heads)];
        Network::with_form(shape.clone(), layers, Form { scale, states, ..Form::default() })
    };
    assert!(made(None, vec![], 2).is_ok() && made(None, vec![1.0; 4], 1).is_ok());
    let wrong =
        |part, found, expected| Err(NetworkError::Form { part, found, expected: Some(expected) });
    assert_eq!(made(None, vec![1.0; 3], 1), wrong("states", 3, 4));
    assert_eq!(made(Some(scale(vec![], 1.0, 1.0)), vec![], 2), wrong("scale.mean", 0, 1));
    // With the automaton state as an input there is one head.
    assert!(matches!(made(None, vec![1.0; 4], 2), Err(NetworkError::Size { layer: 1, .. })));
    assert_eq!(made(None, vec![f32::NAN; 4], 1), Err(NetworkError::NotFinite { layer: 0 }));
    for (deviation, clip) in [(0.0, 1.0), (f32::NAN, 1.0), (1.0, -1.0), (1.0, f32::INFINITY)] {
        let wrong = made(Some(scale(vec![0.0], deviation, clip)), vec![], 2);
        assert_eq!(wrong, Err(NetworkError::Scale));
    }
    let bounded = |low: &[f32], high: &[f32]| {
        let (low, high) = (low.to_vec(), high.to_vec());
        let controls = Some(Controls { squash: Squash::Clip, low, high });
        let layers = vec![layer(2, 2), layer(4, 2)];
        Network::with_form(shape.clone(), layers, Form { controls, ..Form::default() })
    };
    assert!(bounded(&[1.0], &[1.0]).is_ok());
    assert_eq!(bounded(&[], &[1.0]), wrong("controls.low", 0, 1));
    assert_eq!(bounded(&[0.0], &[1.0, 2.0]), wrong("controls.high", 2, 1));
    for (low, high) in [(1.0, 0.5), (f32::NAN, 1.0), (0.0, f32::INFINITY), (-3e38, 3e38)] {
        assert_eq!(bounded(&[low], &[high]), Err(NetworkError::Controls));
    }
}

#[test]
fn tanh_is_the_hyperbolic_tangent() {
    let mut choices = Seeded(5);
    for _ in 0..100_000 {
        let x = number(&mut choices, 12.0);
        let (found, exact) = (Activation::Tanh.of(x), f64::from(x).tanh());
        assert!((f64::from(found) - exact).abs() <= 3.5e-7 * exact.abs(), "{x}: {found}, {exact}");
        assert_eq!(Activation::Tanh.of(-x), -found);
    }
}

/// A feature: often 0, as features are.
fn feature(choices: &mut impl Choices) -> f32 {
    match choices.choose(8) {
        0..=2 => 0.0,
        3 => -0.0,
        4 => 1.0,
        5 => number(choices, 100.0),
        _ => number(choices, 1.0),
    }
}

fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("network");
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn rustc(arguments: &[&str]) {
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let run = Command::new(rustc).args(arguments).current_dir(folder()).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
}

/// A program that reads lines `policy q features…` and answers `act values…`, or the numbers of an action
/// before the values; all floats as bits.
const DRIVER: &str = "
macro_rules! answer {
    ($net:ident, $acts:ident, $q:expr, $bits:expr) => {{
        let all: Vec<f32> = $bits.map(|b| f32::from_bits(b.parse().unwrap())).collect();
        let (inputs, entities) = all.split_at(nets::$net::INPUTS);
        let (inputs, entities) = (inputs.try_into().unwrap(), entities.try_into().unwrap());
        print!(\"{}\", told(nets::$net::$acts($q, inputs, entities)));
        let values = nets::$net::values($q, inputs, entities);
        values.iter().for_each(|v| print!(\" {}\", v.to_bits()));
        println!();
    }};
}

trait Told {
    fn told(self) -> String;
}

impl Told for usize {
    fn told(self) -> String {
        self.to_string()
    }
}

impl<const N: usize> Told for [f32; N] {
    fn told(self) -> String {
        self.map(|x| x.to_bits().to_string()).join(\" \")
    }
}

fn told(action: impl Told) -> String {
    action.told()
}

fn main() {
    for line in std::io::stdin().lines() {
        let line = line.unwrap();
        let mut words = line.split(' ');
        let (net, q) = (words.next().unwrap(), words.next().unwrap().parse().unwrap());
        match net {
            ARMS
            _ => unreachable!(),
        }
    }
}
";

/// Compiles the emitted policies, without std and without a warning, and a program that asks them.
fn program(policies: &[NetworkPolicy]) -> PathBuf {
    let mut library = "//! Policies.\n#![no_std]\n#![forbid(unsafe_code)]\n".to_owned();
    let mut arms = String::new();
    for (i, policy) in policies.iter().enumerate() {
        let source = emit::policy::rust(&serde_json::to_string(policy).unwrap()).unwrap();
        assert!(!source.contains("extern") && !source.contains("#!"));
        assert!(source.lines().all(|line| line.chars().count() <= 100));
        std::fs::write(folder().join(format!("n{i}.rs")), source).unwrap();
        let _ = writeln!(library, "pub mod n{i};");
        let acts = if policy.network().form().controls.is_some() { "control" } else { "act" };
        let _ = writeln!(arms, "\"{i}\" => answer!(n{i}, {acts}, q, words),");
    }
    std::fs::write(folder().join("nets.rs"), library).unwrap();
    std::fs::write(folder().join("driver.rs"), DRIVER.replace("ARMS", &arms)).unwrap();
    let edition = ["--edition", "2024", "-O", "-D", "warnings"];
    rustc(&[&edition[..], &["-D", "missing_docs", "--crate-type", "rlib", "nets.rs"]].concat());
    rustc(&[&edition[..], &["--extern", "nets=libnets.rlib", "-L", ".", "driver.rs"]].concat());
    folder().join(format!("driver{}", std::env::consts::EXE_SUFFIX))
}

/// What to ask, and what the library answers, to the last bit.
fn questions(policies: &[NetworkPolicy], each: usize) -> (String, String) {
    let mut choices = Seeded(3);
    let (mut asked, mut answers) = (String::new(), String::new());
    for (i, policy) in policies.iter().enumerate() {
        let Shape { inputs, entities, channels, .. } = *policy.network().shape();
        for _ in 0..each {
            let q = choices.choose(policy.document().automaton.states);
            let mut features = |count| (0..count).map(|_| feature(&mut choices)).collect();
            let (inputs, entities): (Vec<f32>, Vec<f32>) =
                (features(inputs), features(entities * channels));
            let _ = write!(asked, "{i} {q}");
            inputs.iter().chain(&entities).for_each(|f| {
                let _ = write!(asked, " {}", f.to_bits());
            });
            let _ = match policy.control(q, &inputs, &entities) {
                None => write!(answers, "{}", policy.act(q, &inputs, &entities)),
                Some(numbers) => {
                    let bits: Vec<_> = numbers.iter().map(|x| x.to_bits().to_string()).collect();
                    write!(answers, "{}", bits.join(" "))
                }
            };
            policy.values(q, &inputs, &entities).iter().for_each(|v| {
                assert!(v.is_finite());
                let _ = write!(answers, " {}", v.to_bits());
            });
            asked.push('\n');
            answers.push('\n');
        }
    }
    (asked, answers)
}

#[test]
fn emitted_networks_say_what_the_library_says() {
    let policies = policies();
    let (asked, answers) = questions(&policies, 200);
    let mut child = Command::new(program(&policies))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdin = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || stdin.write_all(asked.as_bytes()));
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    let found = String::from_utf8(output.stdout).unwrap();
    for (line, (found, expected)) in found.lines().zip(answers.lines()).enumerate() {
        assert_eq!(found, expected, "question {line}");
    }
    assert_eq!(found.lines().count(), answers.lines().count());
}
