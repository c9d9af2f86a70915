"""Results go to other processes and come back; any iterable is accepted for several values."""

from __future__ import annotations

import multiprocessing
import pickle
from collections.abc import Sequence
from pathlib import Path

import numpy
import polars
import pytest
from conftest import programs

import frictcomp

UNDECIDED = "N10 $IF V.E.A == 1\nN20 X[COMP OFF FRICT]\nN30 $ENDIF\nN40 G01 X1 F100\nM30\n"


def test_a_timeline_comes_back_whole() -> None:
    # R13.13
    machine = frictcomp.Machine(isolated=True, enable=("X",))
    timeline = frictcomp.run(frictcomp.Text(UNDECIDED), machine=machine, positions=True)
    back = pickle.loads(pickle.dumps(timeline))
    assert polars.DataFrame(back).equals(polars.DataFrame(timeline))
    assert list(back.messages) == list(timeline.messages) and len(back.messages)
    assert (back.axes, back.columns, len(back)) == (timeline.axes, timeline.columns, len(timeline))
    assert back.friction == timeline.friction == {"X": "unknown"}
    assert back.possible == timeline.possible and back.possible
    assert back.state == timeline.state
    assert (back.opaque, back.is_assumed, back.unrun) == (timeline.opaque, timeline.is_assumed, 0)
    for one, other in zip(back.programs, timeline.programs, strict=True):
        assert (one.file, one.by, one.blocks) == (other.file, other.by, other.blocks)
        assert (one.start, one.end, one.possible) == (other.start, other.end, other.possible)


def test_a_pool_of_processes_runs_an_archive() -> None:
    # R13.13
    files = programs("programs/demo/order")
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        timelines = pool.map(frictcomp.run, files)
    for file, timeline in zip(files, timelines, strict=True):
        here = frictcomp.run(file)
        assert polars.DataFrame(timeline).equals(polars.DataFrame(here)), file
        assert list(timeline.messages) == list(here.messages)


def test_what_a_run_is_given_can_be_pickled(tmp_path: Path) -> None:
    # R13.13
    text = frictcomp.Text("X[COMP OFF FRICT]\nV.P.A = V.E.B\nM30\n", "a.nc")
    machine = frictcomp.Machine(isolated=True, enable=["X"], variables={"V.E.B": 3, "V.E.C": "x"})
    limits = frictcomp.Limits(blocks=2, skip=[1, 10])
    for given in (machine, limits, text):
        assert repr(pickle.loads(pickle.dumps(given))) == repr(given)
    there = [pickle.loads(pickle.dumps(it)) for it in (text, machine, limits)]
    said = [
        list(frictcomp.run(program, machine=on, limits=within).messages)
        for program, on, within in ((text, machine, limits), there)
    ]
    assert said[0] == said[1]
    assert any(it.code == "FC910" for it in said[0]), "two blocks are the limit"
    config = tmp_path / "frictcomp.toml"
    config.write_text('[[axis]]\nname = "Y"\nfrict_comp = true\n')
    of_file = pickle.loads(pickle.dumps(frictcomp.Machine(config)))
    assert frictcomp.run(text, machine=of_file).axes == ["Y"]


def test_messages_have_the_methods_of_a_sequence() -> None:
    # R13.13
    messages = frictcomp.check("programs/demo")
    assert all(hasattr(messages, name) for name in dir(Sequence) if not name.startswith("_"))
    assert len(messages) > 1
    first, second = messages[0], messages[1]
    assert first in messages and "FC401" not in messages
    assert messages.index(second) == 1 and messages.count(first) == 1
    assert messages.index(second, -len(messages)) == 1
    assert list(reversed(messages)) == list(messages)[::-1]
    with pytest.raises(ValueError):
        messages.index(first, 1)
    assert pickle.loads(pickle.dumps(first)) == first
    back = pickle.loads(pickle.dumps(messages))
    assert list(back) == list(messages) and back.left_out == messages.left_out


