"""Timelines: the same values as those of the command, in every library that accepts them."""

from __future__ import annotations

import csv
import gc
import io
from pathlib import Path
from typing import Any

import duckdb
import pandas
import polars
import pyarrow
import pytest
from conftest import command, programs, records

import frictcomp

FRICTION = "programs/demo/friction.nc"


def changed(fix: frictcomp.Fix) -> dict[str, Any]:
    """The record of a fix."""
    names = ["file", "line", "column", "end_line", "end_column", "text", "safety"]
    record = {name: getattr(fix, name) for name in names}
    return record | ({"also": changed(fix.also)} if fix.also else {})


def test_a_timeline_is_a_table_of_blocks() -> None:
    timeline = frictcomp.run(FRICTION)
    assert len(timeline) == 5
    blocks = polars.DataFrame(timeline)
    assert blocks.columns == timeline.columns
    assert blocks.columns == [
        *["program", "seq", "file", "line", "n", "level", "text"],
        *["X", "Y", "Z", "changes", "codes", "branch"],
    ]
    inactive = blocks.filter(polars.col("X") == "inactive")
    assert inactive["line"].to_list() == [5, 6]
    assert blocks["codes"].to_list() == [[], [], [], [], ["FC401", "FC401"]]
    assert blocks["changes"].to_list()[1] == [
        {"axis": "Y", "kind": "FRICT", "from": "active", "to": "inactive"}
    ]


def of_messages(messages: frictcomp.Messages) -> list[dict[str, Any]]:
    """Messages as records of the command."""
    told = []
    for it in messages:
        record: dict[str, Any] = {"record": "diagnostic"}
        if it.program is not None:
            record |= {"program": it.program, "seq": it.seq}
        names = ["code", "severity", "file", "line", "column", "end_line", "end_column", "axis"]
        record |= {name: getattr(it, name) for name in [*names, "message", "help"]}
        if it.ends:
            record["ends"] = [{"file": end.file, "line": end.line} for end in it.ends]
        if it.fixes:
            record["fixes"] = [changed(fix) for fix in it.fixes]
        if it.reached_from:
            record["reached_from"] = it.reached_from
        if it.reached_from_count > len(it.reached_from):
            record["reached_from_count"] = it.reached_from_count
        told.append(record)
    return told


def wordless(record: dict[str, Any]) -> dict[str, Any]:
    """A record without advice, which names options on the command line only."""
    return {name: value for name, value in record.items() if name != "help"}


def of_friction(record: dict[str, Any]) -> dict[str, Any]:
    """The states of friction compensation that are possible, by axis."""
    axes = record.get("possible", {})
    return {axis: kinds["FRICT"] for axis, kinds in axes.items() if "FRICT" in kinds}


@pytest.mark.parametrize("name", programs("programs/ok", "programs/err", "programs/demo"))
def test_values_are_those_of_the_command(name: str) -> None:
    told = records("run", "--format", "ndjson", "--kinds", "all", name)
    timeline = frictcomp.run(name, kinds="all")
    rows = polars.DataFrame(timeline).to_dicts()
    blocks = [it for it in told if it["record"] == "block"]
    assert len(rows) == len(blocks)
    for row, block in zip(rows, blocks, strict=True):
        for key in ["program", "seq", "file", "line", "n", "text", "changes"]:
            assert row[key] == block[key], key
        assert row["level"] == block.get("level")
        assert (row["branch"] is not None) == ("branch" in block)
        # An axis has its state before a program names it, too.
        for axis, state in block["friction"].items():
            assert row[axis] == state
        for axis, states in block["compensation"].items():
            for kind, state in states.items():
                assert row[axis if kind == "FRICT" else f"{axis}.{kind}"] == state
        assert all(row[axis] is not None for axis in timeline.axes)
    diagnostics = [wordless(it) for it in told if it["record"] == "diagnostic"]
    assert [wordless(it) for it in of_messages(timeline.messages)] == diagnostics
    (summary,) = [it for it in told if it["record"] == "summary"]
    assert timeline.friction == summary["friction"]
    assert timeline.possible == of_friction(summary)
    assert timeline.opaque == summary["opaque"]
    assert timeline.messages.errors == summary["errors"]
    assert timeline.messages.warnings == summary["warnings"]
    ends = [it for it in told if it["record"] == "end"]
    assert [(it.by, it.blocks, it.end, it.possible) for it in timeline.programs] == [
        (it["by"], it["seq"], it["friction"], of_friction(it)) for it in ends
    ]
    assert timeline.messages.remark == told[0].get("remark") or "--" in told[0]["remark"]


