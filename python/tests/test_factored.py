"""Factored tasks: their parts side by side, against the one automaton of the same formula."""

from __future__ import annotations

import copy
import pickle
import warnings
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces
from gymnasium.utils.env_checker import check_env
from test_gymnasium import MODES, Tape, abc

import tltl
from tltl import Factored, Rewards, Task
from tltl.gymnasium import TaskEnv
from tltl.replay import relabel

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


WALKS = "state S { a: bool, b: bool, c: bool } MARK task t = F a && F b && G[1,3] !c"


def pair() -> tuple[Factored, Task]:
    """The same task, part by part and as one automaton."""
    tasks = [tltl.TaskFile.from_text(WALKS.replace("MARK", mark)).task() for mark in ("#[factored]", "")]
    factored, whole = tasks
    assert isinstance(factored, Factored) and isinstance(whole, Task) and len(factored.parts) == 3
    return factored, whole


def potential(task: Factored, q: Any) -> float:
    """The mean over the parts of how near each is, those that are done counting 1; 0 at the ends."""
    near = []
    for part, state in zip(task.parts, q.tolist(), strict=True):
        if state == part.trap:
            return 0.0
        near.append(1 - part.distances[state] / (part.distances.max() + 1))
    return 0.0 if all(one == 1 for one in near) else float(np.mean(near))


@pytest.mark.parametrize("mode", MODES)
def test_an_environment_pays_what_the_one_automaton_does(mode: str) -> None:
    factored, whole = pair()
    rewards = Rewards(mode, gamma=0.9, environment=0.5, step_penalty=0.25, trap_penalty=2.0)
    eyes, ends = [np.eye(part.num_states) for part in factored.parts], set()
    for _ in range(300):
        letters, end = RNG.integers(0, 8, 12).tolist(), int(RNG.integers(1, 11))
        envs = [TaskEnv(Tape(letters, end), task, abc, rewards=rewards) for task in (factored, whole)]
        (_, info), _ = (env.reset() for env in envs)
        over, told = False, info["tltl"]
        q = told["state"]
        while not over:
            (obs, paid, over, _, info), (_, expected, is_over, _, own) = (env.step(0) for env in envs)
            told, before, q = info["tltl"], q, info["tltl"]["state"]
            for name in ("satisfied", "lost", "terminated", "environment"):
                assert told[name] == own["tltl"][name]
            hot = [eye[state] for eye, state in zip(eyes, q, strict=True)]
            assert np.array_equal(obs[8:], np.concatenate(hot))
            if mode == "shaped":
                after = 0.0 if told["terminated"] else potential(factored, q)
                expected = float(told["satisfied"]) + 0.9 * after - potential(factored, before)
                expected -= 0.25 + 2.0 * told["lost"] + 0.5
            assert paid == pytest.approx(expected) and over == is_over
        ends.add((bool(told["satisfied"]), bool(told["lost"])))
    assert ends == {(True, False), (False, True), (False, False)}


@pytest.mark.parametrize("observe", ["flat", "dict", "none"])
def test_the_checker_of_gymnasium_is_content(observe: Any) -> None:
    text = "state S { x: f64, v: f64 } #[factored] task t = F x > 0.02 && F x < -0.02 && F v > 0.3"
    task = tltl.TaskFile.from_text(text).task()
    env = TaskEnv(gym.make("CartPole-v1"), task, columns={"x": 0, "v": 1}, observe=observe)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        check_env(env, skip_render_check=True)
    if observe == "dict":
        named: Any = env.observation_space
        assert named["task_state"] == spaces.MultiDiscrete([2, 2, 2])


def test_what_needs_one_automaton_says_so() -> None:
    factored, whole = pair()
    with pytest.raises(TypeError, match="wanted is a task with one automaton"):
        relabel(factored, np.zeros((2, 3)), rewards=Rewards())  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a Task or a Factored is wanted"):
        Rewards().pay("F a", 0, 1)  # type: ignore[call-overload]
    q = np.zeros((4, 3), np.uint32)
    with pytest.raises(ValueError, match="next_q: 2 states; q has 4"):
        Rewards().pay(factored, q, q[:2])
    assert Rewards("progress").pay(factored, q[0], np.array([1, 0, 0])) == 1.0
    assert Rewards("progress").pay(factored, q, q).tolist() == [0.0] * 4
    assert Rewards("progress").pay(whole, 0, 0) == 0.0
