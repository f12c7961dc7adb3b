"""Stored experience, seen by every state of the automaton.

A step of the world does not depend on the task: whoever has (s, a, s') and what holds in s' knows what
every automaton state would have made of it. So one step teaches as many as there are live states,
and experience of one task teaches another.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tltl._core import Product, Rewards, Task, relabelled

__all__ = ["Relabelled", "relabel"]


@dataclass(frozen=True)
class Relabelled:
    """Transitions of the augmented world: arrays of shape (m,), one entry for each."""

    #: The stored step that it comes from.
    index: NDArray[np.int64]
    #: The automaton state before.
    q: NDArray[np.uint32]
    #: The automaton state after.
    next_q: NDArray[np.uint32]
    #: What it pays.
    reward: NDArray[np.float64]
    #: Whether the episode ends there, for the task or for the environment.
    terminated: NDArray[np.bool_]


def relabel(
    task: Task | Product,
    next_labels: ArrayLike,
    *,
    rewards: Rewards,
    reward: ArrayLike | None = None,
    terminated: ArrayLike | None = None,
    states: Literal["all"] | int = "all",
    seed: int | None = None,
) -> Relabelled:
    """The transitions that stored steps are for every live automaton state.

    `next_labels`, of shape (n, propositions), is what holds in the state that each step arrives at:
    truth values, or robustness, which the mode `robustness` pays. `reward` and `terminated`, of shape
    (n,), are the environment's. With a number of `states`, so many are drawn for each step, with
    replacement, by `seed`.

    >>> import numpy as np
    >>> from tltl import Rewards, Task
    >>> from tltl.replay import relabel
    >>> seen = relabel(Task("a T b"), [[True, False], [False, True]], rewards=Rewards("acceptance"))
    >>> seen.index.tolist(), seen.q.tolist(), seen.next_q.tolist(), seen.reward.tolist()
    ([0, 0, 1, 1], [0, 1, 0, 1], [1, 1, 0, 2], [0.0, 0.0, 0.0, 1.0])
    """
    task = task.task if isinstance(task, Product) else task
    if not isinstance(task, Task):
        raise TypeError(f"{task!r}: wanted is a task with one automaton, whose states can be listed")
    rho = np.asarray(next_labels)
    if rho.ndim != 2 or rho.shape[1] != len(task.propositions):
        wanted = f"(n, {len(task.propositions)}): {', '.join(task.propositions)}"
        raise ValueError(f"next_labels: shape {rho.shape}; wanted is {wanted}")
    is_end = np.isin(np.arange(task.num_states), [end for end in ends(task) if end is not None])
    live = np.flatnonzero(~is_end).astype(np.uint32)
    steps = len(rho)
    if states == "all":
        each, q = len(live), np.tile(live, steps)
    else:
        each = states if len(live) else 0
        q = np.random.default_rng(seed).choice(live, each * steps) if each else live
    m = len(q)
    # NumPy's own arrays lie in large pages, where they are large: to touch the small ones of others
    # takes as long as all the rest.
    index, next_q = np.empty(m, np.int64), np.empty(m, np.uint32)
    paid, over = np.empty(m, np.float64), np.empty(m, np.bool_)
    relabelled(task, rewards, rho, reward, terminated, (index, q, next_q, paid, over))
    return Relabelled(index, q, next_q, paid, over)


def ends(task: Task) -> tuple[int | None, int | None]:
    """The states in which an episode is over."""
    return task.accepting, task.trap
