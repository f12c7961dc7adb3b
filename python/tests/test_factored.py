"""Factored tasks: their parts side by side, against the one automaton of the same formula."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import tltl
from tltl import Factored, Task

TEXT = """
state S { a: bool, b: bool, x: f64, wet: bool }
{mark} task tour(far: f64) = F a && F b && (!wet U x > far)
"""
RNG = np.random.default_rng(3)


def tour(mark: str = "#[factored]") -> Factored | Task:
    task = tltl.TaskFile.from_text(TEXT.replace("{mark}", mark)).task("tour", far=0.5)
    assert isinstance(task, Factored if mark else Task)
    return task


def test_a_factored_task_is_its_conjunction() -> None:
    factored, whole = tour(), tour("")
    assert isinstance(factored, Factored) and isinstance(whole, Task)
    assert factored.propositions == whole.propositions and len(factored.parts) == 3
    assert factored.text == whole.text and factored.name == "tour"
    assert [one.name for one in factored.inputs] == [one.name for one in whole.inputs]
    states = RNG.normal(size=(40, 6, 4))
    states[..., [0, 1, 3]] = states[..., [0, 1, 3]] > 0.7
    columns = {"a": 0, "b": 1, "x": 2, "wet": 3}
    labels = factored.labels(states, columns=columns)
    assert np.array_equal(labels, whole.labels(states, columns=columns))
    q, one = np.tile(factored.initial, (40, 1)), np.zeros(40, np.uint32)
    for t in range(6):
        q, one = factored.step_batch(q, labels[:, t]), whole.step_batch(one, labels[:, t])
        assert np.array_equal(factored.is_satisfied(q), one == whole.accepting)
        assert np.array_equal(factored.is_lost(q), one == whole.trap)
        # Each part is where its own automaton is.
        for i, part in enumerate(factored.parts):
            places = [factored.propositions.index(name) for name in part.propositions]
            alone = np.zeros(40, np.uint32)
            for s in range(t + 1):
                alone = part.step_batch(alone, labels[:, s][:, places])
            assert np.array_equal(q[:, i], alone)
    for walk, end in zip(states, q, strict=True):
        run, other = factored.run(walk, columns=columns), whole.run(walk, columns=columns)
        assert run.states.shape == (6, 3) and run.states[-1].tolist() == end.tolist()
        assert (run.verdict, run.since, run.robustness) == (other.verdict, other.since, other.robustness)
    holds = {"a": True, "b": False, "x > far": True, "x > 0.5": True, "wet": False}
    step = factored.step(factored.initial, {**holds, **dict.fromkeys(factored.propositions, True)})
    assert step.shape == (3,) and not factored.is_lost(step)


def test_factored_tasks_pickle_and_say_what_is_wrong() -> None:
    factored = tour()
    assert isinstance(factored, Factored) and "3 parts" in repr(factored)
    for other in (pickle.loads(pickle.dumps(factored)), copy.deepcopy(factored)):
        assert [part.fingerprint for part in other.parts] == [p.fingerprint for p in factored.parts]
        assert other.text == factored.text
    for wrong, error, message in (
        ([0, 0], ValueError, r"wanted is \(3,\) or \(n, 3\)"),
        ([0, 9, 0], IndexError, "q is 9 in part 1, whose automaton has 2 states"),
        ([0, -1, 0], ValueError, "whole numbers from 0 on"),
        ([[0, 0, 0]], ValueError, "one state is wanted"),
    ):
        with pytest.raises(error, match=message):
            factored.step(wrong, [True] * 4)
    with pytest.raises(ValueError, match="is missing"):
        factored.step(factored.initial, {"a": True})
    with pytest.raises(ValueError, match="labels: an array of shape"):
        factored.step_batch([[0, 0, 0]], [[True]])


def test_many_goals_need_no_product() -> None:
    names = [f"g{i}" for i in range(24)]
    fields = ", ".join(f"{name}: bool" for name in names)
    goals = " && ".join(f"F {name}" for name in names)
    text = f"state S {{ {fields} }} #[factored] task all = {goals}"
    task = tltl.TaskFile.from_text(text).task()
    q = task.initial
    for name in names:
        assert not task.is_satisfied(q)
        q = task.step(q, {name})
    assert task.is_satisfied(q) and q.tolist() == [1] * 24
