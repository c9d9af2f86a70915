"""What cannot be done is an exception with its place; nothing hangs, crashes or is silently fine."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import frictcomp


def test_an_error_has_its_place(tmp_path: Path) -> None:
    config = tmp_path / "frictcomp.toml"
    config.write_text('[[axis]]\nname = "X"\nfrict_komp = true\n')
    with pytest.raises(frictcomp.Error) as caught:
        frictcomp.run(frictcomp.Text("N10 M30\n"), machine=config)
    error = caught.value
    assert (error.file, error.line, error.column) == (str(config), 3, 1)
    assert error.code == error.messages[0].code
    assert "frict_komp" in str(error)
    back = pickle.loads(pickle.dumps(error))
    assert isinstance(back, frictcomp.Error)
    assert (str(back), back.line, back.code) == (str(error), error.line, error.code)


def test_errors_of_the_control_are_messages_until_they_are_raised() -> None:
    timeline = frictcomp.run(
        ["programs/demo/unset/friction.nc", "programs/demo/friction.nc"],
    )
    assert timeline.messages.errors == 1 and timeline.unrun == 1
    assert [it.by for it in timeline.programs] == ["error"]
    with pytest.raises(frictcomp.Error) as caught:
        timeline.raise_for_errors()
    assert (caught.value.code, caught.value.line) == ("P-ERR-70495", 2)
    kept = frictcomp.run("programs/demo/unset/friction.nc", keep_going=True)
    assert kept.programs[0].by == "M30"


@pytest.mark.parametrize("call", [frictcomp.run, frictcomp.check, frictcomp.audit])
def test_files_that_are_not_there_are_errors(call: Callable[[Any], object], tmp_path: Path) -> None:
    missing = tmp_path / "none.nc"
    with pytest.raises(frictcomp.Error) as caught:
        call(missing)
    assert caught.value.file == str(missing)
    with pytest.raises(frictcomp.Error):
        call([])
    with pytest.raises(frictcomp.Error):
        call("X[COMP OFF FRICT]")
    # A missing file is not an all-clear for the others.
    with pytest.raises(frictcomp.Error):
        call(["programs/demo/friction.nc", missing])


def test_a_text_of_one_line_is_not_taken_for_a_file() -> None:
    with pytest.raises(frictcomp.Error, match=r"frictcomp\.Text"):
        frictcomp.run("X[COMP OFF FRICT]")
    timeline = frictcomp.run(
        frictcomp.Text("X[COMP OFF FRICT]"), machine=frictcomp.Machine(isolated=True, enable=["X"])
    )
    assert timeline.friction == {"X": "inactive"}


@pytest.mark.parametrize("wrong", [None, 5, 1.5, object(), [None], [["a.nc"]], {1}])
def test_wrong_types_are_type_errors(wrong: Any) -> None:
    for call in (frictcomp.run, frictcomp.check, frictcomp.audit):
        with pytest.raises(TypeError):
            call(wrong)


def test_wrong_arguments_are_refused() -> None:
    text: Any = frictcomp.Text("N10 M30\n")
    wrong: list[dict[str, Any]] = [
        {"machine": 5},
        {"state": 5},
        {"kinds": 5},
        {"limits": {"blocks": 5}},
        {"positions": "yes"},
        {"nonsense": True},
    ]
    for arguments in wrong:
        with pytest.raises(TypeError):
            frictcomp.run(text, **arguments)
    with pytest.raises(TypeError, match="kinds are BACKLASH, CROSS"):
        frictcomp.run(text, kinds=5)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="did you mean `FRICT`"):
        frictcomp.run(text, kinds="FRIKT")
    with pytest.raises(ValueError):
        frictcomp.Machine("a.toml", isolated=True)
    for number in (float("nan"), float("inf")):
        with pytest.raises(ValueError):
            frictcomp.Machine(variables={"V.E.A": number})
    with pytest.raises(ValueError):
        frictcomp.Limits(blocks=0)
    with pytest.raises(ValueError):
        frictcomp.Limits(macros=1000)
    with pytest.raises(ValueError):
        frictcomp.Limits(skip=[11])
    for huge in (-1, 2**64):
        with pytest.raises(OverflowError):
            frictcomp.Limits(blocks=huge)
    with pytest.raises(frictcomp.Error):
        frictcomp.run(text, machine=frictcomp.Machine(isolated=True, enable=["X["]))
    with pytest.raises(frictcomp.Error):
        frictcomp.run("a\0.nc")


def test_bytes_that_are_no_utf8_are_code_page_1252() -> None:
    data = b"N10 X1 (\xdcberlauf)\nN20 M30\n"
    for program in (data, frictcomp.Text(data)):
        timeline = frictcomp.run(program, machine=frictcomp.Machine(isolated=True))
        assert list(timeline.programs[0].start) == ["X"]
    with pytest.raises(UnicodeEncodeError):
        frictcomp.Text("N10 \udcdc\n")
    assert len(frictcomp.run(b"\x00\xff\xfe\n")) <= 1


def test_what_is_not_known_is_a_value() -> None:
    text = frictcomp.Text(
        "N10 $IF V.E.PART == 3\nN20 X[COMP OFF FRICT]\nN30 $ENDIF\nN40 G01 X5 F100\nN50 M30\n"
    )
    machine = frictcomp.Machine(isolated=True, enable=["X"])
    timeline = frictcomp.run(text, machine=machine)
    assert timeline.friction == {"X": "unknown"}
    assert {it.code for it in timeline.messages} >= {"FC901"}
    known = frictcomp.Machine(isolated=True, enable=["X"], variables={"V.E.PART": 4})
    assert frictcomp.run(text, machine=known).friction == {"X": "active"}


def test_no_machine_is_said_above_everything_else() -> None:
    text = frictcomp.Text("N10 X[COMP ON FRICT]\nN20 M30\n")
    alone = frictcomp.Machine(isolated=True)
    timeline = frictcomp.run(text, machine=alone)
    assert timeline.messages.remark and "no machine" in timeline.messages.remark
    remark = frictcomp.check(text, machine=alone).remark
    assert remark == timeline.messages.remark
    assert frictcomp.audit(text, machine=alone).messages.remark == remark


def test_limits_end_a_run() -> None:
    text = frictcomp.Text("N10 $WHILE 1\nN20 X1\nN30 $ENDWHILE\nN40 M30\n")
    timeline = frictcomp.run(text, limits=frictcomp.Limits(blocks=100))
    assert len(timeline) <= 100
    assert timeline.programs[0].by == "budget"
    assert [it.code for it in timeline.messages] == ["FC910"]


def test_messages_that_are_left_out_are_counted() -> None:
    blocks = "".join(f"N{n} Y[COMP ON FRICT] X1\n" for n in range(20_000))
    text = frictcomp.Text(blocks + "M30\n")
    machine = frictcomp.Machine(isolated=True, enable=["X"])
    messages = frictcomp.check(text, machine=machine)
    assert len(messages) < 20_000 == messages.errors
    listed = sum(it.severity == "error" for it in messages)
    assert listed + messages.left_out["error"] == messages.errors
    timeline = frictcomp.run(text, machine=machine, keep_going=True)
    assert timeline.messages.errors == 20_000


def test_axes_that_no_program_has_are_no_error() -> None:
    text = frictcomp.Text("N10 X[COMP OFF FRICT]\nN20 M30\n")
    # R13.17: one machine serves every program.
    machine = frictcomp.Machine(isolated=True, enable=["X", "Y", "Q"])
    for program in ("M30\n", "G1 Z5 F100\nM30\n", "B5\nM30\n", ""):
        for call in (frictcomp.run, frictcomp.check, frictcomp.audit, frictcomp.audit_sequence):
            call(frictcomp.Text(program), machine=machine)
    assert list(frictcomp.run(text, machine=machine).programs[0].start) == ["X"]
    frictcomp.run(text, machine=frictcomp.Machine(isolated=True, enable=["Z"]))


def test_what_is_no_variable_is_refused() -> None:
    # R13.17
    for name in ("nonsense", "X", "", "V.", "P"):
        with pytest.raises(ValueError, match="`variables`: .*is not a variable"):
            frictcomp.Machine(variables={name: 3})
    wrong: Any = [1]
    with pytest.raises(TypeError, match="a number or a text"):
        frictcomp.Machine(variables={"V.E.A": wrong})
    frictcomp.Machine(variables={"V.E.A": 1, "P5": 2, "@P5": 3, "v.e.b": "text"})


def test_an_error_names_its_argument_and_the_choices() -> None:
    # R13.17
    calls: list[tuple[Callable[[], object], str]] = [
        (lambda: frictcomp.Limits(calls=0), "`calls` of 0"),
        (lambda: frictcomp.Limits(skip=[11]), "`skip`: 11"),
        (lambda: frictcomp.circle(model="x"), "`model`: .*stribeck, lugre, gms"),
        (lambda: frictcomp.circle(reading="x"), "`reading`: .*standstill=hold"),
        (lambda: frictcomp.explain("FC40l"), "did you mean `FC401`"),
    ]
    for call, words in calls:
        with pytest.raises(ValueError, match=words):
            call()
    with pytest.raises(frictcomp.Error, match="stiff, mid, soft"):
        frictcomp.circle(plant="nope")


def test_messages_are_hashable_and_explained() -> None:
    # R13.17
    text = frictcomp.Text("N10 G0 X1\nN20 X[COMP OFF FRICT]\nN30 M30\n")
    machine = frictcomp.Machine(isolated=True, enable=["X"])
    [message] = [it for it in frictcomp.check(text, machine=machine) if it.code == "FC407"]
    assert len({message, pickle.loads(pickle.dumps(message))}) == 1
    [fix] = message.fixes
    assert fix.also and (fix.line, fix.also.line) == (1, 3)
    assert len({fix, fix.also, *message.ends}) == 3
    assert frictcomp.explain(message.code).startswith("# FC407")
    assert "P-AXIS-00522" in frictcomp.explain("lr_param.frict_comp")
    # As the command: rules, words, error numbers of the control.
    for word, title in [("R1.27", "# R1.27"), ("comp", "# `COMP`"), ("120434", "# P-ERR-120434")]:
        assert frictcomp.explain(word).startswith(title)


def test_what_is_no_recording_is_said(tmp_path: Path) -> None:
    circle = "programs/demo/recorded/learning/round-1/F2000-1.csv"
    assert frictcomp.circle(recordings=circle).record["source"] == "recorded"
    with pytest.raises(frictcomp.Error, match="no recording was given"):
        frictcomp.circle(recordings=[])
    with pytest.raises(frictcomp.Error, match="`model` has no effect on recordings"):
        frictcomp.circle(recordings=circle, model="lugre")
    with pytest.raises(frictcomp.Error, match="was given twice"):
        frictcomp.identify([circle, circle], circles=True)
    with pytest.raises(frictcomp.Error, match="is a folder, not a recording"):
        frictcomp.identify(tmp_path)
    twice = tmp_path / "twice.csv"
    twice.write_text("t,x,x\n0,0,1\n0.001,1,1\n")
    with pytest.raises(frictcomp.Error, match="2 channels fit `x`"):
        frictcomp.current_of_recording(twice, "programs/demo/lists/comp_x.lis")
    with pytest.raises(frictcomp.Error, match="no torque of Q"):
        frictcomp.identify("programs/demo/recordings/friction_x.csv", axis="Q")


def test_what_is_given_wrongly_is_named() -> None:
    with pytest.raises(frictcomp.Error, match="the path is empty"):
        frictcomp.run("")
    with open("programs/demo/friction.nc", encoding="utf-8") as file:
        given: Any = file
        with pytest.raises(TypeError, match="not `TextIOWrapper`"):
            frictcomp.run(given)
    with pytest.raises(TypeError, match="not one text"):
        frictcomp.check("programs/demo/order", exclude="archive/")
    with pytest.raises(frictcomp.Error, match="no axis `Q`, which `start` names"):
        frictcomp.contour("programs/demo/contour/plate.nc", start={"Q": 1.0})
    with pytest.raises(ValueError) as caught:
        frictcomp.explain("")
    assert "did you mean" not in str(caught.value)


def test_currents_are_looked_through_by_axis() -> None:
    currents = frictcomp.current("programs/demo/current/reversal.nc", ["X"])
    assert list(currents) == ["X"] == currents.axes
    assert "X" in currents and "Y" not in currents
