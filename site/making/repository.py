"""The files of the repository."""

import posixpath
import subprocess
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@cache
def paths() -> frozenset[str]:
    """Paths from the root of the files that git tracks or would take with the next commit; links are followed by none."""
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True
    )
    names = listed.stdout.decode().split("\0")
    return frozenset(name for name in names if name and (ROOT / name).is_file())


@cache
def inside(folder: str) -> tuple[str, ...]:
    """Paths of all files inside a folder, in order; none where there is no such folder."""
    return tuple(sorted(path for path in paths() if path.startswith(folder + "/")))


def read(path: str) -> str | None:
    """The text of a file; `None` where it is not text."""
    try:
        return (ROOT / path).read_text(encoding="utf-8")
    except UnicodeDecodeError:
        return None


def resolved(page: str, target: str) -> str:
    """The path from the root that a link of a page means."""
    return posixpath.normpath(posixpath.join(posixpath.dirname(page), target)).removeprefix("./")
