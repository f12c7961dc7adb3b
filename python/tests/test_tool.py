"""The tool in the wheel, and what the package imports."""

from __future__ import annotations

import subprocess
import sys


def run(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, *arguments], capture_output=True, text=True, check=False)


def test_the_tool_is_there() -> None:
    version = run("-m", "tltl", "--version")
    assert version.returncode == 0 and version.stdout.startswith("tltlc ")
    told = run("-m", "tltl", "explain", "!c U a")
    assert told.returncode == 0 and "not c" in told.stdout
    mistaken = run("-m", "tltl", "explain", "G a")
    assert mistaken.returncode != 0 and "^" in mistaken.stderr + mistaken.stdout


def test_numpy_is_all_that_is_imported() -> None:
    code = (
        "import sys, tltl; tops = {name.split('.')[0] for name in sys.modules};"
        "print(sorted(tops & {'gymnasium', 'torch', 'stable_baselines3', 'ray', 'pandas'}))"
    )
    assert run("-c", code).stdout.strip() == "[]"
