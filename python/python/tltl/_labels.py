"""Label functions that say which names they may give."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import wraps
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: What holds in a state: by name, as truth values or robustness; the names of what holds; or an
#: array in the order of `Task.propositions`.
Labels = (
    Mapping[str, bool | float | np.bool_ | np.number[Any]]
    | Collection[str]
    | Sequence[bool | float]
    | NDArray[Any]
)


def labels(*names: str) -> Callable[[Callable[..., Collection[str]]], Callable[..., dict[str, bool]]]:
    """Declares the names that a label function may give, which then gives a set of those that hold.

    Without it a name that is misspelt would not hold for ever, and nobody would notice.

    >>> from tltl import labels
    >>> @labels("key", "door")
    ... def seen(obs):
    ...     return {"key"} if obs == 3 else set()
    >>> seen(3)
    {'key': True, 'door': False}
    """

    def decorate(function: Callable[..., Collection[str]]) -> Callable[..., dict[str, bool]]:
        @wraps(function)
        def named(*args: Any, **kwargs: Any) -> dict[str, bool]:
            given = function(*args, **kwargs)
            for name in given:
                if name not in names:
                    raise ValueError(
                        f"the label function gave {name!r}; it declares {', '.join(names)}"
                    )
            return {name: name in given for name in names}

        return named

    return decorate
