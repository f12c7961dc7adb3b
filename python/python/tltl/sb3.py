"""What was learned with Stable-Baselines3: judged exactly where there is a model, and emitted as Rust.

`tabulate` asks a network in every pair of a finite model, so that `Solution.certify` says what it is
worth. `export` makes a document of its weights, which `tltlc policy` turns into Rust that needs no
standard library. The replay buffers store each step once for every automaton state.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from typing import Any, Literal
from warnings import warn

import numpy as np
from numpy.typing import NDArray

from tltl._core import FiniteModel, NetworkPolicy, Rewards, Task
from tltl._errors import TaskWarning
from tltl.gymnasium import TaskEnv
from tltl.replay import relabel

from gymnasium import spaces  # isort: skip

try:
    import torch
    from stable_baselines3.common.base_class import BaseAlgorithm
    from stable_baselines3.common.buffers import DictReplayBuffer, ReplayBuffer
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.preprocessing import get_flattened_obs_dim
    from stable_baselines3.common.torch_layers import CombinedExtractor, FlattenExtractor
except ImportError:
    raise ImportError("tltl.sb3 needs Stable-Baselines3: pip install 'tltl[sb3]'")

__all__ = [
    "CounterfactualDictReplayBuffer",
    "CounterfactualReplayBuffer",
    "TaskCallback",
    "export",
    "tabulate",
]


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
    key: str = "task_state",
    actions: Sequence[str] | None = None,
    inputs: Sequence[str] | None = None,
) -> NetworkPolicy:
    """The network of a DQN, or the actor of a PPO, A2C, SAC, TD3 or DDPG, as a `NetworkPolicy`.

    It takes what the environment shows without the automaton's state, which is an argument of its own:
    `spaces.flatten` of the observation beneath `TaskEnv`, float32. With `observe="dict"` the parts stand
    in the order of their names, without `key`. Normalisation by a `VecNormalize` around the environment
    is part of the policy. Its actions are those of `predict` with `deterministic=True`: `act` chooses one
    of `Discrete` actions, `control` gives the numbers of a `Box`, whose names are `actions`.

    Raises `ValueError` for what the document cannot say, by its name: layers other than `Linear` with
    `ReLU` or `Tanh` between them, other feature extractors, actions that are neither `Discrete` nor a
    flat, bounded `Box`.
    """
    extractor, actor, squash = acting(algorithm.policy)
    controls = bounds(algorithm.action_space, squash)
    base, state = columns_of(algorithm.observation_space, extractor, task, key)
    layers, activation = dense(actor)
    own, count = [w.shape[1] for w, _ in layers[:-1]], layers[-1][0].shape[1]
    scale, seen = normalisation(algorithm, base, state, task.num_states)
    weights, bias = layers[0]
    # What each live state adds to the first layer: its input, normalised, is the same in every state.
    ends = (task.accepting, task.trap)
    live = [q for q in range(task.num_states) if q not in ends]
    added = np.stack([np.asarray(seen(q) @ weights[state].astype(float)) for q in live])
    network: dict[str, Any] = {
        "shape": {
            "inputs": len(base),
            "hidden": own,
            "heads": len(live),
            "actions": count,
            "entities": 0,
            "channels": 0,
        },
        "activation": activation,
        **scale,
        **controls,
    }
    layers[0] = weights[base], bias
    if own:
        network["states"] = added.astype(np.float32).ravel().tolist()
    else:
        layers[0] = np.tile(weights[base], (1, len(live))), (bias + added).astype(np.float32).ravel()
    network["layers"] = [{"weights": w.ravel().tolist(), "bias": b.tolist()} for w, b in layers]
    document = {
        "format": "tltl-network-policy",
        "version": 2,
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
        "network": network,
    }
    return NetworkPolicy.from_json(json.dumps(document))


def dense(actor: list[Any]) -> tuple[list[tuple[NDArray[np.float32], NDArray[np.float32]]], str]:
    """The weights, of shape (inputs, outputs), and biases of layers, and the activation between them."""
    layers: list[tuple[NDArray[np.float32], NDArray[np.float32]]] = []
    between: set[str] = set()
    names = {torch.nn.ReLU: "relu", torch.nn.Tanh: "tanh"}
    is_next = False
    for layer in actor:
        if isinstance(layer, torch.nn.Linear) and not is_next:
            both = (part.detach().cpu().numpy().astype(np.float32) for part in (layer.weight, layer.bias))
            weights, bias = both
            layers.append((weights.T, bias))
        elif type(layer) in names and is_next:
            between.add(names[type(layer)])
        else:
            raise ValueError(
                f"a layer {layer}: a document has Linear layers with ReLU or Tanh between them"
            )
        is_next = isinstance(layer, torch.nn.Linear)
    if len(between) > 1:
        raise ValueError("both ReLU and Tanh: a document has one of them")
    return layers, (between or {"relu"}).pop()


def acting(policy: Any) -> tuple[Any, list[Any], str]:
    """What makes features of an observation, the layers from there to what the network puts out, and what
    keeps that within the bounds, where an action is numbers."""
    if hasattr(policy, "q_net"):
        return policy.q_net.features_extractor, list(policy.q_net.q_net), ""
    if hasattr(policy, "action_net"):
        rest = [*policy.mlp_extractor.policy_net, policy.action_net]
        return policy.features_extractor, rest, "tanh" if policy.squash_output else "clip"
    actor: Any = getattr(policy, "actor", None)
    if hasattr(actor, "latent_pi"):
        # SAC: the mean of a normal distribution, before the hyperbolic tangent.
        return actor.features_extractor, [*actor.latent_pi, actor.mu], "tanh"
    if hasattr(actor, "mu"):
        # TD3 and DDPG: the hyperbolic tangent is the last layer.
        *rest, last = actor.mu
        if isinstance(last, torch.nn.Tanh):
            return actor.features_extractor, rest, "tanh"
    raise ValueError(f"{type(policy).__name__} has neither action values nor an actor")


def bounds(actions: spaces.Space[Any], squash: str) -> dict[str, Any]:
    """What the network's outputs become, for the document: nothing where it chooses among actions."""
    if isinstance(actions, spaces.Discrete) and actions.start == 0:
        return {}
    if isinstance(actions, spaces.Box) and len(actions.shape) == 1 and squash:
        ends = {"low": actions.low, "high": actions.high}
        if np.isfinite(list(ends.values())).all():
            return {"controls": {"squash": squash, **{name: end.tolist() for name, end in ends.items()}}}
    raise ValueError(
        f"actions of {actions}: wanted are Discrete from 0 on, or a Box with one axis and finite bounds"
    )