def test_states_that_depend_on_the_machine_name_their_ways(tmp_path: Path) -> None:
    # R14.2
    part = tmp_path / "part.nc"
    part.write_text(
        "N10 $IF V.E.MATERIAL == 2\nN20 X[COMP OFF FRICT]\nN30 $ENDIF\n"
        "/N40 Y[COMP OFF FRICT]\nN50 X1\nN60 M30\n"
    )
    machine = frictcomp.Machine(isolated=True, enable=["X", "Y"])
    timeline = frictcomp.run(part, machine=machine)
    assert timeline.friction == {"X": "unknown", "Y": "unknown"}
    asked = {"kind": "condition", "file": str(part), "line": 1, "text": "V.E.MATERIAL == 2"}
    skip = {"kind": "skip", "level": 1, "executed": True, "file": str(part), "line": 4}
    assert timeline.possible == {
        "X": [
            {"state": "inactive", "ways": [[{**asked, "holds": True}]], "more": 0},
            {"state": "active", "ways": None},
        ],
        "Y": [
            {"state": "inactive", "ways": [[skip]], "more": 0},
            {"state": "active", "ways": None},
        ],
    }
    (run,) = timeline.programs
    assert run.possible == timeline.possible
    blocks = polars.DataFrame(timeline)
    assert blocks["branch"].to_list() == [
        *[None, "V.E.MATERIAL == 2 (line 1)", None],
        *["skip level 1 is off", None, None],
    ]
    assert pandas.DataFrame.from_arrow(timeline)["branch"].notna().sum() == 2
    chosen = frictcomp.run(
        part,
        machine=frictcomp.Machine(isolated=True, enable=["X", "Y"], variables={"V.E.MATERIAL": 1}),
        limits=frictcomp.Limits(skip=[1]),
    )
    assert chosen.possible == {} and chosen.programs[0].possible == {}
    assert polars.DataFrame(chosen)["branch"].null_count() == len(chosen)


def test_branches_are_those_of_csv(tmp_path: Path) -> None:
    # R14.2
    part = tmp_path / "part.nc"
    part.write_text(
        "N10 $WHILE V.E.A < 3\nN20 X[COMP OFF FRICT]\nN30 $ENDWHILE\n"
        "N40 $IF V.E.B == 1\nN50 X[COMP ON FRICT]\nN60 M30\nN70 $ENDIF\nN80 M30\n"
    )
    told = command("run", "--isolated", "--enable", "X", "--format", "csv", str(part)).stdout
    rows = list(csv.DictReader(io.StringIO(told)))
    blocks = polars.DataFrame(
        frictcomp.run(part, machine=frictcomp.Machine(isolated=True, enable=["X"]))
    ).to_dicts()
    executed = [it for it in rows if it["branch"] != "join"]
    assert len(executed) < len(rows)
    assert [(it["text"], it["X"], it["branch"] or None) for it in executed] == [
        (it["text"], it["X"], it["branch"]) for it in blocks
    ]


def test_pandas_duckdb_and_pyarrow_take_it_too() -> None:
    timeline = frictcomp.run(FRICTION)
    table = pyarrow.table(timeline)
    assert pyarrow.types.is_dictionary(table.schema.field("X").type)
    frame = pandas.DataFrame.from_arrow(timeline)
    assert list(frame["X"]) == ["active", "active", "active", "inactive", "inactive"]
    assert table.to_pandas()["Y"].dtype == "category"
    database = duckdb.connect()
    database.register("blocks", timeline)
    off = database.execute("select line from blocks where X = 'inactive' order by line")
    assert off.fetchall() == [(5,), (6,)]
    left = database.execute("select line from blocks where list_contains(codes, 'FC401')")
    assert left.fetchall() == [(6,)]
    # By the name of a variable, as analysts write it.
    counted = duckdb.sql("select count(*) from timeline")
    assert counted and counted.fetchall() == [(5,)]


def test_buffers_outlive_the_timeline() -> None:
    timeline = frictcomp.run(FRICTION)
    stream = timeline.__arrow_c_stream__()
    unused = timeline.__arrow_c_stream__()
    table = pyarrow.table(timeline)
    del timeline
    gc.collect()

    class Kept:
        def __arrow_c_stream__(self, requested_schema: object = None) -> object:
            return stream

    taken = pyarrow.table(Kept())
    del unused
    gc.collect()
    assert taken.equals(table)
    assert taken["text"].to_pylist()[0].startswith("N15")
    # The stream of a capsule can be consumed once.
    with pytest.raises((ValueError, pyarrow.ArrowInvalid)):
        pyarrow.table(Kept())


