"""Audits: the records and the table of the command."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pandas
import polars
import pytest
from conftest import ROOT, command, records

import frictcomp

ORDER = ["probe.nc", "pocket.nc", "bore.nc", "probe.nc"]


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


def test_a_sequence_is_that_of_the_command(tmp_path: Path) -> None:
    # R13.13
    programs = [str(ROOT / "programs/demo/order" / name) for name in ORDER]
    order = tmp_path / "order.txt"
    order.write_text("\n".join(programs))
    sequence = frictcomp.audit_sequence(iter(programs))
    options = ["audit", "--sequence", str(order)]
    assert sequence.records == records(*options, "--format", "ndjson")
    assert str(sequence) == command(*options, "--width", "1000").stdout
    assert sequence.has_warnings
    table = polars.DataFrame(sequence)
    assert table.columns == sequence.columns and table.height == len(sequence)
    inherited = table.filter(polars.col("left_by").is_not_null())
    assert inherited.select("position", "axis", "left_by").rows() == [(2, "X", programs[0])]
    # A program that is given twice runs twice.
    assert table["position"].unique().to_list() == [1, 2, 3, 4]


def test_a_program_of_a_sequence_that_cannot_be_read_is_an_error() -> None:
    with pytest.raises(frictcomp.Error) as caught:
        frictcomp.audit_sequence(["programs/demo/order/probe.nc", "none.nc"])
    assert caught.value.file == "none.nc"
