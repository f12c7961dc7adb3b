"""RLlib on Ray: two runners do what one process does; `pip install 'tltl[rllib]'`."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from tltl import Rewards, Task
from tltl.gymnasium import TaskEnv

ray = pytest.importorskip("ray")
pytest.importorskip("ray.rllib")
pytestmark = pytest.mark.rllib

FORMULA = "corner T goal"


def make(**options: Any) -> Any:
    return gym.make("FrozenLake-v1", is_slippery=False, **options)


def labels(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, bool]:
    return {"corner": obs == 3, "goal": obs == 15}


@pytest.fixture(scope="module", autouse=True)
def cluster() -> Iterator[None]:
    # Runners cannot import a file of tests: its functions travel by value.
    ray.cloudpickle.register_pickle_by_value(sys.modules[__name__])
    # On a cluster, this alone differs: ray.init(address="auto").
    ray.init(num_cpus=3, include_dashboard=False, log_to_driver=False)
    yield
    ray.shutdown()


def configured(**env_config: Any) -> Any:
    from ray.rllib.algorithms.ppo import PPOConfig
    from tltl.rllib import TaskMetrics, register_task_env

    register_task_env("lake", make, labels)
    return (
        PPOConfig()
        .environment("lake", env_config={"task": FORMULA, **env_config})
        .env_runners(num_env_runners=2, rollout_fragment_length=100)
        .learners(num_learners=0)
        .training(train_batch_size_per_learner=400, minibatch_size=100, num_epochs=2)
        .callbacks(TaskMetrics)
        .fault_tolerance(restart_failed_env_runners=True)
        .debugging(seed=1)
    )


def walked(env: Any, seed: int) -> list[tuple[int, list[bool], float]]:
    """A random walk: automaton state, labels and reward after each step."""
    rng = np.random.default_rng(seed)
    _, info = env.reset(seed=seed)
    met = [(info["tltl"]["state"], info["tltl"]["labels"].tolist(), 0.0)]
    for _ in range(200):
        _, reward, terminated, truncated, info = env.step(int(rng.integers(4)))
        met.append((info["tltl"]["state"], info["tltl"]["labels"].tolist(), float(reward)))
        if terminated or truncated:
            _, info = env.reset()
            met.append((info["tltl"]["state"], info["tltl"]["labels"].tolist(), 0.0))
    return met


def test_runners_move_the_automaton_as_one_process_does() -> None:
    algorithm = configured().build_algo()

    def of_runner(runner: Any) -> Any:
        env = runner.env.unwrapped.envs[0]
        while not isinstance(env, TaskEnv):
            env = env.env
        return os.getpid(), env.task.fingerprint, walked(env, 7)

    found = algorithm.env_runner_group.foreach_env_runner(of_runner, local_env_runner=False)
    algorithm.stop()
    own = TaskEnv(make(), FORMULA, labels)
    assert len({pid for pid, _, _ in found} - {os.getpid()}) == 2
    for _, fingerprint, met in found:
        assert fingerprint == own.task.fingerprint and met == walked(own, 7)
    assert len({q for q, _, _ in found[0][2]}) >= 2


def test_it_trains_reports_and_survives_the_loss_of_a_runner() -> None:
    algorithm = configured(rewards=Rewards("shaped", gamma=0.99)).build_algo()
    told = algorithm.train()["env_runners"]
    assert 0 <= told["tltl_satisfied"] <= 1 and 0 <= told["tltl_lost"] <= 1
    counts = {int(q): count for q, count in told["tltl_last_q"].items()}
    assert sum(counts.values()) == told["tltl_episodes"] > 0
    assert set(counts) <= set(range(own_states()))

    def killed(runner: Any) -> None:
        if runner.worker_index == 1:
            os._exit(1)

    algorithm.env_runner_group.foreach_env_runner(
        killed, local_env_runner=False, timeout_seconds=30
    )
    iterations = 0
    while iterations < 3 or algorithm.env_runner_group.num_healthy_remote_workers() < 2:
        told = algorithm.train()["env_runners"]
        iterations += 1
        assert iterations < 30, "the runner is not replaced"
    assert told["tltl_episodes"] > sum(counts.values())
    algorithm.stop()


def own_states() -> int:
    return Task(FORMULA).num_states


def test_tasks_travel_by_value() -> None:
    task = Task(FORMULA)

    @ray.remote  # type: ignore[untyped-decorator]
    def there(task: Task, states: Any) -> Any:
        assert not states.flags.writeable
        again = Task(task.text)
        moved = task.step_batch(states, np.ones((len(states), 2), bool))
        return task == again, task.fingerprint, moved

    states = np.zeros(1_000, np.uint32)
    is_same, fingerprint, moved = ray.get(there.remote(ray.put(task), ray.put(states)))
    assert is_same and fingerprint == task.fingerprint
    # Arrays of the store are read-only.
    stored = ray.get(ray.put(states))
    assert not stored.flags.writeable
    assert np.array_equal(moved, task.step_batch(stored, np.ones((1_000, 2), bool)))
    with pytest.raises(ValueError, match="the array is read-only"):
        task.step_batch(stored, np.ones((1_000, 2), bool), out=stored)
    algorithm = configured(task=task, fingerprint=task.fingerprint).build_algo()
    assert algorithm.train()["env_runners"]["tltl_episodes"] > 0
    algorithm.stop()


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"task": "corner T G goal"}, "unsupported-operator"),
        ({"fingerprint": "0" * 16}, "install the same version everywhere"),
    ],
)
def test_what_is_wrong_is_shown_where_it_is_driven(
    wrong: Any, message: str, caplog: pytest.LogCaptureFixture, capfd: pytest.CaptureFixture[str]
) -> None:
    # RLlib raises an error of its own, and logs why its runners were not made.
    with pytest.raises(Exception), caplog.at_level("ERROR"):
        configured(**wrong).build_algo()
    text = caplog.text + "".join(capfd.readouterr())
    assert message in text
    if "task" in wrong:
        assert "1 | corner T G goal" in text and "^" in text


def test_the_page_trains(capsys: pytest.CaptureFixture[str]) -> None:
    page = (Path(__file__).parents[1] / "docs" / "rllib.md").read_text(encoding="utf-8")
    [code] = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    # Ray runs already.
    code = code.replace("ray.init(num_cpus=3)", "pass")

    def door(env: Any, obs: Any, info: dict[str, Any]) -> dict[str, bool]:
        return {"key": obs == 1, "door": obs == 2, "goal": obs == 15}

    trained: dict[str, Any] = {"make": make, "labels": door}
    exec(compile(code, "rllib.md", "exec"), trained)
    trained["algorithm"].stop()
    assert 0 <= float(capsys.readouterr().out.split()[-1]) <= 1
