"""The command that the wheel brings."""

import signal
import sys

from ._engine import command


def main() -> int:
    """Runs the command line of frictcomp."""
    # The command takes its unfinished files away by itself when it is stopped.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(sys.argv)
