"""The command ``armill``, as the wheel installs it."""

import signal
import sys

from armill import _armill


def main() -> int:
    """Does what ``sys.argv`` says, as the command does, and gives its exit code."""
    # Ctrl-C ends the command at once, as it ends the one that is built without Python.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _armill.command(["armill", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
