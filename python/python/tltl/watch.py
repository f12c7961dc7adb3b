"""Training that can be watched: progress, metrics in files, and an end once a certificate is good enough.

>>> import gymnasium as gym
>>> from tltl import FiniteModel, Learner, solve
>>> from tltl.watch import train
>>> model = FiniteModel.from_env(gym.make("FrozenLake-v1", is_slippery=False))
>>> task, labels = "corner T goal", lambda s: {"corner": s == 3, "goal": s == 15}
>>> learner, solution = Learner(model, task, labels, seed=1), solve(model, task, labels)
>>> metrics = train(learner, 1_000_000, every=10_000, solution=solution, within=0.01)
>>> metrics[-1]["satisfied"], metrics[-1]["steps_of_policy"], learner.steps < 1_000_000
(1.0, 8.0, True)
"""

from __future__ import annotations

import importlib
import json
import os
import sys
import time
from pathlib import Path
from typing import Any, Protocol

from tltl._core import Learner, Solution

__all__ = ["train"]

#: A line of metrics.
Metrics = dict[str, float]


class _Writer(Protocol):
    def add_scalar(self, tag: str, value: float, step: int) -> Any: ...
    def close(self) -> None: ...


def train(
    learner: Learner,
    steps: int,
    *,
    every: int | None = None,
    solution: Solution | None = None,
    within: float | None = None,
    log: str | os.PathLike[str] | None = None,
    progress: bool | None = None,
) -> list[Metrics]:
    """Trains `learner` until so many steps have been taken in all, in slices of `every` steps (a fiftieth
    of `steps` if left out), and returns the metrics of each slice. Slices change nothing in what is learned.

    With `solution`, of `tltl.solve`, each slice is certified; with `within` too, training ends as soon as
    the policy gives away at most that much of P(satisfied) and takes at most that share more than the fewest
    steps: 0.01 is one point, and 1 %.

    `log` is a folder. It gets `metrics.jsonl`, a line for each slice as soon as it is over, and TensorBoard's
    event files where PyTorch's writer or `tensorboardX` can be imported (`pip install 'tltl[tensorboard]'`).

    `progress` says whether a line with rate and remaining time is kept on the standard error; if left out,
    where that is a terminal.

    The metrics: `learner_steps`, `episodes`, `steps_per_second`, and of a certificate `satisfied`,
    `steps_of_policy` (left out if no episode succeeds), `regret_satisfied`, `regret_steps` (likewise).

    Raises `TypeError` if `learner` is not a `Learner`, and `ValueError` if `within` has no `solution`, or `every`
    is less than 1.
    """
    if not isinstance(learner, Learner):
        raise TypeError(f"`learner` is a {type(learner).__name__}, not a tltl.Learner")
    if within is not None and solution is None:
        raise ValueError("`within` needs `solution`: what the policy is compared with")
    if every is None:
        every = max(1, steps // 50)
    if every < 1:
        raise ValueError(f"`every` is {every}, not at least 1")
    shown = sys.stderr.isatty() if progress is None else progress
    found: list[Metrics] = []
    writer, lines = _writer(log), None
    if log is not None:
        Path(log).mkdir(parents=True, exist_ok=True)
        lines = (Path(log) / "metrics.jsonl").open("a", encoding="utf-8")
    begun, first = time.perf_counter(), learner.steps
    try:
        while learner.steps < steps:
            had, start = learner.steps, time.perf_counter()
            learner.train(min(had + every, steps))
            taken = time.perf_counter() - start
            metrics: Metrics = {
                "learner_steps": learner.steps,
                "episodes": learner.episodes,
                "steps_per_second": round((learner.steps - had) / max(taken, 1e-9)),
            }
            if solution is not None:
                metrics |= _worth(learner, solution)
            found.append(metrics)
            if lines is not None:
                lines.write(json.dumps(metrics) + "\n")
                lines.flush()
            if writer is not None:
                for name, value in metrics.items():
                    if name != "learner_steps":
                        writer.add_scalar(name, value, learner.steps)
            if shown:
                _show(learner.steps, first, steps, time.perf_counter() - begun, metrics)
            if learner.steps == had:
                break  # every episode is over at its start
            if within is not None and _is_within(metrics, within):
                break
    finally:
        if shown and found:
            print(file=sys.stderr)
        if lines is not None:
            lines.close()
        if writer is not None:
            writer.close()
    return found


def _worth(learner: Learner, solution: Solution) -> Metrics:
    certificate = learner.certify(solution)
    worth = {
        "satisfied": certificate.satisfied,
        "steps_of_policy": certificate.steps,
        "regret_satisfied": certificate.regret_satisfied,
        "regret_steps": certificate.regret_steps,
    }
    return {name: value for name, value in worth.items() if value is not None}


def _is_within(metrics: Metrics, within: float) -> bool:
    # Where the best policy never succeeds there are no steps to compare.
    return metrics["regret_satisfied"] <= within and metrics.get("regret_steps", 0.0) <= within


def _writer(log: str | os.PathLike[str] | None) -> _Writer | None:
    """TensorBoard's writer, the first that can be imported."""
    if log is None:
        return None
    for name in ("torch.utils.tensorboard", "tensorboardX"):
        try:
            module = importlib.import_module(name)
        except ImportError:
            continue
        writer: _Writer = module.SummaryWriter(os.fspath(log))
        return writer
    return None


def _show(done: int, first: int, steps: int, taken: float, metrics: Metrics) -> None:
    rate = (done - first) / max(taken, 1e-9)
    left = max(steps - done, 0) / max(rate, 1e-9)
    worth = f", P {metrics['satisfied']:.4f}" if "satisfied" in metrics else ""
    line = f"{done:,} of {steps:,} steps, {rate:,.0f} a second, {left:.0f} s left{worth}"
    print(f"\r{line:<78}", end="", file=sys.stderr, flush=True)
