"""Exact results on the tables of Gymnasium, against value iteration in NumPy."""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from toy_text import newest

from tltl import FiniteModel, Rewards, Task, solve


def iterated(
    P: Any, task: Task, labels: Any, steps: int, starts: Any, policy: Any = None
) -> tuple[float, Any]:
    """P(satisfied) within so many steps, the largest or that of a policy: mean over the starts, and of
    each pair. Outcomes that end the episode are worth nothing but acceptance on arrival."""
    states, actions = len(P), len(P[0])
    rows = np.array([[bool(labels(s)[name]) for name in task.propositions] for s in range(states)])
    moved = np.array(
        [task.step_batch(np.full(states, q), rows) for q in range(task.num_states)], dtype=int
    )
    value = np.zeros((task.num_states, states))
    for _ in range(steps):
        arrival = np.zeros((task.num_states, states, actions))
        for s in range(states):
            for a in range(actions):
                for p, to, _, done in P[s][a]:
                    after = moved[:, to]
                    ends = np.where(done, 0.0, value[after, to])
                    arrival[:, s, a] += p * np.where(after == task.accepting, 1.0, ends)
        if policy is None:
            new = arrival.max(-1)
        else:
            new = np.take_along_axis(arrival, policy[..., None], -1)[..., 0]
        if np.abs(new - value).max() < 1e-13:
            break
        value = new
    first = moved[task.initial]
    at_start = np.where(first == task.accepting, 1.0, value[first, np.arange(states)])
    return float(np.asarray(starts) @ at_start), value


def cells(s: int) -> dict[str, bool]:
    return {"corner": s == 3, "goal": s == 15}


def test_frozen_lake_is_what_value_iteration_says() -> None:
    env = gym.make("FrozenLake-v1")
    model = FiniteModel.from_env(env)
    assert (model.num_states, model.num_actions, model.horizon) == (16, 4, 100)
    world: Any = env.unwrapped
    starts = world.initial_state_distrib
    for formula, most, within in (("F goal", 14 / 17, 0.7442), ("corner T goal", 14 / 17, 0.6060)):
        task = Task(formula)
        best = solve(model, task, cells)
        worth = best.certify(best.policy)
        assert worth.satisfied == pytest.approx(most, abs=1e-9)
        assert worth.optimal_satisfied == pytest.approx(most, abs=1e-9)
        assert worth.optimal_satisfied_within == pytest.approx(within, abs=5e-5)
        long, values = iterated(world.P, task, cells, 20_000, starts)
        assert worth.optimal_satisfied == pytest.approx(long, abs=1e-9)
        live = [q for q in range(task.num_states) if q not in (task.accepting, task.trap)]
        assert np.allclose(best.satisfied[live], values[live], atol=1e-9)
        cut, _ = iterated(world.P, task, cells, 100, starts)
        assert worth.optimal_satisfied_within == pytest.approx(cut, abs=1e-12)
        own, _ = iterated(world.P, task, cells, 100, starts, best.policy.table)
        assert worth.satisfied_within == pytest.approx(own, abs=1e-12)
        # A function, a table and a worse policy.
        table = best.policy.table
        assert best.certify(table).satisfied == worth.satisfied
        same = best.certify(lambda q, s: int(table[q, s]))
        assert same.satisfied == worth.satisfied
        down = best.certify(np.ones_like(table), within=7)
        expected, _ = iterated(world.P, task, cells, 7, starts, np.ones_like(table))
        assert down.satisfied_within == pytest.approx(expected, abs=1e-12)
        assert down.regret_satisfied > 0.5 and down.starts[0][0] == 0
        assert str(worth).splitlines()[0].split() == [
            "this", "policy", "best", "possible", "regret",
        ]
        assert "P(satisfied in 100 steps)" in str(worth)


def test_nothing_is_read_after_the_end() -> None:
    lake = FiniteModel.from_env(gym.make("FrozenLake-v1"))
    best = solve(lake, "F (goal && X goal)", cells)
    assert best.certify(best.policy).optimal_satisfied == 0.0
    cliff = FiniteModel.from_env(gym.make(newest("CliffWalking")))
    places = lambda s: {"goal": s == 47, "start": s == 36}  # noqa: E731
    best = solve(cliff, "goal T start", places)
    assert best.certify(best.policy).optimal_satisfied == 0.0
    best = solve(cliff, "F goal", places)
    worth = best.certify(best.policy)
    assert worth.satisfied == 1.0 and worth.steps == pytest.approx(13.0)


