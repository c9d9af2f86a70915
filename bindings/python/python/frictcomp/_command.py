"""The command that the wheel contains."""

import signal
import sys

from ._engine import command


def main() -> int:
    """Runs the command line of frictcomp."""
    # The command removes its unfinished files itself when it is stopped.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(sys.argv)
