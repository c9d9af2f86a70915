"""Messages of whole folders: the same as those of the command."""

from __future__ import annotations

from pathlib import Path

import polars
import pytest
from conftest import command, records
from test_run import of_messages, wordless

import frictcomp


@pytest.mark.parametrize("folder", ["programs/ok", "programs/err", "programs/demo"])
def test_messages_are_those_of_the_command(folder: str) -> None:
    told = [it for it in records("check", "--format", "ndjson", folder) if it["record"] == "diagnostic"]
    messages = frictcomp.check(folder)
    assert [wordless(it) for it in of_messages(messages)] == [wordless(it) for it in told]
    table = polars.DataFrame(messages)
    assert table.height == len(messages) == len(told)
    assert table["code"].to_list() == [it["code"] for it in told]
    assert table["help"].to_list() == [it.help for it in messages]


def test_a_message_names_the_programs_that_reach_it(tmp_path: Path) -> None:
    for name in ["a.nc", "b.nc"]:
        (tmp_path / name).write_text("N10 L sub.nc\nN20 M30\n")
    (tmp_path / "sub.nc").write_text("N1 X[COMP ON FRCT]\nM17\n")
    said = [it for it in frictcomp.check(tmp_path) if it.code == "FC202"]
    assert len(said) == 1
    assert [Path(it).name for it in said[0].reached_from] == ["a.nc", "b.nc"]
    assert said[0].reached_from_count == 2


def test_what_is_not_taken_is_said_and_chosen(tmp_path: Path) -> None:
    # R18.5
    (tmp_path / ".ignore").write_text("aside.nc\n")
    (tmp_path / "main.nc").write_text("N10 X1 F100\nM30\n")
    (tmp_path / "aside.nc").write_text("N10 X[COMP OFF FRICT]\nN20 M30\n")
    assert [it.code for it in frictcomp.check(tmp_path)] == ["FC105"]
    assert "FC105" not in {it.code for it in frictcomp.check(tmp_path, no_ignore=True)}
    assert [it.code for it in frictcomp.check(tmp_path, exclude=["aside.nc"])] == []
    with pytest.raises(TypeError):
        frictcomp.check(tmp_path, exclude="aside.nc")


def test_messages_are_a_sequence() -> None:
    messages = frictcomp.check("programs/demo/friction.nc")
    assert [it.code for it in messages] == ["FC401", "FC401"]
    assert messages[0] == messages[-2] and messages[:1] == [messages[0]]
    assert str(messages[0]).startswith("programs/demo/friction.nc:3:5: warning[FC401] ")
    with pytest.raises(IndexError):
        messages[2]
    messages.raise_for_errors()
    with pytest.raises(frictcomp.Error) as caught:
        frictcomp.check("programs/err/FC202-frikt.nc").raise_for_errors()
    assert (caught.value.code, caught.value.line) == ("FC202", caught.value.messages[0].line)


def test_known_findings_are_left_out(tmp_path: Path) -> None:
    # R17.3
    known = tmp_path / "known.json"
    program = tmp_path / "a.nc"
    program.write_text("N10 X[COMP OFF FRIKT]\nN20 M30\n")
    assert [it.code for it in frictcomp.check(program)] == ["FC202"]
    command("check", "--isolated", "--write-baseline", str(known), str(program))
    assert list(frictcomp.check(program, baseline=known)) == []
    program.write_text("N10 X[COMP OFF FRIKT]\nN15 Y[COMP OFF FRIKT]\nN20 M30\n")
    assert [it.line for it in frictcomp.check(program, baseline=known)] == [2]
    known.write_text("{}")
    with pytest.raises(frictcomp.Error, match="not a baseline"):
        frictcomp.check(program, baseline=known)
