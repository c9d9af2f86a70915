"""Currents as arrays: the numbers of the command."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import numpy
import pytest
from conftest import command

import frictcomp

REVERSAL = "programs/demo/current/reversal.nc"


def test_arrays_are_the_columns_of_the_command() -> None:
    currents = frictcomp.current(REVERSAL, ["X"])
    assert currents.axes == ["X"] and len(currents) > 50
    x = currents["X"]
    told = command("current", REVERSAL, "--axis", "X", "--columns", "comp,line")
    rows = list(csv.DictReader(io.StringIO(told.stdout)))
    assert len(rows) == len(currents)
    columns: dict[str, Any] = {"t": currents.t, "line": currents.line}
    for name in ["x", "v", "w_before", "w_after", "current", "output"]:
        columns[name] = getattr(x, name)
    for name, values in columns.items():
        assert values.shape == (len(rows),)
        assert numpy.array_equal(values, [float(row[name]) for row in rows]), name
    assert list(x.comp) == [row["comp"] for row in rows]
    assert x.unknown_cycles == 0
    assert numpy.array_equal(x.filled(numpy.nan), x.current)
    with pytest.raises(KeyError):
        currents["Q"]


def test_a_current_that_is_not_known_is_not_given() -> None:
    text = Path(REVERSAL).read_text("utf-8").splitlines(keepends=True)
    first = next(at for at, line in enumerate(text) if "G01" in line or "G1" in line)
    condition = "$IF V.E.PART == 3\nX[COMP OFF FRICT]\n$ENDIF\n"
    program = frictcomp.Text("".join([*text[:first], condition, *text[first:]]), REVERSAL)
    x = frictcomp.current(program, ["X"])["X"]
    assert x.unknown_cycles > 0
    for read in ("current", "output"):
        with pytest.raises(frictcomp.Error, match="not known"):
            getattr(x, read)
    assert set(x.comp) >= {"unknown"}
    assert numpy.isnan(x.filled(numpy.nan)).sum() == x.unknown_cycles


def test_arrays_outlive_their_currents() -> None:
    currents = frictcomp.current(REVERSAL, ["X"])
    kept, copied = currents["X"].current, currents["X"].current.copy()
    del currents
    assert numpy.array_equal(kept, copied)


def test_places_are_a_mapping_or_pairs() -> None:
    # R13.13
    start = {"X": 1.0}
    mapped = frictcomp.current(REVERSAL, ["X"], start=start)["X"]
    paired = frictcomp.current(REVERSAL, ["X"], start=list(start.items()))["X"]
    assert numpy.array_equal(mapped.current, paired.current)
    for wrong in ("X1", ["X"], {"X": "one"}, 1.0):
        with pytest.raises(TypeError, match="names of axes with their positions"):
            frictcomp.current(REVERSAL, ["X"], start=wrong)  # type: ignore[arg-type]


def test_what_cannot_be_computed_is_an_error() -> None:
    with pytest.raises(frictcomp.Error, match="no axis `QQ`"):
        frictcomp.current(REVERSAL, ["QQ"])
    with pytest.raises(frictcomp.Error, match="no axis was given"):
        frictcomp.current(REVERSAL, [])
    with pytest.raises(frictcomp.Error):
        frictcomp.current([REVERSAL, REVERSAL], ["X"])  # type: ignore[arg-type]
    for cycle in (0, -1, float("nan"), 1e9):
        with pytest.raises(frictcomp.Error):
            frictcomp.current(REVERSAL, ["X"], cycle_time_ms=cycle)
    with pytest.raises(frictcomp.Error):
        frictcomp.current(REVERSAL, ["X"], start=[("X", float("nan"))])
    with pytest.raises(ValueError):
        frictcomp.current(REVERSAL, ["X"], reading="standstill=maybe")
    with pytest.raises(frictcomp.Error) as caught:
        frictcomp.current(REVERSAL, ["X"], value_list="none.lis")
    assert caught.value.file == "none.lis"
    cut = frictcomp.current(REVERSAL, ["X"], max_cycles=10)
    assert 0 < len(cut) <= 10 and cut.messages


TRACE = """t,x,v,comp
0.000,0,0,on
0.001,10,1000,on
0.002,20,1000,on
0.003,20,0,on
0.004,10,-1000,on
0.005,0,-1000,off
"""


def test_the_current_of_a_recording_is_that_of_the_command(tmp_path: Path) -> None:
    # R13.13
    trace, listed = tmp_path / "trace.csv", "programs/demo/lists/comp_x.lis"
    trace.write_text(TRACE)
    made = frictcomp.current_of_recording(trace, listed)
    options = ["--recording", str(trace), "--value-list", listed]
    rows = list(csv.DictReader(io.StringIO(command("current", *options).stdout)))
    assert len(rows) == len(made) == 6
    for name in ["t", "x", "v", "w_before", "w_after", "current", "output"]:
        assert numpy.array_equal(getattr(made, name), [float(row[name]) for row in rows]), name
    assert list(made.comp) == ["active"] * 5 + ["inactive"]
    assert made.axis == "" and made.current.any() and made.current[-1] == 0
    picture = tmp_path / "trace.svg"
    command("current", *options, "--svg", str(picture))
    assert made.svg() == picture.read_text("utf-8")


def test_one_axis_of_a_recording_is_chosen_by_its_name(tmp_path: Path) -> None:
    # R6.3
    trace, listed = tmp_path / "trace.csv", "programs/demo/lists/comp_x.lis"
    trace.write_text("t,X.SetVelo [mm/s],Y.SetVelo [mm/s]\n0,1,0\n0.001,1,-2\n0.002,1,-2\n")
    with pytest.raises(frictcomp.Error, match="SetVelo"):
        frictcomp.current_of_recording(trace, listed)
    made = frictcomp.current_of_recording(trace, listed, axis="Y")
    assert made.axis == "Y" and list(made.v) == [0, -2000, -2000]
    with pytest.raises(frictcomp.Error, match="no channel `v`"):
        frictcomp.current_of_recording(trace, listed, axis="Y", units={"v": "mm/s"})


def test_rows_of_a_recording_that_are_no_cycles_are_refused(tmp_path: Path) -> None:
    trace, listed = tmp_path / "trace.csv", "programs/demo/lists/comp_x.lis"
    trace.write_text(TRACE.replace("0.005", "0.009"))
    with pytest.raises(frictcomp.Error):
        frictcomp.current_of_recording(trace, listed)
    made = frictcomp.current_of_recording(trace, listed, resample=True)
    assert made.remarks and len(made) > 6
    for wrong in (-1.0, float("nan")):
        with pytest.raises(ValueError, match="dead band"):
            frictcomp.current_of_recording(trace, listed, dead_band=wrong)
    with pytest.raises(ValueError):
        frictcomp.current_of_recording(trace, listed, units={"v": "furlongs"})


def test_the_readings_of_the_machine_count(tmp_path: Path) -> None:
    # R4.5: the reading that the machine selects, unless another one is given.
    text = Path(REVERSAL).read_text("utf-8")
    shared = (Path(REVERSAL).parent / "frictcomp.toml").read_text("utf-8")
    config = tmp_path / "frictcomp.toml"
    config.write_text(shared)
    held = frictcomp.current(frictcomp.Text(text), ["X"], machine=config)["X"].current
    other = frictcomp.current(frictcomp.Text(text), ["X"], machine=config, reading="delay=reversal")
    config.write_text(shared + '\n[reading]\n"R4.5" = "reversal"\n')
    selected = frictcomp.current(frictcomp.Text(text), ["X"], machine=config)["X"].current
    assert numpy.array_equal(selected, other["X"].current)
    assert not numpy.array_equal(selected, held)
