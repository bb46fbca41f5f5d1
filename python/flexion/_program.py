"""The program ``flexion``, which the package carries."""

from __future__ import annotations

import signal
import sys

from . import _core


def main() -> None:
    """Does what the command line says, and ends with its exit code."""
    # The program has its own answer to Ctrl-C, and to a closed pipe.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_core.program(["flexion", *sys.argv[1:]]))
