//! A task beside an environment: what one step of a world is for it, and what a step of many is.

use pyo3::exceptions::PyTypeError;
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use tltl::reward::{self, Arrivals, End, JointArrival};
use tltl::{Acceptor, robustness};

use super::array::{Array, shaped};
use super::batch::Letters;
use super::compiled::Compiled;
use super::error::wrong;
use super::factored::Factored;
use super::labels;
use super::rewards::{Rewards, column};
use super::task::Task;

/// A task that follows a world: its states are one number each, or one for each part, one behind the
/// other.
pub(crate) trait Follows: Compiled {
    /// States, checked, and how many of them there are; `None` if it is one that is not in an array of
    /// states.
    fn states_given(&self, q: &Bound<'_, PyAny>) -> PyResult<(Vec<u32>, Option<usize>)>;
    /// Moves each state by its row of truth values.
    fn move_by(&self, q: &mut [u32], holds: &[bool]);
    /// What moves pay.
    fn pay(&self, rewards: &reward::Rewards, moves: &Arrivals<'_>, out: &mut [f64]);
    /// How the task has ended at a state.
    fn end(&self, q: &[u32]) -> Option<End>;
    /// The moves to acceptance at least.
    fn distance(&self, q: &[u32]) -> Option<u32>;
    /// By how much a row of the propositions' robustness moves the task on.
    fn progress(&self, q: &[u32], rho: &[f64]) -> f64;
}

impl Follows for Task {
    fn states_given(&self, q: &Bound<'_, PyAny>) -> PyResult<(Vec<u32>, Option<usize>)> {
        if let Ok(q) = q.extract() {
            return Ok((vec![self.state(q)?], None));
        }
        let states = self.states_of(q)?;
        let count = states.len();
        Ok((states, Some(count)))
    }

    fn move_by(&self, q: &mut [u32], holds: &[bool]) {
        match q {
            [q] => *q = self.moved(*q, holds),
            _ => self.move_all(q, &Letters::Labels(holds.into())),
        }
    }

    fn pay(&self, rewards: &reward::Rewards, moves: &Arrivals<'_>, out: &mut [f64]) {
        rewards.pay_all(&self.ends, moves, out);
    }

    fn end(&self, q: &[u32]) -> Option<End> {
        self.ends.end(q[0])
    }

    fn distance(&self, q: &[u32]) -> Option<u32> {
        self.inner.distance(q[0])
    }

    fn progress(&self, q: &[u32], rho: &[f64]) -> f64 {
        robustness::guard(self.automaton().progress(q[0]), |i| rho[i])
    }
}

impl Follows for Factored {
    fn states_given(&self, q: &Bound<'_, PyAny>) -> PyResult<(Vec<u32>, Option<usize>)> {
        let (states, shape) = self.states_of(q)?;
        Ok((states, (shape.len() > 1).then_some(shape[0])))
    }

    fn move_by(&self, q: &mut [u32], holds: &[bool]) {
        self.inner.step_batch(q, holds);
    }

    fn pay(&self, rewards: &reward::Rewards, moves: &Arrivals<'_>, out: &mut [f64]) {
        let parts = self.inner.parts().len();
        let states = moves.q.chunks_exact(parts).zip(moves.to.chunks_exact(parts));
        let given = |column: &[f64], i: usize| column.get(i).copied().unwrap_or_default();
        for (i, (out, (q, to))) in out.iter_mut().zip(states).enumerate() {
            *out = rewards.pay_joint(
                &self.ends,
                &JointArrival {
                    q,
                    to,
                    robustness: given(moves.robustness, i),
                    reward: given(moves.reward, i),
                    terminated: moves.terminated.get(i).copied().unwrap_or_default(),
                },
            );
        }
    }

    fn end(&self, q: &[u32]) -> Option<End> {
        self.ends.end(q)
    }

    fn distance(&self, q: &[u32]) -> Option<u32> {
        self.ends.distance(q)
    }

    fn progress(&self, q: &[u32], rho: &[f64]) -> f64 {
        let progress = self.rows.progress_robustness(q, rho);
        progress.expect("numbers are compared with 0, and none of them is NaN")
    }
}

/// Calls a generic function with the task that an object is, of either kind.
macro_rules! with_task {
    ($object:expr, $task:ident => $call:expr) => {
        if let Ok(task) = $object.cast::<Task>() {
            let $task = task.get();
            $call
        } else if let Ok(task) = $object.cast::<Factored>() {
            let $task = task.get();
            $call
        } else {
            Err(PyTypeError::new_err("task: a Task or a Factored is wanted"))
        }
    };
}
pub(crate) use with_task;

/// What steps of a world are for a task: a column for each thing that is told.
struct Steps {
    to: Vec<u32>,
    rho: Vec<f64>,
    paid: Vec<f64>,
    satisfied: Vec<bool>,
    lost: Vec<bool>,
    progress: Vec<bool>,
    distance: Vec<i64>,
}

/// What the world says of its steps, one or many.
struct World<'a> {
    holds: &'a [bool],
    /// Empty, unless it is paid for.
    robust: &'a [f64],
    reward: &'a [f64],
    terminated: &'a [bool],
}

fn followed<T: Follows>(
    task: &T,
    rewards: &reward::Rewards,
    q: &[u32],
    world: &World<'_>,
) -> Steps {
    let World { holds, robust, reward, terminated } = *world;
    let (parts, width) = (task.parts().unwrap_or(1), task.propositions().len());
    let rows = q.len() / parts;
    let mut to = q.to_vec();
    task.move_by(&mut to, holds);
    let rho: Vec<f64> = match rewards.needs_robustness() {
        true => {
            let row = |(i, q)| task.progress(q, &robust[i * width..][..width]);
            q.chunks_exact(parts).enumerate().map(row).collect()
        }
        false => Vec::new(),
    };
    let arrivals = Arrivals { q, to: &to, robustness: &rho, reward, terminated };
    let (mut paid, mut moved) = (vec![0.0; rows], vec![0.0; rows]);
    task.pay(rewards, &arrivals, &mut paid);
    let alone = Arrivals { q, to: &to, ..Arrivals::default() };
    task.pay(&reward::Rewards::progress(), &alone, &mut moved);
    let states = || to.chunks_exact(parts);
    let is = |end: End| states().map(|q| task.end(q) == Some(end)).collect();
    Steps {
        satisfied: is(End::Accepted),
        lost: is(End::Lost),
        progress: moved.iter().map(|&paid| paid > 0.0).collect(),
        distance: states().map(|q| task.distance(q).map_or(-1, i64::from)).collect(),
        to,
        rho,
        paid,
    }
}

/// What a step of the world is for the task in state `q`: the next state, what it pays, whether the
/// task is decided then, and what `info["tltl"]` says. For one state of an environment, what holds in
/// it is `labels`, or `robust` if the reward reads robustness.
#[pyfunction]
#[pyo3(signature = (task, rewards, q, labels, robust, reward, terminated))]
pub(crate) fn follow<'py>(
    task: &Bound<'py, PyAny>,
    rewards: &Bound<'py, Rewards>,
    q: &Bound<'py, PyAny>,
    labels: &Bound<'py, PyAny>,
    robust: Option<&Bound<'py, PyAny>>,
    reward: f64,
    terminated: bool,
) -> PyResult<(Bound<'py, PyAny>, f64, bool, Bound<'py, PyDict>)> {
    let rewards = &rewards.get().0;
    with_task!(task, task => of_one(task, rewards, q, (labels, robust), (reward, terminated)))
}