def test_several_values_are_any_iterable() -> None:
    # R13.13
    files = programs("programs/demo/order")
    listed = frictcomp.check(files)
    assert list(frictcomp.check(it for it in files)) == list(listed)
    assert list(frictcomp.check(Path(it) for it in files)) == list(listed)
    tuned = frictcomp.tune(feeds=numpy.array([2000.0, 5000.0]), shaping=False)
    assert tuned.record == frictcomp.tune(feeds=[2000, 5000], shaping=False).record
    with pytest.raises(TypeError):
        frictcomp.Machine(enable="XY")


def test_a_path_has_no_line_end() -> None:
    # R13.13
    with pytest.raises(frictcomp.Error) as caught:
        frictcomp.run("programs/demo/friction.nc\n")
    assert "a path has no line ends" in str(caught.value)
    assert "frictcomp.Text" in str(caught.value)


def test_every_result_can_be_pickled() -> None:
    # R13.13
    reversal = "programs/demo/current/reversal.nc"
    audit = frictcomp.audit("programs/demo/order")
    order = frictcomp.audit_sequence(programs("programs/demo/order"))
    for table in (audit, order):
        back = pickle.loads(pickle.dumps(table))
        assert polars.DataFrame(back).equals(polars.DataFrame(table))
        assert (back.records, back.has_warnings) == (table.records, table.has_warnings)
        assert list(back.messages) == list(table.messages) and str(back) == str(table)
    assert pickle.loads(pickle.dumps(audit)).hazards == audit.hazards
    currents = frictcomp.current(reversal, ["X"])
    again = pickle.loads(pickle.dumps(currents))
    assert numpy.array_equal(again["X"].current, currents["X"].current)
    assert (again.svg(), again["X"].svg()) == (currents.svg(), currents["X"].svg())
    assert (again.axes, again.left_out) == (["X"], currents.left_out)
    simulated = (
        frictcomp.circle(radius_mm=20),
        frictcomp.contour(
            "programs/demo/contour/plate.nc", start=[("X", 0.0), ("Y", 0.0), ("Z", 10.0)]
        ),
        frictcomp.tune(feeds=[2000], radii=[20], shaping=False),
        frictcomp.identify(
            "programs/demo/recordings/friction_x.csv", velocity="SetVelo", torque="ActTorque"
        ),
    )
    for made in simulated:
        there = pickle.loads(pickle.dumps(made))
        assert (there.record, there.svg()) == (made.record, made.svg())
        if isinstance(made, frictcomp.Tuned):
            assert there.value_list("Y") == made.value_list("Y")
        if isinstance(made, frictcomp.Identified):
            assert there.value_list() == made.value_list()


def test_an_error_comes_back_with_its_messages(tmp_path: Path) -> None:
    # R13.13
    config = tmp_path / "frictcomp.toml"
    config.write_text("axis = 3\n")
    with pytest.raises(frictcomp.Error) as caught:
        frictcomp.run("programs/demo/friction.nc", machine=config)
    error = caught.value
    back = pickle.loads(pickle.dumps(error))
    assert (str(back), back.messages, back.line) == (str(error), error.messages, error.line)
    assert back.messages


def test_one_machine_serves_an_archive(tmp_path: Path) -> None:
    # R13.13: one machine, whatever folder a program is in.
    config = tmp_path / "frictcomp.toml"
    config.write_text('[[axis]]\nname = "X"\nfrict_comp = true\n')
    machine = frictcomp.Machine(config)
    files = programs("programs/demo/order", "programs/demo/current")
    assert {tuple(frictcomp.run(file, machine=machine).axes) for file in files} >= {("X",)}
    audit = frictcomp.audit(files, machine=machine)
    assert set(polars.DataFrame(audit)["machine"]) == {str(config)}
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        there = pool.starmap(ran_on, [(file, machine) for file in files])
    assert there == [frictcomp.run(file, machine=machine).friction for file in files]


def ran_on(file: str, machine: frictcomp.Machine) -> dict[str, str]:
    """What a program leaves."""
    return dict(frictcomp.run(file, machine=machine).friction)
