"""What a task means is written once, in the crates: Python holds no arithmetic on automaton states."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

import tltl

PACKAGE = Path(tltl.__file__).parent
STATE = re.compile(r"(^|[._])(q|next_q|_q|state|task_state|before)$")
ARITHMETIC = ast.Add | ast.Sub | ast.Mult | ast.Div | ast.FloorDiv | ast.Mod | ast.Pow | ast.MatMult
ORDER = ast.Lt | ast.LtE | ast.Gt | ast.GtE


def is_state(node: ast.expr) -> bool:
    return isinstance(node, ast.Name | ast.Attribute) and bool(STATE.search(ast.unparse(node)))


def offences(source: str) -> list[str]:
    """Arithmetic on automaton states, and their order: what a move means would be decided here."""
    found = []
    for node in ast.walk(ast.parse(source)):
        operands: list[ast.expr] = []
        if isinstance(node, ast.BinOp) and isinstance(node.op, ARITHMETIC):
            operands = [node.left, node.right]
        elif isinstance(node, ast.AugAssign):
            operands = [node.target]
        elif isinstance(node, ast.Compare) and any(isinstance(op, ORDER) for op in node.ops):
            operands = [node.left, *node.comparators]
        if any(map(is_state, operands)):
            found.append(ast.unparse(node))
    return found


@pytest.mark.parametrize("path", sorted(PACKAGE.glob("*.py")), ids=lambda path: path.name)
def test_no_arithmetic_on_automaton_states(path: Path) -> None:
    source = path.read_text(encoding="utf-8")
    assert offences(source) == []
    # Potentials and payments are the runtime's.
    assert not re.search(r"gamma\s*\*|\*\s*\w*\.?gamma|distances?\[[^]]*\]\s*[-+*]", source)


def test_arithmetic_would_be_found() -> None:
    for line in ("self._q + 1", "q * n", "next_q - q", "told.state // 2", "q < accepting"):
        assert offences(line) == [line]
    assert offences("q == accepting\nn + 1") == []

