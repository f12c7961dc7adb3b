"""Vector environments beside tasks: `TaskVectorEnv` moves all automata in one call.

A vector environment can reset one of its rows only if it does not reset rows by itself. So the base
is made with `autoreset_mode=AutoresetMode.DISABLED`, and `TaskVectorEnv` resets.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Generic, Literal
from warnings import warn

import numpy as np
from numpy.typing import NDArray

from tltl._core import Rewards, follow_all
from tltl._errors import TaskWarning
from tltl.gymnasium import (
    RESETS,
    Columns,
    Followed,
    compiled,
    has_a_way_back,
    observing,
    one_hot,
)

from gymnasium import spaces  # isort: skip

try:
    from gymnasium.vector import AutoresetMode, VectorEnv, VectorWrapper
    from gymnasium.vector.utils import batch_space, iterate
except ImportError:
    raise ImportError("tltl.vector needs Gymnasium 1.1 or later: pip install 'gymnasium>=1.1'")

__all__ = ["TaskVectorEnv"]

#: What holds now, in each row: arrays of shape (n,) by name, or one of shape (n, propositions).
VectorLabelFn = Callable[
    [Any, Any, dict[str, Any]], Mapping[str, NDArray[Any]] | NDArray[Any]
]
Told = dict[str, NDArray[Any]]


class TaskVectorEnv(VectorWrapper, Generic[Followed]):
    """A vector environment with a task in each row. Options are those of `TaskEnv`.

    `autoreset_mode` is `NEXT_STEP` (the call after the end ignores the action of the row and returns
    the next start, which pays nothing) or `SAME_STEP` (the last step returns the next start; the
    observation at the end is in `infos["final_obs"]`, and what was told there in
    `infos["final_info"]`). The base steps all its rows at once, so with `NEXT_STEP` a row that starts
    anew is stepped once in vain and reset again; `SAME_STEP` costs nothing.

    >>> import gymnasium as gym
    >>> from gymnasium.vector import AutoresetMode
    >>> from tltl.vector import TaskVectorEnv
    >>> base = gym.make_vec(
    ...     "CartPole-v1",
    ...     num_envs=8,
    ...     vectorization_mode="sync",
    ...     vector_kwargs={"autoreset_mode": AutoresetMode.DISABLED},
    ... )
    >>> envs = TaskVectorEnv(base, "(x > 0.2) T (x < -0.2)", columns={"x": 0})
    >>> obs, infos = envs.reset(seed=0)
    >>> obs.shape, infos["tltl"]["state"].tolist()
    ((8, 7), [0, 0, 0, 0, 0, 0, 0, 0])
    """

    def __init__(
        self,
        env: VectorEnv[Any, Any, Any],
        task: Followed | str,
        labels: VectorLabelFn | None = None,
        *,
        autoreset_mode: AutoresetMode = AutoresetMode.NEXT_STEP,
        columns: Columns | None = None,
        rewards: Rewards | str | None = None,
        observe: Literal["flat", "dict", "none"] = "flat",
        key: str = "task_state",
        terminate: bool = True,
    ) -> None:
        super().__init__(env)
        if env.metadata.get("autoreset_mode") != AutoresetMode.DISABLED:
            raise ValueError(
                "the base resets its rows by itself: make it with "
                "autoreset_mode=AutoresetMode.DISABLED, or put TaskEnv inside of SyncVectorEnv"
            )
        if autoreset_mode not in (AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP):
            raise ValueError(f"autoreset_mode is {autoreset_mode}, not NEXT_STEP or SAME_STEP")
        if (labels is None) == (columns is None):
            raise ValueError("give `labels` or `columns`: what holds, or where the numbers are")
        self.task = compiled(task)
        self.rewards = Rewards(rewards) if isinstance(rewards, str) else rewards or Rewards()
        self.metadata = {**env.metadata, "autoreset_mode": autoreset_mode}
        self._is_same_step = autoreset_mode == AutoresetMode.SAME_STEP
        self._labels, self._columns, self._terminate = labels, columns, terminate
        self._pays_rho = self.rewards.mode == "robustness"
        single = env.single_observation_space
        self._one, self.single_observation_space = observing(self.task, single, observe, key)
        self.observation_space = batch_space(self.single_observation_space, env.num_envs)
        self._form, self._key = observe, key
        self._hot = one_hot(self.task)
        self._initial = np.repeat(np.array([self.task.initial], np.uint32), env.num_envs, axis=0)
        self._q = self._initial
        self._done = np.zeros(env.num_envs, bool)
        if self.rewards.mode == "progress" and has_a_way_back(self.task):
            warn(
                f"the automaton of `{self.task.text}` has a way back; use the mode \"shaped\"",
                TaskWarning,
                stacklevel=2,
            )

    def reset(
        self,
        *,
        seed: int | list[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Any, dict[str, Any]]:
        start_seed: Any = seed
        obs, infos = self.env.reset(seed=start_seed, options=options)
        every = np.ones(self.num_envs, bool)
        told = self._start(obs, infos, every)
        decided = self._is_over(told)
        if decided.any():
            obs, infos, told = self._restart(decided, infos, told, resampled=1)
        self._done[:] = False
        return self._observed(obs), {**infos, "tltl": told, "_tltl": every}

    def step(
        self, actions: Any
    ) -> tuple[Any, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        starting = self._done.copy()
        if starting.any():
            # The base refuses to step a row that is over.
            self.env.reset(options={"reset_mask": starting.copy()})
        obs, reward, terminated, truncated, infos = self.env.step(actions)
        paid, told = self._read(obs, infos, np.asarray(reward), terminated)
        terminated, truncated = terminated | self._is_over(told), truncated.copy()
        if starting.any():
            obs, infos, told = self._restart(starting, infos, told)
            for of_step in (paid, terminated, truncated):
                of_step[starting] = 0
        self._done = terminated | truncated
        infos["tltl"], infos["_tltl"] = told, np.ones(self.num_envs, bool)
        if self._is_same_step and self._done.any():
            final = self._observed(obs)
            ended, self._done = self._done, np.zeros(self.num_envs, bool)
            last = infos
            obs, infos, told = self._restart(ended, dict(infos), told)
            infos |= {
                "tltl": told,
                "final_obs": rows_where(self.single_observation_space, final, ended),
                "_final_obs": ended,
                "final_info": last,
                "_final_info": ended,
            }
        return self._observed(obs), paid, terminated, truncated, infos

    def _restart(
        self, which: NDArray[np.bool_], infos: dict[str, Any], told: Told, resampled: int = 0
    ) -> tuple[Any, dict[str, Any], Told]:
        """Resets rows until none of them is decided at its start."""
        told = {name: values.copy() for name, values in told.items()}
        left = which.copy()
        for resampled in range(resampled, RESETS + 1):
            obs, own = self.env.reset(options={"reset_mask": left.copy()})
            infos = overlaid(infos, own, left)
            start = self._start(obs, infos, left)
            start["resampled"][:] = resampled
            for name, values in told.items():
                values[left] = start[name][left]
            left = left & self._is_over(told)
            if not left.any():
                return obs, infos, told
        raise RuntimeError(f"{RESETS} starts were decided in rows {np.flatnonzero(left).tolist()}")

    def _start(self, obs: Any, infos: dict[str, Any], which: NDArray[np.bool_]) -> Told:
        """Reads the first state of some rows; the others stay where they are."""
        kept, nothing = self._q, np.zeros(self.num_envs)
        self._q = self._initial
        _, told = self._read(obs, infos, nothing, nothing)
        self._q[~which] = kept[~which]
        told["progress"][:] = False
        return told

    def _read(
        self, obs: Any, infos: dict[str, Any], reward: NDArray[Any], terminated: NDArray[Any]
    ) -> tuple[NDArray[np.float64], Told]:
        """Moves the automata by what holds now: what that pays, and where they are."""
        task, given, columns = self.task, obs, self._columns
        if self._labels is None:
            given = self._flattened(obs)
        else:
            given = self._labels(self.env, obs, infos)
        robust = None
        if columns is not None or isinstance(given, Mapping):
            holds = task.labels(given, columns=columns)
            if self._pays_rho:
                robust = task.rho(given, columns=columns)
        else:
            holds = np.asarray(given)
        self._q, paid, told = follow_all(
            task, self.rewards, self._q, holds, robust, reward, terminated
        )
        return paid, told

    def _is_over(self, told: Told) -> NDArray[np.bool_]:
        return (told["satisfied"] | told["lost"]) & self._terminate

    def _flattened(self, obs: Any) -> NDArray[Any]:
        single = self.env.single_observation_space
        if isinstance(single, spaces.Box):
            return np.asarray(obs).reshape(self.num_envs, -1)
        each: Any = iterate(self.env.observation_space, obs)
        flat: list[Any] = [spaces.flatten(single, row) for row in each]
        return np.stack(flat)

    def _observed(self, obs: Any) -> Any:
        if self._form == "none":
            return obs
        if self._form == "flat":
            dtype: Any = self.single_observation_space.dtype
            return np.concatenate([self._flattened(obs), self._hot(self._q)], axis=1, dtype=dtype)
        base = obs if isinstance(obs, dict) else {"observation": obs}
        return {**base, self._key: self._q.astype(np.int64)}


def rows_where(
    single: spaces.Space[Any], obs: Any, which: NDArray[np.bool_]
) -> NDArray[np.object_]:
    """The rows of a batch of observations, `None` where they are not asked for."""
    rows = np.full(len(which), None, object)
    for i, row in enumerate(iterate(batch_space(single, len(which)), obs)):
        if which[i]:
            rows[i] = row
    return rows


def overlaid(infos: dict[str, Any], own: dict[str, Any], which: NDArray[np.bool_]) -> dict[str, Any]:
    """The infos with those of some rows replaced."""
    result = dict(infos)
    for name, values in own.items():
        known = result.get(name)
        if isinstance(values, dict):
            result[name] = overlaid(known if isinstance(known, dict) else {}, values, which)
        elif isinstance(values, np.ndarray) and isinstance(known, np.ndarray):
            result[name] = known.copy()
            result[name][which] = values[which]
        else:
            result[name] = values
    return result
