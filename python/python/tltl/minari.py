"""Minari: recorded episodes as steps of a task.

A data set has no task in it. What its states hold is read here, so that `tltl.replay.relabel` gives the
transitions that its steps are for every state of an automaton, and `FiniteModel.from_experience` a world.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl._core import Task
from tltl._labels import Labels
from tltl.gymnasium import Columns

from gymnasium import spaces  # isort: skip

try:
    import minari  # noqa: F401
except ImportError:
    raise ImportError("tltl.minari needs Minari: pip install 'tltl[minari]'")

__all__ = ["Steps", "steps"]

#: What holds in a recorded state: an observation.
RecordedLabelFn = Callable[[Any], Labels]


@dataclass(frozen=True)
class Steps:
    """The steps of all episodes, one after the other: arrays of shape (n, …)."""

    #: What was seen before the step, flattened.
    observations: NDArray[Any]
    actions: NDArray[Any]
    #: What was seen after it.
    next_observations: NDArray[Any]
    #: What the environment paid.
    rewards: NDArray[np.float64]
    #: Whether the environment ended the episode itself.
    terminated: NDArray[np.bool_]
    #: What holds after it, of shape (n, propositions): robustness where the task has numeric predicates.
    labels: NDArray[np.float64]
    #: The automaton states before and after it, along the episode as it was recorded.
    q: NDArray[np.uint32]
    next_q: NDArray[np.uint32]
    #: The number of the episode.
    episode: NDArray[np.int64]


def steps(
    dataset: Iterable[Any],
    task: Task | str,
    labels: RecordedLabelFn | None = None,
    *,
    space: spaces.Space[Any] | None = None,
    columns: Columns | None = None,
) -> Steps:
    """The steps of a Minari data set, or of some of its episodes, with what the task makes of them.

    `labels(observation)` says what holds in a state, or `columns` where flattened observations have the
    numbers that the task reads. `space` is that of the observations: the data set's, if left out.

    Raises `ValueError` if both or none of `labels` and `columns` are given, or there is no episode.
    """
    if (labels is None) == (columns is None):
        raise ValueError("give `labels` or `columns`: what holds, or where the numbers are")
    task = Task(task) if isinstance(task, str) else task
    space = dataset.observation_space if space is None else space  # type: ignore[attr-defined]
    parts: list[tuple[Any, ...]] = []
    for number, episode in enumerate(dataset):
        seen = list(states_of(episode.observations, len(episode.rewards) + 1))
        rows: list[Any] = [spaces.flatten(space, one) for one in seen]
        flat = np.stack(rows)
        if labels is None:
            rho = task.rho(flat, columns=columns)
        else:
            rho = np.stack([robust(task, labels(one)) for one in seen])
        run, start = task.initial, []
        for row in rho:
            run = task.step(run, row)
            start.append(run)
        q, count = np.array(start, np.uint32), len(episode.rewards)
        parts.append(
            (
                flat[:-1],
                np.asarray(episode.actions),
                flat[1:],
                np.asarray(episode.rewards, np.float64),
                np.asarray(episode.terminations, bool),
                rho[1:],
                q[:-1],
                q[1:],
                np.full(count, number),
            )
        )
    if not parts:
        raise ValueError("dataset: there are no episodes")
    return Steps(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def robust(task: Task, labels: Labels) -> NDArray[np.float64]:
    """What holds as numbers: 1 and -1."""
    return np.where(task.valuation(labels), 1.0, -1.0)


def states_of(observations: Any, count: int) -> Iterable[Any]:
    """The observations of an episode, one by one: Minari keeps those of `Dict` and `Tuple` by part."""
    if isinstance(observations, dict):
        parts = {name: list(states_of(part, count)) for name, part in observations.items()}
        return [{name: part[t] for name, part in parts.items()} for t in range(count)]
    if isinstance(observations, tuple):
        each = [list(states_of(part, count)) for part in observations]
        return [tuple(part[t] for part in each) for t in range(count)]
    return [observations[t] for t in range(count)]
