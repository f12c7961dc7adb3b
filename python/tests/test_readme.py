"""What the package index shows runs, each example as it is printed."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

TEXT = (Path(__file__).parents[1] / "README.md").read_text(encoding="utf-8")
EXAMPLES = re.findall(r"^## ([^\n]+)|```python\n(.*?)```", TEXT, re.DOTALL | re.MULTILINE)


def examples() -> list[tuple[str, str]]:
    """Each example, called by the heading that it stands under."""
    heading, found = "", []
    for title, code in EXAMPLES:
        heading = title or heading
        if code:
            found.append((heading, code))
    return found


@pytest.mark.parametrize(
    "code", [code for _, code in examples()], ids=[title for title, _ in examples()]
)
def test_an_example_runs(
    code: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    if "stable_baselines3" in code:
        pytest.importorskip("stable_baselines3")
    exec(compile(code, "README.md", "exec"), {})
    printed = capsys.readouterr().out
    if "# True, in 8 steps" in code:
        assert printed == "True\n"
    for promised in re.findall(r"P\(satisfied\) ([\d.]+)|no policy has more than ([\d.]+)", code):
        assert "".join(promised) in printed


def test_there_are_examples() -> None:
    assert len(examples()) >= 7
