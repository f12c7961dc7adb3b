"""Finite models out of Gymnasium's tables."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tltl._core import FiniteModel

#: An outcome: probability, next state, reward, whether the episode is over there.
Outcome = tuple[float, int, float, bool]
Table = Mapping[int, Mapping[int, Sequence[Outcome]]]
#: What happens on the way: of state, action, next state and reward.
EventFn = Callable[[int, int, int, float], Hashable]


def of_transitions(
    transitions: Table,
    *,
    starts: ArrayLike | None = None,
    events: EventFn | None = None,
    horizon: int | None = None,
) -> FiniteModel:
    """See `FiniteModel.from_transitions`."""
    states, actions = len(transitions), len(transitions[0])
    # Without an event each state is itself; those with one come behind, as they are met.
    number: dict[tuple[int, Hashable], int] = {(s, None): s for s in range(states)}
    pairs = list(number)
    indptr, indices, probabilities, ends = [0], [], [], []
    for s, _ in pairs:
        for a in range(actions):
            for p, to, reward, done in transitions[s][a]:
                pair = (int(to), events(s, a, int(to), float(reward)) if events else None)
                if pair not in number:
                    number[pair] = len(pairs)
                    pairs.append(pair)
                indices.append(number[pair])
                probabilities.append(float(p))
                ends.append(bool(done))
            indptr.append(len(indices))
    if starts is not None:
        given = np.asarray(starts, float)
        starts = np.concatenate([given, np.zeros(len(pairs) - states)])
    elif events is not None:
        starts = [1.0] * states + [0.0] * (len(pairs) - states)
    return FiniteModel.from_arrays(
        indptr,
        indices,
        probabilities,
        actions=actions,
        ends=ends,
        starts=starts,
        horizon=horizon,
        origin=[s for s, _ in pairs],
        event=tuple(event for _, event in pairs) if events else None,
    )


def of_env(env: Any, *, events: EventFn | None = None) -> FiniteModel:
    """See `FiniteModel.from_env`."""
    world = env.unwrapped
    if not hasattr(world, "P"):
        raise ValueError(f"{env} has no table of transitions, `env.unwrapped.P`")
    spec = env.spec
    return of_transitions(
        world.P,
        starts=getattr(world, "initial_state_distrib", None),
        events=events,
        horizon=None if spec is None else spec.max_episode_steps,
    )