def columns_of(
    own: spaces.Space[Any], extractor: Any, task: Task, key: str
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Which features are the environment's, and which the automaton's state, one-hot."""
    count = task.num_states
    if isinstance(extractor, FlattenExtractor) and isinstance(own, spaces.Box):
        width = int(np.prod(own.shape))
        hot = np.stack([getattr(own, end).ravel()[-count:] for end in ("low", "high")])
        if hot.T.tolist() == [[0, 1]] * count:
            return np.arange(width - count), np.arange(width - count, width)
    elif isinstance(extractor, CombinedExtractor) and isinstance(own, spaces.Dict):
        parts = {name: type(part) for name, part in extractor.extractors.items()}
        other = [name for name, part in parts.items() if part is not torch.nn.Flatten]
        if other:
            raise ValueError(f"the part `{other[0]}` of observations is an image: it is not exported")
        ends = np.cumsum([0, *(get_flattened_obs_dim(own[name]) for name in parts)])
        place = dict(zip(parts, zip(ends, ends[1:], strict=False), strict=True))
        if key in place and place[key][1] - place[key][0] == count:
            state = np.arange(*place[key])
            return np.setdiff1d(np.arange(ends[-1]), state), state
    raise ValueError(
        f"observations of {own}: wanted are flat ones with the {count} states of `{task.text}` at "
        f"their end, or a Dict in which `{key}` is one of them"
    )


def normalisation(
    algorithm: BaseAlgorithm, base: NDArray[np.int64], state: NDArray[np.int64], count: int
) -> tuple[dict[str, Any], Callable[[int], NDArray[np.float64]]]:
    """How a `VecNormalize` changes the environment's features, for the document, and what it makes of an
    automaton state, one-hot."""
    own, wrapper = algorithm.observation_space, algorithm.get_vec_normalize_env()
    hot = np.eye(count)
    if wrapper is None or not wrapper.norm_obs:
        return {}, lambda q: hot[q]
    mean, deviation = np.zeros(len(base) + count), np.ones(len(base) + count)
    clip, at = float(wrapper.clip_obs), 0
    is_flat = not isinstance(own, spaces.Dict)
    parts: dict[str, Any] = {"": own} if is_flat else dict(own.spaces)
    for name, part in parts.items():
        width = get_flattened_obs_dim(part)
        if is_flat or name in (wrapper.norm_obs_keys or ()):
            moments: Any = wrapper.obs_rms if is_flat else wrapper.obs_rms[name]
            mean[at : at + width] = moments.mean.ravel()
            deviation[at : at + width] = np.sqrt(moments.var + wrapper.epsilon).ravel()
        elif isinstance(part, spaces.Box) and max(np.abs(part.low).max(), np.abs(part.high).max()) > clip:
            raise ValueError(f"`{name}` is not normalised, and may be larger than clip_obs, {clip}")
        at += width
    numbers = {"mean": mean[base].tolist(), "deviation": deviation[base].tolist(), "clip": clip}
    return {"scale": numbers}, lambda q: np.clip((hot[q] - mean[state]) / deviation[state], -clip, clip)


class TaskCallback(BaseCallback):
    """Records at the end of each episode whether the task was `satisfied` or `lost`, and its `last_q`.

    In the logger as `tltl/satisfied` and `tltl/lost`, fractions of the last hundred episodes, and
    `tltl/last_q`. Warns if the discount factor of the rewards is not the algorithm's.
    """

    def __init__(self) -> None:
        super().__init__()
        self.satisfied: list[bool] = []
        self.lost: list[bool] = []
        self.last_q: list[int] = []

    def _on_training_start(self) -> None:
        gamma = getattr(self.model, "gamma", None)
        for wanted in self.training_env.get_attr("shaping_gamma"):
            if wanted not in (None, gamma):
                warn(
                    f"gamma is {gamma}, and the shaped rewards are for {wanted}: give "
                    f'TaskEnv rewards=Rewards("shaped", gamma={gamma})',
                    TaskWarning,
                    stacklevel=2,
                )

    def _on_step(self) -> bool:
        for info, done in zip(self.locals["infos"], self.locals["dones"], strict=True):
            if done and "tltl" in info:
                told = info["tltl"]
                self.satisfied.append(bool(told["satisfied"]))
                self.lost.append(bool(told["lost"]))
                self.logger.record("tltl/satisfied", float(np.mean(self.satisfied[-100:])))
                self.logger.record("tltl/lost", float(np.mean(self.lost[-100:])))
                if not np.ndim(told["state"]):
                    # A factored task has a state for each part, which is no one number.
                    self.last_q.append(int(told["state"]))
                    self.logger.record("tltl/last_q", self.last_q[-1])
        return True


class Counterfactual:
    """Stores each step once for every live automaton state, as `tltl.replay.relabel` has it.

    With a number of `states`, so many are stored: the state in which the step was taken, and others
    that are drawn by `seed`.
    """

    def __init__(
        self,
        *args: Any,
        task: Task,
        rewards: Rewards,
        states: Literal["all"] | int = "all",
        key: str = "task_state",
        seed: int | None = None,
        **kwargs: Any,
    ) -> None:
        super().__init__(*args, **kwargs)
        if rewards.mode == "robustness":
            raise ValueError("rewards: what is stored of a step is what holds, not by how much")
        if not isinstance(states, str) and states < 1:
            raise ValueError(f"states is {states}, not \"all\" or a number from 1 on")
        self.task, self.paid_by, self.states, self.key = task, rewards, states, key
        self.generator = np.random.default_rng(seed)
        self.hot = np.eye(task.num_states, dtype=np.float32)

    def add(
        self, obs: Any, next_obs: Any, action: Any, reward: Any, done: Any, infos: list[dict[str, Any]]
    ) -> None:
        told = [info["tltl"] for info in infos]
        seen = relabel(
            self.task,
            np.stack([one["labels"] for one in told]),
            rewards=self.paid_by,
            reward=[one["environment"] for one in told],
            terminated=[one["terminated"] for one in told],
        )
        # One row for each step, one column for each live state.
        by_step = [values.reshape(len(infos), -1) for values in (seen.q, seen.next_q)]
        q, next_q = by_step
        paid, over = seen.reward.reshape(q.shape), seen.terminated.reshape(q.shape)
        rows = np.arange(len(infos))
        for column in self.chosen(self.before(obs), q).T:
            at = rows, column
            super().add(  # type: ignore[misc]
                self.shown(obs, q[at]),
                self.shown(next_obs, next_q[at]),
                action,
                paid[at],
                over[at],
                # A step at a time limit is an ordinary one: only `terminated` ends.
                [{} for _ in infos],
            )

    def chosen(self, before: NDArray[np.int64], q: NDArray[np.uint32]) -> NDArray[np.int64]:
        """The columns that are stored: of shape (steps, states)."""
        steps, live = q.shape
        if isinstance(self.states, str):
            return np.tile(np.arange(live), (steps, 1))
        own = (q == before[:, None]).argmax(1)
        drawn = self.generator.integers(live, size=(steps, self.states - 1))
        return np.column_stack([own, drawn])

    def before(self, obs: Any) -> NDArray[np.int64]:
        """The automaton states in which the steps were taken."""
        raise NotImplementedError

    def shown(self, obs: Any, q: NDArray[np.uint32]) -> Any:
        """The observations as they would be in other automaton states."""
        raise NotImplementedError


class CounterfactualReplayBuffer(Counterfactual, ReplayBuffer):
    """A replay buffer for `observe="flat"` that stores each step for every live automaton state.

    `DQN("MlpPolicy", env, replay_buffer_class=CounterfactualReplayBuffer, replay_buffer_kwargs={"task":
    env.task, "rewards": env.rewards})`. One step teaches as many as there are live states, so the buffer
    is full after that many fewer. `states` and `seed` as for `Counterfactual`: with 1 + k states it is
    used as HER's, whose k relabelled goals are other automaton states here.
    """

    def before(self, obs: Any) -> NDArray[np.int64]:
        hot: NDArray[Any] = obs[:, -self.task.num_states :]
        return np.asarray(hot.argmax(1))

    def shown(self, obs: Any, q: NDArray[np.uint32]) -> Any:
        shown = obs.copy()
        shown[:, -self.task.num_states :] = self.hot[q]
        return shown


class CounterfactualDictReplayBuffer(Counterfactual, DictReplayBuffer):
    """The same for `observe="dict"`, with `key` as for `TaskEnv`."""

    def before(self, obs: Any) -> NDArray[np.int64]:
        return np.asarray(obs[self.key], np.int64).reshape(-1)

    def shown(self, obs: Any, q: NDArray[np.uint32]) -> Any:
        return {**obs, self.key: q.astype(np.int64).reshape(np.shape(obs[self.key]))}
