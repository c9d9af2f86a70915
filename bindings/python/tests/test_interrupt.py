"""Long work gives way: to Ctrl+C, and to other threads of Python."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import polars
import pytest

import frictcomp

#: A program that runs for hours.
ENDLESS = "N10 $FOR V.P.I = 1, 100000000, 1\\nN20 $FOR V.P.J = 1, 10000, 1\\nN30 X1\\nN40 $ENDFOR\\nN50 $ENDFOR\\nM30\\n"
LONG = "limits=frictcomp.Limits(blocks=10**12, work=10**12)"

CALLS = {
    "run": f"frictcomp.run(frictcomp.Text(program), state=state, {LONG})",
    "check": f"frictcomp.check(frictcomp.Text(program), {LONG})",
    "audit": f"frictcomp.audit([frictcomp.Text(program, f'{{n}}.nc') for n in range(9)], {LONG})",
    "current": f"frictcomp.current(BACK_AND_FORTH, ['X'], max_cycles=10**12, {LONG})",
    "contour": f"frictcomp.contour(IN_THE_PLANE, machine=TWO, max_cycles=10**12, {LONG})",
    "circle": "[frictcomp.circle(radius_mm=1000, feed_mm_per_min=500) for _ in range(1000)]",
    "tune": "frictcomp.tune(feeds=[500, 1000, 2000, 5000], radii=[50, 100, 200, 400])",
}

SCRIPT = """
import sys, time, frictcomp
state = sys.argv[1]
program = "{program}"
BACK_AND_FORTH = frictcomp.Text(
    "N10 G90 X0 F1000\\nN20 $FOR V.P.I = 1, 100000000, 1\\nN30 G01 X50\\nN40 X0\\nN50 $ENDFOR\\n",
    "programs/demo/current/reversal.nc",
)
IN_THE_PLANE = frictcomp.Text(BACK_AND_FORTH.text.replace("X0 F1000", "X0 Y0 F1000"))
TWO = frictcomp.Machine(isolated=True, enable=["X", "Y"])
print("ready", flush=True)
try:
    {call}
except KeyboardInterrupt:
    # Python continues after it.
    assert len(frictcomp.run(frictcomp.Text("N10 M30\\n"))) == 1
    print("interrupted", flush=True)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="signals of consoles reach whole groups")
@pytest.mark.parametrize("name", CALLS)
def test_an_interrupt_ends_long_work(name: str, tmp_path: Path) -> None:
    state = tmp_path / "state.json"
    script = SCRIPT.format(program=ENDLESS, call=CALLS[name])
    process = subprocess.Popen(
        [sys.executable, "-c", script, str(state)], stdout=subprocess.PIPE, encoding="utf-8"
    )
    assert process.stdout
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    os.kill(process.pid, signal.SIGINT)
    told, _ = process.communicate(timeout=30)
    assert told == "interrupted\n" and process.returncode == 0
    # A run that was interrupted leaves no state.
    assert not state.exists()


def test_other_threads_run_meanwhile() -> None:
    program = ENDLESS.encode().decode("unicode_escape")
    turns = 0
    done = threading.Event()

    def work() -> None:
        frictcomp.run(frictcomp.Text(program), limits=frictcomp.Limits(blocks=300_000))
        done.set()

    thread = threading.Thread(target=work)
    thread.start()
    while not done.is_set():
        turns += 1
        time.sleep(0.001)
    thread.join()
    assert turns > 10


def test_runs_in_many_threads_do_not_mix() -> None:
    machine = frictcomp.Machine(isolated=True, enable=["X"])

    def count(switches: int) -> int:
        text = "N1 X[COMP OFF FRICT]\nN2 X[COMP ON FRICT]\n" * switches + "N3 M30\n"
        timeline = frictcomp.run(frictcomp.Text(text), machine=machine)
        blocks = polars.DataFrame(timeline)
        assert blocks.height == len(timeline) == 2 * switches + 1
        return int((blocks["X"] == "inactive").sum())

    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(count, range(1, 100))) == list(range(1, 100))


def test_one_timeline_is_read_in_many_threads() -> None:
    timeline = frictcomp.run("programs/demo/friction.nc")
    with ThreadPoolExecutor(8) as pool:
        frames = list(pool.map(lambda _: polars.DataFrame(timeline), range(200)))
    assert all(frame.equals(frames[0]) for frame in frames)
