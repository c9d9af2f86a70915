"""TwinCAT projects: the lists in them describe the machine, as on the command line."""

from __future__ import annotations

import pickle
from pathlib import Path

import polars
import pytest
from conftest import ROOT, command, records

import frictcomp

PROJECT = "programs/demo/twincat/Machine.tsproj"
PART = "programs/demo/twincat/part.nc"


def test_a_project_describes_the_machine() -> None:
    # R3.42
    machine = frictcomp.Machine.from_project(PROJECT)
    assert "Machine.tsproj" in repr(machine)
    timeline = frictcomp.run(PART, machine=machine)
    assert timeline.axes == ["X", "Y", "Z", "S"]
    assert timeline.friction == {"X": "inactive"} | dict.fromkeys("YZS", "unconfigured")
    told = records("run", "--isolated", "--project", PROJECT, "--format", "ndjson", PART)
    said = [it for it in told if it["record"] == "diagnostic" and "seq" in it]
    assert [(it.code, it.line, it.message) for it in timeline.messages] == [
        (it["code"], it["line"], it["message"]) for it in said
    ]
    again = frictcomp.run(PART, machine=pickle.loads(pickle.dumps(machine)))
    assert polars.DataFrame(again).equals(polars.DataFrame(timeline))


def test_a_machine_of_a_project_takes_assumptions() -> None:
    # R3.42
    machine = frictcomp.Machine.from_project(PROJECT, enable=["Z"], variables={"V.E.A": 1})
    text = frictcomp.Text("$IF V.E.A == 1\nZ[COMP OFF FRICT]\n$ENDIF\nM30\n")
    assert frictcomp.run(text, machine=machine).friction["Z"] == "inactive"


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("plant.xml", "<Plant><Axis/></Plant>"),
        ("Empty.tsproj", '<TcSmProject><Project Name="Empty"/></TcSmProject>'),
        ("Broken.tsproj", "<TcSmProject><Project"),
        ("Text.tsproj", "kopf.achs_nr 1\n"),
    ],
)
def test_what_is_no_project_with_a_cnc_is_refused(tmp_path: Path, name: str, text: str) -> None:
    # R3.43: as the command, which says what it is.
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(frictcomp.Error) as caught:
        frictcomp.run(ROOT / PART, machine=frictcomp.Machine.from_project(path))
    assert caught.value.file == str(path)
    told = command("run", "--isolated", "--project", str(path), PART)
    assert told.returncode == 2, told.stdout
