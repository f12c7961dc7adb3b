"""Mistakes and warnings of a source."""

from __future__ import annotations

from dataclasses import dataclass

Span = tuple[int, int]


@dataclass(frozen=True)
class Diagnostic:
    """A mistake or a warning, as data.

    Spans are (first, one past the last) in characters of the source; `line` and `column` count from
    1.
    """

    kind: str
    severity: str
    message: str
    span: Span
    line: int
    column: int
    label: str
    related: tuple[tuple[Span, str], ...]
    help: tuple[str, ...]


class CompileError(ValueError):
    """A source with mistakes: its text underlines each of them.

    >>> from tltl import CompileError, Task
    >>> try:
    ...     Task("F near && G far")
    ... except CompileError as error:
    ...     first = error.diagnostics[0]
    >>> first.kind, first.span, first.column
    ('unsupported-operator', (10, 11), 11)
    """

    def __init__(self, text: str, diagnostics: tuple[Diagnostic, ...]) -> None:
        super().__init__(text, diagnostics)
        self.diagnostics = diagnostics

    def __str__(self) -> str:
        return str(self.args[0])


class TaskWarning(UserWarning):
    """What compiles, and is hardly meant."""
