"""What the tests share: the programs of the repository, and the command that came with the wheel."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(autouse=True)
def in_the_repository(monkeypatch: pytest.MonkeyPatch) -> None:
    """Paths are named as on the command line, from the root of the repository."""
    monkeypatch.chdir(ROOT)


def command(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Runs the command of the wheel."""
    found = shutil.which("frictcomp", path=str(Path(sys.executable).parent))
    assert found, "the wheel brings the command"
    return subprocess.run([found, *arguments], capture_output=True, encoding="utf-8", check=False)


def records(*arguments: str) -> list[dict[str, Any]]:
    """The NDJSON records that the command prints."""
    return [json.loads(line) for line in command(*arguments).stdout.splitlines()]


def programs(*folders: str) -> list[str]:
    """All programs below folders, as they are named from the root."""
    found = [it for folder in folders for it in (ROOT / folder).rglob("*.nc")]
    return sorted(str(it.relative_to(ROOT)) for it in found)
