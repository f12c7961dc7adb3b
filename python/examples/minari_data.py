"""A Minari data set that is made here, relabelled, and solved without a further step.

It needs `tltl[minari]`. Random episodes on the frozen lake, recorded for no task in particular, teach any.
"""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import numpy as np
from minari import DataCollector

from tltl import Certificate, FiniteModel, Rewards, Task, solve
from tltl.minari import Steps, steps
from tltl.replay import Relabelled, relabel

FORMULA = "corner T goal"


def labels(obs: Any) -> dict[str, bool]:
    return {"corner": bool(obs == 3), "goal": bool(obs == 15)}


def recorded(episodes: int, seed: int = 0) -> Any:
    """Random episodes on the lake."""
    env = DataCollector(gym.make("FrozenLake-v1", is_slippery=False))
    env.action_space.seed(seed)
    for episode in range(episodes):
        _, done = env.reset(seed=seed + episode), False
        while not done:
            _, _, terminated, truncated, _ = env.step(env.action_space.sample())
            done = terminated or truncated
    return env.create_dataset(dataset_id=f"lake/random-{seed}-v0", algorithm_name="random")


def learned(dataset: Any) -> tuple[Steps, Relabelled, Certificate]:
    """The steps for every automaton state, and what is best by what was seen, judged in the world."""
    task = Task(FORMULA)
    seen = steps(dataset, task, labels)
    every = relabel(
        task,
        seen.labels,
        rewards=Rewards("shaped"),
        reward=seen.rewards,
        terminated=seen.terminated,
    )
    place, after = (one.argmax(1) for one in (seen.observations, seen.next_observations))
    world = FiniteModel.from_experience(
        place,
        seen.actions,
        after,
        num_states=16,
        num_actions=4,
        terminated=seen.terminated,
        starts=np.zeros(1, int),
    )
    policy = solve(world, task, labels).policy
    model = FiniteModel.from_env(gym.make("FrozenLake-v1", is_slippery=False))
    return seen, every, solve(model, task, labels).certify(policy.table)


def main() -> None:
    seen, every, worth = learned(recorded(2_000))
    print(f"{len(seen.q)} steps are {len(every.q)} for all states of the automaton\n{worth}")


if __name__ == "__main__":
    main()
