"""The program ``membranes``: ``python -m membrane_contact``."""

import signal
import sys

from ._core import run


def main() -> int:
    """Runs the program on the arguments of the process, and returns its exit code."""
    # The program has a handler of its own.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return run(["membranes", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
