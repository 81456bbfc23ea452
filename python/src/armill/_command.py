"""The command ``armill`` of the wheel."""

import signal
import sys

from armill import _armill


def main() -> int:
    """Runs the command with ``sys.argv`` and returns its exit code."""
    # Ctrl-C ends the command at once, as it does without Python.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _armill.command(["armill", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
