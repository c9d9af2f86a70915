"""Contours: the document of the command."""

from __future__ import annotations

import json

import pytest
from conftest import command

import frictcomp

PLATE = "programs/demo/contour/plate.nc"
PLACES = [("X", 0.0), ("Y", 0.0), ("Z", 10.0)]


def test_a_contour_is_that_of_the_command() -> None:
    # R13.13
    made = frictcomp.contour(PLATE, start=PLACES, plant="mid")
    options = ["--start", "X0,Y0,Z10", "--plant", "mid", "--format", "json"]
    told = json.loads(command("contour", PLATE, *options).stdout)
    assert made.record == told
    assert made.record["reversals"] and made.record["programmed"]["max"] > 0
    assert any("programmed" in remark for remark in made.remarks)
    assert repr(made).startswith("<frictcomp.Contour: feed:")


def test_a_plane_has_two_axes_of_the_machine() -> None:
    for plane in ("X", "XYZ", ["X"], []):
        with pytest.raises(ValueError, match="two axes"):
            frictcomp.contour(PLATE, plane=plane)
    with pytest.raises(frictcomp.Error, match="QQ"):
        frictcomp.contour(PLATE, plane=["X", "QQ"])
    turned = frictcomp.contour(PLATE, start=PLACES, plane=("Y", "X"))
    assert "plane YX" in turned.svg()


def test_what_cannot_be_driven_is_an_error() -> None:
    with pytest.raises(frictcomp.Error):
        frictcomp.contour("none.nc")
    with pytest.raises(frictcomp.Error):
        frictcomp.contour(PLATE, plant="no-such-plant")
    with pytest.raises(frictcomp.Error) as caught:
        frictcomp.contour(PLATE, value_list={"X": "none.lis"})
    assert caught.value.file == "none.lis"
    with pytest.raises(frictcomp.Error):
        frictcomp.contour(PLATE, start=[("X", float("nan"))])
    with pytest.raises(frictcomp.Error):
        frictcomp.contour([PLATE, PLATE])  # type: ignore[arg-type]
    cut = frictcomp.contour(PLATE, start=PLACES, max_cycles=10)
    assert cut.messages and cut.record["machine_time"] < 0.1
