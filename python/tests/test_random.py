"""Random formulas and random moves, against definitions that are written out here.

The definitions know no automaton that the package made beyond its table: what a formula means is read off
the trajectory, and what a move pays off a breadth-first search.
"""

from __future__ import annotations

import warnings
from collections import deque
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from test_gymnasium import MODES, Tape, abc

from tltl import CompileError, Rewards, Task, TaskWarning
from tltl._core import main
from tltl.gymnasium import TaskEnv
from tltl.replay import relabel

Formula = tuple[Any, ...]
NAMES = st.sampled_from("abc")
LITERALS: st.SearchStrategy[Formula] = st.one_of(
    st.tuples(st.just("is"), NAMES), st.tuples(st.just("not"), NAMES)
)


def grown(inner: st.SearchStrategy[Formula]) -> st.SearchStrategy[Formula]:
    bounds = st.tuples(st.integers(0, 2), st.integers(0, 2)).map(lambda b: (b[0], b[0] + b[1]))
    return st.one_of(
        st.tuples(st.sampled_from(["&&", "||", "U", "T"]), inner, inner),
        st.tuples(st.sampled_from(["X", "F"]), inner),
        st.tuples(st.sampled_from(["F in", "G in"]), bounds, inner),
        st.tuples(st.just("ensuring"), inner, LITERALS),
    )


FORMULAS = st.recursive(LITERALS, grown, max_leaves=6)


def text(formula: Formula) -> str:
    match formula:
        case ("is", name):
            return str(name)
        case ("not", name):
            return f"!{name}"
        case ("X" | "F" as operator, one):
            return f"{operator} ({text(one)})"
        case ("F in" | "G in" as operator, (low, high), one):
            return f"{operator[0]}[{low},{high}] ({text(one)})"
        case (operator, one, other):
            return f"(({text(one)}) {operator} ({text(other)}))"
    raise AssertionError(formula)


def holds(formula: Formula, walk: list[int], i: int) -> bool:
    """Whether the formula holds at instant i of a finite trajectory, whose states are letters of a, b, c."""
    end = len(walk)
    match formula:
        case ("is", name):
            return i < end and bool(walk[i] >> "abc".index(name) & 1)
        case ("not", name):
            return i < end and not walk[i] >> "abc".index(name) & 1
        case ("&&", one, other):
            return holds(one, walk, i) and holds(other, walk, i)
        case ("||", one, other):
            return holds(one, walk, i) or holds(other, walk, i)
        case ("X", one):
            return i + 1 < end and holds(one, walk, i + 1)
        case ("F", one):
            return any(holds(one, walk, j) for j in range(i, end))
        case ("U", one, other):
            return any(
                holds(other, walk, j) and all(holds(one, walk, k) for k in range(i, j))
                for j in range(i, end)
            )
        case ("T", one, other):
            return any(
                holds(one, walk, k) and any(holds(other, walk, j) for j in range(k + 1, end))
                for k in range(i, end)
            )
        case ("F in", (low, high), one):
            return any(j < end and holds(one, walk, j) for j in range(i + low, i + high + 1))
        case ("G in", (low, high), one):
            return all(j < end and holds(one, walk, j) for j in range(i + low, i + high + 1))
        case ("ensuring", one, other):
            # The first instant at which the states so far satisfy it.
            ends = (n for n in range(i, end) if holds(one, walk[: n + 1], i))
            first = next(ends, None)
            return first is not None and all(holds(other, walk, k) for k in range(i, first + 1))
    raise AssertionError(formula)


@settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(FORMULAS, st.lists(st.integers(0, 7), min_size=2, max_size=8))
def test_a_formula_means_the_same_everywhere(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], formula: Formula, walk: list[int]
) -> None:
    """`TaskEnv`, `Task.run` and `tltlc run` move through the same states, and are satisfied when the
    definition is."""
    source = text(formula)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TaskWarning)
        try:
            task = Task(source)
        except CompileError as error:
            assume("never" not in str(error))
            raise
        env = TaskEnv(Tape(walk), task, abc, terminate=False)
        rows = [[1.0 if letter >> i & 1 else -1.0 for i in range(3)] for letter in walk]
        run = task.run(np.array(rows), columns=["a", "b", "c"])
    met = [env.reset()[1]] + [env.step(0)[4] for _ in walk[1:]]
    assert [info["tltl"]["state"] for info in met] == run.states.tolist()
    expected = [holds(formula, walk[: n + 1], 0) for n in range(len(walk))]
    assert [info["tltl"]["satisfied"] for info in met] == expected
    # What is lost stays so, however it goes on.
    lost = [bool(info["tltl"]["lost"]) for info in met]
    assert lost == sorted(lost) and not (lost[-1] and expected[-1])
    path = tmp_path / "walk.csv"
    path.write_text("a,b,c\n" + "".join(",".join(map(str, row)) + "\n" for row in rows))
    assert main(["tltlc", "run", source, str(path), "--format", "csv"]) in (0, 1)
    header, *out = capfd.readouterr().out.splitlines()
    column = header.split(",").index("state")
    assert [int(line.split(",")[column]) for line in out[: len(walk)]] == run.states.tolist()


PAID = ["F a && F b && F c ensuring !d", "(a T b) || X X c", "F (a && X a && X X a)", "!d U (a && X (b || c))"]


def distances(task: Task) -> dict[int, int]:
    """The fewest moves to acceptance, by a search from there."""
    assert task.table is not None and task.accepting is not None
    found, left = {task.accepting: 0}, deque([task.accepting])
    while left:
        at = left.popleft()
        for q in range(task.num_states):
            if q not in found and at in task.table[q]:
                found[q] = found[at] + 1
                left.append(q)
    return found


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("formula", PAID)
def test_ten_thousand_moves_pay_what_is_written(formula: str, mode: str) -> None:
    """Stored steps, relabelled, against rewards written out for one move after the other."""
    task, rng = Task(formula), np.random.default_rng(11)
    over = {task.accepting, task.trap}
    live = [q for q in range(task.num_states) if q not in over]
    n = -(-10_000 // len(live))
    rewards = Rewards(
        mode, gamma=0.9, bound=0.75, trap_penalty=2.0, step_penalty=0.125, environment=0.5
    )
    # All robustness of a row has one size, so that of a guard has it too, whatever its form.
    size = rng.uniform(0.1, 1.5, n)
    truth = rng.random((n, len(task.propositions))) < 0.3
    rho = np.where(truth, 1.0, -1.0) * size[:, None]
    reward, ended = rng.normal(size=n), rng.random(n) < 0.1
    seen = relabel(task, rho, rewards=rewards, reward=reward, terminated=ended)
    assert task.table is not None
    letters = truth @ (1 << np.arange(truth.shape[1]))
    far = distances(task)
    farthest = max(far.values())

    def potential(q: int) -> float:
        return 0.0 if q in over or q not in far else 1.0 - far[q] / (farthest + 1)

    # The letters that move the automaton on; where all do, or none, the guard is a constant.
    on = {q: (task.table[q] != q) & (task.table[q] != task.trap) for q in live}
    constant = {q: np.inf for q in live if on[q].all()} | {q: -np.inf for q in live if not on[q].any()}
    expected, moves = [], [(i, q) for i in range(n) for q in live]
    for index, q in moves:
        to = int(task.table[q, letters[index]])
        is_lost, is_on = to == task.trap, on[q][letters[index]]
        guard = float(constant[q] if q in constant else size[index] if is_on else -size[index])
        after = 0.0 if ended[index] else potential(to)
        paid = {
            "acceptance": float(to == task.accepting),
            "progress": float(is_on),
            "literal": float(to != q),
            "robustness": min(max(guard, -0.75), 0.75),
            "shaped": float(to == task.accepting) + 0.9 * after - potential(q),
        }[mode]
        paid -= 0.125 + 2.0 * is_lost - 0.5 * reward[index]
        expected.append((to, paid, ended[index] or to in over))
    next_q, pays, ends = map(np.array, zip(*expected, strict=True))
    assert list(zip(seen.index.tolist(), seen.q.tolist(), strict=True)) == moves
    assert np.array_equal(seen.next_q, next_q) and np.array_equal(seen.terminated, ends)
    assert np.allclose(seen.reward, pays, rtol=0, atol=1e-12)
    assert len(pays) >= 10_000 and len(set(np.round(pays, 9))) > 100