fn of_one<'py, T: Follows>(
    task: &T,
    rewards: &reward::Rewards,
    q: &Bound<'py, PyAny>,
    (labels, robust): (&Bound<'py, PyAny>, Option<&Bound<'py, PyAny>>),
    (reward, terminated): (f64, bool),
) -> PyResult<(Bound<'py, PyAny>, f64, bool, Bound<'py, PyDict>)> {
    let py = q.py();
    let (q, None) = task.states_given(q)? else {
        return Err(wrong("q: one state is wanted"));
    };
    let holds = task.row(labels)?;
    let robust = match rewards.needs_robustness() {
        true => labels::robustness(task.propositions(), robust.unwrap_or(labels))?,
        false => Vec::new(),
    };
    let (reward, terminated) = ([reward], [terminated]);
    let world = World { holds: &holds, robust: &robust, reward: &reward, terminated: &terminated };
    let steps = followed(task, rewards, &q, &world);
    let (state, told) = match task.parts() {
        None => {
            (steps.to[0].into_pyobject(py)?.into_any(), steps.to[0].into_pyobject(py)?.into_any())
        }
        Some(parts) => {
            let wide = steps.to.iter().map(|&q| i64::from(q)).collect();
            (shaped(py, steps.to.clone(), &[parts])?, shaped::<i64>(py, wide, &[parts])?)
        }
    };
    let info = PyDict::new(py);
    info.set_item(intern!(py, "state"), told)?;
    if let [rho] = steps.rho[..] {
        info.set_item(intern!(py, "rho"), rho)?;
    }
    info.set_item(intern!(py, "satisfied"), steps.satisfied[0])?;
    info.set_item(intern!(py, "lost"), steps.lost[0])?;
    info.set_item(intern!(py, "progress"), steps.progress[0])?;
    info.set_item(intern!(py, "distance"), steps.distance[0])?;
    let width = holds.len();
    info.set_item(intern!(py, "labels"), shaped(py, holds, &[width])?)?;
    info.set_item(intern!(py, "resampled"), 0)?;
    info.set_item(intern!(py, "terminated"), terminated[0])?;
    info.set_item(intern!(py, "environment"), reward[0])?;
    Ok((state, steps.paid[0], steps.satisfied[0] || steps.lost[0], info))
}

