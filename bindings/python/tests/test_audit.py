"""Audits: the records and the table of the command."""

from __future__ import annotations

import csv
import io

import pandas
import polars
import pytest
from conftest import command, records

import frictcomp


@pytest.mark.parametrize("folder", ["programs/demo/order", "programs/ok", "programs/demo"])
@pytest.mark.parametrize("kinds", ["FRICT", "all"])
def test_an_audit_is_that_of_the_command(folder: str, kinds: str) -> None:
    audit = frictcomp.audit(folder, kinds=kinds)
    options = ["--kinds", kinds, folder]
    assert audit.records == records("audit", "--format", "ndjson", *options)
    told = list(csv.reader(io.StringIO(command("audit", "--format", "csv", *options).stdout)))
    assert audit.columns == told[0]
    table = polars.DataFrame(audit)
    rows = [["" if it is None else str(it) for it in row] for row in table.rows()]
    assert rows == told[1:]
    assert len(pandas.DataFrame.from_arrow(audit)) == len(audit)
    (summary,) = [it for it in audit.records if it["record"] == "summary"]
    assert (audit.programs, audit.hazards) == (summary["programs"], summary["hazards"])
    assert audit.has_warnings == (command("audit", "--fail-on", "warning", *options).returncode == 1)
