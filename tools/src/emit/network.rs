//! A saved network policy as a Rust source file that stands alone: `static` weights and a forward
//! pass, no dependency, no allocation, `no_std`.
//!
//! The file that comes in is the JSON that the runtime saves (its module `network::policy` has the
//! schema). It is checked in full before anything is written. Weights are written as the shortest
//! decimals that are read back exactly, and products are added up in the runtime's order, so the
//! values are the runtime's to the last bit.

mod source;

use serde::Deserialize;
use serde_json::Value;

/// The value of the field `format`.
pub(super) const FORMAT: &str = "tltl-network-policy";
/// The version that this compiler reads.
const VERSION: u64 = 1;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Policy {
    #[serde(rename = "format")]
    _format: String,
    #[serde(rename = "version")]
    _version: u64,
    task: String,
    formula: String,
    actions: Vec<String>,
    automaton: States,
    #[serde(default)]
    inputs: Vec<String>,
    #[serde(default)]
    channels: Vec<String>,
    training: Vec<Training>,
    #[serde(default)]
    estimate: Option<Estimate>,
    network: Network,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct States {
    states: usize,
    initial: usize,
    accepting: Option<usize>,
    trap: Option<usize>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Training {
    task: String,
    steps: u64,
    episodes: u64,
    updates: u64,
    gamma: f64,
    seed: u64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Interval {
    mean: f64,
    low: f64,
    high: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Estimate {
    episodes: u64,
    horizon: u64,
    confidence: f64,
    satisfied: Interval,
    lost: Interval,
    steps: Option<Interval>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Network {
    shape: Shape,
    layers: Vec<Layer>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Shape {
    inputs: usize,
    hidden: Vec<usize>,
    heads: usize,
    actions: usize,
    entities: usize,
    channels: usize,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Layer {
    /// Indexed `input * outputs + output`.
    weights: Vec<f32>,
    bias: Vec<f32>,
}

/// The Rust source of the network policy that `json` holds.
///
/// # Errors
/// Says why `json` is not a network policy.
pub fn rust(json: &str) -> Result<String, String> {
    let value: Value = serde_json::from_str(json).map_err(|error| format!("not JSON: {error}"))?;
    let format = value.get("format").and_then(Value::as_str).unwrap_or_default();
    if format != FORMAT {
        return Err(format!("not a network policy: format is `{format}`, not `{FORMAT}`"));
    }
    match value.get("version").and_then(Value::as_u64) {
        Some(VERSION) => {}
        Some(other) => {
            return Err(format!("network policy version {other}; this compiler reads {VERSION}"));
        }
        None => return Err("the network policy has no version".to_owned()),
    }
    // Not from the value, whose numbers are of 64 bits: they would be rounded twice.
    let policy: Policy = serde_json::from_str(json).map_err(|error| error.to_string())?;
    policy.check()?;
    Ok(source::write(&policy))
}

impl Policy {
    fn check(&self) -> Result<(), String> {
        self.network.check()?;
        self.check_automaton()?;
        let Shape { inputs, actions, channels, .. } = self.network.shape;
        for (field, names, expected) in [
            ("actions", &self.actions, actions),
            ("inputs", &self.inputs, inputs),
            ("channels", &self.channels, channels),
        ] {
            let found = names.len();
            if found != expected && (found > 0 || field == "actions") {
                return Err(format!(
                    "`{field}` has {found} names, and the network has {expected} {field}"
                ));
            }
        }
        self.estimate.as_ref().map_or(Ok(()), Estimate::check)
    }

    fn check_automaton(&self) -> Result<(), String> {
        let States { states, initial, accepting, trap } = self.automaton;
        let fields = [("initial", Some(initial)), ("accepting", accepting), ("trap", trap)];
        for (field, state) in fields {
            if let Some(q) = state.filter(|&q| q >= states) {
                return Err(format!("`automaton.{field}` is {q}, not less than {states}"));
            }
        }
        if let Some(q) = accepting.filter(|_| accepting == trap) {
            return Err(format!("automaton state {q} is both accepting and the trap"));
        }
        let decided = accepting.iter().chain(&trap).count();
        match (self.network.shape.heads, states - decided) {
            (found, expected) if found != expected => Err(format!(
                "the network has {found} heads, and the task goes on in {expected} automaton states"
            )),
            _ => Ok(()),
        }
    }

    /// The head of each automaton state in which the task goes on: they are in the same order.
    fn heads(&self) -> impl Iterator<Item = Option<usize>> {
        let States { states, accepting, trap, .. } = self.automaton;
        let mut next = 0;
        (0..states).map(move |q| {
            let live = accepting != Some(q) && trap != Some(q);
            next += usize::from(live);
            live.then(|| next - 1)
        })
    }
}

impl Estimate {
    fn check(&self) -> Result<(), String> {
        let probability = |interval: &Interval| {
            [interval.low, interval.mean, interval.high].iter().all(|p| (0.0..=1.0).contains(p))
        };
        for (field, sound) in [
            ("satisfied", probability(&self.satisfied)),
            ("lost", probability(&self.lost)),
            ("steps", self.steps.as_ref().is_none_or(|steps| steps.mean >= 0.0)),
        ] {
            if !sound {
                return Err(format!(
                    "`estimate.{field}` is not a probability, or not a number of steps"
                ));
            }
        }
        Ok(())
    }
}

impl Shape {
    /// Actions that point at nothing.
    fn plain(&self) -> usize {
        self.actions - self.entities
    }

    /// What a head puts out: values, one that all pointing actions have in common, and a weight for
    /// each channel.
    fn head_width(&self) -> Option<usize> {
        (self.plain() + usize::from(self.entities > 0)).checked_add(self.channels)
    }

    /// The widths of all layers, the input first; or which size does not go with the others.
    fn widths(&self) -> Result<Vec<usize>, &'static str> {
        let lone = self.entities == 0 && self.channels > 0;
        for (field, wrong) in [
            ("heads", self.heads == 0),
            ("actions", self.actions == 0),
            ("entities", self.entities > self.actions),
            ("channels", lone || self.channels.checked_mul(self.entities).is_none()),
            ("hidden", self.hidden.contains(&0)),
        ] {
            if wrong {
                return Err(field);
            }
        }
        let last = self.head_width().and_then(|width| width.checked_mul(self.heads));
        let mut widths = vec![self.inputs];
        widths.extend(&self.hidden);
        widths.push(last.ok_or("heads")?);
        Ok(widths)
    }
}

impl Network {
    fn check(&self) -> Result<(), String> {
        let widths = self.shape.widths().map_err(|field| {
            format!(
                "`network.shape.{field}` cannot be: a network needs heads, actions, an action for \
                 each entity, units in each hidden layer, and channels only with entities"
            )
        })?;
        let (found, expected) = (self.layers.len(), widths.len() - 1);
        if found != expected {
            return Err(format!("`network.layers` has {found} layers, not {expected}"));
        }
        for (i, (layer, width)) in self.layers.iter().zip(widths.windows(2)).enumerate() {
            let size = width[0].checked_mul(width[1]);
            let parts = [("weights", &layer.weights, size), ("bias", &layer.bias, Some(width[1]))];
            for (part, entries, expected) in parts {
                check(&format!("network.layers[{i}].{part}"), entries, expected)?;
            }
        }
        Ok(())
    }
}

/// Refuses what has not `expected` entries, all finite.
fn check(field: &str, entries: &[f32], expected: Option<usize>) -> Result<(), String> {
    match expected {
        Some(expected) if expected == entries.len() => {}
        Some(expected) => {
            return Err(format!("`{field}` has {} entries, not {expected}", entries.len()));
        }
        None => return Err(format!("`{field}` would be too large")),
    }
    match entries.iter().position(|w| !w.is_finite()) {
        Some(at) => Err(format!("`{field}`, entry {at}: not a finite number of 32 bits")),
        None => Ok(()),
    }
}
