"""Gymnasium environments beside tasks: `TaskEnv`.

The agent sees the environment's observation and the automaton's state, and is paid by `Rewards`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from graphlib import CycleError, TopologicalSorter
from typing import Any, Generic, Literal, cast
from warnings import warn

import numpy as np
from numpy.typing import NDArray

from tltl._core import Factored, Rewards, Shield, Task, follow
from tltl._errors import TaskWarning
from tltl._labels import Labels

try:
    import gymnasium as gym
    from gymnasium import spaces
    from gymnasium.utils import RecordConstructorArgs
except ImportError:
    raise ImportError("tltl.gymnasium needs Gymnasium: pip install 'tltl[gymnasium]'")

from typing_extensions import TypeVar  # isort: skip, comes with Gymnasium

__all__ = ["TaskEnv"]

#: What an environment follows: a task with one automaton, unless another is given.
Followed = TypeVar("Followed", bound=Task | Factored, default=Task)

#: What holds now: of the environment that is wrapped, its observation and its info.
LabelFn = Callable[[Any, Any, dict[str, Any]], Labels]
Columns = Mapping[str, int] | Sequence[str]

#: Resets in search of a start that is not decided already.
RESETS = 100


class TaskEnv(gym.Wrapper[Any, Any, Any, Any], RecordConstructorArgs, Generic[Followed]):
    """An environment with a task: the agent sees the automaton's state, and is paid for the task.

    `labels(env, obs, info)` says what holds, by the names of the formula; `env` is the environment
    that is wrapped. Where predicates are numeric, `columns` says instead where the observation, made
    flat, has the numbers.

    - `observe`: `"flat"` appends the state of the automaton, one-hot, to the flattened observation;
      `"dict"` gives a `Dict` with it under `key`; `"none"` leaves the observation as it is. Of a
      `Factored` task each part has a one-hot of its own, and the `Dict` an array with a state for each.
    - `terminate`: whether the episode terminates where the task is satisfied or lost.
    - `shield` (of `Solution.shield`): `action_masks()` says what it allows, which MaskablePPO of
      sb3-contrib reads, and any other action is a `ValueError`. `model_state(obs)` gives the state of
      the model that the shield is for; for `Discrete` observations that is the observation.
    - `on_decided_reset`: the first observation is read too, so the task may be satisfied or lost
      before the first action. `"resample"` resets again (at most 100 times); `"raise"` is an
      error; with `"keep"` the first step pays nothing and terminates.

    The environment's own end stays its own: it satisfies nothing. `info["tltl"]` has, at every step
    and at reset: `state`, `satisfied`, `lost`, `progress` (whether the automaton moved on), `distance`
    (moves to acceptance at least, -1 if there is no way), `labels`, `resampled` (resets that were
    decided), `terminated` and `environment` (whether the environment ended the episode itself, and its own
    reward), and `rho` where the reward reads it.

    >>> import gymnasium as gym
    >>> from tltl.gymnasium import TaskEnv
    >>> def labels(env, obs, info):
    ...     return {"corner": obs == 3, "goal": obs == 15}
    >>> env = TaskEnv(gym.make("FrozenLake-v1", is_slippery=False), "corner T goal", labels)
    >>> obs, info = env.reset(seed=0)
    >>> obs.shape, info["tltl"]["state"]
    ((19,), 0)
    """

    def __init__(
        self,
        env: gym.Env[Any, Any],
        task: Followed | str,
        labels: LabelFn | None = None,
        *,
        columns: Columns | None = None,
        rewards: Rewards | str | None = None,
        observe: Literal["flat", "dict", "none"] = "flat",
        key: str = "task_state",
        terminate: bool = True,
        shield: Shield | None = None,
        model_state: Callable[[Any], int] | None = None,
        on_decided_reset: Literal["resample", "raise", "keep"] = "resample",
    ) -> None:
        RecordConstructorArgs.__init__(
            self,
            task=task,
            labels=labels,
            columns=columns,
            rewards=rewards,
            observe=observe,
            key=key,
            terminate=terminate,
            shield=shield,
            model_state=model_state,
            on_decided_reset=on_decided_reset,
        )
        super().__init__(env)
        if (labels is None) == (columns is None):
            raise ValueError("give `labels` or `columns`: what holds, or where the numbers are")
        if on_decided_reset not in ("resample", "raise", "keep"):
            raise ValueError(f"on_decided_reset is {on_decided_reset!r}")
        self.task = compiled(task)
        self.rewards = Rewards(rewards) if isinstance(rewards, str) else rewards or Rewards()
        self._labels, self._columns = labels, columns
        self._terminate, self._on_decided_reset = terminate, on_decided_reset
        self._pays_rho = self.rewards.mode == "robustness"
        self._observe, self.observation_space = observing(
            self.task, env.observation_space, observe, key
        )
        self._q: Any = self.task.initial
        self._last: tuple[Any, dict[str, Any]] | None = None
        self._shield, self._model_state = shield, model_state
        self._mask: NDArray[np.bool_] | None = None
        if shield is not None:
            self._check_shield(shield, env.observation_space)
        lasts, declared = getattr(env.unwrapped, "dt", None), self.task.step_seconds
        if declared is not None and isinstance(lasts, float) and not np.isclose(lasts, declared):
            warn(
                f"a step of the environment lasts {lasts} s, and the task says {declared} s",
                TaskWarning,
                stacklevel=2,
            )
        if self.rewards.mode == "progress" and has_a_way_back(self.task):
            warn(
                f"the automaton of `{self.task.text}` has a way back: it is paid again and again "
                "for the same moves, and the best policy need not satisfy the task; use the mode "
                '"shaped"',
                TaskWarning,
                stacklevel=2,
            )

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        resampled = 0
        while True:
            obs, info = self.env.reset(seed=seed if resampled == 0 else None, options=options)
            self._q = self.task.initial
            _, decided, told = self._follow(obs, info)
            told["resampled"] = resampled
            decided = decided and self._terminate
            if not decided or self._on_decided_reset == "keep":
                break
            if self._on_decided_reset == "raise":
                raise RuntimeError(f"the task is decided at the start {obs!r}")
            if resampled == RESETS:
                raise RuntimeError(f"{RESETS} starts were decided; the last is {obs!r}")
            resampled += 1
        told["progress"] = told["terminated"] = False
        told["environment"] = 0.0
        self._see(obs)
        obs, info = self._observe(obs, self._q), {**info, "tltl": told}
        self._last = (obs, info) if decided else None
        return obs, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        if self._last is not None:
            # The task was decided before the first action.
            obs, info = self._last
            return obs, 0.0, True, False, info
        if self._mask is not None and not self._mask[action]:
            allowed = np.flatnonzero(self._mask).tolist()
            raise ValueError(f"the shield bars action {action}; it allows {allowed}: see action_masks()")
        obs, reward, terminated, truncated, info = self.env.step(action)
        paid, decided, told = self._follow(obs, info, float(reward), bool(terminated))
        over = bool(terminated) or (decided and self._terminate)
        if self._shield is not None:
            self._see(obs)
        return self._observe(obs, self._q), paid, over, truncated, {**info, "tltl": told}

    @property
    def shaping_gamma(self) -> float | None:
        """The discount factor that the rewards are for, which must be the learner's, if they are shaped."""
        return self.rewards.gamma if self.rewards.mode == "shaped" else None

    def observed(self, obs: Any, q: Any) -> Any:
        """What the agent sees where the environment shows `obs` and the automaton is in `q`."""
        return self._observe(obs, q)

    def action_masks(self) -> NDArray[np.bool_]:
        """What the shield allows now: bool, of shape (actions,).

        Raises `ValueError` if there is no shield, and `RuntimeError` before the first reset.
        """
        if self._shield is None:
            raise ValueError("there is no shield: TaskEnv(…, shield=solution.shield())")
        if self._mask is None:
            raise RuntimeError("reset the environment first")
        return self._mask.copy()

    def _check_shield(self, shield: Shield, base: spaces.Space[Any]) -> None:
        own = self.task.fingerprint if isinstance(self.task, Task) else None
        if shield.task is None or shield.task.fingerprint != own:
            raise ValueError(f"{shield} is for another task than `{self.task.text}`")
        if self._model_state is None and not isinstance(base, spaces.Discrete):
            raise ValueError(f"give `model_state`: observations of {base} are no states of a model")

    def _see(self, obs: Any) -> None:
        """What the shield allows where the world is now."""
        if self._shield is not None:
            state = int(obs) if self._model_state is None else self._model_state(obs)
            self._mask = self._shield.mask(self._q, state)

    def _follow(
        self, obs: Any, info: dict[str, Any], reward: float = 0.0, terminated: bool = False
    ) -> tuple[float, bool, dict[str, Any]]:
        """Moves the automaton by what holds now: the pay, whether it is decided, and where it is."""
        holds: Labels
        robust: Labels | None = None
        if self._labels is None:
            row = spaces.flatten(self.env.observation_space, obs)
            holds = self.task.labels(row, columns=self._columns)
            if self._pays_rho:
                robust = self.task.rho(row, columns=self._columns)
        else:
            holds = self._labels(self.env, obs, info)
        self._q, paid, decided, told = follow(
            self.task, self.rewards, self._q, holds, robust, reward, terminated
        )
        return paid, decided, told


