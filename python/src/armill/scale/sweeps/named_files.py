"""The files that a study names: they are part of the request."""

from __future__ import annotations

import re
from pathlib import Path

from armill import Study
from armill.scale.files import sha256_of

#: A text in quotes; no file is called by several lines.
QUOTED = re.compile(r"\"([^\"\n]+)\"|'([^'\n]+)'")


def named_files(study: Study) -> dict[str, str]:
    """study -> SHA-256 of every file that it names, by the name. What those files name in turn is not seen."""
    folder = Path(study.folder)
    names = {double or single for double, single in QUOTED.findall(study.text)}
    return {name: sha256_of(folder / name) for name in sorted(names) if _is_file(folder / name)}


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        # A sentence is not a file name.
        return False
