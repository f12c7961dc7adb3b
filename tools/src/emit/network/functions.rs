//! The functions of an emitted network: its forward pass, and what it makes of the outputs.

use std::fmt::Write as _;

use tltl::network::{Activation, Form, Shape, Squash};

/// The forward pass of this shape: its hidden layers, and the pointing actions if it has entities.
pub(super) fn write(text: &mut String, shape: &Shape, form: &Form) {
    let mut trunk = String::new();
    let first = if form.scale.is_some() { "&normalised(inputs)" } else { "inputs" };
    let function = match form.activation {
        Activation::Relu => "rectified",
        Activation::Tanh => "tanh",
    };
    for i in 0..shape.hidden.len() {
        let from = if i == 0 { first } else { "&x" };
        let of_state = if i == 0 && !form.states.is_empty() { "[head]" } else { "" };
        let _ = writeln!(
            trunk,
            "    let x = {function}(dense({from}, &WEIGHTS_{i}, &BIAS_{i}{of_state}));"
        );
    }
    let last = if shape.hidden.is_empty() { first } else { "&x" };
    let head = if form.states.is_empty() { "head" } else { "0" };
    let out = format!("dense({last}, &HEAD_WEIGHTS[{head}], &HEAD_BIAS[{head}])");
    let (plain, forward) = match shape.entities {
        0 => (String::new(), format!("{trunk}    {out}\n")),
        _ => (
            format!(
                "\n/// The actions before this one point at nothing.\nconst PLAIN: usize = {};\n",
                shape.actions - shape.entities
            ),
            format!("{trunk}    let out = {out};\n{POINTING}"),
        ),
    };
    text.push_str(&plain);
    let unused = if shape.entities == 0 { "_entities" } else { "entities" };
    let squash = form.controls.as_ref().map(|controls| controls.squash);
    let acting = match squash {
        None => ACT.to_owned(),
        Some(squash) => CONTROL.replace("SQUASHED", squashed(squash)),
    };
    let about = if squash.is_none() { WORTH } else { OUTPUTS };
    let functions = FUNCTIONS.replace("ACTING", &acting).replace("ABOUT", about);
    text.push_str(&functions.replace("FORWARD", &forward).replace("UNUSED", unused));
    text.push_str(if form.scale.is_some() { NORMALISED } else { "" });
    let in_layers = |activation| form.activation == activation && !shape.hidden.is_empty();
    let is_tanh = in_layers(Activation::Tanh) || squash == Some(Squash::Tanh);
    text.push_str(if in_layers(Activation::Relu) { RECTIFIED } else { "" });
    text.push_str(if is_tanh { TANH } else { "" });
}

/// What makes controls of outputs, as `Controls::of` has it.
const fn squashed(squash: Squash) -> &'static str {
    match squash {
        Squash::Tanh => {
            "    let mut numbers = tanh(values(q, inputs, entities));
    for ((x, low), high) in numbers.iter_mut().zip(&LOW).zip(&HIGH) {
        *x = (low + (*x + 1.0) * 0.5 * (high - low)).clamp(*low, *high);
    }"
        }
        Squash::Clip => {
            "    let mut numbers = values(q, inputs, entities);
    for ((x, low), high) in numbers.iter_mut().zip(&LOW).zip(&HIGH) {
        *x = x.clamp(*low, *high);
    }"
        }
    }
}

/// What outputs are, where they are values of actions.
const WORTH: &str = "\
/// Q(s, q, ·): what each of the [`ACTIONS`] is worth in the state whose features are `inputs`, at
/// the automaton state `q`; 0 where the task is decided.";

/// What they are where an action is numbers.
const OUTPUTS: &str = "\
/// What the network puts out for each of the [`ACTIONS`] in the state whose features are `inputs`,
/// at the automaton state `q`, before it is one of the numbers of [`control`]; 0 where the task is
/// decided.";

/// Among actions.
const ACT: &str = "\
/// The action of the largest value, an index of [`ACTIONS`], the lowest of equals: 0 where the task
/// is decided.
///
/// # Panics
/// If `q` is not below [`AUTOMATON_STATES`].
#[must_use]
pub fn act(q: usize, inputs: &[f32; INPUTS], entities: &[f32; CHANNELS * ENTITIES]) -> usize {
    let values = values(q, inputs, entities);
    let mut best = 0;
    for (action, value) in values.iter().enumerate() {
        if *value > values[best] {
            best = action;
        }
    }
    best
}
";