def compiled(task: Followed | str) -> Followed:
    """The task, or that of a formula."""
    return cast(Followed, Task(task) if isinstance(task, str) else task)


def automata(task: Task | Factored) -> tuple[Task, ...]:
    """The tasks whose automata run, one or several."""
    return task.parts if isinstance(task, Factored) else (task,)


def has_a_way_back(task: Task | Factored) -> bool:
    """Whether some state can be left and come back to."""
    for part in automata(task):
        graph: dict[int, set[int]] = {}
        for edge in part.edges:
            if edge.source != edge.target:
                graph.setdefault(edge.target, set()).add(edge.source)
        try:
            TopologicalSorter(graph).prepare()
        except CycleError:
            return True
    return False


def one_hot(task: Task | Factored) -> Callable[[Any], NDArray[Any]]:
    """What writes automaton states, of shape (n,) or (n, parts), as rows of zeros with a one for each
    automaton."""
    eyes = [np.eye(part.num_states) for part in automata(task)]
    if isinstance(task, Task):
        return lambda q: eyes[0][q]
    return lambda q: np.concatenate([eye[q[:, i]] for i, eye in enumerate(eyes)], axis=1)


def observing(
    task: Task | Factored, base: spaces.Space[Any], observe: str, key: str
) -> tuple[Callable[[Any, Any], Any], spaces.Space[Any]]:
    """How an observation and the automaton's state become one, and the space of the result."""
    if observe == "none":
        return (lambda obs, q: obs), base
    if observe == "flat":
        return flat(task, base)
    if observe == "dict":
        return named(task, base, key)
    raise ValueError(f'observe is {observe!r}, not one of "flat", "dict", "none"')


