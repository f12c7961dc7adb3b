"""Worlds that nobody here wrote: exact results, learned policies, and tasks in simulators."""

from __future__ import annotations

import copy
import warnings
from collections import deque
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from conftest import since_1_1
from gymnasium.utils.env_checker import check_env
from toy_text import newest

from tltl import FiniteModel, Learner, Task, solve
from tltl.gymnasium import TaskEnv

minigrid = pytest.importorskip("minigrid")

LAKE_8 = [
    "SFFFFFFF", "FFFFFFFF", "FFFHFFFF", "FFFFFHFF", "FFFHFFFF", "FHHFFFHF", "FHFFHFHF", "FFFHFFFG",
]  # fmt: skip


def small_lake(s: int) -> dict[str, bool]:
    return {"corner": s == 3, "goal": s == 15, "hole": s in (5, 7, 11, 12)}


def large_lake(s: int) -> dict[str, bool]:
    return {"corner": s == 7, "goal": s == 63, "hole": LAKE_8[s // 8][s % 8] == "H"}


def taxi(s: int) -> dict[str, bool]:
    passenger, destination = s // 4 % 5, s % 4
    return {"aboard": passenger == 4, "home": passenger == destination}


def cliff(s: int) -> dict[str, bool]:
    return {"corner": s == 0, "goal": s == 47}


WORLDS: dict[str, tuple[str, dict[str, Any], str, Any]] = {
    "lake": ("FrozenLake-v1", {}, "corner T goal", small_lake),
    "dry lake": ("FrozenLake-v1", {"is_slippery": False}, "corner T goal", small_lake),
    "lake without holes": ("FrozenLake-v1", {}, "!hole U goal", small_lake),
    "large lake": ("FrozenLake8x8-v1", {}, "corner T goal", large_lake),
    "large lake, both": ("FrozenLake8x8-v1", {}, "F corner && F goal ensuring !hole", large_lake),
    "taxi": (newest("Taxi"), {}, "aboard T home", taxi),
    "cliff": (newest("CliffWalking"), {}, "corner T goal", cliff),
    "slippery cliff": (newest("CliffWalking"), {"is_slippery": True}, "corner T goal", cliff),
}


def iterated(env: Any, task: Task, labels: Any, steps: int | None) -> Any:
    """The largest P(satisfied) from each live pair by value iteration, with a number of steps or until
    nothing changes; outcomes that end the episode are worth nothing but acceptance on arrival."""
    P = env.unwrapped.P
    states, actions = len(P), len(P[0])
    rows = np.array([[labels(s)[name] for name in task.propositions] for s in range(states)])
    after = np.array([task.step_batch(np.full(states, q), rows) for q in range(task.num_states)])
    goes, ends = np.zeros((2, states * actions, states))
    for s, a in np.ndindex(states, actions):
        for p, to, _, done in P[s][a]:
            (ends if done else goes)[s * actions + a, to] += p
    value, at = np.zeros(after.shape), np.arange(states)
    for _ in range(100_000 if steps is None else steps):
        new = np.zeros_like(value)
        for q in range(task.num_states):
            accepted = after[q] == task.accepting
            arrived = np.where(accepted, 1.0, value[after[q], at])
            worth = goes @ arrived + ends @ accepted
            new[q] = worth.reshape(states, actions).max(1)
        new[[end for end in (task.accepting, task.trap) if end is not None]] = 0.0
        if np.abs(new - value).max() < 1e-14:
            break
        value = new
    return value


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=since_1_1) if "slippery" in name else name for name in WORLDS],
)
def test_solutions_are_those_of_value_iteration(name: str) -> None:
    world, options, formula, labels = WORLDS[name]
    env, task = gym.make(world, **options), Task(formula)
    best = solve(FiniteModel.from_env(env), task, labels)
    live = [q for q in range(task.num_states) if q not in (task.accepting, task.trap)]
    assert np.abs(best.satisfied[live] - iterated(env, task, labels, None)[live]).max() < 1e-9
    worth = best.certify(best.policy, within=60)
    rows = np.array([[labels(s)[name] for name in task.propositions] for s in range(best.Q.shape[1])])
    first = task.step_batch(np.full(len(rows), task.initial), rows)
    cut = iterated(env, task, labels, 60)[first, np.arange(len(rows))]
    cut = np.where(first == task.accepting, 1.0, cut)
    unwrapped: Any = env.unwrapped
    assert worth.optimal_satisfied_within == pytest.approx(unwrapped.initial_state_distrib @ cut)
    assert abs(worth.regret_satisfied) < 1e-9 and abs(worth.regret_steps or 0.0) < 1e-9
    assert worth.satisfied_error is not None and worth.satisfied_error < 1e-7
    assert worth.steps_error is not None and worth.steps_error < 1e-5 * (worth.steps or 1.0)


