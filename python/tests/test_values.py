"""Tasks as values: other pickles, other processes, and nothing that is left behind."""

from __future__ import annotations

import multiprocessing
import os
import sys
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from tltl import Rewards, Task, TaskFile, product
from tltl._core import main
from tltl.gymnasium import TaskEnv

VALUES: dict[str, Any] = {
    "task": lambda: Task("!wet U (home && x > 2)"),
    "bound": lambda: TaskFile.from_text("state S { x: f64 } task far(d: f64) = F x > d").task(d=2.5),
    "automaton": lambda: Task.from_hoa(Task("a T b").to_hoa()),
    "product": lambda: product("or", "F a", "a T b").task,
    "rewards": lambda: Rewards("shaped", gamma=0.9, environment=0.5),
}


def fingerprint(value: Any) -> str:
    return str(getattr(value, "fingerprint", value))


@pytest.mark.parametrize("name", VALUES)
def test_values_travel_to_processes_that_know_nothing(name: str) -> None:
    value = VALUES[name]()
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(fingerprint, (value,)) == fingerprint(value)
    cloudpickle = pytest.importorskip("cloudpickle")
    again = cloudpickle.loads(cloudpickle.dumps(value))
    assert again == value and hash(again) == hash(value)
    # A function that has one in it.
    told: Any = cloudpickle.loads(cloudpickle.dumps(lambda: fingerprint(value)))
    assert told() == fingerprint(value)


@pytest.mark.skipif(sys.platform == "win32", reason="the size of a process is asked in another way")
def test_compilations_leave_nothing_behind() -> None:
    import resource

    def compiled(count: int) -> int:
        for i in range(count):
            task = Task(f"(a{i} T b) && (!c U d) && F[0,{i % 7}] e")
            task.step(0, {f"a{i}", "b"})
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    # The allocator has what it needs after the first hundreds; what leaks grows with the rest: 8 kB a
    # task would be 4 MB at least.
    count = int(os.environ.get("TLTL_COMPILATIONS", "1000"))
    first = compiled(500)
    assert compiled(count - 500) - first < 3_000, "kilobytes"


def test_the_tool_runs_a_recording_through_the_same_states(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    formula = "(x > 0.05) T (x < -0.05) ensuring -0.15 < angle < 0.15"
    env = TaskEnv(gym.make("CartPole-v1"), formula, columns={"x": 0, "angle": 2}, terminate=False)
    env.action_space.seed(5)
    (obs, info), done = env.reset(seed=5), False
    rows, states = [obs[[0, 2]]], [info["tltl"]["state"]]
    while not done:
        obs, _, terminated, truncated, info = env.step(env.action_space.sample())
        rows.append(obs[[0, 2]])
        states.append(info["tltl"]["state"])
        done = terminated or truncated
    path = tmp_path / "walk.csv"
    lines = ["x,angle", *(f"{float(x)!r},{float(angle)!r}" for x, angle in rows)]
    path.write_text("\n".join(lines) + "\n")
    assert main(["tltlc", "run", formula, str(path), "--format", "csv"]) in (0, 1)
    out = capfd.readouterr().out.splitlines()
    column = out[0].split(",").index("state")
    assert [int(line.split(",")[column]) for line in out[1 : len(states) + 1]] == states
    assert env.task.run(np.array(rows)).states.tolist() == states
