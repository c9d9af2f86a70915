"""The examples of the manual are run, one after the other."""

from __future__ import annotations

import doctest
import re

from conftest import ROOT


def test_the_examples_of_the_manual_are_as_printed() -> None:
    path = ROOT / "docs/python.md"
    text = path.read_text("utf-8")
    # A fence ends the output before it; lines stay where they are.
    examples = re.sub(r"^```.*$", "", text, flags=re.MULTILINE)
    parsed = doctest.DocTestParser().get_doctest(examples, {}, path.name, str(path), 0)
    assert len(parsed.examples) > 20
    told: list[str] = []
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    runner.run(parsed, out=told.append)
    assert runner.failures == 0, "".join(told)
