"""Pictures: those of the command, and the state bars of a notebook."""

from __future__ import annotations

import html
import pickle
import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import polars
import pytest
from conftest import command

import frictcomp

PLATE = "programs/demo/contour/plate.nc"
PLACES = [("X", 0.0), ("Y", 0.0), ("Z", 10.0)]
RECORDING = "programs/demo/recordings/friction_x.csv"


def drawn(folder: Path, *arguments: str) -> str:
    """The picture that the command draws."""
    path = folder / "picture.svg"
    told = command(*arguments, "--svg", str(path))
    assert told.returncode == 0, told.stderr
    return path.read_text("utf-8")


def bars(svg: str) -> list[str]:
    """The titles of the parts of a picture."""
    root = ElementTree.fromstring(svg)
    return [it.text or "" for it in root.iter("{http://www.w3.org/2000/svg}title")]


def test_every_picture_is_that_of_the_command(tmp_path: Path) -> None:
    # R13.13
    reversal = ("programs/demo/current/reversal.nc", "X")
    start = ",".join(f"{axis}{place}" for axis, place in PLACES)
    channels = ["--velocity", "SetVelo", "--torque", "ActTorque"]
    pictures: list[tuple[Any, list[str]]] = [
        (frictcomp.current(reversal[0], ["X"]), ["current", reversal[0], "--axis", "X"]),
        (frictcomp.contour(PLATE, start=PLACES), ["contour", PLATE, "--start", start]),
        (frictcomp.circle(radius_mm=20), ["circle", "--radius", "20"]),
        (
            frictcomp.tune(feeds=[2000], radii=[20], shaping=False),
            ["tune", "--feeds", "2000", "--radii", "20", "--no-shaping"],
        ),
        (
            frictcomp.identify(RECORDING, velocity="SetVelo", torque="ActTorque"),
            ["identify", RECORDING, *channels],
        ),
    ]
    for made, arguments in pictures:
        assert made.svg() == drawn(tmp_path, *arguments), arguments[0]


def test_a_notebook_shows_the_states_of_a_timeline_as_bars() -> None:
    # R13.13
    timeline = frictcomp.run("programs/demo/friction.nc")
    html = timeline._repr_html_()
    assert "5 blocks, 0 errors, 2 warnings" in html
    assert html.count("<svg") == 1
    told = bars(timeline.svg())
    assert "X active at program start" in told
    assert "X inactive from N45, programs/demo/friction.nc:5, executed block 4" in told
    several = frictcomp.run(["programs/demo/order/probe.nc", "programs/demo/order/pocket.nc"])
    assert several._repr_html_().count("<svg") == 2
    # The second program starts with the state that the first one left.
    assert "X inactive at program start" in bars(several.svg(2))
    with pytest.raises(ValueError, match="no program -1"):
        timeline.svg(-1)
    with pytest.raises(ValueError, match="no program 3"):
        several.svg(3)


def test_bars_are_those_of_the_table_and_stay_few() -> None:
    # R13.13
    machine = frictcomp.Machine(isolated=True, enable=["X"])
    text = "N1 X[COMP OFF FRICT]\nN2 X[COMP ON FRICT]\n" * 20_000 + "N3 M30\n"
    timeline = frictcomp.run(frictcomp.Text(text, "<&>.nc"), machine=machine)
    assert polars.DataFrame(timeline)["X"].n_unique() == 2
    svg = timeline.svg()
    assert len(svg) < 200_000
    assert "&lt;&amp;&gt;.nc: 40001 executed blocks, ended by M30" in svg
    assert "changing" in svg


def test_a_timeline_from_another_process_draws_the_same() -> None:
    # R13.13
    timeline = frictcomp.run("programs/demo/friction.nc")
    assert pickle.loads(pickle.dumps(timeline)).svg() == timeline.svg()


def test_every_result_shows_itself_in_a_notebook_with_ids_of_its_own() -> None:
    # R13.17
    machine = frictcomp.Machine(isolated=True, enable=["X", "Y"])
    program = frictcomp.Text("N10 G1 X1 F100\nN20 X[COMP OFF FRICT] (<&>)\nN30 M30\n")
    currents = frictcomp.current("programs/demo/current/reversal.nc", ["X"])
    timeline = frictcomp.run(program, machine=machine)
    pictured: list[Any] = [
        timeline,
        timeline,
        currents,
        currents["X"],
        frictcomp.contour(PLATE, start=PLACES),
        frictcomp.circle(radius_mm=20),
        frictcomp.tune(feeds=[2000], radii=[20], shaping=False),
        frictcomp.identify(RECORDING, velocity="SetVelo", torque="ActTorque"),
    ]
    tables: list[Any] = [
        timeline.messages,
        frictcomp.check(program, machine=machine),
        frictcomp.audit(program, machine=machine),
        frictcomp.audit_sequence([program, program], machine=machine),
    ]
    for it in pictured:
        if hasattr(it, "record"):
            verdict = html.escape(it.record["headline"]["text"])
            assert f"<p>{verdict}</p>" in it._repr_html_()
    page = "".join(it._repr_html_() for it in [*pictured, *tables])
    # The picture of a contour has one inside.
    assert page.count("<svg") == len(pictured) + 1 and page.count("<table") == len(tables)
    ids = re.findall(r' id="([^"]*)"', page)
    assert len(ids) == 2 * (len(pictured) + 1) == len(set(ids))
    for used in re.findall(r' aria-[a-z]*="([^"]*)"', page):
        assert used in ids
