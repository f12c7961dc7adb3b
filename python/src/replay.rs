//! Stored steps of a world, as they are for every state of an automaton.

use numpy::{PyReadonlyArray1, PyReadwriteArray1};
use pyo3::prelude::*;
use tltl::reward::Arrivals;
use tltl::{Acceptor, robustness};

use super::array::Array;
use super::batch::Letters;
use super::compiled::Compiled;
use super::error::wrong;
use super::labels;
use super::rewards::{Rewards, column};
use super::task::Task;

/// So many transitions are made at once: what one pass writes, the next one finds in the cache.
const BLOCK: usize = 8192;

/// A place for each transition: the stored step, the automaton state before, that after, what is
/// paid, and whether the episode ends there.
type Out<'py> = (
    PyReadwriteArray1<'py, i64>,
    PyReadonlyArray1<'py, u32>,
    PyReadwriteArray1<'py, u32>,
    PyReadwriteArray1<'py, f64>,
    PyReadwriteArray1<'py, bool>,
);

/// Writes the transitions that stored steps are in as many automaton states each, which are those of
/// `out[1]`; `next_labels` of shape (n, propositions), and `reward` and `terminated` of shape (n,).
#[pyfunction]
#[pyo3(signature = (task, rewards, next_labels, reward, terminated, out))]
pub(crate) fn relabelled(
    task: &Bound<'_, Task>,
    rewards: &Bound<'_, Rewards>,
    next_labels: &Bound<'_, PyAny>,
    reward: Option<&Bound<'_, PyAny>>,
    terminated: Option<&Bound<'_, PyAny>>,
    mut out: Out<'_>,
) -> PyResult<()> {
    let (py, task, rewards) = (task.py(), task.get(), &rewards.get().0);
    let labels = Array::new(next_labels, "next_labels")?;
    let (steps, width) = (labels.shape().first().copied().unwrap_or(0), task.propositions().len());
    let holds = labels::truths(task.propositions(), &labels)?;
    let robust = match rewards.needs_robustness() {
        true => labels::rows(task.propositions(), next_labels, steps)?,
        false => Vec::new(),
    };
    let reward = column(reward, "reward", steps)?;
    let ended = column(terminated, "terminated", steps)?;
    let (index, q, to) = (out.0.as_slice_mut()?, out.1.as_slice()?, out.2.as_slice_mut()?);
    let (paid, over) = (out.3.as_slice_mut()?, out.4.as_slice_mut()?);
    let each = q.len().checked_div(steps).unwrap_or(0);
    let are_places = [q.len(), index.len(), to.len(), paid.len(), over.len()] == [each * steps; 5];
    if !are_places || holds.len() != steps * width || q.iter().any(|&q| q >= task.inner.states()) {
        return Err(wrong("out: wanted are automaton states, and a place for each transition"));
    }
    if each == 0 {
        return Ok(());
    }
    py.detach(|| {
        let at_once = (BLOCK / each).max(1);
        let length = at_once * each;
        let outs = index.chunks_mut(length).zip(to.chunks_mut(length));
        let outs = outs.zip(paid.chunks_mut(length).zip(over.chunks_mut(length)));
        for (block, (q, ((index, to), (paid, over)))) in q.chunks(length).zip(outs).enumerate() {
            let steps = block * at_once..block * at_once + q.len() / each;
            for (step, index) in steps.clone().zip(index.chunks_mut(each)) {
                index.fill(step as i64);
            }
            let row = |step: usize| &holds[step * width..][..width];
            let letters = match width {
                0..=64 => {
                    let bits = |row: &[bool]| {
                        row.iter().rev().fold(0, |bits, &holds| bits << 1 | u64::from(holds))
                    };
                    Letters::Bits(repeated(each, steps.clone().map(|step| bits(row(step)))).into())
                }
                _ => Letters::Labels(repeated(each, steps.clone().map(row)).concat().into()),
            };
            to.copy_from_slice(q);
            task.move_all(to, &letters);
            let of_steps = |given: &[f64]| match given {
                [] => Vec::new(),
                given => repeated(each, steps.clone().map(|step| given[step])),
            };
            let (reward, ended) = (of_steps(&reward), of_steps(&ended));
            let ended: Vec<bool> = ended.iter().map(|&ended| ended > 0.0).collect();
            let rho = |(i, &q): (usize, &u32)| {
                let row = &robust[(steps.start + i / each) * width..][..width];
                robustness::guard(task.automaton().progress(q), |i| row[i])
            };
            let robustness = match robust.is_empty() {
                true => Vec::new(),
                false => q.iter().enumerate().map(rho).collect(),
            };
            let (terminated, robustness) = (&ended[..], &robustness[..]);
            let arrivals = Arrivals { q, to, robustness, reward: &reward, terminated };
            rewards.pay_all(&task.ends, &arrivals, paid);
            for (i, (over, &to)) in over.iter_mut().zip(&*to).enumerate() {
                *over = task.ends.end(to).is_some() || ended.get(i).copied().unwrap_or(false);
            }
        }
    });
    Ok(())
}

/// Each value as often.
fn repeated<T: Clone>(times: usize, values: impl Iterator<Item = T>) -> Vec<T> {
    values.flat_map(|value| std::iter::repeat_n(value, times)).collect()
}
