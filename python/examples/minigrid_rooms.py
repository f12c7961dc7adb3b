"""MiniGrid: two skills are learned in two rooms, and become new ones without a step.

The world is `MiniGrid-DoorKey-6x6-v0` in one layout, whose states are numbered, so the tabular learner of
the package learns in it.
"""

from __future__ import annotations

import math
from typing import Any

import gymnasium as gym
import minigrid  # noqa: F401, registers its environments
import numpy as np
from gymnasium import spaces

from tltl import Composition, Learner, compose

NAME, LAYOUT = "MiniGrid-DoorKey-6x6-v0", 3
#: Left, right, forward, pick up, toggle.
ACTIONS = (0, 1, 2, 3, 5)
#: Column, row, direction, whether the key is carried, and the door: locked, closed or open.
SIZES = (6, 6, 4, 2, 3)


class Room(gym.Env[Any, Any]):
    """A layout of DoorKey whose states are numbers."""

    def __init__(self, layout: int = LAYOUT) -> None:
        self.world = gym.make(NAME, max_episode_steps=300)
        self.layout = layout
        self.observation_space = spaces.Discrete(math.prod(SIZES))
        self.action_space = spaces.Discrete(len(ACTIONS))
        self.visited: set[int] = set()
        self.reset()
        room: Any = self.world.unwrapped
        things = {thing.type: at for at, thing in enumerate(room.grid.grid) if thing is not None}
        self.door, self.goal = (divmod(things[name], room.grid.width) for name in ("door", "goal"))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[int, dict[str, Any]]:
        super().reset(seed=seed)
        self.world.reset(seed=self.layout)
        return self.seen(), {}

    def step(self, action: int) -> tuple[int, float, bool, bool, dict[str, Any]]:
        _, _, terminated, truncated, _ = self.world.step(ACTIONS[action])
        return self.seen(), 0.0, terminated, truncated, {}

    def seen(self) -> int:
        """The number of the state that the world is in."""
        room: Any = self.world.unwrapped
        door = next(one for one in room.grid.grid if one is not None and one.type == "door")
        way = 0 if door.is_locked else 1 + door.is_open
        state = (*room.agent_pos, room.agent_dir, room.carrying is not None, way)
        number = int(np.ravel_multi_index(tuple(map(int, state)), SIZES))
        self.visited.add(number)
        return number

    def holds(self, number: int) -> dict[str, bool]:
        """What holds in a state."""
        x, y, _, has_key, way = map(int, np.unravel_index(number, SIZES))
        return {
            "key": has_key == 1,
            "door": way == 2,
            "beyond": x > self.door[1],
            "goal": (y, x) == self.goal,
        }


def learned(env: Room, formula: str, steps: int) -> Learner:
    """A skill."""
    return Learner(env, formula, env.holds, seed=1).train(steps)


def composed(env: Room, steps: int) -> Composition:
    """`door` in the first room, then `goal` in the second: learned apart, joined on what both have seen."""
    skills = [learned(env, formula, steps) for formula in ("key T door", "F goal")]
    return compose("then", skills)


def walked(env: Room, composition: Composition) -> list[dict[str, bool]]:
    """What holds along an episode of the composed policy, in the world itself."""
    policy = composition.policy
    s, _ = env.reset()
    q, met = policy.reset(s), [env.holds(s)]
    while not policy.is_over(q) and len(met) < 300:
        s, _, terminated, truncated, _ = env.step(policy(q, s))
        q = policy.next(q, s)
        met.append(env.holds(s))
        if terminated or truncated:
            break
    return met


def main() -> None:
    env = Room()
    both = composed(env, 20_000)
    print(both)
    met = walked(env, both)
    print(f"{len(met) - 1} steps; at the end {met[-1]}")


if __name__ == "__main__":
    main()
