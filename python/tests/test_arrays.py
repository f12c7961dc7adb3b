"""Arrays of every type and layout mean the same; what is none is refused in words."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tltl import Task

LAYOUTS: dict[str, Callable[[Any], Any]] = {
    "C": np.ascontiguousarray,
    "F": np.asfortranarray,
    "sliced": lambda a: np.repeat(a, 2, axis=-1)[..., ::2],
    "rows apart": lambda a: np.repeat(a, 3, axis=0)[::3],
    "backwards": lambda a: np.ascontiguousarray(a[::-1])[::-1],
    "columns backwards": lambda a: np.ascontiguousarray(a[..., ::-1])[..., ::-1],
    "big-endian": lambda a: a.astype(a.dtype.newbyteorder(">")),
    "list": lambda a: a.tolist(),
    "read-only": lambda a: np.frombuffer(a.tobytes(), a.dtype).reshape(a.shape),
    "object view": lambda a: np.stack([a, a])[1],
}


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dtype", ["f8", "f4", "f2", "i8", "i4", "i2", "i1"])
def test_states_of_all_layouts(layout: str, dtype: str) -> None:
    task = Task("F (x > 1 && y < 2) && F z > 0")
    numbers = np.random.default_rng(7).integers(-4, 5, size=(4, 6, 3)).astype(dtype)
    array = LAYOUTS[layout](numbers)
    x, y, z = numbers[..., 0], numbers[..., 1], numbers[..., 2]
    assert task.propositions == ("x > 1", "y < 2", "z > 0")
    expected = np.stack([x > 1, y < 2, z > 0], axis=-1)
    assert np.array_equal(task.labels(array), expected)
    rho = np.stack([x.astype("f8") - 1, 2 - y.astype("f8"), z.astype("f8")], axis=-1)
    assert np.array_equal(task.rho(array), rho)
    assert np.array_equal(task.letters(array), expected @ np.array([1, 2, 4]))
    # F (p && q) && F r, by its definition.
    most = np.minimum(np.minimum(rho[..., 0], rho[..., 1]).max(-1), rho[..., 2].max(-1))
    assert np.array_equal(task.robustness(array), most)
    one = LAYOUTS[layout](numbers[0])
    assert task.robustness(one) == most[0] and isinstance(task.robustness(one), float)
    assert np.array_equal(task.labels(numbers[0, 0]), expected[0, 0])
    by_name = {"z": LAYOUTS["C"](z), "x": LAYOUTS["F"](x), "y": y, "more": None}
    assert np.array_equal(task.labels(by_name), expected)
    ragged = [numbers[0], numbers[1][:3]]
    each: Any = task.robustness(ragged)
    assert each[0] == most[0]
    holds = (expected[..., 0] & expected[..., 1]).any(-1) & expected[..., 2].any(-1)
    assert np.array_equal(task.satisfied(array), holds)


def test_columns_say_where_they_are() -> None:
    task = Task("F (x > 1 && y < 2)")
    array = np.array([[0.0, 5.0, 3.0]])
    expected = [[True, True]]
    assert task.labels(array, columns={"x": 1, "y": 0}).tolist() == expected
    assert task.labels(array, columns=["y", "x", "z"]).tolist() == expected
    with pytest.raises(ValueError, match="3 columns, and the task reads 2"):
        task.labels(array)
    with pytest.raises(ValueError, match="`y` is missing; given: w, x"):
        task.labels(array, columns={"x": 1, "w": 0})
    with pytest.raises(ValueError, match="`y` is column 7 of 3"):
        task.labels(array, columns={"x": 1, "y": 7})
    with pytest.raises(ValueError, match="2 names for 3 columns"):
        task.labels(array, columns=["x", "y"])
    with pytest.raises(ValueError, match=r"`x > 1` is not a number \(NaN\) in row 1"):
        task.labels(np.array([[0.0, 1.0], [np.nan, 1.0]]))
    with pytest.raises(ValueError, match="different shapes"):
        task.labels({"x": np.zeros(3), "y": np.zeros(4)})


@pytest.mark.parametrize("layout", [name for name in LAYOUTS if name != "object view"])
@pytest.mark.parametrize("dtype", ["?", "i1", "u8", "f4", "f8"])
def test_labels_of_all_layouts(layout: str, dtype: str) -> None:
    task = Task("(a T b) && F c")
    assert task.table is not None
    rng = np.random.default_rng(3)
    labels = rng.integers(0, 2, size=(50, 3)).astype(dtype)
    q = rng.integers(0, task.num_states, size=50)
    letters = (labels.astype(np.uint64) @ np.array([1, 2, 4], dtype=np.uint64)).astype(np.uint64)
    expected = task.table[q, letters]
    assert np.array_equal(task.step_batch(LAYOUTS[layout](q), LAYOUTS[layout](labels)), expected)
    assert np.array_equal(task.step_batch(q.astype("u1"), letters[::-1].copy()[::-1]), expected)
    out = q.astype(np.uint32)
    assert task.step_batch(out, labels, out=out) is out
    assert np.array_equal(out, expected), "in place"
    apart = np.zeros(100, dtype=np.uint32)[::2]
    task.step_batch(q, labels, out=apart)
    assert np.array_equal(apart, expected)
    both = np.append(q, 0).astype(np.uint32)
    task.step_batch(both[:-1], labels, out=both[1:])
    assert np.array_equal(both[1:], expected), "what is read and written overlaps"


def test_nothing_is_an_array_too() -> None:
    task = Task("F a")
    assert task.step_batch(np.zeros(0, int), np.zeros((0, 1), bool)).shape == (0,)
    assert task.labels(np.zeros((0, 1))).shape == (0, 1)
    assert task.robustness(np.zeros((0, 1))) == -np.inf
    none: Any = task.robustness(np.zeros((0, 5, 1)))
    assert none.shape == (0,)
    nothing = Task.__new__(Task, "X true")
    assert nothing.labels(np.zeros((4, 0))).shape == (4, 0)
    assert nothing.satisfied(np.zeros((2, 0))) is True


HOSTILE = [
    None, "a", b"a", 1, -1, 1.5, 1j, object(), [], {}, set(), [[]], ["a"], [None], {1: 2}, {"a": None},
    {"a": "x"}, {"a"}, float("nan"), 2**70, [2**70], np.zeros(3), np.zeros((2, 2)), np.zeros((1, 1, 1, 1)),
    np.array(["a"]), np.array([None]), np.zeros(2, complex), np.ma.masked_array([1.0], [True]),
    np.full((1, 1), np.inf), np.zeros(1, "M8[s]"), np.full(1, 99), np.array(1), range(3), lambda: 0,
    np.zeros(2, dtype=[("x", "f8")]), np.broadcast_to(1.0, (3, 1)), np.uint64(2**63), memoryview(b"ab"),
]


@settings(max_examples=400, deadline=None)
@given(st.sampled_from(HOSTILE), st.sampled_from(HOSTILE), st.sampled_from(HOSTILE))
def test_hostile_values_raise_ordinary_exceptions(one: Any, two: Any, three: Any) -> None:
    task = Task("a U b")
    calls: list[Callable[[], Any]] = [
        lambda: Task(one),
        lambda: Task("F a", budget=one),
        lambda: task.step(one, two),
        lambda: task.step_batch(one, two),
        lambda: task.step_batch(one, two, out=three),
        lambda: task.labels(one, columns=two),
        lambda: task.rho(one),
        lambda: task.letters(one),
        lambda: task.robustness(one, columns=two),
        lambda: task.satisfied(one),
        lambda: task.run(one, columns=two),
        lambda: task.monitor().observe(one),
        lambda: task.diff(one),
        lambda: task & one,
        lambda: task == one,
    ]
    for call in calls:
        try:
            call()
        except Exception:
            pass
