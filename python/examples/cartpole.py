"""CartPole with a numeric task: predicates are comparisons, so there is no label function.

The cart goes right, and later left, while the pole stays up. A controller by hand does it, and the
robustness says by how much.
"""

from __future__ import annotations

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from tltl import Run, Task
from tltl.gymnasium import TaskEnv

TASK = "(x > 0.3) T (x < -0.3) ensuring -0.2 < angle < 0.2"
COLUMNS = {"x": 0, "angle": 2}
#: A linear feedback that keeps the pole up, of position, speed, angle and its rate.
GAINS = np.array([1.0, 2.0, 25.0, 4.0])


def controlled(obs: NDArray[np.floating], q: int) -> int:
    """Pushes towards the side that the automaton state wants."""
    wanted = 0.6 if q == 0 else -0.6
    return int(GAINS @ (obs[:4] - np.array([wanted, 0, 0, 0])) > 0)


def driven(seed: int) -> tuple[bool, NDArray[np.float32], Run]:
    """An episode: whether the task was satisfied in it, its states, and what the task makes of them."""
    env = TaskEnv(gym.make("CartPole-v1"), TASK, columns=COLUMNS)
    (obs, info), done = env.reset(seed=seed), False
    states = [obs[:4]]
    while not done:
        obs, _, terminated, truncated, info = env.step(controlled(obs, info["tltl"]["state"]))
        states.append(obs[:4])
        done = terminated or truncated
    walk = np.array(states)
    return info["tltl"]["satisfied"], walk, Task(TASK).run(walk, columns=COLUMNS)


def main() -> None:
    for seed in range(5):
        satisfied, walk, run = driven(seed)
        print(f"seed {seed}: satisfied {satisfied} after {len(walk) - 1} steps, ρ = {run.robustness:.3f}")


if __name__ == "__main__":
    main()
