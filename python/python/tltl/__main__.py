"""`tltlc`, the command-line tool: `python -m tltl`."""

from __future__ import annotations

import signal
import sys

from tltl import _core


def main() -> int:
    """Runs the tool on the arguments of the process; its exit code."""
    # While Rust runs, Python's handler would not be called: Ctrl-C ends the process.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _core.main(["tltlc", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
