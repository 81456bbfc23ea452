"""``python -m armill``: the command."""

import sys

from armill._command import main

if __name__ == "__main__":
    sys.exit(main())
