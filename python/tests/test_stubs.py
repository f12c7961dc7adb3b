"""The stubs say what the extension says: editors show the documentation of its classes and functions.

`UPDATE_STUBS=1 pytest tests/test_stubs.py` writes it into the stubs.
"""

from __future__ import annotations

import ast
import inspect
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import tltl
from tltl import _core

STUBS = Path(tltl.__file__).with_name("_core.pyi")
Definition = ast.ClassDef | ast.FunctionDef


def definitions(text: str) -> Iterator[tuple[Definition, Any]]:
    """Each class, function, method and property of the stubs, with what it is in the extension.

    Of overloads the first; special methods have the documentation of Python.
    """
    for node in ast.parse(text).body:
        if isinstance(node, Definition):
            own = getattr(_core, node.name)
            yield node, own
            seen: set[str] = set()
            for member in node.body if isinstance(node, ast.ClassDef) else ():
                if isinstance(member, ast.FunctionDef) and not member.name.startswith("__"):
                    if member.name not in seen:
                        thing = inspect.getattr_static(own, member.name)
                        # The documentation is that of the function, not of what makes it static.
                        is_static = isinstance(thing, staticmethod | classmethod)
                        yield member, getattr(own, member.name) if is_static else thing
                    seen.add(member.name)


def documentation(thing: Any) -> str | None:
    return inspect.cleandoc(thing.__doc__) if thing.__doc__ else None


def written(text: str) -> str:
    """The stubs with the documentation of the extension."""
    lines = text.splitlines()
    for node, thing in reversed(list(definitions(text))):
        doc, body = documentation(thing), node.body
        if doc is None:
            continue
        margin = " " * (node.col_offset + 4)
        end = "\n" if "\n" in doc else ""
        quoted = f'''{"r" if chr(92) in doc else ""}"""{doc}{end}"""'''.splitlines()
        new = [margin + line if line else "" for line in quoted]
        start, stop = body[0].lineno - 1, body[0].end_lineno
        if ast.get_docstring(node) is not None:
            lines[start:stop] = new
        elif isinstance(body[0], ast.Expr):
            # `...`, behind the signature or on a line of its own.
            before = lines[start].rstrip().removesuffix("...").rstrip()
            lines[start:stop] = [*filter(None, [before]), *new]
        else:
            decorators = getattr(body[0], "decorator_list", [])
            place = min([body[0].lineno, *(one.lineno for one in decorators)])
            lines[place - 1 : place - 1] = new
    return "\n".join(lines) + "\n"


def test_the_stubs_have_the_documentation_of_the_extension() -> None:
    text = STUBS.read_text(encoding="utf-8")
    if os.environ.get("UPDATE_STUBS"):
        text = written(text)
        STUBS.write_text(text, encoding="utf-8")
    found = [(node, documentation(thing)) for node, thing in definitions(text)]
    assert len(found) > 150
    assert [node.name for node, doc in found if ast.get_docstring(node) != doc] == []


@pytest.mark.parametrize("name", sorted(set(_core.__all__) - {"__version__"}))
def test_all_that_is_public_is_documented(name: str) -> None:
    thing = getattr(_core, name)
    members = vars(thing).items() if isinstance(thing, type) else ()
    public = [(name, member) for name, member in members if not name.startswith("_")]
    assert documentation(thing)
    assert [name for name, member in public if not documentation(member)] == []
