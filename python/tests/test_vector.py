"""`TaskVectorEnv` is `TaskEnv` in each row, through the ends of episodes."""

from __future__ import annotations

import warnings
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from test_factored import pair
from test_gymnasium import MODES, Tape, abc

from tltl import Rewards, Task, TaskWarning
from tltl.gymnasium import TaskEnv
from tltl.replay import relabel

if "CliffWalking-v1" not in gym.registry:
    pytest.skip("vector environments need Gymnasium 1.1", allow_module_level=True)

from gymnasium.vector import AsyncVectorEnv, AutoresetMode, SyncVectorEnv  # noqa: E402

from tltl.vector import TaskVectorEnv  # noqa: E402

NEXT, SAME = AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP


def many(envs: Any, obs: Any, infos: dict[str, Any]) -> dict[str, Any]:
    return {name: np.asarray(obs) >> i & 1 > 0 for i, name in enumerate("abc")}


def tapes(seed: int, count: int) -> list[Any]:
    """Worlds of eight observations; every start carries labels, and some ends are their own."""
    rng = np.random.default_rng(seed)

    def make() -> Any:
        letters = rng.integers(0, 8, 40).tolist()
        # A start with neither b alone nor everything: undecided for the formulas here.
        letters[0] = int(rng.choice([1, 5]))
        end, cut = (int(rng.choice([-1, *range(1, 9)])) for _ in range(2))
        return lambda: Tape(letters + [0] * 400, end, cut)

    return [make() for _ in range(count)]


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("autoreset", [NEXT, SAME])
@pytest.mark.parametrize("observe", ["flat", "dict", "none"])
def test_rows_are_task_envs(mode: str, autoreset: AutoresetMode, observe: Any) -> None:
    options: dict[str, Any] = {
        "rewards": Rewards(mode, environment=0.5, gamma=0.9),
        "observe": observe,
    }
    makes = tapes(1, 6)

    def wrapped(make: Any) -> Any:
        return lambda: TaskEnv(make(), task, abc, **options)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        task = Task("a T b T a")
        one = SyncVectorEnv([wrapped(make) for make in makes], autoreset_mode=autoreset)
        base = SyncVectorEnv(makes, autoreset_mode=AutoresetMode.DISABLED)
        ours = TaskVectorEnv(base, task, many, autoreset_mode=autoreset, **options)
    equal: Any = np.testing.assert_equal
    (obs, infos), (own, told) = one.reset(), ours.reset()
    equal(own, obs)
    ended = 0
    for _ in range(120):
        actions = np.zeros(6, np.int64)
        *step, infos = one.step(actions)
        *mine, told = ours.step(actions)
        for theirs, here in zip(step, mine, strict=True):
            equal(here, theirs)
        # What was told; the first action after an end is no step of the task.
        for name in ("state", "satisfied", "lost", "progress", "distance", "labels"):
            equal(told["tltl"][name], infos["tltl"][name])
        ended += int((mine[2] | mine[3]).sum())
        if autoreset == SAME and "final_obs" in infos:
            for theirs, here in zip(infos["final_obs"], told["final_obs"], strict=True):
                equal(here, theirs)
            last = infos["_final_info"]
            final = infos["final_info"]["tltl"]["state"][last]
            equal(told["final_info"]["tltl"]["state"][last], final)
    assert ended > 50, "episodes came to their ends"


def test_carts_with_labelled_starts() -> None:
    task, columns = Task("(x < 0.05) T (v > 0.3) T (x < 0.05)"), {"x": 0, "v": 1}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for autoreset in (SAME,):
            one = SyncVectorEnv(
                [lambda: TaskEnv(gym.make("CartPole-v1"), task, columns=columns)] * 16,
                autoreset_mode=autoreset,
            )
            base = SyncVectorEnv(
                [lambda: gym.make("CartPole-v1")] * 16, autoreset_mode=AutoresetMode.DISABLED
            )
            ours = TaskVectorEnv(base, task, columns=columns, autoreset_mode=autoreset)
    obs, _ = one.reset(seed=3)
    own, _ = ours.reset(seed=3)
    rng, paid = np.random.default_rng(1), 0.0
    for _ in range(200):
        assert np.array_equal(own, obs)
        actions = rng.integers(0, 2, 16)
        obs, reward, *_ = one.step(actions)
        own, mine, *_ = ours.step(actions)
        assert np.array_equal(mine, reward)
        paid += float(np.abs(mine).sum())
    assert paid > 0


@pytest.mark.parametrize("observe", ["flat", "dict", "none"])
@pytest.mark.parametrize("autoreset", [NEXT, SAME])
@pytest.mark.parametrize("mode", MODES)
def test_rows_of_factored_tasks_are_task_envs(mode: str, autoreset: AutoresetMode, observe: Any) -> None:
    task, makes = pair()[0], tapes(1, 6)
    options: dict[str, Any] = {"rewards": Rewards(mode, environment=0.5), "observe": observe}

    def wrapped(make: Any) -> Any:
        return lambda: TaskEnv(make(), task, abc, **options)

    one = SyncVectorEnv([wrapped(make) for make in makes], autoreset_mode=autoreset)
    base = SyncVectorEnv(makes, autoreset_mode=AutoresetMode.DISABLED)
    ours = TaskVectorEnv(base, task, many, autoreset_mode=autoreset, **options)
    equal: Any = np.testing.assert_equal
    (obs, infos), (own, told) = one.reset(), ours.reset()
    equal(own, obs)
    ended = 0
    for _ in range(60):
        actions = np.zeros(6, np.int64)
        *step, infos = one.step(actions)
        *mine, told = ours.step(actions)
        for theirs, here in zip(step, mine, strict=True):
            equal(here, theirs)
        for name in ("state", "satisfied", "lost", "progress", "distance", "labels"):
            equal(told["tltl"][name], infos["tltl"][name])
        ended += int((mine[2] | mine[3]).sum())
    assert ended > 30 and told["tltl"]["state"].shape == (6, 3)


