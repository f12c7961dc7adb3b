"""What the package index shows runs."""

from __future__ import annotations

import re
from pathlib import Path


def test_the_examples_run() -> None:
    text = (Path(__file__).parents[1] / "README.md").read_text()
    names: dict[str, object] = {}
    examples = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    assert examples
    for example in examples:
        exec(example, names)
