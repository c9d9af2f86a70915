"""The state that one run leaves for the next one, including the command."""

from __future__ import annotations

import json
import pickle
from pathlib import Path

import pytest
from conftest import command

import frictcomp

OFF = frictcomp.Text("N10 X[COMP OFF FRICT]\nN20 V.S.PART = 3\nN30 M30\n")
MOVE = "N10 G01 X5 F100\nN20 M30\n"
MOVES = frictcomp.Text(MOVE)
MACHINE = frictcomp.Machine(isolated=True, enable=["X"])


def test_a_switch_survives_the_end_of_a_program() -> None:
    first = frictcomp.run(OFF, machine=MACHINE)
    assert first.state.away == [("X", "FRICT")]
    second = frictcomp.run(MOVES, machine=MACHINE, state=first.state)
    assert second.programs[0].start == {"X": "inactive"}
    # The state of a run is not changed by the next one, and without it X is active again.
    assert frictcomp.run(MOVES, machine=MACHINE).friction == {"X": "active"}
    assert first.state == frictcomp.run(OFF, machine=MACHINE).state != second.state


def test_a_state_comes_back_from_a_file_and_another_process(tmp_path: Path) -> None:
    state = frictcomp.run(OFF, machine=MACHINE).state
    path = tmp_path / "cell.json"
    state.save(path)
    assert frictcomp.State.load(path) == state
    assert frictcomp.State.from_json(state.to_json()) == state
    assert pickle.loads(pickle.dumps(state)) == state
    assert json.loads(path.read_text("utf-8"))["variables"]["V.S.PART"] == {"Number": 3.0}


def test_the_command_takes_the_state_and_gives_it_back(tmp_path: Path) -> None:
    path, program = tmp_path / "cell.json", tmp_path / "move.nc"
    program.write_text(MOVE)
    frictcomp.run(OFF, machine=MACHINE).state.save(path)
    arguments = ["--isolated", "--enable", "X", "--state", str(path), str(program)]
    told = command("run", "--format", "csv", *arguments)
    assert ",inactive," in told.stdout.splitlines()[1]
    again = frictcomp.run(program, machine=MACHINE, state=path)
    assert again.programs[0].start == {"X": "inactive"}
    assert frictcomp.State.load(path) == again.state


def test_a_file_is_read_and_written_as_by_the_command(tmp_path: Path) -> None:
    path = tmp_path / "cell.json"
    frictcomp.run(OFF, machine=MACHINE, state=path)
    assert frictcomp.run(MOVES, machine=MACHINE, state=str(path)).friction == {"X": "inactive"}


def test_a_state_of_another_machine_is_refused(tmp_path: Path) -> None:
    state = frictcomp.run(OFF, machine=MACHINE).state
    with pytest.raises(frictcomp.Error, match="another machine"):
        frictcomp.run(MOVES, machine="programs/demo/frictcomp.toml", state=state)
    damaged = tmp_path / "damaged.json"
    damaged.write_text('{"schema":')
    for path in [damaged, tmp_path / "none.json"]:
        with pytest.raises(frictcomp.Error) as caught:
            frictcomp.State.load(path)
        assert caught.value.file == str(path) and caught.value.help
    with pytest.raises(frictcomp.Error, match="damaged"):
        frictcomp.run(MOVES, machine=MACHINE, state=damaged)
    assert damaged.read_text() == '{"schema":'
    with pytest.raises(ValueError, match="not a state"):
        frictcomp.State.from_json("[]")