def pole() -> Any:
    return gym.make("CartPole-v1")


@pytest.mark.parametrize("autoreset", [NEXT, SAME])
def test_all_ways_of_many_carts_are_one(autoreset: AutoresetMode) -> None:
    """SyncVectorEnv and AsyncVectorEnv of TaskEnv, TaskVectorEnv, and environments one by one.

    With NEXT_STEP, TaskVectorEnv steps a row that starts anew once in vain, which draws random numbers:
    its starts are others, so it is compared where nothing is drawn (`test_vector.py`).
    """
    task, columns = Task("(x < 0.03) T (v > 0.25) T (x < 0.03)"), {"x": 0, "v": 1}
    is_same_step = autoreset == SAME

    def wrapped() -> Any:
        return TaskEnv(pole(), task, columns=columns)

    count, seeds = 4, [3, 1, 4, 1]
    many: list[Any] = [
        SyncVectorEnv([wrapped] * count, autoreset_mode=autoreset),
        AsyncVectorEnv([wrapped] * count, autoreset_mode=autoreset),
    ]
    if is_same_step:
        base = SyncVectorEnv([pole] * count, autoreset_mode=AutoresetMode.DISABLED)
        many.append(TaskVectorEnv(base, task, columns=columns, autoreset_mode=autoreset))
    ones, done = [wrapped() for _ in range(count)], [False] * count
    alone = [env.reset(seed=seed)[0] for env, seed in zip(ones, seeds, strict=True)]
    for vector in many:
        assert np.array_equal(vector.reset(seed=seeds)[0], alone)
    rng, ended, paid = np.random.default_rng(2), 0, 0.0
    for _ in range(150):
        actions = rng.integers(0, 2, count)
        steps = [vector.step(actions) for vector in many]
        for i, env in enumerate(ones):
            if done[i] and not is_same_step:
                (alone[i], _), done[i] = env.reset(), False
                expected = (0.0, False, False)
            else:
                alone[i], reward, terminated, truncated, _ = env.step(int(actions[i]))
                done[i] = terminated or truncated
                expected = (reward, terminated, truncated)
                paid += abs(reward)
                ended += done[i]
            if done[i] and is_same_step:
                for *_, infos in steps:
                    assert np.array_equal(infos["final_obs"][i], alone[i])
                alone[i], _ = env.reset()
            for obs, rewards, terminated, truncated, _ in steps:
                assert np.array_equal(obs[i], alone[i])
                assert (rewards[i], terminated[i], truncated[i]) == expected
    many[1].close()
    assert ended > 10 and paid > 1.0


def test_what_is_refused_says_what_to_do() -> None:
    with pytest.raises(ValueError, match="AutoresetMode.DISABLED, or put TaskEnv inside"):
        TaskVectorEnv(SyncVectorEnv([lambda: Tape([0, 0])]), "F a", many)
    base = SyncVectorEnv([lambda: Tape([1, 1])] * 2, autoreset_mode=AutoresetMode.DISABLED)
    with pytest.raises(RuntimeError, match=r"100 starts were decided in rows \[0, 1\]"):
        TaskVectorEnv(base, "F a", many).reset()


@pytest.mark.parametrize("mode", MODES)
def test_relabelled_steps_are_steps_of_the_task(mode: str) -> None:
    task, rng = Task("F a && F b ensuring !c"), np.random.default_rng(2)
    n = 2_000
    rho = rng.normal(size=(n, 3))
    reward, terminated = rng.normal(size=n), rng.random(n) < 0.2
    rewards = Rewards(mode, environment=0.5, trap_penalty=1.0)
    seen = relabel(task, rho, rewards=rewards, reward=reward, terminated=terminated)
    live = [q for q in range(task.num_states) if q not in (task.accepting, task.trap)]
    rows = zip(seen.index, seen.q, seen.next_q, seen.reward, seen.terminated, strict=True)
    expected = iter((i, q) for i in range(n) for q in live)
    for (i, q, to, paid, over), pair in zip(rows, expected, strict=True):
        assert (i, q) == pair and to == task.step(int(q), rho[i])
        moved = task.progress_robustness(int(q), rho[i])
        alone = rewards.pay(
            task, int(q), int(to), rho=moved, reward=float(reward[i]), terminated=bool(terminated[i])
        )
        assert paid == alone
        assert over == (terminated[i] or to in (task.accepting, task.trap))
    drawn = relabel(task, rho, rewards=rewards, reward=reward, states=2, seed=7)
    again = relabel(task, rho, rewards=rewards, reward=reward, states=2, seed=7)
    assert drawn.index.tolist() == np.repeat(np.arange(n), 2).tolist()
    assert np.array_equal(drawn.q, again.q) and set(drawn.q) <= set(live)
    with pytest.raises(ValueError, match=r"wanted is \(n, 3\): a, b, c"):
        relabel(task, rho[:, :2], rewards=rewards)
    with pytest.warns(TaskWarning, match="always satisfied"):
        nothing = Task("true")
    empty = relabel(nothing, np.zeros((4, 0)), rewards=Rewards("acceptance"))
    assert empty.index.shape == (0,)