def flat(
    task: Task | Factored, base: spaces.Space[Any]
) -> tuple[Callable[[Any, Any], Any], spaces.Space[Any]]:
    """The flattened observation with the state of the automaton, one-hot, behind it."""
    box = spaces.flatten_space(base) if is_flat(base) else None
    if not isinstance(box, spaces.Box):
        raise ValueError(
            f'observations of {base} are not made flat: use observe="dict", or put a wrapper '
            "beneath (for MiniGrid ImgObsWrapper or FlatObsWrapper)"
        )
    dtype: Any = box.dtype if np.issubdtype(box.dtype, np.floating) else np.dtype(np.float32)
    hots = [list(np.eye(part.num_states, dtype=dtype)) for part in automata(task)]
    width = sum(map(len, hots))
    low, high = (
        np.concatenate([end.astype(dtype), np.full(width, hot, dtype)])
        for end, hot in ((box.low, 0), (box.high, 1))
    )

    hot, is_box = hots[0], isinstance(base, spaces.Box) and base.shape == box.shape
    is_one = isinstance(task, Task)

    def joined(obs: Any, q: Any) -> Any:
        flattened: Any = obs if is_box else spaces.flatten(base, obs)
        own = (hot[q],) if is_one else [one[state] for one, state in zip(hots, q.tolist(), strict=True)]
        return np.concatenate((flattened, *own), dtype=dtype, casting="unsafe")

    return joined, spaces.Box(low, high, dtype=dtype.type)


def is_flat(space: spaces.Space[Any]) -> bool:
    """Whether flattening loses nothing: no images, texts, graphs or sequences."""
    if isinstance(space, spaces.Dict):
        return all(map(is_flat, space.values()))
    if isinstance(space, spaces.Tuple):
        return all(map(is_flat, space))
    if isinstance(space, spaces.Box):
        return len(space.shape) < 2
    return isinstance(space, spaces.Discrete | spaces.MultiDiscrete | spaces.MultiBinary)


def named(
    task: Task | Factored, base: spaces.Space[Any], key: str
) -> tuple[Callable[[Any, Any], Any], spaces.Space[Any]]:
    """The observation and the state of the automaton, by name."""
    sizes = [part.num_states for part in automata(task)]
    state: Any = spaces.Discrete(sizes[0]) if isinstance(task, Task) else spaces.MultiDiscrete(sizes)
    if not isinstance(base, spaces.Dict):
        return (
            (lambda obs, q: {"observation": obs, key: np.int64(q)}),
            spaces.Dict({"observation": base, key: state}),
        )
    if key in base.spaces:
        raise ValueError(f"the observation has `{key}` already: choose another `key`")
    return (lambda obs, q: {**obs, key: np.int64(q)}), spaces.Dict({**base.spaces, key: state})
