"""Task files."""

from __future__ import annotations

import os
from pathlib import Path

from tltl._core import Budget, TaskFile


def load(path: str | os.PathLike[str], *, budget: Budget | None = None) -> TaskFile:
    """Compiles a task file.

    Raises `CompileError` if there is a mistake in it, and `OSError` if it cannot be read.
    """
    text = Path(path).read_text(encoding="utf-8")
    return TaskFile.from_text(text, name=os.fspath(path), budget=budget)
