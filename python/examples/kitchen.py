"""FrankaKitchen: `kettle T microwave` over the state of MuJoCo's simulator, by a script.

It needs `tltl[robotics]`. Nothing is learned here: objects are put where the script wants them, and the
task reads the simulator as it would read a robot's work.
"""

from __future__ import annotations

from typing import Any

import gymnasium as gym
import gymnasium_robotics
import numpy as np

from tltl import Task
from tltl.gymnasium import TaskEnv

gym.register_envs(gymnasium_robotics)
GOALS = ("kettle", "microwave")
#: How near an object must be to its goal, as the environment has it.
NEAR = 0.3


def nearness(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, float]:
    """By how much each object is nearer to its goal than what counts as done."""
    achieved, wanted = obs["achieved_goal"], obs["desired_goal"]
    return {goal: NEAR - float(np.linalg.norm(achieved[goal] - wanted[goal])) for goal in GOALS}


def scripted(order: tuple[str, ...] = GOALS, steps: int = 30) -> tuple[list[int], list[list[bool]]]:
    """The automaton's states and what held, while objects are moved in this order."""
    world = gym.make("FrankaKitchen-v1", tasks_to_complete=list(GOALS), remove_task_when_completed=False)
    task = Task("kettle T microwave")
    env = TaskEnv(world, task, nearness, observe="none", rewards="robustness", terminate=False)
    kitchen: Any = world.unwrapped
    obs, info = env.reset(seed=1)
    states, met = [info["tltl"]["state"]], [info["tltl"]["labels"].tolist()]
    joints = {"kettle": slice(23, 30), "microwave": slice(22, 23)}
    for step in range(steps):
        data = kitchen.data
        for i, goal in enumerate(order):
            if step >= steps // 3 * (i + 1):
                data.qpos[joints[goal]] = obs["desired_goal"][goal]
                data.qvel[:] = 0.0
        obs, _, _, _, info = env.step(np.zeros(9))
        states.append(info["tltl"]["state"])
        met.append(info["tltl"]["labels"].tolist())
    return states, met


def main() -> None:
    for order in (GOALS, GOALS[::-1]):
        states, _ = scripted(order)
        print(f"{' then '.join(order)}: states {states}")


if __name__ == "__main__":
    main()
