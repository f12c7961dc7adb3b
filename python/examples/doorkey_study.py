"""DoorKey with the automaton and without: PPO, five seeds, the same steps.

`python doorkey_study.py` prints the table of the documentation. It needs `tltl[sb3]` and MiniGrid.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import gymnasium as gym
import minigrid  # noqa: F401, registers its environments
import numpy as np
from gymnasium import spaces
from gymnasium.utils import RecordConstructorArgs
from numpy.typing import NDArray

from tltl.gymnasium import TaskEnv

#: The task of each row: the environment's own, and one that asks for more.
TASKS = {
    "DoorKey-5x5": ("MiniGrid-DoorKey-5x5-v0", "key T door T goal"),
    "DoorKey-6x6": ("MiniGrid-DoorKey-6x6-v0", "key T door T goal"),
    "DoorKey-5x5, and back once": ("MiniGrid-DoorKey-5x5-v0", "key T door T beyond T back T goal"),
}
#: The options of `TaskEnv`: with the automaton and a reward for its moves, or for the task alone.
ARMS: dict[str, dict[str, Any]] = {
    "automaton, progress": {"rewards": "progress"},
    "plain reward": {"rewards": "acceptance", "observe": "none"},
    "automaton, shaped": {"rewards": "shaped"},
}
STEPS, SEEDS, EPISODES = 30_000, 5, 50
#: The quantile of Student's t for five seeds and a level of 95 %.
STUDENT = 2.776


class Features(gym.ObservationWrapper[NDArray[np.float32], Any, Any], RecordConstructorArgs):
    """What a MiniGrid shows as numbers: the agent, and where key, door and goal are."""

    def __init__(self, env: gym.Env[Any, Any]) -> None:
        # So that `check_env` can make it again.
        RecordConstructorArgs.__init__(self)
        super().__init__(env)
        self.observation_space = spaces.Box(0, 1, (15,), np.float32)

    def observation(self, observation: Any) -> NDArray[np.float32]:
        world: Any = self.env.unwrapped
        size = world.grid.width - 1
        found = {thing.type: at for at, thing in enumerate(world.grid.grid) if thing is not None}
        places = []
        for name in ("key", "door", "goal"):
            at = found.get(name)
            y, x = (0, 0) if at is None else divmod(at, world.grid.width)
            places += [x / size, y / size]
        door = world.grid.grid[found["door"]]
        seen = np.zeros(15, np.float32)
        seen[:2] = world.agent_pos[0] / size, world.agent_pos[1] / size
        seen[2 + world.agent_dir] = 1
        seen[6:12] = places
        seen[12:] = world.carrying is not None, door.is_open, door.is_locked
        return seen


def labels(env: Any, obs: NDArray[np.float32], info: dict[str, Any]) -> dict[str, bool]:
    """What holds, read from the features."""
    x, door_x = float(obs[0]), float(obs[8])
    return {
        "key": bool(obs[12]),
        "door": bool(obs[13]),
        "beyond": x > door_x,
        "back": x < door_x,
        "goal": bool((obs[:2] == obs[10:12]).all()),
    }


def made(row: str, **options: Any) -> TaskEnv:
    """The environment of a row, with these options."""
    name, formula = TASKS[row]
    return TaskEnv(Features(gym.make(name)), formula, labels, **options)


def learned(row: str, arm: str, seed: int, steps: int) -> Any:
    """A policy of PPO."""
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env

    envs = make_vec_env(lambda: made(row, **ARMS[arm]), 8, seed=1_000 * seed)
    settings: Any = {"n_steps": 128, "batch_size": 256, "learning_rate": 1e-3, "ent_coef": 0.01}
    return PPO("MlpPolicy", envs, seed=seed, **settings).learn(steps)


def success(act: Callable[[Any], Any], env: TaskEnv, episodes: int, seed: int) -> float:
    """In how many episodes the task is satisfied."""
    satisfied = 0
    for episode in range(episodes):
        (obs, info), done = env.reset(seed=seed + episode), False
        while not done:
            obs, _, terminated, truncated, info = env.step(int(act(obs)))
            done = terminated or truncated
        satisfied += bool(info["tltl"]["satisfied"])
    return satisfied / episodes


def interval(values: list[float]) -> str:
    """The mean of the seeds and its interval of confidence, within [0, 1]."""
    mean = float(np.mean(values))
    half = STUDENT * float(np.std(values, ddof=1)) / len(values) ** 0.5
    return f"{mean:.2f} ({max(0.0, mean - half):.2f} to {min(1.0, mean + half):.2f})"


def main() -> None:
    """Prints the table; every number goes to the error stream as it comes."""
    found: dict[tuple[str, str], str] = {}
    for arm, options in ARMS.items():
        for row in TASKS:
            values = []
            for seed in range(SEEDS):
                model = learned(row, arm, seed, STEPS)
                act: Any = lambda obs, model=model: model.predict(obs)[0]  # noqa: E731
                values.append(success(act, made(row, **options), EPISODES, 10_000))
                print(row, arm, seed, values[-1], file=sys.stderr, flush=True)
            found[row, arm] = interval(values)
    print(f"| {STEPS:,} steps, {SEEDS} seeds | {' | '.join(ARMS)} |\n| --- {'| --- ' * len(ARMS)}|")
    for row in TASKS:
        print(f"| {row} | {' | '.join(found[row, arm] for arm in ARMS)} |")


if __name__ == "__main__":
    main()
