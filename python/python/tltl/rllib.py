"""RLlib: tasks on the runners of a cluster.

Nothing here is an engine of its own: an environment is registered by name, and Ray's runners make it where
they are. Everywhere the same version of this package is installed; a task by value says so if it is not.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from tltl.gymnasium import Columns, LabelFn, TaskEnv, automata

try:
    from ray.rllib.callbacks.callbacks import RLlibCallback
    from ray.tune.registry import register_env
except ImportError:
    raise ImportError("tltl.rllib needs RLlib: pip install 'tltl[rllib]'")

__all__ = ["TaskMetrics", "register_task_env"]


def register_task_env(
    name: str,
    make: Callable[..., Any],
    labels: LabelFn | None = None,
    *,
    columns: Columns | None = None,
) -> None:
    """Registers environments with tasks under a name, for `AlgorithmConfig.environment`.

    `make(**options)` makes the environment, and `labels` or `columns` say what holds in it, as for
    `TaskEnv`; functions travel by reference, so they are defined in a module that every runner imports,
    or by value, if they are not. What differs between experiments is in `env_config`:

    - `task`: a formula, compiled where the runner is, or a `Task` or `Factored`, which is pickled by its source; its
      fingerprint is compared there.
    - `fingerprint`: that of the task, compared if it is given.
    - `make`: a mapping of options for `make`.
    - all else: options of `TaskEnv`, as `rewards` and `observe`.

    ```python
    register_task_env("door", make, labels)
    config = PPOConfig().environment("door", env_config={"task": "key T door T goal"})
    ```
    """

    def create(config: Mapping[str, Any]) -> TaskEnv:
        options = dict(config)
        task, fingerprint = options.pop("task"), options.pop("fingerprint", None)
        made = make(**options.pop("make", {}))
        env = TaskEnv(made, task, labels, columns=columns, **options)
        own = " ".join(part.fingerprint for part in automata(env.task))
        if fingerprint not in (None, own):
            raise ValueError(
                f"the automaton of `{env.task.text}` is numbered in another way here "
                f"({own}, not {fingerprint}): install the same version everywhere"
            )
        return env

    register_env(name, create)


class TaskMetrics(RLlibCallback):
    """Reports of each episode, among the results of `env_runners`: means over `tltl_satisfied` and
    `tltl_lost`, the number `tltl_episodes`, and for each automaton state `tltl_last_q/q`, in how many
    episodes it was the last.

    `config.callbacks(TaskMetrics)`.
    """

    def on_episode_end(self, *, episode: Any, metrics_logger: Any, **kwargs: Any) -> None:
        told = episode.get_infos(-1).get("tltl")
        if told is None:
            return
        metrics_logger.log_value("tltl_satisfied", float(told["satisfied"]), reduce="mean")
        metrics_logger.log_value("tltl_lost", float(told["lost"]), reduce="mean")
        metrics_logger.log_value("tltl_episodes", 1, reduce="lifetime_sum")
        # Of a factored task a state for each part: 0,1,1.
        last = ",".join(map(str, np.atleast_1d(told["state"]).tolist()))
        metrics_logger.log_value(("tltl_last_q", last), 1, reduce="lifetime_sum")