def test_texts_are_handed_over_and_not_copied() -> None:
    timeline = frictcomp.run(FRICTION)
    tables = [pyarrow.table(timeline) for _ in range(2)]
    for name in ["text", "line", "X"]:
        chunks = [table[name].chunk(0) for table in tables]
        addresses = [[it and it.address for it in chunk.buffers()] for chunk in chunks]
        assert addresses[0] == addresses[1] and addresses[0][-1]


def test_a_text_is_run_as_a_file_is() -> None:
    with open(FRICTION, "rb") as file:
        data = file.read()
    of_file = polars.DataFrame(frictcomp.run(FRICTION)).drop("file")
    texts: list[bytes | frictcomp.Text] = [data, frictcomp.Text(data.decode()), frictcomp.Text(data, FRICTION)]
    for program in texts:
        timeline = frictcomp.run(program, machine="programs/demo/frictcomp.toml")
        assert polars.DataFrame(timeline).drop("file").equals(of_file)
    named = frictcomp.run(frictcomp.Text(data, FRICTION))
    assert polars.DataFrame(named)["file"].unique().to_list() == [FRICTION]


def test_blocks_of_called_programs_name_their_files() -> None:
    calls = 50
    subs = [frictcomp.Text(f"N1 X{n}\nN2 M17\n", f"sub{n}.nc") for n in range(calls)]
    lines = [f"N{n} L sub{n % calls}.nc" for n in range(3 * calls)]
    main = frictcomp.Text("\n".join([*lines, "N1 M30"]), "main.nc")
    timeline = frictcomp.run([main, *subs], machine=frictcomp.Machine(isolated=True))
    first, level, n = (polars.col(it) for it in ["program", "level", "n"])
    called = polars.DataFrame(timeline).filter((first == 1) & (level == 1) & (n == 1))
    assert called["file"].to_list() == [f"sub{n % calls}.nc" for n in range(3 * calls)]


def test_programs_run_one_after_the_other() -> None:
    timeline = frictcomp.run([FRICTION, "programs/demo/next.nc"])
    assert [it.file for it in timeline.programs] == [FRICTION, "programs/demo/next.nc"]
    assert timeline.programs[1].start == timeline.programs[0].end
    assert timeline.programs[1].start["X"] == "inactive"


def test_a_set_of_programs_has_no_order() -> None:
    # R13.13
    files = {FRICTION, "programs/demo/next.nc"}
    for ordered in (frictcomp.run, frictcomp.audit_sequence):
        for unordered in (files, frozenset(files)):
            with pytest.raises(TypeError, match="a set has no order"):
                ordered(unordered)
    assert len(frictcomp.check(files)) == len(frictcomp.check(sorted(files)))


def test_positions_are_missing_where_they_are_not_known() -> None:
    text = frictcomp.Text("N10 G90 X1.5\nN20 G91 Y1\nN30 M30\n")
    timeline = frictcomp.run(text, machine=frictcomp.Machine(enable=["X"]), positions=True)
    blocks = polars.DataFrame(timeline)
    assert blocks["X_pos"].to_list() == [1.5, 1.5, 1.5]
    assert blocks["Y_pos"].to_list() == [None, None, None]
    assert blocks["frame"].to_list() == ["machine"] * 3


def test_long_programs_come_in_batches() -> None:
    count = 300_000
    lines = [f"N{n} X{n % 7}" for n in range(count)]
    lines[200_000] = "X[COMP OFF FRICT]"
    text = "\n".join([*lines, "M30"])
    timeline = frictcomp.run(frictcomp.Text(text), machine=frictcomp.Machine(enable=["X"]))
    blocks = polars.DataFrame(timeline)
    assert blocks["n"].head(3).to_list() == [0, 1, 2]
    assert blocks["text"].to_list() == text.split("\n")
    assert (blocks["X"] == "inactive").sum() == count + 1 - 200_000
    assert blocks["seq"].to_list() == list(range(1, count + 2))
    # X was moved before it was switched: the message about it comes at the end.
    assert blocks["codes"].to_list()[-1] == ["FC407"]
