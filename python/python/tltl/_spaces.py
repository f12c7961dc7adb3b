"""Spaces of Gymnasium whose elements can be numbered."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from gymnasium import spaces  # isort: skip

#: How many elements there are, the number of each, and the element of a number.
Numbered = tuple[int, Callable[[Any], int], Callable[[int], Any]]


def numbered(space: spaces.Space[Any]) -> Numbered:
    """Numbers the elements of a space from 0, the last axis fastest.

    Raises `ValueError` if they cannot be numbered.
    """
    if isinstance(space, spaces.Discrete):
        start = int(space.start)
        return int(space.n), lambda x: int(x) - start, lambda i: i + start
    if isinstance(space, spaces.MultiDiscrete):
        return mixed(space.nvec, space.start, space.dtype)
    if isinstance(space, spaces.MultiBinary):
        return mixed(np.full(space.shape, 2), 0, space.dtype)
    if isinstance(space, spaces.Tuple):
        return joined([numbered(part) for part in space])
    raise ValueError(
        f"the elements of {space} cannot be numbered: a table needs Discrete, MultiDiscrete, "
        "MultiBinary or a Tuple of them"
    )


def mixed(sizes: Any, start: Any, dtype: Any) -> Numbered:
    """Arrays of digits, each with a size of its own."""
    shape, sizes = sizes.shape, tuple(map(int, sizes.ravel()))
    count = int(np.prod(sizes, dtype=object))

    def number(x: Any) -> int:
        digits = (np.asarray(x) - start).ravel()
        return int(np.ravel_multi_index(tuple(digits), sizes))

    def element(i: int) -> Any:
        return (np.reshape(np.unravel_index(i, sizes), shape) + start).astype(dtype)

    return count, number, element


def joined(parts: list[Numbered]) -> Numbered:
    """Tuples of numbered elements."""
    count, number, element = mixed(np.array([count for count, _, _ in parts]), 0, np.int64)

    def number_of(x: Any) -> int:
        return number([of(part) for (_, of, _), part in zip(parts, x, strict=True)])

    def element_of(i: int) -> Any:
        places = element(i)
        return tuple(at(int(place)) for (_, _, at), place in zip(parts, places, strict=True))

    return count, number_of, element_of
