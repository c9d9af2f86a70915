"""The command that the wheel brings, and what is typed."""

from __future__ import annotations

import subprocess
import sys
from importlib.metadata import version

from conftest import ROOT, command

import frictcomp


def test_the_command_is_on_the_path() -> None:
    assert command("--version").stdout == f"frictcomp {version('frictcomp')}\n"
    assert frictcomp.__version__ == version("frictcomp")
    for status, arguments in [
        (0, ["run", "programs/demo/friction.nc"]),
        (1, ["check", "programs/demo/unset"]),
        (2, ["check", "no-such-folder"]),
        (2, ["nonsense"]),
    ]:
        assert command(*arguments).returncode == status


def test_the_module_is_the_command_too() -> None:
    arguments = [sys.executable, "-m", "frictcomp", "run", "-"]
    told = subprocess.run(arguments, input=b"N10 M30\n", capture_output=True, check=True)
    assert b"1 block without a change" in told.stdout


def test_the_package_is_typed() -> None:
    folder = ROOT / "bindings/python/python/frictcomp"
    assert (folder / "py.typed").exists()
    assert all(getattr(frictcomp, name).__doc__ for name in frictcomp.__all__ if name[0].isupper())
