"""Circles, tuning and identification: the documents of the command."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from conftest import command

import frictcomp


def document(*arguments: str) -> Any:
    """The JSON document that the command prints."""
    return json.loads(command(*arguments, "--format", "json").stdout)


def test_a_circle_is_that_of_the_command() -> None:
    options = ["--radius", "20", "--feed", "2000", "--plant", "mid"]
    told = frictcomp.circle(radius_mm=20, feed_mm_per_min=2000, plant="mid")
    assert told.record == document("circle", *options)


def test_tuned_lists_are_those_of_the_command(tmp_path: Path) -> None:
    path = tmp_path / "x.lis"
    options = ["--feeds", "2000", "--radii", "20", "--no-shaping", "--write-list", str(path)]
    told = document("tune", *options)
    tuned = frictcomp.tune(feeds=[2000], radii=[20], shaping=False)
    assert tuned.record == told
    assert tuned.value_list() == path.read_text("utf-8")


def test_an_identified_list_is_that_of_the_command(tmp_path: Path) -> None:
    path = tmp_path / "x.lis"
    name = "programs/demo/recordings/friction_x.csv"
    channels = ["--velocity", "SetVelo", "--torque", "ActTorque"]
    told = document("identify", name, *channels, "--write-list", str(path))
    identified = frictcomp.identify(name, velocity="SetVelo", torque="ActTorque")
    assert identified.record == told
    assert identified.value_list() == path.read_text("utf-8")


def test_what_is_said_about_the_torque_counts() -> None:
    name = "programs/demo/recordings/friction_x.csv"
    channels = ["--velocity", "SetVelo", "--torque", "ActTorque"]
    told = document("identify", name, *channels, "--torque-kind", "loop", "--compensation", "off")
    identified = frictcomp.identify(
        name, velocity="SetVelo", torque="ActTorque", torque_kind="loop", compensation="off"
    )
    assert identified.record == told
    with pytest.raises(frictcomp.Error):
        frictcomp.identify(
            name, velocity="SetVelo", torque="ActTorque", torque_kind="loop", compensation="on"
        )
    with pytest.raises(ValueError):
        frictcomp.identify(name, torque_kind="felt")  # type: ignore[arg-type]
    with pytest.raises(ValueError):
        frictcomp.identify(name, compensation="half")  # type: ignore[arg-type]


def test_what_makes_no_sense_is_refused() -> None:
    for radius in (0.0, -1.0, float("nan"), float("inf"), 1e300):
        with pytest.raises(frictcomp.Error):
            frictcomp.circle(radius_mm=radius)
        with pytest.raises(frictcomp.Error):
            frictcomp.tune(radii=[radius])
    with pytest.raises(frictcomp.Error):
        frictcomp.circle(plant="no-such-plant")
    with pytest.raises(frictcomp.Error):
        frictcomp.circle(value_list={"X": "a.lis"})
    with pytest.raises(ValueError):
        frictcomp.circle(model="no-such-model")
    for wrong in ([], [1.0] * 33):
        with pytest.raises(ValueError):
            frictcomp.tune(feeds=wrong)
    with pytest.raises(ValueError):
        frictcomp.tune(free=["scaling_factor"])
    with pytest.raises(frictcomp.Error):
        frictcomp.identify("none.csv")
    with pytest.raises(frictcomp.Error):
        frictcomp.identify([])
    for error in (0.0, -1.0, float("nan"), 99.0):
        with pytest.raises(ValueError):
            frictcomp.identify("none.csv", max_error=error)
    with pytest.raises(ValueError):
        frictcomp.identify("none.csv", units={"v": "furlongs"})


def test_a_commissioning_is_evaluated_as_the_command_does(tmp_path: Path) -> None:
    # R13.13, R16.2
    folders = [tmp_path / "python", tmp_path / "command"]
    for folder in folders:
        shutil.copytree("programs/demo/recorded/machine", folder)
    found = frictcomp.commission(folders[0])
    told = document("commission", "run", str(folders[1]))
    assert found["headline"] == told["headline"]
    assert [it["list"] is None for it in found["axes"]] == [False, True]
    lists = [[it.read_text() for it in (folder / "lists").glob("*.lis")] for folder in folders]
    assert lists[0] == lists[1] and len(lists[0]) == 1
    assert (folders[0] / "results.json").exists()
    with pytest.raises(frictcomp.Error, match="plan"):
        frictcomp.commission(tmp_path)


def test_a_recording_is_compared_with_the_dry_run_as_the_command_does() -> None:
    # R13.13, R15.21
    recordings = [f"programs/demo/replay/{name}.csv" for name in ("states", "other")]
    program = "programs/demo/replay/pocket.nc"
    for recording in recordings:
        assert frictcomp.replay(recording, program) == document("replay", recording, program)
    known = frictcomp.Machine(variables={"V.E.FINISH": 1})
    other = frictcomp.replay(recordings[1], [program], machine=known)
    assert other["headline"]["standing"] == "bad"
    with pytest.raises(frictcomp.Error, match="tolerance"):
        frictcomp.replay(recordings[0], program, tolerance_um=-1.0)
    with pytest.raises(frictcomp.Error, match="no axis"):
        frictcomp.replay(recordings[0], program, start={"Q": 0.0})


def test_friction_is_followed_over_the_dates_as_the_command_does(tmp_path: Path) -> None:
    # R13.13, R16.6
    for date in ("2026-03-01", "2026-09-01"):
        shutil.copy("programs/demo/recordings/friction_x.csv", tmp_path / f"x-{date}.csv")
        with (tmp_path / f"x-{date}.csv").open("a") as recording:
            recording.write("\n" if date.endswith("09-01") else "")
    with pytest.raises(frictcomp.Error, match="date"):
        frictcomp.trend("programs/demo/recordings")
    told = document("commission", "trend", str(tmp_path))
    assert frictcomp.trend(tmp_path) == told


def test_a_recording_is_listed_and_a_list_verified_as_the_command_does() -> None:
    # R13.13, R6.20
    recording = "programs/demo/recordings/friction_x.csv"
    listed = "programs/demo/lists/comp_x.lis"
    assert frictcomp.trace(recording) == document("trace", recording)
    told = document("verify", recording, "--value-list", listed)
    assert frictcomp.verify(recording, listed) == told
    with pytest.raises(frictcomp.Error, match="no channel `v`"):
        frictcomp.verify(recording, listed, units={"v": "mm/s"})
    with pytest.raises(frictcomp.Error, match="is the velocity"):
        frictcomp.verify(recording, listed, units={"velocity": "mm"})
