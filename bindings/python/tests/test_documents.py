"""The docstrings of the stubs equal those at run time."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from pathlib import Path

import frictcomp
from frictcomp import _engine

STUBS = Path(frictcomp.__file__).with_name("_engine.pyi")


def documented() -> Iterator[tuple[str, str]]:
    """The names in the stubs that have a docstring, with it."""
    for node in ast.parse(STUBS.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef):
            yield node.name, ast.get_docstring(node) or ""
            members = [it for it in node.body if isinstance(it, ast.FunctionDef)]
            yield from ((f"{node.name}.{it.name}", ast.get_docstring(it) or "") for it in members)
        elif isinstance(node, ast.FunctionDef):
            yield node.name, ast.get_docstring(node) or ""


def test_the_stubs_and_the_module_say_the_same() -> None:
    # R13.13
    count = 0
    for name, text in documented():
        said: object = _engine
        for part in name.split("."):
            said = getattr(said, part)
        # Methods that the language defines, such as `len`, have the docstrings of the language.
        if text and not name.rsplit(".", 1)[-1].startswith("__"):
            assert inspect.getdoc(said) == text, name
            count += 1
    assert count >= 80