@pytest.mark.parametrize(("name", "steps"), [("lake", 300_000), ("large lake", 600_000),
                                             ("taxi", 600_000),
                                             pytest.param("slippery cliff", 300_000, marks=since_1_1)])
def test_what_is_learned_is_certified(name: str, steps: int) -> None:
    world, options, formula, labels = WORLDS[name]
    model = FiniteModel.from_env(gym.make(world, **options))
    best = solve(model, formula, labels)
    worth = Learner(model, formula, labels, seed=1).train(steps).certify(best)
    assert worth.regret_satisfied < 1e-3 and (worth.regret_steps or 0.0) < 1e-2


@pytest.mark.parametrize(
    "name",
    ["lake", "lake without holes", "large lake", "taxi", pytest.param("slippery cliff", marks=since_1_1)],
)
def test_what_is_certified_is_what_happens(name: str) -> None:
    """Episodes in the environment itself, with its own time limit, against the exact probability."""
    world, options, formula, labels = WORLDS[name]
    base = gym.make(world, **options)
    best = solve(FiniteModel.from_env(base), formula, labels)
    limit = base.spec.max_episode_steps if base.spec else None
    policy, worth = best.policy, best.certify(best.policy, within=limit or 60)
    seen: Any = lambda env, obs, info: labels(int(obs))  # noqa: E731
    env = TaskEnv(base, formula, seen, observe="none", on_decided_reset="keep")
    episodes, satisfied = 200, 0
    obs, info = env.reset(seed=3)
    for _ in range(episodes):
        for _ in range(worth.within or 0):
            obs, _, terminated, truncated, info = env.step(policy(info["tltl"]["state"], int(obs)))
            if terminated or truncated:
                break
        satisfied += bool(info["tltl"]["satisfied"])
        obs, info = env.reset()
    p = worth.satisfied_within
    assert p is not None
    # Four standard deviations, and one episode.
    assert abs(satisfied - episodes * p) <= 4 * (episodes * p * (1 - p)) ** 0.5 + 1


def held(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, bool]:
    """What holds in a room of MiniGrid with a key and a door."""
    room = env.unwrapped
    doors = [thing for thing in room.grid.grid if thing is not None and thing.type == "door"]
    here = room.grid.get(*room.agent_pos)
    return {
        "key": room.carrying is not None and room.carrying.type == "key",
        "door": any(door.is_open for door in doors),
        "goal": here is not None and here.type == "goal",
    }


def planned(room: Any, is_done: Any) -> list[int]:
    """The fewest actions until `is_done(room)`, by a breadth-first search over copies."""

    def key(room: Any) -> Any:
        door = next(thing for thing in room.grid.grid if thing is not None and thing.type == "door")
        return (*map(int, room.agent_pos), room.agent_dir, room.carrying is None, door.is_open)

    left: deque[tuple[Any, list[int]]] = deque([(room, [])])
    seen = {key(room)}
    while left:
        at, plan = left.popleft()
        for action in (0, 1, 2, 3, 5):
            then = copy.deepcopy(at)
            then.step(action)
            if is_done(then):
                return [*plan, action]
            if key(then) not in seen:
                seen.add(key(then))
                left.append((then, [*plan, action]))
    raise AssertionError("there is a plan")


@pytest.mark.parametrize(
    ("name", "formula"),
    [("MiniGrid-DoorKey-5x5-v0", "key T door T goal"), ("MiniGrid-Unlock-v0", "key T door")],
)
def test_a_key_and_a_door(name: str, formula: str) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        check_env(TaskEnv(gym.make(name), formula, held, observe="dict"), skip_render_check=True)
    task = Task(formula)
    last = task.propositions[-1]
    env = TaskEnv(gym.make(name), task, held, observe="dict", rewards="acceptance")
    for seed in range(2):
        obs, info = env.reset(seed=seed)
        world = copy.deepcopy(env.unwrapped)
        plan = planned(world, lambda room: held(room, None, {})[last])
        rows, states, paid = [info["tltl"]["labels"]], [info["tltl"]["state"]], 0.0
        for i, action in enumerate(plan, 1):
            obs, reward, terminated, _, info = env.step(action)
            rows.append(info["tltl"]["labels"])
            states.append(info["tltl"]["state"])
            paid += float(reward)
            assert terminated == (i == len(plan)) and obs["task_state"] == states[-1]
        assert info["tltl"]["satisfied"] and paid == 1.0
        assert states == task.run(np.where(rows, 1.0, -1.0)).states.tolist()
        assert {task.initial, 1, task.accepting} <= set(states)
