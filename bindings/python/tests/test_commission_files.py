"""Measuring programs, learned lists and questions to a control: the documents and the files of the command."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from conftest import command

import frictcomp

MACHINE = "programs/demo/commissioning/frictcomp.toml"
TRAVEL = {"X": (0.0, 300.0), "Y": (-50.0, 200.0)}
FEEDS = [500.0, 1000.0, 2000.0, 5000.0]
PLAN = ["commission", "plan", "--config", MACHINE, "--axis", "X,Y", "--travel", "X0..300,Y-50..200"]
PLAN += ["--feeds", "500,1000,2000,5000"]


def document(*arguments: str) -> Any:
    """The JSON document that the command prints."""
    return json.loads(command(*arguments, "--format", "json").stdout)


def files(folder: Path) -> dict[str, bytes]:
    """The files below a folder with their contents."""
    found = (it for it in folder.rglob("*") if it.is_file())
    return {str(it.relative_to(folder)): it.read_bytes() for it in found}


def planned(**arguments: Any) -> Any:
    """A plan for the machine of the demo, unless arguments say otherwise."""
    usual: dict[str, Any] = {"axis": ["X", "Y"], "travel": TRAVEL, "feeds": FEEDS}
    return frictcomp.plan(**{**usual, "machine": MACHINE, **arguments})


def refused(words: str, **arguments: Any) -> frictcomp.Error:
    """The error of a plan, which names what is wrong and what to do."""
    with pytest.raises(frictcomp.Error, match=words) as caught:
        planned(**arguments)
    assert "help:" in str(caught.value), str(caught.value)
    return caught.value


def test_a_plan_is_that_of_the_command(tmp_path: Path) -> None:
    # R13.13, R16.1
    assert planned() == document(*PLAN)
    more = ["--pitch", "X=10,Y=5", "--radius", "20", "--slowest", "1", "--approach", "500"]
    told = planned(pitch={"X": 10, "Y": 5}, radius_mm=20, slowest=1, approach=500)
    assert told == document(*PLAN, *more)
    one = frictcomp.plan("X", travel=(0, 300), feeds=FEEDS, pitch=10, machine=MACHINE)
    sole = ["commission", "plan", "--config", MACHINE, "--axis", "X", "--travel", "X0..300"]
    assert one == document(*sole, "--feeds", "500,1000,2000,5000", "--pitch", "10")
    assert one["plan"]["programs"][0]["file"] == "01-friction-X.nc"
    planned(into=tmp_path / "python")
    assert command(*PLAN, "--into", str(tmp_path / "command")).returncode == 0
    written = files(tmp_path / "python")
    assert written == files(tmp_path / "command")
    assert {"README.txt", "plan-1.json", "01-friction-X.nc"} <= written.keys()


def test_stage_2_has_a_list_of_each_axis(tmp_path: Path) -> None:
    # R16.1
    shutil.copy("programs/demo/lists/comp_x.lis", tmp_path / "comp.lis")
    listed = str(tmp_path / "comp.lis")
    told = document(*PLAN, "--value-list", listed)
    assert planned(value_list=listed) == planned(value_list={"X": listed, "Y": listed}) == told
    assert [it["axis"] for it in told["lists"]] == ["X", "Y"]
    # Each set of lists is a round with its own plan.
    folder = tmp_path / "plans"
    planned(into=folder)
    planned(value_list=listed, into=folder)
    assert {"plan-1.json", "plan-2.json"} <= files(folder).keys()
    missing = refused("gives nothing for `Y`", value_list={"X": listed})
    assert "value_list={'X': …, 'Y': …}" in str(missing)
    assert "the axes are X, Y" in str(refused("names `Z`", value_list={"Z": listed}))
    absent = str(tmp_path / "none.lis")
    assert refused("there is no file", value_list=absent).file == absent
    other = tmp_path / "other.lis"
    other.write_text("frict_comp.table_entries 1\n")
    with pytest.raises(frictcomp.Error, match="value list") as caught:
        planned(value_list=str(other))
    assert caught.value.file == str(other)


def test_what_does_not_fit_is_not_planned(tmp_path: Path) -> None:
    # R16.8
    folder = tmp_path / "plans"
    for words, arguments in (
        ("gives nothing for `Y`", {"travel": {"X": (0, 300)}}),
        ("ends where it begins", {"travel": (5, 5)}),
        ("not a finite number", {"travel": (0, float("nan"))}),
        ("number of different feeds", {"feeds": [500, 1000]}),
        ("faster than", {"feeds": [500, 1000, 2000, 90_000]}),
        ("cannot be used", {"slowest": -1}),
        ("no linear or rotary axis `Q`", {"axis": "Q", "travel": (0, 300)}),
        ("0 axes were given", {"axis": []}),
        ("given twice", {"axis": ["X", "X"], "travel": (0, 300)}),
        ("radius", {"radius_mm": 400}),
    ):
        refused(words, into=folder, **arguments)
    limits = tmp_path / "frictcomp.toml"
    limits.write_text('[[axis]]\nname = "X"\n[[axis]]\nname = "Y"\n')
    assert "`machine=`" in str(refused("`max_velocity` of axis `X`", machine=limits, into=folder))
    assert not folder.exists()
    with pytest.raises(TypeError):
        planned(travel={"X": 5})
    with pytest.raises(TypeError):
        planned(feeds="500")
    with pytest.raises(frictcomp.Error, match="plan") as caught:
        frictcomp.commission(folder)
    assert "`frictcomp.plan`" in str(caught.value) and caught.value.file == str(folder)


def test_no_plan_and_no_program_is_replaced(tmp_path: Path) -> None:
    # R9.93, R16.1
    folder = tmp_path / "plans"
    planned(into=folder)
    before = files(folder)
    other = refused("holds another plan", into=folder, feeds=[600, 1000, 2000, 5000])
    assert "another folder" in str(other) and other.file == str(folder / "plan-1.json")
    refused("take the place of a program", into=folder)
    assert files(folder) == before


@pytest.fixture
def learning(tmp_path: Path) -> Path:
    """A folder of rounds with recordings, as it was before the second round was made."""
    folder = tmp_path / "learning"
    shutil.copytree("programs/demo/recorded/learning", folder)
    shutil.rmtree(folder / "round-2", ignore_errors=True)
    return folder


def test_learning_begins_as_with_the_command(tmp_path: Path) -> None:
    # R13.13, R16.4
    friction = "programs/demo/learning/friction.lis"
    folders = [tmp_path / name for name in ("python", "command")]
    told = frictcomp.learn(folders[0], plant="mid", friction=friction)
    asked = document(
        "commission", "learn", str(folders[1]), "--plant", "mid", "--friction", friction
    )
    assert str(told).replace(str(folders[0]), "") == str(asked).replace(str(folders[1]), "")
    assert files(folders[0]) == files(folders[1])
    assert {"learning.json", "round-1/X.lis", "round-1/Y.lis"} == {
        name.replace("\\", "/") for name in files(folders[0])
    }
    # Without recordings a further call says the same, and writes nothing.
    before = files(folders[0])
    assert frictcomp.learn(folders[0], plant="mid") == told
    assert files(folders[0]) == before


def test_recorded_rounds_are_judged_as_by_the_command(learning: Path, tmp_path: Path) -> None:
    # R13.13, R16.4
    other = tmp_path / "other"
    shutil.copytree(learning, other)
    best = {"X": tmp_path / "x.lis", "Y": tmp_path / "y.lis"}
    told = frictcomp.learn(learning, plant="mid", write_list=best)
    asked = document("commission", "learn", str(other), "--plant", "mid")
    assert str(told).replace(str(learning), "") == str(asked).replace(str(other), "")
    assert files(learning) == files(other)
    for axis, path in best.items():
        assert path.read_bytes() == (learning / "round-1" / f"{axis}.lis").read_bytes()


def test_learning_does_not_go_on_from_what_is_wrong(learning: Path, tmp_path: Path) -> None:
    # R16.4
    friction = "programs/demo/learning/friction.lis"
    before = files(learning)

    def wrong(words: str, folder: Path = learning, **arguments: Any) -> frictcomp.Error:
        with pytest.raises(frictcomp.Error, match=words) as caught:
            frictcomp.learn(folder, **{"plant": "mid", **arguments})
        assert "help:" in str(caught.value), str(caught.value)
        return caught.value

    empty = tmp_path / "empty"
    assert "`friction={" in str(wrong("has no `learning.json`", empty))
    assert "`value_list`" in str(wrong("has begun", friction=friction))
    wrong("given without `friction`", value_list=friction)
    wrong("gives nothing for `Y`", empty, friction={"X": friction})
    wrong("names `Z`", empty, friction={"Z": friction})
    wrong("no-such-plant", plant="no-such-plant")
    absent = str(tmp_path / "none.lis")
    assert wrong("there is no file", empty, friction=absent).file == absent
    begun = tmp_path / "begun"
    frictcomp.learn(begun, plant="mid", friction=friction)
    assert "`write_list`" in str(wrong("no best list", begun, write_list={"X": tmp_path / "x.lis"}))
    assert not (tmp_path / "x.lis").exists()
    wrong("no channel `Nothing`", position={"X": "Nothing"})
    with pytest.raises(ValueError, match="`model`"):
        frictcomp.learn(learning, plant="mid", model="no-such-model")
    assert files(learning) == before and not empty.exists()
    (learning / "round-1" / "X.lis").write_text("; another list\n")
    changed = wrong("is not the list that was handed out")
    assert changed.file == str(learning / "round-1" / "X.lis")


@pytest.fixture
def control(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a machine, which is the current one."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "frictcomp.toml").write_text(
        '[machine]\ncnc_build = "3.1.3081.5"\n\n[[axis]]\nname = "X"\nnumber = 1\nenable = true\n'
    )
    return tmp_path


def note(control: Path, rule: str, reading: str) -> str:
    """The line for a note, as the page for the operator has it."""
    lines = (control / "ask" / "README.txt").read_text().splitlines()
    found = (it.strip() for it in lines if f"frictcomp-ask {rule} " in it)
    return next(it for it in found if it.endswith(f" reading {reading}")) + "\n"


def test_the_programs_that_ask_are_those_of_the_command(control: Path) -> None:
    # R13.13, R15.1
    told = frictcomp.ask_write("ask", axis="X", travel=4)
    said = command("ask", "write", "--axis", "X", "--travel", "4", "--into", "other")
    assert files(control / "ask") == files(control / "other")
    assert " ".join(said.stdout.split()) == told["headline"]["text"].replace("`ask`", "`other`")
    assert (told["axis"], told["travel"], told["build"]) == ("X", 4, "V3.1.3081.05")
    assert set(told["programs"]) == files(control / "ask").keys() - {"README.txt"}
    for wrong in (0.0, -1.0, 5000.0, float("nan")):
        with pytest.raises(frictcomp.Error, match="from 0.1 to 1000"):
            frictcomp.ask_write("none", travel=wrong)
    with pytest.raises(frictcomp.Error, match="its axes are X"):
        frictcomp.ask_write("none", axis="Q")
    assert not (control / "none").exists()
    # No program is replaced.
    before = files(control / "ask")
    with pytest.raises(frictcomp.Error, match="another place"):
        frictcomp.ask_write("ask", axis="X", travel=5)
    assert files(control / "ask") == before


def test_the_questions_are_those_of_the_command(control: Path) -> None:
    # R13.13, R15.1
    assert frictcomp.ask_list() == document("ask", "list")
    other = frictcomp.ask_list(machine=frictcomp.Machine(isolated=True), cnc_build="3.1.3132.0")
    assert other == document("ask", "list", "--isolated", "--cnc-build", "3.1.3132.0")
    with pytest.raises(ValueError, match="`cnc_build`"):
        frictcomp.ask_list(cnc_build="newest")
    broken = control / "broken.toml"
    broken.write_text('[reading]\n"R1.9" = "between"\n')
    with pytest.raises(frictcomp.Error) as caught:
        frictcomp.ask_list(machine=broken)
    assert (caught.value.file, caught.value.line) == (str(broken), 2)


def test_answers_are_read_as_the_command_reads_them(control: Path) -> None:
    # R13.13, R15.2
    frictcomp.ask_write("ask")
    config = control / "frictcomp.toml"
    (control / "note.txt").write_text(
        note(control, "R1.9", "before") + "frictcomp-ask X9.9 0 X V3.1.3081.5 reading x\n"
    )
    before = config.read_text()
    told = frictcomp.ask_read("note.txt")
    assert [(it["rule"], it["answer"], it["reading"]) for it in told["answers"]] == [
        ("R1.9", "confirmed", "before")
    ]
    assert [(it["file"], it["line"]) for it in told["unread"]] == [("note.txt", 2)]
    # Without `into` nothing is written.
    assert told["recorded_in"] is None and config.read_text() == before
    asked = document("ask", "read", "note.txt")
    recorded = config.read_text()
    assert recorded.startswith(before) and '"R1.9" = "before"' in recorded
    assert {**told, "recorded_in": asked["recorded_in"]} == asked
    config.write_text(before)
    again = frictcomp.ask_read(["note.txt"], into="frictcomp.toml")
    assert again["recorded_in"] == "frictcomp.toml" and config.read_text() == recorded
    # A configuration that is not there is a new one.
    frictcomp.ask_read("note.txt", into="new.toml")
    assert '"R1.9" = "before"' in (control / "new.toml").read_text()


def test_what_holds_no_answer_records_nothing(control: Path) -> None:
    # R15.2
    frictcomp.ask_write("ask")
    (control / "note.txt").write_text("frictcomp-ask R1.9\n")
    (control / "first.txt").write_text(note(control, "R1.9", "before"))
    (control / "other.txt").write_text(note(control, "R1.9", "after"))
    (control / "plain.txt").write_text("12:00 nothing of ours\n")
    (control / "broken.toml").write_text("[reading\n")
    before = files(control)

    def wrong(words: str, given: Any, **arguments: Any) -> frictcomp.Error:
        with pytest.raises(frictcomp.Error, match=words) as caught:
            frictcomp.ask_read(given, **{"into": "frictcomp.toml", **arguments})
        return caught.value

    unread = wrong("holds no answer", "note.txt")
    assert unread.file == "note.txt" and "note.txt:1: after `frictcomp-ask`" in str(unread)
    assert "lines that begin with `frictcomp-ask`" in str(wrong("plain.txt", "plain.txt"))
    assert "one control" in str(wrong("contradict each other", ["first.txt", "other.txt"]))
    assert wrong("there is no file", "none.txt").file == "none.txt"
    assert "message.txt" in str(wrong("no file was given", []))
    broken = wrong("broken.toml", "first.txt", into="broken.toml")
    assert broken.file == "broken.toml"
    assert "frictcomp.toml" in str(wrong("not a configuration", "first.txt", into="other.txt"))
    with pytest.raises(ValueError, match="furlongs"):
        frictcomp.ask_read("first.txt", units={"v": "furlongs"})
    assert files(control) == before
