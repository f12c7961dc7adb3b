"""What was learned with Stable-Baselines3: judged exactly where there is a model, and emitted as Rust.

`tabulate` asks a network in every pair of a finite model, so that `Solution.certify` says what it is
worth. `export` makes a document of its weights, which `tltlc policy` turns into Rust that needs no
standard library.
"""

# pyright: reportMissingImports=false

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tltl._core import FiniteModel, NetworkPolicy, Task
from tltl.gymnasium import TaskEnv

try:
    import torch
    from stable_baselines3.common.base_class import BaseAlgorithm
    from stable_baselines3.common.callbacks import BaseCallback
except ImportError:
    raise ImportError("tltl.sb3 needs Stable-Baselines3: pip install 'tltl[sb3]'")

__all__ = ["TaskCallback", "export", "tabulate"]


def tabulate(
    algorithm: BaseAlgorithm,
    model: FiniteModel,
    env: TaskEnv,
    *,
    observation: Callable[[int], Any] | None = None,
) -> NDArray[np.int64]:
    """The deterministic action in every pair: int64, of shape (automaton states, states).

    `env` is the `TaskEnv` that the algorithm was trained in, which makes an observation of the world's
    and an automaton state; the world's observation in a state is its number in the tables of the model,
    or what `observation` gives for it.
    """
    table = np.zeros((env.task.num_states, model.num_states), np.int64)
    for q in range(env.task.num_states):
        for s, origin in enumerate(model.origin.tolist()):
            seen = origin if observation is None else observation(origin)
            action, _ = algorithm.predict(env.observed(seen, q), deterministic=True)
            table[q, s] = int(action)
    return table


def export(
    algorithm: BaseAlgorithm,
    task: Task,
    *,
    actions: Sequence[str] | None = None,
    inputs: Sequence[str] | None = None,
) -> NetworkPolicy:
    """The network of a DQN, or the actor of a PPO or A2C, as a `NetworkPolicy`.

    It takes the observation as the algorithm does: flat, with the automaton's state one-hot at its end.
    So its heads are the same for every automaton state. The numbers are those of `predict` with
    `deterministic=True`.

    Raises `ValueError` for what the document cannot say, by its name: layers other than `Linear` with
    `ReLU` between them (PPO: `policy_kwargs={"activation_fn": torch.nn.ReLU}`), observations that are
    not flat, actions that are not `Discrete`.
    """
    policy, own = algorithm.policy, algorithm.observation_space
    actor = acting(policy)
    layers: list[dict[str, Any]] = []
    hidden: list[int] = []
    expects_activation = False
    for layer in actor:
        if isinstance(layer, torch.nn.Flatten):
            continue
        if isinstance(layer, torch.nn.Linear) and not expects_activation:
            weights = layer.weight.detach().cpu().numpy().astype(np.float32)
            bias = layer.bias.detach().cpu().numpy().astype(np.float32)
            layers.append({"weights": weights.T, "bias": bias})
            hidden.append(len(bias))
        elif not isinstance(layer, torch.nn.ReLU):
            raise ValueError(f"a layer {layer}: a document has Linear layers with ReLU between them")
        expects_activation = isinstance(layer, torch.nn.Linear)
    *hidden, count = hidden
    live = task.num_states - (task.accepting is not None) - (task.trap is not None)
    last = layers[-1]
    # Every automaton state has the same head: what differs is its input.
    last["weights"], last["bias"] = np.tile(last["weights"], (1, live)), np.tile(last["bias"], live)
    width = layers[0]["weights"].shape[0]
    hot = np.stack([getattr(own, end)[-task.num_states :] for end in ("low", "high")])
    if own.shape != (width,) or hot.T.tolist() != [[0, 1]] * task.num_states:
        raise ValueError(
            f"observations of {own}: wanted are flat ones with the {task.num_states} states of "
            f"`{task.text}` at their end"
        )
    document = {
        "format": "tltl-network-policy",
        "version": 1,
        "task": task.name or task.text,
        "formula": task.text,
        "actions": list(actions or map(str, range(count))),
        "automaton": {
            "states": task.num_states,
            "initial": task.initial,
            "accepting": task.accepting,
            "trap": task.trap,
        },
        "inputs": list(inputs or ()),
        "training": [],
        "network": {
            "shape": {
                "inputs": width,
                "hidden": hidden,
                "heads": live,
                "actions": count,
                "entities": 0,
                "channels": 0,
            },
            "layers": [
                {name: numbers.ravel().tolist() for name, numbers in layer.items()}
                for layer in layers
            ],
        },
    }
    return NetworkPolicy.from_json(json.dumps(document))


def acting(policy: Any) -> list[Any]:
    """The layers between an observation and what the deterministic action is the largest of."""
    if hasattr(policy, "q_net"):
        net = policy.q_net
        extractor, rest = net.features_extractor, list(net.q_net)
    elif hasattr(policy, "action_net"):
        extractor = policy.features_extractor
        rest = [*policy.mlp_extractor.policy_net, policy.action_net]
    else:
        raise ValueError(f"{type(policy).__name__} has neither action values nor an actor")
    if [type(part).__name__ for part in extractor.children()] != ["Flatten"]:
        raise ValueError(f"{type(extractor).__name__}: wanted are flat observations")
    if type(policy.action_space).__name__ != "Discrete" or policy.action_space.start != 0:
        raise ValueError(f"actions of {policy.action_space}: wanted is Discrete from 0 on")
    return [*extractor.children(), *rest]


class TaskCallback(BaseCallback):
    """Records at the end of each episode whether the task was `satisfied` or `lost`.

    In the logger as `tltl/satisfied` and `tltl/lost`, fractions of the last hundred episodes.
    """

    def __init__(self) -> None:
        super().__init__()
        self.satisfied: list[bool] = []
        self.lost: list[bool] = []

    def _on_step(self) -> bool:
        for info, done in zip(self.locals["infos"], self.locals["dones"], strict=True):
            if done and "tltl" in info:
                self.satisfied.append(bool(info["tltl"]["satisfied"]))
                self.lost.append(bool(info["tltl"]["lost"]))
                self.logger.record("tltl/satisfied", float(np.mean(self.satisfied[-100:])))
                self.logger.record("tltl/lost", float(np.mean(self.lost[-100:])))
        return True
