"""Tasks over the states of MuJoCo's simulators; `pip install 'tltl[robotics]'`."""

from __future__ import annotations

import warnings
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from tltl import Task, TaskFile, TaskWarning
from tltl.gymnasium import TaskEnv

pytest.importorskip("mujoco")
pytestmark = pytest.mark.mujoco


def recorded(env: TaskEnv, steps: int, seed: int) -> tuple[list[Any], list[int]]:
    """What held, and the automaton's states, over random actions."""
    env.action_space.seed(seed)
    _, info = env.reset(seed=seed)
    rows, states = [info["tltl"]["labels"]], [info["tltl"]["state"]]
    for _ in range(steps):
        _, _, terminated, truncated, info = env.step(env.action_space.sample())
        rows.append(info["tltl"]["labels"])
        states.append(info["tltl"]["state"])
        if terminated or truncated:
            break
    return rows, states


def test_reacher_by_columns() -> None:
    """Columns 8 and 9 are the finger tip, seen from the target, in metres."""
    text = """
        state Reacher { dx: f64, dy: f64 }
        step 0.02 s
        predicate left = dx < 0
        task swing = left T !left
    """
    task = TaskFile.from_text(text).task()
    with warnings.catch_warnings():
        warnings.simplefilter("error", TaskWarning)
        env = TaskEnv(gym.make("Reacher-v5"), task, columns={"dx": 8, "dy": 9})
    met = set()
    for seed in range(6):
        rows, states = recorded(env, 50, seed)
        q, expected = task.initial, []
        for row in rows:
            q = task.step(q, row)
            expected.append(q)
        assert states == expected
        met |= set(states)
    assert len(met) > 1, "something happens"
    slow = TaskFile.from_text(text.replace("0.02", "0.05")).task()
    with pytest.warns(TaskWarning, match="lasts 0.02 s, and the task says 0.05 s"):
        TaskEnv(gym.make("Reacher-v5"), slow, columns={"dx": 8, "dy": 9})


def test_the_kitchen_of_franka() -> None:
    robotics = pytest.importorskip("gymnasium_robotics")
    gym.register_envs(robotics)
    goals = ["microwave", "kettle"]
    world = gym.make("FrankaKitchen-v1", tasks_to_complete=goals)

    def done(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, float]:
        """By how much each object is nearer to its goal than the 0.3 that counts as done."""
        achieved, wanted = obs["achieved_goal"], obs["desired_goal"]
        return {goal: 0.3 - float(np.linalg.norm(achieved[goal] - wanted[goal])) for goal in goals}

    task = Task("kettle T microwave")
    env = TaskEnv(world, task, done, observe="dict", rewards="robustness")
    rows, states = recorded(env, 30, seed=1)
    assert len(states) == 31 and states == task.run(np.where(rows, 1.0, -1.0)).states.tolist()
    assert env.observation_space.contains(env.reset(seed=2)[0])


def test_a_ball_in_a_maze() -> None:
    """Columns of a flattened Dict: its parts stand in the order of their names, and `observation` is last."""
    robotics = pytest.importorskip("gymnasium_robotics")
    gym.register_envs(robotics)
    formula = "(x > 1.2) T (x < -1.2) ensuring y < 0"
    columns = {"x": 4, "y": 5}
    env = TaskEnv(gym.make("PointMaze_UMaze-v3"), formula, columns=columns, observe="dict")
    # It is pushed to one end of the lower passage, and back to the other; or it stays at the wrong end.
    for first, verdict in ((1.0, "satisfied"), (-1.0, "open")):
        obs, info = env.reset(seed=1)
        rows, states, done = [obs["observation"][:2]], [info["tltl"]["state"]], False
        while not done:
            push = first if len(states) < 100 or verdict == "open" else -first
            obs, _, terminated, truncated, info = env.step(np.array([push, 0.0], np.float32))
            rows.append(obs["observation"][:2])
            states.append(info["tltl"]["state"])
            done = terminated or truncated
        run = env.task.run(np.array(rows))
        assert (run.verdict, run.states.tolist()) == (verdict, states)
        assert info["tltl"]["satisfied"] == (verdict == "satisfied")