/// An action of numbers; `SQUASHED` is replaced.
const CONTROL: &str = "\
/// The numbers that the action is, one for each of [`ACTIONS`], from [`LOW`] to [`HIGH`]: those of
/// values of 0 where the task is decided.
///
/// # Panics
/// If `q` is not below [`AUTOMATON_STATES`].
#[must_use]
pub fn control(
    q: usize,
    inputs: &[f32; INPUTS],
    entities: &[f32; CHANNELS * ENTITIES],
) -> [f32; ACTIONS.len()] {
SQUASHED
    numbers
}
";

/// The functions of the generated file; `ABOUT`, `ACTING`, `FORWARD` and `UNUSED` are
/// replaced.
const FUNCTIONS: &str = "
ABOUT
///
/// `entities`, indexed `channel * ENTITIES + entity`, are the features of the entities. All
/// features must be finite.
///
/// # Panics
/// If `q` is not below [`AUTOMATON_STATES`].
#[must_use]
pub fn values(
    q: usize,
    inputs: &[f32; INPUTS],
    entities: &[f32; CHANNELS * ENTITIES],
) -> [f32; ACTIONS.len()] {
    match HEAD[q] {
        Some(head) => forward(head, inputs, entities),
        None => [0.0; ACTIONS.len()],
    }
}

ACTING
/// Whether an episode ends at `q`: accomplished, or lost.
#[must_use]
pub fn is_done(q: usize) -> bool {
    ACCEPTING == Some(q) || TRAP == Some(q)
}

fn forward(
    head: usize,
    inputs: &[f32; INPUTS],
    UNUSED: &[f32; CHANNELS * ENTITIES],
) -> [f32; ACTIONS.len()] {
FORWARD}

/// `x W + b`; what is 0 in `x` costs nothing.
fn dense<const I: usize, const O: usize>(
    x: &[f32; I],
    weights: &[[f32; O]; I],
    bias: &[f32; O],
) -> [f32; O] {
    let mut y = *bias;
    for (x, row) in x.iter().zip(weights) {
        if *x != 0.0 {
            for (y, w) in y.iter_mut().zip(row) {
                *y += x * w;
            }
        }
    }
    y
}
";

/// The end of the forward pass where actions point at entities: the head gives a query, and the
/// value of pointing is its product with the features of the entity.
const POINTING: &str = "    let mut values = [out[PLAIN]; ACTIONS.len()];
    values[..PLAIN].copy_from_slice(&out[..PLAIN]);
    let query = &out[PLAIN + 1..];
    for (weight, features) in query.iter().zip(entities.chunks_exact(ENTITIES)) {
        for (value, feature) in values[PLAIN..].iter_mut().zip(features) {
            *value += weight * feature;
        }
    }
    values
";

/// The normalisation of the inputs, as `Scale::of` has it.
const NORMALISED: &str = "
fn normalised(inputs: &[f32; INPUTS]) -> [f32; INPUTS] {
    let mut x = *inputs;
    for ((x, mean), deviation) in x.iter_mut().zip(&MEAN).zip(&DEVIATION) {
        *x = ((*x - mean) / deviation).clamp(-CLIP, CLIP);
    }
    x
}
";

/// The other activation function, as `Activation::of` has it.
const TANH: &str = "
/// Lambert's continued fraction at a quarter of the sum, doubled twice.
fn tanh<const N: usize>(mut x: [f32; N]) -> [f32; N] {
    for value in &mut x {
        let y = value.clamp(-9.5, 9.5) * 0.25;
        let s = y * y;
        let t = y * (945.0 + s * (105.0 + s)) / (945.0 + s * (420.0 + s * 15.0));
        let t = 2.0 * t / (1.0 + t * t);
        *value = 2.0 * t / (1.0 + t * t);
    }
    x
}
";

/// The activation function; a network without hidden layers has none.
const RECTIFIED: &str = "
fn rectified<const N: usize>(mut x: [f32; N]) -> [f32; N] {
    for value in &mut x {
        *value = value.max(0.0);
    }
    x
}
";
