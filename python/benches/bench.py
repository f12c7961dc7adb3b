"""Speed as ratios: medians in one run, and every row asserts its answer first.

CPU time of the thread, which others on the machine hardly change; two threads are timed by the clock.

    python benches/bench.py

Build the package with `maturin develop --release` before.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from statistics import median
from typing import Any

import gymnasium as gym
import numpy as np

from tltl import FiniteModel, Learner, Rewards, Task
from tltl.gymnasium import TaskEnv
from tltl.replay import relabel
from tltl.vector import TaskVectorEnv

RNG = np.random.default_rng(1)


def seconds(
    run: Callable[[], Any],
    rounds: int = 15,
    least: float = 0.01,
    clock: Callable[[], float] = time.thread_time,
) -> float:
    """The median time of a call, over rounds of at least so many seconds each."""
    times = 1
    while True:
        start = clock()
        for _ in range(times):
            run()
        taken = clock() - start
        if taken >= least:
            break
        times = max(times + 1, int(times * least / max(taken, 1e-9)))
    found = []
    for _ in range(rounds):
        start = clock()
        for _ in range(times):
            run()
        found.append((clock() - start) / times)
    return median(found)


def told(row: str, figure: str) -> None:
    print(f"{row:<58} {figure}", flush=True)


def table_automata() -> float:
    """`step_batch` against NumPy's look-up; the rate of 1,000 letters, in states a second."""
    task = Task("F a && F b ensuring !c")
    assert task.table is not None
    rates: list[float] = []
    for n in (1_000, 100_000):
        q = RNG.integers(0, task.num_states, n).astype(np.uint32)
        letters = RNG.integers(0, 8, n).astype(np.uint64)
        rows = (letters[:, None] >> np.arange(3, dtype=np.uint64) & 1).astype(bool)
        table, out = task.table, np.empty_like(q)
        expected = table[q, letters]
        assert np.array_equal(task.step_batch(q, letters, out=out), expected)
        assert np.array_equal(task.step_batch(q, rows), expected)
        ours = seconds(lambda: task.step_batch(q, letters, out=out))
        numpy = seconds(lambda: table[q, letters])
        by_row = seconds(lambda: task.step_batch(q, rows, out=out))
        told(f"step_batch, letters, n = {n}", f"{numpy / ours:.2f} times NumPy's look-up ({ours * 1e6:.1f} us)")
        told(f"step_batch, rows of bool, n = {n}", f"{ours / by_row:.2f} of letters")
        rates.append(n / ours)
    return rates[0]


def diagrams(rate: float) -> None:
    for formula in (
        " && ".join(f"F p{i}" for i in range(4)) + " && F (" + " && ".join(f"p{i}" for i in range(4, 16)) + ")",
        " T ".join(f"p{i}" for i in range(16)),
    ):
        task, n = Task(formula), 1_000
        q = RNG.integers(0, task.num_states, n).astype(np.uint32)
        letters = RNG.integers(0, 1 << 16, n).astype(np.uint64)
        assert task.table is not None
        out = np.empty_like(q)
        assert np.array_equal(task.step_batch(q, letters, out=out), task.table[q, letters])
        ours = n / seconds(lambda: task.step_batch(q, letters, out=out))
        told(f"step_batch, {task.num_states} states, 16 propositions", f"{ours / rate:.2f} of the table's rate")


def columns() -> None:
    task = Task("(x < 0.3 && y > 0.1) T (x > 0.5 U y < 0.2) && F x + y > 1")
    states = RNG.random((100, 1_000, 2))
    loop = [task.robustness(one) for one in states[:3]]
    assert np.array_equal(np.asarray(task.robustness(states))[:3], loop)
    for dtype in (np.float64, np.float32):
        given = states.astype(dtype)
        apart = {name: np.ascontiguousarray(given[..., i]) for i, name in enumerate("xy")}
        each = seconds(lambda: task.robustness(given)) / 1e5
        # What Rust is given then are columns without gaps.
        alone = seconds(lambda: task.robustness(apart)) / 1e5
        told(
            f"robustness of (100, 1000, 2) {np.dtype(dtype)}",
            f"{each * 1e9:.0f} ns a state, {each / alone:.2f} times that of columns",
        )
    flat = states.reshape(-1, 2)
    by_row = seconds(lambda: [task.labels(row) for row in flat[:100]]) / 100
    by_column = seconds(lambda: task.labels(flat)) / len(flat)
    told("labels of 100,000 rows in one call", f"{by_row / by_column:.0f} times row by row ({by_column * 1e9:.0f} ns a state)")