def test_events_are_what_happens_on_the_way() -> None:
    env = gym.make(newest("CliffWalking"))
    falls = lambda s, a, to, reward: "cliff" if reward <= -100 else None  # noqa: E731
    model = FiniteModel.from_env(env, events=falls)
    assert model.num_states == 49 and model.origin[48] == 36 and model.event[48] == "cliff"
    told = lambda s, event: {"goal": s == 47, "cliff": event == "cliff"}  # noqa: E731
    safe = solve(model, "F goal ensuring !cliff", told)
    fallen = solve(model, "cliff T goal", told)
    assert safe.certify(safe.policy).steps == pytest.approx(13.0)
    # One step into the cliff, and then the way.
    assert fallen.certify(fallen.policy).steps == pytest.approx(14.0)


def test_arrays_are_the_tables() -> None:
    env: Any = gym.make("FrozenLake-v1").unwrapped
    rows = [env.P[s][a] for s in range(16) for a in range(4)]
    indptr = np.cumsum([0, *map(len, rows)])
    p, to, _, done = (np.array(column) for column in zip(*sum(rows, []), strict=True))
    model = FiniteModel.from_arrays(
        indptr, to.astype(int), p, actions=4, ends=done, starts=env.initial_state_distrib
    )
    by_table = FiniteModel.from_transitions(env.P, starts=env.initial_state_distrib)
    task = Task("corner T goal")
    labels = np.array([[s == 3, s == 15] for s in range(16)])
    one, other = solve(model, task, labels), solve(by_table, task, cells)
    assert np.array_equal(one.satisfied, other.satisfied)
    assert np.array_equal(one.Q, other.Q) and one.Q.shape == (task.num_states, 16, 4)
    assert model.horizon is None and one.certify(one.policy).within is None


def test_what_is_wrong_is_named() -> None:
    with pytest.raises(ValueError, match="action 0 in state 1: the outcomes are not a distribution"):
        FiniteModel.from_arrays([0, 1, 2], [0, 1], [1.0, 0.5], actions=1)
    for indptr in ([0, 2, 1], [1, 2], [0], [0, 1, 2, 2]):
        with pytest.raises(ValueError, match="indptr|distribution"):
            FiniteModel.from_arrays(indptr, [0, 1], [1.0, 1.0], actions=2)
    with pytest.raises(ValueError, match=r"indices\[1\] is 7"):
        FiniteModel.from_arrays([0, 1, 2], [0, 7], [1.0, 1.0], actions=1)
    with pytest.raises(ValueError, match="ends: 1 entries; wanted are 2"):
        FiniteModel.from_arrays([0, 1, 2], [0, 1], [1.0, 1.0], actions=1, ends=[True])
    with pytest.raises(ValueError, match="not a distribution"):
        FiniteModel.from_arrays([0, 1, 2], [0, 1], [1.0, 1.0], actions=1, starts=[-1.0, 2.0])
    model = FiniteModel.from_arrays([0, 1, 2], [1, 1], [1.0, 1.0], actions=1)
    with pytest.raises(ValueError, match="`a` is missing; given: b"):
        solve(model, "F a", lambda s: {"b": True})
    with pytest.raises(ValueError, match="mode `robustness`"):
        solve(model, "F a", [[0.0], [1.0]], rewards=Rewards("robustness"))
    best = solve(model, "F a", [[0.0], [1.0]])
    assert best.certify([[0, 0], [0, 0]]).satisfied == 1.0
    with pytest.raises(ValueError, match=r"wanted is \(2, 2\)"):
        best.certify([0, 0])
    with pytest.raises(ValueError, match="9 is not less than 1"):
        best.certify([[9, 0], [0, 0]])
    with pytest.raises(ValueError, match="no table of transitions"):
        FiniteModel.from_env(gym.make("CartPole-v1"))
