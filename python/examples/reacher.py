"""Reacher by columns: the finger tip goes left of the target, and later right of it.

It needs `tltl[robotics]`. The arm swings by alternating torques; learning it is for a cluster.
"""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np

from tltl import Run, TaskFile
from tltl.gymnasium import TaskEnv

TASK = """
    /// Where the finger tip is, seen from the target, in metres.
    state Reacher { dx: f64, dy: f64 }
    step 0.02 s
    task swing = (dx < -0.01) T (dx > 0.01)
"""
COLUMNS = {"dx": 8, "dy": 9}


def swung(seed: int) -> tuple[dict[str, Any], Run]:
    """An episode of 50 steps, and what the task makes of its states."""
    task = TaskFile.from_text(TASK).task()
    env = TaskEnv(gym.make("Reacher-v5"), task, columns=COLUMNS, terminate=False)
    obs, info = env.reset(seed=seed)
    states, done = [obs[:10]], False
    while not done:
        side = 1.0 if len(states) // 12 % 2 else -1.0
        obs, _, terminated, truncated, info = env.step(np.array([side, side], np.float32))
        states.append(obs[:10])
        done = terminated or truncated
    return info["tltl"], task.run(np.array(states), columns=COLUMNS)


def main() -> None:
    for seed in range(5):
        told, run = swung(seed)
        print(f"seed {seed}: {run.verdict}, ρ = {run.robustness:.3f} m, state {told['state']}")


if __name__ == "__main__":
    main()
