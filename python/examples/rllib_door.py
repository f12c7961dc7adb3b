"""RLlib on Ray: PPO on MiniGrid with two runners, unchanged on a cluster but for the address.

It needs `tltl[rllib]` and MiniGrid. Every node has the same packages; nothing is installed by Ray.
"""

from __future__ import annotations

import sys
from typing import Any

import gymnasium as gym
import ray
from ray.rllib.algorithms.ppo import PPOConfig

from doorkey_study import Features, labels
from tltl.rllib import TaskMetrics, register_task_env


def make(name: str = "MiniGrid-DoorKey-5x5-v0") -> Any:
    return Features(gym.make(name))


def trained(iterations: int, runners: int = 2) -> dict[str, Any]:
    """The last results of the runners."""
    register_task_env("door", make, labels)
    config = (
        PPOConfig()
        .environment("door", env_config={"task": "key T door T goal"})
        .env_runners(num_env_runners=runners)
        .learners(num_learners=0)
        .training(train_batch_size_per_learner=1_000)
        .callbacks(TaskMetrics)
    )
    algorithm = config.build_algo()
    told: dict[str, Any] = {}
    for _ in range(iterations):
        told = algorithm.train()["env_runners"]
    algorithm.stop()
    return told


def main() -> None:
    # On a cluster, this alone differs: ray.init(address="auto").
    ray.init(num_cpus=3, include_dashboard=False)
    told = trained(int(sys.argv[1]) if len(sys.argv) > 1 else 2)
    print({name: value for name, value in told.items() if name.startswith("tltl")})


if __name__ == "__main__":
    main()
