//! A state of the world for each letter of a trace, so that a difference can be seen in numbers.
//!
//! It is searched for among few values of each input: those at which a predicate changes, the
//! numbers that the predicates name, and values between them and beyond them. What is found has been evaluated; where nothing is, within a
//! bounded search, the letters alone are shown.

use tltl::robustness::Predicates;
use tltl_compiler::predicate::{ConditionId, Module, Scalar, Term};

use super::joint::Joint;
use crate::evaluate::{Evaluator, Input, InputKind, Unreadable};
use crate::trace::Letter;

/// The most values that are tried in one search: some ten milliseconds.
const MOST: usize = 1 << 14;

/// The predicates of a comparison, and the values to try.
pub(super) struct Witness {
    evaluator: Evaluator,
    /// For each input the values to try.
    values: Vec<Vec<f64>>,
    /// For each input the predicates that read it, and no later one.
    decided: Vec<Vec<usize>>,
}

impl Witness {
    /// The predicates with these conditions.
    ///
    /// # Errors
    /// If one of them cannot be evaluated: Rust code, or a parameter without a value.
    pub(super) fn new(joint: &mut Joint, conditions: &[ConditionId]) -> Result<Self, Unreadable> {
        let mut evaluator = |conditions: &[ConditionId]| {
            let task = joint.predicates(conditions);
            Evaluator::new(&joint.module, &task)
        };
        let all = evaluator(conditions)?;
        // A predicate without inputs is decided by the first one, if there is any.
        let mut decided = vec![Vec::new(); all.inputs().len()];
        for (predicate, &condition) in conditions.iter().enumerate() {
            let own = evaluator(&[condition])?;
            let reads = |input: &Input| own.inputs().contains(input);
            let last = all.inputs().iter().rposition(reads).unwrap_or(0);
            decided.get_mut(last).into_iter().for_each(|decided| decided.push(predicate));
        }
        let numbers = numbers(&joint.module);
        let values = all.inputs().iter().map(|input| candidates(input, &numbers)).collect();
        Ok(Self { evaluator: all, values, decided })
    }

    /// The names of the inputs and their values in a state with exactly these truth values; `None`
    /// if none is found. Free propositions are not among them.
    pub(super) fn state(&self, letter: &Letter) -> Option<Vec<(String, String)>> {
        let inputs = self.evaluator.inputs();
        let mut search = Search { of: self, letter, row: vec![0.0; inputs.len()], left: MOST };
        if !search.fill(0) {
            return None;
        }
        let shown = inputs.iter().zip(&search.row);
        let shown = shown.filter(|(input, _)| input.kind != InputKind::Proposition);
        Some(shown.map(|(input, value)| (input.name.clone(), written(input, *value))).collect())
    }
}

struct Search<'a> {
    of: &'a Witness,
    letter: &'a Letter,
    /// The state so far; 0 where an input has no value yet.
    row: Vec<f64>,
    left: usize,
}

impl Search<'_> {
    /// Fills the row from an input on, by trying its values (backtracking); whether that was
    /// possible.
    fn fill(&mut self, input: usize) -> bool {
        let Some(values) = self.of.values.get(input) else { return true };
        if values.iter().any(|value| self.fits(input, *value)) {
            return true;
        }
        self.solutions(input).into_iter().any(|value| self.fits(input, value))
    }

    /// Whether the row can be filled from an input on if it has this value.
    fn fits(&mut self, input: usize, value: f64) -> bool {
        let Some(left) = self.left.checked_sub(1) else { return false };
        self.left = left;
        self.row[input] = value;
        let holds = |&i: &usize| self.of.evaluator.holds(i, &self.row) == Ok(self.letter[i]);
        self.of.decided[input].iter().all(holds) && self.fill(input + 1)
    }

    /// Where the predicates that this input decides change as it does, and values between: exact
    /// where they are linear in it, from the robustness at two neighbours.
    fn solutions(&mut self, input: usize) -> Vec<f64> {
        let is_real = match self.of.evaluator.inputs()[input].kind {
            InputKind::Variable => true,
            InputKind::Place(scalar) => {
                matches!(scalar, Scalar::Number(_)) && scalar.whole().is_none()
            }
            InputKind::Proposition => false,
        };
        let mut changes = Vec::new();
        for &predicate in self.of.decided[input].iter().filter(|_| is_real) {
            // Beyond a kink, such as that of `abs`, another line goes on.
            for start in [0.0, -2.0, 1e3, -1e3] {
                let [low, high] = [start, start + 1.0].map(|value| {
                    self.row[input] = value;
                    Predicates::robustness(&self.of.evaluator, predicate, &self.row)
                });
                changes.push(start - low / (high - low));
            }
        }
        changes.retain(|change| change.is_finite());
        if changes.is_empty() { changes } else { reals(&changes) }
    }
}

/// The numbers that stand in the conditions of a module, of both signs.
fn numbers(module: &Module) -> Vec<f64> {
    let number = |term: &Term| match term {
        Term::Number(number) => Some([number.0, -number.0]),
        _ => None,
    };
    let mut numbers: Vec<f64> = module.arena.terms().iter().filter_map(number).flatten().collect();
    numbers.push(0.0);
    numbers
}

/// The values to try for an input, the simplest first.
fn candidates(input: &Input, numbers: &[f64]) -> Vec<f64> {
    match input.kind {
        InputKind::Proposition => vec![-1.0, 1.0],
        InputKind::Place(Scalar::Bool) => vec![0.0, 1.0],
        InputKind::Place(Scalar::Enum { optional, .. }) => {
            let none = optional.then_some(-1.0);
            none.into_iter().chain((0..input.values.len()).map(|value| value as f64)).collect()
        }
        InputKind::Variable => reals(numbers),
        InputKind::Place(scalar) => match scalar.whole() {
            None => reals(numbers),
            Some((least, most)) => {
                let whole =
                    numbers.iter().flat_map(|x| [x.floor() - 1.0, x.floor(), x.floor() + 1.0]);
                let within = |x: &f64| least as f64 <= *x && *x <= most as f64;
                simplest(whole.filter(within).collect())
            }
        },
    }
}

/// Numbers, those half-way between neighbours, and one beyond each end.
fn reals(numbers: &[f64]) -> Vec<f64> {
    let mut numbers = numbers.to_vec();
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    let between = numbers.windows(2).map(|pair| pair[0].midpoint(pair[1]));
    let ends = numbers.first().map(|first| first - 1.0).into_iter();
    let ends = ends.chain(numbers.last().map(|last| last + 1.0));
    simplest(numbers.iter().copied().chain(between).chain(ends).collect())
}

/// Each value once, small ones first, positive ones before negative ones.
fn simplest(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(|a, b| a.abs().total_cmp(&b.abs()).then(b.total_cmp(a)));
    values.dedup();
    values
}

fn written(input: &Input, value: f64) -> String {
    match input.kind {
        InputKind::Place(Scalar::Bool) => (value > 0.0).to_string(),
        InputKind::Place(Scalar::Enum { .. }) => {
            let name = (value >= 0.0).then(|| input.values[value as usize].clone());
            name.unwrap_or_else(|| "none".to_owned())
        }
        _ => (value + 0.0).to_string(),
    }
}
