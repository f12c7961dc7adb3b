"""FrozenLake, Taxi and CliffWalking: learned, and judged exactly.

`python toy_text.py` prints the certificate of what the tabular learner learned in each world, and, with
`tltl[sb3]`, that of a network of PPO on the small lake.
"""

from __future__ import annotations

from typing import Any

import gymnasium as gym

from tltl import Certificate, FiniteModel, Learner, Settings, Solution, solve
from tltl.gymnasium import TaskEnv

HOLES = {5, 7, 11, 12}


def lake(s: int) -> dict[str, bool]:
    return {"corner": s == 3, "goal": s == 15, "hole": s in HOLES}


def large_lake(s: int) -> dict[str, bool]:
    return {"corner": s == 7, "goal": s == 63}


def taxi(s: int) -> dict[str, bool]:
    """A state is ((row, column), passenger, destination); passenger 4 is in the taxi."""
    return {"aboard": s // 4 % 5 == 4, "home": s // 4 % 5 == s % 4}


def cliff(s: int, event: str | None) -> dict[str, bool]:
    """Nobody *is* in the cliff: who steps there is at the start again. So it is an event."""
    return {"cliff": event == "cliff", "goal": s == 47}


def fell(s: int, a: int, to: int, reward: float) -> str | None:
    """What happened on the way."""
    return "cliff" if reward <= -100 else None


def newest(name: str) -> str:
    """The newest version of an environment that is registered: `Taxi-v4`; in Gymnasium 1.0 `Taxi-v3`."""
    versions = [int(spec.version or 0) for spec in gym.registry.values() if spec.name == name]
    return f"{name}-v{max(versions)}"


#: Environment, its options, task, labels, events. The slippery cliff is there from Gymnasium 1.1 on.
WORLDS: dict[str, tuple[str, dict[str, Any], str, Any, Any]] = {
    "FrozenLake": ("FrozenLake-v1", {}, "corner T goal", lake, None),
    "FrozenLake 8x8": ("FrozenLake8x8-v1", {}, "corner T goal", large_lake, None),
    "Taxi": (newest("Taxi"), {}, "aboard T home", taxi, None),
    "CliffWalking": (newest("CliffWalking"), {"is_slippery": True}, "!cliff U goal", cliff, fell),
}


def solved(name: str) -> tuple[FiniteModel, Solution]:
    """The world, and what is optimal in it."""
    world, options, formula, labels, events = WORLDS[name]
    model = FiniteModel.from_env(gym.make(world, **options), events=events)
    return model, solve(model, formula, labels)


def certified(name: str, steps: int, seed: int = 1) -> Certificate:
    """What the tabular learner's policy is worth after so many steps."""
    model, best = solved(name)
    _, _, formula, labels, _ = WORLDS[name]
    settings = Settings(exploration="coverage")
    return Learner(model, formula, labels, settings=settings, seed=seed).train(steps).certify(best)


def certified_network(steps: int, seed: int = 0) -> Certificate:
    """What a network that PPO learned on the small lake, where nothing slips, is worth: exactly, too."""
    from stable_baselines3 import PPO

    from tltl.sb3 import tabulate

    world, _, formula, labels, _ = WORLDS["FrozenLake"]
    holds: Any = lambda env, obs, info: labels(int(obs))  # noqa: E731
    env = TaskEnv(gym.make(world, is_slippery=False), formula, holds, rewards="progress")
    settings: Any = {"n_steps": 256, "batch_size": 256, "learning_rate": 3e-3, "ent_coef": 0.1}
    network = PPO("MlpPolicy", env, seed=seed, **settings).learn(steps)
    model = FiniteModel.from_env(env.env)
    return solve(model, formula, labels).certify(tabulate(network, model, env))


def main() -> None:
    for name in WORLDS:
        print(f"{name}: the tabular learner, 600,000 steps\n{certified(name, 600_000)}\n")
    try:
        import stable_baselines3  # noqa: F401
    except ImportError:
        return
    print(f"FrozenLake, not slippery: a network of PPO, 30,000 steps\n{certified_network(30_000)}\n")


if __name__ == "__main__":
    main()
