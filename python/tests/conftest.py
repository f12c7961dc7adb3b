"""Rows of the project's test data."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import gymnasium as gym
import pytest

#: What came with Gymnasium 1.1: a cliff that may be slippery, and vector environments that are asked how they
#: reset their rows.
since_1_1 = pytest.mark.skipif(
    "CliffWalking-v1" not in gym.registry, reason="it came with Gymnasium 1.1"
)

DATA = Path(__file__).parents[2] / "tests" / "data"


def rows(name: str) -> list[dict[str, Any]]:
    return [json.loads(line) for line in (DATA / name).read_text().splitlines() if line.strip()]