class Still(gym.Env[Any, Any]):
    """An environment that costs nothing."""

    observation_space: Any = gym.spaces.Box(-1, 1, (4,), np.float32)
    action_space: Any = gym.spaces.Discrete(2)
    seen = np.zeros(4, np.float32)

    def reset(self, **_: Any) -> Any:
        return self.seen, {}

    def step(self, action: Any) -> Any:
        return self.seen, 0.0, False, False, {}


def wrappers() -> None:
    holds = np.zeros(2, bool)
    forms: dict[str, Any] = {"arrays": lambda *_: holds, "mappings": lambda *_: {"a": False, "b": False}}
    bare = seconds(partial(Still().step, 0))
    for form, labels in forms.items():
        for observe in ("none", "dict", "flat"):
            options: dict[str, Any] = {"observe": observe}
            env = TaskEnv(Still(), "a T b", labels, **options)
            env.reset()
            more = seconds(partial(env.step, 0)) - bare
            told(f"TaskEnv.step, labels as {form}, observe={observe!r}", f"{more * 1e6:.1f} us over the bare one")


def vectors() -> None:
    from gymnasium.vector import AutoresetMode, SyncVectorEnv

    def carts() -> Any:
        makes = [lambda: gym.make("CartPole-v1")] * 1_000
        return SyncVectorEnv(makes, autoreset_mode=AutoresetMode.DISABLED)

    base, task = carts(), "(x > 2) T (x < -2)"
    envs = TaskVectorEnv(carts(), task, columns={"x": 0}, autoreset_mode=AutoresetMode.SAME_STEP)
    actions = np.arange(1_000) % 2
    envs.reset(seed=1)
    base.reset(seed=1)
    for _ in range(5):
        assert np.array_equal(envs.step(actions)[0][:, :4], base.step(actions)[0])
    # A few steps from the start, where no cart has fallen: what is compared is the same.
    def run(many: Any) -> float:
        found = []
        for _ in range(5):
            many.reset(seed=1)
            start = time.thread_time()
            for _ in range(6):
                many.step(actions)
            found.append(time.thread_time() - start)
        return median(found)

    told("TaskVectorEnv, 1,000 CartPoles in SyncVectorEnv", f"{run(envs) / run(base):.2f} times the bare one")


def scalars() -> None:
    task, row = Task("F a && F b ensuring !c"), np.array([True, False, False])
    assert task.step(0, row) == task.step(0, {"a": True, "b": False, "c": False})
    told("step, an array of labels", f"{seconds(lambda: task.step(0, row)) * 1e9:.0f} ns")
    mapping = {"a": True, "b": False, "c": False}
    told("step, a mapping", f"{seconds(lambda: task.step(0, mapping)) * 1e9:.0f} ns")


def threads() -> None:
    task = Task("(x < 0.3 && y > 0.1) T (x > 0.5 U y < 0.2)")
    states = RNG.random((200, 2_000, 2))
    with ThreadPoolExecutor(2) as pool:
        one = seconds(lambda: [task.robustness(states) for _ in range(2)], 5, clock=time.perf_counter)
        two = seconds(lambda: list(pool.map(task.robustness, [states] * 2)), 5, clock=time.perf_counter)
    told("two threads on one task", f"{one / two:.2f} times one thread")


def replay() -> None:
    task = Task("F a && F b && F c")
    labels = RNG.random((1_000_000, 3)) < 0.2
    rewards = Rewards("shaped")
    seen = relabel(task, labels[:1_000], rewards=rewards)
    assert np.array_equal(seen.next_q, task.step_batch(seen.q, labels[seen.index]))
    taken = seconds(lambda: relabel(task, labels, rewards=rewards), rounds=3)
    live = task.num_states - 1
    told(f"relabel of 1,000,000 steps by {live} states", f"{taken:.2f} s")


def learning() -> None:
    model = FiniteModel.from_env(gym.make(max(name for name in gym.registry if name.startswith("Taxi-"))))
    labels: Any = lambda s: {"aboard": s // 4 % 5 == 4, "home": s // 4 % 5 == s % 4}  # noqa: E731
    learner = Learner(model, "aboard T home", labels, seed=1).train(1_000_000)
    start, before = time.thread_time(), learner.steps
    learner.train(6_000_000)
    told("Learner on Taxi", f"{(time.thread_time() - start) / (learner.steps - before) * 1e9:.0f} ns a step")


def main() -> None:
    warnings.simplefilter("ignore")
    diagrams(table_automata())
    columns()
    wrappers()
    vectors()
    scalars()
    threads()
    replay()
    learning()


if __name__ == "__main__":
    main()