/// The same for many environments at once: `q` of shape (n,), or (n, parts), `labels` and `robust` of
/// shape (n, propositions), `reward` and `terminated` of shape (n,).
#[pyfunction]
#[pyo3(signature = (task, rewards, q, labels, robust, reward, terminated))]
pub(crate) fn follow_all<'py>(
    task: &Bound<'py, PyAny>,
    rewards: &Bound<'py, Rewards>,
    q: &Bound<'py, PyAny>,
    labels: &Bound<'py, PyAny>,
    robust: Option<&Bound<'py, PyAny>>,
    reward: &Bound<'py, PyAny>,
    terminated: &Bound<'py, PyAny>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyDict>)> {
    let rewards = &rewards.get().0;
    with_task!(task, task => of_many(task, rewards, q, (labels, robust), (reward, terminated)))
}

fn of_many<'py, T: Follows>(
    task: &T,
    rewards: &reward::Rewards,
    q: &Bound<'py, PyAny>,
    (labels, robust): (&Bound<'py, PyAny>, Option<&Bound<'py, PyAny>>),
    (reward, terminated): (&Bound<'py, PyAny>, &Bound<'py, PyAny>),
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyDict>)> {
    let py = q.py();
    let (q, Some(rows)) = task.states_given(q)? else {
        return Err(wrong("q: an array of states is wanted"));
    };
    let given = Array::new(labels, "labels")?;
    let wanted = [rows, task.propositions().len()];
    if *given.shape() != wanted {
        let found = given.shape();
        return Err(wrong(format!("labels: an array of shape {found:?}; wanted is {wanted:?}")));
    }
    let holds = labels::truths(task.propositions(), &given)?;
    let robust = match rewards.needs_robustness() {
        true => labels::rows(task.propositions(), robust.unwrap_or(labels), rows)?,
        false => Vec::new(),
    };
    let reward = column(Some(reward), "reward", rows)?;
    let ended = column(Some(terminated), "terminated", rows)?;
    let ended: Vec<bool> = ended.iter().map(|&ended| ended > 0.0).collect();
    let steps = py.detach(|| {
        let world = World { holds: &holds, robust: &robust, reward: &reward, terminated: &ended };
        followed(task, rewards, &q, &world)
    });
    let shape: Vec<usize> = [rows].into_iter().chain(task.parts()).collect();
    let info = PyDict::new(py);
    if !steps.rho.is_empty() {
        info.set_item("rho", shaped(py, steps.rho, &[rows])?)?;
    }
    let wide = steps.to.iter().map(|&q| i64::from(q)).collect();
    info.set_item("state", shaped::<i64>(py, wide, &shape)?)?;
    info.set_item("satisfied", shaped(py, steps.satisfied, &[rows])?)?;
    info.set_item("lost", shaped(py, steps.lost, &[rows])?)?;
    info.set_item("progress", shaped(py, steps.progress, &[rows])?)?;
    info.set_item("distance", shaped(py, steps.distance, &[rows])?)?;
    info.set_item("labels", shaped(py, holds.into_owned(), &wanted)?)?;
    info.set_item("resampled", shaped(py, vec![0_i64; rows], &[rows])?)?;
    info.set_item("terminated", shaped(py, ended, &[rows])?)?;
    info.set_item("environment", shaped(py, reward, &[rows])?)?;
    Ok((shaped(py, steps.to, &shape)?, shaped(py, steps.paid, &[rows])?, info))
}
